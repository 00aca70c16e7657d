//! Violations of MISRA C:2012 that the addon of cppcheck reports.
//!
//! The texts of the rules are not freely available, so only their numbers occur here.

use std::collections::BTreeMap;

/// Rules for which the addon of cppcheck 2.10 contains no check: those without a function in its source.
pub const NOT_DECIDED: [&str; 28] = [
    "1.1", "1.2", "1.3", "2.1", "2.6", "5.3", "8.3", "8.13", "9.1", "12.5", "13.2", "14.3", "17.4", "17.5", "18.1",
    "18.2", "18.3", "18.6", "19.1", "20.6", "21.13", "21.17", "21.18", "22.1", "22.2", "22.3", "22.4", "22.6",
];

/// Rules that emitted code violates, with the reasons.
pub const DEVIATIONS: [(&str, &str); 5] = [
    ("2.4", "advisory; enumerations without a tag: the indices of the joints and of the tips, for the caller"),
    ("2.5", "advisory; macros that the source does not use: the limits of the joints, for the caller"),
    ("8.7", "advisory; momentum_and_rate, which the observer calls, is also for the caller"),
    (
        "19.2",
        "advisory; the sine, the friction and the limits read the bits of a float through a union, which C99 defines, \
         and which needs no library",
    ),
    (
        "20.9",
        "required; the tool does not find FLT_EVAL_METHOD without the system headers; <float.h> defines it, and the \
         source includes this header",
    ),
];

/// Reads the violated rules, each with the places, from the lines that cppcheck prints with `--template={file}:{line}:
/// {id}`.
#[must_use]
pub fn violations(printed: &str) -> BTreeMap<String, Vec<String>> {
    let mut violations = BTreeMap::<String, Vec<String>>::new();
    for line in printed.lines() {
        if let Some((place, rule)) = line.split_once(": misra-c2012-") {
            violations.entry(rule.trim().to_owned()).or_default().push(place.to_owned());
        }
    }
    violations
}

/// Returns the reason why a rule may be violated; `None` if it may not.
#[must_use]
pub fn deviation(rule: &str) -> Option<&'static str> {
    DEVIATIONS.iter().find(|(of, _)| *of == rule).map(|(_, why)| *why)
}

#[cfg(test)]
mod tests {
    use super::{deviation, violations};

    #[test]
    fn rules_are_counted() {
        let printed =
            "a.c:3: misra-c2012-19.2\na.h:8: misra-c2012-2.5\na.c:4: unusedFunction\na.c:9: misra-c2012-19.2\n";
        let found: Vec<_> = violations(printed).into_iter().collect();
        let places = |places: &[&str]| places.iter().map(|&place| place.to_owned()).collect::<Vec<_>>();
        assert_eq!(found, [("19.2".to_owned(), places(&["a.c:3", "a.c:9"])), ("2.5".to_owned(), places(&["a.h:8"]))]);
        assert!(deviation("19.2").is_some() && deviation("17.2").is_none());
    }
}
