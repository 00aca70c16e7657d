//! The residual without accelerations, as a window function: `momentum_residual('puma560@…', time, q, qd, tau) OVER
//! (PARTITION BY robot, run ORDER BY time)`.
//!
//! It is the negative of the external torque that the momentum observer computes, as `rne watch` uses it. This is the
//! function `residual`, filtered by a low-pass of first order.

use std::sync::Arc;

use datafusion::arrow::array::{ArrayRef, Float64Builder, ListBuilder};
use datafusion::arrow::datatypes::{DataType, Field, FieldRef};
use datafusion::common::{Result, exec_err};
use datafusion::logical_expr::function::{ExpressionArgs, PartitionEvaluatorArgs, WindowUDFFieldArgs};
use datafusion::logical_expr::{Documentation, PartitionEvaluator, Signature, WindowUDFImpl};
use datafusion::physical_expr::PhysicalExpr;
use rne::model::{Friction, Robot};
use rne::{DynArm, DynObserverState};
use rne_logs::median;

use crate::argument::Argument;
use crate::call::Call;
use crate::numbers::item;
use crate::robots::{Robots, external};
use crate::rows::{OfRows, Rows};
use crate::time::{self, Instant};

/// Name, arguments and summary of the window function.
static MOMENTUM_RESIDUAL: OfRows = OfRows {
    name: "momentum_residual",
    is_timed: true,
    arguments: &["q", "qd", "tau"],
    over: " OVER (PARTITION BY … ORDER BY time)",
    summary: "Measured torques minus those of the model, without accelerations, by the momentum observer.",
};

/// The gain of the observer, Hz: the default of `rne watch`.
const GAIN: f64 = 20.0;

/// After a step longer than this many usual steps, the observer starts anew.
const GAP: f64 = 2.5;

/// The window function and the robots that its calls may name.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(crate) struct MomentumResidual(Call);

impl MomentumResidual {
    pub(crate) fn new(robots: Robots) -> Self {
        Self(MOMENTUM_RESIDUAL.call(robots))
    }
}

impl WindowUDFImpl for MomentumResidual {
    fn name(&self) -> &'static str {
        MOMENTUM_RESIDUAL.name
    }

    fn signature(&self) -> &Signature {
        &self.0.signature
    }

    fn coerce_types(&self, given: &[DataType]) -> Result<Vec<DataType>> {
        MOMENTUM_RESIDUAL.coerced(given)
    }

    fn expressions(&self, given: ExpressionArgs<'_>) -> Vec<Arc<dyn PhysicalExpr>> {
        given.input_exprs().to_vec()
    }

    fn field(&self, given: WindowUDFFieldArgs<'_>) -> Result<FieldRef> {
        Ok(Arc::new(Field::new(given.name(), DataType::List(item(DataType::Float64)), true)))
    }

    fn partition_evaluator(&self, given: PartitionEvaluatorArgs<'_>) -> Result<Box<dyn PartitionEvaluator>> {
        let (_, rows) = MOMENTUM_RESIDUAL.of(&self.0, given.input_exprs(), given.input_fields())?;
        Ok(Box::new(Partition(rows)))
    }

    fn documentation(&self) -> Option<&Documentation> {
        Some(self.0.documentation())
    }
}

/// The rows of one partition, in order of time.
#[derive(Debug)]
struct Partition(Rows);

impl PartitionEvaluator for Partition {
    fn evaluate_all(&mut self, values: &[ArrayRef], rows: usize) -> Result<ArrayRef> {
        let [_, instants, arrays @ ..] = values else {
            return exec_err!("{}: `time` is missing", MOMENTUM_RESIDUAL.name);
        };
        let Self(of) = self;
        let joints = of.robot.dof();
        let (arguments, nulls) = of.arguments(arrays)?;
        let instants =
            (0..rows).map(|row| time::at(MOMENTUM_RESIDUAL.name, instants, row)).collect::<Result<Vec<_>>>()?;
        let is_null = |row: usize| nulls.as_ref().is_some_and(|nulls| nulls.is_null(row));
        let instants: Vec<Option<Instant>> = instants
            .into_iter()
            .enumerate()
            .map(|(row, instant)| instant.filter(|_| !is_null(row) && is_finite(&arguments, row, joints)))
            .collect();
        let period = period(&instants);
        let arm = DynArm::from_robot(&of.robot.clone().with_rotors());
        let mut result = ListBuilder::new(Float64Builder::new());
        let mut observed: Option<(Instant, Observed)> = None;
        for (row, instant) in instants.into_iter().enumerate() {
            let Some(instant) = instant else {
                observed = None;
                result.append_null();
                continue;
            };
            let goes_on = observed.take().filter(|(before, _)| {
                let step = instant.since(*before);
                0.0 < step && step <= GAP * period
            });
            let is_first = goes_on.is_none();
            let mut state = goes_on.map_or_else(|| Observed::new(&of.robot, period), |(_, state)| state);
            let residual = state.next(&arm, &arguments, row, joints)?;
            observed = Some((instant, state));
            if is_first {
                result.append_null();
            } else {
                result.values().append_slice(&residual);
                result.append(true);
            }
        }
        Ok(Arc::new(result.finish()))
    }
}

/// Whether all numbers of a row are finite. One that is not would remain in the state of the observer.
fn is_finite(arguments: &[Argument<'_>], row: usize, joints: usize) -> bool {
    arguments.iter().all(|argument| (0..joints).all(|joint| argument.at(row, joint, joints).is_finite()))
}

/// Returns the median of the time steps, s.
fn period(instants: &[Option<Instant>]) -> f64 {
    let known: Vec<Instant> = instants.iter().copied().flatten().collect();
    let steps = known.windows(2).map(|pair| pair[1].since(pair[0])).filter(|step| *step > 0.0);
    let steps: Vec<f64> = steps.collect();
    if steps.is_empty() { 1.0 } else { median(steps) }
}

/// The state of the observer in a run without gaps.
struct Observed {
    observer: DynObserverState<f64>,
    friction: Vec<Friction>,
}

impl Observed {
    fn new(robot: &Robot, period: f64) -> Self {
        Self {
            observer: DynObserverState::new(robot.dof(), GAIN, period),
            friction: robot.independent_joints().map(Friction::of).collect(),
        }
    }

    /// Updates the observer with a row and returns the residual.
    fn next(&mut self, arm: &DynArm, arguments: &[Argument<'_>], row: usize, joints: usize) -> Result<Vec<f64>> {
        let of = |at: usize| -> Vec<f64> { (0..joints).map(|joint| arguments[at].at(row, joint, joints)).collect() };
        let [q, qd, mut tau] = [of(0), of(1), of(2)];
        for (joint, friction) in self.friction.iter_mut().enumerate() {
            tau[joint] -= friction.next(q[joint], qd[joint]);
        }
        let torques = self.observer.update(arm, &q, &qd, &tau).map_err(external)?;
        Ok(torques.into_iter().map(|torque| -torque).collect())
    }
}
