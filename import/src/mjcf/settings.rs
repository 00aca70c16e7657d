//! Finds the values of attributes: those of the element itself, else those of its default class (`default`).

use std::ops::Range;

use rne_model::{LARGEST_ANGLE, Report, did_you_mean};

use super::compiler::Compiler;
use super::element::{Element, within};
use crate::geometry::Rotation;
use crate::source::{Help, Source, names, quoted};
use crate::urdf::xml::{LARGEST, end_of_range};

/// The kinds of actuators. A class has one set of default values for all of them (`Default` in MuJoCo's
/// `xml_native_reader.cc`).
const ACTUATORS: [&str; 12] = [
    "general",
    "motor",
    "position",
    "velocity",
    "intvelocity",
    "damper",
    "cylinder",
    "muscle",
    "adhesion",
    "dcmotor",
    "orientation",
    "pid",
];

/// The settings and default classes of the file.
pub(super) struct Settings<'a> {
    pub(super) source: &'a Source,
    pub(super) compiler: Compiler,
    classes: Vec<Class<'a>>,
}

/// A class of default values; the class 0 is that of all elements.
struct Class<'a> {
    name: &'a str,
    parent: Option<usize>,
    elements: Vec<&'a Element>,
}

/// An element together with its default class.
#[derive(Clone, Copy)]
pub(super) struct Classed<'a> {
    pub(super) element: &'a Element,
    pub(super) settings: &'a Settings<'a>,
    /// The class whose values replace attributes that the element lacks.
    class: Option<usize>,
}

impl<'a> Settings<'a> {
    pub(super) fn read(source: &'a Source, compiler: Compiler, root: &'a Element) -> Result<Self, Report> {
        let main = Class { name: "main", parent: None, elements: Vec::new() };
        let mut settings = Self { source, compiler, classes: vec![main] };
        for default in root.children("default") {
            let name = default.text("class").unwrap_or("main");
            settings.classes[0].name = name;
            settings.take(0, default)?;
        }
        Ok(settings)
    }

    /// Reads the default values of a class and of the classes inside it.
    fn take(&mut self, class: usize, default: &'a Element) -> Result<(), Report> {
        for element in &default.children {
            if element.name != "default" {
                self.classes[class].elements.push(element);
                continue;
            }
            let Some(name) = element.text("class") else {
                return Err(self.source.error(
                    &element.span,
                    "a `default` in another one lacks the attribute `class`",
                    None,
                ));
            };
            if self.classes.iter().any(|known| known.name == name) {
                let message = format!("the class {} is already defined", quoted(name));
                return Err(self.source.error(&element.span, message, "names of classes must differ"));
            }
            self.classes.push(Class { name, parent: Some(class), elements: Vec::new() });
            self.take(self.classes.len() - 1, element)?;
        }
        Ok(())
    }

    /// Returns the class of a name.
    pub(super) fn class(&self, name: &str, place: &Range<usize>) -> Result<usize, Report> {
        self.classes.iter().position(|class| class.name == name).ok_or_else(|| {
            let message = format!("there is no class {}", quoted(name));
            let known = self.classes.iter().map(|class| class.name);
            let help = did_you_mean(name, known.clone()).map_or_else(
                || format!("the classes are {}", names(known)),
                |meant| format!("did you mean {}?", quoted(meant)),
            );
            self.source.error(&within(self.source, place, name), message, help)
        })
    }

    /// Gives an element the class that it names, else `class`.
    pub(super) fn classed(&'a self, element: &'a Element, class: usize) -> Result<Classed<'a>, Report> {
        let class = element.text("class").map_or(Ok(class), |name| self.class(name, &element.span))?;
        Ok(Classed { element, settings: self, class: Some(class) })
    }

    /// Returns whether an attribute is true in the default values of one kind of elements, in the class of the element
    /// `of`.
    pub(super) fn default_flag(&self, kind: &str, attribute: &str, of: Classed<'_>) -> Option<bool> {
        let classes = std::iter::successors(of.class, |&class| self.classes[class].parent);
        let value = classes.into_iter().find_map(|class| {
            let elements = self.classes[class].elements.iter().rev().filter(|element| element.name == kind);
            elements.into_iter().find_map(|element| element.text(attribute))
        });
        value.map(|value| value != "false")
    }

    /// Gives an element no class.
    pub(super) fn plain(&'a self, element: &'a Element) -> Classed<'a> {
        Classed { element, settings: self, class: None }
    }
}

impl<'a> Classed<'a> {
    /// Returns the value of an attribute and the element that has it.
    fn find(self, attribute: &str) -> Option<(&'a Element, &'a str)> {
        if let Some(value) = self.element.text(attribute) {
            return Some((self.element, value));
        }
        let kind = |name: &'a str| match name {
            "fixed" | "spatial" => "tendon",
            name if ACTUATORS.contains(&name) => "general",
            name => name,
        };
        let name = kind(&self.element.name);
        let classes = &self.settings.classes;
        let class = std::iter::successors(self.class, |&class| classes[class].parent);
        class.into_iter().find_map(|class| {
            let elements = classes[class].elements.iter().rev().filter(|element| kind(&element.name) == name);
            elements.into_iter().find_map(|element| Some((*element, element.text(attribute)?)))
        })
    }

    pub(super) fn text(self, attribute: &str) -> Option<&'a str> {
        self.find(attribute).map(|(_, value)| value)
    }

    /// Makes an error about the value of an attribute.
    pub(super) fn error(self, attribute: &str, fault: &str) -> Report {
        let (element, value) = self.find(attribute).unwrap_or((self.element, ""));
        let source = self.settings.source;
        let message = format!("`{attribute}` of `{}` is {}; {fault}", element.name, quoted(value));
        source.error(&within(source, &element.span, value), message, None)
    }

    /// Makes an error about the element.
    pub(super) fn refused(self, message: impl Into<String>, help: impl Into<Help>) -> Report {
        self.settings.source.error(&self.element.span, message, help)
    }

    /// Reads the numbers of an attribute, from `least` to `most` of them.
    pub(super) fn numbers(self, attribute: &str, least: usize, most: usize) -> Result<Option<Vec<f64>>, Report> {
        let Some(value) = self.text(attribute) else { return Ok(None) };
        // a limit of a range may be infinite
        let most_of_all = if attribute.ends_with("range") { f64::INFINITY } else { LARGEST };
        let numbers: Vec<f64> = value
            .split_whitespace()
            .map_while(|word| word.parse::<f64>().ok().filter(|number| number.abs() <= most_of_all))
            .collect();
        let is_read = numbers.len() == value.split_whitespace().count();
        if is_read && (least..=most).contains(&numbers.len()) {
            return Ok(Some(numbers));
        }
        let fault = match (least, most) {
            (1, 1) => "it must be one number of at most 1e9".to_owned(),
            (least, most) if least == most => format!("it must be {least} numbers, each of at most 1e9"),
            (least, most) => format!("it must be {least} to {most} numbers, each of at most 1e9"),
        };
        Err(self.error(attribute, &fault))
    }

    pub(super) fn vector<const N: usize>(self, attribute: &str) -> Result<Option<[f64; N]>, Report> {
        Ok(self.numbers(attribute, N, N)?.and_then(|numbers| numbers.try_into().ok()))
    }

    pub(super) fn number(self, attribute: &str) -> Result<Option<f64>, Report> {
        Ok(self.vector(attribute)?.map(|[number]| number))
    }

    /// Returns the first number of an attribute that may have several.
    pub(super) fn first(self, attribute: &str, most: usize) -> Result<Option<f64>, Report> {
        Ok(self.numbers(attribute, 1, most)?.map(|numbers| numbers[0]))
    }

    /// Returns whether an attribute is true; `None` where it is missing or `auto`.
    pub(super) fn flag(self, attribute: &str) -> Result<Option<bool>, Report> {
        match self.text(attribute) {
            None | Some("auto") => Ok(None),
            Some("true") => Ok(Some(true)),
            Some("false") => Ok(Some(false)),
            Some(_) => Err(self.error(attribute, "it must be true, false or auto")),
        }
    }

    /// Returns the two limits of a range if the attribute `limited` is true; if it is missing, where the compiler's
    /// `autolimits` lets a range mean limits.
    pub(super) fn range(self, range: &str, limited: &str) -> Result<Option<(f64, f64)>, Report> {
        let ends = self.vector(range)?.map(|[low, high]| (end_of_range(low), end_of_range(high)));
        let is_limited = self.flag(limited)?.unwrap_or(self.settings.compiler.autolimits);
        Ok(ends.filter(|(low, high)| is_limited && low < high))
    }

    /// Reads angles and converts them to rad.
    pub(super) fn angles<const N: usize>(self, attribute: &str) -> Result<Option<[f64; N]>, Report> {
        let Some(angles) = self.vector::<N>(attribute)? else { return Ok(None) };
        let angles = angles.map(|angle| self.settings.compiler.radians(angle));
        if angles.iter().any(|angle| angle.is_finite() && angle.abs() >= LARGEST_ANGLE) {
            return Err(self.error(attribute, "an angle must be below 8388608 rad"));
        }
        Ok(Some(angles))
    }

    /// Returns the orientation of the element's frame in the frame around it.
    pub(super) fn rotation(self) -> Result<Rotation, Report> {
        let ways: Vec<&str> = ["quat", "axisangle", "xyaxes", "zaxis", "euler"]
            .into_iter()
            .filter(|way| self.element.text(way).is_some())
            .collect();
        if ways.len() > 1 {
            let message = format!("`{}` has several orientations: {}", self.element.name, names(&ways));
            return Err(self.refused(message, "keep one of them"));
        }
        let no_direction = |attribute| self.error(attribute, "it has no direction");
        if let Some([x, y, z, angle]) = self.vector("axisangle")? {
            let angle = self.settings.compiler.radians(angle);
            return Rotation::about_axis([x, y, z], angle).ok_or_else(|| no_direction("axisangle"));
        }
        if let Some([x0, x1, x2, y0, y1, y2]) = self.vector("xyaxes")? {
            return Rotation::of_xy([x0, x1, x2], [y0, y1, y2]).ok_or_else(|| no_direction("xyaxes"));
        }
        if let Some(z) = self.vector("zaxis")? {
            return Rotation::to_z(z).ok_or_else(|| no_direction("zaxis"));
        }
        if let Some(angles) = self.angles("euler")? {
            return Ok(self.settings.compiler.euler(angles));
        }
        let quaternion = self.vector("quat")?.unwrap_or([1.0, 0.0, 0.0, 0.0]);
        Rotation::quaternion(quaternion).ok_or_else(|| no_direction("quat"))
    }

    /// Refuses unknown attributes that are probably misspellings of attributes that are read, which `matter` has.
    /// `others` are known, too.
    pub(super) fn refuse_slips(self, matter: &[&str], others: &[&str]) -> Result<(), Report> {
        for (name, _) in &self.element.attributes {
            if matter.contains(&name.as_str()) || others.contains(&name.as_str()) {
                continue;
            }
            let meant = did_you_mean(name, matter.iter().chain(others).copied());
            if let Some(meant) = meant.filter(|meant| matter.contains(meant)) {
                let source = self.settings.source;
                let message = format!("there is no attribute {} of `{}`", quoted(name), self.element.name);
                let help = format!("did you mean `{meant}`? Correct the name, or delete the attribute");
                return Err(source.error(&within(source, &self.element.span, name), message, help));
            }
        }
        Ok(())
    }
}
