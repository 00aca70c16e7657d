//! Prior knowledge: the links of the file, or plausible bodies where the file has none.

use nalgebra::{DVector, Matrix4, Rotation3, Vector3};
use rne_model::{Convention, FixedFrame, Joint, Robot, Row};

use crate::fit::parameters::{Parameters, moves};
use crate::fit::pseudo_inertia;
use crate::fit::structure::{FRICTION, Structure};
use rne_model::PER_LINK;

/// Mass of a link of which nothing is known, kg.
const MASS: f64 = 3.0;
/// Typical radius of a link, m.
const RADIUS: f64 = 0.06;
/// Standard deviation of the prior that keeps unknowns finite, in multiples of their scale.
const PRIOR_DEVIATIONS: f64 = 30.0;
/// Longest time by which torques may lag, s.
const DELAY: f64 = 0.05;

/// A link as it is assumed before any log.
#[derive(Clone, Debug)]
pub struct PriorLink {
    /// The pseudo-inertia, 4 × 4.
    pub pseudo_inertia: Matrix4<f64>,
    /// Whether the link is that of the file, not a guess.
    pub is_of_file: bool,
}

impl PriorLink {
    /// Returns magnitudes of the ten inertial parameters: products of the mass with powers of the radius of gyration.
    pub(crate) fn scales(&self) -> [f64; PER_LINK] {
        let (size, mass) = (size(&self.pseudo_inertia), self.pseudo_inertia[(3, 3)]);
        [0, 1, 1, 1, 2, 2, 2, 2, 2, 2].map(|power| mass * size.powi(power))
    }
}

/// Returns the links of a robot as they are assumed before any log. All are physically possible.
#[must_use]
pub fn links(robot: &Robot) -> Vec<PriorLink> {
    let values = rne_runtime::DynArm::from_robot(robot).inertial_parameters();
    let is_body = |joint: usize| {
        let link = &robot.joints[joint].row.link;
        link.mass > 0.0 && !link.has_first_moment()
    };
    (0..robot.joints.len())
        .map(|joint| {
            let written = pseudo_inertia::of(&values[joint]);
            let guess = plausible(robot, joint, if is_body(joint) { values[joint][0] } else { MASS });
            if !is_body(joint) {
                return PriorLink { pseudo_inertia: guess, is_of_file: false };
            }
            // a little of the plausible rod makes thin rods and point masses positive definite
            let thick = written + guess * 1e-2;
            let is_positive = pseudo_inertia::margin(&thick) > 0.0;
            let pseudo_inertia = if is_positive { thick } else { guess };
            PriorLink { pseudo_inertia, is_of_file: is_positive }
        })
        .collect()
}

/// Returns a round rod from the link's own joint to the next joint, or to the farthest of several next joints.
fn plausible(robot: &Robot, joint: usize, mass: f64) -> Matrix4<f64> {
    let along = span(robot, joint);
    let centre = along * 0.5;
    let length = along.norm();
    let mut second = nalgebra::Matrix3::identity() * (RADIUS * RADIUS * 0.5);
    if length > 0.0 {
        second += along * along.transpose() / 12.0;
    }
    second += centre * centre.transpose();
    let mut pseudo = Matrix4::zeros();
    pseudo.fixed_view_mut::<3, 3>(0, 0).copy_from(&(second * mass));
    pseudo.fixed_view_mut::<3, 1>(0, 3).copy_from(&(centre * mass));
    pseudo.fixed_view_mut::<1, 3>(3, 0).copy_from(&(centre.transpose() * mass));
    pseudo[(3, 3)] = mass;
    pseudo
}

/// Returns the vector from the origin of the link frame to the other end of the link, in axes of the link frame.
fn span(robot: &Robot, joint: usize) -> Vector3<f64> {
    match robot.convention {
        // frame i is at the distal end of the link, so the other end is the origin of the previous frame
        Convention::Standard => {
            let dh = &robot.joints[joint].row.dh;
            let (sin, cos) = (dh.alpha.sin, dh.alpha.cos);
            // the negative of Rx(-alpha) (a, 0, d)
            -Vector3::new(dh.a, sin * dh.d, cos * dh.d)
        }
        Convention::Modified => {
            let carried = (joint + 1..robot.joints.len()).filter(|next| robot.parent(*next) == Some(joint));
            let way = carried.map(|next| {
                let Joint { row: Row { dh, .. }, branch, .. } = &robot.joints[next];
                let way = Vector3::new(dh.a, -dh.alpha.sin * dh.d, dh.alpha.cos * dh.d);
                branch.map_or(way, |FixedFrame { placement, .. }| {
                    let [roll, pitch, yaw] = placement.rpy.map(|angle| angle.radians);
                    Vector3::from(placement.xyz) + Rotation3::from_euler_angles(roll, pitch, yaw) * way
                })
            });
            let farther = |a: &Vector3<f64>, b: &Vector3<f64>| a.norm().total_cmp(&b.norm());
            way.max_by(farther).unwrap_or_else(|| Vector3::new(0.0, 0.0, RADIUS))
        }
    }
}

/// Orders of magnitude of the unknowns.
#[derive(Clone, Debug)]
pub struct Scales {
    /// The magnitude of each base parameter for plausible links.
    pub bases: DVector<f64>,
    /// The magnitude of each joint's friction, N m or N.
    pub friction: Vec<f64>,
}

impl Scales {
    /// Returns the scales of a robot whose efforts have these root mean squares, N m or N.
    #[must_use]
    pub fn of(robot: &Robot, parameters: &Parameters, efforts: &[f64]) -> Self {
        let links = links(robot);
        let mut values = DVector::zeros(parameters.regrouping.ncols());
        for (link, prior) in links.iter().enumerate() {
            values.as_mut_slice()[link * PER_LINK..][..PER_LINK].copy_from_slice(&prior.scales());
        }
        if parameters.rotors {
            for joint in 0..robot.dof() {
                // a plausible rotor has as much inertia as the links that its joint moves
                let behind = (0..links.len()).filter(|link| moves(robot, joint, *link));
                let behind: f64 = behind.map(|link| values[link * PER_LINK + 9]).sum();
                values[links.len() * PER_LINK + joint] = behind;
            }
        }
        let squares = parameters.regrouping.map(|factor| factor * factor) * values.map(|value| value * value);
        Self { bases: squares.map(f64::sqrt), friction: efforts.iter().map(|effort| effort.max(1e-6)).collect() }
    }

    /// Returns for each unknown the reciprocal of a value that is far larger than the unknown can be.
    pub(crate) fn ridge(&self, structure: &Structure) -> DVector<f64> {
        let rank = structure.parameters.rank();
        DVector::from_fn(structure.count(), |at, _| {
            let scale = if at < rank {
                self.bases[at]
            } else if structure.options.friction && at < rank + FRICTION * structure.dof() {
                self.friction[(at - rank) / FRICTION]
            } else {
                DELAY
            };
            1.0 / (PRIOR_DEVIATIONS * scale)
        })
    }
}

/// Returns the radius of gyration about the origin of the frame, m.
fn size(pseudo: &Matrix4<f64>) -> f64 {
    ((pseudo[(0, 0)] + pseudo[(1, 1)] + pseudo[(2, 2)]) / pseudo[(3, 3)]).sqrt()
}
