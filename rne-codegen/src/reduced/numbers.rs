//! Constants of a sheet, each kept once with where it came from.

use super::sheet::Ref;
use crate::exact::{Image, Number};

/// How a constant came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// From the robot and the plan.
    Given,
    /// From two others by their places: negative factors and summands are references with a sign.
    Sum(Ref, Ref),
    Product(Ref, Ref),
    /// One over another.
    Inverse(u32),
}

/// Constants, each kept once, none negative.
#[derive(Clone, Debug, Default)]
pub(crate) struct Numbers {
    list: Vec<(Number, Source)>,
    /// Open addressing; never iterated.
    places: Vec<u32>,
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
        self.places.clear();
        self.places.resize(512, 0);
    }

    /// The place of a number that is not negative.
    pub(crate) fn intern(&mut self, number: Number, source: Source) -> u32 {
        if self.list.len() * 2 >= self.places.len() {
            let size = (self.places.len() * 2).max(512);
            self.places.clear();
            self.places.resize(size, 0);
            for at in 0..self.list.len() {
                let slot = self.slot(self.list[at].0.image);
                self.places[slot] = u32::try_from(at + 1).unwrap_or(u32::MAX);
            }
        }
        let slot = self.slot(number.image);
        if self.places[slot] == 0 {
            self.list.push((number, source));
            self.places[slot] = u32::try_from(self.list.len()).unwrap_or(u32::MAX);
        }
        self.places[slot] - 1
    }

    /// Where a value is, or would be.
    fn slot(&self, image: Image) -> usize {
        let mask = self.places.len() - 1;
        let (magnitude, _) = canonical(image);
        let mut slot = value_slot(magnitude, mask);
        while let Some(place) = self.places[slot].checked_sub(1) {
            if canonical(self.list[place as usize].0.image).0 == magnitude {
                break;
            }
            slot = (slot + 1) & mask;
        }
        slot
    }
}

/// An image without its sign, and whether it was the negative one.
pub(crate) fn canonical(image: Image) -> (Image, bool) {
    let negative = image.is_negative();
    (if negative { -image } else { image }, negative)
}

/// Where the search for a value begins in a table.
pub(crate) fn value_slot(image: Image, mask: usize) -> usize {
    #[allow(clippy::cast_possible_truncation)] // any bits serve
    let slot = (image.key() >> 32) as usize;
    slot & mask
}
