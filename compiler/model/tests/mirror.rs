//! Links of the two sides that differ: the robots in the box have none, and an altered one is named at its line.

use rne_model::{Reader, Report};

const HYQ: &str = include_str!("../../../robots/trees/hyq.yaml");
const BAXTER: &str = include_str!("../../../robots/trees/baxter.yaml");

fn lints(text: &str) -> Report {
    let read = Reader::new("robot.yaml").trees().couplings().read(text);
    read.unwrap_or_else(|report| panic!("{report}")).lints
}

/// The message of the lint, with its line.
fn told(text: &str) -> Option<(usize, String)> {
    let report = lints(text);
    let of_sides = report.diagnostics.iter().filter(|lint| lint.message.contains("mirror images"));
    let all: Vec<_> = of_sides.map(|lint| (lint.line, lint.message.clone())).collect();
    assert!(all.len() <= 1, "{report}");
    all.into_iter().next()
}

/// The text with the `nth` line that begins so, after blanks, changed.
fn with(text: &str, nth: usize, old: &str, new: &str) -> (usize, String) {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let found = lines.iter().enumerate().filter(|(_, line)| line.trim_start().starts_with(old));
    let at = found.map(|(at, _)| at).nth(nth).unwrap_or_else(|| panic!("{old}"));
    let blanks = lines[at].len() - lines[at].trim_start().len();
    lines[at] = format!("{}{new}", " ".repeat(blanks));
    (at + 1, lines.join("\n"))
}

#[test]
fn sides_of_shipped_trees_are_alike() {
    for (name, text) in [
        ("hyq", HYQ),
        ("baxter", BAXTER),
        ("mini_cheetah", include_str!("../../../robots/trees/mini_cheetah.yaml")),
        ("dex3_left", include_str!("../../../robots/trees/dex3_left.yaml")),
        ("panda_hand", include_str!("../../../robots/trees/panda_hand.yaml")),
        ("wam7_coupled", include_str!("../../../robots/trees/wam7_coupled.yaml")),
        ("tree", include_str!("../../../docs/tree.yaml")),
        ("dual_arm", include_str!("../../../docs/dual_arm.yaml")),
    ] {
        assert_eq!(told(text), None, "{name}");
    }
}

#[test]
fn a_leg_without_inertia_is_named() {
    // rows are lf, lh, rf, rh: the tensor of the sixth link is that of lh_kfe, its twin is rh_kfe
    let (_, text) = with(HYQ, 5, "inertia:", "inertia: {xx: 0, yy: 0, zz: 0}");
    let (twin, _) = with(HYQ, 11, "inertia:", "");
    let (line, message) = told(&text).expect("the legs differ");
    assert_eq!(line, twin);
    for part in ["`lh_kfe_joint` and `rh_kfe_joint` are mirror images", "principal moments of inertia are (0, 0, 0)"] {
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn a_heavier_arm_is_named_with_all_pairs() {
    let (line, text) = with(BAXTER, 10, "mass:", "mass: 99");
    let (told_line, message) = told(&text).expect("the arms differ");
    assert!(message.contains("but their masses are") && message.contains("99"), "{message}");
    assert!(message.contains("left_") && message.contains("right_"), "{message}");
    // the twin stands below: its line is shown, whichever of the two was altered
    assert!(told_line >= line, "{told_line} {line}");
    let all = HYQ.replace("mass: 2.638", "mass: 2").replacen("mass: 2", "mass: 3", 2);
    let (_, message) = told(&all).expect("two pairs differ");
    assert!(message.contains("; so do the links of `l"), "{message}");
}

/// CAD programs do not give both sides the same digits, and a tensor in other axes is the same body.
#[test]
fn rounding_and_other_axes_are_no_difference() {
    let file = |right: &str| {
        let head = "format: 2\nname: torso\nsource: own\nconvention: modified\ngravity: [0, 0, -9.81]\n";
        let joint = |name: &str, a: &str, link: &str| {
            format!(
                "  - {{name: {name}, parent: base, type: revolute, dh: {{theta: 0, d: 0, a: {a}, alpha: 0}}, link: \
                 {{{link}}}}}\n"
            )
        };
        let left = joint("arm_l", "1", "mass: 2, com: [0.1, 0, 0], inertia: {xx: 0.1, yy: 0.2, zz: 0.25}");
        format!("{head}tool: {{on: arm_l}}\njoints:\n{left}{}", joint("arm_r", "-1", right))
    };
    assert_eq!(told(&file("mass: 2.004, com: [-0.1, 0, 0], inertia: {xx: 0.2004, yy: 0.1, zz: 0.25}")), None);
    // turned by 45° about z: xx = yy = (0.1 + 0.2)/2, xy = ±(0.2 - 0.1)/2
    assert_eq!(told(&file("mass: 2, inertia: {xx: 0.15, yy: 0.15, zz: 0.25, xy: 0.05}")), None);
    assert!(told(&file("mass: 2, inertia: {xx: 0.15, yy: 0.15, zz: 0.25, xy: 0.03}")).is_some());
    assert!(told(&file("mass: 2.1, inertia: {xx: 0.1, yy: 0.2, zz: 0.25}")).is_some());
}
