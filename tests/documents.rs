//! Documents are true: what stands between `<!-- begin: NAME … -->` and `<!-- end -->` is what the code prints today.
//!
//! With `RNE_WRITE_DOCUMENTS` set, the blocks are written anew. What is measured (`<!-- begin: measured NAME … -->`) stays as it
//! is: `cargo xtask performance` writes it.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use rne_codegen::emit::{self, Listing, listing};
use rne_codegen::plan::{self, Choice, PlanFile};
use rne_codegen::{Capability, Form, Function, Operations, Program, Step, compile};
use rne_model::{JointKind, Robot};

/// The documents with blocks.
const DOCUMENTS: &[&str] = &["README.md", "docs/performance.md"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn robot(path: &Path) -> Robot {
    Robot::from_yaml(&read(path)).unwrap_or_else(|report| panic!("{report}"))
}

fn inverse_dynamics(robot: &Robot) -> Program {
    compile(robot, Function::InverseDynamics, Form::SevenSteps).expect("finite constants")
}

/// The shipped robot files, by name.
fn robot_files() -> Vec<PathBuf> {
    let folder = std::fs::read_dir(root().join("robots")).expect("the folder of robots");
    let mut files: Vec<PathBuf> = folder.map(|entry| entry.expect("an entry").path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    files.retain(|path| !path.to_string_lossy().ends_with(".plan.yaml"));
    files.sort();
    files
}

/// The text of a block of a document.
fn block(name: &str) -> String {
    match name {
        "example" => format!("```rust\n{}```\n", read(&root().join("examples/puma560.rs"))),
        "torque" => format!("```rust\n{}```\n", read(&root().join("examples/firmware/src/bin/torque.rs"))),
        "config" => {
            let config = read(&root().join("examples/firmware/.cargo/config.toml"));
            let lines = config.lines().filter(|line| !line.trim_start().starts_with('#'));
            lines.fold("```toml\n".to_owned(), |text, line| text + line + "\n") + "```\n"
        }
        "code" => {
            let robot = robot(&root().join("robots/puma560.yaml"));
            let program = inverse_dynamics(&robot);
            let steps = Step::ALL.iter().take(5).map(|&step| {
                listing(&robot, &program, Listing { joint: Some(3), step: Some(step), ..Listing::default() })
            });
            let code: Vec<String> = steps.filter(|text| !text.trim().is_empty()).collect();
            let code = code.join("\n");
            let emitted = emit::rust_file(&robot, &[program]);
            assert!(emitted.contains(&code), "the heading of the block says where it is from");
            format!("```rust\n{code}```\n")
        }
        "robots" => robots(),
        "functions" => functions(),
        "operations" => operations(),
        "tricks" => tricks(),
        "embedded" => embedded(),
        name => panic!("no block is called `{name}`"),
    }
}

/// The counts of a form by the plan beside the robot file.
fn planned(path: &Path, robot: &Robot, form: Form) -> Operations {
    let plan = path.with_extension("plan.yaml");
    let plan = PlanFile::read("plan", &read(&plan), robot).unwrap_or_else(|report| panic!("{report}"));
    let program = Choice::from(plan).compile(robot, Function::InverseDynamics, form);
    program.unwrap_or_else(|error| panic!("{}: {error}", robot.name)).operations()
}

fn robots() -> String {
    let mut text = String::from(
        "| robot | joints | seven steps: products | sums | both | reduced | rewritten | angles |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for path in robot_files() {
        let robot = robot(&path);
        let counts = inverse_dynamics(&robot).operations();
        let [reduced, rewritten] = [Form::Reduced, Form::Rewritten].map(|form| planned(&path, &robot, form));
        let joints: String = robot
            .rows()
            .map(|row| match row.kind {
                JointKind::Revolute => 'R',
                JointKind::Prismatic => 'P',
            })
            .collect();
        let title = robot.title.as_deref().unwrap_or(&robot.name);
        let file = &robot.name;
        let _ = writeln!(
            text,
            "| [{title}](robots/{file}.yaml) | {joints} | {} | {} | {} | {} | {} | {} → {} |",
            counts.mul,
            counts.add,
            counts.total(),
            reduced.total(),
            rewritten.total(),
            counts.sincos,
            reduced.sincos
        );
    }
    text
}

/// The PUMA 560 on the Cortex-M4F, by the first table of docs/embedded.md, and the loop that it is compared with there.
fn embedded() -> String {
    let document = read(&root().join("docs/embedded.md"));
    let rows = || document.lines().map(|line| line.split(" | ").collect::<Vec<_>>());
    let mut text = String::from(
        "| PUMA 560 on a Cortex-M4F, `f32` | instructions of a call | bytes of code and constants | bytes of stack |\n\
         |---|---:|---:|---:|\n",
    );
    for form in ["seven_steps", "reduced"] {
        let row = rows().find(|row| row.starts_with(&["| puma560", form])).expect("a row of the table");
        let [instructions, code, constants, stack] =
            [2, 3, 4, 5].map(|column| row[column].parse::<usize>().expect("a number"));
        let bytes = code + constants;
        let _ = writeln!(text, "| derived, `{form}` | {instructions} | {bytes} | {stack} |");
    }
    let row = rows().find(|row| row[0].starts_with("| `rne::Arm`")).expect("the loop");
    let _ = writeln!(text, "| `rne::Arm`, a loop over a table in flash | {} | | |", row[1]);
    text
}

/// What every function of the PUMA 560 costs in both forms.
fn functions() -> String {
    let path = root().join("robots/puma560.yaml");
    let robot = robot(&path);
    let (choice, _) = choice(&path, &robot);
    let mut text = String::from(
        "| derive | method | seven steps: products | sums | reduced: products | sums | divisions | angles |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for capability in Capability::ALL {
        for &function in capability.functions() {
            let count = |form| choice.compile(&robot, function, form).expect("finite constants").operations();
            let [plain, reduced] = [Form::SevenSteps, Form::Reduced].map(count);
            let angles = if plain.sincos == reduced.sincos {
                plain.sincos.to_string()
            } else {
                format!("{} → {}", plain.sincos, reduced.sincos)
            };
            let _ = writeln!(
                text,
                "| `{}` | `{function}` | {} | {} | {} | {} | {} | {angles} |",
                capability.name(),
                plain.mul,
                plain.add,
                reduced.mul,
                reduced.add,
                reduced.div
            );
        }
    }
    text
}

/// The choices of the plan file of a robot, or those that a build makes by itself, and whether there is a plan.
fn choice(file: &Path, robot: &Robot) -> (Choice, bool) {
    let plan = file.with_extension("plan.yaml");
    if !plan.exists() {
        return (Choice::default_of(robot), false);
    }
    let plan = PlanFile::read(&plan.display().to_string(), &read(&plan), robot);
    (Choice::from(plan.unwrap_or_else(|report| panic!("{report}"))), true)
}

/// The operations of every robot, the forms side by side.
fn operations() -> String {
    let cell = |counts: Operations| format!("{} + {} = {}, {}", counts.mul, counts.add, counts.total(), counts.sincos);
    let mut text = String::from(
        "| robot | plan | before folding | seven_steps | reduced | rewritten |\n|---|---|---:|---:|---:|---:|\n",
    );
    for path in robot_files() {
        let robot = robot(&path);
        let (choice, has_plan) = choice(&path, &robot);
        let compiled = |form| choice.compile(&robot, Function::InverseDynamics, form).expect("finite constants");
        let seven_steps = inverse_dynamics(&robot);
        let (products, sums) = seven_steps.before();
        let rewritten = choice.rewritten.is_some().then(|| cell(compiled(Form::Rewritten).operations()));
        let _ = writeln!(
            text,
            "| {} | {} | {products} + {sums} = {} | {} | {} | {} |",
            robot.name,
            if has_plan { "file" } else { "of the build" },
            products + sums,
            cell(seven_steps.operations()),
            cell(compiled(Form::Reduced).operations()),
            rewritten.unwrap_or_default(),
        );
    }
    text
}

/// What the tricks save that the plans of two robots make use of.
fn tricks() -> String {
    let robots = ["puma560", "panda"];
    let savings = robots.map(|name| {
        let path = root().join("robots").join(name).with_extension("yaml");
        let robot = robot(&path);
        plan::savings(&robot, &choice(&path, &robot).0.plan)
    });
    let mut text = format!("| trick | {} | what it is |\n|---|---:|---:|---|\n", robots.join(" | "));
    for trick in plan::Trick::ALL {
        let saved = |robot: usize| savings[robot].iter().find(|(used, _)| *used == trick).map(|(_, saved)| *saved);
        let cell = |saved: Option<isize>| saved.map_or_else(String::new, |saved| saved.to_string());
        if saved(0).is_some() || saved(1).is_some() {
            let _ = writeln!(text, "| {trick} | {} | {} | {} |", cell(saved(0)), cell(saved(1)), trick.formula());
        }
    }
    text
}

/// A document with every block as it should be.
fn renewed(document: &str) -> String {
    let mut text = String::new();
    let mut lines = document.lines();
    while let Some(line) = lines.next() {
        text.push_str(line);
        text.push('\n');
        if let Some(heading) = line.strip_prefix("<!-- begin: ") {
            let name = heading.split([',', ' ']).next().unwrap_or_default();
            let written: Vec<&str> = lines.by_ref().take_while(|line| *line != "<!-- end -->").collect();
            match name {
                "measured" => written.iter().for_each(|line| {
                    text.push_str(line);
                    text.push('\n');
                }),
                name => text.push_str(&block(name)),
            }
            text.push_str("<!-- end -->\n");
        }
    }
    text
}

#[test]
fn documents_say_what_the_code_prints() {
    for name in DOCUMENTS {
        let path = root().join(name);
        let document = read(&path);
        let renewed = renewed(&document);
        if std::env::var_os("RNE_WRITE_DOCUMENTS").is_some() {
            std::fs::write(&path, &renewed).expect("a writable file");
        } else {
            assert_eq!(document, renewed, "{}: RNE_WRITE_DOCUMENTS=1 cargo test --test documents", path.display());
        }
    }
}

#[test]
fn the_robot_file_of_the_readme_is_valid() {
    let document = read(&root().join("README.md"));
    let (_, rest) = document.split_once("```yaml\n").expect("a robot file");
    let (yaml, _) = rest.split_once("```").expect("its end");
    let checked = rne_model::check("README.md", yaml).unwrap_or_else(|report| panic!("{report}"));
    assert!(checked.lints.is_empty(), "{}", checked.lints);
}

/// The plan that docs/reduced-form.md explains is the one that is shipped.
#[test]
fn the_explained_plan_is_the_shipped_one() {
    let page = read(&root().join("docs/reduced-form.md"));
    let (_, explained) = page.split_once("\n    format: 1 ").expect("a plan");
    let (explained, _) = explained.split_once("\n    rewritten:").expect("two forms");
    let explained = format!("format: 1 {explained}\n").replace("\n    ", "\n");
    let robot =
        Robot::from_yaml(&read(&root().join("robots/puma560.yaml"))).unwrap_or_else(|report| panic!("{report}"));
    let plan = |name: &str, text: &str| PlanFile::read(name, text, &robot).unwrap_or_else(|report| panic!("{report}"));
    let shipped = plan("puma560.plan.yaml", &read(&root().join("robots/puma560.plan.yaml")));
    assert_eq!(plan("docs/reduced-form.md", &explained).reduced, shipped.reduced);
}

/// `cargo xtask mutate` finds what it breaks, and the page has a line for each mutant that some test noticed.
#[test]
fn the_page_of_mutations_is_of_the_mutants() {
    let (file, page) = ("xtask/mutants.yaml", read(&root().join("docs/mutations.md")));
    let mutants: Vec<BTreeMap<String, String>> = serde_yaml::from_str(&read(&root().join(file))).expect("mutants");
    for mutant in &mutants {
        let [what, source, old] = ["what", "file", "old"].map(|key| mutant[key].as_str());
        let times = read(&root().join(source)).matches(old).count();
        assert_eq!(times, 1, "{file}: {what}: `{old}` must occur once in {source}");
        let row = page.lines().find_map(|row| row.strip_prefix(&format!("| {what} | ")));
        assert!(row.is_some_and(|tests| tests.starts_with('`')), "docs/mutations.md: cargo xtask mutate '{what}'");
    }
    assert_eq!(page.lines().filter(|row| row.ends_with("` |")).count(), mutants.len());
}
