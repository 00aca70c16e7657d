//! Errors of functions on a graphics card.

use std::error::Error;
use std::fmt;
use std::path::PathBuf;

use rne_machine::EvaluationError;

/// Why nothing was computed on the card.
#[derive(Debug)]
#[non_exhaustive]
pub enum GpuError {
    /// The library of the driver cannot be opened.
    NoDriver {
        /// Its name.
        library: PathBuf,
        /// The words of the system.
        reason: String,
    },
    /// The driver is too old: it does not have a call.
    OldDriver {
        /// The name of its library.
        library: PathBuf,
        /// The call.
        call: String,
    },
    /// There is no such card.
    NoDevice {
        /// The number of the card that was asked for; the first is 0.
        ordinal: usize,
        /// How many cards there are.
        count: usize,
    },
    /// The driver could not translate a kernel.
    Translation {
        /// The words of the driver.
        log: String,
    },
    /// A call of the driver failed.
    Call {
        /// The call.
        call: &'static str,
        /// The number of the error.
        number: i32,
        /// The name of the error, as `cuda.h` has it.
        name: String,
        /// The meaning of the error, in the driver's words.
        meaning: String,
    },
    /// The arm does not have the function.
    Function(EvaluationError),
    /// A number of the robot file is too large for the number type.
    Constant(String),
    /// An argument is missing, or has a name that the function does not have.
    Argument {
        /// Its name.
        argument: String,
        /// The arguments of the function.
        known: Vec<&'static str>,
        /// Whether it is missing.
        is_missing: bool,
    },
    /// An array has a wrong number of elements.
    Size {
        /// Its name.
        array: String,
        /// The number of elements that it must have.
        expected: usize,
        /// The number of elements that it has.
        found: usize,
    },
    /// An array is on another card than the arm.
    OtherDevice {
        /// The name of the array.
        array: String,
    },
    /// A batch is too large, or a rollout has no step.
    Range {
        /// The name of the value: states, steps, every.
        what: &'static str,
        /// The value.
        found: u64,
        /// The least and the largest number that are allowed.
        allowed: [u64; 2],
    },
    /// The duration of a step is not a finite number above zero of the number type of the arrays.
    Step(f64),
}

impl fmt::Display for GpuError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDriver { library, reason } => write!(
                f,
                "no NVIDIA driver: {} cannot be opened ({reason}). The functions of an arm on a graphics card need a \
                 card of NVIDIA and its driver; without them, the processor computes the same functions",
                library.display()
            ),
            Self::OldDriver { library, call } => write!(
                f,
                "{} has no call {call}: it is no driver of NVIDIA, or one older than CUDA 11. Install a newer driver",
                library.display()
            ),
            Self::NoDevice { count: 0, .. } => f.write_str(
                "the driver finds no graphics card; CUDA_VISIBLE_DEVICES may hide the cards of this machine",
            ),
            Self::NoDevice { ordinal, count } => {
                write!(f, "there is no graphics card {ordinal}: this machine has {count}, counted from 0")
            }
            Self::Translation { log } => write!(
                f,
                "the driver cannot translate the kernel. Kernels need a card from V100 on (compute capability 7.0). \
                 The driver says: {log}"
            ),
            Self::Call { call, number, name, meaning } => {
                write!(f, "the driver's call {call} failed with error {number}, {name}: {meaning}{}", advice(name))
            }
            Self::Function(error) => error.fmt(f),
            Self::Constant(words) => f.write_str(words),
            Self::Argument { argument, known, is_missing } => {
                let known = known.join(", ");
                if *is_missing {
                    write!(f, "the argument `{argument}` is missing; the function takes {known}")
                } else {
                    write!(f, "the function has no argument `{argument}`; it takes {known}")
                }
            }
            Self::Size { array, expected, found } => {
                write!(f, "`{array}` has {found} numbers, but it must have {expected}")
            }
            Self::OtherDevice { array } => {
                write!(f, "`{array}` is on another graphics card than the arm; copy it to that card")
            }
            Self::Range { what, found, allowed: [least, most] } => {
                write!(f, "`{what}` is {found}, but it must be from {least} to {most}")
            }
            Self::Step(step) => write!(
                f,
                "`step` is {step} s, but it must be a finite number above zero, also when it is rounded to the number \
                 type of the arrays"
            ),
        }
    }
}

impl Error for GpuError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Function(error) => Some(error),
            _ => None,
        }
    }
}

/// Returns advice for an error of a call of the driver; empty for most errors.
fn advice(name: &str) -> &'static str {
    match name {
        "CUDA_ERROR_ILLEGAL_ADDRESS" => {
            ". A kernel that was launched before read or wrote outside of its arrays; the context can no \
             longer be used, start the program again"
        }
        name if name.contains("STREAM_CAPTURE") => ". Prepare the function before the capture of a graph begins",
        _ => "",
    }
}
