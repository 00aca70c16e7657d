//! The robots that a process has, by name and content.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use datafusion::common::{DataFusionError, Result, plan_err};
use rne::compiled::{CompiledArm, RobotFiles};
use rne_identify::{Options, Structure};
use sha2::{Digest, Sha256};

/// Number of hexadecimal digits of the content hash in a key.
const DIGITS: usize = 16;

/// The robots that SQL functions may name.
///
/// A query names a robot by its *key*, `NAME@HASH`. The hash is the first 16 digits of the SHA-256 of the robot file,
/// followed by its plan file if it has one, as `cat NAME.yaml NAME.plan.yaml | sha256sum` prints it. Functions are sent
/// to other machines by name alone, so a process that has another file under the same name would compute other torques,
/// or other bits of them, unnoticed. With the key it returns an error.
#[derive(Clone, Debug)]
pub struct Robots(Arc<BTreeMap<String, Held>>);

/// A robot of the registry, compiled, with the hash of its files.
#[derive(Clone, Debug)]
pub(crate) struct Held {
    pub(crate) arm: CompiledArm,
    hash: String,
    structure: OnceLock<Arc<Structure>>,
    with_rotors: OnceLock<CompiledArm>,
}

impl Held {
    /// Returns the unknowns of an identification from rows: links, friction, and rotors if the robot file has any. The
    /// rows of a table have no time, so nothing is filtered. It is computed at the first call.
    pub(crate) fn structure(&self) -> Arc<Structure> {
        let found = self.structure.get_or_init(|| {
            let mut options = Options::default();
            let motors = self.arm.robot().joints.iter().filter_map(|joint| joint.motor);
            options.rotors = motors.into_iter().any(|motor| motor.inertia > 0.0);
            options.cutoff = None;
            // rows have no order, so friction has no displacement since a reversal, and torques have no delay
            options.displacements = Vec::new();
            options.delay = false;
            Arc::new(Structure::new(self.arm.robot(), options))
        });
        Arc::clone(found)
    }

    /// Returns the arm with the inertia of the rotors of its motors.
    pub(crate) fn with_rotors(&self) -> &CompiledArm {
        self.with_rotors.get_or_init(|| CompiledArm::from_robot(&self.arm.robot().clone().with_rotors()))
    }
}

impl Robots {
    /// A registry without robots.
    #[must_use]
    pub fn none() -> Self {
        Self(Arc::default())
    }

    /// The robots that rne ships: `puma560`, `panda`, ….
    ///
    /// # Errors
    /// Never for the shipped ones, which tests read.
    pub fn shipped() -> Result<Self> {
        rne_robots::all().try_fold(Self::none(), |robots, file| {
            let arm = match file.plan {
                Some(plan) => CompiledArm::with_plan(file.yaml, plan),
                None => CompiledArm::from_yaml(file.yaml),
            };
            let texts = [file.yaml, file.plan.unwrap_or_default()];
            Ok(robots.with(file.name, texts.map(str::as_bytes), arm.map_err(external)?))
        })
    }

    /// Adds the robot of a robot file, with the plan file beside it, under the name that the robot file has in its key
    /// `name`.
    ///
    /// # Errors
    /// When the file cannot be read, or with all errors in it.
    pub fn with_file(self, path: impl AsRef<Path>) -> Result<Self> {
        // read once: if a file is replaced meanwhile, the hash and the torques must still be those of one file
        let files = RobotFiles::read(path).map_err(external)?;
        let arm = CompiledArm::from_files(&files).map_err(external)?;
        let name = arm.robot().name.clone();
        Ok(self.with(&name, [files.robot(), files.plan().unwrap_or_default()], arm))
    }

    /// Adds the robot that the text of a robot file describes, under the name that the text has in its key `name`.
    ///
    /// # Errors
    /// With all errors in it.
    pub fn with_yaml(self, text: &str) -> Result<Self> {
        let arm = CompiledArm::from_yaml(text).map_err(external)?;
        let name = arm.robot().name.clone();
        Ok(self.with(&name, [text.as_bytes(), &[]], arm))
    }

    /// Adds a robot under a name. `files` are the bytes of the robot file and of the plan file, the latter empty if it
    /// does not exist.
    fn with(mut self, name: &str, files: [&[u8]; 2], arm: CompiledArm) -> Self {
        let mut hash = Sha256::digest(files.concat()).iter().fold(String::new(), |mut hash, byte| {
            let _ = write!(hash, "{byte:02x}");
            hash
        });
        hash.truncate(DIGITS);
        Arc::make_mut(&mut self.0)
            .insert(name.to_owned(), Held { arm, hash, structure: OnceLock::new(), with_rotors: OnceLock::new() });
        self
    }

    /// Returns the key of the robot with this name, as a query needs it; `None` if there is no such robot.
    #[must_use]
    pub fn key(&self, name: &str) -> Option<String> {
        self.0.get(name).map(|held| format!("{name}@{}", held.hash))
    }

    /// Returns the keys of all robots.
    pub fn keys(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(|(name, held)| format!("{name}@{}", held.hash))
    }

    /// Returns the robot with this key.
    pub(crate) fn get(&self, key: &str) -> Result<&Held> {
        let (name, hash) = key.split_once('@').map_or((key, None), |(name, hash)| (name, Some(hash)));
        let Some(held) = self.0.get(name) else {
            let names: Vec<&str> = self.0.keys().map(String::as_str).collect();
            return plan_err!("this process holds no robot `{name}`; it holds {}", names.join(", "));
        };
        match hash {
            Some(hash) if hash == held.hash => Ok(held),
            Some(_) => plan_err!(
                "`{key}` is not the {name} that this process holds: its robot file is `{name}@{}`. Give every process \
                 the same file",
                held.hash
            ),
            None => plan_err!(
                "which {name}? This process holds `{name}@{}`: write the name with the hash of the file, so that a \
                 process that holds another file refuses",
                held.hash
            ),
        }
    }
}

/// Two registries are equal if they have the same robots from the same files.
impl PartialEq for Robots {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.keys().eq(other.keys())
    }
}

impl Eq for Robots {}

impl std::hash::Hash for Robots {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        for key in self.keys() {
            key.hash(state);
        }
    }
}

/// Converts an error of rne to one of the engine.
pub(crate) fn external(error: impl std::error::Error + Send + Sync + 'static) -> DataFusionError {
    DataFusionError::External(Box::new(error))
}
