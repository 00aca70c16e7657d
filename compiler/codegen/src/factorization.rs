//! Operations of the factors of a mass matrix, by the tree of the robot alone.

use rne_model::Robot;

use crate::coordinates::Coordinates;
use crate::formulate::ldlt::System;
use crate::function::Function;
use crate::program::Operations;

/// The size of the mass matrix of a robot, and the operations of its factors L and D.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Factorization {
    /// Elements on and above the diagonal that are not zero whatever the numbers of the robot are.
    pub elements: usize,
    /// Operations of L and D from these elements.
    pub operations: Operations,
}

impl Factorization {
    /// Counts the mass matrix by which a function solves: with six rows of the base, if that floats in it.
    #[must_use]
    pub fn of(robot: &Robot, function: Function) -> Self {
        let coordinates = Coordinates::of(robot);
        let system = System::new(function, &coordinates, (0..robot.joints.len()).map(|joint| robot.parent(joint)));
        let cost = system.cost_of_factors();
        let operations = Operations { mul: cost.mul, add: cost.add, div: system.size(), ..Operations::default() };
        Self { elements: system.elements(), operations }
    }
}
