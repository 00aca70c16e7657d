//! The parameters of a file that stay letters.

use rne_model::{Reader, Report, Robot};

/// Largest number of parameters that become letters, the last ones of the file: the file is read once more for each.
const MOST_PARAMETERS: usize = 64;

/// Reads a robot file; every parameter that may vary does. The robot is that of the values in the file.
///
/// A parameter that an angle depends on, or a root, is a number; so is one that is 0. Of two parameters one of which is
/// defined by the other the one that the table names is a letter: the last one of the file. Of more than 64 parameters
/// the first ones are numbers. Where the rows of a tree begin is in numbers, too.
///
/// # Errors
///
/// Everything that is wrong with the file.
pub fn read(name: &str, file: &[u8]) -> Result<Robot, Report> {
    let plain = Reader::new(name).trees().read(file)?.robot;
    let mut robot = plain.clone();
    let mut free: Vec<&str> = Vec::new();
    for (parameter, _) in plain.parameters.iter().rev().take(MOST_PARAMETERS) {
        // in the order of the file
        let names: Vec<&str> = std::iter::once(parameter.as_str()).chain(free.iter().copied()).collect();
        if let Ok(checked) = Reader::new(name).trees().run_time(&names).read(file) {
            robot = checked.robot;
            free = names;
        }
    }
    Ok(robot)
}
