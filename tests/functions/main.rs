//! Every function of a robot beyond its torques: against independent values, against each other, and against physics.

mod case;
mod check;
mod conventions;
mod energy;
mod golden;
mod kinematics;
mod matrices;
mod peers;
mod published;
#[path = "../random/robots.rs"]
mod robots;
mod wrenches;
