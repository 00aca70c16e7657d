//! Loads an arm from a robot file, a URDF or an MJCF file, from their texts, or from the shipped robots.

use std::collections::BTreeMap;
use std::ffi::CString;
use std::path::{Path, PathBuf};

use pyo3::exceptions::{PyKeyError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use rne_convert::{Description, Imported, Options, Selection};
use rne_model::{Checked, Convention, Diagnostic, Reader, Report};

use crate::arm::{Arm, Origin};
use crate::errors::{RobotFileWarning, in_keywords, of_opening, of_report};

/// The names of the robots in the box.
#[pyfunction]
pub(crate) fn names() -> Vec<&'static str> {
    rne_robots::all().map(|robot| robot.name).collect()
}

/// A robot of the box by its name.
#[pyfunction]
pub(crate) fn builtin(py: Python<'_>, name: &str) -> PyResult<Arm> {
    let file = rne_convert::shipped(name).map_err(PyKeyError::new_err)?;
    Arm::of(py, Origin::default().shipped(file))
}

/// Read an arm or a tree: a robot file (YAML), a URDF, an MJCF file, or the text of one.
///
/// Parameters
/// ----------
/// source : str or os.PathLike
///     Path of a robot file, a URDF or an MJCF file, or its text, or the name of a built-in robot. A plan file beside a
///     robot file is honoured. The words on a URDF below hold for an MJCF file, too.
/// tip, base : str, optional
///     Of a URDF: the links at the ends of the arm. Without `base` the root; `tip` is needed where there are several.
///     With
///     `whole`, `tip` may be a list of links: they are the tips that carry wrenches, the first of them is the tip.
/// whole : bool
///     Of a URDF: take all links after the base, a tree, and not one arm. `tip` is then the link that carries the tip.
/// floating : bool, optional
///     Of a URDF, with `whole`: True makes the root link, or the link that floats in the file, the floating base. False
///     fixes it. The default is what the file says: the base floats if a floating joint or a free joint moves it there.
/// lock : dict of str to float, optional
///     Of a URDF: movable joints that are held still, rad or m.
/// lock_others : bool
///     Of a URDF: hold every other movable joint off the chain at zero.
/// convention : {"standard", "modified"}, optional
///     Of a URDF: the rows of the table that is made. The default is standard; of a whole tree it is modified.
/// snap : bool
///     Of a URDF: replace angles within 2e-4 rad of a multiple of pi/12 by this multiple, as the command line does.
///     False keeps the numbers of the URDF, for comparisons with programs that read the same file.
/// keep_unphysical : bool
///     Of a URDF: take inertias that no body has.
/// run_time : sequence of str
///     Parameters of a robot file that stay free: the keyword `parameters` of every function gives them.
/// settings : dict of str to float, optional
///     Parameters of a robot file with other values than it has.
/// form : {"reduced", "seven_steps"}
///     Fewest operations, or every intermediate of the lecture in its bits.
/// rotors : bool, optional
///     Whether the rotors of the motors belong to the arm. The default is True for an MJCF file, whose `armature`
///     MuJoCo counts, too, and False for others.
///
/// Raises
/// ------
/// RobotFileError
///     With everything that is wrong, `line` and `column`.
/// OSError
///     When the file cannot be read.
///
/// Warns
/// -----
/// RobotFileWarning
///     For numbers that are allowed but probably wrong, such as an arm without mass or with placeholder inertias.
///     For a URDF, also for limits that the import ignores, and angles of more than a turn in an `rpy`. For an MJCF
///     file, for what MuJoCo's torques have and the arm has not, such as springs. `arm.notes` has these and all other
///     remarks.
#[pyfunction]
#[pyo3(signature = (source, *, tip=None, base=None, whole=false, floating=None, lock=None, lock_others=false,
    convention=None, snap=true, keep_unphysical=false, run_time=Vec::new(), settings=None, form="reduced",
    rotors=None))]
#[allow(clippy::fn_params_excessive_bools)] // keywords of Python
pub(crate) fn load(
    py: Python<'_>,
    source: &Bound<'_, PyAny>,
    tip: Option<Tips>,
    base: Option<String>,
    whole: bool,
    floating: Option<bool>,
    lock: Option<BTreeMap<String, f64>>,
    lock_others: bool,
    convention: Option<&str>,
    snap: bool,
    keep_unphysical: bool,
    run_time: Vec<String>,
    settings: Option<BTreeMap<String, f64>>,
    form: &str,
    rotors: Option<bool>,
) -> PyResult<Arm> {
    let form = form.parse().map_err(|error: rne_codegen::UnknownName| PyValueError::new_err(error.to_string()))?;
    let convention = convention_named(convention, whole)?;
    let origin = Origin {
        form,
        rotors: rotors.unwrap_or(false),
        run_time,
        settings: settings.unwrap_or_default(),
        ..Origin::default()
    };
    let given = Given::of(source)?;
    let (description, name) = given.description()?;
    let bytes = match (description, given) {
        (Description::Shipped(file), _) => return Arm::of(py, origin.shipped(file)),
        (Description::RobotFile(_), given) => return of_robot_file(py, origin, given, &name),
        (Description::Urdf(bytes), _) => bytes,
        _ => return Err(PyValueError::new_err("`source` is neither a robot file nor a URDF")),
    };
    let text = String::from_utf8(bytes).map_err(|_| PyValueError::new_err(format!("{name} is not text in UTF-8")))?;
    let lock: Vec<(String, f64)> = lock.unwrap_or_default().into_iter().collect();
    let mut tips = match tip {
        None => Vec::new(),
        Some(Tips::One(tip)) => vec![tip],
        Some(Tips::Many(tips)) => tips,
    }
    .into_iter();
    let selection = Selection { base, tip: tips.next(), lock, lock_others, whole, floating };
    let more_tips: Vec<String> = tips.collect();
    if !more_tips.is_empty() && !whole {
        return Err(PyValueError::new_err("an arm has one tip; `whole=True` takes the whole robot with several tips"));
    }
    let options =
        Options { selection, more_tips, convention, snap, keep_unphysical, frames: true, ..Options::default() };
    let imported = py.detach(|| rne_convert::import(&name, &text, &options));
    let imported = imported.map_err(|report| of_report(py, &report))?;
    let rotors = rotors.unwrap_or(imported.account.is_mjcf);
    of_import(py, Origin { rotors, ..origin }, &imported, &name, whole)
}

fn convention_named(convention: Option<&str>, whole: bool) -> PyResult<Convention> {
    match convention {
        None if whole => Ok(Convention::Modified),
        None | Some("standard") => Ok(Convention::Standard),
        Some("modified") => Ok(Convention::Modified),
        Some(other) => Err(PyValueError::new_err(format!("`{other}` is not a convention; write standard or modified"))),
    }
}

/// Returns the arm of a robot file, and gives the warnings of its lints.
fn of_robot_file(py: Python<'_>, origin: Origin, given: Given, name: &str) -> PyResult<Arm> {
    let origin = match given {
        // `Arm::of` also reads the plan beside it
        Given::File(path) => Origin { file: Some(path), ..origin },
        Given::Text(text) => Origin { robot: text, ..origin },
    };
    let arm = Arm::of(py, origin)?;
    let lints = arm.origin.read(name, arm.origin.robot.as_bytes()).map_err(|report| of_report(py, &report))?;
    warn_of(py, &lints.lints, |lint| Some(format!("{name}:{}:{}", lint.line, lint.column)))?;
    Ok(arm)
}

/// Returns the arm of an import, and gives its warnings.
fn of_import(py: Python<'_>, origin: Origin, imported: &Imported, name: &str, whole: bool) -> PyResult<Arm> {
    let held = imported.account.held.iter().cloned().collect();
    let snapping = imported.account.snapping().map(|told| format!("{told}; `snap=False` keeps the angles of the file"));
    let floats = imported.account.floats.map(|floats| match (floats, whole) {
        (true, _) => "`floating=False` fixes the base where the file has it".to_owned(),
        (false, true) => "without `floating=False`, the link that floats is the floating base".to_owned(),
        (false, false) => "with `whole=True`, the link that floats is the floating base of the whole robot".to_owned(),
    });
    let said = imported.account.remarks.iter().map(|remark| (remark.is_warning, remark.worded(in_keywords)));
    let (warnings, remarks): (Vec<_>, Vec<_>) = said.map(|(warns, text)| (warns.then(|| text.clone()), text)).unzip();
    let notes = snapping.into_iter().chain(floats).chain(remarks).collect();
    let arm = Arm::of(py, Origin { robot: imported.text.clone(), held, notes, ..origin })?;
    // nobody has written the numbers of this robot file by hand, and `snap` has rounded its angles; about inertias, the
    // remarks on the URDF say more
    let said = [Some("rounded?"), Some("violates the triangle inequality")];
    warn_of(py, &imported.account.lints, |lint| (!said.contains(&lint.label.as_deref())).then(|| name.to_owned()))?;
    warn(py, name, warnings.into_iter().flatten().map(|text| format!("{name}: {text}")).collect())?;
    Ok(arm)
}

/// The largest number of warnings about one file.
const WARNED: usize = 8;

/// Warns of each lint, after its place. Lints without a place are left out.
fn warn_of(py: Python<'_>, lints: &Report, place: impl Fn(&Diagnostic) -> Option<String>) -> PyResult<()> {
    let lints = lints.clone().worded(in_keywords);
    let said = lints.warnings().filter_map(|lint| {
        let help = lint.help.as_ref().map(|help| format!("\n{help}")).unwrap_or_default();
        Some(format!("{}: {}{help}", place(lint)?, lint.message))
    });
    warn(py, &lints.name, said.collect())
}

/// Gives warnings about the file `name`, only the first ones if there are many.
fn warn(py: Python<'_>, name: &str, mut said: Vec<String>) -> PyResult<()> {
    let more = said.len().saturating_sub(WARNED);
    said.truncate(WARNED);
    if more > 0 {
        said.push(format!("{name}: and {more} more warnings; the command `rne check` prints all of them"));
    }
    let category = py.get_type::<RobotFileWarning>();
    said.into_iter().try_for_each(|text| PyErr::warn(py, &category, &CString::new(text)?, 1))
}

/// The argument `tip`: one link or several.
#[derive(FromPyObject)]
pub(crate) enum Tips {
    One(String),
    Many(Vec<String>),
}

pub(crate) enum Given {
    File(PathBuf),
    Text(String),
}

impl Given {
    pub(crate) fn of(source: &Bound<'_, PyAny>) -> PyResult<Self> {
        let Ok(text) = source.extract::<String>() else {
            return match source.extract::<PathBuf>() {
                Ok(path) => Ok(Self::File(path)),
                Err(_) => Err(PyTypeError::new_err("`source` is a path or a text: str or os.PathLike")),
            };
        };
        // a path has no line break, while the text of an arm has one, unless it is XML or JSON
        if text.contains('\n') || text.trim_start().starts_with(['<', '{']) {
            return Ok(Self::Text(text));
        }
        Ok(Self::File(Path::new(&text).to_owned()))
    }

    /// Returns the description and its name in messages.
    fn description(&self) -> PyResult<(Description, String)> {
        Ok(match self {
            Self::Text(text) => (Description::of_text(text.clone()), "<text>".to_owned()),
            Self::File(path) => (Description::open(path).map_err(of_opening)?, path.display().to_string()),
        })
    }

    /// Returns the name in messages and the text.
    pub(crate) fn text(&self) -> PyResult<(String, String)> {
        let (description, name) = self.description()?;
        let bytes = match description {
            Description::Shipped(file) => return Ok((name, file.yaml.to_owned())),
            Description::RobotFile(bytes) | Description::Urdf(bytes) => bytes,
            _ => return Err(PyValueError::new_err("`source` is neither a robot file nor a URDF")),
        };
        let text = String::from_utf8(bytes);
        text.map(|text| (name.clone(), text)).map_err(|_| PyValueError::new_err(format!("{name} is not text in UTF-8")))
    }
}

impl Origin {
    /// Returns this origin with the robot file and the plan of a shipped robot.
    fn shipped(self, file: &rne_robots::RobotFile) -> Self {
        Self { robot: file.yaml.to_owned(), plan: file.plan.map(str::to_owned), ..self }
    }

    /// Reads a robot file with the parameters of this origin, and returns its lints, too.
    pub(crate) fn read(&self, name: &str, text: &[u8]) -> Result<Checked, Report> {
        let names: Vec<&str> = self.run_time.iter().map(String::as_str).collect();
        let reader = Reader::new(name).trees().couplings().loops().run_time(&names);
        let reader = self.settings.iter().fold(reader, |reader, (name, value)| reader.setting(name, *value));
        reader.read(text)
    }
}
