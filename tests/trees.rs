//! Derived functions of a tree, against the runtime.

use rne::{DynArm, ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, Kinematics, MassMatrix};

const YAML: &str = include_str!("../docs/tree.yaml");

#[derive(InverseDynamics, MassMatrix, ForwardDynamics, InverseDynamicsDerivatives, Kinematics)]
#[robot(path = "../docs/tree.yaml")]
struct Torso;

#[derive(InverseDynamics, MassMatrix, ForwardDynamics, InverseDynamicsDerivatives, Kinematics)]
#[robot(path = "../docs/tree.yaml", form = "reduced")]
struct Reduced;

const Q: [f64; 5] = [0.4, 0.7, 0.02, 0.03, -1.1];
const QD: [f64; 5] = [0.9, -0.5, 0.3, -0.2, 1.3];
const QDD: [f64; 5] = [-1.2, 2.0, 0.7, 0.4, -0.6];

fn near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    let scale = expected.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= 1e-13 * scale, "{found} {expected}");
    }
}

/// Every function beside the runtime, and forward dynamics beside inverse dynamics.
macro_rules! is_the_runtime {
    ($arm:expr) => {{
        let runtime = DynArm::from_yaml(YAML).unwrap_or_else(|report| panic!("{report}"));
        let tau = $arm.inverse_dynamics(&Q, &QD, &QDD);
        near(&tau, &runtime.inverse_dynamics(&Q, &QD, &QDD).expect("lengths"));
        near(&$arm.forward_dynamics(&Q, &QD, &tau), &QDD);
        let mass_matrix = $arm.mass_matrix(&Q);
        near(mass_matrix.as_flattened(), &runtime.mass_matrix(&Q).expect("lengths").concat());
        assert_eq!(mass_matrix[1][4], 0.0, "the arms do not move each other");
        near($arm.jacobian(&Q).as_flattened(), &runtime.jacobian(&Q).expect("lengths").concat());
        // the derivative by the position of the left arm, by the central difference of two near states
        let step = 1e-6;
        let at = |sign: f64| $arm.inverse_dynamics(&[Q[0], Q[1] + sign * step, Q[2], Q[3], Q[4]], &QD, &QDD);
        let difference: Vec<f64> = at(1.0).iter().zip(at(-1.0)).map(|(a, b)| (a - b) / (2.0 * step)).collect();
        let by_position = $arm.inverse_dynamics_derivatives(&Q, &QD, &QDD).dq;
        for (row, difference) in by_position.iter().zip(difference) {
            assert!((row[1] - difference).abs() < 1e-7, "{} {difference}", row[1]);
        }
    }};
}

#[test]
fn both_forms_of_a_derived_tree_are_the_runtime() {
    is_the_runtime!(Torso);
    is_the_runtime!(Reduced);
}
