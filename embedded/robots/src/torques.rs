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
    ($($robot:ident[$dof:literal]: $path:literal;)*) => {
        $(
            #[doc = concat!("`", $path, "`")]
            pub mod $robot {
                robots!(seven_steps, "seven_steps", $dof, $path);
                robots!(reduced, "reduced", $dof, $path);
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
    ($form:ident, $name:literal, $dof:literal, $path:literal) => {
        #[doc = concat!("The form `", $name, "`.")]
        pub mod $form {
            #[derive(rne::InverseDynamics)]
            #[robot(path = $path, form = $name)]
            struct Robot;

            /// Torques.
            #[inline(never)]
            #[must_use]
            pub fn inverse_dynamics(q: &[f32; $dof], qd: &[f32; $dof], qdd: &[f32; $dof]) -> [f32; $dof] {
                rne::InverseDynamics::inverse_dynamics(&Robot, q, qd, qdd)
            }

            /// The same in double precision.
            #[cfg(feature = "double")]
            #[inline(never)]
            #[must_use]
            pub fn double(q: &[f64; $dof], qd: &[f64; $dof], qdd: &[f64; $dof]) -> [f64; $dof] {
                rne::InverseDynamics::inverse_dynamics(&Robot, q, qd, qdd)
            }

            /// As functions that other languages can call.
            #[cfg(all(feature = "double", target_family = "wasm"))]
            pub mod foreign {
                /// Torques.
                pub extern "C" fn inverse_dynamics(
                    q: &[f32; $dof], qd: &[f32; $dof], qdd: &[f32; $dof], tau: &mut [f32; $dof],
                ) {
                    *tau = super::inverse_dynamics(q, qd, qdd);
                }

                /// The same in double precision.
                pub extern "C" fn double(
                    q: &[f64; $dof], qd: &[f64; $dof], qdd: &[f64; $dof], tau: &mut [f64; $dof],
                ) {
                    *tau = super::double(q, qd, qdd);
                }
            }
        }
    };
}

robots! {
    cylindrical_rpp[3]: "../../../robots/cylindrical_rpp.yaml";
    gantry_ppp[3]: "../../../robots/gantry_ppp.yaml";
    iiwa14[7]: "../../../robots/iiwa14.yaml";
    panda[7]: "../../../robots/panda.yaml";
    planar1[1]: "../../../robots/planar1.yaml";
    planar2[2]: "../../../robots/planar2.yaml";
    planar3[3]: "../../../robots/planar3.yaml";
    puma560[6]: "../../../robots/puma560.yaml";
    puma560_mdh[6]: "../../../robots/puma560_mdh.yaml";
    scara_cobra600[4]: "../../../robots/scara_cobra600.yaml";
    spherical_rrp[3]: "../../../robots/spherical_rrp.yaml";
    stanford[6]: "../../../robots/stanford.yaml";
    ur5[6]: "../../../robots/ur5.yaml";
    ur5e[6]: "../../../robots/ur5e.yaml";
    wam7[7]: "../../../robots/wam7.yaml";
}
