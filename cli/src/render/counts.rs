//! Writes counts and lists in words: `5 of 6 joints`, `18 inertias of links 2 to 6`.

use rne_identify::Parameter;

/// How many of a number of things are meant.
#[derive(Clone, Copy)]
pub(super) enum Counted {
    No,
    Some(usize, usize),
    All(usize),
}

pub(super) fn counted(count: usize, all: usize) -> Counted {
    match count {
        0 => Counted::No,
        count if count == all => Counted::All(all),
        count => Counted::Some(count, all),
    }
}

impl Counted {
    /// Returns the count with its noun: `no joint`, `5 of 6 joints`, `all 6 joints`.
    pub(super) fn of(self, noun: &str) -> String {
        match self {
            Self::No => format!("no {noun}"),
            Self::Some(count, all) => format!("{count} of {all} {noun}s"),
            Self::All(1) => format!("the {noun}"),
            Self::All(all) => format!("all {all} {noun}s"),
        }
    }
}

/// The kinds of link parameters, each with the places of its parameters; rotors come after these.
const KINDS: [(&str, std::ops::Range<usize>); 3] = [("mass", 0..1), ("moment of mass", 1..4), ("inertia", 4..10)];

/// Lists parameters by kind: `18 inertias of links 2 to 6`.
pub(super) fn groups(parameters: &[Parameter]) -> Vec<String> {
    let mut said = Vec::new();
    for (kind, range) in KINDS {
        let link = |parameter: &Parameter| match parameter {
            Parameter::Link(link, index) if range.contains(index) => Some(*link),
            _ => None,
        };
        said.extend(group(kind, "link", &parameters.iter().filter_map(link).collect::<Vec<_>>()));
    }
    let rotor = |parameter: &Parameter| if let Parameter::Rotor(joint) = parameter { Some(*joint) } else { None };
    said.extend(group("rotor inertia", "joint", &parameters.iter().filter_map(rotor).collect::<Vec<_>>()));
    said
}

fn group(kind: &str, place: &str, of: &[usize]) -> Option<String> {
    let plural = match (of.len(), kind) {
        (0, _) => return None,
        (1, kind) => kind.to_owned(),
        (_, "mass") => "masses".to_owned(),
        (_, "moment of mass") => "moments of mass".to_owned(),
        (_, kind) => format!("{kind}s"),
    };
    Some(format!("{} {plural} of {}", of.len(), listed(place, of)))
}

/// Lists links or joints by their numbers, counted from 1: `link 2`, `links 2 and 4`, `links 2 to 6 and 8`.
pub(super) fn listed(noun: &str, places: &[usize]) -> String {
    let mut numbers: Vec<usize> = places.iter().map(|place| place + 1).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let plural = if numbers.len() == 1 { "" } else { "s" };
    let words: Vec<String> = numbers
        .chunk_by(|one, next| one + 1 == *next)
        .flat_map(|run| match run {
            [first, _, .., last] => vec![format!("{first} to {last}")],
            few => few.iter().map(usize::to_string).collect(),
        })
        .collect();
    format!("{noun}{plural} {}", enumerated(&words))
}

/// Joins words in the form `a, b and c`.
pub(super) fn enumerated(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [before @ .., last] => format!("{} and {last}", before.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_listed_as_a_reader_would() {
        assert_eq!(listed("link", &[1]), "link 2");
        assert_eq!(listed("link", &[3, 1, 1]), "links 2 and 4");
        assert_eq!(listed("link", &[1, 2, 3]), "links 2 to 4");
        assert_eq!(listed("joint", &[0, 1, 3]), "joints 1, 2 and 4");
        assert_eq!(listed("link", &[0, 1, 2, 4, 5, 6]), "links 1 to 3 and 5 to 7");
        let parameters = [Parameter::Link(1, 4), Parameter::Link(2, 9), Parameter::Link(0, 1), Parameter::Rotor(0)];
        let said = ["1 moment of mass of link 1", "2 inertias of links 2 and 3", "1 rotor inertia of joint 1"];
        assert_eq!(groups(&parameters), said);
    }
}
