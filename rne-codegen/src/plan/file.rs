//! Plan files: the choices for one robot, replayed by every build.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::str::FromStr;

use rne_model::{Convention, JointKind, MAX_BYTES, Report, Robot, check_yaml, robot_of};
use serde::de::{self, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::choices::{Plan, parsed};
use super::plan_set::PlanSet;
use crate::ir::Cost;
use crate::program::{Program, Proof};
use crate::prove;
use crate::reduced::algorithm::Algorithm;
use crate::{CompileError, Function};

/// A plan file, as it stands on disk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanFile {
    format: u32,
    /// The robot's name.
    pub robot: String,
    /// Fingerprint of the robot's numbers.
    pub fingerprint: Fingerprint,
    /// The reduced form.
    pub reduced: Reduced,
    /// The graphs that have been rewritten, each with the plan of the graph that it was made from.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty", deserialize_with = "each_once")]
    pub rewritten: BTreeMap<Function, Rewritten>,
}

/// A mapping in which no key stands twice.
fn each_once<'de, D: Deserializer<'de>>(deserializer: D) -> Result<BTreeMap<Function, Rewritten>, D::Error> {
    struct EachOnce;

    impl<'de> Visitor<'de> for EachOnce {
        type Value = BTreeMap<Function, Rewritten>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a rewritten graph per function")
        }

        fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Self::Value, M::Error> {
            let mut all = BTreeMap::new();
            while let Some((function, rewritten)) = map.next_entry()? {
                if all.insert(function, rewritten).is_some() {
                    return Err(de::Error::custom(format_args!("duplicate function `{function}`")));
                }
            }
            Ok(all)
        }
    }

    deserializer.deserialize_map(EachOnce)
}

/// What decides whether the rest of a plan file is to be read at all.
#[derive(Deserialize)]
struct Heading {
    format: u32,
    robot: String,
    fingerprint: Fingerprint,
}

/// The choices of the reduced form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reduced {
    /// Operations of `inverse_dynamics`.
    pub operations: Cost,
    /// How precise it is.
    pub accuracy: Accuracy,
    /// The choices.
    pub plan: Plan,
}

/// The rewritten graph of a function.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rewritten {
    /// Operations of the function.
    pub operations: Cost,
    /// How precise it is.
    pub accuracy: Accuracy,
    /// How the function was written under the plan.
    #[serde(default, skip_serializing_if = "Algorithm::is_rnea")]
    pub(crate) algorithm: Algorithm,
    /// The plan that gives the graph its numbers; none for a function that the choices of a plan do not touch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<Plan>,
    /// One operation per line.
    pub graph: String,
}

/// Largest differences from the seven steps, in parts of the largest torque, with two digits: for people.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Accuracy {
    /// In double precision.
    #[serde(deserialize_with = "measured")]
    pub double: f64,
    /// In single precision.
    #[serde(deserialize_with = "measured")]
    pub single: f64,
    /// Of the seven steps themselves in single precision.
    #[serde(deserialize_with = "measured")]
    pub single_of_seven_steps: f64,
}

/// A difference: finite, and not negative.
fn measured<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    let difference = f64::deserialize(deserializer)?;
    if difference.is_finite() && difference >= 0.0 {
        return Ok(difference);
    }
    Err(de::Error::custom(format_args!("`{difference}` is no accuracy, which is a number from 0 on")))
}

impl From<&Proof> for Accuracy {
    fn from(proof: &Proof) -> Self {
        let rounded = |value: f64| format!("{value:.1e}").parse().unwrap_or(value);
        Self {
            double: rounded(proof.rounding),
            single: rounded(proof.single),
            single_of_seven_steps: rounded(proof.single_of_seven_steps),
        }
    }
}

/// A number that stands for all numbers of a robot that its torques depend on: 16 hexadecimal digits in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(into = "String")]
pub struct Fingerprint(u64);

impl From<Fingerprint> for String {
    fn from(Fingerprint(number): Fingerprint) -> Self {
        format!("{number:016x}")
    }
}

impl<'de> Deserialize<'de> for Fingerprint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        parsed(deserializer)
    }
}

impl FromStr for Fingerprint {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = u64::from_str_radix(text, 16).ok().map(Self);
        // the same digits, and nothing else: no sign, no capitals
        number
            .filter(|&number| String::from(number) == text)
            .ok_or_else(|| format!("`{}` is no fingerprint, which has 16 hexadecimal digits", text.escape_debug()))
    }
}

/// The format of plan files.
const FORMAT: u32 = 2;

/// A fingerprint of all numbers of a robot that its torques depend on.
#[must_use]
pub fn fingerprint(robot: &Robot) -> Fingerprint {
    let mut numbers: Vec<f64> = vec![match robot.convention {
        Convention::Standard => 1.0,
        Convention::Modified => 2.0,
    }];
    numbers.extend(robot.gravity);
    numbers.extend(robot.tool.xyz);
    numbers.extend(robot.tool.rpy.map(|angle| angle.radians));
    // kinematics depend on it; plans of arms without a base are older than this
    let base: Vec<f64> = robot.base.xyz.into_iter().chain(robot.base.rpy.map(|angle| angle.radians)).collect();
    if base.iter().any(|number| *number != 0.0) {
        numbers.extend(base);
    }
    for joint in &robot.joints {
        let (row, (inertia, _)) = (&joint.row, &joint.written_inertia);
        numbers.push(if row.kind == JointKind::Revolute { 1.0 } else { 2.0 });
        numbers.extend([row.dh.theta.radians, row.dh.d, row.dh.a, row.dh.alpha.radians, row.link.mass]);
        numbers.extend(row.link.com);
        numbers.extend(inertia.rows().into_iter().flatten());
        numbers.extend(row.link.inertia.rows().into_iter().flatten());
    }
    // FNV-1a; -0 is 0
    let bytes = numbers.iter().flat_map(|x| (x + 0.0).to_bits().to_le_bytes());
    let hash =
        bytes.fold(0xCBF2_9CE4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3));
    Fingerprint(hash)
}

impl PlanFile {
    /// What a search found for a robot.
    pub(super) fn new(robot: &Robot, reduced: Reduced, rewritten: BTreeMap<Function, Rewritten>) -> Self {
        Self { format: FORMAT, robot: robot.name.clone(), fingerprint: fingerprint(robot), reduced, rewritten }
    }

    /// Reads a plan file and checks that it belongs to `robot`; `name` is what messages call it.
    ///
    /// # Errors
    /// What is wrong with it, with line and column.
    pub fn read(name: &str, text: &str, robot: &Robot) -> Result<Self, Report> {
        let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
        let refused = |keys: &[&str], message: String| {
            Report::of_error(name, text, value_of(text, keys), message, Some(&refresh(name)))
        };
        if text.len() > MAX_BYTES {
            let message = format!("the file has more than {MAX_BYTES} bytes (1 MiB), the most that a plan may have");
            return Err(Report::of_error(name, "", 0..0, message, Some(&refresh(name))));
        }
        if text.lines().map(str::trim_start).all(|line| line.is_empty() || line.starts_with('#')) {
            return Err(refused(&[], "the plan file is empty".to_owned()));
        }
        // serde reads without limits
        check_yaml(name, text).map_err(|mut report| {
            report.diagnostics.iter_mut().for_each(|found| found.help = Some(refresh(name)));
            report
        })?;
        let invalid = |error: serde_yaml::Error| invalid(name, text, &error);
        // a plan of another version, or of another robot, may have other keys
        let heading: Heading = serde_yaml::from_str(text).map_err(invalid)?;
        if heading.format != FORMAT {
            let message = format!("a plan file of this version of rne has `format: {FORMAT}`");
            return Err(refused(&["format"], message));
        }
        if heading.robot != robot.name {
            let message = format!("this plan is of `{}`, not of `{}`", heading.robot.escape_debug(), robot.name);
            return Err(refused(&["robot"], message));
        }
        if heading.fingerprint != fingerprint(robot) {
            let message = format!(
                "this plan is not of `{}` as it is now: the numbers of its robot file have changed",
                robot.name
            );
            return Err(refused(&["fingerprint"], message));
        }
        let file: Self = serde_yaml::from_str(text).map_err(invalid)?;
        let rewritten = file.rewritten.iter();
        let rewritten =
            rewritten.filter_map(|(function, of)| Some((vec!["rewritten", function.name()], of.plan.as_ref()?)));
        for (mut keys, plan) in std::iter::once((vec!["reduced"], &file.reduced.plan)).chain(rewritten) {
            let count = plan.joints.len();
            if count != robot.dof() {
                let message = format!("this plan has {count} joints, `{}` has {}", robot.name, robot.dof());
                keys.push("joints");
                return Err(refused(&keys, message));
            }
        }
        for (function, rewritten) in &file.rewritten {
            let known = Algorithm::of(*function);
            let (key, message) = match rewritten.plan {
                _ if function.entry().is_irreducible => {
                    ("operations", format!("`{function}` has no reduced form that could be rewritten"))
                }
                _ if function.divides().is_some() && prove::divides_by_zero(robot, *function) => {
                    ("operations", format!("`{function}` divides by zero for every q: it has the seven steps only"))
                }
                Some(_) if known.is_empty() => ("plan", format!("the choices of a plan do not touch `{function}`")),
                Some(_) if !known.contains(&rewritten.algorithm) => {
                    let names: Vec<String> = known.iter().map(|&one| format!("`{}`", String::from(one))).collect();
                    ("algorithm", format!("`{function}` is written by {}", names.join(", ")))
                }
                _ => continue,
            };
            let keys = ["rewritten", function.name(), key];
            return Err(refused(if key == "operations" { &keys[..2] } else { &keys }, message));
        }
        Ok(file)
    }

    /// The functions whose programs the file describes, as a compiler takes them from it: the torques by the plan, and
    /// those that are rewritten.
    #[must_use]
    pub fn described(&self) -> Vec<(Function, PlanSet)> {
        let plan = (Function::InverseDynamics, PlanSet::from(self.reduced.plan.clone()));
        let rewritten = self.rewritten.keys().map(|&function| (function, PlanSet::from(self.clone())));
        [plan].into_iter().chain(rewritten).collect()
    }

    /// Where in the text of a plan file the cause of an error is that the compiler found in one of the functions that
    /// it describes.
    #[must_use]
    pub fn located(name: &str, text: &str, (function, plans): (Function, &PlanSet), error: &CompileError) -> Report {
        let (place, message) = match error {
            CompileError::Graph { line, message, .. } => (line_of_graph(text, function, *line), message.clone()),
            _ if !plans.rewritten.contains_key(&function) => (value_of(text, &["reduced", "plan"]), error.to_string()),
            CompileError::NotIdentical { .. } => {
                (value_of(text, &["rewritten", function.name(), "graph"]), error.to_string())
            }
            _ => (value_of(text, &["rewritten", function.name()]), error.to_string()),
        };
        Report::of_error(name, text, place, message, Some(&refresh(name)))
    }

    /// Checks that a function that it describes takes as many operations as the file says.
    ///
    /// # Errors
    /// The operations that are not those of the program.
    pub fn counts(&self, name: &str, text: &str, program: &Program) -> Result<(), Report> {
        let rewritten = self.rewritten.get(&program.function).filter(|_| program.is_rewritten);
        let written = rewritten.map_or(self.reduced.operations, |rewritten| rewritten.operations);
        let counted = program.operations();
        let counted = Cost { mul: counted.mul, add: counted.add, sincos: counted.sincos };
        if counted == written {
            return Ok(());
        }
        let message = format!(
            "the file says {} products, {} sums and {} angles; the code that its plan gives has {}, {} and {}",
            written.mul, written.add, written.sincos, counted.mul, counted.add, counted.sincos
        );
        let keys: &[&str] = if rewritten.is_some() {
            &["rewritten", program.function.name(), "operations"]
        } else {
            &["reduced", "operations"]
        };
        Err(Report::of_error(name, text, value_of(text, keys), message, Some("`rne search ROBOT.yaml` counts anew")))
    }

    /// Takes what is better in another file of the same robot, which has come about meanwhile.
    pub fn merge(&mut self, other: Self) {
        if other.reduced.operations.weight() < self.reduced.operations.weight() {
            self.reduced = other.reduced;
        }
        for (function, rewritten) in other.rewritten {
            let known = self.rewritten.get(&function);
            if known.is_none_or(|known| rewritten.operations.weight() < known.operations.weight()) {
                self.rewritten.insert(function, rewritten);
            }
        }
    }

    /// The text of the file.
    #[must_use]
    pub fn to_yaml(&self) -> String {
        // names, numbers and lists of them: nothing that YAML has no form for
        let plan = serde_yaml::to_string(self).unwrap_or_default();
        format!("{}{plan}", HEADING.replace("ROBOT", &self.robot))
    }
}

/// What a plan file says of itself.
const HEADING: &str = "\
# Choices and rewritten graphs of the reduced form of ROBOT, found by `rne search`, replayed by every build: what they
# mean, `rne show ROBOT.yaml --form reduced` and docs/reduced-form.md say. `fingerprint` is that of the robot's numbers,
# `accuracy` the largest difference from the seven steps, in parts of the largest number returned: in double precision,
# in single precision, and of the seven steps in single precision.
";

/// What helps with a plan file of that name.
fn refresh(name: &str) -> String {
    let robot = robot_of(Path::new(name)).map_or_else(|| "ROBOT.yaml".to_owned(), |path| path.display().to_string());
    format!(
        "`rne search {robot} --fresh` leaves out what is wrong in it and finds the rest anew; without the file, a \
         build chooses by itself"
    )
}

/// What the reader of YAML says, at its place.
fn invalid(name: &str, text: &str, error: &serde_yaml::Error) -> Report {
    let (at, message) = match error.location() {
        Some(location) => {
            let suffix = format!(" at line {} column {}", location.line(), location.column());
            let message = error.to_string();
            (
                byte(text, location.line(), location.column()),
                message.strip_suffix(&suffix).unwrap_or(&message).to_owned(),
            )
        }
        None => (0, error.to_string()),
    };
    // the word that begins there
    let rest = text.get(at..).unwrap_or_default();
    let length = rest.find(|c: char| c.is_whitespace() || ",:]}".contains(c)).unwrap_or(rest.len());
    let message: String = message.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    Report::of_error(name, text, at..at + length, message, Some(&refresh(name)))
}

/// The byte at a line and a column, both counted from 1.
fn byte(text: &str, line: usize, column: usize) -> usize {
    let start: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let rest = text.get(start..).unwrap_or_default();
    start + rest.char_indices().nth(column.saturating_sub(1)).map_or(rest.len(), |(at, _)| at)
}

/// The value of a key in a key …, each on a line of its own, as far as the keys are found.
fn value_of(text: &str, keys: &[&str]) -> Range<usize> {
    let mut found = 0..0;
    let mut at = 0;
    let mut keys = keys.iter().peekable();
    for line in text.split_inclusive('\n') {
        let Some(key) = keys.peek() else { break };
        if let Some(value) = line.trim_start().strip_prefix(**key).and_then(|rest| rest.strip_prefix(':')) {
            keys.next();
            let value = value.split(" #").next().unwrap_or_default().trim();
            let key = at + line.len() - line.trim_start().len();
            let start = if value.is_empty() { key } else { at + line.find(": ").map_or(0, |colon| colon + 2) };
            let blank = text.get(start..).map_or(0, |rest| rest.len() - rest.trim_start_matches(' ').len());
            found = if value.is_empty() {
                key..at + line.trim_end().len()
            } else {
                start + blank..start + blank + value.len()
            };
        }
        at += line.len();
    }
    found
}

/// A line of the graph of a function, counted from 1.
fn line_of_graph(text: &str, function: Function, line: usize) -> Range<usize> {
    let graph = value_of(text, &["rewritten", function.name(), "graph"]);
    let before = text.get(..graph.start).map_or(0, |before| before.matches('\n').count());
    let start = byte(text, before + 1 + line, 1);
    let content = text.get(start..).and_then(|rest| rest.lines().next()).unwrap_or_default();
    let blank = content.len() - content.trim_start().len();
    start + blank..start + content.len()
}
