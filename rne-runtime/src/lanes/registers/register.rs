//! Registers, written once for all units: their operations, from a table of the units' instructions.

/// Defines a register from functions and expressions of `core::arch`. `odd` is a in lanes in which the integer n is
/// odd, and b in others. `one` has 1 in each lane. `within` is a mask of the lanes whose angle, without its sign, is at
/// most the limit, and `all` tells whether the mask has all lanes; single calls use it. `sign` has -0 in each lane.
macro_rules! register {
    (
        $Register:ident: [$element:ident; $LANES:literal], $lanes:ident, $bits:ident;
        unit $Unit:ty, fused $FUSED:expr, many $MANY:literal;
        splat $splat:ident, $splat_bits:ident;
        operators $add:ident, $sub:ident, $mul:ident, $div:ident;
        plus |$plus_c:ident, $plus_a:ident, $plus_b:ident| $plus:expr;
        minus |$minus_c:ident, $minus_a:ident, $minus_b:ident| $minus:expr;
        bits $and:ident, $xor:ident, $add_bits:ident, $shift:ident::<$PLACES:literal>;
        odd |$n:ident, $one:ident, $a:ident, $b:ident| $odd:expr;
        $(
            within |$angle:ident, $sign:ident, $limit:ident| $within:expr;
            all $both:ident, |$mask:ident| $all:expr;
        )?
    ) => {
        /// A register of numbers.
        #[derive(Clone, Copy)]
        pub struct $Register($lanes);

        impl $Register {
            #[inline(always)]
            fn of_numbers(numbers: [$element; $LANES]) -> Self {
                // SAFETY: both have the same number of bytes, and every pattern of bits is a number.
                Self(unsafe { transmute::<[$element; $LANES], $lanes>(numbers) })
            }

            #[inline(always)]
            fn numbers(self) -> [$element; $LANES] {
                // SAFETY: both have the same number of bytes, and every pattern of bits is a number.
                unsafe { transmute::<$lanes, [$element; $LANES]>(self.0) }
            }

            #[inline(always)]
            fn of_bits(bits: $bits) -> Self {
                // SAFETY: both registers have the same size, and every pattern of bits is a value.
                Self(unsafe { transmute::<$bits, $lanes>(bits) })
            }

            #[inline(always)]
            fn bits(self) -> $bits {
                // SAFETY: both registers have the same size, and every pattern of bits is a value.
                unsafe { transmute::<$lanes, $bits>(self.0) }
            }
        }

        register!(operators $Register, Add::add, $add, Sub::sub, $sub, Mul::mul, $mul, Div::div, $div);

        impl Neg for $Register {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                let sign = Self::splat(-0.0);
                // SAFETY: a register only exists if the processor has its unit; see the head of `registers`.
                Self::of_bits(unsafe { $xor(self.bits(), sign.bits()) })
            }
        }

        impl PartialEq for $Register {
            fn eq(&self, other: &Self) -> bool {
                self.numbers() == other.numbers()
            }
        }

        impl fmt::Debug for $Register {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.numbers().fmt(f)
            }
        }

        impl Lanes for $Register {
            type Element = $element;

            const FUSED: bool = $FUSED;

            const MANY: bool = $MANY;

            #[inline(always)]
            fn splat(element: $element) -> Self {
                // SAFETY: a register is only created if the processor has its unit; see the head of `registers`.
                Self(unsafe { $splat(element) })
            }

            #[inline(always)]
            fn plus_product(self, a: Self, b: Self) -> Self {
                if !Self::FUSED {
                    return self + a * b;
                }
                let ($plus_c, $plus_a, $plus_b) = (self.0, a.0, b.0);
                // SAFETY: a register only exists if the processor has its unit; see the head of `registers`.
                Self(unsafe { $plus })
            }

            #[inline(always)]
            fn minus_product(self, a: Self, b: Self) -> Self {
                if !Self::FUSED {
                    return self - a * b;
                }
                let ($minus_c, $minus_a, $minus_b) = (self.0, a.0, b.0);
                // SAFETY: a register only exists if the processor has its unit; see the head of `registers`.
                Self(unsafe { $minus })
            }

            #[inline(always)]
            fn in_quadrant(rounded: Self, sine: Self, cosine: Self) -> (Self, Self) {
                let ($n, sign) = (rounded.bits(), Self::splat(-0.0).bits());
                // SAFETY: a register only exists if the processor has its unit; see the head of `registers`.
                unsafe {
                    let $one = $splat_bits(1);
                    // not a closure, which would be compiled without the unit's instructions
                    let (sine, cosine) = (
                        {
                            let ($a, $b) = (cosine.0, sine.0);
                            Self($odd)
                        },
                        {
                            let ($a, $b) = (sine.0, cosine.0);
                            Self($odd)
                        },
                    );
                    // the second lowest bit becomes the sign
                    let sign_of_sine = $and($shift::<$PLACES>($n), sign);
                    let sign_of_cosine = $and($shift::<$PLACES>($add_bits($n, $one)), sign);
                    (
                        Self::of_bits($xor(sine.bits(), sign_of_sine)),
                        Self::of_bits($xor(cosine.bits(), sign_of_cosine)),
                    )
                }
            }
        }

        vector!($Register, $Unit, [$element; $LANES], $Register::of_numbers, $Register::numbers);

        $(
            impl Register for $Register {
                const LANES: usize = $LANES;

                #[inline(always)]
                fn padded<const N: usize>(numbers: &[$element; N], start: usize) -> Self {
                    let mut lanes = [0.0; $LANES];
                    for (lane, index) in lanes.iter_mut().zip(start..N) {
                        *lane = numbers[index];
                    }
                    Self::of_numbers(lanes)
                }

                #[inline(always)]
                fn write<const N: usize>(self, numbers: &mut [$element; N], start: usize) {
                    for (lane, index) in self.numbers().into_iter().zip(start..N) {
                        numbers[index] = lane;
                    }
                }

                #[inline(always)]
                fn are_within_limit(angles: &[Self]) -> bool {
                    let (Self($sign), Self($limit)) = (Self::splat(-0.0), Self::splat(LIMIT.into()));
                    let Some((&Self($angle), others)) = angles.split_first() else { return true };
                    // SAFETY: a register only exists if the processor has its unit; see the head of `registers`.
                    unsafe {
                        let mut $mask = $within;
                        for &Self($angle) in others {
                            $mask = $both($mask, $within);
                        }
                        $all
                    }
                }
            }
        )?
    };
    (operators $Register:ident, $($Operator:ident :: $operator:ident, $function:ident),*) => {$(
        impl $Operator for $Register {
            type Output = Self;

            #[inline(always)]
            fn $operator(self, other: Self) -> Self {
                // SAFETY: a register only exists if the processor has its unit; see the head of `registers`.
                Self(unsafe { $function(self.0, other.0) })
            }
        }
    )*};
}
pub(super) use register;
