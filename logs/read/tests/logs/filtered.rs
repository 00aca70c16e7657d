//! Filtered motions against the closed form of sines.

use std::f64::consts::PI;

use rne_logs::{Cutoff, Options};

use crate::written::{SINES, csv, file, runs, survey, whole_runs};

fn times(count: u32, rate: f64) -> Vec<f64> {
    (0..count).map(|i| f64::from(i) / rate).collect()
}

/// The pass band is flat to a thousandth, differences are derivatives to (ωT)⁸/630.
#[test]
fn sines_in_the_pass_band_come_out_with_their_derivatives() {
    for (rate, cutoff) in [(125.0, 8.0), (1000.0, 10.0), (30.0, 5.0)] {
        let (_folder, path) = file("sines.csv", csv(&times((rate * 12.0) as u32, rate)));
        for derive_velocities in [false, true] {
            let options = Options { cutoff: Some(cutoff), derive_velocities, ..Options::default() };
            let motions = runs(std::slice::from_ref(&path), options, 100_000).unwrap();
            assert_eq!(motions.len(), 1);
            let (_, motion) = &motions[0];
            assert!(motion.len() as f64 > rate * 9.0, "{}", motion.len());
            for (joint, sine) in SINES.iter().enumerate() {
                let w = 2.0 * PI * sine.frequency;
                // the ripple, and the differences', of one derivative and of two
                let ripple = 1e-3;
                let of_difference = (w / rate).powi(8) / 630.0;
                // stamps are whole nanoseconds
                let of_stamps = 1e-6;
                for (i, time) in motion.time.iter().enumerate() {
                    let [q, qd, qdd] = sine.at(*time);
                    let scale = sine.amplitude.abs();
                    let near = |found: f64, wanted: f64, scale: f64, relative: f64| {
                        let most = scale * (relative + of_stamps);
                        assert!((found - wanted).abs() < most, "{rate} {joint} {time}: {found} {wanted}");
                    };
                    near(motion.q[joint][i], q, scale, ripple);
                    near(motion.qd[joint][i], qd, scale * w, ripple + of_difference);
                    near(motion.qdd[joint][i], qdd, scale * w * w, ripple + 2.0 * of_difference);
                    near(motion.tau[joint][i], 3.0 * q + 2.0, 3.0 * scale, ripple);
                }
            }
        }
    }
}

/// What is far above the cut-off is gone, to a thousandth; where stamps jitter, too.
#[test]
fn noise_above_the_cutoff_is_stopped() {
    let mut text = "time,q1,tau1\n".to_owned();
    for i in 0..4000 {
        let time = f64::from(i) / 200.0;
        let fast = (2.0 * PI * 60.0 * time).sin();
        text += &format!("{time},{},{}\n", 1.0 + 0.05 * fast, 5.0 * fast);
    }
    let (_folder, path) = file("noise.csv", text);
    let options = Options { cutoff: Some(10.0), ..Options::default() };
    let motions = runs(&[path], options, 100_000).unwrap();
    let (_, motion) = &motions[0];
    for (q, tau) in motion.q[0].iter().zip(&motion.tau[0]) {
        assert!((q - 1.0).abs() < 0.05 * 1e-3 && tau.abs() < 5.0 * 1.1e-3, "{q} {tau}");
    }
    // and is in what was recorded
    assert_eq!(motion.recorded[0].len(), motion.len());
    for (time, recorded) in motion.time.iter().zip(&motion.recorded[0]) {
        let written = 5.0 * (2.0 * PI * 60.0 * time).sin();
        assert!((recorded - written).abs() < 1e-6, "{time}: {recorded} {written}");
    }
}

#[test]
fn jittering_stamps_are_resampled() {
    // a fifth of a step either way: the cubic of four neighbours is off by less than (ωT)⁴/16 or so
    let rate = 200.0;
    let mut random = fastrand::Rng::with_seed(3);
    let times: Vec<f64> = times(4000, rate)
        .iter()
        .map(|time| time + if *time > 0.0 { 0.4 * (random.f64() - 0.5) / rate } else { 0.0 })
        .collect();
    let (_folder, path) = file("jitter.csv", csv(&times));
    for derive_velocities in [false, true] {
        let options = Options { cutoff: Some(8.0), derive_velocities, ..Options::default() };
        let motions = runs(std::slice::from_ref(&path), options, 100_000).unwrap();
        let (_, motion) = &motions[0];
        for (joint, sine) in SINES.iter().enumerate() {
            let w = 2.0 * PI * sine.frequency;
            for (i, time) in motion.time.iter().enumerate() {
                let [q, qd, qdd] = sine.at(*time);
                let scale = sine.amplitude.abs() * 1.2e-3;
                assert!((motion.q[joint][i] - q).abs() < scale);
                assert!((motion.qd[joint][i] - qd).abs() < scale * w);
                assert!((motion.qdd[joint][i] - qdd).abs() < scale * w * w, "{} {qdd}", motion.qdd[joint][i]);
            }
        }
    }
}

/// Pieces, however long, are the whole, bit for bit.
#[test]
fn pieces_joined_are_the_whole() {
    let mut random = fastrand::Rng::with_seed(8);
    let mut time = 0.0;
    let times: Vec<f64> = (0..3000)
        .map(|i| {
            time += if i % 700 == 699 { 0.5 } else { 0.008 + 0.001 * random.f64() };
            time
        })
        .collect();
    let (_folder, path) = file("pieces.csv", csv(&times));
    let options = Options { cutoff: Some(9.0), ..Options::default() };
    let whole = runs(std::slice::from_ref(&path), options.clone(), usize::MAX / 2).unwrap();
    assert_eq!(whole.len(), 5);
    for length in [1, 7, 64, 500, 651] {
        assert_eq!(runs(std::slice::from_ref(&path), options.clone(), length).unwrap(), whole, "{length}");
    }
}

/// So they are where the filter is so wide that it is applied by blocks, which pieces are made of.
#[test]
fn pieces_of_a_wide_filter_are_the_whole() {
    let rate = 1000.0;
    let mut stamps = times(12_000, rate);
    stamps.extend((0..24_001).map(|i| 20.0 + f64::from(i) / rate));
    let (_folder, path) = file("wide.csv", csv(&stamps));
    let options = Options { cutoff: Some(2.0), ..Options::default() };
    for read in [runs, whole_runs] {
        let whole = read(std::slice::from_ref(&path), options.clone(), usize::MAX / 2).unwrap();
        assert_eq!(whole.len(), 2);
        for length in [1, 9000] {
            assert_eq!(read(std::slice::from_ref(&path), options.clone(), length).unwrap(), whole, "{length}");
        }
    }
}

/// With their ends runs have all their states: the inner ones as they were, and at the ends what the run's own point
/// reflection makes of them: the last state itself, and its slope.
#[test]
fn ends_are_kept_where_they_are_asked_for() {
    let rate = 100.0;
    let mut stamps = times(800, rate);
    // a run that is shorter than the filter, and another
    stamps.extend((0..20).map(|i| 10.0 + f64::from(i) / rate));
    stamps.extend((0..400).map(|i| 20.0 + f64::from(i) / rate));
    let (_folder, path) = file("ends.csv", csv(&stamps));
    let options = Options { cutoff: Some(8.0), ..Options::default() };
    let inner = runs(std::slice::from_ref(&path), options.clone(), 100_000).unwrap();
    let whole = whole_runs(std::slice::from_ref(&path), options.clone(), 100_000).unwrap();
    assert_eq!(whole.iter().map(|(run, motion)| (*run, motion.len())).collect::<Vec<_>>(), [(0, 800), (2, 400)]);
    for length in [1, 7, 64, 500, 799] {
        assert_eq!(whole_runs(std::slice::from_ref(&path), options.clone(), length).unwrap(), whole, "{length}");
    }
    for ((_, inner), (_, whole)) in inner.iter().zip(&whole) {
        let dropped = (whole.len() - inner.len()) / 2;
        let same = dropped..whole.len() - dropped;
        assert!((inner.time[0] - whole.time[dropped]).abs() < 1e-9);
        assert_eq!((&inner.q[1], &inner.qdd[1]), (&whole.q[1][same.clone()].to_vec(), &whole.qdd[1][same].to_vec()));
        for (joint, sine) in SINES.iter().enumerate() {
            for at in [0, whole.len() - 1] {
                let [q, qd, _] = sine.at(whole.time[at]);
                let found = [whole.q[joint][at], whole.qd[joint][at], whole.tau[joint][at]];
                for (found, wanted) in found.iter().zip([q, qd, 3.0 * q + 2.0]) {
                    assert!((found - wanted).abs() < 1e-6, "joint {joint}, state {at}: {found} {wanted}");
                }
            }
            // between the end and the inner ones the slope is near
            let w = 2.0 * PI * sine.frequency;
            for (time, qdd) in whole.time.iter().zip(&whole.qdd[joint]) {
                assert!((qdd - sine.at(*time)[2]).abs() < 0.5 * sine.amplitude.abs() * w * w, "{time}: {qdd}");
            }
        }
    }
}

#[test]
fn the_spectrum_chooses_a_cutoff_above_the_motion() {
    let mut random = fastrand::Rng::with_seed(1);
    let mut text = "time,q1,q2\n".to_owned();
    for time in times(5000, 250.0) {
        let [a, b] = SINES.map(|sine| sine.at(time)[0] + 1e-4 * (random.f64() - 0.5));
        text += &format!("{time},{a},{b}\n");
    }
    let (_folder, path) = file("spectrum.csv", text);
    let (_, survey) = survey(&[path], Options::default()).unwrap();
    let Cutoff::Spectrum { hertz, ends, bounded } = survey.cutoff else { panic!() };
    assert!(ends[0] > 0.7 && ends[0] < 2.5 && ends[1] > 1.9 && ends[1] < 3.8, "{ends:?}");
    assert!(!bounded && (hertz - 1.5 * ends[1]).abs() < 1e-12);
}

/// A cut-off that needs more states than a run has, or than any memory: said, with the lowest that leaves something.
#[test]
fn a_cutoff_that_leaves_nothing_is_refused() {
    let (_folder, path) = file("short.csv", csv(&times(400, 100.0)));
    let of = |cutoff: f64| {
        let options = Options { cutoff: Some(cutoff), ..Options::default() };
        runs(std::slice::from_ref(&path), options, 100_000)
    };
    for cutoff in [1.5, 0.01, 1e-9, 1e-300] {
        let error = of(cutoff).unwrap_err();
        let said = error.to_string();
        assert!(error.is_of_request() && said.contains("at 100 Hz a cut-off of"), "{said}");
        let lowest = said.rsplit_once("from ").unwrap().1.split(' ').next().unwrap();
        let lowest: f64 = lowest.parse().unwrap();
        assert!((1.5..1.8).contains(&lowest), "{said}");
        assert!(!of(lowest).unwrap().is_empty());
        assert!(of(lowest * 0.99).is_err());
    }
    let error = of(1e300).unwrap_err();
    assert!(error.to_string().contains("1.00e300 Hz is too high for samples at 100.0000 Hz"), "{error}");
    // no cut-off helps five states
    let (_folder, path) = file("five.csv", csv(&times(5, 100.0)));
    let options = Options { cutoff: Some(10.0), ..Options::default() };
    let error = runs(&[path], options, 100_000).unwrap_err();
    assert!(!error.is_of_request() && error.to_string().contains("every cut-off drops all states"), "{error}");
}

/// A spike is found before a filter spreads it; left out, the motion is that of the log without it.
#[test]
fn a_spike_is_found_and_left_out_where_that_is_asked_for() {
    let clean = csv(&times(1200, 100.0));
    let mut lines: Vec<String> = clean.lines().map(str::to_owned).collect();
    let (before, effort) = lines[701].rsplit_once(',').unwrap();
    let (before, effort) = (before.to_owned(), effort.parse::<f64>().unwrap());
    lines[701] = format!("{before},{}", effort + 1e4);
    let (_folder, path) = file("spike.csv", lines.join("\n"));
    let (_other, clean) = file("clean.csv", clean);
    let options = Options { cutoff: Some(8.0), ..Options::default() };
    let (_, found) = survey(std::slice::from_ref(&path), options.clone()).unwrap();
    let [spike] = found.spikes[..] else { panic!("{:?}", found.spikes) };
    assert_eq!((spike.message, spike.joint, spike.time), (701, 1, 7.0));
    assert!((spike.effort - effort - 1e4).abs() < 1e-9);
    let motion = |path, options| runs(&[path], options, 100_000).unwrap().remove(0).1;
    let (spoilt, clean) = (motion(path.clone(), options.clone()), motion(clean, options.clone()));
    let without = motion(path, Options { leave_out_spikes: true, ..options });
    let off = |motion: &rne_logs::Motion| {
        let pairs = motion.tau[1].iter().zip(&clean.tau[1]);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    assert_eq!(without.len(), clean.len());
    assert!(off(&spoilt) > 1e3 && off(&without) < 1e-3, "{} {}", off(&spoilt), off(&without));
}
