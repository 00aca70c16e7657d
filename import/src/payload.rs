//! Adds a payload to an arm, as a part of the link that carries it.

use rne_model::{FixedFrame, Inertia, InertiaReference, Robot, Transform};

use crate::body::Body;
use crate::geometry::Pose;

/// Returns the robot with a payload on its last link: `mass` in kg, `com` from the origin of the tip frame in m,
/// `inertia` about the centre of mass in kg m², all in tip-frame axes. A robot without joints stays as it is.
#[must_use]
pub fn carrying(robot: &Robot, mass: f64, com: [f64; 3], inertia: Inertia) -> Robot {
    carrying_at(robot, &robot.tip(), mass, com, inertia)
}

/// Adds a payload as [`carrying`] does, but at a frame instead of the tip. On the base it has no effect.
#[must_use]
pub fn carrying_at(robot: &Robot, frame: &FixedFrame, mass: f64, com: [f64; 3], inertia: Inertia) -> Robot {
    let Transform { xyz, rpy } = frame.placement;
    let place = Pose::new(xyz, rpy.map(|angle| angle.radians));
    let mut robot = robot.clone();
    if let Some(last) = frame.on.and_then(|on| robot.joints.get_mut(on)) {
        let payload = Body::at(mass, Pose::new(com, [0.0; 3]), inertia).seen_from(place);
        last.row.link = (Body::of_link(&last.row.link) + payload).to_link();
        last.written_inertia = (last.row.link.inertia, InertiaReference::Com);
    }
    robot
}
