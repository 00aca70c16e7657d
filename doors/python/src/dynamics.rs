//! The functions of the class `Arm`, from arrays to arrays. `build.rs` writes these methods from the compiler's table
//! of functions.

use pyo3::prelude::*;
use rne_codegen::{Argument, Function, Length, Record, Shape};

use crate::arm::Arm;
use crate::arrays::Given;

impl Arm {
    /// An argument that must be given.
    fn given<'py>(&self, argument: Argument, value: &Bound<'py, PyAny>) -> PyResult<Given<'py>> {
        let (name, elements) = (argument.name(), self.elements(argument));
        Ok(match argument.shape() {
            Shape::Number => Given::number(name, value)?,
            Shape::Array(Length::Joints, _) => self.of_joints(name, value)?,
            Shape::Array(Length::Passive, _) => self.of_passive(name, value)?,
            Shape::Array(Length::Tips, _) => self.of_tips(name, Some(value))?,
            Shape::Array(_, Shape::Array(..)) => self.of_rotation(name, value)?,
            Shape::Record(Record::Pose, _) => self.of_pose(name, value)?,
            Shape::Record(Record::Wrench, _) => {
                Given { parts: &["force", "moment"], ..Given::vector(name, elements, value.clone()) }
            }
            _ => Given::vector(name, elements, value.clone()),
        })
    }
}

include!(concat!(env!("OUT_DIR"), "/methods.rs"));
