//! Builds, reads, runs and judges the image for a board.

use std::path::Path;

use anyhow::{Result, ensure};

use crate::functions::{self, Method, Robot};
use crate::image::{self, Figures, Image};
use crate::log::{Agreement, Log};
use crate::table::Row;
use crate::tools::{self, Build};
use rne_certify::listing::Fault;

/// A processor and the options for compiling code for it.
pub(crate) struct Board<'a> {
    /// QEMU's name of a board with this processor.
    pub(crate) machine: &'static str,
    /// Flags of the compiler for this processor.
    pub(crate) flags: &'a [&'a str],
    /// Features of the board's image.
    pub(crate) features: &'a [&'a str],
}

/// The results for a board.
pub(crate) struct Examined {
    image: Image,
    log: Log,
}

/// Largest difference of results with another rounding; it is large because the terms of a torque cancel.
pub(crate) const ROUNDING: Agreement = Agreement::Within(32.0);

/// Ticks of the timer (25 MHz) during an instruction, which takes 1024 ns in QEMU.
const TICKS: f64 = 25.6;

impl Board<'_> {
    /// Builds, lists and runs the image. Fails if a function that is faulty on purpose passes.
    pub(crate) fn examine(&self, workspace: &Path) -> Result<Examined> {
        // Identical functions are not merged, so that each has its own figures.
        let mut flags = vec!["-Zemit-stack-sizes", "-Zmerge-functions=disabled"];
        flags.extend(self.flags);
        let arguments: Vec<&str> = self.features.iter().flat_map(|feature| ["--features", *feature]).collect();
        let build = Build {
            target: "thumbv7em-none-eabihf",
            linker: "arm-none-eabi-ld",
            flags: &flags,
            package: "board",
            arguments: &arguments,
        };
        let elf = build.run(workspace)?.join("board");
        let image = image::read(&elf)?;
        let log = Log::read(&tools::qemu(self.machine, &elf)?)?;
        let examined = Examined { image, log };
        examined.gate_closes()?;
        Ok(examined)
    }
}

impl Examined {
    /// Fails unless every function that is faulty on purpose is refused for the expected reason.
    fn gate_closes(&self) -> Result<()> {
        type Reason = fn(&Fault) -> bool;
        let reasons: [(&str, Reason); 4] = [
            ("panics", |fault| matches!(fault, Fault::Calls(line) if line.contains("panic"))),
            ("branches", |fault| matches!(fault, Fault::Branches(_))),
            ("doubles", |fault| matches!(fault, Fault::Calls(_) | Fault::Doubles(_))),
            ("calls", |fault| matches!(fault, Fault::Calls(_))),
        ];
        for (name, is_reason) in reasons {
            let faults = self.image.faults(&format!("board::faulty::{name}"))?;
            ensure!(faults.iter().any(is_reason), "the gate is open: the faulty function `{name}` passes");
        }
        // the same torques with another rounding
        let other_form = self.log.renamed("torques puma560 seven_steps 0", "torques puma560 reduced 0");
        let agreement = self.log.agreement_at(&other_form, "torques puma560 reduced", [0])?;
        ensure!(agreement != Agreement::Identical, "the gate is open: results of one form pass for those of another");
        Ok(())
    }

    /// Returns the figures of `inverse_dynamics` of every robot in both forms; its results may differ from the expected
    /// ones by at most `most`. Fails if the instruction count that the timer measures differs from that in the image.
    pub(crate) fn robots(&self, expected: &Log, most: Agreement) -> Result<Vec<Row>> {
        let row = |robot: Robot| {
            let Robot { name, form, dof } = robot;
            let figures = self.image.straight(&format!("robots::torques::{name}::{form}::inverse_dynamics"))?;
            let measured = self.measured(&format!("{name} {form}"), dof)?;
            #[allow(clippy::cast_precision_loss)]
            let difference = measured - figures.instructions as f64;
            ensure!(
                difference.abs() < 0.5,
                "{name} {form}: {} instructions are read in the image, {measured:.2} are measured by the timer",
                figures.instructions
            );
            let results = self.results(expected, &format!("torques {name} {form}"), most)?;
            Ok(Row { name: name.to_owned(), form: form.to_owned(), figures, results: results.to_string() })
        };
        functions::robots().into_iter().map(row).collect()
    }

    /// Returns the difference of results from the expected ones; fails if it is larger than `most`.
    fn results(&self, expected: &Log, function: &str, most: Agreement) -> Result<Agreement> {
        let agreement = self.log.agreement(expected, function)?;
        ensure!(agreement <= most, "{function}: the results are {agreement} with the host's, not {most}");
        Ok(agreement)
    }

    /// Returns the figures of all other functions of the PUMA 560, whose results must be identical to the expected
    /// ones.
    pub(crate) fn methods(&self, expected: &Log) -> Result<Vec<Row>> {
        let mut rows = Vec::new();
        for Method { name, form } in functions::methods() {
            // the compiler does not inline a long method into the function that calls it
            let [start, end] = [format!("<robots::puma560::{form}::Robot as "), format!(">::{name}::<f32>")];
            let function = format!("robots::puma560::{form}::{name}");
            let function = self.image.find(&start, &end).unwrap_or(&function);
            let results = self.results(expected, &format!("method {form} {name}"), Agreement::Identical)?;
            if self.only_moves_memory(function)? {
                continue;
            }
            let figures = self.image.straight(function)?;
            rows.push(Row { name: name.to_owned(), form: form.to_owned(), figures, results: results.to_string() });
        }
        Ok(rows)
    }

    /// Returns the figures of a tick of the controller of every robot, whose torques and external torques must be
    /// identical to the expected ones.
    pub(crate) fn controllers(&self, expected: &Log) -> Result<Vec<Row>> {
        let mut rows = Vec::new();
        for Robot { name, form, .. } in functions::controllers() {
            let results = self.results(expected, &format!("torques {name} {form}"), Agreement::Identical)?;
            if form == "tick" {
                let figures = self.image.straight(&format!("robots::torques::{name}::controller::tick"))?;
                let (form, results) = ("reduced".to_owned(), results.to_string());
                rows.push(Row { name: name.to_owned(), form, figures, results });
            }
        }
        Ok(rows)
    }

    /// Whether the only faults of a function are calls that clear or copy a known number of bytes, which the compiler
    /// uses to initialize large arrays.
    fn only_moves_memory(&self, function: &str) -> Result<bool> {
        let faults = self.image.faults(function)?;
        let moves = |fault: &Fault| fault.callee().is_some_and(|callee| callee.starts_with("__aeabi_mem"));
        Ok(!faults.is_empty() && faults.iter().all(moves))
    }

    /// Returns the instructions of one call, measured by the timer. The overhead of a call is subtracted; it is
    /// measured with a function of known length.
    pub(crate) fn measured(&self, function: &str, dof: usize) -> Result<f64> {
        let Figures { instructions, .. } = self.image.straight(&format!("board::echo::echo::<{dof}>"))?;
        let ticks = |function: &str| Ok::<_, anyhow::Error>(f64::from(self.log.ticks(function)?));
        #[allow(clippy::cast_precision_loss)]
        let known = instructions as f64;
        Ok((ticks(function)? - ticks(&format!("echo {dof}"))?) / TICKS + known)
    }

    /// Returns the instructions of the loop over a table in the image, and the difference of its results from those of
    /// the seven steps. They differ because the loop computes constants of the links in single precision, which are
    /// rounded only once in the generated code.
    pub(crate) fn runtime(&self) -> Result<(f64, Agreement)> {
        let expected = self.log.renamed("torques puma560 seven_steps 0", "torques puma560 runtime 0");
        let agreement = self.log.agreement_at(&expected, "torques puma560 runtime", [0])?;
        ensure!(
            agreement <= ROUNDING,
            "the loop over a baked-in table: its results are {agreement} with the seven steps'"
        );
        Ok((self.measured("puma560 runtime", 6)?, agreement))
    }
}
