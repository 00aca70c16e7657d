//! The factors M = L D Lᵀ of a mass matrix, and its inverse by them. The order of the operations is that of
//! [`ForwardDynamics`](crate::ForwardDynamics).

use crate::Scalar;

/// Factors M = L D Lᵀ in place. Afterwards M has L below its diagonal and c above it: c_ij is at (j, i). `inverse` gets
/// the reciprocals of D.
#[doc(hidden)]
pub fn factor<T: Scalar, R: AsRef<[T]> + AsMut<[T]>>(m: &mut [R], inverse: &mut [T]) {
    let n = m.len();
    for j in 0..n {
        // What remains of column j, M being symmetric: c_ij for i ≥ j; the first of them is D_j.
        for i in j..n {
            let mut rest = m[j].as_ref()[i];
            for k in 0..j {
                rest -= m[i].as_ref()[k] * m[k].as_ref()[j];
            }
            m[j].as_mut()[i] = rest;
        }
        inverse[j] = T::one() / m[j].as_ref()[j];
        for i in j + 1..n {
            m[i].as_mut()[j] = m[j].as_ref()[i] * inverse[j];
        }
    }
}

/// Solves M x = b with the factors and the reciprocals of D. `x` contains b before and the solution afterwards.
pub(crate) fn solve<T: Scalar, R: AsRef<[T]>>(m: &[R], inverse: &[T], x: &mut [T]) {
    let n = x.len();
    for i in 0..n {
        for k in 0..i {
            x[i] -= m[i].as_ref()[k] * x[k];
        }
    }
    for (x, &inverse) in x.iter_mut().zip(inverse) {
        *x *= inverse;
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            x[i] -= m[k].as_ref()[i] * x[k];
        }
    }
}

/// Returns the inverse of M; `zeros` is a row of zeros.
pub(crate) fn inverse_of<T: Scalar, R, M>(mut m: M, zeros: &R) -> M
where
    R: AsRef<[T]> + AsMut<[T]> + Clone,
    M: AsRef<[R]> + AsMut<[R]> + Clone,
{
    let (mut matrix, mut inverse) = (m.clone(), zeros.clone());
    factor(m.as_mut(), inverse.as_mut());
    let (m, inverse) = (m.as_ref(), inverse.as_ref());
    let lower = |i: usize, k: usize| m[i].as_ref()[k];
    for j in 0..m.len() {
        let mut column = zeros.clone();
        let x = column.as_mut();
        x[j] = T::one();
        for i in j + 1..m.len() {
            x[i] = -lower(i, j);
            for k in j + 1..i {
                let y = x[k];
                x[i] -= lower(i, k) * y;
            }
        }
        for i in j..m.len() {
            x[i] *= inverse[i];
        }
        for i in (j..m.len()).rev() {
            for k in i + 1..m.len() {
                let below = x[k];
                x[i] -= lower(k, i) * below;
            }
            matrix.as_mut()[i].as_mut()[j] = x[i];
            matrix.as_mut()[j].as_mut()[i] = x[i];
        }
    }
    matrix
}
