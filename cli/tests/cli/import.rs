//! `rne import`, `rne convert`, `rne export`.

use std::fs;

use crate::call::{fails, fine, folder, rne, rne_reading};

/// An arm of two joints with a finger on its hand.
const URDF: &str = r#"<robot name="Two Links">
  <link name="base"/>
  <link name="upper"><inertial><origin xyz="0.2 0 0"/><mass value="1.5"/>
    <inertia ixx="0" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial></link>
  <link name="lower"><inertial><origin xyz="0.15 0 0"/><mass value="1"/>
    <inertia ixx="0" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <link name="finger"/>
  <link name="tip"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="2" effort="30" velocity="3"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
    <origin xyz="0.4318 0 0" rpy="1.5708 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="2" effort="30" velocity="3"/></joint>
  <joint name="grip" type="prismatic"><parent link="lower"/><child link="finger"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.1" effort="5" velocity="1"/></joint>
  <joint name="flange" type="fixed"><parent link="lower"/><child link="tip"/><origin xyz="0.3 0 0"/></joint>
</robot>
"#;

/// Several ends behind the same joints are one arm: `tool0`, else the last one. Leaves on the base do not count.
#[test]
fn the_tip_of_one_arm_is_chosen() {
    let folder = folder("import_tip");
    let one_arm = URDF.replace("<joint name=\"grip\" type=\"prismatic\">", "<joint name=\"grip\" type=\"fixed\">");
    let with = |more: &str| one_arm.replace("</robot>", &format!("{more}</robot>"));
    let leaf = |name: &str, parent: &str| {
        format!(
            "<link name=\"{name}\"/><joint name=\"to_{name}\" type=\"fixed\"><parent link=\"{parent}\"/><child \
             link=\"{name}\"/><origin xyz=\"0.1 0 0\"/></joint>"
        )
    };
    let path = folder.join("one_arm.urdf");
    let urdf = path.to_str().expect("UTF-8");
    for (more, tip, others) in [
        (String::new(), "tip", "`finger`"),
        (leaf("tool0", "lower") + &leaf("ee_link", "lower"), "tool0", "`finger`, `tip`, `ee_link`"),
        (leaf("camera", "base"), "tip", "`finger`"),
    ] {
        fs::write(&path, with(&more)).expect("written");
        let chosen = rne(&["import", urdf]);
        assert_eq!(chosen.status, 0, "{tip}: {chosen:?}");
        let note = format!("the tip is `{tip}`; these links are also after the same joints: {others}");
        let words = chosen.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(&format!("note: {note}")), "{note}: {words}");
        // the file says it, too, and is otherwise that of the tip by name
        let noted = format!("  - {note}\n");
        assert_eq!(chosen.out.replacen(&noted, "", 1), rne(&["import", urdf, "--tip", tip]).out, "{tip}");
    }
}

#[test]
fn an_import_prints_the_robot_file_and_tells_what_it_did() {
    let folder = folder("import");
    let urdf = folder.join("arm.urdf");
    fs::write(&urdf, URDF).expect("written");
    let urdf = urdf.to_str().expect("UTF-8");
    let called = rne(&["import", urdf, "--tip", "tip", "--lock", "grip=0.05"]);
    assert_eq!(called.status, 0, "{called:?}");
    insta::assert_snapshot!(called.out);
    for part in [
        "two_links: 2 joints, fixed base",
        "from base to tip",
        "grip is locked at 0.05",
        "joint elbow, roll: 1.5708 is pi/2",
        "over 1,000 states",
    ] {
        assert!(called.err.contains(part), "no `{part}` in {}", called.err);
    }
    fails(
        1,
        &["import", urdf],
        &["`base` has 2 end links", "`finger` (3 joints)", "`tip` (2 joints)", "--tip", "--whole"],
    );
    fails(
        1,
        &["import", urdf, "--tip", "tip"],
        &["movable joints that are not on the chain", "`grip`", &format!("{urdf}:14:3")],
    );
    fails(1, &["import", "no.urdf"], &["there is no URDF no.urdf"]);
    fails(2, &["import", urdf, "--lock", "grip"], &["JOINT=VALUE"]);
    let leaves = ["these links carry no other link", "`finger` (3 joints)", "`tip` (2 joints)"];
    let unknown = [&["no link `tipp` that could be the tip", "did you mean `tip`?"], &leaves[..]].concat();
    fails(2, &["import", urdf, "--tip", "tipp"], &unknown);
    fails(2, &["import", urdf, "--base", "fing", "--tip", "tip"], &["did you mean `finger`?", "the links are `base`"]);
    fails(2, &["import", urdf, "--tip", "tip", "--lock", "gripp=0"], &["no joint `gripp`", "did you mean `grip`?"]);
    let raw = rne(&["import", urdf, "--tip", "tip", "--lock-others", "--no-snap"]);
    assert!(raw.out.contains("alpha: 1.5708}") && !raw.err.contains("snapped"), "{raw:?}");
    // From a pipe too.
    let piped = rne_reading(&["import", "-", "--tip", "tip", "--lock-others", "--name", "mine"], URDF);
    assert!(piped.out.contains("name: mine\n"), "{piped:?}");
}

/// What `rne import` remarks on a file, every command that reads the file remarks, in the same words.
#[test]
fn every_command_has_the_remarks_of_the_import() {
    let folder = folder("import_remarks");
    let mjcf = "<mujoco><option density=\"1.2\"/><worldbody><body name=\"a\"><joint name=\"j\" armature=\"0.1\" \
                stiffness=\"2\"/><inertial pos=\"0 0 1\" mass=\"1\" diaginertia=\"1 1 1\"/></body></worldbody>\
                <tendon><fixed name=\"t\" armature=\"1\"><joint joint=\"j\" coef=\"1\"/></fixed></tendon></mujoco>";
    let hand = "<robot name=\"h\"><link name=\"base\"><inertial><mass value=\"7\"/><inertia ixx=\"1\" iyy=\"1\" \
                izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link><link name=\"l\"><inertial>\
                <mass value=\"1\"/>\
                <inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\
                <joint name=\"j\" type=\"continuous\"><parent link=\"base\"/><child link=\"l\"/><origin rpy=\"9 0 0\"/>\
                </joint></robot>";
    for (name, text, least) in [("hand.urdf", hand, 3), ("m.xml", mjcf, 4)] {
        let file = folder.join(name);
        fs::write(&file, text).expect("written");
        let file = file.to_str().expect("UTF-8");
        let remarks = |call: &[&str]| -> Vec<String> {
            let called = rne(call);
            assert_eq!(called.status, 0, "{called:?}");
            let is_remark = |line: &&str| line.starts_with("note: ") || line.starts_with("warning: ");
            let is_own = |line: &&str| {
                ["is a URDF or an MJCF", "not given", "in the robot file", "rotor inertia"]
                    .iter()
                    .any(|part| line.contains(part))
            };
            called.err.lines().filter(is_remark).filter(|line| !is_own(line)).map(str::to_owned).collect()
        };
        let expected = remarks(&["import", file]);
        assert!(expected.len() >= least, "{expected:?}");
        for call in [
            &["check", file] as &[&str],
            &["eval", file, "--q", "0.1"],
            &["ops", file],
            &["emit", file, "--lang", "c"],
            &["show", file],
            &["convert", file, "--convention", "modified"],
        ] {
            assert_eq!(remarks(call), expected, "{call:?}");
        }
    }
}

/// `rne check` needs no tip: where several could be meant, it checks the whole robot.
#[test]
fn a_urdf_with_several_ends_is_checked_as_a_whole() {
    let urdf = folder("check_whole").join("arm.urdf");
    fs::write(&urdf, URDF).expect("written");
    let urdf = urdf.to_str().expect("UTF-8");
    fails(1, &["eval", urdf, "--q", "0,0"], &["you must name the tip", "--whole"]);
    let checked = rne(&["check", urdf]);
    assert!(checked.status == 0 && checked.err.contains("the robot is everything after base"), "{checked:?}");
    let floats = rne(&["check", "docs/satellite.yaml"]);
    assert!(floats.out.contains("floating base"), "{floats:?}");
}

#[test]
fn several_tips_are_of_a_whole_robot() {
    let urdf = folder("import_tips").join("arm.urdf");
    fs::write(&urdf, URDF).expect("written");
    let urdf = urdf.to_str().expect("UTF-8");
    let tips = ["import", urdf, "--tip", "finger", "--tip", "tip"];
    let whole = rne(&[&tips[..], &["--whole"]].concat());
    assert!(whole.status == 0 && whole.out.contains("\ntips: [finger, tip]\n"), "{whole:?}");
    fails(2, &tips, &["an arm has one tip; --whole imports the whole robot"]);
    let unknown = [&tips[..5], &["tipp", "--whole"]].concat();
    fails(2, &unknown, &["no link `tipp` that could be the tip", "did you mean `tip`?"]);
}

/// A link that a floating joint moves is the floating base of a whole robot, unless an option fixes it.
#[test]
fn a_base_that_floats_in_the_file_floats() {
    let urdf = folder("import_floating").join("arm.urdf");
    let joint = "<link name=\"world\"/><joint name=\"free\" type=\"floating\"><parent link=\"world\"/>\
                 <child link=\"base\"/></joint></robot>";
    fs::write(&urdf, URDF.replace("</robot>", joint)).expect("written");
    let urdf = urdf.to_str().expect("UTF-8");
    let whole = |more: &[&str]| {
        let called = rne(&[&["import", urdf, "--whole", "--tip", "tip"], more].concat());
        assert_eq!(called.status, 0, "{called:?}");
        (called.out, called.err.split_whitespace().collect::<Vec<_>>().join(" "))
    };
    let (floats, told) = whole(&[]);
    assert!(floats.contains("floating_base:\n  name: base\n"), "{floats}");
    let note = "the link `base` floats in the file, so the robot has a floating base";
    assert!(floats.contains(note) && told.contains(note), "{floats}{told}");
    assert!(told.contains("note: --fixed fixes the base where the file has it"), "{told}");
    assert_eq!(whole(&["--floating"]).0, floats);
    let (fixed, told) = whole(&["--fixed"]);
    assert!(!fixed.contains("floating_base"), "{fixed}");
    assert!(
        told.contains("rne fixes it where the file has it note: without --fixed, it is the floating base"),
        "{told}"
    );
    // the joint that lets it float can be locked where it is
    let (locked, told) = whole(&["--lock", "free=0"]);
    assert!(locked == fixed && told.contains("note: without --lock, it is the floating base"), "{locked}{told}");
    let (_, told) = whole(&["--base", "world"]);
    assert!(told.contains("note: without --base, it is the floating base"), "{told}");
    let elsewhere = ["import", urdf, "--whole", "--tip", "tip", "--lock", "free=1"];
    fails(1, &elsewhere, &["the joint `free` floats, and can be locked at 0 only", "0 fixes the base"]);
    let twice = ["import", urdf, "--whole", "--tip", "tip", "--lock", "free=0", "--lock", "free=0"];
    fails(1, &twice, &["the joint `free` is locked twice", "lock it once"]);
    let both = ["import", urdf, "--whole", "--tip", "tip", "--lock", "free=0", "--floating"];
    fails(1, &both, &["the base is to float, and the joint that lets it float is locked"]);
    let arm = rne(&["import", urdf, "--tip", "tip", "--lock-others"]);
    assert!(!arm.out.contains("floating_base") && arm.err.contains("with --whole"), "{arm:?}");
    fails(2, &["import", urdf, "--whole", "--fixed", "--floating"], &["cannot be used with"]);
    fails(2, &["import", urdf, "--tip", "tip", "--fixed"], &["--whole"]);
    let elsewhere = ["import", urdf, "--whole", "--floating", "--base", "upper", "--lock-others"];
    fails(1, &elsewhere, &["a floating base is the root link of a whole robot", "name no other base"]);
}

#[test]
fn a_robot_file_that_is_there_stays() {
    let folder = folder("import_kept");
    let (urdf, out) = (folder.join("arm.urdf"), folder.join("arm.yaml"));
    fs::write(&urdf, URDF).expect("written");
    fs::write(&out, "my own").expect("written");
    let (urdf, out) = (urdf.to_str().expect("UTF-8"), out.to_str().expect("UTF-8"));
    let import = ["import", urdf, "--tip", "tip", "--lock-others", "-o", out];
    fails(2, &import, &["exists and is not changed", "--force"]);
    assert_eq!(fs::read_to_string(out).expect("it is there"), "my own");
    let forced = rne(&[&import[..], &["--force"]].concat());
    assert!(forced.err.contains("wrote"), "{forced:?}");
    assert!(rne(&import).err.contains("up to date:"), "the same text is no conflict");
    assert!(fine(&["check", out]).contains("two_links, RR, standard"));
    fails(2, &["import", urdf, "--tip", "tip", "--lock-others", "-o", urdf], &["is also the file that rne reads"]);
}

#[test]
fn every_command_takes_a_urdf_with_one_arm() {
    let folder = folder("import_at_once");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let (urdf, yaml, plan) = (path("puma.urdf"), path("puma.yaml"), path("puma.plan.yaml"));
    for command in [&["export", "puma560", "--urdf", "-o", &urdf][..], &["import", &urdf, "-o", &yaml]] {
        let called = rne(command);
        assert_eq!(called.status, 0, "{command:?}");
        let is_import = command[0] == "import";
        assert_eq!(called.said().contains("gravity in frame 0: [0, 0, -9.81] m/s²; if"), is_import, "{called:?}");
    }
    for command in [&["eval", "--q", "1,1,1,1,1,1"][..], &["ops"], &["emit"], &["show", "--joint", "2"]] {
        let [of_urdf, of_yaml] = [&urdf, &yaml].map(|file| rne(&[command, &[file.as_str()]].concat()));
        assert_eq!((of_urdf.status, &of_urdf.out), (0, &of_yaml.out), "{command:?}: {of_urdf:?}");
        assert!(of_urdf.err.contains("is a URDF or an MJCF file, and the arm is from world to "), "{of_urdf:?}");
        assert!(of_urdf.err.contains(&format!("rne import {urdf}")), "{of_urdf:?}");
        assert!(of_urdf.err.contains("gravity in frame 0: [0, 0, -9.81] m/s²"), "a URDF has none: {of_urdf:?}");
        assert!(!of_urdf.err.contains("snapped"), "the angles are exact: {of_urdf:?}");
    }
    let text = fs::read_to_string(&urdf).expect("the URDF");
    let rounded = path("rounded.urdf");
    fs::write(&rounded, text.replace("1.5707963267948966", "1.5708")).expect("written");
    for command in [&["eval", "--q", "1,1,1,1,1,1"][..], &["check"]] {
        let said = rne(&[command, &[rounded.as_str()]].concat()).said();
        assert!(said.contains("angles snapped to multiples of pi/12: ") && said.contains("--no-snap"), "{said}");
    }
    let checked = rne(&["check", &urdf]);
    assert!(checked.status == 0 && checked.out.starts_with("ok "), "{checked:?}");
    // a plan is of a robot file
    fails(1, &["search", &urdf, "--seconds", "0"], &["this is URDF", "rne import"]);
    assert!(!fs::exists(plan).expect("a folder"));
}

/// A command that takes a URDF with two possible tips names `rne import`, which has the option `--tip`.
#[test]
fn a_urdf_with_two_ends_names_the_command_that_chooses() {
    let urdf = folder("import_told").join("arm.urdf");
    fs::write(&urdf, URDF).expect("written");
    let urdf = urdf.to_str().expect("UTF-8");
    for command in [&["eval", urdf, "--q", "0,0"][..], &["ops", urdf], &["emit", urdf]] {
        fails(1, command, &["`base` has 2 end links", "rne import", "--tip"]);
    }
}

#[test]
fn conversions_and_exports_have_the_same_torques() {
    let folder = folder("converted");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let state = ["--q", "0.1,-0.5,1.1,0.3,-2,0.7", "--qd", "1,2,-1,0.5,1,1", "--qdd", "0.1,0.2,0.3,-1,-2,1", "--json"];
    let torques = |file: &str| -> Vec<f64> {
        let out = fine(&[&["eval", file][..], &state].concat());
        out.split(|c: char| !(c.is_ascii_digit() || "+-.e".contains(c))).filter_map(|word| word.parse().ok()).collect()
    };
    let expected = torques("robots/puma560.yaml");
    assert_eq!(expected.len(), 6);
    let (modified, urdf, back) = (path("modified.yaml"), path("puma.urdf"), path("back.yaml"));
    let converted = rne(&["convert", "robots/puma560.yaml", "--convention", "modified", "-o", &modified]);
    assert!(converted.status == 0 && converted.err.contains("the same arm over 1,000 states"), "{converted:?}");
    let exported = rne(&["export", "robots/puma560.yaml", "--urdf", "-o", &urdf]);
    assert!(exported.status == 0 && exported.err.contains("motors are left out"), "{exported:?}");
    assert_eq!(rne(&["import", &urdf, "-o", &back]).status, 0);
    for file in [&modified, &back] {
        let found = torques(file);
        assert!(expected.iter().zip(&found).all(|(a, b)| (a - b).abs() < 1e-12 * 60.0), "{expected:?} {found:?}");
    }
    fails(2, &["export", "robots/puma560.yaml"], &["--urdf"]);
    fails(2, &["convert", "robots/puma560.yaml"], &["--convention"]);
}

/// The frame of a URDF that is read as it is: the one of the robot file that `rne import --frames` writes.
#[test]
fn a_frame_of_a_urdf_needs_no_import() {
    let folder = folder("import_frame");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let (urdf, file) = (path("arm.urdf"), path("arm.yaml"));
    fs::write(&urdf, URDF.replace("name=\"grip\" type=\"prismatic\"", "name=\"grip\" type=\"fixed\""))
        .expect("written");
    let imported = rne(&["import", &urdf, "--tip", "tip", "--frames", "--name", "two_links", "-o", &file]);
    assert_eq!(imported.status, 0, "{imported:?}");
    let at = |robot: &str, frame: &str| {
        let called = rne(&["eval", robot, "--frame", frame, "--q", "0.5,0.3", "--json"]);
        assert_eq!(called.status, 0, "{called:?}");
        called.out
    };
    for frame in ["upper", "lower", "finger", "tip"] {
        assert_eq!(at(&urdf, frame), at(&file, frame), "{frame}");
    }
    let of_elbow: serde_json::Value = serde_json::from_str(&at(&urdf, "lower")).expect("JSON");
    let place = &of_elbow["result"]["translation"];
    for (found, expected) in [(&place[0], 0.4318 * 0.5_f64.cos()), (&place[1], 0.4318 * 0.5_f64.sin())] {
        assert!((found.as_f64().expect("a number") - expected).abs() < 1e-12, "{of_elbow}");
    }
    fails(2, &["eval", &urdf, "--frame", "lover", "--q", "0.5,0.3"], &["did you mean `lower`"]);
    // the frames are those that were asked for, and none otherwise
    let emit = |more: &[&str]| rne(&[&["emit", &urdf, "--lang", "c", "--function", "jacobian"], more].concat()).out;
    let code = emit(&["--frame", "lower"]);
    assert!(code.contains("_jacobian_of_lower(") && !code.contains("_of_upper("), "{code}");
    let code = emit(&[]);
    assert!(code.contains("_jacobian(") && !code.contains("_jacobian_of_"), "{code}");
}

/// Two axes are 5e-5 rad off parallel: their common normal is kilometres away, which is no matter of
/// millimetres. Code of the seven steps loses digits there and says so at every door; that of the form `reduced` loses
/// none.
#[test]
fn single_precision_of_a_calibrated_arm_is_kept_or_said_to_be_lost() {
    let folder = folder("import_calibrated");
    let joint = |index: usize, origin: &str| {
        format!(
            "<joint name=\"j{0}\" type=\"revolute\"><parent link=\"l{index}\"/><child link=\"l{0}\"/><origin {origin}/>\
             <axis xyz=\"0 0 1\"/><limit lower=\"-3\" upper=\"3\" effort=\"9\" velocity=\"2\"/></joint><link \
             name=\"l{0}\"><inertial><origin xyz=\"0.1 0.02 0.05\"/><mass value=\"2\"/><inertia ixx=\"0.004\" \
             iyy=\"0.02\" izz=\"0.02\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>",
            index + 1
        )
    };
    let urdf =
        ["xyz=\"0 0 0.15\"", "xyz=\"0 0.1 0\" rpy=\"1.5712 0 0\"", "xyz=\"0.24 0 0.1\" rpy=\"0.00004 0.00003 0\""];
    let joints: String = urdf.iter().enumerate().map(|(index, origin)| joint(index, origin)).collect();
    let path = folder.join("calibrated.urdf");
    fs::write(&path, format!("<robot name=\"calibrated\"><link name=\"l0\"/>{joints}</robot>"))
        .expect("a writable file");
    let file = folder.join("calibrated.yaml");
    let (path, file) = (path.to_str().expect("UTF-8"), file.to_str().expect("UTF-8"));
    let imported = rne(&["import", path, "--no-snap", "-o", file]);
    let said = format!("{} {}", imported.out, imported.err);
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    for words in ["the centre of mass of link 2 is ", "axes are nearly parallel"] {
        assert!(said.contains(words), "{words}: {said}");
    }
    assert!(!said.contains("millimetres"), "{said}");
    let checked = fine(&["check", file]);
    assert!(checked.contains("Single precision (float, f32) is not enough"), "{checked}");
    assert!(checked.contains("  gravity_torques, seven_steps: "), "{checked}");
    assert!(!checked.contains(", reduced: ") && !checked.contains("millimetres"), "{checked}");
    for (language, form, is_lost) in
        [("c", "reduced", false), ("c", "seven_steps", true), ("rust", "seven_steps", true)]
    {
        let emitted = rne(&["emit", file, "--lang", language, "--form", form, "--function", "gravity_torques"]);
        for said in [&emitted.out, &emitted.err] {
            assert_eq!(said.contains("Single precision (float, f32) is not"), is_lost, "{language}, {form}: {said}");
        }
    }
    let double = rne(&["emit", file, "--lang", "c", "--real", "double", "--form", "seven_steps"]);
    assert!(!double.err.contains("Single precision"), "{}", double.err);
}
