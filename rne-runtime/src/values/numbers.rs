//! Arguments and results as plain numbers, in the order of their layout.

use crate::{BaseAcceleration, BaseMotion, BaseTwist, Dual, Payload, Pose, Wrench};

/// A value that is made of numbers in the order of its layout: an argument or a result of a function.
pub trait Numbers<T> {
    /// Calls `see` with each of them, in order.
    fn each(&self, see: &mut impl FnMut(&T));
}

/// Implements the trait for numbers themselves.
macro_rules! number {
    ($($number:ident $(<$inner:ident>)?),*) => { $(
        impl $(<$inner>)? Numbers<Self> for $number $(<$inner>)? {
            fn each(&self, see: &mut impl FnMut(&Self)) {
                see(self);
            }
        }
    )* };
}
number!(f32, f64, Dual<T>);

impl<T, X: Numbers<T> + ?Sized> Numbers<T> for &X {
    fn each(&self, see: &mut impl FnMut(&T)) {
        (**self).each(see);
    }
}

impl<T, X: Numbers<T>> Numbers<T> for [X] {
    fn each(&self, see: &mut impl FnMut(&T)) {
        for numbers in self {
            numbers.each(see);
        }
    }
}

impl<T, X: Numbers<T>, const N: usize> Numbers<T> for [X; N] {
    fn each(&self, see: &mut impl FnMut(&T)) {
        self.as_slice().each(see);
    }
}

#[cfg(feature = "std")]
impl<T, X: Numbers<T>> Numbers<T> for Vec<X> {
    fn each(&self, see: &mut impl FnMut(&T)) {
        self.as_slice().each(see);
    }
}

/// Implements the trait for records, by their fields.
macro_rules! fields {
    ($($record:ident { $($field:ident),* })*) => { $(
        impl<T: Numbers<T>> Numbers<T> for $record<T> {
            fn each(&self, see: &mut impl FnMut(&T)) {
                $(self.$field.each(see);)*
            }
        }
    )* };
}
fields! {
    Wrench { force, moment }
    Pose { rotation, translation }
    BaseTwist { linear, angular }
    BaseAcceleration { linear, angular }
    // without `velocity`: the velocity of a base has no effect
    BaseMotion { omega, omega_dot, acceleration, gravity }
}

impl<T: Numbers<T>> Numbers<T> for Payload<T> {
    fn each(&self, see: &mut impl FnMut(&T)) {
        self.mass.each(see);
        self.com.each(see);
        let inertia = &self.inertia;
        [&inertia.xx, &inertia.yy, &inertia.zz, &inertia.xy, &inertia.xz, &inertia.yz].each(see);
    }
}

#[cfg(feature = "machine")]
pub use self::shaped::Shaped;

#[cfg(feature = "machine")]
mod shaped {
    use core::array;

    use rne_functions::Layout;

    use crate::{BaseAcceleration, BaseTwist, Pose, Wrench};

    /// A result that is built from the numbers of a function, in the order of its layout.
    pub trait Shaped<T>: Sized {
        /// Takes the numbers of the layout from an iterator and builds the result.
        fn take(layout: &Layout, numbers: &mut impl Iterator<Item = T>) -> Self;
    }

    macro_rules! number {
        ($($number:ident),*) => { $(
            impl Shaped<Self> for $number {
                fn take(_: &Layout, numbers: &mut impl Iterator<Item = Self>) -> Self {
                    numbers.next().unwrap_or(0.0)
                }
            }
        )* };
    }
    number!(f32, f64);

    impl<T, E: Shaped<T>> Shaped<T> for Vec<E> {
        fn take(layout: &Layout, numbers: &mut impl Iterator<Item = T>) -> Self {
            layout.parts().map(|part| E::take(part, numbers)).collect()
        }
    }

    impl<T, E: Shaped<T>, const N: usize> Shaped<T> for [E; N] {
        fn take(layout: &Layout, numbers: &mut impl Iterator<Item = T>) -> Self {
            let mut parts = layout.parts();
            array::from_fn(|_| E::take(parts.next().unwrap_or(layout), numbers))
        }
    }

    macro_rules! fields {
        ($($record:ident { $($field:ident),* })*) => { $(
            impl<T: Shaped<T>> Shaped<T> for $record<T> {
                fn take(layout: &Layout, numbers: &mut impl Iterator<Item = T>) -> Self {
                    let mut parts = layout.parts();
                    // Rust evaluates fields in the order in which they are written here
                    Self { $($field: Shaped::take(parts.next().unwrap_or(layout), numbers)),* }
                }
            }
        )* };
    }
    fields! {
        Wrench { force, moment }
        Pose { rotation, translation }
        BaseTwist { linear, angular }
        BaseAcceleration { linear, angular }
    }
}
