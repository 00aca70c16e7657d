//! The arm with its rotors: G² Jm in torques, mass matrix, forward dynamics and kinetic energy, in the runtime and in
//! generated code.

use rne_codegen::{Compiler, Form, Function};
use rne_model::Robot;

use crate::arm::{Arm, Maker, of_runtime};
use crate::case::{Case, cases, largest, sum};
use crate::check::{ROOT, Worst, conditioning, dot, error_on_scale, product, relative_error};

const TOLERANCE: f64 = 1e-12;

/// The arms of random cases with their rotors; some have none. The cases have been compiled, these are not.
fn with_rotors(maker: Maker, property: impl Fn(&Case, &Arm, &mut Worst)) {
    let mut worst = Worst::default();
    let mut resisting = 0;
    let every = if maker == Maker::Runtime { 1 } else { 3 };
    for case in cases(maker).iter().step_by(every) {
        let arm = Arm::new(&case.robot.clone().with_rotors(), maker);
        resisting += usize::from(arm.robot.has_rotors());
        property(case, &arm, &mut worst);
    }
    assert!(resisting >= 3, "{resisting} arms have rotors");
    worst.at_most(TOLERANCE, &format!("with rotors, {maker}"));
}

/// G² Jm of each joint.
fn inertias(robot: &Robot) -> Vec<f64> {
    let of = |motor: rne_model::Motor| motor.gear_ratio * motor.gear_ratio * motor.inertia;
    robot.joints.iter().map(|joint| joint.motor.map_or(0.0, of)).collect()
}

#[test]
fn torques_mass_matrix_and_energy_agree() {
    for maker in Maker::ALL {
        with_rotors(maker, |case, arm, worst| {
            let Case { q, qd, qdd, .. } = case;
            let (mass, bias) = (arm.mass_matrix(q), arm.bias_torques(q, qd));
            let tau = arm.inverse_dynamics(q, qd, qdd);
            let rotors = inertias(&case.robot);
            let scale = largest(&tau).max(largest(&bias)).max(largest(&rotors));
            // what stands on the diagonal is what the bare arm has, and the rotors
            for (i, (row, bare)) in mass.iter().zip(case.mass()).enumerate() {
                let expected: Vec<f64> =
                    bare.iter().enumerate().map(|(j, x)| x + if i == j { rotors[i] } else { 0.0 }).collect();
                worst.see("M", error_on_scale(row, &expected, largest(&rotors)));
            }
            worst.see("M q̈ + bias", error_on_scale(&sum(&product(&mass, qdd), &bias), &tau, scale));
            let energy = arm.kinetic_energy(q, qd);
            worst.see("T", relative_error(&[energy], &[0.5 * dot(qd, &product(&mass, qd))]));
            worst.see("bias", relative_error(&bias, &case.arm.bias_torques(q, qd)));
            // the motors have nothing left but friction
            let all = sum(&case.tau(), &case.arm.actuator_torques(qd, qdd));
            worst.see("τ of arm and motor", error_on_scale(&sum(&tau, &arm.actuator_torques(qd, qdd)), &all, scale));
            let loaded = arm.inverse_dynamics_with_wrench(q, qd, qdd, &case.wrench);
            let bare = case.arm.inverse_dynamics_with_wrench(q, qd, qdd, &case.wrench);
            let resistance: Vec<f64> = rotors.iter().zip(qdd).map(|(rotor, qdd)| rotor * qdd).collect();
            worst.see("with a wrench", error_on_scale(&loaded, &sum(&bare, &resistance), scale));
            let loaded = arm.inverse_dynamics_with_payload(q, qd, qdd, &case.payload);
            let bare = case.arm.inverse_dynamics_with_payload(q, qd, qdd, &case.payload);
            worst.see("with a payload", error_on_scale(&loaded, &sum(&bare, &resistance), scale));
        });
    }
}

#[test]
fn forward_dynamics_undoes_inverse_dynamics() {
    for maker in Maker::ALL {
        with_rotors(maker, |case, arm, worst| {
            let Case { q, qd, qdd, .. } = case;
            let Some(condition) = conditioning(&arm.mass_matrix(q)) else { return };
            let back = arm.forward_dynamics(q, qd, &arm.inverse_dynamics(q, qd, qdd));
            if condition.number < 1e8 {
                worst.see("q̈", error_on_scale(&back, qdd, 1.0) / condition.number.max(1.0));
            }
        });
    }
}

#[test]
fn seven_steps_are_the_runtime_in_every_bit() {
    let maker = Maker::Code(Form::SevenSteps);
    with_rotors(maker, |case, arm, _| {
        for function in [
            Function::InverseDynamics,
            Function::InverseDynamicsWithWrench,
            Function::InverseDynamicsWithPayload,
            Function::InverseDynamicsOnMovingBase,
            Function::InverseDynamicsOfFloatingBase,
            Function::FloatingMassMatrix,
            Function::FloatingForwardDynamics,
            Function::FloatingInverseDynamicsWithPayload,
            Function::FloatingMassMatrixWithPayload,
            Function::FloatingForwardDynamicsWithPayload,
            Function::FloatingInverseDynamicsDerivatives,
            Function::MassMatrix,
            Function::ForwardDynamics,
            Function::InverseMassMatrix,
            Function::KineticEnergy,
            Function::ActuatorTorques,
            Function::MassMatrixWithPayload,
            Function::ForwardDynamicsWithPayload,
            Function::MomentumAndRateWithPayload,
        ] {
            let expected = of_runtime(&arm.runtime, function, &case.given());
            if expected.iter().all(|x| x.is_finite()) {
                assert_eq!(arm.numbers(function, &case.given()), expected, "{}, {function}", arm.robot.name);
            }
        }
    });
}

/// Without gravity and friction, all power of the actuators becomes kinetic energy: that of the rotors too.
#[test]
fn power_becomes_energy() {
    for maker in Maker::ALL {
        with_rotors(maker, |case, arm, worst| {
            let Case { q, qd, qdd, .. } = case;
            let torques = arm.inverse_dynamics(q, qd, qdd);
            let gravity = arm.gravity_torques(q);
            let power: f64 = qd.iter().zip(torques.iter().zip(&gravity)).map(|(qd, (tau, g))| qd * (tau - g)).sum();
            // dT/dt by dual numbers
            let speeding = crate::case::along(qd, qdd);
            let rate = arm.kinetic_energy(&case.moving(), &speeding).derivative;
            let scale = largest(&torques).max(largest(&gravity)) * largest(qd);
            worst.see("Ṫ", error_on_scale(&[rate], &[power], scale));
        });
    }
}

/// P. Corke's toolbox has the rotors in its mass matrix of the PUMA 560: `p560.inertia(qz)`, as its manual prints it.
#[test]
fn the_puma_has_its_published_mass_matrix() {
    let text = std::fs::read_to_string(format!("{ROOT}/robots/puma560.yaml")).expect("a robot file");
    let robot = Robot::from_yaml(&text).expect("a robot").with_rotors();
    let diagonal = [3.9611_f64, 4.4566, 0.9387, 0.1924, 0.1713, 0.1941];
    for maker in Maker::ALL {
        let matrix: Vec<Vec<f64>> = Arm::by_no_choice(&robot, maker).mass_matrix(&[0.0; 6]);
        for (i, expected) in diagonal.into_iter().enumerate() {
            assert!((matrix[i][i] - expected).abs() < 5.1e-5, "{maker}: {} is not {expected}", matrix[i][i]);
        }
        assert!((matrix[1][2] - 0.3727).abs() < 5.1e-5 && (matrix[0][1] + 0.1627).abs() < 5.1e-5, "{maker}");
    }
}

#[test]
fn one_link_by_hand() {
    let yaml = "{format: 1, name: geared, source: own, convention: standard, gravity: [0, -9.81, 0], joints: [
        {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2, com: [-0.3, 0, 0], inertia: {zz: 0.1}},
         motor: {inertia: 2.0e-4, gear_ratio: -50, viscous: 1.0e-3}}]}";
    let robot = Robot::from_yaml(yaml).unwrap_or_else(|report| panic!("{report}")).with_rotors();
    let (q, qd, qdd) = (0.4_f64, 1.5, -2.0);
    let inertia = 0.1 + 2.0 * 0.5 * 0.5 + 2.0e-4 * 2500.0;
    let gravity = 2.0 * 9.81 * 0.5 * q.cos();
    for maker in Maker::ALL {
        let arm = Arm::new(&robot, maker);
        let near =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-14, "{maker}: {found}, {expected}");
        near(arm.inverse_dynamics(&[q], &[qd], &[qdd])[0], inertia * qdd + gravity);
        near(arm.forward_dynamics(&[q], &[qd], &[3.0])[0], (3.0 - gravity) / inertia);
        near(arm.kinetic_energy(&[q], &[qd]), 0.5 * inertia * qd * qd);
        near(arm.actuator_torques(&[qd], &[qdd])[0], 2500.0 * 1.0e-3 * qd);
    }
}

#[test]
fn an_arm_without_motors_stays_the_same_code() {
    let text = std::fs::read_to_string(format!("{ROOT}/robots/planar2.yaml")).expect("a robot file");
    let bare = Robot::from_yaml(&text).expect("a robot");
    let robot = bare.clone().with_rotors();
    assert!(!robot.has_rotors());
    for form in Form::ALL {
        for function in Function::OF_TREES {
            let compiled = |robot: &Robot| Compiler::new(robot).compile(function, form).expect("a program");
            let [with, without] = [&robot, &bare].map(|robot| rne_emit::rust_file(robot, &[compiled(robot)]));
            assert_eq!(with, without, "{function}, {form}");
        }
    }
}
