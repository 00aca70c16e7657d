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
            }
        )*

        /// Shows every function to a visitor.
        pub fn each(visitor: &mut impl Visitor) {
            $(
                visitor.visit(stringify!($robot), "seven_steps", $robot::seven_steps::inverse_dynamics);
                visitor.visit(stringify!($robot), "reduced", $robot::reduced::inverse_dynamics);
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

shipped::for_each_robot!(robots!);
