//! Every function of a robot, by the runtime and by generated code of both forms: against independent values, against each
//! other, and against physics.

mod arm;
mod case;
mod check;
mod conventions;
mod energy;
mod equality;
mod golden;
mod kinematics;
mod matrices;
mod operations;
mod peers;
mod published;
#[path = "../random/robots.rs"]
mod robots;
mod single_precision;
mod wrenches;
