//! The certificate of functions of one arm: its data, and its page.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Serialize;

use crate::accuracy::Error;
use crate::cycles::Class;
use crate::misra;

/// The data of a certificate.
#[derive(Clone, Debug, Serialize)]
pub struct Certificate {
    /// The command that makes this certificate.
    pub command: String,
    /// The name of the arm.
    pub robot: String,
    /// The language of the code: `c` or `rust`.
    pub language: &'static str,
    /// The form of the code.
    pub form: String,
    /// The core, by its name for `-mcpu`.
    pub core: String,
    /// Versions of the tools, by their names.
    pub tools: BTreeMap<String, String>,
    /// Options of the compiler.
    pub options: Vec<String>,
    /// The command that writes the certified code.
    pub emit: String,
    /// SHA-256 hashes, by the names of the hashed data.
    pub hashes: BTreeMap<String, String>,
    /// The certified function, or the first of several.
    #[serde(flatten)]
    pub first: Certified,
    /// The other functions.
    pub more: Vec<Certified>,
    /// Whether the file of the code also contains tests, which `RNE_TEST` enables.
    pub tests: bool,
    /// Violated rules of MISRA C:2012, with the number of violations; absent if cppcheck is not installed.
    pub misra: Option<BTreeMap<String, usize>>,
    /// The lines of the code with the equations from which they come.
    pub trace: Vec<Traced>,
}

/// A certified function with its results.
#[derive(Clone, Debug, Serialize)]
pub struct Certified {
    /// The name of the function in the code, without the prefix.
    pub function: String,
    /// The cost of a call of the function.
    pub cost: Cost,
    /// The measurement in QEMU; absent if it is not installed.
    pub emulation: Option<Emulation>,
    /// The error of the results.
    pub accuracy: Accuracy,
    /// Sentences on the comparison of the code with the recursive Newton-Euler algorithm.
    pub proof: Vec<String>,
}

/// The cost of a call.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Cost {
    /// Instructions of a call, including those of the functions that it calls.
    pub instructions: u64,
    /// Cycles of a call in the worst case, by the table of the core.
    pub cycles: u64,
    /// The meaning of the cycles in words: a worst case, or an estimate of it.
    pub bound: &'static str,
    /// Number of these cycles in which an instruction waits for the result of the previous one.
    pub waits: u64,
    /// The kinds of instructions.
    pub classes: Vec<Class>,
    /// Instructions that are not in the table of the core.
    pub unknown: Vec<String>,
    /// The assumptions of the table.
    pub assumptions: Vec<String>,
    /// Bytes of instructions.
    pub code: u64,
    /// Bytes of constants.
    pub constants: u64,
    /// Bytes of stack of the deepest chain of calls, from the frames that the compiler records or, without these, from
    /// the instructions.
    pub stack: u64,
    /// Bytes of stack of the deepest chain of calls, from the instructions.
    pub stack_of_listing: u64,
    /// The functions that are called, with the numbers of calls.
    pub calls: BTreeMap<String, usize>,
}

/// The measurement in QEMU.
#[derive(Clone, Debug, Serialize)]
pub struct Emulation {
    /// QEMU's name of the board.
    pub machine: String,
    /// Instructions of a call, measured by the timer.
    pub instructions: u64,
    /// Number of states at which the results have the same bits as on the host.
    pub states: usize,
}

/// The error of the results.
#[derive(Clone, Debug, Serialize)]
pub struct Accuracy {
    /// The choice of the states, in words.
    pub how: String,
    /// Number of states.
    pub states: usize,
    /// The seed of the random numbers.
    pub seed: u64,
    /// The ranges of the joints, in words.
    pub ranges: Vec<String>,
    /// The errors of the numbers of the result.
    pub results: Vec<NamedError>,
}

/// The error of a number of the result.
#[derive(Clone, Debug, Serialize)]
pub struct NamedError {
    /// The name of the number.
    pub name: String,
    /// The name of its joint; `None` for a number of the base.
    pub joint: Option<String>,
    /// The unit of the number.
    pub unit: &'static str,
    /// The error of the number.
    #[serde(flatten)]
    pub error: Error,
}

/// A line of the code.
#[derive(Clone, Debug, Serialize, PartialEq, Eq)]
pub struct Traced {
    /// The number of the line in the source.
    pub line: usize,
    /// The name of the value that the line computes.
    pub name: String,
    /// The step, from the comment in the code.
    pub step: String,
    /// The equations of the step.
    pub equations: String,
}

/// Returns the statements of a function in emitted C or Rust, with the step and its equations from the comments above
/// them.
///
/// `head` is the beginning of the function: `arm_inverse_dynamics(` in C, `fn inverse_dynamics<` in Rust. `joints` are
/// the names of the joints in the order of the elements of q.
#[must_use]
pub fn trace(source: &str, head: &str, joints: &[&str]) -> Vec<Traced> {
    let mut traced = Vec::new();
    let mut lines = source.lines().enumerate().skip_while(|(_, line)| !line.contains(head));
    let Some((start, _)) = lines.by_ref().find(|(_, line)| line.trim_end() == "{" || line.ends_with('{')) else {
        return traced;
    };
    let (mut step, mut equations) = (String::new(), Vec::<String>::new());
    let mut is_comment = false;
    for (index, line) in source.lines().enumerate().skip(start + 1) {
        if line == "}" {
            break;
        }
        let words = line.trim();
        if let Some(comment) = words.strip_prefix("// ") {
            if is_comment {
                equations.push(comment.to_owned());
            } else {
                (step, equations) = (comment.to_owned(), Vec::new());
            }
            is_comment = true;
            continue;
        }
        is_comment = false;
        let is_statement = words.contains(" = ") || words.ends_with(" =");
        // a long expression may begin on the next line
        let left = words.split(" =").next().unwrap_or_default();
        if let Some(name) = left.split_whitespace().last().filter(|_| is_statement) {
            // results are stored after all steps, and do not belong to a step
            let (step, equations) = match result(left, joints).filter(|_| step.contains(", step ")) {
                Some(result) => (result, String::new()),
                None if step.is_empty() => ("argument".to_owned(), String::new()),
                None => (step.clone(), equations.join("; ")),
            };
            traced.push(Traced { line: index + 1, name: name.to_owned(), step, equations });
        } else if words.contains("_sin_cos(") {
            let names = words.split(['&', ',', ')']).filter(|word| words.contains(&format!("&{word}")));
            let name = names.filter(|word| !word.is_empty()).collect::<Vec<_>>().join(", ");
            traced.push(Traced { line: index + 1, name, step: step.clone(), equations: String::new() });
        }
    }
    traced
}

/// Describes an element of the result, such as `tau[1]` or `torques->wrench.force[0]`, in words; `None` for a variable.
fn result(place: &str, joints: &[&str]) -> Option<String> {
    let (array, index) = place.strip_suffix(']')?.rsplit_once('[')?;
    let is_of_base = ["force", "moment"].iter().any(|part| array.ends_with(&format!(".{part}")));
    let joint = joints.get(index.parse::<usize>().ok()?).filter(|_| !is_of_base && !array.ends_with(']'));
    Some(joint.map_or("result".to_owned(), |joint| format!("result: joint {joint}")))
}

impl Certificate {
    /// Returns the page in Markdown.
    #[must_use]
    pub fn page(&self) -> String {
        let functions: Vec<String> = self.functions().map(|of| format!("`{}`", of.function)).collect();
        let mut text = format!(
            "# Certificate of {} of {} on {}\n\nThis command writes the page:\n\n```sh\n{}\n```\n\n",
            functions.join(", "),
            self.robot,
            self.core,
            self.command
        );
        self.tools_and_files(&mut text);
        for certified in self.functions() {
            // a page about one function names it only in the title
            let of = if self.more.is_empty() { String::new() } else { format!(" of `{}`", certified.function) };
            certified.costs(&mut text, &self.form, &of);
            certified.emulated(&mut text, &of);
            certified.errors(&mut text, &of);
            let _ = writeln!(text, "\n## Comparison with the recursive Newton-Euler algorithm{of}\n");
            for line in &certified.proof {
                let _ = writeln!(text, "- {line}");
            }
        }
        self.rules(&mut text);
        text
    }

    fn functions(&self) -> impl Iterator<Item = &Certified> {
        std::iter::once(&self.first).chain(&self.more)
    }

    fn tools_and_files(&self, text: &mut String) {
        text.push_str("## Tools and files\n\n| tool | version |\n|---|---|\n");
        for (tool, version) in &self.tools {
            let _ = writeln!(text, "| {tool} | {version} |");
        }
        let _ = writeln!(text, "\nOptions of the compiler: `{}`\n", self.options.join(" "));
        let _ = writeln!(
            text,
            "This command writes the code. A file with more functions has another hash, and this page is not about \
             it:\n\n```sh\n{}\n```\n",
            self.emit
        );
        text.push_str("| file | SHA-256 |\n|---|---|\n");
        for (file, hash) in &self.hashes {
            let _ = writeln!(text, "| {file} | `{hash}` |");
        }
    }

    fn rules(&self, text: &mut String) {
        text.push_str("\n## MISRA C:2012\n\n");
        let Some(violations) = &self.misra else {
            text.push_str(if self.language == "c" {
                "Not checked: cppcheck is not installed (Debian: `apt-get install cppcheck`).\n"
            } else {
                "Not checked: the rules are for C.\n"
            });
            return;
        };
        text.push_str("The addon `misra` of cppcheck reports these rules; the texts of the rules are not free.\n\n");
        text.push_str("| rule | reports | deviation |\n|---|---:|---|\n");
        for (rule, count) in violations {
            let why = misra::deviation(rule).unwrap_or("NO DEVIATION IS RECORDED");
            let _ = writeln!(text, "| {rule} | {count} | {why} |");
        }
        if self.tests {
            text.push_str(
                "\nThe tests at the end of the file, behind `RNE_TEST`, are test code: cppcheck reads the file without \
                 them.\n",
            );
        }
        let undecided = misra::NOT_DECIDED.join(", ");
        let _ = writeln!(text, "\nThe addon of cppcheck 2.10 contains no check for these rules: {undecided}.");
    }
}

impl Certified {
    fn costs(&self, text: &mut String, form: &str, of: &str) {
        let cost = &self.cost;
        let calls: Vec<String> = cost.calls.iter().map(|(name, count)| format!("`{name}` {count}×")).collect();
        let calls = if calls.is_empty() { "none".to_owned() } else { calls.join(", ") };
        let _ = write!(
            text,
            "\n## Cost of a call{of}\n\n| property | value |\n|---|---|\n\
             | form | {form} |\n| instructions, each of which a call executes once | {} |\n\
             | cycles, {} | {} |\n| bytes of instructions | {} |\n\
             | bytes of constants | {} |\n| bytes of stack, with the functions that are called | {} |\n\
             | bytes of stack that the instructions show | {} |\n| calls | {calls} |\n\
             | branches, except over constants | none |\n| double precision | none |\n\n",
            cost.instructions, cost.bound, cost.cycles, cost.code, cost.constants, cost.stack, cost.stack_of_listing
        );
        text.push_str(
            "The code has one path, so the number of instructions is the same for every input, also for NaN and \
             infinities. The cycles hold under these assumptions:\n\n",
        );
        for assumption in &cost.assumptions {
            let _ = writeln!(text, "- {assumption}");
        }
        text.push_str("\n| kind | mnemonics | instructions | cycles |\n|---|---|---:|---:|\n");
        for Class { what, mnemonics, instructions, cycles } in &cost.classes {
            let _ = writeln!(text, "| {what} | {} | {instructions} | {cycles} |", mnemonics.join(", "));
        }
        let _ = writeln!(text, "| wait for the result before | | | {} |", cost.waits);
        if !cost.unknown.is_empty() {
            let unknown = cost.unknown.join(", ");
            let _ = writeln!(text, "\nThe table does not know {unknown}: each counts as 16 cycles.");
        }
    }

    fn emulated(&self, text: &mut String, of: &str) {
        let _ = writeln!(text, "\n## Emulation{of}\n");
        let _ = match &self.emulation {
            Some(Emulation { machine, instructions, states }) => writeln!(
                text,
                "QEMU runs the code on the board `{machine}`. The timer SysTick measures {instructions} instructions \
                 for a call, the number that the listing shows. At {states} states, the results have the same bits as \
                 on the host."
            ),
            None => writeln!(text, "Not run: QEMU is not installed (Debian: `apt-get install qemu-system-arm`)."),
        };
    }

    fn errors(&self, text: &mut String, of: &str) {
        let Accuracy { how, ranges, results, .. } = &self.accuracy;
        let _ = write!(
            text,
            "\n## Error in single precision{of}\n\n{how} At each \
             state, interval arithmetic in `f64`, rounded outwards, encloses the exact result for the numbers of the \
             robot file. The bound is the distance of the `f32` result from the farthest end of this interval, so it \
             holds at each of these states. It says nothing about other states.\n\nRanges of the states:\n\n"
        );
        for range in ranges {
            let _ = writeln!(text, "- {range}");
        }
        text.push_str(
            "\n| result | joint | unit | largest magnitude | largest bound of the error | at state |\n\
             |---|---|---|---:|---:|---:|\n",
        );
        for NamedError { name, joint, unit, error: Error { largest, bound, state } } in results {
            let joint = joint.as_deref().unwrap_or("-").replace('|', "\\|");
            let bound = if *bound == 0.0 { "0".to_owned() } else { format!("{bound:.2e}") };
            let _ = writeln!(text, "| {name} | {joint} | {unit} | {largest:.4} | {bound} | {state} |");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::trace;

    #[test]
    fn lines_have_their_steps() {
        let source = "// head\nvoid a_f(\n    const float q[1], float tau[1])\n{\n    const float q1 = q[0];\n\n    \
                      // constants\n    const float k_1 = 0.5f;\n\n    // joint 1, step 1: angular velocity\n    \
                      // ω1 = z\n    const float w1_z = q1\n        + k_1;\n\n    a_sin_cos(q1, &s1, &c1);\n    \
                      const float w1_y =\n        w1_z;\n    out->wrench.force[0] = w1_y;\n    tau[0] = w1_z;\n    \
                      tau[1] =\n        w1_z;\n}\n";
        let traced = trace(source, "a_f(", &["waist", "elbow"]);
        let lines: Vec<_> = traced.iter().map(|line| (line.line, line.name.as_str(), line.step.as_str())).collect();
        let step = "joint 1, step 1: angular velocity";
        let expected = [
            (5, "q1", "argument"),
            (8, "k_1", "constants"),
            (12, "w1_z", step),
            (15, "s1, c1", step),
            (16, "w1_y", step),
            (18, "out->wrench.force[0]", "result"),
            (19, "tau[0]", "result: joint waist"),
            (20, "tau[1]", "result: joint elbow"),
        ];
        assert_eq!(lines, expected);
        assert_eq!(traced[2].equations, "ω1 = z");
    }
}
