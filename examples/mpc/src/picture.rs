//! A picture of a motion: positions, velocities and torques with their limits, and the distance of the tip from its
//! goal.

use rne_plot::{Panel, PanelCurve, panels};

use crate::controller::NODES;
use crate::experiment::{GOALS, INTERVAL, LOAD, SAMPLES, Sample};
use crate::model::{DOF, Panda};

const NAMES: [&str; DOF] = ["joint 1", "joint 2", "joint 3", "joint 4", "joint 5", "joint 6", "joint 7"];

/// Returns the picture as SVG. The values of each joint are divided by its limits, so that 1 is a limit for all joints.
#[must_use]
pub fn picture(samples: &[Sample]) -> String {
    let time: Vec<f64> = samples.iter().map(|sample| sample.time).collect();
    let by_joint = |of: &dyn Fn(&Sample, usize) -> f64| -> Vec<Vec<f64>> {
        (0..DOF).map(|joint| samples.iter().map(|sample| of(sample, joint)).collect()).collect()
    };
    let position = by_joint(&|sample, joint| {
        let (lower, upper) = Panda::POSITION_LIMITS[joint];
        (2.0 * sample.state.q[joint] - upper - lower) / (upper - lower)
    });
    let velocity = by_joint(&|sample, joint| sample.state.qd[joint] / Panda::VELOCITY_LIMITS[joint]);
    let torque = by_joint(&|sample, joint| sample.tau[joint] / Panda::EFFORT_LIMITS[joint]);
    let tip = vec![samples.iter().map(|sample| 1e3 * sample.off).collect::<Vec<f64>>()];
    let most = |curves: &[Vec<f64>]| {
        let largest = curves.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        format!("at most {largest:.2} of a limit")
    };
    let off = |end: usize| format!("{:.1} mm", 1e3 * samples[end * SAMPLES - 1].off);
    let drawn = [
        panel("positions, limits at 1 and -1", most(&position), &position, vec![-1.0, 1.0]),
        panel("velocities, limits at 1 and -1", most(&velocity), &velocity, vec![-1.0, 1.0]),
        panel("torques, limits at 1 and -1", most(&torque), &torque, vec![-1.0, 1.0]),
        panel("tip from its goal, mm", format!("at the ends {} and {}", off(1), off(2)), &tip, Vec::new()),
    ];
    let about = format!(
        "{} goals, {NODES} intervals of {INTERVAL} s, one iteration for each sample; {LOAD} kg that the model lacks",
        GOALS.len()
    );
    panels("Motion of a Panda under model-predictive control", "Panda, model-predictive control", &about, &time, &drawn)
}

/// Returns a panel with a curve per joint. The panel of the tip has one curve, which gets the name of the first joint.
fn panel<'a>(title: &str, note: String, curves: &'a [Vec<f64>], limits: Vec<f64>) -> Panel<'a> {
    let curves = NAMES.iter().zip(curves).map(|(name, values)| PanelCurve { name, values }).collect();
    Panel { title: title.to_owned(), note, curves, limits, bounds: Vec::new(), bands: Vec::new() }
}
