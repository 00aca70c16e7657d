//! Reads the bodies of an MJCF file as links, with their joints and sites.

use std::collections::{BTreeSet, HashSet};

use rne_model::Report;

use super::compiler::twice;
use super::element::Element;
use super::geom;
use super::settings::{Classed, Settings};
use super::{LeftOut, inertial};
use crate::geometry::{Pose, Vector};
use crate::source::{Source, quoted};
use crate::urdf::{Joint, Kind, Link, Urdf};

/// The name of the link that is the world.
pub(super) const WORLD: &str = "world";

/// The remark on bodies that motion capture moves.
pub(super) const MOCAP: &str = "bodies that a motion capture moves (`mocap`) are fixed";

/// The help for parts that only MuJoCo's compiler can evaluate.
pub(super) const COMPILED: &str = "in Python, rne.from_mujoco(mujoco.MjModel.from_xml_path(FILE)) takes the compiled \
                                   model; or mujoco.mj_saveLastXML(FILE, model) saves it as a file for rne, if \
                                   `compiler` has `saveinertial=\"true\"`: without this, some versions of MuJoCo lose \
                                   `inertiagrouprange`, and with it the right inertias";

/// Largest number of links, more than any robot has.
const MAX_LINKS: usize = 20_000;

/// An element of a body, and the frame in which it is, relative to the body.
#[derive(Clone, Copy)]
pub(super) struct Content<'a> {
    pub(super) element: &'a Element,
    pub(super) frame: Pose,
    /// The default class of elements that name no class.
    pub(super) class: usize,
}

/// The bodies that have been read so far; each body is read before the bodies in it.
pub(super) struct Bodies<'a> {
    pub(super) settings: &'a Settings<'a>,
    pub(super) left_out: &'a mut LeftOut,
    pub(super) urdf: Urdf,
    /// The names of links that are used already, and those of joints.
    pub(super) links: HashSet<String>,
    pub(super) joints: HashSet<String>,
    /// Sites, each with the link that carries it.
    sites: Vec<(usize, Content<'a>)>,
    /// Links that a free joint moves.
    pub(super) floating: Vec<usize>,
}

impl<'a> Bodies<'a> {
    /// Reads all bodies of the file as links below a link `world`.
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

    /// Returns the elements of a body, including those inside its elements `frame`.
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

    /// Returns the default class for the elements in a body or a frame.
    fn childclass(&self, element: &Element, class: usize) -> Result<usize, Report> {
        element.text("childclass").map_or(Ok(class), |name| self.settings.class(name, &element.span))
    }

    /// Reads the bodies on a link, and stores its sites.
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

    /// Reads a body on the link `parent`, and everything on this body.
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

    /// Adds a link without mass.
    pub(super) fn link(&mut self, name: String, of: &Element) -> Result<usize, Report> {
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

    /// Adds a fixed joint between two links.
    pub(super) fn fixed(&mut self, parent: usize, child: usize, place: Pose) {
        let link = &self.urdf.links[child];
        let (xyz, rpy) = placed(place);
        let mut names = std::iter::successors(Some(format!("to_{}", link.name)), |name| Some(format!("{name}'")));
        let name = names.find(|name| !self.joints.contains(name)).unwrap_or_default();
        self.joints.insert(name.clone());
        self.add(Joint { name, parent, child, xyz, rpy, ..Joint::new(Kind::Fixed, link.span.clone()) });
    }

    pub(super) fn add(&mut self, joint: Joint) {
        let index = self.urdf.joints.len();
        self.urdf.links[joint.child].parent = Some(index);
        self.urdf.links[joint.parent].children.push(index);
        self.urdf.joints.push(joint);
    }

    /// Adds sites as links without mass. A site with the name of a body gets another name.
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

    /// Scales the masses and inertias of all links so that the sum of the masses is the one that the file prescribes.
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

    /// Makes the floating body that carries all joints the base of the robot.
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

/// Returns the position and orientation of an element.
pub(super) fn pose(element: Classed) -> Result<Pose, Report> {
    let position = element.vector("pos")?.unwrap_or_default();
    Ok(Pose { rotation: element.rotation()?, translation: Vector::decimal(position) })
}

/// Returns a pose as a translation and roll, pitch, yaw.
pub(super) fn placed(pose: Pose) -> ([f64; 3], [f64; 3]) {
    let size = pose.translation.to_f64().into_iter().map(f64::abs).fold(1.0, f64::max);
    (pose.translation.rounded(size), pose.rotation.to_rpy())
}

/// Converts a range of torque to one limit for both directions: the smaller magnitude, with a remark if they differ.
pub(super) fn effort(left_out: &mut LeftOut, joint: &str, (low, high): (f64, f64)) -> Option<f64> {
    let limit = low.abs().min(high.abs());
    if low != -high {
        left_out.add("limits of torque that differ with the direction are taken as the smaller one", joint);
    }
    (low < 0.0 && high > 0.0 && limit.is_finite()).then_some(limit)
}
