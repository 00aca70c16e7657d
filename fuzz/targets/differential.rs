//! A random arm, one function in one form: the interpreted program is the runtime, and C is written of it.
#![no_main]

use std::fmt::Write as _;

use arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use rne_codegen::emit::{self, Precision};
use rne_codegen::{Arguments, Compiler, Form, Function, Interpreter};
use rne_model::Robot;
use rne_runtime::{DynArm, Scalar};

fuzz_target!(|bytes: &[u8]| {
    let _ = compare(&mut Unstructured::new(bytes));
});

/// Numbers of tables: those that fold, and those that do not.
const ANGLES: [&str; 8] = ["0", "0", "pi/2", "-pi/2", "pi", "0.3", "-1.1", "pi/3"];
const LENGTHS: [&str; 6] = ["0", "0", "0.4", "-0.25", "1", "0.4318"];
const MASSES: [&str; 5] = ["0", "1", "2.5", "0.75", "10"];
const INERTIAS: [&str; 6] = [
    "{}",
    "{xx: 0.1, yy: 0.1, zz: 0.1}",
    "{zz: 0.02, yy: 0.02}",
    "{xx: 0.3, yy: 0.25, zz: 0.2, xy: 0.01, xz: -0.02, yz: 0.03}",
    "{xx: 1, yy: 2, zz: 2.5}",
    "{zz: 0.4}",
];

fn arm(u: &mut Unstructured<'_>) -> Result<String> {
    let convention = *u.choose(&["standard", "modified"])?;
    let gravity = *u.choose(&["[0, 0, -9.81]", "[0, -9.81, 0]", "[0, 0, 0]", "[1, -2, 9]"])?;
    let mut text = format!("format: 1\nname: arm\nsource: fuzz\nconvention: {convention}\ngravity: {gravity}\n");
    if u.arbitrary()? {
        let (x, z, r) = (u.choose(&LENGTHS)?, u.choose(&LENGTHS)?, u.choose(&ANGLES)?);
        let _ = writeln!(text, "tool: {{xyz: [{x}, 0, {z}], rpy: [{r}, 0, 0]}}");
    }
    text.push_str("joints:\n");
    for _ in 0..u.int_in_range(1..=4)? {
        let kind = *u.choose(&["revolute", "revolute", "revolute", "prismatic"])?;
        let [theta, alpha] = [u.choose(&ANGLES)?, u.choose(&ANGLES)?];
        let [d, a, x, y, z] = [(); 5].map(|()| u.choose(&LENGTHS));
        let (mass, inertia) = (u.choose(&MASSES)?, u.choose(&INERTIAS)?);
        let _ = writeln!(
            text,
            "  - {{type: {kind}, dh: {{theta: {theta}, d: {}, a: {}, alpha: {alpha}}}, link: {{mass: {mass}, com: [{}, \
             {}, {}], inertia: {inertia}}}}}",
            d?, a?, x?, y?, z?
        );
    }
    Ok(text)
}

fn compare(u: &mut Unstructured<'_>) -> Result<()> {
    let text = arm(u)?;
    let robot = Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}\n{text}"));
    let function = *u.choose(&Function::ALL)?;
    let form = *u.choose(&Form::ALL)?;
    let dof = robot.dof();
    let mut numbers = |scale: f64| -> Result<Vec<f64>> {
        (0..dof).map(|_| Ok(f64::from(u.arbitrary::<i8>()?) / 128.0 * scale)).collect()
    };
    let (q, qd, qdd) = (numbers(3.0)?, numbers(2.0)?, numbers(5.0)?);
    // without the plans of a build: they take longer than all the rest
    let Ok(program) = Compiler::new(&robot).compile(function, form) else { return Ok(()) };
    let interpreted = Interpreter::new(&program).run(
        &Arguments { tau: &qdd, ..Arguments::of_joints(&q, &qd, &qdd, 0.0) },
        |value| value,
        Scalar::sin_cos,
    );
    let interpreted = interpreted.expect("arrays of the right length");
    let one = std::slice::from_ref(&program);
    let c = emit::c_code(&robot, one, Precision::Double, &"arm".parse().expect("a prefix")).map(|code| code.one_file());
    assert!(c.is_ok_and(|c| c.contains(function.name())), "{text}");
    let Some(expected) = runtime(&DynArm::from_robot(&robot), function, &q, &qd, &qdd) else { return Ok(()) };
    assert_eq!(interpreted.len(), expected.len(), "{function} of\n{text}");
    let largest = expected.iter().fold(1.0, |largest: f64, value| largest.max(value.abs()));
    for (a, b) in interpreted.iter().zip(&expected) {
        let is_equal = (a - b).abs() <= 1e-11 * largest || !a.is_finite() || !b.is_finite();
        assert!(is_equal, "{function}, {form:?}: {interpreted:?} {expected:?} of\n{text}");
    }
    Ok(())
}

/// What the runtime says, in the order of a program's outputs; `None` of functions with arguments of their own.
fn runtime(arm: &DynArm, function: Function, q: &[f64], qd: &[f64], qdd: &[f64]) -> Option<Vec<f64>> {
    let values = match function {
        Function::InverseDynamics => arm.inverse_dynamics(q, qd, qdd),
        Function::GravityTorques => arm.gravity_torques(q),
        Function::BiasTorques => arm.bias_torques(q, qd),
        Function::MassMatrix => arm.mass_matrix(q).map(|rows| rows.concat()),
        Function::CoriolisMatrix => arm.coriolis_matrix(q, qd).map(|rows| rows.concat()),
        // the joint accelerations stand for torques; singular arms have no answer
        Function::ForwardDynamics => return None,
        Function::Jacobian => arm.jacobian(q).map(|rows| rows.concat()),
        Function::JacobianRateTimesVelocity => arm.jacobian_rate_times_velocity(q, qd).map(Vec::from),
        Function::KineticEnergy => arm.kinetic_energy(q, qd).map(|energy| vec![energy]),
        Function::PotentialEnergy => arm.potential_energy(q).map(|energy| vec![energy]),
        Function::Regressor => arm.regressor(q, qd, qdd).map(|rows| rows.concat().concat()),
        _ => return None,
    };
    Some(values.expect("arrays of the right length"))
}
