//! A robot of each kind, and a state of it.

use fastrand::Rng;
use rne_codegen::{Function, sizes_of};
use rne_machine::{Arguments, Array};
use rne_model::{Reader, Robot};
use rne_runtime::{BaseMotion, BaseTwist, DynArm, Inputs, Payload, Pose, Wrench};

/// A kind of robot.
pub(crate) struct Kind {
    pub(crate) name: &'static str,
    pub(crate) robot: Robot,
    /// The robot, with numbers in the place of its run-time parameters.
    definite: Robot,
}

const SATELLITE: &str = include_str!("../../docs/satellite.yaml");
const FOUR_BAR: &str = include_str!("../../docs/four_bar.yaml");

/// Two feet that stand.
const CONTACTS: &str = "
frames: [{name: left, on: elbow, xyz: [0.6, 0.1, 0]}, {name: right, on: shoulder, xyz: [0.2, -0.4, -0.3]}]
tips: [left, right]
contacts: [{tip: left, kind: point}, {tip: right, kind: point}]
";

const TRUNK: &str = "
floating_base: {name: trunk, link: {mass: 3, com: [0.1, 0, 0.02], inertia: {xx: 0.1, yy: 0.2, zz: 0.25}}}
";

/// The middle link has no mass, as that of a universal joint.
const MASSLESS: &str = "{format: 1, name: cross, source: own, convention: standard, gravity: [0, 0, -9.81], joints: [
    {type: revolute, dh: {theta: 0, d: 0.2, a: 0, alpha: pi/2}, link: {mass: 1, com: [0, 0.1, 0], inertia: {yy: 0.02}}},
    {type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: -pi/2}, link: {mass: 0}},
    {type: revolute, dh: {theta: 0, d: 0, a: 0.4, alpha: 0},
     link: {mass: 2, com: [-0.2, 0.05, 0], inertia: {xx: 0.01, yy: 0.05, zz: 0.06}}}]}";

/// `m` and `iz` are known when the program runs.
const VARIABLE: &str = "{format: 1, name: rod, source: own, convention: standard, gravity: [0, -9.81, 0], \
    parameters: {m: 2, iz: 0.3}, joints: [
    {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: pi/2}, link: {mass: m, com: [-0.4, 0, 0], inertia: {zz: iz}}},
    {type: prismatic, dh: {theta: 0, d: 0, a: 0.1, alpha: 0}, link: {mass: 1, com: [0, 0.1, -0.2]}}]}";

/// The values of the run-time parameters in that text.
const VALUES: [f64; 2] = [2.0, 0.3];

fn read(text: &str) -> Robot {
    let read = Reader::new("robot.yaml").trees().couplings().loops().read(text);
    read.unwrap_or_else(|report| panic!("{report}")).robot
}

fn shipped(name: &str) -> Robot {
    read(rne_robots::find(name).expect("a shipped robot").yaml)
}

/// A robot of each kind.
pub(crate) fn all() -> Vec<Kind> {
    let of = |name, robot: Robot| Kind { name, definite: robot.clone(), robot };
    let puma560 = shipped("puma560");
    let variable = Reader::new("rod.yaml").run_time(&["m", "iz"]).read(VARIABLE);
    let variable = variable.unwrap_or_else(|report| panic!("{report}")).robot;
    vec![
        of("chain", puma560.clone()),
        of("modified table", shipped("puma560_mdh")),
        of("rotors", Robot { rotors: true, ..puma560 }),
        of("massless link", read(MASSLESS)),
        Kind { name: "run-time parameters", robot: variable, definite: read(VARIABLE) },
        of("tree", read(include_str!("../../docs/tree.yaml"))),
        of("coupling", read(include_str!("../../docs/gripper.yaml"))),
        of("floating base", read(SATELLITE)),
        of("contacts", read(&format!("{SATELLITE}{CONTACTS}"))),
        of("closed loops", read(FOUR_BAR)),
        of("floating base, closed loops", read(&FOUR_BAR.replacen("\njoints:", &format!("{TRUNK}joints:"), 1))),
    ]
}

impl Kind {
    pub(crate) fn definition(&self) -> DynArm {
        DynArm::from_robot(&self.definite)
    }
}

/// The arguments of all functions.
pub(crate) struct State {
    joints: [Vec<f64>; 5],
    sines: [Vec<f64>; 2],
    passive: Vec<f64>,
    parameters: Vec<f64>,
    wrenches: Vec<Wrench<f64>>,
    payload: Payload<f64>,
    base: BaseMotion<f64>,
    twist: BaseTwist<f64>,
    pose: Pose<f64>,
    /// The structures above as numbers.
    flat: [Vec<f64>; 5],
}

/// The duration of a step, s.
const STEP: [f64; 1] = [0.01];

impl State {
    /// A random state in which the loops are closed.
    pub(crate) fn of(kind: &Kind) -> Self {
        let sizes = sizes_of(&kind.robot);
        let mut rng = Rng::with_seed(58);
        let mut some = |count: usize| -> Vec<f64> { (0..count).map(|_| 2.0 * rng.f64() - 1.0).collect() };
        let mut three = || -> [f64; 3] { some(3).try_into().expect("three") };
        let base = BaseMotion {
            omega: three(),
            omega_dot: three(),
            velocity: [0.0; 3],
            acceleration: three(),
            gravity: three(),
        };
        let twist = BaseTwist { linear: three(), angular: base.omega };
        let wrenches: Vec<_> = (0..sizes.tips).map(|_| Wrench { force: three(), moment: three() }).collect();
        let pose = Pose { rotation: [[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]], translation: three() };
        let joints = [(); 5].map(|()| some(sizes.dof));
        let payload = [0.7, 0.1, -0.05, 0.2, 0.02, 0.03, 0.025, 0.001, -0.002, 0.003];
        let mut state = Self {
            sines: [f64::sin, f64::cos].map(|of| joints[0].iter().map(|&q| of(q)).collect()),
            joints,
            passive: vec![1.0; sizes.passive],
            parameters: if kind.robot.run_time.names.is_empty() { Vec::new() } else { VALUES.to_vec() },
            payload: Payload::from_array(payload),
            flat: [
                [pose.rotation.as_flattened(), &pose.translation].concat(),
                [twist.linear, twist.angular].concat(),
                wrenches.iter().flat_map(|wrench| [wrench.force, wrench.moment].concat()).collect(),
                [wrenches[0].force, wrenches[0].moment].concat(),
                payload.to_vec(),
            ],
            wrenches,
            base,
            twist,
            pose,
        };
        for _ in 0..30 * sizes.passive {
            let step = kind.definition().evaluate(Function::ClosureStep, &state.inputs());
            state.passive = step.expect("arguments of the right lengths")[..sizes.passive].to_vec();
        }
        state
    }

    pub(crate) fn inputs(&self) -> Inputs<'_, f64> {
        let [q, qd, qdd, tau, multipliers] = &self.joints;
        Inputs {
            q,
            qd,
            qdd,
            tau,
            sin: &self.sines[0],
            cos: &self.sines[1],
            passive: &self.passive,
            multipliers,
            wrench: &self.wrenches[0],
            wrenches: &self.wrenches,
            payload: &self.payload,
            base: &self.base,
            omega: &self.base.omega,
            twist: &self.twist,
            pose: &self.pose,
            base_rotation: &self.pose.rotation,
            step: STEP[0],
        }
    }

    /// These arguments by name, for any number of states.
    pub(crate) fn arguments(&self) -> Arguments<'_, f64> {
        let [q, qd, qdd, tau, multipliers] = &self.joints;
        let [pose, twist, wrenches, wrench, payload] = &self.flat;
        let named: [(&str, &[f64]); 21] = [
            ("q", q),
            ("qd", qd),
            ("qdd", qdd),
            ("tau", tau),
            ("multipliers", multipliers),
            ("sin", &self.sines[0]),
            ("cos", &self.sines[1]),
            ("passive", &self.passive),
            ("parameters", &self.parameters),
            ("pose", pose),
            ("twist", twist),
            ("wrenches", wrenches),
            ("force", &wrench[..3]),
            ("moment", &wrench[3..]),
            ("payload", payload),
            ("base_omega", &self.base.omega),
            ("base_omega_dot", &self.base.omega_dot),
            ("base_acceleration", &self.base.acceleration),
            ("base_gravity", &self.base.gravity),
            ("omega", &self.base.omega),
            ("base_rotation", &pose[..9]),
        ];
        let all = named.into_iter().chain([("step", &STEP[..])]);
        all.fold(Arguments::new(), |arguments, (name, array)| {
            arguments.with(name, Array::Same(array)).unwrap_or_else(|| panic!("{name} is an argument"))
        })
    }
}
