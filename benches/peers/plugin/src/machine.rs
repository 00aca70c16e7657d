//! The functions of an arm that is compiled at run time, for many states in one call.

use rne_codegen::Function;
use rne_machine::{Arguments, Array, CompiledArm, Destination};

use crate::abi::quantity::{DTAU_DQ, DTAU_DQD};

/// Torques, which are checked as those of any batch.
pub(crate) const TORQUES: Function = Function::InverseDynamics;
/// Mass matrices; the driver has a reference.
pub(crate) const MASS_MATRIX: Function = Function::MassMatrix;
/// Accelerations; the third argument is torques.
pub(crate) const FORWARD_DYNAMICS: Function = Function::ForwardDynamics;
/// Both derivatives of the torques.
pub(crate) const DERIVATIVES: Function = Function::InverseDynamicsDerivatives;

/// The number of states whose matrices are computed at a time. Each block overwrites the one before, so the memory
/// stays in the cache. Pinocchio does the same: each call overwrites the matrix in its `Data`. The machine computes so
/// many at a time with AVX-512.
const BLOCK: usize = 64;

/// A function of an arm, and the matrices of its last block: element by element, in each the states.
pub(crate) struct Machine {
    arm: CompiledArm,
    function: Function,
    matrices: Vec<f64>,
    /// Whether all states are one block.
    pub(crate) keeps_all: bool,
}

impl Machine {
    /// `file` is a robot file, with its plan file beside it.
    pub(crate) fn new(file: &str, function: Function) -> Self {
        let arm = CompiledArm::from_file(file).unwrap_or_else(|error| panic!("{error}"));
        Self { arm, function, matrices: Vec::new(), keeps_all: false }
    }

    /// The number of joints.
    pub(crate) fn dof(&self) -> usize {
        self.arm.dof()
    }

    /// Joint j of state k is number j·count + k of each argument and of `out`, which matrices do not use.
    pub(crate) fn call(&mut self, arguments: [&[f64]; 3], out: &mut [f64], count: usize) {
        let function = self.arm.function(self.function).unwrap_or_else(|error| panic!("{error}"));
        let columns = arguments.map(|numbers| numbers.chunks(count).collect::<Vec<_>>());
        let is_matrix = function.outputs() != self.arm.dof();
        let block = if is_matrix && !self.keeps_all { BLOCK.min(count) } else { count };
        if is_matrix {
            self.matrices.resize(function.outputs() * block, 0.0);
        }
        for first in (0..count).step_by(block) {
            let states = first..(first + block).min(count);
            let columns =
                columns.each_ref().map(|columns| columns.iter().map(|x| &x[states.clone()]).collect::<Vec<_>>());
            let [q, qd, third] = columns.each_ref().map(|columns| Array::Columns(columns));
            let arguments = Arguments::new().q(q).qd(qd).qdd(third).tau(third);
            let room = if is_matrix { &mut self.matrices } else { &mut *out };
            let results = Destination::Columns(room.chunks_mut(block).map(|x| &mut x[..states.len()]).collect());
            let done = self.arm.run(self.function, states.len(), &arguments, results);
            assert!(done.is_ok(), "all columns have the same length");
        }
    }

    /// The matrices of a quantity, if this function has it.
    pub(crate) fn matrices(&self, quantity: i32) -> Option<&[f64]> {
        match (self.function, quantity) {
            (MASS_MATRIX, crate::abi::quantity::MASS_MATRIX) | (DERIVATIVES, DTAU_DQ) => Some(&self.matrices),
            (DERIVATIVES, DTAU_DQD) => Some(&self.matrices[self.matrices.len() / 2..]),
            _ => None,
        }
    }
}
