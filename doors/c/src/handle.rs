//! The arm to which a handle of C points: how it is loaded, and its properties.

use std::ffi::{CStr, CString};
use std::path::Path;
use std::sync::LazyLock;

use rne_codegen::UnknownName;
use rne_convert::{Description, Selection};
use rne_machine::{ARGUMENTS, CompiledArm, CompiledFunction, Function};
use rne_robots::RobotFile;

use crate::status::{Failure, Status, c_text};

/// An arm. Its functions are compiled when they are first called, once; any number of threads may use it at once.
///
/// What it points to is this library's: made by rne_arm_load_file() and its like, freed by rne_arm_free().
#[derive(Debug)]
pub struct Arm {
    compiled: CompiledArm,
    name: CString,
    joints: Vec<CString>,
}

/// How a joint moves: which units its position, rate, acceleration and torque have.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// About its axis: rad, rad/s, rad/s², N m.
    Revolute = 0,
    /// Along its axis: m, m/s, m/s², N.
    Prismatic = 1,
}

/// What a joint may do. Infinite where the robot file says nothing.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Lower end of its position, rad or m.
    pub lower: f64,
    /// Upper end of its position, rad or m.
    pub upper: f64,
    /// Largest speed, rad/s or m/s.
    pub velocity: f64,
    /// Largest torque or force, N m or N.
    pub effort: f64,
}

impl Arm {
    fn new(arm: CompiledArm) -> Self {
        let robot = arm.robot();
        let name = c_text(&robot.name);
        let joints = robot.independent_joints().map(|joint| c_text(&joint.name)).collect();
        Self { compiled: arm, name, joints }
    }

    /// Loads the arm of a robot file and the plan file beside it, or of a shipped robot.
    pub(crate) fn of_file(path: &str) -> Result<Self, Failure> {
        match Description::open(Path::new(path))? {
            Description::Shipped(file) => Self::of_shipped(file),
            // a URDF is refused, with the name of the function that reads it
            _ => Ok(Self::new(CompiledArm::from_file(path)?)),
        }
    }

    /// Loads the arm that the text of a robot file describes.
    pub(crate) fn of_text(text: &str) -> Result<Self, Failure> {
        Ok(Self::new(CompiledArm::from_yaml(text)?))
    }

    /// Loads the arm of a URDF, as `rne import` converts it.
    pub(crate) fn of_urdf(path: &str, selection: Selection) -> Result<Self, Failure> {
        let (Description::Urdf(bytes) | Description::RobotFile(bytes)) = Description::open(Path::new(path))? else {
            return Err(Failure::new(Status::InvalidFile, format!("{path} is a shipped robot, no URDF")));
        };
        let imported = rne_convert::import_arm(path, bytes, selection)?;
        Ok(Self::new(CompiledArm::from_yaml(&imported.text)?))
    }

    /// Loads a shipped robot by its name, with its plan.
    pub(crate) fn of_name(name: &str) -> Result<Self, Failure> {
        Self::of_shipped(rne_convert::shipped(name).map_err(|message| Failure::new(Status::UnknownName, message))?)
    }

    fn of_shipped(file: &RobotFile) -> Result<Self, Failure> {
        Ok(Self::new(match file.plan {
            Some(plan) => CompiledArm::with_plan(file.yaml, plan)?,
            None => CompiledArm::from_yaml(file.yaml)?,
        }))
    }

    /// Returns an arm that has a frame in the place of the tip.
    pub(crate) fn at_frame(&self, frame: &str) -> Result<Self, Failure> {
        let arm = self.compiled.at_frame(frame);
        Ok(Self::new(arm.map_err(|unknown| Failure::new(Status::UnknownName, unknown.to_string()))?))
    }

    /// Returns the compiled arm, which computes the functions.
    pub(crate) fn compiled(&self) -> &CompiledArm {
        &self.compiled
    }

    pub(crate) fn name(&self) -> &CString {
        &self.name
    }

    pub(crate) fn joint_name(&self, joint: usize) -> Result<&CString, Failure> {
        self.joints.get(joint).ok_or_else(|| self.no_joint(joint))
    }

    pub(crate) fn limits(&self, joint: usize) -> Result<Limits, Failure> {
        let limits =
            self.compiled.robot().coordinate_limits().get(joint).copied().ok_or_else(|| self.no_joint(joint))?;
        let (lower, upper) = limits.position.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        let or_none = |limit: Option<f64>| limit.unwrap_or(f64::INFINITY);
        Ok(Limits { lower, upper, velocity: or_none(limits.velocity), effort: or_none(limits.effort) })
    }

    pub(crate) fn joint_kind(&self, joint: usize) -> Result<JointKind, Failure> {
        let joint = self.compiled.robot().independent_joint(joint).ok_or_else(|| self.no_joint(joint))?;
        Ok(match joint.row.kind {
            rne_model::JointKind::Revolute => JointKind::Revolute,
            rne_model::JointKind::Prismatic => JointKind::Prismatic,
        })
    }

    fn no_joint(&self, joint: usize) -> Failure {
        let message = format!("there is no joint {joint}: this arm has {}, counted from 0", self.joints.len());
        Failure::new(Status::OutOfRange, message)
    }

    /// Compiles a function, if this has not been done yet, and returns it.
    pub(crate) fn function(&self, id: u32) -> Result<&CompiledFunction, Failure> {
        Ok(self.compiled.function(function(id)?)?)
    }

    /// Compiles a function for single states, in both precisions.
    pub(crate) fn prepare(&self, id: u32) -> Result<(), Failure> {
        let function = self.function(id)?;
        function.prepare::<f64>();
        function.prepare::<f32>();
        Ok(())
    }

    /// Returns the name of an argument of a function, and how many elements it has for a state.
    pub(crate) fn argument(&self, id: u32, argument: usize) -> Result<(&'static CStr, usize), Failure> {
        let arguments = self.function(id)?.arguments();
        let none = || {
            let message = format!("there is no argument {argument}: it takes {}, counted from 0", arguments.len());
            Failure::new(Status::OutOfRange, message)
        };
        let &(name, elements) = arguments.get(argument).ok_or_else(none)?;
        Ok((argument_name(name).ok_or_else(none)?, elements))
    }
}

/// Returns the function with this id.
pub(crate) fn function(id: u32) -> Result<Function, Failure> {
    let found = usize::try_from(id).ok().and_then(|id| Function::ALL.get(id).copied());
    found.ok_or_else(|| {
        let message = format!("no function has the id {id}; rne_function_find() gives them");
        Failure::new(Status::OutOfRange, message)
    })
}

/// Returns the id of the function with this name.
pub(crate) fn function_id(name: &str) -> Result<u32, Failure> {
    let function = rne_codegen::function_named(name)
        .map_err(|error: UnknownName| Failure::new(Status::UnknownName, error.to_string()))?;
    let id = Function::ALL.iter().position(|other| *other == function).and_then(|id| u32::try_from(id).ok());
    id.ok_or_else(|| Failure::new(Status::UnknownName, format!("there is no function `{name}`")))
}

/// Returns the name of an argument as a text of C.
fn argument_name(name: &str) -> Option<&'static CStr> {
    static NAMES: LazyLock<Vec<CString>> = LazyLock::new(|| ARGUMENTS.iter().map(|name| c_text(name)).collect());
    NAMES.iter().map(CString::as_c_str).find(|known| known.to_bytes() == name.as_bytes())
}

#[cfg(test)]
mod tests {
    use rne_convert::Selection;

    use super::Arm;

    #[test]
    fn angles_of_a_urdf_are_those_of_rne_import() {
        let body = "<inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/>\
                    </inertial></link>";
        let text = format!(
            "<robot name=\"two\"><link name=\"base\"/><link name=\"a\">{body}<link name=\"b\">{body}\
             <joint name=\"one\" type=\"continuous\"><parent link=\"base\"/><child link=\"a\"/>\
             <axis xyz=\"0 0 1\"/></joint>\
             <joint name=\"two\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/>\
             <origin rpy=\"1.5708 0 0\"/><axis xyz=\"0 0 1\"/></joint></robot>"
        );
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("two.urdf");
        std::fs::write(&file, text).expect("a file");
        let arm = Arm::of_urdf(file.to_str().expect("Unicode"), Selection::default()).expect("an arm");
        let mut joints = arm.compiled().robot().joints.iter();
        assert!(joints.any(|joint| joint.row.dh.alpha.radians.abs() == std::f64::consts::FRAC_PI_2));
    }
}
