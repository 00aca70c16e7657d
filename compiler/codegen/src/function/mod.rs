//! The functions of a robot that can be compiled, and the forms they can take.

mod own;

pub use rne_functions::{
    Answer, AnswerTable, Argument, ArgumentPart, Axes, Base, Capability, Entry, Function, Labels, Layout, Length, Load,
    MatrixUnit, Owner, Record, Shape, Sizes, What,
};
use rne_model::{FrameId, Robot};

use crate::named::{UnknownName, named};

pub use own::{Own, own};

/// The function with a name.
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

/// The functions that a robot has: those of its closed loops, or all others.
pub fn functions_of(robot: &Robot) -> impl Iterator<Item = Function> + use<> {
    let has_loops = !robot.closed.is_empty();
    Function::ALL.into_iter().filter(move |function| function.is_of_closed_loops() == has_loops)
}

/// The function whose operations the plan of a robot is to make few: the torques, and with them the wrench on the base
/// of a robot with a floating base.
#[must_use]
pub fn function_of_plan(robot: &Robot) -> Function {
    match (robot.floating_base.is_some(), robot.closed.is_empty()) {
        (true, true) => Function::InverseDynamicsOfFloatingBase,
        (true, false) => Function::InverseDynamicsOfFloatingLoops,
        (false, true) => Function::InverseDynamics,
        (false, false) => Function::InverseDynamicsOfLoops,
    }
}

/// The lengths of the arrays of a robot.
#[must_use]
pub fn sizes_of(robot: &Robot) -> Sizes {
    let closed = &robot.closed;
    Sizes { dof: robot.dof(), tips: robot.tip_count(), passive: closed.passive.len(), equations: closed.equations() }
}

/// A function of one robot.
pub trait OfRobot: Sized {
    /// The frame that a program of this function is compiled for, if `robot` is seen from one and the function can be.
    #[must_use]
    fn frame(self, robot: &Robot) -> Option<FrameId>;

    /// The name of its code for a robot: its own, or at a frame `jacobian_of_camera`. A character of a joint's name
    /// that is no letter, digit or `_` becomes `_`.
    #[must_use]
    fn name_for(self, robot: &Robot) -> String;

    /// Whether it holds still the base of a robot with a floating base: the plan of the robot is not for it.
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
        /// The seven steps: every intermediate is the lecture's.
        #[default]
        SevenSteps = "seven_steps",
        /// Fewest operations: only the torques keep a physical meaning.
        Reduced = "reduced",
    }
}
