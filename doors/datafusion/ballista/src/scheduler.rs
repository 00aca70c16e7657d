//! The process that gives work to executors.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use ballista_core::config::TaskSchedulingPolicy;
use ballista_core::utils::default_session_builder;
use ballista_scheduler::cluster::BallistaCluster;
use ballista_scheduler::config::SchedulerConfig;
use ballista_scheduler::scheduler_process::start_server;
use datafusion::common::{Result, exec_datafusion_err};
use datafusion::execution::FunctionRegistry as _;
use rne_datafusion::{Robots, aggregates, functions, windows};

/// Gives tasks to executors until it is stopped. An executor without a sign of life for the time `lost_after` counts as
/// lost. All executors must have the same policy; if they pull tasks, a busy one gives a sign of life every five
/// seconds.
///
/// # Errors
/// When it cannot listen there.
pub async fn scheduler(
    listen: SocketAddr,
    lost_after: Duration,
    policy: TaskSchedulingPolicy,
    robots: Robots,
) -> Result<()> {
    let lost_after = lost_after.as_secs().max(1);
    let config = SchedulerConfig {
        bind_host: listen.ip().to_string(),
        external_host: listen.ip().to_string(),
        bind_port: listen.port(),
        scheduling_policy: policy,
        executor_timeout_seconds: lost_after,
        expire_dead_executor_interval_seconds: lost_after.div_ceil(5).max(1),
        // functions are sent by name, so each session of this process needs them
        override_session_builder: Some(Arc::new(move |config| {
            let mut state = default_session_builder(config)?;
            for function in functions(&robots) {
                state.register_udf(Arc::new(function))?;
            }
            for function in aggregates(&robots) {
                state.register_udaf(Arc::new(function))?;
            }
            for function in windows(&robots) {
                state.register_udwf(Arc::new(function))?;
            }
            Ok(state)
        })),
        ..SchedulerConfig::default()
    };
    let failed = |error| exec_datafusion_err!("scheduler at {}: {error}", listen);
    let cluster = BallistaCluster::new_from_config(&config).await.map_err(failed)?;
    start_server(cluster, listen, Arc::new(config)).await.map_err(failed)
}
