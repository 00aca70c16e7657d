//! Writes and reads baseline files, which are made once and used for every later log of the arm.

use std::fmt::Write as _;

use nalgebra::{DMatrix, DVector};
use rne_identify::FittedModel;
use rne_logs::UtcTime;
use rne_model::document::{self, Content, Kind, Node};
use rne_model::{Report, Robot, one_line};

use crate::contact::{ContactNoise, JointNoise};
use crate::{Baseline, Candidate, Scale};

/// The version of the format of baseline files.
const FORMAT: u32 = 2;

const KIND: Kind = Kind { name: "a baseline file", format: FORMAT };

/// The keys of the beginning and the end of the quiet logs, UTC.
const KEYS_OF_SPAN: [&str; 2] = ["quiet_since", "quiet_until"];

/// Largest magnitude of a number in a baseline file.
const LARGEST: f64 = 1e60;

/// Relative difference below which two values of a robot file count as equal.
const SAME: f64 = 1e-9;

impl Baseline {
    /// Returns the text of a baseline file; `logs` describes its logs in words.
    #[must_use]
    pub fn to_yaml(&self, robot: &Robot, logs: &str) -> String {
        let structure = Self::structure(robot, self.cutoff);
        let file = FittedModel::of_file(&structure, &self.model.transitions).solution;
        let list = |numbers: &[f64]| {
            let all: Vec<String> = numbers.iter().map(|number| written(*number)).collect();
            format!("[{}]", all.join(", "))
        };
        let mut text = format!(
            "# A baseline of {}, written by rne from {}.\n# Later logs of the arm are compared with it.\n\
             format: {FORMAT}\n",
            one_line(&robot.name),
            one_line(logs)
        );
        let mut line = |key: &str, value: &str| {
            let _ = writeln!(text, "{key}: {value}");
        };
        line("cutoff", &written(self.cutoff));
        line("duration", &written(self.duration));
        line("rows", &self.rows.to_string());
        if let Some([start, end]) = self.span {
            let [since, until] = KEYS_OF_SPAN;
            line(since, &start.rfc3339());
            line(until, &end.rfc3339());
        }
        line("freedom", &written(self.freedom));
        line("delay", &written(self.model.delay));
        line("mass", &written(self.scale.mass));
        #[allow(clippy::cast_precision_loss)] // a few
        let transitions: Vec<f64> = self.model.transitions.iter().map(|at| *at as f64).collect();
        let lists: [(&str, &[f64]); 9] = [
            ("robot_file", file.as_slice()),
            ("transitions", &transitions),
            ("noise", &self.model.noise),
            ("residual", &self.residual),
            ("friction", &self.scale.friction),
            ("speed", &self.scale.speed),
            ("effort", &self.scale.effort),
            ("inflation", &self.inflation),
            ("solution", self.model.solution.as_slice()),
        ];
        for (key, numbers) in lists {
            line(key, &list(numbers));
        }
        let contact = self.contact.iter().flat_map(|noise| &noise.joints);
        let contact: Vec<f64> = contact.flat_map(|of| [of.mean, of.deviation, of.part, of.terms, of.inertia]).collect();
        line("contact", &list(&contact));
        text += "# upper triangle, row by row\ninformation:\n";
        for row in 0..self.model.information.nrows() {
            let numbers: Vec<f64> = self.model.information.row(row).iter().skip(row).copied().collect();
            let _ = writeln!(text, "  - {}", list(&numbers));
        }
        text
    }

    /// Reads a baseline file of a robot; `name` is for messages.
    ///
    /// # Errors
    /// When the text is no baseline file, or that of another robot file; the report gives the position.
    pub fn from_yaml(name: &str, text: &str, robot: &Robot) -> Result<Self, Report> {
        let root = document::read(name, text, KIND)?;
        let read = Reading { name, text, root: &root };
        #[allow(clippy::float_cmp)] // a whole number
        if read.number("format")? != f64::from(FORMAT) {
            return Err(read.refuse("format", &format!("this rne reads baselines of format {FORMAT}")));
        }
        let cutoff = read.number("cutoff").and_then(|cutoff| read.check("cutoff", cutoff, cutoff > 0.0))?;
        let structure = Self::structure(robot, cutoff);
        let (dof, count) = (structure.dof(), structure.count());
        let transitions = read.transitions(dof, structure.options().transitions().len())?;
        let file = FittedModel::of_file(&structure, &transitions).solution;
        let is_same = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME * a.abs().max(b.abs()).max(1e-6);
        let recorded = read.numbers("robot_file", count)?;
        if !recorded.iter().zip(file.iter()).all(is_same) {
            return Err(read.refuse(
                "robot_file",
                "this baseline was made with another robot file, or with another version of it; make a new one",
            ));
        }
        let solution = DVector::from_vec(read.numbers("solution", count)?);
        let model = FittedModel {
            solution,
            information: read.triangle("information", count)?,
            noise: read.noise(dof)?,
            transitions,
            delay: read.number("delay")?,
        };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // it saturates
        let rows = read.number("rows")? as u64;
        Ok(Self {
            cutoff,
            model,
            scale: Scale {
                friction: read.numbers("friction", dof)?,
                speed: read.numbers("speed", dof)?,
                effort: read.numbers("effort", dof)?,
                mass: read.number("mass")?,
            },
            inflation: read.numbers("inflation", Candidate::all(dof).len())?,
            freedom: read.number("freedom")?,
            residual: read.numbers("residual", dof)?,
            rows,
            duration: read.number("duration")?,
            span: read.span()?,
            doubt: 1.0,
            contact: read.contact(dof)?,
        })
    }
}

/// Formats a number with all its digits for YAML.
fn written(number: f64) -> String {
    if number.is_infinite() { ".inf".to_owned() } else { format!("{number:?}") }
}

struct Reading<'a> {
    name: &'a str,
    text: &'a str,
    root: &'a Node,
}

impl Reading<'_> {
    fn refuse_at(&self, node: &Node, message: &str) -> Report {
        Report::of_error(self.name, self.text, node.head(), message, None)
    }

    fn refuse(&self, key: &str, message: &str) -> Report {
        self.refuse_at(self.root.get(key).unwrap_or(self.root), message)
    }

    fn node(&self, key: &str) -> Result<&Node, Report> {
        self.root.get(key).ok_or_else(|| self.refuse(key, &format!("the key `{key}` is missing")))
    }

    fn number_of(&self, node: &Node) -> Result<f64, Report> {
        let parsed = match &node.content {
            Content::Scalar(scalar) => scalar.text.parse().ok().filter(|number: &f64| number.abs() <= LARGEST),
            _ => None,
        };
        parsed.ok_or_else(|| self.refuse_at(node, "a number is expected here"))
    }

    fn number(&self, key: &str) -> Result<f64, Report> {
        self.number_of(self.node(key)?)
    }

    /// Reads the span of the quiet logs, which a baseline has if their times were dates.
    fn span(&self) -> Result<Option<[UtcTime; 2]>, Report> {
        if self.root.get(KEYS_OF_SPAN[0]).is_none() {
            return Ok(None);
        }
        let time = |key: &str| {
            let node = self.node(key)?;
            let found = match &node.content {
                Content::Scalar(scalar) => UtcTime::from_rfc3339(&scalar.text),
                _ => None,
            };
            found.ok_or_else(|| self.refuse_at(node, "a date such as 2026-11-23T08:00:10.528Z is expected here"))
        };
        let [start, end] = KEYS_OF_SPAN;
        Ok(Some([time(start)?, time(end)?]))
    }

    fn check(&self, key: &str, number: f64, is_right: bool) -> Result<f64, Report> {
        if is_right { Ok(number) } else { Err(self.refuse(key, &format!("`{key}` must be above 0"))) }
    }

    fn list_of(&self, node: &Node) -> Result<Vec<f64>, Report> {
        match &node.content {
            Content::Sequence(items) => items.iter().map(|item| self.number_of(item)).collect(),
            _ => Err(self.refuse_at(node, "a list of numbers is expected here")),
        }
    }

    fn list(&self, key: &str) -> Result<Vec<f64>, Report> {
        self.list_of(self.node(key)?)
    }

    fn numbers(&self, key: &str, count: usize) -> Result<Vec<f64>, Report> {
        let numbers = self.list(key)?;
        if numbers.len() == count {
            Ok(numbers)
        } else {
            let message = format!("`{key}` has {} numbers, but {count} are expected for this robot", numbers.len());
            Err(self.refuse(key, &message))
        }
    }

    /// Reads the noise of each joint, which is infinite for a joint without efforts.
    fn noise(&self, dof: usize) -> Result<Vec<f64>, Report> {
        let node = self.node("noise")?;
        let Content::Sequence(items) = &node.content else { return self.numbers("noise", dof) };
        if items.len() != dof {
            return self.numbers("noise", dof);
        }
        let number = |item: &std::rc::Rc<Node>| match &item.content {
            Content::Scalar(scalar) if scalar.text == ".inf" => Ok(f64::INFINITY),
            _ => self.number_of(item).and_then(|noise| self.check("noise", noise, noise > 0.0)),
        };
        items.iter().map(number).collect()
    }

    /// Reads the transition of the friction of each joint, an index below `ways`.
    fn transitions(&self, dof: usize, ways: usize) -> Result<Vec<usize>, Report> {
        let transitions = self.numbers("transitions", dof)?;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // it saturates
        let transitions: Vec<usize> = transitions.into_iter().map(|at| at as usize).collect();
        if transitions.iter().any(|at| *at >= ways) {
            return Err(self.refuse("transitions", &format!("transitions are numbers from 0 to {}", ways - 1)));
        }
        Ok(transitions)
    }

    /// Reads the noise of the momentum observer, which a baseline for parameters only does not have.
    fn contact(&self, dof: usize) -> Result<Option<ContactNoise>, Report> {
        match self.list("contact")?.as_slice() {
            [] => Ok(None),
            numbers if numbers.len() == 5 * dof => {
                let joints = numbers.chunks_exact(5).map(|of| JointNoise {
                    mean: of[0],
                    deviation: of[1],
                    part: of[2],
                    terms: of[3],
                    inertia: of[4],
                });
                Ok(Some(ContactNoise { joints: joints.collect() }))
            }
            _ => Err(self.refuse("contact", &format!("a list of {} numbers is expected", 5 * dof))),
        }
    }

    fn triangle(&self, key: &str, count: usize) -> Result<DMatrix<f64>, Report> {
        let node = self.node(key)?;
        let Content::Sequence(rows) = &node.content else {
            return Err(self.refuse_at(node, "a list of rows is expected here"));
        };
        let mut matrix = DMatrix::zeros(count, count);
        if rows.len() != count {
            return Err(self
                .refuse_at(node, &format!("there are {} rows, but {count} are expected for this robot", rows.len())));
        }
        for (row, node) in rows.iter().enumerate() {
            let numbers = self.list_of(node)?;
            if numbers.len() != count - row {
                return Err(self.refuse_at(
                    node,
                    &format!("there are {} numbers, but {} are expected", numbers.len(), count - row),
                ));
            }
            for (column, number) in (row..count).zip(numbers) {
                matrix[(row, column)] = number;
                matrix[(column, row)] = number;
            }
        }
        Ok(matrix)
    }
}
