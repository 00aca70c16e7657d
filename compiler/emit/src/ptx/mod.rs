//! Writes programs as PTX, the assembly language of NVIDIA's GPUs: kernels for many states, with one thread per state.
//!
//! The driver of the graphics card compiles the text, so neither a toolkit nor a library is needed. Each operation says
//! how it rounds (`.rn`), so the assembler does not fuse or reorder them: a kernel computes the same bits as the
//! machine of `rne-machine` on a vector unit with fused multiply-add.

mod kernel;
mod order;
mod rollout;
mod writing;

use std::fmt::Write as _;

use rne_codegen::Program;
use rne_model::Robot;

use crate::ascii::ascii;
use crate::c::{Additions, ConstantTooLarge, File, Prefix, comment, header};
use crate::syntax::Precision;
use kernel::Kernel;
pub(crate) use kernel::heading;
pub use rollout::is_for_rollouts;

/// The order of the numbers of many states in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Arrangement {
    /// Element e of state i is at e · states + i: neighbouring threads read neighbouring numbers.
    Columns,
    /// Element e of state i is at i · elements + e.
    Rows,
}

/// The properties that all kernels share, as text for the heading.
const CONTRACT: [&str; 4] = [
    "Every kernel computes one state per thread, in a grid of one dimension; threads beyond the last state write \
     nothing. Launch it with 64 threads per block, kernels with .maxntid with up to 256. Its parameters are the \
     addresses of the arrays in the order below, then the number of states (32 bits), at most 2^31 - 1.",
    "Kernels that end in _columns take and return arrays by elements: element e of state i is at e * states + i. \
     Kernels that end in _rows take and return arrays by states: element e of state i is at i * elements + e.",
    "No array of results may overlap an array of arguments. The address of an array of which no element is used may be \
     0.",
    "Sines and cosines are computed here, with errors below 1 ulp for angles up to 1e5 rad, the sums of those of \
     parallel joints included; beyond that results mean nothing.",
];

/// Writes the programs of one robot as PTX kernels: two for each, one for columns and one for rows. Programs for
/// [`Target::Throughput`](rne_codegen::Target) have the fewest instructions.
///
/// # Errors
/// When a constant is too large for the number type.
pub fn ptx(
    robot: &Robot,
    programs: &[Program],
    precision: Precision,
    prefix: &Prefix,
    additions: &Additions<'_>,
) -> Result<String, ConstantTooLarge> {
    let file = File { robot, programs, precision, prefix: prefix.as_str(), additions };
    let mut text = header::title(&file) + &header::robot(&file) + "//\n";
    for words in CONTRACT {
        text.push_str(&comment("//", words));
        text.push_str("//\n");
    }
    let counts = header::counts(programs);
    text = ascii(&(text + counts.trim_start_matches("//\n")));
    text.push_str("\n.version 7.0\n.target sm_70\n.address_size 64\n");
    for program in programs {
        let kernel = Kernel::of(program, precision)?;
        let _ = write!(text, "\n{}", ascii(&heading(program)));
        for (arrangement, end) in [(Arrangement::Columns, "columns"), (Arrangement::Rows, "rows")] {
            let name = format!("{}_{}_{end}", file.prefix, program.name);
            let _ = write!(text, "\n{}", kernel.text(&name, arrangement));
        }
        if additions.rollout {
            text.push_str(&rollout::text(prefix.as_str(), &kernel));
        }
    }
    Ok(text)
}
