//! Writes robots as robot files, in the form in which a person would write them.

use std::fmt::Write as _;

use rne_model::{
    Body, ClosedLoop, Contact, Convention, Coupling, Drive, FixedFrame, FloatingBase, Frame, Inertia, InertiaReference,
    Joint, JointKind, Limits, Link, Motor, Robot, Rotor, Transform, exact_digits,
};

use crate::snap::angle_text;

/// Number of characters after which a long text is folded.
const WIDTH: usize = 110;

/// Writes a robot as a robot file. Reading it gives the same robot, bit for bit, except for parameters that stay free
/// until run time: every number is written as its value.
///
/// Angles are written as `pi/2` and limits as `deg(170)` where that is exactly the same number; any other number has
/// all digits that it needs.
///
/// ```
/// let text = "
/// format: 1
/// name: pendulum
/// source: a lecture
/// convention: standard
/// gravity: [0, -9.81, 0]
/// joints:
///   - {type: revolute, dh: {theta: 1.5707963267948966, d: 0, a: 0.5, alpha: 0}, link: {mass: 2, com: [-0.25, 0, 0]}}
/// ";
/// let robot = rne_model::Robot::from_yaml(text).unwrap();
/// let written = rne_convert::robot_file::write(&robot);
/// assert!(written.contains("    dh: {theta: pi/2, d: 0, a: 0.5, alpha: 0}"));
/// assert_eq!(rne_model::Robot::from_yaml(&written).unwrap(), robot);
/// ```
#[must_use]
pub fn write(robot: &Robot) -> String {
    let mut text = String::new();
    let format = if robot.is_chain() { 1 } else { 2 };
    let _ = writeln!(text, "format: {format}\nname: {}", robot.name);
    if let Some(title) = &robot.title {
        let _ = writeln!(text, "title: {}", scalar(title));
    }
    let _ = writeln!(text, "source: {}", folded(&robot.source));
    if let Some(notes) = &robot.notes {
        let _ = writeln!(text, "notes: {}", block(notes));
    }
    if !robot.parameters.is_empty() {
        let _ = writeln!(text, "parameters:");
        for (name, value) in &robot.parameters {
            let _ = writeln!(text, "  {name}: {}", exact_digits(*value));
        }
    }
    let _ = writeln!(text, "convention: {}", robot.convention.name());
    noted(&mut text, &format!("gravity: {}", list(&robot.gravity)), "m/s²");
    if robot.base != Transform::IDENTITY {
        noted(&mut text, &format!("base: {}", transform(&robot.base)), "m, rad");
    }
    if let Some(base) = &robot.floating_base {
        write_floating_base(&mut text, base);
    }
    write_frames(&mut text, robot);
    for Body { name, .. } in &robot.bodies.list {
        let _ = writeln!(text, "# the body {name} is a part of its link");
    }
    text.push_str("joints:\n");
    for index in 0..robot.joints.len() {
        if index > 0 {
            text.push('\n');
        }
        write_joint(&mut text, robot, index);
    }
    write_couplings(&mut text, robot);
    write_loops(&mut text, robot);
    write_drives(&mut text, robot);
    text
}

fn write_floating_base(text: &mut String, FloatingBase { name, link }: &FloatingBase) {
    let Link { mass, com, inertia: tensor, .. } = link;
    let _ = writeln!(text, "floating_base:\n  name: {name}\n  link:");
    noted(text, &format!("    mass: {}", exact_digits(*mass)), "kg");
    noted(text, &format!("    com: {}", list(com)), "m");
    if *tensor != Inertia::default() {
        noted(text, &format!("    inertia: {}", inertia(tensor)), "kg m²");
    }
    if !link.is_physical(tensor) {
        text.push_str("    physical: false\n");
    }
}

/// Writes the tip frame, the other frames, and which of them are tips or contacts.
fn write_frames(text: &mut String, robot: &Robot) {
    if let (false, Some(on)) = (robot.is_serial(), robot.tip().on) {
        let on = scalar(&robot.joints[on].name);
        noted(text, &format!("tool: {{on: {on}{}}}", place(&robot.tool)), "m, rad");
    } else if robot.tool != Transform::IDENTITY {
        noted(text, &format!("tool: {}", transform(&robot.tool)), "m, rad");
    }
    if !robot.frames.is_empty() {
        noted(text, "frames:", "m, rad");
    }
    for Frame { name, fixed: FixedFrame { on, placement } } in &robot.frames {
        let on = carrier(robot, *on);
        let _ = writeln!(text, "  - {{name: {name}, on: {on}{}}}", place(placement));
    }
    if !robot.tips.is_empty() {
        let _ = writeln!(text, "tips: [{}]", robot.tip_names().join(", "));
    }
    if !robot.contacts.is_empty() {
        let names = robot.tip_names();
        let contact = |it: &Contact| format!("{{tip: {}, kind: {}}}", names[it.tip], it.kind.name());
        let contacts = robot.contacts.iter().map(contact).collect::<Vec<_>>();
        let _ = writeln!(text, "contacts: [{}]", contacts.join(", "));
    }
}

fn write_couplings(text: &mut String, robot: &Robot) {
    if robot.has_couplings() {
        text.push_str("\ncouplings:\n");
    }
    for Joint { name, coupling, .. } in &robot.joints {
        let Some(Coupling { follows, offset }) = coupling else { continue };
        let follows = ratios(robot, follows);
        let offset = if *offset == 0.0 { String::new() } else { format!(", offset: {}", exact_digits(*offset)) };
        let _ = writeln!(text, "  - {{joint: {}, follows: {{{follows}}}{offset}}}", scalar(name));
    }
}

fn write_loops(text: &mut String, robot: &Robot) {
    if !robot.closed.is_empty() {
        text.push_str("\nloops:\n");
    }
    for ClosedLoop { name, cut, between, dependent } in &robot.closed.loops {
        let [one, other] =
            between.map(|FixedFrame { on, placement }| format!("{{on: {}{}}}", carrier(robot, on), place(&placement)));
        let dependent = dependent.iter().map(|&joint| scalar(&robot.joints[joint].name)).collect::<Vec<_>>();
        let _ = writeln!(text, "  - name: {}\n    cut: {}", scalar(name), cut.name());
        noted(text, &format!("    between: [{one}, {other}]"), "m, rad");
        let _ = writeln!(text, "    dependent: [{}]", dependent.join(", "));
    }
}

fn write_drives(text: &mut String, robot: &Robot) {
    if !robot.drives.is_empty() {
        text.push_str("\nmotors:\n");
    }
    for Drive { name, turns, rotor } in &robot.drives {
        let rotor = rotor.map_or_else(String::new, |Rotor { axis, on, inertia }| {
            let on = carrier(robot, on);
            format!(", rotor: {{axis: {}, on: {on}, inertia: {}}}", list(&axis), exact_digits(inertia))
        });
        let _ = writeln!(text, "  - {{name: {}, turns: {{{}}}{rotor}}}", scalar(name), ratios(robot, turns));
    }
}

/// Returns the name of the joint that moves the carrying link; `base` for frame 0.
fn carrier(robot: &Robot, on: Option<usize>) -> String {
    on.map_or_else(|| "base".to_owned(), |joint| scalar(&robot.joints[joint].name))
}

/// Writes the entries of a mapping from joints to ratios.
fn ratios(robot: &Robot, of_joints: &[(usize, f64)]) -> String {
    let ratio =
        |&(joint, ratio): &(usize, f64)| format!("{}: {}", scalar(&robot.joints[joint].name), exact_digits(ratio));
    of_joints.iter().map(ratio).collect::<Vec<_>>().join(", ")
}

/// Writes a line followed by a comment with its units.
fn noted(text: &mut String, line: &str, units: &str) {
    let _ = writeln!(text, "{line}   # {units}");
}

/// Writes a line without its units, because those of the first joint have been written.
fn unnoted(text: &mut String, line: &str, _units: &str) {
    let _ = writeln!(text, "{line}");
}

/// Writes one joint of the list; the first one with units.
fn write_joint(text: &mut String, robot: &Robot, index: usize) {
    let joint = &robot.joints[index];
    let Joint { name, row, limits, motor, .. } = joint;
    let is_revolute = row.kind == JointKind::Revolute;
    let line = if index == 0 { noted } else { unnoted };
    let kind = if is_revolute { "revolute" } else { "prismatic" };
    let _ = writeln!(text, "  - name: {}", scalar(name));
    if robot.parent(index) != index.checked_sub(1) {
        let _ = writeln!(text, "    parent: {}", carrier(robot, robot.parent(index)));
    }
    let _ = writeln!(text, "    type: {kind}");
    let mut beginning = String::new();
    if let Some(FixedFrame { placement, .. }) = joint.branch.filter(|branch| branch.placement != Transform::IDENTITY) {
        let Transform { xyz: [x, y, b], rpy: [roll, pitch, gamma] } = placement;
        if robot.convention == Convention::Modified && [x, y, roll.radians, pitch.radians] == [0.0; 4] {
            beginning = format!("gamma: {}, b: {}, ", angle(gamma.radians), exact_digits(b));
        } else {
            let _ = writeln!(text, "    at: {}", transform(&placement));
        }
    }
    let dh = &row.dh;
    let dh = format!(
        "    dh: {{{beginning}theta: {}, d: {}, a: {}, alpha: {}}}",
        angle(dh.theta.radians),
        exact_digits(dh.d),
        exact_digits(dh.a),
        angle(dh.alpha.radians)
    );
    line(text, &dh, "rad, m");
    write_link(text, joint, line);
    if *limits != Limits::default() {
        let units = if is_revolute { "rad, rad/s, N m" } else { "m, m/s, N" };
        line(text, &format!("    limits: {}", limited(limits, is_revolute)), units);
    }
    if let Some(motor) = motor {
        let _ = writeln!(text, "    motor: {}", motor_text(motor, joint));
    }
}

/// Writes the link of a joint, if it has data.
fn write_link(text: &mut String, joint: &Joint, line: fn(&mut String, &str, &str)) {
    let (written, about) = joint.written_inertia;
    let Link { mass, com, first_moment, .. } = joint.row.link;
    if joint.row.link != Link::default() || written != Inertia::default() || about != InertiaReference::Com {
        text.push_str("    link:\n");
        line(text, &format!("      mass: {}", exact_digits(mass)), "kg");
        if com != [0.0; 3] {
            line(text, &format!("      com: {}", list(&com)), "m");
        }
        if joint.row.link.has_first_moment() {
            line(text, &format!("      first_moment: {}", list(&first_moment)), "kg m");
        }
        if written != Inertia::default() {
            line(text, &format!("      inertia: {}", inertia(&written)), "kg m²");
        }
        if about == InertiaReference::Origin {
            text.push_str("      inertia_about: origin\n");
        }
        if !joint.is_physical() {
            text.push_str("      physical: false\n");
        }
    }
}

/// Writes the keys of a placement that are not zero.
fn place(placement: &Transform) -> String {
    let Transform { xyz, rpy } = placement;
    let mut text = String::new();
    if *xyz != [0.0; 3] {
        let _ = write!(text, ", xyz: {}", list(xyz));
    }
    if *rpy != Transform::IDENTITY.rpy {
        let rpy: Vec<String> = rpy.iter().map(|turn| angle(turn.radians)).collect();
        let _ = write!(text, ", rpy: [{}]", rpy.join(", "));
    }
    text
}

fn transform(placement: &Transform) -> String {
    let rpy: Vec<String> = placement.rpy.iter().map(|turn| angle(turn.radians)).collect();
    format!("{{xyz: {}, rpy: [{}]}}", list(&placement.xyz), rpy.join(", "))
}

/// Writes the elements of a tensor that are not zero, but at least one.
fn inertia(tensor: &Inertia) -> String {
    let Inertia { xx, yy, zz, xy, xz, yz } = *tensor;
    let elements = [("xx", xx), ("yy", yy), ("zz", zz), ("xy", xy), ("xz", xz), ("yz", yz)];
    pairs(elements.iter().filter(|(_, value)| *value != 0.0).map(|(key, value)| (*key, exact_digits(*value))))
}

fn limited(limits: &Limits, is_revolute: bool) -> String {
    let degrees = |value: f64| if is_revolute { in_degrees(value) } else { exact_digits(value) };
    let position = limits.position.map(|(low, high)| ("position", format!("[{}, {}]", degrees(low), degrees(high))));
    let velocity = limits.velocity.map(|velocity| ("velocity", degrees(velocity)));
    let effort = limits.effort.map(|effort| ("effort", exact_digits(effort)));
    pairs([position, velocity, effort].into_iter().flatten())
}

fn motor_text(motor: &Motor, joint: &Joint) -> String {
    let Motor { inertia, gear_ratio, viscous, coulomb } = *motor;
    let given = |key, value: f64, default: f64| (value != default).then(|| (key, exact_digits(value)));
    let coulomb = (coulomb != [0.0; 2]).then(|| ("coulomb", list(&coulomb)));
    let width = joint.coulomb_width.map(|width| ("coulomb_width", exact_digits(width)));
    let displacement = joint.coulomb_displacement.map(|length| ("coulomb_displacement", exact_digits(length)));
    let parts = [
        given("inertia", inertia, 0.0),
        given("gear_ratio", gear_ratio, 1.0),
        given("viscous", viscous, 0.0),
        coulomb,
        width,
        displacement,
    ];
    pairs(parts.into_iter().flatten())
}

fn pairs<'a>(pairs: impl Iterator<Item = (&'a str, String)>) -> String {
    let pairs: Vec<String> = pairs.map(|(key, value)| format!("{key}: {value}")).collect();
    format!("{{{}}}", pairs.join(", "))
}

fn list(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| exact_digits(*value)).collect();
    format!("[{}]", values.join(", "))
}

fn angle(value: f64) -> String {
    angle_text(value).unwrap_or_else(|| exact_digits(value))
}

/// Writes an angle or an angular velocity in whole degrees where that is exactly the same number.
fn in_degrees(value: f64) -> String {
    let degrees = value.to_degrees().round();
    let text = format!("{}deg({})", if value < 0.0 { "-" } else { "" }, degrees.abs());
    if value != 0.0 && degrees.abs() <= 720.0 && rne_model::number(&text) == Ok(value) {
        text
    } else {
        exact_digits(value)
    }
}

/// Returns whether YAML reads a text within a line as the same text without quotation marks.
fn is_plain(text: &str) -> bool {
    let is_word = text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | ' ' | '/' | '.' | '-' | '(' | ')' | '+'));
    let words = ["null", "true", "false", "yes", "no", "on", "off", "nan", "inf"];
    is_word && !text.ends_with(' ') && !words.contains(&text.to_lowercase().as_str())
}

/// Writes a text of one line.
fn scalar(text: &str) -> String {
    if is_plain(text) {
        return text.to_owned();
    }
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            '\r' => quoted.push_str("\\r"),
            '\t' => quoted.push_str("\\t"),
            '\u{85}' | '\u{A0}' | '\u{2028}' | '\u{2029}' | '\u{FEFF}' => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// Writes a text of one line, folded where it is long.
fn folded(text: &str) -> String {
    let is_foldable = text.chars().count() > WIDTH
        && text.split(' ').all(|word| !word.is_empty() && word.chars().all(|c| !c.is_whitespace() && !c.is_control()));
    if !is_foldable {
        return scalar(text);
    }
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let line = lines.last().map_or(0, |line| line.chars().count());
        if line > 0 && line + 1 + word.chars().count() > WIDTH {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    format!(">\n  {}", lines.join("\n  "))
}

/// Writes a text of several lines.
fn block(text: &str) -> String {
    let is_line = |line: &str| {
        !line.is_empty()
            && !line.starts_with(char::is_whitespace)
            && !line.ends_with(char::is_whitespace)
            && !line.chars().any(|c| c.is_control() || matches!(c, '\u{85}' | '\u{2028}' | '\u{2029}' | '\u{FEFF}'))
    };
    let is_list = text.contains('\n') || text.starts_with("- ");
    if !is_list || !text.split('\n').all(is_line) {
        return scalar(text);
    }
    format!("|\n  {}", text.split('\n').collect::<Vec<_>>().join("\n  "))
}
