//! The operational-space inertia and the dynamically consistent inverse of the Jacobian: closed forms, and laws of
//! shipped and random arms in which forward dynamics is the witness.

use fastrand::Rng;
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use rne::{Kinematics as _, MassMatrix as _, dynamically_consistent_inverse, operational_space_inertia};
use rne_model::Robot;

use crate::arm::{Arm, Maker};
use crate::arms;
use crate::check::{Conditioning, Worst, conditioning, flat};
use crate::trees;

/// An arm at a state, and rows of its Jacobian that are independent there.
struct Task {
    arm: Arm,
    q: Vec<f64>,
    mass: DMatrix<f64>,
    jacobian: DMatrix<f64>,
    rows: Vec<Vec<f64>>,
    /// By how much the two inverses magnify rounding.
    magnification: f64,
}

impl Task {
    /// A mass matrix that is regular, and as many rows in a random order as are well independent.
    fn of(robot: &Robot, rng: &mut Rng) -> Option<Self> {
        // accelerations by torques alone
        let robot = Robot { gravity: [0.0; 3], ..robot.clone() };
        let arm = Arm::by_no_choice(&robot, Maker::Runtime);
        let dof = robot.dof();
        let q: Vec<f64> = (0..dof).map(|_| 6.0 * rng.f64() - 3.0).collect();
        let mass = arm.mass_matrix(&q);
        let of_mass = conditioning(&mass).filter(|of| of.number < 1e6)?;
        let mass = DMatrix::from_row_iterator(dof, dof, flat(&mass));
        let inverse = mass.clone().lu().try_inverse()?;
        let all = arm.jacobian(&q);
        let mut order = [0, 1, 2, 3, 4, 5];
        rng.shuffle(&mut order);
        let (mut rows, mut number): (Vec<Vec<f64>>, f64) = (Vec::new(), 1.0);
        // a row of rounding errors is a row of zeros
        let is_there = |row: &usize| all[*row].iter().any(|element| element.abs() > 1e-3);
        for row in order.into_iter().filter(is_there) {
            let with = [&rows[..], &[all[row].clone()]].concat();
            let jacobian = DMatrix::from_row_iterator(with.len(), dof, flat(&with));
            let mobility = &jacobian * &inverse * jacobian.transpose();
            let mobility: Vec<Vec<f64>> = mobility.row_iter().map(|row| row.iter().copied().collect()).collect();
            if let Some(Conditioning { number: found, .. }) = conditioning(&mobility).filter(|of| of.number < 1e4) {
                (rows, number) = (with, found);
            }
        }
        let jacobian = DMatrix::from_row_iterator(rows.len(), dof, flat(&rows));
        let magnification = of_mass.number + number;
        (!rows.is_empty()).then_some(Self { arm, q, mass, jacobian, rows, magnification })
    }

    /// Λ and J̄.
    fn found(&self) -> [DMatrix<f64>; 2] {
        let (dof, task) = (self.q.len(), self.rows.len());
        let mut mass = self.arm.mass_matrix(&self.q);
        let mut rows = self.rows.clone();
        let inertia = rne::operational_space(&mut mass, &mut rows, vec![vec![0.0; task]; task]);
        let transposed = DMatrix::from_row_iterator(task, dof, flat(rows));
        [DMatrix::from_row_iterator(task, task, flat(inertia)), transposed.transpose()]
    }

    fn acceleration(&self, tau: &DVector<f64>) -> DVector<f64> {
        let still = vec![0.0; self.q.len()];
        DVector::from_vec(self.arm.forward_dynamics(&self.q, &still, tau.as_slice()))
    }

    /// The laws, each with its error as a part of the largest number in it and of the magnification.
    fn laws(&self, rng: &mut Rng, worst: &mut Worst) {
        let (dof, task) = (self.q.len(), self.rows.len());
        let [inertia, inverse] = self.found();
        assert_eq!(inertia, inertia.transpose(), "to the last bit");
        let mut any = |length: usize| DVector::from_fn(length, |_, _| 2.0 * rng.f64() - 1.0);
        let (force, torque) = (any(task), any(dof));
        let Self { mass, jacobian, .. } = self;
        let mut see = |law, found: DMatrix<f64>, scale: f64| {
            worst.see(law, found.amax() / scale / self.magnification);
        };

        // the definitions, by nalgebra's LU
        let columns = mass.clone().lu().solve(&jacobian.transpose()).expect("a regular matrix");
        let mobility = jacobian * &columns;
        see("Λ J M⁻¹ Jᵀ = 1", &inertia * &mobility - DMatrix::identity(task, task), inertia.amax() * mobility.amax());
        let expected = &columns * &inertia;
        see("J̄ = M⁻¹ Jᵀ Λ", &inverse - &expected, columns.amax() * inertia.amax());
        see("J J̄ = 1", jacobian * &inverse - DMatrix::identity(task, task), jacobian.amax() * inverse.amax());

        // physics, by forward dynamics: a force at the tip, and torques in the null space
        let qdd = self.acceleration(&(jacobian.transpose() * &force));
        let at_tip = jacobian * &qdd;
        let scale = inertia.amax() * jacobian.amax() * qdd.amax().max(at_tip.amax());
        see("Λ J q̈ = F", DMatrix::from_columns(&[&inertia * at_tip - &force]), scale);
        let projected = &torque - jacobian.transpose() * (inverse.transpose() * &torque);
        let scale = jacobian.amax() * self.acceleration(&torque).amax().max(self.acceleration(&projected).amax());
        see("J M⁻¹ Nᵀ τ = 0", DMatrix::from_columns(&[jacobian * self.acceleration(&projected)]), scale);
    }
}

/// Laws of many arms at random states; returns how many of them had a task.
fn laws_of(of: &str, robots: impl Iterator<Item = Robot>) -> usize {
    let mut rng = Rng::with_seed(87);
    let (mut worst, mut compared, mut redundant) = (Worst::default(), 0, 0);
    for robot in robots {
        if let Some(task) = Task::of(&robot, &mut rng) {
            task.laws(&mut rng, &mut worst);
            compared += 1;
            redundant += usize::from(task.rows.len() < task.q.len());
        }
    }
    println!("{of}: {compared} arms, {redundant} of them with fewer rows than joints");
    worst.at_most(1e-14, of);
    assert!(redundant > 0, "an arm with a null space");
    compared
}

#[test]
fn shipped_arms_obey_the_laws_at_the_tip_and_at_their_links() {
    let robots = rne_robots::ROBOTS.iter().flat_map(|file| {
        let robot = Robot::from_yaml(file.yaml).unwrap_or_else(|report| panic!("{report}"));
        let of_frames = robot.frame_ids().map(|frame| robot.clone().at_frame(frame)).collect::<Vec<_>>();
        of_frames.into_iter().chain([robot])
    });
    let compared = laws_of("shipped arms", robots);
    assert!(compared > 100, "{compared}");
}

#[test]
fn random_arms_obey_the_laws() {
    let robots = (0..500).map(|seed| Robot::from_yaml(&arms::yaml(seed)).unwrap_or_else(|report| panic!("{report}")));
    let compared = laws_of("random arms", robots);
    assert!(compared > 250, "{compared}");
}

#[test]
fn random_trees_obey_the_laws() {
    let compared = laws_of("random trees", (0..60).map(|seed| trees::random(seed, trees::dof(seed))));
    assert!(compared > 20, "{compared}");
}

/// Two links without mass but for points of 2 kg at the elbow and 1.5 kg at the tip.
const POINTS: &str = "
format: 1
name: points
source: textbook
convention: standard
gravity: [0, -9.81, 0]
joints:
  - {type: revolute, dh: {theta: 0, d: 0, a: 0.5, alpha: 0}, link: {mass: 2, com: [0, 0, 0], inertia: {}}}
  - {type: revolute, dh: {theta: 0, d: 0, a: 0.4, alpha: 0}, link: {mass: 1.5, com: [0, 0, 0], inertia: {}}}
";

#[test]
fn the_inertia_of_two_point_masses_is_the_closed_form() {
    let arm = rne::Arm::<2>::from_yaml(POINTS).expect("an arm");
    let mut rng = Rng::with_seed(88);
    for _ in 0..1000 {
        let q = [6.0 * rng.f64() - 3.0, 0.2 + 2.7 * rng.f64()];
        let [x, y, ..] = arm.jacobian(&q);
        let (mass, rows) = (arm.mass_matrix(&q), [x, y]);
        // T = ½ m₂ v·v + ½ m₁ a₁² q̇₁², and q̇₁ = (c₁₂ v_x + s₁₂ v_y)/(a₁ s₂)
        let along = Vector2::new((q[0] + q[1]).cos(), (q[0] + q[1]).sin());
        let expected = Matrix2::identity() * 1.5 + along * along.transpose() * (2.0 / q[1].sin().powi(2));
        let found = Matrix2::from(operational_space_inertia(&mass, &rows)).transpose();
        assert!((found - expected).amax() < 1e-12 * expected.amax() / q[1].sin().powi(2), "{q:?}: {found} {expected}");
        // as many rows as joints: the inverse of J itself
        let inverse = Matrix2::from(dynamically_consistent_inverse(&mass, &rows)).transpose();
        let expected = Matrix2::from(rows).transpose().try_inverse().expect("a regular pose");
        assert!((inverse - expected).amax() < 1e-12 * expected.amax() / q[1].sin().powi(2), "{q:?}");
    }
}

#[test]
fn a_null_space_of_two_slides_is_the_closed_form() {
    // 1 kg that slides on 3 kg, along the same line: J = [1 1], M = [4 1; 1 1], and only the lighter one moves
    let (mass, rows) = ([[4.0, 1.0], [1.0, 1.0]], [[1.0, 1.0]]);
    assert_eq!(operational_space_inertia(&mass, &rows), [[1.0]]);
    assert_eq!(dynamically_consistent_inverse(&mass, &rows), [[0.0], [1.0]]);
}

#[test]
fn arrays_and_vectors_have_the_same_bits_in_double_and_single_precision() {
    let arm = rne::Arm::<7>::from_yaml(rne_robots::find("panda").expect("shipped").yaml).expect("an arm");
    let q: [f64; 7] = [0.3, -0.8, 0.5, -1.9, 0.2, 1.4, -0.6];
    let (mass, jacobian) = (arm.mass_matrix(&q), arm.jacobian(&q));
    let (mut masses, mut rows) = (mass.map(|row| row.to_vec()), jacobian.map(|row| row.to_vec()));
    let inertia = rne::operational_space(&mut masses, &mut rows, vec![vec![0.0; 6]; 6]);
    let found = operational_space_inertia(&mass, &jacobian);
    assert_eq!(inertia, found.map(|row| row.to_vec()));
    let inverse = dynamically_consistent_inverse(&mass, &jacobian);
    assert_eq!(rows.concat(), (0..6).flat_map(|row| inverse.map(|of_joint| of_joint[row])).collect::<Vec<_>>());
    #[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
    let q = q.map(|angle| angle as f32);
    let single = operational_space_inertia(&arm.mass_matrix(&q), &arm.jacobian(&q));
    let largest = found.as_flattened().iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    for (single, double) in single.as_flattened().iter().zip(found.as_flattened()) {
        assert!((f64::from(*single) - double).abs() < 1e-4 * largest, "{single} {double}");
    }
}

#[test]
fn a_singular_pose_has_no_inertia_and_no_panic() {
    let arm = rne::Arm::<2>::from_yaml(POINTS).expect("an arm");
    let stretched: [f64; 2] = [0.4, 0.0];
    let ([x, y, z, ..], mass) = (arm.jacobian(&stretched), arm.mass_matrix(&stretched));
    for rows in [[x, y], [x, z]] {
        for numbers in [operational_space_inertia(&mass, &rows), dynamically_consistent_inverse(&mass, &rows)] {
            assert!(numbers.as_flattened().iter().any(|x| !x.is_finite() || x.abs() > 1e10), "{numbers:?}");
        }
    }
    // one row is enough there
    assert!(operational_space_inertia(&mass, &[y])[0][0].is_finite());
}
