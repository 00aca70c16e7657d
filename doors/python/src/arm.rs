//! The class `Arm`.

mod properties;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rne::compiled::{CompiledArm, Form, Function, PlanFile};
use rne_codegen::CheckFor as _;
use rne_codegen::{Argument, Compiler};
use rne_model::{Convention, Robot};

use crate::arrays::{Axes, Given, Value};
use crate::errors::{of_arm, of_evaluation, of_report};
use crate::functions::evaluate;

/// Defines methods of `Arm` that differ only in what they compute. It takes the signature and the arguments that all of
/// them have, and then each method with its documentation.
macro_rules! methods {
    ($signature:tt $arguments:tt -> $returned:ty; $($(#[$($about:tt)*])* $method:ident $body:tt)*) => {
        #[pymethods]
        impl Arm {
            $(
                $(#[$($about)*])*
                #[pyo3(signature = $signature)]
                fn $method<'py> $arguments -> $returned $body
            )*
        }
    };
}
pub(crate) use methods;

/// The texts and options from which an arm was made, so that another process can make it again.
#[derive(Clone, Debug, Default)]
pub(crate) struct Origin {
    /// The file to read, with the plan beside it. After reading, its text is in `robot`.
    pub(crate) file: Option<PathBuf>,
    pub(crate) robot: String,
    pub(crate) plan: Option<String>,
    pub(crate) form: FormOr,
    pub(crate) rotors: bool,
    pub(crate) run_time: Vec<String>,
    pub(crate) settings: BTreeMap<String, f64>,
    /// For a URDF: the joints that are locked, and their positions.
    pub(crate) held: BTreeMap<String, f64>,
    /// For a URDF: the remarks of the import, as sentences.
    pub(crate) notes: Vec<String>,
}

/// A form of the code; the default is the reduced one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FormOr(pub(crate) Form);

impl Default for FormOr {
    fn default() -> Self {
        Self(Form::Reduced)
    }
}

impl std::str::FromStr for FormOr {
    type Err = rne_codegen::UnknownName;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.parse().map(Self)
    }
}

/// An arm whose functions are compiled when they are first called.
///
/// Made by `rne.load` or `rne.robots`. Arguments are arrays of the shape `(n,)` for one state or `(N, n)` for many, a
/// single row standing for all; revolute joints in rad, rad/s, rad/s² and N m, prismatic ones in m, m/s, m/s² and N.
/// An argument with a number per joint may be a dict of joint name → number or array (N,).
/// Arrays of float32 are computed in single precision, everything else in double. `out` is an array that the result is
/// written to; it shares no memory with an argument. `parameters` are the run-time parameters, in the order of the
/// property `parameters`, or a dict of them by name.
#[pyclass(frozen, module = "rne")]
#[derive(Clone)]
pub(crate) struct Arm {
    pub(crate) arm: CompiledArm,
    pub(crate) origin: Arc<Origin>,
}

impl Arm {
    pub(crate) fn of(py: Python<'_>, mut origin: Origin) -> PyResult<Self> {
        let name = match origin.file.take() {
            Some(path) => {
                let read = |path: &std::path::Path| {
                    rne_model::read_file(path)
                        .map_err(|error| of_arm(py, &rne::compiled::ArmError::Unreadable { path: path.into(), error }))
                };
                let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
                origin.robot = text(read(&path)?);
                let plan = rne_model::plan_of(&path);
                origin.plan = if plan.exists() { Some(text(read(&plan)?)) } else { None };
                path.display().to_string()
            }
            None => "<text>".to_owned(),
        };
        let is_as_it_stands = origin.run_time.is_empty() && origin.settings.is_empty();
        let arm = if is_as_it_stands {
            let arm = py.detach(|| match &origin.plan {
                Some(plan) => CompiledArm::with_plan(&origin.robot, plan),
                None => CompiledArm::from_yaml(&origin.robot),
            });
            // reported again, with the name of the file
            match arm {
                Ok(arm) => arm,
                Err(error) => {
                    origin.read(&name, origin.robot.as_bytes()).map_err(|report| of_report(py, &report))?;
                    return Err(of_arm(py, &error));
                }
            }
        } else {
            let checked = origin.read(&name, origin.robot.as_bytes()).map_err(|report| of_report(py, &report))?;
            CompiledArm::from_robot(&checked.robot)
        };
        let arm = arm.in_form(origin.form.0);
        let arm = if origin.rotors { arm.with_rotors() } else { arm };
        Ok(Self { arm, origin: Arc::new(origin) })
    }

    pub(crate) fn robot(&self) -> &Robot {
        self.arm.robot()
    }

    /// Returns the convention of the rows: `standard` or `modified`.
    pub(crate) fn rows(&self) -> &'static str {
        match self.robot().convention {
            Convention::Standard => "standard",
            Convention::Modified => "modified",
        }
    }

    /// An argument with a number per joint: an array in the order of the joints, or a dict by their names.
    pub(crate) fn of_joints<'py>(&self, name: &'static str, value: &Bound<'py, PyAny>) -> PyResult<Given<'py>> {
        let value = by_name(value, || self.joints(), name, "joint")?;
        Ok(Given::vector(name, self.arm.dof(), value))
    }

    /// Positions of the dependent joints of closed loops: an array, or a dict by their names.
    pub(crate) fn of_passive<'py>(&self, name: &'static str, value: &Bound<'py, PyAny>) -> PyResult<Given<'py>> {
        let value = by_name(value, || self.passive_joints(), name, "dependent joint")?;
        Ok(Given::vector(name, self.robot().closed.passive.len(), value))
    }

    /// The name that the keyword `frame` has; a TypeError lists the names where it is not a text.
    pub(crate) fn frame_name(&self, frame: &Bound<'_, PyAny>) -> PyResult<String> {
        frame.extract().map_err(|_| {
            let known = self.robot().known_frames();
            let given = frame.repr().map_or_else(|_| "no text".to_owned(), |text| text.to_string());
            PyTypeError::new_err(format!("`frame` is {given}, but it must be the name of a frame: {known}"))
        })
    }

    /// Returns how many numbers an argument has per state.
    pub(crate) fn elements(&self, argument: Argument) -> usize {
        argument.elements(rne_codegen::sizes_of(self.robot()))
    }

    /// A wrench at each tip: a dict by the names of the tips, or an array of shape (tips, 6) or (N, tips, 6). Without
    /// it no tip exerts anything.
    pub(crate) fn of_tips<'py>(&self, name: &'static str, value: Option<&Bound<'py, PyAny>>) -> PyResult<Given<'py>> {
        let (axes, elements) = (Axes::Rows(6), self.elements(Argument::Wrenches));
        let Some(value) = value else {
            let value = Value::Own(vec![0.0; elements]);
            return Ok(Given { name, parts: &[], elements, axes, value });
        };
        let tips = || self.robot().tip_names();
        let value = if let Ok(of_tips) = value.cast::<PyDict>() {
            let names = of_tips.keys().iter().filter_map(|key| key.extract::<String>().ok()).collect::<Vec<_>>();
            if let Some(two) = names.iter().find_map(|tip| self.robot().two_tips(tip)) {
                return Err(PyValueError::new_err(format!("{name}: {two}")));
            }
            value.py().import("rne.names")?.call_method1("of_tips", (value, tips(), name))?
        } else {
            value.clone()
        };
        let known = || format!("; the tips of this arm are {}", tips().join(", "));
        Given::matrix(name, axes, elements, value, known)
    }

    /// A vector of the motion of the base. If it is left out, it is zero; gravity is then that of the robot.
    pub(crate) fn of_base_motion<'py>(&self, name: &'static str, value: Option<&Bound<'py, PyAny>>) -> Given<'py> {
        let left_out = if name == "base_gravity" { self.robot().gravity } else { [0.0; 3] };
        value.map_or_else(|| Given::own(name, left_out.to_vec()), |value| Given::vector(name, 3, value.clone()))
    }

    /// The payload at the tip.
    pub(crate) fn payload<'py>(&self, value: &Bound<'py, PyAny>) -> Given<'py> {
        Given::vector("payload", self.elements(Argument::Payload), value.clone())
    }

    /// The pose of a base, as homogeneous matrices. The compiled functions take twelve numbers of each.
    pub(crate) fn of_pose<'py>(&self, name: &'static str, value: &Bound<'py, PyAny>) -> PyResult<Given<'py>> {
        Given::matrix(name, Axes::Pose, self.elements(Argument::BasePose), value.clone(), String::new)
    }

    /// A rotation matrix: an array of shape (3, 3) or (N, 3, 3).
    pub(crate) fn of_rotation<'py>(&self, name: &'static str, value: &Bound<'py, PyAny>) -> PyResult<Given<'py>> {
        Given::matrix(name, Axes::Rows(3), self.elements(Argument::BaseRotation), value.clone(), String::new)
    }

    /// Computes a function of joint arrays and other arguments. Several results are a tuple.
    pub(crate) fn compute<'py>(
        &self,
        py: Python<'py>,
        function: Function,
        given: Vec<Given<'py>>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute_at(py, None, function, given, parameters, out)
    }

    /// Computes a function as `compute` does, with a frame in the place of the tip.
    pub(crate) fn compute_at<'py>(
        &self,
        py: Python<'py>,
        frame: Option<&Bound<'py, PyAny>>,
        function: Function,
        mut given: Vec<Given<'py>>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        given.extend(self.given_parameters(parameters)?);
        evaluate(py, &self.at(frame)?, function, &given, out)
    }

    /// The argument of the run-time parameters, if the arm has any.
    pub(crate) fn given_parameters<'py>(&self, parameters: Option<&Bound<'py, PyAny>>) -> PyResult<Option<Given<'py>>> {
        let run_time = &self.robot().run_time;
        if !run_time.is_empty() {
            let (name, elements) = ("parameters", run_time.names.len());
            return Ok(Some(match parameters {
                Some(value) => {
                    Given::vector(name, elements, by_name(value, || self.parameters(), name, "run-time parameter")?)
                }
                None => Given::own(name, run_time.values(self.robot())), // the values in the robot file
            }));
        }
        if parameters.is_some() {
            return Err(PyValueError::new_err(
                "this arm has no run-time parameters; `rne.load(…, run_time=[…])` leaves some free",
            ));
        }
        Ok(None)
    }

    /// Compiles a function in a form and returns the program.
    pub(crate) fn program(&self, function: &str, form: Option<&str>) -> PyResult<rne_codegen::Program> {
        let function = function_named(function)?;
        function.check_base(self.robot()).map_err(|error| of_evaluation(&error))?;
        let form = form.map_or(Ok(self.arm.form()), name)?;
        let compiler = Compiler::new(self.robot());
        let compiler = match (&self.origin.plan, self.robot().run_time.is_empty()) {
            (Some(plan), true) if form == Form::Reduced => {
                let plan = PlanFile::read("plan", plan, self.robot()).map_err(|report| of_evaluation(&report))?;
                compiler.with_plans(plan)
            }
            _ => compiler,
        };
        compiler.compile(function, form).map_err(|error| of_evaluation(&error))
    }
}

/// Returns the function with a name, or a ValueError that lists the names that exist.
pub(crate) fn function_named(text: &str) -> PyResult<Function> {
    rne_codegen::function_named(text).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// Parses a name, or returns a ValueError that lists the names that exist.
pub(crate) fn name<T: std::str::FromStr<Err = rne_codegen::UnknownName>>(text: &str) -> PyResult<T> {
    text.parse().map_err(|error: rne_codegen::UnknownName| PyValueError::new_err(error.to_string()))
}

/// Returns the values of a dict in the order of these names. Any other value is taken as an array and returned
/// unchanged.
fn by_name<'a, 'py>(
    value: &Bound<'py, PyAny>,
    names: impl Fn() -> Vec<&'a str>,
    argument: &str,
    kind: &str,
) -> PyResult<Bound<'py, PyAny>> {
    if !value.is_instance_of::<PyDict>() {
        return Ok(value.clone());
    }
    value.py().import("rne.names")?.call_method1("in_order", (value, names(), argument, kind))
}
