//! Sine and cosine as a list of operations, for a compiler that writes them into its code.

use core::cell::RefCell;
use core::marker::PhantomData;
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::VectorUnit;
use crate::lanes::batch::BatchScalar;
use crate::lanes::batch::vector::{Vector, Work};
use crate::number::sin_cos::{Lanes, SQUARE_LIMIT, kernel};

/// The operations by which the machine computes sine and cosine of an angle on a vector unit, both for one number and
/// for many. A program that performs the same operations gets the same bits.
///
/// ```
/// use rne_runtime::VectorUnit;
/// use rne_runtime::machine::Kernel;
///
/// let kernel = Kernel::of::<f64>(VectorUnit::widest());
/// assert!(kernel.sine < kernel.steps.len() && kernel.cosine < kernel.steps.len());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Kernel {
    /// The operations, each on results of earlier ones.
    pub steps: Vec<Step>,
    /// Index of the step whose result is the sine.
    pub sine: usize,
    /// Index of the step whose result is the cosine.
    pub cosine: usize,
    /// Whether the unit rounds [`Step::Plus`] and [`Step::Minus`] once, here and in the machine's instructions.
    /// Otherwise their product is rounded first.
    pub is_fused: bool,
    /// The kernel is correct for angles whose squares have at most this sum, rad². For other angles the machine uses
    /// `std`.
    pub limit_of_squares: f64,
}

/// An operation of the kernel. Its operands are the results of earlier steps, given by their indices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// The angle.
    Angle,
    /// A number, exact in the type of the kernel.
    Constant(f64),
    /// -x
    Negative(usize),
    /// x + y
    Sum(usize, usize),
    /// x - y
    Difference(usize, usize),
    /// x y
    Product(usize, usize),
    /// x / y
    Quotient(usize, usize),
    /// z + x y
    Plus(usize, usize, usize),
    /// z - x y
    Minus(usize, usize, usize),
    /// The sine of x, from three operands: a number whose two lowest bits contain n modulo 4, and the sine and the
    /// cosine of x - n π/2. The lowest bit of n exchanges the two; the second lowest bit negates the result.
    SineInQuadrant([usize; 3]),
    /// The cosine of x, from the same operands; the bit that negates the result is that of n + 1.
    CosineInQuadrant([usize; 3]),
}

impl Kernel {
    /// Returns the kernel of a vector unit.
    #[must_use]
    pub fn of<T: BatchScalar + Into<f64>>(unit: VectorUnit) -> Self {
        let mut kernel =
            Self { steps: Vec::new(), sine: 0, cosine: 0, is_fused: false, limit_of_squares: SQUARE_LIMIT.into() };
        unit.run(Tracing { kernel: &mut kernel, number: PhantomData::<T> });
        kernel
    }
}

/// Records the steps of the kernel: runs it on numbers that remember how they were computed.
struct Tracing<'a, T> {
    kernel: &'a mut Kernel,
    number: PhantomData<T>,
}

impl<T: BatchScalar + Into<f64>> Work<T> for Tracing<'_, T> {
    #[inline(always)]
    fn run<V: Vector<Element = T>>(self, _: V::Unit) {
        STEPS.take();
        let (sine, cosine) = kernel(Traced::<V>::of(Step::Angle));
        self.kernel.steps = STEPS.take();
        (self.kernel.sine, self.kernel.cosine) = (sine.step, cosine.step);
        self.kernel.is_fused = V::FUSED;
    }
}

std::thread_local! {
    /// The steps recorded so far, in a static, because a constant is created without access to any list.
    static STEPS: RefCell<Vec<Step>> = const { RefCell::new(Vec::new()) };
}

/// The index of a step, in place of the register `V` that would have its result.
#[derive(Clone, Copy)]
struct Traced<V> {
    step: usize,
    register: PhantomData<V>,
}

impl<V> Traced<V> {
    fn of(step: Step) -> Self {
        let index = STEPS.with_borrow_mut(|steps| {
            steps.push(step);
            steps.len() - 1
        });
        Self { step: index, register: PhantomData }
    }
}

macro_rules! operators {
    ($($Operator:ident :: $operator:ident, $Step:ident;)*) => {$(
        impl<V> $Operator for Traced<V> {
            type Output = Self;

            fn $operator(self, other: Self) -> Self {
                Self::of(Step::$Step(self.step, other.step))
            }
        }
    )*};
}
operators! {
    Add::add, Sum;
    Sub::sub, Difference;
    Mul::mul, Product;
    Div::div, Quotient;
}

impl<V> Neg for Traced<V> {
    type Output = Self;

    fn neg(self) -> Self {
        Self::of(Step::Negative(self.step))
    }
}

impl<V: Lanes<Element: Into<f64>>> Lanes for Traced<V> {
    type Element = V::Element;

    const FUSED: bool = V::FUSED;

    const MANY: bool = V::MANY;

    fn splat(element: V::Element) -> Self {
        Self::of(Step::Constant(element.into()))
    }

    fn plus_product(self, a: Self, b: Self) -> Self {
        Self::of(Step::Plus(self.step, a.step, b.step))
    }

    fn minus_product(self, a: Self, b: Self) -> Self {
        Self::of(Step::Minus(self.step, a.step, b.step))
    }

    fn in_quadrant(rounded: Self, sine: Self, cosine: Self) -> (Self, Self) {
        let operands = [rounded, sine, cosine].map(|traced| traced.step);
        (Self::of(Step::SineInQuadrant(operands)), Self::of(Step::CosineInQuadrant(operands)))
    }
}
