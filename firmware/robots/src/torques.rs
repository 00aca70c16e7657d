//! `inverse_dynamics` of every shipped robot in both forms.

/// A function from positions, velocities and accelerations to torques.
pub type Torques<const DOF: usize, T = f32> = fn(&[T; DOF], &[T; DOF], &[T; DOF]) -> [T; DOF];

/// What is done with each function.
pub trait Visitor<T = f32> {
    /// `robot` and `form` name the function of [`each`].
    fn visit<const DOF: usize>(&mut self, robot: &'static str, form: &'static str, function: Torques<DOF, T>);
}

/// A module per robot and form, and [`each`].
macro_rules! robots {
    ($([$robot:ident, $path:literal])*) => {
        $(
            #[doc = concat!("`robots/", stringify!($robot), ".yaml`")]
            pub mod $robot {
                form!(seven_steps, "seven_steps", $path);
                form!(reduced, "reduced", $path);
                controller!($path);
            }
        )*

        /// Shows every function to a visitor.
        pub fn each(visitor: &mut impl Visitor) {
            $(
                visitor.visit(stringify!($robot), "seven_steps", $robot::seven_steps::inverse_dynamics);
                visitor.visit(stringify!($robot), "reduced", $robot::reduced::inverse_dynamics);
            )*
        }

        /// The tick of the controller of every robot: its torques, named `tick`, and its external torques, named
        /// `contact`.
        #[cfg(feature = "methods")]
        pub fn each_controller(visitor: &mut impl Visitor) {
            $(
                visitor.visit(stringify!($robot), "tick", $robot::controller::torques);
                visitor.visit(stringify!($robot), "contact", $robot::controller::external_torques);
            )*
        }

        /// The same in double precision.
        #[cfg(feature = "double")]
        pub fn each_double(visitor: &mut impl Visitor<f64>) {
            $(
                visitor.visit(stringify!($robot), "seven_steps", $robot::seven_steps::double);
                visitor.visit(stringify!($robot), "reduced", $robot::reduced::double);
            )*
        }
    };
}

/// The functions of a robot in a form.
macro_rules! form {
    ($form:ident, $name:literal, $path:literal) => {
        #[doc = concat!("The form `", $name, "`.")]
        pub mod $form {
            #[derive(rne::InverseDynamics)]
            #[robot(path = $path, form = $name)]
            struct Robot;

            /// One number per joint.
            type Joints<T> = [T; Robot::DOF];

            /// Torques.
            #[inline(never)]
            #[must_use]
            pub fn inverse_dynamics(q: &Joints<f32>, qd: &Joints<f32>, qdd: &Joints<f32>) -> Joints<f32> {
                rne::InverseDynamics::inverse_dynamics(&Robot, q, qd, qdd)
            }

            /// The same in double precision.
            #[cfg(feature = "double")]
            #[inline(never)]
            #[must_use]
            pub fn double(q: &Joints<f64>, qd: &Joints<f64>, qdd: &Joints<f64>) -> Joints<f64> {
                rne::InverseDynamics::inverse_dynamics(&Robot, q, qd, qdd)
            }

            /// As functions that other languages can call.
            #[cfg(all(feature = "double", target_family = "wasm"))]
            pub mod foreign {
                use super::Joints;

                /// Torques.
                pub extern "C" fn inverse_dynamics(
                    q: &Joints<f32>,
                    qd: &Joints<f32>,
                    qdd: &Joints<f32>,
                    tau: &mut Joints<f32>,
                ) {
                    *tau = super::inverse_dynamics(q, qd, qdd);
                }

                /// The same in double precision.
                pub extern "C" fn double(q: &Joints<f64>, qd: &Joints<f64>, qdd: &Joints<f64>, tau: &mut Joints<f64>) {
                    *tau = super::double(q, qd, qdd);
                }
            }
        }
    };
}

/// A controller of a robot at 1 kHz, in the reduced form.
macro_rules! controller {
    ($path:literal) => {
        /// Computed torque with an observer of contacts.
        #[cfg(feature = "methods")]
        pub mod controller {
            use rne::{ComputedTorque, Desired, ObserverState};

            #[derive(rne::InverseDynamics, rne::MomentumObserver)]
            #[robot(path = $path, form = "reduced")]
            struct Robot;

            /// One number per joint.
            type Joints = [f32; Robot::DOF];
            type Controller = ComputedTorque<{ Robot::DOF }, f32>;

            /// A tick.
            #[inline(never)]
            #[must_use]
            pub fn tick(
                controller: &mut Controller,
                q: &Joints,
                qd: &Joints,
                desired: &Desired<{ Robot::DOF }, f32>,
                applied: &Joints,
            ) -> Joints {
                controller.tick(&Robot, q, qd, desired, applied)
            }

            /// The torques of the third tick.
            #[must_use]
            pub fn torques(q: &Joints, qd: &Joints, qdd: &Joints) -> Joints {
                third(q, qd, qdd).1
            }

            /// The external torques of the third tick.
            #[must_use]
            pub fn external_torques(q: &Joints, qd: &Joints, qdd: &Joints) -> Joints {
                *third(q, qd, qdd).0.observer.external_torques()
            }

            fn third(q: &Joints, qd: &Joints, qdd: &Joints) -> (Controller, Joints) {
                let observer = ObserverState::new(20.0, 1e-3);
                let [stiffness, damping] = [256.0, 32.0].map(|gain| [gain; Robot::DOF]);
                let mut controller = ComputedTorque { stiffness, damping, observer };
                let desired = Desired { q: *qd, qd: *q, qdd: *qdd };
                let first = tick(&mut controller, q, qd, &desired, qdd);
                let second = tick(&mut controller, qdd, q, &desired, &first);
                let third = tick(&mut controller, qd, qdd, &desired, &second);
                (controller, third)
            }
        }
    };
}

shipped::for_each_robot!(robots!);
