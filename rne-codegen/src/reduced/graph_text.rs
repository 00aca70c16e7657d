//! A rewritten graph as text: one operation per line, in order.
//!
//! ```text
//! d1 = k4 / k7          a constant made from others, without its sign; k7 is a number of the reduced form under its plan
//! t12 = t3 - t4         s2, c2 sine and cosine of joint 2, s2_4 of the summed angle of joints 2 to 4
//! t13 = d1 * qd3
//! tau2 = -t13
//! ```

use std::collections::HashMap;
use std::fmt::Write;

use super::evaluator::Frame;
use super::numbers::{Numbers, Source};
use super::plan::count;
use super::point::Point;
use super::sheet::{Dag, Identity, Leaf, Op, Ref, Sheet, mark_live};
use super::writer::Angle;
use crate::exact::Number;

/// A graph as text, when the first `given` of its numbers are those of its plan.
pub(crate) fn written(dag: &Dag, given: usize) -> String {
    let mut live = Vec::new();
    mark_live(&dag.sheet.nodes, &dag.outputs, &mut live);
    let mut text = String::new();
    let mut constants = Constants { numbers: &dag.sheet.numbers, given, names: HashMap::new(), text: String::new() };
    let mut names: Vec<String> = vec![String::new(); dag.sheet.nodes.len()];
    let mut terms = 0;
    for (index, node) in dag.sheet.nodes.iter().enumerate().filter(|(index, _)| live[*index]) {
        let operand = |at: Ref| format!("{}{}", if at.is_negative() { "-" } else { "" }, names[at.index()]);
        let line = match node.op {
            Op::Constant(place) => {
                names[index] = constants.name(place);
                continue;
            }
            Op::Leaf(leaf) => {
                names[index] = leaf_name(leaf);
                continue;
            }
            Op::Sum(a, b) if b.is_negative() => format!("{} - {}", operand(a), operand(-b)),
            Op::Sum(a, b) => format!("{} + {}", operand(a), operand(b)),
            Op::Product(a, b) => format!("{} * {}", operand(a), operand(b)),
            // torques divide by nothing
            Op::Inverse(a) => format!("1 / {}", operand(a)),
        };
        terms += 1;
        names[index] = format!("t{terms}");
        let _ = writeln!(text, "t{terms} = {line}");
    }
    for (joint, at) in dag.outputs.iter().enumerate() {
        let sign = if at.is_negative() { "-" } else { "" };
        let _ = writeln!(text, "tau{} = {sign}{}", joint + 1, names[at.index()]);
    }
    constants.text + &text
}

/// Names of constants, and the lines that make those that are not given.
struct Constants<'a> {
    numbers: &'a Numbers,
    given: usize,
    names: HashMap<u32, String>,
    text: String,
}

impl Constants<'_> {
    fn name(&mut self, place: u32) -> String {
        if (place as usize) < self.given {
            return format!("k{place}");
        }
        if let Some(name) = self.names.get(&place) {
            return name.clone();
        }
        let source = self.numbers.get(place).1;
        let mut operand = |at: Ref| {
            let name = self.name(u32::try_from(at.index()).unwrap_or(u32::MAX));
            if at.is_negative() { format!("-{name}") } else { name }
        };
        let line = match source {
            // numbers that were not there at first have all been made
            Source::Given => String::from("k0"),
            Source::Sum(a, b) => format!("{} + {}", operand(a), operand(b)),
            Source::Product(a, b) => format!("{} * {}", operand(a), operand(b)),
            Source::Inverse(of) => format!("1 / {}", operand(Ref::new(of as usize))),
        };
        let name = format!("d{}", self.names.len() + 1);
        let _ = writeln!(self.text, "{name} = {line}");
        self.names.insert(place, name.clone());
        name
    }
}

fn leaf_name(leaf: Leaf) -> String {
    let joint = |at: u8| usize::from(at) + 1;
    let turn = |letter: &str, first: u8, last: u8| {
        let group = if first == last { String::new() } else { format!("_{}", joint(last)) };
        format!("{letter}{}{group}", joint(first))
    };
    match leaf {
        Leaf::Position(at) => format!("q{}", joint(at)),
        Leaf::Rate(at) => format!("qd{}", joint(at)),
        Leaf::RateDot(at) => format!("qdd{}", joint(at)),
        Leaf::Torque(at) => format!("tau{}", joint(at)),
        Leaf::Force(axis) => format!("f{}", joint(axis)),
        Leaf::Moment(axis) => format!("n{}", joint(axis)),
        Leaf::GivenSine(at) => turn("s", at, at),
        Leaf::GivenCosine(at) => turn("c", at, at),
        Leaf::Sine(first, last) => turn("s", first, last),
        Leaf::Cosine(first, last) => turn("c", first, last),
    }
}

/// The graph of a text; `numbers` are those of the reduced form under the plan.
///
/// # Errors
/// What is wrong in which line of the text, counted from 1.
pub(crate) fn read(text: &str, frame: &Frame, numbers: &Numbers) -> Result<Dag, (usize, String)> {
    let given = (0..numbers.len()).filter_map(|place| u32::try_from(place).ok()).map(|place| numbers.get(place).0);
    let mut reader = Reader {
        frame,
        given: given.collect(),
        sheet: Sheet::new(Identity::Value),
        known: HashMap::new(),
        point: Point::new(frame.table.reading, 0),
    };
    let dof = frame.table.rows.len();
    let mut outputs = vec![None; dof];
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
        let term = reader.operation(value).map_err(|message| (at, message))?;
        // a constant is kept without its sign
        let term = if name.starts_with('d') { term.magnitude() } else { term };
        if let Some(joint) = name.strip_prefix("tau").and_then(count) {
            let slot = joint.checked_sub(1).and_then(|joint| outputs.get_mut(joint));
            let slot = slot.ok_or_else(|| (at, format!("there is no joint {joint}")))?;
            if slot.replace(term).is_some() {
                return Err((at, format!("`{name}` stands there twice")));
            }
        } else if !is_name(name) {
            return Err((
                at,
                format!("`{name}` is no name of a graph: `d1` is a constant, `t1` a term, `tau1` a torque"),
            ));
        } else if reader.known.insert(name.to_owned(), term).is_some() {
            return Err((at, format!("`{name}` stands there twice")));
        }
    }
    let outputs: Option<Vec<Ref>> = outputs.into_iter().collect();
    let end = text.lines().count();
    outputs.map(|outputs| Dag { sheet: reader.sheet, outputs }).ok_or_else(|| (end, "a torque is missing".to_owned()))
}

/// Whether a line may define this name.
fn is_name(name: &str) -> bool {
    ["d", "t"].iter().any(|letter| name.strip_prefix(letter).and_then(count).is_some())
}

/// A graph that was read, with the numbers of its plan in their places and its own behind them.
pub(crate) fn on_numbers_of(read: &Dag, plan: &Dag) -> Dag {
    let mut sheet = plan.sheet.clone();
    sheet.clear_nodes();
    let mut map: Vec<Ref> = Vec::with_capacity(read.sheet.nodes.len());
    let mut places: HashMap<u32, Ref> = HashMap::new();
    for node in &read.sheet.nodes {
        let mapped = |map: &[Ref], at: Ref| map[at.index()].signed(at.is_negative());
        let at = match node.op {
            Op::Constant(place) => constant_on(&mut sheet, &read.sheet.numbers, &mut places, place),
            Op::Leaf(leaf) => sheet.leaf(leaf, node.image),
            Op::Inverse(a) => {
                let a = mapped(&map, a);
                sheet.inverse(a)
            }
            Op::Sum(a, b) => {
                let (a, b) = (mapped(&map, a), mapped(&map, b));
                sheet.sum(a, b)
            }
            Op::Product(a, b) => {
                let (a, b) = (mapped(&map, a), mapped(&map, b));
                sheet.product(a, b)
            }
        };
        map.push(at);
    }
    let outputs = read.outputs.iter().map(|at| map[at.index()].signed(at.is_negative())).collect();
    Dag { sheet, outputs }
}

/// Makes a constant of another sheet from what it was made of there.
fn constant_on(sheet: &mut Sheet, numbers: &Numbers, places: &mut HashMap<u32, Ref>, place: u32) -> Ref {
    if let Some(&known) = places.get(&place) {
        return known;
    }
    let (number, source) = numbers.get(place);
    let mut operand = |sheet: &mut Sheet, at: Ref| {
        let place = u32::try_from(at.index()).unwrap_or(u32::MAX);
        constant_on(sheet, numbers, places, place).signed(at.is_negative())
    };
    let at = match source {
        Source::Given => sheet.constant(number),
        Source::Sum(a, b) => {
            let (a, b) = (operand(sheet, a), operand(sheet, b));
            sheet.sum(a, b)
        }
        Source::Product(a, b) => {
            let (a, b) = (operand(sheet, a), operand(sheet, b));
            sheet.product(a, b)
        }
        Source::Inverse(of) => {
            let of = operand(sheet, Ref::new(of as usize));
            sheet.constant_inverse(of).unwrap_or_else(Sheet::zero)
        }
    };
    // a place holds the magnitude
    let at = at.magnitude();
    places.insert(place, at);
    at
}

struct Reader<'a> {
    frame: &'a Frame,
    given: Vec<Number>,
    sheet: Sheet,
    known: HashMap<String, Ref>,
    point: Point,
}

impl Reader<'_> {
    fn operation(&mut self, text: &str) -> Result<Ref, String> {
        let parts: Vec<&str> = text.split_whitespace().collect();
        match parts[..] {
            [one] => self.operand(one),
            [a, sign, b] => {
                let (a, b) = (self.operand(a)?, self.operand(b)?);
                match sign {
                    "+" => Ok(self.sheet.sum(a, b)),
                    "-" => Ok(self.sheet.sum(a, -b)),
                    "*" => Ok(self.sheet.product(a, b)),
                    "/" => {
                        let inverse = self.sheet.constant_inverse(b);
                        let inverse = inverse.ok_or_else(|| format!("`{text}` divides by what is no constant"))?;
                        Ok(self.sheet.product(a, inverse))
                    }
                    _ => Err(format!("`{sign}` is no operation of a graph")),
                }
            }
            _ => Err(format!("`{text}` is no operation of a graph")),
        }
    }

    fn operand(&mut self, text: &str) -> Result<Ref, String> {
        let (name, negative) = text.strip_prefix('-').map_or((text, false), |name| (name, true));
        let term = match self.known.get(name) {
            Some(&known) => known,
            None => self.leaf(name).ok_or_else(|| format!("there is no `{name}` before this line"))?,
        };
        Ok(term.signed(negative))
    }

    fn leaf(&mut self, name: &str) -> Option<Ref> {
        if name == "1" {
            return Some(self.sheet.constant(Number::ONE));
        }
        let digits = name.find(|c: char| c.is_ascii_digit())?;
        let (letters, digits) = name.split_at(digits);
        let rows = &self.frame.table.rows;
        let joint = |text: &str| {
            let at = count(text)?.checked_sub(1).filter(|&at| at < rows.len())?;
            Some((at, u8::try_from(at).ok()?))
        };
        let (leaf, image) = match letters {
            "k" => return Some(self.sheet.constant(*self.given.get(count(digits)?)?)),
            "q" => joint(digits).map(|(at, byte)| (Leaf::Position(byte), self.point.position(at)))?,
            "qd" => joint(digits).map(|(at, byte)| (Leaf::Rate(byte), self.point.rate(at)))?,
            "qdd" => joint(digits).map(|(at, byte)| (Leaf::RateDot(byte), self.point.rate_dot(at)))?,
            "s" | "c" => {
                let (first, last) = digits.split_once('_').unwrap_or((digits, digits));
                let ((first, from), (last, to)) = (joint(first)?, joint(last)?);
                if first > last {
                    return None;
                }
                let (sine, cosine) = Angle::of(rows, first, last).image(rows, &self.point);
                if letters == "s" { (Leaf::Sine(from, to), sine) } else { (Leaf::Cosine(from, to), cosine) }
            }
            _ => return None,
        };
        Some(self.sheet.leaf(leaf, image))
    }
}
