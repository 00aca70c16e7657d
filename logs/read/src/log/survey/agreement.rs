//! Compares measured velocities with differences of positions.

/// Compares differences of positions with the integral of measured velocities, by the trapezoidal rule over each
/// interval.
pub(super) struct Agreement {
    joints: usize,
    pub(super) previous: Option<(i64, Vec<f64>)>,
    of_difference: Vec<f64>,
    of_position: Vec<f64>,
}

impl Agreement {
    pub(super) fn new(joints: usize) -> Self {
        Self { joints, previous: None, of_difference: vec![0.0; joints], of_position: vec![0.0; joints] }
    }

    #[expect(clippy::cast_precision_loss, reason = "ns between samples")]
    pub(super) fn push(&mut self, time: i64, numbers: &[f64]) {
        let n = self.joints;
        if n == 0 {
            return;
        }
        if let Some((before, old)) = &self.previous {
            let step = time.saturating_sub(*before) as f64 * 1e-9;
            for joint in 0..n {
                let moved = numbers[joint] - old[joint];
                let said = step * (numbers[n + joint] + old[n + joint]) / 2.0;
                self.of_difference[joint] += (moved - said).powi(2);
                self.of_position[joint] += moved.powi(2);
            }
        }
        let previous = self.previous.get_or_insert_default();
        previous.0 = time;
        previous.1.clear();
        previous.1.extend_from_slice(numbers);
    }

    pub(super) fn end(self) -> Vec<f64> {
        let pairs = self.of_difference.iter().zip(&self.of_position);
        pairs
            .map(|(difference, position)| if *difference == 0.0 { 0.0 } else { (difference / position).sqrt() })
            .collect()
    }
}
