//! Coulomb and viscous friction: the log names one of both, and says where the other one would explain it almost as
//! well.

use rne_identify::{MotionError, Stretches};
use rne_logs::Motion;
use rne_model::Robot;
use rne_watch::{Baseline, Cause, Changes, Event};

const ROD: &str = "
format: 1
name: rod
source: own
convention: standard
gravity: [0, -9.81, 0]
joints:
  - type: revolute
    dh: {theta: 0, d: 0, a: 0.5, alpha: 0}
    link: {mass: 2, com: [-0.25, 0, 0], inertia: {zz: 0.05}}
";

/// s: between two speeds.
const RAMP: f64 = 0.2;

const STEP: f64 = 0.01;

/// Coulomb friction, N m, and viscous friction, N m s/rad, of the rod.
const FRICTION: [f64; 2] = [1.0, 0.5];

/// The rod swings by 2 rad to and fro for a minute, each rad at one of the speeds, rad/s; with noise of 0.02 N m.
fn swings(speeds: &[f64], [coulomb, viscous]: [f64; 2], seed: u64) -> Motion {
    let mut rng = fastrand::Rng::with_seed(seed);
    let ways = speeds.iter().cycle().zip([1.0, 1.0, -1.0, -1.0].into_iter().cycle());
    // every speed is driven in both directions
    let ways = ways.map(|(speed, sign)| speed * sign);
    let (mut motion, mut q, mut before) = (Motion::default(), -1.0, 0.0);
    let (mut lists, mut time) = ([const { Vec::new() }; 4], 0.0);
    for speed in ways {
        let duration = 1.0 / f64::abs(speed) + RAMP;
        let mut since = 0.0;
        while since < duration {
            let part = f64::min(since / RAMP, 1.0);
            let blend = 0.5 * (1.0 - (std::f64::consts::PI * part).cos());
            let slope = 0.5 * std::f64::consts::PI / RAMP * (std::f64::consts::PI * part).sin();
            let (qd, qdd) = (before + blend * (speed - before), slope * (speed - before));
            // 2 kg at 0.25 m; 0.05 + 2 (0.25)² kg m² about the hinge
            let model = 0.175 * qdd + 2.0 * 9.81 * 0.25 * f64::cos(q);
            let noise = 0.04 * (rng.f64() - 0.5);
            let tau = model + viscous * qd + coulomb * (qd / 1e-3).tanh() + noise;
            motion.time.push(time);
            lists.iter_mut().zip([q, qd, qdd, tau]).for_each(|(list, number)| list.push(number));
            (q, time, since) = (q + STEP * qd, time + STEP, since + STEP);
        }
        before = speed;
        if time > 60.0 {
            break;
        }
    }
    [motion.q, motion.qd, motion.qdd, motion.tau] = lists.map(|list| vec![list]);
    motion
}

fn event(speeds: &[f64], friction: [f64; 2]) -> Event {
    let robot = Robot::from_yaml(ROD).unwrap_or_else(|report| panic!("{report}"));
    let structure = Baseline::structure(&robot, 4.0);
    let quiet = swings(&[0.3, 0.9, 0.5, 0.7], FRICTION, 1);
    let baseline =
        Baseline::of(&structure, |take| -> Result<(), MotionError> { take(0, &quiet) }).expect("long enough");
    let mut stretches = Stretches::new(&structure, &baseline.model);
    stretches.absorb(&structure, 0, &swings(speeds, friction, 2)).expect("a motion of the rod");
    let changes = Changes::of(&structure, &baseline, &stretches).expect("long enough");
    let [event] = &changes.events[..] else { panic!("{speeds:?}: {:?}", changes.events) };
    assert_eq!((event.cause, event.joint), (Cause::Friction, Some(0)), "{event:?}");
    event.clone()
}

/// Where each rad takes 1/v, the speed explains the part (Σ v t)² / (Σ t Σ v² t) of Coulomb friction, t = 1/v: 0.56
/// of two ways at 0.2 and 1 rad/s, 0.99 of two at 0.8 and 1 rad/s.
#[test]
fn the_other_friction_is_a_rival_where_speeds_are_alike() {
    for (friction, name) in [([2.0, 0.5], "coulomb"), ([1.0, 2.0], "viscous")] {
        let apart = event(&[0.2, 1.0], friction);
        assert_eq!((apart.parameter, &apart.rivals[..]), (name, &[][..]), "{apart:?}");
        let alike = event(&[0.8, 1.0], friction);
        let both = [&[alike.parameter], &alike.rivals[..]].concat();
        assert!(both == ["coulomb", "viscous"] || both == ["viscous", "coulomb"], "{alike:?}");
    }
}
