//! The arguments of a function for many states, in arrays of the caller.

use core::ops::Range;

use rne_codegen::ArgumentPart;
use rne_runtime::machine::Source;

/// An argument for many states: its elements, most often one number per joint, for each state.
#[derive(Clone, Copy, Debug)]
pub enum Array<'a, T> {
    /// All elements of the first state, then all of the next one: `q[state][joint]`. States that are arrays, such as
    /// `states: Vec<[f64; 7]>`, can be given directly: `.q(&states)`.
    Rows(&'a [T]),
    /// One slice per element, with one number per state: `q[joint][state]`. This layout is read fastest.
    Columns(&'a [&'a [T]]),
    /// The elements of one state, which all states have in common.
    Same(&'a [T]),
    /// Element `j` of state `s` is at `s * state + j * element`.
    Strided {
        /// The numbers, from the first element of the first state on.
        numbers: &'a [T],
        /// The distance from one state to the next, in numbers.
        state: usize,
        /// The distance from one element to the next, in numbers.
        element: usize,
    },
}

impl<'a, T> Array<'a, T> {
    /// Returns some elements of a larger array as an array, such as the force of a wrench. `elements` is the number of
    /// elements of the larger array for each state.
    #[must_use]
    pub fn part(self, elements: usize, range: Range<usize>) -> Self {
        match self {
            Array::Rows(numbers) => {
                Array::Strided { numbers: numbers.get(range.start..).unwrap_or_default(), state: elements, element: 1 }
            }
            Array::Columns(columns) => Array::Columns(columns.get(range).unwrap_or_default()),
            Array::Same(numbers) => Array::Same(numbers.get(range).unwrap_or_default()),
            Array::Strided { numbers, state, element } => {
                let numbers = numbers.get(range.start.saturating_mul(element)..).unwrap_or_default();
                Array::Strided { numbers, state, element }
            }
        }
    }

    /// Whether the array has this number of elements for each of these states.
    pub(crate) fn has(&self, elements: usize, states: usize) -> bool {
        match *self {
            Array::Columns(columns) => columns.len() == elements && columns.iter().all(|column| column.len() == states),
            // all elements have the same number of states, so it is enough to test the first
            _ => elements == 0 || self.source(0, elements, states).is_some(),
        }
    }

    /// Returns one element of all states; `elements` is the number of elements per state. `None` if the array is too
    /// short.
    pub(crate) fn source(&self, element: usize, elements: usize, states: usize) -> Option<Source<'a, T>> {
        match *self {
            Array::Rows(numbers) => {
                (numbers.len() == states.checked_mul(elements)?).then(|| strided(numbers, element, elements))
            }
            Array::Columns(columns) => {
                let column =
                    columns.get(element).filter(|column| columns.len() == elements && column.len() == states)?;
                Some(Source::Column(column))
            }
            Array::Same(numbers) => (numbers.len() == elements).then(|| strided(numbers, element, 0)),
            Array::Strided { numbers, state, element: apart } => {
                let last = |count: usize, apart: usize| count.saturating_sub(1).checked_mul(apart);
                let reached = last(states, state)?.checked_add(last(elements, apart)?)?;
                (states == 0 || reached < numbers.len()).then(|| strided(numbers, element * apart, state))
            }
        }
    }

    /// Returns one element of one state; `elements` is the number of elements per state.
    pub(crate) fn number(&self, element: usize, elements: usize, state: usize, states: usize) -> Option<&'a T> {
        match self.source(element, elements, states)? {
            Source::Column(numbers) => numbers.get(state),
            Source::Strided(numbers, apart) => numbers.get(state * apart),
        }
    }
}

impl<'a, T, const N: usize> From<&'a [[T; N]]> for Array<'a, T> {
    /// Converts states that are arrays.
    fn from(states: &'a [[T; N]]) -> Self {
        Self::Rows(states.as_flattened())
    }
}

impl<'a, T, const N: usize, const STATES: usize> From<&'a [[T; N]; STATES]> for Array<'a, T> {
    /// Converts states that are arrays.
    fn from(states: &'a [[T; N]; STATES]) -> Self {
        Self::Rows(states.as_flattened())
    }
}

impl<'a, T, const N: usize> From<&'a Vec<[T; N]>> for Array<'a, T> {
    /// Converts states that are arrays.
    fn from(states: &'a Vec<[T; N]>) -> Self {
        Self::Rows(states.as_flattened())
    }
}

fn strided<T>(numbers: &[T], start: usize, stride: usize) -> Source<'_, T> {
    let numbers = numbers.get(start..).unwrap_or_default();
    if stride == 1 { Source::Column(numbers) } else { Source::Strided(numbers, stride) }
}

macro_rules! arguments {
    ($(
        $name:ident: $argument:ident, $owner:ident [$($quantity:ident * $count:literal),*], $about:literal;
    )*) => {
        /// The arguments of a function, by name. Arguments that the function does not take may be given; they are not
        /// read.
        ///
        /// ```
        /// use rne_machine::{Arguments, Array};
        ///
        /// let q = [0.1, 0.2, 0.3, 0.4]; // two states of two joints
        /// let arguments = Arguments::new().q(Array::Rows(&q)).qd(Array::Same(&[0.0, 0.0]));
        /// // states that are arrays
        /// let states = vec![[0.1, 0.2], [0.3, 0.4]];
        /// let of_arrays = Arguments::new().q(&states).qd(&[[0.0, 0.0], [0.1, 0.1]]);
        /// # let _: [Arguments<'_, f64>; 2] = [arguments, of_arrays];
        /// ```
        #[derive(Clone, Copy, Debug)]
        pub struct Arguments<'a, T> {
            arrays: [Option<Array<'a, T>>; ARGUMENTS.len()],
        }

        /// The places of the arguments in `arrays`.
        #[allow(non_camel_case_types)] // the variants have the names of the arguments
        enum Place { $($name,)* parameters }

        impl<'a, T> Arguments<'a, T> {
            $(#[doc = $about]
            #[must_use]
            pub fn $name(self, $name: impl Into<Array<'a, T>>) -> Self {
                self.with_array(Place::$name as usize, $name.into())
            })*

            /// The parameters of the robot file that are known at run time only, in their order.
            #[must_use]
            pub fn parameters(self, parameters: impl Into<Array<'a, T>>) -> Self {
                self.with_array(Place::parameters as usize, parameters.into())
            }
        }

        /// The names of all arguments.
        pub const ARGUMENTS: &[&str] = &[$(stringify!($name),)* "parameters"];
    };
}

rne_codegen::argument_parts!(arguments);

impl<'a, T> Arguments<'a, T> {
    /// Returns a list without any argument.
    #[must_use]
    pub const fn new() -> Self {
        Self { arrays: [const { None }; ARGUMENTS.len()] }
    }

    fn with_array(mut self, place: usize, array: Array<'a, T>) -> Self {
        self.arrays[place] = Some(array);
        self
    }

    /// Sets the argument with a name; `None` if there is no such argument.
    #[must_use]
    pub fn with(self, name: &str, array: Array<'a, T>) -> Option<Self> {
        place(name).map(|place| self.with_array(place, array))
    }

    /// Sets the argument of a part of the table of arguments.
    pub(crate) fn of_part(self, part: &ArgumentPart, array: Array<'a, T>) -> Self {
        self.with_array(part.place, array)
    }

    /// Returns the argument at a place in the list.
    pub(crate) fn at(&self, place: usize) -> Option<&Array<'a, T>> {
        self.arrays.get(place)?.as_ref()
    }
}

/// Returns the place of the argument with a name among all arguments.
pub(crate) fn place(name: &str) -> Option<usize> {
    ARGUMENTS.iter().position(|argument| *argument == name)
}

impl<T> Default for Arguments<'_, T> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_an_array_that_reaches_too_far_has_nothing() {
        let numbers = [1.0, 2.0, 3.0];
        for element in [usize::MAX, usize::MAX / 2] {
            let part = Array::Strided { numbers: &numbers, state: 1, element }.part(6, 3..6);
            assert!(part.source(0, 3, 1).is_none(), "{part:?}");
        }
        let part = Array::Strided { numbers: &numbers, state: 0, element: 1 }.part(3, 1..3);
        assert_eq!(part.number(1, 2, 0, 1), Some(&3.0));
    }
}
