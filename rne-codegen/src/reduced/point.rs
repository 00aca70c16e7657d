//! Random values for the arguments of a function: where two functions are compared.

use crate::exact::{Image, Reading};
use crate::name::Name;
use crate::quantity::{Component, Quantity};

/// Random values for all arguments: what a function of the robot is compared at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    reading: Reading,
    index: u64,
}

impl Point {
    pub(crate) const fn new(reading: Reading, index: u64) -> Self {
        Self { reading, index }
    }

    fn random(&self, kind: u64, joint: usize) -> Image {
        self.reading.random(kind ^ (self.index << 8), joint as u64)
    }

    pub(crate) fn position(&self, joint: usize) -> Image {
        self.random(1, joint)
    }

    pub(crate) fn rate(&self, joint: usize) -> Image {
        self.random(2, joint)
    }

    pub(crate) fn rate_dot(&self, joint: usize) -> Image {
        self.random(3, joint)
    }

    pub(crate) fn force(&self, axis: usize) -> Image {
        self.random(4, axis)
    }

    pub(crate) fn moment(&self, axis: usize) -> Image {
        self.random(5, axis)
    }

    pub(crate) fn torque(&self, joint: usize) -> Image {
        self.random(7, joint)
    }

    /// An argument of any function; positions of revolute joints are no numbers of the field by themselves, but random ones
    /// serve where only their sines and cosines matter.
    pub(crate) fn argument(&self, name: Name) -> Image {
        let index = name.joint.wrapping_sub(1);
        match (name.quantity, name.component) {
            (Quantity::JointForce, Component::Vector(axis)) => self.force(axis as usize),
            (Quantity::JointMoment, Component::Vector(axis)) => self.moment(axis as usize),
            (Quantity::Omega, Component::Vector(axis)) => self.random(8, axis as usize),
            (Quantity::OmegaDot, Component::Vector(axis)) => self.random(9, axis as usize),
            (Quantity::Acceleration, Component::Vector(axis)) => self.random(10, axis as usize),
            (Quantity::Gravity, Component::Vector(axis)) => self.random(11, axis as usize),
            (Quantity::Parameter, _) => self.random(12, index),
            (Quantity::Position, _) => self.position(index),
            (Quantity::Sine, _) => self.turn(index).0,
            (Quantity::Cosine, _) => self.turn(index).1,
            (Quantity::Rate, _) => self.rate(index),
            (Quantity::AppliedTorque, _) => self.torque(index),
            _ => self.rate_dot(index),
        }
    }

    /// Sine and cosine of the position of a joint.
    pub(crate) fn turn(&self, joint: usize) -> (Image, Image) {
        self.reading.point(6 ^ (self.index << 8), joint as u64)
    }
}
