//! A rewritten graph as text: one operation per line, in order.
//!
//! ```text
//! k1 = 0.4318           a number of the graph before it was rewritten: the one that rounds to this
//! d1 = 1 / k1           a constant made from others, without its sign
//! t12 = t3 - t4         s2, c2 sine and cosine of joint 2, s2_4 of the summed angle of joints 2 to 4
//! t13 = d1 * qd3
//! out2 = -t13           the second number returned
//! ```

use std::collections::HashMap;
use std::fmt::Write;

use crate::function::Function;
use crate::ir::{
    Builder, Graph, Number, Numbers, Op, Policy, Ref, Residue, Source, Symbol, Traced, mark_live_outside_angles,
};
use crate::reduced::choices::count;

/// A graph as text, when the numbers in the places `given` are those of its plan.
pub(crate) fn written(graph: &Graph, given: &[u32]) -> String {
    let mut text = String::new();
    let mut constants = Constants { numbers: &graph.numbers, given, names: HashMap::new(), text: String::new() };
    let mut names: Vec<String> = vec![String::new(); graph.len()];
    let mut terms = 0;
    // angles are known by their joints
    let mut live = Vec::new();
    mark_live_outside_angles(&graph.nodes, &graph.outputs, &mut live);
    for (at, op) in graph.nodes().filter(|(at, _)| live[at.index()]) {
        let operand = |at: Ref| format!("{}{}", if at.is_negative() { "-" } else { "" }, names[at.index()]);
        let line = match op {
            Op::Constant(place) => Err(constants.name(place)),
            Op::Input(input) => Err(input.name().to_string()),
            Op::Sine(angle) => Err(format!("s{}", group(graph, angle))),
            Op::Cosine(angle) => Err(format!("c{}", group(graph, angle))),
            Op::Sum(a, b) if b.is_negative() => Ok(format!("{} - {}", operand(a), operand(-b))),
            Op::Sum(a, b) => Ok(format!("{} + {}", operand(a), operand(b))),
            Op::Product(a, b) => Ok(format!("{} * {}", operand(a), operand(b))),
            Op::Quotient(a, b) => Ok(format!("{} / {}", operand(a), operand(b))),
            // nothing that is rewritten chooses
            Op::BySign(_) => Err(String::new()),
        };
        names[at.index()] = match line {
            Err(name) => name,
            Ok(line) => {
                terms += 1;
                let _ = writeln!(text, "t{terms} = {line}");
                format!("t{terms}")
            }
        };
    }
    for (index, at) in graph.outputs.iter().enumerate() {
        let sign = if at.is_negative() { "-" } else { "" };
        let _ = writeln!(text, "out{} = {sign}{}", index + 1, names[at.index()]);
    }
    constants.text + &text
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

/// Names of constants, and the lines that make those that are not given.
struct Constants<'a> {
    numbers: &'a Numbers,
    given: &'a [u32],
    names: HashMap<u32, String>,
    text: String,
}

impl Constants<'_> {
    fn define(&mut self, letter: char, place: u32, line: &str) -> String {
        let name = format!("{letter}{}", self.names.len() + 1);
        let _ = writeln!(self.text, "{name} = {line}");
        self.names.insert(place, name.clone());
        name
    }

    fn name(&mut self, place: u32) -> String {
        if let Some(name) = self.names.get(&place) {
            return name.clone();
        }
        let (number, source) = self.numbers.get(place);
        if self.given.contains(&place) {
            return self.define('k', place, &format!("{:?}", number.to_f64()));
        }
        let mut operand = |at: Ref| {
            let name = self.name(u32::try_from(at.index()).unwrap_or(u32::MAX));
            if at.is_negative() { format!("-{name}") } else { name }
        };
        let line = match source {
            // numbers that were not there at first have all been made
            Source::Given => String::from("1"),
            Source::Sum(a, b) => format!("{} + {}", operand(a), operand(b)),
            Source::Product(a, b) => format!("{} * {}", operand(a), operand(b)),
            Source::Inverse(of) => format!("1 / {}", operand(Ref::new(of as usize))),
        };
        self.define('d', place, &line)
    }
}

/// The graph of a text; `plain` is the one before it was rewritten.
///
/// # Errors
/// What is wrong in which line of the text, counted from 1.
pub(crate) fn read(text: &str, plain: &Graph, function: Function) -> Result<Traced, (usize, String)> {
    let builder = Builder::traced(Policy::Numbered, plain.embedding(), function);
    let given = plain.factors().into_iter().map(|place| plain.numbers.get(place).0).collect();
    let divisors =
        plain.nodes().filter_map(|(_, op)| if let Op::Quotient(_, b) = op { Some(plain.residue(b)) } else { None });
    let mut reader = Reader { given, divisors: divisors.collect(), builder: &builder, known: leaves(plain, &builder) };
    let mut outputs = vec![None; plain.outputs.len()];
    for (index, line) in text.lines().enumerate() {
        let at = index + 1;
        let line = line.trim();
        if line.is_empty() {
            continue;
        }
        let Some((name, value)) = line.split_once('=') else {
            return Err((at, format!("`{line}` is no line of a graph, such as `t1 = s2 * qd3`")));
        };
        let (name, value) = (name.trim(), value.trim());
        let term = if name.starts_with('k') { reader.given(value) } else { reader.operation(value) };
        let term = term.map_err(|message| (at, message))?;
        // a constant is kept without its sign
        let term = if name.starts_with('d') { builder.symbol(term.at.magnitude()) } else { term };
        if let Some(number) = name.strip_prefix("out").and_then(count) {
            let slot = number.checked_sub(1).and_then(|index| outputs.get_mut(index));
            let slot = slot.ok_or_else(|| (at, format!("`{name}`: {} numbers are returned", plain.outputs.len())))?;
            if slot.replace(term.at).is_some() {
                return Err((at, format!("`{name}` stands there twice")));
            }
        } else if !is_name(name) {
            return Err((
                at,
                format!("`{name}` is no name of a graph: `k1` and `d1` are constants, `t1` a term, `out1` a result"),
            ));
        } else if reader.known.insert(name.to_owned(), term).is_some() {
            return Err((at, format!("`{name}` stands there twice")));
        }
    }
    let end = text.lines().count();
    let outputs = outputs.into_iter().enumerate();
    let outputs: Result<Vec<Ref>, _> =
        outputs.map(|(index, at)| at.ok_or_else(|| (end, format!("`out{}` is missing", index + 1)))).collect();
    outputs.map(|outputs| builder.finish(outputs))
}

/// What a graph calls by name without having computed it: its arguments, and the sines and cosines of its angles.
fn leaves<'s>(graph: &Graph, builder: &'s Builder) -> HashMap<String, Symbol<'s>> {
    let mut leaves = HashMap::from([("1".to_owned(), builder.one())]);
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

/// An angle of one graph, written in another.
fn angle_of<'s>(graph: &Graph, at: Ref, builder: &'s Builder) -> Symbol<'s> {
    let angle = match graph.op(at) {
        Op::Input(input) => builder.argument(input.name()),
        Op::Sum(a, b) => angle_of(graph, a, builder) + angle_of(graph, b, builder),
        // angles are sums of positions and of constants, some of which are no numbers of the field
        Op::Constant(place) if graph.factors().contains(&place) => {
            builder.number(graph.number(at.magnitude()).unwrap_or_default())
        }
        _ => graph.turn(at.magnitude()).map_or_else(|| builder.zero(), |turn| builder.angle(turn)),
    };
    angle.signed(at.is_negative())
}

/// Whether a line may define this name.
fn is_name(name: &str) -> bool {
    ["k", "d", "t"].iter().any(|letter| name.strip_prefix(letter).and_then(count).is_some())
}

/// A graph that was read, with the numbers of its plan in their places and its own behind them.
pub(crate) fn on_numbers_of(read: &Graph, plan: &Graph) -> Graph {
    let mut graph = plan.clone();
    graph.clear_nodes();
    let mut map: Vec<Ref> = Vec::with_capacity(read.len());
    let mut places: HashMap<u32, Ref> = HashMap::new();
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

/// Makes a constant of another graph from what it was made of there.
fn constant_on(graph: &mut Graph, numbers: &Numbers, places: &mut HashMap<u32, Ref>, place: u32) -> Ref {
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
        Source::Inverse(of) => {
            let of = operand(graph, Ref::new(of as usize));
            graph.constant_inverse(of).unwrap_or_else(|| graph.zero())
        }
    };
    // a place holds the magnitude
    let at = at.magnitude();
    places.insert(place, at);
    at
}

struct Reader<'s> {
    given: Vec<Number>,
    /// What the graph before divides by. Nothing else may be divided by: it could be zero where that is not.
    divisors: Vec<Residue>,
    builder: &'s Builder,
    known: HashMap<String, Symbol<'s>>,
}

impl<'s> Reader<'s> {
    fn operation(&self, text: &str) -> Result<Symbol<'s>, String> {
        let parts: Vec<&str> = text.split_whitespace().collect();
        match parts[..] {
            [one] => self.operand(one),
            [a, sign, b] => {
                let (a, b) = (self.operand(a)?, self.operand(b)?);
                match sign {
                    "+" => Ok(a + b),
                    "-" => Ok(a - b),
                    "*" => Ok(a * b),
                    "/" if self.builder.graph.borrow().is_constant(b.at) => Ok(a * b.inverse()),
                    "/" if self.divides_by(b.at) => Ok(self.builder.quotient(a, b)),
                    "/" => Err(format!("`{text}` divides by what the plan does not divide by")),
                    _ => Err(format!("`{sign}` is no operation of a graph")),
                }
            }
            _ => Err(format!("`{text}` is no operation of a graph")),
        }
    }

    fn divides_by(&self, at: Ref) -> bool {
        let graph = self.builder.graph.borrow();
        [at, -at].into_iter().any(|at| self.divisors.contains(&graph.residue(at)))
    }

    fn operand(&self, text: &str) -> Result<Symbol<'s>, String> {
        let (name, negative) = text.strip_prefix('-').map_or((text, false), |name| (name, true));
        let term = self.known.get(name).ok_or_else(|| format!("there is no `{name}` before this line"))?;
        Ok(term.signed(negative))
    }

    /// The number of the graph before that rounds to this. A change of the formulas may move a number by a rounding.
    fn given(&self, text: &str) -> Result<Symbol<'s>, String> {
        const ROUNDING: f64 = 1e-13;
        let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
        let value = value.ok_or_else(|| format!("`{text}` is no number"))?;
        let distance = |number: &Number| (number.to_f64() - value).abs();
        let nearest = self.given.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let nearest = nearest.filter(|number| distance(number) <= ROUNDING * value.abs());
        nearest.map(|&number| self.builder.number(number)).ok_or_else(|| format!("the plan gives no number {text}"))
    }
}
