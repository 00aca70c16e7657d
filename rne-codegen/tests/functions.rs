//! The table of functions is complete and in order, and what names parse to.

use rne_codegen::{Capability, Form, Function, Length, Shape};

#[test]
fn names_are_read_back_and_no_two_are_the_same() {
    for function in Function::ALL {
        assert_eq!(rne_codegen::function_named(function.name()), Ok(function));
        assert!(!function.summary().is_empty() && !function.arguments().is_empty(), "{function}");
    }
    for form in Form::ALL {
        assert_eq!(form.name().parse(), Ok(form));
    }
    for capability in Capability::ALL {
        assert_eq!(format!("{capability:?}"), capability.name());
    }
    let message = "fast".parse::<Form>().expect_err("no form").to_string();
    assert!(message.starts_with("`fast` is not a valid form; the valid words are `seven_steps`, "), "{message}");
    // a list of all functions would hide the near one
    let of_function = |word: &str| rne_codegen::function_named(word).expect_err("no function").to_string();
    assert_eq!(of_function("mass_matix"), "`mass_matix` is not a valid function; did you mean `mass_matrix`?");
    let far = of_function("foo");
    assert!(far.starts_with("`foo` is not a valid function; there are ") && far.len() < 150, "{far}");
}

#[test]
fn every_function_is_of_one_capability() {
    let mut functions: Vec<Function> = Capability::ALL.iter().flat_map(|capability| capability.functions()).collect();
    functions.sort_unstable();
    assert_eq!(functions, Function::ALL);
    assert!(Capability::InverseDynamics.functions().eq(Function::TORQUES));
    for capability in Capability::ALL {
        assert!(capability.functions().all(|function| function.capability() == capability));
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
