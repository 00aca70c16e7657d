//! Identification as an aggregate: `identification('puma560@…', q, qd, qdd, tau)`.

use std::sync::Arc;

use datafusion::arrow::array::{Array, ArrayRef};
use datafusion::common::{Result, ScalarValue, exec_err};
use datafusion::logical_expr::Accumulator;
use rne_identify::{Fit, Information, Structure};
use rne_logs::Motion;

use crate::argument::Argument;
use crate::found::{self, Found};
use crate::numbers;
use crate::robots::{Held, external};
use crate::rows::{OfRows, Rows};

/// Name, arguments and summary of the aggregate.
pub(crate) static IDENTIFICATION: OfRows = OfRows {
    name: "identification",
    is_timed: false,
    arguments: &["q", "qd", "qdd", "tau"],
    over: "",
    summary: "Links and friction from states with measured torques, by least squares row by row.",
};

/// The weight that keeps link parameters near those of the robot file; the default of `rne identify`.
pub(crate) const REGULARIZATION: f64 = 1.0;

/// The least-squares information of the rows of a group that were read so far.
#[derive(Debug)]
pub(crate) struct Gathered {
    structure: Arc<Structure>,
    information: Information,
    rows: Rows,
}

impl Gathered {
    pub(crate) fn new(held: &Held, rows: Rows) -> Self {
        let structure = held.structure();
        let information = Information::unordered(&structure);
        Self { structure, information, rows }
    }

    fn joints(&self) -> usize {
        self.structure.robot().dof()
    }

    /// Returns the numbers of an argument in some states, one list per joint.
    fn of_joints(&self, argument: &Argument<'_>, states: &[usize]) -> Vec<Vec<f64>> {
        let joints = self.joints();
        (0..joints).map(|joint| states.iter().map(|&state| argument.at(state, joint, joints)).collect()).collect()
    }

    /// Returns an error that names the first number that is not finite, with its column.
    fn check_finite(&self, arguments: &[Argument<'_>], lists: &[Vec<Vec<f64>>], states: &[usize]) -> Result<()> {
        let mut first = 0;
        for (argument, list) in arguments.iter().zip(lists) {
            let (width, step) = if matches!(argument, Argument::Columns(_)) { (self.joints(), 1) } else { (1, 0) };
            for (joint, numbers) in list.iter().enumerate() {
                if let Some(at) = numbers.iter().position(|number| !number.is_finite()) {
                    let column = self.rows.columns.get(first + step * joint).map_or("?", String::as_str);
                    return exec_err!(
                        "{}: column `{column}`, row {} of a batch: joint {} has {}, which is no finite number",
                        IDENTIFICATION.name,
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
        let (arguments, nulls) = self.rows.arguments(arrays)?;
        let rows = arrays.first().map_or(0, Array::len);
        let states: Vec<usize> =
            (0..rows).filter(|&state| nulls.as_ref().is_none_or(|nulls| nulls.is_valid(state))).collect();
        let lists: Vec<Vec<Vec<f64>>> = arguments.iter().map(|argument| self.of_joints(argument, &states)).collect();
        self.check_finite(&arguments, &lists, &states)?;
        let Ok([q, qd, qdd, tau]) = <[Vec<Vec<f64>>; 4]>::try_from(lists) else { return Ok(()) };
        // rows have no time; this one only has to increase
        let time = (0_u32..).map(f64::from).take(states.len()).collect();
        let motion = Motion { time, q, qd, qdd, tau, ..Motion::default() };
        self.information.absorb(&self.structure, &motion, None).map_err(external)
    }

    fn state(&mut self) -> Result<Vec<ScalarValue>> {
        Ok(vec![numbers::scalar(self.information.to_numbers())?])
    }

    fn merge_batch(&mut self, states: &[ArrayRef]) -> Result<()> {
        numbers::each(IDENTIFICATION.name, states, |numbers| {
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
