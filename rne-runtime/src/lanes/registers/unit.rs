//! The vector units that an x86 processor may have beyond the compiled target.

use core::mem::{ManuallyDrop, MaybeUninit};
use core::sync::atomic::{AtomicU8, Ordering};

/// A computation that runs on a vector unit. It is not a closure, so it can always be inlined.
pub(crate) trait Computation {
    type Result;

    /// Runs the computation. Implementations are `#[inline(always)]`.
    fn compute(self) -> Self::Result;
}

/// A computation of at most this many words is passed in registers: that many registers are for arguments.
const WORDS: usize = 6;

/// The state before the processor was tested for a unit.
const UNKNOWN: u8 = 2;

macro_rules! unit {
    ($(#[$documentation:meta])* $Unit:ident: $($feature:tt)*) => {
        $(#[$documentation])*
        #[derive(Clone, Copy, Debug)]
        pub struct $Unit(());

        impl $Unit {
            /// Returns the unit if the processor has it. The processor is tested once; afterwards this reads one byte.
            #[inline]
            pub(crate) fn try_new() -> Option<Self> {
                static IS_THERE: AtomicU8 = AtomicU8::new(UNKNOWN);

                #[cold]
                #[inline(never)]
                fn ask() -> u8 {
                    let is_there = u8::from($(std::arch::is_x86_feature_detected!($feature))&&*);
                    IS_THERE.store(is_there, Ordering::Relaxed);
                    is_there
                }

                let mut is_there = IS_THERE.load(Ordering::Relaxed);
                if is_there == UNKNOWN {
                    is_there = ask();
                }
                (is_there != 0).then_some(Self(()))
            }

            /// Runs a computation that is compiled with the instructions of the unit.
            #[inline(always)]
            pub(crate) fn vectorize<C: Computation>(self, computation: C) -> C::Result {
                $(#[target_feature(enable = $feature)])*
                #[inline]
                fn in_memory<C: Computation>(computation: C) -> C::Result {
                    computation.compute()
                }

                // A value of more than two words would be passed in memory. Passing it as words spares a short
                // computation the stores and loads.
                $(#[target_feature(enable = $feature)])*
                #[inline]
                fn in_words<C: Computation>(
                    a: MaybeUninit<usize>,
                    b: MaybeUninit<usize>,
                    c: MaybeUninit<usize>,
                    d: MaybeUninit<usize>,
                    e: MaybeUninit<usize>,
                    f: MaybeUninit<usize>,
                ) -> C::Result {
                    let words = Words::<C> { words: [a, b, c, d, e, f] };
                    // SAFETY: these are the words of a computation that the only caller has moved into them.
                    ManuallyDrop::into_inner(unsafe { words.computation }).compute()
                }

                if const { size_of::<C>() > size_of::<[usize; WORDS]>() } {
                    // SAFETY: the processor has the unit, because `self` can only be created after the test.
                    return unsafe { in_memory(computation) };
                }
                let mut words = Words::<C> { words: [MaybeUninit::uninit(); WORDS] };
                words.computation = ManuallyDrop::new(computation);
                // SAFETY: words may have any bytes, and the processor has the unit, because `self` can only be created
                // after the test.
                unsafe {
                    let [a, b, c, d, e, f] = words.words;
                    in_words::<C>(a, b, c, d, e, f)
                }
            }
        }
    };
}

/// The memory of a computation, as a value or as words.
#[repr(C)]
union Words<C> {
    computation: ManuallyDrop<C>,
    words: [MaybeUninit<usize>; WORDS],
}

unit! {
    /// AVX2 and fused multiply-add: x86-64-v3.
    Avx2: "sse" "sse2" "fxsr" "sse3" "ssse3" "sse4.1" "sse4.2" "popcnt" "avx" "avx2" "bmi1" "bmi2" "fma" "lzcnt"
}
unit! {
    /// AVX-512 F, BW, CD, DQ and VL: x86-64-v4.
    Avx512: "sse" "sse2" "fxsr" "sse3" "ssse3" "sse4.1" "sse4.2" "popcnt" "avx" "avx2" "bmi1" "bmi2" "fma" "lzcnt"
        "avx512f" "avx512bw" "avx512cd" "avx512dq" "avx512vl"
}
