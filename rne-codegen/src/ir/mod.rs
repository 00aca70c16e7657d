//! The one representation in which formulas are written, and what can be done with any of them.

mod arithmetic;
mod builder;
mod causes;
mod constants;
mod cost;
mod differentiation;
pub(crate) mod fold_report;
mod graph;
mod input;
mod live;
pub(crate) mod name;
mod node;
mod number;
mod numbers;
mod operators;
pub(crate) mod quantity;
mod residue;
mod sample_point;
mod symbol;
mod trace;
mod value_numbering;

pub(crate) use builder::{Builder, JointLines};
pub(crate) use causes::CausesId;
pub use cost::Cost;
pub(crate) use graph::{Graph, Outcome, Policy, Side};
pub(crate) use input::Input;
pub(crate) use live::{mark_live, mark_live_outside_angles};
pub(crate) use node::{Node, Op, Ref};
pub(crate) use number::{Embedding, ExactAngle, Number, square};
pub(crate) use numbers::{Numbers, Source};
pub(crate) use operators::operators;
pub(crate) use residue::Residue;
pub(crate) use sample_point::SamplePoint;
pub(crate) use symbol::{Matrix, Symbol, Vector, by_quarters};
pub(crate) use trace::{Birth, Definition, Trace, Traced};
pub(crate) use value_numbering::number_values;
