//! Random chains.

use std::fmt::Write;

/// The robot file of a chain of revolute joints in which no number is zero and no angle right. A longer chain begins
/// with the joints of a shorter one.
pub(crate) fn yaml(joints: usize) -> String {
    let mut text =
        String::from("format: 1\nname: chain\nsource: no arm\nconvention: standard\ngravity: [1, 2, -9]\njoints:\n");
    let mut numbers = fastrand::Rng::with_seed(50);
    let mut between = |low: f64, high: f64| low + (high - low) * numbers.f64();
    for _ in 0..joints {
        let [theta, d, a, alpha] =
            [(0.1, 1.4), (0.1, 0.4), (0.1, 0.4), (0.1, 1.4)].map(|(low, high)| between(low, high));
        let [x, y, z] = std::array::from_fn(|_| between(0.01, 0.1));
        let [xx, yy, zz] = std::array::from_fn(|_| between(0.2, 0.3));
        let [xy, xz, yz] = std::array::from_fn(|_| between(0.01, 0.03));
        let mass = between(1.0, 5.0);
        let _ = writeln!(
            text,
            "  - type: revolute\n    dh: {{theta: {theta}, d: {d}, a: {a}, alpha: {alpha}}}\n    \
             link: {{mass: {mass}, com: [{x}, {y}, {z}], \
             inertia: {{xx: {xx}, yy: {yy}, zz: {zz}, xy: {xy}, xz: {xz}, yz: {yz}}}}}"
        );
    }
    text
}
