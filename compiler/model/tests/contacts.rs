//! The list `contacts`: what it means, and every mistake at its line and column.

use rne_model::{Contact, ContactKind, Reader, Robot};

const FLOATING: &str = "floating_base: {name: trunk, link: {mass: 1}}\n";

/// A robot of two legs on a trunk.
fn text(format: u32, base: &str, contacts: &str) -> String {
    let joint = "type: revolute, dh: {theta: 0, d: 0, a: 1, alpha: 0}, link: {mass: 1, com: [-0.5, 0, 0]}";
    format!(
        "format: {format}\nname: biped\nsource: a test\nconvention: standard\ngravity: [0, 0, -9.81]\n{base}\
         frames: [{{name: left, on: a, xyz: [0, 0, 0]}}, {{name: right, on: b, xyz: [0, 0, 0]}}, \
         {{name: other, on: b, xyz: [0, 0, 0]}}, {{name: imu, on: base, xyz: [0, 0, 0]}}]\n\
         tips: [left, right]\ncontacts: {contacts}\njoints:\n  - {{name: a, parent: base, {joint}}}\n  \
         - {{name: b, parent: base, {joint}}}\n"
    )
}

fn read(text: &str) -> Result<Robot, String> {
    Reader::new("biped.yaml").trees().read(text).map(|read| read.robot).map_err(|report| report.to_string())
}

#[test]
fn contacts_are_tips_in_their_own_order() {
    let robot = read(&text(2, FLOATING, "[{tip: right, kind: weld}, {tip: left, kind: point}]")).expect("valid");
    let [weld, point] = [(1, ContactKind::Weld), (0, ContactKind::Point)].map(|(tip, kind)| Contact { tip, kind });
    assert_eq!(robot.contacts, [weld, point]);
    assert_eq!([weld.rows(), point.rows()], [6, 3]);
    assert_eq!(read(&text(2, FLOATING, "[]")).expect("valid").contacts, []);
}

#[test]
fn mistakes_in_contacts_are_told_at_their_place() {
    for (contacts, place, said) in [
        ("left", "9:11", "found `left` where a list of contacts is needed"),
        (
            "[{tip: lefd, kind: point}]",
            "9:18",
            "`contacts` names `lefd`, which is no tip of this file; its tips are `left`, `right`",
        ),
        ("[{tip: left, kind: glued}]", "9:30", "unknown kind of contact"),
        ("[{tip: left, kind: point}, {tip: left, kind: weld}]", "9:44", "the tip `left` is in `contacts` twice"),
        ("[{tip: left}]", "9:12", "`kind`"),
        ("[{tip: left, kind: point, frame: a}]", "9:37", "unknown key `frame`"),
    ] {
        let report = read(&text(2, FLOATING, contacts)).expect_err(contacts);
        assert!(
            report.contains(&format!(" --> biped.yaml:{place}\n")) && report.contains(said),
            "{contacts}\n{report}"
        );
    }
    for (tip, help) in [
        ("other", "add the name of the frame to the list `tips`: `tips: [left, right, other]`"),
        ("imu", "a contact must be on a link that a joint moves"),
        ("knee_of_nobody", "add the frame to `frames`, and its name to the list `tips`: `tips: [left, right, knee_of"),
    ] {
        let report = read(&text(2, FLOATING, &format!("[{{tip: {tip}, kind: point}}]"))).unwrap_err();
        assert!(report.contains(&format!("= help: {help}")), "{report}");
    }
    for (key, said) in [
        ("first_moment: [0, 0, 0]", "only the link of a joint has this key"),
        (
            "mass: m",
            "only lengths (not `b` and `at`), gravity, the numbers under `motor`, and the mass, centre of mass and \
             inertia of a link",
        ),
    ] {
        let base = FLOATING.replace("mass: 1", &format!("mass: 1, {key}")).replace("mass: 1, mass", "mass");
        let text = format!("parameters: {{m: 1}}\n{}", text(2, &base, "[]"));
        let read = Reader::new("biped.yaml").trees().run_time(&["m"]).read(&text);
        let report = read.expect_err(key).to_string();
        assert!(report.contains(said), "{report}");
    }
    let report = read(&text(2, FLOATING, "[{tip: left, kind: glued}]")).unwrap_err();
    assert!(report.contains("`point` or `weld`"), "{report}");
    let report = read(&text(2, "", "[{tip: left, kind: point}]")).unwrap_err();
    assert!(report.contains("biped.yaml:8:11\n") && report.contains("`contacts` needs `floating_base`"), "{report}");
}
