//! Time of sine and cosine, `std` beside it: `cargo run --release -p rne-runtime --example sin_cos_speed`.

use std::hint::black_box;
use std::time::Instant;

use rne_runtime::Scalar;

/// Sets of angles per round, few enough for the first cache.
const SETS: u32 = 128;
const ROUNDS: u32 = 2_000;
/// The fastest of so many tries counts: the machine may be shared.
const TRIES: usize = 15;

/// Nanoseconds per set.
fn time<const N: usize, T: Scalar>(sets: &[[T; N]], function: impl Fn([T; N]) -> ([T; N], [T; N])) -> f64 {
    let mut results = vec![([T::zero(); N], [T::zero(); N]); sets.len()];
    let mut best = f64::INFINITY;
    for _ in 0..TRIES {
        let start = Instant::now();
        for _ in 0..ROUNDS {
            for (result, &angles) in black_box(&mut results).iter_mut().zip(black_box(sets)) {
                *result = function(angles);
            }
        }
        best = best.min(start.elapsed().as_secs_f64());
    }
    best * 1e9 / f64::from(ROUNDS) / f64::from(SETS)
}

fn row<const N: usize, T: Scalar>(name: &str, range: f64, std_sin_cos: impl Fn(T) -> (T, T)) {
    let mut numbers = fastrand::Rng::with_seed(1);
    let mut angle = || T::from_f64((2.0 * numbers.f64() - 1.0) * range);
    let sets: Vec<[T; N]> = (0..SETS).map(|_| std::array::from_fn(|_| angle())).collect();
    let own = time(&sets, T::sin_cos_array);
    let one_by_one = time(&sets, |angles| {
        let pairs = angles.map(&std_sin_cos);
        (pairs.map(|(sine, _)| sine), pairs.map(|(_, cosine)| cosine))
    });
    println!("{N} {name}, up to {range:>6} rad: {own:6.2} ns, std {one_by_one:6.2} ns, ratio {:4.1}", one_by_one / own);
}

fn main() {
    for range in [3.0, 1e5] {
        row::<1, f64>("f64", range, f64::sin_cos);
        row::<6, f64>("f64", range, f64::sin_cos);
        row::<7, f64>("f64", range, f64::sin_cos);
        row::<8, f64>("f64", range, f64::sin_cos);
        row::<6, f32>("f32", range, f32::sin_cos);
        row::<8, f32>("f32", range, f32::sin_cos);
    }
}
