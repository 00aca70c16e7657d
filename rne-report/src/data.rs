//! The data of a page: the inspection, without the parts that the page can derive.

use rne_codegen::Program;
use rne_inspection::{Became, Component, Inspection, Name, Statement};
use rne_model::Robot;
use serde_json::{Map, Value, json};

/// The data of a page.
///
/// `robot`, `counts`, `quantities`, `reasons` and `cells` are those of the inspection of `torques`, which has
/// equations. `names` has arrays of quantity, joint, component (or null), part (where it is one) and what the link
/// carries there (where it is not the first). A component has its name, its equation and, unless it is computed, what
/// became of it, with its reason by number. `programs` are three: `folded`, with the tip wrench as arguments
/// `with_wrench`, and `reduced` with names of its own, for its frames are not those of the lecture.
#[must_use]
pub fn data(robot: &Robot, torques: &Program, with_wrench: &Program, reduced: Option<&Program>) -> Value {
    let folded = Inspection::new(robot, torques);
    let wrench = Inspection::new(robot, with_wrench);
    let mut quantities = folded.quantities.clone();
    quantities.extend(wrench.quantities.clone());
    let mut programs = Map::new();
    programs.insert("folded".to_owned(), program(&folded, true));
    // only its torques are shown
    programs.insert("with_wrench".to_owned(), program(&wrench, false));
    if let Some(reduced) = reduced {
        let inspection = Inspection::new(robot, reduced);
        let mut told = program(&inspection, true);
        told["names"] = names(&inspection);
        told["counts"] = json!(inspection.counts);
        if !inspection.refusals.is_empty() {
            told["form"] = json!(inspection.form);
            told["refusals"] = json!(inspection.refusals);
        }
        quantities.extend(inspection.quantities);
        programs.insert("reduced".to_owned(), told);
    }
    let mut reasons = folded.reasons.clone();
    let table = components(&folded.table, &mut reasons);
    let cells = folded.cells.iter().map(|cell| {
        json!({
            "joint": cell.joint,
            "step": cell.step,
            "title": cell.title,
            "formulas": cell.formulas,
            "before": cell.before,
            "after": cell.after,
            "components": components(&cell.components, &mut reasons),
        })
    });
    let cells = cells.collect::<Vec<_>>();
    json!({
        "schema": "rne-report",
        "version": 1,
        "generator": folded.generator,
        "robot": folded.robot,
        "counts": folded.counts,
        "quantities": quantities,
        "names": names(&folded),
        "reasons": reasons,
        "table": table,
        "cells": cells,
        "programs": programs,
    })
}

/// The meaning of every name.
fn names(inspection: &Inspection) -> Value {
    let record = |name: &Name| match (name.part, name.carries) {
        (None, None) => json!([name.quantity, name.joint, name.component]),
        (Some(part), None) => json!([name.quantity, name.joint, name.component, part]),
        (part, Some(carries)) => json!([name.quantity, name.joint, name.component, part.unwrap_or(0), carries]),
    };
    let all: Map<String, Value> = inspection.names.iter().map(|(text, name)| (text.clone(), record(name))).collect();
    Value::Object(all)
}

/// Components; the reason for which one became a number is an entry of `reasons`, by its number.
fn components(all: &[Component], reasons: &mut Vec<String>) -> Value {
    let mut told = |component: &Component| {
        let mut became = json!(component.became);
        match &component.became {
            // that a number is one of the table goes without saying
            Became::Constant { why, .. } if why == "of the table" => {
                became.as_object_mut().and_then(|became| became.remove("why"));
            }
            Became::Constant { why, .. } => {
                let at = reasons.iter().position(|known| known == why).unwrap_or_else(|| {
                    reasons.push(why.clone());
                    reasons.len() - 1
                });
                became["why"] = json!(at);
            }
            // nor is it told that one is computed
            Became::Computed => return json!({ "name": component.name, "general": component.general }),
            _ => {}
        }
        json!({ "name": component.name, "general": component.general, "became": became })
    };
    all.iter().map(&mut told).collect()
}

/// The code that computes the outputs, with its text where that is shown; else a statement is its name and its value.
fn program(inspection: &Inspection, with_text: bool) -> Value {
    let told = |statement: &Statement| {
        if !with_text {
            return json!([statement.name, statement.value]);
        }
        let mut told = json!({ "name": statement.name, "value": statement.value, "rust": statement.rust });
        if let Some(component) = statement.component.as_ref().filter(|component| **component != statement.name) {
            told["component"] = json!(component);
        }
        told
    };
    json!({
        "arguments": inspection.arguments,
        "constants": inspection.constants,
        "angles": inspection.angles.iter().map(told).collect::<Vec<_>>(),
        "sines_and_cosines": inspection.sines_and_cosines,
        "statements": inspection.statements.iter().map(told).collect::<Vec<_>>(),
        "outputs": inspection.outputs,
    })
}
