//! Checks that the library builds with every set of its features.

use anyhow::{Context, Result};
use clap::Args;
use serde::Deserialize;
use std::collections::BTreeMap;
use xshell::cmd;

use crate::Verdict;
use crate::machine;

/// Builds the facade with no feature, each one, and all of them, every warning an error
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when a set does not build.

Example:
  cargo xtask features --pairs")]
pub(crate) struct Features {
    /// Build it with each pair of features, too
    #[arg(long)]
    pairs: bool,
}

/// A feature that needs a nightly compiler, so it is not tested.
const UNSTABLE: &str = "core_float_math";

/// The part of `cargo metadata` that is used.
#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    features: BTreeMap<String, Vec<String>>,
}

impl Features {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let metadata = cmd!(shell, "cargo metadata --no-deps --format-version 1").quiet().read()?;
        // every JSON document is a YAML document
        let Metadata { packages } = serde_yaml::from_str(&metadata)?;
        let facade = packages.into_iter().find(|package| package.name == "rne").context("the facade")?;
        let names: Vec<String> =
            facade.features.into_keys().filter(|name| name != "default" && name != UNSTABLE).collect();
        let mut failed = Vec::new();
        let sets = sets(&names, self.pairs);
        for set in &sets {
            let check = cmd!(shell, "cargo check --quiet --package rne --no-default-features --features {set}");
            // flags that turn warnings into errors would rebuild all dependencies, so the output is searched for
            // warnings instead
            let output = machine::without_flags(check).quiet().ignore_status().output()?;
            if !output.status.success() || !output.stderr.is_empty() {
                eprint!("{}", String::from_utf8_lossy(&output.stderr));
                failed.push(set.clone());
            }
        }
        println!("features: {} sets of {} build", sets.len() - failed.len(), names.join(", "));
        for set in &failed {
            println!("features: `{set}` does not");
        }
        Ok(Verdict::from(failed.is_empty()))
    }
}

/// Returns the sets of features: none, each alone, all, and with `pairs` each pair, because some errors need two
/// features.
fn sets(names: &[String], pairs: bool) -> Vec<String> {
    let mut sets = vec![String::new(), names.join(",")];
    for (index, name) in names.iter().enumerate() {
        sets.push(name.clone());
        let others = if pairs { &names[index + 1..] } else { &[] };
        sets.extend(others.iter().map(|other| format!("{name},{other}")));
    }
    sets
}

#[cfg(test)]
mod tests {
    use super::sets;

    #[test]
    fn every_pair_is_a_set_where_it_is_asked_for() {
        let names = ["a", "b", "c"].map(str::to_owned);
        assert_eq!(sets(&names, true), ["", "a,b,c", "a", "a,b", "a,c", "b", "b,c", "c"]);
        assert_eq!(sets(&names, false), ["", "a,b,c", "a", "b", "c"]);
    }
}
