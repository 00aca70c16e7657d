//! A robot as a constant, its torques in single and in double precision, no `std`, no allocator.
#![no_std]

use rne_model::{Angle, Convention, Dh, Inertia, JointKind, Link, Model, Motor, QuarterTurns, Row, Transform};
use rne_runtime::{
    Actuation, Arm, BaseMotion, CentreOfMass, CoriolisMatrix, Dual, Energy, ForwardDynamics, InverseDynamics,
    InverseDynamicsDerivatives, JointWrenches, Kinematics, MassMatrix, MomentumObserver, MovingBase, ObserverState,
    Regressor, Scalar, Wrench,
};

const QUARTER_TURN: Angle =
    Angle { radians: core::f64::consts::FRAC_PI_2, sin: 1.0, cos: 0.0, right: Some(QuarterTurns::One) };

const SHOULDER: Row = Row {
    kind: JointKind::Revolute,
    dh: Dh { theta: Angle::ZERO, d: 0.4, a: 0.0, alpha: QUARTER_TURN },
    link: Link {
        mass: 2.5,
        com: [0.0, -0.2, 0.0],
        inertia: Inertia { xx: 0.03, yy: 0.02, zz: 0.03, xy: 0.0, xz: 0.0, yz: 0.0 },
        first_moment: [0.0; 3],
    },
};

const SLIDE: Row = Row {
    kind: JointKind::Prismatic,
    dh: Dh { theta: Angle::ZERO, d: 0.1, a: 0.0, alpha: Angle::ZERO },
    link: Link {
        mass: 1.5,
        com: [0.0, 0.0, -0.1],
        inertia: Inertia { xx: 0.01, yy: 0.01, zz: 0.002, xy: 0.0, xz: 0.0, yz: 0.0 },
        first_moment: [0.0; 3],
    },
};

const DOUBLE: Model<2> = Model {
    convention: Convention::Standard,
    gravity: [0.0, 0.0, -9.81],
    base: Transform::IDENTITY,
    tool: Transform::IDENTITY,
    rows: [SHOULDER, SLIDE],
};

const SINGLE: Model<2, f32> = Model {
    convention: DOUBLE.convention,
    gravity: [0.0, 0.0, -9.81],
    base: DOUBLE.base.to_f32(),
    tool: DOUBLE.tool.to_f32(),
    rows: [SHOULDER.to_f32(), SLIDE.to_f32()],
};

/// Torques in single precision, with what the tip pushes down with, N.
#[unsafe(no_mangle)]
pub extern "C" fn torques_single(q: &[f32; 2], qd: &[f32; 2], qdd: &[f32; 2], push: f32, tau: &mut [f32; 2]) {
    let wrench = Wrench { force: [0.0, -push, 0.0], moment: [0.0; 3] };
    *tau = Arm::new(SINGLE).inverse_dynamics_with_wrench(q, qd, qdd, &wrench);
}

/// Torques in double precision, free tip.
#[unsafe(no_mangle)]
pub extern "C" fn torques_double(q: &[f64; 2], qd: &[f64; 2], qdd: &[f64; 2], tau: &mut [f64; 2]) {
    *tau = Arm::new(DOUBLE).inverse_dynamics(q, qd, qdd);
}

/// The force along the slide alone, from the trace.
#[unsafe(no_mangle)]
pub extern "C" fn slide_force(q: &[f64; 2]) -> f64 {
    let arm = Arm::new(DOUBLE);
    let zero = [0.0; 2];
    arm.trace(q, &zero, &zero, &arm.fixed_base(), None).links[1].joint_force[2]
}

const MOTOR: Motor<f32> = Motor { inertia: 2e-4, gear_ratio: 100.0, viscous: 1e-3, coulomb: [0.1, -0.1] };

/// The sum of what every function finds.
fn everything<T: Scalar>(q: &[T; 2], qd: &[T; 2], qdd: &[T; 2]) -> T {
    let arm = Arm::new(SINGLE).with_motors([Some(MOTOR), None]);
    let mut sum = arm.kinetic_energy(q, qd) + arm.potential_energy(q);
    let mut add = |values: &[T]| values.iter().for_each(|&value| sum += value);
    add(arm.mass_matrix(q).as_flattened());
    add(arm.coriolis_matrix(q, qd).as_flattened());
    add(&arm.forward_dynamics(q, qd, qdd));
    add(&arm.forward_kinematics(q).translation);
    add(&arm.link_poses(q)[0].translation);
    add(arm.jacobian(q).as_flattened());
    add(&arm.jacobian_rate_times_velocity(q, qd));
    add(&arm.centre_of_mass(q));
    add(arm.centre_of_mass_jacobian(q).as_flattened());
    add(arm.regressor(q, qd, qdd).as_flattened().as_flattened());
    add(arm.inverse_dynamics_derivatives(q, qd, qdd).dq.as_flattened());
    add(&arm.joint_wrenches(q, qd, qdd)[0].moment);
    add(&arm.momentum_and_rate(q, qd, qdd).rate);
    let mut observer = ObserverState::new(20.0, 1e-3);
    add(&observer.update(&arm, q, qd, qdd));
    add(&observer.update(&arm, qd, q, qdd));
    add(&arm.inverse_dynamics_on_moving_base(q, qd, qdd, &BaseMotion::fixed([T::one(); 3])));
    add(&arm.actuator_torques(qd, qdd));
    add(&arm.actuator_torques_smooth(qd, qdd, T::one()));
    sum
}

/// Every function, in single precision.
#[unsafe(no_mangle)]
pub extern "C" fn everything_single(q: &[f32; 2], qd: &[f32; 2], qdd: &[f32; 2]) -> f32 {
    everything(q, qd, qdd)
}

/// How that changes with time.
#[unsafe(no_mangle)]
pub extern "C" fn everything_s_rate(q: &[f32; 2], qd: &[f32; 2], qdd: &[f32; 2]) -> f32 {
    let moving = |x: &[f32; 2], rate: &[f32; 2]| [0, 1].map(|i| Dual { value: x[i], derivative: rate[i] });
    everything(&moving(q, qd), &moving(qd, qdd), &qdd.map(Dual::constant)).derivative
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
