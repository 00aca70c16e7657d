//! The emitted Rust and C of every shipped robot are, byte for byte, those of the list `tests/frozen.txt`.
//!
//! Each line of the list is the SHA-256 of the files of one robot, form and function: Rust, C with `float`, C with
//! `double`. A change of the compiler that is meant to change no emitted byte is held to that here. One that is meant
//! to renews the list by `cargo xtask frozen --update`, and the difference of the list says what it changed.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use rne_codegen::{Compiler, Form, Function};
use rne_emit::{Precision, Prefix};
use rne_model::Robot;
use rne_robots::{ROBOTS, RobotFile};
use rne_search::PlanFile;
use sha2::{Digest, Sha256};

/// From what is emitted, as `ROBOT FORM FUNCTION`, to its hash.
type Frozen = BTreeMap<String, String>;

fn list() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/frozen.txt"))
}

/// The hash of everything that is emitted for one function in one form.
fn hash(compiler: &Compiler<'_>, robot: &Robot, function: Function, form: Form) -> String {
    let program = compiler.compile(function, form).unwrap_or_else(|error| panic!("{} {function}: {error}", robot.name));
    let programs = [program];
    let c = |precision| {
        let code = rne_emit::c_code(robot, &programs, precision, &Prefix::of(robot));
        code.unwrap_or_else(|error| panic!("{} {function}: {error}", robot.name)).one_file()
    };
    let mut hash = Sha256::new();
    for file in [rne_emit::rust_file(robot, &programs), c(Precision::Single), c(Precision::Double)] {
        // the length keeps two files apart
        hash.update((file.len() as u64).to_le_bytes());
        hash.update(file);
    }
    hash.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// All functions of a robot in both forms; with its rotors too, where it has them.
fn frozen_of(file: &RobotFile) -> Frozen {
    let robot = Robot::from_yaml(file.yaml).unwrap_or_else(|report| panic!("{report}"));
    let with_rotors = robot.clone().with_rotors();
    let arms = [("", &robot), ("+rotors", &with_rotors)];
    let mut frozen = Frozen::new();
    for (suffix, robot) in arms.into_iter().filter(|(suffix, robot)| suffix.is_empty() || robot.has_rotors()) {
        let compiler = Compiler::new(robot);
        let compiler = match file.plan {
            Some(plan) => {
                let plan = PlanFile::read(file.name, plan, robot).unwrap_or_else(|report| panic!("{report}"));
                compiler.with_plans(plan)
            }
            None => compiler,
        };
        for form in Form::ALL {
            for function in Function::OF_TREES {
                let key = format!("{}{suffix} {form} {function}", robot.name);
                frozen.insert(key, hash(&compiler, robot, function, form));
            }
        }
    }
    frozen
}

fn frozen_now(robots: &[&'static RobotFile]) -> Frozen {
    let next = AtomicUsize::new(0);
    let frozen = Mutex::new(Frozen::new());
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(file) = robots.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let of_robot = frozen_of(file);
                    frozen.lock().expect("no thread panics while it holds the list").extend(of_robot);
                }
            });
        }
    });
    frozen.into_inner().expect("no thread has panicked")
}

fn committed() -> Frozen {
    let text = std::fs::read_to_string(list()).unwrap_or_default();
    let line = |line: &str| line.split_once("  ").map(|(hash, key)| (key.to_owned(), hash.to_owned()));
    text.lines()
        .map(|text| line(text).unwrap_or_else(|| panic!("a hash, two blanks, and what it is of: {text}")))
        .collect()
}

#[test]
fn emitted_code_is_the_frozen_one() {
    let robots: Vec<&RobotFile> = shipped::tried().collect();
    let now = frozen_now(&robots);
    if std::env::var_os("RNE_FROZEN_UPDATE").is_some() {
        assert_eq!(robots.len(), ROBOTS.len(), "the list is written of all robots: set RNE_EXHAUSTIVE, too");
        let text = now.iter().fold(String::new(), |mut text, (key, hash)| {
            let _ = writeln!(text, "{hash}  {key}");
            text
        });
        std::fs::write(list(), text).expect("the list can be written");
    }
    let is_asked = |key: &String| {
        let name = key.split([' ', '+']).next().unwrap_or_default();
        robots.iter().any(|file| file.name == name)
    };
    let mut committed = committed();
    committed.retain(|key, _| is_asked(key));
    println!("{} emitted texts of {} robots", now.len(), robots.len());
    let keys: BTreeSet<&String> = now.keys().chain(committed.keys()).collect();
    let other: Vec<&str> =
        keys.into_iter().filter(|key| now.get(*key) != committed.get(*key)).map(String::as_str).collect();
    assert!(other.is_empty(), "{} emitted texts are not those of tests/frozen.txt:\n{}", other.len(), other.join("\n"));
}
