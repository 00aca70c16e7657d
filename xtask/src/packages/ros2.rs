//! Tests the ROS 2 node, `doors/ros2/`, a workspace of its own.

use anyhow::Result;
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};
use crate::packages::python::Place;

/// Python packages of the program that talks to the node in the test.
const REQUIREMENTS: &str = "doors/ros2/peer/requirements.txt";

/// Tests the ROS 2 node, alone and against Eclipse Cyclone DDS
///
/// First clippy and the tests without DDS. Then a program in Python with Cyclone DDS publishes joint states of the PUMA
/// 560 at 1 kHz, and reads the torques and the diagnostics of the node: no message may be lost, and each torque must be
/// that of `rne eval`. All of it is on the loopback interface, without multicast. No ROS 2 is needed.
#[derive(Args)]
#[command(after_help = "\
Needs python3 with venv; cyclonedds and numpy are fetched into target/python.

Examples:
  cargo xtask ros2 --install               a minute at 1 kHz
  cargo xtask ros2 --seconds 5             as a first test")]
pub(crate) struct Ros2 {
    /// Install cyclonedds and numpy with pip, below target/
    #[arg(long)]
    pub(crate) install: bool,
    /// How long joint states are published, s
    #[arg(long, value_name = "S", default_value_t = 60, value_parser = clap::value_parser!(u32).range(2..=3600))]
    seconds: u32,
}

impl Ros2 {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let manifest = "doors/ros2/Cargo.toml";
        machine::fetch(&shell, manifest)?;
        let folder = machine::target_folder("target")?.join("ros2");
        let arguments = ["--release", "--manifest-path", manifest, "--locked", "--target-dir"];
        let holds = cmd!(shell, "cargo clippy --all-targets {arguments...} {folder} -- -D warnings").run().is_ok()
            && cmd!(shell, "cargo test {arguments...} {folder}").run().is_ok();
        if !holds {
            return Ok(Verdict::Fails);
        }
        let place = Place::new()?;
        let python = place.environment("ros2")?;
        if cmd!(shell, "{python} -c 'import cyclonedds, numpy'").quiet().ignore_stderr().run().is_err() {
            if !self.install {
                return Err(Missing::error("there is no cyclonedds; `cargo xtask ros2 --install` gets it"));
            }
            if !place.pip(&python, &["-r", REQUIREMENTS]) {
                return Err(Missing::error(format!("the packages of {REQUIREMENTS} cannot be fetched")));
            }
        }
        cmd!(shell, "cargo build {arguments...} {folder}").run()?;
        machine::without_flags(cmd!(shell, "cargo build --quiet --locked --bin rne")).quiet().run()?;
        let (node, rne) = (folder.join("release/rne-ros2"), machine::target_folder("target")?.join("debug/rne"));
        let seconds = self.seconds.to_string();
        let exchange = "doors/ros2/peer/exchange.py";
        let exchanged = cmd!(shell, "{python} -B {exchange} --node {node} --rne {rne} --seconds {seconds}");
        Ok(Verdict::from(exchanged.run().is_ok()))
    }
}
