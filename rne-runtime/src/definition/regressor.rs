//! The torques as a linear function of the inertial parameters, τ = Σ Y π.
//!
//! Link j has ten parameters in the axes of its link frame, π = (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz), J
//! being the tensor about the link frame's origin O_j. With a = Ö_j - g, force and moment about O_j that move the link
//! and carry its weight are linear in them:
//!
//! ```text
//! f = m a + ω̇ × m c + ω × (ω × m c)
//! n = m c × a + J ω̇ + ω × J ω
//! ```
//!
//! Each parameter set to one, the others to zero, gives a wrench; its way to the joints i ≤ j is that of step 6, and
//! the element along joint i is Y_{i,j}. The motion comes from the forward pass of the same table with every centre of
//! mass put at its link frame's origin: no inertial parameter of the robot enters Y.

use core::array;

use nalgebra::{Matrix3, Vector3};
use rne_model::{Convention, Link, PER_LINK, Row};

use crate::definition::Definition;
use crate::definition::coordinates::Coordinates as _;
use crate::definition::floating_base::BASE;
use crate::definition::per_joint::{PerJoint, Square};
use crate::seven_steps::joint::JointLaws;
use crate::seven_steps::link_frame::{Chain, LinkFrame, Table, rotation_x};
use crate::seven_steps::link_state::{ForceMoment, JointMotions, LinkMotion};
use crate::seven_steps::mechanism::Mechanism;
use crate::seven_steps::mount::Mount;
use crate::{ArmWithTips, BaseMotion, Constant, FloatingRegressor, Scalar};

/// Row and column of Jxx, Jxy, Jxz, Jyy, Jyz, Jzz.
const TENSOR: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// The numbers of a link in one row of Y.
pub(crate) type Elements<T> = [T; PER_LINK];

/// The rows of a floating base, force above moment: columns of the base's own parameters, and of the links.
pub(crate) struct OfBase<J: PerJoint, T: Scalar> {
    own: [Elements<T>; BASE],
    links: [J::Of<Elements<T>>; BASE],
}

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    pub(crate) fn regressor<T: Scalar>(
        self,
        joints: JointMotions<'_, T>,
        base: &BaseMotion<T>,
    ) -> (OfBase<J, T>, Square<J, Elements<T>>) {
        let rows = self.per_joint.of(|i| empty(&self.table.rows[i]));
        // relative to the origin of frame 0, and not to the centre of mass of the base
        let table = Table { rows: rows.as_ref(), floating_base: None, ..self.table };
        let links = self.per_joint.of(|i| LinkFrame::new(table, i));
        let chain = Chain { links: links.as_ref(), tip: &Mount::of_tip(table), floating_base: None, ..self.chain };
        let bare = Mechanism { chain, table, ..self };
        let motions = bare.motions(joints, base);
        let motions = motions.as_ref();

        let zeros = self.per_joint.all(&[T::zero(); PER_LINK]);
        let own = unit_wrenches(&LinkMotion::of_base(base, None), &Matrix3::identity());
        let own = array::from_fn(|row| own.map(|wrench| row_of(&wrench, row)));
        let mut of_base: OfBase<J, T> = OfBase { own, links: array::from_fn(|_| zeros.clone()) };
        let mut matrix = self.per_joint.all(&zeros);
        for (j, motion) in motions.iter().enumerate() {
            let mut wrenches = unit_wrenches(motion, &self.link_axes(j));
            // First the link itself: the lever from its link frame's origin to its joint.
            let mut lever = motion.d;
            let mut joint = Some(j);
            while let Some(i) = joint {
                for (parameter, wrench) in wrenches.iter_mut().enumerate() {
                    wrench.moment += lever.cross(&wrench.force);
                    matrix.as_mut()[i].as_mut()[j][parameter] = self.table.rows[i].kind.actuator(wrench);
                    // Now in the axes of the parent.
                    let rotation = motions[i].rotation;
                    *wrench = ForceMoment { force: rotation * wrench.force, moment: rotation * wrench.moment };
                }
                // The parent carries this wrench, too: the lever from there to the parent's joint.
                let link = &chain.links[i];
                joint = link.parent;
                lever = link.mount.r.map(S::to);
                if let Some(parent) = joint {
                    lever = motions[parent].d + lever;
                }
            }
            for (parameter, wrench) in wrenches.iter_mut().enumerate() {
                wrench.moment += lever.cross(&wrench.force);
                for row in 0..BASE {
                    of_base.links[row].as_mut()[j][parameter] = row_of(wrench, row);
                }
            }
        }
        (of_base, matrix)
    }

    /// Turns components in the axes of link frame `index` into those of form P.
    fn link_axes<T: Scalar>(self, index: usize) -> Matrix3<T> {
        match self.table.convention {
            Convention::Standard => rotation_x(&self.table.rows[index].dh.alpha).map(S::to),
            Convention::Modified => Matrix3::identity(),
        }
    }
}

/// Returns a component of a wrench: of the force for rows 0 to 2, of the moment for rows 3 to 5.
fn row_of<T: Scalar>(wrench: &ForceMoment<T>, row: usize) -> T {
    if row < 3 { wrench.force[row] } else { wrench.moment[row - 3] }
}

/// Returns the row of the table with a link without mass.
fn empty<S: Constant>(row: &Row<S>) -> Row<S> {
    let zero = S::zero();
    let inertia = rne_model::Inertia { xx: zero, yy: zero, zz: zero, xy: zero, xz: zero, yz: zero };
    Row { link: Link { mass: zero, com: [zero; 3], inertia, first_moment: [zero; 3] }, ..*row }
}

/// Returns force and moment for each parameter set to one, about the origin of the link frame, in the axes of form P.
fn unit_wrenches<T: Scalar>(motion: &LinkMotion<T>, axes: &Matrix3<T>) -> [ForceMoment<T>; PER_LINK] {
    let omega = axes.tr_mul(&motion.omega);
    let omega_dot = axes.tr_mul(&motion.omega_dot);
    let acceleration = axes.tr_mul(&(motion.acceleration - motion.gravity));
    let unit = |k: usize| Vector3::from_fn(|row, _| if row == k { T::one() } else { T::zero() });
    array::from_fn(|parameter| {
        let (force, moment) = match parameter {
            0 => (acceleration, Vector3::zeros()),
            1..=3 => {
                let com = unit(parameter - 1);
                (omega_dot.cross(&com) + omega.cross(&omega.cross(&com)), com.cross(&acceleration))
            }
            _ => {
                let (row, column) = TENSOR[parameter - 4];
                let mut tensor = Matrix3::zeros();
                tensor[(row, column)] = T::one();
                tensor[(column, row)] = T::one();
                (Vector3::zeros(), tensor * omega_dot + omega.cross(&(tensor * omega)))
            }
        };
        ForceMoment { force: axes * force, moment: axes * moment }
    })
}

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    /// Returns the rows of the base, and those of the coordinates.
    pub(crate) fn regressor<T: Scalar>(
        self,
        [q, qd, qdd]: [&[T]; 3],
        base: &BaseMotion<T>,
    ) -> (OfBase<J, T>, Square<J, Elements<T>>) {
        let [q, qd, qdd] = [q, qd, qdd].map(|values| self.of_joints(values));
        let joints = JointMotions::new(q.as_ref(), qd.as_ref(), qdd.as_ref());
        let (of_base, of_joints) = self.mechanism.regressor(joints, base);
        let gathered = self.coordinates.gathered(of_joints, |mut sum: J::Of<Elements<T>>, row, ratio| {
            for (a, b) in sum.as_mut().iter_mut().zip(row.as_ref()) {
                *a = array::from_fn(|i| a[i] + b[i] * ratio.to());
            }
            sum
        });
        (of_base, gathered)
    }
}

impl<const DOF: usize, const NV: usize, const BODIES: usize, const TIPS: usize, S: Constant>
    FloatingRegressor<DOF, NV, BODIES> for ArmWithTips<'_, DOF, NV, TIPS, S>
{
    fn floating_regressor<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
    ) -> [[Elements<T>; BODIES]; NV] {
        const { assert!(BODIES == DOF + 1, "the regressor has ten columns for the base and for each link") };
        let (of_base, of_joints) = self.definition().regressor([q, qd, qdd], base);
        array::from_fn(|row| array::from_fn(|body| element(&of_base, &of_joints, row, body)))
    }
}

/// Returns the elements for a row and a body; the base has the first rows and is the first body.
pub(crate) fn element<J: PerJoint, T: Scalar>(
    of_base: &OfBase<J, T>,
    of_joints: &Square<J, Elements<T>>,
    row: usize,
    body: usize,
) -> Elements<T> {
    match (row.checked_sub(BASE), body.checked_sub(1)) {
        (None, None) => of_base.own[row],
        (None, Some(link)) => of_base.links[row].as_ref()[link],
        // no joint moves the base, so its parameters affect no torque
        (Some(_), None) => [T::zero(); PER_LINK],
        (Some(joint), Some(link)) => of_joints.as_ref()[joint].as_ref()[link],
    }
}
