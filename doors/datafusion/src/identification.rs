//! Identification as an aggregate: `identification('puma560@…', q, qd, qdd, tau)`.

use std::sync::Arc;

use datafusion::arrow::array::{Array, ArrayRef};
use datafusion::arrow::datatypes::{DataType, FieldRef};
use datafusion::common::{Result, ScalarValue, exec_err, plan_err};
use datafusion::logical_expr::function::{AccumulatorArgs, StateFieldsArgs};
use datafusion::logical_expr::{Accumulator, AggregateUDFImpl, Documentation, Signature};
use datafusion::physical_expr::expressions::Literal;
use rne_identify::{Fit, Information, Structure};
use rne_logs::Motion;

use crate::argument::{self, Argument};
use crate::call::{Call, key};
use crate::found::{self, Found};
use crate::function::coerced;
use crate::numbers;
use crate::robots::{Held, Robots, external};

const NAME: &str = "identification";

/// The arguments after the robot.
const ARGUMENTS: [&str; 4] = ["q", "qd", "qdd", "tau"];

/// How strongly links are pulled to those of the file, as `rne identify` does unasked.
pub(crate) const REGULARIZATION: f64 = 1.0;

const SUMMARY: &str = "Links and friction from states with measured torques, by least squares row by row.";

/// The aggregate, with the robots that it may be asked for.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(crate) struct IdentificationFunction(Call);

impl IdentificationFunction {
    pub(crate) fn new(robots: Robots) -> Self {
        let syntax = format!("{NAME}(robot, {})", ARGUMENTS.join(", "));
        Self(Call::new(robots, &syntax, SUMMARY))
    }
}

impl AggregateUDFImpl for IdentificationFunction {
    fn name(&self) -> &'static str {
        NAME
    }

    fn signature(&self) -> &Signature {
        &self.0.signature
    }

    fn coerce_types(&self, given: &[DataType]) -> Result<Vec<DataType>> {
        coerced(NAME, given)
    }

    fn return_type(&self, _: &[DataType]) -> Result<DataType> {
        Ok(found::data_type())
    }

    fn state_fields(&self, given: StateFieldsArgs<'_>) -> Result<Vec<FieldRef>> {
        Ok(vec![numbers::field(given.name)])
    }

    fn accumulator(&self, given: AccumulatorArgs<'_>) -> Result<Box<dyn Accumulator>> {
        if given.is_distinct {
            return plan_err!("{NAME}: DISTINCT is not for rows of states; select the distinct rows before");
        }
        let robot = given.exprs.first().and_then(|robot| robot.downcast_ref::<Literal>());
        let held = self.0.robots.get(key(NAME, robot.map(Literal::value))?)?;
        let columns = argument::columns(given.expr_fields);
        let robot = held.arm.robot();
        argument::check(NAME, &ARGUMENTS, &columns, robot)?;
        let columns = columns.iter().map(|column| column.name.to_owned()).collect();
        Ok(Box::new(Gathered::new(held, columns)))
    }

    fn documentation(&self) -> Option<&Documentation> {
        Some(self.0.documentation())
    }
}

/// What the rows of a group say, so far.
#[derive(Debug)]
struct Gathered {
    structure: Arc<Structure>,
    information: Information,
    /// The names of the columns after the robot.
    columns: Vec<String>,
}

impl Gathered {
    fn new(held: &Held, columns: Vec<String>) -> Self {
        let structure = held.structure();
        let information = Information::unordered(&structure);
        Self { structure, information, columns }
    }

    fn joints(&self) -> usize {
        self.structure.robot().dof()
    }

    /// Of an argument the numbers of each joint in those states.
    fn of_joints(&self, argument: &Argument<'_>, states: &[usize]) -> Vec<Vec<f64>> {
        let joints = self.joints();
        (0..joints).map(|joint| states.iter().map(|&state| argument.at(state, joint, joints)).collect()).collect()
    }

    /// The first number that is none, with its column.
    fn check_finite(&self, arguments: &[Argument<'_>], lists: &[Vec<Vec<f64>>], states: &[usize]) -> Result<()> {
        let mut first = 0;
        for (argument, list) in arguments.iter().zip(lists) {
            let (width, step) = if matches!(argument, Argument::Columns(_)) { (self.joints(), 1) } else { (1, 0) };
            for (joint, numbers) in list.iter().enumerate() {
                if let Some(at) = numbers.iter().position(|number| !number.is_finite()) {
                    let column = self.columns.get(first + step * joint).map_or("?", String::as_str);
                    return exec_err!(
                        "{NAME}: column `{column}`, row {} of a batch: joint {} has {}, which is no finite number",
                        states[at] + 1,
                        joint + 1,
                        numbers[at]
                    );
                }
            }
            first += width;
        }
        Ok(())
    }
}

impl Accumulator for Gathered {
    fn update_batch(&mut self, values: &[ArrayRef]) -> Result<()> {
        let arrays = values.get(1..).unwrap_or_default();
        let columns: Vec<&str> = self.columns.iter().map(String::as_str).collect();
        let (arguments, nulls) = argument::all(NAME, &ARGUMENTS, &columns, arrays, self.structure.robot())?;
        let rows = arrays.first().map_or(0, Array::len);
        let states: Vec<usize> =
            (0..rows).filter(|&state| nulls.as_ref().is_none_or(|nulls| nulls.is_valid(state))).collect();
        let lists: Vec<Vec<Vec<f64>>> = arguments.iter().map(|argument| self.of_joints(argument, &states)).collect();
        self.check_finite(&arguments, &lists, &states)?;
        let Ok([q, qd, qdd, tau]) = <[Vec<Vec<f64>>; 4]>::try_from(lists) else { return Ok(()) };
        // rows of a table have no time: nothing is asked of it but to grow
        let time = (0_u32..).map(f64::from).take(states.len()).collect();
        let motion = Motion { time, q, qd, qdd, tau, ..Motion::default() };
        self.information.absorb(&self.structure, &motion, None).map_err(external)
    }

    fn state(&mut self) -> Result<Vec<ScalarValue>> {
        Ok(vec![numbers::scalar(self.information.to_numbers())?])
    }

    fn merge_batch(&mut self, states: &[ArrayRef]) -> Result<()> {
        numbers::each(NAME, states, |numbers| {
            let part = Information::from_numbers(&self.structure, numbers).map_err(external)?;
            self.information.merge(part);
            Ok(())
        })
    }

    fn evaluate(&mut self) -> Result<ScalarValue> {
        if self.information.states() == 0 {
            return ScalarValue::try_from(&found::data_type());
        }
        let fit = Fit::new(&self.structure, &self.information, REGULARIZATION);
        Found::of_fit(&self.structure, &fit, self.information.states()).scalar()
    }

    fn size(&self) -> usize {
        size_of_val(self) + self.information.size() * size_of::<f64>()
    }
}
