//! Tables in Parquet: two arms in one, integers without a sign, compression.

use std::path::Path;

use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int32Type, Int64Type};
use parquet::file::properties::WriterProperties;
use rne_logs::{Options, TimeUnit};

use crate::formats::parquet;
use crate::written::{file, survey};

/// A column of a table: its name, and its numbers, lists of texts or lists of numbers.
enum Column {
    Numbers(&'static str, Vec<f64>),
    Names(&'static str, [&'static str; 2]),
    Lists(&'static str, Vec<[f64; 2]>),
    /// With the type of the schema.
    Int32(&'static str, &'static str, Vec<i32>),
    Int64(&'static str, &'static str, Vec<i64>),
}

const ROWS: usize = 200;

fn table(columns: &[Column]) -> Vec<u8> {
    let list = |name: &str, kind: &str| {
        format!("REQUIRED group {name} (LIST) {{ REPEATED group list {{ REQUIRED {kind}; }} }}")
    };
    let of = |column: &Column| match column {
        Column::Numbers(name, _) => format!("REQUIRED DOUBLE {name};"),
        Column::Names(name, _) => list(name, "BINARY element (STRING)"),
        Column::Lists(name, _) => list(name, "DOUBLE element"),
        Column::Int32(name, kind, _) => format!("REQUIRED INT32 {name} {kind};"),
        Column::Int64(name, kind, _) => format!("REQUIRED INT64 {name} {kind};"),
    };
    let schema = format!("message log {{ {} }}", columns.iter().map(of).collect::<String>());
    let (definitions, repetitions) = (vec![1; 2 * ROWS], [0, 1].repeat(ROWS));
    parquet(&schema, WriterProperties::builder().build(), 1, |_, writer| {
        for column in columns {
            let mut out = writer.next_column().unwrap().unwrap();
            match column {
                Column::Numbers(_, numbers) => out.typed::<DoubleType>().write_batch(numbers, None, None),
                Column::Names(_, names) => {
                    let texts: Vec<ByteArray> = (0..ROWS).flat_map(|_| names.map(ByteArray::from)).collect();
                    out.typed::<ByteArrayType>().write_batch(&texts, Some(&definitions), Some(&repetitions))
                }
                Column::Lists(_, rows) => {
                    out.typed::<DoubleType>().write_batch(rows.as_flattened(), Some(&definitions), Some(&repetitions))
                }
                Column::Int32(_, _, numbers) => out.typed::<Int32Type>().write_batch(numbers, None, None),
                Column::Int64(_, _, numbers) => out.typed::<Int64Type>().write_batch(numbers, None, None),
            }
            .unwrap();
            out.close().unwrap();
        }
    })
}

fn times(step: f64) -> Vec<f64> {
    (0..ROWS).map(|i| i as f64 * step).collect()
}

/// Positions about two and about minus two.
fn positions() -> Vec<[f64; 2]> {
    times(0.01).into_iter().map(|t| [2.0 + t.sin(), -2.0 + t.cos()]).collect()
}

fn of(topic: &str) -> Options {
    Options { topic: Some(topic.to_owned()), ..Options::default() }
}

fn refused(columns: &[Column], options: Options) -> String {
    let (_folder, path) = file("log.parquet", table(columns));
    let error = survey(&[path], options).err().unwrap();
    error.to_string()
}

/// Of two arms, names, times and numbers are those of the one that is asked for.
#[test]
fn names_and_times_are_those_of_the_arm_that_is_read() {
    let lists = [
        Column::Numbers("left.stamp", times(0.02)),
        Column::Names("left.name", ["j1", "j2"]),
        Column::Lists("left.position", positions()),
        Column::Numbers("right.stamp", times(0.01)),
        Column::Names("right.name", ["j2", "j1"]),
        Column::Lists("right.position", positions()),
    ];
    for (arm, step, first) in [("right", 0.01, "j2"), ("left", 0.02, "j1"), ("/right", 0.01, "j2")] {
        let (_folder, path) = file("log.parquet", table(&lists));
        let (log, found) = survey(&[path], of(arm)).unwrap_or_else(|error| panic!("{error}"));
        let layout = log.layout();
        assert_eq!((layout.step, layout.joints.len()), (step, 2), "{arm}");
        for (joint, (least, _)) in layout.joints.iter().zip(&found.positions) {
            assert_eq!(*least > 0.0, joint == first, "{arm}: {joint} from {least}");
        }
        let other = if arm == "left" { "right.stamp" } else { "left.stamp" };
        assert_eq!(layout.notes, [format!("other times that are not read: {other}")]);
    }
    let scalars = [
        Column::Numbers("left.stamp", times(0.02)),
        Column::Numbers("left_q1", times(0.01)),
        Column::Numbers("right.stamp", times(0.01)),
        Column::Numbers("right_q1", times(0.01)),
    ];
    let (_folder, path) = file("log.parquet", table(&scalars));
    assert_eq!(survey(&[path], of("right")).unwrap().0.layout().step, 0.01);
    // a name that says no unit of the option, of lists as of single columns
    let said = [Column::Numbers("t_ms", times(10.0)), Column::Lists("position", positions())];
    let seconds = Options { time_unit: Some(TimeUnit::Seconds), ..Options::default() };
    assert!(refused(&said, seconds).contains("the column t_ms has times in ms, but you gave s"));
}

#[test]
fn what_may_be_of_either_arm_is_refused() {
    let (left, centre) = (times(0.02), times(0.01));
    for (columns, wanted) in [
        (
            [
                Column::Numbers("left.stamp", left.clone()),
                Column::Numbers("centre.stamp", centre.clone()),
                Column::Lists("right.position", positions()),
            ],
            "the columns left.stamp and centre.stamp both contain times, and neither begins with right",
        ),
        (
            [
                Column::Numbers("left.stamp", left.clone()),
                Column::Numbers("centre.stamp", centre),
                Column::Numbers("right_q1", times(0.01)),
            ],
            "the columns left.stamp and centre.stamp both contain times, and neither begins with right",
        ),
    ] {
        let error = refused(&columns, of("right"));
        assert!(error.contains(wanted), "{error}");
    }
    let names = [
        Column::Numbers("t", left),
        Column::Names("left.name", ["a", "b"]),
        Column::Names("centre.name", ["b", "a"]),
        Column::Lists("right.position", positions()),
    ];
    let error = refused(&names, of("right"));
    assert!(error.contains("the columns left.name, centre.name all contain names of joints"), "{error}");
}

/// Counters of controllers go on beyond the half of what they hold.
#[test]
fn integers_without_a_sign_have_none() {
    let half = 1_u32 << 31;
    let stamps: Vec<i32> = (0..ROWS as u32).map(|i| (half - 1000 + 10 * i).cast_signed()).collect();
    let far: Vec<i32> = (0..ROWS as u32).map(|i| (4_000_000_000 + i).cast_signed()).collect();
    let long: Vec<i64> = (0..ROWS as u64).map(|i| ((1_u64 << 63) + (i << 20)).cast_signed()).collect();
    let milliseconds = Options { time_unit: Some(TimeUnit::Milliseconds), ..Options::default() };
    for kind in ["(INTEGER(32,false))", "(UINT_32)"] {
        let columns = [
            Column::Int32("t", kind, stamps.clone()),
            Column::Int32("q1", kind, far.clone()),
            Column::Int64("q2", "(INTEGER(64,false))", long.clone()),
        ];
        let (_folder, path) = file("log.parquet", table(&columns));
        let (log, found) = survey(&[path], milliseconds.clone()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((log.layout().step, found.run_count, found.counts.messages), (0.01, 0, 200), "{kind}");
        assert_eq!(found.counts.not_finite, 200, "2^63 was not measured");
        let columns = [Column::Int32("t", kind, stamps.clone()), Column::Int32("q1", kind, far.clone())];
        let (_folder, path) = file("log.parquet", table(&columns));
        let (_, found) = survey(&[path], milliseconds.clone()).unwrap();
        assert_eq!(found.positions[0], (4e9, 4e9 + 199.0), "{kind}");
    }
    // with a sign, as it was
    let below: Vec<i32> = (-100..100).collect();
    let columns = [Column::Int32("t", "", below.clone()), Column::Int32("q1", "(INTEGER(32,true))", below)];
    let (_folder, path) = file("log.parquet", table(&columns));
    let (log, found) = survey(&[path], milliseconds).unwrap();
    assert_eq!((log.layout().step, found.positions[0]), (0.001, (-100.0, 99.0)));
    // beyond what nanoseconds count
    let columns = [Column::Int64("t", "(UINT_64)", long), Column::Numbers("q1", times(0.01))];
    let nanoseconds = Options { time_unit: Some(TimeUnit::Nanoseconds), ..Options::default() };
    assert!(
        refused(&columns, nanoseconds).contains("row 0: t is missing, is not a number, or is later than the year 2262")
    );
}

/// The table is one that pyarrow wrote.
#[test]
fn a_compression_that_is_not_read_is_named() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/brotli.parquet");
    let error = survey(&[path], Options::default()).err().unwrap().to_string();
    assert!(error.contains("compressed with brotli, which rne does not read: write the file with zstd"), "{error}");
    assert!(!error.contains("corrupt"), "{error}");
}
