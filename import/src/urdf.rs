//! Reads a URDF as a tree of links and joints, in which every number is finite and every name exists. An MJCF file
//! becomes the same kind of tree.

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

/// A robot as a URDF or an MJCF file describes it. [`Urdf::read`] has checked that its links form one tree.
#[derive(Clone, Debug)]
pub struct Urdf {
    pub(crate) source: Source,
    pub(crate) name: String,
    /// The links, in the order of the text.
    pub(crate) links: Vec<Link>,
    /// The joints, in the order of the text.
    pub(crate) joints: Vec<Joint>,
    /// Joints that gears couple to others; only URDF+ has them.
    pub(crate) gears: Vec<Gear>,
    /// The closed loops of the robot.
    pub(crate) loops: Vec<Loop>,
    /// The link that no joint moves.
    pub(crate) root: usize,
    /// The link that is the base of an arm if the caller names none: the root, or the link that floats.
    pub(crate) base: usize,
    /// The link that carries all joints as a floating base: a floating joint of a URDF, or a free joint of an MJCF
    /// file, moves it. This joint has the kind `Fixed` here.
    pub(crate) floats: Option<usize>,
    /// The acceleration of gravity in the axes of the root, m/s², if the file gives it.
    pub(crate) gravity: Option<[f64; 3]>,
    /// Remarks on parts of the file that a robot file cannot express, in sentences.
    pub(crate) remarks: Remarks,
    /// Kinds of unknown elements and attributes, in words.
    pub(crate) unknown: Vec<String>,
    /// Unknown elements outside of links and joints, as indices into `unknown`.
    pub(crate) beside: BTreeSet<usize>,
}

#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub(crate) name: String,
    pub(crate) span: Range<usize>,
    /// The place of the link's inertia in the text.
    pub(crate) span_of_inertia: Range<usize>,
    /// Unknown names in the link, as indices into [`Urdf::unknown`].
    pub(crate) unknown: BTreeSet<usize>,
    /// Mass, kg; 0 where there is no `inertial`.
    pub(crate) mass: f64,
    /// Centre of mass in the link frame, m.
    pub(crate) xyz: [f64; 3],
    /// The orientation of the axes in which the inertia is given, rad.
    pub(crate) rpy: [f64; 3],
    /// The inertia about the centre of mass, in the axes of `rpy`.
    pub(crate) inertia: Inertia,
    /// Whether the link is only a mark on another link, a site of an MJCF file, and so no end of an arm.
    pub(crate) is_site: bool,
    /// The joint that moves the link.
    pub(crate) parent: Option<usize>,
    /// The joints that the link carries.
    pub(crate) children: Vec<usize>,
}

/// Returns the kind of cut joint that a word of a URDF+ means.
pub(crate) fn cut(word: &str) -> Option<Cut> {
    match word {
        "revolute" | "continuous" => Some(Cut::Revolute),
        "spherical" => Some(Cut::Spherical),
        "universal" => Some(Cut::Universal),
        "fixed" => Some(Cut::Weld),
        _ => None,
    }
}

/// A joint that gears couple to others: its position is Σ ratio · q over these joints.
#[derive(Clone, Debug)]
pub(crate) struct Gear {
    /// The place of its tag in the text.
    pub(crate) span: Range<usize>,
    pub(crate) joint: usize,
    /// The joints that it follows, and the ratio of each.
    pub(crate) follows: Vec<(usize, f64)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Revolute,
    /// A revolute joint without position limits.
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

    /// Returns the kind of joint that a word of a URDF means.
    pub(crate) fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == word)
    }

    /// Returns the word of a URDF for this kind of joint.
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

    /// Returns whether one number describes the position of such a joint.
    pub(crate) fn has_one_freedom(self) -> bool {
        matches!(self, Self::Revolute | Self::Continuous | Self::Prismatic)
    }
}

/// How a joint follows another one: q = `multiplier` · q of `joint` + `offset`.
#[derive(Clone, Debug)]
pub(crate) struct Mimic {
    pub(crate) joint: String,
    /// The index of the joint that is followed, if it exists.
    pub(crate) leader: Option<usize>,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}

#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) name: String,
    pub(crate) span: Range<usize>,
    /// Unknown names in the joint, as indices into [`Urdf::unknown`].
    pub(crate) unknown: BTreeSet<usize>,
    /// Whether the file gives the axis; otherwise it is 1 0 0.
    pub(crate) has_axis: bool,
    /// Position limits of which the lower one is above the upper one.
    pub(crate) crossed: Option<(f64, f64)>,
    /// Limits of effort and velocity that are below zero.
    pub(crate) negative: Vec<(&'static str, f64)>,
    pub(crate) kind: Kind,
    pub(crate) mimic: Option<Mimic>,
    /// The link that carries the joint.
    pub(crate) parent: usize,
    /// The link that the joint moves.
    pub(crate) child: usize,
    pub(crate) xyz: [f64; 3],
    pub(crate) rpy: [f64; 3],
    /// The axis as the file has it, not scaled to length 1.
    pub(crate) axis: [f64; 3],
    pub(crate) limits: Limits,
    /// Viscous and Coulomb friction at the joint, N m s/rad and N m, or N s/m and N.
    pub(crate) friction: [f64; 2],
    /// Inertia of the rotor about its own axis, kg m², or its mass, kg.
    pub(crate) rotor_inertia: f64,
    /// Gear ratio: motor angle per joint angle.
    pub(crate) gear_ratio: f64,
    /// The joint position at which the links are placed as in the file, rad or m: `ref` of an MJCF file.
    pub(crate) reference: f64,
    /// Whether the joint has a motor, if the file says it.
    pub(crate) has_motor: Option<bool>,
}

impl Urdf {
    /// Reads the text of a URDF, or of an MJCF file, whose root element is `mujoco`. `file` is the path of the file,
    /// which messages name; files that an MJCF file includes are read from its folder. The robot file keeps only the
    /// name without folders. Closed loops of a URDF are read from the file beside it, `robot.yaml` for `robot.urdf`, if
    /// that has the key `closed_loop`, as those of Gepetto/example-parallel-robots have.
    ///
    /// # Errors
    ///
    /// An error with its place in the text: not XML, a document type, more than 16 MiB, a value that is no finite
    /// number, a name that is there twice or does not exist, links that are not one tree.
    pub fn read(file: &str, text: &str) -> Result<Self, Report> {
        let loops = crate::extended_urdf::beside(file);
        Self::read_with_loops(file, text, loops.as_ref().map(|(name, text)| (name.as_str(), text.as_str())))
    }

    /// Does the same as [`Urdf::read`], but reads the closed loops from `loops`, the name and the text of a file, and
    /// not from the file beside the URDF.
    ///
    /// # Errors
    ///
    /// As [`Urdf::read`]; an error in the file of loops, with its place there; an MJCF file together with such a file.
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

    /// Returns the link with a name, or else the link that the joint with this name moves.
    pub(crate) fn link_or_moved(&self, name: &str) -> Option<usize> {
        let moved = || self.joints.iter().find(|joint| joint.name == name).map(|joint| joint.child);
        self.links.iter().position(|link| link.name == name).or_else(moved)
    }

    /// Makes a robot without links.
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

    /// Returns the names of the end links, which carry no other link: an arm may end at each of them.
    #[must_use]
    pub fn leaves(&self) -> Vec<&str> {
        self.links.iter().filter(|link| self.is_end(link)).map(|link| link.name.as_str()).collect()
    }

    /// Returns whether an arm may end at a link: it carries only marks, and is no mark itself.
    pub(crate) fn is_end(&self, link: &Link) -> bool {
        let is_mark = |&joint: &usize| self.links[self.joints[joint].child].is_site;
        !link.is_site && link.children.iter().all(is_mark)
    }

    /// Returns the joints from a link to the root.
    pub(crate) fn to_root(&self, link: usize) -> Vec<usize> {
        let parent = |joint: &usize| self.links[self.joints[*joint].parent].parent;
        std::iter::successors(self.links[link].parent, parent).collect()
    }
}

impl Link {
    /// Makes a link without mass and joints.
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

    /// Returns whether the link has mass or inertia.
    pub(crate) fn has_mass(&self) -> bool {
        self.mass != 0.0 || self.inertia != Inertia::default()
    }
}

impl Joint {
    /// Makes a joint without name, limits and friction, whose links are set later.
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
