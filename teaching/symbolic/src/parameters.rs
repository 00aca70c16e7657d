//! Reads a robot file whose parameters stay letters.

use rne_model::{Reader, Report, Robot};

/// Largest number of parameters that become letters, the last ones of the file. The file is read once for each.
const MOST_PARAMETERS: usize = 64;

/// Reads a robot file, and makes every possible parameter a run-time parameter. The robot has the values of the file.
///
/// A parameter is replaced by its value if an angle or a root depends on it, or if it is 0. If one parameter is defined
/// by another, the last one of the file, which the table uses, is a letter. If there are more than 64 parameters, the
/// first ones are replaced by their values. Placements where the rows of a tree begin are numbers, too.
///
/// # Errors
///
/// Everything that is wrong with the file.
pub fn read(name: &str, file: &[u8]) -> Result<Robot, Report> {
    let plain = Reader::new(name).trees().read(file)?.robot;
    let mut robot = plain.clone();
    let mut free: Vec<&str> = Vec::new();
    for (parameter, _) in plain.parameters.iter().rev().take(MOST_PARAMETERS) {
        // keeps the order of the file
        let names: Vec<&str> = std::iter::once(parameter.as_str()).chain(free.iter().copied()).collect();
        if let Ok(checked) = Reader::new(name).trees().run_time(&names).read(file) {
            robot = checked.robot;
            free = names;
        }
    }
    Ok(robot)
}
