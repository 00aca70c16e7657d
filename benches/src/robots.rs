//! The derived robots. A plan file beside the robot file is replayed.

use rne::{ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, MassMatrix};

/// Structs with documentation, each derived from a robot file in one form: inverse dynamics and what is named besides.
macro_rules! robots {
    ($($name:ident: $path:literal in $form:literal $(with $($capability:ident)+)?;)*) => {$(
        #[doc = concat!("`", $path, "` in the form `", $form, "`.")]
        #[derive(InverseDynamics $($(, $capability)+)?)]
        #[robot(path = $path, form = $form)]
        pub struct $name;
    )*};
}

robots! {
    Puma560SevenSteps: "../../robots/puma560.yaml" in "seven_steps"
        with MassMatrix ForwardDynamics InverseDynamicsDerivatives;
    Puma560Reduced: "../../robots/puma560.yaml" in "reduced"
        with MassMatrix ForwardDynamics InverseDynamicsDerivatives;
    PandaSevenSteps: "../../robots/panda.yaml" in "seven_steps"
        with MassMatrix ForwardDynamics InverseDynamicsDerivatives;
    PandaReduced: "../../robots/panda.yaml" in "reduced"
        with MassMatrix ForwardDynamics InverseDynamicsDerivatives;
    Ur5SevenSteps: "../../robots/ur5.yaml" in "seven_steps";
    Ur5Reduced: "../../robots/ur5.yaml" in "reduced";
}
