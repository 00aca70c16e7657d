//! Checks the names of columns and refuses unclear ones, so that nothing is guessed.

use std::collections::{BTreeSet, HashMap};

use crate::columns::header::{Found, Header, by_joint};
use crate::columns::quantity::Quantity;
use crate::columns::unit::{Dimension, Unit};
use crate::limits::{MOST_JOINTS, work};
use crate::options::Angles;
use crate::remedy::Setting;
use crate::spelling::listed;
use crate::{LogError, Options};

impl<'a> Header<'a> {
    /// Refuses a quantity with more columns than the largest number of joints.
    pub(crate) fn check_count(&self, found: &[&Found]) -> Result<(), LogError> {
        let Some(one) = found.first().filter(|_| found.len() > MOST_JOINTS) else { return Ok(()) };
        let what = format!(
            "the table has {} columns of {}; rne reads at most {MOST_JOINTS} joints",
            found.len(),
            one.named.quantity.plural()
        );
        Err(LogError::request(self.path, what).give(Setting::Prefix))
    }

    /// Refuses two columns with the same quantity of one joint.
    pub(crate) fn check_once(&self, found: &[&Found]) -> Result<(), LogError> {
        work::add(found.len());
        let mut seen: HashMap<&str, &Found> = HashMap::with_capacity(found.len());
        for second in found {
            let Some(first) = seen.insert(&second.named.joint, second) else { continue };
            let what = format!(
                "the columns {} and {}, {} and {} of the table, are both {} of {}; remove one, or choose a group",
                self.name(first),
                self.name(second),
                first.place + 1,
                second.place + 1,
                second.named.quantity.plural(),
                second.named.joint
            );
            return Err(LogError::request(self.path, what).give(Setting::Prefix));
        }
        Ok(())
    }

    /// Checks that numbered joints are complete, from 0 or 1 on, and that all have the same quantities. If the options
    /// ask for joints by their numbers, only these are checked.
    pub(crate) fn check_numbers(
        &self,
        positions: &[&Found],
        others: &[&[&Found]; 3],
        options: &Options,
    ) -> Result<(), LogError> {
        let asked: Option<BTreeSet<u32>> = options
            .joints
            .as_ref()
            .and_then(|names| names.iter().map(|name| name.parse().ok()).collect::<Option<BTreeSet<u32>>>());
        let numbers = |found: &[&Found]| -> BTreeSet<u32> {
            let all = found.iter().filter_map(|found| found.named.number);
            all.filter(|number| asked.as_ref().is_none_or(|asked| asked.contains(number))).collect()
        };
        let there = numbers(positions);
        let (Some(least), Some(most)) = (there.first(), there.last()) else { return Ok(()) };
        let first = *least.min(&1);
        if asked.is_none()
            && let Some(missing) = (first..=*most).find(|number| !there.contains(number))
        {
            let all = there.iter().map(u32::to_string).collect();
            let what = format!(
                "the columns {} are positions of numbered joints, but {missing} is missing; name the joints if you \
                 want only these",
                self.listed(positions)
            );
            return Err(LogError::request(self.path, what).give(Setting::Joints(all)));
        }
        for found in others {
            let have = numbers(found);
            let is_derived = |found: &&Found| found.named.quantity == Quantity::Velocity && options.derive_velocities;
            let Some(one) = found.first().filter(|one| !have.is_empty() && !is_derived(one)) else { continue };
            let quantity = one.named.quantity;
            let missing = there.difference(&have).next();
            let other = have.difference(&there).next();
            let what = match (missing, other) {
                (Some(missing), _) => format!("the position of joint {missing} but not its {}", quantity.word()),
                (None, Some(other)) => format!("the {} of joint {other} but not its position", quantity.word()),
                (None, None) => continue,
            };
            let what = format!(
                "the columns have {what}: {} are {}, {} positions",
                self.listed(found),
                quantity.plural(),
                self.listed(positions)
            );
            return Err(LogError::request(self.path, what));
        }
        Ok(())
    }

    /// Lists the names of columns, for a message.
    fn listed(&self, found: &[&Found]) -> String {
        listed(found.iter().map(|found| self.name(found)))
    }

    /// Checks that the units of a joint fit each other. If the name of one column has a unit other than SI, columns of
    /// the quantity without a unit are refused, not guessed.
    pub(crate) fn check_units(
        &self,
        positions: &[&Found],
        velocities: &[&Found],
        efforts: &[&Found],
        options: &Options,
    ) -> Result<(), LogError> {
        let others = [velocities, efforts].map(|found| by_joint(found));
        for position in positions {
            let others = others.iter().filter_map(|found| found.get(position.named.joint.as_str()));
            let all: Vec<&Found> = [position].into_iter().chain(others).copied().collect();
            let says = |wanted: [Dimension; 2]| {
                all.iter().any(|found| found.dimension().is_some_and(|dimension| wanted.contains(&dimension)))
            };
            let is_in_degrees = |found: &&Found| {
                let is_effort = found.named.quantity == Quantity::Effort;
                options.angles == Angles::Degrees && !is_effort && found.dimension().is_none()
            };
            let turns = says([Dimension::Angle, Dimension::Torque]) || all.iter().any(is_in_degrees);
            if turns && says([Dimension::Length, Dimension::Force]) {
                let degrees = if all.iter().any(is_in_degrees) {
                    ", and rne reads columns without a unit in degrees"
                } else {
                    ""
                };
                let what = format!(
                    "the columns {} belong to one joint, but a joint either turns or slides{degrees}",
                    self.listed(&all)
                );
                return Err(LogError::file(self.path, what));
            }
        }
        let velocities = if options.derive_velocities { &[] } else { velocities };
        let motions: Vec<&Found> = positions.iter().chain(velocities).copied().collect();
        let is_other = |found: &&&Found| found.named.unit.is_some_and(|unit| !unit.is_si());
        let is_unsaid = |found: &&&Found| found.dimension().is_none();
        let name = |found: &&Found| self.name(found);
        let both = |found: &[&Found]| -> Option<(&'a str, &'a str)> {
            Some((name(found.iter().find(is_other)?), name(found.iter().find(is_unsaid)?)))
        };
        if let Some((said, unsaid)) = both(&motions).filter(|_| options.angles == Angles::Unsaid) {
            let what = format!("the name of the column {said} gives a unit, but the name {unsaid} does not");
            return Err(LogError::request(self.path, what).give(Setting::Angles));
        }
        if let Some((said, unsaid)) = both(efforts) {
            let what = format!(
                "the name of the column {said} gives a unit, but the name {unsaid} does not: write the unit into each \
                 name, as in tau1 [Nm]"
            );
            return Err(LogError::file(self.path, what));
        }
        self.check_options(&motions, efforts, options)
    }

    /// Refuses options of units that contradict the names of all columns.
    fn check_options(&self, motions: &[&Found], efforts: &[&Found], options: &Options) -> Result<(), LogError> {
        let is_contrary: fn(&Unit) -> bool = match options.angles {
            Angles::Degrees => |unit| unit.dimension == Dimension::Length || unit.is_si(),
            Angles::Radians => |unit| unit.dimension == Dimension::Angle && !unit.is_si(),
            Angles::Unsaid => |_| false,
        };
        let all_say = motions.iter().all(|found| found.named.unit.is_some());
        if let Some(found) = motions.iter().find(|found| found.named.unit.is_some_and(|unit| is_contrary(&unit)))
            && all_say
        {
            let what = format!("the column {} gives its unit, and so do all other columns", self.name(found));
            return Err(LogError::request(self.path, what).leave_out(Setting::Angles));
        }
        let is_torque = |found: &&Found| matches!(found.dimension(), Some(Dimension::Torque | Dimension::Force));
        if let Some(found) = efforts.first()
            && !options.torque_constants.is_empty()
            && efforts.iter().all(is_torque)
        {
            let what = format!("the column {} has no current, and no other column has one", self.name(found));
            return Err(LogError::request(self.path, what).leave_out(Setting::TorqueConstants));
        }
        Ok(())
    }
}
