//! The class `Arm`.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use rne::compiled::{CompiledArm, Form, Function, PlanFile};
use rne_codegen::CheckFor as _;
use rne_codegen::{Argument, Compiler};
use rne_model::{Convention, Joint, Robot};

use crate::arrays::{Axes, Given, Value};
use crate::errors::{of_arm, of_evaluation, of_report};
use crate::functions::evaluate;

/// Methods of an arm that differ in what they compute alone: what Python writes for their arguments, the arguments, and
/// then each method with its documentation.
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

/// From what an arm was made: enough to make it again in another process.
#[derive(Clone, Debug, Default)]
pub(crate) struct Origin {
    /// The file that is read, with the plan beside it; its text stands in `robot` afterwards.
    pub(crate) file: Option<PathBuf>,
    pub(crate) robot: String,
    pub(crate) plan: Option<String>,
    pub(crate) form: FormOr,
    pub(crate) rotors: bool,
    pub(crate) run_time: Vec<String>,
    pub(crate) settings: BTreeMap<String, f64>,
    /// Of a URDF: the joints that do not move, and where they stand.
    pub(crate) held: BTreeMap<String, f64>,
    /// Of a URDF: what the import remarks, in sentences.
    pub(crate) notes: Vec<String>,
}

/// A form; the reduced one unless told.
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
            // told again with the name of the file
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

    /// `standard` or `modified`.
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

    /// How many numbers an argument has for a state.
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

    /// A vector of the motion of the base; left out, it is zero, gravity that of the robot.
    pub(crate) fn of_base_motion<'py>(&self, name: &'static str, value: Option<&Bound<'py, PyAny>>) -> Given<'py> {
        let left_out = if name == "base_gravity" { self.robot().gravity } else { [0.0; 3] };
        value.map_or_else(|| Given::own(name, left_out.to_vec()), |value| Given::vector(name, 3, value.clone()))
    }

    /// What the tip carries.
    pub(crate) fn payload<'py>(&self, value: &Bound<'py, PyAny>) -> Given<'py> {
        Given::vector("payload", self.elements(Argument::Payload), value.clone())
    }

    /// The pose of a base: homogeneous matrices, of which functions take twelve numbers.
    pub(crate) fn of_pose<'py>(&self, name: &'static str, value: &Bound<'py, PyAny>) -> PyResult<Given<'py>> {
        Given::matrix(name, Axes::Pose, self.elements(Argument::BasePose), value.clone(), String::new)
    }

    /// A rotation matrix: an array of shape (3, 3) or (N, 3, 3).
    pub(crate) fn of_rotation<'py>(&self, name: &'static str, value: &Bound<'py, PyAny>) -> PyResult<Given<'py>> {
        Given::matrix(name, Axes::Rows(3), self.elements(Argument::BaseRotation), value.clone(), String::new)
    }

    /// A function of joint arrays and whatever else it takes; of a pair of results a tuple.
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

    /// As `compute`, with a frame in the place of the tip.
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
                None => Given::own(name, run_time.values(self.robot())), // those of the file
            }));
        }
        if parameters.is_some() {
            return Err(PyValueError::new_err(
                "this arm has no run-time parameters; `rne.load(…, run_time=[…])` leaves some free",
            ));
        }
        Ok(None)
    }

    /// A program of a function, in a form.
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

/// The function with a name, or a ValueError with those allowed.
pub(crate) fn function_named(text: &str) -> PyResult<Function> {
    rne_codegen::function_named(text).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// What a name says, or a ValueError with those allowed.
pub(crate) fn name<T: std::str::FromStr<Err = rne_codegen::UnknownName>>(text: &str) -> PyResult<T> {
    text.parse().map_err(|error: rne_codegen::UnknownName| PyValueError::new_err(error.to_string()))
}

/// The values of a dict in the order of names; what is no dict is an array already.
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

#[pymethods]
impl Arm {
    /// The robot's name.
    #[getter]
    fn name(&self) -> &str {
        &self.robot().name
    }

    /// Number of joints.
    #[getter]
    fn dof(&self) -> usize {
        self.arm.dof()
    }

    /// Whether the base floats. Functions of a floating base need one.
    #[getter]
    fn floating(&self) -> bool {
        self.robot().floating_base.is_some()
    }

    /// The names of the joints, base to tip. Joints that follow others are not among them: see `followers`.
    #[getter]
    fn joints(&self) -> Vec<&str> {
        self.robot().independent_joints().map(|joint| joint.name.as_str()).collect()
    }

    /// The names of the dependent joints of closed loops, in the order of `passive`.
    #[getter]
    fn passive_joints(&self) -> Vec<&str> {
        self.robot().closed.passive.iter().map(|&joint| self.robot().joints[joint].name.as_str()).collect()
    }

    /// Positions at which the closed loops are closed: a list of pairs of `q` and `passive`, found when the file was
    /// read. They serve as guesses for `close`.
    #[getter]
    fn closures(&self) -> Vec<(Vec<f64>, Vec<f64>)> {
        let robot = self.robot();
        let of = |closure: &[f64], joints: &mut dyn Iterator<Item = usize>| joints.map(|at| closure[at]).collect();
        let closures = robot.closed.closures.iter();
        let pair =
            |it: &Vec<f64>| (of(it, &mut robot.coordinates()), of(it, &mut robot.closed.passive.iter().copied()));
        closures.map(pair).collect()
    }

    /// Closes the loops of a robot from a guess: five steps of Newton's method.
    ///
    /// `q`: shape (n,) or (N, n). `guess`: positions of the dependent joints, shape (p,) or (N, p), or a dict by their
    /// names. Returns the positions of the dependent joints, and what is left of the equations there: shapes (p,) and
    /// (e,), or (N, p) and (N, e). What is left says whether the loops are closed: below 1e-12 from a good guess.
    #[pyo3(signature = (q, guess, *, parameters=None))]
    fn close<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        guess: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let step = |passive: &Bound<'py, PyAny>| {
            let given = vec![self.of_joints("q", q)?, self.of_passive("passive", passive)?];
            self.compute(py, Function::ClosureStep, given, parameters, None)
        };
        let mut passive = guess.clone();
        for _ in 0..5 {
            passive = step(&passive)?.get_item(0)?;
        }
        let residual = step(&passive)?.get_item(1)?;
        Ok(PyTuple::new(py, [passive, residual])?.into_any())
    }

    /// The joints that follow others: a dict of the name of each to the ratios, by the names of the joints that it
    /// follows, and the offset, rad or m: `{"finger_b": ({"finger_a": 1.0}, 0.0)}`. The position of such a joint is the
    /// sum of ratio times position, plus the offset; it has no element in `q` and no torque.
    #[getter]
    fn followers(&self) -> BTreeMap<String, (BTreeMap<String, f64>, f64)> {
        let joints = &self.robot().joints;
        let follower = |joint: &Joint| {
            let coupling = joint.coupling.as_ref()?;
            let ratio = |&(followed, ratio): &(usize, f64)| (joints[followed].name.clone(), ratio);
            Some((joint.name.clone(), (coupling.follows.iter().map(ratio).collect(), coupling.offset)))
        };
        joints.iter().filter_map(follower).collect()
    }

    /// The names of the tips, in the order of arrays of wrenches: the list `tips` of the robot file, or `tip`.
    #[getter]
    fn tips(&self) -> Vec<&str> {
        self.robot().tip_names()
    }

    /// The place of each joint of the arm in a list of joint names of another program, an integer array of shape (n,).
    ///
    /// `order[i]` is the place of joint i in `names`: `q = theirs[arm.order(names)]` has the order of the arm, and
    /// `theirs[arm.order(names)] = q` writes back. For arrays of shape (N, m), write `theirs[:, arm.order(names)]`.
    ///
    /// A joint that is missing or in the list twice is a ValueError. So is a name that is not of this arm, and a joint
    /// that follows others, which has no element in `q`, unless `extra` is True.
    #[pyo3(signature = (names, extra=false))]
    fn order<'py>(&self, names: &Bound<'py, PyAny>, extra: bool) -> PyResult<Bound<'py, PyAny>> {
        let followers: BTreeMap<_, _> = self
            .followers()
            .into_iter()
            .map(|(name, (ratios, _))| (name, ratios.into_keys().collect::<Vec<_>>()))
            .collect();
        names.py().import("rne.names")?.call_method1("order", (self.joints(), names, extra, followers))
    }

    /// `standard` or `modified`: how the rows of the table are read.
    #[getter]
    fn convention(&self) -> &'static str {
        self.rows()
    }

    /// Acceleration of gravity in frame 0, m/s².
    #[getter]
    fn gravity(&self) -> [f64; 3] {
        self.robot().gravity
    }

    /// `reduced` or `seven_steps`.
    #[getter]
    fn form(&self) -> &'static str {
        self.arm.form().name()
    }

    /// Lower and upper ends of the joints' positions, rad or m: shape (n, 2); infinite where the file has none.
    #[getter]
    fn limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let infinite = (f64::NEG_INFINITY, f64::INFINITY);
        let limits: Vec<(f64, f64)> =
            self.robot().coordinate_limits().iter().map(|limits| limits.position.unwrap_or(infinite)).collect();
        py.import("numpy")?.call_method1("array", (limits,))
    }

    /// Largest speeds of the joints, rad/s or m/s: shape (n,); infinite where the file has none.
    #[getter]
    fn velocity_limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let limits: Vec<f64> =
            self.robot().coordinate_limits().iter().map(|limits| limits.velocity.unwrap_or(f64::INFINITY)).collect();
        py.import("numpy")?.call_method1("array", (limits,))
    }

    /// Largest torques or forces of the joints, N m or N: shape (n,); infinite where the file has none.
    #[getter]
    fn effort_limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let limits: Vec<f64> =
            self.robot().coordinate_limits().iter().map(|limits| limits.effort.unwrap_or(f64::INFINITY)).collect();
        py.import("numpy")?.call_method1("array", (limits,))
    }

    /// The text of the robot file; of a URDF, that which was made of it.
    #[getter]
    fn yaml(&self) -> &str {
        &self.origin.robot
    }

    /// The named frames of the robot file: words for the keyword `frame`, beside the joints.
    #[getter]
    fn frames(&self) -> Vec<String> {
        self.robot().frames.iter().map(|frame| frame.name.clone()).collect()
    }

    /// Of an arm from a URDF: remarks of the import, such as which tip was chosen and which links were joined.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.origin.notes.clone()
    }

    /// Of an arm from a URDF: the movable joints that are held still, and where, rad or m.
    #[getter]
    fn held(&self) -> BTreeMap<String, f64> {
        self.origin.held.clone()
    }

    /// The names of the run-time parameters.
    #[getter]
    fn parameters(&self) -> Vec<&str> {
        self.robot().run_time.names.iter().map(String::as_str).collect()
    }

    /// An arm of as many copies is the same arm.
    fn __copy__(&self) -> Self {
        self.clone()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.clone()
    }

    /// From its texts, in whatever process.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let Origin { robot, plan, form, rotors, run_time, settings, held, notes, .. } = (*self.origin).clone();
        let arguments = (robot, plan, form.0.name(), rotors, run_time, settings, held, notes).into_pyobject(py)?;
        Ok((py.import("rne._rne")?.getattr("Arm")?.getattr("_of_texts")?, arguments))
    }

    #[staticmethod]
    fn _of_texts(
        py: Python<'_>,
        robot: String,
        plan: Option<String>,
        form: &str,
        rotors: bool,
        run_time: Vec<String>,
        settings: BTreeMap<String, f64>,
        held: BTreeMap<String, f64>,
        notes: Vec<String>,
    ) -> PyResult<Self> {
        let form = FormOr(name(form)?);
        Self::of(py, Origin { file: None, robot, plan, form, rotors, run_time, settings, held, notes })
    }

    fn __repr__(&self) -> String {
        let robot = self.robot();
        let base = if self.floating() { ", floating base" } else { "" };
        format!("<rne.Arm {}: {} joints{base}, {}, {}>", robot.name, robot.dof(), self.rows(), self.arm.form())
    }
}
