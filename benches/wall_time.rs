//! Wall time of a call: `cargo bench --manifest-path benches/Cargo.toml --bench wall_time`, with a filter such as
//! `puma560::independent` behind `--`.
//!
//! - `independent`: one state after the other; the processor may overlap a call with the next.
//! - `chained`: every `q` depends on the torques of the call before (times 1e-30, below rounding), so latency counts.
//! - `gravity`, `mass_matrix`, `forward_dynamics`, `derivatives`: the other functions, independent.
//!
//! `arm` is `rne::Arm`, which reads the same table at run time and does the same steps in loops.

use std::hint::black_box;
use std::path::Path;

use divan::Bencher;
use rne::{Arm, ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, MassMatrix, Scalar};
use rne_benches::{PandaReduced, PandaSevenSteps, Puma560Reduced, Puma560SevenSteps, states};

fn main() {
    // 200 samples of 1000 calls; the machine's clock is too coarse for one call.
    divan::Divan::default().sample_count(200).sample_size(1000).config_with_args().main();
}

fn independent<const DOF: usize, T: Scalar>(bencher: Bencher, arm: &impl InverseDynamics<DOF>) {
    let states = states::<DOF, T>();
    let mut index = 0;
    bencher.bench_local(|| {
        index = (index + 1) % states.len();
        let state = black_box(&states[index]);
        arm.inverse_dynamics(&state.q, &state.qd, &state.qdd)
    });
}

fn gravity<const DOF: usize, T: Scalar>(bencher: Bencher, arm: &impl InverseDynamics<DOF>) {
    let states = states::<DOF, T>();
    let mut index = 0;
    bencher.bench_local(|| {
        index = (index + 1) % states.len();
        arm.gravity_torques(&black_box(&states[index]).q)
    });
}

fn mass_matrix<const DOF: usize, T: Scalar>(bencher: Bencher, arm: &impl MassMatrix<DOF>) {
    let states = states::<DOF, T>();
    let mut index = 0;
    bencher.bench_local(|| {
        index = (index + 1) % states.len();
        arm.mass_matrix(&black_box(&states[index]).q)
    });
}

/// The accelerations of a state serve as torques.
fn forward_dynamics<const DOF: usize, T: Scalar>(bencher: Bencher, arm: &impl ForwardDynamics<DOF>) {
    let states = states::<DOF, T>();
    let mut index = 0;
    bencher.bench_local(|| {
        index = (index + 1) % states.len();
        let state = black_box(&states[index]);
        arm.forward_dynamics(&state.q, &state.qd, &state.qdd)
    });
}

fn derivatives<const DOF: usize, T: Scalar>(bencher: Bencher, arm: &impl InverseDynamicsDerivatives<DOF>) {
    let states = states::<DOF, T>();
    let mut index = 0;
    bencher.bench_local(|| {
        index = (index + 1) % states.len();
        let state = black_box(&states[index]);
        arm.inverse_dynamics_derivatives(&state.q, &state.qd, &state.qdd)
    });
}

/// `q` of a state, and nearly nothing of the torques before.
fn behind<const DOF: usize, T: Scalar>(q: [T; DOF], torques: &[T; DOF]) -> [T; DOF] {
    let nearly_nothing = T::from_f64(1e-30);
    std::array::from_fn(|joint| q[joint] + torques[joint] * nearly_nothing)
}

fn chained<const DOF: usize, T: Scalar>(bencher: Bencher, arm: &impl InverseDynamics<DOF>) {
    let states = states::<DOF, T>();
    let mut index = 0;
    let mut torques = [T::zero(); DOF];
    bencher.bench_local(|| {
        index = (index + 1) % states.len();
        let state = black_box(&states[index]);
        torques = arm.inverse_dynamics(&behind(state.q, &torques), &state.qd, &state.qdd);
    });
    black_box(torques);
}

fn robot_file(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots").join(name).with_extension("yaml")
}

fn arm<const DOF: usize>(name: &str) -> Arm<DOF> {
    Arm::from_file(robot_file(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// The benchmarks of one robot: a module per measurement, a function per competitor and scalar.
macro_rules! robot {
    ($name:ident, $dof:literal, $seven_steps:ident, $reduced:ident) => {
        mod $name {
            robot!(@function independent, $name, $dof, $seven_steps, $reduced);
            robot!(@function chained, $name, $dof, $seven_steps, $reduced);
            robot!(@function gravity, $name, $dof, $seven_steps, $reduced);
            robot!(@function mass_matrix, $name, $dof, $seven_steps, $reduced);
            robot!(@function forward_dynamics, $name, $dof, $seven_steps, $reduced);
            robot!(@function derivatives, $name, $dof, $seven_steps, $reduced);
        }
    };
    (@function $measurement:ident, $name:ident, $dof:literal, $seven_steps:ident, $reduced:ident) => {
        mod $measurement {
            use divan::{Bencher, bench};

            robot!(@form $measurement, $dof, seven_steps, seven_steps_f32, $seven_steps);
            robot!(@form $measurement, $dof, reduced, reduced_f32, $reduced);

            #[bench]
            fn arm(bencher: Bencher) {
                crate::$measurement::<$dof, f64>(bencher, &crate::arm::<$dof>(stringify!($name)));
            }

            #[bench]
            fn arm_f32(bencher: Bencher) {
                let arm = rne::Arm::new(crate::arm::<$dof>(stringify!($name)).model().to_f32());
                crate::$measurement::<$dof, f32>(bencher, &arm);
            }
        }
    };
    (@form $measurement:ident, $dof:literal, $double:ident, $single:ident, $robot:ident) => {
        #[bench]
        fn $double(bencher: Bencher) {
            crate::$measurement::<$dof, f64>(bencher, &crate::$robot);
        }

        #[bench]
        fn $single(bencher: Bencher) {
            crate::$measurement::<$dof, f32>(bencher, &crate::$robot);
        }
    };
}

robot!(puma560, 6, Puma560SevenSteps, Puma560Reduced);
robot!(panda, 7, PandaSevenSteps, PandaReduced);
