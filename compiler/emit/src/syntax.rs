//! Differences between the languages in which statements are written.

/// The number type of C code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Precision {
    /// `float`, 32 bits.
    #[default]
    Single,
    /// `double`, 64 bits.
    Double,
}

impl Precision {
    /// Both precisions.
    pub const ALL: [Self; 2] = [Self::Single, Self::Double];

    /// Returns the name of the number type in C.
    #[must_use]
    pub const fn c_type(self) -> &'static str {
        match self {
            Self::Single => "float",
            Self::Double => "double",
        }
    }

    /// Returns a number as a literal of C: the shortest one that is read as the same number of this type. `None` if it
    /// is too large.
    pub(super) fn literal(self, value: f64) -> Option<String> {
        match self {
            Self::Double => value.is_finite().then(|| format!("{value:?}")),
            Self::Single => {
                #[allow(clippy::cast_possible_truncation)] // rounded once, as the runtime's `from_f64` rounds
                let value = value as f32;
                value.is_finite().then(|| format!("{value:?}f"))
            }
        }
    }
}

/// The language in which statements and expressions are written.
#[derive(Clone, Copy)]
pub(super) enum Syntax<'a> {
    /// Rust over a trait `Scalar`.
    Rust,
    /// C over a number type; names of functions of the file begin with the prefix.
    C { precision: Precision, prefix: &'a str },
    /// CUDA and C++ over a type `T`.
    Cuda { prefix: &'a str },
}

impl Syntax<'_> {
    /// Returns the words before the name of a value.
    pub(super) fn declaration(self) -> String {
        match self {
            Self::Rust => "let".to_owned(),
            Self::C { precision, .. } => format!("const {}", precision.c_type()),
            Self::Cuda { .. } => "const T".to_owned(),
        }
    }

    /// Returns the constant 0 of an expression.
    pub(super) const fn zero(self) -> &'static str {
        match self {
            Self::Rust => "zero",
            Self::C { precision: Precision::Single, .. } => "0.0f",
            Self::C { precision: Precision::Double, .. } => "0.0",
            Self::Cuda { .. } => "T(0)",
        }
    }

    /// Returns the name of the function that chooses by a sign.
    pub(super) fn by_sign(self) -> String {
        match self {
            Self::Rust => "Scalar::by_sign".to_owned(),
            Self::C { prefix, .. } | Self::Cuda { prefix } => format!("{prefix}_by_sign"),
        }
    }

    /// Returns the name of the function that adds a product with one rounding.
    pub(super) fn mul_add(self) -> String {
        match self {
            Self::Rust => "Scalar::mul_add".to_owned(),
            Self::C { precision: Precision::Single, .. } => "fmaf".to_owned(),
            Self::C { precision: Precision::Double, .. } | Self::Cuda { .. } => "fma".to_owned(),
        }
    }

    /// Whether a product in a sum has parentheses: rule 12.1 of MISRA C asks for them, because readers may not know the
    /// precedence.
    pub(super) const fn groups_products(self) -> bool {
        !matches!(self, Self::Rust)
    }
}

#[cfg(test)]
mod tests {
    use super::Precision;

    #[test]
    fn literals_read_back_as_the_rounded_number() {
        let single = |value| Precision::Single.literal(value);
        assert_eq!(single(0.1).as_deref(), Some("0.1f"));
        assert_eq!(single(2.0).as_deref(), Some("2.0f"));
        assert_eq!(single(-1e-9).as_deref(), Some("-1e-9f"));
        assert_eq!(single(1e-60).as_deref(), Some("0.0f"));
        // if a decimal is rounded twice, to double and then to float, the result can differ from rounding once
        assert_eq!(single(1.000_000_059_604_644_8).as_deref(), Some("1.0f"));
        assert_eq!(single(1.000_000_059_604_645).as_deref(), Some("1.0000001f"));
        assert_eq!(single(3.4e38).as_deref(), Some("3.4e38f"));
        assert_eq!(single(3.5e38), None);
        assert_eq!(Precision::Double.literal(3.5e38).as_deref(), Some("3.5e38"));
        assert_eq!(Precision::Double.literal(f64::INFINITY), None);
    }
}
