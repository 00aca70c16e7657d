//! The centre of mass of the whole arm and its Jacobian, from the mass fractions μ_i = m_i / Σ m of the links.
//!
//! ```text
//! c = Σ μ_i c_i                                     c_i from the base, in world axes; then from the world's origin
//! column j of J     z_j × Σ μ_i (c_i - p_j)         revolute: z_j × (s_j - w_j p_j); i: link j and all that it carries
//!                   z_j Σ μ_i                       prismatic: w_j z_j
//! s_j = Σ s_k + μ_j c_j,   w_j = Σ w_k + μ_j        from the ends to the base; k: joints that link j carries
//! ```
//!
//! A floating base is a link, too: link 0, whose frame is frame 0.
//!
//! If a link has a first moment h in addition to its mass, h_i (1 / Σ m) is added to c and to s_j.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::formulate::{Arm, Frames};
use crate::ir::{Builder, Cause, Name, Quantity, Symbol, Vector};

/// Returns the centre of mass in the world. The origins of `frames` are measured from the base, in world axes;
/// `centres` are the vectors from the joints to the centres of mass of their links.
pub(crate) fn position<'s>(arm: &Arm<'s>, frames: &Frames<'s>, centres: &[Vector<'s>]) -> Vector<'s> {
    let builder = arm.builder;
    let line = builder.joint(arm.links.len());
    let centre = match parts(arm) {
        Ok((parts, inverse)) => {
            let links = links(builder, frames, centres);
            let of_base = arm.floating_base.as_ref().map(|base| base.com * (base.mass * inverse));
            let sum = links.into_iter().zip(parts).enumerate().fold(
                of_base.unwrap_or_else(|| builder.zeros(Cause::Arithmetic)),
                |sum, (index, (centre, part))| {
                    let moment = || with_first_moment(arm, frames, index, centre * part, inverse);
                    builder.joint(index + 1).within(Quantity::ComPosition, || sum + moment())
                },
            );
            line.within(Quantity::ComPosition, || sum + arm.base.translation)
        }
        Err(infinite) => Vector([infinite; 3]),
    };
    builder.name_vector(Quantity::ComPosition, 0, centre)
}

/// Returns the columns of the Jacobian, base to tip; the arguments are those of [`position`].
pub(crate) fn jacobian<'s>(arm: &Arm<'s>, frames: &Frames<'s>, centres: &[Vector<'s>]) -> Vec<Vector<'s>> {
    let builder = arm.builder;
    let (parts, inverse) = match parts(arm) {
        Ok(found) => found,
        Err(infinite) => return vec![Vector([infinite; 3]); arm.links.len()],
    };
    let links = links(builder, frames, centres);
    // for each link: Σ μ_k c_k and Σ μ_k of the links after it
    let nothing = (builder.zeros(Cause::Arithmetic), builder.constant(0.0, Cause::Arithmetic));
    let mut carried = vec![None; links.len()];
    let mut columns = Vec::with_capacity(links.len());
    for (index, link) in arm.links.iter().enumerate().rev() {
        let (line, frame) = (builder.joint(index + 1), &frames.joints[index]);
        let axis = frame.axis();
        let column = line.within(Quantity::JacobianLinear, || {
            let (moment, part) = carried[index].unwrap_or(nothing);
            let moment = moment + with_first_moment(arm, frames, index, links[index] * parts[index], inverse);
            let part = part + parts[index];
            if let Some(parent) = link.parent {
                let with_others = |(others, parts)| (others + moment, parts + part);
                carried[parent] = Some(carried[parent].map_or((moment, part), with_others));
            }
            match link.kind {
                Revolute => axis.cross(moment - frame.origin * part),
                Prismatic => axis * part,
            }
        });
        columns.push(builder.name_vector(Quantity::JacobianLinear, index + 1, column));
    }
    columns.reverse();
    columns
}

/// Returns the centres of mass of the links as named quantities.
fn links<'s>(builder: &'s Builder, frames: &Frames<'s>, centres: &[Vector<'s>]) -> Vec<Vector<'s>> {
    let centres = frames.joints.iter().zip(centres).enumerate();
    centres
        .map(|(index, (frame, d))| {
            builder.joint(index + 1).define(Quantity::ComPosition).by(frame.rotation * *d + frame.origin)
        })
        .collect()
}

/// Returns μ_i c_i of a link, plus the term of its first moment h if the link has one in addition to its mass.
fn with_first_moment<'s>(
    arm: &Arm<'s>,
    frames: &Frames<'s>,
    index: usize,
    moment: Vector<'s>,
    inverse: Symbol<'s>,
) -> Vector<'s> {
    arm.links[index].body.first_moment.map_or(moment, |h| moment + (frames.joints[index].rotation * h) * inverse)
}

/// Returns the mass fraction of each link, and 1 / Σ m: constants, unless a mass is given at run time. If the arm has
/// no mass, returns the infinite 1 / 0 as the error, because products of it with zeros would be folded to zero.
fn parts<'s>(arm: &Arm<'s>) -> Result<(Vec<Symbol<'s>>, Symbol<'s>), Symbol<'s>> {
    let builder = arm.builder;
    let line = builder.joint(arm.links.len());
    line.within(Quantity::ComPosition, || {
        let nothing = builder.constant(0.0, Cause::Arithmetic);
        let of_base = arm.floating_base.as_ref().map_or(nothing, |base| base.mass);
        let total = arm.links.iter().fold(of_base, |total, link| total + link.body.mass);
        let one = builder.entry(Name::scalar(Quantity::One, 0), 1.0);
        let inverse = builder.quotient(one, total);
        if total.is_zero() {
            return Err(inverse);
        }
        Ok((arm.links.iter().map(|link| link.body.mass * inverse).collect(), inverse))
    })
}
