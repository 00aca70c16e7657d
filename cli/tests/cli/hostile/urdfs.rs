//! Texts in the place of a URDF.

use std::path::Path;

use super::robot_files::{ARM, lines};
use super::{Case, as_said, written};

/// A valid URDF, of which passages are replaced.
const TWO_LINKS: &str = "<?xml version=\"1.0\"?>
<robot name=\"arm\">
  <link name=\"a\"/>
  <link name=\"b\"><inertial><origin xyz=\"0 0 0.5\"/><mass value=\"2\"/>
    <inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link>
  <joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/><origin xyz=\"0 0 0.7\"/>
    <axis xyz=\"0 1 0\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint>
</robot>
";

fn with(old: &str, new: &str) -> String {
    assert_eq!(TWO_LINKS.matches(old).count(), 1, "`{old}` must occur once");
    TWO_LINKS.replace(old, new)
}

/// A chain of links, after the two.
fn chain(links: usize, kind: &str) -> String {
    let link = |i: usize| {
        let parent = if i == 0 { "b".to_owned() } else { format!("l{}", i - 1) };
        format!(
            "<link name=\"l{i}\"/><joint name=\"k{i}\" type=\"{kind}\"><parent link=\"{parent}\"/><child \
             link=\"l{i}\"/></joint>"
        )
    };
    with("</robot>", &(lines(links, link) + "</robot>"))
}

pub(super) fn cases(folder: &Path) -> Vec<Case> {
    let bytes: Vec<(&str, Vec<u8>, &'static str)> = vec![
        ("zeros", vec![0; 1 << 20], "x.urdf"),
        ("ones", vec![0xFF; 1 << 20], "byte 0 is not UTF-8"),
        ("UTF-16", TWO_LINKS.encode_utf16().flat_map(u16::to_le_bytes).collect(), "x.urdf"),
        ("Latin-1", with("\"arm\"", "\"gr").into_bytes().into_iter().chain(*b"\xFC\"").collect(), "is not UTF-8"),
        ("a mesh", b"solid x\0\0\0\0\0\0\0\0".into(), "x.urdf"),
        ("17 MiB", [TWO_LINKS.as_bytes(), &vec![b' '; 17 << 20]].concat(), "at most 16777216 are read"),
    ];
    let texts = texts().into_iter().map(|(what, text, words)| (what, text.into_bytes(), words));
    let case = |(index, (what, bytes, words)): (usize, (&str, Vec<u8>, &'static str))| {
        let path = written(folder, index, "x.urdf", bytes);
        Case::new(format!("URDF: {what}"), &["import", &path], as_said(words)).naming("x.urdf")
    };
    bytes.into_iter().chain(texts).enumerate().map(case).collect()
}

#[allow(clippy::too_many_lines)] // a table
fn texts() -> Vec<(&'static str, String, &'static str)> {
    let mesh = |path: &str| {
        let visual =
            format!("<link name=\"a\"><visual><geometry><mesh filename=\"{path}\"/></geometry></visual></link>");
        with("<link name=\"a\"/>", &visual)
    };
    let entities =
        |first: &str, body: &str| format!("<!DOCTYPE robot [<!ENTITY e0 \"{first}\">{body}]><robot name=\"&e9;\"/>");
    let laughs = lines(9, |i| format!("<!ENTITY e{} \"{}\">", i + 1, format!("&e{i};").repeat(10)));
    vec![
        ("two links", TWO_LINKS.into(), ""),
        ("empty", String::new(), "x.urdf"),
        ("a byte order mark", format!("\u{FEFF}{TWO_LINKS}"), ""),
        ("lines of DOS", TWO_LINKS.replace('\n', "\r\n"), ""),
        ("a robot file", ARM.into(), "x.urdf:1"),
        ("a web page", "<!DOCTYPE html><html><body><p>404</body></html>".into(), "x.urdf:1"),
        ("SDF", "<sdf version=\"1.9\"><model name=\"m\"/></sdf>".into(), "SDF is another format"),
        ("Latin-1 by its word", with("version=\"1.0\"", "version=\"1.0\" encoding=\"ISO-8859-1\""), ""),
        ("nothing in it", "<robot name=\"r\"/>".into(), "x.urdf:1"),
        ("two robots", format!("{TWO_LINKS}<robot/>"), "a second element"),
        ("words behind it", format!("{TWO_LINKS}words"), "text after the element `robot`"),
        // entities
        ("billions of laughs", entities("ha", &laughs), "a document type"),
        ("a file from elsewhere", entities("x", "<!ENTITY e9 SYSTEM \"file:///etc/passwd\">"), "a document type"),
        (
            "a document type from elsewhere",
            "<!DOCTYPE r SYSTEM \"http://localhost/x.dtd\"><robot/>".into(),
            "a document type",
        ),
        ("an open document type", "<!DOCTYPE r [".into(), "x.urdf:1"),
        ("an unknown entity", with("\"arm\"", "\"&lol;\""), "x.urdf:2"),
        ("an escape by its number", with("name=\"j\"", "name=\"&#x1b;[2J\""), "no control characters"),
        ("beyond Unicode", with("name=\"j\"", "name=\"&#x110000;\""), "x.urdf:6"),
        ("zero by its number", with("name=\"j\"", "name=\"&#0;\""), "x.urdf:6"),
        ("a stylesheet", with("<robot", "<?xml-stylesheet href=\"http://localhost\"?><robot"), ""),
        // depth and length
        (
            "a million deep",
            format!("<robot>{}", "<a>".repeat(1_000_000)),
            "elements are nested more than 64 levels deep",
        ),
        ("a million ends", format!("<robot>{}", "</a>".repeat(1_000_000)), "x.urdf:1"),
        ("open tags", "<".repeat(1 << 20), "x.urdf:1"),
        ("an open comment", with("<link name=\"a\"/>", "<!-- "), "x.urdf"),
        (
            "a comment of 4 MB",
            with("<link name=\"a\"/>", &format!("<!--{}--><link name=\"a\"/>", "x".repeat(4 << 20))),
            "",
        ),
        ("an open attribute", with("name=\"j\"", "name=\"j"), "x.urdf:"),
        (
            "100,000 attributes",
            with("name=\"j\"", &format!("name=\"j\"{}", lines(100_000, |i| format!(" a{i}=\"1\"")))),
            "more than 1000 names",
        ),
        ("an attribute twice", with("name=\"j\"", "name=\"j\" name=\"k\""), "occurs twice"),
        (
            "an attribute of 4 MB",
            with("name=\"j\"", &format!("name=\"{}\"", "j".repeat(4 << 20))),
            "more than 1048576 bytes",
        ),
        ("an element of 4 MB", with("<axis", &format!("<{}/><axis", "a".repeat(4 << 20))), ""),
        ("1,000,000 elements", with("<axis", &format!("{}<axis", "<a/>".repeat(1_000_000))), ""),
        (
            "20,001 links",
            with("</robot>", &(lines(20_001, |i| format!("<link name=\"l{i}\"/>")) + "</robot>")),
            "20000",
        ),
        ("10,000 links of one body", chain(10_000, "fixed"), ""),
        ("10,000 links that move", chain(10_000, "continuous"), "10001 movable joints"),
        // what is connected to what
        ("two roots", with("<link name=\"a\"/>", "<link name=\"a\"/><link name=\"c\"/>"), "x.urdf:3"),
        ("a circle", with("parent link=\"a\"", "parent link=\"b\""), "x.urdf:"),
        ("a link that is nowhere", with("child link=\"b\"", "child link=\"../b\""), "refers to the link"),
        ("a link twice", with("name=\"a\"", "name=\"b\""), "x.urdf:4"),
        ("no type", with(" type=\"revolute\"", ""), "lacks the attribute `type`"),
        ("a type with an escape", with("revolute", "rev\u{202E}olute\u{9B}2J"), "it must be revolute"),
        ("a floating arm", with("revolute", "floating"), "x.urdf:6"),
        ("a planar arm", with("revolute", "planar"), "x.urdf:6"),
        // numbers
        ("a mass that is none", with("value=\"2\"", "value=\"nan\""), "must be one number"),
        ("an endless mass", with("value=\"2\"", "value=\"1e999\""), "must be one number"),
        ("a mass beyond float", with("value=\"2\"", "value=\"1e308\""), "x.urdf"),
        ("a mass of almost nothing", with("value=\"2\"", "value=\"5e-324\""), "x.urdf"),
        ("a mass below nothing", with("value=\"2\"", "value=\"-2\""), "the mass of the link `b` is -2 kg"),
        ("a long mass", with("value=\"2\"", &format!("value=\"{}\"", "1".repeat(1 << 20))), "x.urdf:4"),
        ("an endless place", with("0 0 0.7", "0 0 inf"), "must be three numbers"),
        ("a place beyond float", with("0 0 0.7", "1e308 1e308 1e308"), "x.urdf"),
        ("a place of many", with("0 0 0.7", &"0 ".repeat(100_000)), "must be three numbers"),
        ("no axis", with("0 1 0", "0 0 0"), "x.urdf:"),
        ("an axis of almost nothing", with("0 1 0", "0 5e-324 0"), "x.urdf:"),
        ("an axis beyond float", with("0 1 0", "1e308 1e308 1e308"), "x.urdf"),
        ("limits that cross", with("lower=\"-1\"", "lower=\"1e308\""), ""),
        ("full-width digits", with("value=\"2\"", "value=\"\u{FF12}\""), "must be one number"),
        // names and files
        ("a path for a name", with("\"arm\"", "\"../../etc/passwd\""), ""),
        ("an option for a name", with("\"arm\"", "\"-rf\""), ""),
        ("no name", with("\"arm\"", "\"\""), "it must not be empty"),
        ("a name that turns", with("\"arm\"", "\"\u{202E}mra\u{9B}2J\""), ""),
        ("a joint that turns", with("name=\"j\"", "name=\"\u{202E}j\u{9B}2J\u{2028}\""), ""),
        ("a mesh from above", mesh("../../../../etc/passwd"), ""),
        ("a mesh from a device", mesh("file:///dev/zero"), ""),
        ("a mesh from elsewhere", mesh("http://localhost/mesh.stl"), ""),
        ("an xacro", with("<link name=\"a\"/>", "<xacro:include filename=\"/etc/passwd\"/>"), "not expanded yet"),
    ]
}
