//! Errors of sine and cosine against a reference of higher precision: of every `f32` up to 10⁵ rad, of 10⁸ random `f64`
//! up to there and of those nearest to multiples of π/4. Fails above the promised bounds.
//!
//! `cargo run --release -p rne-runtime --features batch --example sin_cos_accuracy`; without the feature, without the
//! vector units of batches.

#[path = "../tests/sin_cos/reference.rs"]
mod reference;
#[path = "../tests/sin_cos/turn.rs"]
mod turn;

use std::f64::consts::FRAC_PI_4;
use std::fmt::Debug;
use std::io::{IsTerminal, Write};
use std::ops::Range;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;

use rne_runtime::{BatchScalar, Scalar, VectorUnit, batch};
use turn::Turn;

/// Promised for angles up to here, in rad, in units in the last place.
const LIMIT: f32 = 1e5;
/// Multiples of π/4 up to there, but the last.
const MULTIPLES: u32 = 127_322;
const PROMISE_F64: f64 = 1.0;
const PROMISE_F32: f64 = 1.0;

const RANDOM_ANGLES: u32 = 100_000_000;
const THREADS: u32 = 2;
/// Angles between two reports of progress.
const STEP: u32 = 1 << 20;

/// The largest error so far and its angle.
#[derive(Clone, Copy)]
struct Worst<T> {
    ulp: f64,
    angle: T,
}

impl<T: Copy> Worst<T> {
    /// An error that is no number is infinite.
    fn meets(&mut self, ulp: f64, angle: T) {
        let ulp = if ulp.is_nan() { f64::INFINITY } else { ulp };
        if ulp > self.ulp {
            *self = Self { ulp, angle };
        }
    }
}

/// Worst errors of sine and cosine over `0..count`, `check` being given a range of at most a step at a time.
fn sweep<T: Copy + Debug + Default + Send>(
    name: &str,
    count: u32,
    promise: f64,
    check: impl Fn(Range<u32>, &mut [Worst<T>; 2]) + Sync,
) -> bool {
    let next = AtomicU32::new(0);
    let steps = count.div_ceil(STEP);
    let work = || {
        let mut worst = [Worst { ulp: 0.0, angle: T::default() }; 2];
        loop {
            let step = next.fetch_add(1, Ordering::Relaxed);
            if step >= steps {
                return worst;
            }
            if std::io::stderr().is_terminal() {
                let _ = write!(std::io::stderr(), "\r{name}: {:3} %\r", 100 * u64::from(step) / u64::from(steps));
            }
            check(step * STEP..count.min((step + 1).saturating_mul(STEP)), &mut worst);
        }
    };
    let found: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = (0..THREADS).map(|_| scope.spawn(work)).collect();
        threads.into_iter().map(|thread| thread.join().expect("a thread of this sweep")).collect()
    });
    let mut kept = true;
    for (function, name_of) in ["sine", "cosine"].iter().enumerate() {
        let worst = found.iter().map(|worst| worst[function]).reduce(|a, b| if b.ulp <= a.ulp { a } else { b });
        let Worst { ulp, angle } = worst.expect("a thread");
        println!("{name}, {name_of:6}: {ulp:.4} ulp at {angle:?}, promised < {promise}");
        kept &= ulp < promise;
    }
    kept
}

/// Sines and cosines of eight angles.
trait SinCos<T>: Fn([T; 8]) -> ([T; 8], [T; 8]) + Sync {}
impl<T, F: Fn([T; 8]) -> ([T; 8], [T; 8]) + Sync> SinCos<T> for F {}

/// All of both signs, `step` apart: those of negative angles must be the same but for the sign.
fn singles(sin_cos: &impl SinCos<f32>, step: u32, range: Range<u32>, worst: &mut [Worst<f32>; 2]) {
    for first in range.step_by(8) {
        let angles = [0, 1, 2, 3, 4, 5, 6, 7].map(|lane| f32::from_bits(step * (first + lane)));
        let (sines, cosines) = sin_cos(angles);
        let opposite = sin_cos(angles.map(|angle| -angle));
        let mirrored = (opposite.0.map(|sine| (-sine).to_bits()), opposite.1.map(f32::to_bits));
        if mirrored != (sines.map(f32::to_bits), cosines.map(f32::to_bits)) {
            worst[0].meets(f64::INFINITY, angles[0]);
        }
        for ((angle, sine), cosine) in angles.into_iter().zip(sines).zip(cosines) {
            let exact = f64::from(angle).sin_cos();
            worst[0].meets(reference::error_in_ulp_f32(sine, exact.0), angle);
            worst[1].meets(reference::error_in_ulp_f32(cosine, exact.1), angle);
        }
    }
}

fn double(sin_cos: &impl SinCos<f64>, angles: [f64; 8], worst: &mut [Worst<f64>; 2]) {
    let (sines, cosines) = sin_cos(angles);
    for ((angle, sine), cosine) in angles.into_iter().zip(sines).zip(cosines) {
        let exact = reference::sin_cos(angle);
        worst[0].meets(exact.0.error_in_ulp(sine), angle);
        worst[1].meets(exact.1.error_in_ulp(cosine), angle);
    }
}

/// Half of them up to the limit, half of them up to two turns.
fn random_doubles(sin_cos: &impl SinCos<f64>, range: Range<u32>, worst: &mut [Worst<f64>; 2]) {
    let mut numbers = fastrand::Rng::with_seed(range.start.into());
    for first in range.step_by(8) {
        let limit = if (first / 8).is_multiple_of(2) { f64::from(LIMIT) } else { 4.0 * std::f64::consts::PI };
        double(sin_cos, std::array::from_fn(|_| (2.0 * numbers.f64() - 1.0) * limit), worst);
    }
}

/// The nearest numbers to n π/4, from the fourth below to the third above.
fn near_multiples(sin_cos: &impl SinCos<f64>, range: Range<u32>, worst: &mut [Worst<f64>; 2]) {
    for n in range {
        let nearest = (f64::from(n + 1) * FRAC_PI_4).to_bits() - 4;
        double(sin_cos, std::array::from_fn(|step| f64::from_bits(nearest + step as u64)), worst);
    }
}

fn on<T: BatchScalar>(unit: VectorUnit, angles: [T; 8]) -> ([T; 8], [T; 8]) {
    let (mut sines, mut cosines) = (angles, angles);
    batch::run(&Turn, unit, [&angles], [&mut sines, &mut cosines]).expect("arrays of one length");
    (sines, cosines)
}

fn main() -> ExitCode {
    let f32s = LIMIT.to_bits() + 1;
    let mut kept = vec![
        sweep("every f32 up to 1e5", f32s, PROMISE_F32, |range, worst| {
            singles(&Scalar::sin_cos_array, 1, range, worst);
        }),
        sweep("1e8 random f64     ", RANDOM_ANGLES, PROMISE_F64, |range, worst| {
            random_doubles(&Scalar::sin_cos_array, range, worst);
        }),
        sweep("f64 near n pi/4    ", MULTIPLES, PROMISE_F64, |range, worst| {
            near_multiples(&Scalar::sin_cos_array, range, worst);
        }),
    ];
    // The kernel of batches, which is another one.
    for unit in VectorUnit::all().skip(1) {
        let name = |what: &str| format!("{unit}, {what}");
        let (single, double) = (|angles| on::<f32>(unit, angles), |angles| on::<f64>(unit, angles));
        kept.extend([
            sweep(&name("every 10th f32 "), f32s / 10, PROMISE_F32, |range, worst| singles(&single, 10, range, worst)),
            sweep(&name("1e7 random f64 "), RANDOM_ANGLES / 10, PROMISE_F64, |range, worst| {
                random_doubles(&double, range, worst);
            }),
            sweep(&name("f64 near n pi/4"), MULTIPLES, PROMISE_F64, |range, worst| {
                near_multiples(&double, range, worst);
            }),
        ]);
    }
    if kept.contains(&false) { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
