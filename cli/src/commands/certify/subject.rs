//! The kinds of functions that `rne certify` measures: a program, an update of the observer, friction or limits of the
//! joints.

use rne_certify::accuracy::{self, Error, Sample};
use rne_certify::board::{self, Call};
use rne_certify::certificate::{Accuracy, NamedError};
use rne_certify::image::NoFigures;
use rne_certify::joint_functions::{BEYOND, JointFunction};
use rne_certify::observer::{self, LowPass};
use rne_codegen::{Argument, ArgumentArray, Function, Interpreter, Layout, Name, Output, Program, Quantity};
use rne_model::{JointKind, Limits, Robot};

use crate::outcome::Failure;
use crate::palette::TYPED;

/// A function of the code that is certified.
pub(super) enum Subject<'a> {
    Program(&'a Program),
    /// An update of the observer, which calls the program.
    Observer(&'a Program, LowPass),
    /// Friction or limits, which depend only on the joints.
    Joints(JointFunction),
}

impl Subject<'_> {
    /// Returns the name of the function in the code, without the prefix.
    pub(super) fn name(&self) -> &str {
        match self {
            Self::Program(program) => program.function.name(),
            Self::Observer(..) => "observer_update",
            Self::Joints(function) => function.name(),
        }
    }

    /// Returns the other functions that it may call, without their prefix; calls of the sine function are always
    /// allowed.
    pub(super) fn callees(&self) -> Vec<&str> {
        match self {
            Self::Program(_) => Vec::new(),
            Self::Observer(program, _) => vec![program.function.name()],
            Self::Joints(function) => vec![function.helper()],
        }
    }

    /// Makes the error that says why the function has no certificate.
    pub(super) fn refused(&self, fault: &NoFigures) -> Failure {
        match (self, fault) {
            (Self::Program(program), NoFigures::NotStraight(..)) if program.function == Function::ActuatorTorques => {
                input_error!(
                    "the robot file has dry friction, and its code branches over the sign of each velocity; \
                 {TYPED}--friction{TYPED:#} certifies the smooth law of friction. {fault}"
                )
            }
            _ => Failure::input(fault),
        }
    }

    /// Returns the call in the test program; an error where a program takes other arguments than arrays of joints, or
    /// does not return a plain array.
    pub(super) fn call(&self, prefix: &str, robot: &Robot) -> Result<Call, Failure> {
        let dof = robot.dof();
        if dof > board::MOST_JOINTS {
            return Err(usage_error!(
                "rne certify takes arms with at most {} joints; this arm has {dof}",
                board::MOST_JOINTS
            ));
        }
        Ok(match self {
            Self::Program(program) => program_call(program, prefix, &accuracy::passive(robot)),
            Self::Observer(_, low_pass) => low_pass.call(prefix, dof),
            Self::Joints(function) => function.call(prefix, dof),
        })
    }

    /// Computes the numbers that the call writes at a state of the test program, with the same operations as the code.
    pub(super) fn expected(&self, robot: &Robot, number: u32) -> Option<Vec<f32>> {
        let sin_cos = rne_emit::sin_cos_f32;
        match self {
            Self::Program(program) => {
                let [q, qd, qdd] = board::state(number, robot.dof());
                let passive = accuracy::passive(robot);
                accuracy::single_precision(robot, &Interpreter::new(program), [&q, &passive, &qd, &qdd], sin_cos)
            }
            Self::Observer(program, low_pass) => low_pass.result(robot, &Interpreter::new(program), number, sin_cos),
            Self::Joints(function) => Some(function.result_at(number, robot.dof())),
        }
    }

    /// Returns sentences on how the function was compared with the recursive Newton-Euler algorithm.
    pub(super) fn proof(&self) -> Vec<String> {
        match self {
            Self::Program(program) | Self::Observer(program, _) => {
                let mut lines = program.proof.as_ref().map_or_else(
                    || {
                        vec![
                            "The code is the seven steps of recursive Newton-Euler, so there is no other form to \
                             compare."
                                .to_owned(),
                        ]
                    },
                    |proof| rne_emit::evidence(program, proof),
                );
                lines.extend(rne_emit::losses(std::slice::from_ref(program)));
                lines
            }
            Self::Joints(function) => {
                let other = match function {
                    JointFunction::Friction(_) => "`actuator_torques_smooth` of its runtime library",
                    JointFunction::FrictionDerivatives(_) => {
                        "`actuator_torques_smooth_derivatives` of its runtime library"
                    }
                    JointFunction::Limits(_) => "the smaller of torque and limit",
                };
                vec![format!(
                    "The comparison does not cover `{}`: it belongs to no step of the algorithm; tests of rne compare \
                     it with {other} for other arms, in `float` and in `double`.",
                    function.name()
                )]
            }
        }
    }

    /// Computes the error of the function over a sample of states.
    pub(super) fn accuracy(&self, robot: &Robot, sample: Sample) -> Result<Accuracy, Failure> {
        let errors = self.errors(robot, sample);
        let errors = errors.ok_or_else(|| Failure::input("the interpreter cannot run this function"))?;
        let of_joints = |array: &str, unit: &dyn Fn(JointKind) -> &'static str| {
            let joints = robot.coordinates().enumerate();
            joints
                .map(|(index, joint)| (format!("`{array}[{index}]`"), Some(joint), unit(robot.joints[joint].row.kind)))
                .collect()
        };
        let names: Vec<(String, Option<usize>, &str)> = match self {
            Self::Program(program) => {
                let places = rne_emit::result_elements(program, program.function.entry().output).into_iter();
                let of_output = |(output, place): (&Output, String)| named(program, robot, output.name, &place);
                program.outputs.iter().zip(places).map(of_output).collect()
            }
            Self::Observer(..) => of_joints("external", &JointKind::effort_unit),
            Self::Joints(function) => of_joints(function.result(), &|kind| function.unit(kind)),
        };
        let named = |(error, (name, joint, unit)): (Error, (String, Option<usize>, &'static str))| {
            let joint = joint.and_then(|joint| robot.joints.get(joint)).map(|joint| joint.name.clone());
            NamedError { name, joint, unit, error }
        };
        let results = errors.into_iter().zip(names).map(named).collect();
        let Sample { states, seed } = sample;
        Ok(Accuracy { how: self.how(sample), states, seed, ranges: self.ranges(robot), results })
    }

    fn errors(&self, robot: &Robot, sample: Sample) -> Option<Vec<Error>> {
        let sin_cos = rne_emit::sin_cos_f32;
        match self {
            Self::Program(program) => accuracy::errors(robot, program, sample, sin_cos),
            Self::Observer(program, low_pass) => low_pass.errors(robot, program, sample, sin_cos),
            Self::Joints(function) => function.errors(robot, sample),
        }
    }

    /// Returns a sentence on how the states are chosen.
    fn how(&self, Sample { states, seed }: Sample) -> String {
        let random = format!("The function runs at {states} random states (seed {seed}).");
        match self {
            Self::Program(program) => random + &fixed(program.function),
            Self::Observer(_, low_pass) => format!(
                "The observer has a low-pass with a gain of {} Hz and a period of {} s. It runs through {states} \
                 updates (seed {seed}) in motions of {} updates. In a motion, each joint follows a sine within the \
                 ranges below, and each torque is a random number at each update. The exact result is that of all \
                 updates since the beginning of the motion, with the weight and the frequency that the observer \
                 stores in `float`.",
                low_pass.gain,
                low_pass.period,
                observer::UPDATES
            ),
            Self::Joints(JointFunction::Friction(_) | JointFunction::FrictionDerivatives(_)) => format!(
                "{random} The exact result is that of the law in the header for G² B, |G| (Tc⁺ - Tc⁻)/2, |G| (Tc⁺ + \
                 Tc⁻)/2 and the square of `coulomb_width`, which rne computes in `double`."
            ),
            Self::Joints(JointFunction::Limits(_)) => {
                format!("{random} The torques reach {BEYOND} times the limit, so that the function cuts some of them.")
            }
        }
    }

    /// Returns the ranges of the states, a line for each joint.
    fn ranges(&self, robot: &Robot) -> Vec<String> {
        let range = |(index, ((range, joint), limits)): (usize, ((accuracy::Range, &rne_model::Joint), Limits))| {
            let (unit, torque_is, torque_unit) = match joint.row.kind {
                JointKind::Revolute => ("rad", "torque", "N m"),
                JointKind::Prismatic => ("m", "force", "N"),
            };
            let of = |is_given: bool| if is_given { "limits of the robot file" } else { "no limit in the robot file" };
            let accuracy::Range { position: (low, high), velocity, acceleration, torque } = range;
            let position = format!("position {low:.4} to {high:.4} {unit} ({})", of(limits.position.is_some()));
            let speed = format!("speed up to {velocity:.4} {unit}/s ({})", of(limits.velocity.is_some()));
            let effort =
                |torque: f64| format!("{torque_is} up to {torque} {torque_unit} ({})", of(limits.effort.is_some()));
            let parts = match self {
                Self::Joints(JointFunction::Friction(_) | JointFunction::FrictionDerivatives(_)) => vec![speed],
                Self::Joints(JointFunction::Limits(_)) => vec![effort(BEYOND * torque)],
                Self::Program(program) | Self::Observer(program, _) => {
                    let arrays = program.arrays_without_parameters();
                    let parts = [
                        ("q", position),
                        ("qd", speed),
                        ("qdd", format!("acceleration up to {acceleration} {unit}/s²")),
                        ("tau", effort(torque)),
                        ("multipliers", format!("multiplier up to {acceleration}")),
                    ];
                    let is_taken = |name| arrays.iter().any(|array| array.name == name);
                    parts.into_iter().filter(|(name, _)| is_taken(*name)).map(|(_, part)| part).collect()
                }
            };
            format!("joint {}: {}", index + 1, parts.join(", "))
        };
        let joints = accuracy::ranges(robot).into_iter().zip(robot.independent_joints());
        joints.zip(robot.coordinate_limits()).enumerate().map(range).collect()
    }
}

/// Describes the arguments that are the same at each state.
fn fixed(function: Function) -> String {
    let parts = function.arguments().iter().flat_map(|argument| argument.parts());
    let clauses: Vec<String> = parts.filter_map(|part| Some(accuracy::same(part.name)?.1)).collect();
    let mut words = match &clauses[..] {
        [] => String::new(),
        [only] => format!(" At each state {only}."),
        [first @ .., last] => format!(" At each state {}, and {last}.", first.join(", ")),
    };
    if function.takes(Argument::Sines) {
        words.push_str(" Sines and cosines are those of the code's own function; the bound includes their errors.");
    }
    if function.takes(Argument::Passive) {
        words.push_str(" At each state the dependent joints close the loops.");
    }
    words
}

/// Describes a number that a program returns: its place in the result, its joint and its unit. The unit is `SI` for an
/// element of a matrix whose rows and columns have different units.
fn named(program: &Program, robot: &Robot, name: Name, place: &str) -> (String, Option<usize>, &'static str) {
    let joint = name.joint.checked_sub(1);
    let kind = joint.and_then(|joint| robot.joints.get(joint)).map_or(JointKind::Revolute, |joint| joint.row.kind);
    // the index of a force that one link exerts on the next is that of a link
    let is_of_pair = matches!(name.quantity, Quantity::JointForce | Quantity::JointMoment);
    let is_of_matrix = name.by.is_some() || name.indices != [0; 2] && !is_of_pair;
    let unit = match name.quantity {
        _ if is_of_matrix => "SI",
        Quantity::ContactForce => "N",
        Quantity::ContactMoment => "N m",
        Quantity::LinearMomentum => "N s",
        Quantity::ComPosition | Quantity::FrameOrigin => "m",
        Quantity::Momentum => match kind {
            JointKind::Revolute => "N m s",
            JointKind::Prismatic => "N s",
        },
        Quantity::CentroidalMoment if program.function.takes(Argument::BaseTwist) => "N m s",
        // an equation of a loop is a distance or a scalar product of axes
        Quantity::Residual => "m or 1",
        Quantity::ActuatorTorque | Quantity::MomentumRate => kind.effort_unit(),
        quantity => match quantity.unit(kind) {
            "" => "SI",
            unit => unit,
        },
    };
    // indices of these results count tips, equations or components of the base, not joints; elements of a matrix have a
    // row and a column
    let is_of_no_joint = is_of_matrix
        || matches!(
            name.quantity,
            Quantity::BaseForce
                | Quantity::BaseMoment
                | Quantity::Residual
                | Quantity::ContactForce
                | Quantity::ContactMoment
        );
    (format!("`{place}`"), joint.filter(|_| !is_of_no_joint), unit)
}

/// Writes the sines or the cosines of the positions at the states of the test program, as C.
fn turns(dof: usize, name: &str, of: impl Fn(f32) -> f32) -> String {
    let list = |numbers: Vec<String>| numbers.join(", ");
    let row = |number| {
        let [q, ..] = board::state(number, dof);
        format!("{{{}}}", list(q.into_iter().map(|q| format!("{:?}f", of(q))).collect()))
    };
    format!(
        "static const float {name}[{}][{dof}] = {{{}}};",
        board::STATES,
        list((0..board::STATES).map(row).collect())
    )
}

/// Returns the call of a function whose arguments are arrays of a state of the test program, and arrays that are the
/// same at each state.
fn program_call(program: &Program, prefix: &str, passive: &[f32]) -> Call {
    let function = program.function;
    let list = |numbers: &[f32]| numbers.iter().map(|x| format!("{x:?}f")).collect::<Vec<_>>().join(", ");
    let name = format!("{prefix}_{function}");
    let mut call = Call::new(name, program.outputs.len());
    for array in program.arrays_without_parameters() {
        let ArgumentArray { name, row, is_number, .. } = &array;
        let (kind, given) = match (*name, row) {
            ("q" | "qd" | "qdd", _) => ("const float *".to_owned(), format!("s->{name}")),
            // a state of the test program has three arrays per joint; these arguments use the third
            ("tau" | "multipliers", _) => ("const float *".to_owned(), "s->qdd".to_owned()),
            ("sin" | "cos", _) => {
                let of = |q| rne_emit::sin_cos_f32(q);
                let of: &dyn Fn(f32) -> f32 = if *name == "sin" { &|q| of(q).0 } else { &|q| of(q).1 };
                call.before.push(turns(program.dof, &format!("{name}_of_states"), of));
                ("const float *".to_owned(), format!("{name}_of_states[number]"))
            }
            (_, row) => {
                let of_one = match *name {
                    "passive" => passive,
                    name => accuracy::same(name).unwrap_or_default().0,
                };
                let all = of_one.repeat(array.elements.len() / of_one.len().max(1));
                let lengths = array.lengths().iter().map(|length| format!("[{length}]")).collect::<Vec<_>>().concat();
                let value = match row {
                    Some(row) => format!("{{{{{}}}}}", all.chunks(*row).map(list).collect::<Vec<_>>().join("}, {")),
                    None if *is_number => list(&all),
                    None => format!("{{{}}}", list(&all)),
                };
                call.before.push(format!("const float {name}{lengths} = {value};"));
                let kind = match row {
                    Some(row) => format!("const float (*)[{row}]"),
                    None if *is_number => "float".to_owned(),
                    None => "const float *".to_owned(),
                };
                (kind, (*name).to_owned())
            }
        };
        call.arguments.push((kind, given));
    }
    let (mut layout, mut lengths) = (program.layout(), Vec::new());
    while let Layout::Array(length, of) = layout {
        lengths.push(length);
        layout = *of;
    }
    if let Layout::Record(record, _) = layout {
        call.element = rne_emit::record_name(prefix, record);
    }
    Call { lengths, ..call }
}
