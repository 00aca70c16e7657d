//! The order in which nalgebra evaluates what the seven steps use. Generated code repeats this order to the bit, so a
//! release of nalgebra that changed it must fail here first.

use crate::common::Numbers;
use nalgebra::{Matrix3, Vector3};

/// ((a₀ b₀ + a₁ b₁) + a₂ b₂)
fn sum(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

#[test]
fn three_products_are_summed_from_left_to_right() {
    let mut numbers = Numbers::new(1);
    for _ in 0..1000 {
        let (a, b): ([f64; 9], [f64; 9]) = (numbers.array(1.0), numbers.array(1.0));
        let (a, b) = (Matrix3::from_row_slice(&a), Matrix3::from_row_slice(&b));
        let x: [f64; 3] = numbers.array(1.0);
        let v = Vector3::from(x);
        let row = |m: &Matrix3<f64>, i: usize| [m[(i, 0)], m[(i, 1)], m[(i, 2)]];
        let column = |m: &Matrix3<f64>, j: usize| [m[(0, j)], m[(1, j)], m[(2, j)]];

        for i in 0..3 {
            assert_eq!((a * v)[i], sum(row(&a, i), x), "M v");
            assert_eq!(a.row(i).transpose().dot(&v), sum(row(&a, i), x), "v · v");
            assert_eq!(a.tr_mul(&v)[i], sum(column(&a, i), x), "Mᵀ v");
            for j in 0..3 {
                assert_eq!((a * b)[(i, j)], sum(row(&a, i), column(&b, j)), "M M");
                assert_eq!((a * b.transpose())[(i, j)], sum(row(&a, i), row(&b, j)), "M Mᵀ");
            }
        }
    }
}

#[test]
fn cross_products_and_scalings_are_elementwise() {
    let mut numbers = Numbers::new(2);
    for _ in 0..1000 {
        let (a, b): ([f64; 3], [f64; 3]) = (numbers.array(1.0), numbers.array(1.0));
        let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        let (a, b, factor) = (Vector3::from(a), Vector3::from(b), numbers.next());
        assert_eq!(a.cross(&b), Vector3::from(cross));
        assert_eq!(a * factor, Vector3::new(a.x * factor, a.y * factor, a.z * factor));
        assert_eq!(a + b, Vector3::new(a.x + b.x, a.y + b.y, a.z + b.z));
    }
}
