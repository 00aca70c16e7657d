//! Counts the operations that factor a mass matrix into L D Lᵀ, from the tree of the robot alone.

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
    /// Counts the mass matrix that a function solves with; it has six more rows if the base floats in the function.
    #[must_use]
    pub fn of(robot: &Robot, function: Function) -> Self {
        let coordinates = Coordinates::of(robot);
        let system = System::new(function, &coordinates, (0..robot.joints.len()).map(|joint| robot.parent(joint)));
        let cost = system.cost_of_factors();
        let operations = Operations { mul: cost.mul, add: cost.add, div: system.size(), ..Operations::default() };
        Self { elements: system.elements(), operations }
    }
}
