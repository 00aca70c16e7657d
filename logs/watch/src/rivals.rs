//! Friction that another parameter of the joint would explain almost as well.

use crate::candidate::Candidate;
use crate::score::Change;
use crate::selection::{Finding, Selection};

/// A rival explains at least this part of what the named parameter explains. Of 690 changes of Coulomb or viscous
/// friction that were computed into two public logs and 80 simulated ones, 41 have the name of the other kind, 38 of
/// them with the true kind as a rival; of the 649 others 67 have a rival.
const ALMOST: f64 = 0.85;

impl Selection<'_> {
    /// The friction parameters of the same joint that explain a change almost as well as the parameter that was found.
    ///
    /// The sum of squares falls by some amount when a parameter changes over the window, beside all other changes. The
    /// competition of the causes is decided by this amount, and so are rivals: each takes the place of the parameter
    /// that was found.
    pub(crate) fn rivals(&self, found: &Finding) -> Vec<Candidate> {
        let named = found.statistic.candidate;
        let rival = match named {
            Candidate::Coulomb(joint) => Candidate::Viscous(joint),
            Candidate::Viscous(joint) => Candidate::Coulomb(joint),
            _ => return Vec::new(),
        };
        let is_of = |candidate: usize, of: Candidate| self.score.candidates()[candidate].0 == of;
        let (own, others): (Vec<_>, Vec<_>) =
            self.given.iter().cloned().partition(|given| is_of(given.change.candidate, named));
        // where both have changed, each is known beside the other
        if own.is_empty() || others.iter().any(|given| is_of(given.change.candidate, rival)) {
            return Vec::new();
        }
        let drop = |of: Candidate| {
            let candidate = self.score.candidates().iter().position(|(candidate, _)| *candidate == of)?;
            let change = Change { candidate, window: found.window.clone() };
            Some(self.score.estimate(change, &others)?.drop)
        };
        let is_rival = drop(named).zip(drop(rival)).is_some_and(|(named, rival)| rival >= ALMOST * named);
        if is_rival { vec![rival] } else { Vec::new() }
    }
}
