//! Rotors of the list `motors` (the reduced form, section 16).
//!
//! A rotor of spin s = Σ n q̇ about the axis a on link c has the energy ½ Jm s² + Jm s a · ω_c. The first term only
//! adds constants to M. The second one is a product of s and the spin of the carrier about a. If the axes of the joints
//! with which the rotor turns are parallel to a, this product is a difference of squares of link spins, so it only
//! changes inertias of links about a and costs no operation. For all other joints with which the rotor turns, the
//! carrier is a gyrostat: it has the angular momentum Jm s a in addition.

use std::collections::BTreeMap;

use rne_model::JointKind::Revolute;
use rne_model::{Convention, Robot};

use crate::ir::{Embedding, Number, Symbol, Vector};
use crate::reduced::crba::Column;
use crate::reduced::link_parameters::{about_x, apply, sum};
use crate::reduced::{Arm, JointFrame, PseudoInertia, Triple, Wrench};

/// A rotor on a link, with those of its joints whose axes are not parallel to its own.
#[derive(Clone, Debug)]
pub(crate) struct Gyrostat {
    /// The rotor's axis a, in the axes of the link.
    pub(crate) axis: Triple,
    /// The joints with which the rotor turns, counted from 0, each with n Jm.
    pub(crate) turns: Vec<(usize, Number)>,
}

/// The elements (i, j), i ≤ j, of a symmetric matrix C that does not depend on the positions; its torques are C q̈.
type Elements = BTreeMap<(usize, usize), Number>;

/// The links whose joints turn about axes that are parallel to that of a rotor.
struct Parallel {
    /// The link nearest to the base; `None` for the base itself.
    root: Option<usize>,
    /// The axis of the rotor in the axes of the root.
    axis: Triple,
    /// For each joint that turns about a parallel axis: a · z; for other joints `None`.
    along: Vec<Option<Number>>,
}

impl Parallel {
    /// Finds the joints with axes parallel to a rotor's axis: those after the carrier, and those before it that turn
    /// the carrier about this axis.
    fn of(rows: &[JointFrame], on: Option<usize>, axis: Triple) -> Self {
        let (mut root, mut axis) = (on, axis);
        while let Some(row) = root.map(|link| &rows[link]).filter(|row| row.kind == Revolute) {
            let [x, y, z] = axis;
            if !(x.is_zero() && y.is_zero()) {
                break;
            }
            (root, axis) = (row.parent, row.along_axis(z));
        }
        let mut along: Vec<Option<Number>> = Vec::with_capacity(rows.len());
        for row in rows {
            let of_link = |z: Number| [Number::ZERO, Number::ZERO, z];
            let of_parent =
                if row.parent == root { Some(axis) } else { row.parent.and_then(|parent| along[parent]).map(of_link) };
            let direction = row.along_axis(Number::ONE);
            let is_parallel = |a: &Triple| cross(direction, *a).iter().all(|x| x.is_zero());
            let of_parent = of_parent.filter(|a| row.kind == Revolute && is_parallel(a));
            along.push(of_parent.map(|a| sum((0..3).map(|k| direction[k] * a[k]))));
        }
        Self { root, axis, along }
    }

    /// Returns the spin Σ x q̇ of a link about the axis relative to the root: the joints with their x.
    fn spin(&self, rows: &[JointFrame], link: Option<usize>) -> Vec<(usize, Number)> {
        let way = std::iter::successors(link.filter(|_| link != self.root), |&link| {
            rows[link].parent.filter(|_| rows[link].parent != self.root)
        });
        way.filter_map(|joint| Some((joint, self.along[joint]?))).collect()
    }

    /// Writes the spin Σ n q̇ of a rotor as Σ κ (spin of a link), and returns κ for each of these links.
    fn shares(&self, rows: &[JointFrame], turns: &[(usize, Number)]) -> Option<Vec<(usize, Number)>> {
        let mut shares: Elements = BTreeMap::new();
        for &(joint, n) in turns {
            let share = n * self.along[joint]?.inverse()?;
            add(&mut shares, [joint, joint], share);
            if let Some(parent) = rows[joint].parent.filter(|_| rows[joint].parent != self.root) {
                add(&mut shares, [parent, parent], -share);
            }
        }
        Some(shares.into_iter().map(|((link, _), share)| (link, share)).filter(|(_, share)| !share.is_zero()).collect())
    }
}

/// A floating base, which carries rotors as a link does.
#[derive(Clone, Debug)]
pub(crate) struct Carrier {
    pub(crate) matter: PseudoInertia,
    /// The rotors on the base that are not included in its inertial parameters.
    pub(crate) gyrostats: Vec<Gyrostat>,
}

/// Adds the rotors of a robot to its rows and to a floating base, if it has one, and their constants to `rotors`, the
/// diagonal of C. Returns the elements of C above the diagonal; `None` if a number has no inverse.
pub(crate) fn put_rotors(
    robot: &Robot,
    embedding: Embedding,
    (rows, mut base): (&mut [JointFrame], Option<&mut Carrier>),
    rotors: &mut [Number],
) -> Option<Vec<(usize, usize, Number)>> {
    let mut elements = Elements::new();
    let half = embedding.decimal(0.5);
    for (rotor, turns) in robot.spinning_rotors() {
        let inertia = embedding.decimal(rotor.inertia);
        let axis = rotor.axis.map(|x| embedding.decimal(x));
        let axis = match (robot.convention, rotor.on) {
            (Convention::Standard, Some(link)) => {
                apply(&about_x(embedding.turn(&robot.joints[link].row.dh.alpha)), axis)
            }
            _ => axis,
        };
        let turns: Vec<(usize, Number)> = turns.iter().map(|&(joint, n)| (joint, embedding.decimal(n))).collect();
        add_square(&mut elements, &turns, inertia);
        let parallel = Parallel::of(rows, rotor.on, axis);
        let (along, others): (Vec<_>, Vec<_>) = turns.iter().partition(|(joint, _)| parallel.along[*joint].is_some());
        for &(joint, n) in &along {
            for (other, x) in parallel.spin(rows, rotor.on) {
                let element = n * x * inertia;
                add(&mut elements, [joint, other], if joint == other { element + element } else { element });
            }
        }
        // a fixed base does not turn
        if parallel.root.is_some() || base.is_some() {
            for (link, share) in parallel.shares(rows, &along)? {
                let share = share * inertia;
                add_square(&mut elements, &parallel.spin(rows, Some(link)), -share);
                let of_link = [Number::ZERO, Number::ZERO, parallel.along[link]?];
                rows[link].matter = rows[link].matter + PseudoInertia::about(of_link, share, half);
                let root = match (parallel.root, &mut base) {
                    (Some(root), _) => Some(&mut rows[root].matter),
                    (None, base) => base.as_mut().map(|base| &mut base.matter),
                };
                if let Some(root) = root {
                    *root = *root + PseudoInertia::about(parallel.axis, -share, half);
                }
            }
        }
        let gyrostats = match (rotor.on, &mut base) {
            (Some(on), _) => Some(&mut rows[on].gyrostats),
            (None, base) => base.as_mut().map(|base| &mut base.gyrostats),
        };
        if let Some(gyrostats) = gyrostats.filter(|_| !others.is_empty()) {
            let turns = others.into_iter().map(|(joint, n)| (joint, n * inertia)).collect();
            gyrostats.push(Gyrostat { axis, turns });
        }
    }
    let mut above = Vec::new();
    for ((row, column), element) in elements.into_iter().filter(|(_, element)| !element.is_zero()) {
        if row != column {
            above.push((row, column, element));
        } else if rows[row].parent.is_none() && base.is_none() && rows[row].kind == Revolute {
            // such an element is added to the inertia of the first link about its joint, which has the same effect
            rows[row].matter =
                rows[row].matter + PseudoInertia::about([Number::ZERO, Number::ZERO, Number::ONE], element, half);
        } else {
            rotors[row] = rotors[row] + element;
        }
    }
    Some(above)
}

fn add(elements: &mut Elements, [row, column]: [usize; 2], element: Number) {
    let place = elements.entry((row.min(column), row.max(column))).or_insert(Number::ZERO);
    *place = *place + element;
}

/// Adds factor · x xᵀ to the elements.
fn add_square(elements: &mut Elements, x: &[(usize, Number)], factor: Number) {
    for (at, &(row, a)) in x.iter().enumerate() {
        for &(column, b) in &x[at..] {
            add(elements, [row, column], a * b * factor);
        }
    }
}

fn cross(a: Triple, b: Triple) -> Triple {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

impl Gyrostat {
    /// Returns Σ n Jm x, where x is the rate or the acceleration of each joint.
    pub(crate) fn of_joints<'s>(&self, arm: &Arm<'_, 's>, of_joint: impl Fn(usize) -> Symbol<'s>) -> Symbol<'s> {
        let terms = self.turns.iter().map(|&(joint, n)| of_joint(joint).signed(arm.rows()[joint].reversed).times(n));
        terms.reduce(|sum, term| sum + term).unwrap_or_else(|| arm.builder.zero())
    }

    /// Returns Jm ṡ a + ω × Jm s a: the moment that accelerates the carrier with its rotor.
    pub(crate) fn moment<'s>(&self, arm: &Arm<'_, 's>, omega: Vector<'s>) -> Vector<'s> {
        let axis = arm.builder.vector(self.axis);
        let (rate, rate_dot) = (|joint| arm.rate(joint), |joint| arm.rate_dot(joint));
        axis * self.of_joints(arm, rate_dot) + omega.cross(axis * self.of_joints(arm, rate))
    }

    /// Returns the columns of M for the joints with which the rotor turns: the moments on its carrier.
    pub(crate) fn columns<'s>(&self, arm: &Arm<'_, 's>) -> impl Iterator<Item = Column<'s>> {
        self.turns.iter().map(|&(joint, n)| {
            let n = if arm.rows()[joint].reversed { -n } else { n };
            let moment = arm.builder.vector(self.axis.map(|x| x * n));
            (joint, Wrench { force: arm.builder.no_vector(), moment })
        })
    }
}

/// Returns the part of the rotors in the torque of a joint, with the sign of its row: Σ n Jm a · y, with the angular
/// accelerations y of the carriers, which `of_link` returns (`None`: the floating base).
pub(crate) fn resistance<'s>(
    arm: &Arm<'_, 's>,
    joint: usize,
    of_link: impl Fn(Option<usize>) -> Vector<'s>,
) -> Option<Symbol<'s>> {
    let links = arm.rows().iter().enumerate().map(|(link, row)| (Some(link), &row.gyrostats));
    let base = arm.joint_frames.base.iter().map(|base| (None, &base.gyrostats));
    let all = base.chain(links).flat_map(|(link, gyrostats)| gyrostats.iter().map(move |it| (link, it)));
    let terms = all.filter_map(|(link, gyrostat)| {
        let (_, n) = *gyrostat.turns.iter().find(|(other, _)| *other == joint)?;
        let along = arm.builder.vector(gyrostat.axis.map(|x| x * n)).dot(of_link(link));
        Some(along.signed(arm.rows()[joint].reversed))
    });
    terms.reduce(|sum, term| sum + term)
}

/// Returns the terms of C q̈ in the torque of a joint that are due to other joints, with the sign of its row.
pub(crate) fn of_other_joints<'s>(arm: &Arm<'_, 's>, joint: usize) -> Option<Symbol<'s>> {
    let rows = arm.rows();
    let others = arm.joint_frames.coupled.iter().filter_map(|&(row, column, element)| match joint {
        _ if joint == row => Some((column, element)),
        _ if joint == column => Some((row, element)),
        _ => None,
    });
    let terms = others.map(|(other, element)| {
        arm.rate_dot(other).times(element).signed(rows[joint].reversed != rows[other].reversed)
    });
    terms.reduce(|sum, term| sum + term)
}
