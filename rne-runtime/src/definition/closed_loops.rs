//! Robots with closed loops: the functions of the open tree, in which the dependent joints follow the joints that move
//! by themselves.
//!
//! ```text
//! K (q̇, ṗ) = 0                 rows: R_Lᵀ (v₂ - v₁);  (b × a)·(ω₂ - ω₁)
//! K (q̈, p̈) + k = 0             k: R_Lᵀ (a₂ - a₁);  (b × a)·(ω̇₂ - ω̇₁) + (ω₂ - ω₁)·((ω₂ × b) × a + b × (ω₁ × a))
//! ṗ = G q̇,  p̈ = G q̈ + Ġ q̇     G = -K_p⁻¹ K_q,  Ġ q̇ = -K_p⁻¹ k
//! τ = Gᵀ τ_tree                M = (1, G)ᵀ M_tree (1, G)
//! ```
//!
//! The Jacobians and accelerations are those of the two places of each loop, in axes of frame 0. R_L has the axes of
//! the loop there. The robot file decides which equations are kept, and in which order.

use nalgebra::{Matrix3, Vector3};
use rne_model::{ClosedLoops, Cut, FixedFrame, JointKind, Pivot, Robot};

use crate::definition::coordinates::Coordinates as _;
use crate::definition::couplings::Counted;
use crate::definition::floating_base::{BASE, of_base, solve_from_the_ends, turning};
use crate::definition::kinematics::Placement;
use crate::number::ldlt::{factor, solve};
use crate::seven_steps::at_tip::AtTip;
use crate::seven_steps::mechanism::Mechanism;
use crate::{
    BaseMotion, Constant, DynArm, DynClosureStep, DynFloatingAccelerations, DynFloatingTorques, Scalar, Wrench,
    WrongLength,
};

/// The loops of a robot.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Loops<S> {
    cuts: Vec<(Cut, [FixedFrame<S>; 2])>,
    /// For each loop, the joint whose axes the equations use; `None` for the axes of frame 0.
    axes: Vec<Option<usize>>,
    /// The indices of the coordinates and of the dependent joints among the joints that follow none by a coupling.
    coordinates: Vec<usize>,
    passive: Vec<usize>,
    elimination: Vec<Pivot>,
}

impl Loops<f64> {
    pub(crate) fn of(robot: &Robot) -> Self {
        if robot.closed.is_empty() {
            return Self::none();
        }
        let ClosedLoops { loops, passive, elimination, .. } = &robot.closed;
        let of_tree: Vec<usize> = (0..robot.joints.len()).filter(|&at| robot.joints[at].coupling.is_none()).collect();
        let place = |joint: usize| of_tree.iter().position(|&other| other == joint);
        Self {
            cuts: loops.iter().map(|closed| (closed.cut, closed.between)).collect(),
            axes: loops.iter().map(|closed| robot.ways_of_loop(closed).concat().first().copied()).collect(),
            coordinates: robot.coordinates().filter_map(place).collect(),
            passive: passive.iter().copied().filter_map(place).collect(),
            elimination: elimination.clone(),
        }
    }

    pub(crate) fn to_f32(&self) -> Loops<f32> {
        let Self { cuts, axes, coordinates, passive, elimination } = self.clone();
        let cuts = cuts.into_iter().map(|(cut, between)| (cut, between.map(FixedFrame::to_f32))).collect();
        Loops { cuts, axes, coordinates, passive, elimination }
    }
}

impl<S> Loops<S> {
    pub(crate) const fn none() -> Self {
        Self {
            cuts: Vec::new(),
            axes: Vec::new(),
            coordinates: Vec::new(),
            passive: Vec::new(),
            elimination: Vec::new(),
        }
    }

    /// Returns one number for each joint of the tree that follows none by a coupling, in the order of the tree.
    fn of_tree<T: Scalar>(&self, of_coordinates: &[T], of_passive: &[T]) -> Vec<T> {
        let mut all = vec![T::zero(); self.coordinates.len() + self.passive.len()];
        for (&place, &x) in self.coordinates.iter().zip(of_coordinates).chain(self.passive.iter().zip(of_passive)) {
            all[place] = x;
        }
        all
    }
}

/// The equations of the loops in one state.
struct Equations<T> {
    residuals: Vec<T>,
    /// One column for each joint of the tree that follows none by a coupling.
    rows: Vec<Vec<T>>,
    biases: Vec<T>,
}

impl<S: Constant> DynArm<S> {
    /// How many dependent joints its closed loops have.
    #[must_use]
    pub fn passive_joints(&self) -> usize {
        self.closed.passive.len()
    }

    /// Returns the robot itself. The macro of the capabilities calls it for functions of loops.
    pub(crate) const fn itself(&self) -> &Self {
        self
    }

    /// Returns the positions of the dependent joints after one step of Newton's method, and the residual of the
    /// equations before it.
    pub(crate) fn newton<T: Scalar>(&self, q: &[T], passive: &[T]) -> DynClosureStep<T> {
        let equations = self.equations(q, passive, None);
        let changes = self.solved(&equations.rows, &equations.residuals);
        let passive = passive.iter().zip(changes).map(|(&p, change)| p + change).collect();
        DynClosureStep { passive, residual: equations.residuals }
    }

    /// Returns G, with one row per dependent joint.
    pub(crate) fn map<T: Scalar>(&self, q: &[T], passive: &[T]) -> Vec<Vec<T>> {
        let equations = self.equations(q, passive, None);
        let column = |&place: &usize| {
            self.solved(&equations.rows, &equations.rows.iter().map(|row| row[place]).collect::<Vec<_>>())
        };
        let columns: Vec<Vec<T>> = self.closed.coordinates.iter().map(column).collect();
        (0..self.closed.passive.len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
    }

    /// Returns Ġ q̇.
    pub(crate) fn map_rate<T: Scalar>(&self, q: &[T], passive: &[T], qd: &[T]) -> Vec<T> {
        let rates = product(&self.map(q, passive), qd);
        let equations = self.equations(q, passive, Some((qd, &rates)));
        self.solved(&equations.rows, &equations.biases)
    }

    /// Returns the wrench that must act on the base, and the torques: those of the tree, to which the torques at the
    /// dependent joints are added through Gᵀ.
    pub(crate) fn torques_of_loops<T: Scalar>(
        &self,
        [q, passive, qd, qdd]: [&[T]; 4],
        base: &BaseMotion<T>,
        load: AtTip<'_, T>,
    ) -> DynFloatingTorques<T> {
        let map = self.map(q, passive);
        let rates = product(&map, qd);
        let bias = self.map_rate(q, passive, qd);
        let accelerations: Vec<T> = product(&map, qdd).into_iter().zip(bias).map(|(a, b)| a + b).collect();
        let [q, qd, qdd] =
            [(q, passive), (qd, &rates), (qdd, &accelerations)].map(|(own, other)| self.closed.of_tree(own, other));
        let (wrench, of_tree) = self.definition().torques_and_wrench([&q, &qd, &qdd], base, load);
        DynFloatingTorques { wrench, tau: self.by_coordinates(&map, &of_tree) }
    }

    /// Returns the torques of a motion without accelerations, on a base at rest.
    pub(crate) fn bias_of_loops<T: Scalar>(&self, state: [&[T]; 3], load: AtTip<'_, T>) -> Vec<T> {
        let ([q, passive, qd], still) = (state, vec![T::zero(); state[0].len()]);
        self.torques_of_loops([q, passive, qd, &still], &self.fixed_base(), load).tau
    }

    /// Returns the torques that hold the robot at rest, on a base at rest.
    pub(crate) fn gravity_of_loops<T: Scalar>(&self, q: &[T], passive: &[T], load: AtTip<'_, T>) -> Vec<T> {
        self.bias_of_loops([q, passive, &vec![T::zero(); q.len()]], load)
    }

    pub(crate) fn mass_of_loops<T: Scalar>(&self, q: &[T], passive: &[T], load: AtTip<'_, T>) -> Vec<Vec<T>> {
        let of_tree = self.definition().mass_matrix(&self.closed.of_tree(q, passive), load);
        self.projected(&self.map(q, passive), 0, &of_tree)
    }

    pub(crate) fn accelerations_of_loops<T: Scalar>(
        &self,
        [q, passive, qd, tau]: [&[T]; 4],
        load: AtTip<'_, T>,
    ) -> Vec<T> {
        let bias = self.bias_of_loops([q, passive, qd], load);
        let mut rows = self.mass_of_loops(q, passive, load);
        let mut x: Vec<T> = tau.iter().zip(bias).map(|(&tau, bias)| tau - bias).collect();
        let mut inverse = vec![T::zero(); rows.len()];
        factor(&mut rows, &mut inverse);
        solve(&rows, &inverse, &mut x);
        x
    }

    /// Returns the mass matrix with the rows of a floating base.
    pub(crate) fn floating_mass_of_loops<T: Scalar>(&self, q: &[T], passive: &[T]) -> Vec<Vec<T>> {
        let of_tree = self.definition().floating_mass_matrix(&self.closed.of_tree(q, passive), AtTip::Nothing);
        self.projected(&self.map(q, passive), BASE, &of_tree)
    }

    /// Returns the accelerations of a floating base and of the joints.
    pub(crate) fn floating_accelerations_of_loops<T: Scalar>(
        &self,
        [q, passive, qd, tau]: [&[T]; 4],
        omega: &[T; 3],
        load: AtTip<'_, T>,
    ) -> DynFloatingAccelerations<T> {
        let still = vec![T::zero(); q.len()];
        let DynFloatingTorques { wrench: Wrench { force, moment }, tau: of_joints } =
            self.torques_of_loops([q, passive, qd, &still], &turning(omega), load);
        let bias = force.into_iter().chain(moment).chain(of_joints);
        let applied = [T::zero(); BASE].into_iter().chain(tau.iter().copied());
        let mut x: Vec<T> = applied.zip(bias).map(|(applied, bias)| applied - bias).collect();
        let mut matrix = self.floating_mass_of_loops(q, passive);
        solve_from_the_ends(&mut matrix, &mut vec![T::zero(); x.len()], &mut x);
        DynFloatingAccelerations { base: of_base(&x), qdd: x.split_off(BASE) }
    }

    /// Returns the symmetric matrix of the coordinates from that of the tree. The first `of_base` rows and columns,
    /// those of the base, are not changed by the loops.
    fn projected<T: Scalar>(&self, map: &[Vec<T>], of_base: usize, of_tree: &[Vec<T>]) -> Vec<Vec<T>> {
        let gathered = |row: &[T]| [&row[..of_base], &self.by_coordinates(map, &row[of_base..])].concat();
        let columns: Vec<Vec<T>> = of_tree.iter().map(|row| gathered(row)).collect();
        let column = |at: usize| gathered(&columns.iter().map(|row| row[at]).collect::<Vec<_>>());
        let mut matrix: Vec<Vec<T>> = (0..of_base + self.closed.coordinates.len()).map(column).collect();
        for row in 1..matrix.len() {
            let (above, rest) = matrix.split_at_mut(row);
            rest[0].iter_mut().zip(above).for_each(|(element, upper)| *element = upper[row]);
        }
        matrix
    }

    /// Whether a list has one element for each joint that moves by itself.
    pub(crate) fn has_coordinates<T>(&self, argument: &'static str, values: &[T]) -> Result<(), WrongLength> {
        has_length(argument, values, self.closed.coordinates.len())
    }

    /// Whether a list has one element for each dependent joint.
    pub(crate) fn has_passive<T>(&self, argument: &'static str, values: &[T]) -> Result<(), WrongLength> {
        has_length(argument, values, self.closed.passive.len())
    }

    /// Returns Gᵀ of numbers of the tree: those of the coordinates, plus the contributions of the dependent joints.
    fn by_coordinates<T: Scalar>(&self, map: &[Vec<T>], of_tree: &[T]) -> Vec<T> {
        let of_coordinate = |(at, &place): (usize, &usize)| {
            let passive = self.closed.passive.iter().zip(map);
            passive.fold(of_tree[place], |sum, (&passive, row)| sum + row[at] * of_tree[passive])
        };
        self.closed.coordinates.iter().enumerate().map(of_coordinate).collect()
    }

    /// Returns -K_p⁻¹ b, one number per dependent joint, by Gaussian elimination in the order of the robot file.
    fn solved<T: Scalar>(&self, rows: &[Vec<T>], b: &[T]) -> Vec<T> {
        let Loops { passive, elimination, .. } = &self.closed;
        let system = elimination.iter().map(|row| {
            let elements = elimination.iter().map(|column| rows[row.equation][passive[column.passive]]);
            elements.chain([b[row.equation]]).collect::<Vec<T>>()
        });
        let mut system: Vec<Vec<T>> = system.collect();
        let size = system.len();
        for step in 0..size {
            let (above, below) = system.split_at_mut(step + 1);
            let pivot = &above[step];
            for row in below {
                let factor = row[step] / pivot[step];
                row.iter_mut().zip(pivot).skip(step).for_each(|(x, &by)| *x -= factor * by);
            }
        }
        let mut x = vec![T::zero(); size];
        for step in (0..size).rev() {
            let row = &system[step];
            let known = (step + 1..size).fold(row[size], |sum, at| sum - row[at] * x[at]);
            x[step] = known / row[step];
        }
        let mut by_joint = x.clone();
        for (pivot, x) in elimination.iter().zip(x) {
            by_joint[pivot.passive] = -x;
        }
        by_joint
    }

    /// Returns the equations in a state. Without rates the biases are those of zero velocities.
    fn equations<T: Scalar>(&self, q: &[T], passive: &[T], rates: Option<(&[T], &[T])>) -> Equations<T> {
        let q = self.closed.of_tree(q, passive);
        let q = self.couplings.of_joints(&q).into_owned();
        let zero = vec![T::zero(); q.len()];
        let qd = match rates {
            Some((qd, passive)) => self.couplings.of_joints(&self.closed.of_tree(qd, passive)).into_owned(),
            None => zero.clone(),
        };
        let mut equations = Equations { residuals: Vec::new(), rows: Vec::new(), biases: Vec::new() };
        for ((cut, between), &joint) in self.closed.cuts.iter().zip(&self.closed.axes) {
            let places = between.each_ref().map(|place| self.place(place, &q, &qd));
            let [one, other] = &places;
            let loop_axes = joint.map_or_else(Matrix3::identity, |joint| self.axes_of(joint, &q)).transpose();
            let apart = loop_axes * (other.origin - one.origin);
            equations.residuals.extend(apart.iter().copied());
            let falling = loop_axes * (other.acceleration - one.acceleration);
            equations.biases.extend(falling.iter().copied());
            let difference = |row: usize| -> Vec<T> {
                let rows = places.each_ref().map(|place| &place.jacobian[row]);
                rows[1].iter().zip(rows[0]).map(|(&b, &a)| b - a).collect()
            };
            let [linear, angular] = [0, 3].map(|first| [0, 1, 2].map(|axis| difference(first + axis)));
            let along = |axis: &Vector3<T>, rows: &[Vec<T>; 3]| -> Vec<T> {
                (0..rows[0].len()).map(|at| axis.dot(&Vector3::new(rows[0][at], rows[1][at], rows[2][at]))).collect()
            };
            for axis in loop_axes.row_iter() {
                equations.rows.push(along(&axis.transpose(), &linear));
            }
            for &[a, b] in cut.perpendicular() {
                let (a, b) = (one.axes.column(a).into_owned(), other.axes.column(b).into_owned());
                let normal = b.cross(&a);
                equations.residuals.push(a.dot(&b));
                equations.rows.push(along(&normal, &angular));
                let moving = other.omega.cross(&b).cross(&a) + b.cross(&one.omega.cross(&a));
                let turning = normal.dot(&(other.omega_dot - one.omega_dot));
                equations.biases.push(turning + moving.dot(&(other.omega - one.omega)));
            }
        }
        equations
    }
}

/// A place of a loop in axes of frame 0, with its acceleration when no joint accelerates.
struct Place<T> {
    axes: Matrix3<T>,
    origin: Vector3<T>,
    /// Three linear rows, then three angular rows.
    jacobian: [Vec<T>; 6],
    omega: Vector3<T>,
    omega_dot: Vector3<T>,
    acceleration: Vector3<T>,
}

impl<S: Constant> Mechanism<'_, Counted, S> {
    /// Returns axes and origin of a place on a link, in frame 0, and the Jacobian of the place.
    #[allow(clippy::type_complexity)] // axes, origin, rows
    fn placed<T: Scalar>(self, place: &FixedFrame<S>, q: &[T]) -> (Matrix3<T>, Vector3<T>, [Vec<T>; 6]) {
        let start = Placement::identity();
        let links = self.placements(start, q);
        let at_place = Mechanism { at: Some(place), ..self };
        let (rows, origin) = at_place.jacobian_from(start, links.as_ref());
        (at_place.tip(start, links.as_ref()).rotation, origin, rows)
    }

    /// Returns the axes of a joint in frame 0. In a modified table they turn with its link.
    fn axes_of_joint<T: Scalar>(self, joint: usize, q: &[T]) -> Matrix3<T> {
        let start = Placement::identity();
        self.joint_frame(joint, start, self.placements(start, q).as_ref()).rotation
    }
}

impl<S: Constant> DynArm<S> {
    fn place<T: Scalar>(&self, place: &FixedFrame<S>, q: &[T], qd: &[T]) -> Place<T> {
        let rest = [T::zero(); 3];
        let identity = Matrix3::identity();
        let mechanism = self.mechanism();
        let (axes, origin, rows) = mechanism.placed(place, q);
        let omega = Vector3::new(dot(&rows[3], qd), dot(&rows[4], qd), dot(&rows[5], qd));
        let [x, y, z, about_x, about_y, about_z] = mechanism.tip_acceleration((q, qd), &rest, identity, place);
        Place {
            axes,
            origin,
            jacobian: self.couplings.rows(rows),
            omega,
            omega_dot: Vector3::new(about_x, about_y, about_z),
            acceleration: Vector3::new(x, y, z),
        }
    }

    /// Returns the axes of a joint in frame 0, at the zero position of a revolute joint.
    fn axes_of<T: Scalar>(&self, joint: usize, q: &[T]) -> Matrix3<T> {
        let mut still = q.to_vec();
        let row = &self.rows()[joint];
        if row.kind == JointKind::Revolute {
            still[joint] = T::zero();
        }
        let turned = self.mechanism().axes_of_joint(joint, &still);
        let (sin, cos) = (row.dh.theta.sin.to::<T>(), row.dh.theta.cos.to::<T>());
        let (zero, one) = (T::zero(), T::one());
        match self.convention() {
            rne_model::Convention::Standard => turned,
            rne_model::Convention::Modified => turned * Matrix3::new(cos, sin, zero, -sin, cos, zero, zero, zero, one),
        }
    }
}

fn has_length<T>(argument: &'static str, values: &[T], expected: usize) -> Result<(), WrongLength> {
    let found = values.len();
    if found == expected { Ok(()) } else { Err(WrongLength { argument, expected, found }) }
}

fn dot<T: Scalar>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::zero(), |sum, (&a, &b)| sum + a * b)
}

fn product<T: Scalar>(rows: &[Vec<T>], x: &[T]) -> Vec<T> {
    rows.iter().map(|row| dot(row, x)).collect()
}
