//! Computes the dynamics of a chain or a tree in the frames of its links, for comparison with a table.
//!
//! It uses Newton-Euler recursion about the origin of each link's frame, without Denavit-Hartenberg frames, and shares
//! no formula with the recursion of the rne runtime.

use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Unit, Vector3};
use rne_model::Limits;

use crate::chain::Chain;
use crate::geometry::{Pose, Vector};

/// A rotation and a translation: the placement of a frame.
type Place = (Matrix3<f64>, Vector3<f64>);

/// A chain or a tree with `f64` numbers.
pub(crate) struct Dynamics {
    base: (Matrix3<f64>, Vector3<f64>),
    gravity: Vector3<f64>,
    joints: Vec<Joint>,
    /// The joint that moves the tip frame, and the placement of this frame on the moved link.
    tip: (Option<usize>, Place),
    /// For each named frame, the joint that moves it and its placement on the moved link.
    frames: Vec<(Option<usize>, Place)>,
}

struct Joint {
    parent: Option<usize>,
    is_prismatic: bool,
    rotation: Matrix3<f64>,
    translation: Vector3<f64>,
    axis: Vector3<f64>,
    mass: f64,
    /// First moment and inertia of the link about the origin of its frame.
    moment: Vector3<f64>,
    inertia: Matrix3<f64>,
    limits: Limits,
}

/// A state: positions, velocities, accelerations.
pub(crate) struct State {
    pub(crate) q: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    pub(crate) qdd: Vec<f64>,
}

impl Dynamics {
    pub(crate) fn of(chain: &Chain) -> Self {
        let joints = chain.joints.iter().map(|joint| {
            let (rotation, translation) = numbers(joint.place);
            Joint {
                parent: joint.parent,
                is_prismatic: joint.is_prismatic,
                rotation,
                translation,
                axis: vector(joint.axis),
                mass: joint.body.mass.to_f64(),
                moment: vector(joint.body.moment),
                inertia: Matrix3::from_columns(&joint.body.inertia.map(vector)),
                limits: joint.limits,
            }
        });
        Self {
            base: numbers(chain.base),
            gravity: vector(chain.gravity),
            joints: joints.collect(),
            tip: (Some(chain.tip_on), numbers(chain.tip)),
            frames: chain.frames.iter().map(|frame| (frame.on, numbers(frame.place))).collect(),
        }
    }

    /// Returns random states within the position limits, with speeds up to 2 and accelerations up to 5; the same in
    /// every run.
    pub(crate) fn states(&self, number: usize) -> Vec<State> {
        let mut random = fastrand::Rng::with_seed(1);
        let mut between = |(low, high): (f64, f64)| low + (high - low) * random.f64();
        let pi = std::f64::consts::PI;
        let position = |joint: &Joint| match (joint.limits.position, joint.is_prismatic) {
            (Some((low, high)), true) => (low.max(-2.0), high.min(2.0).max(low.max(-2.0))),
            (Some((low, high)), false) => (low.max(-pi), high.min(pi).max(low.max(-pi))),
            (None, true) => (-0.5, 0.5),
            (None, false) => (-pi, pi),
        };
        let mut state = || State {
            q: self.joints.iter().map(|joint| between(position(joint))).collect(),
            qd: self.joints.iter().map(|_| between((-2.0, 2.0))).collect(),
            qdd: self.joints.iter().map(|_| between((-5.0, 5.0))).collect(),
        };
        (0..number).map(|_| state()).collect()
    }

    /// Returns the placement of a link in the frame of the link before it, at the joint position `q`.
    fn place(joint: &Joint, q: f64) -> (Matrix3<f64>, Vector3<f64>) {
        if joint.is_prismatic {
            return (joint.rotation, joint.translation + joint.rotation * joint.axis * q);
        }
        let turned = Rotation3::from_axis_angle(&Unit::new_unchecked(joint.axis), q);
        (joint.rotation * turned.matrix(), joint.translation)
    }

    /// Returns the placement of the tip frame in the world.
    pub(crate) fn tip(&self, q: &[f64]) -> Place {
        self.carried(self.tip, q)
    }

    /// Returns the placements of the named frames in the world.
    pub(crate) fn frames(&self, q: &[f64]) -> Vec<Place> {
        self.frames.iter().map(|frame| self.carried(*frame, q)).collect()
    }

    /// Returns the placement in the world of a frame that a joint moves.
    fn carried(&self, (on, place): (Option<usize>, Place), q: &[f64]) -> Place {
        let mut joints: Vec<usize> = std::iter::successors(on, |&joint| self.joints[joint].parent).collect();
        joints.reverse();
        let places = joints.into_iter().map(|joint| Self::place(&self.joints[joint], q[joint])).chain([place]);
        places.fold(self.base, |(r, p), (rotation, translation)| (r * rotation, r * translation + p))
    }

    /// Returns the torques, N m or N.
    pub(crate) fn torques(&self, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<f64> {
        self.newton_euler(q, qd, qdd, self.gravity)
    }

    fn newton_euler(&self, q: &[f64], qd: &[f64], qdd: &[f64], gravity: Vector3<f64>) -> Vec<f64> {
        let zero = Vector3::zeros();
        // Angular velocity, angular acceleration and acceleration of the origin of each link's frame, in the axes of
        // this frame.
        let mut motions: Vec<[Vector3<f64>; 3]> = Vec::with_capacity(self.joints.len());
        let mut wrenches = Vec::with_capacity(self.joints.len());
        for (i, joint) in self.joints.iter().enumerate() {
            let (rotation, translation) = Self::place(joint, q[i]);
            let back = rotation.transpose();
            let along = joint.axis;
            let [mut w, mut dw, mut a] = joint.parent.map_or([zero, zero, -gravity], |parent| motions[parent]);
            a = back * (a + dw.cross(&translation) + w.cross(&w.cross(&translation)));
            w = back * w;
            dw = back * dw;
            if joint.is_prismatic {
                a += 2.0 * w.cross(&(along * qd[i])) + along * qdd[i];
            } else {
                dw += w.cross(&(along * qd[i])) + along * qdd[i];
                w += along * qd[i];
            }
            motions.push([w, dw, a]);
            let h = joint.moment;
            let force = a * joint.mass + dw.cross(&h) + w.cross(&w.cross(&h));
            let moment = joint.inertia * dw + w.cross(&(joint.inertia * w)) + h.cross(&a);
            wrenches.push((rotation, translation, force, moment));
        }
        let mut carried = vec![[zero; 2]; self.joints.len()];
        let mut torques = vec![0.0; self.joints.len()];
        for (i, (rotation, translation, own_force, own_moment)) in wrenches.into_iter().enumerate().rev() {
            let joint = &self.joints[i];
            let (force, moment) = (own_force + carried[i][0], own_moment + carried[i][1]);
            torques[i] = joint.axis.dot(if joint.is_prismatic { &force } else { &moment });
            let force = rotation * force;
            if let Some(parent) = joint.parent {
                carried[parent][0] += force;
                carried[parent][1] += rotation * moment + translation.cross(&force);
            }
        }
        torques
    }

    /// Returns the mass matrix; each column is the torques of a unit acceleration.
    pub(crate) fn mass_matrix(&self, q: &[f64]) -> DMatrix<f64> {
        let n = self.joints.len();
        let still = vec![0.0; n];
        let columns: Vec<DVector<f64>> = (0..n)
            .map(|k| {
                let unit: Vec<f64> = (0..n).map(|i| f64::from(u8::from(i == k))).collect();
                DVector::from_vec(self.newton_euler(q, &still, &unit, Vector3::zeros()))
            })
            .collect();
        DMatrix::from_columns(&columns)
    }

    /// Returns the accelerations that `torques` cause; `None` where the mass matrix is singular.
    pub(crate) fn accelerations(&self, q: &[f64], qd: &[f64], torques: &[f64]) -> Option<Vec<f64>> {
        let still = vec![0.0; self.joints.len()];
        let bias = self.torques(q, qd, &still);
        let rest: Vec<f64> = torques.iter().zip(bias).map(|(torque, bias)| torque - bias).collect();
        let solved = self.mass_matrix(q).cholesky()?.solve(&DVector::from_vec(rest));
        Some(solved.iter().copied().collect())
    }
}

fn vector(v: Vector) -> Vector3<f64> {
    Vector3::from(v.to_f64())
}

fn numbers(pose: Pose) -> (Matrix3<f64>, Vector3<f64>) {
    (Matrix3::from_columns(&pose.rotation.columns.map(vector)), vector(pose.translation))
}
