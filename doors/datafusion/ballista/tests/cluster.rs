//! A scheduler and two executors on this machine: the results are those of one process, also when an executor dies.

use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU16, Ordering};
use std::time::Duration;

use datafusion::arrow::array::{AsArray, RecordBatch};
use datafusion::arrow::compute::concat_batches;
use datafusion::arrow::datatypes::{Float64Type, Int64Type};
use datafusion::arrow::util::pretty::pretty_format_batches;
use datafusion::common::Result;
use datafusion::dataframe::DataFrameWriteOptions;
use datafusion::prelude::SessionContext;
use rne_ballista::Session;
use rne_datafusion::Robots;

/// Files of the log, states in each, and in how many parts queries are computed.
const FILES: usize = 8;
const STATES: usize = 20_000;
const PARTS: usize = 4;

/// What is killed when the test ends, however it ends.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

struct Fleet {
    scheduler: String,
    addresses: [String; 2],
    executors: Vec<Process>,
    _scheduler: Process,
    work: PathBuf,
}

/// The first of so many ports that are free now, one after the other.
fn ports(count: u16) -> u16 {
    // tests of one process run beside each other
    static NEXT: AtomicU16 = AtomicU16::new(0);
    let free = |port: u16| TcpListener::bind(("127.0.0.1", port)).is_ok();
    let of_process = 20_000 + u16::try_from(std::process::id() % 20_000).unwrap_or_default();
    loop {
        let port = of_process + NEXT.fetch_add(10, Ordering::Relaxed);
        if (port..port + count).all(free) {
            return port;
        }
    }
}

fn start(arguments: &[&str]) -> Process {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rne-fleet"));
    // what they say, for who looks
    let said = std::env::var_os("RNE_FLEET_LOG").map(|folder| {
        let name = format!("{}-{}.log", arguments[0], arguments[2].replace(':', "-"));
        std::fs::File::create(Path::new(&folder).join(name)).expect("the folder is there")
    });
    let command = command.args(arguments).stdout(Stdio::null()).stderr(said.map_or_else(Stdio::null, Stdio::from));
    Process(command.spawn().expect("it is built"))
}

impl Fleet {
    fn new(work: &Path, like: Like) -> Self {
        let port = ports(5);
        let address = |offset: u16| format!("127.0.0.1:{}", port + offset);
        let start = |arguments: &[&str]| {
            let push = ["--push"].into_iter().filter(|_| like == Like::Sent);
            start(&arguments.iter().copied().chain(push).collect::<Vec<_>>())
        };
        let scheduler = start(&["scheduler", "--listen", &address(0), "--lost-after", "12"]);
        let executors = [1, 3].map(|offset| {
            let work = work.join(offset.to_string());
            std::fs::create_dir_all(&work).expect("a folder");
            let work = work.to_str().expect("a name");
            start(&["executor", "--listen", &address(offset), "--scheduler", &address(0), "--work", work])
        });
        let addresses = [address(1), address(3)];
        Self {
            scheduler: address(0),
            addresses,
            executors: executors.into(),
            _scheduler: scheduler,
            work: work.to_owned(),
        }
    }

    /// A session, once all processes answer.
    async fn session(&self, log: &Path, like: Like) -> Result<Session> {
        for address in [&self.scheduler].into_iter().chain(&self.addresses) {
            let mut tries = 0..LOOKS;
            while TcpStream::connect(address).is_err() {
                assert!(tries.next().is_some(), "nobody answers at {address} within {:?}", LOOKS * LOOK);
                tokio::time::sleep(LOOK).await;
            }
        }
        session(Some(&self.scheduler), log, like).await
    }
}

async fn session(scheduler: Option<&str>, log: &Path, like: Like) -> Result<Session> {
    let adaptive = ("ballista.planner.adaptive.enabled".to_owned(), "true".to_owned());
    let settings: Vec<_> = Some(adaptive).into_iter().filter(|_| like == Like::Adaptive).collect();
    let session = Session::new(scheduler, Some(PARTS), &settings, Robots::shipped()?).await?;
    session.table("log", log.to_str().expect("a name")).await?;
    Ok(session)
}

/// Sines as trajectories of a PUMA, in several files.
async fn write_log(folder: &Path) -> Result<()> {
    let context = SessionContext::new();
    let columns = |name: &str| {
        let column = |joint: usize| format!("sin(0.001 * i * {joint} + length('{name}')) AS {name}{joint}");
        (1..=6).map(column).collect::<Vec<_>>().join(", ")
    };
    for file in 0..FILES {
        let (first, last) = (file * STATES + 1, (file + 1) * STATES);
        let [q, qd, qdd] = ["q", "qd", "qdd"].map(columns);
        let sql = format!(
            "SELECT value AS i, {q}, {qd}, {qdd} FROM (SELECT value, value AS i FROM generate_series({first}, {last}))"
        );
        let path = folder.join(format!("{file}.parquet"));
        let path = path.to_str().expect("a name");
        context.sql(&sql).await?.write_parquet(path, DataFrameWriteOptions::new(), None).await?;
    }
    Ok(())
}

/// The columns of positions, rates and accelerations.
fn columns() -> String {
    let of = |name: &str| (1..=6).map(|joint| format!("{name}{joint}")).collect::<Vec<_>>().join(", ");
    ["q", "qd", "qdd"].map(of).join(", ")
}

fn call() -> String {
    format!("inverse_dynamics({{puma560}}, {})", columns())
}

async fn all(session: &Session, sql: &str) -> Result<RecordBatch> {
    let batches = session.sql(sql).await?.collect().await?;
    Ok(concat_batches(&batches.first().expect("a batch").schema(), &batches)?)
}

/// Rows, and sums with how many they are of: what a loss would make fewer, and a repetition more.
fn rows() -> String {
    format!("SELECT i, tau[2] AS tau FROM (SELECT i, {} AS tau FROM log) WHERE i % 40 = 0 ORDER BY i", call())
}

fn sums() -> String {
    format!(
        "SELECT i % 7 AS part, count(*) AS states, count(DISTINCT i) AS different, sum(tau[2]) AS sum \
         FROM (SELECT i, {} AS tau FROM log) GROUP BY i % 7 ORDER BY part",
        call()
    )
}

/// The same, with the torques behind a shuffle: a state is a group.
fn late_sums() -> String {
    let latest = columns().split(", ").map(|column| format!("max({column})")).collect::<Vec<_>>().join(", ");
    format!(
        "SELECT i % 7 AS part, count(*) AS states, count(DISTINCT i) AS different, sum(tau[2]) AS sum \
         FROM (SELECT i, inverse_dynamics({{puma560}}, {latest}) AS tau FROM log GROUP BY i) \
         GROUP BY i % 7 ORDER BY part"
    )
}

/// Links and friction of some of the states, of two groups, from torques with a noise that is none.
fn identification() -> String {
    let noisy = (1..=6).map(|joint| format!("tau[{joint}] + 0.1 * sin(1.7 * i * i + {joint})"));
    let noisy = noisy.collect::<Vec<_>>().join(", ");
    format!(
        "SELECT i % 3 AS part, identification({{puma560}}, {}, make_array({noisy})) AS found FROM (SELECT *, {} AS tau \
         FROM log WHERE i % 40 < 2) GROUP BY i % 3 ORDER BY part",
        columns(),
        call()
    )
}

/// The same of a log with times, a second for every forty states, and its residual without accelerations.
fn of_logs() -> [String; 2] {
    let lists = |name: &str| {
        format!("make_array({})", (1..=6).map(|joint| format!("{name}{joint}")).collect::<Vec<_>>().join(", "))
    };
    let torques = format!("(SELECT *, {} AS tau FROM log WHERE i % 40 < 2)", call());
    let arguments = format!("{{puma560}}, i / 40.0, {}, {}, tau", lists("q"), lists("qd"));
    [
        format!("SELECT i % 3 AS part, identify({arguments}) AS found FROM {torques} GROUP BY i % 3 ORDER BY part"),
        format!(
            "SELECT i, momentum_residual({arguments}) OVER (PARTITION BY i % 3 ORDER BY i) AS residual FROM {torques} \
             ORDER BY i"
        ),
    ]
}

/// As many states, and values and deviations to 1e-10.
fn same_identification(found: &RecordBatch, expected: &RecordBatch) {
    assert_eq!((found.num_rows(), found.column(0)), (3, expected.column(0)));
    let column = |batch: &RecordBatch, name: &str| {
        batch.column(1).as_struct().column_by_name(name).expect("it is there").clone()
    };
    assert_eq!(&column(found, "states"), &column(expected, "states"));
    for name in ["value", "deviation"] {
        for row in 0..expected.num_rows() {
            let numbers = |batch: &RecordBatch| {
                let parameters = column(batch, "parameters").as_list::<i32>().value(row);
                let numbers = parameters.as_struct().column_by_name(name).expect("it is there").clone();
                numbers.as_primitive::<Float64Type>().values().to_vec()
            };
            let (found, expected) = (numbers(found), numbers(expected));
            let largest = expected.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
            assert_eq!(found.len(), expected.len());
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() <= 1e-10 * largest, "{name}: {found}, {expected}");
            }
        }
    }
}

/// Rows exactly; sums to the order of summing, and their counts exactly.
fn same_sums(found: &RecordBatch, expected: &RecordBatch) {
    let show = |batch: &RecordBatch| pretty_format_batches(std::slice::from_ref(batch)).expect("a table").to_string();
    for column in 0..3 {
        let numbers = |batch: &RecordBatch| batch.column(column).as_primitive::<Int64Type>().values().to_vec();
        assert_eq!(numbers(found), numbers(expected), "{}\n{}", show(found), show(expected));
    }
    let sums = |batch: &RecordBatch| batch.column(3).as_primitive::<Float64Type>().values().to_vec();
    for (found, expected) in sums(found).into_iter().zip(sums(expected)) {
        assert!((found - expected).abs() <= 1e-10 * expected.abs().max(1.0), "{found}, {expected}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn two_executors_give_what_one_process_gives() -> Result<()> {
    let folder = tempfile::tempdir().expect("a folder");
    let log = folder.path().join("log");
    write_log(&log).await?;
    let here = session(None, &log, Like::Ours).await?;
    let fleet = Fleet::new(&folder.path().join("work"), Like::Ours);
    let there = fleet.session(&log, Like::Ours).await?;
    let (found, expected) = (all(&there, &rows()).await?, all(&here, &rows()).await?);
    assert_eq!(expected.num_rows(), FILES * STATES / 40);
    assert_eq!(found, expected);
    same_sums(&all(&there, &sums()).await?, &all(&here, &sums()).await?);
    same_identification(&all(&there, &identification()).await?, &all(&here, &identification()).await?);
    for of_log in of_logs() {
        let (found, expected) = (all(&there, &of_log).await?, all(&here, &of_log).await?);
        assert!(expected.num_rows() > 0 && found == expected, "{of_log}");
    }
    // a robot that the executors do not hold is refused, and said to the client
    let said = all(&there, "SELECT gravity_torques('puma560@0000000000000000', q1, q2, q3, q4, q5, q6) FROM log").await;
    assert!(said.expect_err("it is refused").to_string().contains("is not the puma560"));
    Ok(())
}

/// A pipe that is closed wants no more; a disk that is full is an error, and neither is a panic.
#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_written_is_said() {
    for arguments in [&["robots"][..], &["sql", "SELECT 1"]] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rne-fleet"));
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
        let output = command.args(arguments).stdout(full).output().expect("it starts");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(1) && said.starts_with("error: "), "{arguments:?}: {said}");
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let mut command = Command::new(env!("CARGO_BIN_EXE_rne-fleet"));
        let output = command.args(arguments).stdout(writer).output().expect("it starts");
        assert!(output.status.success() && output.stderr.is_empty(), "{arguments:?}: {output:?}");
    }
}

/// When an executor is killed.
#[derive(Clone, Copy, Debug)]
enum Loss {
    /// While the log is read.
    FirstStage,
    /// When what it has computed is asked for.
    AfterAShuffle,
}

#[tokio::test(flavor = "multi_thread")]
async fn an_executor_that_dies_in_the_first_stage_costs_time_and_no_rows() -> Result<()> {
    an_executor_dies(Loss::FirstStage, Like::Ours).await
}

#[tokio::test(flavor = "multi_thread")]
async fn an_executor_that_dies_after_a_shuffle_costs_time_and_no_rows() -> Result<()> {
    an_executor_dies(Loss::AfterAShuffle, Like::Ours).await
}

#[tokio::test(flavor = "multi_thread")]
#[ignore = "Ballista 55.0 waits for ever: docs/control/fleet.md"]
async fn the_adaptive_planner_bears_an_executor_that_dies_after_a_shuffle() -> Result<()> {
    an_executor_dies(Loss::AfterAShuffle, Like::Adaptive).await
}

#[tokio::test(flavor = "multi_thread")]
#[ignore = "Ballista 55.0 may wait for ever: docs/control/fleet.md"]
async fn tasks_that_are_sent_bear_an_executor_that_dies_after_a_shuffle() -> Result<()> {
    an_executor_dies(Loss::AfterAShuffle, Like::Sent).await
}

/// How queries are planned, and how tasks come to executors.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Like {
    /// As `rne-fleet` does it.
    Ours,
    /// Planned anew after each stage.
    Adaptive,
    /// Tasks are sent to executors.
    Sent,
}

/// Between two looks whether a process answers or a query has ended.
const LOOK: Duration = Duration::from_millis(50);

/// Looks at most: with what lies between them a limit of five minutes, which a slow machine may need and a query that
/// waits for ever exceeds.
const LOOKS: u32 = 6000;

async fn an_executor_dies(loss: Loss, like: Like) -> Result<()> {
    let folder = tempfile::tempdir().expect("a folder");
    let log = folder.path().join("log");
    write_log(&log).await?;
    let sql = match loss {
        Loss::FirstStage => sums(),
        Loss::AfterAShuffle => late_sums(),
    };
    let expected = all(&session(None, &log, Like::Ours).await?, &sql).await?;
    let mut fleet = Fleet::new(&folder.path().join("work"), like);
    let there = fleet.session(&log, like).await?;
    let query = tokio::spawn(async move { all(&there, &sql).await });
    let killed = wait_for(&fleet.work, loss, &query).await;
    drop(fleet.executors.remove(0));
    assert!(killed, "{loss:?}: the query ended before");
    for _ in 0..LOOKS {
        if query.is_finished() {
            break;
        }
        tokio::time::sleep(LOOK).await;
    }
    assert!(query.is_finished(), "{loss:?}: the query has not ended within {:?}, the limit of this test", LOOKS * LOOK);
    same_sums(&query.await.expect("no panic")?, &expected);
    Ok(())
}

/// Waits until the query is that far; false when it ended before.
async fn wait_for<T>(work: &Path, loss: Loss, query: &tokio::task::JoinHandle<T>) -> bool {
    while !query.is_finished() {
        let [of_lost, of_other] = ["1", "3"].map(|executor| stages(&work.join(executor)));
        let is_there = match loss {
            Loss::FirstStage => !of_lost.is_empty(),
            // what it has of the first stage is wanted by the second
            Loss::AfterAShuffle => !of_lost.is_empty() && of_lost.iter().chain(&of_other).any(|stage| *stage >= 2),
        };
        if is_there {
            return true;
        }
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
    false
}

/// The stages that an executor has written results of: its work folder has a folder per job, and in it one per stage.
fn stages(work: &Path) -> Vec<u32> {
    let folders = |folder: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(folder).map(|found| found.flatten().map(|entry| entry.path()).collect()).unwrap_or_default()
    };
    let jobs = folders(work);
    let stages = jobs.iter().flat_map(|job| folders(job));
    stages.filter_map(|stage| stage.file_name()?.to_str()?.parse().ok()).collect()
}
