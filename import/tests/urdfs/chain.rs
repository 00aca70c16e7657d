//! The chain between a base and a tip: links that are lumped, joints that are held, and what no table can say.

use super::*;

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
    assert!(loose.contains("movable joints that are not on the chain from `base` to `tip`: `f`, `t`"), "{loose}");
    assert!(loose.contains("each at a position of its own or all at zero; LockOthers"), "{loose}");
    let named = import(&hand, &select(&[("f", 0.2), ("t", 0.4)], false));
    assert_eq!(named.robot.joints[0].row.link.com, [-0.05, 0.0, 0.0]);
    assert_eq!(named.account.aside, ["w"]);
    // The follower goes where its leader is held: 2 · 0.2 + 0.1 to the other side.
    let others = import(&hand, &select(&[("f", 0.2)], true));
    assert_eq!(others.account.held, [("f".to_owned(), 0.2), ("t".to_owned(), 0.5)]);
    assert_close(&others.robot.joints[0].row.link.com, &[-0.075, 0.0, 0.0], 1e-16);
    assert!(others.text.contains("the joint t is locked at 0.5"), "{}", others.text);
    let unknown = refused(&hand, &select(&[("g", 0.2)], true));
    assert!(unknown.contains("there is no joint `g`") && unknown.contains("`a`, `f`, `t`"), "{unknown}");
    let twice = refused(&hand, &select(&[("f", 0.2), ("f", 0.2)], true));
    assert!(twice.contains("`f` is locked twice"), "{twice}");
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
    assert!(message.contains("`base` has 2 end links"), "{message}");
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
    assert!(
        mimic.contains("the joint `b` on the chain follows `a`")
            && mimic.contains("or import the whole robot; WholeOrLock { joint: \"b\" }"),
        "{mimic}"
    );
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
