//! Plan files beside robot files.

use std::fs::File;
use std::io::{ErrorKind, Read as _};
use std::path::{Path, PathBuf};

use rne_codegen::reduced::{Choice, PlanFile};
use rne_model::Robot;

use crate::outcome::Failure;

/// Far more than the largest plan.
const LONGEST: u64 = 16 << 20;

/// `NAME.plan.yaml` beside `NAME.yaml`.
pub(crate) fn path(robot_file: &Path) -> PathBuf {
    robot_file.with_extension("plan.yaml")
}

/// The plan file of a robot file, if there is one.
pub(crate) fn read(robot_file: &Path, robot: &Robot) -> Result<Option<PlanFile>, Failure> {
    if robot_file == Path::new("-") {
        return Ok(None);
    }
    let path = path(robot_file);
    let shown = path.display();
    let mut text = String::new();
    match File::open(&path).and_then(|file| file.take(LONGEST).read_to_string(&mut text)) {
        Ok(_) => PlanFile::read(&shown.to_string(), &text, robot).map(Some).map_err(|report| Failure::from(&report)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(Failure::input(format_args!("{shown} cannot be read: {error}"))),
    }
}

/// The choices for a robot: those of its plan file, or those that a build makes by itself.
pub(crate) fn choice(robot_file: &Path, robot: &Robot) -> Result<Choice, Failure> {
    Ok(read(robot_file, robot)?.map_or_else(|| Choice::default_of(robot), Choice::from))
}
