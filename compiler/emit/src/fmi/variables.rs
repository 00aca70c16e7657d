//! The variables of an FMU; the index of a variable in the list is its value reference.

use rne_model::JointKind;

use super::{Fmu, FmuCausality, STEP};

/// The role of a variable.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Role {
    Time,
    Input,
    Output,
    /// An output that is also a state.
    State,
    /// A parameter that may change between two steps.
    Tunable,
    /// A parameter that is set before the simulation.
    Fixed,
}

/// A variable of the FMU, which is a real number.
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) description: String,
    pub(super) unit: Option<&'static str>,
    pub(super) role: Role,
    pub(super) start: f64,
    pub(super) range: Option<(f64, f64)>,
    /// The index of the variable whose time derivative this one is.
    pub(super) derivative_of: Option<usize>,
}

/// The numbers of a payload, in the order of the argument in C, with their names and units.
pub(super) const PAYLOAD: [(&str, &str); 10] = [
    ("mass", "kg"),
    ("com.x", "m"),
    ("com.y", "m"),
    ("com.z", "m"),
    ("inertia.xx", "kg.m2"),
    ("inertia.yy", "kg.m2"),
    ("inertia.zz", "kg.m2"),
    ("inertia.xy", "kg.m2"),
    ("inertia.xz", "kg.m2"),
    ("inertia.yz", "kg.m2"),
];

impl Variable {
    /// Returns a variable without a range.
    fn new(name: &str, description: &str, unit: Option<&'static str>, role: Role, start: f64) -> Self {
        let (name, description) = (name.to_owned(), description.to_owned());
        Self { name, description, unit, role, start, range: None, derivative_of: None }
    }
}

impl Fmu<'_> {
    /// Returns the variables in the order that the C code expects: time; q, q̇, q̈ and τ of all joints; the step of the
    /// integrator; the parameters; the payload.
    pub(super) fn variables(&self) -> Vec<Variable> {
        let mut variables = vec![Variable::new("time", "Simulation time", Some("s"), Role::Time, 0.0)];
        variables.extend(self.variables_of_joints());
        if self.causality == FmuCausality::Forward {
            let about = "Longest step of the integrator in co-simulation (Runge-Kutta of order 4)";
            variables.push(Variable::new("step", about, Some("s"), Role::Fixed, STEP));
        }
        variables.extend(self.parameters().into_iter().map(|parameter| {
            let (name, description) = (&parameter.name, &parameter.description);
            Variable::new(name, description, parameter.unit, Role::Tunable, parameter.value)
        }));
        variables.extend(PAYLOAD.map(|(name, unit)| {
            let about = match name {
                "mass" => "Mass of a payload that is fixed to the tip",
                name if name.starts_with("com") => "Centre of mass of the payload, in the tip frame",
                _ => "Inertia tensor of the payload about its centre of mass, in the axes of the tip frame",
            };
            Variable::new(&format!("payload.{name}"), about, Some(unit), Role::Tunable, 0.0)
        }));
        variables
    }

    /// Returns q, q̇, q̈ and τ of all joints, which come after the time.
    fn variables_of_joints(&self) -> Vec<Variable> {
        let is_forward = self.causality == FmuCausality::Forward;
        let dof = self.robot.dof();
        // the limits of a joint that others follow also respect the limits of these joints
        let coordinate_limits = self.robot.coordinate_limits();
        let mut variables = Vec::new();
        for (order, kind) in ["q", "qd", "qdd", "tau"].into_iter().enumerate() {
            for (index, (joint, limits)) in self.robot.independent_joints().zip(&coordinate_limits).enumerate() {
                let symmetric = |largest: Option<f64>| largest.map(|largest| (-largest, largest));
                let (what, range) = match order {
                    0 => ("Position", limits.position),
                    1 => ("Velocity", symmetric(limits.velocity)),
                    2 => ("Acceleration", None),
                    _ => ("Torque or force without friction", symmetric(limits.effort)),
                };
                let role = match (is_forward, order) {
                    (true, 0 | 1) => Role::State,
                    (true, 2) | (false, 3) => Role::Output,
                    _ => Role::Input,
                };
                let units = match joint.row.kind {
                    JointKind::Revolute => ["rad", "rad/s", "rad/s2", "N.m"],
                    JointKind::Prismatic => ["m", "m/s", "m/s2", "N"],
                };
                variables.push(Variable {
                    name: format!("{kind}.{}", joint.name),
                    description: format!("{what} of joint {}", index + 1),
                    unit: Some(units[order]),
                    role,
                    // 0, or the limit that is nearest to 0
                    start: range.map_or(0.0, |(least, most)| 0.0_f64.max(least).min(most)),
                    range: range.filter(|(least, most)| least <= most),
                    derivative_of: (is_forward && matches!(order, 1 | 2)).then(|| 1 + (order - 1) * dof + index),
                });
            }
        }
        variables
    }
}
