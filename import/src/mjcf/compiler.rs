//! Reads the element `compiler`, which says how to interpret numbers of the file.

use rne_model::Report;

use super::element::{Element, within};
use super::settings::{Classed, Settings};
use crate::geometry::Rotation;
use crate::source::{Source, quoted};

/// The settings of the compiler that dynamics needs.
#[derive(Clone, Debug)]
pub(super) struct Compiler {
    pub(super) is_degrees: bool,
    /// Three letters: the axes about which Euler angles turn, in lower case for rotating axes and in upper case for
    /// fixed axes.
    euler: [u8; 3],
    pub(super) autolimits: bool,
    pub(super) inertia_from_geoms: FromGeoms,
    /// The range of groups of geoms that count for inertias.
    pub(super) groups: [f64; 2],
    /// Whether an inertia that no physical body has is replaced by the mean of its moments about every axis.
    pub(super) balances: bool,
    /// The smallest mass and the smallest principal moment that a body gets.
    pub(super) least: [f64; 2],
    /// The total mass of all bodies, kg, if the file prescribes it.
    pub(super) total_mass: Option<f64>,
}

/// The bodies that get their inertia from their geoms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FromGeoms {
    /// No body: only `inertial` counts.
    Never,
    /// Bodies without an element `inertial`.
    Missing,
    /// All bodies that have geoms.
    Always,
}

impl Compiler {
    pub(super) fn read(source: &Source, root: &Element) -> Result<Self, Report> {
        let compiler = Self {
            is_degrees: true,
            euler: *b"xyz",
            autolimits: true,
            inertia_from_geoms: FromGeoms::Missing,
            groups: [0.0, 5.0],
            balances: false,
            least: [0.0; 2],
            total_mass: None,
        };
        let no_classes = Element::default();
        let mut settings = Settings::read(source, compiler, &no_classes)?;
        for element in root.children("compiler") {
            let mut compiler = settings.compiler.clone();
            compiler.take(source, settings.plain(element))?;
            settings.compiler = compiler;
        }
        Ok(settings.compiler)
    }

    fn take(&mut self, source: &Source, element: Classed) -> Result<(), Report> {
        element.refuse_slips(
            &[
                "angle",
                "autolimits",
                "balanceinertia",
                "boundinertia",
                "boundmass",
                "eulerseq",
                "inertiafromgeom",
                "inertiagrouprange",
                "settotalmass",
            ],
            &["coordinate", "alignfree", "fitaabb", "fusestatic", "saveinertial", "exactmeshinertia"],
        )?;
        match element.text("angle") {
            None => {}
            Some("degree") => self.is_degrees = true,
            Some("radian") => self.is_degrees = false,
            Some(_) => return Err(element.error("angle", "it must be degree or radian")),
        }
        if element.text("coordinate").is_some_and(|word| word != "local") {
            let help = "MuJoCo has removed global coordinates, too: save the file with a version before 2.3.4";
            let place = within(source, &element.element.span, "coordinate");
            return Err(source.error(&place, "rne reads local coordinates only", help));
        }
        if let Some(word) = element.text("eulerseq") {
            let letters = word.as_bytes().try_into().ok();
            let is_fine = |letters: &[u8; 3]| letters.iter().all(|letter| b"xyzXYZ".contains(letter));
            self.euler = letters
                .filter(is_fine)
                .ok_or_else(|| element.error("eulerseq", "it must be three of the letters x, y, z, X, Y, Z"))?;
        }
        self.inertia_from_geoms = match element.text("inertiafromgeom") {
            None => self.inertia_from_geoms,
            Some("false") => FromGeoms::Never,
            Some("auto") => FromGeoms::Missing,
            Some("true") => FromGeoms::Always,
            Some(_) => return Err(element.error("inertiafromgeom", "it must be true, false or auto")),
        };
        self.autolimits = element.flag("autolimits")?.unwrap_or(self.autolimits);
        self.balances = element.flag("balanceinertia")?.unwrap_or(self.balances);
        self.groups = element.vector("inertiagrouprange")?.unwrap_or(self.groups);
        let [mass, inertia] = self.least;
        self.least = [element.number("boundmass")?.unwrap_or(mass), element.number("boundinertia")?.unwrap_or(inertia)];
        self.total_mass = element.number("settotalmass")?.filter(|mass| *mass > 0.0).or(self.total_mass);
        Ok(())
    }

    /// Converts an angle of the file to rad.
    pub(super) fn radians(&self, angle: f64) -> f64 {
        if self.is_degrees { angle.to_radians() } else { angle }
    }

    /// Returns the rotation of Euler angles, rad.
    pub(super) fn euler(&self, angles: [f64; 3]) -> Rotation {
        self.euler.iter().zip(angles).fold(Rotation::identity(), |before, (letter, angle)| {
            let turn = match letter.to_ascii_lowercase() {
                b'x' => Rotation::x(angle),
                b'y' => Rotation::y(angle),
                _ => Rotation::z(angle),
            };
            if letter.is_ascii_lowercase() { before * turn } else { turn * before }
        })
    }
}

/// Makes the error for a name that is used twice.
pub(super) fn twice(source: &Source, element: &Element, name: &str) -> Report {
    let place = within(source, &element.span, name);
    let message = format!("there are two elements `{}` with the name {}", element.name, quoted(name));
    source.error(&place, message, "names must differ")
}
