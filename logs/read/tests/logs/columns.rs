//! Tables whose columns are in another order, in other units, or not clear: the motion is that of the plain table, or
//! there is none.

use rne_logs::{Angles, Dimension, Motion, Options};

use crate::written::{csv, file, runs, survey};

fn times() -> Vec<f64> {
    (0..600).map(|i| f64::from(i) * 0.01).collect()
}

fn options() -> Options {
    Options { cutoff: Some(8.0), ..Options::default() }
}

fn motion(text: &str, options: Options) -> Motion {
    let (_folder, path) = file("log.csv", text);
    let mut runs = runs(&[path], options, 1000).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(runs.len(), 1);
    runs.remove(0).1
}

fn refused(text: &str, options: Options) -> String {
    let (_folder, path) = file("log.csv", text);
    runs(&[path], options, 1000).map(|runs| runs.len()).unwrap_err().to_string()
}

/// The table of eleven joints, joint by joint sin(i + t), with its columns in an order.
fn eleven(order: &[usize]) -> String {
    let header = |quantity: &str| order.iter().map(|joint| format!(",{quantity}{joint}")).collect::<String>();
    let mut text = format!("time{}{}\n", header("q"), header("tau"));
    for time in times() {
        text += &format!("{time}");
        for part in [0.0, 100.0] {
            let numbers = order.iter().map(|joint| format!(",{}", part + (*joint as f64 + time).sin()));
            text += &numbers.collect::<String>();
        }
        text.push('\n');
    }
    text
}

#[test]
fn joints_are_by_their_numbers_in_any_order_of_columns() {
    let sorted: Vec<usize> = (1..=11).collect();
    let as_texts = [1, 10, 11, 2, 3, 4, 5, 6, 7, 8, 9];
    let expected = motion(&eleven(&sorted), options());
    assert_eq!(motion(&eleven(&as_texts), options()), expected);
    // two of them, and names that are none of the log, as many as it has
    let named =
        |names: &[&str]| Options { joints: Some(names.iter().map(|name| (*name).into()).collect()), ..options() };
    let others = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k"];
    assert!(refused(&eleven(&as_texts), named(&others)).contains("no joint a, b, c"));
    let two = motion(&eleven(&as_texts), named(&["10", "2"]));
    assert_eq!((&two.q[0], &two.q[1], &two.tau[0]), (&expected.q[9], &expected.q[1], &expected.tau[9]));
    // words with numbers
    let words = eleven(&as_texts).replace(",q", ",position.joint_").replace(",tau", ",effort.joint_");
    assert_eq!(motion(&words, options()), expected);
}

#[test]
fn a_table_with_a_gap_or_twice_a_joint_is_refused() {
    assert!(refused(&eleven(&[1, 3]), options()).contains("q1, q3 are positions of numbered joints, but 2 is"));
    assert!(
        refused(&eleven(&[1, 2, 1]), options()).contains("q1 and q1, 2 and 4 of the table, are both positions of 1")
    );
    let twice = eleven(&[1, 2]).replace("tau1,tau2", "tau1,torque1");
    assert!(refused(&twice, options()).contains("tau1 and torque1, 4 and 5 of the table, are both efforts of 1"));
    let other = eleven(&[1, 2]).replace("tau1,tau2", "tau1,tau3");
    assert!(refused(&other, options()).contains("the position of joint 2 but not its effort"));
}

/// A table with other units, its numbers divided as its header says.
fn with_units(header: &str, factors: [f64; 7]) -> String {
    let plain = csv(&times());
    let rows = plain.lines().skip(1).map(|line| {
        let cells = line.split(',').zip(factors).map(|(cell, factor)| {
            if factor == 1.0 { cell.to_owned() } else { (cell.parse::<f64>().unwrap() / factor).to_string() }
        });
        cells.collect::<Vec<_>>().join(",") + "\n"
    });
    format!("{header}\n{}", rows.collect::<String>())
}

#[test]
fn units_of_names_are_converted() {
    let plain = csv(&times());
    let expected = motion(&plain, options());
    let degree = std::f64::consts::PI / 180.0;
    let is_near = |found: &Motion, wanted: &Motion| {
        let lists =
            [(&found.q, &wanted.q), (&found.qd, &wanted.qd), (&found.qdd, &wanted.qdd), (&found.tau, &wanted.tau)];
        let mut pairs = lists.into_iter().flat_map(|(a, b)| a.iter().flatten().zip(b.iter().flatten()));
        found.time.len() == wanted.time.len() && pairs.all(|(a, b)| (a - b).abs() <= 1e-12 * (1.0 + b.abs()))
    };
    for (header, factors) in [
        (
            "t [ms],q1 [deg],q2 [deg],qd1 [deg/s],qd2 [deg/s],tau1 [mNm],tau2 [mNm]",
            [1e-3, degree, degree, degree, degree, 1e-3, 1e-3],
        ),
        ("t_us,q1_deg,q2_rad,qd1_deg_s,qd2_rad_s,tau1_Nm,tau2_mNm", [1e-6, degree, 1.0, degree, 1.0, 1.0, 1e-3]),
        (
            "time,q1[°],q2 (mm),qd1[rpm],qd2 (mm/s),tau1[N m],tau2 (kN)",
            [1.0, degree, 1e-3, std::f64::consts::PI / 30.0, 1e-3, 1.0, 1e3],
        ),
        ("time,q1 [rad],q2 [m],qd1 [rad/s],qd2 [m/s],tau1 [N·m],tau2 [N]", [1.0; 7]),
    ] {
        let found = motion(&with_units(header, factors), options());
        assert!(is_near(&found, &expected), "{header}");
    }
    // degrees by name are those of the option, in every bit
    let text = with_units("time,q1,q2,qd1,qd2,tau1,tau2", [1.0, degree, degree, degree, degree, 1.0, 1.0]);
    let said = text.replace("q1,q2,qd1,qd2", "q1 [deg],q2 [deg],qd1 [deg/s],qd2 [deg/s]");
    let asked = Options { angles: Angles::Degrees, ..options() };
    assert_eq!(motion(&said, options()), motion(&text, asked.clone()));
    assert_eq!(motion(&said, asked.clone()), motion(&text, asked.clone()));
    // what slides is in metres, whatever joints it is asked with
    let slide = |joints: &[&str], slides: &[bool]| Options {
        joints: Some(joints.iter().map(|name| (*name).into()).collect()),
        slides: slides.to_vec(),
        ..asked.clone()
    };
    let of_metres = with_units("time,q1,q2,qd1,qd2,tau1,tau2", [1.0, 1.0, degree, 1.0, degree, 1.0, 1.0]);
    for (joints, slides) in [(["1", "2"], [true, false]), (["2", "1"], [false, true])] {
        let found = motion(&of_metres, slide(&joints, &slides));
        let plain = motion(&plain, Options { joints: slide(&joints, &[]).joints, ..options() });
        assert!(is_near(&found, &plain), "{joints:?}");
        let (_folder, path) = file("log.csv", &of_metres);
        let (log, _) = survey(&[path], slide(&joints, &slides)).unwrap();
        let note = "degrees are only for joints that turn: 1 slides, and is read in m and m/s".to_owned();
        assert_eq!(log.layout().notes, [note]);
    }
    // the option is of what says none
    let partly = text.replace("q1,q2,qd1,qd2", "q1 [deg],q2 [deg],qd1,qd2");
    assert_eq!(motion(&partly, asked.clone()), motion(&text, asked));
    assert!(refused(&partly, options()).contains("q1 [deg] gives a unit, but the name qd1 does not"));
}

#[test]
fn a_wide_range_that_says_its_unit_is_no_question() {
    let wide = |header: &str| {
        format!("{header}\n{}", times().iter().map(|t| format!("{t},{}\n", 20.0 * t.sin())).collect::<String>())
    };
    assert!(refused(&wide("time,q1"), options()).contains("more than 4π"));
    let plain = Options { angles: Angles::Radians, ..options() };
    assert_eq!(motion(&wide("time,q1 [rad]"), options()), motion(&wide("time,q1"), plain));
}

#[test]
fn currents_need_a_constant() {
    let text = csv(&times()).replace("tau1,tau2", "i1 [mA],i2 [A]");
    let (_folder, path) = file("log.csv", &text);
    let (log, _) = survey(&[path], options()).unwrap();
    assert_eq!((log.unsaid_currents(), log.layout().units[0].effort), (vec!["1", "2"], Some(Dimension::Current)));
    let error = refused(&text, options());
    assert!(error.contains("the names of columns say that efforts of 1, 2 are currents"), "{error}");
    assert!(refused(&csv(&times()).replace("tau", "current_"), options()).contains("are currents"));
    let said = motion(&text, Options { torque_constants: vec![200.0, 0.3], ..options() });
    let plain = motion(&csv(&times()), options());
    for (found, wanted) in said.tau[0].iter().zip(&plain.tau[0]) {
        assert!((found - 0.2 * wanted).abs() < 1e-12);
    }
    for (found, wanted) in said.tau[1].iter().zip(&plain.tau[1]) {
        assert!((found - 0.3 * wanted).abs() < 1e-12);
    }
}

/// What others write around the same numbers.
#[test]
fn tables_of_other_programs_are_the_same() {
    let plain = csv(&times());
    let expected = motion(&plain, options());
    let header = "time,q1,q2,qd1,qd2,tau1,tau2";
    let (_, rows) = plain.split_once('\n').unwrap();
    for (what, text) in [
        ("BOM", format!("\u{feff}{plain}")),
        ("semicolons", plain.replace(',', ";")),
        ("tabs", plain.replace(',', "\t")),
        ("blanks", plain.replace(',', " , ")),
        ("quotes", plain.replace(header, "\"time\",\"q1\",\"q2\",\"qd1\",\"qd2\",\"tau1\",\"tau2\"")),
        ("capitals", plain.replace(header, "TIME,Q1,Q2,QD1,QD2,TAU1,TAU2")),
        ("CRLF", plain.replace('\n', "\r\n")),
        ("comment", format!("# made by hand\n{plain}")),
        ("empty columns", format!("{header},,\n{}", rows.replace('\n', ",,\n"))),
    ] {
        assert_eq!(motion(&text, options()), expected, "{what}");
    }
    for (text, wanted) in [
        (format!("{header}\n"), "the log has no joint states"),
        (plain.replace(',', ";").replace('.', ","), "decimal comma"),
        (plain.replace(',', " "), "separated by blanks"),
        (csv(&times()[..1]), "the log has one joint state"),
    ] {
        let error = refused(&text, options());
        assert!(error.contains(wanted), "{wanted}: {error}");
    }
}

/// A file behind another says the same units.
#[test]
fn files_of_one_log_have_one_unit() {
    let degree = std::f64::consts::PI / 180.0;
    let header = "time,q1 [deg],q2,qd1 [deg/s],qd2,tau1,tau2";
    let text = with_units(header, [1.0, degree, 1.0, degree, 1.0, 1.0, 1.0]);
    let (_a, first) = file("a.csv", &text);
    let (_b, second) = file("b.csv", csv(&times()));
    let radians = Options { angles: Angles::Radians, ..options() };
    let error = runs(&[first, second], radians, 1000).map(|runs| runs.len()).unwrap_err().to_string();
    assert!(error.contains("b.csv: the names of its columns give other units for 1"), "{error}");
}
