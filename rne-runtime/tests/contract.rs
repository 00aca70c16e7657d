//! The order of operations that generated code repeats to the bit, written out once more from the documentation.

use crate::common::{Numbers, six_joints, tool};
use nalgebra::{Matrix3, Vector3};
use rne_model::Convention::{Modified, Standard};
use rne_model::{Convention, JointKind, Model};
use rne_runtime::{
    Arm, BaseMotion, CoriolisMatrix, ForwardDynamics, InverseDynamics, Kinematics, MassMatrix, MovingBase, Scalar,
};

const N: usize = 6;

fn arms() -> [Arm<N>; 2] {
    [Standard, Modified].map(|convention| Arm::new(Model { tool: tool(), base: tool(), ..six_joints(convention) }))
}

fn unit(j: usize) -> [f64; N] {
    std::array::from_fn(|i| if i == j { 1.0 } else { 0.0 })
}

fn weightless(arm: &Arm<N>, q: &[f64; N], qd: &[f64; N], qdd: &[f64; N]) -> [f64; N] {
    arm.inverse_dynamics_on_moving_base(q, qd, qdd, &BaseMotion::fixed([0.0; 3]))
}

#[test]
fn matrices_are_torques_of_unit_motions() {
    let mut numbers = Numbers::new(51);
    for arm in arms() {
        for _ in 0..50 {
            let (q, qd): ([f64; N], [f64; N]) = (numbers.array(3.0), numbers.array(2.0));
            let (mass, coriolis) = (arm.mass_matrix(&q), arm.coriolis_matrix(&q, &qd));
            for j in 0..N {
                let column = weightless(&arm, &q, &[0.0; N], &unit(j));
                for i in 0..=j {
                    assert_eq!((mass[i][j], mass[j][i]), (column[i], column[i]));
                }
                let shifted = |sign: f64| std::array::from_fn(|k| qd[k] + sign * unit(j)[k]);
                let faster = weightless(&arm, &q, &shifted(1.0), &[0.0; N]);
                let slower = weightless(&arm, &q, &shifted(-1.0), &[0.0; N]);
                for i in 0..N {
                    assert_eq!(coriolis[i][j], (faster[i] - slower[i]) / 4.0);
                }
            }
        }
    }
}

#[test]
#[allow(clippy::needless_range_loop)] // written as in the documentation
fn forward_dynamics_is_a_factorisation_without_pivoting() {
    let mut numbers = Numbers::new(52);
    for arm in arms() {
        for _ in 0..50 {
            let (q, qd, tau): ([f64; N], [f64; N], [f64; N]) =
                (numbers.array(3.0), numbers.array(2.0), numbers.array(9.0));
            let (m, bias) = (arm.mass_matrix(&q), arm.bias_torques(&q, &qd));
            let (mut l, mut c, mut v) = ([[0.0; N]; N], [[0.0; N]; N], [0.0; N]);
            for j in 0..N {
                let mut d = m[j][j];
                for k in 0..j {
                    d -= l[j][k] * c[j][k];
                }
                v[j] = 1.0 / d;
                for i in j + 1..N {
                    c[i][j] = m[i][j];
                    for k in 0..j {
                        c[i][j] -= l[i][k] * c[j][k];
                    }
                    l[i][j] = c[i][j] * v[j];
                }
            }
            let mut y = [0.0; N];
            for i in 0..N {
                y[i] = tau[i] - bias[i];
                for k in 0..i {
                    y[i] -= l[i][k] * y[k];
                }
            }
            let mut x = [0.0; N];
            for i in (0..N).rev() {
                x[i] = y[i] * v[i];
                for k in i + 1..N {
                    x[i] -= l[k][i] * x[k];
                }
            }
            assert_eq!(arm.forward_dynamics(&q, &qd, &tau), x);
        }
    }
}

/// Rows times columns, summed from the first product to the last.
fn product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| (a[i][0] * b[0][j] + a[i][1] * b[1][j]) + a[i][2] * b[2][j]))
}

fn moved(a: &[[f64; 3]; 3], x: [f64; 3], p: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| ((a[i][0] * x[0] + a[i][1] * x[1]) + a[i][2] * x[2]) + p[i])
}

#[test]
fn poses_are_accumulated_from_the_base() {
    let mut numbers = Numbers::new(53);
    for arm in arms() {
        let Model { convention, base, rows, .. } = arm.model();
        let placed = |transform: &rne_model::Transform| {
            let [[sr, cr], [sp, cp], [sy, cy]] = transform.rpy.map(|angle| [angle.sin, angle.cos]);
            let rz = [[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]];
            let ry = [[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]];
            let rx = [[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]];
            (product(&product(&rz, &ry), &rx), transform.xyz)
        };
        for _ in 0..50 {
            let q: [f64; N] = numbers.array(3.0);
            let (mut rotation, mut position) = placed(base);
            let poses = arm.link_poses(&q);
            for ((row, q), pose) in rows.iter().zip(q).zip(&poses) {
                let dh = &row.dh;
                let ((s, c), d) = match row.kind {
                    JointKind::Prismatic => ((dh.theta.sin, dh.theta.cos), dh.d + q),
                    JointKind::Revolute => (Scalar::sin_cos(dh.theta.radians + q), dh.d),
                };
                let (sa, ca) = (dh.alpha.sin, dh.alpha.cos);
                let (r, p) = match convention {
                    Convention::Standard => {
                        ([[c, -s * ca, s * sa], [s, c * ca, -c * sa], [0.0, sa, ca]], [c * dh.a, s * dh.a, d])
                    }
                    Convention::Modified => {
                        ([[c, -s, 0.0], [ca * s, ca * c, -sa], [sa * s, sa * c, ca]], [dh.a, -sa * d, ca * d])
                    }
                };
                (position, rotation) = (moved(&rotation, p, position), product(&rotation, &r));
                assert_eq!((pose.rotation, pose.translation), (rotation, position));
            }
            let (r, p) = placed(&arm.model().tool);
            let tip = arm.forward_kinematics(&q);
            assert_eq!((tip.rotation, tip.translation), (product(&rotation, &r), moved(&rotation, p, position)));

            let jacobian = arm.jacobian(&q);
            let base = placed(base);
            for i in 0..N {
                let before = if i == 0 { base } else { (poses[i - 1].rotation, poses[i - 1].translation) };
                let frame = match convention {
                    Convention::Standard => before,
                    Convention::Modified => (poses[i].rotation, poses[i].translation),
                };
                let axis = Matrix3::from(frame.0).transpose().column(2).into_owned();
                let lever = Vector3::from(tip.translation) - Vector3::from(frame.1);
                let (linear, angular) = match rows[i].kind {
                    JointKind::Revolute => (axis.cross(&lever), axis),
                    JointKind::Prismatic => (axis, Vector3::zeros()),
                };
                let expected = [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z];
                assert_eq!(jacobian.map(|row| row[i]), expected);
            }
        }
    }
}
