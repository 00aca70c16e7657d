//! Computes torques with slips, as another tool might do.

use nalgebra::Vector3;
use rne_model::{Convention, JointKind, Robot, Row};
use rne_runtime::{DynArm, Wrench, WrongLength};

use crate::lecture::{self, Misprint};
use crate::observation::Observation;
use crate::slip::{Slip, rotation};

/// The computation of another tool: its model of the arm, and its treatment of a state.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Computation {
    pub(crate) robot: Robot,
    pub(crate) misprints: Vec<Misprint>,
    pub(crate) reversed: Vec<usize>,
    /// Factors on the speed, acceleration and torque of a joint.
    pub(crate) factors: Vec<(usize, f64)>,
    /// Factors of positions, and of velocities and accelerations, of revolute joints.
    scales: [f64; 2],
    /// Multiple of its constant part that is added to each joint variable.
    offsets: f64,
    pub(crate) velocity_factor: f64,
    pub(crate) acceleration_factor: f64,
    /// A factor on the acceleration of the first joint.
    pub(crate) first_factor: f64,
    pub(crate) motor_torques: bool,
    pub(crate) rates_exchanged: bool,
    /// The joint at each index in the lists of the state; empty for the order of the rows.
    pub(crate) order_of_state: Vec<usize>,
    /// The joint at each index in the list of torques; empty for the order of the rows.
    pub(crate) order_of_torques: Vec<usize>,
    /// A factor on the torques of revolute joints.
    pub(crate) moment_factor: f64,
    pub(crate) wrench_factor: f64,
    pub(crate) wrench_axes: WrenchAxes,
    pub(crate) torque_factor: f64,
}

/// The axes of a wrench, and the point about which its moment is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum WrenchAxes {
    /// Axes of the tip frame, at its origin.
    Tip,
    /// World axes, at the origin of the tip frame.
    World,
    /// The axes of frame 0, at the origin of the tip frame.
    Base,
    /// World axes, at the origin of the world.
    AboutWorld,
}

/// Whether the lecture's formulas apply to a robot: a serial arm without dependent joints and without rotors on links.
pub(crate) fn is_of_lecture(robot: &Robot) -> bool {
    robot.is_serial() && !robot.has_couplings() && !robot.has_spinning_rotors()
}

/// A state as a computation interprets it, with the wrench at the tip in the axes of the tip.
#[derive(Clone)]
pub(crate) struct Moved {
    pub(crate) q: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    pub(crate) qdd: Vec<f64>,
    pub(crate) wrench: Option<Wrench<f64>>,
}

impl Computation {
    /// Returns the correct computation, without slips.
    pub(crate) fn right(robot: &Robot) -> Self {
        Self {
            robot: robot.clone(),
            misprints: Vec::new(),
            reversed: Vec::new(),
            factors: Vec::new(),
            scales: [1.0; 2],
            offsets: 0.0,
            velocity_factor: 1.0,
            acceleration_factor: 1.0,
            first_factor: 1.0,
            motor_torques: false,
            rates_exchanged: false,
            order_of_state: Vec::new(),
            order_of_torques: Vec::new(),
            moment_factor: 1.0,
            wrench_factor: 1.0,
            wrench_axes: WrenchAxes::Tip,
            torque_factor: 1.0,
        }
    }

    /// Returns the computation with some slips, made in the order of [`Slip`]; `None` if it is impossible, because the
    /// lecture's formulas only apply to standard tables of serial arms.
    pub(crate) fn with(robot: &Robot, slips: &[Slip]) -> Option<Self> {
        let mut this = Self::right(robot);
        let mut slips = slips.to_vec();
        slips.sort_unstable();
        for slip in slips {
            slip.make(&mut this);
        }
        let is_computable = this.robot.convention == Convention::Standard && is_of_lecture(&this.robot);
        (this.misprints.is_empty() || is_computable).then_some(this)
    }

    /// Returns the rows of the coordinates.
    fn rows(&self) -> impl Iterator<Item = &Row> {
        self.robot.independent_joints().map(|joint| &joint.row)
    }

    fn factor(&self, joint: usize) -> f64 {
        self.factors.iter().filter(|(at, _)| *at == joint).map(|(_, factor)| factor).product()
    }

    /// Multiplies the angles of revolute joints by a factor, and if `all` is true, their speeds and accelerations too.
    pub(crate) fn scale(&mut self, factor: f64, all: bool) {
        self.scales = [factor, if all { factor } else { 1.0 }];
    }

    /// Adds `times` its constant part to each joint variable.
    pub(crate) fn offset(&mut self, times: f64) {
        self.offsets = times;
    }

    /// Computes the torques at the state of an observation.
    ///
    /// # Errors
    /// When a list of the observation does not have one number per joint.
    pub(crate) fn torques(&self, arm: &DynArm, at: &Observation) -> Result<Vec<f64>, WrongLength> {
        let moved = self.moved(arm, at.q.clone(), at.qd.clone(), at.qdd.clone(), at.wrench)?;
        let Moved { q, qd, qdd, wrench } = &moved;
        let tau = if self.misprints.is_empty() {
            arm.inverse_dynamics_with_wrench(q, qd, qdd, &wrench.unwrap_or_else(Wrench::zero))?
        } else {
            self.by_the_lecture(&moved)
        };
        self.printed(arm, tau, &moved)
    }

    /// Returns the wrench at the tip in tip axes, from a wrench in the axes that this computation assumes.
    fn in_tip_axes(&self, arm: &DynArm, q: &[f64], wrench: Wrench<f64>) -> Result<Wrench<f64>, WrongLength> {
        if self.wrench_axes == WrenchAxes::Tip {
            return Ok(wrench);
        }
        let pose = arm.forward_kinematics(q)?;
        let (mut force, mut moment) = wrench.vectors();
        if self.wrench_axes == WrenchAxes::Base {
            let base = rotation(&self.robot.base);
            (force, moment) = (base * force, base * moment);
        }
        if self.wrench_axes == WrenchAxes::AboutWorld {
            moment -= Vector3::from(pose.translation).cross(&force);
        }
        let to_tip = |v: Vector3<f64>| [0, 1, 2].map(|axis| (0..3).map(|k| pose.rotation[k][axis] * v[k]).sum());
        Ok(Wrench { force: to_tip(force), moment: to_tip(moment) })
    }

    /// Returns the state as this computation interprets it.
    ///
    /// # Errors
    /// When the wrench has to be rotated and `q` does not have one number per joint.
    pub(crate) fn moved(
        &self,
        arm: &DynArm,
        mut q: Vec<f64>,
        mut qd: Vec<f64>,
        mut qdd: Vec<f64>,
        wrench: Option<Wrench<f64>>,
    ) -> Result<Moved, WrongLength> {
        if self.rates_exchanged {
            std::mem::swap(&mut qd, &mut qdd);
        }
        for list in [&mut q, &mut qd, &mut qdd] {
            // the arm refuses a list of another length later
            if list.len() == self.order_of_state.len() {
                let given = list.clone();
                self.order_of_state.iter().zip(given).for_each(|(&joint, number)| list[joint] = number);
            }
        }
        let joints = self.rows().zip(&mut q).zip(qd.iter_mut().zip(&mut qdd)).enumerate();
        for (index, ((row, q), (qd, qdd))) in joints {
            let revolute = row.kind == JointKind::Revolute;
            if revolute {
                let [position, rate] = self.scales;
                (*q, *qd, *qdd) = (*q * position, *qd * rate, *qdd * rate);
            }
            *q += self.offsets * if revolute { row.dh.theta.radians } else { row.dh.d };
            if self.reversed.contains(&index) {
                (*q, *qd, *qdd) = (-*q, -*qd, -*qdd);
            }
            let factor = self.factor(index);
            (*qd, *qdd) = (*qd * factor, *qdd * factor);
            *qd *= self.velocity_factor;
            *qdd *= self.acceleration_factor * if index == 0 { self.first_factor } else { 1.0 };
        }
        let scaled = |v: [f64; 3]| v.map(|x| x * self.wrench_factor);
        let wrench = wrench.map(|Wrench { force, moment }| Wrench { force: scaled(force), moment: scaled(moment) });
        let wrench = wrench.map(|wrench| self.in_tip_axes(arm, &q, wrench)).transpose()?;
        Ok(Moved { q, qd, qdd, wrench })
    }

    /// Converts torques to the form in which this computation prints them.
    pub(crate) fn printed(&self, arm: &DynArm, mut tau: Vec<f64>, moved: &Moved) -> Result<Vec<f64>, WrongLength> {
        if self.motor_torques {
            let motors = arm.actuator_torques(&moved.qd, &moved.qdd)?;
            tau.iter_mut().zip(motors).for_each(|(tau, motor)| *tau += motor);
        }
        for (index, (tau, row)) in tau.iter_mut().zip(self.rows()).enumerate() {
            *tau *= if self.reversed.contains(&index) { -self.torque_factor } else { self.torque_factor };
            *tau *= if row.kind == JointKind::Revolute { self.moment_factor } else { 1.0 };
            *tau *= self.factor(index);
        }
        if self.order_of_torques.is_empty() {
            return Ok(tau);
        }
        Ok(self.order_of_torques.iter().map(|&joint| tau[joint]).collect())
    }

    /// Computes every vector of the lecture's formulas, in the lecture's axes, with the vectors and inertias of the
    /// links at this state.
    pub(crate) fn lecture(&self, moved: &Moved) -> (Vec<lecture::Placed>, Vec<lecture::LinkVectors>) {
        let rows: Vec<_> = self.robot.rows().copied().collect();
        let state = self.state(moved);
        (lecture::place(&rows, &state.q, &self.misprints), lecture::seven_steps(&rows, &state, &self.misprints))
    }

    fn state(&self, moved: &Moved) -> lecture::State {
        let Robot { tool, gravity, .. } = &self.robot;
        // the lecture's wrench is in frame n+1, that of rne is in the tool frame
        let (force, moment) = moved.wrench.unwrap_or_else(Wrench::zero).vectors();
        let turn = rotation(tool);
        let force = turn * force;
        let moment = turn * moment + Vector3::from(tool.xyz).cross(&force);
        let wrench = Wrench { force: force.into(), moment: moment.into() };
        let Moved { q, qd, qdd, .. } = moved.clone();
        lecture::State { q, qd, qdd, gravity: *gravity, wrench }
    }

    pub(crate) fn by_the_lecture(&self, moved: &Moved) -> Vec<f64> {
        let state = self.state(moved);
        let rows: Vec<_> = self.robot.rows().copied().collect();
        let mut tau: Vec<f64> =
            lecture::seven_steps(&rows, &state, &self.misprints).into_iter().map(|link| link.tau).collect();
        if self.robot.rotors {
            for ((tau, joint), qdd) in tau.iter_mut().zip(&self.robot.joints).zip(&moved.qdd) {
                *tau += joint.motor.map_or(0.0, |motor| motor.gear_ratio * motor.gear_ratio * motor.inertia * qdd);
            }
        }
        tau
    }
}
