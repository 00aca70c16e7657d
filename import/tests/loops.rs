//! Closed loops of URDF+, of the YAML beside a URDF, and of MJCF: which joints are dependent, and what is refused.

use std::fmt::Write as _;

use rne_convert::{Imported, Options, Selection, Urdf};
use rne_model::{Cut, Robot};

/// A four-bar whose sides are 0.5 m and 1 m. `joints` are the attributes of its three joints, `end` is what is before
/// `</robot>`.
fn four_bar(joints: [&str; 3], end: &str) -> String {
    let mut text = "<robot name=\"bars\">\n<link name=\"base\"/>\n".to_owned();
    for link in ["crank", "coupler", "rocker"] {
        let _ = writeln!(
            text,
            "<link name=\"{link}\"><inertial><origin xyz=\"0.2 0 0\"/><mass value=\"1\"/>\
             <inertia ixx=\"0.01\" ixy=\"0\" ixz=\"0\" iyy=\"0.02\" iyz=\"0\" izz=\"0.02\"/></inertial></link>"
        );
    }
    let places = [("base", "crank", "0 0 0"), ("crank", "coupler", "0.5 0 0"), ("base", "rocker", "1 0 0")];
    for ((parent, child, xyz), attributes) in places.into_iter().zip(joints) {
        let _ = writeln!(
            text,
            "<joint name=\"to_{child}\" type=\"continuous\" {attributes}><parent link=\"{parent}\"/>\
             <child link=\"{child}\"/><origin xyz=\"{xyz}\"/><axis xyz=\"0 0 1\"/>\
             <dynamics damping=\"0.1\"/></joint>"
        );
    }
    format!("{text}{end}\n</robot>\n")
}

const SAID: [&str; 3] = ["independent=\"true\"", "independent=\"false\"", "independent=\"false\""];

/// The loop of the four-bar, in line 9 of its file.
const LOOP: &str = "<loop name=\"pin\" type=\"revolute\"><predecessor link=\"coupler\"><origin xyz=\"1 0 0\"/>\
                    </predecessor><successor link=\"rocker\"><origin xyz=\"0.5 0 0\"/></successor>\
                    <axis xyz=\"0 0 1\"/></loop>";

fn import(text: &str, options: &Options) -> Imported {
    let imported = Urdf::read("bars.urdf", text).and_then(|urdf| urdf.import(options));
    imported.unwrap_or_else(|report| panic!("{report}"))
}

fn plain(text: &str) -> Imported {
    import(text, &Options::default())
}

fn refused(text: &str) -> String {
    let report = Urdf::read("bars.urdf", text).and_then(|urdf| urdf.import(&Options::default()).map(|_| ()));
    report.unwrap_err().to_string()
}

fn dependent(robot: &Robot) -> Vec<&str> {
    robot.closed.passive.iter().map(|&joint| robot.joints[joint].name.as_str()).collect()
}

fn told(imported: &Imported) -> String {
    imported.account.sentences().join("\n")
}

#[test]
fn joints_without_motors_are_dependent() {
    let imported = plain(&four_bar(SAID, LOOP));
    let robot = &imported.robot;
    assert_eq!(dependent(robot), ["to_coupler", "to_rocker"]);
    let [closed] = &robot.closed.loops[..] else { panic!("{:?}", robot.closed.loops) };
    assert_eq!((closed.name.as_str(), closed.cut), ("pin", Cut::Revolute));
    assert_eq!(closed.between.map(|end| end.placement.xyz), [[1.0, 0.0, 0.0], [0.5, 0.0, 0.0]]);
    assert!(robot.joints[0].motor.is_some(), "the friction of the motor stays");
    assert!(robot.joints[1].motor.is_none() && robot.joints[2].motor.is_none());
    for words in
        ["the file says that these joints have no motors", "friction and rotors of dependent joints are left out"]
    {
        assert!(told(&imported).contains(words), "{}", told(&imported));
    }
}

/// The rank decides how many, and the report says which were chosen.
#[test]
fn what_the_file_does_not_say_is_chosen_and_told() {
    let unsaid = plain(&four_bar(["", "", ""], LOOP));
    assert_eq!(dependent(&unsaid.robot).len(), 2);
    assert!(told(&unsaid).contains("the file does not say whether"), "{}", told(&unsaid));
    let one = plain(&four_bar(["", "independent=\"true\"", ""], LOOP));
    assert_eq!(dependent(&one.robot), ["to_crank", "to_rocker"]);
    let two = plain(&four_bar(["independent=\"true\"", "independent=\"false\"", "independent=\"true\""], LOOP));
    assert_eq!(dependent(&two.robot).len(), 2);
    assert!(dependent(&two.robot).contains(&"to_coupler"));
    assert!(told(&two).contains("fewer freedoms than there are motors"), "{}", told(&two));
    let none = plain(&four_bar(["independent=\"false\""; 3], LOOP));
    assert!(told(&none).contains("freedoms that no motor of the file moves"), "{}", told(&none));
}

/// z of the places is the axis, whatever the axes of the file are.
#[test]
fn the_axis_of_the_file_is_z_of_the_places() {
    let about_y = four_bar(SAID, LOOP).replace("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 2 0\"/>");
    assert_eq!(dependent(&plain(&about_y).robot), ["to_coupler", "to_rocker"]);
    // y of origins that are turned about x is z of the bodies
    let turned = LOOP.replace("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 1 0\"/>");
    let turned = turned.replace("<origin ", "<origin rpy=\"1.5707963267948966 0 0\" ");
    let imported = plain(&four_bar(SAID, &turned));
    let places = |imported: &Imported| imported.robot.closed.loops[0].between.map(|end| end.placement);
    assert_eq!(places(&imported), places(&plain(&four_bar(SAID, LOOP))));
}

#[test]
fn an_arm_alone_has_no_loops_and_held_loops_are_left_out() {
    let arm = Options {
        selection: Selection { tip: Some("coupler".to_owned()), lock_others: true, ..Selection::default() },
        ..Options::default()
    };
    let text = four_bar(SAID, LOOP);
    let report = Urdf::read("bars.urdf", &text).and_then(|urdf| urdf.import(&arm).map(|_| ())).unwrap_err().to_string();
    assert!(
        report.contains("the joint `to_coupler` of the arm moves the closed loop `pin`")
            && report.contains("bars.urdf:9:"),
        "{report}"
    );
    // another link, whose joint is in no loop
    let lamp = "<link name=\"lamp\"/><joint name=\"to_lamp\" type=\"continuous\"><parent link=\"base\"/>\
                <child link=\"lamp\"/><axis xyz=\"0 0 1\"/></joint>";
    let arm = Options { selection: Selection { tip: Some("lamp".to_owned()), ..arm.selection }, ..arm };
    let imported = import(&four_bar(SAID, &format!("{LOOP}{lamp}")), &arm);
    assert!(
        imported.robot.closed.is_empty() && told(&imported).contains("the loop `pin` is left out"),
        "{}",
        told(&imported)
    );
}

#[test]
fn every_mistake_of_a_loop_has_its_place() {
    let with = |old: &str, new: &str| {
        assert_eq!(LOOP.matches(old).count(), 1, "{old}");
        four_bar(SAID, &LOOP.replace(old, new))
    };
    for (old, new, part) in [
        ("link=\"coupler\"", "link=\"arm\"", "the loop `pin` refers to the link `arm`, which does not exist"),
        ("link=\"coupler\"", "link=\"rocker\"", "no joint moves the ends of the loop `pin` against each other"),
        ("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>", "the axis of the loop `pin` has no direction"),
        ("<axis xyz=\"0 0 1\"/>", "", "is revolute and has no element `axis`"),
        ("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 nan\"/>", "it must be three numbers"),
        ("xyz=\"1 0 0\"", "xyz=\"1 0 inf\"", "it must be three numbers"),
        ("xyz=\"1 0 0\"", "xyz=\"9 0 0\"", "no position of the joints closes the loop `pin`"),
        ("type=\"revolute\"", "type=\"prismatic\"", "`type` of `loop` is `prismatic`; it must be revolute"),
        ("type=\"revolute\"", "", "`loop` lacks the attribute `type`"),
        ("type=\"revolute\"", "type=\"spherical\"", "has an `axis`, but it is not revolute"),
        ("<successor link=\"rocker\"><origin xyz=\"0.5 0 0\"/></successor>", "", "has no element `successor`"),
        ("<origin xyz=\"1 0 0\"/>", "<origin/><origin/>", "a second `origin` in one `predecessor`"),
    ] {
        let said = refused(&with(old, new));
        assert!(said.contains(part) && said.contains("bars.urdf:9:"), "{new}: {said}");
    }
    for (end, part) in [
        (LOOP.repeat(2), "two loops have the name `pin`"),
        (format!("{LOOP}{}", LOOP.replace("pin", "pin2")), "the loop `pin2` adds no equation"),
        (
            LOOP.replace("revolute", "fixed").replace("<axis xyz=\"0 0 1\"/>", "").replace("0.5 0 0", "0.2 0 0"),
            "leave no joint that moves",
        ),
    ] {
        let said = refused(&four_bar(SAID, &end));
        assert!(said.contains(part) && said.contains("bars.urdf:9:"), "{said}");
    }
    let said = refused(&four_bar(["independent=\"yes\"", "", ""], LOOP));
    assert!(said.contains("it must be true or false") && said.contains("bars.urdf:6:"), "{said}");
}

/// Numbers that are rounded out of the plane close the loop all the same.
#[test]
fn rounded_numbers_close_and_are_told() {
    let imported = plain(&four_bar(SAID, &LOOP.replace("xyz=\"1 0 0\"", "xyz=\"1 0 0.0000001\"")));
    assert_eq!(dependent(&imported.robot), ["to_coupler", "to_rocker"]);
    assert!(told(&imported).contains("which is taken for rounding of the file"), "{}", told(&imported));
    let said = refused(&four_bar(SAID, &LOOP.replace("xyz=\"1 0 0\"", "xyz=\"1 0 0.001\"")));
    assert!(said.contains("no position of the joints closes"), "{said}");
}

/// The ends of the four-bar as links, whose names a YAML file has.
fn with_ends() -> String {
    let end = |name: &str, on: &str, xyz: &str| {
        format!(
            "<link name=\"{name}\"/><joint name=\"{name}_frame\" type=\"fixed\"><parent link=\"{on}\"/>\
             <child link=\"{name}\"/><origin xyz=\"{xyz}\"/></joint>"
        )
    };
    four_bar(["", "", ""], &(end("A", "coupler", "1 0 0") + &end("B", "rocker", "0.5 0 0")))
}

const YAML: &str = "closed_loop: [[A, B]]\ntype: ['3d']\nname_mot: [to_crank]\n";

#[test]
fn the_file_beside_a_urdf_has_its_loops() {
    let folder = tempfile::tempdir().expect("a folder");
    let urdf = folder.path().join("bars.urdf").display().to_string();
    let read = |yaml: &str| {
        std::fs::write(folder.path().join("bars.yaml"), yaml).expect("a file");
        let read = Urdf::read(&urdf, &with_ends()).and_then(|urdf| urdf.import(&whole()));
        read.unwrap_or_else(|report| panic!("{report}"))
    };
    let imported = read(YAML);
    assert_eq!(dependent(&imported.robot), ["to_coupler", "to_rocker"]);
    assert_eq!(imported.robot.closed.loops[0].cut, Cut::Spherical);
    assert!(told(&imported).contains("the closed loops are those of `bars.yaml`"), "{}", told(&imported));
    // a robot file beside it has none
    assert!(read("format: 1\nname: bars\n").robot.closed.is_empty());
    // what was read before is read again
    let dof = |urdf: &str| rne_convert::import(urdf, &with_ends(), &whole()).expect("a robot").robot.dof();
    assert_eq!(dof(&urdf), 3);
    std::fs::write(folder.path().join("bars.yaml"), YAML).expect("a file");
    assert_eq!(dof(&urdf), 1);
}

fn whole() -> Options {
    let selection = Selection { whole: true, ..Selection::default() };
    Options { selection, convention: rne_model::Convention::Modified, ..Options::default() }
}

#[test]
fn every_mistake_of_the_file_beside_a_urdf_has_its_place() {
    for (old, new, place, part) in [
        ("['3d']", "['3d', '6d']", "2:8", "`closed_loop` has 1 entries and `type` has 2"),
        ("['3d']", "['4d']", "2:8", "the type of a loop is `4d`; it must be `6d` or `3d`"),
        ("[[A, B]]", "[[A, C]]", "1:19", "the loop names `C`, which is no link and no joint of the URDF"),
        ("[[A, B]]", "[[A, coupler]]", "1:16", "no joint moves the ends of the loop `loop1`"),
        ("[[A, B]]", "[[A, B, C]]", "1:15", "found a list of 3 where a list of two names is needed"),
        ("[[A, B]]", "[A, B]", "1:15", "found `A` where a list of two names is needed"),
        ("[[A, B]]", "A", "1:14", "found `A` where a list of pairs is needed"),
        ("to_crank", "to_crnk", "3:12", "there is no joint `to_crnk` in the URDF"),
        ("name_mot:", "joint_name: [to_crank]\nname_mot:", "1:1", "`joint_name` has 1 entries and `joint_type` has 0"),
        (
            "name_mot:",
            "joint_name: [to_crank]\njoint_type: [PLANAR]\nname_mot:",
            "4:14",
            "the type of a joint is `PLANAR`",
        ),
        ("name_mot:", "joint_name: [A_frame]\njoint_type: [SPHERICAL]\nname_mot:", "3:14", "is fixed in the URDF"),
        ("closed_loop:", "closed_loops:", "1:1", "did you mean `closed_loop`?"),
        ("closed_loop: [[A, B]]", "", "1:1", "the file has no key `closed_loop`"),
        ("]]", "]", "2:", "error"),
    ] {
        assert_eq!(YAML.matches(old).count(), 1, "{old}");
        let yaml = YAML.replace(old, new);
        let said =
            Urdf::read_with_loops("bars.urdf", &with_ends(), Some(("loops.yaml", &yaml))).expect_err(new).to_string();
        assert!(said.contains(part) && said.contains(&format!("loops.yaml:{place}")), "{new}: {said}");
    }
    let mjcf = "<mujoco><worldbody><body/></worldbody></mujoco>";
    let said = Urdf::read_with_loops("x.xml", mjcf, Some(("loops.yaml", YAML))).expect_err("MJCF").to_string();
    assert!(said.contains("this is an MJCF file"), "{said}");
}

/// A four-bar of MuJoCo: `equality` has its loop, `joint` is an element in the coupler.
fn model(equality: &str, joint: &str) -> String {
    let inertial = "<inertial pos=\"0.2 0 0\" mass=\"1\" diaginertia=\"0.01 0.02 0.02\"/>";
    format!(
        "<mujoco><worldbody><body name=\"crank\"><joint name=\"a\"/>{inertial}\
         <body name=\"coupler\" pos=\"0.5 0 0\">{joint}{inertial}<site name=\"end\" pos=\"1 0 0\"/></body></body>\
         <body name=\"rocker\" pos=\"1 0 0\"><joint name=\"c\"/>{inertial}<site name=\"pin\" pos=\"0.5 0 0\"/></body>\
         </worldbody>\n<equality>{equality}</equality><actuator><motor joint=\"a\"/></actuator></mujoco>"
    )
}

#[test]
fn mjcf_closes_loops_by_bodies_and_by_sites() {
    let hinge = "<joint name=\"b\"/>";
    for equality in
        ["<connect body1=\"coupler\" body2=\"rocker\" anchor=\"1 0 0\"/>", "<connect site1=\"end\" site2=\"pin\"/>"]
    {
        let imported = plain(&model(equality, hinge));
        assert_eq!(dependent(&imported.robot), ["b", "c"], "{equality}");
        let [closed] = &imported.robot.closed.loops[..] else { panic!("{equality}") };
        assert_eq!(closed.between.map(|end| end.placement.xyz), [[1.0, 0.0, 0.0], [0.5, 0.0, 0.0]], "{equality}");
    }
    // a point of the coupler that the world holds
    let held =
        plain(&model("<connect body1=\"coupler\" anchor=\"0.7 0 0\"/>", hinge).replace("<motor joint=\"a\"/>", ""));
    let refused = |equality: &str| refused(&model(equality, hinge));
    assert_eq!(held.robot.closed.loops.len(), 1);
    assert!(
        refused("<weld body1=\"coupler\" body2=\"rocker\" relpose=\"0.8 0 0 1 0 0 0\"/>")
            .contains("leave no joint that moves")
    );
    // MuJoCo does not close by what a motion capture moves
    let captured = "<weld body1=\"coupler\" body2=\"hand\"/>";
    let text = model(captured, hinge)
        .replace("<body name=\"rocker\"", "<body name=\"hand\" mocap=\"true\"/><body name=\"rocker\"");
    let imported = import(&text, &whole());
    assert!(
        imported.robot.closed.is_empty() && told(&imported).contains("a motion capture moves are left out"),
        "{}",
        told(&imported)
    );
}

/// A weld with a pose and an anchor joins the point at the pose of the first body to the anchor of the second one.
#[test]
fn a_weld_has_a_pose_and_an_anchor() {
    let weld = "<weld body1=\"coupler\" body2=\"rocker\" relpose=\"1 0 0.1 1 0 0 0\" anchor=\"0.5 0 0.1\"/>";
    let text = model(weld, "<joint name=\"b\" type=\"ball\"/>");
    let [closed] = &plain(&text).robot.closed.loops[..] else { panic!("one loop") };
    assert_eq!(closed.between.map(|end| end.placement.xyz), [[1.0, 0.0, 0.1], [0.5, 0.0, 0.1]]);
}

/// An equality is inactive by itself, by a class, or by the options of the file.
#[test]
fn inactive_loops_are_left_out() {
    let connect = "<connect body1=\"coupler\" body2=\"rocker\" anchor=\"1 0 0\"/>";
    let text = model(connect, "<joint name=\"b\"/>");
    for inactive in [
        text.replace("<connect ", "<connect active=\"false\" "),
        text.replace("<worldbody>", "<default><equality active=\"false\"/></default><worldbody>"),
        text.replace("<worldbody>", "<option><flag equality=\"disable\"/></option><worldbody>"),
    ] {
        let imported = import(&inactive, &whole());
        assert!(imported.robot.closed.is_empty(), "{inactive}");
        assert!(told(&imported).contains("equalities that are not active are left out"), "{}", told(&imported));
    }
    let class = "<default><equality active=\"false\"/></default><worldbody>";
    let active = text.replace("<worldbody>", class).replace("<connect ", "<connect active=\"true\" ");
    assert_eq!(plain(&active).robot.closed.loops.len(), 1);
}

/// A ball in a loop is three joints; the coupler turns about itself between two spherical joints.
#[test]
fn a_ball_in_a_loop_is_three_joints() {
    let ball = "<joint name=\"b\" type=\"ball\"/>";
    let imported = plain(&model("<connect site1=\"end\" site2=\"pin\"/>", ball));
    let names: Vec<&str> = imported.robot.joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names, ["a", "b_x", "b_y", "b_z", "c"]);
    assert_eq!(imported.robot.dof(), 2);
    assert!(told(&imported).contains("become three revolute joints each"), "{}", told(&imported));
    assert!(told(&imported).contains("freedoms that no motor of the file moves"), "{}", told(&imported));
}
