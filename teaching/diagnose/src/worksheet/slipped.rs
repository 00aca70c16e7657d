//! Computes worksheets with one of the usual slips.

use nalgebra::{Matrix3, Vector3};
use rne_model::{JointKind, Robot};
use rne_runtime::{DynArm, LinkTrace, WrongLength};

use super::formulas::about_z;
use super::{Axes, Computed, Line, Quantity, Situation, Worksheet, followed, orientations, symmetric};
use crate::computation::{Computation, Moved};
use crate::lecture::{LinkVectors, Misprint, Placed};
use crate::slip::Slip;

/// A slip in words, the correct way, and the values of each line of the worksheet with the slip.
pub(super) struct Slipped {
    pub(super) says: String,
    pub(super) right: Option<String>,
    pub(super) values: Vec<Vec<f64>>,
}

/// Returns every slip that is possible in a situation: those of [`Slip::candidates`], and those that do not change
/// torques. Empty with a moving base or a payload.
pub(super) fn all(robot: &Robot, at: &Situation, sheet: &Worksheet) -> Result<Vec<Slipped>, WrongLength> {
    if at.base.is_some() || at.payload.is_some() {
        return Ok(Vec::new());
    }
    let unseen = [Misprint::E5NoDot, Misprint::E6FactorsSwapped].map(Slip::Misprint);
    let mut all = Vec::new();
    for slip in Slip::candidates(robot).into_iter().chain(unseen) {
        let Some(computation) = Computation::with(robot, &[slip]) else { continue };
        let values = values(&computation, robot, at, sheet)?;
        all.push(Slipped { says: slip.says(robot), right: Some(slip.right(robot)), values });
    }
    all.extend(of_positions(robot, at, sheet)?);
    all.extend(of_lines(robot, at, sheet)?);
    Ok(all)
}

/// Returns slips with a joint at a wrong position: the angle of a neighbouring joint, zero, or the other sign.
fn of_positions(robot: &Robot, at: &Situation, sheet: &Worksheet) -> Result<Vec<Slipped>, WrongLength> {
    let mut all = Vec::new();
    let revolute = |joint: usize| robot.joints.get(joint).filter(|joint| joint.row.kind == JointKind::Revolute);
    for (joint, q) in at.q.iter().enumerate() {
        let beside = [joint.wrapping_sub(1), joint + 1].into_iter().filter_map(|other| {
            let [constant, of_other] = [revolute(joint)?, revolute(other)?].map(|it| it.row.dh.theta.radians);
            Some((
                format!("the angle of joint {} is that of joint {}", joint + 1, other + 1),
                at.q[other] + of_other - constant,
            ))
        });
        let own = [(format!("q{} is left out", joint + 1), 0.0), (format!("q{} has the other sign", joint + 1), -q)];
        for (says, position) in beside.chain(own) {
            let mut moved = at.clone();
            moved.q[joint] = position;
            let lines = Worksheet::new(robot, &moved, sheet.axes)?.lines.into_iter().zip(&sheet.lines);
            let of_line = |(line, own): (Line, &Line)| {
                if line.quantity == Quantity::Q { own.values.clone() } else { line.values }
            };
            all.push(Slipped { says, right: None, values: lines.map(of_line).collect() });
        }
    }
    Ok(all)
}

/// Returns slips that use a wrong vector or matrix in every line.
fn of_lines(robot: &Robot, at: &Situation, sheet: &Worksheet) -> Result<Vec<Slipped>, WrongLength> {
    type Taken = fn(&Line, &mut [LinkTrace<f64>]);
    fn transposed(links: &mut [LinkTrace<f64>]) {
        for link in links {
            link.rotation = Matrix3::from(link.rotation).transpose().into();
        }
    }
    let slips: [(&str, Taken); 3] = [
        ("R is used in place of Rᵀ in steps 1 to 5", |line, links| {
            if !line.quantity.is_inward() {
                transposed(links);
            }
        }),
        ("R is used in place of Rᵀ, and Rᵀ in place of R", |_, links| transposed(links)),
        ("r of the link itself is used in place of r of the link before", |line, links| {
            if !line.quantity.is_inward() && line.joint > 1 {
                links[line.joint - 2].r = links[line.joint - 1].r;
            }
        }),
    ];
    let computed = Computed::new(robot, at, sheet.axes)?;
    let with = |(says, take): (&str, Taken)| {
        let mut links = computed.links.clone();
        let mut values = Vec::new();
        for line in &sheet.lines {
            let mut taken = links.clone();
            take(line, &mut taken);
            let own = computed.formulas(robot, at, &taken).by_formula(line.joint, line.quantity);
            let own = own.map_or_else(|| line.values.clone(), |own| own.values);
            own.iter()
                .enumerate()
                .for_each(|(at, value)| followed::set(&mut links[line.joint - 1], line.quantity, at, *value));
            values.push(own);
        }
        Slipped { says: says.to_owned(), right: None, values }
    };
    Ok(slips.map(with).into())
}

fn values(
    computation: &Computation,
    robot: &Robot,
    at: &Situation,
    sheet: &Worksheet,
) -> Result<Vec<Vec<f64>>, WrongLength> {
    let arm = DynArm::from_robot(&computation.robot);
    let moved = computation.moved(&arm, at.q.clone(), at.qd.clone(), at.qdd.clone(), at.wrench)?;
    let Moved { q, qd, qdd, wrench } = moved.clone();
    let slipped = Situation { q, qd, qdd, wrench, ..at.clone() };
    let own = Worksheet::new(&computation.robot, &slipped, sheet.axes)?;
    let mut values: Vec<Vec<f64>> = own.lines.iter().map(|line| line.values.clone()).collect();
    let mut tau = own.tau();
    if !computation.misprints.is_empty() {
        let (placed, found) = computation.lecture(&moved);
        let turns = from_the_lecture(robot, at, sheet.axes)?;
        for (line, values) in sheet.lines.iter().zip(&mut values) {
            if let Some(misprinted) = misprinted(line, computation, &placed, &found, &turns) {
                *values = misprinted;
            }
        }
        tau = computation.by_the_lecture(&moved);
    }
    let tau = computation.printed(&arm, tau, &moved)?;
    for (line, values) in sheet.lines.iter().zip(&mut values) {
        match line.quantity {
            // the lines of the given state do not change
            Quantity::Q | Quantity::Qd | Quantity::Qdd => values.clone_from(&line.values),
            Quantity::Tau => *values = vec![tau[line.joint - 1]],
            _ => {}
        }
    }
    Ok(values)
}

/// Returns for each joint the rotation from the lecture's axes to those of a worksheet.
fn from_the_lecture(robot: &Robot, at: &Situation, axes: Axes) -> Result<Vec<Matrix3<f64>>, WrongLength> {
    let arm = DynArm::from_robot(robot);
    let fixed = arm.trace(&at.q, &at.qd, &at.qdd, &arm.fixed_base(), None)?.links;
    let to_links = fixed.iter().map(|link| about_z(link.sin, link.cos).transpose());
    Ok(match axes {
        Axes::Joint => vec![Matrix3::identity(); fixed.len()],
        Axes::Link => to_links.collect(),
        Axes::Base => to_links.zip(orientations(&fixed)).map(|(to_link, to_base)| to_base * to_link).collect(),
    })
}

/// Returns the values of a line by the lecture's formulas with a misprint; `None` if they do not give the quantity.
fn misprinted(
    line: &Line,
    computation: &Computation,
    placed: &[Placed],
    found: &[LinkVectors],
    turns: &[Matrix3<f64>],
) -> Option<Vec<f64>> {
    let index = line.joint - 1;
    let (place, link, turn) = (placed.get(index)?, found.get(index)?, turns.get(index)?);
    let has = |misprint| computation.misprints.contains(&misprint);
    let handed = |value: Vector3<f64>, misprint| if has(misprint) { value } else { place.turn * value };
    let next = found.get(index + 1);
    let vector = match line.quantity {
        Quantity::D => place.d,
        Quantity::R => place.r,
        Quantity::Omega => link.omega,
        Quantity::OmegaDot => link.omega_dot,
        Quantity::Velocity => link.velocity,
        Quantity::Acceleration => link.acceleration,
        Quantity::Gravity => link.gravity,
        Quantity::InertiaForce => link.inertia_force,
        Quantity::InertiaMoment => link.inertia_moment,
        Quantity::NextForce => handed(next?.joint_force, Misprint::E10ForceNotTurned),
        Quantity::NextMoment => handed(next?.joint_moment, Misprint::E10MomentNotTurned),
        Quantity::JointForce => link.joint_force,
        Quantity::JointMoment => link.joint_moment,
        Quantity::Inertia => {
            return Some(symmetric(&(turn * place.inertia * turn.transpose())));
        }
        _ => return None,
    };
    Some((turn * vector).iter().copied().collect())
}
