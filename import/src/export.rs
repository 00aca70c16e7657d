//! Converts a table to a URDF, so that other programs that read URDF can be compared with rne.

mod elements;
mod friction;
mod remarks;

use std::error::Error;
use std::fmt::{self, Write as _};

use rne_model::{Coupling, Frame, Robot, exact_digits, one_line};

use self::elements::{Names, comment, fixed, link, movable};
use self::friction::Friction;
use self::remarks::remarks;
use crate::body::Body;
use crate::chain::{Chain, ChainFrame, ChainJoint};
use crate::conventions::of_robot;
use crate::urdf::xml::LARGEST;

/// A robot as a URDF.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Exported {
    /// The text of the URDF.
    pub text: String,
    /// The acceleration of gravity in the axes of the root link, m/s², which a URDF cannot contain.
    pub gravity: [f64; 3],
    /// Properties of the robot that the URDF cannot express, in sentences.
    pub remarks: Vec<String>,
}

/// The reason why a robot cannot be written as a URDF.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum NoUrdf {
    /// A link has a first moment and no mass.
    NoMass {
        /// The number of the link, counted from 1.
        link: usize,
        /// The name of the joint that moves the link.
        joint: String,
    },
    /// A joint follows several others.
    SeveralLeaders {
        /// The name of the joint that follows others.
        joint: String,
        /// The names of the joints that it follows.
        leaders: Vec<String>,
    },
    /// A number is larger than an import accepts.
    TooLarge {
        /// The name of the quantity, in words.
        what: String,
        /// The number.
        number: f64,
    },
}

impl fmt::Display for NoUrdf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoMass { link, joint } => write!(
                f,
                "link {link}, which the joint {} moves, has a first moment but no mass, and a URDF cannot store this, \
                 because it stores the mass of a link and its centre; give the link its `mass`",
                one_line(joint)
            ),
            Self::SeveralLeaders { joint, leaders } => write!(
                f,
                "the joint {} follows {}, and a URDF cannot say this: a `mimic` follows one joint",
                one_line(joint),
                leaders.iter().map(|leader| one_line(leader)).collect::<Vec<_>>().join(" and ")
            ),
            Self::TooLarge { what, number } => write!(
                f,
                "{what} would be {number:e}, but an import refuses numbers of a URDF above {LARGEST:e}; check the \
                 units of the robot file: lengths are metres and masses kilograms"
            ),
        }
    }
}

impl Error for NoUrdf {}

/// Converts a robot, an arm or a tree, to a URDF. Its root link `world` carries the link `base`, which is frame 0; a
/// floating base is the root link itself, with its own name. Joint i moves the link `link_i`, whose frame is on the
/// axis of the joint; the frame of the link `tip` is the tip frame. Named frames and bodies become links with fixed
/// joints. A joint that follows another one gets a `mimic`.
///
/// The friction of a motor becomes that of its joint: `damping` is G² B, and `friction` is |G| Tc with the mean Tc of
/// both directions.
///
/// # Errors
///
/// When a link has a first moment and no mass, when a joint follows several others, or when a number is larger than an
/// import accepts.
pub fn export(robot: &Robot) -> Result<Exported, NoUrdf> {
    if let Some(index) = robot.rows().position(|row| row.link.has_first_moment()) {
        return Err(NoUrdf::NoMass { link: index + 1, joint: robot.joints[index].name.clone() });
    }
    let bare = &without_bodies(robot);
    let chain = of_robot(bare);
    refuse_too_large(&chain)?;
    // Gravity in frame 0 is rounded, so components below 1e-14 in the axes of the world are rounding errors of zero.
    let gravity = (chain.base.rotation * chain.gravity).to_f64().map(|g| if g.abs() < 1e-14 { 0.0 } else { g });
    let base = name_of_base(bare);
    let root = if chain.floating_base.is_some() { base } else { "world" };
    let remarks = remarks(robot, &chain, gravity, root);
    let mut text = String::from("<?xml version=\"1.0\"?>\n");
    for words in robot.title.iter().chain(&remarks) {
        let _ = writeln!(text, "<!-- {} -->", comment(words));
    }
    let _ = writeln!(text, "<robot name=\"{}\">", robot.name);
    if let Some(body) = &chain.floating_base {
        link(&mut text, base, body);
    } else {
        text.push_str("  <link name=\"world\"/>\n  <link name=\"base\"/>\n");
        fixed(&mut text, "world_to_base", ("world", "base"), chain.base);
    }
    let mut names = Names::default();
    let carrier = |on: Option<usize>| on.map_or_else(|| base.to_owned(), |joint| format!("link_{}", joint + 1));
    let joints: Vec<String> = chain.joints.iter().map(|joint| names.unique(&joint.name)).collect();
    for (index, joint) in chain.joints.iter().enumerate() {
        let child = format!("link_{}", index + 1);
        link(&mut text, &child, &joint.body);
        let mimic = mimic(joint, &chain, &joints)?;
        movable(&mut text, &joints[index], joint, (&carrier(joint.parent), &child), &mimic);
    }
    text.push_str("  <link name=\"tip\"/>\n");
    fixed(&mut text, "to_tip", (&carrier(Some(chain.tip_on)), "tip"), chain.tip);
    for (index, frame) in as_links(&chain, bare).into_iter().enumerate() {
        let body = index.checked_sub(robot.frames.len()).map(|body| &robot.bodies.list[body].matter);
        match body {
            Some(matter) => link(&mut text, &frame.name, &Body::of_link(matter)),
            None => {
                let _ = writeln!(text, "  <link name=\"{}\"/>", frame.name);
            }
        }
        let joint = names.unique(&format!("to_{}", frame.name));
        fixed(&mut text, &joint, (&carrier(frame.on), &frame.name), frame.place);
    }
    text.push_str("</robot>\n");
    Ok(Exported { text, gravity, remarks })
}

/// Returns the robot with links without their bodies; each body becomes a frame after the named frames.
fn without_bodies(robot: &Robot) -> Robot {
    let names: Vec<&str> = robot.bodies.list.iter().map(|body| body.name.as_str()).collect();
    let mut bare = robot.without_bodies(&names).unwrap_or_else(|_| robot.clone());
    bare.frames.extend(robot.bodies.list.iter().map(|body| Frame { name: body.name.clone(), fixed: body.fixed }));
    bare
}

/// Returns the element `mimic` of a joint that follows another one; an empty text for other joints.
fn mimic(joint: &ChainJoint, chain: &Chain, names: &[String]) -> Result<String, NoUrdf> {
    let Some(Coupling { follows, offset }) = &joint.coupling else { return Ok(String::new()) };
    let [(leader, ratio)] = follows[..] else {
        let leaders = follows.iter().map(|(leader, _)| chain.joints[*leader].name.clone()).collect();
        return Err(NoUrdf::SeveralLeaders { joint: joint.name.clone(), leaders });
    };
    let [ratio, offset] = [ratio, *offset].map(exact_digits);
    let leader = &names[leader];
    Ok(format!("    <mimic joint=\"{leader}\" multiplier=\"{ratio}\" offset=\"{offset}\"/>\n"))
}

/// Returns the name of the link that is frame 0: that of a floating base if no other link has it, else `base`.
fn name_of_base(robot: &Robot) -> &str {
    let name = robot.floating_base.as_ref().map_or("base", |base| base.name.as_str());
    if is_taken(name, robot) { "base" } else { name }
}

/// Returns whether a link other than the base and the named frames has this name in the URDF.
fn is_taken(name: &str, robot: &Robot) -> bool {
    let number = name.strip_prefix("link_").and_then(|number| number.parse::<usize>().ok());
    matches!(name, "world" | "tip") || number.is_some_and(|number| (1..=robot.joints.len()).contains(&number))
}

/// Returns the named frames as links of the URDF, with names that no other link has.
fn as_links(chain: &Chain, robot: &Robot) -> Vec<ChainFrame> {
    let named = |frame: &ChainFrame| {
        let mut name = frame.name.clone();
        while is_taken(&name, robot) || name != frame.name && robot.frames.iter().any(|other| other.name == name) {
            name.push_str("_frame");
        }
        ChainFrame { name, ..frame.clone() }
    };
    chain.frames.iter().map(named).collect()
}

/// Refuses numbers that an import would refuse.
fn refuse_too_large(chain: &Chain) -> Result<(), NoUrdf> {
    let check =
        |what: String, numbers: &[f64]| match numbers.iter().find(|number| number.is_nan() || number.abs() > LARGEST) {
            Some(&number) => Err(NoUrdf::TooLarge { what, number }),
            None => Ok(()),
        };
    check("a coordinate of `base`".to_owned(), &chain.base.translation.to_f64())?;
    check("a coordinate of the tip".to_owned(), &chain.tip.translation.to_f64())?;
    for frame in &chain.frames {
        check(format!("a coordinate of the frame {}", frame.name), &frame.place.translation.to_f64())?;
    }
    let check_body = |of: &str, body: &Body| {
        let link = body.to_link();
        let i = link.inertia;
        check(format!("a coordinate of the centre of mass of {of}"), &link.com)?;
        check(format!("the mass of {of}"), &[body.mass.to_f64()])?;
        check(format!("an inertia of {of}"), &[i.xx, i.yy, i.zz, i.xy, i.xz, i.yz])
    };
    chain.floating_base.as_ref().map_or(Ok(()), |body| check_body("the floating base", body))?;
    for (index, joint) in chain.joints.iter().enumerate() {
        let number = index + 1;
        check(format!("a coordinate of joint {number}"), &joint.place.translation.to_f64())?;
        check_body(&format!("link {number}"), &joint.body)?;
        if let Some(Friction { damping, friction }) = joint.motor.as_ref().and_then(Friction::of) {
            check(format!("the friction of joint {number}"), &[damping, friction])?;
        }
    }
    Ok(())
}
