//! Model-predictive control of a robot arm with dynamics that are made when it is compiled.

pub mod controller;
pub mod experiment;
pub mod model;
pub mod picture;
pub mod plant;
pub mod program;
