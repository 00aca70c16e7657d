//! Closed loops: both forms of each function, against the closed form of a four-bar linkage.

use rne_codegen::{Arguments, Compiler, Form, Function, Interpreter, Reason};
use rne_model::{Reader, Robot};

/// A crank of 0.2 m and a coupler of 0.45 m; a rocker of 0.3 m stands 0.5 m away.
const FOUR_BAR: &str = "
    format: 2
    name: four_bar
    source: own numbers
    convention: modified
    gravity: [0, -9.81, 0]
    tool: {on: coupler, xyz: [0.45, 0, 0]}
    joints:
      - {name: crank, type: revolute, dh: {alpha: 0, a: 0, theta: 0, d: 0},
         link: {mass: 1.1, com: [0.1, 0.01, 0], inertia: {zz: 0.004}}}
      - {name: coupler, type: revolute, dh: {alpha: 0, a: 0.2, theta: 0, d: 0},
         link: {mass: 0.7, com: [0.2, -0.02, 0], inertia: {zz: 0.013}}}
      - {name: rocker, parent: base, type: revolute, dh: {gamma: 0, b: 0, alpha: 0, a: 0.5, theta: 0, d: 0},
         link: {mass: 0.9, com: [0.14, 0.03, 0], inertia: {zz: 0.008}}}
";

/// The joint between coupler and rocker.
const LOOP: &str = "
    loops:
      - {name: bar, cut: revolute, between: [{on: coupler, xyz: [0.45, 0, 0]}, {on: rocker, xyz: [0.3, 0, 0]}],
         dependent: [coupler, rocker]}
";

fn read(text: &str) -> Robot {
    let read = Reader::new("four_bar").trees().couplings().loops().read(text.as_bytes());
    read.unwrap_or_else(|report| panic!("{}", report.render(false))).robot
}

fn four_bar() -> Robot {
    read(&[FOUR_BAR.trim_end(), LOOP].concat())
}

/// The angles of the coupler, from the crank, and of the rocker: the triangle of the crank's end, the rocker's joint
/// and the joint between coupler and rocker.
fn closed_form(q: f64) -> [f64; 2] {
    let [x, y] = [0.5 - 0.2 * q.cos(), -0.2 * q.sin()];
    let (apart, towards) = (x.hypot(y), y.atan2(x));
    let corner = |near: f64, far: f64| ((near * near + apart * apart - far * far) / (2.0 * near * apart)).acos();
    let coupler = towards + corner(0.45, 0.3);
    let rocker = towards + std::f64::consts::PI - corner(0.3, 0.45);
    [coupler - q, rocker]
}

/// Kinetic and potential energy of the linkage whose crank turns with `qd`.
fn energies(q: f64, qd: f64) -> (f64, f64) {
    let h = 1e-6;
    let centres = |q: f64| {
        let [coupler, rocker] = closed_form(q);
        let turned = |angle: f64, [x, y]: [f64; 2]| {
            [x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos(), angle]
        };
        let [ax, ay, a] = turned(q, [0.1, 0.01]);
        let [bx, by, b] = turned(q + coupler, [0.2, -0.02]);
        let [cx, cy, c] = turned(rocker, [0.14, 0.03]);
        [[ax, ay, a], [bx + 0.2 * q.cos(), by + 0.2 * q.sin(), b], [cx + 0.5, cy, c]]
    };
    let (before, after) = (centres(q - h), centres(q + h));
    let (mut kinetic, mut potential) = (0.0, 0.0);
    for (body, (mass, inertia)) in [(1.1, 0.004), (0.7, 0.013), (0.9, 0.008)].into_iter().enumerate() {
        let [vx, vy, w] = [0, 1, 2].map(|i| (after[body][i] - before[body][i]) / (2.0 * h) * qd);
        kinetic += 0.5 * (mass * (vx * vx + vy * vy) + inertia * w * w);
        potential += mass * 9.81 * centres(q)[body][1];
    }
    (kinetic, potential)
}

fn run(robot: &Robot, function: Function, form: Form, state: [&[f64]; 5]) -> Vec<f64> {
    let program = Compiler::new(robot).compile(function, form).unwrap_or_else(|error| panic!("{function}: {error}"));
    let is_longer = program.refusals.iter().any(|refusal| matches!(refusal.reason, Reason::Longer { .. }));
    assert!(program.form == form || is_longer, "{function}: {:?}", program.refusals);
    let [q, passive, qd, qdd, tau] = state;
    let arguments = Arguments { passive, tau, wrenches: &[[0.0; 6]], ..Arguments::of_joints(q, qd, qdd, 0.0) };
    Interpreter::new(&program).run(&arguments, |x| x, f64::sin_cos).expect("all arguments")
}

#[test]
fn a_four_bar_linkage_has_its_closed_form() {
    let robot = four_bar();
    for form in [Form::SevenSteps, Form::Reduced] {
        for (q, qd, qdd) in [(0.3, 1.5, -2.0), (-1.2, 0.4, 3.0), (2.6, -2.0, 0.5)] {
            let passive = closed_form(q);
            let near = |a: f64, b: f64, tolerance: f64, what: &str| {
                assert!((a - b).abs() < tolerance * (1.0 + b.abs()), "{form} {what} at {q}: {a} and not {b}");
            };
            let of = |function, form| run(&robot, function, form, [&[q], &passive, &[qd], &[qdd], &[0.7]]);
            // rates by differences of the closed form
            let h = 1e-5;
            let (before, at, after) = (closed_form(q - h), closed_form(q), closed_form(q + h));
            let (map, bias) = (of(Function::LoopMap, Form::SevenSteps), of(Function::LoopMapRateTimesVelocity, form));
            for i in 0..2 {
                near(map[i], (after[i] - before[i]) / (2.0 * h), 1e-8, "map");
                near(bias[i], (after[i] - 2.0 * at[i] + before[i]) / (h * h) * qd * qd, 1e-4, "bias");
            }
            // T = ½ M q̇², τ = M q̈ + ½ M' q̇² + V'
            let mass = |q: f64| 2.0 * energies(q, 1.0).0;
            let slope = |f: &dyn Fn(f64) -> f64| (f(q + 1e-4) - f(q - 1e-4)) / 2e-4;
            let bias = 0.5 * slope(&mass) * qd * qd + slope(&|q| energies(q, 0.0).1);
            near(of(Function::MassMatrixOfLoops, form)[0], mass(q), 1e-8, "mass");
            near(of(Function::InverseDynamicsOfLoops, form)[0], mass(q) * qdd + bias, 1e-6, "torque");
            near(of(Function::InverseDynamicsOfLoopsWithWrenches, form)[0], mass(q) * qdd + bias, 1e-6, "torque");
            near(of(Function::ForwardDynamicsOfLoops, form)[0], (0.7 - bias) / mass(q), 1e-6, "acceleration");
        }
    }
}

#[test]
fn newton_steps_close_the_loop() {
    let robot = four_bar();
    let mut passive = vec![0.5, 1.4];
    let mut left = Vec::new();
    for _ in 0..6 {
        let step = run(&robot, Function::ClosureStep, Form::SevenSteps, [&[0.3], &passive, &[], &[], &[]]);
        let (after, residual) = step.split_at(2);
        left.push(residual.iter().fold(0.0_f64, |largest, x| largest.max(x.abs())));
        passive = after.to_vec();
    }
    let expected = closed_form(0.3);
    assert!((passive[0] - expected[0]).abs() < 1e-14 && (passive[1] - expected[1]).abs() < 1e-14, "{passive:?}");
    assert!(left[5] < 1e-15 && left[4] < 10.0 * left[3] * left[3], "quadratic convergence: {left:?}");
}

#[test]
fn functions_that_take_no_dependent_positions_are_refused() {
    let robot = four_bar();
    let error = Compiler::new(&robot).compile(Function::InverseDynamics, Form::SevenSteps).unwrap_err();
    assert!(error.to_string().contains("the loop `bar`") && error.to_string().contains("inverse_dynamics_of_loops"));
    let open = read(FOUR_BAR);
    let error = Compiler::new(&open).compile(Function::LoopMap, Form::SevenSteps).unwrap_err();
    assert!(error.to_string().contains("no `loops`"), "{error}");
}
