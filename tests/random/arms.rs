//! Random arms of the kinds that are hard on a compiler: axes that coincide, are parallel or at right angles, links
//! without mass, point masses, short decimals that fold and cancel; motors, bases, tools and gravity of any direction.

use std::fmt::Write;

use fastrand::Rng;

/// Joints of an arm: few more often than many, for time grows with their square.
const JOINTS: [usize; 12] = [1, 2, 2, 3, 3, 3, 4, 4, 5, 5, 6, 7];

/// What is special about the arms of a kind.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Nothing: decimals everywhere.
    Dense,
    /// All joints on one axis but for the first or last: sliding and turning in turn.
    Coaxial,
    /// Parallel axes.
    Parallel,
    /// Right angles and zeros, as in textbooks.
    RightAngled,
    /// Most links without mass.
    Massless,
    /// Masses without inertia.
    Points,
    /// Each joint of another kind.
    Mixed,
}

const KINDS: [Kind; 7] =
    [Kind::Dense, Kind::Coaxial, Kind::Parallel, Kind::RightAngled, Kind::Massless, Kind::Points, Kind::Mixed];

/// A robot file, the same for the same seed.
pub(crate) fn yaml(seed: u64) -> String {
    let mut rng = Rng::with_seed(seed ^ 0x5eed);
    let kind = one(&mut rng, &KINDS);
    let mut dof = one(&mut rng, &JOINTS);
    if kind == Kind::Coaxial {
        // what coincides in few joints is folded away
        dof = dof.max(3);
    }
    let convention = one(&mut rng, &["standard", "modified"]);
    let gravity = match rng.usize(..4) {
        0 => "[0, 0, 0]".to_owned(),
        1 => vector(&mut rng, 9.0),
        _ => "[0, 0, -9.81]".to_owned(),
    };
    let mut text = format!(
        "format: 1\nname: arm_{seed}\nsource: random numbers, seed {seed}\nconvention: {convention}\ngravity: \
        {gravity}\n"
    );
    for end in ["base", "tool"] {
        if rng.usize(..3) == 0 {
            let angles = [(); 3].map(|()| angle(&mut rng, kind)).join(", ");
            let _ = writeln!(text, "{end}: {{xyz: {}, rpy: [{angles}]}}", vector(&mut rng, 0.5));
        }
    }
    text.push_str("joints:\n");
    let slides_first = rng.usize(..2);
    // the joint whose axis is another one, if all others coincide
    let turned = one(&mut rng, &[0, dof - 1]);
    for index in 0..dof {
        let of_joint = if kind == Kind::Mixed { one(&mut rng, &KINDS) } else { kind };
        text.push_str(&joint(&mut rng, of_joint, index, slides_first, turned));
    }
    text
}

fn joint(rng: &mut Rng, kind: Kind, index: usize, slides_first: usize, turned: usize) -> String {
    let is_prismatic = match kind {
        Kind::Coaxial => (index + slides_first).is_multiple_of(2),
        _ => rng.usize(..4) == 0,
    };
    let length = |rng: &mut Rng, rarity: usize| if rng.usize(..rarity) == 0 { decimal(rng, 0.5) } else { 0.0 };
    let right = |rng: &mut Rng| one(rng, &["0", "pi/2", "-pi/2", "pi"]).to_owned();
    let (theta, d, a, alpha) = match kind {
        Kind::Coaxial => {
            let alpha = if index == turned { angle(rng, kind) } else { "0".to_owned() };
            (one(rng, &["0", "0", "0.3"]).to_owned(), length(rng, 3), length(rng, 6), alpha)
        }
        Kind::Parallel => {
            let alpha = one(rng, &["0", "0", "0", "pi"]).to_owned();
            (angle(rng, kind), length(rng, 2), decimal(rng, 0.5), alpha)
        }
        Kind::RightAngled => (right(rng), length(rng, 3), length(rng, 2), right(rng)),
        _ => (angle(rng, kind), length(rng, 2), length(rng, 2), angle(rng, kind)),
    };
    let name = if is_prismatic { "prismatic" } else { "revolute" };
    let mut text = format!("  - type: {name}\n    dh: {{theta: {theta}, d: {d}, a: {a}, alpha: {alpha}}}\n");
    if rng.usize(..4) == 0 {
        let [inertia, viscous, positive, negative] = [1e-3, 1e-2, 1.0, 1.0].map(|scale| decimal(rng, scale).abs());
        let ratio = decimal(rng, 100.0);
        let _ = writeln!(
            text,
            "    motor: {{inertia: {inertia}, gear_ratio: {ratio}, viscous: {viscous}, coulomb: [{positive}, \
            -{negative}]}}"
        );
    }
    if matches!(kind, Kind::Massless) && rng.usize(..3) > 0 || rng.usize(..12) == 0 {
        return text;
    }
    let mass = if rng.usize(..12) == 0 { 0.0 } else { decimal(rng, 5.0).abs() };
    let com = match rng.usize(..4) {
        0 => one(rng, &["[0, 0, 0]", "[0.2, 0, 0]", "[0, 0, -0.1]"]).to_owned(),
        _ => vector(rng, 0.5),
    };
    // without mass the same numbers are a first moment: no body, but what base parameters look like
    let (place, ends) = if mass == 0.0 { ("first_moment", ", physical: false") } else { ("com", "") };
    let _ = writeln!(text, "    link: {{mass: {mass}, {place}: {com}, inertia: {}{ends}}}", inertia(rng, kind));
    text
}

fn inertia(rng: &mut Rng, kind: Kind) -> String {
    // semi-axes of a body of unit mass: Σ over the two others of its squares
    let [x, y, z] = [(); 3].map(|()| decimal(rng, 0.6).powi(2));
    let [xx, yy, zz] = [y + z, x + z, x + y];
    match (kind, rng.usize(..3)) {
        (Kind::Points, _) => "{}".to_owned(),
        (Kind::Dense | Kind::Mixed, 0 | 1) => {
            let [xy, xz, yz] = [(); 3].map(|()| decimal(rng, 0.1) * xx.min(yy).min(zz));
            format!("{{xx: {xx}, yy: {yy}, zz: {zz}, xy: {xy}, xz: {xz}, yz: {yz}}}")
        }
        _ => format!("{{xx: {xx}, yy: {yy}, zz: {zz}}}"),
    }
}

fn one<T: Copy>(rng: &mut Rng, of: &[T]) -> T {
    of[rng.usize(..of.len())]
}

/// A number of two digits behind the point of `scale`, not zero.
fn decimal(rng: &mut Rng, scale: f64) -> f64 {
    let digits = f64::from(rng.i32(1..=100)) / 100.0;
    if rng.bool() { digits * scale } else { -digits * scale }
}

fn vector(rng: &mut Rng, scale: f64) -> String {
    let [x, y, z] = [(); 3].map(|()| if rng.usize(..4) == 0 { 0.0 } else { decimal(rng, scale) });
    format!("[{x}, {y}, {z}]")
}

fn angle(rng: &mut Rng, kind: Kind) -> String {
    let is_right = if kind == Kind::Dense { rng.usize(..8) == 0 } else { rng.bool() };
    if is_right { one(rng, &["0", "pi/2", "-pi/2", "pi"]).to_owned() } else { decimal(rng, 3.0).to_string() }
}
