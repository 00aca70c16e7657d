//! The page's scripts, run by node, against the runtime, whose recursion shares no code with the compiler: the
//! interpreter's torques are its bits, and code in the page is the code that is emitted.

use std::process::Command;

use rne_codegen::{Compiler, Form, Function};
use rne_inspection::{Inspection, Tree};
use rne_model::{Reader, Robot};
use rne_runtime::{DynArm, DynTrace, LinkTrace, Pose, Scalar};
use serde_json::{Value, json};

const STATES: usize = 4;

struct Asked {
    robot: Robot,
    /// Torques, with a wrench at the tip, and of gravity alone.
    states: Vec<[Vec<f64>; 3]>,
    /// All vectors of the links.
    traces: Vec<DynTrace<f64>>,
    /// The frames of the links in the world.
    poses: Vec<Vec<Pose<f64>>>,
    /// The statements that are emitted, of the seven steps and of the reduced form.
    code: [Vec<String>; 2],
}

/// The shipped robots that are tried, and trees by rows of either convention.
fn robots() -> impl Iterator<Item = Robot> {
    let (gripper, palletiser) =
        (include_str!("../../../docs/gripper.yaml"), include_str!("../../../docs/palletiser.yaml"));
    let trees = [include_str!("../../../docs/tree.yaml"), STANDARD_TREE, gripper, palletiser];
    let tree =
        |text| Reader::new("tree").trees().couplings().read(text).unwrap_or_else(|report| panic!("{report}")).robot;
    let shipped = shipped::tried().map(|file| Robot::from_yaml(file.yaml).expect("shipped robots are valid"));
    shipped.chain(trees.map(tree))
}

/// A slide with two arms, on a base that is turned.
const STANDARD_TREE: &str = "
format: 2
name: two_arms
source: own
convention: standard
gravity: [0, 0.3, -9.8]
base: {xyz: [0.2, 0, 0.4], rpy: [0.1, 0.2, -0.5]}
tool: {on: elbow, xyz: [0.1, 0, 0.02], rpy: [0.1, 0, 0]}
joints:
  - {name: slide, type: prismatic, dh: {theta: 0.2, d: 0.1, a: 0.1, alpha: pi/2},
     link: {mass: 4, com: [0.1, 0.2, 0], inertia: {xx: 0.2, yy: 0.3, zz: 0.25, xy: 0.02}}}
  - {name: shoulder, type: revolute, dh: {theta: 0.3, d: 0.1, a: 0.4, alpha: -pi/2},
     link: {mass: 2, com: [-0.2, 0.03, 0.01], inertia: {xx: 0.01, yy: 0.04, zz: 0.04, xz: 0.003}}}
  - {name: elbow, type: revolute, dh: {theta: 0, d: 0.05, a: 0.3, alpha: 0},
     link: {mass: 1, com: [-0.1, 0.02, 0], inertia: {xx: 0.002, yy: 0.01, zz: 0.01, yz: 0.001}}}
  - {name: other, parent: slide, at: {xyz: [0.1, -0.2, 0.3], rpy: [0.1, 0.7, -0.3]}, type: revolute,
     dh: {theta: 0, d: 0, a: 0.25, alpha: pi/2},
     link: {mass: 1.5, com: [-0.12, 0, 0.03], inertia: {xx: 0.004, yy: 0.02, zz: 0.02}}}
  - {name: blade, type: revolute, dh: {theta: 1, d: 0.1, a: 0, alpha: 0.5},
     link: {mass: 0.6, com: [0.05, 0, 0.06], inertia: {xx: 0.001, yy: 0.003, zz: 0.003}}}
";

/// The sines and cosines of the runtime at a state, by their angles.
fn turns(robot: &Robot, inspection: &Inspection, q: &[f64]) -> Vec<[f64; 3]> {
    let coordinates: Vec<usize> = robot.coordinates().collect();
    let constants = &inspection.constants;
    let given = |name: &str| -> f64 {
        let joint = name.strip_prefix('q').and_then(|joint| joint.parse::<usize>().ok());
        match joint.and_then(|joint| coordinates.iter().position(|index| index + 1 == joint)) {
            Some(coordinate) => q[coordinate],
            None => constants.iter().find(|(known, _)| known == name).map_or(f64::NAN, |(_, value)| *value),
        }
    };
    let angles: Vec<(&str, f64)> = inspection.angles.iter().map(|of| (&*of.name, of.value.evaluate(&given))).collect();
    let value = |name: &str| angles.iter().find(|(known, _)| *known == name).map_or_else(|| given(name), |of| of.1);
    let turn = |angle: &Tree| {
        let angle = angle.evaluate(&value);
        let (sine, cosine) = Scalar::sin_cos(angle);
        [angle, sine, cosine]
    };
    inspection.sines_and_cosines.iter().map(|of| turn(&of.angle)).collect()
}

fn question(robot: Robot, random: &mut fastrand::Rng) -> (Asked, Value) {
    let dof = robot.dof();
    let program =
        |function| Compiler::new(&robot).with_equations().compile(function, Form::SevenSteps).expect("compiles");
    let torques = program(Function::InverseDynamics);
    let with_wrench = program(Function::InverseDynamicsWithWrench);
    let reduced = Compiler::new(&robot).compile(Function::InverseDynamics, Form::Reduced).expect("compiles");
    let data = rne_report::data(&robot, &torques, Some(&with_wrench), Some(&reduced));
    let inspection = Inspection::new(&robot, &with_wrench);
    let arm = DynArm::from_robot(&robot);
    let (mut states, mut traces, mut poses, mut asked) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for _ in 0..STATES {
        let mut list = |count: usize| (0..count).map(|_| random.f64() * 4.0 - 2.0).collect::<Vec<f64>>();
        let (q, qd, qdd, force, moment) = (list(dof), list(dof), list(dof), list(3), list(3));
        let triple = |list: &[f64]| [list[0], list[1], list[2]];
        let wrench = rne_runtime::Wrench { force: triple(&force), moment: triple(&moment) };
        let still = vec![0.0; dof];
        states.push([
            arm.inverse_dynamics(&q, &qd, &qdd).expect("one number per joint"),
            arm.inverse_dynamics_with_wrench(&q, &qd, &qdd, &wrench).expect("one number per joint"),
            arm.inverse_dynamics(&q, &still, &still).expect("one number per joint"),
        ]);
        let trace = arm.trace(&q, &qd, &qdd, &arm.fixed_base(), None);
        traces.push(trace.expect("one number per joint"));
        poses.push(arm.link_poses(&q).expect("one number per joint"));
        asked.push(json!({
            "turns": turns(&robot, &inspection, &q),
            "state": { "q": q, "qd": qd, "qdd": qdd },
            "wrench": { "f": force, "n": moment },
        }));
    }
    let code = [&torques, &reduced].map(|program| {
        let statements = Inspection::new(&robot, program).statements;
        statements.iter().map(|statement| without_blanks(&statement.rust)).collect()
    });
    (Asked { robot, states, traces, poses, code }, json!({ "data": data, "states": asked }))
}

/// What node says to the questions; nothing where there is no node.
fn answers(questions: &[Value]) -> Option<Vec<Value>> {
    by_node(include_str!("interpreter.js"), questions)
}

/// What a script says that stands behind those of the page and reads the questions.
fn by_node(last: &str, questions: &[Value]) -> Option<Vec<Value>> {
    let folder = tempfile::tempdir().expect("a folder");
    let scripts = rne_report::SCRIPTS.iter().filter(|(name, _)| *name != "page.js").map(|(_, text)| *text);
    let script: String = scripts.chain([last]).collect();
    let (program, input) = (folder.path().join("all.js"), folder.path().join("questions.json"));
    std::fs::write(&program, script).expect("it can be written");
    std::fs::write(&input, Value::from(questions.to_vec()).to_string()).expect("it can be written");
    let Ok(output) = Command::new("node").arg(&program).arg(&input).output() else {
        println!("there is no node: the page's scripts are not run");
        return None;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    Some(serde_json::from_str(&text).expect("JSON"))
}

fn numbers(value: &Value) -> Vec<f64> {
    let texts = value.as_array().expect("a list").iter().map(|text| text.as_str().expect("a text"));
    texts.map(|text| text.parse().unwrap_or(f64::NAN)).collect()
}

fn close(found: &[f64], torques: &[f64], tolerance: f64, what: &str) {
    let largest = torques.iter().fold(1.0_f64, |largest, torque| largest.max(torque.abs()));
    assert_eq!(found.len(), torques.len(), "{what}");
    for (found, torque) in found.iter().zip(torques) {
        assert!((found - torque).abs() <= tolerance * largest, "{what}: {found} {torque}");
    }
}

fn without_blanks(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace("( ", "(").replace(" )", ")")
}

#[test]
fn the_page_computes_the_torques_of_the_runtime_and_shows_the_code_that_is_emitted() {
    let mut random = fastrand::Rng::with_seed(38);
    let (asked, questions): (Vec<Asked>, Vec<Value>) = robots().map(|robot| question(robot, &mut random)).unzip();
    let Some(answers) = answers(&questions) else { return };
    assert_eq!(answers.len(), asked.len());
    let mut named = (0, 0);
    for (Asked { robot, states, code, .. }, answer) in asked.iter().zip(&answers) {
        let name = &robot.name;
        for ([free, with_wrench, gravity], said) in states.iter().zip(answer["answers"].as_array().expect("a list")) {
            // with the runtime's sine and cosine the same bits
            assert_eq!(&numbers(&said["free"]), free, "{name}");
            assert_eq!(&numbers(&said["total"]), with_wrench, "{name}");
            assert_eq!(&numbers(&said["gravity"]), gravity, "{name}");
            // those of node differ in the last digit
            close(&numbers(&said["own"]), free, 1e-14, name);
            close(&numbers(&said["equations"]), free, 1e-13, name);
            close(&numbers(&said["reduced"]), free, 1e-11, name);
        }
        for (lines, emitted) in answer["rust"].as_array().expect("two programs").iter().zip(code) {
            let lines =
                lines.as_array().expect("a list").iter().map(|line| without_blanks(line.as_str().expect("a text")));
            assert_eq!(&lines.collect::<Vec<_>>(), emitted, "{name}");
        }
        let value: f64 = answer["value"].as_str().and_then(|text| text.parse().ok()).expect("a number");
        assert_eq!(answer["right"], "Right.", "{name}");
        for slip in answer["slips"].as_array().expect("a list") {
            let (what, said) = (slip[0].as_str().expect("a text"), slip[1].as_str().expect("a text"));
            let of: f64 = slip[2].as_str().and_then(|text| text.parse().ok()).expect("a number");
            // what gives nearly the right number, or nothing at all, tells nothing
            if (of - value).abs() <= 0.05 * value.abs() + 1e-4 || of.abs() < 1e-3 {
                continue;
            }
            named.1 += 1;
            named.0 += usize::from(said.contains(what));
        }
    }
    println!("{} slips of {} are named by what they are; two are named at most", named.0, named.1);
    assert!(named.1 > 30 && named.0 * 10 >= named.1 * 9, "{named:?}");
}

/// Rz(yaw) Ry(pitch) Rx(roll), column by column, times a vector.
fn turned([roll, pitch, yaw]: [f64; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    let about = |angle: f64, a: f64, b: f64| (angle.cos() * a - angle.sin() * b, angle.sin() * a + angle.cos() * b);
    let (y, z) = about(roll, y, z);
    let (z, x) = about(pitch, z, x);
    let (x, y) = about(yaw, x, y);
    [x, y, z]
}

fn vectors(link: &LinkTrace<f64>) -> [[f64; 3]; 7] {
    let of = (link.omega, link.omega_dot, link.velocity, link.acceleration);
    [of.0, of.1, of.2, of.3, link.gravity, link.joint_force, link.joint_moment]
}

/// The arm is drawn where the runtime has it: centres of mass by the frames of its links, ends of links by its r in
/// base axes, arrows by its vectors there; and what is told in the lecture's axes and in the base's is what it has
/// there.
#[test]
fn links_and_arrows_are_where_the_runtime_has_them() {
    let mut random = fastrand::Rng::with_seed(40);
    let (asked, questions): (Vec<Asked>, Vec<Value>) = robots().map(|robot| question(robot, &mut random)).unzip();
    let Some(answers) = answers(&questions) else { return };
    for (Asked { robot, traces, poses, .. }, answer) in asked.iter().zip(&answers) {
        let name = &robot.name;
        let rpy = robot.base.rpy.map(|angle| angle.radians);
        let sum = |a: [f64; 3], b: [f64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        let said = answer["answers"].as_array().expect("a list");
        for ((trace, poses), said) in traces.iter().zip(poses).zip(said) {
            let links = trace.to_base().into_iter().zip(trace.to_lecture()).enumerate();
            for ((index, (link, lecture)), said) in links.zip(said["links"].as_array().expect("a list")) {
                // the runtime returns no pose of a link that follows
                if let Some(pose) = robot.coordinates().position(|joint| joint == index).map(|at| &poses[at]) {
                    let own = robot.joints[index].row.link.com;
                    let com = pose.rotation.map(|row| row[0] * own[0] + row[1] * own[1] + row[2] * own[2]);
                    let com = sum(pose.translation, com);
                    close(&numbers(&said["com"]), &com, 1e-13, name);
                    let carries = (0..robot.joints.len()).any(|joint| robot.parent(joint) == Some(index));
                    if carries || robot.tip().on == Some(index) {
                        close(&numbers(&said["next"]), &sum(com, turned(rpy, link.r)), 1e-13, name);
                    }
                }
                let in_world = vectors(&link).map(|vector| turned(rpy, vector));
                close(&numbers(&said["world"]), in_world.as_flattened(), 1e-12, name);
                close(&numbers(&said["base"]), vectors(&link).as_flattened(), 1e-12, name);
                close(&numbers(&said["lecture"]), vectors(&lecture).as_flattened(), 1e-12, name);
            }
        }
    }
}

#[test]
fn c_in_the_page_is_the_c_that_is_emitted() {
    let mut random = fastrand::Rng::with_seed(39);
    let shipped = |name: &str| Robot::from_yaml(rne_robots::find(name).expect("shipped").yaml).expect("valid");
    let robots = ["puma560", "stanford", "panda", "ur5"].map(shipped);
    let (asked, questions): (Vec<Asked>, Vec<Value>) = robots.into_iter().map(|of| question(of, &mut random)).unzip();
    let Some(answers) = answers(&questions) else { return };
    for (Asked { robot, .. }, answer) in asked.iter().zip(&answers) {
        let program = Compiler::new(robot).compile(Function::InverseDynamics, Form::SevenSteps).expect("compiles");
        let emitted = without_blanks(&c_code(robot, &program));
        for line in answer["c"].as_array().expect("a list") {
            let line = without_blanks(line.as_str().expect("a text"));
            assert!(emitted.contains(&line), "{}: {line}", robot.name);
        }
    }
}

fn c_code(robot: &Robot, program: &rne_codegen::Program) -> String {
    let programs = std::slice::from_ref(program);
    let code = rne_emit::c_code(robot, programs, rne_emit::Precision::Double, &rne_emit::Prefix::of(robot))
        .expect("it is emitted");
    code.one_file()
}

/// The page names each unknown key of an address, and lists the keys that it knows.
#[test]
fn addresses_that_the_page_does_not_know_are_told() {
    const SCRIPT: &str = "
        const addresses = JSON.parse(require('fs').readFileSync(process.argv[2], 'utf8'));
        console.log(JSON.stringify(addresses.map((address) => readAddress(address).wrong.join('; '))));";
    let cases = [
        ("#q=0.6,1.3&qd=1,-0.5&cell=2.4&exercise", &[][..]),
        ("#look=3D&no-masses&f=1,0,0", &[]),
        ("#look=0.1,0.2,1", &[]),
        // the link at the top of the page
        ("#steps", &[]),
        ("#look=side", &["look=side is no view", "front, top, 3D"]),
        ("#cel=2.4", &["cel is not known", "q, qd, qdd, f, n, cell, look"]),
        ("#exercize", &["exercize is not known", "exercise, lecture"]),
        ("#cell=2", &["cell=2 is no cell", "cell=JOINT.STEP"]),
        ("#q=a,1", &["“a” in q is no number"]),
    ];
    let addresses: Vec<Value> = cases.iter().map(|(address, _)| Value::from(*address)).collect();
    let Some(said) = by_node(SCRIPT, &addresses) else { return };
    for ((address, parts), said) in cases.iter().zip(&said) {
        let said = said.as_str().expect("a text");
        assert_eq!(said.is_empty(), parts.is_empty(), "{address}: {said}");
        assert!(parts.iter().all(|part| said.contains(part)), "{address}: {said}");
    }
}

/// Robots with a floating base.
const FLOATING: [&str; 2] =
    [include_str!("../../../docs/standing_hyq.yaml"), include_str!("../../../docs/satellite.yaml")];

/// By the code, by the equations before folding and by the reduced form, the page has the wrench on a base that moves
/// and the torques of the runtime; its parts add up, and those of gravity and velocities are what they are said to be.
#[test]
fn a_floating_base_of_the_page_is_that_of_the_runtime() {
    const SCRIPT: &str = "
        const asked = JSON.parse(require('fs').readFileSync(process.argv[2], 'utf8'));
        console.log(JSON.stringify(asked.map(({ data, states }) => {
          const inspection = new Inspection(data);
          const [folded, reduced] = [data.programs.folded, data.programs.reduced].map((record) => new Program(record));
          const equations = new Equations(inspection.components);
          const torques = new Torques(inspection, folded, folded);
          return states.map(({ state, wrench }) => {
            const split = torques.split(state, wrench);
            const given = inspection.argumentsOf(state, wrench);
            equations.set(given);
            const all = (part) => [...split.onBase[part], ...split[part]].map(String);
            const byEquations = data.programs.folded.outputs.map(([name]) => String(equations.value(name)));
            const { total, gravity, velocity, inertia, tip } = Object.fromEntries(
              ['total', 'gravity', 'velocity', 'inertia', 'tip'].map((part) => [part, all(part)]));
            return { total, gravity, velocity, inertia, tip, byEquations, reduced: reduced.run(given).map(String) };
          });
        })));";
    let mut random = fastrand::Rng::with_seed(41);
    let mut questions = Vec::new();
    let mut expected = Vec::new();
    for text in FLOATING {
        let reader = Reader::new("floating").trees();
        let robot = reader.read(text).unwrap_or_else(|report| panic!("{report}")).robot;
        let page = rne_report::page(&robot, None).expect("it compiles");
        let (_, data) = page.split_once(r#"id="data">"#).expect("a page has data");
        let (data, _) = data.split_once("</script>").expect("the data end");
        let data: Value = serde_json::from_str(data).expect("JSON");
        let (arm, tips) = (DynArm::from_robot(&robot), robot.tips.len().max(1));
        let mut states = Vec::new();
        for _ in 0..STATES {
            let mut list = |count: usize| (0..count).map(|_| random.f64() * 4.0 - 2.0).collect::<Vec<f64>>();
            let [q, qd, qdd] = [0, 1, 2].map(|_| list(robot.dof()));
            let [rpy, omega, omega_dot, acceleration] = [0; 4].map(|_| <[f64; 3]>::try_from(list(3)).expect("three"));
            let (force, moment) = (list(3 * tips), list(3 * tips));
            let wrenches: Vec<rne_runtime::Wrench<f64>> = (0..tips)
                .map(|tip| {
                    let triple = |list: &[f64]| [0, 1, 2].map(|axis| list[3 * tip + axis]);
                    rne_runtime::Wrench { force: triple(&force), moment: triple(&moment) }
                })
                .collect();
            // Rᵀ g: along each axis of the base, which is a column of R
            let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| turned(rpy, axis));
            let gravity = axes.map(|axis| (0..3).map(|at| axis[at] * robot.gravity[at]).sum());
            let rest = rne_runtime::BaseMotion { gravity, ..Default::default() };
            let turning = rne_runtime::BaseMotion { omega, ..rest };
            let moving = rne_runtime::BaseMotion { omega_dot, acceleration, ..turning };
            let still = vec![0.0; robot.dof()];
            let free = vec![rne_runtime::Wrench::default(); tips];
            let of = |qd: &[f64], qdd: &[f64], base, wrenches: &[rne_runtime::Wrench<f64>]| {
                let rne_runtime::DynFloatingTorques { wrench: on_base, tau } =
                    arm.inverse_dynamics_of_floating_base(&q, qd, qdd, base, wrenches).expect("lengths are right");
                [&on_base.force[..], &on_base.moment[..], &tau[..]].concat()
            };
            let gravity = of(&still, &still, &rest, &free);
            let (mass, size) = (arm_mass(&robot), |vector: &[f64]| vector.iter().map(|x| x * x).sum::<f64>().sqrt());
            assert!(
                (size(&gravity[..3]) - mass * size(&robot.gravity)).abs() < 1e-11,
                "a base at rest bears the weight"
            );
            let with_rates = of(&qd, &still, &turning, &free);
            expected.push((robot.name.clone(), of(&qd, &qdd, &moving, &wrenches), gravity, with_rates));
            let base = json!({ "rpy": rpy, "omega": omega, "omega_dot": omega_dot, "acceleration": acceleration });
            let wrench = json!({ "f": force, "n": moment });
            states.push(json!({ "state": { "q": q, "qd": qd, "qdd": qdd, "base": base }, "wrench": wrench }));
        }
        questions.push(json!({ "data": data, "states": states }));
    }
    let Some(answers) = by_node(SCRIPT, &questions) else { return };
    let answers = answers.iter().flat_map(|answer| answer.as_array().expect("a list"));
    for ((name, all, gravity, with_rates), said) in expected.iter().zip(answers) {
        let part = |of: &str| numbers(&said[of]);
        close(&part("total"), all, 1e-13, name);
        close(&part("byEquations"), all, 1e-12, name);
        close(&part("reduced"), all, 1e-11, name);
        close(&part("gravity"), gravity, 1e-13, name);
        let sum = |parts: &[&str]| {
            let parts: Vec<Vec<f64>> = parts.iter().map(|of| part(of)).collect();
            (0..all.len()).map(|at| parts.iter().map(|part| part[at]).sum()).collect::<Vec<f64>>()
        };
        close(&sum(&["gravity", "velocity"]), with_rates, 1e-12, name);
        close(&sum(&["gravity", "velocity", "inertia", "tip"]), all, 1e-12, name);
    }
}

/// The mass of a robot with a floating base, kg.
fn arm_mass(robot: &Robot) -> f64 {
    let base = robot.floating_base.as_ref().map_or(0.0, |base| base.link.mass);
    robot.joints.iter().map(|joint| joint.row.link.mass).sum::<f64>() + base
}
