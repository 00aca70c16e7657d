//! Names in messages: suggestions for misspelt names, and lists of limited length.

/// Largest number of names that a message lists.
const LISTED: usize = 12;

/// Returns " (did you mean NAME?)" if a name is similar to `word`, and an empty text otherwise.
pub(crate) fn instead(word: &str, names: impl IntoIterator<Item: AsRef<str>>) -> String {
    let nearest = names
        .into_iter()
        .map(|name| (strsim::damerau_levenshtein(&word.to_lowercase(), &name.as_ref().to_lowercase()), name))
        .filter(|(distance, name)| {
            let length = word.chars().count().max(name.as_ref().chars().count());
            // a name without a common letter, such as 1 and 7, is not similar
            *distance <= length.div_ceil(3) && *distance < length
        })
        .min_by_key(|(distance, _)| *distance);
    nearest.map_or(String::new(), |(_, name)| format!(" (did you mean {}?)", name.as_ref()))
}

/// Lists the first twelve names and the number of the others; thirteen names are all listed.
pub(crate) fn listed(names: impl IntoIterator<Item: AsRef<str>>) -> String {
    let names: Vec<String> = names.into_iter().map(|name| name.as_ref().to_owned()).collect();
    match names.len().saturating_sub(LISTED) {
        0 | 1 => names.join(", "),
        others => format!("{} and {others} others", names[..LISTED].join(", ")),
    }
}
