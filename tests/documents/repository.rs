//! Rules of the repository that a text of its sources shows.

use std::collections::BTreeSet;
use std::path::PathBuf;

use rne_codegen::What;

use crate::{files_below, read, robot, robot_files, root};

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

/// The Rust files of the repository, from its root, whose text says one of these words.
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
    // the events of a driver for processors of graphics are times
    assert_eq!(found, ["tests/compile_time.rs", "tests/fake_driver/src/lib.rs"]);
}

#[test]
fn unsafe_stands_in_few_modules() {
    let mut found = files_that_say(&[concat!("allow(", "unsafe_code)"), concat!("expect(", "unsafe_code)")]);
    found.retain(|name| {
        [
            "cli/",
            "compiler/",
            "doors/c/src/",
            "doors/gpu/",
            "doors/playground/",
            "doors/python/src/",
            "firmware/certify/",
            "import/",
            "logs/",
            "rne-",
            "src/",
            "teaching/",
        ]
        .iter()
        .any(|folder| name.starts_with(folder))
    });
    // pointers of C become slices, an export has a name, and launches on a card have addresses that a caller vouches
    // for
    let expected = [
        "compiler/machine/src/native.rs",
        "doors/c/src/border.rs",
        "doors/gpu/src/arm.rs",
        "doors/gpu/src/driver.rs",
        "doors/playground/src/border.rs",
        "doors/python/src/gpu.rs",
        "doors/python/src/xla/border.rs",
        "rne-runtime/src/lanes/registers/mod.rs",
    ];
    assert_eq!(found, expected);
}

#[test]
fn the_compiler_opens_no_file_and_prints_nothing() {
    let mut sources = Vec::new();
    files_below(&root().join("compiler/codegen/src"), ".rs", &mut sources);
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
    let names: Vec<String> = robot_files("robots").iter().map(|path| robot(path).name).collect();
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

/// A search of the reference for a name of another program finds the method.
#[test]
fn methods_have_the_other_names_of_the_table() {
    let mut files = Vec::new();
    files_below(&root().join("rne-runtime/src/capability"), ".rs", &mut files);
    let traits: String = files.iter().map(|path| read(path)).collect();
    for what in What::ALL {
        let found = traits.split_once(&format!("    fn {}(", what.name()));
        let Some((before, _)) = found else { panic!("no trait has {}", what.name()) };
        let lines =
            before.lines().rev().map_while(|line| line.trim().strip_prefix("#[doc(alias = \"")?.strip_suffix("\")]"));
        let aliases: BTreeSet<&str> = lines.collect();
        assert_eq!(aliases, what.aliases().iter().copied().collect(), "{}", what.name());
    }
}
