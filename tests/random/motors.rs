//! Random motors of a list `motors`: some turn with several joints, some have no rotor, and a link or the base carries
//! a rotor.

use std::fmt::Write;

use fastrand::Rng;

const RATIOS: [f64; 6] = [1.0, -1.0, 6.0, -9.33, 0.5, 23.7];
const AXES: [&str; 6] = ["0, 0, 1", "0, 0, -1", "0, 1, 0", "-1, 0, 0", "0.6, 0, 0.8", "1.5, -0.7, 0.4"];

/// The list for a robot with the joints `j0`, `j1` and so on.
pub(crate) fn yaml(rng: &mut Rng, dof: usize) -> String {
    let mut text = "motors:\n".to_owned();
    for _ in 0..=rng.usize(0..4) {
        let mut joints: Vec<usize> = (0..dof).collect();
        rng.shuffle(&mut joints);
        joints.truncate(1 + rng.usize(0..dof.min(3)));
        let turns: Vec<_> =
            joints.iter().map(|joint| format!("j{joint}: {}", RATIOS[rng.usize(0..RATIOS.len())])).collect();
        let on = match rng.usize(0..4) {
            0 => "on: base, ".to_owned(),
            1 => String::new(),
            _ => format!("on: j{}, ", rng.usize(0..dof)),
        };
        let (axis, inertia) = (AXES[rng.usize(0..AXES.len())], 0.01 + 0.2 * rng.f64());
        let rotor = if rng.usize(0..5) == 0 {
            String::new()
        } else {
            format!(", rotor: {{axis: [{axis}], {on}inertia: {inertia}}}")
        };
        let _ = writeln!(text, "  - {{turns: {{{}}}{rotor}}}", turns.join(", "));
    }
    text
}
