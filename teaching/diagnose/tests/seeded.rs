//! Slips that were made on purpose, with every shipped robot and with trees: the diagnosis names them first. It
//! names no slip for right torques.

use fastrand::Rng;
use rne_diagnose::{Diagnosis, Observation, Slip, Typo, diagnose, torques_with};
use rne_model::{JointKind, Reader, Robot};
use rne_runtime::{DynArm, Wrench};

/// So many cases, every second one a pair; three times as many where all is asked for.
const CASES: u64 = 100;
/// As a tool prints torques: so many digits behind the point.
const DIGITS: i32 = 6;

fn robots() -> Vec<Robot> {
    rne_robots::ROBOTS.iter().map(|file| Robot::from_yaml(file.yaml).unwrap()).collect()
}

/// Two states with a wrench at the tip.
fn states(rng: &mut Rng, dof: usize) -> [Observation; 2] {
    let mut numbers = |count: usize, size: f64| (0..count).map(|_| (2.0 * rng.f64() - 1.0) * size).collect::<Vec<_>>();
    [(); 2].map(|()| {
        let wrench = numbers(6, 20.0);
        let wrench = Wrench { force: [wrench[0], wrench[1], wrench[2]], moment: [wrench[3], wrench[4], wrench[5]] };
        Observation {
            q: numbers(dof, 1.5),
            qd: numbers(dof, 2.0),
            qdd: numbers(dof, 5.0),
            wrench: Some(wrench),
            tau: vec![0.0; dof],
            resolution: vec![0.5 * 10_f64.powi(-DIGITS); dof],
        }
    })
}

fn torques(robot: &Robot, slips: &[Slip], states: &[Observation]) -> Option<Vec<Vec<f64>>> {
    states.iter().map(|at| torques_with(robot, slips, at).unwrap()).collect()
}

/// Whether somebody who prints so many digits sees a difference.
fn differ(a: &[Vec<f64>], b: &[Vec<f64>]) -> bool {
    let size = a.iter().chain(b).flatten().fold(0.0, |size: f64, x| size.max(x.abs()));
    let least = 3.0 * 10_f64.powi(-DIGITS) + 1e-8 * size;
    a.iter().flatten().zip(b.iter().flatten()).any(|(a, b)| (a - b).abs() > least)
}

fn printed(states: &[Observation], torques: &[Vec<f64>]) -> Vec<Observation> {
    let unit = 10_f64.powi(DIGITS);
    let rounded = |tau: &Vec<f64>| tau.iter().map(|tau| (tau * unit).round() / unit).collect();
    states.iter().zip(torques).map(|(at, tau)| Observation { tau: rounded(tau), ..at.clone() }).collect()
}

/// Slips that show in the torques, each of them.
fn made(
    robot: &Robot,
    all: &[Slip],
    count: usize,
    states: &[Observation],
    rng: &mut Rng,
) -> Option<(Vec<Slip>, Vec<Vec<f64>>)> {
    let mut slips: Vec<Slip> = (0..count).map(|_| all[rng.usize(..all.len())]).collect();
    slips.sort_unstable();
    if let [first, second] = slips[..]
        && !first.goes_with(second)
    {
        return None;
    }
    let torques_of = |slips: &[Slip]| torques(robot, slips, states);
    let made = torques_of(&slips)?;
    let shows = |one: usize| {
        let rest: Vec<Slip> = slips.iter().enumerate().filter(|(i, _)| *i != one).map(|(_, slip)| *slip).collect();
        torques_of(&rest).is_none_or(|rest| differ(&rest, &made))
    };
    ((0..count).all(shows) && differ(&torques_of(&[])?, &made)).then_some((slips, made))
}

#[test]
fn nine_of_ten_slips_are_named_first() {
    named_first(38, robots(), Slip::candidates, |case| if case % 2 == 0 { 1 } else { 2 });
}

#[test]
fn nine_of_ten_mistyped_signs_are_named_first() {
    named_first(39, robots(), |robot| Typo::candidates(robot).into_iter().map(Slip::Typo).collect(), |_| 1);
}

/// A tree by rows of either convention.
fn trees() -> Vec<Robot> {
    [include_str!("../../../docs/tree.yaml"), STANDARD_TREE]
        .map(|text| Reader::new("tree").trees().read(text).unwrap_or_else(|report| panic!("{report}")).robot)
        .into()
}

/// Two arms of two joints on a slide.
const STANDARD_TREE: &str = "
format: 2
name: two_arms
source: own
convention: standard
gravity: [0, 0.3, -9.8]
base: {xyz: [0, 0, 0.4], rpy: [0, 0.2, 0]}
tool: {on: elbow, xyz: [0.1, 0, 0.02], rpy: [0.1, 0, 0]}
joints:
  - {name: slide, type: prismatic, dh: {theta: 0.2, d: 0.1, a: 0.1, alpha: pi/2},
     link: {mass: 4, com: [0.1, 0.2, 0], inertia: {xx: 0.2, yy: 0.3, zz: 0.25, xy: 0.02}}}
  - {name: shoulder, type: revolute, dh: {theta: 0.3, d: 0.1, a: 0.4, alpha: -pi/2}, motor: {inertia: 1e-4,
     gear_ratio: 80, viscous: 1e-4}, link: {mass: 2, com: [-0.2, 0.03, 0.01],
     inertia: {xx: 0.01, yy: 0.04, zz: 0.04, xz: 0.003}}}
  - {name: elbow, type: revolute, dh: {theta: 0, d: 0.05, a: 0.3, alpha: 0},
     link: {mass: 1, com: [-0.1, 0.02, 0], inertia: {xx: 0.002, yy: 0.01, zz: 0.01, yz: 0.001}}}
  - {name: other, parent: slide, at: {xyz: [0.1, -0.2, 0.3], rpy: [0.1, 0.7, -0.3]}, type: revolute,
     dh: {theta: 0, d: 0, a: 0.25, alpha: pi/2},
     link: {mass: 1.5, com: [-0.12, 0, 0.03], inertia: {xx: 0.004, yy: 0.02, zz: 0.02}}}
  - {name: blade, type: revolute, dh: {theta: 1, d: 0.1, a: 0, alpha: 0.5},
     link: {mass: 0.6, com: [0.05, 0, 0.06], inertia: {xx: 0.001, yy: 0.003, zz: 0.003}}}
";

#[test]
fn slips_with_trees_are_named_first() {
    named_first(40, trees(), Slip::candidates, |case| if case % 2 == 0 { 1 } else { 2 });
}

/// The lists of another tool, put in the order of the alphabet by hand.
#[test]
fn lists_in_the_order_of_the_alphabet_are_named() {
    let mut rng = Rng::with_seed(41);
    for robot in trees() {
        let mut alphabet: Vec<(&str, usize)> = Vec::new();
        alphabet.extend(robot.joints.iter().enumerate().map(|(joint, row)| (row.name.as_str(), joint)));
        alphabet.sort_unstable();
        let of_rows = |list: &[f64]| {
            let mut numbers = vec![0.0; list.len()];
            alphabet.iter().zip(list).for_each(|((_, joint), number)| numbers[*joint] = *number);
            numbers
        };
        let in_alphabet = |list: &[f64]| alphabet.iter().map(|(_, joint)| list[*joint]).collect::<Vec<_>>();
        let arm = DynArm::from_robot(&robot);
        let states = states(&mut rng, robot.dof());
        let torques = |read: &dyn Fn(&[f64]) -> Vec<f64>| {
            let of = |at: &Observation| {
                let (q, qd, qdd, wrench) = (read(&at.q), read(&at.qd), read(&at.qdd), at.wrench.unwrap());
                in_alphabet(&arm.inverse_dynamics_with_wrench(&q, &qd, &qdd, &wrench).unwrap())
            };
            printed(&states, &states.iter().map(of).collect::<Vec<_>>())
        };
        assert_eq!(first(&robot, &torques(&<[f64]>::to_vec)), [Slip::TorquesByName], "{}", robot.name);
        assert_eq!(first(&robot, &torques(&of_rows)), [Slip::JointsByName], "{}", robot.name);
    }
}

/// The slips of the first explanation.
fn first(robot: &Robot, seen: &[Observation]) -> Vec<Slip> {
    match diagnose(robot, seen).unwrap() {
        Diagnosis::Explained(all) => all[0].slips.clone(),
        other => panic!("{}: {other:?}", robot.name),
    }
}

/// Tests slips on every robot to which they apply: makes each slip, and checks that the diagnosis names it first.
fn named_first(
    seed: u64,
    mut robots: Vec<Robot>,
    candidates: impl Fn(&Robot) -> Vec<Slip>,
    count: impl Fn(u64) -> usize,
) {
    let mut rng = Rng::with_seed(seed);
    robots.retain(|robot| !candidates(robot).is_empty());
    let (mut named, mut same, mut hidden, mut others) = (0, 0, 0, Vec::new());
    for case in 0..CASES {
        let robot = &robots[usize::try_from(case).unwrap() % robots.len()];
        let states = states(&mut rng, robot.dof());
        let all = candidates(robot);
        let mut attempts = std::iter::repeat_with(|| made(robot, &all, count(case), &states, &mut rng)).take(1000);
        let Some((slips, made)) = attempts.find_map(|made| made) else {
            hidden += 1;
            continue;
        };
        match diagnose(robot, &printed(&states, &made)).unwrap() {
            Diagnosis::Explained(all) if all[0].slips == slips => named += 1,
            // this arm cannot tell them apart
            Diagnosis::Explained(all) if is_the_same(robot, &all[0].slips, &slips, &mut rng) => same += 1,
            found => others.push(format!("{}: {slips:?} is {found:?}", robot.name)),
        }
    }
    assert!(hidden * 20 <= CASES, "{hidden} arms show none of their slips");
    println!(
        "seed {seed}: {named} of {CASES} named first, {same} by what is the same for the arm\n{}",
        others.join("\n")
    );
    assert!(named * 10 >= CASES * 9, "{named} of {CASES}\n{}", others.join("\n"));
    assert!((named + same) * 100 >= CASES * 98, "{named} and {same} of {CASES}\n{}", others.join("\n"));
}

/// Whether slips give the same torques at other states too.
fn is_the_same(robot: &Robot, found: &[Slip], made: &[Slip], rng: &mut Rng) -> bool {
    let states = states(rng, robot.dof());
    let [found, made] = [found, made].map(|slips| torques(robot, slips, &states));
    found.zip(made).is_some_and(|(found, made)| !differ(&found, &made))
}

#[test]
fn nothing_is_said_of_torques_that_agree() {
    let mut rng = Rng::with_seed(1);
    for robot in robots() {
        for _ in 0..5 {
            let states = states(&mut rng, robot.dof());
            let right = torques(&robot, &[], &states).unwrap();
            let found = diagnose(&robot, &printed(&states, &right)).unwrap();
            assert!(matches!(found, Diagnosis::Agrees(_)), "{}: {found:?}", robot.name);
        }
    }
}

/// Torques of nothing in particular: no pair of slips is found in them.
#[test]
fn nonsense_is_not_explained() {
    let mut rng = Rng::with_seed(2);
    for robot in robots().into_iter().filter(|robot| robot.dof() > 2).step_by(4) {
        // far off, and nearly right
        for size in [0.1, 1e-3] {
            let states = states(&mut rng, robot.dof());
            let mut wrong = torques(&robot, &[], &states).unwrap();
            wrong.iter_mut().flatten().for_each(|tau| *tau *= 1.0 + size * rng.f64());
            let found = diagnose(&robot, &printed(&states, &wrong)).unwrap();
            assert!(matches!(found, Diagnosis::Unexplained(_)), "{}: {found:?}", robot.name);
        }
    }
}

/// A slip is what it says: the same arm from a robot file in which somebody made it by hand.
#[test]
fn slips_are_those_that_are_made_by_hand() {
    let text = rne_robots::find("puma560").unwrap().yaml;
    let robot = Robot::from_yaml(text).unwrap();
    for (from, to, slip) in [
        ("convention: standard", "convention: modified", Slip::OtherConvention),
        ("gravity: [0, 0, -9.81]", "gravity: [0, 0, 9.81]", Slip::GravityReversed),
        ("gravity: [0, 0, -9.81]", "gravity: [0, 9.81, 0]", Slip::GravityAlong(1, false)),
        ("gravity: [0, 0, -9.81]", "gravity: [0, 0, 0]", Slip::NoGravity),
        ("a: 0.0203, alpha: -pi/2", "a: 0.0203, alpha: pi/2", Slip::Typo(Typo::Alpha(2))),
        ("[-0.3638, 0.006, 0.2275]", "[-0.3638, 0.006, -0.2275]", Slip::Typo(Typo::Com(1, 2))),
        ("[-0.0203, -0.0141, 0.070]", "[-0.0203, 0.0141, 0.070]", Slip::Typo(Typo::Com(2, 1))),
    ] {
        assert!(text.contains(from));
        by_hand(&robot, &text.replacen(from, to, 1), slip);
    }
    // every line of which one number counts from elsewhere
    let dense = "
format: 1
name: arm
source: a test
convention: CONVENTION
gravity: [1, 2, -9]
joints:
  - {type: revolute, dh: {theta: 0.2, d: 0.4, a: 0.3, alpha: 0.5},
     link: {mass: 2, com: COM1, inertia: {xx: 0.2, yy: 0.3, zz: 0.25, yz: PRODUCT}}}
  - {type: revolute, dh: {theta: 0, d: -0.2, a: 0.5, alpha: -1.1},
     link: {mass: 1, com: COM2, inertia: {xx: 0.1, yy: 0.1, zz: 0.12}}}
";
    let file = |convention: &str, com1: &str, com2: &str, product: &str| {
        let text = dense.replace("CONVENTION", convention).replace("PRODUCT", product);
        text.replace("COM1", com1).replace("COM2", com2)
    };
    let dense_at = |convention: &str| file(convention, "[0.1, 0.2, 0.3]", "[0, 0.1, 0]", "0.02");
    let standard = Robot::from_yaml(&file("standard", "[0.1, 0.2, 0.3]", "[0, 0.1, 0]", "0.02")).unwrap();
    by_hand(&standard, &file("standard", "[-0.1, -0.2, -0.3]", "[0, -0.1, 0]", "0.02"), Slip::ComReversed);
    by_hand(&standard, &file("standard", "[0.1, 0.2, 0.3]", "[0, 0.1, 0]", "-0.02"), Slip::ProductsOfInertia);
    by_hand(&standard, &dense_at("standard").replace("alpha: -1.1", "alpha: 1.1"), Slip::Typo(Typo::Alpha(1)));
    // theta of the second row: that of the first, the only one there is, is all of them
    let turned = dense_at("standard").replacen("theta: 0,", "theta: 0.7,", 1);
    let mistyped = turned.replace("theta: 0.7", "theta: -0.7");
    by_hand(&Robot::from_yaml(&turned).unwrap(), &mistyped, Slip::Typo(Typo::Theta(1)));
    // in frame i, frame i-1 is at -(a, d sin(alpha), d cos(alpha))
    let [com1, com2] =
        ["[0.1 - 0.3, 0.2 - 0.4*sin(0.5), 0.3 - 0.4*cos(0.5)]", "[0 - 0.5, 0.1 + 0.2*sin(-1.1), 0.2*cos(-1.1)]"];
    by_hand(&standard, &file("standard", com1, com2, "0.02"), Slip::ComFromOtherEnd);
    // in frame 1, frame 2 is at (a, -d sin(alpha), d cos(alpha)) of row 2; link 2 has no other end
    let modified = Robot::from_yaml(&file("modified", "[0.1, 0.2, 0.3]", "[0, 0.1, 0]", "0.02")).unwrap();
    let com1 = "[0.1 + 0.5, 0.2 + 0.2*sin(-1.1), 0.3 - 0.2*cos(-1.1)]";
    by_hand(&modified, &file("modified", com1, "[0, 0.1, 0]", "0.02"), Slip::ComFromOtherEnd);
}

#[track_caller]
fn by_hand(robot: &Robot, text: &str, slip: Slip) {
    let wrong = Robot::from_yaml(text).unwrap();
    let states = states(&mut Rng::with_seed(3), robot.dof());
    let made = torques(&wrong, &[], &states).unwrap();
    let found = diagnose(robot, &printed(&states, &made)).unwrap();
    let Diagnosis::Explained(found) = found else { panic!("{slip:?}: {found:?}") };
    assert_eq!(found[0].slips, [slip]);
}

/// What the file's inertias refer to decides what its reader can get wrong.
#[test]
fn inertias_about_another_point() {
    let about = |reference: &str| {
        let link = "mass: 2, com: [0.1, 0.2, 0], inertia: {xx: 0.2, yy: 0.3, zz: 0.25}";
        format!(
            "format: 1\nname: arm\nsource: a test\nconvention: standard\ngravity: [1, 2, -9]\njoints:\n  - type: \
             revolute\n    dh: {{theta: 0, d: 0, a: 0.3, alpha: 0}}\n    link: {{{link}, inertia_about: {reference}}}\n"
        )
    };
    let [com, origin] = ["com", "origin"].map(|reference| Robot::from_yaml(&about(reference)).unwrap());
    assert!(com.rows().all(|row| row.kind == JointKind::Revolute));
    by_hand(&com, &about("origin"), Slip::InertiaAboutOrigin);
    by_hand(&origin, &about("com"), Slip::InertiaShifted);
}

/// A state in which numbers overflow explains nothing, and nothing explains it.
#[test]
fn what_overflows_is_no_explanation() {
    let robot = Robot::from_yaml(rne_robots::find("planar2").unwrap().yaml).unwrap();
    let resolution = vec![0.0; 2];
    let seen = Observation {
        q: vec![0.5, 0.3],
        qd: vec![1e155, 0.5],
        qdd: vec![2.0, 1.0],
        wrench: None,
        tau: vec![1.0, 2.0],
        resolution,
    };
    assert_eq!(diagnose(&robot, &[seen]).unwrap(), Diagnosis::Unexplained(f64::INFINITY));
}

/// The order, the unit, and the order of arguments.
#[test]
fn slips_of_lists() {
    let robot = Robot::from_yaml(rne_robots::find("puma560").unwrap().yaml).unwrap();
    let states = states(&mut Rng::with_seed(4), robot.dof());
    let right = torques(&robot, &[], &states).unwrap();
    let explained = |seen: &[Observation]| match diagnose(&robot, seen).unwrap() {
        Diagnosis::Explained(all) => all[0].slips.clone(),
        other => panic!("{other:?}"),
    };
    let reversed: Vec<Vec<f64>> = right.iter().map(|tau| tau.iter().rev().copied().collect()).collect();
    assert_eq!(explained(&printed(&states, &reversed)), [Slip::TorquesFromTheTip]);
    let in_nmm: Vec<Vec<f64>> = right.iter().map(|tau| tau.iter().map(|tau| tau * 1e3).collect()).collect();
    assert_eq!(explained(&printed(&states, &in_nmm)), [Slip::TorquesInNmm]);
    let exchanged = states.map(|at| Observation { qd: at.qdd.clone(), qdd: at.qd.clone(), ..at });
    assert_eq!(explained(&printed(&exchanged, &right)), [Slip::RatesExchanged]);
}

/// Torques that are printed with three digits agree with every shipped robot, each within half of its own last digit.
#[test]
fn torques_of_three_digits_agree() {
    let mut rng = Rng::with_seed(3);
    for robot in robots() {
        let [at, _] = states(&mut rng, robot.dof());
        let right = torques_with(&robot, &[], &at).unwrap().expect("torques");
        let printed: Vec<String> = right.iter().map(|tau| format!("{tau:.2e}")).collect();
        let tau = printed.iter().map(|text| text.parse().unwrap()).collect();
        let resolution = printed.iter().map(|text| rne_model::half_of_last_digit(text)).collect();
        let found = diagnose(&robot, &[Observation { tau, resolution, ..at }]).unwrap();
        assert!(matches!(found, Diagnosis::Agrees(_)), "{}: {found:?}", robot.name);
    }
}
