//! The shipped robots, as a list that is not typed: a new file in robots/ is in it.
//!
//! A derive needs a type per robot, hence macros and no array.
#![no_std]

include!(concat!(env!("OUT_DIR"), "/robots.rs"));
