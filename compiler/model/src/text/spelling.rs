//! Finds the word for the help "did you mean …?"

use std::iter;

/// Longest word that is compared, because no known word is longer and comparing takes time.
pub(crate) const LONGEST_WORD: usize = 32;

/// Largest number of slips by which two words may differ and still be taken for the same word.
const MOST: usize = 2;

/// Returns the candidate that `word` was probably meant to be, if it is one or two slips away: a missing, surplus or
/// wrong letter, or two neighbours that changed places.
pub fn did_you_mean<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    if word.is_empty() || word.chars().count() > LONGEST_WORD {
        return None;
    }
    let word = word.to_lowercase().replace('-', "_");
    let length = word.chars().count();
    candidates
        .into_iter()
        // words whose lengths differ by three or more are more than two slips apart
        .filter(|candidate| candidate.chars().count().abs_diff(length) <= MOST)
        .filter_map(|candidate| {
            let distance = strsim::osa_distance(&word, &candidate.to_lowercase());
            let shorter = length.min(candidate.chars().count());
            let close = distance == 0 || (distance <= shorter.div_ceil(3).min(MOST) && distance < shorter);
            close.then_some((distance, candidate))
        })
        // among equal distances, a word with the same letters in another order is likelier, and one with the same first
        // letter
        .min_by_key(|(distance, candidate)| {
            (*distance, letters(candidate) != letters(&word), first(candidate) != first(&word))
        })
        .map(|(_, candidate)| candidate)
}

fn first(word: &str) -> Option<char> {
    word.chars().next().map(|letter| letter.to_ascii_lowercase())
}

fn letters(word: &str) -> Vec<char> {
    let mut letters: Vec<char> = word.to_lowercase().chars().collect();
    letters.sort_unstable();
    letters
}

/// Returns the known name that another name probably means: one that is a slip away, begins with the other name, or
/// fits it without the maker's name, as `iiwa14` fits `kuka_iiwa`.
#[must_use]
pub fn nearest_name<'n>(name: &str, names: &[&'n str]) -> Option<&'n str> {
    let parts = name.match_indices(['_', '-', ' ']).map(|(at, _)| name.get(at + 1..).unwrap_or_default());
    iter::once(name).chain(parts).filter(|part| !part.is_empty()).find_map(|part| {
        let longer = || names.iter().copied().find(|known| known.starts_with(part));
        did_you_mean(part, names.iter().copied()).or_else(longer)
    })
}

/// Returns the message for a name that no shipped robot has.
#[must_use]
pub fn no_shipped_robot(name: &str, names: &[&str]) -> String {
    let meant = nearest_name(name, names).map_or_else(|| ";".to_owned(), |meant| format!("; did you mean `{meant}`?"));
    format!("there is no shipped robot `{name}`{meant} the shipped robots are {}", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_words_are_found_and_far_ones_are_not() {
        let keys = ["theta", "d", "a", "alpha"];
        assert_eq!(did_you_mean("thta", keys), Some("theta"));
        assert_eq!(did_you_mean("Alpha", keys), Some("alpha"));
        assert_eq!(did_you_mean("b", keys), None);
        assert_eq!(did_you_mean("inertia-about", ["inertia_about"]), Some("inertia_about"));
        assert_eq!(did_you_mean("offset", keys), None);
        assert_eq!(did_you_mean("xzy", ["xyz", "rpy"]), Some("xyz"));
        // an element of a symmetric tensor has two names, such as `yx` for `xy`
        let elements = ["xx", "yy", "zz", "xy", "xz", "yz", "ixx", "iyy", "izz", "ixy", "ixz", "iyz"];
        for (other, element) in
            [("yx", "xy"), ("zx", "xz"), ("zy", "yz"), ("iyx", "ixy"), ("izx", "ixz"), ("izy", "iyz")]
        {
            assert_eq!(did_you_mean(other, elements), Some(element));
        }
        assert_eq!(did_you_mean("w2_zz", ["i2_zz", "w2_z"]), Some("w2_z"));
    }
}
