//! Arrays of another size: what is needed and what was given, for every layout; and states that are arrays.

use rne_machine::{Arguments, Array, CompiledArm, Destination, Function};
use rne_model::Robot;

const YAML: &str = include_str!("../../../docs/desk_arm.yaml");

fn arm() -> CompiledArm {
    CompiledArm::from_robot(&Robot::from_yaml(YAML).unwrap())
}

fn said(states: usize, q: Array<'_, f64>, results: Destination<'_, f64>) -> String {
    arm().run(Function::GravityTorques, states, &Arguments::new().q(q), results).unwrap_err().to_string()
}

#[test]
fn arguments_say_what_is_needed_and_given() {
    let numbers = [0.1; 6];
    let mut room = [7.0; 6];
    let columns = [&numbers[..2], &numbers[..2], &numbers[..1]];
    for (q, expected) in [
        (Array::Rows(&numbers[..5]), "for each of 2 states, but 5 were given and 6 are needed"),
        (Array::Same(&numbers[..2]), "for each of 2 states, but 2 were given and 3 are needed"),
        (Array::Columns(&columns[..2]), "for each of 2 states, but 2 columns were given and 3 are needed"),
        (Array::Columns(&columns), "for each of 2 states, but column 3 has 1 and 2 are needed"),
        (
            Array::Strided { numbers: &numbers[..5], state: 3, element: 1 },
            "for each of 2 states, but 5 were given and 6 are needed",
        ),
    ] {
        let found = said(2, q, Destination::Rows(&mut room));
        assert_eq!(found, format!("`q` must have 3 numbers {expected}"));
    }
    let found = arm().run_one(Function::GravityTorques, &Arguments::new().q(Array::Rows(&numbers)), &mut [0.0; 3]);
    assert_eq!(found.unwrap_err().to_string(), "`q` must have 3 numbers, but 6 were given and 3 are needed");
    assert_eq!(room, [7.0; 6], "nothing is written");
}

#[test]
fn results_say_what_is_needed_and_given() {
    let numbers = [0.1; 6];
    let q = || Array::Rows(&numbers);
    let [mut room, mut other] = [[7.0; 6]; 2];
    let needed = "the memory for the result must hold 3 numbers for each of 2 states, but";
    assert_eq!(said(2, q(), Destination::Rows(&mut room[..4])), format!("{needed} 4 were given and 6 are needed"));
    let two = vec![&mut room[..2], &mut other[..2]];
    assert_eq!(said(2, q(), Destination::Columns(two)), format!("{needed} 2 columns were given and 3 are needed"));
    let arm = arm();
    let found = arm.run_one(Function::GravityTorques, &Arguments::new().q(Array::Rows(&numbers[..3])), &mut room[..2]);
    let needed = "the memory for the result must hold 3 numbers, but";
    assert_eq!(found.unwrap_err().to_string(), format!("{needed} 2 were given and 3 are needed"));
}

#[test]
fn states_may_be_arrays() {
    let states = vec![[0.1, 0.2, 0.3], [-0.4, 0.5, 0.6]];
    let [mut flat, mut nested] = [[0.0; 6]; 2];
    let run = |arguments: &Arguments<'_, f64>, room: &mut [f64]| {
        arm().run(Function::GravityTorques, 2, arguments, Destination::Rows(room)).unwrap();
    };
    run(&Arguments::new().q(Array::Rows(states.as_flattened())), &mut flat);
    run(&Arguments::new().q(&states), &mut nested);
    assert!(flat.iter().any(|torque| *torque != 0.0) && flat == nested);
    run(&Arguments::new().q(&[[0.1, 0.2, 0.3], [-0.4, 0.5, 0.6]]), &mut nested);
    assert_eq!(flat, nested);
    run(&Arguments::new().q(&states[..]), &mut nested);
    assert_eq!(flat, nested);
}
