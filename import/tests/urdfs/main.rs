//! Small URDFs by hand: closed forms, and every pitfall that real files have.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;

use rne_convert::{Imported, Options, Selection, Urdf, robot_file};
use rne_model::{Convention, Inertia, JointKind, Reader, Robot};
use rne_runtime::{BaseMotion, DynArm, DynFloatingTorques, Wrench};

mod bodies;
mod chain;
mod followers;
mod frames;
mod geometry;
mod transmissions;
mod trees;
mod whole;

pub(crate) const GRAVITY: f64 = 9.81;
pub(crate) const BOTH: [Convention; 2] = [Convention::Standard, Convention::Modified];

/// A link with mass, its centre and the diagonal of its tensor.
pub(crate) fn link(name: &str, mass: f64, xyz: &str, [xx, yy, zz]: [f64; 3]) -> String {
    format!(
        "<link name=\"{name}\"><inertial><origin xyz=\"{xyz}\"/><mass value=\"{mass}\"/>\
         <inertia ixx=\"{xx}\" ixy=\"0\" ixz=\"0\" iyy=\"{yy}\" iyz=\"0\" izz=\"{zz}\"/></inertial></link>\n"
    )
}

/// A joint with its origin and what else stands in it.
pub(crate) fn joint(name: &str, kind: &str, (parent, child): (&str, &str), origin: &str, rest: &str) -> String {
    format!(
        "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
         <origin {origin}/>{rest}</joint>\n"
    )
}

pub(crate) fn robot(parts: &[String]) -> String {
    format!("<robot name=\"arm\">\n{}</robot>\n", parts.concat())
}

/// Links without mass.
pub(crate) fn bare(names: &[&str]) -> String {
    names.iter().fold(String::new(), |mut text, name| {
        let _ = writeln!(text, "<link name=\"{name}\"/>");
        text
    })
}

pub(crate) fn converted(text: &str, options: &Options) -> Imported {
    let imported = Urdf::read("arm.urdf", text).and_then(|urdf| urdf.import(options)).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(Reader::new("written").read(&imported.text).unwrap().robot, imported.robot, "reading gives the robot");
    imported
}

pub(crate) fn import(text: &str, options: &Options) -> Imported {
    let imported = converted(text, options);
    assert!(imported.account.rounding.torque < 1e-12, "{:?}", imported.account.rounding);
    imported
}

pub(crate) fn plain(text: &str) -> Imported {
    import(text, &Options::default())
}

/// The message of an import that is refused, with its remedy as `Debug` shows it.
pub(crate) fn refused(text: &str, options: &Options) -> String {
    let report = Urdf::read("arm.urdf", text).and_then(|urdf| urdf.import(options).map(|_| ())).unwrap_err();
    report.worded(|remedy| Some(format!("{remedy:?}"))).to_string()
}

pub(crate) fn torques(robot: &Robot, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<f64> {
    DynArm::from_robot(robot).inverse_dynamics(q, qd, qdd).unwrap()
}

pub(crate) fn tip(robot: &Robot, q: &[f64]) -> [f64; 3] {
    let pose = DynArm::from_robot(robot).forward_kinematics(q).unwrap();
    pose.translation_vector().into()
}

pub(crate) fn assert_close(one: &[f64], other: &[f64], tolerance: f64) {
    let close = one.len() == other.len() && one.iter().zip(other).all(|(a, b)| (a - b).abs() <= tolerance);
    assert!(close, "{one:?} {other:?}");
}

/// A pendulum about y that hangs down, of mass m at distance l, with moment of inertia i about its centre.
pub(crate) fn pendulum(axis: &str) -> String {
    robot(&[
        bare(&["base"]),
        link("rod", 2.0, "0 0 -0.3", [0.05, 0.05, 0.001]),
        joint("hinge", "continuous", ("base", "rod"), "xyz=\"0 0 1\"", axis),
    ])
}

/// A planar arm of two links along x, joints about z.
pub(crate) fn planar(second: &str) -> String {
    let limits = "<axis xyz=\"0 0 1\"/><limit lower=\"-1\" upper=\"2\" effort=\"30\" velocity=\"3\"/>";
    robot(&[
        bare(&["base", "tip"]),
        link("one", 1.5, "0.2 0 0", [0.0, 0.02, 0.02]),
        link("two", 1.0, "0.15 0 0", [0.0, 0.01, 0.01]),
        joint("a", "revolute", ("base", "one"), "xyz=\"0 0 0\"", limits),
        joint("b", "revolute", ("one", "two"), second, limits),
        joint("end", "fixed", ("two", "tip"), "xyz=\"0.3 0 0\"", ""),
    ])
}
