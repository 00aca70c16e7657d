//! Whole computations with one slip each: every later number follows from it. The computation is typed here, in axes
//! fixed to each link with z along its joint, and shares nothing with the worksheet.

use rne_diagnose::worksheet::{Axes, GivenValue, Quantity, Reach, Situation, Worksheet};
use rne_model::{JointKind, Robot};

use crate::lecture::*;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Made {
    Nothing,
    GravityUp,
    NoGyroscopic,
    Degrees,
    CoriolisOnce,
    CoriolisReversed,
    ForceNotTurned,
    InertiaAboutOrigin,
    InertiaNotTwisted,
    /// R for Rᵀ where vectors go outward.
    TransposedOutward,
    /// Also Rᵀ for R where they come back.
    Transposed,
    /// The angle of joint 1 in the rotation of joint 2.
    AngleOfBefore,
    /// r of a link for that of the link before, in steps 3 and 4.
    OwnR,
    /// d of a sliding joint without its q.
    NoSlide,
    /// q of joint 2 with the other sign in its rotation.
    PositionReversed,
}

use Made::*;

const ALL: [Made; 15] = [
    Nothing,
    GravityUp,
    NoGyroscopic,
    Degrees,
    CoriolisOnce,
    CoriolisReversed,
    ForceNotTurned,
    InertiaAboutOrigin,
    InertiaNotTwisted,
    TransposedOutward,
    Transposed,
    AngleOfBefore,
    OwnR,
    NoSlide,
    PositionReversed,
];

/// The words that name a slip, on an arm on which it changes something.
fn words(made: Made) -> &'static str {
    match made {
        Nothing => "",
        GravityUp => "gravity points the other way",
        NoGyroscopic => "without ω × I ω",
        Degrees => "read as degrees",
        CoriolisOnce => "without its factor 2",
        CoriolisReversed => "has the other sign",
        ForceNotTurned => "is not turned",
        InertiaAboutOrigin => "inertias about the frame's origin are",
        InertiaNotTwisted => "the inertias are not turned by alpha",
        TransposedOutward => "R is used in place of Rᵀ in steps 1 to 5",
        Transposed => "R is used in place of Rᵀ, and Rᵀ in place of R",
        AngleOfBefore => "the angle of joint 2 is that of joint 1",
        OwnR => "r of the link itself is used in place of r of the link before",
        NoSlide => "q3 is left out",
        PositionReversed => "q2 has the other sign",
    }
}

/// Every value of steps 1 to 7, as a student writes it: five digits.
#[expect(clippy::too_many_lines, reason = "the seven steps in a row")]
fn computed(robot: &Robot, at: &Situation, made: Made) -> Vec<GivenValue> {
    let rows: Vec<_> = robot.rows().copied().collect();
    let to_rad = if made == Degrees { std::f64::consts::PI / 180.0 } else { 1.0 };
    let revolute = |i: usize| rows[i].kind == JointKind::Revolute;
    let q = |i: usize| at.q[i] * if revolute(i) { to_rad } else { 1.0 };
    let rates = |i: usize| [at.qd[i], at.qdd[i]].map(|x| x * if revolute(i) { to_rad } else { 1.0 });
    let theta = |i: usize| {
        let own = |i: usize| rows[i].dh.theta.radians + if revolute(i) { q(i) } else { 0.0 };
        match made {
            AngleOfBefore if i == 1 => own(0),
            PositionReversed if i == 1 => rows[1].dh.theta.radians - q(1),
            _ => own(i),
        }
    };
    // from link i to link i-1
    let rotation = |i: usize| {
        let twist = if i == 0 { 0.0 } else { rows[i - 1].dh.alpha.radians };
        product(rx(twist), rz(theta(i)))
    };
    let outward = |i: usize, v: V| match made {
        TransposedOutward | Transposed => turn(rotation(i), v),
        _ => turn(transposed(rotation(i)), v),
    };
    let inward = |i: usize, v: V| match made {
        Transposed => turn(transposed(rotation(i)), v),
        _ => turn(rotation(i), v),
    };
    let twist = |i: usize| rx(rows[i].dh.alpha.radians);
    let com = |i: usize| turn(twist(i), rows[i].link.com);
    let d = |i: usize| {
        let slide = if revolute(i) || made == NoSlide { 0.0 } else { at.q[i] };
        add([rows[i].dh.a, 0.0, rows[i].dh.d + slide], com(i))
    };
    let last = rows.len() - 1;
    let r = |i: usize| {
        let tool = if i == last { turn(twist(i), robot.tool.xyz) } else { [0.0; 3] };
        sub(tool, com(i))
    };
    let inertia = |i: usize| {
        let own = rows[i].link.inertia;
        let mut own = [[own.xx, own.xy, own.xz], [own.xy, own.yy, own.yz], [own.xz, own.yz, own.zz]];
        if made == InertiaAboutOrigin {
            let (m, c) = (rows[i].link.mass, rows[i].link.com);
            (0..3).for_each(|j| {
                (0..3).for_each(|k| own[j][k] += m * (if j == k { dot(c, c) } else { 0.0 } - c[j] * c[k]));
            });
        }
        if made == InertiaNotTwisted { own } else { product(product(twist(i), own), transposed(twist(i))) }
    };
    let e = [0.0, 0.0, 1.0];
    let gravity = if made == GravityUp { times(-1.0, robot.gravity) } else { robot.gravity };
    let (mut w, mut dw, mut dc, mut ddc, mut g, mut r_before) =
        ([0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3], gravity, [0.0; 3]);
    let mut values = Vec::new();
    let mut write = |i: usize, quantity: Quantity, vector: &[f64]| {
        for (component, &value) in vector.iter().enumerate() {
            let value: f64 = format!("{value:.4e}").parse().expect("a number");
            values.push(GivenValue { joint: i + 1, quantity, component, value, resolution: 0.0 });
        }
    };
    let mut moving = Vec::new();
    for i in 0..=last {
        let [qd, qdd] = rates(i);
        if made == OwnR && i > 0 {
            r_before = r(i);
        }
        let lever = add(cross(dw, r_before), cross(w, cross(w, r_before)));
        (dc, ddc) = (outward(i, add(dc, cross(w, r_before))), outward(i, add(ddc, lever)));
        (w, dw, g) = (outward(i, w), outward(i, dw), outward(i, g));
        if revolute(i) {
            w = add(w, times(qd, e));
            dw = add(dw, add(times(qdd, e), times(qd, cross(w, e))));
        }
        dc = add(dc, cross(w, d(i)));
        ddc = add(ddc, add(cross(dw, d(i)), cross(w, cross(w, d(i)))));
        if !revolute(i) {
            let factor = match made {
                CoriolisOnce => 1.0,
                CoriolisReversed => -2.0,
                _ => 2.0,
            };
            dc = add(dc, times(qd, e));
            ddc = add(ddc, add(times(qdd, e), times(factor * qd, cross(w, e))));
        }
        r_before = r(i);
        for (quantity, vector) in [
            (Quantity::Omega, w),
            (Quantity::OmegaDot, dw),
            (Quantity::Velocity, dc),
            (Quantity::Acceleration, ddc),
            (Quantity::Gravity, g),
        ] {
            write(i, quantity, &vector);
        }
        moving.push((w, dw, ddc, g));
    }
    let (mut next_f, mut next_n) = ([0.0; 3], [0.0; 3]);
    for i in (0..=last).rev() {
        let (w, dw, ddc, g) = moving[i];
        let m = rows[i].link.mass;
        let f = times(m, ddc);
        let mut n = turn(inertia(i), dw);
        if made != NoGyroscopic {
            n = add(n, cross(w, turn(inertia(i), w)));
        }
        if i < last {
            next_f = if made == ForceNotTurned { next_f } else { inward(i + 1, next_f) };
            next_n = inward(i + 1, next_n);
        }
        let joint_f = sub(add(f, next_f), times(m, g));
        let joint_n = add(add(n, next_n), add(cross(d(i), joint_f), cross(r(i), next_f)));
        let tau = if revolute(i) { joint_n[2] } else { joint_f[2] };
        for (quantity, vector) in [
            (Quantity::InertiaForce, &f[..]),
            (Quantity::InertiaMoment, &n),
            (Quantity::NextForce, &next_f),
            (Quantity::NextMoment, &next_n),
            (Quantity::JointForce, &joint_f),
            (Quantity::JointMoment, &joint_n),
            (Quantity::Tau, &[tau]),
        ] {
            write(i, quantity, vector);
        }
        (next_f, next_n) = (joint_f, joint_n);
    }
    values
}

/// Each slip, made in the whole computation of three arms, is the first reason; where it changes nothing, all agree.
#[test]
fn a_slip_of_a_whole_computation_is_named() {
    let mut named = Vec::new();
    for arm in ["planar2", "puma560", "stanford"] {
        let robot = shipped(arm);
        let n = u8::try_from(robot.dof()).expect("few joints");
        let list = |from: f64| (0..n).map(|i| (from + 1.7 * f64::from(i)).sin() + 0.2).collect::<Vec<_>>();
        let at = Situation { q: list(0.4), qd: list(1.9), qdd: list(3.1), base: None, wrench: None, payload: None };
        let sheet = Worksheet::new(&robot, &at, Axes::Link).expect("a sheet");
        let right = computed(&robot, &at, Nothing);
        for made in ALL {
            let given = computed(&robot, &at, made);
            let found = sheet.compare(&robot, &at, &given, 4).expect("a comparison");
            let Some(first) = found.first else {
                let off =
                    given.iter().zip(&right).filter(|(a, b)| (a.value - b.value).abs() > 1e-3 * b.value.abs().max(1.0));
                assert_eq!(off.count(), 0, "{arm} {made:?}");
                continue;
            };
            let says: Vec<_> = first.reasons.iter().map(|reason| (&reason.says, reason.reach)).collect();
            assert!(says.first().is_some_and(|(says, _)| says.contains(words(made))), "{arm} {made:?}: {says:#?}");
            let mut once: Vec<_> = says.iter().map(|(says, _)| says).collect();
            once.sort();
            once.dedup();
            assert_eq!(once.len(), says.len(), "{arm} {made:?}: {says:#?}");
            named.push((made, says[0].1));
            // one more number is mistyped: the slip is still the first reason, for it explains most values
            let mut mistyped = given.clone();
            let tau = mistyped.iter_mut().rfind(|value| value.quantity == Quantity::Tau).expect("a torque");
            tau.value += 100.0;
            let first = sheet.compare(&robot, &at, &mistyped, 4).expect("a comparison").first.expect("a difference");
            let says: Vec<_> = first.reasons.iter().map(|reason| &reason.says).collect();
            assert!(says.first().is_some_and(|says| says.contains(words(made))), "{arm} {made:?}, mistyped: {says:#?}");
        }
    }
    // each but the first was made on an arm that shows it, and all but a sign and a force explain the whole sheet
    for made in ALL.into_iter().filter(|made| *made != Nothing) {
        let reach = named.iter().filter(|(of, _)| *of == made).map(|(_, reach)| *reach).collect::<Vec<_>>();
        assert!(!reach.is_empty(), "{made:?} changes nothing");
        let whole =
            matches!(made, CoriolisReversed | ForceNotTurned) || reach.iter().all(|reach| *reach == Reach::Everything);
        assert!(whole, "{made:?}: {reach:?}");
    }
}

/// A cause of one component is not told of a vector of which another component is wrong, too.
#[test]
fn a_cause_explains_the_whole_vector() {
    let robot = shipped("puma560");
    let at = state(6);
    let sheet = Worksheet::new(&robot, &at, Axes::Link).expect("a sheet");
    let mut given = all_values(&sheet);
    let of_line = |value: &&mut GivenValue| (value.joint, value.quantity) == (5, Quantity::JointForce);
    for value in given.iter_mut().filter(of_line) {
        value.value = if value.component == 0 { -value.value } else { value.value + 3.7 };
    }
    let first = sheet.compare(&robot, &at, &given, 4).expect("a comparison").first.expect("a difference");
    assert!(first.reasons.iter().all(|reason| reason.reach != Reach::Component), "{:#?}", first.reasons);
}
