//! Robots from robot files, at run time.

use core::array;
use std::path::Path;

use rne_model::{Reader, Robot, read_file};

use crate::{Arm, DynArm, LoadError, WrongJointCount};

impl<const DOF: usize> Arm<DOF> {
    /// The robot of the text of a robot file.
    ///
    /// # Errors
    /// With all errors in the text, or when it describes another number of joints than `DOF`.
    pub fn from_yaml(text: &str) -> Result<Self, LoadError> {
        Ok(Self::from_robot(&reader("<yaml>").read(text)?.robot)?)
    }

    /// The robot of a robot file. A relative `path` starts at the working directory.
    ///
    /// # Errors
    /// When the file cannot be read, with all errors in it, or when it has another number of joints than `DOF`.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, LoadError> {
        Ok(Self::from_robot(&read(path.as_ref(), false)?)?)
    }

    /// The robot of a robot file that has been read.
    ///
    /// # Errors
    /// When the robot does not have `DOF` joints, some of its joints follow others, or it has a list `motors`:
    /// [`DynArm`] takes such robots.
    pub fn from_robot(robot: &Robot) -> Result<Self, WrongJointCount> {
        let followers = robot.joints.len() - robot.dof();
        let drives = robot.drives.len();
        let wrong = WrongJointCount { expected: DOF, found: robot.joints.len(), followers, drives };
        let model = robot.model().filter(|_| followers == 0 && drives == 0).ok_or(wrong)?;
        let floating_base = robot.floating_base.as_ref().map(|base| base.link);
        let branches = array::from_fn(|joint| robot.joints[joint].branch);
        let arm = Self::prepared(model, branches, robot.tip_on, floating_base)
            .with_motors(array::from_fn(|joint| robot.joints[joint].motor));
        Ok(if robot.rotors { arm.with_rotors() } else { arm })
    }
}

impl DynArm {
    /// The robot of the text of a robot file.
    ///
    /// # Errors
    /// With all errors in the text.
    pub fn from_yaml(text: &str) -> Result<Self, LoadError> {
        Ok(Self::from_robot(&reader("<yaml>").loops().read(text)?.robot))
    }

    /// The robot of a robot file. A relative `path` starts at the working directory.
    ///
    /// # Errors
    /// When the file cannot be read, or with all errors in it.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, LoadError> {
        Ok(Self::from_robot(&read(path.as_ref(), true)?))
    }
}

fn read(path: &Path, loops: bool) -> Result<Robot, LoadError> {
    let bytes = read_file(path);
    let bytes = bytes.map_err(|error| LoadError::Unreadable { path: path.into(), error })?;
    let name = path.display().to_string();
    let reader = if loops { reader(&name).loops() } else { reader(&name) };
    Ok(reader.read(&bytes)?.robot)
}

fn reader(name: &str) -> Reader<'_> {
    Reader::new(name).trees().couplings()
}
