//! The functions of a robot as data, below everything else of rne: their names, arguments, results, units and
//! sentences. There is no formula here, and nothing of a robot but the numbers of its joints, tips and loops.

#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

mod answer;
mod argument;
mod axes;
mod capability;
mod entry;
mod example;
mod fixed_base;
mod floating_base;
mod function;
mod layout;
mod named;
mod record;
mod table;
mod what;

pub use answer::{Answer, AnswerTable, Labels, MatrixUnit};
pub use argument::{Argument, ArgumentPart, Owner};
pub use axes::{Axes, Base, Load};
pub use capability::Capability;
pub use entry::Entry;
#[cfg(feature = "alloc")]
pub use layout::Layout;
pub use layout::{Length, Shape, Sizes};
pub use record::Record;
pub use table::Function;
pub use what::{Recursion, What};
