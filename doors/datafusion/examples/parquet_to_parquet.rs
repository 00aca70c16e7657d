//! Measures how long SQL over Parquet takes on one core, and which share of it is dynamics: reads states of a PUMA from
//! a file and writes their torques to another.
//!
//! ```console
//! cargo run --release --manifest-path doors/datafusion/Cargo.toml --example parquet_to_parquet -- 5000000
//! ```

use std::hash::{Hash, Hasher};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use datafusion::arrow::datatypes::{DataType, FieldRef};
use datafusion::common::Result;
use datafusion::logical_expr::{
    ColumnarValue, ReturnFieldArgs, ScalarFunctionArgs, ScalarUDF, ScalarUDFImpl, Signature,
};
use datafusion::prelude::{ParquetReadOptions, SessionConfig, SessionContext};
use rne_datafusion::{Robots, aggregates, functions};

/// Runs of each query, of which the fastest is reported.
const RUNS: usize = 3;

/// A function that adds up how long it took.
#[derive(Debug)]
struct Timed {
    of: ScalarUDF,
    nanoseconds: Arc<AtomicU64>,
}

impl PartialEq for Timed {
    fn eq(&self, other: &Self) -> bool {
        self.of == other.of
    }
}

impl Eq for Timed {}

impl Hash for Timed {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.of.hash(state);
    }
}

impl ScalarUDFImpl for Timed {
    fn name(&self) -> &str {
        self.of.name()
    }

    fn signature(&self) -> &Signature {
        self.of.signature()
    }

    fn return_type(&self, given: &[DataType]) -> Result<DataType> {
        self.of.return_type(given)
    }

    fn coerce_types(&self, given: &[DataType]) -> Result<Vec<DataType>> {
        self.of.inner().coerce_types(given)
    }

    fn return_field_from_args(&self, given: ReturnFieldArgs<'_>) -> Result<FieldRef> {
        self.of.inner().return_field_from_args(given)
    }

    fn invoke_with_args(&self, given: ScalarFunctionArgs) -> Result<ColumnarValue> {
        let start = Instant::now();
        let result = self.of.inner().invoke_with_args(given);
        let elapsed = u64::try_from(start.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.nanoseconds.fetch_add(elapsed, Ordering::Relaxed);
        result
    }
}

/// Returns the SQL names of the columns `name1` to `name6`, separated by commas.
fn columns(name: &str) -> String {
    (1..=6).map(|joint| format!("{name}{joint}")).collect::<Vec<_>>().join(", ")
}

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<()> {
    let count: usize = std::env::args().nth(1).and_then(|count| count.parse().ok()).unwrap_or(5_000_000);
    let robots = Robots::shipped()?;
    let Some(puma) = robots.key("puma560") else { unreachable!("it is shipped") };
    let nanoseconds = Arc::new(AtomicU64::new(0));
    let context = SessionContext::new_with_config(SessionConfig::new().with_target_partitions(1));
    for of in functions(&robots) {
        context.register_udf(ScalarUDF::new_from_impl(Timed { of, nanoseconds: Arc::clone(&nanoseconds) }));
    }
    for aggregate in aggregates(&robots) {
        context.register_udaf(aggregate);
    }
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).display().to_string();

    // the trajectories of all joints are sines
    let sines = |name: &str| {
        let sine = |joint: usize| format!("sin(0.001 * i * {joint} + length('{name}') + {joint}) AS {name}{joint}");
        (1..=6).map(sine).collect::<Vec<_>>().join(", ")
    };
    let states = format!(
        "SELECT i, {}, {}, {} FROM (SELECT value AS i FROM generate_series(1, {count}))",
        sines("q"),
        sines("qd"),
        sines("qdd")
    );
    context
        .sql(&format!("COPY ({states}) TO '{}' STORED AS PARQUET", path("columns.parquet")))
        .await?
        .collect()
        .await?;
    context.register_parquet("columns", path("columns.parquet"), ParquetReadOptions::default()).await?;
    let lists = ["q", "qd", "qdd"].map(|name| format!("make_array({}) AS {name}", columns(name))).join(", ");
    let torques = format!("inverse_dynamics('{puma}', {}, {}, {})", columns("q"), columns("qd"), columns("qdd"));
    let lists = format!("SELECT i, {lists}, {torques} AS tau FROM columns");
    context.sql(&format!("COPY ({lists}) TO '{}' STORED AS PARQUET", path("lists.parquet"))).await?.collect().await?;
    context.register_parquet("lists", path("lists.parquet"), ParquetReadOptions::default()).await?;

    println!("{count} states of puma560, Parquet to Parquet, one core: seconds, of them in the function, its share");
    for (words, from, call) in [
        ("a column per joint", "columns", torques),
        ("a list per state", "lists", format!("inverse_dynamics('{puma}', q, qd, qdd)")),
    ] {
        let sql = format!("COPY (SELECT i, {call} AS tau FROM {from}) TO '{}' STORED AS PARQUET", path("tau.parquet"));
        let mut best = (f64::INFINITY, 0.0);
        for _ in 0..RUNS {
            nanoseconds.store(0, Ordering::Relaxed);
            let start = Instant::now();
            context.sql(&sql).await?.collect().await?;
            #[allow(clippy::cast_precision_loss)] // a duration in s, rounded for printing
            let inside = nanoseconds.load(Ordering::Relaxed) as f64 * 1e-9;
            let whole = start.elapsed().as_secs_f64();
            if whole < best.0 {
                best = (whole, inside);
            }
        }
        println!("  {words:<20} {:6.2} s {:6.2} s {:5.1} %", best.0, best.1, 100.0 * best.1 / best.0);
    }
    let start = Instant::now();
    let sql = format!("SELECT identification('{puma}', q, qd, qdd, tau)['states'] FROM lists");
    context.sql(&sql).await?.collect().await?;
    println!("identification       {:6.2} s", start.elapsed().as_secs_f64());
    Ok(())
}
