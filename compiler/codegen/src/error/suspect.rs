//! The probable cause when a form is refused.

use std::fmt;

use rne_model::Robot;

/// The probable cause of the refusal of a form.
#[derive(Clone, Debug, PartialEq, Default)]
#[non_exhaustive]
pub struct Suspect {
    /// Whether the plan of a plan file was used.
    pub planned: bool,
    /// A number of the robot whose products leave the range of double precision.
    pub number: Option<Extreme>,
}

/// A number of a robot that is very large or very small.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    what: &'static str,
    link: usize,
    value: f64,
}

impl Extreme {
    /// Returns the number of the robot that is farthest from 1 (very large or very small), if its powers can leave the
    /// range of double precision, or exceed the 106 bits in which constants are computed.
    #[must_use]
    pub fn of(robot: &Robot) -> Option<Self> {
        const LARGEST: f64 = 1e75;
        let far = |value: f64| value.abs().log2().abs();
        let mut numbers = Vec::new();
        for (index, joint) in robot.joints.iter().enumerate() {
            let mut put = |what, values: &[f64]| {
                numbers.extend(values.iter().map(|&value| Self { what, link: index + 1, value }));
            };
            put("the length d", &[joint.row.dh.d]);
            put("the length a", &[joint.row.dh.a]);
            put("the angle theta", &[joint.row.dh.theta.radians]);
            put("the angle alpha", &[joint.row.dh.alpha.radians]);
            put("the mass", &[joint.row.link.mass]);
            put("a coordinate of the centre of mass,", &joint.row.link.com);
            put("a coordinate of the first moment,", &joint.row.link.first_moment);
            put("an inertia,", joint.written_inertia.0.rows().as_flattened());
        }
        numbers.retain(|number| number.value != 0.0 && far(number.value) > LARGEST.log2());
        numbers.into_iter().max_by(|a, b| far(a.value).total_cmp(&far(b.value)))
    }
}

impl fmt::Display for Extreme {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, link, value } = self;
        let (size, beyond) = if value.abs() > 1.0 { ("large", "overflow") } else { ("small", "vanish") };
        write!(
            f,
            "{what} {value:e} of link {link} is too {size} for this form: products of such numbers {beyond} in double \
             precision. Use other units, or `form = \"seven_steps\"`, which needs fewer products"
        )
    }
}

impl Suspect {
    /// Writes advice: about the number if one is suspected, else the text for a plan file or the text for a plan of the
    /// build.
    pub(super) fn advise(&self, f: &mut fmt::Formatter<'_>, of_plan_file: &str, of_build: &str) -> fmt::Result {
        match &self.number {
            Some(number) => write!(f, "{number}"),
            None => f.write_str(if self.planned { of_plan_file } else { of_build }),
        }
    }
}
