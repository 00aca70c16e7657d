//! The relevant elements and attributes of a URDF, those that are known but ignored, and the values that each attribute
//! may have.

use rne_model::LARGEST_ANGLE;

use super::LARGEST;
use crate::urdf;

/// An element that dynamics needs.
pub(super) struct Element {
    pub(super) name: &'static str,
    pub(super) parent: &'static str,
    pub(super) attributes: &'static [Attribute],
}

pub(super) struct Attribute {
    pub(super) name: &'static str,
    pub(super) kind: Kind,
    pub(super) required: bool,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Text,
    /// The value is a kind of joint.
    Joint,
    /// The value is a kind of joint that closes a loop.
    Cut,
    /// The value is true or false.
    Flag,
    Number,
    /// The value is a number that may be infinite.
    Limit,
    Vector,
    Angles,
}

const fn text(name: &'static str) -> Attribute {
    Attribute { name, kind: Kind::Text, required: true }
}

const fn number(name: &'static str) -> Attribute {
    Attribute { name, kind: Kind::Number, required: true }
}

const fn optional(name: &'static str, kind: Kind) -> Attribute {
    Attribute { name, kind, required: false }
}

const fn limit(name: &'static str) -> Attribute {
    optional(name, Kind::Limit)
}

const TYPE: Attribute = Attribute { name: "type", kind: Kind::Joint, required: true };

const ORIGIN: &[Attribute] = &[optional("xyz", Kind::Vector), optional("rpy", Kind::Angles)];

const fn element(name: &'static str, parent: &'static str, attributes: &'static [Attribute]) -> Element {
    Element { name, parent, attributes }
}

pub(super) const ELEMENTS: &[Element] = &[
    element("robot", "", &[optional("name", Kind::Text)]),
    element("link", "robot", &[text("name")]),
    element("inertial", "link", &[]),
    element("origin", "inertial", ORIGIN),
    element("mass", "inertial", &[number("value")]),
    element(
        "inertia",
        "inertial",
        &[number("ixx"), number("ixy"), number("ixz"), number("iyy"), number("iyz"), number("izz")],
    ),
    element("joint", "robot", &[text("name"), TYPE, optional("independent", Kind::Flag)]),
    element("origin", "joint", ORIGIN),
    element("parent", "joint", &[text("link")]),
    element("child", "joint", &[text("link")]),
    element("axis", "joint", &[Attribute { name: "xyz", kind: Kind::Vector, required: true }]),
    element("limit", "joint", &[limit("lower"), limit("upper"), limit("effort"), limit("velocity")]),
    element("mimic", "joint", &[text("joint"), optional("multiplier", Kind::Number), optional("offset", Kind::Number)]),
    element("dynamics", "joint", &[optional("damping", Kind::Number), optional("friction", Kind::Number)]),
    element("coupling", "robot", &[optional("name", Kind::Text)]),
    element("predecessor", "coupling", &[text("link")]),
    element("successor", "coupling", &[text("link")]),
    element("ratio", "coupling", &[number("value")]),
    element(
        "loop",
        "robot",
        &[optional("name", Kind::Text), Attribute { name: "type", kind: Kind::Cut, required: true }],
    ),
    element("predecessor", "loop", &[text("link")]),
    element("successor", "loop", &[text("link")]),
    element("origin", "predecessor", ORIGIN),
    element("origin", "successor", ORIGIN),
    element("axis", "loop", &[Attribute { name: "xyz", kind: Kind::Vector, required: true }]),
];

/// Elements that are known and ignored, by the element that contains them.
pub(super) const PASSED_OVER: &[(&str, &[&str])] = &[
    ("robot", &["material", "gazebo", "transmission", "sensor", "ros2_control", "mujoco"]),
    ("link", &["visual", "collision", "contact"]),
    ("joint", &["calibration", "safety_controller"]),
];

/// Attributes that are known and ignored, by their element.
pub(super) const PASSED_OVER_ATTRIBUTES: &[(&str, &[&str])] = &[("robot", &["version", "xmlns"])];

/// Returns the entry of a list under a name.
pub(super) fn passed_over(list: &[(&str, &'static [&'static str])], name: &str) -> &'static [&'static str] {
    list.iter().find(|(of, _)| *of == name).map_or(&[], |(_, known)| known)
}

/// Returns the reason why a value does not fit an attribute, if it does not.
pub(super) fn fault(kind: Kind, value: &str) -> Option<&'static str> {
    let number = |word: &str| word.parse::<f64>().ok();
    let fine = |word: &str| number(word).is_some_and(|x| x.abs() <= LARGEST);
    let is_angle = |word: &str| number(word).is_some_and(|x| x.abs() < LARGEST_ANGLE);
    let words: Vec<&str> = value.split_whitespace().collect();
    match kind {
        Kind::Text if value.trim().is_empty() => Some("it must not be empty"),
        Kind::Text if value.chars().any(|c| c.is_ascii_control() && !c.is_ascii_whitespace()) => {
            Some("it must have no control characters")
        }
        Kind::Joint if urdf::Kind::of(value).is_none() => {
            Some("it must be revolute, continuous, prismatic, fixed, floating, planar or spherical")
        }
        Kind::Cut if urdf::cut(value).is_none() => {
            Some("it must be revolute, continuous, spherical, universal or fixed, the joints that can close a loop")
        }
        Kind::Flag if !matches!(value, "true" | "false") => Some("it must be true or false"),
        Kind::Number if words.len() != 1 || !words.iter().all(|word| fine(word)) => {
            Some("it must be one number of at most 1e9")
        }
        Kind::Limit if words.len() != 1 || !words.iter().all(|word| number(word).is_some_and(|x| !x.is_nan())) => {
            Some("it must be one number")
        }
        Kind::Vector if words.len() != 3 || !words.iter().all(|word| fine(word)) => {
            Some("it must be three numbers, each of at most 1e9")
        }
        Kind::Angles if words.len() != 3 || !words.iter().all(|word| is_angle(word)) => {
            Some("it must be three numbers, each below 8388608 rad")
        }
        _ => None,
    }
}
