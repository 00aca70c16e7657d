//! The names of the functions that are certified.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use robots::puma560::{self, Arguments};
use robots::{Numbers, Torques};

/// A robot in a form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Robot {
    pub(crate) name: &'static str,
    pub(crate) form: &'static str,
    pub(crate) dof: usize,
}

/// A function of the PUMA 560 in a form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Method {
    pub(crate) name: &'static str,
    pub(crate) form: &'static str,
}

/// All robots in both forms.
pub(crate) fn robots() -> Vec<Robot> {
    struct Names(Vec<Robot>);
    impl robots::Visitor for Names {
        fn visit<const DOF: usize>(&mut self, name: &'static str, form: &'static str, _: Torques<DOF>) {
            self.0.push(Robot { name, form, dof: DOF });
        }
    }
    let mut names = Names(Vec::new());
    robots::each(&mut names);
    names.0
}

/// Fails if a robot is shipped that is not certified.
pub(crate) fn are_all(folder: &Path) -> Result<()> {
    let certified: BTreeSet<String> = robots().iter().map(|robot| robot.name.to_owned()).collect();
    let mut shipped = BTreeSet::new();
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let file = entry?.path();
        let is_yaml = file.extension().is_some_and(|extension| extension == "yaml");
        // `puma560.plan.yaml` is no robot
        let name = file.file_stem().map(Path::new).filter(|name| is_yaml && name.extension().is_none());
        shipped.extend(name.map(|name| name.display().to_string()));
    }
    ensure!(
        shipped == certified,
        "robots/ and embedded/robots/src/torques.rs have different robots: {:?}",
        shipped.symmetric_difference(&certified).collect::<Vec<_>>()
    );
    Ok(())
}

/// All functions of the PUMA 560 but `inverse_dynamics`, in both forms.
pub(crate) fn methods() -> Vec<Method> {
    struct Names(Vec<Method>);
    impl puma560::Visitor for Names {
        fn visit<N: Numbers>(&mut self, form: &'static str, name: &'static str, _: impl Fn(&Arguments) -> N) {
            self.0.push(Method { name, form });
        }
    }
    let mut names = Names(Vec::new());
    puma560::each(&mut names);
    names.0
}
