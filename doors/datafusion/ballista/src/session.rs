//! Queries, in this process or on a fleet.

use ballista::prelude::{SessionConfigExt as _, SessionContextExt as _};
use datafusion::common::{DataFusionError, Result, exec_datafusion_err};
use datafusion::execution::SessionStateBuilder;
use datafusion::prelude::{DataFrame, ParquetReadOptions, SessionConfig, SessionContext};
use rne_datafusion::{Robots, register};

/// A session whose queries have the functions of some robots.
pub struct Session {
    context: SessionContext,
    robots: Robots,
}

impl Session {
    /// Opens a session on the fleet of a scheduler (`127.0.0.1:50050`), or in this process without one. At most
    /// `partitions` parts of a query are computed at once. `settings` are keys and values of the engine.
    ///
    /// # Errors
    /// When no scheduler answers there, or there is no such setting.
    pub async fn new(
        scheduler: Option<&str>,
        partitions: Option<usize>,
        settings: &[(String, String)],
        robots: Robots,
    ) -> Result<Self> {
        let configured = |mut config: SessionConfig| {
            if let Some(partitions) = partitions {
                config = config.with_target_partitions(partitions);
            }
            settings.iter().try_for_each(|(key, value)| config.options_mut().set(key, value))?;
            Ok::<_, DataFusionError>(config)
        };
        let context = match scheduler {
            None => SessionContext::new_with_config(configured(SessionConfig::new())?),
            Some(scheduler) => {
                // the adaptive planner of Ballista 55.0 waits for ever for an executor that died after a shuffle
                let config = SessionConfig::new_with_ballista().with_ballista_adaptive_query_planner(false);
                let config = configured(config)?;
                let state = SessionStateBuilder::new().with_config(config).with_default_features().build();
                let unreached = |error| exec_datafusion_err!("no scheduler answers at {scheduler}: {error}");
                SessionContext::remote_with_state(&format!("df://{scheduler}"), state).await.map_err(unreached)?
            }
        };
        register(&context, &robots);
        Ok(Self { context, robots })
    }

    /// Makes a table of a Parquet file, or of a folder of them. In a fleet every executor reads it, so it must be on
    /// storage that they share.
    ///
    /// # Errors
    /// When it cannot be read.
    pub async fn table(&self, name: &str, path: &str) -> Result<()> {
        self.context.register_parquet(name, path, ParquetReadOptions::default()).await
    }

    /// Plans a query, in which `{puma560}` is replaced by the key of this robot, its name with its hash.
    ///
    /// # Errors
    /// With all errors in it.
    pub async fn sql(&self, sql: &str) -> Result<DataFrame> {
        let with_keys = self.robots.keys().fold(sql.to_owned(), |sql, key| {
            let name = key.split('@').next().unwrap_or_default();
            sql.replace(&format!("{{{name}}}"), &format!("'{key}'"))
        });
        self.context.sql(&with_keys).await
    }
}
