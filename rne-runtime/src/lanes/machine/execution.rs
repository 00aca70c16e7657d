//! One block of states through the code: the accumulator is some registers, a slot as many in memory.

use super::code::{Code, Instruction, NOWHERE, Operation, Slot};
use crate::Scalar;
use crate::lanes::batch::BatchScalar;
use crate::lanes::batch::vector::Vector;
use crate::number::sin_cos::Float;

/// Where the inputs of a block come from and its outputs go.
pub(super) trait Port<V: Vector, const N: usize> {
    fn input(&mut self, index: usize) -> [V; N];
    fn output(&mut self, index: usize, values: &[V; N]);
}

/// Runs instructions on a block.
#[inline(always)]
#[allow(clippy::too_many_lines)] // a line per operation
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
        macro_rules! each {
            (|$i:ident| $value:expr) => {
                for $i in 0..N {
                    acc[$i] = $value;
                }
            };
            ($($x:ident: $slot:expr),+; |$i:ident| $value:expr) => {{
                $(let $x = &slots[$slot as usize];)+
                for $i in 0..N {
                    $(let $x = V::load(unit, &$x[$i]);)+
                    acc[$i] = $value;
                }
            }};
        }
        let number = |k: f64| V::splat(V::Element::rounded(k));
        match operation {
            Operation::Input(index) => acc = port.input(index as usize),
            Operation::Output(index) => port.output(index as usize, &acc),
            Operation::BySign(x, a, b) => {
                let [x, a, b] = [x, a, b].map(|slot: Slot| &slots[slot as usize]);
                for i in 0..N {
                    acc[i] = by_sign(unit, &x[i], &a[i], &b[i]);
                }
            }
            Operation::Constant(k) => {
                let k = number(k);
                each!(|i| k);
            }
            Operation::CopyS(x) => each!(x: x; |i| x),
            Operation::NegativeS(x) => each!(x: x; |i| -x),
            Operation::NegativeA() => each!(|i| -acc[i]),
            Operation::SumSS(x, y) => each!(x: x, y: y; |i| x + y),
            Operation::SumAS(y) => each!(y: y; |i| acc[i] + y),
            Operation::SumSK(x, k) => {
                let k = number(k);
                each!(x: x; |i| x + k);
            }
            Operation::SumAK(k) => {
                let k = number(k);
                each!(|i| acc[i] + k);
            }
            Operation::DifferenceSS(x, y) => each!(x: x, y: y; |i| x - y),
            Operation::DifferenceAS(y) => each!(y: y; |i| acc[i] - y),
            Operation::DifferenceSA(x) => each!(x: x; |i| x - acc[i]),
            Operation::DifferenceKS(y, k) => {
                let k = number(k);
                each!(y: y; |i| k - y);
            }
            Operation::DifferenceKA(k) => {
                let k = number(k);
                each!(|i| k - acc[i]);
            }
            Operation::ProductSS(x, y) => each!(x: x, y: y; |i| x * y),
            Operation::ProductAS(y) => each!(y: y; |i| acc[i] * y),
            Operation::ProductSK(x, k) => {
                let k = number(k);
                each!(x: x; |i| x * k);
            }
            Operation::ProductAK(k) => {
                let k = number(k);
                each!(|i| acc[i] * k);
            }
            Operation::QuotientSS(x, y) => each!(x: x, y: y; |i| x / y),
            Operation::QuotientAS(y) => each!(y: y; |i| acc[i] / y),
            Operation::QuotientSA(x) => each!(x: x; |i| x / acc[i]),
            Operation::QuotientKS(y, k) => {
                let k = number(k);
                each!(y: y; |i| k / y);
            }
            Operation::QuotientKA(k) => {
                let k = number(k);
                each!(|i| k / acc[i]);
            }
            Operation::PlusASS(x, y) => each!(x: x, y: y; |i| acc[i].plus_product(x, y)),
            Operation::PlusASK(x, k) => {
                let k = number(k);
                each!(x: x; |i| acc[i].plus_product(x, k));
            }
            Operation::PlusSSS(z, x, y) => each!(z: z, x: x, y: y; |i| z.plus_product(x, y)),
            Operation::PlusSAS(z, y) => each!(z: z, y: y; |i| z.plus_product(acc[i], y)),
            Operation::PlusSSK(z, x, k) => {
                let k = number(k);
                each!(z: z, x: x; |i| z.plus_product(x, k));
            }
            Operation::PlusSAK(z, k) => {
                let k = number(k);
                each!(z: z; |i| z.plus_product(acc[i], k));
            }
            Operation::PlusKSS(x, y, k) => {
                let k = number(k);
                each!(x: x, y: y; |i| k.plus_product(x, y));
            }
            Operation::PlusKAS(y, k) => {
                let k = number(k);
                each!(y: y; |i| k.plus_product(acc[i], y));
            }
            Operation::MinusASS(x, y) => each!(x: x, y: y; |i| acc[i].minus_product(x, y)),
            Operation::MinusSSS(z, x, y) => each!(z: z, x: x, y: y; |i| z.minus_product(x, y)),
            Operation::MinusSAS(z, y) => each!(z: z, y: y; |i| z.minus_product(acc[i], y)),
            Operation::MinusKSS(x, y, k) => {
                let k = number(k);
                each!(x: x, y: y; |i| k.minus_product(x, y));
            }
            Operation::MinusKAS(y, k) => {
                let k = number(k);
                each!(y: y; |i| k.minus_product(acc[i], y));
            }
            Operation::LessASS(x, y) => each!(x: x, y: y; |i| (-acc[i]).plus_product(x, y)),
            Operation::LessASK(x, k) => {
                let k = number(k);
                each!(x: x; |i| (-acc[i]).plus_product(x, k));
            }
            Operation::LessSSS(z, x, y) => each!(z: z, x: x, y: y; |i| (-z).plus_product(x, y)),
            Operation::LessSAS(z, y) => each!(z: z, y: y; |i| (-z).plus_product(acc[i], y)),
            Operation::LessSSK(z, x, k) => {
                let k = number(k);
                each!(z: z, x: x; |i| (-z).plus_product(x, k));
            }
            Operation::LessSAK(z, k) => {
                let k = number(k);
                each!(z: z; |i| (-z).plus_product(acc[i], k));
            }
        }
        if store != NOWHERE {
            let slot = &mut slots[store as usize];
            for i in 0..N {
                slot[i] = acc[i].store();
            }
        }
    }
}

/// Lane by lane: only friction needs it.
#[inline(always)]
fn by_sign<V: Vector<Element: BatchScalar>>(unit: V::Unit, x: &V::Numbers, a: &V::Numbers, b: &V::Numbers) -> V {
    let mut chosen = *x;
    let lanes = V::each(x).iter().zip(V::each(a).iter().zip(V::each(b)));
    for (chosen, (&x, (&a, &b))) in V::each_mut(&mut chosen).iter_mut().zip(lanes) {
        *chosen = x.by_sign(a, b);
    }
    V::load(unit, &chosen)
}

/// The slots of a block, in a caller's memory.
#[inline(always)]
pub(super) fn slots<V: Vector, const N: usize>(memory: &mut [V::Element]) -> &mut [[V::Numbers; N]] {
    V::split_mut(memory).0.as_chunks_mut().0
}

/// Memory of the slots of some code, in numbers, for registers with `lanes` lanes.
pub(super) const fn memory(code: &Code, lanes: usize, registers: usize) -> usize {
    code.slots * lanes * registers
}
