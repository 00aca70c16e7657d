//! Every lint: where it points, what it says, and what it leaves alone.

mod common;

use common::{BASE, found, the_one, with};
use rne_model::{Severity, check};

#[test]
fn lints() {
    for (old, new, line, column, message, help) in [
        (
            "alpha: pi/2",
            "alpha: 1.5708",
            11,
            41,
            "the angle `1.5708` is 3.67321e-6 rad off the right angle `pi/2`",
            "write `pi/2`",
        ),
        ("alpha: pi/2", "alpha: -1.5707", 11, 41, "the right angle `-pi/2`", "write `-pi/2`"),
        ("alpha: pi/2", "alpha: 3.1416", 11, 41, "the right angle `pi`", "write `pi`"),
        ("alpha: pi/2", "alpha: 4.7124", 11, 41, "the right angle `3*pi/2`", "write `3*pi/2`"),
        ("alpha: pi/2", "alpha: 6.2832", 11, 41, "the right angle `2*pi`", "write `2*pi`"),
        ("alpha: pi/2", "alpha: 1e-4", 11, 41, "the right angle `0`", "write `0`"),
        ("alpha: pi/2", "alpha: 3.1416/2", 11, 41, "the angle `3.1416/2` = 1.5708 is", "write `pi/2`"),
        ("alpha: pi/2", "alpha: -90", 11, 41, "the angle `-90` rad is more than a full turn", "write `deg(-90)`"),
        ("alpha: pi/2", "alpha: 180/2", 11, 41, "the angle `180/2` = 90 rad", "write `deg(…)`"),
        ("rpy: [0, 0, pi]", "rpy: [0, 0, 180]", 6, 36, "more than a full turn", "`deg(180)`"),
        (
            "[0, 0, -9.81]",
            "[0, 0, -9810]",
            5,
            10,
            "gravity accelerates by 9810 m/s²; on Earth it is 9.81 m/s²",
            "an acceleration in m/s²",
        ),
        ("[0, 0, -9.81]", "[0, 0, -1]", 5, 10, "gravity accelerates by 1 m/s²", "such as `[0, 0, -9.81]`"),
        (
            "[0, 0, -9.81]",
            "[0, 0, 9.81]",
            5,
            10,
            "gravity `[0, 0, 9.81]` points along the positive z",
            "`[0, 0, -9.81]`",
        ),
        ("d: 0.4", "d: 400", 11, 23, "the length `400` m is over 20 m", "lengths are in metres"),
        ("a: 0, alpha: pi/2", "a: -21, alpha: pi/2", 11, 31, "the length `-21` m", "metres"),
        ("com: [0, 0, 0.3]", "com: [0, 0, 300]", 14, 19, "the length `300` m", "metres"),
        ("xyz: [0, 0, 1]", "xyz: [0, 0, 1000]", 6, 20, "the length `1000` m", "metres"),
        ("mass: 2.5", "mass: 2500", 13, 13, "the mass `2500` kg is over 2000 kg", "kilograms"),
        (
            "zz: 0.02",
            "zz: 0.23",
            15,
            16,
            "principal moments 0.1, 0.12 and 0.23 kg m² the largest exceeds",
            "check them",
        ),
        (
            "link: {mass: r, inertia: {",
            "link: {inertia: {xx: r/100, ",
            22,
            11,
            "the last link has no mass",
            "flange and tool",
        ),
        ("link: {mass: r, ", "link: {mass: r-r, ", 22, 18, "the last link has no mass", "flange and tool"),
        ("{m: 1.5, ", "{m: 1.5, unused: 1, ", 7, 22, "the parameter `unused` is never used", "delete it"),
        (
            "[-pi, pi]",
            "[-180, 180]",
            17,
            24,
            "the position limits `[-180, 180]` rad are more than four turns",
            "`[deg(-180), deg(180)]`",
        ),
    ] {
        let lint = the_one(old, new);
        assert_eq!(lint.severity, Severity::Warning, "{new}");
        assert_eq!((lint.line, lint.column), (line, column), "{new}: {}", lint.message);
        assert!(lint.message.contains(message), "{new}: {}", lint.message);
        assert!(lint.help.as_deref().unwrap_or_default().contains(help), "{new}: {:?}", lint.help);
        assert!(check("x.yaml", &with(old, new)).is_ok(), "{new}: a lint is no error");
    }
}

#[test]
fn what_is_no_lint() {
    for (old, new) in [
        // Exact right angles, and angles that are not near one.
        ("alpha: pi/2", "alpha: 2*pi"),
        ("alpha: pi/2", "alpha: -2*pi"),
        ("alpha: pi/2", "alpha: deg(90)"),
        ("alpha: pi/2", "alpha: 1.5707963267948966"),
        ("alpha: pi/2", "alpha: 1.57"),
        ("alpha: pi/2", "alpha: 0.001"),
        // A thin rod: the triangle inequality is an equality.
        ("{xx: 0.1, yy: 0.12, zz: 0.02}", "{yy: 0.12, zz: 0.12}"),
        ("{xx: 0.1, yy: 0.12, zz: 0.02}", "{}"),
        // A massless link that is not the last, with inertia.
        ("mass: 2.5", "mass: 0"),
        ("d: 0.4", "d: 20"),
        // Along any other axis a sign says nothing, and an arm may float.
        ("[0, 0, -9.81]", "[9.81, 0, 0]"),
        ("[0, 0, -9.81]", "[0, 6.9, 6.9]"),
        ("[0, 0, -9.81]", "[0, 0, 0]"),
        ("[0, 0, -9.81]", "[0, 0, -10]"),
        ("[-pi, pi]", "[-8*pi, 8*pi]"),
    ] {
        assert_eq!(found(&with(old, new)).to_string(), "", "{new}");
    }
    // Metres, not radians: the joint slides.
    let text = format!("{BASE}    limits: {{position: [-180, 180]}}\n");
    assert_eq!(found(&text).to_string(), "");
}

#[test]
fn a_value_behind_an_alias_is_reported_once() {
    let text = with("dh: {theta: 0, d: 0.4", "dh: &dh {theta: 0, d: 400")
        .replace("dh: {theta: 0, d: 0, a: 0, alpha: 0}", "dh: *dh");
    let report = found(&text);
    assert_eq!(report.diagnostics.len(), 1, "{report}");
    assert_eq!((report.diagnostics[0].line, report.diagnostics[0].column), (11, 27));
}

#[test]
fn errors_come_before_warnings() {
    let report = found(&with("d: 0.4", "d: 400").replace("alpha: 0}", "alpha: x}"));
    assert_eq!(
        report.short(),
        "robots/x.yaml:21:39: error: unknown name `x`\nrobots/x.yaml:11:23: warning: the length `400` m is over 20 m"
    );
    assert_eq!((report.errors().count(), report.warnings().count()), (1, 1));
}
