//! A crate that derives a robot, in a folder of its own.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use rne_codegen::Form;

const TIME: &str = "/usr/bin/time";

/// The crate of a user, changed before every build.
pub(crate) struct Crate {
    folder: PathBuf,
    program: String,
}

impl Crate {
    /// A crate that derives a chain and calls its torques, with its dependencies built in both profiles.
    pub(crate) fn new(yaml: &str, joints: usize, form: Form) -> Self {
        let user = Self::of("../chain.yaml", &["InverseDynamics"], &["inverse_dynamics(q, qd, qdd)"], joints, form);
        fs::write(user.folder.join("chain.yaml"), yaml).expect("the robot file");
        user
    }

    /// A crate that derives capabilities of a robot file and makes calls with arguments `q`, `qd`, `qdd`; a relative
    /// path starts at the source of the crate.
    pub(crate) fn of(file: &str, capabilities: &[&str], calls: &[&str], joints: usize, form: Form) -> Self {
        let package = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("benches is a folder of rne");
        let folder = target().join("chain");
        let manifest = format!(
            "[package]\nname = \"chain\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[dependencies]\n\
             rne = {{ path = '{}', default-features = false }}\n\n[workspace]\n",
            package.display()
        );
        let arguments = format!("q: &[f64; {joints}], qd: &[f64; {joints}], qdd: &[f64; {joints}]");
        let mut program = format!(
            "use rne::*;\n\n#[derive({})]\n#[robot(path = \"{file}\", form = \"{form}\")]\npub struct Chain;\n",
            capabilities.join(", ")
        );
        for (number, call) in calls.iter().enumerate() {
            let _ = write!(
                program,
                "\n#[inline(never)]\npub fn call{number}({arguments}) {{\n    \
                 std::hint::black_box(Chain.{call});\n}}\n"
            );
        }
        fs::create_dir_all(folder.join("src")).expect("a folder for sources");
        fs::write(folder.join("Cargo.toml"), manifest).expect("the manifest");
        // The versions that are at hand, since they built the workspace.
        fs::copy(package.join("Cargo.lock"), folder.join("Cargo.lock")).expect("the workspace's lock file");
        let user = Self { folder, program };
        for profile in ["dev", "release"] {
            user.write("pub struct Chain;\n");
            assert!(user.run_cargo(profile), "the dependencies do not compile");
        }
        user
    }

    fn write(&self, program: &str) {
        fs::write(self.folder.join("src/lib.rs"), program).expect("the program");
    }

    /// Builds the crate anew, as after a change of its source. Whether that succeeds.
    pub(crate) fn build(&self, profile: &str) -> bool {
        self.write(&self.program);
        self.run_cargo(profile)
    }

    fn object(&self) -> PathBuf {
        self.folder.join("chain.o")
    }

    fn run_cargo(&self, profile: &str) -> bool {
        // GNU time says how much memory the largest process below it took.
        let measured = Path::new(TIME).exists().then(|| Command::new(TIME)).map(|mut time| {
            time.args(["-f", "%M", "-o"]).arg(self.folder.join("memory")).arg(env!("CARGO"));
            time
        });
        let output = measured
            .unwrap_or_else(|| Command::new(env!("CARGO")))
            .args(["rustc", "--offline", "--quiet", "--lib", "--profile", profile, "--target-dir"])
            .arg(target().join("target"))
            .args(["--", "-C", "codegen-units=1", "--emit"])
            .arg(format!("obj={}", self.object().display()))
            .current_dir(&self.folder)
            .env_remove("RUSTFLAGS")
            .env_remove("CARGO_ENCODED_RUSTFLAGS")
            // as a user has it, not as .cargo/config.toml here
            .env("CARGO_PROFILE_DEV_DEBUG", "true")
            .output()
            .expect("cargo runs");
        if !output.status.success() {
            eprintln!("{}", String::from_utf8_lossy(&output.stderr));
        }
        output.status.success()
    }

    /// Megabytes of the largest process of the last build, which is the compiler; not a number without GNU time.
    pub(crate) fn most_memory(&self) -> f64 {
        let text = fs::read_to_string(self.folder.join("memory")).unwrap_or_default();
        text.trim().parse().map_or(f64::NAN, |kilobytes: f64| kilobytes * 1024e-6)
    }

    /// Bytes of the executable sections of the object file that was built last; only in the format ELF, of 64 bits.
    pub(crate) fn code_size(&self) -> u64 {
        const EXECUTABLE: u64 = 4;
        let bytes = fs::read(self.object()).expect("the object file");
        assert!(bytes.starts_with(b"\x7fELF\x02\x01"), "code size is read from 64-bit little-endian ELF only");
        let number = |at: usize, length: usize| {
            bytes[at..at + length].iter().rev().fold(0_u64, |number, &byte| number << 8 | u64::from(byte))
        };
        let index = |at, length| usize::try_from(number(at, length)).expect("an index");
        let (start, size, count) = (index(0x28, 8), index(0x3a, 2), index(0x3c, 2));
        let sections = (0..count).map(|section| start + section * size);
        sections
            .filter(|section| number(section + 8, 8) & EXECUTABLE != 0)
            .map(|section| number(section + 0x20, 8))
            .sum()
    }
}

/// A folder of this program's own in the target folder.
fn target() -> PathBuf {
    let program = std::env::current_exe().expect("the path of this program");
    program.parent().expect("the folder of the profile").join("growth.users")
}
