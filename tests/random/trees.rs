//! Random trees: links that carry none, one or many joints, rows that begin at placements, links without mass, motors,
//! named frames, a tip on any link, floating bases, and contacts at their tips.

use std::fmt::Write;

use fastrand::Rng;

use crate::robots::{angle, angles, link, number, vector};

/// A robot file of format 2 with `dof` joints, the same for the same seed. The joints are `j0`, `j1` and so on, the
/// frames `on_base`, `on_link` and `other`; the last two may be tips.
pub(crate) fn yaml(seed: u64, dof: usize) -> String {
    let mut rng = Rng::with_seed(seed);
    let rng = &mut rng;
    let is_modified = rng.bool();
    // How often a number is zero and an angle right, a joint slides, and a row does not follow the row before: from
    // chains to stars.
    let [sparsity, prismatic, branching] =
        [[0.0, 0.3, 0.7, 0.9], [0.0, 0.2, 0.5, 0.8], [0.1, 0.4, 0.7, 1.0]].map(|parts| parts[rng.usize(0..4)]);
    let gravity = if rng.bool() { "[0, 0, -9.81]".to_owned() } else { vector(rng, 0.3, 9.0) };
    let placement = |rng: &mut Rng| format!("xyz: {}, rpy: {}", vector(rng, sparsity, 0.5), angles(rng, sparsity));

    let convention = if is_modified { "modified" } else { "standard" };
    let mut text = format!(
        "format: 2\nname: tree_{seed}\nsource: random numbers, seed {seed}\nconvention: {convention}\n\
         gravity: {gravity}\n"
    );
    let base = rng.bool().then(|| format!("base: {{{}}}\n", placement(rng)));
    // of numbers of its own, as the tips
    let mut floating = Rng::with_seed(seed ^ 0xf1);
    match link(&mut floating, sparsity).filter(|link| !link.contains("first_moment") && floating.f64() < 0.6) {
        Some(link) => drop(writeln!(text, "floating_base: {{name: trunk, link: {link}}}")),
        None => text.extend(base),
    }
    let _ = writeln!(text, "tool: {{on: j{}, {}}}", rng.usize(0..dof), placement(rng));
    let _ = writeln!(text, "frames:\n  - {{name: on_base, on: base, {}}}", placement(rng));
    let _ = writeln!(text, "  - {{name: on_link, on: j{}, {}}}", rng.usize(0..dof), placement(rng));
    // of numbers of their own, so that the rest is that of a tree without tips
    let mut own = Rng::with_seed(seed ^ 0x71);
    let _ = writeln!(text, "  - {{name: other, on: j{}, {}}}", own.usize(0..dof), placement(&mut own));
    if own.f64() < 0.8 {
        let tips = ["other", "on_link, other", "other, on_link"][own.usize(0..3)];
        let _ = writeln!(text, "tips: [{tips}]");
        if text.contains("floating_base") {
            let mut held = Rng::with_seed(seed ^ 0xc0);
            let mut contact =
                |tip: &str| format!("{{tip: {tip}, kind: {}}}", if held.bool() { "point" } else { "weld" });
            let contacts: Vec<String> = tips.split(", ").map(&mut contact).collect();
            let _ = writeln!(text, "contacts: [{}]", contacts[held.usize(0..contacts.len())..].join(", "));
        }
    }
    text.push_str("joints:\n");
    for joint in 0..dof {
        let kind = if rng.f64() < prismatic { "prismatic" } else { "revolute" };
        let _ = writeln!(text, "  - name: j{joint}\n    type: {kind}");
        if rng.f64() < branching {
            match rng.usize(0..=joint) {
                0 => text.push_str("    parent: base\n"),
                above => drop(writeln!(text, "    parent: j{}", above - 1)),
            }
        }
        let (theta, d) = (angle(rng, sparsity), number(rng, sparsity, 0.5));
        let (a, alpha) = (number(rng, sparsity, 0.5), angle(rng, sparsity));
        let mut row = format!("theta: {theta}, d: {d}, a: {a}, alpha: {alpha}");
        match rng.usize(0..4) {
            0 => drop(writeln!(text, "    at: {{{}}}", placement(rng))),
            1 if is_modified => {
                let _ = write!(row, ", gamma: {}, b: {}", angle(rng, sparsity), number(rng, sparsity, 0.5));
            }
            _ => {}
        }
        let _ = writeln!(text, "    dh: {{{row}}}");
        if let Some(link) = link(rng, sparsity) {
            let _ = writeln!(text, "    link: {link}");
        }
        if rng.f64() < 0.3 {
            let [inertia, ratio, friction] = [1e-3, 200.0, 0.5].map(|most| (2.0 * rng.f64() - 1.0) * most);
            let _ = writeln!(
                text,
                "    motor: {{inertia: {}, gear_ratio: {ratio}, viscous: 0.001, coulomb: [{}, -0.25]}}",
                inertia.abs(),
                friction.abs()
            );
        }
    }
    text
}
