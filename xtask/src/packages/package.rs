//! Checks that the packages are complete, and that the README's examples work with the packages alone.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::Args;
use tempfile::TempDir;
use xshell::{Shell, cmd};

use crate::Verdict;
use crate::machine;

/// Packages every crate as a registry would take it, and runs the README's examples with the packages alone
///
/// A new crate adds rne and has the README's examples of Control; the packaged command line runs the commands of
/// Control, Logs, Firmware and Teaching: in a folder that knows nothing of this repository. The firmware runs where
/// QEMU is, and is built elsewhere.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when a command fails, or when the crate and the command line print other torques.

Example:
  cargo xtask package")]
pub(crate) struct Package {
    /// Keep the folder of the crate that has nothing else, and print where it is
    #[arg(long)]
    keep: bool,
}

/// The crates that are published, in the order of their dependencies.
pub(crate) const CRATES: [&str; 21] = [
    "rne-functions",
    "rne-model",
    "rne-robots",
    "rne-runtime",
    "rne-codegen",
    "rne-search",
    "rne-emit",
    "rne-macro",
    "rne-machine",
    "rne-diagnose",
    "rne-inspection",
    "rne-symbolic",
    "rne-report",
    "rne",
    "rne-convert",
    "rne-plot",
    "rne-logs",
    "rne-identify",
    "rne-watch",
    "rne-certify",
    "rne-cli",
];

impl Package {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let packages = Packages::made(&shell)?;
        let config = packages.folder.path().join(".cargo/config.toml");
        // a packaged crate is a workspace of its own, so it gets the patches from the file of configuration
        let manifest = packages.folder.path().join(format!("rne-cli-{}/Cargo.toml", packages.version));
        let build = packages.target.path();
        machine::without_flags(cmd!(shell, "cargo build --quiet --config {config} --manifest-path {manifest}"))
            .env("CARGO_TARGET_DIR", build)
            .run()?;
        let holds = packages.readme_holds(&shell, &build.join("debug"))?;
        if self.keep {
            println!("packages: {}", packages.folder.keep().display());
        }
        Ok(Verdict::from(holds))
    }
}

/// The packages of all crates, unpacked in a folder where cargo takes them in place of those of the registry.
pub(crate) struct Packages {
    pub(crate) folder: TempDir,
    /// The folder of their compiled code. It is new in each run: otherwise cargo would reuse what it built and unpacked
    /// there from an older package of the same version.
    target: TempDir,
    pub(crate) version: String,
}

impl Packages {
    /// Makes the packages, as files in `package` of the target folder, too.
    pub(crate) fn made(shell: &Shell) -> Result<Self> {
        let target = tempfile::Builder::new().prefix("packaged-").tempdir_in(machine::target_folder("target")?)?;
        let licences = Licences::copied(shell)?;
        // `--no-verify`, because the examples compile all packages anyway
        let published = CRATES.iter().flat_map(|name| ["--package", name]);
        machine::without_flags(cmd!(shell, "cargo package {published...} --allow-dirty --no-verify --quiet"))
            .env("CARGO_TARGET_DIR", target.path())
            .run()?;
        drop(licences);
        let (folder, version) = (tempfile::tempdir()?, version()?);
        let mut patch = String::from("[patch.crates-io]\n");
        for name in CRATES {
            let package = target.path().join(format!("package/{name}-{version}.crate"));
            let _ = writeln!(patch, "{name} = {{ path = '{}' }}", unpacked(shell, &package, folder.path())?.display());
        }
        fs::create_dir(folder.path().join(".cargo"))?;
        fs::write(folder.path().join(".cargo/config.toml"), patch)?;
        Ok(Self { folder, target, version })
    }

    /// The files that a registry takes, in the order of their dependencies.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let package = |name| self.target.path().join(format!("package/{name}-{}.crate", self.version));
        CRATES.into_iter().map(package).collect()
    }

    /// Runs the README's examples in a new folder, with the command `rne` of another one.
    pub(crate) fn readme_holds(&self, shell: &Shell, programs: &Path) -> Result<bool> {
        let readme = machine::read("README.md")?;
        let place = tempfile::tempdir_in(self.folder.path())?;
        let path = std::env::var_os("PATH").unwrap_or_default();
        let folders = [programs.to_owned()].into_iter().chain(std::env::split_paths(&path));
        let _path = shell.push_env("PATH", std::env::join_paths(folders).context("PATH")?);
        let _target = shell.push_env("CARGO_TARGET_DIR", place.path().join("target"));
        let _folder = shell.push_dir(place.path());
        let mut holds = self.own_crate_holds(shell, &readme)?;
        fs::create_dir_all(place.path().join("home/docs"))?;
        for file in desk_arm()? {
            fs::copy(machine::root().join(&file), place.path().join("home").join(&file))?;
        }
        let _folder = shell.push_dir("home");
        for section in ["Control", "Logs", "Firmware", "Teaching"] {
            let script = commands(&readme, section)?;
            let run = machine::without_flags(cmd!(shell, "sh -e -c {script}").quiet().ignore_status()).output()?;
            let says = if run.status.success() { "its commands run" } else { "FAILS" };
            println!("packages: {section}: {says}");
            if !run.status.success() {
                print!("{script}{}", String::from_utf8_lossy(&run.stderr));
                holds = false;
            }
        }
        Ok(holds)
    }

    /// Makes a crate with the README's programs in Rust, and compares the torques of the first with those of the
    /// command line.
    fn own_crate_holds(&self, shell: &Shell, readme: &str) -> Result<bool> {
        cmd!(shell, "cargo new --quiet own").quiet().run()?;
        let _folder = shell.push_dir("own");
        let start = Instant::now();
        // `cargo add` asks the registry alone, and not the patches
        let rne = self.folder.path().join(format!("rne-{}", self.version));
        machine::without_flags(cmd!(shell, "cargo add --quiet --path {rne}")).quiet().run()?;
        let builtin = |text: &str| text.replace("path = \"../robots/puma560.yaml\"", "builtin = \"puma560\"");
        shell.write_file("src/main.rs", builtin(block(readme, "```rust")?))?;
        let derived = machine::without_flags(cmd!(shell, "cargo run --quiet")).quiet().read()?;
        let seconds = start.elapsed().as_secs_f64();
        println!("packages: `cargo add rne` and the README's first program, nothing compiled before: {seconds:.1} s");
        shell.write_file("src/bin/control.rs", builtin(&machine::read("examples/control.rs")?))?;
        machine::without_flags(cmd!(shell, "cargo run --quiet --bin control")).quiet().ignore_stdout().run()?;

        let (q, qd, qdd) = ("0.1,-0.4,0.3,1.2,-0.7,0.5", ["0.5"; 6].join(","), ["1.0"; 6].join(","));
        let evaluated = cmd!(shell, "rne eval puma560 --q {q} --qd {qd} --qdd {qdd} --json").quiet().read()?;
        let (derived, evaluated) = (numbers(&derived)?, numbers(&evaluated)?);
        println!("packages: a crate of them alone prints {derived:?}, the command line {evaluated:?}");
        let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= 0.5001e-4; // the README prints four digits
        Ok(derived.len() == 6 && evaluated.len() == 6 && derived.iter().zip(&evaluated).all(is_near))
    }
}

/// The robot and the logs of the README's section Logs, from the folder of the repository.
pub(crate) fn desk_arm() -> Result<Vec<PathBuf>> {
    let files = fs::read_dir(machine::root().join("docs"))?.map_while(Result::ok).map(|file| file.file_name());
    let files = files.filter(|name| name.to_string_lossy().starts_with("desk_arm"));
    Ok(files.map(|name| Path::new("docs").join(name)).collect())
}

/// The text of a document with the commands and the links of somebody who has no clone.
pub(crate) fn of_release(text: &str) -> String {
    let pages = concat!(env!("CARGO_PKG_REPOSITORY"), "/blob/main/");
    let add = "add `[dependencies] rne = { path = \"CLONE\" }`, where CLONE is the folder of your clone.";
    let text = text.replace("In a clone, `cargo run -- COMMAND` runs `rne COMMAND`.\n\n", "");
    let text = text.replace(add, "type `cargo add rne`.").replace("cargo run -- ", "rne ").replace("--rne-path . ", "");
    let is_page = |link: &str| !link.starts_with("http") && !link.starts_with('#');
    let mut parts = text.split("](");
    let mut written = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let _ = write!(written, "]({}{part}", if is_page(part) { pages } else { "" });
    }
    written
}

/// The commands of a section of the README, for a folder that is no clone.
fn commands(readme: &str, section: &str) -> Result<String> {
    let (_, text) = readme.split_once(&format!("\n## {section}\n")).with_context(|| section.to_owned())?;
    let mut commands = of_release(block(text, "```sh")?);
    if !machine::has("qemu-system-arm") {
        commands = commands.replace("cargo run --release", "cargo build --release");
    }
    let mut script = String::from("finds() { \"$@\" || test $? -eq 1; }\n");
    for line in commands.lines().filter(|line| !line.starts_with("sudo ")) {
        // its exit status 1 says that it has found something
        let _ = writeln!(script, "{}{line}", if line.starts_with("rne watch") { "finds " } else { "" });
    }
    Ok(script)
}

/// The first block of a document that a line begins.
fn block<'a>(document: &'a str, begin: &str) -> Result<&'a str> {
    let (_, rest) = document.split_once(&format!("{begin}\n")).context("a block")?;
    Ok(rest.split("```").next().unwrap_or_default())
}

/// Copies of the licences beside the manifest of each package. They exist while packages are made: the repository
/// has the licences once.
pub(crate) struct Licences(Vec<PathBuf>);

impl Licences {
    pub(crate) fn copied(shell: &Shell) -> Result<Self> {
        let manifests = cmd!(shell, "git ls-files */Cargo.toml").quiet().read()?;
        let mut copies = Self(Vec::new());
        for folder in manifests.lines().filter_map(|manifest| Path::new(manifest).parent()) {
            for name in ["LICENSE-APACHE", "LICENSE-MIT"] {
                let copy = shell.current_dir().join(folder).join(name);
                fs::copy(shell.current_dir().join(name), &copy)?;
                copies.0.push(copy);
            }
        }
        Ok(copies)
    }
}

impl Drop for Licences {
    fn drop(&mut self) {
        for copy in &self.0 {
            let _ = fs::remove_file(copy);
        }
    }
}

/// Returns the version that all published crates share.
fn version() -> Result<String> {
    let manifest = machine::read("Cargo.toml")?;
    let line = manifest.lines().find_map(|line| line.strip_prefix("version = "));
    Ok(line.context("Cargo.toml has a version")?.trim_matches('"').to_owned())
}

/// Unpacks a package into a folder and returns the path of its content.
fn unpacked(shell: &Shell, package: &Path, folder: &Path) -> Result<PathBuf> {
    if !package.is_file() {
        bail!("there is no package {}", package.display());
    }
    cmd!(shell, "tar -xzf {package} -C {folder}").quiet().run()?;
    let name = package.file_stem().context("a package has a name")?;
    Ok(folder.join(name))
}

/// Returns the numbers in a text, without the words, brackets and commas around them.
fn numbers(text: &str) -> Result<Vec<f64>> {
    let words = text.split(|c: char| c.is_whitespace() || "[]{},:".contains(c));
    let numbers = words.filter(|word| word.starts_with(|c: char| c.is_ascii_digit() || c == '-'));
    numbers.map(|word| word.parse::<f64>().with_context(|| word.to_owned())).collect()
}
