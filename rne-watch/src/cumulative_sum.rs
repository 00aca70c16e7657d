//! A cumulative sum of both signs (E. S. Page, 1954) over numbers of deviation 1.

use crate::threshold::ALLOWANCE;

/// A segment in which a sum was above its threshold, in indices of the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Alarm {
    /// The index at which the sum began to grow: the change is there, or later.
    pub(crate) start: usize,
    /// The index at which the sum reached its threshold.
    pub(crate) raised: usize,
    /// The last one at which the sum was at its threshold.
    pub(crate) end: usize,
}

/// The alarms of numbers, of one sign after the other. A sum stays at its threshold `h`, so that it comes down soon
/// after what raised it is over.
pub(crate) fn alarms(numbers: &[f64], h: f64) -> Vec<Alarm> {
    let mut found: Vec<Alarm> = [1.0, -1.0].into_iter().flat_map(|sign| of_sign(numbers, h, sign)).collect();
    found.sort_unstable_by_key(|alarm| (alarm.start, alarm.end));
    found
}

fn of_sign(numbers: &[f64], h: f64, sign: f64) -> Vec<Alarm> {
    let mut found = Vec::new();
    let (mut sum, mut start, mut open) = (0.0_f64, 0, None);
    for (index, number) in numbers.iter().enumerate() {
        let grown = sum + sign * number - ALLOWANCE;
        if grown <= 0.0 {
            sum = 0.0;
            found.extend(open.take());
            continue;
        }
        if sum == 0.0 {
            start = index;
        }
        sum = grown.min(h);
        if grown >= h {
            let alarm = open.get_or_insert(Alarm { start, raised: index, end: index });
            alarm.end = index;
        }
    }
    found.extend(open);
    found
}

#[cfg(test)]
mod tests {
    use super::{Alarm, alarms};

    #[test]
    fn a_step_is_found_where_it_is() {
        let numbers: Vec<f64> = (0..300).map(|i| if (100..150).contains(&i) { -2.0 } else { 0.0 }).collect();
        assert_eq!(alarms(&numbers, 8.0), [Alarm { start: 100, raised: 105, end: 149 }]);
        assert_eq!(alarms(&numbers[..148], 8.0), [Alarm { start: 100, raised: 105, end: 147 }]);
        assert!(alarms(&numbers[..103], 8.0).is_empty());
    }
}
