//! The formulas of a worksheet, written out for one joint: text, terms, and what goes into them.

use std::fmt::Write as _;

use nalgebra::{Matrix3, Vector3};
use rne_model::{Convention, JointKind, Robot, Row};
use rne_runtime::{BaseMotion, LinkTrace};

use super::{Axes, Input, Line, Quantity, Situation, Term, first_lever, orientations};

/// The data that the lines are made of.
pub(super) struct Formulas<'a> {
    pub(super) robot: &'a Robot,
    pub(super) at: &'a Situation,
    pub(super) base: BaseMotion<f64>,
    pub(super) axes: Axes,
    /// In these axes.
    pub(super) links: &'a [LinkTrace<f64>],
    /// In axes fixed to each link.
    pub(super) fixed: &'a [LinkTrace<f64>],
}

type V = Vector3<f64>;

/// A joint whose lines are written.
struct Here<'a> {
    i: usize,
    kind: JointKind,
    row: &'a Row,
    link: &'a LinkTrace<f64>,
    /// R_i in these axes; 1 in those of the base.
    rotation: Matrix3<f64>,
    /// From axes fixed to the link into these.
    turn: Matrix3<f64>,
    e: V,
    q: [f64; 3],
    /// How the link before moves, and r_{i-1}.
    before: (BaseMotion<f64>, V),
}

/// A vector in a formula: how it is written, its components, and what goes into it.
#[derive(Clone)]
struct Part {
    term: Term,
    value: V,
    inputs: Vec<Input>,
}

impl Part {
    fn new(text: &str, value: impl Into<V>, unit: &'static str) -> Self {
        let value = value.into();
        let inputs = vec![input(text.to_owned(), &list(&value), unit)];
        Self { term: term(text, &value), value, inputs }
    }

    fn made(text: &str, value: V, inputs: &[Input]) -> Self {
        Self { term: term(text, &value), value, inputs: inputs.to_vec() }
    }

    fn cross(&self, other: &Self) -> Self {
        let (left, right) = (&self.term.text, &other.term.text);
        let text = if right.contains('×') { format!("{left} × ({right})") } else { format!("{left} × {right}") };
        Self::made(&text, self.value.cross(&other.value), &[&self.inputs[..], &other.inputs].concat())
    }

    /// Multiplied by a number, or by a matrix, that is written before it.
    fn times<F>(&self, (factor, input): &(F, Input)) -> Self
    where
        F: Copy + std::ops::Mul<V, Output = V>,
    {
        let text = format!("{} {}", input.symbol, self.term.text);
        Self::made(&text, *factor * self.value, &[std::slice::from_ref(input), &self.inputs].concat())
    }

    fn negative(&self) -> Self {
        Self::made(&format!("-{}", self.term.text), -self.value, &self.inputs)
    }
}

impl Formulas<'_> {
    /// All lines, in the order of computation.
    pub(super) fn lines(&self) -> Vec<Line> {
        let orientations = orientations(self.fixed);
        let joints: Vec<Here<'_>> = (0..self.links.len()).map(|index| self.here(index, &orientations)).collect();
        let outward = joints.iter().flat_map(|here| [self.given(here, &orientations), self.outward(here)]).flatten();
        let inward = joints.iter().rev().flat_map(|here| self.inward(here));
        outward.chain(inward).collect()
    }

    fn here(&self, index: usize, orientations: &[Matrix3<f64>]) -> Here<'_> {
        let (link, joint) = (&self.links[index], &self.robot.joints[index]);
        let turn = match self.axes {
            Axes::Link => Matrix3::identity(),
            Axes::Joint => about_z(self.fixed[index].sin, self.fixed[index].cos),
            Axes::Base => orientations[index],
        };
        let before = match index.checked_sub(1).map(|before| &self.links[before]) {
            Some(&LinkTrace { omega, omega_dot, velocity, acceleration, gravity, r, .. }) => {
                (BaseMotion { omega, omega_dot, velocity, acceleration, gravity }, r.into())
            }
            None => (self.base, first_lever(self.robot).into()),
        };
        let q = [self.at.q[index], self.at.qd[index], self.at.qdd[index]];
        let (kind, row) = (joint.row.kind, &joint.row);
        let e = if self.axes == Axes::Base { turn * V::z() } else { V::z() };
        Here { i: index + 1, kind, row, link, rotation: link.rotation_matrix(), turn, e, q, before }
    }

    /// The line of a quantity of steps 1 to 7 of a joint, counted from 1.
    pub(super) fn line(&self, joint: usize, quantity: Quantity) -> Option<Line> {
        let here = self.here(joint.checked_sub(1)?, &orientations(self.fixed));
        let lines = if quantity.is_inward() { self.inward(&here) } else { self.outward(&here) };
        lines.into_iter().find(|line| line.quantity == quantity)
    }

    /// A vector in the axes of the joint after this one, in the axes of this one, counted from 1.
    pub(super) fn turned(&self, joint: usize, own: [f64; 3]) -> Vec<f64> {
        match self.links.get(joint).filter(|_| self.axes != Axes::Base) {
            Some(next) => list(&(next.rotation_matrix() * V::from(own))),
            None => own.to_vec(),
        }
    }

    /// The lines of the inputs of the steps.
    fn given(&self, here: &Here<'_>, orientations: &[Matrix3<f64>]) -> Vec<Line> {
        let Here { i, kind, row, link, turn, .. } = here;
        let (i, [q, qd, qdd]) = (*i, here.q);
        let slides = *kind == JointKind::Prismatic;
        let [theta, offset] = [(row.dh.theta.radians, !slides), (row.dh.d, slides)].map(|(constant, moves)| {
            let own = if moves { vec![scalar(&format!("q{i}"), q)] } else { Vec::new() };
            own.into_iter().chain([scalar("the constant of its row", constant)]).collect::<Vec<_>>()
        });
        let sum = |terms: &[Term]| terms.iter().map(|term| term.values[0]).sum::<f64>();
        let moving = |terms: &[Term]| match terms {
            [own, constant] if constant.values[0] == 0.0 => own.text.clone(),
            [own, constant] => format!("{} + {}", own.text, short(constant.values[0])).replace("+ -", "- "),
            _ => "of the row".to_owned(),
        };
        let mut lines = vec![
            here.line(Quantity::Q, vec![q], "given"),
            here.line(Quantity::Qd, vec![qd], "given"),
            here.line(Quantity::Qdd, vec![qdd], "given"),
            Line { terms: theta.clone(), ..here.line(Quantity::Theta, vec![sum(&theta)], &moving(&theta)) },
            Line { terms: offset.clone(), ..here.line(Quantity::Offset, vec![sum(&offset)], &moving(&offset)) },
            here.line(Quantity::Mass, vec![link.mass], "given"),
        ];
        lines.push(self.rotation_line(here, orientations));
        if self.axes == Axes::Base {
            lines.push(here.line(Quantity::Axis, list(&here.e), &format!("A{i} (0, 0, 1), the z column")));
        }
        // from the joint along the row's offset, then to the centre of mass
        let fixed = &self.fixed[i - 1];
        let standard = self.robot.convention == Convention::Standard;
        let along = V::new(if standard { row.dh.a } else { 0.0 }, 0.0, sum(&offset));
        let com = V::from(fixed.d) - along;
        let lever = V::from(fixed.r) + com;
        let turned = |text: &str| match self.axes {
            Axes::Link => text.to_owned(),
            Axes::Joint => format!("Rz(θ{i}) {text}"),
            Axes::Base => format!("A{i} {text}"),
        };
        let along_text = if standard { format!("(a{i}, 0, b{i})") } else { format!("(0, 0, b{i})") };
        let com_text = if standard { format!("Rx(α{i}) com{i}") } else { format!("com{i}") };
        let last = i == self.links.len();
        let lever_text = match (standard, last) {
            (true, true) => format!("Rx(α{i}) tool"),
            (false, true) => "tool".to_owned(),
            (true, false) => String::new(),
            (false, false) => format!("(a{}, 0, 0)", i + 1),
        };
        let whole = |text: String| if self.axes == Axes::Link { text } else { turned(&format!("({text})")) };
        let d_terms = vec![term(&turned(&along_text), &(turn * along)), term(&turned(&com_text), &(turn * com))];
        lines.push(Line {
            terms: d_terms,
            ..here.line(Quantity::D, link.d.to_vec(), &whole(format!("{along_text} + {com_text}")))
        });
        let no_lever = lever_text.is_empty() || (last && lever.norm() == 0.0);
        let r_formula =
            if no_lever { format!("-{}", turned(&com_text)) } else { whole(format!("{lever_text} - {com_text}")) };
        let lever_text = if no_lever { "the way to the next joint".to_owned() } else { turned(&lever_text) };
        let r_terms =
            vec![term(&lever_text, &(turn * lever)), term(&format!("-{}", turned(&com_text)), &(-(turn * com)))];
        lines.push(Line { terms: r_terms, ..here.line(Quantity::R, link.r.to_vec(), &r_formula) });
        let (left, right) = match (self.axes, standard) {
            (Axes::Link, true) => (format!("Rx(α{i})"), format!("Rx(α{i})ᵀ")),
            (Axes::Link, false) => (String::new(), String::new()),
            (Axes::Joint, true) => (format!("Rz(θ{i}) Rx(α{i})"), "(…)ᵀ".to_owned()),
            (Axes::Joint, false) => (format!("Rz(θ{i})"), format!("Rz(θ{i})ᵀ")),
            (Axes::Base, true) => (format!("A{i} Rx(α{i})"), "(…)ᵀ".to_owned()),
            (Axes::Base, false) => (format!("A{i}"), format!("A{i}ᵀ")),
        };
        let about = if row.link.has_first_moment() { "the origin" } else { "com" };
        let formula = format!("{left} I {right}, I of the file, about {about}");
        let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = link.inertia;
        lines.push(here.line(Quantity::Inertia, vec![xx, xy, xz, yy, yz, zz], formula.trim_start()));
        lines
    }

    fn rotation_line(&self, here: &Here<'_>, orientations: &[Matrix3<f64>]) -> Line {
        let (i, p) = (here.i, here.i - 1);
        let standard = self.robot.convention == Convention::Standard;
        let twist = match (standard, i) {
            (true, 1) => String::new(),
            (true, _) => format!("Rx(α{p}) "),
            (false, _) => format!("Rx(α{i}) "),
        };
        match self.axes {
            Axes::Link => here.line(Quantity::Rotation, rows(&here.rotation), format!("{twist}Rz(θ{i})").trim()),
            Axes::Joint => {
                let before = if p == 0 { String::new() } else { format!("Rz(θ{p}) ") };
                let formula = format!("{before}{twist}");
                let formula = if formula.is_empty() { "1" } else { formula.trim() };
                here.line(Quantity::Rotation, rows(&here.rotation), formula)
            }
            Axes::Base => {
                let before = if p == 0 { String::new() } else { format!("A{p} ") };
                here.line(Quantity::Orientation, rows(&orientations[p]), &format!("{before}{twist}Rz(θ{i})"))
            }
        }
    }

    /// Rᵀ of a vector of the link before.
    fn carried(&self, here: &Here<'_>, part: &Part) -> Part {
        if self.axes == Axes::Base {
            return part.clone();
        }
        let (i, value) = (here.i, &part.value);
        let input = input(format!("R{i}"), &rows(&here.rotation), "1");
        let mut carried = Part::made(
            &turned_back(i, &part.term.text),
            here.rotation.tr_mul(value),
            &[&[input], &part.inputs[..]].concat(),
        );
        carried.term.slips = vec![
            (format!("R{i} is used in place of R{i}ᵀ"), list(&(here.rotation * value))),
            (format!("it is not turned by R{i}ᵀ"), list(value)),
        ];
        carried
    }

    /// A line that is the sum of vectors of the link before, which are turned into these axes, and of others.
    fn sum(&self, here: &Here<'_>, quantity: Quantity, before: &[Part], own: &[Part]) -> Line {
        let joined = |parts: &[Part]| {
            let texts: Vec<&str> = parts.iter().map(|part| part.term.text.as_str()).collect();
            texts.join(" + ").replace("+ -", "- ")
        };
        let mut formula = joined(before);
        if self.axes != Axes::Base && !before.is_empty() {
            formula = turned_back(here.i, &formula);
        }
        let formula =
            [formula, joined(own)].into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join(" + ");
        let parts: Vec<Part> = before.iter().map(|part| self.carried(here, part)).chain(own.iter().cloned()).collect();
        let mut inputs: Vec<Input> = Vec::new();
        for input in parts.iter().flat_map(|part| &part.inputs) {
            if !inputs.iter().any(|known| known.symbol == input.symbol) {
                inputs.push(input.clone());
            }
        }
        let terms = parts.into_iter().map(|part| part.term).collect();
        Line { terms, inputs, ..here.line(quantity, here.vector(quantity).to_vec(), &formula) }
    }

    /// e, which is an input only where it has other components than (0, 0, 1).
    fn axis(&self, here: &Here<'_>) -> Part {
        if self.axes == Axes::Base {
            return Part::new(&format!("e{}", here.i), here.e, "1");
        }
        Part::made("e", here.e, &[])
    }

    /// Steps 1 to 5.
    fn outward(&self, here: &Here<'_>) -> Vec<Line> {
        let own = |quantity| here.part(quantity);
        let (p, (motion, r)) = (here.i - 1, &here.before);
        let part =
            |quantity: Quantity, value: [f64; 3]| Part::new(&quantity.symbol(p), value, quantity.unit(here.kind));
        let omega_p = part(Quantity::Omega, motion.omega);
        let omega_dot_p = part(Quantity::OmegaDot, motion.omega_dot);
        let r_p = part(Quantity::R, (*r).into());
        let (omega, omega_dot, d, e) =
            (own(Quantity::Omega), own(Quantity::OmegaDot), own(Quantity::D), self.axis(here));
        let [rate, rate_dot] = [(Quantity::Qd, here.q[1]), (Quantity::Qdd, here.q[2])]
            .map(|(quantity, value)| (value, input(quantity.symbol(here.i), &[value], quantity.unit(here.kind))));
        let is_revolute = here.kind == JointKind::Revolute;
        let of_revolute = |parts: &[Part]| if is_revolute { parts.to_vec() } else { Vec::new() };
        let with_prismatic = |parts: &[Part], more: &[Part]| [parts, if is_revolute { &[] } else { more }].concat();

        let spin = of_revolute(&[e.times(&rate)]);
        let step_1 = self.sum(here, Quantity::Omega, std::slice::from_ref(&omega_p), &spin);

        let spin = of_revolute(&[e.times(&rate_dot), omega.cross(&e).times(&rate)]);
        let step_2 = self.sum(here, Quantity::OmegaDot, std::slice::from_ref(&omega_dot_p), &spin);

        let before = [part(Quantity::Velocity, motion.velocity), omega_p.cross(&r_p)];
        let step_3 =
            self.sum(here, Quantity::Velocity, &before, &with_prismatic(&[omega.cross(&d)], &[e.times(&rate)]));

        let before = [
            part(Quantity::Acceleration, motion.acceleration),
            omega_dot_p.cross(&r_p),
            omega_p.cross(&omega_p.cross(&r_p)),
        ];
        let about_joint = [omega_dot.cross(&d), omega.cross(&omega.cross(&d))];
        let once = omega.cross(&e).times(&rate);
        let mut coriolis = omega.cross(&e).times(&(2.0 * rate.0, rate.1.clone()));
        coriolis.term.text = format!("2 {}", once.term.text);
        let slip = format!("ḃ ω × e without its factor 2: {}", once.term.text);
        coriolis.term.slips = vec![(slip, list(&(coriolis.value / 2.0)))];
        let slide = [e.times(&rate_dot), coriolis];
        let step_4 = self.sum(here, Quantity::Acceleration, &before, &with_prismatic(&about_joint, &slide));

        let step_5 = self.sum(here, Quantity::Gravity, &[part(Quantity::Gravity, motion.gravity)], &[]);
        vec![step_1, step_2, step_3, step_4, step_5]
    }

    /// Steps 6 and 7.
    fn inward(&self, here: &Here<'_>) -> Vec<Line> {
        let Here { i, kind, link, e, .. } = here;
        let (i, p) = (*i, *i - 1);
        let own = |quantity| here.part(quantity);
        let (omega, omega_dot, acceleration) =
            (own(Quantity::Omega), own(Quantity::OmegaDot), own(Quantity::Acceleration));
        let gravity = own(Quantity::Gravity);
        let mass = (link.mass, input(format!("m{i}"), &[link.mass], "kg"));
        let tensor = Matrix3::from(link.inertia).transpose();
        let tensor = (tensor, input(format!("I{i}"), &rows(&tensor), "kg m²"));
        // of a link without mass that has a first moment
        let h = Some(V::from(link.first_moment)).filter(|h| *h != V::zeros());
        let h = h.map(|h| Part::new(&format!("h{i}"), h, "kg m"));
        let with = |parts: &[Part], more: &dyn Fn(&Part) -> Vec<Part>| {
            parts.iter().cloned().chain(h.iter().flat_map(more)).collect::<Vec<_>>()
        };

        let parts = with(&[acceleration.times(&mass)], &|h| vec![omega_dot.cross(h), omega.cross(&omega.cross(h))]);
        let force = self.sum(here, Quantity::InertiaForce, &[], &parts);
        let parts = [omega_dot.times(&tensor), omega.cross(&omega.times(&tensor))];
        let parts = with(&parts, &|h| vec![h.cross(&acceleration)]);
        let moment = self.sum(here, Quantity::InertiaMoment, &[], &parts);

        let (next_force, next_moment) = (own(Quantity::NextForce), own(Quantity::NextMoment));
        let handed_on = self.handed_on(here);

        let parts = [own(Quantity::InertiaForce), next_force.clone(), gravity.times(&mass).negative()];
        let joint_force = self.sum(here, Quantity::JointForce, &[], &parts);
        let parts = [
            own(Quantity::InertiaMoment),
            next_moment,
            own(Quantity::D).cross(&own(Quantity::JointForce)),
            own(Quantity::R).cross(&next_force),
        ];
        let joint_moment =
            self.sum(here, Quantity::JointMoment, &[], &with(&parts, &|h| vec![h.cross(&gravity).negative()]));

        let (wrench, letter) = match kind {
            JointKind::Revolute => (Quantity::JointMoment, link.joint_moment),
            JointKind::Prismatic => (Quantity::JointForce, link.joint_force),
        };
        let (wrench, value) = (wrench.symbol(i), V::from(letter));
        let axis = if self.axes == Axes::Base { format!("e{i}") } else { "e".to_owned() };
        let mut terms = vec![scalar(&format!("{axis} · {wrench}"), e.dot(&value))];
        let mut formula = format!("{axis} · {wrench}");
        let unit = Quantity::Tau.unit(*kind);
        let mut inputs = vec![Some(input(wrench, &list(&value), unit))];
        if self.axes == Axes::Base {
            inputs.push(Some(input(format!("e{i}"), &list(e), "1")));
        }
        if let Some(motor) = self.robot.joints[p].motor.filter(|_| self.robot.rotors) {
            let rotor = motor.gear_ratio * motor.gear_ratio * motor.inertia;
            terms.push(scalar(&format!("G{i}² Jm{i} q̈{i}"), rotor * here.q[2]));
            let _ = write!(formula, " + G{i}² Jm{i} q̈{i}");
            let unit = if *kind == JointKind::Revolute { "kg m²" } else { "kg" };
            inputs.push(Some(input(format!("G{i}² Jm{i}"), &[rotor], unit)));
            inputs.push(Some(input(format!("q̈{i}"), &[here.q[2]], Quantity::Qdd.unit(*kind))));
        }
        let inputs = inputs.into_iter().flatten().collect();
        let tau = Line { terms, inputs, ..here.line(Quantity::Tau, vec![link.tau], &formula) };
        [vec![force, moment], handed_on, vec![joint_force, joint_moment, tau]].concat()
    }

    /// The wrench that the next link takes, turned into these axes.
    fn handed_on(&self, here: &Here<'_>) -> Vec<Line> {
        let (i, n) = (here.i, here.i + 1);
        [Quantity::NextForce, Quantity::NextMoment]
            .map(|quantity| {
                let value = &V::from(here.vector(quantity));
                let symbol = quantity.symbol(i);
                let Some(next) = self.links.get(i) else {
                    let what = match (&self.at.wrench, &self.at.payload) {
                        (Some(_), _) => "at the tip, in these axes",
                        (None, Some(_)) => "on the payload",
                        (None, None) => "free tip",
                    };
                    return here.line(quantity, list(value), what);
                };
                let own = V::from(if quantity == Quantity::NextForce { next.joint_force } else { next.joint_moment });
                if self.axes == Axes::Base {
                    return here.line(quantity, list(value), &format!("from joint {n}"));
                }
                let turn = next.rotation_matrix();
                let slips = vec![
                    (format!("R{n}ᵀ is used in place of R{n}"), list(&turn.tr_mul(&own))),
                    (format!("it is not turned by R{n}"), list(&own)),
                ];
                let formula = format!("R{n} {symbol}, from the axes of joint {n}");
                let terms = vec![Term { slips, ..term(&format!("R{n} {symbol}"), value) }];
                let unit = quantity.unit(here.kind);
                let inputs = vec![
                    input(format!("R{n}"), &rows(&turn), "1"),
                    input(format!("{symbol} of joint {n}"), &list(&own), unit),
                ];
                Line { terms, inputs, ..here.line(quantity, list(value), &formula) }
            })
            .to_vec()
    }
}

impl Here<'_> {
    fn line(&self, quantity: Quantity, values: Vec<f64>, formula: &str) -> Line {
        let (joint, kind, formula) = (self.i, self.kind, formula.to_owned());
        Line { joint, kind, quantity, values, formula, terms: Vec::new(), inputs: Vec::new() }
    }

    /// A vector of the link.
    fn vector(&self, quantity: Quantity) -> [f64; 3] {
        let link = self.link;
        match quantity {
            Quantity::D => link.d,
            Quantity::R => link.r,
            Quantity::Omega => link.omega,
            Quantity::OmegaDot => link.omega_dot,
            Quantity::Velocity => link.velocity,
            Quantity::Acceleration => link.acceleration,
            Quantity::Gravity => link.gravity,
            Quantity::InertiaForce => link.inertia_force,
            Quantity::InertiaMoment => link.inertia_moment,
            Quantity::NextForce => link.next_force,
            Quantity::NextMoment => link.next_moment,
            Quantity::JointForce => link.joint_force,
            Quantity::JointMoment => link.joint_moment,
            _ => unreachable!("{quantity} is no vector of the steps"),
        }
    }

    /// A vector of the link as a part of a formula.
    fn part(&self, quantity: Quantity) -> Part {
        Part::new(&quantity.symbol(self.i), self.vector(quantity), quantity.unit(self.kind))
    }
}

/// Rᵀ of a term, or of a sum.
fn turned_back(i: usize, text: &str) -> String {
    if text.contains(' ') { format!("R{i}ᵀ ({text})") } else { format!("R{i}ᵀ {text}") }
}

/// A number in six digits.
fn short(value: f64) -> String {
    let value: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    value.to_string()
}

fn term(text: &str, value: &V) -> Term {
    Term { text: text.to_owned(), values: list(value), slips: Vec::new() }
}

fn scalar(text: &str, value: f64) -> Term {
    Term { text: text.to_owned(), values: vec![value], slips: Vec::new() }
}

fn input(symbol: String, values: &[f64], unit: &'static str) -> Input {
    Input { symbol, values: values.to_vec(), unit }
}

fn list(value: &V) -> Vec<f64> {
    value.iter().copied().collect()
}

fn rows(matrix: &Matrix3<f64>) -> Vec<f64> {
    matrix.transpose().iter().copied().collect()
}

/// Rz of an angle.
#[rustfmt::skip]
pub(super) fn about_z(sin: f64, cos: f64) -> Matrix3<f64> {
    Matrix3::new(
        cos, -sin, 0.0,
        sin, cos,  0.0,
        0.0, 0.0,  1.0,
    )
}
