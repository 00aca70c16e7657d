//! Which of the shipped robots a plain `cargo test` tries.

use rne_robots::RobotFile;

/// Robots of six and seven joints that are tried: their structures differ, and several programs have computed them.
const LARGE: [&str; 3] = ["panda", "puma560", "stanford"];

/// Whether a test tries this robot where it does not try all: the robots of few joints, and some others.
pub(crate) fn is_tried(robot: &RobotFile) -> bool {
    robot.yaml.matches("dh:").count() <= 4 || LARGE.contains(&robot.name)
}
