//! Operation counts of every function.

use rne_codegen::{Form, Function};

use crate::arm::{Arm, Maker};
use crate::golden::ROBOTS;

/// Products and sums of SymPyBotics' code by base parameters for an arm with the geometry of the PUMA 560, whatever its
/// inertias: what another generator reached.
const SYMPYBOTICS: [(Function, usize, usize); 2] =
    [(Function::GravityTorques, 50, 28), (Function::MassMatrix, 289, 212)];

/// Products, sums and divisions that the reduced form has come down to.
const REACHED: [(&str, Function, [usize; 3]); 17] = [
    ("robots/puma560.yaml", Function::GravityTorques, [16, 7, 0]),
    ("robots/puma560.yaml", Function::BiasTorques, [128, 92, 0]),
    ("robots/puma560.yaml", Function::CoriolisTorques, [126, 89, 0]),
    ("robots/puma560.yaml", Function::InverseDynamics, [145, 118, 0]),
    ("robots/puma560.yaml", Function::MassMatrix, [81, 61, 0]),
    ("robots/puma560.yaml", Function::CoriolisMatrix, [323, 230, 0]),
    ("robots/puma560.yaml", Function::ForwardDynamics, [299, 228, 6]),
    ("robots/puma560.yaml", Function::InverseDynamicsDerivatives, [693, 530, 0]),
    ("robots/puma560.yaml", Function::TorqueHessian, [1073, 864, 0]),
    ("robots/panda.yaml", Function::TorqueHessian, [2377, 1976, 0]),
    ("tests/functions/puma_geometry.yaml", Function::GravityTorques, [27, 17, 0]),
    ("tests/functions/puma_geometry.yaml", Function::BiasTorques, [212, 190, 0]),
    ("tests/functions/puma_geometry.yaml", Function::InverseDynamics, [222, 214, 0]),
    ("tests/functions/puma_geometry.yaml", Function::MassMatrix, [133, 116, 0]),
    ("tests/functions/puma_geometry.yaml", Function::CoriolisMatrix, [527, 414, 0]),
    ("tests/functions/puma_geometry.yaml", Function::ForwardDynamics, [431, 375, 6]),
    ("tests/functions/puma_geometry.yaml", Function::InverseDynamicsDerivatives, [1055, 863, 0]),
];

fn counts(file: &str, function: Function, form: Form) -> [usize; 3] {
    let counts = Arm::from_file(file, Maker::Code(form)).program(function).operations();
    [counts.mul, counts.add, counts.div]
}

#[test]
fn counts_stay_as_low_as_they_are() {
    for (file, function, reached) in REACHED {
        let counts = counts(file, function, Form::Reduced);
        println!("{file:40} {:30} {counts:3?}", function.name());
        let is_higher = counts.iter().zip(reached).any(|(count, reached)| *count > reached);
        assert!(!is_higher, "{file}, {function}: {counts:?} against {reached:?}");
    }
}

#[test]
fn the_geometry_of_the_puma_with_any_inertias_is_below_sympybotics() {
    for (function, products, sums) in SYMPYBOTICS {
        let [mul, add, div] = counts("tests/functions/puma_geometry.yaml", function, Form::Reduced);
        println!("{function}: {mul}/{add}, SymPyBotics {products}/{sums}");
        assert!(mul <= products && add <= sums && div == 0, "{function}: {mul}/{add}");
    }
}

/// Prints all, and finds no function that the reduced form makes longer.
#[test]
fn no_function_is_longer_in_the_reduced_form() {
    for form in [Form::SevenSteps, Form::Reduced] {
        println!("\nproducts + sums + divisions, {}", form.name());
        println!("{:32}{}", "", ROBOTS.iter().map(|name| format!("{name:>10.9}")).collect::<Vec<_>>().concat());
        for function in Function::OF_TREES {
            let total = |name: &String| counts(&format!("robots/{name}.yaml"), function, form).iter().sum::<usize>();
            println!(
                "{:32}{}",
                function.name(),
                ROBOTS.iter().map(|name| format!("{:10}", total(name))).collect::<Vec<_>>().concat()
            );
        }
    }
    for (name, function) in ROBOTS.iter().flat_map(|name| Function::OF_TREES.map(|function| (name, function))) {
        let [plain, reduced] = [Form::SevenSteps, Form::Reduced]
            .map(|form| counts(&format!("robots/{name}.yaml"), function, form).iter().sum::<usize>());
        assert!(reduced <= plain, "{name}, {function}: {reduced} against {plain}");
    }
}
