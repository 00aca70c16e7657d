//! A robust first fit: a few disturbed segments of time cannot spoil it.
//!
//! Rows are weighted by their residuals in the previous fit, in standard deviations of its noise (P. J. Huber, Robust
//! statistics, 1981). A long push or sensor fault increases that noise so much that no residual seems large any more.
//! The equations are stored for segments of time. So the weight of segments with much larger residuals than the others
//! is reduced, iteratively and without another pass over the logs. With this fit, single rows can be weighted.

use rne_logs::median;

use crate::fit::information::Information;
use crate::fit::least_squares::LeastSquares;
use crate::fit::r_factor::RFactor;
use crate::fit::r_factor::effort;
use crate::fit::structure::Structure;

/// A segment is an outlier if its residual is this many times the median of its joint.
const SUSPECT: f64 = 7.0;
/// A segment whose residual is above this many times the median counts less.
const BEND: f64 = 2.0;
const ROUNDS: usize = 10;
/// Weights that change by less than this part have converged.
const SETTLED: f64 = 0.1;
/// Residuals below this part of the effort (root mean square) count as rounding.
const ROUNDING: f64 = 1e-6;

/// Returns the fit of the segments that agree with each other; `None` if no segment is an outlier.
pub(crate) fn steady(structure: &Structure, information: &Information, fit: &LeastSquares) -> Option<LeastSquares> {
    let before = residuals(structure, information, fit);
    let is_suspect = |of_joint: &Vec<f64>| of_joint.iter().any(|left| *left > SUSPECT * median(of_joint.clone()));
    if !before.iter().any(is_suspect) {
        return None;
    }
    let mut weights = weights(&before);
    let mut found = fit.clone();
    for _ in 0..ROUNDS {
        let weighted = information.weighted(&weights);
        found = LeastSquares::of(structure, &weighted, &weighted.scales(structure));
        let next = self::weights(&residuals(structure, information, &found));
        let pairs = weights.iter().flatten().zip(next.iter().flatten());
        let has_settled = pairs.into_iter().all(|(a, b)| (a - b).abs() <= SETTLED * a.max(*b));
        weights = next;
        if has_settled {
            break;
        }
    }
    Some(found)
}

/// Returns the root mean square of the residual of a fit for each joint and segment, N m or N.
fn residuals(structure: &Structure, information: &Information, fit: &LeastSquares) -> Vec<Vec<f64>> {
    let total = information.total(structure);
    let of_joint = |joint: usize| {
        let used = structure.used(joint, fit.transitions[joint]);
        let unknowns = structure.unknowns(joint);
        let left = |factor: &RFactor| {
            let selected = factor.selected(&used);
            let triangle = selected.triangle();
            let mut left = triangle.column(unknowns.len()).clone_owned();
            for (column, unknown) in unknowns.iter().enumerate() {
                left.axpy(-fit.solution[*unknown], &triangle.column(column), 1.0);
            }
            left.norm() / factor.weight().max(1.0).sqrt()
        };
        let effort = effort(&total[joint]);
        let segments = information.segments.iter().filter_map(|segment| segment.get(joint));
        segments.map(|factor| left(factor).max(ROUNDING * effort)).collect()
    };
    (0..structure.dof()).map(of_joint).collect()
}

fn weights(residuals: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let of_joint = |of_joint: &Vec<f64>| {
        let most = BEND * median(of_joint.clone());
        of_joint.iter().map(|left| if *left > most { (most / left).powi(2) } else { 1.0 }).collect()
    };
    residuals.iter().map(of_joint).collect()
}
