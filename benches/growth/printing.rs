//! How long it takes to write the reduced form of arms of many joints, as `rne emit` and `rne show` do.
//!
//! ```sh
//! cargo xtask growth --arms 300    # random arms of 7 to 12 joints, every function; some minutes
//! ```
//!
//! Processor time, where the system is Linux, of one function of one arm: the choices of a build without a plan file,
//! the compilation with its proof, and the text. `rne emit FILE --function F --form reduced` does all of it, in Rust or
//! C, and so does `rne show`.

mod arms;
mod time;

use std::time::Instant;

use rne_codegen::plan::PlanSet;
use rne_codegen::{CompileError, Compiler, Form, Function, Program};
use rne_emit::{Precision, Prefix, Selection};
use rne_model::Robot;

/// No function of an arm may take longer, in seconds.
const MOST: f64 = 1.0;

/// How many of the slowest are named.
const NAMED: usize = 5;

/// What one function of one arm takes, in seconds.
struct Sample {
    arm: String,
    function: Function,
    /// The choices, the compilation, Rust, C, `rne show`.
    parts: [f64; 5],
}

impl Sample {
    /// The longest that one call takes, of `rne emit` in either language and of `rne show`.
    fn call(&self) -> f64 {
        let [choices, compilation, texts @ ..] = self.parts;
        choices + compilation + texts.into_iter().fold(0.0, f64::max)
    }
}

fn main() {
    let arms = std::env::args().nth(1).and_then(|word| word.parse().ok());
    let Some(arms) = arms.filter(|&arms: &u64| arms > 0) else {
        eprintln!("usage: printing ARMS\n\nARMS: how many random arms, 1 or more");
        std::process::exit(2);
    };
    let mut samples: Vec<Sample> = (0..arms).flat_map(measured).collect();
    samples.sort_by(|a, b| b.call().total_cmp(&a.call()));
    println!(
        "| of {} calls of {arms} arms | median, s | largest, s | above {MOST} s |\n|---|---|---|---|",
        samples.len()
    );
    let parts = ["choices", "compilation", "Rust", "C", "listing"];
    for (index, part) in parts.into_iter().enumerate() {
        row(part, samples.iter().map(|sample| sample.parts[index]).collect());
    }
    row("one call", samples.iter().map(Sample::call).collect());
    println!("\nThe slowest calls:\n");
    for Sample { arm, function, parts } in samples.iter().take(NAMED) {
        let parts = parts.map(|part| format!("{part:.2}")).join(" + ");
        println!("- {arm}, {function}: {parts} s");
    }
    if samples.first().is_some_and(|slowest| slowest.call() > MOST) {
        std::process::exit(1);
    }
}

fn row(what: &str, mut seconds: Vec<f64>) {
    seconds.sort_by(f64::total_cmp);
    let [median, largest] = [seconds.len() / 2, seconds.len() - 1].map(|at| seconds[at]);
    let above = seconds.iter().filter(|seconds| **seconds > MOST).count();
    println!("| {what} | {median:.3} | {largest:.3} | {above} |");
}

/// Every function of an arm.
fn measured(seed: u64) -> Vec<Sample> {
    let robot = Robot::from_yaml(&arms::yaml(seed)).unwrap_or_else(|report| panic!("{report}"));
    let start = Instant::now();
    let (plans, choices) = time::of(start, || PlanSet::default_of(&robot));
    let compiler = Compiler::new(&robot).with_plans(plans);
    let sample = |function| {
        let (program, compilation) = time::of(start, || compiler.compile(function, Form::Reduced));
        let program = match program {
            Ok(program) => program,
            Err(CompileError::TooLarge { .. }) => return None,
            Err(error) => panic!("{}, {function}: {error}", robot.name),
        };
        let [rust, c, listing] = texts(&robot, &program).map(|text| time::of(start, text).1);
        let parts = [choices, compilation, rust, c, listing];
        Some(Sample { arm: format!("{} of {} joints", robot.name, robot.dof()), function, parts })
    };
    Function::OF_TREES.into_iter().filter_map(sample).collect()
}

type Text<'a> = Box<dyn Fn() + 'a>;

fn texts<'a>(robot: &'a Robot, program: &'a Program) -> [Text<'a>; 3] {
    let programs = std::slice::from_ref(program);
    let what = Selection { explain: true, ..Selection::default() };
    [
        Box::new(move || drop(std::hint::black_box(rne_emit::rust_file(robot, programs)))),
        Box::new(move || {
            drop(std::hint::black_box(rne_emit::c_code(robot, programs, Precision::Double, &Prefix::of(robot))));
        }),
        Box::new(move || drop(std::hint::black_box(rne_emit::listing(robot, program, what).to_string()))),
    ]
}
