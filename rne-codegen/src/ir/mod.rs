//! The one representation in which formulas are written, and what can be done with any of them.

mod builder;
mod causes;
mod differentiation;
mod double;
mod graph;
mod input;
pub(crate) mod ledger;
mod live;
pub(crate) mod name;
mod number;
mod numbers;
pub(crate) mod quantity;
mod residue;
mod sample_point;
mod symbol;
mod trace;
mod value_numbering;

pub(crate) use builder::{Builder, JointLines};
pub(crate) use causes::CausesId;
pub use graph::Cost;
pub(crate) use graph::{Graph, Node, Op, Outcome, Policy, Ref, Side};
pub(crate) use input::Input;
pub(crate) use live::{mark_live, mark_live_outside_angles};
pub(crate) use number::{Number, Reading, Turn};
pub(crate) use numbers::{Numbers, Source};
pub(crate) use residue::Image;
pub(crate) use sample_point::Point;
pub(crate) use symbol::{Matrix, Symbol, Vector};
pub(crate) use trace::{Birth, Definition, Trace, Traced};
pub(crate) use value_numbering::number_values;
