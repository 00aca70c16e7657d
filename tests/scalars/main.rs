//! Generated code of every function on every kind of number: single precision, lanes, two kinds of dual numbers and,
//! where the target has the instructions that their crate asks for, intervals.

#[cfg(any(target_arch = "aarch64", all(target_feature = "avx", target_feature = "fma")))]
mod intervals;
mod numbers;
mod robots;
