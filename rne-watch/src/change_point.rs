//! The sample at which a mean changed.

/// The index from which on numbers have another mean: that with which zero before it and one mean from there on leave
/// the least squares. Behind it are `least` numbers at least; 0 of fewer.
pub(crate) fn change_point(numbers: &[f64], least: usize) -> usize {
    let (mut sum, mut count) = (0.0, 0.0);
    let (mut best, mut found) = (0.0, 0);
    for (index, number) in numbers.iter().enumerate().rev() {
        sum += number;
        count += 1.0;
        // what one mean takes from the sum of the squares
        let taken = sum * sum / count;
        if numbers.len() - index >= least && taken > best {
            (best, found) = (taken, index);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::change_point;

    #[test]
    fn a_step_is_where_it_is() {
        // noise of half the step
        let noise = |i: u32| f64::from(i.wrapping_mul(2_654_435_761) >> 16) / 65_536.0 - 0.5;
        let numbers: Vec<f64> = (0..300).map(|i| noise(i) - if i < 200 { 0.0 } else { 0.6 }).collect();
        assert!(change_point(&numbers, 1).abs_diff(200) <= 3, "{}", change_point(&numbers, 1));
        assert_eq!(change_point(&[0.0, 0.0, 2.0], 1), 2);
        assert_eq!((change_point(&[1.0; 4], 9), change_point(&[], 1)), (0, 0));
    }
}
