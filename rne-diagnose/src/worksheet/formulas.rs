//! The formulas of a worksheet, written out for one joint: text, terms, and what goes into them.

use std::fmt::Write as _;

use nalgebra::{Matrix3, Vector3};
use rne_model::{Convention, JointKind, Robot, Row};
use rne_runtime::{BaseMotion, LinkTrace};

use super::{Axes, Input, Line, Quantity, Situation, Term, first_lever, orientations};

/// What the lines are made of.
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

/// What a link hands on to the next in the outward steps.
struct Before {
    omega: V,
    omega_dot: V,
    velocity: V,
    acceleration: V,
    gravity: V,
    r: V,
}

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
    before: Before,
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
        let before = match index.checked_sub(1) {
            Some(before) => {
                let link = &self.links[before];
                Before {
                    omega: link.omega.into(),
                    omega_dot: link.omega_dot.into(),
                    velocity: link.velocity.into(),
                    acceleration: link.acceleration.into(),
                    gravity: link.gravity.into(),
                    r: link.r.into(),
                }
            }
            None => Before {
                omega: self.base.omega.into(),
                omega_dot: self.base.omega_dot.into(),
                velocity: self.base.velocity.into(),
                acceleration: self.base.acceleration.into(),
                gravity: self.base.gravity.into(),
                r: first_lever(self.robot).into(),
            },
        };
        let q = [self.at.q[index], self.at.qd[index], self.at.qdd[index]];
        let (kind, row) = (joint.row.kind, &joint.row);
        let e = if self.axes == Axes::Base { turn * V::z() } else { V::z() };
        Here { i: index + 1, kind, row, link, rotation: link.rotation_matrix(), turn, e, q, before }
    }

    /// What goes into the steps.
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

    /// Rᵀ of a vector of the link before: text and term.
    fn carried(&self, here: &Here<'_>, text: &str, value: &V) -> Term {
        let i = here.i;
        if self.axes == Axes::Base {
            return term(text, value);
        }
        let text = if text.contains(' ') { format!("R{i}ᵀ ({text})") } else { format!("R{i}ᵀ {text}") };
        Term {
            slips: vec![
                (format!("R{i} stands where R{i}ᵀ belongs"), list(&(here.rotation * value))),
                (format!("it is not turned by R{i}ᵀ"), list(value)),
            ],
            ..term(&text, &here.rotation.tr_mul(value))
        }
    }

    /// Steps 1 to 5.
    #[allow(clippy::too_many_lines)] // five formulas, one beside the other
    fn outward(&self, here: &Here<'_>) -> Vec<Line> {
        let Here { i, kind, link, e, before, .. } = here;
        let (i, p, [_, qd, qdd]) = (*i, *i - 1, here.q);
        let slides = *kind == JointKind::Prismatic;
        let in_base = self.axes == Axes::Base;
        let axis = if in_base { format!("e{i}") } else { "e".to_owned() };
        let [omega, omega_dot, d] = [link.omega, link.omega_dot, link.d].map(V::from);
        let r = &before.r;
        let carried = |text: &str, value: &V| self.carried(here, text, value);
        // what goes in; R is not needed where all axes are those of the base
        let rotation = || if in_base { None } else { Some(input(format!("R{i}"), &rows(&here.rotation), "1")) };
        let of = |quantity: Quantity, joint: usize, value: &V| {
            Some(input(quantity.symbol(joint), &list(value), quantity.unit(*kind)))
        };
        let rate = || Some(input(format!("q̇{i}"), &[qd], Quantity::Qd.unit(*kind)));
        let rate_dot = || Some(input(format!("q̈{i}"), &[qdd], Quantity::Qdd.unit(*kind)));
        let along = || if in_base { Some(input(format!("e{i}"), &list(e), "1")) } else { None };
        let group = |text: &str| if in_base { text.to_owned() } else { format!("R{i}ᵀ ({text})") };
        let lone = |text: &str| if in_base { text.to_owned() } else { format!("R{i}ᵀ {text}") };

        let mut terms = vec![carried(&format!("ω{p}"), &before.omega)];
        let mut formula = lone(&format!("ω{p}"));
        let mut inputs = vec![rotation(), of(Quantity::Omega, p, &before.omega)];
        if !slides {
            terms.push(term(&format!("q̇{i} {axis}"), &(e * qd)));
            let _ = write!(formula, " + q̇{i} {axis}");
            inputs.extend([rate(), along()]);
        }
        let step_1 = here.sum(Quantity::Omega, &link.omega, formula, terms, inputs);

        let mut terms = vec![carried(&format!("ω̇{p}"), &before.omega_dot)];
        let mut formula = lone(&format!("ω̇{p}"));
        let mut inputs = vec![rotation(), of(Quantity::OmegaDot, p, &before.omega_dot)];
        if !slides {
            terms.push(term(&format!("q̈{i} {axis}"), &(e * qdd)));
            terms.push(term(&format!("q̇{i} ω{i} × {axis}"), &(omega.cross(e) * qd)));
            let _ = write!(formula, " + q̈{i} {axis} + q̇{i} ω{i} × {axis}");
            inputs.extend([rate_dot(), rate(), of(Quantity::Omega, i, &omega), along()]);
        }
        let step_2 = here.sum(Quantity::OmegaDot, &link.omega_dot, formula, terms, inputs);

        let mut terms = vec![
            carried(&format!("ċ{p}"), &before.velocity),
            carried(&format!("ω{p} × r{p}"), &before.omega.cross(r)),
            term(&format!("ω{i} × d{i}"), &omega.cross(&d)),
        ];
        let mut formula = format!("{} + ω{i} × d{i}", group(&format!("ċ{p} + ω{p} × r{p}")));
        let mut inputs = vec![
            rotation(),
            of(Quantity::Velocity, p, &before.velocity),
            of(Quantity::Omega, p, &before.omega),
            of(Quantity::R, p, r),
            of(Quantity::Omega, i, &omega),
            of(Quantity::D, i, &d),
        ];
        if slides {
            terms.push(term(&format!("q̇{i} {axis}"), &(e * qd)));
            let _ = write!(formula, " + q̇{i} {axis}");
            inputs.extend([rate(), along()]);
        }
        let step_3 = here.sum(Quantity::Velocity, &link.velocity, formula, terms, inputs);

        let mut terms = vec![
            carried(&format!("c̈{p}"), &before.acceleration),
            carried(&format!("ω̇{p} × r{p}"), &before.omega_dot.cross(r)),
            carried(&format!("ω{p} × (ω{p} × r{p})"), &before.omega.cross(&before.omega.cross(r))),
            term(&format!("ω̇{i} × d{i}"), &omega_dot.cross(&d)),
            term(&format!("ω{i} × (ω{i} × d{i})"), &omega.cross(&omega.cross(&d))),
        ];
        let mut formula = format!(
            "{} + ω̇{i} × d{i} + ω{i} × (ω{i} × d{i})",
            group(&format!("c̈{p} + ω̇{p} × r{p} + ω{p} × (ω{p} × r{p})"))
        );
        let mut inputs = vec![
            rotation(),
            of(Quantity::Acceleration, p, &before.acceleration),
            of(Quantity::OmegaDot, p, &before.omega_dot),
            of(Quantity::Omega, p, &before.omega),
            of(Quantity::R, p, r),
            of(Quantity::OmegaDot, i, &omega_dot),
            of(Quantity::Omega, i, &omega),
            of(Quantity::D, i, &d),
        ];
        if slides {
            terms.push(term(&format!("q̈{i} {axis}"), &(e * qdd)));
            let coriolis = omega.cross(e) * (2.0 * qd);
            let once = (format!("ḃ ω × e without its factor 2: q̇{i} ω{i} × {axis}"), list(&(coriolis / 2.0)));
            terms.push(Term { slips: vec![once], ..term(&format!("2 q̇{i} ω{i} × {axis}"), &coriolis) });
            let _ = write!(formula, " + q̈{i} {axis} + 2 q̇{i} ω{i} × {axis}");
            inputs.extend([rate_dot(), rate(), along()]);
        }
        let step_4 = here.sum(Quantity::Acceleration, &link.acceleration, formula, terms, inputs);

        let gravity = vec![carried(&format!("g{p}"), &before.gravity)];
        let inputs = vec![rotation(), of(Quantity::Gravity, p, &before.gravity)];
        let step_5 = here.sum(Quantity::Gravity, &link.gravity, lone(&format!("g{p}")), gravity, inputs);
        vec![step_1, step_2, step_3, step_4, step_5]
    }

    /// Steps 6 and 7.
    fn inward(&self, here: &Here<'_>) -> Vec<Line> {
        let Here { i, kind, link, e, .. } = here;
        let (i, p, n) = (*i, *i - 1, *i + 1);
        let inertia = Matrix3::from(link.inertia).transpose();
        let [omega, omega_dot, c_dd, g] = [link.omega, link.omega_dot, link.acceleration, link.gravity].map(V::from);
        let [d, r, f, m] = [link.d, link.r, link.inertia_force, link.inertia_moment].map(V::from);
        let [next_f, next_m, joint_f] = [link.next_force, link.next_moment, link.joint_force].map(V::from);
        let of = |quantity: Quantity, value: &V| Some(input(quantity.symbol(i), &list(value), quantity.unit(*kind)));
        let mass = || Some(input(format!("m{i}"), &[link.mass], "kg"));
        let tensor = || Some(input(format!("I{i}"), &rows(&inertia), "kg m²"));

        // of a link without mass that has a first moment
        let h = V::from(link.first_moment);
        let has_h = h != V::zeros();
        let of_h = || has_h.then(|| input(format!("h{i}"), &list(&h), "kg m"));
        let more = |text: &str| if has_h { format!(" {text}") } else { String::new() };

        let mut force = vec![term(&format!("m{i} c̈{i}"), &(c_dd * link.mass))];
        let mut inputs = vec![mass(), of(Quantity::Acceleration, &c_dd)];
        if has_h {
            force.push(term(&format!("ω̇{i} × h{i}"), &omega_dot.cross(&h)));
            force.push(term(&format!("ω{i} × (ω{i} × h{i})"), &omega.cross(&omega.cross(&h))));
            inputs.extend([of(Quantity::OmegaDot, &omega_dot), of(Quantity::Omega, &omega), of_h()]);
        }
        let formula = format!("m{i} c̈{i}{}", more(&format!("+ ω̇{i} × h{i} + ω{i} × (ω{i} × h{i})")));
        let force = here.sum(Quantity::InertiaForce, &link.inertia_force, formula, force, inputs);

        let mut moment = vec![
            term(&format!("I{i} ω̇{i}"), &(inertia * omega_dot)),
            term(&format!("ω{i} × I{i} ω{i}"), &omega.cross(&(inertia * omega))),
        ];
        let mut inputs = vec![tensor(), of(Quantity::OmegaDot, &omega_dot), of(Quantity::Omega, &omega)];
        if has_h {
            moment.push(term(&format!("h{i} × c̈{i}"), &h.cross(&c_dd)));
            inputs.extend([of_h(), of(Quantity::Acceleration, &c_dd)]);
        }
        let formula = format!("I{i} ω̇{i} + ω{i} × I{i} ω{i}{}", more(&format!("+ h{i} × c̈{i}")));
        let moment = here.sum(Quantity::InertiaMoment, &link.inertia_moment, formula, moment, inputs);

        let handed_on = self.handed_on(here, &next_f, &next_m);

        let terms = vec![
            term(&format!("f{i}"), &f),
            term(&format!("f{i},{n}"), &next_f),
            term(&format!("-m{i} g{i}"), &(g * -link.mass)),
        ];
        let inputs =
            vec![of(Quantity::InertiaForce, &f), of(Quantity::NextForce, &next_f), mass(), of(Quantity::Gravity, &g)];
        let formula = format!("f{i} + f{i},{n} - m{i} g{i}");
        let joint_force = here.sum(Quantity::JointForce, &link.joint_force, formula, terms, inputs);

        let mut terms = vec![
            term(&format!("n{i}"), &m),
            term(&format!("n{i},{n}"), &next_m),
            term(&format!("d{i} × f{p},{i}"), &d.cross(&joint_f)),
            term(&format!("r{i} × f{i},{n}"), &r.cross(&next_f)),
        ];
        let mut inputs = vec![
            of(Quantity::InertiaMoment, &m),
            of(Quantity::NextMoment, &next_m),
            of(Quantity::D, &d),
            of(Quantity::JointForce, &joint_f),
            of(Quantity::R, &r),
            of(Quantity::NextForce, &next_f),
        ];
        if has_h {
            terms.push(term(&format!("-h{i} × g{i}"), &-h.cross(&g)));
            inputs.extend([of_h(), of(Quantity::Gravity, &g)]);
        }
        let weight = more(&format!("- h{i} × g{i}"));
        let formula = format!("n{i} + n{i},{n} + d{i} × f{p},{i} + r{i} × f{i},{n}{weight}");
        let joint_moment = here.sum(Quantity::JointMoment, &link.joint_moment, formula, terms, inputs);

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

    /// What the next link takes, turned into these axes.
    fn handed_on(&self, here: &Here<'_>, force: &V, moment: &V) -> Vec<Line> {
        let (i, n) = (here.i, here.i + 1);
        [(Quantity::NextForce, force), (Quantity::NextMoment, moment)]
            .map(|(quantity, value)| {
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
                    (format!("R{n}ᵀ stands where R{n} belongs"), list(&turn.tr_mul(&own))),
                    (format!("it is not turned by R{n}"), list(&own)),
                ];
                let formula = format!("R{n} {symbol}, from the axes of joint {n}");
                let terms = vec![Term { slips, ..term(&format!("R{n} {symbol}"), value) }];
                let unit = quantity.unit(here.kind);
                let inputs = vec![
                    Some(input(format!("R{n}"), &rows(&turn), "1")),
                    Some(input(format!("{symbol} of joint {n}"), &list(&own), unit)),
                ];
                here.sum(quantity, &(*value).into(), formula, terms, inputs)
            })
            .to_vec()
    }
}

impl Here<'_> {
    fn line(&self, quantity: Quantity, values: Vec<f64>, formula: &str) -> Line {
        let (joint, kind, formula) = (self.i, self.kind, formula.to_owned());
        Line { joint, kind, quantity, values, formula, terms: Vec::new(), inputs: Vec::new() }
    }

    fn sum(
        &self,
        quantity: Quantity,
        values: &[f64; 3],
        formula: String,
        terms: Vec<Term>,
        inputs: Vec<Option<Input>>,
    ) -> Line {
        let inputs = inputs.into_iter().flatten().collect();
        Line { formula, terms, inputs, ..self.line(quantity, values.to_vec(), "") }
    }
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
