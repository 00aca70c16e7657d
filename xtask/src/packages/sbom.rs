//! A software bill of materials (SBOM) of the command `rne` in the format CycloneDX.

use std::collections::BTreeSet;

use anyhow::{Context, Result};
use clap::Args;
use serde_json::{Value, json};
use xshell::cmd;

use crate::Verdict;
use crate::machine;

/// Prints the crates that the command rne is built of, as JSON in the format CycloneDX 1.5
///
/// The list contains the crates of Cargo.lock that the default features of rne-cli use, with version, licence and
/// package URL. Crates that only tests use are left out.
#[derive(Args)]
#[command(after_help = "\
Examples:
  cargo xtask sbom > rne.cdx.json
  cargo xtask sbom --features full > rne-full.cdx.json")]
pub(crate) struct Sbom {
    /// Features of rne-cli
    #[arg(long, value_name = "F")]
    features: Option<String>,
}

impl Sbom {
    /// The list of a command line with every format of logs.
    pub(crate) fn full() -> Self {
        Self { features: Some("full".into()) }
    }

    pub(crate) fn run(&self) -> Result<Verdict> {
        println!("{}", self.text()?);
        Ok(Verdict::Holds)
    }

    pub(crate) fn text(&self) -> Result<String> {
        let shell = machine::shell()?;
        let features = self.features.iter().flat_map(|features| ["--features", features]);
        let edges = ["--edges", "normal,build", "--prefix", "none", "--format", "{p}", "--locked"];
        let tree = cmd!(shell, "cargo tree --package rne-cli {edges...} {features...}").quiet().read()?;
        // each line of the tree looks like: rne-cli v0.1.0 (/path) (*)
        let used: BTreeSet<(String, String)> = tree
            .lines()
            .filter_map(|line| {
                let mut words = line.split_whitespace();
                Some((words.next()?.to_owned(), words.next()?.trim_start_matches('v').to_owned()))
            })
            .collect();
        let metadata = cmd!(shell, "cargo metadata --format-version 1 --locked --all-features").quiet().read()?;
        let metadata: Value = serde_json::from_str(&metadata)?;
        Ok(serde_json::to_string_pretty(&document(&metadata, &used)?)?)
    }
}

/// Returns the document with those packages of `cargo metadata` that are used, which are given by name and version.
fn document(metadata: &Value, used: &BTreeSet<(String, String)>) -> Result<Value> {
    let packages = metadata["packages"].as_array().context("cargo metadata lists packages")?;
    let component = |package: &Value| {
        let [name, version] = ["name", "version"].map(|key| package[key].as_str().unwrap_or_default().to_owned());
        if !used.contains(&(name.clone(), version.clone())) {
            return None;
        }
        let mut component = json!({
            "type": "library",
            "name": name,
            "version": version,
            "purl": format!("pkg:cargo/{name}@{version}"),
            "bom-ref": format!("{name}@{version}"),
        });
        if let Some(licence) = package["license"].as_str() {
            component["licenses"] = json!([{"expression": licence.replace('/', " OR ")}]);
        }
        Some(component)
    };
    let mut components: Vec<Value> = packages.iter().filter_map(component).collect();
    components.sort_by_key(|component| component["bom-ref"].as_str().unwrap_or_default().to_owned());
    let of = components.iter().find(|component| component["name"] == "rne-cli").context("rne-cli is a package")?;
    let mut of = of.clone();
    of["type"] = json!("application");
    components.retain(|component| component["name"] != "rne-cli");
    Ok(json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {"component": of},
        "components": components,
    }))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::document;

    #[test]
    fn the_document_lists_what_is_used() {
        let metadata = json!({"packages": [
            {"name": "rne-cli", "version": "0.1.0", "license": "MIT OR Apache-2.0"},
            {"name": "serde", "version": "1.0.0", "license": "MIT/Apache-2.0"},
            {"name": "proptest", "version": "1.0.0", "license": "MIT"},
        ]});
        let used = [("rne-cli", "0.1.0"), ("serde", "1.0.0")].map(|(name, version)| (name.into(), version.into()));
        let document = document(&metadata, &used.into()).expect("a document");
        assert_eq!(document["metadata"]["component"]["name"], "rne-cli");
        let components = document["components"].as_array().expect("a list");
        assert_eq!(components.len(), 1);
        assert_eq!(components[0]["purl"], "pkg:cargo/serde@1.0.0");
        assert_eq!(components[0]["licenses"][0]["expression"], "MIT OR Apache-2.0");
    }
}
