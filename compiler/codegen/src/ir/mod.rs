//! The representation of all formulas as a graph, and the operations on it, such as folding, differentiation and value
//! numbering.

mod adjoint;
mod arithmetic;
mod array_names;
mod builder;
mod causes;
mod constants;
mod cost;
pub(crate) mod derivation;
mod differentiation;
mod fold_report;
mod graph;
mod input;
mod live;
mod name;
mod node;
mod number;
mod numbers;
mod operators;
mod residue;
mod sample_point;
mod symbol;
mod trace;
mod value_numbering;
mod written;

pub(crate) use array_names::{all_names_of, names_of};
pub(crate) use builder::{Builder, JointLines, Moving};
pub(crate) use causes::CausesId;
pub use cost::Cost;
pub(crate) use derivation::Exactly;
pub use derivation::{Derivation, ExactConstant, ExactStep};
pub(crate) use fold_report::Alternatives;
pub use fold_report::{Cause, Causes, Fold, FoldReport, Line, Operation, Place};
pub(crate) use graph::{Graph, Outcome, Policy, Side};
pub(crate) use input::Input;
pub(crate) use live::{mark_live, mark_live_outside_angles};
pub use name::{Name, WithRespectTo};
pub(crate) use node::{Node, Op, Ref};
pub(crate) use number::{Embedding, ExactAngle, Number, square};
pub(crate) use numbers::{Numbers, Source};
pub(crate) use operators::operators;
pub use residue::Residue;
pub(crate) use sample_point::{SamplePoint, composed};
pub(crate) use symbol::{Matrix, Symbol, Vector, by_quarters};
pub(crate) use trace::{Birth, Definition, Trace, Traced};
pub(crate) use value_numbering::number_values;
pub use written::{Operator, Sign};
pub(crate) use written::{TermId, Written, WrittenTerms};

pub(crate) use crate::quantity::Indices;
pub use crate::quantity::{Axis, Component, Quantity, Step};
