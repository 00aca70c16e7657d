//! What an arm costs that is known at run time only, beside the derived code of the same arm.
//!
//! ```sh
//! cargo run --release --manifest-path benches/Cargo.toml --no-default-features --features run_time --bin run_time
//! ```
//!
//! Nanoseconds per state of inverse dynamics in double precision, reduced form with the shipped plan, one thread; the
//! minima of many alternating repetitions over the same 1,024 states.
//!
//! - batches: the derived one and the machine, on the widest vector unit
//! - single calls one after the other: the derived one, as this program was compiled; the machine with one state;
//!   native code. The processor may overlap a call with the next
//! - chained: every position depends on a torque of the call before (times 1e-300, below rounding)
//! - build: milliseconds from the compiled program to native code
//!
//! Then, on every vector unit: torques against the derived batch of that unit, and the other functions, which have no
//! derived batch, against a loop over derived calls.

use std::hint::black_box;
use std::time::Instant;

use rne::{BatchInverseDynamics, ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, MassMatrix, VectorUnit};
use rne_codegen::{Compiler, Form, Function, Program, Target};
use rne_machine::{Arguments, Array, CompiledArm, Destination, Machine, Native, Source};
use rne_model::Robot;
use rne_search::PlanFile;

const STATES: usize = 1024;
const REPETITIONS: usize = 300;
const BUILDS: usize = 20;

const HEADER: &str = concat!(
    "                 batches                  single calls                                   chained\n",
    "robot            derived  machine  times  derived  machine  times   native  times  derived   native  times  build"
);

const OF_FUNCTIONS: &str = "robot           unit     function                       derived  machine  times";

macro_rules! arms {
    ($($Arm:ident: $name:literal by $key:ident = $value:literal;)*) => {
        $(
            #[derive(
                InverseDynamics, BatchInverseDynamics, MassMatrix, ForwardDynamics, InverseDynamicsDerivatives,
            )]
            #[robot($key = $value, form = "reduced")]
            struct $Arm;
        )*

        fn main() {
            println!("{HEADER}");
            $(println!("{}", row(&$Arm, $name));)*
            println!("\n{OF_FUNCTIONS}");
            $(functions(&$Arm, $name);)*
        }
    };
}
arms! {
    Puma560: "puma560" by builtin = "puma560";
    Panda: "panda" by builtin = "panda";
    Iiwa14: "iiwa14" by builtin = "iiwa14";
    Ur5: "ur5" by builtin = "ur5";
    Cobra600: "scara_cobra600" by builtin = "scara_cobra600";
    Stanford: "stanford" by builtin = "stanford";
    Dense7: "dense7" by path = "peers/models/dense7.yaml";
}

/// The texts of a robot file and its plan file: of the box, or the arm of random numbers in which nothing folds.
fn texts(name: &str) -> (&'static str, &'static str) {
    if name == "dense7" {
        return (include_str!("peers/models/dense7.yaml"), include_str!("peers/models/dense7.plan.yaml"));
    }
    let file = rne_robots::find(name).expect("it is shipped");
    (file.yaml, file.plan.expect("it has a plan"))
}

/// Numbers of every joint, of every state.
type Numbers<const DOF: usize> = Vec<[f64; DOF]>;

fn row<const DOF: usize, R: BatchInverseDynamics<DOF>>(derived: &R, name: &str) -> String {
    let unit = VectorUnit::widest();
    let [latency, throughput] = [Target::Latency, Target::Throughput].map(|target| program(name, target));
    let machine = Machine::new(&throughput).expect("a small program");
    let native = Native::<f64>::new(&latency).expect("a processor that Cranelift knows");

    let mut random = fastrand::Rng::with_seed(1);
    let motion: [Numbers<DOF>; 3] =
        std::array::from_fn(|_| (0..STATES).map(|_| std::array::from_fn(|_| 2.0 * random.f64() - 1.0)).collect());
    let [q, qd, qdd] = &motion;
    let columns = motion.each_ref().map(|numbers| columns(numbers));
    let sources: Vec<Source<'_, f64>> = machine
        .inputs()
        .iter()
        .map(|input| {
            let (quantity, joint) = quantity_and_joint(&input.to_string());
            Source::Column(&columns[quantity][joint])
        })
        .collect();
    let [of_machine, of_native] = [machine.inputs(), native.inputs()].map(|inputs| {
        let inputs: Vec<_> = inputs.iter().map(|input| quantity_and_joint(&input.to_string())).collect();
        let of_state = |state: usize| inputs.iter().map(|(quantity, joint)| motion[*quantity][state][*joint]).collect();
        (0..STATES).map(of_state).collect::<Vec<Vec<f64>>>()
    });

    let mut torques: [Vec<f64>; DOF] = std::array::from_fn(|_| vec![0.0; STATES]);
    let mut rows = vec![0.0; DOF * STATES];
    let mut tau = [0.0; DOF];
    let mut times = [f64::INFINITY; 7];
    for _ in 0..REPETITIONS {
        fastest(&mut times[0], || {
            let [q, qd, qdd] = columns.each_ref().map(|columns| columns.each_ref().map(Vec::as_slice));
            let tau = torques.each_mut().map(Vec::as_mut_slice);
            derived.inverse_dynamics_batch_on(unit, q, qd, qdd, tau).expect("columns of one length");
        });
        fastest(&mut times[1], || {
            let columns = Destination::Columns(rows.chunks_mut(STATES).collect());
            machine.code().run(unit, STATES, &sources, columns).expect("columns of one length");
        });
        fastest(&mut times[2], || {
            for state in 0..STATES {
                black_box(derived.inverse_dynamics(black_box(&q[state]), &qd[state], &qdd[state]));
            }
        });
        fastest(&mut times[3], || {
            for state in &of_machine {
                machine.code().run_one(unit, state, &mut tau).expect("a state");
                black_box(&tau);
            }
        });
        fastest(&mut times[4], || {
            for state in &of_native {
                native.call(state, &mut tau).expect("a state");
                black_box(&tau);
            }
        });
        fastest(&mut times[5], || {
            let mut before = 0.0;
            for state in 0..STATES {
                let q = q[state].map(|angle| angle + before);
                before = derived.inverse_dynamics(&q, &qd[state], &qdd[state])[0] * 1e-300;
            }
            black_box(before);
        });
        fastest(&mut times[6], || {
            let mut before = 0.0;
            let mut inputs = of_native[0].clone();
            for state in &of_native {
                inputs.iter_mut().zip(state).for_each(|(input, number)| *input = number + before);
                native.call(&inputs, &mut tau).expect("a state");
                before = tau[0] * 1e-300;
            }
            black_box(before);
        });
    }
    let mut build = f64::INFINITY;
    for _ in 0..BUILDS {
        fastest(&mut build, || drop(black_box(Native::<f64>::new(&latency))));
    }
    #[allow(clippy::cast_precision_loss)] // of a thousand states
    let build = build * STATES as f64 * 1e-6;
    let [derived_batch, machine_batch, derived, machine, native, derived_chained, native_chained] = times;
    format!(
        "{name:<15} {derived_batch:>8.1} {machine_batch:>8.1} {:>6.2} {derived:>8.1} {machine:>8.1} {:>6.2} \
         {native:>8.1} {:>6.2} {derived_chained:>8.1} {native_chained:>8.1} {:>6.2} {build:>6.2}",
        machine_batch / derived_batch,
        machine / derived,
        native / derived,
        native_chained / derived_chained,
    )
}

/// A line for each function on each unit.
fn functions<const DOF: usize, R>(derived: &R, name: &str)
where
    R: BatchInverseDynamics<DOF> + MassMatrix<DOF> + ForwardDynamics<DOF> + InverseDynamicsDerivatives<DOF>,
{
    let (robot, plan) = texts(name);
    let arm = CompiledArm::with_plan(robot, plan).expect("a robot that is here");
    let mut random = fastrand::Rng::with_seed(2);
    let motion: [Numbers<DOF>; 3] =
        std::array::from_fn(|_| (0..STATES).map(|_| std::array::from_fn(|_| 2.0 * random.f64() - 1.0)).collect());
    let columns = motion.each_ref().map(|numbers| columns(numbers));
    let slices = columns.each_ref().map(|columns| columns.each_ref().map(Vec::as_slice));
    let [q, qd, qdd] = slices.each_ref().map(|slices| Array::Columns(slices));
    let arguments = Arguments::new().q(q).qd(qd).qdd(qdd).tau(qdd);
    let [q, qd, qdd] = &motion;
    for unit in VectorUnit::all() {
        for function in [
            Function::InverseDynamics,
            Function::MassMatrix,
            Function::ForwardDynamics,
            Function::InverseDynamicsDerivatives,
        ] {
            let compiled = arm.function(function).expect("its plan");
            let mut results = vec![0.0; compiled.outputs() * STATES];
            let mut torques: [Vec<f64>; DOF] = std::array::from_fn(|_| vec![0.0; STATES]);
            let mut times = [f64::INFINITY; 2];
            for _ in 0..REPETITIONS {
                fastest(&mut times[0], || match function {
                    Function::InverseDynamics => {
                        let [q, qd, qdd] = slices;
                        let tau = torques.each_mut().map(Vec::as_mut_slice);
                        derived.inverse_dynamics_batch_on(unit, q, qd, qdd, tau).expect("columns of one length");
                    }
                    Function::MassMatrix => (0..STATES).for_each(|state| {
                        black_box(derived.mass_matrix(black_box(&q[state])));
                    }),
                    Function::ForwardDynamics => (0..STATES).for_each(|state| {
                        black_box(derived.forward_dynamics(black_box(&q[state]), &qd[state], &qdd[state]));
                    }),
                    _ => (0..STATES).for_each(|state| {
                        black_box(derived.inverse_dynamics_derivatives(black_box(&q[state]), &qd[state], &qdd[state]));
                    }),
                });
                fastest(&mut times[1], || {
                    let columns = Destination::Columns(results.chunks_mut(STATES).collect());
                    compiled.run(unit, STATES, &arguments, columns).expect("columns of one length");
                });
            }
            let [derived, machine] = times;
            let (unit, function) = (unit.name(), function.name());
            println!("{name:<15} {unit:<8} {function:<29} {derived:>8.1} {machine:>8.1} {:>6.2}", machine / derived);
        }
    }
}

fn program(name: &str, target: Target) -> Program {
    let (robot, plan) = texts(name);
    let robot = Robot::from_yaml(robot).expect("a robot that is here");
    let plan = PlanFile::read(name, plan, &robot).expect("its plan");
    let compiler = Compiler::new(&robot).for_target(target).with_plans(plan);
    compiler.compile(Function::InverseDynamics, Form::Reduced).expect("its plan")
}

/// `qd3`: the second quantity of the motion, the third joint.
fn quantity_and_joint(input: &str) -> (usize, usize) {
    let (quantity, joint) = input.split_at(input.trim_end_matches(|c: char| c.is_ascii_digit()).len());
    let quantity = ["q", "qd", "qdd"].iter().position(|name| *name == quantity).expect("an argument of the torques");
    (quantity, joint.parse::<usize>().expect("the number of a joint") - 1)
}

/// One column per joint.
fn columns<const DOF: usize>(numbers: &[[f64; DOF]]) -> [Vec<f64>; DOF] {
    std::array::from_fn(|joint| numbers.iter().map(|numbers| numbers[joint]).collect())
}

/// Nanoseconds per state, if it is less than before.
fn fastest(best: &mut f64, work: impl FnOnce()) {
    let start = Instant::now();
    work();
    #[allow(clippy::cast_precision_loss)] // of a thousand states
    let time = start.elapsed().as_nanos() as f64 / STATES as f64;
    *best = best.min(time);
}
