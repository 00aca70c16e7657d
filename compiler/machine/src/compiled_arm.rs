//! An arm that is known at run time only, with all its functions.

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

/// An arm, serial or a tree, that is read when the program runs, and computes nearly as fast as one that is derived:
/// every function is compiled when it is first called, once, from whatever thread, and runs on the widest vector unit.
///
/// [`run`](Self::run) computes many states of any function. The methods with the functions' own names compute one, and
/// take and return what `DynArm` does. Clones share what has been compiled.
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
    /// Plans of the plan file, or plans that are chosen at the first use.
    plans: OnceLock<PlanSet>,
    functions: Box<[OnceLock<Result<CompiledFunction, CompileError>>]>,
    /// This arm at the frames that were asked for.
    at: Mutex<Vec<(FrameId, CompiledArm)>>,
}

/// Arms that were read before, the latest last, by what was read: the same text gives the same arm, compiled.
static READ: Mutex<VecDeque<(Content, CompiledArm)>> = Mutex::new(VecDeque::new());

/// How many of them are kept.
const KEPT: usize = 32;

#[derive(Clone, Debug, PartialEq, Eq)]
struct Content {
    robot: Vec<u8>,
    plan: Option<Vec<u8>>,
}

/// A robot file and the plan file beside it, where there is one, as they were when they were read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotFiles {
    path: PathBuf,
    robot: Vec<u8>,
    plan: Option<Vec<u8>>,
}

impl RobotFiles {
    /// Reads both. A relative `path` starts at the working directory.
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

    /// The bytes of the robot file.
    #[must_use]
    pub fn robot(&self) -> &[u8] {
        &self.robot
    }

    /// The bytes of the plan file.
    #[must_use]
    pub fn plan(&self) -> Option<&[u8]> {
        self.plan.as_deref()
    }
}

impl CompiledArm {
    /// The arm of the text of a robot file. An arm that this process has read before is there at once.
    ///
    /// # Errors
    /// Everything that is wrong with the text.
    pub fn from_yaml(text: &str) -> Result<Self, ArmError> {
        Self::read("robot file", Content { robot: text.into(), plan: None }, "")
    }

    /// The arm of a robot file, by the choices of its plan file where there is one beside it. A relative `path` starts
    /// at the working directory.
    ///
    /// # Errors
    /// When a file cannot be read, or everything that is wrong with it.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, ArmError> {
        Self::from_files(&RobotFiles::read(path)?)
    }

    /// The arm of files that have been read: for who asks for their bytes besides, of a hash say.
    ///
    /// # Errors
    /// Everything that is wrong with them.
    pub fn from_files(files: &RobotFiles) -> Result<Self, ArmError> {
        let RobotFiles { path, robot, plan } = files;
        let content = Content { robot: robot.clone(), plan: plan.clone() };
        Self::read(&path.display().to_string(), content, &plan_of(path).display().to_string())
    }

    /// The arm of the text of a robot file, by the choices of the text of its plan file.
    ///
    /// # Errors
    /// Everything that is wrong with the texts.
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
        // another thread may have read it meanwhile: one arm for all
        if let Some(arm) = known(&read) {
            return Ok(arm);
        }
        if read.len() == KEPT {
            read.pop_front();
        }
        read.push_back((content, arm.clone()));
        Ok(arm)
    }

    /// The arm of a robot file that has been read otherwise, with parameters that stay free, say.
    #[must_use]
    pub fn from_robot(robot: &Robot) -> Self {
        Self::new(robot.clone(), Form::Reduced, None, None)
    }

    /// `plans` are those that were chosen before, where no file has them.
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

    /// The plan file by which it is compiled: one that was read, or that a [search](Self::search) has found.
    #[must_use]
    pub fn plan(&self) -> Option<&PlanFile> {
        self.0.file.as_ref()
    }

    /// Returns this arm with the rotors of its motors in every function that they affect.
    #[must_use]
    pub fn with_rotors(&self) -> Self {
        let Compiled { robot, form, file, plans, .. } = &*self.0;
        Self::new(robot.clone().with_rotors(), *form, file.clone(), plans.get().cloned())
    }

    /// Returns this arm with a frame in the place of the tip: the functions of a frame, such as
    /// [`jacobian`](Self::jacobian), are those of the frame. Other functions stay those of the tip. `name` is that of a
    /// frame in the list `frames` of the robot file, or that of a joint for its link frame. The same frame asked for
    /// again gives the same arm, compiled.
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

    /// The table.
    #[must_use]
    pub fn robot(&self) -> &Robot {
        &self.0.robot
    }

    /// Number of joints.
    #[must_use]
    pub fn dof(&self) -> usize {
        self.0.robot.dof()
    }

    /// The shape of what a function returns for this arm.
    #[must_use]
    pub fn layout(&self, function: Function) -> Layout {
        function.layout(rne_codegen::sizes_of(&self.0.robot))
    }

    /// How its functions are computed.
    #[must_use]
    pub fn form(&self) -> Form {
        self.0.form
    }

    /// A function, compiled now if it has not been before.
    ///
    /// # Errors
    /// When it cannot be compiled for this robot: its numbers overflow, say; when it needs a floating base, and the
    /// file has none.
    pub fn function(&self, function: Function) -> Result<&CompiledFunction, EvaluationError> {
        let Compiled { robot, form, file, plans, functions, .. } = &*self.0;
        let compiled = functions[function as usize].get_or_init(|| {
            function.check_for(robot)?;
            let mut compiler = Compiler::new(robot).for_target(Target::Throughput);
            // what has no plan does not wait until one is found
            if *form == Form::Reduced && (file.is_some() || Algorithm::is_planned(function)) {
                compiler = compiler.with_plans(plans.get_or_init(|| PlanSet::default_of(robot)).clone());
            }
            CompiledFunction::new(compiler.compile(function, *form)?)
        });
        compiled.as_ref().map_err(|error| error.clone().into())
    }

    /// Computes a function for a number of states on the widest vector unit.
    ///
    /// The numbers of a result stand in the order of the function's [layout](Function::layout), matrices row by row.
    ///
    /// # Errors
    /// When the function cannot be compiled, an argument is missing, has another size or is
    /// [out of range](crate::OutOfRange), or when the room for the results has another size.
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
