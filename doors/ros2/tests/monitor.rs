//! Messages of all kinds to the monitor, without ROS: what it computes, what it refuses, and what the diagnostics say.

use std::path::Path;

use rne_convert::Selection;
use rne_machine::CompiledArm;
use rne_ros2::messages::{DiagnosticStatus, ERROR, Header, JointState, OK, STALE, Time, WARN};
use rne_ros2::{Fault, Lacking, Monitor, Settings, Source, arm};

/// The time of the first message, ns.
const BEGIN: i64 = 1_700_000_000_000_000_000;

/// A rod of 2 kg without inertia about its centre, which turns about a level axis at its end.
const ROD: &str = "
format: 1
name: rod
source: own
convention: standard
gravity: [0, -9.81, 0]
joints:
  - name: hinge
    type: revolute
    dh: {theta: 0, d: 0, a: 0.8, alpha: 0}
    link: {mass: 2.0, com: [-0.4, 0, 0]}
";

fn puma() -> CompiledArm {
    arm::open(Path::new("puma560"), Selection::default()).expect("a shipped robot")
}

fn monitor(settings: Settings) -> Monitor {
    Monitor::new(puma(), settings).unwrap_or_else(|error| panic!("{error}"))
}

/// A message at a time after the beginning, ms, with the numbers 0.1, 0.2, … as positions.
fn message(names: &[&str], ms: i64) -> JointState {
    let count = u32::try_from(names.len()).expect("few");
    let numbers = |by: f64| (1..=count).map(|joint| by * f64::from(joint)).collect();
    JointState {
        header: Header { stamp: Time::of_nanoseconds(BEGIN + ms * 1_000_000), frame_id: "base".to_owned() },
        name: names.iter().map(|name| (*name).to_owned()).collect(),
        position: numbers(0.1),
        velocity: numbers(0.2),
        effort: numbers(1.0),
    }
}

/// A change that makes a good message a bad one.
type Change = fn(&mut JointState);

const JOINTS: [&str; 6] = ["j1", "j2", "j3", "j4", "j5", "j6"];

fn sent(monitor: &mut Monitor, message: &JointState) -> Result<rne_ros2::Torques, Fault> {
    monitor.update(message, message.header.stamp)
}

/// Both parts of the diagnostics at a time after the beginning, ms.
fn diagnostics(monitor: &mut Monitor, ms: i64) -> [DiagnosticStatus; 2] {
    let source = Source { node: "rne", topic: "/joint_states", publishers: 1 };
    let now = Time::of_nanoseconds(BEGIN + ms * 1_000_000);
    monitor.diagnostics(now, &source).status.try_into().expect("two parts")
}

fn count(status: &DiagnosticStatus, key: &str) -> u64 {
    let value = status.values.iter().find(|pair| pair.key == key);
    value.map_or(0, |pair| pair.value.parse().expect(key))
}

/// m g l cos q of a rod, and the torque of whoever pushes it through the low-pass of the observer.
#[test]
fn a_rod_is_held_and_pushed() {
    let arm = CompiledArm::from_yaml(ROD).expect("a robot file");
    let mut monitor = Monitor::new(arm, Settings { gain: 5.0, ..Settings::default() }).expect("settings");
    let held = |q: f64| 2.0 * 9.81 * 0.4 * q.cos();
    let (q, push) = (0.3, 1.5);
    // ticks of unequal length: the response depends on the time alone
    let mut ms = 0;
    for step in [0, 1, 7, 2, 30, 1, 1, 4] {
        ms += step;
        let mut message = message(&["hinge"], ms);
        // the actuator holds the arm still against what pushes
        (message.position, message.velocity, message.effort) = (vec![q], vec![0.0], vec![held(q) - push]);
        let torques = sent(&mut monitor, &message).expect("a good message");
        assert!((torques.gravity.effort[0] - held(q)).abs() < 1e-12);
        assert_eq!(torques.gravity.header, message.header);
        assert!(torques.gravity.position.is_empty() && torques.gravity.velocity.is_empty());
        match torques.external {
            Err(lacking) => assert_eq!((lacking, ms), (Lacking::First, 0)),
            #[allow(clippy::cast_precision_loss)] // few
            Ok(external) => {
                let expected = -push * (-std::f64::consts::TAU * 5.0 * 1e-3 * ms as f64).exp_m1();
                assert!((external.effort[0] - expected).abs() < 1e-9, "{ms} ms: {external:?}, not {expected}");
            }
        }
    }
    assert_eq!(diagnostics(&mut monitor, ms).map(|status| status.level), [OK, OK]);
}

#[test]
fn joints_are_matched_by_name_in_any_order_and_among_others() {
    let [mut straight, mut mixed] = [monitor(Settings::default()), monitor(Settings::default())];
    let names = ["j3", "finger", "j1", "j6", "j2", "thumb", "j5", "j4"];
    for ms in 0..20 {
        let in_order = message(&JOINTS, ms);
        let mut other = message(&names, ms);
        for (place, name) in names.iter().enumerate() {
            let joint = JOINTS.iter().position(|joint| joint == name);
            let take = |list: &[f64]| joint.map_or(f64::NAN, |joint| list[joint]);
            other.position[place] = take(&in_order.position);
            other.velocity[place] = take(&in_order.velocity);
            other.effort[place] = take(&in_order.effort);
        }
        // the numbers of other joints may be anything
        let [a, b] =
            [sent(&mut straight, &in_order), sent(&mut mixed, &other)].map(|torques| torques.expect("matched"));
        assert_eq!((&a.gravity.name, &a), (&JOINTS.map(str::to_owned).to_vec(), &b));
    }
    // a message of another part of the robot is no fault
    assert_eq!(sent(&mut mixed, &message(&["finger", "thumb"], 20)), Err(Fault::Foreign));
    assert_eq!(diagnostics(&mut mixed, 20).map(|status| status.level), [OK, OK]);
    // one with a part of the joints is
    let missing = sent(&mut mixed, &message(&["j1", "j2", "finger"], 21)).expect_err("joints are missing");
    assert_eq!(missing, Fault::Incomplete { joint: "j3".to_owned() });
    let [states, _] = diagnostics(&mut mixed, 21);
    assert_eq!((states.level, count(&states, "messages of other joints")), (ERROR, 1));
}

#[test]
fn other_names_are_taken_in_their_order_with_a_warning() {
    let mut monitor = monitor(Settings::default());
    let urdf = ["shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3"];
    let torques = sent(&mut monitor, &message(&urdf, 0)).expect("six joints");
    assert_eq!(torques.gravity.name, urdf);
    assert_eq!(torques.gravity.effort, puma().gravity_torques(&message(&urdf, 0).position).unwrap());
    // these are their names from now on, in whatever order
    let mut back = message(&urdf, 1);
    for list in [&mut back.position, &mut back.velocity, &mut back.effort] {
        list.reverse();
    }
    back.name.reverse();
    let again = sent(&mut monitor, &back).expect("the same names");
    assert_eq!(again.gravity.effort, torques.gravity.effort);
    let [states, _] = diagnostics(&mut monitor, 1);
    assert!(states.level == WARN && states.message.contains("--joints"), "{states:?}");
    assert!(states.values.iter().any(|pair| pair.value.starts_with("shoulder_pan = j1, ")), "{states:?}");
    // other six are of another arm, such as a hand
    assert_eq!(sent(&mut monitor, &message(&["a", "b", "c", "d", "e", "f"], 2)), Err(Fault::Foreign));
    // until a message has the names of the robot: the first one was of another arm
    let torques = sent(&mut monitor, &message(&JOINTS, 3)).expect("the names of the robot");
    assert_eq!((torques.gravity.name, torques.external), (JOINTS.map(str::to_owned).to_vec(), Err(Lacking::First)));
    diagnostics(&mut monitor, 3);
    assert_eq!(sent(&mut monitor, &message(&urdf, 4)), Err(Fault::Foreign));
    assert!(sent(&mut monitor, &message(&JOINTS, 5)).expect("the names of the robot").external.is_ok());
    assert_eq!(diagnostics(&mut monitor, 5).map(|status| status.level), [OK, OK]);
}

#[test]
fn joints_that_cannot_be_matched_are_refused() {
    for (names, part) in [
        (&["a", "b", "c"][..], "the 3 joints a, b, c, but the arm has the 6 joints j1, j2, j3, j4, j5, j6"),
        (&["a", "b", "c", "d", "e", "f", "g"], "the 7 joints"),
        (&["j2", "j1", "c", "d", "e", "f"], "j1 has another place"),
        (&["a", "a", "a", "a", "a", "a"], "lacks the joint j1"),
    ] {
        let mut monitor = monitor(Settings::default());
        let fault = sent(&mut monitor, &message(names, 0)).expect_err("no match");
        assert!(fault.to_string().contains(part), "{names:?}: {fault}");
        let [states, external] = diagnostics(&mut monitor, 0);
        assert_eq!((states.level, external.level), (ERROR, STALE));
        assert!(states.message.starts_with("1 of 1 messages are not used; the last one: "), "{}", states.message);
    }
    let mut monitor = monitor(Settings::default());
    assert_eq!(sent(&mut monitor, &message(&[], 0)), Err(Fault::Foreign));
}

#[test]
fn names_that_are_given_are_those_of_the_messages() {
    let names = ["f", "e", "d", "c", "b", "a"].map(str::to_owned);
    let settings = |joints: &[String]| Settings { joints: Some(joints.to_vec()), ..Settings::default() };
    let mut named = monitor(settings(&names));
    let torques = sent(&mut named, &message(&["a", "b", "c", "d", "e", "f"], 0)).expect("all of them");
    let mut positions = message(&JOINTS, 0).position;
    positions.reverse();
    assert_eq!(torques.gravity.effort, puma().gravity_torques(&positions).unwrap());
    assert_eq!(sent(&mut named, &message(&JOINTS, 1)), Err(Fault::Foreign));
    for (joints, why) in
        [(&names[..5], "--joints has 5 names, but puma560 has 6"), (&[names[0].clone(), names[0].clone()], "2")]
    {
        let error = Monitor::new(puma(), settings(joints)).expect_err("wrong names");
        assert!(error.contains(why), "{error}");
    }
    let mut twice = names.clone();
    twice[3] = "f".to_owned();
    assert_eq!(Monitor::new(puma(), settings(&twice)).expect_err("twice"), "--joints names f twice");
}

#[test]
fn settings_are_numbers_that_are_possible() {
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for settings in [
            Settings { gain: wrong, ..Settings::default() },
            Settings { gap: wrong, ..Settings::default() },
            Settings { stale_after: if wrong == 0.0 { -0.5 } else { wrong }, ..Settings::default() },
        ] {
            let error = Monitor::new(puma(), settings).expect_err("a wrong setting");
            assert!(error.starts_with("--") && error.contains("it must be a number"), "{error}");
        }
    }
}

/// Gravity torques need positions alone; external torques begin anew when velocities and efforts are there again.
#[test]
fn missing_velocities_and_efforts_leave_gravity_torques() {
    let mut monitor = monitor(Settings::default());
    let mut ms = 0;
    let mut next = |monitor: &mut Monitor, change: Change| {
        ms += 1;
        let mut message = message(&JOINTS, ms);
        change(&mut message);
        let torques = sent(monitor, &message).expect("positions are there");
        assert_eq!(torques.gravity.effort, puma().gravity_torques(&message.position).unwrap());
        (torques.external.map(|_| ()), ms)
    };
    let length = |what, found| Lacking::Length { what, names: 6, found };
    let changes: [(Change, Lacking); 6] = [
        (|message| message.velocity.clear(), Lacking::Missing { what: "velocities" }),
        (|message| message.effort.clear(), Lacking::Missing { what: "efforts" }),
        (|message| message.velocity.truncate(5), length("velocities", 5)),
        (|message| message.effort.push(0.0), length("efforts", 7)),
        (
            |message| message.effort[2] = f64::INFINITY,
            Lacking::Number { what: "effort", joint: "j3".to_owned(), value: f64::INFINITY },
        ),
        (|message| message.velocity[0] = 1e200, Lacking::Torques(String::new())),
    ];
    for (change, wanted) in changes {
        assert_eq!(next(&mut monitor, |_| ()).0, Err(Lacking::First));
        assert_eq!(next(&mut monitor, |_| ()).0, Ok(()));
        let (Err(lacking), ms) = next(&mut monitor, change) else { panic!("{wanted:?}") };
        match (&lacking, &wanted) {
            (Lacking::Torques(_), Lacking::Torques(_)) => {}
            _ => assert_eq!(lacking, wanted),
        }
        let [states, external] = diagnostics(&mut monitor, ms);
        assert_eq!((states.level, external.level), (OK, WARN), "{external:?}");
        let said = format!("2 of 3 messages give no external torques: {lacking}");
        assert_eq!(external.message, said);
    }
    let (Err(lacking), ms) = next(&mut monitor, |message| message.velocity[4] = f64::NAN) else { panic!("NaN") };
    assert_eq!(lacking.to_string(), "the velocity of j5 is NaN, which is not finite");
    let [_, external] = diagnostics(&mut monitor, ms);
    assert_eq!(count(&external, "velocity or effort not finite"), 2);
    assert_eq!(count(&external, "wrong number of velocities or efforts"), 2);
    assert_eq!([count(&external, "without velocities"), count(&external, "without efforts")], [1, 1]);
}

#[test]
fn positions_that_are_none_give_nothing() {
    let mut monitor = monitor(Settings::default());
    sent(&mut monitor, &message(&JOINTS, 0)).expect("a good message");
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut message = message(&JOINTS, 1);
        message.position[3] = value;
        let fault = sent(&mut monitor, &message).expect_err("no position");
        assert_eq!(fault.to_string(), format!("the position of j4 is {value}, which is not finite"));
    }
    for positions in [0, 5, 7] {
        let mut message = message(&JOINTS, 1);
        message.position.resize(positions, 0.0);
        assert_eq!(sent(&mut monitor, &message), Err(Fault::Positions { names: 6, positions }));
    }
    // the observer goes on from before
    let torques = sent(&mut monitor, &message(&JOINTS, 2)).expect("a good message");
    assert!(torques.external.is_ok());
    let [states, _] = diagnostics(&mut monitor, 2);
    let counts = ["received", "used", "rejected: position not finite", "rejected: number of positions"];
    assert_eq!((states.level, counts.map(|key| count(&states, key))), (WARN, [8, 2, 3, 3]));
}

#[test]
fn stamps_must_be_of_now_and_later_than_the_last() {
    let mut monitor = monitor(Settings::default());
    let at = |monitor: &mut Monitor, stamp: i64, clock: i64| {
        let message = message(&JOINTS, stamp);
        monitor
            .update(&message, Time::of_nanoseconds(BEGIN + clock * 1_000_000))
            .map(|torques| torques.external.is_ok())
    };
    assert_eq!(at(&mut monitor, 0, 500), Ok(false));
    assert_eq!(at(&mut monitor, 10, 10), Ok(true));
    for (earlier, seconds) in [(10, 0.0), (9, 1e-3), (0, 1e-2)] {
        let fault = at(&mut monitor, earlier, 10).expect_err("not later");
        assert!(matches!(fault, Fault::NotLater { by } if (by - seconds).abs() < 1e-12), "{fault}");
    }
    let old = at(&mut monitor, 20, 521).expect_err("old").to_string();
    assert!(old.starts_with("header.stamp of the message is 0.501 s old, more than 0.5 s;"), "{old}");
    let future = at(&mut monitor, 1021, 520).expect_err("of the future").to_string();
    assert!(future.starts_with("header.stamp of the message is 0.501 s in the future"), "{future}");
    // a gap: the observer begins anew
    assert_eq!(at(&mut monitor, 60, 60), Ok(true));
    assert_eq!(at(&mut monitor, 111, 111), Ok(false));
    assert_eq!(at(&mut monitor, 112, 112), Ok(true));
    let mut unstamped = message(&JOINTS, 0);
    unstamped.header.stamp = Time::default();
    assert_eq!(monitor.update(&unstamped, Time::default()), Err(Fault::NoStamp));
    let [states, external] = diagnostics(&mut monitor, 112);
    let keys = ["rejected: stamp not later", "rejected: stale stamp", "rejected: no stamp"];
    assert_eq!(keys.map(|key| count(&states, key)), [3, 2, 1]);
    assert_eq!(count(&external, "beginnings of the observer"), 2);
    assert!(external.level == WARN && external.message.starts_with("the observer began anew 1 times"), "{external:?}");
    // a bag or a simulation, from its beginning once more
    let mut simulated = self::monitor(Settings { stale_after: 0.0, ..Settings::default() });
    let begin = |simulated: &mut Monitor, stamp| at(simulated, stamp, 1_000_000_000);
    assert_eq!(
        [0, 1, 5000, 5001, 0, 1].map(|stamp| begin(&mut simulated, stamp).unwrap()),
        [false, true, false, true, false, true]
    );
}

#[test]
fn silence_is_told_with_its_reason() {
    let mut monitor = monitor(Settings::default());
    let [states, external] = diagnostics(&mut monitor, 0);
    assert_eq!((states.level, external.level), (STALE, STALE));
    assert_eq!(
        states.message,
        "no message on /joint_states since the node began; a publisher is connected and sends nothing"
    );
    sent(&mut monitor, &message(&JOINTS, 0)).expect("a good message");
    diagnostics(&mut monitor, 100);
    let source = Source { node: "rne", topic: "/joint_states", publishers: 0 };
    let later = Time::of_nanoseconds(BEGIN + 2_345_000_000);
    let written = monitor.diagnostics(later, &source);
    let states = &written.status[0];
    assert!(
        states.message.starts_with("no message on /joint_states for 2.345 s; no publisher is connected"),
        "{states:?}"
    );
    assert_eq!((states.name.as_str(), states.hardware_id.as_str()), ("rne: joint states", "puma560"));
    assert_eq!(written.header.stamp, later);
    // lost messages, and those that cannot be read or published
    monitor.lost(3);
    sent(&mut monitor, &message(&JOINTS, 1)).expect("a good message");
    let [states, _] = diagnostics(&mut monitor, 1);
    assert_eq!((states.level, states.message.as_str()), (WARN, "3 messages were lost before the node"));
    monitor.failed("not published", "torques were not published".to_owned());
    sent(&mut monitor, &message(&JOINTS, 2)).expect("a good message");
    let [states, _] = diagnostics(&mut monitor, 2);
    assert_eq!((states.level, states.message.as_str()), (WARN, "torques were not published"));
    assert_eq!([count(&states, "not published"), count(&states, "lost")], [1, 3]);
}

/// No message causes a panic, and the node publishes finite numbers only.
#[test]
fn any_message_is_survived() {
    let mut random = 0x9E37_79B9_7F4A_7C15_u64;
    let mut draw = |below: usize| {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        usize::try_from(random % below as u64).expect("small")
    };
    let numbers = [0.0, 0.4, -1.0, f64::NAN, f64::INFINITY, 1e308, -1e160, 5e-324];
    let mut used = 0;
    for settings in [Settings::default(), Settings { stale_after: 0.0, gap: 1e9, ..Settings::default() }] {
        let mut monitor = monitor(settings);
        for ms in 0..20_000 {
            let mut message = message(&JOINTS, ms);
            for _ in 0..draw(4) {
                let (kind, place, number) = (draw(6), draw(6), numbers[draw(numbers.len())]);
                let list = match kind {
                    0 => &mut message.position,
                    1 => &mut message.velocity,
                    2 => &mut message.effort,
                    3 => {
                        message.name.swap(place, 0);
                        continue;
                    }
                    4 => {
                        let sec = [0, i32::MIN, i32::MAX, -1, message.header.stamp.sec][draw(5)];
                        message.header.stamp = Time { sec, nanosec: [0, 1, u32::MAX][draw(3)] };
                        continue;
                    }
                    _ => {
                        message.name[place].push('x');
                        continue;
                    }
                };
                if draw(3) == 0 {
                    list.truncate(place);
                } else if let Some(element) = list.get_mut(place) {
                    *element = number;
                }
            }
            let now = Time::of_nanoseconds(BEGIN + ms * 1_000_000);
            if let Ok(torques) = monitor.update(&message, now) {
                let external = torques.external.map(|external| external.effort).unwrap_or_default();
                assert!(torques.gravity.effort.iter().chain(&external).all(|torque| torque.is_finite()));
                used += 1;
            }
            if draw(100) == 0 {
                let written = diagnostics(&mut monitor, ms);
                assert!(written.iter().all(|status| status.level <= STALE && !status.message.is_empty()));
            }
        }
    }
    assert!(used > 5_000, "{used} messages were used");
}
