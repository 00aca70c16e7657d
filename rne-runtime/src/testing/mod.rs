//! Functions for the tests of `#[robot(…, tests)]`: generated code against `DynArm` of the same robot file, and against
//! laws of mechanics. Each function is one test; it panics when the test fails, and names the state.
//!
//! Not part of the public interface: derived code names it.

#[cfg(all(feature = "arm", feature = "std"))]
mod of_robots;

#[cfg(all(feature = "arm", feature = "std"))]
pub use of_robots::*;

/// Compiles the tests if there is a runtime to compare with.
#[cfg(all(feature = "arm", feature = "std"))]
#[doc(hidden)]
#[macro_export]
macro_rules! __with_runtime {
    ($($tests:item)*) => { $($tests)* };
}

/// Reports one message in place of the tests, because there is no runtime to compare with.
#[cfg(not(all(feature = "arm", feature = "std")))]
#[doc(hidden)]
#[macro_export]
macro_rules! __with_runtime {
    ($($tests:item)*) => {
        ::core::compile_error!(
            "the tests of `#[robot(…, tests)]` compare with `rne::Arm`, which needs the features `arm` and `std`: \
             write `rne = { version = \"…\", features = [\"arm\", \"std\"] }` under `[dev-dependencies]`; the library \
             itself can do without"
        );
    };
}

pub use crate::__with_runtime as with_runtime;
