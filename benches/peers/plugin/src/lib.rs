//! The robots of the comparison, one struct each, and the table that the C interface looks them up in.

mod abi;

#[cfg(feature = "functions")]
use abi::quantity::{BIAS, DTAU_DQ, DTAU_DQD, GRAVITY, MASS_MATRIX, TAU};
use abi::{Function, Robot};
use rne::InverseDynamics;

/// One line per robot: its struct, the number of its joints, its file.
macro_rules! robots {
    ($($name:ident $dof:literal $path:literal)*) => {
        $(
            #[doc = concat!("The robot of `", $path, "`.")]
            #[derive(Clone, Copy, Debug, Default, InverseDynamics)]
            #[cfg_attr(feature = "batch", derive(rne::BatchInverseDynamics))]
            #[cfg_attr(
                feature = "functions",
                derive(rne::MassMatrix, rne::ForwardDynamics, rne::InverseDynamicsDerivatives)
            )]
            #[cfg_attr(not(feature = "reduced"), robot(path = $path, allow_lints))]
            #[cfg_attr(feature = "reduced", robot(path = $path, form = "reduced", allow_lints))]
            pub struct $name;
        )*

        /// Every robot, by the name in its file.
        static ROBOTS: &[Robot] = &[$(Robot {
            name: $name::NAME,
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
            ],
        }),*];
    };
}

robots! {
    Planar2  2 "../../models/planar2.yaml"
    Puma560  6 "../../models/puma560.yaml"
    Stanford 6 "../../models/stanford.yaml"
    Panda    7 "../../models/panda.yaml"
    Iiwa14   7 "../../models/iiwa14.yaml"
    Dense6P2 6 "../../models/dense6_2p.yaml"
    Dense7   7 "../../models/dense7.yaml"
}
