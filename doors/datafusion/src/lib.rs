//! Dynamics of robot arms as functions of DataFusion: in SQL and on DataFrames, over columns or lists.
//!
//! ```
//! use datafusion::prelude::SessionContext;
//! use rne_datafusion::{Robots, register};
//!
//! # #[tokio::main(flavor = "current_thread")]
//! # async fn main() -> datafusion::error::Result<()> {
//! let robots = Robots::shipped()?;
//! let context = SessionContext::new();
//! register(&context, &robots);
//!
//! let robot = robots.key("planar2").expect("it is shipped");
//! let torques = context.sql(&format!("SELECT gravity_torques('{robot}', [0.0, 0.0]) AS tau")).await?;
//! assert_eq!(torques.collect().await?[0].num_rows(), 1);
//! # Ok(())
//! # }
//! ```
//!
//! Each argument is a list per state, or a column per joint: columns are read as they are. A null in an argument makes
//! the result of that state null; the aggregates `identification` and `identify` leave such a state out. Units, signs
//! and frames are those of [`rne`](https://docs.rs/rne).

mod aggregate;
mod argument;
mod call;
mod found;
mod function;
mod identification;
mod log_identification;
mod momentum_residual;
mod numbers;
mod result;
mod robots;
mod rows;
mod time;

use datafusion::logical_expr::{AggregateUDF, ScalarUDF, WindowUDF};
use datafusion::prelude::SessionContext;

use crate::aggregate::Aggregate;
use crate::function::{Computation, DynamicsFunction};
use crate::momentum_residual::MomentumResidual;
pub use crate::robots::Robots;

/// Returns all scalar functions; their calls may name these robots.
#[must_use]
pub fn functions(robots: &Robots) -> Vec<ScalarUDF> {
    let function = |computation| ScalarUDF::new_from_impl(DynamicsFunction::new(computation, robots.clone()));
    Computation::all().map(function).collect()
}

/// Registers all functions in a session; their calls may name these robots.
pub fn register(context: &SessionContext, robots: &Robots) {
    for function in functions(robots) {
        context.register_udf(function);
    }
    for function in aggregates(robots) {
        context.register_udaf(function);
    }
    for function in windows(robots) {
        context.register_udwf(function);
    }
}

/// Returns all aggregates; their calls may name these robots.
#[must_use]
pub fn aggregates(robots: &Robots) -> Vec<AggregateUDF> {
    Aggregate::all(robots).map(AggregateUDF::new_from_impl).into()
}

/// Returns all window functions; their calls may name these robots.
#[must_use]
pub fn windows(robots: &Robots) -> Vec<WindowUDF> {
    vec![WindowUDF::new_from_impl(MomentumResidual::new(robots.clone()))]
}
