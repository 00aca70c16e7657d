//! `#[robot(…, tests)]`: the tests that derives write are in this binary and pass, and they notice code that is wrong.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::Command;

use rne::testing::{self, GoldenState, RobotFile};
use rne::{
    Actuation, BatchForwardDynamics, BatchInverseDynamics, BatchInverseDynamicsDerivatives, BatchMassMatrix,
    CentreOfMass, CoriolisMatrix, Energy, EulerStep, EulerStepDerivatives, ForwardDynamics, ForwardDynamicsDerivatives,
    InverseDynamics, InverseDynamicsDerivatives, InverseDynamicsGradient, InverseDynamicsHessian, JacobianDerivatives,
    JointWrenches, Kinematics, MassMatrix, MomentumObserver, MovingBase, Payload, Pose, Regressor, Scalar, Wrench,
};

#[derive(
    InverseDynamics,
    BatchInverseDynamics,
    MassMatrix,
    CoriolisMatrix,
    ForwardDynamics,
    Kinematics,
    Energy,
    CentreOfMass,
    Regressor,
    InverseDynamicsDerivatives,
    JointWrenches,
    MomentumObserver,
    MovingBase,
    Actuation,
    InverseDynamicsGradient,
    ForwardDynamicsDerivatives,
    JacobianDerivatives,
    InverseDynamicsHessian,
    EulerStep,
    EulerStepDerivatives,
    BatchMassMatrix,
    BatchForwardDynamics,
    BatchInverseDynamicsDerivatives,
)]
#[robot(path = "../robots/puma560.yaml", tests)]
struct Puma560;

#[derive(InverseDynamics, BatchInverseDynamics, MassMatrix, ForwardDynamics, Kinematics, Energy, MomentumObserver)]
#[robot(builtin = "puma560", form = "reduced", rotors, tests)]
struct Puma560Reduced;

#[derive(
    InverseDynamics,
    MassMatrix,
    ForwardDynamics,
    Kinematics,
    Energy,
    CentreOfMass,
    InverseDynamicsGradient,
    ForwardDynamicsDerivatives,
    InverseDynamicsHessian,
    EulerStep,
    EulerStepDerivatives,
)]
#[robot(builtin = "panda", form = "reduced", tests)]
struct Panda;

/// One joint slides, and gravity loads one joint alone.
#[derive(InverseDynamics, MassMatrix, ForwardDynamics, Kinematics, Energy, MomentumObserver)]
#[robot(builtin = "scara_cobra600", form = "reduced", tests)]
struct Scara {}

/// Small inertias at the end of a chain.
#[derive(InverseDynamics, MassMatrix, ForwardDynamics, Kinematics, Energy)]
#[robot(builtin = "so101", form = "reduced", tests)]
struct So101;

/// No joint turns.
#[derive(InverseDynamics, MassMatrix, ForwardDynamics, Kinematics, Energy)]
#[robot(builtin = "gantry_ppp", form = "reduced", tests)]
struct Gantry;

/// A golden file beside the robot file: m l²/3 q̈ + m g l/2 cos q.
#[derive(InverseDynamics)]
#[robot(path = "golden/rod.yaml", tests)]
struct Rod;

/// A joint follows another one.
#[derive(InverseDynamics, MassMatrix, ForwardDynamics, Actuation)]
#[robot(path = "../robots/trees/wam7_coupled.yaml", rotors, tests)]
struct Coupled;

/// Two fingers: a tree.
#[derive(InverseDynamics, MassMatrix, ForwardDynamics, Kinematics, Energy, rne::TipWrenches)]
#[robot(builtin = "panda_hand", tests)]
struct Hand;

/// Closed loops.
#[derive(rne::ClosedLoops, rne::ClosedLoopsPayloadDynamics)]
#[robot(path = "../benches/trees/loops/four_bar.yaml", form = "reduced", tests)]
struct FourBar;

/// Closed loops and a floating base.
#[derive(rne::ClosedLoops, rne::FloatingClosedLoops)]
#[robot(path = "../benches/trees/loops/floating_four_bar_leg.yaml", tests)]
struct Leg;

/// A floating base with two tips, one of which a contact holds.
#[derive(
    InverseDynamics,
    rne::PayloadDynamics,
    rne::TipWrenches,
    rne::FloatingBase,
    rne::FloatingPayloadDynamics,
    rne::CentroidalMomentum,
    rne::FloatingRegressor,
    rne::FloatingEnergy,
    rne::FloatingKinematics,
    rne::ContactDynamics,
    rne::FloatingInverseDynamicsDerivatives,
    rne::FloatingEulerStep,
    rne::FloatingEulerStepDerivatives,
)]
#[robot(
    form = "reduced",
    tests,
    yaml = "
    format: 2
    name: hopper
    source: own numbers
    convention: modified
    gravity: [0, 0, -9.81]
    floating_base: {name: trunk, link: {mass: 3.2, com: [0.01, -0.004, 0.03],
      inertia: {xx: 0.021, yy: 0.018, zz: 0.025}}}
    joints:
      - {name: hip, type: revolute, dh: {alpha: -pi/2, a: 0.02, theta: 0, d: 0.06},
         link: {mass: 0.9, com: [0.09, 0.005, 0.01], inertia: {xx: 0.0006, yy: 0.004, zz: 0.0042, xy: 0.0001}}}
      - {name: knee, type: revolute, dh: {alpha: 0, a: 0.2, theta: 0, d: 0.01},
         link: {mass: 0.35, com: [0.13, -0.008, 0.002], inertia: {xx: 0.00011, yy: 0.0021, zz: 0.0022, xz: 2.0e-5}}}
      - {name: arm, parent: trunk, type: prismatic, dh: {gamma: 0, b: 0, alpha: pi/3, a: 0.1, theta: 0, d: 0},
         link: {mass: 0.2, com: [0, 0.01, 0.05], inertia: {xx: 0.0003, yy: 0.0003, zz: 0.0001}}}
    frames:
      - {name: foot, on: knee, xyz: [0.2, 0, 0]}
      - {name: hand, on: arm, xyz: [0, 0, 0.1]}
    tips: [foot, hand]
    contacts: [{tip: foot, kind: point}]
"
)]
struct Hopper;

mod elsewhere {
    pub(crate) mod dynamics {
        pub(crate) use rne::*;
    }

    use rne::InverseDynamics;

    /// A rod whose last link has no inertia: no accelerations.
    #[derive(InverseDynamics, rne::ForwardDynamics)]
    #[robot(crate = self::dynamics, tests, yaml = "
        format: 1
        name: massless
        source: own numbers
        convention: standard
        gravity: [0, -9.81, 0]
        joints:
          - {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0], inertia: {}}}
          - {type: revolute, dh: {theta: 0, d: 0, a: 0.5, alpha: 0}}
    ", allow_lints)]
    pub(crate) struct Massless;

    #[derive(InverseDynamics)]
    #[robot(crate = dynamics, builtin = "planar2", tests)]
    pub(crate) struct Planar;
}

#[test]
fn each_derive_has_its_tests() {
    let list = Command::new(std::env::current_exe().expect("this program")).arg("--list").output().expect("a list");
    let list = String::from_utf8(list.stdout).expect("names");
    for (module, tests) in [
        ("puma560_inverse_dynamics_tests", 8),
        ("puma560_batch_inverse_dynamics_tests", 1),
        ("puma560_batch_mass_matrix_tests", 1),
        ("puma560_batch_forward_dynamics_tests", 1),
        ("puma560_batch_inverse_dynamics_derivatives_tests", 1),
        ("puma560_mass_matrix_tests", 4),
        ("puma560_coriolis_matrix_tests", 2),
        ("puma560_forward_dynamics_tests", 2),
        ("puma560_kinematics_tests", 6),
        ("puma560_energy_tests", 3),
        ("puma560_centre_of_mass_tests", 2),
        ("puma560_regressor_tests", 1),
        ("puma560_inverse_dynamics_derivatives_tests", 1),
        ("puma560_joint_wrenches_tests", 1),
        ("puma560_momentum_observer_tests", 2),
        ("puma560_moving_base_tests", 1),
        ("puma560_actuation_tests", 1),
        ("puma560_reduced_inverse_dynamics_tests", 8),
        ("rod_inverse_dynamics_tests", 8),
        ("rod_golden_tests", 1),
        ("puma560_golden_tests", 0),
        ("four_bar_closed_loops_tests", 9),
        ("four_bar_closed_loops_payload_dynamics_tests", 5),
        ("leg_floating_closed_loops_tests", 3),
        ("hopper_floating_base_tests", 5),
        ("hopper_contact_dynamics_tests", 1),
        ("elsewhere::massless_forward_dynamics_tests", 2),
        ("elsewhere::planar_inverse_dynamics_tests", 8),
    ] {
        let found = list.lines().filter(|line| line.starts_with(&format!("{module}::"))).count();
        assert_eq!(found, tests, "{module} in\n{list}");
    }
}

const TEXT: &str = include_str!("../robots/puma560.yaml");
const SEVEN_STEPS: RobotFile = RobotFile { text: TEXT, rotors: false, seven_steps: true };
const REDUCED: RobotFile = RobotFile { seven_steps: false, ..SEVEN_STEPS };

/// A mistake of a code generator.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Mistake {
    /// None: the derived code.
    None,
    /// The last bits of a torque.
    LastBits,
    /// One part in 10^11.
    SmallFactor,
    /// A term of accelerations that is not linear.
    Square,
    /// Gravity and bias alone.
    Gravity,
    /// An element below the diagonal alone.
    Below,
    /// A direction is the opposite.
    Sign,
    /// A torque that is no number.
    NotANumber,
}

/// The PUMA 560 with a mistake.
struct Wrong(Mistake);

impl Wrong {
    fn spoil<T: Scalar>(&self, mut tau: [T; 6], qdd: &[T; 6]) -> [T; 6] {
        let of = T::from_f64;
        match self.0 {
            Mistake::LastBits => tau[3] *= of(1.0 + 4.0 * f64::EPSILON),
            Mistake::SmallFactor => tau[1] *= of(1.0 + 1e-11),
            Mistake::Square => tau[0] += qdd[1] * qdd[1] * of(1e-6),
            Mistake::Sign => tau[2] = -tau[2],
            Mistake::NotANumber => tau[5] = of(f64::NAN),
            Mistake::None | Mistake::Gravity | Mistake::Below => {}
        }
        tau
    }
}

impl InverseDynamics<6> for Wrong {
    fn inverse_dynamics<T: Scalar>(&self, q: &[T; 6], qd: &[T; 6], qdd: &[T; 6]) -> [T; 6] {
        self.spoil(Puma560.inverse_dynamics(q, qd, qdd), qdd)
    }
    fn inverse_dynamics_with_wrench<T: Scalar>(
        &self,
        q: &[T; 6],
        qd: &[T; 6],
        qdd: &[T; 6],
        wrench: &Wrench<T>,
    ) -> [T; 6] {
        Puma560.inverse_dynamics_with_wrench(q, qd, qdd, wrench)
    }
    fn inverse_dynamics_with_payload<T: Scalar>(
        &self,
        q: &[T; 6],
        qd: &[T; 6],
        qdd: &[T; 6],
        payload: &Payload<T>,
    ) -> [T; 6] {
        Puma560.inverse_dynamics_with_payload(q, qd, qdd, payload)
    }
    fn inverse_dynamics_from_sin_cos<T: Scalar>(
        &self,
        sin: &[T; 6],
        cos: &[T; 6],
        q: &[T; 6],
        qd: &[T; 6],
        qdd: &[T; 6],
    ) -> [T; 6] {
        Puma560.inverse_dynamics_from_sin_cos(sin, cos, q, qd, qdd)
    }
    fn gravity_torques<T: Scalar>(&self, q: &[T; 6]) -> [T; 6] {
        let [first, second, rest @ ..] = Puma560.gravity_torques(q);
        let [a, b, c, d] = rest;
        let second = if self.0 == Mistake::Gravity { second + T::from_f64(1e-9) } else { second };
        [first, second, a, b, c, d]
    }
    fn bias_torques<T: Scalar>(&self, q: &[T; 6], qd: &[T; 6]) -> [T; 6] {
        Puma560.bias_torques(q, qd)
    }
}

impl MassMatrix<6> for Wrong {
    fn mass_matrix<T: Scalar>(&self, q: &[T; 6]) -> [[T; 6]; 6] {
        let mut mass = Puma560.mass_matrix(q);
        if self.0 == Mistake::Below {
            mass[2][1] *= T::from_f64(1.0 + 4.0 * f64::EPSILON);
        }
        mass
    }
}

impl ForwardDynamics<6> for Wrong {
    fn forward_dynamics<T: Scalar>(&self, q: &[T; 6], qd: &[T; 6], tau: &[T; 6]) -> [T; 6] {
        self.spoil(Puma560.forward_dynamics(q, qd, tau), tau)
    }
}

impl Energy<6> for Wrong {
    fn kinetic_energy<T: Scalar>(&self, q: &[T; 6], qd: &[T; 6]) -> T {
        let energy = Puma560.kinetic_energy(q, qd);
        if self.0 == Mistake::SmallFactor { energy * T::from_f64(1.0 + 1e-9) } else { energy }
    }
    fn potential_energy<T: Scalar>(&self, q: &[T; 6]) -> T {
        let energy = Puma560.potential_energy(q);
        if self.0 == Mistake::Sign { -energy } else { energy }
    }
}

impl Kinematics<6> for Wrong {
    fn forward_kinematics<T: Scalar>(&self, q: &[T; 6]) -> Pose<T> {
        let mut pose = Puma560.forward_kinematics(q);
        if self.0 == Mistake::SmallFactor {
            pose.rotation[0] = pose.rotation[0].map(|x| x * T::from_f64(1.0 + 1e-9));
        }
        pose
    }
    fn link_poses<T: Scalar>(&self, q: &[T; 6]) -> [Pose<T>; 6] {
        Puma560.link_poses(q)
    }
    fn jacobian<T: Scalar>(&self, q: &[T; 6]) -> [[T; 6]; 6] {
        let mut jacobian = Puma560.jacobian(q);
        if self.0 == Mistake::Sign {
            jacobian[0] = jacobian[0].map(|x| -x);
        }
        jacobian
    }
    fn jacobian_rate_times_velocity<T: Scalar>(&self, q: &[T; 6], qd: &[T; 6]) -> [T; 6] {
        Puma560.jacobian_rate_times_velocity(q, qd)
    }
}

type Test = fn(&Wrong, &RobotFile);

/// The test that a derive writes for a function.
macro_rules! same {
    ($name:ident($($argument:ident),*) of $robot:ident, $file:ident) => {
        testing::is_that_of_the_runtime($file, stringify!($name), |given| {
            testing::numbers($robot.$name($(testing::array(given.$argument)),*))
        })
    };
}

fn torques(robot: &Wrong, file: &RobotFile) {
    same!(inverse_dynamics(q, qd, qdd) of robot, file);
}

/// What a test says of the robot with a mistake; `None` when it passes.
fn said(test: Test, mistake: Mistake, file: &RobotFile) -> Option<String> {
    let panic = catch_unwind(AssertUnwindSafe(|| test(&Wrong(mistake), file))).err()?;
    Some(*panic.downcast::<String>().expect("words"))
}

#[test]
fn wrong_code_is_noticed() {
    use Mistake::{Below, Gravity, LastBits, NotANumber, SmallFactor, Square};
    let linear = testing::torques_are_linear_in_accelerations::<6, Wrong>;
    let at_rest = testing::gravity_and_bias_are_torques_without_motion::<6, Wrong>;
    let symmetric = testing::mass_matrix_is_symmetric::<6, Wrong>;
    let caused = testing::accelerations_need_the_torques_that_cause_them::<6, Wrong>;
    let kinetic = testing::kinetic_energy_is_that_of_the_mass_matrix::<6, Wrong>;
    let orthonormal = testing::rotations_are_orthonormal::<6, Wrong>;
    let cases: [(Test, &[Mistake], &[Mistake]); 14] = [
        // the test, what it notices of the seven steps, what of the reduced form
        (torques, &[LastBits, SmallFactor, Square, NotANumber], &[SmallFactor, Square, NotANumber]),
        (|robot, file| same!(gravity_torques(q) of robot, file), &[Gravity], &[Gravity]),
        (linear, &[Square, NotANumber], &[Square, NotANumber]),
        (at_rest, &[Gravity, SmallFactor, Mistake::Sign], &[Gravity, SmallFactor, Mistake::Sign]),
        (|robot, file| same!(mass_matrix(q) of robot, file), &[Below], &[]),
        (symmetric, &[Below], &[Below]),
        (
            |robot, file| same!(forward_dynamics(q, qd, tau) of robot, file),
            &[LastBits, Square, NotANumber],
            &[Square, NotANumber],
        ),
        (caused, &[Square, Mistake::Sign, NotANumber], &[Square, Mistake::Sign, NotANumber]),
        (|robot, file| same!(kinetic_energy(q, qd) of robot, file), &[SmallFactor], &[SmallFactor]),
        (|robot, file| same!(potential_energy(q) of robot, file), &[Mistake::Sign], &[Mistake::Sign]),
        (kinetic, &[SmallFactor], &[SmallFactor]),
        (|robot, file| same!(forward_kinematics(q) of robot, file), &[SmallFactor], &[SmallFactor]),
        (|robot, file| same!(jacobian(q) of robot, file), &[Mistake::Sign], &[Mistake::Sign]),
        (orthonormal, &[SmallFactor], &[SmallFactor]),
    ];
    for (index, (test, of_seven_steps, of_reduced)) in cases.into_iter().enumerate() {
        for (file, mistakes) in [(&SEVEN_STEPS, of_seven_steps), (&REDUCED, of_reduced)] {
            assert_eq!(said(test, Mistake::None, file), None, "test {index}");
            for &mistake in mistakes {
                assert!(
                    said(test, mistake, file).is_some(),
                    "test {index}, {mistake:?}, seven steps: {}",
                    file.seven_steps
                );
            }
        }
    }
}

#[test]
fn a_failing_test_says_where() {
    let said = said(torques, Mistake::Sign, &REDUCED).expect("words");
    for part in ["inverse_dynamics: number 2 is ", ", not ", "(allowed: 1e-12 of the largest)", "\n  q   = ["] {
        assert!(said.contains(part), "no `{part}` in {said}");
    }
}

/// The states of a golden file whose second torque of the second line is this.
fn golden(torque: f64) -> [GoldenState<6>; 2] {
    let state = |line, qdd: f64| {
        let (q, qd, qdd) = ([0.3, -0.8, 0.5, 1.1, -0.4, 0.6], [0.5; 6], [qdd; 6]);
        GoldenState { line, q, qd, qdd, tau: Puma560.inverse_dynamics(&q, &qd, &qdd) }
    };
    let [first, mut second] = [state(4, 1.0), state(7, -2.0)];
    second.tau[1] += torque;
    [first, second]
}

#[test]
fn a_golden_file_is_compared_line_by_line() {
    let said = |robot: &Wrong, tolerance, states: &[GoldenState<6>]| {
        let test = || {
            let file = "robots/arm.golden.csv";
            testing::torques_are_those_of_the_golden_file(robot, file, &Puma560::JOINT_NAMES, tolerance, states);
        };
        let panic = catch_unwind(AssertUnwindSafe(test)).err()?;
        Some(*panic.downcast::<String>().expect("words"))
    };
    let right = Wrong(Mistake::None);
    let [_, second] = golden(0.0);
    let largest = golden(0.0).iter().flat_map(|state| state.tau).fold(0.0, |a: f64, b| a.max(b.abs()));
    assert_eq!(said(&right, 1e-9, &golden(0.0)), None);
    // within the tolerance, and beyond
    assert_eq!(said(&right, 1e-9, &golden(0.9e-9 * largest)), None);
    let words = said(&right, 1e-9, &golden(1.1e-9 * largest)).expect("words");
    let joint = Puma560::JOINT_NAMES[1];
    let start = format!("robots/arm.golden.csv:7: the torque of {joint} is {:e}, not ", second.tau[1]);
    assert!(words.starts_with(&start) && words.contains("1e-9 of the largest torque"), "{words}");
    assert_eq!(words.matches("the torque of").count(), 1, "{words}");
    // wrong code
    for mistake in [Mistake::Sign, Mistake::NotANumber, Mistake::Square] {
        assert!(said(&Wrong(mistake), 1e-9, &golden(0.0)).is_some(), "{mistake:?}");
    }
}
