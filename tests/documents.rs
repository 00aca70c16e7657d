//! Documents are true: what stands between `<!-- begin: NAME … -->` and `<!-- end -->` is what the code prints today.
//!
//! With `RNE_WRITE_DOCUMENTS` set, the blocks are written anew. What is measured (`<!-- begin: measured NAME … -->`)
//! stays as it is: `cargo xtask performance` writes it. What a command prints (`<!-- begin: output … -->`) is for
//! `rne-cli/tests/cli/documents.rs`, which runs it. In the stubs of Python the markers are comments. And what the
//! documents lead to is there: links, files, tests.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};

use rne_codegen::plan::{PlanSet, Trick};
use rne_codegen::{Argument, Capability, Compiler, Form, Function, Operations, Program, Returned, Step};
use rne_emit::{Selection, listing};
use rne_model::{JointKind, Robot};
use rne_search::PlanFile;

/// The documents with blocks, and which blocks these are; what is measured or printed by a command does not count.
const DOCUMENTS: &[(&str, &[&str])] = &[
    ("docs/c-library.md", &["controller"]),
    ("doors/python/package/rne/__init__.pyi", &["stubs"]),
    ("README.md", &["headline", "example", "control", "twelve_lines"]),
    ("docs/firmware.md", &["torque", "config", "embedded"]),
    ("docs/functions.md", &["functions"]),
    ("docs/performance.md", &["operations", "tricks"]),
    ("docs/ros2.md", &["ros2_controller"]),
    ("docs/robot-file.md", &["frames", "tree", "two_bars", "desk_arm", "every_key"]),
    ("docs/teaching.md", &["code"]),
    ("robots/README.md", &["sources", "robots"]),
];

/// The documents that say where things stand: what they name must exist.
const GUIDES: &[&str] = &["ARCHITECTURE.md", "CONTRIBUTING.md"];

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
    Compiler::new(robot).compile(Function::InverseDynamics, Form::SevenSteps).expect("finite constants")
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
        "control" => control(),
        "ros2_controller" => {
            format!("```cpp\n{}```\n", read(&root().join("doors/capi/examples/ros2_control/gravity_controller.cpp")))
        }
        "controller" => format!("```c\n{}```\n", read(&root().join("doors/capi/examples/controller.c"))),
        "torque" => format!("```rust\n{}```\n", read(&root().join("rne-cli/src/commands/firmware/main.rs"))),
        "config" => {
            let config = read(&root().join("rne-cli/src/commands/firmware/config.toml"));
            let lines = config.lines().filter(|line| !line.trim_start().starts_with('#'));
            lines.fold("```toml\n".to_owned(), |text, line| text + line + "\n") + "```\n"
        }
        "desk_arm" => format!("```yaml\n{}```\n", read(&root().join("docs/desk_arm.yaml"))),
        "frames" => {
            let file = read(&root().join("docs/desk_arm_frames.yaml"));
            let list = file.lines().skip_while(|line| !line.starts_with("frames:"));
            let list: Vec<&str> = list.take_while(|line| !line.starts_with("joints:")).collect();
            format!("```yaml\n{}\n```\n", list.join("\n"))
        }
        "two_bars" => format!("```yaml\n{}```\n", read(&root().join("docs/two_bars.yaml"))),
        "tree" => format!("```yaml\n{}```\n", read(&root().join("docs/tree.yaml"))),
        "every_key" => format!("```yaml\n{}```\n", read(&root().join("docs/every-key.yaml"))),
        "headline" => headline(),
        "twelve_lines" => code(2),
        "code" => code(5),
        "sources" => sources(),
        "robots" => robots(),
        "functions" => functions(),
        "stubs" => stubs(),
        "operations" => operations(),
        "tricks" => tricks(),
        "embedded" => embedded(),
        name => panic!("no block is called `{name}`"),
    }
}

/// The derive and the calls of an example, with the robot file of the commands above them.
fn control() -> String {
    let program = read(&root().join("examples/control.rs"));
    let between = |start: &str, end: &str| {
        let lines = program.lines().skip_while(|line| !line.contains(start)).take_while(|line| !line.contains(end));
        let lines = lines.map(str::trim).filter(|line| !line.is_empty());
        lines.fold(String::new(), |text, line| text + line + "\n")
    };
    let derive = between("#[derive", "fn main").replace("../robots/puma560.yaml", "arm.yaml");
    let calls = between("let gravity", "println!");
    assert!(derive.contains("path = \"arm.yaml\"") && calls.lines().count() == 3, "{derive}{calls}");
    format!("```rust\n{derive}{calls}```\n")
}

/// What is emitted for the first steps of joint 3 of the PUMA 560.
fn code(steps: usize) -> String {
    let robot = robot(&root().join("robots/puma560.yaml"));
    let program = inverse_dynamics(&robot);
    let what = |&step| Selection { joint: Some(3), step: Some(step), ..Selection::default() };
    let steps = Step::ALL[..steps].iter().map(|step| listing(&robot, &program, what(step)));
    let code: Vec<String> = steps.filter(|listing| !listing.is_empty()).map(|listing| listing.to_string()).collect();
    let code = code.join("\n");
    let emitted = rne_emit::rust_file(&robot, &[program]);
    assert!(emitted.contains(&code), "the heading of the block says where it is from");
    format!("```rust\n{code}```\n")
}

/// The rows of the table below a heading, by the names in their first column: name, then column, then cell.
fn table(document: &str, heading: &str) -> Vec<(String, BTreeMap<String, String>)> {
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('|').split('|').map(|cell| cell.trim().replace("**", "")).collect()
    };
    let (_, below) = document.split_once(&format!("\n{heading}")).unwrap_or_else(|| panic!("{heading}"));
    let mut lines = below.lines().skip_while(|line| !line.starts_with('|')).take_while(|line| line.starts_with('|'));
    let titles = cells(lines.next().expect("a table"));
    let rows = lines.skip(1).map(cells);
    rows.map(|row| (row[0].clone(), titles.iter().cloned().zip(row).skip(1).collect())).collect()
}

/// What a call of two arms costs beside what it costs the best peer, by the tables that `benches/peers/run` and the
/// certificate have written.
fn headline() -> String {
    /// Rows of the table of times that are other functions, or parts of one.
    const OTHER_FUNCTIONS: &[&str] = &["pin_nle", "pin_gravity", "pin_crba", "pin_aba", "pin_rnea_deriv"];
    let peers = read(&root().join("benches/peers/README.md"));
    let (operations, times) = (table(&peers, "### Operations"), table(&peers, "### Independent calls"));
    let number = |cell: &str| -> f64 {
        let first = cell.rsplit("= ").next().and_then(|text| text.split([' ', ',']).next()).unwrap_or_default();
        first.parse().unwrap_or_else(|error| panic!("`{cell}`: {error}"))
    };
    let robots = ["puma560", "panda"];
    let cell = |rows: &[(String, BTreeMap<String, String>)], name: &str, robot: &str| {
        let (_, row) = rows.iter().find(|(other, _)| other == name).unwrap_or_else(|| panic!("no row {name}"));
        number(&row[robot])
    };
    let of = |rows: &[(String, BTreeMap<String, String>)], name: &str| {
        robots.map(|robot| cell(rows, name, robot).to_string()).join(" | ")
    };
    let best = |rows: &[(String, BTreeMap<String, String>)]| {
        let is_peer =
            |name: &str| !name.starts_with("rne") && !name.starts_with("trig_only") && !OTHER_FUNCTIONS.contains(&name);
        robots.map(|robot| {
            let peers = rows.iter().filter(|(name, row)| is_peer(name) && !row[robot].is_empty());
            let (name, row) = peers
                .min_by(|(_, a), (_, b)| number(&a[robot]).total_cmp(&number(&b[robot])))
                .expect("there are peers");
            format!("{} (`{name}`)", number(&row[robot]))
        })
    };
    let certificate = read(&root().join("docs/embedded.md"));
    let (_, m4f) = certificate.split_once("\n## Cortex-M4F\n").expect("the first board");
    let instructions = |form: &str| {
        let find = |robot| {
            let row = m4f.lines().find_map(|line| line.strip_prefix(&format!("| {robot} | {form} | ")));
            row.and_then(|row| row.split(" | ").next()).unwrap_or_else(|| panic!("no row of {robot}, {form}"))
        };
        robots.map(find).join(" | ")
    };
    format!(
        "| one call, form `reduced` | PUMA 560 | Franka Panda |\n|---|---:|---:|\n\
         | operations | {} |\n\
         | operations, best peer | {} |\n\
         | time in ns, native build | {} |\n\
         | time in ns, default build | {} |\n\
         | time in ns, best peer, native build | {} |\n\
         | time in ns, Pinocchio | {} |\n\
         | instructions on a Cortex-M4F, `f32` | {} |\n",
        of(&operations, "rne, reduced"),
        best(&operations).join(" | "),
        of(&times, "rne_reduced_native"),
        of(&times, "rne_reduced_default"),
        best(&times).join(" | "),
        of(&times, "pin_rnea"),
        instructions("reduced"),
    )
}

/// The counts of the reduced form.
fn reduced(robot: &Robot, plans: &PlanSet) -> Operations {
    let program = Compiler::new(robot).with_plans(plans).compile(Function::InverseDynamics, Form::Reduced);
    program.unwrap_or_else(|error| panic!("{}: {error}", robot.name)).operations()
}

/// R or P for each joint, base to tip.
fn kinds(robot: &Robot) -> String {
    let letter = |kind| match kind {
        JointKind::Revolute => 'R',
        JointKind::Prismatic => 'P',
    };
    robot.rows().map(|row| letter(row.kind)).collect()
}

/// Where the numbers of every robot are from, and what is doubtful: the last sentence of `source`, and the first one
/// after "Doubtful:" in the comment at the head of the file.
fn sources() -> String {
    let mut text =
        String::from("| file | arm | joints | convention | source quality | doubtful |\n|---|---|---|---|---|---|\n");
    for path in robot_files() {
        let (robot, file) = (robot(&path), read(&path));
        let source = robot.source.split_whitespace().collect::<Vec<_>>().join(" ");
        let quality = source.rsplit_once("Source quality: ").map(|(_, quality)| quality.trim_end_matches('.'));
        let quality = quality.unwrap_or_else(|| panic!("{}: `source` ends with `Source quality: …`", path.display()));
        let head = file.lines().map_while(|line| line.strip_prefix('#')).flat_map(str::split_whitespace);
        let head = head.collect::<Vec<_>>().join(" ") + " ";
        let doubtful =
            head.split_once("Doubtful: ").and_then(|(_, rest)| rest.split_once(". ")).map(|(first, _)| first);
        let (name, title) = (&robot.name, robot.title.as_deref().unwrap_or(&robot.name));
        let _ = writeln!(
            text,
            "| [{name}]({name}.yaml) | {title} | {} | {} | {quality} | {} |",
            kinds(&robot),
            robot.convention.name(),
            doubtful.unwrap_or_default()
        );
    }
    text
}

fn robots() -> String {
    let mut text = String::from(
        "| robot | joints | seven steps: products | sums | both | planned | reduced | angles |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for path in robot_files() {
        let robot = robot(&path);
        let counts = inverse_dynamics(&robot).operations();
        let (plans, _) = plans(&path, &robot);
        let (planned, reduced) =
            (reduced(&robot, &rne_search::without(&robot, &plans, &[Trick::Rewriting])), reduced(&robot, &plans));
        let joints = kinds(&robot);
        let title = robot.title.as_deref().unwrap_or(&robot.name);
        let file = &robot.name;
        let _ = writeln!(
            text,
            "| [{title}]({file}.yaml) | {joints} | {} | {} | {} | {} | {} | {} → {} |",
            counts.mul,
            counts.add,
            counts.total(),
            planned.total(),
            reduced.total(),
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

/// The methods of Python's class `Arm` that are functions of the compiler.
fn stubs() -> String {
    const BASE: &str = "base_omega: ArrayLike | None = ..., base_omega_dot: ArrayLike | None = ...,
        base_acceleration: ArrayLike | None = ..., base_gravity: ArrayLike | None = ...,
        ";
    let mut text = String::new();
    let mut stub = |function: Function, arguments: &[(&str, Argument)], returned: Returned, summary: &str| {
        let frame = if function.of_frame().is_some() { "frame: str | None = ..., " } else { "" };
        let payload = if function.with_payload().is_some() { "payload: ArrayLike | None = ..., " } else { "" };
        let joints = arguments.iter().filter(|(_, kind)| *kind != Argument::Base);
        let joints: Vec<String> = joints.map(|(name, _)| format!("{name}: ArrayLike, ")).collect();
        let joints = joints.concat();
        let base = if arguments.iter().any(|(_, kind)| *kind == Argument::Base) { BASE } else { "" };
        let returned = match returned {
            Returned::Number => "Floats | float",
            Returned::TorqueDerivatives | Returned::MomentumAndRate => "tuple[Floats, Floats]",
            _ => "Floats",
        };
        // a pose of the tip has the name that it has at a frame, too
        let other = function.of_frame().filter(|_| function == Function::ForwardKinematics);
        for name in [Some(function.name()), other].into_iter().flatten() {
            let _ = writeln!(
                text,
                "    def {name}(\n        self, {joints}*,\n        {base}{frame}{payload}\
                 parameters: Parameters = ..., out: Floats | None = ...,\n    \
                 ) -> {returned}:\n        \"\"\"{summary}\"\"\""
            );
        }
    };
    macro_rules! methods {
        ($(
            $variant:ident = $name:ident($($argument:ident: $kind:ident),*) -> $returned:ident $(at $of_frame:ident)?:
                $summary:literal $(, $details:literal)?;
        )*) => {
            $(stub(
                Function::$variant,
                &[$((stringify!($argument), Argument::$kind)),*],
                Returned::$returned,
                $summary,
            );)*
        };
    }
    rne_codegen::functions!(methods);
    text
}

/// What every function of the PUMA 560 costs in both forms.
fn functions() -> String {
    let path = root().join("robots/puma560.yaml");
    let robot = robot(&path);
    let (plans, _) = plans(&path, &robot);
    let mut text = String::from(
        "| derive | method | seven steps: products | sums | reduced: products | sums | divisions | angles |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for capability in Capability::ALL {
        for function in capability.functions() {
            let count = |form| {
                Compiler::new(&robot).with_plans(&plans).compile(function, form).expect("finite constants").operations()
            };
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
fn plans(file: &Path, robot: &Robot) -> (PlanSet, bool) {
    let plan = file.with_extension("plan.yaml");
    if !plan.exists() {
        return (PlanSet::default_of(robot), false);
    }
    let plan = PlanFile::read(&plan.display().to_string(), &read(&plan), robot);
    (PlanSet::from(plan.unwrap_or_else(|report| panic!("{report}"))), true)
}

/// The operations of every robot, the forms side by side.
fn operations() -> String {
    let cell = |counts: Operations| format!("{} + {} = {}, {}", counts.mul, counts.add, counts.total(), counts.sincos);
    let mut text = String::from(
        "| robot | plan | before folding | seven_steps | planned | reduced |\n|---|---|---:|---:|---:|---:|\n",
    );
    for path in robot_files() {
        let robot = robot(&path);
        let (plans, has_plan) = plans(&path, &robot);
        let seven_steps = inverse_dynamics(&robot);
        let (products, sums) = seven_steps.before();
        let _ = writeln!(
            text,
            "| {} | {} | {products} + {sums} = {} | {} | {} | {} |",
            robot.name,
            if has_plan { "file" } else { "of the build" },
            products + sums,
            cell(seven_steps.operations()),
            cell(reduced(&robot, &rne_search::without(&robot, &plans, &[Trick::Rewriting]))),
            cell(reduced(&robot, &plans)),
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
        rne_search::savings(&robot, &plans(&path, &robot).0)
    });
    let mut text = format!("| trick | {} | what it is |\n|---|---:|---:|---|\n", robots.join(" | "));
    for trick in Trick::ALL {
        let saved = |robot: usize| savings[robot].iter().find(|(used, _)| *used == trick).map(|(_, saved)| *saved);
        let cell = |saved: Option<isize>| saved.map_or_else(String::new, |saved| saved.to_string());
        if saved(0).is_some() || saved(1).is_some() {
            let _ = writeln!(text, "| {trick} | {} | {} | {} |", cell(saved(0)), cell(saved(1)), trick.formula());
        }
    }
    text
}

/// A document with every block as it should be, and the names of the blocks.
fn renewed(document: &str) -> (String, Vec<String>) {
    let (mut text, mut names) = (String::new(), Vec::new());
    let mut lines = document.lines();
    while let Some(line) = lines.next() {
        text.push_str(line);
        text.push('\n');
        let marker = line.trim_start_matches([' ', '#']);
        if let Some(heading) = marker.strip_prefix("<!-- begin: ") {
            let name = heading.split([',', ' ']).next().unwrap_or_default();
            let end = format!("{}<!-- end -->", line.strip_suffix(marker).unwrap_or_default());
            let written: Vec<&str> = lines.by_ref().take_while(|line| *line != end).collect();
            match name {
                "measured" | "output" => written.iter().for_each(|line| {
                    text.push_str(line);
                    text.push('\n');
                }),
                name => {
                    text.push_str(&block(name));
                    names.push(name.to_owned());
                }
            }
            text.push_str(&end);
            text.push('\n');
        }
    }
    (text, names)
}

#[test]
fn documents_say_what_the_code_prints() {
    for (name, blocks) in DOCUMENTS {
        let path = root().join(name);
        let document = read(&path);
        let (renewed, found) = renewed(&document);
        assert_eq!(found, *blocks, "the blocks of {name}");
        if std::env::var_os("RNE_WRITE_DOCUMENTS").is_some() {
            std::fs::write(&path, &renewed).expect("a writable file");
        } else {
            assert_eq!(document, renewed, "{}: RNE_WRITE_DOCUMENTS=1 cargo test --test documents", path.display());
        }
    }
}

/// The files below a folder whose names end so, what is built and hidden left out.
fn files_below(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            files_below(&path, ending, found);
        } else if name.ends_with(ending) {
            found.push(path);
        }
    }
}

/// The headings of a page as GitHub names them in addresses.
fn anchors(page: &str) -> BTreeSet<String> {
    let mut anchors = BTreeSet::new();
    let mut is_code = false;
    for line in page.lines() {
        is_code ^= line.starts_with("```");
        let title = line.trim_start_matches('#');
        if is_code || !line.starts_with('#') || !title.starts_with(' ') {
            continue;
        }
        let kept = title.trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        let anchor: String = kept.flat_map(char::to_lowercase).map(|c| if c == ' ' { '-' } else { c }).collect();
        let again = (1..1000).map(|time| format!("{anchor}-{time}")).find(|name| !anchors.contains(name));
        let name = if anchors.contains(&anchor) { again.expect("some number is free") } else { anchor };
        anchors.insert(name);
    }
    anchors
}

#[test]
fn links_lead_somewhere() {
    let mut pages = Vec::new();
    files_below(root(), ".md", &mut pages);
    let mut links = 0;
    for page in &pages {
        let text = read(page);
        for link in text.split("](").skip(1).filter_map(|rest| rest.split([')', ' ']).next()) {
            if link.contains("://") {
                continue;
            }
            links += 1;
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { page.clone() } else { page.with_file_name(file) };
            assert!(target.exists(), "{}: `{link}` leads nowhere", page.display());
            if !anchor.is_empty() {
                assert!(anchors(&read(&target)).contains(anchor), "{}: `{link}` has no such heading", page.display());
            }
        }
    }
    assert!(links > 80, "{links} links of {} pages", pages.len());
}

/// A source that any page names by its last part (`prove.rs`, `ir/graph.rs`) is there.
#[test]
fn pages_name_sources_that_are_there() {
    let (mut pages, mut sources) = (Vec::new(), Vec::new());
    files_below(root(), ".md", &mut pages);
    files_below(root(), ".rs", &mut sources);
    let mut named = 0;
    for page in &pages {
        for word in read(page).split('`').skip(1).step_by(2) {
            let is_path = word.chars().all(|c| c.is_ascii_alphanumeric() || "_/.-".contains(c));
            if is_path
                && Path::new(word).extension() == Some("rs".as_ref())
                && !word.starts_with('.')
                && !word.starts_with("target/") // what a build writes
                && page.file_name() != Some("CHANGELOG.md".as_ref())
            {
                named += 1;
                assert!(
                    sources.iter().any(|source| source.ends_with(word)),
                    "{}: there is no `{word}`",
                    page.display()
                );
            }
        }
    }
    assert!(named > 60, "{named} sources are named");
}

/// Files and tests that the guides name are there. A test is what has three underscores or more; a name in capitals
/// (`robots/NAME.yaml`) stands for any.
#[test]
fn guides_name_what_is_there() {
    let mut sources = Vec::new();
    files_below(root(), ".rs", &mut sources);
    let code: String = sources.iter().map(|path| read(path)).collect();
    for guide in GUIDES {
        let text = read(&root().join(guide));
        let mut named = 0;
        let mut is_code = false;
        for line in text.lines() {
            is_code ^= line.starts_with("```");
            if is_code {
                continue;
            }
            for word in line.split('`').skip(1).step_by(2) {
                let is_name = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
                if word.chars().all(is_name) && word.matches('_').count() >= 3 {
                    assert!(code.contains(&format!("fn {word}(")), "{guide}: there is no test `{word}`");
                    named += 1;
                } else if word.contains('/') && word.chars().all(|c| is_name(c) || "/.-".contains(c)) {
                    assert!(root().join(word).exists(), "{guide}: there is no `{word}`");
                    named += 1;
                }
            }
        }
        assert!(named > 30, "{guide} names {named} files and tests");
    }
}

/// The Rust files of the repository, from its root, whose text says one of these words.
/// The rows of the crates stand in such an order that each uses only what stands above it.
#[test]
fn crates_use_what_stands_above_them() {
    let guide = read(&root().join("ARCHITECTURE.md"));
    let mut above: Vec<&str> = Vec::new();
    for row in guide.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.split('`').collect();
        let &[_, folder, _, name, ..] = cells.as_slice() else { continue };
        let manifest = root().join(if folder == "src/" { "" } else { folder }).join("Cargo.toml");
        let Some(manifest) = std::fs::read_to_string(manifest).ok().filter(|_| name.starts_with("rne")) else {
            continue;
        };
        let dependencies = manifest.split_once("\n[dependencies]\n").map_or("", |(_, dependencies)| dependencies);
        let dependencies = dependencies.split("\n[").next().unwrap_or_default();
        for line in dependencies.lines().filter(|line| line.starts_with("rne")) {
            let used = line.split(['.', ' ', '=']).next().unwrap_or_default();
            assert!(above.contains(&used), "ARCHITECTURE.md: {name} stands above {used}, which it uses");
        }
        above.push(name);
    }
    assert!(above.len() > 15 && above.contains(&"rne-cli"), "{above:?}");
}

fn files_that_say(words: &[&str]) -> Vec<String> {
    let mut sources = Vec::new();
    files_below(root(), ".rs", &mut sources);
    sources.retain(|path| words.iter().any(|word| read(path).contains(word)));
    let inside =
        |path: &PathBuf| path.strip_prefix(root()).expect("below the root").to_string_lossy().replace('\\', "/");
    let mut names: Vec<String> = sources.iter().map(inside).collect();
    names.sort();
    names
}

#[test]
fn no_test_asks_the_clock_but_to_print() {
    let mut found =
        files_that_say(&[concat!("Instant", "::now"), concat!("System", "Time"), concat!(".elap", "sed()")]);
    found.retain(|name| name.split('/').any(|folder| folder == "tests") || name.ends_with("tests.rs"));
    assert_eq!(found, ["tests/compile_time.rs"]);
}

#[test]
fn unsafe_stands_in_two_modules() {
    let mut found = files_that_say(&[concat!("allow(", "unsafe_code)"), concat!("expect(", "unsafe_code)")]);
    found.retain(|name| {
        ["rne-", "src/", "doors/playground/", "doors/capi/src/"].iter().any(|folder| name.starts_with(folder))
    });
    // one turns the pointers of C into slices, one is an attribute, the name of an export
    let expected = [
        "doors/capi/src/border.rs",
        "doors/playground/src/border.rs",
        "rne-machine/src/native.rs",
        "rne-runtime/src/registers/mod.rs",
    ];
    assert_eq!(found, expected);
}

#[test]
fn the_compiler_opens_no_file_and_prints_nothing() {
    let mut sources = Vec::new();
    files_below(&root().join("rne-codegen/src"), ".rs", &mut sources);
    for source in sources {
        let text = read(&source);
        // tests read robots and print figures
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        let is_test = source.components().any(|part| part.as_os_str() == "tests") || source.ends_with("tests.rs");
        for word in ["std::fs", "std::env", "println!", "eprint!", "dbg!"] {
            assert!(is_test || !code.contains(word), "{}: {word}", source.display());
        }
    }
}

/// A new robot is in no list: what wants all of them reads the folder, or takes `shipped::for_each_robot`.
#[test]
fn no_source_lists_the_robots() {
    let names: Vec<String> = robot_files().iter().map(|path| robot(path).name).collect();
    let mut sources = Vec::new();
    for ending in [".rs", ".toml", ".py", "run"] {
        files_below(root(), ending, &mut sources);
    }
    for source in sources {
        let text = read(&source);
        let words: BTreeSet<&str> = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').collect();
        let named = names.iter().filter(|name| words.contains(name.as_str())).count();
        assert!(4 * named < 3 * names.len(), "{} names {named} of {} robots", source.display(), names.len());
    }
}

#[test]
fn the_readme_is_short() {
    let lines = read(&root().join("README.md")).lines().count();
    assert!(lines <= 225, "README.md has {lines} lines: long tables stand in docs/");
}

#[test]
fn the_robot_file_of_the_readme_is_valid() {
    let document = read(&root().join("README.md"));
    let (_, rest) = document.split_once("```yaml\n").expect("a robot file");
    let (yaml, _) = rest.split_once("```").expect("its end");
    let checked = rne_model::Reader::new("README.md").read(yaml).unwrap_or_else(|report| panic!("{report}"));
    assert!(checked.lints.is_empty(), "{}", checked.lints);
}

/// The plan that docs/reduced-form.md explains is the one that is shipped.
#[test]
fn the_explained_plan_is_the_shipped_one() {
    let page = read(&root().join("docs/reduced-form.md"));
    let (_, explained) = page.split_once("\n    format: 3 ").expect("a plan");
    let (explained, _) = explained.split_once("\n    rewritten:").expect("two forms");
    let explained = format!("format: 3 {explained}\n").replace("\n    ", "\n");
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
