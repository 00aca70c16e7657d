//! The robots of the comparison, one struct each, and the table that the C interface looks them up in.

mod abi;

use abi::Robot;
use rne::InverseDynamics;

/// One line per robot: its struct, the number of its joints, its file.
macro_rules! robots {
    ($($name:ident $dof:literal $path:literal)*) => {
        $(
            #[doc = concat!("The robot of `", $path, "`.")]
            #[derive(Clone, Copy, Debug, Default, InverseDynamics)]
            #[cfg_attr(feature = "batch", derive(rne::BatchInverseDynamics))]
            #[cfg_attr(not(feature = "reduced"), robot(path = $path))]
            #[cfg_attr(feature = "reduced", robot(path = $path, form = "reduced"))]
            pub struct $name;
        )*

        /// Every robot, by the name in its file.
        static ROBOTS: &[Robot] = &[$(Robot::new::<$name, $dof>($name::NAME)),*];
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
