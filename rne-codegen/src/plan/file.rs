//! Plan files: the choices for one robot, replayed by every build.

use std::fmt::Write;

use rne_model::{Convention, DataFile, JointKind, Report, Robot, Value};

use crate::ir::Cost;
use crate::plan::{JointPlan, Plan, Side, Switches};
use crate::program::Proof;

/// A plan file.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanFile {
    /// The robot's name.
    pub robot: String,
    /// Fingerprint of the robot's numbers.
    pub fingerprint: u64,
    /// The choices.
    pub plan: Plan,
    /// A graph that has been rewritten, with the plan of the graph that it was made from.
    pub rewritten: Option<Rewritten>,
}

/// A rewritten graph.
#[derive(Clone, Debug, PartialEq)]
pub struct Rewritten {
    /// The plan that gives the graph its numbers.
    pub plan: Plan,
    /// One operation per line.
    pub graph: String,
}

/// What a plan file says of itself, for people.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remark {
    /// Operations of `inverse_dynamics`.
    pub cost: Cost,
    /// Why it is right, and how precise.
    pub proof: Proof,
}

/// The format of plan files.
const FORMAT: &str = "1";

/// A fingerprint of all numbers of a robot that its torques depend on.
#[must_use]
pub fn fingerprint(robot: &Robot) -> u64 {
    let mut numbers: Vec<f64> = vec![match robot.convention {
        Convention::Standard => 1.0,
        Convention::Modified => 2.0,
    }];
    numbers.extend(robot.gravity);
    numbers.extend(robot.tool.xyz);
    numbers.extend(robot.tool.rpy.map(|angle| angle.radians));
    for joint in &robot.joints {
        let (row, (inertia, _)) = (&joint.row, &joint.written_inertia);
        numbers.push(if row.kind == JointKind::Revolute { 1.0 } else { 2.0 });
        numbers.extend([row.dh.theta.radians, row.dh.d, row.dh.a, row.dh.alpha.radians, row.link.mass]);
        numbers.extend(row.link.com);
        numbers.extend(inertia.rows().into_iter().flatten());
        numbers.extend(row.link.inertia.rows().into_iter().flatten());
    }
    // FNV-1a; -0 is 0
    let bytes = numbers.iter().flat_map(|x| (x + 0.0).to_bits().to_le_bytes());
    bytes.fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3))
}

impl PlanFile {
    /// Reads a plan file and checks that it belongs to `robot`; `name` is what messages call it.
    ///
    /// # Errors
    /// What is wrong with it, with line and column.
    pub fn read(name: &str, text: &str, robot: &Robot) -> Result<Self, Report> {
        let file = DataFile::read(name, text)?;
        let root = file.root();
        known_keys(&root, &["format", "robot", "fingerprint", "reduced", "rewritten"])?;
        let format = required(&root, "format")?;
        if format.text() != Some(FORMAT) {
            return Err(refreshable(&format, "a plan file of this version of rne has `format: 1`"));
        }
        let fingerprint_value = required(&root, "fingerprint")?;
        let written = fingerprint_value.text().and_then(|text| u64::from_str_radix(text, 16).ok());
        if written != Some(fingerprint(robot)) {
            return Err(refreshable(
                &fingerprint_value,
                &format!(
                    "this plan is not of `{}` as it is now: the numbers of its robot file have changed",
                    robot.name
                ),
            ));
        }
        let reduced = required(&root, "reduced")?;
        known_keys(&reduced, &["operations", "accuracy", "plan"])?;
        let rewritten = match root.get("rewritten") {
            None => None,
            Some(value) => {
                known_keys(&value, &["operations", "accuracy", "plan", "graph"])?;
                let graph = required(&value, "graph")?;
                let text =
                    graph.text().ok_or_else(|| graph.error("a graph is a text, one operation per line", None))?;
                Some(Rewritten { plan: plan(&required(&value, "plan")?, robot)?, graph: text.to_owned() })
            }
        };
        Ok(Self {
            robot: robot.name.clone(),
            fingerprint: fingerprint(robot),
            plan: plan(&required(&reduced, "plan")?, robot)?,
            rewritten,
        })
    }

    /// The text of the file.
    #[must_use]
    pub fn to_yaml(&self, reduced: &Remark, rewritten: Option<&Remark>) -> String {
        let mut text = format!(
            "# Choices of the reduced form of {0}, found by `rne search`, replayed by every build. Names only, no numbers:\n\
             # what they mean, `rne show {0}.yaml --form reduced` and docs/reduced-form.md say.\n\
             format: {FORMAT}\n\
             robot: {0}\n\
             fingerprint: {1:016x}   # of the numbers of the robot file\n",
            self.robot, self.fingerprint
        );
        text.push_str("reduced:\n");
        remark(&mut text, reduced);
        write_plan(&mut text, &self.plan);
        if let (Some(Rewritten { plan, graph }), Some(remarks)) = (&self.rewritten, rewritten) {
            text.push_str("rewritten:\n");
            remark(&mut text, remarks);
            write_plan(&mut text, plan);
            text.push_str("  graph: |\n");
            for line in graph.lines() {
                let _ = writeln!(text, "    {line}");
            }
        }
        text
    }
}

fn remark(text: &mut String, Remark { cost, proof }: &Remark) {
    let _ = writeln!(text, "  operations: {{mul: {}, add: {}, sincos: {}}}", cost.mul, cost.add, cost.sincos);
    let _ = writeln!(
        text,
        "  # largest difference from the seven steps, in parts of the largest torque: double precision; single precision,\n  \
         # and that of the seven steps themselves in single precision"
    );
    let _ = writeln!(
        text,
        "  accuracy: {{double: {:.1e}, single: {:.1e}, single_of_seven_steps: {:.1e}}}",
        proof.rounding, proof.single, proof.single_of_seven_steps
    );
}

fn write_plan(text: &mut String, plan: &Plan) {
    text.push_str("  plan:\n");
    for (name, on) in [
        ("gyrostat", plan.gyrostat),
        ("turned_last_frame", plan.turned_last_frame),
        ("carried_prismatics", plan.carried_prismatics),
    ] {
        if on {
            let _ = writeln!(text, "    {name}: true");
        }
    }
    let plain = Plan::new(plan.joints.len());
    if plan.length_scale != plain.length_scale {
        let _ = writeln!(text, "    length_scale: {}", plan.length_scale);
    }
    if plan.force_scale != plain.force_scale {
        let _ = writeln!(text, "    force_scale: {}", plan.force_scale);
    }
    text.push_str("    joints:\n");
    for joint in &plan.joints {
        let plain = JointPlan::default();
        let mut parts = Vec::new();
        if joint.gauge != plain.gauge {
            let [first, second, third] = joint.gauge;
            parts.push(format!("gauge: [{first}, {second}, {third}]"));
        }
        if joint.slide != plain.slide {
            parts.push(format!("slide: {}", joint.slide));
        }
        if joint.outward_offset != plain.outward_offset {
            parts.push(format!("outward_offset: {}", joint.outward_offset));
        }
        if joint.inward_offset != plain.inward_offset {
            parts.push(format!("inward_offset: {}", joint.inward_offset));
        }
        if joint.moment != plain.moment {
            parts.push(format!("moment: {}", joint.moment));
        }
        let on: Vec<&str> = joint.switches.list().iter().filter(|(_, on)| *on).map(|(name, _)| *name).collect();
        if !on.is_empty() {
            parts.push(format!("on: [{}]", on.join(", ")));
        }
        let _ = writeln!(text, "      - {{{}}}", parts.join(", "));
    }
}

fn plan(value: &Value<'_>, robot: &Robot) -> Result<Plan, Report> {
    let mut plan = Plan::new(robot.dof());
    for (key, value) in value.entries() {
        match key {
            "gyrostat" => plan.gyrostat = boolean(&value)?,
            "turned_last_frame" => plan.turned_last_frame = boolean(&value)?,
            "carried_prismatics" => plan.carried_prismatics = boolean(&value)?,
            "length_scale" => plan.length_scale = parsed(&value)?,
            "force_scale" => plan.force_scale = parsed(&value)?,
            "joints" => {
                let items = value.items().ok_or_else(|| value.error("the joints of a plan are a list", None))?;
                if items.len() != robot.dof() {
                    let count = items.len();
                    return Err(refreshable(
                        &value,
                        &format!("this plan has {count} joints, `{}` has {}", robot.name, robot.dof()),
                    ));
                }
                for (joint, item) in plan.joints.iter_mut().zip(items) {
                    *joint = joint_plan(&item)?;
                }
            }
            _ => return Err(value.error(format!("`{key}` is no choice of a plan"), Some(REFRESH.to_owned()))),
        }
    }
    Ok(plan)
}

fn joint_plan(value: &Value<'_>) -> Result<JointPlan, Report> {
    let mut joint = JointPlan::default();
    for (key, value) in value.entries() {
        match key {
            "gauge" => {
                let items: Vec<Value<'_>> = value.items().map(Iterator::collect).unwrap_or_default();
                let [first, second, third] = items[..] else {
                    return Err(value.error("a gauge is a list of three targets", None));
                };
                joint.gauge = [parsed(&first)?, parsed(&second)?, parsed(&third)?];
            }
            "slide" => joint.slide = parsed(&value)?,
            "outward_offset" => joint.outward_offset = parsed(&value)?,
            "inward_offset" => {
                joint.inward_offset = parsed(&value)?;
                if joint.inward_offset == Side::Joint {
                    return Err(value.error("on the way back an offset acts in `link` or `parent`", None));
                }
            }
            "moment" => joint.moment = parsed(&value)?,
            "on" => {
                let items = value.items().ok_or_else(|| value.error("`on` is a list of choices", None))?;
                for item in items {
                    let name = item.text().unwrap_or_default();
                    if !joint.switches.set(name, true) {
                        let names: Vec<_> = Switches::NAMES.iter().map(|name| format!("`{name}`")).collect();
                        return Err(item.error(
                            format!("`{name}` is no choice of a joint"),
                            Some(format!("there are {}", names.join(", "))),
                        ));
                    }
                }
            }
            _ => return Err(value.error(format!("`{key}` is no choice of a joint"), Some(REFRESH.to_owned()))),
        }
    }
    Ok(joint)
}

fn required<'a>(value: &Value<'a>, key: &str) -> Result<Value<'a>, Report> {
    value.get(key).ok_or_else(|| value.error(format!("`{key}` is missing in this plan file"), Some(REFRESH.to_owned())))
}

fn known_keys(value: &Value<'_>, known: &[&str]) -> Result<(), Report> {
    match value.entries().find(|(key, _)| !known.contains(key)) {
        None => Ok(()),
        Some((key, at)) => Err(at.error(format!("`{key}` is no key of a plan file"), Some(REFRESH.to_owned()))),
    }
}

fn boolean(value: &Value<'_>) -> Result<bool, Report> {
    match value.text() {
        Some("true") => Ok(true),
        Some("false") => Ok(false),
        _ => Err(value.error("this is `true` or `false`", None)),
    }
}

fn parsed<T: std::str::FromStr<Err = String>>(value: &Value<'_>) -> Result<T, Report> {
    value.text().unwrap_or_default().parse().map_err(|message: String| value.error(message, None))
}

const REFRESH: &str =
    "`rne search ROBOT.yaml --fresh` writes the plan anew; without the file, a build chooses by itself";

fn refreshable(value: &Value<'_>, message: &str) -> Report {
    value.error(message, Some(REFRESH.to_owned()))
}
