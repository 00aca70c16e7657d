//! Finds the bodies of a URDF, an MJCF file or a robot file, with the places of their numbers in the text.
//!
//! Other readers refuse a body that cannot exist; this one does not, because it is for such bodies.

use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;

use rne_model::document::{self, Content, Entry, Node};
use rne_model::{Reader, Report, Severity};

use super::{Body, Numbers, Order, line_and_column};
use crate::mjcf::element::{Element, read as read_mjcf};
use crate::source::{Source, quoted};
use crate::urdf::xml::{MAX_BYTES, Seen, root_name, scan};

/// Returns the bodies of a description that have a mass or an inertia. `file` is its name in messages; from the folder
/// of an MJCF file, the files that it includes are read, but their bodies are left out.
///
/// # Errors
/// When the text is not a URDF, an MJCF file or YAML.
pub fn bodies_of(file: &str, text: &str) -> Result<Vec<Body>, Report> {
    match root_name(text) {
        Some(name) if name == "mujoco" => of_mjcf(Source::new(file, text)),
        Some(_) => of_urdf(&Source::new(file, text)),
        None => of_robot_file(file, text),
    }
}

/// Returns the place of the value of an attribute in a tag. Values before it may have any text, also that of an
/// attribute.
fn value(tag: &str, attribute: &str) -> Option<Range<usize>> {
    let mut rest = tag;
    loop {
        let (before, after) = rest.split_once('=')?;
        let name = before.trim_end().rsplit(char::is_whitespace).next()?;
        let quoted = after.trim_start();
        let quote = quoted.chars().next().filter(|quote| matches!(quote, '"' | '\''))?;
        let start = tag.len() - quoted.len() + 1;
        let end = start + quoted[1..].find(quote)?;
        if name == attribute {
            return Some(start..end);
        }
        rest = &tag[end + 1..];
    }
}

/// Returns the places of the words in the value of an attribute.
fn words(text: &str, tag: &Range<usize>, attribute: &str) -> Vec<Range<usize>> {
    let inside = text.get(tag.clone()).unwrap_or_default();
    let Some(value) = value(inside, attribute) else { return Vec::new() };
    let (mut words, mut at) = (Vec::new(), tag.start + value.start);
    for piece in inside[value].split_inclusive(char::is_whitespace) {
        let word = piece.trim_end();
        if !word.is_empty() {
            words.push(at..at + word.len());
        }
        at += piece.len();
    }
    words
}

/// Returns the number at a place of the text.
fn number(text: &str, span: &Range<usize>) -> Option<f64> {
    text.get(span.clone())?.parse().ok().filter(|number: &f64| number.is_finite())
}

/// Makes a body of the places of its mass and its tensor; `None` if all numbers are zero.
///
/// # Errors
/// When a place has no number.
fn body(
    source: &Source,
    name: &str,
    spans: [Option<Range<usize>>; 7],
    elements: Vec<Range<usize>>,
) -> Result<Option<Body>, Report> {
    let mut all = [0.0; 7];
    for (number_at, span) in all.iter_mut().zip(&spans) {
        let Some(span) = span else { continue };
        *number_at = number(&source.text, span).ok_or_else(|| unread(source, name, span))?;
    }
    let [mass, inertia @ ..] = all;
    let numbers = Numbers { mass, inertia };
    Ok((all != [0.0; 7]).then(|| Body { name: name.to_owned(), numbers, spans, elements, ..Body::default() }))
}

/// Returns the error of a body whose mass or tensor is not made of plain numbers.
fn unread(source: &Source, name: &str, span: &Range<usize>) -> Report {
    let message = format!("the mass or the inertia of {} is not made of plain numbers", quoted(name));
    source.error(span, message, "write each number with digits, such as 0.012 or 1.2e-2")
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

/// Makes each body as long as the distances of the joints that it carries, and names its neighbours. `links` has the
/// index of the body of each link, and `joints` the parent, the child and the length of each joint.
fn connect(bodies: &mut [Body], links: &HashMap<String, usize>, joints: &[(String, String, f64)]) {
    for (parent, child, length) in joints {
        let [parent, child] = [parent, child].map(|link| links.get(link).copied());
        if let Some(parent) = parent {
            bodies[parent].size = bodies[parent].size.max(*length);
            bodies[parent].neighbours.extend(child);
        }
        if let Some(child) = child {
            bodies[child].neighbours.extend(parent);
        }
    }
}

fn of_urdf(source: &Source) -> Result<Vec<Body>, Report> {
    const ATTRIBUTES: [&str; 6] = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];
    let scanned = scan(source)?;
    let (mut bodies, mut links) = (Vec::new(), HashMap::new());
    for seen in &scanned.links {
        let name = seen.text("link", "name").unwrap_or_default();
        let place = |element: &str| seen.elements.get(element).cloned();
        let (Some(mass), Some(inertia)) = (place("mass"), place("inertia")) else { continue };
        let first = |tag: &Range<usize>, attribute: &str| words(&source.text, tag, attribute).into_iter().next();
        let tensor = ATTRIBUTES.map(|attribute| first(&inertia, attribute));
        let [xx, yy, zz, xy, xz, yz] = tensor;
        let spans = [first(&mass, "value"), xx, yy, zz, xy, xz, yz];
        let Some(body) = body(source, name, spans, vec![mass, inertia])? else { continue };
        let com = seen.vector("origin", "xyz").unwrap_or_default();
        let turned = seen.vector("origin", "rpy").is_some_and(|rpy| rpy != [0.0; 3]);
        links.insert(name.to_owned(), bodies.len());
        bodies.push(Body { com: (!turned).then_some(com), size: 2.0 * length(com), ..body });
    }
    let joint = |seen: &Seen| {
        let link = |end| seen.text(end, "link").unwrap_or_default().to_owned();
        (link("parent"), link("child"), length(seen.vector("origin", "xyz").unwrap_or_default()))
    };
    connect(&mut bodies, &links, &scanned.joints.iter().map(joint).collect::<Vec<_>>());
    Ok(bodies)
}

fn of_mjcf(mut source: Source) -> Result<Vec<Body>, Report> {
    let own = source.text.len();
    if own > MAX_BYTES {
        return Err(source.error(&(0..0), format!("the file has more than {MAX_BYTES} bytes"), None));
    }
    let root = read_mjcf(&mut source)?;
    let is_set = |name: &str| root.children("compiler").any(|compiler| compiler.text(name) == Some("true"));
    // MuJoCo replaces the numbers of these files
    if is_set("inertiafromgeom") || is_set("balanceinertia") {
        return Ok(Vec::new());
    }
    let (mut bodies, mut links, mut joints) = (Vec::new(), HashMap::new(), Vec::new());
    let mut open: Vec<(&Element, String)> = root.children("worldbody").map(|world| (world, String::new())).collect();
    while let Some((element, parent)) = open.pop() {
        let name = if element.name == "body" {
            let unnamed = || format!("body in line {}", line_and_column(&source.text, element.span.start)[0]);
            let name = element.text("name").map_or_else(unnamed, str::to_owned);
            joints.push((parent, name.clone(), vector(element).map_or(0.0, length)));
            name
        } else {
            parent
        };
        for inertial in element.children("inertial").filter(|inertial| inertial.span.end <= own) {
            if let Some(body) = of_inertial(&source, &name, inertial)? {
                links.insert(name.clone(), bodies.len());
                bodies.push(body);
            }
        }
        open.extend(element.children.iter().rev().map(|child| (child, name.clone())));
    }
    connect(&mut bodies, &links, &joints);
    Ok(bodies)
}

/// Returns the three numbers of `pos`.
fn vector(element: &Element) -> Option<[f64; 3]> {
    let mut numbers = element.text("pos")?.split_whitespace().map(|word| word.parse().ok());
    Some([numbers.next()??, numbers.next()??, numbers.next()??])
}

fn of_inertial(source: &Source, name: &str, inertial: &Element) -> Result<Option<Body>, Report> {
    let words = |attribute| words(&source.text, &inertial.span, attribute).into_iter().map(Some);
    let tensor: Vec<_> = words("fullinertia").chain(words("diaginertia")).collect();
    match tensor.len() {
        0 => return Ok(None),
        3 | 6 => {}
        _ => return Err(unread(source, name, &inertial.span)),
    }
    let mut spans: [Option<Range<usize>>; 7] = Default::default();
    for (to, from) in spans.iter_mut().zip(words("mass").take(1).chain(tensor)) {
        *to = from;
    }
    let Some(body) = body(source, name, spans, vec![inertial.span.clone()])? else { return Ok(None) };
    let com = vector(inertial).unwrap_or_default();
    let turned = ["quat", "euler", "axisangle", "xyaxes", "zaxis"].iter().any(|turn| inertial.text(turn).is_some());
    let size = 2.0 * length(com);
    Ok(Some(Body { com: (!turned).then_some(com), size, order: Order::MomentsFirst, ..body }))
}

fn of_robot_file(file: &str, text: &str) -> Result<Vec<Body>, Report> {
    let root = document::read(file, text, document::Kind { name: "a robot file", format: 1 })?;
    let table = Table { text, parameters: parameters(&root) };
    let joints = root.list("joints");
    let name = |item: &Node| item.get("name").and_then(scalar).map(str::to_owned);
    let (mut bodies, mut links) = (Vec::new(), HashMap::new());
    let mut lengths = Vec::new();
    let is_modified = root.get("convention").and_then(scalar) == Some("modified");
    let mut before = String::new();
    for (index, item) in joints.iter().enumerate() {
        let name = name(item).unwrap_or_else(|| format!("link {}", index + 1));
        let length = |key: &str| item.get("dh").and_then(|dh| table.number(dh.get(key)?)).unwrap_or(0.0);
        let length = length("a").hypot(length("d"));
        let above = std::mem::replace(&mut before, name.clone());
        let parent = item.get("parent").and_then(scalar).map_or(above, str::to_owned);
        let body = child(item, "link").and_then(|link| table.body(name.clone(), &[item, link]));
        // a standard row is the length of its own link, a modified row that of the link before
        let own = if is_modified { 0.0 } else { length };
        lengths.push((parent, name.clone(), if is_modified { length } else { 0.0 }));
        if let Some(body) = body {
            links.insert(name, bodies.len());
            bodies.push(Body { size: own.max(body.size), ..body });
        }
    }
    connect(&mut bodies, &links, &lengths);
    let base = root.get("floating_base").and_then(|base| child(base, "link"));
    bodies.extend(base.and_then(|link| table.body("floating base".to_owned(), &[link])));
    let further = root.list("bodies").iter();
    bodies.extend(further.filter_map(|item| table.body(name(item)?, &[item])));
    others_refused(file, text, &bodies)?;
    Ok(bodies)
}

/// Refuses a robot file with an error that is not in the mass or the inertia of a body: its numbers may mean something
/// else than they seem to.
fn others_refused(file: &str, text: &str, bodies: &[Body]) -> Result<(), Report> {
    let Err(mut report) = Reader::new(file).trees().couplings().loops().read(text) else { return Ok(()) };
    let elements: Vec<&Range<usize>> = bodies.iter().flat_map(|body| &body.elements).collect();
    let is_of_body = |span: &Range<usize>| elements.iter().any(|all| all.start <= span.start && span.end <= all.end);
    report.diagnostics.retain(|found| found.severity == Severity::Error && !is_of_body(&found.span));
    if report.is_empty() { Ok(()) } else { Err(report) }
}

/// Returns the values of the parameters. Several passes find those that depend on others.
fn parameters(root: &Node) -> HashMap<&str, f64> {
    let mut known = HashMap::new();
    for _ in 0..4 {
        for Entry { key, value, .. } in root.get("parameters").map_or(&[][..], entries) {
            if let Some(value) = scalar(value).and_then(|text| evaluated(text, &known)) {
                known.insert(key.as_str(), value);
            }
        }
    }
    known
}

/// Returns the value of an expression with parameters.
fn evaluated(text: &str, parameters: &HashMap<&str, f64>) -> Option<f64> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.');
    let mut replaced = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let end = if is_word(first) { rest.find(|c| !is_word(c)).unwrap_or(rest.len()) } else { first.len_utf8() };
        let (word, after) = rest.split_at(end);
        let value = parameters.get(word).map(|value| format!("({value:?})"));
        replaced.push_str(value.as_deref().unwrap_or(word));
        rest = after;
    }
    rne_model::number(&replaced).ok().filter(|value| value.is_finite())
}

/// The text of a robot file, and its parameters.
struct Table<'a> {
    text: &'a str,
    parameters: HashMap<&'a str, f64>,
}

impl Table<'_> {
    fn number(&self, node: &Node) -> Option<f64> {
        evaluated(scalar(node)?, &self.parameters)
    }

    /// Reads a mapping with the mass and the tensor of a body; `path` leads to it and ends with it. Only plain numbers
    /// have a place, because a formula cannot be changed, and only those that no alias uses elsewhere.
    fn body(&self, name: String, path: &[&Rc<Node>]) -> Option<Body> {
        let link = path.last()?;
        let tensor = child(link, "inertia");
        let of_tensor = |key| tensor.and_then(|tensor| child(tensor, key));
        let [xx, yy, zz, xy, xz, yz] = ["xx", "yy", "zz", "xy", "xz", "yz"].map(of_tensor);
        let nodes = [child(link, "mass"), xx, yy, zz, xy, xz, yz];
        let mut all = [0.0; 7];
        for (number, node) in all.iter_mut().zip(nodes) {
            *number = node.map_or(Some(0.0), |node| self.number(node))?;
        }
        let is_shared = |node: &&Rc<Node>| Rc::strong_count(node) > 1;
        let all_shared = path.iter().any(is_shared);
        let place = |node: &Rc<Node>| {
            let is_own = !all_shared && !is_shared(&node);
            Some(node.span.clone()).filter(|span| is_own && number(self.text, span).is_some())
        };
        let mut spans = nodes.map(|node| node.and_then(place));
        if tensor.as_ref().is_some_and(is_shared) {
            spans[1..].fill(None);
        }
        let elements = entries(link).iter().filter(|entry| matches!(entry.key.as_str(), "mass" | "inertia"));
        let com = link.get("com").map(|_| {
            let mut numbers = link.list("com").iter().map(|node| self.number(node));
            Some([numbers.next()??, numbers.next()??, numbers.next()??])
        });
        let com = com.unwrap_or(Some([0.0; 3]));
        let [mass, inertia @ ..] = all;
        Some(Body {
            name,
            numbers: Numbers { mass, inertia },
            com,
            is_about_origin: link.get("inertia_about").and_then(scalar) == Some("origin"),
            order: Order::MomentsFirst,
            size: 2.0 * length(com.unwrap_or_default()),
            neighbours: Vec::new(),
            spans,
            elements: elements.map(|entry| entry.key_span.start..entry.value.span.end).collect(),
            is_exempt: link.get("physical").and_then(scalar) == Some("false") || link.get("first_moment").is_some(),
        })
    }
}

/// Returns the value of a key, as it is shared by aliases.
fn child<'a>(node: &'a Node, key: &str) -> Option<&'a Rc<Node>> {
    entries(node).iter().find(|entry| entry.key == key).map(|entry| &entry.value)
}

fn entries(node: &Node) -> &[Entry] {
    if let Content::Mapping(entries) = &node.content { entries } else { &[] }
}

fn scalar(node: &Node) -> Option<&str> {
    if let Content::Scalar(scalar) = &node.content { Some(scalar.text.as_str()) } else { None }
}
