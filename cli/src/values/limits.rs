//! Compares a motion with the limits of joints in a robot file.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use rne_model::{Joint, JointKind, Robot, six_digits};

/// Returns a line for each joint whose position in `q`, rad or m, or whose velocity in `qd` is outside of its limits in
/// the file, also for dependent joints of closed loops. Results are right even so, because limits are no part of the
/// dynamics.
pub(crate) fn remark(robot: &Robot, [q, qd]: [&[f64]; 2], passive: &[f64]) -> String {
    let mut text = String::new();
    let joints = robot.independent_joints().zip(robot.coordinate_limits()).zip(q);
    let joints = joints.enumerate().map(|(index, (joint, q))| (format!("q{}", index + 1), joint, q));
    let dependent = robot.closed.passive.iter().map(|&joint| &robot.joints[joint]).zip(passive);
    let dependent = dependent.map(|(joint, p)| ("the position".to_owned(), (joint, joint.limits), p));
    for (name, (joint, limits), &q) in joints.chain(dependent) {
        let Some((lower, upper)) = limits.position else { continue };
        // allows for the rounding between a limit that is an expression and a position that is written in digits
        let rounding = 1e-12 * lower.abs().max(upper.abs());
        if lower - rounding <= q && q <= upper + rounding {
            continue;
        }
        let unit = joint.row.kind.position_unit();
        let [q, lower, upper] = [q, lower, upper].map(six_digits);
        let _ = writeln!(
            text,
            "note: {name} = {q} {unit} is outside of the limits of {}: {lower} to {upper} {unit}",
            joint.name
        );
    }
    let joints = robot.independent_joints().zip(robot.coordinate_limits()).zip(qd);
    for (index, ((joint, limits), qd)) in joints.enumerate() {
        let Some(most) = limits.velocity.filter(|most| qd.abs() > most * (1.0 + 1e-12)) else { continue };
        let (unit, [qd, most]) = (joint.row.kind.position_unit(), [*qd, most].map(six_digits));
        let _ = writeln!(
            text,
            "note: qd{} = {qd} {unit}/s is beyond the velocity limit of {}: {most} {unit}/s",
            index + 1,
            joint.name
        );
    }
    text
}

/// Finds positions of revolute joints that are probably in degrees: a position is more than a full turn, and either all
/// positions have at most one decimal, which is unusual for radians, or one is many turns.
#[derive(Default)]
pub(crate) struct Degrees {
    /// The first position of more than a turn, and the name of its joint.
    first: Option<(String, f64)>,
    have_digits: bool,
    is_far: bool,
}

/// Position that no joint reaches, rad.
const MANY_TURNS: f64 = 5.0 * TAU;

impl Degrees {
    /// Examines the positions of each state.
    pub(crate) fn of<'a>(robot: &Robot, states: impl IntoIterator<Item = &'a [f64]>) -> Self {
        let mut degrees = Self::default();
        states.into_iter().for_each(|q| degrees.see(robot, q));
        degrees
    }

    /// Examines the positions of one more state.
    pub(crate) fn see(&mut self, robot: &Robot, q: &[f64]) {
        let turns = |(joint, _): &(&Joint, &f64)| joint.row.kind == JointKind::Revolute;
        for (joint, &q) in robot.independent_joints().zip(q).filter(turns) {
            self.have_digits |= (10.0 * q).fract() != 0.0;
            self.is_far |= q.abs() > MANY_TURNS;
            if self.first.is_none() && q.abs() > TAU {
                self.first = Some((joint.name.clone(), q));
            }
        }
    }

    /// Returns the remark; `remedy` says how to write the position instead.
    pub(crate) fn remark(&self, remedy: impl Fn(f64) -> String) -> String {
        self.first.as_ref().filter(|_| self.is_far || !self.have_digits).map_or_else(String::new, |(joint, q)| {
            let remedy = remedy(*q);
            format!("note: {joint} is at {q} rad, more than a full turn; if this is in degrees, {remedy}\n")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARM: &str = "
        {format: 1, name: arm, source: own, convention: standard, gravity: [0, 0, -9.81], joints: [
        {name: turn, type: revolute, limits: {position: [-deg(160), pi/2]},
         dh: {theta: 0, d: 0, a: 1, alpha: 0}, link: {mass: 1}},
        {name: free, type: revolute, dh: {theta: 0, d: 0, a: 1, alpha: 0}, link: {mass: 1}},
        {name: slide, type: prismatic, limits: {position: [0, 0.5], velocity: 0.2},
         dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 1}}]}";

    #[test]
    fn joints_beyond_their_limits() {
        let robot = Robot::from_yaml(ARM).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(remark(&robot, [&[0.0, 1e9, 0.25], &[]], &[]), "");
        // positions at a limit, as an expression and in digits; and a function that takes no positions
        assert_eq!(remark(&robot, [&[std::f64::consts::FRAC_PI_2, 0.0, 0.5], &[]], &[]), "");
        assert_eq!(remark(&robot, [&[-2.792_526_803_190_927, 0.0, 0.0], &[]], &[]), "");
        assert_eq!(remark(&robot, [&[], &[]], &[]), "");
        assert_eq!(
            remark(&robot, [&[-3.0, 0.0, 0.6], &[0.0, 0.0, -0.3]], &[]),
            "note: q1 = -3 rad is outside of the limits of turn: -2.79253 to 1.5708 rad\n\
             note: q3 = 0.6 m is outside of the limits of slide: 0 to 0.5 m\n\
             note: qd3 = -0.3 m/s is beyond the velocity limit of slide: 0.2 m/s\n"
        );
    }

    /// Dependent joints of closed loops are compared with their limits, too.
    #[test]
    fn dependent_joints_beyond_their_limits() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/four_bar.yaml");
        let text = std::fs::read_to_string(path).expect("a file").replace(
            "{name: coupler, type: revolute,",
            "{name: coupler, type: revolute, limits: {position: [-0.5, 0.5]},",
        );
        let robot = rne_model::Reader::new("four_bar").trees().couplings().loops().read(text.as_bytes());
        let robot = robot.unwrap_or_else(|report| panic!("{}", report.render(false))).robot;
        let expected = "note: the position = 0.6 rad is outside of the limits of coupler: -0.5 to 0.5 rad\n";
        assert_eq!(remark(&robot, [&[0.2], &[]], &[0.6, 1.0]), expected);
        assert_eq!(remark(&robot, [&[0.2], &[]], &[0.4, 1.0]), "");
    }
}
