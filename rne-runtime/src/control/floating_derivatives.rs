//! Derivatives of the torques of a robot with a floating base, and their conversion to the matrices of Pinocchio.

use crate::values::pose_log::cross;
use crate::{BaseMotion, FloatingTorqueDerivatives, Scalar};

/// Columns of the base: three linear ones, then three angular ones.
const BASE: usize = 6;

impl<const DOF: usize, const NV: usize, T: Scalar> FloatingTorqueDerivatives<DOF, NV, T> {
    /// Returns ∂τ/∂q and ∂τ/∂v of Pinocchio's `computeRNEADerivatives` with a free flyer, in this order. Rows are
    /// force, moment and torques. Columns are those of its tangent space: translation and rotation of the base, or its
    /// linear and angular velocity, in axes of the base, then the joints. Its ∂τ/∂a is the mass matrix.
    ///
    /// `base`: the motion at which the derivatives were taken, with `velocity` and `gravity` in axes of frame 0, as
    /// [`BaseMotion::from_pinocchio`] returns it. `mass`: the [mass matrix](crate::FloatingBase::floating_mass_matrix)
    /// M at the same q; its three columns L for the linear acceleration are used. In Pinocchio, the spatial
    /// acceleration a - ω × v and gravity in world axes are constant:
    ///
    /// ```text
    /// ∂τ/∂q:  0,  L (e × g) for e = x, y, z,  dq        ∂τ/∂v:  L (ω × e),  domega + L (e × v),  dqd
    /// ```
    #[must_use]
    pub fn to_pinocchio(&self, base: &BaseMotion<T>, mass: &[[T; NV]; NV]) -> [[[T; NV]; NV]; 2] {
        let units = Units::new(base);
        let element = |kind: usize, row: usize, column: usize| {
            let [dq, dqd] = [&self.dq[row], &self.dqd[row]];
            units.element(kind, column, (&mass[row], [dq, dqd], &self.domega[row]))
        };
        [0, 1].map(|kind| core::array::from_fn(|row| core::array::from_fn(|column| element(kind, row, column))))
    }
}

#[cfg(feature = "std")]
impl<T: Scalar> crate::DynFloatingTorqueDerivatives<T> {
    /// Converts as [`FloatingTorqueDerivatives::to_pinocchio`] does, with a mass matrix of 6 + n rows. Rows that `mass`
    /// lacks are left out.
    #[must_use]
    pub fn to_pinocchio(&self, base: &BaseMotion<T>, mass: &[Vec<T>]) -> [Vec<Vec<T>>; 2] {
        let units = Units::new(base);
        [0, 1].map(|kind| {
            let rows = self.dq.iter().zip(&self.dqd).zip(self.domega.iter().zip(mass));
            rows.map(|((dq, dqd), (domega, mass))| {
                let columns = 0..BASE + dq.len().min(dqd.len());
                columns.map(|column| units.element(kind, column, (mass, [dq, dqd], domega))).collect()
            })
            .collect()
        })
    }
}

/// Derivatives of a - g with respect to each linear and angular variable of the base.
struct Units<T> {
    /// With respect to its rotation, which only turns gravity: e × g.
    turned: [[T; 3]; 3],
    /// With respect to its linear and its angular velocity: ω × e, then e × v.
    moved: [[[T; 3]; 3]; 2],
}

impl<T: Scalar> Units<T> {
    fn new(base: &BaseMotion<T>) -> Self {
        let unit = |axis: usize| core::array::from_fn(|other| if other == axis { T::one() } else { T::zero() });
        let each = |change: &dyn Fn([T; 3]) -> [T; 3]| [0, 1, 2].map(|axis| change(unit(axis)));
        let linear = each(&|e| cross(&base.omega, &e));
        Self { turned: each(&|e| cross(&e, &base.gravity)), moved: [linear, each(&|e| cross(&e, &base.velocity))] }
    }

    /// Returns an element of ∂τ/∂q, or of ∂τ/∂v if `kind` is 1, from a row of each matrix.
    fn element(&self, kind: usize, column: usize, (mass, joints, domega): (&[T], [&[T]; 2], &[T; 3])) -> T {
        let by = |change: [T; 3]| mass.iter().zip(change).fold(T::zero(), |sum, (&element, x)| sum + element * x);
        match (kind, column) {
            (0, 0..3) => T::zero(),
            (0, 3..BASE) => by(self.turned[column - 3]),
            (_, 0..3) => by(self.moved[0][column]),
            (_, 3..BASE) => domega[column - 3] + by(self.moved[1][column - 3]),
            _ => joints[kind][column - BASE],
        }
    }
}
