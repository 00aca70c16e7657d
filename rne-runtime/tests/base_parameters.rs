//! What the torques see of the links: ranks that the literature knows, and torques from base parameters alone.

use crate::common::{dh, link, model, row, two_links};
use rne_model::JointKind::{Prismatic, Revolute};
use rne_model::{Convention, JointKind, Link, Robot, Row};
use rne_runtime::{BaseParameters, DynArm};

const DOWN: [f64; 3] = [0.0, 0.0, -9.81];

fn shipped(name: &str) -> DynArm {
    let path = format!("{}/../robots/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    DynArm::from_robot(&Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}")))
}

fn dense_link(index: usize) -> Link {
    let x = f64::from(u32::try_from(index).expect("a small number"));
    link(1.0 + x, [0.1, -0.2 + 0.01 * x, 0.3], [0.5, 0.6, 0.7, 0.01, -0.02, 0.03])
}

/// A row without zeros and right angles.
fn dense(kind: JointKind, index: usize) -> Row {
    Row { dh: dh([0.3, 0.7, 0.2, 0.4]), ..row(kind, [0.0; 4], dense_link(index)) }
}

fn dense_arm<const DOF: usize>(convention: Convention, gravity: [f64; 3], kinds: [JointKind; DOF]) -> DynArm {
    let mut index = 0;
    let rows = kinds.map(|kind| {
        index += 1;
        dense(kind, index)
    });
    DynArm::new(&model(convention, gravity, rows))
}

fn names(base: &BaseParameters) -> Vec<String> {
    let text = |(coefficient, parameter): &(f64, _)| format!(" + {coefficient:.4} {parameter}");
    let texts =
        base.parameters.iter().map(|base| base.kept.to_string() + &base.regrouped.iter().map(text).collect::<String>());
    texts.collect()
}

/// 36 for gravity along the first axis: Khalil, Dombre, Modeling, identification and control of robots, 2002,
/// chapter 9.
#[test]
fn puma_560_has_36() {
    for name in ["puma560", "puma560_mdh"] {
        let base = shipped(name).base_parameters();
        assert_eq!(base.rank(), 36, "{name}");
        // of the first link its moment of inertia about the axis is seen, and nothing else
        let first: Vec<String> =
            base.parameters.iter().filter(|base| base.kept.link == 0).map(|base| base.kept.to_string()).collect();
        assert_eq!(first, [if name == "puma560" { "Jyy1" } else { "Jzz1" }], "{name}");
    }
}

/// Seven per revolute joint but for the first, which turns about a fixed axis: one of ten, and two more where gravity
/// feels the first moments. Mayeda, Yoshida, Osuka, Base parameters of manipulator dynamic models, 1990.
#[test]
fn seven_per_revolute_joint() {
    for convention in [Convention::Standard, Convention::Modified] {
        let up = if convention == Convention::Modified {
            // axis 1 is turned away from z of frame 0 by the twist of its row
            [0.0, 9.81 * 0.7_f64.sin(), -9.81 * 0.7_f64.cos()]
        } else {
            DOWN
        };
        assert_eq!(dense_arm(convention, up, [Revolute; 3]).base_parameters().rank(), 1 + 7 * 2);
        let tilted = [3.0, 4.0, -8.0];
        assert_eq!(dense_arm(convention, tilted, [Revolute; 2]).base_parameters().rank(), 3 + 7);
        assert_eq!(dense_arm(convention, tilted, [Revolute; 6]).base_parameters().rank(), 3 + 7 * 5);
    }
    assert_eq!(shipped("iiwa14").base_parameters().rank(), 7 * 7 - 6);
}

/// Four per prismatic joint behind joints that turn it every way: its first moments and its mass.
#[test]
fn four_per_prismatic_joint() {
    let tilted = [3.0, 4.0, -8.0];
    let arm = dense_arm(Convention::Standard, tilted, [Revolute, Revolute, Prismatic]);
    assert_eq!(arm.base_parameters().rank(), 3 + 7 + 4);
    assert_eq!(shipped("gantry_ppp").base_parameters().rank(), 3, "three masses in a row");
}

/// One link: its inertia about the axis, and its first moments across it where gravity has a part there. Two: three
/// each.
#[test]
fn planar_arms() {
    let in_plane = [0.0, -9.81, 0.0];
    let arm = |gravity| DynArm::new(&two_links(Convention::Modified, gravity)).base_parameters();
    assert_eq!(
        names(&arm(in_plane)),
        ["Jzz1 + 0.6400 m2", "mcx1 + 0.8000 m2", "mcy1", "Jzz2", "mcx2", "mcy2"],
        "a1 = 0.8"
    );
    assert_eq!(names(&arm(DOWN)), ["Jzz1 + 0.6400 m2", "Jzz2", "mcx2", "mcy2"]);
    let base = arm(in_plane);
    assert_eq!(base.without_effect.len(), 20 - 7);
    assert_eq!(base.alone().count(), 4);
    let (first, second) = (&base.parameters[0], &base.parameters[1]);
    assert!((first.value - (2.5 * 0.8 * 0.8 / 3.0 + 0.64 * 1.5)).abs() < 1e-12, "{first:?}");
    assert!((second.value - (2.5 * 0.4 + 0.8 * 1.5)).abs() < 1e-12, "{second:?}");
}

/// The masses of the other links and their moments do not matter: τ = Y_b π_b.
#[test]
fn torques_from_base_parameters_alone() {
    let mut random = fastrand::Rng::with_seed(5);
    let arms =
        ["puma560", "puma560_mdh", "panda", "stanford", "scara_cobra600", "spherical_rrp", "ur5e", "wam7"].map(shipped);
    let dense = [Convention::Standard, Convention::Modified]
        .map(|convention| dense_arm(convention, DOWN, [Revolute, Revolute, Prismatic, Revolute, Prismatic, Revolute]));
    for arm in arms.iter().chain(&dense) {
        let base = arm.base_parameters();
        for _ in 0..20 {
            let mut list =
                |most: f64| -> Vec<f64> { (0..arm.dof()).map(|_| most * (2.0 * random.f64() - 1.0)).collect() };
            let (q, qd, qdd) = (list(3.0), list(2.0), list(5.0));
            let expected = arm.inverse_dynamics(&q, &qd, &qdd).expect("one per joint");
            let scale = expected.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
            let matrix = base.regressor(arm, &q, &qd, &qdd).expect("one per joint");
            for (row, expected) in matrix.iter().zip(&expected) {
                let torque: f64 = row.iter().zip(&base.parameters).map(|(y, base)| y * base.value).sum();
                assert!((torque - expected).abs() < 1e-10 * scale, "{torque} is not {expected}");
            }
        }
    }
}

#[test]
fn the_same_every_time() {
    let arm = shipped("panda");
    assert_eq!(arm.base_parameters(), arm.base_parameters());
}

/// The rank of the regressor at random states, by a singular value decomposition: what is below 1e-12 of the largest
/// singular value is rounding.
fn rank_in_double(arm: &DynArm) -> usize {
    let mut rng = fastrand::Rng::with_seed(31);
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for _ in 0..120 {
        let mut random = |most: f64| (0..arm.dof()).map(|_| most * (2.0 * rng.f64() - 1.0)).collect::<Vec<f64>>();
        let (q, qd, qdd) = (random(3.0), random(3.0), random(10.0));
        let matrix = arm.regressor(&q, &qd, &qdd).expect("a number per joint");
        rows.extend(matrix.into_iter().map(Vec::into_flattened));
    }
    let matrix = nalgebra::DMatrix::from_fn(rows.len(), rows[0].len(), |row, column| rows[row][column]);
    let values = matrix.singular_values();
    values.iter().filter(|value| **value > 1e-12 * values.max()).count()
}

/// `alpha: 1.5708` and a tilt of 1e-7 are no right angles. What they let the torques see on paper is less than
/// rounding.
#[test]
fn what_no_double_can_see_is_marked() {
    for (name, rank) in [("alphas_of_1.5708", 34), ("tilts_of_1e-7", 24)] {
        let path = format!("{}/../tests/nearly_right/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        let arm = DynArm::from_robot(&Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}")));
        let base = arm.base_parameters();
        assert_eq!(rank_in_double(&arm), rank, "{name}");
        assert_eq!((base.visible_rank, base.rank()), (rank, rank + 1), "{name}");
        // one combination is not seen: at least two parameters take part in it, and not all of them
        let hidden = base.parameters.iter().filter(|base| !base.is_visible).count();
        assert!((2..base.rank() / 2).contains(&hidden), "{name}: {hidden}");
    }
    for name in ["puma560", "panda", "stanford", "scara_cobra600"] {
        let arm = shipped(name);
        let base = arm.base_parameters();
        assert_eq!((rank_in_double(&arm), base.visible_rank), (base.rank(), base.rank()), "{name}");
        assert!(base.parameters.iter().all(|base| base.is_visible), "{name}");
    }
}
