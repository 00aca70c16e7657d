//! The quadratic program of one real-time iteration: a model that is linear about the last plan, a quadratic cost and
//! the limits of the joints.
//!
//! Its variables are the changes of the plan, node by node: of the positions, velocities and torques. The pattern of
//! its matrices never changes, so that the solver keeps its order of elimination.

use std::borrow::Cow;

use osqp::{CscMatrix, Problem, Settings, Status};

use crate::controller::{NODES, Node, Plan, Task};
use crate::model::{DOF, Interval, Joints, Panda};

/// Largest number of iterations of the solver. Its solution is then used as it is.
const MOST_ITERATIONS: u32 = 100;
/// Number of variables of a node: positions, velocities, torques.
const WIDTH: usize = 3 * DOF;
/// Number of all variables; the last node has no torques.
const VARIABLES: usize = NODES * WIDTH + 2 * DOF;

/// Elements of a sparse matrix, in the order in which they were added.
#[derive(Default)]
struct Elements {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl Elements {
    fn put(&mut self, row: usize, column: usize, value: f64) {
        self.rows.push(row);
        self.columns.push(column);
        self.values.push(value);
    }

    /// Returns the place of each element when the elements are sorted by columns, then by rows.
    fn places(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.values.len()).collect();
        order.sort_by_key(|&at| (self.columns[at], self.rows[at]));
        let mut places = vec![0; order.len()];
        order.into_iter().enumerate().for_each(|(place, at)| places[at] = place);
        places
    }

    fn matrix(&self, rows: usize, places: &[usize]) -> CscMatrix<'static> {
        let mut starts = vec![0; VARIABLES + 1];
        self.columns.iter().for_each(|&column| starts[column + 1] += 1);
        (0..VARIABLES).for_each(|column| starts[column + 1] += starts[column]);
        let mut row_of = vec![0; places.len()];
        places.iter().zip(&self.rows).for_each(|(&place, &row)| row_of[place] = row);
        CscMatrix {
            nrows: rows,
            ncols: VARIABLES,
            indptr: Cow::Owned(starts),
            indices: Cow::Owned(row_of),
            data: Cow::Owned(self.sorted(places)),
        }
    }

    fn sorted(&self, places: &[usize]) -> Vec<f64> {
        let mut values = vec![0.0; places.len()];
        places.iter().zip(&self.values).for_each(|(&place, &value)| values[place] = value);
        values
    }
}

/// All numbers of the quadratic program.
#[derive(Default)]
struct Data {
    cost: Elements,
    linear: Vec<f64>,
    constraints: Elements,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

/// The quadratic program, and data that the solver keeps from one iteration to the next.
#[derive(Default)]
pub struct Program {
    kept: Option<Kept>,
}

struct Kept {
    solver: Problem,
    places: [Vec<usize>; 2],
}

/// The solution of the program: changes of all variables of a plan.
pub struct Change(Vec<f64>);

impl Change {
    /// Returns the changes of the positions, velocities or torques (`part` 0, 1, 2) of a node.
    #[must_use]
    pub fn of(&self, node: usize, part: usize) -> Joints {
        std::array::from_fn(|joint| self.0[node * WIDTH + part * DOF + joint])
    }
}

impl Program {
    /// Solves the program. Returns the solution, `None` if the solver finds none, and the number of iterations of the
    /// solver.
    ///
    /// # Panics
    /// If a number of the plan is not finite.
    pub fn solve(&mut self, plan: &Plan, nodes: &[Node], task: &Task) -> (Option<Change>, u32) {
        let data = Data::of(plan, nodes, task);
        let rows = data.lower.len();
        let matrices = |[cost, constraints]: &[Vec<usize>; 2]| {
            (data.cost.matrix(VARIABLES, cost), data.constraints.matrix(rows, constraints))
        };
        let kept = match &mut self.kept {
            Some(kept) => {
                let (cost, constraints) = matrices(&kept.places);
                kept.solver.update_P(cost);
                kept.solver.update_A(constraints);
                kept.solver.update_lin_cost(&data.linear);
                kept.solver.update_bounds(&data.lower, &data.upper);
                // the plan already contains the last solution, so the best initial guess is no change
                kept.solver.warm_start_x(&[0.0; VARIABLES]);
                kept
            }
            none => {
                let places = [data.cost.places(), data.constraints.places()];
                let (cost, constraints) = matrices(&places);
                // a low accuracy suffices, because the next sample continues with another iteration
                let settings = Settings::default()
                    .verbose(false)
                    .eps_abs(1e-4)
                    .eps_rel(1e-4)
                    .max_iter(MOST_ITERATIONS)
                    .check_termination(Some(5))
                    .adaptive_rho(false);
                let solver = Problem::new(cost, &data.linear, constraints, &data.lower, &data.upper, &settings)
                    .expect("the numbers of a plan are finite");
                none.insert(Kept { solver, places })
            }
        };
        let status = kept.solver.solve();
        let iterations = status.iter();
        match status {
            Status::Solved(solution) | Status::SolvedInaccurate(solution) | Status::MaxIterationsReached(solution) => {
                (Some(Change(solution.x().to_vec())), iterations)
            }
            _ => (None, iterations),
        }
    }
}

/// Returns the index of a variable.
const fn at(node: usize, part: usize, joint: usize) -> usize {
    node * WIDTH + part * DOF + joint
}

impl Data {
    fn of(plan: &Plan, nodes: &[Node], task: &Task) -> Self {
        let mut data = Self { linear: vec![0.0; VARIABLES], ..Self::default() };
        data.costs(plan, nodes, task);
        data.dynamics(plan, nodes, task);
        data.limits(plan, task);
        data
    }

    /// Adds the costs: distance of the tip from its goal, distance from the posture, velocities, and torques other than
    /// those that hold the arm. The Hessian is that of Gauss and Newton.
    fn costs(&mut self, plan: &Plan, nodes: &[Node], task: &Task) {
        for (node, Node { tip: (place, jacobian), .. }) in nodes.iter().enumerate() {
            let state = &plan.states[node];
            let weight = task.weights.tip * if node == NODES { task.weights.last } else { 1.0 };
            let off: [f64; 3] = std::array::from_fn(|axis| place[axis] - task.goal[axis]);
            for column in 0..DOF {
                for row in 0..=column {
                    let product: f64 = jacobian.iter().map(|of_axis| of_axis[row] * of_axis[column]).sum();
                    let posture = if row == column { task.weights.posture } else { 0.0 };
                    self.cost.put(at(node, 0, row), at(node, 0, column), weight * product + posture);
                }
                let gradient: f64 = jacobian.iter().zip(off).map(|(of_axis, off)| of_axis[column] * off).sum();
                self.linear[at(node, 0, column)] =
                    weight * gradient + task.weights.posture * (state.q[column] - task.posture[column]);
                self.cost.put(at(node, 1, column), at(node, 1, column), task.weights.velocity);
                self.linear[at(node, 1, column)] = task.weights.velocity * state.qd[column];
                if node < NODES {
                    self.cost.put(at(node, 2, column), at(node, 2, column), task.weights.torque);
                    self.linear[at(node, 2, column)] =
                        task.weights.torque * (plan.torques[node][column] - nodes[node].holding[column]);
                }
            }
        }
    }

    /// Adds the linear equations between nodes. Euler: δq̇⁺ = δq̇ + h (∂q̈/∂q δq + ∂q̈/∂q̇ δq̇ + ∂q̈/∂τ δτ) + gap, and
    /// δq⁺ = δq + h δq̇⁺ + gap, which has fewer elements than with δq̇⁺ inserted. Runge and Kutta: both equations
    /// contain positions, velocities and torques.
    fn dynamics(&mut self, plan: &Plan, nodes: &[Node], task: &Task) {
        for joint in 0..DOF {
            for (part, gap) in
                [task.now.q[joint] - plan.states[0].q[joint], task.now.qd[joint] - plan.states[0].qd[joint]]
                    .into_iter()
                    .enumerate()
            {
                self.constraints.put(self.lower.len(), at(0, part, joint), 1.0);
                self.equal(gap);
            }
        }
        let h = task.interval;
        for (node, Node { interval, .. }) in nodes.iter().enumerate().take(NODES) {
            let (state, next) = (&plan.states[node], &plan.states[node + 1]);
            match interval {
                Interval::Euler(qdd, by) => {
                    for joint in 0..DOF {
                        let row = self.lower.len();
                        self.constraints.put(row, at(node + 1, 1, joint), 1.0);
                        for (part, matrix) in [&by.dq, &by.dqd, &by.dtau].into_iter().enumerate() {
                            for (column, element) in matrix[joint].iter().enumerate() {
                                let own = if part == 1 && column == joint { 1.0 } else { 0.0 };
                                self.constraints.put(row, at(node, part, column), -own - h * element);
                            }
                        }
                        self.equal(state.qd[joint] + h * qdd[joint] - next.qd[joint]);
                    }
                    for joint in 0..DOF {
                        let row = self.lower.len();
                        self.constraints.put(row, at(node + 1, 0, joint), 1.0);
                        self.constraints.put(row, at(node, 0, joint), -1.0);
                        self.constraints.put(row, at(node + 1, 1, joint), -h);
                        self.equal(state.q[joint] + h * next.qd[joint] - next.q[joint]);
                    }
                }
                Interval::RungeKutta(end, by) => {
                    let gaps = [(&end.q, &next.q), (&end.qd, &next.qd)];
                    for (part, (rows, (end, next))) in by.iter().zip(gaps).enumerate() {
                        for joint in 0..DOF {
                            let row = self.lower.len();
                            self.constraints.put(row, at(node + 1, part, joint), 1.0);
                            for (column, element) in rows[joint].iter().enumerate() {
                                self.constraints.put(row, at(node, 0, column), -element);
                            }
                            self.equal(end[joint] - next[joint]);
                        }
                    }
                }
            }
        }
    }

    fn equal(&mut self, right: f64) {
        self.lower.push(right);
        self.upper.push(right);
    }

    /// Adds the limits of positions, velocities and torques. If the measured state violates a limit, the plan must
    /// halve the violation in each interval.
    fn limits(&mut self, plan: &Plan, task: &Task) {
        let mut bound = |column: usize, value: f64, (lower, upper): (f64, f64)| {
            self.constraints.put(self.lower.len(), column, 1.0);
            self.lower.push(lower - value);
            self.upper.push(upper - value);
        };
        for node in 0..=NODES {
            for joint in 0..DOF {
                if node > 0 {
                    let (now, state) = (&task.now, &plan.states[node]);
                    let back = 0.5_f64.powi(i32::try_from(node).unwrap_or(i32::MAX));
                    let beyond = |x: f64, limit: f64| limit + back * (x - limit).max(0.0);
                    let (lower, upper) = Panda::POSITION_LIMITS[joint];
                    let (q, qd) = (now.q[joint], now.qd[joint]);
                    bound(at(node, 0, joint), state.q[joint], (-beyond(-q, -lower), beyond(q, upper)));
                    let limit = beyond(qd.abs(), Panda::VELOCITY_LIMITS[joint]);
                    bound(at(node, 1, joint), state.qd[joint], (-limit, limit));
                }
                if node < NODES {
                    let limit = Panda::EFFORT_LIMITS[joint];
                    bound(at(node, 2, joint), plan.torques[node][joint], (-limit, limit));
                }
            }
        }
    }
}
