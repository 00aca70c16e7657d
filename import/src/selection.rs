//! Finds in the tree of links what selects a chain: its base, its tip, and the joints that are locked.

use std::collections::HashMap;

use rne_model::{LARGEST_ANGLE, Remedy, Report, did_you_mean};

use crate::source::{names, quoted};
use crate::urdf::xml::LARGEST;
use crate::urdf::{Joint, Kind, Urdf};

/// Largest number of end links that a message lists when the caller must name the tip.
const LISTED: usize = 60;

/// The chain that is taken out of a tree.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// The fixed link at the base [default: the root].
    pub base: Option<String>,
    /// The link at the end of the arm; needed where the tree has several end links.
    pub tip: Option<String>,
    /// Movable joints that are locked, each with its position, rad or m. The joint that lets the base float can be
    /// locked at 0, which fixes the base.
    pub lock: Vec<(String, f64)>,
    /// Whether all other movable joints outside the chain are locked at zero.
    pub lock_others: bool,
    /// Whether all movable joints after the base are taken: the robot is a tree, and `tip` only says where its tip
    /// frame is.
    pub whole: bool,
    /// Whether a whole robot has a floating base: the root link, or the link that floats in the file [default: if a
    /// link floats in the file].
    pub floating: Option<bool>,
}

impl Urdf {
    /// Checks that every link and every joint that a selection names exists.
    ///
    /// # Errors
    ///
    /// The first name that does not exist, with the one that was probably meant and all that exist.
    pub fn check_names(&self, selection: &Selection) -> Result<(), Report> {
        selection.base.as_ref().map_or(Ok(0), |name| link(self, name, "base"))?;
        selection.tip.as_ref().map_or(Ok(0), |name| link(self, name, "tip"))?;
        selection.lock.iter().try_for_each(|(name, _)| joint(self, name).map(|_| ()))
    }
}

impl Selection {
    /// Returns whether the robot has a floating base.
    pub(crate) fn floats(&self, urdf: &Urdf, base: usize) -> Result<bool, Report> {
        let mut locked = self.lock.iter().filter_map(|(name, _)| urdf.joints.iter().find(|joint| joint.name == *name));
        let is_free = urdf.floats.is_some_and(|link| locked.all(|joint| joint.child != link));
        if self.floating == Some(true) && urdf.floats.is_some() && !is_free {
            let message = "the base is to float, and the joint that lets it float is locked";
            return Err(urdf.source.error(&urdf.links[base].span, message, None));
        }
        let floats = self.floating.unwrap_or(self.whole && is_free && urdf.floats == Some(base));
        let may_float = self.whole && (base == urdf.root || urdf.floats == Some(base));
        if floats && !may_float {
            let message = "a floating base is the root link of a whole robot, or the link that floats in the file";
            let help = if self.whole { Some("name no other base".to_owned()) } else { None };
            let report = urdf.source.error(&urdf.links[base].span, message, help);
            return Err(if self.whole { report } else { report.with_remedy(&Remedy::Whole) });
        }
        Ok(floats)
    }
}

impl Urdf {
    /// Chooses the base of a floating robot: among links that a free joint moves, the one that carries all other
    /// joints.
    pub(crate) fn find_floating(&mut self, floating: &[usize]) {
        let carried = |link: usize| {
            let (mut joints, mut open) = (0, vec![link]);
            while let Some(link) = open.pop() {
                let below = self.links[link].children.iter().map(|&joint| &self.joints[joint]);
                joints += below.clone().filter(|joint| joint.kind.has_one_freedom()).count();
                open.extend(below.map(|joint| joint.child));
            }
            joints
        };
        let all = carried(self.root);
        self.floats = floating.iter().copied().find(|&link| all > 0 && carried(link) == all);
        self.base = self.floats.unwrap_or(self.root);
    }
}

pub(crate) fn link(urdf: &Urdf, name: &str, what: &str) -> Result<usize, Report> {
    urdf.links.iter().position(|link| link.name == name).ok_or_else(|| {
        let message = format!("there is no link {} that could be the {what}", quoted(name));
        let known = if what == "tip" {
            let leaves = leaves(urdf, urdf.root);
            format!("the tip can be any link; these links carry no other link:\n{}", listed(urdf, &leaves))
        } else {
            format!("the links are {}", names(urdf.links.iter().map(|link| &link.name)))
        };
        let help = meant(name, urdf.links.iter().map(|link| link.name.as_str())) + &known;
        urdf.source.error(&(0..0), message, help)
    })
}

/// Finds a joint that is to be locked.
fn joint(urdf: &Urdf, name: &str) -> Result<usize, Report> {
    urdf.joints.iter().position(|joint| joint.name == name).ok_or_else(|| {
        let movable = urdf.joints.iter().filter(|joint| joint.kind != Kind::Fixed);
        let movable: Vec<&str> = movable.map(|joint| joint.name.as_str()).collect();
        let message = format!("there is no joint {}, so it cannot be locked", quoted(name));
        let known = format!("the movable joints are {}", names(&movable));
        urdf.source.error(&(0..0), message, meant(name, movable) + &known)
    })
}

/// Returns the question "did you mean": with the name that is a slip away, or else with the only name that contains the
/// word, as `panda_hand` contains `hand`.
fn meant<'n>(word: &str, known: impl IntoIterator<Item = &'n str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    let lower = word.to_lowercase();
    let mut longer = known.iter().filter(|name| !lower.is_empty() && name.to_lowercase().contains(&lower));
    let only = longer.next().copied().filter(|_| longer.next().is_none());
    let meant = did_you_mean(word, known.iter().copied()).or(only);
    meant.map_or_else(String::new, |meant| format!("did you mean {}? ", quoted(meant)))
}

/// Lists end links, one per line, each with the number of joints before it.
fn listed(urdf: &Urdf, leaves: &[(usize, usize)]) -> String {
    let listed = leaves.iter().map(|&(leaf, joints)| {
        let joints = if joints == 1 { "1 joint".to_owned() } else { format!("{joints} joints") };
        format!("  {} ({joints})", quoted(&urdf.links[leaf].name))
    });
    let more = leaves.len().saturating_sub(LISTED);
    let more = if more > 0 { format!("\n  and {more} more") } else { String::new() };
    listed.take(LISTED).collect::<Vec<_>>().join("\n") + &more
}

/// Words that names of tips contain, the most certain one last.
const OF_TIPS: [&str; 8] = ["foot", "hand", "flange", "end_effector", "endeffector", "ee", "tool", "tcp"];

/// Returns how probable it is that an end link is the tip, by its name. `tool0` is the tip by convention (ROS REP 199,
/// and ROS-Industrial before it), as is `tip`, the name that `rne export` writes; then come names with a word for tips,
/// `tcp` (tool centre point) first. `ee` and `hand` must be at the end of the name, apart from `_link`, because other
/// words and names of fingers contain them. A link that a follower moves, such as the second finger of a gripper, is
/// less probable than others; least probable are links that are only drawn (`visual`) or are rotors of motors.
fn rank(urdf: &Urdf, base: usize, leaf: usize) -> usize {
    const OTHER: usize = 2;
    let name = urdf.links[leaf].name.to_lowercase();
    let name = name.trim_end_matches("_link").trim_end_matches("_frame");
    let follows = last_movable(urdf, base, leaf).is_some_and(|joint| urdf.joints[joint].mimic.is_some());
    let has = |word: &&str| match *word {
        "ee" | "hand" => {
            name.strip_suffix(word).is_some_and(|before| before.is_empty() || before.ends_with(['_', '-']))
        }
        word => name.contains(word),
    };
    if name.contains("visual") || name.contains("rotor") {
        0
    } else if follows {
        1
    } else if name == "tool0" || name == "tip" {
        OTHER + OF_TIPS.len() + 1
    } else {
        OTHER + OF_TIPS.iter().rposition(has).map_or(0, |place| place + 1)
    }
}

/// The end of a chain.
pub(crate) struct End {
    pub(crate) link: usize,
    /// Other end links after the same movable joint, if the end was chosen among several.
    pub(crate) others: Vec<usize>,
}

/// Returns the link at which the chain ends.
pub(crate) fn tip(urdf: &Urdf, base: usize, selection: &Selection) -> Result<End, Report> {
    let alone = |link| End { link, others: Vec::new() };
    if let Some(name) = &selection.tip {
        return link(urdf, name, "tip").map(alone);
    }
    let leaves = leaves(urdf, base);
    if let [(leaf, _)] = leaves[..] {
        return Ok(alone(leaf));
    }
    // end links that no movable joint moves are sensors or marks on the base
    let moved: Vec<usize> = leaves.iter().filter(|(_, joints)| *joints > 0).map(|(leaf, _)| *leaf).collect();
    // among equally probable end links, those whose last joint moves no further joint come first
    let is_outermost = |leaf: usize, leaves: &[usize]| {
        let Some(joint) = last_movable(urdf, base, leaf) else { return false };
        leaves.iter().all(|&other| last_movable(urdf, base, other) == Some(joint) || !is_beyond(urdf, joint, other))
    };
    let end = |mut others: Vec<usize>| {
        let likeliest =
            (0..others.len()).max_by_key(|&at| (rank(urdf, base, others[at]), is_outermost(others[at], &others)));
        let link = others.remove(likeliest.unwrap_or(others.len() - 1));
        Ok(End { link, others })
    };
    if selection.whole {
        return end(if moved.is_empty() { leaves.iter().map(|(leaf, _)| *leaf).collect() } else { moved });
    }
    let last_joint = |leaf: &usize| last_movable(urdf, base, *leaf);
    if let Some(first) = moved.first()
        && moved.iter().all(|leaf| last_joint(leaf) == last_joint(first))
    {
        return end(moved);
    }
    let message =
        format!("{} has {} end links, so you must name the tip", quoted(&urdf.links[base].name), leaves.len());
    let help = format!("the tip is one of these links, or a link before it:\n{}", listed(urdf, &leaves));
    Err(urdf.source.error_with(&urdf.links[base].span, message, help, &Remedy::NameTip))
}

/// Returns whether a joint moves a link.
fn is_beyond(urdf: &Urdf, joint: usize, mut link: usize) -> bool {
    while let Some(parent) = urdf.links[link].parent {
        if parent == joint {
            return true;
        }
        link = urdf.joints[parent].parent;
    }
    false
}

/// Returns the last movable joint before a link.
fn last_movable(urdf: &Urdf, base: usize, mut link: usize) -> Option<usize> {
    while link != base {
        let joint = urdf.links[link].parent?;
        if urdf.joints[joint].kind.has_one_freedom() {
            return Some(joint);
        }
        link = urdf.joints[joint].parent;
    }
    None
}

/// Returns the end links after `base`, each with the number of movable joints between them.
fn leaves(urdf: &Urdf, base: usize) -> Vec<(usize, usize)> {
    let mut leaves = Vec::new();
    let mut open = vec![(base, 0)];
    while let Some((link, joints)) = open.pop() {
        let children = &urdf.links[link].children;
        if urdf.is_end(&urdf.links[link]) {
            leaves.push((link, joints));
        }
        let below = |&joint: &usize| {
            let joint = &urdf.joints[joint];
            (joint.child, joints + usize::from(joint.kind.has_one_freedom()))
        };
        open.extend(children.iter().rev().map(below));
    }
    leaves
}

/// Returns the joints from `base` to `tip`.
pub(crate) fn path(urdf: &Urdf, base: usize, tip: usize) -> Result<Vec<usize>, Report> {
    let mut path = Vec::new();
    let mut link = tip;
    while link != base {
        let Some(joint) = urdf.links[link].parent else {
            let message = format!(
                "the link {} does not lead to {}: it is attached to {}",
                quoted(&urdf.links[base].name),
                quoted(&urdf.links[tip].name),
                quoted(&urdf.links[link].name)
            );
            let help = "the base must be between the root and the tip";
            return Err(urdf.source.error(&urdf.links[tip].span, message, help));
        };
        path.push(joint);
        link = urdf.joints[joint].parent;
    }
    path.reverse();
    Ok(path)
}

/// Returns the joints that the selection locks by name, with their positions.
pub(crate) fn locks(urdf: &Urdf, selection: &Selection) -> Result<HashMap<usize, f64>, Report> {
    let mut locks = HashMap::new();
    for (place, (name, value)) in selection.lock.iter().enumerate() {
        let index = joint(urdf, name)?;
        let joint = &urdf.joints[index];
        if selection.lock[..place].iter().any(|(earlier, _)| earlier == name) {
            let message = format!("the joint {} is locked twice", quoted(name));
            return Err(urdf.source.error(&joint.span, message, "lock it once, at one value"));
        }
        if urdf.floats == Some(joint.child) {
            if *value != 0.0 {
                let message = format!("the joint {} floats, and can be locked at 0 only", quoted(name));
                let help = "0 fixes the base where the file has it";
                return Err(urdf.source.error(&joint.span, message, help));
            }
            continue;
        }
        if joint.kind == Kind::Fixed || !joint.kind.has_one_freedom() && *value != 0.0 {
            let message =
                format!("the joint {} is {} and cannot be locked at a value", quoted(name), joint.kind.name());
            let help = "a joint with more than one freedom can be locked at 0".to_owned();
            return Err(urdf.source.error(&joint.span, message, Some(help).filter(|_| joint.kind != Kind::Fixed)));
        }
        refuse_value(urdf, joint, *value)?;
        locks.insert(index, *value);
    }
    Ok(locks)
}

/// Refuses a value that cannot be a position of a joint.
pub(crate) fn refuse_value(urdf: &Urdf, joint: &Joint, value: f64) -> Result<(), Report> {
    let is_angle = joint.kind != Kind::Prismatic;
    let is_position = if is_angle { value.abs() < LARGEST_ANGLE } else { value.abs() <= LARGEST };
    if is_position {
        return Ok(());
    }
    let message = format!("the joint {} cannot be locked at {value}", quoted(&joint.name));
    let help = if is_angle {
        format!("an angle is a number below {LARGEST_ANGLE} rad")
    } else {
        format!("a displacement is a number of at most {LARGEST:e} m")
    };
    Err(urdf.source.error(&joint.span, message, help))
}
