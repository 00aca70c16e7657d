//! Y(q, q̇, q̈) π with inertial parameters π that are known at run time: it is the torque of an arm whose file names its
//! ten parameters per link, and so are the derivatives. Beside dual numbers through the regressor of the runtime.

use fastrand::Rng;
use rne::{Dual, DynArm, Scalar};
use rne_codegen::{Arguments, Compiler, Form, Function, Interpreter};
use rne_model::{Reader, Robot};

use crate::arm::Number;
use crate::check::{Worst, dot, error_on_scale};

/// The parameters of a link in the order of the regressor.
const NAMES: [&str; 10] = ["m", "hx", "hy", "hz", "jxx", "jxy", "jxz", "jyy", "jyz", "jzz"];
const TOLERANCE: f64 = 1e-11;

/// An arm whose links are parameters, all ten of each about the origin of the link frame.
fn robot(convention: &str, kinds: &[&str]) -> Robot {
    let (mut parameters, mut joints) = (Vec::new(), Vec::new());
    for (index, kind) in kinds.iter().enumerate() {
        let link = index + 1;
        let [m, hx, hy, hz, jxx, jxy, jxz, jyy, jyz, jzz] = NAMES.map(|name| format!("{name}{link}"));
        let values = [2.0, 0.1, -0.2, 0.3, 0.9, 0.02, -0.01, 0.8, 0.05, 0.7];
        parameters.extend(NAMES.iter().zip(values).map(|(name, value)| format!("{name}{link}: {value}")));
        joints.push(format!(
            "{{type: {kind}, dh: {{theta: 0.{link}, d: 0.2, a: 0.3, alpha: 1.{link}}}, link: {{mass: {m}, \
             first_moment: [{hx}, {hy}, {hz}], inertia_about: origin, \
             inertia: {{xx: {jxx}, xy: {jxy}, xz: {jxz}, yy: {jyy}, yz: {jyz}, zz: {jzz}}}}}}}"
        ));
    }
    let yaml = format!(
        "{{format: 1, name: of_parameters, source: own, convention: {convention}, gravity: [0.5, 1, -9.81], \
         parameters: {{{}}}, joints: [{}]}}",
        parameters.join(", "),
        joints.join(", ")
    );
    let names: Vec<String> = parameters.iter().map(|pair| pair.split(':').next().unwrap_or("").to_owned()).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let checked = Reader::new("of_parameters").run_time(&names).read(&yaml);
    checked.unwrap_or_else(|report| panic!("{report}\n{yaml}")).robot
}

/// What code of a function returns.
fn of_code<T: Scalar>(
    robot: &Robot,
    (function, form): (Function, Form),
    [q, qd, qdd, multipliers]: [&[T]; 4],
    parameters: &[T],
) -> Vec<T> {
    let program = Compiler::new(robot).compile(function, form).expect("it compiles");
    let [q, qd, qdd, tau, parameters] =
        [q, qd, qdd, multipliers, parameters].map(|x| x.iter().copied().map(Number).collect::<Vec<_>>());
    let arguments =
        Arguments { tau: &tau, parameters: &parameters, ..Arguments::of_joints(&q, &qd, &qdd, Number(T::zero())) };
    let sin_cos = |Number(angle): Number<T>| {
        let (sine, cosine) = Scalar::sin_cos(angle);
        (Number(sine), Number(cosine))
    };
    let found = Interpreter::new(&program).run(&arguments, |constant| Number(T::from_f64(constant)), sin_cos);
    found.expect("arrays of the right length").into_iter().map(|Number(x)| x).collect()
}

/// Y π at dual numbers.
fn product(arm: &DynArm, [q, qd, qdd]: [&[Dual<f64>]; 3], parameters: &[f64]) -> Vec<Dual<f64>> {
    let rows = arm.regressor(q, qd, qdd).expect("one per joint");
    let of_row = |row: &Vec<[Dual<f64>; 10]>| {
        let elements = row.iter().flatten().zip(parameters);
        elements.fold(Dual::constant(0.0), |sum, (&element, &x)| sum + element * Dual::constant(x))
    };
    rows.iter().map(of_row).collect()
}

fn moving(x: &[f64], along: Option<usize>) -> Vec<Dual<f64>> {
    let one = |i: usize| f64::from(u8::from(along == Some(i)));
    x.iter().enumerate().map(|(i, &value)| Dual { value, derivative: one(i) }).collect()
}

#[test]
fn derivatives_of_the_regressor_times_parameters_are_those_of_code_with_run_time_parameters() {
    let (mut rng, mut worst) = (Rng::with_seed(11), Worst::default());
    for kinds in [&["revolute"; 3][..], &["revolute", "prismatic", "revolute"], &["prismatic", "revolute"]] {
        for convention in ["standard", "modified"] {
            let robot = robot(convention, kinds);
            let (arm, dof) = (DynArm::from_robot(&robot), robot.dof());
            assert_eq!(robot.run_time.names.len(), 10 * dof);
            let mut numbers = |count: usize| -> Vec<f64> { (0..count).map(|_| 4.0 * rng.f64() - 2.0).collect() };
            // parameters that no body has: nothing in the product asks for a body
            let (state, mut parameters) = ([(); 4].map(|()| numbers(dof)), numbers(10 * dof));
            // the centre of mass is the first moment by the mass
            parameters.iter_mut().step_by(10).for_each(|mass| *mass = mass.abs() + 1.0);
            let [q, qd, qdd, multipliers] = &state;
            let joints: [&[f64]; 3] = [q, qd, qdd];
            // of each torque, by each joint
            let by = |kind: usize| -> Vec<f64> {
                let column = |joint: usize| {
                    let [q, qd, qdd] = [0, 1, 2].map(|other| moving(joints[other], (other == kind).then_some(joint)));
                    product(&arm, [&q, &qd, &qdd], &parameters)
                };
                let columns: Vec<_> = (0..dof).map(column).collect();
                (0..dof).flat_map(|row| columns.iter().map(move |column| column[row].derivative)).collect()
            };
            let weighted = |matrix: &[f64]| -> Vec<f64> {
                let column = |at: usize| matrix.iter().skip(at).step_by(dof).copied().collect::<Vec<_>>();
                (0..dof).map(|at| dot(&column(at), multipliers)).collect()
            };
            let [by_q, by_qd, by_qdd] = [0, 1, 2].map(by);
            let gradient = [&by_q, &by_qd, &by_qdd].map(|matrix| weighted(matrix)).concat();
            let regressor = arm.regressor(q, qd, qdd).expect("one per joint").concat().concat();
            let torques = product(&arm, joints.map(|x| moving(x, None)).each_ref().map(Vec::as_slice), &parameters);
            for form in Form::ALL {
                let of = |function| {
                    let state = [&q[..], qd, qdd, multipliers];
                    of_code(&robot, (function, form), state, &parameters)
                };
                let expected = [
                    (Function::InverseDynamics, torques.iter().map(|x| x.value).collect()),
                    (Function::InverseDynamicsDerivatives, [&by_q[..], &by_qd].concat()),
                    (Function::MassMatrix, by_qdd.clone()),
                    (Function::TorqueGradient, gradient.clone()),
                ];
                for (function, expected) in expected {
                    worst.see(function.name(), error_on_scale(&of(function), &expected, 1.0));
                }
                // by the parameters: the regressor itself
                let still = state.each_ref().map(|x| moving(x, None));
                for parameter in 0..10 * dof {
                    let state = still.each_ref().map(Vec::as_slice);
                    let parameters = moving(&parameters, Some(parameter));
                    let found = of_code(&robot, (Function::InverseDynamics, form), state, &parameters);
                    let found: Vec<f64> = found.iter().map(|torque| torque.derivative).collect();
                    let expected: Vec<f64> = regressor.iter().skip(parameter).step_by(10 * dof).copied().collect();
                    worst.see("by the parameters", error_on_scale(&found, &expected, 1.0));
                }
            }
        }
    }
    worst.at_most(TOLERANCE, "the regressor times parameters");
}
