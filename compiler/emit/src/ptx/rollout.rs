//! Kernels for rollouts: a thread keeps the state of its sample in registers over all steps.

use std::fmt::Write as _;

use rne_codegen::{Function, Program, Value, ValueId};

use super::Arrangement;
use super::kernel::Kernel;
use super::writing::Writing;
use crate::wrap::{WIDTH, fill};

/// The meaning of a rollout, in the heading.
const CONTRACT: &str = "\
// ROLLOUT: positions and velocities of samples that move on under torques, by semi-implicit Euler.
//
// A step of duration h does this: accelerations of the function above for q, qd and the torques of the step;
// qd += h * acceleration; q += h * qd, with the new qd. One thread computes all steps of a sample. Parameters:
// the addresses of the arguments of the function; those of the arrays out_q and out_qd; step, the duration h in s, a
// number of the type of the arrays; steps, the number T of steps; every; states, the number of samples (each 32 bits).
// The states after the steps every, 2 * every, 3 * every, ... are written, K = T / every of them: every = 1 writes all
// states, every = T only the last. Both T and every are at least 1; with N samples of n joints, T * n is below 2^31.
// tau has T * n elements for a sample and out_q and out_qd K * n, step by step. Other arrays hold for all steps.
// The numbers are those of calls of the function above with a step of Euler after each, bit for bit.
";

/// Returns the name of the rollout kernel for a function, without the prefix; `None` for a function that does not
/// return the accelerations of all joints.
fn name(function: Function) -> Option<&'static str> {
    match function {
        Function::ForwardDynamics => Some("rollout"),
        Function::ForwardDynamicsWithPayload => Some("rollout_with_payload"),
        _ => None,
    }
}

/// Whether `rne emit --lang ptx` can write a rollout with this function.
#[must_use]
pub fn is_for_rollouts(function: Function) -> bool {
    name(function).is_some()
}

/// Returns both rollout kernels of a program, with a comment; empty for a function that returns no accelerations.
pub(super) fn text(prefix: &str, kernel: &Kernel<'_>) -> String {
    let Some(name) = name(kernel.program.function) else { return String::new() };
    let mut text = format!("\n{}", CONTRACT.replace("ROLLOUT", name));
    for (arrangement, end) in [(Arrangement::Columns, "columns"), (Arrangement::Rows, "rows")] {
        let _ = write!(text, "\n{}", kernel.rollout(&format!("{prefix}_{name}_{end}"), arrangement));
    }
    text
}

/// Returns the argument of a program that has this name.
fn argument(program: &Program, name: rne_codegen::Name) -> Option<ValueId> {
    let mut values = program.values.iter();
    let is_it = |&(id, value): &(ValueId, Value)| value == Value::Argument && program.values.name(id) == Some(name);
    values.find(is_it).map(|(id, _)| id)
}

impl Kernel<'_> {
    fn rollout(&self, name: &str, arrangement: Arrangement) -> String {
        let dof = self.program.outputs.len();
        let mut writing = Writing::of(self, arrangement, "global");
        let start = self.load_state(&mut writing);
        let step = self.step_of_euler(&mut writing);
        let stores = self.store_state(&mut writing);
        let inputs = self.arrays.iter().map(|array| (format!("in_{}", array.name), array.elements.len()));
        let arrays: Vec<(String, usize)> =
            inputs.chain([("out_q".to_owned(), dof), ("out_qd".to_owned(), dof)]).collect();
        self.head_of_rollout(name, &writing, &arrays)
            + &self.first_addresses(arrangement, &arrays)
            + &start
            + "next_step:\n"
            + &step
            + "    add.u32 %left, %left, 4294967295;\n    setp.ne.u32 %is_left, %left, 0;\n    \
               @%is_left bra not_written;\n    mov.u32 %left, %every;\n"
            + &stores
            + "    add.u64 %out_q, %out_q, %out_step;\n    add.u64 %out_qd, %out_qd, %out_step;\nnot_written:\n    \
               add.u64 %in_tau, %in_tau, %tau_step;\n    add.u32 %steps, %steps, 4294967295;\n    \
               setp.ne.u32 %is_left, %steps, 0;\n    @%is_left bra next_step;\n    ret;\n}\n"
    }

    /// Returns code that loads positions and velocities into registers, where the values of a step read them.
    fn load_state(&self, writing: &mut Writing<'_, '_>) -> String {
        let (real, _) = self.number();
        for array in self.arrays.iter().filter(|array| matches!(array.name, "q" | "qd")) {
            for (joint, element) in array.elements.iter().enumerate() {
                let register = format!("%{}{joint}", array.name);
                let place = writing.place(&format!("%in_{}", array.name), joint);
                let _ = writeln!(writing.body, "    ld.global.nc.{real} {register}, {place};");
                if let Some(id) = element.and_then(|name| argument(&self.program, name)) {
                    writing.known[id.index()].clone_from(&register);
                }
                writing.registers.push(register);
            }
        }
        std::mem::take(&mut writing.body)
    }

    /// Returns code that computes the accelerations, and from them the next velocities and positions.
    fn step_of_euler(&self, writing: &mut Writing<'_, '_>) -> String {
        let (real, _) = self.number();
        writing.values(false);
        let accelerations: Vec<String> =
            self.program.outputs.iter().map(|output| writing.operand(output.value)).collect();
        for (joint, acceleration) in accelerations.iter().enumerate() {
            let _ = writeln!(
                writing.body,
                "    mul.rn.{real} %change, %step, {acceleration};\n    \
                 add.rn.{real} %qd{joint}, %qd{joint}, %change;\n    \
                 mul.rn.{real} %change, %step, %qd{joint};\n    add.rn.{real} %q{joint}, %q{joint}, %change;"
            );
        }
        std::mem::take(&mut writing.body)
    }

    /// Returns code that stores positions and velocities.
    fn store_state(&self, writing: &mut Writing<'_, '_>) -> String {
        let (real, _) = self.number();
        for array in ["q", "qd"] {
            for joint in 0..self.program.outputs.len() {
                let place = writing.place(&format!("%out_{array}"), joint);
                let _ = writeln!(writing.body, "    st.global.{real} {place}, %{array}{joint};");
            }
        }
        std::mem::take(&mut writing.body)
    }

    /// Returns the declarations of the parameters and the registers of a rollout, and code that counts its steps; a
    /// thread without a sample returns.
    fn head_of_rollout(&self, name: &str, writing: &Writing<'_, '_>, arrays: &[(String, usize)]) -> String {
        let (real, bytes) = self.number();
        let mut text = format!(".visible .entry {name}(\n");
        for (array, _) in arrays {
            let _ = writeln!(text, "    .param .u64 {array},");
        }
        let registers = writing.registers.iter().map(String::as_str).chain(["%step", "%change"]).collect::<Vec<_>>();
        let registers = fill(&registers.join(", "), WIDTH, &format!("    .reg .{real} "), "        ");
        let by_states = match writing.arrangement {
            Arrangement::Columns => "mul.wide.u32 %tau_step, %states,",
            Arrangement::Rows => "mov.u64 %tau_step,",
        };
        let _ = write!(
            text,
            "    .param .{real} step,\n    .param .u32 steps,\n    .param .u32 every,\n    .param .u32 states)\n\
             .maxntid 256, 1, 1\n{{\n{registers};\n    \
             .reg .u32 %index, %block, %width, %states, %steps, %every, %left, %kept;\n    \
             .reg .u64 %a<{}>, %first, %tau_step, %out_step;\n    \
             .reg .pred %is_beyond, %is_above, %is_below, %is_left;\n    mov.u32 %block, %ctaid.x;\n    \
             mov.u32 %index, %tid.x;\n    mov.u32 %width, %ntid.x;\n    \
             mad.lo.u32 %index, %block, %width, %index;\n    ld.param.u32 %states, [states];\n    \
             setp.ge.u32 %is_beyond, %index, %states;\n    @%is_beyond ret;\n    \
             ld.param.u32 %steps, [steps];\n    ld.param.u32 %every, [every];\n    \
             ld.param.{real} %step, [step];\n    mov.u32 %left, %every;\n    \
             div.u32 %kept, %steps, %every;\n    {} {};\n    mov.u64 %out_step, %tau_step;\n",
            writing.addresses + 1,
            by_states,
            self.program.outputs.len() * bytes
        );
        text
    }

    /// Returns code for the addresses of a thread's numbers at the first step.
    fn first_addresses(&self, arrangement: Arrangement, arrays: &[(String, usize)]) -> String {
        let (_, bytes) = self.number();
        let mut text = String::new();
        for (array, length) in arrays {
            let _ = writeln!(
                text,
                "    .reg .u64 %{array};\n    ld.param.u64 %{array}, [{array}];\n    \
                 cvta.to.global.u64 %{array}, %{array};"
            );
            let size = length * bytes;
            let _ = match (arrangement, array.as_str()) {
                (Arrangement::Columns, _) => writeln!(text, "    mad.wide.u32 %{array}, %index, {bytes}, %{array};"),
                (Arrangement::Rows, "in_tau" | "out_q" | "out_qd") => {
                    let steps = if array == "in_tau" { "%steps" } else { "%kept" };
                    writeln!(
                        text,
                        "    mul.wide.u32 %first, %index, {steps};\n    mad.lo.u64 %{array}, %first, {size}, %{array};"
                    )
                }
                (Arrangement::Rows, _) => writeln!(text, "    mad.wide.u32 %{array}, %index, {size}, %{array};"),
            };
        }
        text
    }
}
