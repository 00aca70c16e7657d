//! The letters of a closed form.

use std::collections::HashSet;

use crate::notation::latex_name;

/// An angle whose sine and cosine are letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Angle {
    /// θ of the table of a revolute joint, from 0: the joint variable with the constant part of the row.
    Joint(usize),
    /// α of a row, where it is no right angle.
    Twist(usize),
    /// θ of a prismatic joint, which is constant, where it is no right angle.
    Turn(usize),
}

/// A letter. In this order the factors of a product are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Symbol {
    /// A number that the file gives: an index into [`Constants`].
    Constant(usize),
    /// d of the table of a prismatic joint, from 0: the joint variable with the constant part of the row.
    Position(usize),
    /// The sine of an angle.
    Sine(Angle),
    /// Its cosine.
    Cosine(Angle),
    /// q̇ of a joint, from 0.
    Rate(usize),
    /// q̈ of a joint, from 0.
    Acceleration(usize),
}

/// The kind of a constant, which decides how a sum is collected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    /// A mass.
    Mass,
    /// The acceleration of gravity.
    Gravity,
    /// A length, an inertia, or a parameter of the file that is neither mass nor gravity.
    Other,
}

/// A number that the file gives and that stays a letter.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Constant {
    /// As it is written, in ASCII: `m1`, `a2`, `x_C2`, `I2_xx`.
    pub(crate) name: String,
    pub(crate) kind: Kind,
    /// The value in the file, SI.
    pub(crate) value: f64,
    /// `kg`, `m`; nothing for a parameter, whose unit no file says.
    pub(crate) unit: &'static str,
    /// Whether it is one of the `parameters` of the file.
    pub(crate) is_parameter: bool,
    /// Other elements of the table that are the same number.
    pub(crate) also: Vec<String>,
}

/// The constants of an arm, in the order in which factors are written: masses, gravity, the rest.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Constants(pub(crate) Vec<Constant>);

impl Constants {
    pub(crate) fn add(&mut self, constant: Constant) -> Symbol {
        self.0.push(constant);
        Symbol::Constant(self.0.len() - 1)
    }

    /// Gives every constant a letter that nothing else in the equations has, neither on a terminal nor in print, where
    /// `m_1` looks like `m1` and `theta1` like θ1: a table's `m1` is `m1'` beside a parameter of that name, which keeps
    /// it wherever it first occurs, and a parameter `d2` is `d2'` where the second joint slides. `structure` are the
    /// names that the equations have for variables, matrices and torques.
    pub(crate) fn distinguish(&mut self, structure: impl IntoIterator<Item = String>) {
        let looks = |name: &str| latex_name(name).replace("\\mathit", "").replace(['{', '}'], "");
        let mut taken: HashSet<String> = structure.into_iter().map(|name| looks(&name)).collect();
        let mut own = |name: &mut String| {
            while !taken.insert(looks(name)) {
                name.push('\'');
            }
        };
        for is_parameter in [true, false] {
            for constant in self.0.iter_mut().filter(|constant| constant.is_parameter == is_parameter) {
                own(&mut constant.name);
                constant.also.iter_mut().for_each(&mut own);
            }
        }
    }
}
