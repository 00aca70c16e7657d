//! Scheduler, executor and client of Ballista that know the dynamics of robot arms, and the same queries on one
//! machine.

mod executor;
mod scheduler;
mod session;

pub use crate::executor::executor;
pub use crate::scheduler::scheduler;
pub use crate::session::Session;
