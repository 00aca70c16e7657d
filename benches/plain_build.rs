//! Single calls of derived code, as this program is compiled: `cargo xtask performance plain_build` compiles it twice,
//! as `cargo build --release` does it and with `-C target-cpu=x86-64-v3`, runs the two in turn and compares them.
//!
//! ```sh
//! cargo run --release --manifest-path benches/Cargo.toml --no-default-features --bin plain_build
//! ```
//!
//! A line for a robot, a scalar and a kind of call: nanoseconds of the reduced form and of the same with
//! `#[robot(inline)]`, which does not ask the processor; the minima of many alternating repetitions over the same
//! states. The states are a few, so that they stay in the nearest cache.

use std::hint::black_box;
use std::time::Instant;

use rne::{ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, Kinematics, MassMatrix, Scalar};
use rne_benches::{State, states};

const ROUNDS: usize = 16;
const REPETITIONS: usize = 60;

trait Everything<const DOF: usize>:
    InverseDynamics<DOF> + MassMatrix<DOF> + ForwardDynamics<DOF> + InverseDynamicsDerivatives<DOF> + Kinematics<DOF>
{
}

macro_rules! arms {
    ($($Arm:ident $Inlined:ident: $name:literal;)*) => {
        $(
            #[derive(
                InverseDynamics, MassMatrix, ForwardDynamics, InverseDynamicsDerivatives, Kinematics,
            )]
            #[robot(builtin = $name, form = "reduced")]
            struct $Arm;
            impl Everything<{ $Arm::DOF }> for $Arm {}

            #[derive(
                InverseDynamics, MassMatrix, ForwardDynamics, InverseDynamicsDerivatives, Kinematics,
            )]
            #[robot(builtin = $name, form = "reduced", inline)]
            struct $Inlined;
            impl Everything<{ $Inlined::DOF }> for $Inlined {}
        )*

        fn main() {
            $(
                rows::<{ $Arm::DOF }, f64>(concat!($name, " f64"), &$Arm, &$Inlined);
                rows::<{ $Arm::DOF }, f32>(concat!($name, " f32"), &$Arm, &$Inlined);
            )*
        }
    };
}
arms! {
    Puma560 InlinedPuma560: "puma560";
    Panda InlinedPanda: "panda";
    Iiwa14 InlinedIiwa14: "iiwa14";
    Ur5 InlinedUr5: "ur5";
    Cobra600 InlinedCobra600: "scara_cobra600";
    Stanford InlinedStanford: "stanford";
}

fn rows<const DOF: usize, T: Scalar>(name: &str, asking: &impl Everything<DOF>, inlined: &impl Everything<DOF>) {
    macro_rules! row {
        ($function:ident, $at:ident: $($argument:expr),*) => {
            let mut times = [f64::INFINITY; 2];
            for _ in 0..REPETITIONS {
                independent(&mut times[0], |$at: &State<DOF, T>| asking.$function($($argument),*));
                independent(&mut times[1], |$at: &State<DOF, T>| inlined.$function($($argument),*));
            }
            print(name, stringify!($function), times);
        };
    }
    row!(inverse_dynamics, at: &at.q, &at.qd, &at.qdd);
    let mut times = [f64::INFINITY; 2];
    for _ in 0..REPETITIONS {
        chained::<DOF, T>(&mut times[0], |q, at| asking.inverse_dynamics(q, &at.qd, &at.qdd));
        chained::<DOF, T>(&mut times[1], |q, at| inlined.inverse_dynamics(q, &at.qd, &at.qdd));
    }
    print(name, "inverse_dynamics, chained", times);
    row!(gravity_torques, at: &at.q);
    row!(mass_matrix, at: &at.q);
    row!(forward_dynamics, at: &at.q, &at.qd, &at.qdd);
    row!(inverse_dynamics_derivatives, at: &at.q, &at.qd, &at.qdd);
    row!(forward_kinematics, at: &at.q);
}

fn print(name: &str, kind: &str, [asking, inlined]: [f64; 2]) {
    println!("{name:<18} {kind:<28} {asking:>7.1} {inlined:>7.1}");
}

/// Nanoseconds of a call, if it is less than before: the processor may overlap a call with the next.
fn independent<const DOF: usize, T: Scalar, R>(best: &mut f64, call: impl Fn(&State<DOF, T>) -> R) {
    let states = states();
    fastest(best, states.len(), || {
        for state in &states {
            black_box(&call(black_box(state)));
        }
    });
}

/// The same where every `q` depends on the torques of the call before, times 1e-30, below rounding.
fn chained<const DOF: usize, T: Scalar>(best: &mut f64, call: impl Fn(&[T; DOF], &State<DOF, T>) -> [T; DOF]) {
    let states = states();
    let nearly_nothing = T::from_f64(1e-30);
    let mut torques = [T::zero(); DOF];
    fastest(best, states.len(), || {
        for state in &states {
            let state: &State<DOF, T> = black_box(state);
            let q = std::array::from_fn(|joint| state.q[joint] + torques[joint] * nearly_nothing);
            torques = call(&q, state);
        }
    });
    black_box(torques);
}

fn fastest(best: &mut f64, calls: usize, mut work: impl FnMut()) {
    let start = Instant::now();
    for _ in 0..ROUNDS {
        work();
    }
    #[allow(clippy::cast_precision_loss)] // of a thousand calls
    let time = start.elapsed().as_nanos() as f64 / (ROUNDS * calls) as f64;
    *best = best.min(time);
}
