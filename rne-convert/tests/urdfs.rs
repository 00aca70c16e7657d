//! Small URDFs by hand: closed forms, and every pitfall that real files have.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;

use rne_convert::{Imported, Options, Selection, Urdf, robot_file};
use rne_model::{Convention, Inertia, JointKind, Reader, Robot};
use rne_runtime::DynArm;

const GRAVITY: f64 = 9.81;
const BOTH: [Convention; 2] = [Convention::Standard, Convention::Modified];

/// A link with mass, its centre and the diagonal of its tensor.
fn link(name: &str, mass: f64, xyz: &str, [xx, yy, zz]: [f64; 3]) -> String {
    format!(
        "<link name=\"{name}\"><inertial><origin xyz=\"{xyz}\"/><mass value=\"{mass}\"/>\
         <inertia ixx=\"{xx}\" ixy=\"0\" ixz=\"0\" iyy=\"{yy}\" iyz=\"0\" izz=\"{zz}\"/></inertial></link>\n"
    )
}

/// A joint with its origin and what else stands in it.
fn joint(name: &str, kind: &str, (parent, child): (&str, &str), origin: &str, rest: &str) -> String {
    format!(
        "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
         <origin {origin}/>{rest}</joint>\n"
    )
}

fn robot(parts: &[String]) -> String {
    format!("<robot name=\"arm\">\n{}</robot>\n", parts.concat())
}

/// Links without mass.
fn bare(names: &[&str]) -> String {
    names.iter().fold(String::new(), |mut text, name| {
        let _ = writeln!(text, "<link name=\"{name}\"/>");
        text
    })
}

fn converted(text: &str, options: &Options) -> Imported {
    let imported = Urdf::read("arm.urdf", text).and_then(|urdf| urdf.import(options)).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(Reader::new("written").read(&imported.text).unwrap().robot, imported.robot, "reading gives the robot");
    imported
}

fn import(text: &str, options: &Options) -> Imported {
    let imported = converted(text, options);
    assert!(imported.account.rounding.torque < 1e-12, "{:?}", imported.account.rounding);
    imported
}

fn plain(text: &str) -> Imported {
    import(text, &Options::default())
}

fn refused(text: &str, options: &Options) -> String {
    Urdf::read("arm.urdf", text).and_then(|urdf| urdf.import(options).map(|_| ())).unwrap_err().to_string()
}

fn torques(robot: &Robot, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<f64> {
    DynArm::from_robot(robot).inverse_dynamics(q, qd, qdd).unwrap()
}

fn tip(robot: &Robot, q: &[f64]) -> [f64; 3] {
    let pose = DynArm::from_robot(robot).forward_kinematics(q).unwrap();
    pose.translation_vector().into()
}

fn assert_close(one: &[f64], other: &[f64], tolerance: f64) {
    let close = one.len() == other.len() && one.iter().zip(other).all(|(a, b)| (a - b).abs() <= tolerance);
    assert!(close, "{one:?} {other:?}");
}

/// A pendulum about y that hangs down, of mass m at distance l, with moment of inertia i about its centre.
fn pendulum(axis: &str) -> String {
    robot(&[
        bare(&["base"]),
        link("rod", 2.0, "0 0 -0.3", [0.05, 0.05, 0.001]),
        joint("hinge", "continuous", ("base", "rod"), "xyz=\"0 0 1\"", axis),
    ])
}

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

/// A planar arm of two links along x, joints about z.
fn planar(second: &str) -> String {
    let limits = "<axis xyz=\"0 0 1\"/><limit lower=\"-1\" upper=\"2\" effort=\"30\" velocity=\"3\"/>";
    robot(&[
        bare(&["base", "tip"]),
        link("one", 1.5, "0.2 0 0", [0.0, 0.02, 0.02]),
        link("two", 1.0, "0.15 0 0", [0.0, 0.01, 0.01]),
        joint("a", "revolute", ("base", "one"), "xyz=\"0 0 0\"", limits),
        joint("b", "revolute", ("one", "two"), second, limits),
        joint("end", "fixed", ("two", "tip"), "xyz=\"0.3 0 0\"", ""),
    ])
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
    assert!(far.account.remarks.iter().any(|remark| remark.contains("nearly parallel")), "{:?}", far.account.remarks);
    // 0.1 m over 7.3e-6 rad: 14 km of d cost 14 km times the rounding of an f64.
    assert!(far.account.rounding.position < 2e-11, "{:?}", far.account.rounding);
    let near = plain(&text);
    assert_eq!(near.robot.joints[0].row.dh.d, 0.0);
    assert_eq!(near.robot.joints[0].row.dh.alpha.radians, PI, "never -pi");
    assert!(near.account.remarks.is_empty(), "{:?}", near.account.remarks);
}

/// Degrees and millimetres are told, by the name of their joint.
#[test]
fn other_units_are_told() {
    for (origin, told) in [
        ("xyz=\"0.4 0.1 0\" rpy=\"90 0 0\"", "has the angle 90 rad in its rpy, more than a turn: 90° is 1.5708 rad"),
        ("xyz=\"400 100 0\" rpy=\"1.5 0 0\"", "stands 400 m away: lengths in a URDF are metres"),
    ] {
        let remarks = plain(&planar(origin)).account.remarks;
        assert!(remarks.iter().any(|remark| remark.contains(told)), "{remarks:?}");
        assert!(!remarks.iter().any(|remark| remark.contains("nearly parallel")), "{remarks:?}");
    }
    assert!(plain(&planar("xyz=\"0.4 0.1 0\" rpy=\"-6.28 0 0\"")).account.remarks.is_empty());
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
        assert!(imported.account.remarks[0].contains("off parallel"), "{:?}", imported.account.remarks);
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

/// Pitfall 8: what is fixed to a link is part of it; what is fixed to the base is nothing.
#[test]
fn fixed_links_are_lumped() {
    let axis = "<axis xyz=\"0 1 0\"/>";
    let split = robot(&[
        bare(&["base"]),
        link("pedestal", 100.0, "0 0 0", [1.0, 1.0, 1.0]),
        link("upper", 1.0, "0 0 0", [0.0; 3]),
        link("lower", 1.0, "0 0 0.1", [0.0; 3]),
        joint("feet", "fixed", ("base", "pedestal"), "xyz=\"0 0 1\"", ""),
        joint("hinge", "continuous", ("pedestal", "upper"), "", axis),
        joint("weld", "fixed", ("upper", "lower"), "xyz=\"0 0 -0.5\" rpy=\"3.141592653589793 0 0\"", ""),
    ]);
    let imported = plain(&split);
    let link = imported.robot.joints[0].row.link;
    // Two points at 0 and at 0.6 below, where y of frame 0 points, for z is the axis.
    assert_eq!((link.mass, link.com), (2.0, [0.0, 0.3, 0.0]));
    assert_eq!(link.inertia, Inertia { xx: 0.18, zz: 0.18, ..Inertia::default() });
    assert_eq!(imported.account.lumped, [("hinge".to_owned(), vec!["upper".to_owned(), "lower".to_owned()])]);
    assert_eq!(imported.account.base, "base");
}

/// Pitfall 8: movable joints off the chain.
#[test]
fn joints_off_the_chain_are_held_by_name_or_refused() {
    let hand = robot(&[
        bare(&["base", "tip"]),
        link("arm", 1.0, "0 0 0", [0.1; 3]),
        link("finger", 0.5, "0 0 0", [0.0; 3]),
        link("thumb", 0.5, "0 0 0", [0.0; 3]),
        joint("a", "continuous", ("base", "arm"), "", "<axis xyz=\"0 0 1\"/>"),
        joint("end", "fixed", ("arm", "tip"), "", ""),
        joint("f", "prismatic", ("arm", "finger"), "", "<axis xyz=\"1 0 0\"/><limit effort=\"1\" velocity=\"1\"/>"),
        joint(
            "t",
            "prismatic",
            ("arm", "thumb"),
            "",
            "<axis xyz=\"-1 0 0\"/><limit effort=\"1\" velocity=\"1\"/>\
             <mimic joint=\"f\" multiplier=\"2\" offset=\"0.1\"/>",
        ),
        // On the base nothing of it reaches the arm.
        "<link name=\"wheel\"/>".to_owned(),
        joint("w", "continuous", ("base", "wheel"), "", ""),
    ]);
    let select = |lock: &[(&str, f64)], lock_others| Options {
        selection: Selection {
            tip: Some("tip".to_owned()),
            lock: lock.iter().map(|&(name, value)| (name.to_owned(), value)).collect(),
            lock_others,
            ..Selection::default()
        },
        ..Options::default()
    };
    let loose = refused(&hand, &select(&[], false));
    assert!(loose.contains("movable joints off the chain from `base` to `tip`: `f`, `t`"), "{loose}");
    assert!(loose.contains("--lock JOINT=VALUE") && loose.contains("--lock-others"), "{loose}");
    let named = import(&hand, &select(&[("f", 0.2), ("t", 0.4)], false));
    assert_eq!(named.robot.joints[0].row.link.com, [-0.05, 0.0, 0.0]);
    assert_eq!(named.account.aside, ["w"]);
    // The follower goes where its leader is held: 2 · 0.2 + 0.1 to the other side.
    let others = import(&hand, &select(&[("f", 0.2)], true));
    assert_eq!(others.account.held, [("f".to_owned(), 0.2), ("t".to_owned(), 0.5)]);
    assert_close(&others.robot.joints[0].row.link.com, &[-0.075, 0.0, 0.0], 1e-16);
    assert!(others.text.contains("the joint t is held at 0.5"), "{}", others.text);
    let unknown = refused(&hand, &select(&[("g", 0.2)], true));
    assert!(unknown.contains("there is no joint `g`") && unknown.contains("`a`, `f`, `t`"), "{unknown}");
    let twice = refused(&hand, &select(&[("f", 0.2), ("f", 0.2)], true));
    assert!(twice.contains("`f` is locked twice"), "{twice}");
}

/// An arm of one joint `j`, and a link with a mass on a joint `k`, which hangs on `on` and has a `mimic`.
fn with_follower(on: &str, mass: f64, mimic: &str) -> String {
    let axis = "<axis xyz=\"0 1 0\"/>";
    robot(&[
        bare(&["base", "tip"]),
        link("arm", 2.0, "0.1 0 0", [0.1; 3]),
        link("rod", mass, "0.5 0 0", [0.0; 3]),
        joint("j", "continuous", ("base", "arm"), "", axis),
        joint("end", "fixed", ("arm", "tip"), "", ""),
        joint("k", "continuous", (on, "rod"), "", &format!("{axis}{mimic}")),
    ])
}

/// A table cannot say that the mass of a follower moves along: it is held by name alone.
#[test]
fn a_follower_of_a_moving_joint_is_refused_unless_it_is_held_by_name() {
    let select = |lock: &[(&str, f64)], lock_others| Options {
        selection: Selection {
            tip: Some("tip".to_owned()),
            lock: lock.iter().map(|&(name, value)| (name.to_owned(), value)).collect(),
            lock_others,
            ..Selection::default()
        },
        ..Options::default()
    };
    let mimic = "<mimic joint=\"j\" multiplier=\"-1\"/>";
    // on the arm, and on the base, where it turns the other way and is no part of the arm otherwise
    for on in ["arm", "base"] {
        let text = with_follower(on, 2.0, mimic);
        let message = refused(&text, &select(&[], true));
        assert!(message.contains("follow joints of the chain that move: `k` follows `j`"), "{message}");
        assert!(message.contains("hold each of them by its name, such as --lock k=VALUE"), "{message}");
        assert!(message.contains("arm.urdf:"), "{message}");
        let held = import(&text, &select(&[("k", 0.0)], true)).account;
        assert_eq!(held.remarks, ["the joint k is held still, although it follows j, which moves"]);
    }
    assert!(refused(&with_follower("base", 2.0, mimic), &select(&[], false)).contains("`k` follows `j`"));
    let note = "the joint k follows j, which moves; nothing that it carries has mass, so it is held still";
    let light = import(&with_follower("arm", 0.0, mimic), &select(&[], true));
    assert_eq!(light.account.remarks, [note]);
    assert!(light.text.contains(note), "{}", light.text);
    // one that has a multiplier of zero does not move
    let still = "<mimic joint=\"j\" multiplier=\"0\" offset=\"0.25\"/>";
    let held = import(&with_follower("arm", 2.0, still), &select(&[], true)).account;
    assert_eq!((held.held, held.remarks), (vec![("k".to_owned(), 0.25)], Vec::new()));
    // a joint of the chain that is held does not move either
    let locked = |lock: &[(&str, f64)]| {
        let text = robot(&[
            bare(&["base"]),
            link("arm", 1.0, "0 0 0", [0.1; 3]),
            link("hand", 1.0, "0 0 0", [0.1; 3]),
            link("rod", 1.0, "0 0 0", [0.1; 3]),
            joint("i", "continuous", ("base", "arm"), "", "<axis xyz=\"0 1 0\"/>"),
            joint("j", "continuous", ("arm", "hand"), "", "<axis xyz=\"0 1 0\"/>"),
            joint("k", "continuous", ("arm", "rod"), "", &format!("<axis xyz=\"0 1 0\"/>{mimic}")),
        ]);
        let selection = Selection { tip: Some("hand".to_owned()), ..select(lock, true).selection };
        import(&text, &Options { selection, ..Options::default() }).account
    };
    assert_eq!(locked(&[("j", 0.3)]).held, [("k".to_owned(), -0.3), ("j".to_owned(), 0.3)]);
    // and where it is held by name, too, the two agree or a remark tells that they do not
    assert_eq!(locked(&[("j", 0.3), ("k", -0.3)]).remarks, [""; 0]);
    let note = "the joint k is held at 0.5, although it follows j, which holds it at -0.3";
    assert_eq!(locked(&[("j", 0.3), ("k", 0.5)]).remarks, [note]);
}

/// What a follower follows must be there, and must not follow it.
#[test]
fn followers_of_nobody_and_of_each_other_are_refused() {
    let options = |lock: &[(&str, f64)]| Options {
        selection: Selection {
            tip: Some("tip".to_owned()),
            lock: lock.iter().map(|&(name, value)| (name.to_owned(), value)).collect(),
            lock_others: true,
            ..Selection::default()
        },
        ..Options::default()
    };
    let nobody = with_follower("arm", 2.0, "<mimic joint=\"x\"/>");
    let message = refused(&nobody, &options(&[]));
    assert!(message.contains("the joint `k` follows `x`, and there is no such joint in the file"), "{message}");
    assert!(message.contains("--lock k=VALUE"), "{message}");
    let circle = with_follower("arm", 2.0, "<mimic joint=\"l\"/>").replace(
        "</robot>",
        &format!("<link name=\"c\"/>{}</robot>", joint("l", "continuous", ("arm", "c"), "", "<mimic joint=\"k\"/>")),
    );
    let message = refused(&circle, &options(&[]));
    assert!(message.contains("which follows it in a circle"), "{message}");
    assert_eq!(import(&circle, &options(&[("k", 0.2)])).account.held, [("k".to_owned(), 0.2), ("l".to_owned(), 0.2)]);
    let itself = with_follower("arm", 2.0, "<mimic joint=\"k\"/>");
    assert!(refused(&itself, &options(&[])).contains("follows `k`, which follows it in a circle"));
}

/// Where a joint is held, it should be able to be; and no angle is so large that its last digit is an angle.
#[test]
fn a_joint_that_is_held_outside_of_its_limits_is_told() {
    let limits = "<axis xyz=\"0 0 1\"/><limit lower=\"-0.5\" upper=\"1\" effort=\"1\" velocity=\"1\"/>";
    let with_end = |origin: &str| {
        robot(&[
            bare(&["base", "tip"]),
            link("arm", 2.0, "0.1 0 0", [0.1; 3]),
            link("rod", 2.0, "0.5 0 0", [0.0; 3]),
            joint("j", "continuous", ("base", "arm"), "", "<axis xyz=\"0 1 0\"/>"),
            joint("end", "fixed", ("arm", "tip"), origin, ""),
            joint("k", "revolute", ("arm", "rod"), "", limits),
        ])
    };
    let held_at = |value: f64| Options {
        selection: Selection {
            tip: Some("tip".to_owned()),
            lock: vec![("k".to_owned(), value)],
            ..Selection::default()
        },
        ..Options::default()
    };
    let text = with_end("");
    let told = import(&text, &held_at(3.0)).account.remarks;
    assert_eq!(told, ["the joint k is held at 3, which is outside of its limits, from -0.5 to 1"]);
    for value in [-0.5, 0.0, 1.0] {
        assert_eq!(import(&text, &held_at(value)).account.remarks, Vec::<String>::new(), "{value}");
    }
    for value in [8_388_608.0, 1e15, -1e16, 1e300, f64::NAN, f64::INFINITY] {
        let message = refused(&text, &held_at(value));
        assert!(message.contains("the joint `k` cannot be held at"), "{message}");
        assert!(message.contains("below 8388608 rad"), "{message}");
    }
    for angle in ["8388608", "1e15", "-1e16", "1e300"] {
        let message = refused(&with_end(&format!("rpy=\"0 0 {angle}\"")), &held_at(0.0));
        assert!(message.contains(&format!("`rpy` of `origin` is `0 0 {angle}`")), "{message}");
        assert!(message.contains("each below 8388608 rad"), "{message}");
    }
    import(&with_end("rpy=\"0 0 8388607\""), &held_at(0.0));
}

#[test]
fn a_joint_of_the_chain_may_be_locked() {
    let options = Options {
        selection: Selection { lock: vec![("b".to_owned(), FRAC_PI_2)], ..Selection::default() },
        ..Options::default()
    };
    let imported = import(&planar("xyz=\"0.4 0 0\""), &options);
    assert_eq!(imported.robot.dof(), 1);
    assert_eq!(imported.robot.tool.xyz, [0.4, 0.3, 0.0]);
    assert_eq!(imported.robot.joints[0].row.link.mass, 2.5);
}

#[test]
fn without_a_tip_the_leaves_are_listed() {
    let text = robot(&[
        bare(&["base", "left", "right", "palm"]),
        joint("l", "continuous", ("base", "left"), "", ""),
        joint("r", "continuous", ("base", "right"), "", ""),
        joint("p", "fixed", ("right", "palm"), "", ""),
    ]);
    let message = refused(&text, &Options::default());
    assert!(message.contains("`base` has 2 leaves"), "{message}");
    assert!(message.contains("`left` (1 joint)") && message.contains("`palm` (1 joint)"), "{message}");
    assert!(message.contains("arm.urdf:2:1"), "{message}");
}

#[test]
fn what_no_row_can_say_is_refused_with_a_reason() {
    let with = |kind: &str, rest: &str| {
        robot(&[
            bare(&["base", "one", "two"]),
            joint("a", "continuous", ("base", "one"), "", ""),
            joint("b", kind, ("one", "two"), "", rest),
        ])
    };
    for kind in ["planar", "floating"] {
        let message = refused(&with(kind, ""), &Options::default());
        assert!(message.contains(&format!("the joint `b` on the chain is {kind}")), "{message}");
        assert!(message.contains("arm.urdf:6:1") && message.contains("choose base and tip"), "{message}");
    }
    let mimic = refused(&with("continuous", "<mimic joint=\"a\"/>"), &Options::default());
    assert!(mimic.contains("the joint `b` on the chain follows `a`") && mimic.contains("--lock b=VALUE"), "{mimic}");
    let unknown = Urdf::read("arm.urdf", &with("helical", "")).unwrap_err().to_string();
    assert!(unknown.contains("helical"), "{unknown}");
    for (end, element) in [("parent", "<parent link=\"one\"/>"), ("child", "<child link=\"two\"/>")] {
        let text = with("continuous", "");
        let at = text.rfind(element).expect("the second joint has it");
        let without = format!("{}{}", &text[..at], &text[at + element.len()..]);
        let message = Urdf::read("arm.urdf", &without).unwrap_err().to_string();
        for part in [&format!("the joint `b` has no element `{end}`"), "arm.urdf:6:1"] {
            assert!(message.contains(part), "no `{part}` in {message}");
        }
    }
}

/// Half of a body is not guessed.
#[test]
fn an_inertial_has_a_mass_and_an_inertia() {
    for (part, element) in [("mass", "<mass value=\"2\"/>"), ("inertia", "<inertia ixx")] {
        let text = pendulum("");
        let at = text.find(element).expect("the rod has it");
        let end = at + text[at..].find("/>").expect("its end") + 2;
        let message = Urdf::read("arm.urdf", &format!("{}{}", &text[..at], &text[end..])).unwrap_err().to_string();
        for words in [&format!("the `inertial` of the link `rod` has no element `{part}`"), "arm.urdf:3:1"] {
            assert!(message.contains(words), "no `{words}` in {message}");
        }
    }
}

/// XML takes a line break within an attribute for a space.
#[test]
fn numbers_of_an_attribute_may_stand_in_several_lines() {
    let text = pendulum("");
    let broken = text.replace("xyz=\"0 0 1\"", "xyz=\"0\n0\t1\"");
    assert_ne!(text, broken);
    assert_eq!(plain(&broken).text, plain(&text).text);
}

/// Pitfall 9: a joint and a link may share a name; a mass of zero divides nothing.
#[test]
fn one_name_for_a_joint_and_a_link_and_a_centre_without_mass() {
    let text = robot(&[
        bare(&["base"]),
        link("hand", 0.0, "1 2 3", [0.0, 0.0, 0.35]),
        joint("hand", "continuous", ("base", "hand"), "", "<axis xyz=\"0 0 1\"/>"),
    ]);
    let link = plain(&text).robot.joints[0].row.link;
    assert_eq!((link.mass, link.com), (0.0, [0.0; 3]));
    assert_eq!(link.inertia, Inertia { zz: 0.35, ..Inertia::default() });
}

/// Pitfall 10: the triangle inequality is a lint, a negative moment an error, unless it is asked for.
#[test]
fn bodies_that_are_none() {
    let flat = pendulum("").replace("ixx=\"0.05\"", "ixx=\"0.5\"");
    let imported = plain(&flat);
    assert!(imported.account.lints.to_string().contains("no body has this inertia"), "{}", imported.account.lints);
    let negative = pendulum("").replace("izz=\"0.001\"", "izz=\"-0.0027\"");
    let message = refused(&negative, &Options::default());
    assert!(message.contains("the joint `hinge`") && message.contains("-2.700e-3 kg m²"), "{message}");
    assert!(message.contains("--keep-unphysical"), "{message}");
    let kept = import(&negative, &Options { keep_unphysical: true, ..Options::default() });
    assert!(kept.text.contains("physical: false"), "{}", kept.text);
    assert!(!kept.robot.joints[0].is_physical());
}

/// 50² 2e-4 N m s/rad and 50 (0.03 + 0.01)/2 N m; a friction without a gear comes back to the last digit.
#[test]
fn friction_goes_through_the_gear_to_the_joint() {
    let text = |motor: &str| {
        format!(
            "{{format: 1, name: arm, source: own, convention: standard, gravity: [0, 0, -9.81], joints: [{{type: \
             revolute, dh: {{theta: 0, d: 0, a: 1, alpha: 0}}, link: {{mass: 1}}, motor: {motor}}}]}}"
        )
    };
    let exported =
        |motor: &str| rne_convert::export(&Robot::from_yaml(&text(motor)).unwrap_or_else(|e| panic!("{e}"))).unwrap();
    let geared = exported("{inertia: 1e-4, gear_ratio: -50, viscous: 2e-4, coulomb: [0.03, -0.01]}");
    assert!(geared.text.contains("<dynamics damping=\"0.5\" friction=\"1\"/>"), "{}", geared.text);
    for part in ["motors are left out, but for their friction", "is written as its mean", ": joint1"] {
        assert!(geared.remarks.iter().any(|remark| remark.contains(part)), "{part}: {:?}", geared.remarks);
    }
    let direct = exported("{viscous: 0.1, coulomb: [0.3, -0.3]}");
    assert_eq!(direct.remarks, [""; 0]);
    let back = plain(&direct.text).robot.joints[0].motor.expect("friction");
    assert_eq!((back.viscous, back.coulomb, back.gear_ratio, back.inertia), (0.1, [0.3, -0.3], 1.0, 0.0));
    for key in ["coulomb_width: 0.02", "coulomb_displacement: 0.003"] {
        let smooth = exported(&format!("{{coulomb: [0.3, -0.3], {key}}}"));
        assert!(
            smooth.remarks[0].contains("changes its sign") && smooth.remarks[0].ends_with(": joint1"),
            "{smooth:?}"
        );
        assert!(smooth.remarks.len() == 1 && smooth.text.contains("<!-- how Coulomb friction"), "{}", smooth.text);
    }
    let rotor = exported("{inertia: 1e-4, gear_ratio: 50}");
    assert!(!rotor.text.contains("dynamics") && rotor.remarks.len() == 1, "{rotor:?}");
    let huge = exported("{inertia: 1e-4, gear_ratio: 1e160, viscous: 1}");
    assert!(!huge.text.contains("dynamics") && huge.remarks.len() == 2, "{huge:?}");
}

#[test]
fn friction_becomes_that_of_a_motor_without_a_gear() {
    let text = pendulum("<axis xyz=\"0 1 0\"/><dynamics damping=\"0.5\" friction=\"0.2\"/>");
    let imported = plain(&text);
    assert!(imported.text.contains("motor: {viscous: 0.5, coulomb: [0.2, -0.2]}"), "{}", imported.text);
}

#[test]
fn the_base_may_stand_anywhere() {
    let text = planar("xyz=\"0.4 0 0\"").replace("xyz=\"0 0 0\"", "xyz=\"0.1 0.2 0.3\" rpy=\"0 0 0.5\"");
    let options = Options {
        selection: Selection { base: Some("one".to_owned()), lock_others: true, ..Selection::default() },
        ..Options::default()
    };
    let imported = import(&text, &options);
    assert_eq!(imported.robot.dof(), 1);
    assert_eq!(imported.robot.base.xyz[2], 0.3);
    assert_eq!(imported.account.held, [("a".to_owned(), 0.0)]);
    let alone = Options { selection: Selection { lock_others: false, ..options.selection.clone() }, ..options };
    assert!(refused(&text, &alone).contains("movable joints off the chain"));
    let above = Options {
        selection: Selection { base: Some("tip".to_owned()), tip: Some("one".to_owned()), ..Selection::default() },
        ..Options::default()
    };
    let message = refused(&text, &above);
    assert!(message.contains("the link `tip` does not lead to `one`"), "{message}");
}

/// The text of a robot file is what a person would write.
#[test]
fn the_robot_file_is_for_people() {
    let text = planar("xyz=\"0.4318 0 0\" rpy=\"1.5708 0 0\"")
        .replace("lower=\"-1\"", &format!("lower=\"-{}\"", rne_model::number("deg(170)").unwrap()));
    insta::assert_snapshot!(plain(&text).text);
}

#[test]
fn all_texts_of_a_robot_come_back() {
    let mut robot = plain(&pendulum("")).robot;
    for text in
        ["a: b", "- a", "null", "it's \"x\"", "a\u{2028}b", "#1", "é ü 漢字", "1.5", "{x}", "a #b", "a  b", "[", "\\n"]
    {
        robot.source = text.to_owned();
        robot.notes = Some(format!("- {text}\n- second"));
        if !text.contains('\u{2028}') {
            robot.title = Some(text.to_owned());
            robot.joints[0].name = text.to_owned();
        }
        let written = robot_file::write(&robot);
        match Reader::new("written").read(&written) {
            Ok(checked) => assert_eq!(checked.robot, robot, "{written}"),
            Err(report) => panic!("{report}\n{written}"),
        }
    }
    robot.source = "word ".repeat(60).trim().to_owned();
    robot.notes = Some(" leading\n\nempty ".to_owned());
    let written = robot_file::write(&robot);
    assert_eq!(Reader::new("written").read(&written).unwrap().robot, robot, "{written}");
}
