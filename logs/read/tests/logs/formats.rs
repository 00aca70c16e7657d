//! The same motion in every format.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::Arc;

use mcap::records::MessageHeader;
use parquet::basic::{Compression, GzipLevel, ZstdLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, FloatType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use rne_logs::{Format, LogError, Motion, Options, Remedy, Setting};
use tempfile::TempDir;

use crate::written::{SINES, csv, file, joint_state, rows, runs, survey};

const NAMES: [&str; 2] = ["elbow", "wrist"];

pub(crate) fn times() -> Vec<f64> {
    (0..1500).map(|i| f64::from(i) * 0.008).collect()
}

fn nanoseconds(time: f64) -> i64 {
    (time * 1e9).round() as i64
}

const UNIT: Remedy = Remedy::Give(Setting::TimeUnit);

/// A bag in MCAP, with an image topic among the joint states.
pub(crate) fn mcap(times: &[f64], compression: Option<mcap::Compression>, topics: &[&str]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut writer =
        mcap::WriteOptions::new().compression(compression).chunk_size(Some(20_000)).create(&mut bytes).unwrap();
    let image = writer.add_schema("sensor_msgs/msg/Image", "ros2msg", b"").unwrap();
    let image = writer.add_channel(image, "/image", "cdr", &BTreeMap::new()).unwrap();
    let state = writer.add_schema("sensor_msgs/msg/JointState", "ros2msg", b"").unwrap();
    let states: Vec<u16> =
        topics.iter().map(|topic| writer.add_channel(state, topic, "cdr", &BTreeMap::new()).unwrap()).collect();
    for (i, (time, [q, qd, tau])) in rows(times).into_iter().enumerate() {
        let log_time = 5_000_000 + nanoseconds(time) as u64;
        let header = |channel_id| MessageHeader { channel_id, sequence: i as u32, log_time, publish_time: log_time };
        if i % 100 == 0 {
            writer.write_to_known_channel(&header(image), &[7; 5000]).unwrap();
        }
        let message = joint_state(nanoseconds(time), &NAMES, [&q, &qd, &tau], true);
        for state in &states {
            writer.write_to_known_channel(&header(*state), &message).unwrap();
        }
    }
    writer.finish().unwrap();
    drop(writer);
    bytes.into_inner()
}

/// A bag in SQLite; with or without the index of times.
pub(crate) fn sqlite(times: &[f64], is_little: bool, is_indexed: bool) -> (TempDir, PathBuf) {
    let (folder, path) = file("bag.db3", "");
    let bag = rusqlite::Connection::open(&path).unwrap();
    bag.execute_batch(
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);
         CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);
         INSERT INTO topics VALUES (1, '/image', 'sensor_msgs/msg/Image', 'cdr');
         INSERT INTO topics VALUES (2, '/joint_states', 'sensor_msgs/msg/JointState', 'cdr');
         BEGIN;",
    )
    .unwrap();
    for (time, [q, qd, tau]) in rows(times) {
        let message = joint_state(nanoseconds(time), &NAMES, [&q, &qd, &tau], is_little);
        bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (2, ?1, ?2)", (nanoseconds(time), message))
            .unwrap();
    }
    bag.execute_batch("COMMIT").unwrap();
    if is_indexed {
        bag.execute_batch("CREATE INDEX timestamp_idx ON messages (timestamp ASC)").unwrap();
    }
    (folder, path)
}

pub(crate) fn parquet(
    schema: &str,
    properties: WriterProperties,
    groups: usize,
    mut write: impl FnMut(usize, &mut SerializedRowGroupWriter<'_, &mut Vec<u8>>),
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let schema = Arc::new(parse_message_type(schema).unwrap());
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties)).unwrap();
    for group in 0..groups {
        let mut row_group = writer.next_row_group().unwrap();
        write(group, &mut row_group);
        row_group.close().unwrap();
    }
    writer.close().unwrap();
    bytes
}

fn doubles(
    group: &mut SerializedRowGroupWriter<'_, &mut Vec<u8>>,
    numbers: &[f64],
    levels: Option<(&[i16], Option<&[i16]>)>,
) {
    let mut column = group.next_column().unwrap().unwrap();
    let (definitions, repetitions) = levels.unzip();
    column.typed::<DoubleType>().write_batch(numbers, definitions, repetitions.flatten()).unwrap();
    column.close().unwrap();
}

/// A column per number, in three groups of rows.
pub(crate) fn scalars(times: &[f64], properties: WriterProperties) -> Vec<u8> {
    let schema = "message log { REQUIRED INT64 stamp (TIMESTAMP(NANOS, true));
        REQUIRED DOUBLE elbow_position; REQUIRED DOUBLE wrist_position;
        REQUIRED DOUBLE elbow_velocity; REQUIRED DOUBLE wrist_velocity;
        OPTIONAL DOUBLE elbow_effort; OPTIONAL DOUBLE wrist_effort; OPTIONAL BINARY remark (STRING); }";
    let each = times.len().div_ceil(3);
    parquet(schema, properties, 3, |group, writer| {
        let rows = rows(&times[group * each..times.len().min((group + 1) * each)]);
        let mut column = writer.next_column().unwrap().unwrap();
        let stamps: Vec<i64> = rows.iter().map(|(time, _)| nanoseconds(*time)).collect();
        column.typed::<Int64Type>().write_batch(&stamps, None, None).unwrap();
        column.close().unwrap();
        for quantity in 0..3 {
            for joint in 0..2 {
                let numbers: Vec<f64> = rows.iter().map(|(_, row)| row[quantity][joint]).collect();
                let levels = vec![1; rows.len()];
                doubles(writer, &numbers, (quantity == 2).then_some((&levels, None)));
            }
        }
        let mut column = writer.next_column().unwrap().unwrap();
        let levels = vec![0; rows.len()];
        column.typed::<ByteArrayType>().write_batch(&[], Some(&levels), None).unwrap();
        column.close().unwrap();
    })
}

/// Lists, of names too.
pub(crate) fn lists(times: &[f64], has_names: bool) -> Vec<u8> {
    let names = "REQUIRED group name (LIST) { REPEATED group list { REQUIRED BINARY element (STRING); } }";
    let list =
        |name: &str| format!("OPTIONAL group {name} (LIST) {{ REPEATED group list {{ OPTIONAL DOUBLE element; }} }}");
    let schema = format!(
        "message log {{ REQUIRED DOUBLE timestamp; {} {} {} {} }}",
        if has_names { names } else { "" },
        list("position"),
        list("velocity"),
        list("effort")
    );
    let properties = WriterProperties::builder().build();
    parquet(&schema, properties, 1, |_, writer| {
        let rows = rows(times);
        doubles(writer, times, None);
        if has_names {
            let mut column = writer.next_column().unwrap().unwrap();
            let texts: Vec<ByteArray> = rows.iter().flat_map(|_| NAMES.map(ByteArray::from)).collect();
            let (definitions, repetitions) = (vec![1; texts.len()], [0, 1].repeat(rows.len()));
            column.typed::<ByteArrayType>().write_batch(&texts, Some(&definitions), Some(&repetitions)).unwrap();
            column.close().unwrap();
        }
        for quantity in 0..3 {
            let numbers: Vec<f64> = rows.iter().flat_map(|(_, row)| row[quantity]).collect();
            let (definitions, repetitions) = (vec![3; numbers.len()], [0, 1].repeat(rows.len()));
            doubles(writer, &numbers, Some((&definitions, Some(&repetitions))));
        }
    })
}

pub(crate) fn npy(times: &[f64], is_time: bool, kind: &str) -> Vec<u8> {
    let width = if is_time { 7 } else { 6 };
    let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({}, {width}), }}", times.len());
    let header = format!("{header:<117}\n");
    let mut bytes = [b"\x93NUMPY\x01\x00".as_slice(), &(header.len() as u16).to_le_bytes(), header.as_bytes()].concat();
    for (time, row) in rows(times) {
        let numbers = is_time.then_some(time).into_iter().chain(row.into_iter().flatten());
        for number in numbers {
            match kind {
                "<f8" => bytes.extend(number.to_le_bytes()),
                ">f8" => bytes.extend(number.to_be_bytes()),
                _ => bytes.extend((number as f32).to_le_bytes()),
            }
        }
    }
    bytes
}

fn options() -> Options {
    Options { cutoff: Some(8.0), ..Options::default() }
}

fn only(path: PathBuf, options: Options) -> Motion {
    let mut runs = runs(&[path], options, 1000).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(runs.len(), 1);
    runs.remove(0).1
}

fn of(name: &str, bytes: Vec<u8>, format: Format, options: Options) -> Motion {
    let (_folder, path) = file(name, bytes);
    let (log, _) = survey(std::slice::from_ref(&path), options.clone()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(log.layout().format, format);
    only(path, options)
}

fn expected() -> Motion {
    of("log.csv", csv(&times()).into_bytes(), Format::Csv, options())
}

#[test]
fn every_format_has_the_same_motion() {
    let expected = expected();
    let times = times();
    for compression in [None, Some(mcap::Compression::Zstd), Some(mcap::Compression::Lz4)] {
        let bytes = mcap(&times, compression, &["/joint_states"]);
        assert_eq!(of("bag.mcap", bytes, Format::Mcap, options()), expected, "{compression:?}");
    }
    for (is_little, is_indexed) in [(true, true), (false, true), (true, false)] {
        let (_folder, path) = sqlite(&times, is_little, is_indexed);
        assert_eq!(only(path, options()), expected, "{is_little} {is_indexed}");
    }
    let compressions = [
        Compression::UNCOMPRESSED,
        Compression::SNAPPY,
        Compression::LZ4_RAW,
        Compression::GZIP(GzipLevel::default()),
        Compression::ZSTD(ZstdLevel::default()),
    ];
    for compression in compressions {
        let properties = WriterProperties::builder().set_compression(compression).set_data_page_size_limit(1000);
        let bytes = scalars(&times, properties.build());
        assert_eq!(of("log.parquet", bytes, Format::Parquet, options()), expected, "{compression:?}");
    }
    for has_names in [true, false] {
        assert_eq!(of("log.parquet", lists(&times, has_names), Format::Parquet, options()), expected);
    }
    for kind in ["<f8", ">f8"] {
        assert_eq!(of("log.npy", npy(&times, true, kind), Format::Npy, options()), expected, "{kind}");
    }
    let untimed = Options { rate: Some(125.0), columns: ["q", "qd", "tau"].map(str::to_owned).to_vec(), ..options() };
    assert_eq!(of("log.npy", npy(&times, false, "<f8"), Format::Npy, untimed), expected);
    // of single precision
    let single = of("log.npy", npy(&times, true, "<f4"), Format::Npy, options());
    // its times are, too, and so is the grid: at each state's own time it is the sine, to the ripple
    for (time, found) in single.time.iter().zip(&single.q[0]) {
        assert!((found - SINES[0].at(*time)[0]).abs() < 0.8 * 1e-3 + 1e-5);
    }
}

/// Units and numbers in the names of Parquet's columns are those of CSV.
#[test]
fn names_of_parquet_say_numbers_and_units() {
    type Number<'a> = &'a dyn Fn(&(f64, [[f64; 2]; 3])) -> f64;
    let times = times();
    let rows = rows(&times);
    let degrees = |radians: f64| radians / (std::f64::consts::PI / 180.0);
    let table = |schema: &str, columns: &[Number<'_>]| {
        parquet(schema, WriterProperties::builder().build(), 1, |_, writer| {
            for column in columns {
                doubles(writer, &rows.iter().map(column).collect::<Vec<_>>(), None);
            }
        })
    };
    let plain = table(
        "message log { REQUIRED DOUBLE time; REQUIRED DOUBLE q1; REQUIRED DOUBLE q2; }",
        &[&|row| row.0, &|row| degrees(row.1[0][0]), &|row| degrees(row.1[0][1])],
    );
    let turned = table(
        "message log { REQUIRED DOUBLE q2_deg; REQUIRED DOUBLE q1_deg; REQUIRED DOUBLE time_s; }",
        &[&|row| degrees(row.1[0][1]), &|row| degrees(row.1[0][0]), &|row| row.0],
    );
    let asked = Options { angles: rne_logs::Angles::Degrees, ..options() };
    let expected = of("log.parquet", plain, Format::Parquet, asked);
    assert_eq!(of("log.parquet", turned, Format::Parquet, options()), expected);
}

#[test]
fn names_of_lists_and_bags_are_the_joints() {
    for (name, bytes) in [
        ("bag.mcap", mcap(&times(), None, &["/joint_states"])),
        ("log.parquet", lists(&times(), true)),
        ("log.parquet", scalars(&times(), WriterProperties::builder().build())),
    ] {
        let (_folder, path) = file(name, bytes);
        let joints = |names: &[&str]| Options {
            joints: Some(names.iter().map(|name| (*name).to_owned()).collect()),
            ..options()
        };
        let turned = only(path.clone(), joints(&["wrist", "elbow"]));
        let plain = only(path.clone(), options());
        assert_eq!((&turned.q[0], &turned.tau[1]), (&plain.q[1], &plain.tau[0]));
        let error = runs(&[path], joints(&["wrist", "elbo"]), 1000).unwrap_err();
        assert!(
            error.to_string().contains("no joint elbo (did you mean elbow?); its joints are elbow, wrist"),
            "{error}"
        );
    }
}

/// A log of two files is one, if the second goes on where the first ends.
#[test]
fn files_that_follow_each_other_are_one_run() {
    let times = times();
    let (first, second) = times.split_at(700);
    let (_a, one) = file("bag_0.mcap", mcap(first, None, &["/js"]));
    let (_b, two) = file("bag_1.mcap", mcap(second, None, &["/js"]));
    let runs = runs(&[one, two], options(), 1000).unwrap();
    assert_eq!(runs.len(), 1);
    assert_eq!(runs[0].1, expected());
}

fn error(path: PathBuf, options: Options) -> LogError {
    match survey(&[path], options) {
        Ok(_) => panic!("it is read"),
        Err(error) => error,
    }
}

#[test]
fn topics_are_named_where_there_are_several() {
    let bytes = mcap(&times(), None, &["/left", "/right"]);
    let (_folder, path) = file("two.mcap", bytes);
    let asked = error(path.clone(), Options::default());
    let several = "several topics have joint states: /left, /right";
    assert!(asked.is_of_request() && asked.to_string().contains(several), "{asked}");
    assert_eq!(asked.remedies(), [Remedy::Give(Setting::Topic)]);
    let topic = |topic: &str| Options { topic: Some(topic.to_owned()), ..options() };
    assert_eq!(only(path.clone(), topic("/right")), expected());
    let asked = error(path.clone(), topic("/rigt"));
    assert!(asked.to_string().contains("there is no topic /rigt (did you mean /right?)"), "{asked}");
    let asked = error(path, topic("/image"));
    assert!(asked.to_string().contains("the topic /image has sensor_msgs/msg/Image"), "{asked}");

    let (_folder, path) = sqlite(&times(), true, true);
    let asked = error(path, topic("/joint_state"));
    assert!(asked.to_string().contains("(did you mean /joint_states?); joint states are in /joint_states"), "{asked}");

    let (_folder, path) = file("none.mcap", mcap(&times(), None, &[]));
    let asked = error(path, Options::default());
    assert!(asked.to_string().contains("no topic has sensor_msgs/msg/JointState; the topics are"), "{asked}");
}

/// An option that a format has no use for, or that says what the log says too, is refused.
#[test]
fn options_that_count_for_nothing_are_refused() {
    let (_folder, bag) = sqlite(&times(), true, true);
    let rate = Options { rate: Some(125.0), ..options() };
    let columns = Options { columns: ["time", "q", "tau"].map(str::to_owned).to_vec(), ..options() };
    let plain = || WriterProperties::builder().build();
    let (has, names) = (
        "a sampling rate can be given only for",
        "an order of columns can be given only for arrays of numpy, but this file is",
    );
    for (name, bytes) in [
        ("log.csv", csv(&times()).into_bytes()),
        ("log.npy", npy(&times(), true, "<f8")),
        ("log.parquet", scalars(&times(), plain())),
        ("log.parquet", lists(&times(), true)),
        ("bag.mcap", mcap(&times(), None, &["/js"])),
        ("bag.db3", std::fs::read(bag).unwrap()),
    ] {
        let (_folder, path) = file(name, bytes);
        let refused = error(path.clone(), rate.clone());
        assert!(refused.is_of_request() && refused.to_string().contains(has), "{name}: {refused}");
        if name != "log.npy" {
            let refused = error(path, columns.clone());
            assert!(refused.is_of_request() && refused.to_string().contains(names), "{name}: {refused}");
        }
    }
}

#[test]
fn other_schemas_are_told() {
    let text = parquet(
        "message log { REQUIRED DOUBLE time; REQUIRED BINARY q1 (STRING); }",
        WriterProperties::builder().build(),
        1,
        |_, writer| {
            doubles(writer, &[0.0, 1.0], None);
            let mut column = writer.next_column().unwrap().unwrap();
            let texts = ["a", "b"].map(ByteArray::from);
            column.typed::<ByteArrayType>().write_batch(&texts, None, None).unwrap();
            column.close().unwrap();
        },
    );
    let sales = parquet(
        "message log { REQUIRED FLOAT price; REQUIRED FLOAT count; }",
        WriterProperties::builder().build(),
        1,
        |_, writer| {
            for _ in 0..2 {
                let mut column = writer.next_column().unwrap().unwrap();
                column.typed::<FloatType>().write_batch(&[0.0, 1.0], None, None).unwrap();
                column.close().unwrap();
            }
        },
    );
    for (name, bytes, wanted) in [
        ("text.parquet", text, "the column q1 has texts, not numbers"),
        ("sales.parquet", sales, "no column has the position of a joint"),
        ("empty.db3", Vec::new(), "the file is empty, so it is not rosbag2, SQLite"),
        ("text.mcap", b"hello".to_vec(), "does not begin like a file of the format rosbag2, MCAP"),
        ("old.bag", b"#ROSBAG V2.0\n".to_vec(), "a bag of ROS 1"),
        ("arm.yaml", b"name: arm\nformat: 1\n".to_vec(), "this is a robot file or another YAML file, but a log"),
        ("arm.txt", b"format: 1\nname: arm\n".to_vec(), "One robot file comes first"),
        ("arm.urdf", b"<?xml version=\"1.0\"?>\n".to_vec(), "this is a URDF or another XML file"),
        ("metadata.yaml", b"rosbag2_bagfile_information:\n".to_vec(), "name the folder of the bag"),
        ("empty.csv", Vec::new(), "the file is empty"),
        ("numbers.csv", b"0,1,2\n3,4,5\n".to_vec(), "the first line has numbers"),
        (
            "no_time.csv",
            b"Zeit,q1,q2\n3,4,5\n".to_vec(),
            "no column has times: name the column of times time, t, stamp or timestamp; the columns of this file are \
             Zeit, q1, q2",
        ),
        ("words.csv", b"time,q1\n0,1\n0.1,two\n".to_vec(), "line 3: \"two\" is not a number"),
        ("short.csv", b"time,q1,q2\n0,1,2\n0.1,2\n".to_vec(), "line 3: the line has 2 cells, but the header has 3"),
        // a last line without an end, and a line without one
        ("cut.csv", b"time,q1,q2\n0,1,2\n0.1,2".to_vec(), "line 3: the line has 2 cells, but the header has 3"),
        ("one.csv", b"time,q1,q2\n0,1,2\n0.1".to_vec(), "line 3: the line has 1 cell, but the header has 3"),
        (
            "long.csv",
            [&b"time,q1,q2\n0,1,2\n"[..], &[b'1'; 1 << 21]].concat(),
            "line 3: a line has more than a million bytes",
        ),
        ("still.csv", b"time,q1\n1,1\n1,2\n1,3\n".to_vec(), "do not increase"),
        (
            "shuffled.csv",
            b"time,q1\n0.3,1\n0.1,2\n0.4,1\n0.0,2\n0.2,3\n".to_vec(),
            "in the first 5 rows, time goes back 2 times; sort the rows by their time",
        ),
        ("binary.csv", vec![1, 0, 2, 0], "bytes with the value zero"),
        ("ints.npy", npy(&times()[..3], true, "<i8"), "the numbers are"),
        ("wide.npy", npy(&times()[..3], false, "<f8"), "which does not fit the order time,q,qd,tau"),
    ] {
        let (_folder, path) = file(name, bytes);
        let error = error(path, Options::default()).to_string();
        assert!(error.contains(wanted) && error.contains(name), "{error}");
    }
    let (_folder, path) = file("other.db3", "");
    rusqlite::Connection::open(&path).unwrap().execute_batch("CREATE TABLE a(b); INSERT INTO a VALUES (1)").unwrap();
    assert!(error(path, Options::default()).to_string().contains("no tables `topics` and `messages`"));
}

/// Messages without velocities or efforts, of other joints, of some of the joints.
#[test]
fn what_is_missing_is_counted() {
    let (_folder, path) = sqlite(&[], true, true);
    let bag = rusqlite::Connection::open(&path).unwrap();
    let mut number = 0;
    let mut write = |names: &[&str], lists: [&[f64]; 3]| {
        number += 1;
        let message = joint_state(number * 8_000_000, names, lists, true);
        bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (2, ?1, ?2)", (number, message)).unwrap();
    };
    for i in 0..300 {
        let q = [f64::from(i) * 0.01, 0.5];
        match i {
            50 => write(&["gripper"], [&[0.0], &[], &[]]),
            60 => write(&["elbow"], [&[0.0], &[], &[]]),
            70 => write(&NAMES, [&[], &[], &[]]),
            80 => write(&NAMES, [&q, &[], &[1.0]]),
            90 => write(&NAMES, [&[f64::NAN, 0.0], &[], &[1.0, 1.0]]),
            _ => write(&NAMES, [&q, &[], &[1.0, 2.0]]),
        }
    }
    let (log, survey) = survey(std::slice::from_ref(&path), options()).unwrap();
    assert!(!log.layout().has_velocities && log.layout().has_efforts);
    assert_eq!(log.layout().ignored, ["gripper"]);
    let counts = survey.counts;
    assert_eq!((counts.messages, counts.states, counts.of_others, counts.without_joints), (300, 295, 1, 1));
    assert_eq!((counts.without_positions, counts.without_efforts, counts.not_finite), (1, 1, 1));
    let motion = only(path, options());
    // velocities are differences: of a ramp, its slope
    assert!(motion.qd[0].iter().all(|qd| (qd - 1.25).abs() < 1e-9));
    assert!(motion.tau[1].iter().all(|tau| (tau - 2.0).abs() < 1e-12));
}

/// Headers without times: those of recording count.
#[test]
fn stamps_of_recording_stand_in_for_missing_ones() {
    let (_folder, path) = sqlite(&[], true, true);
    let bag = rusqlite::Connection::open(&path).unwrap();
    for i in 0..200 {
        let message = joint_state(0, &NAMES, [&[f64::from(i), 0.0], &[], &[]], true);
        bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (2, ?1, ?2)", (i * 10_000_000, message))
            .unwrap();
    }
    let options = Options { angles: rne_logs::Angles::Radians, ..options() };
    let (log, survey) = survey(&[path], options).unwrap();
    assert!(log.layout().recorded && !log.layout().has_efforts);
    assert_eq!((log.layout().step, survey.efforts.len()), (0.01, 0));
}

/// Times that may be in any unit are asked for theirs, and those of bags and types are not.
#[test]
fn the_unit_of_slow_times_is_known_or_asked_for() {
    let milliseconds = Options { time_unit: Some(rne_logs::TimeUnit::Milliseconds), ..Options::default() };
    let times: Vec<f64> = (0..200).map(f64::from).collect();
    let (_folder, path) = file("log.npy", npy(&times, true, "<f8"));
    assert!(survey(std::slice::from_ref(&path), Options::default()).err().unwrap().remedies().contains(&UNIT));
    assert_eq!(survey(&[path], milliseconds).unwrap().0.layout().step, 1e-3);
    let (_folder, path) = file("log.npy", npy(&times, false, "<f8"));
    let untimed =
        Options { rate: Some(0.5), columns: ["q", "qd", "tau"].map(str::to_owned).to_vec(), ..Options::default() };
    assert_eq!(survey(&[path], untimed).unwrap().0.layout().step, 2.0);
    // bags and types say theirs: a log at 1 Hz is one
    let (_folder, path) = sqlite(&times, true, true);
    assert_eq!(survey(&[path], Options::default()).unwrap().0.layout().step, 1.0);
    let (_folder, path) = file("log.parquet", scalars(&times, WriterProperties::builder().build()));
    assert_eq!(survey(&[path], Options::default()).unwrap().0.layout().step, 1.0);
    let (_folder, path) = file("log.parquet", lists(&times, true));
    assert!(survey(&[path], Options::default()).err().unwrap().remedies().contains(&UNIT));
}
