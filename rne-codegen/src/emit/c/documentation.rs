//! What a caller must know of each function.

use crate::function::Function;

/// What stands behind a function's summary: shapes, units, frames and signs that the names do not tell.
pub(super) const fn details(function: Function) -> &'static str {
    match function {
        Function::InverseDynamics => {
            "tau: what the actuators must deliver, M(q) q̈ + C(q, q̇) q̇ + g(q). No friction, no rotor inertia."
        }
        Function::InverseDynamicsWithWrench => {
            "force (N), moment (N m): exerted BY the last link ON its environment, about the origin of the tip frame (tool \
             included); what the environment exerts on the robot is the negative of them. tau: τ_free + Jᵀ w."
        }
        Function::InverseDynamicsSc => {
            "sine[i], cosine[i]: those of q[i], without the constant part of the joint's angle. Those of a prismatic joint are \
             not used, as q[i] of a revolute joint is not."
        }
        Function::GravityTorques | Function::BiasTorques => "",
        Function::MassMatrix => {
            "mass[i][j]: torque of joint i for a unit acceleration of joint j, from rest and without gravity; kg m², kg m or \
             kg, as the kinds of joints i and j have it. No rotor inertia."
        }
        Function::CoriolisMatrix => {
            "coriolis[i][j]: row i is torque i. Its product with q̇ are the Coriolis and centrifugal torques."
        }
        Function::ForwardDynamics => {
            "qdd: M(q)⁻¹ (τ - C(q, q̇) q̇ - g(q)). A singular mass matrix (a joint that moves nothing) gives numbers that are not \
             finite."
        }
        Function::ForwardKinematics => {
            "tip->rotation: its columns are the axes of the tip frame, in world axes. tip->translation: its origin in the world, \
             m."
        }
        Function::LinkPoses => {
            "poses[i]: at the far end of link i + 1 in a standard table, on its joint in a modified one; axes as columns, \
             origin in m. The tool is not included."
        }
        Function::Jacobian => {
            "jacobian: its product with q̇ is the velocity of the origin of the tip frame (m/s) above the angular velocity of the \
             last link (rad/s)."
        }
        Function::JacobianRateTimesVelocity => {
            "acceleration: of the origin of the tip frame (m/s²), then angular (rad/s²). At any other q̈ they are J q̈ + J̇ q̇."
        }
        Function::KineticEnergy => "½ q̇ᵀ M(q) q̇ of the links; rotors are not included.",
        Function::PotentialEnergy => "-Σ m g·c, with c from the origin of frame 0 to each centre of mass.",
        Function::Regressor => {
            "regressor[i][j][k]: torque i per parameter k of link j, gravity included. The parameters refer to the link frame \
             of the table: c and J from its origin, in its axes; Jxy is the tensor's element, -∫ x y dm."
        }
        Function::InverseDynamicsDerivatives => {
            "dq[i][j], dqd[i][j]: of torque i, by joint j. The derivative by q̈ is the mass matrix."
        }
        Function::JointWrenches => {
            "wrenches[i]: exerted BY the link before joint i + 1 ON the link behind it, with a free tip; force in N, moment in \
             N m; axis z is that of the joint. The moment is about the origin of the frame before it in a standard table, about \
             the foot of the common normal on its axis in a modified one."
        }
        Function::InverseDynamicsOnMovingBase => {
            "base_omega (rad/s), base_omega_dot (rad/s²): of frame 0. base_acceleration (m/s²): of its origin, gravity not \
             included. base_gravity (m/s²): points down, and replaces the robot's own. All in the axes of frame 0."
        }
        Function::ActuatorTorques => {
            "G² Jm q̈ + G² B q̇ + |G| Tc(sign q̇), to be added to the torques of the links. Friction of Coulomb is zero at rest; a \
             joint without a motor needs nothing."
        }
    }
}
