//! The arm that is controlled: with a load that the controller does not know, and sensors with noise.

use fastrand::Rng;
use rne::{Payload, PayloadDynamics};

use crate::model::{Joints, Panda, State};

/// The simulated arm.
pub struct Plant {
    /// Its true state.
    pub state: State,
    /// The load that it carries.
    pub payload: Payload<f64>,
    /// Standard deviations of the measured positions, rad, and velocities, rad/s.
    pub noise: [f64; 2],
    /// Source of the noise.
    pub random: Rng,
}

impl Plant {
    /// Integrates the motion during an interval with constant torques, by the method of Runge and Kutta in steps of 1
    /// ms.
    pub fn advance(&mut self, tau: &Joints, interval: f64) {
        let steps = (interval / 1e-3).round().max(1.0);
        let step_length = interval / steps;
        let slope =
            |state: &State| (state.qd, Panda.forward_dynamics_with_payload(&state.q, &state.qd, tau, &self.payload));
        let moved = |state: &State, (qd, qdd): &(Joints, Joints), by: f64| State {
            q: std::array::from_fn(|joint| state.q[joint] + by * qd[joint]),
            qd: std::array::from_fn(|joint| state.qd[joint] + by * qdd[joint]),
        };
        let mut state = self.state;
        let mut step = 0.0;
        while step < steps {
            let first = slope(&state);
            let second = slope(&moved(&state, &first, step_length / 2.0));
            let third = slope(&moved(&state, &second, step_length / 2.0));
            let fourth = slope(&moved(&state, &third, step_length));
            let mean = |part: fn(&(Joints, Joints)) -> &Joints| -> Joints {
                let [a, b, c, d] = [&first, &second, &third, &fourth].map(part);
                std::array::from_fn(|joint| (a[joint] + 2.0 * (b[joint] + c[joint]) + d[joint]) / 6.0)
            };
            state = moved(&state, &(mean(|slope| &slope.0), mean(|slope| &slope.1)), step_length);
            step += 1.0;
        }
        self.state = state;
    }

    /// Returns the state as the sensors measure it, with noise.
    pub fn measured(&mut self) -> State {
        let [position, velocity] = self.noise;
        let State { q, qd } = self.state;
        let mut noisy = |numbers: Joints, deviation: f64| numbers.map(|number| number + deviation * self.normal());
        State { q: noisy(q, position), qd: noisy(qd, velocity) }
    }

    /// Returns a random number of the standard normal distribution, by the method of Box and Muller.
    fn normal(&mut self) -> f64 {
        let (radius, angle) =
            ((-2.0 * (1.0 - self.random.f64()).ln()).sqrt(), self.random.f64() * std::f64::consts::TAU);
        radius * angle.cos()
    }
}
