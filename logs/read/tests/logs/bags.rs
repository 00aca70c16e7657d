//! Public bags: extracts of a UR10's log and a Panda's.

use std::path::{Path, PathBuf};

use rne_logs::{Format, Motion, Options};

use crate::written::{runs, survey};

pub(crate) fn bag(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

#[test]
fn the_bags_say_what_they_are() {
    let (log, ur10) = survey(&[bag("ur10.db3")], Options::default()).unwrap();
    let layout = log.layout();
    assert_eq!((layout.format, layout.topic.as_deref()), (Format::Sqlite, Some("/joint_states")));
    let names = ["shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3"];
    assert_eq!(layout.joints, names.map(|name| format!("{name}_joint")));
    assert!(layout.has_velocities && layout.has_efforts && !layout.recorded);
    assert_eq!((layout.step, ur10.run_count, ur10.counts.states), (0.008, 1, 460));
    assert!(ur10.disagreement.iter().all(|share| *share < 0.05), "{:?}", ur10.disagreement);

    let (log, panda) = survey(&[bag("panda.db3")], Options::default()).unwrap();
    assert_eq!(log.layout().joints[6], "fer_joint7");
    assert_eq!((panda.run_count, panda.counts.states), (1, 300));
    assert!((1.0 / log.layout().step - 30.0).abs() < 0.01);
    // its stamps are more even than its samples were
    assert!(panda.disagreement.iter().all(|share| *share > 0.1), "{:?}", panda.disagreement);
}

/// `golden.py` is another program: numpy.
#[test]
fn filtered_extracts_are_those_of_numpy() {
    let text = std::fs::read_to_string(bag("golden.csv")).unwrap();
    let mut compared = 0;
    for (name, cutoff) in [("ur10", 8.0), ("panda", 5.0)] {
        for measured in [true, false] {
            let options = Options { cutoff: Some(cutoff), derive_velocities: !measured, ..Options::default() };
            let found = runs(&[bag(&format!("{name}.db3"))], options, 50).unwrap();
            let [(0, motion)] = &found[..] else { panic!("{} runs", found.len()) };
            let mut last = 0.0;
            for line in text.lines().filter(|line| line.starts_with(&format!("{name},{}", u8::from(measured)))) {
                let numbers: Vec<f64> = line.split(',').skip(2).map(|cell| cell.parse().unwrap()).collect();
                let Motion { time, q, qd, qdd, tau, .. } = motion;
                let i = time.iter().position(|time| (time - numbers[0]).abs() < 1e-6).unwrap();
                let joint = numbers[1] as usize;
                let found = [q[joint][i], qd[joint][i], qdd[joint][i], tau[joint][i]];
                for (found, wanted) in found.iter().zip(&numbers[2..]) {
                    assert!((found - wanted).abs() < 1e-9 * wanted.abs().max(1.0), "{line}: {found}");
                    compared += 1;
                }
                last = numbers[0];
            }
            assert!((motion.time[motion.len() - 1] - last).abs() < 1e-6, "the last state is numpy's last");
        }
    }
    assert!(compared > 1000, "{compared}");
}
