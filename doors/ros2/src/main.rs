//! The program `rne-ros2`: a ROS 2 node for a robot arm.

use std::net::IpAddr;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Parser;
use rne_convert::Selection;
use rne_ros2::{Monitor, Settings, arm, node};

/// A ROS 2 node that computes gravity torques and external torques of a robot arm
///
/// The node reads joint states (sensor_msgs/JointState) and publishes three topics: /rne/gravity_torques and
/// /rne/external_torques (sensor_msgs/JointState with the names and efforts of the arm's joints), and /diagnostics
/// (diagnostic_msgs/DiagnosticArray, once per second). External torques need positions, velocities and efforts; a
/// momentum observer computes them. They are the torques of the environment on the arm.
///
/// Joints are matched by name, in any order and among other joints. If the message has as many joints with other names,
/// they are taken in the order of the message.
#[derive(Parser)]
#[command(
    name = "rne-ros2",
    version,
    after_help = "\
Examples:
  rne-ros2 puma560
  rne-ros2 panda.urdf --tip panda_hand --lock-others --topic /franka/joint_states
  rne-ros2 my_arm.yaml --joints shoulder,elbow,wrist --gain 10 --interface 127.0.0.1

Ctrl-C or SIGTERM ends the node. Exit status: 0 it was ended, 1 the arm or an
option is wrong or the node cannot start, 2 the arguments are wrong."
)]
struct Arguments {
    /// Robot file, URDF, or the name of a shipped robot
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Fixed link at the base of the arm, of a URDF [default: the root link]
    #[arg(long, value_name = "LINK")]
    base: Option<String>,
    /// Last link of the arm, of a URDF [default: the last link, if the URDF has only one end]
    #[arg(long, value_name = "LINK")]
    tip: Option<String>,
    /// Lock all movable joints of a URDF outside the arm at zero
    #[arg(long)]
    lock_others: bool,
    /// Names of the joints in the messages, base to tip [default: the names in FILE]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    joints: Option<Vec<String>>,
    /// Topic of the joint states
    #[arg(long, value_name = "TOPIC", default_value = "/joint_states")]
    topic: String,
    /// Name of the node; its topics are /NAME/gravity_torques and /NAME/external_torques
    #[arg(long, value_name = "NAME", default_value = "rne")]
    name: String,
    /// Low-pass filter of the external torques, Hz
    #[arg(long, value_name = "HZ", default_value_t = Settings::default().gain)]
    gain: f64,
    /// Do not use a message whose stamp differs by more than this from the clock, s; 0 accepts every stamp
    #[arg(long, value_name = "S", default_value_t = Settings::default().stale_after)]
    stale_after: f64,
    /// Start the external torques anew if two stamps are further apart than this, s
    #[arg(long, value_name = "S", default_value_t = Settings::default().gap)]
    gap: f64,
    /// Number of messages that publishers and subscription keep
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    depth: u32,
    /// Also read publishers whose reliability is best effort
    #[arg(long)]
    best_effort: bool,
    /// DDS domain, 0 to 232
    #[arg(long, value_name = "ID", env = "ROS_DOMAIN_ID", default_value_t = 0)]
    domain: u16,
    /// Address of the network interface to use, such as 127.0.0.1; may be repeated [default: all interfaces]
    #[arg(long, value_name = "ADDRESS")]
    interface: Vec<IpAddr>,
}

fn main() -> ExitCode {
    match run(Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("rne-ros2: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: Arguments) -> Result<(), String> {
    let Arguments { base, tip, lock_others, joints, gain, stale_after, gap, .. } = arguments;
    let selection = Selection { base, tip, lock_others, ..Selection::default() };
    let arm = arm::open(&arguments.file, selection)?;
    let (name, dof) = (arm.robot().name.clone(), arm.dof());
    let monitor = Monitor::new(arm, Settings { joints, gain, stale_after, gap })?;
    let options = node::Options {
        domain: arguments.domain,
        interfaces: arguments.interface,
        name: arguments.name,
        topic: arguments.topic,
        depth: arguments.depth as usize,
        best_effort: arguments.best_effort,
    };
    let is_ended = Arc::new(AtomicBool::new(false));
    let ended = Arc::clone(&is_ended);
    ctrlc::set_handler(move || ended.store(true, Ordering::Relaxed)).map_err(|error| error.to_string())?;
    node::run(monitor, &options, &is_ended, |[states, gravity, external, diagnostics]| {
        eprintln!("rne-ros2: {name}, {dof} joints: reads {states}, publishes {gravity}, {external}, {diagnostics}");
    })
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::Arguments;

    #[test]
    fn the_document_has_every_option() {
        let document = include_str!("../../../docs/control/ros2.md");
        for option in Arguments::command().get_arguments().filter_map(|argument| argument.get_long()) {
            assert!(document.contains(&format!("`--{option}")), "docs/control/ros2.md lacks --{option}");
        }
    }

    #[test]
    fn the_help_has_examples_that_are_read() {
        let help = Arguments::command().render_long_help().to_string();
        let examples: Vec<&str> = help.lines().filter(|line| line.starts_with("  rne-ros2 ")).collect();
        assert_eq!(examples.len(), 3, "{help}");
        for example in examples {
            Arguments::command().try_get_matches_from(example.split_whitespace()).expect(example);
        }
    }
}
