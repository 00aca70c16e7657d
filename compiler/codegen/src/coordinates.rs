//! The coordinates of a robot: the joints that follow no other, and how the other joints follow them.
//!
//! The positions of all joints are G q + offsets, with the ratios of the couplings in the constant matrix G; velocities
//! and accelerations are G q̇ and G q̈. The torques that work on the coordinates are Gᵀ τ, the mass matrix is Gᵀ M G,
//! with τ and M of a robot whose joints all move freely. A robot without couplings has G = 1.
//!
//! The dependent joints of closed loops have positions that are arguments. Their rows of G depend on the positions, and
//! their accelerations are G q̈ + Ġ q̇; [`Closure`](crate::formulate::Closure) writes both.

use rne_model::Robot;

use crate::ir::{Builder, Cause, Name, Quantity, Symbol};

/// The coordinates of a robot, and the joints that follow them. Joints are counted from 0.
#[derive(Clone, Debug)]
pub(crate) struct Coordinates {
    /// The joints that follow no other, in the order of q.
    joints: Vec<usize>,
    /// For each joint the joints that it follows by a coupling, with their ratios; `None` for a coordinate, and for a
    /// dependent joint of closed loops.
    follows: Vec<Option<Vec<(usize, f64)>>>,
    /// The dependent joints of closed loops.
    passive: Vec<usize>,
    /// For each joint, the coordinates with which it moves, and the factors of their rates; `None` for a coordinate.
    moves: Vec<Option<Vec<(usize, Ratio)>>>,
    /// For each rotor, the joints with which it turns, and the link that carries it; `None` for the base.
    rotors: Vec<(Vec<usize>, Option<usize>)>,
}

/// The factor by which the rate of one joint enters the rate of another joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ratio {
    factor: f64,
    /// The element of the map of closed loops that multiplies `factor`: the indices of a dependent joint and of a
    /// coordinate.
    of_loop: Option<[usize; 2]>,
}

impl Ratio {
    pub(crate) const ONE: Self = Self::constant(1.0);

    pub(crate) const fn constant(factor: f64) -> Self {
        Self { factor, of_loop: None }
    }
}

/// Returns the coordinates with which a joint moves, and the factors; a dependent joint moves with the coordinates of
/// its loops.
fn moved(
    (robot, linked): (&Robot, &[Vec<usize>]),
    joints: &[usize],
    follows: &[Option<Vec<(usize, f64)>>],
    joint: usize,
) -> Option<Vec<(usize, Ratio)>> {
    let passive = &robot.closed.passive;
    let of_passive = |joint: usize, factor: f64| match passive.iter().position(|&other| other == joint) {
        Some(place) => {
            let is_linked = |other: usize| linked.iter().any(|group| group.contains(&joint) && group.contains(&other));
            let of_loop =
                |(coordinate, &joint): (usize, &usize)| (joint, Ratio { factor, of_loop: Some([place, coordinate]) });
            joints.iter().enumerate().filter(|(_, other)| is_linked(**other)).map(of_loop).collect::<Vec<_>>()
        }
        None => vec![(joint, Ratio::constant(factor))],
    };
    match &follows[joint] {
        Some(follows) => Some(follows.iter().flat_map(|&(joint, ratio)| of_passive(joint, ratio)).collect()),
        None => passive.contains(&joint).then(|| of_passive(joint, 1.0)),
    }
}

/// Returns the joints of closed loops in groups: loops that share joints determine each other, so they are in one
/// group.
fn linked(robot: &Robot, follows: &[Option<Vec<(usize, f64)>>]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for closed in &robot.closed.loops {
        let joints = robot.ways_of_loop(closed).concat();
        let followed = joints.iter().flat_map(|&joint| follows[joint].iter().flatten().map(|(followed, _)| *followed));
        let mut group: Vec<usize> = followed.chain(joints.iter().copied()).collect();
        groups.retain(|other| {
            let is_apart = other.iter().all(|joint| !group.contains(joint));
            if !is_apart {
                group.extend(other);
            }
            is_apart
        });
        groups.push(group);
    }
    groups
}

impl Coordinates {
    pub(crate) fn of(robot: &Robot) -> Self {
        let follows = |joint: &rne_model::Joint| joint.coupling.as_ref().map(|coupling| coupling.follows.clone());
        let follows: Vec<_> = robot.joints.iter().map(follows).collect();
        let (joints, passive): (Vec<usize>, _) = (robot.coordinates().collect(), robot.closed.passive.clone());
        let linked = linked(robot, &follows);
        let moves = (0..follows.len()).map(|joint| moved((robot, &linked), &joints, &follows, joint)).collect();
        let rotors = robot.spinning_rotors();
        let rotors = rotors.map(|(rotor, turns)| (turns.iter().map(|(joint, _)| *joint).collect(), rotor.on)).collect();
        Self { joints, follows, passive, moves, rotors }
    }

    /// The coordinates of joints of which none follows another.
    pub(crate) fn of_free_joints(joints: usize) -> Self {
        Self {
            joints: (0..joints).collect(),
            follows: vec![None; joints],
            passive: Vec::new(),
            moves: vec![None; joints],
            rotors: Vec::new(),
        }
    }

    /// The joints that follow no other, in the order of q.
    pub(crate) fn joints(&self) -> &[usize] {
        &self.joints
    }

    /// The dependent joints of closed loops, in their order.
    pub(crate) fn passive(&self) -> &[usize] {
        &self.passive
    }

    /// Whether a joint follows no other.
    pub(crate) fn has(&self, joint: usize) -> bool {
        self.moves[joint].is_none()
    }

    /// Returns the joints whose positions determine that of a joint, and their ratios; the joint itself if it follows
    /// no other.
    pub(crate) fn followed(&self, joint: usize) -> Vec<(usize, f64)> {
        self.follows[joint].clone().unwrap_or_else(|| vec![(joint, 1.0)])
    }

    /// Whether no joint follows another.
    pub(crate) fn is_every_joint(&self) -> bool {
        self.joints.len() == self.follows.len()
    }

    /// Returns the name of the torque of a joint: a result if no joint is coupled to it, else one part of the torques
    /// of the coupled joints.
    pub(crate) fn name_of_torque(&self, joint: usize) -> Name {
        let is_alone = self.has(joint) && self.followers(joint).next().is_none();
        Name::scalar(if is_alone { Quantity::Torque } else { Quantity::AxisTorque }, joint + 1)
    }

    /// Returns position, rate or acceleration of a joint: an argument of the function, or a sum of arguments if the
    /// joint follows others.
    pub(crate) fn of_joint<'s>(&self, builder: &'s Builder, quantity: Quantity, joint: usize) -> Symbol<'s> {
        let argument = |joint: usize| {
            let name = Name::scalar(quantity, joint + 1);
            let solved = (quantity == Quantity::RateDot).then(|| builder.solved_acceleration(name)).flatten();
            solved.unwrap_or_else(|| builder.argument(name))
        };
        let is_position = quantity == Quantity::Position;
        let own = [(joint, Ratio::ONE)];
        let followed: Vec<(usize, Ratio)> = match (&self.moves[joint], &self.follows[joint]) {
            (None, _) | (Some(_), None) if is_position || self.has(joint) => return argument(joint),
            (_, Some(follows)) if is_position => {
                follows.iter().map(|&(joint, ratio)| (joint, Ratio::constant(ratio))).collect()
            }
            (moves, _) => moves.as_deref().unwrap_or(&own).to_vec(),
        };
        let line = builder.joint(joint + 1);
        let bias = (quantity == Quantity::RateDot).then(|| self.bias(builder, joint)).flatten();
        let sum = || {
            let terms = followed.iter().map(|&(followed, ratio)| scaled(argument(followed), ratio));
            terms.chain(bias).reduce(|sum, term| sum + term).unwrap_or_else(|| builder.zero())
        };
        quantity.of_follower().map_or_else(sum, |quantity| builder.by(None, || line.define(quantity).by(sum())))
    }

    /// Returns the acceleration Ġ q̇ of a joint if no coordinate accelerates; `None` if closed loops do not move it.
    pub(crate) fn bias<'s>(&self, builder: &'s Builder, joint: usize) -> Option<Symbol<'s>> {
        let place = |joint: usize| self.passive.iter().position(|&other| other == joint);
        let terms = self
            .followed(joint)
            .into_iter()
            .filter_map(|(followed, ratio)| Some(scaled(builder.loop_bias(place(followed)?), Ratio::constant(ratio))));
        terms.reduce(|sum, term| sum + term)
    }

    /// Returns the torque or force of the actuator of a joint: an argument, or zero for a follower, which has no
    /// actuator.
    pub(crate) fn applied<'s>(&self, builder: &'s Builder, joint: usize) -> Symbol<'s> {
        match self.moves[joint] {
            None => builder.argument(Name::scalar(Quantity::AppliedTorque, joint + 1)),
            Some(_) => builder.constant(0.0, Cause::Arithmetic),
        }
    }

    /// Returns Gᵀ x, one element for each coordinate, from one element for each joint. `plus` adds two elements,
    /// `times` multiplies an element by a ratio.
    pub(crate) fn gathered<T: Clone>(
        &self,
        of_joints: &[T],
        plus: impl Fn(T, T) -> T,
        times: impl Fn(T, Ratio) -> T,
    ) -> Vec<T> {
        if self.is_every_joint() {
            return of_joints.to_vec();
        }
        let of_coordinate = |&joint: &usize| {
            let own = of_joints[joint].clone();
            self.followers(joint)
                .fold(own, |sum, (follower, ratio)| plus(sum, times(of_joints[follower].clone(), ratio)))
        };
        self.joints.iter().map(of_coordinate).collect()
    }

    /// Returns one number for each coordinate and then for each dependent joint, from one for each joint. The numbers
    /// of joints that follow others by couplings are added to those of the joints that they follow.
    pub(crate) fn of_tree<'s>(&self, of_joints: &[Symbol<'s>]) -> Vec<Symbol<'s>> {
        let of_joint = |&joint: &usize| {
            let followers = self.follows.iter().enumerate().flat_map(|(follower, follows)| {
                let of_joint = follows.iter().flatten().filter(|(followed, _)| *followed == joint);
                of_joint.map(move |(_, ratio)| (follower, Ratio::constant(*ratio)))
            });
            followers.fold(of_joints[joint], |sum, (follower, ratio)| sum + scaled(of_joints[follower], ratio))
        };
        self.joints.iter().chain(&self.passive).map(of_joint).collect()
    }

    /// Gives a result its name, if it is gathered from several joints. A part of it from one joint loses this name.
    pub(crate) fn named<'s>(&self, name: Name, result: Symbol<'s>) -> (Name, Symbol<'s>) {
        (name, if self.is_every_joint() { result } else { result.builder.name(name, result) })
    }

    /// Gᵀ τ, one torque for each coordinate.
    pub(crate) fn torques<'s>(&self, of_joints: &[Symbol<'s>]) -> Vec<Symbol<'s>> {
        self.gathered(of_joints, |a, b| a + b, scaled)
    }

    /// Gᵀ A G of a matrix A, by rows.
    pub(crate) fn matrix<'s>(&self, of_joints: &[Vec<Symbol<'s>>]) -> Vec<Vec<Symbol<'s>>> {
        let rows: Vec<_> = of_joints.iter().map(|row| self.torques(row)).collect();
        let plus = |a: Vec<Symbol<'s>>, b: Vec<Symbol<'s>>| a.into_iter().zip(b).map(|(a, b)| a + b).collect();
        let times = |row: Vec<Symbol<'s>>, ratio| row.into_iter().map(|x| scaled(x, ratio)).collect::<Vec<_>>();
        self.gathered(&rows, plus, times)
    }

    /// The upper half of Gᵀ M G, from that of M: row i has the elements (i, i) to (i, n).
    pub(crate) fn upper_half<'s>(&self, builder: &'s Builder, upper: Vec<Vec<Symbol<'s>>>) -> Vec<Vec<Symbol<'s>>> {
        if self.is_every_joint() {
            return upper;
        }
        let element = |row: usize, column: usize| upper[row.min(column)][row.max(column) - row.min(column)];
        let moved = |coordinate: usize| {
            std::iter::once((coordinate, Ratio::ONE)).chain(self.followers(coordinate)).collect::<Vec<_>>()
        };
        let gathered = |row: usize, column: usize| {
            let (rows, columns) = (moved(row), moved(column));
            let of_row = |&(row, of_row): &(usize, Ratio)| {
                let terms = columns.iter().map(move |&(column, ratio)| (element(row, column), ratio));
                let terms = terms.map(|(element, ratio)| scaled(element, ratio));
                terms.reduce(|sum, term| sum + term).map(|sum| scaled(sum, of_row))
            };
            rows.iter().filter_map(of_row).reduce(|sum, term| sum + term).unwrap_or_else(|| builder.zero())
        };
        let row = |(at, &row): (usize, &usize)| self.joints[at..].iter().map(|&column| gathered(row, column)).collect();
        self.joints.iter().enumerate().map(row).collect()
    }

    /// Whether the mass matrix can have an element that is not zero for two coordinates: both can move the same link,
    /// or a rotor that one turns and the other turns or carries. `parents` are the links that carry the joints.
    pub(crate) fn meet(&self, parents: &[Option<usize>], [one, other]: [usize; 2]) -> bool {
        let moves = |joint: usize, other: usize| {
            std::iter::successors(Some(other), |&link| parents[link]).any(|link| link == joint)
        };
        let moved = |coordinate: usize| {
            let joint = self.joints[coordinate];
            std::iter::once(joint).chain(self.followers(joint).map(|(follower, _)| follower)).collect::<Vec<_>>()
        };
        // the energy of a rotor has products of two rates: one turns it, the other turns it or moves its carrier
        let by_rotor = |a: usize, b: usize| {
            self.rotors.iter().any(|(turns, on)| {
                turns.contains(&a) && (turns.contains(&b) || on.is_some_and(|carrier| moves(b, carrier)))
            })
        };
        let share = |a: usize, b: usize| moves(a, b) || moves(b, a) || by_rotor(a, b) || by_rotor(b, a);
        moved(one).iter().any(|&a| moved(other).iter().any(|&b| share(a, b)))
    }

    /// The joints that follow a coordinate, with their ratios.
    fn followers(&self, coordinate: usize) -> impl Iterator<Item = (usize, Ratio)> {
        let of_joint = move |(joint, moves): (usize, &Option<Vec<(usize, Ratio)>>)| {
            let with_it = moves.iter().flatten().filter(move |(followed, _)| *followed == coordinate);
            with_it.map(move |(_, ratio)| (joint, *ratio)).collect::<Vec<_>>()
        };
        self.moves.iter().enumerate().flat_map(of_joint)
    }
}

/// A number times a ratio.
pub(crate) fn scaled(x: Symbol<'_>, Ratio { factor, of_loop }: Ratio) -> Symbol<'_> {
    let builder = x.builder;
    let x = of_loop.map_or(x, |[passive, coordinate]| x * builder.loop_map(passive, coordinate));
    if factor.abs() == 1.0 { x.signed(factor < 0.0) } else { x * builder.constant(factor, Cause::Arithmetic) }
}
