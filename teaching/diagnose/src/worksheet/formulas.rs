//! Writes the formulas of a worksheet for each joint: text, terms and inputs.

use std::collections::HashSet;

use nalgebra::{Matrix3, Vector3};
use rne_model::{JointKind, Robot, Row};
use rne_runtime::{BaseMotion, LinkTrace};

use super::quantity::indexed;
use super::{Axes, Input, Line, Quantity, Situation, Term, first_lever, followed, orientations};

/// The data from which the lines are made.
pub(super) struct Formulas<'a> {
    pub(super) robot: &'a Robot,
    pub(super) at: &'a Situation,
    pub(super) base: BaseMotion<f64>,
    pub(super) axes: Axes,
    /// The vectors of the links in the axes of the worksheet.
    pub(super) links: &'a [LinkTrace<f64>],
    /// The vectors of the links in axes fixed to each link.
    pub(super) fixed: &'a [LinkTrace<f64>],
}

pub(super) type V = Vector3<f64>;

/// The symbol of the axis of a joint if it is (0, 0, 1).
const AXIS: &str = "e";

/// The vectors of the steps as sums, with {i} for the joint, {p} for the previous and {n} for the next one. There are
/// four parts: terms of the previous link, which are rotated into the axes of this joint, terms of the link itself, and
/// additional terms of a revolute joint and of a prismatic one. A link without mass that has a first moment h has the
/// terms with h.
#[rustfmt::skip]
const SUMS: [(Quantity, [&str; 4]); 9] = [
    (Quantity::Omega, ["ω{p}", "", "q̇{i} e{i}", ""]),
    (Quantity::OmegaDot, ["ω̇{p}", "", "q̈{i} e{i} + q̇{i} ω{i} × e{i}", ""]),
    (Quantity::Velocity, ["ċ{p} + ω{p} × r{p}", "ω{i} × d{i}", "", "q̇{i} e{i}"]),
    (Quantity::Acceleration, [
        "c̈{p} + ω̇{p} × r{p} + ω{p} × (ω{p} × r{p})",
        "ω̇{i} × d{i} + ω{i} × (ω{i} × d{i})",
        "",
        "q̈{i} e{i} + 2 q̇{i} ω{i} × e{i}",
    ]),
    (Quantity::Gravity, ["g{p}", "", "", ""]),
    (Quantity::InertiaForce, ["", "m{i} c̈{i} + ω̇{i} × h{i} + ω{i} × (ω{i} × h{i})", "", ""]),
    (Quantity::InertiaMoment, ["", "I{i} ω̇{i} + ω{i} × I{i} ω{i} + h{i} × c̈{i}", "", ""]),
    (Quantity::JointForce, ["", "f{i} + f{i},{n} + -m{i} g{i}", "", ""]),
    (Quantity::JointMoment, ["", "n{i} + n{i},{n} + d{i} × f{p},{i} + r{i} × f{i},{n} + -h{i} × g{i}", "", ""]),
];

/// The data of the joint whose lines are written.
pub(super) struct Here<'a> {
    pub(super) i: usize,
    pub(super) kind: JointKind,
    pub(super) row: &'a Row,
    pub(super) link: &'a LinkTrace<f64>,
    /// The previous link, or the base.
    before: LinkTrace<f64>,
    /// The rotation from axes fixed to the link to the axes of the worksheet.
    pub(super) turn: Matrix3<f64>,
    pub(super) e: V,
    pub(super) q: [f64; 3],
}

/// A vector in a formula, and its inputs.
struct Part {
    term: Term,
    inputs: Vec<Input>,
}

impl Formulas<'_> {
    /// Returns all lines in the order of computation.
    pub(super) fn lines(&self) -> Vec<Line> {
        let orientations = orientations(self.fixed);
        let joints: Vec<Here<'_>> = (0..self.links.len()).map(|index| self.here(index, &orientations)).collect();
        let outward =
            joints.iter().flat_map(|here| [self.given(here, &orientations), self.steps(here, false)]).flatten();
        let inward = joints.iter().rev().flat_map(|here| self.steps(here, true));
        outward.chain(inward).collect()
    }

    /// Returns the lines of steps 1 to 5 of a joint or, with `inward`, of steps 6 and 7.
    fn steps(&self, here: &Here<'_>, inward: bool) -> Vec<Line> {
        let quantities = Quantity::ALL.into_iter().filter(|quantity| quantity.is_inward() == inward);
        quantities.filter_map(|quantity| self.of_step(here, quantity)).collect()
    }

    /// Returns the line of a quantity of steps 1 to 7; `None` for inputs of the steps.
    fn of_step(&self, here: &Here<'_>, quantity: Quantity) -> Option<Line> {
        match quantity {
            Quantity::NextForce | Quantity::NextMoment => Some(self.handed_on(here, quantity)),
            Quantity::Tau => Some(self.torque(here)),
            _ => SUMS.into_iter().find(|(of, _)| *of == quantity).map(|(_, terms)| self.sum(here, quantity, terms)),
        }
    }

    fn here(&self, index: usize, orientations: &[Matrix3<f64>]) -> Here<'_> {
        let (link, joint) = (&self.links[index], &self.robot.joints[index]);
        let turn = match self.axes {
            Axes::Link => Matrix3::identity(),
            Axes::Joint => about_z(self.fixed[index].sin, self.fixed[index].cos),
            Axes::Base => orientations[index],
        };
        let before = index.checked_sub(1).map_or_else(|| self.link_0(*link), |before| self.links[before]);
        let q = [self.at.q[index], self.at.qd[index], self.at.qdd[index]];
        let (kind, row) = (joint.row.kind, &joint.row);
        let e = if self.axes == Axes::Base { turn * V::z() } else { V::z() };
        Here { i: index + 1, kind, row, link, before, turn, e, q }
    }

    /// Returns the base in the form of a link, with its motion.
    fn link_0(&self, mut link: LinkTrace<f64>) -> LinkTrace<f64> {
        let BaseMotion { omega, omega_dot, velocity, acceleration, gravity } = self.base;
        (link.omega, link.omega_dot, link.velocity, link.acceleration) = (omega, omega_dot, velocity, acceleration);
        (link.gravity, link.r) = (gravity, first_lever(self.robot));
        link
    }

    /// Returns the line of a quantity of steps 1 to 7 for a joint, counted from 1.
    pub(super) fn line(&self, joint: usize, quantity: Quantity) -> Option<Line> {
        self.of_step(&self.here(joint.checked_sub(1)?, &orientations(self.fixed)), quantity)
    }

    /// Rotates a vector from the axes of the next joint into the axes of this joint, counted from 1.
    pub(super) fn turned(&self, joint: usize, own: [f64; 3]) -> Vec<f64> {
        match self.links.get(joint).filter(|_| self.axes != Axes::Base) {
            Some(next) => list(&(next.rotation_matrix() * V::from(own))),
            None => own.to_vec(),
        }
    }

    /// Returns a part of a formula with the numbers of the joints; the symbol of an axis (0, 0, 1) has no number.
    fn written(&self, here: &Here<'_>, template: &str) -> String {
        match self.axes {
            Axes::Base => indexed(template, here.i),
            _ => indexed(&template.replace(Quantity::Axis.template(), AXIS), here.i),
        }
    }

    /// Returns the symbol and value of an input of a formula at this joint.
    fn input(&self, here: &Here<'_>, template: &str) -> Input {
        let of = |link, template: &str| {
            let quantity = Quantity::ALL.into_iter().find(|quantity| quantity.template() == template)?;
            Some((link, quantity))
        };
        let known = of(here.link, template).or_else(|| of(&here.before, &template.replace("{p}", "{i}")));
        let values = known.map_or_else(
            || here.link.first_moment.to_vec(),
            |(link, quantity)| match quantity {
                Quantity::Qd => vec![here.q[1]],
                Quantity::Qdd => vec![here.q[2]],
                Quantity::Mass => vec![link.mass],
                Quantity::Axis => list(&here.e),
                Quantity::Rotation => link.rotation.concat(),
                Quantity::Inertia => link.inertia.concat(),
                _ => vector(*link, quantity),
            },
        );
        let unit = known.map_or("kg m", |(_, quantity)| quantity.unit(here.kind));
        input(self.written(here, template), &values, unit)
    }

    /// Computes a term of a sum from its text: a product of numbers, matrices and vectors, evaluated from right to
    /// left, with an optional sign or factor 2.
    fn part(&self, here: &Here<'_>, text: &str) -> Part {
        let (factor, product) = match (text.strip_prefix('-'), text.strip_prefix("2 ")) {
            (Some(product), _) => (-1.0, product),
            (_, Some(product)) => (2.0, product),
            _ => (1.0, text),
        };
        let symbols = product.split([' ', '×', '(', ')']).filter(|symbol| !symbol.is_empty());
        let inputs: Vec<Input> = symbols.map(|symbol| self.input(here, symbol)).collect();
        let value = inputs.iter().rev().map(|input| &input.values[..]).fold(None, |value: Option<V>, own| {
            Some(match (own, value) {
                (&[number], Some(value)) => number * value,
                (&[x, y, z], Some(value)) => V::new(x, y, z).cross(&value),
                (matrix, Some(value)) => Matrix3::from_row_slice(matrix) * value,
                (vector, None) => V::from_column_slice(vector),
            })
        });
        let value = value.unwrap_or_default();
        let mut term = term(&self.written(here, text), &(factor * value));
        if factor == 2.0 {
            let once = self.written(here, product);
            term.slips = vec![(format!("ḃ ω × e without its factor 2: {once}"), list(&value))];
        }
        Part { term, inputs }
    }

    /// Rotates a vector of the previous link into the axes of this joint, by Rᵀ.
    fn carried(&self, here: &Here<'_>, part: Part) -> Part {
        if self.axes == Axes::Base {
            return part;
        }
        let (i, value) = (here.i, V::from_column_slice(&part.term.values));
        let rotation = here.link.rotation_matrix();
        let slips = vec![
            (format!("R{i} is used in place of R{i}ᵀ"), list(&(rotation * value))),
            (format!("it is not turned by R{i}ᵀ"), list(&value)),
        ];
        let term = Term { slips, ..term(&turned_back(i, &part.term.text), &rotation.tr_mul(&value)) };
        Part { term, inputs: [vec![self.input(here, Quantity::Rotation.template())], part.inputs].concat() }
    }

    /// Returns the line of one of the [`SUMS`].
    fn sum(&self, here: &Here<'_>, quantity: Quantity, [before, own, turns, slides]: [&str; 4]) -> Line {
        let parts = |text: &str| -> Vec<Part> {
            let terms = text.split(" + ").filter(|term| !term.is_empty());
            let terms = terms.filter(|term| here.link.first_moment != [0.0; 3] || !term.contains('h'));
            terms.map(|text| self.part(here, text)).collect()
        };
        let texts = |parts: &[Part]| parts.iter().map(|part| part.term.text.clone()).collect::<Vec<_>>().join(" + ");
        let [before, mut own, more] =
            [before, own, if here.kind == JointKind::Revolute { turns } else { slides }].map(parts);
        own.extend(more);
        let first = texts(&before);
        let first = if self.axes == Axes::Base { first } else { turned_back(here.i, &first) };
        let formula = match (before.is_empty(), own.is_empty()) {
            (true, _) => texts(&own),
            (_, true) => first,
            _ => format!("{first} + {}", texts(&own)),
        };
        let parts = before.into_iter().map(|part| self.carried(here, part)).chain(own);
        let (terms, inputs): (Vec<Term>, Vec<Vec<Input>>) = parts.map(|part| (part.term, part.inputs)).unzip();
        let values = vector(*here.link, quantity);
        here.of_terms(quantity, values, &formula.replace("+ -", "- "), terms, inputs.concat())
    }

    /// Returns the line of step 7.
    fn torque(&self, here: &Here<'_>) -> Line {
        let Here { i, kind, link, .. } = here;
        let wrench = if *kind == JointKind::Revolute { Quantity::JointMoment } else { Quantity::JointForce };
        let mut inputs = [wrench, Quantity::Axis].map(|quantity| self.input(here, quantity.template())).to_vec();
        let text = format!("{} · {}", inputs[1].symbol, inputs[0].symbol);
        let mut terms = vec![scalar(&text, here.e.dot(&V::from_column_slice(&inputs[0].values)))];
        if let Some(motor) = self.robot.joints[i - 1].motor.filter(|_| self.robot.rotors) {
            let rotor = motor.gear_ratio * motor.gear_ratio * motor.inertia;
            let unit = if *kind == JointKind::Revolute { "kg m²" } else { "kg" };
            let rotor = input(format!("G{i}² Jm{i}"), &[rotor], unit);
            let rate_dot = self.input(here, Quantity::Qdd.template());
            let text = format!("{} {}", rotor.symbol, rate_dot.symbol);
            terms.push(scalar(&text, rotor.values[0] * here.q[2]));
            inputs.extend([rotor, rate_dot]);
        }
        let formula = terms.iter().map(|term| term.text.as_str()).collect::<Vec<_>>().join(" + ");
        here.of_terms(Quantity::Tau, vec![link.tau], &formula, terms, inputs)
    }

    /// Returns the line of the force or moment on the next link, rotated into the axes of this joint.
    fn handed_on(&self, here: &Here<'_>, quantity: Quantity) -> Line {
        let (i, n) = (here.i, here.i + 1);
        let values = vector(*here.link, quantity);
        let symbol = quantity.symbol(i);
        let Some(next) = self.links.get(i) else {
            let what = match (&self.at.wrench, &self.at.payload) {
                (Some(_), _) => "at the tip, in these axes",
                (None, Some(_)) => "on the payload",
                (None, None) => "free tip",
            };
            return here.line(quantity, values, what);
        };
        if self.axes == Axes::Base {
            return here.line(quantity, values, &format!("from joint {n}"));
        }
        let own = V::from(if quantity == Quantity::NextForce { next.joint_force } else { next.joint_moment });
        let slips = vec![
            (format!("R{n}ᵀ is used in place of R{n}"), list(&next.rotation_matrix().tr_mul(&own))),
            (format!("it is not turned by R{n}"), list(&own)),
        ];
        let text = format!("R{n} {symbol}");
        let formula = format!("{text}, from the axes of joint {n}");
        let inputs = vec![
            input(format!("R{n}"), &next.rotation.concat(), "1"),
            input(format!("{symbol} of joint {n}"), &list(&own), quantity.unit(here.kind)),
        ];
        let terms = vec![Term { text, values: values.clone(), slips }];
        here.of_terms(quantity, values, &formula, terms, inputs)
    }
}

impl Here<'_> {
    pub(super) fn line(&self, quantity: Quantity, values: Vec<f64>, formula: &str) -> Line {
        let (joint, kind, formula) = (self.i, self.kind, formula.to_owned());
        Line { joint, kind, quantity, values, formula, terms: Vec::new(), inputs: Vec::new() }
    }

    /// Makes a line from terms. Each input is listed once. An axis (0, 0, 1) is not an input.
    fn of_terms(
        &self,
        quantity: Quantity,
        values: Vec<f64>,
        formula: &str,
        terms: Vec<Term>,
        mut inputs: Vec<Input>,
    ) -> Line {
        let mut known = HashSet::from([AXIS.to_owned()]);
        inputs.retain(|input| known.insert(input.symbol.clone()));
        Line { terms, inputs, ..self.line(quantity, values, formula) }
    }
}

/// Returns the vector of a link for a quantity.
fn vector(mut link: LinkTrace<f64>, quantity: Quantity) -> Vec<f64> {
    followed::vector(&mut link, quantity).map_or_else(Vec::new, |vector| vector.to_vec())
}

/// Writes Rᵀ before a term or a sum.
fn turned_back(i: usize, text: &str) -> String {
    if text.contains(' ') { format!("R{i}ᵀ ({text})") } else { format!("R{i}ᵀ {text}") }
}

pub(super) fn term(text: &str, value: &V) -> Term {
    Term { text: text.to_owned(), values: list(value), slips: Vec::new() }
}

pub(super) fn scalar(text: &str, value: f64) -> Term {
    Term { text: text.to_owned(), values: vec![value], slips: Vec::new() }
}

fn input(symbol: String, values: &[f64], unit: &'static str) -> Input {
    Input { symbol, values: values.to_vec(), unit }
}

pub(super) fn list(value: &V) -> Vec<f64> {
    value.iter().copied().collect()
}

/// Returns the rotation Rz by an angle.
#[rustfmt::skip]
pub(super) fn about_z(sin: f64, cos: f64) -> Matrix3<f64> {
    Matrix3::new(
        cos, -sin, 0.0,
        sin, cos,  0.0,
        0.0, 0.0,  1.0,
    )
}
