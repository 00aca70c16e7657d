//! A choice of dependent joints, for closed loops of a description that does not name them.

use crate::loops::closure::{Equations, moving, sorted};
use crate::loops::matrix::{Matrix, elimination};
use crate::loops::mobility::{CLOSURES, Jacobians, SPARE};
use crate::{ClosedLoop, Convention, Joint};

/// Whether a description gives a joint a motor. A joint that comes earlier here is rather dependent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Actuation {
    /// It has none.
    None,
    /// The description does not say.
    Unknown,
    /// It has one.
    Motor,
}

/// The reason why no joints of closed loops can be dependent.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum NoDependents {
    /// No configuration closes this loop: at these positions of all joints, where the loops come nearest to it, its
    /// places are so far apart, m and rad.
    Open {
        /// The loop, counted from 0.
        index: usize,
        /// The distance of its places, m, and the angle between their axes, rad.
        apart: [f64; 2],
        /// Positions of all joints, rad or m.
        positions: Vec<f64>,
    },
    /// The equations of this loop, counted from 0, follow from those of the loops before it.
    Repeats(usize),
    /// The joints that move this loop, counted from 0, cannot move at all.
    Rigid(usize),
    /// The loops are singular at all configurations that close them: this is the first of them, counted from 0.
    Singular(usize),
}

/// Gives each loop a list `dependent`, for joints of which `actuation` says whether they have motors: as many as the
/// equations determine, joints without motors first. Returns the joints that move the loops and are not dependent.
///
/// # Errors
/// When no choice makes a mechanism that moves.
pub fn choose_dependents(
    joints: &[Joint],
    convention: Convention,
    loops: &mut [ClosedLoop],
    actuation: &[Actuation],
) -> Result<Vec<usize>, NoDependents> {
    let equations = Equations::new(joints, convention, loops);
    let (closures, nearest) = equations.closures(CLOSURES + SPARE);
    if closures.is_empty() {
        let (index, apart) = equations.farthest(&nearest);
        return Err(NoDependents::Open { index, apart, positions: nearest });
    }
    let all = closures.iter().map(|positions| equations.jacobian(positions)).collect();
    let unnamed = loops.to_vec();
    let found = Jacobians { equations, all, loops: &unnamed, joints };
    let mut rest = Vec::new();
    for group in found.groups() {
        let movers = sorted(group.iter().flat_map(|&index| moving(joints, &unnamed[index])).collect());
        let rank = found.rank_of(&group).0;
        // the equations that each loop adds to those before it
        let ranks: Vec<usize> = (0..=group.len()).map(|place| found.rank_of(&group[..place]).0).collect();
        let adds: Vec<usize> = ranks.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).collect();
        if let Some(place) = adds.iter().position(|added| *added == 0) {
            return Err(NoDependents::Repeats(group[place]));
        }
        if rank >= movers.len() {
            return Err(NoDependents::Rigid(group[0]));
        }
        let level = |joint: &usize| actuation.get(*joint).copied().unwrap_or(Actuation::Unknown);
        let levels = [Actuation::None, Actuation::Unknown, Actuation::Motor];
        let chosen = levels.into_iter().find_map(|most| {
            let among: Vec<usize> = movers.iter().copied().filter(|joint| level(joint) <= most).collect();
            found.chosen(&group, &among, rank, |joint| level(&joint) < most)
        });
        let Some(chosen) = chosen else { return Err(NoDependents::Singular(group[0])) };
        rest.extend(movers.into_iter().filter(|joint| !chosen.contains(joint)));
        share(joints, loops, (&group, &adds), &chosen);
    }
    Ok(sorted(rest))
}

impl Jacobians<'_> {
    /// A choice of `rank` dependent joints of some loops among others, where they determine these; `preferred` come
    /// first.
    fn chosen(
        &self,
        loops: &[usize],
        among: &[usize],
        rank: usize,
        preferred: impl Fn(usize) -> bool,
    ) -> Option<Vec<usize>> {
        let (rows, columns) = (self.rows_of(loops), self.columns_of(among));
        let parts = self.all.iter().map(|jacobian| jacobian.part(&rows, &columns));
        let is_regular = |part: &Matrix| crate::loops::mobility::rank(&part.singular()) == rank;
        let regular: Vec<Matrix> = parts.filter(is_regular).collect();
        let steps = elimination(&regular, |column| preferred(among[column]));
        let chosen = sorted(steps.iter().map(|step| among[step.1]).collect());
        (chosen.len() == rank).then_some(chosen)
    }
}

/// Names each chosen joint in one loop that it moves: each loop gets as many as it adds equations, as far as that is
/// possible, and one at least. The loops are solved together, so that the numbers of each do not matter.
fn share(joints: &[Joint], loops: &mut [ClosedLoop], (group, adds): (&[usize], &[usize]), chosen: &[usize]) {
    let moves: Vec<Vec<usize>> = group.iter().map(|&index| moving(joints, &loops[index])).collect();
    // places of the loops, by the places in `chosen`
    let mut of_joint: Vec<Option<usize>> = vec![None; chosen.len()];
    for place in 0..group.len() {
        claim(place, &moves, chosen, &mut of_joint, &mut vec![false; chosen.len()]);
    }
    for at in 0..chosen.len() {
        let has_room = |place: &usize| of_joint.iter().filter(|of| **of == Some(*place)).count() < adds[*place];
        let mut may = (0..group.len()).filter(|&place| moves[place].contains(&chosen[at]));
        let place = of_joint[at].or_else(|| may.clone().find(has_room)).or_else(|| may.next());
        of_joint[at] = place;
        if let Some(place) = place {
            loops[group[place]].dependent.push(chosen[at]);
        }
    }
}

/// Finds a joint of its own for a loop, and other ones for the loops that had it.
fn claim(
    place: usize,
    moves: &[Vec<usize>],
    chosen: &[usize],
    of_joint: &mut [Option<usize>],
    seen: &mut [bool],
) -> bool {
    for at in 0..chosen.len() {
        if seen[at] || !moves[place].contains(&chosen[at]) {
            continue;
        }
        seen[at] = true;
        let is_free = of_joint[at].is_none_or(|other| claim(other, moves, chosen, of_joint, seen));
        if is_free {
            of_joint[at] = Some(place);
            return true;
        }
    }
    false
}
