//! `rne-fleet`: reads the arguments and prints; the library does the work.

use std::io::Write as _;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use clap::{Args, Parser, Subcommand};
use datafusion::arrow::util::pretty::pretty_format_batches;
use datafusion::common::{Result, plan_err};
use futures::StreamExt as _;
use rne_ballista::{Session, TaskSchedulingPolicy, executor, scheduler};
use rne_datafusion::Robots;

/// Dynamics of robot arms in SQL, on one machine or on several.
#[derive(Parser)]
#[command(
    version,
    after_help = "Examples:\n  rne-fleet robots\n  rne-fleet sql \"SELECT gravity_torques({planar2}, [0.0, 0.5])\""
)]
struct Line {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Runs a query here, or on a fleet with --scheduler
    Sql(Query),
    /// Gives work to executors and clients
    Scheduler(Scheduler),
    /// Does the work of a scheduler
    Executor(Executor),
    /// Lists the robots that this binary holds, as a query calls them
    Robots(Files),
}

/// Robot files beside those that are built in.
#[derive(Args, Clone)]
struct Files {
    /// A robot file beside the shipped ones; every process of a fleet needs it
    #[arg(long = "robot", value_name = "FILE")]
    files: Vec<PathBuf>,
}

impl Files {
    fn read(&self) -> Result<Robots> {
        self.files.iter().try_fold(Robots::shipped()?, Robots::with_file)
    }
}

#[derive(Args)]
struct Query {
    /// The query; {puma560}, or another name of a robot in braces, becomes its key NAME@HASH
    sql: String,
    /// A Parquet file or folder as a table
    #[arg(long = "table", value_name = "NAME=PATH")]
    tables: Vec<String>,
    /// The scheduler of a fleet; without it the query runs here
    #[arg(long, value_name = "HOST:PORT")]
    scheduler: Option<String>,
    /// Parts that are computed beside each other
    #[arg(long, value_name = "N")]
    partitions: Option<usize>,
    /// A setting of the engine
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings: Vec<String>,
    #[command(flatten)]
    robots: Files,
}

impl Query {
    async fn run(&self) -> Result<()> {
        let robots = self.robots.read()?;
        let mut settings = Vec::new();
        for setting in &self.settings {
            let Some((key, value)) = setting.split_once('=') else {
                return plan_err!("`--set {setting}`: a setting is KEY=VALUE");
            };
            settings.push((key.to_owned(), value.to_owned()));
        }
        let session = Session::new(self.scheduler.as_deref(), self.partitions, &settings, robots).await?;
        for table in &self.tables {
            let Some((name, path)) = table.split_once('=') else {
                return plan_err!("`--table {table}`: a table is NAME=PATH, `--table log=log.parquet`");
            };
            session.table(name, path).await?;
        }
        let mut batches = session.sql(&self.sql).await?.execute_stream().await?;
        let mut out = std::io::stdout().lock();
        while let Some(batch) = batches.next().await {
            if !is_taken(writeln!(out, "{}", pretty_format_batches(&[batch?])?))? {
                break;
            }
        }
        Ok(())
    }
}

/// Whether the reader of the output still reads. A closed pipe is no error: then nothing more is written.
fn is_taken(written: std::io::Result<()>) -> Result<bool> {
    match written {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(error.into()),
    }
}

/// Prints the keys of all robots, names with hashes, one per line.
fn list(files: &Files) -> Result<()> {
    let mut out = std::io::stdout().lock();
    for key in files.read()?.keys() {
        if !is_taken(writeln!(out, "{key}"))? {
            break;
        }
    }
    Ok(())
}

/// How tasks come to executors.
#[derive(Args, Clone, Copy)]
struct Policy {
    /// Tasks are sent to executors, which do not ask; for all processes of a fleet or for none
    #[arg(long)]
    push: bool,
}

impl Policy {
    fn of_tasks(self) -> TaskSchedulingPolicy {
        if self.push { TaskSchedulingPolicy::PushStaged } else { TaskSchedulingPolicy::PullStaged }
    }
}

#[derive(Args)]
struct Scheduler {
    /// Where it listens
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:50050")]
    listen: SocketAddr,
    /// Seconds without a sign of life after which an executor is lost
    #[arg(long, value_name = "SECONDS", default_value_t = 30)]
    lost_after: u64,
    #[command(flatten)]
    policy: Policy,
    #[command(flatten)]
    robots: Files,
}

#[derive(Args)]
struct Executor {
    /// Where it listens; the port after it is taken too
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:50060")]
    listen: SocketAddr,
    /// Where the scheduler listens
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:50050")]
    scheduler: SocketAddr,
    /// Parts that are computed beside each other
    #[arg(long, value_name = "N", default_value_t = 1)]
    cores: usize,
    /// Folder of what passes between the stages of a query
    #[arg(long, value_name = "DIR")]
    work: Option<PathBuf>,
    #[command(flatten)]
    policy: Policy,
    #[command(flatten)]
    robots: Files,
}

#[tokio::main]
async fn main() -> ExitCode {
    env_logger::Builder::from_env(env_logger::Env::default().default_filter_or("warn")).init();
    let said = match Line::parse().command {
        Command::Sql(query) => query.run().await,
        Command::Scheduler(Scheduler { listen, lost_after, policy, robots }) => match robots.read() {
            Ok(robots) => scheduler(listen, Duration::from_secs(lost_after), policy.of_tasks(), robots).await,
            Err(error) => Err(error),
        },
        Command::Executor(Executor { listen, scheduler, cores, work, policy, robots }) => match robots.read() {
            Ok(robots) => executor(listen, scheduler, cores, policy.of_tasks(), work.as_deref(), &robots).await,
            Err(error) => Err(error),
        },
        Command::Robots(files) => list(&files),
    };
    match said {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {}", error.strip_backtrace());
            ExitCode::FAILURE
        }
    }
}
