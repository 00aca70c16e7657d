//! Turns the elements of a URDF into links and joints, and checks that they are one tree.

use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

use rne_model::{Inertia, Limits, Report};

use super::{Gear, Joint, Kind, Link, Mimic, Urdf};
use crate::source::{Help, names, quoted};
use crate::transmission::Transmission;
use crate::urdf::xml::{Seen, end_of_range};

/// The help for links that are not one tree.
const CONNECT: &str = "connect all links with joints to one tree";

impl Urdf {
    pub(super) fn take_links(&mut self, links: &[Seen]) -> Result<(), Report> {
        let mut known = HashMap::new();
        for seen in links {
            let span = &seen.span;
            let name = seen.text("link", "name").unwrap_or_default();
            if let Some(first) = known.insert(name, span) {
                return Err(self.taken("link", name, first, span));
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

    pub(super) fn take_joints(&mut self, joints: &[Seen]) -> Result<(), Report> {
        let links = by_name(self.links.iter().map(|link| &link.name));
        let mut known = HashMap::new();
        for (index, seen) in joints.iter().enumerate() {
            let span = &seen.span;
            let name = seen.text("joint", "name").unwrap_or_default();
            if let Some(first) = known.insert(name, span) {
                return Err(self.taken("joint", name, first, span));
            }
            let link = |end: &'static str| {
                let help = format!("write <{end} link=\"NAME\"/> into the joint");
                self.named_link(seen, end, &format!("the joint {}", quoted(name)), help, |link| {
                    links.get(link).copied()
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
        let known = by_name(self.joints.iter().map(|joint| &joint.name));
        for mimic in self.joints.iter_mut().filter_map(|joint| joint.mimic.as_mut()) {
            mimic.leader = known.get(&mimic.joint).copied();
        }
        Ok(())
    }

    /// Makes the error for a second element `what` with the same name; `first` is the place of the first one.
    fn taken(&self, what: &str, name: &str, first: &Range<usize>, span: &Range<usize>) -> Report {
        // line numbers begin with 1
        let line = 1 + self.source.text.as_bytes().iter().take(first.start).filter(|&&byte| byte == b'\n').count();
        let message = format!("the {what} {} is already defined in line {line}", quoted(name));
        self.source.error(span, message, format!("names of {what}s must differ"))
    }

    /// Returns the link that the element `end` of `owner` names; `find` looks it up, `help` says how to write the
    /// element.
    pub(crate) fn named_link(
        &self,
        seen: &Seen,
        end: &'static str,
        owner: &str,
        help: impl Into<Help>,
        find: impl Fn(&str) -> Option<usize>,
    ) -> Result<usize, Report> {
        let Some(link) = seen.text(end, "link") else {
            return Err(self.source.error(&seen.span, format!("{owner} has no element `{end}`"), help));
        };
        find(link).ok_or_else(|| {
            let message = format!("{owner} refers to the link {}, which does not exist", quoted(link));
            self.source.error(&seen.span, message, "there is no such link in the file")
        })
    }

    /// Finds the only link that no joint moves. Refuses joints that form a circle, which cannot be reached from there.
    pub(super) fn find_root(&mut self) -> Result<(), Report> {
        let roots: Vec<usize> = (0..self.links.len()).filter(|&link| self.links[link].parent.is_none()).collect();
        let [root] = roots[..] else {
            let (place, message, help) = match roots.get(1) {
                Some(&second) => {
                    let roots = names(roots.iter().map(|&root| &self.links[root].name));
                    let message = format!("the URDF has several root links, because no joint moves the links {roots}");
                    (&self.links[second].span, message, CONNECT)
                }
                None if self.links.is_empty() => {
                    let help = "add an element <link> for each body, and an element <joint> between two links";
                    (&(0..0), "the robot has no link".to_owned(), help)
                }
                None => {
                    let message = "the joints form a circle, so no link is the root".to_owned();
                    (&self.joints[0].span, message, CONNECT)
                }
            };
            return Err(self.source.error(place, message, help));
        };
        let mut reached = vec![false; self.links.len()];
        let mut open = vec![root];
        while let Some(link) = open.pop() {
            reached[link] = true;
            open.extend(self.links[link].children.iter().map(|&joint| self.joints[joint].child));
        }
        if let Some(lost) = reached.iter().position(|reached| !reached) {
            let message = format!("the link {} is part of a circle of joints", quoted(&self.links[lost].name));
            return Err(self.source.error(&self.links[lost].span, message, CONNECT));
        }
        self.root = root;
        // a link with mass is a body of its own and not the world
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

    /// Reads the elements `coupling` of URDF+ (arXiv 2411.19753). Counted from the link that carries both ends, the sum
    /// of the positions of the joints to the successor is the ratio times the sum for the joints to the predecessor.
    pub(super) fn take_gears(&mut self, couplings: &[Seen]) -> Result<(), Report> {
        for seen in couplings {
            let error = |message: String, help: &str| Err(self.source.error(&seen.span, message, help));
            let mut ends = [0; 2];
            for (end, of) in ends.iter_mut().zip(["predecessor", "successor"]) {
                let help = "write the link into it: <predecessor link=\"NAME\"/> <successor link=\"NAME\"/> <ratio \
                            value=\"NUMBER\"/>";
                let find = |name: &str| self.links.iter().position(|link| link.name == name);
                *end = self.named_link(seen, of, "the coupling", help, find)?;
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
    pub(super) fn take_transmissions(&mut self, transmissions: Vec<Transmission>) {
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
}

impl Joint {
    /// Makes a joint between two links from its elements.
    fn of(seen: &Seen, parent: usize, child: usize) -> Self {
        let kind = seen.text("joint", "type").and_then(Kind::of).unwrap_or(Kind::Fixed);
        let number = |element, attribute| seen.number(element, attribute).unwrap_or(0.0);
        let limit = |attribute| end_of_range(number("limit", attribute));
        let (lower, upper) = (limit("lower"), limit("upper"));
        let both = lower.is_finite() && upper.is_finite() && lower < upper;
        // files have a limit of 0 where none is known
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

/// Returns a map from names to indices.
fn by_name<'a>(names: impl Iterator<Item = &'a String>) -> HashMap<String, usize> {
    names.enumerate().map(|(index, name)| (name.clone(), index)).collect()
}
