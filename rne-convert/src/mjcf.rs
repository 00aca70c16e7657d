//! An MJCF file, MuJoCo's description of a model, as a tree of links and joints.
//!
//! Bodies, joints and inertias are read, with the values of their classes, as MuJoCo's XML reference defines them
//! (<https://mujoco.readthedocs.io/en/stable/XMLreference.html>). What is not a matter of inverse dynamics, such as
//! meshes, contacts and sensors, is ignored. A body is a link whose frame is that of the body; of several joints of
//! a body, each but the last one moves a link without mass.

mod actuator;
mod body;
mod compiler;
mod element;
mod equality;
mod geom;
mod inertial;
mod settings;

use std::collections::BTreeMap;

use rne_model::Report;

use self::body::Bodies;
use self::compiler::Compiler;
use self::element::Element;
use self::settings::Settings;
use crate::source::{Source, names};
use crate::urdf::Urdf;

/// Parts of a model that a robot file cannot describe, in words, and the names of the elements that have them.
#[derive(Default)]
struct LeftOut(BTreeMap<&'static str, Vec<String>>);

impl LeftOut {
    fn add(&mut self, what: &'static str, of: &str) {
        self.0.entry(what).or_default().push(of.to_owned());
    }

    /// Whether an element is among those of a kind.
    fn has(&self, what: &str, of: &str) -> bool {
        self.0.get(what).is_some_and(|elements| elements.iter().any(|element| element == of))
    }

    /// A remark for each thing.
    fn remarks(self) -> impl Iterator<Item = String> {
        self.0.into_iter().map(|(what, of)| format!("{what}: {}", names(of)))
    }
}

/// Reads an MJCF file and the files that it includes, which are searched in the folder of the file.
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
    for tendon in root.below("tendon") {
        left_out.add("tendons are left out", tendon.text("name").unwrap_or(&tendon.name));
    }
    for flex in root.below("deformable") {
        left_out.add("deformable bodies are left out", flex.text("name").unwrap_or(&flex.name));
    }
    urdf.gravity = Some(gravity(&settings, &root)?);
    urdf.remarks.extend(left_out.remarks());
    urdf.name = name;
    urdf.source = source;
    Ok(urdf)
}

/// The acceleration of gravity, m/s².
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
