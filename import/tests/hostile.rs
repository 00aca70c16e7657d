//! Files that are broken, or want to break something.

use std::fmt::Write as _;

use rne_convert::{Options, Urdf};

fn error(text: &str) -> String {
    Urdf::read("bad.urdf", text).and_then(|urdf| urdf.import(&Options::default()).map(|_| ())).unwrap_err().to_string()
}

/// Two links and a joint, with something in their place.
fn with(old: &str, new: &str) -> String {
    let text = "<robot name=\"r\">\n\
         <link name=\"a\"/>\n\
         <link name=\"b\"><inertial><mass value=\"1\"/>\
         <inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/>\
         </inertial></link>\n\
         <joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/><origin xyz=\"0 0 1\"/>\
         <limit effort=\"1\" velocity=\"1\"/></joint>\n\
         </robot>";
    assert_eq!(text.matches(old).count(), 1, "{old}");
    text.replace(old, new)
}

#[test]
fn every_mistake_has_its_message_and_its_place() {
    for (old, new, line, part) in [
        ("value=\"1\"", "value=\"-1\"", 3, "the mass of the link `b` is -1 kg"),
        ("value=\"1\"", "value=\"nan\"", 3, "`value` of `mass` is `nan`; it must be one number"),
        ("value=\"1\"", "value=\"1e400\"", 3, "`value` of `mass` is `1e400`"),
        ("value=\"1\"", "value=\"\"", 3, "it must be one number"),
        ("ixx=\"1\" ", "", 3, "`inertia` lacks the attribute `ixx`"),
        ("0 0 1", "0 0", 4, "it must be three numbers"),
        ("0 0 1", "0 zero 0 1", 4, "`xyz` of `origin` is `0 zero 0 1`; it must be three numbers"),
        ("0 0 1", "0 0 inf", 4, "it must be three numbers"),
        ("parent link=\"a\"", "parent link=\"x\"", 4, "the joint `j` refers to the link `x`, which does not exist"),
        ("child link=\"b\"", "child link=\"a\"", 2, "the link `a` is part of a circle of joints"),
        ("<link name=\"a\"/>", "<link name=\"b\"/>", 3, "the link `b` is already defined in line 2"),
        ("<link name=\"a\"/>", "<link name=\"a\"/><link name=\"c\"/>", 2, "no joint moves the links `a`, `c`"),
        ("type=\"revolute\"", "", 4, "`joint` lacks the attribute `type`"),
        ("<origin xyz=\"0 0 1\"/>", "<origin/><origin/>", 4, "a second `origin` in one `joint`"),
        ("xyz=\"0 0 1\"", "quat_xyzw=\"0 0 0 1\"", 4, "rne does not read a rotation as `quat_xyzw`"),
        ("<robot name=\"r\">", "<!DOCTYPE r [<!ENTITY e \"x\">]><robot name=\"r\">", 1, "a document type"),
        ("name=\"j\"", "name=\"&e;\"", 4, "`name` cannot be read"),
        ("</robot>", "", 4, "the text ends within an element"),
        ("</robot>", "</robot><robot/>", 5, "a second element after `robot`"),
        ("<robot name=\"r\">", "<sdf><robot name=\"r\">", 1, "SDF is another format"),
        ("<link name=\"a\"/>", "<link name=\"a\"/><xacro:include/>", 2, "which is not expanded yet"),
        ("</link>\n<joint", "</lin>\n<joint", 3, "this is not XML"),
        ("name=\"j\"", "name=\"${prefix}j\"", 4, "`name` of `joint` is `${prefix}j`, an expression of xacro"),
        ("0 0 1", "0 0 $(arg height)", 4, "an expression of xacro"),
    ] {
        let message = error(&with(old, new));
        assert!(message.contains(part), "{new}: {message}");
        let line = if part.starts_with("the text ends") { 5 } else { line };
        assert!(message.contains(&format!("bad.urdf:{line}:")) || part.contains("ends within"), "{new}: {message}");
    }
    for text in
        ["", "   ", "robot", "<robot/>", "<a><robot/></a>", "format: 1", "<robot>&#0;</robot>", "<", "<robot", "\u{0}"]
    {
        let message = error(text);
        assert!(message.starts_with("error: "), "{text}: {message}");
    }
}

/// The place, the name and what was meant.
#[test]
fn what_looks_like_a_slip_is_refused() {
    for (old, new, place, said, meant) in [
        ("<origin xyz", "<Origin xyz", "<Origin", "no element `Origin` in `joint`", "`origin`"),
        ("xyz=", "xzy=", "xzy", "no attribute `xzy` of `origin`", "`xyz`"),
        ("<limit ", "<axes xyz=\"0 1 0\"/><limit ", "<axes", "no element `axes` in `joint`", "`axis`"),
        ("<limit ", "<limits ", "<limits", "no element `limits` in `joint`", "`limit`"),
        ("velocity=", "velocty=", "velocty", "no attribute `velocty` of `limit`", "`velocity`"),
        ("<limit ", "<dynamic/><limit ", "<dynamic", "no element `dynamic` in `joint`", "`dynamics`"),
        ("<limit ", "<dynamics dampng=\"1\"/><limit ", "dampng", "`dampng` of `dynamics`", "`damping`"),
        ("<limit ", "<mimc joint=\"j\"/><limit ", "<mimc", "no element `mimc` in `joint`", "`mimic`"),
        ("<limit ", "<mimic joint=\"j\" ofset=\"2\"/><limit ", "ofset", "`ofset` of `mimic`", "`offset`"),
        ("<mass ", "<mas value=\"1\"/><mass ", "<mas ", "no element `mas` in `inertial`", "`mass`"),
        ("<link name=\"a\"/>", "<Link name=\"a\"/>", "<Link", "no element `Link` in `robot`", "`link`"),
        ("<link name=\"a\"/>", "<link name=\"a\"><inertal/></link>", "<inertal", "`inertal` in `link`", "`inertial`"),
        ("</robot>", "<jiont/></robot>", "<jiont", "no element `jiont` in `robot`", "`joint`"),
        ("parent link", "parent lnik=\"a\" link", "lnik", "no attribute `lnik` of `parent`", "`link`"),
    ] {
        let text = with(old, new);
        let before = &text[..text.find(place).expect("the slip")];
        let (line, column) = (before.matches('\n').count() + 1, before.len() - before.rfind('\n').unwrap_or(0));
        let message = error(&text);
        assert!(message.contains(said), "{new}: {message}");
        assert!(message.contains(&format!("did you mean {meant}?")), "{new}: {message}");
        assert!(message.contains(&format!("bad.urdf:{line}:{column}\n")), "{new}: {message}");
    }
}

/// What real files have beside what the import reads: known things in silence, others with a note.
#[test]
fn what_is_not_known_is_noted() {
    let remarks = |text: &str| {
        let imported = Urdf::read("a.urdf", text).and_then(|urdf| urdf.import(&Options::default()));
        imported.unwrap_or_else(|report| panic!("{report}")).account.sentences()
    };
    let axis = |text: String| text.replace("<limit ", "<axis xyz=\"0 0 1\"/><limit ");
    let known = axis(with(
        "<robot name=\"r\">",
        "<robot name=\"r\" version=\"1.0\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\" xmlns=\"x\">\
         <gazebo><self_collide/></gazebo><transmission><joint><hardwareInterface/></joint></transmission><material/>",
    ))
    .replace("<inertial>", "<visual><origin xzy=\"\"/><geometry/></visual><collision/><inertial>")
    .replace("</joint>\n</robot>", "<safety_controller kvelocity=\"1\"/><calibration/></joint>\n</robot>");
    assert_eq!(remarks(&known), Vec::<String>::new());
    let other = known
        .replace("<link name=\"b\">", "<link name=\"b\" type=\"x\"><verbose value=\"1\"/>")
        .replace("<limit ", "<drake:effort_limit/><limit acceleration=\"2\" ")
        .replace("</robot>", "<orbit/></robot>");
    let ignored = "the import ignores these parts, which it does not know: attribute `type` of `link`, element \
                   `verbose` in `link`, element `drake:effort_limit` in `joint`, attribute `acceleration` of `limit`, \
                   element `orbit` in `robot`";
    assert_eq!(remarks(&other), [ignored]);
    // the link that stands still is no part of the arm
    let still = known.replace("<link name=\"a\"/>", "<link name=\"a\" type=\"x\"><verbose/></link>");
    assert_eq!(remarks(&still), Vec::<String>::new());

    let no_axis = remarks(&with("type=\"revolute\"", "type=\"prismatic\""));
    assert_eq!(no_axis, ["the joint j has no element `axis`, so its axis is 1 0 0"]);
    let crossed = remarks(&axis(with("effort=", "lower=\"2\" upper=\"-1\" effort=")));
    assert_eq!(crossed, ["the joint j has a lower limit, 2, above its upper limit, -1; rne ignores both limits"]);
    let negative = remarks(&axis(with("effort=\"1\"", "effort=\"-1\"")));
    assert_eq!(negative, ["the joint j has a negative limit of effort, -1; rne ignores it"]);
}

/// As many names as a text has room for take no time and no room of their own.
#[test]
fn unknown_names_are_bounded() {
    let mut names = String::new();
    for i in 0..300_000 {
        let _ = write!(names, " qq{i}=\"\"");
    }
    let message = error(&with("<link name=\"a\"", &format!("<link{names} name=\"a\"")));
    assert!(message.contains("more than 1000 names of elements and attributes that no URDF has"), "{message}");
}

#[test]
fn circles_are_found() {
    let mut text = with("</robot>", "");
    text += "<link name=\"c\"/><link name=\"d\"/>\
             <joint name=\"k\" type=\"fixed\"><parent link=\"c\"/><child link=\"d\"/></joint>\
             <joint name=\"l\" type=\"fixed\"><parent link=\"d\"/><child link=\"c\"/></joint></robot>";
    let message = error(&text);
    assert!(message.contains("the link `c` is part of a circle of joints"), "{message}");
    let circle = with("<link name=\"a\"/>", "").replace("link=\"a\"", "link=\"b\"");
    assert!(error(&circle).contains("no link is the root"), "{}", error(&circle));
    let twice =
        with("</robot>", "<joint name=\"k\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint></robot>");
    assert!(error(&twice).contains("the link `b` is moved by two joints, `j` and `k`"), "{}", error(&twice));
}

#[test]
fn depth_length_and_number_are_bounded() {
    let deep = format!("<robot>{}", "<a>".repeat(1_000_000));
    assert!(error(&deep).contains("elements are nested more than 64 levels deep"), "{}", error(&deep));
    let long = format!("<robot>{}</robot>", " ".repeat(17 << 20));
    assert!(error(&long).contains("rne reads at most 16777216"), "{}", error(&long));
    let mut many = String::from("<robot>");
    for i in 0..20_001 {
        let _ = write!(many, "<link name=\"l{i}\"/>");
    }
    assert!(error(&many).contains("more than 20000 elements `link`"), "{}", error(&many));
    // A chain of that many fixed joints is walked without recursion.
    let mut chain = String::from("<robot><link name=\"l0\"/>");
    for i in 1..3_000 {
        let kind = if i == 1 { "continuous" } else { "fixed" };
        let _ = write!(
            chain,
            "<link name=\"l{i}\"/><joint name=\"j{i}\" type=\"{kind}\">\
             <parent link=\"l{}\"/><child link=\"l{i}\"/></joint>",
            i - 1
        );
    }
    let urdf = Urdf::read("long.urdf", &(chain.clone() + "</robot>")).unwrap();
    assert_eq!(urdf.import(&Options::default()).unwrap().robot.dof(), 1);
    let movable = chain.replace("fixed", "continuous") + "</robot>";
    assert!(error(&movable).contains("2999 movable joints; a robot file has at most 64"));
}

/// Meshes and plugins that nobody here needs may be of any kind; names may hold anything.
#[test]
fn what_does_not_matter_is_passed_over_and_names_stay_words() {
    let mut text = with(
        "<link name=\"a\"/>",
        "<link name=\"a\"><visual><geometry><torus r=\"x\"/></geometry></visual></link>\
         <gazebo><joint name=\"j\"/></gazebo>",
    );
    text = text.replace("name=\"r\"", "name=\"R 2-D2 &amp; co\"");
    let named = text.replace("name=\"j\"", "name=\"j: &quot;#&lt;{}&#10; - x\"");
    let imported = Urdf::read("a.urdf", &named).unwrap().import(&Options::default()).unwrap();
    assert_eq!(imported.robot.name, "r_2_d2_co");
    assert_eq!(imported.robot.joints[0].name, "j: \"#<{}  - x");
    assert_eq!(rne_model::Reader::new("x").read(&imported.text).unwrap().robot, imported.robot);
    let control = text.replace("name=\"j\"", "name=\"j\u{1b}[31m\"");
    if let Err(report) = Urdf::read("a.urdf", &control).and_then(|urdf| urdf.import(&Options::default()).map(|_| ())) {
        assert!(report.to_string().starts_with("error: "), "{report}");
    }
}
