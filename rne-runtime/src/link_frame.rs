//! From rows of the table to what the seven steps need of every link, in form P.
//!
//! Form P gives link i a frame fixed to it, with its z axis on joint i. In this frame `e_i` is (0, 0, 1), `r_i` and `I_i`
//! are constant, and `d_i` changes along z only, and only when joint i slides. Standard and modified tables differ in the
//! constants below and nowhere else:
//!
//! ```text
//!             R_i                     d_i                          r_i                 I_i
//! standard    Rx(α_{i-1}) Rz(θ_i)     (a_i, 0, b_i) + Rx(α_i) c̄    -Rx(α_i) c̄          Rx(α_i) Ī Rx(α_i)ᵀ
//!             α_0 = 0, R_{n+1} = Rx(α_n)
//! modified    Rx(α_{i-1}) Rz(θ_i)     (0, 0, b_i) + c̄              (a_i, 0, 0) - c̄     Ī
//!             R_{n+1} = 1                                          r_n = -c̄
//! ```
//!
//! c̄ and Ī are the table's centre of mass and inertia. Row i of a modified table already carries α_{i-1} and a_{i-1}.

use nalgebra::{Matrix3, Vector3};
use rne_model::{Angle, Convention, JointKind, QuarterTurns, Row, Transform};

use crate::{Constant, Scalar};

/// The constants of link i and of its joint. `S` is the scalar of the table, or that of a computation after
/// [`LinkFrame::to`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LinkFrame<S> {
    pub(crate) kind: JointKind,
    /// Rx(α_{i-1}), the fixed part of R_i.
    pub(crate) twist: Matrix3<S>,
    /// θ_i without the joint variable.
    theta: Angle<S>,
    /// (a_i, 0, b_i) without the joint variable (modified: a_i = 0).
    offset: Vector3<S>,
    /// From the origin that the offset leads to, to the centre of mass.
    com: Vector3<S>,
    /// J_i → C_i at joint variable 0.
    d: Vector3<S>,
    /// C_i → J_{i+1}.
    pub(crate) r: Vector3<S>,
    /// From the end of the offset to J_{i+1}, or to the origin of the tip frame.
    lever: Vector3<S>,
    /// Inertia about C_i, kg m².
    pub(crate) inertia: Matrix3<S>,
    /// Mass, kg.
    pub(crate) mass: S,
}

/// Where the chain of links begins and ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ends<S> {
    /// r_0: from the origin of frame 0 to J_1.
    pub(crate) base_lever: Vector3<S>,
    /// R_{n+1}: from the tip frame's axes to those of link n.
    pub(crate) tip_rotation: Matrix3<S>,
}

/// All links of a robot, whatever owns them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chain<'a, S> {
    pub(crate) links: &'a [LinkFrame<S>],
    pub(crate) ends: &'a Ends<S>,
}

impl<S: Constant> LinkFrame<S> {
    /// The link of `rows[index]`. The tool belongs to the last one.
    pub(crate) fn new(convention: Convention, rows: &[Row<S>], tool: &Transform<S>, index: usize) -> Self {
        let Row { kind, dh, link } = rows[index];
        let is_last = index + 1 == rows.len();
        let zero = S::zero();
        let written_com = Vector3::from(link.com);
        let written_inertia = Matrix3::from(link.inertia.rows()).transpose();

        let (twist, offset, com, inertia, mut r, mut lever);
        match convention {
            Convention::Standard => {
                let rx = rotation_x(&dh.alpha);
                twist = previous_twist(rows, index);
                offset = Vector3::new(dh.a, zero, dh.d);
                com = rx * written_com;
                inertia = (rx * written_inertia) * rx.transpose();
                (r, lever) = (-com, Vector3::zeros());
                if is_last {
                    lever = rx * Vector3::from(tool.xyz);
                    r += lever;
                }
            }
            Convention::Modified => {
                twist = rotation_x(&dh.alpha);
                offset = Vector3::new(zero, zero, dh.d);
                com = written_com;
                inertia = written_inertia;
                (r, lever) = match rows.get(index + 1) {
                    Some(next) => {
                        let lever = Vector3::new(next.dh.a, zero, zero);
                        (lever - com, lever)
                    }
                    None => {
                        let lever = Vector3::from(tool.xyz);
                        (-com + lever, lever)
                    }
                };
            }
        }
        Self { kind, twist, theta: dh.theta, offset, com, d: offset + com, r, lever, inertia, mass: link.mass }
    }

    /// The same constants in the scalar of a computation.
    #[inline]
    pub(crate) fn to<T: Scalar>(self) -> LinkFrame<T> {
        let Angle { radians, sin, cos, right } = self.theta;
        LinkFrame {
            kind: self.kind,
            twist: self.twist.map(S::to),
            theta: Angle { radians: radians.to(), sin: sin.to(), cos: cos.to(), right },
            offset: self.offset.map(S::to),
            com: self.com.map(S::to),
            d: self.d.map(S::to),
            r: self.r.map(S::to),
            lever: self.lever.map(S::to),
            inertia: self.inertia.map(S::to),
            mass: self.mass.to(),
        }
    }
}

impl<T: Scalar> LinkFrame<T> {
    /// R_i = Rx(α_{i-1}) Rz(θ_i): turns components in the axes of link i into those of link i-1.
    #[inline]
    pub(crate) fn rotation(&self, q: T) -> Matrix3<T> {
        self.twist * rotation_z(self.sin_cos(q))
    }

    /// The same from the sine and cosine of q.
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
        self.twist * rotation_z((s, c))
    }

    /// d_i = J_i → C_i, m; a prismatic joint moves it along its z axis.
    #[inline]
    pub(crate) fn d(&self, q: T) -> Vector3<T> {
        match self.kind {
            JointKind::Revolute => self.d,
            JointKind::Prismatic => Vector3::new(self.offset.x, self.offset.y, self.offset.z + q) + self.com,
        }
    }

    /// J_i → J_{i+1}, or to the origin of the tip frame, m.
    #[inline]
    pub(crate) fn span(&self, q: T) -> Vector3<T> {
        let span = self.offset + self.lever;
        match self.kind {
            JointKind::Revolute => span,
            JointKind::Prismatic => Vector3::new(span.x, span.y, span.z + q),
        }
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

/// Sine and cosine of an angle that is so many right angles larger.
fn by_quarters<T: Scalar>((sin, cos): (T, T), turns: QuarterTurns) -> (T, T) {
    match turns {
        QuarterTurns::Zero => (sin, cos),
        QuarterTurns::One => (cos, -sin),
        QuarterTurns::Two => (-sin, -cos),
        QuarterTurns::Three => (-cos, sin),
    }
}

impl<S: Constant> Ends<S> {
    /// The ends of the chain of `rows`, with `tool` after the last of them.
    pub(crate) fn new(convention: Convention, rows: &[Row<S>], tool: &Transform<S>) -> Self {
        let zero = S::zero();
        let turned = rotation_of(tool);
        match convention {
            Convention::Standard => {
                Self { base_lever: Vector3::zeros(), tip_rotation: previous_twist(rows, rows.len()) * turned }
            }
            Convention::Modified => {
                let a_0 = rows.first().map_or(zero, |row| row.dh.a);
                Self { base_lever: Vector3::new(a_0, zero, zero), tip_rotation: turned }
            }
        }
    }
}

impl<'a, S: Constant> Chain<'a, S> {
    /// The links from base to tip, in the scalar of a computation.
    #[inline]
    pub(crate) fn links<T: Scalar>(self) -> impl ExactSizeIterator<Item = LinkFrame<T>> + DoubleEndedIterator + 'a {
        self.links.iter().map(|link| link.to())
    }
}

/// Rx(α) of the row before `rows[index]`; nothing precedes the first.
fn previous_twist<S: Constant>(rows: &[Row<S>], index: usize) -> Matrix3<S> {
    match index.checked_sub(1).and_then(|previous| rows.get(previous)) {
        Some(previous) => rotation_x(&previous.dh.alpha),
        None => Matrix3::identity(),
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
