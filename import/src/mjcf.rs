//! Reads an MJCF file, MuJoCo's description of a model, as a tree of links and joints.
//!
//! Bodies, joints and inertias are read, with the default values of their classes, as MuJoCo's XML reference defines
//! them (<https://mujoco.readthedocs.io/en/stable/XMLreference.html>). Parts without effect on inverse dynamics, such
//! as meshes, contacts and sensors, are ignored. A body is a link whose frame is that of the body; if a body has
//! several joints, each but the last one moves a link without mass.

mod actuator;
mod body;
mod compiler;
pub(crate) mod element;
mod equality;
mod geom;
mod inertial;
mod joint;
mod settings;

use std::collections::BTreeMap;

use rne_model::Report;

use self::body::Bodies;
use self::compiler::Compiler;
use self::element::Element;
use self::settings::{Classed, Settings};
use crate::remark::Remark;
use crate::source::{Source, names};
use crate::urdf::Urdf;

/// The kinds of parts that a robot file cannot describe, each in words; with whether MuJoCo's torques include such
/// parts, and the names of the elements that have them.
#[derive(Default)]
struct LeftOut(BTreeMap<&'static str, (bool, Vec<String>)>);

impl LeftOut {
    fn add(&mut self, what: &'static str, of: &str) {
        self.0.entry(what).or_default().1.push(of.to_owned());
    }

    /// Adds a part that is left out although it changes forces or inertias in MuJoCo.
    fn add_felt(&mut self, what: &'static str, of: &str) {
        self.add(what, of);
        self.0.entry(what).or_default().0 = true;
    }

    /// Returns whether an element has a part of this kind.
    fn has(&self, what: &str, of: &str) -> bool {
        self.0.get(what).is_some_and(|(_, elements)| elements.iter().any(|element| element == of))
    }

    /// Returns a remark for each kind of part.
    fn remarks(self) -> impl Iterator<Item = Remark> {
        self.0.into_iter().map(|(what, (is_felt, of))| {
            let of = names(of);
            if is_felt {
                Remark::warning(format!("{what}, but MuJoCo's torques have them: {of}"))
            } else {
                format!("{what}: {of}").into()
            }
        })
    }
}

/// Returns whether a number of one of these attributes is not zero.
fn is_there(element: Classed, attributes: &[&str]) -> Result<bool, Report> {
    let mut is_there = false;
    for attribute in attributes {
        is_there |=
            element.numbers(attribute, 1, 3)?.is_some_and(|numbers| numbers.iter().any(|number| *number != 0.0));
    }
    Ok(is_there)
}

/// Reads an MJCF file and the files that it includes, which are searched in its folder.
pub(crate) fn read(mut source: Source) -> Result<Urdf, Report> {
    let root = element::read(&mut source)?;
    let compiler = Compiler::read(&source, &root)?;
    let settings = Settings::read(&source, compiler, &root)?;
    let name = root.text("model").unwrap_or_default().to_owned();
    let mut left_out = LeftOut::default();
    let mut urdf = Bodies::read(&settings, &mut left_out, &root)?;
    actuator::read(&settings, &mut left_out, &root, &mut urdf)?;
    equality::read(&settings, &mut left_out, &root, &mut urdf)?;
    urdf.split_spherical_joints(&source)?;
    for element in root.below("tendon") {
        let (tendon, name) = (settings.classed(element, 0)?, element.text("name").unwrap_or(&element.name));
        if is_there(tendon, &["armature", "stiffness", "damping", "frictionloss"])? {
            left_out.add_felt("springs, friction and armature of tendons are left out", name);
        } else {
            left_out.add("tendons are left out", name);
        }
    }
    for option in root.children("option").map(|option| settings.plain(option)) {
        for attribute in ["density", "viscosity"] {
            if is_there(option, &[attribute])? {
                left_out.add_felt("forces of a fluid are left out", attribute);
            }
        }
    }
    for flex in root.below("deformable") {
        left_out.add("deformable bodies are left out", flex.text("name").unwrap_or(&flex.name));
    }
    urdf.gravity = Some(gravity(&settings, &root)?);
    urdf.remarks.0.extend(left_out.remarks());
    urdf.name = name;
    urdf.source = source;
    Ok(urdf)
}

/// Reads the acceleration of gravity, m/s².
fn gravity(settings: &Settings, root: &Element) -> Result<[f64; 3], Report> {
    let mut gravity = [0.0, 0.0, -9.81];
    let mut is_off = false;
    for option in root.children("option") {
        gravity = settings.plain(option).vector("gravity")?.unwrap_or(gravity);
        for flag in option.children.iter().filter(|flag| flag.name == "flag") {
            is_off = flag.text("gravity").map_or(is_off, |word| word == "disable");
        }
    }
    Ok(if is_off { [0.0; 3] } else { gravity })
}
