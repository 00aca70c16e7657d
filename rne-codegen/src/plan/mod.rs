//! Plans: which choices the reduced form makes for a robot, what they cost, where they are kept, and the search for
//! better ones.

mod cost;
mod exploration;
mod file;
mod graph_text;
mod neighbourhood;
mod plan_set;
mod rewriting;
mod schema;
mod search;
mod shapes;
#[cfg(test)]
mod tests;
mod trick;
mod yaml;

pub use crate::ir::Cost;
pub use crate::reduced::choices::{JointPlan, Moment, OriginShift, Plan, RegroupingTarget, Scale, Side, Switches};
pub use exploration::{Clock, Progress};
pub use file::{Accuracy, Fingerprint, PlanFile, Reduced, Rewritten, fingerprint};
pub(crate) use plan_set::formulation;
pub use plan_set::{PlanSet, cost, is_planned, savings};
pub use search::{SearchOptions, search};
pub use trick::Trick;
