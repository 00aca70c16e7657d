//! Checks whether a mass matrix is positive definite. If all links are physical bodies, it is positive definite or
//! singular; with `physical: false` a link need not be one.

use rne::{DynArm, Payload};
use rne_codegen::{Argument, Function};
use rne_model::Robot;

use crate::render::physics::smallest_pivot;

/// A pivot counts as negative if it is below zero by more than this part of the largest element, which rounding cannot
/// cause.
const NEGATIVE: f64 = 1e-9;

/// A pivot counts as zero if it is below this part of the diagonal element, because fewer than three digits would be
/// left.
const SINGULAR: f64 = 1e-13;

/// The message for a result of a function that inverts the mass matrix, if this is singular up to rounding.
pub(crate) const BUT_FOR_ROUNDING: &str = "the mass matrix is singular at this position, so the numbers are \
                                           rounding errors: no inertia resists a joint, or the base, when others move \
                                           against it; give its link mass and inertia (`rne check` names the link if \
                                           this is so at all positions)";

/// The message for a result of a function that inverts the mass matrix, if this is not positive definite.
pub(crate) const NOT_DEFINITE: &str = "the mass matrix is not positive definite at this position: a link is no real \
                                       body (`physical: false`)";

/// Returns whether the mass matrix that a function inverts has a negative direction at a position, given by q and the
/// dependent joints of closed loops.
pub(crate) fn is_indefinite(
    robot: &Robot,
    function: Function,
    joints: [&[f64]; 2],
    payload: Option<&Payload<f64>>,
) -> bool {
    inverted_mass_matrix(&DynArm::from_robot(robot), function, joints, payload).is_some_and(has_negative_direction)
}

/// Returns whether the mass matrix that a function inverts is singular up to rounding at a position.
pub(crate) fn is_singular(
    robot: &Robot,
    function: Function,
    joints: [&[f64]; 2],
    payload: Option<&Payload<f64>>,
) -> bool {
    let arm = DynArm::from_robot(robot);
    least_resistance(&arm, function, joints, payload).is_some_and(|least| least < SINGULAR)
        && !is_indefinite(robot, function, joints, payload)
}

/// Returns the [smallest pivot](smallest_pivot) of the mass matrix that a function inverts; `None` if it inverts none.
pub(crate) fn least_resistance(
    arm: &DynArm,
    function: Function,
    joints: [&[f64]; 2],
    payload: Option<&Payload<f64>>,
) -> Option<f64> {
    inverted_mass_matrix(arm, function, joints, payload).map(smallest_pivot)
}

/// Returns the mass matrix that a function inverts, with the rows of a floating base or with a payload; `None` if it
/// inverts none.
fn inverted_mass_matrix(
    arm: &DynArm,
    function: Function,
    [q, passive]: [&[f64]; 2],
    payload: Option<&Payload<f64>>,
) -> Option<Vec<Vec<f64>>> {
    let matrix = || match payload.filter(|_| function.takes(Argument::Payload)) {
        Some(payload) => arm.mass_matrix_with_payload(q, payload),
        None => match (function.is_of_floating_base(), function.is_of_closed_loops()) {
            (true, true) => arm.floating_mass_matrix_of_loops(q, passive),
            (true, false) => arm.floating_mass_matrix(q),
            (false, true) => arm.mass_matrix_of_loops(q, passive),
            (false, false) => arm.mass_matrix(q),
        },
    };
    function.inverts_mass().then(matrix)?.ok()
}

/// Returns whether xᵀ M x < 0 for some x. Elimination takes the largest pivot of the diagonal each time; if the rest
/// has a zero diagonal, any other element that is not zero gives such an x.
fn has_negative_direction(mut m: Vec<Vec<f64>>) -> bool {
    let largest = m.iter().flatten().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let least = NEGATIVE * largest;
    if !largest.is_finite() {
        return false;
    }
    let mut rest: Vec<usize> = (0..m.len()).collect();
    while !rest.is_empty() {
        if rest.iter().any(|&i| m[i][i] < -least) {
            return true;
        }
        let at = (0..rest.len()).max_by(|&a, &b| m[rest[a]][rest[a]].total_cmp(&m[rest[b]][rest[b]])).unwrap_or(0);
        let pivot = rest[at];
        if m[pivot][pivot] <= least {
            return rest.iter().any(|&i| rest.iter().any(|&j| m[i][j].abs() > least));
        }
        rest.swap_remove(at);
        for &i in &rest {
            let factor = m[i][pivot] / m[pivot][pivot];
            for &j in &rest {
                m[i][j] -= factor * m[pivot][j];
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::has_negative_direction;

    #[test]
    fn definiteness_is_that_of_the_eigenvalues() {
        for (matrix, is_negative) in [
            (vec![vec![2.0, 1.0], vec![1.0, 2.0]], false),
            // a singular matrix, with the eigenvalues 0 and 2
            (vec![vec![1.0, 1.0], vec![1.0, 1.0]], false),
            (vec![vec![0.0, 0.0], vec![0.0, 3.0]], false),
            // eigenvalues of this matrix and the next two: -1 and 1; 3 and -1; -1
            (vec![vec![0.0, 1.0], vec![1.0, 0.0]], true),
            (vec![vec![1.0, 2.0], vec![2.0, 1.0]], true),
            (vec![vec![-1.0]], true),
            (vec![vec![f64::INFINITY]], false),
        ] {
            assert_eq!(has_negative_direction(matrix.clone()), is_negative, "{matrix:?}");
        }
    }
}
