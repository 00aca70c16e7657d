//! The C library: installs it below a prefix, and compiles and runs programs of C and C++ against it.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use xshell::{Shell, cmd};

use crate::Verdict;
use crate::machine::{self, Missing};

/// System libraries with which a program must link a static library of Rust.
const SYSTEM: &str = "-lgcc_s -lutil -lrt -lpthread -lm -ldl -lc";

/// Debian packages for the tests: valgrind, which checks memory accesses, and two programs that find installed
/// libraries.
const PACKAGES: [&str; 3] = ["valgrind", "cmake", "pkg-config"];

/// Options for the sanitizers that find accesses outside of memory, memory that is not freed, and undefined behaviour.
const SANITIZERS: [&str; 4] =
    ["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer", "-g"];

/// Warnings that the compilation of the examples must not give.
const STRICT: [&str; 4] = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"];

/// The folder of headers that replace those of ros2_control, for the example of a controller.
const STUB: &str = "-Idoors/c/tests/ros2_stub";

/// Builds the C library, lays it out below a prefix, and runs programs of C and C++ against it
///
/// The prefix gets include/rne.h, lib/librne.so, lib/librne.a, and what pkg-config and CMake read. Then the examples, a
/// program of sixteen threads, one that forks and a controller of ros2_control with a stub of ROS are compiled against
/// it and run, under valgrind where it is there, and with the compiler's sanitizers of addresses, leaks and undefined
/// behaviour.
#[derive(Args)]
#[command(after_help = "\
Needs cc and c++; skips valgrind, the sanitizers, pkg-config and CMake, each with one line, where they are not there.

Examples:
  cargo xtask capi                        with what is there, below target/capi/prefix
  cargo xtask capi --install              Debian's valgrind, cmake and pkg-config first
  cargo xtask capi --prefix ~/.local      for your own programs")]
pub(crate) struct Capi {
    /// Get Debian's valgrind, cmake and pkg-config
    #[arg(long)]
    pub(crate) install: bool,
    /// Where include/ and lib/ go [default: target/capi/prefix]
    #[arg(long, value_name = "DIR")]
    prefix: Option<PathBuf>,
}

impl Capi {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        for compiler in ["cc", "c++"] {
            if !machine::has(compiler) {
                return Err(Missing::error(format!("there is no {compiler}")));
            }
        }
        if self.install
            && let Err(error) = machine::packages(&PACKAGES, true)
        {
            println!("capi: {error}");
        }
        let prefix = built(&self.prefix.clone().map_or_else(prefix, Ok)?)?;
        println!("capi: {}", prefix.display());
        let programs = machine::target_folder("target")?.join("capi/programs");
        fs::create_dir_all(&programs)?;
        Ok(Verdict::from(holds(&shell, &prefix, &programs)? && cmake(&shell, &prefix, &programs)?))
    }
}

/// Returns the default prefix of the installed library.
pub(crate) fn prefix() -> Result<PathBuf> {
    Ok(machine::target_folder("target")?.join("capi/prefix"))
}

/// Builds the library and installs it below a prefix. Returns the absolute path of the prefix.
pub(crate) fn built(prefix: &Path) -> Result<PathBuf> {
    let shell = machine::shell()?;
    let (folder, (profile, built)) = (machine::target_folder("target")?, machine::profile()?);
    fs::create_dir_all(prefix).with_context(|| prefix.display().to_string())?;
    let prefix = prefix.canonicalize()?;
    let build = cmd!(
        shell,
        "cargo build --quiet --profile {profile} --locked --manifest-path doors/c/Cargo.toml --target-dir {folder}"
    );
    machine::without_flags(build).quiet().run()?;
    lay_out(&folder.join(built), &prefix)?;
    Ok(prefix)
}

/// Returns the file name of the shared library on this system.
fn shared() -> String {
    format!("librne{}", std::env::consts::DLL_SUFFIX)
}

/// Copies header and libraries below the prefix, and writes the files with which pkg-config and CMake find them.
fn lay_out(built: &Path, prefix: &Path) -> Result<()> {
    let copy = |from: &Path, to: &str| -> Result<()> {
        let to = prefix.join(to);
        fs::create_dir_all(to.parent().unwrap_or(prefix))?;
        fs::copy(from, &to).with_context(|| format!("{} to {}", from.display(), to.display()))?;
        Ok(())
    };
    let shared = shared();
    copy(&machine::root().join("doors/c/include/rne.h"), "include/rne.h")?;
    copy(&built.join(&shared), &format!("lib/{shared}"))?;
    copy(&built.join("librne.a"), "lib/librne.a")?;
    let manifest = machine::read("doors/c/Cargo.toml")?;
    let version = manifest.lines().find_map(|line| line.strip_prefix("version = \"")?.strip_suffix('"'));
    let version = version.context("doors/c/Cargo.toml has no version")?;
    for (folder, file) in
        [("lib/pkgconfig", "rne.pc"), ("lib/cmake/rne", "rneConfig.cmake"), ("lib/cmake/rne", "rneConfigVersion.cmake")]
    {
        let text = machine::read(&format!("doors/c/cmake/{file}.in"))?;
        // a list in CMake is separated by semicolons
        let system = if file == "rne.pc" { SYSTEM.to_owned() } else { SYSTEM.replace(' ', ";") };
        let text = text.replace("@VERSION@", version).replace("@SHARED@", &shared).replace("@SYSTEM@", &system);
        fs::create_dir_all(prefix.join(folder))?;
        fs::write(prefix.join(folder).join(file), text).with_context(|| file.to_owned())?;
    }
    Ok(())
}

/// Compiles the programs against the prefix and runs them. Returns whether all of them succeed.
fn holds(shell: &Shell, prefix: &Path, programs: &Path) -> Result<bool> {
    let library = prefix.join("lib");
    let mut flags = vec![format!("-I{}", prefix.join("include").display()), format!("-L{}", library.display())];
    flags.push("-lrne".to_owned());
    if machine::has("pkg-config") {
        let found = cmd!(shell, "pkg-config --cflags --libs rne").env("PKG_CONFIG_PATH", library.join("pkgconfig"));
        flags = found.quiet().read()?.split_whitespace().map(str::to_owned).collect();
    } else {
        println!("pkg-config: skipped, it is not there");
    }
    flags.push(STUB.to_owned());
    let has_valgrind = machine::has("valgrind");
    if !has_valgrind {
        println!("valgrind: skipped, it is not there");
    }
    let rpath = format!("-Wl,-rpath,{}", library.display());
    let archive = library.join("librne.a");
    let include = prefix.join("include");
    let system: Vec<&str> = SYSTEM.split(' ').collect();
    let sources = [
        ("doors/c/examples/torque.c", "cc", "-std=c11"),
        ("doors/c/examples/torque.cpp", "c++", "-std=c++17"),
        ("doors/c/examples/controller.c", "cc", "-std=c11"),
        ("doors/c/tests/threads.c", "cc", "-std=c11"),
        ("doors/c/tests/fork.c", "cc", "-std=c11"),
        ("doors/c/tests/ros2_control.cpp", "c++", "-std=c++17"),
    ];
    let sanitized = programs.join("sanitized");
    fs::create_dir_all(&sanitized)?;
    let has_sanitizers = has_sanitizers(shell, &sanitized)?;
    if !has_sanitizers {
        println!("sanitizers: skipped, cc and c++ have none");
    }
    let mut holds = true;
    for (source, compiler, standard) in sources {
        let name = Path::new(source).file_name().unwrap_or_default().to_string_lossy().replace('.', "_");
        let program = programs.join(&name);
        let flags = &flags;
        cmd!(shell, "{compiler} {standard} -O1 -g {STRICT...} {source} {flags...} -pthread {rpath} -o {program}")
            .quiet()
            .run()?;
        holds &= runs(shell, &program, has_valgrind)?;
        if has_sanitizers {
            let program = sanitized.join(&name);
            let compile = cmd!(shell, "{compiler} {standard} -O1 {SANITIZERS...} {STRICT...} {source} {flags...}");
            compile.args(["-pthread", &rpath, "-o"]).arg(&program).quiet().run()?;
            holds &= is_clean(shell, &program)?;
        }
    }
    // one program with the static library
    let program = programs.join("torque_static");
    let source = "doors/c/examples/torque.c";
    cmd!(shell, "cc -std=c11 {STRICT...} -I{include} {source} {archive} {system...} -o {program}").quiet().run()?;
    Ok(holds & runs(shell, &program, false)?)
}

/// Whether both compilers support the sanitizers and the program that they make runs here.
fn has_sanitizers(shell: &Shell, folder: &Path) -> Result<bool> {
    let (source, program) = (folder.join("empty.c"), folder.join("empty"));
    fs::write(&source, "int main(void) { return 0; }\n")?;
    Ok(["cc -xc", "c++ -xc++"].iter().all(|compiler| {
        let (compiler, language) = compiler.split_once(' ').unwrap_or_default();
        let compile = cmd!(shell, "{compiler} {language} {SANITIZERS...} {source} -o {program}").quiet();
        compile.ignore_stderr().run().is_ok() && cmd!(shell, "{program}").quiet().ignore_stderr().run().is_ok()
    }))
}

/// Runs a program that was compiled with the sanitizers. Returns whether they find nothing.
fn is_clean(shell: &Shell, program: &Path) -> Result<bool> {
    let name = program.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let run = cmd!(shell, "{program}").env("ASAN_OPTIONS", "detect_leaks=1:strict_string_checks=1");
    let output = run.quiet().ignore_status().output()?;
    let holds = output.status.success();
    println!("{name}: the sanitizers find {}", if holds { "nothing" } else { "fault" });
    if !holds {
        print!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    }
    Ok(holds)
}

/// Runs a program, and runs it again under valgrind if it is installed. Returns whether there is no error and no leak.
fn runs(shell: &Shell, program: &Path, has_valgrind: bool) -> Result<bool> {
    let name = program.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let output = cmd!(shell, "{program}").quiet().ignore_status().output()?;
    let mut holds = output.status.success();
    let mut told = if holds { "runs" } else { "fails" }.to_owned();
    if holds && has_valgrind {
        let check = cmd!(
            shell,
            "valgrind --quiet --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite {program}"
        );
        let checked = check.quiet().ignore_status().output()?;
        holds = checked.status.success();
        told += if holds { ", valgrind finds nothing" } else { ", valgrind finds fault" };
        if !holds {
            print!("{}", String::from_utf8_lossy(&checked.stderr));
        }
    }
    println!("{name}: {told}");
    if !holds {
        print!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    }
    Ok(holds)
}

/// Builds and tests the examples with CMake, which finds the library by find_package(rne), both shared and static.
fn cmake(shell: &Shell, prefix: &Path, programs: &Path) -> Result<bool> {
    if !machine::has("cmake") {
        println!("cmake: skipped, it is not there");
        return Ok(true);
    }
    let build = programs.join("cmake");
    let found = format!("-DCMAKE_PREFIX_PATH={}", prefix.display());
    cmd!(shell, "cmake -S doors/c/examples -B {build} {found}").quiet().ignore_stdout().run()?;
    cmd!(shell, "cmake --build {build}").quiet().ignore_stdout().run()?;
    let tested = cmd!(shell, "ctest --test-dir {build} --output-on-failure").quiet().ignore_status().output()?;
    let holds = tested.status.success();
    println!("cmake: {}", if holds { "find_package(rne) finds it, shared and static" } else { "fails" });
    if !holds {
        print!("{}", String::from_utf8_lossy(&tested.stdout));
    }
    Ok(holds)
}
