//! What a log may have at most, whatever its format: beyond that it is refused, and says the limit.

use std::sync::Arc;

use mcap::records::MessageHeader;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::file::properties::{WriterProperties, WriterVersion};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use rne_logs::Options;

use crate::formats::{mcap, npy, sqlite};
use crate::written::{file, joint_state, survey};

fn times() -> Vec<f64> {
    (0..100).map(|i| f64::from(i) * 0.01).collect()
}

fn refused(path: std::path::PathBuf, options: Options) -> String {
    match survey(&[path], options) {
        Ok((log, _)) => panic!("it is read: {:?}", log.layout()),
        Err(error) => error.to_string(),
    }
}

/// A table in Parquet of a time, lists of positions and, where there are any, of names.
fn lists(lengths: &[usize], names: Option<&str>, properties: WriterProperties) -> Vec<u8> {
    let list = |name: &str, kind: &str, of: &str| {
        format!("REQUIRED group {name} (LIST) {{ REPEATED group list {{ REQUIRED {kind} element {of}; }} }}")
    };
    let of_names = names.map_or(String::new(), |_| list("name", "BINARY", "(STRING)"));
    let schema = format!("message log {{ REQUIRED DOUBLE t; {} {of_names} }}", list("position", "DOUBLE", ""));
    let mut bytes = Vec::new();
    let schema = Arc::new(parse_message_type(&schema).unwrap());
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties)).unwrap();
    let mut group = writer.next_row_group().unwrap();
    let times: Vec<f64> = (0..lengths.len()).map(|i| i as f64 * 0.01).collect();
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<DoubleType>().write_batch(&times, None, None).unwrap();
    column.close().unwrap();
    let total: usize = lengths.iter().sum();
    let definitions = vec![1; total];
    let repetitions: Vec<i16> = lengths.iter().flat_map(|length| (0..*length).map(|i| i16::from(i > 0))).collect();
    let mut column = group.next_column().unwrap().unwrap();
    let zeros = vec![0.0; total];
    column.typed::<DoubleType>().write_batch(&zeros, Some(&definitions), Some(&repetitions)).unwrap();
    column.close().unwrap();
    if let Some(first) = names {
        let of_row = |length: &usize| {
            let others = (1..*length).map(|i| i.to_string());
            [first.to_owned()].into_iter().take((*length).min(1)).chain(others).collect::<Vec<_>>()
        };
        let texts: Vec<ByteArray> =
            lengths.iter().flat_map(of_row).map(|name| ByteArray::from(name.as_str())).collect();
        let mut column = group.next_column().unwrap().unwrap();
        column.typed::<ByteArrayType>().write_batch(&texts, Some(&definitions), Some(&repetitions)).unwrap();
        column.close().unwrap();
    }
    group.close().unwrap();
    writer.close().unwrap();
    bytes
}

fn plain() -> WriterProperties {
    WriterProperties::builder().build()
}

#[test]
fn lists_of_parquet_are_as_long_as_joints_are_many() {
    let small_pages = || {
        WriterProperties::builder().set_dictionary_enabled(false).set_data_page_size_limit(500).set_write_batch_size(10)
    };
    for version in [WriterVersion::PARQUET_1_0, WriterVersion::PARQUET_2_0] {
        for properties in [plain(), small_pages().set_writer_version(version).build()] {
            let mut lengths = vec![1024; 80];
            let (_folder, path) = file("log.parquet", lists(&lengths, None, properties.clone()));
            let (log, _) = survey(&[path], Options::default()).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(log.layout().joints.len(), 1024);
            // one that is longer: the first, a later one
            for place in [0, 70] {
                lengths[place] = 1025;
                let (_folder, path) = file("log.parquet", lists(&lengths, None, properties.clone()));
                let error = refused(path, Options::default());
                assert!(
                    error.contains("a list of position has 1025 numbers or more; rne reads at most 1024"),
                    "{error}"
                );
                assert!(!error.contains("corrupt"), "{error}");
                lengths[place] = 1024;
            }
        }
    }
    // four kilobytes that claim five million numbers
    let bytes = lists(&[5_000_000, 2, 2], None, plain());
    assert!(bytes.len() < 20_000, "{}", bytes.len());
    let (_folder, path) = file("log.parquet", bytes);
    assert!(refused(path, Options::default()).contains("rne reads at most 1024"));
}

/// A file whose end claims more than it has is cut off, and one that claims too much is not tried.
#[test]
fn the_end_of_parquet_has_a_limit() {
    let bytes = lists(&[2; 80], None, plain());
    for (length, wanted) in
        [(20_000_000_u32, "has 20000000 bytes; rne reads at most 16777216"), (10_000_000, "cut off")]
    {
        let mut bytes = bytes.clone();
        let place = bytes.len() - 8;
        bytes[place..place + 4].copy_from_slice(&length.to_le_bytes());
        let (_folder, path) = file("log.parquet", bytes);
        let error = refused(path, Options::default());
        assert!(error.contains(wanted), "{error}");
    }
}

#[test]
fn names_are_of_some_length() {
    let long = |length: usize| "a".repeat(length);
    let (_folder, path) = file("log.parquet", lists(&[2; 80], Some(&long(256)), plain()));
    let (log, _) = survey(&[path], Options::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(log.layout().joints, [long(256), "1".to_owned()]);
    let (_folder, path) = file("log.parquet", lists(&[2; 80], Some(&long(257)), plain()));
    let error = refused(path, Options::default());
    assert!(error.contains("has 257 bytes; rne reads names of at most 256 bytes"), "{error}");

    for (names, wanted) in [
        (vec![long(257)], "message 1 of /joint_states cannot be read: the name of a joint has 257 bytes"),
        ((0..1025).map(|i| i.to_string()).collect(), "it names 1025 joints; rne reads at most 1024"),
    ] {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let message = joint_state(10_000_000, &names, [&vec![0.0; names.len()], &[], &[]], true);
        let (_folder, path) = sqlite(&[], true, true);
        let bag = rusqlite::Connection::open(&path).unwrap();
        bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (2, 1, ?1)", (message.clone(),)).unwrap();
        let error = refused(path, Options::default());
        assert!(error.contains(wanted), "{error}");

        let mut bytes = std::io::Cursor::new(Vec::new());
        let mut writer = mcap::Writer::new(&mut bytes).unwrap();
        let schema = writer.add_schema("sensor_msgs/msg/JointState", "ros2msg", b"").unwrap();
        let channel_id =
            writer.add_channel(schema, "/joint_states", "cdr", &std::collections::BTreeMap::new()).unwrap();
        let header = MessageHeader { channel_id, sequence: 0, log_time: 1, publish_time: 1 };
        writer.write_to_known_channel(&header, &message).unwrap();
        writer.finish().unwrap();
        drop(writer);
        let (_folder, path) = file("bag.mcap", bytes.into_inner());
        let error = refused(path, Options::default());
        assert!(error.contains(wanted), "{error}");
    }
}

#[test]
fn lists_of_messages_are_as_long_as_joints_are_many() {
    let message = joint_state(10_000_000, &["a"], [&vec![0.0; 1025], &[], &[]], true);
    let (_folder, path) = sqlite(&[], true, true);
    let bag = rusqlite::Connection::open(&path).unwrap();
    bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (2, 1, ?1)", (message,)).unwrap();
    assert!(refused(path, Options::default()).contains("it has 1025 positions; rne reads at most 1024"));
}

/// Of two files in one, or two arrays, the second would not be read.
#[test]
fn what_follows_the_end_of_a_file_is_refused() {
    let times: Vec<f64> = (0..300).map(|i| f64::from(i) * 0.01).collect();
    let (_folder, bag) = sqlite(&times, true, true);
    for (name, one, wanted) in [
        ("bag.mcap", mcap(&times, None, &["/js"]), "the bag ends at byte"),
        ("zstd.mcap", mcap(&times, Some(mcap::Compression::Zstd), &["/js"]), "the bag ends at byte"),
        ("bag.db3", std::fs::read(bag).unwrap(), "the bag ends at byte"),
        ("log.npy", npy(&times, true, "<f8"), "the array ends at byte"),
    ] {
        let (_folder, path) = file(name, &one);
        assert!(survey(&[path], Options::default()).is_ok(), "{name}");
        let (_folder, path) = file(name, [&one[..], &one].concat());
        let error = refused(path, Options::default());
        assert!(error.contains(&format!("{wanted} {}", one.len())), "{name} of {}: {error}", one.len());
    }
}

/// Records of MCAP: a kind, a length, and what is in it.
fn record(kind: u8, parts: &[&[u8]]) -> Vec<u8> {
    let body = parts.concat();
    [&[kind][..], &(body.len() as u64).to_le_bytes(), &body].concat()
}

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}

/// Zeros are packed ten thousand to one, and unpacking them takes as long as if they were numbers.
#[test]
fn chunks_unpack_to_what_logs_are_packed_from() {
    let header = record(1, &[&text("ros2"), &text("test")]);
    for (unpacked, wanted) in [
        (1_u64 << 32, "a chunk states that it unpacks to 4294967296 bytes"),
        (256 * 8192 + 256, "a chunk states that it unpacks to 2097408 bytes"),
        (256 * 8192, "the file is corrupt"),
        (1 << 20, "the file is corrupt"),
    ] {
        let zeros = vec![0; 8192];
        let (size, length) = (unpacked.to_le_bytes(), 8192_u64.to_le_bytes());
        let chunk = record(6, &[&[0; 16], &size, &[0; 4], &text("zstd"), &length, &zeros]);
        let (_folder, path) = file("bag.mcap", [mcap::MAGIC, &header, &chunk].concat());
        let error = refused(path, Options::default());
        assert!(error.contains(wanted), "{unpacked}: {error}");
    }
}

#[test]
fn a_channel_is_defined_once() {
    let schema =
        |number: u16, name: &str| record(3, &[&number.to_le_bytes(), &text(name), &text("ros2msg"), &text("")]);
    let channel = |number: u16, schema: u16, topic: &str, encoding: &str| {
        record(4, &[&number.to_le_bytes(), &schema.to_le_bytes(), &text(topic), &text(encoding), &text("")])
    };
    let message = |number: u16, i: i64| {
        let state = joint_state(i * 10_000_000, &["a"], [&[0.0], &[], &[]], true);
        let time = (i as u64 * 10_000_000).to_le_bytes();
        record(5, &[&number.to_le_bytes(), &(i as u32).to_le_bytes(), &time, &time, &state])
    };
    let header = record(1, &[&text(""), &text("test")]);
    let end = [record(15, &[&[0; 4]]), record(2, &[&[0; 20]])].concat();
    let (own, image) = ("sensor_msgs/msg/JointState", "sensor_msgs/msg/Image");
    let bag = |second: &[u8]| {
        let messages = |from: i64, number| (from..from + 100).flat_map(|i| message(number, i)).collect::<Vec<u8>>();
        let first = [schema(1, own), channel(1, 1, "/a", "cdr")].concat();
        [mcap::MAGIC, &header, &first, &messages(0, 1), second, &messages(100, 1), &end, mcap::MAGIC].concat()
    };
    for (second, wanted) in [
        (vec![], None),
        ([schema(1, own), channel(1, 1, "/a", "cdr")].concat(), None),
        (
            channel(1, 1, "/b", "cdr"),
            Some("channel 1 is defined twice, as /a (sensor_msgs/msg/JointState, cdr) and as /b"),
        ),
        (channel(1, 1, "/a", "json"), Some("channel 1 is defined twice")),
        (
            schema(1, image),
            Some("schema 1 is defined twice, as sensor_msgs/msg/JointState and as sensor_msgs/msg/Image"),
        ),
        (channel(2, 1, "/a", "json"), Some("the topic /a is encoded as \"json\", not as cdr")),
        (
            [schema(2, image), channel(2, 2, "/a", "cdr")].concat(),
            Some("the topic /a has joint states, but has sensor_msgs/msg/Image in channel 2"),
        ),
        (channel(2, 1, &"t".repeat(257), "cdr"), Some("has 257 bytes; rne reads names of at most 256 bytes")),
    ] {
        let (_folder, path) = file("bag.mcap", bag(&second));
        match (survey(&[path], Options::default()), wanted) {
            (Ok((_, found)), None) => assert_eq!(found.counts.states, 200),
            (Err(error), Some(wanted)) => assert!(error.to_string().contains(wanted), "{error}"),
            (Err(error), None) => panic!("{error}"),
            (Ok(_), Some(wanted)) => panic!("{wanted}"),
        }
    }
}

/// Data that is computed when it is read, of any length.
#[test]
fn long_data_of_sqlite_is_not_loaded() {
    for data in [
        "zeroblob(900000000)",
        "CAST(replace(hex(zeroblob(30000)), '0', 'aaaaaaaaaaaaaaaaaaaa') AS BLOB)",
        "CAST(printf('%900000000s', '') AS BLOB)",
    ] {
        let (_folder, path) = file("bag.db3", "");
        let bag = rusqlite::Connection::open(&path).unwrap();
        bag.execute_batch(&format!(
            "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);
             CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data AS ({data}));
             INSERT INTO topics VALUES (2, '/js', 'sensor_msgs/msg/JointState', 'cdr');
             INSERT INTO messages(topic_id, timestamp) VALUES (2, 1)"
        ))
        .unwrap();
        let error = refused(path, Options::default());
        assert!(error.contains("a message has more than 1048576 bytes"), "{data}: {error}");
    }
    // a message of any topic may be long
    let (_folder, path) = sqlite(&times(), true, true);
    let bag = rusqlite::Connection::open(&path).unwrap();
    bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (1, 5, zeroblob(8000000))", ()).unwrap();
    assert_eq!(survey(std::slice::from_ref(&path), Options::default()).unwrap().1.counts.states, 100);
    bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (2, 5, zeroblob(8000000))", ()).unwrap();
    let error = refused(path, Options::default());
    assert!(error.contains("message 2 of /joint_states cannot be read: it has 8000000 bytes"), "{error}");
}

/// A bag whose recorder writes its changes beside it first.
#[test]
fn nothing_is_left_beside_a_bag() {
    let (folder, path) = sqlite(&times(), true, true);
    let bag = rusqlite::Connection::open(&path).unwrap();
    bag.query_row("PRAGMA journal_mode = WAL", [], |_| Ok(())).unwrap();
    drop(bag);
    let names = |folder: &std::path::Path| {
        let mut names: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    };
    assert_eq!(names(folder.path()), ["bag.db3"]);
    let states = |path: &std::path::Path| survey(&[path.to_owned()], Options::default()).unwrap().1.counts.states;
    assert_eq!(states(&path), 100);
    assert_eq!(names(folder.path()), ["bag.db3"]);
    // one more message, which the bag does not have yet: that of a recorder that ended hard
    let bag = rusqlite::Connection::open(&path).unwrap();
    let message = joint_state(1_000_000_000, &["elbow", "wrist"], [&[0.1; 2], &[0.0; 2], &[0.0; 2]], true);
    bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (2, 1000000000, ?1)", (message,)).unwrap();
    let copy = tempfile::tempdir().unwrap();
    let strange = copy.path().join("a 50% bag?#.db3");
    std::fs::copy(&path, &strange).unwrap();
    std::fs::copy(folder.path().join("bag.db3-wal"), copy.path().join("a 50% bag?#.db3-wal")).unwrap();
    let before = names(copy.path());
    assert_eq!(states(&strange), 101);
    assert_eq!(names(copy.path()), before);
    // while the recorder runs, its own files stay
    let before = names(folder.path());
    assert_eq!((states(&path), names(folder.path())), (101, before));
    drop(bag);
    std::fs::copy(&path, &strange).unwrap();
    std::fs::remove_file(copy.path().join("a 50% bag?#.db3-wal")).unwrap();
    assert_eq!((states(&strange), names(copy.path()).len()), (101, 1));
}
