//! Names in messages: what may have been meant, and lists that do not grow without end.

/// The names that a message lists at most.
const LISTED: usize = 12;

/// " (did you mean NAME?)", where a name is near; else nothing.
pub(crate) fn instead(word: &str, names: impl IntoIterator<Item: AsRef<str>>) -> String {
    let nearest = names
        .into_iter()
        .map(|name| (strsim::damerau_levenshtein(&word.to_lowercase(), &name.as_ref().to_lowercase()), name))
        .filter(|(distance, name)| {
            let length = word.chars().count().max(name.as_ref().chars().count());
            // what has no letter of it, as a 1 for a 7, is not near
            *distance <= length.div_ceil(3) && *distance < length
        })
        .min_by_key(|(distance, _)| *distance);
    nearest.map_or(String::new(), |(_, name)| format!(" (did you mean {}?)", name.as_ref()))
}

/// Names, the first dozen of them; a last one more is shown, too.
pub(crate) fn listed(names: impl IntoIterator<Item: AsRef<str>>) -> String {
    let names: Vec<String> = names.into_iter().map(|name| name.as_ref().to_owned()).collect();
    match names.len().saturating_sub(LISTED) {
        0 | 1 => names.join(", "),
        others => format!("{} and {others} others", names[..LISTED].join(", ")),
    }
}
