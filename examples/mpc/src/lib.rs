//! Model-predictive control of a robot arm. The code of its dynamics is generated when the program is compiled.

pub mod controller;
pub mod experiment;
pub mod model;
pub mod picture;
pub mod plant;
pub mod program;
