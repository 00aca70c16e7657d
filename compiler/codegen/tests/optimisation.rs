//! Derivatives for optimisers without rounding, in the fields of the proof: reverse mode against forward mode, and the
//! derivatives of the accelerations against those of the torques.

use rne_codegen::plan::{Formulation, Reference};
use rne_codegen::{Compiler, ExactFunction, Form, Function, Name, Quantity, Residue};
use rne_model::{Reader, Robot};

fn robots() -> impl Iterator<Item = Robot> {
    ["puma560", "panda", "ur5", "scara_cobra600", "stanford"].into_iter().map(|name| {
        let file = format!("{}/../../robots/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        let yaml = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{file}: {error}"));
        Robot::from_yaml(&yaml).unwrap_or_else(|report| panic!("{report}"))
    })
}

/// Rows times a column.
fn product(rows: &[Residue], column: impl Fn(usize) -> Residue, dof: usize) -> Vec<Residue> {
    rows.chunks(dof)
        .map(|row| row.iter().enumerate().fold(Residue::ZERO, |sum, (at, element)| sum + *element * column(at)))
        .collect()
}

#[test]
fn reverse_mode_is_forward_mode() {
    for robot in robots() {
        let dof = robot.dof();
        let [gradient, derivatives, mass] =
            [Function::TorqueGradient, Function::InverseDynamicsDerivatives, Function::MassMatrix]
                .map(|function| ExactFunction::new(&robot, function));
        for point in 1..=3 {
            let multiplier = |at: usize| gradient.argument(point, Name::scalar(Quantity::Multiplier, at + 1));
            let by_state = derivatives.at(point);
            // λᵀ A is Aᵀ λ
            let column = |matrix: usize, column: usize| {
                (0..dof).map(|row| by_state[(matrix * dof + row) * dof + column]).collect::<Vec<_>>()
            };
            let columns: Vec<Residue> = (0..2 * dof).flat_map(|at| column(at / dof, at % dof)).collect();
            let expected = [product(&columns, multiplier, dof), product(&mass.at(point), multiplier, dof)].concat();
            assert_eq!(gradient.at(point), expected, "{}", robot.name);
        }
    }
}

#[test]
fn derivatives_of_accelerations_have_the_inverse_mass_matrix() {
    for robot in robots() {
        let dof = robot.dof();
        let [derivatives, inverse] = [Function::ForwardDynamicsDerivatives, Function::InverseMassMatrix]
            .map(|function| ExactFunction::new(&robot, function).at(1));
        assert_eq!(derivatives[2 * dof * dof..], inverse, "{}", robot.name);
        assert!(derivatives[..2 * dof * dof].iter().any(|element| !element.is_zero()), "{}", robot.name);
    }
}

#[test]
fn the_mass_matrix_times_the_accelerations_of_torques_is_the_torques() {
    for robot in robots() {
        let [accelerations, mass] = [Function::InverseMassMatrixTimesTorques, Function::MassMatrix]
            .map(|function| ExactFunction::new(&robot, function));
        for point in 1..=3 {
            let found = accelerations.at(point);
            let torque = |at: usize| accelerations.argument(point, Name::scalar(Quantity::AppliedTorque, at + 1));
            let expected: Vec<_> = (0..robot.dof()).map(torque).collect();
            assert_eq!(product(&mass.at(point), |at| found[at], robot.dof()), expected, "{}", robot.name);
        }
    }
}

/// No wrench changes the inverse of the mass matrix, and a payload does.
#[test]
fn derivatives_by_torques_are_the_inverse_of_the_mass_matrix_with_the_load() {
    for robot in robots() {
        let dof = robot.dof();
        let at = |function| ExactFunction::new(&robot, function).at(1);
        let by_torques = |function| at(function).split_off(2 * dof * dof);
        let wrenches = by_torques(Function::ForwardDynamicsDerivativesWithWrenches);
        assert_eq!(wrenches, at(Function::InverseMassMatrix), "{}", robot.name);
        let payload = by_torques(Function::ForwardDynamicsDerivativesWithPayload);
        let mass = at(Function::MassMatrixWithPayload);
        for column in 0..dof {
            let found = product(&mass, |row| payload[row * dof + column], dof);
            let unit: Vec<_> = (0..dof).map(|row| Residue::integer(u64::from(row == column))).collect();
            assert_eq!(found, unit, "{}", robot.name);
        }
    }
}
/// λᵀτ has the rates in a quadratic form, whose gradient is its Hessian times the rates.
#[test]
fn the_hessian_is_that_of_a_quadratic_form_of_the_rates() {
    for robot in robots() {
        let dof = robot.dof();
        let [hessian, gradient] =
            [Function::TorqueHessian, Function::TorqueGradient].map(|function| ExactFunction::new(&robot, function));
        for point in 1..=3 {
            let blocks = hessian.at(point);
            let blocks: Vec<_> = blocks.chunks(dof * dof).collect();
            let rate = |at: usize| hessian.argument(point, Name::scalar(Quantity::Rate, at + 1));
            assert_eq!(product(blocks[2], rate, dof), gradient.at(point)[dof..2 * dof], "{}", robot.name);
            for block in [blocks[0], blocks[2]] {
                let is_symmetric = (0..dof * dof).all(|at| block[at] == block[at % dof * dof + at / dof]);
                assert!(is_symmetric, "{}", robot.name);
            }
        }
    }
}

/// At accelerations that are solved for, a torque is the torque that was given, and the forces on a free base are zero:
/// no fold may take that for a reason that their derivatives vanish.
#[test]
fn derivatives_at_solved_accelerations_do_not_fold_by_what_is_solved() {
    let file = format!("{}/../../docs/satellite.yaml", env!("CARGO_MANIFEST_DIR"));
    let yaml = std::fs::read(&file).unwrap_or_else(|error| panic!("{file}: {error}"));
    let satellite = Reader::new("satellite").trees().read(&yaml).unwrap_or_else(|report| panic!("{report}")).robot;
    let floating = [(satellite, Function::FloatingEulerStepDerivatives)];
    let functions = [Function::ForwardDynamicsDerivatives, Function::EulerStepDerivatives];
    for (robot, function) in robots().flat_map(|robot| functions.map(|of| (robot.clone(), of))).chain(floating) {
        let reference = Reference::of(&robot, function).unwrap_or_else(|error| panic!("{error}"));
        let proof = reference.proof(function, Formulation::numbered(&robot, function));
        assert!(proof.is_ok(), "{}, {function}: {proof:?}", robot.name);
    }
}

/// The formulas of this robot, whose rotor turns with one joint, give a number and a value that is computed one name.
#[test]
fn a_quantity_that_is_written_twice_has_two_names() {
    let yaml = "format: 2\nname: rotor\nsource: x\nconvention: modified\ngravity: [0, 0, 0]\njoints:\n\
        - {name: j1, type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}}\n\
        - {name: j2, type: revolute, at: {rpy: [1, 0, 0]}, dh: {theta: 0, d: 0, a: 0, alpha: 0}}\n\
        - {name: j3, type: revolute, dh: {theta: 0, d: 0, a: 1, alpha: 0}, link: {mass: 1, first_moment: [0, 1, 0]}}\n\
        motors:\n- {turns: {j3: 1}, rotor: {axis: [1, 0, 1], inertia: 1}}\n";
    let read = Reader::new("rotor").trees().couplings().read(yaml.as_bytes());
    let robot = read.unwrap_or_else(|report| panic!("{report}")).robot;
    let program = Compiler::new(&robot).compile(Function::ForwardDynamicsDerivatives, Form::Reduced);
    let program = program.unwrap_or_else(|error| panic!("{error}"));
    assert!(program.proof.is_some() && program.refusals.is_empty(), "{:?}", program.refusals);
}
