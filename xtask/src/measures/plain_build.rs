//! Compares a plain build with one for x86-64-v3, as two programs that run alternately.

use std::fmt::Write;

use anyhow::{Result, bail};
use xshell::cmd;

use crate::machine;

/// How often each of the two programs runs.
const RUNS: usize = 15;

/// The times of a run by name, ns: first with a test of the processor in each call, then inlined.
type Times = Vec<(String, [f64; 2])>;

/// Builds both programs, runs them alternately and returns a table.
pub(crate) fn table() -> Result<String> {
    let shell = machine::shell()?;
    let folder = machine::target_folder("benches/target")?;
    let mut programs = Vec::new();
    for target in ["", "x86-64-v3"] {
        let folder = folder.join(target);
        let options = ["--quiet", "--release", "--no-default-features", "--locked", "--bin", "plain_build"];
        let mut build = cmd!(shell, "cargo build --manifest-path benches/Cargo.toml {options...}");
        build = machine::without_flags(build).env("CARGO_TARGET_DIR", &folder);
        if !target.is_empty() {
            build = build.env("RUSTFLAGS", format!("-C target-cpu={target}"));
        }
        build.quiet().run()?;
        programs.push(folder.join("release/plain_build"));
    }
    let mut runs = [const { Vec::new() }; 2];
    for _ in 0..RUNS {
        for (runs, program) in runs.iter_mut().zip(&programs) {
            runs.push(read(&cmd!(shell, "{program}").quiet().read()?)?);
        }
    }
    Ok(of_runs(&runs))
}

fn read(text: &str) -> Result<Times> {
    let times = text.lines().map(|line| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [name @ .., asking, inlined] = &words[..] else { bail!("`{line}` has no two times") };
        Ok((name.join(" "), [asking.parse()?, inlined.parse()?]))
    });
    times.collect()
}

/// The robot and number type of which the table shows every row.
const SHOWN: &str = "panda f64 ";
/// The table shows a row of any other robot if its ratio differs from 1 by more than this.
const DIFFERENT: f64 = 0.15;

/// Returns a table with a row per robot, number type and kind of call: medians of the times, and the median of the
/// ratios of neighbouring runs. Rows of other robots are left out if both builds are about equally fast.
fn of_runs([plain, v3]: &[Vec<Times>; 2]) -> String {
    let mut table =
        String::from("| robot, scalar, calls | inline | plain | v3 | plain/v3 |\n|---|---:|---:|---:|---:|\n");
    for (line, (name, _)) in plain.first().into_iter().flatten().enumerate() {
        let of = |runs: &[Times], kind: usize| -> Vec<f64> { runs.iter().map(|run| run[line].1[kind]).collect() };
        let (plain, inlined, v3) = (of(plain, 0), of(plain, 1), of(v3, 0));
        let ratio = median(plain.iter().zip(&v3).map(|(plain, v3)| plain / v3).collect());
        if (ratio - 1.0).abs() <= DIFFERENT && !name.starts_with(SHOWN) {
            continue;
        }
        let [inlined, plain, v3] = [inlined, plain, v3].map(median);
        let _ = writeln!(table, "| {name} | {inlined:.1} | {plain:.1} | {v3:.1} | {ratio:.2} |");
    }
    table
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::{of_runs, read};

    #[test]
    fn a_ratio_is_of_runs_in_turn() {
        let runs = |texts: [&str; 3]| texts.map(|text| read(text).expect("times")).to_vec();
        let plain = runs(["a f64 gravity 4.0 5.0", "a f64 gravity 8.0 9.0", "a f64 gravity 6.0 7.0"]);
        let v3 = runs(["a f64 gravity 4.0 4.0", "a f64 gravity 4.0 4.0", "a f64 gravity 5.0 5.0"]);
        let table = of_runs(&[plain, v3]);
        assert_eq!(table.lines().last(), Some("| a f64 gravity | 7.0 | 6.0 | 4.0 | 1.20 |"));
        assert!(read("a f64").is_err());
        let alike = runs(["a f64 gravity 4.0 5.0"; 3]);
        assert_eq!(of_runs(&[alike.clone(), alike]).lines().count(), 2);
    }
}
