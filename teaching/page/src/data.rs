//! Makes the data of a page: the inspection without the parts that the page can derive.

use rne_codegen::Program;
use rne_inspection::{Became, Component, Inspection, Name, Statement};
use rne_model::{Angle, FixedFrame, Robot};
use serde_json::{Map, Value, json};

/// Returns the data of a page.
///
/// `robot`, `counts`, `quantities`, `reasons` and `cells` are those of the inspection of `torques`, which has
/// equations. `names` has arrays of quantity, joint, component (or null), part (if the name is one) and carried joint
/// (if it is not the first). A component has its name, its equation and, unless it is computed, what it became, with
/// the index of the reason. There are three `programs`: `folded`, `with_wrench`, which has the tip wrench as arguments,
/// and `reduced`, which has its own names, because its frames are not those of the lecture. With a floating base,
/// `folded` itself has the wrenches at the tips as arguments, and `floating` describes the base and these tips.
#[must_use]
pub fn data(robot: &Robot, torques: &Program, with_wrench: Option<&Program>, reduced: Option<&Program>) -> Value {
    let folded = Inspection::new(robot, torques);
    let mut quantities = folded.quantities.clone();
    let mut programs = Map::new();
    programs.insert("folded".to_owned(), program(&folded, true));
    if let Some(with_wrench) = with_wrench {
        let wrench = Inspection::new(robot, with_wrench);
        quantities.extend(wrench.quantities.clone());
        // the page shows only its torques, not its code
        programs.insert("with_wrench".to_owned(), program(&wrench, false));
    }
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
    let mut data = json!({
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
    });
    if let Some(floating) = floating(robot) {
        data["floating"] = floating;
    }
    data
}

/// Returns the floating base and the tips of a robot; `on` is the number of a joint, from 1, or 0 for the base.
fn floating(robot: &Robot) -> Option<Value> {
    let base = robot.floating_base.as_ref()?;
    let tip = |name: &str, FixedFrame { on, placement }: FixedFrame| {
        let rpy = placement.rpy.map(|angle: Angle| angle.radians);
        json!({ "name": name, "on": on.map_or(0, |joint| joint + 1), "xyz": placement.xyz, "rpy": rpy })
    };
    let listed = robot.tips.iter().map(|&at| &robot.frames[at]).map(|frame| tip(&frame.name, frame.fixed));
    let mut tips: Vec<Value> = listed.collect();
    if tips.is_empty() {
        tips.push(tip("tip", robot.tip()));
    }
    let (link, inertia) = (&base.link, base.link.inertia);
    let inertia = [inertia.xx, inertia.yy, inertia.zz];
    Some(json!({ "name": base.name, "mass": link.mass, "com": link.com, "inertia": inertia, "tips": tips }))
}

/// Returns the meaning of every name.
fn names(inspection: &Inspection) -> Value {
    let record = |name: &Name| match (name.part, name.carries) {
        (None, None) => json!([name.quantity, name.joint, name.component]),
        (Some(part), None) => json!([name.quantity, name.joint, name.component, part]),
        (part, Some(carries)) => json!([name.quantity, name.joint, name.component, part.unwrap_or(0), carries]),
    };
    let all: Map<String, Value> = inspection.names.iter().map(|(text, name)| (text.clone(), record(name))).collect();
    Value::Object(all)
}

/// Returns components. The reason for which one became a constant is given by its index in `reasons`.
fn components(all: &[Component], reasons: &mut Vec<String>) -> Value {
    let mut told = |component: &Component| {
        let mut became = json!(component.became);
        match &component.became {
            // constants of the table need no reason
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
            // for a computed component, `became` is left out
            Became::Computed => return json!({ "name": component.name, "general": component.general }),
            _ => {}
        }
        json!({ "name": component.name, "general": component.general, "became": became })
    };
    all.iter().map(&mut told).collect()
}

/// Returns the code of the outputs. If the page shows the code, its statements are objects; otherwise, each is a name
/// and a value. The page writes the text of the statements, which tests compare with the emitted text.
fn program(inspection: &Inspection, is_shown: bool) -> Value {
    let told = |statement: &Statement| {
        if !is_shown {
            return json!([statement.name, statement.value]);
        }
        let mut told = json!({ "name": statement.name, "value": statement.value });
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
