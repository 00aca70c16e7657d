//! Random robots: every mixture of joints, conventions, right angles, zeros and dense data that a file can hold.

use std::fmt::Write;

use fastrand::Rng;

/// A robot file with `dof` joints, the same for the same seed.
pub(crate) fn yaml(seed: u64, dof: usize) -> String {
    let mut rng = Rng::with_seed(seed);
    let convention = if rng.bool() { "standard" } else { "modified" };
    // How often a number is zero and an angle right: from arms like textbooks' to arms where nothing folds.
    let sparsity = *rng.choice([0.0, 0.3, 0.7, 0.9].iter()).unwrap_or(&0.5);
    let prismatic = *rng.choice([0.0, 0.2, 0.5, 1.0].iter()).unwrap_or(&0.2);
    let gravity = if rng.bool() { "[0, 0, -9.81]".to_owned() } else { vector(&mut rng, 0.3, 9.0) };

    let mut text = format!(
        "format: 1\nname: random_{seed}\nsource: random numbers, seed {seed}\nconvention: {convention}\n\
         gravity: {gravity}\n"
    );
    if rng.bool() {
        let (xyz, rpy) = (vector(&mut rng, sparsity, 0.3), angles(&mut rng, sparsity));
        let _ = writeln!(text, "tool: {{xyz: {xyz}, rpy: {rpy}}}");
    }
    text.push_str("joints:\n");
    for _ in 0..dof {
        let kind = if rng.f64() < prismatic { "prismatic" } else { "revolute" };
        let (theta, d) = (angle(&mut rng, sparsity), number(&mut rng, sparsity, 0.5));
        let (a, alpha) = (number(&mut rng, sparsity, 0.5), angle(&mut rng, sparsity));
        let _ = writeln!(text, "  - type: {kind}\n    dh: {{theta: {theta}, d: {d}, a: {a}, alpha: {alpha}}}");
        if let Some(link) = link(&mut rng, sparsity) {
            let _ = writeln!(text, "    link: {link}");
        }
    }
    text
}

/// A link; `None` of those without mass and inertia.
pub(crate) fn link(rng: &mut Rng, sparsity: f64) -> Option<String> {
    if rng.f64() < 0.15 {
        return None;
    }
    let mass = if rng.f64() < 0.1 { 0.0 } else { rng.f64() * 10.0 };
    let (com, inertia) = (vector(rng, sparsity, 0.3), inertia(rng, sparsity));
    // without mass the same numbers are a first moment: no body, but what base parameters look like
    let (place, ends) = if mass == 0.0 { ("first_moment", ", physical: false") } else { ("com", "") };
    Some(format!("{{mass: {mass}, {place}: {com}, inertia: {inertia}{ends}}}"))
}

pub(crate) fn number(rng: &mut Rng, sparsity: f64, scale: f64) -> f64 {
    if rng.f64() < sparsity { 0.0 } else { (2.0 * rng.f64() - 1.0) * scale }
}

pub(crate) fn vector(rng: &mut Rng, sparsity: f64, scale: f64) -> String {
    let [x, y, z] = [(); 3].map(|()| number(rng, sparsity, scale));
    format!("[{x}, {y}, {z}]")
}

pub(crate) fn angle(rng: &mut Rng, sparsity: f64) -> String {
    if rng.f64() < sparsity {
        let right = ["0", "pi/2", "-pi/2", "pi", "-pi", "3*pi/2"];
        return (*rng.choice(right.iter()).unwrap_or(&"0")).to_owned();
    }
    format!("{}", (2.0 * rng.f64() - 1.0) * 3.0)
}

pub(crate) fn angles(rng: &mut Rng, sparsity: f64) -> String {
    let [roll, pitch, yaw] = [(); 3].map(|()| angle(rng, sparsity));
    format!("[{roll}, {pitch}, {yaw}]")
}

/// A positive semidefinite tensor: none, diagonal, or full. A full one is Σ v vᵀ, which is semidefinite by
/// construction.
fn inertia(rng: &mut Rng, sparsity: f64) -> String {
    if rng.f64() < sparsity * 0.5 {
        return "{}".to_owned();
    }
    if rng.f64() < sparsity {
        let [x, y, z] = [(); 3].map(|()| number(rng, 0.2, 1.0).abs());
        return format!("{{xx: {x}, yy: {y}, zz: {z}}}");
    }
    let v = [(); 3].map(|()| [(); 3].map(|()| 2.0 * rng.f64() - 1.0));
    let element = |i: usize, j: usize| v.iter().map(|v| v[i] * v[j]).sum::<f64>();
    format!(
        "{{xx: {}, yy: {}, zz: {}, xy: {}, xz: {}, yz: {}}}",
        element(0, 0),
        element(1, 1),
        element(2, 2),
        element(0, 1),
        element(0, 2),
        element(1, 2)
    )
}
