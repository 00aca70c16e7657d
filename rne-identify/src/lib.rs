//! Inertial parameters and friction of a robot arm from its logs.
#![forbid(unsafe_code)]
