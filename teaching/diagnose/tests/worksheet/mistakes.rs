//! Mistakes that were made on purpose are named.

use rne_diagnose::Slip;
use rne_diagnose::worksheet::{Axes, GivenValue, Quantity, Reach, Situation, Worksheet};
use rne_model::{Convention, Robot};

use crate::lecture::*;

/// Each component made wrong, with all that comes behind it: it is the one that is named.
#[test]
fn the_first_wrong_component_is_named() {
    for (robot, axes) in
        [(six("standard"), Axes::Joint), (six("modified"), Axes::Link), (shipped("stanford"), Axes::Base)]
    {
        let at = state(robot.dof());
        let sheet = Worksheet::new(&robot, &at, axes).unwrap();
        let right = all_values(&sheet);
        // some of all, and more of a joint in the middle
        for (index, wrong) in right
            .iter()
            .enumerate()
            .filter(|(i, value)| i % 58 == 0 || (i % 3 == 0 && value.joint == 3 && axes == Axes::Joint))
        {
            let mut given = right.clone();
            for value in &mut given[index..] {
                let size = sheet.line(value.joint, value.quantity).unwrap().size();
                value.value += 0.2 * size + 0.01;
            }
            // in another order than that of computation
            given.reverse();
            let found = sheet.compare(&robot, &at, &given, 4).unwrap();
            let first = found.first.unwrap();
            let line = &sheet.lines[first.line];
            assert_eq!(
                (line.joint, line.quantity, first.component),
                (wrong.joint, wrong.quantity, wrong.component),
                "{}",
                robot.name
            );
            assert_eq!((first.ours, found.differing), (wrong.value, given.len() - index));
        }
    }
}

/// A term left out of a line is named, or one that is as large.
#[test]
fn a_term_that_is_left_out_is_named() {
    let robot = six("standard");
    let at = Situation { wrench: Some(WRENCH), ..state(6) };
    let mut named = 0;
    for (turn, axes) in ALL_AXES.into_iter().enumerate() {
        let sheet = Worksheet::new(&robot, &at, axes).unwrap();
        // each line in one of the three
        let lines = sheet.lines.iter().enumerate().filter(|(index, _)| index % 3 == turn);
        for (index, line) in lines.filter(|(_, line)| line.quantity.step() > 0) {
            for term in line.terms.iter().filter(|term| term.values.iter().any(|x| x.abs() > 0.05 * line.size())) {
                if line.terms.len() < 2 {
                    continue;
                }
                let mut given = all_values(&sheet);
                let before = sheet.lines[..index].iter().map(|line| line.values.len()).sum::<usize>();
                for (value, missing) in given[before..].iter_mut().zip(&term.values) {
                    value.value -= missing;
                }
                let found = sheet.compare(&robot, &at, &given, 4).unwrap().first.unwrap();
                let says: Vec<&str> = found.reasons.iter().map(|reason| reason.says.as_str()).collect();
                let expected = format!("the term {} is left out", term.text);
                assert!(says.iter().any(|says| says.contains(&expected)), "{axes:?} {}: {says:?}", line.symbol());
                named += 1;
            }
        }
    }
    assert!(named > 70, "{named}");
}

/// Who makes a slip everywhere hears of it, not of a term.
#[test]
fn a_slip_that_explains_every_value_comes_first() {
    let right = six("standard");
    let at = state(6);
    let text = |change: &dyn Fn(&mut Robot)| {
        let mut robot = right.clone();
        change(&mut robot);
        robot
    };
    let cases: [(Robot, Slip); 5] = [
        (text(&|robot| robot.gravity = [0.0, 0.0, 9.81]), Slip::GravityReversed),
        (text(&|robot| robot.gravity = [0.0; 3]), Slip::NoGravity),
        (text(&|robot| robot.convention = Convention::Modified), Slip::OtherConvention),
        (
            text(&|robot| {
                robot.joints.iter_mut().for_each(|joint| joint.row.link.com = joint.row.link.com.map(|c| -c));
            }),
            Slip::ComReversed,
        ),
        (
            text(&|robot| {
                robot.joints.iter_mut().for_each(|joint| {
                    let inertia = &mut joint.row.link.inertia;
                    (inertia.xy, inertia.xz, inertia.yz) = (-inertia.xy, -inertia.xz, -inertia.yz);
                });
            }),
            Slip::ProductsOfInertia,
        ),
    ];
    for axes in ALL_AXES {
        let sheet = Worksheet::new(&right, &at, axes).unwrap();
        for (wrong, slip) in &cases {
            let given = all_values(&Worksheet::new(wrong, &at, axes).unwrap());
            let first = sheet.compare(&right, &at, &given, 6).unwrap().first.unwrap();
            let reason = first.reasons.first().unwrap();
            assert_eq!(
                (reason.says.as_str(), reason.reach),
                (slip.says(&right).as_str(), Reach::Everything),
                "{axes:?}"
            );
        }
    }
}

/// The slips of steps that only a worksheet shows, and of one value.
#[test]
fn slips_on_one_line() {
    let robot = six("standard");
    let at = state(6);
    let sheet = Worksheet::new(&robot, &at, Axes::Link).unwrap();
    let told = |joint: usize, quantity: Quantity, change: &dyn Fn(&mut [f64])| {
        let mut values = sheet.line(joint, quantity).unwrap().values.clone();
        change(&mut values);
        let mut given = all_values(&sheet);
        for value in given.iter_mut().filter(|value| (value.joint, value.quantity) == (joint, quantity)) {
            value.value = values[value.component];
        }
        let first = sheet.compare(&robot, &at, &given, 4).unwrap().first.unwrap();
        first.reasons.into_iter().map(|reason| reason.says).collect::<Vec<_>>().join("\n")
    };
    assert!(told(4, Quantity::Omega, &|w| w.iter_mut().for_each(|x| *x = x.to_degrees())).contains("in degrees"));
    assert!(told(4, Quantity::Theta, &|t| t[0] = t[0].to_degrees()).contains("in degrees"));
    assert!(told(4, Quantity::Velocity, &|v| v.swap(0, 1)).contains("exchanged: y, x, z"));
    assert!(told(4, Quantity::JointForce, &|f| f[1] = -f[1]).contains("the sign is reversed"));
    assert!(told(4, Quantity::JointForce, &|f| f[1] = f[2]).contains("this is component z"));
    assert!(told(4, Quantity::Rotation, &|m| *m.get_mut(1).unwrap() *= -1.0).contains("the sign is reversed"));
    let transpose = |m: &mut [f64]| (m[1], m[3], m[2], m[6], m[5], m[7]) = (m[3], m[1], m[6], m[2], m[7], m[5]);
    assert!(told(4, Quantity::Rotation, &transpose).contains("transposed"));
    assert!(told(4, Quantity::Tau, &|t| t[0] *= 1000.0).contains("a thousand times"));
    // 2 q̇ ω × e of a sliding joint, once
    let coriolis = sheet.line(5, Quantity::Acceleration).unwrap().terms.last().unwrap().values.clone();
    let once = |c: &mut [f64]| c.iter_mut().zip(&coriolis).for_each(|(c, term)| *c -= term / 2.0);
    assert!(told(5, Quantity::Acceleration, &once).contains("without its factor 2"));
    // R for Rᵀ, and not turned at all
    let before = sheet.line(3, Quantity::Gravity).unwrap().values.clone();
    assert!(told(4, Quantity::Gravity, &|g| g.copy_from_slice(&before)).contains("it is not turned by R4ᵀ"));
}

/// Vectors that are right, but in the axes of frame i of a standard table: Rz(θ) Rx(α) turns them from frame to frame.
#[test]
fn axes_of_the_table_are_named() {
    let robot = six("standard");
    let at = state(6);
    let sheet = Worksheet::new(&robot, &at, Axes::Link).unwrap();
    let theta = |row: usize| sheet.line(row, Quantity::Theta).unwrap().values[0];
    let alphas: Vec<f64> = robot.rows().map(|row| row.dh.alpha.radians).collect();
    let mut to_table = ONE;
    let mut given = all_values(&sheet);
    given.retain(|value| value.quantity.step() > 0);
    let base = Worksheet::new(&robot, &at, Axes::Base).unwrap();
    for joint in 1..=6 {
        // from the axes of frame i to those of frame 0
        to_table = product(to_table, product(rz(theta(joint)), rx(alphas[joint - 1])));
        for value in given.iter_mut().filter(|value| value.joint == joint) {
            let line = base.line(joint, value.quantity).unwrap();
            if let [x, y, z] = line.values[..] {
                value.value = turn(transposed(to_table), [x, y, z])[value.component];
            }
        }
    }
    let first = sheet.compare(&robot, &at, &given, 4).unwrap().first.unwrap();
    let reason = first.reasons.first().unwrap();
    assert!(reason.says.contains("axes of frame i of the table"), "{reason:?}");
    assert_eq!(reason.reach, Reach::Everything);
    assert!(reason.right.as_ref().unwrap().contains("fixed to link i, z along joint i"), "{reason:?}");
    // with a mistake of its own in the last line, the axes still are the first reason
    let tau = given.iter_mut().rfind(|value| value.quantity == Quantity::Tau).unwrap();
    tau.value += 100.0;
    let first = sheet.compare(&robot, &at, &given, 4).unwrap().first.unwrap();
    let reason = first.reasons.first().unwrap();
    assert_eq!((reason.says.contains("frame i of the table"), reason.reach), (true, Reach::UpToHere), "{reason:?}");
    // other axes that have a name
    let mut given = all_values(&sheet);
    given.retain(|value| value.quantity.step() > 0);
    for value in &mut given {
        value.value = base.line(value.joint, value.quantity).unwrap().values[value.component];
    }
    let first = sheet.compare(&robot, &at, &given, 4).unwrap().first.unwrap();
    assert!(first.reasons[0].says.contains("`base`: those of frame 0"), "{:?}", first.reasons);
}

/// The worksheet finds the misprints of the lecture that change no torque.
#[test]
fn misprints_of_step_3_are_named() {
    let robot = six("standard");
    let mut at = state(6);
    at.q[2] = 0.35;
    let sheet = Worksheet::new(&robot, &at, Axes::Joint).unwrap();
    // ċ with b for ḃ, from the recursion with a wrong rate
    let mut given: Vec<GivenValue> = all_values(&sheet)
        .into_iter()
        .filter(|value| value.quantity == Quantity::Velocity && value.joint == 3)
        .collect();
    let b = sheet.line(3, Quantity::Offset).unwrap().values[0];
    given[2].value += b - at.qd[2];
    let first = sheet.compare(&robot, &at, &given, 4).unwrap().first.unwrap();
    assert!(first.reasons.iter().any(|reason| reason.says.contains("(E5)")), "{:?}", first.reasons);
}
