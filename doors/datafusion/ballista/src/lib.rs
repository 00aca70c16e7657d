//! Scheduler, executor and client of Ballista that know the dynamics of robot arms, and the same queries on one
//! machine.

mod executor;
mod scheduler;
mod session;

/// How tasks reach executors: executors ask for them (pull), or the scheduler sends them (push). With push, Ballista
/// 55.0 loses slots of executors when another executor dies after a shuffle: `docs/control/fleet.md`.
pub use ballista_core::config::TaskSchedulingPolicy;

pub use crate::executor::executor;
pub use crate::scheduler::scheduler;
pub use crate::session::Session;
