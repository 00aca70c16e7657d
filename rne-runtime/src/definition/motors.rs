//! Motors of the list `motors`: their speeds N q̇, the torques Nᵀ τ_m that they exert on the coordinates, and the way
//! back, where N has an inverse.

use nalgebra::Vector3;
use rne_model::{Convention, Robot};

use crate::seven_steps::link_frame::rotation_x;
use crate::seven_steps::spin::{Spin, Spins};
use crate::{Constant, DynArm, Scalar, WrongLength};

/// The motors of a robot and their rotors.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Motors<S> {
    spins: Vec<Spin<S>>,
    turns: Vec<(usize, S)>,
    /// N, by rows.
    matrix: Vec<Vec<S>>,
    /// N⁻¹, by rows.
    inverse: Option<Vec<Vec<S>>>,
}

impl Motors<f64> {
    pub(crate) fn of(robot: &Robot) -> Self {
        let (mut spins, mut turns) = (Vec::new(), Vec::new());
        for (rotor, joints) in robot.spinning_rotors() {
            let axis = Vector3::from(rotor.axis);
            let axis = match (robot.convention, rotor.on) {
                (Convention::Standard, Some(link)) => rotation_x(&robot.joints[link].row.dh.alpha) * axis,
                _ => axis,
            };
            let start = turns.len();
            turns.extend_from_slice(joints);
            spins.push(Spin { on: rotor.on, axis, inertia: rotor.inertia, turns: [start, turns.len()] });
        }
        Self { spins, turns, matrix: robot.motor_matrix(), inverse: robot.inverse_motor_matrix() }
    }

    #[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
    pub(crate) fn to_f32(&self) -> Motors<f32> {
        let single = |x: &f64| *x as f32;
        let rows = |matrix: &Vec<Vec<f64>>| matrix.iter().map(|row| row.iter().map(single).collect()).collect();
        let spin = |spin: &Spin<f64>| Spin {
            on: spin.on,
            axis: spin.axis.map(|x| x as f32),
            inertia: spin.inertia as f32,
            turns: spin.turns,
        };
        Motors {
            spins: self.spins.iter().map(spin).collect(),
            turns: self.turns.iter().map(|(joint, n)| (*joint, *n as f32)).collect(),
            matrix: rows(&self.matrix),
            inverse: self.inverse.as_ref().map(rows),
        }
    }
}

impl<S: Constant> Motors<S> {
    pub(crate) const NONE: Self = Self { spins: Vec::new(), turns: Vec::new(), matrix: Vec::new(), inverse: None };

    pub(crate) fn spins(&self) -> Spins<'_, S> {
        Spins { spins: &self.spins, turns: &self.turns }
    }
}

/// a · x, the terms from left to right; terms with a zero of the constants are left out.
fn dot<'a, S: Constant, T: Scalar>(constants: impl Iterator<Item = &'a S>, x: &[T]) -> T {
    let terms = constants.zip(x).filter(|(factor, _)| **factor != S::zero()).map(|(factor, &x)| x * factor.to());
    terms.reduce(|sum, term| sum + term).unwrap_or_else(T::zero)
}

impl<S: Constant> DynArm<S> {
    /// The number of motors of the list `motors`.
    #[must_use]
    pub fn motor_count(&self) -> usize {
        self.drives.matrix.len()
    }

    /// N q̇, the speeds of the motors of the list `motors`, rad/s, in the order of the list.
    ///
    /// # Errors
    /// When the argument does not have one element per joint.
    pub fn motor_speeds<T: Scalar>(&self, qd: &[T]) -> Result<Vec<T>, WrongLength> {
        self.has_length("qd", qd)?;
        Ok(self.drives.matrix.iter().map(|row| dot(row.iter(), qd)).collect())
    }

    /// Nᵀ τ, the torques that work on the joints, N m or N, from the torques of the motors of the list `motors`.
    ///
    /// # Errors
    /// When the argument does not have one element per motor.
    pub fn joint_torques<T: Scalar>(&self, motor_torques: &[T]) -> Result<Vec<T>, WrongLength> {
        let (expected, found) = (self.motor_count(), motor_torques.len());
        if expected != found {
            return Err(WrongLength { argument: "motor_torques", expected, found });
        }
        let of_joint = |joint: usize| dot(self.drives.matrix.iter().map(|row| &row[joint]), motor_torques);
        Ok((0..self.dof()).map(of_joint).collect())
    }

    /// N⁻ᵀ τ, the torques of the motors of the list `motors`, N m, that work as τ on the joints; `None` where N has no
    /// inverse: there must be as many motors as joints, and no motion of the joints may leave all motors at rest.
    ///
    /// # Errors
    /// When the argument does not have one element per joint.
    pub fn motor_torques<T: Scalar>(&self, tau: &[T]) -> Result<Option<Vec<T>>, WrongLength> {
        self.has_length("tau", tau)?;
        let all = |inverse: &Vec<Vec<S>>| {
            let of_motor = |motor: usize| dot(inverse.iter().map(|row| &row[motor]), tau);
            (0..inverse.len()).map(of_motor).collect()
        };
        Ok(self.drives.inverse.as_ref().map(all))
    }
}
