//! Compares the left and the right side of a robot: warns where two links are mirror images by the names of their
//! joints, but have different masses or inertias.
//!
//! Mirror images have the same mass and the same principal moments of inertia, in whatever axes a tensor is written.
//! Only these are compared, because they do not depend on the frames of the table.

use std::collections::BTreeMap;

use crate::parts::inertia::principal_moments;
use crate::robot::parent;
use crate::text::decode::Context;
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::text::expression::Names as _;
use crate::text::source::{quoted, six_digits};
use crate::{Joint, Link};

/// Relative difference above which the numbers of two links are not those of mirror images. CAD programs give numbers
/// that differ by up to 0.3 %, as in the wrists of Romeo; known mistakes begin at 25 %, as in the legs of Atlas and the
/// iCub.
const ALIKE: f64 = 0.01;

/// Names with more bytes are not searched for the word of a side.
const LONGEST_NAME: usize = 100;

/// Largest number of further pairs of links that a message names after the first pair.
const NAMED: usize = 3;

/// The words for the two sides.
const SIDES: [[&str; 2]; 5] = [["left", "right"], ["Left", "Right"], ["LEFT", "RIGHT"], ["l", "r"], ["L", "R"]];

/// Reports links of the two sides whose masses or principal moments of inertia differ.
pub(crate) fn twins(cx: &Context, root: &Node, joints: &[Joint]) {
    let items = root.list("joints");
    cx.count(joints.len() * joints.len());
    let mut differing = pairs(joints).into_iter().filter_map(|pair| Some((pair, difference(joints, pair)?)));
    let Some(([one, other], Difference { key, what })) = differing.next() else { return };
    let names = |[one, other]: [usize; 2]| format!("{} and {}", quoted(&joints[one].name), quoted(&joints[other].name));
    let others: Vec<String> = differing.map(|(pair, _)| names(pair)).collect();
    let more = match others.len() {
        0 => String::new(),
        1..=NAMED => format!("; so do the links of {}", others.join(", of ")),
        count => {
            format!("; so do the links of {} and {} other pairs", others[..NAMED].join(", of "), count - NAMED)
        }
    };
    let message = format!("by their names the links of {} are mirror images, but {what}{more}", names([one, other]));
    let link = items.get(other).map_or(root, |item| item.get("link").unwrap_or(item));
    let place = link.get(key).unwrap_or(link).head();
    cx.report(Diagnostic::lint(place, message).label("differs from the other side").help(
        "the links of both sides have the same mass and the same principal moments of inertia; compare both links with \
         the source of the numbers; if the sides really differ, ignore this",
    ));
}

/// A difference between two links that should be mirror images.
struct Difference {
    /// The key of the robot file under which the differing numbers are.
    key: &'static str,
    what: String,
}

fn difference(joints: &[Joint], [one, other]: [usize; 2]) -> Option<Difference> {
    let [one, other] = [one, other].map(|joint| &joints[joint].row.link);
    if [one, other].iter().any(|link| link.has_first_moment()) {
        return None;
    }
    let differs = |a: f64, b: f64, scale: f64| (a - b).abs() > ALIKE * scale;
    if differs(one.mass, other.mass, one.mass.max(other.mass)) {
        let what = format!("their masses are {} and {} kg", six_digits(one.mass), six_digits(other.mass));
        return Some(Difference { key: "mass", what });
    }
    let moments = |link: &Link| principal_moments(&link.inertia);
    let (a, b) = (moments(one)?, moments(other)?);
    let scale = a.iter().chain(&b).fold(0.0_f64, |largest, moment| largest.max(moment.abs()));
    a.iter().zip(b).any(|(a, b)| differs(*a, b, scale)).then(|| {
        let [a, b] = [a, b].map(|moments| moments.map(six_digits).join(", "));
        let what = format!("their principal moments of inertia are ({a}) and ({b}) kg m²");
        Difference { key: "inertia", what }
    })
}

/// Returns the pairs of joints, counted from 0, whose names differ only in the side, and of which neither carries the
/// other.
fn pairs(joints: &[Joint]) -> Vec<[usize; 2]> {
    let places: BTreeMap<&str, usize> =
        joints.iter().enumerate().map(|(index, joint)| (joint.name.as_str(), index)).collect();
    let carries = |below: usize, above: usize| {
        std::iter::successors(Some(above), |&joint| parent(joints, joint)).any(|joint| joint == below)
    };
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    for (one, joint) in joints.iter().enumerate() {
        let is_twin = |other: &usize| {
            *other > one
                && joints[*other].row.kind == joint.row.kind
                && !carries(one, *other)
                && !pairs.iter().flatten().any(|known| known == other || *known == one)
        };
        let candidates = other_side(&joint.name);
        let twin = candidates.iter().filter_map(|name| places.get(name.as_str()).copied()).find(is_twin);
        pairs.extend(twin.map(|other| [one, other]));
    }
    pairs
}

/// Returns the names that the same joint on the other side may have: `arm_right_1` for `arm_left_1`, `rf_haa` for
/// `lf_haa`, `FR_hip` for `FL_hip`, `RHipYaw` for `LHipYaw`.
#[must_use]
pub fn other_side(name: &str) -> Vec<String> {
    let mut names = Vec::new();
    if name.len() > LONGEST_NAME {
        return names;
    }
    let mut start = 0;
    for word in name.split(|c: char| !c.is_ascii_alphabetic()) {
        let range = start..start + word.len();
        // a character between two words may have several bytes
        start = range.end + name[range.end..].chars().next().map_or(0, char::len_utf8);
        let mut put = |at: usize, old: &str, new: &str| {
            let at = range.start + at;
            names.push(format!("{}{new}{}", &name[..at], &name[at + old.len()..]));
        };
        for (old, new) in SIDES.iter().flat_map(|&[left, right]| [(left, right), (right, left)]) {
            let is_upper = |at: usize| word[at..].starts_with(|c: char| c.is_ascii_uppercase());
            match (old.len(), word.len()) {
                // one letter: alone, one of two as in `FL`, or before a capital as in `LHip`
                (1, 1) if word == old => put(0, old, new),
                (1, 2) => word.match_indices(old).for_each(|(at, _)| put(at, old, new)),
                (1, 3..) if old != "l" && old != "r" && word.starts_with(old) && is_upper(1) && !is_upper(2) => {
                    put(0, old, new);
                }
                (1, _) => {}
                _ if word == old => put(0, old, new),
                _ if word.starts_with(old) && is_upper(old.len()) => put(0, old, new),
                (length, whole) if word.ends_with(old) && old.starts_with(['L', 'R']) => put(whole - length, old, new),
                _ => {}
            }
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::other_side;

    #[test]
    fn names_of_sides_are_those_of_real_robots() {
        for (name, other) in [
            ("left_e0", "right_e0"),
            ("arm_left_1_joint", "arm_right_1_joint"),
            ("l_leg_hpx", "r_leg_hpx"),
            ("lf_haa_joint", "rf_haa_joint"),
            ("LH_HFE", "RH_HFE"),
            ("FL_calf_joint", "FR_calf_joint"),
            ("RL_calf_joint", "RR_calf_joint"),
            ("HR_KFE", "HL_KFE"),
            ("LHipYaw", "RHipYaw"),
            ("leftHip", "rightHip"),
            ("hipLeft", "hipRight"),
            ("knee-l", "knee-r"),
            ("épaule l", "épaule r"),
            ("LEFT-knee", "RIGHT-knee"),
        ] {
            assert!(other_side(name).contains(&other.to_owned()), "{name}: {:?}", other_side(name));
            assert!(other_side(other).contains(&name.to_owned()), "{other}: {:?}", other_side(other));
        }
        for name in ["elbow", "shoulder", "roll", "wrist_roll_joint", "joint1", "RADIUS", "lower"] {
            assert!(other_side(name).is_empty(), "{name}: {:?}", other_side(name));
        }
    }
}
