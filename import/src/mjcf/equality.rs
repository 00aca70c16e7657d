//! Reads the section `equality`: joints that follow others, and closed loops, which MuJoCo closes by `connect` and
//! `weld`.

use rne_model::{Cut, Report};

use super::LeftOut;
use super::body::{MOCAP, WORLD};
use super::element::Element;
use super::settings::{Classed, Settings};
use crate::closed_loop::Loop;
use crate::geometry::{Pose, Rotation, Vector, decimal};
use crate::source::quoted;
use crate::urdf::{Joint, Kind, Mimic, Urdf};

/// Applies the equalities of the file: some couple joints, others close loops.
pub(super) fn read(settings: &Settings, left_out: &mut LeftOut, root: &Element, urdf: &mut Urdf) -> Result<(), Report> {
    for element in root.below("equality") {
        let equality = settings.classed(element, 0)?;
        let name = element.text("name").unwrap_or(&element.name);
        let is_active = equality.flag("active")?.or_else(|| settings.default_flag("equality", "active", equality));
        if is_active == Some(false) || are_disabled(root) {
            left_out.add("equalities that are not active are left out", name);
            continue;
        }
        match element.name.as_str() {
            "joint" => couple(equality, left_out, urdf)?,
            "connect" | "weld" => close(equality, left_out, urdf)?,
            kind => {
                let message = format!(
                    "the equality {} is of the kind `{kind}`, and is neither `joint`, `connect` nor `weld`",
                    quoted(name)
                );
                let help = "rne reads these three; delete this one, or make it inactive: active=\"false\"";
                return Err(equality.refused(message, help));
            }
        }
    }
    Ok(())
}

/// Returns whether the options of the file disable all equalities.
fn are_disabled(root: &Element) -> bool {
    let flags = root.children("option").flat_map(|option| option.children.iter().filter(|flag| flag.name == "flag"));
    flags.filter_map(|flag| flag.text("equality")).last() == Some("disable")
}

/// Couples a joint to another one. MuJoCo's equality is: position - reference = polynomial of (other position - its
/// reference).
fn couple(equality: Classed, left_out: &mut LeftOut, urdf: &mut Urdf) -> Result<(), Report> {
    let find = |attribute: &str| {
        let Some(name) = equality.text(attribute) else { return Ok(None) };
        let Some(index) = urdf.joints.iter().position(|joint| joint.name == name) else {
            let message = format!("the equality names the joint {}, which does not exist", quoted(name));
            return Err(equality.refused(message, "there is no such joint in the file"));
        };
        if urdf.joints[index].kind.has_one_freedom() {
            return Ok(Some(index));
        }
        let message = format!("the equality names the joint {}, which is neither hinge nor slide", quoted(name));
        Err(equality.refused(message, None))
    };
    let Some(joint) = find("joint1")? else {
        return Err(equality.refused("the equality lacks the attribute `joint1`", None));
    };
    let leader = find("joint2")?;
    let mut coefficients = equality.numbers("polycoef", 1, 5)?.unwrap_or(vec![0.0, 1.0]);
    coefficients.resize(5, 0.0);
    let [start, ratio, higher @ ..] = &coefficients[..] else { return Ok(()) };
    if leader.is_some() && higher.iter().any(|coefficient| *coefficient != 0.0) {
        let message = format!(
            "the joint {} follows another one by a polynomial of a degree above 1",
            quoted(&urdf.joints[joint].name)
        );
        let help = "a robot file couples joints by a ratio and an offset: keep the first two numbers of `polycoef`";
        return Err(equality.refused(message, help));
    }
    if urdf.joints[joint].mimic.is_some() {
        let message = format!("the joint {} follows others twice", quoted(&urdf.joints[joint].name));
        return Err(equality.refused(message, "delete one of the equalities"));
    }
    let reference = |joint: usize| decimal(urdf.joints[joint].reference);
    let start = reference(joint) + decimal(*start);
    if let Some(leader) = leader.filter(|_| *ratio != 0.0) {
        let offset = (start - decimal(*ratio) * reference(leader)).to_f64();
        let name = urdf.joints[leader].name.clone();
        urdf.joints[joint].mimic = Some(Mimic { joint: name, leader: Some(leader), multiplier: *ratio, offset });
    } else {
        let position = start.to_f64();
        left_out.add("joints that an equality holds are fixed", &urdf.joints[joint].name);
        hold(urdf, joint, position);
    }
    Ok(())
}

/// Adds the closed loop of a `connect`, whose cut joint is spherical, or of a `weld`.
fn close(equality: Classed, left_out: &mut LeftOut, urdf: &mut Urdf) -> Result<(), Report> {
    let element = equality.element;
    let matter = ["name", "class", "body1", "body2", "site1", "site2", "anchor", "relpose", "active"];
    equality.refuse_slips(&matter, &["solref", "solimp", "torquescale"])?;
    let name = element.text("name").map_or_else(|| format!("loop{}", urdf.loops.len() + 1), str::to_owned);
    let cut = if element.name == "weld" { Cut::Weld } else { Cut::Spherical };
    let [sites, bodies] = [["site1", "site2"], ["body1", "body2"]].map(|of| of.map(|end| equality.text(end)));
    let (names, are_sites) = match (sites, bodies) {
        ([Some(one), Some(other)], [None, None]) => ([one, other], true),
        ([None, None], [Some(one), other]) => ([one, other.unwrap_or(WORLD)], false),
        _ => {
            let message = format!("`{}` has neither two sites nor a `body1` alone", element.name);
            let help = "write `site1` and `site2`, or `body1` and `body2`";
            return Err(equality.refused(message, help));
        }
    };
    if names.iter().any(|name| !are_sites && left_out.has(MOCAP, name)) {
        left_out.add("equalities with a body that a motion capture moves are left out", &name);
        return Ok(());
    }
    let mut links = [0; 2];
    for (link, name) in links.iter_mut().zip(names) {
        let find = |name: &str| urdf.links.iter().position(|link| link.is_site == are_sites && link.name == name);
        // a site with the name of a body was renamed when it was read
        let other = || find(&format!("{name}_site")).filter(|_| are_sites);
        let Some(known) = find(name).or_else(other) else {
            let what = if are_sites { "site" } else { "body" };
            let message = format!("the equality names the {what} {}, which does not exist", quoted(name));
            return Err(equality.refused(message, format!("there is no such {what} in the file")));
        };
        *link = known;
    }
    let places = places(equality, cut, are_sites, urdf.at_reference(links[0]).inverse() * urdf.at_reference(links[1]))?;
    let ends = [(links[0], places[0]), (links[1], places[1])];
    urdf.add_loop(Loop { name, span: element.span.clone(), cut, ends }, equality.settings.source)
}

/// Returns the places of the cut joint on the two links of a loop. `of_one` is the placement of the second link in the
/// frame of the first one.
fn places(equality: Classed, cut: Cut, are_sites: bool, of_one: Pose) -> Result<[Pose; 2], Report> {
    let (anchor, relative) = (equality.vector::<3>("anchor")?, equality.numbers("relpose", 7, 7)?);
    Ok(match (cut, anchor, relative) {
        (_, None, None) if are_sites => [Pose::identity(); 2],
        _ if are_sites => {
            let message = format!("`{}` between sites has no `anchor` and no `relpose`", equality.element.name);
            return Err(equality.refused(message, "delete them: the sites say where the ends are"));
        }
        (Cut::Weld, anchor, Some(pose)) if pose[3..] != [0.0; 4] => {
            let Some(rotation) = Rotation::quaternion([pose[3], pose[4], pose[5], pose[6]]) else {
                return Err(equality.error("relpose", "its quaternion has no direction"));
            };
            let translation = Vector::decimal([pose[0], pose[1], pose[2]]);
            // this pose on the first body and the anchor of the second body must coincide
            let anchor = anchor.map_or(Vector::ZERO, Vector::decimal);
            [Pose { rotation, translation }, Pose { rotation: Rotation::identity(), translation: anchor }]
        }
        (Cut::Weld, ..) => [of_one, Pose::identity()],
        (_, Some(anchor), _) => {
            let place = Pose { rotation: Rotation::identity(), translation: Vector::decimal(anchor) };
            [place, of_one.inverse() * place]
        }
        (_, None, _) => {
            let message = "`connect` between bodies lacks the attribute `anchor`";
            return Err(equality.refused(message, "write the place of the joint in the axes of `body1`"));
        }
    })
}

impl Urdf {
    /// Returns the placement of a link in the world when all joints are at their reference positions.
    fn at_reference(&self, link: usize) -> Pose {
        let place = |&joint: &usize| {
            let joint = &self.joints[joint];
            Pose::new(joint.xyz, joint.rpy) * moved(joint, joint.reference)
        };
        self.to_root(link).iter().rev().map(place).fold(Pose::identity(), |pose, next| pose * next)
    }
}

/// Returns the motion of a joint from position 0 to a position.
fn moved(joint: &Joint, position: f64) -> Pose {
    let axis = Vector::decimal(joint.axis).direction().unwrap_or(Vector::unit(2));
    if joint.kind == Kind::Prismatic {
        Pose { rotation: Rotation::identity(), translation: axis * decimal(position) }
    } else {
        Pose { rotation: Rotation::about(axis, position), translation: Vector::ZERO }
    }
}

/// Replaces a joint by a fixed one at a position.
fn hold(urdf: &mut Urdf, joint: usize, position: f64) {
    let joint = &mut urdf.joints[joint];
    let place = Pose::new(joint.xyz, joint.rpy) * moved(joint, position);
    (joint.xyz, joint.rpy) = super::body::placed(place);
    joint.kind = Kind::Fixed;
}
