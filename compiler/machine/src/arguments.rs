//! The arguments of many states, in a caller's arrays.

use core::ops::Range;

use rne_codegen::ArgumentPart;
use rne_runtime::machine::Source;

/// An argument of many states: its elements, a number per joint most often, for each of them.
#[derive(Clone, Copy, Debug)]
pub enum Array<'a, T> {
    /// All elements of a state one after the other, then the next state's: `q[state][joint]`. States that are arrays,
    /// such as `states: Vec<[f64; 7]>`, are given as they are: `.q(&states)`.
    Rows(&'a [T]),
    /// One slice per element, and in it one number per state: `q[joint][state]`. It is read fastest.
    Columns(&'a [&'a [T]]),
    /// The elements of every state.
    Same(&'a [T]),
    /// Element `j` of state `s` is at `s * state + j * element`.
    Strided {
        /// The numbers, the first state's first element first.
        numbers: &'a [T],
        /// How far apart states are.
        state: usize,
        /// How far apart elements are.
        element: usize,
    },
}

impl<'a, T> Array<'a, T> {
    /// Some elements of a larger array as an array of its own, such as the force of a wrench.
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

    /// Whether it has that number of elements for each of these states.
    pub(crate) fn has(&self, elements: usize, states: usize) -> bool {
        match *self {
            Array::Columns(columns) => columns.len() == elements && columns.iter().all(|column| column.len() == states),
            // all elements are as far as one
            _ => elements == 0 || self.source(0, elements, states).is_some(),
        }
    }

    /// One element of all states; `elements` is their number per state. `None` when the array is too short.
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

    /// One element of one state; `elements` is their number per state.
    pub(crate) fn number(&self, element: usize, elements: usize, state: usize, states: usize) -> Option<&'a T> {
        match self.source(element, elements, states)? {
            Source::Column(numbers) => numbers.get(state),
            Source::Strided(numbers, apart) => numbers.get(state * apart),
        }
    }
}

impl<'a, T, const N: usize> From<&'a [[T; N]]> for Array<'a, T> {
    /// States that are arrays.
    fn from(states: &'a [[T; N]]) -> Self {
        Self::Rows(states.as_flattened())
    }
}

impl<'a, T, const N: usize, const STATES: usize> From<&'a [[T; N]; STATES]> for Array<'a, T> {
    /// States that are arrays.
    fn from(states: &'a [[T; N]; STATES]) -> Self {
        Self::Rows(states.as_flattened())
    }
}

impl<'a, T, const N: usize> From<&'a Vec<[T; N]>> for Array<'a, T> {
    /// States that are arrays.
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
        /// The arguments of a function, by name. What it does not take may be there and is not read.
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

        /// The places of the arguments.
        #[allow(non_camel_case_types)] // they are called as the arguments
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
    /// Begins without any argument.
    #[must_use]
    pub const fn new() -> Self {
        Self { arrays: [const { None }; ARGUMENTS.len()] }
    }

    fn with_array(mut self, place: usize, array: Array<'a, T>) -> Self {
        self.arrays[place] = Some(array);
        self
    }

    /// The argument of a name; `None` when there is no such argument, and nothing has changed then.
    #[must_use]
    pub fn with(self, name: &str, array: Array<'a, T>) -> Option<Self> {
        place(name).map(|place| self.with_array(place, array))
    }

    /// The argument of a part of the table.
    pub(crate) fn of_part(self, part: &ArgumentPart, array: Array<'a, T>) -> Self {
        self.with_array(part.place, array)
    }

    /// The argument at a place.
    pub(crate) fn at(&self, place: usize) -> Option<&Array<'a, T>> {
        self.arrays.get(place)?.as_ref()
    }
}

/// Where the argument of a name is among all.
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
