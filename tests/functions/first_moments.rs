//! Links with a first moment and without mass, which no body has: against bodies, by linearity, and against the arms
//! whose base parameters they are.

use nalgebra::{Matrix3, Vector3};
use rne::{DynArm, Scalar};
use rne_codegen::{Arguments, Compiler, Form, Function, Interpreter};
use rne_model::{Inertia, InertiaReference, Link, Reader, Robot};

use crate::arm::{Arm, Maker, of_runtime};
use crate::case::{Case, cases, largest};
use crate::check::{Conditioning, Worst, conditioning, error_on_scale, product};

/// What is linear in mass, first moment and inertia of a link. Forward dynamics is not, the regressor has no part in
/// it, and the centre of mass is divided by the mass.
const LINEAR: [Function; 19] = [
    Function::InverseDynamics,
    Function::InverseDynamicsWithWrench,
    Function::InverseDynamicsWithPayload,
    Function::InverseDynamicsFromSinCos,
    Function::InverseDynamicsOnMovingBase,
    Function::InverseDynamicsOfFloatingBase,
    Function::FloatingMassMatrix,
    Function::FloatingBias,
    Function::FloatingGravityTorques,
    Function::GravityTorques,
    Function::BiasTorques,
    Function::CoriolisTorques,
    Function::MassMatrix,
    Function::CoriolisMatrix,
    Function::InverseDynamicsDerivatives,
    Function::JointWrenches,
    Function::KineticEnergy,
    Function::PotentialEnergy,
    Function::ActuatorTorques,
];

/// The link of a table from its parameters about the origin of its frame.
fn link(mass: f64, h: Vector3<f64>, j: Matrix3<f64>) -> Link {
    let centre = if mass == 0.0 { Vector3::zeros() } else { h / mass };
    let i = j - (Matrix3::identity() * centre.dot(&centre) - centre * centre.transpose()) * mass;
    let inertia = Inertia { xx: i.m11, yy: i.m22, zz: i.m33, xy: i.m12, xz: i.m13, yz: i.m23 };
    let first_moment = if mass == 0.0 { h.into() } else { [0.0; 3] };
    Link { mass, com: centre.into(), inertia, first_moment }
}

/// The robot with another link; what no reader would let pass is no matter.
fn with_link(robot: &Robot, index: usize, link: Link) -> Robot {
    let mut robot = robot.clone();
    robot.joints[index].row.link = link;
    robot.joints[index].written_inertia = (link.inertia, InertiaReference::Com);
    robot
}

/// The arm of a case whose links are bodies, but for one that has a first moment alone; and bodies of which it is the
/// first less the second: of the mass 1 with the first moment and the inertia, and the mass 1 at the origin. The last
/// is no link at all.
fn massless(case: &Case) -> (Robot, usize, [Robot; 3]) {
    let mut robot = case.robot.clone();
    for joint in &mut robot.joints {
        joint.row.link.first_moment = [0.0; 3];
    }
    let index = case.q.len() / 2;
    // numbers of the case as good as random ones
    let h = Vector3::from(case.payload.com) * 3.0;
    let j = Matrix3::from(case.payload.inertia.rows()) - Matrix3::identity() * 0.2;
    let one = |link: Link| with_link(&robot, index, link);
    let bodies = [link(1.0, h, j), link(1.0, Vector3::zeros(), Matrix3::zeros()), Link::default()].map(one);
    (one(link(0.0, h, j)), index, bodies)
}

/// τ(0, h, J) = τ(1, h, J) - τ(1, 0, 0) + τ(0, 0, 0), and so is all that is linear in the parameters of a link.
#[test]
fn a_first_moment_without_mass_is_a_difference_of_bodies() {
    for maker in Maker::ALL {
        let mut worst = Worst::default();
        // what is compiled is so for this alone
        let number = match maker {
            Maker::Runtime => 200,
            Maker::Code(_) if shipped::is_exhaustive() => 24,
            Maker::Code(_) => 12,
        };
        for case in cases(Maker::Runtime).iter().take(number).filter(|case| maker == Maker::Runtime || case.q.len() < 5)
        {
            let (robot, _, bodies) = massless(case);
            let (arm, bodies) = (Arm::new(&robot, maker), bodies.map(|robot| DynArm::from_robot(&robot)));
            let given = case.given();
            for function in LINEAR {
                let [first, second, none] = [0, 1, 2].map(|of| of_runtime(&bodies[of], function, &given));
                let expected: Vec<f64> = first.iter().zip(&second).zip(&none).map(|((a, b), c)| a - b + c).collect();
                let scale = [&first, &second, &none].into_iter().map(|of| largest(of)).fold(1e-2, f64::max);
                worst.see(function.name(), error_on_scale(&arm.numbers(function, &given), &expected, scale));
            }
            let masses =
                [&bodies[0], &bodies[1], &bodies[2]].map(|arm| arm.rows().iter().map(|row| row.link.mass).sum::<f64>());
            if masses[2] < 0.1 {
                continue;
            }
            for function in [Function::CentreOfMass, Function::CentreOfMassJacobian] {
                let moments = [0, 1, 2].map(|of| {
                    of_runtime(&bodies[of], function, &given).into_iter().map(|x| x * masses[of]).collect::<Vec<_>>()
                });
                let expected: Vec<f64> = (0..moments[0].len())
                    .map(|i| (moments[0][i] - moments[1][i] + moments[2][i]) / masses[2])
                    .collect();
                let scale = moments.iter().map(|of| largest(of)).fold(1e-2, f64::max) / masses[2];
                worst.see(function.name(), error_on_scale(&arm.numbers(function, &given), &expected, scale));
            }
        }
        worst.at_most(1e-12, &format!("a first moment without mass, {maker}"));
    }
}

/// The regressor of an arm knows no link, and its parameters are what the torques are made of.
#[test]
fn its_parameters_are_the_regressor_s() {
    let mut worst = Worst::default();
    for case in cases(Maker::Runtime).iter().take(100) {
        let (robot, index, bodies) = massless(case);
        let (arm, body) = (DynArm::from_robot(&robot), DynArm::from_robot(&bodies[0]));
        let (q, qd, qdd) = (&case.q, &case.qd, &case.qdd);
        let [own, of_body] = [&arm, &body].map(|arm| arm.regressor(q, qd, qdd).expect("one per joint"));
        assert_eq!(own, of_body, "whatever the link is");
        let mut parameters = arm.inertial_parameters();
        let of_link = body.inertial_parameters()[index];
        for (found, expected) in parameters[index].iter().zip(of_link).skip(1) {
            assert!((found - expected).abs() < 1e-14, "{found} is not {expected}");
        }
        assert_eq!(std::mem::take(&mut parameters[index][0]), 0.0);
        let matrix: Vec<Vec<f64>> = own.iter().map(|torque| torque.concat()).collect();
        let tau = arm.inverse_dynamics(q, qd, qdd).expect("one per joint");
        let found = product(&matrix, &parameters.concat());
        worst.see("Y π", error_on_scale(&found, &tau, 1e-2 * largest(&case.qdd)));
    }
    worst.at_most(1e-12, "parameters of links without mass");
}

/// The arm whose links have the base parameters of another and nothing else.
fn of_base_parameters(robot: &Robot) -> Robot {
    let found = DynArm::from_robot(robot).base_parameters();
    let mut parameters = vec![[0.0; 10]; robot.dof()];
    for base in &found.parameters {
        parameters[base.kept.link][base.kept.index] = base.value;
    }
    let mut regrouped = robot.clone();
    for (index, [m, hx, hy, hz, xx, xy, xz, yy, yz, zz]) in parameters.into_iter().enumerate() {
        let j = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        regrouped = with_link(&regrouped, index, link(m, Vector3::new(hx, hy, hz), j));
    }
    regrouped
}

/// Torques, mass matrix, Coriolis matrix, forward dynamics and base parameters of an arm are those of its base
/// parameters, and nearly all links of these have no mass.
#[test]
fn an_arm_is_its_base_parameters() {
    for maker in Maker::ALL {
        let mut worst = Worst::default();
        // both conventions, and a joint that slides
        let number = if shipped::is_exhaustive() { 6 } else { 3 };
        for name in ["puma560_mdh", "scara_cobra600", "stanford", "puma560", "ur5", "panda"].into_iter().take(number) {
            let robot = Arm::from_file(&format!("robots/{name}.yaml"), Maker::Runtime).robot.clone();
            let regrouped = of_base_parameters(&robot);
            assert!(regrouped.rows().any(|row| row.link.has_first_moment()), "{name}");
            let (expected, arm) = (DynArm::from_robot(&robot), Arm::new(&regrouped, maker));
            let values =
                |arm: &DynArm| -> Vec<f64> { arm.base_parameters().parameters.iter().map(|base| base.value).collect() };
            let of_arm = values(&expected);
            worst.see("base parameters", error_on_scale(&values(&arm.runtime), &of_arm, 1e-3 * largest(&of_arm)));
            let mut rng = fastrand::Rng::with_seed(3);
            for _ in 0..5 {
                let mut array =
                    |scale: f64| -> Vec<f64> { (0..robot.dof()).map(|_| (2.0 * rng.f64() - 1.0) * scale).collect() };
                let (q, qd, qdd) = (array(3.0), array(2.0), array(5.0));
                let given = crate::arm::Given { tau: &qdd, ..crate::arm::Given::of_joints(&q, &qd, &qdd) };
                for function in [
                    Function::InverseDynamics,
                    Function::GravityTorques,
                    Function::MassMatrix,
                    Function::CoriolisMatrix,
                ] {
                    let wanted = of_runtime(&expected, function, &given);
                    worst.see(function.name(), error_on_scale(&arm.numbers(function, &given), &wanted, 1e-2));
                }
                let matrix = expected.mass_matrix(&q).expect("one per joint");
                let Some(Conditioning { number, .. }) = conditioning(&matrix) else { continue };
                let wanted = of_runtime(&expected, Function::ForwardDynamics, &given);
                let found = arm.numbers(Function::ForwardDynamics, &given);
                worst.see("forward_dynamics", error_on_scale(&found, &wanted, 1.0) / number);
            }
        }
        worst.at_most(1e-11, &format!("arms of base parameters, {maker}"));
    }
}

/// A first moment of a parameter at run time, beside one that is made of it with a mass.
#[test]
fn a_first_moment_may_be_known_at_run_time_only() {
    let yaml = "{format: 1, name: varying, source: own, convention: standard, gravity: [0, 1, -9.81], parameters: \
        {h: 0.4, j: 0.3}, joints: [\
        {type: revolute, dh: {theta: 0.1, d: 0.2, a: 0.3, alpha: pi/2}, link: {first_moment: [h, 0.1, -2*h], \
         inertia: {xx: 0.2, yy: j, zz: 0.4}, physical: false}}, \
        {type: prismatic, dh: {theta: 0.4, d: 0.1, a: 0.2, alpha: 0.7}, link: {mass: 2, first_moment: [h, 0.1, 0], \
         inertia: {xx: 0.2, yy: 0.3, zz: 0.4}}}, \
        {type: revolute, dh: {theta: 0, d: 0.1, a: 0.2, alpha: 0}, link: {first_moment: [0.8, j*h, 0.3], \
         inertia: {xx: 0.5, yy: 0.5, zz: 0.4}, physical: false}}]}";
    let checked = Reader::new("varying").run_time(&["h", "j"]).read(yaml).unwrap_or_else(|report| panic!("{report}"));
    let robot = checked.robot;
    let mut worst = Worst::default();
    let (q, qd, qdd) = ([0.4, -0.7, 1.3], [0.9, 0.3, -1.1], [2.0, -0.6, 0.8]);
    let given = crate::arm::Given { tau: &qdd, ..crate::arm::Given::of_joints(&q, &qd, &qdd) };
    for parameters in [[0.4, 0.3], [-1.7, 0.9]] {
        let runtime = DynArm::from_robot(&robot.with_parameters(&parameters).expect("two"));
        for form in [Form::SevenSteps, Form::Reduced] {
            for function in [
                Function::InverseDynamics,
                Function::MassMatrix,
                Function::ForwardDynamics,
                Function::KineticEnergy,
                Function::PotentialEnergy,
                Function::CentreOfMass,
                Function::CentreOfMassJacobian,
                Function::JointWrenches,
            ] {
                let program = Compiler::new(&robot).compile(function, form).expect("it compiles");
                let arguments =
                    Arguments { tau: &qdd, parameters: &parameters, ..Arguments::of_joints(&q, &qd, &qdd, 0.0) };
                let found = Interpreter::new(&program).run(&arguments, f64::from_f64, Scalar::sin_cos);
                let found = found.expect("arrays of the right length");
                let expected = of_runtime(&runtime, function, &given);
                if form == Form::SevenSteps && function == Function::InverseDynamics {
                    assert_eq!(found, expected, "in every bit");
                }
                worst.see(function.name(), error_on_scale(&found, &expected, 1.0));
            }
        }
    }
    worst.at_most(1e-12, "first moments at run time");
}
