//! An arm whose functions are computed by the runtime or by generated code: the same properties hold of both.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::{Mutex, OnceLock};

use rne::{BaseMotion, BaseTwist, DynArm, DynTorqueDerivatives, Numbers, Payload, Pose, Scalar, Wrench};
use rne_codegen::plan::PlanSet;
use rne_codegen::{Arguments, Compiler, Form, Function, Interpreter, Program, Real};
use rne_model::{Reader, Robot};
use rne_runtime::Inputs;
use rne_search::PlanFile;

use crate::check::{ROOT, flat};

/// Who computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Maker {
    /// The generic recursion.
    Runtime,
    /// Generated code of a form, interpreted.
    Code(Form),
}

impl Maker {
    pub(crate) const ALL: [Self; 3] = [Self::Runtime, Self::Code(Form::SevenSteps), Self::Code(Form::Reduced)];
    pub(crate) const CODE: [Self; 2] = [Self::Code(Form::SevenSteps), Self::Code(Form::Reduced)];
}

impl fmt::Display for Maker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Runtime => f.pad("runtime"),
            Self::Code(form) => f.pad(form.name()),
        }
    }
}

/// What functions are asked with; what is not used may be empty.
#[derive(Clone, Copy)]
pub(crate) struct Given<'a, T> {
    pub(crate) q: &'a [T],
    pub(crate) qd: &'a [T],
    pub(crate) qdd: &'a [T],
    pub(crate) tau: &'a [T],
    pub(crate) wrench: Wrench<T>,
    pub(crate) payload: Payload<T>,
    pub(crate) base: BaseMotion<T>,
    pub(crate) base_rotation: [[T; 3]; 3],
    pub(crate) step: T,
}

impl<'a, T: Scalar> Given<'a, T> {
    pub(crate) fn of_joints(q: &'a [T], qd: &'a [T], qdd: &'a [T]) -> Self {
        let zero = [T::zero(); 3];
        let (wrench, payload) = (Wrench::zero(), Payload::none());
        let base = BaseMotion::fixed(zero);
        Self { q, qd, qdd, tau: &[], wrench, payload, base, base_rotation: base_rotation(), step: T::from_f64(STEP) }
    }

    /// The velocity of a floating base.
    pub(crate) fn twist(&self) -> BaseTwist<T> {
        BaseTwist { linear: self.base.velocity, angular: self.base.omega }
    }

    /// Where this base stands: no function takes a pose and a gravity, so that they share their numbers.
    pub(crate) fn pose(&self) -> Pose<T> {
        Pose { rotation: self.base_rotation, translation: self.base.gravity }
    }

    /// At a pose of the base.
    pub(crate) fn at(self, pose: &Pose<T>) -> Self {
        let base = BaseMotion { gravity: pose.translation, ..self.base };
        Self { base, base_rotation: pose.rotation, ..self }
    }
}

/// A rotation none of whose angles is a right one.
pub(crate) fn base_rotation<T: Scalar>() -> [[T; 3]; 3] {
    [[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]].map(|row| row.map(T::from_f64))
}

/// The duration of a step, s: exact in single precision.
pub(crate) const STEP: f64 = 0.03125;

/// A scalar of the runtime as a number of the interpreter.
#[derive(Clone, Copy)]
pub(crate) struct Number<T>(pub(crate) T);

impl<T: Scalar> Neg for Number<T> {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident)*) => {$(
        impl<T: Scalar> $operator for Number<T> {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                Self($operator::$method(self.0, other.0))
            }
        }
    )*};
}

operators! { Add add Sub sub Mul mul Div div }

impl<T: Scalar> Real for Number<T> {
    fn by_sign(self, positive: Self, negative: Self) -> Self {
        Self(self.0.by_sign(positive.0, negative.0))
    }
}

/// The functions of a robot in a form, each compiled when it is first asked for.
struct Code {
    form: Form,
    plans: OnceLock<PlanSet>,
    functions: Vec<OnceLock<(Program, Interpreter)>>,
}

/// An arm.
pub(crate) struct Arm {
    pub(crate) robot: Robot,
    pub(crate) runtime: DynArm,
    code: Option<Code>,
}

impl Arm {
    /// By the choices of a build without a plan file.
    pub(crate) fn new(robot: &Robot, maker: Maker) -> Self {
        let functions = || Function::OF_TREES.iter().map(|_| OnceLock::new()).collect();
        let code = |form| Code { form, plans: OnceLock::new(), functions: functions() };
        let code = match maker {
            Maker::Runtime => None,
            Maker::Code(form) => Some(code(form)),
        };
        Self { robot: robot.clone(), runtime: DynArm::from_robot(robot), code }
    }

    /// By no plans at all, which fits every robot and takes no time to find.
    pub(crate) fn by_no_choice(robot: &Robot, maker: Maker) -> Self {
        let arm = Self::new(robot, maker);
        if let Some(code) = &arm.code {
            code.plans.set(PlanSet::none(robot)).expect("plans are made once");
        }
        arm
    }

    /// By the plan file that stands beside the robot file, if there is one; compiled once in all tests.
    pub(crate) fn from_file(file: &str, maker: Maker) -> &'static Self {
        static ARMS: Mutex<BTreeMap<String, &'static Arm>> = Mutex::new(BTreeMap::new());
        let mut arms = ARMS.lock().expect("no test panics here");
        arms.entry(format!("{file}, {maker}")).or_insert_with(|| Box::leak(Box::new(Self::read(file, maker))))
    }

    fn read(file: &str, maker: Maker) -> Self {
        let path = format!("{ROOT}/{file}");
        let yaml = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        let read = Reader::new(file).trees().couplings().read(&yaml);
        let robot = read.unwrap_or_else(|report| panic!("{report}")).robot;
        let arm = Self::new(&robot, maker);
        if let Some(code) = &arm.code
            && let Ok(plan) = std::fs::read_to_string(path.replace(".yaml", ".plan.yaml"))
        {
            let plan = PlanFile::read(file, &plan, &robot).unwrap_or_else(|report| panic!("{report}"));
            code.plans.set(PlanSet::from(plan)).expect("plans are made once");
        }
        arm
    }

    /// The code of a function.
    pub(crate) fn program(&self, function: Function) -> &Program {
        &self.compiled(self.code.as_ref().expect("an arm of code"), function).0
    }

    fn compiled<'a>(&self, code: &'a Code, function: Function) -> &'a (Program, Interpreter) {
        let index = Function::OF_TREES.iter().position(|other| *other == function).expect("all are in it");
        code.functions[index].get_or_init(|| {
            let program = match code.form {
                Form::SevenSteps => Compiler::new(&self.robot).compile(function, code.form),
                form @ Form::Reduced => {
                    let plans = code.plans.get_or_init(|| PlanSet::default_of(&self.robot));
                    Compiler::new(&self.robot).with_plans(plans).compile(function, form)
                }
            };
            let program = program.unwrap_or_else(|error| panic!("{}: {error}", self.robot.name));
            let interpreter = Interpreter::new(&program);
            (program, interpreter)
        })
    }

    /// All numbers that a function returns, in the order of its layout.
    pub(crate) fn numbers<T: Scalar + Numbers<T>>(&self, function: Function, given: &Given<'_, T>) -> Vec<T> {
        self.of_code(function, given).unwrap_or_else(|| of_runtime(&self.runtime, function, given))
    }

    /// All numbers that the code of a function returns, if this arm has code.
    pub(crate) fn of_code<T: Scalar>(&self, function: Function, given: &Given<'_, T>) -> Option<Vec<T>> {
        let code = self.code.as_ref()?;
        let [q, qd, qdd, tau] = [given.q, given.qd, given.qdd, given.tau]
            .map(|array| array.iter().copied().map(Number).collect::<Vec<_>>());
        let BaseMotion { omega, omega_dot, velocity, acceleration, gravity } = given.base;
        let pose = flat(given.pose().rotation).into_iter().chain(given.pose().translation).map(Number);
        let wrenches: Vec<[Number<T>; 6]> = at_tips(self.robot.tip_count(), &given.wrench)
            .iter()
            .map(|&Wrench { force: [fx, fy, fz], moment: [nx, ny, nz] }| [fx, fy, fz, nx, ny, nz].map(Number))
            .collect();
        let arguments = Arguments {
            wrenches: &wrenches,
            force: given.wrench.force.map(Number),
            moment: given.wrench.moment.map(Number),
            payload: given.payload.to_array().map(Number),
            tau: &tau,
            base: [omega, omega_dot, acceleration, gravity].map(|vector| vector.map(Number)),
            velocity: velocity.map(Number),
            pose: pose.collect::<Vec<_>>().try_into().unwrap_or_else(|_| unreachable!("twelve")),
            step: Number(given.step),
            base_rotation: std::array::from_fn(|at| Number(given.base_rotation[at / 3][at % 3])),
            ..Arguments::of_joints(&q, &qd, &qdd, Number(T::zero()))
        };
        let sin_cos = |Number(angle): Number<T>| {
            let (sine, cosine) = Scalar::sin_cos(angle);
            (Number(sine), Number(cosine))
        };
        let (_, interpreter) = self.compiled(code, function);
        let numbers = interpreter.run(&arguments, |constant| Number(T::from_f64(constant)), sin_cos);
        let numbers: Vec<T> = numbers.expect("one per joint").into_iter().map(|Number(x)| x).collect();
        assert_eq!(numbers.len(), function.layout(rne_codegen::sizes_of(&self.robot)).len());
        Some(numbers)
    }

    fn rows<T: Copy>(&self, numbers: &[T]) -> Vec<Vec<T>> {
        numbers.chunks(self.robot.dof()).map(<[T]>::to_vec).collect()
    }

    pub(crate) fn inverse_dynamics<T: Scalar + Numbers<T>>(&self, q: &[T], qd: &[T], qdd: &[T]) -> Vec<T> {
        self.numbers(Function::InverseDynamics, &Given::of_joints(q, qd, qdd))
    }

    pub(crate) fn inverse_dynamics_with_wrench<T: Scalar + Numbers<T>>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        wrench: &Wrench<T>,
    ) -> Vec<T> {
        let given = Given { wrench: *wrench, ..Given::of_joints(q, qd, qdd) };
        self.numbers(Function::InverseDynamicsWithWrench, &given)
    }

    pub(crate) fn inverse_dynamics_with_payload<T: Scalar + Numbers<T>>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        payload: &Payload<T>,
    ) -> Vec<T> {
        let given = Given { payload: *payload, ..Given::of_joints(q, qd, qdd) };
        self.numbers(Function::InverseDynamicsWithPayload, &given)
    }

    pub(crate) fn inverse_dynamics_on_moving_base<T: Scalar + Numbers<T>>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        base: &BaseMotion<T>,
    ) -> Vec<T> {
        let given = Given { base: *base, ..Given::of_joints(q, qd, qdd) };
        self.numbers(Function::InverseDynamicsOnMovingBase, &given)
    }

    pub(crate) fn gravity_torques<T: Scalar + Numbers<T>>(&self, q: &[T]) -> Vec<T> {
        self.numbers(Function::GravityTorques, &Given::of_joints(q, &[], &[]))
    }

    pub(crate) fn bias_torques<T: Scalar + Numbers<T>>(&self, q: &[T], qd: &[T]) -> Vec<T> {
        self.numbers(Function::BiasTorques, &Given::of_joints(q, qd, &[]))
    }

    pub(crate) fn mass_matrix<T: Scalar + Numbers<T>>(&self, q: &[T]) -> Vec<Vec<T>> {
        self.rows(&self.numbers(Function::MassMatrix, &Given::of_joints(q, &[], &[])))
    }

    pub(crate) fn inverse_mass_matrix<T: Scalar + Numbers<T>>(&self, q: &[T]) -> Vec<Vec<T>> {
        self.rows(&self.numbers(Function::InverseMassMatrix, &Given::of_joints(q, &[], &[])))
    }

    pub(crate) fn coriolis_matrix<T: Scalar + Numbers<T>>(&self, q: &[T], qd: &[T]) -> Vec<Vec<T>> {
        self.rows(&self.numbers(Function::CoriolisMatrix, &Given::of_joints(q, qd, &[])))
    }

    pub(crate) fn coriolis_torques<T: Scalar + Numbers<T>>(&self, q: &[T], qd: &[T]) -> Vec<T> {
        self.numbers(Function::CoriolisTorques, &Given::of_joints(q, qd, &[]))
    }

    pub(crate) fn forward_dynamics<T: Scalar + Numbers<T>>(&self, q: &[T], qd: &[T], tau: &[T]) -> Vec<T> {
        self.numbers(Function::ForwardDynamics, &Given { tau, ..Given::of_joints(q, qd, &[]) })
    }

    pub(crate) fn forward_kinematics<T: Scalar + Numbers<T>>(&self, q: &[T]) -> Pose<T> {
        pose(&self.numbers(Function::ForwardKinematics, &Given::of_joints(q, &[], &[])))
    }

    pub(crate) fn link_poses<T: Scalar + Numbers<T>>(&self, q: &[T]) -> Vec<Pose<T>> {
        self.numbers(Function::LinkPoses, &Given::of_joints(q, &[], &[])).chunks(12).map(pose).collect()
    }

    pub(crate) fn jacobian<T: Scalar + Numbers<T>>(&self, q: &[T]) -> [Vec<T>; 6] {
        let rows = self.rows(&self.numbers(Function::Jacobian, &Given::of_joints(q, &[], &[])));
        rows.try_into().unwrap_or_else(|_| unreachable!("six rows"))
    }

    pub(crate) fn jacobian_rate_times_velocity<T: Scalar + Numbers<T>>(&self, q: &[T], qd: &[T]) -> Vec<T> {
        self.numbers(Function::JacobianRateTimesVelocity, &Given::of_joints(q, qd, &[]))
    }

    pub(crate) fn kinetic_energy<T: Scalar + Numbers<T>>(&self, q: &[T], qd: &[T]) -> T {
        self.numbers(Function::KineticEnergy, &Given::of_joints(q, qd, &[]))[0]
    }

    pub(crate) fn potential_energy<T: Scalar + Numbers<T>>(&self, q: &[T]) -> T {
        self.numbers(Function::PotentialEnergy, &Given::of_joints(q, &[], &[]))[0]
    }

    pub(crate) fn centre_of_mass<T: Scalar + Numbers<T>>(&self, q: &[T]) -> Vec<T> {
        self.numbers(Function::CentreOfMass, &Given::of_joints(q, &[], &[]))
    }

    pub(crate) fn centre_of_mass_jacobian<T: Scalar + Numbers<T>>(&self, q: &[T]) -> Vec<Vec<T>> {
        self.rows(&self.numbers(Function::CentreOfMassJacobian, &Given::of_joints(q, &[], &[])))
    }

    /// By torque: a row of ten parameters of each link.
    pub(crate) fn regressor<T: Scalar + Numbers<T>>(&self, q: &[T], qd: &[T], qdd: &[T]) -> Vec<Vec<T>> {
        let numbers = self.numbers(Function::Regressor, &Given::of_joints(q, qd, qdd));
        numbers.chunks(10 * self.robot.dof()).map(<[T]>::to_vec).collect()
    }

    pub(crate) fn inverse_dynamics_derivatives<T: Scalar + Numbers<T>>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
    ) -> DynTorqueDerivatives<T> {
        let mut dq = self.rows(&self.numbers(Function::InverseDynamicsDerivatives, &Given::of_joints(q, qd, qdd)));
        let dqd = dq.split_off(self.robot.dof());
        DynTorqueDerivatives { dq, dqd }
    }

    pub(crate) fn joint_wrenches<T: Scalar + Numbers<T>>(&self, q: &[T], qd: &[T], qdd: &[T]) -> Vec<Wrench<T>> {
        let numbers = self.numbers(Function::JointWrenches, &Given::of_joints(q, qd, qdd));
        let wrench = |numbers: &[T]| {
            let [force, moment] = [0, 3].map(|part| std::array::from_fn(|axis| numbers[part + axis]));
            Wrench { force, moment }
        };
        numbers.chunks(6).map(wrench).collect()
    }

    /// M q̇, and its rate without external torques.
    pub(crate) fn momentum_and_rate<T: Scalar + Numbers<T>>(&self, q: &[T], qd: &[T], tau: &[T]) -> [Vec<T>; 2] {
        let given = Given { tau, ..Given::of_joints(q, qd, &[]) };
        let mut momentum = self.numbers(Function::MomentumAndRate, &given);
        let rate = momentum.split_off(self.robot.dof());
        [momentum, rate]
    }

    pub(crate) fn actuator_torques<T: Scalar + Numbers<T>>(&self, qd: &[T], qdd: &[T]) -> Vec<T> {
        self.numbers(Function::ActuatorTorques, &Given::of_joints(&[], qd, qdd))
    }
}

fn pose<T: Scalar>(numbers: &[T]) -> Pose<T> {
    let triple = |start: usize| std::array::from_fn(|index| numbers[start + index]);
    Pose { rotation: [0, 3, 6].map(triple), translation: triple(9) }
}

/// A wrench at each tip, each another one: that at the tip frame is the first.
pub(crate) fn at_tips<T: Copy>(tips: usize, wrench: &Wrench<T>) -> Vec<Wrench<T>> {
    let Wrench { force: [a, b, c], moment: [d, e, f] } = *wrench;
    let others = [([a, b, c], [d, e, f]), ([e, f, a], [b, c, d]), ([c, d, b], [f, a, e])];
    others.into_iter().cycle().take(tips).map(|(force, moment)| Wrench { force, moment }).collect()
}

/// What the runtime returns, as a row of numbers.
pub(crate) fn of_runtime<T: Scalar + Numbers<T>>(arm: &DynArm, function: Function, given: &Given<'_, T>) -> Vec<T> {
    let Given { q, qd, qdd, tau, ref wrench, ref payload, ref base, ref base_rotation, step } = *given;
    let (sin, cos): (Vec<T>, Vec<T>) = q.iter().map(|&q| Scalar::sin_cos(q)).unzip();
    let inputs = Inputs {
        q,
        qd,
        qdd,
        tau,
        sin: &sin,
        cos: &cos,
        passive: &[],
        multipliers: tau,
        wrench,
        wrenches: &at_tips(arm.tips().len(), wrench),
        payload,
        base,
        omega: &base.omega,
        twist: &given.twist(),
        pose: &given.pose(),
        base_rotation,
        step,
    };
    arm.evaluate(function, &inputs).expect("one per joint")
}
