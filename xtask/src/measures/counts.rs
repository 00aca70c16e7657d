//! Counts of instructions: reads them from the output of the harness and from a baseline, compares them, and prints
//! tables.

use std::collections::BTreeMap;
use std::fmt::Write;

/// The largest growth of a count that is no error, per cent.
const TOLERANCE: u64 = 2;

/// The key of a count: robot, form and function.
pub(crate) type Key = [String; 3];

/// Counts of instructions per call, in the order in which they were measured.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts(Vec<(Key, u64)>);

/// The result of a comparison with a baseline.
pub(crate) struct Comparison {
    /// A table of all counts, and a list of those that are no longer measured.
    pub(crate) text: String,
    /// Whether a count grew by more than the tolerance.
    pub(crate) has_grown: bool,
}

impl Counts {
    /// Reads the output of gungraun: lines `instructions::GROUP::FUNCTION ROBOT_FORM:…`, each followed by
    /// `Instructions: COUNT|…`.
    pub(crate) fn of_harness(log: &str) -> Self {
        let mut counts = Vec::new();
        let mut key = None;
        for line in log.lines() {
            if line.starts_with("instructions::") {
                key = Self::key(line);
            } else if let Some(rest) = line.trim_start().strip_prefix("Instructions:")
                && let Some(number) = rest.split('|').next().and_then(|number| number.trim().parse().ok())
                && let Some(key) = &key
            {
                counts.push((Key::clone(key), number));
            }
        }
        Self(counts)
    }

    fn key(line: &str) -> Option<Key> {
        let mut words = line.split_whitespace();
        let function = words.next()?.split("::").nth(2)?;
        let (robot, form) = words.next()?.split(':').next()?.split_once('_')?;
        Some([robot, form, function].map(str::to_owned))
    }

    /// Reads a baseline: lines `ROBOT FORM FUNCTION COUNT`.
    pub(crate) fn of_baseline(text: &str) -> Self {
        let lines = text.lines().filter(|line| !line.starts_with('#'));
        let count = |line: &str| match line.split_whitespace().collect::<Vec<_>>()[..] {
            [robot, form, function, count] => Some(([robot, form, function].map(str::to_owned), count.parse().ok()?)),
            _ => None,
        };
        Self(lines.filter_map(count).collect())
    }

    /// Returns the counts as lines of a baseline.
    pub(crate) fn baseline(&self) -> String {
        self.0.iter().fold(String::new(), |mut text, (key, count)| {
            let _ = writeln!(text, "{} {count}", key.join(" "));
            text
        })
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Compares the counts with those of a baseline.
    pub(crate) fn beside(&self, baseline: &Self) -> Comparison {
        let mut before: BTreeMap<&Key, u64> = baseline.0.iter().map(|(key, count)| (key, *count)).collect();
        let mut text = row(["robot", "form", "function", "baseline", "now", ""]);
        let mut has_grown = false;
        for (key, now) in &self.0 {
            let old = before.remove(key);
            #[allow(clippy::cast_precision_loss)] // small counts are exact
            let growth = old.map(|old| 100.0 * (*now as f64 / old as f64 - 1.0));
            let is_too_much = old.is_some_and(|old| 100 * now > (100 + TOLERANCE) * old);
            has_grown |= is_too_much;
            let change = match growth {
                None => "new".to_owned(),
                Some(_) if old == Some(*now) => String::new(),
                Some(growth) => format!("{growth:+.1} %{}", if is_too_much { ", too many" } else { "" }),
            };
            let old = old.map_or_else(String::new, |old| old.to_string());
            text.push_str(&row([&key[0], &key[1], &key[2], &old, &now.to_string(), &change]));
        }
        for key in before.keys() {
            let _ = writeln!(text, "no longer counted: {}", key.join(" "));
        }
        Comparison { text, has_grown }
    }

    /// Returns a table in Markdown: one row per robot and form, one column per function.
    pub(crate) fn markdown(&self) -> String {
        let mut rows: Vec<[&str; 2]> = self.0.iter().map(|([robot, form, _], _)| [robot.as_str(), form]).collect();
        let mut seen = Vec::new();
        rows.retain(|row| {
            !seen.contains(row) && {
                seen.push(*row);
                true
            }
        });
        let titles = COLUMNS.map(|(_, title)| title).join(" | ");
        let mut text = format!("| robot | form | {titles} |\n|---|---|{}\n", "---:|".repeat(COLUMNS.len()));
        for [robot, form] in rows {
            let cells = COLUMNS.map(|(function, _)| {
                let found = self.0.iter().find(|(key, _)| key[..] == [robot, form, function]);
                match found {
                    Some((_, count)) => count.to_string(),
                    None => "-".to_owned(),
                }
            });
            let _ = writeln!(text, "| {robot} | {form} | {} |", cells.join(" | "));
        }
        text
    }
}

/// The functions that the harness measures, with the titles of their columns.
const COLUMNS: [(&str, &str); 8] = [
    ("inverse_dynamics", "inverse_dynamics"),
    ("inverse_dynamics_f32", "in f32"),
    ("with_wrench", "with a wrench"),
    ("gravity_torques", "gravity_torques"),
    ("bias_torques", "bias_torques"),
    ("mass_matrix", "mass_matrix"),
    ("forward_dynamics", "forward_dynamics"),
    ("derivatives", "derivatives"),
];

fn row([robot, form, function, before, now, change]: [&str; 6]) -> String {
    format!("{robot:<8} {form:<12} {function:<21} {before:>9} {now:>9}  {change}").trim_end().to_owned() + "\n"
}

#[cfg(test)]
mod tests {
    use super::Counts;

    const LOG: &str = "\
instructions::torques::inverse_dynamics puma560_seven_steps:setup :: inverse_dynamics(Puma560SevenSteps)
  Instructions:                        1313|1300                 (+1.00000%) [+1.01000x]
  L1 Hits:                             1800|1800                 (No change)
instructions::torques::gravity_torques puma560_reduced:setup :: gravity(Puma560Reduced)
  Instructions:                         254|N/A                  (*********)
";

    #[test]
    fn the_output_of_the_harness_is_read_and_written_as_a_baseline() {
        let counts = Counts::of_harness(LOG);
        let text = "puma560 seven_steps inverse_dynamics 1313\npuma560 reduced gravity_torques 254\n";
        assert_eq!(counts.baseline(), text);
        assert_eq!(Counts::of_baseline(&format!("# written by\nrustc 1.95.0 (x), y\n{text}")), counts);
        assert!(Counts::of_harness("error: no such bench\n").is_empty());
    }

    #[test]
    fn growth_by_more_than_two_per_cent_is_too_much() {
        let counts = |number: u32| Counts::of_baseline(&format!("arm reduced inverse_dynamics {number}\n"));
        let compared = |number| counts(number).beside(&counts(100));
        assert!(!compared(102).has_grown);
        assert!(compared(102).text.contains("+2.0 %"));
        assert!(compared(103).has_grown);
        assert!(compared(103).text.contains("+3.0 %, too many"));
        assert!(compared(100).text.ends_with("inverse_dynamics            100       100\n"), "{}", compared(100).text);
        let other = Counts::of_baseline("arm reduced energy 5\n").beside(&counts(100));
        assert!(!other.has_grown);
        assert!(other.text.contains("new\n") && other.text.contains("no longer counted: arm reduced inverse_dynamics"));
    }

    #[test]
    fn a_table_has_a_line_for_each_robot_and_form() {
        let counts = Counts::of_baseline(
            "ur5 reduced inverse_dynamics 673\nur5 seven_steps inverse_dynamics 900\nur5 reduced mass_matrix 40\n",
        );
        let table = counts.markdown();
        assert!(table.contains("| ur5 | reduced | 673 | - | - | - | - | 40 | - | - |"), "{table}");
        assert!(table.contains("| ur5 | seven_steps | 900 | - |"), "{table}");
        assert_eq!(table.lines().count(), 4);
    }
}
