//! `rne show --symbolic` and `--latex`: prints the dynamics in closed form.

use std::path::Path;

use clap::{Args, ValueEnum};

use rne_model::{Joint, Robot};
use rne_symbolic::{ClosedForm, LatexStyle};

use crate::files::robot_file::{self, Frames, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::{TITLE, TYPED};
use crate::render::letters::Letters;

/// The dynamics in closed form, instead of code.
#[derive(Args)]
pub(crate) struct Wanted {
    /// Print symbolic equations of motion, τ = M θ̈ + h + γ
    #[arg(long, conflicts_with_all = OTHERS)]
    symbolic: bool,
    /// Print them as LaTeX: article (default), body for \input, or beamer, a frame for each torque
    #[arg(long, value_name = "STYLE", value_enum, hide_possible_values = true, num_args = 0..=1, require_equals = true,
        default_missing_value = "article", conflicts_with_all = OTHERS)]
    latex: Option<Style>,
    /// Print symbolic equations of motion of joints 1 to N
    #[arg(long, value_name = "N", value_parser = crate::values::choice::joint, conflicts_with_all = OTHERS)]
    first: Option<usize>,
}

/// The use of the LaTeX.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Style {
    /// A document
    Article,
    /// Equations alone
    Body,
    /// Slides
    Beamer,
}

impl From<Style> for LatexStyle {
    fn from(style: Style) -> Self {
        match style {
            Style::Article => Self::Article,
            Style::Body => Self::Body,
            Style::Beamer => Self::Beamer,
        }
    }
}

/// Options of the listing that have no meaning for a closed form.
const OTHERS: [&str; 9] =
    ["joint", "step", "form", "function", "keep", "without", "base_parameters", "equations", "json"];

impl Wanted {
    /// Returns whether the command line asks for a closed form.
    pub(crate) fn is_asked_for(&self) -> bool {
        self.symbolic || self.latex.is_some() || self.first.is_some()
    }

    /// Prints the closed form of the arm in a file.
    pub(crate) fn run(
        &self,
        file: &Path,
        letters: Letters,
        of: impl FnOnce(Robot) -> Robot,
    ) -> Result<Outcome, Failure> {
        let (checked, bytes) = robot_file::read_with_run_time(file, &[], Frames::Dropped, Shape::Tree)?;
        let joints = match self.first {
            Some(joint) if joint == 0 || joint > checked.robot.dof() => {
                let (name, dof) = (&checked.robot.name, checked.robot.dof());
                return Err(usage_error!("{name} has {dof} joints; --first takes 1 to {dof}"));
            }
            first => first.unwrap_or(checked.robot.dof()),
        };
        // errors of the file were reported when it was read, so here only its name is needed
        let name = file.display().to_string();
        let robot = of(rne_symbolic::read(&name, &bytes).map_err(|report| Failure::from(&report))?);
        let form = ClosedForm::of(&robot, joints);
        let title = rne_emit::title(&robot);
        let has_rotor = |joint: &Joint| joint.motor.is_some_and(|motor| motor.inertia != 0.0);
        let remark = if !robot.rotors && robot.joints.iter().any(has_rotor) {
            format!("the inertia of the rotors is left out; {TYPED}--rotors{TYPED:#} adds it\n")
        } else {
            String::new()
        };
        if let Some(style) = self.latex {
            let text = form.latex(&rne_emit::ascii(&title), style.into());
            return Ok(Outcome { text, remark, ..Outcome::default() });
        }
        let text = form.text_spelt(|text| letters.of(text));
        let mut before = "";
        let styled = |line| {
            // a heading is a line after an empty one, above indented lines
            let is_heading = std::mem::replace(&mut before, line).is_empty() && !line.ends_with('.');
            if is_heading && !line.is_empty() { format!("{TITLE}{line}{TITLE:#}\n") } else { format!("{line}\n") }
        };
        let text: String = text.lines().map(styled).collect();
        let title = letters.of(&title);
        let shorter = |joints| {
            format!("\n{TYPED}--first {joints}{TYPED:#} prints the closed form of the arm up to joint {joints}.\n")
        };
        let shorter = form.shorter().map(shorter).unwrap_or_default();
        let text = format!("{TITLE}{title}{TITLE:#}\n\n{text}{shorter}");
        Ok(Outcome { text, remark, remark_last: true, ..Outcome::default() })
    }
}
