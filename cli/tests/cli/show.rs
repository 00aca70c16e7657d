//! `rne show` and `rne ops`: listings and counts.

use std::collections::BTreeSet;

use crate::call::{ROOT, fails, fine, rne_reading};
use serde_json::Value;
use unicode_width::UnicodeWidthStr;

#[test]
fn one_joint_of_the_lectures_arm() {
    insta::assert_snapshot!(fine(&["show", "robots/planar1.yaml", "--joint", "1"]));
}

#[test]
fn every_component_with_what_it_is_left_of() {
    insta::assert_snapshot!("equations_of_one_link", fine(&["show", "planar1", "--equations"]));
    insta::assert_snapshot!("equations_of_two_links", fine(&["show", "planar2", "--equations"]));
    insta::assert_snapshot!(
        "equations_of_a_prismatic_joint",
        fine(&["show", "stanford", "--equations", "--joint", "3"])
    );
    let puma = ["show", "puma560", "--equations", "--joint", "2", "--step", "4"];
    insta::assert_snapshot!("equations_of_a_step_of_puma560", fine(&puma));
    for arguments in [&puma[..], &["show", "cylindrical_rpp", "--equations"], &["explain", "f1_2_x", "fr3"]] {
        let text = fine(arguments);
        // below the heading with the counts
        let equations = text.split_once(" statements\n").map_or(text.as_str(), |(_, equations)| equations);
        let long = equations.lines().find(|line| line.width() > 80);
        assert_eq!(long, None, "lines of a projector");
    }
}

#[test]
fn equations_are_of_the_seven_steps() {
    fails(2, &["show", "puma560", "--equations", "--form", "reduced"], &["only the seven steps", "rne explain tricks"]);
    fails(2, &["show", "puma560", "--equations", "--joint", "7"], &["has no joint 7"]);
    let none = fine(&["show", "puma560", "--equations", "--function", "mass_matrix"]);
    assert!(none.contains("mass_matrix has no equations there"), "{none}");
}

#[test]
fn an_inspection_for_programs() {
    for form in ["seven_steps", "reduced"] {
        let json: Value = serde_json::from_str(&fine(&["show", "puma560", "--json", "--form", form])).expect("JSON");
        assert_eq!(json["schema"], "rne-inspection");
        assert_eq!((&json["version"], &json["form"]), (&1.into(), &form.into()));
        assert_eq!(json["outputs"].as_array().map(Vec::len), Some(6));
        assert_eq!(json["cells"].as_array().map(Vec::len), Some(if form == "reduced" { 0 } else { 42 }));
    }
}

/// docs/teaching/inspection.md tells every field there is, and no other.
#[test]
fn the_fields_of_an_inspection_are_written_down() {
    let page =
        std::fs::read_to_string(std::path::Path::new(ROOT).join("docs/teaching/inspection.md")).expect("the page");
    let rows = page.lines().filter_map(|line| line.strip_prefix("| `"));
    let told: BTreeSet<String> =
        rows.filter_map(|row| Some(row.split_once('`')?.0.rsplit('.').next()?.to_owned())).collect();
    let mut found = BTreeSet::new();
    for robot in ["stanford", "ur5", "docs/tree.yaml", "docs/gripper.yaml"] {
        let mut json: Value = serde_json::from_str(&fine(&["show", robot, "--json"])).expect("JSON");
        // keys that are names, not fields
        for table in ["names", "quantities"] {
            let values: Vec<Value> = json[table].as_object().expect("a table").values().cloned().collect();
            json[table] = values.into();
        }
        fields(&json, &mut found);
    }
    assert_eq!(told, found);
}

fn fields(json: &Value, found: &mut BTreeSet<String>) {
    match json {
        Value::Array(list) => list.iter().for_each(|value| fields(value, found)),
        Value::Object(table) => {
            for (key, value) in table {
                found.insert(key.clone());
                fields(value, found);
            }
        }
        _ => {}
    }
}

#[test]
fn what_a_name_in_the_code_is() {
    insta::assert_snapshot!("explain_a_component", fine(&["explain", "ddc2_x", "puma560"]));
    insta::assert_snapshot!("explain_a_shared_term", fine(&["explain", "wxd2_y_1", "puma560"]));
    let q = fine(&["explain", "q2", "puma560"]);
    assert!(q.contains("joint position, rad") && q.contains("used by   s2, c2"), "{q}");
    let reduced = fine(&["explain", "tau6", "puma560", "--form", "reduced"]);
    assert!(reduced.contains("let tau6 = "), "{reduced}");
    fails(2, &["explain", "w2z", "puma560"], &["there is no name `w2z`", "did you mean w2_z"]);
    // a vector is meant with its components, though `c2` is a name that is nearly the same
    fails(2, &["explain", "w7_z", "puma560"], &["there is no name `w7_z`", "puma560, which has 6 joints"]);
    // a vector: all of its components; letters as the lecture writes them
    let all = fine(&["explain", "w3", "puma560"]);
    let each = ["w3_x", "w3_y", "w3_z"].map(|name| fine(&["explain", name, "puma560"]));
    assert_eq!(all, each.join("\n"));
    for (letters, code) in [
        ("ω3_z", "w3_z"),
        ("ω̇3_x", "dw3_x"),
        ("c̈3_y", "ddc3_y"),
        ("τ2", "tau2"),
        ("q̈2", "qdd2"),
        ("ω3", "w3"),
        ("c̈3", "ddc3"),
        ("dw3", "dw3"),
        ("omega3", "w3"),
    ] {
        assert_eq!(fine(&["explain", letters, "puma560"]), fine(&["explain", code, "puma560"]), "{letters}");
    }
    assert_eq!(fine(&["explain", "quantities", "puma560"]), fine(&["explain", "quantities"]));
    fails(2, &["explain", "functons"], &["did you mean functions", "rne explain w2_z puma560"]);
    fails(1, &["explain", "w2_z", "nowhere.yaml"], &["nowhere.yaml"]);
}

#[test]
fn one_step_of_a_prismatic_joint() {
    insta::assert_snapshot!(fine(&["show", "robots/cylindrical_rpp.yaml", "--joint", "3", "--step", "4"]));
}

#[test]
fn velocities_are_shown_when_step_3_is() {
    let robot = "robots/planar2.yaml";
    let usual = fine(&["show", robot]);
    assert!(!usual.contains("let dc2_x") && !usual.contains("also computed"));
    let asked = fine(&["show", robot, "--step", "3"]);
    assert!(
        asked.contains("let dc2_x = ") && asked.contains("also computed, and counted above: velocities"),
        "{asked}"
    );
    assert!(!asked.contains("step 4"), "only step 3: {asked}");
    let kept = fine(&["show", robot, "--keep", "velocity,inertia_force"]);
    assert!(kept.contains("let dc2_x = ") && kept.contains("let f2_x = "), "{kept}");
}

#[test]
fn joints_and_steps_that_are_not_there() {
    let robot = "robots/puma560.yaml";
    for joint in ["0", "7"] {
        fails(2, &["show", robot, "--joint", joint], &["has no joint", "1 (j1)", "6 (j6)", "rne show --help"]);
    }
    fails(2, &["show", robot, "--joint", "one"], &["has no joint one", "1 (j1)"]);
    assert_eq!(fine(&["show", robot, "--joint", "j3"]), fine(&["show", robot, "--joint", "3"]));
    for step in ["0", "8", "x"] {
        fails(2, &["show", robot, "--step", step], &["1 angular velocity", "7 torque"]);
    }
    fails(2, &["show", robot, "--function", "torques"], &["did you mean inverse_dynamics?"]);
    fails(2, &["show", robot, "--function", "bias"], &["bias_torques", "rne explain functions lists all functions"]);
    fails(2, &["show", robot, "--form", "eight_steps"], &["seven_steps"]);
    fails(2, &["show", robot, "--keep", "speed"], &["velocity"]);
}

#[test]
fn the_reduced_form_says_its_choices_and_its_proof() {
    let robot = "robots/puma560.yaml";
    let shown = fine(&["show", robot, "--form", "reduced"]);
    for part in [
        "form reduced",
        "only the torques keep a physical meaning",
        "Identical to the seven steps but for a probability below 1e-100",
        "Choices:\n",
        "the last link is a spinning sphere without mass",
        "let tau6 = ",
    ] {
        assert!(shown.contains(part), "no `{part}` in {shown}");
    }
    assert!(shown.contains("rewritten by algebra") && !shown.contains("// joint 3, "), "no recursion: {shown}");
    let joint = fine(&["show", robot, "--form", "reduced", "--without", "rewriting", "--joint", "3"]);
    assert!(joint.contains("Choices:\n") && joint.contains("// joint 3, "), "{joint}");
    assert!(!joint.contains("// joint 2, "), "only joint 3: {joint}");
    assert!(!joint.contains("rewritten"), "{joint}");
    let joint = fine(&["show", robot, "--form", "reduced", "--joint", "3"]);
    assert!(joint.contains("a rewritten graph has no steps; --without rewriting shows the recursion"), "{joint}");
    let wrenches = fine(&["show", robot, "--form", "reduced", "--function", "joint_wrenches"]);
    assert!(wrenches.contains("joint_wrenches has one form, the seven steps"), "{wrenches}");
    fails(2, &["show", robot, "--without", "rewriting"], &["the seven steps use no tricks", "--form reduced"]);
    for arguments in [&["--keep", "velocity"][..], &["--step", "3"], &["--keep", "joint_force,omega"]] {
        let call: Vec<&str> = ["show", robot, "--form", "reduced"].iter().chain(arguments).copied().collect();
        fails(2, &call, &["only the seven steps have", "computes only torques"]);
    }
}

#[test]
fn the_base_is_written_as_the_table_is() {
    let text = std::fs::read_to_string(format!("{ROOT}/robots/planar1.yaml")).expect("a robot");
    let turned = text.replace("\njoints:", "\nbase: {rpy: [0, pi/2, -0.5]}\njoints:");
    let called = rne_reading(&["show", "-"], &turned);
    assert!(called.out.contains("roll pitch yaw (0, π/2, -0.5) rad"), "{called:?}");
}

#[test]
fn other_functions_for_reading() {
    let robot = "robots/planar2.yaml";
    let functions =
        ["mass_matrix", "forward_dynamics", "forward_kinematics", "jacobian", "kinetic_energy", "regressor"];
    let texts = functions.map(|function| {
        let text = fine(&["show", robot, "--function", function]);
        // the robot is the same
        text.split_once("\n\n").and_then(|(_, rest)| rest.split_once("\n\n")).expect("a listing").1.to_owned()
    });
    insta::assert_snapshot!(texts.join("\n"));
    let derivatives = ["show", robot, "--function", "inverse_dynamics_derivatives"];
    let with =
        |more: &[&'static str]| fine(&derivatives.iter().copied().chain(more.iter().copied()).collect::<Vec<_>>());
    for form in ["seven_steps", "reduced"] {
        let plain: &[&str] = if form == "reduced" { &["--without", "rewriting"] } else { &[] };
        let text = with(&[&["--form", form, "--joint", "1", "--step", "7"], plain].concat());
        assert!(text.contains("// joint 1, step 7: torque, by q̇1\n    let tau1_qd1 = "), "{text}");
        assert!(!text.contains("joint 2, ") && !text.contains("step 6"), "{text}");
    }
    assert!(with(&[]).contains("// returned: the rows of ∂τ/∂q, then those of ∂τ/∂q̇\n"));
    let nothing = fine(&["show", robot, "--function", "jacobian", "--step", "7"]);
    assert!(nothing.contains("jacobian has no code in this selection"), "{nothing}");
    assert!(fine(&["show", robot, "--function", "actuator_torques"]).contains("// returned\n    [zero, zero]"));
    assert!(fine(&["show", "robots/puma560.yaml", "--function", "actuator_torques"]).contains("// motor 6: G² Jm q̈"));
}

#[test]
fn what_the_torques_see_of_the_links() {
    insta::assert_snapshot!(fine(&["show", "robots/planar3.yaml", "--base-parameters"]));
    let puma = fine(&["show", "robots/puma560.yaml", "--base-parameters"]);
    for part in ["36 base parameters: ", "of the 60 inertial parameters", "mcx2 + 0.4318 (m2 + m3 + m4 + m5 + m6)"] {
        assert!(puma.contains(part), "no `{part}` in {puma}");
    }
    assert_eq!(puma, fine(&["show", "robots/puma560.yaml", "--base-parameters"]));
    for other in [&["--joint", "1"][..], &["--step", "2"], &["--function", "regressor"], &["--form", "reduced"]] {
        let call: Vec<&str> =
            ["show", "robots/puma560.yaml", "--base-parameters"].iter().chain(other).copied().collect();
        fails(2, &call, &["--base-parameters", other[0]]);
    }
}

#[test]
fn counts_as_json() {
    let json = fine(&["ops", "robots/planar1.yaml", "robots/puma560.yaml", "--json"]);
    let json: Value = serde_json::from_str(&json).expect("JSON");
    let entries = json.as_array().expect("a list");
    assert_eq!(entries.len(), 2 * 81, "40 functions, 41 with motors, two forms");
    for entry in entries {
        let keys: Vec<&str> = entry.as_object().expect("an object").keys().map(String::as_str).collect();
        let mut expected = ["robot", "function", "form", "mul", "add", "div", "sincos", "statements"];
        expected.sort_unstable();
        assert_eq!(keys, expected);
        for count in ["mul", "add", "div", "sincos", "statements"] {
            assert!(entry[count].is_u64(), "{entry}");
        }
    }
    let entry = entries.iter().find(|entry| entry["robot"] == "planar1" && entry["function"] == "gravity_torques");
    let entry = entry.expect("the lecture's arm at rest");
    assert_eq!((&entry["form"], &entry["mul"], &entry["sincos"]), (&"seven_steps".into(), &3.into(), &1.into()));
}

#[test]
fn counts_as_a_table() {
    insta::assert_snapshot!(fine(&["ops", "robots/planar2.yaml"]));
    let all = fine(&["ops", "robots/planar1.yaml", "robots/puma560.yaml"]);
    let rows = all.lines().filter(|line| line.contains("seven_steps"));
    let widths: Vec<usize> = rows.map(|line| line.chars().count()).collect();
    assert_eq!(widths.len(), 40 + 41);
    assert!(widths.iter().all(|width| *width == widths[0]), "aligned: {all}");
}

#[test]
fn counts_of_some_functions() {
    let robot = "robots/planar2.yaml";
    let some = fine(&["ops", robot, "--function", "mass_matrix,gravity_torques"]);
    let functions: Vec<_> = some.lines().skip(3).filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(functions, ["gravity_torques", "gravity_torques", "mass_matrix", "mass_matrix"], "{some}");
    assert!(!some.contains(" div "), "nothing is divided: {some}");
    assert!(fine(&["ops", robot, "--function", "forward_dynamics"]).contains(" div "));
    let without_motors = fine(&["ops", robot, "--json"]);
    assert!(!without_motors.contains("actuator_torques"));
    // the file holds the base; who asks for a function of a floating base gets it
    let floating = fine(&["ops", robot, "--function", "floating_euler_step"]);
    assert_eq!(floating.matches("floating_euler_step").count(), 2, "{floating}");
    fails(2, &["ops", robot, "--tricks", "--function", "mass_matrix"], &["--tricks", "--function"]);
    fails(2, &["ops", robot, "--function", "torques"], &["did you mean inverse_dynamics?"]);
}

#[test]
fn tricks_and_what_they_save() {
    let robot = "robots/puma560.yaml";
    let tricks = fine(&["ops", robot, "--tricks"]);
    assert!(tricks.starts_with("puma560\ntrick"), "{tricks}");
    for (trick, formula) in [("regrouping", "(4.4)"), ("gyrostat", "τ_n = c (ω̇'_z + q̈)"), ("axis-columns", "(5.3)")]
    {
        // a long formula goes on in the next line
        let from = tricks.find(&format!("\n {trick} ")).unwrap_or_else(|| panic!("no `{trick}` in {tricks}"));
        let line: Vec<&str> = tricks[from..].split_whitespace().take(40).collect();
        let line = line.join(" ");
        let saved: i64 = line.split_whitespace().nth(1).and_then(|word| word.parse().ok()).expect("a number");
        assert!(saved > 0 && line.contains(formula), "{line}");
    }
    assert!(!tricks.contains("last-frame"), "only those of its plan: {tricks}");

    let total = |more: &[&str]| {
        let arguments: Vec<&str> = ["ops", robot, "--json"].iter().chain(more).copied().collect();
        let json: Value = serde_json::from_str(&fine(&arguments)).expect("JSON");
        let entries = json.as_array().expect("a list");
        let entry = entries.iter().find(|entry| entry["function"] == "inverse_dynamics" && entry["form"] == "reduced");
        let entry = entry.expect("the reduced form");
        entry["mul"].as_u64().expect("products") + entry["add"].as_u64().expect("sums")
    };
    let (all, without) = (total(&["--without", "rewriting"]), total(&["--without", "gyrostat"]));
    let saved = |trick: &str| -> Option<u64> {
        let line = tricks.lines().find(|line| line.trim_start().starts_with(trick))?;
        line.split_whitespace().nth(1)?.parse().ok()
    };
    assert_eq!(saved("rewriting"), Some(all - total(&[])), "{tricks}");
    let line = tricks.lines().find(|line| line.trim_start().starts_with("gyrostat")).expect("the gyrostat");
    assert_eq!(line.split_whitespace().nth(1), Some((without - all).to_string().as_str()), "{line}");
    assert!(total(&["--without", "gyrostat,regrouping-targets"]) > without);

    let names = ["regrouping", "regrouping-targets", "gyrostat", "last-frame", "carried-prismatics", "axis-columns"];
    fails(2, &["ops", robot, "--without", "gyro"], &names);
    let names =
        ["parallel-groups", "offsets", "origin-shifts", "scales", "moment-forms", "scaled-twists", "unturned-frames"];
    fails(2, &["ops", robot, "--without", "gyro"], &names);
    fails(2, &["ops", robot, "--tricks", "--without", "gyrostat"], &["--tricks", "--without"]);
}

#[test]
fn base_parameters_that_no_double_can_see_are_marked() {
    let said = "Torques in double precision determine only 24 combinations";
    let text = fine(&["show", "tests/nearly_right/tilts_of_1e-7.yaml", "--base-parameters"]);
    assert!(text.contains(said) && text.lines().any(|line| line.starts_with("? ")), "{text}");
    let text = fine(&["show", "puma560", "--base-parameters"]);
    assert!(!text.contains("double precision") && !text.lines().any(|line| line.starts_with('?')), "{text}");
}

/// The table names the link that carries each joint, and formulas name all that a link carries.
#[test]
fn a_tree_is_shown_by_its_branches() {
    insta::assert_snapshot!("a_tree", fine(&["show", "docs/tree.yaml", "--joint", "1", "--step", "6"]));
    let reduced = fine(&["show", "docs/tree.yaml", "--form", "reduced", "--joint", "5"]);
    assert!(reduced.contains("// ω5 = R5ᵀ ω1 + q̇5 z") && !reduced.contains("ω4"), "{reduced}");
    let explained = fine(&["explain", "f0_1_x", "docs/tree.yaml"]);
    assert!(explained.contains("fc1_x_5 + fc1_x"), "{explained}");
}

/// The head of emitted code says where each row of a tree begins, and its names say which link carries a joint.
#[test]
fn emitted_code_of_a_tree_describes_the_tree() {
    for language in ["rust", "c"] {
        let arguments = ["emit", "docs/tree.yaml", "--lang", language, "--form", "seven_steps"];
        let text = fine(&[&arguments[..], &["--function", "joint_wrenches"]].concat());
        for line in [
            "row of right, in the link frame of waist: (0, 0, 0.3) m, roll pitch yaw (0, 0, -π/2) rad",
            "tool, in the link frame of finger_a: (0, 0, 0.04) m, roll pitch yaw (0, 0, 0) rad",
            "force exerted on link i by link h, which carries joint i",
        ] {
            assert!(text.contains(line), "{language}: {line}: {text}");
        }
        // link 1 carries link 5, and link 2 carries link 4
        assert!(["f1_5_x", "n1_5_z", "f2_4_z"].iter().all(|name| text.contains(name)), "{text}");
        assert!(!text.contains("f4_5") && !text.contains("n3_4") && !text.contains("i - 1"), "{text}");
    }
}

#[test]
fn a_trace_of_a_tree_is_refused() {
    let state = ["--q", "0,0,0,0,0", "--qd", "0,0,0,0,0", "--qdd", "0,0,0,0,0"];
    let arguments = [&["eval", "docs/tree.yaml"][..], &state].concat();
    assert!(fine(&arguments).contains("finger_b"));
    fails(2, &[&arguments[..], &["--trace"]].concat(), &["--trace takes serial arms, but the robot is a tree"]);
}

/// A leg of a quadruped is found by the names of its joints.
#[test]
fn joints_of_a_tree_have_their_names() {
    let shank = fine(&["show", "hyq", "--joint", "lh_kfe_joint", "--step", "6"]);
    assert!(shank.contains("// joint 6 (lh_kfe_joint), step 6: forces and moments"), "{shank}");
    let derivatives = fine(&["show", "hyq", "--joint", "6", "--function", "inverse_dynamics_derivatives"]);
    assert!(derivatives.contains("// joint 6 (lh_kfe_joint), step 7: torque, by q4"), "{derivatives}");
    // the link before link 4 is the base
    let explained = fine(&["explain", "f0_4_y", "hyq"]);
    assert!(explained.contains("by link h, which carries joint i") && !explained.contains("i - 1"), "{explained}");
}
