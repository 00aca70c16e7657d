//! How numbers are read and compared.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rne::Wrench;
use serde_json::Value;

/// The workspace.
pub(crate) const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

pub(crate) fn json(file: &str) -> Value {
    let text = std::fs::read_to_string(format!("{ROOT}/{file}")).unwrap_or_else(|error| panic!("{file}: {error}"));
    serde_json::from_str(&text).expect("JSON")
}

/// All numbers of an array of arrays, row after row.
pub(crate) fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(values) => values.iter().flat_map(numbers).collect(),
        number => vec![number.as_f64().expect("a number")],
    }
}

/// Rows of a matrix, one after the other.
pub(crate) fn flat<T: Copy>(rows: impl IntoIterator<Item = impl AsRef<[T]>>) -> Vec<T> {
    rows.into_iter().flat_map(|row| row.as_ref().to_vec()).collect()
}

pub(crate) fn wrench([fx, fy, fz, nx, ny, nz]: [f64; 6]) -> Wrench<f64> {
    Wrench { force: [fx, fy, fz], moment: [nx, ny, nz] }
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A matrix, as rows, times a vector.
pub(crate) fn product(rows: &[impl AsRef<[f64]>], x: &[f64]) -> Vec<f64> {
    rows.iter().map(|row| dot(row.as_ref(), x)).collect()
}

/// The largest difference, relative to the largest of `expected` or, if that is smaller, to `scale`.
pub(crate) fn error_on_scale(found: &[f64], expected: &[f64], scale: f64) -> f64 {
    assert_eq!(found.len(), expected.len());
    // `f64::max` drops what is not a number
    assert!(found.iter().chain(expected).all(|x| x.is_finite()), "{found:?} {expected:?}");
    let scale = expected.iter().fold(scale, |scale, x| scale.max(x.abs()));
    let error = found.iter().zip(expected).fold(0.0_f64, |error, (a, b)| error.max((a - b).abs()));
    if scale == 0.0 { error } else { error / scale }
}

pub(crate) fn relative_error(found: &[f64], expected: &[f64]) -> f64 {
    error_on_scale(found, expected, 0.0)
}

pub(crate) fn eigenvalues(symmetric: &[Vec<f64>]) -> DVector<f64> {
    let matrix = DMatrix::from_row_slice(symmetric.len(), symmetric.len(), &flat(symmetric));
    SymmetricEigen::new(matrix).eigenvalues
}

/// How much a matrix magnifies errors when it is divided by.
#[derive(Clone, Copy)]
pub(crate) struct Conditioning {
    /// The ratio of its largest to its smallest eigenvalue.
    pub(crate) number: f64,
    pub(crate) largest: f64,
}

/// `None` for a matrix that is not positive definite.
pub(crate) fn conditioning(symmetric: &[Vec<f64>]) -> Option<Conditioning> {
    let eigenvalues = eigenvalues(symmetric);
    let (smallest, largest) = (eigenvalues.min(), eigenvalues.max());
    (smallest > 0.0).then(|| Conditioning { number: largest / smallest, largest })
}

/// The worst error of each quantity, and how many were joined.
#[derive(Default)]
pub(crate) struct Worst(Vec<(&'static str, f64, usize)>);

impl Worst {
    pub(crate) fn see(&mut self, what: &'static str, error: f64) {
        self.add(what, error, 0);
    }

    fn add(&mut self, what: &'static str, error: f64, count: usize) {
        assert!(!error.is_nan(), "{what}");
        match self.0.iter_mut().find(|(name, ..)| *name == what) {
            Some((_, worst, of)) => (*worst, *of) = (worst.max(error), *of + count),
            None => self.0.push((what, error, count.max(1))),
        }
    }

    /// The name of each quantity, its worst error, and the number of those that saw it and were joined.
    pub(crate) fn rows(&self) -> &[(&'static str, f64, usize)] {
        &self.0
    }

    /// How many quantities were seen.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// The worse of both.
    pub(crate) fn join(&mut self, other: Self) {
        other.0.into_iter().for_each(|(what, error, count)| self.add(what, error, count));
    }

    /// Prints all and fails on those above `tolerance`.
    #[track_caller]
    pub(crate) fn at_most(&self, tolerance: f64, of: &str) {
        for (what, error, _) in &self.0 {
            println!("{of:40} {what:20} {error:.1e}");
            assert!(*error <= tolerance, "{of}, {what}: {error:e}");
        }
    }
}
