//! What every function of a tree returns, without a recursion: by projected Newton-Euler, and where a function solves
//! with the mass matrix, by the solution of nalgebra.

use fastrand::Rng;
use nalgebra::{DMatrix, DVector, Matrix3, UnitQuaternion, Vector3};
use rne::{BaseMotion, Payload, Wrench};
use rne_codegen::OfRobot as _;
use rne_codegen::{Argument, Function};
use rne_model::{Contact, FixedFrame, Robot};
use tree_oracle::{self as oracle, Motion};

use crate::arm::{Given, STEP, at_tips, base_rotation};
use crate::case::payload;
use crate::check::{conditioning, flat};

#[derive(Clone)]
pub(crate) struct State {
    pub(crate) q: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    pub(crate) qdd: Vec<f64>,
    pub(crate) tau: Vec<f64>,
    pub(crate) wrench: Wrench<f64>,
    pub(crate) payload: Payload<f64>,
    pub(crate) base: BaseMotion<f64>,
}

impl State {
    pub(crate) fn random(seed: u64, dof: usize) -> Self {
        let mut rng = Rng::with_seed(seed);
        let mut array = |scale: f64| -> Vec<f64> { (0..dof).map(|_| (2.0 * rng.f64() - 1.0) * scale).collect() };
        let (q, qd, qdd, tau) = (array(3.0), array(2.0), array(5.0), array(20.0));
        let mut triple = || [(); 3].map(|()| (2.0 * rng.f64() - 1.0) * 10.0);
        let wrench = Wrench { force: triple(), moment: triple() };
        let [omega, omega_dot, velocity, acceleration, gravity] = [(); 5].map(|()| triple());
        let base = BaseMotion { omega, omega_dot, velocity, acceleration, gravity };
        Self { q, qd, qdd, tau, wrench, payload: payload(&mut rng), base }
    }

    pub(crate) fn with_joints(&self, [q, qd, qdd]: [Vec<f64>; 3]) -> Self {
        Self { q, qd, qdd, ..self.clone() }
    }

    pub(crate) fn given(&self) -> Given<'_, f64> {
        let Self { q, qd, qdd, tau, wrench, payload, base } = self;
        Given {
            q,
            qd,
            qdd,
            tau,
            wrench: *wrench,
            payload: *payload,
            base: *base,
            base_rotation: base_rotation(),
            step: STEP,
        }
    }
}

fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

pub(crate) fn times(matrix: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    matrix.iter().map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
}

fn rows(columns: &[[Vector3<f64>; 2]]) -> Vec<f64> {
    (0..6).flat_map(|row| columns.iter().map(move |parts| parts[row / 3][row % 3])).collect()
}

/// The rotation of the base.
fn rotation() -> Matrix3<f64> {
    Matrix3::from(base_rotation()).transpose()
}

fn pose((rotation, translation): (Matrix3<f64>, Vector3<f64>)) -> Vec<f64> {
    [rotation.transpose().as_slice(), translation.as_slice()].concat()
}

/// Jᵀ w of a wrench in the axes of a frame.
fn of_wrench_at(robot: &Robot, frame: &FixedFrame, q: &[f64], wrench: &Wrench<f64>) -> Vec<f64> {
    let zeros = vec![0.0; q.len()];
    let still = Motion { joints: [q, &zeros, &zeros], base: BaseMotion::fixed([0.0; 3]) };
    let (r, _) = oracle::parts(&oracle::frame(robot, frame, &still)[0]);
    let (force, moment) = (r * Vector3::from(wrench.force), r * Vector3::from(wrench.moment));
    let columns = oracle::jacobian(robot, frame, q, &Vector3::zeros());
    columns.iter().map(|[v, w]| v.dot(&force) + w.dot(&moment)).collect()
}

/// The wrench that must act on a floating base, and the torques, with nothing at the tips.
fn of_floating_base(robot: &Robot, motion: &Motion<'_>, payload: Option<&Payload<f64>>) -> Vec<f64> {
    let [force, moment] = oracle::base_wrench(robot, motion, payload);
    [force.as_slice(), moment.as_slice(), &oracle::torques(robot, motion, payload)].concat()
}

/// The columns of the mass matrix of a robot with a floating base: wrenches and torques of unit accelerations.
pub(crate) fn floating_mass_matrix(robot: &Robot, q: &[f64], payload: Option<&Payload<f64>>) -> Vec<Vec<f64>> {
    let zeros = vec![0.0; q.len()];
    let column = |column: usize| {
        let unit = |place: usize| f64::from(u8::from(place == column));
        let (linear, angular) = ([0, 1, 2].map(unit), [3, 4, 5].map(unit));
        let qdd: Vec<f64> = (0..q.len()).map(|joint| unit(6 + joint)).collect();
        let base = BaseMotion { acceleration: linear, omega_dot: angular, ..BaseMotion::fixed([0.0; 3]) };
        of_floating_base(robot, &Motion { joints: [q, &zeros, &qdd], base }, payload)
    };
    (0..6 + q.len()).map(column).collect()
}

/// The equations of a robot in contact as one dense system, without gravity: M and -Jᵀ above J and what is added to the
/// diagonal. `jacobians` has the rows of all tips, one after the other.
pub(crate) fn contact_system(robot: &Robot, mass: &[f64], jacobians: &[f64]) -> (DMatrix<f64>, Vec<usize>) {
    let held: Vec<usize> = robot.contacts.iter().flat_map(|it| (0..it.rows()).map(|row| 6 * it.tip + row)).collect();
    let size = 6 + robot.dof();
    let jacobian = |row: usize, column: usize| jacobians[held[row] * size + column];
    let matrix = DMatrix::from_fn(size + held.len(), size + held.len(), |row, column| {
        match (row.checked_sub(size), column.checked_sub(size)) {
            (None, None) => mass[row * size + column],
            (None, Some(force)) => -jacobian(force, row),
            (Some(row), None) => jacobian(row, column),
            (Some(row), Some(force)) if row == force => Contact::DAMPING,
            _ => 0.0,
        }
    });
    (matrix, held)
}

/// How much such a system magnifies errors when the forces are found first, by A = J M⁻¹ Jᵀ and what is added to its
/// diagonal: the condition number of the whole system, and that of A, which is the larger one where many contacts share
/// few joints.
pub(crate) fn contact_condition(robot: &Robot, mass: &[f64], jacobians: &[f64]) -> f64 {
    let size = 6 + robot.dof();
    let (system, held) = contact_system(robot, mass, jacobians);
    let (m, j) = (system.view((0, 0), (size, size)), system.view((size, 0), (held.len(), size)));
    let Some(inverse) = m.clone_owned().try_inverse() else { return f64::INFINITY };
    let a = j * inverse * j.transpose() + system.view((size, size), (held.len(), held.len()));
    [system, a].map(|matrix| condition(&matrix)).into_iter().fold(1.0, f64::max)
}

fn condition(matrix: &DMatrix<f64>) -> f64 {
    if matrix.is_empty() {
        return 1.0;
    }
    let values = matrix.singular_values();
    values.max() / values.min()
}

/// The accelerations and forces of a robot in contact.
fn in_contact(robot: &Robot, state: &State) -> Vec<f64> {
    let size = 6 + state.q.len();
    let [jacobians, lacking] =
        [Function::TipJacobians, Function::TipAccelerations].map(|function| expected(robot, function, state));
    let zeros = vec![0.0; state.q.len()];
    let base = BaseMotion { omega: state.base.omega, ..BaseMotion::fixed([0.0; 3]) };
    let bias = of_floating_base(robot, &Motion { joints: [&state.q, &state.qd, &zeros], base }, None);
    let (matrix, held) = contact_system(robot, &flat(floating_mass_matrix(robot, &state.q, None)), &jacobians);
    let right = DMatrix::from_fn(size + held.len(), 1, |row, _| match row.checked_sub(size) {
        None if row < 6 => -bias[row],
        None => state.tau[row - 6] - bias[row],
        Some(row) if held[row] % 6 < 3 => -lacking[held[row]] - robot.gravity[held[row] % 6],
        Some(row) => -lacking[held[row]],
    });
    let mut wrenches = vec![0.0; 6 * robot.tip_count()];
    let Some(solution) = matrix.lu().solve(&right) else { return vec![f64::NAN; size + wrenches.len()] };
    held.iter().zip(&solution.as_slice()[size..]).for_each(|(&place, &force)| wrenches[place] = force);
    [&solution.as_slice()[..size], &wrenches].concat()
}

/// The state after a step: the base turns about ω by four times the arc tangent of h |ω| / 4.
fn next_of_floating_base(robot: &Robot, state: &State) -> Vec<f64> {
    let State { q, qd, base, .. } = state;
    let accelerations = expected(robot, Function::FloatingForwardDynamics, state);
    let (pose, place) = (state.given().pose(), |from: usize| Vector3::from_column_slice(&accelerations[from..][..3]));
    let rotation = Matrix3::from(pose.rotation).transpose();
    let omega = Vector3::from(base.omega) + place(3) * STEP;
    let velocity = rotation * (Vector3::from(base.velocity) + place(0) * STEP) + Vector3::from(robot.gravity) * STEP;
    let angle = 4.0 * (omega.norm() * STEP / 4.0).atan();
    let turn = UnitQuaternion::from_scaled_axis(omega.normalize() * angle).to_rotation_matrix();
    let turned = rotation * turn.matrix();
    let origin = Vector3::from(pose.translation) + velocity * STEP;
    let moved = |x: &[f64], by: &[f64]| x.iter().zip(by).map(|(x, by)| x + STEP * by).collect::<Vec<_>>();
    let rates = moved(qd, &accelerations[6..]);
    let of_base = [turned.transpose().as_slice(), origin.as_slice(), turned.tr_mul(&velocity).as_slice()].concat();
    [of_base, omega.as_slice().to_vec(), moved(q, &rates), rates].concat()
}

/// The derivatives of this step on the manifold of the positions: those of the accelerations as the solution of
/// nalgebra, and the turn of the base by the right Jacobian of the exponential.
fn derivatives_of_floating_step(robot: &Robot, state: &State) -> Vec<f64> {
    let State { q, base, .. } = state;
    let (dof, size) = (q.len(), 6 + q.len());
    let accelerations = expected(robot, Function::FloatingForwardDynamics, state);
    if !accelerations.iter().all(|x| x.is_finite()) {
        return vec![f64::NAN; size * (4 * size + 2 * dof)];
    }
    let place = |from: usize| Vector3::from_column_slice(&accelerations[from..][..3]);
    let motion = BaseMotion { acceleration: place(0).into(), omega_dot: place(3).into(), gravity: [0.0; 3], ..*base };
    let solved = State { qdd: accelerations[6..].to_vec(), base: motion, ..state.clone() };
    let forces = expected(robot, Function::FloatingInverseDynamicsDerivatives, &solved);
    let (by_joints, by_omega) = forces.split_at(2 * size * dof);
    let [by_q, by_qd] =
        [0, 1].map(|kind| DMatrix::from_row_slice(size, dof, &by_joints[kind * size * dof..][..size * dof]));
    let by_omega = DMatrix::from_row_slice(size, 3, by_omega);
    let mass = DMatrix::from_row_slice(size, size, &flat(floating_mass_matrix(robot, q, None))).lu();
    let solution = |right: DMatrix<f64>| {
        mass.solve(&right).unwrap_or_else(|| DMatrix::from_element(size, right.ncols(), f64::NAN))
    };
    let mut caused = [size, size, dof].map(|columns| DMatrix::zeros(size, columns));
    caused[0].view_mut((0, 6), (size, dof)).copy_from(&solution(-by_q));
    caused[1].view_mut((0, 6), (size, dof)).copy_from(&solution(-by_qd));
    caused[1].view_mut((0, 3), (size, 3)).copy_from(&solution(-by_omega));
    caused[2].copy_from(&solution(DMatrix::from_fn(size, dof, |row, column| f64::from(u8::from(row == 6 + column)))));

    let rotation = Matrix3::from(state.given().pose().rotation).transpose();
    let driven = Vector3::from(base.velocity) + place(0) * STEP;
    let in_world = rotation * driven + Vector3::from(robot.gravity) * STEP;
    // the turn has the rotation vector φ = f ω
    let omega = Vector3::from(base.omega) + place(3) * STEP;
    let speed = omega.norm();
    let (f, slope) = (4.0 * (speed * STEP / 4.0).atan() / speed, STEP / (1.0 + (speed * STEP / 4.0).powi(2)));
    let (phi, angle) = (omega * f, speed * f);
    let crossed = phi.cross_matrix();
    let right = Matrix3::identity() - crossed * ((1.0 - angle.cos()) / angle.powi(2))
        + crossed * crossed * ((angle - angle.sin()) / angle.powi(3));
    let by_rate = right * (Matrix3::identity() * f + omega * omega.transpose() * ((slope - f) / (speed * speed)));
    let next = rotation * UnitQuaternion::from_scaled_axis(phi).to_rotation_matrix().matrix();
    let mut halves = [Vec::new(), Vec::new()];
    for (kind, caused) in caused.iter().enumerate() {
        let column = |at: usize| {
            let unit = |of: usize| DVector::from_fn(size, |row, _| f64::from(u8::from(of == kind && row == at)));
            let (position, mut velocity) = (unit(0), unit(1) + caused.column(at) * STEP);
            let three = |of: &DVector<f64>, from: usize| Vector3::new(of[from], of[from + 1], of[from + 2]);
            let of_joints = &position + &velocity * STEP;
            let turn = three(&position, 3);
            let moved = rotation * (turn.cross(&driven) + three(&velocity, 0));
            let origin = next.tr_mul(&(rotation * three(&position, 0) + moved * STEP));
            let turned = next.tr_mul(&(rotation * turn)) + by_rate * three(&velocity, 3);
            let linear = next.tr_mul(&moved) + next.tr_mul(&in_world).cross(&turned);
            velocity.as_mut_slice()[..3].copy_from_slice(linear.as_slice());
            [[origin.as_slice(), turned.as_slice(), &of_joints.as_slice()[6..]].concat(), velocity.as_slice().to_vec()]
        };
        let columns: Vec<[Vec<f64>; 2]> = (0..caused.ncols()).map(column).collect();
        for (half, numbers) in halves.iter_mut().enumerate() {
            numbers.extend((0..size).flat_map(|row| columns.iter().map(move |column| column[half][row])));
        }
    }
    halves.concat()
}

/// The products of the rows of a matrix, which are as long as `x`, with it.
fn times_rows(rows: &[f64], x: &[f64]) -> Vec<f64> {
    rows.chunks(x.len()).map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
}

/// What a function returns, without a recursion. Of the functions that solve with the mass matrix, the solution of
/// nalgebra.
#[allow(clippy::too_many_lines)] // an arm for each function
pub(crate) fn expected(robot: &Robot, function: Function, state: &State) -> Vec<f64> {
    let State { q, qd, qdd, tau, wrench, payload, base } = state;
    let (dof, zeros) = (q.len(), vec![0.0; q.len()]);
    let fixed = BaseMotion::fixed(robot.gravity);
    let loaded = function.takes(Argument::Payload).then_some(payload);
    let torques = |q: &[f64], qd: &[f64], qdd: &[f64], base| {
        oracle::torques(robot, &Motion { joints: [q, qd, qdd], base }, loaded)
    };
    let mass_matrix = || oracle::mass_matrix(robot, q, loaded);
    let world = oracle::parts(&oracle::placement_of_base(robot));
    let still = Motion { joints: [q, &zeros, &zeros], base: BaseMotion::fixed([0.0; 3]) };
    let in_world = |(r, p): (Matrix3<f64>, Vector3<f64>)| (world.0 * r, world.0 * p + world.1);
    let tip = function.frame(robot).map_or_else(|| robot.tip(), |frame| robot.fixed_frame(frame));
    let of_tip = || oracle::jacobian(robot, &tip, q, &Vector3::zeros());
    let of_wrench = || of_wrench_at(robot, &tip, q, wrench);
    let floating_at = |q: &[f64], qd: &[f64], qdd: &[f64], base: BaseMotion<f64>| {
        let tips = robot.wrench_frames();
        let mut numbers = of_floating_base(robot, &Motion { joints: [q, qd, qdd], base }, loaded);
        if !function.takes(Argument::Wrenches) {
            return numbers;
        }
        let still = Motion { joints: [q, &zeros, &zeros], base: BaseMotion::fixed([0.0; 3]) };
        for (tip, wrench) in tips.iter().zip(at_tips(tips.len(), wrench)) {
            let (r, p) = oracle::parts(&oracle::frame(robot, tip, &still)[0]);
            let at_tip = r * Vector3::from(wrench.force);
            let moment = r * Vector3::from(wrench.moment) + p.cross(&at_tip);
            let on_base = at_tip.iter().chain(moment.iter()).copied().chain(of_wrench_at(robot, tip, q, &wrench));
            numbers.iter_mut().zip(on_base).for_each(|(number, more)| *number += more);
        }
        numbers
    };
    let floating = |qdd: &[f64], base: BaseMotion<f64>| floating_at(q, qd, qdd, base);
    // a wrench on the base, with its moment about the centre of mass
    let about_centre = |wrench: &[f64]| -> Vec<f64> {
        let (mass, moment) = oracle::first_moment(robot, q);
        let [force, about] = [&wrench[..3], &wrench[3..6]].map(Vector3::from_column_slice);
        let about = about - (moment / mass).cross(&force);
        force.iter().chain(about.iter()).copied().collect()
    };
    // the rows of a matrix from its columns
    let transposed = |columns: Vec<Vec<f64>>| -> Vec<f64> {
        (0..columns[0].len())
            .flat_map(|row| columns.iter().map(move |column| column[row]).collect::<Vec<_>>())
            .collect()
    };
    let by_rates = |qdd: &[f64]| -> Vec<f64> {
        let column = |joint| oracle::by_rate(qd, joint, |qd| torques(q, qd, qdd, fixed));
        transposed((0..dof).map(column).collect())
    };
    // with the wrenches of the tips, if the function takes them
    let with_wrenches = |q: &[f64], torques: Vec<f64>| {
        let tips = robot.wrench_frames().into_iter().filter(|_| function.takes(Argument::Wrenches));
        let parts = tips.zip(at_tips(robot.tip_count(), wrench));
        parts.fold(torques, |all, (tip, wrench)| sum(&all, &of_wrench_at(robot, &tip, q, &wrench)))
    };
    let by_positions = |qdd: &[f64]| -> Vec<f64> {
        let all = |q: &[f64]| with_wrenches(q, torques(q, qd, qdd, fixed));
        transposed((0..dof).map(|joint| oracle::by_position(robot, q, joint, all)).collect())
    };
    let solved = |right: DMatrix<f64>| {
        let matrix = DMatrix::from_row_slice(dof, dof, &flat(mass_matrix()));
        let solution = matrix.lu().solve(&right).unwrap_or_else(|| DMatrix::from_element(dof, right.ncols(), f64::NAN));
        solution.transpose().as_slice().to_vec()
    };
    match function {
        Function::InverseDynamics | Function::InverseDynamicsFromSinCos | Function::InverseDynamicsWithPayload => {
            torques(q, qd, qdd, fixed)
        }
        Function::InverseDynamicsWithWrench => sum(&torques(q, qd, qdd, fixed), &of_wrench()),
        Function::InverseDynamicsWithWrenches => with_wrenches(q, torques(q, qd, qdd, fixed)),
        Function::ForwardDynamicsWithWrenches => {
            let bias = with_wrenches(q, torques(q, qd, &zeros, fixed));
            solved(DMatrix::from_fn(dof, 1, |joint, _| tau[joint] - bias[joint]))
        }
        Function::InverseDynamicsOnMovingBase => torques(q, qd, qdd, *base),
        Function::InverseDynamicsOfFloatingBase | Function::FloatingInverseDynamicsWithPayload => floating(qdd, *base),
        Function::FloatingInverseDynamicsDerivatives => {
            let by_q = |joint| oracle::by_position(robot, q, joint, |q| floating_at(q, qd, qdd, *base));
            let by_qd = |joint| oracle::by_rate(qd, joint, |qd| floating_at(q, qd, qdd, *base));
            let turning = |omega: &[f64]| BaseMotion { omega: [omega[0], omega[1], omega[2]], ..*base };
            let by_omega = |axis| oracle::by_rate(&base.omega, axis, |omega| floating_at(q, qd, qdd, turning(omega)));
            let by_joints = [(0..dof).map(by_q).collect(), (0..dof).map(by_qd).collect()].map(transposed);
            [by_joints.concat(), transposed((0..3).map(by_omega).collect())].concat()
        }
        Function::FloatingMassMatrix | Function::FloatingMassMatrixWithPayload => {
            flat(floating_mass_matrix(robot, q, loaded))
        }
        Function::FloatingGravityTorques => {
            let gravity = rotation().transpose() * Vector3::from(robot.gravity);
            floating_at(q, &zeros, &zeros, BaseMotion::fixed(gravity.into()))
        }
        Function::FloatingBias | Function::FloatingBiasTorquesWithPayload => {
            floating(&zeros, BaseMotion { omega: base.omega, ..BaseMotion::fixed([0.0; 3]) })
        }
        Function::FloatingForwardDynamics | Function::FloatingForwardDynamicsWithPayload => {
            let bias = floating(&zeros, BaseMotion { omega: base.omega, ..BaseMotion::fixed([0.0; 3]) });
            let applied = |row: usize| if row < 6 { 0.0 } else { tau[row - 6] };
            let matrix = DMatrix::from_row_slice(6 + dof, 6 + dof, &flat(floating_mass_matrix(robot, q, loaded)));
            let right = DMatrix::from_fn(6 + dof, 1, |row, _| applied(row) - bias[row]);
            matrix.lu().solve(&right).map_or_else(|| vec![f64::NAN; 6 + dof], |x| x.as_slice().to_vec())
        }
        Function::FloatingEulerStep => next_of_floating_base(robot, state),
        Function::FloatingEulerStepDerivatives => derivatives_of_floating_step(robot, state),
        Function::ForwardDynamicsInContact => in_contact(robot, state),
        Function::CentroidalMomentumMatrix => {
            let columns = floating_mass_matrix(robot, q, None);
            transposed(columns.iter().map(|column| about_centre(column)).collect())
        }
        Function::CentroidalBias => {
            let base = BaseMotion { omega: base.omega, ..BaseMotion::fixed([0.0; 3]) };
            about_centre(&of_floating_base(robot, &Motion { joints: [q, qd, &zeros], base }, None))
        }
        Function::TipJacobians => {
            let turn = rotation();
            let of_tip = |tip: &FixedFrame| {
                let (_, origin) = oracle::parts(&oracle::frame(robot, tip, &still)[0]);
                let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
                let linear = [x, y, z].map(|axis| [axis, Vector3::zeros()]);
                let angular = [x, y, z].map(|axis| [axis.cross(&origin), axis]);
                let columns = [&linear[..], &angular, &oracle::jacobian(robot, tip, q, &Vector3::zeros())].concat();
                rows(&columns.iter().map(|parts| parts.map(|part| turn * part)).collect::<Vec<_>>())
            };
            robot.wrench_frames().iter().flat_map(of_tip).collect()
        }
        Function::TipAccelerations => {
            // of the base by hand: the oracle has frames in frame 0
            let omega = Vector3::from(base.omega);
            let motion = Motion { joints: [q, qd, &zeros], ..still };
            let of_tip = |tip: &FixedFrame| {
                let jet = oracle::frame(robot, tip, &motion);
                let (_, origin) = oracle::parts(&jet[0]);
                let [[velocity, turning], [acceleration, rate]] = oracle::rates(&jet, &Vector3::zeros());
                let linear = acceleration + 2.0 * omega.cross(&velocity) + omega.cross(&omega.cross(&origin));
                [linear, rate + omega.cross(&turning)].map(|part| rotation() * part)
            };
            robot.wrench_frames().iter().flat_map(of_tip).flat_map(|part| part.as_slice().to_vec()).collect()
        }
        Function::GravityTorques | Function::GravityTorquesWithPayload => torques(q, &zeros, &zeros, fixed),
        Function::BiasTorques | Function::BiasTorquesWithPayload => torques(q, qd, &zeros, fixed),
        Function::CoriolisTorques => {
            let [bias, gravity] = [qd, &zeros[..]].map(|qd| torques(q, qd, &zeros, fixed));
            bias.iter().zip(gravity).map(|(bias, gravity)| bias - gravity).collect()
        }
        Function::MassMatrix | Function::MassMatrixWithPayload => flat(mass_matrix()),
        Function::InverseMassMatrix => solved(DMatrix::identity(dof, dof)),
        Function::InverseMassMatrixTimesTorques => solved(DMatrix::from_column_slice(dof, 1, tau)),
        Function::ForwardDynamics | Function::ForwardDynamicsWithPayload => {
            let bias = torques(q, qd, &zeros, fixed);
            solved(DMatrix::from_fn(dof, 1, |joint, _| tau[joint] - bias[joint]))
        }
        Function::CoriolisMatrix => by_rates(&zeros).iter().map(|element| element / 2.0).collect(),
        Function::InverseDynamicsDerivatives
        | Function::InverseDynamicsDerivativesWithPayload
        | Function::InverseDynamicsDerivativesWithWrenches => [by_positions(qdd), by_rates(qdd)].concat(),
        // the multipliers are the torques of the state
        Function::TorqueGradient => {
            let weighted = |torques: Vec<f64>| vec![torques.iter().zip(tau).map(|(a, b)| a * b).sum::<f64>()];
            let by_q = |joint| oracle::by_position(robot, q, joint, |q| weighted(torques(q, qd, qdd, fixed)))[0];
            let by_qd = |joint| oracle::by_rate(qd, joint, |qd| weighted(torques(q, qd, qdd, fixed)))[0];
            let by_qdd = times(&mass_matrix(), tau);
            [(0..dof).map(by_q).collect(), (0..dof).map(by_qd).collect(), by_qdd].concat()
        }
        Function::TorqueHessian => {
            let weighted = |torques: Vec<f64>| torques.iter().zip(tau).map(|(a, b)| a * b).sum::<f64>();
            let by_q = |q: &[f64], qd: &[f64]| -> Vec<f64> {
                let along =
                    |joint| oracle::by_position(robot, q, joint, |q| vec![weighted(torques(q, qd, qdd, fixed))])[0];
                (0..dof).map(along).collect()
            };
            let by_qd = |qd: &[f64]| -> Vec<f64> {
                let along = |joint| oracle::by_rate(qd, joint, |qd| vec![weighted(torques(q, qd, qdd, fixed))])[0];
                (0..dof).map(along).collect()
            };
            let momenta = |q: &[f64]| {
                let columns = (0..dof).map(|joint| {
                    let unit: Vec<f64> = (0..dof).map(|other| f64::from(u8::from(other == joint))).collect();
                    let still = Motion { joints: [q, &zeros, &unit], base: BaseMotion::fixed([0.0; 3]) };
                    weighted(oracle::torques(robot, &still, None))
                });
                columns.collect::<Vec<f64>>()
            };
            let dq_dq: Vec<_> = (0..dof).map(|joint| oracle::by_position(robot, q, joint, |q| by_q(q, qd))).collect();
            let dq_dqd: Vec<_> = (0..dof).map(|joint| oracle::by_rate(qd, joint, |qd| by_q(q, qd))).collect();
            let dqd_dqd: Vec<_> = (0..dof).map(|joint| oracle::by_rate(qd, joint, by_qd)).collect();
            let dq_dqdd: Vec<_> = (0..dof).map(|joint| oracle::by_position(robot, q, joint, momenta)).collect();
            [flat(dq_dq), transposed(dq_dqd), flat(dqd_dqd), flat(dq_dqdd)].concat()
        }
        Function::EulerStep => {
            let qdd = self::expected(robot, Function::ForwardDynamics, state);
            let moved = |x: &[f64], by: &[f64]| x.iter().zip(by).map(|(x, by)| x + STEP * by).collect::<Vec<_>>();
            let rates = moved(qd, &qdd);
            [moved(q, &rates), rates].concat()
        }
        Function::EulerStepDerivatives => {
            let found = self::expected(robot, Function::ForwardDynamicsDerivatives, state);
            let moved = |place: usize, by: &[f64]| {
                let one = |at: usize| if at.is_multiple_of(dof + 1) { 1.0 } else { 0.0 };
                let blocks = by.chunks(dof * dof).enumerate();
                let moved = blocks.flat_map(|(kind, block)| {
                    block.iter().enumerate().map(move |(at, x)| STEP * x + if kind == place { one(at) } else { 0.0 })
                });
                moved.collect::<Vec<f64>>()
            };
            let rates = moved(1, &found);
            [moved(0, &rates), rates].concat()
        }
        Function::ForwardDynamicsDerivatives
        | Function::ForwardDynamicsDerivativesWithWrenches
        | Function::ForwardDynamicsDerivativesWithPayload => {
            let bias = with_wrenches(q, torques(q, qd, &zeros, fixed));
            let qdd = &solved(DMatrix::from_fn(dof, 1, |joint, _| tau[joint] - bias[joint]));
            if !qdd.iter().all(|x| x.is_finite()) {
                return vec![f64::NAN; 3 * dof * dof];
            }
            let by_q = solved(-DMatrix::from_row_slice(dof, dof, &by_positions(qdd)));
            let by_qd = solved(-DMatrix::from_row_slice(dof, dof, &by_rates(qdd)));
            [by_q, by_qd, solved(DMatrix::identity(dof, dof))].concat()
        }
        Function::Regressor => oracle::regressor(robot, &Motion { joints: [q, qd, qdd], base: fixed }),
        Function::FloatingKineticEnergy => {
            let velocities = [&base.velocity[..], &base.omega, qd].concat();
            let momenta = times(&floating_mass_matrix(robot, q, None), &velocities);
            vec![momenta.iter().zip(&velocities).map(|(p, v)| p * v).sum::<f64>() / 2.0]
        }
        Function::FloatingPotentialEnergy => {
            let (mass, moment) = oracle::first_moment(robot, q);
            let pose = state.given().pose();
            let rotation = Matrix3::from(pose.rotation).transpose();
            let in_world = rotation * moment + Vector3::from(pose.translation) * mass;
            vec![-Vector3::from(robot.gravity).dot(&in_world)]
        }
        Function::CentroidalMomentum => {
            let velocities = [&base.velocity[..], &base.omega, qd].concat();
            about_centre(&times(&floating_mass_matrix(robot, q, None), &velocities))
        }
        Function::FloatingRegressor => oracle::floating_regressor(robot, &Motion { joints: [q, qd, qdd], base: *base }),
        Function::ActuatorTorques => oracle::actuator_torques(robot, qd, qdd),
        Function::ForwardKinematics => pose(in_world(oracle::parts(&oracle::frame(robot, &tip, &still)[0]))),
        Function::LinkPoses => {
            (0..dof).flat_map(|index| pose(in_world(oracle::parts(&oracle::link_pose(robot, index, &still))))).collect()
        }
        Function::Jacobian => rows(&of_tip().iter().map(|it| it.map(|part| world.0 * part)).collect::<Vec<_>>()),
        Function::JacobianRateTimesVelocity => {
            let motion = Motion { joints: [q, qd, &zeros], ..still };
            let [_, parts] = oracle::rates(&oracle::frame(robot, &tip, &motion), &Vector3::zeros());
            parts.iter().flat_map(|part| (world.0 * part).as_slice().to_vec()).collect()
        }
        Function::JacobianRate | Function::JacobianDerivatives => {
            let elements = |q: &[f64]| {
                let columns = oracle::jacobian(robot, &tip, q, &Vector3::zeros());
                rows(&columns.iter().map(|it| it.map(|part| world.0 * part)).collect::<Vec<_>>())
            };
            let by: Vec<Vec<f64>> = (0..dof).map(|joint| oracle::by_position(robot, q, joint, elements)).collect();
            let by = transposed(by);
            if function == Function::JacobianDerivatives { by } else { times_rows(&by, qd) }
        }
        Function::WrenchTorques => of_wrench(),
        Function::KineticEnergy => vec![oracle::kinetic_energy(robot, q, qd, None)],
        Function::PotentialEnergy => vec![-Vector3::from(robot.gravity).dot(&oracle::first_moment(robot, q).1)],
        Function::CentreOfMass => {
            let (mass, moment) = oracle::first_moment(robot, q);
            (world.0 * (moment / mass) + world.1).as_slice().to_vec()
        }
        Function::CentreOfMassJacobian => {
            let centre = |q: &[f64]| {
                let (mass, moment) = oracle::first_moment(robot, q);
                (world.0 * (moment / mass)).as_slice().to_vec()
            };
            transposed((0..dof).map(|joint| oracle::by_position(robot, q, joint, centre)).collect())
        }
        Function::JointWrenches => {
            let needed = oracle::needed(robot, &Motion { joints: [q, qd, qdd], base: fixed }, None);
            let of_joint = |joint: usize| {
                let (r, point) = oracle::joint_frame(robot, joint, &still);
                let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
                let carried = |link: &usize| oracle::moves(robot, joint, Some(*link));
                for it in (0..dof).filter(carried).map(|link| &needed[link]) {
                    force += it.force;
                    moment += it.moment + (it.centre - point).cross(&it.force);
                }
                [r.tr_mul(&force), r.tr_mul(&moment)].iter().flat_map(|it| it.as_slice().to_vec()).collect::<Vec<_>>()
            };
            (0..dof).flat_map(of_joint).collect()
        }
        Function::MomentumAndRate | Function::MomentumAndRateWithPayload => {
            let momentum = times(&mass_matrix(), qd);
            // ṗ = τ - g + ∂T/∂q
            let energy = |q: &[f64]| vec![oracle::kinetic_energy(robot, q, qd, loaded)];
            let gravity = torques(q, &zeros, &zeros, fixed);
            let rate = |joint| tau[joint] - gravity[joint] + oracle::by_position(robot, q, joint, energy)[0];
            [momentum, (0..dof).map(rate).collect()].concat()
        }
        other => unreachable!("{other} is of closed loops, which have tests of their own"),
    }
}

/// How much the function magnifies rounding: the condition number where it solves with the mass matrix. `None` where
/// there is nothing to compare: a matrix that is not positive definite or nearly singular, a robot without mass.
pub(crate) fn magnification(robot: &Robot, function: Function, state: &State, expected: &[f64]) -> Option<f64> {
    if !expected.iter().all(|x| x.is_finite()) {
        return None;
    }
    if !function.inverts_mass() {
        return Some(1.0);
    }
    let loaded = function.takes(Argument::Payload).then_some(&state.payload);
    let matrix = match function {
        Function::FloatingForwardDynamics
        | Function::FloatingForwardDynamicsWithPayload
        | Function::FloatingEulerStep
        | Function::FloatingEulerStepDerivatives => floating_mass_matrix(robot, &state.q, loaded),
        Function::ForwardDynamicsInContact => {
            let mass = floating_mass_matrix(robot, &state.q, None);
            conditioning(&mass)?;
            let jacobians = self::expected(robot, Function::TipJacobians, state);
            let number = contact_condition(robot, &flat(mass), &jacobians);
            return (number < 1e12).then_some(number);
        }
        _ => oracle::mass_matrix(robot, &state.q, loaded),
    };
    let of = conditioning(&matrix)?;
    (of.number < 1e12).then_some(of.number)
}

/// Scale of rounding: numbers of a function that vanish are sums of larger parts.
pub(crate) fn scale(robot: &Robot, function: Function, state: &State) -> f64 {
    let needed = oracle::needed(
        robot,
        &Motion { joints: [&state.q, &state.qd, &state.qdd], base: state.base },
        Some(&state.payload),
    );
    let largest =
        needed.iter().map(|it| it.force.norm() * (1.0 + it.centre.norm()) + it.moment.norm()).fold(0.0, f64::max);
    match function {
        Function::PotentialEnergy
        | Function::FloatingPotentialEnergy
        | Function::CoriolisMatrix
        | Function::InverseDynamicsDerivatives
        | Function::FloatingInverseDynamicsDerivatives
        | Function::InverseDynamicsDerivativesWithPayload
        | Function::InverseDynamicsDerivativesWithWrenches => largest,
        Function::JacobianRate => state.qd.iter().fold(0.0, |most, qd| f64::max(most, qd.abs())),
        Function::JacobianDerivatives => 1.0,
        // the multipliers are the torques of the state
        Function::TorqueHessian => largest * state.tau.iter().fold(0.0, |most, tau| tau.abs().max(most)),
        // centripetal, one metre from an axis
        Function::JacobianRateTimesVelocity => state.qd.iter().map(|qd| qd * qd).fold(0.0, f64::max),
        Function::TipAccelerations => state.qd.iter().chain(&state.base.omega).map(|qd| qd * qd).fold(0.0, f64::max),
        _ if function.returns_torques() => largest,
        _ => 0.0,
    }
}
