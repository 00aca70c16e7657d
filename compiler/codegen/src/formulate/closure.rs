//! The equations of closed loops, and the motion of their dependent joints.
//!
//! A loop closes where two places of the tree meet. [`ClosedLoops`](rne_model::ClosedLoops) has its equations r = 0.
//! The chains of joints to both places begin at the last link that they share; that link may be taken as fixed. All
//! vectors are in the axes of the loop:
//!
//! ```text
//! r                  p₂ - p₁;                 a·b
//! column i of K      z_i × (p - p_i), z_i;    (b × a)·z_i           negative on the way to the first place
//! K̇ (q̇, ṗ)           p̈₂ - p̈₁;                (b × a)·(ω̇₂ - ω̇₁) + (ω₂ - ω₁)·((ω₂ × b) × a + b × (ω₁ × a))
//! ```
//!
//! a is an axis of the first place and b one of the second. K = [K_q K_p] has the columns of the independent joints and
//! of the dependent ones. Then G = -K_p⁻¹ K_q, Ġ q̇ = -K_p⁻¹ K̇ (q̇, ṗ), and a Newton step gives p - K_p⁻¹ r. One
//! equation is kept for each dependent joint; [`ClosedLoops::elimination`](rne_model::ClosedLoops) is their order. No
//! pivots are searched for: at a singular position there is a division by zero, and the results are not finite.

use rne_model::JointKind::{Prismatic, Revolute};
use rne_model::{ClosedLoop, FixedFrame, Pivot, Robot};

use crate::coordinates::Coordinates;
use crate::formulate::arm::{Placement, identity};
use crate::formulate::{Arm, Frame, Joint, JointState, Outputs};
use crate::ir::{Builder, Cause, Matrix, Name, Quantity, Symbol, Vector};

/// A joint on the way to a place: its axis and a point of that axis.
struct Station<'s> {
    joint: usize,
    axis: Vector<'s>,
    point: Vector<'s>,
}

/// The chain of joints from the last shared link to a place of a loop.
struct Way<'s> {
    stations: Vec<Station<'s>>,
    place: Frame<'s>,
}

/// The motion of a place of a loop if the independent joints do not accelerate.
struct Motion<'s> {
    omega: Vector<'s>,
    omega_dot: Vector<'s>,
    acceleration: Vector<'s>,
}

/// The equations of the closed loops of a robot.
pub(crate) struct Closure<'s> {
    builder: &'s Builder,
    loops: Vec<Ways<'s>>,
    /// The residual of each equation.
    residuals: Vec<Symbol<'s>>,
    /// K by rows; a column for each joint of the tree, except joints that follow another joint by a coupling.
    rows: Vec<Vec<Symbol<'s>>>,
}

/// Both chains of a loop, and the pairs of axes that must be perpendicular.
struct Ways<'s> {
    ways: [Way<'s>; 2],
    perpendicular: Vec<[Vector<'s>; 2]>,
}

impl<'s> Closure<'s> {
    /// Writes the closure equations of an arm at the given joint positions.
    pub(crate) fn of(arm: &Arm<'s>, robot: &Robot, states: &[JointState<'s>]) -> Self {
        let (builder, coordinates) = (arm.builder, &arm.coordinates);
        let mut closure = Self { builder, loops: Vec::new(), residuals: Vec::new(), rows: Vec::new() };
        for closed in &robot.closed.loops {
            let ways = Ways::of(arm, robot, states, closed);
            let [first, second] = &ways.ways;
            let apart = second.place.origin - first.place.origin;
            closure.residuals.extend(apart.0);
            closure.residuals.extend(ways.perpendicular.iter().map(|[a, b]| a.dot(*b)));
            let joints = robot.joints.len();
            let mut rows = vec![vec![builder.zero(); joints]; closed.cut.equations()];
            for (way, is_first) in [(first, true), (second, false)] {
                for Station { joint, axis, point } in &way.stations {
                    let [linear, angular] = match arm.links[*joint].kind {
                        Revolute => [axis.cross(way.place.origin - *point), *axis],
                        Prismatic => [*axis, builder.no_vector()],
                    };
                    let turns = ways.perpendicular.iter().map(|[a, b]| b.cross(*a).dot(angular));
                    for (row, x) in rows.iter_mut().zip(linear.0.into_iter().chain(turns)) {
                        row[*joint] = x.signed(is_first);
                    }
                }
            }
            closure.rows.extend(rows.iter().map(|row| coordinates.of_tree(row)));
            closure.loops.push(ways);
        }
        closure
    }

    /// Writes the map G and, where the joints have rates, Ġ q̇. The builder keeps both, to compute the rate and
    /// acceleration of each dependent joint.
    pub(crate) fn keep(builder: &'s Builder, robot: &Robot, has_rates: bool) {
        if robot.closed.is_empty() {
            return;
        }
        builder.unnamed(|| {
            let (arm, states) = (Arm::new(builder, robot), Self::states(builder, robot));
            let closure = Self::of(&arm, robot, &states);
            let solved = Solved::of(&closure, robot);
            builder.keep_loop_map(&solved.map(&closure, &arm.coordinates));
            if has_rates {
                let rate = |joint| arm.coordinates.of_joint(builder, Quantity::Rate, joint);
                let rates: Vec<Symbol<'s>> = (0..robot.joints.len()).map(rate).collect();
                builder.keep_loop_bias(&solved.of_rows(&closure.biases(&arm, &rates)));
            }
        });
    }

    /// Returns the joints at their positions, with zero rates and accelerations.
    fn states(builder: &'s Builder, robot: &Robot) -> Vec<JointState<'s>> {
        let coordinates = Coordinates::of(robot);
        let still = || builder.constant(0.0, Cause::AtRest);
        let state = |joint| JointState {
            q: coordinates.of_joint(builder, Quantity::Position, joint),
            turn: None,
            qd: still(),
            qdd: still(),
        };
        (0..robot.joints.len()).map(state).collect()
    }

    /// Returns K̇ (q̇, ṗ), one number for each equation.
    fn biases(&self, arm: &Arm<'s>, rates: &[Symbol<'s>]) -> Vec<Symbol<'s>> {
        let of_loop = |closed: &Ways<'s>| {
            let [one, other] = closed.ways.each_ref().map(|way| way.motion(arm, rates));
            let apart = other.acceleration - one.acceleration;
            let (turning, turning_dot) = (other.omega - one.omega, other.omega_dot - one.omega_dot);
            let turns = closed.perpendicular.iter().map(move |&[a, b]| {
                let moving = other.omega.cross(b).cross(a) + b.cross(one.omega.cross(a));
                b.cross(a).dot(turning_dot) + moving.dot(turning)
            });
            apart.0.into_iter().chain(turns).collect::<Vec<_>>()
        };
        self.loops.iter().flat_map(of_loop).collect()
    }
}

impl<'s> Ways<'s> {
    fn of(arm: &Arm<'s>, robot: &Robot, states: &[JointState<'s>], closed: &ClosedLoop) -> Self {
        let both = robot.ways_of_loop(closed);
        // the loop has the axes of this joint at θ = 0
        let axes = both.iter().flatten().next().map(|&joint| arm.links[joint].mount);
        let start = |rotation, lever| match axes {
            Some(axes) => {
                let back = axes.rotation.transpose();
                Frame { rotation: back * rotation, origin: back * (lever - axes.lever) }
            }
            None => Frame { rotation, origin: lever },
        };
        let ways = [0, 1].map(|end| Way::to(arm, states, &both[end], &closed.between[end], &start));
        let [first, second] = ways.each_ref().map(|way| way.place.rotation.transpose().0);
        let perpendicular = closed.cut.perpendicular().iter().map(|&[a, b]| [first[a], second[b]]).collect();
        Self { ways, perpendicular }
    }
}

impl<'s> Way<'s> {
    fn to(
        arm: &Arm<'s>,
        states: &[JointState<'s>],
        joints: &[usize],
        place: &FixedFrame,
        start: &impl Fn(Matrix<'s>, Vector<'s>) -> Frame<'s>,
    ) -> Self {
        let builder = arm.builder;
        let mut stations = Vec::new();
        // the axes of the last link so far, with the end of its offset as the origin
        let mut last: Option<Frame<'s>> = None;
        let next = |last: Option<Frame<'s>>, rotation, lever| match last {
            Some(Frame { rotation: axes, origin }) => {
                Frame { rotation: axes * rotation, origin: axes * lever + origin }
            }
            None => start(rotation, lever),
        };
        let all: Vec<Joint<'_, 's>> = arm.joints(states).collect();
        for &index in joints {
            let joint = &all[index];
            let mounted = next(last, joint.link.mount.rotation, joint.link.mount.lever);
            let rotation = mounted.rotation * joint.turn();
            stations.push(Station { joint: index, axis: mounted.axis(), point: mounted.origin });
            last = Some(Frame { rotation, origin: rotation * joint.offset(joint.link.offset) + mounted.origin });
        }
        let Placement { rotation, translation } = Placement::constant(builder, &place.placement);
        let table = place.on.map_or_else(|| identity(builder), |on| arm.links[on].table_axes);
        Self { stations, place: next(last, table * rotation, table * translation) }
    }

    /// Returns the motion of the place, given the rates of all joints.
    fn motion(&self, arm: &Arm<'s>, rates: &[Symbol<'s>]) -> Motion<'s> {
        let nothing = arm.builder.no_vector();
        let mut motion = Motion { omega: nothing, omega_dot: nothing, acceleration: nothing };
        for (at, Station { joint, axis, point }) in self.stations.iter().enumerate() {
            let rate = *axis * rates[*joint];
            let Motion { omega, omega_dot, acceleration } = motion;
            // vector to the next joint, or after the last joint to the place
            let span = self.stations.get(at + 1).map_or(self.place.origin, |next| next.point) - *point;
            motion = match arm.links[*joint].kind {
                Revolute => {
                    let (omega_dot, omega) = (omega_dot + omega.cross(rate), omega + rate);
                    let acceleration = acceleration + omega_dot.cross(span) + omega.cross(omega.cross(span));
                    Motion { omega, omega_dot, acceleration }
                }
                Prismatic => {
                    let sliding = omega.cross(rate);
                    let rigid = acceleration + omega_dot.cross(span) + omega.cross(omega.cross(span));
                    Motion { omega, omega_dot, acceleration: rigid + sliding + sliding }
                }
            };
        }
        motion
    }
}

/// The kept equations after elimination: K_p = L U in the order of elimination.
struct Solved<'s> {
    /// The equation and the dependent joint of each elimination step.
    order: Vec<Pivot>,
    /// Rows of L to the left of its diagonal of ones.
    lower: Vec<Vec<Symbol<'s>>>,
    /// Rows of U to the right of the diagonal.
    upper: Vec<Vec<Symbol<'s>>>,
    /// The reciprocals of the diagonal of U.
    inverses: Vec<Symbol<'s>>,
}

impl<'s> Solved<'s> {
    fn of(closure: &Closure<'s>, robot: &Robot) -> Self {
        let (builder, order) = (closure.builder, robot.closed.elimination.clone());
        let dof = robot.dof();
        let mut rows: Vec<Vec<Symbol<'s>>> = order
            .iter()
            .map(|row| order.iter().map(|column| closure.rows[row.equation][dof + column.passive]).collect())
            .collect();
        let one = builder.entry(Name::scalar(Quantity::One, 0), 1.0);
        let (mut lower, mut inverses) = (vec![Vec::new(); order.len()], Vec::new());
        for step in 0..order.len() {
            let inverse = builder.quotient(one, rows[step][step]);
            inverses.push(inverse);
            let (above, below) = rows.split_at_mut(step + 1);
            let of_pivot = &above[step];
            for (row, factors) in below.iter_mut().zip(&mut lower[step + 1..]) {
                let factor = row[step] * inverse;
                for (x, &pivot) in row.iter_mut().zip(of_pivot).skip(step + 1) {
                    *x = *x - factor * pivot;
                }
                factors.push(factor);
            }
        }
        let upper = rows.into_iter().enumerate().map(|(step, row)| row[step + 1..].to_vec()).collect();
        Self { order, lower, upper, inverses }
    }

    /// Returns -K_p⁻¹ b, one number for each dependent joint; `b` has one number for each equation.
    fn of_rows(&self, b: &[Symbol<'s>]) -> Vec<Symbol<'s>> {
        let mut y: Vec<Symbol<'s>> = Vec::with_capacity(self.order.len());
        for (pivot, row) in self.order.iter().zip(&self.lower) {
            y.push(row.iter().zip(&y).fold(b[pivot.equation], |sum, (&l, &y)| sum - l * y));
        }
        for step in (0..y.len()).rev() {
            let rest = self.upper[step].iter().zip(&y[step + 1..]).fold(y[step], |sum, (&u, &x)| sum - u * x);
            y[step] = rest * self.inverses[step];
        }
        let mut x = y.clone();
        for (pivot, y) in self.order.iter().zip(y) {
            x[pivot.passive] = -y;
        }
        x
    }

    /// Returns G by rows.
    fn map(&self, closure: &Closure<'s>, coordinates: &Coordinates) -> Vec<Vec<Symbol<'s>>> {
        let column = |place: usize| self.of_rows(&closure.rows.iter().map(|row| row[place]).collect::<Vec<_>>());
        let columns: Vec<_> = (0..coordinates.joints().len()).map(column).collect();
        (0..self.order.len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
    }
}

/// Returns one Newton step: the new positions of the dependent joints, then the residuals of the equations before the
/// step.
pub(crate) fn step<'s>(builder: &'s Builder, robot: &Robot) -> Outputs<'s> {
    let (closure, changes) = builder.unnamed(|| {
        let arm = Arm::new(builder, robot);
        let closure = Closure::of(&arm, robot, &Closure::states(builder, robot));
        let changes = Solved::of(&closure, robot).of_rows(&closure.residuals);
        (closure, changes)
    });
    let positions = robot.closed.passive.iter().zip(changes).map(|(joint, change)| {
        let position = builder.argument(Name::scalar(Quantity::Position, joint + 1));
        let line = builder.joint(joint + 1);
        let closed = line.define(Quantity::ClosedPosition).by(position + change);
        (Name::scalar(Quantity::ClosedPosition, joint + 1), closed)
    });
    let residuals = closure.residuals.iter().enumerate().map(|(equation, &residual)| {
        let name = Name::scalar(Quantity::Residual, equation + 1);
        (name, builder.name(name, residual))
    });
    positions.chain(residuals).collect()
}

/// Returns the elements of G, the map from independent to dependent joint rates, by rows.
pub(crate) fn map<'s>(builder: &'s Builder, coordinates: &Coordinates) -> Outputs<'s> {
    let places = coordinates.passive().iter().enumerate();
    let elements = places.flat_map(|(passive, joint)| {
        coordinates.joints().iter().enumerate().map(move |(coordinate, by)| {
            let name = Name::indexed(Quantity::LoopMap, joint + 1, by + 1);
            (name, builder.name(name, builder.loop_map(passive, coordinate)))
        })
    });
    elements.collect()
}

/// Returns the accelerations Ġ q̇ of the dependent joints, which they have if no independent joint accelerates.
pub(crate) fn bias<'s>(builder: &'s Builder, coordinates: &Coordinates) -> Outputs<'s> {
    let places = coordinates.passive().iter().enumerate();
    let of_joint = |(passive, joint): (usize, &usize)| {
        let name = Name::scalar(Quantity::LoopBias, joint + 1);
        (name, builder.name(name, builder.loop_bias(passive)))
    };
    places.map(of_joint).collect()
}
