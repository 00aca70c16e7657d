//! The pseudo-inertia of a link: its ten parameters as a 4 × 4 matrix, which is positive definite if a body can have
//! them.
//!
//! ```text
//! P = ⎡ Σ    m c ⎤      Σ = ½ tr(J) 1 - J = ∫ x xᵀ dm
//!     ⎣ m cᵀ  m  ⎦
//! ```
//!
//! P ⪰ 0 states all conditions at once: the mass is positive, the inertia is positive definite and its moments obey the
//! triangle inequality. P. M. Wensing, S. Kim, J.-J. E. Slotine, Linear matrix inequalities for physically consistent
//! inertial parameter identification, IEEE RA-L 3(1), 2018.

use nalgebra::{Matrix4, SymmetricEigen};

use rne_model::PER_LINK;

/// Returns the pseudo-inertia of (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz) about the origin of the link
/// frame.
#[must_use]
pub fn of(parameters: &[f64; PER_LINK]) -> Matrix4<f64> {
    let [m, hx, hy, hz, xx, xy, xz, yy, yz, zz] = *parameters;
    let half = 0.5 * (xx + yy + zz);
    #[rustfmt::skip]
    let pseudo = Matrix4::new(
        half - xx, -xy, -xz, hx,
        -xy, half - yy, -yz, hy,
        -xz, -yz, half - zz, hz,
        hx, hy, hz, m,
    );
    pseudo
}

/// Returns the parameters of a pseudo-inertia, in the order of [`of`].
#[must_use]
pub fn parameters(pseudo: &Matrix4<f64>) -> [f64; PER_LINK] {
    let p = |row, column| pseudo[(row, column)];
    let trace = p(0, 0) + p(1, 1) + p(2, 2);
    [
        p(3, 3),
        p(0, 3),
        p(1, 3),
        p(2, 3),
        trace - p(0, 0),
        -p(0, 1),
        -p(0, 2),
        trace - p(1, 1),
        -p(1, 2),
        trace - p(2, 2),
    ]
}

/// Returns the matrices that the parameters multiply: P = Σ parameter · unit.
#[must_use]
pub fn units() -> [Matrix4<f64>; PER_LINK] {
    std::array::from_fn(|index| of(&std::array::from_fn(|other| f64::from(u8::from(index == other)))))
}

/// Returns the smallest eigenvalue over the largest: above zero for every body that is not flat.
#[must_use]
pub fn margin(pseudo: &Matrix4<f64>) -> f64 {
    // the eigenvalue iteration would not end for NaN
    if pseudo.iter().any(|x| !x.is_finite()) {
        return f64::NEG_INFINITY;
    }
    let values = SymmetricEigen::new(*pseudo).eigenvalues;
    let largest = values.max();
    if largest > 0.0 { values.min() / largest } else { f64::NEG_INFINITY }
}
