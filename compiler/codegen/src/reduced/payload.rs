//! A payload on the link of the tip (the reduced form, section 13).
//!
//! ```text
//! r = R c + t        F = m (a + U r)        N = moment of (R I Rᵀ + J_n) + r × F
//! ```
//!
//! In algorithms with composite bodies, the payload is added to the moments of the last link: m, m r, and S = R (½
//! tr(I) 1 - I) Rᵀ + m r rᵀ.
//!
//! R and t are the pose of the tip in the frame of the last link. J_n is the inertia that the last link has after
//! regrouping.

use crate::formulate::Payload;
use crate::ir::{Builder, Matrix, Number, Vector};
use crate::reduced::{Arm, Composite, FirstMoment, Motion, Moved, PseudoInertia, SymbolicTurn, Wrench};

/// A payload, and the frame in which its wrench is computed.
#[derive(Clone, Copy)]
pub(crate) struct Load<'s> {
    pub(crate) payload: Payload<'s>,
    /// Whether this is frame N of the last joint, if that is revolute; otherwise it is the frame of the last link.
    pub(crate) unturned: bool,
}

impl<'s> Arm<'_, 's> {
    /// Returns the payload of the function on a link; `None` if the link does not carry the tip or the function takes
    /// no payload.
    pub(crate) fn payload_on(&self, index: usize) -> Option<Payload<'s>> {
        (index == self.joint_frames.tip().on).then(|| Payload::argument(self.builder, self.rows().len())).flatten()
    }

    /// Returns the payload for the Newton-Euler recursion, if the function takes one.
    pub(crate) fn load(&self, unturned: bool) -> Option<Load<'s>> {
        let payload = self.payload_on(self.joint_frames.tip().on)?;
        Some(Load { payload, unturned })
    }
}

impl<'s> Payload<'s> {
    /// Returns R, and r: the vector from the origin of the last frame to the payload's centre of mass, in the axes of
    /// that frame.
    fn on_link(&self, arm: &Arm<'_, 's>) -> (Matrix<'s>, Vector<'s>) {
        let builder = arm.builder;
        let tip = arm.joint_frames.tip();
        let rotation = Matrix(tip.rotation.map(|row| builder.vector(row)));
        let origin_shift = arm.parameters.origin_shifts[tip.on];
        let [x, y, z] = tip.translation;
        (rotation, rotation * self.com + builder.vector([x, y, z - origin_shift]))
    }

    /// Returns the payload's mass and first moment, in the axes of the last link and about the origin of its frame.
    pub(crate) fn first_moment(&self, arm: &Arm<'_, 's>) -> FirstMoment<'s> {
        let (_, r) = self.on_link(arm);
        FirstMoment { mass: self.mass, h: r * self.mass }
    }

    /// Returns the payload's mass, first moment and second moments, in the axes of the last link and about the origin
    /// of its frame.
    pub(crate) fn matter(&self, arm: &Arm<'_, 's>) -> Composite<'s> {
        let (rotation, r) = self.on_link(arm);
        let Matrix([Vector([xx, xy, xz]), Vector([_, yy, yz]), Vector([_, _, zz])]) =
            rotation * self.inertia * rotation.transpose();
        let half = Number::integer(2).inverse().unwrap_or_default();
        let trace = (xx + yy + zz).times(half);
        let h = r * self.mass;
        let ([x, y, z], [hx, hy, hz]) = (r.0, h.0);
        let s = [trace - xx + hx * x, trace - yy + hy * y, trace - zz + hz * z, hx * y - xy, hx * z - xz, hy * z - yz];
        // S11 + S22 is computed without the halves of the trace
        Composite { mass: self.mass, h, s, around: Some(zz + (hx * x + hy * y)) }
    }
}

impl<'s> Load<'s> {
    /// Returns the wrench of the payload together with the moment of the last link's second moments, about the origin
    /// of the last frame.
    pub(crate) fn with_link(
        &self,
        arm: &Arm<'_, 's>,
        link: &Moved<'s>,
        matter: &PseudoInertia,
        unturned: bool,
    ) -> Wrench<'s> {
        let builder = arm.builder;
        let Payload { mass, inertia, .. } = self.payload;
        let (rotation, r) = self.payload.on_link(arm);
        let inertia = rotation * inertia * rotation.transpose() + of_link(builder, matter);
        let (r, inertia, motion) = if unturned {
            (link.group_turn.about_z(r), turned(inertia, link.group_turn), &link.unturned)
        } else {
            (r, inertia, &link.own)
        };
        let on = arm.joint_frames.tip().on;
        let (lambda, mu) = (arm.parameters.lambda[on], arm.parameters.mu[on]);
        let per = |scale: Number| scale.inverse().unwrap_or(Number::ONE);
        let point = motion.acceleration + motion.gradient.of(r.times(lambda));
        let force = point * mass.times(mu * per(lambda));
        Wrench { force, moment: moment(inertia, motion) + r.times(per(mu)).cross(force) }
    }
}

/// Returns J = tr(S) 1 - S of the moments that the link has after regrouping.
fn of_link<'s>(builder: &'s Builder, matter: &PseudoInertia) -> Matrix<'s> {
    let s = matter.s;
    let trace = s[0][0] + s[1][1] + s[2][2];
    Matrix(
        [0, 1, 2].map(|row| builder.vector([0, 1, 2].map(|k| if row == k { trace - s[row][k] } else { -s[row][k] }))),
    )
}

/// Returns Rz J Rzᵀ.
fn turned<'s>(j: Matrix<'s>, turn: SymbolicTurn<'s>) -> Matrix<'s> {
    let SymbolicTurn { s, c } = turn;
    let [Vector([xx, xy, xz]), Vector([_, yy, yz]), Vector([_, _, zz])] = j.0;
    let half = c * xy;
    let column = c * (xx - yy) - s * xy;
    let u = c * column - s * half;
    let xy = s * column + c * half;
    let (xz, yz) = (c * xz - s * yz, s * xz + c * yz);
    Matrix::from_rows([[yy + u, xy, xz], [xy, xx - u, yz], [xz, yz, zz]])
}

/// Returns J ω̇ + ω × J ω, computed from the elements of U (the form `diagonal` of section 3.3).
fn moment<'s>(j: Matrix<'s>, motion: &Motion<'s>) -> Vector<'s> {
    let [Vector([xx, xy, xz]), Vector([_, yy, yz]), Vector([_, _, zz])] = j.0;
    let ([x, y, z], [dx, dy, dz]) = (motion.omega.0, motion.omega_dot.0);
    let u = &motion.gradient.u;
    let [of_yz, of_xz, of_xy] = motion.gradient.differences;
    Vector([
        dx * xx + y * z * (zz - yy) + u[1][0] * xz - u[2][0] * xy - of_yz * yz,
        dy * yy + x * z * (xx - zz) + u[2][1] * xy - u[0][1] * yz - of_xz * xz,
        dz * zz + x * y * (yy - xx) + u[0][2] * yz - u[1][2] * xz - of_xy * xy,
    ])
}
