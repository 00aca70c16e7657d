//! Tries mistakes within one line: a missing term, a wrong sign, exchanged axes, degrees.

use std::f64::consts::PI;

use super::{Line, Term};

/// A mistake within a line: its description, and the resulting components; `None` for components that it does not
/// concern.
pub(super) struct Way {
    pub(super) says: String,
    pub(super) values: Vec<Option<f64>>,
}

/// Returns all mistakes, first those that explain a whole line. `component` is the one that differs.
pub(super) fn ways(line: &Line, component: usize) -> Vec<Way> {
    let own = line.values[component];
    let mut ways = of_all_components(line);
    ways.extend(of_one_component(line, component).into_iter().map(|(says, value)| {
        let mut values = vec![None; line.values.len()];
        values[component] = Some(value);
        Way { says, values }
    }));
    // a mistake that does not change the component does not explain it
    ways.retain(|way| way.values[component].is_some_and(|value| (value - own).abs() > 1e-12 * own.abs()));
    ways
}

/// Returns the terms of a line, if several of them are not zero.
fn several(line: &Line) -> impl Iterator<Item = &Term> {
    let are_several = line.terms.iter().filter(|term| super::norm(&term.values) > 0.0).count() > 1;
    line.terms.iter().filter(move |_| are_several)
}

fn of_all_components(line: &Line) -> Vec<Way> {
    let ours = &line.values;
    let mut ways = Vec::new();
    let mut whole =
        |says: String, values: Vec<f64>| ways.push(Way { says, values: values.into_iter().map(Some).collect() });
    let with = |change: &[f64], times: f64| ours.iter().zip(change).map(|(x, y)| x + times * y).collect::<Vec<_>>();
    for term in line.terms.iter().filter(|_| line.terms.len() > 1) {
        whole(format!("the term {} is left out", term.text), with(&term.values, -1.0));
    }
    for term in several(line) {
        whole(format!("the term {} has the other sign", term.text), with(&term.values, -2.0));
    }
    for term in &line.terms {
        for (says, values) in &term.slips {
            let change: Vec<f64> = values.iter().zip(&term.values).map(|(slip, right)| slip - right).collect();
            whole(says.clone(), with(&change, 1.0));
        }
    }
    for term in several(line) {
        whole(format!("the term {} is counted twice", term.text), with(&term.values, 1.0));
    }
    if ours.len() > 1 {
        whole("all signs are reversed".to_owned(), ours.iter().map(|x| -x).collect());
    }
    if let [x, y, z] = ours[..] {
        for (order, values) in [("y, x, z", [y, x, z]), ("x, z, y", [x, z, y]), ("z, y, x", [z, y, x])] {
            whole(format!("two components are exchanged: {order}"), values.to_vec());
        }
        for (order, values) in [("y, z, x", [y, z, x]), ("z, x, y", [z, x, y])] {
            whole(format!("the components are in the order {order}"), values.to_vec());
        }
    }
    if ours.len() == 9 {
        let transposed = [0, 3, 6, 1, 4, 7, 2, 5, 8].map(|index| ours[index]);
        whole("the matrix is transposed".to_owned(), transposed.to_vec());
    }
    if line.quantity.is_angular(line.kind) {
        whole("it is in degrees".to_owned(), ours.iter().map(|x| x * 180.0 / PI).collect());
        whole(
            "it was converted from degrees to radians twice".to_owned(),
            ours.iter().map(|x| x * PI / 180.0).collect(),
        );
    }
    ways
}

fn of_one_component(line: &Line, component: usize) -> Vec<(String, f64)> {
    let (ours, own) = (&line.values, line.values[component]);
    let names = line.quantity.components();
    let mut ways = vec![("the sign is reversed".to_owned(), -own)];
    for (other, value) in ours.iter().enumerate().filter(|(other, value)| *other != component && **value != 0.0) {
        ways.push((format!("this is component {}", names[other]), *value));
        ways.push((format!("this is component {} with the other sign", names[other]), -*value));
    }
    for (says, factor) in
        [("ten times as large", 10.0), ("a hundred times as large", 100.0), ("a thousand times as large", 1e3)]
    {
        ways.push((format!("it is {says}: check the unit and the decimal point"), own * factor));
        let small = says.replace("as large", "smaller");
        ways.push((format!("it is {small}: check the unit and the decimal point"), own / factor));
    }
    ways.push(("it is twice as large".to_owned(), 2.0 * own));
    ways.push(("it is half as large".to_owned(), 0.5 * own));
    for term in several(line) {
        let value = term.values[component];
        ways.push((format!("in this component the term {} is left out", term.text), own - value));
        ways.push((format!("in this component the term {} has the other sign", term.text), own - 2.0 * value));
    }
    ways
}
