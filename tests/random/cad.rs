//! Random arms with the numbers that CAD gives: short decimals, principal axes along the axes of the link, the tensor
//! about the centre of mass or about the origin of the link's frame. None is refused in the reduced form, whatever is
//! zero about which point.

use fastrand::Rng;
use rne::DynArm;
use rne_codegen::plan::PlanSet;
use rne_codegen::{Compiler, Form, Function};
use rne_model::Robot;

use super::interpreted::{State, interpreted, runtime};
use super::reduced::error;

/// Relative to the largest torque of the state.
const TOLERANCE: f64 = 1e-11;

/// How many arms, and how many joints the longest has: with `RNE_EXHAUSTIVE` set, more than anybody waits for.
fn extent() -> (u64, usize) {
    if std::env::var_os("RNE_EXHAUSTIVE").is_some() { (640, 7) } else { (56, 3) }
}

/// An integer of so many decimal places as text, exactly.
fn decimal(value: i64, places: u32) -> String {
    let (sign, unit) = (if value < 0 { "-" } else { "" }, 10_u64.pow(places));
    let magnitude = value.unsigned_abs();
    format!("{sign}{}.{:0width$}", magnitude / unit, magnitude % unit, width = places as usize)
}

/// Zero now and then, else up to `most` either way.
fn number(rng: &mut Rng, zeros: f64, most: i64) -> i64 {
    if rng.f64() < zeros { 0 } else { rng.i64(-most..=most) }
}

fn angle(rng: &mut Rng, right: f64) -> String {
    if rng.f64() < right {
        return (*rng.choice(["0", "pi/2", "-pi/2", "pi"].iter()).unwrap_or(&"0")).to_owned();
    }
    decimal(rng.i64(-300..=300), 2)
}

/// A link in units of 0.1 kg and 0.01 m: principal moments about its centre of mass, or the whole tensor about the
/// origin.
fn link(rng: &mut Rng, zeros: f64) -> String {
    let mass = if rng.f64() < 0.1 { 0 } else { rng.i64(1..=80) };
    let com = [(); 3].map(|()| number(rng, zeros, 60));
    // each as the sum of two moments of a plane, so that the triangle inequalities hold; in units of 1e-5 kg m²
    let planes = [(); 3].map(|()| number(rng, 0.15, 40_000).abs());
    let moments = [planes[1] + planes[2], planes[0] + planes[2], planes[0] + planes[1]];
    let about_origin = rng.bool();
    let square: i64 = com.iter().map(|c| c * c).sum();
    let entry = |i: usize, j: usize| {
        let own = if i == j { moments[i] } else { 0 };
        let steiner = if i == j { square - com[i] * com[j] } else { -com[i] * com[j] };
        decimal(own + if about_origin { mass * steiner } else { 0 }, 5)
    };
    let [xx, yy, zz, xy, xz, yz] = [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)];
    let [x, y, z] = com.map(|c| decimal(c, 2));
    let about = if about_origin { "origin" } else { "com" };
    format!(
        "{{mass: {}, com: [{x}, {y}, {z}], inertia: {{xx: {xx}, yy: {yy}, zz: {zz}, xy: {xy}, xz: {xz}, yz: {yz}}}, \
         inertia_about: {about}}}",
        decimal(mass, 1)
    )
}

fn yaml(seed: u64, most: usize) -> String {
    let mut rng = Rng::with_seed(seed);
    let joints = most.min(*rng.choice([2, 2, 2, 2, 2, 3, 3, 3, 4, 5, 6, 7].iter()).unwrap_or(&2));
    let convention = if rng.bool() { "standard" } else { "modified" };
    let (zeros, right) = (*rng.choice(&[0.0, 0.3, 0.6]).unwrap_or(&0.3), *rng.choice(&[0.6, 1.0]).unwrap_or(&1.0));
    let prismatic = *rng.choice(&[0.0, 0.0, 0.3, 0.6]).unwrap_or(&0.0);
    let gravity = if rng.f64() < 0.8 { "[0, 0, -9.81]" } else { "[1.2, -3.4, 9.1]" };
    let joints: Vec<String> = (0..joints)
        .map(|_| {
            let kind = if rng.f64() < prismatic { "prismatic" } else { "revolute" };
            let [d, a] = [(); 2].map(|()| decimal(number(&mut rng, zeros, 50), 2));
            let (theta, alpha, link) = (angle(&mut rng, right), angle(&mut rng, right), link(&mut rng, zeros));
            format!("  - {{type: {kind}, dh: {{theta: {theta}, d: {d}, a: {a}, alpha: {alpha}}}, link: {link}}}\n")
        })
        .collect();
    let joints = joints.concat();
    format!(
        "format: 1\nname: cad_{seed}\nsource: random numbers, seed {seed}\nconvention: {convention}\n\
         gravity: {gravity}\njoints:\n{joints}"
    )
}

/// Compiles a robot in the reduced form by the plans of a build, and compares torques with the runtime. How many of
/// its functions that have a recursion of their own it had to leave in their plain form.
fn left_plain(robot: &Robot, functions: &[Function]) -> usize {
    let (arm, plans) = (DynArm::from_robot(robot), PlanSet::default_of(robot));
    let mut rng = Rng::with_seed(9);
    let mut plain = 0;
    for &function in functions {
        let program = Compiler::new(robot).with_plans(&plans).compile(function, Form::Reduced);
        let program = program.unwrap_or_else(|error| panic!("{}, {function}: {error}", robot.name));
        if !Function::TORQUES.contains(&function) {
            continue;
        }
        plain += usize::from(program.proof.is_none());
        for _ in 0..3 {
            let state = State::random(&mut rng, robot.dof());
            let of_motion = runtime(&arm, Function::InverseDynamics, &state);
            let error = error(&interpreted(&program, &state), &runtime(&arm, function, &state), &of_motion);
            assert!(error <= TOLERANCE, "{}, {function}: {error}", robot.name);
        }
    }
    plain
}

#[test]
fn no_arm_is_refused_in_the_reduced_form() {
    let (mut plain, (arms, most)) = (0, extent());
    for seed in 0..arms {
        let yaml = yaml(seed, most);
        let robot = Robot::from_yaml(&yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}"));
        // all functions of every eighth that is short
        let functions =
            if seed % 8 == 0 && robot.dof() < 5 { &Function::OF_TREES[..] } else { &Function::TORQUES[..1] };
        plain += left_plain(&robot, functions);
    }
    assert_eq!(plain, 0, "some plan can be proved for each");
}

#[test]
fn a_tensor_about_the_origin_is_no_obstacle() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/random/files/about_origin.yaml");
    let robot = Robot::from_yaml(&std::fs::read_to_string(path).expect("a robot file")).expect("a robot");
    assert_eq!(left_plain(&robot, &Function::OF_TREES), 0);
    // the plans that needs a root is made all the same
    assert!(PlanSet::default_of(&robot).plan.turned_last_frame);
}

/// Numbers whose products leave the range of double precision: the reduced form is then the seven steps.
#[test]
fn numbers_out_of_range_are_no_obstacle() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/random/files/about_origin.yaml");
    let text = std::fs::read_to_string(path).expect("a robot file");
    for (from, to) in [
        ("mass: 2,", "mass: 1e150,"),
        ("mass: 2.5,", "mass: 1e150,"),
        ("mass: 2,", "mass: 5e-324,"),
        ("mass: 2.5,", "mass: 5e-324,"),
        ("d: 0.3,", "d: 5e-324,"),
        ("a: 0.4,", "a: 5e-324,"),
        ("a: 0.4,", "a: 1e150,"),
    ] {
        let text = text.replacen(from, to, 1).replace(", inertia_about: origin", "");
        let robot = Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}"));
        let plans = PlanSet::default_of(&robot);
        for function in [Function::InverseDynamics, Function::MassMatrix, Function::ForwardDynamics] {
            let plain = Compiler::new(&robot).with_plans(&plans).compile(function, Form::SevenSteps);
            let reduced = Compiler::new(&robot).with_plans(&plans).compile(function, Form::Reduced);
            assert_eq!(plain.is_ok(), reduced.is_ok(), "{to} {function}: {:?}", reduced.map_err(|e| e.to_string()));
        }
    }
}
