//! Chooses dependent joints for the closed loops of a robot description that does not name them.

use crate::loops::closure::{Equations, moving, sorted};
use crate::loops::matrix::{Matrix, elimination};
use crate::loops::mobility::{CLOSURES, Jacobians, SPARE};
use crate::{ClosedLoop, Convention, Joint};

/// Whether a description gives a joint a motor. Joints with an earlier value of this list are preferred as dependent
/// joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Actuation {
    /// The joint has no motor.
    None,
    /// The description does not say it.
    Unknown,
    /// The joint has a motor.
    Motor,
}

/// The reason why no joints can be chosen as the dependent joints of closed loops.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum NoDependents {
    /// No configuration closes this loop; the fields say how far open it is where the loops come nearest to closing.
    Open {
        /// The loop, counted from 0.
        index: usize,
        /// The distance between the two places of the loop, m, and the angle between their axes, rad.
        apart: [f64; 2],
        /// The positions of all joints, rad or m, at which the loops come nearest to closing.
        positions: Vec<f64>,
    },
    /// The equations of this loop, counted from 0, follow from those of earlier loops.
    Repeats(usize),
    /// The joints that move this loop, counted from 0, cannot move at all.
    Rigid(usize),
    /// The loops are singular at all configurations that close them: this is the first of these loops, counted from 0.
    Singular(usize),
}

/// Writes the list `dependent` of each loop: as many joints as the equations determine, those without motors first.
/// `actuation` says for each joint whether it has a motor. Returns the joints that move the loops and are not
/// dependent.
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
        // how many independent equations each loop adds to those of the loops before it
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
    /// Chooses `rank` dependent joints for some loops out of the joints `among`, `preferred` ones first; `None` if the
    /// equations determine fewer of them.
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

/// Writes each chosen joint into the list `dependent` of one loop that it moves. Each loop gets at least one joint, and
/// if possible as many as it adds equations; more is not needed, because all loops are solved together.
fn share(joints: &[Joint], loops: &mut [ClosedLoop], (group, adds): (&[usize], &[usize]), chosen: &[usize]) {
    let moves: Vec<Vec<usize>> = group.iter().map(|&index| moving(joints, &loops[index])).collect();
    // for each place in `chosen`, the loop that gets the joint, as its place in `group`
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

/// Finds a joint of its own for a loop, and if needed moves other loops to other joints. Returns whether it succeeded.
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
