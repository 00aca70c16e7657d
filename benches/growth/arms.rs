//! Random arms of several joints with the numbers that robot files have.

use std::fmt::Write;

use fastrand::Rng;

/// The robot file of an arm of 7 to 12 joints, the same for the same seed: revolute and prismatic joints, right angles
/// and other ones, lengths and coordinates of which many are zero, links with and without mass.
pub(crate) fn yaml(seed: u64) -> String {
    let mut rng = Rng::with_seed(seed);
    let joints = rng.usize(7..=12);
    let convention = if rng.bool() { "standard" } else { "modified" };
    let gravity = if rng.f64() < 0.8 { "[0, 0, -9.81]" } else { "[1.2, -3.4, 9.1]" };
    let [prismatic, right, zeros] = [0.5, 1.0, 0.6].map(|most| most * rng.f64());
    let mut text = format!(
        "format: 1\nname: arm_{seed}\nsource: random numbers, seed {seed}\nconvention: {convention}\ngravity: \
         {gravity}\n"
    );
    if rng.bool() {
        let _ = writeln!(text, "tool: {{xyz: [0.1, 0, 0.2], rpy: [0.3, 0, 1.1]}}");
    }
    text.push_str("joints:\n");
    for _ in 0..joints {
        let kind = if rng.f64() < prismatic { "prismatic" } else { "revolute" };
        let [theta, alpha] = [(); 2].map(|()| angle(&mut rng, right));
        let [d, a] = [(); 2].map(|()| decimal(&mut rng, zeros, 0.8));
        let _ = writeln!(
            text,
            "  - type: {kind}\n    dh: {{theta: {theta}, d: {d}, a: {a}, alpha: {alpha}}}\n    link: {}",
            link(&mut rng, zeros)
        );
    }
    text
}

/// Zero, or up to `most` either way with three decimals.
fn decimal(rng: &mut Rng, zeros: f64, most: f64) -> f64 {
    if rng.f64() < zeros { 0.0 } else { (2e3 * most * (rng.f64() - 0.5)).round() / 1e3 }
}

fn angle(rng: &mut Rng, right: f64) -> String {
    let angles = ["0", "pi/2", "-pi/2", "pi"];
    if rng.f64() < right { angles[rng.usize(..4)].to_owned() } else { decimal(rng, 0.0, 3.0).to_string() }
}

fn link(rng: &mut Rng, zeros: f64) -> String {
    if rng.f64() < 0.05 {
        return "{mass: 0}".to_owned();
    }
    let mass = 0.5 + (60.0 * rng.f64()).round() / 10.0;
    let [x, y, z] = [(); 3].map(|()| decimal(rng, zeros, 0.4));
    // each principal moment is a sum of two moments of a plane, as those of a body are
    let planes = [(); 3].map(|()| decimal(rng, 0.1, 0.4).abs());
    let [xx, yy, zz] = [planes[1] + planes[2], planes[0] + planes[2], planes[0] + planes[1]];
    format!("{{mass: {mass}, com: [{x}, {y}, {z}], inertia: {{xx: {xx:.3}, yy: {yy:.3}, zz: {zz:.3}}}}}")
}
