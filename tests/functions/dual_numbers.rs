//! Derivatives by dual numbers through the functions of the runtime: exact up to rounding, and from no formula of a
//! derivative. Second derivatives by dual numbers of dual numbers.

use rne::{BaseMotion, Dual, Numbers, Payload, Scalar, Wrench};
use rne_codegen::Function;

use crate::arm::{Arm, Given, STEP, base_rotation, of_runtime};
use crate::tree_functions::State;

/// The argument by which a function is derived.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum By {
    Q,
    Qd,
    Qdd,
    Tau,
    /// The angular velocity of the base.
    Omega,
    /// The velocity of its origin.
    Velocity,
    /// A shift of it and a turn, in its axes.
    Shift,
    Turn,
}
use By::{Omega, Q, Qd, Qdd, Shift, Tau, Turn, Velocity};

/// The numbers that are computed from the derivatives.
#[derive(Clone, Copy)]
pub(crate) enum Kind {
    /// A matrix for each that is varied, by rows: a row for each number of the function.
    Rows,
    /// These matrices for the first half of the numbers of the function, then those for the others.
    HalvesOfRows,
    /// The matrices of a step with a floating base, on the manifold of its positions.
    OnManifold,
    /// The torques of the state times each of these matrices.
    Weighted,
    /// The matrix times the torques of the state.
    TimesTorques,
    /// The rates of the numbers at the velocities of the state.
    Rates,
    /// These, in rows, times the velocities.
    RatesTimesVelocities,
    /// Of a mass matrix M: M q̇, and ½ q̇ᵀ ∂M/∂q q̇ + τ less the torques of this function.
    Momentum(Function),
    /// The second derivatives of the torques of the state times the numbers: by q and q, q and q̇, q̇ and q̇, q and q̈.
    Hessian,
}

/// A derivative.
pub(crate) struct Derivative {
    pub(crate) function: Function,
    /// The function that it is a derivative of.
    pub(crate) of: Function,
    pub(crate) by: &'static [By],
    pub(crate) kind: Kind,
}

/// The numbers of a function, each argument a scalar made of its kind, its place and its value.
fn numbers<T: Scalar + Numbers<T>>(
    arm: &Arm,
    function: Function,
    state: &State,
    scalar: impl Fn(By, usize, f64) -> T,
) -> Vec<T> {
    let list = |by: By, x: &[f64]| -> Vec<T> { x.iter().enumerate().map(|(i, &x)| scalar(by, i, x)).collect() };
    let (q, qd, qdd, tau) = (list(Q, &state.q), list(Qd, &state.qd), list(Qdd, &state.qdd), list(Tau, &state.tau));
    let still = |x: [f64; 3]| x.map(T::from_f64);
    let base = &state.base;
    let rotation = base_rotation::<T>();
    let [shift, turn]: [[T; 3]; 2] = [Shift, Turn].map(|by| std::array::from_fn(|axis| scalar(by, axis, 0.0)));
    let crossed = |[a, b, c]: [T; 3], [x, y, z]: [T; 3]| [b * z - c * y, c * x - a * z, a * y - b * x];
    let given = Given {
        q: &q,
        qd: &qd,
        qdd: &qdd,
        tau: &tau,
        wrench: Wrench { force: still(state.wrench.force), moment: still(state.wrench.moment) },
        payload: Payload::from_array(state.payload.to_array().map(T::from_f64)),
        base: BaseMotion {
            omega: std::array::from_fn(|axis| scalar(Omega, axis, base.omega[axis])),
            omega_dot: still(base.omega_dot),
            velocity: std::array::from_fn(|axis| scalar(Velocity, axis, base.velocity[axis])),
            acceleration: still(base.acceleration),
            // the place of a floating base
            gravity: std::array::from_fn(|row| {
                let moved = (0..3).fold(T::zero(), |sum, axis| sum + rotation[row][axis] * shift[axis]);
                T::from_f64(base.gravity[row]) + moved
            }),
        },
        // R (1 + [δθ]×), by rows: r + r × δθ
        base_rotation: rotation.map(|row| {
            let turned = crossed(row, turn);
            std::array::from_fn(|axis| row[axis] + turned[axis])
        }),
        step: T::from_f64(STEP),
    };
    of_runtime(&arm.runtime, function, &given)
}

/// The derivative of each number of a function by element `at` of what is varied.
fn column(arm: &Arm, function: Function, state: &State, by: By, at: usize) -> Vec<f64> {
    let dual = |kind: By, i: usize, value: f64| Dual { value, derivative: one_if(kind == by && i == at) };
    numbers(arm, function, state, dual).iter().map(|number| number.derivative).collect()
}

/// The changes of the positions and of the velocities after a step with a floating base, in its axes.
fn changes(arm: &Arm, state: &State, by: By, at: usize) -> [Vec<f64>; 2] {
    let dual = |kind: By, i: usize, value: f64| Dual { value, derivative: one_if(kind == by && i == at) };
    let next = numbers(arm, Function::FloatingEulerStep, state, dual);
    let rates: Vec<f64> = next.iter().map(|number| number.derivative).collect();
    // R'ᵀ times a column of changes
    let back =
        |change: [f64; 3], axis: usize| -> f64 { (0..3).map(|row| next[3 * row + axis].value * change[row]).sum() };
    let column = |axis: usize| [rates[axis], rates[3 + axis], rates[6 + axis]];
    let turn = [back(column(1), 2), back(column(2), 0), back(column(0), 1)];
    let origin = [0, 1, 2].map(|axis| back([rates[9], rates[10], rates[11]], axis));
    let (q, qd) = rates[18..].split_at(state.q.len());
    [[&origin[..], &turn, q].concat(), [&rates[12..18], qd].concat()]
}

fn one_if(is_one: bool) -> f64 {
    f64::from(u8::from(is_one))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Derivative {
    /// The matrices of the derivative, one after the other.
    pub(crate) fn expected(&self, arm: &Arm, state: &State) -> Vec<Vec<f64>> {
        let dof = state.q.len();
        let columns = |by: By| -> Vec<Vec<f64>> {
            (0..if by == Omega { 3 } else { dof }).map(|at| column(arm, self.of, state, by, at)).collect()
        };
        let rows = |by: By| -> Vec<Vec<f64>> {
            let columns = columns(by);
            (0..columns[0].len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
        };
        let rates = || -> Vec<f64> {
            let moving = |by: By, i: usize, value: f64| {
                let derivative = if by == Q { state.qd[i] } else { 0.0 };
                Dual { value, derivative }
            };
            numbers(arm, self.of, state, moving).iter().map(|number| number.derivative).collect()
        };
        match self.kind {
            Kind::Rows => self.by.iter().map(|&by| rows(by).concat()).collect(),
            Kind::HalvesOfRows => {
                let matrices: Vec<Vec<Vec<f64>>> = self.by.iter().map(|&by| rows(by)).collect();
                let half = |half: usize| {
                    matrices.iter().map(move |rows| rows[half * rows.len() / 2..][..rows.len() / 2].concat())
                };
                half(0).chain(half(1)).collect()
            }
            Kind::OnManifold => {
                let by = |kinds: &[(By, usize)]| -> Vec<[Vec<f64>; 2]> {
                    let columns = kinds.iter().flat_map(|&(by, count)| (0..count).map(move |at| (by, at)));
                    columns.map(|(by, at)| changes(arm, state, by, at)).collect()
                };
                let columns = [
                    by(&[(Shift, 3), (Turn, 3), (Q, dof)]),
                    by(&[(Velocity, 3), (Omega, 3), (Qd, dof)]),
                    by(&[(Tau, dof)]),
                ];
                let matrix = |half: usize, columns: &[[Vec<f64>; 2]]| -> Vec<f64> {
                    (0..6 + dof).flat_map(|row| columns.iter().map(move |column| column[half][row])).collect()
                };
                [0, 1].into_iter().flat_map(|half| columns.iter().map(move |columns| matrix(half, columns))).collect()
            }
            Kind::Weighted => {
                let weighted = |by: &By| columns(*by).iter().map(|column| dot(column, &state.tau)).collect();
                self.by.iter().map(weighted).collect()
            }
            Kind::TimesTorques => {
                self.by.iter().map(|&by| rows(by).iter().map(|row| dot(row, &state.tau)).collect()).collect()
            }
            Kind::Rates => vec![rates()],
            Kind::RatesTimesVelocities => vec![rates().chunks(dof).map(|row| dot(row, &state.qd)).collect()],
            Kind::Momentum(gravity) => {
                let times_velocity =
                    |matrix: &[f64]| -> Vec<f64> { matrix.chunks(dof).map(|row| dot(row, &state.qd)).collect() };
                let plain = |function| numbers(arm, function, state, |_, _, x| x);
                let momentum = times_velocity(&plain(self.of));
                let gravity = plain(gravity);
                let twice = columns(Q).into_iter().map(|matrix| dot(&times_velocity(&matrix), &state.qd));
                let rate = twice.enumerate().map(|(i, twice)| twice / 2.0 + state.tau[i] - gravity[i]).collect();
                vec![momentum, rate]
            }
            Kind::Hessian => {
                let blocks = [(Q, Q), (Q, Qd), (Qd, Qd), (Q, Qdd)];
                blocks.iter().map(|&(first, second)| self.hessian(arm, state, first, second)).collect()
            }
        }
    }

    /// The second derivatives of the torques of the state times the numbers, by rows: a row for each element of
    /// `first`, a column for each of `second`.
    fn hessian(&self, arm: &Arm, state: &State, first: By, second: By) -> Vec<f64> {
        let dof = state.q.len();
        let element = |row: usize, column: usize| {
            let dual = |by: By, i: usize, value: f64| Dual {
                value: Dual { value, derivative: one_if(by == second && i == column) },
                derivative: Dual { value: one_if(by == first && i == row), derivative: 0.0 },
            };
            let found = numbers(arm, self.of, state, dual);
            dot(&found.iter().map(|number| number.derivative.derivative).collect::<Vec<_>>(), &state.tau)
        };
        let mut matrix = vec![0.0; dof * dof];
        for row in 0..dof {
            // by the same twice: symmetric
            for column in if first == second { row } else { 0 }..dof {
                matrix[row * dof + column] = element(row, column);
                if first == second {
                    matrix[column * dof + row] = matrix[row * dof + column];
                }
            }
        }
        matrix
    }
}
