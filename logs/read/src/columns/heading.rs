//! Makes the names of the columns when a table is written, such that a log reads the joints back.

use crate::Quantity;
use crate::columns::guess::{Meaning, joint_number, meaning};

/// Names of the columns of joints for writing a table. A [`Log`](crate::Log) reads the joints back by them.
///
/// ```
/// use rne_logs::{Heading, Quantity};
///
/// let joints = ["shoulder".to_owned(), "elbow".to_owned()];
/// let heading = Heading::of(&joints);
/// assert_eq!(heading.columns(Quantity::Position), ["shoulder.position", "elbow.position"]);
/// assert_eq!(Heading::numbered(&joints).columns(Quantity::Effort), ["tau1", "tau2"]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heading<'a> {
    joints: &'a [String],
    form: Form,
}

/// How a column names its joint.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    /// `elbow.position`
    JointFirst,
    /// `position.elbow`
    QuantityFirst,
    /// `q2`
    Number,
}

impl Form {
    fn column(self, number: usize, joint: &str, quantity: Quantity) -> String {
        match self {
            Self::JointFirst => format!("{joint}.{}", quantity.word()),
            Self::QuantityFirst => format!("{}.{joint}", quantity.word()),
            Self::Number => format!("{}{number}", Heading::letters(quantity)),
        }
    }

    /// Whether a log reads this joint back from the names of its columns. Columns of accelerations are never read by
    /// their names.
    fn says(self, joint: &str) -> bool {
        Quantity::ALL.into_iter().all(|quantity| match meaning(&self.column(0, joint, quantity), false) {
            Meaning::Joint(named) => named.quantity == quantity && named.joint == joint && named.unit.is_none(),
            Meaning::Nothing | Meaning::Like => quantity == Quantity::Acceleration,
            Meaning::Unknown { .. } => false,
        })
    }
}

impl<'a> Heading<'a> {
    /// Makes names of columns from the names of the joints. If joints have numbers as names, or names that a log could
    /// not read back, the columns are numbered as with [`Heading::numbered`].
    #[must_use]
    pub fn of(joints: &'a [String]) -> Self {
        // these characters end a cell of CSV
        let is_cell = |joint: &String| !joint.contains([',', ';', '\t', '\n', '\r', '"']) && joint.trim() == joint;
        let is_name = |joint: &String| joint_number(joint).is_none() && is_cell(joint) && !joint.starts_with('#');
        let forms = [Form::JointFirst, Form::QuantityFirst];
        let form = forms.into_iter().find(|form| joints.iter().all(|joint| is_name(joint) && form.says(joint)));
        Self { joints, form: form.unwrap_or(Form::Number) }
    }

    /// Makes numbered names of columns in the order of the joints: `q1`, `q2` and so on, likewise `qd1`, `qdd1` and
    /// `tau1`.
    #[must_use]
    pub fn numbered(joints: &'a [String]) -> Self {
        Self { joints, form: Form::Number }
    }

    /// Returns the quantity that the letters before the number of a joint mean: `q`, `qd`, `qdd` or `tau`.
    #[must_use]
    pub fn quantity(letters: &str) -> Option<Quantity> {
        Quantity::ALL.into_iter().find(|quantity| Self::letters(*quantity) == letters)
    }

    /// Returns the letters for a quantity before the number of a joint, such as `qd`.
    #[must_use]
    pub const fn letters(quantity: Quantity) -> &'static str {
        match quantity {
            Quantity::Position => "q",
            Quantity::Velocity => "qd",
            Quantity::Effort => "tau",
            Quantity::Acceleration => "qdd",
        }
    }

    /// Whether the columns have numbers instead of names of joints.
    #[must_use]
    pub fn is_numbered(&self) -> bool {
        self.form == Form::Number
    }

    /// Returns the names of the columns of a quantity, one for each joint.
    #[must_use]
    pub fn columns(&self, quantity: Quantity) -> Vec<String> {
        let joints = self.joints.iter().enumerate();
        joints.map(|(at, joint)| self.form.column(at + 1, joint, quantity)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(joints: &[&str]) -> String {
        let joints: Vec<String> = joints.iter().map(|joint| (*joint).to_owned()).collect();
        let heading = Heading::of(&joints);
        assert_eq!(heading.is_numbered(), heading == Heading::numbered(&joints));
        heading.columns(Quantity::Position).swap_remove(0)
    }

    #[test]
    fn columns_have_names_that_are_read_back() {
        for (joints, wanted) in [
            (&["elbow_joint", "wrist_1_joint"][..], "elbow_joint.position"),
            (&["fer_joint1", "fer_joint2"], "fer_joint1.position"),
            (&["left/elbow", "right/elbow"], "position.left/elbow"),
            (&["Achse ä"], "Achse ä.position"),
            // names that end like a unit of an angle and of a length
            (&["finger_deg", "finger_m"], "finger_deg.position"),
            (&["1", "2"], "q1"),
            (&["elbow", "2"], "q1"),
            (&["elbow, left"], "q1"),
            (&["tcp_joint"], "q1"),
            (&[" elbow"], "q1"),
            (&["#1"], "q1"),
        ] {
            assert_eq!(first(joints), wanted, "{joints:?}");
        }
        assert_eq!(first(&["x".repeat(300).as_str()]), "q1");
    }
}
