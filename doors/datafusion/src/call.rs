//! What every function of the engine has: its robots, the types of its arguments, its documentation.

use std::hash::{Hash, Hasher};

use datafusion::common::{Result, ScalarValue, plan_err};
use datafusion::logical_expr::{DocSection, Documentation, Signature, Volatility};

use crate::robots::Robots;

/// What every function of the engine has.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(crate) struct Call {
    /// The robots that it may be asked for.
    pub(crate) robots: Robots,
    /// Its arguments have types that depend on the robot.
    pub(crate) signature: Signature,
    documentation: About,
}

impl Call {
    /// A function that is called by a syntax.
    pub(crate) fn new(robots: Robots, syntax: &str, summary: &str) -> Self {
        let section = DocSection { include: true, label: "Robot dynamics", description: None };
        let documentation = Documentation::builder(section, summary, syntax).build();
        Self { robots, signature: Signature::user_defined(Volatility::Immutable), documentation: About(documentation) }
    }

    pub(crate) fn documentation(&self) -> &Documentation {
        &self.documentation.0
    }
}

/// What the engine tells of a function; not part of what it is.
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

/// The key of a robot out of the first argument.
pub(crate) fn key<'a>(function: &str, robot: Option<&'a ScalarValue>) -> Result<&'a str> {
    let Some(key) = robot.and_then(|robot| robot.try_as_str().flatten()) else {
        return plan_err!("{function}: the first argument is the robot, a literal such as 'puma560@0123456789abcdef'");
    };
    Ok(key)
}
