//! Measures a function: its cost, its run in QEMU, and its error.

use std::collections::BTreeMap;
use std::path::Path;

use rne_certify::accuracy::Sample;
use rne_certify::board::Call;
use rne_certify::certificate::{Certified, Cost};
use rne_certify::cycles::{self, Core, Counter};
use rne_certify::image::{Function, Image, NoFigures};
use rne_emit::Prefix;
use rne_model::Robot;

use crate::commands::certify::Arguments;
use crate::commands::certify::code::emulate;
use crate::commands::certify::subject::Subject;
use crate::commands::toolchain;
use crate::outcome::Failure;

/// The code of a robot, compiled in a folder, with the tools that measure it.
pub(super) struct Measurement<'a> {
    pub(super) arguments: &'a Arguments,
    pub(super) robot: &'a Robot,
    pub(super) prefix: &'a Prefix,
    pub(super) objdump: &'a str,
    pub(super) folder: &'a Path,
    pub(super) has_qemu: bool,
}

impl Measurement<'_> {
    /// Measures a function in its compiled image.
    pub(super) fn of(&self, subject: &Subject<'_>, call: &Call, image: &str) -> Result<Certified, Failure> {
        let &Self { arguments, robot, prefix, objdump, folder, has_qemu } = self;
        let cpu = arguments.cpu;
        let callees: Vec<String> = subject.callees().iter().map(|callee| format!("{prefix}_{callee}")).collect();
        let listing = toolchain::image(objdump, folder, image)?;
        let cost = cost(cpu, &listing, &call.function, &callees).map_err(|fault| subject.refused(&fault))?;
        let emulation = has_qemu.then(|| emulate(cpu, robot, subject, image, cost.instructions, folder)).transpose()?;
        let sample = Sample { states: arguments.states, seed: arguments.seed };
        Ok(Certified {
            function: subject.name().to_owned(),
            cost,
            emulation,
            accuracy: subject.accuracy(robot, sample)?,
            proof: subject.proof(),
        })
    }
}

/// Computes the cost of a call: that of the function and of all functions that it calls.
fn cost(core: Core, image: &Image, symbol: &str, callees: &[String]) -> Result<Cost, NoFigures> {
    // the compiler makes copies of static functions, which have a point and a suffix after the name
    let is_of = |name: &str, own: &String| name.strip_prefix(own).is_some_and(|s| s.is_empty() || s.starts_with('.'));
    let may_be_called = |name: &str| name.contains("sin_cos") || callees.iter().any(|own| is_of(name, own));
    let figures = image.straight_but_for(symbol, may_be_called)?;
    let executed = image.executed(symbol, &may_be_called)?;
    let mut counter = Counter::default();
    for name in &executed {
        counter.add(core, &image.function(name)?.lines);
    }
    let frame = |function: &Function| cycles::stack(&function.lines);
    let stack = image.deepest(symbol, &may_be_called, &frame)?;
    let worst = counter.cycles();
    let mut called = BTreeMap::new();
    for callee in executed.into_iter().skip(1) {
        *called.entry(callee).or_default() += 1;
    }
    Ok(Cost {
        instructions: figures.instructions,
        cycles: worst.total,
        bound: core.bound(),
        waits: worst.waits,
        classes: worst.classes,
        unknown: worst.unknown,
        assumptions: core.assumptions().into_iter().map(str::to_owned).collect(),
        code: figures.code,
        constants: figures.constants,
        stack: figures.stack,
        stack_of_listing: stack,
        calls: called,
    })
}
