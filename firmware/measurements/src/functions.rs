//! The names of the functions that are certified.

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

struct Names(Vec<Robot>);

impl robots::Visitor for Names {
    fn visit<const DOF: usize>(&mut self, name: &'static str, form: &'static str, _: Torques<DOF>) {
        self.0.push(Robot { name, form, dof: DOF });
    }
}

/// Returns all robots in both forms.
pub(crate) fn robots() -> Vec<Robot> {
    let mut names = Names(Vec::new());
    robots::each(&mut names);
    names.0
}

/// Returns all robots; instead of a form, each entry has the part of its controller that is compared.
pub(crate) fn controllers() -> Vec<Robot> {
    let mut names = Names(Vec::new());
    robots::each_controller(&mut names);
    names.0
}

/// Returns all functions of the PUMA 560 except `inverse_dynamics`, in both forms.
pub(crate) fn methods() -> Vec<Method> {
    struct Names(Vec<Method>);
    impl puma560::Visitor for Names {
        fn visit<N: Numbers<f32>>(&mut self, form: &'static str, name: &'static str, _: impl Fn(&Arguments) -> N) {
            self.0.push(Method { name, form });
        }
    }
    let mut names = Names(Vec::new());
    puma560::each(&mut names);
    names.0
}
