//! From rows of the table to what the seven steps need of every link, in form P.
//!
//! Form P gives link i a frame fixed to it, with its z axis on joint i. In this frame `e_i` is (0, 0, 1), `r_i` and
//! `I_i` are constant, and `d_i` changes along z only, and only when joint i slides. Standard and modified tables
//! differ in the constants below and nowhere else:
//!
//! ```text
//!             R_i                     d_i                          I_i
//! standard    Rx(α_{i-1}) Rz(θ_i)     (a_i, 0, b_i) + Rx(α_i) c̄    Rx(α_i) Ī Rx(α_i)ᵀ       α_0 = 0
//! modified    Rx(α_{i-1}) Rz(θ_i)     (0, 0, b_i) + c̄              Ī
//! ```
//!
//! c̄ and Ī are the table's centre of mass and inertia; a first moment turns as c̄ does. Row i of a modified
//! table already carries α_{i-1} and a_{i-1}. The twist, and r, the lever from one link's centre of mass to the next
//! joint, belong to that joint: [`Mount`].

use nalgebra::{Matrix3, Vector3};
use rne_model::{Angle, Convention, FixedFrame, JointKind, Link, QuarterTurns, Row, Transform};

use crate::seven_steps::at_tip::Tip;
use crate::seven_steps::joint::JointLaws;
use crate::seven_steps::mount::Mount;
use crate::seven_steps::spin::Spins;
use crate::{Constant, Scalar};

/// The constants of link i and of its joint. `S` is the scalar of the table, or that of a computation after
/// [`LinkFrame::to`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LinkFrame<S> {
    pub(crate) kind: JointKind,
    /// The link that carries the joint; `None` for the base.
    pub(crate) parent: Option<usize>,
    /// Where the joint stands on that link.
    pub(crate) mount: Mount<S>,
    /// θ_i without the joint variable.
    theta: Angle<S>,
    /// (a_i, 0, b_i) without the joint variable (modified: a_i = 0).
    offset: Vector3<S>,
    /// From the origin that the offset leads to, to the centre of mass.
    com: Vector3<S>,
    /// J_i → C_i at joint variable 0.
    d: Vector3<S>,
    /// Inertia about C_i, kg m².
    pub(crate) inertia: Matrix3<S>,
    /// Mass, kg.
    pub(crate) mass: S,
    /// h, the first moment about C_i that no mass accounts for, kg m; `None` of every body.
    pub(crate) first_moment: Option<Vector3<S>>,
}

/// The rows of a robot, and where each begins, whatever owns them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Table<'a, S> {
    pub(crate) convention: Convention,
    pub(crate) rows: &'a [Row<S>],
    /// Where a row begins, if not at the link frame of the row before; shorter than `rows` where no other row does.
    pub(crate) branches: &'a [Option<FixedFrame<S>>],
    /// Link frame → tip frame.
    pub(crate) tool: &'a Transform<S>,
    /// The link that carries the tip, if not the last one.
    pub(crate) tip_on: Option<usize>,
    /// The link of frame 0, if the base floats.
    pub(crate) floating_base: Option<Link<S>>,
}

impl<'a, S: Constant> Table<'a, S> {
    /// Where a row begins, if not at the link frame of the row before.
    pub(crate) fn branch(self, joint: usize) -> Option<&'a FixedFrame<S>> {
        self.branches.get(joint)?.as_ref()
    }

    /// The link that carries a joint; `None` for the base.
    pub(crate) fn parent(self, joint: usize) -> Option<usize> {
        self.branch(joint).map_or(joint.checked_sub(1), |branch| branch.on)
    }

    /// Where a row begins in the link frame of its parent, if not there.
    pub(crate) fn placement(self, joint: usize) -> Option<&'a Transform<S>> {
        let placement = &self.branch(joint)?.placement;
        let is_zero = |angle: &Angle<S>| angle.right == Some(QuarterTurns::Zero);
        let is_nothing = placement.xyz == [S::zero(); 3] && placement.rpy.iter().all(is_zero);
        (!is_nothing).then_some(placement)
    }

    /// The tip frame on its link.
    pub(crate) fn tip(self) -> FixedFrame<S> {
        FixedFrame { on: self.tip_on.or(self.rows.len().checked_sub(1)), placement: *self.tool }
    }
}

/// The constants of the base, in frame 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaseLink<T> {
    /// Mass, kg.
    pub(crate) mass: T,
    /// From the origin of frame 0 to the centre of mass.
    pub(crate) com: Vector3<T>,
    /// Inertia about the centre of mass, kg m².
    pub(crate) inertia: Matrix3<T>,
}

impl<T: Scalar> BaseLink<T> {
    fn massless() -> Self {
        Self { mass: T::zero(), com: Vector3::zeros(), inertia: Matrix3::zeros() }
    }
}

/// All links of a robot, whatever owns them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chain<'a, S> {
    pub(crate) links: &'a [LinkFrame<S>],
    /// Where the tip frame stands on its link.
    pub(crate) tip: &'a Mount<S>,
    /// The link that carries the tip; `None` without links.
    pub(crate) tip_link: Option<usize>,
    /// The named tips.
    pub(crate) tips: &'a [Tip<S>],
    /// The rotors that turn on the links and on the base.
    pub(crate) spins: Spins<'a, S>,
    /// The link of frame 0, if the base floats.
    pub(crate) floating_base: Option<Link<S>>,
}

impl<S: Constant> LinkFrame<S> {
    /// The link of `table.rows[index]`.
    pub(crate) fn new(table: Table<'_, S>, index: usize) -> Self {
        let Table { convention, rows, .. } = table;
        let Row { kind, dh, link } = rows[index];
        let mount = Mount::of_joint(table, index);
        let com = turned_com(convention, &rows[index]);
        let written_inertia = Matrix3::from(link.inertia.rows()).transpose();
        let (offset, inertia) = match convention {
            Convention::Standard => {
                let rx = rotation_x(&dh.alpha);
                (Vector3::new(dh.a, S::zero(), dh.d), (rx * written_inertia) * rx.transpose())
            }
            Convention::Modified => (Vector3::new(S::zero(), S::zero(), dh.d), written_inertia),
        };
        let (parent, d) = (table.parent(index), offset + com);
        let has_moment = link.first_moment.iter().any(|h| *h != S::zero());
        let first_moment = has_moment.then(|| turned(convention, &rows[index], link.first_moment));
        Self { kind, parent, mount, theta: dh.theta, offset, com, d, inertia, mass: link.mass, first_moment }
    }

    /// Converts the constants to the scalar of a computation.
    #[inline]
    pub(crate) fn to<T: Scalar>(self) -> LinkFrame<T> {
        let Angle { radians, sin, cos, right } = self.theta;
        LinkFrame {
            kind: self.kind,
            parent: self.parent,
            mount: self.mount.to(),
            theta: Angle { radians: radians.to(), sin: sin.to(), cos: cos.to(), right },
            offset: self.offset.map(S::to),
            com: self.com.map(S::to),
            d: self.d.map(S::to),
            inertia: self.inertia.map(S::to),
            mass: self.mass.to(),
            first_moment: self.first_moment.map(|h| h.map(S::to)),
        }
    }
}

impl<T: Scalar> LinkFrame<T> {
    /// The base as a link that no joint moves.
    pub(crate) fn of_base(BaseLink { mass, com, inertia }: BaseLink<T>) -> Self {
        let (zero, here) = (Vector3::zeros(), Matrix3::identity());
        let (sin, cos) = (T::zero(), T::one());
        Self {
            kind: JointKind::Revolute,
            parent: None,
            mount: Mount { rotation: here, r: zero, lever: zero },
            theta: Angle { radians: sin, sin, cos, right: Some(QuarterTurns::Zero) },
            offset: zero,
            com,
            d: com,
            inertia,
            mass,
            first_moment: None,
        }
    }

    /// R_i = Rx(α_{i-1}) Rz(θ_i): turns components in the axes of link i into those of link i-1.
    #[inline]
    pub(crate) fn rotation(&self, q: T) -> Matrix3<T> {
        self.mount.rotation * rotation_z(self.sin_cos(q))
    }

    /// Computes the frame from the sine and cosine of q.
    #[inline]
    pub(crate) fn rotation_by(&self, turn: (T, T)) -> Matrix3<T> {
        let (s, c) = match (self.kind, self.theta.right) {
            (JointKind::Prismatic, _) => (self.theta.sin, self.theta.cos),
            // the addition theorem
            (JointKind::Revolute, None) => {
                let ((s, c), Angle { sin, cos, .. }) = (turn, self.theta);
                (s * cos + c * sin, c * cos - s * sin)
            }
            (JointKind::Revolute, Some(turns)) => by_quarters(turn, turns),
        };
        self.mount.rotation * rotation_z((s, c))
    }

    /// d_i = J_i → C_i, m; a prismatic joint moves it along its z axis.
    #[inline]
    pub(crate) fn d(&self, q: T) -> Vector3<T> {
        match self.kind {
            JointKind::Revolute => self.d,
            JointKind::Prismatic => self.kind.offset(self.offset, q) + self.com,
        }
    }

    /// From J_i to what is mounted on the link, m.
    #[inline]
    pub(crate) fn span(&self, q: T, to: &Mount<T>) -> Vector3<T> {
        self.kind.offset(self.offset + to.lever, q)
    }

    /// Sine and cosine of θ_i. A constant part that is a right angle is not added, its effect is exact: sin(q + 90°) is
    /// the cosine of q.
    #[inline]
    pub(crate) fn sin_cos(&self, q: T) -> (T, T) {
        match (self.kind, self.theta.right) {
            (JointKind::Prismatic, _) => (self.theta.sin, self.theta.cos),
            (JointKind::Revolute, None) => (self.theta.radians + q).sin_cos(),
            (JointKind::Revolute, Some(turns)) => by_quarters(q.sin_cos(), turns),
        }
    }
}

/// Sine and cosine of an angle increased by a number of right angles.
fn by_quarters<T: Scalar>((sin, cos): (T, T), turns: QuarterTurns) -> (T, T) {
    match turns {
        QuarterTurns::Zero => (sin, cos),
        QuarterTurns::One => (cos, -sin),
        QuarterTurns::Two => (-sin, -cos),
        QuarterTurns::Three => (-cos, sin),
    }
}

impl<'a, S: Constant> Chain<'a, S> {
    /// The links from base to tip, in the scalar of a computation.
    #[inline]
    pub(crate) fn links<T: Scalar>(self) -> impl ExactSizeIterator<Item = LinkFrame<T>> + DoubleEndedIterator + 'a {
        self.links.iter().map(|link| link.to())
    }

    /// The base as a link whose frame is frame 0: without mass where the world holds it.
    pub(crate) fn base<T: Scalar>(self) -> BaseLink<T> {
        let Some(Link { mass, com, inertia, .. }) = self.floating_base else { return BaseLink::massless() };
        let com = Vector3::from(com.map(S::to));
        BaseLink { mass: mass.to(), com, inertia: Matrix3::from(inertia.rows()).transpose().map(S::to) }
    }

    /// The mount of what a link carries: of its first joint, or of the tip where it carries no joint.
    pub(crate) fn mount_behind<T: Scalar>(self, link: usize) -> Mount<T> {
        self.links.iter().find(|other| other.parent == Some(link)).map_or(self.tip, |child| &child.mount).to()
    }

    /// The mount of what a link carries on the way to a frame on `end`: of the joint there; `None` on `end` itself.
    pub(crate) fn mount_towards<T: Scalar>(self, end: usize, link: usize) -> Option<Mount<T>> {
        let mut joint = (end != link).then_some(end)?;
        while self.links[joint].parent != Some(link) {
            joint = self.links[joint].parent?;
        }
        Some(self.links[joint].mount.to())
    }
}

/// The centre of mass of a row's link, from the end of its offset, in form P.
pub(crate) fn turned_com<S: Constant>(convention: Convention, row: &Row<S>) -> Vector3<S> {
    turned(convention, row, row.link.com)
}

/// Components in the link frame of a row, turned into the axes of form P.
fn turned<S: Constant>(convention: Convention, row: &Row<S>, components: [S; 3]) -> Vector3<S> {
    let vector = Vector3::from(components);
    match convention {
        Convention::Standard => rotation_x(&row.dh.alpha) * vector,
        Convention::Modified => vector,
    }
}

/// The rotation of a constant placement, Rz(yaw) Ry(pitch) Rx(roll).
pub(crate) fn rotation_of<S: Constant>(transform: &Transform<S>) -> Matrix3<S> {
    let [roll, pitch, yaw] = &transform.rpy;
    (rotation_z((yaw.sin, yaw.cos)) * rotation_y(pitch)) * rotation_x(roll)
}

pub(crate) fn rotation_x<S: Scalar>(angle: &Angle<S>) -> Matrix3<S> {
    let (zero, one, s, c) = (S::zero(), S::one(), angle.sin, angle.cos);
    #[rustfmt::skip]
    let rx = Matrix3::new(
        one,  zero, zero,
        zero, c,    -s,
        zero, s,    c,
    );
    rx
}

fn rotation_y<S: Scalar>(angle: &Angle<S>) -> Matrix3<S> {
    let (zero, one, s, c) = (S::zero(), S::one(), angle.sin, angle.cos);
    #[rustfmt::skip]
    let ry = Matrix3::new(
        c,    zero, s,
        zero, one,  zero,
        -s,   zero, c,
    );
    ry
}

/// Rz from the sine and cosine of its angle.
pub(crate) fn rotation_z<T: Scalar>((s, c): (T, T)) -> Matrix3<T> {
    let (zero, one) = (T::zero(), T::one());
    #[rustfmt::skip]
    let rz = Matrix3::new(
        c,    -s,   zero,
        s,    c,    zero,
        zero, zero, one,
    );
    rz
}
