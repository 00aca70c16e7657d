//! Rollouts: many samples of a motion under torques, for sampling-based predictive control.

use std::error::Error;
use std::fmt;

use rne_codegen::Function;
use rne_model::{Entry, Joint, Limits, Robot};
use rne_runtime::VectorUnit;
use rne_runtime::machine::{self, RolloutJoint, SmoothFriction, Source};

use crate::arguments::place;
use crate::{Arguments, CompiledArm, CompiledFunction, EvaluationError, Number, WrongSize};

/// The steps of a rollout, and what acts on the joints in addition to the dynamics of the arm.
///
/// [`CompiledArm::rollout`] integrates each sample by semi-implicit Euler. A step of duration h does this, in this
/// order:
///
/// 1. With effort limits, each torque of the step is clamped to the range from -effort to +effort.
/// 2. With friction, the friction at the velocity before the step is subtracted from the torque. It is that of
///    `Actuation::actuator_torques_smooth` for accelerations of zero: G² B q̇ + |G| (½ (Tc⁺ - Tc⁻) s + ½ (Tc⁺ + Tc⁻) s²)
///    with s = q̇ / √(q̇² + width²).
/// 3. q̈ is `forward_dynamics` of the position and velocity before the step and of this torque.
/// 4. q̇ becomes q̇ + h q̈. With velocity limits, it is clamped to the range from -velocity to +velocity.
/// 5. q becomes q + h q̇, with the new q̇.
/// 6. With position limits, a joint beyond an end of its range stops: q is set to that end, and q̇ to zero.
///
/// The rotors of the motors belong to the arm only after [`CompiledArm::with_rotors`], as in all functions. Friction is
/// taken from the velocity before the step, so a long step makes a light joint swing about zero velocity: it is stable
/// for h < 2 m / (G² B + |G| Tc / width), where m is the joint's inertia in the mass matrix. With a longer step, states
/// may grow until they are infinite or NaN; [`CompiledArm::rollout`] returns them as they are, so test that they are
/// finite. The other samples keep their numbers.
///
/// ```
/// use rne_machine::{Arguments, Array, CompiledArm, FrictionWidth, Rollout, RolloutLimits};
///
/// let rod = "
/// format: 1
/// name: rod
/// source: own
/// convention: standard
/// gravity: [0, -9.81, 0]
/// joints:
///   - type: revolute
///     dh: {theta: 0, d: 0, a: 0.8, alpha: 0}
///     link: {mass: 2.5, com: [-0.4, 0, 0]}
///     motor: {viscous: 0.1, coulomb: [0.2, -0.2]}
///     limits: {position: [-3, 3], effort: 12}
/// ";
/// let arm = CompiledArm::from_yaml(rod)?;
/// let (samples, steps) = (2, 3);
/// let rollout = Rollout {
///     friction: Some(FrictionWidth::Of(0.05)), // rad/s
///     limits: RolloutLimits::ALL,
///     ..Rollout::new(steps, 0.01) // s
/// };
/// let tau = [0.0, 0.0, 0.0, 15.0, 15.0, 15.0]; // N m: of the first sample, then of the second
/// let start = Arguments::new().q(Array::Same(&[0.0])).qd(Array::Same(&[0.0])).tau(Array::Rows(&tau));
/// let [mut q, mut qd] = [[0.0; 6]; 2]; // after each step: of the first sample, then of the second
/// arm.rollout(&rollout, samples, &start, &mut q, &mut qd)?;
/// // the second sample is lifted by the largest torque of its motor, 12 N m: q̈ = (12 - m g c) / (m c²)
/// let first: f64 = 0.01 * (12.0 - 2.5 * 9.81 * 0.4) / (2.5 * 0.4 * 0.4);
/// assert!((qd[3] - first).abs() < 1e-12 && (q[3] - 0.01 * first).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rollout {
    /// The number of steps.
    pub steps: usize,
    /// The duration h of a step, s; above zero.
    pub step: f64,
    /// Friction of the joints, by the `motor` keys of the robot file, with the width around zero speed in which Coulomb
    /// friction changes its sign; `None`: no friction.
    pub friction: Option<FrictionWidth>,
    /// The limits of the robot file that are applied.
    pub limits: RolloutLimits,
}

/// The width around zero speed in which the Coulomb friction of a joint changes its sign: `width` in s = q̇ / √(q̇² +
/// width²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrictionWidth {
    /// The width is the key `coulomb_width` of each joint with Coulomb friction.
    OfFile,
    /// One width for all joints, rad/s or m/s; above zero.
    Of(f64),
}

/// The limits of the robot file that are applied in a rollout. A joint without a limit in the file has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RolloutLimits {
    /// The torque of the actuator is limited to ± the key `effort`.
    pub effort: bool,
    /// The speed is limited to ± the key `velocity`.
    pub velocity: bool,
    /// A joint stops at the ends of the key `position`.
    pub position: bool,
}

impl RolloutLimits {
    /// All limits of the robot file.
    pub const ALL: Self = Self { effort: true, velocity: true, position: true };

    /// No limits.
    pub const NONE: Self = Self { effort: false, velocity: false, position: false };
}

impl Rollout {
    /// Returns a rollout without friction and without limits: `steps` steps of the duration `step`, s.
    #[must_use]
    pub const fn new(steps: usize, step: f64) -> Self {
        Self { steps, step, friction: None, limits: RolloutLimits::NONE }
    }

    /// Returns the limits and the friction of the joints of a robot.
    fn joints<T: Number>(&self, robot: &Robot) -> Result<Vec<RolloutJoint<T>>, RolloutError> {
        let limit = |holds: bool, limit: Option<f64>| limit.filter(|_| holds).map(T::from_f64);
        let of_joint = |(index, limits): (usize, Limits)| {
            let position = limits.position.filter(|_| self.limits.position);
            Ok(RolloutJoint {
                effort: limit(self.limits.effort, limits.effort),
                friction: self.friction_of(robot, index, &robot.joints[index])?,
                velocity: limit(self.limits.velocity, limits.velocity),
                position: position.map(|(lower, upper)| [lower, upper].map(T::from_f64)),
            })
        };
        robot.coordinates().zip(robot.coordinate_limits()).map(of_joint).collect()
    }

    fn friction_of<T: Number>(
        &self,
        robot: &Robot,
        index: usize,
        joint: &Joint,
    ) -> Result<Option<SmoothFriction<T>>, RolloutError> {
        let (Some(of_rollout), Some(motor)) = (self.friction, joint.motor) else { return Ok(None) };
        let entries = [Entry::GearRatio, Entry::Viscous, Entry::CoulombPositive, Entry::CoulombNegative];
        if entries.iter().any(|entry| robot.run_time.formula(entry(index)).is_some()) {
            return Err(RolloutError::RunTimeFriction { joint: joint.name.clone() });
        }
        let square = motor.gear_ratio * motor.gear_ratio;
        let viscous = T::from_f64(square * motor.viscous);
        let [positive, negative] = motor.coulomb.map(|friction| T::from_f64(motor.gear_ratio.abs() * friction));
        if motor.coulomb == [0.0; 2] {
            let zero = T::zero();
            let friction = SmoothFriction { viscous, odd: zero, even: zero, width: T::one() };
            return Ok((motor.viscous != 0.0).then_some(friction));
        }
        let width = match of_rollout {
            FrictionWidth::Of(width) => Some(width),
            FrictionWidth::OfFile => joint.coulomb_width,
        };
        let usable = width.and_then(usable);
        let width = usable.ok_or_else(|| RolloutError::FrictionWidth { joint: joint.name.clone(), width })?;
        let half = T::from_f64(0.5);
        let (odd, even) = ((positive - negative) * half, (positive + negative) * half);
        Ok(Some(SmoothFriction { viscous, odd, even, width }))
    }
}

/// Returns the value as a `T` if it is a finite number above zero whose square is above zero, too.
fn usable<T: Number>(value: f64) -> Option<T> {
    let number = T::from_f64(value);
    (value > 0.0 && number * number > T::zero() && number.into().is_finite()).then_some(number)
}

impl CompiledArm {
    /// Integrates samples of states under torques, step by step, on the widest vector unit. [`Rollout`] describes a
    /// step.
    ///
    /// `arguments` has the initial positions `q` and velocities `qd` of n joints, the torques `tau`, which are steps ×
    /// n numbers for each sample, step after step, and for an arm with a payload at its tip `payload`. An argument in
    /// [`Array::Same`](crate::Array::Same) is used for all samples. `positions` and `velocities` get the states after
    /// each step, samples × steps × n numbers: sample after sample, in each step after step, in each joint after joint.
    /// The initial state is not among them.
    ///
    /// The results of a sample have the same bits for any other samples and any number of threads: those of one call of
    /// `forward_dynamics` for each step and of the arithmetic in [`Rollout`]. A NaN or an infinite number stays in its
    /// sample. With the feature `rayon` many samples are computed on all cores. Between steps nothing is allocated.
    ///
    /// # Errors
    /// When the step is not above zero, a joint has Coulomb friction without a width above zero, the friction of a
    /// joint depends on run-time parameters, an argument is missing or has another size, the payload of a sample has a
    /// mass below zero, `positions` or `velocities` has another size, or forward dynamics cannot be compiled. Then
    /// nothing is written.
    pub fn rollout<T: Number>(
        &self,
        rollout: &Rollout,
        samples: usize,
        arguments: &Arguments<'_, T>,
        positions: &mut [T],
        velocities: &mut [T],
    ) -> Result<(), RolloutError> {
        self.rollout_on(VectorUnit::widest(), rollout, samples, arguments, [positions, velocities])
    }

    /// Does what [`rollout`](Self::rollout) does on a given vector unit; `states` are `positions` and `velocities`.
    ///
    /// # Errors
    /// As for [`rollout`](Self::rollout).
    pub fn rollout_on<T: Number>(
        &self,
        unit: VectorUnit,
        rollout: &Rollout,
        samples: usize,
        arguments: &Arguments<'_, T>,
        states: [&mut [T]; 2],
    ) -> Result<(), RolloutError> {
        let Rollout { steps, step, friction, .. } = *rollout;
        usable::<T>(step).ok_or(RolloutError::Step(step))?;
        if let Some(FrictionWidth::Of(width)) = friction {
            usable::<T>(width).ok_or(RolloutError::Width(width))?;
        }
        let joints = rollout.joints(self.robot())?;
        let is_loaded = place("payload").is_some_and(|place| arguments.at(place).is_some());
        let function = if is_loaded { Function::ForwardDynamicsWithPayload } else { Function::ForwardDynamics };
        let compiled = self.function(function)?;
        let size = steps.checked_mul(joints.len()).and_then(|size| size.checked_mul(samples));
        for (array, numbers) in ["positions", "velocities"].into_iter().zip(&states) {
            if Some(numbers.len()) != size {
                let (joints, found) = (joints.len(), numbers.len());
                return Err(RolloutError::Size { array, samples, steps, joints, found });
            }
        }
        compiled.roll_out(unit, samples, &joints, rollout, arguments, states)
    }
}

impl CompiledFunction {
    /// Integrates samples; this function is forward dynamics.
    fn roll_out<T: Number>(
        &self,
        unit: VectorUnit,
        samples: usize,
        joints: &[RolloutJoint<T>],
        &Rollout { steps, step, .. }: &Rollout,
        arguments: &Arguments<'_, T>,
        states: [&mut [T]; 2],
    ) -> Result<(), RolloutError> {
        let dof = joints.len();
        let [mut q, mut qd, mut tau, mut constants] = [const { Vec::new() }; 4];
        // the place of each array's first element in the machine's list of inputs
        let mut starts = Vec::with_capacity(self.arguments().len());
        for (index, &(argument, elements)) in self.arguments().iter().enumerate() {
            let is_tau = argument == "tau";
            let elements = if is_tau { elements.saturating_mul(steps) } else { elements };
            let array = self.checked(index, elements, samples, arguments).map_err(|error| match error {
                EvaluationError::Argument {
                    argument: array, size: WrongSize::Numbers { given: found, .. }, ..
                } if is_tau => RolloutError::Size { array, samples, steps, joints: dof, found },
                error => error.into(),
            })?;
            let (start, sources): (usize, &mut Vec<Source<'_, T>>) = match argument {
                "q" => (0, &mut q),
                "qd" => (dof, &mut qd),
                "tau" => (2 * dof, &mut tau),
                _ => (3 * dof + constants.len(), &mut constants),
            };
            starts.push(start);
            sources.extend((0..elements).filter_map(|element| array.source(element, elements, samples)));
        }
        let inputs: Vec<usize> = self.inputs().iter().map(|&(array, element)| starts[array] + element).collect();
        let step = T::from_f64(step);
        let (q, qd, tau, constants, inputs) = (&q[..], &qd[..], &tau[..], &constants[..], &inputs[..]);
        let rollout = machine::Rollout { steps, step, joints, inputs, q, qd, tau, constants };
        let found = samples.saturating_mul(tau.len());
        let wrong = |_| RolloutError::Size { array: "tau", samples, steps, joints: dof, found };
        self.machine().code().roll_out(unit, samples, &rollout, states).map_err(wrong)
    }
}

/// Why nothing was rolled out. In this case no result has been written.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RolloutError {
    /// An argument is missing or has another size, or forward dynamics cannot be compiled.
    Evaluation(EvaluationError),
    /// The duration of a step is not above zero.
    Step(f64),
    /// The width of Coulomb friction is not above zero.
    Width(f64),
    /// A joint with Coulomb friction has no usable width in the robot file.
    FrictionWidth {
        /// The name of the joint.
        joint: String,
        /// Its `coulomb_width`, rad/s or m/s.
        width: Option<f64>,
    },
    /// The friction of a joint depends on parameters that are known at run time only.
    RunTimeFriction {
        /// The name of the joint.
        joint: String,
    },
    /// An array has another size.
    Size {
        /// The name of the array.
        array: &'static str,
        /// The number of samples.
        samples: usize,
        /// The number of steps.
        steps: usize,
        /// The number of joints.
        joints: usize,
        /// The number of numbers that the array has.
        found: usize,
    },
}

impl fmt::Display for RolloutError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Evaluation(error) => error.fmt(f),
            Self::Step(step) => {
                write!(f, "the step of a rollout is {step} s, but it must be a finite number above 0")
            }
            Self::Width(width) => {
                write!(f, "the width of Coulomb friction is {width}, but it must be a finite number above 0")
            }
            Self::FrictionWidth { joint, width: None } => {
                write!(
                    f,
                    "joint `{joint}` has Coulomb friction, but no `coulomb_width` in the robot file: add this key, or \
                     give one width for all joints"
                )
            }
            Self::FrictionWidth { joint, width: Some(width) } => {
                write!(
                    f,
                    "the `coulomb_width` of joint `{joint}` is {width} in the robot file, but a rollout needs a number \
                     above 0: change this key, or give one width for all joints"
                )
            }
            Self::RunTimeFriction { joint } => {
                write!(
                    f,
                    "the friction of joint `{joint}` depends on run-time parameters, but a rollout needs constants: \
                     give these parameters values when you read the robot file, or roll out without friction"
                )
            }
            Self::Size { array, samples, steps, joints, found } => {
                let needed = samples.saturating_mul(*steps).saturating_mul(*joints);
                write!(
                    f,
                    "`{array}` must have {needed} numbers, which are {samples} samples × {steps} steps × {joints} \
                     joints, but it has {found}"
                )
            }
        }
    }
}

impl Error for RolloutError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Evaluation(error) => error.source(),
            _ => None,
        }
    }
}

impl From<EvaluationError> for RolloutError {
    fn from(error: EvaluationError) -> Self {
        Self::Evaluation(error)
    }
}
