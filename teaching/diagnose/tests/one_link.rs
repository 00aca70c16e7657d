//! Slips in one row, joint or link of random arms, made here by hand, with torques of four digits.

use std::fmt::Write;

use fastrand::Rng;
use nalgebra::{Matrix3, Matrix4, Vector3};
use rne_diagnose::{Cause, Diagnosis, Observation, Slip, diagnose, diagnose_nearly, near_miss};
use rne_model::{Angle, Convention, Inertia, Link, Reader, Robot, Row};
use rne_runtime::DynArm;

/// So many arms, each with every slip; twenty-five times as many where all is asked for.
const ARMS: u32 = 20;

/// An arm of three to six joints, as a robot file.
fn arm(rng: &mut Rng, convention: Convention) -> Robot {
    let dof = rng.usize(3..7);
    let mut number = |low: f64, high: f64| low + (high - low) * rng.f64();
    let word = if convention == Convention::Standard { "standard" } else { "modified" };
    let mut text = format!(
        "format: 1\nname: arm\nsource: a test\nconvention: {word}\ngravity: [{}, {}, -9.5]\njoints:\n",
        number(-1.0, 1.0),
        number(-1.0, 1.0)
    );
    for _ in 0..dof {
        let [theta, d, a, alpha] =
            [number(-3.0, 3.0), number(-0.4, 0.4), number(-0.5, 0.5), number(-1.5, 1.5)].map(|x| format!("{x:.3}"));
        let com = [(); 3].map(|()| format!("{:.3}", number(-0.3, 0.3))).join(", ");
        let [x, y, z] = [(); 3].map(|()| number(0.01, 0.05));
        let products = [(); 3].map(|()| number(-0.004, 0.004));
        let _ = write!(
            text,
            "  - type: revolute\n    dh: {{theta: {theta}, d: {d}, a: {a}, alpha: {alpha}}}\n    link: {{mass: {:.2}, \
             com: [{com}], inertia: {{xx: {:.4}, yy: {:.4}, zz: {:.4}, xy: {:.4}, xz: {:.4}, yz: {:.4}}}}}\n",
            number(0.5, 8.0),
            y + z,
            x + z,
            x + y,
            products[0],
            products[1],
            products[2],
        );
    }
    Reader::new("arm").read(&text).unwrap_or_else(|report| panic!("{report}\n{text}")).robot
}

/// The matrix of a row.
fn placement(row: &Row, convention: Convention) -> Matrix4<f64> {
    let about = |axis, angle: Angle| Matrix4::from_axis_angle(&axis, angle.radians);
    let along = |x, z| Matrix4::new_translation(&Vector3::new(x, 0.0, z));
    let turn = about(Vector3::z_axis(), row.dh.theta);
    let twist = about(Vector3::x_axis(), row.dh.alpha);
    match convention {
        Convention::Standard => turn * along(0.0, row.dh.d) * along(row.dh.a, 0.0) * twist,
        Convention::Modified => twist * along(row.dh.a, 0.0) * turn * along(0.0, row.dh.d),
    }
}

/// The parallel axis term m (c² 1 - c cᵀ), added to an inertia `times` times.
fn shifted(link: &Link, times: f64) -> Inertia {
    let (c, m) = (Vector3::from(link.com), link.mass);
    let all = Matrix3::from(link.inertia.rows()) + (Matrix3::identity() * c.dot(&c) - c * c.transpose()) * m * times;
    Inertia { xx: all[(0, 0)], yy: all[(1, 1)], zz: all[(2, 2)], xy: all[(0, 1)], xz: all[(0, 2)], yz: all[(1, 2)] }
}

/// The arm of another program, with a slip at a joint, and a factor on speed, acceleration and torque of that joint;
/// `None` if the slip is impossible there.
fn spoilt(robot: &Robot, joint: usize, slip: &str) -> Option<(Robot, f64)> {
    let (mut other, mut factor) = (robot.clone(), 1.0);
    let next = robot.rows().nth(joint + 1).copied();
    let row = &mut other.joints[joint].row;
    let old = *row;
    let link = &mut row.link;
    match slip {
        "alpha_of_one_row_reversed" => row.dh.alpha = Angle::new(-row.dh.alpha.radians),
        "theta_of_one_row_reversed" => row.dh.theta = Angle::new(-row.dh.theta.radians),
        "com_of_one_link_reversed" => link.com[1] = -link.com[1],
        "com_vector_of_one_link_reversed" => link.com = link.com.map(|c| -c),
        "inertia_of_one_link_about_origin" => link.inertia = shifted(&old.link, -1.0),
        "inertia_of_one_link_shifted" => link.inertia = shifted(&old.link, 1.0),
        "products_of_one_link" => {
            let Inertia { xx, yy, zz, xy, xz, yz } = link.inertia;
            link.inertia = Inertia { xx, yy, zz, xy: -xy, xz: -xz, yz: -yz };
        }
        // where the next frame, or the one before, is in axes of the link frame
        "com_of_one_link_from_other_end" if robot.convention == Convention::Standard => {
            let before = placement(&old, robot.convention).try_inverse()?.column(3).xyz();
            link.com = (Vector3::from(link.com) + before).into();
        }
        "com_of_one_link_from_other_end" => {
            let after = placement(&next?, robot.convention).column(3).xyz();
            link.com = (Vector3::from(link.com) + after).into();
        }
        "mass_of_one_link" => link.mass *= 1000.0,
        "a_and_d_of_one_row_exchanged" => (row.dh.a, row.dh.d) = (row.dh.d, row.dh.a),
        "alpha_and_theta_of_one_row_exchanged" => (row.dh.alpha, row.dh.theta) = (row.dh.theta, row.dh.alpha),
        "inertia_of_another_link" => link.inertia = next?.link.inertia,
        "zero_of_one_joint" => row.dh.theta = Angle::new(row.dh.theta.radians + std::f64::consts::PI / 2.0),
        "axis_of_one_joint" => factor = 2.0_f64.sqrt(),
        _ => unreachable!("{slip}"),
    }
    Some((other, factor))
}

const SLIPS: [&str; 14] = [
    "alpha_of_one_row_reversed",
    "theta_of_one_row_reversed",
    "com_of_one_link_reversed",
    "com_vector_of_one_link_reversed",
    "inertia_of_one_link_about_origin",
    "inertia_of_one_link_shifted",
    "products_of_one_link",
    "com_of_one_link_from_other_end",
    "mass_of_one_link",
    "a_and_d_of_one_row_exchanged",
    "alpha_and_theta_of_one_row_exchanged",
    "inertia_of_another_link",
    "zero_of_one_joint",
    "axis_of_one_joint",
];

/// A state, and the torques of a program that prints four digits.
fn seen(robot: &Robot, other: &Robot, joint: usize, factor: f64, rng: &mut Rng) -> (Observation, bool) {
    let mut list = |size: f64| (0..robot.dof()).map(|_| (2.0 * rng.f64() - 1.0) * size).collect::<Vec<_>>();
    let (q, qd, qdd) = (list(1.5), list(2.0), list(4.0));
    let right = DynArm::from_robot(robot).inverse_dynamics(&q, &qd, &qdd).expect("one number for each joint");
    let (mut fast, mut accelerated) = (qd.clone(), qdd.clone());
    (fast[joint], accelerated[joint]) = (fast[joint] * factor, accelerated[joint] * factor);
    let mut tau =
        DynArm::from_robot(other).inverse_dynamics(&q, &fast, &accelerated).expect("one number for each joint");
    tau[joint] *= factor;
    let digits = |tau: f64| 10_f64.powf(tau.abs().log10().floor() - 3.0);
    let resolution: Vec<f64> = tau.iter().map(|tau| 0.5 * digits(*tau)).collect();
    let tau: Vec<f64> = tau.iter().map(|tau| (tau / digits(*tau)).round() * digits(*tau)).collect();
    let differs = tau.iter().zip(&right).zip(&resolution).any(|((tau, right), half)| (tau - right).abs() > 3.0 * half);
    (Observation { q, qd, qdd, wrench: None, tau, resolution }, differs)
}

#[test]
fn slips_of_one_link_are_named() {
    let arms = if std::env::var_os("RNE_EXHAUSTIVE").is_some() { 25 * ARMS } else { ARMS };
    let (mut tried, mut alone, mut first) = (0, 0, 0);
    let mut wrong = Vec::new();
    for seed in 0..arms {
        let mut rng = Rng::with_seed(seed.into());
        let convention = if seed % 2 == 0 { Convention::Standard } else { Convention::Modified };
        let robot = arm(&mut rng, convention);
        for slip in SLIPS {
            let joint = rng.usize(..robot.dof());
            let Some((other, factor)) = spoilt(&robot, joint, slip) else { continue };
            let (seen, differs) = seen(&robot, &other, joint, factor, &mut rng);
            if !differs {
                continue;
            }
            tried += 1;
            let found = diagnose(&robot, &[seen]).expect("one number for each joint");
            let Diagnosis::Explained(found) = found else { panic!("seed {seed}, {slip} at {joint}: {found:?}") };
            let is_it = |slips: &[Slip]| slips.len() == 1 && slips[0].name() == slip;
            assert!(found.iter().any(|found| is_it(&found.slips)), "seed {seed}, {slip} at {joint}: {found:?}");
            first += u32::from(is_it(&found[0].slips));
            alone += u32::from(found.len() == 1);
            if !is_it(&found[0].slips) {
                wrong.push(format!("{slip}: {:?}", found[0].slips));
            }
        }
    }
    println!("{tried} slips; {first} named first; in {alone} cases no other slip agrees as printed");
    println!("{}", wrong.join("\n"));
    assert!(tried > 10 * arms, "{tried}");
    assert!(first * 100 >= tried * 95, "{first} of {tried}");
}

/// A slip of one link and one of the whole arm together.
#[test]
fn a_slip_of_one_link_beside_one_of_the_arm_is_named() {
    let mut named = 0;
    for seed in 0..6 {
        let mut rng = Rng::with_seed(100 + seed);
        let robot = arm(&mut rng, Convention::Standard);
        let (mut other, _) = spoilt(&robot, 1, "com_of_one_link_reversed").expect("possible");
        other.gravity = other.gravity.map(|g| -g);
        let (seen, _) = seen(&robot, &other, 1, 1.0, &mut rng);
        let found = diagnose(&robot, &[seen]).expect("one number for each joint");
        let Diagnosis::Explained(found) = found else { panic!("seed {seed}: {found:?}") };
        let names: Vec<_> = found[0].slips.iter().map(|slip| slip.name()).collect();
        named += usize::from(names == ["gravity_reversed", "com_of_one_link_reversed"]);
    }
    assert!(named >= 5, "{named}");
}

/// If no slip explains the torques, the diagnosis names the parameter of one link that comes nearest.
#[test]
fn the_nearest_is_told_where_nothing_agrees() {
    let mut rng = Rng::with_seed(7);
    let robot = arm(&mut rng, Convention::Standard);
    let mut other = robot.clone();
    other.joints[2].row.link.mass += 0.37;
    // the mass alone: the first moment and the inertia about the origin stay those of the file
    let (old, new) = (robot.joints[2].row.link, &mut other.joints[2].row.link);
    new.com = old.com.map(|c| c * old.mass / new.mass);
    new.inertia = shifted(&old, 1.0);
    new.inertia = shifted(new, -1.0);
    let (seen, differs) = seen(&robot, &other, 2, 1.0, &mut rng);
    assert!(differs);
    assert!(matches!(diagnose(&robot, std::slice::from_ref(&seen)).unwrap(), Diagnosis::Unexplained(_)));
    let found = near_miss(&robot, &[seen]).unwrap().expect("something is near");
    let Cause::Parameter { link: 2, parameter: 0, difference, .. } = found.cause else { panic!("{found:?}") };
    assert!((difference - 0.37).abs() < 0.01 && found.error < 1e-3, "{found:?}");
    assert!(
        found.says(&robot).contains("differ by one number: the mass of link 3 (joint3) is 0.369"),
        "{}",
        found.says(&robot)
    );
}

/// A mass is wrong more often alone than with its first moment.
#[test]
fn another_mass_at_the_same_centre_is_told() {
    let (mut near, mut exact) = (0, 0);
    for seed in 0..20 {
        let mut rng = Rng::with_seed(300 + seed);
        let robot = arm(&mut rng, Convention::Standard);
        let mut other = robot.clone();
        let link = rng.usize(1..robot.dof());
        let difference = robot.joints[link].row.link.mass * 0.31;
        other.joints[link].row.link.mass += difference;
        let (seen, _) = seen(&robot, &other, 2, 1.0, &mut rng);
        let Some(found) = near_miss(&robot, &[seen]).expect("one number for each joint") else { continue };
        near += 1;
        let is_exact = |of: usize, by: f64| of == link && (by - difference).abs() < 0.02 * difference;
        let Cause::Parameter { link, parameter: 10, difference, .. } = found.cause else { continue };
        exact += usize::from(is_exact(link, difference));
    }
    assert!(near >= 14 && exact >= 12, "{near} {exact}");
}

/// A slip that leaves most of a small difference is no explanation.
#[test]
fn a_small_difference_is_not_explained_by_any_small_slip() {
    let mut rng = Rng::with_seed(11);
    let tolerances = [1e-4, 1e-3, 1e-2];
    for seed in 0..20 {
        let robot = arm(&mut rng, Convention::Standard);
        let mut other = robot.clone();
        other.joints[1].row.link.mass *= 1.0 + 0.003 * f64::from(seed + 1);
        let (seen, _) = seen(&robot, &other, 1, 1.0, &mut rng);
        let found = diagnose(&robot, std::slice::from_ref(&seen)).expect("one number for each joint");
        let Diagnosis::Unexplained(right) = found else { continue };
        if let Some((_, Diagnosis::Explained(found))) = diagnose_nearly(&robot, &[seen], &tolerances).expect("numbers")
        {
            assert!(found[0].error <= 0.2 * right, "{seed}: {right} {found:?}");
        }
    }
}
