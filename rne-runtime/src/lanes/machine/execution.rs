//! Executes code for one block of states. The accumulator is some registers, and a slot is the same number of registers
//! in memory.

use super::code::{Code, Instruction, NOWHERE, Operation, Slot, arithmetic};
use crate::Scalar;
use crate::lanes::batch::BatchScalar;
use crate::lanes::batch::vector::Vector;
use crate::number::sin_cos::Float;

/// Reads the inputs of a block and writes its outputs.
pub(super) trait Port<V: Vector, const N: usize> {
    fn input(&mut self, index: usize) -> [V; N];
    fn output(&mut self, index: usize, values: &[V; N]);
}

/// Executes instructions for a block.
#[inline(always)]
pub(super) fn execute<V, P, const N: usize>(
    unit: V::Unit,
    instructions: &[Instruction],
    slots: &mut [[V::Numbers; N]],
    port: &mut P,
) where
    V: Vector<Element: BatchScalar>,
    P: Port<V, N>,
{
    let mut acc = [V::splat(V::Element::ZERO); N];
    for &Instruction { operation, store } in instructions {
        // Loops over registers, written so that the compiler unrolls them.
        macro_rules! operations {
            (
                $acc:ident;
                $($(#[$about:meta])* $Operation:ident($($slot:ident),*; $($k:ident)?) $text:literal => $value:expr,)*
            ) => {
                match operation {
                    Operation::Input(index) => acc = port.input(index as usize),
                    Operation::Output(index) => port.output(index as usize, &acc),
                    Operation::BySign(x, a, b) => {
                        let [x, a, b] = [x, a, b].map(|slot: Slot| &slots[slot as usize]);
                        for i in 0..N {
                            acc[i] = by_sign(unit, &x[i], &a[i], &b[i]);
                        }
                    }
                    $(Operation::$Operation($($slot,)* $($k)?) => {
                        $(let $k = V::splat(V::Element::rounded($k));)?
                        $(let $slot = &slots[$slot as usize];)*
                        for i in 0..N {
                            $(let $slot = V::load(unit, &$slot[i]);)*
                            #[allow(unused_variables)]
                            let $acc = acc[i];
                            acc[i] = $value;
                        }
                    })*
                }
            };
        }
        arithmetic!(operations);
        if store != NOWHERE {
            let slot = &mut slots[store as usize];
            for i in 0..N {
                slot[i] = acc[i].store();
            }
        }
    }
}

/// Computed lane by lane, because only friction needs it.
#[inline(always)]
fn by_sign<V: Vector<Element: BatchScalar>>(unit: V::Unit, x: &V::Numbers, a: &V::Numbers, b: &V::Numbers) -> V {
    let mut chosen = *x;
    let lanes = V::each(x).iter().zip(V::each(a).iter().zip(V::each(b)));
    for (chosen, (&x, (&a, &b))) in V::each_mut(&mut chosen).iter_mut().zip(lanes) {
        *chosen = x.by_sign(a, b);
    }
    V::load(unit, &chosen)
}

/// Returns the slots of a block, in memory of the caller.
#[inline(always)]
pub(super) fn slots<V: Vector, const N: usize>(memory: &mut [V::Element]) -> &mut [[V::Numbers; N]] {
    V::split_mut(memory).0.as_chunks_mut().0
}

/// Returns how many numbers the slots of some code take in memory, for registers with `lanes` lanes.
pub(super) const fn memory(code: &Code, lanes: usize, registers: usize) -> usize {
    code.slots * lanes * registers
}
