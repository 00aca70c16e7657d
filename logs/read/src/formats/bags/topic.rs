//! Chooses the topic of a bag that is read.

use std::path::Path;

use crate::LogError;
use crate::formats::bags::joint_state::TYPE;
use crate::remedy::Setting;
use crate::spelling::{instead, listed};

/// Returns the index of the topic to read: the wanted one, or the only one with joint states. `topics` has names and
/// types.
pub(crate) fn choose(path: &Path, topics: &[(String, String)], wanted: Option<&str>) -> Result<usize, LogError> {
    let is_state = |place: &usize| is_joint_state(&topics[*place].1);
    let states: Vec<usize> = (0..topics.len()).filter(is_state).collect();
    let names = || listed(states.iter().map(|place| &topics[*place].0));
    if let Some(wanted) = wanted {
        let Some(place) = topics.iter().position(|(name, _)| name == wanted) else {
            let near = instead(wanted, topics.iter().map(|(name, _)| name));
            let there = if states.is_empty() {
                "no topic has joint states".to_owned()
            } else {
                format!("joint states are in {}", names())
            };
            return Err(LogError::request(path, format_args!("there is no topic {wanted}{near}; {there}")));
        };
        let kind = &topics[place].1;
        if !is_joint_state(kind) {
            let there = if states.is_empty() { String::new() } else { format!("; joint states are in {}", names()) };
            return Err(LogError::request(path, format_args!("the topic {wanted} has {kind}, not {TYPE}{there}")));
        }
        return Ok(place);
    }
    match states[..] {
        [place] => Ok(place),
        [] => {
            let all = topics.iter().map(|(name, kind)| format!("{name} ({kind})")).collect::<Vec<_>>();
            let all = if all.is_empty() {
                "the log has no topics".to_owned()
            } else {
                format!("the topics are {}", listed(&all))
            };
            Err(LogError::file(path, format_args!("no topic has {TYPE}; {all}")))
        }
        _ => {
            let error = LogError::request(path, format_args!("several topics have joint states: {}", names()));
            Err(error.give(Setting::Topic))
        }
    }
}

/// Whether a type is that of joint states. Other spellings than that of ROS 2 occur, too.
pub(crate) fn is_joint_state(kind: &str) -> bool {
    kind == TYPE || kind == "sensor_msgs/JointState" || kind == "sensor_msgs::msg::dds_::JointState_"
}
