//! Wrenches at tips as dual numbers that nothing changes.

use crate::{Dual, Scalar, Wrench};

/// Wrenches at tips, where nothing changes them.
pub(crate) trait AllStill<T> {
    /// As many, of dual numbers.
    type Still: AsRef<[Wrench<Dual<T>>]>;

    /// Each of them [`still`](Wrench::still).
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
