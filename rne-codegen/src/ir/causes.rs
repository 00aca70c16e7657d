//! Causes of constants while formulas are written: each kept once, symbols hold their numbers.

use std::collections::HashMap;

use crate::ir::ledger::{Cause, Causes};

/// The index of [`Causes`] in the trace that knows them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct CausesId(u32);

impl CausesId {
    /// The first: constants that happen to give it.
    pub(crate) const ARITHMETIC: Self = Self(0);
}

/// Causes and their unions, each kept once.
pub(crate) struct KnownCauses {
    list: Vec<Causes>,
    ids: HashMap<Causes, CausesId>,
    unions: HashMap<(CausesId, CausesId), CausesId>,
}

impl Default for KnownCauses {
    fn default() -> Self {
        let arithmetic = Causes::one(Cause::Arithmetic);
        let ids = HashMap::from([(arithmetic, CausesId::ARITHMETIC)]);
        Self { list: vec![arithmetic], ids, unions: HashMap::new() }
    }
}

impl KnownCauses {
    pub(crate) fn one(&mut self, cause: Cause) -> CausesId {
        self.id(Causes::one(cause))
    }

    fn id(&mut self, causes: Causes) -> CausesId {
        let next = CausesId(u32::try_from(self.list.len()).unwrap_or(u32::MAX));
        let id = *self.ids.entry(causes).or_insert(next);
        if id == next {
            self.list.push(causes);
        }
        id
    }

    pub(crate) fn get(&self, id: CausesId) -> Causes {
        self.list[id.0 as usize]
    }

    pub(crate) fn union(&mut self, a: CausesId, b: CausesId) -> CausesId {
        if a == b {
            return a;
        }
        if let Some(&known) = self.unions.get(&(a, b)) {
            return known;
        }
        let id = self.id(self.get(a).and(self.get(b)));
        self.unions.insert((a, b), id);
        id
    }

    /// The weightier of two.
    pub(crate) fn weightier(&self, a: CausesId, b: CausesId) -> CausesId {
        if self.get(b) > self.get(a) { b } else { a }
    }
}
