//! Tasks for this repository besides `cargo build` and `cargo test`.
//!
//! Each subcommand is a module of this crate, and its `--help` says what it needs and what it takes. This crate is not
//! published. `.ci/run` lists the tasks that must succeed before a change is merged.

mod certificate;
mod certify_all;
mod derivatives;
mod doors;
mod fmu;
mod frozen;
mod fuzz;
mod loops;
mod machine;
mod measures;
mod mutants;
mod mutate;
mod packages;
mod page;
mod surface;
mod tool;
mod urdf;
mod verify;
mod writing;

use measures::{batch_profile, gpu, growth, instructions, performance, tree_counts};
use packages::{bare, capi, features, fleet, light, package, playground, python, release, ros2, sbom, site};
use writing::{lines, prose};

use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};

use crate::machine::Missing;

/// Certificates, counts, measurements and mutants of this repository
#[derive(Parser)]
#[command(
    name = "cargo xtask",
    bin_name = "cargo xtask",
    after_help = "\
Exit status: 0 what was looked at holds, 1 it does not, 2 it could not be looked at or the arguments are wrong.

Examples:
  cargo xtask certificate --install    the code of microcontrollers, with the tools that it takes
  cargo xtask mutate Coriolis          is that term tested?
  cargo xtask lines                    lines of more than 120 columns"
)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    Certificate(certificate::Certificate),
    CertifyAll(certify_all::CertifyAll),
    Instructions(instructions::Instructions),
    Performance(performance::Performance),
    Bare(bare::Bare),
    BatchProfile(batch_profile::BatchProfile),
    Growth(growth::Growth),
    Mutate(mutate::Mutate),
    Verify(verify::Verify),
    Light(light::Light),
    Lines(lines::Lines),
    Loops(loops::Loops),
    Derivatives(derivatives::Derivatives),
    Prose(prose::Prose),
    Package(package::Package),
    Tool(tool::Tool),
    TreeCounts(tree_counts::TreeCounts),
    Features(features::Features),
    Fleet(fleet::Fleet),
    Sbom(sbom::Sbom),
    Frozen(frozen::Frozen),
    Surface(surface::Surface),
    Doors(doors::Doors),
    Fuzz(fuzz::Fuzz),
    Gpu(gpu::Gpu),
    Urdf(urdf::Urdf),
    Python(python::Python),
    Release(release::Release),
    Ros2(ros2::Ros2),
    Capi(capi::Capi),
    Page(page::Page),
    Playground(playground::Playground),
    Site(site::Site),
    Fmu(fmu::Fmus),
}

/// The result of a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    /// The check succeeded.
    Holds,
    /// The check failed, and the reasons have been printed.
    Fails,
}

impl From<bool> for Verdict {
    fn from(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::Fails }
    }
}

impl Task {
    /// Runs the task. Returns its name for messages, whether it may install what it needs, and its result.
    fn run(&self) -> (&'static str, bool, Result<Verdict>) {
        match self {
            Self::Certificate(task) => ("embedded certificate", task.install, task.run()),
            Self::CertifyAll(task) => ("certify-all", task.install, task.run()),
            Self::Instructions(task) => ("instruction counts", task.install, task.run()),
            Self::Performance(task) => ("performance", false, task.run()),
            Self::Bare(task) => ("bare", false, task.run()),
            Self::BatchProfile(task) => ("batch profile", false, task.run()),
            Self::Growth(task) => ("growth", false, task.run()),
            Self::Mutate(task) => ("mutate", false, task.run()),
            Self::Verify(task) => ("verify", task.install, task.run()),
            Self::Light(task) => ("light", false, task.run()),
            Self::Lines(task) => ("lines", false, task.run()),
            Self::Loops(task) => ("loops", false, task.run()),
            Self::Derivatives(task) => ("derivatives", false, task.run()),
            Self::Prose(task) => ("prose", false, task.run()),
            Self::Package(task) => ("package", false, task.run()),
            Self::Tool(task) => ("tool", task.install, task.run()),
            Self::TreeCounts(task) => ("tree counts", false, task.run()),
            Self::Fleet(_) => ("fleet", false, fleet::Fleet::run()),
            Self::Sbom(task) => ("sbom", false, task.run()),
            Self::Frozen(task) => ("frozen", false, task.run()),
            Self::Surface(task) => ("surface", false, task.run()),
            Self::Doors(task) => ("doors", task.install, task.run()),
            Self::Gpu(task) => ("gpu", task.install, task.run()),
            Self::Fuzz(task) => ("fuzz", false, task.run()),
            Self::Features(features) => ("features", false, features.run()),
            Self::Urdf(task) => ("urdf", task.install, task.run()),
            Self::Python(task) => ("python", task.install, task.run()),
            Self::Release(task) => ("release", false, task.run()),
            Self::Ros2(task) => ("ros2", task.install, task.run()),
            Self::Capi(task) => ("capi", task.install, task.run()),
            Self::Page(task) => ("page", task.install, task.run()),
            Self::Playground(task) => ("playground", task.install, task.run()),
            Self::Site(task) => ("site", task.install, task.run()),
            Self::Fmu(task) => ("fmu", task.install, task.run()),
        }
    }
}

fn main() -> ExitCode {
    let (name, installs, result) = Arguments::parse().task.run();
    match result {
        Ok(Verdict::Holds) => ExitCode::SUCCESS,
        Ok(Verdict::Fails) => ExitCode::FAILURE,
        Err(error) if error.is::<Missing>() => {
            println!("{name}: skipped, {error}");
            // a missing tool is no failure if the task was allowed to install it and could not
            ExitCode::from(if installs { 0 } else { 2 })
        }
        Err(error) => {
            eprintln!("{name}: {error:#}");
            ExitCode::from(2)
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::Arguments;

    #[test]
    fn every_task_says_what_it_does_and_shows_an_example() {
        let mut command = Arguments::command();
        command.build();
        for task in command.get_subcommands_mut().filter(|task| task.get_name() != "help") {
            let help = task.render_long_help().to_string();
            assert!(help.contains("Example"), "{help}");
            assert!(help.contains(&format!("cargo xtask {}", task.get_name())), "{help}");
        }
    }
}
