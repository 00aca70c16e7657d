//! Base parameters without rounding are those that a factorisation finds to a tolerance.

use std::fs;

use rne_identify::{Identifiability, Parameter, Visibility};
use rne_model::Robot;
use rne_runtime::DynArm;

#[path = "../../../tests/random/arms.rs"]
mod arms;

fn compare(robot: &Robot, name: &str) {
    let exact = Identifiability::of(robot, false);
    let numerical = DynArm::from_robot(robot).base_parameters();
    let kept: Vec<Parameter> =
        numerical.parameters.iter().map(|base| Parameter::Link(base.kept.link, base.kept.index)).collect();
    assert_eq!(exact.kept(), kept, "{name}");
    assert_eq!(numerical.visible_rank, kept.len(), "{name}");
    assert!(numerical.parameters.iter().all(|base| base.is_visible), "{name}");
    for (parameter, visibility) in &exact.parameters {
        let &Parameter::Link(link, index) = parameter else { panic!("{name}: no rotor was asked for") };
        let is = |other: &rne_runtime::LinkParameter| (other.link, other.index) == (link, index);
        match visibility {
            Visibility::Kept => {}
            Visibility::WithoutEffect => assert!(numerical.without_effect.iter().any(is), "{name} {parameter:?}"),
            Visibility::Regrouped(parts) => {
                let places = numerical.parameters.iter().enumerate();
                let found: Vec<(usize, f64)> = places
                    .filter_map(|(at, base)| Some((at, base.regrouped.iter().find(|(_, other)| is(other))?.0)))
                    .collect();
                assert_eq!(
                    parts.iter().map(|(at, _)| *at).collect::<Vec<_>>(),
                    found.iter().map(|(at, _)| *at).collect::<Vec<_>>(),
                    "{name} {parameter:?}"
                );
                for ((_, whole), (_, factor)) in parts.iter().zip(&found) {
                    assert!(whole.is_none_or(|whole| f64::from(whole) == *factor), "{name} {parameter:?}");
                }
            }
            other => panic!("{name}: {other:?}"),
        }
    }
}

fn shipped(name: &str) -> Robot {
    let path = format!("{}/../../robots/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}"))
}

#[test]
fn base_parameters_of_the_shipped_robots_are_the_exact_ones() {
    let folder = fs::read_dir(format!("{}/../../robots", env!("CARGO_MANIFEST_DIR"))).expect("it is there");
    let names = folder.filter_map(|entry| Some(entry.ok()?.file_name().to_str()?.strip_suffix(".yaml")?.to_owned()));
    let mut count = 0;
    for name in names.filter(|name| !name.contains(".plan")) {
        compare(&shipped(&name), &name);
        count += 1;
    }
    assert!(count > 20, "{count}");
}

#[test]
fn base_parameters_of_random_arms_are_the_exact_ones() {
    let arms = if std::env::var_os("RNE_EXHAUSTIVE").is_some() { 120 } else { 60 };
    for seed in 0..arms {
        compare(&Robot::from_yaml(&arms::yaml(seed)).expect("it is an arm"), &format!("arm {seed}"));
    }
}

/// The rotor of joint 1 resists as its link does, and that of joint 2 where its axis is at a right angle; the others
/// are seen by themselves.
#[test]
fn rotors_of_the_first_joints_are_seen_with_their_links() {
    let ranks = |name: &str| {
        let robot = shipped(name);
        let of = |rotors| -> Identifiability { Identifiability::of(&robot, rotors) };
        (of(false).kept().len(), of(true))
    };
    for (name, links, with_rotors) in [("puma560", 36, 40), ("ur10", 36, 40), ("panda", 43, 48)] {
        let (rank, rotors) = ranks(name);
        assert_eq!((rank, rotors.kept().len()), (links, with_rotors), "{name}");
        let seen = |joint| rotors.parameters.iter().find(|(parameter, _)| *parameter == Parameter::Rotor(joint));
        assert!(matches!(seen(0), Some((_, Visibility::Regrouped(_)))), "{name}");
        assert!(matches!(seen(1), Some((_, Visibility::Regrouped(_)))), "{name}");
    }
}

/// Robots some of whose joints follow others: their ratios are 1 and -1.
#[test]
fn base_parameters_of_coupled_robots_are_the_exact_ones() {
    for text in [include_str!("../../../docs/gripper.yaml"), include_str!("../../../docs/palletiser.yaml")] {
        let read = rne_model::Reader::new("robot").trees().couplings().read(text);
        let robot = read.unwrap_or_else(|report| panic!("{report}")).robot;
        compare(&robot, &robot.name);
    }
}
