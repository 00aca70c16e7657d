//! The dynamics of the arm at its tip or at a frame: the operational-space inertia Λ = (J M⁻¹ Jᵀ)⁻¹ and the dynamically
//! consistent inverse J̄ = M⁻¹ Jᵀ Λ of the Jacobian. Source: O. Khatib, "A unified approach for motion and force
//! control of robot manipulators: the operational space formulation", IEEE Journal of Robotics and Automation
//! 3(1), 1987.
//!
//! M and J M⁻¹ Jᵀ are factored as L D Lᵀ, as in [forward dynamics](crate::ForwardDynamics).

use crate::Scalar;
use crate::number::ldlt::{factor, inverse_of, solve};

/// The operational-space inertia Λ(q) = (J M⁻¹ Jᵀ)⁻¹ of Khatib (1987): a force at the tip of an arm at rest, without
/// gravity, is Λ times the acceleration of the tip that it causes.
///
/// `mass` is M(q): [`mass_matrix`](crate::MassMatrix::mass_matrix), also with rotors or with a payload. `jacobian` has
/// the rows of J(q) that the task controls. With all six rows of [`jacobian`](crate::Kinematics::jacobian), or of
/// [`jacobian_of`](crate::FrameKinematics::jacobian_of) for a frame, the rows and columns of Λ are x, y, z of the
/// velocity, then x, y, z of the angular velocity, in world axes. Units: kg between two linear rows, kg m² between two
/// angular rows, kg m between a linear and an angular row.
///
/// Λ is symmetric to the last bit. An arm moves its tip in at most `DOF` directions at a time, so `ROWS > DOF` is a
/// compile error: for a planar arm give two rows, `[j[0], j[1]]`. At a singular pose (the rows of J are linearly
/// dependent) Λ does not exist: the elements are then not finite, or so large that they contain only rounding errors.
/// The function never panics. Near such a pose, give fewer rows.
///
/// A frame that only k joints move has at most k independent rows, at every pose: the compiler does not know k, so all
/// six rows of a frame on joint 4 compile, and Λ is never right. Give at most k rows, and test that the result is
/// finite.
///
/// ```
/// use rne_runtime::operational_space_inertia;
///
/// // a point mass of 2 kg on a slide along x and a slide along y
/// let (mass, jacobian) = ([[2.0, 0.0], [0.0, 2.0]], [[1.0, 0.0], [0.0, 1.0]]);
/// assert_eq!(operational_space_inertia(&mass, &jacobian), [[2.0, 0.0], [0.0, 2.0]]);
///
/// // three slides; only the first two move the frame: three rows are dependent, two are not
/// let mass = [[1.0_f64, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let [x, y, z] = [[1.0_f64, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
/// assert!(!operational_space_inertia(&mass, &[x, y, z]).as_flattened().iter().all(|x| x.is_finite()));
/// assert_eq!(operational_space_inertia(&mass, &[x, y]), [[1.0, 0.0], [0.0, 1.0]]);
/// ```
#[must_use]
pub fn operational_space_inertia<const DOF: usize, const ROWS: usize, T: Scalar>(
    mass: &[[T; DOF]; DOF],
    jacobian: &[[T; DOF]; ROWS],
) -> [[T; ROWS]; ROWS] {
    const { at_most_one_row_per_joint(ROWS, DOF) };
    operational_space(&mut { *mass }, &mut { *jacobian }, [[T::zero(); ROWS]; ROWS])
}

/// The dynamically consistent inverse J̄(q) = M⁻¹ Jᵀ Λ of the Jacobian, Khatib (1987): of all q̇ with J q̇ = v, J̄ v has
/// the least kinetic energy.
///
/// Row i belongs to joint i, column k to row k of `jacobian`: rad/s or m/s of the joint per m/s or rad/s of the task.
/// J J̄ = 1. Torques (1 - Jᵀ J̄ᵀ) τ do not accelerate the task for any τ: they move only the null space. The arguments,
/// the compile error and the results at singular poses are those of [`operational_space_inertia`].
///
/// For inverse kinematics, a step of the joints is J̄ times the error of the pose,
/// [`Pose::error_to`](crate::Pose::error_to), in the same rows. It has no damping, so limit the step near singular
/// poses.
///
/// ```
/// use rne_runtime::dynamically_consistent_inverse;
///
/// // a slide of 1 kg on a slide of 3 kg along the same line: only the lighter one moves
/// let (mass, jacobian) = ([[4.0, 1.0], [1.0, 1.0]], [[1.0, 1.0]]);
/// let inverse = dynamically_consistent_inverse(&mass, &jacobian);
/// assert_eq!(inverse, [[0.0], [1.0]]);
///
/// // inverse kinematics: the step of the joints that moves the tip by 0.2 m along the line
/// let error = [0.2];
/// assert_eq!(inverse.map(|joint| joint[0] * error[0]), [0.0, 0.2]);
/// ```
#[must_use]
pub fn dynamically_consistent_inverse<const DOF: usize, const ROWS: usize, T: Scalar>(
    mass: &[[T; DOF]; DOF],
    jacobian: &[[T; DOF]; ROWS],
) -> [[T; ROWS]; DOF] {
    const { at_most_one_row_per_joint(ROWS, DOF) };
    let mut transposed = *jacobian;
    let _ = operational_space(&mut { *mass }, &mut transposed, [[T::zero(); ROWS]; ROWS]);
    core::array::from_fn(|joint| transposed.map(|row| row[joint]))
}

/// More rows than joints are linearly dependent at every pose.
const fn at_most_one_row_per_joint(rows: usize, joints: usize) {
    assert!(rows <= joints, "give at most as many rows of the Jacobian as the arm has joints, such as `[j[0], j[1]]`");
}

/// Returns Λ, written to `zeros`, and replaces the rows of J by those of J̄ᵀ. `mass` contains the factors of M
/// afterwards.
#[doc(hidden)]
pub fn operational_space<T: Scalar, R, S, A>(mass: &mut [R], jacobian: &mut [R], zeros: A) -> A
where
    R: AsRef<[T]> + AsMut<[T]> + Clone,
    S: AsRef<[T]> + AsMut<[T]> + Clone,
    A: AsRef<[S]> + AsMut<[S]> + Clone,
{
    let (Some(row), Some(zero)) = (jacobian.first().cloned(), zeros.as_ref().first().cloned()) else { return zeros };
    let mut pivots = row;
    factor(mass, pivots.as_mut());
    // the mobility J M⁻¹ Jᵀ, which is symmetric, so only one half is computed
    let mut mobility = zeros;
    for k in 0..jacobian.len() {
        let mut solved = jacobian[k].clone();
        solve(mass, pivots.as_ref(), solved.as_mut());
        for (l, row) in jacobian.iter().enumerate().skip(k) {
            let products = solved.as_ref().iter().zip(row.as_ref());
            let sum = products.fold(T::zero(), |sum, (&x, &j)| sum + x * j);
            mobility.as_mut()[k].as_mut()[l] = sum;
            mobility.as_mut()[l].as_mut()[k] = sum;
        }
        jacobian[k] = solved;
    }
    let inertia = inverse_of(mobility, &zero);
    for joint in 0..pivots.as_ref().len() {
        let mut of_joint = zero.clone();
        for (row, place) in inertia.as_ref().iter().zip(of_joint.as_mut()) {
            let products = row.as_ref().iter().zip(jacobian.iter());
            *place = products.fold(T::zero(), |sum, (&l, solved)| sum + l * solved.as_ref()[joint]);
        }
        for (row, &element) in jacobian.iter_mut().zip(of_joint.as_ref()) {
            row.as_mut()[joint] = element;
        }
    }
    inertia
}
