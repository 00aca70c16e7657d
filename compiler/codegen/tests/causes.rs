//! What is told of a zero is why it is zero: the causes named suffice, and none of them can be left out.
//!
//! A number of the table that is zero stops being so when it becomes a run-time parameter, an angle when it grows by
//! 0.3. For every component that is found to be zero, everything that is not named is changed at once, and the
//! component stays zero; then each named zero is changed as well, one at a time, and the component is zero no more.

mod common;

use std::collections::{BTreeMap, BTreeSet};

use common::robot;
use rne_codegen::{Axis, Cause, Compiler, Component, Form, Function, Name, Quantity, ResolvedAs};
use rne_model::{Angle, Entry, Formula, InertiaElement, JointKind, Robot};

/// A number of the robot file that can be another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Change {
    Number(Entry),
    Alpha(usize),
    Theta(usize),
}

fn changes(robot: &Robot) -> Vec<Change> {
    let mut changes: Vec<Change> = (0..3).map(|axis| Change::Number(Entry::Gravity(axis))).collect();
    changes.extend((0..3).map(|axis| Change::Number(Entry::ToolXyz(axis))));
    for (joint, row) in robot.rows().enumerate() {
        changes.push(Change::Alpha(joint));
        if row.kind == JointKind::Prismatic {
            changes.push(Change::Theta(joint));
        }
        let com = (0..3).map(|axis| Entry::Com(joint, axis));
        let inertia = InertiaElement::ALL.map(|element| Entry::Inertia(joint, element));
        changes.extend([Entry::A(joint), Entry::D(joint)].into_iter().chain(com).chain(inertia).map(Change::Number));
    }
    changes
}

fn changed<'c>(robot: &Robot, changes: impl IntoIterator<Item = &'c Change>) -> Robot {
    let mut robot = robot.clone();
    for change in changes {
        let other = |angle: Angle| Angle::new(angle.radians + 0.3);
        match *change {
            Change::Alpha(joint) => robot.joints[joint].row.dh.alpha = other(robot.joints[joint].row.dh.alpha),
            Change::Theta(joint) => robot.joints[joint].row.dh.theta = other(robot.joints[joint].row.dh.theta),
            Change::Number(entry) => {
                let run_time = &mut robot.run_time;
                run_time.entries.push((entry, Formula::Parameter(run_time.names.len())));
                run_time.names.push(format!("p{}", run_time.names.len()));
            }
        }
    }
    robot
}

/// Whether each component is zero, with the causes.
fn zeros(robot: &Robot, function: Function) -> BTreeMap<Name, Option<Vec<Cause>>> {
    let program = Compiler::new(robot).compile(function, Form::SevenSteps).expect("finite constants");
    let of = |found: &ResolvedAs| match found {
        ResolvedAs::Constant(value, causes) if *value == 0.0 => Some(causes.iter().collect()),
        _ => None,
    };
    program.resolutions.iter().map(|resolution| (resolution.name, of(&resolution.value))).collect()
}

/// The component of the table that a cause says is zero.
fn entry(cause: Cause) -> Option<Name> {
    match cause {
        Cause::Table(name) => Some(name),
        Cause::GravityDirection(axis) => Some(Name::vector(Quantity::Gravity, 0, axis)),
        _ => None,
    }
}

/// The two halves of a tensor are one.
fn upper(name: Name) -> Name {
    match name.component {
        Component::Matrix(row, column) if name.quantity == Quantity::Inertia && row > column => {
            Name { component: Component::Matrix(column, row), ..name }
        }
        _ => name,
    }
}

/// How many sets of causes and how many single causes were tried.
fn try_all(robot: &Robot, function: Function) -> [usize; 2] {
    let plain = zeros(robot, function);
    let changes = changes(robot);
    // what each change makes of the zeros of the table
    let broken = |changes: &[Change]| -> BTreeSet<Name> {
        let after = zeros(&changed(robot, changes), function);
        plain
            .iter()
            .filter(|(name, zero)| zero.is_some() && after[name].is_none())
            .map(|(name, _)| upper(*name))
            .collect()
    };
    let breaks: Vec<(Change, BTreeSet<Name>)> = changes.iter().map(|change| (*change, broken(&[*change]))).collect();

    let mut of_set: BTreeMap<Vec<Cause>, Vec<Name>> = BTreeMap::new();
    for (name, zero) in &plain {
        // what makes terms cancel is not told
        if let Some(causes) = zero.as_ref().filter(|causes| !causes.contains(&Cause::Cancellation)) {
            of_set.entry(causes.clone()).or_default().push(*name);
        }
    }
    let mut single = 0;
    for (causes, names) in &of_set {
        let named: BTreeSet<Name> = causes.iter().filter_map(|cause| entry(*cause)).collect();
        let mut others: Vec<Change> =
            breaks.iter().filter(|(_, broken)| broken.is_disjoint(&named)).map(|(change, _)| *change).collect();
        // what a turn brings along with another change: the turn stays as it is
        let mut without = broken(&others);
        for turn in changes.iter().filter(|change| matches!(change, Change::Alpha(_) | Change::Theta(_))) {
            if without.is_disjoint(&named) {
                break;
            }
            others.retain(|other| other != turn);
            without = broken(&others);
        }
        assert!(without.is_disjoint(&named), "{}: {named:?}", robot.name);
        for name in names {
            assert!(!without.contains(&upper(*name)), "{}, {function}: {name} = 0 not by {causes:?}", robot.name);
        }
        for cause in &named {
            let only = |broken: &BTreeSet<Name>| broken.intersection(&named).eq([cause]);
            let Some((change, _)) = breaks.iter().find(|(_, broken)| only(broken)) else { continue };
            let with: Vec<Change> = others.iter().chain([change]).copied().collect();
            let without = broken(&with);
            if !without.intersection(&named).eq([cause]) {
                continue;
            }
            single += 1;
            for name in names {
                let is_zero = !without.contains(&upper(*name));
                assert!(!is_zero, "{}, {function}: {name} = 0 by {causes:?}, even without {cause}", robot.name);
            }
        }
    }
    [of_set.len(), single]
}

#[test]
fn the_causes_of_a_zero_suffice_and_each_is_needed() {
    for (name, functions, least) in [
        ("planar1", &[Function::InverseDynamics, Function::GravityTorques][..], [20, 20]),
        ("planar2", &[Function::InverseDynamics, Function::BiasTorques], [20, 20]),
        ("puma560", &[Function::InverseDynamics], [40, 40]),
        ("stanford", &[Function::InverseDynamics], [40, 40]),
    ] {
        let robot = robot(name);
        let tried = functions.iter().map(|&function| try_all(&robot, function));
        let tried = tried.fold([0, 0], |sum, tried| [sum[0] + tried[0], sum[1] + tried[1]]);
        println!("{name}: {} sets of causes, {} causes left out", tried[0], tried[1]);
        assert!(tried[0] >= least[0] && tried[1] >= least[1], "{name}: {tried:?}");
    }
}

/// As a teacher's question had it: gravity along -y has to do with no x.
#[test]
fn gravity_has_no_z_where_the_arm_moves_in_a_plane() {
    let planar = robot("planar1");
    for (gravity, named) in [([0.0, -9.81, 0.0], "z"), ([9.81, 0.0, 0.0], "z"), ([9.81, -9.81, 0.0], "z")] {
        let robot = Robot { gravity, ..planar.clone() };
        let found = zeros(&robot, Function::InverseDynamics);
        let of = |name| found[&name].clone().expect("a zero");
        assert_eq!(of(Name::vector(Quantity::Gravity, 1, Axis::Z)), [Cause::GravityDirection(Axis::Z)], "{gravity:?}");
        let force: Vec<String> =
            of(Name::vector(Quantity::JointForce, 1, Axis::Z)).iter().map(Cause::to_string).collect();
        let gravity = format!("gravity has no {named} in frame 0");
        assert_eq!(force, ["the base does not move", "nothing touches the tip", &gravity]);
    }
}
