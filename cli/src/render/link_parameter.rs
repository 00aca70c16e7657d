//! Explains the name of a parameter of a link or of a rotor, such as `Jzz3`.

use rne_model::INERTIAL_PARAMETERS;

use crate::render::layout::{PAGE, wrap};
use crate::terminal;

/// The name of the inertia of a rotor.
const ROTOR: &str = "Jm";

/// The name of a parameter with the number of its link or joint, from 1.
pub(crate) struct LinkParameter {
    letters: &'static str,
    number: u32,
}

impl LinkParameter {
    /// Reads a name; `None` if it is not that of a parameter.
    pub(crate) fn parse(name: &str) -> Option<Self> {
        let letters = name.trim_end_matches(|c: char| c.is_ascii_digit());
        let number = name[letters.len()..].parse().ok().filter(|number| *number > 0)?;
        let letters = INERTIAL_PARAMETERS.into_iter().chain([ROTOR]).find(|known| *known == letters)?;
        Some(Self { letters, number })
    }

    /// Explains the meaning of the name, and why rne prints such names.
    pub(crate) fn explained(&self) -> String {
        let Self { letters, number } = *self;
        let end: String = letters.chars().skip(1).collect::<String>();
        let what = match letters {
            "m" => format!("{letters}{number} is the mass of link {number}, in kg."),
            ROTOR => format!(
                "{letters}{number} is the inertia of the rotor of joint {number}, at the joint: the inertia of the \
                 rotor times the square of the gear ratio. The unit is kg m\u{b2}, of a prismatic joint kg."
            ),
            _ if letters.starts_with('m') => {
                let axis = end.trim_start_matches('c');
                format!(
                    "{letters}{number} is a moment of mass of link {number}, in kg m: the mass times the coordinate \
                     {axis} of the centre of mass in frame {number}."
                )
            }
            _ => format!(
                "{letters}{number} is the element {end} of the inertia of link {number}, in kg m\u{b2}: about the \
                 origin of frame {number}, in the axes of frame {number}."
            ),
        };
        let base = "The torques of an arm do not determine every parameter of every link. They determine base \
                    parameters, which are sums of parameters. rne names a base parameter by one parameter of its sum. \
                    The value of a base parameter in a table of `rne identify --all` is the value of the whole sum.";
        let others = "The letters are m (mass), mcx, mcy, mcz (mass times centre of mass), Jxx, Jxy, Jxz, Jyy, Jyz, \
                      Jzz (inertia) and Jm (rotor). The number is that of the link, from 1 at the base to the tip.";
        let paragraphs = [what.as_str(), base, others];
        paragraphs.map(|text| wrap(text, terminal::width(PAGE), "") + "\n").join("\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_parameters_are_known() {
        for (name, wanted) in [
            ("Jzz3", "element zz of the inertia of link 3"),
            ("m12", "mass of link 12, in kg"),
            ("mcy2", "coordinate y of the centre of mass in frame 2"),
            ("Jm1", "rotor of joint 1"),
        ] {
            let said = LinkParameter::parse(name).map(|parameter| parameter.explained().replace('\n', " "));
            assert!(said.as_ref().is_some_and(|said| said.contains(wanted)), "{name}: {said:?}");
        }
        for name in ["Jzz", "Jzz0", "3", "w2_z", "Jzx1", "mc2", ""] {
            assert!(LinkParameter::parse(name).is_none(), "{name}");
        }
    }
}
