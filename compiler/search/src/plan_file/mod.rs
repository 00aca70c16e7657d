//! Plan files: the choices for one robot, which every build uses again.

mod schema;
mod shapes;
mod yaml;

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::str::FromStr;

#[cfg(doc)]
use rne_codegen::Remedy;
use rne_codegen::plan::{Accuracy, Cost, Plan, PlanSet, Rewritten, divides_by_zero};
use rne_codegen::{Algorithm, CompileError, Function, Program};
use rne_model::document::{self, Content, Node, Style};
use rne_model::{Convention, FixedFrame, JointKind, Report, Robot};

use self::shapes::Mistake;

/// A plan file, as it is stored.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanFile {
    /// The robot's name.
    pub robot: String,
    /// Fingerprint of the robot's numbers.
    pub fingerprint: Fingerprint,
    /// The reduced form.
    pub reduced: Reduced,
    /// The graphs that have been rewritten, each with the plan of the graph that it was made from.
    pub rewritten: BTreeMap<Function, Rewritten>,
}

/// The choices of the reduced form.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced {
    /// Operations of `inverse_dynamics`.
    pub operations: Cost,
    /// How precise it is.
    pub accuracy: Accuracy,
    /// The choices.
    pub plan: Plan,
}

/// A hash of all numbers of a robot that its torques depend on; in a file, 16 hexadecimal digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingerprint(u64);

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

impl FromStr for Fingerprint {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = u64::from_str_radix(text, 16).ok().map(Self);
        // only the digits that the number is written with: no sign, no capitals
        number.filter(|number| number.to_string() == text).ok_or_else(|| {
            format!("`{}` is not a fingerprint; a fingerprint has 16 hexadecimal digits", text.escape_debug())
        })
    }
}

/// The version of the format of plan files.
const FORMAT: u32 = 3;

const KIND: document::Kind = document::Kind { name: "a plan file", format: FORMAT };

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
    // kinematics depend on the base; it counts only if it is not zero, so that older plans of arms without it keep
    // their fingerprints
    let base: Vec<f64> = robot.base.xyz.into_iter().chain(robot.base.rpy.map(|angle| angle.radians)).collect();
    if base.iter().any(|number| *number != 0.0) {
        numbers.extend(base);
    }
    for joint in &robot.joints {
        let (row, (inertia, _)) = (&joint.row, &joint.written_inertia);
        numbers.push(if row.kind == JointKind::Revolute { 1.0 } else { 2.0 });
        numbers.extend([row.dh.theta.radians, row.dh.d, row.dh.a, row.dh.alpha.radians, row.link.mass]);
        numbers.extend(row.link.com);
        // a first moment of its own counts only if there is one, so that older plans of bodies keep their fingerprints
        if row.link.has_first_moment() {
            numbers.extend(row.link.first_moment);
        }
        // a branch counts only if there is one, so that older plans of chains keep their fingerprints
        if let Some(FixedFrame { on, placement }) = joint.branch {
            #[allow(clippy::cast_precision_loss)] // joints are few
            numbers.push(on.map_or(-1.0, |on| on as f64));
            numbers.extend(placement.xyz);
            numbers.extend(placement.rpy.map(|angle| angle.radians));
        }
        numbers.extend(inertia.rows().into_iter().flatten());
        numbers.extend(row.link.inertia.rows().into_iter().flatten());
    }
    // rotors on links count only if there are some, so that older plans keep their fingerprints
    for (rotor, turns) in robot.spinning_rotors() {
        #[allow(clippy::cast_precision_loss)] // joints are few
        let number = |joint: usize| joint as f64;
        numbers.extend(rotor.axis);
        numbers.extend([rotor.on.map_or(-1.0, number), rotor.inertia]);
        numbers.extend(turns.iter().flat_map(|&(joint, n)| [number(joint), n]));
    }
    // the hash is FNV-1a; adding 0 turns -0 into 0
    let bytes = numbers.iter().flat_map(|x| (x + 0.0).to_bits().to_le_bytes());
    let hash =
        bytes.fold(0xCBF2_9CE4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3));
    Fingerprint(hash)
}

impl From<PlanFile> for PlanSet {
    fn from(file: PlanFile) -> Self {
        let mut plans = Self::from(file.reduced.plan);
        plans.rewritten = file.rewritten;
        plans
    }
}

impl PlanFile {
    /// Makes the plan file of a search's result.
    pub(crate) fn new(robot: &Robot, reduced: Reduced, rewritten: BTreeMap<Function, Rewritten>) -> Self {
        Self { robot: robot.name.clone(), fingerprint: fingerprint(robot), reduced, rewritten }
    }

    /// Reads a plan file and checks that it belongs to `robot`; `name` is its name in messages.
    ///
    /// # Errors
    /// A report of what is wrong with it, with line and column; the remedy is always [`Remedy::SearchAfresh`].
    pub fn read(name: &str, text: &str, robot: &Robot) -> Result<Self, Report> {
        let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
        let refused =
            |Mistake { place, message, help }: Mistake| Report::of_error(name, text, place, message, help.as_deref());
        if text.trim().is_empty() {
            return Err(refused(Mistake::new(0..0, "the plan file is empty")));
        }
        let root = document::read(name, text, KIND)?;
        let file = schema::read(&root, robot).map_err(refused)?;
        file.fits(&root, robot).map_err(refused)?;
        Ok(file)
    }

    /// Checks that the choices and the graphs can be used for the robot.
    fn fits(&self, root: &Node, robot: &Robot) -> Result<(), Mistake> {
        let rewritten = self.rewritten.iter();
        let rewritten =
            rewritten.filter_map(|(function, of)| Some((vec!["rewritten", function.name()], of.plan.as_ref()?)));
        for (mut keys, plan) in std::iter::once((vec!["reduced"], &self.reduced.plan)).chain(rewritten) {
            let count = plan.joints.len();
            let joints = robot.joints.len();
            if count != joints {
                let message = format!("this plan has {count} joints, but `{}` has {joints}", robot.name);
                keys.extend(["plan", "joints"]);
                return Err(Mistake::new(place(root, &keys), message));
            }
        }
        for (function, rewritten) in &self.rewritten {
            let known = Algorithm::of(*function);
            let (key, message) = match rewritten.plan {
                _ if function.entry().is_irreducible => {
                    (None, format!("`{function}` has no reduced form that could be rewritten"))
                }
                _ if divides_by_zero(robot, *function) => {
                    (None, format!("`{function}` divides by zero for every q, so its only form is seven_steps"))
                }
                Some(_) if known.is_empty() => {
                    (Some("plan"), format!("the choices of a plan have no effect on `{function}`"))
                }
                Some(_) if !known.contains(&rewritten.algorithm) => {
                    let names: Vec<String> = known.iter().map(|one| format!("`{}`", one.name())).collect();
                    (Some("algorithm"), format!("the algorithms of `{function}` are {}", names.join(", ")))
                }
                _ => continue,
            };
            let keys: Vec<&str> = ["rewritten", function.name()].into_iter().chain(key).collect();
            return Err(Mistake::new(place(root, &keys), message));
        }
        Ok(())
    }

    /// Returns the functions whose programs the file describes, with the choices that a compiler takes from it: the
    /// torques by the plan, and the rewritten functions.
    #[must_use]
    pub fn described(&self, robot: &Robot) -> Vec<(Function, PlanSet)> {
        let plan = (rne_codegen::function_of_plan(robot), PlanSet::from(self.reduced.plan.clone()));
        let rewritten = self.rewritten.keys().map(|&function| (function, PlanSet::from(self.clone())));
        [plan].into_iter().chain(rewritten).collect()
    }

    /// Returns a report of an error that the compiler found in one of the functions that a plan file describes, with
    /// its place in the text; the remedy is [`Remedy::SearchAfresh`].
    #[must_use]
    pub fn located(name: &str, text: &str, (function, plans): (Function, &PlanSet), error: &CompileError) -> Report {
        let (place, message) = match error {
            CompileError::Graph { word, mistake, .. } => (word_of_graph(text, function, *word), mistake.to_string()),
            _ if !plans.rewritten.contains_key(&function) => (value_of(text, &["reduced", "plan"]), error.to_string()),
            CompileError::NotIdentical { .. } => {
                (value_of(text, &["rewritten", function.name(), "graph"]), error.to_string())
            }
            _ => (value_of(text, &["rewritten", function.name()]), error.to_string()),
        };
        Report::of_error(name, text, place, message, None)
    }

    /// Checks that a function of the file takes as many operations as the file states.
    ///
    /// # Errors
    /// A report if the numbers of operations differ from those of the program; the remedy is [`Remedy::CountAnew`].
    pub fn counts(&self, name: &str, text: &str, program: &Program) -> Result<(), Report> {
        let rewritten = self.rewritten.get(&program.function).filter(|_| program.is_rewritten);
        let written = rewritten.map_or(self.reduced.operations, |rewritten| rewritten.operations);
        let counted = program.operations();
        let counted = Cost { mul: counted.mul, add: counted.add, sincos: counted.sincos };
        if counted == written {
            return Ok(());
        }
        let message = format!(
            "the file states {} products, {} sums and {} angles; the code from its plan has {}, {} and {}",
            written.mul, written.add, written.sincos, counted.mul, counted.add, counted.sincos
        );
        let keys: &[&str] = if rewritten.is_some() {
            &["rewritten", program.function.name(), "operations"]
        } else {
            &["reduced", "operations"]
        };
        Err(Report::of_error(name, text, value_of(text, keys), message, None))
    }

    /// Takes the better results of another file of the same robot that was written in the meantime.
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
        format!("{}{}", HEADING.replace("ROBOT", &self.robot), schema::written(self).document())
    }
}

/// The comment at the head of a plan file.
const HEADING: &str = "\
# Choices and rewritten graphs of the reduced form of ROBOT, found by a search and replayed by every build;
# docs/teaching/reduced-form.md explains them. `fingerprint` is that of the robot's numbers, `accuracy` the largest
# difference from the seven steps, in parts of the largest number returned: in double precision, in single precision,
# and of the seven steps in single precision.
";

/// Returns the place of the value at a path of nested keys, or of the last key if the value is written below it. A path
/// whose keys are missing ends before them.
fn place(root: &Node, keys: &[&str]) -> Range<usize> {
    let (mut found, mut node) = (0..0, root);
    for key in keys {
        let Content::Mapping(entries) = &node.content else { break };
        let Some(entry) = entries.iter().find(|entry| entry.key == *key) else { break };
        let is_beside = matches!(&entry.value.content, Content::Scalar(scalar) if scalar.style != Style::Block);
        found = if is_beside { entry.value.span.clone() } else { entry.key_span.clone() };
        node = &entry.value;
    }
    found
}

/// Returns the [place] of a value at a path of keys in a text, which has been read before.
fn value_of(text: &str, keys: &[&str]) -> Range<usize> {
    document::read("", text, KIND).map_or(0..0, |root| place(&root, keys))
}

/// Returns the place of a word of the graph of a function; words count from 1.
fn word_of_graph(text: &str, function: Function, word: usize) -> Range<usize> {
    let graph = value_of(text, &["rewritten", function.name(), "graph"]);
    let Some((_, below)) = text.split_at_checked(graph.start) else { return graph };
    // a text that is written as a block begins below its key
    let is_below = below.starts_with("graph");
    let head = if is_below { below.find('\n').unwrap_or(below.len()) } else { 0 };
    let mut rest = below.get(head..).unwrap_or_default().trim_start();
    for _ in 1..word {
        rest = rest.trim_start_matches(|c: char| !c.is_whitespace()).trim_start();
    }
    let start = text.len() - rest.len();
    start..start + rest.find(char::is_whitespace).unwrap_or(rest.len())
}
