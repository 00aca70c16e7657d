//! Arrays that should be of one length and are not.

use core::error::Error;
use core::fmt;

/// An array has another length than the first joint's positions, which say how many states there are.
///
/// Nothing has been computed then, and no torque written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LengthMismatch {
    /// Name of the argument: `q`, `qd`, `qdd` or `tau`.
    pub argument: &'static str,
    /// Index of the joint's array in the argument, from 0.
    pub joint: usize,
    /// The length of that array.
    pub length: usize,
    /// The length of `q[0]`.
    pub states: usize,
}

impl fmt::Display for LengthMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { argument, joint, length, states } = self;
        write!(f, "`{argument}[{joint}]` has length {length} and `q[0]` {states}: each holds one number per state")
    }
}

impl Error for LengthMismatch {}

/// The length of all arrays: of the inputs, and those of the torques.
pub(super) fn common_length<T, const DOF: usize>(
    [q, qd, qdd]: [&[&[T]; DOF]; 3],
    tau: [usize; DOF],
) -> Result<usize, LengthMismatch> {
    let states = q.first().map_or(0, |first| first.len());
    let inputs = [("q", q), ("qd", qd), ("qdd", qdd)].map(|(argument, arrays)| (argument, arrays.map(<[T]>::len)));
    for (argument, lengths) in inputs.into_iter().chain([("tau", tau)]) {
        for (joint, length) in lengths.into_iter().enumerate() {
            if length != states {
                return Err(LengthMismatch { argument, joint, length, states });
            }
        }
    }
    Ok(states)
}
