//! What a robot can compute: one derive and one trait each.

use super::table::{CAPABILITIES, Capability, TABLE};
use crate::function::Function;

impl Capability {
    /// All of them.
    pub const ALL: [Self; CAPABILITIES.len()] = {
        let mut all = [Self::InverseDynamics; CAPABILITIES.len()];
        let mut index = 0;
        while index < all.len() {
            all[index] = CAPABILITIES[index].0;
            index += 1;
        }
        all
    };

    /// The name of its trait.
    #[must_use]
    pub const fn name(self) -> &'static str {
        CAPABILITIES[self as usize].1
    }

    /// The methods of its trait.
    #[must_use]
    pub fn functions(self) -> &'static [Function] {
        let first = TABLE.iter().take_while(|entry| entry.capability != self).count();
        let count = TABLE[first..].iter().take_while(|entry| entry.capability == self).count();
        &ALL_FUNCTIONS[first..first + count]
    }
}

static ALL_FUNCTIONS: [Function; TABLE.len()] = Function::ALL;
