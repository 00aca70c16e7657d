//! Sine and cosine in C, and the constants of those in Rust, against those of the runtime, at many angles.

use std::collections::BTreeSet;
use std::slice::from_ref;

use fastrand::Rng;
use rne::Scalar;
use rne_codegen::{Form, Function};
use rne_emit::Precision;
use rne_model::Robot;

use crate::comparison::{ROOT, read};
use crate::compiler::Compiler;
use crate::driver::{INCLUDES, words};

const ANGLES: usize = 100_000;

/// Angles of every magnitude up to 10⁵, and those at which a quadrant ends.
fn angles(rng: &mut Rng) -> Vec<f64> {
    let limit = |angle: f64| angle.clamp(-1e5, 1e5);
    let mut angles = vec![0.0, -0.0, 1e5, -1e5, f64::MIN_POSITIVE, f64::from(f32::MIN_POSITIVE)];
    while angles.len() < ANGLES {
        let sign = if rng.bool() { 1.0 } else { -1.0 };
        let bound = f64::from(rng.u32(..127_000)) * std::f64::consts::FRAC_PI_4;
        angles.extend([
            limit(sign * rng.f64() * 1e5),
            limit(sign * 10_f64.powf(rng.f64() * 13.0 - 8.0)),
            limit(sign * bound),
            limit(sign * bound * (1.0 + (rng.f64() - 0.5) * 1e-6)),
        ]);
    }
    angles.truncate(ANGLES);
    angles
}

#[test]
#[allow(clippy::cast_possible_truncation)]
fn sine_and_cosine_have_the_bits_of_the_runtime() {
    let Some(compiler) = Compiler::found() else { return };
    let robot = Robot::from_yaml(&read(&format!("{ROOT}/robots/planar1.yaml"))).expect("a robot");
    let program = rne_codegen::Compiler::new(&robot)
        .compile(Function::GravityTorques, Form::SevenSteps)
        .expect("finite constants");
    let angles = angles(&mut Rng::with_seed(7));
    for precision in Precision::ALL {
        let real = precision.c_type();
        let prefix = "arm".parse().expect("an identifier");
        let code = rne_emit::c_code(&robot, from_ref(&program), precision, &prefix).expect("small constants");
        let source = format!(
            "{INCLUDES}{}{}int main(void)\n{{\n    {real} x[3];\n    \
             while (read_{real}(x, 1u)) {{ arm_sin_cos(x[0], &x[1], &x[2]); print_{real}(&x[1], 2u); }}\n    \
             return 0;\n}}\n",
            code.one_file(),
            words(precision)
        );
        let (input, expected): (Vec<u64>, Vec<[u64; 2]>) = match precision {
            Precision::Single => {
                let of = |angle: f32| <[f32; 2]>::from(Scalar::sin_cos(angle)).map(|x| x.to_bits().into());
                angles.iter().map(|&angle| (u64::from((angle as f32).to_bits()), of(angle as f32))).unzip()
            }
            Precision::Double => {
                let of = |angle: f64| <[f64; 2]>::from(Scalar::sin_cos(angle)).map(f64::to_bits);
                angles.iter().map(|&angle| (angle.to_bits(), of(angle))).unzip()
            }
        };
        let found = compiler.run(&format!("sin_cos_{real}"), "-O2", &source, &input);
        assert_eq!(found.len(), 2 * expected.len());
        for ((found, expected), angle) in found.chunks(2).zip(&expected).zip(&angles) {
            // every bit, a zero's sign as well
            assert_eq!(found, expected, "sine and cosine of {angle:e} in {real}");
        }
    }
    println!("{} angles, every bit of sine and cosine, float and double", angles.len());
}

/// The magnitudes of the numbers with a point in source code, comments aside, as they are read in double precision.
fn constants(code: &str) -> BTreeSet<u64> {
    let code = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    let words = code.flat_map(|line| line.split(|c: char| " ()[],;".contains(c)));
    let number = |word: &str| {
        let word = word.trim_start_matches('-').trim_end_matches('f').replace('_', "");
        word.contains('.').then(|| word.parse::<f64>().ok()).flatten()
    };
    words.filter_map(number).map(f64::to_bits).collect()
}

/// The last bit of a coefficient changes the result at one angle of millions: the two copies are compared as text.
#[test]
fn the_constants_are_those_of_the_runtime() {
    let read = |file: &str| read(&format!("{ROOT}/{file}"));
    let (reduction, polynomial) =
        (read("rne-runtime/src/number/sin_cos/reduction.rs"), read("rne-runtime/src/number/sin_cos/polynomial.rs"));
    let (double, single) = reduction.split_once("fn single").expect("two functions");
    let (double_sums, single_sums) = polynomial.split_once("const P_F32").expect("two pairs of polynomials");
    let single_sums = single_sums.split_once("/// Sine").expect("the end of the constants").0;
    for (real, parts, sums, inverse) in
        [("double", double, double_sums, "0.6366197723675814"), ("float", single, single_sums, "0.63661975")]
    {
        let rust = if real == "double" { "f64" } else { "f32" };
        for file in [format!("c/sin_cos_{real}.c"), format!("sin_cos_{rust}.rs")] {
            let emitted = constants(&read(&format!("compiler/emit/src/{file}")));
            assert_eq!(emitted, constants(&format!("{parts} {sums} 0.5 1.0 {inverse}")), "{file}");
        }
    }
    assert_eq!("0.6366197723675814".parse(), Ok(std::f64::consts::FRAC_2_PI));
    assert_eq!("0.63661975".parse(), Ok(std::f32::consts::FRAC_2_PI));
}
