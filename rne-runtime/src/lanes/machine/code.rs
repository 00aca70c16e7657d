//! Code of the machine: three-address instructions on slots and an accumulator.

use core::fmt;

/// An index of the machine's memory, which has one value for each state of a block.
pub type Slot = u32;

/// Not a slot: the value is not stored.
pub const NOWHERE: Slot = Slot::MAX;

/// One instruction: an operation that sets the accumulator, and the slot in which its result is stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instruction {
    /// The operation to perform.
    pub operation: Operation,
    /// The slot in which the accumulator is stored afterwards; [`NOWHERE`] if only the next instruction needs it.
    pub store: Slot,
}

/// Calls a macro with all arithmetic operations. Each has its formula, its name with slots and constant, its text, and
/// the expression of its value, where `acc` is the accumulator.
macro_rules! arithmetic {
    ($of:ident) => {
        $of! {
            acc;
            /// k
            Constant(; k) "{k:?}" => k,
            /// x
            CopyS(x;) "s{x}" => x,
            /// -x
            NegativeS(x;) "-s{x}" => -x,
            /// -acc
            NegativeA(;) "-acc" => -acc,
            /// x + y
            SumSS(x, y;) "s{x} + s{y}" => x + y,
            /// acc + y
            SumAS(y;) "acc + s{y}" => acc + y,
            /// x + k
            SumSK(x; k) "s{x} + {k:?}" => x + k,
            /// acc + k
            SumAK(; k) "acc + {k:?}" => acc + k,
            /// x - y
            DifferenceSS(x, y;) "s{x} - s{y}" => x - y,
            /// acc - y
            DifferenceAS(y;) "acc - s{y}" => acc - y,
            /// x - acc
            DifferenceSA(x;) "s{x} - acc" => x - acc,
            /// k - y
            DifferenceKS(y; k) "{k:?} - s{y}" => k - y,
            /// k - acc
            DifferenceKA(; k) "{k:?} - acc" => k - acc,
            /// x y
            ProductSS(x, y;) "s{x}*s{y}" => x * y,
            /// acc y
            ProductAS(y;) "acc*s{y}" => acc * y,
            /// x k
            ProductSK(x; k) "s{x}*{k:?}" => x * k,
            /// acc k
            ProductAK(; k) "acc*{k:?}" => acc * k,
            /// x / y
            QuotientSS(x, y;) "s{x}/s{y}" => x / y,
            /// acc / y
            QuotientAS(y;) "acc/s{y}" => acc / y,
            /// x / acc
            QuotientSA(x;) "s{x}/acc" => x / acc,
            /// k / y
            QuotientKS(y; k) "{k:?}/s{y}" => k / y,
            /// k / acc
            QuotientKA(; k) "{k:?}/acc" => k / acc,
            /// acc + x y
            PlusASS(x, y;) "acc + s{x}*s{y}" => acc.plus_product(x, y),
            /// acc + x k
            PlusASK(x; k) "acc + s{x}*{k:?}" => acc.plus_product(x, k),
            /// z + x y
            PlusSSS(z, x, y;) "s{z} + s{x}*s{y}" => z.plus_product(x, y),
            /// z + acc y
            PlusSAS(z, y;) "s{z} + acc*s{y}" => z.plus_product(acc, y),
            /// z + x k
            PlusSSK(z, x; k) "s{z} + s{x}*{k:?}" => z.plus_product(x, k),
            /// z + acc k
            PlusSAK(z; k) "s{z} + acc*{k:?}" => z.plus_product(acc, k),
            /// k + x y
            PlusKSS(x, y; k) "{k:?} + s{x}*s{y}" => k.plus_product(x, y),
            /// k + acc y
            PlusKAS(y; k) "{k:?} + acc*s{y}" => k.plus_product(acc, y),
            /// acc - x y
            MinusASS(x, y;) "acc - s{x}*s{y}" => acc.minus_product(x, y),
            /// z - x y
            MinusSSS(z, x, y;) "s{z} - s{x}*s{y}" => z.minus_product(x, y),
            /// z - acc y
            MinusSAS(z, y;) "s{z} - acc*s{y}" => z.minus_product(acc, y),
            /// k - x y
            MinusKSS(x, y; k) "{k:?} - s{x}*s{y}" => k.minus_product(x, y),
            /// k - acc y
            MinusKAS(y; k) "{k:?} - acc*s{y}" => k.minus_product(acc, y),
            /// x y - acc
            LessASS(x, y;) "s{x}*s{y} - acc" => (-acc).plus_product(x, y),
            /// x k - acc
            LessASK(x; k) "s{x}*{k:?} - acc" => (-acc).plus_product(x, k),
            /// x y - z
            LessSSS(z, x, y;) "s{x}*s{y} - s{z}" => (-z).plus_product(x, y),
            /// acc y - z
            LessSAS(z, y;) "acc*s{y} - s{z}" => (-z).plus_product(acc, y),
            /// x k - z
            LessSSK(z, x; k) "s{x}*{k:?} - s{z}" => (-z).plus_product(x, k),
            /// acc k - z
            LessSAK(z; k) "acc*{k:?} - s{z}" => (-z).plus_product(acc, k),
        }
    };
}
pub(super) use arithmetic;

macro_rules! operations {
    (
        $acc:ident;
        $($(#[$about:meta])* $Operation:ident($($slot:ident),*; $($number:ident)?) $text:literal => $value:expr,)*
    ) => {
        /// New value of the accumulator. The names list the operands from left to right: `A` is the accumulator, `S` a
        /// slot, `K` a constant. A product and a sum are one operation, which is rounded once if the vector unit can do
        /// that.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Operation {
            /// An input, by its index.
            Input(u32),
            /// One of two values, or zero, by the sign of a number. The slots are those of the number, of the value for
            /// a positive number and of the value for a negative one.
            BySign(Slot, Slot, Slot),
            /// The accumulator is written as an output and kept.
            Output(u32),
            $($(#[$about])* $Operation($(operations!(@slot $slot),)* $(operations!(@number $number))?),)*
        }

        impl Operation {
            /// Returns the slots that the operation reads.
            fn slots(&self) -> [Slot; 3] {
                let mut read = [NOWHERE; 3];
                match *self {
                    Self::Input(_) | Self::Output(_) => {}
                    Self::BySign(x, a, b) => read = [x, a, b],
                    $(Self::$Operation($($slot,)* $($number)?) => {
                        let slots: &[Slot] = &[$($slot),*];
                        read[..slots.len()].copy_from_slice(slots);
                        $(let _ = $number;)?
                    })*
                }
                read
            }
        }

        impl fmt::Display for Operation {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match *self {
                    Self::Input(index) => write!(f, "input {index}"),
                    Self::Output(index) => write!(f, "output {index}"),
                    Self::BySign(x, a, b) => write!(f, "s{a} or s{b} by the sign of s{x}"),
                    $(Self::$Operation($($slot,)* $($number)?) => write!(f, $text),)*
                }
            }
        }
    };
    (@slot $slot:ident) => { Slot };
    (@number $number:ident) => { f64 };
}
arithmetic!(operations);

/// The computation of the sine and the cosine of a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turn {
    /// The angle, rad.
    pub angle: Slot,
    /// The slot for its sine; [`NOWHERE`] if nothing uses it.
    pub sine: Slot,
    /// The slot for its cosine; [`NOWHERE`] if nothing uses it.
    pub cosine: Slot,
}

/// A program of the machine. First the angles are computed, then all sines and cosines, then the rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Code {
    pub(super) angles: Vec<Instruction>,
    pub(super) turns: Vec<Turn>,
    pub(super) rest: Vec<Instruction>,
    pub(super) slots: usize,
    pub(super) inputs: usize,
    pub(super) outputs: usize,
}

impl Code {
    /// Creates code for a number of slots, inputs and outputs; `None` if an instruction names one that does not exist,
    /// or if an output is not written exactly once.
    #[must_use]
    pub fn new(
        angles: Vec<Instruction>,
        turns: Vec<Turn>,
        rest: Vec<Instruction>,
        [slots, inputs, outputs]: [usize; 3],
    ) -> Option<Self> {
        let is_slot = |slot: Slot| slot == NOWHERE || (slot as usize) < slots;
        let mut written = vec![0_usize; outputs];
        for Instruction { operation, store } in angles.iter().chain(&rest) {
            match *operation {
                Operation::Input(index) if index as usize >= inputs => return None,
                Operation::Output(index) => *written.get_mut(index as usize)? += 1,
                _ => {}
            }
            if !operation.slots().into_iter().chain([*store]).all(is_slot) {
                return None;
            }
        }
        let are_slots = turns
            .iter()
            .all(|turn| turn.angle != NOWHERE && [turn.angle, turn.sine, turn.cosine].into_iter().all(is_slot));
        let is_each_once = written.iter().all(|times| *times == 1);
        (are_slots && is_each_once).then_some(Self { angles, turns, rest, slots, inputs, outputs })
    }

    /// Returns the number of instructions for a block of states, without sines and cosines.
    #[must_use]
    pub fn instructions(&self) -> usize {
        self.angles.len() + self.rest.len()
    }

    /// Returns the number of slots, that is, of values in memory at the same time.
    #[must_use]
    pub fn slots(&self) -> usize {
        self.slots
    }
}

impl fmt::Display for Instruction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.store != NOWHERE {
            write!(f, "s{} = ", self.store)?;
        }
        write!(f, "acc = {}", self.operation)
    }
}

impl fmt::Display for Turn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let slot = |slot: Slot| if slot == NOWHERE { "_".to_owned() } else { format!("s{slot}") };
        write!(f, "{}, {} = sin_cos({})", slot(self.sine), slot(self.cosine), slot(self.angle))
    }
}

/// Prints one instruction per line.
impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.angles.iter().try_for_each(|instruction| writeln!(f, "{instruction}"))?;
        self.turns.iter().try_for_each(|turn| writeln!(f, "{turn}"))?;
        self.rest.iter().try_for_each(|instruction| writeln!(f, "{instruction}"))
    }
}
