//! Contacts in synthetic motions of shipped arms: what touches the arm is found, where it is, and nothing else.

use fastrand::Rng;
use rne_logs::Motion;
use rne_model::{Joint, Motor, Reader, Robot};
use rne_runtime::DynArm;
use rne_watch::{Contact, ContactNoise, Settings, Signals, WatchError, contacts};

/// Samples per second.
const RATE: f64 = 250.0;
const SECONDS: f64 = 40.0;

/// Standard deviation of the measured efforts, of the largest of each joint.
const NOISE: f64 = 0.01;

fn shipped(name: &str) -> Robot {
    let file = rne_robots::find(name).expect("a shipped robot");
    Reader::new(name).read(file.yaml).expect("it is valid").robot
}

/// A number of the standard normal distribution (Box and Muller).
fn normal(rng: &mut Rng) -> f64 {
    let (u, v) = (1.0 - rng.f64(), rng.f64());
    (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

/// Position, velocity and acceleration of a joint at a time.
type Path = fn(usize, f64) -> [f64; 3];

/// Every joint swings at a rate of its own.
fn swing(joint: usize, time: f64) -> [f64; 3] {
    #[allow(clippy::cast_precision_loss)]
    let w = 0.9 + 0.37 * joint as f64;
    [0.4 * (w * time).sin(), 0.4 * w * (w * time).cos(), -0.4 * w * w * (w * time).sin()]
}

/// Slowly from posture to posture, where an arm is held for long.
fn slowly(joint: usize, time: f64) -> [f64; 3] {
    #[allow(clippy::cast_precision_loss)]
    let w = 0.31 + 0.12 * joint as f64;
    [1.2 * (w * time).sin(), 1.2 * w * (w * time).cos(), -1.2 * w * w * (w * time).sin()]
}

/// Other postures, other rates.
fn elsewhere(joint: usize, time: f64) -> [f64; 3] {
    #[allow(clippy::cast_precision_loss)]
    let (w, middle) = (0.47 - 0.11 * joint as f64, 0.3 - 0.4 * joint as f64);
    [middle + (w * time).cos(), -w * (w * time).sin(), -w * w * (w * time).cos()]
}

/// A motion in which every joint swings; `disturbed` changes the efforts that the model asks for, from time, velocities
/// and the efforts.
fn motion(robot: &Robot, seed: u64, disturbed: impl Fn(f64, &[f64], &mut [f64])) -> Motion {
    along(robot, (seed, NOISE), swing, disturbed)
}

/// A motion along a path; noise by a seed and its deviation, of the largest effort of each joint.
fn along(robot: &Robot, (seed, noise): (u64, f64), path: Path, disturbed: impl Fn(f64, &[f64], &mut [f64])) -> Motion {
    let arm = DynArm::from_robot(&robot.clone().with_rotors());
    let (dof, mut rng) = (robot.dof(), Rng::with_seed(seed));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let samples = (RATE * SECONDS) as usize;
    let lists = || vec![Vec::with_capacity(samples); dof];
    let mut motion =
        Motion { time: Vec::new(), q: lists(), qd: lists(), qdd: lists(), tau: lists(), ..Motion::default() };
    for sample in 0..samples {
        #[allow(clippy::cast_precision_loss)]
        let time = sample as f64 / RATE;
        let of = |which: usize| -> Vec<f64> { (0..dof).map(|joint| path(joint, time)[which]).collect() };
        let [q, qd, qdd] = [0, 1, 2].map(of);
        let mut tau = arm.inverse_dynamics(&q, &qd, &qdd).expect("one per joint");
        let friction = arm.actuator_torques(&qd, &qdd).expect("one per joint");
        tau.iter_mut().zip(&friction).for_each(|(tau, friction)| *tau += friction);
        disturbed(time, &qd, &mut tau);
        motion.time.push(time);
        for joint in 0..dof {
            motion.q[joint].push(q[joint]);
            motion.qd[joint].push(qd[joint]);
            motion.qdd[joint].push(qdd[joint]);
            motion.tau[joint].push(tau[joint]);
        }
    }
    for tau in &mut motion.tau {
        let deviation = noise * tau.iter().fold(0.0_f64, |most, tau| most.max(tau.abs()));
        for tau in tau {
            *tau += deviation * normal(&mut rng);
        }
    }
    motion
}

fn watched(
    robot: &Robot,
    seed: u64,
    disturbed: impl Fn(f64, &[f64], &mut [f64]),
) -> (Signals, ContactNoise, Vec<Contact>) {
    let settings = Settings::default();
    let signals = Signals::new(robot, &motion(robot, seed, disturbed), settings.gain).expect("a motion of the robot");
    // the first ten seconds are quiet
    let noise = ContactNoise::of(&signals, 0..2500).expect("long enough");
    let found = contacts(&signals, &noise, &settings).expect("of the same robot");
    (signals, noise, found)
}

fn of(contacts: &[Contact], joint: usize) -> Vec<&Contact> {
    contacts.iter().filter(|contact| contact.joint == joint).collect()
}

#[test]
fn free_motion_raises_no_alarm() {
    for (name, seed) in [("puma560", 1), ("planar2", 2), ("planar2", 3), ("scara_cobra600", 4)] {
        let (signals, _, found) = watched(&shipped(name), seed, |_, _, _| {});
        assert_eq!(found, [], "{name}");
        // noise is all that the model does not explain
        for (joint, tau) in signals.measured.iter().enumerate() {
            let error = signals.prediction_error(joint).expect("efforts that change");
            #[allow(clippy::cast_precision_loss)]
            let count = tau.len() as f64;
            let mean = tau.iter().sum::<f64>() / count;
            let spread = (tau.iter().map(|tau| (tau - mean).powi(2)).sum::<f64>() / count).sqrt();
            let noise = NOISE * tau.iter().fold(0.0_f64, |most, tau| most.max(tau.abs()));
            assert!((error / (noise / spread) - 1.0).abs() < 0.08, "{name}: {error}, {}", noise / spread);
        }
    }
}

/// A tenth of a second of something in the way of the second joint.
#[test]
fn a_collision_is_seen_where_it_is() {
    let robot = shipped("puma560");
    let (size, start, length) = (12.0, 20.0, 0.1);
    let (_, _, found) = watched(&robot, 5, |time, _, tau| {
        let phase = (time - start) / length;
        // the environment pushes back: the actuator delivers more
        if (0.0..1.0).contains(&phase) {
            tau[1] += size * (std::f64::consts::PI * phase).sin();
        }
    });
    let of_joint = of(&found, 1);
    assert_eq!(of_joint.len(), 1, "{found:?}");
    let contact = of_joint[0];
    assert!((start - 0.01..start + 0.05).contains(&contact.start), "{contact:?}");
    assert!((start + 0.05..start + length + 0.05).contains(&contact.end), "{contact:?}");
    assert!((-1.2 * size..-0.6 * size).contains(&contact.peak), "{contact:?}");
    assert!(found.iter().all(|contact| contact.joint == 1));
}

/// A joint that turns back is held by anything between Coulomb's friction of both directions: real gears give way over
/// some travel, the model at once. What is beyond that is still seen.
#[test]
fn a_joint_that_turns_back_is_no_event() {
    turning_back(|joint| joint.coulomb_width = Some(0.01));
}

/// Where the file has a displacement, and a wrong one.
#[test]
fn a_joint_that_turns_back_over_a_displacement_is_no_event() {
    turning_back(|joint| joint.coulomb_displacement = Some(1e-4));
}

fn turning_back(describe: fn(&mut Joint)) {
    let mut robot = shipped("planar2");
    let motor = Motor { inertia: 0.0, gear_ratio: 1.0, viscous: 0.3, coulomb: [2.0, -2.0] };
    for joint in &mut robot.joints {
        joint.motor = Some(motor);
        describe(joint);
    }
    // friction of a spring that slides: it lags behind the sign by two milliradians
    let lagging = |robot: &Robot| {
        let mut motion = motion(robot, 21, |_, _, _| {});
        for joint in 0..2 {
            let mut bent = 0.001_f64; // all joints set out forward
            for at in 0..motion.len() {
                let step = if at == 0 { 0.0 } else { motion.q[joint][at] - motion.q[joint][at - 1] };
                bent = (bent + step).clamp(-0.001, 0.001);
                let sign = 2.0 * bent / 0.001;
                let instant = robot.joints[joint].friction(motion.qd[joint][at]) - 0.3 * motion.qd[joint][at];
                motion.tau[joint][at] += sign - instant;
            }
        }
        motion
    };
    let settings = Settings::default();
    let free = lagging(&robot);
    let signals = Signals::new(&robot, &free, settings.gain).expect("a motion of the robot");
    let noise = ContactNoise::of(&signals, 0..2500).expect("long enough");
    let mut blind = signals.clone();
    blind.open = vec![vec![0.0; free.len()]; 2];
    blind.creeps = vec![vec![false; free.len()]; 2];
    assert!(!contacts(&blind, &noise, &settings).expect("two joints").is_empty(), "nothing lags");
    assert_eq!(contacts(&signals, &noise, &settings).expect("two joints"), []);
    let mut knocked = free;
    for (tau, time) in knocked.tau[1].iter_mut().zip(&knocked.time) {
        *tau += if (20.0..20.2).contains(time) { 8.0 } else { 0.0 };
    }
    let signals = Signals::new(&robot, &knocked, settings.gain).expect("a motion of the robot");
    let events = contacts(&signals, &noise, &settings).expect("two joints");
    assert!(events.iter().any(|event| event.joint == 1 && (19.99..20.1).contains(&event.start)), "{events:?}");
}

/// Levels of several stretches: the medians know nothing of one that is different, what covers them knows all.
#[test]
fn levels_of_several_stretches() {
    let of = |mean: f64, deviation: f64| ContactNoise::white(&[deviation]).widened(1.0 + mean, 1.0);
    let typical = ContactNoise::typical(&[of(0.0, 1.0), of(0.0, 1.2), of(0.0, 50.0)]).expect("three");
    assert!((typical.joints[0].deviation - 1.2).abs() < 1e-12 && typical.joints[0].mean == 0.0);
    let mut offset = of(0.0, 1.0);
    offset.joints[0].mean = 4.0;
    let covering = ContactNoise::covering(&[of(0.0, 3.0), offset]).expect("two");
    assert_eq!((covering.joints[0].mean, covering.joints[0].deviation), (2.0, 5.0));
    assert!(ContactNoise::typical(&[]).is_none());
}

/// In a stretch in which nothing happens nothing is found, however the model is wrong there; and twice as much is.
#[test]
fn a_quiet_stretch_stays_quiet() {
    let robot = shipped("puma560");
    let settings = Settings::default();
    // a wave that the model has not
    let wrong =
        |times: f64| motion(&robot, 22, move |time, _, tau| tau[1] += times * 9.0 * (0.8 * time).sin().powi(41));
    let signals = |times| Signals::new(&robot, &wrong(times), settings.gain).expect("a motion of the robot");
    let quiet = signals(1.0);
    let before = ContactNoise::of(&quiet, 0..quiet.time.len()).expect("long enough");
    assert!(!contacts(&quiet, &before, &settings).expect("six joints").is_empty());
    let silent = before.silent(&quiet, &settings).expect("six joints");
    assert_eq!(contacts(&quiet, &silent, &settings).expect("six joints"), []);
    let events = contacts(&signals(2.0), &silent, &settings).expect("six joints");
    assert!(events.iter().any(|event| event.joint == 1), "{events:?}");
    assert!(events.iter().all(|event| event.joint == 1), "{events:?}");
}

/// Events on both sides of a border are one.
#[test]
fn events_are_joined() {
    let robot = shipped("planar2");
    let (_, _, found) = watched(&robot, 23, |time, _, tau| tau[1] += if time > 20.0 { 9.0 } else { 0.0 });
    let first = found[0];
    let later = |by: f64, peak: f64| {
        let mut event = first;
        (event.start, event.end, event.peak) = (first.start + by, first.end + by, peak);
        event
    };
    let long = first.end - first.start;
    let joined = Contact::joined(vec![later(long + 0.1, -99.0), first], 0.25);
    assert_eq!((joined.len(), joined[0].start, joined[0].peak), (1, first.start, -99.0));
    assert_eq!(Contact::joined(vec![later(long + 0.3, 1.0), first], 0.25).len(), 2);
}

/// Of noise that is white, and of one that a filter has smoothed: alarms are no more than asked for.
#[test]
fn false_alarms_are_as_rare_as_asked_for() {
    let robot = shipped("planar2");
    let base = Signals::new(&robot, &motion(&robot, 8, |_, _, _| {}), 20.0).expect("a motion of the robot");
    let samples = 200_000_u32;
    // one in ten seconds
    let settings = Settings { false_alarms: 360.0, ..Settings::default() };
    for memory in [0.0_f64, 0.9] {
        let mut rng = Rng::with_seed(9);
        let mut noise = || -> Vec<Vec<f64>> {
            let list = |rng: &mut Rng| {
                let mut before = 0.0;
                (0..samples)
                    .map(|_| {
                        before = memory * before + (1.0 - memory * memory).sqrt() * normal(rng);
                        before
                    })
                    .collect()
            };
            vec![list(&mut rng), list(&mut rng)]
        };
        let mut signals = base.clone();
        signals.residual = noise();
        signals.external = noise();
        signals.measured = noise();
        signals.time = (0..samples).map(|sample| f64::from(sample) / RATE).collect();
        signals.settled = vec![true; signals.time.len()];
        signals.open = vec![vec![0.0; signals.time.len()]; 2];
        (signals.terms, signals.inertia) = (signals.open.clone(), signals.open.clone());
        signals.creeps = vec![vec![false; signals.time.len()]; 2];
        let noise = ContactNoise::of(&signals, 0..100_000).expect("long enough");
        let hours = f64::from(samples) / RATE / 3600.0;
        #[allow(clippy::cast_precision_loss)]
        let found = contacts(&signals, &noise, &settings).expect("two joints").len() as f64 / hours;
        println!("memory {memory}: {found:.0} an hour, at most 360 asked for");
        assert!(found < 1.3 * 360.0, "memory {memory}: {found} an hour");
    }
}

/// A gap in the times is a new beginning of the observer, and no event.
#[test]
fn a_gap_is_no_event() {
    let robot = shipped("planar2");
    let mut motion = motion(&robot, 10, |_, _, _| {});
    for list in std::iter::once(&mut motion.time)
        .chain(&mut motion.q)
        .chain(&mut motion.qd)
        .chain(&mut motion.qdd)
        .chain(&mut motion.tau)
    {
        list.drain(5000..5400);
    }
    let settings = Settings::default();
    let signals = Signals::new(&robot, &motion, settings.gain).expect("a motion of the robot");
    assert!(signals.settled[4999] && !signals.settled[5000] && !signals.settled[5005] && signals.settled[5020]);
    let noise = ContactNoise::of(&signals, 0..2500).expect("long enough");
    assert_eq!(contacts(&signals, &noise, &settings).expect("of the same robot"), []);
}

/// What deviates by nothing has no threshold.
#[test]
fn levels_without_a_deviation_are_refused() {
    let robot = shipped("planar2");
    let settings = Settings::default();
    let signals = Signals::new(&robot, &motion(&robot, 24, |_, _, _| {}), settings.gain).expect("a motion");
    for wrong in [0.0, -1.0, f64::NAN] {
        let noise = ContactNoise::white(&[1.0, wrong]);
        let refused = noise.clone().silent(&signals, &settings);
        assert!(matches!(refused, Err(WatchError::Setting(_))), "{wrong}: {refused:?}");
        assert!(contacts(&signals, &noise, &settings).is_err());
    }
}

/// A slow observer blinds itself after a reversal, and nothing else.
#[test]
fn a_slow_observer_blinds_nothing_but_itself() {
    let mut robot = shipped("planar2");
    for joint in &mut robot.joints {
        joint.motor = Some(Motor { inertia: 0.0, gear_ratio: 1.0, viscous: 0.3, coulomb: [2.0, -2.0] });
        joint.coulomb_width = Some(0.01);
    }
    let signals = Signals::new(&robot, &motion(&robot, 25, |_, _, _| {}), 0.1).expect("a motion of the robot");
    let share = |of: usize| {
        let creeping = signals.creeps[of].iter().filter(|creeps| **creeps).count();
        #[allow(clippy::cast_precision_loss)]
        let share = creeping as f64 / signals.time.len() as f64;
        share
    };
    assert!(share(0) > 0.0 && share(0) < 0.2 && share(1) < 0.2, "{} {}", share(0), share(1));
}

#[test]
fn noise_that_is_known_needs_no_quiet_stretch() {
    let robot = shipped("planar2");
    let plain = motion(&robot, 11, |time, _, tau| tau[0] -= if time > 30.0 { 8.0 } else { 0.0 });
    let settings = Settings::default();
    let signals = Signals::new(&robot, &plain, settings.gain).expect("a motion of the robot");
    let noise = ContactNoise::white(&[1.0, 0.5]);
    let found = contacts(&signals, &noise, &settings).expect("of the same robot");
    let first = found.first().expect("a contact");
    assert!(first.start > 29.9 && first.joint == 0, "{first:?}");
}

#[test]
fn what_cannot_be_watched_is_said() {
    let robot = shipped("planar2");
    let whole = motion(&robot, 12, |_, _, _| {});
    let refused = |change: &dyn Fn(&mut Motion)| {
        let mut motion = whole.clone();
        change(&mut motion);
        Signals::new(&robot, &motion, 20.0).expect_err("no motion of the robot")
    };
    let is = |error: WatchError, words: &str| assert_eq!(error.to_string(), words);
    is(refused(&|m| m.qdd.truncate(1)), "the motion has 1 joints, but the robot has 2");
    assert!(matches!(refused(&|m| m.tau[1].truncate(7)), WatchError::Length("tau", 2)));
    assert!(matches!(refused(&|m| m.q[0][9] = f64::NAN), WatchError::Sample(9)));
    assert!(matches!(refused(&|m| m.time[5] = m.time[4]), WatchError::Sample(5)));
    let empty = |m: &mut Motion| {
        *m = Motion {
            q: vec![vec![]; 2],
            qd: vec![vec![]; 2],
            qdd: vec![vec![]; 2],
            tau: vec![vec![]; 2],
            ..Motion::default()
        };
    };
    assert!(matches!(refused(&empty), WatchError::TooFew { found: 0, needed: 16 }));
    let signals = Signals::new(&robot, &whole, 20.0).expect("a motion of the robot");
    assert!(matches!(Signals::new(&robot, &whole, 0.0), Err(WatchError::Setting("the gain"))));
    assert!(matches!(ContactNoise::of(&signals, 0..5), Err(WatchError::TooFew { .. })));
    let found = |noise: &[f64], settings: &Settings| contacts(&signals, &ContactNoise::white(noise), settings);
    assert!(matches!(found(&[1.0], &Settings::default()), Err(WatchError::Joints { expected: 2, found: 1 })));
    let settings = Settings { hold: f64::NAN, ..Settings::default() };
    assert!(matches!(found(&[1.0; 2], &settings), Err(WatchError::Setting("the hold"))));
    assert!(WatchError::Sample(3).to_string().starts_with("sample 4 "));
}

/// A robot whose numbers are wrong by up to so large a part of themselves.
fn wrong(robot: &Robot, part: f64, seed: u64) -> Robot {
    let (mut robot, mut rng) = (robot.clone(), Rng::with_seed(seed));
    let mut times = || 1.0 + part * (2.0 * rng.f64() - 1.0);
    for joint in &mut robot.joints {
        let link = &mut joint.row.link;
        link.mass *= times();
        link.com.iter_mut().for_each(|number| *number *= times());
        let inertia = &mut link.inertia;
        for number in [&mut inertia.xx, &mut inertia.yy, &mut inertia.zz] {
            *number *= times();
        }
    }
    robot
}

/// What the numbers of a model get wrong is no event, whether what is usual is learnt from the log itself or from one
/// of other postures; and a collision is still one.
#[test]
fn numbers_that_are_wrong_by_little_are_no_event() {
    let robot = shipped("planar2");
    let settings = Settings::default();
    for seed in 31..37 {
        let model = wrong(&robot, 0.05, seed);
        let signals = |motion: &Motion| Signals::new(&model, motion, settings.gain).expect("a motion of the robot");
        let own = |signals: &Signals| ContactNoise::of(signals, 0..signals.time.len()).expect("long enough");
        let free = signals(&along(&robot, (seed, 0.002), slowly, |_, _, _| {}));
        let other = signals(&along(&robot, (seed + 100, 0.002), elsewhere, |_, _, _| {}));
        let quiet = |signals: &Signals| own(signals).silent(signals, &settings).expect("two joints").widened(1.5, 2.0);
        for noise in [own(&free), quiet(&other)] {
            assert_eq!(contacts(&free, &noise, &settings).expect("two joints"), [], "{seed}");
        }

        let hit = signals(&along(&robot, (seed, 0.002), slowly, |time, _, tau| {
            tau[0] += if (20.0..20.2).contains(&time) { 10.0 } else { 0.0 };
        }));
        let found = contacts(&hit, &own(&hit), &settings).expect("two joints");
        let of_joint = of(&found, 0);
        assert!(of_joint.len() == 1 && (20.0..20.05).contains(&of_joint[0].start), "{seed}: {found:?}");
    }
}

/// An elbow that is bent most of the time, and stretched for some of it.
fn reaching(joint: usize, time: f64) -> [f64; 3] {
    if joint == 0 {
        return swing(0, time);
    }
    let (w, sine, cosine) = (0.4, (0.4 * time).sin(), (0.4 * time).cos());
    let bent = |power: [f64; 3]| power.map(|number| -2.8 * number);
    let [q, qd, qdd] = bent([
        sine.powi(8),
        8.0 * w * sine.powi(7) * cosine,
        8.0 * w * w * (7.0 * sine.powi(6) * cosine * cosine - sine.powi(8)),
    ]);
    [2.8 + q, qd, qdd]
}

/// Noise of the velocities is larger in the torques of an arm that reaches out.
#[test]
fn an_arm_that_reaches_out_collides_with_nothing() {
    let mut robot = shipped("planar2");
    // a light upper arm: stretched, the first joint feels four times the inertia
    let upper = &mut robot.joints[0].row.link;
    (upper.mass, upper.inertia.zz) = (0.1, 0.05 * upper.inertia.zz);
    let settings = Settings::default();
    let mut blind_alarms = 0;
    for seed in 41..45 {
        let noisy = |disturbed: fn(f64, &[f64], &mut [f64])| {
            let mut motion = along(&robot, (seed, 0.002), reaching, disturbed);
            let mut rng = Rng::with_seed(seed + 100);
            motion.qd.iter_mut().flatten().for_each(|rate| *rate += 0.02 * normal(&mut rng));
            Signals::new(&robot, &motion, settings.gain).expect("a motion of the robot")
        };
        let own = |signals: &Signals| ContactNoise::of(signals, 0..signals.time.len()).expect("long enough");
        let external = |signals: &Signals| contacts(signals, &own(signals), &settings).expect("two joints");
        let free = noisy(|_, _, _| {});
        assert_eq!(external(&free), [], "{seed}");
        let mut blind = free.clone();
        blind.inertia = vec![vec![0.0; blind.time.len()]; 2];
        blind_alarms += external(&blind).len();
        let hit = external(&noisy(|time, _, tau| tau[0] += if (16.0..16.2).contains(&time) { 15.0 } else { 0.0 }));
        assert!(hit.len() == 1 && (16.0..16.05).contains(&hit[0].start), "{seed}: {hit:?}");
    }
    println!("events of those who do not know the inertia: {blind_alarms}");
    assert!(blind_alarms > 0, "noise is the same everywhere");
}

/// What a filter makes of friction that turns back at once: it spreads to both sides.
#[test]
fn a_filter_before_the_watch_is_no_event() {
    let mut robot = shipped("planar2");
    for joint in &mut robot.joints {
        joint.motor = Some(Motor { inertia: 0.0, gear_ratio: 1.0, viscous: 0.3, coulomb: [6.0, -6.0] });
    }
    let mut free = motion(&robot, 61, |_, _, _| {});
    // a log of 25 Hz
    let motion = &mut free;
    let lists = [&mut motion.q, &mut motion.qd, &mut motion.qdd, &mut motion.tau].into_iter().flatten();
    for list in lists.chain([&mut motion.time]) {
        *list = list.iter().step_by(10).copied().collect();
    }
    for tau in &mut free.tau {
        let sharp = tau.clone();
        for at in 2..sharp.len() - 2 {
            tau[at] = 0.3 * sharp[at] + 0.25 * (sharp[at - 1] + sharp[at + 1]) + 0.1 * (sharp[at - 2] + sharp[at + 2]);
        }
    }
    let settings = Settings::default();
    let signals = Signals::new(&robot, &free, settings.gain).expect("a motion of the robot");
    let noise = ContactNoise::of(&signals, 0..free.len()).expect("long enough");
    assert_eq!(contacts(&signals, &noise, &settings).expect("two joints"), []);
}
