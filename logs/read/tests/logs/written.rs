//! Logs that tests write.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use rne_logs::{Log, LogError, Motion, Motions, Options, Survey};
use tempfile::TempDir;

/// A file with this content, and the folder that goes with it.
pub(crate) fn file(name: &str, content: impl AsRef<[u8]>) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    (folder, path)
}

/// A sum of sines, and its derivatives.
#[derive(Clone, Copy)]
pub(crate) struct Sine {
    pub(crate) amplitude: f64,
    /// Hz
    pub(crate) frequency: f64,
    pub(crate) phase: f64,
}

impl Sine {
    /// Position, velocity, acceleration.
    pub(crate) fn at(&self, time: f64) -> [f64; 3] {
        let w = 2.0 * PI * self.frequency;
        let (sin, cos) = (w * time + self.phase).sin_cos();
        [self.amplitude * sin, self.amplitude * w * cos, -self.amplitude * w * w * sin]
    }
}

pub(crate) const SINES: [Sine; 2] =
    [Sine { amplitude: 0.8, frequency: 0.7, phase: 0.3 }, Sine { amplitude: -0.5, frequency: 1.9, phase: 1.1 }];

/// A CSV of the two sines at these times; torques are 3 q + 2.
pub(crate) fn csv(times: &[f64]) -> String {
    let mut text = "time,q1,q2,qd1,qd2,tau1,tau2\n".to_owned();
    for time in times {
        let [a, b] = SINES.map(|sine| sine.at(*time));
        let (tau, other) = (3.0 * a[0] + 2.0, 3.0 * b[0] + 2.0);
        writeln!(text, "{time:.9},{},{},{},{},{tau},{other}", a[0], b[0], a[1], b[1]).unwrap();
    }
    text
}

pub(crate) fn survey(paths: &[PathBuf], options: Options) -> Result<(Log, Survey), LogError> {
    let log = Log::open(paths, options)?;
    let survey = log.survey(|_| ())?;
    Ok((log, survey))
}

/// Every run, its pieces joined.
pub(crate) fn runs(paths: &[PathBuf], options: Options, length: usize) -> Result<Vec<(u64, Motion)>, LogError> {
    let (log, survey) = survey(paths, options)?;
    joined(log.motions(&survey)?.with_length(length))
}

/// The same with the ends of runs.
pub(crate) fn whole_runs(paths: &[PathBuf], options: Options, length: usize) -> Result<Vec<(u64, Motion)>, LogError> {
    let (log, survey) = survey(paths, options)?;
    joined(log.motions(&survey)?.with_length(length).with_ends())
}

fn joined(pieces: Motions<'_>) -> Result<Vec<(u64, Motion)>, LogError> {
    let mut runs: Vec<(u64, Motion)> = Vec::new();
    for piece in pieces {
        let piece = piece?;
        match runs.last_mut() {
            Some((run, motion)) if *run == piece.run => {
                motion.time.extend(piece.motion.time);
                let lists = [
                    (&mut motion.q, piece.motion.q),
                    (&mut motion.qd, piece.motion.qd),
                    (&mut motion.qdd, piece.motion.qdd),
                    (&mut motion.tau, piece.motion.tau),
                    (&mut motion.recorded, piece.motion.recorded),
                ];
                for (all, more) in lists {
                    all.iter_mut().zip(more).for_each(|(all, more)| all.extend(more));
                }
            }
            _ => runs.push((piece.run, piece.motion)),
        }
    }
    Ok(runs)
}

/// A message of `sensor_msgs/msg/JointState`, written by the rules of CDR: numbers stand at multiples of their size,
/// counted from behind the four bytes of the encoding.
#[cfg(feature = "full")]
pub(crate) fn joint_state(time: i64, names: &[&str], lists: [&[f64]; 3], is_little: bool) -> Vec<u8> {
    let mut bytes = vec![];
    let align = |bytes: &mut Vec<u8>, to: usize| bytes.resize(bytes.len().next_multiple_of(to), 0);
    let number = |bytes: &mut Vec<u8>, number: u32| {
        align(bytes, 4);
        bytes.extend(if is_little { number.to_le_bytes() } else { number.to_be_bytes() });
    };
    let text = |bytes: &mut Vec<u8>, text: &str| {
        number(bytes, text.len() as u32 + 1);
        bytes.extend(text.as_bytes());
        bytes.push(0);
    };
    number(&mut bytes, time.div_euclid(1_000_000_000) as u32);
    number(&mut bytes, time.rem_euclid(1_000_000_000) as u32);
    text(&mut bytes, "base");
    number(&mut bytes, names.len() as u32);
    for name in names {
        text(&mut bytes, name);
    }
    for list in lists {
        number(&mut bytes, list.len() as u32);
        for x in list {
            align(&mut bytes, 8);
            bytes.extend(if is_little { x.to_le_bytes() } else { x.to_be_bytes() });
        }
    }
    [vec![0, u8::from(is_little), 0, 0], bytes].concat()
}

/// The rows of [`csv`]: time, positions, velocities, torques.
#[cfg(feature = "full")]
pub(crate) fn rows(times: &[f64]) -> Vec<(f64, [[f64; 2]; 3])> {
    let row = |time: &f64| {
        let [a, b] = SINES.map(|sine| sine.at(*time));
        (*time, [[a[0], b[0]], [a[1], b[1]], [3.0 * a[0] + 2.0, 3.0 * b[0] + 2.0]])
    };
    times.iter().map(row).collect()
}
