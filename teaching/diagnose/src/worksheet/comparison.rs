//! Compares given values with those of a worksheet.

use std::collections::{BTreeMap, BTreeSet};

use rne_model::Robot;
use rne_runtime::WrongLength;

use super::{Computed, Line, Quantity, ROUNDING, Situation, Worksheet, followed, local, norm, other_axes, slipped};
use crate::{Diagnosis, Observation, diagnose};

/// A value that a person computed for a component of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenValue {
    /// The joint, from 1 at the base.
    pub joint: usize,
    /// The quantity of the line.
    pub quantity: Quantity,
    /// The index of the component in [`Quantity::components`].
    pub component: usize,
    /// The value.
    pub value: f64,
    /// Half a unit of the last written digit; 0 if the value has all digits.
    pub resolution: f64,
}

/// The result of a comparison.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Comparison {
    /// Number of values that were compared.
    pub compared: usize,
    /// Number of values that differ.
    pub differing: usize,
    /// The verdict on each given value, by the index of its line in [`Worksheet::lines`] and its own index.
    pub verdicts: BTreeMap<(usize, usize), Verdict>,
    /// The steps, 1 to 7, without a given value.
    pub steps_not_given: Vec<u8>,
    /// The first value that differs, in the order of computation; `None` if all agree.
    pub first: Option<Difference>,
}

/// A verdict on a given value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The value agrees.
    Right,
    /// The value differs, but it follows by the formula of its line from the given earlier values, and is not zero.
    Followed,
    /// The value differs, and does not follow from the earlier ones.
    Wrong,
}

/// The first value that differs.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Difference {
    /// The index of the line in [`Worksheet::lines`].
    pub line: usize,
    /// The index of the component.
    pub component: usize,
    /// The given value.
    pub theirs: f64,
    /// The right value.
    pub ours: f64,
    /// The reasons that explain the difference, the likeliest first.
    pub reasons: Vec<Reason>,
}

/// An explanation of a difference.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Reason {
    /// The mistake, in a clause.
    pub says: String,
    /// The correction, if it is more than the formula of the line.
    pub right: Option<String>,
    /// How many of the values the reason explains.
    pub reach: Reach,
}

/// The part of the differences that a reason explains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reach {
    /// Every given value.
    Everything,
    /// All given torques.
    Torques,
    /// All given values of this line.
    Line,
    /// This component only.
    Component,
    /// Every given value up to this line, but not all after it.
    UpToHere,
}

/// Largest number of explanations.
const MOST: usize = 4;

/// Largest tolerance because of few written digits, as a part of a line's size. Otherwise a value with one digit would
/// agree with almost anything.
const COARSEST: f64 = 0.05;

impl Worksheet {
    /// Compares given values with those of this worksheet, which is that of `robot` at `at`. A value agrees if its
    /// error is within `digits` significant digits of the largest number in its line, or within the digits with which
    /// it is written. Values of lines that the worksheet does not have are ignored.
    ///
    /// # Errors
    /// When a list of the situation does not have one number per joint.
    pub fn compare(
        &self,
        robot: &Robot,
        at: &Situation,
        given: &[GivenValue],
        digits: u8,
    ) -> Result<Comparison, WrongLength> {
        let given = Ordered::new(self, robot, at, given, digits);
        let verdicts = given.verdicts()?;
        let mut comparison = Comparison {
            compared: given.values.len(),
            differing: verdicts.values().filter(|verdict| **verdict != Verdict::Right).count(),
            verdicts,
            steps_not_given: given.steps_not_given(),
            first: None,
        };
        let first = given.values.iter().find(|(at, _)| !given.agrees(**at, self.value(**at)));
        let Some((&(line, component), value)) = first else { return Ok(comparison) };
        let reasons = given.reasons(line, component)?;
        let (theirs, ours) = (value.value, self.value((line, component)));
        comparison.first = Some(Difference { line, component, theirs, ours, reasons });
        Ok(comparison)
    }

    fn value(&self, (line, component): Place) -> f64 {
        self.lines.get(line).and_then(|line| line.values.get(component)).copied().unwrap_or(f64::NAN)
    }
}

/// The indices of a line and of its component.
pub(super) type Place = (usize, usize);

/// The given values in the order of computation.
struct Ordered<'a> {
    sheet: &'a Worksheet,
    robot: &'a Robot,
    at: &'a Situation,
    values: BTreeMap<Place, GivenValue>,
    digits: u8,
    /// The rounding error of the largest value of each unit.
    rounding: BTreeMap<&'static str, f64>,
}

impl<'a> Ordered<'a> {
    fn new(sheet: &'a Worksheet, robot: &'a Robot, at: &'a Situation, given: &[GivenValue], digits: u8) -> Self {
        let places: BTreeMap<(usize, Quantity), usize> =
            sheet.lines.iter().enumerate().map(|(index, line)| ((line.joint, line.quantity), index)).collect();
        let place = |value: &GivenValue| {
            let line = *places.get(&(value.joint, value.quantity))?;
            Some(((line, value.component), *value)).filter(|_| value.component < value.quantity.components().len())
        };
        let units = sheet.lines.iter().map(Line::unit);
        let rounding = units.map(|unit| (unit, ROUNDING * sheet.largest(unit))).collect();
        Self { sheet, robot, at, values: given.iter().filter_map(place).collect(), digits, rounding }
    }

    /// Returns the tolerance for a calculation by hand that rounds each line to `digits` digits: two units of the last
    /// digit of a number of this size, because rounding errors of earlier lines add up.
    fn by_hand(&self, size: f64) -> f64 {
        2.0 * size * 10_f64.powi(1 - i32::from(self.digits))
    }

    /// Returns the tolerance of the value at a place.
    fn allowed(&self, place: Place) -> f64 {
        self.sheet.lines.get(place.0).map_or(0.0, |line| self.allowed_of(line, place))
    }

    /// Returns the tolerance of the value at a place, computed from another version of its line.
    fn allowed_of(&self, line: &Line, place: Place) -> f64 {
        let size = line.size();
        let written = self.values.get(&place).map_or(0.0, |given| given.resolution.min(COARSEST * size));
        let by_hand = self.by_hand(size);
        let rounding = self.rounding.get(line.unit()).copied().unwrap_or_default();
        by_hand.max(written) + rounding
    }

    /// Whether the given value at a place agrees with `value`; true if none is given.
    fn agrees(&self, place: Place, value: f64) -> bool {
        let Some(given) = self.values.get(&place) else { return true };
        let difference = given.value - value;
        let off = match given.quantity {
            // angles that differ by full turns are equal
            Quantity::Theta => difference - (difference / std::f64::consts::TAU).round() * std::f64::consts::TAU,
            _ => difference,
        };
        off.abs() <= self.allowed(place)
    }

    /// Returns the verdict on each given value. Line by line in the order of computation, each formula is evaluated
    /// with the given earlier values, or with the computed ones if none are given.
    fn verdicts(&self) -> Result<BTreeMap<Place, Verdict>, WrongLength> {
        let of_place = |(place, _): (&Place, _)| {
            (*place, if self.agrees(*place, self.sheet.value(*place)) { Verdict::Right } else { Verdict::Wrong })
        };
        let mut verdicts: BTreeMap<Place, Verdict> = self.values.iter().map(of_place).collect();
        if verdicts.values().all(|verdict| *verdict == Verdict::Right) {
            return Ok(verdicts);
        }
        let computed = Computed::new(self.robot, self.at, self.sheet.axes)?;
        let mut links = computed.links.clone();
        for (index, line) in self.sheet.lines.iter().enumerate() {
            let Some(own) = computed.formulas(self.robot, self.at, &links).by_formula(line.joint, line.quantity) else {
                continue;
            };
            for (component, value) in own.values.iter().enumerate() {
                let place = (index, component);
                let theirs = self.values.get(&place).map(|given| given.value);
                let allowed = self.allowed_of(&own, place);
                let follows = theirs.is_some_and(|theirs| (theirs - value).abs() <= allowed && value.abs() > allowed);
                if let Some(verdict) = verdicts.get_mut(&place).filter(|verdict| follows && **verdict == Verdict::Wrong)
                {
                    *verdict = Verdict::Followed;
                }
                followed::set(&mut links[line.joint - 1], line.quantity, component, theirs.unwrap_or(*value));
            }
        }
        Ok(verdicts)
    }

    fn steps_not_given(&self) -> Vec<u8> {
        let given: BTreeSet<u8> = self.values.values().map(|value| value.quantity.step()).collect();
        (1..=7).filter(|step| !given.contains(step)).collect()
    }

    fn line(&self, index: usize) -> &Line {
        &self.sheet.lines[index]
    }

    fn reasons(&self, line: usize, component: usize) -> Result<Vec<Reason>, WrongLength> {
        let slipped = slipped::all(self.robot, self.at, self.sheet)?;
        let explains = |values: &[Vec<f64>], up_to: usize| {
            // all given values up to the line have to agree
            let here = |place: Place| values.get(place.0).and_then(|line| line.get(place.1)).copied();
            let mut places = self.values.keys().take_while(|place| place.0 <= up_to);
            places.all(|&place| here(place).is_some_and(|value| self.agrees(place, value)))
        };
        let of_slip = |slipped: &slipped::Slipped, reach| {
            let (says, right) = (slipped.says.clone(), slipped.right.clone());
            Reason { says, right, reach }
        };
        let last = self.sheet.lines.len();
        let everything = slipped.iter().filter(|slipped| explains(&slipped.values, last));
        let mut reasons: Vec<Reason> =
            everything.map(|slipped| of_slip(slipped, Reach::Everything)).take(MOST).collect();
        if reasons.is_empty() {
            reasons.extend(self.of_other_axes(line)?);
        }
        if reasons.iter().all(|reason| reason.reach != Reach::Everything) {
            let wrong = self.wrong();
            let of = |is_there: &dyn Fn(&Place) -> bool| wrong.iter().filter(|place| is_there(place)).count();
            let here = of(&|place| place.0 == line);
            let torques = of(&|place| self.line(place.0).quantity == Quantity::Tau);
            let mut found: Vec<(usize, Reason)> =
                self.of_the_line(line, component).into_iter().map(|reason| (here, reason)).collect();
            found.extend(self.of_torques()?.into_iter().map(|reason| (torques, reason)));
            let so_far = slipped.iter().filter(|slipped| explains(&slipped.values, line));
            found.extend(so_far.map(|slipped| {
                let explained = of(&|&place| self.agrees(place, slipped.values[place.0][place.1]));
                (explained, of_slip(slipped, Reach::UpToHere))
            }));
            // the reason that explains most values is the likeliest
            found.sort_by_key(|(explained, _)| std::cmp::Reverse(*explained));
            for (_, reason) in found {
                if reasons.iter().all(|known| known.says != reason.says) {
                    reasons.push(reason);
                }
            }
            reasons.truncate(MOST);
        }
        Ok(reasons)
    }

    /// Returns the places of the values that differ.
    fn wrong(&self) -> Vec<Place> {
        self.values.keys().copied().filter(|&place| !self.agrees(place, self.sheet.value(place))).collect()
    }

    /// Returns other axes in which all vectors may have been written: those that explain every value, or every value up
    /// to the line and more than half of the differing ones.
    fn of_other_axes(&self, line: usize) -> Result<Vec<Reason>, WrongLength> {
        let wrong = self.wrong();
        let mut found = Vec::new();
        for other in other_axes::all(self.robot, self.at, self.sheet)? {
            let agrees = |place: Place| self.agrees(place, other.values[place.0][place.1]);
            let explained = wrong.iter().filter(|&&place| agrees(place)).count();
            let reach = match self.values.keys().find(|&&place| !agrees(place)) {
                None => Reach::Everything,
                Some(first) if first.0 > line && 2 * explained > wrong.len() => Reach::UpToHere,
                Some(_) => continue,
            };
            let own = self.sheet.axes;
            let right = format!("the axes of the worksheet are `{}`: {}", own.name(), own.explained());
            found.push(Reason { says: other.says, right: Some(right), reach });
        }
        let best = found.iter().any(|reason| reason.reach == Reach::Everything);
        found.retain(|reason| !best || reason.reach == Reach::Everything);
        found.truncate(1);
        Ok(found)
    }

    /// Returns the mistakes within the line that explain it.
    fn of_the_line(&self, line: usize, component: usize) -> Vec<Reason> {
        let ways = local::ways(self.line(line), component);
        // a mistake in one component does not explain a vector with another differing component
        let others_are_right = self.wrong().iter().all(|place| place.0 != line || place.1 == component);
        let is_whole = |way: &local::Way| way.values.len() > 1 && way.values.iter().all(Option::is_some);
        let zero_is_no_multiple = |way: &local::Way| {
            let small = way.values[component].is_none_or(|value| value.abs() <= self.allowed((line, component)));
            is_whole(way) || others_are_right && (!small || way.says.contains("term"))
        };
        let fits = |way: &local::Way| {
            let mut said = way.values.iter().enumerate().filter_map(|(at, value)| Some((at, (*value)?)));
            said.all(|(at, value)| self.agrees((line, at), value))
        };
        let mut found: Vec<Reason> = Vec::new();
        for way in ways.into_iter().filter(|way| fits(way) && zero_is_no_multiple(way)) {
            let reach = if is_whole(&way) { Reach::Line } else { Reach::Component };
            // if a reason explains the whole line, reasons for a part of it are dropped
            if reach == Reach::Line || found.iter().all(|other| other.reach != Reach::Line) {
                found.push(Reason { says: way.says, right: None, reach });
            }
        }
        found.truncate(MOST - 1);
        found
    }

    /// Returns the reasons that `diagnose` finds for the torques, if all torques are given.
    fn of_torques(&self) -> Result<Vec<Reason>, WrongLength> {
        let (robot, at) = (self.robot, self.at);
        let of_tau = |joint: usize| self.values.values().find(|v| v.quantity == Quantity::Tau && v.joint == joint);
        let tau: Vec<GivenValue> = (1..=robot.dof()).filter_map(of_tau).copied().collect();
        if tau.len() < robot.dof() || at.base.is_some() || at.payload.is_some() {
            return Ok(Vec::new());
        }
        let largest = norm(&tau.iter().map(|value| value.value).collect::<Vec<_>>());
        let by_hand = self.by_hand(largest);
        let seen = Observation {
            q: at.q.clone(),
            qd: at.qd.clone(),
            qdd: at.qdd.clone(),
            wrench: at.wrench,
            tau: tau.iter().map(|value| value.value).collect(),
            resolution: tau.iter().map(|value| value.resolution.min(COARSEST * largest).max(by_hand)).collect(),
        };
        let Diagnosis::Explained(all) = diagnose(robot, &[seen])? else { return Ok(Vec::new()) };
        let reason = |slips: &[crate::Slip]| {
            let says: Vec<String> = slips.iter().map(|slip| slip.says(robot)).collect();
            let right: Vec<String> = slips.iter().map(|slip| slip.right(robot)).collect();
            Reason { says: says.join("; and "), right: Some(right.join("; and ")), reach: Reach::Torques }
        };
        Ok(all.iter().take(1).map(|explanation| reason(&explanation.slips)).collect())
    }
}
