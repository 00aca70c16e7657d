//! A dynamics compiler for robot arms: a Denavit-Hartenberg table becomes straight-line recursive Newton-Euler code,
//! while your program is compiled.
//!
//! ```
//! use rne::InverseDynamics;
//!
//! #[derive(InverseDynamics)]
//! #[robot(path = "../robots/puma560.yaml")] // relative to this source file
//! pub struct Puma560;
//!
//! let q = [0.0, 0.8, -0.4, 0.0, 0.5, 0.0]; // rad
//! let tau: [f64; 6] = Puma560.inverse_dynamics(&q, &[0.1; 6], &[0.0; 6]); // N m
//! assert_eq!(Puma560::DOF, tau.len());
//! ```
//!
//! `robots/puma560.yaml` contains the table of the arm and the mass, centre of mass and inertia of each link. The
//! [derive](derive@InverseDynamics) reads it at compile time, writes the seven steps of the recursion for each link,
//! and removes the terms that vanish by this arm's right angles and zeros. A few hundred multiplications and additions
//! remain, with names such as `w2_z`: no loop, no matrix, no allocation, no branch, no panic, no `unsafe`. The
//! documentation of your type gives the counts before and after. A mistake in the file is a compiler error that points
//! into the file.
//!
//! # Functions of a robot
//!
//! There is one trait per capability, generic over the [`Scalar`]: `f32`, `f64`, SIMD lanes, dual numbers, fixed point.
//!
#![doc = include_str!("../docs/reference/capabilities.md")]
//!
//! # A robot at run time
//!
//! [`Arm`] implements the same traits for a robot that is loaded when the program runs, by the recursion as a textbook
//! writes it, with loops and vectors. Generated code is tested against it: in `f64`, without fused multiply-add, the
//! seven steps give the same bits for the torques of all traits, the mass matrix, forward dynamics, kinetic energy, the
//! derivatives and the joint wrenches. [`Kinematics`], potential energy, [`CoriolisMatrix`] and [`Regressor`] sum in
//! another order and agree to rounding. So does `f32`, because an `Arm` stores its constants in `f64`. `DynArm` is for
//! a robot whose number of joints is not known at compile time either.
//!
//! ```
//! # #[cfg(all(feature = "arm", feature = "std"))] {
//! use rne::{Arm, InverseDynamics};
//! # #[derive(InverseDynamics)]
//! # #[robot(path = "../robots/puma560.yaml")]
//! # pub struct Puma560;
//!
//! let arm = Arm::<6>::from_file("robots/puma560.yaml")?;
//! let q = [0.0, 0.8, -0.4, 0.0, 0.5, 0.0];
//! assert_eq!(arm.gravity_torques(&q), Puma560.gravity_torques(&q));
//!
//! // Every vector of the seven steps, for a lesson or for a comparison by hand.
//! let trace = arm.trace(&q, &[0.1; 6], &[0.0; 6], &arm.fixed_base(), None);
//! assert_eq!(trace.links.len(), 6);
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A million states
//!
//! ```
//! use rne::{BatchInverseDynamics, InverseDynamics};
//!
//! #[derive(InverseDynamics, BatchInverseDynamics)]
//! #[robot(path = "../robots/puma560.yaml")]
//! pub struct Puma560;
//!
//! let states = 1003; // any number
//! let zeros = vec![0.0; states];
//! let mut tau = [(); 6].map(|()| vec![0.0; states]);
//! Puma560.inverse_dynamics_batch([&zeros; 6], [&zeros; 6], [&zeros; 6], tau.each_mut().map(Vec::as_mut_slice))?;
//! # Ok::<(), rne::LengthMismatch>(())
//! ```
//!
//! A batch uses AVX-512, AVX2, SSE2 or NEON, detected at run time, without `-C target-cpu`. With the feature `rayon` it
//! uses all cores.
//!
//! # The processor
//!
//! Single calls in the form `reduced` use AVX2 and fused multiply-add on x86 processors that have them, in `f64` and
//! `f32`. So a plain `cargo build --release` is about as fast as one with `-C target-cpu=x86-64-v3`, and returns the
//! same bits. The form `seven_steps` returns the same bits on every processor. `#[robot(…, inline)]` switches the
//! detection off, so that a method can be [inlined](derive@InverseDynamics#inline) into a loop.
//!
//! # Features
//!
//! | feature | effect |
//! |---|---|
//! | `arm` (default) | robots that are known at run time: [`Arm`], `DynArm`; depends on nalgebra |
//! | `simba` (default) | every scalar of simba; without it `f32`, `f64` and your own types. Lanes such as `WideF64x4` need simba's feature `std`, which `simba = "0.10"` in your `Cargo.toml` enables |
//! | `std` (default) | robot files at run time |
//! | `batch` (default) | detection of the processor's instructions at run time, for batches and single calls; without it the code uses the compiled target |
//! | `compiled` | any arm at run time, nearly as fast as a derived one: `compiled::CompiledArm`; depends on the compiler |
//! | `native` | machine code for single calls of a `CompiledArm`, as fast as derived ones; depends on Cranelift |
//! | `nalgebra` | conversions of poses and wrenches; enabled by `arm` |
//! | `rayon` | batches on all cores |
//! | `core_float_math` | without `std`: fused multiply-add in the reduced form, with a nightly compiler (a stable one says E0554) |
//!
//! # Without `std`
//!
//! `rne = { version = "0.1", default-features = false }`: derived robots, the traits and, with the feature `arm`,
//! `Arm::new` need neither `std` nor an allocator. The robot file is read on the machine that compiles.
//!
//! # Conventions
//!
//! - Joint arrays run from base to tip. Revolute joints: rad, rad/s, rad/s², N m. Prismatic joints: m, m/s, m/s², N.
//! - Torques are the torques that the actuators must deliver: τ = M(q) q̈ + C(q, q̇) q̇ + g(q), without friction and rotor
//!   inertia.
//! - A table states whether its rows are `standard` (distal) or `modified` (proximal, Craig); this is never guessed.
//! - `gravity` is the acceleration of gravity in frame 0: `[0, 0, -9.81]` when z points up.
//! - A [`Wrench`] is exerted by the last link on its environment, at the tip frame, in its axes: τ = τ_free + Jᵀ w.
//! - Inertias are elements of the tensor, so `xy` is -∫ x y dm; about the centre of mass unless the file says
//!   otherwise.
//!
//! # Robot files
//!
//! [`model`] reads and checks robot files, and contains the plain types of the table that [`Arm::new`] takes: one YAML
//! document per arm, where every number may be an expression (`pi/2`, `m*a^2/12`). [`robot_file`] leads an arm from
//! its datasheet to its torque, and [`robot_file::keys`] explains every key. `rne check FILE` reports mistakes and
//! suspicious values, `rne show FILE` the annotated code.
#![warn(missing_debug_implementations)]
#![forbid(unsafe_code)]
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(docsrs, feature(doc_cfg))]

#[doc(inline)]
pub use rne_macro::*;
#[doc(inline)]
pub use rne_model as model;
#[doc(inline)]
pub use rne_runtime::*;

/// Any arm at run time, nearly as fast as a derived one: read, compiled to the code of a machine, and run over blocks
/// of states on the widest vector unit.
///
/// ```
/// use rne::compiled::{Arguments, Array, CompiledArm, Destination, Function};
///
/// let arm = CompiledArm::from_file("robots/puma560.yaml")?;
/// let tau = arm.inverse_dynamics(&[0.0, 0.8, -0.4, 0.0, 0.5, 0.0], &[0.1; 6], &[0.0; 6])?; // N m
///
/// // ten thousand states, numbers of a state beside each other
/// let (q, zeros) = (vec![0.5; 60_000], vec![0.0; 60_000]);
/// let arguments = Arguments::new().q(Array::Rows(&q)).qd(Array::Rows(&zeros)).qdd(Array::Rows(&zeros));
/// let mut torques = vec![0.0; 60_000];
/// arm.run(Function::InverseDynamics, 10_000, &arguments, Destination::Rows(&mut torques))?;
/// # assert_eq!((tau.len(), &torques[..6]), (6, &torques[6..12]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[cfg(feature = "compiled")]
#[cfg_attr(docsrs, doc(cfg(feature = "compiled")))]
pub mod compiled {
    #[doc(inline)]
    pub use rne_machine::{
        ARGUMENTS, Argument, Arguments, ArmError, Array, CompiledArm, CompiledFunction, Destination, EvaluationError,
        Form, FrictionWidth, Function, Layout, Machine, Number, OutOfRange, PlanFile, Record, RobotFiles, Rollout,
        RolloutError, RolloutLimits, SearchError, SearchOptions, SearchProgress, Sizes, WrongSize, sizes_of,
    };
}

#[cfg(doc)]
#[doc = include_str!("../docs/robot-file.md")]
pub mod robot_file {
    #[doc = include_str!("../docs/reference/robot-file-keys.md")]
    pub mod keys {}
}

/// Runs the example of states that are arrays, in a document.
#[cfg(all(doctest, feature = "compiled"))]
#[doc = include_str!("../docs/control/run-time.md")]
mod run_time {}

/// Runs the examples of the capabilities.
#[cfg(doctest)]
#[allow(non_snake_case)] // a module for each name of a capability
mod capabilities {
    macro_rules! run {
        ($($capability:ident $(of $robots:ident)?: $($sentence:literal),*;)*) => { $(
            #[doc = rne_codegen::example!("../../../docs/" $capability)]
            mod $capability {}
        )* };
    }
    rne_codegen::capabilities!(run);
}

/// Runs the examples in the documentation of the derives.
#[cfg(doctest)]
mod derives {
    #[doc = include_str!("../rne-macro/src/inverse_dynamics.md")]
    mod inverse_dynamics {}
    #[doc = include_str!("../rne-macro/src/batch_inverse_dynamics.md")]
    mod batch_inverse_dynamics {}
}
