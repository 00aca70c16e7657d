//! The robot file of a derive, as its tests know it.

use rne_model::Robot;

use super::comparison::Allowed;
use crate::Arm;

/// The robot file of a derive, and how the derive read it.
#[derive(Clone, Copy, Debug)]
pub struct RobotFile {
    /// The text.
    pub text: &'static str,
    /// Whether rotors belong to the arm.
    pub rotors: bool,
    /// Whether the code is the seven steps, which have the bits of the runtime.
    pub seven_steps: bool,
}

impl RobotFile {
    /// Reads the robot at run time.
    pub(super) fn arm<const DOF: usize>(&self) -> Arm<DOF> {
        let robot = Robot::from_yaml(self.text).unwrap_or_else(|report| panic!("{report}"));
        let robot = Robot { rotors: self.rotors, ..robot };
        Arm::from_robot(&robot).unwrap_or_else(|error| panic!("{error}"))
    }

    /// How far from the runtime a function may be whose seven steps are the runtime's operations in its order. `scale`
    /// as in [`Allowed::Rounding`].
    pub(super) fn same_operations(&self, scale: f64) -> Allowed {
        if self.seven_steps { Allowed::Nothing } else { Allowed::Rounding { scale } }
    }
}
