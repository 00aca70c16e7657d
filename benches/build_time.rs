//! What a robot file costs a build: `cargo bench --manifest-path benches/Cargo.toml --bench build_time`.
//!
//! Cargo compiles macros without optimization unless told otherwise; for what a build of the dev profile waits, add
//! `--profile dev`. Tests count work instead of time: `rne_model::Report::work`, statements, tokens.

use std::path::Path;

use divan::Bencher;
use rne_codegen::{Compiler, Form, Function};
use rne_model::{Reader, Robot};

fn main() {
    divan::Divan::default().sample_count(20).sample_size(1).config_with_args().main();
}

fn panda() -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/panda.yaml");
    std::fs::read_to_string(file).expect("the robot file")
}

#[divan::bench]
fn read_panda(bencher: Bencher) {
    let text = panda();
    bencher.bench_local(|| Robot::from_yaml(&text).is_ok());
}

/// Parameters that share one expression of the largest size.
#[divan::bench]
fn read_shared_expressions(bencher: Bencher) {
    let parameters = (0..1900).fold(String::new(), |lines, index| format!("{lines}  p{index}: *p\n"));
    let expression = format!("{}1", " ".repeat(9000));
    let text = panda() + &format!("\nparameters:\n  p: &p \"{expression}\"\n{parameters}");
    bencher.bench_local(|| Reader::new("panda.yaml").read(&text).is_ok());
}

/// What the derive of `InverseDynamics` does behind the reading.
#[divan::bench(args = [Form::SevenSteps, Form::Reduced])]
fn expand_panda(bencher: Bencher, form: Form) {
    let robot = Robot::from_yaml(&panda()).unwrap_or_else(|report| panic!("{report}"));
    bencher.bench_local(|| {
        let compiler = Compiler::new(&robot);
        let programs = Function::TORQUES
            .map(|function| compiler.compile(function, form).unwrap_or_else(|error| panic!("{error}")));
        rne_emit::rust_file(&robot, &programs).len()
    });
}
