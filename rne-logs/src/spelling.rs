//! Names in messages: what may have been meant, and lists that do not grow without end.

/// The names that a message lists at most.
const LISTED: usize = 12;

/// " (did you mean NAME?)", where a name is near; else nothing.
pub(crate) fn instead<'a>(word: &str, names: impl Iterator<Item = &'a str>) -> String {
    let nearest = names
        .map(|name| (strsim::damerau_levenshtein(&word.to_lowercase(), &name.to_lowercase()), name))
        .filter(|(distance, name)| {
            let length = word.chars().count().max(name.chars().count());
            // what has no letter of it, as a 1 for a 7, is not near
            *distance <= length.div_ceil(3) && *distance < length
        })
        .min_by_key(|(distance, _)| *distance);
    nearest.map_or(String::new(), |(_, name)| format!(" (did you mean {name}?)"))
}

/// Names, the first dozen of them; a last one more is shown, too.
pub(crate) fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    match names.len().saturating_sub(LISTED) {
        0 | 1 => names.join(", "),
        others => format!("{} and {others} others", names[..LISTED].join(", ")),
    }
}
