//! Turns the text of a robot file into a validated robot, or into a report of all its mistakes.

use crate::readers::robot::{Takes, robot};
use crate::text::decode::Context;
use crate::text::diagnostic::{Problems, Report};
use crate::text::identifier::{JointIdentifier, identifiers};
use crate::{Robot, text::document, text::other_formats, text::source};

/// The result of reading a valid robot file: the robot, and the warnings and notes about it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Checked {
    /// The robot.
    pub robot: Robot,
    /// Warnings and notes about the file; often empty.
    pub lints: Report,
    /// The identifiers of the joints in generated code, in the order of the joints; or an error, at the line of the
    /// second joint, where two joints have the same identifier. A file with such names is valid: only code that
    /// contains the identifiers needs them.
    pub identifiers: Result<Vec<JointIdentifier>, Report>,
}

/// A reader of robot files. It gets a name for messages, then options such as other values of parameters, and then the
/// file.
///
/// ```
/// use rne_model::{Entry, Formula, Reader};
///
/// let text = "
/// format: 1
/// name: pendulum
/// source: a lecture
/// convention: standard
/// gravity: [0, -9.81, 0]
/// parameters: {payload: 0, m: 1.2 + payload}
/// joints:
///   - {type: revolute, dh: {theta: 0, d: 0, a: 0.5, alpha: 0}, link: {mass: m, com: [-1/4, 0, 0]}}
/// ";
/// let reader = Reader::new("pendulum.yaml");
/// assert_eq!(reader.read(text).unwrap().robot.joints[0].row.link.mass, 1.2);
///
/// let heavier = reader.clone().setting("payload", 2.0).read(text).unwrap().robot;
/// assert_eq!(heavier.joints[0].row.link.mass, 1.2 + 2.0);
///
/// let varying = reader.run_time(&["payload"]).read(text).unwrap().robot;
/// let mass = Formula::Number(1.2) + Formula::Parameter(0);
/// assert_eq!(varying.run_time.entries, [(Entry::Mass(0), mass)]);
/// assert_eq!(varying.joints[0].row.link.mass, 1.2);
/// ```
#[derive(Clone, Debug)]
pub struct Reader<'a> {
    name: &'a str,
    run_time: Vec<&'a str>,
    settings: Vec<(&'a str, f64)>,
    takes: Takes,
}

impl<'a> Reader<'a> {
    /// Makes a reader of a file that messages call `name`, usually the path of the file.
    #[must_use]
    pub const fn new(name: &'a str) -> Self {
        Self {
            name,
            run_time: Vec::new(),
            settings: Vec::new(),
            takes: Takes { trees: false, couplings: false, loops: false },
        }
    }

    /// Keeps these parameters of the file, each named once, free until run time. The numbers of the robot are those for
    /// the parameters' values in the file; [`Robot::run_time`] says how they depend on the parameters.
    ///
    /// These numbers may vary: gravity, `xyz`, `d`, `a`, masses, centres of mass, inertias and the numbers of motors,
    /// by `+ - * /` and whole powers, which become products. Where `libm::pow` rounds a power otherwise, the number in
    /// the robot is that of the product, too.
    ///
    /// The file has an error when it does not define a name under `parameters`; when an angle, a limit, a function, any
    /// other power or an exponent depends on such a parameter; when a number that depends on one is zero in the file,
    /// because zeros are folded away; and when no number depends on a parameter.
    #[must_use]
    pub fn run_time(mut self, names: &[&'a str]) -> Self {
        self.run_time.extend(names);
        self
    }

    /// Accepts trees, too: robots of `format: 2` whose joints branch off or begin at a placement. Without this call
    /// they are refused at their line, because not every function of rne takes a tree.
    #[must_use]
    pub fn trees(mut self) -> Self {
        self.takes.trees = true;
        self
    }

    /// Accepts robots with `couplings` or a list `motors`, too: some of their joints follow others, or rotors turn on
    /// their links. Without this call they are refused at their line, because not every function of rne takes them.
    #[must_use]
    pub fn couplings(mut self) -> Self {
        self.takes.couplings = true;
        self
    }

    /// Accepts robots with closed loops, too: [`Robot::closed`] has their equations, and the positions of their
    /// dependent joints are no coordinates. Without this call they are refused at their line, because not every
    /// function of rne takes them. Parallelograms count as couplings.
    #[must_use]
    pub fn loops(mut self) -> Self {
        self.takes.loops = true;
        self
    }

    /// Gives a parameter of the file another value than the file does; the numbers that the file defines through the
    /// parameter change with it. If one parameter is set twice, the last value counts.
    ///
    /// The file has an error when it does not define the name under `parameters`.
    #[must_use]
    pub fn setting(mut self, parameter: &'a str, value: f64) -> Self {
        self.settings.retain(|(known, _)| *known != parameter);
        self.settings.push((parameter, value));
        self
    }

    /// Reads and checks a robot file, given as text or as bytes that may not be text.
    ///
    /// # Errors
    ///
    /// Everything that is wrong with the file, with line, column and what is allowed; bytes that are not UTF-8 are an
    /// error at the first of them.
    pub fn read(&self, file: &(impl AsRef<[u8]> + ?Sized)) -> Result<Checked, Report> {
        let bytes = file.as_ref();
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        let problems = Problems::new();
        match std::str::from_utf8(bytes) {
            Ok(text) => self.read_text(text, problems),
            Err(_) if !source::size_is_fine(bytes.len(), document::ROBOT_FILE.name, &problems) => {
                Err(problems.finish(self.name, ""))
            }
            Err(error) => {
                source::not_utf8(bytes, error, document::ROBOT_FILE.name, &problems);
                Err(problems.finish(self.name, &String::from_utf8_lossy(bytes)))
            }
        }
    }

    fn read_text(&self, text: &str, problems: Problems) -> Result<Checked, Report> {
        // the beginning is enough to recognise another format, and a URDF may be long
        let beginning = other_formats::head(text);
        if let Some(other_format) = other_formats::instead_of_a_robot_file(self.name, beginning) {
            problems.push(other_format);
            return Err(problems.finish(self.name, beginning));
        }
        if !source::size_is_fine(text.len(), document::ROBOT_FILE.name, &problems) {
            return Err(problems.finish(self.name, ""));
        }
        let robot = source::is_printable(text, &problems)
            .then(|| document::parse(text, document::ROBOT_FILE, &problems))
            .flatten()
            .and_then(|root| {
                let context = Context::new(text, &problems, &self.run_time).with_settings(&self.settings);
                let robot = robot(&context, &root, self.takes)?;
                let identifiers = identifiers((self.name, text), &root, &robot.joints);
                Some((robot, identifiers))
            });
        let report = problems.finish(self.name, text);
        match robot {
            Some((robot, identifiers)) if !report.has_errors() => Ok(Checked { robot, lints: report, identifiers }),
            _ => Err(report),
        }
    }
}

impl Robot {
    /// Reads a robot file from its text, without its warnings and notes: [`Reader`] reports these.
    ///
    /// # Errors
    ///
    /// Everything that is wrong with the text; also a tree, which only [`Reader::trees`] accepts.
    pub fn from_yaml(text: &str) -> Result<Self, Report> {
        Reader::new("<yaml>").read(text).map(|checked| checked.robot)
    }
}
