//! The causes of constants while formulas are written. Each set is stored once, and symbols have its index.

use rustc_hash::FxHashMap;

use super::{Alternatives, Cause, Causes};

/// The index of sets of causes in [`KnownCauses`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct CausesId(u32);

impl CausesId {
    /// The id of the set that contains only the cause `Arithmetic`. It is the first set.
    pub(crate) const ARITHMETIC: Self = Self(0);
}

/// The sets of causes of zeros and ones, each stored once, and their combinations.
pub(crate) struct KnownCauses {
    list: Vec<Alternatives>,
    ids: FxHashMap<Alternatives, CausesId>,
    /// The combination of two sets; the key is `true` if both are needed, `false` if either is enough.
    joined: FxHashMap<(CausesId, CausesId, bool), CausesId>,
}

impl Default for KnownCauses {
    fn default() -> Self {
        let arithmetic = Alternatives::single(Cause::Arithmetic);
        let ids = FxHashMap::from_iter([(arithmetic.clone(), CausesId::ARITHMETIC)]);
        Self { list: vec![arithmetic], ids, joined: FxHashMap::default() }
    }
}

impl KnownCauses {
    pub(crate) fn single(&mut self, cause: Cause) -> CausesId {
        self.id(Alternatives::single(cause))
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

    /// Returns the best set of causes at an index.
    pub(crate) fn get(&self, id: CausesId) -> &Causes {
        self.alternatives(id).best()
    }

    /// The causes of a sum of two zeros.
    pub(crate) fn both(&mut self, a: CausesId, b: CausesId) -> CausesId {
        self.joined((a, b, true), Alternatives::and)
    }

    /// The causes of a product of two zeros.
    pub(crate) fn either(&mut self, a: CausesId, b: CausesId) -> CausesId {
        self.joined((a, b, false), Alternatives::or)
    }

    fn joined(
        &mut self,
        key: (CausesId, CausesId, bool),
        join: fn(&Alternatives, &Alternatives) -> Alternatives,
    ) -> CausesId {
        let (a, b, _) = key;
        if a == b {
            return a;
        }
        if let Some(&known) = self.joined.get(&key) {
            return known;
        }
        let id = self.id(join(self.alternatives(a), self.alternatives(b)));
        self.joined.insert(key, id);
        id
    }
}
