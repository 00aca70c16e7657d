//! Reads the values of a URDF that dynamics needs, with their places, and refuses text that no reader should accept.
//!
//! Links, inertias and joints are read; everything else, such as meshes, is skipped. Every value has been checked: a
//! number is a number, and required values are there.

mod elements;

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use rne_model::{Report, did_you_mean};

use self::elements::{ELEMENTS, Element, PASSED_OVER, PASSED_OVER_ATTRIBUTES, fault, passed_over};
use crate::source::{Source, quoted};

/// Largest size of a text, far more than the description of any arm needs.
pub(crate) const MAX_BYTES: usize = 16 << 20;
/// Largest depth of elements; those that dynamics needs are nested four deep.
const MAX_DEPTH: usize = 64;
/// Largest number of links or joints, more than any robot has.
const MAX_ELEMENTS: usize = 20_000;
/// Largest number that is accepted; no number of an arm in SI units is larger.
pub(crate) const LARGEST: f64 = 1e9;

/// Returns the limit of a joint; infinity for very large numbers such as 1.8e308, which programs write for a joint
/// without limit.
pub(crate) fn end_of_range(value: f64) -> f64 {
    if value.abs() < LARGEST { value } else { f64::INFINITY.copysign(value) }
}

/// Largest number of kinds of unknown elements and attributes, more than any description has.
const MAX_UNKNOWN: usize = 1000;

/// The values of a text that dynamics needs; links and joints are in the order of the text.
#[derive(Default)]
pub(crate) struct Scanned {
    /// The values outside of links and joints, with the name of the robot.
    pub(crate) robot: Seen,
    pub(crate) links: Vec<Seen>,
    pub(crate) joints: Vec<Seen>,
    /// Gears between links; only URDF+ has them.
    pub(crate) couplings: Vec<Seen>,
    /// Closed loops; only URDF+ has them.
    pub(crate) loops: Vec<Seen>,
    /// Kinds of unknown elements and attributes, in words.
    pub(crate) unknown: Vec<String>,
}

/// The values of one link, joint, coupling or loop.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seen {
    /// The place of the tag in the text.
    pub(crate) span: Range<usize>,
    /// The relevant elements inside it, at any depth, with the places of their tags.
    pub(crate) elements: BTreeMap<&'static str, Range<usize>>,
    /// The values of attributes, by the names of the element and the attribute.
    values: HashMap<(&'static str, &'static str), String>,
    /// Unknown names inside it, as indices into [`Scanned::unknown`].
    pub(crate) unknown: BTreeSet<usize>,
}

impl Seen {
    /// Returns the text of an attribute.
    pub(crate) fn text(&self, element: &'static str, attribute: &'static str) -> Option<&str> {
        self.values.get(&(element, attribute)).map(String::as_str)
    }

    /// Returns the number of an attribute.
    pub(crate) fn number(&self, element: &'static str, attribute: &'static str) -> Option<f64> {
        self.text(element, attribute)?.trim().parse().ok()
    }

    /// Returns the three numbers of an attribute.
    pub(crate) fn vector(&self, element: &'static str, attribute: &'static str) -> Option<[f64; 3]> {
        let mut numbers = self.text(element, attribute)?.split_whitespace().map(|word| word.parse().ok());
        Some([numbers.next()??, numbers.next()??, numbers.next()??])
    }
}

/// Returns the name of the root element of a text, if its beginning is XML.
pub(crate) fn root_name(text: &str) -> Option<String> {
    let mut reader = Reader::from_str(text);
    loop {
        match reader.read_event() {
            Ok(Event::Start(tag) | Event::Empty(tag)) => {
                return Some(String::from_utf8_lossy(tag.name().as_ref()).into_owned());
            }
            Ok(Event::Eof) | Err(_) => return None,
            Ok(_) => {}
        }
    }
}

/// Reads the whole text in one pass.
pub(crate) fn scan(source: &Source) -> Result<Scanned, Report> {
    let bytes = source.text.len();
    if bytes > MAX_BYTES {
        let message = format!("the URDF has {bytes} bytes; rne reads at most {MAX_BYTES}");
        return Err(Source::new(&source.file, "").error(&(0..0), message, None));
    }
    let mut scanner =
        Scanner { source, scanned: Scanned::default(), kinds: HashMap::new(), open: Vec::new(), has_robot: false };
    let mut reader = Reader::from_str(&source.text);
    loop {
        let start = usize::try_from(reader.buffer_position()).unwrap_or(0);
        let event = reader.read_event();
        let end = usize::try_from(reader.buffer_position()).unwrap_or(0);
        // The span without the byte order mark and blanks before the tag.
        let start = start + source.text.get(start..end).and_then(|text| text.find('<')).unwrap_or(0);
        let place = start..end.max(start);
        match event {
            Ok(Event::Start(tag)) => scanner.open(&tag, place, false)?,
            Ok(Event::Empty(tag)) => scanner.open(&tag, place, true)?,
            Ok(Event::End(_)) => {
                scanner.open.pop();
            }
            Ok(Event::DocType(_)) => {
                let message = "the file has a document type; rne does not read its entities";
                let help = "delete the line: a URDF needs no document type";
                return Err(source.error(&place, message, help));
            }
            Ok(Event::Text(words))
                if scanner.has_robot && scanner.open.is_empty() && !words.trim_ascii().is_empty() =>
            {
                let message = "there is text after the element `robot`; a URDF ends with </robot>";
                return Err(source.error(&place, message, None));
            }
            Ok(Event::Eof) => break,
            Ok(_) => {}
            Err(error) => {
                let at = usize::try_from(reader.error_position()).unwrap_or(0).min(bytes);
                return Err(source.error(&(at..at), format!("this is not XML: {error}"), None));
            }
        }
    }
    if !scanner.open.is_empty() {
        return Err(source.error(&(bytes..bytes), "this is not XML: the text ends within an element", None));
    }
    if !scanner.has_robot {
        let message = "there is no element `robot`; a URDF is XML that begins with <robot name=\"…\">";
        let is_robot_file = source.text.contains("convention:");
        let help = is_robot_file.then(|| "this is a robot file, which needs no import".to_owned());
        return Err(source.error(&(0..0), message, help));
    }
    Ok(scanner.scanned)
}

struct Scanner<'a> {
    source: &'a Source,
    scanned: Scanned,
    /// The unknown names found so far: whether it is an attribute, the element that has it, and its name; with its
    /// index.
    kinds: HashMap<(bool, &'static str, String), usize>,
    open: Vec<Open>,
    has_robot: bool,
}

/// An element that is not closed yet.
struct Open {
    /// The element, or `None` if neither it nor anything inside it is relevant.
    element: Option<&'static Element>,
    /// The relevant elements inside it.
    children: Vec<&'static str>,
}

impl Scanner<'_> {
    fn open(&mut self, tag: &BytesStart, place: Range<usize>, is_empty: bool) -> Result<(), Report> {
        let name = tag.name();
        let name = String::from_utf8_lossy(name.as_ref()).into_owned();
        if self.open.len() >= MAX_DEPTH {
            let message = format!("the elements are nested more than {MAX_DEPTH} levels deep; a URDF needs six levels");
            return Err(self.source.error(&place, message, None));
        }
        let element = self.element(&name, &place)?;
        if let Some(element) = element {
            if let Some(parent) = self.open.last_mut() {
                let several = matches!(element.name, "link" | "joint" | "coupling" | "loop");
                if !several && parent.children.contains(&element.name) {
                    let message = format!("a second `{}` in one `{}`", element.name, element.parent);
                    return Err(self.source.error(&place, message, None));
                }
                if !several {
                    parent.children.push(element.name);
                }
            }
            self.owner(element).elements.insert(element.name, place.clone());
            self.take(element, tag, &place)?;
        }
        if !is_empty {
            self.open.push(Open { element, children: Vec::new() });
        }
        Ok(())
    }

    /// Returns the relevant element of this name, if it is one.
    fn element(&mut self, name: &str, place: &Range<usize>) -> Result<Option<&'static Element>, Report> {
        let parent = match self.open.last() {
            None => None,
            Some(Open { element: Some(parent), .. }) => Some(*parent),
            Some(_) => return Ok(None),
        };
        let name_of_parent = parent.map_or("", |parent| parent.name);
        let element = ELEMENTS.iter().find(|element| element.name == name && element.parent == name_of_parent);
        if parent.is_none() {
            if element.is_none() || self.has_robot {
                let message = if self.has_robot {
                    "there is a second element after `robot`, but a URDF has only one robot".to_owned()
                } else {
                    format!("found the element {} where `robot` is needed: this is not a URDF", quoted(name))
                };
                let help = name.contains("sdf").then(|| "SDF is another format; convert it to URDF first".to_owned());
                return Err(self.source.error(place, message, help));
            }
            self.has_robot = true;
        }
        if name.starts_with("xacro:") {
            let message = format!("the file has the macro {}, which is not expanded yet", quoted(name));
            let help = "expand the file first: `xacro FILE.xacro > FILE.urdf`";
            return Err(self.source.error(place, message, help));
        }
        if let (None, Some(parent)) = (element, parent) {
            let matter = ELEMENTS.iter().filter(|element| element.parent == parent.name).map(|element| element.name);
            let others = passed_over(PASSED_OVER, parent.name);
            self.unknown(parent, ("element", "in"), name, (&matter.collect::<Vec<_>>(), others), place)?;
        }
        let seen = match name {
            "link" => &mut self.scanned.links,
            "joint" => &mut self.scanned.joints,
            "coupling" => &mut self.scanned.couplings,
            "loop" => &mut self.scanned.loops,
            _ => return Ok(element),
        };
        if element.is_some() {
            if seen.len() >= MAX_ELEMENTS {
                let message = format!("more than {MAX_ELEMENTS} elements `{name}`");
                return Err(self.source.error(place, message, None));
            }
            seen.push(Seen { span: place.clone(), ..Seen::default() });
        }
        Ok(element)
    }

    /// Returns the record to which an element belongs: that of its link, its joint, its loop, its coupling, or the
    /// robot.
    fn owner(&mut self, element: &Element) -> &mut Seen {
        let Scanned { robot, links, joints, couplings, loops, .. } = &mut self.scanned;
        let is_in_loop = self.open.iter().filter_map(|open| open.element).any(|open| open.name == "loop");
        let owner = match (element.name, element.parent) {
            ("link", _) | (_, "link" | "inertial") => links.last_mut(),
            ("joint", _) | (_, "joint") => joints.last_mut(),
            ("loop", _) => loops.last_mut(),
            (_, "loop" | "predecessor" | "successor") if is_in_loop => loops.last_mut(),
            ("coupling", _) | (_, "coupling" | "predecessor" | "successor") => couplings.last_mut(),
            _ => None,
        };
        owner.unwrap_or(robot)
    }

    /// Refuses an unknown name that is probably a misspelling of a relevant one, and records any other. `what` is
    /// `element` or `attribute`, `between` is the word between the name and the element that has it.
    fn unknown(
        &mut self,
        of: &'static Element,
        (what, between): (&'static str, &str),
        name: &str,
        (matter, others): (&[&'static str], &[&'static str]),
        place: &Range<usize>,
    ) -> Result<(), Report> {
        if others.contains(&name) {
            return Ok(());
        }
        let key = (what == "attribute", of.name, name.to_owned());
        if let Some(&kind) = self.kinds.get(&key) {
            self.owner(of).unknown.insert(kind);
            return Ok(());
        }
        let meant = did_you_mean(name, matter.iter().chain(others).copied());
        if let Some(meant) = meant.filter(|meant| matter.contains(meant)) {
            let message = format!("there is no {what} {} {between} `{}`", quoted(name), of.name);
            let help = format!("did you mean `{meant}`? Correct the name, or delete the element or attribute");
            return Err(self.source.error(place, message, help));
        }
        let kind = self.scanned.unknown.len();
        if kind >= MAX_UNKNOWN {
            let message =
                format!("the file has more than {MAX_UNKNOWN} names of elements and attributes that no URDF has");
            return Err(self.source.error(place, message, None));
        }
        self.scanned.unknown.push(format!("{what} {} {between} `{}`", quoted(name), of.name));
        self.kinds.insert(key, kind);
        self.owner(of).unknown.insert(kind);
        Ok(())
    }

    /// Stores the relevant attributes of a tag.
    fn take(&mut self, element: &'static Element, tag: &BytesStart, place: &Range<usize>) -> Result<(), Report> {
        let mut values: Vec<Option<String>> = element.attributes.iter().map(|_| None).collect();
        // checking thousands of attributes for repetition takes long, so only the few relevant ones are checked below
        for attribute in tag.attributes().with_checks(false) {
            let attribute =
                attribute.map_err(|error| self.source.error(place, format!("this is not XML: {error}"), None))?;
            let key = String::from_utf8_lossy(attribute.key.as_ref()).into_owned();
            if key == "quat_xyzw" {
                let help = "write the rotation as rpy, in the axes of the parent";
                return Err(self.source.error(place, "rne does not read a rotation as `quat_xyzw`", help));
            }
            let Some(index) = element.attributes.iter().position(|known| known.name == key) else {
                if !key.starts_with("xmlns:") {
                    let matter: Vec<&str> = element.attributes.iter().map(|known| known.name).collect();
                    let others = passed_over(PASSED_OVER_ATTRIBUTES, element.name);
                    let place = self.within(place, &key);
                    self.unknown(element, ("attribute", "of"), &key, (&matter, others), &place)?;
                }
                continue;
            };
            let raw = String::from_utf8_lossy(&attribute.value).into_owned();
            // XML reads every tab or line break in an attribute as a space
            let value = quick_xml::escape::unescape(&raw.replace(['\t', '\n', '\r'], " "))
                .map_err(|error| self.source.error(place, format!("`{key}` cannot be read: {error}"), None))?
                .into_owned();
            if ["${", "$("].iter().any(|mark| value.contains(mark)) {
                let message =
                    format!("{} of `{}` is {}, an expression of xacro", quoted(&key), element.name, quoted(&value));
                let help = "expand the file first: `xacro FILE.xacro > FILE.urdf`";
                return Err(self.source.error(&self.within(place, &raw), message, help));
            }
            if let Some(fault) = fault(element.attributes[index].kind, &value) {
                let message = format!("{} of `{}` is {}; {fault}", quoted(&key), element.name, quoted(&value));
                return Err(self.source.error(&self.within(place, &raw), message, None));
            }
            if values[index].replace(value).is_some() {
                let message = format!("this is not XML: the attribute `{key}` occurs twice");
                return Err(self.source.error(place, message, None));
            }
        }
        // in a loop, `origin` is inside `predecessor` or `successor`, which tells the two apart
        let of = if matches!(element.parent, "predecessor" | "successor") { element.parent } else { element.name };
        for (attribute, value) in element.attributes.iter().zip(values) {
            if let Some(value) = value {
                self.owner(element).values.insert((of, attribute.name), value);
            } else if attribute.required {
                let message = format!("`{}` lacks the attribute `{}`", element.name, attribute.name);
                return Err(self.source.error(place, message, None));
            }
        }
        Ok(())
    }

    /// Returns the place of a part of a tag in the text.
    fn within(&self, tag: &Range<usize>, part: &str) -> Range<usize> {
        let found = self.source.text.get(tag.clone()).and_then(|tag| tag.find(part));
        found.map_or(tag.clone(), |at| tag.start + at..tag.start + at + part.len())
    }
}
