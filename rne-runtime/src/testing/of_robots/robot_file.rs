//! The robot file of a derive, for its tests.

use rne_model::{Reader, Robot};

use crate::DynArm;

/// The robot file of a derive, and the options with which the derive read it.
#[derive(Clone, Copy, Debug)]
pub struct RobotFile {
    /// The text.
    pub text: &'static str,
    /// Whether rotors belong to the arm.
    pub rotors: bool,
    /// Whether the form of the code is the seven steps, which have the bits of the runtime.
    pub seven_steps: bool,
}

impl RobotFile {
    /// Reads the robot at run time.
    pub(super) fn robot(&self) -> (Robot, DynArm) {
        let read = Reader::new("robot file").trees().couplings().loops().read(self.text);
        let checked = read.unwrap_or_else(|report| panic!("{report}"));
        let robot = Robot { rotors: self.rotors, ..checked.robot };
        let arm = DynArm::from_robot(&robot);
        (robot, arm)
    }
}
