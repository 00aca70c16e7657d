//! Dynamics of a tree without a recursion: every link's pose is a product of 4 × 4 matrices along its path from the
//! base, differentiated twice along the motion, and the torques are the projected Newton-Euler equations,
//! τ_j = Σ v_j · (m (p̈ - g) + R̈ h) + w_j · (I ω̇ + ω × I ω + R h × (p̈ - g)), summed over the links.

use nalgebra::{Matrix3, Matrix4, Vector3};
use rne::{BaseMotion, Payload};
use rne_model::{Angle, Convention, FixedFrame, JointKind, Robot, Transform};

/// A pose along a motion: its value, and its first and second derivative.
pub(crate) type Jet = [Matrix4<f64>; 3];

/// Positions, rates and accelerations of the joints, and the base.
#[derive(Clone, Copy)]
pub(crate) struct Motion<'a> {
    pub(crate) joints: [&'a [f64]; 3],
    pub(crate) base: BaseMotion<f64>,
}

/// A body of a robot: the link that carries it, and its data in a frame there.
struct Body {
    frame: FixedFrame,
    mass: f64,
    com: Vector3<f64>,
    inertia: Matrix3<f64>,
    first_moment: Vector3<f64>,
}

/// What moves a body: force, and moment about its centre of mass; in the axes of the base.
pub(crate) struct Needed {
    pub(crate) centre: Vector3<f64>,
    pub(crate) force: Vector3<f64>,
    pub(crate) moment: Vector3<f64>,
}

fn about(axis: usize, sin: f64, cos: f64) -> Matrix4<f64> {
    let mut matrix = Matrix4::identity();
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    (matrix[(i, i)], matrix[(i, j)], matrix[(j, i)], matrix[(j, j)]) = (cos, -sin, sin, cos);
    matrix
}

fn turned(axis: usize, angle: &Angle) -> Matrix4<f64> {
    about(axis, angle.sin, angle.cos)
}

fn moved(by: [f64; 3]) -> Matrix4<f64> {
    Matrix4::new_translation(&Vector3::from(by))
}

fn placed(transform: &Transform) -> Matrix4<f64> {
    let [roll, pitch, yaw] = &transform.rpy;
    moved(transform.xyz) * turned(2, yaw) * turned(1, pitch) * turned(0, roll)
}

fn still(matrix: Matrix4<f64>) -> Jet {
    [matrix, Matrix4::zeros(), Matrix4::zeros()]
}

fn product(a: &Jet, b: &Jet) -> Jet {
    [a[0] * b[0], a[1] * b[0] + a[0] * b[1], a[2] * b[0] + a[1] * b[1] * 2.0 + a[0] * b[2]]
}

/// exp(G q), where G is the screw of a joint about or along z.
fn joint(kind: JointKind, [q, qd, qdd]: [f64; 3]) -> Jet {
    let mut screw = Matrix4::zeros();
    let value = match kind {
        JointKind::Revolute => {
            (screw[(0, 1)], screw[(1, 0)]) = (-1.0, 1.0);
            about(2, q.sin(), q.cos())
        }
        JointKind::Prismatic => {
            screw[(2, 3)] = 1.0;
            moved([0.0, 0.0, q])
        }
    };
    [value, value * screw * qd, value * (screw * screw * (qd * qd) + screw * qdd)]
}

/// The pose of a link in frame 0, and the frame at its joint: z along the joint, fixed to the link.
fn link(robot: &Robot, index: Option<usize>, motion: &Motion<'_>) -> [Jet; 2] {
    let Some(index) = index else {
        let skew = |w: [f64; 3]| Vector3::from(w).cross_matrix();
        let BaseMotion { omega, omega_dot, velocity, acceleration, .. } = motion.base;
        let of = |rotation: Matrix3<f64>, translation: [f64; 3]| {
            let mut matrix = Matrix4::zeros();
            matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&rotation);
            matrix.fixed_view_mut::<3, 1>(0, 3).copy_from(&Vector3::from(translation));
            matrix
        };
        let second = skew(omega_dot) + skew(omega) * skew(omega);
        let base = [Matrix4::identity(), of(skew(omega), velocity), of(second, acceleration)];
        return [base, base];
    };
    let row = &robot.joints[index].row;
    let [mut pose, _] = link(robot, robot.parent(index), motion);
    if let Some(branch) = &robot.joints[index].branch {
        pose = product(&pose, &still(placed(&branch.placement)));
    }
    let variable = joint(row.kind, motion.joints.map(|values| values[index]));
    let turn = turned(2, &row.dh.theta);
    let (length, twist) = (moved([row.dh.a, 0.0, 0.0]), turned(0, &row.dh.alpha));
    let (before, behind) = match robot.convention {
        Convention::Standard => (turn, length * twist),
        Convention::Modified => (twist * length * turn, Matrix4::identity()),
    };
    let at_joint = product(&product(&pose, &still(before)), &variable);
    // the reference point of the joint: the offset d, and the sliding, lie behind it
    let mut point = product(&pose, &still(before));
    point[0].fixed_view_mut::<3, 3>(0, 0).copy_from(&at_joint[0].fixed_view::<3, 3>(0, 0));
    [product(&at_joint, &still(moved([0.0, 0.0, row.dh.d]) * behind)), point]
}

pub(crate) fn frame(robot: &Robot, frame: &FixedFrame, motion: &Motion<'_>) -> Jet {
    product(&link(robot, frame.on, motion)[0], &still(placed(&frame.placement)))
}

/// World → frame 0.
pub(crate) fn placement_of_base(robot: &Robot) -> Matrix4<f64> {
    placed(&robot.base)
}

/// The link frame of the table in frame 0.
pub(crate) fn link_pose(robot: &Robot, index: usize, motion: &Motion<'_>) -> Matrix4<f64> {
    link(robot, Some(index), motion)[0][0]
}

/// The frame at a joint in frame 0: rotation and reference point.
pub(crate) fn joint_frame(robot: &Robot, index: usize, motion: &Motion<'_>) -> (Matrix3<f64>, Vector3<f64>) {
    parts(&link(robot, Some(index), motion)[1][0])
}

pub(crate) fn parts(matrix: &Matrix4<f64>) -> (Matrix3<f64>, Vector3<f64>) {
    (matrix.fixed_view::<3, 3>(0, 0).into_owned(), matrix.fixed_view::<3, 1>(0, 3).into_owned())
}

fn vector_of(skew: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(skew[(2, 1)] - skew[(1, 2)], skew[(0, 2)] - skew[(2, 0)], skew[(1, 0)] - skew[(0, 1)]) / 2.0
}

/// Linear and angular velocity, then acceleration, of a frame at a point of it.
pub(crate) fn rates(jet: &Jet, point: &Vector3<f64>) -> [[Vector3<f64>; 2]; 2] {
    let [(r, _), (r1, p1), (r2, p2)] = [parts(&jet[0]), parts(&jet[1]), parts(&jet[2])];
    let (omega, omega_dot) = (vector_of(&(r1 * r.transpose())), vector_of(&(r2 * r.transpose() + r1 * r1.transpose())));
    [[r1 * point + p1, omega], [r2 * point + p2, omega_dot]]
}

/// Velocity of a point of a frame, and angular velocity, per rate of each joint, on a base that stands still.
pub(crate) fn jacobian(robot: &Robot, of: &FixedFrame, q: &[f64], point: &Vector3<f64>) -> Vec<[Vector3<f64>; 2]> {
    let zeros = vec![0.0; q.len()];
    let column = |index: usize| {
        let mut unit = zeros.clone();
        unit[index] = 1.0;
        let motion = Motion { joints: [q, &unit, &zeros], base: BaseMotion::fixed([0.0; 3]) };
        rates(&frame(robot, of, &motion), point)[0]
    };
    (0..q.len()).map(column).collect()
}

fn bodies(robot: &Robot, payload: Option<&Payload<f64>>) -> Vec<Body> {
    let tensor = |inertia: &rne_model::Inertia| Matrix3::from(inertia.rows());
    let of_link = |(index, joint): (usize, &rne_model::Joint)| {
        let link = &joint.row.link;
        Body {
            frame: FixedFrame { on: Some(index), placement: Transform::IDENTITY },
            mass: link.mass,
            com: link.com.into(),
            inertia: tensor(&link.inertia),
            first_moment: link.first_moment.into(),
        }
    };
    let at_tip = |payload: &Payload<f64>| Body {
        frame: robot.tip(),
        mass: payload.mass,
        com: payload.com.into(),
        inertia: tensor(&payload.inertia),
        first_moment: Vector3::zeros(),
    };
    robot.joints.iter().enumerate().map(of_link).chain(payload.map(at_tip)).collect()
}

/// What moves each link, and the payload, against gravity.
pub(crate) fn needed(robot: &Robot, motion: &Motion<'_>, payload: Option<&Payload<f64>>) -> Vec<Needed> {
    let gravity = Vector3::from(motion.base.gravity);
    let of_body = |body: &Body| {
        let jet = frame(robot, &body.frame, motion);
        let [(r, p), (r2, _)] = [parts(&jet[0]), parts(&jet[2])];
        let [[_, omega], [acceleration, omega_dot]] = rates(&jet, &body.com);
        let inertia = r * body.inertia * r.transpose();
        let specific = acceleration - gravity;
        let turning = inertia * omega_dot + omega.cross(&(inertia * omega));
        Needed {
            centre: r * body.com + p,
            force: specific * body.mass + r2 * body.first_moment,
            moment: turning + (r * body.first_moment).cross(&specific),
        }
    };
    bodies(robot, payload).iter().map(of_body).collect()
}

/// The part of each body in each torque: by body, then by joint.
pub(crate) fn torque_parts(robot: &Robot, motion: &Motion<'_>, payload: Option<&Payload<f64>>) -> Vec<Vec<f64>> {
    let bodies = bodies(robot, payload);
    let parts = bodies.iter().zip(needed(robot, motion, payload)).map(|(body, needed)| {
        let columns = jacobian(robot, &body.frame, motion.joints[0], &body.com);
        columns.iter().map(|[v, w]| v.dot(&needed.force) + w.dot(&needed.moment)).collect()
    });
    parts.collect()
}

pub(crate) fn torques(robot: &Robot, motion: &Motion<'_>, payload: Option<&Payload<f64>>) -> Vec<f64> {
    let parts = torque_parts(robot, motion, payload);
    (0..robot.dof()).map(|joint| parts.iter().map(|part| part[joint]).sum()).collect()
}

/// The columns of M: torques of unit accelerations, at rest and without gravity.
pub(crate) fn mass_matrix(robot: &Robot, q: &[f64], payload: Option<&Payload<f64>>) -> Vec<Vec<f64>> {
    let zeros = vec![0.0; q.len()];
    let column = |index: usize| {
        let mut unit = zeros.clone();
        unit[index] = 1.0;
        torques(robot, &Motion { joints: [q, &zeros, &unit], base: BaseMotion::fixed([0.0; 3]) }, payload)
    };
    (0..q.len()).map(column).collect()
}

/// Mass, and first moment from the origin of frame 0.
pub(crate) fn first_moment(robot: &Robot, q: &[f64]) -> (f64, Vector3<f64>) {
    let zeros = vec![0.0; q.len()];
    let motion = Motion { joints: [q, &zeros, &zeros], base: BaseMotion::fixed([0.0; 3]) };
    bodies(robot, None).iter().fold((0.0, Vector3::zeros()), |(mass, moment), body| {
        let (r, p) = parts(&frame(robot, &body.frame, &motion)[0]);
        (mass + body.mass, moment + (r * body.com + p) * body.mass + r * body.first_moment)
    })
}

/// The first moment's derivative by each joint.
pub(crate) fn first_moment_rates(robot: &Robot, q: &[f64]) -> Vec<Vector3<f64>> {
    let mut columns = vec![Vector3::zeros(); q.len()];
    for body in bodies(robot, None) {
        let (r, _) = {
            let zeros = vec![0.0; q.len()];
            let motion = Motion { joints: [q, &zeros, &zeros], base: BaseMotion::fixed([0.0; 3]) };
            parts(&frame(robot, &body.frame, &motion)[0])
        };
        let moment = r * body.first_moment;
        for (column, [v, w]) in columns.iter_mut().zip(jacobian(robot, &body.frame, q, &body.com)) {
            *column += v * body.mass + w.cross(&moment);
        }
    }
    columns
}

/// ∂T/∂q. T is a quadratic form of the rates, so ∂T/∂q_j is that of the velocities and of their derivatives by q_j: for
/// the link's velocity V along q̇, ∂V/∂q_j comes from the second derivative of the pose along q̇ and e_j.
pub(crate) fn kinetic_energy_by_position(
    robot: &Robot,
    q: &[f64],
    qd: &[f64],
    payload: Option<&Payload<f64>>,
) -> Vec<f64> {
    let zeros = vec![0.0; q.len()];
    let at = |rates: &[f64], body: &Body| {
        let motion = Motion { joints: [q, rates, &zeros], base: BaseMotion::fixed([0.0; 3]) };
        frame(robot, &body.frame, &motion)
    };
    let mut all = vec![0.0; q.len()];
    for body in bodies(robot, payload) {
        let along = at(qd, &body);
        for (joint, energy) in all.iter_mut().enumerate() {
            let [mut plus, mut minus] = [qd.to_vec(), qd.to_vec()];
            plus[joint] += 1.0;
            minus[joint] -= 1.0;
            // ∂²X/∂q_j ∂t by polarisation of the quadratic form Ẍ
            let (plus, minus) = (at(&plus, &body), at(&minus, &body));
            let mixed = parts(&((plus[2] - minus[2]) / 4.0));
            let by_joint = parts(&((plus[1] - minus[1]) / 2.0));
            let [(r, _), (r1, p1)] = [parts(&along[0]), parts(&along[1])];
            // ω = vee(Ṙ Rᵀ), and its derivative by q_j
            let omega = vector_of(&(r1 * r.transpose()));
            let omega_by = vector_of(&(mixed.0 * r.transpose() + r1 * by_joint.0.transpose()));
            let velocity = r1 * body.com + p1;
            let velocity_by = mixed.0 * body.com + mixed.1;
            let inertia = r * body.inertia * r.transpose();
            let spin = by_joint.0 * r.transpose();
            let inertia_by = spin * inertia + inertia * spin.transpose();
            let moment = r * body.first_moment;
            let moment_by = by_joint.0 * body.first_moment;
            *energy += body.mass * velocity.dot(&velocity_by)
                + omega.dot(&(inertia * omega_by))
                + omega.dot(&(inertia_by * omega)) / 2.0
                + velocity_by.dot(&omega.cross(&moment))
                + velocity.dot(&(omega_by.cross(&moment) + omega.cross(&moment_by)));
        }
    }
    all
}
