//! A controller that plans: one real-time iteration of sequential quadratic programming for each sample (M. Diehl,
//! H. G. Bock, J. P. Schlöder, "A real-time iteration scheme for nonlinear optimization in optimal feedback control",
//! 2005).

use std::time::{Duration, Instant};

use rne::InverseDynamics;

use crate::model::{DOF, Interval, Joints, Method, Panda, State, tip};
use crate::program::Program;

/// Number of intervals of the plan.
pub const NODES: usize = 20;

/// The task of the controller in one sample.
pub struct Task {
    /// The measured state.
    pub now: State,
    /// The goal of the tip in the world, m.
    pub goal: [f64; 3],
    /// Positions that the arm prefers, rad.
    pub posture: Joints,
    /// Length of an interval, s.
    pub interval: f64,
    /// External torques, N m, for example of a load that the model does not have.
    pub external: Joints,
    /// Weights of the cost.
    pub weights: Weights,
}

/// Weights of the squared terms in the cost.
#[derive(Clone, Copy)]
pub struct Weights {
    /// Weight of the distance of the tip from the goal, 1/m².
    pub tip: f64,
    /// Factor by which the weight of the tip is larger at the last node.
    pub last: f64,
    /// Weight of the distance from the preferred posture, 1/rad².
    pub posture: f64,
    /// Weight of the velocities, s²/rad².
    pub velocity: f64,
    /// Weight of the torques, less those that hold the arm, 1/(N m)².
    pub torque: f64,
}

/// A plan: states at the nodes, and torques of the intervals between them.
pub struct Plan {
    /// States at the nodes.
    pub states: Vec<State>,
    /// Torques of the intervals, N m.
    pub torques: Vec<Joints>,
}

/// The model of the robot at a node of the plan.
pub struct Node {
    /// The interval after the node: its end, and how the end changes with the state and the torques.
    pub interval: Interval,
    /// Position of the tip, and the linear rows of its Jacobian.
    pub tip: ([f64; 3], [[f64; DOF]; 3]),
    /// Torques that hold the arm at rest, N m.
    pub holding: Joints,
}

/// Time and iterations that one call of the controller needed.
#[derive(Clone, Copy, Default)]
pub struct Spent {
    /// Time of the whole call.
    pub whole: Duration,
    /// Time for dynamics, kinematics and their derivatives.
    pub model: Duration,
    /// Time for the intervals and their derivatives, a part of `model`.
    pub dynamics: Duration,
    /// Iterations of the solver of the quadratic program.
    pub iterations: u32,
}

/// The controller, with its last plan.
pub struct Controller {
    method: Method,
    plan: Plan,
    program: Program,
}

impl Controller {
    /// Creates a controller whose first plan holds the arm at `start`.
    #[must_use]
    pub fn new(method: Method, start: &State) -> Self {
        let plan = Plan { states: vec![*start; NODES + 1], torques: vec![Panda.gravity_torques(&start.q); NODES] };
        Self { method, plan, program: Program::default() }
    }

    /// Improves the plan and returns the torques for the next interval.
    pub fn step(&mut self, task: &Task) -> (Joints, Spent) {
        let begin = Instant::now();
        self.shift();
        let states = self.plan.states.iter().enumerate();
        // the last node is followed by no interval, so these torques are only a placeholder and their interval is not
        // used
        let torques = |node: usize| self.plan.torques[node.min(NODES - 1)];
        let interval = |(node, state)| Interval::new(self.method, state, &torques(node), &task.external, task.interval);
        let intervals: Vec<Interval> = states.clone().map(interval).collect();
        let dynamics = begin.elapsed();
        let nodes: Vec<Node> = states
            .zip(intervals)
            .map(|((_, state), interval)| {
                let gravity = Panda.gravity_torques(&state.q);
                let holding = std::array::from_fn(|joint| gravity[joint] - task.external[joint]);
                Node { interval, tip: tip(&state.q), holding }
            })
            .collect();
        let model = begin.elapsed();
        let (change, iterations) = self.program.solve(&self.plan, &nodes, task);
        if let Some(change) = change {
            let plus =
                |numbers: &mut Joints, change: Joints| numbers.iter_mut().zip(change).for_each(|(x, by)| *x += by);
            for (node, state) in self.plan.states.iter_mut().enumerate() {
                plus(&mut state.q, change.of(node, 0));
                plus(&mut state.qd, change.of(node, 1));
            }
            for (node, torques) in self.plan.torques.iter_mut().enumerate() {
                plus(torques, change.of(node, 2));
            }
        }
        let limited = std::array::from_fn(|joint| {
            let limit = Panda::EFFORT_LIMITS[joint];
            self.plan.torques[0][joint].clamp(-limit, limit)
        });
        (limited, Spent { whole: begin.elapsed(), model, dynamics, iterations })
    }

    /// Returns the state that the plan predicts after the first interval.
    #[must_use]
    pub fn expected(&self) -> &State {
        &self.plan.states[1]
    }

    /// Moves the plan of the last sample one interval ahead, and repeats its last state and torques.
    fn shift(&mut self) {
        self.plan.states.remove(0);
        self.plan.torques.remove(0);
        let (state, torques) = (self.plan.states[NODES - 1], self.plan.torques[NODES - 2]);
        self.plan.states.push(state);
        self.plan.torques.push(torques);
    }
}
