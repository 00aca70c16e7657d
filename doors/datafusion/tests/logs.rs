//! Logs in SQL: the friction of each robot per day, as `rne identify` finds it in each log, and the residual without
//! accelerations.

use std::fmt::Write as _;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use datafusion::arrow::array::{
    Array, ArrayRef, AsArray, Float64Array, ListArray, RecordBatch, StringArray, UInt64Array,
};
use datafusion::arrow::compute::{concat_batches, take_record_batch};
use datafusion::arrow::datatypes::Float64Type;
use datafusion::common::Result;
use datafusion::prelude::{ParquetReadOptions, SessionConfig, SessionContext};
use rne::DynArm;
use rne::model::Robot;
use rne_datafusion::{Robots, register};
use rne_identify::{ArmLog, ArmLogOptions, Identification, MotionError, Options, Part, PassError, identify};
use rne_logs::{Log, MotionParquet};
use rne_watch::Signals;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// A robot, a day since 1970, and the log of the documents that the robot recorded on this day.
const LOGS: [(&str, i64, &str); 4] = [
    ("r1", 20_780, "desk_arm_log.csv"),
    ("r1", 20_781, "desk_arm_worn.csv"),
    ("r2", 20_780, "desk_arm_loaded.csv"),
    ("r2", 20_781, "desk_arm_log.csv"),
];

fn document(name: &str) -> String {
    std::fs::read_to_string(format!("{ROOT}/docs/{name}")).expect("a document of this repository")
}

fn arm() -> Robot {
    Robot::from_yaml(&document("desk_arm.yaml")).unwrap_or_else(|report| panic!("{report}"))
}

fn context(partitions: usize) -> (SessionContext, Robots) {
    let robots = Robots::none().with_yaml(&document("desk_arm.yaml")).expect("it is right");
    let context = SessionContext::new_with_config(SessionConfig::new().with_target_partitions(partitions));
    register(&context, &robots);
    (context, robots)
}

/// A log with dates in place of its seconds.
fn dated(folder: &Path, (robot, day, log): (&str, i64, &str)) -> PathBuf {
    let text = document(log);
    let mut lines = text.lines();
    let mut dated = lines.next().expect("a header").replacen("time", "time_ns", 1);
    for line in lines {
        let (seconds, rest) = line.split_once(',').expect("columns");
        let seconds: f64 = seconds.parse().expect("a number");
        #[allow(clippy::cast_possible_truncation)]
        let stamp = (day * 86_400 + 36_000) * 1_000_000_000 + (seconds * 1e9).round() as i64;
        write!(dated, "\n{stamp},{rest}").expect("a text grows");
    }
    let path = folder.join(format!("{robot}_{day}.csv"));
    std::fs::write(&path, dated).expect("a file");
    path
}

/// The motions of logs in one table, as `rne log --by robot_id -o` writes them.
fn write(path: &Path, logs: &[(&str, PathBuf)]) {
    let mut out: Option<MotionParquet<File>> = None;
    for (robot, log) in logs {
        let log = Log::open(std::slice::from_ref(log), rne_logs::Options::default()).expect("a log");
        let survey = log.survey(|_| ()).expect("a log");
        let file = || File::create(path).expect("a file");
        let out =
            out.get_or_insert_with(|| MotionParquet::new(file(), log.layout(), Some("robot_id")).expect("a table"));
        for piece in log.motions(&survey).expect("motions") {
            let piece = piece.expect("a motion");
            out.push(log.layout(), piece.run, &piece.motion, robot).expect("rows");
        }
    }
    out.expect("a log").finish().expect("a table");
}

/// As `rne identify FILE LOG` does it.
fn identified(path: &Path) -> Identification {
    let robot = arm();
    let log = ArmLog::open(&[path.to_owned()], &robot, &ArmLogOptions::default()).expect("a log of the arm");
    let mut options = Options::default();
    options.cutoff = Some(log.cutoff());
    identify::<PassError<MotionError>>(&robot, options, 1.0, |take| log.pass(Part::All, take))
        .expect("it is identified")
}

/// A block of SQL of the document, by a part of it.
fn recipe(part: &str) -> String {
    let text = document("fleet.md");
    let blocks = text.split("```sql\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.filter(|block| block.contains(part)).map(str::to_owned).next().expect("a block of the document")
}

async fn one(context: &SessionContext, robots: &Robots, sql: &str) -> Result<RecordBatch> {
    let sql = sql.replace("{desk_arm}", &format!("'{}'", robots.key("desk_arm").expect("it is held")));
    let frame = context.sql(&sql).await?;
    let schema = Arc::new(frame.schema().as_arrow().clone());
    Ok(concat_batches(&schema, &frame.collect().await?)?)
}

fn texts(batch: &RecordBatch, column: &str) -> Vec<String> {
    let column = datafusion::arrow::compute::cast(
        batch.column_by_name(column).expect("a column"),
        &datafusion::arrow::datatypes::DataType::Utf8,
    );
    column.expect("texts").as_string::<i32>().iter().map(|text| text.expect("no null").to_owned()).collect()
}

fn numbers(batch: &RecordBatch, column: &str) -> Vec<f64> {
    batch.column_by_name(column).expect("a column").as_primitive::<Float64Type>().values().to_vec()
}

#[tokio::test]
async fn friction_of_each_robot_per_day_is_that_of_each_log() -> Result<()> {
    let folder = tempfile::tempdir().expect("a folder");
    let logs: Vec<(&str, PathBuf)> = LOGS.iter().map(|log| (log.0, dated(folder.path(), *log))).collect();
    write(&folder.path().join("motion.parquet"), &logs);
    for is_shuffled in [false, true] {
        let (context, robots) = context(3);
        let path = folder.path().join("motion.parquet");
        context.register_parquet("motion", path.to_str().expect("UTF-8"), ParquetReadOptions::default()).await?;
        if is_shuffled {
            let rows = one(&context, &robots, "SELECT * FROM motion").await?;
            let mut order: Vec<u64> = (0..rows.num_rows() as u64).collect();
            fastrand::Rng::with_seed(7).shuffle(&mut order);
            let rows = take_record_batch(&rows, &UInt64Array::from(order))?;
            context.deregister_table("motion")?;
            context.register_batch("motion", rows)?;
        }
        let found = one(&context, &robots, &recipe("identify({desk_arm}, time, q, qd, tau)")).await?;
        let rows: Vec<[String; 3]> = texts(&found, "robot_id")
            .into_iter()
            .zip(texts(&found, "day"))
            .zip(texts(&found, "parameter"))
            .map(|((robot, day), parameter)| [robot, day, parameter])
            .collect();
        assert_eq!(rows.len(), LOGS.len() * 9, "{rows:?}");
        let (values, deviations) = (numbers(&found, "value"), numbers(&found, "deviation"));
        for ((robot, day, name), log) in LOGS.into_iter().zip(&logs) {
            let alone = folder.path().join(format!("{robot}_{day}.parquet"));
            write(&alone, std::slice::from_ref(log));
            let expected = identified(&alone);
            let day = format!("2026-11-{}", day - 20_757);
            for (joint, report) in expected.joints.iter().enumerate() {
                let friction = report.friction.expect("it was asked for");
                let names = ["viscous", "coulomb_forward", "coulomb_backward"];
                for (parameter, (value, deviation)) in names.into_iter().zip(friction) {
                    let row = [robot.to_owned(), day.clone(), format!("{parameter}{}", joint + 1)];
                    let at = rows.iter().position(|of| *of == row).unwrap_or_else(|| panic!("{row:?} of {rows:?}"));
                    // a number near 0 is known to its deviation
                    let is_same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs() + 1e-6 * deviation;
                    assert!(is_same(values[at], value), "{row:?}: {} {value}", values[at]);
                    assert!(is_same(deviations[at], deviation), "{row:?}: {} {deviation}", deviations[at]);
                }
            }
            // the log itself has other rows than its filtered motion, and its own filter: numbers differ by less than
            // two deviations
            for (joint, (own, report)) in identified(&log.1).joints.iter().zip(&expected.joints).enumerate() {
                let pairs = own.friction.into_iter().flatten().zip(report.friction.into_iter().flatten());
                for ((own, _), (value, deviation)) in pairs {
                    println!("{robot} {day} joint {joint}: {own:.4} {value:.4} ± {deviation:.4}");
                    assert!(
                        (own - value).abs() < 2.0 * deviation,
                        "{robot} {day} {joint}: {own} {value} ± {deviation}"
                    );
                }
            }
            // the worn elbow is seen
            let elbow = expected.joints[2].friction.expect("friction")[1].0;
            println!("{robot} {day}: elbow {elbow:.4} N m");
            assert_eq!(elbow > 0.36, name == "desk_arm_worn.csv", "{robot} {day}: {elbow}");
        }
    }
    Ok(())
}

/// One robot whose log is too short does not end the query: its row says why.
#[tokio::test]
async fn a_group_that_cannot_be_identified_has_an_error() -> Result<()> {
    let (context, robots) = context(2);
    let folder = tempfile::tempdir().expect("a folder");
    let log = dated(folder.path(), LOGS[0]);
    let path = folder.path().join("motion.parquet");
    write(&path, &[("r1", log)]);
    context.register_parquet("motion", path.to_str().expect("UTF-8"), ParquetReadOptions::default()).await?;
    let sql = "SELECT robot_id, found['states'] AS states, found['error'] AS error, found['delay'] AS delay FROM \
               (SELECT robot_id, identify({desk_arm}, time, q, qd, tau) AS found FROM (SELECT * FROM motion UNION \
               ALL (SELECT time, name, q, qd, qdd, tau, run, 'r2' AS robot_id FROM motion ORDER BY time LIMIT 5)) \
               GROUP BY robot_id) ORDER BY robot_id";
    let found = one(&context, &robots, sql).await?;
    assert_eq!(texts(&found, "robot_id"), ["r1", "r2"]);
    let errors = found.column_by_name("error").expect("a column").as_string::<i32>();
    assert!(errors.is_null(0) && !errors.value(1).is_empty(), "{errors:?}");
    println!("{}", errors.value(1));
    let states: Vec<i64> = found
        .column_by_name("states")
        .expect("a column")
        .as_primitive::<datafusion::arrow::datatypes::Int64Type>()
        .values()
        .to_vec();
    assert!(states[0] > 300 && states[1] == 5, "{states:?}");
    assert!(found.column_by_name("delay").expect("a column").is_valid(0));
    Ok(())
}

/// The state of a joint at a time, in order: time, and for each quantity a number per joint.
struct Row {
    time: f64,
    lists: [Vec<f64>; 3],
}

fn table(rows: &[Row]) -> RecordBatch {
    let mut columns: Vec<(&str, ArrayRef)> =
        vec![("time", Arc::new(rows.iter().map(|row| Some(row.time)).collect::<Float64Array>()))];
    columns.push(("log", Arc::new(rows.iter().map(|_| Some("a")).collect::<StringArray>())));
    for (at, name) in ["q", "qd", "tau"].into_iter().enumerate() {
        let lists = rows.iter().map(|row| Some(row.lists[at].iter().copied().map(Some)));
        columns.push((name, Arc::new(ListArray::from_iter_primitive::<Float64Type, _, _>(lists))));
    }
    RecordBatch::try_from_iter(columns).expect("columns of one length")
}

/// A motion in closed form with the torques of the arm's engine, and a constant torque of the environment on joint 2
/// from 1 s on.
fn pushed(robot: &Robot, external: f64) -> (Vec<Row>, rne_logs::Motion) {
    let dynamics = DynArm::from_robot(robot);
    let mut motion = rne_logs::Motion::default();
    (motion.q, motion.qd) = (vec![Vec::new(); 3], vec![Vec::new(); 3]);
    (motion.qdd, motion.tau) = (vec![Vec::new(); 3], vec![Vec::new(); 3]);
    let rows = (0..2000).map(|at| {
        let time = f64::from(at) * 1e-3;
        let of = |wave: fn(f64) -> f64, power: i32| -> Vec<f64> {
            (1..4).map(|k| 0.4 * f64::from(k).powi(power) * wave(f64::from(k) * time)).collect()
        };
        let (q, qd, qdd) = (of(f64::sin, 0), of(f64::cos, 1), of(|x| -x.sin(), 2));
        let mut tau = dynamics.inverse_dynamics(&q, &qd, &qdd).expect("of the arm");
        tau[1] -= if time >= 1.0 { external } else { 0.0 };
        motion.time.push(time);
        for joint in 0..3 {
            motion.q[joint].push(q[joint]);
            motion.qd[joint].push(qd[joint]);
            motion.qdd[joint].push(qdd[joint]);
            motion.tau[joint].push(tau[joint]);
        }
        Row { time, lists: [q, qd, tau] }
    });
    (rows.collect(), motion)
}

fn model(robot: &Robot, motion: &rne_logs::Motion, row: usize) -> Vec<f64> {
    let of = |list: &[Vec<f64>]| -> Vec<f64> { list.iter().map(|joint| joint[row]).collect() };
    let torques = DynArm::from_robot(robot).inverse_dynamics(&of(&motion.q), &of(&motion.qd), &of(&motion.qdd));
    torques.expect("of the arm")
}

fn residuals(batch: &RecordBatch) -> Vec<Option<Vec<f64>>> {
    let list = batch.column_by_name("residual").expect("a column").as_list::<i32>();
    list.iter().map(|row| row.map(|row| row.as_primitive::<Float64Type>().values().to_vec())).collect()
}

#[tokio::test]
async fn the_residual_needs_no_accelerations() -> Result<()> {
    // the file has no friction, so the torque of the environment is all that the model lacks
    let robot = arm();
    let (rows, motion) = pushed(&robot, 2.0);
    let (context, robots) = context(2);
    // rows in any order: the window puts them right
    let mut shuffled = rows.iter().map(|row| Row { time: row.time, lists: row.lists.clone() }).collect::<Vec<_>>();
    fastrand::Rng::with_seed(3).shuffle(&mut shuffled);
    context.register_batch("motion", table(&shuffled))?;
    let sql = "SELECT time, momentum_residual({desk_arm}, time, q, qd, tau) OVER (PARTITION BY log ORDER BY time) \
               AS residual FROM motion ORDER BY time";
    let found = residuals(&one(&context, &robots, sql).await?);
    assert!(found[0].is_none() && found[1..].iter().all(Option::is_some));
    let at = |row: usize, joint: usize| found[row].as_ref().expect("a residual")[joint];
    // before the push nothing, and after it what the first-order low-pass of 20 Hz lets through of -2 N m
    for row in [200, 500, 999] {
        (0..3).for_each(|joint| assert!(at(row, joint).abs() < 2e-3, "{row} {joint}: {}", at(row, joint)));
    }
    for after in [5_u32, 10, 30, 900] {
        let row = 1000 + usize::try_from(after).expect("small");
        let expected = -2.0 * (1.0 - (-std::f64::consts::TAU * 20.0 * f64::from(after) * 1e-3).exp());
        assert!((at(row, 1) - expected).abs() < 0.15, "{after} ms: {} {expected}", at(row, 1));
        assert!(at(row, 0).abs() < 2e-3 && at(row, 2).abs() < 2e-3, "{after} ms");
    }
    assert!((at(1900, 1) + 2.0).abs() < 2e-3, "{}", at(1900, 1));
    // it is what the watch sees, with the other sign, and in the end the residual with accelerations
    let with_accelerations = motion.tau[1][1900] - model(&robot, &motion, 1900)[1];
    assert!((at(1900, 1) - with_accelerations).abs() < 2e-3, "{} {with_accelerations}", at(1900, 1));
    let signals = Signals::new(&robot, &motion, 20.0).expect("a motion of the arm");
    for row in 1..rows.len() {
        for joint in 0..3 {
            let watched = signals.external[joint][row];
            assert!((at(row, joint) + watched).abs() < 1e-9, "{row} {joint}: {} {watched}", at(row, joint));
        }
    }
    Ok(())
}

#[tokio::test]
async fn an_observer_begins_anew_behind_a_gap_and_a_null() -> Result<()> {
    let robot = arm();
    let (mut rows, _) = pushed(&robot, 0.0);
    rows.truncate(400);
    let (context, robots) = context(2);
    context.register_batch("motion", table(&rows))?;
    let sql = "SELECT momentum_residual({desk_arm}, CASE WHEN time = 0.15 THEN 0.149 ELSE time END, q, CASE WHEN \
               time = 0.1 THEN NULL WHEN time = 0.05 THEN [0.0, 0.0, arrow_cast('NaN', 'Float64')] ELSE qd END, \
               tau) OVER (ORDER BY time) AS residual FROM motion WHERE time < 0.2 OR time > 0.3 ORDER BY time";
    let found = residuals(&one(&context, &robots, sql).await?);
    let nulls: Vec<usize> = found.iter().enumerate().filter(|(_, of)| of.is_none()).map(|(at, _)| at).collect();
    // the first row, a number that is none, the null, two rows of one time, and the row behind the gap
    assert_eq!(nulls, [0, 50, 51, 100, 101, 150, 200]);
    for (sql, words) in [
        (
            "SELECT momentum_residual({desk_arm}, log, q, qd, tau) OVER (ORDER BY time) FROM motion",
            "time stamp or seconds",
        ),
        ("SELECT momentum_residual({desk_arm}, time, q, qd) OVER (ORDER BY time) FROM motion", "`tau` is missing"),
        ("SELECT identify({desk_arm}, log, q, qd, tau) FROM motion", "time stamp or seconds"),
        ("SELECT identify({desk_arm}, time, q, qd) FROM motion", "`tau` is missing"),
        ("SELECT identify({desk_arm}) FROM motion", "time are missing"),
        ("SELECT identify('nobody', time, q, qd, tau) FROM motion", "no robot `nobody`"),
    ] {
        let said = one(&context, &robots, sql).await.expect_err("it is refused").to_string();
        assert!(said.contains(words), "{sql}: {said}");
    }
    Ok(())
}
