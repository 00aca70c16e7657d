//! The reduced form: the same torques with far fewer operations.
//!
//! Regrouped parameters, one matrix U for all accelerations of a link, turns in two steps, gravity in the acceleration of
//! the base, and choices per joint that a search makes. Only the torques keep a physical meaning.
//!
//! From the robot file to code: `rows` and `regroup` prepare the numbers, `outward` and `inward` write the recursion
//! on a `sheet`, `transcript` turns the sheet into a program, which the gate of `proof.rs` lets pass or not.

mod arguments;
mod articulated;
mod choice;
mod composite;
mod evaluator;
mod graph_text;
mod inward;
mod moves;
mod outward;
mod plan;
mod plan_file;
mod pseudo_inertia;
mod regroup;
mod rewrite;
mod rows;
mod search;
mod sensitivity;
#[cfg(test)]
mod tests;
mod trick;
mod way;

pub use crate::ir::Cost;
pub use choice::{Choice, Found, Maker, Wanted, cost, is_planned, savings, search};
pub use plan::{JointPlan, Moment, Plan, Scale, Side, Slide, Switches, Target};
pub use plan_file::{PlanFile, Remark, Rewritten, fingerprint};
pub use search::{Clock, Progress};
pub use trick::Trick;
