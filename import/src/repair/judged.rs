//! Judges whether a body is possible and plausible, by itself and beside the other bodies of its robot.

use std::collections::HashMap;

use rne_model::{Inertia, decimal_digits, other_side};

use super::{Body, Numbers};

/// A radius of gyration is too large if it is more than this times the length of the link and of its neighbours.
const WIDE: f64 = 5.0;

/// The length that a radius of gyration is compared with if the joints tell nothing, m.
const UNKNOWN_REACH: f64 = 2.0;

/// Densities of real bodies, kg/m³, where the volume is the cube of the radius of gyration; solid steel has 1e5.
const DENSITIES: [f64; 2] = [1.0, 1e8];

/// A radius of gyration is too small if it is less than this times the length of the link.
const NARROW: f64 = 0.005;

/// Relative difference of the numbers of mirror twins that a CAD program makes.
const ALIKE: f64 = 0.01;

/// Ratio of the numbers of mirror twins from which on one of them is suspect.
const UNLIKE: f64 = 5.0;

/// How unusual a link is whose mass is in one point.
const POINT: f64 = 8.0;

/// The part of the largest moment by which the triangle inequality may be violated.
const ROUNDED: f64 = 1e-3;

/// A test of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Test {
    /// The mass is not below zero.
    Mass,
    /// No principal moment is below zero.
    Moments,
    /// No principal moment is more than the sum of the two others.
    Triangle,
    /// The radius of gyration is not far above the length of the link and of its neighbours.
    Wide,
    /// The radius of gyration is not far below the length of the link.
    Narrow,
    /// Mass and moments are those of the mirror twin.
    Twin,
    /// The tensor is in kg m², as no tensor of the file seems to be.
    Unit,
}

impl Test {
    /// Returns whether a body that fails this test is possible, and only doubtful.
    #[must_use]
    pub fn is_doubt(&self) -> bool {
        !matches!(self, Self::Mass | Self::Moments | Self::Triangle)
    }

    /// Says what is wrong with a body that fails this test.
    #[must_use]
    pub fn sentence(self) -> &'static str {
        match self {
            Self::Mass => "the mass is below zero",
            Self::Moments => "a principal moment of inertia is below zero",
            Self::Triangle => "the largest principal moment is more than the sum of the two others",
            Self::Wide => "the radius of gyration is far larger than the link",
            Self::Narrow => "the radius of gyration is far smaller than the link",
            Self::Twin => "the numbers differ from those of the link of the other side",
            Self::Unit => "the tensors of this file are not in kg m²",
        }
    }
}

/// The tests that a body fails, and how unusual it is beside the others: the logarithm of a probability, without unit.
pub(super) struct Verdict {
    pub(super) failed: Vec<Test>,
    pub(super) distance: f64,
}

impl Verdict {
    /// Returns the number of failed tests, where an impossible body counts more than all doubts.
    pub(super) fn weight(&self) -> usize {
        self.failed.iter().map(|test| if test.is_doubt() { 1 } else { 4 }).sum()
    }
}

/// Mass, principal moments and radius of gyration of a body.
struct Measures {
    mass: f64,
    moments: [f64; 3],
    gyration: f64,
}

/// The bodies of a robot, and what is usual among them.
#[derive(Debug)]
pub(super) struct Robot<'a> {
    pub(super) bodies: &'a [Body],
    twins: Vec<Option<usize>>,
    /// Medians over the possible bodies: the decadic logarithms of mass, of density, and of the radius of gyration over
    /// the length of the link.
    usual: [Option<f64>; 3],
}

impl<'a> Robot<'a> {
    pub(super) fn of(bodies: &'a [Body]) -> Self {
        let places: HashMap<&str, usize> =
            bodies.iter().enumerate().map(|(at, body)| (body.name.as_str(), at)).collect();
        let twin = |body: &Body| other_side(&body.name).iter().find_map(|name| places.get(name.as_str()).copied());
        let mut robot = Self { bodies, twins: vec![None; bodies.len()], usual: [None; 3] };
        // a twin that cannot exist says nothing
        let is_possible = |twin: &usize| {
            let numbers = &bodies[*twin].numbers;
            robot.measures(*twin, numbers).is_some_and(|found| robot.impossible(*twin, numbers, &found).is_none())
        };
        let twins = bodies.iter().map(|body| twin(body).filter(is_possible)).collect();
        robot.twins = twins;
        let plain = (0..bodies.len()).filter(|&body| {
            let numbers = &bodies[body].numbers;
            numbers.mass > 0.0 && robot.verdict(body, numbers).failed.iter().all(|test| *test == Test::Twin)
        });
        let measured: Vec<_> =
            plain.filter_map(|body| Some((body, robot.measures(body, &bodies[body].numbers)?))).collect();
        let logarithms = |of: &dyn Fn(usize, &Measures) -> f64| {
            median(measured.iter().map(|(body, found)| of(*body, found).log10()).filter(|x| x.is_finite()).collect())
        };
        robot.usual = [
            logarithms(&|_, found| found.mass),
            logarithms(&|_, found| found.mass / found.gyration.powi(3)),
            logarithms(&|body, found| found.gyration / robot.length(body)),
        ];
        robot
    }

    /// Returns whether the bodies come from a program and not from a text.
    pub(super) fn has_no_text(&self) -> bool {
        self.bodies.iter().all(|body| body.elements.is_empty())
    }

    /// Returns whether the text has a place for each number of the tensor.
    pub(super) fn can_scale(&self, body: usize) -> bool {
        let Body { numbers, spans, .. } = &self.bodies[body];
        let mut all = numbers.inertia.iter().zip(&spans[1..]);
        self.has_no_text() || all.all(|(number, span)| *number == 0.0 || span.is_some())
    }

    /// Returns the decadic logarithm of the median of the radii of gyration over the lengths of the links.
    pub(super) fn usual_gyration(&self) -> Option<f64> {
        self.usual[2]
    }

    pub(super) fn twin(&self, body: usize) -> Option<usize> {
        self.twins[body]
    }

    /// Returns the tests that a body fails, if it needs a repair: differing from a twin only counts if the numbers are
    /// far apart and this one of the two is the more unusual one.
    pub(super) fn reasons(&self, body: usize) -> Vec<Test> {
        let numbers = &self.bodies[body].numbers;
        if self.bodies[body].is_exempt {
            return Vec::new();
        }
        let Verdict { failed, distance } = self.verdict(body, numbers);
        if failed.iter().any(|test| *test != Test::Twin) {
            return failed;
        }
        let suspect = failed.first().and_then(|_| self.twin(body)).is_some_and(|twin| {
            let other = &self.bodies[twin].numbers;
            let verdict = self.verdict(twin, other);
            let is_sound = verdict.failed.iter().all(|test| *test == Test::Twin);
            self.unlike(body, numbers, twin) > UNLIKE && is_sound && verdict.distance < distance
        });
        if suspect { failed } else { Vec::new() }
    }

    pub(super) fn verdict(&self, body: usize, numbers: &Numbers) -> Verdict {
        let Some(found) = self.measures(body, numbers) else {
            return Verdict { failed: vec![Test::Moments], distance: f64::INFINITY };
        };
        let mut failed: Vec<Test> = (numbers.mass < 0.0).then_some(Test::Mass).into_iter().collect();
        let [_, _, c] = found.moments;
        failed.extend(self.impossible(body, numbers, &found));
        let size = self.bodies[body].size;
        let density = found.mass / found.gyration.powi(3);
        let is_real = !numbers.is_made_up();
        if is_real && found.gyration > WIDE * self.reach(body) && density < DENSITIES[0] {
            failed.push(Test::Wide);
        }
        let is_point = c <= self.noise(body, numbers);
        if is_real && !is_point && found.gyration < NARROW * size && density > DENSITIES[1] {
            failed.push(Test::Narrow);
        }
        let mut distance = self.unusual(body, &found) + shape(&found) + products(numbers) + digits(&numbers.inertia);
        distance += if is_point { POINT } else { 0.0 };
        if let Some(twin) = self.twins[body] {
            let apart = self.unlike(body, numbers, twin);
            if apart > 1.0 + ALIKE {
                failed.push(Test::Twin);
                distance += 3.0 + squared(apart.log10(), 1.0);
            }
        }
        Verdict { failed, distance }
    }

    /// Returns the test that no possible body fails.
    fn impossible(&self, body: usize, numbers: &Numbers, found: &Measures) -> Option<Test> {
        let [a, b, c] = found.moments;
        // a tensor about the origin loses digits on its way to the centre of mass
        let largest = if self.bodies[body].is_about_origin { numbers.tensor().principal_moments()?[2] } else { 0.0 };
        let noise = self.noise(body, numbers).max(ROUNDED * largest);
        if a < -numbers.tensor().rounding().max(noise) {
            return Some(Test::Moments);
        }
        let is_over = c - (a + b) > noise.max(ROUNDED * c) && self.tensor(body, numbers).impossible_moments().is_some();
        is_over.then_some(Test::Triangle)
    }

    /// Returns a moment of inertia, kg m², that is only rounding beside that of a link of this mass.
    fn noise(&self, body: usize, numbers: &Numbers) -> f64 {
        1e-12 * numbers.mass.abs() * self.reach(body).powi(2)
    }

    /// Returns the largest ratio of the masses and of the largest two moments of a body and of its twin.
    fn unlike(&self, body: usize, numbers: &Numbers, twin: usize) -> f64 {
        let (Some(one), Some(other)) = (self.measures(body, numbers), self.measures(twin, &self.bodies[twin].numbers))
        else {
            return f64::INFINITY;
        };
        let [_, b, c] = one.moments;
        let [_, other_b, other_c] = other.moments;
        [(one.mass, other.mass), (b, other_b), (c, other_c)].into_iter().fold(1.0, |most: f64, (x, y)| {
            let ratio = if x == y {
                1.0
            } else if x <= 0.0 || y <= 0.0 {
                f64::INFINITY
            } else {
                (x / y).max(y / x)
            };
            most.max(ratio)
        })
    }

    /// Returns the length of the longest link among a body and its neighbours, m.
    fn reach(&self, body: usize) -> f64 {
        let near = self.bodies[body].neighbours.iter().filter_map(|&near| self.bodies.get(near));
        let reach = near.fold(self.bodies[body].size, |most, near| most.max(near.size));
        if reach > 0.0 { reach } else { UNKNOWN_REACH }
    }

    /// Returns the length of a link, m, which is not far below that of its neighbours: a centre of mass near the origin
    /// says nothing.
    fn length(&self, body: usize) -> f64 {
        self.bodies[body].size.max(0.1 * self.reach(body))
    }

    /// Returns the tensor about the centre of mass.
    fn tensor(&self, body: usize, numbers: &Numbers) -> Inertia {
        let body = &self.bodies[body];
        match body.com.filter(|_| body.is_about_origin) {
            Some(com) => Numbers { inertia: moved(numbers, com, -1.0), ..*numbers }.tensor(),
            None => numbers.tensor(),
        }
    }

    fn measures(&self, body: usize, numbers: &Numbers) -> Option<Measures> {
        let moments = self.tensor(body, numbers).principal_moments()?;
        let mass = numbers.mass.abs();
        let gyration = (moments[2].max(0.0) / mass).sqrt();
        mass.is_finite().then_some(Measures {
            mass,
            moments,
            gyration: if gyration.is_finite() { gyration } else { 0.0 },
        })
    }

    /// Returns how far mass, density and radius of gyration are from those of the other bodies.
    fn unusual(&self, body: usize, found: &Measures) -> f64 {
        let [mass, density, gyration] = self.usual;
        let apart = |value: f64, usual: Option<f64>, width: f64| {
            let usual = usual.filter(|_| value > 0.0 && value.is_finite());
            usual.map_or(0.0, |usual| squared(value.log10() - usual, width))
        };
        apart(found.mass, mass, 0.6)
            + apart(found.mass / found.gyration.powi(3), density, 0.6)
            + apart(found.gyration / self.length(body), gyration, 0.4)
    }
}

/// Moves a tensor from the centre of mass to the origin with sign 1, and back with -1.
pub(super) fn moved(numbers: &Numbers, [x, y, z]: [f64; 3], sign: f64) -> [f64; 6] {
    let m = sign * numbers.mass;
    let [xx, yy, zz, xy, xz, yz] = numbers.inertia;
    let [a, b, c] = [xx + m * (y * y + z * z), yy + m * (x * x + z * z), zz + m * (x * x + y * y)];
    let moved = [a, b, c, xy - m * x * y, xz - m * x * z, yz - m * y * z];
    let scale = moved.iter().chain(&numbers.inertia).fold(0.0, |most: f64, number| most.max(number.abs()));
    // what is left of digits that cancel is nothing
    moved.map(|number| if number.abs() < 1e-12 * scale { 0.0 } else { rounded(number) })
}

/// Returns a number with the digits that a sum keeps.
fn rounded(number: f64) -> f64 {
    format!("{number:.11e}").parse().unwrap_or(number)
}

/// Returns half of the square of a deviation in units of its width, but no more than that of four widths.
fn squared(deviation: f64, width: f64) -> f64 {
    0.5 * (deviation / width).clamp(-4.0, 4.0).powi(2)
}

/// Returns how unusual the ratio of the smallest to the largest moment is.
fn shape(found: &Measures) -> f64 {
    let [a, _, c] = found.moments;
    if c > 0.0 { squared((a.max(0.0) / c).max(1e-6).log10() + 0.4, 0.5) } else { 0.0 }
}

/// Returns how unusual the products are beside the moments.
fn products(numbers: &Numbers) -> f64 {
    let [xx, yy, zz, xy, xz, yz] = numbers.inertia;
    let pairs = [(xy, xx * yy), (xz, xx * zz), (yz, yy * zz)];
    let parts = pairs.into_iter().filter(|(product, moments)| *product != 0.0 && *moments > 0.0);
    parts.map(|(product, moments)| squared((product.abs() / moments.sqrt()).log10() + 1.8, 1.0)).sum()
}

/// Returns how unusual the digits are: files print all elements with the same number of decimals or of digits, and only
/// one number in ten ends with a zero.
fn digits(elements: &[f64; 6]) -> f64 {
    let numbers = elements.iter().filter(|element| **element != 0.0).map(|element| {
        let (digits, last) = decimal_digits(element.abs());
        (i32::try_from(digits.checked_ilog10().unwrap_or(0)).unwrap_or(0), last)
    });
    let numbers: Vec<(i32, i32)> = numbers.collect();
    let most = numbers.iter().map(|(count, _)| *count).max().unwrap_or(0);
    let finest = numbers.iter().map(|(_, last)| *last).min().unwrap_or(0);
    let decimals: i32 = numbers.iter().map(|(_, last)| last - finest).sum();
    let digits: i32 = numbers.iter().map(|(count, _)| most - count).sum();
    (f64::from(decimals.min(digits)) * std::f64::consts::LN_10).min(3.0)
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
