//! A URDF as a tree of links and joints, whose every number is finite and whose every name is known. An MJCF file
//! becomes the same tree.

mod elements;
pub(crate) mod xml;

use std::collections::BTreeSet;
use std::ops::Range;

use rne_model::{Cut, Inertia, Limits, Report};

use crate::closed_loop::Loop;
use crate::mjcf;
use crate::remark::Remarks;
use crate::source::Source;
use crate::transmission;
use crate::urdf::xml::{root_name, scan};

/// A robot as its URDF or its MJCF file describes it. [`Urdf::read`] has checked that its links are one tree.
#[derive(Clone, Debug)]
pub struct Urdf {
    pub(crate) source: Source,
    pub(crate) name: String,
    /// In the order of the text.
    pub(crate) links: Vec<Link>,
    /// In the order of the text.
    pub(crate) joints: Vec<Joint>,
    /// Joints that gears couple to others, of URDF+.
    pub(crate) gears: Vec<Gear>,
    /// Closed loops.
    pub(crate) loops: Vec<Loop>,
    /// The link that no joint moves.
    pub(crate) root: usize,
    /// The link at the base of an arm that names none: the root, or the link that floats.
    pub(crate) base: usize,
    /// The link that carries all joints as a floating base: a floating joint in a URDF, or a free joint in an MJCF
    /// file, moves it. This joint is `Fixed` here.
    pub(crate) floats: Option<usize>,
    /// The acceleration of gravity in the axes of the root, m/s², where the file says it.
    pub(crate) gravity: Option<[f64; 3]>,
    /// Remarks on what the file has and a robot file has not, in sentences.
    pub(crate) remarks: Remarks,
    /// Kinds of elements and attributes that are not known, in words.
    pub(crate) unknown: Vec<String>,
    /// The unknown elements beside links and joints.
    pub(crate) beside: BTreeSet<usize>,
}

#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub(crate) name: String,
    pub(crate) span: Range<usize>,
    /// The place of its inertia.
    pub(crate) span_of_inertia: Range<usize>,
    /// Unknown names in it.
    pub(crate) unknown: BTreeSet<usize>,
    /// Mass, kg; 0 where there is no `inertial`.
    pub(crate) mass: f64,
    /// Centre of mass in the link frame, m.
    pub(crate) xyz: [f64; 3],
    /// The axes of the tensor, rad.
    pub(crate) rpy: [f64; 3],
    /// About the centre of mass, in the axes of `rpy`.
    pub(crate) inertia: Inertia,
    /// Whether it is a mark on another link, and no end of an arm: a site of an MJCF file.
    pub(crate) is_site: bool,
    /// The joint that moves it.
    pub(crate) parent: Option<usize>,
    /// The joints whose parent it is.
    pub(crate) children: Vec<usize>,
}

/// The cut joint of a word in a URDF+.
pub(crate) fn cut(word: &str) -> Option<Cut> {
    match word {
        "revolute" | "continuous" => Some(Cut::Revolute),
        "spherical" => Some(Cut::Spherical),
        "universal" => Some(Cut::Universal),
        "fixed" => Some(Cut::Weld),
        _ => None,
    }
}

/// A joint that gears couple to others: its position is Σ ratio · q of those.
#[derive(Clone, Debug)]
pub(crate) struct Gear {
    /// The place of its tag.
    pub(crate) span: Range<usize>,
    pub(crate) joint: usize,
    /// The joints that it follows, and the ratios.
    pub(crate) follows: Vec<(usize, f64)>,
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
    pub(crate) const ALL: [Self; 7] =
        [Self::Revolute, Self::Continuous, Self::Prismatic, Self::Fixed, Self::Floating, Self::Planar, Self::Spherical];

    /// The kind of a word in a URDF.
    pub(crate) fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == word)
    }

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
    /// The index of that joint, where it exists.
    pub(crate) leader: Option<usize>,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}

#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) name: String,
    pub(crate) span: Range<usize>,
    /// Unknown names in it.
    pub(crate) unknown: BTreeSet<usize>,
    /// Whether its axis is written; 1 0 0 otherwise.
    pub(crate) has_axis: bool,
    /// Limits of position of which the lower one is above the upper one.
    pub(crate) crossed: Option<(f64, f64)>,
    /// Limits of effort and velocity that are below zero.
    pub(crate) negative: Vec<(&'static str, f64)>,
    pub(crate) kind: Kind,
    pub(crate) mimic: Option<Mimic>,
    /// The parent link.
    pub(crate) parent: usize,
    /// The link that it moves.
    pub(crate) child: usize,
    pub(crate) xyz: [f64; 3],
    pub(crate) rpy: [f64; 3],
    /// As written: not of length 1.
    pub(crate) axis: [f64; 3],
    pub(crate) limits: Limits,
    /// Viscous and Coulomb friction at the joint, N m s/rad and N m, or N s/m and N.
    pub(crate) friction: [f64; 2],
    /// Inertia of the rotor about its own axis, kg m², or its mass, kg.
    pub(crate) rotor_inertia: f64,
    /// Motor angle by joint angle.
    pub(crate) gear_ratio: f64,
    /// The position at which the links are where the file has them, rad or m: `ref` of an MJCF file.
    pub(crate) reference: f64,
    /// Whether it has a motor, where the file says it.
    pub(crate) has_motor: Option<bool>,
}

impl Urdf {
    /// Reads the text of a URDF, or of an MJCF file, whose root element is `mujoco`. `file` is what messages call it,
    /// its path; files that an MJCF file includes are read from its folder. The robot file keeps its name without
    /// folders. Closed loops that a URDF has not are read from the file beside it, `robot.yaml` for `robot.urdf`, if
    /// that has the key `closed_loop`, as those of Gepetto/example-parallel-robots have.
    ///
    /// # Errors
    ///
    /// An error with its place in the text: not XML, a document type, more than 16 MiB, a value that is no finite
    /// number, a name that is there twice or not at all, links that are not one tree.
    pub fn read(file: &str, text: &str) -> Result<Self, Report> {
        let loops = crate::extended_urdf::beside(file);
        Self::read_with_loops(file, text, loops.as_ref().map(|(name, text)| (name.as_str(), text.as_str())))
    }

    /// [`Urdf::read`] with the closed loops of the file `loops`, its name and its text, and not of one beside the URDF.
    ///
    /// # Errors
    ///
    /// As [`Urdf::read`]; an error of the file with its place there; an MJCF file with such a file.
    pub fn read_with_loops(file: &str, text: &str, loops: Option<(&str, &str)>) -> Result<Self, Report> {
        let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
        let source = Source::new(file, text);
        if root_name(text).is_some_and(|name| name == "mujoco") {
            if loops.is_some() {
                let help = "a file of closed loops is for a URDF; an MJCF file has its own, in `equality`";
                return Err(source.error(&(0..0), "this is an MJCF file", help));
            }
            return mjcf::read(source);
        }
        let scanned = scan(&source)?;
        let mut urdf = Self {
            name: scanned.robot.text("robot", "name").unwrap_or_default().to_owned(),
            unknown: scanned.unknown.clone(),
            beside: scanned.robot.unknown.clone(),
            ..Self::empty(source)
        };
        urdf.take_links(&scanned.links)?;
        urdf.take_joints(&scanned.joints)?;
        urdf.find_root()?;
        urdf.take_gears(&scanned.couplings)?;
        urdf.take_loops(&scanned.loops)?;
        let transmissions = transmission::read(&urdf.source)?;
        urdf.take_transmissions(transmissions);
        if let Some((name, text)) = loops {
            urdf.extend(name, text)?;
        }
        let source = urdf.source.clone();
        urdf.split_spherical_joints(&source)?;
        Ok(urdf)
    }

    /// The link of a name, or the link that the joint of this name moves.
    pub(crate) fn link_or_moved(&self, name: &str) -> Option<usize> {
        let moved = || self.joints.iter().find(|joint| joint.name == name).map(|joint| joint.child);
        self.links.iter().position(|link| link.name == name).or_else(moved)
    }

    /// A robot without links.
    pub(crate) fn empty(source: Source) -> Self {
        Self {
            source,
            name: String::new(),
            links: Vec::new(),
            joints: Vec::new(),
            gears: Vec::new(),
            loops: Vec::new(),
            root: 0,
            base: 0,
            floats: None,
            gravity: None,
            remarks: Remarks::default(),
            unknown: Vec::new(),
            beside: BTreeSet::new(),
        }
    }

    /// The names of the links that carry no other: where an arm may end.
    #[must_use]
    pub fn leaves(&self) -> Vec<&str> {
        self.links.iter().filter(|link| self.is_end(link)).map(|link| link.name.as_str()).collect()
    }

    /// Whether an arm may end with a link: it carries nothing but marks, and is not a mark itself.
    pub(crate) fn is_end(&self, link: &Link) -> bool {
        let is_mark = |&joint: &usize| self.links[self.joints[joint].child].is_site;
        !link.is_site && link.children.iter().all(is_mark)
    }

    /// The joints from a link to the root.
    pub(crate) fn to_root(&self, link: usize) -> Vec<usize> {
        let parent = |joint: &usize| self.links[self.joints[*joint].parent].parent;
        std::iter::successors(self.links[link].parent, parent).collect()
    }
}

impl Link {
    /// A link without mass and joints.
    pub(crate) fn new(name: String, span: Range<usize>) -> Self {
        Self {
            name,
            span_of_inertia: span.clone(),
            span,
            unknown: BTreeSet::new(),
            mass: 0.0,
            xyz: [0.0; 3],
            rpy: [0.0; 3],
            inertia: Inertia::default(),
            is_site: false,
            parent: None,
            children: Vec::new(),
        }
    }

    /// Whether it has a body of its own.
    pub(crate) fn has_mass(&self) -> bool {
        self.mass != 0.0 || self.inertia != Inertia::default()
    }
}

impl Joint {
    /// A joint without name, limits and friction, between links that are still to be named.
    pub(crate) fn new(kind: Kind, span: Range<usize>) -> Self {
        Self {
            name: String::new(),
            span,
            unknown: BTreeSet::new(),
            has_axis: true,
            crossed: None,
            negative: Vec::new(),
            kind,
            mimic: None,
            parent: 0,
            child: 0,
            xyz: [0.0; 3],
            rpy: [0.0; 3],
            axis: [1.0, 0.0, 0.0],
            limits: Limits::default(),
            friction: [0.0; 2],
            rotor_inertia: 0.0,
            gear_ratio: 1.0,
            reference: 0.0,
            has_motor: None,
        }
    }
}
