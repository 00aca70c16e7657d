//! Which modules of this crate use which: the checker shares no pass with what it checks (it reads the robot by the
//! seven steps alone), and no two modules use each other.

use std::collections::{BTreeMap, BTreeSet};

use syn::visit::Visit;
use syn::{ItemUse, UseTree};

/// Passes and choices: what makes the programs that are checked.
const CHECKED: [&str; 8] = ["reduced", "plan", "lower", "fma", "latency", "registers", "pipeline", "formulation"];

/// What the checker needs of the representation: to write the seven steps, and to take residues.
const OF_THE_REPRESENTATION: [&str; 12] = [
    "Axis",
    "Name",
    "Quantity",
    "operators",
    "Builder",
    "Graph",
    "Residue",
    "Input",
    "Op",
    "SamplePoint",
    "Policy",
    "Exactly",
];

#[derive(Default)]
struct Paths(Vec<Vec<String>>);

impl<'a> Visit<'a> for Paths {
    fn visit_item_use(&mut self, item: &'a ItemUse) {
        fn walk(tree: &UseTree, path: &[String], found: &mut Vec<Vec<String>>) {
            let with = |name: &syn::Ident| path.iter().cloned().chain([name.to_string()]).collect::<Vec<_>>();
            match tree {
                UseTree::Path(step) => walk(&step.tree, &with(&step.ident), found),
                UseTree::Name(name) => found.push(with(&name.ident)),
                UseTree::Rename(name) => found.push(with(&name.ident)),
                UseTree::Glob(_) => found.push(path.iter().cloned().chain(["*".to_owned()]).collect()),
                UseTree::Group(group) => group.items.iter().for_each(|tree| walk(tree, path, found)),
            }
        }
        walk(&item.tree, &[], &mut self.0);
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        if names.first().is_some_and(|first| first == "crate" || first == "super") {
            self.0.push(names);
        }
        syn::visit::visit_path(self, path);
    }
}

fn paths(file: &str) -> Vec<Vec<String>> {
    let path = format!("{}/src/{file}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let mut found = Paths::default();
    found.visit_file(&syn::parse_file(&text).expect("a file of this crate"));
    found.0
}

#[test]
fn the_checker_imports_no_pass() {
    let found = [paths("proof.rs"), paths("rounding.rs"), paths("exact.rs")].concat();
    for module in CHECKED {
        let is_there = |file: &str| std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(file).exists();
        assert!(is_there(&format!("{module}.rs")) || is_there(&format!("{module}/mod.rs")), "there is no {module}");
    }
    assert!(found.iter().any(|path| path.join("::") == "crate::formulate"), "the visitor reads imports");
    for path in found.iter().filter(|path| path[0] == "crate" && path.len() > 1) {
        let module = path[1].as_str();
        assert!(!CHECKED.contains(&module), "prove uses {}", path.join("::"));
        if module == "ir" {
            let of = path[2].as_str();
            let known = OF_THE_REPRESENTATION.contains(&of) || ["Embedding", "Ref", "composed"].contains(&of);
            assert!(known, "prove uses {}: is it a pass?", path.join("::"));
        }
    }
}

/// Nor do the formulas that it compares with, from which the seven steps are compiled.
#[test]
fn the_formulas_import_no_pass() {
    let files = files("formulate");
    for name in &files {
        for path in paths(name).iter().filter(|path| path[0] == "crate" && path.len() > 1) {
            assert!(!CHECKED.contains(&path[1].as_str()), "{name} uses {}", path.join("::"));
        }
    }
    assert!(files.len() > 5, "{files:?}");
}

/// The files in a folder of the sources, with their paths from there.
fn files(folder: &str) -> Vec<String> {
    let mut folders = vec![folder.to_owned()];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        let path = format!("{}/src/{folder}", env!("CARGO_MANIFEST_DIR"));
        for entry in std::fs::read_dir(path).expect("the formulas") {
            let entry = entry.expect("an entry");
            let name = format!("{folder}/{}", entry.file_name().to_str().expect("a name"));
            if entry.path().is_dir() { &mut folders } else { &mut files }.push(name);
        }
    }
    files
}

/// The modules of the crate stand in an order in which each uses only those before it. Tests may use any module.
#[test]
fn no_modules_use_each_other_in_a_circle() {
    let module = |name: &str| name.trim_start_matches("./").split(['/', '.']).next().unwrap_or_default().to_owned();
    let files = files(".").into_iter().filter(|name| !name.contains("tests") && !name.ends_with("/lib.rs"));
    let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for name in files {
        let used = paths(&name).into_iter().filter(|path| path[0] == "crate" && path.len() > 1);
        uses.entry(module(&name)).or_default().extend(used.map(|path| path[1].clone()));
    }
    assert!(uses["program"].contains("values") && uses["ir"].contains("quantity"), "{uses:?}");
    let modules: BTreeSet<String> = uses.keys().cloned().collect();
    for (module, used) in &mut uses {
        used.retain(|used| used != module && modules.contains(used));
    }
    let mut below = BTreeSet::new();
    while let Some(next) = uses.iter().find(|(_, used)| used.is_subset(&below)).map(|(module, _)| module.clone()) {
        uses.remove(&next);
        below.insert(next);
    }
    assert!(uses.is_empty(), "these modules use each other: {uses:#?}");
}
