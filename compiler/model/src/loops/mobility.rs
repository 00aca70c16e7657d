//! The joints of closed loops that follow from the others, and the order in which they are solved for, by the rank of
//! the equations' Jacobian at configurations that close the loops. No formula that counts links and joints gives it:
//! equations may repeat others, as those across the plane of a planar loop do.

use crate::loops::closure::{Equations, moving, sorted};
use crate::loops::matrix::{Matrix, elimination, pivots};
use crate::{ClosedLoop, ClosedLoops, Convention, Joint, Pivot};

/// Configurations at which the equations are looked at, and more in place of those where they are singular.
pub(crate) const CLOSURES: usize = 20;
pub(crate) const SPARE: usize = 4;
/// A singular value below this part of the largest is zero.
const RANK: f64 = 1e-7;
/// A singular value, and a pivot, below this part of the largest is worth a note.
pub(crate) const NEARLY_SINGULAR: f64 = 1e-3;

/// Why the closed loops of a file cannot be solved.
pub(crate) enum Fault {
    /// No configuration closes this loop: where it comes nearest, its places are so far apart, m and rad.
    Open { index: usize, apart: [f64; 2] },
    /// Loops that share joints do not have as many dependent joints as their equations determine.
    Count(Box<Count>),
    /// These dependent joints, of this loop first, can move while all other joints are at rest.
    Undetermined { index: usize, joints: Vec<usize>, singular_values: Vec<f64>, choice: Vec<usize> },
    /// There is no pivot for each dependent joint that is one at all closures.
    NoOrder,
}

/// A wrong number of dependent joints.
pub(crate) struct Count {
    /// The loops that share joints, the one to be mended first.
    pub(crate) loops: Vec<usize>,
    /// Whether the equations of that one follow from those of the loops before it.
    pub(crate) repeats: bool,
    /// Their dependent joints, and the rank of their equations.
    pub(crate) named: usize,
    pub(crate) rank: usize,
    /// The singular values at the first closure, with lengths as parts of `size`, m; how many closures there are.
    pub(crate) singular_values: Vec<f64>,
    pub(crate) size: f64,
    pub(crate) closures: usize,
    /// All joints of these loops that follow no other, and a choice of dependent ones.
    pub(crate) joints: Vec<usize>,
    pub(crate) choice: Vec<usize>,
}

/// Remarks about loops that can be solved.
pub(crate) struct Remarks {
    /// How many closures were found, if they are fewer than looked for.
    pub(crate) few: Option<(usize, usize)>,
    /// The smallest singular value and pivot found within the limits, each as a part of the largest, and where; only
    /// where it is small.
    pub(crate) singular: Option<(f64, Vec<f64>)>,
    pub(crate) pivot: Option<(f64, Vec<f64>)>,
    /// The dependent joints that the least singular value moves there.
    pub(crate) undetermined: Vec<usize>,
    /// Whether all configurations that were found are beyond the position limits.
    pub(crate) beyond: bool,
    /// Loops that cannot move: all joints that move them are dependent.
    pub(crate) rigid: Vec<usize>,
    /// The joints that move the loops.
    pub(crate) joints: Vec<usize>,
}

/// Solves the loops of joints that have their couplings.
pub(crate) fn solved(
    joints: &[Joint],
    convention: Convention,
    loops: Vec<ClosedLoop>,
) -> Result<(ClosedLoops, Remarks), Fault> {
    let equations = Equations::new(joints, convention, &loops);
    let (closures, nearest) = equations.closures(CLOSURES + SPARE);
    if closures.is_empty() {
        let (index, apart) = equations.farthest(&nearest);
        return Err(Fault::Open { index, apart });
    }
    let found = Jacobians { equations, all: Vec::new(), loops: &loops, joints };
    let all = closures.iter().map(|positions| found.equations.jacobian(positions)).collect();
    let found = Jacobians { all, ..found };
    found.groups().into_iter().try_for_each(|group| found.counted(&group))?;

    let passive = sorted(loops.iter().flat_map(|closed| closed.dependent.iter().copied()).collect());
    let (rows, columns) = (found.equations.rows(), found.columns_of(&passive));
    let singular = |jacobian: &Matrix| jacobian.part(&rows, &columns).singular();
    let is_regular = |jacobian: &Matrix| rank(&singular(jacobian)) == passive.len();
    let regular = (0..closures.len()).filter(|&index| is_regular(&found.all[index]));
    let regular: Vec<usize> = regular.take(CLOSURES).collect();
    if regular.is_empty() {
        return Err(found.undetermined(&passive, &singular(&found.all[0])));
    }
    // as they are, in m and rad
    let plain = |of: &[(usize, f64)]| of.iter().map(|(index, _)| (*index, 1.0)).collect::<Vec<_>>();
    let (rows, columns) = (plain(&rows), plain(&columns));
    let of_passive = |jacobian: &Matrix| jacobian.part(&rows, &columns);
    let matrices: Vec<Matrix> = regular.iter().map(|&index| of_passive(&found.all[index])).collect();
    let steps = elimination(&matrices, |_| true);
    if steps.len() < passive.len() {
        return Err(Fault::NoOrder);
    }
    let closures: Vec<Vec<f64>> = regular.into_iter().map(|index| closures[index].clone()).collect();
    let equations = &found.equations;
    let at = |positions: &[f64]| of_passive(&equations.jacobian(positions));
    let Nearness { singular_values, smallest_pivot, singular, pivot, undetermined } =
        nearness(equations, (&closures, &matrices), at, &steps, &passive);
    let is_rigid = |group: &Vec<usize>| {
        let mut joints = group.iter().flat_map(|&index| moving(joints, &loops[index]));
        joints.all(|joint| passive.contains(&joint))
    };
    let rigid = found.groups().into_iter().filter(is_rigid).flatten().collect();
    let few = (closures.len() < CLOSURES).then_some((closures.len(), CLOSURES));
    let beyond = !closures.iter().any(|positions| equations.is_within(positions));
    let remarks = Remarks { few, singular, pivot, undetermined, beyond, rigid, joints: equations.variables.clone() };
    let elimination = steps.iter().map(|&(equation, passive, _)| Pivot { equation, passive }).collect();
    Ok((ClosedLoops { loops, passive, elimination, closures, singular_values, smallest_pivot }, remarks))
}

/// How near the equations that determine the dependent joints come to singular ones.
struct Nearness {
    /// The least and the largest singular value.
    singular_values: [f64; 2],
    smallest_pivot: f64,
    /// The least ratio of singular values, where it is small, and the positions there.
    singular: Option<(f64, Vec<f64>)>,
    /// The least pivot, as a part of the largest singular value, where it is small and no such ratio is.
    pivot: Option<(f64, Vec<f64>)>,
    /// The joints that are hardly determined there.
    undetermined: Vec<usize>,
}

/// Looks for the positions where the equations of the joints `passive` come nearest to singular ones, from closures
/// and the equations there. `at` gives the equations at positions, and `steps` are those of their elimination.
fn nearness(
    equations: &Equations,
    (closures, matrices): (&[Vec<f64>], &[Matrix]),
    at: impl Fn(&[f64]) -> Matrix,
    steps: &[(usize, usize, f64)],
    passive: &[usize],
) -> Nearness {
    let kept: Vec<(usize, f64)> = steps.iter().map(|step| (step.0, 1.0)).collect();
    let every: Vec<(usize, f64)> = (0..passive.len()).map(|column| (column, 1.0)).collect();
    let of_kept = |matrix: &Matrix| {
        let values = matrix.part(&kept, &every).singular();
        [values.last(), values.first()].map(|value| value.map_or(0.0, |(value, _)| *value))
    };
    let least_pivot =
        |positions: &[f64]| pivots(&at(positions), steps).into_iter().map(f64::abs).fold(f64::INFINITY, f64::min);
    let ratio = |positions: &[f64]| {
        let [least, largest] = of_kept(&at(positions));
        least / largest
    };
    let singular = equations.least(closures, ratio);
    let pivot = equations.least(closures, least_pivot);
    let worst = singular.iter().map(|(_, positions)| of_kept(&at(positions)));
    let singular_values = matrices
        .iter()
        .map(of_kept)
        .chain(worst)
        .fold([f64::INFINITY, 0.0], |known, found| [known[0].min(found[0]), known[1].max(found[1])]);
    let at_closures = steps.iter().map(|step| step.2).fold(f64::INFINITY, f64::min);
    let smallest_pivot = pivot.iter().map(|(pivot, _)| *pivot).fold(at_closures, f64::min);
    let singular = singular.filter(|(ratio, _)| *ratio < NEARLY_SINGULAR);
    let pivot = pivot
        .map(|(pivot, positions)| (pivot / singular_values[1], positions))
        .filter(|(ratio, _)| *ratio < NEARLY_SINGULAR && singular.is_none());
    let undetermined = singular.iter().flat_map(|(_, positions)| {
        let values = at(positions).part(&kept, &every).singular();
        moved(passive, values.last().map_or(&[], |(_, direction)| direction), 0.3)
    });
    let undetermined = undetermined.collect();
    Nearness { singular_values, smallest_pivot, singular, pivot, undetermined }
}

/// How many singular values, the largest first, are not zero.
pub(crate) fn rank(singular: &[(f64, Vec<f64>)]) -> usize {
    let largest = singular.first().map_or(0.0, |(value, _)| *value);
    singular.iter().filter(|(value, _)| *value > RANK * largest).count()
}

/// The joints that a direction moves by more than a part of the largest motion.
fn moved(joints: &[usize], direction: &[f64], part: f64) -> Vec<usize> {
    let largest = direction.iter().map(|it| it.abs()).fold(0.0, f64::max);
    let moves = joints.iter().zip(direction).filter(|(_, it)| it.abs() > part * largest);
    moves.map(|(joint, _)| *joint).collect()
}

/// The Jacobians at all closures.
pub(crate) struct Jacobians<'a> {
    pub(crate) equations: Equations<'a>,
    pub(crate) all: Vec<Matrix>,
    pub(crate) loops: &'a [ClosedLoop],
    pub(crate) joints: &'a [Joint],
}

impl Jacobians<'_> {
    /// The columns of some joints, with their units.
    pub(crate) fn columns_of(&self, joints: &[usize]) -> Vec<(usize, f64)> {
        let columns = self.equations.columns();
        joints.iter().filter_map(|joint| Some(columns[self.equations.variables.binary_search(joint).ok()?])).collect()
    }

    pub(crate) fn rows_of(&self, loops: &[usize]) -> Vec<(usize, f64)> {
        let rows = self.equations.rows();
        loops.iter().flat_map(|&index| rows[self.equations.rows_of(index)].to_vec()).collect()
    }

    /// The rank of the equations of some loops at most closures, of equally many the larger one, and the singular
    /// values where it is that.
    pub(crate) fn rank_of(&self, loops: &[usize]) -> (usize, Vec<f64>) {
        let (rows, columns) = (self.rows_of(loops), self.equations.columns());
        let found: Vec<_> =
            self.all.iter().take(CLOSURES).map(|jacobian| jacobian.part(&rows, &columns).singular()).collect();
        let ranks: Vec<usize> = found.iter().map(|singular| rank(singular)).collect();
        let times = |of: usize| ranks.iter().filter(|rank| **rank == of).count();
        let most = ranks.iter().copied().max_by_key(|&rank| (times(rank), rank)).unwrap_or(0);
        let values = found.iter().zip(&ranks).find(|(_, rank)| **rank == most);
        (most, values.map_or_else(Vec::new, |(values, _)| values.iter().map(|(value, _)| *value).collect()))
    }

    /// The loops in groups that share joints.
    pub(crate) fn groups(&self) -> Vec<Vec<usize>> {
        let mut groups: Vec<(Vec<usize>, Vec<usize>)> = Vec::new();
        for index in 0..self.loops.len() {
            let mut own = (vec![index], moving(self.joints, &self.loops[index]));
            let (shared, rest): (Vec<_>, Vec<_>) =
                groups.into_iter().partition(|(_, joints)| joints.iter().any(|joint| own.1.contains(joint)));
            for (loops, joints) in shared {
                own.0.extend(loops);
                own.1.extend(joints);
            }
            own.0.sort_unstable();
            groups = rest;
            groups.push(own);
        }
        groups.into_iter().map(|(loops, _)| loops).collect()
    }

    /// Refuses a group of loops with a wrong number of dependent joints.
    fn counted(&self, group: &[usize]) -> Result<(), Fault> {
        let named = |loops: &[usize]| loops.iter().map(|&index| self.loops[index].dependent.len()).sum::<usize>();
        let (rank, singular_values) = self.rank_of(group);
        if named(group) == rank {
            return Ok(());
        }
        // the first loop whose equations add more or less to those before it than it names
        let adds = |place: usize| self.rank_of(&group[..=place]).0 - self.rank_of(&group[..place]).0;
        let wrong = (0..group.len()).find(|&place| adds(place) != named(&group[place..=place])).unwrap_or(0);
        let joints = sorted(group.iter().flat_map(|&index| moving(self.joints, &self.loops[index])).collect());
        let number = singular_values.len().min(joints.len());
        let mut loops = group.to_vec();
        loops.swap(0, wrong);
        Err(Fault::Count(Box::new(Count {
            repeats: adds(wrong) == 0,
            named: named(group),
            rank,
            singular_values: singular_values[..number].to_vec(),
            size: self.equations.size,
            closures: self.all.len().min(CLOSURES),
            choice: self.choice(group, &joints, rank),
            joints,
            loops,
        })))
    }

    /// Chooses as many dependent joints as the equations of some loops determine. None of them has a motor, and joints
    /// that `dependent` names come first. The list is empty if no choice is possible.
    fn choice(&self, loops: &[usize], joints: &[usize], rank: usize) -> Vec<usize> {
        let free: Vec<usize> = joints.iter().copied().filter(|&joint| self.joints[joint].motor.is_none()).collect();
        let (rows, columns) = (self.rows_of(loops), self.columns_of(&free));
        let matrices: Vec<Matrix> = self.all.iter().map(|jacobian| jacobian.part(&rows, &columns)).collect();
        let is_named = |column: usize| self.loops.iter().any(|closed| closed.dependent.contains(&free[column]));
        let steps = elimination(&matrices, is_named);
        let choice = sorted(steps.iter().map(|step| free[step.1]).collect());
        if choice.len() == rank { choice } else { Vec::new() }
    }

    /// The dependent joints that the least singular value moves.
    fn undetermined(&self, passive: &[usize], singular: &[(f64, Vec<f64>)]) -> Fault {
        let direction = singular.last().map_or(&[][..], |(_, direction)| direction);
        let joints = moved(passive, direction, 1e-3);
        let index = self.loops.iter().position(|closed| closed.dependent.iter().any(|it| joints.contains(it)));
        let loops: Vec<usize> = (0..self.loops.len()).collect();
        Fault::Undetermined {
            index: index.unwrap_or(0),
            singular_values: singular.iter().map(|(value, _)| *value).collect(),
            choice: self.choice(&loops, &self.equations.variables, passive.len()),
            joints,
        }
    }
}
