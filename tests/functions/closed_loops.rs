//! Closed loops: every function of real and of random mechanisms, by every maker, beside golden values that another
//! program has made by virtual work on the closed kinematics, at 60 digits (`tests/witnesses/loops.py`).

use std::collections::BTreeMap;

use rne::compiled::{Arguments as Numbers, Array, CompiledArm, Destination};
use rne::{
    BaseMotion, BaseTwist, ClosedLoops, ClosedLoopsPayloadDynamics, DynArm, FloatingClosedLoops, Payload, Pose,
    VectorUnit, Wrench,
};
use rne_codegen::{Argument, Arguments, Axes, Compiler, Form, Function, Interpreter, Load};
use rne_model::{Reader, Robot};
use rne_runtime::Inputs;
use serde_json::Value;

use crate::check::ROOT;
use crate::payload::carrying;

/// A trunk with one leg of a four-bar.
#[derive(rne::ClosedLoops, rne::ClosedLoopsPayloadDynamics, rne::FloatingClosedLoops)]
#[robot(path = "../../benches/trees/loops/floating_four_bar_leg.yaml", form = "reduced")]
struct FourBarLeg;

/// The largest error that is allowed, relative to the largest number that the function returns.
const TOLERANCE: f64 = 1e-9;

/// Robots with golden values of their own.
const ROBOTS: [&str; 15] = [
    "four_bar",
    "six_bar",
    "planar_leg_linkage",
    "five_bar",
    "delta",
    "cassie_like",
    "digit_like",
    "g1_ankle",
    "ankle_by_foot",
    "palletiser",
    "bennett",
    "floating_four_bar_leg",
    "floating_two_ankles",
    "floating_delta",
    "floating_digit_like",
];

fn robot(yaml: &[u8]) -> Robot {
    Reader::new("robot")
        .trees()
        .couplings()
        .loops()
        .read(yaml)
        .unwrap_or_else(|report| panic!("{}", report.render(false)))
        .robot
}

fn read(path: &str) -> Vec<u8> {
    let path = format!("{ROOT}/{path}");
    std::fs::read(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// A payload of each robot.
fn payload() -> Payload<f64> {
    Payload::from_array([0.7, 0.02, -0.05, 0.04, 0.003, 0.004, 0.002, 0.0005, -0.0003, 0.0002])
}

/// A state of a golden file.
struct State<'a>(&'a Value);

impl State<'_> {
    /// The motion of the base; `None` for a robot whose base is fixed.
    fn base(&self) -> Option<BaseMotion<f64>> {
        self.0.get("base")?;
        let of = |key: &str| {
            let numbers = State(&self.0["base"]).numbers(key);
            <[f64; 3]>::try_from(numbers).expect("three numbers")
        };
        let (omega, omega_dot) = (of("omega"), of("omega_dot"));
        Some(BaseMotion { omega, omega_dot, acceleration: of("acceleration"), ..BaseMotion::fixed(of("gravity")) })
    }

    /// The functions with values in the file.
    fn functions(&self, robot: &Robot) -> impl Iterator<Item = Function> + use<> {
        let floats = self.base().is_some();
        rne_codegen::functions_of(robot).filter(move |function| floats || !function.is_of_floating_base())
    }

    fn numbers(&self, key: &str) -> Vec<f64> {
        fn flat(value: &Value, numbers: &mut Vec<f64>) {
            match value {
                Value::Array(values) => values.iter().for_each(|value| flat(value, numbers)),
                value => numbers.push(value.as_f64().expect("a number")),
            }
        }
        let mut numbers = Vec::new();
        flat(&self.0[key], &mut numbers);
        numbers
    }

    /// What a function returns, and what its error is measured by. With a payload, it is what the runtime returns for
    /// the robot with a link that has the payload.
    fn expected(&self, robot: &Robot, function: Function) -> (Vec<f64>, f64) {
        let without = Function::find(Axes { load: Load::Free, ..function.axes() });
        let numbers = match function {
            _ if function.takes(Argument::Payload) => {
                of_runtime(&carrying(robot, &payload()), without.expect("a function without a payload"), self)
            }
            Function::ClosureStep => self.numbers("passive"),
            Function::LoopMap => self.numbers("loop_map"),
            Function::LoopMapRateTimesVelocity => self.numbers("passive_accelerations_bias"),
            Function::InverseDynamicsOfLoops => self.numbers("inverse_dynamics"),
            Function::InverseDynamicsOfLoopsWithWrenches => self.numbers("inverse_dynamics_with_wrench"),
            Function::MassMatrixOfLoops => self.numbers("mass_matrix"),
            Function::ForwardDynamicsOfLoops => self.numbers("forward_dynamics"),
            Function::GravityTorquesOfLoops => self.numbers("gravity_torques"),
            Function::BiasTorquesOfLoops => self.numbers("bias_torques"),
            Function::InverseDynamicsOfFloatingLoops => self.numbers("inverse_dynamics_of_floating_loops_with_wrench"),
            Function::FloatingMassMatrixOfLoops => self.numbers("floating_mass_matrix_of_loops"),
            Function::FloatingForwardDynamicsOfLoops => self.numbers("floating_forward_dynamics_of_loops_with_wrench"),
            other => unreachable!("{other} is of no closed loop"),
        };
        let largest = |numbers: &[f64]| numbers.iter().fold(1.0_f64, |largest, x| largest.max(x.abs()));
        let scale = match function {
            // a large wrench may need a small torque
            Function::InverseDynamicsOfLoopsWithWrenches | Function::InverseDynamicsOfFloatingLoops => {
                largest(&numbers).max(largest(&self.numbers("wrench")))
            }
            _ => largest(&numbers),
        };
        (numbers, scale)
    }

    /// The largest error, which is allowed.
    fn is_near(&self, robot: &Robot, function: Function, found: &[f64], maker: &str) -> f64 {
        let (expected, scale) = self.expected(robot, function);
        // behind the positions stand the equations, which are closed
        let (found, rest) = found.split_at(expected.len());
        assert!(rest.iter().all(|left| left.abs() < 1e-12), "{maker}, {function}: {rest:?} are left");
        let errors = found.iter().zip(&expected).map(|(found, expected)| {
            let error = (found - expected).abs() / scale;
            assert!(error < TOLERANCE, "{maker}, {function}: {found} and not {expected}");
            error
        });
        errors.fold(0.0, f64::max)
    }
}

fn of_runtime(arm: &DynArm, function: Function, state: &State<'_>) -> Vec<f64> {
    let [q, passive, qd, qdd, tau, wrench] =
        ["q", "passive", "qd", "qdd", "tau", "wrench"].map(|key| state.numbers(key));
    let wrench = Wrench { force: [wrench[0], wrench[1], wrench[2]], moment: [wrench[3], wrench[4], wrench[5]] };
    let [q, passive, qd, qdd, tau] = [&q, &passive, &qd, &qdd, &tau].map(Vec::as_slice);
    let base = state.base().unwrap_or_else(|| BaseMotion::fixed([0.0; 3]));
    let inputs = Inputs {
        q,
        qd,
        qdd,
        tau,
        sin: &[],
        cos: &[],
        passive,
        multipliers: &[],
        wrench: &wrench,
        wrenches: &[wrench],
        payload: &payload(),
        base: &base,
        omega: &base.omega,
        twist: &BaseTwist::default(),
        pose: &Pose::identity(),
        base_rotation: &Pose::identity().rotation,
        step: 0.0,
    };
    arm.evaluate(function, &inputs).expect("one number per joint")
}

/// The largest error of each function.
fn check(name: &str, robot: &Robot, states: &[Value]) -> BTreeMap<Function, f64> {
    let (arm, compiler) = (DynArm::from_robot(robot), Compiler::new(robot));
    let mut errors = BTreeMap::new();
    for function in State(&states[0]).functions(robot) {
        let worst = errors.entry(function).or_insert(0.0_f64);
        for state in states.iter().map(State) {
            *worst = worst.max(state.is_near(
                robot,
                function,
                &of_runtime(&arm, function, &state),
                &format!("{name}, runtime"),
            ));
        }
        for form in Form::ALL {
            let program = compiler.compile(function, form).unwrap_or_else(|error| panic!("{name}: {error}"));
            let interpreter = Interpreter::new(&program);
            for state in states.iter().map(State) {
                let [q, passive, qd, qdd, tau] = ["q", "passive", "qd", "qdd", "tau"].map(|key| state.numbers(key));
                let wrench: [f64; 6] = state.numbers("wrench").try_into().expect("six numbers");
                let arguments = Arguments {
                    passive: &passive,
                    tau: &tau,
                    wrenches: &[wrench],
                    payload: payload().to_array(),
                    base: state
                        .base()
                        .map_or([[0.0; 3]; 4], |base| [base.omega, base.omega_dot, base.acceleration, base.gravity]),
                    ..Arguments::of_joints(&q, &qd, &qdd, 0.0)
                };
                let found = interpreter.run(&arguments, |x| x, f64::sin_cos).expect("all arguments");
                *worst = worst.max(state.is_near(robot, function, &found, &format!("{name}, {form}")));
            }
        }
    }
    errors
}

/// The text of a robot file with other lists of dependent joints, one for each loop.
fn with_dependent(yaml: &str, lists: &[Value]) -> String {
    let mut parts = yaml.split("dependent: [");
    let mut text = parts.next().expect("a text").to_owned();
    for (part, list) in parts.zip(lists) {
        let names: Vec<&str> = list.as_array().expect("a list").iter().filter_map(Value::as_str).collect();
        let rest = part.split_once(']').expect("the end of a list").1;
        text.extend(["dependent: [", &names.join(", "), "]", rest]);
    }
    text
}

/// Random robots, and for each a choice of dependent joints that is refused: too few, too many, or as many as the rank
/// where they lose it at all closed positions of the golden values.
fn check_random(golden: &[u8]) {
    let golden: Vec<Value> = serde_json::from_slice(golden).expect("JSON");
    let (mut errors, mut refused) = (BTreeMap::new(), BTreeMap::new());
    let one_in = if shipped::is_exhaustive() { 1 } else { 3 };
    for (index, entry) in golden.iter().enumerate().step_by(one_in) {
        let yaml = entry["yaml"].as_str().expect("a text");
        let states = entry["states"].as_array().expect("states");
        for (function, error) in check(&format!("random mechanism {index}"), &robot(yaml.as_bytes()), states) {
            let worst = errors.entry(function).or_insert(0.0_f64);
            *worst = worst.max(error);
        }
        let wrong = &entry["wrong"];
        let why = wrong["why"].as_str().expect("a word");
        let text = with_dependent(yaml, wrong["dependent"].as_array().expect("lists"));
        let report = match Reader::new("robot").trees().couplings().loops().read(text.as_bytes()) {
            Ok(_) => panic!("random mechanism {index}: {why}, and not refused:\n{text}"),
            Err(report) => report.render(false),
        };
        assert!(report.contains("dependent joint"), "random mechanism {index}, {why}: {report}");
        *refused.entry(why).or_insert(0_usize) += 1;
    }
    println!("one in {one_in} of {} random mechanisms, wrong choices refused: {refused:?}", golden.len());
    for (function, error) in errors {
        println!("{function}: largest error {error:.1e}");
    }
}

#[test]
fn real_mechanisms_are_those_of_virtual_work() {
    for name in ROBOTS {
        let robot = robot(&read(&format!("benches/trees/loops/{name}.yaml")));
        let golden: Vec<Value> =
            serde_json::from_slice(&read(&format!("tests/golden/loops/{name}.json"))).expect("JSON");
        check(name, &robot, &golden);
    }
}

#[test]
fn random_mechanisms_are_those_of_virtual_work() {
    check_random(&read("tests/golden/loops/random.json"));
}

#[test]
fn random_mechanisms_float() {
    check_random(&read("tests/golden/loops/floating_random.json"));
}

#[test]
fn derived_closed_loops_float() {
    let golden: Vec<Value> =
        serde_json::from_slice(&read("tests/golden/loops/floating_four_bar_leg.json")).expect("JSON");
    let leg = robot(&read("benches/trees/loops/floating_four_bar_leg.yaml"));
    for state in golden.iter().map(State) {
        let of = |key: &str| <[f64; 2]>::try_from(state.numbers(key)).expect("two numbers");
        let [q, passive, qd, qdd, tau] = ["q", "passive", "qd", "qdd", "tau"].map(of);
        let [x, y, z, about_x, about_y, about_z] = state.numbers("wrench")[..] else { unreachable!("six numbers") };
        let wrenches = [Wrench { force: [x, y, z], moment: [about_x, about_y, about_z] }];
        let base = state.base().expect("a floating base");
        let closed = FourBarLeg.close(&q, &passive.map(|p| p + 1e-3));
        let carried = FourBarLeg.forward_dynamics_of_loops_with_payload(&q, &passive, &qd, &tau, &payload());
        state.is_near(&leg, Function::ForwardDynamicsOfLoopsWithPayload, &carried, "derived");
        state.is_near(&leg, Function::ClosureStep, &[&closed.passive[..], &closed.residual].concat(), "derived");
        let torques = FourBarLeg.inverse_dynamics_of_floating_loops(&q, &passive, &qd, &qdd, &base, &wrenches);
        let torques = [&torques.wrench.force[..], &torques.wrench.moment, &torques.tau].concat();
        state.is_near(&leg, Function::InverseDynamicsOfFloatingLoops, &torques, "derived");
        let mass = FourBarLeg.floating_mass_matrix_of_loops(&q, &passive);
        state.is_near(&leg, Function::FloatingMassMatrixOfLoops, mass.as_flattened(), "derived");
        let moved = FourBarLeg.floating_forward_dynamics_of_loops(&q, &passive, &qd, &tau, &base.omega, &wrenches);
        let moved = [&moved.base.linear[..], &moved.base.angular, &moved.qdd].concat();
        state.is_near(&leg, Function::FloatingForwardDynamicsOfLoops, &moved, "derived");
    }
}

#[test]
#[ignore = "reads the file that `cargo xtask loops` makes"]
fn many_mechanisms_are_those_of_virtual_work() {
    let path = std::env::var("RNE_LOOPS").expect("the file, in the variable RNE_LOOPS");
    check_random(&std::fs::read(&path).unwrap_or_else(|error| panic!("{path}: {error}")));
}

/// The machine computes what the interpreter does, for many states at once.
#[test]
fn the_machine_computes_closed_loops() {
    for name in ["g1_ankle", "cassie_like", "floating_two_ankles"] {
        let path = format!("{ROOT}/benches/trees/loops/{name}.yaml");
        let arm = CompiledArm::from_file(path).expect("a robot file").in_form(Form::Reduced);
        let golden: Vec<Value> =
            serde_json::from_slice(&read(&format!("tests/golden/loops/{name}.json"))).expect("JSON");
        let all = |key: &str| golden.iter().flat_map(|state| State(state).numbers(key)).collect::<Vec<f64>>();
        let [q, passive, qd, qdd, tau, wrenches] = ["q", "passive", "qd", "qdd", "tau", "wrench"].map(all);
        let arguments = Numbers::new().q(Array::Rows(&q)).passive(Array::Rows(&passive)).qd(Array::Rows(&qd));
        let payload = payload().to_array();
        let arguments = arguments.payload(Array::Same(&payload));
        let arguments = arguments.qdd(Array::Rows(&qdd)).tau(Array::Rows(&tau)).wrenches(Array::Rows(&wrenches));
        let of_base = |part: fn(&BaseMotion<f64>) -> [f64; 3]| {
            golden.iter().filter_map(|state| State(state).base()).flat_map(|base| part(&base)).collect::<Vec<f64>>()
        };
        let [omega, omega_dot, acceleration, gravity] = [
            of_base(|base| base.omega),
            of_base(|base| base.omega_dot),
            of_base(|base| base.acceleration),
            of_base(|base| base.gravity),
        ];
        let arguments = arguments.omega(Array::Rows(&omega)).base_omega(Array::Rows(&omega));
        let arguments = arguments.base_omega_dot(Array::Rows(&omega_dot));
        let arguments = arguments.base_acceleration(Array::Rows(&acceleration)).base_gravity(Array::Rows(&gravity));
        for function in State(&golden[0]).functions(arm.robot()) {
            let width = arm.layout(function).len();
            let mut numbers = vec![f64::NAN; golden.len() * width];
            let compiled = arm.function(function).expect("a function that compiles");
            let results = Destination::Rows(&mut numbers);
            compiled.run(VectorUnit::widest(), golden.len(), &arguments, results).expect("arrays of one length");
            for (state, found) in golden.iter().map(State).zip(numbers.chunks(width)) {
                state.is_near(arm.robot(), function, found, &format!("{name}, machine"));
            }
        }
    }
}

/// Motors that move a mechanism in a circle do no work: it comes back with the energy that it had.
#[test]
fn a_closed_motion_takes_no_work() {
    const POINTS: u32 = 64;
    for name in ROBOTS {
        let robot = robot(&read(&format!("benches/trees/loops/{name}.yaml")));
        let golden: Vec<Value> =
            serde_json::from_slice(&read(&format!("tests/golden/loops/{name}.json"))).expect("JSON");
        let (middle, mut passive) = (State(&golden[0]).numbers("q"), State(&golden[0]).numbers("passive"));
        let arm = DynArm::from_robot(&robot);
        let program =
            Compiler::new(&robot).compile(Function::InverseDynamicsOfLoops, Form::Reduced).expect("a program");
        let interpreter = Interpreter::new(&program);
        let (mut work, mut spent) = (0.0, 0.0_f64);
        for point in 0..POINTS {
            // one turn in 2π s; each joint with a phase of its own
            let time = std::f64::consts::TAU * f64::from(point) / f64::from(POINTS);
            let motion = |joint: usize| {
                let (sine, cosine) = (time + 0.7 * f64::from(u32::try_from(joint).expect("small"))).sin_cos();
                [middle[joint] + 0.05 * sine, 0.05 * cosine, -0.05 * sine]
            };
            let [q, qd, qdd] =
                [0, 1, 2].map(|order| (0..middle.len()).map(|joint| motion(joint)[order]).collect::<Vec<f64>>());
            for _ in 0..4 {
                passive = arm.closure_step(&q, &passive).expect("one number per joint").passive;
            }
            let arguments = Arguments { passive: &passive, ..Arguments::of_joints(&q, &qd, &qdd, 0.0) };
            let tau = interpreter.run(&arguments, |x| x, f64::sin_cos).expect("all arguments");
            let power: f64 = tau.iter().zip(&qd).map(|(tau, qd)| tau * qd).sum();
            work += power;
            spent += power.abs();
        }
        assert!(work.abs() < TOLERANCE * spent, "{name}: {work:e} of {spent:e}");
    }
}
