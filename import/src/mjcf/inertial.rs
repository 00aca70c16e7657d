//! Computes mass, centre of mass and inertia of a body, from its element `inertial` or from its geoms.

use rne_model::{Inertia, Report};

use super::body::{Content, placed, pose};
use super::compiler::FromGeoms;
use super::element::Element;
use super::geom;
use super::settings::{Classed, Settings};
use crate::geometry::Pose;
use crate::source::quoted;

/// Mass, kg; centre of mass, m; the axes of the tensor, rad; the tensor about the centre of mass in these axes, kg m².
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Inertial {
    pub(super) mass: f64,
    pub(super) com: [f64; 3],
    pub(super) rpy: [f64; 3],
    pub(super) inertia: Inertia,
}

/// Computes the inertia of a body as MuJoCo's compiler does; `place` is the placement of the body in its parent.
pub(super) fn read(
    settings: &Settings,
    name: &str,
    (body, place): (&Element, Pose),
    contents: &[Content],
) -> Result<Inertial, Report> {
    let written = contents.iter().filter(|content| content.element.name == "inertial").collect::<Vec<_>>();
    if let Some(second) = written.get(1) {
        return Err(settings.source.error(&second.element.span, "a second `inertial` in one `body`", None));
    }
    let uses_geoms = match settings.compiler.inertia_from_geoms {
        FromGeoms::Never => false,
        FromGeoms::Missing => written.is_empty(),
        FromGeoms::Always => true,
    };
    let of_geoms = if uses_geoms { geom::inertial(settings, name, contents)? } else { None };
    let inertial = match (of_geoms, written.first()) {
        (Some(inertial), _) => inertial,
        (None, Some(content)) => explicit(settings.plain(content.element), name, content)?,
        // a body without `inertial` and geoms has only the least mass; MuJoCo puts it at the coordinates of the body's
        // `pos`, but in the frame of the body itself
        (None, None) => {
            let (com, rpy) = placed(place);
            Inertial { com, rpy, ..Inertial::default() }
        }
    };
    adjusted(settings, name, body, inertial)
}

/// Reads an element `inertial`.
fn explicit(element: Classed, name: &str, content: &Content) -> Result<Inertial, Report> {
    element.refuse_slips(
        &["pos", "quat", "mass", "diaginertia", "fullinertia", "axisangle", "xyaxes", "zaxis", "euler"],
        &[],
    )?;
    let missing = |attribute: &str| {
        let message = format!("the `inertial` of the body {} lacks `{attribute}`", quoted(name));
        let help = "write `pos`, `mass` and `diaginertia` or `fullinertia`, or delete it";
        element.refused(message, help)
    };
    let Some(mass) = element.number("mass")? else { return Err(missing("mass")) };
    if element.text("pos").is_none() {
        return Err(missing("pos"));
    }
    if mass < 0.0 {
        return Err(element.error("mass", "a mass is zero or positive"));
    }
    let (com, rpy) = placed(content.frame * pose(element)?);
    let (diagonal, full) = (element.vector("diaginertia")?, element.vector("fullinertia")?);
    let inertia = match (diagonal, full) {
        (Some(_), Some(_)) => {
            let message = format!("the `inertial` of the body {} has two inertias", quoted(name));
            return Err(element.refused(message, "keep `diaginertia` or `fullinertia`"));
        }
        (Some([xx, yy, zz]), None) => Inertia { xx, yy, zz, ..Inertia::default() },
        (None, Some([xx, yy, zz, xy, xz, yz])) => Inertia { xx, yy, zz, xy, xz, yz },
        (None, None) => return Err(missing("diaginertia")),
    };
    Ok(Inertial { mass, com, rpy, inertia })
}

/// Applies the compiler settings: smallest values, and balancing where the file asks for it.
fn adjusted(settings: &Settings, name: &str, body: &Element, mut inertial: Inertial) -> Result<Inertial, Report> {
    let [mass, least] = settings.compiler.least;
    inertial.mass = inertial.mass.max(mass);
    let Inertia { xx, yy, zz, xy, xz, yz } = inertial.inertia;
    let moments = inertial.inertia.principal_moments().unwrap_or_default();
    if least > 0.0 && moments[0] < least {
        if [xy, xz, yz] != [0.0; 3] {
            let message = format!("`boundinertia` changes the body {}, whose tensor is not diagonal", quoted(name));
            let help = "write the tensor of this body as `diaginertia` and `quat`";
            return Err(settings.source.error(&body.span, message, help));
        }
        inertial.inertia = Inertia { xx: xx.max(least), yy: yy.max(least), zz: zz.max(least), xy, xz, yz };
    }
    let [a, b, c] = inertial.inertia.principal_moments().unwrap_or_default();
    if settings.compiler.balances && a + b < c {
        let mean = (a + b + c) / 3.0;
        inertial.inertia = Inertia { xx: mean, yy: mean, zz: mean, ..Inertia::default() };
    }
    Ok(inertial)
}
