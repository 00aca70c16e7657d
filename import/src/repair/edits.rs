//! The table of single edits: each is a mistake that people make with the numbers of a body, and takes it back.

use rne_model::decimal_digits;

use super::judged::{Robot, Test, moved};
use super::{Body, Numbers, Order};

/// A row of the table.
#[derive(Debug)]
pub struct Edit {
    /// A short name.
    pub name: &'static str,
    /// The mistake, in words.
    pub mistake: &'static str,
    /// How rare one way of the mistake is: minus the logarithm of its probability. A decimal point can be wrong in
    /// eighteen ways, so each of them is rare.
    pub(super) cost: f64,
    /// Takes the mistake back in all ways in which it can have been made.
    pub(super) tries: fn(&Robot, usize) -> Vec<Change>,
}

/// One way to take a mistake back.
#[derive(Debug)]
pub(super) struct Change {
    pub(super) what: String,
    pub(super) numbers: Numbers,
    pub(super) lost: Option<usize>,
    /// Another body that changes too.
    pub(super) other: Option<(usize, Numbers)>,
    pub(super) cost: f64,
}

/// All single edits.
pub(super) static EDITS: [Edit; 12] = [
    Edit { name: "decimal point", mistake: "a number is wrong by a power of ten", cost: 3.0, tries: one_power },
    Edit { name: "sign", mistake: "a number has the wrong sign", cost: 1.8, tries: one_sign },
    Edit { name: "mass", mistake: "the mass is wrong by a power of ten", cost: 3.0, tries: power_of_mass },
    Edit { name: "unit", mistake: "the tensor is in another unit", cost: 3.0, tries: power_of_all },
    Edit { name: "signs of products", mistake: "all products have the other sign", cost: 0.7, tries: all_products },
    Edit { name: "signs", mistake: "all moments have the wrong sign", cost: 0.7, tries: all_moments },
    Edit { name: "order", mistake: "the numbers are in another order", cost: 0.7, tries: orders },
    Edit { name: "row-major order", mistake: "the numbers are the rows of the matrix", cost: 0.7, tries: rows },
    Edit { name: "reference", mistake: "the tensor is about the wrong point", cost: 1.0, tries: references },
    Edit {
        name: "revolution",
        mistake: "a moment across the axis is not that of the other axis",
        cost: 3.5,
        tries: revolved,
    },
    Edit { name: "exchange", mistake: "two links have each other's tensors", cost: 3.5, tries: exchanged },
    Edit { name: "twin", mistake: "the numbers are not those of the other side", cost: 6.0, tries: of_twin },
];

/// The names of the elements of a tensor.
pub(super) const ELEMENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "xz", "yz"];

impl Change {
    fn new(what: impl Into<String>, mass: f64, inertia: [f64; 6]) -> Self {
        Self { what: what.into(), numbers: Numbers { mass, inertia }, lost: None, other: None, cost: 0.0 }
    }
}

/// The units of programs, as powers of ten of kg m².
pub(super) const UNITS: [(i32, &str); 4] = [(-4, "kg cm²"), (-6, "kg mm²"), (-7, "g cm²"), (-9, "g mm²")];

/// Moves the decimal point of a number, without the rounding of a product.
pub(super) fn shifted(number: f64, power: i32) -> f64 {
    let digits = format!("{number:e}");
    let moved = digits.split_once('e').and_then(|(digits, exponent)| {
        let exponent: i32 = exponent.parse().ok()?;
        format!("{digits}e{}", exponent + power).parse().ok()
    });
    moved.unwrap_or(number)
}

/// The powers of ten that a decimal point may be wrong by.
fn powers() -> impl Iterator<Item = i32> {
    (1..=9).flat_map(|power| [-power, power])
}

/// Says how a number becomes right.
fn times(what: &str, power: i32) -> String {
    let (verb, of) = if power < 0 { ("large", -power) } else { ("small", power) };
    format!("{what} is too {verb} by the factor 1e{of}")
}

/// Changes one element of the tensor at a time.
fn each(robot: &Robot, body: usize, change: impl Fn(f64, &str) -> Vec<(String, f64)>) -> Vec<Change> {
    let Numbers { mass, inertia } = robot.bodies[body].numbers;
    let mut changes = Vec::new();
    for (at, name) in ELEMENTS.iter().enumerate().filter(|(at, _)| inertia[*at] != 0.0) {
        for (what, number) in change(inertia[at], name) {
            let mut inertia = inertia;
            inertia[at] = number;
            changes.push(Change::new(what, mass, inertia));
        }
    }
    changes
}

fn one_power(robot: &Robot, body: usize) -> Vec<Change> {
    each(robot, body, |number, name| powers().map(|power| (times(name, power), shifted(number, power))).collect())
}

fn one_sign(robot: &Robot, body: usize) -> Vec<Change> {
    let mut changes = each(robot, body, |number, name| vec![(format!("{name} has the wrong sign"), -number)]);
    let Numbers { mass, inertia } = robot.bodies[body].numbers;
    changes.push(Change::new("the mass has the wrong sign", -mass, inertia));
    changes
}

fn power_of_mass(robot: &Robot, body: usize) -> Vec<Change> {
    let Numbers { mass, inertia } = robot.bodies[body].numbers;
    powers().map(|power| Change::new(times("the mass", power), shifted(mass, power), inertia)).collect()
}

fn power_of_all(robot: &Robot, body: usize) -> Vec<Change> {
    let Numbers { mass, inertia } = robot.bodies[body].numbers;
    let change = |power: i32| {
        let unit = UNITS.iter().find(|(of, _)| *of == power).map(|(_, unit)| format!("the tensor is in {unit}"));
        let cost = if unit.is_some() { 0.0 } else { 1.5 };
        let what = unit.unwrap_or_else(|| times("the whole tensor", power));
        Change { cost, ..Change::new(what, mass, inertia.map(|number| shifted(number, power))) }
    };
    powers().map(change).collect()
}

fn all_products(robot: &Robot, body: usize) -> Vec<Change> {
    let Numbers { mass, inertia: [xx, yy, zz, xy, xz, yz] } = robot.bodies[body].numbers;
    let what = "all products have the other sign, as some CAD programs write them";
    vec![Change::new(what, mass, [xx, yy, zz, -xy, -xz, -yz])]
}

fn all_moments(robot: &Robot, body: usize) -> Vec<Change> {
    let Numbers { mass, inertia } = robot.bodies[body].numbers;
    let [xx, yy, zz, xy, xz, yz] = inertia;
    vec![
        Change::new("all moments have the wrong sign", mass, [-xx, -yy, -zz, xy, xz, yz]),
        Change { cost: 1.5, ..Change::new("the whole tensor has the wrong sign", mass, inertia.map(|number| -number)) },
    ]
}

/// Returns the tensor whose elements are at these places in the file.
fn reordered(inertia: [f64; 6], from: [usize; 6]) -> [f64; 6] {
    from.map(|at| inertia[at])
}

fn orders(robot: &Robot, body: usize) -> Vec<Change> {
    let Body { numbers: Numbers { mass, inertia }, order, .. } = &robot.bodies[body];
    let moments_first = "the numbers are in MuJoCo's order xx yy zz xy xz yz, not in that of URDF";
    let upper_triangle = "the numbers are in URDF's order xx xy xz yy yz zz, not in that of MuJoCo";
    // the order of another format is in this file much more often than the reverse
    let rare = |here: Order| if *order == here { 0.0 } else { 3.0 };
    let change =
        |what: &str, from, here| Change { cost: rare(here), ..Change::new(what, *mass, reordered(*inertia, from)) };
    vec![
        change(moments_first, [0, 3, 4, 1, 5, 2], Order::UpperTriangle),
        change(upper_triangle, [0, 3, 5, 1, 2, 4], Order::MomentsFirst),
    ]
}

/// Takes back that six of the nine numbers of the matrix, row by row, were taken for the upper triangle, or the
/// reverse. One moment is lost then.
fn rows(robot: &Robot, body: usize) -> Vec<Change> {
    let Body { numbers: Numbers { mass, inertia }, order, .. } = &robot.bodies[body];
    let rows = "the numbers are the first six of the matrix, row by row: xx xy xz yx yy yz";
    let triangle = "the numbers are those of the upper triangle, read as if they were rows of the matrix";
    // the places in the file of the elements, the lost element, and two places that must have the same number
    let (from, same) = match order {
        Order::UpperTriangle => ([0, 5, 5, 3, 4, 2], Some([1, 3])),
        Order::MomentsFirst => ([0, 4, 4, 1, 2, 5], Some([1, 3])),
    };
    let cases = [(rows, from, 2, same), (triangle, [0, 5, 5, 3, 4, 1], 1, None)];
    let change = |(what, from, lost, same): (&str, [usize; 6], usize, Option<[usize; 2]>)| {
        let mut found = reordered(*inertia, from);
        found[lost] = 0.0;
        let sum = found[0] + found[1] + found[2];
        // the lost moment as that of the twin, or some part of the sum of the two others: only judging needs it
        let twin = robot.twin(body).map(|twin| robot.bodies[twin].numbers.inertia[..3].iter().sum::<f64>() - sum);
        let guesses = twin.into_iter().chain([0.7, 0.5, 0.9, 0.3, 0.99].map(|part| part * sum));
        let guess = guesses.filter(|guess| *guess > 0.0).find(|guess| {
            found[lost] = *guess;
            robot.verdict(body, &Numbers { mass: *mass, inertia: found }).failed.iter().all(Test::is_doubt)
        })?;
        found[lost] = guess;
        let name = ELEMENTS[lost];
        let what = format!("{what}; the file does not have the moment {name}, so find it where the numbers are from");
        let cost = match same {
            Some([one, _]) if inertia[one] != 0.0 => 0.0,
            Some(_) => 1.0,
            None => 4.0,
        };
        let fits = same.is_none_or(|[one, other]| inertia[one] == inertia[other]);
        fits.then(|| Change { lost: Some(lost), cost, ..Change::new(what, *mass, found) })
    };
    cases.into_iter().filter_map(change).collect()
}

fn references(robot: &Robot, body: usize) -> Vec<Change> {
    let Body { numbers, com, .. } = &robot.bodies[body];
    let Some(com) = com.filter(|com| *com != [0.0; 3] && numbers.mass > 0.0) else { return Vec::new() };
    // a sum has more digits than its parts, so a tensor that was moved by mistake does not have fewer than the true one
    let most = |inertia: &[f64; 6]| inertia.iter().map(|number| decimal_digits(number.abs()).0.checked_ilog10()).max();
    let change = |what: &str, sign: f64| {
        let new = moved(numbers, com, sign);
        let cost = if most(&new) > most(&numbers.inertia) { 4.0 } else { 0.0 };
        Change { cost, ..Change::new(what, numbers.mass, new) }
    };
    vec![
        change("the tensor is about the origin of the link", -1.0),
        change("the tensor was moved to the centre of mass twice", 1.0),
    ]
}

/// Makes the two moments across an axis equal where the centre of mass is on this axis, as in a body of revolution.
fn revolved(robot: &Robot, body: usize) -> Vec<Change> {
    let Body { numbers: Numbers { mass, inertia }, com, .. } = &robot.bodies[body];
    let Some(com) = com else { return Vec::new() };
    let mut changes = Vec::new();
    for axis in 0..3 {
        let across = [(axis + 1) % 3, (axis + 2) % 3];
        if across.iter().any(|at| com[*at] != 0.0) {
            continue;
        }
        for (wrong, right) in [(across[0], across[1]), (across[1], across[0])] {
            let mut new = *inertia;
            new[wrong] = inertia[right];
            let [wrong, right] = [wrong, right].map(|at| ELEMENTS[at]);
            let what = format!("{wrong} should be {right}, because the link looks like a body of revolution");
            changes.push(Change::new(what, *mass, new));
        }
    }
    changes
}

fn exchanged(robot: &Robot, body: usize) -> Vec<Change> {
    /// Number of bodies above which this takes too long.
    const MOST: usize = 256;
    if robot.bodies.len() > MOST {
        return Vec::new();
    }
    let own = robot.bodies[body].numbers;
    let is_other = |other: usize| other != body && Some(other) != robot.twin(body);
    let others = robot.bodies.iter().enumerate().filter(|(other, _)| is_other(*other));
    let change = |(index, other): (usize, &Body)| {
        let what = format!("this link and `{}` have each other's tensors", other.name);
        let theirs = Numbers { inertia: own.inertia, ..other.numbers };
        let change = Change::new(what, own.mass, other.numbers.inertia);
        // of invented tensors, nobody can tell whose they are
        let is_real = other.numbers.inertia != own.inertia && !own.is_made_up() && !other.numbers.is_made_up();
        is_real.then_some(Change { other: Some((index, theirs)), ..change })
    };
    others.filter_map(change).collect()
}

fn of_twin(robot: &Robot, body: usize) -> Vec<Change> {
    let Some(twin) = robot.twin(body).map(|twin| &robot.bodies[twin]) else { return Vec::new() };
    let Numbers { mass, inertia: [xx, yy, zz, xy, xz, yz] } = twin.numbers;
    let what = format!("these are not the numbers of `{}`, mirrored at the plane y = 0", twin.name);
    vec![Change::new(what, mass, [xx, yy, zz, -xy, xz, -yz])]
}
