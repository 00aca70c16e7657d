//! "Did you mean …?"

/// Nothing longer is a slip of one of our words, and the distance costs time.
pub(crate) const LONGEST_WORD: usize = 32;

/// The candidate that `word` was probably meant to be.
pub(crate) fn did_you_mean<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    if word.is_empty() || word.chars().count() > LONGEST_WORD {
        return None;
    }
    let word = word.to_lowercase().replace('-', "_");
    candidates
        .into_iter()
        .filter_map(|candidate| {
            let distance = distance(&word, &candidate.to_lowercase());
            let shorter = word.chars().count().min(candidate.chars().count());
            let close = distance == 0 || (distance <= shorter.div_ceil(3).min(2) && distance < shorter);
            close.then_some((distance, candidate))
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// Levenshtein's distance: insertions, deletions and substitutions.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = i;
        let mut left = i + 1;
        for (cell, to) in row.iter_mut().skip(1).zip(&b) {
            let substitution = diagonal + usize::from(from != *to);
            diagonal = *cell;
            left = substitution.min(*cell + 1).min(left + 1);
            *cell = left;
        }
        if let Some(first) = row.first_mut() {
            *first = i + 1;
        }
    }
    row.last().copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances() {
        assert_eq!(distance("mass", "mass"), 0);
        assert_eq!(distance("masss", "mass"), 1);
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("", "abc"), 3);
    }

    #[test]
    fn near_words_are_found_and_far_ones_are_not() {
        let keys = ["theta", "d", "a", "alpha"];
        assert_eq!(did_you_mean("thta", keys), Some("theta"));
        assert_eq!(did_you_mean("Alpha", keys), Some("alpha"));
        assert_eq!(did_you_mean("b", keys), None);
        assert_eq!(did_you_mean("inertia-about", ["inertia_about"]), Some("inertia_about"));
        assert_eq!(did_you_mean("offset", keys), None);
    }
}
