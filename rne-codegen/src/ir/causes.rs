//! Causes of constants while formulas are written: each kept once, symbols hold their numbers.

use std::collections::HashMap;

use crate::ir::ledger::{Alternatives, Cause, Causes};

/// The index of [`Causes`] in the trace that knows them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct CausesId(u32);

impl CausesId {
    /// The first: constants that happen to give it.
    pub(crate) const ARITHMETIC: Self = Self(0);
}

/// What numbers are zero or one because of, each kept once, and what they give together.
pub(crate) struct KnownCauses {
    list: Vec<Alternatives>,
    ids: HashMap<Alternatives, CausesId>,
    both: HashMap<(CausesId, CausesId), CausesId>,
    either: HashMap<(CausesId, CausesId), CausesId>,
}

impl Default for KnownCauses {
    fn default() -> Self {
        let arithmetic = Alternatives::one(Cause::Arithmetic);
        let ids = HashMap::from([(arithmetic.clone(), CausesId::ARITHMETIC)]);
        Self { list: vec![arithmetic], ids, both: HashMap::new(), either: HashMap::new() }
    }
}

impl KnownCauses {
    pub(crate) fn one(&mut self, cause: Cause) -> CausesId {
        self.id(Alternatives::one(cause))
    }

    fn id(&mut self, alternatives: Alternatives) -> CausesId {
        if let Some(&known) = self.ids.get(&alternatives) {
            return known;
        }
        let id = CausesId(u32::try_from(self.list.len()).unwrap_or(u32::MAX));
        self.list.push(alternatives.clone());
        self.ids.insert(alternatives, id);
        id
    }

    fn alternatives(&self, id: CausesId) -> &Alternatives {
        &self.list[id.0 as usize]
    }

    /// The best of the alternatives.
    pub(crate) fn get(&self, id: CausesId) -> &Causes {
        self.alternatives(id).best()
    }

    /// Of a sum of two zeros.
    pub(crate) fn both(&mut self, a: CausesId, b: CausesId) -> CausesId {
        if a == b {
            return a;
        }
        if let Some(&known) = self.both.get(&(a, b)) {
            return known;
        }
        let id = self.id(self.alternatives(a).and(self.alternatives(b)));
        self.both.insert((a, b), id);
        id
    }

    /// Of a product of two zeros.
    pub(crate) fn either(&mut self, a: CausesId, b: CausesId) -> CausesId {
        if a == b {
            return a;
        }
        if let Some(&known) = self.either.get(&(a, b)) {
            return known;
        }
        let id = self.id(self.alternatives(a).or(self.alternatives(b)));
        self.either.insert((a, b), id);
        id
    }
}
