//! Worksheets against the lecture's formulas, typed here over vectors in the axes of frame 0, and against positions
//! that are differentiated; then mistakes that were made on purpose.

use std::f64::consts::FRAC_PI_2;

use rne_diagnose::Slip;
use rne_diagnose::worksheet::{Axes, Comparison, GivenValue, Quantity, Reach, Situation, Worksheet};
use rne_model::{Convention, JointKind, Robot};
use rne_runtime::{BaseMotion, Payload, Wrench};

type V = [f64; 3];
type M = [V; 3];

fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn times(s: f64, a: V) -> V {
    a.map(|x| s * x)
}

fn sub(a: V, b: V) -> V {
    add(a, times(-1.0, b))
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn turn(m: M, a: V) -> V {
    m.map(|row| dot(row, a))
}

fn transposed(m: M) -> M {
    [0, 1, 2].map(|j| [0, 1, 2].map(|i| m[i][j]))
}

fn product(a: M, b: M) -> M {
    let columns = transposed(b);
    a.map(|row| columns.map(|column| dot(row, column)))
}

fn rz(t: f64) -> M {
    [[t.cos(), -t.sin(), 0.0], [t.sin(), t.cos(), 0.0], [0.0, 0.0, 1.0]]
}

fn rx(t: f64) -> M {
    [[1.0, 0.0, 0.0], [0.0, t.cos(), -t.sin()], [0.0, t.sin(), t.cos()]]
}

const ONE: M = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Every number of a link, in the axes of frame 0.
#[derive(Clone, Copy, Debug)]
struct Link {
    e: V,
    /// Axes on the joint: fixed to the link, and to the link before.
    fixed: M,
    before: M,
    theta: f64,
    d: V,
    r: V,
    inertia: M,
    omega: V,
    omega_dot: V,
    velocity: V,
    acceleration: V,
    f: V,
    n: V,
    next_f: V,
    next_n: V,
    joint_f: V,
    joint_n: V,
    tau: f64,
}

/// Where things are: axes, joints, centres of mass, and the tip with its axes.
struct Placed {
    e: Vec<V>,
    fixed: Vec<M>,
    before: Vec<M>,
    theta: Vec<f64>,
    joints: Vec<V>,
    centres: Vec<V>,
    frames: Vec<M>,
    tip: (M, V),
}

/// From the rows, frame by frame.
fn placed(robot: &Robot, q: &[f64]) -> Placed {
    let (mut axes, mut origin) = (ONE, [0.0; 3]);
    let mut all = Placed {
        e: vec![],
        fixed: vec![],
        before: vec![],
        theta: vec![],
        joints: vec![],
        centres: vec![],
        frames: vec![],
        tip: (ONE, [0.0; 3]),
    };
    for (row, q) in robot.rows().zip(q) {
        let revolute = row.kind == JointKind::Revolute;
        let theta = row.dh.theta.radians + if revolute { *q } else { 0.0 };
        let d = row.dh.d + if revolute { 0.0 } else { *q };
        let (a, alpha) = (row.dh.a, row.dh.alpha.radians);
        if robot.convention == Convention::Modified {
            origin = add(origin, turn(axes, [a, 0.0, 0.0]));
            axes = product(axes, rx(alpha));
        }
        all.joints.push(origin);
        all.before.push(axes);
        all.e.push(turn(axes, [0.0, 0.0, 1.0]));
        all.theta.push(theta);
        origin = add(origin, turn(axes, [0.0, 0.0, d]));
        axes = product(axes, rz(theta));
        all.fixed.push(axes);
        if robot.convention == Convention::Standard {
            origin = add(origin, turn(axes, [a, 0.0, 0.0]));
            axes = product(axes, rx(alpha));
        }
        all.frames.push(axes);
        all.centres.push(add(origin, turn(axes, row.link.com)));
    }
    let [roll, pitch, yaw] = robot.tool.rpy.map(|angle| angle.radians);
    assert_eq!((roll, pitch), (0.0, 0.0), "tools of these tests turn about z");
    all.tip = (product(axes, rz(yaw)), add(origin, turn(axes, robot.tool.xyz)));
    all
}

/// The lecture's recursion in the axes of frame 0; every vector is rounded as soon as it is found.
fn recursion(robot: &Robot, at: &Situation, rounded: impl Fn(f64) -> f64) -> Vec<Link> {
    let places = placed(robot, &at.q);
    let round = |v: V| v.map(&rounded);
    let base = at.base.unwrap_or_else(|| BaseMotion::fixed(robot.gravity));
    let BaseMotion { omega, omega_dot, velocity, acceleration, gravity: g } = base;
    let (mut w, mut dw, mut dc, mut ddc, mut centre) = (omega, omega_dot, velocity, acceleration, [0.0; 3]);
    let mut links = Vec::new();
    for (i, row) in robot.rows().enumerate() {
        let (e, qd, qdd) = (round(places.e[i]), at.qd[i], at.qdd[i]);
        let slides = row.kind == JointKind::Prismatic;
        let r_before = round(sub(places.joints[i], centre));
        let d = round(sub(places.centres[i], places.joints[i]));
        let next = places.joints.get(i + 1).copied().unwrap_or(places.tip.1);
        let r = round(sub(next, places.centres[i]));
        // ω_i = ω_{i-1} + q̇ e; ω̇_i = ω̇_{i-1} + q̈ e + q̇ ω_{i-1} × e
        let (w_before, dw_before) = (w, dw);
        if !slides {
            dw = round(add(add(dw, times(qdd, e)), times(qd, cross(w, e))));
            w = round(add(w, times(qd, e)));
        }
        dc = add(add(dc, cross(w_before, r_before)), cross(w, d));
        ddc = add(ddc, add(cross(dw_before, r_before), cross(w_before, cross(w_before, r_before))));
        ddc = add(ddc, add(cross(dw, d), cross(w, cross(w, d))));
        if slides {
            dc = add(dc, times(qd, e));
            ddc = add(ddc, add(times(qdd, e), times(2.0 * qd, cross(w, e))));
        }
        (dc, ddc) = (round(dc), round(ddc));
        let own = row.link.inertia;
        let own = [[own.xx, own.xy, own.xz], [own.xy, own.yy, own.yz], [own.xz, own.yz, own.zz]];
        let axes = places.frames[i];
        let inertia = product(product(axes, own), transposed(axes)).map(round);
        // of a link without mass that has a first moment
        let h = turn(axes, row.link.first_moment);
        let f = round(add(times(row.link.mass, ddc), add(cross(dw, h), cross(w, cross(w, h)))));
        let n = round(add(add(turn(inertia, dw), cross(w, turn(inertia, w))), cross(h, ddc)));
        centre = places.centres[i];
        links.push(Link {
            e,
            fixed: places.fixed[i],
            before: places.before[i],
            theta: places.theta[i],
            d,
            r,
            inertia,
            omega: w,
            omega_dot: dw,
            velocity: dc,
            acceleration: ddc,
            f,
            n,
            next_f: [0.0; 3],
            next_n: [0.0; 3],
            joint_f: [0.0; 3],
            // what is taken from it for the weight
            joint_n: cross(h, g),
            tau: 0.0,
        });
    }
    let (mut next_f, mut next_n) = ([0.0; 3], [0.0; 3]);
    if let Some(Wrench { force, moment }) = at.wrench {
        (next_f, next_n) = (round(turn(places.tip.0, force)), round(turn(places.tip.0, moment)));
    }
    for (link, row) in links.iter_mut().zip(robot.rows()).rev() {
        (link.next_f, link.next_n) = (next_f, next_n);
        link.joint_f = round(sub(add(link.f, next_f), times(row.link.mass, g)));
        let levers = add(cross(link.d, link.joint_f), cross(link.r, next_f));
        link.joint_n = round(sub(add(add(link.n, next_n), levers), link.joint_n));
        let of = if row.kind == JointKind::Revolute { link.joint_n } else { link.joint_f };
        link.tau = rounded(dot(link.e, of));
        (next_f, next_n) = (link.joint_f, link.joint_n);
    }
    links
}

/// A line as the recursion has it, in these axes.
fn expected(links: &[Link], robot: &Robot, at: &Situation, axes: Axes, joint: usize, quantity: Quantity) -> Vec<f64> {
    let link = &links[joint - 1];
    let entry = |joint: usize| match axes {
        _ if joint == 0 => ONE,
        Axes::Link => links[joint - 1].fixed,
        Axes::Joint => links[joint - 1].before,
        Axes::Base => ONE,
    };
    let into = transposed(entry(joint));
    let vector = |v: V| turn(into, v).to_vec();
    let (row, g) = (&robot.joints[joint - 1].row, at.base.map_or(robot.gravity, |base| base.gravity));
    match quantity {
        Quantity::Q => vec![at.q[joint - 1]],
        Quantity::Qd => vec![at.qd[joint - 1]],
        Quantity::Qdd => vec![at.qdd[joint - 1]],
        Quantity::Theta => vec![link.theta],
        Quantity::Offset => {
            vec![row.dh.d + if row.kind == JointKind::Prismatic { at.q[joint - 1] } else { 0.0 }]
        }
        Quantity::Mass => vec![row.link.mass],
        Quantity::Rotation => product(transposed(entry(joint - 1)), entry(joint)).concat(),
        Quantity::Orientation => link.fixed.concat(),
        Quantity::Axis => link.e.to_vec(),
        Quantity::D => vector(link.d),
        Quantity::R => vector(link.r),
        Quantity::Inertia => {
            let m = product(product(into, link.inertia), transposed(into));
            vec![m[0][0], m[0][1], m[0][2], m[1][1], m[1][2], m[2][2]]
        }
        Quantity::Omega => vector(link.omega),
        Quantity::OmegaDot => vector(link.omega_dot),
        Quantity::Velocity => vector(link.velocity),
        Quantity::Acceleration => vector(link.acceleration),
        Quantity::Gravity => vector(g),
        Quantity::InertiaForce => vector(link.f),
        Quantity::InertiaMoment => vector(link.n),
        Quantity::NextForce => vector(link.next_f),
        Quantity::NextMoment => vector(link.next_n),
        Quantity::JointForce => vector(link.joint_f),
        Quantity::JointMoment => vector(link.joint_n),
        Quantity::Tau => vec![link.tau],
        other => panic!("{other} is new"),
    }
}

/// The six joints of the specification's largest test: skew axes, full inertias, joints of both kinds.
fn six(convention: &str) -> Robot {
    let rows = [
        "revolute, dh: {a: 0.10, alpha: 0.9, d: 0.40, theta: 0}, link: {mass: 4.0, com: [-0.05, 0.02, 0.03], inertia: \
         {xx: 0.050, yy: 0.060, zz: 0.040, xy: 0.004, xz: -0.003, yz: 0.002}}",
        "revolute, dh: {a: 0.45, alpha: -0.3, d: 0.05, theta: 0.2}, link: {mass: 3.0, com: [-0.20, 0.01, 0.04], \
         inertia: {xx: 0.020, yy: 0.070, zz: 0.065, xy: -0.002, xz: 0.001, yz: 0.003}}",
        "prismatic, dh: {a: 0.20, alpha: 0.7, d: 0.15, theta: -0.4}, link: {mass: 2.0, com: [0.03, -0.06, 0.02], \
         inertia: {xx: 0.030, yy: 0.025, zz: 0.015, xy: 0.001, xz: 0.002, yz: -0.001}}",
        "revolute, dh: {a: -0.05, alpha: 1.3, d: 0.30, theta: 0.1}, link: {mass: 1.5, com: [0.02, 0.03, -0.05], \
         inertia: {xx: 0.012, yy: 0.010, zz: 0.008, xy: -0.001, xz: 0.0005, yz: 0.0007}}",
        "prismatic, dh: {a: 0.08, alpha: -1.1, d: 0.10, theta: 0.6}, link: {mass: 1.0, com: [-0.03, 0.01, 0.02], \
         inertia: {xx: 0.006, yy: 0.005, zz: 0.004, xy: 0.0003, xz: -0.0002, yz: 0.0004}}",
        "revolute, dh: {a: 0.12, alpha: 0.5, d: -0.07, theta: -0.3}, link: {mass: 0.5, com: [0.01, -0.02, 0.06], \
         inertia: {xx: 0.0020, yy: 0.0018, zz: 0.0009, xy: 0.0001, xz: 0.0002, yz: -0.0001}}",
    ];
    let joints: Vec<String> = rows.iter().map(|row| format!("  - {{type: {row}}}\n")).collect();
    let joints = joints.concat();
    let head = format!(
        "format: 1\nname: six\nsource: the specification, 5.5\nconvention: {convention}\ngravity: [0, 0, -9.81]\n\
         tool: {{xyz: [0.02, -0.01, 0.05], rpy: [0, 0, 0.3]}}\n"
    );
    Robot::from_yaml(&format!("{head}joints:\n{joints}")).unwrap()
}

/// The same where links 2 and 5 have their first moments and no mass.
fn without_mass(mut robot: Robot) -> Robot {
    for index in [1, 4] {
        let link = &mut robot.joints[index].row.link;
        link.first_moment = times(link.mass, link.com);
        (link.mass, link.com) = (0.0, [0.0; 3]);
    }
    robot
}

fn shipped(name: &str) -> Robot {
    Robot::from_yaml(rne_robots::find(name).unwrap().yaml).unwrap()
}

fn state(dof: usize) -> Situation {
    let of = |numbers: [f64; 6]| numbers.iter().cycle().take(dof).copied().collect();
    Situation {
        q: of([0.3, -0.8, 0.25, 1.1, 0.15, -0.6]),
        qd: of([0.9, -0.5, 0.4, 1.2, -0.3, 0.7]),
        qdd: of([-1.1, 0.6, 0.8, -0.9, 1.4, 0.35]),
        base: None,
        wrench: None,
        payload: None,
    }
}

const WRENCH: Wrench<f64> = Wrench { force: [2.0, -1.5, 4.0], moment: [0.3, 0.7, -0.2] };

const ALL_AXES: [Axes; 3] = [Axes::Link, Axes::Joint, Axes::Base];

#[track_caller]
fn close(found: &[f64], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let scale = expected.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= 1e-12 * scale, "{what}: {found:?} is not {expected:?}");
    }
}

#[test]
fn every_line_is_the_recursion_in_base_axes() {
    let two = ["standard", "modified"].map(|convention| without_mass(six(convention)));
    let bodies = [six("standard"), six("modified"), shipped("stanford"), shipped("puma560"), shipped("puma560_mdh")];
    for robot in bodies.into_iter().chain(two) {
        let still = state(robot.dof());
        let pushed = Situation { wrench: Some(WRENCH), ..still.clone() };
        let base = BaseMotion {
            omega: [0.2, -0.1, 0.3],
            omega_dot: [0.5, 0.4, -0.6],
            velocity: [0.1, 0.2, -0.3],
            acceleration: [0.7, -0.2, 0.1],
            gravity: [1.0, 2.0, -9.0],
        };
        let moving = Situation { base: Some(base), ..pushed.clone() };
        for at in [still, pushed, moving] {
            let links = recursion(&robot, &at, |x| x);
            for axes in ALL_AXES {
                let sheet = Worksheet::new(&robot, &at, axes).unwrap();
                let lines = if axes == Axes::Base { 23 } else { 22 };
                assert_eq!(sheet.lines.len(), lines * robot.dof());
                for line in &sheet.lines {
                    let what = format!("{} {axes:?} {}", robot.name, line.symbol());
                    let expected = expected(&links, &robot, &at, axes, line.joint, line.quantity);
                    close(&line.values, &expected, &what);
                }
            }
        }
    }
}

/// Steps 3 and 4 are the derivatives of where the centres of mass are, which no recursion of velocities knows.
#[test]
fn velocities_and_accelerations_are_derivatives_of_positions() {
    for robot in [six("standard"), six("modified")] {
        let at = state(6);
        let sheet = Worksheet::new(&robot, &at, Axes::Base).unwrap();
        let h = 1e-4;
        let at_time = |t: f64| {
            let moved = at.q.iter().zip(&at.qd).zip(&at.qdd).map(|((q, qd), qdd)| q + qd * t + qdd * t * t / 2.0);
            placed(&robot, &moved.collect::<Vec<_>>()).centres
        };
        let (before, now, after) = (at_time(-h), at_time(0.0), at_time(h));
        for joint in 1..=6 {
            let i = joint - 1;
            let velocity = times(0.5 / h, sub(after[i], before[i]));
            let acceleration = times(1.0 / (h * h), add(sub(after[i], now[i]), sub(before[i], now[i])));
            for (quantity, expected) in [(Quantity::Velocity, velocity), (Quantity::Acceleration, acceleration)] {
                let found = &sheet.line(joint, quantity).unwrap().values;
                let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(off < 1e-6, "{joint} {quantity}: {found:?} {expected:?}");
            }
        }
    }
}

/// The numbers of the lecture's example, section 5.1 of the specification.
#[test]
#[allow(clippy::excessive_precision)] // as they stand there
fn the_lectures_one_link() {
    let text = "{format: 1, name: rod, source: the lecture, convention: standard, gravity: [9.81, 0, 0], joints: \
        [{type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0], inertia: \
        {yy: 2.5*0.64/12, zz: 2.5*0.64/12}}}]}";
    let robot = Robot::from_yaml(text).unwrap();
    let at = Situation { q: vec![0.6], qd: vec![1.3], qdd: vec![-0.7], ..state(1) };
    for axes in [Axes::Joint, Axes::Base] {
        let sheet = Worksheet::new(&robot, &at, axes).unwrap();
        for (quantity, numbers) in [
            (Quantity::Velocity, vec![-0.293_614_086_165_418_39, 0.429_174_519_753_032_71, 0.0]),
            (Quantity::Acceleration, vec![-0.399_826_983_128_332_63, -0.612_792_284_189_753_82, 0.0]),
            (Quantity::InertiaForce, vec![-0.999_567_457_820_831_57, -1.531_980_710_474_384_6, 0.0]),
            (Quantity::InertiaMoment, vec![0.0, 0.0, -0.093_333_333_333_333_333]),
            (Quantity::JointForce, vec![-25.524_567_457_820_832, -1.531_980_710_474_384_6, 0.0]),
            (Quantity::JointMoment, vec![0.0, 0.0, 5.165_809_330_671_963_5]),
            (Quantity::Tau, vec![5.165_809_330_671_963_5]),
        ] {
            close(&sheet.line(1, quantity).unwrap().values, &numbers, quantity.name());
        }
    }
    let sheet = Worksheet::new(&robot, &at, Axes::Link).unwrap();
    close(&sheet.line(1, Quantity::Acceleration).unwrap().values, &[-0.676, -0.28, 0.0], "c̈ in link axes");
}

/// A line is the sum of its terms, or there are none.
#[test]
fn terms_add_up() {
    let robots = shipped::tried().map(|file| Robot::from_yaml(file.yaml).unwrap());
    for robot in robots.chain([without_mass(six("standard"))]) {
        for rotors in [false, true] {
            let robot = Robot { rotors, ..robot.clone() };
            let payload = Payload { mass: 2.0, com: [0.1, 0.2, -0.3], ..Payload::none() };
            let at = state(robot.dof());
            for at in [Situation { payload: Some(payload), ..at.clone() }, Situation { wrench: Some(WRENCH), ..at }] {
                for sheet in ALL_AXES.map(|axes| Worksheet::new(&robot, &at, axes).unwrap()) {
                    for line in sheet.lines.iter().filter(|line| !line.terms.is_empty()) {
                        let what = format!("{} {:?} {}", robot.name, sheet.axes, line.symbol());
                        for (component, value) in line.values.iter().enumerate() {
                            let sum: f64 = line.terms.iter().map(|term| term.values[component]).sum();
                            assert!((sum - value).abs() <= 1e-12 * line.size().max(1.0), "{what}: {sum} {value}");
                        }
                        // a formula names its terms' letters
                        assert!(!line.formula.is_empty(), "{what}");
                    }
                }
            }
        }
    }
}

/// Every value of a worksheet, as somebody gives it.
fn all_values(sheet: &Worksheet) -> Vec<GivenValue> {
    let of_line = |line: &rne_diagnose::worksheet::Line| {
        let (joint, quantity) = (line.joint, line.quantity);
        let given =
            move |(component, &value): (usize, &f64)| GivenValue { joint, quantity, component, value, resolution: 0.0 };
        line.values.iter().enumerate().map(given).collect::<Vec<_>>()
    };
    sheet.lines.iter().flat_map(of_line).collect()
}

#[test]
fn a_worksheet_agrees_with_itself() {
    for robot in [six("standard"), shipped("stanford"), shipped("panda")] {
        let at = state(robot.dof());
        for sheet in ALL_AXES.map(|axes| Worksheet::new(&robot, &at, axes).unwrap()) {
            let given = all_values(&sheet);
            let Comparison { compared, differing, steps_not_given, first, .. } =
                sheet.compare(&robot, &at, &given, 15).unwrap();
            assert_eq!((compared, differing, steps_not_given, first), (given.len(), 0, vec![], None));
            let part: Vec<GivenValue> =
                given.into_iter().filter(|value| [1, 4, 7].contains(&value.quantity.step())).collect();
            let found = sheet.compare(&robot, &at, &part, 4).unwrap();
            assert_eq!((found.first, found.steps_not_given), (None, vec![2, 3, 5, 6]));
        }
    }
}

/// Each component made wrong, with all that comes behind it: it is the one that is named.
#[test]
fn the_first_wrong_component_is_named() {
    for (robot, axes) in
        [(six("standard"), Axes::Joint), (six("modified"), Axes::Link), (shipped("stanford"), Axes::Base)]
    {
        let at = state(robot.dof());
        let sheet = Worksheet::new(&robot, &at, axes).unwrap();
        let right = all_values(&sheet);
        // some of all, and more of a joint in the middle
        for (index, wrong) in right
            .iter()
            .enumerate()
            .filter(|(i, value)| i % 58 == 0 || (i % 3 == 0 && value.joint == 3 && axes == Axes::Joint))
        {
            let mut given = right.clone();
            for value in &mut given[index..] {
                let size = sheet.line(value.joint, value.quantity).unwrap().size();
                value.value += 0.2 * size + 0.01;
            }
            // in another order than that of computation
            given.reverse();
            let found = sheet.compare(&robot, &at, &given, 4).unwrap();
            let first = found.first.unwrap();
            let line = &sheet.lines[first.line];
            assert_eq!(
                (line.joint, line.quantity, first.component),
                (wrong.joint, wrong.quantity, wrong.component),
                "{}",
                robot.name
            );
            assert_eq!((first.ours, found.differing), (wrong.value, given.len() - index));
        }
    }
}

/// A term left out of a line is named, or one that is as large.
#[test]
fn a_term_that_is_left_out_is_named() {
    let robot = six("standard");
    let at = Situation { wrench: Some(WRENCH), ..state(6) };
    let mut named = 0;
    for (turn, axes) in ALL_AXES.into_iter().enumerate() {
        let sheet = Worksheet::new(&robot, &at, axes).unwrap();
        // each line in one of the three
        let lines = sheet.lines.iter().enumerate().filter(|(index, _)| index % 3 == turn);
        for (index, line) in lines.filter(|(_, line)| line.quantity.step() > 0) {
            for term in line.terms.iter().filter(|term| term.values.iter().any(|x| x.abs() > 0.05 * line.size())) {
                if line.terms.len() < 2 {
                    continue;
                }
                let mut given = all_values(&sheet);
                let before = sheet.lines[..index].iter().map(|line| line.values.len()).sum::<usize>();
                for (value, missing) in given[before..].iter_mut().zip(&term.values) {
                    value.value -= missing;
                }
                let found = sheet.compare(&robot, &at, &given, 4).unwrap().first.unwrap();
                let says: Vec<&str> = found.reasons.iter().map(|reason| reason.says.as_str()).collect();
                let expected = format!("the term {} is left out", term.text);
                assert!(says.iter().any(|says| says.contains(&expected)), "{axes:?} {}: {says:?}", line.symbol());
                named += 1;
            }
        }
    }
    assert!(named > 70, "{named}");
}

/// Who makes a slip everywhere hears of it, not of a term.
#[test]
fn a_slip_that_explains_every_value_comes_first() {
    let right = six("standard");
    let at = state(6);
    let text = |change: &dyn Fn(&mut Robot)| {
        let mut robot = right.clone();
        change(&mut robot);
        robot
    };
    let cases: [(Robot, Slip); 5] = [
        (text(&|robot| robot.gravity = [0.0, 0.0, 9.81]), Slip::GravityReversed),
        (text(&|robot| robot.gravity = [0.0; 3]), Slip::NoGravity),
        (text(&|robot| robot.convention = Convention::Modified), Slip::OtherConvention),
        (
            text(&|robot| {
                robot.joints.iter_mut().for_each(|joint| joint.row.link.com = joint.row.link.com.map(|c| -c));
            }),
            Slip::ComReversed,
        ),
        (
            text(&|robot| {
                robot.joints.iter_mut().for_each(|joint| {
                    let inertia = &mut joint.row.link.inertia;
                    (inertia.xy, inertia.xz, inertia.yz) = (-inertia.xy, -inertia.xz, -inertia.yz);
                });
            }),
            Slip::ProductsOfInertia,
        ),
    ];
    for axes in ALL_AXES {
        let sheet = Worksheet::new(&right, &at, axes).unwrap();
        for (wrong, slip) in &cases {
            let given = all_values(&Worksheet::new(wrong, &at, axes).unwrap());
            let first = sheet.compare(&right, &at, &given, 6).unwrap().first.unwrap();
            let reason = first.reasons.first().unwrap();
            assert_eq!(
                (reason.says.as_str(), reason.reach),
                (slip.says(&right).as_str(), Reach::Everything),
                "{axes:?}"
            );
        }
    }
}

/// The slips of steps that only a worksheet shows, and of one value.
#[test]
fn slips_on_one_line() {
    let robot = six("standard");
    let at = state(6);
    let sheet = Worksheet::new(&robot, &at, Axes::Link).unwrap();
    let told = |joint: usize, quantity: Quantity, change: &dyn Fn(&mut [f64])| {
        let mut values = sheet.line(joint, quantity).unwrap().values.clone();
        change(&mut values);
        let mut given = all_values(&sheet);
        for value in given.iter_mut().filter(|value| (value.joint, value.quantity) == (joint, quantity)) {
            value.value = values[value.component];
        }
        let first = sheet.compare(&robot, &at, &given, 4).unwrap().first.unwrap();
        first.reasons.into_iter().map(|reason| reason.says).collect::<Vec<_>>().join("\n")
    };
    assert!(told(4, Quantity::Omega, &|w| w.iter_mut().for_each(|x| *x = x.to_degrees())).contains("in degrees"));
    assert!(told(4, Quantity::Theta, &|t| t[0] = t[0].to_degrees()).contains("in degrees"));
    assert!(told(4, Quantity::Velocity, &|v| v.swap(0, 1)).contains("exchanged: y, x, z"));
    assert!(told(4, Quantity::JointForce, &|f| f[1] = -f[1]).contains("the sign is reversed"));
    assert!(told(4, Quantity::JointForce, &|f| f[1] = f[2]).contains("this is component z"));
    assert!(told(4, Quantity::Rotation, &|m| *m.get_mut(1).unwrap() *= -1.0).contains("the sign is reversed"));
    let transpose = |m: &mut [f64]| (m[1], m[3], m[2], m[6], m[5], m[7]) = (m[3], m[1], m[6], m[2], m[7], m[5]);
    assert!(told(4, Quantity::Rotation, &transpose).contains("transposed"));
    assert!(told(4, Quantity::Tau, &|t| t[0] *= 1000.0).contains("a thousand times"));
    // 2 q̇ ω × e of a sliding joint, once
    let coriolis = sheet.line(5, Quantity::Acceleration).unwrap().terms.last().unwrap().values.clone();
    let once = |c: &mut [f64]| c.iter_mut().zip(&coriolis).for_each(|(c, term)| *c -= term / 2.0);
    assert!(told(5, Quantity::Acceleration, &once).contains("without its factor 2"));
    // R for Rᵀ, and not turned at all
    let before = sheet.line(3, Quantity::Gravity).unwrap().values.clone();
    assert!(told(4, Quantity::Gravity, &|g| g.copy_from_slice(&before)).contains("it is not turned by R4ᵀ"));
}

/// Vectors that are right, but in the axes of frame i of a standard table: Rz(θ) Rx(α) turns them from frame to frame.
#[test]
fn axes_of_the_table_are_named() {
    let robot = six("standard");
    let at = state(6);
    let sheet = Worksheet::new(&robot, &at, Axes::Link).unwrap();
    let theta = |row: usize| sheet.line(row, Quantity::Theta).unwrap().values[0];
    let alphas: Vec<f64> = robot.rows().map(|row| row.dh.alpha.radians).collect();
    let mut to_table = ONE;
    let mut given = all_values(&sheet);
    given.retain(|value| value.quantity.step() > 0);
    let base = Worksheet::new(&robot, &at, Axes::Base).unwrap();
    for joint in 1..=6 {
        // from the axes of frame i to those of frame 0
        to_table = product(to_table, product(rz(theta(joint)), rx(alphas[joint - 1])));
        for value in given.iter_mut().filter(|value| value.joint == joint) {
            let line = base.line(joint, value.quantity).unwrap();
            if let [x, y, z] = line.values[..] {
                value.value = turn(transposed(to_table), [x, y, z])[value.component];
            }
        }
    }
    let first = sheet.compare(&robot, &at, &given, 4).unwrap().first.unwrap();
    let reason = first.reasons.first().unwrap();
    assert!(reason.says.contains("axes of frame i of the table"), "{reason:?}");
    assert_eq!(reason.reach, Reach::Everything);
    assert!(reason.right.as_ref().unwrap().contains("fixed to link i, z along joint i"), "{reason:?}");
    // with a mistake of its own in the last line, the axes still are the first reason
    let tau = given.iter_mut().rfind(|value| value.quantity == Quantity::Tau).unwrap();
    tau.value += 100.0;
    let first = sheet.compare(&robot, &at, &given, 4).unwrap().first.unwrap();
    let reason = first.reasons.first().unwrap();
    assert_eq!((reason.says.contains("frame i of the table"), reason.reach), (true, Reach::UpToHere), "{reason:?}");
    // other axes that have a name
    let mut given = all_values(&sheet);
    given.retain(|value| value.quantity.step() > 0);
    for value in &mut given {
        value.value = base.line(value.joint, value.quantity).unwrap().values[value.component];
    }
    let first = sheet.compare(&robot, &at, &given, 4).unwrap().first.unwrap();
    assert!(first.reasons[0].says.contains("`base`: those of frame 0"), "{:?}", first.reasons);
}

/// Of the misprints that no torque shows, the worksheet does.
#[test]
fn misprints_of_step_3_are_named() {
    let robot = six("standard");
    let mut at = state(6);
    at.q[2] = 0.35;
    let sheet = Worksheet::new(&robot, &at, Axes::Joint).unwrap();
    // ċ with b for ḃ, from the recursion with a wrong rate
    let mut given: Vec<GivenValue> = all_values(&sheet)
        .into_iter()
        .filter(|value| value.quantity == Quantity::Velocity && value.joint == 3)
        .collect();
    let b = sheet.line(3, Quantity::Offset).unwrap().values[0];
    given[2].value += b - at.qd[2];
    let first = sheet.compare(&robot, &at, &given, 4).unwrap().first.unwrap();
    assert!(first.reasons.iter().any(|reason| reason.says.contains("(E5)")), "{:?}", first.reasons);
}

/// So many significant digits.
fn digits(value: f64, count: usize) -> f64 {
    format!("{value:.0$e}", count - 1).parse().unwrap()
}

/// A hand that rounds every vector to four digits is right, to three it is not when four are asked for.
#[test]
fn a_hand_that_rounds_is_right() {
    for robot in [six("standard"), six("modified"), shipped("stanford"), shipped("puma560"), shipped("planar2")] {
        for shift in [0.0, 0.4, 1.3, FRAC_PI_2] {
            let mut at = state(robot.dof());
            at.q.iter_mut().for_each(|q| *q += shift);
            let sheet = Worksheet::new(&robot, &at, Axes::Base).unwrap();
            let by_hand = |count: usize| {
                let links = recursion(&robot, &at, |x| digits(x, count));
                let mut given = all_values(&sheet);
                for value in given.iter_mut().filter(|value| value.quantity.step() > 0) {
                    let line = expected(&links, &robot, &at, Axes::Base, value.joint, value.quantity);
                    value.value = digits(line[value.component], count);
                }
                sheet.compare(&robot, &at, &given, 4).unwrap()
            };
            let four = by_hand(4);
            assert_eq!(four.first, None, "{} {shift}", robot.name);
            assert!(by_hand(2).first.is_some(), "{} {shift}", robot.name);
        }
    }
}

/// Few digits are no mistake where they are rounded rightly, and no excuse for a term that is missing.
#[test]
fn written_digits_count() {
    let robot = shipped("planar2");
    let at = Situation { q: vec![0.6, -1.1], qd: vec![1.3, -0.4], qdd: vec![-0.7, 2.1], ..state(2) };
    let sheet = Worksheet::new(&robot, &at, Axes::Link).unwrap();
    let given = |value: f64, resolution: f64| {
        let given = GivenValue { joint: 2, quantity: Quantity::Acceleration, component: 0, value, resolution };
        sheet.compare(&robot, &at, &[given], 4).unwrap().first.is_none()
    };
    // c̈2 x is -0.233366
    assert!(given(-0.23, 0.005) && given(-0.2, 0.05) && given(-0.233, 0.0005));
    assert!(!given(-0.24, 0.005) && !given(-0.2, 0.0) && !given(0.0, 0.5));
}
