//! A rewritten graph as text: its values in order, without names of their own.
//!
//! ```text
//! constants 0.4318 /1 2*1     k1 is the number of the plan that is nearest to 0.4318, k2 = 1 / k1, k3 = k1 k2
//! operations qd1*s2_3 k2*1    sines and cosines have the numbers of their joints: s2_3 = sin(q2 + q3)
//! results -1 c3 2             the numbers returned
//! ```
//!
//! A number among the operands counts back: `1` is the value before, `2` the one before that; among constants it counts
//! constants, and operations elsewhere.

use rustc_hash::FxHashMap;

use crate::error::GraphMistake;
use crate::function::Function;
use crate::ir::{
    Builder, Graph, Number, Numbers, Op, Policy, Ref, Residue, Source, Symbol, Traced, mark_live_outside_angles,
};
use crate::reduced::choices::count;

const CONSTANTS: &str = "constants";
const OPERATIONS: &str = "operations";
const RESULTS: &str = "results";

/// Fewest digits of a number, and the largest relative difference between a number with so few digits and that of the
/// plan.
const LEAST_DIGITS: usize = 4;
const ROUNDING: f64 = 1e-3;

/// Writes a graph as text. The numbers at the places `given` are those of its plan.
pub(crate) fn written(graph: &Graph, given: &[u32]) -> String {
    let mut constants = Constants { numbers: &graph.numbers, given, places: Vec::new(), words: Vec::new() };
    let mut operations: Vec<String> = Vec::new();
    let mut values: Vec<Called> = Vec::with_capacity(graph.len());
    // angles are not written: a sine or cosine has the numbers of its joints
    let mut live = Vec::new();
    mark_live_outside_angles(&graph.nodes, &graph.outputs, &mut live);
    for (at, op) in graph.nodes() {
        let operand = |at: Ref| values[at.index()].operand(at.is_negative(), operations.len());
        let operation = match op {
            _ if !live[at.index()] => Err(Called::default()),
            Op::Constant(place) => Err(Called::Named(format!("k{}", constants.number(place)))),
            Op::Input(input) => Err(Called::Named(input.name().to_string())),
            Op::Sine(angle) => Err(Called::Named(format!("s{}", group(graph, angle)))),
            Op::Cosine(angle) => Err(Called::Named(format!("c{}", group(graph, angle)))),
            Op::Sum(a, b) if b.is_negative() => Ok(format!("{}-{}", operand(a), operand(-b))),
            Op::Sum(a, b) => Ok(format!("{}+{}", operand(a), operand(b))),
            Op::Product(a, b) => Ok(format!("{}*{}", operand(a), operand(b))),
            Op::Quotient(a, b) => Ok(format!("{}/{}", operand(a), operand(b))),
            // no function that is rewritten has a choice by a sign
            Op::BySign(_) => Err(Called::default()),
        };
        values.push(operation.map_or_else(
            |named| named,
            |operation| {
                operations.push(operation);
                Called::Operation(operations.len())
            },
        ));
    }
    let results = graph.outputs.iter().map(|at| values[at.index()].operand(at.is_negative(), operations.len()));
    let results = results.collect();
    let sections = [(CONSTANTS, constants.words), (OPERATIONS, operations), (RESULTS, results)];
    sections.into_iter().filter(|(_, words)| !words.is_empty()).map(|(name, words)| wrapped(name, &words)).collect()
}

/// How a value of a graph is called where it is used.
enum Called {
    /// By a name: an argument, a sine, a cosine, a constant.
    Named(String),
    /// An operation, by its number, counted from 1.
    Operation(usize),
}

impl Default for Called {
    fn default() -> Self {
        Self::Named(String::new())
    }
}

impl Called {
    /// The value as an operand, where `count` operations have been written.
    fn operand(&self, is_negative: bool, count: usize) -> String {
        let sign = if is_negative { "-" } else { "" };
        match self {
            Self::Named(name) => format!("{sign}{name}"),
            Self::Operation(number) => format!("{sign}{}", count + 1 - number),
        }
    }
}

/// Writes a section of the text, with line breaks.
fn wrapped(name: &str, words: &[String]) -> String {
    const WIDTH: usize = 112;
    let (mut text, mut width) = (name.to_owned(), name.len());
    for word in words {
        let is_full = width + 1 + word.len() > WIDTH;
        text.push(if is_full { '\n' } else { ' ' });
        text.push_str(word);
        width = if is_full { word.len() } else { width + 1 + word.len() };
    }
    text + "\n"
}

/// The joints whose positions are summed in an angle: `2`, or `2_4` for three of them.
fn group(graph: &Graph, angle: Ref) -> String {
    fn joints(graph: &Graph, at: Ref, found: &mut Vec<usize>) {
        match graph.op(at) {
            Op::Input(input) => found.push(input.index() + 1),
            op => op.operands().for_each(|operand| joints(graph, operand, found)),
        }
    }
    let mut found = Vec::new();
    joints(graph, angle, &mut found);
    match (found.iter().min(), found.iter().max()) {
        (Some(first), Some(last)) if first < last => format!("{first}_{last}"),
        (Some(first), _) => first.to_string(),
        _ => String::new(),
    }
}

/// Constants in the order in which they are written.
struct Constants<'a> {
    numbers: &'a Numbers,
    given: &'a [u32],
    places: Vec<u32>,
    words: Vec<String>,
}

impl Constants<'_> {
    /// Returns the number of a constant, counted from 1, after writing the constant if it has no number yet.
    fn number(&mut self, place: u32) -> usize {
        if let Some(known) = self.places.iter().position(|known| *known == place) {
            return known + 1;
        }
        let (number, source) = self.numbers.get(place);
        let word = match source {
            _ if self.given.contains(&place) => self.digits(number.to_f64()),
            // the only other number that is not computed is 1
            Source::Given => String::from("1"),
            Source::Sum(a, b) => self.made(a, "+", b),
            Source::Product(a, b) => self.made(a, "*", b),
            Source::Inverse(inverted) => {
                let number = self.number(inverted);
                format!("/{}", self.places.len() + 1 - number)
            }
        };
        self.places.push(place);
        self.words.push(word);
        self.places.len()
    }

    fn made(&mut self, a: Ref, operator: &str, b: Ref) -> String {
        let [a, b] = [a, b].map(|at| {
            let number = self.number(u32::try_from(at.index()).unwrap_or(u32::MAX));
            (if at.is_negative() { "-" } else { "" }, number)
        });
        let back = |number: usize| self.places.len() + 1 - number;
        let operator = if operator == "+" && b.0 == "-" { "" } else { operator };
        format!("{}{}{operator}{}{}", a.0, back(a.1), b.0, back(b.1))
    }

    /// Writes a number of the plan with as many digits as tell it from the others, even if rounding moves it a little.
    fn digits(&self, value: f64) -> String {
        let others = self.given.iter().map(|&place| self.numbers.get(place).0.to_f64()).chain([1.0]);
        let others = others.filter(|other| *other != value).map(|other| (other - value).abs());
        let nearest = others.fold(f64::INFINITY, f64::min);
        let short = (LEAST_DIGITS..16).map(|digits| format!("{value:.*e}", digits - 1));
        let short = short.filter_map(|text| text.parse::<f64>().ok());
        let short = short.into_iter().find(|short| 100.0 * (short - value).abs() < nearest);
        format!("{:?}", short.unwrap_or(value))
    }
}

/// Reads the graph of a text; `plain` is the graph before rewriting.
///
/// # Errors
/// The number of the wrong word, counted from 1, and the mistake in it.
pub(crate) fn read(text: &str, plain: &Graph, function: Function) -> Result<Traced, (usize, GraphMistake)> {
    let builder = Builder::traced(Policy::Numbered, plain.embedding(), function);
    let given = plain.factors().into_iter().map(|place| plain.numbers.get(place).0).chain([Number::ONE]).collect();
    let divisors =
        plain.nodes().filter_map(|(_, op)| if let Op::Quotient(_, b) = op { Some(plain.residue(b)) } else { None });
    let mut reader = Reader {
        given,
        divisors: divisors.collect(),
        builder: &builder,
        leaves: leaves(plain, &builder),
        section: "",
        constants: Vec::new(),
        operations: Vec::new(),
        results: Vec::new(),
    };
    for (index, word) in text.split_whitespace().enumerate() {
        reader.read(word).map_err(|mistake| (index + 1, mistake))?;
    }
    let (found, needed) = (reader.results.len(), plain.outputs.len());
    if found != needed {
        return Err((text.split_whitespace().count(), GraphMistake::Results { function, needed, found }));
    }
    let results = reader.results.iter().map(|result| result.at).collect();
    drop(reader);
    Ok(builder.finish(results))
}

/// Values that a graph uses without computing them: its arguments, and the sines and cosines of its angles.
fn leaves<'s>(graph: &Graph, builder: &'s Builder) -> FxHashMap<String, Symbol<'s>> {
    let mut leaves = FxHashMap::default();
    for (_, op) in graph.nodes() {
        match op {
            Op::Input(input) => _ = leaves.insert(input.name().to_string(), builder.argument(input.name())),
            Op::Sine(angle) | Op::Cosine(angle) => {
                let (sine, cosine) = builder.sine_and_cosine(angle_of(graph, angle, builder));
                let (letter, value) = if matches!(op, Op::Sine(_)) { ("s", sine) } else { ("c", cosine) };
                leaves.insert(format!("{letter}{}", group(graph, angle)), value);
            }
            _ => {}
        }
    }
    leaves
}

/// Writes an angle of one graph in another graph.
fn angle_of<'s>(graph: &Graph, at: Ref, builder: &'s Builder) -> Symbol<'s> {
    let angle = match graph.op(at) {
        Op::Input(input) => builder.argument(input.name()),
        Op::Sum(a, b) => angle_of(graph, a, builder) + angle_of(graph, b, builder),
        // an angle is a sum of positions and constants; some of these constants are plain numbers, others angles
        Op::Constant(place) if graph.factors().contains(&place) => {
            builder.number(graph.number(at.magnitude()).unwrap_or_default())
        }
        _ => graph.turn(at.magnitude()).map_or_else(|| builder.zero(), |turn| builder.angle(turn)),
    };
    angle.signed(at.is_negative())
}

/// Rebuilds a graph that was read: the numbers of its plan come first, in their places, then the graph's own numbers.
pub(crate) fn on_numbers_of(read: &Graph, plan: &Graph) -> Graph {
    let mut graph = plan.clone();
    graph.clear_nodes();
    let mut map: Vec<Ref> = Vec::with_capacity(read.len());
    let mut places: FxHashMap<u32, Ref> = FxHashMap::default();
    for node in &read.nodes {
        let at = match node.op {
            Op::Constant(place) => constant_on(&mut graph, &read.numbers, &mut places, place),
            op => graph.transcribed(op, node.residue, &map),
        };
        map.push(at);
    }
    graph.outputs = read.outputs.iter().map(|at| at.mapped(&map)).collect();
    graph
}

/// Computes a constant of another graph again, from the same operands as there.
fn constant_on(graph: &mut Graph, numbers: &Numbers, places: &mut FxHashMap<u32, Ref>, place: u32) -> Ref {
    if let Some(&known) = places.get(&place) {
        return known;
    }
    let (number, source) = numbers.get(place);
    let mut operand = |graph: &mut Graph, at: Ref| {
        let place = u32::try_from(at.index()).unwrap_or(u32::MAX);
        constant_on(graph, numbers, places, place).signed(at.is_negative())
    };
    let at = match source {
        Source::Given => graph.constant(number),
        Source::Sum(a, b) => {
            let (a, b) = (operand(graph, a), operand(graph, b));
            graph.sum(a, b).0
        }
        Source::Product(a, b) => {
            let (a, b) = (operand(graph, a), operand(graph, b));
            graph.product(a, b).0
        }
        Source::Inverse(inverted) => {
            let value = operand(graph, Ref::new(inverted as usize));
            graph.constant_inverse(value).unwrap_or_else(|| graph.zero())
        }
    };
    // the number at a place has no sign
    let at = at.magnitude();
    places.insert(place, at);
    at
}

struct Reader<'s> {
    /// The numbers of the graph before rewriting, and 1.
    given: Vec<Number>,
    /// The divisors of the graph before rewriting. No other value may be a divisor: it could be zero where these are
    /// not.
    divisors: Vec<Residue>,
    builder: &'s Builder,
    leaves: FxHashMap<String, Symbol<'s>>,
    /// The section that is being read.
    section: &'static str,
    constants: Vec<Symbol<'s>>,
    operations: Vec<Symbol<'s>>,
    results: Vec<Symbol<'s>>,
}

impl<'s> Reader<'s> {
    fn read(&mut self, word: &str) -> Result<(), GraphMistake> {
        match self.section {
            _ if [CONSTANTS, OPERATIONS, RESULTS].contains(&word) => {
                self.section = [CONSTANTS, OPERATIONS, RESULTS].into_iter().find(|name| *name == word).unwrap_or("");
            }
            CONSTANTS => self.constants.push(self.constant(word)?),
            OPERATIONS => self.operations.push(self.operation(word)?),
            RESULTS => self.results.push(self.operand(word)?),
            _ => return Err(GraphMistake::NoSection(word.to_owned())),
        }
        Ok(())
    }

    /// A constant, which is kept without its sign.
    fn constant(&self, word: &str) -> Result<Symbol<'s>, GraphMistake> {
        let constant = match (word.parse::<f64>(), word.strip_prefix('/')) {
            (Ok(value), _) => self.given(word, value)?,
            (_, Some(of)) => self.operand(of)?.inverse(),
            _ => self.operation(word)?,
        };
        Ok(self.builder.symbol(constant.at.magnitude()))
    }

    fn operation(&self, word: &str) -> Result<Symbol<'s>, GraphMistake> {
        // the first character may be a sign
        let mut signs = word.char_indices().skip(1).filter(|(_, c)| "+-*/".contains(*c));
        let (at, sign) = signs.next().ok_or_else(|| GraphMistake::NoOperation(word.to_owned()))?;
        let (a, b) = (self.operand(&word[..at])?, self.operand(&word[at + 1..])?);
        match sign {
            '+' => Ok(a + b),
            '-' => Ok(a - b),
            '*' => Ok(a * b),
            _ if self.builder.graph.borrow().is_constant(b.at) => Ok(a * b.inverse()),
            _ if self.divides_by(b.at) => Ok(self.builder.quotient(a, b)),
            _ => Err(GraphMistake::Division(word.to_owned())),
        }
    }

    fn divides_by(&self, at: Ref) -> bool {
        let graph = self.builder.graph.borrow();
        [at, -at].into_iter().any(|at| self.divisors.contains(&graph.residue(at)))
    }

    /// Returns a value by its name, or by how far back it is: `1` is the value before.
    fn operand(&self, text: &str) -> Result<Symbol<'s>, GraphMistake> {
        let (name, is_negative) = text.strip_prefix('-').map_or((text, false), |name| (name, true));
        let earlier = if self.section == CONSTANTS { &self.constants } else { &self.operations };
        let value = match (count(name), name.strip_prefix('k').and_then(count)) {
            (Some(back), _) => earlier.len().checked_sub(back).and_then(|index| earlier.get(index)),
            (_, Some(number)) => number.checked_sub(1).and_then(|index| self.constants.get(index)),
            _ => self.leaves.get(name),
        };
        let value = value.ok_or_else(|| GraphMistake::UnknownValue(name.to_owned()))?;
        Ok(value.signed(is_negative))
    }

    /// Returns the nearest number of the graph before rewriting. A change of the formulas may move a number by a
    /// rounding error.
    fn given(&self, word: &str, value: f64) -> Result<Symbol<'s>, GraphMistake> {
        if !value.is_finite() {
            return Err(GraphMistake::NotFinite(word.to_owned()));
        }
        let distance = |number: &Number| (number.to_f64() - value).abs();
        let nearest = self.given.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let nearest = nearest.filter(|number| distance(number) <= ROUNDING * value.abs());
        nearest.map(|&number| self.builder.number(number)).ok_or_else(|| GraphMistake::UnknownNumber(word.to_owned()))
    }
}
