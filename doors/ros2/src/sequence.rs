//! Counts messages that DDS lost, from the sequence numbers of their publishers.

use std::collections::HashMap;

/// The identifier of a publisher.
type Publisher = [u8; 16];

/// The largest number of publishers that are remembered. When one more appears, all others are forgotten.
const MOST: usize = 64;

/// The last sequence number of each publisher.
#[derive(Clone, Debug, Default)]
pub struct Sequences(HashMap<Publisher, i64>);

impl Sequences {
    /// Returns how many messages were lost between the last message of a publisher and this one: 0 for the first
    /// message of a publisher.
    pub fn lost(&mut self, publisher: Publisher, number: i64) -> u64 {
        if self.0.len() >= MOST && !self.0.contains_key(&publisher) {
            self.0.clear();
        }
        let last = self.0.insert(publisher, number);
        let missing = last.and_then(|last| number.checked_sub(last)?.checked_sub(1));
        missing.and_then(|missing| u64::try_from(missing).ok()).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_publisher_counts_for_itself() {
        let mut sequences = Sequences::default();
        let lost: Vec<u64> = [(1, 7), (2, 1), (1, 8), (2, 5), (1, 11), (1, 3), (1, i64::MIN), (1, i64::MAX)]
            .map(|(publisher, number)| sequences.lost([publisher; 16], number))
            .to_vec();
        assert_eq!(lost, [0, 0, 0, 3, 2, 0, 0, 0]);
        for publisher in 0..=255 {
            assert_eq!(sequences.lost([publisher; 16], 1000 + i64::from(publisher)) % 1000, lost_of(publisher));
        }
        assert!(sequences.0.len() <= MOST);
    }

    /// Publisher 2 loses the numbers 6 to 1001. Publisher 1 had the largest number before.
    fn lost_of(publisher: u8) -> u64 {
        if publisher == 2 { 996 } else { 0 }
    }
}
