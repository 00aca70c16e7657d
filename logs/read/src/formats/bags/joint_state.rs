//! Decodes `sensor_msgs/msg/JointState` in the encoding of ROS 2.

use byteorder::{BigEndian, LittleEndian};
use serde::Deserialize;

use crate::formats::sample::Sample;
use crate::limits::{MOST_JOINTS, check_names};

/// The name of the message type that is read, as bags write it.
pub(crate) const TYPE: &str = "sensor_msgs/msg/JointState";

#[derive(Deserialize)]
struct JointState {
    header: Header,
    name: Vec<String>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    effort: Vec<f64>,
}

#[derive(Deserialize)]
struct Header {
    stamp: Time,
    #[serde(rename = "frame_id")]
    _frame_id: String,
}

#[derive(Deserialize)]
struct Time {
    sec: i32,
    nanosec: u32,
}

/// Decodes a message, which begins with four bytes that give its encoding. `Err` is the reason if it cannot be read.
pub(crate) fn decode(bytes: &[u8], recorded: i64, sample: &mut Sample) -> Result<(), String> {
    let [_, kind, _, _, message @ ..] = bytes else {
        return Err(format!("it has {} bytes, less than the four bytes that give its encoding", bytes.len()));
    };
    let decoded: Result<(JointState, usize), _> = match (bytes[0], kind) {
        (0, 0) => cdr_encoding::from_bytes::<_, BigEndian>(message),
        (0, 1) => cdr_encoding::from_bytes::<_, LittleEndian>(message),
        (first, second) => {
            return Err(format!("its encoding {first:#04x} {second:#04x} is not plain CDR, 0x00 0x00 or 0x00 0x01"));
        }
    };
    let (JointState { header, name, position, velocity, effort }, _) =
        decoded.map_err(|error| format!("it is not a {TYPE}: {error}"))?;
    check_names(name.iter().map(String::as_str))?;
    for (list, numbers) in [("positions", &position), ("velocities", &velocity), ("efforts", &effort)] {
        if numbers.len() > MOST_JOINTS {
            return Err(format!("it has {} {list}; rne reads at most {MOST_JOINTS}", numbers.len()));
        }
    }
    sample.measured = i64::from(header.stamp.sec) * 1_000_000_000 + i64::from(header.stamp.nanosec);
    sample.recorded = recorded;
    (sample.names, sample.position, sample.velocity, sample.effort) = (name, position, velocity, effort);
    Ok(())
}
