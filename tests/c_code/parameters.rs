//! Run-time parameters in C: the bits of a derived struct that has them as fields, and the torques of the runtime for a
//! file that has these numbers.

use std::fmt::Write;

use fastrand::Rng;
use rne::{DynArm, Energy, ForwardDynamics, InverseDynamics, Kinematics, MassMatrix, Scalar};
use rne_codegen::{Form, Function, Program, Quantity};
use rne_emit::Precision;
use rne_model::{Reader, Robot};

use crate::comparison::{ROOT, is_same, read};
use crate::compiler::Compiler;
use crate::driver::{INCLUDES, Unit, words};

/// So many states, each with values of the parameters of its own.
const STATES: usize = 40;

/// Functions of every kind of argument and result.
const FUNCTIONS: [Function; 7] = [
    Function::InverseDynamics,
    Function::GravityTorques,
    Function::BiasTorques,
    Function::MassMatrix,
    Function::ForwardDynamics,
    Function::KineticEnergy,
    Function::ForwardKinematics,
];

/// Lengths of links, and what is made of them.
macro_rules! desk {
    ($name:ident, $form:literal) => {
        #[derive(InverseDynamics, MassMatrix, ForwardDynamics, Energy, Kinematics)]
        #[robot(path = "../../docs/desk_arm.yaml", form = $form, inline)]
        struct $name {
            fore: f64,
            upper: f64,
        }
    };
}
desk!(Desk, "seven_steps");
desk!(DeskReduced, "reduced");

/// A payload, of which no pose depends; a length, gravity, and the name of a type of C. What is not a field is folded.
macro_rules! loaded {
    ($name:ident, $form:literal) => {
        #[derive(InverseDynamics, MassMatrix, ForwardDynamics, Energy, Kinematics)]
        #[robot(path = "loaded.yaml", form = $form, inline)]
        struct $name {
            payload: f64,
            double: f64,
            g: f64,
        }
    };
}
loaded!(Loaded, "seven_steps");
loaded!(LoadedReduced, "reduced");

/// A mass on two branches of a tree, and a length behind which another branch begins.
macro_rules! branches {
    ($name:ident, $form:literal) => {
        #[derive(InverseDynamics, MassMatrix, ForwardDynamics, Energy, Kinematics)]
        #[robot(path = "branches.yaml", form = $form, inline, allow_lints)]
        struct $name {
            m: f64,
            span: f64,
        }
    };
}
branches!(Branches, "seven_steps");
branches!(BranchesReduced, "reduced");

/// All numbers that a function of a derived robot returns.
fn derived<const DOF: usize, T: Scalar, R>(robot: &R, function: Function, [q, qd, qdd]: [&[T]; 3]) -> Vec<T>
where
    R: InverseDynamics<DOF> + MassMatrix<DOF> + ForwardDynamics<DOF> + Energy<DOF> + Kinematics<DOF>,
{
    let array = |numbers: &[T]| -> [T; DOF] { numbers.try_into().expect("one per joint") };
    let [q, qd, qdd] = [q, qd, qdd].map(array);
    match function {
        Function::InverseDynamics => robot.inverse_dynamics(&q, &qd, &qdd).to_vec(),
        Function::GravityTorques => robot.gravity_torques(&q).to_vec(),
        Function::BiasTorques => robot.bias_torques(&q, &qd).to_vec(),
        Function::MassMatrix => robot.mass_matrix(&q).as_flattened().to_vec(),
        Function::ForwardDynamics => robot.forward_dynamics(&q, &qd, &qdd).to_vec(),
        Function::KineticEnergy => vec![robot.kinetic_energy(&q, &qd)],
        _ => {
            let tip = robot.forward_kinematics(&q);
            [tip.rotation.as_flattened(), &tip.translation].concat()
        }
    }
}

/// Torques of the runtime for a file with these numbers.
fn runtime(robot: &Robot, parameters: &[f64], [q, qd, qdd]: [&[f64]; 3]) -> Vec<f64> {
    let arm = DynArm::from_robot(&robot.with_parameters(parameters).expect("as many"));
    arm.inverse_dynamics(q, qd, qdd).expect("one per joint")
}

/// A function that reads a state and parameters and prints what every function returns.
fn calls(prefix: &str, precision: Precision, dof: usize, members: &[&str], programs: &[Program]) -> String {
    let real = precision.c_type();
    let count = members.len();
    let mut text = format!("static void {prefix}_all(const {real} *given)\n{{\n    {prefix}_parameters parameters;\n");
    for (index, name) in ["q", "qd", "qdd"].iter().enumerate() {
        let _ = writeln!(text, "    const {real} *{name} = given + {};", count + index * dof);
    }
    for (index, member) in members.iter().enumerate() {
        let _ = writeln!(text, "    parameters.{member} = given[{index}];");
    }
    for program in programs {
        let name = program.function;
        let joints: &[&str] = match name {
            Function::InverseDynamics | Function::ForwardDynamics => &["q", "qd", "qdd"],
            Function::BiasTorques | Function::KineticEnergy => &["q", "qd"],
            _ => &["q"],
        };
        let takes = program.arguments().any(|name| name.quantity == Quantity::Parameter);
        let parameters = if takes { ", &parameters" } else { "" };
        let given = joints.join(", ") + parameters;
        let _ = match name {
            Function::KineticEnergy => {
                writeln!(text, "    {{ const {real} x = {prefix}_{name}({given}); print_{real}(&x, 1u); }}")
            }
            Function::ForwardKinematics => writeln!(
                text,
                "    {{ {prefix}_pose x; {prefix}_{name}({given}, &x); print_{real}(&x.rotation[0][0], 9u); \
                 print_{real}(x.translation, 3u); }}"
            ),
            Function::MassMatrix => writeln!(
                text,
                "    {{ {real} x[{dof}][{dof}]; {prefix}_{name}({given}, x); print_{real}(&x[0][0], {}u); }}",
                dof * dof
            ),
            _ => writeln!(text, "    {{ {real} x[{dof}]; {prefix}_{name}({given}, x); print_{real}(x, {dof}u); }}"),
        };
    }
    text + "}\n"
}

/// Compares a robot, `of` which there are derived structs; `members` are its parameters in C.
fn compare<const DOF: usize>(
    file: &str,
    (names, members): (&[&str], &[&str]),
    double: impl Fn(Form, &[f64], Function, [&[f64]; 3]) -> Vec<f64>,
    single: impl Fn(Form, &[f64], Function, [&[f32]; 3]) -> Vec<f32>,
) {
    let Some(compiler) = Compiler::found() else { return };
    let checked = Reader::new(file).trees().run_time(names).read(&read(&format!("{ROOT}/{file}")));
    let robot = checked.unwrap_or_else(|report| panic!("{report}")).robot;
    let programs = |form| {
        let compiler = rne_codegen::Compiler::new(&robot);
        FUNCTIONS.map(|function| compiler.compile(function, form).unwrap_or_else(|error| panic!("{error}")))
    };
    let forms = Form::ALL.map(|form| (form, programs(form)));

    let mut source = INCLUDES.to_owned();
    let (mut called, mut drivers) = (String::new(), Precision::ALL.map(words).concat());
    for precision in Precision::ALL {
        let real = precision.c_type();
        let _ = writeln!(called, "        if (!read_{real}({real}s, {}u)) {{ return 0; }}", names.len() + 3 * DOF);
        for (form, programs) in &forms {
            let prefix = format!("{form}_{real}");
            source.push_str(Unit::new(&robot, programs, precision, prefix.clone()).code());
            drivers.push_str(&calls(&prefix, precision, DOF, members, programs));
            let _ = writeln!(called, "        {prefix}_all({real}s);");
        }
    }
    let count = names.len() + 3 * DOF;
    let _ = write!(
        source,
        "{drivers}int main(void)\n{{\n    float floats[{count}];\n    double doubles[{count}];\n    for \
         (;;) {{\n{called}    \
         }}\n}}\n"
    );

    let mut rng = Rng::with_seed(11);
    let states: Vec<Vec<f64>> = (0..STATES)
        .map(|state| {
            let file = robot.run_time.values(&robot);
            // first those of the file
            let factor = |rng: &mut Rng| if state == 0 { 1.0 } else { 0.5 + 2.0 * rng.f64() };
            let parameters: Vec<f64> = file.iter().map(|value| value * factor(&mut rng)).collect();
            let joints = (0..3 * DOF).map(|_| 6.0 * rng.f64() - 3.0);
            // numbers that single precision holds too
            #[allow(clippy::cast_possible_truncation)]
            parameters.into_iter().chain(joints).map(|x| f64::from(x as f32)).collect()
        })
        .collect();
    #[allow(clippy::cast_possible_truncation)]
    let in_single = |state: &[f64]| -> Vec<f32> { state.iter().map(|&x| x as f32).collect() };
    let input: Vec<u64> = states
        .iter()
        .flat_map(|state| {
            let single = in_single(state).into_iter().map(|x| u64::from(x.to_bits()));
            single.chain(state.iter().map(|x| x.to_bits())).collect::<Vec<_>>()
        })
        .collect();
    let mut found = compiler.run(&format!("{}_at_run_time", robot.name), "-O1", &source, &input).into_iter();

    for state in &states {
        let (parameters, joints) = state.split_at(names.len());
        let joints: Vec<&[f64]> = joints.chunks(DOF).collect();
        let joints: [&[f64]; 3] = joints.try_into().expect("three arrays");
        let torques = runtime(&robot, parameters, joints);
        let largest = torques.iter().fold(0.0, |largest: f64, torque| largest.max(torque.abs()));
        for precision in Precision::ALL {
            for form in Form::ALL {
                for function in FUNCTIONS {
                    let expected: Vec<u64> = match precision {
                        Precision::Double => {
                            double(form, parameters, function, joints).into_iter().map(f64::to_bits).collect()
                        }
                        Precision::Single => {
                            let joints = joints.map(in_single);
                            let joints = [0, 1, 2].map(|index: usize| joints[index].as_slice());
                            let numbers = single(form, parameters, function, joints);
                            numbers.into_iter().map(|x| x.to_bits().into()).collect()
                        }
                    };
                    let computed: Vec<u64> = found.by_ref().take(expected.len()).collect();
                    assert_eq!(computed.len(), expected.len(), "{file}, {function}: too few numbers");
                    let real = precision.c_type();
                    for (index, (computed, expected)) in computed.iter().zip(&expected).enumerate() {
                        assert!(
                            is_same(precision, *computed, *expected),
                            "{file}, {function}, {form}, {real}, number {index}: {computed:x} in C, {expected:x} in \
                             Rust, at {state:?}"
                        );
                    }
                    if (function, precision) == (Function::InverseDynamics, Precision::Double) {
                        let allowed = if form == Form::SevenSteps { 0.0 } else { 1e-12 * largest };
                        for (computed, torque) in computed.iter().zip(&torques) {
                            let computed = f64::from_bits(*computed);
                            assert!(
                                (computed - torque).abs() <= allowed,
                                "{file}, {form}: {computed:e}, but {torque:e} of the runtime, at {state:?}"
                            );
                        }
                    }
                }
            }
        }
    }
    assert_eq!(found.next(), None, "{file}: more numbers than asked for");
}

#[test]
fn lengths_at_run_time() {
    fn of<T: Scalar>(form: Form, parameters: &[f64], function: Function, joints: [&[T]; 3]) -> Vec<T> {
        let &[upper, fore] = parameters else { panic!("two parameters") };
        match form {
            Form::SevenSteps => derived::<3, T, _>(&Desk { fore, upper }, function, joints),
            Form::Reduced => derived::<3, T, _>(&DeskReduced { fore, upper }, function, joints),
        }
    }
    let names = ["upper", "fore"];
    compare::<3>("docs/desk_arm.yaml", (&names, &names), of, of);
}

#[test]
fn a_payload_at_run_time() {
    fn of<T: Scalar>(form: Form, parameters: &[f64], function: Function, joints: [&[T]; 3]) -> Vec<T> {
        let &[double, g, payload] = parameters else { panic!("three parameters") };
        match form {
            Form::SevenSteps => derived::<3, T, _>(&Loaded { payload, double, g }, function, joints),
            Form::Reduced => derived::<3, T, _>(&LoadedReduced { payload, double, g }, function, joints),
        }
    }
    let names = (&["double", "g", "payload"][..], &["double_", "g", "payload"][..]);
    compare::<3>("tests/c_code/loaded.yaml", names, of, of);
}

#[test]
fn masses_and_lengths_of_a_tree_at_run_time() {
    fn of<T: Scalar>(form: Form, parameters: &[f64], function: Function, joints: [&[T]; 3]) -> Vec<T> {
        let &[m, span] = parameters else { panic!("two parameters") };
        match form {
            Form::SevenSteps => derived::<4, T, _>(&Branches { m, span }, function, joints),
            Form::Reduced => derived::<4, T, _>(&BranchesReduced { m, span }, function, joints),
        }
    }
    let names = ["m", "span"];
    compare::<4>("tests/c_code/branches.yaml", (&names, &names), of, of);
}
