//! Explains the letters of a closed form: constants by their values, and angles by the joint variables.

use std::collections::BTreeSet;

use rne_model::JointKind;

use crate::document::{Composer, Item, Section, words};
use crate::notation::{Notation, Script};
use crate::symbol::{Angle, Constant, Symbol};
use crate::table::Table;

/// Returns the section on the meaning of the letters.
pub(crate) fn letters(composer: &Composer<'_>, table: &Table, used: &BTreeSet<Symbol>) -> Option<Section> {
    let notation = &composer.notation;
    let constants: Vec<usize> = used
        .iter()
        .filter_map(|symbol| if let Symbol::Constant(index) = symbol { Some(*index) } else { None })
        .collect();
    let mut items = Vec::new();
    let mut list = |title: &str, list: Vec<(String, String)>| {
        if !list.is_empty() {
            items.push(Item::Words(words(title)));
            items.push(Item::List(list));
        }
    };
    list("Parameters of the file:", values(notation, table, &constants, true));
    list("Numbers of the table:", values(notation, table, &constants, false));
    let meanings = meanings(table, &constants).into_iter();
    items.extend(meanings.map(|meaning| Item::Words(words(&format!("{meaning}.")))));
    let slides: Vec<usize> = (0..table.rows.len()).filter(|i| table.rows[*i].kind == JointKind::Prismatic).collect();
    if !slides.is_empty() {
        let names: Vec<String> = slides.iter().map(|joint| notation.variable(*joint, 0)).collect();
        let text = ["Where θ stands for all joint variables, that of a sliding joint is d: ", "."];
        let [before, after] = text.map(|text| script_words(notation, text));
        items.push(Item::Words(vec![before, names.join(", "), after]));
    }
    let variables = [angles(notation, table, used), lengths(notation, table, used)].concat();
    if !variables.is_empty() {
        items.push(Item::Words(words("Angles and lengths of the table, by the joint variables q:")));
        items.push(Item::List(variables));
    }
    (!items.is_empty()).then(|| Section { title: words("Where"), items })
}

/// Returns the constants that are parameters of the file, or all others, with their values and units.
fn values(notation: &Notation<'_>, table: &Table, constants: &[usize], is_parameter: bool) -> Vec<(String, String)> {
    let all = constants.iter().filter_map(|index| Some((*index, table.constants.0.get(*index)?)));
    let value = |(index, constant): (usize, &Constant)| {
        let also = constant.also.iter().map(|name| notation.named(name));
        let names: Vec<String> = std::iter::once(notation.constant(index)).chain(also).collect();
        (format!("{} = {}", names.join(" = "), number(constant.value)), constant.unit.to_owned())
    };
    all.filter(|(_, constant)| constant.is_parameter == is_parameter).map(value).collect()
}

/// Returns the meanings of the letters with indices, such as m1, that occur.
fn meanings(table: &Table, constants: &[usize]) -> Vec<&'static str> {
    let constants = constants.iter().map(|index| &table.constants.0[*index]);
    let names: Vec<&str> =
        constants.filter(|constant| !constant.is_parameter).map(|constant| constant.name.as_str()).collect();
    let has = |start: char, inside: &str| names.iter().any(|name| name.starts_with(start) && name.contains(inside));
    let all = [
        (
            ['x', 'y', 'z'].iter().any(|axis| has(*axis, "_C")),
            "x_C, y_C, z_C: centre of mass, in the link frame of the table",
        ),
        (
            table.rows.iter().any(|row| !row.first_moment.is_zero()) && has('m', "mc"),
            "mcx, mcy, mcz: first moment of a link without mass, in the link frame of the table",
        ),
        (has('I', "_"), "I: inertia about the centre of mass, in link axes"),
        (has('J', "_"), "J: inertia about the origin of the link frame, in link axes"),
    ];
    all.into_iter().filter(|(is_used, _)| *is_used).map(|(_, meaning)| meaning).collect()
}

/// Returns the angles of the table that occur, with their units: those of joints by their variable q, the others by
/// their values.
fn angles(notation: &Notation<'_>, table: &Table, used: &BTreeSet<Symbol>) -> Vec<(String, String)> {
    let mut angles = Vec::new();
    for (angle, turn) in &table.angles {
        if !used.contains(&Symbol::Sine(*angle)) && !used.contains(&Symbol::Cosine(*angle)) {
            continue;
        }
        let (name, constant) = (notation.angle(*angle), self::angle(turn));
        match angle {
            Angle::Joint(joint) if turn.radians != 0.0 => {
                let q = notation.indexed("q", &(joint + 1).to_string());
                let constant =
                    if constant.starts_with('-') { constant.replacen('-', "- ", 1) } else { format!("+ {constant}") };
                let unit = if turn.right.is_some() { "" } else { "rad" };
                angles.push((format!("{name} = {q} {}", with_pi(notation, &constant)), unit.to_owned()));
            }
            Angle::Twist(_) | Angle::Turn(_) => {
                angles.push((format!("{name} = {}", with_pi(notation, &constant)), "rad".to_owned()));
            }
            Angle::Joint(_) => {}
        }
    }
    angles
}

/// Returns the offsets d of prismatic joints that occur, by their variable q, with their unit.
fn lengths(notation: &Notation<'_>, table: &Table, used: &BTreeSet<Symbol>) -> Vec<(String, String)> {
    let slides = table.rows.iter().enumerate().filter(|(joint, row)| {
        row.kind == JointKind::Prismatic && !row.d_constant.is_zero() && used.contains(&Symbol::Position(*joint))
    });
    let length = |(joint, _): (usize, _)| {
        let q = notation.indexed("q", &(joint + 1).to_string());
        let constant = table.offsets.get(joint).copied().unwrap_or(0.0);
        let sign = if constant < 0.0 { '-' } else { '+' };
        let text = format!("{} = {q} {sign} {}", notation.variable(joint, 0), number(constant.abs()));
        (text, "m".to_owned())
    };
    slides.map(length).collect()
}

/// Formats a number of the file.
fn number(value: f64) -> String {
    format!("{value}")
}

/// Replaces Greek letters in words for LaTeX, which has them only in mathematics.
fn script_words(notation: &Notation<'_>, text: &str) -> String {
    if notation.script == Script::Latex { text.replace('θ', "theta") } else { text.to_owned() }
}

fn with_pi(notation: &Notation<'_>, text: &str) -> String {
    if notation.script == Script::Latex { text.replace('π', r"\pi") } else { text.to_owned() }
}

/// Formats a constant angle; multiples of a right angle as multiples of π.
fn angle(turn: &rne_model::Angle) -> String {
    let quarters = (turn.radians / std::f64::consts::FRAC_PI_2).round();
    if turn.right.is_none() || quarters.abs() > 4.0 || quarters == 0.0 {
        return number(turn.radians);
    }
    let sign = if quarters < 0.0 { "-" } else { "" };
    let magnitude = match quarters.abs() {
        1.0 => "π/2",
        2.0 => "π",
        3.0 => "3π/2",
        _ => "2π",
    };
    format!("{sign}{magnitude}")
}
