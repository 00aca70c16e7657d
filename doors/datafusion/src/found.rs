//! The result of an identification, as a struct of SQL.

use std::sync::Arc;

use datafusion::arrow::array::{
    ArrayRef, BooleanArray, Float64Array, Int64Array, ListArray, StringArray, StructArray, new_null_array,
};
use datafusion::arrow::buffer::OffsetBuffer;
use datafusion::arrow::datatypes::{DataType, Field, Fields};
use datafusion::common::{Result, ScalarValue};
use rne::model::JointKind;
use rne_identify::{BaseReport, Fit, Identification, Structure};

use crate::numbers::item;

/// The names of the friction coefficients of a joint; the number of the joint is appended to each.
const FRICTION: [&str; 3] = ["viscous", "coulomb_forward", "coulomb_backward"];

/// The result of an identification.
pub(crate) struct Found {
    states: u64,
    unknowns: Vec<Unknown>,
    noise: Vec<f64>,
    robot: String,
    delay: Option<f64>,
}

/// The result for one unknown.
struct Unknown {
    name: String,
    value: f64,
    deviation: f64,
    unit: &'static str,
    is_excited: bool,
}

impl Found {
    /// The result of `identification`, whose rows have no order in time.
    pub(crate) fn of_fit(structure: &Structure, fit: &Fit, states: u64) -> Self {
        let friction = fit.friction.iter().enumerate().map(|(at, of)| (Some(*of), fit.is_friction_excited(at)));
        Self {
            states,
            unknowns: unknowns(structure, &fit.bases, friction),
            noise: fit.least_squares.noise.clone(),
            robot: fit.robot_file(&format!("{states} states of a table")),
            delay: None,
        }
    }

    /// The result of `identify`, whose rows are a log.
    pub(crate) fn of_log(found: &Identification) -> Self {
        let friction = found.joints.iter().map(|joint| (joint.friction, joint.is_friction_excited()));
        Self {
            states: found.states,
            unknowns: unknowns(&found.structure, &found.bases, friction),
            noise: found.joints.iter().map(|joint| joint.noise).collect(),
            robot: found.robot_file(&format!("{} states of a table", found.states)),
            delay: found.delay.map(|(delay, _)| delay),
        }
    }

    /// Returns the result as the value of an aggregate, an SQL struct.
    pub(crate) fn scalar(&self) -> Result<ScalarValue> {
        let texts = |of: fn(&Unknown) -> &str| -> ArrayRef {
            Arc::new(self.unknowns.iter().map(of).map(Some).collect::<StringArray>())
        };
        let numbers = |of: fn(&Unknown) -> f64| -> ArrayRef {
            Arc::new(self.unknowns.iter().map(of).map(Some).collect::<Float64Array>())
        };
        let excited: BooleanArray = self.unknowns.iter().map(|unknown| Some(unknown.is_excited)).collect();
        let columns = vec![
            texts(|unknown| &unknown.name),
            numbers(|unknown| unknown.value),
            numbers(|unknown| unknown.deviation),
            texts(|unknown| unknown.unit),
            Arc::new(excited),
        ];
        let unknowns = StructArray::try_new(unknown_fields(), columns, None)?;
        let one = |values: ArrayRef| -> Result<ArrayRef> {
            let (of, offsets) = (item(values.data_type().clone()), OffsetBuffer::from_lengths([values.len()]));
            Ok(Arc::new(ListArray::try_new(of, offsets, values, None)?))
        };
        let columns: Vec<ArrayRef> = vec![
            Arc::new(Int64Array::from(vec![i64::try_from(self.states).unwrap_or(i64::MAX)])),
            one(Arc::new(unknowns))?,
            one(Arc::new(Float64Array::from(self.noise.clone())))?,
            Arc::new(StringArray::from(vec![self.robot.clone()])),
            Arc::new(Float64Array::from(vec![self.delay])),
            Arc::new(StringArray::from(vec![None::<String>])),
        ];
        Ok(ScalarValue::Struct(Arc::new(StructArray::try_new(fields(), columns, None)?)))
    }
}

/// The result of an aggregate whose rows do not identify the parameters: the number of states and the reason. The other
/// fields are null.
pub(crate) fn refused(states: u64, reason: &str) -> Result<ScalarValue> {
    let column = |field: &Arc<Field>| -> ArrayRef {
        match field.name().as_str() {
            "states" => Arc::new(Int64Array::from(vec![i64::try_from(states).unwrap_or(i64::MAX)])),
            "error" => Arc::new(StringArray::from(vec![reason])),
            _ => new_null_array(field.data_type(), 1),
        }
    };
    let columns = fields().iter().map(column).collect();
    Ok(ScalarValue::Struct(Arc::new(StructArray::try_new(fields(), columns, None)?)))
}

/// Returns the base parameters, base to tip, then the friction coefficients of each joint. Each has a flag that tells
/// whether the rows determine it.
fn unknowns(
    structure: &Structure,
    bases: &[BaseReport],
    friction: impl Iterator<Item = (Option<[(f64, f64); 3]>, bool)>,
) -> Vec<Unknown> {
    let bases = structure.parameters().bases.iter().zip(bases).map(|(base, report)| Unknown {
        name: report.name.clone(),
        value: report.value,
        deviation: report.deviation,
        unit: structure.unit(base.kept),
        is_excited: report.is_excited(),
    });
    let joints = structure.robot().independent_joints().zip(friction).enumerate();
    let friction = joints.flat_map(|(at, (joint, (friction, is_excited)))| {
        let kind = joint.row.kind;
        let viscous = if kind == JointKind::Revolute { "N m s/rad" } else { "N s/m" };
        let units = [viscous, kind.effort_unit(), kind.effort_unit()];
        let each = FRICTION.into_iter().zip(units).zip(friction.into_iter().flatten());
        each.map(move |((name, unit), (value, deviation))| Unknown {
            name: format!("{name}{}", at + 1),
            value,
            deviation,
            unit,
            is_excited,
        })
    });
    bases.chain(friction).collect()
}

fn unknown_fields() -> Fields {
    Fields::from(vec![
        Field::new("parameter", DataType::Utf8, true),
        Field::new("value", DataType::Float64, true),
        Field::new("deviation", DataType::Float64, true),
        Field::new("unit", DataType::Utf8, true),
        Field::new("excited", DataType::Boolean, true),
    ])
}

fn fields() -> Fields {
    Fields::from(vec![
        Field::new("states", DataType::Int64, true),
        Field::new("parameters", DataType::List(item(DataType::Struct(unknown_fields()))), true),
        Field::new("noise", DataType::List(item(DataType::Float64)), true),
        Field::new("robot", DataType::Utf8, true),
        Field::new("delay", DataType::Float64, true),
        Field::new("error", DataType::Utf8, true),
    ])
}

/// The type of the result.
pub(crate) fn data_type() -> DataType {
    DataType::Struct(fields())
}
