//! MJCF files: torques as MuJoCo computes them, and what is refused.

use std::fs;
use std::path::Path;

use rne_convert::{Imported, Options, Selection, Urdf};
use rne_model::{Convention, Reader, Robot};
use rne_runtime::{BaseMotion, DynArm, DynFloatingTorques, Wrench};

fn whole() -> Options {
    let selection = Selection { whole: true, ..Selection::default() };
    Options { selection, convention: Convention::Modified, snap: false, ..Options::default() }
}

fn file(name: &str) -> String {
    format!("{}/tests/mjcf/{name}.xml", env!("CARGO_MANIFEST_DIR"))
}

fn import(name: &str, options: &Options) -> Imported {
    let imported = import_file(&file(name), options);
    assert!(imported.account.rounding.torque < 1e-12, "{:?}", imported.account.rounding);
    imported
}

fn import_file(file: &str, options: &Options) -> Imported {
    let text = fs::read_to_string(file).unwrap_or_else(|error| panic!("{file}: {error}"));
    let imported = Urdf::read(file, &text).and_then(|urdf| urdf.import(options));
    let imported = imported.unwrap_or_else(|report| panic!("{report}"));
    let read = Reader::new("written").trees().couplings().read(&imported.text);
    assert_eq!(read.unwrap_or_else(|report| panic!("{report}")).robot, imported.robot, "reading gives the robot");
    imported
}

/// The torques of MuJoCo at the states of the file beside an MJCF file.
fn assert_golden(name: &str, robot: &Robot) {
    let golden = fs::read_to_string(Path::new(name).with_extension("csv")).expect("a golden file");
    let mut lines = golden.lines();
    let names: Vec<&str> = lines.next().expect("names").split(',').collect();
    let free = robot.joints.iter().filter(|joint| joint.coupling.is_none());
    assert_eq!(free.map(|joint| joint.name.as_str()).collect::<Vec<_>>(), names, "{name}");
    let arm = DynArm::from_robot(robot).with_rotors();
    let mut states = 0;
    for line in lines {
        let numbers: Vec<f64> = line.split(',').map(|number| number.parse().expect("a number")).collect();
        let parts: Vec<&[f64]> = numbers.chunks(names.len()).collect();
        let [q, qd, qdd, expected] = parts[..] else { panic!("{name}: four lists") };
        let found = arm.inverse_dynamics(q, qd, qdd).expect("as many joints");
        let scale = expected.iter().fold(0.0, |largest: f64, torque| largest.max(torque.abs()));
        for ((found, expected), joint) in found.iter().zip(expected).zip(&names) {
            assert!((found - expected).abs() < 1e-9 * scale, "{name}, {joint}: {found} {expected}");
        }
        states += 1;
    }
    assert!(states > 0, "{name}");
}

#[test]
fn torques_are_those_of_mujoco() {
    for name in ["classes", "geoms", "gripper", "g1_29dof"] {
        assert_golden(&file(name), &import(name, &whole()).robot);
    }
}

/// The models that `cargo xtask urdf --mjcf DIR` saves.
#[test]
#[ignore = "needs a folder of models, which MuJoCo writes"]
fn torques_are_those_of_mujoco_in_a_folder() {
    let folder = std::env::var("RNE_MJCF").expect("RNE_MJCF");
    let mut seen = 0;
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("a file").path();
        if path.extension().is_some_and(|extension| extension == "xml") {
            let file = path.to_str().expect("Unicode");
            assert_golden(file, &import_file(file, &Options { keep_unphysical: true, ..whole() }).robot);
            println!("{file}");
            seen += 1;
        }
    }
    assert!(seen >= 20, "{seen} models");
}

#[test]
fn what_a_robot_file_has_is_kept() {
    let Imported { robot, account, .. } = import("classes", &Options { frames: true, ..whole() });
    let joint = |name: &str| robot.joints.iter().find(|joint| joint.name == name).expect("a joint");
    let (low, high) = joint("hip_y").limits.position.expect("limits");
    assert_eq!((low, high), (-std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_4), "degrees of a class");
    assert_eq!(joint("hip_z").limits.position, None, "not limited");
    assert_eq!(joint("knee").limits.effort, Some(12.0), "control times gear");
    assert_eq!(joint("hip_x").limits.effort, Some(30.0), "the smaller of two");
    assert_eq!(joint("slide_x").limits.effort, Some(20.0));
    let motor = joint("knee").motor.expect("a motor");
    assert_eq!((motor.inertia, motor.gear_ratio), (0.02 + 16.0 * 0.001, 1.0));
    assert_eq!((motor.viscous, motor.coulomb), (0.5, [0.3, -0.3]));
    let frames: Vec<&str> = account.frames.iter().map(|(_, name)| name.as_str()).collect();
    assert!(frames.contains(&"trunk_site") && frames.contains(&"sole"), "{frames:?}");
    let told = account.sentences().join("\n");
    assert!(told.contains("smaller one: `hip_x`"), "{told}");
    assert!((robot.gravity[0] - 1.0).abs() < 1e-15, "{:?}", robot.gravity);
}

/// A body with a free joint is the floating base of a whole robot, and its force, moment and torques are MuJoCo's.
#[test]
fn a_free_joint_makes_the_base_float() {
    for name in ["gripper", "g1_29dof"] {
        let Imported { robot, account, .. } = import(name, &whole());
        let base = robot.floating_base.as_ref().unwrap_or_else(|| panic!("{name}: a floating base"));
        assert_eq!((&base.name, account.floats), (&account.base, Some(true)));
        let told = account.sentences().join("\n");
        let expected = format!("the link `{}` floats in the file, so the robot has a floating base", base.name);
        assert!(told.contains(&expected), "{told}");
        let arm = DynArm::from_robot(&robot).with_rotors();
        let golden = fs::read_to_string(file(name).replace(".xml", ".floating.csv")).expect("a golden file");
        for line in golden.lines().skip(1) {
            let numbers: Vec<f64> = line.split(',').map(|number| number.parse().expect("a number")).collect();
            let (joints, base) = numbers.split_at(3 * robot.dof());
            let (base, expected) = base.split_at(12);
            let vector = |part: usize| -> [f64; 3] { base[3 * part..][..3].try_into().expect("three numbers") };
            let [omega, omega_dot, acceleration, gravity] = [0, 1, 2, 3].map(vector);
            let base = BaseMotion { omega, omega_dot, acceleration, gravity, ..BaseMotion::default() };
            let [q, qd, qdd] = [0, 1, 2].map(|part| &joints[part * robot.dof()..][..robot.dof()]);
            let free = vec![Wrench::zero(); arm.tips().len()];
            let DynFloatingTorques { wrench, tau } =
                arm.inverse_dynamics_of_floating_base(q, qd, qdd, &base, &free).expect("a state");
            let found = [wrench.force.to_vec(), wrench.moment.to_vec(), tau].concat();
            let scale = expected.iter().fold(0.0, |largest: f64, torque| largest.max(torque.abs()));
            assert_eq!(found.len(), expected.len(), "{name}");
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9 * scale, "{name}: {found} {expected}");
            }
        }
    }
}

const SCENE: &str = "<mujoco><worldbody>
<body name='trunk' pos='1 2 3' quat='0 1 0 0'><joint type='free' armature='0.1'/>
<inertial pos='0 0 0' mass='2' diaginertia='1 1 1'/>
<body name='leg'><joint name='hip' axis='0 1 0'/><inertial pos='0 0 -1' mass='1' diaginertia='1 1 1'/></body></body>
<body name='ball'><freejoint/><inertial pos='0 0 0' mass='5' diaginertia='1 1 1'/></body>
</worldbody></mujoco>";

#[test]
fn a_base_floats_or_is_fixed_as_the_selection_says() {
    let scene = |floating, base: Option<&str>| {
        let selection = Selection { floating, base: base.map(str::to_owned), ..whole().selection };
        Urdf::read("scene.xml", SCENE).expect("MJCF").import(&Options { selection, ..whole() })
    };
    for (floating, base) in [(None, None), (Some(true), None), (None, Some("trunk")), (Some(true), Some("trunk"))] {
        let Imported { robot, account, .. } = scene(floating, base).expect("a robot");
        let trunk = robot.floating_base.expect("a floating base");
        assert_eq!((trunk.name.as_str(), trunk.link.mass), ("trunk", 2.0), "without the ball");
        // z of the trunk points down in the file, but gravity is in axes of the world, in which the base turns
        assert_eq!((robot.base, robot.gravity), (rne_model::Transform::IDENTITY, [0.0, 0.0, -9.81]));
        let told = account.sentences().join("\n");
        assert!(told.contains("the body `ball` has a free joint, and rne fixes it"), "{told}");
        assert!(
            told.contains("springs of free joints are left out, but MuJoCo's torques have them: `trunk`"),
            "{told}"
        );
    }
    let Imported { robot, account, .. } = scene(Some(false), None).expect("a robot");
    assert!(robot.floating_base.is_none() && account.floats == Some(false));
    assert_eq!(account.base, "trunk");
    assert!((robot.base.xyz[2] - 3.0).abs() < 1e-15, "{:?}", robot.base);
    let told = account.sentences().join("\n");
    assert!(told.contains("the link `trunk` floats in the file, and rne fixes it where the file has it"), "{told}");
    // the world floats with all that no joint moves
    assert_eq!(scene(Some(true), Some("world")).expect("a robot").robot.floating_base.expect("a base").link.mass, 7.0);
    let said = scene(Some(true), Some("ball")).expect_err("no base").to_string();
    assert!(said.contains("or the link that floats in the file") && said.contains("scene.xml:5:1"), "{said}");
    // no frame and no joint has the name of the base
    let text = SCENE.replace("'hip'", "'trunk'");
    let options = Options { frames: true, ..whole() };
    let robot = Urdf::read("scene.xml", &text).and_then(|urdf| urdf.import(&options)).expect("a robot").robot;
    assert_eq!(robot.floating_base.expect("a base").name, "trunk_base");
    assert_eq!(robot.frames.iter().map(|frame| frame.name.as_str()).collect::<Vec<_>>(), ["trunk_frame", "leg"]);
    import("g1_29dof", &options);
    // one arm stands on the trunk
    let arm = Urdf::read("scene.xml", SCENE).and_then(|urdf| urdf.import(&Options::default())).expect("an arm");
    assert!(arm.robot.floating_base.is_none() && arm.account.floats == Some(false) && arm.account.base == "trunk");
}

#[test]
fn equalities_couple() {
    let selection = Selection { floating: Some(false), ..whole().selection };
    let Imported { robot, account, text, .. } = import("gripper", &Options { selection, ..whole() });
    let told = account.sentences().join("\n");
    assert!(told.contains("joints that an equality holds are fixed: `held`"), "{told}");
    assert!(told.contains("equalities that are not active are left out"), "{told}");
    // right - 0.02 = 0.01 - 0.5 (left - 0.01); wheel = 0.2 + 30 (right - 0.02)
    assert!(text.contains("{joint: right, follows: {left: -0.5}, offset: 0.035}"), "{text}");
    assert_eq!(robot.joints.iter().filter(|joint| joint.coupling.is_some()).count(), 2);
}

/// Each part that a robot file has not is told once; a warning, where MuJoCo's torques have it.
#[test]
fn what_is_left_out_is_told() {
    let tendon = |attributes: &str| {
        format!("<tendon><fixed name=\"t\" {attributes}><joint joint=\"j\" coef=\"1\"/></fixed></tendon><equality/>")
    };
    let of_class = format!("<default><tendon stiffness=\"3\"/></default>{}", tendon(""));
    let springs = "springs, friction and armature of tendons are left out, but MuJoCo's torques have them: `t`";
    let actuator = "<actuator><motor joint=\"j\" damping=\"1\"/></actuator>";
    for (old, new, told, is_warning) in [
        ("<equality/>", &tendon("") as &str, "tendons are left out: `t`", false),
        ("<equality/>", &tendon("armature=\"0.5\""), springs, true),
        ("<equality/>", &tendon("stiffness=\"0 1\""), springs, true),
        ("<equality/>", &of_class, springs, true),
        ("<equality/>", "<option density=\"1.2\"/>", "forces of a fluid are left out, but", true),
        ("<equality/>", "<option viscosity=\"1e-5\" wind=\"1 0 0\"/>", "have them: `viscosity`", true),
        ("<equality/>", "<option density=\"0\"/>", "", false),
        ("<equality/>", actuator, "forces that damp actuators are left out", true),
        ("<joint name=\"j\"/>", "<joint name=\"j\" damping=\"1 2\"/>", "of higher degree are left out", true),
        ("<joint name=\"j\"/>", "<joint name=\"j\" stiffness=\"1\"/>", "springs of joints are left out", true),
        ("<joint name=\"j\"/>", "<joint name=\"j\" armature=\"1\"/>", "1 joint has the inertia of a rotor", false),
        ("<body name=\"a\">", "<body name=\"a\" gravcomp=\"1\">", "forces that compensate gravity", true),
        (
            "<equality/>",
            "<equality><weld name=\"w\" body1=\"a\" active=\"false\"/></equality>",
            "equalities that are not active are left out: `w`",
            false,
        ),
    ] {
        let urdf = Urdf::read("m.xml", &with(old, new)).unwrap_or_else(|report| panic!("{report}"));
        let account = urdf.import(&whole()).unwrap_or_else(|report| panic!("{report}")).account;
        let serial = |remark: &&rne_convert::Remark| !remark.text.contains("is a serial arm");
        let found: Vec<_> = account.remarks.iter().filter(serial).collect();
        if told.is_empty() {
            assert!(found.is_empty(), "{new}: {found:?}");
            continue;
        }
        let [remark] = found[..] else { panic!("{new}: {found:?}") };
        assert!(remark.text.contains(told) && remark.is_warning == is_warning, "{new}: {remark:?}");
    }
}

/// The defaults of `general` hold for all kinds of actuators, as in MuJoCo. An import warns of a rotor that drives a
/// tendon.
#[test]
fn actuators_of_all_kinds_have_rotors() {
    let of = |actuator: &str| {
        let lists = format!(
            "<tendon><fixed name=\"t\"><joint joint=\"j\" coef=\"1\"/></fixed></tendon><default><general gear=\"3\" \
             armature=\".1\"/></default><actuator><{actuator}/></actuator><equality/>"
        );
        let urdf = Urdf::read("m.xml", &with("<equality/>", &lists)).unwrap_or_else(|report| panic!("{report}"));
        urdf.import(&whole()).unwrap_or_else(|report| panic!("{report}"))
    };
    for kind in ["general", "motor", "position", "velocity", "intvelocity", "damper", "cylinder", "muscle", "dcmotor"] {
        let robot = of(&format!("{kind} joint=\"j\"")).robot;
        let motor = robot.joints[0].motor.as_ref().unwrap_or_else(|| panic!("{kind} has no rotor"));
        assert!((motor.inertia * motor.gear_ratio.powi(2) - 0.9).abs() < 1e-12, "{kind}: {motor:?}");
        let told = of(&format!("{kind} tendon=\"t\"")).account.sentences().join("\n");
        assert!(told.contains("rotors and damping of actuators on tendons are left out, but MuJoCo's"), "{told}");
    }
}

/// A ball is named, with what to do, and can be held at zero.
#[test]
fn a_ball_alone_is_named() {
    let ball = with("<joint name=\"j\"/>", "<joint name=\"j\" type=\"ball\"/>");
    let said = refused(&ball);
    assert!(said.contains("which no row of a table can describe: `j`"), "{said}");
    assert!(said.contains("a ball as three hinges about x, y and z") && said.contains("bad.xml:5:"), "{said}");
    let two = "<joint name=\"j\"/><body name=\"b\"><joint name=\"k\" type=\"ball\"/></body>";
    let text = with("<joint name=\"j\"/>", two);
    let locked = |value: f64| {
        let selection = Selection { lock: vec![("k".to_owned(), value)], ..whole().selection };
        Urdf::read("two.xml", &text).and_then(|urdf| urdf.import(&Options { selection, ..whole() }))
    };
    assert_eq!(locked(0.0).expect("an arm").robot.dof(), 1);
    let said = locked(0.5).expect_err("a ball").to_string();
    assert!(said.contains("the joint `k` is spherical and cannot be locked") && said.contains("locked at 0"), "{said}");
}

/// An arm of a tree is chosen as in a URDF.
#[test]
fn one_arm_of_a_tree_is_chosen_by_its_tip() {
    let selection = Selection { tip: Some("left_rubber_hand".to_owned()), ..Selection::default() };
    let file = file("g1_29dof");
    let text = fs::read_to_string(&file).expect("a file");
    let urdf = Urdf::read(&file, &text).expect("MJCF");
    let options = Options { selection, ..Options::default() };
    let said = urdf.import(&options).expect_err("no such body").to_string();
    assert!(said.contains("there is no link `left_rubber_hand`"), "{said}");
    let selection =
        Selection { tip: Some("left_wrist_yaw_link".to_owned()), lock_others: true, ..Selection::default() };
    let robot = urdf.import(&Options { selection, ..Options::default() }).expect("an arm").robot;
    assert_eq!(robot.joints.len(), 10, "waist and arm");
    assert_eq!(robot.joints[9].limits.effort, Some(5.0));
}

fn with(old: &str, new: &str) -> String {
    let text = "<mujoco model=\"m\">\n\
         <compiler angle=\"radian\"/>\n\
         <worldbody><body name=\"a\">\n\
         <inertial pos=\"0 0 1\" mass=\"1\" diaginertia=\"1 1 1\"/>\n\
         <joint name=\"j\"/>\n\
         </body></worldbody>\n\
         <equality/>\n\
         </mujoco>";
    assert_eq!(text.matches(old).count(), 1, "{old}");
    text.replace(old, new)
}

fn refused(text: &str) -> String {
    let report = Urdf::read("bad.xml", text).and_then(|urdf| urdf.import(&whole()).map(|_| ())).expect_err(text);
    report.to_string()
}

#[test]
fn every_mistake_has_its_message_and_its_place() {
    for (old, new, line, part) in [
        ("mass=\"1\"", "mass=\"-1\"", 4, "a mass is zero or positive"),
        ("mass=\"1\"", "mass=\"one\"", 4, "`mass` of `inertial` is `one`; it must be one number"),
        ("mass=\"1\"", "mass=\"nan\"", 4, "it must be one number"),
        ("mass=\"1\"", "mass=\"1e400\"", 4, "it must be one number"),
        ("mass=\"1\"", "mas=\"1\"", 4, "there is no attribute `mas` of `inertial`"),
        ("0 0 1", "0 0", 4, "it must be 3 numbers"),
        ("diaginertia=\"1 1 1\"", "", 4, "lacks `diaginertia`"),
        ("diaginertia", "fullinertia=\"1 1 1 0 0 0\" diaginertia", 4, "two inertias"),
        ("diaginertia=\"1 1 1\"", "fullinertia=\"1 1 1 2 0 0\"", 4, "no body has a negative one"),
        ("diaginertia", "quat=\"0 0 0 0\" diaginertia", 4, "it has no direction"),
        ("diaginertia", "quat=\"1 0 0 0\" euler=\"0 0 0\" diaginertia", 4, "several orientations"),
        ("<joint name=\"j\"/>", "<joint name=\"j\" axis=\"0 0 0\"/>", 5, "has no direction"),
        ("<joint name=\"j\"/>", "<joint name=\"j\" type=\"screw\"/>", 5, "it must be hinge, slide, ball or free"),
        ("<joint name=\"j\"/>", "<joint name=\"j\" type=\"ball\"/>", 5, "more than one freedom"),
        ("<joint name=\"j\"/>", "<joint/><body><joint type=\"ball\"/></body>", 5, "more than one freedom"),
        ("<joint name=\"j\"/>", "<joint name=\"j\"/><joint name=\"j\"/>", 5, "two elements `joint` with the name `j`"),
        ("<joint name=\"j\"/>", "<joint name=\"j\" class=\"x\"/>", 5, "there is no class `x`"),
        ("<joint name=\"j\"/>", "<joint name=\"j\" armature=\"-1\"/>", 5, "it must not be negative"),
        ("<joint name=\"j\"/>", "<joint name=\"j\" range=\"0 x\"/>", 5, "it must be 2 numbers"),
        ("<joint name=\"j\"/>", "<joint name=\"j\"/><freejoint/>", 5, "is not free"),
        ("<joint name=\"j\"/>", "<joint name=\"j\"/><body><freejoint/></body>", 5, "is not free"),
        ("<joint name=\"j\"/>", "<joint/><body name=\"a\"/>", 5, "two elements `body` with the name `a`"),
        ("<joint name=\"j\"/>", "<joint/><replicate count=\"2\"/>", 5, "which makes bodies"),
        ("<joint name=\"j\"/>", "<joint/><body><geom type=\"mesh\" mesh=\"x\"/></body>", 5, "opens no meshes"),
        ("<joint name=\"j\"/>", "<joint/><body><geom type=\"box\" size=\"1\"/></body>", 5, "needs 3 sizes"),
        ("<joint name=\"j\"/>", "<joint/><include file=\"no.xml\"/>", 5, "`no.xml` cannot be read"),
        ("<joint name=\"j\"/>", "<joint/><include/>", 5, "`include` lacks the attribute `file`"),
        ("radian", "grad", 2, "it must be degree or radian"),
        ("angle=\"radian\"", "coordinate=\"global\"", 2, "local coordinates only"),
        ("angle=\"radian\"", "eulerseq=\"xy\"", 2, "three of the letters"),
        ("<equality/>", "<equality><connect body1=\"a\"/></equality>", 7, "lacks the attribute `anchor`"),
        ("<equality/>", "<equality><connect body1=\"a\" anchor=\"0 nan 0\"/></equality>", 7, "it must be 3 numbers"),
        ("<equality/>", "<equality><connect body1=\"a\" anchor=\"0 0 1e999\"/></equality>", 7, "it must be 3 numbers"),
        ("<equality/>", "<equality><connect body2=\"a\" anchor=\"0 0 0\"/></equality>", 7, "nor a `body1`"),
        (
            "<equality/>",
            "<equality><connect body1=\"b\" anchor=\"0 0 0\"/></equality>",
            7,
            "the body `b`, which does not",
        ),
        (
            "<equality/>",
            "<equality><connect body1=\"a\" body2=\"a\" anchor=\"0 0 0\"/></equality>",
            7,
            "no joint moves",
        ),
        ("<equality/>", "<equality><connect site1=\"a\" site2=\"b\"/></equality>", 7, "the site `a`, which does not"),
        ("<equality/>", "<equality><connect site1=\"a\" body2=\"a\"/></equality>", 7, "neither two sites nor"),
        ("<equality/>", "<equality><connect body1=\"a\" ancor=\"0 0 0\"/></equality>", 7, "did you mean `anchor`"),
        ("<equality/>", "<equality><weld body1=\"a\"/></equality>", 7, "leave no joint that moves"),
        ("<equality/>", "<equality><weld body1=\"a\" relpose=\"0 0 0 1\"/></equality>", 7, "it must be 7 numbers"),
        ("<equality/>", "<equality><tendon tendon1=\"a\"/></equality>", 7, "neither `joint`, `connect` nor"),
        ("<equality/>", "<equality><joint joint1=\"k\"/></equality>", 7, "the joint `k`, which does not exist"),
        ("<equality/>", "<equality><joint/></equality>", 7, "lacks the attribute `joint1`"),
        (
            "<equality/>",
            "<equality><joint joint1=\"j\" joint2=\"j\" polycoef=\"0 1 2\"/></equality>",
            7,
            "a degree above 1",
        ),
        ("<equality/>", "<actuator><motor joint=\"k\"/></actuator>", 7, "the joint `k`, which does not exist"),
        ("<mujoco model=\"m\">", "<!DOCTYPE m><mujoco model=\"m\">", 1, "a document type"),
        ("</mujoco>", "</mujoco><mujoco/>", 8, "a second element"),
        ("</body>", "</bodi>", 6, "this is not XML"),
        ("<body name=\"a\">", "<body name=\"a\" name=\"b\">", 3, "this is not XML"),
        ("<compiler", "<default><default/></default><compiler", 2, "lacks the attribute `class`"),
    ] {
        let message = refused(&with(old, new));
        assert!(message.contains(part), "{new}: {message}");
        assert!(message.contains(&format!("bad.xml:{line}:")), "{new}: {message}");
    }
    for text in ["<mujoco/>", "<mujoco", "<mujoco>", "<mujoco><worldbody/></mujoco>", "<mujoco>&#0;</mujoco>"] {
        assert!(refused(text).starts_with("error: "), "{text}");
    }
    let deep = format!("<mujoco>{}", "<body>".repeat(100_000));
    assert!(refused(&deep).contains("more than 256 levels deep"));
    let circle = with("<equality/>", "<equality><joint joint1=\"j\" joint2=\"j\"/></equality>");
    assert!(refused(&circle).contains("form a circle"), "{}", refused(&circle));
}

/// A mistake in an included file is shown there.
#[test]
fn an_included_file_has_its_own_lines() {
    let folder = tempfile::tempdir().expect("a folder");
    let main = folder.path().join("main.xml");
    let text = with("<joint name=\"j\"/>", "<joint/>\n<include file=\"part.xml\"/>");
    let said = |part: &str| {
        fs::write(folder.path().join("part.xml"), part).expect("a file");
        Urdf::read(main.to_str().expect("Unicode"), &text).expect_err(part).to_string()
    };
    let message = said("<mujocoinclude>\n<body><joint range=\"1\"/></body>\n</mujocoinclude>");
    assert!(message.contains("part.xml:2:"), "{message}");
    let message = said("<mujoco>\n<include file=\"part.xml\"/></mujoco>");
    assert!(message.contains("is included twice"), "{message}");
    let message = said("<robot/>");
    assert!(message.contains("where `mujoco` is needed") && message.contains("part.xml:1:"), "{message}");
}
