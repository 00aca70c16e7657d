//! Two dense arms, in which nothing folds, against independent values at 32 states each.

use rne::{DynArm, Payload, Scalar, Wrench};
use rne_codegen::{Arguments, Compiler, Form, Function, Interpreter};
use rne_model::Robot;
use serde_json::Value;

#[test]
fn torques_of_dense_arms_are_the_independent_ones() {
    for name in ["dense7", "dense6_2p"] {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/dense");
        let read = |file: String| std::fs::read_to_string(format!("{folder}/{file}")).expect("a file");
        let robot = Robot::from_yaml(&read(format!("{name}.yaml"))).unwrap_or_else(|report| panic!("{report}"));
        let arm = DynArm::from_robot(&robot);
        let golden: Value = serde_json::from_str(&read(format!("{name}.golden.json"))).expect("JSON");
        let programs = Function::TORQUES
            .map(|function| Compiler::new(&robot).compile(function, Form::SevenSteps).expect("finite"));
        let mut worst = 0.0_f64;
        for state in golden["states"].as_array().expect("states") {
            let array = |key: &str| -> Vec<f64> {
                state[key].as_array().expect("an array").iter().map(|x| x.as_f64().expect("a number")).collect()
            };
            let (q, qd, qdd) = (array("q"), array("qd"), array("qdd"));
            // these values were made with the wrench that the environment exerts on the robot: the opposite sign
            let [fx, fy, fz, nx, ny, nz] = array("wrench").try_into().expect("six numbers");
            let wrench = Wrench { force: [-fx, -fy, -fz], moment: [-nx, -ny, -nz] };
            let arguments =
                Arguments { force: wrench.force, moment: wrench.moment, ..Arguments::of_joints(&q, &qd, &qdd, 0.0) };
            for program in &programs {
                let (expected, runtime) = match program.function {
                    Function::InverseDynamics => (array("tau"), arm.inverse_dynamics(&q, &qd, &qdd)),
                    Function::InverseDynamicsWithWrench => {
                        (array("tau_wrench"), arm.inverse_dynamics_with_wrench(&q, &qd, &qdd, &wrench))
                    }
                    // they are no others' values: of nothing
                    Function::InverseDynamicsWithPayload => {
                        (array("tau"), arm.inverse_dynamics_with_payload(&q, &qd, &qdd, &Payload::none()))
                    }
                    Function::InverseDynamicsFromSinCos => {
                        let (sin, cos): (Vec<f64>, Vec<f64>) = q.iter().map(|&q| Scalar::sin_cos(q)).unzip();
                        (array("tau"), arm.inverse_dynamics_from_sin_cos(&sin, &cos, &q, &qd, &qdd))
                    }
                    Function::GravityTorques => (array("grav"), arm.gravity_torques(&q)),
                    Function::BiasTorques => (array("nle"), arm.bias_torques(&q, &qd)),
                    _ => unreachable!("no torques of a fixed base"),
                };
                let runtime = runtime.expect("the right length");
                let interpreted = Interpreter::new(program).run(&arguments, f64::from_f64, Scalar::sin_cos);
                assert_eq!(interpreted.as_ref(), Some(&runtime), "{name}, {}", program.function);
                let scale = expected.iter().fold(0.0_f64, |scale, torque| scale.max(torque.abs()));
                // `f64::max` drops what is not a number
                assert!(runtime.iter().chain(&expected).all(|torque| torque.is_finite()), "{name}: {runtime:?}");
                let error = runtime.iter().zip(&expected).map(|(a, b)| (a - b).abs() / scale);
                worst = error.fold(worst, f64::max);
            }
        }
        println!("{name:12} worst error {worst:.1e} of max |tau|");
        assert!(worst <= 1e-12, "{name}: {worst}");
    }
}
