//! Makes the robot from the identified parameters.

use nalgebra::Matrix4;
use rne_model::{Bodies, FrictionTransition, Inertia, InertiaReference, Joint, Link, Motor, PER_LINK, Robot};

use super::Fit;
use crate::fit::pseudo_inertia;
use crate::fit::structure::Structure;

/// Significant digits of the numbers in the robot.
const DIGITS: i32 = 8;

/// Returns the first joint that has a number that is not finite.
pub(super) fn not_finite(robot: &Robot) -> Option<usize> {
    let is_finite = |joint: &Joint| {
        let Link { mass, com, inertia, .. } = joint.row.link;
        let Inertia { xx, yy, zz, xy, xz, yz } = inertia;
        let of_motor =
            joint.motor.map_or([0.0; 4], |Motor { inertia, viscous, coulomb: [forward, backward], .. }| {
                [inertia, viscous, forward, backward]
            });
        [mass, xx, yy, zz, xy, xz, yz].iter().chain(&com).chain(&of_motor).all(|x| x.is_finite())
    };
    robot.joints.iter().position(|joint| !is_finite(joint))
}

/// Returns the robot with the fitted links and motors. Its friction is the identified one, that of the file where the
/// logs do not determine it, and none if friction was not asked for.
pub(super) fn robot_of(structure: &Structure, one: &Fit) -> Robot {
    let Fit { least_squares, feasible, .. } = one;
    let mut robot = structure.robot.clone();
    // the identified links include the payload and other bodies of the file
    robot.bodies = Bodies::default();
    let mut coordinate = 0;
    for (joint, of_link) in robot.joints.iter_mut().zip(&feasible.links) {
        joint.row.link = link(of_link);
        joint.written_inertia = (joint.row.link.inertia, InertiaReference::Com);
        // a dependent joint has no motor
        if joint.coupling.is_some() {
            continue;
        }
        let at = coordinate;
        coordinate += 1;
        let before = joint.motor.unwrap_or(Motor { inertia: 0.0, gear_ratio: 1.0, viscous: 0.0, coulomb: [0.0; 2] });
        let ratio = before.gear_ratio.abs();
        let mut motor = before;
        if structure.options.rotors {
            motor.inertia = rounded(feasible.rotors[at] / (ratio * ratio));
        }
        if !structure.options.friction {
            (motor.viscous, motor.coulomb) = (0.0, [0.0; 2]);
            (joint.coulomb_width, joint.coulomb_displacement) = (None, None);
        } else if one.is_friction_excited(at) {
            let [viscous, forward, backward] = feasible.friction[at];
            motor.viscous = rounded(viscous / (ratio * ratio));
            motor.coulomb = [rounded(forward / ratio), -rounded(backward / ratio)];
            (joint.coulomb_width, joint.coulomb_displacement) =
                match structure.transitions[least_squares.transitions[at]] {
                    FrictionTransition::Speed(width) => (Some(width), None),
                    FrictionTransition::Displacement(length) => (None, Some(length)),
                };
        }
        let is_nothing = motor.inertia == 0.0 && motor.viscous == 0.0 && motor.coulomb == [0.0; 2];
        // the gear ratio of the file is kept even without friction and rotor
        if joint.motor.is_some_and(|motor| motor.gear_ratio != 1.0) || !is_nothing {
            joint.motor = Some(motor);
        } else {
            joint.motor = None;
        }
    }
    robot
}

/// Converts a pseudo-inertia to a link: mass, centre of mass, and inertia about the centre of mass.
pub(crate) fn link(pseudo: &Matrix4<f64>) -> Link {
    let [mass, hx, hy, hz, ..]: [f64; PER_LINK] = pseudo_inertia::parameters(pseudo);
    let com = [hx / mass, hy / mass, hz / mass];
    let second = pseudo.fixed_view::<3, 3>(0, 0);
    let centred = |row: usize, column: usize| second[(row, column)] - mass * com[row] * com[column];
    let trace = centred(0, 0) + centred(1, 1) + centred(2, 2);
    Link {
        mass: rounded(mass),
        com: com.map(rounded),
        inertia: Inertia {
            xx: rounded(trace - centred(0, 0)),
            yy: rounded(trace - centred(1, 1)),
            zz: rounded(trace - centred(2, 2)),
            xy: rounded(-centred(0, 1)),
            xz: rounded(-centred(0, 2)),
            yz: rounded(-centred(1, 2)),
        },
        first_moment: [0.0; 3],
    }
}

/// Rounds a number to the digits that a robot file gets.
fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", usize::try_from(DIGITS - 1).unwrap_or_default()).parse().unwrap_or(value)
}
