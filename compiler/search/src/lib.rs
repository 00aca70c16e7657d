//! The search for fewer operations of the reduced form, and the plan files that keep what it finds.
//!
//! A build without a plan file takes the choices of a short search that the compiler makes by itself
//! ([`rne_codegen::plan::Descent`]). [`search()`] goes on from there for as long as its caller's clock says: it anneals
//! the choices, then the graphs that the best of them give, and returns a [`PlanFile`]. A compiler takes it as its
//! choices and proves what it gives:
//!
//! ```
//! use rne_codegen::{Compiler, Form, Function};
//! use rne_search::{PlanFile, SearchOptions, search};
//! # let yaml = "{format: 1, name: one, source: doc, convention: standard, gravity: [0, -9.81, 0], joints: [
//! #     {type: revolute, dh: {theta: 0, d: 0, a: 1, alpha: 0}, link: {mass: 1, com: [-0.5, 0, 0]}}]}";
//! # let robot = rne_model::Robot::from_yaml(yaml).unwrap();
//! // a clock that counts: 100 looks at the progress are all of the time
//! let mut looks = 0.0;
//! let mut clock = |_: &rne_search::Progress| {
//!     looks += 0.01;
//!     (looks < 1.0).then_some(looks)
//! };
//! let text = search(&robot, None, &SearchOptions::default(), &mut clock)?.to_yaml();
//! let plan = PlanFile::read("one.plan.yaml", &text, &robot).unwrap();
//! let program = Compiler::new(&robot).with_plans(plan).compile(Function::InverseDynamics, Form::Reduced)?;
//! assert!(program.proof.is_some());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! This crate neither opens files, nor asks a clock, nor prints.
#![warn(missing_debug_implementations)]
#![forbid(unsafe_code)]

mod error;
mod neighbourhood;
mod plan_file;
mod plan_search;
mod savings;
mod search;

pub use error::SearchError;
pub use neighbourhood::Neighbourhood;
pub use plan_file::{Fingerprint, PlanFile, Reduced, fingerprint};
pub use plan_search::{Clock, Progress};
pub use savings::{savings, without};
pub use search::{SearchOptions, search};
