//! The lecture's recursion, typed here over vectors in the axes of frame 0, and the robots and states of the tests.

use rne_diagnose::worksheet::{Axes, GivenValue, Quantity, Situation, Worksheet};
use rne_model::{Convention, JointKind, Robot};
use rne_runtime::{BaseMotion, Wrench};

pub(crate) type V = [f64; 3];
pub(crate) type M = [V; 3];

pub(crate) fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn times(s: f64, a: V) -> V {
    a.map(|x| s * x)
}

pub(crate) fn sub(a: V, b: V) -> V {
    add(a, times(-1.0, b))
}

pub(crate) fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn turn(m: M, a: V) -> V {
    m.map(|row| dot(row, a))
}

pub(crate) fn transposed(m: M) -> M {
    [0, 1, 2].map(|j| [0, 1, 2].map(|i| m[i][j]))
}

pub(crate) fn product(a: M, b: M) -> M {
    let columns = transposed(b);
    a.map(|row| columns.map(|column| dot(row, column)))
}

pub(crate) fn rz(t: f64) -> M {
    [[t.cos(), -t.sin(), 0.0], [t.sin(), t.cos(), 0.0], [0.0, 0.0, 1.0]]
}

pub(crate) fn rx(t: f64) -> M {
    [[1.0, 0.0, 0.0], [0.0, t.cos(), -t.sin()], [0.0, t.sin(), t.cos()]]
}

pub(crate) const ONE: M = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Every number of a link, in the axes of frame 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link {
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
pub(crate) struct Placed {
    e: Vec<V>,
    fixed: Vec<M>,
    before: Vec<M>,
    theta: Vec<f64>,
    joints: Vec<V>,
    pub(crate) centres: Vec<V>,
    frames: Vec<M>,
    tip: (M, V),
}

/// From the rows, frame by frame.
pub(crate) fn placed(robot: &Robot, q: &[f64]) -> Placed {
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
pub(crate) fn recursion(robot: &Robot, at: &Situation, rounded: impl Fn(f64) -> f64) -> Vec<Link> {
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
pub(crate) fn expected(
    links: &[Link],
    robot: &Robot,
    at: &Situation,
    axes: Axes,
    joint: usize,
    quantity: Quantity,
) -> Vec<f64> {
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
pub(crate) fn six(convention: &str) -> Robot {
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

/// The robot whose links 2 and 5 have first moments and no mass instead.
pub(crate) fn without_mass(mut robot: Robot) -> Robot {
    for index in [1, 4] {
        let link = &mut robot.joints[index].row.link;
        link.first_moment = times(link.mass, link.com);
        (link.mass, link.com) = (0.0, [0.0; 3]);
    }
    robot
}

pub(crate) fn shipped(name: &str) -> Robot {
    Robot::from_yaml(rne_robots::find(name).unwrap().yaml).unwrap()
}

pub(crate) fn state(dof: usize) -> Situation {
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

pub(crate) const WRENCH: Wrench<f64> = Wrench { force: [2.0, -1.5, 4.0], moment: [0.3, 0.7, -0.2] };

pub(crate) const ALL_AXES: [Axes; 3] = [Axes::Link, Axes::Joint, Axes::Base];

#[track_caller]
pub(crate) fn close(found: &[f64], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let scale = expected.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= 1e-12 * scale, "{what}: {found:?} is not {expected:?}");
    }
}

/// Every value of a worksheet, as somebody gives it.
pub(crate) fn all_values(sheet: &Worksheet) -> Vec<GivenValue> {
    let of_line = |line: &rne_diagnose::worksheet::Line| {
        let (joint, quantity) = (line.joint, line.quantity);
        let given =
            move |(component, &value): (usize, &f64)| GivenValue { joint, quantity, component, value, resolution: 0.0 };
        line.values.iter().enumerate().map(given).collect::<Vec<_>>()
    };
    sheet.lines.iter().flat_map(of_line).collect()
}

/// So many significant digits.
pub(crate) fn digits(value: f64, count: usize) -> f64 {
    format!("{value:.0$e}", count - 1).parse().unwrap()
}
