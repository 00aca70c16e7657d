//! Pages whose text must be that of another file.

use std::collections::BTreeMap;

use rne_codegen::{Compiler, Form, Function};
use rne_model::Robot;
use rne_search::PlanFile;

use crate::{read, robot, root};

#[test]
fn the_readme_is_short() {
    let lines = read(&root().join("README.md")).lines().count();
    assert!(lines <= 180, "README.md has {lines} lines: long tables stand in docs/");
}

#[test]
fn the_robot_file_of_the_readme_is_valid() {
    let document = read(&root().join("README.md"));
    let (_, rest) = document.split_once("```yaml\n").expect("a robot file");
    let (yaml, _) = rest.split_once("```").expect("its end");
    let checked = rne_model::Reader::new("README.md").read(yaml).unwrap_or_else(|report| panic!("{report}"));
    assert!(checked.lints.is_empty(), "{}", checked.lints);
}

/// The plan that docs/teaching/reduced-form.md explains is the one that is shipped.
#[test]
fn the_explained_plan_is_the_shipped_one() {
    let page = read(&root().join("docs/teaching/reduced-form.md"));
    let (_, explained) = page.split_once("\n    format: 3 ").expect("a plan");
    let (explained, _) = explained.split_once("\n    rewritten:").expect("two forms");
    let explained = format!("format: 3 {explained}\n").replace("\n    ", "\n");
    let robot =
        Robot::from_yaml(&read(&root().join("robots/puma560.yaml"))).unwrap_or_else(|report| panic!("{report}"));
    let plan = |name: &str, text: &str| PlanFile::read(name, text, &robot).unwrap_or_else(|report| panic!("{report}"));
    let shipped = plan("puma560.plan.yaml", &read(&root().join("robots/puma560.plan.yaml")));
    assert_eq!(plan("docs/teaching/reduced-form.md", &explained).reduced, shipped.reduced);
}

/// `cargo xtask mutate` finds what it breaks, and the page has a line for each mutant that some test noticed.
#[test]
fn the_page_of_mutations_is_of_the_mutants() {
    let (file, page) = ("xtask/mutants.yaml", read(&root().join("docs/measured/mutations.md")));
    let mutants: Vec<BTreeMap<String, String>> = serde_yaml::from_str(&read(&root().join(file))).expect("mutants");
    for mutant in &mutants {
        let [what, source, old] = ["what", "file", "old"].map(|key| mutant[key].as_str());
        let times = read(&root().join(source)).matches(old).count();
        assert_eq!(times, 1, "{file}: {what}: `{old}` must occur once in {source}");
        let row = page.lines().find_map(|row| row.strip_prefix(&format!("| {what} | ")));
        assert!(
            row.is_some_and(|tests| tests.starts_with('`')),
            "docs/measured/mutations.md: cargo xtask mutate '{what}'"
        );
    }
    assert_eq!(page.lines().filter(|row| row.ends_with("` |") || row.ends_with(" more |")).count(), mutants.len());
}

/// Both tables of `cargo xtask tree-counts --loops` have the counts of the programs.
#[test]
fn the_page_of_closed_loops_counts_the_programs() {
    let page = read(&root().join("docs/control/closed-loops.md"));
    let (_, tables) = page.split_once("<!-- begin: measured loops,").expect("the tables");
    let cells = |row: &str| row.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    for function in [Function::InverseDynamicsOfLoops, Function::LoopMap] {
        let (_, rows) = tables.split_once(&format!("| `{function}` |")).expect("a table");
        let rows: Vec<_> = rows.lines().take_while(|row| row.contains('|')).map(cells).collect();
        // the first line lacks its first cell here
        let column = 1 + rows[0].iter().position(|title| title == "rne").expect("a column");
        assert_eq!(rows.len(), 5);
        for row in &rows[2..] {
            let file = if row[0] == "four_bar" {
                "docs/four_bar.yaml"
            } else {
                &format!("benches/trees/loops/{}.yaml", row[0])
            };
            let program =
                Compiler::new(&robot(&root().join(file))).compile(function, Form::Reduced).expect("a program");
            let found = program.operations();
            assert_eq!(
                row[column],
                (found.mul + found.add).to_string(),
                "{file}, {function}: cargo xtask tree-counts --loops"
            );
        }
    }
}
