//! Computes mass and inertia of geoms: spheres, capsules, cylinders, boxes and ellipsoids.

use std::f64::consts::PI;

use rne_model::{Inertia, Link, Report};

use super::body::{COMPILED, Content, pose};
use super::inertial::Inertial;
use super::settings::{Classed, Settings};
use crate::body::Body;
use crate::geometry::{Pose, Rotation, Vector, decimal};
use crate::source::quoted;

/// Density of a geom that gives neither mass nor density, kg/m³.
const DENSITY: f64 = 1000.0;

/// Adds up the geoms of a body; `None` if no geom is in the groups that count.
pub(super) fn inertial(settings: &Settings, name: &str, contents: &[Content]) -> Result<Option<Inertial>, Report> {
    let mut body = Body::NONE;
    let mut number = 0;
    for content in contents.iter().filter(|content| content.element.name == "geom") {
        let geom = settings.classed(content.element, content.class)?;
        let group = geom.number("group")?.unwrap_or(0.0);
        let [first, last] = settings.compiler.groups;
        if group < first || group > last {
            continue;
        }
        number += 1;
        if let Some((mass, place, inertia)) = solid(geom, name)? {
            body = body + Body::at(mass, content.frame * place, inertia);
        }
    }
    let Link { mass, com, inertia, .. } = body.to_link();
    Ok((number > 0).then_some(Inertial { mass, com, rpy: [0.0; 3], inertia }))
}

/// Returns the mass, the frame at the centre, and the inertia of a geom of the body `of`; `None` where the geom has no
/// mass.
fn solid(geom: Classed, of: &str) -> Result<Option<(f64, Pose, Inertia)>, Report> {
    let (mass, density) = (geom.number("mass")?, geom.number("density")?.unwrap_or(DENSITY));
    let kind = geom.text("type").unwrap_or("sphere");
    if mass.map_or(density, |mass| mass) == 0.0 || matches!(kind, "plane" | "hfield") {
        return Ok(None);
    }
    let is_mesh = matches!(kind, "mesh" | "sdf") || geom.text("mesh").is_some();
    let is_shell = geom.flag("shellinertia")?.unwrap_or(false);
    if is_mesh || is_shell {
        let of_what = if is_mesh { "the mesh of a geom, and rne opens no meshes" } else { "the shell of a geom" };
        let message = format!("the inertia of the body {} is that of {of_what}", quoted(of));
        return Err(geom.refused(message, COMPILED));
    }
    let (place, sizes) = match geom.vector("fromto")? {
        Some(ends) => {
            let (place, half) = between(geom, ends)?;
            let radius = geom.first("size", 3)?;
            let radius = radius.ok_or_else(|| geom.refused("a `geom` with `fromto` lacks `size`", None))?;
            let round = matches!(kind, "capsule" | "cylinder");
            (place, if round { vec![radius, half] } else { vec![radius, radius, half] })
        }
        None => (pose(geom)?, geom.numbers("size", 1, 3)?.unwrap_or_default()),
    };
    let needed = match kind {
        "sphere" => 1,
        "capsule" | "cylinder" => 2,
        "box" | "ellipsoid" => 3,
        _ => return Err(geom.error("type", "rne knows sphere, capsule, cylinder, box, ellipsoid, plane and mesh")),
    };
    if sizes.len() < needed || sizes[..needed].iter().any(|size| *size <= 0.0) {
        let message = format!("a `geom` of the type {kind} needs {needed} sizes, each above zero");
        return Err(geom.refused(message, "write them into `size`"));
    }
    let (volume, about) = unit_density(kind, &sizes);
    let mass = mass.unwrap_or(density * volume);
    if mass < 0.0 {
        return Err(geom.refused("a `geom` has a negative mass", "a mass is zero or positive"));
    }
    let [xx, yy, zz] = about.map(|moment| moment * mass);
    Ok(Some((mass, place, Inertia { xx, yy, zz, ..Inertia::default() })))
}

/// Returns the volume of a solid, m³, and its principal moments of inertia about its centre divided by its mass, m².
fn unit_density(kind: &str, sizes: &[f64]) -> (f64, [f64; 3]) {
    let square = |length: f64| length * length;
    match *sizes {
        [radius, ..] if kind == "sphere" => (4.0 / 3.0 * PI * radius.powi(3), [0.4 * square(radius); 3]),
        [radius, half, ..] if kind == "cylinder" => {
            let across = square(radius) / 4.0 + square(half) / 3.0;
            (2.0 * PI * square(radius) * half, [across, across, square(radius) / 2.0])
        }
        [radius, half, ..] if kind == "capsule" => {
            let (ends, middle) = (4.0 / 3.0 * PI * radius.powi(3), 2.0 * PI * square(radius) * half);
            let (ends_part, middle_part) = (ends / (ends + middle), middle / (ends + middle));
            // the centre of mass of a hemisphere is 3/8 of the radius from its flat side
            let away = 0.4 * square(radius) + square(half) + 0.75 * half * radius;
            let across = ends_part * away + middle_part * (square(radius) / 4.0 + square(half) / 3.0);
            let along = ends_part * 0.4 * square(radius) + middle_part * square(radius) / 2.0;
            (ends + middle, [across, across, along])
        }
        [x, y, z] => {
            let (volume, part) = if kind == "box" { (8.0, 3.0) } else { (4.0 / 3.0 * PI, 5.0) };
            let moment = |a: f64, b: f64| (square(a) + square(b)) / part;
            (volume * x * y * z, [moment(y, z), moment(x, z), moment(x, y)])
        }
        _ => (0.0, [0.0; 3]),
    }
}

/// Returns the frame in the middle between two points, whose z axis points from the second to the first one, and half
/// their distance.
pub(super) fn between(element: Classed, [a, b, c, d, e, f]: [f64; 6]) -> Result<(Pose, f64), Report> {
    let (from, to) = (Vector::decimal([a, b, c]), Vector::decimal([d, e, f]));
    let way = from - to;
    let Some(rotation) = Rotation::to_z(way.to_f64()) else {
        return Err(element.error("fromto", "its two points must differ"));
    };
    let half = decimal(0.5);
    Ok((Pose { rotation, translation: (from + to) * half }, (way.norm() * half).to_f64()))
}
