//! Writes modelDescription.xml and buildDescription.xml.

use std::fmt::Write;

use super::variables::{Role, Variable};
use super::{FmiVersion, Fmu, FmuCausality, units};
use crate::inert;

/// Whether a variable belongs to one of the lists of the model structure.
type IsListed = fn(&Variable) -> bool;

/// Escapes a text for an attribute of XML.
pub(super) fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            // characters that XML does not allow
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

/// Whether a name is a structured name of FMI: identifiers with points between them.
fn is_structured(name: &str) -> bool {
    name.split('.').all(|part| {
        let starts = part.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        starts && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    })
}

impl Fmu<'_> {
    pub(super) fn description(&self, variables: &[Variable]) -> String {
        let naming = if variables.iter().all(|one| is_structured(&one.name)) { "structured" } else { "flat" };
        let (name, token) = (escaped(&self.robot.name), escaped(self.token));
        let title = escaped(&inert::title(self.robot));
        let tool = concat!("rne ", env!("CARGO_PKG_VERSION"));
        let is_third = self.version == FmiVersion::Three;
        let (version, identity) = if is_third { ("3.0", "instantiationToken") } else { ("2.0", "guid") };
        let mut text = format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"{version}\" \
             modelName=\"{name}\" {identity}=\"{token}\" description=\"{title}\" generationTool=\"{tool}\" \
             variableNamingConvention=\"{naming}\"{}>\n",
            if is_third { "" } else { " numberOfEventIndicators=\"0\"" }
        );
        for kind in ["ModelExchange", "CoSimulation"] {
            self.interface(&mut text, kind);
        }
        text.push_str("  <UnitDefinitions>\n");
        for (unit, exponents) in units::ALL {
            if !variables.iter().any(|variable| variable.unit == Some(unit)) {
                continue;
            }
            let of = ["kg", "m", "s", "rad"].into_iter().zip(exponents).filter(|(_, exponent)| *exponent != 0);
            let base = of.fold(String::new(), |text, (base, exponent)| text + &format!(" {base}=\"{exponent}\""));
            let degrees = if unit == "rad" { "<DisplayUnit name=\"deg\" factor=\"57.29577951308232\"/>" } else { "" };
            let _ = writeln!(text, "    <Unit name=\"{unit}\"><BaseUnit{base}/>{degrees}</Unit>");
        }
        text.push_str(
            "  </UnitDefinitions>\n  <DefaultExperiment startTime=\"0\" stopTime=\"1\" stepSize=\"0.01\"/>\n",
        );
        text.push_str("  <ModelVariables>\n");
        for (index, variable) in variables.iter().enumerate() {
            self.variable(&mut text, index, variable);
        }
        text.push_str("  </ModelVariables>\n  <ModelStructure>\n");
        self.structure(&mut text, variables);
        text.push_str("  </ModelStructure>\n</fmiModelDescription>\n");
        text
    }

    /// Writes the element of an interface type; in FMI 2.0 it lists the sources.
    fn interface(&self, text: &mut String, kind: &str) {
        let name = escaped(&self.robot.name);
        let steps = if kind == "CoSimulation" { " canHandleVariableCommunicationStepSize=\"true\"" } else { "" };
        match self.version {
            FmiVersion::Three => {
                let _ = writeln!(
                    text,
                    "  <{kind} modelIdentifier=\"{name}\" canGetAndSetFMUState=\"true\" \
                     canSerializeFMUState=\"true\" providesDirectionalDerivatives=\"true\" \
                     providesAdjointDerivatives=\"true\"{steps}/>"
                );
            }
            FmiVersion::Two => {
                let _ = writeln!(
                    text,
                    "  <{kind} modelIdentifier=\"{name}\"{steps} canNotUseMemoryManagementFunctions=\"true\" \
                     canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\" \
                     providesDirectionalDerivative=\"true\">\n    <SourceFiles>{}</SourceFiles>\n  </{kind}>",
                    self.source_files("File")
                );
            }
        }
    }

    fn source_files(&self, element: &str) -> String {
        let of = |source: &String| format!("<{element} name=\"{}\"/>", escaped(source));
        self.sources().iter().fold(String::new(), |text, source| text + &of(source))
    }

    pub(super) fn build_description(&self) -> String {
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiBuildDescription fmiVersion=\"3.0\">\n  \
             <BuildConfiguration modelIdentifier=\"{}\">\n    <SourceFileSet language=\"C99\">{}</SourceFileSet>\n  \
             </BuildConfiguration>\n</fmiBuildDescription>\n",
            escaped(&self.robot.name),
            self.source_files("SourceFile")
        )
    }

    fn variable(&self, text: &mut String, index: usize, variable: &Variable) {
        let (causality, variability, initial) = match variable.role {
            Role::Time => ("independent", "continuous", ""),
            Role::Input => ("input", "continuous", ""),
            Role::Output => ("output", "continuous", "calculated"),
            Role::State => ("output", "continuous", "exact"),
            Role::Tunable => ("parameter", "tunable", "exact"),
            Role::Fixed => ("parameter", "fixed", "exact"),
        };
        let mut common = format!(
            "name=\"{}\" valueReference=\"{index}\" causality=\"{causality}\" variability=\"{variability}\"",
            escaped(&variable.name)
        );
        if !initial.is_empty() {
            let _ = write!(common, " initial=\"{initial}\"");
        }
        let _ = write!(common, " description=\"{}\"", escaped(&variable.description));
        let mut own = String::new();
        if let Some(unit) = variable.unit {
            let _ = write!(own, " unit=\"{unit}\"");
            own.push_str(if unit == "rad" { " displayUnit=\"deg\"" } else { "" });
        }
        if let Some((least, most)) = variable.range {
            let _ = write!(own, " min=\"{least:?}\" max=\"{most:?}\"");
        }
        if !matches!(variable.role, Role::Time | Role::Output) {
            let _ = write!(own, " start=\"{:?}\"", variable.start);
        }
        if let Some(of) = variable.derivative_of {
            let _ = write!(own, " derivative=\"{}\"", self.reference(of));
        }
        let _ = match self.version {
            FmiVersion::Three => writeln!(text, "    <Float64 {common}{own}/>"),
            FmiVersion::Two => writeln!(text, "    <ScalarVariable {common}><Real{own}/></ScalarVariable>"),
        };
    }

    /// Returns the number by which another variable is referred to: its value reference, in FMI 2.0 its place counted
    /// from 1.
    fn reference(&self, variable: usize) -> usize {
        if self.version == FmiVersion::Two { variable + 1 } else { variable }
    }

    fn structure(&self, text: &mut String, variables: &[Variable]) {
        let (dof, is_forward) = (self.robot.dof(), self.causality == FmuCausality::Forward);
        let is_second = self.version == FmiVersion::Two;
        // a state depends only on itself; a result depends on the three arrays of arguments
        let (result, arguments): (usize, Vec<usize>) = if is_forward {
            (2 * dof + 1, (1..=2 * dof).chain(3 * dof + 1..=4 * dof).collect())
        } else {
            (3 * dof + 1, (1..=3 * dof).collect())
        };
        let lists: [(&str, &str, IsListed); 3] = [
            ("Outputs", "Output", |variable| matches!(variable.role, Role::Output | Role::State)),
            ("Derivatives", "ContinuousStateDerivative", |variable| variable.derivative_of.is_some()),
            ("InitialUnknowns", "InitialUnknown", |variable| variable.role == Role::Output),
        ];
        for (list, element, is_listed) in lists {
            let (tag, by) = if is_second { ("Unknown", "index") } else { (element, "valueReference") };
            let mut lines = String::new();
            for index in (0..variables.len()).filter(|&index| is_listed(&variables[index])) {
                let _ = write!(lines, "    <{tag} {by}=\"{}\"", self.reference(index));
                // without a list of dependencies, an initial value depends on all variables, also on parameters
                if list != "InitialUnknowns" {
                    let known = if index < result { &[index][..] } else { &arguments };
                    let known: Vec<String> = known.iter().map(|&known| self.reference(known).to_string()).collect();
                    let kind = if index < result { " dependenciesKind=\"constant\"" } else { "" };
                    let _ = write!(lines, " dependencies=\"{}\"{kind}", known.join(" "));
                }
                lines.push_str("/>\n");
            }
            if is_second && !lines.is_empty() {
                lines = format!("    <{list}>\n{lines}    </{list}>\n");
            }
            text.push_str(&lines);
        }
    }
}
