//! An example for each capability, in the documentation of its trait and of its derive. The crate `rne` runs them.

/// The example of a capability as Markdown, a literal. The first argument is the folder of robots that are not shipped.
#[macro_export]
#[rustfmt::skip]
macro_rules! example {
    (@robot $folder:literal $robot:literal $also:literal $capability:literal $call:literal) => {
        concat!(
            "# Example\n\n```\nuse rne::{", $also, $capability, "};\n\n#[derive(", $also, $capability, ")]\n#[robot(path = \"",
            $folder, $robot, ")]\nstruct MyRobot;\n\n", $call, "\n```\n",
        )
    };
    (@arm $folder:literal $capability:literal $call:literal) => {
        concat!(
            "# Example\n\n```\nuse rne::", $capability, ";\n\n#[derive(", $capability, ")]\n#[robot(builtin = \"puma560\")]\nstruct \
             MyRobot;\n\n", $call, "\n```\n",
        )
    };
    (@tips $folder:literal $capability:literal $call:literal) => {
        $crate::example!(@robot $folder "dual_arm.yaml\"" "" $capability $call)
    };
    (@floats $folder:literal $capability:literal $call:literal) => {
        $crate::example!(@robot $folder "satellite.yaml\"" "" $capability $call)
    };
    (@loops $folder:literal $also:literal $capability:literal $call:literal) => {
        $crate::example!(@robot $folder "four_bar.yaml\"" $also $capability $call)
    };

    ($folder:literal InverseDynamics) => { $crate::example!(@arm $folder "InverseDynamics"
        "let tau: [f64; 6] = MyRobot.inverse_dynamics(&[0.1; 6], &[0.5; 6], &[1.0; 6]); // N m\n\
         let holding: [f64; 6] = MyRobot.gravity_torques(&[0.1; 6]);") };
    ($folder:literal MassMatrix) => { $crate::example!(@arm $folder "MassMatrix"
        "let m: [[f64; 6]; 6] = MyRobot.mass_matrix(&[0.1; 6]); // kg m²\nassert_eq!(m[0][1], m[1][0]);") };
    ($folder:literal CoriolisMatrix) => { $crate::example!(@arm $folder "CoriolisMatrix"
        "let c: [[f64; 6]; 6] = MyRobot.coriolis_matrix(&[0.1; 6], &[0.5; 6]);") };
    ($folder:literal ForwardDynamics) => { $crate::example!(@arm $folder "ForwardDynamics"
        "let qdd: [f64; 6] = MyRobot.forward_dynamics(&[0.1; 6], &[0.5; 6], &[1.0; 6]); // rad/s²") };
    ($folder:literal Kinematics) => { $crate::example!(@arm $folder "Kinematics"
        "let [x, y, z] = MyRobot.forward_kinematics(&[0.1; 6]).translation; // m\n\
         let jacobian: [[f64; 6]; 6] = MyRobot.jacobian(&[0.1; 6]); // three linear rows, three angular rows") };
    ($folder:literal Energy) => { $crate::example!(@arm $folder "Energy"
        "let energy = MyRobot.kinetic_energy(&[0.1; 6], &[0.5; 6]) + MyRobot.potential_energy(&[0.1; 6]); // J") };
    ($folder:literal CentreOfMass) => { $crate::example!(@arm $folder "CentreOfMass"
        "let [x, y, z] = MyRobot.centre_of_mass(&[0.1; 6]); // m") };
    ($folder:literal Regressor) => { $crate::example!(@arm $folder "Regressor"
        "let y = MyRobot.regressor(&[0.1; 6], &[0.5; 6], &[1.0; 6]); // y[torque][link][parameter]") };
    ($folder:literal InverseDynamicsDerivatives) => { $crate::example!(@arm $folder "InverseDynamicsDerivatives"
        "let by = MyRobot.inverse_dynamics_derivatives(&[0.1; 6], &[0.5; 6], &[1.0; 6]);\n\
         let of_first_torque: [f64; 6] = by.dq[0]; // N m per rad of each joint") };
    ($folder:literal JointWrenches) => { $crate::example!(@arm $folder "JointWrenches"
        "let wrenches = MyRobot.joint_wrenches(&[0.1; 6], &[0.5; 6], &[1.0; 6]);\n\
         let on_the_first_link = wrenches[0].force; // N, from the base") };
    ($folder:literal MomentumObserver) => { $crate::example!(@arm $folder "MomentumObserver"
        "let momentum = MyRobot.momentum_and_rate(&[0.1; 6], &[0.5; 6], &[1.0; 6]).momentum; // N m s") };
    ($folder:literal MovingBase) => { $crate::example!(@arm $folder "MovingBase"
        "let base = rne::BaseMotion::fixed([0.0, 0.5, -9.81]); // gravity in frame 0 of a vehicle on a slope\n\
         let tau = MyRobot.inverse_dynamics_on_moving_base(&[0.1; 6], &[0.5; 6], &[1.0; 6], &base);") };
    ($folder:literal Actuation) => { $crate::example!(@arm $folder "Actuation"
        "let of_motors: [f64; 6] = MyRobot.actuator_torques(&[0.5; 6], &[1.0; 6]); // N m, added to the dynamics") };
    ($folder:literal PayloadDynamics) => { $crate::example!(@arm $folder "PayloadDynamics"
        "let tool = rne::Payload { mass: 1.5, com: [0.0, 0.0, 0.1], ..rne::Payload::default() };\n\
         let holding = MyRobot.gravity_torques_with_payload(&[0.1; 6], &tool);") };
    ($folder:literal TipWrenches) => { $crate::example!(@tips $folder "TipWrenches"
        "let wrenches = [rne::Wrench { force: [0.0, 0.0, -5.0], moment: [0.0; 3] }, rne::Wrench::default()];\n\
         let tau = MyRobot.inverse_dynamics_with_wrenches(&[0.1; 5], &[0.5; 5], &[1.0; 5], &wrenches);") };
    ($folder:literal FloatingBase) => { $crate::example!(@floats $folder "FloatingBase"
        "let base = rne::BaseMotion::fixed([0.0; 3]); // at rest, without gravity\n\
         let wrenches = [rne::Wrench::default()]; // the tip is free\n\
         let of = MyRobot.inverse_dynamics_of_floating_base(&[0.1; 2], &[0.5; 2], &[1.0; 2], &base, &wrenches);\n\
         let (on_the_base, tau) = (of.wrench, of.tau); // force and moment; torques of the joints") };
    ($folder:literal CentroidalMomentum) => { $crate::example!(@floats $folder "CentroidalMomentum"
        "let matrix: [[f64; 8]; 6] = MyRobot.centroidal_momentum_matrix(&[0.1; 2]);") };
    ($folder:literal FloatingRegressor) => { $crate::example!(@floats $folder "FloatingRegressor"
        "let base = rne::BaseMotion::fixed([0.0; 3]);\n\
         let y = MyRobot.floating_regressor(&[0.1; 2], &[0.5; 2], &[1.0; 2], &base); // y[row][body][parameter]") };
    ($folder:literal FloatingEnergy) => { $crate::example!(@floats $folder "FloatingEnergy"
        "let twist = rne::BaseTwist { linear: [0.0; 3], angular: [0.0, 0.0, 0.2] };\n\
         let energy = MyRobot.floating_kinetic_energy(&[0.1; 2], &[0.5; 2], &twist); // J") };
    ($folder:literal FloatingKinematics) => { $crate::example!(@floats $folder "FloatingKinematics"
        "let upright = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];\n\
         let [jacobian] = MyRobot.tip_jacobians(&[0.1; 2], &upright); // one for each tip: 6 rows, 6 + 2 columns") };
    ($folder:literal ContactDynamics) => { $crate::example!(@robot $folder "standing_hyq.yaml\"" "" "ContactDynamics"
        "let upright = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];\n\
         let (q, zeros) = ([0.0, 0.7, -1.4, 0.0, -0.7, 1.4, 0.0, 0.7, -1.4, 0.0, -0.7, 1.4], [0.0; 12]);\n\
         let motion = MyRobot.forward_dynamics_in_contact(&q, &zeros, &zeros, &[0.0; 3], &upright);") };
    ($folder:literal FloatingInverseDynamicsDerivatives) => { $crate::example!(@floats $folder
        "FloatingInverseDynamicsDerivatives"
        "let (base, wrenches) = (rne::BaseMotion::fixed([0.0; 3]), [rne::Wrench::default()]);\n\
         let (q, qd, qdd) = ([0.1; 2], [0.5; 2], [1.0; 2]);\n\
         let by = MyRobot.floating_inverse_dynamics_derivatives(&q, &qd, &qdd, &base, &wrenches);") };
    ($folder:literal ClosedLoops) => { $crate::example!(@loops $folder "" "ClosedLoops"
        "let q = [0.3]; // rad, of the joint with the motor\n\
         let closed = MyRobot.close(&q, &[0.1; 2]); // from a guess of the two other joints\n\
         let tau = MyRobot.inverse_dynamics_of_loops(&q, &closed.passive, &[0.5], &[1.0]); // N m") };
    ($folder:literal FloatingClosedLoops) => { $crate::example!(@robot
        $folder "four_bar.yaml\", allow_lints" "ClosedLoops, "
        "FloatingClosedLoops"
        "let closed = MyRobot.close(&[0.3], &[0.1; 2]);\n\
         let m = MyRobot.floating_mass_matrix_of_loops(&[0.3], &closed.passive); // the base, then the joint") };
    ($folder:literal InverseDynamicsGradient) => { $crate::example!(@arm $folder "InverseDynamicsGradient"
        "let by = MyRobot.torque_gradient(&[0.1; 6], &[0.5; 6], &[1.0; 6], &[2.0; 6]); // of the sum of 2 τᵢ") };
    ($folder:literal ForwardDynamicsDerivatives) => { $crate::example!(@arm $folder "ForwardDynamicsDerivatives"
        "let by = MyRobot.forward_dynamics_derivatives(&[0.1; 6], &[0.5; 6], &[1.0; 6]);\n\
         let inverse_of_the_mass_matrix: [[f64; 6]; 6] = by.dtau;") };
    ($folder:literal JacobianDerivatives) => { $crate::example!(@arm $folder "JacobianDerivatives"
        "let rate: [[f64; 6]; 6] = MyRobot.jacobian_rate(&[0.1; 6], &[0.5; 6]);") };
    ($folder:literal InverseDynamicsHessian) => { $crate::example!(@arm $folder "InverseDynamicsHessian"
        "let by = MyRobot.torque_hessian(&[0.1; 6], &[0.5; 6], &[1.0; 6], &[2.0; 6]); // of the sum of 2 τᵢ") };
    ($folder:literal EulerStep) => { $crate::example!(@arm $folder "EulerStep"
        "let next = MyRobot.euler_step(&[0.1; 6], &[0.5; 6], &[1.0; 6], 0.001); // after one millisecond") };
    ($folder:literal EulerStepDerivatives) => { $crate::example!(@arm $folder "EulerStepDerivatives"
        "let by = MyRobot.euler_step_derivatives(&[0.1; 6], &[0.5; 6], &[1.0; 6], 0.001);") };
    ($folder:literal FloatingEulerStep) => { $crate::example!(@floats $folder "FloatingEulerStep"
        "let pose = rne::Pose::identity();\n\
         let twist = rne::BaseTwist { linear: [0.0; 3], angular: [0.0, 0.0, 0.2] };\n\
         let (q, qd, tau, free) = ([0.1; 2], [0.5; 2], [1.0; 2], [rne::Wrench::default()]);\n\
         let next = MyRobot.floating_euler_step(&q, &qd, &tau, &pose, &twist, 0.001, &free);") };
    ($folder:literal FloatingEulerStepDerivatives) => { $crate::example!(@floats $folder "FloatingEulerStepDerivatives"
        "let pose = rne::Pose::identity();\n\
         let twist = rne::BaseTwist { linear: [0.0; 3], angular: [0.0, 0.0, 0.2] };\n\
         let (q, qd, tau, free) = ([0.1; 2], [0.5; 2], [1.0; 2], [rne::Wrench::default()]);\n\
         let by = MyRobot.floating_euler_step_derivatives(&q, &qd, &tau, &pose, &twist, 0.001, &free);") };
    ($folder:literal FloatingPayloadDynamics) => { $crate::example!(@floats $folder "FloatingPayloadDynamics"
        "let tool = rne::Payload { mass: 1.5, ..rne::Payload::default() };\n\
         let m: [[f64; 8]; 8] = MyRobot.floating_mass_matrix_with_payload(&[0.1; 2], &tool);") };
    ($folder:literal ClosedLoopsPayloadDynamics) => { $crate::example!(@loops $folder "ClosedLoops, "
        "ClosedLoopsPayloadDynamics"
        "let closed = MyRobot.close(&[0.3], &[0.1; 2]);\n\
         let tool = rne::Payload { mass: 1.5, ..rne::Payload::default() };\n\
         let holding = MyRobot.gravity_torques_of_loops_with_payload(&[0.3], &closed.passive, &tool);") };
}
