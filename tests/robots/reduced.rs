//! The reduced form of every robot, compiled: independent torques, and single precision.

use rne::Wrench;
use rne_codegen::Function;
use serde_json::Value;

use crate::golden::{call, numbers, relative_error};
use crate::shipped::{Shipped, Visitor, reduced, seven_steps};
use crate::single_precision::SinglePrecision;

/// Largest error relative to the largest torque of the state.
const TOLERANCE: f64 = 1e-11;

/// How much less precise than the seven steps a form may be in single precision.
const FACTOR: f64 = 4.0;

struct Golden;

impl Visitor for Golden {
    fn visit<const DOF: usize, R: Shipped<DOF>>(&mut self, robot: &R) {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reference");
        let text = std::fs::read_to_string(format!("{folder}/{}.golden.json", R::NAME)).expect("golden values");
        let golden: Value = serde_json::from_str(&text).expect("JSON");
        let mut worst = 0.0_f64;
        for state in golden["states"].as_array().expect("states") {
            let array = |key: &str| -> [f64; DOF] { numbers(&state[key]).try_into().expect("one number per joint") };
            let (q, qd, qdd) = (array("q"), array("qd"), array("qdd"));
            let [fx, fy, fz, nx, ny, nz] = numbers(&state["wrench"]).try_into().expect("six numbers");
            let wrench = Wrench { force: [fx, fy, fz], moment: [nx, ny, nz] };
            let (gravity, coriolis) = (array("gravity"), array("coriolis"));
            for (function, expected) in [
                (Function::InverseDynamics, array("tau")),
                (Function::InverseDynamicsFromSinCos, array("tau")),
                (Function::InverseDynamicsWithWrench, array("tau_wrench")),
                (Function::GravityTorques, gravity),
                (Function::BiasTorques, std::array::from_fn(|joint| gravity[joint] + coriolis[joint])),
            ] {
                let torques = call(robot, function, &q, &qd, &qdd, &wrench);
                worst = worst.max(relative_error(&torques, &expected));
            }
        }
        println!("{:16} worst error {worst:.1e} of max |tau|", R::NAME);
        assert!(worst <= TOLERANCE, "{}: {worst}", R::NAME);
    }
}

#[test]
fn reduced_torques_are_the_independent_ones() {
    reduced::visit_all(&mut Golden);
}

#[test]
fn single_precision_is_not_much_worse_than_that_of_the_seven_steps() {
    let [mut faithful, mut shorter] = [(); 2].map(|()| SinglePrecision::default());
    seven_steps::visit_all(&mut faithful);
    reduced::visit_all(&mut shorter);
    println!("worst error of single precision, of max |tau|: seven steps, reduced");
    for (index, (robot, faithful)) in faithful.worst.into_iter().enumerate() {
        let shorter = shorter.worst[index].1;
        println!("{robot:16} {faithful:.1e}  {shorter:.1e}");
        assert!(shorter <= FACTOR * faithful, "{robot}, reduced: {shorter:.1e} against {faithful:.1e}");
    }
}
