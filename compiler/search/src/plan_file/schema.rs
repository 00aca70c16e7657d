//! The keys of a plan file, as they are read and as they are written.

use std::collections::BTreeMap;

use rne_codegen::plan::{
    Accuracy, Cost, JointPlan, Moment, OriginShift, Plan, RegroupingTarget, Rewritten, Scale, Side, Switches,
};
use rne_codegen::{Algorithm, Function};
use rne_model::Robot;
use rne_model::document::{Content, Node};

use super::shapes::{Fields, Mistake, array, list, number, parsed, switch, text, whole, word};
use super::yaml::Value;
use super::{FORMAT, Fingerprint, PlanFile, Reduced, fingerprint};

/// Reads a plan file, which must be for the present numbers of `robot`.
pub(super) fn read(root: &Node, robot: &Robot) -> Result<PlanFile, Mistake> {
    belongs_to(root, robot)?;
    let keys = ["format", "robot", "fingerprint", "reduced", "rewritten"];
    let file = Fields::open(root, "a plan file", &keys)?;
    file.required("format", whole::<u32>)?;
    Ok(PlanFile {
        robot: file.required("robot", text)?.to_owned(),
        fingerprint: file.required("fingerprint", parsed::<Fingerprint>)?,
        reduced: file.required("reduced", reduced)?,
        rewritten: file.optional("rewritten", all_rewritten)?,
    })
}

/// Checks format, robot and fingerprint before the rest is read: a plan of another version, or of another robot, may
/// have other keys.
fn belongs_to(root: &Node, robot: &Robot) -> Result<(), Mistake> {
    let refuse = |node: &Node, message: String| Err(Mistake::new(node.span.clone(), message));
    if let Some(node) = root.get("format")
        && whole::<u32>(node)? != FORMAT
    {
        return refuse(node, format!("a plan file of this version of rne has `format: {FORMAT}`"));
    }
    if let Some(node) = root.get("robot")
        && text(node)? != robot.name
    {
        return refuse(node, format!("this plan is for `{}`, not for `{}`", text(node)?.escape_debug(), robot.name));
    }
    if let Some(node) = root.get("fingerprint")
        && parsed::<Fingerprint>(node)? != fingerprint(robot)
    {
        let message = format!(
            "this plan is not for the present robot file of `{}`: numbers of the robot file have changed",
            robot.name
        );
        return refuse(node, message);
    }
    Ok(())
}

fn reduced(node: &Node) -> Result<Reduced, Mistake> {
    let reduced = Fields::open(node, "`reduced`", &["operations", "accuracy", "plan"])?;
    Ok(Reduced {
        operations: reduced.required("operations", cost)?,
        accuracy: reduced.required("accuracy", accuracy)?,
        plan: reduced.required("plan", plan)?,
    })
}

fn all_rewritten(node: &Node) -> Result<BTreeMap<Function, Rewritten>, Mistake> {
    let functions = Function::ALL.map(Function::name);
    Fields::open(node, "`rewritten`", &functions)?;
    let Content::Mapping(entries) = &node.content else { return Ok(BTreeMap::new()) };
    let known = |name: &str| Function::ALL.into_iter().find(|function| function.name() == name);
    let functions = entries.iter().filter_map(|entry| Some((known(&entry.key)?, &entry.value)));
    functions.map(|(function, node)| Ok((function, rewritten(node)?))).collect()
}

fn rewritten(node: &Node) -> Result<Rewritten, Mistake> {
    let keys = ["operations", "accuracy", "algorithm", "plan", "graph"];
    let rewritten = Fields::open(node, "a rewritten function", &keys)?;
    let algorithm = |node: &Node| word(node, "algorithm", &Algorithm::NAMES);
    Ok(Rewritten {
        operations: rewritten.required("operations", cost)?,
        accuracy: rewritten.required("accuracy", accuracy)?,
        algorithm: rewritten.optional("algorithm", algorithm)?,
        plan: rewritten.optional("plan", |node| plan(node).map(Some))?,
        graph: rewritten.required("graph", text)?.to_owned(),
    })
}

fn cost(node: &Node) -> Result<Cost, Mistake> {
    let cost = Fields::open(node, "`operations`", &["mul", "add", "sincos"])?;
    Ok(Cost {
        mul: cost.required("mul", whole)?,
        add: cost.required("add", whole)?,
        sincos: cost.required("sincos", whole)?,
    })
}

fn accuracy(node: &Node) -> Result<Accuracy, Mistake> {
    let accuracy = Fields::open(node, "`accuracy`", &["double", "single", "single_of_seven_steps"])?;
    Ok(Accuracy {
        double: accuracy.required("double", difference)?,
        single: accuracy.required("single", difference)?,
        single_of_seven_steps: accuracy.required("single_of_seven_steps", difference)?,
    })
}

/// Reads a relative error, which must be finite and not negative.
fn difference(node: &Node) -> Result<f64, Mistake> {
    let difference = number(node)?;
    if difference.is_finite() && difference >= 0.0 {
        return Ok(difference);
    }
    Err(Mistake::new(
        node.span.clone(),
        format!("`{difference}` is not an accuracy; an accuracy is a number of 0 or more"),
    ))
}

fn plan(node: &Node) -> Result<Plan, Mistake> {
    let keys =
        ["gyrostat", "turned_last_frame", "carried_prismatics", "length_scale", "force_scale", "base_moment", "joints"];
    let plan = Fields::open(node, "`plan`", &keys)?;
    Ok(Plan {
        regrouped: true,
        gyrostat: plan.optional("gyrostat", switch)?,
        turned_last_frame: plan.optional("turned_last_frame", switch)?,
        carried_prismatics: plan.optional("carried_prismatics", switch)?,
        length_scale: plan.optional("length_scale", parsed)?,
        force_scale: plan.optional("force_scale", parsed)?,
        base_moment: plan.optional("base_moment", moment)?,
        joints: plan.required("joints", |node| list(node, joint))?,
    })
}

fn joint(node: &Node) -> Result<JointPlan, Mistake> {
    let keys =
        ["targets", "origin_shift", "outward_offset", "inward_offset", "moment", "length_scale", "force_scale", "on"];
    let joint = Fields::open(node, "a joint", &keys)?;
    let target = |node: &Node| word(node, "target", &named(&RegroupingTarget::ALL, RegroupingTarget::name));
    let shift = |node: &Node| word(node, "origin shift", &named(&OriginShift::ALL, OriginShift::name));
    let side = |node: &Node| word(node, "side", &named(&Side::ALL, Side::name));
    let inward = |node: &Node| match side(node)? {
        Side::Joint => Err(Mistake::new(node.span.clone(), "`inward_offset` must be `link` or `parent`, not `joint`")),
        side => Ok(side),
    };
    Ok(JointPlan {
        targets: joint.optional("targets", |node| array(node, target))?,
        origin_shift: joint.optional("origin_shift", shift)?,
        outward_offset: joint.optional("outward_offset", side)?,
        inward_offset: joint.optional("inward_offset", inward)?,
        moment: joint.optional("moment", moment)?,
        length_scale: joint.optional("length_scale", parsed)?,
        force_scale: joint.optional("force_scale", parsed)?,
        switches: joint.optional("on", switches)?,
    })
}

fn moment(node: &Node) -> Result<Moment, Mistake> {
    word(node, "moment", &named(&Moment::ALL, Moment::name))
}

fn named<T: Copy>(all: &[T], name: fn(T) -> &'static str) -> Vec<(T, &'static str)> {
    all.iter().map(|&one| (one, name(one))).collect()
}

fn switches(node: &Node) -> Result<Switches, Mistake> {
    let names: Vec<(usize, &str)> = Switches::NAMES.iter().copied().enumerate().collect();
    let mut switches = Switches::default();
    for index in list(node, |node| word(node, "choice of a joint", &names))? {
        if let Some(switch) = switches.at(index) {
            *switch = true;
        }
    }
    Ok(switches)
}

/// Writes a plan file. Choices with default values are left out.
pub(super) fn written(file: &PlanFile) -> Value {
    let PlanFile { robot, fingerprint, reduced, rewritten } = file;
    let functions = rewritten.iter().map(|(function, rewritten)| (function.name(), written_function(rewritten)));
    let reduced = vec![
        ("operations", written_cost(reduced.operations)),
        ("accuracy", written_accuracy(reduced.accuracy)),
        ("plan", written_plan(&reduced.plan)),
    ];
    let mut entries = vec![
        ("format", Value::Plain(FORMAT.to_string())),
        ("robot", Value::Text(robot.clone())),
        ("fingerprint", Value::Text(fingerprint.to_string())),
        ("reduced", Value::Mapping(reduced)),
    ];
    if !rewritten.is_empty() {
        entries.push(("rewritten", Value::Mapping(functions.collect())));
    }
    Value::Mapping(entries)
}

fn written_function(rewritten: &Rewritten) -> Value {
    let Rewritten { operations, accuracy, algorithm, plan, graph } = rewritten;
    let entries = [
        Some(("operations", written_cost(*operations))),
        Some(("accuracy", written_accuracy(*accuracy))),
        chosen("algorithm", algorithm, |algorithm| name(algorithm.name())),
        plan.as_ref().map(|plan| ("plan", written_plan(plan))),
        Some(("graph", Value::Text(graph.clone()))),
    ];
    Value::Mapping(entries.into_iter().flatten().collect())
}

fn written_cost(Cost { mul, add, sincos }: Cost) -> Value {
    let numbers = [("mul", mul), ("add", add), ("sincos", sincos)];
    Value::Mapping(numbers.map(|(key, number)| (key, Value::Plain(number.to_string()))).into())
}

fn written_accuracy(Accuracy { double, single, single_of_seven_steps }: Accuracy) -> Value {
    let numbers = [("double", double), ("single", single), ("single_of_seven_steps", single_of_seven_steps)];
    Value::Mapping(numbers.map(|(key, number)| (key, Value::number(number))).into())
}

fn written_plan(plan: &Plan) -> Value {
    // regrouping is no choice of a plan file
    let Plan { regrouped: _, gyrostat, turned_last_frame, carried_prismatics, .. } = plan;
    let Plan { length_scale, force_scale, base_moment, joints, .. } = plan;
    let switch = |on: &bool| Value::Plain(on.to_string());
    let scale = |scale: &Scale| Value::Text(scale.to_string());
    let entries = [
        chosen("gyrostat", gyrostat, switch),
        chosen("turned_last_frame", turned_last_frame, switch),
        chosen("carried_prismatics", carried_prismatics, switch),
        chosen("length_scale", length_scale, scale),
        chosen("force_scale", force_scale, scale),
        chosen("base_moment", base_moment, |moment| name(moment.name())),
        Some(("joints", Value::List(joints.iter().map(written_joint).collect()))),
    ];
    Value::Mapping(entries.into_iter().flatten().collect())
}

fn written_joint(joint: &JointPlan) -> Value {
    let JointPlan { targets, origin_shift, outward_offset, inward_offset, moment, switches, .. } = joint;
    let JointPlan { length_scale, force_scale, .. } = joint;
    let scale = |scale: &Scale| Value::Text(scale.to_string());
    let on = |switches: &Switches| {
        Value::List(switches.list().into_iter().filter(|(_, on)| *on).map(|(switch, _)| name(switch)).collect())
    };
    let entries = [
        chosen("targets", targets, |targets| Value::List(targets.map(|target| name(target.name())).into())),
        chosen("origin_shift", origin_shift, |shift| name(shift.name())),
        chosen("outward_offset", outward_offset, |side| name(side.name())),
        chosen("inward_offset", inward_offset, |side| name(side.name())),
        chosen("moment", moment, |moment| name(moment.name())),
        chosen("length_scale", length_scale, scale),
        chosen("force_scale", force_scale, scale),
        chosen("on", switches, on),
    ];
    Value::Mapping(entries.into_iter().flatten().collect())
}

/// Returns key and value of a choice; `None`, so that nothing is written, for a choice that is not made.
fn chosen<T: Default + PartialEq>(
    key: &'static str,
    value: &T,
    write: impl FnOnce(&T) -> Value,
) -> Option<(&'static str, Value)> {
    (*value != T::default()).then(|| (key, write(value)))
}

fn name(name: &str) -> Value {
    Value::Text(name.to_owned())
}
