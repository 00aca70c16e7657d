//! Writes the elements of a URDF as text.

use std::fmt::Write as _;

use rne_model::{exact_digits, one_line};

use super::friction::Friction;
use crate::body::Body;
use crate::chain::ChainJoint;
use crate::geometry::{Pose, rounded};

/// The names of joints that are used already.
#[derive(Default)]
pub(super) struct Names(Vec<String>);

impl Names {
    /// Returns the name of a joint as an attribute value; a name that is used already gets a stroke (') at its end.
    pub(super) fn unique(&mut self, name: &str) -> String {
        let mut name = one_line(name);
        while matches!(name.as_str(), "world_to_base" | "to_tip") || self.0.contains(&name) {
            name.push('\'');
        }
        self.0.push(name.clone());
        quick_xml::escape::escape(name.as_str()).into_owned()
    }
}

/// Returns a text for an XML comment, which must not contain `--`.
pub(super) fn comment(text: &str) -> String {
    let mut text = one_line(text);
    while text.contains("--") {
        text = text.replace("--", "- -");
    }
    let end = if text.ends_with('-') { " " } else { "" };
    text + end
}

fn vector(values: [f64; 3]) -> String {
    values.map(exact_digits).join(" ")
}

fn origin(pose: Pose) -> String {
    let size = pose.translation.to_f64().into_iter().map(f64::abs).fold(1.0, f64::max);
    format!("<origin xyz=\"{}\" rpy=\"{}\"/>", vector(pose.translation.rounded(size)), vector(pose.rotation.to_rpy()))
}

pub(super) fn fixed(text: &mut String, name: &str, (parent, child): (&str, &str), pose: Pose) {
    let _ = writeln!(
        text,
        "  <joint name=\"{name}\" type=\"fixed\">\n    <parent link=\"{parent}\"/>\n    <child link=\"{child}\"/>\n    \
         {}\n  </joint>",
        origin(pose)
    );
}

pub(super) fn movable(text: &mut String, name: &str, joint: &ChainJoint, (parent, child): (&str, &str), mimic: &str) {
    let limits = joint.limits;
    let kind = match (joint.is_prismatic, limits.position) {
        (true, _) => "prismatic",
        (false, Some(_)) => "revolute",
        (false, None) => "continuous",
    };
    let (lower, upper) = limits.position.unwrap_or(if joint.is_prismatic { (-1e9, 1e9) } else { (0.0, 0.0) });
    let position = if kind == "continuous" {
        String::new()
    } else {
        format!("lower=\"{}\" upper=\"{}\" ", exact_digits(lower), exact_digits(upper))
    };
    let dynamics = joint.motor.as_ref().and_then(Friction::of).map_or_else(String::new, |at_joint| {
        let [damping, friction] = [at_joint.damping, at_joint.friction].map(exact_digits);
        format!("    <dynamics damping=\"{damping}\" friction=\"{friction}\"/>\n")
    });
    let _ = writeln!(
        text,
        "  <joint name=\"{name}\" type=\"{kind}\">\n    <parent link=\"{parent}\"/>\n    \
         <child link=\"{child}\"/>\n    {}\n    <axis xyz=\"0 0 1\"/>\n    \
         <limit {position}effort=\"{}\" velocity=\"{}\"/>\n{dynamics}{mimic}  </joint>",
        origin(joint.place),
        exact_digits(limits.effort.unwrap_or(0.0)),
        exact_digits(limits.velocity.unwrap_or(0.0))
    );
}

pub(super) fn link(text: &mut String, name: &str, body: &Body) {
    let link = body.to_link();
    let i = link.inertia;
    let _ = writeln!(
        text,
        "  <link name=\"{name}\">\n    <inertial>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n      \
         <mass value=\"{}\"/>\n      <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" \
         iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/>\n    </inertial>\n  </link>",
        vector(link.com),
        exact_digits(rounded(body.mass, 1.0)),
        exact_digits(i.xx),
        exact_digits(i.xy),
        exact_digits(i.xz),
        exact_digits(i.yy),
        exact_digits(i.yz),
        exact_digits(i.zz)
    );
}
