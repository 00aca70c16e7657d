//! The table of functions: one signature and one entry for each, with all but its formulas.
//!
//! A function is added by a line of `functions!` here and the runtime's own implementation; what no other function
//! computes has an entry in the table of its kind of base and formulas in `formulate`, too. A new function is the last
//! line, whatever its capability, so that the others keep their places, which are the ids of the C library.

use crate::axes::Axes;
use crate::entry::{Entry, Signature};
use crate::layout::returned;
use crate::named;
use crate::{Argument, What};

/// Every result in the order of [`What`]: after `by`, its reduced [`Recursion`], if it has one; its name, and the names
/// that other programs or a function at a frame have for it; then the trait and the entry, for a base that is fixed or
/// moved, and for a floating base. `$callback!` is given the list.
#[rustfmt::skip]
macro_rules! results {
    ($callback:ident) => {
        $callback! {
            /// Torques from motion.
            InverseDynamics by Torques = "inverse_dynamics" | "torques" | "rnea" | "computeTorque" | "rne":
                [InverseDynamics Entry::TORQUES] [FloatingBase floating::TORQUES];
            /// Torques from motion, with the sines and cosines of the positions as arguments.
            InverseDynamicsFromSinCos by Torques = "inverse_dynamics_from_sin_cos": [InverseDynamics Entry::TORQUES] [];
            /// Torques that hold the robot still.
            GravityTorques by GravityTorques = "gravity_torques" | "gravity compensation" | "computeGeneralizedGravity" | "gravload": [InverseDynamics fixed::GRAVITY_TORQUES] [FloatingBase floating::GRAVITY_TORQUES];
            /// Torques where nothing accelerates.
            BiasTorques by Torques = "bias_torques" | "bias" | "nle" | "nonLinearEffects" | "qfrc_bias": [InverseDynamics fixed::BIAS_TORQUES] [FloatingBase floating::BIAS_TORQUES];
            /// C(q, q̇) q̇: torques where nothing accelerates or weighs.
            CoriolisTorques by Torques = "coriolis_torques" | "Coriolis": [CoriolisMatrix fixed::CORIOLIS_TORQUES] [];
            /// M(q).
            MassMatrix by MassMatrix = "mass_matrix" | "crba" | "mj_fullM" | "qM" | "inertia matrix": [MassMatrix fixed::MASS_MATRIX] [FloatingBase floating::MASS_MATRIX];
            /// M(q)⁻¹.
            InverseMassMatrix by MassMatrix = "inverse_mass_matrix" | "computeMinverse": [MassMatrix fixed::INVERSE_MASS_MATRIX] [];
            /// M(q)⁻¹ τ.
            InverseMassMatrixTimesTorques by Accelerations = "inverse_mass_matrix_times_torques" | "mj_solveM":
                [MassMatrix fixed::INVERSE_MASS_MATRIX_TIMES_TORQUES] [];
            /// C(q, q̇).
            CoriolisMatrix by Derivatives = "coriolis_matrix" | "computeCoriolisMatrix": [CoriolisMatrix fixed::CORIOLIS_MATRIX] [];
            /// Accelerations from torques.
            ForwardDynamics by Accelerations = "forward_dynamics" | "aba" | "mj_forward":
                [ForwardDynamics fixed::FORWARD_DYNAMICS] [FloatingBase floating::ACCELERATIONS];
            /// Accelerations from torques while contacts hold some of the tips.
            ForwardDynamicsInContact by CompositeBodies = "forward_dynamics_in_contact" | "constraintDynamics":
                [] [ContactDynamics floating::FORWARD_DYNAMICS_IN_CONTACT];
            /// The pose of the tip.
            ForwardKinematics = "forward_kinematics" | "pose" | "fk" | "fkine": [Kinematics fixed::FORWARD_KINEMATICS] [];
            /// The poses of all links.
            LinkPoses = "link_poses": [Kinematics fixed::LINK_POSES] [];
            /// The Jacobian J of the tip.
            Jacobian = "jacobian" | "computeJointJacobian" | "mj_jac": [Kinematics fixed::JACOBIAN] [];
            /// J̇.
            JacobianRate = "jacobian_rate" | "computeJointJacobiansTimeVariation": [JacobianDerivatives fixed::JACOBIAN_RATE] [];
            /// J̇ q̇.
            JacobianRateTimesVelocity = "jacobian_rate_times_velocity": [Kinematics fixed::JACOBIAN_RATE_TIMES_VELOCITY] [];
            /// ∂J/∂q.
            JacobianDerivatives = "jacobian_derivatives": [JacobianDerivatives fixed::JACOBIAN_DERIVATIVES] [];
            /// The Jacobian of each tip.
            TipJacobians = "tip_jacobians": [] [FloatingKinematics floating::TIP_JACOBIANS];
            /// The acceleration of each tip where nothing accelerates.
            TipAccelerations = "tip_accelerations": [] [FloatingKinematics floating::TIP_ACCELERATIONS];
            /// Kinetic energy.
            KineticEnergy = "kinetic_energy" | "computeKineticEnergy": [Energy fixed::KINETIC_ENERGY] [FloatingEnergy fixed::KINETIC_ENERGY];
            /// Potential energy.
            PotentialEnergy = "potential_energy" | "computePotentialEnergy":
                [Energy fixed::POTENTIAL_ENERGY] [FloatingEnergy fixed::POTENTIAL_ENERGY];
            /// The centre of mass.
            CentreOfMass = "centre_of_mass" | "center of mass" | "com": [CentreOfMass fixed::CENTRE_OF_MASS] [];
            /// The Jacobian of the centre of mass.
            CentreOfMassJacobian = "centre_of_mass_jacobian" | "jacobianCenterOfMass" | "mj_jacSubtreeCom": [CentreOfMass fixed::CENTRE_OF_MASS_JACOBIAN] [];
            /// Torques per inertial parameter.
            Regressor = "regressor" | "computeJointTorqueRegressor": [Regressor fixed::REGRESSOR] [FloatingRegressor floating::REGRESSOR];
            /// Derivatives of the torques.
            InverseDynamicsDerivatives by Derivatives = "inverse_dynamics_derivatives" | "computeRNEADerivatives" | "IDSVA":
                [InverseDynamicsDerivatives fixed::DERIVATIVES]
                [FloatingInverseDynamicsDerivatives floating::INVERSE_DYNAMICS_DERIVATIVES];
            /// Derivatives of the accelerations.
            ForwardDynamicsDerivatives by CompositeBodies = "forward_dynamics_derivatives" | "computeABADerivatives":
                [ForwardDynamicsDerivatives fixed::ACCELERATION_DERIVATIVES] [];
            /// The gradient of a weighted sum of the torques.
            TorqueGradient by Torques = "torque_gradient": [InverseDynamicsGradient fixed::TORQUE_GRADIENT] [];
            /// The second derivatives of this sum.
            TorqueHessian by SecondDerivatives = "torque_hessian" | "ComputeRNEASecondOrderDerivatives": [InverseDynamicsHessian fixed::TORQUE_HESSIAN] [];
            /// The wrench at each joint.
            JointWrenches = "joint_wrenches": [JointWrenches fixed::JOINT_WRENCHES] [];
            /// The momentum of the joints and its rate.
            MomentumAndRate by CompositeBodies = "momentum_and_rate" | "momentum observer": [MomentumObserver fixed::MOMENTUM_AND_RATE] [];
            /// Torques of a wrench at the tip.
            WrenchTorques = "wrench_torques": [Kinematics fixed::WRENCH_TORQUES] [];
            /// Torques of motors.
            ActuatorTorques = "actuator_torques": [Actuation fixed::ACTUATOR_TORQUES] [];
            /// A step of the semi-implicit Euler method.
            EulerStep by Accelerations = "euler_step" | "mj_step": [EulerStep fixed::EULER_STEP] [FloatingEulerStep floating::EULER_STEP];
            /// The derivatives of this step.
            EulerStepDerivatives by CompositeBodies = "euler_step_derivatives":
                [EulerStepDerivatives fixed::EULER_STEP_DERIVATIVES]
                [FloatingEulerStepDerivatives floating::EULER_STEP_DERIVATIVES];
            /// The momentum about the centre of mass.
            CentroidalMomentum by CompositeBodies = "centroidal_momentum" | "computeCentroidalMomentum": [] [CentroidalMomentum floating::CENTROIDAL_MOMENTUM];
            /// The matrix from velocities to this momentum.
            CentroidalMomentumMatrix by CompositeBodies = "centroidal_momentum_matrix" | "CCRBA" | "CMM":
                [] [CentroidalMomentum floating::CENTROIDAL_MOMENTUM_MATRIX];
            /// The rate of this momentum where nothing accelerates.
            CentroidalBias by CompositeBodies = "centroidal_bias" | "dccrba": [] [CentroidalMomentum floating::CENTROIDAL_BIAS];
            /// A Newton step towards closed loops.
            ClosureStep = "closure_step": [ClosedLoops fixed::CLOSURE_STEP] [];
            /// The matrix G from velocities to those of the dependent joints.
            LoopMap = "loop_map": [ClosedLoops fixed::LOOP_MAP] [];
            /// Ġ q̇.
            LoopMapRateTimesVelocity = "loop_map_rate_times_velocity": [ClosedLoops fixed::LOOP_MAP_RATE_TIMES_VELOCITY] [];
        }
    };
}
pub(crate) use results;

/// Every function in the order of [`Function`]: its variant, its [`Axes`], its method with the arguments by their names
/// and kinds, its result, and the sentences about it. `at NAME` follows the result where the function of the tip can be
/// taken at any frame of a link instead; its name there begins with NAME. `$callback!` is given the list, so that each
/// door makes its methods of it.
#[macro_export]
#[rustfmt::skip]
macro_rules! functions {
    ($callback:ident) => {
        $callback! {
            InverseDynamics [InverseDynamics] = inverse_dynamics(q: Positions, qd: Rates, qdd: Accelerations) -> Vector:
                "Torques for positions `q`, velocities `qd` and accelerations `qdd`, with a free tip.",
                "tau: what the actuators must deliver, M(q) q̈ + C(q, q̇) q̇ + g(q). No friction; rotor inertia in an \
                 arm with its rotors only.";
            InverseDynamicsWithWrench [InverseDynamics.with_wrench] =
                inverse_dynamics_with_wrench(q: Positions, qd: Rates, qdd: Accelerations, wrench: Wrench) -> Vector:
                "Torques when the last link exerts a force and a moment on its environment, at the tip, in tip axes.",
                "force (N), moment (N m): exerted BY the last link ON its environment, about the origin of the tip \
                 frame (tool included); what the environment exerts on the robot is the negative of them. tau: τ_free \
                 + Jᵀ w.";
            InverseDynamicsWithPayload [InverseDynamics.with_payload] =
                inverse_dynamics_with_payload(q: Positions, qd: Rates, qdd: Accelerations, payload: Payload) -> Vector:
                "Torques when a payload is fixed to the tip: its mass, centre of mass and inertia, in tip axes.",
                "payload: mass (kg); centre of mass x, y, z from the origin of the tip frame (m; tool included); \
                 inertia about the centre of mass xx, yy, zz, xy, xz, yz (kg m²; xy is the tensor's element, -∫ x y \
                 dm). tau: those of the arm whose last link has this payload too.";
            InverseDynamicsFromSinCos [InverseDynamicsFromSinCos] = inverse_dynamics_from_sin_cos(
                sin: Sines, cos: Cosines, q: Positions, qd: Rates, qdd: Accelerations
            ) -> Vector:
                "Torques from the sines and cosines of the joint positions; `q` is used for prismatic joints alone.",
                "sine[i], cosine[i]: those of q[i], without the constant part of the joint's angle. Those of a \
                 prismatic joint are not used, as q[i] of a revolute joint is not.";
            GravityTorques [GravityTorques] = gravity_torques(q: Positions) -> Vector:
                "Torques that hold the arm still against gravity, τ(q, 0, 0).";
            BiasTorques [BiasTorques] = bias_torques(q: Positions, qd: Rates) -> Vector:
                "Coriolis, centrifugal and gravity torques, τ(q, q̇, 0).";
            MassMatrix [MassMatrix] = mass_matrix(q: Positions) -> Matrix:
                "The mass matrix M(q), symmetric: column j holds the torques for q̈ = e_j of an arm at rest.",
                "mass[i][j]: torque of joint i for a unit acceleration of joint j, from rest and without gravity; kg \
                 m², kg m or kg, as the kinds of joints i and j have it. Rotor inertia in an arm with its rotors \
                 only.";
            CoriolisMatrix [CoriolisMatrix] = coriolis_matrix(q: Positions, qd: Rates) -> Matrix:
                "The Coriolis matrix C(q, q̇) of Christoffel: Ṁ - 2C is skew, and C = ½ ∂(bias torques)/∂q̇.",
                "coriolis[i][j]: row i is torque i. Its product with q̇ are the Coriolis and centrifugal torques.";
            ForwardDynamics [ForwardDynamics] = forward_dynamics(q: Positions, qd: Rates, tau: Torques) -> Vector:
                "Accelerations for positions `q`, velocities `qd` and torques `tau`, with a free tip.",
                "qdd: M(q)⁻¹ (τ - C(q, q̇) q̇ - g(q)). A singular mass matrix (a joint that moves nothing) gives \
                 numbers that are not finite.";
            ForwardKinematics [ForwardKinematics] = forward_kinematics(q: Positions) -> Pose at pose:
                "The tip in the world, base and tool included.",
                "tip->rotation: its columns are the axes of the tip frame, in world axes. tip->translation: its \
                 origin in the world, m.";
            LinkPoses [LinkPoses] = link_poses(q: Positions) -> Poses:
                "The frame of every row of the table in the world.",
                "poses[i]: at the far end of link i + 1 in a standard table, on its joint in a modified one; axes as \
                 columns, origin in m. The tool is not included.";
            Jacobian [Jacobian] = jacobian(q: Positions) -> SpatialRows at jacobian:
                "The geometric Jacobian of the tip in world axes: three linear rows, then three angular ones.",
                "jacobian: its product with q̇ is the velocity of the origin of the tip frame (m/s) above the angular \
                 velocity of the last link (rad/s).";
            JacobianRateTimesVelocity [JacobianRateTimesVelocity] =
                jacobian_rate_times_velocity(q: Positions, qd: Rates) -> Spatial at jacobian_rate_times_velocity:
                "J̇ q̇: the acceleration of the tip in world axes when q̈ = 0, linear, then angular.",
                "acceleration: of the origin of the tip frame (m/s²), then angular (rad/s²). At any other q̈ they are \
                 J q̈ + J̇ q̇.";
            KineticEnergy [KineticEnergy] = kinetic_energy(q: Positions, qd: Rates) -> Number:
                "Kinetic energy, J.",
                "½ q̇ᵀ M(q) q̇ of the links, and of the rotors in an arm with its rotors.";
            PotentialEnergy [PotentialEnergy] = potential_energy(q: Positions) -> Number:
                "Potential energy in gravity, J; zero where a mass is at the origin of frame 0.",
                "-Σ m g·c, with c from the origin of frame 0 to each centre of mass.";
            CentreOfMass [CentreOfMass] = centre_of_mass(q: Positions) -> Point:
                "The centre of mass of all links in the world, base included.",
                "centre: Σ m c / Σ m, m. Rotors are not included. An arm without mass gives numbers that are not \
                 finite.";
            CentreOfMassJacobian [CentreOfMassJacobian] = centre_of_mass_jacobian(q: Positions) -> PointRows:
                "The Jacobian of the centre of mass in world axes: its velocity per joint velocity.",
                "jacobian: its product with q̇ is the velocity of the centre of mass, m/s. An arm without mass gives \
                 numbers that are not finite.";
            Regressor [Regressor] = regressor(q: Positions, qd: Rates, qdd: Accelerations) -> Regressor:
                "Torques per inertial parameter: joint, link, (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz).",
                "regressor[i][j][k]: torque i per parameter k of link j, gravity included. The parameters refer to \
                 the link frame of the table: c and J from its origin, in its axes; Jxy is the tensor's element, -∫ x \
                 y dm.";
            InverseDynamicsDerivatives [InverseDynamicsDerivatives] =
                inverse_dynamics_derivatives(q: Positions, qd: Rates, qdd: Accelerations) -> TorqueDerivatives:
                "∂τ/∂q and ∂τ/∂q̇ of `inverse_dynamics`; row i is torque i.",
                "dq[i][j], dqd[i][j]: of torque i, by joint j. The derivative by q̈ is the mass matrix.";
            JointWrenches [JointWrenches] = joint_wrenches(q: Positions, qd: Rates, qdd: Accelerations) -> Wrenches:
                "Force and moment that link i-1 exerts on link i, at joint i, in axes fixed to link i.",
                "wrenches[i]: exerted BY the link before joint i + 1 ON the link behind it, with a free tip; force in \
                 N, moment in N m; axis z is that of the joint. The moment is about the origin of the frame before it \
                 in a standard table, about the foot of the common normal on its axis in a modified one.";
            MomentumAndRate [MomentumAndRate] = momentum_and_rate(q: Positions, qd: Rates, tau: Torques) -> MomentumAndRate:
                "The momentum of the joints, M(q) q̇, and the rate it would have without external torques.",
                "momentum: row i of M(q) q̇ (N m s, or N s for a prismatic joint), rotors included in an arm with its \
                 rotors. rate: τ + C(q, q̇)ᵀ q̇ - g(q) (N m or N); what the momentum changes faster than that is the \
                 external torque, so an observer needs no accelerations. tau: of the actuators, without friction.";
            InverseDynamicsOnMovingBase [InverseDynamics.moving] =
                inverse_dynamics_on_moving_base(q: Positions, qd: Rates, qdd: Accelerations, base: Base) -> Vector:
                "Torques on a base with a given motion, under a given gravity, with a free tip.",
                "base_omega (rad/s), base_omega_dot (rad/s²): of frame 0. base_acceleration (m/s²): of its origin, \
                 gravity not included. base_gravity (m/s²): points down, and replaces the robot's own. All in the axes \
                 of frame 0.";
            ActuatorTorques [ActuatorTorques] = actuator_torques(qd: Rates, qdd: Accelerations) -> Vector:
                "Torques of rotors behind gears and of friction, beside those of the links.",
                "G² Jm q̈ + G² B q̇ + |G| Tc(sign q̇), to be added to the torques of the links. Friction of Coulomb \
                 is zero at rest; a joint without a motor needs nothing.";
            InverseMassMatrix [InverseMassMatrix] = inverse_mass_matrix(q: Positions) -> Matrix:
                "The inverse of the mass matrix, M(q)⁻¹, symmetric: column j holds the accelerations for τ = e_j.",
                "inverse[i][j]: acceleration of joint i for a unit torque at joint j, from rest and without gravity. \
                 Rotor inertia in an arm with its rotors only. A singular mass matrix (a joint that moves nothing) \
                 gives numbers that are not finite.";
            GravityTorquesWithPayload [GravityTorques.with_payload] = gravity_torques_with_payload(q: Positions, payload: Payload) -> Vector:
                "Torques that hold the arm and a payload at its tip still against gravity.",
                "payload: as in inverse_dynamics_with_payload.";
            BiasTorquesWithPayload [BiasTorques.with_payload] = bias_torques_with_payload(q: Positions, qd: Rates, payload: Payload) -> Vector:
                "Coriolis, centrifugal and gravity torques of the arm with a payload at its tip.",
                "payload: as in inverse_dynamics_with_payload.";
            MassMatrixWithPayload [MassMatrix.with_payload] = mass_matrix_with_payload(q: Positions, payload: Payload) -> Matrix:
                "The mass matrix of the arm with a payload at its tip, symmetric.",
                "mass[i][j]: as in mass_matrix. payload: as in inverse_dynamics_with_payload.";
            ForwardDynamicsWithPayload [ForwardDynamics.with_payload] =
                forward_dynamics_with_payload(q: Positions, qd: Rates, tau: Torques, payload: Payload) -> Vector:
                "Accelerations for positions `q`, velocities `qd` and torques `tau` with a payload at the tip.",
                "qdd: as in forward_dynamics. payload: as in inverse_dynamics_with_payload.";
            InverseDynamicsDerivativesWithPayload [InverseDynamicsDerivatives.with_payload] = inverse_dynamics_derivatives_with_payload(
                q: Positions, qd: Rates, qdd: Accelerations, payload: Payload
            ) -> TorqueDerivatives:
                "∂τ/∂q and ∂τ/∂q̇ of `inverse_dynamics_with_payload`; row i is torque i.",
                "dq[i][j], dqd[i][j]: of torque i, by joint j. The derivative by q̈ is mass_matrix_with_payload.";
            MomentumAndRateWithPayload [MomentumAndRate.with_payload] = momentum_and_rate_with_payload(
                q: Positions, qd: Rates, tau: Torques, payload: Payload
            ) -> MomentumAndRate:
                "The momentum of the joints with a payload at the tip, and its rate without external torques.",
                "momentum, rate: as in momentum_and_rate. payload: as in inverse_dynamics_with_payload.";
            WrenchTorques [WrenchTorques] = wrench_torques(q: Positions, wrench: Wrench) -> Vector at wrench_torques:
                "Torques Jᵀ w of a force and a moment that the last link exerts at the tip, in tip axes.",
                "force (N), moment (N m): as in inverse_dynamics_with_wrench. tau: its torques minus those of \
                 inverse_dynamics.";
            InverseDynamicsWithWrenches [InverseDynamics.with_wrenches] = inverse_dynamics_with_wrenches(
                q: Positions, qd: Rates, qdd: Accelerations, wrenches: Wrenches
            ) -> Vector:
                "Torques when the robot exerts a force and a moment at each of its tips, in axes of the tip.",
                "wrenches[k]: force (N), then moment (N m), exerted BY the robot ON its environment, about the origin \
                 of tip k. The tips are the frames of the list tips of the robot file, in its order; without the list, \
                 the tip frame. tau: τ_free + Σ Jₖᵀ wₖ.";
            ForwardDynamicsWithWrenches [ForwardDynamics.with_wrenches] = forward_dynamics_with_wrenches(
                q: Positions, qd: Rates, tau: Torques, wrenches: Wrenches
            ) -> Vector:
                "Accelerations for positions `q`, velocities `qd`, torques `tau` and a wrench at each tip.",
                "wrenches: as in inverse_dynamics_with_wrenches. qdd: as in forward_dynamics.";
            InverseDynamicsOfFloatingBase [InverseDynamics.floating.with_wrenches] = inverse_dynamics_of_floating_base(
                q: Positions, qd: Rates, qdd: Accelerations, base: Base, wrenches: Wrenches
            ) -> FloatingTorques:
                "Torques of a robot with a floating base, and the wrench that must act on the base, for a given motion.",
                "base: as in inverse_dynamics_on_moving_base; only its acceleration less its gravity counts, which is \
                 what an inertial measurement unit reads. wrenches: as in inverse_dynamics_with_wrenches. wrench: \
                 force (N) and moment (N m) that must act ON the base beside gravity, about the origin of frame 0, in \
                 its axes; zero in free flight. tau: of the actuators.";
            FloatingMassMatrix [MassMatrix.floating] = floating_mass_matrix(q: Positions) -> FloatingMatrix:
                "The mass matrix of a robot with a floating base, symmetric: six rows of the base, then the joints.",
                "mass[i][j]: rows are the force (N) on the base, the moment (N m) about the origin of frame 0 and the \
                 torques; columns are the acceleration of this origin less gravity, the angular acceleration of the \
                 base and the accelerations of the joints. The base in axes of frame 0.";
            FloatingBias [BiasTorques.floating.with_wrenches] = floating_bias(
                q: Positions, qd: Rates, omega: BaseVelocity, wrenches: Wrenches
            ) -> FloatingVector:
                "Wrench on a floating base and torques, for zero accelerations: velocity products and tips.",
                "omega: angular velocity of the base (rad/s), in axes of frame 0. wrenches: as in \
                 inverse_dynamics_with_wrenches. bias: force (N), moment (N m) about the origin of frame 0, then \
                 torques, where the acceleration of this origin less gravity, the angular acceleration and those of \
                 the joints are zero.";
            FloatingForwardDynamics [ForwardDynamics.floating.with_wrenches] = floating_forward_dynamics(
                q: Positions, qd: Rates, tau: Torques, omega: BaseVelocity, wrenches: Wrenches
            ) -> FloatingAccelerations:
                "Accelerations of a floating base and of the joints for torques `tau`.",
                "omega, wrenches: as in floating_bias; beside the wrenches, only gravity acts. base: acceleration of \
                 the origin of frame 0 less gravity (m/s²), which an accelerometer reads, and angular acceleration \
                 (rad/s²), in axes of frame 0. qdd: of the joints. A base without mass makes the mass matrix \
                 singular: the numbers mean nothing or are not finite.";
            CentroidalMomentumMatrix [CentroidalMomentumMatrix.floating] = centroidal_momentum_matrix(q: Positions) -> FloatingRows:
                "The matrix A of a robot with a floating base: A v is its momentum about its centre of mass.",
                "map[i][j]: rows are the linear momentum (N s) and the angular momentum about the centre of mass \
                 (N m s); columns are the velocity of the origin of frame 0, the angular velocity of the base and the \
                 velocities of the joints. All vectors are in axes of frame 0.";
            CentroidalBias [CentroidalBias.floating] = centroidal_bias(q: Positions, qd: Rates, omega: BaseVelocity) -> Spatial:
                "The rate of the momentum about the centre of mass when all accelerations are zero.",
                "omega: angular velocity of the base (rad/s), in axes of frame 0. rate: force (N), then moment about \
                 the centre of mass (N m), in axes of frame 0. A times the accelerations, as in \
                 floating_mass_matrix, plus this rate is what acts on the robot beside gravity.";
            FloatingRegressor [Regressor.floating] = floating_regressor(
                q: Positions, qd: Rates, qdd: Accelerations, base: Base
            ) -> FloatingRegressor:
                "Wrench on a floating base and torques per inertial parameter of the base and of each link.",
                "base: as in inverse_dynamics_of_floating_base; the tips are free. regressor[i][j][k]: rows are the \
                 force (N) on the base, the moment (N m) about the origin of frame 0 and the torques; j is 0 for the \
                 base and counts the links from 1; k is the parameter, as in regressor. Those of the base refer to \
                 frame 0.";
            FloatingKineticEnergy [KineticEnergy.floating] = floating_kinetic_energy(q: Positions, qd: Rates, twist: BaseTwist) -> Number:
                "Kinetic energy of a robot with a floating base, J.",
                "twist: velocity of the origin of frame 0 (m/s), then angular velocity of the base (rad/s), in axes of \
                 frame 0. ½ vᵀ M v of these and of the joints, M as in floating_mass_matrix.";
            FloatingPotentialEnergy [PotentialEnergy.floating] = floating_potential_energy(q: Positions, pose: BasePose) -> Number:
                "Potential energy of such a robot in gravity, J; zero where a mass is at the origin of the world.",
                "pose: of frame 0 in the world, in whose axes the robot file has gravity; rotation and origin (m). -Σ \
                 m g·c, with c from the origin of the world to each centre of mass.";
            CentroidalMomentum [CentroidalMomentum.floating] = centroidal_momentum(q: Positions, qd: Rates, twist: BaseTwist) -> Spatial:
                "The momentum of a robot with a floating base, and its angular momentum about the centre of mass.",
                "twist: as in floating_kinetic_energy. momentum: linear (N s), then angular about the centre of mass \
                 (N m s), in axes of frame 0: centroidal_momentum_matrix times the velocities, in fewer operations.";
            TipJacobians [TipJacobians.floating] = tip_jacobians(q: Positions, base_rotation: BaseRotation) -> TipRows:
                "The Jacobian of each tip of a robot with a floating base, in world axes: linear rows, then angular.",
                "base_rotation: its columns are the axes of frame 0 in the world. jacobians[k]: times the velocities, it \
                 is the velocity of the origin of tip k (m/s) above its angular velocity (rad/s), in world axes; \
                 columns are the velocity of the origin of frame 0 and the angular velocity of the base, both in axes \
                 of frame 0, and the velocities of the joints. The identity as base_rotation gives base axes, the \
                 transpose of the rotation of a tip in frame 0 gives axes of this tip. The tips are those of \
                 inverse_dynamics_with_wrenches.";
            TipAccelerations [TipAccelerations.floating] = tip_accelerations(
                q: Positions, qd: Rates, omega: BaseVelocity, base_rotation: BaseRotation
            ) -> TipVectors:
                "J̇ v: accelerations of the tips where base and joints do not accelerate, in world axes, for a floating base.",
                "omega: angular velocity of the base (rad/s), in axes of frame 0. base_rotation: as in tip_jacobians. \
                 accelerations[k]: classical acceleration of the origin of tip k (m/s²), then its angular acceleration \
                 (rad/s²), where the acceleration of the origin of frame 0, the angular acceleration of the base and \
                 those of the joints are zero. At others, those of the tip are its Jacobian times them, plus these. No \
                 linear velocity enters.";
            ForwardDynamicsInContact [ForwardDynamicsInContact.floating] = forward_dynamics_in_contact(
                q: Positions, qd: Rates, tau: Torques, omega: BaseVelocity, base_rotation: BaseRotation
            ) -> AccelerationsAndWrenches:
                "Accelerations of a robot on a floating base while its contacts hold tips, and the wrenches of these.",
                "omega: as in floating_bias. base_rotation: as in tip_jacobians. The contacts are those of the list \
                 contacts of the robot file; their tips do not accelerate in the world, whose gravity is that of the \
                 file. accelerations: as in floating_forward_dynamics. wrenches_on_robot[k]: force (N), then moment \
                 (N m) about the origin of tip k, exerted ON the robot by its contact, in world axes; the moment of a \
                 point and all of a tip without a contact are zero. 1e-8 1/kg is added to the diagonal of J M⁻¹ Jᵀ, so \
                 that contacts that hold more than the robot can move have finite forces in double precision.";
            FloatingInverseDynamicsDerivatives [InverseDynamicsDerivatives.floating.with_wrenches] = floating_inverse_dynamics_derivatives(
                q: Positions, qd: Rates, qdd: Accelerations, base: Base, wrenches: Wrenches
            ) -> FloatingTorqueDerivatives:
                "Derivatives of `inverse_dynamics_of_floating_base` by q, by q̇ and by the angular velocity of the base.",
                "base, wrenches: as in inverse_dynamics_of_floating_base; the wrenches do not change in axes of their \
                 tips. dq[i][j], dqd[i][j], domega[i][k]: rows are the force (N) on the base, the moment (N m) about \
                 the origin of frame 0 and the torques; column j is joint j, column k is component k of the angular \
                 velocity of the base. The base in axes of frame 0, in which its acceleration less gravity stays the \
                 same; so its position and orientation do not enter. The derivative by the accelerations is \
                 floating_mass_matrix.";
            ClosureStep [ClosureStep.of_loops] = closure_step(q: Positions, passive: Passive) -> ClosureStep:
                "One Newton step towards closed loops: better positions of the dependent joints, and what is left.",
                "passive: positions of the dependent joints (rad, prismatic: m), a guess. passive of the result: after \
                 the step. residual: the equations of the loops at the guess, loop by loop: p₂ - p₁ of the two places \
                 (m), in the axes of the loop, then the products of axes that must be perpendicular. Where the guess \
                 is singular, the numbers are not finite.";
            LoopMap [LoopMap.of_loops] = loop_map(q: Positions, passive: Passive) -> PassiveRows:
                "The matrix G of closed loops: the velocities of the dependent joints are G q̇.",
                "passive: positions of the dependent joints that close the loops; steps of closure_step find them. \
                 map[i][j]: velocity of dependent joint i per velocity of joint j. Its transpose maps torques of dependent \
                 joints to torques of q. In a singular position the numbers are not finite.";
            LoopMapRateTimesVelocity [LoopMapRateTimesVelocity.of_loops] =
                loop_map_rate_times_velocity(q: Positions, passive: Passive, qd: Rates) -> PassiveVector:
                "Accelerations of the dependent joints of closed loops where the others do not accelerate: Ġ q̇.",
                "passive: as in loop_map. acceleration: rad/s², prismatic: m/s². Their accelerations are G q̈ plus these.";
            InverseDynamicsOfLoops [InverseDynamics.of_loops] = inverse_dynamics_of_loops(
                q: Positions, passive: Passive, qd: Rates, qdd: Accelerations
            ) -> Vector:
                "Torques of a robot with closed loops, of the joints that move by themselves.",
                "passive: as in loop_map. tau: what the actuators of the joints of q must deliver, Gᵀ times the torques of \
                 the tree; the dependent joints have no actuators.";
            InverseDynamicsOfLoopsWithWrenches [InverseDynamics.with_wrenches.of_loops] = inverse_dynamics_of_loops_with_wrenches(
                q: Positions, passive: Passive, qd: Rates, qdd: Accelerations, wrenches: Wrenches
            ) -> Vector:
                "Torques of a robot with closed loops when it exerts a force and a moment at each tip.",
                "passive: as in loop_map. wrenches: as in inverse_dynamics_with_wrenches. tau: as in \
                 inverse_dynamics_of_loops.";
            MassMatrixOfLoops [MassMatrix.of_loops] = mass_matrix_of_loops(q: Positions, passive: Passive) -> Matrix:
                "The mass matrix of a robot with closed loops, of the joints that move by themselves: symmetric.",
                "passive: as in loop_map. mass[i][j]: torque of joint i for a unit acceleration of joint j, from rest and \
                 without gravity; kg m², kg m or kg.";
            ForwardDynamicsOfLoops [ForwardDynamics.of_loops] = forward_dynamics_of_loops(
                q: Positions, passive: Passive, qd: Rates, tau: Torques
            ) -> Vector:
                "Accelerations of a robot with closed loops for torques `tau` of the joints that move by themselves.",
                "passive: as in loop_map. qdd: of the joints of q; those of the dependent joints are G q̈ + Ġ q̇.";
            InverseDynamicsOfFloatingLoops [InverseDynamics.floating.with_wrenches.of_loops] = inverse_dynamics_of_floating_loops(
                q: Positions, passive: Passive, qd: Rates, qdd: Accelerations, base: Base, wrenches: Wrenches
            ) -> FloatingTorques:
                "Torques of a robot with closed loops and a floating base, and the wrench on the base.",
                "passive: as in loop_map. base, wrenches, wrench: as in inverse_dynamics_of_floating_base. tau: as in \
                 inverse_dynamics_of_loops.";
            FloatingMassMatrixOfLoops [MassMatrix.floating.of_loops] = floating_mass_matrix_of_loops(q: Positions, passive: Passive) -> FloatingMatrix:
                "The mass matrix of a robot with closed loops and a floating base: six rows, then the joints.",
                "passive: as in loop_map. mass[i][j]: as in floating_mass_matrix, of the joints of q.";
            FloatingForwardDynamicsOfLoops [ForwardDynamics.floating.with_wrenches.of_loops] = floating_forward_dynamics_of_loops(
                q: Positions, passive: Passive, qd: Rates, tau: Torques, omega: BaseVelocity, wrenches: Wrenches
            ) -> FloatingAccelerations:
                "Accelerations of the base and of the joints of a robot with closed loops and a floating base.",
                "passive: as in loop_map. omega, wrenches, base: as in floating_forward_dynamics. qdd: as in \
                 forward_dynamics_of_loops.";
            TorqueGradient [TorqueGradient] = torque_gradient(
                q: Positions, qd: Rates, qdd: Accelerations, multipliers: Multipliers
            ) -> TorqueGradient:
                "The gradient of λᵀτ: of the torques of `inverse_dynamics`, each times its multiplier λ and added up.",
                "multipliers: λ, as an optimiser has them for the equations of motion. dq, dqd, dqdd: derivatives of \
                 λᵀτ by the positions, velocities and accelerations, which are λᵀ ∂τ/∂q, λᵀ ∂τ/∂q̇ and M(q) λ, in \
                 fewer operations. The unit of λᵀτ per that of the joint.";
            ForwardDynamicsDerivatives [ForwardDynamicsDerivatives] = forward_dynamics_derivatives(
                q: Positions, qd: Rates, tau: Torques
            ) -> AccelerationDerivatives:
                "∂q̈/∂q, ∂q̈/∂q̇ and ∂q̈/∂τ of `forward_dynamics`; row i is acceleration i.",
                "dq[i][j], dqd[i][j], dtau[i][j]: of acceleration i, by joint j; -M⁻¹ times the derivatives of the \
                 torques at these accelerations, and M⁻¹, which is symmetric. A singular mass matrix (a joint that \
                 moves nothing) gives numbers that are not finite.";
            InverseMassMatrixTimesTorques [InverseMassMatrixTimesTorques] = inverse_mass_matrix_times_torques(q: Positions, tau: Torques) -> Vector:
                "M(q)⁻¹ τ: the accelerations that torques add, in fewer operations than the inverse has.",
                "qdd: accelerations for the torques tau from rest and without gravity; at any motion, how the \
                 accelerations change with the torques. tau may be any vector, of torques or of impulses (N m s or N s): \
                 then qdd are the changes of the velocities. Rotor inertia in an arm with its rotors only. A singular \
                 mass matrix (a joint that moves nothing) gives numbers that are not finite.";
            InverseDynamicsDerivativesWithWrenches [InverseDynamicsDerivatives.with_wrenches] = inverse_dynamics_derivatives_with_wrenches(
                q: Positions, qd: Rates, qdd: Accelerations, wrenches: Wrenches
            ) -> TorqueDerivatives:
                "∂τ/∂q and ∂τ/∂q̇ of `inverse_dynamics_with_wrenches`; row i is torque i.",
                "dq[i][j], dqd[i][j]: of torque i, by joint j. wrenches: as in inverse_dynamics_with_wrenches; they do \
                 not change in axes of their tips. The derivative by q̈ is the mass matrix.";
            ForwardDynamicsDerivativesWithWrenches [ForwardDynamicsDerivatives.with_wrenches] = forward_dynamics_derivatives_with_wrenches(
                q: Positions, qd: Rates, tau: Torques, wrenches: Wrenches
            ) -> AccelerationDerivatives:
                "∂q̈/∂q, ∂q̈/∂q̇ and ∂q̈/∂τ of `forward_dynamics_with_wrenches`; row i is acceleration i.",
                "dq[i][j], dqd[i][j], dtau[i][j]: as in forward_dynamics_derivatives. wrenches: as in \
                 inverse_dynamics_derivatives_with_wrenches.";
            ForwardDynamicsDerivativesWithPayload [ForwardDynamicsDerivatives.with_payload] = forward_dynamics_derivatives_with_payload(
                q: Positions, qd: Rates, tau: Torques, payload: Payload
            ) -> AccelerationDerivatives:
                "∂q̈/∂q, ∂q̈/∂q̇ and ∂q̈/∂τ of `forward_dynamics_with_payload`; row i is acceleration i.",
                "dq[i][j], dqd[i][j], dtau[i][j]: as in forward_dynamics_derivatives. payload: as in \
                 inverse_dynamics_with_payload.";
            JacobianRate [JacobianRate] = jacobian_rate(q: Positions, qd: Rates) -> SpatialRows at jacobian_rate:
                "The rate J̇ of the geometric Jacobian at velocities `qd`, in world axes.",
                "rate[r][i]: of element (r, i) of jacobian. Its product with q̇ is jacobian_rate_times_velocity.";
            JacobianDerivatives [JacobianDerivatives] = jacobian_derivatives(q: Positions) -> SpatialMatrices at jacobian_derivatives:
                "∂J/∂q: the derivatives of the geometric Jacobian by the positions, in world axes.",
                "derivatives[r][i][j]: of element (r, i) of jacobian, by joint j. The three linear matrices are \
                 symmetric. The sum over j of these times q̇[j] is jacobian_rate.";
            TorqueHessian [TorqueHessian] = torque_hessian(
                q: Positions, qd: Rates, qdd: Accelerations, multipliers: Multipliers
            ) -> TorqueHessian:
                "The Hessian of λᵀτ: of the torques of `inverse_dynamics`, each times its multiplier λ and added up.",
                "multipliers: λ, as an optimiser has them for the equations of motion. dq_dq[i][j], dq_dqd[i][j], \
                 dqd_dqd[i][j], dq_dqdd[i][j]: second derivatives of λᵀτ by the position (dqd_dqd: velocity) of joint i \
                 and by the position, velocity or acceleration of joint j. dq_dq and dqd_dqd are symmetric. The other \
                 second derivatives, by q̇ and q̈ and by q̈ twice, are zero: the torques are linear in q̈, with M(q).";
            EulerStep [EulerStep] = euler_step(q: Positions, qd: Rates, tau: Torques, step: Step) -> NextState:
                "A step of the semi-implicit Euler method under torques `tau`: positions and velocities after it.",
                "step: its duration h (s). qd of the result: q̇ + h q̈ with the accelerations q̈ of forward_dynamics. q \
                 of the result: q plus h times these velocities. A singular mass matrix (a joint that moves nothing) \
                 gives numbers that are not finite.";
            EulerStepDerivatives [EulerStepDerivatives] = euler_step_derivatives(
                q: Positions, qd: Rates, tau: Torques, step: Step
            ) -> NextStateDerivatives:
                "Derivatives of `euler_step` by q, by q̇ and by τ: the linear model of a step.",
                "q.dq[i][j], q.dqd[i][j], q.dtau[i][j]: of position i after the step, by joint j; qd.dq and so on: of \
                 velocity i after the step. With the state x = (q, q̇), the matrices A and B of δx' = A δx + B δτ are \
                 made of these blocks.";
            FloatingEulerStep [EulerStep.floating.with_wrenches] = floating_euler_step(
                q: Positions, qd: Rates, tau: Torques, pose: BasePose, twist: BaseTwist, step: Step, wrenches: Wrenches
            ) -> FloatingNextState:
                "A step of the semi-implicit Euler method with a floating base: the state after it.",
                "pose: of frame 0 in the world, in whose axes the robot file has gravity. twist: as in \
                 floating_kinetic_energy. step: as in euler_step. wrenches: as in inverse_dynamics_with_wrenches; they \
                 do not change during the step. The velocities come first, by the accelerations of \
                 floating_forward_dynamics; then the origin of frame 0, the base and the joints move with the new \
                 ones. The base turns by the unit quaternion (1 - s, 2 u) / (1 + s) with u = h omega / 4 and s = u·u. \
                 The rotation after the step is orthogonal to rounding, however many steps came before. A base without \
                 mass gives numbers that mean nothing or are not finite.";
            FloatingEulerStepDerivatives [EulerStepDerivatives.floating.with_wrenches] = floating_euler_step_derivatives(
                q: Positions, qd: Rates, tau: Torques, pose: BasePose, twist: BaseTwist, step: Step, wrenches: Wrenches
            ) -> FloatingStepDerivatives:
                "Derivatives of `floating_euler_step` by positions, velocities and τ: the linear model of a step.",
                "pose, twist, step, wrenches: as in floating_euler_step; the wrenches do not change in axes of their \
                 tips. q_dq, q_dv, q_dtau: of the positions after the step by the positions, the velocities and the \
                 torques; v_dq, v_dv, v_dtau: of the velocities after the step. Six rows or columns of the base stand \
                 before those of the joints. A change of the positions of the base is a shift of its origin and a \
                 rotation vector, both in axes of frame 0 before the step for columns and after the step for rows. \
                 The velocities of the base are twist. A base without mass gives numbers that mean nothing or are not \
                 finite.";
            CoriolisTorques [CoriolisTorques] = coriolis_torques(q: Positions, qd: Rates) -> Vector:
                "Coriolis and centrifugal torques, C(q, q̇) q̇: the bias torques without gravity.",
                "tau: C(q, q̇) q̇, without gravity, accelerations and friction; bias_torques less gravity_torques.";
            FloatingInverseDynamicsWithPayload [InverseDynamics.floating.with_payload] = floating_inverse_dynamics_with_payload(
                q: Positions, qd: Rates, qdd: Accelerations, base: Base, payload: Payload
            ) -> FloatingTorques:
                "Torques, and the wrench on a floating base, when a payload is fixed to the tip.",
                "payload: as in inverse_dynamics_with_payload. base, wrench: as in inverse_dynamics_of_floating_base. The \
                 tips exert nothing.";
            FloatingMassMatrixWithPayload [MassMatrix.floating.with_payload] = floating_mass_matrix_with_payload(
                q: Positions, payload: Payload
            ) -> FloatingMatrix:
                "The mass matrix of a robot with a floating base and a payload at its tip: six rows, then the joints.",
                "payload: as in inverse_dynamics_with_payload. mass[i][j]: as in floating_mass_matrix.";
            FloatingBiasTorquesWithPayload [BiasTorques.floating.with_payload] = floating_bias_torques_with_payload(
                q: Positions, qd: Rates, omega: BaseVelocity, payload: Payload
            ) -> FloatingVector:
                "Force and moment on a floating base and torques where nothing accelerates, with a payload at the tip.",
                "payload: as in inverse_dynamics_with_payload. omega, bias: as in floating_bias. The tips exert nothing.";
            FloatingForwardDynamicsWithPayload [ForwardDynamics.floating.with_payload] = floating_forward_dynamics_with_payload(
                q: Positions, qd: Rates, tau: Torques, omega: BaseVelocity, payload: Payload
            ) -> FloatingAccelerations:
                "Accelerations of a floating base and of the joints for torques `tau`, with a payload at the tip.",
                "payload: as in inverse_dynamics_with_payload. omega, base, qdd: as in floating_forward_dynamics. The \
                 tips exert nothing.";
            GravityTorquesOfLoops [GravityTorques.of_loops] = gravity_torques_of_loops(q: Positions, passive: Passive) -> Vector:
                "Torques that hold a robot with closed loops still against gravity, of the joints that move by themselves.",
                "passive: as in loop_map. tau: Gᵀ times the gravity torques of the tree.";
            BiasTorquesOfLoops [BiasTorques.of_loops] = bias_torques_of_loops(
                q: Positions, passive: Passive, qd: Rates
            ) -> Vector:
                "Coriolis, centrifugal and gravity torques of a robot with closed loops: its torques at q̈ = 0.",
                "passive: as in loop_map. tau: of the joints of q; the dependent joints accelerate by Ġ q̇.";
            InverseDynamicsOfLoopsWithPayload [InverseDynamics.with_payload.of_loops] = inverse_dynamics_of_loops_with_payload(
                q: Positions, passive: Passive, qd: Rates, qdd: Accelerations, payload: Payload
            ) -> Vector:
                "Torques of a robot with closed loops when a payload is fixed to the tip.",
                "passive: as in loop_map. payload: as in inverse_dynamics_with_payload. tau: as in \
                 inverse_dynamics_of_loops.";
            GravityTorquesOfLoopsWithPayload [GravityTorques.with_payload.of_loops] = gravity_torques_of_loops_with_payload(
                q: Positions, passive: Passive, payload: Payload
            ) -> Vector:
                "Torques that hold a robot with closed loops and a payload at its tip still against gravity.",
                "passive, tau: as in gravity_torques_of_loops. payload: as in inverse_dynamics_with_payload.";
            BiasTorquesOfLoopsWithPayload [BiasTorques.with_payload.of_loops] = bias_torques_of_loops_with_payload(
                q: Positions, passive: Passive, qd: Rates, payload: Payload
            ) -> Vector:
                "Coriolis, centrifugal and gravity torques of a robot with closed loops and a payload at its tip.",
                "passive, tau: as in bias_torques_of_loops. payload: as in inverse_dynamics_with_payload.";
            MassMatrixOfLoopsWithPayload [MassMatrix.with_payload.of_loops] = mass_matrix_of_loops_with_payload(
                q: Positions, passive: Passive, payload: Payload
            ) -> Matrix:
                "The mass matrix of a robot with closed loops and a payload at its tip: symmetric.",
                "passive, mass[i][j]: as in mass_matrix_of_loops. payload: as in inverse_dynamics_with_payload.";
            ForwardDynamicsOfLoopsWithPayload [ForwardDynamics.with_payload.of_loops] = forward_dynamics_of_loops_with_payload(
                q: Positions, passive: Passive, qd: Rates, tau: Torques, payload: Payload
            ) -> Vector:
                "Accelerations of a robot with closed loops and a payload at its tip for torques `tau`.",
                "passive, qdd: as in forward_dynamics_of_loops. payload: as in inverse_dynamics_with_payload.";
            FloatingGravityTorques [GravityTorques.floating] = floating_gravity_torques(
                q: Positions, base_rotation: BaseRotation
            ) -> FloatingVector:
                "Wrench on a floating base and torques that hold a robot still against gravity.",
                "base_rotation: as in tip_jacobians. gravity: force (N) and moment (N m) about the origin of frame 0 \
                 that must act on the base, in axes of frame 0, then torques. Gravity is that of the robot file, in the \
                 axes of the world. The part of inverse_dynamics_of_floating_base that only gravity causes.";
        }
    };
}

/// The enum and the signatures.
macro_rules! signatures {
    ($(
        $variant:ident [$what:ident $(. $axis:ident)*] =
            $name:ident($($argument:ident: $kind:ident),*) -> $returned:ident $(at $of_frame:ident)?:
            $summary:literal $(, $details:literal)?;
    )*) => {
        named! {
            /// A function of a robot, named as its trait method.
            Function {
                $(#[doc = $summary] $variant = stringify!($name),)*
            }
        }

        /// The signatures, in the order of the variants.
        pub(crate) static SIGNATURES: &[Signature] = &[$(Signature {
            axes: Axes::of(What::$what)$(.$axis())*,
            summary: $summary,
            details: concat!("" $(, $details)?),
            arguments: &[$(Argument::$kind),*],
            returned: &returned::$returned,
            of_frame: [$(Some(stringify!($of_frame)),)? None][0],
        }),*];
    };
}

functions!(signatures);

/// The entries, in the order of the variants.
pub(crate) static TABLE: [Entry; Function::ALL.len()] = {
    let (mut entries, mut index) = ([Entry::NEW; Function::ALL.len()], 0);
    while index < Function::ALL.len() {
        let axes = SIGNATURES[index].axes;
        entries[index] = axes.what.entry(axes.base).for_robot(axes);
        // C and listings say something of each
        assert!(!entries[index].output.is_empty() && !entries[index].listed.is_empty());
        index += 1;
    }
    entries
};
