//! Tables of calibrated arms, whose axes are nearly parallel and whose frames therefore stand up to kilometres away:
//! every function in single precision, beside the runtime in double precision on the same arm with frames that stand at
//! its joints.

use std::fmt::Write;

use fastrand::Rng;
use rne_codegen::{Form, Function, What};
use rne_convert::{Options, Urdf};
use rne_model::{Convention, Reader, Robot};

use crate::arm::{Arm, Maker};
use crate::case::largest;
use crate::single_precision::{State, limit};

/// A joint on the link of the one before, and the link that it moves; a URDF and a robot file write it alike.
struct Joint {
    kind: &'static str,
    xyz: [f64; 3],
    rpy: [f64; 3],
    mass: f64,
    com: [f64; 3],
    /// About the centre of mass: xx, yy, zz.
    inertia: [f64; 3],
}

/// An arm of six or seven joints, each axis parallel or at a right angle to the one before but for a tilt of 1e-5 to
/// 1e-2 rad; of every fourth arm one joint slides.
fn joints(rng: &mut Rng) -> Vec<Joint> {
    let tilt = 10f64.powf(-5.0 + 3.0 * rng.f64());
    let count = rng.usize(6..=7);
    let sliding = (rng.usize(..4) == 0).then(|| rng.usize(1..count));
    let joint = |index: usize| {
        let mut within = |low: f64, high: f64| low + (high - low) * rng.f64();
        let tilts = [within(-tilt, tilt), within(-tilt, tilt)];
        let place = [within(-0.4, 0.4), within(-0.1, 0.1), within(-0.2, 0.2)];
        let mass = within(0.3, 4.0);
        let com = [within(-0.2, 0.2), within(-0.05, 0.05), within(-0.1, 0.1)];
        let [a, b, c] = [(); 3].map(|()| within(0.03, 0.1)).map(|radius| mass * radius * radius);
        let quarter = [0.0, 0.0, 0.0, 1.0, -1.0][rng.usize(..5)] * std::f64::consts::FRAC_PI_2;
        // frame 0 is that of the base
        let is_first = index == 0;
        let rpy = if is_first { [0.0; 3] } else { [tilts[0] + quarter, tilts[1], 0.0] };
        let xyz = if is_first { [0.0, 0.0, 0.15] } else { place };
        let kind = if sliding == Some(index) { "prismatic" } else { "revolute" };
        Joint { kind, xyz, rpy, mass, com, inertia: [b + c, a + c, a + b] }
    };
    (0..count).map(joint).collect()
}

fn urdf(joints: &[Joint]) -> String {
    let mut text = "<robot name=\"calibrated\"><link name=\"l0\"/>".to_owned();
    for (index, Joint { kind, xyz: [x, y, z], rpy: [r, p, w], mass, com: [cx, cy, cz], inertia: [xx, yy, zz] }) in
        joints.iter().enumerate()
    {
        let _ = write!(
            text,
            "<joint name=\"j{0}\" type=\"{kind}\"><parent link=\"l{index}\"/><child link=\"l{0}\"/><origin \
             xyz=\"{x} {y} {z}\" rpy=\"{r} {p} {w}\"/><axis xyz=\"0 0 1\"/><limit lower=\"-3\" upper=\"3\" \
             effort=\"1\" velocity=\"1\"/></joint><link name=\"l{0}\"><inertial><origin xyz=\"{cx} {cy} {cz}\"/><mass \
             value=\"{mass}\"/><inertia ixx=\"{xx}\" iyy=\"{yy}\" izz=\"{zz}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>\
             </inertial>\
             </link>",
            index + 1
        );
    }
    text + "</robot>"
}

/// The arm with a frame at each joint.
fn near(joints: &[Joint]) -> Robot {
    let head = "format: 2\nname: near\nsource: own\nconvention: modified\ngravity: [0, 0, -9.81]\njoints:\n";
    let mut text = head.to_owned();
    for (index, Joint { kind, xyz, rpy, mass, com, inertia: [xx, yy, zz] }) in joints.iter().enumerate() {
        let parent = if index == 0 { "base".to_owned() } else { format!("j{index}") };
        let _ = writeln!(
            text,
            "  - {{name: j{}, parent: {parent}, type: {kind}, at: {{xyz: {xyz:?}, rpy: {rpy:?}}}, \
             dh: {{theta: 0, d: 0, \
             a: 0, alpha: 0}}, limits: {{position: [-3, 3]}}, link: {{mass: {mass}, com: {com:?}, inertia: {{xx: {xx}, \
             yy: {yy}, zz: {zz}}}}}}}",
            index + 1
        );
    }
    Reader::new("near").trees().read(&text).unwrap_or_else(|report| panic!("{report}")).robot
}

/// The largest error of a function in single precision at some states, in parts of the largest number there.
fn error(arm: &Arm, right: &Arm, function: Function, states: usize) -> f64 {
    let (mut error, mut scale) = (0.0_f64, 0.0_f64);
    let mut rng = Rng::with_seed(1);
    for _ in 0..states {
        let state = State::random(&arm.robot, &mut rng);
        let (single, double) = (state.ask(arm, function, |x| x), state.ask(right, function, f64::from));
        for (single, double) in single.iter().zip(&double) {
            let difference = (f64::from(*single) - double).abs();
            // `f64::max` drops what is not a number
            error = if difference.is_nan() { difference } else { error.max(difference) };
        }
        scale = scale.max(largest(&double));
    }
    if error == 0.0 { 0.0 } else { error / scale }
}

/// Code says what it loses, with a margin. Of the form `reduced`, at most one function in 25 does, but for those that
/// are about frames of the table themselves.
#[test]
fn calibrated_tables_keep_single_precision_or_say_what_they_lose() {
    let (tables, states) = if shipped::is_exhaustive() { (200, 20) } else { (1, 4) };
    let mut rng = Rng::with_seed(57);
    let (mut lost, mut lost_reduced, mut reduced) = (0, 0, 0);
    let mut wrong = String::new();
    for table in 0..tables {
        let joints = joints(&mut rng);
        let near = near(&joints);
        let exact = Arm::new(&near, Maker::Runtime);
        // of a sample, one is enough
        let conventions = [Convention::Standard, Convention::Modified];
        for convention in conventions.into_iter().take(if shipped::is_exhaustive() { 2 } else { 1 }) {
            let options = Options { convention, snap: false, ..Options::default() };
            let imported = Urdf::read("arm", &urdf(&joints)).and_then(|urdf| urdf.import(&options));
            let robot = imported.unwrap_or_else(|report| panic!("{report}")).robot;
            let of_table = Arm::new(&robot, Maker::Runtime);
            for form in [Form::SevenSteps, Form::Reduced] {
                let make = if shipped::is_exhaustive() { Arm::new } else { Arm::by_no_choice };
                let arm = make(&robot, Maker::Code(form));
                // the base of these arms has no mass
                let is_solvable = |function: &Function| !(function.is_of_floating_base() && function.inverts_mass());
                for function in Function::OF_TREES.into_iter().filter(is_solvable) {
                    let right = if function.entry().is_of_table_points { &of_table } else { &exact };
                    let error = error(&arm, right, function, states);
                    let loss = arm.program(function).loss;
                    // energy is zero at frame 0, and a floating base is frame 0, wherever the table has it
                    let is_of_frame_0 = function.what() == What::PotentialEnergy || function.is_of_floating_base();
                    let is_of_table = function.entry().is_of_table_points || is_of_frame_0;
                    lost += usize::from(loss.is_some());
                    if form == Form::Reduced && !is_of_table {
                        reduced += 1;
                        lost_reduced += usize::from(loss.is_some());
                    }
                    // other states than those that the compiler tries
                    let most = 3.0 * limit(function).max(loss.unwrap_or_default());
                    if error > most || error.is_nan() {
                        let _ =
                            writeln!(wrong, "{table}, {convention:?}, {form}, {function}: {error:e}, said {loss:?}");
                    }
                }
            }
        }
    }
    println!("{lost} functions say that they lose digits, {lost_reduced} of {reduced} in the form reduced");
    assert!(wrong.is_empty(), "{wrong}");
    assert!(lost > 0, "no table of these is a hard one");
    assert!(lost_reduced * 25 <= reduced, "{lost_reduced} of {reduced}");
}

/// Long lengths that are no common normals of nearly parallel axes: beside parallel axes, of a base in the axes of a
/// site, and behind joints that slide.
const LONG: [&str; 3] = [
    "name: parallel, convention: modified, joints: [
     {type: revolute, dh: {theta: 0, d: 0.3, a: 0, alpha: 0}, link: {com: [0.1, 0, 0], BODY}},
     {type: revolute, dh: {theta: 0, d: 5000, a: 0, alpha: pi/2}, link: {com: [0.1, 0, -5000], BODY}},
     {type: revolute, dh: {theta: 0, d: -5000, a: 0.4, alpha: 0}, link: {com: [0.1, 0, 0], BODY}}]",
    "name: site, convention: modified, base: {xyz: [5000, 6000, 0]}, joints: [
     {type: revolute, dh: {theta: 0, d: 0.3, a: 0, alpha: 0}, link: {com: [0.1, 0, 0], BODY}},
     {type: revolute, dh: {theta: 0, d: 0, a: 0.3, alpha: pi/2}, link: {com: [0.1, 0, 0], BODY}}]",
    "name: slides, convention: standard, joints: [
     {type: prismatic, dh: {theta: 0, d: 0.1, a: 0, alpha: pi/2}, link: {BODY}},
     {type: prismatic, dh: {theta: pi/2, d: 0.2, a: 0, alpha: pi/2}, link: {BODY}},
     {type: prismatic, dh: {theta: 0, d: -11266, a: 0.3, alpha: 0}, link: {BODY}},
     {type: revolute, dh: {theta: 0, d: 389, a: 0.4, alpha: -4e-5}, link: {com: [-0.1, 0, -389], BODY}},
     {type: revolute, dh: {theta: 0, d: 10877, a: 0.3, alpha: -6e-5}, link: {com: [-0.1, 0, 0], BODY}}]",
];

/// The matter of each link of these.
const BODY: &str = "mass: 2, inertia: {xx: 0.02, yy: 0.02, zz: 0.02}";

/// What no form keeps is said, wherever the long length is.
#[test]
fn code_of_robots_with_long_lengths_says_what_it_loses() {
    let mut wrong = String::new();
    for text in LONG {
        let head = "{format: 1, source: own, gravity: [0, 0, -9.81], ";
        let text = format!("{head}{}}}", text.replace("BODY", BODY));
        let robot = Reader::new("long").read(&text).unwrap_or_else(|report| panic!("{report}")).robot;
        let right = Arm::new(&robot, Maker::Runtime);
        let mut lost = 0;
        for form in [Form::SevenSteps, Form::Reduced] {
            let arm = Arm::by_no_choice(&robot, Maker::Code(form));
            let is_solvable = |function: &Function| !function.is_of_floating_base();
            for function in Function::OF_TREES.into_iter().filter(is_solvable) {
                let loss = arm.program(function).loss;
                lost += usize::from(loss.is_some());
                let error = error(&arm, &right, function, 300);
                // where one in ten is lost, there is no digit to rely on
                let is_useless = loss.is_some_and(|loss| loss > 0.1);
                if error.is_nan() || error > 3.0 * limit(function).max(loss.unwrap_or_default()) && !is_useless {
                    let _ = writeln!(wrong, "{}, {form}, {function}: {error:e}, said {loss:?}", robot.name);
                }
            }
        }
        assert!(lost > 0, "{}", robot.name);
    }
    assert!(wrong.is_empty(), "{wrong}");
}
