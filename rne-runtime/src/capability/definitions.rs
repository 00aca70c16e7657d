//! The macro that declares a trait beside the definition of its functions.

/// Defines a trait and its functions by their definitions, and implements it: for [`Arm`](crate::Arm), for an arm with
/// its tips, and as methods of `DynArm`. The code after `or` is the default for types of the user that do not implement
/// the function.
macro_rules! capability {
    // checks that a list has one element for each joint, or for each tip
    (@checked $robot:ident, $argument:ident, joints) => {
        $robot.has_length(stringify!($argument), $argument)?
    };
    (@checked $robot:ident, $argument:ident, wrenches) => {
        $robot.has_tips($argument)?
    };
    (@checked $robot:ident, $argument:ident, coordinates) => {
        $robot.has_coordinates(stringify!($argument), $argument)?
    };
    (@checked $robot:ident, $argument:ident, passive) => {
        $robot.has_passive(stringify!($argument), $argument)?
    };
    (@checked $robot:ident, $argument:ident, $other:ident) => {};
    (@method $(#[$doc:meta])* $name:ident($($arg:ident: $kind:ident),*) -> $result:ty) => {
        $(#[$doc])*
        #[must_use]
        #[allow(clippy::too_many_arguments)] // the state, and forces on the robot
        fn $name<T: $crate::Scalar>(&self, $($arg: $crate::values::shapes::known!($kind)),*) -> $result;
    };
    (@method $(#[$doc:meta])* $name:ident($($arg:ident: $kind:ident),*) -> $result:ty, $this:ident $default:block) => {
        $(#[$doc])*
        #[must_use]
        #[allow(clippy::too_many_arguments)] // the state, and forces on the robot
        fn $name<T: $crate::Scalar>(&self, $($arg: $crate::values::shapes::known!($kind)),*) -> $result {
            let $this = self;
            $default
        }
    };
    (@known [$($size:ident),*] $trait:path; $robot_type:ty; $(
        $(#[$doc:meta])* fn $name:ident($($arg:ident: $kind:ident),*) -> $shape:ident $(<$($of:ident),*>)?
            $(or |$this:ident| $default:block)? = |$robot:ident| $body:expr;
    )*) => {
        #[cfg(feature = "arm")]
        impl<$(const $size: usize,)* S: $crate::Constant> $trait for $robot_type {
            $(fn $name<T: $crate::Scalar>(
                &self,
                $($arg: $crate::values::shapes::known!($kind)),*
            ) -> $crate::values::shapes::known!($shape $(<$($of),*>)?) {
                let $robot = self.definition();
                From::from($body)
            })*
        }
    };
    (@counted $definition:ident $(
        $(#[$doc:meta])* fn $name:ident($($arg:ident: $kind:ident),*) -> $shape:ident $(<$($of:ident),*>)?
            $(or |$this:ident| $default:block)? = |$robot:ident| $body:expr;
    )*) => {
        #[cfg(all(feature = "arm", feature = "std"))]
        impl<S: $crate::Constant> $crate::DynArm<S> { $(
            $(#[$doc])*
            ///
            /// # Errors
            /// When an argument does not have one element per joint, or `wrenches` not one element per tip.
            #[allow(clippy::too_many_arguments)] // the state, and forces on the robot
            #[allow(clippy::type_complexity)] // as wide as the result is
            pub fn $name<T: $crate::Scalar>(
                &self,
                $($arg: $crate::values::shapes::counted!($kind)),*
            ) -> Result<$crate::values::shapes::counted!($shape $(<$($of),*>)?), $crate::WrongLength> {
                $(capability! { @checked self, $arg, $kind })*
                let $robot = self.$definition();
                Ok(From::from($body))
            }
        )* }
    };
    (@trait { $($more:tt)* } $(#[$about:meta])* $trait:ident<$($size:ident),*> $(
        $(#[$doc:meta])* fn $name:ident($($arg:ident: $kind:ident),*) -> $shape:ident $(<$($of:ident),*>)?
            $(or |$this:ident| $default:block)? = |$robot:ident| $body:expr;
    )*) => {
        $(#[$about])*
        ///
        #[cfg_attr(all(feature = "arm", not(doctest)), doc = rne_functions::example!("" $trait))] // `rne` runs it
        pub trait $trait<$(const $size: usize),*> { $(
            capability! { @method
                $(#[$doc])* $name($($arg: $kind),*) -> $crate::values::shapes::known!($shape $(<$($of),*>)?)
                    $(, $this $default)?
            }
        )* $($more)* }
    };
    // for functions of an arm whose joints are only known when the program runs; `with` precedes functions that are
    // composed of others
    ($(#[$about:meta])* pub trait $trait:ident<$($size:ident),*> of loops { $($functions:tt)* }
        $(with { $($more:tt)* })?) => {
        capability! { @trait { $($($more)*)? } $(#[$about])* $trait<$($size),*> $($functions)* }
        capability! { @counted itself $($functions)* }
    };
    ($(#[$about:meta])* pub trait $trait:ident<DOF> { $($functions:tt)* }) => {
        capability! { @trait {} $(#[$about])* $trait<DOF> $($functions)* }
        capability! { @known [DOF] $trait<DOF>; $crate::Arm<DOF, S>; $($functions)* }
        capability! { @counted definition $($functions)* }
    };
    ($(#[$about:meta])* pub trait $trait:ident<$($size:ident),*> { $($functions:tt)* }) => {
        capability! { @trait {} $(#[$about])* $trait<$($size),*> $($functions)* }
        capability! {
            @known [DOF, NV, TIPS] $trait<$($size),*>; $crate::ArmWithTips<'_, DOF, NV, TIPS, S>; $($functions)*
        }
        capability! { @counted definition $($functions)* }
    };
}
