//! The letters of a closed form.

use std::collections::HashSet;

use crate::notation::latex_name;

/// An angle whose sine and cosine are letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Angle {
    /// θ of a revolute joint, counted from 0: the joint variable plus the constant part of the row.
    Joint(usize),
    /// α of a row that is no multiple of a right angle.
    Twist(usize),
    /// The constant θ of a prismatic joint that is no multiple of a right angle.
    Turn(usize),
}

/// A letter of the equations. The factors of a product are written in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Symbol {
    /// A number of the file, as an index into [`Constants`].
    Constant(usize),
    /// d of a prismatic joint, counted from 0: the joint variable plus the constant part of the row.
    Position(usize),
    /// The sine of an angle.
    Sine(Angle),
    /// The cosine of an angle.
    Cosine(Angle),
    /// The rate q̇ of a joint, counted from 0.
    Rate(usize),
    /// The acceleration q̈ of a joint, counted from 0.
    Acceleration(usize),
}

/// The kind of a constant, which determines how sums are collected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    /// A mass.
    Mass,
    /// The acceleration of gravity.
    Gravity,
    /// A length, an inertia, or a parameter of the file that is neither mass nor gravity.
    Other,
}

/// A number of the file that stays a letter.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Constant {
    /// The name in ASCII, such as `m1`, `a2`, `x_C2` or `I2_xx`.
    pub(crate) name: String,
    pub(crate) kind: Kind,
    /// The value in the file, in SI units.
    pub(crate) value: f64,
    /// The unit, such as `kg` or `m`; empty for a parameter, whose unit is not in the file.
    pub(crate) unit: &'static str,
    /// Whether the constant is one of the `parameters` of the file.
    pub(crate) is_parameter: bool,
    /// Names of other elements of the table with the same number.
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

    /// Gives every constant a unique name, both on a terminal and in LaTeX, where `m_1` looks like `m1` and `theta1`
    /// like θ1. If a parameter has the name `m1`, the mass `m1` of the table becomes `m1'`, wherever they first occur.
    /// A parameter `d2` becomes `d2'` if the second joint is prismatic. `structure` has the names of variables,
    /// matrices and torques in the equations.
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
