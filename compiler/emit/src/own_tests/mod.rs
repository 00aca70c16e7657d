//! Tests that are emitted with the code: values that another program has computed, and laws of mechanics.
//!
//! This module decides which functions have which tests; a module for each language writes these tests.

mod c;
mod rust;

use rne_codegen::{Function, Program};

pub use c::{c_tests, without_c_tests};
pub use rust::rust_tests;

/// A state at which emitted code is tested.
#[derive(Clone, Debug, PartialEq)]
pub struct Golden {
    /// The numbers of every argument array, by the name that it has in emitted Rust; and `parameters`, if the robot has
    /// parameters at run time.
    pub arguments: Vec<(&'static str, Vec<f64>)>,
    /// The results of each program, in the order of its layout, computed by code that is independent of the compiler.
    /// Empty if there is nothing to compare with: accelerations for a singular mass matrix are not finite.
    pub results: Vec<Vec<f64>>,
    /// The approximate size of the terms from which each program computes its results: a result that is zero for this
    /// arm may differ from zero by rounding errors of these terms.
    pub sizes: Vec<f64>,
    /// The changes of the positions and of the velocities by a step of the Runge-Kutta method of the duration
    /// [`STEP`](Self::STEP), and the derivatives of the step, in the order of their layouts. Empty if the file has no
    /// `forward_dynamics`, or if there is nothing to compare with.
    pub steps: [Vec<f64>; 2],
}

impl Golden {
    /// The duration of a step, s; it is exact in every number type.
    pub const STEP: f64 = 1.0 / 256.0;

    /// Returns the numbers of an argument array, by its name.
    fn argument(&self, name: &str) -> &[f64] {
        self.arguments.iter().find(|(known, _)| *known == name).map_or(&[], |(_, numbers)| numbers)
    }
}

/// The arguments that all functions share; the tests of physical laws use them.
const MOTION: [&str; 4] = ["q", "qd", "qdd", "tau"];

/// A law of mechanics that the results of functions must obey.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Law {
    /// M = Mᵀ, to the last bit.
    Symmetry,
    /// τ(q, q̇, a + b) - τ(q, q̇, b) = τ(q, q̇, a) - τ(q, q̇, 0).
    Linearity,
    /// g(q) = τ(q, 0, 0).
    Gravity,
    /// C(q, q̇) q̇ + g(q) = τ(q, q̇, 0).
    Bias,
    /// T = ½ q̇ᵀ M q̇.
    Kinetic,
    /// q̇ᵀ τ is the rate of kinetic and potential energy.
    Power,
}

/// A call of a function in the test of a law.
struct Call<'a> {
    /// The variable for the result.
    result: &'static str,
    function: Function,
    /// Arguments that replace those of the state.
    others: Vec<(&'static str, &'a str)>,
}

impl Law {
    const ALL: [Self; 6] = [Self::Symmetry, Self::Linearity, Self::Gravity, Self::Bias, Self::Kinetic, Self::Power];

    /// Returns the calls whose results the test compares. The arguments are expressions of the language: accelerations
    /// `sum`, `a` and `b`, where `sum` is a + b, and `zero`, an array of zeros.
    fn calls(self, [sum, a, b, zero]: [&str; 4]) -> Vec<Call<'_>> {
        let call = |result, function| Call { result, function, others: Vec::new() };
        let torques_at = |result, qdd| Call { others: vec![("qdd", qdd)], ..call(result, Function::InverseDynamics) };
        match self {
            Self::Symmetry => vec![call("mass", Function::MassMatrix)],
            Self::Linearity => {
                vec![
                    torques_at("of_sum", sum),
                    torques_at("of_a", a),
                    torques_at("of_b", b),
                    torques_at("at_zero", zero),
                ]
            }
            // torques that are zero but for rounding errors are compared on the scale of the torques of the motion
            Self::Gravity => vec![
                call("found", Function::GravityTorques),
                Call { others: vec![("qd", zero), ("qdd", zero)], ..call("expected", Function::InverseDynamics) },
                call("moving", Function::InverseDynamics),
            ],
            Self::Bias => vec![
                call("found", Function::BiasTorques),
                torques_at("expected", zero),
                call("moving", Function::InverseDynamics),
            ],
            Self::Kinetic => vec![call("mass", Function::MassMatrix), call("found", Function::KineticEnergy)],
            Self::Power => vec![
                Call { others: vec![("q", "q"), ("qd", "qd")], ..call("kinetic", Function::KineticEnergy) },
                Call { others: vec![("q", "q")], ..call("potential", Function::PotentialEnergy) },
                call("moving", Function::InverseDynamics),
            ],
        }
    }

    /// Returns the part for this law of a text with one part for each law; gravity and bias share a part.
    fn part_of(self, laws: &str) -> &str {
        let index = match self {
            Self::Symmetry => 0,
            Self::Linearity => 1,
            Self::Gravity | Self::Bias => 2,
            Self::Kinetic => 3,
            Self::Power => 4,
        };
        laws.split("// next law\n").nth(index).unwrap_or_default()
    }

    /// Returns the name of the law's test.
    const fn name(self) -> &'static str {
        match self {
            Self::Symmetry => "mass_matrix_is_symmetric",
            Self::Linearity => "torques_are_linear_in_accelerations",
            Self::Gravity => "gravity_torques_are_torques_at_rest",
            Self::Bias => "bias_torques_are_torques_without_accelerations",
            Self::Kinetic => "kinetic_energy_is_that_of_the_mass_matrix",
            Self::Power => "power_is_the_rate_of_energy",
        }
    }

    /// Returns the laws whose functions are all in the file.
    fn of(programs: &[Program]) -> impl Iterator<Item = Self> {
        let is_there = |function| program(programs, function).is_some();
        Self::ALL.into_iter().filter(move |law| law.calls([""; 4]).iter().all(|call| is_there(call.function)))
    }
}

/// Replaces names between `@` in a text by their values.
fn filled(text: &str, values: &[(&str, String)]) -> String {
    let value = |name| values.iter().find(|(known, _)| *known == name).map_or("", |(_, value)| value);
    text.split('@').enumerate().map(|(index, part)| if index % 2 == 0 { part } else { value(part) }).collect()
}

/// Returns the results of a program at each state; `None` if a state has nothing to compare with.
fn results(golden: &[Golden], program: usize) -> Option<Vec<&[f64]>> {
    let results = golden.iter().map(|state| state.results.get(program).map_or(&[][..], Vec::as_slice));
    results.map(|numbers| (!numbers.is_empty()).then_some(numbers)).collect()
}

/// Returns the size below which a number of a program counts as zero, as `part` of the size of its terms: rounding
/// errors of terms that cancel.
fn floor(golden: &[Golden], program: usize, part: f64) -> f64 {
    let sizes = golden.iter().filter_map(|state| state.sizes.get(program));
    part * sizes.fold(0.0, |largest: f64, size| largest.max(*size))
}

/// Returns the program of a function that is not compiled for a frame.
fn program(programs: &[Program], function: Function) -> Option<&Program> {
    programs.iter().find(|program| program.function == function && program.frame.is_none())
}
