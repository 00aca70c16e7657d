//! The errata of the lecture's transcript, E1 to E22: what is printed fails, what is right passes.
//!
//! `rne_diagnose::lecture` is the lecture taken literally, with a switch for every slip. It is compared with `rne`'s
//! runtime robot, which computes in other frames. Two figures go with an erratum: how far the printed formula is off
//! for the six-joint arm of the specification, and for the worst of fifty random six-joint arms. The latter is the
//! "check" column of the specification's list of errata, drawn again, so half of it is asked for; where that list has
//! no such figure (E3, E9, E13, E22), it was measured here.
//!
//! There is no test of E12, indices that lost a character ([f_{-1,i}]_i for [f_{i-1,i}]_i): reading is all it takes.
#![allow(clippy::unreadable_literal, clippy::excessive_precision)] // the digits as the specification prints them

#[path = "errata/arms.rs"]
mod arms;

use std::fmt;

use arms::{
    ROD, Random, arms_of_the_table, one_link, one_link_state, one_link_with, prismatic_revolute,
    prismatic_revolute_state, revolute_prismatic, revolute_prismatic_state, six_joints, six_joints_loaded,
    six_joints_state, six_joints_two_without_mass, tensor, two_rods, two_rods_state,
};
use nalgebra::{Matrix3, Matrix4, Vector3};
use rne::{BaseMotion, DynArm, LinkTrace, Wrench};
use rne_diagnose::lecture::{LinkVectors, Misprint, State, place, seven_steps, turn, turn_back};
use rne_model::Link;

/// What "passes" means, relative to the largest number (or to 1, if all are smaller).
const TOLERANCE: f64 = 1e-13;

/// τ of the lecture's example.
const TAU: f64 = 5.1658093306719635;

/// The seven steps by `rne`, in the lecture's axes.
fn trace(arm: &DynArm, state: &State) -> Vec<LinkTrace<f64>> {
    let base = BaseMotion::fixed(state.gravity);
    arm.trace(&state.q, &state.qd, &state.qdd, &base, Some(&state.wrench)).unwrap().to_lecture()
}

/// The seven steps by the lecture.
fn lecture(arm: &DynArm, state: &State, slip: Option<Misprint>) -> Vec<LinkVectors> {
    seven_steps(arm.rows(), state, slip.as_slice())
}

fn relative_error(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    assert!(found.iter().chain(expected).all(|x| x.is_finite()), "{found:?} {expected:?}");
    let largest = expected.iter().fold(1.0_f64, |largest, x| largest.max(x.abs()));
    let differences = found.iter().zip(expected).map(|(found, expected)| (found - expected).abs());
    differences.fold(0.0, f64::max) / largest
}

#[track_caller]
fn assert_close(what: &str, found: &[f64], expected: &[f64]) {
    let error = relative_error(found, expected);
    assert!(error <= TOLERANCE, "{what}: {error:e}\n  found    {found:?}\n  expected {expected:?}");
}

/// How far the lecture is from `rne`.
#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    /// Of all τ_i.
    tau: f64,
    /// Of all ċ_i.
    velocity: f64,
}

impl Errors {
    fn of(arm: &DynArm, state: &State, slip: Option<Misprint>) -> Self {
        let (found, expected) = (lecture(arm, state, slip), trace(arm, state));
        let tau: [Vec<f64>; 2] =
            [found.iter().map(|link| link.tau).collect(), expected.iter().map(|link| link.tau).collect()];
        let velocity: [Vec<f64>; 2] = [
            found.iter().flat_map(|link| <[f64; 3]>::from(link.velocity)).collect(),
            expected.iter().flat_map(|link| link.velocity).collect(),
        ];
        Self { tau: relative_error(&tau[0], &tau[1]), velocity: relative_error(&velocity[0], &velocity[1]) }
    }

    /// The worst of fifty random arms R R P R P R.
    fn of_random_arms(slip: Option<Misprint>) -> Self {
        let mut random = Random::new(38);
        let all = (0..50).map(|_| Self::of(&random.six_joints(), &random.state(6), slip));
        all.fold(Self::default(), |worst, errors| Self {
            tau: worst.tau.max(errors.tau),
            velocity: worst.velocity.max(errors.velocity),
        })
    }
}

impl fmt::Display for Errors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "τ {:.1e} ċ {:.1e}", self.tau, self.velocity)
    }
}

/// Where a slip shows.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ShowsIn {
    Tau,
    /// And not in τ: no later step uses ċ.
    VelocityOnly,
}

/// As printed: off by at least `six_joints_error` for the arm of the specification, and by at least half of `check` for
/// the worst of the random arms. Corrected: both pass.
#[track_caller]
fn assert_erratum(slip: Misprint, shows_in: ShowsIn, six_joints_error: f64, check: f64) {
    let six_joints = |slip| Errors::of(&six_joints(), &six_joints_loaded(), slip);
    for (printed, right, least) in [
        (six_joints(Some(slip)), six_joints(None), six_joints_error),
        (Errors::of_random_arms(Some(slip)), Errors::of_random_arms(None), check / 2.0),
    ] {
        println!("{slip:?}: as printed {printed}, right {right}");
        assert!(right.tau <= TOLERANCE && right.velocity <= TOLERANCE, "right, but off by {right}");
        match shows_in {
            ShowsIn::Tau => assert!(printed.tau >= least, "{slip:?}: {printed}, expected τ off by {least}"),
            ShowsIn::VelocityOnly => {
                assert!(printed.velocity >= least, "{slip:?}: {printed}, expected ċ off by {least}");
                assert!(printed.tau <= TOLERANCE, "{slip:?}: {printed}, but τ does not use ċ");
            }
        }
    }
}

/// Without a slip the lecture is right: every vector of steps 1 to 7, for every arm of the specification's section 5.
#[test]
fn the_lecture_without_slips() {
    let rods_tip = Wrench { force: [3.0, -2.0, 0.0], moment: [0.0, 0.0, 0.5] };
    for (name, arm, state) in [
        ("5.1", one_link(), one_link_state()),
        ("5.2", two_rods(), two_rods_state()),
        ("5.2, tip wrench", two_rods(), State { wrench: rods_tip, ..two_rods_state() }),
        ("5.3", revolute_prismatic(), revolute_prismatic_state()),
        ("5.4", prismatic_revolute(), prismatic_revolute_state()),
        ("5.5", six_joints(), six_joints_state()),
        ("5.5, tip wrench", six_joints(), six_joints_loaded()),
        ("5.5, first moments", six_joints_two_without_mass(), six_joints_loaded()),
    ] {
        let placed = place(arm.rows(), &state.q, &[]);
        for (i, (found, expected)) in lecture(&arm, &state, None).iter().zip(trace(&arm, &state)).enumerate() {
            for (what, found, expected) in [
                ("d", placed[i].d, expected.d),
                ("r", placed[i].r, expected.r),
                ("ω", found.omega, expected.omega),
                ("ω̇", found.omega_dot, expected.omega_dot),
                ("ċ", found.velocity, expected.velocity),
                ("c̈", found.acceleration, expected.acceleration),
                ("g", found.gravity, expected.gravity),
                ("f", found.inertia_force, expected.inertia_force),
                ("n", found.inertia_moment, expected.inertia_moment),
                ("f_{i-1,i}", found.joint_force, expected.joint_force),
                ("n_{i-1,i}", found.joint_moment, expected.joint_moment),
            ] {
                assert_close(&format!("{name}, link {}, {what}", i + 1), found.as_slice(), &expected);
            }
            assert_close(&format!("{name}, τ_{}", i + 1), &[found.tau], &[expected.tau]);
        }
    }
    let tau = |arm, state| trace(&arm, &state).iter().map(|link| link.tau).collect::<Vec<_>>();
    assert_close("5.1", &tau(one_link(), one_link_state()), &[TAU]);
    assert_close("5.2", &tau(two_rods(), two_rods_state()), &[9.1083282182418484, -2.5209408206288769]);
    let six = [
        -6.7854247044385871,
        18.802844548526256,
        41.232002870594765,
        0.26907309091123066,
        -3.9459563659845217,
        0.35896406813215266,
    ];
    assert_close("5.5, tip wrench", &tau(six_joints(), six_joints_loaded()), &six);
}

/// E1, step 1. Printed: third column of Qᵀ (0, -1, -1). Right: (0, sα, cα).
#[test]
fn e1_third_column_of_q_transposed() {
    let of_a_rotation = |slip: Option<Misprint>| {
        let qt = turn_back(0.6, 0.9, slip.as_slice());
        ((qt * qt.transpose() - Matrix3::identity()).amax(), qt.determinant())
    };
    let (from_one, determinant) = of_a_rotation(Some(Misprint::E1ThirdColumn));
    println!("|QᵀQ - 1| {from_one:.4}, det {determinant:.4}");
    assert!((from_one - 0.61).abs() < 0.005, "|QᵀQ - 1| = {from_one}");
    assert!((determinant + 1.40).abs() < 0.005, "det = {determinant}");
    let (from_one, determinant) = of_a_rotation(None);
    assert!(from_one <= 1e-15 && (determinant - 1.0).abs() <= 1e-15);

    assert_erratum(Misprint::E1ThirdColumn, ShowsIn::Tau, 0.93, 6.8);
}

/// E2, step 1. Printed: Q_{i-1} is frame i with respect to frame i+1. Right: frame i with respect to frame i-1.
#[test]
fn e2_what_q_turns() {
    assert_erratum(Misprint::E2WrongQ, ShowsIn::Tau, 0.51, 3.7);
}

/// E3, step 2. Printed: ω_i = ω̇_{i-1} + …. Right: ω̇_i = ….
#[test]
fn e3_left_side_of_step_2() {
    let [printed, right] =
        [Some(Misprint::E3LeftSide), None].map(|slip| lecture(&one_link(), &one_link_state(), slip)[0]);
    // Left 1.3 from step 1, right side -0.7.
    assert_eq!((right.omega.z, right.omega_dot.z), (1.3, -0.7));
    assert_eq!((printed.omega.z, printed.omega_dot.z), (-0.7, 0.0));
    assert_erratum(Misprint::E3LeftSide, ShowsIn::Tau, 0.05, 3.0);
}

/// E4, step 2, P. Printed: Q_{i-1}ᵀ [ω̇_{i-1}]_i. Right: Q_{i-1}ᵀ [ω̇_{i-1}]_{i-1}.
#[test]
fn e4_frame_of_the_previous_angular_acceleration() {
    assert_erratum(Misprint::E4TurnedTwice, ShowsIn::Tau, 0.012, 2.8);
}

/// E5, step 3, P. Printed: … + b_i e_i. Right: … + ḃ_i e_i.
#[test]
fn e5_velocity_of_a_slide() {
    assert_erratum(Misprint::E5NoDot, ShowsIn::VelocityOnly, 0.54, 2.7);
}

/// E6, step 3. Spoken: r_{i-1} × ω_{i-1}. Right: ω_{i-1} × r_{i-1}.
#[test]
fn e6_factors_of_a_cross_product() {
    assert_erratum(Misprint::E6FactorsSwapped, ShowsIn::VelocityOnly, 0.29, 1.6);
}

/// E7, step 3. Printed: [r_i]_i = (r_ix, r_iy, r_iz). Right: [r_i]_i = Q_i (r_ix, r_iy, r_iz).
#[test]
fn e7_where_r_is_constant() {
    assert_erratum(Misprint::E7ConstantR, ShowsIn::Tau, 0.017, 0.79);
}

/// E8, step 3. Spoken: d_i is the joint offset. Right: d_i = O_i → C_i = a_i - r_i, which contains the offset b_i e_i.
#[test]
fn e8_d_is_not_the_offset() {
    assert_erratum(Misprint::E8OffsetForD, ShowsIn::Tau, 0.042, 2.3);
}

/// E9, step 3. Spoken: a_i connects O_{i-1} to O_i. Right: O_i to O_{i+1} in this numbering.
#[test]
fn e9_what_a_connects() {
    let (arm, state) = (six_joints(), six_joints_state());
    let mut previous: Option<Matrix4<f64>> = None;
    for (row, (placed, &q)) in arm.rows().iter().zip(place(arm.rows(), &state.q, &[]).iter().zip(&state.q)) {
        let [about, along] = if row.kind == rne_model::JointKind::Revolute { [q, 0.0] } else { [0.0, q] };
        let t = Matrix4::new_rotation((row.dh.theta.radians + about) * Vector3::z())
            * Matrix4::new_translation(&((row.dh.d + along) * Vector3::z()))
            * Matrix4::new_translation(&(row.dh.a * Vector3::x()))
            * Matrix4::new_rotation(row.dh.alpha.radians * Vector3::x());
        let from_to = |t: &Matrix4<f64>| t.fixed_view::<3, 1>(0, 3).into_owned();
        let rotation = |t: &Matrix4<f64>| t.fixed_view::<3, 3>(0, 0).into_owned();
        assert!((rotation(&t) - placed.turn).amax() <= 4e-16, "T_i turns as Q_i does");
        assert!((from_to(&t) - placed.a).amax() <= 4e-16, "T_i leads from O_i to O_{{i+1}}: {t} {}", placed.a);
        if let Some(previous) = previous {
            let printed = rotation(&previous).transpose() * from_to(&previous);
            assert!((printed - placed.a).norm() > 0.1, "O_{{i-1}} → O_i in frame i: {printed} {}", placed.a);
        }
        previous = Some(t);
    }
    assert_erratum(Misprint::E9FramesBefore, ShowsIn::Tau, 0.14, 1.5);
}

/// E10, step 6. Printed: [f_{i,i+1}]_i and [n_{i,i+1}]_i, as if they were there. Right: [f_{i,i+1}]_i = Q_i
/// [f_{i,i+1}]_{i+1}, the same for n.
#[test]
fn e10_wrench_of_the_next_joint() {
    assert_erratum(Misprint::E10ForceNotTurned, ShowsIn::Tau, 0.44, 1.7);
    assert_erratum(Misprint::E10MomentNotTurned, ShowsIn::Tau, 0.54, 2.5);
}

/// E11, step 6. Printed: [I]_i, as if it were constant. Right: [I_i]_i = Q_i [I_i]_{i+1} Q_iᵀ.
#[test]
fn e11_inertia_turns() {
    assert_erratum(Misprint::E11InertiaNotTurned, ShowsIn::Tau, 5.4e-4, 4.4e-2);
}

/// E13, step 5. Spoken: starts from 0, the ground frame. Right: the base frame is frame 1, [g]_1 is given and Q_0 = 1.
#[test]
fn e13_the_ground_is_frame_1() {
    let (arm, state) = (one_link(), one_link_state());
    let [printed, right] = [Some(Misprint::E13GroundFrame), None].map(|slip| lecture(&arm, &state, slip)[0]);
    assert_eq!(right.gravity, Vector3::new(9.81, 0.0, 0.0));
    assert_close("τ", &[right.tau], &[TAU]);
    // Turned once too often: (g cθ, -g sθ, 0).
    assert_close("g", printed.gravity.as_slice(), &[8.0965423822639441, -5.5391426640052969, 0.0]);
    assert!((printed.tau - TAU).abs() > 3.6, "τ = {}", printed.tau);
    assert_erratum(Misprint::E13GroundFrame, ShowsIn::Tau, 0.94, 5.0);
}

/// E14, inertia. Printed: I_zx = I_xz = ∫ y z ρ dV. Right: -∫ z x ρ dV.
#[test]
fn e14_product_of_inertia() {
    let masses =
        [(1.0, [0.3, 0.1, -0.2]), (2.0, [-0.1, 0.4, 0.2]), (1.5, [0.2, -0.3, 0.5])].map(|(m, p)| (m, Vector3::from(p)));
    let as_printed = |masses: &[(f64, Vector3<f64>)]| masses.iter().map(|(m, p)| m * p.y * p.z).sum::<f64>();
    assert_close("right", &[tensor(&masses).xz], &[-0.050]);
    assert_close("as printed", &[as_printed(&masses)], &[-0.085]);

    // The three masses turn about z, without gravity. What does the joint feel about x and y?
    let state = State { gravity: [0.0; 3], ..one_link_state() };
    let (omega, omega_dot) = (state.qd[0] * Vector3::z(), state.qdd[0] * Vector3::z());
    let newton = masses.iter().map(|(m, p)| {
        let p = turn(state.q[0], 0.0) * p;
        p.cross(&(*m * (omega_dot.cross(&p) + omega.cross(&omega.cross(&p)))))
    });
    let newton: Vector3<f64> = newton.sum();

    let mass = masses.iter().map(|(m, _)| m).sum::<f64>();
    let centre = masses.iter().map(|(m, p)| *m * p).sum::<Vector3<f64>>() / mass;
    let about_centre = masses.map(|(m, p)| (m, p - centre));
    let right =
        Link { mass, com: (centre - ROD.1 * Vector3::x()).into(), inertia: tensor(&about_centre), ..Link::default() };
    let mut printed = right;
    printed.inertia.xz = as_printed(&about_centre);
    let moment = |link| trace(&one_link_with(link), &state)[0].joint_moment;
    assert_close("n_01", &moment(right), newton.as_slice());
    let error = relative_error(&moment(printed), newton.as_slice());
    println!("I_zx as printed: n_01 off by {error:.3}");
    assert!(error > 0.1, "n_01 off by {error}");
}

/// E15, inertia. Spoken: I_i is positive definite. Right: semidefinite, the lecture's own rod has the eigenvalue 0.
#[test]
fn e15_a_rod_is_not_positive_definite() {
    let rod = Matrix3::from(one_link().rows()[0].link.inertia.rows());
    let mut eigenvalues: [f64; 3] = rod.symmetric_eigenvalues().into();
    eigenvalues.sort_by(f64::total_cmp);
    assert_close("eigenvalues", &eigenvalues, &[0.0, 0.4 / 3.0, 0.4 / 3.0]);
    assert_eq!(eigenvalues[0], 0.0);
    assert!(rod.cholesky().is_none(), "a positive definite matrix has a Cholesky factor");
    // Robot files take it.
    assert!(DynArm::from_file(concat!(env!("CARGO_MANIFEST_DIR"), "/robots/planar1.yaml")).is_ok());
}

/// E16, example. Printed: [n_01]_1 contains (m a²/4) θ̇. Right: (m a²/4) θ̈.
#[test]
fn e16_moment_at_the_joint() {
    let (m, a) = ROD;
    let (theta, rate, rate_dot): (f64, f64, f64) = (0.6, 1.3, -0.7);
    let n_01 = |of_the_centre: f64| {
        m * a * a / 12.0 * rate_dot + m * a * a / 4.0 * of_the_centre + m * 9.81 * a / 2.0 * theta.sin()
    };
    let joint_moment = trace(&one_link(), &one_link_state())[0].joint_moment;
    assert_close("right", &[0.0, 0.0, n_01(rate_dot)], &joint_moment);
    assert!((n_01(rate_dot) - 5.165809).abs() < 5e-7);
    assert!((n_01(rate) - 5.965809).abs() < 5e-7);
    assert!((n_01(rate) - joint_moment[2]).abs() > 0.79);
}

/// E17, example. Printed: e = (1, 0, 0). Right: (0, 0, 1), as spoken.
#[test]
fn e17_axis_of_the_joint() {
    let (arm, state) = (one_link(), one_link_state());
    assert_eq!(lecture(&arm, &state, Some(Misprint::E17AxisX))[0].omega, Vector3::new(1.3, 0.0, 0.0));
    // Step 7 alone: n_01 is right and has no element along x.
    let n_01 = Vector3::from(trace(&arm, &state)[0].joint_moment);
    assert_eq!(n_01.dot(&Vector3::x()), 0.0);
    assert_close("τ", &[n_01.dot(&Vector3::z())], &[TAU]);
    assert_erratum(Misprint::E17AxisX, ShowsIn::Tau, 1.35, 5.8);
}

/// E18, example. Printed: backward for i = 2, 1. Right: for i = 1 only, from [f_12]_2 = [n_12]_2 = 0.
#[test]
fn e18_one_link_has_no_second_step_backward() {
    let (arm, state) = (one_link(), one_link_state());
    assert_eq!(state.wrench, Wrench::zero());
    let right = lecture(&arm, &state, None);
    assert_eq!(right.len(), 1);
    assert_close("τ", &[right[0].tau], &[TAU]);
    // Passing i = 2 means a second link, and its wrench does not vanish.
    let printed = lecture(&two_rods(), &two_rods_state(), None);
    assert_close("τ_1", &[printed[0].tau], &[9.1083282182418484]);
    assert!((printed[0].tau - TAU).abs() > 3.9);
}

/// E19, example. Spoken: Q I Qᵀ is equivalent to the parallel axis theorem. Right: it keeps I_zz = m a²/12; the rest,
/// m a²/4, comes from d × f_01.
#[test]
fn e19_a_rotation_moves_no_axis() {
    let state = State { gravity: [0.0; 3], ..one_link_state() };
    let placed = place(one_link().rows(), &state.q, &[])[0];
    let link = trace(&one_link(), &state)[0];
    let about_joint = link.tau / state.qdd[0];
    let turned = placed.inertia[(2, 2)];
    let lever = placed.d.cross(&Vector3::from(link.joint_force)).z / state.qdd[0];
    println!("{turned:.4} + {lever:.4} = {about_joint:.4}");
    assert_close("Q I Qᵀ", &[turned], &[0.4 / 3.0]);
    assert_close("d × f_01", &[lever], &[0.4]);
    assert_close("τ/θ̈", &[about_joint], &[1.6 / 3.0]);
    assert_close("τ/θ̈", &[about_joint], &[turned + lever]);
    assert!((turned - about_joint).abs() > 0.39, "as printed: equal");
}

/// E20, example. Printed: I without a frame, [r]_2 without a link. Right: I is [I_1]_2, r is [r_1]_2.
#[test]
fn e20_frames_of_the_example() {
    let (arm, state) = (one_link(), one_link_state());
    let rod = one_link().rows()[0].link.inertia.rows();
    let along = turn(state.q[0], 0.0) * Vector3::x();

    // I in frame 1? A rod has no inertia about itself.
    assert!((Matrix3::from(rod) * along).norm() > 0.07);
    assert!((place(arm.rows(), &state.q, &[])[0].inertia * along).norm() <= 1e-16);

    // r in frame 1? The centre of mass is then no longer half way.
    let d = |slip: Option<Misprint>| place(arm.rows(), &state.q, slip.as_slice())[0].d;
    assert!((d(Some(Misprint::E7ConstantR)) - 0.4 * along).norm() > 0.2);
    assert!((d(None) - 0.4 * along).norm() <= 1e-16);
    let tau = |slip| lecture(&arm, &state, slip)[0].tau;
    assert!((tau(Some(Misprint::E7ConstantR)) - TAU).abs() > 5.0, "{}", tau(Some(Misprint::E7ConstantR)));
    assert_close("τ", &[tau(None)], &[TAU]);
}

/// E21, the first Newton-Euler slide. Printed: O_{i-1} and O_i at the two ends of link i,
///
/// ```text
/// n_{i-1,i} = n_{i,i+1} + (r_{i-1,i} + r_{i,Ci}) × f_{i-1,i} - r_{i,Ci} × f_{i,i+1} + n_i
/// ```
///
/// Right: the numbering is shifted against the seven steps. Their O_i and O_{i+1} are meant, so r_{i-1,i} = a_i, and
/// r_{i,Ci} = O_{i+1} → C_i = -r_i.
#[test]
fn e21_numbering_of_the_free_body_diagram() {
    let (arm, state) = (six_joints(), six_joints_loaded());
    let (links, found) = (place(arm.rows(), &state.q, &[]), trace(&arm, &state));
    let (mut force, mut moment) = state.wrench.vectors();
    for i in (0..6).rev() {
        (force, moment) = (links[i].turn * force, links[i].turn * moment);
        let (joint_force, inertia_moment): (Vector3<f64>, Vector3<f64>) =
            (found[i].joint_force.into(), found[i].inertia_moment.into());
        let slide = |r_before: Vector3<f64>, r_centre: Vector3<f64>| {
            moment + (r_before + r_centre).cross(&joint_force) - r_centre.cross(&force) + inertia_moment
        };
        let right = slide(links[i].a, -links[i].r);
        assert_close(&format!("n of joint {}", i + 1), right.as_slice(), &found[i].joint_moment);

        // With the numbers of the seven steps: r_{i-1,i} = O_{i-1} → O_i, r_{i,Ci} = O_i → C_i.
        let before = i.checked_sub(1).map_or_else(Vector3::zeros, |k| links[k].turn.transpose() * links[k].a);
        let error = relative_error(slide(before, links[i].d).as_slice(), &found[i].joint_moment);
        println!("joint {}: as printed off by {error:.3}", i + 1);
        assert!(error > 0.05, "joint {}: {error}", i + 1);

        (force, moment) = (joint_force, found[i].joint_moment.into());
    }
}

/// E22, step 1. Printed: ω_i = ω_{i-1}, for any link. Right: for P joints only; R adds θ̇_i e_i.
#[test]
fn e22_a_turning_joint_adds_its_rate() {
    let omega = |slip| lecture(&one_link(), &one_link_state(), slip)[0].omega.z;
    assert_eq!((omega(Some(Misprint::E22NoJointRate)), omega(None)), (0.0, 1.3));
    assert_erratum(Misprint::E22NoJointRate, ShowsIn::Tau, 0.041, 2.0);
}

/// "Which arm notices which slip", section 7: largest relative error of τ over twenty states, 0 where the arm does not
/// notice. One-link, planar two-link and SCARA arms notice neither E11, nor the Coriolis factor, nor the gyroscopic
/// moment; the arm R R P R P R notices everything.
#[test]
fn which_arm_notices_which_slip() {
    const NEVER: f64 = 0.0;
    let names = ["R", "RR", "RP", "PR", "RRP", "RRPR", "3R", "RPR", "PPR", "6dof"];
    let table = [
        (Misprint::E1ThirdColumn, [NEVER, 16.0, 7.7, 1.3, 6.4, 2.9, 4.0, 22.0, 1.3, 8.2]),
        (Misprint::E4TurnedTwice, [NEVER, NEVER, 1.3, NEVER, 0.13, 0.20, NEVER, 0.28, NEVER, 0.64]),
        (Misprint::E8OffsetForD, [NEVER, NEVER, 0.68, NEVER, 0.19, 0.28, NEVER, 0.24, NEVER, 0.64]),
        (Misprint::E11InertiaNotTurned, [NEVER, NEVER, 1e-3, NEVER, NEVER, NEVER, 0.05, 7e-3, 3e-3, 0.01]),
        (Misprint::E10MomentNotTurned, [NEVER, NEVER, 4.1, NEVER, 2.6, 1.8, 2.0, 0.97, 0.68, 2.6]),
        (Misprint::CoriolisOnce, [NEVER, NEVER, 0.54, NEVER, NEVER, NEVER, NEVER, 0.46, NEVER, 0.31]),
        (Misprint::NoGyroscopicMoment, [NEVER, NEVER, NEVER, NEVER, NEVER, NEVER, 0.03, 2e-3, NEVER, 0.01]),
    ];
    let arms = arms_of_the_table();
    assert_eq!(arms.each_ref().map(|(name, _)| *name), names);
    for (slip, expected) in table {
        for ((name, arm), expected) in arms.iter().zip(expected) {
            let mut random = Random::new(7);
            let states = (0..20).map(|_| random.state(arm.dof()));
            let error = states.map(|state| Errors::of(arm, &state, Some(slip)).tau).fold(0.0, f64::max);
            println!("{slip:?}, {name}: {error:.1e}");
            if expected == NEVER {
                assert!(error <= TOLERANCE, "{slip:?}: {name} notices, {error:e}");
            } else {
                // Other states, and for the last arm other links, than those of the table: the order of magnitude.
                assert!((expected / 10.0..expected * 10.0).contains(&error), "{slip:?}: {name} {error:e}");
            }
        }
    }
}
