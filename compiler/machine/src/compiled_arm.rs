//! An arm whose robot file is read at run time, with all its functions.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use rne_codegen::CheckFor as _;
use rne_codegen::plan::PlanSet;
use rne_codegen::{Algorithm, CompileError, Compiler, Form, Function, Layout, Target};
use rne_model::{FrameId, Reader, Robot, UnknownFrame, plan_of, read_file};
use rne_runtime::VectorUnit;
use rne_runtime::machine::Destination;
use rne_search::PlanFile;

use crate::{Arguments, ArmError, CompiledFunction, EvaluationError, Number};

/// An arm, serial or a tree, that is read when the program runs. It is nearly as fast as code that is generated when
/// the program is built: each function is compiled once, at its first call from any thread, and uses the widest vector
/// unit.
///
/// [`run`](Self::run) computes many states of any function. The methods that are named after the functions compute one
/// state; they have the arguments and results of the methods of `DynArm`. Clones share the compiled functions.
///
/// ```
/// use rne_machine::{Arguments, Array, CompiledArm, Destination, Function};
///
/// let rod = "
/// format: 1
/// name: rod
/// source: own
/// convention: standard
/// gravity: [0, -9.81, 0]
/// joints: [{type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0]}}]
/// ";
/// let arm = CompiledArm::from_yaml(rod)?;
/// let tau = arm.gravity_torques(&[0.0_f64])?;
/// assert!((tau[0] - 2.5 * 9.81 * 0.4).abs() < 1e-12);
///
/// let q = [0.0, 0.1, 0.2]; // rad, three states
/// let mut many = [0.0; 3];
/// arm.run(Function::GravityTorques, 3, &Arguments::new().q(Array::Rows(&q)), Destination::Rows(&mut many))?;
/// assert_eq!(many[0], tau[0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct CompiledArm(Arc<Compiled>);

#[derive(Debug)]
struct Compiled {
    robot: Robot,
    form: Form,
    /// The plan file, if one was given.
    file: Option<PlanFile>,
    /// The plans of the plan file, or those that were chosen when a function first needed them.
    plans: OnceLock<PlanSet>,
    functions: Box<[OnceLock<Result<CompiledFunction, CompileError>>]>,
    /// This arm at other frames, for each frame for which it was requested.
    at: Mutex<Vec<(FrameId, CompiledArm)>>,
}

/// The arms that were read before, the latest last, with the text from which they were read: if the same text is read
/// again, the same arm is returned, with its compiled functions.
static READ: Mutex<VecDeque<(Content, CompiledArm)>> = Mutex::new(VecDeque::new());

/// Largest number of arms in `READ`.
const KEPT: usize = 32;

#[derive(Clone, Debug, PartialEq, Eq)]
struct Content {
    robot: Vec<u8>,
    plan: Option<Vec<u8>>,
}

/// The bytes of a robot file and of the plan file next to it, if there is one, at the time when they were read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotFiles {
    path: PathBuf,
    robot: Vec<u8>,
    plan: Option<Vec<u8>>,
}

impl RobotFiles {
    /// Reads both files. A relative `path` starts at the working directory.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ArmError> {
        let path = path.as_ref().to_owned();
        let read = |path: &Path| read_file(path).map_err(|error| ArmError::Unreadable { path: path.to_owned(), error });
        let robot = read(&path)?;
        let beside = plan_of(&path);
        let plan = if beside.exists() { Some(read(&beside)?) } else { None };
        Ok(Self { path, robot, plan })
    }

    /// Returns the bytes of the robot file.
    #[must_use]
    pub fn robot(&self) -> &[u8] {
        &self.robot
    }

    /// Returns the bytes of the plan file; `None` without such a file.
    #[must_use]
    pub fn plan(&self) -> Option<&[u8]> {
        self.plan.as_deref()
    }
}

impl CompiledArm {
    /// Reads an arm from the text of a robot file. If this process has read the same text before, returns that arm at
    /// once.
    ///
    /// # Errors
    /// When the text is not a valid robot file; the report lists all mistakes.
    pub fn from_yaml(text: &str) -> Result<Self, ArmError> {
        Self::read("robot file", Content { robot: text.into(), plan: None }, "")
    }

    /// Reads an arm from a robot file, with the choices of the plan file next to it, if there is one. A relative `path`
    /// starts at the working directory.
    ///
    /// # Errors
    /// When a file cannot be read or is not valid; the report lists all mistakes.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, ArmError> {
        Self::from_files(&RobotFiles::read(path)?)
    }

    /// Reads an arm from files that were read before; for callers that also need their bytes, such as for a hash.
    ///
    /// # Errors
    /// When a file is not valid; the report lists all mistakes.
    pub fn from_files(files: &RobotFiles) -> Result<Self, ArmError> {
        let RobotFiles { path, robot, plan } = files;
        let content = Content { robot: robot.clone(), plan: plan.clone() };
        Self::read(&path.display().to_string(), content, &plan_of(path).display().to_string())
    }

    /// Reads an arm from the text of a robot file, with the choices of the text of its plan file.
    ///
    /// # Errors
    /// When a text is not valid; the report lists all mistakes.
    pub fn with_plan(robot: &str, plan: &str) -> Result<Self, ArmError> {
        Self::read("robot file", Content { robot: robot.into(), plan: Some(plan.into()) }, "plan")
    }

    fn read(name: &str, content: Content, name_of_plan: &str) -> Result<Self, ArmError> {
        let known = |read: &VecDeque<(Content, Self)>| {
            read.iter().find(|(other, _)| *other == content).map(|(_, arm)| arm.clone())
        };
        if let Some(arm) = known(&READ.lock().unwrap_or_else(PoisonError::into_inner)) {
            return Ok(arm);
        }
        let robot = Reader::new(name).trees().couplings().loops().read(&content.robot)?.robot;
        let plan = match &content.plan {
            Some(plan) => Some(PlanFile::read(name_of_plan, &String::from_utf8_lossy(plan), &robot)?),
            None => None,
        };
        let arm = Self::new(robot, Form::Reduced, plan, None);
        let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
        // another thread may have read it meanwhile; then both return the same arm
        if let Some(arm) = known(&read) {
            return Ok(arm);
        }
        if read.len() == KEPT {
            read.pop_front();
        }
        read.push_back((content, arm.clone()));
        Ok(arm)
    }

    /// Returns the arm of a robot that was read in another way, such as with run-time parameters.
    #[must_use]
    pub fn from_robot(robot: &Robot) -> Self {
        Self::new(robot.clone(), Form::Reduced, None, None)
    }

    /// Returns a new arm. `plans` are plans that were chosen before; they are used if there is no plan file.
    fn new(robot: Robot, form: Form, file: Option<PlanFile>, plans: Option<PlanSet>) -> Self {
        let plans = file.clone().map(PlanSet::from).or(plans).map_or_else(OnceLock::new, OnceLock::from);
        let functions = Function::ALL.iter().map(|_| OnceLock::new()).collect();
        Self(Arc::new(Compiled { robot, form, file, plans, functions, at: Mutex::default() }))
    }

    /// Returns this arm in another form. The default is the reduced form, with the fewest operations.
    #[must_use]
    pub fn in_form(&self, form: Form) -> Self {
        if form == self.0.form {
            return self.clone();
        }
        let Compiled { robot, file, plans, .. } = &*self.0;
        Self::new(robot.clone(), form, file.clone(), plans.get().cloned())
    }

    /// Returns this arm with the choices of a plan file, such as the result of a search.
    #[must_use]
    pub fn by_plan(&self, plan: PlanFile) -> Self {
        Self::new(self.0.robot.clone(), self.0.form, Some(plan), None)
    }

    /// Returns the plan file with whose choices the arm is compiled: one that was read, or the result of a
    /// [search](Self::search).
    #[must_use]
    pub fn plan(&self) -> Option<&PlanFile> {
        self.0.file.as_ref()
    }

    /// Returns this arm with the inertia of its motors' rotors in every function that it affects.
    #[must_use]
    pub fn with_rotors(&self) -> Self {
        let Compiled { robot, form, file, plans, .. } = &*self.0;
        Self::new(robot.clone().with_rotors(), *form, file.clone(), plans.get().cloned())
    }

    /// Returns this arm with a frame in the place of the tip: the functions that are about a frame, such as
    /// [`jacobian`](Self::jacobian), are then about this frame. Other functions do not change. `name` is that of a
    /// frame in the list `frames` of the robot file, or that of a joint for its link frame. If the same frame is
    /// requested again, the same arm is returned, with its compiled functions.
    ///
    /// # Errors
    /// When neither a frame nor a joint has this name.
    pub fn at_frame(&self, name: &str) -> Result<Self, UnknownFrame> {
        let Compiled { robot, form, file, plans, at, .. } = &*self.0;
        let frame = robot.frame(name)?;
        let mut at = at.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, arm)) = at.iter().find(|(other, _)| *other == frame) {
            return Ok(arm.clone());
        }
        let arm = Self::new(robot.clone().at_frame(frame), *form, file.clone(), plans.get().cloned());
        at.push((frame, arm.clone()));
        Ok(arm)
    }

    /// Returns the robot.
    #[must_use]
    pub fn robot(&self) -> &Robot {
        &self.0.robot
    }

    /// Returns the number of joints.
    #[must_use]
    pub fn dof(&self) -> usize {
        self.0.robot.dof()
    }

    /// Returns the shape of a function's result for this arm.
    #[must_use]
    pub fn layout(&self, function: Function) -> Layout {
        function.layout(rne_codegen::sizes_of(&self.0.robot))
    }

    /// Returns the form in which its functions are computed.
    #[must_use]
    pub fn form(&self) -> Form {
        self.0.form
    }

    /// Returns a function; it is compiled now if it was not before.
    ///
    /// # Errors
    /// When the function cannot be compiled for this robot: for example if its numbers overflow, or if the function
    /// needs a floating base and the file has none.
    pub fn function(&self, function: Function) -> Result<&CompiledFunction, EvaluationError> {
        let Compiled { robot, form, file, plans, functions, .. } = &*self.0;
        let compiled = functions[function as usize].get_or_init(|| {
            function.check_for(robot)?;
            let mut compiler = Compiler::new(robot).for_target(Target::Throughput);
            // a function that does not depend on plans does not choose them, which takes time
            if *form == Form::Reduced && (file.is_some() || Algorithm::is_planned(function)) {
                compiler = compiler.with_plans(plans.get_or_init(|| PlanSet::default_of(robot)).clone());
            }
            CompiledFunction::new(compiler.compile(function, *form)?)
        });
        compiled.as_ref().map_err(|error| error.clone().into())
    }

    /// Computes a function for a number of states on the widest vector unit.
    ///
    /// The numbers of a result are in the order of the function's [layout](Function::layout), matrices row by row.
    ///
    /// # Errors
    /// When the function cannot be compiled, when an argument is missing, has another size or is [out of
    /// range](crate::OutOfRange), or when `results` has another size.
    pub fn run<T: Number>(
        &self,
        function: Function,
        states: usize,
        arguments: &Arguments<'_, T>,
        results: Destination<'_, T>,
    ) -> Result<(), EvaluationError> {
        self.function(function)?.run(VectorUnit::widest(), states, arguments, results)
    }
}

impl From<&Robot> for CompiledArm {
    fn from(robot: &Robot) -> Self {
        Self::from_robot(robot)
    }
}
