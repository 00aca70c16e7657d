#![deny(warnings, missing_docs)]
//! Types with parameters, fields and bounds.

use std::fmt::Debug;

use rne::InverseDynamics;

/// Parameters with the names that generated code would like to use.
#[derive(InverseDynamics)]
#[robot(path = "../robots/two.yaml")]
pub struct Arm<'a, T: Debug + 'a, Number, const DOF: usize, const N: usize = 2>
where
    Number: Copy + ?Sized,
{
    /// A reference.
    #[robot(skip)]
    pub name: &'a [T; DOF],
    /// A value.
    #[robot(skip)]
    pub payload: Number,
    /// More of them.
    #[robot(skip)]
    pub spare: [T; N],
}

/// A type that is also its own unit.
#[derive(InverseDynamics)]
#[robot(path = "../robots/rod.yaml")]
pub struct T(#[robot(skip)] pub f64);

fn main() {
    let arm: Arm<'_, &str, f32, 1> = Arm { name: &["arm"], payload: 1.5, spare: ["a", "b"] };
    let tau: [f64; 2] = arm.bias_torques(&[0.1, 0.2], &[0.3, 0.4]);
    assert!(tau[0].is_finite() && arm.payload > 1.0 && arm.name.len() + arm.spare.len() == 3);
    assert_eq!(Arm::<'_, u8, u8, 7>::DOF, 2);
    assert_eq!(Arm::<'_, u8, u8, 7>::JOINT_NAMES, ["joint1", "joint2"]);
    assert_eq!(Arm::<'_, u8, u8, 7>::VELOCITY_LIMITS, [f64::INFINITY; 2]);
    assert_eq!((T::NAME, T::EFFORT_LIMITS), ("rod", [50.0]));
    assert_eq!(T::POSITION_LIMITS, [(-std::f64::consts::PI, std::f64::consts::PI)]);
    assert_eq!(T::OPERATIONS.sincos, 1);
    let load = rne::Wrench { force: [0.0, T(2.0).0, 0.0], moment: [0.0; 3] };
    // Exerted on the environment, at the end of the rod.
    let [with] = T(0.0).inverse_dynamics_with_wrench(&[0.0], &[0.0], &[0.0], &load);
    assert!((with - 1.6_f64).abs() < 1e-12);
}
