//! Every lint: where it points, what it says, and what it leaves alone.

use crate::common::{BASE, found, the_one, with};
use rne_model::{Checked, Reader, Severity};

/// A mass that is forgotten, unless it is said to be zero.
#[test]
fn a_centre_of_mass_has_a_mass() {
    let diagnostic = the_one("      mass: 2.5\n", "");
    assert_eq!(diagnostic.message, "link 1 has a centre of mass but no mass");
    assert!(diagnostic.help.is_some_and(|help| help.contains("without mass, delete `com`")));
    assert!(
        found(&with("      mass: 2.5\n      com: [0, 0, 0.3]\n", "")).diagnostics.is_empty(),
        "an inertia is no slip"
    );
    let said = found(&with("mass: 2.5", "mass: 0"));
    assert!(said.diagnostics.iter().all(|diagnostic| !diagnostic.message.contains("no mass")), "{said}");
}

/// A file without any link is one warning, not one for each joint.
#[test]
fn geometry_alone_is_told_once() {
    let joint = "  - {type: revolute, dh: {theta: 0, d: 0.1, a: 0.3, alpha: 0}}\n";
    let head = "format: 1\nname: x\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n";
    let said = found(&format!("{head}{}", joint.repeat(6)));
    let [warning] = &said.diagnostics[..] else { panic!("{said}") };
    assert_eq!(warning.message, "no link has a mass or an inertia: the file has the geometry only");
    let with_rotor = joint.replace("}}", "}, motor: {inertia: 1e-4, gear_ratio: 100}}");
    let said = found(&format!("{head}{joint}{with_rotor}"));
    assert!(said.diagnostics.iter().all(|diagnostic| diagnostic.message.contains("resist")), "{said}");
    let floating = head.replace("joints:", "floating_base: {name: trunk, link: {mass: 3}}\njoints:").replace('1', "2");
    let said = Reader::new("x").trees().read(&format!("{floating}{joint}")).expect("a robot").lints.to_string();
    assert!(!said.contains("geometry only") && said.contains("resist"), "{said}");
    let one = joint.replace("}}", "}, link: {mass: 1, com: [-0.1, 0, 0]}}");
    assert!(!found(&format!("{head}{joint}{one}")).to_string().contains("geometry only"));
}

/// One joint of three without friction is a slip; two of three, or a friction of zero, are meant.
#[test]
fn missing_friction_is_told() {
    let arm = |motors: &[&str]| {
        let joints = motors.iter().map(|motor| {
            format!(
                "  - {{type: revolute, dh: {{theta: 0, d: 0.1, a: 0.3, alpha: 0}}, link: {{mass: 3, inertia: \
                 {{xx: 0.1, yy: 0.1, zz: 0.02}}}}{motor}}}\n"
            )
        });
        let head = "format: 1\nname: x\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n";
        found(&(head.to_owned() + &joints.collect::<String>()))
    };
    let [viscous, coulomb] = [", motor: {viscous: 0.1}", ", motor: {coulomb: [0.1, -0.1]}"];
    for forgotten in ["", ", motor: {inertia: 1e-4}"] {
        let said = arm(&[viscous, forgotten, coulomb]);
        let [note] = &said.diagnostics[..] else { panic!("{said}") };
        assert_eq!(note.message, "joint 2 has no friction, but all other joints have");
        assert_eq!((note.severity, note.line), (Severity::Note, 8));
        assert!(note.help.as_deref().is_some_and(|help| help.contains("`motor: {viscous: 0}`")), "{said}");
    }
    for meant in [&[viscous, ", motor: {viscous: 0}", coulomb][..], &[viscous, "", ""], &["", "", ""], &[viscous, ""]] {
        assert_eq!(arm(meant).to_string(), "", "{meant:?}");
    }
}

/// Three or more links that are the same ball are an exporter's; two, or links that differ, are not.
#[test]
fn placeholders_are_told() {
    let arm = |links: &[(f64, f64)]| {
        let joints = links.iter().map(|(mass, moment)| {
            format!(
                "  - type: revolute\n    dh: {{theta: 0, d: 0.1, a: 0.3, alpha: 0}}\n    link: {{mass: {mass}, \
                 com: [-0.1, 0, 0], inertia: {{xx: {moment}, yy: {moment}, zz: {moment}}}}}\n"
            )
        });
        let head = "format: 1\nname: x\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n";
        found(&(head.to_owned() + &joints.collect::<String>()))
    };
    let said = arm(&[(3.0, 0.02), (2.0, 0.01), (2.0, 0.01), (2.0, 0.01)]);
    assert_eq!(said.diagnostics.len(), 1, "{said}");
    let diagnostic = &said.diagnostics[0];
    assert_eq!(diagnostic.message, "3 of 4 links with mass have 2 kg and 0.01 kg m² about every axis");
    assert_eq!(diagnostic.severity, Severity::Warning);
    assert!(said.to_string().contains("x.yaml:12:"), "{said}");
    for links in [
        &[(3.0, 0.02), (3.0, 0.02), (2.0, 0.01), (2.0, 0.01)][..],
        &[(2.0, 0.01), (2.0, 0.011), (2.0, 0.012), (2.0, 0.013)],
        &[(1.0, 0.01), (2.0, 0.01), (3.0, 0.01)],
        &[(1.0, 0.1), (4.0, 0.2), (5.0, 0.3), (6.0, 0.4), (2.0, 0.01), (2.0, 0.01), (2.0, 0.01)],
    ] {
        let said = arm(links);
        assert!(said.diagnostics.is_empty(), "{links:?}: {said}");
    }
}

/// Links of 1.9 to 2.1 kg for a robot of a tonne, as an exporter writes them who knows no material.
#[test]
fn a_sum_of_masses_that_is_small_for_the_reach_is_told() {
    let arm = |joints: usize, mass: f64, length: f64, kind: &str| {
        let joint = |index: usize| {
            let mass = mass * (1.0 + 0.01 * f64::from(u8::try_from(index).expect("few joints")));
            format!(
                "  - type: {kind}\n    dh: {{theta: 0, d: 0, a: {length}, alpha: 0}}\n    limits: {{position: \
                 [0, 1]}}\n    link: {{mass: {mass}, com: [-0.1, 0, 0], inertia: {{xx: 0.01, yy: 0.01, zz: 0.01}}}}\n"
            )
        };
        let head = "format: 1\nname: x\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n";
        found(&(head.to_owned() + &(0..joints).map(joint).collect::<String>()))
    };
    let said = arm(6, 2.0, 0.5, "revolute");
    let [diagnostic] = &said.diagnostics[..] else { panic!("{said}") };
    assert_eq!(diagnostic.message, "all links together have 12.3 kg, which is little for an arm with a reach of 3 m");
    assert_eq!(diagnostic.severity, Severity::Warning);
    let help = diagnostic.help.as_ref().expect("a help");
    assert!(help.contains("have more than 33.8 kg (1.25 kg per cubic metre of reach)"), "{help}");
    // a travel of 1 m each is reach, too
    let said = arm(6, 2.0, 0.0, "prismatic").to_string();
    assert!(said.contains("a reach of 6 m"), "{said}");
    // lengths in millimetres say nothing about masses
    let said = arm(6, 2.0, 260.0, "revolute").to_string();
    assert!(said.contains("millimetres?") && !said.contains("masses missing"), "{said}");
    for (joints, mass, length, kind) in
        // heavy enough, short enough, arms of textbooks, a snake, no reach at all
        [
            (6, 5.6, 0.5, "revolute"),
            (6, 2.0, 0.35, "revolute"),
            (3, 1.0, 1.0, "revolute"),
            (9, 1.0, 1.0, "revolute"),
            (6, 1.0, 0.0, "revolute"),
        ]
    {
        let said = arm(joints, mass, length, kind).to_string();
        assert!(!said.contains("reach"), "{said}");
    }
}

/// Mass that was moved between links says nothing about their sum.
#[test]
fn a_set_of_base_parameters_may_be_light() {
    let link = "{mass: 0.1, com: [0, 0, 0], inertia: {zz: 1}, physical: false}";
    let joint = format!("  - {{type: revolute, dh: {{theta: 0, d: 0, a: 0.5, alpha: 0}}, link: {link}}}\n");
    let moved = joint.replace("mass: 0.1, com: [0, 0, 0], ", "first_moment: [1, 0, 0], ");
    let head = "format: 1\nname: x\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n";
    let said = |joints: &str| found(&format!("{head}{joints}")).to_string();
    assert!(said(&joint.repeat(6)).contains("a reach of 3 m"));
    assert!(!said(&(joint.repeat(5) + &moved)).contains("reach"));
}

/// Its size is told where its squares overflow or vanish.
#[test]
fn gravity_of_any_size_is_told() {
    for (gravity, size) in
        [("[0, -1e300, 0]", "1e300"), ("[3e-300, -4e-300, 0]", "5e-300"), ("[1.7e308, 1.7e308, 0]", "1.79769e308")]
    {
        let message = the_one("[0, 0, -9.81]", gravity).message;
        assert!(message.contains(&format!("gravity accelerates by {size} m/s²")), "{message}");
    }
}

#[test]
fn lints() {
    for (old, new, line, column, message, help) in [
        (
            "coulomb: [0.395, -0.435]",
            "coulomb_width: 0.02, coulomb_displacement: 0.003",
            18,
            81,
            "rne ignores `coulomb_width` because `coulomb_displacement` is given",
            "keep only one of the two",
        ),
        (
            "alpha: pi/2",
            "alpha: 1.5708",
            11,
            41,
            "the angle `1.5708` is 3.67321e-6 rad off the right angle `pi/2`",
            "write `pi/2`",
        ),
        ("alpha: pi/2", "alpha: -1.5707", 11, 41, "the right angle `-pi/2`", "write `-pi/2`"),
        ("alpha: pi/2", "alpha: 3.1416", 11, 41, "the right angle `pi`", "write `pi`"),
        ("alpha: pi/2", "alpha: 4.7124", 11, 41, "the right angle `3*pi/2`", "write `3*pi/2`"),
        ("alpha: pi/2", "alpha: 6.2832", 11, 41, "the right angle `2*pi`", "write `2*pi`"),
        ("alpha: pi/2", "alpha: 1e-4", 11, 41, "the right angle `0`", "write `0`"),
        ("alpha: pi/2", "alpha: 3.1416/2", 11, 41, "the angle `3.1416/2` = 1.5708 is", "write `pi/2`"),
        ("alpha: pi/2", "alpha: -90", 11, 41, "the angle `-90` rad is more than a full turn", "write `deg(-90)`"),
        ("alpha: pi/2", "alpha: 180/2", 11, 41, "the angle `180/2` = 90 rad", "write `deg(…)`"),
        ("rpy: [0, 0, pi]", "rpy: [0, 0, 180]", 6, 36, "more than a full turn", "`deg(180)`"),
        (
            "[0, 0, -9.81]",
            "[0, 0, -9810]",
            5,
            10,
            "gravity accelerates by 9810 m/s²; on Earth it is 9.81 m/s²",
            "an acceleration in m/s²",
        ),
        ("[0, 0, -9.81]", "[0, 0, -1]", 5, 10, "gravity accelerates by 1 m/s²", "such as `[0, 0, -9.81]`"),
        (
            "[0, 0, -9.81]",
            "[0, 0, 9.81]",
            5,
            10,
            "gravity `[0, 0, 9.81]` points along the positive z",
            "`[0, 0, -9.81]`",
        ),
        ("d: 0.4", "d: 400", 11, 23, "the length `400` m is over 20 m", "lengths are in metres"),
        ("a: 0, alpha: pi/2", "a: -21, alpha: pi/2", 11, 31, "the length `-21` m", "metres"),
        ("com: [0, 0, 0.3]", "com: [0, 0, 300]", 14, 19, "the centre of mass lies `300` m from the origin", "metres"),
        (
            "com: [0, 0, 0.3]",
            "com: [0, 0, -5.1]",
            14,
            19,
            "`-5.1` m from the origin of the link frame, over 5 m",
            "metres",
        ),
        (
            "{xx: 0.1, yy: 0.12, zz: 0.02}",
            "{xx: 11, yy: 9, zz: 9}",
            15,
            16,
            "a radius of gyration of 2.09762 m, as if all of the 2.5 kg were 2.09762 m from",
            "1 kg mm² is 1e-6 kg m²",
        ),
        (
            "      inertia: {xx: 0.1, yy: 0.12, zz: 0.02}\n",
            "",
            13,
            13,
            "link 1 has the mass `2.5` kg and no inertia",
            "write `inertia: {}`",
        ),
        ("xyz: [0, 0, 1]", "xyz: [0, 0, 1000]", 6, 20, "the length `1000` m", "metres"),
        ("mass: 2.5", "mass: 2500", 13, 13, "the mass `2500` kg is over 2000 kg", "kilograms"),
        (
            "link: {mass: r, inertia: {",
            "link: {inertia: {xx: r/100, ",
            22,
            11,
            "no inertia resists joint 2: it moves without any torque or force",
            "give link 2 a mass: `link: {mass: …}` of joint 2",
        ),
        ("link: {mass: r, ", "link: {mass: r-r, ", 22, 18, "no inertia resists joint 2", "a mass"),
        ("{m: 1.5, ", "{m: 1.5, unused: 1, ", 7, 22, "the parameter `unused` is never used", "delete it"),
        (
            "[-pi, pi]",
            "[-180, 180]",
            17,
            24,
            "the position limits `[-180, 180]` rad are more than four turns",
            "`[deg(-180), deg(180)]`",
        ),
    ] {
        let lint = the_one(old, new);
        assert_eq!(lint.severity, Severity::Warning, "{new}");
        assert_eq!((lint.line, lint.column), (line, column), "{new}: {}", lint.message);
        assert!(lint.message.contains(message), "{new}: {}", lint.message);
        assert!(lint.help.as_deref().unwrap_or_default().contains(help), "{new}: {:?}", lint.help);
        assert!(Reader::new("x.yaml").read(&with(old, new)).is_ok(), "{new}: a lint is no error");
    }
}

/// Two names that look alike and are not the same.
#[test]
fn invisible_characters() {
    for (old, new, line, column, message, help) in [
        (
            "source: test",
            "title: 'an \u{200B}arm'\nsource: test",
            3,
            12,
            r"the invisible character U+200B is in `an \u{200b}arm`",
            "delete this character",
        ),
        (
            "source: ",
            "title: \"a long title of an\\u00ADarm\"\nsource: ",
            3,
            8,
            r"U+00AD is in `itle of an\u{ad}arm`",
            "type the word again",
        ),
        ("name: first", "name: fi\u{2060}rst", 9, 13, r"U+2060 is in `fi\u{2060}rst`", "delete this character"),
    ] {
        let lint = the_one(old, new);
        assert_eq!((lint.severity, lint.line, lint.column), (Severity::Warning, line, column), "{}", lint.message);
        assert!(lint.message.contains(message), "{new}: {}", lint.message);
        assert!(lint.help.as_deref().unwrap_or_default().contains(help), "{new}: {:?}", lint.help);
    }
}

/// What published tables have: seen by `rne check`, not repeated by each build.
#[test]
fn notes() {
    // of few digits: within what the last digit leaves it is a body
    assert_eq!(found(&with("zz: 0.02", "zz: 0.221")).to_string(), "");
    let impossible = the_one("zz: 0.02", "zz: 0.3");
    assert_eq!(impossible.severity, Severity::Warning);
    assert_eq!((impossible.line, impossible.column), (15, 16));
    assert!(
        impossible.message.contains("principal moments 0.1, 0.12 and 0.3 kg m², the largest is more than"),
        "{}",
        impossible.message
    );
    // the file says that it is meant
    let known = the_one("zz: 0.02}", "zz: 0.3}\n      physical: false");
    assert_eq!((known.severity, &known.message), (Severity::Note, &impossible.message));
    // only one moment, as in the table of a plane arm
    assert_eq!(found(&with("{xx: 0.1, yy: 0.12, zz: 0.02}", "{zz: 0.3}")).to_string(), "");
    let text = with("link: {mass: r, inertia: {", "motor: {inertia: 1e-4}\n    link: {inertia: {xx: r/100, ");
    let report = found(&text);
    assert_eq!((report.warnings().count(), report.notes().count()), (0, 1), "{report}");
    let note = report.notes().next().unwrap();
    assert_eq!(note.message, "no link's inertia resists joint 2, only the rotor of its motor does");
    assert_eq!((note.line, note.column), (23, 11));
}

/// A length in millimetres is told where it is written, which may be a parameter.
#[test]
fn millimetres_are_told_at_the_number() {
    for (text, line, column) in [
        (with("a: 0, alpha: pi/2", "a: 400, alpha: pi/2"), 11, 31),
        (with("r: 2*m", "r: 2*m, a2: 400").replace("a: 0, alpha: pi/2", "a: a2, alpha: pi/2"), 7, 34),
        (with("com: [0, 0, 0.3]", "com: [0, 0, 400]"), 14, 19),
    ] {
        let report = found(&text);
        let [lint] = &report.diagnostics[..] else { panic!("{report}") };
        assert_eq!((lint.line, lint.column), (line, column), "{report}");
        assert!(lint.help.as_deref().unwrap_or_default().contains("write `mm(400)`"), "{report}");
    }
}

const PLANE: &str = "format: 1
name: plane
source: test
convention: standard
gravity: [0, -9.81, 0]
joints:
";

/// Revolute joints, each with its alpha and its link.
fn arm(links: &[(&str, &str)]) -> String {
    links.iter().fold(PLANE.to_owned(), |text, (alpha, link)| {
        text + &format!("  - {{type: revolute, dh: {{theta: 0, d: 0, a: 0, alpha: {alpha}}}, link: {{{link}}}}}\n")
    })
}

#[test]
fn joints_that_nothing_resists() {
    let bar = "mass: 1, com: [0.3, 0, 0], inertia: {xx: 0.001, yy: 0.01, zz: 0.01}";
    // each: the arm, line and text underlined, what the one warning says, and what its help says
    for (links, line, underlined, message, help) in [
        (vec![("0", bar), ("0", "")], 8, "{}", "no inertia resists joint 2: it moves", "z axis: `inertia: {zz: …}`"),
        (vec![("0", bar), ("pi/2", "")], 8, "{}", "no inertia resists joint 2: it moves", "y axis: `inertia: {yy: …}`"),
        (vec![("0", bar), ("0.3", "")], 8, "{}", "no inertia resists joint 2: it moves", "the axis of joint 2, or"),
        // the tool of a wrist that is a point on the axis
        (vec![("0", bar), ("0", "mass: 0.2, com: [0, 0, 0.1]")], 8, "0.2", "no inertia resists joint 2: it", "{zz: …}"),
        (
            vec![("0", bar), ("0", "mass: 0.2, inertia: {xx: 1e-3, yy: 1e-3}")],
            8,
            "{xx: 1e-3, yy: 1e-3}",
            "no inertia resists joint 2: it moves",
            "{zz: …}",
        ),
        (
            vec![("0", ""), ("0", bar)],
            7,
            "{}",
            "no inertia resists joint 1 when the joints after it move against it",
            "{zz: …}",
        ),
    ] {
        let text = arm(&links);
        let report = found(&text);
        let [warning] = report.diagnostics.as_slice() else { panic!("{links:?}\n{report}") };
        assert_eq!(warning.severity, Severity::Warning);
        assert_eq!((warning.line, &text[warning.span.clone()]), (line, underlined), "{report}");
        assert!(warning.message.starts_with(message), "{report}");
        let found = warning.help.as_deref().unwrap_or_default();
        assert!(found.contains(help) && found.ends_with("(`forward_dynamics`) are not finite"), "{report}");
    }
    // all that it takes
    for link in ["inertia: {xx: 1e-6, zz: 1e-6}", "mass: 1e-3, com: [0, 0.001, 0], inertia: {}", bar] {
        assert_eq!(found(&arm(&[("0", bar), ("0", link)])).to_string(), "", "{link}");
    }
}

#[test]
fn masses_that_never_turn_need_no_inertia() {
    let slide = "  - {type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: pi/2}, link: {mass: 2}}\n";
    let turn = "  - {type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 2, com: [0.1, 0, 0]}}\n";
    assert_eq!(found(&format!("{PLANE}{slide}{slide}")).to_string(), "");
    let report = found(&format!("{PLANE}{slide}{turn}"));
    assert_eq!(report.short(), "robots/x.yaml:8:73: warning: link 2 has the mass `2` kg and no inertia");
}

#[test]
fn what_is_no_lint() {
    for (old, new) in [
        // Exact right angles, and angles that are not near one.
        ("alpha: pi/2", "alpha: 2*pi"),
        ("alpha: pi/2", "alpha: -2*pi"),
        ("alpha: pi/2", "alpha: deg(90)"),
        ("alpha: pi/2", "alpha: 1.5707963267948966"),
        ("alpha: pi/2", "alpha: 1.57"),
        ("alpha: pi/2", "alpha: 0.001"),
        // A thin rod: the triangle inequality is an equality.
        ("{xx: 0.1, yy: 0.12, zz: 0.02}", "{yy: 0.12, zz: 0.12}"),
        ("{xx: 0.1, yy: 0.12, zz: 0.02}", "{}"),
        // A massless link with inertia.
        ("mass: 2.5\n      com: [0, 0, 0.3]", "mass: 0"),
        // A point mass on purpose.
        ("{xx: 0.1, yy: 0.12, zz: 0.02}", "{ }"),
        ("com: [0, 0, 0.3]", "com: [0, 0, -5]"),
        ("{xx: 0.1, yy: 0.12, zz: 0.02}", "{xx: 9, yy: 9, zz: 9}"),
        ("d: 0.4", "d: 20"),
        // Along any other axis a sign says nothing, and an arm may float.
        ("[0, 0, -9.81]", "[9.81, 0, 0]"),
        ("[0, 0, -9.81]", "[0, 6.9, 6.9]"),
        ("[0, 0, -9.81]", "[0, 0, 0]"),
        ("[0, 0, -9.81]", "[0, 0, -10]"),
        ("[-pi, pi]", "[-8*pi, 8*pi]"),
    ] {
        assert_eq!(found(&with(old, new)).to_string(), "", "{new}");
    }
    // Metres, not radians: the joint slides.
    let text = format!("{BASE}    limits: {{position: [-180, 180]}}\n");
    assert_eq!(found(&text).to_string(), "");
}

#[test]
fn a_value_behind_an_alias_is_reported_once() {
    let text = with("dh: {theta: 0, d: 0.4", "dh: &dh {theta: 0, d: 400")
        .replace("dh: {theta: 0, d: 0, a: 0, alpha: 0}", "dh: *dh");
    let report = found(&text);
    assert_eq!(report.diagnostics.len(), 1, "{report}");
    assert_eq!((report.diagnostics[0].line, report.diagnostics[0].column), (11, 27));
}

#[test]
fn errors_come_before_warnings() {
    let report = found(&with("d: 0.4", "d: 400").replace("alpha: 0}", "alpha: x}"));
    assert_eq!(
        report.short(),
        "robots/x.yaml:21:39: error: unknown name `x`\nrobots/x.yaml:11:23: warning: the length `400` m is over 20 m"
    );
    assert_eq!((report.errors().count(), report.warnings().count()), (1, 1));
}

/// The base of one leg turns about the axis of its joint without any moment.
#[test]
fn a_floating_base_that_nothing_resists() {
    let body = "mass: 2, com: [0.1, 0.2, 0.3], inertia: {xx: 0.2, yy: 0.3, zz: 0.4}";
    let text = |base: &str, more: &str| {
        format!(
            "format: 2\nname: x\nsource: x\nconvention: modified\ngravity: [0, 0, -9.81]\ntool: {{on: j1}}\n\
             floating_base: {{name: trunk, link: {{{base}}}}}\njoints:\n  - {{name: j1, type: revolute, \
             dh: {{theta: 0, d: 0, a: 0.3, alpha: 0}}, link: {{{body}}}}}\n{more}"
        )
    };
    let said = |text: &str| Reader::new("x.yaml").trees().read(text).expect("it is right").lints;
    let report = said(&text("mass: 0", ""));
    let [warning] = report.diagnostics.as_slice() else { panic!("{report}") };
    assert_eq!((warning.severity, warning.line, warning.column), (Severity::Warning, 7, 43), "{report}");
    assert!(warning.message.starts_with("no inertia resists the floating base when the joints move"), "{report}");
    assert!(warning.help.as_deref().unwrap_or_default().contains("give this link its mass and inertia"), "{report}");
    // with a mass, with a leg on another axis, or with a body on it
    let other = format!(
        "  - {{name: j2, parent: base, type: revolute, dh: {{gamma: 0, b: 0, theta: 0, d: 0, a: 0, alpha: pi/2}}, \
         link: {{{body}}}}}\n"
    );
    let carried = format!("bodies:\n  - {{name: battery, on: base, {body}}}\n");
    for text in [text(body, ""), text("mass: 0", &other), text("mass: 0", &carried)] {
        let report = said(&text);
        assert!(!report.to_string().contains("resists"), "{report}");
    }
}

/// Frame 0 has the name `base`, so a joint of this name is told in each format, with the place of the name.
#[test]
fn a_joint_with_the_name_of_frame_0_is_told() {
    let row = "type: revolute, dh: {theta: 0, d: 0.1, a: 0.3, alpha: 0}, link: {mass: 1, com: [-0.1, 0, 0]}";
    for format in [1, 2] {
        for (name, is_told) in [("base", true), ("Base", false), ("basis", false), ("world", false), ("tip", false)] {
            let head = "source: own\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n";
            let said = found(&format!("format: {format}\nname: x\n{head}  - {{name: {name}, {row}}}\n  - {{{row}}}\n"));
            let told = said.diagnostics.iter().filter(|diagnostic| diagnostic.message.contains("name of frame 0"));
            assert_eq!(told.count(), usize::from(is_told), "format {format}, {name}: {said}");
            assert!(!is_told || said.to_string().contains("robots/x.yaml:7:12"), "{said}");
        }
    }
}

/// Frames that are far away because axes are nearly parallel have no lengths in millimetres.
#[test]
fn frames_of_nearly_parallel_axes_are_told_as_such() {
    let arm = |convention: &str, tilt: &str, far: f64, a: f64| {
        let joint = |d: f64, com: f64, alpha: &str| {
            format!(
                "  - type: revolute\n    dh: {{theta: 0, d: {d}, a: {a}, alpha: {alpha}}}\n    link: {{mass: 2, com: \
                 [0.1, 0, {com}], inertia: {{xx: 0.01, yy: 0.01, zz: 0.01}}}}\n"
            )
        };
        let head =
            format!("format: 1\nname: x\nsource: own\nconvention: {convention}\ngravity: [0, 0, -9.81]\njoints:\n");
        found(&(head + &joint(0.1, 0.0, "pi/2") + &joint(far, -far, tilt) + &joint(-far, 0.0, tilt)))
    };
    for convention in ["standard", "modified"] {
        let said = arm(convention, "0.0004", 536.0, 0.3);
        let told: Vec<_> =
            said.diagnostics.iter().filter(|one| one.label.as_deref() == Some("far from the arm")).collect();
        // d of joints 2 and 3, the centre of mass of link 2
        assert_eq!(told.len(), 3, "{said}");
        assert!(told.iter().all(|one| one.severity == Severity::Warning), "{said}");
        let help = told[0].help.as_ref().expect("a help");
        assert!(help.contains("The centre of mass of link 2 is 536 m away."), "{help}");
        assert!(!said.to_string().contains("millimetres"), "{said}");
    }
    // a long common normal, or no tilt
    for said in
        [arm("standard", "0.0004", 536.0, 300.0), arm("modified", "0", 536.0, 0.3), arm("modified", "pi/2", 536.0, 0.3)]
    {
        assert!(said.to_string().contains("millimetres?") && !said.to_string().contains("far from"), "{said}");
    }
    // a length that an arm can have
    for convention in ["standard", "modified"] {
        let far = |metres: f64, tilt: &str| {
            let said = arm(convention, tilt, metres, 0.3);
            said.notes().filter(|one| one.label.as_deref() == Some("far from the arm")).cloned().collect::<Vec<_>>()
        };
        let [note] = &far(4.0, "0.01")[..] else { panic!("one note") };
        assert_eq!(
            note.message,
            "the common normal of the axes of joints 2 and 3 is 4 m away, because these axes are nearly parallel"
        );
        for (metres, tilt) in [(1.9, "0.01"), (4.0, "0"), (4.0, "0.1"), (536.0, "0.0004")] {
            assert!(far(metres, tilt).is_empty(), "{metres} {tilt}");
        }
    }
}

/// Without `tips`, wrenches at `tip` act at the tool.
#[test]
fn a_frame_with_the_name_of_the_tip_is_told() {
    let text = |more: &str| {
        format!(
            "{{format: 2, name: x, source: own, convention: standard, gravity: [0, 0, -9.81], {more}\
             frames: [{{name: hand, on: j1, xyz: [0, 0, 0.1]}}, {{name: tip, on: j1, xyz: [0.1, 0, 0]}}], joints: [\
             {{name: j1, type: revolute, dh: {{theta: 0, d: 0, a: 1, alpha: 0}}, link: {{mass: 1, com: [0, 0, 0], \
             inertia: {{zz: 0.1}}}}}}]}}"
        )
    };
    let found = |more: &str| Reader::new("x").read(&text(more)).unwrap_or_else(|report| panic!("{report}"));
    let Checked { robot, lints, .. } = found("");
    assert!(robot.two_tips("tip").is_some() && robot.two_tips("hand").is_none());
    let told: Vec<_> = lints.warnings().filter(|warning| warning.message.contains("the name of the tip")).collect();
    let [warning] = &told[..] else { panic!("{lints}") };
    assert_eq!(warning.label.as_deref(), Some("two meanings"));
    let Checked { robot, lints, .. } = found("tips: [tip], ");
    assert!(robot.two_tips("tip").is_none() && !lints.to_string().contains("two meanings"), "{lints}");
}
