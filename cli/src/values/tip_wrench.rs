//! Reads wrenches at tips from the command line.

use std::str::FromStr;

use rne::Wrench;
use rne_codegen::{Argument, Function};
use rne_model::{Robot, nearest_name};

use crate::outcome::Failure;
use crate::values::numbers::List;
use crate::values::state::{not_taken, triple};

/// A tip and the wrench that acts on it: `left=0,0,-5,0,0,0`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TipWrench {
    tip: String,
    numbers: List,
}

impl FromStr for TipWrench {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (tip, numbers) = text.split_once('=').ok_or("write NAME=fx,fy,fz,nx,ny,nz, such as left=0,0,-5,0,0,0")?;
        let numbers: List = numbers.parse()?;
        match numbers.0.len() {
            6 => Ok(Self { tip: tip.trim().to_owned(), numbers }),
            found => Err(format!("a wrench has 6 numbers, not {found}: fx,fy,fz,nx,ny,nz")),
        }
    }
}

/// Returns the wrench at each tip of a robot for a function that takes them: that of the command line, or zero.
pub(super) fn tip_wrenches(
    function: Function,
    given: &[TipWrench],
    robot: &Robot,
) -> Result<Vec<Wrench<f64>>, Failure> {
    let names = robot.tip_names();
    if !function.takes(Argument::Wrenches) {
        let refused = given.first().map(|_| not_taken(function, "--tip-wrench", Argument::Wrenches));
        return refused.map_or(Ok(Vec::new()), Err);
    }
    let mut wrenches = vec![Wrench::zero(); names.len()];
    if given.is_empty() && !function.is_of_floating_base() {
        return Err(usage_error!(
            "{function} needs --tip-wrench NAME=fx,fy,fz,nx,ny,nz for at least one tip of {}: `{}`",
            robot.name,
            names.join("`, `")
        ));
    }
    for (index, TipWrench { tip, numbers: List(numbers) }) in given.iter().enumerate() {
        if let Some(two) = robot.two_tips(tip) {
            return Err(Failure::usage(two));
        }
        let Some(place) = names.iter().position(|name| name == tip) else {
            if robot.frames.iter().any(|frame| frame.name == *tip) {
                let listed = if robot.tips.is_empty() { tip.clone() } else { format!("{}, {tip}", names.join(", ")) };
                return Err(usage_error!(
                    "`{tip}` is a frame of {}, but not a tip; list it under `tips` of the robot file: tips: [{listed}]",
                    robot.name
                ));
            }
            let meant = nearest_name(tip, &names).map(|meant| format!("; did you mean `{meant}`?"));
            return Err(usage_error!(
                "{} has no tip `{tip}`; its tips are `{}`{}",
                robot.name,
                names.join("`, `"),
                meant.unwrap_or_default()
            ));
        };
        if given[..index].iter().any(|other| other.tip == *tip) {
            return Err(usage_error!("--tip-wrench gives the wrench at `{tip}` twice"));
        }
        wrenches[place] = Wrench { force: triple(numbers, 0), moment: triple(numbers, 3) };
    }
    Ok(wrenches)
}
