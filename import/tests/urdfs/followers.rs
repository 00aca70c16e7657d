//! Joints that follow others: held by name, or refused.

use super::*;

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
        assert!(message.contains("follow moving joints of the chain: `k` follows `j`"), "{message}");
        assert!(message.contains("lock each of these joints by its name; LockJoint { joint: \"k\" }"), "{message}");
        assert!(message.contains("arm.urdf:"), "{message}");
        let held = import(&text, &select(&[("k", 0.0)], true)).account;
        assert_eq!(held.sentences(), ["the joint k is locked, although it follows j, which moves"]);
    }
    assert!(refused(&with_follower("base", 2.0, mimic), &select(&[], false)).contains("`k` follows `j`"));
    let note = "the joint k follows j, which moves; no link after it has mass, so rne locks it";
    let light = import(&with_follower("arm", 0.0, mimic), &select(&[], true));
    assert_eq!(light.account.sentences(), [note]);
    assert!(light.text.contains(note), "{}", light.text);
    // one that has a multiplier of zero does not move
    let still = "<mimic joint=\"j\" multiplier=\"0\" offset=\"0.25\"/>";
    let held = import(&with_follower("arm", 2.0, still), &select(&[], true)).account;
    assert_eq!((held.held.clone(), held.sentences()), (vec![("k".to_owned(), 0.25)], Vec::new()));
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
    assert_eq!(locked(&[("j", 0.3), ("k", -0.3)]).sentences(), [""; 0]);
    let note = "the joint k is locked at 0.5, although it follows j, whose position would put it at -0.3";
    assert_eq!(locked(&[("j", 0.3), ("k", 0.5)]).sentences(), [note]);
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
    assert!(message.contains("the joint `k` follows `x`, but the file has no such joint"), "{message}");
    assert!(message.contains("lock the joint; LockJoint { joint: \"k\" }"), "{message}");
    let more =
        format!("<link name=\"c\"/>{}</robot>", joint("l", "continuous", ("arm", "c"), "", "<mimic joint=\"y\"/>"));
    let message = refused(&nobody.replace("</robot>", &more), &options(&[]));
    assert!(message.contains("follow others that the file has not: `k` follows `x`, `l` follows `y`"), "{message}");
    let circle = with_follower("arm", 2.0, "<mimic joint=\"l\"/>").replace(
        "</robot>",
        &format!("<link name=\"c\"/>{}</robot>", joint("l", "continuous", ("arm", "c"), "", "<mimic joint=\"k\"/>")),
    );
    let message = refused(&circle, &options(&[]));
    assert!(message.contains("form a circle"), "{message}");
    assert_eq!(import(&circle, &options(&[("k", 0.2)])).account.held, [("k".to_owned(), 0.2), ("l".to_owned(), 0.2)]);
    let itself = with_follower("arm", 2.0, "<mimic joint=\"k\"/>");
    assert!(refused(&itself, &options(&[])).contains("follows `k`, and the `mimic` elements form a circle"));
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
    let told = import(&text, &held_at(3.0)).account.sentences();
    assert_eq!(told, ["the joint k is locked at 3, which is outside of its limits, from -0.5 to 1"]);
    for value in [-0.5, 0.0, 1.0] {
        assert_eq!(import(&text, &held_at(value)).account.sentences(), Vec::<String>::new(), "{value}");
    }
    for value in [8_388_608.0, 1e15, -1e16, 1e300, f64::NAN, f64::INFINITY] {
        let message = refused(&text, &held_at(value));
        assert!(message.contains("the joint `k` cannot be locked at"), "{message}");
        assert!(message.contains("below 8388608 rad"), "{message}");
    }
    for angle in ["8388608", "1e15", "-1e16", "1e300"] {
        let message = refused(&with_end(&format!("rpy=\"0 0 {angle}\"")), &held_at(0.0));
        assert!(message.contains(&format!("`rpy` of `origin` is `0 0 {angle}`")), "{message}");
        assert!(message.contains("each below 8388608 rad"), "{message}");
    }
    import(&with_end("rpy=\"0 0 8388607\""), &held_at(0.0));
}
