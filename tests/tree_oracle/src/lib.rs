//! Dynamics of a tree without a recursion: every link's pose is a product of 4 × 4 matrices along its path from the
//! base, differentiated twice along the motion, and the torques are the projected Newton-Euler equations,
//! τ_j = Σ v_j · (m (p̈ - g) + R̈ h) + w_j · (I ω̇ + ω × I ω + R h × (p̈ - g)), summed over the links.
//!
//! Derivatives are exact without a rule of differentiation: the torques are polynomials of second degree in the rates
//! and in the position of a joint that slides, and sums of sines and cosines of q and 2 q for a joint that turns.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, SQRT_2};

use nalgebra::{Matrix3, Matrix4, Vector3};
use rne_model::{Angle, Convention, FixedFrame, JointKind, Motor, Robot, Transform};
use rne_runtime::{BaseMotion, Payload};

/// A pose along a motion: its value, and its first and second derivative.
pub type Jet = [Matrix4<f64>; 3];

/// Positions, rates and accelerations of the joints, and the base.
#[derive(Clone, Copy)]
pub struct Motion<'a> {
    /// Positions, rates and accelerations.
    pub joints: [&'a [f64]; 3],
    /// The motion of frame 0, in its axes.
    pub base: BaseMotion<f64>,
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
pub struct Needed {
    /// The centre of mass, from the origin of frame 0.
    pub centre: Vector3<f64>,
    /// Force, N.
    pub force: Vector3<f64>,
    /// Moment about the centre of mass, N m.
    pub moment: Vector3<f64>,
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

/// What is fixed to a moving frame.
fn fixed(to: &Jet, at: Matrix4<f64>) -> Jet {
    to.map(|derivative| derivative * at)
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
        pose = fixed(&pose, placed(&branch.placement));
    }
    let variable = joint(row.kind, motion.joints.map(|values| values[index]));
    let turn = turned(2, &row.dh.theta);
    let (length, twist) = (moved([row.dh.a, 0.0, 0.0]), turned(0, &row.dh.alpha));
    let (before, behind) = match robot.convention {
        Convention::Standard => (turn, length * twist),
        Convention::Modified => (twist * length * turn, Matrix4::identity()),
    };
    let at_joint = product(&fixed(&pose, before), &variable);
    // the reference point of the joint: the offset d, and the sliding, lie behind it
    let mut point = fixed(&pose, before);
    point[0].fixed_view_mut::<3, 3>(0, 0).copy_from(&at_joint[0].fixed_view::<3, 3>(0, 0));
    [fixed(&at_joint, moved([0.0, 0.0, row.dh.d]) * behind), point]
}

/// The pose of a frame along a motion.
pub fn frame(robot: &Robot, frame: &FixedFrame, motion: &Motion<'_>) -> Jet {
    fixed(&link(robot, frame.on, motion)[0], placed(&frame.placement))
}

/// World → frame 0.
pub fn placement_of_base(robot: &Robot) -> Matrix4<f64> {
    placed(&robot.base)
}

/// The link frame of the table in frame 0.
pub fn link_pose(robot: &Robot, index: usize, motion: &Motion<'_>) -> Matrix4<f64> {
    link(robot, Some(index), motion)[0][0]
}

/// The frame at a joint in frame 0: rotation and reference point.
pub fn joint_frame(robot: &Robot, index: usize, motion: &Motion<'_>) -> (Matrix3<f64>, Vector3<f64>) {
    parts(&link(robot, Some(index), motion)[1][0])
}

/// Rotation and translation.
pub fn parts(matrix: &Matrix4<f64>) -> (Matrix3<f64>, Vector3<f64>) {
    (matrix.fixed_view::<3, 3>(0, 0).into_owned(), matrix.fixed_view::<3, 1>(0, 3).into_owned())
}

fn vector_of(skew: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(skew[(2, 1)] - skew[(1, 2)], skew[(0, 2)] - skew[(2, 0)], skew[(1, 0)] - skew[(0, 1)]) / 2.0
}

/// Linear and angular velocity, then acceleration, of a frame at a point of it.
pub fn rates(jet: &Jet, point: &Vector3<f64>) -> [[Vector3<f64>; 2]; 2] {
    let [(r, _), (r1, p1), (r2, p2)] = [parts(&jet[0]), parts(&jet[1]), parts(&jet[2])];
    let (omega, omega_dot) = (vector_of(&(r1 * r.transpose())), vector_of(&(r2 * r.transpose() + r1 * r1.transpose())));
    [[r1 * point + p1, omega], [r2 * point + p2, omega_dot]]
}

/// Whether a joint moves a link, or what is on the base.
pub fn moves(robot: &Robot, joint: usize, link: Option<usize>) -> bool {
    std::iter::successors(link, |&link| robot.parent(link)).any(|link| link == joint)
}

/// Velocity of a point of a frame, and angular velocity, per rate of each joint, on a base that stands still.
pub fn jacobian(robot: &Robot, of: &FixedFrame, q: &[f64], point: &Vector3<f64>) -> Vec<[Vector3<f64>; 2]> {
    let zeros = vec![0.0; q.len()];
    let column = |joint: usize| {
        if !moves(robot, joint, of.on) {
            return [Vector3::zeros(); 2];
        }
        let unit = moved_by(&zeros, joint, 1.0);
        let motion = Motion { joints: [q, &unit, &zeros], base: BaseMotion::fixed([0.0; 3]) };
        rates(&frame(robot, of, &motion), point)[0]
    };
    (0..q.len()).map(column).collect()
}

fn moved_by(values: &[f64], joint: usize, step: f64) -> Vec<f64> {
    let mut values = values.to_vec();
    values[joint] += step;
    values
}

/// The derivative of what is a polynomial of second degree in a rate, at a rate.
pub fn by_rate(qd: &[f64], joint: usize, of: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    odd_part(qd, joint, 1.0, of)
}

/// The derivative by the position of a joint. The odd part of b₁ sin x + b₂ sin 2 x at π/2 is b₁, that at π/4 is
/// b₁/√2 + b₂, and the derivative b₁ + 2 b₂.
pub fn by_position(robot: &Robot, q: &[f64], joint: usize, of: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    match robot.joints[joint].row.kind {
        JointKind::Prismatic => odd_part(q, joint, 1.0, of),
        JointKind::Revolute => {
            let (half, quarter) = (odd_part(q, joint, FRAC_PI_2, &of), odd_part(q, joint, FRAC_PI_4, &of));
            half.iter().zip(quarter).map(|(half, quarter)| 2.0 * quarter + (1.0 - SQRT_2) * half).collect()
        }
    }
}

fn odd_part(at: &[f64], joint: usize, step: f64, of: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    let [after, before] = [step, -step].map(|step| of(&moved_by(at, joint, step)));
    after.iter().zip(before).map(|(after, before)| (after - before) / 2.0).collect()
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
    // the base stands last, so that links keep their places
    let base = robot.floating_base.as_ref().map(|base| Body {
        frame: FixedFrame { on: None, placement: Transform::IDENTITY },
        mass: base.link.mass,
        com: base.link.com.into(),
        inertia: tensor(&base.link.inertia),
        first_moment: Vector3::zeros(),
    });
    robot.joints.iter().enumerate().map(of_link).chain(payload.map(at_tip)).chain(base).collect()
}

/// Force, and moment about the origin of frame 0, that must act on the base beside gravity.
pub fn base_wrench(robot: &Robot, motion: &Motion<'_>, payload: Option<&Payload<f64>>) -> [Vector3<f64>; 2] {
    needed(robot, motion, payload).iter().fold([Vector3::zeros(); 2], |[force, moment], it| {
        [force + it.force, moment + it.moment + it.centre.cross(&it.force)]
    })
}

/// What moves each link, and the payload, against gravity.
pub fn needed(robot: &Robot, motion: &Motion<'_>, payload: Option<&Payload<f64>>) -> Vec<Needed> {
    needed_by(robot, motion, &bodies(robot, payload))
}

fn needed_by(robot: &Robot, motion: &Motion<'_>, bodies: &[Body]) -> Vec<Needed> {
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
    bodies.iter().map(of_body).collect()
}

/// The part of each body in each torque: by body, then by joint.
fn torque_parts(robot: &Robot, motion: &Motion<'_>, bodies: &[Body]) -> Vec<Vec<f64>> {
    let parts = bodies.iter().zip(needed_by(robot, motion, bodies)).map(|(body, needed)| {
        let columns = jacobian(robot, &body.frame, motion.joints[0], &body.com);
        columns.iter().map(|[v, w]| v.dot(&needed.force) + w.dot(&needed.moment)).collect()
    });
    parts.collect()
}

/// Bodies of a unit of each inertial parameter of a link, about the origin of the link frame; of the base without a
/// link.
fn units(on: Option<usize>) -> Vec<Body> {
    let body = |mass: f64, first_moment: Vector3<f64>, inertia: Matrix3<f64>| Body {
        frame: FixedFrame { on, placement: Transform::IDENTITY },
        com: Vector3::zeros(),
        mass,
        first_moment,
        inertia,
    };
    let element = |row: usize, column: usize| {
        let mut tensor = Matrix3::zeros();
        (tensor[(row, column)], tensor[(column, row)]) = (1.0, 1.0);
        tensor
    };
    let of_moment = |axis: usize| body(0.0, Vector3::ith(axis, 1.0), Matrix3::zeros());
    let elements = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
    let of_tensor = elements.map(|(row, column)| body(0.0, Vector3::zeros(), element(row, column)));
    let point = body(1.0, Vector3::zeros(), Matrix3::zeros());
    [point].into_iter().chain((0..3).map(of_moment)).chain(of_tensor).collect()
}

/// The torques of a unit of each inertial parameter of each link: by torque, then by link.
pub fn regressor(robot: &Robot, motion: &Motion<'_>) -> Vec<f64> {
    let units: Vec<Body> = (0..robot.dof()).flat_map(|index| units(Some(index))).collect();
    let parts = torque_parts(robot, motion, &units);
    (0..robot.dof()).flat_map(|joint| parts.iter().map(move |part| part[joint]).collect::<Vec<_>>()).collect()
}

/// Force and moment on the base, and the torques, of a unit of each inertial parameter of the base and of each link.
pub fn floating_regressor(robot: &Robot, motion: &Motion<'_>) -> Vec<f64> {
    let bodies = [None].into_iter().chain((0..robot.dof()).map(Some));
    let units: Vec<Body> = bodies.flat_map(units).collect();
    let parts = needed_by(robot, motion, &units).into_iter().zip(torque_parts(robot, motion, &units));
    let column = |(needed, torques): (Needed, Vec<f64>)| {
        let about = needed.moment + needed.centre.cross(&needed.force);
        [needed.force.as_slice(), about.as_slice(), &torques].concat()
    };
    let columns: Vec<Vec<f64>> = parts.map(column).collect();
    (0..6 + robot.dof()).flat_map(|row| columns.iter().map(move |column| column[row]).collect::<Vec<_>>()).collect()
}

/// G² Jm of each joint, where rotors belong to the robot.
fn rotors(robot: &Robot) -> impl Iterator<Item = f64> {
    let of = |motor: Motor| motor.gear_ratio * motor.gear_ratio * motor.inertia;
    robot.joints.iter().map(move |joint| joint.motor.filter(|_| robot.rotors).map_or(0.0, of))
}

/// The torques of the joints, with the weight and the inertia of a payload.
pub fn torques(robot: &Robot, motion: &Motion<'_>, payload: Option<&Payload<f64>>) -> Vec<f64> {
    let parts = torque_parts(robot, motion, &bodies(robot, payload));
    let of_links = |joint: usize| parts.iter().map(|part| part[joint]).sum::<f64>();
    let of_spins = spin_torques(robot, motion.joints);
    let of_rotors = rotors(robot).zip(of_spins).enumerate();
    of_rotors.map(|(joint, (rotor, spin))| of_links(joint) + rotor * motion.joints[2][joint] + spin).collect()
}

/// ½ Jm s (s + 2 a · ω) of the rotors that turn on links, with the base at rest.
fn spin_energy(robot: &Robot, q: &[f64], qd: &[f64]) -> f64 {
    let zeros = vec![0.0; q.len()];
    let motion = Motion { joints: [q, qd, &zeros], base: BaseMotion::fixed([0.0; 3]) };
    let mut energy = 0.0;
    for (rotor, turns) in robot.spinning_rotors() {
        let spin: f64 = turns.iter().map(|&(joint, n)| n * qd[joint]).sum();
        let jet = frame(robot, &FixedFrame { on: rotor.on, placement: Transform::IDENTITY }, &motion);
        let ((r, _), [[_, omega], _]) = (parts(&jet[0]), rates(&jet, &Vector3::zeros()));
        energy += 0.5 * rotor.inertia * spin * (spin + 2.0 * (r * Vector3::from(rotor.axis)).dot(&omega));
    }
    energy
}

/// Lagrange's equations of that energy: τ = d/dt ∂T/∂q̇ - ∂T/∂q, with the momenta ∂T/∂q̇ linear in the rates.
fn spin_torques(robot: &Robot, [q, qd, qdd]: [&[f64]; 3]) -> Vec<f64> {
    let mut torques = vec![0.0; q.len()];
    if !robot.has_spinning_rotors() {
        return torques;
    }
    let momenta = |q: &[f64], qd: &[f64]| -> Vec<f64> {
        (0..q.len()).map(|joint| by_rate(qd, joint, |qd| vec![spin_energy(robot, q, qd)])[0]).collect()
    };
    let accelerated = momenta(q, qdd);
    for joint in 0..q.len() {
        torques[joint] += accelerated[joint];
        for (torque, moved) in torques.iter_mut().zip(by_position(robot, q, joint, |q| momenta(q, qd))) {
            *torque += moved * qd[joint];
        }
        torques[joint] -= by_position(robot, q, joint, |q| vec![spin_energy(robot, q, qd)])[0];
    }
    torques
}

/// What motors need beside the links: G² Jm q̈ where rotors do not belong to the robot, and friction.
pub fn actuator_torques(robot: &Robot, qd: &[f64], qdd: &[f64]) -> Vec<f64> {
    let of_motor = |(motor, joint): (Motor, usize)| {
        let square = motor.gear_ratio.powi(2);
        let rotor = if robot.rotors { 0.0 } else { motor.inertia };
        let coulomb = motor.coulomb[usize::from(qd[joint] < 0.0)];
        square * (rotor * qdd[joint] + motor.viscous * qd[joint]) + motor.gear_ratio.abs() * coulomb
    };
    robot.joints.iter().enumerate().map(|(index, joint)| joint.motor.map_or(0.0, |it| of_motor((it, index)))).collect()
}

/// The columns of M: torques of unit accelerations, at rest and without gravity.
pub fn mass_matrix(robot: &Robot, q: &[f64], payload: Option<&Payload<f64>>) -> Vec<Vec<f64>> {
    let zeros = vec![0.0; q.len()];
    let column = |joint: usize| {
        let unit = moved_by(&zeros, joint, 1.0);
        torques(robot, &Motion { joints: [q, &zeros, &unit], base: BaseMotion::fixed([0.0; 3]) }, payload)
    };
    (0..q.len()).map(column).collect()
}

/// ½ Σ m v · v + ω · I ω + 2 v · (ω × R h), and that of rotors.
pub fn kinetic_energy(robot: &Robot, q: &[f64], qd: &[f64], payload: Option<&Payload<f64>>) -> f64 {
    let zeros = vec![0.0; q.len()];
    let motion = Motion { joints: [q, qd, &zeros], base: BaseMotion::fixed([0.0; 3]) };
    let of_body = |body: &Body| {
        let jet = frame(robot, &body.frame, &motion);
        let ((r, _), [[v, omega], _]) = (parts(&jet[0]), rates(&jet, &body.com));
        let inertia = r * body.inertia * r.transpose();
        body.mass * v.dot(&v) + omega.dot(&(inertia * omega)) + 2.0 * v.dot(&omega.cross(&(r * body.first_moment)))
    };
    let of_rotors = rotors(robot).zip(qd).map(|(rotor, qd)| rotor * qd * qd);
    bodies(robot, payload).iter().map(of_body).chain(of_rotors).sum::<f64>() / 2.0 + spin_energy(robot, q, qd)
}

/// Mass, and first moment from the origin of frame 0.
pub fn first_moment(robot: &Robot, q: &[f64]) -> (f64, Vector3<f64>) {
    let zeros = vec![0.0; q.len()];
    let motion = Motion { joints: [q, &zeros, &zeros], base: BaseMotion::fixed([0.0; 3]) };
    bodies(robot, None).iter().fold((0.0, Vector3::zeros()), |(mass, moment), body| {
        let (r, p) = parts(&frame(robot, &body.frame, &motion)[0]);
        (mass + body.mass, moment + (r * body.com + p) * body.mass + r * body.first_moment)
    })
}
