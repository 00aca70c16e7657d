//! The table of functions is complete and in order, and what names parse to.

use rne_codegen::{Argument, Axes, Base, Capability, Form, Function, Length, Load, Shape, What};

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

/// The name that the grammar of docs/reference/function-names.md gives.
fn by_grammar(Axes { what, base, load, loops }: Axes) -> String {
    let floating = if base == Base::Floating { "floating_" } else { "" };
    // these are about loops alone
    let is_of_closure = matches!(what, What::ClosureStep | What::LoopMap | What::LoopMapRateTimesVelocity);
    let loops = if loops && !is_of_closure { "_of_loops" } else { "" };
    let moving = if base == Base::Moving { "_on_moving_base" } else { "" };
    let load = match load {
        Load::Free => "",
        Load::Wrench => "_with_wrench",
        Load::Wrenches => "_with_wrenches",
        Load::Payload => "_with_payload",
    };
    format!("{floating}{what}{loops}{moving}{load}")
}

/// The names of the document's table of names that will change, and of no others, differ from the grammar.
#[test]
fn names_follow_the_grammar() {
    let document = include_str!("../../../docs/reference/function-names.md");
    let table = document.split("## ").find(|part| part.starts_with("Names that will change")).expect("a section");
    let rows = table.lines().filter_map(|line| line.strip_prefix("| `")?.strip_suffix("` |")?.split_once("` | `"));
    let will_change: Vec<(&str, &str)> = rows.collect();
    assert!(!will_change.is_empty());
    for function in Function::ALL {
        let new = will_change.iter().find(|(old, _)| *old == function.name()).map(|(_, new)| *new);
        assert_eq!(by_grammar(function.axes()), new.unwrap_or(function.name()), "{function}");
        assert_eq!(Function::find(function.axes()), Some(function));
    }
    let is_old = |(old, _): &(&str, &str)| Function::named(old).is_some();
    assert!(will_change.iter().all(is_old), "{will_change:?}");
}

/// A load, loops and a base each add their own arguments to those of what is computed, in one order for all.
#[test]
fn arguments_follow_the_parts_of_the_name() {
    use Argument::{
        Accelerations, Base as Motion, BasePose, BaseRotation, BaseTwist, BaseVelocity, Cosines, Multipliers, Passive,
        Payload, Positions, Rates, Sines, Step, Torques, Wrench, Wrenches,
    };
    const ORDER: [Argument; 17] = [
        Sines,
        Cosines,
        Positions,
        Passive,
        Rates,
        Accelerations,
        Torques,
        Multipliers,
        Motion,
        BaseVelocity,
        BasePose,
        BaseTwist,
        BaseRotation,
        Step,
        Wrench,
        Payload,
        Wrenches,
    ];
    for function in Function::ALL {
        let (axes, arguments) = (function.axes(), function.arguments());
        let place = |argument: &Argument| ORDER.iter().position(|other| other == argument);
        assert!(arguments.is_sorted_by_key(place), "{function}: {arguments:?}");
        let loads = arguments.iter().filter(|argument| [Wrench, Payload, Wrenches].contains(argument));
        let own = if axes.what == What::WrenchTorques { Some(Wrench) } else { axes.load.argument() };
        assert!(loads.copied().eq(own), "{function}");
        assert_eq!(function.takes(Passive), axes.loops, "{function}");
        let of_base =
            [Motion, BaseVelocity, BasePose, BaseTwist, BaseRotation].iter().any(|base| function.takes(*base));
        // forces by accelerations of the base know no motion of it
        let is_still =
            axes.base == Base::Held || matches!(axes.what, What::MassMatrix | What::CentroidalMomentumMatrix);
        assert_eq!(of_base, !is_still, "{function}");
        // what the same what takes on a base that stands still
        let held = Function::find(Axes { base: Base::Held, load: Load::Free, loops: false, ..axes });
        let of_joints = |function: Function| -> Vec<Argument> {
            let joints = [Sines, Cosines, Positions, Rates, Accelerations, Torques, Multipliers, Step];
            function.arguments().iter().copied().filter(|argument| joints.contains(argument)).collect()
        };
        if let Some(held) = held {
            assert_eq!(of_joints(function), of_joints(held), "{function}");
        }
    }
}
