//! `rne firmware`: what it writes into an empty folder is complete, is the firmware of the examples, and builds.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::call::{Called, ROOT, called, command, folder};

const TARGET: &str = "thumbv7em-none-eabihf";

fn read(path: impl AsRef<Path>) -> String {
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.as_ref().display()))
}

/// `rne firmware` as it is typed in a folder.
fn firmware(folder: &Path, arguments: &[&str]) -> Called {
    let mut command = command(&[&["firmware"], arguments].concat());
    called(command.current_dir(folder).output().expect("rne starts"))
}

/// The files below a folder, by their paths in it.
fn files(folder: &Path) -> BTreeSet<String> {
    let mut files = BTreeSet::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).expect("UTF-8").to_owned();
        if path.is_dir() {
            files.extend(self::files(&path).iter().map(|file| format!("{name}/{file}")));
        } else {
            files.insert(name);
        }
    }
    files
}

const FILES: [&str; 7] =
    [".cargo/config.toml", "Cargo.toml", "README.md", "build.rs", "memory.x", "robot.yaml", "src/main.rs"];

#[test]
fn a_firmware_is_written_once() {
    let empty = folder("firmware");
    let typed = ["torque", "--rne-path", ROOT];
    let Called { out, err, status } = firmware(&empty, &typed);
    assert_eq!((status, out.as_str()), (0, ""), "{err}");
    assert!(err.starts_with("robot: puma560\n"), "{err}");
    let written = empty.join("torque");
    let expected = FILES.into_iter().chain(["robot.plan.yaml"]).map(str::to_owned).collect();
    assert_eq!(files(&written), expected);
    for file in ["robot.yaml", "robot.plan.yaml"] {
        assert_eq!(read(written.join(file)), read(format!("{ROOT}/robots/{}", file.replace("robot.", "puma560."))));
    }
    let manifest = read(written.join("Cargo.toml"));
    assert!(manifest.contains("\nname = \"torque\"\n") && !manifest.contains("version = \"0.1\""), "{manifest}");
    assert!(manifest.contains(&format!("\nrne = {{ path = \"{ROOT}\", default-features = false }}\n")), "{manifest}");
    // the same commands, where they are read first and where they are read later
    let readme = read(written.join("README.md"));
    assert!(readme.starts_with("# torque\n\nTorques of the Unimate PUMA 560 "), "{readme}");
    for next in
        [&format!("rustup target add {TARGET}"), "sudo apt-get install --yes qemu-system-arm", "cargo run --release"]
    {
        assert!(err.contains(&format!("\n  {next}\n")) && readme.contains(&format!("\n{next}  ")), "{err}\n{readme}");
    }

    fs::remove_file(written.join("README.md")).expect("removed");
    let before = read(written.join("src/main.rs"));
    let again = firmware(&empty, &["torque", "--robot", "planar2", "--rne-path", ROOT]);
    assert_eq!(again.status, 2, "{again:?}");
    assert!(again.err.contains("torque is not empty and is not changed"), "{again:?}");
    assert_eq!((read(written.join("src/main.rs")), written.join("README.md").exists()), (before, false));
    fs::create_dir(empty.join("mine")).expect("a folder");
    assert_eq!(firmware(&empty, &["torque", "-o", "mine"]).status, 0, "an empty folder is as good as none");
}

#[test]
fn a_firmware_is_for_any_robot() {
    let empty = folder("firmware_of_robots");
    let of = |arguments: &[&str], folder: &str| {
        let called = firmware(&empty, arguments);
        assert_eq!(called.status, 0, "{called:?}");
        let written = empty.join(folder);
        (read(written.join("src/main.rs")), read(written.join("robot.yaml")), files(&written))
    };
    let shipped = |name: &str| read(format!("{ROOT}/robots/{name}.yaml"));
    // a name that is that of a robot
    let (main, yaml, _) = of(&["panda"], "panda");
    assert!(main.contains("const JOINTS: usize = 7;") && yaml == shipped("panda"), "{main}");
    let (main, yaml, _) = of(&["panda", "--robot", "planar2", "-o", "deep/er"], "deep/er");
    assert!(main.contains("const JOINTS: usize = 2;") && yaml == shipped("planar2"), "{main}");
    // a robot with branches whose second finger follows the first
    let gripper = format!("{ROOT}/docs/gripper.yaml");
    let (main, yaml, _) = of(&["grip", "--robot", &gripper], "grip");
    assert!(main.contains("const JOINTS: usize = 3;") && yaml == read(&gripper), "{main}");
    // a file without a plan
    fs::write(empty.join("arm.yaml"), shipped("planar1")).expect("written");
    let (main, yaml, files) = of(&["my-arm", "--robot", "arm.yaml"], "my-arm");
    assert!(main.contains("const JOINTS: usize = 1;") && yaml == shipped("planar1"), "{main}");
    assert_eq!(files, FILES.map(str::to_owned).into());
    // until it is told otherwise, of the version that is built here
    let version = env!("CARGO_PKG_VERSION").rsplit_once('.').expect("three numbers").0;
    let manifest = read(empty.join("my-arm/Cargo.toml"));
    assert!(
        manifest.contains(&format!("\nrne = {{ version = \"{version}\", default-features = false }}\n")),
        "{manifest}"
    );
}

#[test]
fn wrong_requests_for_a_firmware() {
    let empty = folder("firmware_refused");
    fs::write(empty.join("file"), "").expect("written");
    fs::write(empty.join("wrong.yaml"), "format: 1\nname: wrong\n").expect("written");
    for (status, arguments, said) in [
        (2, &["../torque"][..], "letters, digits, - and _"),
        (2, &["7arms"], "starts with a letter"),
        (2, &["rne"], "this name is reserved"),
        (2, &["cortex_m"], "this name is reserved"),
        (2, &["torque", "-o", "file"], "file is not a folder and is not changed"),
        (2, &["torque", "--rne-path", "."], "not a clone of the rne repository"),
        // misspelt names of shipped robots
        (2, &["ur55"], "did you mean --robot ur5?"),
        (2, &["puma"], "did you mean --robot puma560?"),
        (1, &["torque", "--robot", "nothing"], "there is no robot file nothing"),
        (1, &["torque", "--robot", "wrong.yaml"], "wrong.yaml"),
    ] {
        let called = firmware(&empty, arguments);
        assert_eq!(called.status, status, "{arguments:?}: {called:?}");
        assert!(called.err.contains(said), "{arguments:?}: {called:?}");
    }
    assert!(!empty.join("torque").exists() && !empty.join("ur55").exists(), "nothing is left behind");
    let called = firmware(&empty, &["ur55", "--robot", "ur5"]);
    assert!(called.status == 0 && called.err.starts_with("robot: ur5\n"), "{called:?}");
}

/// The template is typed once: `firmware/example`, which CI runs in QEMU, has its files. `RNE_WRITE_DOCUMENTS` writes
/// them anew.
#[test]
fn the_example_is_what_is_written() {
    let empty = folder("firmware_example");
    assert_eq!(firmware(&empty, &["firmware", "--robot", "puma560", "--rne-path", ROOT]).status, 0);
    let (written, example) = (empty.join("firmware"), Path::new(ROOT).join("firmware/example"));
    for (file, there) in [
        (".cargo/config.toml", ".cargo/config.toml"),
        ("memory.x", "memory.x"),
        ("build.rs", "build.rs"),
        ("src/main.rs", "src/bin/torque.rs"),
    ] {
        let text = read(written.join(file)).replace("\"../robot.yaml\"", "\"../../../../robots/puma560.yaml\"");
        if std::env::var_os("RNE_WRITE_DOCUMENTS").is_some() {
            fs::write(example.join(there), &text).expect("a writable file");
        }
        assert_eq!(
            read(example.join(there)),
            text,
            "{there}: RNE_WRITE_DOCUMENTS=1 cargo test -p rne-cli --test cli firmware"
        );
    }
    // The example has crates, lints and a licence on top.
    let manifest = read(example.join("Cargo.toml"));
    let ours = read(written.join("Cargo.toml")).replace(ROOT, "../..");
    let of_the_firmware = ours.lines().filter(|line| !line.starts_with('#') && !line.starts_with("version"));
    for line in of_the_firmware {
        assert!(manifest.lines().any(|there| there == line), "firmware/example/Cargo.toml has no line {line}");
    }
}

/// As `cargo run --release` builds it, where rustup's target and the crates are on this machine; elsewhere
/// `firmware/example/run --written`, in `.ci/run`, gets Debian's compiler.
#[test]
fn what_is_written_builds() {
    if !shipped::is_exhaustive() {
        eprintln!("skipped: cargo xtask verify certify builds the firmware");
        return;
    }
    let libraries = Command::new("rustc").args(["--print", "target-libdir", "--target", TARGET]).output();
    let libraries = libraries.ok().and_then(|output| String::from_utf8(output.stdout).ok()).unwrap_or_default();
    if !Path::new(libraries.trim()).is_dir() {
        eprintln!("skipped: there is no target {TARGET} (rustup target add {TARGET})");
        return;
    }
    let empty = folder("firmware_built");
    assert_eq!(firmware(&empty, &["torque", "--rne-path", ROOT]).status, 0);
    // the versions that the example has; what it has on top is dropped
    fs::copy(format!("{ROOT}/firmware/example/Cargo.lock"), empty.join("torque/Cargo.lock")).expect("a copy");
    let cargo = |arguments: &[&str]| {
        let mut cargo = Command::new("cargo");
        cargo.args(arguments).arg("--offline").current_dir(empty.join("torque"));
        cargo.env("CARGO_TARGET_DIR", empty.with_file_name("firmware_target"));
        cargo.env_remove("RUSTFLAGS").env_remove("CARGO_ENCODED_RUSTFLAGS").output().expect("cargo starts")
    };
    let fetched = cargo(&["fetch"]);
    if !fetched.status.success() {
        eprintln!(
            "skipped: its crates are not on this machine (cargo fetch --manifest-path firmware/example/Cargo.toml)"
        );
        return;
    }
    let built = cargo(&["build", "--release"]);
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
}
