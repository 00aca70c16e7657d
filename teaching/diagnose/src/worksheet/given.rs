//! Writes the lines of a worksheet with the inputs of the steps: the state, and the link in the axes of the worksheet.

use nalgebra::Matrix3;
use rne_model::{Convention, JointKind};

use super::formulas::{Formulas, Here, V, list, scalar, term};
use super::{Axes, Line, Quantity, Term, symmetric};

impl Formulas<'_> {
    /// Returns the lines with the inputs of the steps.
    pub(super) fn given(&self, here: &Here<'_>, orientations: &[Matrix3<f64>]) -> Vec<Line> {
        let Here { i, row, link, turn, .. } = *here;
        let given = |(quantity, value)| here.line(quantity, vec![value], "given");
        let mut lines: Vec<Line> =
            [Quantity::Q, Quantity::Qd, Quantity::Qdd].into_iter().zip(here.q).map(given).collect();
        let [theta, offset] = variables(here);
        let along = offset.values[0];
        lines.extend([theta, offset, given((Quantity::Mass, link.mass))]);
        lines.push(self.rotation_line(here, orientations));
        if self.axes == Axes::Base {
            lines.push(here.line(Quantity::Axis, list(&here.e), &format!("A{i} (0, 0, 1), the z column")));
        }
        // the vector from the joint along the row's offset, then to the centre of mass
        let fixed = &self.fixed[i - 1];
        let is_standard = self.is_standard();
        let along = V::new(if is_standard { row.dh.a } else { 0.0 }, 0.0, along);
        let com = V::from(fixed.d) - along;
        let lever = V::from(fixed.r) + com;
        let lead = self.lead(i);
        let turned = |text: &str| format!("{lead}{text}");
        let whole = |text: String| if lead.is_empty() { text } else { format!("{lead}({text})") };
        let (along_text, com_text) = if is_standard {
            (format!("(a{i}, 0, b{i})"), format!("Rx(α{i}) com{i}"))
        } else {
            (format!("(0, 0, b{i})"), format!("com{i}"))
        };
        let terms = vec![term(&turned(&along_text), &(turn * along)), term(&turned(&com_text), &(turn * com))];
        let line = here.line(Quantity::D, link.d.to_vec(), &whole(format!("{along_text} + {com_text}")));
        lines.push(Line { terms, ..line });
        let back = format!("-{}", turned(&com_text));
        let (formula, lever_text) = match self.lever(i).filter(|_| i < self.links.len() || lever.norm() != 0.0) {
            Some(text) => (whole(format!("{text} - {com_text}")), turned(&text)),
            None => (back.clone(), "the way to the next joint".to_owned()),
        };
        let terms = vec![term(&lever_text, &(turn * lever)), term(&back, &(-(turn * com)))];
        lines.push(Line { terms, ..here.line(Quantity::R, link.r.to_vec(), &formula) });
        lines.push(self.inertia_line(here));
        lines
    }

    fn is_standard(&self) -> bool {
        self.robot.convention == Convention::Standard
    }

    /// Returns the formula of the vector from the origin of a link to the next joint, or to the tip; `None` if both are
    /// the same point.
    fn lever(&self, i: usize) -> Option<String> {
        match (self.is_standard(), i == self.links.len()) {
            (true, true) => Some(format!("Rx(α{i}) tool")),
            (false, true) => Some("tool".to_owned()),
            (true, false) => None,
            (false, false) => Some(format!("(a{}, 0, 0)", i + 1)),
        }
    }

    /// Returns the line of the inertia, rotated from the axes of the file into those of the worksheet.
    fn inertia_line(&self, here: &Here<'_>) -> Line {
        let left = self.lead(here.i) + &if self.is_standard() { format!("Rx(α{})", here.i) } else { String::new() };
        let right = match left.trim_end() {
            left if left.contains(' ') => "(…)ᵀ".to_owned(),
            "" => String::new(),
            left => format!("{left}ᵀ"),
        };
        let about = if here.row.link.has_first_moment() { "the origin" } else { "com" };
        let formula = format!("{} I {right}, I of the file, about {about}", left.trim_end());
        let inertia = symmetric(&Matrix3::from(here.link.inertia).transpose());
        here.line(Quantity::Inertia, inertia, formula.trim_start())
    }

    /// Returns the line of the rotation from the previous link or from frame 0.
    fn rotation_line(&self, here: &Here<'_>, orientations: &[Matrix3<f64>]) -> Line {
        let (i, p) = (here.i, here.i - 1);
        let twist = match (self.is_standard(), i) {
            (true, 1) => String::new(),
            (true, _) => format!("Rx(α{p}) "),
            (false, _) => format!("Rx(α{i}) "),
        };
        let before = if p == 0 { String::new() } else { self.lead(p) };
        let own = if self.axes == Axes::Joint { String::new() } else { format!("Rz(θ{i})") };
        let formula = format!("{before}{twist}{own}");
        let formula = if formula.is_empty() { "1" } else { formula.trim() };
        match self.axes {
            Axes::Base => here.line(Quantity::Orientation, rows(&orientations[p]), formula),
            _ => here.line(Quantity::Rotation, here.link.rotation.concat(), formula),
        }
    }

    /// Returns the symbol of the matrix from axes fixed to a link to the axes of the worksheet, for writing before a
    /// vector.
    fn lead(&self, i: usize) -> String {
        match self.axes {
            Axes::Link => String::new(),
            Axes::Joint => format!("Rz(θ{i}) "),
            Axes::Base => format!("A{i} "),
        }
    }
}

/// Returns the lines of θ and of the offset of a joint, one of which is the joint variable.
fn variables(here: &Here<'_>) -> [Line; 2] {
    let slides = here.kind == JointKind::Prismatic;
    let dh = &here.row.dh;
    [(Quantity::Theta, dh.theta.radians, !slides), (Quantity::Offset, dh.d, slides)].map(
        |(quantity, constant, moves)| {
            let own = moves.then(|| scalar(&format!("q{}", here.i), here.q[0]));
            let formula = match &own {
                None => "of the row".to_owned(),
                Some(own) if constant == 0.0 => own.text.clone(),
                Some(own) => format!("{} + {}", own.text, short(constant)).replace("+ -", "- "),
            };
            let terms: Vec<Term> = own.into_iter().chain([scalar("the constant of its row", constant)]).collect();
            let sum = terms.iter().map(|term| term.values[0]).sum();
            Line { terms, ..here.line(quantity, vec![sum], &formula) }
        },
    )
}

/// Formats a number with six digits.
fn short(value: f64) -> String {
    let value: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    value.to_string()
}

fn rows(matrix: &Matrix3<f64>) -> Vec<f64> {
    matrix.transpose().iter().copied().collect()
}
