//! Assigns statements to cells, one per joint and step, so that a listing by joints and steps defines each value before
//! it is used.
//!
//! A value that two joints share is placed at the joint that asked for it first. If joints follow others or rotors turn
//! with several joints, this is not always the first cell that uses it.

use rustc_hash::FxHashMap;

use crate::ir::{Name, Place, Step};
use crate::program::{SineCosine, Statement};
use crate::values::Values;

/// The place of a cell in a listing: steps 1 to 5 outward, the others inward.
type Order = (bool, isize, usize);

fn order(place: &Place) -> Order {
    let joint = isize::try_from(place.joint).unwrap_or(isize::MAX);
    let is_inward = place.step > Step::ALL[4];
    (is_inward, if is_inward { -joint } else { joint }, place.step as usize)
}

/// Moves statements to other cells if another cell would use them too early. A statement that depends on arguments
/// alone moves to the first cell that uses it; for any other statement, the statements that use it move to its cell. In
/// `statements`, each one comes before its users.
pub(super) fn settle(values: &Values, statements: &mut [Statement], turns: &[SineCosine]) {
    let index: FxHashMap<Name, usize> =
        statements.iter().enumerate().map(|(index, statement)| (statement.name, index)).collect();
    let turned: FxHashMap<Name, Place> =
        turns.iter().flat_map(|turn| turn.sine.iter().chain(&turn.cosine).map(|name| (*name, turn.place))).collect();
    let used: Vec<Vec<Name>> =
        statements.iter().map(|statement| values.defined(statement.value).names().collect()).collect();
    let mut is_early: Vec<bool> = Vec::with_capacity(statements.len());
    for names in &used {
        let is_known = |name: &Name| !turned.contains_key(name) && index.get(name).is_none_or(|&at| is_early[at]);
        let is = names.iter().all(is_known);
        is_early.push(is);
    }
    // a term of several joints has no cell of its own and takes that of its first user
    let is_homeless: Vec<bool> = statements.iter().map(|statement| statement.place.joint == 0).collect();
    // in reverse order, so that users are placed before the statements that they use
    for user in (0..statements.len()).rev() {
        let place = statements[user].place;
        for at in used[user].iter().filter_map(|name| index.get(name)).copied() {
            let old = &mut statements[at].place;
            let is_first = order(&place) < order(old);
            if place.joint > 0 && (is_homeless[at] && (is_first || old.joint == 0) || is_early[at] && is_first) {
                (old.joint, old.step) = (place.joint, place.step);
            }
        }
    }
    for user in 0..statements.len() {
        let before = |name: &Name| turned.get(name).copied().or_else(|| Some(statements[*index.get(name)?].place));
        let last = used[user].iter().filter_map(before).max_by_key(order);
        if let Some(last) = last.filter(|last| order(last) > order(&statements[user].place)) {
            (statements[user].place.joint, statements[user].place.step) = (last.joint, last.step);
        }
    }
}
