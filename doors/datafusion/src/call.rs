//! The data that every SQL function has: its robots, the types of its arguments, its documentation.

use std::hash::{Hash, Hasher};

use datafusion::common::{Result, ScalarValue, plan_err};
use datafusion::logical_expr::{DocSection, Documentation, Signature, Volatility};

use crate::robots::Robots;

/// The data that every SQL function has.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(crate) struct Call {
    /// The robots that the first argument of a call may name.
    pub(crate) robots: Robots,
    /// Accepts arguments of any types, because their types depend on the robot.
    pub(crate) signature: Signature,
    documentation: About,
}

impl Call {
    /// A function with an example of its call, `syntax`, for the documentation.
    pub(crate) fn new(robots: Robots, syntax: &str, summary: &str) -> Self {
        let section = DocSection { include: true, label: "Robot dynamics", description: None };
        let documentation = Documentation::builder(section, summary, syntax).build();
        Self { robots, signature: Signature::user_defined(Volatility::Immutable), documentation: About(documentation) }
    }

    pub(crate) fn documentation(&self) -> &Documentation {
        &self.documentation.0
    }
}

/// The documentation that the engine shows for a function. All are equal, so that they do not affect whether two
/// functions are equal.
#[derive(Debug)]
struct About(Documentation);

impl PartialEq for About {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Eq for About {}

impl Hash for About {
    fn hash<H: Hasher>(&self, _: &mut H) {}
}

/// Returns the key of the robot, which is the first argument of a call.
pub(crate) fn key<'a>(function: &str, robot: Option<&'a ScalarValue>) -> Result<&'a str> {
    let Some(key) = robot.and_then(|robot| robot.try_as_str().flatten()) else {
        return plan_err!("{function}: the first argument is the robot, a literal such as 'puma560@0123456789abcdef'");
    };
    Ok(key)
}
