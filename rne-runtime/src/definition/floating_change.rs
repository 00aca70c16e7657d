//! Derivatives of an Euler step of a robot with a floating base with respect to the state before it and to the torques.
//! The derivatives of the accelerations are -M⁻¹ times those of the wrench on the base and of the torques.

use core::array::from_fn;

use crate::definition::Definition;
use crate::definition::floating_base::BASE;
use crate::definition::floating_euler_step::next_of_base;
use crate::definition::per_joint::{PerJoint, Square};
use crate::integrators::floating_integrator::{turn, turn_by_change};
use crate::integrators::moved;
use crate::number::ldlt::{factor, solve};
use crate::seven_steps::at_tip::AtTip;
use crate::values::pose_log::{cross, times, transposed};
use crate::{BaseAcceleration, BaseMotion, BaseTwist, Constant, Dual, Pose, Scalar, Wrench};

/// Returns the motion at which the forces are differentiated. It contains the acceleration of the base less gravity, so
/// its field `gravity` stays zero.
fn motion<T: Scalar>(twist: &BaseTwist<T>, acceleration: &BaseAcceleration<T>) -> BaseMotion<T> {
    BaseMotion {
        omega: twist.angular,
        omega_dot: acceleration.angular,
        acceleration: acceleration.linear,
        ..BaseMotion::default()
    }
}

/// The mass matrix, and the derivatives of the wrench on the base and of the torques. Each has six rows of the base and
/// one for each joint.
struct Forces<'a, T, R, J> {
    mass: &'a mut [R],
    dq: &'a [J],
    dqd: &'a [J],
    domega: &'a [[T; 3]],
}

impl<T: Scalar, R: AsRef<[T]> + AsMut<[T]>, J: AsRef<[T]>> Forces<'_, T, R, J> {
    /// Passes every derivative to `put`: [0 for a position or 1 for a velocity, kind of the argument (0 positions, 1
    /// velocities, 2 torques)], [row, column] and value. `lists` are scratch memory for as many numbers as the matrix
    /// has rows.
    fn derivatives(self, change: &Change<T>, lists: [&mut [T]; 4], mut put: impl FnMut([usize; 2], [usize; 2], T)) {
        let [inverse, x, positions, velocities] = lists;
        factor(self.mass, inverse);
        let size = x.len();
        for (kind, columns) in [size, size, size - BASE].into_iter().enumerate() {
            for column in 0..columns {
                for (row, x) in x.iter_mut().enumerate() {
                    *x = match (kind, column.checked_sub(BASE)) {
                        (0, Some(joint)) => -self.dq[row].as_ref()[joint],
                        (1, Some(joint)) => -self.dqd[row].as_ref()[joint],
                        (1, None) if column >= 3 => -self.domega[row][column - 3],
                        (2, _) if row == BASE + column => T::one(),
                        _ => T::zero(),
                    };
                }
                solve(self.mass, inverse, x);
                change.of([0, 1].map(|own| (own == kind).then_some(column)), x, [positions, velocities]);
                for (half, changes) in [&*positions, &*velocities].into_iter().enumerate() {
                    changes.iter().enumerate().for_each(|(row, &element)| put([half, kind], [row, column], element));
                }
            }
        }
    }
}

/// The numbers of a step from which the changes of the next state are computed.
struct Change<T> {
    step: T,
    /// R'ᵀ R, which turns axes of frame 0 before the step into those after it.
    back: [[T; 3]; 3],
    /// v + h a, in axes of frame 0 before the step.
    linear: [T; 3],
    /// v', in axes of frame 0 after the step.
    next_linear: [T; 3],
    /// h ω / 4, the coordinates u of the turn.
    quarter: [T; 3],
}

impl<T: Scalar> Change<T> {
    /// Computes these numbers from the velocities of the base before and after the step, and its acceleration less
    /// gravity.
    fn new(twist: &BaseTwist<T>, next: &BaseTwist<T>, acceleration: &[T; 3], step: T) -> Self {
        let quarter = next.angular.map(|x| x * step * T::from_f64(0.25));
        Self {
            step,
            back: transposed(&turn(&next.angular, step).rotation()),
            linear: moved(&twist.linear, acceleration, step),
            next_linear: next.linear,
            quarter,
        }
    }

    /// Writes the changes of positions and velocities after the step, caused by a unit change of position `q` or
    /// velocity `v` before it and by the changes of the accelerations that belong to it.
    fn of(&self, [q, v]: [Option<usize>; 2], accelerations: &[T], [positions, velocities]: [&mut [T]; 2]) {
        let unit = |of: Option<usize>, at: usize| if of == Some(at) { T::one() } else { T::zero() };
        for (at, &acceleration) in accelerations.iter().enumerate() {
            velocities[at] = unit(v, at) + self.step * acceleration;
            positions[at] = unit(q, at) + self.step * velocities[at];
        }
        let three = |from: usize| -> [T; 3] { from_fn(|at| unit(q, from + at)) };
        // the rotation R E of the base after the step changes by Eᵀ δθ and by the change of E
        let angular: [T; 3] = from_fn(|at| velocities[3 + at] * self.step * T::from_f64(0.25));
        let by_rate = turn_by_change(&self.quarter, &angular);
        let before = times(&self.back, &three(3));
        let turned: [T; 3] = from_fn(|at| before[at] + by_rate[at]);
        // the velocity in world axes is R (v + h a) + h g, here in axes of frame 0 before the step, then after it
        let swung = cross(&three(3), &self.linear);
        let linear: [T; 3] = from_fn(|at| velocities[at] + swung[at]);
        let linear = times(&self.back, &linear);
        let origin = times(&self.back, &three(0));
        let swung = cross(&self.next_linear, &turned);
        for at in 0..3 {
            positions[at] = origin[at] + self.step * linear[at];
            positions[3 + at] = turned[at];
            velocities[at] = linear[at] + swung[at];
        }
    }
}

/// Derivatives of the positions and of the velocities after a step, each with respect to positions, velocities and
/// torques.
type Blocks<J, V, T> = (
    Square<V, T>,
    Square<V, T>,
    <V as PerJoint>::Of<<J as PerJoint>::Of<T>>,
    Square<V, T>,
    Square<V, T>,
    <V as PerJoint>::Of<<J as PerJoint>::Of<T>>,
);

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    pub(crate) fn floating_step_derivatives<T: Scalar>(
        self,
        [q, qd, tau]: [&[T]; 3],
        (pose, twist): (&Pose<T>, &BaseTwist<T>),
        step: T,
        wrenches: &[Wrench<T>],
        still: &[Wrench<Dual<T>>],
    ) -> Blocks<J, V, T> {
        let load = AtTip::Wrenches(wrenches);
        let (found, qdd) = self.floating_forward_dynamics([q, qd, tau], &twist.angular, load);
        let (dq, dqd, domega) = self.floating_derivatives([q, qd, qdd.as_ref()], &motion(twist, &found), still);
        let next = next_of_base((pose, twist), &found, &self.mechanism.gravity.map(S::to), step).1;
        let zeros = self.velocities.all(&T::zero());
        let square = || self.velocities.all(&zeros);
        let (mut by_state, mut by_torques) =
            ([[square(), square()], [square(), square()]], [(); 2].map(|()| self.velocities.all(&self.zeros())));
        let mut lists = [(); 4].map(|()| zeros.clone());
        let mut mass = self.floating_mass_matrix(q, AtTip::Nothing);
        let forces = Forces { mass: mass.as_mut(), dq: dq.as_ref(), dqd: dqd.as_ref(), domega: domega.as_ref() };
        let change = Change::new(twist, &next, &found.linear, step);
        forces.derivatives(
            &change,
            lists.each_mut().map(AsMut::as_mut),
            |[half, kind], [row, column], x| match by_state[half].get_mut(kind) {
                Some(matrix) => matrix.as_mut()[row].as_mut()[column] = x,
                None => by_torques[half].as_mut()[row].as_mut()[column] = x,
            },
        );
        let ([[q_dq, q_dv], [v_dq, v_dv]], [q_dtau, v_dtau]) = (by_state, by_torques);
        (q_dq, q_dv, q_dtau, v_dq, v_dv, v_dtau)
    }
}
