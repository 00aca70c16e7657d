//! A whole URDF as a tree.

use super::*;

/// A waist that carries two arms of one joint, whose axes are in other directions, and a lamp on a fixed link. The left
/// arm has a gripper of two fingers that slide; the joint of the second one may follow the first.
fn torso(second_finger: &str) -> String {
    let arm = |name: &str, side: &str, axis: &str| {
        joint(name, "continuous", ("torso", name), &format!("xyz=\"0.1 {side} 0.4\" rpy=\"0.3 0 0.2\""), axis)
    };
    robot(&[
        bare(&["base", "tool0"]),
        link("torso", 10.0, "0 0 0.2", [0.3, 0.3, 0.2]),
        link("lamp", 0.5, "0 0 0.05", [0.001; 3]),
        link("left", 2.0, "0.2 0 0", [0.003, 0.03, 0.03]),
        link("right", 2.0, "0.2 0 0", [0.003, 0.03, 0.03]),
        link("finger_a", 0.1, "0 0.01 0", [1e-5; 3]),
        link("finger_b", 0.1, "0 -0.01 0", [1e-5; 3]),
        joint(
            "waist",
            "revolute",
            ("base", "torso"),
            "xyz=\"0 0 0.5\"",
            "<axis xyz=\"0 0 1\"/><limit lower=\"-2\" upper=\"1\" effort=\"9\" velocity=\"3\"/>",
        ),
        joint("to_lamp", "fixed", ("torso", "lamp"), "xyz=\"0 0 0.6\"", ""),
        arm("left", "0.2", "<axis xyz=\"0 1 0\"/>"),
        joint(
            "a",
            "prismatic",
            ("left", "finger_a"),
            "xyz=\"0.4 0 0\"",
            "<axis xyz=\"0 1 0\"/><limit lower=\"0\" upper=\"0.04\" effort=\"9\" velocity=\"3\"/>",
        ),
        joint("b", "prismatic", ("left", "finger_b"), "xyz=\"0.4 0 0\"", second_finger),
        arm("right", "-0.2", "<axis xyz=\"0 0.6 0.8\"/>"),
        joint("to_tool", "fixed", ("right", "tool0"), "xyz=\"0.4 0 0\"", ""),
    ])
}

const FREE: &str = "<axis xyz=\"0 -1 0\"/><limit lower=\"0\" upper=\"0.04\" effort=\"9\" velocity=\"3\"/>";

fn options() -> Options {
    let selection = Selection { whole: true, ..Selection::default() };
    Options { selection, convention: Convention::Modified, snap: false, ..Options::default() }
}

/// The comparison of the import is with Newton-Euler in the frames of the URDF's links.
#[test]
fn every_joint_is_a_row_below_its_parent() {
    let Imported { robot, text, account, .. } = Urdf::read("torso.urdf", &torso(FREE))
        .and_then(|urdf| urdf.import(&options()))
        .unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(Reader::new("written").trees().read(&text).unwrap().robot, robot, "reading gives the robot");
    let rounding = account.rounding;
    assert!(rounding.torque < 1e-14 && rounding.position < 1e-14 && rounding.rotation < 1e-14, "{rounding:?}");
    let names: Vec<&str> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names, ["waist", "left", "a", "b", "right"], "branch by branch");
    let parents: Vec<_> = (0..5).map(|joint| robot.parent(joint)).collect();
    assert_eq!(parents, [None, Some(0), Some(1), Some(1), Some(0)]);
    // frame 0 is the base
    assert_eq!((robot.gravity, robot.base), ([0.0, 0.0, -GRAVITY], rne_model::Transform::IDENTITY));
    assert_eq!(robot.joints[0].limits.position, Some((-2.0, 1.0)));
    assert_eq!(robot.joints[0].row.link.mass, 10.5, "the lamp is part of the torso");
    assert_eq!(account.lumped, [("waist".to_owned(), vec!["torso".to_owned(), "lamp".to_owned()])]);
    // the tip that is called so, and the others in a note
    assert_eq!(robot.tip().on, Some(4));
    assert!(
        account.sentences().iter().any(|remark| remark.contains("the tip is `tool0`")),
        "{:?}",
        account.sentences()
    );
    // the first joint on a link continues its frame, the second begins elsewhere
    assert!(robot.joints[1].branch.is_none() && robot.joints[2].branch.is_none(), "{text}");
    assert!(
        text.contains("  - name: right\n    parent: waist\n    type: revolute\n    dh: {gamma: 0, b: 0.658"),
        "{text}"
    );
    assert!(text.contains("  - name: b\n    parent: left\n    type: prismatic\n    dh: {theta: 0, "), "{text}");
}

#[test]
fn the_tip_may_be_any_moved_link() {
    let selection = Selection { tip: Some("finger_b".to_owned()), ..options().selection };
    let urdf = Urdf::read("torso.urdf", &torso(FREE)).unwrap();
    let robot = urdf.import(&Options { selection, ..options() }).unwrap().robot;
    assert_eq!(robot.tip().on, Some(3));
    let selection = Selection { tip: Some("base".to_owned()), ..options().selection };
    let message = refused(&torso(FREE), &Options { selection, ..options() });
    assert!(message.contains("no movable joint moves the tip `base`"), "{message}");
}

#[test]
fn a_tree_that_no_table_has_is_refused_with_what_to_do() {
    let message = refused(&torso(FREE), &Options { convention: Convention::Standard, ..options() });
    assert!(message.contains("`modified`"), "{message}");
    let ball = torso(FREE).replace("name=\"right\" type=\"continuous\"", "name=\"right\" type=\"planar\"");
    let message = refused(&ball, &options());
    assert!(message.contains("more than one freedom") && message.contains("`right`"), "{message}");
}

/// A follower becomes a coupling; the torques are those of the free tree, projected: the finger that is followed moves
/// both, and the reaction on the arm is that of two fingers.
#[test]
fn followers_become_couplings() {
    let with = |mimic: &str| torso(&format!("{FREE}{mimic}"));
    let import = |text: &str, selection: Selection| {
        Urdf::read("torso.urdf", text).and_then(|urdf| urdf.import(&Options { selection, ..options() }))
    };
    let whole = || options().selection;
    let text = with("<mimic joint=\"a\" multiplier=\"-0.5\" offset=\"0.01\"/>");
    let Imported { robot, text, account, .. } = import(&text, whole()).unwrap_or_else(|e| panic!("{e}"));
    assert!(account.rounding.torque < 1e-14, "{:?}", account.rounding);
    assert!(text.contains("couplings:\n  - {joint: b, follows: {a: -0.5}, offset: 0.01}\n"), "{text}");
    let read = Reader::new("written").trees().couplings().read(&text).unwrap().robot;
    assert_eq!(read, robot, "reading gives the robot");
    assert_eq!((robot.dof(), robot.joints.len()), (4, 5));
    let mut free = robot.clone();
    free.joints[3].coupling = None;
    let [coupled, free] = [&robot, &free].map(rne_runtime::DynArm::from_robot);
    let all = |[waist, left, a, right]: [f64; 4], offset: f64| [waist, left, a, -0.5 * a + offset, right];
    let (q, qd, qdd) = ([0.3, -0.7, 0.02, 1.1], [1.0, -2.0, 0.5, 0.7], [3.0, 2.0, -1.0, 0.4]);
    let found = coupled.inverse_dynamics(&q, &qd, &qdd).unwrap();
    let torques = free.inverse_dynamics(&all(q, 0.01), &all(qd, 0.0), &all(qdd, 0.0)).unwrap();
    let expected = [torques[0], torques[1], torques[2] - 0.5 * torques[3], torques[4]];
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
    // over a follower, a joint follows what that follows
    let chain = with("<mimic joint=\"a\"/>").replace(
        "<joint name=\"right\" type=\"continuous\">",
        "<joint name=\"right\" type=\"continuous\"><mimic joint=\"b\" multiplier=\"3\" offset=\"1\"/>",
    );
    let text = import(&chain, whole()).unwrap_or_else(|e| panic!("{e}")).text;
    assert!(text.contains("{joint: right, follows: {a: 3}, offset: 1}"), "{text}");
    // held, or following what is held
    let lock = |name: &str| Selection { lock: vec![(name.to_owned(), 0.01)], ..whole() };
    let held = import(&with("<mimic joint=\"a\"/>"), lock("b")).unwrap();
    assert_eq!((held.robot.dof(), &held.account.held[0].0), (4, &"b".to_owned()));
    let message = import(&with("<mimic joint=\"a\"/>"), lock("a")).unwrap_err().to_string();
    assert!(message.contains("`b` follows `a`, which is locked"), "{message}");
    let others = Selection { lock_others: true, ..whole() };
    assert_eq!(import(&with("<mimic joint=\"a\"/>"), others).unwrap().robot.joints.len(), 5, "others are locked");
}

fn imported(text: &str, options: &Options) -> rne_model::Robot {
    let imported = Urdf::read("torso.urdf", text).and_then(|urdf| urdf.import(options));
    imported.unwrap_or_else(|report| panic!("{report}")).robot
}

/// URDF+: from the link that carries both, what moves the successor is what moves the predecessor, times the ratio.
#[test]
fn gears_couple_joints() {
    let coupling = |predecessor: &str, successor: &str, ratio: &str| {
        format!(
            "<coupling name=\"gear\"><predecessor link=\"{predecessor}\"/><successor link=\"{successor}\"/>{ratio}\
             </coupling></robot>"
        )
    };
    let with = |gear: &str| torso(FREE).replace("</robot>", gear);
    let six = "<ratio value=\"-6\"/>";
    let follows = |gear: &str| {
        let robot = imported(&with(gear), &options());
        let follower = |joint: &rne_model::Joint| Some((joint.name.clone(), joint.coupling.clone()?.follows));
        robot.joints.iter().filter_map(follower).collect::<Vec<_>>()
    };
    assert_eq!(follows(&coupling("finger_a", "finger_b", six)), [("b".to_owned(), vec![(2, -6.0)])]);
    // `finger_a` is moved by `left` and `a` against the torso, which carries `right`
    assert_eq!(follows(&coupling("finger_a", "right", six)), [("right".to_owned(), vec![(1, -6.0), (2, -6.0)])]);
    // `b` and `left` together turn as `right` does: `b` is -6 q5 - q2
    assert_eq!(follows(&coupling("right", "finger_b", six)), [("b".to_owned(), vec![(1, -1.0), (4, -6.0)])]);
    for (gear, words) in [
        (coupling("finger", "right", six), "the link `finger`, which does not exist"),
        (coupling("finger_a", "lamp", six), "no joint moves the successor"),
        (coupling("finger_a", "right", ""), "no ratio other than zero"),
        ("<coupling/></robot>".to_owned(), "no element `predecessor`"),
        (
            coupling("finger_a", "finger_b", six).replace("</robot>", &coupling("finger_b", "right", six)),
            "the joint `right` follows `b`, which follows others itself",
        ),
    ] {
        let said = refused(&with(&gear), &options());
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn joints_before_the_base_are_held_by_name() {
    let selection = Selection { base: Some("torso".to_owned()), ..options().selection };
    let said = refused(&torso(FREE), &Options { selection: selection.clone(), ..options() });
    assert!(said.contains("movable joints that do not come after the base `torso`: `waist`"), "{said}");
    let locked = Selection { lock_others: true, ..selection };
    assert_eq!(imported(&torso(FREE), &Options { selection: locked, ..options() }).dof(), 4);
}

/// Without a fork, the file is that of an arm: what takes serial arms takes it.
#[test]
fn a_serial_arm_is_no_tree() {
    let arm = robot(&[
        bare(&["base", "tool0"]),
        link("upper", 2.0, "0.2 0 0", [0.003, 0.03, 0.03]),
        link("fore", 1.0, "0.1 0 0", [0.001, 0.01, 0.01]),
        joint(
            "shoulder",
            "continuous",
            ("base", "upper"),
            "xyz=\"0.1 0 0.1575\" rpy=\"0 0 0.5\"",
            "<axis xyz=\"0 0 1\"/>",
        ),
        joint("elbow", "continuous", ("upper", "fore"), "xyz=\"0.4 0 0\" rpy=\"0.3 0 0\"", "<axis xyz=\"0 1 0\"/>"),
        joint("to_tool", "fixed", ("fore", "tool0"), "xyz=\"0.3 0 0\"", ""),
    ]);
    let import = |whole: bool, convention: Convention| {
        let selection = Selection { whole, ..Selection::default() };
        converted(&arm, &Options { selection, convention, ..options() })
    };
    for convention in BOTH {
        let Imported { robot, text, account, .. } = import(true, convention);
        assert!(text.starts_with("format: 1\n") && robot.is_serial(), "{text}");
        assert!(account.rounding.torque < 1e-13 && account.rounding.position < 1e-13, "{:?}", account.rounding);
        let note = "no link carries two joints, so the robot is a serial arm and its file has `format: 1`";
        assert!(account.sentences().iter().any(|remark| remark == note) && text.contains(note), "{text}");
        let alone = import(false, convention).robot;
        assert_eq!((robot.joints, robot.base, robot.tool), (alone.joints, alone.base, alone.tool));
    }
    // a tip before the last joint needs a tree
    let selection = Selection { tip: Some("upper".to_owned()), ..options().selection };
    let tree = Urdf::read("arm.urdf", &arm).unwrap().import(&Options { selection, ..options() }).unwrap();
    assert!(tree.text.starts_with("format: 2\n"), "{}", tree.text);
}

/// Among several leaves, a leaf with the name of a tip comes first, and a finger that follows another one last.
#[test]
fn the_tip_is_the_leaf_that_is_called_so() {
    let follower = format!("{FREE}<mimic joint=\"a\"/>");
    for (tool, expected) in [
        ("tool0", "tool0"),
        ("hand_TCP", "hand_TCP"),
        ("tool_plate", "tool_plate"),
        ("x", "x"),
        ("rotor_7", "finger_a"),
        ("arm_visual", "finger_a"),
        ("ee", "ee"),
    ] {
        let text = torso(&follower).replace("tool0", tool);
        let urdf = Urdf::read("torso.urdf", &text).unwrap();
        assert_eq!(urdf.import(&options()).unwrap().account.tip, expected);
    }
    // without the right arm, the second finger is the last leaf
    let text = torso(&follower);
    let (before, _) = text.split_once("<joint name=\"right\"").expect("the right arm");
    let text = before.replace("<link name=\"tool0\"/>\n", "") + "</robot>";
    let (before, after) = text.split_once("<link name=\"right\">").expect("the right arm");
    let text = before.to_owned() + after.split_once("</link>\n").expect("an end").1;
    assert_eq!(Urdf::read("torso.urdf", &text).unwrap().import(&options()).unwrap().account.tip, "finger_a");
    let named = text.replace("\"finger_b\"", "\"finger_tool\"");
    assert_eq!(Urdf::read("torso.urdf", &named).unwrap().import(&options()).unwrap().account.tip, "finger_a");
}

/// A leaf with the name of a tip is the tip, wherever it stands among the leaves.
#[test]
fn names_of_tips_come_before_the_last_leaf() {
    for tip in ["ee", "ee_link", "left_end_effector", "flange", "panda_hand", "hand", "LF_FOOT", "foot_link"] {
        // the leaf `tool0`, which is the last one, has no such name
        let text = torso(FREE).replace("tool0", "plate").replace("finger_a", tip);
        let urdf = Urdf::read("torso.urdf", &text).unwrap();
        assert_eq!(urdf.import(&options()).unwrap().account.tip, tip);
    }
    // parts of other words
    for other in ["wheel", "hand_camera", "thigh_rotor_tool"] {
        let text = torso(FREE).replace("tool0", "plate").replace("finger_a", other);
        let urdf = Urdf::read("torso.urdf", &text).unwrap();
        assert_eq!(urdf.import(&options()).unwrap().account.tip, "plate", "{other}");
    }
}

/// Several tips become frames and the list `tips`; a wrench at one of them acts as one at the tip alone does.
#[test]
fn several_tips_are_listed() {
    let import = |tips: &[&str], frames: bool| {
        let names: Vec<String> = tips.iter().map(|&tip| tip.to_owned()).collect();
        let selection = Selection { tip: names.first().cloned(), ..options().selection };
        let options = Options { selection, more_tips: names[1..].to_vec(), frames, ..options() };
        Urdf::read("torso.urdf", &torso(FREE)).and_then(|urdf| urdf.import(&options))
    };
    let both = import(&["finger_b", "tool0"], false).unwrap_or_else(|report| panic!("{report}"));
    assert!(both.text.contains("\ntips: [finger_b, tool0]\n"), "{}", both.text);
    assert_eq!((both.robot.frames.len(), both.robot.tip().on), (2, Some(3)));
    assert!(both.account.rounding.position < 1e-12, "each tip is compared with itself: {:?}", both.account.rounding);
    let (q, qd, qdd) = ([0.3, -0.7, 0.02, 0.01, 1.1], [1.0, -2.0, 0.5, 0.2, 0.7], [3.0, 2.0, -1.0, 0.1, 0.4]);
    let wrench = Wrench { force: [1.0, -2.0, 3.0], moment: [0.3, 0.2, -0.1] };
    let arm = DynArm::from_robot(&both.robot);
    for (place, tip) in ["finger_b", "tool0"].into_iter().enumerate() {
        let mut wrenches = [Wrench::zero(); 2];
        wrenches[place] = wrench;
        let found = arm.inverse_dynamics_with_wrenches(&q, &qd, &qdd, &wrenches).unwrap();
        let alone = DynArm::from_robot(&import(&[tip], false).unwrap().robot);
        let expected = alone.inverse_dynamics_with_wrench(&q, &qd, &qdd, &wrench).unwrap();
        assert!(found.iter().zip(&expected).all(|(a, b)| f64::abs(a - b) < 1e-12), "{tip}: {found:?} {expected:?}");
    }
    assert!(import(&["finger_b", "tool0"], true).unwrap().robot.frames.len() > 5, "all links are frames");
    for (tips, words) in [
        (["tool0", "tool0"], "the tip `tool0` is named twice"),
        (["tool0", "base"], "no movable joint moves the tip `base"),
        (["tool0", "tool"], "no link `tool` that could be the tip"),
    ] {
        let said = import(&tips, false).unwrap_err().to_string();
        assert!(said.contains(words), "{said}");
    }
}

/// A camera in the middle of the arm is no tip, in whatever order the joints stand; a name of a tip is, there as well.
#[test]
fn the_tip_is_on_the_last_joint_unless_its_name_says_more() {
    let moving = |name: &str, links| joint(name, "revolute", links, "xyz=\"0 0 0.3\"", FREE);
    let fixed = |name: &str, links| joint(name, "fixed", links, "xyz=\"0 0 0.1\"", "");
    let body = |name: &str| link(name, 1.0, "0 0 0.1", [0.01; 3]);
    for (end, inner, tip) in [("end", "camera", "end"), ("end", "tool0", "tool0"), ("tip", "link_1", "tip")] {
        let mut joints = [
            moving("a", ("base", "upper")),
            moving("b", ("upper", "fore")),
            fixed("c", ("fore", end)),
            fixed("d", ("upper", inner)),
        ];
        for _ in 0..joints.len() {
            joints.rotate_left(1);
            let links = [bare(&["base", end, inner]), body("upper"), body("fore"), joints.concat()];
            let urdf = Urdf::read("arm.urdf", &robot(&links)).unwrap_or_else(|error| panic!("{error}"));
            let account = urdf.import(&options()).unwrap_or_else(|error| panic!("{error}")).account;
            assert_eq!(account.tip, tip, "{:?}", account.remarks);
        }
    }
}

/// The error has the place in the URDF, not one in the robot file, which nobody has seen.
#[test]
fn a_joint_with_the_name_of_frame_0_is_refused_where_it_stands() {
    let text = torso(FREE).replace("name=\"waist\"", "name=\"base\"");
    let refused = Urdf::read("torso.urdf", &text).and_then(|urdf| urdf.import(&options())).expect_err("two meanings");
    let said = refused.to_string();
    let line = 1 + text.lines().position(|line| line.contains("<joint name=\"base\"")).expect("the joint");
    assert!(said.contains("the joint `base` has the name") && said.contains(&format!("torso.urdf:{line}:")), "{said}");
}
