//! Logs that are made up, of a torso with two arms: what is found is what was put in.

use rne_identify::{MotionError, Options, Payload, Structure, identify, prediction_errors};
use rne_logs::Motion;
use rne_model::{Inertia, Link, Reader, Robot};
use rne_runtime::DynArm;

const TORSO: &str = include_str!("torso.yaml");

fn read(text: &str) -> Robot {
    Reader::new("torso").trees().read(text).unwrap_or_else(|report| panic!("{report}\n{text}")).robot
}

/// Positions, rates and accelerations at a time: sums of four sines for each joint, no two of one frequency.
fn state(joint: usize, time: f64) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for k in 1..=4_u32 {
        let (k, joint) = (f64::from(k), f64::from(u32::try_from(joint).unwrap()));
        let (amplitude, rate) = (0.5 / k, std::f64::consts::TAU * (0.17 * k + 0.013 * joint));
        let (sin, cos) = (rate * time + 1.3 * k + 2.1 * joint).sin_cos();
        sums[0] += amplitude * sin;
        sums[1] += amplitude * rate * cos;
        sums[2] -= amplitude * rate * rate * sin;
    }
    sums
}

/// The log of a robot, with the friction of its file, from a time on.
fn log(robot: &Robot, start: f64) -> Motion {
    let (arm, dof) = (DynArm::from_robot(robot), robot.dof());
    let empty = || vec![Vec::new(); dof];
    let mut motion =
        Motion { time: Vec::new(), q: empty(), qd: empty(), qdd: empty(), tau: empty(), ..Motion::default() };
    for sample in 0..6000_u32 {
        let time = start + f64::from(sample) / 200.0;
        let states: Vec<[f64; 3]> = (0..dof).map(|joint| state(joint, time)).collect();
        let [q, qd, qdd] = [0, 1, 2].map(|of| states.iter().map(|state| state[of]).collect::<Vec<_>>());
        let torques = arm.inverse_dynamics(&q, &qd, &qdd).unwrap();
        motion.time.push(time);
        for (joint, torque) in torques.into_iter().enumerate() {
            motion.q[joint].push(q[joint]);
            motion.qd[joint].push(qd[joint]);
            motion.qdd[joint].push(qdd[joint]);
            motion.tau[joint].push(torque + robot.joints[joint].friction(qd[joint]));
        }
    }
    motion
}

#[test]
fn a_clean_log_of_a_tree_gives_the_tree_back() {
    let robot = read(TORSO);
    let mut options = Options::default();
    (options.widths, options.displacements, options.delay) = (vec![0.025, 0.05], Vec::new(), false);
    // the masses of the file are no help
    let mut unknown = robot.clone();
    unknown.joints.iter_mut().for_each(|joint| joint.row.link = Link::default());
    let motion = log(&robot, 0.0);
    let found = identify(&unknown, options, 1e-4, |take| take(&motion)).unwrap();
    let parameters = found.structure.parameters();
    let truth = &parameters.regrouping * parameters.of_robot(&robot);
    for (base, truth) in found.bases.iter().zip(truth.iter()) {
        assert!((base.value - truth).abs() < 1e-6 * (1.0 + truth.abs()), "{} {} {truth}", base.name, base.value);
    }
    let text = found.robot_file("a made-up log");
    let identified = read(&text);
    assert_eq!(identified.joints[3].branch, robot.joints[3].branch);
    assert_eq!((identified.parent(3), identified.tip_on), (Some(0), Some(2)));
    // on another motion
    for error in prediction_errors(&identified, [&log(&robot, 500.0)], Some(2.0)).unwrap() {
        assert!(error.error < 1e-4, "{error:?}");
    }
}

/// No torque of an arm depends on the other arm but those of the joints that carry both.
#[test]
fn a_joint_feels_the_links_that_it_moves() {
    let robot = read(TORSO);
    let structure = Structure::new(&robot, Options::default());
    let regrouping = &structure.parameters().regrouping;
    let arm = DynArm::from_robot(&robot);
    let states: Vec<[f64; 3]> = (0..5).map(|joint| state(joint, 0.7)).collect();
    let [q, qd, qdd] = [0, 1, 2].map(|of| states.iter().map(|state| state[of]).collect::<Vec<_>>());
    let rows = arm.regressor(&q, &qd, &qdd).unwrap();
    // the columns of the kept parameters times the base parameters are the torques
    let bases = regrouping * structure.parameters().of_robot(&robot);
    let torques = arm.inverse_dynamics(&q, &qd, &qdd).unwrap();
    for (row, torque) in rows.iter().zip(&torques) {
        let kept = structure.parameters().bases.iter().zip(bases.iter()).map(|(base, value)| match base.kept {
            rne_identify::Parameter::Link(link, index) => row[link][index] * value,
            rne_identify::Parameter::Rotor(_) => 0.0,
        });
        assert!((kept.sum::<f64>() - torque).abs() < 1e-9 * (1.0 + torque.abs()));
    }
}

#[test]
fn a_payload_is_found_on_the_link_with_the_tip() {
    let robot = read(TORSO);
    let (mass, com, moment) = (1.5, [0.3, 0.02, -0.04], 0.004);
    let mut loaded = robot.clone();
    let link = &mut loaded.joints[2].row.link;
    let both = link.mass + mass;
    // two bodies as one: about the common centre of mass
    let (own, centre) = (*link, [0, 1, 2].map(|axis| (link.mass * link.com[axis] + mass * com[axis]) / both));
    let about = |mass: f64, com: [f64; 3], tensor: &Inertia| {
        let [x, y, z] = [0, 1, 2].map(|axis| com[axis] - centre[axis]);
        [
            tensor.xx + mass * (y * y + z * z),
            tensor.yy + mass * (x * x + z * z),
            tensor.zz + mass * (x * x + y * y),
            tensor.xy - mass * x * y,
            tensor.xz - mass * x * z,
            tensor.yz - mass * y * z,
        ]
    };
    let cube = Inertia { xx: moment, yy: moment, zz: moment, ..Inertia::default() };
    let (a, b) = (about(own.mass, own.com, &own.inertia), about(mass, com, &cube));
    let [xx, yy, zz, xy, xz, yz] = std::array::from_fn(|at| a[at] + b[at]);
    *link = Link { mass: both, com: centre, inertia: Inertia { xx, yy, zz, xy, xz, yz }, ..*link };
    let motion = log(&loaded, 0.0);
    let found = Payload::identify(&robot, 2.0, |take| -> Result<(), MotionError> { take(&motion) }).unwrap();
    assert!(found.is_there() && (found.mass.value - mass).abs() < 0.02, "{found:?}");
    // from the tip, whose axes are those of the link
    let placement = robot.tip().placement;
    assert!(placement.rpy.iter().all(|angle| angle.radians == 0.0));
    for ((found, com), tip) in found.com.iter().zip(com).zip(placement.xyz) {
        assert!((found.value - (com - tip)).abs() < 0.01, "{found:?} {com} {tip}");
    }
    let with = found.added_to(&robot).expect("a body");
    assert!((with.joints[2].row.link.mass - both).abs() < 0.02 && with.joints[4] == robot.joints[4]);
    assert!(found.robot_file(&with, true, "a made-up log").contains("added to the link of left_elbow"));
}
