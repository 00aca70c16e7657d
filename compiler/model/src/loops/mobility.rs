//! Checks which joints of closed loops follow from the others, and finds the order in which they are solved for, by the
//! rank of the Jacobian of the equations at configurations that close the loops. No formula that counts links and
//! joints gives this rank: equations may repeat others, such as those perpendicular to the plane of a planar loop.

use crate::loops::closure::{Equations, moving, sorted};
use crate::loops::matrix::{Matrix, elimination, pivots};
use crate::{ClosedLoop, ClosedLoops, Convention, Joint, Pivot};

/// Number of configurations at which the equations are examined, and number of spare ones that replace those where the
/// equations are singular.
pub(crate) const CLOSURES: usize = 20;
pub(crate) const SPARE: usize = 4;
/// A singular value below this part of the largest one counts as zero.
const RANK: f64 = 1e-7;
/// A singular value or a pivot below this part of the largest singular value causes a note.
pub(crate) const NEARLY_SINGULAR: f64 = 1e-3;

/// Why the closed loops of a file cannot be solved.
pub(crate) enum Fault {
    /// No configuration closes this loop: where the loops come nearest to closing, its two places are `apart`, m and
    /// rad.
    Open { index: usize, apart: [f64; 2] },
    /// A group of loops that share joints has another number of dependent joints than its equations determine.
    Count(Box<Count>),
    /// The dependent joints `joints`, of the loop `index` first, can move while all other joints are at rest.
    Undetermined { index: usize, joints: Vec<usize>, singular_values: Vec<f64>, choice: Vec<usize> },
    /// No order of elimination has a usable pivot for each dependent joint at all closures.
    NoOrder,
}

/// Details of a wrong number of dependent joints.
pub(crate) struct Count {
    /// The loops that share joints; the first is the one whose list must be corrected.
    pub(crate) loops: Vec<usize>,
    /// Whether the equations of the first of these loops follow from those of the other loops before it.
    pub(crate) repeats: bool,
    /// The number of dependent joints that the file names for these loops, and the rank of their equations.
    pub(crate) named: usize,
    pub(crate) rank: usize,
    /// The singular values at the first closure, with lengths divided by `size`, m; and the number of closures.
    pub(crate) singular_values: Vec<f64>,
    pub(crate) size: f64,
    pub(crate) closures: usize,
    /// All joints that move these loops and follow no other joint, and a valid choice of dependent ones.
    pub(crate) joints: Vec<usize>,
    pub(crate) choice: Vec<usize>,
}

/// Remarks about loops that can be solved.
pub(crate) struct Remarks {
    /// How many closures were found and how many were wanted, if they are fewer.
    pub(crate) few: Option<(usize, usize)>,
    /// The smallest singular value and the smallest pivot within the limits, relative to the largest singular value,
    /// with the positions of the joints there; only where they are small.
    pub(crate) singular: Option<(f64, Vec<f64>)>,
    pub(crate) pivot: Option<(f64, Vec<f64>)>,
    /// The dependent joints that are hardly determined at this smallest singular value.
    pub(crate) undetermined: Vec<usize>,
    /// Whether all closures that were found are outside the position limits.
    pub(crate) beyond: bool,
    /// Loops that cannot move, because all joints that move them are dependent.
    pub(crate) rigid: Vec<usize>,
    /// The joints that move the loops.
    pub(crate) joints: Vec<usize>,
}

/// Finds how the closed loops are solved: the order of elimination, closures and remarks. The joints must have their
/// couplings already.
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
    // without the factors that make rows and columns free of units: elements in m and rad
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

/// How near to singular the equations of the dependent joints come.
struct Nearness {
    /// The smallest and the largest singular value.
    singular_values: [f64; 2],
    smallest_pivot: f64,
    /// The smallest ratio of the least to the largest singular value, and the positions there; only where it is small.
    singular: Option<(f64, Vec<f64>)>,
    /// The smallest pivot relative to the largest singular value, and the positions there; only where it is small and
    /// `singular` is `None`.
    pivot: Option<(f64, Vec<f64>)>,
    /// The dependent joints that are hardly determined at the positions of `singular`.
    undetermined: Vec<usize>,
}

/// Searches the positions where the equations of the joints `passive` are nearest to singular, beginning at the
/// closures and their Jacobians `matrices`. `at` gives the Jacobian at any positions; `steps` are the steps of its
/// elimination.
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

/// Returns how many of the singular values, which are sorted from the largest on, are not zero.
pub(crate) fn rank(singular: &[(f64, Vec<f64>)]) -> usize {
    let largest = singular.first().map_or(0.0, |(value, _)| *value);
    singular.iter().filter(|(value, _)| *value > RANK * largest).count()
}

/// Returns the joints whose component in a direction of motion is larger than a `part` of the largest component.
fn moved(joints: &[usize], direction: &[f64], part: f64) -> Vec<usize> {
    let largest = direction.iter().map(|it| it.abs()).fold(0.0, f64::max);
    let moves = joints.iter().zip(direction).filter(|(_, it)| it.abs() > part * largest);
    moves.map(|(joint, _)| *joint).collect()
}

/// The Jacobians of the loop equations at all closures.
pub(crate) struct Jacobians<'a> {
    pub(crate) equations: Equations<'a>,
    pub(crate) all: Vec<Matrix>,
    pub(crate) loops: &'a [ClosedLoop],
    pub(crate) joints: &'a [Joint],
}

impl Jacobians<'_> {
    /// Returns the columns of some joints, each with the factor that makes it free of units.
    pub(crate) fn columns_of(&self, joints: &[usize]) -> Vec<(usize, f64)> {
        let columns = self.equations.columns();
        joints.iter().filter_map(|joint| Some(columns[self.equations.variables.binary_search(joint).ok()?])).collect()
    }

    pub(crate) fn rows_of(&self, loops: &[usize]) -> Vec<(usize, f64)> {
        let rows = self.equations.rows();
        loops.iter().flat_map(|&index| rows[self.equations.rows_of(index)].to_vec()).collect()
    }

    /// Returns the rank that the equations of some loops have at most of the closures, and the singular values at one
    /// of them. If two ranks are equally frequent, the larger one counts.
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

    /// Returns groups of loops: loops that share a joint are in one group.
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

    /// Refuses a group of loops whose number of dependent joints is not the rank of their equations.
    fn counted(&self, group: &[usize]) -> Result<(), Fault> {
        let named = |loops: &[usize]| loops.iter().map(|&index| self.loops[index].dependent.len()).sum::<usize>();
        let (rank, singular_values) = self.rank_of(group);
        if named(group) == rank {
            return Ok(());
        }
        // the first loop that names more or fewer dependent joints than it adds independent equations
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

    /// Makes the fault that names the dependent joints that the smallest singular value leaves undetermined.
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
