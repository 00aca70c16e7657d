//! The table is complete and in order.

use super::table::{CAPABILITIES, Capability, Function, TABLE};
use super::{Length, Shape};

#[test]
fn entries_stand_in_the_order_of_the_variants() {
    for (index, entry) in TABLE.iter().enumerate() {
        assert_eq!(entry.function as usize, index, "{}", entry.name);
        assert_eq!(Function::ALL[index], entry.function);
        assert_eq!(entry.name.parse(), Ok(entry.function));
    }
}

#[test]
fn every_entry_is_complete() {
    for entry in TABLE {
        let texts = [entry.name, entry.summary, entry.output, entry.listed];
        assert!(texts.iter().all(|text| !text.is_empty()), "{}", entry.name);
        assert!(!entry.arguments.is_empty(), "{}", entry.name);
        let copies = TABLE.iter().filter(|other| other.name == entry.name).count();
        assert_eq!(copies, 1, "{}", entry.name);
    }
}

#[test]
fn the_functions_of_a_capability_stand_beside_each_other() {
    let functions: Vec<Function> =
        Capability::ALL.iter().flat_map(|capability| capability.functions()).copied().collect();
    assert_eq!(functions, Function::ALL);
    assert_eq!(Capability::InverseDynamics.functions(), Function::TORQUES);
    for capability in Capability::ALL {
        for function in capability.functions() {
            assert_eq!(function.capability(), capability);
        }
    }
}

#[test]
fn what_returns_torques_has_one_number_per_joint() {
    for function in Function::ALL {
        if function.returns_torques() || function.returns_accelerations() {
            assert_eq!(*function.shape(), Shape::Array(Length::Joints, &Shape::Number), "{function}");
        }
    }
}

#[test]
fn names_stand_in_the_order_of_the_variants() {
    for (index, (capability, name)) in CAPABILITIES.iter().enumerate() {
        assert_eq!(*capability as usize, index);
        assert_eq!(format!("{capability:?}"), *name);
    }
}
