//! A URDF as a tree of links and joints, whose every number is finite and whose every name is known.

use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

use rne_model::{Inertia, Limits, Report};
use urdf_rs::JointType;

use crate::scan::{Scanned, Seen, scan};
use crate::source::{Source, names, quoted};

/// A robot as its URDF describes it. [`Urdf::read`] has checked that its links are one tree.
#[derive(Clone, Debug)]
pub struct Urdf {
    pub(crate) source: Source,
    pub(crate) name: String,
    /// In the order of the text.
    pub(crate) links: Vec<Link>,
    /// In the order of the text.
    pub(crate) joints: Vec<Joint>,
    /// The link that no joint moves.
    pub(crate) root: usize,
    /// Kinds of elements and attributes that are not known, in words.
    pub(crate) unknown: Vec<String>,
    /// Those of them that stand beside links and joints.
    pub(crate) beside: BTreeSet<usize>,
}

#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub(crate) name: String,
    pub(crate) span: Range<usize>,
    /// What in it is not known.
    pub(crate) unknown: BTreeSet<usize>,
    /// Mass, kg; 0 where there is no `inertial`.
    pub(crate) mass: f64,
    /// Centre of mass in the link frame, m.
    pub(crate) xyz: [f64; 3],
    /// The axes of the tensor, rad.
    pub(crate) rpy: [f64; 3],
    /// About the centre of mass, in the axes of `rpy`.
    pub(crate) inertia: Inertia,
    /// The joint that moves it.
    pub(crate) parent: Option<usize>,
    /// The joints that stand on it.
    pub(crate) children: Vec<usize>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Revolute,
    /// Revolute without limits of position.
    Continuous,
    Prismatic,
    Fixed,
    Planar,
    Floating,
    Spherical,
}

impl Kind {
    /// Its word in a URDF.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Revolute => "revolute",
            Self::Continuous => "continuous",
            Self::Prismatic => "prismatic",
            Self::Fixed => "fixed",
            Self::Planar => "planar",
            Self::Floating => "floating",
            Self::Spherical => "spherical",
        }
    }

    /// Whether one number says where it is.
    pub(crate) fn has_one_freedom(self) -> bool {
        matches!(self, Self::Revolute | Self::Continuous | Self::Prismatic)
    }
}

/// A joint that follows another one: q = `multiplier` · q of `joint` + `offset`.
#[derive(Clone, Debug)]
pub(crate) struct Mimic {
    pub(crate) joint: String,
    /// The same, where there is such a joint.
    pub(crate) leader: Option<usize>,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}

#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) name: String,
    pub(crate) span: Range<usize>,
    /// What in it is not known.
    pub(crate) unknown: BTreeSet<usize>,
    /// Whether its axis is written; 1 0 0 otherwise.
    pub(crate) has_axis: bool,
    /// Limits of position of which the lower one is above the upper one.
    pub(crate) crossed: Option<(f64, f64)>,
    pub(crate) kind: Kind,
    pub(crate) mimic: Option<Mimic>,
    /// The link on which it stands.
    pub(crate) parent: usize,
    /// The link that it moves.
    pub(crate) child: usize,
    pub(crate) xyz: [f64; 3],
    pub(crate) rpy: [f64; 3],
    /// As written: not of length 1.
    pub(crate) axis: [f64; 3],
    pub(crate) limits: Limits,
    /// Viscous and Coulomb friction, N m s/rad and N m, or N s/m and N.
    pub(crate) friction: [f64; 2],
}

impl Urdf {
    /// Reads the text of a URDF; `file` is what messages call it, its path. The robot file keeps its name without
    /// folders.
    ///
    /// # Errors
    ///
    /// What is wrong, with its place in the text: not XML, a document type, more than 16 MiB, a value that is no finite
    /// number, a name that is there twice or not at all, links that are not one tree.
    pub fn read(file: &str, text: &str) -> Result<Self, Report> {
        let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
        let source = Source { file: file.to_owned(), text: text.to_owned() };
        let scanned = scan(&source)?;
        let robot = urdf_rs::read_from_string(&scanned.text)
            .map_err(|error| source.error(&(0..0), format!("this URDF cannot be read: {error}"), None))?;
        let mut urdf = Self {
            source,
            name: robot.name,
            links: Vec::new(),
            joints: Vec::new(),
            root: 0,
            unknown: scanned.unknown.clone(),
            beside: scanned.robot.unknown.clone(),
        };
        urdf.take_links(robot.links, &scanned)?;
        urdf.take_joints(robot.joints, &scanned)?;
        urdf.find_root()?;
        Ok(urdf)
    }

    /// The names of the links that carry no other: where an arm may end.
    #[must_use]
    pub fn leaves(&self) -> Vec<&str> {
        self.links.iter().filter(|link| link.children.is_empty()).map(|link| link.name.as_str()).collect()
    }

    fn take_links(&mut self, links: Vec<urdf_rs::Link>, scanned: &Scanned) -> Result<(), Report> {
        let mut known = HashMap::new();
        for (link, seen) in links.into_iter().zip(&scanned.links) {
            let span = &seen.span;
            let urdf_rs::Inertial { origin, mass, inertia: i } = link.inertial;
            if let Some(first) = known.insert(link.name.clone(), span) {
                let message = format!("the link {} is there already, in line {}", quoted(&link.name), self.line(first));
                return Err(self.source.error(span, message, "names of links must differ".to_owned()));
            }
            if mass.value < 0.0 {
                let message = format!("the mass of the link {} is {} kg", quoted(&link.name), mass.value);
                return Err(self.source.error(span, message, "a mass is zero or positive".to_owned()));
            }
            self.links.push(Link {
                name: link.name,
                span: span.clone(),
                unknown: seen.unknown.clone(),
                mass: mass.value,
                xyz: origin.xyz.0,
                rpy: origin.rpy.0,
                inertia: Inertia { xx: i.ixx, yy: i.iyy, zz: i.izz, xy: i.ixy, xz: i.ixz, yz: i.iyz },
                parent: None,
                children: Vec::new(),
            });
        }
        Ok(())
    }

    fn take_joints(&mut self, joints: Vec<urdf_rs::Joint>, scanned: &Scanned) -> Result<(), Report> {
        let links: HashMap<String, usize> =
            self.links.iter().enumerate().map(|(index, link)| (link.name.clone(), index)).collect();
        let mut known = HashMap::new();
        for (index, (joint, seen)) in joints.into_iter().zip(&scanned.joints).enumerate() {
            let span = &seen.span;
            if let Some(first) = known.insert(joint.name.clone(), span) {
                let message =
                    format!("the joint {} is there already, in line {}", quoted(&joint.name), self.line(first));
                return Err(self.source.error(span, message, "names of joints must differ".to_owned()));
            }
            let link = |name: &str| {
                links.get(name).copied().ok_or_else(|| {
                    let message = format!("the joint {} names the link {}", quoted(&joint.name), quoted(name));
                    self.source.error(span, message, "there is no such link in the file".to_owned())
                })
            };
            let (parent, child) = (link(&joint.parent.link)?, link(&joint.child.link)?);
            if let Some(first) = self.links[child].parent {
                let message = format!(
                    "the link {} is moved by two joints, {} and {}",
                    quoted(&self.links[child].name),
                    quoted(&self.joints[first].name),
                    quoted(&joint.name)
                );
                return Err(self.source.error(span, message, "a URDF is a tree: loops cannot be closed".to_owned()));
            }
            self.links[child].parent = Some(index);
            self.links[parent].children.push(index);
            self.joints.push(taken(joint, seen, parent, child));
        }
        let known: HashMap<String, usize> =
            self.joints.iter().enumerate().map(|(index, joint)| (joint.name.clone(), index)).collect();
        for mimic in self.joints.iter_mut().filter_map(|joint| joint.mimic.as_mut()) {
            mimic.leader = known.get(&mimic.joint).copied();
        }
        Ok(())
    }

    /// The one link that no joint moves; from there every link is reached, or some joints form a circle.
    fn find_root(&mut self) -> Result<(), Report> {
        let roots: Vec<usize> = (0..self.links.len()).filter(|&link| self.links[link].parent.is_none()).collect();
        let [root] = roots[..] else {
            let (place, message) = match roots.get(1) {
                Some(&second) => {
                    let roots = names(roots.iter().map(|&root| &self.links[root].name));
                    (
                        self.links[second].span.clone(),
                        format!("no joint moves the links {roots}; one of them is the root"),
                    )
                }
                None if self.links.is_empty() => (0..0, "there is no link".to_owned()),
                None => (self.joints[0].span.clone(), "the joints form a circle: no link is the root".to_owned()),
            };
            return Err(self.source.error(&place, message, "join all links to one tree".to_owned()));
        };
        let mut reached = vec![false; self.links.len()];
        let mut open = vec![root];
        while let Some(link) = open.pop() {
            reached[link] = true;
            open.extend(self.links[link].children.iter().map(|&joint| self.joints[joint].child));
        }
        if let Some(lost) = reached.iter().position(|reached| !reached) {
            let message = format!("the link {} hangs in a circle of joints", quoted(&self.links[lost].name));
            return Err(self.source.error(&self.links[lost].span, message, "join all links to one tree".to_owned()));
        }
        self.root = root;
        Ok(())
    }

    /// The line, from 1, in which a place of the text begins.
    fn line(&self, span: &Range<usize>) -> usize {
        1 + self.source.text.as_bytes().iter().take(span.start).filter(|&&byte| byte == b'\n').count()
    }
}

fn taken(joint: urdf_rs::Joint, seen: &Seen, parent: usize, child: usize) -> Joint {
    let kind = match joint.joint_type {
        JointType::Revolute => Kind::Revolute,
        JointType::Continuous => Kind::Continuous,
        JointType::Prismatic => Kind::Prismatic,
        JointType::Fixed => Kind::Fixed,
        JointType::Planar => Kind::Planar,
        JointType::Floating => Kind::Floating,
        JointType::Spherical => Kind::Spherical,
    };
    let limit = &joint.limit;
    // Zero stands where nothing was measured.
    let positive = |limit: f64| (limit > 0.0 && limit.is_finite()).then_some(limit);
    let both = limit.lower.is_finite() && limit.upper.is_finite() && limit.lower < limit.upper;
    let position = (both && kind != Kind::Continuous).then_some((limit.lower, limit.upper));
    let crossed = (limit.lower > limit.upper && kind != Kind::Continuous).then_some((limit.lower, limit.upper));
    let limits = Limits { position, velocity: positive(limit.velocity), effort: positive(limit.effort) };
    let mimic = joint.mimic.map(|mimic| Mimic {
        joint: mimic.joint,
        leader: None,
        multiplier: mimic.multiplier.unwrap_or(1.0),
        offset: mimic.offset.unwrap_or(0.0),
    });
    let friction = joint.dynamics.map_or([0.0; 2], |dynamics| [dynamics.damping, dynamics.friction]);
    Joint {
        name: joint.name,
        span: seen.span.clone(),
        unknown: seen.unknown.clone(),
        has_axis: seen.elements.contains("axis"),
        crossed,
        kind,
        mimic,
        parent,
        child,
        xyz: joint.origin.xyz.0,
        rpy: joint.origin.rpy.0,
        axis: joint.axis.xyz.0,
        limits,
        friction,
    }
}
