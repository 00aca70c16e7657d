//! Finds changes of friction that another friction parameter of the joint would explain almost as well.

use crate::candidate::Candidate;
use crate::score::Change;
use crate::selection::{Finding, Selection};

/// A rival explains at least this part of what the reported parameter explains. In a test, 690 changes of Coulomb or
/// viscous friction were added by computation to two public logs and 80 simulated ones: 41 were reported as the other
/// kind, 38 of these with the true kind as a rival; 67 of the 649 others have a rival.
const ALMOST: f64 = 0.85;

impl Selection<'_> {
    /// Returns the friction parameters of the same joint that explain a change almost as well as the parameter that was
    /// found.
    ///
    /// If a parameter may change over the window, in addition to all other changes, the sum of squares decreases by
    /// some amount. This amount decides which cause is chosen, and which parameters are rivals: each is tried instead
    /// of the parameter that was found.
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
        // if both parameters have changed, they are distinguished already
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
