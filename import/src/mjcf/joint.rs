//! Reads the joints of a body; if a body has several, massless links are put between them.

use rne_model::{Limits, Report};

use super::body::{Bodies, Content, effort, placed};
use super::compiler::twice;
use super::element::Element;
use super::is_there;
use super::settings::Classed;
use crate::geometry::{Pose, Rotation, Vector, decimal};
use crate::source::quoted;
use crate::urdf::{Joint, Kind};

/// The attributes of a joint that are read.
const JOINT: [&str; 15] = [
    "name",
    "class",
    "type",
    "pos",
    "axis",
    "ref",
    "range",
    "limited",
    "armature",
    "damping",
    "frictionloss",
    "stiffness",
    "springdamper",
    "actuatorfrcrange",
    "actuatorfrclimited",
];

/// The attributes of a joint that are known and ignored.
const JOINT_PASSED_OVER: [&str; 6] = ["springref", "springyield", "margin", "group", "user", "actuatorgravcomp"];

impl<'a> Bodies<'a> {
    /// Adds the joints of a body, from the link `parent` to the link of the body. `place` is the placement of the body
    /// when all joints are at their reference positions.
    pub(super) fn joints(
        &mut self,
        parent: usize,
        place: Pose,
        name: &str,
        body: &'a Element,
        contents: &[Content<'a>],
    ) -> Result<usize, Report> {
        let joints: Vec<&Content> =
            contents.iter().filter(|content| matches!(content.element.name.as_str(), "joint" | "freejoint")).collect();
        let (mut on, mut before) = (parent, place);
        for (index, content) in joints.iter().enumerate() {
            let joint = self.settings.classed(content.element, content.class)?;
            if is_free(joint) {
                let is_alone = joints.len() == 1 && parent == 0;
                return self.free_body(joint, is_alone, place, name, body);
            }
            let mut read = self.joint(joint, name)?;
            let anchor = content.frame.point(Vector::decimal(joint.vector("pos")?.unwrap_or_default()));
            let axis = joint.vector("axis")?.unwrap_or([0.0, 0.0, 1.0]);
            let axis = content.frame.rotation * Vector::decimal(axis);
            let Some(direction) = axis.direction() else {
                let message = format!("the axis of the joint {} has no direction", quoted(&read.name));
                return Err(joint.refused(message, "write a direction, such as 0 0 1"));
            };
            let reference = joint.number("ref")?.unwrap_or(0.0);
            let reference =
                if read.kind == Kind::Prismatic { reference } else { self.settings.compiler.radians(reference) };
            read.reference = reference;
            let to = |translation: Vector| Pose { rotation: Rotation::identity(), translation };
            let back = match read.kind {
                Kind::Prismatic => to(direction * -decimal(reference)),
                Kind::Spherical => Pose::identity(),
                _ => Pose { rotation: Rotation::about(direction, -reference), translation: Vector::ZERO },
            };
            (read.xyz, read.rpy) = placed(before * to(anchor) * back);
            read.axis = axis.rounded(1.0);
            let is_last = index + 1 == joints.len() && anchor.to_f64() == [0.0; 3];
            let moved = if is_last { name.to_owned() } else { self.link_between(&read.name) };
            let link = self.link(moved, body)?;
            (read.parent, read.child) = (on, link);
            self.add(read);
            (on, before) = (link, to(-anchor));
            if is_last {
                return Ok(link);
            }
        }
        let link = self.link(name.to_owned(), body)?;
        self.fixed(on, link, before);
        Ok(link)
    }

    /// Adds the link of a body with a free joint, fixed where the file has the body.
    fn free_body(
        &mut self,
        joint: Classed<'a>,
        is_alone: bool,
        place: Pose,
        name: &str,
        body: &'a Element,
    ) -> Result<usize, Report> {
        if !is_alone {
            let message = format!("the body {} has a free joint and is not free", quoted(name));
            let help = "MuJoCo takes a free joint as the only joint of a body in `worldbody`";
            return Err(joint.refused(message, help));
        }
        if is_there(joint, &["armature", "damping", "frictionloss", "stiffness"])? {
            self.left_out.add_felt("armature, friction and springs of free joints are left out", name);
        }
        let link = self.link(name.to_owned(), body)?;
        self.fixed(0, link, place);
        self.floating.push(link);
        Ok(link)
    }

    /// Returns an unused name for the massless link that a joint moves when the same body has a further joint.
    fn link_between(&self, joint: &str) -> String {
        let numbered = (2..).map(|number| format!("{joint}_link_{number}"));
        let mut names = std::iter::once(format!("{joint}_link")).chain(numbered);
        names.find(|name| !self.links.contains(name)).unwrap_or_default()
    }

    /// Reads a hinge, slide or ball joint of the body `of`, without its placement.
    fn joint(&mut self, joint: Classed<'a>, of: &str) -> Result<Joint, Report> {
        joint.refuse_slips(&JOINT, &JOINT_PASSED_OVER)?;
        let kind = match joint.text("type").unwrap_or("hinge") {
            "hinge" => Kind::Continuous,
            "slide" => Kind::Prismatic,
            "ball" => Kind::Spherical,
            _ => return Err(joint.error("type", "it must be hinge, slide, ball or free")),
        };
        let name = if let Some(name) = joint.element.text("name") {
            if !self.joints.insert(name.to_owned()) {
                return Err(twice(self.settings.source, joint.element, name));
            }
            name.to_owned()
        } else {
            let mut names = (1..).map(|number| format!("{of}_joint_{number}"));
            names.find(|name| self.joints.insert(name.clone())).unwrap_or_default()
        };
        let mut not_negative = |attribute: &'static str, most: usize| match joint.numbers(attribute, 1, most)? {
            Some(numbers) if numbers[0] < 0.0 => Err(joint.error(attribute, "it must not be negative")),
            Some(numbers) => {
                if numbers[1..].iter().any(|number| *number != 0.0) {
                    self.left_out.add_felt("damping and stiffness of higher degree are left out", &name);
                }
                Ok(numbers[0])
            }
            None => Ok(0.0),
        };
        let friction = [not_negative("damping", 3)?, not_negative("frictionloss", 1)?];
        let rotor_inertia = not_negative("armature", 1)?;
        if not_negative("stiffness", 3)? != 0.0 || joint.numbers("springdamper", 2, 2)?.is_some() {
            self.left_out.add_felt("springs of joints are left out", &name);
        }
        let position = if kind == Kind::Spherical { None } else { joint.range("range", "limited")? };
        let position = position.filter(|(low, high)| low.is_finite() && high.is_finite());
        let position = position.map(|(low, high)| {
            let radians = |angle| self.settings.compiler.radians(angle);
            if kind == Kind::Prismatic { (low, high) } else { (radians(low), radians(high)) }
        });
        let range = joint.range("actuatorfrcrange", "actuatorfrclimited")?;
        let effort = range.and_then(|range| effort(self.left_out, &name, range));
        let kind = if position.is_some() && kind == Kind::Continuous { Kind::Revolute } else { kind };
        let limits = Limits { position, velocity: None, effort };
        let span = joint.element.span.clone();
        Ok(Joint { name, limits, friction, rotor_inertia, ..Joint::new(kind, span) })
    }
}

fn is_free(joint: Classed) -> bool {
    joint.element.name == "freejoint" || joint.text("type") == Some("free")
}
