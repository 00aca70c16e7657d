//! The process that computes the tasks of a scheduler.

use std::net::SocketAddr;
use std::path::Path;
use std::sync::Arc;

use ballista::prelude::SessionConfigExt as _;
use ballista_core::config::TaskSchedulingPolicy;
use ballista_core::registry::BallistaFunctionRegistry;
use ballista_core::utils::default_session_builder;
use ballista_executor::executor_process::{ExecutorProcessConfig, start_executor_process};
use datafusion::common::{Result, exec_datafusion_err};
use datafusion::prelude::SessionConfig;
use rne_datafusion::{Robots, aggregates, functions, windows};

/// Seconds for which an executor waits for its scheduler.
const PATIENCE: u16 = 60;

/// Computes tasks of a scheduler until it is stopped, `cores` of them at once. Data between the stages of a query are
/// stored in the folder `work`.
///
/// # Errors
/// When it cannot listen there, or no scheduler answers within a minute.
pub async fn executor(
    listen: SocketAddr,
    scheduler: SocketAddr,
    cores: usize,
    policy: TaskSchedulingPolicy,
    work: Option<&Path>,
    robots: &Robots,
) -> Result<()> {
    // the registry replaces the engine's own functions, so these are added to it first
    let state = default_session_builder(SessionConfig::new_with_ballista())?;
    let mut registry = BallistaFunctionRegistry::from(&state);
    for function in functions(robots) {
        registry.scalar_functions.insert(function.name().to_owned(), Arc::new(function));
    }
    for function in aggregates(robots) {
        registry.aggregate_functions.insert(function.name().to_owned(), Arc::new(function));
    }
    for function in windows(robots) {
        registry.window_functions.insert(function.name().to_owned(), Arc::new(function));
    }
    let config = ExecutorProcessConfig {
        bind_host: listen.ip().to_string(),
        external_host: Some(listen.ip().to_string()),
        port: listen.port(),
        grpc_port: listen.port() + 1,
        scheduler_host: scheduler.ip().to_string(),
        scheduler_port: scheduler.port(),
        vcores: cores,
        task_scheduling_policy: policy,
        work_dir: work.map(|work| work.display().to_string()),
        scheduler_connect_timeout_seconds: PATIENCE,
        executor_heartbeat_interval_seconds: 1,
        override_function_registry: Some(Arc::new(registry)),
        ..ExecutorProcessConfig::default()
    };
    let failed = |error| exec_datafusion_err!("executor at {}: {error}", listen);
    start_executor_process(Arc::new(config)).await.map_err(failed)
}
