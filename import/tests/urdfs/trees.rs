//! Trees as URDFs, and back.

use super::*;

/// The URDF of a robot, imported whole, with the gravity that the export reports.
fn again(robot: &Robot) -> Robot {
    let exported = rne_convert::export(robot).unwrap_or_else(|error| panic!("{}: {error}", robot.name));
    let selection = Selection {
        whole: true,
        floating: Some(robot.floating_base.is_some()),
        tip: Some("tip".to_owned()),
        ..Selection::default()
    };
    let options = Options {
        selection,
        convention: Convention::Modified,
        snap: false,
        keep_unphysical: true,
        gravity: exported.gravity,
        ..Options::default()
    };
    let urdf = Urdf::read("again.urdf", &exported.text).unwrap_or_else(|report| panic!("{report}"));
    let imported = urdf.import(&options).unwrap_or_else(|report| panic!("{}: {report}", robot.name));
    assert!(imported.account.rounding.position < 1e-12, "{}: {:?}", robot.name, imported.account.rounding);
    imported.robot
}

fn free(robot: &Robot) -> Vec<&str> {
    let free = robot.joints.iter().filter(|joint| joint.coupling.is_none());
    free.map(|joint| joint.name.as_str()).collect()
}

/// Torques, tip and followers of the URDF are those of the robot without the motors of its list, joint by joint.
fn assert_same(robot: &Robot) {
    let other = again(robot);
    let robot = &Robot { drives: Vec::new(), ..robot.clone() };
    let places: Vec<usize> = free(&other)
        .iter()
        .map(|name| free(robot).iter().position(|known| known == name).unwrap_or_else(|| panic!("{name}")))
        .collect();
    assert_eq!(places.len(), robot.dof(), "{}", robot.name);
    let mut random = fastrand::Rng::with_seed(3);
    let [one, two] = [robot, &other].map(DynArm::from_robot);
    for _ in 0..3 {
        let mut state = || -> Vec<f64> { (0..robot.dof()).map(|_| 2.0 * random.f64() - 1.0).collect() };
        let states = [state(), state(), state()];
        let [q, qd, qdd] = states.clone().map(|all| places.iter().map(|&place| all[place]).collect::<Vec<f64>>());
        let expected = one.inverse_dynamics(&states[0], &states[1], &states[2]).unwrap();
        let found = two.inverse_dynamics(&q, &qd, &qdd).unwrap();
        let scale = expected.iter().fold(0.0, |largest: f64, torque| largest.max(torque.abs()));
        for (found, &place) in found.iter().zip(&places) {
            assert!((found - expected[place]).abs() < 1e-12 * scale, "{}: {found} {}", robot.name, expected[place]);
        }
        let [here, there] = [(&one, &states[0]), (&two, &q)]
            .map(|(arm, q)| <[f64; 3]>::from(arm.forward_kinematics(q).unwrap().translation_vector()));
        assert!(here.iter().zip(there).all(|(a, b)| (a - b).abs() < 1e-12), "{}: {here:?} {there:?}", robot.name);
    }
}

#[test]
fn trees_come_back_with_their_torques() {
    let mut seen = 0;
    for file in rne_robots::all() {
        let robot = Reader::new(file.name).trees().couplings().read(file.yaml).unwrap().robot;
        if robot.is_serial() && !robot.has_couplings() && robot.drives.is_empty() {
            continue;
        }
        assert_same(&robot);
        seen += 1;
    }
    assert!(seen >= 5, "{seen}");
}

fn read(text: &str) -> Robot {
    Reader::new("tree").trees().couplings().read(text).unwrap_or_else(|report| panic!("{report}")).robot
}

const TREE: &str = "
format: 2
name: tree
source: by hand
convention: standard
gravity: [0, 0, -9.81]
base: {xyz: [0.1, 0.2, 0.3], rpy: [0, 0, 0.5]}
tool: {on: follower, xyz: [0.1, 0.2, 0.3], rpy: [0.3, 0.2, 0.1]}
joints:
  - {name: waist, type: revolute, dh: {theta: 0, d: 0.3, a: 0.1, alpha: pi/2},
     link: {mass: 2, com: [0, 0.1, 0], inertia: {xx: 0.1, yy: 0.2, zz: 0.15}}}
  - {name: left, type: revolute, dh: {theta: 0.1, d: 0, a: 0.2, alpha: 0.3}, link: {mass: 1, com: [0.1, 0, 0]}}
  - {name: right, parent: waist, at: {xyz: [0, 0.2, -0.1], rpy: [0.1, 0.2, 0.3]}, type: prismatic,
     dh: {theta: 0.4, d: 0.1, a: 0.2, alpha: 1}, link: {mass: 1, com: [0.1, 0, 0]}}
  - {name: follower, parent: left, type: revolute, dh: {theta: 0, d: 0, a: 0.3, alpha: 0},
     link: {mass: 1, com: [0.1, 0, 0]}}
frames: [{name: eye, on: left, xyz: [0.1, 0, 0], rpy: [0, 0, 1]}]
bodies:
  - {name: camera, on: left, at: {xyz: [0, 0, 0.1], rpy: [0, 0, 1]}, mass: 0.5, com: [0.01, 0, 0],
     inertia: {xx: 0.001, yy: 0.001, zz: 0.001}}
couplings: [{joint: follower, follows: {left: -0.5}, offset: 0.25}]
motors: [{name: shoulder, turns: {left: 20}, rotor: {axis: [0, 0, 1], on: waist, inertia: 1e-4}}]
";

#[test]
fn a_urdf_has_followers_frames_and_bodies_of_a_tree() {
    let robot = read(TREE);
    assert_same(&robot);
    let exported = rne_convert::export(&robot).unwrap();
    let text = &exported.text;
    assert!(text.contains("<mimic joint=\"left\" multiplier=\"-0.5\" offset=\"0.25\"/>"), "{text}");
    assert!(text.contains("<link name=\"eye\"/>") && text.contains("<link name=\"camera\">\n    <inertial>"), "{text}");
    assert!(exported.remarks.iter().any(|remark| remark.contains("with their rotors: shoulder;")), "{exported:?}");
    assert!(exported.remarks.iter().any(|remark| remark.contains("no limit of effort or velocity")), "{exported:?}");
}

#[test]
fn a_joint_that_follows_two_has_no_urdf() {
    let text = TREE.replace("follows: {left: -0.5}", "follows: {left: -0.5, waist: 1}");
    let said = rne_convert::export(&read(&text)).expect_err("two leaders").to_string();
    assert!(said.contains("follower follows waist and left, and a URDF cannot say this"), "{said}");
}

/// The base is the root link with its body, and no joint holds it: what moves the robot in free flight is the same.
#[test]
fn a_floating_base_is_the_root_of_a_urdf() {
    let satellite = include_str!("../../../docs/satellite.yaml");
    let lamp = "bodies: [{name: lamp, on: bus, at: {xyz: [0.1, 0, 1]}, mass: 3, com: [0, 0, 0.1]}]";
    for text in [satellite.to_owned(), format!("{satellite}{lamp}"), satellite.replace("bus", "link_2")] {
        let robot = read(&text);
        assert_same(&robot);
        let urdf = rne_convert::export(&robot).unwrap().text;
        let name = if text.contains("bus") { "bus" } else { "base" };
        assert!(urdf.contains(&format!("<link name=\"{name}\">\n    <inertial>")), "{urdf}");
        assert!(!urdf.contains("world"), "no joint holds the base: {urdf}");
        let other = again(&robot);
        let [one, two] = [&robot, &other].map(|robot| robot.floating_base.as_ref().expect("a base").link);
        assert!((one.mass - two.mass).abs() < 1e-12 * one.mass && other.floating_base.as_ref().unwrap().name == name);
        let base = BaseMotion {
            omega: [0.1, 0.2, -0.3],
            omega_dot: [1.0, -0.5, 0.3],
            velocity: [0.0; 3],
            acceleration: [0.3, 0.2, 0.1],
            gravity: [0.0, 0.0, -9.81],
        };
        let wrench = |robot: &Robot| {
            let arm = DynArm::from_robot(robot);
            let (q, qd, qdd) = ([0.3, -0.7], [1.0, -2.0], [3.0, 2.0]);
            let tips = vec![Wrench::zero(); arm.tips().len()];
            let DynFloatingTorques { wrench, tau } =
                arm.inverse_dynamics_of_floating_base(&q, &qd, &qdd, &base, &tips).unwrap();
            [wrench.force.to_vec(), wrench.moment.to_vec(), tau].concat()
        };
        for (a, b) in wrench(&robot).iter().zip(wrench(&other)) {
            assert!(f64::abs(a - b) < 1e-11, "{a} {b}");
        }
    }
}

/// A URDF has no contacts, and the export says so.
#[test]
fn contacts_are_left_out_with_a_note() {
    let robot = read(include_str!("../../../docs/standing_hyq.yaml"));
    let exported = rne_convert::export(&robot).unwrap();
    let note = "the contacts at lf_foot, lh_foot, rf_foot, rh_foot are left out: a URDF has no place for them";
    assert!(exported.remarks.iter().any(|remark| remark.starts_with(note)), "{:?}", exported.remarks);
    assert!(exported.text.contains(note), "{}", exported.text);
}

/// A floating joint on a root without mass makes the base float: the same robot as without this root and joint.
#[test]
fn a_floating_joint_makes_the_base_float() {
    let inertial = "<inertial><origin xyz='0.1 0 0.2'/><mass value='2'/>
<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0.1' iyz='0'/></inertial>";
    let hinge = |name: &str, child: &str| {
        format!(
            "<joint name='{name}' type='continuous'><origin xyz='0.3 0 0' rpy='0.1 0.2 0.3'/><parent link='trunk'/>
<child link='{child}'/><axis xyz='0 1 0'/></joint><link name='{child}'>{inertial}</link>"
        )
    };
    let trunk = format!("<link name='trunk'>{inertial}</link>{}{}", hinge("a", "left"), hinge("b", "right"));
    let world = |root: &str, kind: &str| {
        format!(
            "<robot name='r'>{root}
<joint name='f' type='{kind}'><origin xyz='0 0 1' rpy='0 0 0.5'/><parent link='world'/><child link='trunk'/></joint>
{trunk}</robot>"
        )
    };
    let alone = format!("<robot name='r'>{trunk}</robot>");
    let import = |text: &str, floating| {
        let selection = Selection { floating, whole: true, tip: Some("left".to_owned()), ..Selection::default() };
        let options = Options { selection, convention: Convention::Modified, ..Options::default() };
        Urdf::read("r.urdf", text).and_then(|urdf| urdf.import(&options))
    };
    let floats = world("<link name='world'/>", "floating");
    let expected = import(&alone, Some(true)).unwrap();
    assert_eq!(expected.account.floats, None, "the file does not say so");
    for floating in [None, Some(true)] {
        let imported = import(&floats, floating).unwrap();
        assert_eq!(imported.account.floats, Some(true));
        let robot = Robot { notes: expected.robot.notes.clone(), ..imported.robot };
        assert_eq!(robot, expected.robot);
    }
    // fixed, and as one arm, it is the robot of a fixed joint
    for whole in [true, false] {
        let [one, other] = ["floating", "fixed"].map(|kind| {
            let base = Selection { base: Some("trunk".to_owned()), ..Selection::default() };
            let selection = Selection { floating: Some(false), whole, lock_others: true, ..base };
            let selection = Selection { tip: Some("left".to_owned()), ..selection };
            let options = Options { selection, convention: Convention::Modified, ..Options::default() };
            let urdf = Urdf::read("r.urdf", &world("<link name='world'/>", kind)).unwrap();
            urdf.import(&options).unwrap()
        });
        assert_eq!([one.account.floats, other.account.floats], [Some(false), None]);
        assert_eq!(Robot { notes: None, ..one.robot }, Robot { notes: None, ..other.robot });
    }
    // the mass of a base that stands still is told, whatever is imported, and is that of the floating base
    let mass = expected.robot.floating_base.as_ref().unwrap().link.mass;
    let told = format!("the base stands still: its mass of {mass} kg is left out");
    let says = |imported: &Imported| imported.account.remarks.iter().find(|remark| remark.text == told).cloned();
    for whole in [true, false] {
        for (text, remedy) in [(&alone, Some(rne_model::Remedy::Float)), (&floats, None)] {
            let selection = Selection { floating: Some(false), whole, ..Selection::default() };
            let selection = Selection { tip: Some("left".to_owned()), lock_others: true, ..selection };
            let options = Options { selection, convention: Convention::Modified, ..Options::default() };
            let imported = Urdf::read("r.urdf", text).and_then(|urdf| urdf.import(&options)).unwrap();
            assert_eq!(says(&imported).expect("a remark").remedy, remedy, "{text}");
            assert!(imported.text.contains(&told), "{}", imported.text);
        }
    }
    assert!(says(&expected).is_none());
    // a root with mass is a second body, and no world
    let heavy = world(&format!("<link name='world'>{inertial}</link>"), "floating");
    let said = import(&heavy, None).unwrap_err().to_string();
    assert!(said.contains("joints with more than one freedom") && said.contains("`f`"), "{said}");
    assert!(import(&alone, None).unwrap().robot.floating_base.is_none());
}

/// The placement of a floating joint, behind a fixed one or not, is part of the pose of the base: the account tells it,
/// and the robot whose base is fixed there has the torques of the one that floats there.
#[test]
fn the_placement_of_a_floating_joint_is_told() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let body = "<inertial><origin xyz='0.1 0.02 0.03'/><mass value='2'/>
<inertia ixx='0.1' iyy='0.12' izz='0.15' ixy='0' ixz='0' iyz='0'/></inertial>";
    let text = |between: &str, parent: &str, origin: &str| {
        format!(
            "<robot name='r'><link name='world'/>{between}
<joint name='f' type='floating'>{origin}<parent link='{parent}'/><child link='trunk'/></joint>
<link name='trunk'>{body}</link><joint name='j' type='continuous'><origin xyz='0 0 0.2'/><parent link='trunk'/>
<child link='leg'/><axis xyz='1 2 3'/></joint><link name='leg'>{body}</link></robot>"
        )
    };
    let origin = |roll: f64, yaw: f64| format!("<origin xyz='1 0 0' rpy='{roll} 0 {yaw}'/>");
    let mount = format!(
        "<joint name='m' type='fixed'>{}<parent link='world'/><child link='mount'/></joint><link name='mount'/>",
        origin(quarter, 0.0)
    );
    let cases = [
        (text("", "world", ""), None, [0.0, 0.0, -9.81]),
        (text("", "world", &origin(quarter, 0.0)), Some("[1.0, 0.0, 0.0] m, rpy [1.57"), [0.0, -9.81, 0.0]),
        (text(&mount, "mount", &origin(0.0, quarter)), Some("[2.0, 0.0, 0.0] m, rpy [0.0, -1.57"), [-9.81, 0.0, 0.0]),
        (text(&mount, "mount", "<origin xyz='-1 0 0'/>"), Some("[0.0, 0.0, 0.0] m, rpy [1.57"), [0.0, -9.81, 0.0]),
    ];
    for (text, told, gravity) in cases {
        let import = |floating| {
            let selection = Selection { floating, whole: true, ..Selection::default() };
            let options = Options { selection, convention: Convention::Modified, ..Options::default() };
            Urdf::read("r.urdf", &text).and_then(|urdf| urdf.import(&options)).unwrap()
        };
        let floating = import(None);
        let remark =
            floating.account.remarks.iter().find(|remark| remark.text.contains("the floating joint of `trunk`"));
        assert_eq!(remark.is_some(), told.is_some(), "{:?}", floating.account.remarks);
        if let (Some(remark), Some(told)) = (remark, told) {
            assert!(remark.text.contains(told) && floating.text.contains("Pinocchio"), "{told}: {remark}");
        }
        let arm = DynArm::from_robot(&floating.robot);
        let (q, free) = ([0.4], vec![Wrench::zero(); arm.tips().len()]);
        let base = BaseMotion { gravity, ..BaseMotion::default() };
        let DynFloatingTorques { wrench, tau } =
            arm.inverse_dynamics_of_floating_base(&q, &[0.0], &[0.0], &base, &free).unwrap();
        for (force, gravity) in wrench.force.iter().zip(gravity) {
            assert!(f64::abs(force + 4.0 * gravity) < 1e-13, "the weight of 4 kg: {force} {gravity}");
        }
        let fixed = DynArm::from_robot(&import(Some(false)).robot).gravity_torques(&q).unwrap();
        assert!(f64::abs(tau[0] - fixed[0]) < 1e-13, "{tau:?} {fixed:?}");
    }
    // what moves or has mass before it is no world
    let heavy = mount.replace("<link name='mount'/>", &format!("<link name='mount'>{body}</link>"));
    for mount in [heavy, mount.replace("'fixed'", "'continuous'")] {
        let selection = Selection { whole: true, ..Selection::default() };
        let options = Options { selection, convention: Convention::Modified, ..Options::default() };
        let urdf = Urdf::read("r.urdf", &text(&mount, "mount", "")).unwrap();
        let said = urdf.import(&options).unwrap_err().to_string();
        assert!(said.contains("joints with more than one freedom") && said.contains("`f`"), "{said}");
    }
}
