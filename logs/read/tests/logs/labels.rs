//! Tables of several arms: rows of one, texts of a column, and a column of times by its name.

use std::path::PathBuf;

use rne_logs::{Log, LogError, Mapping, Motion, Options, Remark, Remedy, Setting, Target};
use tempfile::TempDir;

use crate::written::{csv, file, runs, survey};

fn times(from: f64) -> Vec<f64> {
    (0..500).map(|i| from + f64::from(i) * 0.01).collect()
}

/// The rows of two arms, by turns, with a column in front; the second arm moves 0.3 s later.
fn by_turns(column: &str, names: [&str; 2]) -> String {
    let [first, second] = [csv(&times(0.0)), csv(&times(0.3))];
    let header = first.lines().next().unwrap();
    let pairs = first.lines().zip(second.lines()).skip(1);
    let rows = pairs.flat_map(|(a, b)| [format!("{},{a}", names[0]), format!("{},{b}", names[1])]);
    [format!("{column},{header}")].into_iter().chain(rows).collect::<Vec<_>>().join("\n")
}

fn options(column: &str, value: &str) -> Options {
    let select = vec![(column.to_owned(), value.to_owned())];
    Options { cutoff: Some(8.0), select, ..Options::default() }
}

fn log(text: impl AsRef<[u8]>) -> (TempDir, PathBuf) {
    file("log.csv", text)
}

/// The only run of a log.
fn only(path: &PathBuf, options: Options) -> Motion {
    let mut runs = runs(std::slice::from_ref(path), options, 1000).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(runs.len(), 1);
    runs.remove(0).1
}

fn refused(paths: &[PathBuf], options: Options) -> LogError {
    survey(paths, options).map(|(log, _)| log.layout().clone()).unwrap_err()
}

#[test]
fn rows_of_one_arm_are_the_log_of_that_arm() {
    let whole = Options { cutoff: Some(8.0), ..Options::default() };
    // names, numbers, quotes; a comma would be another cell
    for (column, names) in [("robot_id", ["r1", "r2"]), ("cell", ["0", "1"]), ("arm", ["\"left\"", "\"right\""])] {
        let (_folder, both) = log(by_turns(column, names));
        for (name, from) in names.into_iter().zip([0.0, 0.3]) {
            let (_folder, alone) = log(csv(&times(from)));
            let name = name.trim_matches('"');
            assert_eq!(only(&both, options(column, name)), only(&alone, whole.clone()), "{column} {name}");
        }
    }
}

#[test]
fn without_times_the_rate_is_that_of_the_selected_rows() {
    let untimed = |text: &str| {
        let without = |line: &str| {
            let cells = line.split(',').enumerate().filter(|(at, _)| *at != 1).map(|(_, cell)| cell);
            cells.collect::<Vec<_>>().join(",")
        };
        text.lines().map(without).collect::<Vec<_>>().join("\n")
    };
    let (_folder, both) = log(untimed(&by_turns("robot_id", ["r1", "r2"])));
    let rate = |options: Options| Options { rate: Some(100.0), ..options };
    let motion = only(&both, rate(options("robot_id", "r2")));
    assert!((motion.time[1] - motion.time[0] - 0.01).abs() < 1e-12);
    let (_folder, alone) = log(csv(&times(0.3)));
    let timed = only(&alone, Options { cutoff: Some(8.0), ..Options::default() });
    assert_eq!((motion.q, motion.qdd), (timed.q, timed.qdd));
}

#[test]
fn texts_of_a_column_are_counted_in_their_order() {
    let (_folder, path) = log(by_turns("cell", ["b", "a"]));
    let values = |column: &str| Log::values(std::slice::from_ref(&path), column, &Options::default(), |_| ());
    let found: Vec<_> = values("cell").unwrap().into_iter().map(|found| (found.value, found.rows)).collect();
    assert_eq!(found, [("b".to_owned(), 500), ("a".to_owned(), 500)]);
    let error = values("sell").unwrap_err().to_string();
    assert!(
        error.contains("the table has no column `sell` (did you mean cell?); its columns are cell, time, q1"),
        "{error}"
    );
    // each time is a text of its own
    let many = |count: i32| {
        let (_folder, path) = log(csv(&(0..count).map(|i| f64::from(i) * 0.01).collect::<Vec<_>>()));
        Log::values(&[path], "time", &Options::default(), |_| ())
    };
    assert_eq!(many(1000).unwrap().len(), 1000);
    let error = many(1001).unwrap_err();
    assert!(error.is_of_request() && error.to_string().contains("time has more than 1000 different texts"), "{error}");
}

#[test]
fn a_second_arm_is_refused_with_the_option_that_selects_one() {
    let remedy = |column: &str, value: &str| {
        [Remedy::Give(Setting::Select { column: column.to_owned(), value: value.to_owned() })]
    };
    let (_folder, both) = log(by_turns("robot_id", ["r1", "r2"]));
    let error = refused(std::slice::from_ref(&both), Options::default());
    assert!(error.is_of_request() && error.to_string().contains("robot_id names two arms, r1 and r2"), "{error}");
    assert_eq!(error.remedies(), remedy("robot_id", "r1"));
    // behind the first thousand rows
    let late =
        format!("{}\nr2,9.5,0,0,0,0,1,1", csv_of("r1", &(0..3000).map(|i| f64::from(i) * 0.01).collect::<Vec<_>>()));
    let (_folder, path) = log(late);
    assert!(Log::open(std::slice::from_ref(&path), Options::default()).is_ok());
    assert_eq!(refused(&[path], Options::default()).remedies(), remedy("robot_id", "r1"));
    // in a file of its own
    let (_first, a) = log(csv_of("r1", &times(0.0)));
    let (_second, b) = log(csv_of("r2", &times(10.0)));
    assert!(refused(&[a.clone(), b], Options::default()).to_string().contains("two arms, r1 and r2"));
    let (_second, b) = log(csv_of("r1", &times(10.0)));
    assert_eq!(survey(&[a, b], Options::default()).unwrap().1.run_count, 2);
    // a missing text is no other arm
    let gappy = csv_of("r1", &times(0.0)).replacen("\nr1,0.1", "\n,0.1", 3);
    assert!(gappy.contains("\n,0.1"));
    let (_folder, path) = log(gappy);
    assert_eq!(survey(&[path], Options::default()).unwrap().1.counts.states, 500);
    let error = refused(std::slice::from_ref(&both), options("robot_id", "r3"));
    assert!(error.is_of_request() && error.to_string().contains("no row has r3"), "{error}");
    assert!(error.to_string().ends_with("the column has r1, r2"), "{error}");
}

/// A log of one arm, with its name.
fn csv_of(name: &str, times: &[f64]) -> String {
    let text = csv(times);
    let rows = text.lines().enumerate().map(|(at, line)| format!("{},{line}", if at == 0 { "robot_id" } else { name }));
    rows.collect::<Vec<_>>().join("\n")
}

#[test]
fn words_in_a_table_whose_time_goes_back_are_a_warning() {
    let two = |column: &str| {
        let again = csv_of("b", &times(0.0)).lines().skip(1).collect::<Vec<_>>().join("\n");
        format!("{}\n{again}", csv_of("a", &times(0.0)).replacen("robot_id", column, 1))
    };
    let back = |text: String, options: Options| {
        let (_folder, path) = log(text);
        let (log, survey) = survey(&[path], options).unwrap();
        log.remarks(&survey).into_iter().find(|remark| matches!(remark, Remark::TimeGoesBack { .. }))
    };
    let expected = Remark::TimeGoesBack { times: 1, columns: vec!["cell".to_owned()] };
    assert!(expected.is_warning());
    assert_eq!(back(two("cell"), Options::default()), Some(expected));
    assert_eq!(back(two("cell"), options("cell", "a")), None);
    // numbers say no names, and a table of one log has no such time
    assert_eq!(back(two("cell").replace("\nb", "\n2").replace("\na", "\n1"), Options::default()), None);
    assert_eq!(back(csv_of("a", &times(0.0)).replacen("robot_id", "cell", 1), Options::default()), None);
}

#[test]
fn other_formats_have_no_rows_to_select() {
    let (_folder, path) = file("log.npy", {
        let header = format!("{:<117}\n", "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 4), }");
        [b"\x93NUMPY\x01\x00".as_slice(), &118_u16.to_le_bytes(), header.as_bytes(), &[0; 32]].concat()
    });
    let error = refused(std::slice::from_ref(&path), options("robot_id", "r1"));
    let remedy = Setting::Select { column: "robot_id".to_owned(), value: "r1".to_owned() };
    assert_eq!(error.remedies(), [Remedy::LeaveOut(remedy)]);
    assert!(error.to_string().contains("selected only by a column of a table"), "{error}");
    let time = Mapping { target: Target::Time, column: "clock".to_owned() };
    let error = refused(&[path], Options { map: vec![time], ..Options::default() });
    assert_eq!(error.remedies(), [Remedy::LeaveOut(Setting::TimeColumn(Vec::new()))]);
}

#[test]
fn a_column_of_times_has_the_name_that_is_given() {
    let whole = Options { cutoff: Some(8.0), ..Options::default() };
    let (_folder, known) = log(csv(&times(0.0)));
    let (_folder, ts) = log(csv(&times(0.0)).replacen("time", "ts", 1));
    assert_eq!(only(&ts, whole.clone()), only(&known, whole.clone()));
    let (_folder, other) = log(csv(&times(0.0)).replacen("time", "sample clock", 1));
    let error = refused(std::slice::from_ref(&other), whole.clone());
    // the column keeps true times, so it is proposed before a rate
    assert!(matches!(error.remedies(), [Remedy::Give(Setting::TimeColumn(_)), Remedy::Give(Setting::Rate)]), "{error}");
    let map = vec![Mapping { target: Target::Time, column: "sample clock".to_owned() }];
    assert_eq!(only(&other, Options { map, ..whole.clone() }), only(&known, whole));
}

/// The same in Parquet, with names, with numbers, in lists and in columns.
#[cfg(feature = "full")]
mod in_parquet {
    use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int32Type};
    use parquet::file::properties::WriterProperties;
    use rne_logs::{Format, MotionParquet};

    use super::*;
    use crate::formats::parquet;
    use crate::written::rows;

    #[derive(Clone, Copy)]
    enum Names {
        Texts,
        Numbers,
    }

    /// The table of [`by_turns`] with one joint, in two groups of rows.
    fn table(names: Names, time: &str) -> Vec<u8> {
        let kind = match names {
            Names::Texts => "OPTIONAL BINARY robot_id (STRING)",
            Names::Numbers => "OPTIONAL INT32 robot_id",
        };
        let columns = "REQUIRED DOUBLE q1; REQUIRED DOUBLE qd1; REQUIRED DOUBLE tau1;";
        let schema = format!("message log {{ REQUIRED DOUBLE {time}; {columns} {kind}; }}");
        let all: Vec<_> = rows(&times(0.0)).into_iter().zip(rows(&times(0.3))).flat_map(|(a, b)| [a, b]).collect();
        parquet(&schema, WriterProperties::builder().build(), 2, |group, writer| {
            let part = &all[group * 500..(group + 1) * 500];
            let columns: [Vec<f64>; 4] = [
                part.iter().map(|(time, _)| *time).collect(),
                part.iter().map(|(_, row)| row[0][0]).collect(),
                part.iter().map(|(_, row)| row[1][0]).collect(),
                part.iter().map(|(_, row)| row[2][0]).collect(),
            ];
            for numbers in columns {
                let mut column = writer.next_column().unwrap().unwrap();
                column.typed::<DoubleType>().write_batch(&numbers, None, None).unwrap();
                column.close().unwrap();
            }
            let mut column = writer.next_column().unwrap().unwrap();
            let levels = vec![1; part.len()];
            match names {
                Names::Texts => {
                    let texts: Vec<ByteArray> =
                        ["r1", "r2"].map(ByteArray::from).into_iter().cycle().take(part.len()).collect();
                    column.typed::<ByteArrayType>().write_batch(&texts, Some(&levels), None).unwrap()
                }
                Names::Numbers => {
                    let numbers: Vec<i32> = [1, 2].into_iter().cycle().take(part.len()).collect();
                    column.typed::<Int32Type>().write_batch(&numbers, Some(&levels), None).unwrap()
                }
            };
            column.close().unwrap();
        })
    }

    #[test]
    fn rows_of_one_arm_are_those_of_the_table_in_csv() {
        let joint = |motion: Motion| (motion.time, motion.q[0].clone(), motion.qdd[0].clone(), motion.tau[0].clone());
        let (_folder, csv) = log(by_turns("robot_id", ["r1", "r2"]));
        for (names, values) in [(Names::Texts, ["r1", "r2"]), (Names::Numbers, ["1", "2"])] {
            let (_folder, path) = file("log.parquet", table(names, "time"));
            for (value, name) in values.into_iter().zip(["r1", "r2"]) {
                let (found, expected) = (options("robot_id", value), options("robot_id", name));
                assert_eq!(joint(only(&path, found)), joint(only(&csv, expected)), "{value}");
            }
            let values: Vec<_> = values.map(|value| (value.to_owned(), 500)).to_vec();
            let found = Log::values(std::slice::from_ref(&path), "robot_id", &Options::default(), |_| ()).unwrap();
            assert_eq!(found.into_iter().map(|found| (found.value, found.rows)).collect::<Vec<_>>(), values);
            let error = refused(&[path], Options::default());
            assert!(error.to_string().contains("the column robot_id names two arms"), "{error}");
        }
    }

    #[test]
    fn a_column_of_times_has_the_name_that_is_given() {
        let map = vec![Mapping { target: Target::Time, column: "clock".to_owned() }];
        let (_folder, named) = file("log.parquet", table(Names::Texts, "time"));
        let (_folder, other) = file("log.parquet", table(Names::Texts, "clock"));
        let known = options("robot_id", "r1");
        assert_eq!(only(&other, Options { map: map.clone(), ..known.clone() }), only(&named, known));
        // lists stay lists, whatever the column of times is called
        let text = csv(&times(0.0));
        let (_folder, path) = log(&text);
        let (log, found) = survey(&[path], Options { cutoff: Some(8.0), ..Options::default() }).unwrap();
        let mut bytes = Vec::new();
        let mut table = MotionParquet::new(&mut bytes, log.layout(), Some("cell")).unwrap();
        for piece in log.motions(&found).unwrap() {
            let piece = piece.unwrap();
            table.push(log.layout(), piece.run, &piece.motion, "a").unwrap();
        }
        table.finish().unwrap();
        let (_folder, lists) = file("log.parquet", bytes);
        let run = Mapping { target: Target::Time, column: "run [ms]".to_owned() };
        let (read, _) = survey(std::slice::from_ref(&lists), options("cell", "a")).unwrap();
        assert_eq!(
            (read.layout().format, read.layout().word_columns.as_slice()),
            (Format::Parquet, &["cell".to_owned()][..])
        );
        let error = refused(&[lists], Options { map: vec![run], ..Options::default() });
        assert!(error.to_string().contains("do not increase"), "{error}");
    }
}
