//! Images of numbers in two prime fields.

use super::operators;

const BITS: u32 = 61;
const MASK: u64 = (1 << BITS) - 1;
/// 2⁶¹ minus each prime: the primes are 2⁶¹ - 1 and 2⁶¹ - 31.
const BELOW: [u64; 2] = [1, 31];

/// The image of a real number under the two ring homomorphisms into the fields of 2⁶¹ - 1 and 2⁶¹ - 31 elements.
///
/// Sums, products and quotients of numbers have the sums, products and quotients of their images, without rounding. Two
/// different rational functions agree at a random point of one field with a probability below 10⁻¹⁵, of both fields
/// below 10⁻³⁰.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Residue([u64; 2]);

impl Residue {
    /// 0
    pub const ZERO: Self = Self([0, 0]);
    /// 1
    pub(crate) const ONE: Self = Self([1, 1]);
    /// 1/10
    pub(crate) const TENTH: Self = Self([2_075_258_708_292_324_556, 2_075_258_708_292_324_529]);

    /// The image of an integer.
    #[must_use]
    pub const fn integer(value: u64) -> Self {
        Self::residues(value, value)
    }

    /// Makes an image from two integers, each reduced modulo its prime.
    pub(crate) const fn residues(first: u64, second: u64) -> Self {
        Self([first % prime(0), second % prime(1)])
    }

    /// Whether it is the image of zero.
    #[must_use]
    pub fn is_zero(self) -> bool {
        self == Self::ZERO
    }

    /// Whether the image counts as negative. Images have no order; this rule only picks one of x and -x.
    pub(crate) fn is_negative(self) -> bool {
        match self.0 {
            [0, second] => second > MASK / 2,
            [first, _] => first > MASK / 2,
        }
    }

    /// The integer with this image, if there is one that is not negative and below 2⁶⁰.
    pub(crate) fn to_integer(self) -> Option<u64> {
        let [first, second] = self.0;
        (first == second && first < 1 << 60).then_some(first)
    }

    /// The image, negated if `negative`.
    pub(crate) fn signed(self, negative: bool) -> Self {
        if negative { -self } else { self }
    }

    /// A well-mixed hash of 64 bits.
    pub(crate) fn key(self) -> u64 {
        self.0[0].wrapping_mul(0x9E37_79B9_7F4A_7C15)
    }

    /// The image of a value that is chosen by the sign of `x`. A field has no signs, so the image is a hash: it is the
    /// same for the same operands, and its negative if both values are negated.
    pub(crate) fn by_sign([x, positive, negative]: [Self; 3]) -> Self {
        if positive.is_zero() && negative.is_zero() {
            return Self::ZERO;
        }
        let flip = if positive.is_zero() { negative.is_negative() } else { positive.is_negative() };
        if flip {
            return -Self::by_sign([x, -positive, -negative]);
        }
        let mixed = [x, positive, negative]
            .into_iter()
            .flat_map(|residue| residue.0)
            .fold(0x5167_u64, |mixed, residue| (mixed.rotate_left(23) ^ residue).wrapping_mul(0x9E37_79B9_7F4A_7C15));
        Self::residues(mixed ^ (mixed >> 29), mixed.wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 3)
    }

    /// The inverse; `None` when an image is zero.
    #[must_use]
    pub fn inverse(self) -> Option<Self> {
        let [first, second] = self.0;
        (first != 0 && second != 0).then(|| {
            // Fermat: x^(p - 2) = 1/x
            Self([power(first, prime(0) - 2, 0), power(second, prime(1) - 2, 1)])
        })
    }

    /// A square root; `None` unless both images are squares.
    pub(crate) fn sqrt(self) -> Option<Self> {
        Some(Self([root(self.0[0], 0)?, root(self.0[1], 1)?]))
    }
}

const fn prime(field: usize) -> u64 {
    MASK + 1 - BELOW[field]
}

fn add(a: u64, b: u64, field: usize) -> u64 {
    let sum = a + b;
    if sum >= prime(field) { sum - prime(field) } else { sum }
}

/// Reduces x modulo the prime. 2⁶¹ equals `BELOW` in the field, so the upper bits are added after multiplication by it.
fn reduce(x: u128, field: usize) -> u64 {
    let below = u128::from(BELOW[field]);
    let folded = (x & u128::from(MASK)) + (x >> BITS) * below;
    #[allow(clippy::cast_possible_truncation)] // below 2⁶²
    let folded = ((folded & u128::from(MASK)) + (folded >> BITS) * below) as u64;
    if folded >= prime(field) { folded - prime(field) } else { folded }
}

fn multiply(a: u64, b: u64, field: usize) -> u64 {
    reduce(u128::from(a) * u128::from(b), field)
}

fn power(base: u64, mut exponent: u64, field: usize) -> u64 {
    let (mut result, mut square) = (1, base);
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = multiply(result, square, field);
        }
        square = multiply(square, square, field);
        exponent >>= 1;
    }
    result
}

/// A square root modulo the prime of a field, if there is one.
fn root(square: u64, field: usize) -> Option<u64> {
    let p = prime(field);
    let power = |base, exponent| power(base, exponent, field);
    let twos = (p - 1).trailing_zeros();
    let odd = (p - 1) >> twos;
    let non_residue = (2..p).find(|&candidate| power(candidate, (p - 1) / 2) == p - 1)?;
    // the square of `nearly` is `square` times a factor whose order is a power of two
    let nearly = power(square, odd.div_ceil(2));
    let generator = power(non_residue, odd);
    let mut roots = (0..1 << (twos - 1)).map(|exponent| multiply(nearly, power(generator, exponent), field));
    roots.find(|&root| multiply(root, root, field) == square)
}

operators! { Residue:
    a + b => Self([add(a.0[0], b.0[0], 0), add(a.0[1], b.0[1], 1)]);
    -a => {
        let negative = |residue: u64, field: usize| if residue == 0 { 0 } else { prime(field) - residue };
        Self([negative(a.0[0], 0), negative(a.0[1], 1)])
    };
    a - b => a + -b;
    a * b => Self([multiply(a.0[0], b.0[0], 0), multiply(a.0[1], b.0[1], 1)]);
}

#[cfg(test)]
mod tests {
    use super::*;

    const LARGE: Residue = Residue([prime(0) - 2, prime(1) - 2]);

    #[test]
    fn the_moduli_are_prime() {
        // Fermat's test to the first twelve primes decides below 3.3e24 (Sorenson, Webster 2015) in Miller's form
        for field in 0..2 {
            let (p, twos) = (prime(field), (prime(field) - 1).trailing_zeros());
            for witness in [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37] {
                let mut x = power(witness, (p - 1) >> twos, field);
                let passes = x == 1
                    || (0..twos).any(|_| {
                        let last = x == p - 1;
                        x = multiply(x, x, field);
                        last
                    });
                assert!(passes, "{p} to the base {witness}");
            }
        }
    }

    #[test]
    fn arithmetic_is_that_of_a_field() {
        let three = Residue::integer(3);
        assert_eq!(LARGE + three, Residue::ONE);
        assert_eq!(LARGE * LARGE, Residue::integer(4));
        assert_eq!(three - LARGE, Residue::integer(5));
        assert_eq!(-Residue::ZERO, Residue::ZERO);
        for residue in [three, LARGE, Residue::residues(1 << 60, 12_345)] {
            assert_eq!(residue * residue.inverse().unwrap(), Residue::ONE);
            let square = residue * residue;
            let root = square.sqrt().unwrap();
            assert_eq!(root * root, square);
            assert_ne!(residue.is_negative(), (-residue).is_negative());
        }
        assert_eq!(Residue::ZERO.inverse(), None);
        assert_eq!(Residue::TENTH * Residue::integer(10), Residue::ONE);
    }
}
