//! Whether a mass matrix is positive definite. The mass matrix of an arm whose links are bodies is positive definite;
//! with `physical: false` a link need not be a body.

use rne::DynArm;
use rne_codegen::Function;
use rne_model::Robot;

/// A pivot counts as negative beyond this part of the largest element: rounding does not make such a pivot.
const NEGATIVE: f64 = 1e-9;

/// The mistake in the result of a function that inverts the mass matrix, where this is not positive definite.
pub(crate) const NOT_DEFINITE: &str = "the mass matrix is not positive definite at this position: a link is no real \
                                       body (`physical: false`), or a payload has negative numbers";

/// Whether a function inverts the mass matrix of the robot, and that is not positive definite at a position.
pub(crate) fn is_indefinite(robot: &Robot, function: Function, q: &[f64]) -> bool {
    function.inverts_mass() && DynArm::from_robot(robot).mass_matrix(q).is_ok_and(has_negative_direction)
}

/// Whether xᵀ M x < 0 for some x: elimination with the largest pivot of the diagonal, or a rest whose diagonal is zero
/// and whose other elements are not.
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
            // eigenvalues 0 and 2: singular
            (vec![vec![1.0, 1.0], vec![1.0, 1.0]], false),
            (vec![vec![0.0, 0.0], vec![0.0, 3.0]], false),
            // eigenvalues -1 and 1, 3 and -1, -1
            (vec![vec![0.0, 1.0], vec![1.0, 0.0]], true),
            (vec![vec![1.0, 2.0], vec![2.0, 1.0]], true),
            (vec![vec![-1.0]], true),
            (vec![vec![f64::INFINITY]], false),
        ] {
            assert_eq!(has_negative_direction(matrix.clone()), is_negative, "{matrix:?}");
        }
    }
}
