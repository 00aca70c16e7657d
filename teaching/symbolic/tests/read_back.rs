//! The printed text, read again as a formula and computed: nothing stands between what is read and the runtime.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use rne_model::Robot;
use rne_runtime::DynArm;
use rne_symbolic::{ClosedForm, read};

/// A formula as it is printed: sums of products of letters, powers, sines and parentheses.
struct Formula<'t> {
    rest: &'t str,
    letters: &'t BTreeMap<String, f64>,
}

impl Formula<'_> {
    fn blanks(&mut self) {
        self.rest = self.rest.trim_start();
    }

    fn take(&mut self, text: &str) -> bool {
        let rest = self.rest.strip_prefix(text);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    fn sum(&mut self) -> f64 {
        self.blanks();
        let mut sum = if self.take("-") { -self.product() } else { self.product() };
        loop {
            self.blanks();
            if self.take("+") {
                sum += self.product();
            } else if self.take("-") {
                sum -= self.product();
            } else {
                return sum;
            }
        }
    }

    fn product(&mut self) -> f64 {
        let mut product = 1.0;
        loop {
            self.blanks();
            if self.rest.is_empty() || self.rest.starts_with(['+', '-', ')', ',']) {
                return product;
            }
            product *= self.power();
        }
    }

    fn power(&mut self) -> f64 {
        for (name, function) in [("sin", f64::sin as fn(f64) -> f64), ("cos", f64::cos)] {
            if self.take(name) {
                let exponent = self.exponent();
                self.blanks();
                let argument = if self.take("(") { self.closed() } else { self.multiple() };
                return function(argument).powi(exponent);
            }
        }
        let base = if self.take("(") { self.closed() } else { self.letter() };
        base.powi(self.exponent())
    }

    /// What stands before the closing parenthesis: a sum, or the fraction (1/3).
    fn closed(&mut self) -> f64 {
        let inside = self.rest.split([')', ' ']).next().unwrap_or_default();
        if let Some((p, q)) = inside.split_once('/').filter(|(p, _)| p.parse::<f64>().is_ok()) {
            let fraction = p.parse::<f64>().expect("a numerator") / q.parse::<f64>().expect("a denominator");
            self.rest = &self.rest[inside.len()..];
            assert!(self.take(")"));
            return fraction;
        }
        let sum = self.sum();
        assert!(self.take(")"), "not closed: {}", self.rest);
        sum
    }

    /// θ2 or 2θ2
    fn multiple(&mut self) -> f64 {
        let times = if self.rest.starts_with('θ') { 1.0 } else { self.letter() };
        times * self.letter()
    }

    fn exponent(&mut self) -> i32 {
        let digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
        let sign = if self.take("⁻") { -1 } else { 1 };
        let mut exponent = None;
        while let Some((c, digit)) =
            self.rest.chars().next().and_then(|c| Some((c, digits.chars().position(|d| d == c)?)))
        {
            exponent = Some(10 * exponent.unwrap_or(0) + i32::try_from(digit).expect("a digit"));
            self.rest = &self.rest[c.len_utf8()..];
        }
        sign * exponent.unwrap_or(1)
    }

    /// A number, or the longest letter that is known.
    fn letter(&mut self) -> f64 {
        let digits = self.rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(self.rest.len());
        if digits > 0 {
            let (number, rest) = self.rest.split_at(digits);
            self.rest = rest;
            return number.parse().expect("a number");
        }
        let known = self.letters.iter().filter(|(name, _)| self.rest.starts_with(name.as_str()));
        let (name, value) =
            known.max_by_key(|(name, _)| name.len()).unwrap_or_else(|| panic!("what is {}?", self.rest));
        self.rest = &self.rest[name.len()..];
        *value
    }
}

/// The letters that the text explains: `m1 = 2`, `J3_xx = J3_yy = 2.51 kg m²`, `θ2 = q2 + π/2`.
fn explained(text: &str, robot: &Robot, [q, qd, qdd]: [&[f64]; 3]) -> BTreeMap<String, f64> {
    let mut letters = BTreeMap::new();
    for (joint, ((q, qd), qdd)) in q.iter().zip(qd).zip(qdd).enumerate() {
        let i = joint + 1;
        letters.insert(format!("q{i}"), *q);
        let names = match robot.joints[joint].row.kind {
            rne_model::JointKind::Revolute => ["θ", "θ̇", "θ̈"],
            rne_model::JointKind::Prismatic => ["d", "ḋ", "d̈"],
        };
        for (name, value) in names.into_iter().zip([q, qd, qdd]) {
            letters.insert(format!("{name}{i}"), *value);
        }
    }
    let (_, list) = text.split_once("\nWhere\n").expect("a list of letters");
    for entry in list.lines().filter_map(|line| line.strip_prefix("    ")).flat_map(|line| line.split(", ")) {
        let parts: Vec<&str> = entry.trim_end_matches(',').split(" = ").collect();
        let Some((value, names)) = parts.split_last() else { continue };
        let number = |text: &str| match text.split(' ').next().unwrap_or_default() {
            "π/2" => PI / 2.0,
            "π" => PI,
            "3π/2" => 1.5 * PI,
            text => text.parse().unwrap_or_else(|_| panic!("{entry}")),
        };
        let value = match (value.split_once(" + "), value.split_once(" - ")) {
            (Some((q, constant)), _) => letters[q] + number(constant),
            (_, Some((q, constant))) => letters[q] - number(constant),
            _ => value.strip_prefix('-').map_or_else(|| number(value), |magnitude| -number(magnitude)),
        };
        letters.extend(names.iter().map(|name| ((*name).to_owned(), value)));
    }
    letters
}

#[test]
fn what_a_reader_computes_is_what_the_runtime_does() {
    let mut rng = fastrand::Rng::with_seed(11);
    let (mut compared, mut largest) = (0, 0.0_f64);
    for file in rne_robots::ROBOTS {
        let robot = read(file.name, file.yaml.as_bytes()).expect("it is valid");
        for joints in 1..=robot.dof().min(3) {
            let form = ClosedForm::of(&robot, joints);
            let Some(text) = form.is_closed().then(|| form.text()) else { continue };
            let mut state = || (0..joints).map(|_| 3.0 * rng.f64() - 1.5).collect::<Vec<f64>>();
            let (q, qd, qdd) = (state(), state(), state());
            let letters = explained(&text, &robot, [&q, &qd, &qdd]);
            let value = |text: Option<String>| {
                let text = text.expect("a closed form");
                let mut formula = Formula { rest: &text, letters: &letters };
                let value = formula.sum();
                assert_eq!(formula.rest, "", "{text}");
                value
            };
            let mut first = robot.clone();
            first.joints.truncate(joints);
            let expected = DynArm::from_robot(&first).inverse_dynamics(&q, &qd, &qdd).expect("lengths");
            let scale = expected.iter().fold(1.0_f64, |scale, tau| scale.max(tau.abs()));
            for (i, expected) in expected.iter().enumerate() {
                let mut parts = value(form.gravity(i));
                for j in 0..joints {
                    parts += value(form.mass(i, j)) * qdd[j];
                    parts += (0..joints).map(|k| value(form.christoffel(i, j, k)) * qd[j] * qd[k]).sum::<f64>();
                }
                for found in [value(form.torque(i)), parts] {
                    let off = (found - expected).abs() / scale;
                    assert!(off < 1e-12, "{} up to {joints}: τ{} is {found}, not {expected}\n{text}", file.name, i + 1);
                    largest = largest.max(off);
                }
                compared += 1;
            }
        }
    }
    assert!(compared > 150, "{compared} torques; at most {largest:e} off");
}
