//! Identification, from simulated and from public logs.

mod arm_log;
mod excitation;
mod followers;
mod identifiability;
mod offsets;
mod payload;
mod public_logs;
mod synthetic;
mod trees;
mod unordered;
mod unusual;
