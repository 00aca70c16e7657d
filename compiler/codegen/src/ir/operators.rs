//! Operators of numbers, each written as a rule.

/// Implements the operators of a type by rules such as `a + b => ...;`, where `a` and `b` are of that type.
macro_rules! operators {
    ($type:ty:) => {};
    ($type:ty: - $a:ident => $value:expr; $($rest:tt)*) => {
        impl std::ops::Neg for $type {
            type Output = Self;

            fn neg(self) -> Self {
                let $a = self;
                $value
            }
        }
        $crate::ir::operators!($type: $($rest)*);
    };
    ($type:ty: $a:ident + $($rest:tt)*) => { $crate::ir::operators!(@binary $type, Add, add: $a $($rest)*); };
    ($type:ty: $a:ident - $($rest:tt)*) => { $crate::ir::operators!(@binary $type, Sub, sub: $a $($rest)*); };
    ($type:ty: $a:ident * $($rest:tt)*) => { $crate::ir::operators!(@binary $type, Mul, mul: $a $($rest)*); };
    ($type:ty: $a:ident / $($rest:tt)*) => { $crate::ir::operators!(@binary $type, Div, div: $a $($rest)*); };
    (@binary $type:ty, $operator:ident, $method:ident: $a:ident $b:ident => $value:expr; $($rest:tt)*) => {
        #[allow(clippy::suspicious_arithmetic_impl)] // a field divides by multiplying with the inverse
        impl std::ops::$operator for $type {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                let ($a, $b) = (self, other);
                $value
            }
        }
        $crate::ir::operators!($type: $($rest)*);
    };
}

pub(crate) use operators;
