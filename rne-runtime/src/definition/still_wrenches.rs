//! Wrenches at tips as dual numbers whose derivatives are zero.

use crate::{Dual, Scalar, Wrench};

/// Wrenches at tips that can be converted to dual numbers.
pub(crate) trait AllStill<T> {
    /// A collection of the same number of wrenches in dual numbers.
    type Still: AsRef<[Wrench<Dual<T>>]>;

    /// Converts each wrench by [`still`](Wrench::still).
    fn all_still(self) -> Self::Still;
}

impl<const TIPS: usize, T: Scalar> AllStill<T> for &[Wrench<T>; TIPS] {
    type Still = [Wrench<Dual<T>>; TIPS];

    fn all_still(self) -> Self::Still {
        self.map(Wrench::still)
    }
}

#[cfg(feature = "std")]
impl<T: Scalar> AllStill<T> for &[Wrench<T>] {
    type Still = Vec<Wrench<Dual<T>>>;

    fn all_still(self) -> Self::Still {
        self.iter().copied().map(Wrench::still).collect()
    }
}
