//! Dynamics of a robot whose base nothing holds: torques and the wrench that must act on this base, the mass matrix of
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
use rne_model::FixedFrame;

use crate::at_tip::AtTip;
use crate::ldlt::{factor, solve};
use crate::link_state::{ForceMoment, JointMotions};
use crate::mechanism::Mechanism;
use crate::per_joint::{PerJoint, Square};
use crate::{Arm, BaseAcceleration, BaseMotion, Constant, FloatingAccelerations, FloatingTorques, Scalar, Wrench};
#[cfg(feature = "std")]
use crate::{DynArm, WrongLength};

/// Rows of the base: x, y, z, then about x, y, z.
pub(crate) const BASE: usize = 6;

/// The parts of the mass matrix on and above its diagonal.
struct FloatingMass<J: PerJoint, T: Scalar> {
    base: [[T; BASE]; BASE],
    /// Rows of the base, in the columns of the joints.
    rows: [J::Of<T>; BASE],
    joints: Square<J, T>,
}

/// The base turns with ω, and all its accelerations, gravity included, are zero.
pub(crate) fn turning<T: Scalar>(omega: &[T; 3]) -> BaseMotion<T> {
    BaseMotion { omega: *omega, ..BaseMotion::fixed([T::zero(); 3]) }
}

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    fn floating_mass<T: Scalar>(self, q: &[T]) -> FloatingMass<J, T> {
        let zeros = self.zeros();
        let mut rows: [J::Of<T>; BASE] = core::array::from_fn(|_| zeros.clone());
        let joints = self.mass_matrix_beside(q, AtTip::Nothing, |column, ForceMoment { force, moment }| {
            for (row, element) in rows.iter_mut().zip(force.iter().chain(moment.iter())) {
                row.as_mut()[column] = *element;
            }
        });
        let still = JointMotions::new(q, zeros.as_ref(), zeros.as_ref());
        let columns = [Vector3::x(), Vector3::y(), Vector3::z()].map(|unit: Vector3<T>| {
            let base = BaseMotion { omega_dot: unit.into(), ..BaseMotion::fixed([T::zero(); 3]) };
            self.of_floating_base(still, &base, AtTip::Nothing).0
        });
        let chain = self.chain;
        let mass = chain.links::<T>().fold(chain.base::<T>().mass, |mass, link| mass + link.mass);
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

/// The centre of mass: h / m.
struct Centre<T: Scalar>(Vector3<T>);

impl<J: PerJoint, T: Scalar> FloatingMass<J, T> {
    fn centre(&self) -> Centre<T> {
        let [[mass, _, _, _, z, minus_y], [_, _, _, _, _, x], ..] = self.base;
        Centre(Vector3::new(x, -minus_y, z) * (T::one() / mass))
    }
}

impl<T: Scalar> Centre<T> {
    /// Makes rows of the momentum about the centre of mass from columns of wrenches that are about the origin of frame
    /// 0.
    fn take<R: AsRef<[T]> + AsMut<[T]>>(&self, rows: &mut [R; BASE]) {
        for column in 0..rows[0].as_ref().len() {
            let moment = self.moment(&core::array::from_fn(|row| rows[row].as_ref()[column]));
            for (row, about) in rows[3..].iter_mut().zip(&moment) {
                row.as_mut()[column] = *about;
            }
        }
    }

    /// As [`take`](Self::take), of the base: while it does not turn, there is no angular momentum about the centre.
    fn take_base(&self, rows: &mut [[T; BASE]; BASE]) {
        self.take(rows);
        rows[3..].iter_mut().for_each(|row| row[..3].fill(T::zero()));
    }

    /// The moment about the centre of mass of a wrench that is about the origin of frame 0.
    fn moment(&self, &[fx, fy, fz, nx, ny, nz]: &[T; BASE]) -> Vector3<T> {
        Vector3::new(nx, ny, nz) - self.0.cross(&Vector3::new(fx, fy, fz))
    }
}

impl<T: Scalar> Centre<T> {
    /// The rate of the momentum that a wrench is, which is about the origin of frame 0.
    fn rate(&self, force: [T; 3], moment: [T; 3]) -> [T; BASE] {
        let ([fx, fy, fz], [nx, ny, nz]) = (force, moment);
        let about = self.moment(&[fx, fy, fz, nx, ny, nz]);
        [fx, fy, fz, about.x, about.y, about.z]
    }
}

/// Puts a matrix together, row by row into zeros.
fn fill<T: Scalar, R: AsMut<[T]>, V: AsRef<[T]>>(
    matrix: &mut [R],
    base: &[[T; BASE]; BASE],
    rows: &[V; BASE],
    joints: &[V],
) {
    for (row, (base, of_joints)) in base.iter().zip(rows).enumerate() {
        matrix[row].as_mut()[..BASE].copy_from_slice(base);
        matrix[row].as_mut()[BASE..].copy_from_slice(of_joints.as_ref());
        for (column, &element) in of_joints.as_ref().iter().enumerate() {
            matrix[BASE + column].as_mut()[row] = element;
        }
    }
    for (row, of_joints) in joints.iter().enumerate() {
        matrix[BASE + row].as_mut()[BASE..].copy_from_slice(of_joints.as_ref());
    }
}

/// Makes the solution x of M x = b from b; `inverse` is a place for the reciprocals of D.
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

/// The first six accelerations.
pub(crate) fn of_base<T: Scalar>(x: &[T]) -> BaseAcceleration<T> {
    BaseAcceleration { linear: [x[0], x[1], x[2]], angular: [x[3], x[4], x[5]] }
}

/// An arm that does not know its tips takes them with the wrenches.
impl<const DOF: usize, S: Constant> Arm<DOF, S> {
    /// As [`FloatingBase::inverse_dynamics_of_floating_base`](crate::FloatingBase::inverse_dynamics_of_floating_base),
    /// at these tips. A tip on the base, or on a link that there is not, carries no load.
    #[must_use]
    pub fn inverse_dynamics_of_floating_base<T: Scalar, const TIPS: usize>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
        (tips, wrenches): (&[FixedFrame<S>; TIPS], &[Wrench<T>; TIPS]),
    ) -> FloatingTorques<DOF, T> {
        let (joints, at_tips) = (JointMotions::new(q, qd, qdd), self.at_tips(tips, wrenches));
        let (wrench, tau) = self.mechanism().of_floating_base(joints, base, AtTip::Wrenches(&at_tips));
        FloatingTorques { wrench: Wrench::from_vectors(wrench.force, wrench.moment), tau }
    }

    /// As [`FloatingBase::floating_mass_matrix`](crate::FloatingBase::floating_mass_matrix); `NV` is `DOF` + 6.
    #[must_use]
    pub fn floating_mass_matrix<T: Scalar, const NV: usize>(&self, q: &[T; DOF]) -> [[T; NV]; NV] {
        const { assert!(NV == DOF + BASE, "the matrix has a row for each joint and six for the base") };
        let FloatingMass { base, rows, joints } = self.mechanism().floating_mass(q);
        let mut matrix = [[T::zero(); NV]; NV];
        fill(&mut matrix, &base, &rows, &joints);
        matrix
    }

    /// As [`FloatingBase::floating_bias`](crate::FloatingBase::floating_bias), at these tips; `NV` is `DOF` + 6.
    #[must_use]
    pub fn floating_bias<T: Scalar, const NV: usize, const TIPS: usize>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        omega: &[T; 3],
        at_tips: (&[FixedFrame<S>; TIPS], &[Wrench<T>; TIPS]),
    ) -> [T; NV] {
        const { assert!(NV == DOF + BASE, "the vector has an element for each joint and six for the base") };
        let zeros = [T::zero(); DOF];
        let FloatingTorques { wrench: Wrench { force, moment }, tau } =
            self.inverse_dynamics_of_floating_base(q, qd, &zeros, &turning(omega), at_tips);
        let mut numbers = force.into_iter().chain(moment).chain(tau);
        [(); NV].map(|()| numbers.next().unwrap_or_else(T::zero))
    }

    /// As [`CentroidalMomentum::centroidal_momentum_matrix`](crate::CentroidalMomentum::centroidal_momentum_matrix);
    /// `NV` is `DOF` + 6.
    #[must_use]
    pub fn centroidal_momentum_matrix<T: Scalar, const NV: usize>(&self, q: &[T; DOF]) -> [[T; NV]; 6] {
        const { assert!(NV == DOF + BASE, "the matrix has a column for each joint and six for the base") };
        let mass = self.mechanism().floating_mass(q);
        let (centre, FloatingMass { mut base, mut rows, .. }) = (mass.centre(), mass);
        centre.take_base(&mut base);
        centre.take(&mut rows);
        let element = |row: usize, column: usize| match column.checked_sub(BASE) {
            Some(joint) => rows[row].as_ref()[joint],
            None => base[row][column],
        };
        core::array::from_fn(|row| core::array::from_fn(|column| element(row, column)))
    }

    /// As [`CentroidalMomentum::centroidal_bias`](crate::CentroidalMomentum::centroidal_bias).
    #[must_use]
    pub fn centroidal_bias<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], omega: &[T; 3]) -> [T; 6] {
        let FloatingTorques { wrench: Wrench { force, moment }, .. } =
            self.inverse_dynamics_of_floating_base(q, qd, &[T::zero(); DOF], &turning(omega), (&[], &[]));
        self.mechanism().floating_mass(q).centre().rate(force, moment)
    }

    /// As [`FloatingBase::floating_forward_dynamics`](crate::FloatingBase::floating_forward_dynamics), at these tips;
    /// `NV` is `DOF` + 6.
    #[must_use]
    pub fn floating_forward_dynamics<T: Scalar, const NV: usize, const TIPS: usize>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        omega: &[T; 3],
        at_tips: (&[FixedFrame<S>; TIPS], &[Wrench<T>; TIPS]),
    ) -> FloatingAccelerations<DOF, T> {
        let bias = self.floating_bias::<T, NV, TIPS>(q, qd, omega, at_tips);
        let applied = |row: usize| if row < BASE { T::zero() } else { tau[row - BASE] };
        let mut x: [T; NV] = core::array::from_fn(|row| applied(row) - bias[row]);
        let mut matrix = self.floating_mass_matrix::<T, NV>(q);
        solve_from_the_ends(&mut matrix, &mut [T::zero(); NV], &mut x);
        FloatingAccelerations { base: of_base(&x), qdd: core::array::from_fn(|joint| x[BASE + joint]) }
    }
}

#[cfg(feature = "std")]
impl<S: Constant> DynArm<S> {
    /// As [`FloatingBase::inverse_dynamics_of_floating_base`](crate::FloatingBase::inverse_dynamics_of_floating_base),
    /// with one of `wrenches` for each of the [tips](Self::tips): the wrench on the base, and the torques.
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint, or `wrenches` not one element per tip.
    pub fn inverse_dynamics_of_floating_base<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        base: &BaseMotion<T>,
        wrenches: &[Wrench<T>],
    ) -> Result<(Wrench<T>, Vec<T>), WrongLength> {
        let (q, qd, qdd) = self.of_all_joints(q, qd, qdd)?;
        let (joints, at_tips) = (JointMotions::new(&q, &qd, &qdd), self.at_tips(wrenches)?);
        let (wrench, of_joints) = self.mechanism().of_floating_base(joints, base, AtTip::Wrenches(&at_tips));
        Ok((Wrench::from_vectors(wrench.force, wrench.moment), self.couplings.torques(of_joints)))
    }

    /// As [`FloatingBase::floating_mass_matrix`](crate::FloatingBase::floating_mass_matrix): 6 + n rows.
    ///
    /// # Errors
    /// When the argument does not have one element per joint.
    pub fn floating_mass_matrix<T: Scalar>(&self, q: &[T]) -> Result<Vec<Vec<T>>, WrongLength> {
        let q = &*self.of_joints("q", q)?;
        let FloatingMass { base, rows, joints } = self.mechanism().floating_mass(q);
        let (rows, joints) = (self.couplings.rows(rows), self.couplings.symmetric(joints));
        let size = BASE + self.dof();
        let mut matrix = vec![vec![T::zero(); size]; size];
        fill(&mut matrix, &base, &rows, &joints);
        Ok(matrix)
    }

    /// As [`FloatingBase::floating_bias`](crate::FloatingBase::floating_bias), with one of `wrenches` for each of the
    /// [tips](Self::tips): 6 + n numbers.
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint, or `wrenches` not one element per tip.
    pub fn floating_bias<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        omega: &[T; 3],
        wrenches: &[Wrench<T>],
    ) -> Result<Vec<T>, WrongLength> {
        let zeros = vec![T::zero(); self.dof()];
        let (Wrench { force, moment }, tau) =
            self.inverse_dynamics_of_floating_base(q, qd, &zeros, &turning(omega), wrenches)?;
        Ok(force.into_iter().chain(moment).chain(tau).collect())
    }

    /// As [`CentroidalMomentum::centroidal_momentum_matrix`](crate::CentroidalMomentum::centroidal_momentum_matrix):
    /// six rows of 6 + n numbers.
    ///
    /// # Errors
    /// When the argument does not have one element per joint.
    pub fn centroidal_momentum_matrix<T: Scalar>(&self, q: &[T]) -> Result<Vec<Vec<T>>, WrongLength> {
        let q = &*self.of_joints("q", q)?;
        let mass = self.mechanism().floating_mass(q);
        let (centre, FloatingMass { mut base, rows, .. }) = (mass.centre(), mass);
        let mut rows = self.couplings.rows(rows);
        centre.take_base(&mut base);
        centre.take(&mut rows);
        Ok(base.iter().zip(rows).map(|(base, joints)| [base.as_slice(), joints.as_ref()].concat()).collect())
    }

    /// As [`CentroidalMomentum::centroidal_bias`](crate::CentroidalMomentum::centroidal_bias).
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint.
    pub fn centroidal_bias<T: Scalar>(&self, q: &[T], qd: &[T], omega: &[T; 3]) -> Result<[T; 6], WrongLength> {
        let (zeros, free) = (vec![T::zero(); self.dof()], vec![Wrench::zero(); self.tips().len()]);
        let (Wrench { force, moment }, _) =
            self.inverse_dynamics_of_floating_base(q, qd, &zeros, &turning(omega), &free)?;
        let q = &*self.of_joints("q", q)?;
        Ok(self.mechanism().floating_mass(q).centre().rate(force, moment))
    }

    /// As [`FloatingBase::floating_forward_dynamics`](crate::FloatingBase::floating_forward_dynamics), with one of
    /// `wrenches` for each of the [tips](Self::tips): the acceleration of the base, and those of the joints.
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint, or `wrenches` not one element per tip.
    pub fn floating_forward_dynamics<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        omega: &[T; 3],
        wrenches: &[Wrench<T>],
    ) -> Result<(BaseAcceleration<T>, Vec<T>), WrongLength> {
        self.has_length("tau", tau)?;
        let bias = self.floating_bias(q, qd, omega, wrenches)?;
        let applied = [T::zero(); BASE].into_iter().chain(tau.iter().copied());
        let mut x: Vec<T> = applied.zip(bias).map(|(applied, bias)| applied - bias).collect();
        let mut matrix = self.floating_mass_matrix(q)?;
        solve_from_the_ends(&mut matrix, &mut vec![T::zero(); x.len()], &mut x);
        Ok((of_base(&x), x.split_off(BASE)))
    }
}
