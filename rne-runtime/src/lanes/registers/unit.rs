//! The vector units that an x86 processor may have beyond the compiled target.

use core::mem::{ManuallyDrop, MaybeUninit};
use core::sync::atomic::{AtomicU8, Ordering};

/// A computation on a unit. It is not a closure, so it can always be inlined.
pub(crate) trait Computation {
    type Result;

    /// Computes it, `#[inline(always)]`.
    fn compute(self) -> Self::Result;
}

/// A computation of no more words is handed on in registers: as many as take arguments.
const WORDS: usize = 6;

/// State before the processor was asked for a unit.
const UNKNOWN: u8 = 2;

macro_rules! unit {
    ($(#[$documentation:meta])* $Unit:ident: $($feature:tt)*) => {
        $(#[$documentation])*
        #[derive(Clone, Copy, Debug)]
        pub struct $Unit(());

        impl $Unit {
            /// The unit, if the processor has it. It is asked once; afterwards this reads one byte.
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

            /// Computes with the instructions of the unit.
            #[inline(always)]
            pub(crate) fn vectorize<C: Computation>(self, computation: C) -> C::Result {
                $(#[target_feature(enable = $feature)])*
                #[inline]
                fn in_memory<C: Computation>(computation: C) -> C::Result {
                    computation.compute()
                }

                // A value of more than two words is handed on in memory; this one saves a short computation the way
                // there and back.
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
                    // SAFETY: these are the words of a computation that the one caller has given away.
                    ManuallyDrop::into_inner(unsafe { words.computation }).compute()
                }

                if const { size_of::<C>() > size_of::<[usize; WORDS]>() } {
                    // SAFETY: the processor has the unit, for `self` is the proof.
                    return unsafe { in_memory(computation) };
                }
                let mut words = Words::<C> { words: [MaybeUninit::uninit(); WORDS] };
                words.computation = ManuallyDrop::new(computation);
                // SAFETY: any bytes are such words, and the processor has the unit, for `self` is the proof.
                unsafe {
                    let [a, b, c, d, e, f] = words.words;
                    in_words::<C>(a, b, c, d, e, f)
                }
            }
        }
    };
}

/// A computation as the words that it is made of.
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
