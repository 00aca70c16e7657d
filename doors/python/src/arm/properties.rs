//! Properties of the class `Arm`.

use std::collections::BTreeMap;

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use rne::compiled::Function;
use rne_model::Joint;

use super::{Arm, FormOr, Origin, name};

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
    pub(super) fn joints(&self) -> Vec<&str> {
        self.robot().independent_joints().map(|joint| joint.name.as_str()).collect()
    }

    /// The names of the dependent joints of closed loops, in the order of `passive`.
    #[getter]
    pub(super) fn passive_joints(&self) -> Vec<&str> {
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

    /// Remarks of the import of a URDF, such as which tip was chosen and which links were joined.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.origin.notes.clone()
    }

    /// The movable joints of a URDF that are held still, and their positions, rad or m.
    #[getter]
    fn held(&self) -> BTreeMap<String, f64> {
        self.origin.held.clone()
    }

    /// The names of the run-time parameters.
    #[getter]
    pub(super) fn parameters(&self) -> Vec<&str> {
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
