//! Writes FMUs of FMI 2.0 and 3.0: the files of a robot for model exchange and co-simulation.
//!
//! The C code of [`c_code_with`](crate::c_code_with) does the computation; a wrapper has the functions of FMI. The
//! wrapper declares the types of FMI itself, so an FMU compiles without the headers of the standard.

mod description;
mod parameters;
mod units;
mod variables;

use std::fmt::Write;

use rne_codegen::{Function, Program};
use rne_model::Robot;

use crate::parameters::{are_used, used};
use crate::{CCode, inert};
use parameters::FmuParameter;
use variables::{PAYLOAD, Variable};

pub use parameters::with_inertial_parameters;

/// A version of the FMI standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FmiVersion {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
}

/// The inputs and outputs of an FMU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FmuCausality {
    /// Torques are inputs and the motion is the output: forward dynamics, whose states are q and q̇.
    Forward,
    /// The motion is the input and torques are outputs: inverse dynamics without states.
    Inverse,
}

impl FmuCausality {
    /// Returns the functions that the C code of an FMU needs.
    #[must_use]
    pub const fn functions(self) -> &'static [Function] {
        match self {
            Self::Forward => &[Function::ForwardDynamicsWithPayload, Function::ForwardDynamicsDerivativesWithPayload],
            Self::Inverse => &[
                Function::InverseDynamicsWithPayload,
                Function::InverseDynamicsDerivativesWithPayload,
                Function::MassMatrixWithPayload,
            ],
        }
    }
}

/// A robot as an FMU, without its binaries.
#[derive(Clone, Copy, Debug)]
pub struct Fmu<'a> {
    /// The robot; those of its run-time parameters that the programs use become parameters of the FMU.
    pub robot: &'a Robot,
    /// The programs of [`FmuCausality::functions`].
    pub programs: &'a [Program],
    /// The code of these programs in double precision, whose prefix is the name of the robot.
    pub code: &'a CCode,
    /// The version of FMI.
    pub version: FmiVersion,
    /// Forward or inverse dynamics.
    pub causality: FmuCausality,
    /// A text that is different for FMUs with different variables.
    pub token: &'a str,
}

/// Default of the longest step of the integrator, s.
const STEP: f64 = 0.001;

impl Fmu<'_> {
    /// Returns the files of the FMU: their paths with `/`, and their texts.
    #[must_use]
    pub fn files(&self) -> Vec<(String, String)> {
        let name = &self.robot.name;
        let variables = self.variables();
        let header = format!("{name}.h");
        let types = match self.version {
            FmiVersion::Two => include_str!("fmi_types2.h"),
            FmiVersion::Three => include_str!("fmi_types3.h"),
        };
        let number = if self.version == FmiVersion::Two { "2" } else { "3" };
        let cmake = include_str!("CMakeLists.txt").replace("VERSION EQUAL 2", &format!("{number} EQUAL 2"));
        let cmake = cmake.replace("MODEL_IDENTIFIER", name);
        let mut files = vec![
            ("modelDescription.xml".to_owned(), self.description(&variables)),
            (format!("sources/{name}.c"), self.code.source(&header)),
            (format!("sources/{header}"), self.code.header().to_owned()),
            ("sources/fmi-functions.c".to_owned(), self.wrapper(&variables)),
            // the name of a robot has no hyphen, so this file has no name in common with its files
            ("sources/fmi-types.h".to_owned(), types.to_owned()),
            ("sources/CMakeLists.txt".to_owned(), cmake),
            ("documentation/index.html".to_owned(), self.documentation()),
        ];
        if self.version == FmiVersion::Three {
            files.push(("sources/buildDescription.xml".to_owned(), self.build_description()));
        }
        files
    }

    /// Returns the names of the files in the folder `sources` that must be compiled.
    #[must_use]
    pub fn sources(&self) -> [String; 2] {
        [format!("{}.c", self.robot.name), "fmi-functions.c".to_owned()]
    }

    /// Returns the parameters that some program uses.
    fn parameters(&self) -> Vec<FmuParameter> {
        let is_used = |index| self.programs.iter().any(|program| used(program).any(|(used, _)| used == index));
        parameters::of(self.robot, is_used)
    }

    /// Returns the source with the functions of FMI.
    fn wrapper(&self, variables: &[Variable]) -> String {
        let (name, parameters) = (&self.robot.name, self.parameters());
        let equations = match self.causality {
            FmuCausality::Forward => include_str!("forward.c"),
            FmuCausality::Inverse => include_str!("inverse.c"),
        };
        let (own, [state, real, instance, deserialize, derivatives]) = match self.version {
            FmiVersion::Two => (
                include_str!("fmi2.c"),
                ["FMUstate", "fmi2Real", "fmi2Component", "DeSerializeFMUstate", "GetDerivatives"],
            ),
            FmiVersion::Three => (
                include_str!("fmi3.c"),
                ["FMUState", "fmi3Float64", "fmi3Instance", "DeserializeFMUState", "GetContinuousStateDerivatives"],
            ),
        };
        let number = if self.version == FmiVersion::Two { "2" } else { "3" };
        let common = include_str!("common.c")
            .replace("STATE_TYPE", &format!("fmi{number}{state}"))
            .replace("FMU_STATE", state)
            .replace("REAL", real)
            .replace("INSTANCE", instance)
            .replace("DESERIALIZE", deserialize)
            .replace("GET_DERIVATIVES", derivatives)
            .replace("fmiN", &format!("fmi{number}"))
            .replace("FMIN", &format!("FMI{number}"))
            .replace("OWN_FUNCTIONS", own);
        let first = variables.len() - PAYLOAD.len() - parameters.len();
        let mut filled = String::new();
        if !parameters.is_empty() {
            let upper = name.to_ascii_uppercase();
            let _ = writeln!(filled, "    {name}_parameters parameters = {upper}_PARAMETERS;");
            for (index, parameter) in parameters.iter().enumerate() {
                let _ = writeln!(filled, "    parameters.{} = v[{}];", parameter.member, first + index);
            }
        }
        let are_used = |&function: &Function| self.programs.iter().any(|one| one.function == function && are_used(one));
        let used: Vec<bool> = self.causality.functions().iter().map(are_used).collect();
        let mut equations = equations.to_owned();
        for (place, is_used) in ["VALUE_ARGUMENT", "DERIVATIVES_ARGUMENT", "MASS_ARGUMENT"].into_iter().zip(&used) {
            equations = equations.replace(place, if *is_used { ", &parameters" } else { "" });
        }
        // a function that uses no parameter does not fill the struct of the parameters
        let mut parts = equations.split("FILLED").map(str::to_owned).collect::<Vec<_>>();
        for (part, is_used) in parts.iter_mut().skip(1).zip([used[0], used[1..].contains(&true)]) {
            part.insert_str(0, if is_used { &filled } else { "" });
        }
        let starts: Vec<String> = variables.iter().map(|variable| format!("{:?}", variable.start)).collect();
        let model = include_str!("model.c")
            .replace("EQUATIONS", &parts.concat())
            .replace("COUNT_OF_VALUES", &variables.len().to_string())
            .replace("START_VALUES", &starts.join(",\n    "))
            .replace("INSTANTIATION_TOKEN", self.token)
            .replace("DOF", &self.robot.dof().to_string());
        let title = crate::c::comment("//", &format!("{}: the functions of FMI {number}.0.", inert::title(self.robot)));
        title + &with_name(&(model + "\n" + &common), name)
    }

    fn documentation(&self) -> String {
        let title = description::escaped(&inert::title(self.robot));
        let what = match self.causality {
            FmuCausality::Forward => "tau.JOINT in, q.JOINT, qd.JOINT and qdd.JOINT out (forward dynamics)",
            FmuCausality::Inverse => "q.JOINT, qd.JOINT and qdd.JOINT in, tau.JOINT out (inverse dynamics)",
        };
        include_str!("index.html").replace("CONTENT", what).replace("TITLE", &title)
    }
}

/// Inserts the name of the robot into a template. This comes last, because the name may contain another placeholder.
fn with_name(text: &str, name: &str) -> String {
    text.replace("PREFIX", name)
}
