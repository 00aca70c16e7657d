//! `inverse_dynamics` of every shipped robot in both forms.

/// A function from positions, velocities and accelerations to torques.
pub type Torques<const DOF: usize, T = f32> = fn(&[T; DOF], &[T; DOF], &[T; DOF]) -> [T; DOF];

/// An operation that [`each`] applies to every function.
pub trait Visitor<T = f32> {
    /// Receives a function of [`each`], with the names of its robot and form.
    fn visit<const DOF: usize>(&mut self, robot: &'static str, form: &'static str, function: Torques<DOF, T>);
}

/// Makes a module for each robot and form, and [`each`].
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

        /// Passes every function to a visitor.
        pub fn each(visitor: &mut impl Visitor) {
            $(
                visitor.visit(stringify!($robot), "seven_steps", $robot::seven_steps::inverse_dynamics);
                visitor.visit(stringify!($robot), "reduced", $robot::reduced::inverse_dynamics);
            )*
        }

        /// Passes the results of a controller tick of every robot to a visitor: its torques, named `tick`, and its
        /// external torques, named `contact`.
        #[cfg(feature = "methods")]
        pub fn each_controller(visitor: &mut impl Visitor) {
            $(
                visitor.visit(stringify!($robot), "tick", $robot::controller::torques);
                visitor.visit(stringify!($robot), "contact", $robot::controller::external_torques);
            )*
        }

        /// Passes every function in double precision to a visitor.
        #[cfg(feature = "double")]
        pub fn each_double(visitor: &mut impl Visitor<f64>) {
            $(
                visitor.visit(stringify!($robot), "seven_steps", $robot::seven_steps::double);
                visitor.visit(stringify!($robot), "reduced", $robot::reduced::double);
            )*
        }
    };
}

/// Makes the functions of a robot in a form.
macro_rules! form {
    ($form:ident, $name:literal, $path:literal) => {
        #[doc = concat!("The form `", $name, "`.")]
        pub mod $form {
            #[derive(rne::InverseDynamics)]
            #[robot(path = $path, form = $name)]
            struct Robot;

            /// One number per joint.
            type Joints<T> = [T; Robot::DOF];

            /// Computes the torques.
            #[inline(never)]
            #[must_use]
            pub fn inverse_dynamics(q: &Joints<f32>, qd: &Joints<f32>, qdd: &Joints<f32>) -> Joints<f32> {
                rne::InverseDynamics::inverse_dynamics(&Robot, q, qd, qdd)
            }

            /// Computes the torques in double precision.
            #[cfg(feature = "double")]
            #[inline(never)]
            #[must_use]
            pub fn double(q: &Joints<f64>, qd: &Joints<f64>, qdd: &Joints<f64>) -> Joints<f64> {
                rne::InverseDynamics::inverse_dynamics(&Robot, q, qd, qdd)
            }

            /// The same functions, exported for other languages.
            #[cfg(all(feature = "double", target_family = "wasm"))]
            pub mod foreign {
                use super::Joints;

                /// Computes the torques.
                pub extern "C" fn inverse_dynamics(
                    q: &Joints<f32>,
                    qd: &Joints<f32>,
                    qdd: &Joints<f32>,
                    tau: &mut Joints<f32>,
                ) {
                    *tau = super::inverse_dynamics(q, qd, qdd);
                }

                /// Computes the torques in double precision.
                pub extern "C" fn double(q: &Joints<f64>, qd: &Joints<f64>, qdd: &Joints<f64>, tau: &mut Joints<f64>) {
                    *tau = super::double(q, qd, qdd);
                }
            }
        }
    };
}

/// Makes a controller of a robot at 1 kHz, in the reduced form.
macro_rules! controller {
    ($path:literal) => {
        /// A computed-torque controller with an observer of external torques.
        #[cfg(feature = "methods")]
        pub mod controller {
            use rne::{ComputedTorque, Desired, ObserverState};

            #[derive(rne::InverseDynamics, rne::MomentumObserver)]
            #[robot(path = $path, form = "reduced")]
            struct Robot;

            /// One number per joint.
            type Joints = [f32; Robot::DOF];
            type Controller = ComputedTorque<{ Robot::DOF }, f32>;

            /// Runs one tick of the controller.
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

            /// Returns the torques of the third tick.
            #[must_use]
            pub fn torques(q: &Joints, qd: &Joints, qdd: &Joints) -> Joints {
                third(q, qd, qdd).1
            }

            /// Returns the external torques of the third tick.
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
