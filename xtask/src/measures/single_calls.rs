//! Turns divan's output, a tree of wall times of single calls, into a table.

use std::collections::BTreeMap;
use std::fmt::Write;

/// The kinds of calls in the tree that the table shows.
const KINDS: [&str; 2] = ["independent", "chained"];

/// The implementations that are compared in the tree, with their titles.
const COLUMNS: [(&str, &str); 3] = [("seven_steps", "seven_steps"), ("reduced", "reduced"), ("arm", "`rne::Arm`")];

/// Returns a table with a row per robot, kind of call and number type, and a column per implementation. Each cell has
/// the median and, in brackets, the fastest time, ns.
///
/// The tree has robots, kinds of calls and implementations on three levels. `_f32` at the end of an implementation's
/// name means single precision.
pub(crate) fn table(tree: &str) -> String {
    let mut robots: Vec<&str> = Vec::new();
    let mut cells = BTreeMap::new();
    let mut kind = "";
    for line in tree.lines() {
        let Some(at) = line.find("├─").or_else(|| line.find("╰─")) else { continue };
        let depth = line[..at].chars().count() / 3;
        let fields: Vec<&str> = line[at + "├─".len()..].split('│').collect();
        let mut words = fields[0].split_whitespace();
        let Some(name) = words.next() else { continue };
        match depth {
            0 => robots.push(name),
            1 => kind = name,
            _ => {
                let fastest = words.collect::<Vec<_>>().join(" ");
                let (name, scalar) = name.strip_suffix("_f32").map_or((name, "f64"), |name| (name, "f32"));
                let times = [fields.get(2).copied().unwrap_or_default(), &fastest].map(nanoseconds);
                if let ([Some(median), Some(fastest)], Some(robot)) = (times, robots.last()) {
                    cells.insert((*robot, kind, scalar, name), format!("{median} ({fastest})"));
                }
            }
        }
    }
    let titles = COLUMNS.map(|(_, title)| title).join(" | ");
    let mut text = format!("| robot | calls | scalar | {titles} |\n|---|---|---|{}\n", "---:|".repeat(COLUMNS.len()));
    // divan sorts by name, but in all other tables the PUMA 560 comes first
    for robot in robots.iter().rev() {
        for kind in KINDS {
            for scalar in ["f64", "f32"] {
                let cell = |name| cells.get(&(*robot, kind, scalar, name)).map_or("-", String::as_str);
                let line = COLUMNS.map(|(name, _)| cell(name)).join(" | ");
                let _ = writeln!(text, "| {robot} | {kind} | {scalar} | {line} |");
            }
        }
    }
    text
}

/// Converts a time such as `57.4 ns` or `1.2 µs` to nanoseconds, with one decimal below 100.
fn nanoseconds(text: &str) -> Option<String> {
    let (number, unit) = text.trim().split_once(' ')?;
    let number: f64 = number.parse().ok()?;
    let number = match unit.trim() {
        "ns" => number,
        "µs" => number * 1e3,
        "ms" => number * 1e6,
        _ => return None,
    };
    Some(if number < 100.0 { format!("{number:.1}") } else { format!("{number:.0}") })
}

#[cfg(test)]
mod tests {
    use super::table;

    const TREE: &str = "\
Timer precision: 20 ns
wall_time          fastest       │ slowest       │ median        │ mean          │ samples │ iters
├─ panda                         │               │               │               │         │
│  ╰─ independent                │               │               │               │         │
│     ╰─ reduced   115.2 ns      │ 120.1 ns      │ 115.4 ns      │ 115.9 ns      │ 200     │ 200000
╰─ puma560                       │               │               │               │         │
   ├─ chained                    │               │               │               │         │
   │  ╰─ arm_f32   506.4 ns      │ 1.1 µs        │ 507.2 ns      │ 520 ns        │ 200     │ 200000
   ╰─ independent                │               │               │               │         │
      ├─ arm       1.021 µs      │ 2.1 µs        │ 1.034 µs      │ 1.1 µs        │ 200     │ 200000
      ╰─ reduced   62.21 ns      │ 80.01 ns      │ 62.48 ns      │ 63 ns         │ 200     │ 200000
";

    #[test]
    fn a_tree_becomes_a_table() {
        let table = table(TREE);
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines.len(), 2 + 2 * 2 * 2);
        assert_eq!(lines[2], "| puma560 | independent | f64 | - | 62.5 (62.2) | 1034 (1021) |");
        assert_eq!(lines[5], "| puma560 | chained | f32 | - | - | 507 (506) |");
        assert_eq!(lines[6], "| panda | independent | f64 | - | 115 (115) | - |");
    }
}
