//! The names of the numbers of argument arrays.

use std::array::from_fn;

use super::{Name, Quantity};

/// The names of the numbers of an array that belong to a joint, to the base (0) or to a tip, in order.
pub(crate) fn names_of(array: &str, joint: usize) -> impl Iterator<Item = Name> {
    let quantities = quantities(array).iter();
    quantities.flat_map(move |&(quantity, count)| (0..count).map(move |at| Name::nth(quantity, joint, count, at)))
}

/// The names of all numbers of an array whose length does not depend on the robot, in the order of the table of
/// arguments.
pub(crate) fn all_names_of<const COUNT: usize>(array: &str, joint: usize) -> [Name; COUNT] {
    let names: Vec<Name> = names_of(array, joint).collect();
    from_fn(|at| names[at])
}

/// The quantities of the numbers of an array, and how many numbers each has.
fn quantities(array: &str) -> &'static [(Quantity, usize)] {
    macro_rules! quantities {
        ($($name:ident: $argument:ident, $owner:ident [$($quantity:ident * $count:literal),*], $about:literal;)*) => {
            match array {
                $(stringify!($name) => &[$((Quantity::$quantity, $count)),*],)*
                name => unreachable!("no argument is passed in {name}"),
            }
        };
    }
    rne_functions::argument_parts!(quantities)
}
