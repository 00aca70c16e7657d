//! The bodies of an MJCF file as links, with their joints and sites.

use std::collections::{BTreeSet, HashSet};

use rne_model::{Limits, Report};

use super::compiler::twice;
use super::element::Element;
use super::geom;
use super::settings::{Classed, Settings};
use super::{LeftOut, inertial, is_there};
use crate::geometry::{Pose, Rotation, Vector, decimal};
use crate::source::{Source, quoted};
use crate::urdf::{Joint, Kind, Link, Urdf};

/// The link of the world.
pub(super) const WORLD: &str = "world";

/// The remark on bodies that a motion capture moves.
pub(super) const MOCAP: &str = "bodies that a motion capture moves (`mocap`) are fixed";

/// The help where MuJoCo must compile the model.
pub(super) const COMPILED: &str = "in Python, rne.from_mujoco(mujoco.MjModel.from_xml_path(FILE)) takes the compiled \
                                   model; or mujoco.mj_saveLastXML(FILE, model) saves it as a file for rne, if \
                                   `compiler` has `saveinertial=\"true\"`: without this, some versions of MuJoCo lose \
                                   `inertiagrouprange`, and with it the right inertias";

/// More links than any robot has.
const MAX_LINKS: usize = 20_000;

/// An element of a body, and the frame of the body in which it stands.
#[derive(Clone, Copy)]
pub(super) struct Content<'a> {
    pub(super) element: &'a Element,
    pub(super) frame: Pose,
    /// The class of elements that name none.
    pub(super) class: usize,
}

/// Bodies that are read one after the other, each before those in it.
pub(super) struct Bodies<'a> {
    settings: &'a Settings<'a>,
    left_out: &'a mut LeftOut,
    urdf: Urdf,
    /// The names of links and of joints that are taken.
    links: HashSet<String>,
    joints: HashSet<String>,
    /// Sites, with the links on which they are.
    sites: Vec<(usize, Content<'a>)>,
    /// Links that a free joint moves.
    floating: Vec<usize>,
}

impl<'a> Bodies<'a> {
    /// All bodies of the file below a link `world`.
    pub(super) fn read(
        settings: &'a Settings<'a>,
        left_out: &'a mut LeftOut,
        root: &'a Element,
    ) -> Result<Urdf, Report> {
        let mut bodies = Self {
            settings,
            left_out,
            urdf: Urdf::empty(Source::default()),
            links: HashSet::new(),
            joints: HashSet::new(),
            sites: Vec::new(),
            floating: Vec::new(),
        };
        bodies.link(WORLD.to_owned(), root)?;
        for world in root.children("worldbody") {
            let class = world.text("childclass").map_or(Ok(0), |name| settings.class(name, &world.span))?;
            let mut contents = Vec::new();
            bodies.contents(world, Pose::identity(), class, &mut contents)?;
            bodies.below(0, &contents)?;
        }
        if bodies.urdf.links.len() == 1 {
            let help = "a model has a `body` in its `worldbody` for each link";
            return Err(settings.source.error(&root.span, "the file has no body", help));
        }
        bodies.add_sites()?;
        bodies.scale_masses();
        bodies.find_base();
        Ok(bodies.urdf)
    }

    /// The elements of a body, and those of its frames (`frame`).
    fn contents(
        &self,
        of: &'a Element,
        frame: Pose,
        class: usize,
        contents: &mut Vec<Content<'a>>,
    ) -> Result<(), Report> {
        for element in &of.children {
            match element.name.as_str() {
                "frame" => {
                    let placed = frame * pose(self.settings.plain(element))?;
                    self.contents(element, placed, self.childclass(element, class)?, contents)?;
                }
                "replicate" | "attach" | "composite" | "flexcomp" => {
                    let message = format!("rne does not read the element `{}`, which makes bodies", element.name);
                    return Err(self.settings.source.error(&element.span, message, COMPILED));
                }
                _ => contents.push(Content { element, frame, class }),
            }
        }
        Ok(())
    }

    /// The class of the elements in a body or a frame.
    fn childclass(&self, element: &Element, class: usize) -> Result<usize, Report> {
        element.text("childclass").map_or(Ok(class), |name| self.settings.class(name, &element.span))
    }

    /// The bodies and sites on a link.
    fn below(&mut self, link: usize, contents: &[Content<'a>]) -> Result<(), Report> {
        for content in contents {
            match content.element.name.as_str() {
                "body" => self.body(link, *content)?,
                "site" => self.sites.push((link, *content)),
                _ => {}
            }
        }
        Ok(())
    }

    /// A body on the link `parent`, and all on it.
    fn body(&mut self, parent: usize, Content { element, frame, class }: Content<'a>) -> Result<(), Report> {
        let body = self.settings.plain(element);
        body.refuse_slips(&["name", "pos", "quat", "axisangle", "xyaxes", "zaxis", "euler", "childclass"], &[])?;
        let name = element.text("name").map_or_else(|| format!("body_{}", self.urdf.links.len()), str::to_owned);
        if body.number("gravcomp")?.unwrap_or(0.0) != 0.0 {
            self.left_out.add_felt("forces that compensate gravity (`gravcomp`) are left out", &name);
        }
        if element.text("mocap") == Some("true") {
            self.left_out.add(MOCAP, &name);
        }
        let mut contents = Vec::new();
        self.contents(element, Pose::identity(), self.childclass(element, class)?, &mut contents)?;
        let place = frame * pose(body)?;
        let link = self.joints(parent, place, &name, element, &contents)?;
        let inertial = inertial::read(self.settings, &name, (element, place), &contents)?;
        self.urdf.links[link] = Link { mass: inertial.mass, xyz: inertial.com, ..self.urdf.links[link].clone() };
        (self.urdf.links[link].rpy, self.urdf.links[link].inertia) = (inertial.rpy, inertial.inertia);
        if let Some(written) = contents.iter().find(|content| content.element.name == "inertial") {
            self.urdf.links[link].span_of_inertia = written.element.span.clone();
        }
        self.below(link, &contents)
    }

    /// The joints of a body, from the link `parent` to that of the body, which is at `place` where all are at their
    /// reference.
    fn joints(
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
                if joints.len() > 1 || parent != 0 {
                    let message = format!("the body {} has a free joint and is not free", quoted(name));
                    let help = "MuJoCo takes a free joint as the only joint of a body in `worldbody`";
                    return Err(joint.refused(message, help));
                }
                if is_there(joint, &["armature", "damping", "frictionloss", "stiffness"])? {
                    self.left_out.add_felt("armature, friction and springs of free joints are left out", name);
                }
                let link = self.link(name.to_owned(), body)?;
                self.fixed(on, link, before);
                self.floating.push(link);
                return Ok(link);
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
            let moved = if is_last {
                name.to_owned()
            } else {
                let free = (1..).map(|number| if number == 1 { String::new() } else { format!("_{number}") });
                let mut names = free.map(|number| format!("{}_link{number}", read.name));
                names.find(|name| !self.links.contains(name)).unwrap_or_default()
            };
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

    /// A hinge, slide or ball of the body `of`, without its place.
    fn joint(&mut self, joint: Classed<'a>, of: &str) -> Result<Joint, Report> {
        const MATTER: [&str; 15] = [
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
        joint.refuse_slips(&MATTER, &["springref", "springyield", "margin", "group", "user", "actuatorgravcomp"])?;
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
        let effort = joint.range("actuatorfrcrange", "actuatorfrclimited")?;
        let effort = effort.and_then(|range| self.effort(&name, range));
        let kind = if position.is_some() && kind == Kind::Continuous { Kind::Revolute } else { kind };
        let limits = Limits { position, velocity: None, effort };
        let span = joint.element.span.clone();
        Ok(Joint { name, limits, friction, rotor_inertia, ..Joint::new(kind, span) })
    }

    fn effort(&mut self, joint: &str, range: (f64, f64)) -> Option<f64> {
        effort(self.left_out, joint, range)
    }

    /// A new link, without mass.
    fn link(&mut self, name: String, of: &Element) -> Result<usize, Report> {
        if !self.links.insert(name.clone()) {
            return Err(twice(self.settings.source, of, &name));
        }
        if self.urdf.links.len() >= MAX_LINKS {
            let message = format!("the file has more than {MAX_LINKS} bodies and sites");
            return Err(self.settings.source.error(&of.span, message, None));
        }
        self.urdf.links.push(Link::new(name, of.span.clone()));
        Ok(self.urdf.links.len() - 1)
    }

    /// Fixes a link to another one.
    fn fixed(&mut self, parent: usize, child: usize, place: Pose) {
        let link = &self.urdf.links[child];
        let (xyz, rpy) = placed(place);
        let mut names = std::iter::successors(Some(format!("to_{}", link.name)), |name| Some(format!("{name}'")));
        let name = names.find(|name| !self.joints.contains(name)).unwrap_or_default();
        self.joints.insert(name.clone());
        self.add(Joint { name, parent, child, xyz, rpy, ..Joint::new(Kind::Fixed, link.span.clone()) });
    }

    fn add(&mut self, joint: Joint) {
        let index = self.urdf.joints.len();
        self.urdf.links[joint.child].parent = Some(index);
        self.urdf.links[joint.parent].children.push(index);
        self.urdf.joints.push(joint);
    }

    /// Sites, as links without mass. One that has the name of a body gets another one.
    fn add_sites(&mut self) -> Result<(), Report> {
        let mut seen = BTreeSet::new();
        for (link, Content { element, frame, class }) in std::mem::take(&mut self.sites) {
            let site = self.settings.classed(element, class)?;
            let Some(name) = element.text("name") else { continue };
            if !seen.insert(name) {
                return Err(twice(self.settings.source, element, name));
            }
            let mut names = std::iter::successors(Some(name.to_owned()), |name| Some(format!("{name}_site")));
            let name = names.find(|name| !self.links.contains(name)).unwrap_or_default();
            let place = match site.vector("fromto")? {
                Some(ends) => geom::between(site, ends)?.0,
                None => pose(site)?,
            };
            let index = self.link(name, element)?;
            self.urdf.links[index].is_site = true;
            self.fixed(link, index, frame * place);
        }
        Ok(())
    }

    /// The masses, so that they add up to the prescribed one.
    fn scale_masses(&mut self) {
        let all: f64 = self.urdf.links.iter().map(|link| link.mass).sum();
        let Some(total) = self.settings.compiler.total_mass.filter(|_| all > 0.0) else { return };
        let scale = total / all;
        for link in &mut self.urdf.links {
            link.mass *= scale;
            let rows = [&mut link.inertia.xx, &mut link.inertia.yy, &mut link.inertia.zz];
            let products = [&mut link.inertia.xy, &mut link.inertia.xz, &mut link.inertia.yz];
            rows.into_iter().chain(products).for_each(|element| *element *= scale);
        }
    }

    /// Makes the body that floats and carries all joints the base of the robot.
    fn find_base(&mut self) {
        self.urdf.find_floating(&self.floating);
        for &link in self.floating.iter().filter(|&&link| self.urdf.floats != Some(link)) {
            let name = quoted(&self.urdf.links[link].name);
            self.urdf.remarks.push(format!(
                "the body {name} has a free joint, and rne fixes it where the file has it: only a body that carries \
                 all other joints can be a floating base"
            ));
        }
    }
}

fn is_free(joint: Classed) -> bool {
    joint.element.name == "freejoint" || joint.text("type") == Some("free")
}

/// Position and orientation of an element.
pub(super) fn pose(element: Classed) -> Result<Pose, Report> {
    let position = element.vector("pos")?.unwrap_or_default();
    Ok(Pose { rotation: element.rotation()?, translation: Vector::decimal(position) })
}

/// A pose as numbers.
pub(super) fn placed(pose: Pose) -> ([f64; 3], [f64; 3]) {
    let size = pose.translation.to_f64().into_iter().map(f64::abs).fold(1.0, f64::max);
    (pose.translation.rounded(size), pose.rotation.to_rpy())
}

/// The one limit of a torque that is within a range; the smaller one of two that differ.
pub(super) fn effort(left_out: &mut LeftOut, joint: &str, (low, high): (f64, f64)) -> Option<f64> {
    let limit = low.abs().min(high.abs());
    if low != -high {
        left_out.add("limits of torque that differ with the direction are taken as the smaller one", joint);
    }
    (low < 0.0 && high > 0.0 && limit.is_finite()).then_some(limit)
}
