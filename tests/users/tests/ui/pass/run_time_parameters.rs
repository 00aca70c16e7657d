#![deny(warnings, missing_docs)]
//! Fields that are parameters of the robot file.

use std::marker::PhantomData;

use rne::{
    CentreOfMass, CoriolisMatrix, Energy, ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, JointWrenches,
    Kinematics, MassMatrix, MomentumObserver, MovingBase, Regressor,
};

/// In double precision.
#[derive(
    InverseDynamics,
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
)]
#[robot(path = "../robots/loaded.yaml")]
pub struct Loaded {
    /// kg
    pub payload: f64,
}

/// The other way round, in single precision, with something else beside.
#[derive(InverseDynamics, MassMatrix, ForwardDynamics)]
#[robot(path = "../robots/loaded.yaml", form = "reduced")]
pub struct Longer<'a, T> {
    /// m
    pub length: f32,
    /// No parameter.
    #[robot(skip)]
    pub name: &'a str,
    /// Nothing.
    pub kind: PhantomData<T>,
    /// kg
    pub payload: f32,
}

/// All numbers known.
#[derive(InverseDynamics, MassMatrix, ForwardDynamics, Energy)]
#[robot(path = "../robots/loaded.yaml")]
pub struct Unloaded;

fn main() {
    let (q, qd, qdd) = ([0.3, -0.8], [0.5, 0.4], [-1.1, 0.7]);
    // a payload of zero gives exactly the torques of the robot without it
    let light = Loaded { payload: 0.0 };
    assert_eq!(light.inverse_dynamics(&q, &qd, &qdd), Unloaded.inverse_dynamics(&q, &qd, &qdd));
    assert_eq!(light.mass_matrix(&q), Unloaded.mass_matrix(&q));
    assert_eq!(light.forward_dynamics(&q, &qd, &qdd), Unloaded.forward_dynamics(&q, &qd, &qdd));
    assert_eq!(light.kinetic_energy(&q, &qd), Unloaded.kinetic_energy(&q, &qd));

    // against the file with other numbers written in it
    let text = include_str!("../robots/loaded.yaml");
    let text = text.replace("payload: 0,", "payload: 0.75,").replace("length: 0.3", "length: 0.5");
    let arm = rne::Arm::<2>::from_yaml(&text).expect("a robot");
    let longer = Longer::<u8> { length: 0.5, name: "", kind: PhantomData, payload: 0.75 };
    let (found, expected) = (longer.inverse_dynamics(&q, &qd, &qdd), arm.inverse_dynamics(&q, &qd, &qdd));
    let close = |(a, b): (f64, f64)| (a - b).abs() < 1e-13 * (1.0 + b.abs());
    assert!(found.into_iter().zip(expected).all(close), "{found:?} {expected:?} {}", longer.name);
    let heavy = Loaded { payload: 1.5 };
    assert!(heavy.gravity_torques(&q)[0].is_finite() && heavy.coriolis_matrix(&q, &qd)[0][1].is_finite());
    assert!(heavy.inverse_dynamics_derivatives(&q, &qd, &qdd).dq[0][0].is_finite());
    assert!(heavy.joint_wrenches(&q, &qd, &qdd)[0].force[2] > light.joint_wrenches(&q, &qd, &qdd)[0].force[2]);
    let (centre, jacobian) = (heavy.centre_of_mass(&q), heavy.centre_of_mass_jacobian(&q));
    assert!(centre.iter().chain(jacobian.as_flattened()).all(|x| x.is_finite()));
    assert!(heavy.regressor(&q, &qd, &qdd)[0][0][0].is_finite() && heavy.jacobian(&q)[0][0].is_finite());
    let [loaded, bare] = [&heavy, &light].map(|arm| arm.momentum_and_rate(&q, &qd, &qdd).momentum[0]);
    assert!(loaded.is_finite() && loaded != bare);
    let base = rne::BaseMotion::fixed([0.0, 0.0, -9.81]);
    let moving = heavy.inverse_dynamics_on_moving_base(&q, &qd, &qdd, &base);
    assert_eq!(moving, heavy.inverse_dynamics(&q, &qd, &qdd));
}
