//! Finds the physically possible parameters of links, rotors and friction that explain the logs best.
//!
//! The problem is convex: least squares on the triangular factor R of the rows, with a positive definite pseudo-inertia
//! P of every link, positive friction and rotor inertia y, and a weak regularization towards prior values,
//!
//! ```text
//! min ½ |R u(y) - z|² + γ Σ (tr(P₀⁻¹ P) - log det P) + γ Σ (y / y₀ - log y)
//! ```
//!
//! The regularization is Bregman's divergence of the log determinant (T. Lee, F. C. Park, A geometric algorithm for
//! robust multibody inertial parameter identification, IEEE RA-L 3(3), 2018): it does not depend on the frames, is
//! least at the prior P₀, and tends to infinity where a link ceases to be physically possible. It determines the
//! parameters that the logs do not determine. Newton's method computes the minimum for a large γ first and then for
//! smaller ones, down to the required γ.
//!
//! G = γ P⁻¹ and g = γ / y are multipliers of P ⪰ 0 and y ≥ 0 in the problem without logarithms: its gradient vanishes
//! with them, they are positive, and tr(G P) is γ for each row of a matrix, so the minimum is within the
//! [`Certificate`]'s gap of the exact one.

use nalgebra::{DMatrix, DVector, Matrix4};

use crate::fit::least_squares::LeastSquares;
use crate::fit::prior::{self, Scales};
use crate::fit::pseudo_inertia;
use crate::fit::structure::{FRICTION, Structure};
use rne_model::PER_LINK;

/// First value of γ, and the factor by which γ decreases in each step.
const START: f64 = 1e6;
const STEP: f64 = 0.2;
/// Largest number of Newton steps at each γ.
const STEPS: usize = 60;
/// Half the square of the Newton decrement below which a point counts as the minimum.
const CLOSE: f64 = 1e-11;
/// Expected friction and rotor inertia without values in the robot file, as a part of the joint's effort and of the
/// inertia of the distal links.
const PART: f64 = 0.1;

/// Physically possible parameters of links, rotors and friction.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Feasible {
    /// The pseudo-inertia of each link.
    pub links: Vec<Matrix4<f64>>,
    /// G² Jm of each joint, kg m² (or kg); zeros when rotors were not asked for.
    pub rotors: Vec<f64>,
    /// Viscous friction and Coulomb friction forward and backward of each joint, all positive; zeros when friction was
    /// not asked for.
    pub friction: Vec<[f64; FRICTION]>,
    /// The unknowns that follow from these parameters, in the order of [`LeastSquares::solution`].
    pub unknowns: DVector<f64>,
    /// Numbers that show how near to the minimum these parameters are.
    pub certificate: Certificate,
}

/// The numbers that prove a point to be the minimum of the convex problem.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Certificate {
    /// γ, the weight of the regularization.
    pub regularization: f64,
    /// Half the sum of squares, weighted, at the point.
    pub misfit: f64,
    /// Half the sum of squares at the unconstrained minimum.
    pub least_misfit: f64,
    /// Half the square of the Newton decrement, which is what another Newton step would gain; divided by γ if γ < 1.
    pub decrement: f64,
    /// Σ tr(G P) + Σ g y: how far the objective without logarithms can be from its minimum.
    pub gap: f64,
    /// The ratio of the smallest to the largest eigenvalue of a link's pseudo-inertia; the smallest ratio of all links.
    pub margin: f64,
}

/// The convex problem in scaled coordinates, whose magnitude is about 1.
struct Problem {
    /// The matrix from scaled coordinates to unknowns.
    map: DMatrix<f64>,
    /// R, z, and the unknowns that minimize |R u - z|.
    design: DMatrix<f64>,
    target: DVector<f64>,
    least: DVector<f64>,
    links: usize,
    /// The parameter that a scaled coordinate of 1 means.
    scale: DVector<f64>,
    /// The inverses of the prior pseudo-inertias P₀.
    inverses: Vec<Matrix4<f64>>,
    units: [Matrix4<f64>; PER_LINK],
    /// Number of coordinates that must be positive: rotors and friction. They follow those of the links.
    positive: usize,
    /// The prior values y₀ of the positive coordinates, not scaled.
    expected: Vec<f64>,
}

impl Feasible {
    /// Finds the feasible parameters nearest to a least-squares estimate. `regularization` is γ: a weight of 1 is as
    /// strong as one row of noise.
    #[must_use]
    pub fn of(structure: &Structure, fit: &LeastSquares, scales: &Scales, regularization: f64) -> Self {
        let problem = Problem::new(structure, fit, scales);
        let mut at = problem.start(structure);
        let mut weight = START.max(regularization);
        let mut decrement = f64::INFINITY;
        loop {
            for _ in 0..STEPS {
                decrement = problem.step(&mut at, weight);
                if decrement < CLOSE {
                    break;
                }
            }
            if weight <= regularization {
                break;
            }
            weight = (weight * STEP).max(regularization);
        }
        problem.result(structure, &at, regularization, decrement)
    }
}

impl Problem {
    fn new(structure: &Structure, fit: &LeastSquares, scales: &Scales) -> Self {
        let dof = structure.dof();
        let count = structure.count();
        let of_rotors = if structure.options.rotors { dof } else { 0 };
        let of_friction = if structure.options.friction { FRICTION * dof } else { 0 };
        let links = structure.robot.joints.len();
        let inertial = links * PER_LINK;
        let positive = of_rotors + of_friction;
        let map = map(structure, inertial, of_rotors, of_friction);
        let priors = prior::links(&structure.robot);
        let mut scale = DVector::from_element(map.ncols(), 1.0);
        for (link, prior) in priors.iter().enumerate() {
            scale.as_mut_slice()[link * PER_LINK..][..PER_LINK].copy_from_slice(&prior.scales());
        }
        let behind = |joint: usize| {
            let first = structure.robot.coordinates().nth(joint).unwrap_or(joint);
            (first..links).map(|link| scale[link * PER_LINK + 9]).sum()
        };
        let rotors = (0..of_rotors).map(|joint| expected_rotor(structure, joint, behind(joint)));
        let friction =
            (0..of_friction / FRICTION).flat_map(|joint| expected_friction(structure, joint, scales.friction[joint]));
        let expected: Vec<f64> = rotors.chain(friction).collect();
        for (at, expected) in expected.iter().enumerate() {
            scale[inertial + at] = *expected;
        }
        if structure.options.delay {
            scale[inertial + positive] = 1e-3;
        }
        let triangle = fit.triangle.triangle();
        let design = triangle.view((0, 0), (count, count)).clone_owned();
        // an offset beyond Coulomb friction is cut to it, so that the links do not take over the rest
        let mut least = fit.solution.clone();
        for joint in 0..dof {
            let loose = fit.loose_offset(structure, joint, scales.friction[joint]);
            if let (Some((offset, coulomb)), Some(at)) = (loose, structure.friction_at(joint)) {
                least[at + 2] = coulomb.copysign(offset);
            }
        }
        let target = triangle.view((0, count), (count, 1)).column(0) - &design * (&fit.solution - &least);
        let inverses = priors.iter().map(|prior| {
            // the inverse exists: all priors are positive definite
            prior.pseudo_inertia.try_inverse().unwrap_or_else(Matrix4::identity)
        });
        Self {
            design,
            target,
            least,
            links,
            inverses: inverses.collect(),
            units: pseudo_inertia::units(),
            positive,
            expected,
            map: DMatrix::from_fn(count, scale.len(), |row, column| map[(row, column)] * scale[column]),
            scale,
        }
    }

    fn start(&self, structure: &Structure) -> DVector<f64> {
        let mut at = DVector::zeros(self.scale.len());
        for (link, prior) in prior::links(&structure.robot).iter().enumerate() {
            for (index, value) in pseudo_inertia::parameters(&prior.pseudo_inertia).iter().enumerate() {
                at[link * PER_LINK + index] = value / self.scale[link * PER_LINK + index];
            }
        }
        let inertial = self.links * PER_LINK;
        for index in 0..self.positive {
            at[inertial + index] = self.expected[index] / self.scale[inertial + index];
        }
        at
    }

    fn pseudo_inertia(&self, at: &DVector<f64>, link: usize) -> Matrix4<f64> {
        let parameter = |index: usize| at[link * PER_LINK + index] * self.scale[link * PER_LINK + index];
        pseudo_inertia::of(&std::array::from_fn(parameter))
    }

    /// Returns the objective; infinite where a link or a positive coordinate is not physically possible.
    fn value(&self, at: &DVector<f64>, regularization: f64) -> f64 {
        let mut value = 0.5 * (&self.design * (&self.map * at) - &self.target).norm_squared();
        for link in 0..self.links {
            let pseudo = self.pseudo_inertia(at, link);
            let Some(cholesky) = pseudo.cholesky() else { return f64::INFINITY };
            let log: f64 = 2.0 * cholesky.l().diagonal().iter().map(|x| x.ln()).sum::<f64>();
            value += regularization * ((self.inverses[link] * pseudo).trace() - log);
        }
        let inertial = self.links * PER_LINK;
        for index in 0..self.positive {
            let y = at[inertial + index];
            if y <= 0.0 {
                return f64::INFINITY;
            }
            value += regularization * (y * self.scale[inertial + index] / self.expected[index] - y.ln());
        }
        value
    }

    /// Takes one Newton step; returns half the square of the Newton decrement, divided by γ if γ < 1.
    fn step(&self, at: &mut DVector<f64>, regularization: f64) -> f64 {
        let design = &self.design * &self.map;
        let residual = &design * &*at - &self.target;
        let mut gradient = design.tr_mul(&residual);
        let mut hessian = design.tr_mul(&design);
        for link in 0..self.links {
            let Some(inverse) = self.pseudo_inertia(at, link).try_inverse() else { return 0.0 };
            let first = link * PER_LINK;
            let turned: Vec<Matrix4<f64>> =
                self.units.iter().enumerate().map(|(k, unit)| inverse * unit * self.scale[first + k]).collect();
            for k in 0..PER_LINK {
                gradient[first + k] += regularization
                    * ((self.inverses[link] * self.units[k]).trace() * self.scale[first + k] - turned[k].trace());
                for l in 0..PER_LINK {
                    hessian[(first + k, first + l)] += regularization * (turned[k] * turned[l]).trace();
                }
            }
        }
        let inertial = self.links * PER_LINK;
        for index in 0..self.positive {
            let (place, y) = (inertial + index, at[inertial + index]);
            gradient[place] += regularization * (self.scale[place] / self.expected[index] - 1.0 / y);
            hessian[(place, place)] += regularization / (y * y);
        }
        let Some(cholesky) = hessian.cholesky() else { return 0.0 };
        let direction = cholesky.solve(&gradient);
        let decrement = 0.5 * gradient.dot(&direction);
        let before = self.value(at, regularization);
        let mut length = 1.0;
        while length > 1e-12 {
            let next = &*at - &direction * length;
            if self.value(&next, regularization) <= before - 0.25 * length * decrement {
                *at = next;
                break;
            }
            length *= 0.5;
        }
        decrement / regularization.min(1.0)
    }

    fn result(&self, structure: &Structure, at: &DVector<f64>, regularization: f64, decrement: f64) -> Feasible {
        let unknowns = &self.map * at;
        let links: Vec<Matrix4<f64>> = (0..self.links).map(|link| self.pseudo_inertia(at, link)).collect();
        let misfit = |unknowns: &DVector<f64>| 0.5 * (&self.design * unknowns - &self.target).norm_squared();
        let margin = links.iter().map(pseudo_inertia::margin).fold(f64::INFINITY, f64::min);
        #[allow(clippy::cast_precision_loss)]
        let gap = regularization * (4 * self.links + self.positive) as f64;
        let certificate = Certificate {
            regularization,
            misfit: misfit(&unknowns),
            least_misfit: misfit(&self.least),
            decrement,
            gap,
            margin,
        };
        let inertial = self.links * PER_LINK;
        let unscaled = |index: usize| at[inertial + index] * self.scale[inertial + index];
        let dof = structure.dof();
        let of_rotors = if structure.options.rotors { dof } else { 0 };
        let rotors = (0..dof).map(|joint| if joint < of_rotors { unscaled(joint) } else { 0.0 }).collect();
        let friction = (0..dof).map(|joint| {
            if !structure.options.friction {
                return [0.0; FRICTION];
            }
            std::array::from_fn(|k| unscaled(of_rotors + FRICTION * joint + k))
        });
        Feasible { links, rotors, friction: friction.collect(), unknowns, certificate }
    }
}

/// Returns the matrix from coordinates (inertial parameters of links, rotors, friction of both directions and the
/// delay) to unknowns (base parameters, friction with offsets and the delay).
fn map(structure: &Structure, inertial: usize, of_rotors: usize, of_friction: usize) -> DMatrix<f64> {
    let (count, rank) = (structure.count(), structure.parameters.rank());
    let positive = of_rotors + of_friction;
    let delay = usize::from(structure.options.delay);
    let mut map = DMatrix::zeros(count, inertial + positive + delay);
    map.view_mut((0, 0), (rank, inertial + of_rotors)).copy_from(&structure.parameters.regrouping);
    for joint in 0..of_friction / FRICTION {
        let (row, column) = (rank + FRICTION * joint, inertial + of_rotors + FRICTION * joint);
        map[(row, column)] = 1.0;
        // with p forward, n backward and the sign s of the speed, Coulomb friction is ½ (p + n) s + ½ (p - n)
        for (row, signs) in [(row + 1, [0.5, 0.5]), (row + 2, [0.5, -0.5])] {
            map[(row, column + 1)] = signs[0];
            map[(row, column + 2)] = signs[1];
        }
    }
    if delay == 1 {
        map[(count - 1, inertial + positive)] = 1.0;
    }
    map
}

/// Returns the expected inertia of a rotor, at its joint: that of the robot file or, without one, a part of `behind`,
/// the inertia of the distal links.
fn expected_rotor(structure: &Structure, joint: usize, behind: f64) -> f64 {
    let motor = structure.robot.independent_joint(joint).and_then(|joint| joint.motor);
    let known = motor.map(|motor| motor.gear_ratio.powi(2) * motor.inertia);
    known.filter(|known| *known > 0.0).unwrap_or(PART * behind)
}

/// Returns the expected friction of a joint: that of the robot file or, without one, a part of the joint's effort.
fn expected_friction(structure: &Structure, joint: usize, effort: f64) -> [f64; FRICTION] {
    let motor = structure.robot.independent_joint(joint).and_then(|joint| joint.motor);
    let of_file = motor.map_or([0.0; FRICTION], |motor| {
        let ratio = motor.gear_ratio.abs();
        [ratio * ratio * motor.viscous, ratio * motor.coulomb[0], -ratio * motor.coulomb[1]]
    });
    of_file.map(|known| if known > 0.0 { known } else { PART * effort })
}
