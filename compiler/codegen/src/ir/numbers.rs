//! The constants of a graph, each stored once with its origin.

use hashbrown::HashTable;

use super::{Number, Ref, Residue};

/// How a constant was computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// A number from the robot and the plan.
    Given,
    /// The sum of two constants, by their places. The sign of a summand is in its reference.
    Sum(Ref, Ref),
    Product(Ref, Ref),
    /// The inverse of another constant.
    Inverse(u32),
}

/// The list of constants, each stored once and without a negative sign.
#[derive(Clone, Debug, Default)]
pub(crate) struct Numbers {
    list: Vec<(Number, Source)>,
    /// A hash table of places in the list, used for look-ups only.
    known: HashTable<u32>,
}

impl Numbers {
    pub(crate) fn len(&self) -> usize {
        self.list.len()
    }

    pub(crate) fn get(&self, place: u32) -> (Number, Source) {
        self.list[place as usize]
    }

    pub(crate) fn clear(&mut self) {
        self.list.clear();
        self.known.clear();
    }

    /// Returns the place of a number that is not negative, and adds the number if it is new. Numbers with the same
    /// residue, up to sign, are one if `same` says so.
    pub(crate) fn intern(&mut self, number: Number, source: Source, same: impl Fn(Number, Number) -> bool) -> u32 {
        let Self { list, known } = self;
        let is_it = |&place: &u32| same(list[place as usize].0, number);
        if let Some(&place) = known.find(key(number.residue), is_it) {
            return place;
        }
        let place = u32::try_from(list.len()).unwrap_or(u32::MAX);
        list.push((number, source));
        known.insert_unique(key(number.residue), place, |&place| key(list[place as usize].0.residue));
        place
    }
}

/// A residue without its sign, and whether it was the negative one.
pub(crate) fn canonical(residue: Residue) -> (Residue, bool) {
    let negative = residue.is_negative();
    (residue.signed(negative), negative)
}

/// A hash that a residue and its negative share.
pub(crate) fn key(residue: Residue) -> u64 {
    canonical(residue).0.key()
}
