//! The reduced form: the same torques with far fewer operations.
//!
//! Regrouped parameters, one matrix U for all accelerations of a link, turns in two steps, gravity in the acceleration of
//! the base, and choices per joint that a search makes. Only the torques keep a physical meaning.
//!
//! From the robot file to code: `rows` and `regroup` prepare the numbers, `outward` and `inward` write the recursion
//! on a `sheet`, `transcript` turns the sheet into a program, which the gate of `proof.rs` lets pass or not.

mod articulated;
mod choice;
mod composite;
mod differentiation;
mod evaluator;
mod graph_text;
mod inward;
mod merged;
mod moves;
mod numbers;
mod outward;
mod plan;
mod plan_file;
mod point;
mod pseudo_inertia;
mod regroup;
mod rewrite;
mod rows;
mod search;
mod sensitivity;
mod sheet;
#[cfg(test)]
mod tests;
mod transcript;
mod trick;
mod way;
mod writer;

pub use choice::{Choice, Found, Wanted, cost, is_planned, savings, search};
pub use plan::{JointPlan, Moment, Plan, Scale, Side, Slide, Switches, Target};
pub use plan_file::{Accuracy, Fingerprint, PlanFile, Reduced, Rewritten, fingerprint};
pub(crate) use point::Point;
pub use search::{Clock, Progress};
pub use sheet::Cost;
pub use trick::Trick;
