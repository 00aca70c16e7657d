//! The robots of the comparison, one struct each, and the table that the C interface looks them up in.

mod abi;
mod blocks;
#[cfg(feature = "machine")]
mod machine;

#[cfg(feature = "functions")]
use abi::quantity::{BIAS, DTAU_DQ, DTAU_DQD, GRAVITY, MASS_MATRIX, TAU};
use abi::{Function, Robot};
use rne::InverseDynamics;

/// One line per robot: its name and feature, its struct, the number of its joints, its file.
macro_rules! robots {
    ($($robot:literal $name:ident $dof:literal $path:literal)*) => {
        $(
            #[cfg(feature = $robot)]
            #[doc = concat!("The robot of `", $path, "`.")]
            #[derive(Clone, Copy, Debug, Default, InverseDynamics)]
            #[cfg_attr(feature = "batch", derive(rne::BatchInverseDynamics))]
            #[cfg_attr(
                feature = "functions",
                derive(rne::MassMatrix, rne::ForwardDynamics, rne::InverseDynamicsDerivatives)
            )]
            #[cfg_attr(
                all(feature = "batch", feature = "functions"),
                derive(rne::BatchMassMatrix, rne::BatchForwardDynamics, rne::BatchInverseDynamicsDerivatives)
            )]
            #[cfg_attr(not(feature = "reduced"), robot(path = $path, allow_lints))]
            #[cfg_attr(feature = "reduced", robot(path = $path, form = "reduced", allow_lints))]
            pub struct $name;
        )*

        /// Every robot, by the name that the comparison gives it.
        static ROBOTS: &[Robot] = &[$(#[cfg(feature = $robot)] Robot {
            name: $robot,
            #[cfg(feature = "machine")]
            file: concat!(env!("CARGO_MANIFEST_DIR"), "/src/", $path),
            competitors: &[
                (c"rne", Function::InverseDynamics(abi::inverse_dynamics::<$name, $dof>)),
                #[cfg(feature = "batch")]
                (c"rne_batch", Function::Batch(abi::batch::<$name, $dof>)),
                #[cfg(feature = "functions")]
                (c"rne_gravity", Function::Other(GRAVITY, abi::gravity::<$name, $dof>)),
                #[cfg(feature = "functions")]
                (c"rne_bias", Function::Other(BIAS, abi::bias::<$name, $dof>)),
                #[cfg(feature = "functions")]
                (c"rne_mass_matrix", Function::Matrices(&[MASS_MATRIX], abi::mass_matrix::<$name, $dof>)),
                #[cfg(feature = "functions")]
                (c"rne_forward_dynamics", Function::ForwardDynamics(abi::forward_dynamics::<$name, $dof>)),
                #[cfg(feature = "functions")]
                (c"rne_derivatives", Function::Matrices(&[DTAU_DQ, DTAU_DQD], abi::derivatives::<$name, $dof, false>)),
                #[cfg(feature = "functions")]
                (
                    c"rne_derivatives_tau_m",
                    Function::Matrices(&[DTAU_DQ, DTAU_DQD, TAU, MASS_MATRIX], abi::derivatives::<$name, $dof, true>),
                ),
                #[cfg(all(feature = "batch", feature = "functions"))]
                (
                    c"rne_batch_mass_matrix",
                    Function::BatchMatrices(&[MASS_MATRIX], abi::batch_mass_matrix::<$name, $dof>),
                ),
                #[cfg(all(feature = "batch", feature = "functions"))]
                (
                    c"rne_batch_forward_dynamics",
                    Function::BatchForwardDynamics(abi::batch_forward_dynamics::<$name, $dof>),
                ),
                #[cfg(all(feature = "batch", feature = "functions"))]
                (
                    c"rne_batch_derivatives",
                    Function::BatchMatrices(&[DTAU_DQ, DTAU_DQD], abi::batch_derivatives::<$name, $dof>),
                ),
                #[cfg(feature = "machine")]
                (c"rne_machine_batch", Function::Machine(machine::TORQUES)),
                #[cfg(feature = "machine")]
                (c"rne_machine_mass_matrix", Function::Machine(machine::MASS_MATRIX)),
                #[cfg(feature = "machine")]
                (c"rne_machine_forward_dynamics", Function::Machine(machine::FORWARD_DYNAMICS)),
                #[cfg(feature = "machine")]
                (c"rne_machine_derivatives", Function::Machine(machine::DERIVATIVES)),
            ],
        }),*];
    };
}

robots! {
    "planar2"   Planar2  2  "../../models/planar2.yaml"
    "puma560"   Puma560  6  "../../models/puma560.yaml"
    "stanford"  Stanford 6  "../../models/stanford.yaml"
    "panda"     Panda    7  "../../models/panda.yaml"
    "iiwa14"    Iiwa14   7  "../../models/iiwa14.yaml"
    "dense6_2p" Dense6P2 6  "../../models/dense6_2p.yaml"
    "dense7"    Dense7   7  "../../models/dense7.yaml"
    "hyq"       Hyq      12 "../../../../robots/trees/hyq.yaml"
    "atlas"     Atlas    30 "../../../trees/atlas.yaml"
    "g1"        G1       29 "../../../trees/g1.yaml"
}
