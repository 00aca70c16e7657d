//! Plans: which choices the reduced form makes for a robot, what they cost, and the short search of a build that finds
//! no plan file. The crate `rne-search` has the long search and the plan files.

mod branches;
mod cost;
mod descent;
mod graph_text;
mod plan_set;
mod rewriting;
mod rewritten;
#[cfg(test)]
mod tests;
mod trick;

pub use crate::formulation::Formulation;
pub use crate::ir::Cost;
pub use crate::proof::divides_by_zero;
pub use crate::reduced::choices::{JointPlan, Moment, OriginShift, Plan, RegroupingTarget, Scale, Side, Switches};
pub use crate::rounding::Reference;
pub use cost::{OpenChoices, OpenJoint};
pub use descent::Descent;
pub use plan_set::PlanSet;
pub use rewriting::Rewriting;
pub use rewritten::{Accuracy, Rewritten};
pub use trick::Trick;
