//! Every command that a document gives to its reader works: those of `rne` run here, in a copy of the robots; for every
//! other it is known who runs it.
//!
//! What a command prints (`<!-- begin: output … -->`) is what it prints today; `RNE_WRITE_DOCUMENTS` writes it anew.
#![cfg(unix)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use crate::call::{ROOT, folder};

/// The documents whose commands a reader types.
const DOCUMENTS: [&str; 32] = [
    "README.md",
    "CONTRIBUTING.md",
    "docs/firmware/c-library.md",
    "docs/control/closed-loops.md",
    "docs/reference/command-line.md",
    "docs/firmware/first-firmware.md",
    "docs/control/fmi.md",
    "docs/control/identify.md",
    "docs/teaching/inspection.md",
    "docs/control/jax.md",
    "docs/teaching/lecture/README.md",
    "docs/teaching/lecture/errata.md",
    "docs/teaching/lecture/answers.md",
    "docs/teaching/lecture/exercises.md",
    "docs/teaching/lecture/folding.md",
    "docs/teaching/lecture/frames.md",
    "docs/teaching/lecture/one-link.md",
    "docs/teaching/lecture/prismatic.md",
    "docs/teaching/lecture/reduced.md",
    "docs/teaching/lecture/results.md",
    "docs/teaching/lecture/two-links.md",
    "docs/control/logs.md",
    "docs/control/operational-space.md",
    "docs/control/optimal-control.md",
    "docs/control/python.md",
    "docs/reference/robot-file-keys.md",
    "docs/robot-file.md",
    "docs/control/run-time.md",
    "docs/teaching/for-teachers.md",
    "docs/control/urdf.md",
    "docs/control/watch.md",
    "robots/README.md",
];

/// The documents whose commands run in each `cargo test`: the first page, and the first of each track. `cargo xtask
/// verify certify` runs the commands of all.
const FIRST_READ: [&str; 5] = [
    "README.md",
    "docs/robot-file.md",
    "docs/reference/command-line.md",
    "docs/firmware/first-firmware.md",
    "docs/teaching/for-teachers.md",
];

/// Commands that take long, install something or change the repository: how they begin, and the file that has them run,
/// by this text.
const RUN_ELSEWHERE: &[(&str, &str, &str)] = &[
    ("cargo test", ".ci/run", "\nstep cargo xtask bare"),
    ("cargo test --workspace", "xtask/src/verify.rs", "name: \"rest\""),
    ("cargo xtask bare", ".ci/run", "\nstep cargo xtask bare"),
    ("RNE_EXHAUSTIVE=1 cargo test", "xtask/src/verify.rs", "\"RNE_EXHAUSTIVE\", \"1\""),
    ("RNE_EXHAUSTIVE=1 RNE_WRITE_DOCUMENTS=1 cargo test", "xtask/src/verify.rs", "\"RNE_EXHAUSTIVE\", \"1\""),
    ("RNE_WRITE_DOCUMENTS=1 cargo test", ".ci/run", "\nstep cargo xtask bare"),
    ("cargo fmt", ".ci/run", "step cargo fmt --all"),
    ("cargo clippy", ".ci/run", "step cargo clippy --workspace --all-targets -- -D warnings\n"),
    ("cargo xtask lines", ".ci/run", "step cargo xtask lines\n"),
    ("cargo xtask prose", ".ci/run", "step cargo xtask prose\n"),
    ("cargo xtask verify", ".ci/run", "step cargo xtask verify --install\n"),
    ("cargo xtask urdf", "xtask/src/verify.rs", "\"xtask\", \"urdf\""),
    ("cargo xtask doors", ".ci/run", "step cargo xtask doors --install\n"),
    ("cargo xtask fuzz", ".ci/run", "step cargo xtask fuzz"),
    ("cargo xtask package", "xtask/src/verify.rs", "\"xtask\", \"package\""),
    ("cargo xtask release", "xtask/src/verify.rs", "\"xtask\", \"release\""),
    ("cargo xtask tool", "xtask/src/verify.rs", "\"xtask\", \"tool\", \"deny\""),
    ("cargo xtask tool book", "xtask/src/verify.rs", "\"xtask\", \"tool\", \"book\""),
    ("cargo xtask site", "xtask/src/verify.rs", "\"xtask\", \"site\", \"--install\""),
    ("cargo xtask python", "xtask/src/verify.rs", "\"xtask\", \"python\", \"--install\""),
    ("cargo xtask capi", ".ci/run", "cargo xtask capi"),
    ("cargo xtask fmu", "xtask/src/verify.rs", "\"xtask\", \"fmu\", \"--install\""),
    // with the flags of pkg-config, below the prefix that it was given
    ("export PKG_CONFIG_PATH=", "xtask/src/packages/capi.rs", ".env(\"PKG_CONFIG_PATH\", library.join(\"pkgconfig\"))"),
    ("pip install ./doors/python", "xtask/src/packages/python.rs", "pip install --quiet"),
    ("pip install jax", "xtask/src/packages/python.rs", "const JAX"),
    ("pip install casadi", "xtask/src/packages/python.rs", "const CASADI"),
    ("cargo run --release --manifest-path examples/mpc/Cargo.toml", "examples/mpc/tests/reach.rs", "run(method)"),
    ("python examples/mpc/casadi_mpc.py", "doors/python/tests/test_casadi.py", "import casadi_mpc"),
    ("cc -std=c99 -O2 -ffp-contract=off -fPIC", "doors/python/tests/test_casadi.py", "shlex.split(command)"),
    ("cc doors/c/examples/torque.c", "xtask/src/packages/capi.rs", "(\"doors/c/examples/torque.c\", \"cc\""),
    ("cargo xtask page", ".ci/run", "step cargo xtask page --install\n"),
    ("cargo xtask playground", "xtask/src/verify.rs", "\"xtask\", \"playground\", \"--install\""),
    ("cargo xtask features", "xtask/src/verify.rs", "\"xtask\", \"features\""),
    ("cargo xtask certify-all", ".ci/run", "step cargo xtask certify-all --install\n"),
    ("cargo xtask certificate", ".ci/run", "step cargo xtask certificate --install\n"),
    ("cargo xtask frozen", ".ci/run", "step cargo xtask frozen\n"),
    ("cargo xtask surface", ".ci/run", "step cargo xtask surface\n"),
    ("cargo xtask light", ".ci/run", "step cargo xtask light $("),
    // its page is checked, and it breaks sources
    ("cargo xtask mutate", "tests/documents/pages.rs", "fn the_page_of_mutations_is_of_the_mutants()"),
    // it searches for minutes
    ("cargo xtask tree-counts", "xtask/src/main.rs", "TreeCounts("),
    // they draw robots for minutes
    ("cargo xtask derivatives", "xtask/src/main.rs", "Derivatives(derivatives::Derivatives)"),
    ("cargo xtask loops", "xtask/src/main.rs", "Loops(loops::Loops)"),
    // it measures times
    ("cargo xtask performance", "xtask/src/main.rs", "Performance(performance::Performance)"),
    // it fetches Pinocchio
    ("cargo xtask urdf", "xtask/src/main.rs", "Urdf(urdf::Urdf)"),
    // its document is checked in xtask/src/packages/sbom.rs
    ("cargo xtask sbom", "xtask/src/main.rs", "Sbom(sbom::Sbom)"),
    // it fetches Cyclone DDS, and measures for a minute
    ("cargo xtask ros2", "xtask/src/main.rs", "Ros2(ros2::Ros2)"),
    (".ci/run", ".ci/run", "#!/usr/bin/env bash"),
    // of an object that a compiler of the user has made
    ("arm-none-eabi-nm -u my_arm.o", "cli/tests/cli/certify_trees.rs", "Command::new(\"arm-none-eabi-nm\")"),
    // in a firmware that rne has written
    ("rustup target add thumbv7em-none-eabihf", "firmware/example/run", "rustup target add $target"),
    ("sudo apt-get install --yes qemu-system-arm", "firmware/example/run", "packages=(qemu-system-arm)"),
    ("cargo run --release", ".ci/run", "firmware/example/run --install --written target/torque\n"),
    ("firmware/example/run", ".ci/run", "firmware/example/run --install $board"),
    ("cargo install --path cli", "cli/Cargo.toml", "name = \"rne\""),
    // the search runs in cli/tests/cli/search.rs
    ("cargo run --release -- search robots/NAME.yaml --seconds 600", "cli/tests/cli/search.rs", "\"search\""),
];

/// A copy of what commands read, in a folder that they may leave.
pub(crate) fn copy(name: &str) -> PathBuf {
    let folder = folder(name).join("clone");
    let of_documents =
        ["robots", "docs", "docs/teaching/lecture", "docs/teaching/lecture/answers", "docs/teaching/lecture/class"];
    for part in of_documents.into_iter().chain(["benches/trees/loops"]) {
        fs::create_dir_all(folder.join(part)).expect("a folder");
        for entry in fs::read_dir(Path::new(ROOT).join(part)).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|extension| extension == "yaml" || extension == "csv") {
                fs::copy(&path, folder.join(part).join(path.file_name().expect("a name"))).expect("a copy");
            }
        }
    }
    let logs = Path::new("logs/read/tests/data");
    fs::create_dir_all(folder.join(logs)).expect("a folder");
    for log in ["ur10.db3", "panda.db3"] {
        fs::copy(Path::new(ROOT).join(logs).join(log), folder.join(logs).join(log)).expect("a copy");
    }
    // by which a clone is known
    fs::copy(Path::new(ROOT).join("Cargo.toml"), folder.join("Cargo.toml")).expect("a copy");
    fs::copy(folder.join("docs/desk_arm.yaml"), folder.join("my_arm.yaml")).expect("a copy");
    folder
}

/// Runs a command as a shell does, with the binary that is tested.
pub(crate) fn typed(folder: &Path, command: &str) -> Output {
    let binary = Path::new(env!("CARGO_BIN_EXE_rne")).parent().expect("a folder");
    let path = std::env::var("PATH").unwrap_or_default();
    Command::new("sh")
        .args(["-euc", command])
        .current_dir(folder)
        .env("PATH", format!("{}:{path}", binary.display()))
        .env_remove("CLICOLOR_FORCE")
        .stdin(Stdio::null())
        .output()
        .expect("a shell")
}

/// A command with formats that this build does not have, which `cargo xtask verify formats` runs, or with programs that
/// this machine does not have, which `cargo xtask verify certify` installs.
fn is_left_out(command: &str) -> bool {
    !cfg!(feature = "bags") && command.starts_with("cargo run --features bags -- ")
        || !cfg!(feature = "full") && command.starts_with("cargo run --features full -- ")
        || of_rne(command).is_some_and(|command| lacks_program(&command))
}

/// Whether a command needs a program that is not on this machine; one line names it.
pub(crate) fn lacks_program(command: &str) -> bool {
    if command.starts_with("rne certify") && !crate::certify::has_tools() {
        return true;
    }
    let programs = command.split(['|', ';']).skip(1).filter_map(|part| part.split_whitespace().next());
    let lacking = programs.filter(|name| typed(Path::new(ROOT), &format!("command -v {name}")).stdout.is_empty());
    lacking.inspect(|name| println!("`{command}` does not run: {name} is not installed")).count() > 0
}

/// A command of rne, as it is called where it is installed; `None` for any other.
fn of_rne(command: &str) -> Option<String> {
    if command == "cargo run" {
        return Some("rne".to_owned());
    }
    let starts = ["cargo run -- ", "cargo run --features bags -- ", "cargo run --features full -- ", "rne "];
    let arguments = starts.iter().find_map(|start| command.strip_prefix(start))?;
    Some(format!("rne {arguments}").replace("NAME", "puma560"))
}

/// Whether words stand for others: `FILE…`, `[--joint I]`, `COMMAND`; or no robot is named, so that the words name an
/// option: `rne emit --tests`.
fn is_pattern(command: &str) -> bool {
    command.contains(['…', '['])
        || ["COMMAND", "DIR", "FILE", "LINK", "TOPIC", "SHELL", "ROBOT"].iter().any(|word| command.contains(word))
        || command.starts_with("rne ") && command.split(' ').nth(2).is_some_and(|word| word.starts_with("--"))
}

/// The file of a test that `cargo test … --test NAME` asks for.
fn tests_are_there(document: &str, command: &str) {
    let words: Vec<&str> = command.split(' ').collect();
    let after = |option: &str| words.iter().position(|word| *word == option).and_then(|at| words.get(at + 1));
    let Some(name) = after("--test") else { return };
    let package = format!("name = \"{}\"", after("-p").unwrap_or(&"rne"));
    let folders = |above: &Path| fs::read_dir(above).expect("a folder").map(|entry| entry.expect("an entry").path());
    let shelves = folders(Path::new(ROOT)).filter(|path| path.is_dir() && !path.ends_with("target"));
    let crates = shelves.flat_map(|shelf| folders(&shelf).chain([shelf.clone()]).collect::<Vec<_>>());
    let found = crates.chain([Path::new(ROOT).to_owned()]).find_map(|folder| {
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).ok()?;
        let own = manifest.lines().find(|line| line.starts_with("name = "));
        (own == Some(&package)).then_some((folder, manifest))
    });
    let (root, manifest) = found.unwrap_or_else(|| panic!("{document}: `{command}`: there is no package {package}"));
    let files = ["tests/NAME.rs", "tests/NAME/main.rs", "tests/NAME/all.rs"].map(|file| file.replace("NAME", name));
    assert!(
        files.iter().any(|file| root.join(file).exists()) || manifest.contains(&format!("name = \"{name}\"")),
        "{document}: `{command}`: there is no test {name}"
    );
}

/// Runs a command, or sees that somebody does; what it printed, if it is one of rne.
fn tried(folder: &Path, document: &str, command: &str) -> Option<String> {
    let elsewhere = RUN_ELSEWHERE.iter().filter(|(start, ..)| command.starts_with(start));
    if let Some((_, file, text)) = elsewhere.max_by_key(|(start, ..)| start.len()) {
        let there = fs::read_to_string(Path::new(ROOT).join(file)).expect("a file");
        assert!(there.contains(text), "{document}: `{command}` was run by {file}, which has no `{text}`");
        tests_are_there(document, command);
        return None;
    }
    let called = of_rne(command).unwrap_or_else(|| panic!("{document}: nobody runs `{command}`"));
    let output = typed(folder, &called);
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"));
    // an answer with a slip in it is marked wrong, a knock and wear are events, and only that
    let is_event = command.contains("_knock.csv") || command.contains("_worn.csv");
    let status = i32::from(command.ends_with("-wrong.csv") || is_event);
    assert_eq!(output.status.code(), Some(status), "{document}: `{command}`: {err}");
    Some(out + &err)
}

/// The commands in backticks of a line of prose.
fn in_prose(line: &str) -> impl Iterator<Item = &str> {
    let quoted = line.split('`').skip(1).step_by(2);
    let starts = ["cargo ", "rne ", ".ci/run", "RNE_EXHAUSTIVE=", "RNE_WRITE_DOCUMENTS="];
    quoted.filter(move |words| starts.iter().any(|start| words.starts_with(start)) && !is_pattern(words))
}

/// Numbers of a text, and what is between them.
fn parts(text: &str) -> (Vec<f64>, Vec<&str>) {
    let words = text.split(|c: char| c.is_whitespace() || "[]{},:%".contains(c)).filter(|word| !word.is_empty());
    let (numbers, others): (Vec<&str>, Vec<&str>) = words.partition(|word| word.parse::<f64>().is_ok());
    (numbers.into_iter().filter_map(|word| word.parse().ok()).collect(), others)
}

const IDENTIFIED: &str = "docs/desk_arm_identified.yaml";

/// What the README's command writes of the log of the desk arm, and what is there.
fn identified(name: &str) -> (String, String) {
    let folder = copy(name);
    let output = typed(&folder, "rne identify docs/desk_arm.yaml docs/desk_arm_log.csv -o identified.yaml");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let today = fs::read_to_string(folder.join("identified.yaml")).expect("a file");
    (today, fs::read_to_string(Path::new(ROOT).join(IDENTIFIED)).expect("a file"))
}

/// Whether two robot files have the same words, and the same numbers but for what another library's sines change.
fn is_same_robot(a: &str, b: &str) -> bool {
    let ((numbers, words), (others, other_words)) = (parts(a), parts(b));
    // what is small beside the arm is rounding of what is not
    let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-6 * a.abs().max(b.abs()).max(1e-2);
    words == other_words && numbers.len() == others.len() && numbers.iter().zip(&others).all(is_near)
}

fn is_writing() -> bool {
    std::env::var_os("RNE_WRITE_DOCUMENTS").is_some()
}

/// The robot file that the page on watching has is what the README's command writes.
#[test]
fn the_identified_arm_is_what_the_command_writes() {
    let (today, page) = identified("identified");
    assert!(
        is_writing() || is_same_robot(&today, &page),
        "{IDENTIFIED}: RNE_WRITE_DOCUMENTS=1 cargo test -p rne-cli --test cli documents\n{today}\n{page}"
    );
}

/// The log with a knock is the log without, and half a wave on two joints from 9.2 s on for 0.48 s.
#[test]
fn the_knock_is_what_the_page_says() {
    let rows = |name: &str| -> Vec<Vec<f64>> {
        let text = fs::read_to_string(Path::new(ROOT).join("docs").join(name)).expect("a log");
        let row = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        text.lines().skip(1).map(row).collect()
    };
    let (log, knock) = (rows("desk_arm_log.csv"), rows("desk_arm_knock.csv"));
    assert_eq!(log.len(), knock.len());
    for (row, with) in log.iter().zip(&knock) {
        let part = (row[0] - 9.2) / 0.48;
        let wave = if (0.0..=1.0).contains(&part) { (std::f64::consts::PI * part).sin() } else { 0.0 };
        let added = [0.0, 2.2 * wave, 1.6 * wave];
        for (column, (before, after)) in row.iter().zip(with).enumerate() {
            let added = column.checked_sub(7).map_or(0.0, |joint| added[joint]);
            // efforts have two digits behind the point
            assert!((after - before - added).abs() <= 0.005 + 1e-9, "{} s, column {column}: {before} {after}", row[0]);
            assert!(added != 0.0 || before == after, "{} s", row[0]);
        }
    }
}

/// The worn log is the log, and from 8 s on 0.15 N m at the elbow in the direction of its motion.
#[test]
fn the_worn_log_is_what_the_page_says() {
    let rows = |name: &str| -> Vec<Vec<f64>> {
        let text = fs::read_to_string(Path::new(ROOT).join("docs").join(name)).expect("a log");
        let row = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        text.lines().skip(1).map(row).collect()
    };
    let (log, worn) = (rows("desk_arm_log.csv"), rows("desk_arm_worn.csv"));
    assert_eq!(log.len(), worn.len());
    for (row, with) in log.iter().zip(&worn) {
        let added = if row[0] >= 8.0 && row[6] != 0.0 { 0.15 * row[6].signum() } else { 0.0 };
        for (column, (before, after)) in row.iter().zip(with).enumerate() {
            let added = if column == 9 { added } else { 0.0 };
            assert!((after - before - added).abs() <= 0.005 + 1e-9, "{} s, column {column}: {before} {after}", row[0]);
        }
    }
}

#[test]
fn commands_of_documents_work() {
    // by which the page on watching goes
    let (today, page) = if is_writing() { identified("identified_anew") } else { <(String, String)>::default() };
    if !is_same_robot(&today, &page) {
        fs::write(Path::new(ROOT).join(IDENTIFIED), today).expect("a writable file");
    }
    let mut commands = 0;
    let tried_here = if shipped::is_exhaustive() { &DOCUMENTS[..] } else { &FIRST_READ };
    for &document in tried_here {
        let folder = copy("documents");
        let path = Path::new(ROOT).join(document);
        let page = fs::read_to_string(&path).expect("a document");
        let (mut renewed, mut printed) = (String::new(), String::new());
        let mut lines = page.lines();
        let mut block = None;
        // a command of the block, and so all that follow it there
        let mut left_out = false;
        let mut here = folder.clone();
        while let Some(line) = lines.next() {
            renewed.push_str(line);
            renewed.push('\n');
            if let Some(language) = line.strip_prefix("```") {
                block = if block.is_some() { None } else { Some(language) };
                if block == Some("sh") {
                    printed.clear();
                    left_out = false;
                    here.clone_from(&folder);
                }
            } else if block == Some("sh") {
                let command = line.split(" #").next().unwrap_or_default().trim();
                left_out |= is_left_out(command);
                if let Some(there) = command.strip_prefix("cd ") {
                    here = here.join(there);
                    assert!(here.is_dir(), "{document}: `{command}`: there is no such folder");
                } else if !left_out {
                    printed += &tried(&here, document, command).unwrap_or_default();
                }
                commands += 1;
            } else if line.starts_with("<!-- begin: output, ") {
                let old: Vec<&str> = lines.by_ref().take_while(|line| *line != "<!-- end -->").collect();
                if left_out {
                    renewed.extend([&old.join("\n"), "\n<!-- end -->\n"]);
                    continue;
                }
                renewed.extend(["```text\n", &printed, "```\n<!-- end -->\n"]);
            } else if block.is_none() {
                for command in in_prose(line).filter(|command| !is_left_out(command)) {
                    // `rne eval` is the name of a command
                    if !command.starts_with("rne ") || command.split(' ').count() > 2 {
                        tried(&folder, document, command);
                        commands += 1;
                    }
                }
            }
        }
        if is_writing() && page != renewed {
            fs::write(&path, &renewed).expect("a writable file");
        } else {
            assert_eq!(page, renewed, "{document}: RNE_WRITE_DOCUMENTS=1 cargo test -p rne-cli --test cli documents");
        }
    }
    assert!(commands > 40, "{commands} commands");
}
