//! Plans that differ from a plan in one choice or in few, in a fixed order.

use rne_codegen::plan::{Descent, Moment, OpenChoices, OriginShift, Plan, RegroupingTarget, Scale, Side, Switches};
use rne_model::JointKind::Revolute;
use rne_model::Robot;

/// Part of a robot that makes choices of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// Whole robot.
    Arm,
    /// A joint, counted from 0.
    Joint(usize),
}

/// Finds plans of one robot that differ little from a given plan.
#[derive(Clone, Debug)]
pub struct Neighbourhood(OpenChoices);

impl Neighbourhood {
    /// Makes it from the choices that a robot leaves open.
    #[must_use]
    pub fn of(robot: &Robot) -> Self {
        Self(Descent::new(robot, &[]).open_choices().clone())
    }

    /// Returns plans that differ in one choice, in all regrouping targets of one joint, in all choices of frame N of
    /// one joint, or in what a group of parallel axes shares. Of joints of the same structure, one changes alone, or
    /// all change together.
    #[must_use]
    pub fn neighbours(&self, plan: &Plan) -> Vec<Plan> {
        let alone = self.parts(false).into_iter().map(|part| (part, false));
        let together = self.parts(true).into_iter().filter(|part| self.followers(*part) > 0).map(|part| (part, true));
        alone.chain(together).flat_map(|(part, together)| self.beside(plan, part, together)).collect()
    }

    /// Returns the parts of the robot for which a descent chooses, one after the other. Of joints that choose together,
    /// only the first one is a part.
    pub(crate) fn parts(&self, together: bool) -> Vec<Part> {
        let joints = self.0.joints.iter().enumerate();
        let first = joints.filter(|(index, joint)| !together || joint.alike.first() == Some(index));
        [Part::Arm].into_iter().chain(first.map(|(index, _)| Part::Joint(index))).collect()
    }

    /// Whether some joints are alike, so that they can choose together.
    pub(crate) fn has_alike(&self) -> bool {
        self.0.joints.iter().any(|joint| joint.alike.len() > 1)
    }

    /// Returns how many other joints have the same structure as this one.
    fn followers(&self, part: Part) -> usize {
        match part {
            Part::Arm => 0,
            Part::Joint(index) => self.0.joints[index].alike.len() - 1,
        }
    }

    /// Returns plans in which one part makes other choices; with `together`, joints of the same structure make the same
    /// choices.
    pub(crate) fn beside(&self, plan: &Plan, part: Part, together: bool) -> Vec<Plan> {
        let mut list = Vec::new();
        match part {
            Part::Arm => self.of_the_arm(plan, &mut list),
            Part::Joint(index) => {
                self.of_joint(plan, index, &mut list);
                self.of_unturned_frame(plan, index, &mut list);
                self.of_group(plan, index, &mut list);
                self.of_gauge(plan, index, &mut list);
            }
        }
        if together { list.into_iter().map(|other| self.everywhere(plan, other)).collect() } else { list }
    }

    /// Makes the change from one plan to another at all joints of the same structure.
    fn everywhere(&self, from: &Plan, to: Plan) -> Plan {
        to.followed(from, |index| &self.0.joints[index].alike)
    }

    fn of_the_arm(&self, plan: &Plan, list: &mut Vec<Plan>) {
        let mut put = |change: &dyn Fn(&mut Plan)| {
            let mut other = plan.clone();
            change(&mut other);
            if other != *plan {
                list.push(other);
            }
        };
        if self.0.gyrostat {
            put(&|plan| plan.gyrostat = !plan.gyrostat);
        }
        if self.0.turned_last_frame {
            put(&|plan| plan.turned_last_frame = !plan.turned_last_frame);
        }
        if self.0.carried_prismatics {
            put(&|plan| plan.carried_prismatics = !plan.carried_prismatics);
        }
        if self.0.floating_base {
            for moment in Moment::ALL {
                put(&|plan| plan.base_moment = moment);
            }
        }
        let all: Vec<usize> = (0..self.0.joints.len()).collect();
        for [length, force] in self.scales(&all) {
            put(&|plan| {
                plan.length_scale = length.unwrap_or(plan.length_scale);
                plan.force_scale = force.unwrap_or(plan.force_scale);
            });
        }
    }

    /// Returns the scales of lengths and of forces to try: from all lengths, and from masses and first moments of the
    /// links of some joints. `None` keeps a scale.
    fn scales(&self, joints: &[usize]) -> Vec<[Option<Scale>; 2]> {
        let lengths = self.0.lengths.iter().chain(&[Scale::Default, Scale::One]);
        let of_lengths = lengths
            .flat_map(|&length| [[Some(length), Some(Scale::Default)], [Some(length), None], [None, Some(length)]]);
        let of_matter = joints.iter().flat_map(|index| {
            let joint = index + 1;
            let moments = (0..3).map(move |axis| Scale::FirstMoment(joint, axis));
            moments.flat_map(|h| [[Some(h), None], [None, Some(h)]]).chain([[None, Some(Scale::Mass(joint))]])
        });
        of_lengths.chain(of_matter).collect()
    }

    fn of_joint(&self, plan: &Plan, index: usize, list: &mut Vec<Plan>) {
        let row = &self.0.joints[index];
        let mut put = |change: &dyn Fn(&mut Plan)| {
            let mut other = plan.clone();
            change(&mut other);
            if other != *plan {
                list.push(other);
            }
        };
        let own_scales = if row.scaled.is_empty() { Vec::new() } else { self.scales(&row.scaled) };
        for [length, force] in own_scales {
            put(&|plan| {
                let joint = &mut plan.joints[index];
                joint.length_scale = length.unwrap_or(joint.length_scale);
                joint.force_scale = force.unwrap_or(joint.force_scale);
            });
        }
        for &origin_shift in &self.0.joints[index].origin_shifts {
            put(&|plan| plan.joints[index].origin_shift = origin_shift);
        }
        if row.kind != Revolute {
            return;
        }
        for side in Side::ALL {
            put(&|plan| plan.joints[index].outward_offset = side);
        }
        for side in [Side::Link, Side::Parent] {
            put(&|plan| plan.joints[index].inward_offset = side);
        }
        for moment in Moment::ALL {
            put(&|plan| plan.joints[index].moment = moment);
        }
        for switch in 0..Switches::NAMES.len() {
            if self.is_open(index, switch) {
                put(&|plan| {
                    if let Some(on) = plan.joints[index].switches.at(switch) {
                        *on = !*on;
                    }
                });
            }
        }
    }

    /// Whether a switch can make a difference at a joint.
    fn is_open(&self, index: usize, switch: usize) -> bool {
        let name = Switches::NAMES[switch];
        if name.starts_with("group") {
            return self.0.joints[index].is_parallel;
        }
        if name.starts_with("scaled") {
            return self.0.joints[index].is_twisted;
        }
        index > 0 || self.0.floating_base || name != "axis_column"
    }

    fn of_unturned_frame(&self, plan: &Plan, index: usize, list: &mut Vec<Plan>) {
        if self.0.joints[index].kind != Revolute {
            return;
        }
        for bits in 0..32_u32 {
            let mut other = plan.clone();
            let on = &mut other.joints[index].switches;
            on.origin_unturned = bits & 1 != 0;
            on.first_moment_unturned = bits & 2 != 0;
            on.second_moment_unturned = bits & 4 != 0;
            on.wrench_unturned = bits & 8 != 0;
            on.omega_dot_unturned = bits & 16 != 0;
            if other != *plan {
                list.push(other);
            }
        }
    }

    /// The last joint of the group of parallel axes that begins at a joint.
    fn group_end(&self, index: usize) -> usize {
        let joints = &self.0.joints;
        (index + 1..joints.len()).find(|&next| !joints[next].is_parallel).unwrap_or(joints.len()) - 1
    }

    /// Adds all combinations of what a group of parallel axes can share, with its origins as they are, innermost or
    /// outermost.
    fn of_group(&self, plan: &Plan, index: usize, list: &mut Vec<Plan>) {
        let starts = index + 1 < self.0.joints.len()
            && !self.0.joints[index].is_parallel
            && self.0.joints[index + 1].is_parallel;
        if !starts {
            return;
        }
        let end = self.group_end(index);
        for shared in 0..16_u32 {
            for offsets in 0..3 {
                for frames in 0..4_u32 {
                    let mut other = plan.clone();
                    for at in index + 1..=end {
                        let on = &mut other.joints[at].switches;
                        on.group_omega = shared & 1 != 0;
                        on.group_acceleration = shared & 2 != 0;
                        on.group_wrench = shared & 4 != 0;
                        on.group_omega_dot = shared & 8 != 0;
                    }
                    if offsets > 0 {
                        for at in index..=end {
                            let rule = if offsets == 1 { OriginShift::GroupInward } else { OriginShift::GroupOutward };
                            let rule = if self.0.offers(at, rule) { rule } else { OriginShift::None };
                            if at > 0 {
                                other.joints[at].origin_shift = rule;
                            }
                            if at > index {
                                other.joints[at].outward_offset = Side::Parent;
                                other.joints[at].inward_offset = Side::Parent;
                            }
                        }
                    }
                    for at in index..=end {
                        other.joints[at].switches.wrench_unturned = frames & 1 != 0;
                        other.joints[at].switches.origin_unturned = frames & 2 != 0;
                    }
                    if other != *plan {
                        list.push(other);
                    }
                }
            }
        }
    }

    fn of_gauge(&self, plan: &Plan, index: usize, list: &mut Vec<Plan>) {
        if index == 0 && !self.0.floating_base || self.0.joints[index].kind != Revolute {
            return;
        }
        for &first in RegroupingTarget::CHOICES[0] {
            for &second in RegroupingTarget::CHOICES[1] {
                for &third in RegroupingTarget::CHOICES[2] {
                    let mut other = plan.clone();
                    other.joints[index].targets = [first, second, third];
                    if other != *plan {
                        list.push(other);
                    }
                }
            }
        }
    }

    /// Returns a plan with one to three random changes.
    #[must_use]
    pub fn random(&self, plan: &Plan, rng: &mut fastrand::Rng) -> Plan {
        let mut other = plan.clone();
        let mut left = [1, 1, 1, 2, 3][rng.usize(..5)];
        while left > 0 {
            if self.change(&mut other, rng) {
                left -= 1;
            }
        }
        // in two of three cases, joints of the same structure change together
        if self.has_alike() && rng.u32(..3) > 0 { self.everywhere(plan, other) } else { other }
    }

    /// Makes one random change; returns false if nothing could be changed.
    fn change(&self, plan: &mut Plan, rng: &mut fastrand::Rng) -> bool {
        let index = rng.usize(..self.0.joints.len());
        let row = &self.0.joints[index];
        let joint = &mut plan.joints[index];
        match rng.u32(..100) {
            0..4 if self.0.gyrostat => plan.gyrostat = !plan.gyrostat,
            4..6 if self.0.turned_last_frame => plan.turned_last_frame = !plan.turned_last_frame,
            6..8 if self.0.carried_prismatics => plan.carried_prismatics = !plan.carried_prismatics,
            8..34 if row.kind == Revolute && (index > 0 || self.0.floating_base) => {
                for (target, choices) in joint.targets.iter_mut().zip(RegroupingTarget::CHOICES) {
                    *target = if rng.bool() { RegroupingTarget::Own } else { choices[rng.usize(..choices.len())] };
                }
                if rng.u32(..3) == 0 {
                    joint.targets = [RegroupingTarget::Own; 3];
                }
            }
            34..46 => {
                joint.origin_shift =
                    self.0.joints[index].origin_shifts[rng.usize(..self.0.joints[index].origin_shifts.len())];
            }
            46..50 if !row.scaled.is_empty() => {
                let scales = self.scales(&row.scaled);
                let [length, force] = scales[rng.usize(..scales.len())];
                joint.length_scale = length.unwrap_or(joint.length_scale);
                joint.force_scale = force.unwrap_or(joint.force_scale);
            }
            46..50 => {
                let length = *[Scale::One, Scale::Default]
                    .iter()
                    .chain(&self.0.lengths)
                    .nth(rng.usize(..self.0.lengths.len() + 2))
                    .unwrap_or(&Scale::One);
                match rng.u32(..5) {
                    0 => (plan.length_scale, plan.force_scale) = (length, Scale::Default),
                    1 => plan.length_scale = length,
                    2 => plan.force_scale = length,
                    3 => plan.length_scale = Scale::FirstMoment(index + 1, rng.usize(..3)),
                    _ if rng.bool() => plan.force_scale = Scale::Mass(index + 1),
                    _ => plan.force_scale = Scale::FirstMoment(index + 1, rng.usize(..3)),
                }
            }
            50..56 => joint.outward_offset = Side::ALL[rng.usize(..3)],
            56..60 => {
                joint.inward_offset = if joint.inward_offset == Side::Link { Side::Parent } else { Side::Link };
            }
            60..64 => joint.moment = Moment::ALL[rng.usize(..3)],
            64..100 => {
                let switch = rng.usize(..Switches::NAMES.len());
                if !self.is_open(index, switch) {
                    return false;
                }
                if let Some(on) = joint.switches.at(switch) {
                    *on = !*on;
                }
            }
            _ => return false,
        }
        true
    }
}
