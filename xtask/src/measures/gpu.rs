//! Assembles kernels of PTX and counts registers, bytes that are spilled to memory, and instructions.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};

/// Assembles the torques of every shipped arm for three generations of NVIDIA's processors, and some other functions
///
/// Needs ptxas, NVIDIA's assembler: that of the path, or the one of the package nvidia-cuda-nvcc-cu12 of PyPI. It is
/// used here and never shipped.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when torques of an arm of six or seven joints need more than 128 registers in single precision, or
numbers of them find no register; 2 when there is no assembler.

Examples:
  cargo xtask gpu                       a table
  cargo xtask gpu --update              write the table into docs/control/gpu.md
  cargo xtask gpu --install             get the assembler into target/tools first; takes 40 MB")]
pub(crate) struct Gpu {
    /// Write the table into docs/control/gpu.md
    #[arg(long)]
    update: bool,
    /// Get the assembler with pip
    #[arg(long)]
    pub(crate) install: bool,
}

const PAGE: &str = "docs/control/gpu.md";
/// The lines before and after the table.
const MARKS: [&str; 2] = ["<!-- cargo xtask gpu --update -->\n", "<!-- end -->"];
const PACKAGE: &str = "nvidia-cuda-nvcc-cu12==12.*";
const PROCESSORS: [&str; 3] = ["sm_70", "sm_80", "sm_90"];
const MOST_REGISTERS: usize = 128;

/// Functions besides the torques of arms: pairs of a robot file and a function of it.
const OTHERS: [(&str, &str); 8] = [
    ("robots/panda.yaml", "mass_matrix"),
    ("robots/panda.yaml", "forward_dynamics"),
    ("robots/panda.yaml", "inverse_dynamics_derivatives"),
    ("robots/panda.yaml", "rollout"),
    ("robots/puma560.yaml", "rollout"),
    ("benches/trees/g1.yaml", "inverse_dynamics"),
    ("benches/trees/g1_floating.yaml", "inverse_dynamics_of_floating_base"),
    ("benches/trees/g1_floating.yaml", "floating_forward_dynamics"),
];

/// Measures of a kernel that was assembled for a processor.
struct Assembled {
    registers: usize,
    /// Bytes that are written to memory because too few registers are free.
    spilled: usize,
    instructions: usize,
}

impl Gpu {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let ptxas = self.assembler()?;
        machine::without_flags(cmd!(shell, "cargo build --quiet --bin rne")).quiet().run()?;
        let rne = machine::target_folder("target")?.join("debug/rne");
        let folder = tempfile::tempdir()?;
        let mut verdict = Verdict::Holds;
        let mut table =
            "| robot | function | type | registers (sm_70, sm_80, sm_90) | bytes spilled | instructions |\n\
             |---|---|---|---:|---:|---:|\n"
                .to_owned();
        let arms = shipped_arms()?;
        let torques = arms.iter().map(|path| (path.as_str(), "inverse_dynamics"));
        for (path, function) in torques.chain(OTHERS) {
            for (real, name) in [("float", "f32"), ("double", "f64")] {
                let text = folder.path().join("kernel.ptx");
                let asked = if function == "rollout" { vec!["--rollout"] } else { vec!["--function", function] };
                cmd!(shell, "{rne} emit {path} --lang ptx {asked...} --real {real} --output {text} --force")
                    .quiet()
                    .ignore_stderr()
                    .run()?;
                let robot = Path::new(path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let found = PROCESSORS.map(|processor| assembled(&ptxas, processor, function, &text, folder.path()));
                let found: Vec<Assembled> = found.into_iter().collect::<Result<_>>()?;
                let joints = machine::read(path)?.matches("dh:").count();
                let is_judged = function == "inverse_dynamics" && name == "f32" && (6..=7).contains(&joints);
                if is_judged && found.iter().any(|one| one.spilled > 0 || one.registers > MOST_REGISTERS) {
                    println!("gpu: {robot}: too many registers");
                    verdict = Verdict::Fails;
                }
                let row = |of: fn(&Assembled) -> usize| {
                    found.iter().map(|one| of(one).to_string()).collect::<Vec<_>>().join(", ")
                };
                let line = format!(
                    "| {robot} | {function} | {name} | {} | {} | {} |",
                    row(|one| one.registers),
                    row(|one| one.spilled),
                    row(|one| one.instructions)
                );
                println!("{line}");
                // the page shows torques and rollouts of one arm, and every kernel that spills
                let is_shown = robot == "panda" && ["inverse_dynamics", "rollout"].contains(&function);
                if is_shown || found.iter().any(|one| one.spilled > 0) {
                    let _ = writeln!(table, "{line}");
                }
            }
        }
        if self.update {
            let page = machine::read(PAGE)?;
            let [begin, end] = MARKS;
            let (before, rest) = page.split_once(begin).with_context(|| format!("{PAGE} has no {begin}"))?;
            let (_, after) = rest.split_once(end).with_context(|| format!("{PAGE} has no {end}"))?;
            machine::write(PAGE, &format!("{before}{begin}\n{table}\n{end}{after}"))?;
        }
        Ok(verdict)
    }

    fn assembler(&self) -> Result<PathBuf> {
        if machine::has("ptxas") {
            return Ok("ptxas".into());
        }
        let folder = machine::target_folder("target")?.join("tools/nvcc");
        let ptxas = folder.join("nvidia/cuda_nvcc/bin/ptxas");
        if !ptxas.exists() && self.install {
            let status = Command::new("python3")
                .args(["-m", "pip", "install", "--quiet", "--no-deps", "--target"])
                .arg(&folder)
                .arg(PACKAGE)
                .stdout(Stdio::null())
                .status();
            if !status.is_ok_and(|status| status.success()) {
                return Err(Missing::error(format!("pip does not get {PACKAGE}")));
            }
        }
        if ptxas.exists() { Ok(ptxas) } else { Err(Missing::error("there is no ptxas (--install gets it)")) }
    }
}

/// Returns the paths of all shipped robot files, sorted by name.
fn shipped_arms() -> Result<Vec<String>> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(machine::root().join("robots")).context("robots/")? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        if name.strip_suffix(".yaml").is_some_and(|robot| !robot.contains('.')) {
            paths.push(format!("robots/{name}"));
        }
    }
    paths.sort();
    Ok(paths)
}

/// Assembles a file of kernels. Returns the measures of the kernel that reads columns, of a function or a rollout.
fn assembled(ptxas: &Path, processor: &str, function: &str, text: &Path, folder: &Path) -> Result<Assembled> {
    let code = folder.join("kernel.cubin");
    let output = Command::new(ptxas)
        .args(["--verbose", "--gpu-name", processor])
        .arg(text)
        .arg("--output-file")
        .arg(&code)
        .output()?;
    let said = String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
    if !output.status.success() {
        bail!("{}: {said}", text.display());
    }
    let end = format!("{function}_columns");
    let of_columns = said.split("Compiling entry function").find(|part| part.contains(&format!("{end}' for")));
    let of_columns = of_columns.with_context(|| format!("no kernel of columns: {said}"))?;
    let number_before = |words: &str| {
        let before = of_columns.split(words).next()?;
        before.split_whitespace().next_back()?.parse().ok()
    };
    let spilled: Option<usize> = number_before(" bytes spill stores");
    let registers: Option<usize> = number_before(" registers");
    let instructions =
        instructions(&fs::read(&code)?, end.as_bytes()).context("the code has no section of the kernel")?;
    Ok(Assembled {
        registers: registers.with_context(|| said.clone())?,
        spilled: spilled.with_context(|| said.clone())?,
        instructions,
    })
}

/// Counts the instructions of the kernel whose name ends with `end`, in an ELF file. Each instruction has 16 bytes.
fn instructions(code: &[u8], end: &[u8]) -> Option<usize> {
    let number = |at: usize, bytes: usize| -> Option<usize> {
        let bytes = code.get(at..at + bytes)?;
        bytes.iter().rev().try_fold(0_usize, |number, byte| number.checked_mul(256)?.checked_add((*byte).into()))
    };
    let (sections, size, count, names) = (number(0x28, 8)?, number(0x3A, 2)?, number(0x3C, 2)?, number(0x3E, 2)?);
    let names = number(sections + names * size + 0x18, 8)?;
    for index in 0..count {
        let header = sections + index * size;
        let name = code.get(names + number(header, 4)?..)?;
        let name = name.split(|byte| *byte == 0).next()?;
        if name.starts_with(b".text.") && name.ends_with(end) {
            return Some(number(header + 0x20, 8)? / 16);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::instructions;

    #[test]
    fn what_is_no_code_has_no_instructions() {
        assert_eq!(instructions(b"no ELF", b""), None);
        assert_eq!(instructions(&[0; 64], b""), None);
    }
}
