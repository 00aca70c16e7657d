//! Robots on floating bases: real ones beside Pinocchio, operations of the reduced form, and laws of mechanics.
//!
//! `tests/reference/floating.py` made the robot files and the values: `rne import --whole --floating` read the URDF,
//! and so did Pinocchio, whose states have a quaternion and spatial vectors.

use nalgebra::Vector3;
use rne::{
    BaseMotion, BaseTwist, DynFloatingTorques, FloatingEulerStep, FloatingEulerStepDerivatives, FloatingIntegratorStep,
    FloatingNextState, FloatingState, Pose, Quaternion, Wrench,
};
use rne_codegen::{Argument, Compiler, Factorization, Form, Function, Output, Value};
use rne_model::{Contact, Reader, Robot};

use crate::arm::{Arm, Given, Maker, base_rotation};
use crate::check::{ROOT, Worst, conditioning, dot, error_on_scale, json, numbers, product};
use crate::tree_functions::{State, contact_condition};
use crate::trees::robot;

const TOLERANCE: f64 = 1e-12;
const FOLDER: &str = "tests/functions/floating";
const FUNCTION: Function = Function::InverseDynamicsOfFloatingBase;

const ROBOTS: [&str; 4] = ["grid_hyq", "erd_anymal_c", "grid_atlas", "h1"];

fn read(name: &str) -> Robot {
    let file = format!("{ROOT}/{FOLDER}/{name}.yaml");
    robot(&std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{file}: {error}")))
}

#[test]
fn dynamics_of_floating_robots_are_those_of_pinocchio() {
    for maker in Maker::ALL {
        let mut worst = Worst::default();
        for name in ROBOTS {
            let robot = read(name);
            let (golden, arm) = (json(&format!("{FOLDER}/{name}.golden.json")), Arm::by_no_choice(&robot, maker));
            for state in golden["states"].as_array().expect("states") {
                let array = |key: &str| numbers(&state[key]);
                let triple = |key: &str| -> [f64; 3] { array(key).try_into().expect("three numbers") };
                let [q, qd, qdd, tau] = ["q", "qd", "qdd", "tau"].map(array);
                let base = BaseMotion {
                    omega: triple("omega"),
                    omega_dot: triple("omega_dot"),
                    velocity: triple("velocity"),
                    acceleration: triple("acceleration"),
                    gravity: triple("gravity"),
                };
                let turn = array("base_rotation");
                let base_rotation = std::array::from_fn(|row| std::array::from_fn(|column| turn[3 * row + column]));
                let given =
                    Given { base, base_rotation, tau: &tau, wrench: Wrench::zero(), ..Given::of_joints(&q, &qd, &qdd) };
                let pose: [f64; 12] = array("pose").try_into().expect("twelve numbers");
                let row = |row: usize| [0, 1, 2].map(|column| pose[3 * row + column]);
                let pose = Pose { rotation: [0, 1, 2].map(row), translation: row(3) };
                for function in Function::OF_TREES.into_iter().filter(|it| state.get(it.name()).is_some()) {
                    let given = if function.takes(Argument::BasePose) { given.at(&pose) } else { given };
                    let error = error_on_scale(&arm.numbers(function, &given), &array(function.name()), 0.0);
                    let error = match function {
                        Function::FloatingForwardDynamics => {
                            let matrix = arm.runtime.floating_mass_matrix(&q).expect("one per joint");
                            error / conditioning(&matrix).expect("positive definite").number
                        }
                        Function::ForwardDynamicsInContact => {
                            let of = |function| arm.numbers(function, &given);
                            let [mass, jacobians] = [Function::FloatingMassMatrix, Function::TipJacobians].map(of);
                            error / contact_condition(&robot, &mass, &jacobians)
                        }
                        _ => error,
                    };
                    assert!(error <= TOLERANCE, "{maker}, {name}, {function}: {error:e}");
                    worst.see(name, error);
                }
                let parameters = array("parameters");
                let rows = arm.numbers(Function::FloatingRegressor, &given);
                let found = product(&rows.chunks(parameters.len()).collect::<Vec<_>>(), &parameters);
                worst.see(name, error_on_scale(&found, &array("floating_regressor_times_parameters"), 0.0));
            }
        }
        worst.at_most(TOLERANCE, &format!("floating bases, {maker}"));
        assert_eq!(worst.len(), ROBOTS.len());
    }
}

/// The matrices of its derivatives of rnea, by the tangent of its configuration and by its velocity, with a wrench at
/// each tip.
#[test]
fn derivatives_of_floating_robots_are_those_of_pinocchio() {
    for name in ROBOTS {
        let golden = json(&format!("{FOLDER}/{name}.golden.json"));
        let (state, arm) = (&golden["states"][0], Arm::by_no_choice(&read(name), Maker::Runtime).runtime);
        let array = |key: &str| numbers(&state[key]);
        let triple = |key: &str| -> [f64; 3] { array(key).try_into().expect("three numbers") };
        let base = BaseMotion {
            omega: triple("omega"),
            omega_dot: triple("omega_dot"),
            velocity: triple("velocity"),
            acceleration: triple("acceleration"),
            gravity: triple("gravity"),
        };
        let of_tip = |w: &[f64]| Wrench { force: [w[0], w[1], w[2]], moment: [w[3], w[4], w[5]] };
        let wrenches: Vec<_> = array("wrenches").chunks(6).map(of_tip).collect();
        let [q, qd, qdd] = ["q", "qd", "qdd"].map(array);
        let found = arm.floating_inverse_dynamics_derivatives(&q, &qd, &qdd, &base, &wrenches).expect("one per joint");
        let mass = arm.floating_mass_matrix(&q).expect("one per joint");
        let expected = array("derivatives_of_pinocchio");
        let (by_q, by_v) = expected.split_at(expected.len() / 2);
        for (found, expected) in found.to_pinocchio(&base, &mass).into_iter().zip([by_q, by_v]) {
            let error = error_on_scale(&found.concat(), expected, 0.0);
            assert!(error <= TOLERANCE, "{name}: {error:e}");
        }
    }
}

/// No element of joints on different branches is computed: of the 486 elements of HyQ, which has four legs of three
/// joints, at least 216 are zero in every state.
#[test]
fn derivatives_of_joints_on_different_branches_are_no_operations() {
    let robot = read("grid_hyq");
    for form in [Form::SevenSteps, Form::Reduced] {
        let function = Function::FloatingInverseDynamicsDerivatives;
        let program = Compiler::new(&robot).compile(function, form).expect("a program");
        let is_zero = |output: &Output| program.values.get(output.value) == Value::Constant(0.0);
        let (joints, rows) = (12, 18);
        let mut elements = 0;
        for (index, output) in program.outputs.iter().enumerate() {
            let by_joints = index < 2 * rows * joints;
            let (row, column) = (index / joints % rows, index % joints);
            if by_joints && row >= 6 && (row - 6) / 3 != column / 3 {
                assert!(is_zero(output), "{form}: row {row}, column {column}");
            }
            elements += usize::from(!is_zero(output));
        }
        println!("{form}: {elements} elements, {} operations", program.operations().total());
        assert!(elements <= 270, "{form}: {elements}");
    }
}

/// The numbers of a state that a step of a robot on a floating base takes and returns.
struct Floating {
    pose: Pose<f64>,
    state: State,
}

impl Floating {
    /// The state after some steps without wrenches.
    fn after(&self, arm: &Arm, steps: u32, step: f64) -> Self {
        let mut now = Self { pose: self.pose, state: self.state.clone() };
        for _ in 0..steps {
            let given = Given { wrench: Wrench::zero(), step, ..now.state.given() }.at(&now.pose);
            let next = arm.numbers(Function::FloatingEulerStep, &given);
            let triple = |from: usize| [next[from], next[from + 1], next[from + 2]];
            now.pose = Pose { rotation: [0, 3, 6].map(triple), translation: triple(9) };
            now.state.base = BaseMotion { velocity: triple(12), omega: triple(15), ..now.state.base };
            let (q, qd) = next[18..].split_at(now.state.q.len());
            (now.state.q, now.state.qd) = (q.to_vec(), qd.to_vec());
        }
        now
    }

    fn numbers(&self) -> Vec<f64> {
        let Self { pose, state: State { q, qd, base, .. } } = self;
        [pose.rotation.as_flattened(), &pose.translation, &base.velocity, &base.omega, q, qd].concat()
    }

    /// Linear and angular momentum about the centre of mass, in world axes.
    fn momentum(&self, arm: &Arm) -> Vec<f64> {
        let found = arm.numbers(Function::CentroidalMomentum, &self.state.given());
        found.chunks(3).flat_map(|part| self.pose.rotation.map(|row| dot(&row, part))).collect()
    }
}

/// Without wrenches, gravity alone changes the momentum. The rotation of the base stays orthogonal. The error of the
/// motion falls by 2 where the step halves.
#[test]
fn steps_of_a_floating_base_keep_its_momentum_and_its_rotation() {
    for maker in Maker::CODE {
        for name in ["grid_hyq", "h1"] {
            let robot = read(name);
            let (arm, time) = (Arm::by_no_choice(&robot, maker), 0.02);
            let mut state = State::random(1, robot.dof());
            state.tau.iter_mut().for_each(|tau| *tau *= 0.1);
            state.base = BaseMotion { omega: state.base.omega.map(|x| x * 0.1), ..state.base };
            let start = Floating { pose: state.given().pose(), state };
            let ends = [50_u32, 100, 200].map(|steps| start.after(&arm, steps, time / f64::from(steps)));
            let mass = robot.floating_base.as_ref().map_or(0.0, |base| base.link.mass)
                + robot.rows().map(|row| row.link.mass).sum::<f64>();
            let before = start.momentum(&arm);
            let error = |end: &Floating| {
                let gained = end.momentum(&arm).into_iter().zip(&before).map(|(after, before)| after - before);
                let weight = robot.gravity.iter().map(|g| mass * g * time).chain([0.0; 3]);
                gained.zip(weight).map(|(gained, weight)| (gained - weight).abs()).fold(0.0, f64::max)
            };
            let of_momentum = (error(&ends[0]) / error(&ends[1])).log2();
            let [first, second, third] = ends.each_ref().map(Floating::numbers);
            let distance = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let order = (distance(&first, &second) / distance(&second, &third)).log2();
            println!("{maker}, {name}: momentum {of_momentum:.3}, motion {order:.3}");
            assert!((of_momentum - 1.0).abs() < 0.1 && (order - 1.0).abs() < 0.1, "{maker}, {name}");
            let rotation = ends[2].pose.rotation_matrix();
            let error = (rotation.transpose() * rotation - nalgebra::Matrix3::identity()).abs().max();
            assert!(error < 1e-14 && rotation.determinant() > 0.0, "{maker}, {name}: {error:e}");
        }
    }
}

/// Two joints and one tip.
#[derive(rne::FloatingBase, rne::FloatingEulerStep, rne::FloatingEulerStepDerivatives)]
#[robot(path = "../../docs/satellite.yaml", form = "reduced")]
struct Satellite;

/// Many derived steps with a rotation matrix are those with a quaternion, by derived accelerations.
#[test]
fn derived_steps_with_a_matrix_are_those_with_a_quaternion() {
    let State { q, qd, tau, wrench, base, .. } = State::random(5, 2);
    let [q, qd, tau] = [q, qd, tau].map(|x| [x[0], x[1]]);
    let pose = Pose { rotation: base_rotation(), translation: [0.3, -0.2, 0.1] };
    let twist = BaseTwist { linear: [0.4, 0.7, -0.5], angular: base.omega.map(|x| 0.1 * x) };
    let orientation = Quaternion::of_rotation(&pose.rotation);
    let (mut matrix, step) = (FloatingNextState { pose, twist, q, qd }, 1e-3);
    let mut quaternion = FloatingState { orientation, position: pose.translation, twist, q, qd };
    for _ in 0..200 {
        let FloatingNextState { pose, twist, q, qd } = matrix;
        matrix = Satellite.floating_euler_step(&q, &qd, &tau, &pose, &twist, step, &[wrench]);
        let next = FloatingIntegratorStep::<2, 8, 1>::floating_quaternion_step;
        quaternion = next(&Satellite, &quaternion, &tau, &[wrench], &[0.0; 3], step);
    }
    for (found, expected) in [
        (matrix.pose.rotation.as_flattened(), quaternion.orientation.rotation().as_flattened()),
        (&matrix.pose.translation, &quaternion.position),
        (&matrix.twist.linear, &quaternion.twist.linear),
        (&matrix.twist.angular, &quaternion.twist.angular),
        (&matrix.q, &quaternion.q),
        (&matrix.qd, &quaternion.qd),
    ] {
        let error = error_on_scale(found, expected, 0.0);
        assert!(error <= TOLERANCE, "{error:e}: {found:?} {expected:?}");
    }
}

/// The derived derivatives are difference quotients of the derived step, on the manifold of the positions: third order
/// in the difference of 1e-4 of numbers up to 100.
#[test]
fn derived_derivatives_of_a_step_are_difference_quotients() {
    const NV: usize = 8;
    let State { q, qd, tau, wrench, base, .. } = State::random(7, 2);
    let [q, qd, tau] = [q, qd, tau].map(|x| [x[0], x[1]]);
    let pose = Pose { rotation: base_rotation(), translation: [0.3, -0.2, 0.1] };
    let twist = BaseTwist { linear: base.velocity, angular: base.omega };
    let (step, small) = (0.01, 1e-4);
    let orientation = Quaternion::of_rotation(&pose.rotation);
    let rotated = |quaternion: Quaternion<f64>, x: [f64; 3]| quaternion.rotation().map(|row| dot(&row, &x));
    let next = |by: &[f64]| {
        let three = |from: usize| [by[from], by[from + 1], by[from + 2]];
        let plus = |x: [f64; 3], by: [f64; 3]| [0, 1, 2].map(|at| x[at] + by[at]);
        let both = |x: [f64; 2], from: usize| [x[0] + by[from], x[1] + by[from + 1]];
        let moved = Pose {
            rotation: orientation.turned_by(three(3)).rotation(),
            translation: plus(pose.translation, rotated(orientation, three(0))),
        };
        let velocity = BaseTwist { linear: plus(twist.linear, three(8)), angular: plus(twist.angular, three(11)) };
        let [q, qd, tau] = [(q, 6), (qd, 14), (tau, 16)].map(|(x, from)| both(x, from));
        Satellite.floating_euler_step(&q, &qd, &tau, &moved, &velocity, step, &[wrench])
    };
    let by = Satellite.floating_euler_step_derivatives(&q, &qd, &tau, &pose, &twist, step, &[wrench]);
    let middle = Quaternion::of_rotation(&next(&[0.0; 18]).pose.rotation);
    for column in 0..2 * NV + 2 {
        let [after, before] = [small, -small].map(|change| {
            let mut by = [0.0; 18];
            by[column] = change;
            next(&by)
        });
        let of = |pair: &dyn Fn(&FloatingNextState<2, f64>) -> Vec<f64>| -> Vec<f64> {
            pair(&after)
                .into_iter()
                .zip(pair(&before))
                .map(|(after, before)| (after - before) / (2.0 * small))
                .collect()
        };
        let back = Quaternion { w: middle.w, x: -middle.x, y: -middle.y, z: -middle.z };
        let positions = of(&|next| {
            let turned = back.then(&Quaternion::of_rotation(&next.pose.rotation));
            // twice the vector of a small turn whose scalar is positive
            let turn = [turned.x, turned.y, turned.z].map(|x| 2.0 * x * turned.w.signum());
            [&rotated(back, next.pose.translation)[..], &turn, &next.q].concat()
        });
        let velocities = of(&|next| [&next.twist.linear[..], &next.twist.angular, &next.qd].concat());
        let found = |matrices: [[[f64; NV]; NV]; 2], of_torques: [[f64; 2]; NV]| -> Vec<f64> {
            let element = |row: usize| match column.checked_sub(2 * NV) {
                Some(joint) => of_torques[row][joint],
                None => matrices[column / NV][row][column % NV],
            };
            (0..NV).map(element).collect()
        };
        for (found, expected) in
            [(found([by.q_dq, by.q_dv], by.q_dtau), positions), (found([by.v_dq, by.v_dv], by.v_dtau), velocities)]
        {
            let error = error_on_scale(&found, &expected, 1.0);
            assert!(error <= 1e-6, "column {column}, {error:e}: {found:?} {expected:?}");
        }
    }
}

/// A step takes the error of a rotation away: what is left is its square.
#[test]
fn a_step_makes_a_rotation_orthogonal() {
    let State { q, qd, tau, wrench, base, .. } = State::random(6, 2);
    let [q, qd, tau] = [q, qd, tau].map(|x| [x[0], x[1]]);
    let twist = BaseTwist { linear: base.velocity, angular: base.omega };
    for error in [1e-4, -1e-4] {
        let rotation = base_rotation::<f64>().map(|row| row.map(|x| x * (1.0 + error)));
        let pose = Pose { rotation, translation: [0.0; 3] };
        let next = Satellite.floating_euler_step(&q, &qd, &tau, &pose, &twist, 0.1, &[wrench]).pose.rotation_matrix();
        let left = (next.transpose() * next - nalgebra::Matrix3::identity()).abs().max();
        assert!(left < 4.0 * error * error, "{left:e}");
    }
}

/// Forces of accelerations are M times them and the bias, and what they make of these forces are the accelerations.
#[test]
fn inverse_and_forward_dynamics_are_one_equation() {
    for maker in Maker::ALL {
        for (index, name) in ROBOTS.into_iter().enumerate() {
            let robot = read(name);
            let (arm, dof) = (Arm::by_no_choice(&robot, maker), robot.dof());
            let state = State::random(u64::try_from(index).expect("small"), dof);
            let of = |function, state: &State| arm.numbers(function, &state.given());
            let (torques, bias) = (of(FUNCTION, &state), of(Function::FloatingBias, &state));
            let matrix = of(Function::FloatingMassMatrix, &state);
            let BaseMotion { omega_dot, acceleration, gravity, .. } = state.base;
            let linear = [0, 1, 2].map(|axis| acceleration[axis] - gravity[axis]);
            let accelerations = [&linear[..], &omega_dot, &state.qdd].concat();
            let rows: Vec<Vec<f64>> = matrix.chunks(6 + dof).map(<[f64]>::to_vec).collect();
            let product = |row: &Vec<f64>| row.iter().zip(&accelerations).map(|(a, b)| a * b).sum::<f64>();
            let sum: Vec<f64> = rows.iter().map(product).zip(&bias).map(|(force, bias)| force + bias).collect();
            assert!(error_on_scale(&sum, &torques, 0.0) < 1e-14, "{maker}, {name}");
            let is_symmetric = (0..6 + dof).all(|i| (0..i).all(|j| rows[i][j].to_bits() == rows[j][i].to_bits()));
            assert!(is_symmetric, "{maker}, {name}");
            // no wrench acts on the base: what it needs is taken off the accelerations
            let conditioning = conditioning(&rows).expect("positive definite");
            let found = of(Function::FloatingForwardDynamics, &state);
            let given: Vec<f64> = rows.iter().map(|row| row.iter().zip(&found).map(|(a, b)| a * b).sum()).collect();
            let expected =
                [0.0; 6].into_iter().chain(state.tau.iter().copied()).zip(&bias).map(|(tau, bias)| tau - bias);
            let error = error_on_scale(&given, &expected.collect::<Vec<_>>(), 0.0);
            assert!(error / conditioning.number < 1e-15, "{maker}, {name}: {error:e}");
        }
    }
}

/// ½ vᵀ M v, and the centroidal momentum matrix times v; the potential energy where frame 0 is the world, and what it
/// is more where the robot is lifted: its weight times the height.
#[test]
fn energies_and_momentum_are_those_of_the_matrices() {
    for maker in Maker::ALL {
        for (index, name) in ROBOTS.into_iter().enumerate() {
            let robot = read(name);
            let (arm, dof) = (Arm::by_no_choice(&robot, maker), robot.dof());
            let state = State::random(20 + u64::try_from(index).expect("small"), dof);
            let given = state.given();
            let of = |function| arm.numbers(function, &given);
            let velocities = [&given.twist().to_pinocchio()[..], &state.qd].concat();
            let times = |matrix: Vec<f64>| product(&matrix.chunks(6 + dof).collect::<Vec<_>>(), &velocities);
            let energy = dot(&velocities, &times(of(Function::FloatingMassMatrix))) / 2.0;
            assert!(error_on_scale(&of(Function::FloatingKineticEnergy), &[energy], 0.0) < 1e-14, "{maker}, {name}");
            let momentum = times(of(Function::CentroidalMomentumMatrix));
            assert!(error_on_scale(&of(Function::CentroidalMomentum), &momentum, 0.0) < 1e-13, "{maker}, {name}");
            let at = |pose: &Pose<f64>| arm.numbers(Function::FloatingPotentialEnergy, &given.at(pose));
            let (world, held) = (at(&Pose::identity()), of(Function::PotentialEnergy));
            assert!(error_on_scale(&world, &held, 1.0) < 1e-14, "{maker}, {name}");
            let [mass, ..] = of(Function::FloatingMassMatrix)[..] else { unreachable!("a matrix") };
            let lifted = at(&Pose { translation: [0.3, -2.0, 1.5], ..Pose::identity() });
            assert!(error_on_scale(&lifted, &[world[0] + mass * 9.81 * 1.5], 0.0) < 1e-14, "{maker}, {name}");
        }
    }
}

/// The momentum by recursion takes fewer operations than the matrix, which has to be multiplied by the velocities yet.
#[test]
fn the_momentum_takes_fewer_operations_than_its_matrix() {
    for name in ["grid_hyq", "grid_atlas"] {
        let robot = read(name);
        for form in [Form::SevenSteps, Form::Reduced] {
            let program = |function| Compiler::new(&robot).compile(function, form).expect("a program");
            let count = |function| program(function).operations().total();
            let [momentum, matrix] = [Function::CentroidalMomentum, Function::CentroidalMomentumMatrix].map(count);
            println!("{name}, {form}: {momentum} and {matrix}");
            assert!(momentum < matrix, "{name}, {form}: {momentum} and {matrix}");
        }
    }
}

/// The regressor of the base and the links, times their parameters, is the wrench on the base and the torques with free
/// tips.
#[test]
fn the_regressor_times_the_parameters_is_inverse_dynamics() {
    for maker in Maker::ALL {
        for (index, name) in ROBOTS.into_iter().enumerate() {
            let robot = read(name);
            let (arm, dof) = (Arm::by_no_choice(&robot, maker), robot.dof());
            let state =
                State { wrench: Wrench::zero(), ..State::random(10 + u64::try_from(index).expect("small"), dof) };
            let parameters = arm.runtime.floating_inertial_parameters().concat();
            let rows = arm.numbers(Function::FloatingRegressor, &state.given());
            let found = product(&rows.chunks(parameters.len()).collect::<Vec<_>>(), &parameters);
            let error = error_on_scale(&found, &arm.numbers(FUNCTION, &state.given()), 0.0);
            assert!(error < 1e-13, "{maker}, {name}: {error:e}");
        }
    }
}

/// No element that is zero in every state is computed, and a robot with the masses of a test has as many elements as
/// its tree asks. The rows of the base have three zeros beside the mass and three on the diagonal of the first moment.
#[test]
fn factors_of_a_floating_robot_take_the_operations_that_its_elements_ask() {
    let file = |path: &str| {
        let text = std::fs::read_to_string(format!("{ROOT}/{path}")).unwrap_or_else(|error| panic!("{path}: {error}"));
        robot(&text)
    };
    // operations of Featherstone's LᵀDL for dense rows of the base, and its elements
    for (path, operations, elements) in [
        ("tests/functions/floating/grid_hyq.yaml", 849, 117),
        ("benches/trees/atlas.yaml", 3889, 351),
        ("benches/trees/g1.yaml", 3790, 341),
    ] {
        let robot = file(path);
        let found = Factorization::of(&robot, Function::FloatingForwardDynamics);
        println!("{path}: {} operations, {} elements", found.operations.total(), found.elements);
        assert_eq!(found.operations.total(), operations - 6, "{path}");
        assert_eq!(found.elements, elements - 6, "{path}");
    }
    let robot = read("grid_hyq");
    for form in [Form::SevenSteps, Form::Reduced] {
        let program = Compiler::new(&robot).compile(Function::FloatingMassMatrix, form).expect("a program");
        let is_zero = |output: &&Output| program.values.get(output.value) == Value::Constant(0.0);
        let zeros = program.outputs.iter().filter(is_zero).count();
        // both triangles
        assert_eq!(zeros, 18 * 18 - (2 * 111 - 18), "{form}");
    }
}

/// After Khalil and Kleinfinger with base parameters, a rebuilding of SYMORO counts 1534 operations for HyQ. Ours are
/// those of a build without a search, with a wrench at the tip frame, which the peer does not have.
#[test]
fn the_reduced_form_of_a_floating_robot_takes_fewer_operations_than_any_published() {
    let file = format!("{ROOT}/tests/functions/trees/hyq.yaml");
    let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{file}: {error}"));
    let trunk = "floating_base:
  name: trunk
  link:
    mass: 60.978
    com: [0.05607, 0.02149, 0.00361]
    inertia: {xx: 1.57277, yy: 8.50274, zz: 9.19649, xy: 0.02847, xz: -0.20354, yz: -0.00443}
";
    let robot = robot(&text.replacen("joints:", &format!("{trunk}joints:"), 1));
    let count = |form| Compiler::new(&robot).compile(FUNCTION, form).expect("a program").operations().total();
    let [seven_steps, reduced] = [Form::SevenSteps, Form::Reduced].map(count);
    assert_eq!([seven_steps, reduced], [2019, 1305]);
    assert!(reduced < 1534);
}

/// The spanning tree of links and 12 rotors takes 1469 operations after Khalil and Kleinfinger. Rotors on a base that
/// turns are a part of its matter.
#[test]
fn exact_rotors_on_a_floating_base_take_fewer_operations_than_bodies_of_their_own() {
    let file = format!("{ROOT}/robots/trees/mini_cheetah.yaml");
    let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{file}: {error}"));
    let (head, joints) = text.split_once("tips: ").expect("four feet");
    let joints = joints.split_once("joints:").expect("a list of joints").1;
    // the trunk of the URDF, and one tip
    let trunk = "{name: trunk, link: {mass: 3.3, com: [0, 0, 0], inertia: {xx: 0.011253, yy: 0.036203, zz: 0.042673}}}";
    let text = format!("{head}floating_base: {trunk}\ntool: {{on: fr_knee}}\njoints:{joints}");
    let robot = Reader::new("mini_cheetah").trees().couplings().read(&text).unwrap_or_else(|it| panic!("{it}")).robot;
    assert_eq!(robot.spinning_rotors().count(), 12);
    let program = Compiler::new(&robot).compile(FUNCTION, Form::Reduced).expect("a program");
    assert_eq!((program.operations().total(), program.refusals.len()), (1079, 0));
}

/// A robot that nothing touches and that falls with its joints still keeps them so without torques, and no wrench acts
/// on its base.
#[test]
fn a_robot_in_free_fall_needs_nothing() {
    for maker in Maker::ALL {
        for name in ROBOTS {
            let robot = read(name);
            let (arm, dof) = (Arm::by_no_choice(&robot, maker), robot.dof());
            let (q, zeros) = (State::random(3, dof).q, vec![0.0; dof]);
            let falling = [1.2, -3.4, -9.1];
            let base = BaseMotion { acceleration: falling, ..BaseMotion::fixed(falling) };
            let given = Given { base, ..Given::of_joints(&q, &zeros, &zeros) };
            let found = arm.numbers(FUNCTION, &given);
            assert!(found.iter().all(|x| x.abs() < 1e-12), "{maker}, {name}: {found:?}");
        }
    }
}

/// At rest, the wrench on the base carries the weight of the whole robot, which acts in its centre of mass.
#[test]
fn the_base_of_a_robot_at_rest_bears_its_weight() {
    for name in ROBOTS {
        let robot = read(name);
        let (arm, dof) = (Arm::new(&robot, Maker::Runtime), robot.dof());
        let (q, zeros) = (State::random(4, dof).q, vec![0.0; dof]);
        let base = BaseMotion::fixed(robot.gravity);
        let DynFloatingTorques { wrench, tau } = arm
            .runtime
            .inverse_dynamics_of_floating_base(&q, &zeros, &zeros, &base, &vec![Wrench::zero(); robot.tip_count()])
            .expect("arrays of the right length");
        let of_links: f64 = robot.rows().map(|row| row.link.mass).sum();
        let mass = of_links + robot.floating_base.as_ref().expect("a floating base").link.mass;
        let weight = -Vector3::from(robot.gravity) * mass;
        let centre = Vector3::from(arm.runtime.centre_of_mass(&q).expect("one per joint"));
        let (force, moment) = (Vector3::from(wrench.force), Vector3::from(wrench.moment));
        assert!((force - weight).norm() < 1e-11 * weight.norm(), "{name}: {force}");
        assert!((moment - centre.cross(&weight)).norm() < 1e-11 * weight.norm(), "{name}: {moment}");
        let held = arm.runtime.gravity_torques(&q).expect("one per joint");
        assert!(error_on_scale(&tau, &held, weight.norm()) < 1e-14, "{name}");
    }
}

/// The forces of contacts are what moves the centre of mass, and turns the robot about it: momentum by the
/// accelerations that they cause, of robots at random states. The tips do not accelerate, but for the damping.
#[test]
fn contacts_exert_the_rate_of_the_momentum() {
    for maker in Maker::ALL {
        for (index, name) in ROBOTS.into_iter().enumerate() {
            let robot = read(name);
            let (arm, dof) = (Arm::by_no_choice(&robot, maker), robot.dof());
            let state = State::random(20 + u64::try_from(index).expect("small"), dof);
            let of = |function| arm.numbers(function, &state.given());
            let found = of(Function::ForwardDynamicsInContact);
            let (x, wrenches) = found.split_at(6 + dof);
            let times = |matrix: &[f64]| product(&matrix.chunks(6 + dof).collect::<Vec<_>>(), x);
            let (map, rate) = (of(Function::CentroidalMomentumMatrix), of(Function::CentroidalBias));
            let rate: Vec<f64> = times(&map).iter().zip(&rate).map(|(a, b)| a + b).collect();
            // the linear half, in world axes
            let force = product(&base_rotation::<f64>(), &rate[..3]);
            let sum: Vec<f64> = (0..3).map(|axis| wrenches.chunks(6).map(|wrench| wrench[axis]).sum()).collect();
            let scale = wrenches.iter().fold(0.0_f64, |scale, x| scale.max(x.abs()));
            let error = error_on_scale(&sum, &force, scale);
            assert!(error < 1e-10, "{maker}, {name}: {error:e}");
            let (jacobians, lacking) = (times(&of(Function::TipJacobians)), of(Function::TipAccelerations));
            for contact in &robot.contacts {
                for row in 0..contact.rows() {
                    let place = 6 * contact.tip + row;
                    let gravity = if row < 3 { robot.gravity[row] } else { 0.0 };
                    let acceleration = jacobians[place] + lacking[place] + gravity;
                    let least = 1e-10 * scale.max(jacobians[place].abs());
                    let damped = -Contact::DAMPING * wrenches[place];
                    assert!((acceleration - damped).abs() < least, "{maker}, {name}: {acceleration:e}, {damped:e}");
                }
            }
        }
    }
}

/// Where the row of a joint begins with a turn about its axis, the reduced form and the rows of contacts count one
/// angle from different zeros: by any part of a turn, or by a right angle, so that a cosine is the negative of a sine.
#[test]
fn contacts_behind_a_turn_about_an_axis_are_proved() {
    for rpy in ["[-2.2, 0, 0]", "[-2.2, 3*pi/2, 1.2]"] {
        let robot = robot(&format!(
            "format: 2\nname: turned\nsource: invented\nconvention: standard\ngravity: [0, 0, -9.81]\n\
             floating_base: {{name: trunk, link: {{mass: 1.5, com: [0.1, 0.2, 0.3], \
             inertia: {{xx: 0.1, yy: 0.2, zz: 0.15}}}}}}\n\
             frames: [{{name: foot, on: hip, xyz: [0.1, 0.2, 0.3]}}]\ntips: [foot]\n\
             contacts: [{{tip: foot, kind: point}}]\njoints:\n  - name: hip\n    type: revolute\n    \
             at: {{xyz: [0.1, 0.3, -0.2], rpy: {rpy}}}\n    dh: {{theta: 0.7, d: 0.1, a: 0.2, alpha: 0.4}}\n    \
             link: {{mass: 1.0, com: [0.1, 0.3, 0.2], inertia: {{xx: 0.1, yy: 0.2, zz: 0.15}}}}\n"
        ));
        let program = Compiler::new(&robot).compile(Function::ForwardDynamicsInContact, Form::Reduced);
        let refusals = program.expect("a program").refusals;
        assert!(refusals.is_empty(), "{rpy}: {refusals:?}");
    }
}

/// Two points of one foot hold more than it can move: the damping of their equations takes eight digits.
#[test]
fn redundant_contacts_have_a_reduced_form() {
    let body = "{mass: 1.5, com: [0.1, 0.2, 0.3], inertia: {xx: 0.1, yy: 0.2, zz: 0.15}}";
    let robot = robot(&format!(
        "{{format: 2, name: hopper, source: own, convention: modified, gravity: [0, 0, -9.81], \
         floating_base: {{name: trunk, link: {body}}}, joints: [{{name: hip, type: revolute, \
         dh: {{theta: 0, d: 0, a: 0.2, alpha: 0.4}}, link: {body}}}], \
         frames: [{{name: heel, on: hip, xyz: [0, 0.1, 0]}}, {{name: toe, on: hip, xyz: [0.2, 0, 0.1]}}], \
         tips: [heel, toe], contacts: [{{tip: heel, kind: point}}, {{tip: toe, kind: point}}]}}"
    ));
    let program = Compiler::new(&robot).compile(Function::ForwardDynamicsInContact, Form::Reduced);
    let program = program.expect("a program");
    assert!(program.refusals.is_empty(), "{:?}", program.refusals);
    let rounding = program.proof.expect("it is proved").rounding;
    assert!(rounding > 1e-11 && rounding < 1e-7, "{rounding:e}");
}

/// HyQ stands still under the torques that its feet ask when they carry it, and the forces under them are its weight.
#[test]
fn a_quadruped_stands_on_its_feet() {
    let text = std::fs::read_to_string(format!("{ROOT}/docs/standing_hyq.yaml")).expect("HyQ");
    let q = [0.0, 0.75, -1.5, 0.0, -0.75, 1.5].repeat(2);
    let (robot, zeros) = (robot(&text), vec![0.0; 12]);
    // twice as many contacts, two at each foot: nothing tells how these share its force
    let twice = (text.replace("tips: [", "tips: [lf_toe, lh_toe, rf_toe, rh_toe, "))
        .replace("contacts:\n", "contacts:\n  - {tip: lf_toe, kind: point}\n  - {tip: rh_toe, kind: weld}\n")
        .replace("joints:\n", "TOES joints:\n");
    let toes = ["lf", "lh", "rf", "rh"]
        .map(|leg| format!("  - {{name: {leg}_toe, on: {leg}_kfe_joint, xyz: [0.33, 0, 0]}}\n"));
    let twice = crate::trees::robot(&twice.replace("TOES ", &toes.concat()));
    for maker in Maker::ALL {
        for robot in [&robot, &twice] {
            let arm = Arm::by_no_choice(robot, maker);
            let level = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            let base = BaseMotion::fixed(robot.gravity);
            let given = Given { base, base_rotation: level, ..Given::of_joints(&q, &zeros, &zeros) };
            let given = Given { wrench: Wrench::zero(), ..given };
            let weight = arm.numbers(FUNCTION, &given);
            let (of_base, hanging) = weight.split_at(6);
            let jacobians = arm.numbers(Function::TipJacobians, &given);
            let row = |tip: usize, row: usize| &jacobians[(6 * tip + row) * 18..][..18];
            // forces up at the last four tips, by the lever rule: their moments about x and y are those of the weight
            let feet = robot.tip_count() - 4;
            let [lever_y, minus_x] =
                [3, 4].map(|column| -> [f64; 4] { std::array::from_fn(|k| row(feet + k, 2)[column]) });
            let along = (of_base[4] / of_base[2] - minus_x[1]) / (minus_x[0] - minus_x[1]);
            let across = (of_base[3] / of_base[2] - lever_y[2]) / (lever_y[0] - lever_y[2]);
            let share =
                [along * across, (1.0 - along) * across, along * (1.0 - across), (1.0 - along) * (1.0 - across)];
            let carried =
                |joint: usize| (0..4).map(|k| row(feet + k, 2)[6 + joint] * share[k] * of_base[2]).sum::<f64>();
            let tau: Vec<f64> = hanging.iter().enumerate().map(|(joint, tau)| tau - carried(joint)).collect();
            let found = arm.numbers(Function::ForwardDynamicsInContact, &Given { tau: &tau, ..given });
            let (accelerations, wrenches) = found.split_at(18);
            let force = |axis: usize| wrenches.chunks(6).map(|wrench| wrench[axis]).sum::<f64>();
            let weight = of_base[2];
            assert!((force(2) - weight).abs() < 1e-5 * weight, "{maker}: {} is not {weight}", force(2));
            assert!([0, 1].iter().all(|&axis| force(axis).abs() < 1e-5 * weight), "{maker}: {wrenches:?}");
            let still = accelerations.iter().enumerate().map(|(row, x)| if row == 2 { x - 9.81 } else { *x });
            assert!(still.into_iter().all(|x| x.abs() < 1e-3), "{maker}: {accelerations:?}");
            if feet == 0 {
                for (wrench, share) in wrenches.chunks(6).zip(share) {
                    assert!((wrench[2] - share * weight).abs() < 1e-3, "{maker}: {wrenches:?}");
                }
            }
        }
    }
}

/// A satellite in free flight, by Runge and Kutta's fourth order: energy, momentum and the angular momentum about the
/// centre of mass stay what they are, in the world, while its arm swings.
#[test]
fn free_flight_conserves_energy_and_momentum() {
    // q, q̇, v and ω of the base in its axes, and its quaternion w, x, y, z
    type State = [f64; 14];
    let robot = robot(&std::fs::read_to_string(format!("{ROOT}/docs/satellite.yaml")).expect("the satellite"));
    for maker in Maker::ALL {
        let arm = Arm::by_no_choice(&robot, maker);
        let of = |function, state: &State| {
            let [velocity, omega] = [4, 7].map(|at| [state[at], state[at + 1], state[at + 2]]);
            let base = BaseMotion { omega, velocity, ..BaseMotion::fixed([0.0; 3]) };
            let given = Given { base, ..Given::of_joints(&state[..2], &state[2..4], &[0.0; 2]) };
            arm.numbers(function, &Given { tau: &[0.0; 2], ..given })
        };
        let turn = |state: &State| Quaternion { w: state[10], x: state[11], y: state[12], z: state[13] };
        // nothing weighs here
        let rate = |state: &State| -> State {
            let found = of(Function::FloatingForwardDynamics, state);
            let [v, omega] = [&state[4..7], &state[7..10]].map(Vector3::from_column_slice);
            let acceleration = Vector3::from_column_slice(&found[..3]) - omega.cross(&v);
            let half = Quaternion { w: 0.0, x: omega.x / 2.0, y: omega.y / 2.0, z: omega.z / 2.0 };
            let turning = turn(state).then(&half).to_wxyz();
            let parts = [&state[2..4], &found[6..8], acceleration.as_slice(), &found[3..6], &turning];
            parts.concat().try_into().expect("14 numbers")
        };
        let moved =
            |state: &State, by: &State, step: f64| -> State { std::array::from_fn(|i| state[i] + by[i] * step) };
        // in the world, to which the base is turned
        let conserved = |state: &State| -> Vec<f64> {
            let energy = of(Function::FloatingKineticEnergy, state);
            let momentum = of(Function::CentroidalMomentum, state);
            let turned = |part: &[f64]| product(&turn(state).rotation(), part);
            [energy, turned(&momentum[..3]), turned(&momentum[3..])].concat()
        };
        let mut state: State = [0.4, -1.1, 1.5, -2.0, 0.3, -0.2, 0.5, 0.2, 0.7, -0.4, 0.5, -0.5, 0.5, 0.5];
        let before = conserved(&state);
        let step = 1e-3;
        for _ in 0..1000 {
            let first = rate(&state);
            let second = rate(&moved(&state, &first, step / 2.0));
            let third = rate(&moved(&state, &second, step / 2.0));
            let fourth = rate(&moved(&state, &third, step));
            let mean = std::array::from_fn(|i| (first[i] + (second[i] + third[i]) * 2.0 + fourth[i]) / 6.0);
            state = moved(&state, &mean, step);
        }
        let error = error_on_scale(&conserved(&state), &before, 0.0);
        assert!(error < 1e-9, "{maker}: {error:e}");
    }
}
