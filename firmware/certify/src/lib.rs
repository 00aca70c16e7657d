//! Certificates of generated code on microcontrollers.
//!
//! The parts are: the instructions of a function in the output of `objdump` ([`listing`], [`image`]), their cycles on a
//! processor ([`cycles`]), and the error of results in single precision ([`accuracy`], [`observer`],
//! [`joint_functions`]). [`certificate`] puts them on one page. This crate does not start programs and does not open
//! files: callers run the tools and pass their output.
#![forbid(unsafe_code)]

pub mod accuracy;
pub mod board;
pub mod certificate;
pub mod cycles;
pub mod image;
pub mod interval;
pub mod joint_functions;
pub mod listing;
pub mod misra;
pub mod observer;

use std::fmt::Write as _;

use sha2::{Digest, Sha256};

/// Returns the SHA-256 hash of bytes in hexadecimal, as `sha256sum` prints it.
///
/// ```
/// let empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
/// assert_eq!(rne_certify::sha256(b""), empty);
/// ```
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
