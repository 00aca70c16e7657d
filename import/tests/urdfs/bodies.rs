//! Bodies, friction and texts of a URDF in a robot file.

use super::*;

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
    assert!(imported.account.lints.to_string().contains("no body can have this inertia"), "{}", imported.account.lints);
    assert_eq!(imported.account.lints.warnings().count(), 1);
    let negative = pendulum("").replace("izz=\"0.001\"", "izz=\"-0.0027\"");
    let message = refused(&negative, &Options::default());
    assert!(message.contains("the joint `hinge`") && message.contains("-2.700e-3 kg m²"), "{message}");
    assert!(message.contains("or keep it; KeepUnphysical"), "{message}");
    let kept = import(&negative, &Options { keep_unphysical: true, ..Options::default() });
    assert!(kept.text.contains("physical: false"), "{}", kept.text);
    assert!(!kept.robot.joints[0].is_physical());
}

/// An inertia of a floating base that no body can have is refused or kept in the same way.
#[test]
fn a_base_that_is_no_body() {
    let urdf = pendulum("").replace(
        "<link name=\"base\"/>",
        "<link name=\"base\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" \
         izz=\"-0.3\"/></inertial></link>",
    );
    let selection = Selection { whole: true, floating: Some(true), ..Selection::default() };
    let options = Options { selection, convention: Convention::Modified, ..Options::default() };
    let message = refused(&urdf, &options);
    assert!(message.contains("the base `base` has the principal moment of inertia -3.000e-1 kg m²"), "{message}");
    assert!(message.contains("arm.urdf:") && message.contains("or keep it; KeepUnphysical"), "{message}");
    let options = Options { keep_unphysical: true, ..options };
    let kept = Urdf::read("arm.urdf", &urdf).and_then(|urdf| urdf.import(&options)).expect("a robot");
    assert_eq!(kept.robot.floating_base.expect("a base").link.inertia.zz, -0.3);
    assert!(kept.account.lints.to_string().contains("as `physical: false` allows"), "{}", kept.account.lints);
}

/// The import names a link whose inertia no body can have, even if the links that are fixed to it hide this. The link
/// is the motor of Talos' gripper (Gepetto/example-robot-data#130).
#[test]
fn a_part_that_is_no_body_is_told() {
    let motor = |yz: &str| {
        format!(
            "<link name=\"motor\"><inertial><origin xyz=\"0.02 0 0\"/><mass value=\"0.14765\"/><inertia \
             ixx=\"0.000115\" ixy=\"0.000052\" ixz=\"0.000025\" iyy=\"0.000153\" iyz=\"{yz}\" \
             izz=\"0.00019\"/></inertial></link>"
        )
    };
    let said = |yz: &str| {
        let text = robot(&[
            bare(&["base"]),
            link("hand", 1.0, "0 0 0.1", [0.01, 0.01, 0.01]),
            motor(yz),
            joint("wrist", "continuous", ("base", "hand"), "", "<axis xyz=\"0 0 1\"/>"),
            joint("screws", "fixed", ("hand", "motor"), "", ""),
        ]);
        warnings(&text)
    };
    let told = "no body can have the inertia of `motor` (line 4, column 77): its largest principal moment is 2.319e-4 \
                kg m², the sum of the two others is 2.261e-4 kg m²; is one number wrong by a power of ten?";
    assert_eq!(said("0.000034"), [told]);
    assert_eq!(said("0"), [""; 0]);
}

/// The warnings of the import of a URDF.
fn warnings(text: &str) -> Vec<String> {
    let remarks = plain(text).account.remarks.into_iter();
    remarks.filter(|remark| remark.is_warning).map(|remark| remark.text).collect()
}

/// One element that is off by a thousand, as in published URDFs: a warning at the element `inertia`. A moment that is
/// negative is refused there, and not at the joint.
#[test]
fn the_place_of_an_impossible_inertia_is_its_element() {
    let text = |ixx: &str, ixy: &str, iyy: &str, izz: &str| {
        let body = format!(
            "<link name=\"body\"><inertial><origin xyz=\"0 0 0.05\"/><mass value=\"0.5\"/>\n<inertia ixx=\"{ixx}\" \
             ixy=\"{ixy}\" ixz=\"0.0002\" iyy=\"{iyy}\" iyz=\"0\" izz=\"{izz}\"/></inertial></link>"
        );
        robot(&[bare(&["base"]), body, joint("j1", "continuous", ("base", "body"), "", "<axis xyz=\"0 0 1\"/>")])
    };
    let line = text("", "", "", "").lines().position(|line| line.starts_with("<inertia")).expect("a line") + 1;
    for (ixx, iyy, izz) in [("0.002", "0.000002", "0.0002"), ("2", "1", "4"), ("0.002", "0", "0.0002")] {
        let said = warnings(&text(ixx, "0", iyy, izz));
        let [message] = &said[..] else { panic!("{ixx}: {said:?}") };
        let place = format!("no body can have the inertia of `body` (line {line}, column 1): ");
        assert!(message.starts_with(&place), "{message}");
    }
    assert_eq!(warnings(&text("0.002", "0", "0.002", "0.0002")), [""; 0]);
    let report = refused(&text("0.70337", "0.70661", "-0.000139", "0.019169"), &Options::default());
    assert!(report.contains("the joint `j1`") && report.contains(&format!(":{line}:1")), "{report}");
}

/// Rods of a URDF that is rounded to some digits: they are bodies, also where the import turns their tensors, and the
/// robot file of the import can be read and has no warning.
#[test]
fn rounded_rods_are_imported() {
    let mut state = 3_u64;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(state >> 33).expect("31 bits")) / f64::from(1_u32 << 31)
    };
    for index in 0..300 {
        let u = [0; 3].map(|_| 2.0 * random() - 1.0);
        let square = u.iter().map(|x| x * x).sum::<f64>() + 1e-3;
        // a rod, or a plate
        let sign = if index % 3 == 0 { 1.0 } else { -1.0 };
        let size = 0.2 * random() + 0.02;
        let decimals = 4 + index % 4;
        let element = |i: usize, j: usize| {
            let one = if i == j { u.iter().map(|x| x * x).sum::<f64>() } else { 0.0 };
            format!("{:.decimals$}", size * (one + sign * u[i] * u[j]) / square)
        };
        let turn = format!("{:.3} {:.3} {:.3}", 3.0 * random(), random(), 3.0 * random());
        let body = format!(
            "<link name=\"body\"><inertial><origin xyz=\"0.1 0 0.05\" rpy=\"{turn}\"/><mass value=\"1\"/><inertia \
             ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/></inertial></link>",
            element(0, 0),
            element(0, 1),
            element(0, 2),
            element(1, 1),
            element(1, 2),
            element(2, 2)
        );
        let text =
            robot(&[bare(&["base"]), body, joint("j1", "continuous", ("base", "body"), "", "<axis xyz=\"1 2 2\"/>")]);
        let imported = converted(&text, &Options::default());
        assert!(
            imported.account.remarks.iter().all(|remark| !remark.is_warning),
            "{index}: {:?}",
            imported.account.remarks
        );
        let lints = &imported.account.lints;
        let of_inertia = lints.warnings().filter(|lint| lint.message.contains("inertia")).count();
        assert_eq!(of_inertia, 0, "{index}: {lints}");
    }
}

/// 50² 2e-4 N m s/rad and 50 (0.03 + 0.01)/2 N m; a friction without a gear comes back to the last digit.
#[test]
fn friction_goes_through_the_gear_to_the_joint() {
    let text = |motor: &str| {
        format!(
            "{{format: 1, name: arm, source: own, convention: standard, gravity: [0, 0, -9.81], joints: [{{type: \
             revolute, dh: {{theta: 0, d: 0, a: 1, alpha: 0}}, limits: {{velocity: 1, effort: 1}}, \
             link: {{mass: 1}}, motor: {motor}}}]}}"
        )
    };
    let exported =
        |motor: &str| rne_convert::export(&Robot::from_yaml(&text(motor)).unwrap_or_else(|e| panic!("{e}"))).unwrap();
    let geared = exported("{inertia: 1e-4, gear_ratio: -50, viscous: 2e-4, coulomb: [0.03, -0.01]}");
    assert!(geared.text.contains("<dynamics damping=\"0.5\" friction=\"1\"/>"), "{}", geared.text);
    for part in ["motors are left out, except their friction", "is written as its mean", ": joint1"] {
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
    let imported = converted(&text, &Options::default());
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
    assert!(refused(&text, &alone).contains("movable joints that are not on the chain"));
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

/// A loop of each kind of cut, on the base and on links, with names that need quotation marks.
#[test]
fn closed_loops_come_back() {
    let four_bar = include_str!("../../../docs/four_bar.yaml");
    let other =
        four_bar.replace("coupler", "\"rod: 2\"").replace("xyz: [0.3, 0, 0]", "xyz: [0.3, 0, 0], rpy: [0, 0, pi/2]");
    let spherical = four_bar.replace("cut: revolute ", "cut: spherical ").replace("name: pin", "name: \"1\"");
    let shaft =
        "format: 2\nname: shaft\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\ntool: {on: a}\njoints:
  - {name: a, type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}}
  - {name: b, parent: base, at: {rpy: [0.6, 0, 0]}, type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}}
loops: [{name: shaft, cut: universal, between: [{on: a}, {on: b}], dependent: [b]}]\n";
    let held = "format: 2\nname: held\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:
  - {name: a, type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: pi/2}}
  - {name: b, type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: -pi/2}}
  - {name: c, type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: pi/2}}
  - {name: d, type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}}
loops: [{cut: weld, between: [{on: base, rpy: [1, 0.2, 0]}, {on: d}], dependent: [b, c, d]}]\n";
    for text in [four_bar, &other, &spherical, shaft, held] {
        let read = |text: &str| {
            let read = Reader::new("loops").trees().couplings().loops().read(text);
            read.unwrap_or_else(|report| panic!("{report}\n{text}")).robot
        };
        let robot = read(text);
        assert!(!robot.closed.is_empty() && !robot.is_chain());
        let written = robot_file::write(&robot);
        assert_eq!(read(&written), robot, "{written}");
    }
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
