//! The results of functions, by the rows of the table of results.

use crate::axes::Base;
use crate::entry::Entry;
use crate::table::results;
use crate::{Capability, fixed_base as fixed, floating_base as floating, named};

/// The kinds of recursion in the reduced form. Those of a kind can be written in the same ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recursion {
    /// The torques of a motion.
    Torques,
    /// The torques against gravity, which composite bodies give, too.
    GravityTorques,
    /// The mass matrix.
    MassMatrix,
    /// The accelerations of torques.
    Accelerations,
    /// The derivatives of torques, from the graph of the torques or by composite bodies.
    Derivatives,
    /// Their second derivatives.
    SecondDerivatives,
    /// Other quantities of composite bodies. In the momentum, the first moments behind the joints are gathered.
    CompositeBodies,
}

macro_rules! what {
    ($(
        $(#[$doc:meta])*
        $what:ident $(by $recursion:ident)? = $name:literal $(| $alias:literal)*:
            [$($fixed_trait:ident $($fixed:ident)::+)?] [$($floating_trait:ident $($floating:ident)::+)?];
    )*) => {
        named! {
            /// The result of a function, whatever the base, the load and the loops of the robot.
            What { $($(#[$doc])* $what = $name),* }
        }

        impl What {
            /// Its names in other programs, and at a frame.
            #[must_use]
            pub const fn aliases(self) -> &'static [&'static str] {
                match self {
                    $(Self::$what => &[$($alias),*],)*
                }
            }

            /// The recursion of its reduced form; none where nothing is gathered.
            #[must_use]
            pub const fn recursion(self) -> Option<Recursion> {
                match self {
                    $(Self::$what => [$(Some(Recursion::$recursion),)? None][0],)*
                }
            }

            /// The entry for a base.
            pub(crate) const fn entry(self, base: Base) -> Entry {
                let [fixed, floating] = match self {
                    $(Self::$what => [
                        [$(Some((Capability::$fixed_trait, $($fixed)::+)),)? None][0],
                        [$(Some((Capability::$floating_trait, $($floating)::+)),)? None][0],
                    ],)*
                };
                let found = if matches!(base, Base::Floating) { floating } else { fixed };
                let (capability, entry) = found.expect("an entry for each kind of base");
                Entry { what: self, capability, ..entry }
            }
        }
    };
}

results!(what);

impl What {
    /// The result that has a name in other programs. Capitals, blanks and signs do not count.
    #[must_use]
    pub fn of_alias(name: &str) -> Option<Self> {
        fn letters(text: &str) -> impl Iterator<Item = u8> {
            text.bytes().filter(u8::is_ascii_alphanumeric).map(|letter| letter.to_ascii_lowercase())
        }
        let is_one = |what: &Self| what.aliases().iter().any(|alias| letters(alias).eq(letters(name)));
        Self::ALL.into_iter().find(is_one)
    }
}
