//! `rne new`: writes a robot file to fill in.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use rne_model::Convention;

use crate::files::file_name::{self, Format};
use crate::files::output_file::{Existing, existing, is_standard_output, replace, unreadable};
use crate::outcome::{Failure, Outcome};
use crate::palette::TYPED;
use crate::values::choice::{convention, robot_name};

/// Write a commented robot file with placeholders, for your arm
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne new elbow --dof 6                      writes elbow.yaml
  rne new scara --dof 4 --prismatic 3 -o -   to the terminal; joint 3 prismatic
  rne new wrist --dof 3 --convention modified

The file is valid: each link is a slender rod of 0.3 m and 2 kg. Replace these
numbers by the numbers of your arm.")]
pub(crate) struct Arguments {
    /// The robot's name: small letters, digits and underscores
    #[arg(value_name = "NAME", value_parser = robot_name)]
    name: String,
    /// Number of joints, 1 to 64
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=64))]
    dof: u8,
    /// Numbers of the prismatic joints, such as 3; joint 1 is at the base
    #[arg(long, value_name = "I,…", value_delimiter = ',')]
    prismatic: Vec<u8>,
    /// Denavit-Hartenberg convention of the table of joints
    #[arg(long, value_parser = convention(), default_value = "standard")]
    convention: Convention,
    /// Robot file to write [default: NAME.yaml]; - is standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if let Some(joint) = arguments.prismatic.iter().find(|&&joint| joint == 0 || joint > arguments.dof) {
        return Err(usage_error!(
            "there is no joint {joint}; joints have the numbers 1 (at the base) to {}",
            arguments.dof
        ));
    }
    let text = text(&arguments.name, arguments.dof, &arguments.prismatic, arguments.convention);
    let path = match &arguments.output {
        Some(path) if is_standard_output(path) => return Ok(Outcome::text(text)),
        Some(path) => path.clone(),
        None => PathBuf::from(format!("{}.yaml", arguments.name)),
    };
    let shown = path.display();
    match existing(&path) {
        Existing::Nothing => {}
        Existing::Unreadable(error) => return Err(unreadable(&path, &error)),
        Existing::Folder | Existing::Special | Existing::Text(_) | Existing::Other => {
            return Err(usage_error!(
                "{shown} exists and is not changed; name another file with {TYPED}-o FILE{TYPED:#}"
            ));
        }
    }
    file_name::check(&path, Format::RobotFile)?;
    replace(&path, &text)?;
    Ok(Outcome::remark(format!(
        "{shown} is written; put your numbers in it, then\n\n  {TYPED}rne check {shown}{TYPED:#}\n  {TYPED}rne show \
         {shown}{TYPED:#}\n"
    )))
}

/// Writes the robot file. Its links are slender rods of 2 kg; the first joint is vertical, the others move in a
/// vertical plane.
fn text(name: &str, dof: u8, prismatic: &[u8], convention: Convention) -> String {
    let (word, rows, place) = match convention {
        Convention::Standard => (
            "standard",
            "Rz(theta) Tz(d) Tx(a) Rx(alpha): link frame i at the far end of link i",
            "at the far end of the link",
        ),
        Convention::Modified => (
            "modified",
            "Rx(alpha) Tx(a) Rz(theta) Tz(d): link frame i on joint i, alpha and a of the link before",
            "on the link's own joint",
        ),
    };
    let mut text = format!(
        "# A robot file with placeholders: put your numbers in their place. m, rad, kg.\n\
         # A number may be an expression: pi/2, deg(90), mm(77), 0.4318/2, m*a^2/12.\n\
         format: 1\n\
         name: {name}\n\
         title: {name}\n\
         source: placeholders of rne new   # where the numbers come from: a datasheet, a URDF, a paper\n\
         convention: {word}              # {rows}\n\
         gravity: [0, 0, -9.81]            # acceleration of gravity in frame 0, m/s²: it points down\n\
         base: {{xyz: [0, 0, 0], rpy: [0, 0, 0]}}   # world -> frame 0\n\
         tool: {{xyz: [0, 0, 0], rpy: [0, 0, 0]}}   # frame {dof} -> tip\n\
         joints:                           # base to tip\n"
    );
    for joint in 1..=dof {
        text += &row(joint, prismatic.contains(&joint), convention, place);
    }
    text
}

/// Writes the row of a joint. Only the row of the first joint has comments; `place` says where its link frame is.
fn row(joint: u8, slides: bool, convention: Convention, place: &str) -> String {
    let kind = if slides { "prismatic" } else { "revolute" };
    let moving = if slides { "d" } else { "theta" };
    // joint 1 has a vertical axis, the others have horizontal axes
    let (d, a, alpha) = match (convention, joint) {
        (Convention::Modified, 1) => ("0.3", "0", "0"),
        (Convention::Standard, 1) => ("0.3", "0", "pi/2"),
        (Convention::Modified, 2) => ("0", "0", "pi/2"),
        _ => ("0", "0.3", "0"),
    };
    let (com, inertia) = match (convention, joint) {
        (Convention::Standard, 1) => ("[0, -0.15, 0]", "xx: 0.015, yy: 0.002, zz: 0.015"),
        (Convention::Modified, 1) => ("[0, 0, -0.15]", "xx: 0.015, yy: 0.015, zz: 0.002"),
        (Convention::Standard, _) => ("[-0.15, 0, 0]", "xx: 0.002, yy: 0.015, zz: 0.015"),
        (Convention::Modified, _) => ("[0.15, 0, 0]", "xx: 0.002, yy: 0.015, zz: 0.015"),
    };
    let note = if joint == 1 { format!("   # {moving}: the constant part, q is added to it") } else { String::new() };
    let mut text = format!(
        "  - name: joint{joint}\n    type: {kind}\n    dh: {{theta: 0, d: {d}, a: {a}, alpha: {alpha}}}{note}\n"
    );
    let (mass_note, com_note, inertia_note) = match joint {
        1 => (
            "                   # kg".to_owned(),
            format!("       # from the origin of the link frame ({place}), its axes, m"),
            "  # about com, link axes, kg m²; xy = -∫ x y dm".to_owned(),
        ),
        _ => Default::default(),
    };
    let _ = write!(
        text,
        "    link:\n      mass: 2{mass_note}\n      com: {com}{com_note}\n      inertia: {{{inertia}, xy: 0, \
         xz: 0, yz: 0}}{inertia_note}\n"
    );
    text
}

#[cfg(test)]
mod tests {
    use rne_model::{JointKind, Reader};

    use super::*;

    #[test]
    fn every_new_file_is_in_order() {
        for convention in [Convention::Standard, Convention::Modified] {
            for dof in [1, 2, 6, 7, 64] {
                let text = text("my_arm", dof, &[2], convention);
                let checked = Reader::new("my_arm.yaml").read(&text).unwrap_or_else(|report| panic!("{report}"));
                assert!(checked.lints.is_empty(), "{}", checked.lints.render(false));
                assert_eq!((checked.robot.dof(), checked.robot.convention), (usize::from(dof), convention));
                for (index, joint) in checked.robot.joints.iter().enumerate() {
                    let kind = if index == 1 { JointKind::Prismatic } else { JointKind::Revolute };
                    assert_eq!(joint.row.kind, kind);
                    // the rod reaches from one joint to the next, so its centre is half its length away
                    assert_eq!(joint.row.link.com.iter().map(|c| c.abs()).sum::<f64>(), 0.15);
                }
            }
        }
    }
}
