//! Plans: which choices the reduced form makes for a robot, what they cost, where they are kept, and the search for
//! better ones.

mod choices;
mod cost;
mod file;
mod graph_text;
mod neighbourhood;
mod plan_set;
mod rewriting;
mod search;
#[cfg(test)]
mod tests;
mod trick;

pub use crate::ir::Cost;
pub use choices::{JointPlan, Moment, Plan, Scale, Side, Slide, Switches, Target};
pub use file::{Accuracy, Fingerprint, PlanFile, Reduced, Rewritten, fingerprint};
pub use plan_set::{Choice, Found, Maker, Wanted, cost, is_planned, savings, search};
pub use search::{Clock, Progress};
pub use trick::Trick;
