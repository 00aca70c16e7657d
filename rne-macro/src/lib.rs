//! The derive macros of `rne`; use them through that crate.
//!
//! A shell: the attribute, the file and the messages are handled here, everything else is `rne-codegen`.
#![forbid(unsafe_code)]

mod attribute;
mod batch;
mod description;
mod error;
mod expand;
mod implementation;
mod inspection;
mod location;
mod own_tests;
mod parameters;
#[cfg(test)]
mod tests;
mod warning;

use proc_macro::TokenStream;
use rne_codegen::Capability;

/// Implements the trait `InverseDynamics` for a struct: the robot of a robot file, compiled together with the struct.
///
/// ```ignore
/// use rne::InverseDynamics;
///
/// #[derive(InverseDynamics)]
/// #[robot(path = "../robots/puma560.yaml")]
/// pub struct Puma560;
///
/// let tau: [f64; 6] = Puma560.inverse_dynamics(&q, &qd, &qdd);
/// ```
///
/// The robot file is read by the compiler. The recursion is unrolled for this one robot, everything that its table
/// makes zero or one is folded, and what is left are straight-line methods: no allocation, no panic, no loop, no
/// branch, no `unsafe`. They are generic over the scalar and need neither `std` nor the file at run time. A change of
/// the file causes a new build.
///
/// The struct may have lifetimes and parameters, which the methods do not use. A field is a run-time parameter, see
/// below.
///
/// The methods name their variables as the textbook does, `m1`, `w2_z`, `tau3`. A constant of such a name that is in
/// scope where the struct stands (`const m1: f64`, against Rust's custom of capitals) would take their place and fail
/// to compile; put the struct into a module of its own then.
///
/// # `path = "…"`
///
/// The robot file. A relative path starts at the folder of the source file, as with `include_str!`. Where a macro is
/// not told its source file, as in some editors, it is looked for from the package's `src`, from its folder (that of
/// `Cargo.toml`), and then from every folder with sources.
///
/// # `yaml = "…"`
///
/// The text of a robot file, in place of `path`:
///
/// ```
/// use rne::InverseDynamics;
///
/// /// A uniform rod of 2.5 kg and 0.8 m that turns about one end, and hangs along x.
/// #[derive(InverseDynamics)]
/// #[robot(yaml = "
///     format: 1
///     name: rod
///     source: lecture 38, one-link example
///     convention: standard
///     gravity: [9.81, 0, 0]
///     joints:
///       - type: revolute
///         dh: {theta: 0, d: 0, a: 0.8, alpha: 0}
///         link: {mass: 2.5, com: [-0.4, 0, 0], inertia: {yy: 2.5*0.8^2/12, zz: 2.5*0.8^2/12}}
/// ")]
/// struct Rod;
///
/// let [tau] = Rod.inverse_dynamics(&[0.6], &[1.3], &[-0.7]);
/// assert!((tau - (2.5 * 0.8 * 0.8 * -0.7 / 3.0 + 2.5 * 9.81 * 0.4 * 0.6_f64.sin())).abs() < 1e-14);
/// ```
///
/// # `builtin = "…"`
///
/// A robot that `rne` ships, by its name; `rne list` prints them, and a wrong name is answered with all of them.
///
/// ```
/// use rne::InverseDynamics;
///
/// #[derive(InverseDynamics)]
/// #[robot(builtin = "puma560", form = "reduced")]
/// struct Puma560;
///
/// let [.., wrist]: [f64; 6] = Puma560.inverse_dynamics(&[0.0; 6], &[0.0; 6], &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
/// assert!(wrist > 0.0);
/// ```
///
/// # `form = "seven_steps"`
///
/// How the torques are computed.
///
/// | form | |
/// |---|---|
/// | `seven_steps` | the default: every intermediate value is one of the textbook's ω, ω̇, ċ, c̈, g, f, n of a link; the bits are those of `rne::Arm` |
/// | `reduced` | about half the operations: regrouped inertias, shared kinematics, choices per joint; only the torques keep a meaning. A few percent less where `rne search --rewrite` left a graph in the plan file |
///
/// A form that is not the seven steps is proved identical to them while it is compiled, in exact arithmetic; its
/// documentation says so, with its rounding error. The choices come from `NAME.plan.yaml` beside the robot file, which
/// `rne search` writes; a plan that does not belong to the robot any more is an error of the build. Cargo watches a
/// plan that a build has read; one that appears later, other than by `rne search`, is seen when the robot file is
/// touched. Without a plan, a fixed number of plans is tried, the same on every machine.
///
/// Products that are added become `Scalar::mul_add` in this form: one instruction where the target has it, and on x86
/// where the processor has it, see [`inline`](#inline).
///
/// ```
/// # use rne::InverseDynamics;
/// #[derive(InverseDynamics)]
/// #[robot(form = "reduced", yaml = "
///     format: 1
///     name: slide
///     source: own numbers
///     convention: standard
///     gravity: [0, 0, -9.81]
///     joints:
///       - {type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 2}}
///       - {type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 1}}
/// ")]
/// struct Slides;
///
/// let [below, above]: [f64; 2] = Slides.inverse_dynamics(&[0.0; 2], &[0.0; 2], &[1.0, 0.5]);
/// assert!((above - (1.0 + 0.5 + 9.81)).abs() < 1e-13);
/// assert!((below - above - 2.0 * (1.0 + 9.81)).abs() < 1e-13);
/// ```
///
/// # `rotors`
///
/// The arm with its rotors: `#[robot(path = "…", rotors)]` makes G² Jm q̈ of the motors a part of the torques of
/// `inverse_dynamics` and its variants, of the mass matrix, of forward dynamics and of kinetic energy; `Actuation` then
/// adds friction alone. Every derive of the type takes it. A robot without motors stays as it is.
///
/// ```
/// use rne::{ForwardDynamics, InverseDynamics};
///
/// #[derive(InverseDynamics, ForwardDynamics)]
/// #[robot(rotors, yaml = "
/// format: 1
/// name: geared
/// source: own
/// convention: standard
/// gravity: [0, 0, -9.81]
/// joints: [{type: revolute, dh: {theta: 0, d: 0, a: 1, alpha: 0}, link: {inertia: {zz: 0.5}},
///           motor: {inertia: 2.0e-4, gear_ratio: 50}}]
/// ")]
/// struct Geared;
///
/// // 0.5 kg m² of the link, 50² 2e-4 of the rotor
/// assert_eq!(Geared.inverse_dynamics(&[0.0], &[0.0], &[2.0]), [2.0]);
/// assert_eq!(Geared.forward_dynamics(&[0.0], &[0.0], &[2.0]), [2.0]);
/// ```
///
/// # `inline`
///
/// In the form `reduced` a call in `f64` or `f32` takes the AVX2 and the fused multiply-add of an x86 processor that
/// has them, in a plain `cargo build --release`, with `std` and the feature `batch` (both are on by default). The
/// processor is asked once; a call then costs a nanosecond or two more than the code itself, for it is a call. Methods
/// so short that this does not pay do not ask, nor does a program that is compiled for such processors
/// (`-C target-cpu=x86-64-v3`). Results have the bits of such a program, and on other processors those of a plain one:
/// they differ in the last digits. `seven_steps` has the same bits on all of them.
///
/// `#[robot(path = "…", form = "reduced", inline)]` leaves it out: the code is compiled for the target of the build
/// alone, as other functions are, and may be inlined. That pays
///
/// - in a tight loop of your own that the compiler can work into the code: over calls that share arguments, or of a
///   short arm whose calls wait for each other,
/// - in a function of yours that is compiled for more by `#[target_feature(enable = "…")]`; with
///   `-C target-cpu=x86-64-v3` for the whole program nothing need be said,
/// - where results have to have the same bits on all processors of x86.
///
/// Code for many states at once needs none of this: `BatchInverseDynamics`.
///
/// ```
/// use rne::InverseDynamics;
///
/// #[derive(InverseDynamics)]
/// #[robot(builtin = "planar3", form = "reduced", inline)]
/// struct Fingers;
///
/// let tau = (0..100).map(|step| Fingers.gravity_torques(&[0.01 * f64::from(step), 0.5, -0.2])[0]);
/// assert!(tau.fold(0.0, f64::max) > 0.0);
/// ```
///
/// # `tests`
///
/// Tests of the code in your own crate, run by `cargo test` with the rest:
///
/// ```
/// use rne::{InverseDynamics, Kinematics};
///
/// #[derive(InverseDynamics, Kinematics)]
/// #[robot(builtin = "puma560", tests)]
/// struct Puma560;
/// ```
///
/// ```text
/// test puma560_inverse_dynamics_tests::gravity_and_bias_are_torques_without_motion ... ok
/// test puma560_inverse_dynamics_tests::torques_are_linear_in_accelerations ... ok
/// test puma560_inverse_dynamics_tests::torques_are_those_of_the_runtime ... ok
/// test puma560_kinematics_tests::kinematics_are_those_of_the_runtime ... ok
/// test puma560_kinematics_tests::rotations_are_orthonormal ... ok
/// ```
///
/// Each derive writes a private module under `#[cfg(test)]` whose tests use its trait alone. They compare the code with
/// `rne::Arm` of the same robot file at 48 fixed states: bit for bit where the seven steps are the operations of `Arm`,
/// otherwise within 1e-12 of the largest number. (In the reduced form, `forward_dynamics` is not compared with `Arm`
/// directly, but by the torques that its accelerations need.) They also check laws of mechanics: torques are linear in
/// accelerations, M is symmetric, the accelerations of τ need τ, rotations are orthonormal, T = ½ q̇ᵀ M q̇. A failing
/// test names the function, the number and the state.
///
/// Torques that somebody else has computed or measured stand beside `NAME.yaml` as `NAME.golden.csv`: `InverseDynamics`
/// reads them when your crate is compiled, and writes a test that compares them. `docs/robot-file.md` has the format.
///
/// The tests need the features `arm` and `std` of `rne`; under `[dev-dependencies]` they cost the library nothing. They
/// make a value of the struct, so it has neither fields nor generics, and stands in a module, not in a function.
///
/// # `max_ops = N`
///
/// The build fails when one call of `inverse_dynamics` takes more than `N` multiplications and additions together: a
/// budget that a change of the table cannot exceed unnoticed. `rne ops FILE`, or the constant `OPERATIONS`, tells how
/// many there are.
///
/// ```
/// # use rne::InverseDynamics;
/// #[derive(InverseDynamics)]
/// #[robot(max_ops = 10, yaml = "
///     format: 1
///     name: slide
///     source: own numbers
///     convention: standard
///     gravity: [0, 0, -9.81]
///     joints:
///       - {type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 2}}
/// ")]
/// struct Slide;
///
/// assert!(Slide::OPERATIONS.total() <= 10);
/// ```
///
/// # `crate = path`
///
/// Where the generated code finds `rne`, when that is not `::rne`: under another name, or re-exported by another crate.
/// A path, bare or in quotes, like serde's.
///
/// ```
/// mod dynamics {
///     pub use rne::*;
/// }
///
/// #[derive(dynamics::InverseDynamics)]
/// #[robot(crate = crate::dynamics, yaml = "
///     format: 1
///     name: slide
///     source: own numbers
///     convention: standard
///     gravity: [0, 0, -9.81]
///     joints:
///       - {type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 2}}
/// ")]
/// struct Slide;
/// # fn main() {}
/// ```
///
/// # Run-time parameters
///
/// A name under `parameters:` of the robot file that is also a field of the struct stays free until run time;
/// everything else is folded. The field is `f32` or `f64`. All derives read it.
///
/// ```
/// use rne::InverseDynamics;
///
/// /// A rod of 2.5 kg that carries something at its end.
/// #[derive(InverseDynamics)]
/// #[robot(yaml = "
///     format: 1
///     name: rod
///     source: own numbers
///     convention: standard
///     gravity: [9.81, 0, 0]
///     parameters: {payload: 0}
///     joints:
///       - {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0]}}
///       - {type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 0.1 + payload}}
/// ")]
/// struct Rod {
///     payload: f64,
/// }
///
/// let torque = |payload| Rod { payload }.gravity_torques(&[0.5, 0.0])[0];
/// assert!((torque(2.0) - torque(0.0) - 2.0 * 9.81 * 0.8 * 0.5_f64.sin()).abs() < 1e-14);
/// ```
///
/// Angles are constants, and so is every number that is zero in the file, for zeros are folded: a parameter that would
/// make one of these vary is an error of the build, and so is a field that is no parameter. `#[robot(skip)]` on a field
/// says that it is there for other purposes; fields without names and `PhantomData` are. With such parameters
/// `form = "reduced"` regroups nothing: it computes every value of the seven steps once.
///
/// # Constants
///
/// The type gets, as visible as it is itself:
///
/// | constant | |
/// |---|---|
/// | `DOF: usize` | number of joints |
/// | `NAME: &str` | name of the robot |
/// | `JOINT_NAMES: [&str; DOF]` | base to tip |
/// | `POSITION_LIMITS: [(f64, f64); DOF]` | lowest and highest, rad or m; infinite where the file has none |
/// | `VELOCITY_LIMITS: [f64; DOF]` | rad/s or m/s; infinite where the file has none |
/// | `EFFORT_LIMITS: [f64; DOF]` | N m or N; infinite where the file has none |
/// | `OPERATIONS: rne::Operations` | what one call of `inverse_dynamics` takes |
///
/// # Errors and lints
///
/// A mistake in the robot file is an error of the compiler with file, line, column, the line itself, what is allowed,
/// and often what was probably meant. Whatever uses the struct still compiles, so that the mistake stands alone.
///
/// A lint, a value that is allowed and yet probably not what was meant, is a warning of the compiler under the path in
/// the attribute: degrees for radians, 1.5708 for pi/2, a joint that no inertia resists, millimetres, a mass without
/// its inertia. It says file, line, column and what to write instead:
///
/// ```text
/// warning: use of deprecated constant `_::ROBOT_FILE`: arm.yaml:8:45: the angle `90` rad is more than a full turn
///          if these are degrees, write `deg(90)`
///   --> src/main.rs:4:16
///    |
///  4 | #[robot(path = "../robots/arm.yaml")]
///    |                ^^^^^^^^^^^^^^^^^^^^^
/// ```
///
/// A macro has no way of its own to warn, so a constant that is marked as deprecated is used there. Where warnings are
/// errors, by `#![deny(warnings)]` or `-D warnings`, a lint is one too, as every warning of such a crate. What
/// published tables have, as tensors that violate the triangle inequality, is a note: `rne check FILE` shows it, a
/// build does not.
///
/// # `inspect`
///
/// `#[robot(path = "…", inspect)]` writes the code as a file to read, with the formulas of each step and the meaning of
/// every name, beside what the compiler writes: `target/debug/rne/NAME.InverseDynamics.seven_steps.rs`. Who meets
/// `w2_z` in a debugger finds it there; `rne explain w2_z FILE` tells what it is computed from.
///
/// # `allow_lints`
///
/// The lints are known, the numbers are meant: `#[robot(path = "…", allow_lints)]` has no warnings of the robot file.
/// `#[allow(deprecated)]` on the struct does the same. A point mass is said in the file, by `inertia: {}`.
#[proc_macro_derive(InverseDynamics, attributes(robot))]
pub fn derive_inverse_dynamics(input: TokenStream) -> TokenStream {
    expand::capability(Capability::InverseDynamics, input.into()).into()
}

/// Implements the trait `BatchInverseDynamics` for a struct that derives `InverseDynamics` too: torques of many states
/// at once.
///
/// ```
/// use rne::{BatchInverseDynamics, InverseDynamics};
///
/// #[derive(InverseDynamics, BatchInverseDynamics)]
/// #[robot(yaml = "
///     format: 1
///     name: rod
///     source: own numbers
///     convention: standard
///     gravity: [9.81, 0, 0]
///     joints:
///       - {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0]}}
/// ")]
/// struct Rod;
///
/// let q = [0.1, 0.2, 0.3, 0.4, 0.5]; // one slice per joint, one number per state
/// let mut tau = [0.0; 5];
/// Rod.inverse_dynamics_batch([&q], [&[0.0; 5]], [&[0.0; 5]], [&mut tau])?;
/// assert!((tau[4] - 2.5 * 9.81 * 0.4 * 0.5_f64.sin()).abs() < 1e-14);
/// # Ok::<(), rne::LengthMismatch>(())
/// ```
///
/// Both derives read the same attribute, which [`InverseDynamics`](macro@InverseDynamics) explains and whose mistakes
/// it reports. `max_ops` has been checked there; no constants are added.
#[proc_macro_derive(BatchInverseDynamics, attributes(robot))]
pub fn derive_batch_inverse_dynamics(input: TokenStream) -> TokenStream {
    batch::batch_inverse_dynamics(input.into()).into()
}

/// Implements the trait `MassMatrix` for a struct: the mass matrix M(q).
///
/// Symmetric by construction: each element off the diagonal is computed once.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `MASS_MATRIX_OPERATIONS` and so on; `DOF`, names and limits come
/// with `InverseDynamics`.
#[proc_macro_derive(MassMatrix, attributes(robot))]
pub fn derive_mass_matrix(input: TokenStream) -> TokenStream {
    expand::capability(Capability::MassMatrix, input.into()).into()
}

/// Implements the trait `CoriolisMatrix` for a struct: the Coriolis matrix C(q, q̇) of Christoffel.
///
/// Ṁ - 2C is skew.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `CORIOLIS_MATRIX_OPERATIONS` and so on; `DOF`, names and limits
/// come with `InverseDynamics`.
#[proc_macro_derive(CoriolisMatrix, attributes(robot))]
pub fn derive_coriolis_matrix(input: TokenStream) -> TokenStream {
    expand::capability(Capability::CoriolisMatrix, input.into()).into()
}

/// Implements the trait `ForwardDynamics` for a struct: accelerations from torques.
///
/// A singular mass matrix gives numbers that are not finite, never a panic.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `FORWARD_DYNAMICS_OPERATIONS` and so on; `DOF`, names and limits
/// come with `InverseDynamics`.
#[proc_macro_derive(ForwardDynamics, attributes(robot))]
pub fn derive_forward_dynamics(input: TokenStream) -> TokenStream {
    expand::capability(Capability::ForwardDynamics, input.into()).into()
}

/// Implements the trait `Kinematics` for a struct: tip pose, link poses, Jacobian and J̇ q̇.
///
/// `base` and `tool` of the robot file included.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `FORWARD_KINEMATICS_OPERATIONS` and so on; `DOF`, names and
/// limits come with `InverseDynamics`.
#[proc_macro_derive(Kinematics, attributes(robot))]
pub fn derive_kinematics(input: TokenStream) -> TokenStream {
    expand::capability(Capability::Kinematics, input.into()).into()
}

/// Implements the trait `Energy` for a struct: kinetic and potential energy.
///
/// Links alone, without rotors.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `KINETIC_ENERGY_OPERATIONS` and so on; `DOF`, names and limits
/// come with `InverseDynamics`.
#[proc_macro_derive(Energy, attributes(robot))]
pub fn derive_energy(input: TokenStream) -> TokenStream {
    expand::capability(Capability::Energy, input.into()).into()
}

/// Implements the trait `CentreOfMass` for a struct: the centre of mass of the whole arm, and its Jacobian.
///
/// In the world, `base` of the robot file included. Links alone, without rotors.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `CENTRE_OF_MASS_OPERATIONS` and so on; `DOF`, names and limits
/// come with `InverseDynamics`.
#[proc_macro_derive(CentreOfMass, attributes(robot))]
pub fn derive_centre_of_mass(input: TokenStream) -> TokenStream {
    expand::capability(Capability::CentreOfMass, input.into()).into()
}

/// Implements the trait `Regressor` for a struct: torques per inertial parameter, τ = Y π.
///
/// Ten parameters per link; the masses of the file have no part in it.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `REGRESSOR_OPERATIONS` and so on; `DOF`, names and limits come
/// with `InverseDynamics`.
#[proc_macro_derive(Regressor, attributes(robot))]
pub fn derive_regressor(input: TokenStream) -> TokenStream {
    expand::capability(Capability::Regressor, input.into()).into()
}

/// Implements the trait `InverseDynamicsDerivatives` for a struct: ∂τ/∂q and ∂τ/∂q̇.
///
/// In the seven steps by the product rule on the graph of the torques, which they share; in the reduced form that or
/// composite bodies, whatever takes fewer operations.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `INVERSE_DYNAMICS_DERIVATIVES_OPERATIONS` and so on; `DOF`,
/// names and limits come with `InverseDynamics`.
#[proc_macro_derive(InverseDynamicsDerivatives, attributes(robot))]
pub fn derive_inverse_dynamics_derivatives(input: TokenStream) -> TokenStream {
    expand::capability(Capability::InverseDynamicsDerivatives, input.into()).into()
}

/// Implements the trait `JointWrenches` for a struct: the force and moment that each link exerts on the next.
///
/// Bearing loads; always in the seven steps, whose forces have a meaning.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `JOINT_WRENCHES_OPERATIONS` and so on; `DOF`, names and limits
/// come with `InverseDynamics`.
#[proc_macro_derive(JointWrenches, attributes(robot))]
pub fn derive_joint_wrenches(input: TokenStream) -> TokenStream {
    expand::capability(Capability::JointWrenches, input.into()).into()
}

/// Implements the trait `MomentumObserver` for a struct: the momentum of the joints and its rate, from which
/// `ObserverState` makes external torques without accelerations.
///
/// In the reduced form by the recursion of the torques, with velocities in the place of accelerations.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `MOMENTUM_AND_RATE_OPERATIONS`; `DOF`, names and limits come
/// with `InverseDynamics`.
#[proc_macro_derive(MomentumObserver, attributes(robot))]
pub fn derive_momentum_observer(input: TokenStream) -> TokenStream {
    expand::capability(Capability::MomentumObserver, input.into()).into()
}

/// Implements the trait `MovingBase` for a struct: torques on a base that moves.
///
/// Its motion (ω₀, ω̇₀, c̈₀) and gravity are arguments.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `INVERSE_DYNAMICS_ON_MOVING_BASE_OPERATIONS` and so on; `DOF`,
/// names and limits come with `InverseDynamics`.
#[proc_macro_derive(MovingBase, attributes(robot))]
pub fn derive_moving_base(input: TokenStream) -> TokenStream {
    expand::capability(Capability::MovingBase, input.into()).into()
}

/// Implements the trait `Actuation` for a struct: what rotors behind gears and friction add to the torques.
///
/// The robot file needs a `motor` at one joint at least.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `ACTUATOR_TORQUES_OPERATIONS` and so on; `DOF`, names and limits
/// come with `InverseDynamics`.
#[proc_macro_derive(Actuation, attributes(robot))]
pub fn derive_actuation(input: TokenStream) -> TokenStream {
    expand::capability(Capability::Actuation, input.into()).into()
}
