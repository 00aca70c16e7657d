//! Reads the elements of an MJCF file, and puts those of included files in their places.

use std::collections::BTreeSet;
use std::io::Read as _;
use std::ops::Range;
use std::path::Path;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use rne_model::{Report, open_file};

use crate::source::{Source, quoted};
use crate::urdf::xml::MAX_BYTES;

/// Largest depth of elements. Bodies are nested as deep as joints follow each other, and a robot file has at most 64
/// joints.
const MAX_DEPTH: usize = 256;
/// Largest number of elements, more than any robot has.
const MAX_ELEMENTS: usize = 200_000;

/// An element of the file.
#[derive(Debug, Default)]
pub(crate) struct Element {
    pub(crate) name: String,
    /// The place of the element's tag in the text.
    pub(crate) span: Range<usize>,
    /// The names and the values of the attributes.
    pub(crate) attributes: Vec<(String, String)>,
    pub(crate) children: Vec<Element>,
}

impl Element {
    /// Returns the value of an attribute that the element itself has.
    pub(crate) fn text(&self, attribute: &str) -> Option<&str> {
        self.attributes.iter().find(|(name, _)| name == attribute).map(|(_, value)| value.as_str())
    }

    /// Returns the children with a name.
    pub(crate) fn children(&self, name: &str) -> impl Iterator<Item = &Self> {
        self.children.iter().filter(move |child| child.name == name)
    }

    /// Returns the elements inside all sections of a name; the file may have several such sections.
    pub(crate) fn below(&self, section: &str) -> impl Iterator<Item = &Self> {
        self.children(section).flat_map(|section| &section.children)
    }
}

/// Returns the place of a part of a tag in the text.
pub(crate) fn within(source: &Source, tag: &Range<usize>, part: &str) -> Range<usize> {
    let found = source.text.get(tag.clone()).filter(|_| !part.is_empty()).and_then(|tag| tag.find(part));
    found.map_or(tag.clone(), |at| tag.start + at..tag.start + at + part.len())
}

/// Reads the root element of the text. Elements of included files are put in their places, and the texts of these files
/// are appended to that of the source.
pub(crate) fn read(source: &mut Source) -> Result<Element, Report> {
    let mut number = 0;
    let mut root = parse(source, 0, &mut number)?;
    let mut opened = BTreeSet::new();
    include(source, &mut root, &mut opened, (&mut number, 0))?;
    Ok(root)
}

/// Replaces each element `include` by the elements of the included file.
fn include(
    source: &mut Source,
    element: &mut Element,
    opened: &mut BTreeSet<String>,
    (number, depth): (&mut usize, usize),
) -> Result<(), Report> {
    let mut index = 0;
    while index < element.children.len() {
        let child = &mut element.children[index];
        if child.name != "include" {
            include(source, child, opened, (number, depth + 1))?;
            index += 1;
            continue;
        }
        let Some(file) = child.text("file") else {
            return Err(source.error(&child.span, "`include` lacks the attribute `file`", None));
        };
        if !opened.insert(file.to_owned()) {
            let help = "MuJoCo includes a file once; delete the second `include`";
            return Err(source.error(&child.span, format!("the file {} is included twice", quoted(file)), help));
        }
        let (text, name) = open(source, &child.span, file)?;
        let start = source.text.len();
        source.text.push_str(&text);
        source.included.push((start, name));
        let parts = parse(source, start, number)?.children;
        if parts.iter().any(|part| depth + height(part) > MAX_DEPTH) {
            return Err(too_deep(source, &element.children[index].span));
        }
        element.children.splice(index..=index, parts);
    }
    Ok(())
}

/// Returns the number of levels of an element, counting itself.
fn height(element: &Element) -> usize {
    1 + element.children.iter().map(height).max().unwrap_or(0)
}

fn too_deep(source: &Source, place: &Range<usize>) -> Report {
    let message = format!("the elements are nested more than {MAX_DEPTH} levels deep");
    source.error(place, message, None)
}

/// Reads an included file, and returns its text and its name in messages. MuJoCo searches the file in the folder of the
/// main file.
fn open(source: &Source, place: &Range<usize>, file: &str) -> Result<(String, String), Report> {
    let error = |message: String, help: Option<String>| Err(source.error(place, message, help));
    if source.file.starts_with('<') || source.file == "-" {
        let message = format!("the file includes {}, but rne has a text here and no folder", quoted(file));
        return error(message, Some("give rne the path of the file".to_owned()));
    }
    let path = Path::new(&source.file).parent().unwrap_or(Path::new("")).join(file);
    let name = path.display().to_string();
    let most = MAX_BYTES.saturating_sub(source.text.len()) as u64;
    let mut bytes = Vec::new();
    let read = open_file(&path).and_then(|file| file.take(most + 1).read_to_end(&mut bytes));
    if let Err(reason) = read {
        return error(format!("the included file {} cannot be read: {reason}", quoted(&name)), None);
    }
    if bytes.len() as u64 > most {
        let message = format!("the file and what it includes have more than {MAX_BYTES} bytes");
        return error(message, Some("rne reads no more".to_owned()));
    }
    let Ok(text) = String::from_utf8(bytes) else {
        return error(format!("the included file {} is not text in UTF-8", quoted(&name)), None);
    };
    Ok((text.strip_prefix('\u{FEFF}').map_or(text.clone(), str::to_owned), name))
}

/// Parses the root element of the text, beginning at `start`.
fn parse(source: &Source, start: usize, number: &mut usize) -> Result<Element, Report> {
    let text = &source.text[start..];
    let mut reader = Reader::from_str(text);
    let mut open: Vec<Element> = Vec::new();
    let mut root = None;
    loop {
        let from = usize::try_from(reader.buffer_position()).unwrap_or(0);
        let event = reader.read_event();
        let to = usize::try_from(reader.buffer_position()).unwrap_or(0).max(from);
        let from = from + text.get(from..to).and_then(|text| text.find('<')).unwrap_or(0);
        let place = start + from..start + to;
        let closed = match event {
            Ok(Event::Start(tag)) => {
                open.push(element(source, &tag, &place)?);
                None
            }
            Ok(Event::Empty(tag)) => Some(element(source, &tag, &place)?),
            Ok(Event::End(_)) => open.pop(),
            Ok(Event::DocType(_)) => {
                let help = "delete the line: an MJCF file needs no document type";
                return Err(source.error(&place, "the file has a document type; rne does not read its entities", help));
            }
            Ok(Event::Eof) => break,
            Ok(_) => None,
            Err(error) => {
                let at = start + usize::try_from(reader.error_position()).unwrap_or(0).min(text.len());
                return Err(source.error(&(at..at), format!("this is not XML: {error}"), None));
            }
        };
        *number += usize::from(closed.is_some());
        if *number > MAX_ELEMENTS {
            return Err(source.error(&place, format!("the file has more than {MAX_ELEMENTS} elements"), None));
        }
        if open.len() > MAX_DEPTH {
            return Err(too_deep(source, &place));
        }
        match (closed, open.last_mut()) {
            (Some(closed), Some(parent)) => parent.children.push(closed),
            (Some(_), None) if root.is_some() => {
                return Err(source.error(&place, "there is a second element after the root element", None));
            }
            (Some(closed), None) => root = Some(closed),
            (None, _) => {}
        }
    }
    let end = start + text.len();
    match root.filter(|_| open.is_empty()) {
        Some(root) if matches!(root.name.as_str(), "mujoco" | "mujocoinclude") => Ok(root),
        Some(root) => {
            let message = format!("found the element {} where `mujoco` is needed", quoted(&root.name));
            Err(source.error(&root.span, message, None))
        }
        None => Err(source.error(&(end..end), "this is not XML: the text ends within an element", None)),
    }
}

/// Makes an element from a tag, without children.
fn element(source: &Source, tag: &BytesStart, place: &Range<usize>) -> Result<Element, Report> {
    let name = String::from_utf8_lossy(tag.name().as_ref()).into_owned();
    let mut attributes: Vec<(String, String)> = Vec::new();
    for attribute in tag.attributes().with_checks(true) {
        let attribute = attribute.map_err(|error| source.error(place, format!("this is not XML: {error}"), None))?;
        let key = String::from_utf8_lossy(attribute.key.as_ref()).into_owned();
        let raw = String::from_utf8_lossy(&attribute.value).replace(['\t', '\n', '\r'], " ");
        let value = quick_xml::escape::unescape(&raw)
            .map_err(|error| source.error(place, format!("`{key}` cannot be read: {error}"), None))?
            .into_owned();
        if value.chars().any(|c| c.is_ascii_control()) {
            return Err(source.error(place, format!("{} has control characters", quoted(&key)), None));
        }
        attributes.push((key, value));
    }
    Ok(Element { name, span: place.clone(), attributes, children: Vec::new() })
}
