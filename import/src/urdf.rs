//! A URDF as a tree of links and joints, whose every number is finite and whose every name is known. An MJCF file
//! becomes the same tree.

use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

use rne_model::{Cut, Inertia, Limits, Report};

use crate::closed_loop::Loop;
use crate::mjcf;
use crate::remark::Remarks;
use crate::scan::{Seen, end_of_range, root_name, scan};
use crate::source::{Source, names, quoted};
use crate::transmission::{self, Transmission};

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

    fn take_links(&mut self, links: &[Seen]) -> Result<(), Report> {
        let mut known = HashMap::new();
        for seen in links {
            let span = &seen.span;
            let name = seen.text("link", "name").unwrap_or_default();
            if let Some(first) = known.insert(name, span) {
                let message = format!("the link {} is already defined in line {}", quoted(name), self.line(first));
                return Err(self.source.error(span, message, "names of links must differ"));
            }
            let is_there = |part: &str| !seen.elements.contains_key("inertial") || seen.elements.contains_key(part);
            if let Some(part) = ["mass", "inertia"].into_iter().find(|part| !is_there(part)) {
                let message = format!("the `inertial` of the link {} has no element `{part}`", quoted(name));
                let help = "write both `mass` and `inertia`, or leave `inertial` out: the link has no mass then";
                return Err(self.source.error(span, message, help));
            }
            let mass = seen.number("mass", "value").unwrap_or(0.0);
            if mass < 0.0 {
                let message = format!("the mass of the link {} is {mass} kg", quoted(name));
                return Err(self.source.error(span, message, "a mass is zero or positive"));
            }
            let inertia = |attribute| seen.number("inertia", attribute).unwrap_or(0.0);
            self.links.push(Link {
                unknown: seen.unknown.clone(),
                mass,
                xyz: seen.vector("origin", "xyz").unwrap_or_default(),
                rpy: seen.vector("origin", "rpy").unwrap_or_default(),
                inertia: Inertia {
                    xx: inertia("ixx"),
                    yy: inertia("iyy"),
                    zz: inertia("izz"),
                    xy: inertia("ixy"),
                    xz: inertia("ixz"),
                    yz: inertia("iyz"),
                },
                span_of_inertia: seen.elements.get("inertia").unwrap_or(span).clone(),
                ..Link::new(name.to_owned(), span.clone())
            });
        }
        Ok(())
    }

    fn take_joints(&mut self, joints: &[Seen]) -> Result<(), Report> {
        let links: HashMap<String, usize> =
            self.links.iter().enumerate().map(|(index, link)| (link.name.clone(), index)).collect();
        let mut known = HashMap::new();
        for (index, seen) in joints.iter().enumerate() {
            let span = &seen.span;
            let name = seen.text("joint", "name").unwrap_or_default();
            if let Some(first) = known.insert(name, span) {
                let message = format!("the joint {} is already defined in line {}", quoted(name), self.line(first));
                return Err(self.source.error(span, message, "names of joints must differ"));
            }
            let link = |end: &'static str| {
                let Some(link) = seen.text(end, "link") else {
                    let message = format!("the joint {} has no element `{end}`", quoted(name));
                    return Err(self.source.error(
                        span,
                        message,
                        format!("write <{end} link=\"NAME\"/> into the joint"),
                    ));
                };
                links.get(link).copied().ok_or_else(|| {
                    let message =
                        format!("the joint {} refers to the link {}, which does not exist", quoted(name), quoted(link));
                    self.source.error(span, message, "there is no such link in the file")
                })
            };
            let (parent, child) = (link("parent")?, link("child")?);
            if let Some(first) = self.links[child].parent {
                let message = format!(
                    "the link {} is moved by two joints, {} and {}",
                    quoted(&self.links[child].name),
                    quoted(&self.joints[first].name),
                    quoted(name)
                );
                return Err(self.source.error(span, message, "a URDF is a tree and cannot describe closed loops"));
            }
            self.links[child].parent = Some(index);
            self.links[parent].children.push(index);
            self.joints.push(Joint::of(seen, parent, child));
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
            const CONNECT: &str = "connect all links with joints to one tree";
            let (place, message, help) = match roots.get(1) {
                Some(&second) => {
                    let roots = names(roots.iter().map(|&root| &self.links[root].name));
                    (
                        self.links[second].span.clone(),
                        format!("the URDF has several root links, because no joint moves the links {roots}"),
                        CONNECT,
                    )
                }
                None if self.links.is_empty() => {
                    let help = "add an element <link> for each body, and an element <joint> between two links";
                    (0..0, "the robot has no link".to_owned(), help)
                }
                None => {
                    let message = "the joints form a circle, so no link is the root".to_owned();
                    (self.joints[0].span.clone(), message, CONNECT)
                }
            };
            return Err(self.source.error(&place, message, help));
        };
        let mut reached = vec![false; self.links.len()];
        let mut open = vec![root];
        while let Some(link) = open.pop() {
            reached[link] = true;
            open.extend(self.links[link].children.iter().map(|&joint| self.joints[joint].child));
        }
        if let Some(lost) = reached.iter().position(|reached| !reached) {
            let message = format!("the link {} is part of a circle of joints", quoted(&self.links[lost].name));
            return Err(self.source.error(
                &self.links[lost].span,
                message,
                "connect all links with joints to one tree",
            ));
        }
        self.root = root;
        // links with mass are bodies of their own, and no world
        let is_world = |link: usize| !self.links[link].has_mass();
        let is_placed = |&joint: &usize| self.joints[joint].kind == Kind::Fixed && is_world(self.joints[joint].parent);
        let floating = |joint: &&Joint| {
            joint.kind == Kind::Floating && is_world(joint.parent) && self.to_root(joint.parent).iter().all(is_placed)
        };
        let floating: Vec<usize> = self.joints.iter().filter(floating).map(|joint| joint.child).collect();
        self.find_floating(&floating);
        if let Some(joint) = self.floats.and_then(|link| self.links[link].parent) {
            self.joints[joint].kind = Kind::Fixed;
        }
        Ok(())
    }

    /// The elements `coupling` of URDF+ (arXiv 2411.19753): from the link that carries both ends, the positions of the
    /// joints to the successor add up to those of the joints to the predecessor times the ratio.
    fn take_gears(&mut self, couplings: &[Seen]) -> Result<(), Report> {
        for seen in couplings {
            let error = |message: String, help: &str| Err(self.source.error(&seen.span, message, help));
            let mut ends = [0; 2];
            for (end, of) in ends.iter_mut().zip(["predecessor", "successor"]) {
                let Some(link) = seen.text(of, "link") else {
                    return error(
                        format!("the coupling has no element `{of}`"),
                        "write the link into it: <predecessor \
                        link=\"NAME\"/> <successor link=\"NAME\"/> <ratio value=\"NUMBER\"/>",
                    );
                };
                let Some(known) = self.links.iter().position(|known| known.name == link) else {
                    let message = format!("the coupling refers to the link {}, which does not exist", quoted(link));
                    return error(message, "there is no such link in the file");
                };
                *end = known;
            }
            let ratio = seen.number("ratio", "value").filter(|ratio| *ratio != 0.0);
            let Some(ratio) = ratio else {
                return error("the coupling has no ratio other than zero".to_owned(), "write <ratio value=\"6\"/>");
            };
            let [to_predecessor, to_successor] = ends.map(|link| self.to_root(link));
            let moves = |joint: &usize| self.joints[*joint].kind.has_one_freedom();
            let apart = |of: &[usize], other: &[usize]| -> Vec<usize> {
                of.iter().copied().filter(|joint| moves(joint) && !other.contains(joint)).collect()
            };
            let predecessors = apart(&to_predecessor, &to_successor).into_iter();
            let mut successors = apart(&to_successor, &to_predecessor).into_iter();
            let Some(joint) = successors.next() else {
                let message = "no joint moves the successor of the coupling against its predecessor".to_owned();
                return error(message, "the successor is the link that follows, such as the rotor of a motor");
            };
            let follows =
                predecessors.map(|joint| (joint, ratio)).chain(successors.map(|joint| (joint, -1.0))).collect();
            self.gears.push(Gear { span: seen.span.clone(), joint, follows });
        }
        Ok(())
    }

    /// Gives joints the gears and rotors of their transmissions.
    fn take_transmissions(&mut self, transmissions: Vec<Transmission>) {
        let mut known = BTreeSet::new();
        for Transmission { name, joints, actuators, ratio, rotor_inertia } in transmissions {
            let (ratio, rotor_inertia) = (ratio.unwrap_or(1.0), rotor_inertia.unwrap_or(0.0));
            if [ratio, rotor_inertia] == [1.0, 0.0] {
                continue;
            }
            let joint = match (&joints[..], actuators) {
                ([joint], 0 | 1) => self.joints.iter().position(|known| known.name == *joint),
                _ => None,
            };
            let movable = joint.filter(|&joint| self.joints[joint].kind.has_one_freedom() && known.insert(joint));
            let Some(joint) = movable else {
                self.remarks.push(format!(
                    "the transmission {} is left out: rne takes one of a motor and a joint that moves",
                    quoted(&name)
                ));
                continue;
            };
            (self.joints[joint].gear_ratio, self.joints[joint].rotor_inertia) = (ratio, rotor_inertia);
        }
    }

    /// The joints from a link to the root.
    pub(crate) fn to_root(&self, link: usize) -> Vec<usize> {
        let parent = |joint: &usize| self.links[self.joints[*joint].parent].parent;
        std::iter::successors(self.links[link].parent, parent).collect()
    }

    /// The line, from 1, in which a place of the text begins.
    fn line(&self, span: &Range<usize>) -> usize {
        1 + self.source.text.as_bytes().iter().take(span.start).filter(|&&byte| byte == b'\n').count()
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

    /// A joint between two links, as its elements say.
    fn of(seen: &Seen, parent: usize, child: usize) -> Self {
        let kind = seen.text("joint", "type").and_then(Kind::of).unwrap_or(Kind::Fixed);
        let number = |element, attribute| seen.number(element, attribute).unwrap_or(0.0);
        let limit = |attribute| end_of_range(number("limit", attribute));
        let (lower, upper) = (limit("lower"), limit("upper"));
        let both = lower.is_finite() && upper.is_finite() && lower < upper;
        // zero stands where nothing was measured
        let positive = |limit: f64| (limit > 0.0 && limit.is_finite()).then_some(limit);
        let mimic = seen.text("mimic", "joint").map(|joint| Mimic {
            joint: joint.to_owned(),
            leader: None,
            multiplier: seen.number("mimic", "multiplier").unwrap_or(1.0),
            offset: number("mimic", "offset"),
        });
        Self {
            name: seen.text("joint", "name").unwrap_or_default().to_owned(),
            unknown: seen.unknown.clone(),
            has_axis: seen.elements.contains_key("axis"),
            negative: ["effort", "velocity"]
                .into_iter()
                .map(|limit| (limit, number("limit", limit)))
                .filter(|(_, value)| *value < 0.0)
                .collect(),
            crossed: (lower > upper && kind != Kind::Continuous).then_some((lower, upper)),
            mimic,
            parent,
            child,
            xyz: seen.vector("origin", "xyz").unwrap_or_default(),
            rpy: seen.vector("origin", "rpy").unwrap_or_default(),
            axis: seen.vector("axis", "xyz").unwrap_or([1.0, 0.0, 0.0]),
            limits: Limits {
                position: (both && kind != Kind::Continuous).then_some((lower, upper)),
                velocity: positive(limit("velocity")),
                effort: positive(limit("effort")),
            },
            friction: [number("dynamics", "damping"), number("dynamics", "friction")],
            has_motor: seen.text("joint", "independent").map(|word| word == "true"),
            ..Self::new(kind, seen.span.clone())
        }
    }
}
