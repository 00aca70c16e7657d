//! Computes one state: all lanes of a register have its numbers, so that the results have the same bits as among many
//! states.

use super::code::{Code, NOWHERE};
use super::execution::{Port, execute, slots};
use super::many::WIDEST;
use crate::lanes::batch::BatchScalar;
use crate::lanes::batch::vector::{Vector, Work};
use crate::number::sin_cos::{Float, kernel};

/// Returns how many numbers of memory some code needs on the widest unit.
pub(super) const fn memory(code: &Code) -> usize {
    super::execution::memory(code, WIDEST, 1)
}

/// The state of one call, and its arrays.
pub(super) struct One<'a, T> {
    pub(super) code: &'a Code,
    pub(super) memory: &'a mut [T],
    pub(super) inputs: &'a [T],
    pub(super) outputs: &'a mut [T],
}

impl<T: BatchScalar> Work<T> for One<'_, T> {
    #[inline(always)]
    fn run<V: Vector<Element = T>>(self, unit: V::Unit) {
        let Self { code, memory, inputs, outputs } = self;
        let slots = slots::<V, 1>(memory);
        execute::<V, _, 1>(unit, &code.angles, slots, &mut Numbers { inputs, outputs });
        turns::<V>(unit, code, slots);
        execute::<V, _, 1>(unit, &code.rest, slots, &mut Numbers { inputs, outputs });
    }
}

/// Computes the sines and cosines, as many at a time as a register has lanes.
#[inline(always)]
fn turns<V: Vector<Element: BatchScalar>>(unit: V::Unit, code: &Code, slots: &mut [[V::Numbers; 1]]) {
    let lanes = size_of::<V::Numbers>() / size_of::<V::Element>();
    for turns in code.turns.chunks(lanes) {
        let mut angles = V::splat(V::Element::ZERO).store();
        for (lane, turn) in V::each_mut(&mut angles).iter_mut().zip(turns) {
            *lane = V::each(&slots[turn.angle as usize][0])[0];
        }
        let (sines, cosines) = kernel(V::load(unit, &angles));
        let (sines, cosines) = (sines.store(), cosines.store());
        for (lane, turn) in turns.iter().enumerate() {
            let angle = V::each(&angles)[lane];
            let (sine, cosine) = if angle.is_within_limit() {
                (V::each(&sines)[lane], V::each(&cosines)[lane])
            } else {
                angle.std_sin_cos()
            };
            for (slot, value) in [(turn.sine, sine), (turn.cosine, cosine)] {
                if slot != NOWHERE {
                    slots[slot as usize][0] = V::splat(value).store();
                }
            }
        }
    }
}

struct Numbers<'a, T> {
    inputs: &'a [T],
    outputs: &'a mut [T],
}

impl<V: Vector<Element: BatchScalar>> Port<V, 1> for Numbers<'_, V::Element> {
    #[inline(always)]
    fn input(&mut self, index: usize) -> [V; 1] {
        [V::splat(self.inputs[index])]
    }

    #[inline(always)]
    fn output(&mut self, index: usize, [value]: &[V; 1]) {
        self.outputs[index] = V::each(&value.store())[0];
    }
}
