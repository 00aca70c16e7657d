//! Dynamics of a robot with a floating base: torques and the wrench that must act on this base, the mass matrix of
//! 6 + n rows, and the motion that follows from torques.
//!
//! M has the base first, force above moment, then the joints. Its columns are the torques and wrenches of unit
//! accelerations by the seven steps. m is the sum of the masses, h and J are read from the columns of ω̇:
//!
//! ```text
//! ω̇ = e_k at rest:  force e_k × h,  moment J e_k        M = [ m 1    -[h]×   F ]
//! h = (-F_z of ω̇_y, -F_x of ω̇_z, F_x of ω̇_y)                [ [h]×    J     N ]      H: the mass matrix of the joints
//!                                                            [ Fᵀ      Nᵀ    H ]
//! ```
//!
//! M = L D Lᵀ is made from the end of q on, with the base last: joints on different branches have a zero in M then, and
//! in L. The order of the operations is otherwise that of [`ForwardDynamics`](crate::ForwardDynamics).

use nalgebra::Vector3;

use crate::definition::Definition;
use crate::definition::coordinates::Coordinates as _;
use crate::definition::floating_kinematics::matrix;
use crate::definition::per_joint::{PerJoint, Square};
use crate::number::ldlt::{factor, solve};
use crate::seven_steps::at_tip::AtTip;
use crate::seven_steps::link_state::{ForceMoment, JointMotions};
use crate::seven_steps::mechanism::Mechanism;
use crate::{BaseAcceleration, BaseMotion, Constant, Scalar, Wrench};

/// Number of rows of the base: x, y, z, then about x, y, z.
pub(crate) const BASE: usize = 6;

/// The parts of the mass matrix on and above its diagonal.
struct FloatingMass<J: PerJoint, T: Scalar> {
    base: [[T; BASE]; BASE],
    /// Rows of the base in the columns of the joints.
    rows: [J::Of<T>; BASE],
    joints: Square<J, T>,
}

/// The motion of a base that turns with ω and has no acceleration, so also no gravity.
pub(crate) fn turning<T: Scalar>(omega: &[T; 3]) -> BaseMotion<T> {
    BaseMotion { omega: *omega, ..BaseMotion::fixed([T::zero(); 3]) }
}

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    fn floating_mass<T: Scalar>(self, q: &[T], load: AtTip<'_, T>) -> FloatingMass<J, T> {
        let load = load.matter();
        let zeros = self.zeros();
        let mut rows: [J::Of<T>; BASE] = core::array::from_fn(|_| zeros.clone());
        let joints = self.mass_matrix_beside(q, load, |column, ForceMoment { force, moment }| {
            for (row, element) in rows.iter_mut().zip(force.iter().chain(moment.iter())) {
                row.as_mut()[column] = *element;
            }
        });
        let still = JointMotions::new(q, zeros.as_ref(), zeros.as_ref());
        let columns = [Vector3::x(), Vector3::y(), Vector3::z()].map(|unit: Vector3<T>| {
            let base = BaseMotion { omega_dot: unit.into(), ..BaseMotion::fixed([T::zero(); 3]) };
            self.of_floating_base(still, &base, load).0
        });
        let chain = self.chain;
        let mass = chain.links::<T>().fold(chain.base::<T>().mass, |mass, link| mass + link.mass);
        let mass = if let AtTip::Payload(payload) = load { mass + payload.mass } else { mass };
        let [x, y, z] = columns.map(|column| column.moment);
        let h = Vector3::new(-columns[1].force.z, -columns[2].force.x, columns[1].force.x);
        let zero = T::zero();
        let base = [
            [mass, zero, zero, zero, h.z, -h.y],
            [zero, mass, zero, -h.z, zero, h.x],
            [zero, zero, mass, h.y, -h.x, zero],
            [zero, -h.z, h.y, x.x, y.x, z.x],
            [h.z, zero, -h.x, y.x, y.y, z.y],
            [-h.y, h.x, zero, z.x, z.y, z.z],
        ];
        FloatingMass { base, rows, joints }
    }
}

/// The centre of mass, h / m.
struct Centre<T: Scalar>(Vector3<T>);

impl<J: PerJoint, T: Scalar> FloatingMass<J, T> {
    fn centre(&self) -> Centre<T> {
        let [[mass, _, _, _, z, minus_y], [_, _, _, _, _, x], ..] = self.base;
        Centre(Vector3::new(x, -minus_y, z) * (T::one() / mass))
    }
}

impl<T: Scalar> Centre<T> {
    /// Turns moments about the origin of frame 0 into moments about the centre of mass. `rows` has a wrench in each
    /// column.
    fn take<R: AsRef<[T]> + AsMut<[T]>>(&self, rows: &mut [R; BASE]) {
        for column in 0..rows[0].as_ref().len() {
            let moment = self.moment(&core::array::from_fn(|row| rows[row].as_ref()[column]));
            for (row, about) in rows[3..].iter_mut().zip(&moment) {
                row.as_mut()[column] = *about;
            }
        }
    }

    /// Does the same as [`take`](Self::take) for the columns of the base. A base that does not turn has no angular
    /// momentum about the centre of mass.
    fn take_base(&self, rows: &mut [[T; BASE]; BASE]) {
        self.take(rows);
        rows[3..].iter_mut().for_each(|row| row[..3].fill(T::zero()));
    }

    /// Returns the moment about the centre of mass, from a wrench about the origin of frame 0.
    fn moment(&self, &[fx, fy, fz, nx, ny, nz]: &[T; BASE]) -> Vector3<T> {
        Vector3::new(nx, ny, nz) - self.0.cross(&Vector3::new(fx, fy, fz))
    }
}

impl<T: Scalar> Centre<T> {
    /// Returns the rate of the momentum about the centre of mass that a wrench about the origin of frame 0 causes.
    fn rate(&self, force: [T; 3], moment: [T; 3]) -> [T; BASE] {
        let ([fx, fy, fz], [nx, ny, nz]) = (force, moment);
        let about = self.moment(&[fx, fy, fz, nx, ny, nz]);
        [fx, fy, fz, about.x, about.y, about.z]
    }
}

/// Solves M x = b, factored from the last row to the first. `x` contains b before and the solution afterwards;
/// `inverse` is scratch memory for the reciprocals of D.
pub(crate) fn solve_from_the_ends<T: Scalar, R: AsRef<[T]> + AsMut<[T]>>(
    matrix: &mut [R],
    inverse: &mut [T],
    x: &mut [T],
) {
    matrix.reverse();
    for row in matrix.iter_mut() {
        row.as_mut().reverse();
    }
    x.reverse();
    factor(matrix, inverse);
    solve(matrix, inverse, x);
    x.reverse();
}

/// Returns the first six accelerations, those of the base.
pub(crate) fn of_base<T: Scalar>(x: &[T]) -> BaseAcceleration<T> {
    BaseAcceleration { linear: [x[0], x[1], x[2]], angular: [x[3], x[4], x[5]] }
}

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    /// Returns the mass matrix with six rows and columns of the base, then those of the coordinates.
    pub(crate) fn floating_mass_matrix<T: Scalar>(self, q: &[T], load: AtTip<'_, T>) -> Square<V, T> {
        let FloatingMass { base, rows, joints } = self.mechanism.floating_mass(self.of_joints(q).as_ref(), load);
        let (rows, joints) = (self.coordinates.rows(rows), self.coordinates.symmetric(joints));
        self.velocities.of(|row| {
            self.velocities.of(|column| match (row.checked_sub(BASE), column.checked_sub(BASE)) {
                (None, None) => base[row][column],
                (None, Some(joint)) => rows[row].as_ref()[joint],
                (Some(joint), None) => rows[column].as_ref()[joint],
                (Some(i), Some(j)) => joints.as_ref()[i].as_ref()[j],
            })
        })
    }

    /// Returns the wrench on the base, then the torques, of a motion without accelerations.
    pub(crate) fn floating_bias<T: Scalar>(self, motion: [&[T]; 2], omega: &[T; 3], load: AtTip<'_, T>) -> V::Of<T> {
        self.floating_torques(motion, &turning(omega), load)
    }

    /// Returns the wrench on the base, then the torques, that hold the robot at rest.
    pub(crate) fn floating_gravity<T: Scalar>(self, q: &[T], base_rotation: &[[T; 3]; 3]) -> V::Of<T> {
        let gravity = matrix(base_rotation).transpose() * Vector3::from(self.fixed_base().gravity);
        self.floating_torques([q, self.zeros().as_ref()], &BaseMotion::fixed(gravity.into()), AtTip::Nothing)
    }

    /// Returns the wrench on a base that moves, then the torques, when the joints do not accelerate.
    fn floating_torques<T: Scalar>(self, [q, qd]: [&[T]; 2], base: &BaseMotion<T>, load: AtTip<'_, T>) -> V::Of<T> {
        let zeros = self.zeros();
        let (Wrench { force, moment }, tau) = self.torques_and_wrench([q, qd, zeros.as_ref()], base, load);
        self.velocities.of(|row| match row {
            0..3 => force[row],
            3..BASE => moment[row - 3],
            _ => tau.as_ref()[row - BASE],
        })
    }

    /// Returns the acceleration of the base less gravity, then those of the coordinates, in one list.
    pub(crate) fn floating_accelerations<T: Scalar>(
        self,
        [q, qd, tau]: [&[T]; 3],
        omega: &[T; 3],
        load: AtTip<'_, T>,
    ) -> V::Of<T> {
        let bias = self.floating_bias([q, qd], omega, load);
        let applied = |row: usize| row.checked_sub(BASE).map_or_else(T::zero, |joint| tau[joint]);
        let mut x = self.velocities.of(|row| applied(row) - bias.as_ref()[row]);
        let mut inverse = self.velocities.all(&T::zero());
        solve_from_the_ends(self.floating_mass_matrix(q, load).as_mut(), inverse.as_mut(), x.as_mut());
        x
    }

    /// Returns the acceleration of the base less gravity, and those of the coordinates.
    pub(crate) fn floating_forward_dynamics<T: Scalar>(
        self,
        arguments: [&[T]; 3],
        omega: &[T; 3],
        load: AtTip<'_, T>,
    ) -> (BaseAcceleration<T>, J::Of<T>) {
        self.of_velocities(self.floating_accelerations(arguments, omega, load).as_ref())
    }

    /// Splits a list into the acceleration of the base and those of the coordinates.
    pub(crate) fn of_velocities<T: Scalar>(self, x: &[T]) -> (BaseAcceleration<T>, J::Of<T>) {
        (of_base(x), self.coordinates.each().of(|joint| x[BASE + joint]))
    }

    pub(crate) fn centroidal_momentum_matrix<T: Scalar>(self, q: &[T]) -> [V::Of<T>; BASE] {
        let mass = self.mechanism.floating_mass(self.of_joints(q).as_ref(), AtTip::Nothing);
        let (centre, FloatingMass { mut base, rows, .. }) = (mass.centre(), mass);
        let mut rows = self.coordinates.rows(rows);
        centre.take_base(&mut base);
        centre.take(&mut rows);
        core::array::from_fn(|row| {
            self.velocities.of(|column| match column.checked_sub(BASE) {
                Some(joint) => rows[row].as_ref()[joint],
                None => base[row][column],
            })
        })
    }

    pub(crate) fn centroidal_bias<T: Scalar>(self, q: &[T], qd: &[T], omega: &[T; 3]) -> [T; BASE] {
        let zeros = self.zeros();
        let motion = [q, qd, zeros.as_ref()];
        let (Wrench { force, moment }, _) = self.torques_and_wrench(motion, &turning(omega), AtTip::Wrenches(&[]));
        self.mechanism.floating_mass(self.of_joints(q).as_ref(), AtTip::Nothing).centre().rate(force, moment)
    }
}
