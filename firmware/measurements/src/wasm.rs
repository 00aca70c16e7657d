//! Compiles the generated code to WebAssembly and runs it in Node.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use object::{Object, ObjectSymbol};
use robots::{STATES, State, Torques};

use crate::functions;
use crate::log::{Agreement, Log};
use crate::{object_file, tools};

const TARGET: &str = "wasm32-unknown-unknown";

/// Compares the torques of every robot and form, in single and double precision, with those of the host; fails if a bit
/// differs. Returns how many numbers were compared.
pub(crate) fn examine(workspace: &Path, expected: &Log) -> Result<usize> {
    let object = object_file::build(workspace, TARGET, &[], &["--features", "double"])?;
    let symbols = symbols(&object)?;
    let module = tools::target_folder(workspace).join(TARGET).join("robots.wasm");
    let exports = symbols.iter().map(|(_, symbol)| symbol.as_str()).chain(["__heap_base"]);
    tools::wasm_ld(&object, &module, exports)?;
    let mut calls = Calls { symbols: &symbols, text: String::new(), numbers: 0, missing: Vec::new() };
    robots::each(&mut calls);
    robots::each_double(&mut calls);
    ensure!(calls.missing.is_empty(), "the module has no {}", calls.missing.join(", "));
    let file = module.with_extension("calls");
    fs::write(&file, &calls.text)?;
    let log = Log::read(&tools::node(&workspace.join("wasm/run.mjs"), &module, &file)?)?;
    for functions::Robot { name, form, .. } in functions::robots() {
        for kind in ["torques", "double"] {
            let agreement = log.agreement(expected, &format!("{kind} {name} {form}"))?;
            ensure!(agreement == Agreement::Identical, "{kind} {name} {form}: WebAssembly is {agreement} of the host");
        }
    }
    Ok(calls.numbers)
}

/// Returns the exported functions: their paths and symbols.
fn symbols(object: &Path) -> Result<Vec<(String, String)>> {
    let bytes = fs::read(object).with_context(|| object.display().to_string())?;
    let file = object::File::parse(&*bytes)?;
    let names = file.symbols().filter_map(|symbol| symbol.name().ok().map(str::to_owned));
    let functions = names.map(|name| (format!("{:#}", rustc_demangle::demangle(&name)), name));
    Ok(functions.filter(|(path, _)| path.contains("::foreign::")).collect())
}

/// Collects the calls for Node as text.
struct Calls<'a> {
    symbols: &'a [(String, String)],
    text: String,
    numbers: usize,
    missing: Vec<String>,
}

impl Calls<'_> {
    fn add(&mut self, call: &Call, words: &[String]) {
        let Call { kind, robot, form, state, function, bytes } = call;
        let path = format!("robots::torques::{robot}::{form}::foreign::{function}");
        let Some((_, symbol)) = self.symbols.iter().find(|(known, _)| *known == path) else {
            self.missing.push(path);
            return;
        };
        let dof = words.len() / 3;
        let words = words.join(" ");
        let _ = writeln!(self.text, "{kind} {robot} {form} {state}\t{symbol}\t{bytes}\t{dof}\t{words}");
        self.numbers += dof;
    }
}

/// A call of a function at a state.
struct Call {
    kind: &'static str,
    robot: &'static str,
    form: &'static str,
    state: u32,
    function: &'static str,
    bytes: usize,
}

impl robots::Visitor for Calls<'_> {
    fn visit<const DOF: usize>(&mut self, robot: &'static str, form: &'static str, _: Torques<DOF>) {
        for number in 0..STATES {
            let State { q, qd, qdd } = State::<DOF>::new(number);
            let words = [q, qd, qdd].into_iter().flatten().map(|x| format!("{:08x}", x.to_bits()));
            let call = Call { kind: "torques", robot, form, state: number, function: "inverse_dynamics", bytes: 4 };
            self.add(&call, &words.collect::<Vec<_>>());
        }
    }
}

impl robots::Visitor<f64> for Calls<'_> {
    fn visit<const DOF: usize>(&mut self, robot: &'static str, form: &'static str, _: Torques<DOF, f64>) {
        for number in 0..STATES {
            let State { q, qd, qdd } = State::<DOF>::new(number).double();
            let words = [q, qd, qdd].into_iter().flatten().map(|x| format!("{:016x}", x.to_bits()));
            let call = Call { kind: "double", robot, form, state: number, function: "double", bytes: 8 };
            self.add(&call, &words.collect::<Vec<_>>());
        }
    }
}
