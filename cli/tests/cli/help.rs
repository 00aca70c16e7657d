//! The pages of help: as wide as any terminal, as long as one screen, and with examples that work.

use std::fs;

use unicode_width::UnicodeWidthStr as _;

use crate::call::{fails, fine, folder};

/// Every command, by the help of rne.
fn commands() -> Vec<String> {
    let help = fine(&["--help"]);
    let (_, list) = help.split_once("Commands:\n").expect("a list of commands");
    let lines = list.lines().take_while(|line| !line.is_empty());
    let names = lines.filter_map(|line| line.split_whitespace().next()).map(str::to_owned);
    names.filter(|name| name != "help").collect()
}

/// The help of rne and of every command.
fn pages() -> Vec<(String, String)> {
    let of = |command: String| {
        let help = fine(&[&command, "--help"]);
        (command, help)
    };
    let commands = commands();
    assert!(commands.len() >= 9, "{commands:?}");
    std::iter::once(("rne".to_owned(), fine(&["--help"]))).chain(commands.into_iter().map(of)).collect()
}

#[test]
fn helps_fit_on_a_screen() {
    for (command, help) in pages() {
        for line in help.lines() {
            assert!(line.width() <= 80, "{command}: {} columns: {line}", line.width());
            assert_eq!(line, line.trim_end(), "{command}");
        }
        // the options for reading a log are the same everywhere, below a heading of their own
        let shared = help
            .split_once("How the log is read:")
            .map_or(0, |(_, rest)| rest.lines().skip(1).take_while(|line| line.starts_with("   ")).count());
        let lines = help.lines().count() - shared;
        assert!(lines <= 50 && shared <= 30, "{command}: {lines} lines and {shared}");
    }
}

/// What `rne explain` prints is prose of the same width.
#[test]
fn topics_are_explained() {
    let help = fine(&["explain", "--help"]);
    let topics: Vec<&str> = help.lines().filter_map(|line| line.strip_prefix("  rne explain ")).collect();
    assert!(topics.len() >= 5, "{help}");
    for topic in topics.iter().filter_map(|line| line.split("  ").next()) {
        let words: Vec<&str> = ["explain"].into_iter().chain(topic.split(' ')).collect();
        let text = fine(&words);
        assert!(text.lines().count() > 3 && text.lines().all(|line| line.width() <= 80), "{topic}: {text}");
    }
    assert!(fine(&["explain", "functions"]).contains("\ninverse_dynamics_derivatives\n"));
    let on_one_line = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ");
    for robot in [None, Some("puma560")] {
        let step = on_one_line(fine(&["explain", "euler_step"].into_iter().chain(robot).collect::<Vec<_>>()));
        assert!(step.starts_with("euler_step A step of the semi-implicit Euler method under torques"), "{step}");
        assert!(step.contains("--function euler_step` takes the options --q --qd --tau --duration."), "{step}");
    }
    let of_sines = on_one_line(fine(&["explain", "inverse_dynamics_from_sin_cos"]));
    assert!(of_sines.contains("takes the options --q --qd --qdd."), "{of_sines}");
    assert!(fine(&["explain", "runge_kutta_step"]).contains("rne emit FILE --lang c --runge-kutta"));
    fails(2, &["explain", "euler_stp"], &["did you mean euler_step?"]);
    assert!(fine(&["explain", "hold-out"]).contains("rne identify FILE LOG --hold-out 0.3"));
    assert!(fine(&["explain", "mcx2"]).starts_with("mcx2 is a moment of mass of link 2, in kg m"));
    // with a robot a name in the code comes first
    assert!(fine(&["explain", "Jzz3", "puma560"]).starts_with("Jzz3 is the element zz of the inertia of link 3"));
    assert!(fine(&["explain", "exit-status"]).contains("`rne certify --check`"));
    fails(2, &["explain", "nothing"], &["exit-status", "Jzz3"]);
    fails(2, &["explain", "puma560", "w2_z"], &["the name comes first", "rne explain w2_z puma560"]);
    fails(2, &["explain", "robots/ur5.yaml", "w2_z"], &["rne explain w2_z robots/ur5.yaml"]);
    fails(1, &["explain", "w2_z", "puma56"], &["puma560"]);
}

/// The commands below `Examples:`, without the words beside them.
#[cfg(unix)]
fn examples(help: &str) -> Vec<String> {
    let (_, below) = help.split_once("\nExamples:\n").unwrap_or_else(|| panic!("no example: {help}"));
    let mut examples: Vec<String> = Vec::new();
    for line in below.lines().take_while(|line| line.starts_with("  ")) {
        let command = line.trim().split("  ").next().unwrap_or_default();
        match examples.last_mut().filter(|last| last.ends_with('\\')) {
            Some(last) => last.truncate(last.len() - 1),
            None => examples.push(String::new()),
        }
        examples.last_mut().expect("one was pushed").push_str(command);
    }
    examples
}

#[cfg(unix)]
#[test]
fn examples_of_helps_work() {
    let folder = crate::documents::copy("examples");
    for made in
        [".local/share/bash-completion/completions", ".zfunc", ".config/fish/completions", ".local/share/man/man1"]
    {
        fs::create_dir_all(folder.join(made)).expect("a folder");
    }
    for (command, help) in pages() {
        let examples = examples(&help);
        assert!(!examples.is_empty(), "{command}: no example");
        // `cargo xtask verify certify` runs them all
        let tried_here = if shipped::is_exhaustive() { examples.len() } else { 1 };
        for example in &examples[..tried_here] {
            assert!(example.starts_with("rne ") && !example.contains("  "), "{command}: {example}");
            if command == "search" || command == "import" {
                continue; // minutes, and a URDF of the reader's: `search.rs` and `import.rs` have their own
            }
            let is_checked = example.contains(" -o ") || example.contains("--check");
            if command == "certify" && !is_checked && !shipped::is_exhaustive() {
                continue; // a compiler, an emulator and a checker for each of them
            }
            // all arms take long where the code is not optimised
            let typed = example.replace("robots/*.yaml", "robots/planar*.yaml");
            let typed = typed.replace("~/", "./").replace("| man -l -", "| cat");
            if crate::documents::lacks_program(&typed) {
                continue;
            }
            let output = crate::documents::typed(&folder, &typed);
            // the arm of the example is worn
            let is_event = typed.contains("_worn.csv") && output.status.code() == Some(1);
            assert!(output.status.success() || is_event, "{example}: {}", String::from_utf8_lossy(&output.stderr));
        }
    }
}

#[test]
fn shells_complete_words_that_helps_leave_out() {
    let words = ["inverse_dynamics_derivatives", "regrouping-targets", "seven_steps"];
    // the scripts of clap for the last two complete no words
    for (shell, words) in
        [("bash", &words[..]), ("zsh", &words), ("fish", &words), ("elvish", &[]), ("powershell", &[])]
    {
        let script = fine(&["completions", shell]);
        // fish writes an option without its dashes
        for word in words.iter().chain(&["base-omega-dot"]) {
            assert!(script.contains(word), "{shell}: no {word}");
        }
    }
    fails(2, &["completions", "cmd"], &["bash", "fish", "zsh"]);
}

#[test]
fn every_command_has_a_page_of_the_manual() {
    let folder = folder("man");
    let path = folder.to_str().expect("UTF-8");
    let called = crate::call::rne(&["man", "-o", path]);
    assert_eq!((called.status, called.out.as_str()), (0, ""));
    for command in commands() {
        let page = fs::read_to_string(folder.join(format!("rne-{command}.1"))).expect("a page");
        assert_eq!(page, fine(&["man", &command]), "the same page, the same bytes");
        assert!(page.contains(&format!(".TH rne-{command} 1")) && page.contains("Examples:"), "{page}");
    }
    assert!(fs::read_to_string(folder.join("rne.1")).expect("a page").contains("rne\\-search(1)"));
    fails(2, &["man", "nothing"], &["rne-nothing has no page", "check, show, emit"]);
    // what is no page of these stays, unless told otherwise
    fs::write(folder.join("rne.1"), "precious").expect("a file");
    fails(2, &["man", "-o", path], &["rne.1 exists and is not changed", "--force"]);
    assert_eq!(fs::read_to_string(folder.join("rne.1")).expect("a file"), "precious");
    assert_eq!(crate::call::rne(&["man", "-o", path, "--force"]).status, 0);
    // a folder that is not there yet is made, and not where a file is in its way
    let new = folder.join("share/man1");
    assert_eq!(crate::call::rne(&["man", "-o", new.to_str().expect("UTF-8")]).status, 0);
    assert!(new.join("rne-eval.1").exists());
    let below_a_file = folder.join("rne.1/man1");
    fails(1, &["man", "-o", below_a_file.to_str().expect("UTF-8")], &["Not a directory"]);
}
