//! Trees: every function of random ones beside projected Newton-Euler by products of 4 × 4 matrices, and beside the
//! runtime; the same tree by rows in another order.
//!
//! A plain `cargo test` tries small trees. Thousands, of up to 20 joints, with
//! `RNE_EXHAUSTIVE=1 cargo test --release --test functions trees`; with 10 instead of 1, every tenth of them.

use std::fmt::Write as _;

use fastrand::Rng;
use nalgebra::{DMatrix, Matrix3, Vector3};
use rne::{BaseMotion, DynObserverState, Payload, Wrench};
use rne_codegen::{Algorithm, Argument, Compiler, Form, Function, Reason, Refusal};
use rne_model::{Contact, Convention, FixedFrame, FrameId, Reader, Robot};

use crate::arm::{Arm, Given, Maker, STEP, at_tips, base_rotation};
use crate::case::payload;
use crate::check::{Worst, conditioning, error_on_scale, flat};
use crate::equality::compare_at_states;
use crate::random_arms;
use crate::random_trees;
use crate::tree_oracle as oracle;
use crate::tree_oracle::Motion;

const TOLERANCE: f64 = 1e-12;

pub(crate) fn robot(yaml: &str) -> Robot {
    Reader::new("tree").trees().read(yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}")).robot
}

/// A random tree.
pub(crate) fn random(seed: u64, dof: usize) -> Robot {
    robot(&random_trees::yaml(seed, dof))
}

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
        Given { q, qd, qdd, tau, wrench: *wrench, payload: *payload, base: *base, base_rotation: base_rotation() }
    }
}

fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

fn times(matrix: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
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

/// The wrench that must act on a base that nothing holds, and the torques, with nothing at the tips.
fn of_floating_base(robot: &Robot, motion: &Motion<'_>) -> Vec<f64> {
    let [force, moment] = oracle::base_wrench(robot, motion);
    [force.as_slice(), moment.as_slice(), &oracle::torques(robot, motion, None)].concat()
}

/// The columns of the mass matrix of a robot whose base nothing holds: wrenches and torques of unit accelerations.
pub(crate) fn floating_mass_matrix(robot: &Robot, q: &[f64]) -> Vec<Vec<f64>> {
    let zeros = vec![0.0; q.len()];
    let column = |column: usize| {
        let unit = |place: usize| f64::from(u8::from(place == column));
        let (linear, angular) = ([0, 1, 2].map(unit), [3, 4, 5].map(unit));
        let qdd: Vec<f64> = (0..q.len()).map(|joint| unit(6 + joint)).collect();
        let base = BaseMotion { acceleration: linear, omega_dot: angular, ..BaseMotion::fixed([0.0; 3]) };
        of_floating_base(robot, &Motion { joints: [q, &zeros, &qdd], base })
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
    let bias = of_floating_base(robot, &Motion { joints: [&state.q, &state.qd, &zeros], base });
    let (matrix, held) = contact_system(robot, &flat(floating_mass_matrix(robot, &state.q)), &jacobians);
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
        let mut numbers = of_floating_base(robot, &Motion { joints: [q, qd, qdd], base });
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
        Function::InverseDynamicsOfFloatingBase => floating(qdd, *base),
        Function::FloatingInverseDynamicsDerivatives => {
            let by_q = |joint| oracle::by_position(robot, q, joint, |q| floating_at(q, qd, qdd, *base));
            let by_qd = |joint| oracle::by_rate(qd, joint, |qd| floating_at(q, qd, qdd, *base));
            let turning = |omega: &[f64]| BaseMotion { omega: [omega[0], omega[1], omega[2]], ..*base };
            let by_omega = |axis| oracle::by_rate(&base.omega, axis, |omega| floating_at(q, qd, qdd, turning(omega)));
            let by_joints = [(0..dof).map(by_q).collect(), (0..dof).map(by_qd).collect()].map(transposed);
            [by_joints.concat(), transposed((0..3).map(by_omega).collect())].concat()
        }
        Function::FloatingMassMatrix => flat(floating_mass_matrix(robot, q)),
        Function::FloatingBias => floating(&zeros, BaseMotion { omega: base.omega, ..BaseMotion::fixed([0.0; 3]) }),
        Function::FloatingForwardDynamics => {
            let bias = floating(&zeros, BaseMotion { omega: base.omega, ..BaseMotion::fixed([0.0; 3]) });
            let applied = |row: usize| if row < 6 { 0.0 } else { tau[row - 6] };
            let matrix = DMatrix::from_row_slice(6 + dof, 6 + dof, &flat(floating_mass_matrix(robot, q)));
            let right = DMatrix::from_fn(6 + dof, 1, |row, _| applied(row) - bias[row]);
            matrix.lu().solve(&right).map_or_else(|| vec![f64::NAN; 6 + dof], |x| x.as_slice().to_vec())
        }
        Function::ForwardDynamicsInContact => in_contact(robot, state),
        Function::CentroidalMomentumMatrix => {
            let columns = floating_mass_matrix(robot, q);
            transposed(columns.iter().map(|column| about_centre(column)).collect())
        }
        Function::CentroidalBias => {
            let base = BaseMotion { omega: base.omega, ..BaseMotion::fixed([0.0; 3]) };
            about_centre(&of_floating_base(robot, &Motion { joints: [q, qd, &zeros], base }))
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
            let momenta = times(&floating_mass_matrix(robot, q), &velocities);
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
            about_centre(&times(&floating_mass_matrix(robot, q), &velocities))
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
fn magnification(robot: &Robot, function: Function, state: &State, expected: &[f64]) -> Option<f64> {
    if !expected.iter().all(|x| x.is_finite()) {
        return None;
    }
    if !function.inverts_mass() {
        return Some(1.0);
    }
    let loaded = function.takes(Argument::Payload).then_some(&state.payload);
    let matrix = match function {
        Function::FloatingForwardDynamics => floating_mass_matrix(robot, &state.q),
        Function::ForwardDynamicsInContact => {
            let mass = floating_mass_matrix(robot, &state.q);
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

/// Trees in all, and those that a plain `cargo test` tries, which have few joints.
const TREES: u64 = 2040;
const SOME: u64 = 24;

/// One tree in so many is written by the choices that a build makes for it, if it has few joints; the others by none,
/// which is sooner found.
const CHOSEN: u64 = 10;

/// 2 to 5 joints of most trees, 6 to 10 of a quarter, 11 to 20 of one in twelve: how long a tree takes to compile grows
/// with the square of its joints.
pub(crate) fn dof(seed: u64) -> usize {
    let round = seed / 12;
    let joints = match seed % 12 {
        0 if random_arms::one_in().is_some() => 11 + round % 10,
        1..=3 if random_arms::one_in().is_some() => 6 + round % 5,
        _ => 2 + seed % 4,
    };
    usize::try_from(joints).expect("small")
}

/// Every function of a tree, and those of frames at each of its frames, by every maker.
fn compare(seed: u64, worst: &mut Worst) {
    let (dof, mut robot) = (dof(seed), random(seed, dof(seed)));
    robot.rotors = seed.is_multiple_of(3);
    let state = State::random(seed, dof);
    let at_frames = (0..robot.frames.len()).map(|frame| robot.clone().at_frame(FrameId::Named(frame)));
    for robot in [robot.clone()].into_iter().chain(at_frames) {
        let arms = Maker::ALL.map(|maker| match maker {
            Maker::Code(_) if dof > 5 || !seed.is_multiple_of(CHOSEN) => Arm::by_no_choice(&robot, maker),
            _ => Arm::new(&robot, maker),
        });
        for function in
            Function::OF_TREES.into_iter().filter(|function| robot.at.is_none() || function.of_frame().is_some())
        {
            let expected = expected(&robot, function, &state);
            let Some(magnification) = magnification(&robot, function, &state, &expected) else { continue };
            let scale = scale(&robot, function, &state);
            for (arm, maker) in arms.iter().zip(Maker::ALL) {
                let found = arm.numbers(function, &state.given());
                let error = error_on_scale(&found, &expected, scale) / magnification;
                assert!(error <= TOLERANCE, "{maker}, tree {seed}, {function} of {:?}: {error:e}", robot.at);
                worst.see(function.name(), error);
            }
        }
    }
}

#[test]
fn every_function_of_a_tree_is_projected_newton_euler() {
    let trees = random_arms::one_in().map_or(SOME, |one_in| TREES / one_in);
    let worst = random_arms::of_each(&(0..trees).collect::<Vec<_>>(), compare);
    worst.at_most(TOLERANCE, &format!("{trees} trees"));
    assert_eq!(worst.len(), Function::OF_TREES.len(), "every function is compared");
}

/// Torques are the columns of the regressor that are kept times the values of the base parameters.
#[test]
fn base_parameters_of_a_tree_give_its_torques() {
    let mut worst = Worst::default();
    for seed in 0..random_arms::one_in().map_or(6, |one_in| 300 / one_in) {
        let robot = random(seed, dof(seed));
        let (arm, state) = (Arm::new(&robot, Maker::Runtime).runtime, State::random(seed, robot.dof()));
        let base = arm.base_parameters();
        let values: Vec<f64> = base.parameters.iter().map(|base| base.value).collect();
        let matrix = base.regressor(&arm, &state.q, &state.qd, &state.qdd).expect("one per joint");
        let expected = expected(&robot, Function::InverseDynamics, &state);
        let scale = scale(&robot, Function::InverseDynamics, &state);
        worst.see("τ", error_on_scale(&times(&matrix, &values), &expected, scale));
    }
    worst.at_most(TOLERANCE, "base parameters of trees");
}

/// After two ticks: the low-pass of what the oracle's momentum changes faster than its rate.
#[test]
fn an_observer_of_a_tree_sees_the_external_torques() {
    let (gain, period) = (20.0_f64, 0.01);
    for seed in 0..6 {
        let robot = random(seed, dof(seed));
        let (arm, dof) = (Arm::new(&robot, Maker::Runtime).runtime, robot.dof());
        let mut observer = DynObserverState::new(dof, gain, period);
        let [before, now] = [seed, seed + 1000].map(|seed| State::random(seed, dof));
        let found = [&before, &now].map(|it| observer.update(&arm, &it.q, &it.qd, &it.tau).expect("one per joint"));
        let ticks = [&before, &now].map(|state| expected(&robot, Function::MomentumAndRate, state));
        let weight = 1.0 - (-std::f64::consts::TAU * gain * period).exp();
        let external = |joint: usize| {
            let [change, rate] = [ticks[1][joint] - ticks[0][joint], ticks[1][dof + joint] + ticks[0][dof + joint]];
            weight * (change / period - rate / 2.0)
        };
        let expected: Vec<f64> = (0..dof).map(external).collect();
        assert_eq!(found[0], vec![0.0; dof]);
        let error = error_on_scale(&found[1], &expected, scale(&robot, Function::InverseDynamics, &now));
        assert!(error <= TOLERANCE, "tree {seed}: {error:e}");
    }
}

#[test]
fn code_of_trees_is_the_runtime() {
    for maker in Maker::CODE {
        let mut worst = Worst::default();
        for seed in 0..8 {
            let dof = 2 + usize::try_from(seed).expect("small") % 3;
            compare_at_states(&Arm::new(&random(seed, dof), maker), maker, &mut worst);
        }
        worst.at_most(TOLERANCE, &format!("trees, {maker}"));
    }
}

/// The first of four legs on a base, each with the first axis in another direction: a quadruped whose trunk is held.
fn legs(count: usize) -> Robot {
    let places = [("lf", "pi/2", 0.3), ("rf", "-pi/2", 0.3), ("lh", "pi/2", -0.3), ("rh", "-pi/2", -0.3)];
    let mut yaml = "{format: 2, name: quadruped, source: own, convention: modified, gravity: [0, 0, -9.81], \
                    tool: {on: lf3}, joints: ["
        .to_owned();
    for (name, gamma, d) in places.into_iter().take(count) {
        let hip = format!("gamma: {gamma}, b: 0.1, alpha: pi/2, a: 0.2, theta: 0, d: {d}");
        let _ =
            write!(yaml,
            "{{name: {name}1, parent: base, type: revolute, dh: {{{hip}}}, link: {{mass: 2, com: [0.01, 0.02, 0.15],
               inertia: {{xx: 0.05, yy: 0.055, zz: 0.006, xy: 0.001, xz: -0.002, yz: 0.003}}}}}},
             {{name: {name}2, type: revolute, dh: {{alpha: pi/2, a: 0.08, theta: 0, d: 0}}, link: {{mass: 2.5,
               com: [0.15, -0.03, 0.02], inertia: {{xx: 0.004, yy: 0.027, zz: 0.028, xy: -0.003}}}}}},
             {{name: {name}3, type: revolute, dh: {{alpha: 0, a: 0.35, theta: 0, d: 0}}, link: {{mass: 0.9,
               com: [0.12, 0.01, 0], inertia: {{xx: 0.001, yy: 0.013, zz: 0.013, xy: 0.0002}}}}}}, "
        );
    }
    yaml.push_str("]}");
    robot(&yaml)
}

/// Every function that has a reduced recursion is written by it on trees, and costs less than the seven steps.
#[test]
fn trees_have_the_reduced_recursion() {
    for robot in [legs(4), random(1, 4), random(2, 5), random(3, 6)] {
        let compiler = Compiler::new(&robot);
        let mut seen = 0;
        for function in Function::OF_TREES.into_iter().filter(|function| Algorithm::is_planned(*function)) {
            let [plain, reduced] = [Form::SevenSteps, Form::Reduced].map(|form| compiler.compile(function, form));
            let (plain, reduced) = (plain.expect("a program"), reduced.expect("a program"));
            if matches!(reduced.refusals[..], [Refusal { reason: Reason::DividesByZero, .. }]) {
                continue; // links without mass behind a joint
            }
            assert!(reduced.refusals.is_empty(), "{} {function}: {:?}", robot.name, reduced.refusals);
            assert!(reduced.proof.is_some(), "{} {function}", robot.name);
            let [plain, reduced] = [plain, reduced].map(|program| program.operations().total());
            assert!(reduced < plain, "{} {function}: {reduced} of {plain}", robot.name);
            seen += 1;
        }
        assert!(seen > 10, "{}: {seen} functions", robot.name);
    }
}

/// A joint does not move the links of another branch: no element of M between them is computed, and none of its factors
/// fills. So four legs take four times the operations of one.
#[test]
fn zeros_of_branches_are_not_computed() {
    for function in [Function::MassMatrix, Function::ForwardDynamics, Function::InverseMassMatrix] {
        for form in Form::ALL {
            let [one, four] = [1, 4].map(|count| {
                let program = Compiler::new(&legs(count)).compile(function, form).expect("a program");
                program.operations().total()
            });
            assert!(four <= 4 * one, "{form} {function}: {four} for four legs, {one} for one");
        }
    }
}

/// Rows in another order, each still below its parent: the same torques by name.
#[test]
fn the_order_of_rows_changes_no_torque() {
    for seed in 0..40 {
        let dof = 3 + usize::try_from(seed).expect("small") % 8;
        let robot = random(seed, dof);
        let state = State::random(seed, dof);
        // any joint whose parent stands already is next
        let (mut rng, mut order) = (Rng::with_seed(seed), Vec::new());
        while order.len() < dof {
            let next = rng.usize(0..dof);
            if !order.contains(&next) && robot.parent(next).is_none_or(|parent| order.contains(&parent)) {
                order.push(next);
            }
        }
        let place = |joint: usize| order.iter().position(|other| *other == joint).expect("all are in it");
        let mut other = robot.clone();
        other.tip_on = robot.tip().on.map(place);
        other.joints = order.iter().map(|&joint| robot.joints[joint].clone()).collect();
        for (joint, &old) in other.joints.iter_mut().zip(&order) {
            let placement = robot.joints[old].branch.map_or(rne_model::Transform::IDENTITY, |branch| branch.placement);
            joint.branch = Some(rne_model::FixedFrame { on: robot.parent(old).map(place), placement });
        }
        let ordered = |values: &[f64]| -> Vec<f64> { order.iter().map(|&joint| values[joint]).collect() };
        let (q, qd, qdd) = (ordered(&state.q), ordered(&state.qd), ordered(&state.qdd));
        let [arm, other] = [&robot, &other].map(|robot| Arm::new(robot, Maker::Runtime));
        let expected = ordered(&arm.inverse_dynamics_with_wrench(&state.q, &state.qd, &state.qdd, &state.wrench));
        let found = other.inverse_dynamics_with_wrench(&q, &qd, &qdd, &state.wrench);
        let error = error_on_scale(&found, &expected, scale(&robot, Function::InverseDynamics, &state));
        assert!(error <= TOLERANCE, "tree {seed}: {error:e}");
    }
}

/// Placements: `gamma` and `b` of a modified row are an `at`.
#[test]
fn gamma_and_b_are_a_placement() {
    let file = |row: &str, at: &str| {
        robot(&format!(
            "{{format: 2, name: x, source: own, convention: modified, gravity: [0, 0, -9.81], tool: {{on: c}}, joints: [
            {{name: a, type: revolute, dh: {{theta: 0.1, d: 0.2, a: 0.3, alpha: 0.4}}, link: {{mass: 1}}}},
            {{name: b, type: revolute, dh: {{theta: 0.1, d: 0.2, a: 0.3, alpha: 0.4}}, link: {{mass: 1}}}},
            {{name: c, parent: a, {at} type: prismatic, dh: {{{row} theta: 0.5, d: 0.6, a: 0.7, alpha: 0.8}},
              link: {{mass: 2}}}}]}}"
        ))
    };
    let by_row = file("gamma: pi/3, b: 0.25,", "");
    assert_eq!(by_row, file("", "at: {xyz: [0, 0, 0.25], rpy: [0, 0, pi/3]},"));
    assert_eq!((by_row.convention, by_row.parent(2)), (Convention::Modified, Some(0)));
}

/// The robots of `robots/trees` by their plans: branches, followers, rotors, tips. A plain `cargo test` leaves out
/// those of more than ten coordinates but one.
#[test]
fn code_of_shipped_trees_is_the_runtime() {
    let is_tried = |name: &str, robot: &Robot| robot.dof() <= 10 || name == "mini_cheetah" || shipped::is_exhaustive();
    for maker in Maker::CODE {
        let mut worst = Worst::default();
        for file in rne_robots::TREES {
            let checked = Reader::new(file.name).trees().couplings().read(file.yaml);
            if is_tried(file.name, &checked.unwrap_or_else(|report| panic!("{report}")).robot) {
                compare_at_states(
                    Arm::from_file(&format!("robots/trees/{}.yaml", file.name), maker),
                    maker,
                    &mut worst,
                );
            }
        }
        worst.at_most(TOLERANCE, &format!("shipped trees, {maker}"));
    }
}
