//! The frames of a table from the axes of a URDF, and the remarks on angles and units.

use super::*;

#[test]
fn a_pendulum_has_its_closed_form() {
    for convention in BOTH {
        let options = Options { convention, ..Options::default() };
        let imported = import(&pendulum("<axis xyz=\"0 1 0\"/>"), &options);
        for (q, qdd) in [(0.0, 0.0), (0.3, 1.0), (-2.0, -0.7)] {
            let inertia = 0.05 + 2.0 * 0.3 * 0.3;
            let expected = inertia * qdd + 2.0 * GRAVITY * 0.3 * f64::sin(q);
            assert_close(&torques(&imported.robot, &[q], &[5.0], &[qdd]), &[expected], 1e-14);
        }
    }
}

/// Programs write their largest number where a joint has no limit; it is none in degrees, and no warning says so.
#[test]
fn the_largest_number_is_no_limit() {
    let none = |text: String| {
        let Imported { robot, account, .. } = plain(&text);
        let limits = robot.joints[0].limits;
        assert_eq!((limits.position, limits.velocity, limits.effort), (None, None, None), "{text}");
        assert!(!account.lints.to_string().contains("degrees"), "{}", account.lints);
    };
    for largest in ["1.7976931348623157e308", "1e9"] {
        let limit = format!("lower='-{largest}' upper='{largest}' effort='{largest}' velocity='{largest}'");
        none(pendulum(&format!("<limit {limit}/>")).replace("\"continuous\"", "\"revolute\""));
        none(pendulum(&format!("<limit {}/>", limit.replace(&format!("-{largest}"), "-1"))));
        for angle in ["degree", "radian"] {
            none(format!(
                "<mujoco><compiler angle='{angle}'/><worldbody><body><joint range='-{largest} {largest}' \
                 limited='true' \
                 actuatorfrcrange='-{largest} {largest}' actuatorfrclimited='true'/>\
                 <inertial pos='0 0 1' mass='1' diaginertia='1 1 1'/></body></worldbody></mujoco>"
            ));
        }
    }
}

/// Pitfalls 9: the default axis is x, and its length is none of its meaning.
#[test]
fn the_axis_is_x_unless_given_and_of_any_length() {
    let default = plain(&pendulum("")).robot;
    let x = plain(&pendulum("<axis xyz=\"250 0 0\"/>")).robot;
    assert_eq!(default.joints, x.joints);
    let tilted = plain(&pendulum("<axis xyz=\"3 0 4\"/>")).robot;
    let unit = plain(&pendulum("<axis xyz=\"0.6 0 0.8\"/>")).robot;
    assert_eq!(tilted.joints, unit.joints);
    let none = refused(&pendulum("<axis xyz=\"0 0 0\"/>"), &Options::default());
    assert!(none.contains("the axis of the joint `hinge` has no direction"), "{none}");
}

#[test]
fn lengths_stay_as_they_are_written_and_limits_are_carried() {
    for convention in BOTH {
        let imported = import(&planar("xyz=\"0.4318 0 0\""), &Options { convention, ..Options::default() });
        let lengths: Vec<f64> = imported.robot.rows().map(|row| row.dh.a).collect();
        assert_eq!(lengths, if convention == Convention::Standard { [0.4318, 0.0] } else { [0.0, 0.4318] });
        assert_eq!(imported.robot.tool.xyz, [0.3, 0.0, 0.0]);
        let limits = imported.robot.joints[1].limits;
        assert_eq!((limits.position, limits.velocity, limits.effort), (Some((-1.0, 2.0)), Some(3.0), Some(30.0)));
        let (q1, q2) = (0.4, -1.1);
        let x = 0.4318 * f64::cos(q1) + 0.3 * f64::cos(q1 + q2);
        let y = 0.4318 * f64::sin(q1) + 0.3 * f64::sin(q1 + q2);
        assert_close(&tip(&imported.robot, &[q1, q2]), &[x, y, 0.0], 1e-15);
        assert_eq!(torques(&imported.robot, &[q1, q2], &[0.0; 2], &[0.0; 2]), [0.0; 2], "gravity is along the axes");
    }
}

/// Pitfall 1: pi is rounded in files; what that changes is told.
#[test]
fn rounded_right_angles_are_snapped_and_the_change_is_told() {
    let text = planar("xyz=\"0.4318 0 0\" rpy=\"1.5708 0 0\"");
    let snapped = plain(&text);
    assert_eq!(snapped.robot.joints[0].row.dh.alpha.radians, FRAC_PI_2);
    assert!(snapped.text.contains("alpha: pi/2"), "{}", snapped.text);
    let [found] = &snapped.account.snapped[..] else { panic!("{:?}", snapped.account.snapped) };
    assert_eq!((&*found.place, &*found.from, &*found.to), ("joint b, roll", "1.5708", "pi/2"));
    let change = snapped.account.change.unwrap();
    // 3.7e-6 rad over the 0.3 m behind the joint.
    assert!((0.9e-6..1.2e-6).contains(&change.position), "{change:?}");
    assert!((3.6e-6..3.8e-6).contains(&change.rotation), "{change:?}");
    assert!(change.torque > 1e-7 && change.torque < 1e-4 && change.acceleration.is_some(), "{change:?}");
    let raw = import(&text, &Options { snap: false, ..Options::default() });
    assert_eq!(raw.robot.joints[0].row.dh.alpha.radians.to_string(), "1.5708", "not a bit is lost");
    assert!(raw.account.snapped.is_empty() && raw.account.change.is_none());
}

/// Pitfall 2: axes that are nearly parallel have their common normal far away.
#[test]
fn nearly_parallel_axes_are_told_or_snapped() {
    let text = planar("xyz=\"0.4 0.1 0\" rpy=\"3.1416 0 0\"");
    let far = converted(&text, &Options { snap: false, ..Options::default() });
    assert!(
        far.account.sentences().iter().any(|remark| remark.contains("nearly parallel")),
        "{:?}",
        far.account.sentences()
    );
    // 0.1 m over 7.3e-6 rad: 14 km of d cost 14 km times the rounding of an f64.
    assert!(far.account.rounding.position < 2e-11, "{:?}", far.account.rounding);
    let near = plain(&text);
    assert_eq!(near.robot.joints[0].row.dh.d, 0.0);
    assert_eq!(near.robot.joints[0].row.dh.alpha.radians, PI, "never -pi");
    assert!(near.account.sentences().is_empty(), "{:?}", near.account.sentences());
}

/// Degrees and millimetres are told, by the name of their joint.
#[test]
fn other_units_are_told() {
    for (origin, told) in [
        ("xyz=\"0.4 0.1 0\" rpy=\"90 0 0\"", "has the angle 90 rad in its rpy, more than a turn: 90° is 1.5708 rad"),
        ("xyz=\"400 100 0\" rpy=\"1.5 0 0\"", "has an origin that is 400 m away: lengths are in metres"),
    ] {
        let remarks = plain(&planar(origin)).account.sentences();
        assert!(remarks.iter().any(|remark| remark.contains(told)), "{remarks:?}");
        assert!(!remarks.iter().any(|remark| remark.contains("nearly parallel")), "{remarks:?}");
    }
    assert!(plain(&planar("xyz=\"0.4 0.1 0\" rpy=\"-6.28 0 0\"")).account.sentences().is_empty());
}

/// A tilt that a table can say is in the table; one that it cannot say is told.
#[test]
fn no_tilt_is_dropped_in_silence() {
    for tilt in [1e-3, 1e-5, 1e-6, 3e-8] {
        let text = planar(&format!("xyz=\"0.4 0 0.1\" rpy=\"{tilt} 0 0\""));
        let imported = converted(&text, &Options { snap: false, ..Options::default() });
        assert_eq!(imported.robot.joints[0].row.dh.alpha.radians, tilt);
        assert!(imported.account.rounding.rotation < 1e-15, "{tilt}: {:?}", imported.account.rounding);
    }
    for tilt in [1e-9, 1e-11] {
        let text = planar(&format!("xyz=\"0.4 0.1 0\" rpy=\"{tilt} 0 0\""));
        let imported = converted(&text, &Options { snap: false, ..Options::default() });
        assert!(imported.account.sentences()[0].contains("off parallel"), "{:?}", imported.account.sentences());
        assert!(imported.account.rounding.position < tilt, "{:?}", imported.account.rounding);
    }
}

/// Pitfall 3: what the axes leave free makes the table short.
#[test]
fn parallel_axes_leave_d_zero_and_one_line_leaves_a_zero() {
    let axis = "<axis xyz=\"0 0 1\"/>";
    let text = robot(&[
        bare(&["base", "one", "two", "three", "four"]),
        joint("a", "continuous", ("base", "one"), "xyz=\"0 0 0.3\"", axis),
        joint("b", "continuous", ("one", "two"), "xyz=\"0.4 0 0.1\"", axis),
        joint("c", "continuous", ("two", "three"), "xyz=\"0 0 0.2\"", axis),
        joint("d", "continuous", ("three", "four"), "xyz=\"0 0.5 0\" rpy=\"0 1.5707963267948966 0\"", axis),
    ]);
    for convention in BOTH {
        let imported = import(&text, &Options { convention, ..Options::default() });
        let rows: Vec<(f64, f64)> = imported.robot.rows().map(|row| (row.dh.d, row.dh.a)).collect();
        let standard = convention == Convention::Standard;
        assert_eq!(rows[0].0, 0.0, "parallel");
        assert_eq!(rows[usize::from(!standard)].1, 0.4);
        assert_eq!(rows[usize::from(!standard) + 1].1, 0.0, "one line");
        assert_close(&tip(&imported.robot, &[0.0; 4]), &[0.4, 0.5, 0.6], 1e-15);
    }
}

/// Pitfall 4: |theta| is at most pi/2; a may have either sign.
#[test]
fn x_points_so_that_theta_is_small() {
    for (y, expected) in [("0.5", FRAC_PI_2), ("-0.5", -FRAC_PI_2)] {
        let text = robot(&[
            bare(&["base", "one", "two"]),
            joint("a", "continuous", ("base", "one"), "", "<axis xyz=\"0 0 1\"/>"),
            joint("b", "continuous", ("one", "two"), &format!("xyz=\"0 {y} 0\""), "<axis xyz=\"0 0 1\"/>"),
        ]);
        let row = plain(&text).robot.joints[0].row;
        assert_eq!((row.dh.theta.radians, row.dh.a), (expected, 0.5), "at a right angle a > 0");
    }
    let text = robot(&[
        bare(&["base", "one", "two"]),
        joint("a", "continuous", ("base", "one"), "", "<axis xyz=\"0 0 1\"/>"),
        joint("b", "continuous", ("one", "two"), "xyz=\"-0.5 0.1 0\"", "<axis xyz=\"0 0 1\"/>"),
    ]);
    let row = plain(&text).robot.joints[0].row;
    assert!(row.dh.theta.radians.abs() < FRAC_PI_2 && row.dh.a < 0.0, "{row:?}");
}

/// Pitfall 5: z is the positive axis of the joint, so gravity is turned, not q.
#[test]
fn gravity_is_turned_into_frame_0() {
    let imported = plain(&pendulum("<axis xyz=\"0 0 -1\"/>"));
    assert_eq!(imported.robot.gravity, [0.0, 0.0, GRAVITY]);
    let sideways = plain(&pendulum("<axis xyz=\"1 0 0\"/>")).robot;
    assert_eq!(sideways.gravity.map(f64::abs).iter().sum::<f64>(), GRAVITY);
    assert_eq!(sideways.gravity[2], 0.0);
    // Down in the world, wherever frame 0 points.
    let pose = DynArm::from_robot(&sideways).forward_kinematics(&[0.0]).unwrap();
    assert_close(&[pose.translation_vector()[2]], &[1.0], 1e-15);
    assert_close(&torques(&sideways, &[FRAC_PI_2], &[0.0], &[0.0]), &[2.0 * GRAVITY * 0.3], 1e-14);
}

/// Pitfall 6: the line of a prismatic axis goes through the joint's origin.
#[test]
fn a_prismatic_joint_slides_along_its_axis() {
    let text = robot(&[
        bare(&["base"]),
        link("turn", 1.0, "0 0 0", [0.1, 0.1, 0.1]),
        link("slide", 2.0, "0 0 0.1", [0.01, 0.01, 0.01]),
        joint("a", "continuous", ("base", "turn"), "", "<axis xyz=\"0 0 1\"/>"),
        joint(
            "b",
            "prismatic",
            ("turn", "slide"),
            "xyz=\"0.3 0 0.2\"",
            "<axis xyz=\"0 0 2\"/><limit lower=\"0\" upper=\"0.5\" effort=\"10\" velocity=\"1\"/>",
        ),
    ]);
    for convention in BOTH {
        let robot = import(&text, &Options { convention, ..Options::default() }).robot;
        assert_eq!(robot.joints[1].row.kind, JointKind::Prismatic);
        assert_close(&tip(&robot, &[0.0, 0.25]), &[0.3, 0.0, 0.45], 1e-15);
        let expected = [(0.1 + 0.01 + 2.0 * 0.3 * 0.3) * 0.5, 2.0 * (GRAVITY + 0.7)];
        assert_close(&torques(&robot, &[1.0, 0.25], &[0.0, 0.0], &[0.5, 0.7]), &expected, 1e-14);
    }
}

/// Pitfall 7: `rpy` of an inertial turns its tensor.
#[test]
fn an_inertial_frame_turns_its_tensor() {
    let with = |rpy: &str, [xx, yy, zz]: [f64; 3]| {
        pendulum("<axis xyz=\"0 1 0\"/>")
            .replace("<origin xyz=\"0 0 -0.3\"/>", &format!("<origin xyz=\"0 0 -0.3\" rpy=\"{rpy}\"/>"))
            .replace("ixx=\"0.05\"", &format!("ixx=\"{xx}\""))
            .replace("iyy=\"0.05\"", &format!("iyy=\"{yy}\""))
            .replace("izz=\"0.001\"", &format!("izz=\"{zz}\""))
    };
    let turned = plain(&with("0 0 1.570796327", [0.3, 0.2, 0.15])).robot;
    let straight = plain(&with("0 0 0", [0.2, 0.3, 0.15])).robot;
    assert_eq!(turned.joints, straight.joints, "snapped, so exactly");
    assert_eq!(turned.joints[0].row.link.inertia, Inertia { xx: 0.2, yy: 0.15, zz: 0.3, ..Inertia::default() });
}
