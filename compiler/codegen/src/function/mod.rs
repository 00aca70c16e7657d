//! The functions of a robot that can be compiled, and the forms they can take.

mod own;

pub use rne_functions::{
    Answer, AnswerTable, Argument, ArgumentPart, Axes, Base, Capability, Entry, Function, Labels, Layout, Length, Load,
    MatrixUnit, Owner, Record, Shape, Sizes, What,
};
use rne_model::{FrameId, Robot};

use crate::named::{UnknownName, named};

pub use own::{Own, own};

/// Returns the function with this name.
///
/// # Errors
/// When no function has this name.
pub fn function_named(name: &str) -> Result<Function, UnknownName> {
    Function::named(name).ok_or_else(|| UnknownName {
        found: name.to_owned(),
        what: "function",
        allowed: &Function::NAMES,
    })
}

/// Returns the functions that a robot has: those of closed loops if it has closed loops, otherwise all others.
pub fn functions_of(robot: &Robot) -> impl Iterator<Item = Function> + use<> {
    let has_loops = !robot.closed.is_empty();
    Function::ALL.into_iter().filter(move |function| function.is_of_closed_loops() == has_loops)
}

/// Returns the function for which the plan of a robot minimises the number of operations: the torques, and for a robot
/// with a floating base also the wrench on the base.
#[must_use]
pub fn function_of_plan(robot: &Robot) -> Function {
    match (robot.floating_base.is_some(), robot.closed.is_empty()) {
        (true, true) => Function::InverseDynamicsOfFloatingBase,
        (true, false) => Function::InverseDynamicsOfFloatingLoops,
        (false, true) => Function::InverseDynamics,
        (false, false) => Function::InverseDynamicsOfLoops,
    }
}

/// Returns the lengths of the arrays of a robot.
#[must_use]
pub fn sizes_of(robot: &Robot) -> Sizes {
    let closed = &robot.closed;
    Sizes { dof: robot.dof(), tips: robot.tip_count(), passive: closed.passive.len(), equations: closed.equations() }
}

/// Properties of a function that depend on the robot.
pub trait OfRobot: Sized {
    /// Returns the frame that code for this function is compiled for: the frame that was selected in `robot`, if the
    /// function is about a frame.
    #[must_use]
    fn frame(self, robot: &Robot) -> Option<FrameId>;

    /// Returns the name of the function's code for a robot: the name of the function, and for a selected frame also
    /// that of the frame, as in `jacobian_of_camera`. In it, a character of a joint's name that is no letter, digit or
    /// `_` becomes `_`.
    #[must_use]
    fn name_for(self, robot: &Robot) -> String;

    /// Whether the function treats the base of a robot with a floating base as fixed: the plan of the robot is not made
    /// for such functions.
    #[must_use]
    fn holds_floating_base(self, robot: &Robot) -> bool;
}

impl OfRobot for Function {
    fn frame(self, robot: &Robot) -> Option<FrameId> {
        robot.at.filter(|_| self.of_frame().is_some())
    }

    fn name_for(self, robot: &Robot) -> String {
        match (self.of_frame(), robot.at) {
            (Some(of_frame), Some(frame)) => {
                let name = robot.frame_name(frame).chars();
                let name: String = name.map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
                format!("{of_frame}_of_{name}")
            }
            _ => self.name().to_owned(),
        }
    }

    fn holds_floating_base(self, robot: &Robot) -> bool {
        function_of_plan(robot).is_of_floating_base() && !self.is_of_floating_base()
    }
}

named! {
    /// How a function is computed.
    #[derive(Default)]
    Form, "form" {
        /// The lecture's seven steps: every intermediate quantity has a physical meaning.
        #[default]
        SevenSteps = "seven_steps",
        /// Fewest operations: of all quantities, only the torques have a physical meaning.
        Reduced = "reduced",
    }
}
