//! The robot file of a derive, as its tests know it.

use rne_model::{Reader, Robot};

use crate::DynArm;

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
    pub(super) fn robot(&self) -> (Robot, DynArm) {
        let read = Reader::new("robot file").trees().couplings().loops().read(self.text);
        let checked = read.unwrap_or_else(|report| panic!("{report}"));
        let robot = Robot { rotors: self.rotors, ..checked.robot };
        let arm = DynArm::from_robot(&robot);
        (robot, arm)
    }
}
