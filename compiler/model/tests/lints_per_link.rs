//! Lints of single links and joints: what they say, where, and that they leave real robots alone.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::common::{found, the_one, with};
use rne_model::{Convention, Diagnostic, JointKind, Reader, Report, Robot, Severity};

/// One link, whose `com` lies on the far side of its frame: it was measured from the joint.
const ONE_LINK: &str = "format: 1
name: onelink
source: SymPyBotics 25
convention: standard
gravity: [0, -9.81, 0]
parameters: {m: 2.0, a: 0.5}
joints:
  - {type: revolute, dh: {theta: 0, d: 0, a: a, alpha: 0}, link: {mass: m, com: [a/2, 0, 0], inertia: {zz: 1}}}
";

/// The beginnings of the messages of these lints.
const TOLD: [&str; 7] = [
    "the centre of mass of link",
    "the inertia of link",
    "link ",
    "the gear ratio",
    "the velocity",
    "the effort",
    "joints ",
];

fn told(report: &Report) -> Vec<&Diagnostic> {
    let is_told = |one: &&Diagnostic| {
        TOLD.iter().any(|start| one.message.starts_with(start)) && one.label.as_deref() != Some("the mass is missing")
    };
    report.diagnostics.iter().filter(is_told).collect()
}

/// The only lint of these in the text, with its severity and place.
fn only(text: &str) -> (Severity, (usize, usize), String, String, String) {
    let report = found(text);
    let all = told(&report);
    let [one] = &all[..] else { panic!("{report}") };
    let [label, help] = [&one.label, &one.help].map(|text| text.clone().unwrap_or_default());
    (one.severity, (one.line, one.column), one.message.clone(), label, help)
}

#[test]
fn a_centre_of_mass_beyond_the_end_is_told() {
    let (severity, place, message, label, help) = only(ONE_LINK);
    assert_eq!((severity, place, label.as_str()), (Severity::Warning, (8, 81), "beyond the end"));
    let expected =
        "the centre of mass of link 1 lies 0.25 m beyond the far end of the link, which is 0.5 m long".to_owned();
    assert_eq!(message, expected);
    assert_eq!(
        help,
        "in a `standard` table, `com` is measured from the far end of the link; if its sign is wrong, or if you \
         measured from the near end, write `com: [-0.25, 0, 0]`; if the centre of mass is really there, ignore this"
    );
    let off = with_com("[0.2, 0.1, 0]");
    assert!(only(&off).4.contains(
        "if its sign is wrong, write `com: [-0.2, 0.1, 0]`; if you measured from the near end, write \
         `com: [-0.3, 0.1, 0]`"
    ));
    // as a first moment
    let (.., message, _, _) = only(&ONE_LINK.replace("com: [a/2, 0, 0]", "first_moment: [m*a/2, 0, 0]"));
    assert_eq!(message, expected);
    // inside, a little beyond the end, a counterweight beyond the joint, far out, and a body beside the link
    for com in ["[-a/2, 0, 0]", "[0.12, 0, 0]", "[-0.8, 0, 0]", "[0.6, 0, 0]", "[0.2, 0.35, 0]", "[0, 0, 0.3]"] {
        assert!(told(&found(&with_com(com))).is_empty(), "{com}");
    }
    // mass of other links
    assert!(told(&found(&ONE_LINK.replace("com:", "physical: false, com:"))).is_empty());
}

fn with_com(com: &str) -> String {
    ONE_LINK.replace("[a/2, 0, 0]", com)
}

/// In a modified table the end where `com` is zero is the near one, and the far end is in the next row.
#[test]
fn a_modified_table_measures_from_the_near_end() {
    let row = |a: &str, com: &str| {
        format!(
            "  - {{type: revolute, dh: {{theta: 0, d: 0, a: {a}, alpha: 0}}, link: \
             {{mass: 1, com: {com}, inertia: {{zz: 1}}}}}}\n"
        )
    };
    let head = "format: 1\nname: x\nsource: own\nconvention: modified\ngravity: [0, -9.81, 0]\njoints:\n";
    let text = |com: &str| format!("{head}{}{}", row("0", com), row("0.4", "[-0.2, 0, 0]"));
    let (severity, place, message, _, help) = only(&text("[-0.16, 0, 0]"));
    assert_eq!((severity, place), (Severity::Warning, (7, 81)));
    assert_eq!(
        message,
        "the centre of mass of link 1 lies 0.16 m beyond the near end of the link, which is 0.4 m long"
    );
    assert!(
        help.contains(
            "if its sign is wrong, write `com: [0.16, 0, 0]`; if you measured from the far end, write \
         `com: [0.24, 0, 0]`"
        ),
        "{help}"
    );
    assert!(told(&found(&text("[0.6, 0, 0]"))).is_empty());
}

#[test]
fn an_inertia_about_the_origin_is_noted() {
    // a rod of 0.6 m and 2 kg: m a²/3 about its end, m a²/12 about its middle
    let text = |inertia: &str| with_com("[-0.3, 0, 0]").replace("a: 0.5", "a: 0.6").replace("{zz: 1}", inertia);
    let (severity, place, message, label, help) = only(&text("{xx: 0.001, yy: 0.24, zz: 0.24}"));
    assert_eq!((severity, place, label.as_str()), (Severity::Note, (8, 104), "about the origin?"));
    assert_eq!(
        message,
        "the inertia of link 1 has a radius of gyration of 0.34641 m; if it is about the origin of the link frame, \
         this radius is 0.173205 m"
    );
    assert!(help.ends_with("write `inertia_about: origin`"), "{help}");
    for right in ["{xx: 0.001, yy: 0.06, zz: 0.06}", "{xx: 0.001, yy: 0.24, zz: 0.24}, inertia_about: origin"] {
        assert!(told(&found(&text(right))).is_empty(), "{right}");
    }
}

#[test]
fn values_of_one_joint_are_told() {
    for (old, new, severity, place, message, help) in [
        (
            "mass: 2.5",
            "mass: 0",
            Severity::Note,
            (14, 12),
            "link 1 has the mass 0, so its centre of mass has no effect",
            "write the `mass` of the link in kg; if the link is without mass, delete `com`",
        ),
        (
            "gear_ratio: -62.6",
            "gear_ratio: -0.016",
            Severity::Warning,
            (18, 42),
            "the gear ratio `-0.016` is below 1: the motor turns slower than the joint",
            "`gear_ratio` is motor turns per joint turn, or rad/m for a prismatic joint; if this is joint turns per \
             motor turn, write `gear_ratio: -62.5`",
        ),
        (
            "velocity: 2.0",
            "velocity: 180",
            Severity::Warning,
            (17, 45),
            "the velocity limit `180` rad/s is over 30 rad/s",
            "if this is in degrees per second, write `deg(180)`",
        ),
        (
            "velocity: 2.0",
            "velocity: 0",
            Severity::Note,
            (17, 45),
            "the velocity limit is 0",
            "write the limit of the joint; if it is unknown, delete `velocity`",
        ),
        (
            "effort: 50",
            "effort: 0",
            Severity::Note,
            (17, 58),
            "the effort limit is 0",
            "write the limit of the joint; if it is unknown, delete `effort`",
        ),
    ] {
        let one = the_one(old, new);
        assert_eq!((one.severity, (one.line, one.column)), (severity, place), "{new}");
        assert_eq!((one.message.as_str(), one.help.as_deref()), (message, Some(help)));
    }
    for (old, new) in [
        ("inertia: 2.0e-4, gear_ratio: -62.6", "gear_ratio: -0.016"),
        ("gear_ratio: -62.6", "gear_ratio: 1"),
        ("velocity: 2.0", "velocity: deg(1445)"),
        ("velocity: 2.0", "velocity: 1000"),
    ] {
        assert!(told(&found(&with(old, new))).is_empty(), "{new}");
    }
}

/// Two joints on one line are no arm, but the first rows of a modified table read as standard are.
#[test]
fn a_table_of_the_other_convention_is_noted() {
    let arm = |convention: &str, rows: [(&str, &str); 3]| {
        let mut text =
            format!("format: 1\nname: x\nsource: own\nconvention: {convention}\ngravity: [0, 0, -9.81]\njoints:\n");
        for (a, alpha) in rows {
            let _ = writeln!(
                text,
                "  - {{type: revolute, dh: {{theta: 0, d: 0, a: {a}, alpha: {alpha}}}, link: \
                 {{mass: 1, inertia: {{xx: 1, yy: 1, zz: 1.1}}}}}}"
            );
        }
        text
    };
    let modified = [("0", "0"), ("0", "pi/2"), ("0.4", "0")];
    let (severity, place, message, label, help) = only(&arm("standard", modified));
    assert_eq!((severity, place, label.as_str()), (Severity::Note, (4, 13), "a `modified` table?"));
    assert_eq!(
        message,
        "joints 1 and 2 turn about the same line, because the first row of this `standard` table has a = 0 and alpha \
         = 0"
    );
    assert!(help.ends_with("if the source has rows of the other kind, write `convention: modified`"), "{help}");
    let standard = [("0", "pi/2"), ("0.4", "0"), ("0", "0")];
    let (severity, _, message, label, _) = only(&arm("modified", standard));
    assert_eq!((severity, label.as_str()), (Severity::Note, "a `standard` table?"));
    assert!(message.starts_with("joints 2 and 3 turn about the same line, because the last row of this"), "{message}");
    for (convention, rows) in
        [("standard", standard), ("modified", modified), ("standard", [("0", "0"), ("0.4", "0"), ("0", "0")])]
    {
        assert!(told(&found(&arm(convention, rows))).is_empty(), "{convention} {rows:?}");
    }
}

/// The files of robots below the root of the repository.
fn shipped(folders: &[&str]) -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let files = folders.iter().filter_map(|folder| root.join(folder).read_dir().ok()).flatten();
    let mut paths: Vec<PathBuf> = files.map(|file| file.expect("a file").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|it| it == "yaml") && !path.to_string_lossy().contains(".plan."));
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), std::fs::read_to_string(path).expect("a text"))).collect()
}

#[test]
fn shipped_robots_are_left_alone() {
    for (path, text) in shipped(&["robots", "robots/trees", "docs"]) {
        let read = Reader::new("x").trees().couplings().loops().read(&text);
        let lints = read.unwrap_or_else(|report| panic!("{}: {report}", path.display())).lints;
        assert!(told(&lints).is_empty(), "{}: {lints}", path.display());
    }
}

/// A robot as a file with the rows and links only, with another centre of mass of one link.
fn altered(robot: &Robot, link: usize, com: [f64; 3]) -> String {
    let mut text = format!(
        "format: 1\nname: x\nsource: own\nconvention: {}\ngravity: [0, 0, -9.81]\njoints:\n",
        robot.convention.name()
    );
    for (index, row) in robot.rows().enumerate() {
        let (kind, dh, own) = (row.kind.name(), &row.dh, &row.link);
        let i = own.inertia;
        let com = if index == link { com } else { own.com };
        let _ = writeln!(
            text,
            "  - {{type: {kind}, dh: {{theta: {:?}, d: {:?}, a: {:?}, alpha: {:?}}}, link: {{mass: {:?}, com: {com:?}, \
             inertia: {{xx: {:?}, yy: {:?}, zz: {:?}, xy: {:?}, xz: {:?}, yz: {:?}}}}}}}",
            dh.theta.radians, dh.d, dh.a, dh.alpha.radians, own.mass, i.xx, i.yy, i.zz, i.xy, i.xz, i.yz
        );
    }
    text
}

/// The vector from the near end to the far end of a link, by the rows alone.
fn along(robot: &Robot, link: usize) -> Option<[f64; 3]> {
    let rows: Vec<_> = robot.rows().collect();
    let (row, sign) = match robot.convention {
        Convention::Standard => (rows[link], 1.0),
        Convention::Modified => (*rows.get(link + 1)?, -1.0),
    };
    let (dh, length) = (row.dh, row.dh.a.hypot(row.dh.d));
    let is_fixed = row.kind == JointKind::Revolute && length > 0.0 && rows[link].link.mass > 0.0;
    is_fixed.then_some([dh.a, sign * dh.d * dh.alpha.sin, dh.d * dh.alpha.cos])
}

/// Gives each link of the shipped arms a centre of mass with one sign wrong, and one that is measured from the other
/// end. Where it is more than a quarter of the length beyond the end, most are told; the others are at short links, and
/// at ends that no axis determines.
#[test]
#[allow(clippy::cast_precision_loss)] // few joints
fn wrong_centres_of_shipped_arms_are_told() {
    let (mut beyond, mut seen, mut long) = (0, 0, [0, 0]);
    for (_, text) in shipped(&["robots"]) {
        let robot = Robot::from_yaml(&text).expect("a robot");
        let length = |index: usize| robot.joints[index].row.dh.a.hypot(robot.joints[index].row.dh.d);
        let mean = (0..robot.joints.len()).map(length).sum::<f64>() / robot.joints.len() as f64;
        for link in 0..robot.joints.len() {
            let (Some(p), com) = (along(&robot, link), robot.joints[link].row.link.com) else { continue };
            let size = p.iter().map(|x| x * x).sum::<f64>();
            let sign = if robot.convention == Convention::Standard { 1.0 } else { -1.0 };
            let part = |com: [f64; 3]| sign * (0..3).map(|i| com[i] * p[i]).sum::<f64>() / size;
            let flipped = (0..3).filter(|axis| com[*axis] != 0.0).map(|axis| {
                let mut wrong = com;
                wrong[axis] = -wrong[axis];
                wrong
            });
            let moved = [0, 1, 2].map(|i| com[i] + sign * p[i]);
            for wrong in flipped.chain([moved]).filter(|wrong| part(*wrong) > 0.25 && part(com) <= 0.25) {
                let report = found(&altered(&robot, link, wrong));
                let is_told = told(&report).iter().any(|one| one.label.as_deref() == Some("beyond the end"));
                let is_long = size.sqrt() >= 0.4 * mean;
                beyond += 1;
                seen += usize::from(is_told);
                long[0] += usize::from(is_long);
                long[1] += usize::from(is_long && is_told);
            }
        }
    }
    println!("{seen} of {beyond} are told, of long links {} of {}", long[1], long[0]);
    assert!(100 * seen >= 80 * beyond, "{seen} of {beyond}");
}
