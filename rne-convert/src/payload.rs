//! A payload that stays on the arm: a part of its last link.

use rne_model::{Inertia, InertiaReference, Robot};

use crate::body::Body;
use crate::geometry::Pose;

/// The robot whose last link has the payload, too: `mass` in kg, `com` from the origin of the tip frame in m, `inertia`
/// about the centre of mass in kg m², all in tip-frame axes. A robot without joints stays as it is.
#[must_use]
pub fn carrying(robot: &Robot, mass: f64, com: [f64; 3], inertia: Inertia) -> Robot {
    let tool = Pose::new(robot.tool.xyz, robot.tool.rpy.map(|angle| angle.radians));
    let mut robot = robot.clone();
    if let Some(last) = robot.tip().on.and_then(|on| robot.joints.get_mut(on)) {
        let payload = Body::at(mass, Pose::new(com, [0.0; 3]), inertia).seen_from(tool);
        last.row.link = (Body::of_link(&last.row.link) + payload).to_link();
        last.written_inertia = (last.row.link.inertia, InertiaReference::Com);
    }
    robot
}
