//! Where runs begin, and what is left out.

use rne_logs::{Interruption, LogError, Options, Remedy, Setting, TimeUnit};

use crate::written::{csv, file, runs, survey};

fn even(begin: f64, count: u32) -> Vec<f64> {
    (0..count).map(|i| begin + f64::from(i) * 0.01).collect()
}

#[test]
fn gaps_resets_and_duplicates_split_runs() {
    let mut times = even(0.0, 300);
    times.extend(even(5.0, 200)); // a gap
    times.extend(even(2.0, 200)); // the clock was set back
    let mut text = csv(&times);
    // the time of the last state, and another torque
    let last = csv(&even(3.99, 200));
    let (first, others) = last.split_once('\n').unwrap().1.split_once('\n').unwrap();
    text += &format!("{},9.5\n{others}", first.rsplit_once(',').unwrap().0);
    let (_folder, path) = file("runs.csv", text);
    let (_, survey) = survey(&[path], Options::default()).unwrap();
    let kinds: Vec<_> = survey.runs.iter().map(|run| (run.begins, run.states)).collect();
    assert_eq!(survey.run_count, 4, "{kinds:?}");
    assert!(matches!(kinds[0], (Interruption::Beginning, 300)));
    assert!(matches!(kinds[1], (Interruption::Gap { seconds }, 200) if (seconds - 2.01).abs() < 1e-9));
    assert!(matches!(kinds[2], (Interruption::Reset { seconds }, 200) if (seconds - 4.99).abs() < 1e-9));
    assert!(matches!(kinds[3], (Interruption::Duplicate, 200)), "{kinds:?}");
}

#[test]
fn a_message_that_is_said_twice_counts_once() {
    let text = csv(&even(0.0, 300));
    let doubled: String = text
        .lines()
        .enumerate()
        .flat_map(|(i, line)| [line; 2].into_iter().take(1 + i.min(1)))
        .map(|line| format!("{line}\n"))
        .collect();
    let (_folder, path) = file("doubled.csv", doubled);
    let (_, survey) = survey(&[path], Options::default()).unwrap();
    assert_eq!((survey.run_count, survey.counts.states, survey.counts.repeats), (1, 300, 300));
}

#[test]
fn a_jump_splits_a_run() {
    let mut text = csv(&even(0.0, 200));
    text += &csv(&even(2.0, 200))
        .lines()
        .skip(1)
        .map(|line| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            cells[2] = (cells[2].parse::<f64>().unwrap() + std::f64::consts::TAU).to_string();
            cells.join(",") + "\n"
        })
        .collect::<String>();
    let (_folder, path) = file("jump.csv", text);
    let (_, survey) = survey(&[path], Options::default()).unwrap();
    assert!(
        matches!(survey.runs[1].begins, Interruption::Jump { joint: 1, by } if (by - 6.2).abs() < 0.2),
        "{:?}",
        survey.runs
    );
}

#[test]
fn numbers_that_are_none_are_counted_and_left_out() {
    let text = csv(&even(0.0, 500));
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for (line, cell) in [(50, "NaN"), (51, ""), (90, "inf")] {
        let mut cells: Vec<&str> = lines[line].split(',').collect();
        cells[1] = cell;
        lines[line] = cells.join(",");
    }
    let (_folder, path) = file("nan.csv", lines.join("\n"));
    let (_, survey) = survey(&[path], Options::default()).unwrap();
    assert_eq!((survey.counts.not_finite, survey.counts.states, survey.counts.messages), (3, 497, 500));
    let invalid_sample = survey.invalid_sample.unwrap();
    assert_eq!((invalid_sample.message, invalid_sample.joint, invalid_sample.quantity), (50, 0, "position"));
    // two steps are missing: not yet a gap
    assert_eq!(survey.run_count, 1);
    assert!((survey.runs[0].longest - 0.03).abs() < 1e-9);
}

/// What overflows where it is squared is no number that was measured.
#[test]
fn numbers_that_nobody_measured_are_left_out() {
    let text = csv(&even(0.0, 500));
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let (before, _) = lines[91].rsplit_once(',').unwrap();
    lines[91] = format!("{before},-1e300");
    let (_folder, path) = file("huge.csv", lines.join("\n"));
    let (_, survey) = survey(&[path], Options::default()).unwrap();
    assert_eq!((survey.counts.not_finite, survey.counts.states), (1, 499));
    let invalid_sample = survey.invalid_sample.unwrap();
    assert_eq!(
        (invalid_sample.message, invalid_sample.joint, invalid_sample.quantity, invalid_sample.value),
        (91, 1, "effort", -1e300)
    );
    assert!((invalid_sample.time - 0.9).abs() < 1e-9);
    assert!(survey.efforts[1].0 > -100.0);
}

#[test]
fn degrees_are_not_guessed() {
    let text = csv(&even(0.0, 800));
    let header = text.lines().next().unwrap().to_owned() + "\n";
    let degrees: String = text
        .lines()
        .skip(1)
        .map(|line| {
            let cells = line.split(',').enumerate().map(|(i, cell)| {
                let number: f64 = cell.parse().unwrap();
                if (1..5).contains(&i) { number.to_degrees().to_string() } else { cell.to_owned() }
            });
            cells.collect::<Vec<_>>().join(",") + "\n"
        })
        .collect();
    let (_folder, path) = file("degrees.csv", header + &degrees);
    let options = Options { cutoff: Some(8.0), ..Options::default() };
    let error = runs(std::slice::from_ref(&path), options.clone(), 1000).unwrap_err();
    assert!(error.is_of_request() && error.remedies() == [Remedy::Give(Setting::Angles)], "{error}");
    let options = Options { angles: rne_logs::Angles::Degrees, ..options };
    let motions = runs(&[path], options.clone(), 1000).unwrap();
    let (_folder, path) = file("radians.csv", text);
    let radians = runs(&[path], Options { angles: rne_logs::Angles::Radians, ..options }, 1000).unwrap();
    for joint in 0..2 {
        for (a, b) in motions[0].1.qdd[joint].iter().zip(&radians[0].1.qdd[joint]) {
            assert!((a - b).abs() < 1e-9);
        }
    }
}

#[test]
fn currents_become_torques_by_their_constants() {
    let (_folder, path) = file("currents.csv", csv(&even(0.0, 400)));
    let options = Options { cutoff: Some(8.0), ..Options::default() };
    let plain = runs(std::slice::from_ref(&path), options.clone(), 1000).unwrap();
    let with =
        |torque_constants| runs(std::slice::from_ref(&path), Options { torque_constants, ..options.clone() }, 1000);
    let scaled = with(vec![2.0, -4.0]).unwrap();
    for i in 0..plain[0].1.len() {
        assert_eq!(scaled[0].1.tau[0][i], 2.0 * plain[0].1.tau[0][i]);
        assert_eq!(scaled[0].1.tau[1][i], -4.0 * plain[0].1.tau[1][i]);
    }
    assert_eq!(with(vec![2.0]).unwrap()[0].1.tau[0], scaled[0].1.tau[0]);
    for wrong in [vec![1.0; 3], vec![0.0], vec![f64::NAN, 1.0]] {
        assert!(with(wrong).unwrap_err().is_of_request());
    }
}

#[test]
fn joints_are_found_by_name_and_in_the_order_asked_for() {
    let text = csv(&even(0.0, 400)).replace("q1,q2,qd1,qd2,tau1,tau2", "a/pos,b/pos,a/vel,b/vel,a/torque,b/torque");
    let (_folder, path) = file("names.csv", text);
    let open = |names: &[&str]| {
        let joints = Some(names.iter().map(|name| (*name).to_owned()).collect());
        survey(std::slice::from_ref(&path), Options { joints, ..Options::default() })
    };
    let (log, turned) = open(&["b", "a"]).unwrap();
    let (_, plain) = open(&["a", "b"]).unwrap();
    assert_eq!(log.layout().joints, ["b", "a"]);
    assert_eq!(turned.positions, [plain.positions[1], plain.positions[0]]);
    assert_eq!(turned.efforts, [plain.efforts[1], plain.efforts[0]]);
    let (log, one) = open(&["b"]).unwrap();
    assert_eq!((log.layout().ignored.as_slice(), one.positions[0]), (["a".to_owned()].as_slice(), plain.positions[1]));
    let wrong = |names: &[&str]| match open(names) {
        Err(error) => error,
        Ok(_) => panic!("{names:?}"),
    };
    let error: LogError = wrong(&["a", "bb"]);
    assert!(
        error.is_of_request() && error.to_string().contains("no joint bb (did you mean b?); its joints are a, b"),
        "{error}"
    );
    assert!(wrong(&["a", "a"]).to_string().contains("twice"));
}

#[test]
fn times_in_other_units_are_asked_for() {
    let seconds = csv(&even(1_700_000_000.0, 400));
    let nanoseconds: String = seconds
        .lines()
        .map(|line| match line.split_once(',') {
            Some((time, rest)) if line.starts_with('1') => format!("{},{rest}\n", time.replace('.', "")),
            _ => format!("{line}\n"),
        })
        .collect();
    let (_folder, path) = file("ns.csv", nanoseconds);
    let error = survey(std::slice::from_ref(&path), Options::default()).err().unwrap();
    assert!(error.remedies().contains(&Remedy::Give(Setting::TimeUnit)), "{error}");
    let (log, found) =
        survey(&[path], Options { time_unit: Some(TimeUnit::Nanoseconds), ..Options::default() }).unwrap();
    assert!((log.layout().step - 0.01).abs() < 1e-6);
    // times are since the first
    assert_eq!(found.runs[0].start, 0.0);
    assert_eq!(log.layout().origin, 1_700_000_000_000_000_000);
}

/// Times of a log of a kilohertz in whole milliseconds, of a megahertz in microseconds, or numbers of rows: taken for
/// seconds they make a slow log of it, and accelerations a millionth.
#[test]
fn times_that_may_be_in_any_unit_are_asked_for_theirs() {
    let table = |step: f64, name: &str| {
        let text = csv(&even(0.0, 400));
        let rows = text.lines().skip(1).zip(0..).map(|(line, i)| {
            let (_, cells) = line.split_once(',').unwrap();
            format!("{},{cells}\n", step * f64::from(i))
        });
        format!("{name},q1,q2,qd1,qd2,tau1,tau2\n{}", rows.collect::<String>())
    };
    let open = |text: &str, options: Options| {
        let (_folder, path) = file("log.csv", text);
        survey(&[path], options).map(|(log, _)| log.layout().step)
    };
    let unit = |unit| Options { time_unit: Some(unit), ..Options::default() };
    for step in [0.5, 1.0, 2.0, 8.0, 1e6] {
        let error = open(&table(step, "t"), Options::default()).unwrap_err();
        assert!(error.is_of_request(), "{error}");
        assert!(error.to_string().contains("the unit of the times is not known: the times are "), "{error}");
        assert!(error.to_string().contains("if the times only count rows"), "{error}");
        // who says it is believed
        assert!((open(&table(step, "t"), unit(TimeUnit::Seconds)).unwrap() / step - 1.0).abs() < 1e-12);
        assert!((open(&table(step, "t"), unit(TimeUnit::Milliseconds)).unwrap() / step - 1e-3).abs() < 1e-12);
        assert!((open(&table(step, "t_s"), Options::default()).unwrap() / step - 1.0).abs() < 1e-12);
        assert!((open(&table(step, "t [ms]"), Options::default()).unwrap() / step - 1e-3).abs() < 1e-12);
    }
    let error = open(&table(1.0, "t"), Options::default()).unwrap_err().to_string();
    assert!(error.contains("1 apart, so samples are at 1 Hz in s, 1 kHz in ms, 1 MHz in us, 1 GHz in ns"), "{error}");
    assert_eq!(open(&table(0.4, "t"), Options::default()).unwrap(), 0.4);
    // ms of a log at 4 kHz look like that: it is read, and said
    for (step, name, is_said) in [(0.25, "t", true), (0.1, "t", true), (0.25, "t_s", false), (0.05, "t", false)] {
        let (_folder, path) = file("log.csv", table(step, name));
        let (log, _) = survey(&[path], Options::default()).unwrap();
        let said =
            log.layout().notes.iter().any(|note| note.contains("the times have no unit, so rne reads them as seconds"));
        assert_eq!(said, is_said, "{name} {step}: {:?}", log.layout().notes);
    }
}

/// A thousand joints at a megahertz: the filter and the spectrum hold some rows of them, and not all.
#[test]
fn a_table_of_a_thousand_joints_is_read() {
    let table = |joints: usize| {
        let names = (1..=joints).map(|joint| format!(",q{joint}")).collect::<String>();
        let rows = (0..100).map(|i| format!("{:.6}{}\n", f64::from(i) * 1e-6, ",0".repeat(joints)));
        format!("t{names}\n{}", rows.collect::<String>())
    };
    let (_folder, path) = file("log.csv", table(1024));
    let (log, found) = survey(&[path], Options::default()).unwrap();
    assert_eq!((log.layout().joints.len(), found.counts.states), (1024, 100));
    let (_folder, path) = file("log.csv", table(1025));
    let error = survey(&[path], Options::default()).err().unwrap().to_string();
    assert!(error.contains("the table has 1025 columns of positions; rne reads at most 1024 joints"), "{error}");
}

/// A small log with long intervals would be a long one that nobody measured.
#[test]
fn what_is_filled_in_is_bounded() {
    let mut times = even(0.0, 1500);
    times.extend((0..20_000).map(|i| 15.0 + 9.9 * f64::from(i)));
    let (_folder, path) = file("sparse.csv", csv(&times));
    let with = |gap| Options { gap, ..Options::default() };
    let error = survey(std::slice::from_ref(&path), with(1000.0)).err().unwrap();
    assert!(error.is_of_request(), "{error}");
    assert!(error.to_string().contains("interpolate more than 20 states for each of them"), "{error}");
    survey(&[path], with(100.0)).unwrap();
}

#[test]
fn a_gap_has_a_limit() {
    let (_folder, path) = file("log.csv", csv(&even(0.0, 100)));
    let with = |gap| Options { gap, ..Options::default() };
    for gap in [1000.5, 1e7, 1e15, f64::INFINITY, f64::NAN] {
        let error = survey(std::slice::from_ref(&path), with(gap)).err().unwrap();
        assert!(error.is_of_request() && error.to_string().contains("the limit of gaps must be at "), "{gap}: {error}");
    }
    let error = survey(std::slice::from_ref(&path), with(1e7)).err().unwrap().to_string();
    assert!(error.contains("the limit of gaps must be at most 1000 steps"), "{error}");
    assert!(survey(&[path], with(1000.0)).is_ok());
}
