//! Regrouping of inertial parameters: mass on a joint axis can be counted to the link before or after the joint without
//! changing the torques. It is distributed so that as many parameters as possible vanish (the reduced form, section 4).

use rne_model::JointKind::{Prismatic, Revolute};

use crate::ir::{ExactAngle, Number};
use crate::reduced::attitudes::holders;
use crate::reduced::{
    Entry, IDENTITY, JointFrame, JointFrames, OriginShift, Plan, PseudoInertia, RegroupingTarget, Scale, Square, Triple,
};

/// Smallest pivot that is accepted in the three equations for the rods of an axis.
const LEAST_PIVOT: f64 = 1e-5;
/// Largest rod, as a multiple of the arm's own mass and moments.
const LARGEST_ROD: f64 = 1e3;
/// Largest shift of a frame's origin along its axis, as a multiple of the arm's length.
const LONGEST_SLIDE: f64 = 5.0;
/// Allowed range of the scales λ and μ.
const SCALES: std::ops::Range<f64> = 1e-3..1e3;

/// The parameters of an arm under a plan.
#[derive(Clone, Debug)]
pub(crate) struct Parameters {
    pub(crate) links: Vec<PseudoInertia>,
    /// Moments of a floating base, including those that were moved to it from the links on it.
    pub(crate) base: PseudoInertia,
    /// The shift of each frame's origin along its axis.
    pub(crate) origin_shifts: Vec<Number>,
    /// I_zz of a last link that is a spinning sphere without mass.
    pub(crate) sphere: Option<Number>,
    /// λ for each joint, the factor of lengths in the outward pass. All joints after one joint on the base share its λ.
    pub(crate) lambda: Vec<Number>,
    /// μ for each joint, the factor of forces in the inward pass.
    pub(crate) mu: Vec<Number>,
}

/// The choices that a table allows, and the size of the arm.
#[derive(Clone, Debug)]
pub(crate) struct Offers {
    /// For each joint, the rules that give different shifts of its origin.
    pub(crate) origin_shifts: Vec<Vec<(OriginShift, Number)>>,
    /// The different lengths of the table.
    pub(crate) lengths: Vec<Scale>,
    /// Whether the last link is axisymmetric about its joint.
    pub(crate) gyrostat: bool,
    /// Limits of a rod's mass, first and second moment.
    rods: [f64; 3],
}

/// Whether a row's axis is parallel to that of its parent, where both are revolute and the parent is the row before. So
/// a group of parallel axes is a sequence of consecutive rows.
pub(crate) fn is_parallel(rows: &[JointFrame], index: usize) -> bool {
    index > 0
        && rows[index].parent == Some(index - 1)
        && rows[index].kind == Revolute
        && rows[index - 1].kind == Revolute
        && rows[index].alpha.sin.is_zero()
        && rows[index].alpha.cos == Number::ONE
}

/// Returns the last row of the group of parallel axes to which a row belongs.
pub(crate) fn group_end(rows: &[JointFrame], index: usize) -> usize {
    (index + 1..rows.len()).find(|&next| !is_parallel(rows, next)).unwrap_or(rows.len()) - 1
}

/// Returns the first row of the group of parallel axes to which a row belongs.
pub(crate) fn group_start(rows: &[JointFrame], index: usize) -> usize {
    (0..=index).rev().find(|&at| !is_parallel(rows, at)).unwrap_or(0)
}

impl Offers {
    pub(crate) fn new(joint_frames: &JointFrames) -> Self {
        let rows = &joint_frames.rows;
        let reach: f64 = rows.iter().map(|row| length(row.offset) + row.d.to_f64().abs()).sum::<f64>();
        let reach = if reach > 0.0 { reach } else { 1.0 };
        let mass: f64 = rows.iter().map(|row| row.matter.mass.to_f64().abs()).sum();
        let rods = [mass, mass * reach, mass * reach * reach].map(|x| LARGEST_ROD * x);
        let mut offers =
            Self { origin_shifts: Vec::new(), lengths: Vec::new(), gyrostat: has_sphere(joint_frames), rods };
        let plain = Plan::new(rows.len());
        let links = regrouped(joint_frames, &vec![Number::ZERO; rows.len()], &plain, &offers)
            .map_or_else(Vec::new, |(links, ..)| links);
        for (index, row) in rows.iter().enumerate() {
            let mut origin_shifts: Vec<(OriginShift, Number)> = Vec::new();
            for rule in OriginShift::ALL {
                let Some(value) = origin_shift(joint_frames, &links, index, rule) else { continue };
                let is_new = origin_shifts.iter().all(|(_, other)| other.residue != value.residue);
                if is_new && value.to_f64().abs() <= LONGEST_SLIDE * reach {
                    origin_shifts.push((rule, value));
                }
            }
            offers.origin_shifts.push(origin_shifts);
            for (scale, value) in [(Scale::A(index + 1), row.offset[0]), (Scale::D(index + 1), row.d)] {
                let known = offers.lengths.iter().filter_map(|&scale| length_of(rows, scale));
                if !value.is_zero() && !value.is_unit() && !known.map(Number::abs).any(|x| x == value.abs()) {
                    offers.lengths.push(scale);
                }
            }
        }
        offers
    }

    fn origin_shift(&self, index: usize, rule: OriginShift) -> Option<Number> {
        self.origin_shifts.get(index)?.iter().find(|(other, _)| *other == rule).map(|(_, value)| *value)
    }
}

/// Returns the parameters of a table under a plan; `None` if a choice does not apply to it or exceeds the limits.
pub(crate) fn parameters(joint_frames: &JointFrames, offers: &Offers, plan: &Plan) -> Option<Parameters> {
    let origin_shifts =
        plan.joints.iter().enumerate().map(|(index, joint)| offers.origin_shift(index, joint.origin_shift));
    let origin_shifts: Vec<Number> = origin_shifts.collect::<Option<_>>()?;
    let (links, base, sphere) = regrouped(joint_frames, &origin_shifts, plan, offers)?;
    let (lambda, mu) = scales(joint_frames, &links, plan)?.into_iter().unzip();
    Some(Parameters { links, base, origin_shifts, sphere, lambda, mu })
}

/// Returns the links and the base after regrouping, and the inertia of the sphere that remains of the last link.
fn regrouped(
    joint_frames: &JointFrames,
    origin_shifts: &[Number],
    plan: &Plan,
    offers: &Offers,
) -> Option<(Vec<PseudoInertia>, PseudoInertia, Option<Number>)> {
    let rows = &joint_frames.rows;
    let slid = |(row, origin_shift): (&JointFrame, &Number)| {
        if origin_shift.is_zero() { row.matter } else { row.matter.moved([Number::ZERO, Number::ZERO, -*origin_shift]) }
    };
    let mut links: Vec<PseudoInertia> = rows.iter().zip(origin_shifts).map(slid).collect();
    links.push(joint_frames.base.as_ref().map(|base| base.matter).unwrap_or_default());
    let mut sphere = None;
    let mut end = rows.len();
    if plan.gyrostat {
        // a massless sphere with S = c·1 remains; all of it but the spin is moved to the link before
        end -= 1;
        let parent = joint_frames.carrier(end).filter(|_| offers.gyrostat)?;
        let link = links[end];
        let c = link.s[0][0];
        let (p, u) = line(joint_frames, origin_shifts, end);
        links[parent] = links[parent]
            + PseudoInertia::rod([link.mass, link.h[2], link.s[2][2] - c], p, u)
            + PseudoInertia { s: IDENTITY.map(|row| row.map(|x| x * c)), ..PseudoInertia::default() };
        links[end] = PseudoInertia::default();
        sphere = Some(c + c);
    }
    if !plan.regrouped {
        let base = links.pop()?;
        return Some((links, base, sphere));
    }
    let mut links = Links { list: links, holders: holders(joint_frames) };
    for index in 0..end {
        let s = std::mem::take(&mut links.list[index].s);
        links.add(index, PseudoInertia { s, ..PseudoInertia::default() });
    }
    // after the links, a floating base is processed like a link that carries joints
    for index in (0..end).rev().chain(joint_frames.base.as_ref().map(|_| rows.len())) {
        let carried = |kind| {
            let is_carried = move |at: &usize| joint_frames.carrier(*at) == Some(index) && rows[*at].kind == kind;
            (0..end).rev().filter(is_carried)
        };
        for sliding in carried(Prismatic) {
            // a prismatic link turns as the link before, so all its second moments are moved to that
            let s = std::mem::take(&mut links.list[sliding].s);
            links.add(index, PseudoInertia { s, ..PseudoInertia::default() }.turned(&rows[sliding].rotation()));
        }
        share_rods(joint_frames, origin_shifts, plan, offers, &mut links, &carried(Revolute).collect::<Vec<_>>())?;
        match rows.get(index).filter(|_| joint_frames.carrier(index).is_none()).map(|row| row.kind) {
            Some(Prismatic) => links.list[index].s = Square::default(),
            Some(Revolute) => share_rods(joint_frames, origin_shifts, plan, offers, &mut links, &[index])?,
            None => {}
        }
    }
    let mut links = links.list;
    let is_first = |index: usize| joint_frames.carrier(index).is_none() && rows[index].kind == Revolute;
    for (_, first) in links.iter_mut().take(rows.len()).enumerate().filter(|(index, _)| is_first(*index)) {
        // a first link on a fixed base turns only about its axis, so only the inertia about this axis acts
        let about_axis = first.s[0][0] + first.s[1][1];
        first.s = Square::default();
        first.s[0][0] = about_axis;
    }
    let base = links.pop()?;
    Some((links, base, sphere))
}

/// The links while moments are moved between them.
struct Links {
    list: Vec<PseudoInertia>,
    /// For each link, the link to which its second moments are given, and the rotation to the axes of that link.
    holders: Vec<Option<(usize, Square)>>,
}

impl Links {
    /// Adds moments to a link; the second moments go to the link that has those of this link.
    fn add(&mut self, link: usize, matter: PseudoInertia) {
        let PseudoInertia { mass, h, s } = matter;
        let first = PseudoInertia { mass, h, ..PseudoInertia::default() };
        self.list[link] = self.list[link] + first;
        if let Some((holder, s)) = self.second_moments(link, s) {
            self.list[holder] = self.list[holder] + s;
        }
    }

    /// Returns the link that has the second moments of `link`, and `s` turned into its axes; `None` if the link does
    /// not turn.
    fn second_moments(&self, link: usize, s: Square) -> Option<(usize, PseudoInertia)> {
        let (holder, rotation) = self.holders[link]?;
        let s = PseudoInertia { s, ..PseudoInertia::default() };
        Some((holder, if holder == link { s } else { s.turned(&rotation) }))
    }

    /// Returns a moment of a link; a second moment is that of the link that has the second moments.
    fn had(&self, link: usize, entry: Entry) -> Number {
        let holder =
            if entry.is_of_second_moments() { self.holders[link].map(|(holder, _)| holder) } else { Some(link) };
        holder.map_or(Number::ZERO, |holder| self.list[holder].get(entry))
    }

    /// Returns the number that `matter` adds to a moment of a link, or of the link that has its second moments.
    fn given(&self, link: usize, entry: Entry, matter: &PseudoInertia) -> Number {
        if !entry.is_of_second_moments() {
            return matter.get(entry);
        }
        self.second_moments(link, matter.s).map_or(Number::ZERO, |(_, s)| s.get(entry))
    }
}

/// Moves three rods of mass from each of some revolute links to their common parent, so that all target parameters
/// vanish.
fn share_rods(
    joint_frames: &JointFrames,
    origin_shifts: &[Number],
    plan: &Plan,
    offers: &Offers,
    links: &mut Links,
    carried: &[usize],
) -> Option<()> {
    const OWN: [Entry; 3] = [Entry::Mass, Entry::H(2), Entry::S(2, 2)];
    let Some(parent) = carried.first().map(|&link| joint_frames.carrier(link)) else { return Some(()) };
    let lines: Vec<(Triple, Triple)> = carried.iter().map(|&link| line(joint_frames, origin_shifts, link)).collect();
    // one equation for each target: it vanishes
    let mut equations = Vec::with_capacity(3 * carried.len());
    for (place, &link) in carried.iter().enumerate() {
        for (k, target) in plan.joints[link].targets.into_iter().enumerate() {
            let mut equation = vec![Number::ZERO; 3 * carried.len()];
            let constant = if let (Some(entry), Some(parent)) = (target.entry(), parent) {
                for (three, &(p, u)) in equation.chunks_mut(3).zip(&lines) {
                    let rods = IDENTITY.map(|unit| PseudoInertia::rod(unit, p, u));
                    three.copy_from_slice(&rods.map(|rod| -links.given(parent, entry, &rod)));
                }
                links.had(parent, entry)
            } else {
                equation[3 * place + k] = Number::ONE;
                links.list[link].get(OWN[k])
            };
            equation.push(constant);
            equations.push(equation);
        }
    }
    let rods = solved(equations)?;
    for ((&link, rods), (p, u)) in carried.iter().zip(rods.chunks(3)).zip(lines) {
        let rods = [rods[0], rods[1], rods[2]];
        // a link's own parameters can always be moved; the limit on rods does not apply, which also works for an arm
        // without mass
        let is_plain = parent.is_none() || plan.joints[link].targets == [RegroupingTarget::Own; 3];
        if !is_plain && rods.iter().zip(offers.rods).any(|(rod, limit)| rod.to_f64().abs() > limit) {
            return None;
        }
        links.add(link, PseudoInertia::rod(rods.map(|rod| -rod), [Number::ZERO; 3], IDENTITY[2]));
        if let Some(parent) = parent {
            links.add(parent, PseudoInertia::rod(rods, p, u));
        }
    }
    Some(())
}

/// Solves linear equations, each with its constant at the end, by Gauss-Jordan elimination; `None` if a pivot is too
/// small.
fn solved(mut rows: Vec<Vec<Number>>) -> Option<Vec<Number>> {
    let count = rows.len();
    for column in 0..count {
        let size = |row: &[Number]| row[column].to_f64().abs();
        let pivot = (column..count).max_by(|&a, &b| size(&rows[a]).total_cmp(&size(&rows[b])).then(b.cmp(&a)))?;
        if size(&rows[pivot]) < LEAST_PIVOT {
            return None;
        }
        rows.swap(column, pivot);
        let scale = rows[column][column].inverse()?;
        rows[column].iter_mut().for_each(|x| *x = *x * scale);
        let pivot = rows[column].clone();
        for row in rows.iter_mut().enumerate().filter(|(other, _)| *other != column).map(|(_, row)| row) {
            let factor = row[column];
            if !factor.is_zero() {
                for (x, p) in row.iter_mut().zip(&pivot).skip(column) {
                    *x = *x - factor * *p;
                }
            }
        }
    }
    rows.iter().map(|row| row.last().copied()).collect()
}

/// Returns the axis of a row in axes of its parent: the origin of its frame, and its direction.
fn line(joint_frames: &JointFrames, origin_shifts: &[Number], index: usize) -> (Triple, Triple) {
    let row = &joint_frames.rows[index];
    let u = row.along_axis(Number::ONE);
    let before = row.parent.map_or(Number::ZERO, |parent| origin_shifts[parent]);
    let d = if joint_frames.carrier(index).is_none() { Number::ZERO } else { row.d + origin_shifts[index] };
    let [x, y, z] = row.offset;
    ([x + d * u[0], y + d * u[1], z - before + d * u[2]], u)
}

/// Whether the last link is axisymmetric about a revolute joint.
fn has_sphere(joint_frames: &JointFrames) -> bool {
    let Some(row) = joint_frames.rows.last().filter(|row| row.parent.is_some()) else { return false };
    let PseudoInertia { h, s, .. } = row.matter;
    let vanish = [s[0][0] - s[1][1], s[0][1], s[0][2], s[1][2], h[0], h[1]];
    row.kind == Revolute && row.gyrostats.is_empty() && vanish.iter().all(|x| x.is_zero())
}

/// Returns the shift that a rule gives, computed from the links that are regrouped by default targets.
fn origin_shift(
    joint_frames: &JointFrames,
    links: &[PseudoInertia],
    index: usize,
    rule: OriginShift,
) -> Option<Number> {
    let (rows, is_held) = (&joint_frames.rows, joint_frames.carrier(index).is_none());
    let row = &rows[index];
    if rule == OriginShift::None {
        return Some(Number::ZERO);
    }
    if row.carried || is_held && row.kind == Prismatic {
        return None;
    }
    let ratio = |a: Number, b: Number| Some(a * b.inverse()?);
    let link = links.get(index)?;
    let sum = |range: std::ops::RangeInclusive<usize>| range.fold(Number::ZERO, |sum, at| sum + rows[at].d);
    let is_group = row.kind == Revolute && group_end(rows, index) > index;
    let origin_shift = match rule {
        OriginShift::None => Number::ZERO,
        OriginShift::MinusD => -row.d,
        _ if row.kind == Prismatic => return None,
        OriginShift::AnnulS13 => ratio(link.s[0][2], link.h[0])?,
        OriginShift::AnnulS23 => ratio(link.s[1][2], link.h[1])?,
        OriginShift::GroupInward if is_group => sum(index + 1..=group_end(rows, index)),
        OriginShift::NextOffset if is_group => rows[index + 1].d,
        OriginShift::NextLessOwn if is_group => rows[index + 1].d - row.d,
        OriginShift::GroupOutward if is_parallel(rows, index) || is_group => -sum(group_start(rows, index)..=index),
        OriginShift::AnnulParentH if row.gamma == ExactAngle::NONE => {
            let [x, y, _] = links.get(row.parent?)?.h;
            ratio(-(y * row.offset[0]), x * row.alpha.sin)? - row.d
        }
        _ => return None,
    };
    (!is_held || rule != OriginShift::MinusD).then_some(origin_shift)
}

fn length(v: Triple) -> f64 {
    v.iter().map(|x| x.to_f64() * x.to_f64()).sum::<f64>().sqrt()
}

fn length_of(rows: &[JointFrame], scale: Scale) -> Option<Number> {
    match scale {
        Scale::A(row) => Some(rows.get(row.checked_sub(1)?)?.offset[0]),
        Scale::D(row) => Some(rows.get(row.checked_sub(1)?)?.d),
        _ => None,
    }
}

/// Returns λ and μ of each joint: those of the arm, or those of the joint on the base that carries it. `None` if they
/// exceed their bounds, or if a joint that is not on the base has its own.
fn scales(joint_frames: &JointFrames, links: &[PseudoInertia], plan: &Plan) -> Option<Vec<(Number, Number)>> {
    let rows = &joint_frames.rows;
    let of_arm = scale(rows, links, plan.length_scale, plan.force_scale)?;
    let mut scales: Vec<(Number, Number)> = Vec::with_capacity(rows.len());
    for (row, joint) in rows.iter().zip(&plan.joints) {
        let is_plain = (joint.length_scale, joint.force_scale) == (Scale::Default, Scale::Default);
        scales.push(match row.parent {
            Some(parent) if is_plain => scales[parent],
            // all joints on a floating base form one branch, with the scales of the arm
            None if is_plain || joint_frames.base.is_some() => of_arm,
            None => scale(rows, links, joint.length_scale, joint.force_scale)?,
            Some(_) => return None,
        });
    }
    Some(scales)
}

/// Returns λ and μ for two choices; `None` if they exceed their bounds.
fn scale(rows: &[JointFrame], links: &[PseudoInertia], lengths: Scale, forces: Scale) -> Option<(Number, Number)> {
    let first_moment = |link: usize, axis: usize| Some(links.get(link.checked_sub(1)?)?.h.get(axis)?.abs());
    let lambda = match lengths {
        Scale::Default | Scale::One => Number::ONE,
        // the scale makes |h| / λ = 1 in the moments
        Scale::FirstMoment(link, axis) => first_moment(link, axis)?,
        Scale::Mass(_) => return None,
        scale => length_of(rows, scale)?.abs().inverse()?,
    };
    let mu = match forces {
        Scale::Default => lambda.inverse()?,
        Scale::One => Number::ONE,
        // the scale makes μ |h| = 1 in the forces
        Scale::FirstMoment(link, axis) => first_moment(link, axis)?.inverse()?,
        // the scale makes m μ / λ = 1
        Scale::Mass(link) => lambda * links.get(link.checked_sub(1)?)?.mass.abs().inverse()?,
        scale => length_of(rows, scale)?.abs(),
    };
    let within = |scale: Number| SCALES.contains(&scale.to_f64());
    (within(lambda) && within(mu)).then_some((lambda, mu))
}
