//! Reads a whole robot file: which keys it has, what each means, and which values are allowed.

use crate::readers::bodies::bodies;
use crate::readers::contacts::contacts;
use crate::readers::couplings::{self, couplings};
use crate::readers::drives::drives;
use crate::readers::floating_base::{self, name_of_base};
use crate::readers::frames::frames;
use crate::readers::joints::joints;
use crate::readers::loops::loops;
use crate::readers::parameters::parameters;
use crate::readers::placement::{tool, transform};
use crate::readers::texts::{lines, text_of_one_line};
use crate::readers::tips::{first_tip, tips};
use crate::readers::varying::{entry, unknown_names, unknown_settings, without_effect};
use crate::text::decode::{Context, choice, list, read_mapping, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::text::source::quoted;
use crate::{
    Bodies, ClosedLoops, Convention, Entry, Joint, Robot, RunTime, Transform, lints, lints::mirror,
    lints::single_value, readers::tree,
};

/// The kinds of robots that a caller takes in addition to serial arms.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Takes {
    pub(crate) trees: bool,
    pub(crate) couplings: bool,
    pub(crate) loops: bool,
}

/// Reads the root of a robot file.
pub(crate) fn robot(cx: &Context, node: &Node, takes: Takes) -> Option<Robot> {
    // Stops here if the format is another one, because every key may have another meaning there.
    if let Some(version) = node.get("format") {
        format(cx, version)?;
    }
    unknown_names(cx, node);
    unknown_settings(cx, node);
    cx.base_name.replace(name_of_base(node));
    read_mapping!(cx, node, "a robot file", {
        format: required "format" format,
        name: required "name" robot_name,
        title: optional "title" |cx, node| text_of_one_line(cx, node, "title"),
        source: required "source" lines,
        notes: optional "notes" lines,
        parameters: or(Vec::new()) "parameters" parameters,
        convention: required "convention" convention,
        gravity: required "gravity" gravity,
        base: or(Transform::IDENTITY) "base" |cx, node| transform(cx, node, Entry::BaseXyz),
        _floating_base: optional "floating_base" |_, _| Some(()),
        tool: or(Transform::IDENTITY) "tool" tool,
        frames: or(Vec::new()) "frames" |cx, list| frames(cx, list, node),
        joints: required "joints" joints,
        _couplings: optional "couplings" |_, _| Some(()),
        _loops: optional "loops" |_, _| Some(()),
        _motors: optional "motors" |_, _| Some(()),
        _bodies: optional "bodies" |_, _| Some(()),
        _tips: optional "tips" |_, _| Some(()),
        _contacts: optional "contacts" |_, _| Some(()),
    });
    let robot = Robot {
        name,
        title,
        source,
        notes,
        convention,
        gravity,
        base,
        floating_base: None,
        tool,
        tip_on: None,
        parameters,
        joints,
        drives: Vec::new(),
        frames,
        tips: Vec::new(),
        contacts: Vec::new(),
        bodies: Bodies::default(),
        at: None,
        run_time: RunTime::default(),
        closed: ClosedLoops::default(),
        rotors: false,
    };
    with_references(cx, node, (format, takes), robot)
}

/// Adds to the robot all that refers to its joints and frames, and does the checks that need the whole robot.
fn with_references(cx: &Context, node: &Node, (format, takes): (u32, Takes), robot: Robot) -> Option<Robot> {
    let mut robot = robot;
    let (convention, joints) = (robot.convention, &mut robot.joints);
    robot.tip_on = tree::branches(cx, node, (format, convention), joints)?;
    robot.tips = tips(cx, node, format, &robot.frames)?;
    if node.get("tool").is_none()
        && let Some(first) = first_tip(cx, &robot.frames, &robot.tips, joints)
    {
        (robot.tip_on, robot.tool) = first;
    }
    robot.contacts = contacts(cx, node, format, (&robot.frames, &robot.tips))?;
    couplings(cx, node, format, joints)?;
    let (closed, of_loops) = loops(cx, node, (format, convention), joints, takes.loops)?;
    robot.drives = drives(cx, node, format, joints, &closed.passive)?;
    robot.bodies = bodies(cx, node, format, joints)?;
    robot.floating_base = floating_base::floating_base(cx, node, format)?;
    robot.closed = closed;
    if let Some(node) = node.get("gravity") {
        single_value::gravity_upwards(cx, node, robot.gravity, &robot.base);
    }
    single_value::unused_parameters(cx);
    // After an error it may be the wrong part that would use a parameter, so these reports would mislead.
    if !cx.has_errors() {
        without_effect(cx);
        lint_joints(cx, node, convention, &robot.joints, &of_loops);
        refuse_untaken(cx, node, takes, &robot);
    }
    robot.bodies.add_to(&mut robot.joints, robot.floating_base.as_mut());
    // closed loops restrict the joints, but this check assumes that all joints move freely
    if let Some(base) = robot.floating_base.as_ref().filter(|_| !cx.has_errors() && robot.closed.is_empty()) {
        lints::inertia::floating_inertia(cx, node, &base.link, convention, &robot.joints);
    }
    robot.run_time = cx.run_time.take();
    Some(robot)
}

/// Reports warnings that need all joints; the joints `of_loops` are also moved by closed loops.
fn lint_joints(cx: &Context, node: &Node, convention: Convention, joints: &[Joint], of_loops: &[usize]) {
    lints::inertia::inertias(cx, node, convention, joints, of_loops);
    lints::link::links(cx, node, convention, joints);
    lints::arm::nearly_parallel(cx, joints);
    lints::arm::far_normals(cx, node, convention, joints);
    lints::arm::placeholders(cx, node, joints);
    lints::arm::missing_friction(cx, node);
    mirror::twins(cx, node, joints);
    couplings::lint_limits(cx, node, joints);
    // the check adds up the lengths of all rows, which is the reach only of a chain
    if joints.iter().all(|joint| joint.branch.is_none()) {
        lints::arm::light_for_reach(cx, node, joints);
    }
}

/// Refuses a robot of a kind that the caller does not take.
fn refuse_untaken(cx: &Context, node: &Node, takes: Takes, robot: &Robot) {
    if !takes.trees {
        tree::refuse(cx, node, &robot.joints, robot.tip_on);
        floating_base::refuse(cx, node);
    }
    if !takes.couplings {
        couplings::refuse(cx, node, &robot.joints, &robot.drives);
    }
}

fn format(cx: &Context, node: &Node) -> Option<u32> {
    choice(cx, node, "format", &[("1", 1), ("2", 2)])
}

fn robot_name(cx: &Context, node: &Node) -> Option<String> {
    let name = text(cx, node)?;
    let valid = name.starts_with(|c: char| c.is_ascii_lowercase())
        && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
    if valid {
        return Some(name);
    }
    let message = format!(
        "the name {} is not an identifier; it must be a lower-case letter, then lower-case letters, digits and `_`",
        quoted(&name)
    );
    cx.refuse(Diagnostic::error(node.span.clone(), message).help("write a name for people into `title`"))
}

/// Reads the acceleration of gravity in frame 0.
fn gravity(cx: &Context, node: &Node) -> Option<[f64; 3]> {
    let gravity = list(cx, node, "[x, y, z] (m/s²)", |cx, node, axis| entry(Entry::Gravity(axis))(cx, node))?;
    single_value::gravity(cx, node, gravity);
    Some(gravity)
}

fn convention(cx: &Context, node: &Node) -> Option<Convention> {
    choice(cx, node, "convention", &[("standard", Convention::Standard), ("modified", Convention::Modified)])
}
