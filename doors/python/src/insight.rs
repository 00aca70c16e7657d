//! Methods of the class `Arm` about its code: annotated and generated code, counts of operations, parameters, likely
//! mistakes in another tool's torques, better plans, and pages.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use pyo3::exceptions::{PyIndexError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rne::DynArm;
use rne::compiled::SearchOptions;
use rne_codegen::{Form, Order, Program, ordered_for_registers};
use rne_diagnose::{Diagnosis, Observation};
use rne_emit::{Additions, Precision, Prefix, Selection};

use crate::arm::{Arm, Origin, function_named, name};
use crate::arrays::refuse_masked;
use crate::errors::of_evaluation;
use crate::notebook;

/// Returns an array of numpy with ten numbers in each row.
fn rows(py: Python<'_>, parameters: Vec<[f64; 10]>) -> PyResult<Bound<'_, PyAny>> {
    let parameters: Vec<Vec<f64>> = parameters.into_iter().map(Vec::from).collect();
    py.import("numpy")?.call_method1("array", (parameters,))
}

/// Returns an error for a method that is a composition of several functions, and says how to get it in CasADi.
fn is_no_composition(function: &str) -> PyResult<()> {
    let instead = match function {
        "runge_kutta_step" | "runge_kutta_step_derivatives" => {
            "CasADi composes a step of Runge-Kutta from `arm.casadi(\"forward_dynamics\")`; a step of \
             Euler's method is a function by itself"
        }
        "floating_runge_kutta_step" | "floating_runge_kutta_step_derivatives" => {
            "it takes and returns poses, and CasADi calls functions of vectors"
        }
        "friction_torques" | "friction_derivatives" => {
            "write the law of friction with CasADi's own operations; `arm.friction_torques` has its formula"
        }
        _ => return Ok(()),
    };
    Err(PyValueError::new_err(format!("there is no code of `{function}` for CasADi: {instead}")))
}

impl Arm {
    /// Adds the functions from which CasADi's derivatives of these functions are computed, each once.
    fn add_derivatives(functions: &mut Vec<String>) -> PyResult<()> {
        for asked in functions.clone() {
            for needed in rne_emit::casadi_derivatives(function_named(&asked)?) {
                if !functions.iter().any(|other| other == needed.name()) {
                    functions.push(needed.name().to_owned());
                }
            }
        }
        Ok(())
    }
}

#[pymethods]
impl Arm {
    /// The inertial parameters of the links, as `regressor` counts them: shape (n, 10).
    fn inertial_parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        rows(py, DynArm::from_robot(self.robot()).inertial_parameters())
    }

    /// The inertial parameters of the base, then of the links, as `floating_regressor` counts them: shape (n + 1, 10).
    /// Those of the base are zeros where the robot file has no `floating_base`.
    fn floating_inertial_parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        rows(py, DynArm::from_robot(self.robot()).floating_inertial_parameters())
    }

    /// What the torques can see of the links: a list of dicts with `name`, `value`, `combination`, a dict of
    /// coefficients by parameter, and `visible`: whether torques in double precision tell it from the others, to 1e-10.
    fn base_parameters<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        const NAMES: [&str; 10] = ["m", "mcx", "mcy", "mcz", "Jxx", "Jxy", "Jxz", "Jyy", "Jyz", "Jzz"];
        let named = |parameter: &rne::LinkParameter| format!("{}_{}", NAMES[parameter.index], parameter.link + 1);
        let base = py.detach(|| DynArm::from_robot(self.robot()).base_parameters());
        base.parameters
            .iter()
            .map(|parameter| {
                let (found, combination) = (PyDict::new(py), PyDict::new(py));
                combination.set_item(named(&parameter.kept), 1.0)?;
                for (coefficient, regrouped) in &parameter.regrouped {
                    combination.set_item(named(regrouped), coefficient)?;
                }
                found.set_item("name", named(&parameter.kept))?;
                found.set_item("value", parameter.value)?;
                found.set_item("visible", parameter.is_visible)?;
                found.set_item("combination", combination)?;
                Ok(found)
            })
            .collect()
    }

    /// Multiplications, additions, divisions, sines and statements of a function: a dict.
    #[pyo3(signature = (function="inverse_dynamics", form=None))]
    fn operations<'py>(&self, py: Python<'py>, function: &str, form: Option<&str>) -> PyResult<Bound<'py, PyDict>> {
        let counts = self.program(function, form)?.operations();
        let found = PyDict::new(py);
        for (name, count) in [
            ("mul", counts.mul),
            ("add", counts.add),
            ("div", counts.div),
            ("sincos", counts.sincos),
            ("statements", counts.statements),
            ("total", counts.total()),
        ] {
            found.set_item(name, count)?;
        }
        Ok(found)
    }

    /// The annotated code of a function, all of it or a joint's, from 1: the seven steps unless told otherwise.
    #[pyo3(signature = (function="inverse_dynamics", *, joint=None, form="seven_steps"))]
    fn show(&self, function: &str, joint: Option<usize>, form: &str) -> PyResult<String> {
        if let Some(joint) = joint
            && !(1..=self.arm.dof()).contains(&joint)
        {
            return Err(PyIndexError::new_err(format!("joints are 1 to {}, not {joint}", self.arm.dof())));
        }
        let program = self.program(function, Some(form))?;
        let what = Selection { joint, explain: true, ..Selection::default() };
        Ok(rne_emit::listing(self.robot(), &program, what).to_string())
    }

    /// A function as code that needs nothing: `language` is `c` (a header and a source in one text) or `rust`.
    ///
    /// `precision`: of C, `double` or `single`. `casadi`: of C in double precision, add the functions that CasADi
    /// calls, with derivatives, and the functions that these need. `order`: the order of the statements of reduced
    /// forms, joint by joint (`formulas`) or so that few values are alive at once (`registers`), which is faster where
    /// code is long.
    #[pyo3(signature = (
        language="c", functions=vec!["inverse_dynamics".to_owned()], *, form=None, precision="double", casadi=false,
        order="formulas",
    ))]
    #[allow(clippy::too_many_arguments)] // those of Python
    fn code(
        &self,
        language: &str,
        mut functions: Vec<String>,
        form: Option<&str>,
        precision: &str,
        casadi: bool,
        order: &str,
    ) -> PyResult<String> {
        if casadi {
            if (language, precision) != ("c", "double") {
                return Err(PyValueError::new_err("`casadi=True` is for C in double precision"));
            }
            if let Some(parameter) = self.robot().run_time.names.first() {
                return Err(PyValueError::new_err(format!(
                    "this arm has run-time parameters, such as `{parameter}`, and the functions that CasADi calls have \
                     none: load the robot file without `run_time`"
                )));
            }
            functions.iter().try_for_each(|function| is_no_composition(function))?;
            Self::add_derivatives(&mut functions)?;
        }
        let order: Order = name(order)?;
        if order == Order::Registers && form == Some(Form::SevenSteps.name()) {
            return Err(PyValueError::new_err(
                "`order=\"registers\"` is for `form=\"reduced\"`: code of the seven steps keeps their order",
            ));
        }
        let in_order = |program: Program| match order {
            Order::Registers => ordered_for_registers(&program),
            Order::Formulas => program,
        };
        let programs = functions.iter().map(|name| self.program(name, form).map(in_order));
        let programs = programs.collect::<PyResult<Vec<_>>>()?;
        if casadi && !programs.iter().any(rne_emit::is_for_casadi) {
            return Err(PyValueError::new_err(
                "CasADi cannot call this: it calls functions that take vectors and return a number, a vector or a \
                 matrix, such as inverse_dynamics. Derivatives come from these, such as \
                 `arm.casadi(\"forward_dynamics\").jacobian()`",
            ));
        }
        let prefix = Prefix::of(self.robot());
        if let Some(name) = rne_emit::casadi_collision(&programs, &prefix).filter(|_| casadi) {
            return Err(PyValueError::new_err(format!(
                "two functions would have the name {name}: one for CasADi, and one of C, whose names begin with the \
                 robot's name. Give the robot another `name`",
            )));
        }
        let precision = precision_named(precision)?;
        let additions = Additions { casadi, ..Additions::default() };
        match language {
            "rust" => Ok(rne_emit::rust_file_with_sin_cos(self.robot(), &programs)),
            "c" => rne_emit::c_code_with(self.robot(), &programs, precision, &prefix, &additions)
                .map(|code| code.one_file())
                .map_err(|error| of_evaluation(&error)),
            other => Err(PyValueError::new_err(format!("`{other}` is not a language; write c or rust"))),
        }
    }

    /// A function as a `casadi.Function`, with its derivatives for optimisers such as IPOPT.
    ///
    /// A compiler of C, `$CC` or cc, gcc or clang, compiles its code once, to a library in the user's cache folder (the
    /// variable RNE_CACHE names another). Inputs and outputs have the names, order and units of the function.
    /// `inverse_dynamics`, `forward_dynamics`, `gravity_torques`, `bias_torques` and `euler_step` have Jacobians,
    /// forward and reverse derivatives by all inputs, computed without finite differences; other functions have none,
    /// and CasADi refuses to derive them. These five have second derivatives, too: the Hessian of their results times
    /// multipliers. Needs the package casadi, 3.6 or later.
    #[pyo3(signature = (function="inverse_dynamics"))]
    fn casadi<'py>(slf: &Bound<'py, Self>, function: &str) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("rne.optimal_control")?.call_method1("external", (slf, function))
    }

    /// Why another tool's torques differ: the usual slips that give them, the likeliest first.
    ///
    /// Arguments are of one state, shape (n,). Returns a dict: `agrees`, `error` (in parts of the largest torque) and
    /// `explanations`, each a list of sentences with what is right. If the list is empty, `nearest` is a tuple: the
    /// mistake that comes nearest, and the error that remains; or None. `tolerance`, in parts of the largest torque,
    /// says how far each torque may be off; by default by half of the last digit of its shortest decimal, 14.5 by
    /// 0.05, and by 1e-6 of the largest torque at least.
    #[pyo3(signature = (q, qd, qdd, tau, *, tolerance=None))]
    fn diagnose<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
        tolerance: Option<f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let numbers = |name: &str, value: &Bound<'py, PyAny>| -> PyResult<Vec<f64>> {
            refuse_masked(name, value)?;
            value.extract().map_err(|_| PyTypeError::new_err(format!("`{name}` is not a sequence of real numbers")))
        };
        let (q, qd, qdd) = (numbers("q", q)?, numbers("qd", qd)?, numbers("qdd", qdd)?);
        let tau = numbers("tau", tau)?;
        let largest = tau.iter().fold(0.0, |largest: f64, tau| largest.max(tau.abs()));
        let half = |tau: f64| rne_model::half_of_last_digit(&rne_model::exact_digits(tau));
        let of_digits = |tau: &f64| if *tau == 0.0 { 0.0 } else { half(*tau) }.max(1e-6 * largest);
        let resolution = match tolerance {
            Some(tolerance) => vec![tolerance * largest; tau.len()],
            None => tau.iter().map(of_digits).collect(),
        };
        let seen = Observation { q, qd, qdd, wrench: None, tau, resolution };
        let robot = self.robot();
        let diagnosis = py.detach(|| rne_diagnose::diagnose(robot, std::slice::from_ref(&seen)));
        let diagnosis = diagnosis.map_err(|error| PyValueError::new_err(error.to_string()))?;
        let found = PyDict::new(py);
        let (agrees, error, explanations) = match &diagnosis {
            Diagnosis::Agrees(error) => (true, *error, Vec::new()),
            Diagnosis::Unexplained(error) => (false, *error, Vec::new()),
            Diagnosis::Explained(all) => {
                let sentences = all.iter().map(|explanation| {
                    let of_slip =
                        |slip: &rne_diagnose::Slip| format!("{}; right: {}", slip.says(robot), slip.right(robot));
                    explanation.slips.iter().map(of_slip).collect::<Vec<_>>()
                });
                (false, all.first().map_or(0.0, |first| first.error), sentences.collect())
            }
        };
        found.set_item("agrees", agrees)?;
        found.set_item("error", error)?;
        found.set_item("explanations", explanations)?;
        let nearest = match diagnosis {
            Diagnosis::Unexplained(_) => py.detach(|| rne_diagnose::near_miss(robot, std::slice::from_ref(&seen))),
            _ => Ok(None),
        };
        let nearest = nearest.map_err(|error| PyValueError::new_err(error.to_string()))?;
        let nearest = nearest.map(|near| (format!("{}; right: {}", near.says(robot), near.right(robot)), near.error));
        found.set_item("nearest", nearest)?;
        Ok(found)
    }

    /// Look for fewer operations for so many seconds; the arm that was found, proved to be the same.
    ///
    /// `functions` are rewritten besides. `progress`, a function of the share of the time that is over and the count of
    /// operations, is called now and then; Ctrl-C ends the search with what it has.
    #[pyo3(signature = (seconds=10.0, *, functions=Vec::new(), seed=0, progress=None))]
    fn search(
        &self,
        py: Python<'_>,
        seconds: f64,
        functions: Vec<String>,
        seed: u64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        if !(0.0..=1e6).contains(&seconds) {
            return Err(PyValueError::new_err("`seconds` is a time from 0 to 1e6"));
        }
        if !self.robot().run_time.is_empty() {
            return Err(PyValueError::new_err("an arm with run-time parameters has no plan"));
        }
        let rewrite = functions.iter().map(|function| function_named(function)).collect::<PyResult<_>>()?;
        let options = SearchOptions { rewrite, seed };
        let mut told = Instant::now();
        let mut failed = None;
        let found = py.detach(|| {
            self.arm.search(Duration::from_secs_f64(seconds), &options, |so_far| {
                if told.elapsed().as_millis() >= 100 {
                    told = Instant::now();
                    Python::attach(|py| {
                        if py.check_signals().is_err() {
                            // after Ctrl-C the search ends, but the best plan so far is still returned
                            failed = Some(Ok(()));
                        } else if let Some(progress) = &progress
                            && let Err(error) = progress.call1(py, (so_far.share, so_far.operations))
                        {
                            failed = Some(Err(error));
                        }
                    });
                }
                if failed.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })
        });
        if let Some(Err(error)) = failed {
            return Err(error);
        }
        let found = found.map_err(|error| of_evaluation(&error))?;
        let plan = found.plan().map(rne::compiled::PlanFile::to_yaml);
        Self::of(py, Origin { plan, ..(*self.origin).clone() })
    }

    /// The page of `rne report`: one file of HTML that needs no network.
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        let function = rne_codegen::function_of_plan(self.robot()).to_string();
        let reduced = self.program(&function, Some("reduced"))?;
        py.detach(|| rne_report::page(self.robot(), Some(&reduced))).map_err(|error| of_evaluation(&error))
    }

    /// The table, the counts, and the code of the torques joint by joint with what folded, for notebooks; the page that
    /// `report` makes, which moves, is too large for a cell.
    fn _repr_html_(&self) -> PyResult<String> {
        notebook::cell(self.robot(), self.rows(), |function, form| self.program(function, Some(form)))
    }
}

fn precision_named(precision: &str) -> PyResult<Precision> {
    match precision {
        "double" => Ok(Precision::Double),
        "single" => Ok(Precision::Single),
        other => Err(PyValueError::new_err(format!("`{other}` is not a precision; write double or single"))),
    }
}
