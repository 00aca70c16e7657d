//! Dynamics as scalar functions: `inverse_dynamics('puma560@…', q, qd, qdd)`.

use std::sync::Arc;

use datafusion::arrow::array::ArrayRef;
use datafusion::arrow::datatypes::{DataType, Field, FieldRef};
use datafusion::common::{Result, ScalarValue, exec_err, internal_err, plan_err};
use datafusion::logical_expr::{
    ColumnarValue, Documentation, ReturnFieldArgs, ScalarFunctionArgs, ScalarUDFImpl, Signature,
};
use rne::compiled::{Argument as Input, Arguments, CompiledArm, Destination, Function, Layout, sizes_of};
use rne::model::Robot;

use crate::argument::{self, Argument};
use crate::call::{Call, key};
use crate::result;
use crate::robots::{Held, Robots, external};

/// The computation of an SQL function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Computation {
    /// A function of the arm, such as inverse dynamics.
    Of(Function),
    /// Measured torques minus the torques of the model, including the friction and the rotors of its motors.
    Residual,
}

impl Computation {
    /// Returns all computations whose arguments are numbers of joints, the motion of the base, or wrenches at the tips.
    /// Functions with sines, cosines or a payload are left out.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        let is_left_out = |input: &Input| matches!(input, Input::Sines | Input::Cosines | Input::Payload);
        let is_there = move |function: &Function| !function.arguments().iter().any(is_left_out);
        Function::OF_TREES.iter().copied().filter(is_there).map(Self::Of).chain([Self::Residual])
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Of(function) => function.name(),
            Self::Residual => "residual",
        }
    }

    /// The names of its arguments, after the robot.
    fn arguments(self) -> Vec<&'static str> {
        match self {
            Self::Of(function) => {
                function.arguments().iter().flat_map(|input| input.parts()).map(|part| part.name).collect()
            }
            Self::Residual => vec!["q", "qd", "qdd", "tau"],
        }
    }

    fn layout(self, robot: &Robot) -> Layout {
        match self {
            Self::Of(function) => function.layout(sizes_of(robot)),
            Self::Residual => Function::InverseDynamics.layout(sizes_of(robot)),
        }
    }

    fn summary(self) -> &'static str {
        match self {
            Self::Of(function) => function.summary(),
            Self::Residual => "Measured torques minus those of the model, friction and rotors of its motors included.",
        }
    }

    /// Returns the results of `states` states, one state after the other.
    fn run(self, held: &Held, states: usize, arguments: &[Argument<'_>]) -> Result<Vec<f64>> {
        let mut given = Arguments::new();
        for (name, argument) in self.arguments().into_iter().zip(arguments) {
            given = match given.with(name, argument.array()) {
                Some(given) => given,
                None => return internal_err!("{}: `{name}` is no argument", self.name()),
            };
        }
        let run = |arm: &CompiledArm, function: Function| {
            let mut numbers = vec![0.0; states * function.layout(sizes_of(arm.robot())).len()];
            arm.run(function, states, &given, Destination::Rows(&mut numbers)).map_err(external)?;
            Ok(numbers)
        };
        match self {
            Self::Of(function) => run(&held.arm, function),
            Self::Residual => {
                let mut torques = run(held.with_rotors(), Function::InverseDynamics)?;
                let [_, qd, _, measured] = arguments else { return internal_err!("residual: no torques") };
                let joints: Vec<_> = held.arm.robot().independent_joints().collect();
                for (at, torque) in torques.iter_mut().enumerate() {
                    let (state, joint) = (at / joints.len(), at % joints.len());
                    let of = |argument: &Argument<'_>| argument.at(state, joint, joints.len());
                    // rows have no order, so friction depends on the velocity alone and not on the motion before
                    *torque = of(measured) - (*torque + joints[joint].friction(of(qd)));
                }
                Ok(torques)
            }
        }
    }
}

/// A [`Computation`] as a scalar function of the engine.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(crate) struct DynamicsFunction {
    computation: Computation,
    call: Call,
}

impl DynamicsFunction {
    pub(crate) fn new(computation: Computation, robots: Robots) -> Self {
        let syntax = format!("{}(robot, {})", computation.name(), computation.arguments().join(", "));
        Self { computation, call: Call::new(robots, &syntax, computation.summary()) }
    }

    /// Returns the robot that the first argument, a literal, names.
    fn held(&self, robot: Option<&ScalarValue>) -> Result<&Held> {
        self.call.robots.get(key(self.computation.name(), robot)?)
    }
}

/// Returns the types to which the arguments are converted: the name of a robot, then numbers.
pub(crate) fn coerced(function: &str, given: &[DataType]) -> Result<Vec<DataType>> {
    let Some((robot, columns)) = given.split_first() else {
        return plan_err!("{function}: the robot is missing, the first argument");
    };
    if !matches!(robot, DataType::Utf8 | DataType::LargeUtf8 | DataType::Utf8View) {
        return plan_err!("{function}: the first argument is the robot, a literal of text, not {robot}");
    }
    Ok([robot.clone()].into_iter().chain(columns.iter().map(argument::coerced)).collect())
}

impl ScalarUDFImpl for DynamicsFunction {
    fn name(&self) -> &str {
        self.computation.name()
    }

    fn signature(&self) -> &Signature {
        &self.call.signature
    }

    fn return_type(&self, _: &[DataType]) -> Result<DataType> {
        internal_err!("{}: the type depends on the robot", self.name())
    }

    fn coerce_types(&self, given: &[DataType]) -> Result<Vec<DataType>> {
        coerced(self.name(), given)
    }

    fn return_field_from_args(&self, given: ReturnFieldArgs<'_>) -> Result<FieldRef> {
        let held = self.held(given.scalar_arguments.first().copied().flatten())?;
        let columns = argument::columns(given.arg_fields);
        let robot = held.arm.robot();
        argument::check(self.name(), &self.computation.arguments(), &columns, robot)?;
        let of = result::data_type(&self.computation.layout(robot));
        Ok(Arc::new(Field::new(self.name(), of, true)))
    }

    fn invoke_with_args(&self, given: ScalarFunctionArgs) -> Result<ColumnarValue> {
        let ScalarFunctionArgs { args, arg_fields, number_rows: states, .. } = given;
        let Some((ColumnarValue::Scalar(robot), columns)) = args.split_first() else {
            return exec_err!("{}: the first argument is the robot, a literal", self.name());
        };
        let held = self.held(Some(robot))?;
        // where all arguments are constants, the function is computed for one state
        let is_constant = columns.iter().all(|column| matches!(column, ColumnarValue::Scalar(_)));
        let states = if is_constant { 1 } else { states };
        let arrays = columns.iter().map(|column| column.to_array(states)).collect::<Result<Vec<ArrayRef>>>()?;
        let names: Vec<&str> = arg_fields.iter().skip(1).map(|field| field.name().as_str()).collect();
        let robot = held.arm.robot();
        let (arguments, nulls) = argument::all(self.name(), &self.computation.arguments(), &names, &arrays, robot)?;
        let numbers = self.computation.run(held, states, &arguments)?;
        let column = result::column(&self.computation.layout(robot), numbers, states, nulls)?;
        if is_constant {
            return Ok(ColumnarValue::Scalar(ScalarValue::try_from_array(&column, 0)?));
        }
        Ok(ColumnarValue::Array(column))
    }

    fn documentation(&self) -> Option<&Documentation> {
        Some(self.call.documentation())
    }
}
