//! What each derive of a robot file costs a release build.

use std::path::Path;
use std::time::Instant;

use rne_codegen::Form;
use rne_model::Reader;

use crate::{number, time, user};

/// Derives, and calls of their functions.
const DERIVES: [(&[&str], &[&str]); 13] = [
    (&["InverseDynamics"], &["inverse_dynamics(q, qd, qdd)"]),
    (
        &["InverseDynamics", "MassMatrix", "ForwardDynamics"],
        &["inverse_dynamics(q, qd, qdd)", "mass_matrix(q)", "forward_dynamics(q, qd, qdd)"],
    ),
    (&["MassMatrix"], &["mass_matrix(q)"]),
    (&["ForwardDynamics"], &["forward_dynamics(q, qd, qdd)"]),
    (&["InverseDynamicsDerivatives"], &["inverse_dynamics_derivatives(q, qd, qdd)"]),
    (&["CoriolisMatrix"], &["coriolis_matrix(q, qd)"]),
    (&["Kinematics"], &["forward_kinematics(q)", "jacobian(q)"]),
    (&["Energy"], &["kinetic_energy(q, qd)", "potential_energy(q)"]),
    (&["CentreOfMass"], &["centre_of_mass(q)", "centre_of_mass_jacobian(q)"]),
    (&["Regressor"], &["regressor(q, qd, qdd)"]),
    (&["JointWrenches"], &["joint_wrenches(q, qd, qdd)"]),
    (&["MomentumObserver"], &["momentum_and_rate(q, qd, qdd)"]),
    (&["MovingBase"], &["inverse_dynamics_on_moving_base(q, qd, qdd, &BaseMotion::default())"]),
];

/// A table of a robot file.
#[allow(clippy::cast_precision_loss)] // bytes of code
pub(crate) fn print(file: &str) {
    let path = Path::new(file).canonicalize().unwrap_or_else(|error| panic!("{file}: {error}"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{file}: {error}"));
    let reader = Reader::new(file).trees().couplings().read(text.as_bytes());
    let joints = reader.unwrap_or_else(|report| panic!("{report}")).robot.joints.len();
    println!("| {file}: derives | release, s | most memory, MB | code, bytes |\n|---|---:|---:|---:|");
    for (capabilities, calls) in DERIVES {
        let user = user::Crate::of(&path.display().to_string(), capabilities, calls, joints, Form::Reduced);
        let (is_built, seconds) = time::of(Instant::now(), || user.build("release"));
        let [seconds, memory, code] =
            if is_built { [seconds, user.most_memory(), user.code_size() as f64] } else { [f64::NAN; 3] };
        let cells = [number(seconds, 1), number(memory, 0), number(code, 0)].join(" | ");
        println!("| {} | {cells} |", capabilities.join(", "));
    }
}
