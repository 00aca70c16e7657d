//! The numbers of a robot that become parameters of an FMU.

use rne_model::{Entry, Formula, InertiaElement, Robot};

use crate::parameters::{OF_C, Parameter};

/// The names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Returns a robot whose gravity, masses, centres of mass and inertias are also run-time parameters, in addition to
/// those that it has.
///
/// A number that is zero stays constant, and a number that already depends on a run-time parameter of the file does not
/// change. The new parameters come after those of the file.
#[must_use]
pub fn with_inertial_parameters(mut robot: Robot) -> Robot {
    let links = 0..robot.joints.len();
    let of_link = |link: usize| {
        let com = (0..AXES.len()).map(move |axis| Entry::Com(link, axis));
        let inertia = InertiaElement::ALL.into_iter().map(move |element| Entry::Inertia(link, element));
        std::iter::once(Entry::Mass(link)).chain(com).chain(inertia)
    };
    let entries: Vec<Entry> = (0..AXES.len()).map(Entry::Gravity).chain(links.flat_map(of_link)).collect();
    for entry in entries {
        let value = robot.number_mut(entry).map_or(0.0, |number| *number);
        if value == 0.0 || robot.run_time.formula(entry).is_some() {
            continue;
        }
        let mut name = identifier(entry);
        while robot.parameters.iter().any(|(known, _)| *known == name) {
            name.push('_');
        }
        let index = robot.run_time.names.len();
        robot.run_time.entries.push((entry, Formula::Parameter(index)));
        robot.run_time.names.push(name.clone());
        robot.parameters.push((name, value));
    }
    robot
}

/// Returns the name of a number in C.
fn identifier(entry: Entry) -> String {
    match entry {
        Entry::Gravity(axis) => format!("gravity_{}", AXES[axis]),
        Entry::Mass(link) => format!("mass_{}", link + 1),
        Entry::Com(link, axis) => format!("com_{}_{}", link + 1, AXES[axis]),
        Entry::Inertia(link, element) => format!("inertia_{}_{}", link + 1, element.key()),
        _ => String::new(),
    }
}

/// A parameter of an FMU.
pub(super) struct FmuParameter {
    /// The name of the variable.
    pub(super) name: String,
    pub(super) description: String,
    /// The unit by its name in the model description, if it is known.
    pub(super) unit: Option<&'static str>,
    pub(super) value: f64,
    /// The name of the member in the C struct.
    pub(super) member: String,
}

/// Returns the run-time parameters for whose index `is_used` is true, as variables.
pub(super) fn of(robot: &Robot, is_used: impl Fn(usize) -> bool) -> Vec<FmuParameter> {
    let all = Parameter::of(robot, OF_C).into_iter().enumerate();
    let used = all.filter(|(index, _)| is_used(*index));
    used.map(|(index, parameter)| {
        let added = robot.run_time.entries.iter().find(|(entry, formula)| {
            *formula == Formula::Parameter(index) && parameter.name.trim_end_matches('_') == identifier(*entry)
        });
        let (name, description) = match added {
            Some((entry, _)) => variable(robot, *entry),
            // the FMU has a variable of its own with this name
            None if ["time", "step"].contains(&&*parameter.name) => {
                (format!("parameter.{}", parameter.name), parameter.about())
            }
            None => (parameter.name.clone(), parameter.about()),
        };
        let unit = parameter.unit.and_then(super::units::of_file);
        FmuParameter { name, description, unit, value: parameter.value, member: parameter.member }
    })
    .collect()
}

/// Returns the name and the description of a number of the robot file.
fn variable(robot: &Robot, entry: Entry) -> (String, String) {
    let link = |link: usize| &robot.joints[link].name;
    match entry {
        Entry::Mass(of) => (format!("mass.{}", link(of)), "Mass of the link that this joint moves".to_owned()),
        Entry::Com(of, axis) => (
            format!("com.{}.{}", link(of), AXES[axis]),
            "Centre of mass of the link that this joint moves, in the link frame of the table".to_owned(),
        ),
        Entry::Inertia(of, element) => (
            format!("inertia.{}.{}", link(of), element.key()),
            "Inertia tensor of the link that this joint moves, about its centre of mass, in the axes of the link frame"
                .to_owned(),
        ),
        Entry::Gravity(axis) => {
            (format!("gravity.{}", AXES[axis]), "Acceleration of gravity in frame 0; it points down".to_owned())
        }
        _ => Default::default(),
    }
}
