//! The emitted Rust and C of every shipped robot are, byte for byte, those of the list `tests/frozen.txt`: chains, and
//! trees, floating bases and closed loops with every function that they have.
//!
//! Each line of the list is the SHA-256 of the files of one robot, form and function: Rust, C with `float`, C with
//! `double`, or of the reason why there are none. A change of the compiler that is meant to change no emitted byte is
//! held to that here. One that is meant to renews the list by `cargo xtask frozen --update`, and the difference of the
//! list says what it changed.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use rne_codegen::{CheckFor, Compiler, Form, Function};
use rne_emit::{Precision, Prefix};
use rne_model::{Reader, Robot};
use rne_robots::ROBOTS;
use rne_search::PlanFile;
use sha2::{Digest, Sha256};

/// From what is emitted, as `ROBOT FORM FUNCTION`, to its hash.
type Frozen = BTreeMap<String, String>;

fn list() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/frozen.txt"))
}

/// A robot file, and its plan file if it has one.
struct Source {
    path: String,
    yaml: String,
    plan: Option<String>,
}

impl Source {
    /// The chains, and the other robots; without `RNE_EXHAUSTIVE` those of few joints.
    fn all() -> Vec<Self> {
        let chains = shipped::tried().map(|file| format!("robots/{}.yaml", file.name));
        let small = ["dual_arm", "four_bar", "gripper", "palletiser", "satellite", "tree"];
        let small = small.map(|name| format!("docs/{name}.yaml"));
        let large = ["docs/standing_hyq", "robots/trees/dex3_left", "robots/trees/wam7_coupled"];
        let large = large.into_iter().filter(|_| shipped::is_exhaustive()).map(|name| format!("{name}.yaml"));
        chains.chain(small).chain(large).map(Self::read).collect()
    }

    fn read(path: String) -> Self {
        let full = Path::new(env!("CARGO_MANIFEST_DIR")).join(&path);
        let yaml = std::fs::read_to_string(&full).unwrap_or_else(|error| panic!("{path}: {error}"));
        Self { yaml, plan: std::fs::read_to_string(full.with_extension("plan.yaml")).ok(), path }
    }

    fn name(&self) -> &str {
        Path::new(&self.path).file_stem().and_then(|stem| stem.to_str()).expect("a name")
    }
}

/// The hash of everything that is emitted for one function in one form.
fn hash(compiler: &Compiler<'_>, robot: &Robot, function: Function, form: Form) -> String {
    let files = match compiler.compile(function, form) {
        Ok(program) => {
            let programs = [program];
            let c = |precision| {
                let code = rne_emit::c_code(robot, &programs, precision, &Prefix::of(robot));
                code.map_or_else(|error| error.to_string(), |code| code.one_file())
            };
            vec![rne_emit::rust_file(robot, &programs), c(Precision::Single), c(Precision::Double)]
        }
        Err(error) => vec![error.to_string()],
    };
    let mut hash = Sha256::new();
    for file in files {
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
fn frozen_of(file: &Source) -> Frozen {
    let read = Reader::new(&file.path).trees().couplings().loops().read(&file.yaml);
    let robot = read.unwrap_or_else(|report| panic!("{report}")).robot;
    let functions: Vec<Function> = Function::ALL.into_iter().filter(|it| it.check_kind(&robot).is_ok()).collect();
    let with_rotors = robot.clone().with_rotors();
    let arms = [("", &robot), ("+rotors", &with_rotors)];
    let mut frozen = Frozen::new();
    for (suffix, robot) in arms.into_iter().filter(|(suffix, robot)| suffix.is_empty() || robot.has_rotors()) {
        let compiler = Compiler::new(robot);
        let compiler = match &file.plan {
            Some(plan) => {
                let plan = PlanFile::read(file.name(), plan, robot).unwrap_or_else(|report| panic!("{report}"));
                compiler.with_plans(plan)
            }
            None => compiler,
        };
        for form in Form::ALL {
            for &function in &functions {
                let key = format!("{}{suffix} {form} {function}", file.name());
                frozen.insert(key, hash(&compiler, robot, function, form));
            }
        }
    }
    frozen
}

fn frozen_now(robots: &[Source]) -> Frozen {
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
    let robots = Source::all();
    let now = frozen_now(&robots);
    if std::env::var_os("RNE_FROZEN_UPDATE").is_some() {
        assert!(
            robots.len() > ROBOTS.len() && shipped::is_exhaustive(),
            "the list is written of all robots: set RNE_EXHAUSTIVE, too"
        );
        let text = now.iter().fold(String::new(), |mut text, (key, hash)| {
            let _ = writeln!(text, "{hash}  {key}");
            text
        });
        std::fs::write(list(), text).expect("the list can be written");
    }
    let is_asked = |key: &String| {
        let name = key.split([' ', '+']).next().unwrap_or_default();
        robots.iter().any(|file| file.name() == name)
    };
    let mut committed = committed();
    committed.retain(|key, _| is_asked(key));
    println!("{} emitted texts of {} robots", now.len(), robots.len());
    let keys: BTreeSet<&String> = now.keys().chain(committed.keys()).collect();
    let other: Vec<&str> =
        keys.into_iter().filter(|key| now.get(*key) != committed.get(*key)).map(String::as_str).collect();
    assert!(other.is_empty(), "{} emitted texts are not those of tests/frozen.txt:\n{}", other.len(), other.join("\n"));
}
