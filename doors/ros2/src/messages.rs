//! The messages of ROS 2 that the node reads and writes. Each field is in the order of its `.msg` file, because CDR
//! contains no names.

use serde::{Deserialize, Serialize};

/// `builtin_interfaces/msg/Time`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Time {
    /// Seconds since 1970, or since the beginning of a simulation.
    pub sec: i32,
    /// Nanoseconds to add, 0 to 999 999 999.
    pub nanosec: u32,
}

impl Time {
    /// Nanoseconds.
    #[must_use]
    pub fn nanoseconds(self) -> i64 {
        i64::from(self.sec) * 1_000_000_000 + i64::from(self.nanosec)
    }

    /// The time of a number of nanoseconds; the nearest time that the message has.
    #[must_use]
    pub fn of_nanoseconds(nanoseconds: i64) -> Self {
        let sec = nanoseconds.div_euclid(1_000_000_000);
        let nanosec = u32::try_from(nanoseconds.rem_euclid(1_000_000_000)).unwrap_or_default();
        let last = if sec < 0 { i32::MIN } else { i32::MAX };
        Self { sec: i32::try_from(sec).unwrap_or(last), nanosec }
    }
}

/// `std_msgs/msg/Header`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// The time of the measurement of the joints.
    pub stamp: Time,
    /// A name of a frame; the node copies it.
    pub frame_id: String,
}

/// `sensor_msgs/msg/JointState`. Each list has one element for each name, or is empty.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointState {
    /// Stamp and frame.
    pub header: Header,
    /// Names of the joints.
    pub name: Vec<String>,
    /// rad or m.
    pub position: Vec<f64>,
    /// rad/s or m/s.
    pub velocity: Vec<f64>,
    /// N m or N.
    pub effort: Vec<f64>,
}

/// `diagnostic_msgs/msg/DiagnosticArray`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosticArray {
    /// When the diagnostics were written.
    pub header: Header,
    /// The diagnostics of the parts of the node.
    pub status: Vec<DiagnosticStatus>,
}

/// `diagnostic_msgs/msg/DiagnosticStatus`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosticStatus {
    /// One of [`OK`], [`WARN`], [`ERROR`] and [`STALE`].
    pub level: u8,
    /// The part of the node.
    pub name: String,
    /// The state of this part in one sentence, for people.
    pub message: String,
    /// The name of the robot.
    pub hardware_id: String,
    /// Counts and settings.
    pub values: Vec<KeyValue>,
}

/// `diagnostic_msgs/msg/KeyValue`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeyValue {
    /// The name of the value.
    pub key: String,
    /// The value.
    pub value: String,
}

/// Level of a part that works.
pub const OK: u8 = 0;
/// Level of a part that works with restrictions.
pub const WARN: u8 = 1;
/// Level of a part that does not work.
pub const ERROR: u8 = 2;
/// Level of a part that gets no messages.
pub const STALE: u8 = 3;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_its_nanoseconds() {
        for (sec, nanosec, nanoseconds) in [(0, 0, 0), (2, 5, 2_000_000_005), (-1, 999_999_999, -1)] {
            let time = Time { sec, nanosec };
            assert_eq!((time.nanoseconds(), Time::of_nanoseconds(nanoseconds)), (nanoseconds, time));
        }
        assert_eq!(Time::of_nanoseconds(i64::MAX).sec, i32::MAX);
        assert_eq!(Time::of_nanoseconds(i64::MIN).sec, i32::MIN);
        // no valid message has such a time, and the number does not overflow
        assert_eq!(Time { sec: i32::MAX, nanosec: u32::MAX }.nanoseconds(), 2_147_483_651_294_967_295);
    }
}
