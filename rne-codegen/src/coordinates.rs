//! The coordinates of a robot: the joints that follow no other, and how the other joints follow them.
//!
//! The positions of all joints are G q + offsets, with the ratios of the couplings in the constant matrix G; velocities
//! and accelerations are G q̇ and G q̈. The torques that work on the coordinates are Gᵀ τ, the mass matrix is Gᵀ M G,
//! with τ and M of a robot whose joints all move freely. A robot without couplings has G = 1.

use rne_model::Robot;

use crate::ir::{Builder, Cause, Name, Quantity, Symbol};

/// The coordinates of a robot, and the joints that follow them. Joints are counted from 0.
#[derive(Clone, Debug)]
pub(crate) struct Coordinates {
    /// The joints that follow no other, in the order of q.
    joints: Vec<usize>,
    /// For each joint the joints that it follows, with their ratios; `None` for a coordinate.
    follows: Vec<Option<Vec<(usize, f64)>>>,
    /// For each rotor the joints with which it turns, and the link that carries it; `None` for the base.
    rotors: Vec<(Vec<usize>, Option<usize>)>,
}

impl Coordinates {
    pub(crate) fn of(robot: &Robot) -> Self {
        let follows = |joint: &rne_model::Joint| joint.coupling.as_ref().map(|coupling| coupling.follows.clone());
        let rotors = robot.spinning_rotors();
        let rotors = rotors.map(|(rotor, turns)| (turns.iter().map(|(joint, _)| *joint).collect(), rotor.on)).collect();
        Self { joints: robot.coordinates().collect(), follows: robot.joints.iter().map(follows).collect(), rotors }
    }

    /// Joints none of which follows another.
    pub(crate) fn of_free_joints(joints: usize) -> Self {
        Self { joints: (0..joints).collect(), follows: vec![None; joints], rotors: Vec::new() }
    }

    /// The joints that follow no other, in the order of q.
    pub(crate) fn joints(&self) -> &[usize] {
        &self.joints
    }

    /// Whether a joint follows no other.
    pub(crate) fn has(&self, joint: usize) -> bool {
        self.follows[joint].is_none()
    }

    /// The coordinates with which a joint moves, and their ratios.
    pub(crate) fn followed(&self, joint: usize) -> Vec<(usize, f64)> {
        self.follows[joint].clone().unwrap_or_else(|| vec![(joint, 1.0)])
    }

    /// Whether no joint follows another.
    pub(crate) fn is_every_joint(&self) -> bool {
        self.joints.len() == self.follows.len()
    }

    /// The name of what a joint needs: a torque, or one part of those of the joints that it follows or that follow it.
    pub(crate) fn torque(&self, joint: usize) -> Name {
        let is_alone = self.has(joint) && self.followers(joint).next().is_none();
        Name::scalar(if is_alone { Quantity::Torque } else { Quantity::AxisTorque }, joint + 1)
    }

    /// Position, rate or acceleration of a joint: an argument of the function, or that of a follower.
    pub(crate) fn of_joint<'s>(&self, builder: &'s Builder, quantity: Quantity, joint: usize) -> Symbol<'s> {
        let argument = |joint: usize| builder.argument(Name::scalar(quantity, joint + 1));
        let Some(follows) = &self.follows[joint] else { return argument(joint) };
        let line = builder.joint(joint + 1);
        let sum = || {
            let terms = follows.iter().map(|&(followed, ratio)| scaled(argument(followed), ratio));
            terms.reduce(|sum, term| sum + term).unwrap_or_else(|| builder.zero())
        };
        quantity.of_follower().map_or_else(sum, |quantity| builder.by(None, || line.scalar(quantity, sum)))
    }

    /// The torque or force of the actuator of a joint: an argument; a follower has no actuator.
    pub(crate) fn applied<'s>(&self, builder: &'s Builder, joint: usize) -> Symbol<'s> {
        match self.follows[joint] {
            None => builder.argument(Name::scalar(Quantity::AppliedTorque, joint + 1)),
            Some(_) => builder.constant(0.0, Cause::Arithmetic),
        }
    }

    /// Gᵀ x, one element for each coordinate, from one for each joint. `plus` adds two of them, `times` multiplies
    /// one by a ratio.
    pub(crate) fn gathered<T: Clone>(
        &self,
        of_joints: &[T],
        plus: impl Fn(T, T) -> T,
        times: impl Fn(T, f64) -> T,
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

    /// Gives a result its name, where it is gathered from several joints: what one of them has loses that name.
    pub(crate) fn named<'s>(&self, name: Name, result: Symbol<'s>) -> (Name, Symbol<'s>) {
        (name, if self.is_every_joint() { result } else { result.builder.name(name, result) })
    }

    /// Gᵀ τ
    pub(crate) fn torques<'s>(&self, of_joints: &[Symbol<'s>]) -> Vec<Symbol<'s>> {
        self.gathered(of_joints, |a, b| a + b, scaled)
    }

    /// Gᵀ A G of a matrix by rows.
    pub(crate) fn matrix<'s>(&self, of_joints: &[Vec<Symbol<'s>>]) -> Vec<Vec<Symbol<'s>>> {
        let rows: Vec<_> = of_joints.iter().map(|row| self.torques(row)).collect();
        let plus = |a: Vec<Symbol<'s>>, b: Vec<Symbol<'s>>| a.into_iter().zip(b).map(|(a, b)| a + b).collect();
        let times = |row: Vec<Symbol<'s>>, ratio| row.into_iter().map(|x| scaled(x, ratio)).collect::<Vec<_>>();
        self.gathered(&rows, plus, times)
    }

    /// The upper half of Gᵀ M G, from that of M: row i holds the elements (i, i) to (i, n).
    pub(crate) fn upper_half<'s>(&self, builder: &'s Builder, upper: Vec<Vec<Symbol<'s>>>) -> Vec<Vec<Symbol<'s>>> {
        if self.is_every_joint() {
            return upper;
        }
        let element = |row: usize, column: usize| upper[row.min(column)][row.max(column) - row.min(column)];
        let moved = |coordinate: usize| {
            std::iter::once((coordinate, 1.0)).chain(self.followers(coordinate)).collect::<Vec<(usize, f64)>>()
        };
        let gathered = |row: usize, column: usize| {
            let (rows, columns) = (moved(row), moved(column));
            let of_row = |&(row, of_row): &(usize, f64)| {
                let terms = columns.iter().map(move |&(column, ratio)| (element(row, column), ratio));
                let terms = terms.map(|(element, ratio)| scaled(element, ratio));
                terms.reduce(|sum, term| sum + term).map(|sum| scaled(sum, of_row))
            };
            rows.iter().filter_map(of_row).reduce(|sum, term| sum + term).unwrap_or_else(|| builder.zero())
        };
        let row = |(at, &row): (usize, &usize)| self.joints[at..].iter().map(|&column| gathered(row, column)).collect();
        self.joints.iter().enumerate().map(row).collect()
    }

    /// Whether the motion of one coordinate can move a link that the other moves, one that such a link carries, or a
    /// rotor there: the mass matrix has an element for both then. `parents` are the links that carry the joints.
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
    fn followers(&self, coordinate: usize) -> impl Iterator<Item = (usize, f64)> {
        let ratio = move |follows: &Vec<(usize, f64)>| {
            follows.iter().find(|(followed, _)| *followed == coordinate).map(|(_, ratio)| *ratio)
        };
        let of_joint = move |(joint, follows): (usize, &Option<Vec<(usize, f64)>>)| {
            follows.as_ref().and_then(ratio).map(|ratio| (joint, ratio))
        };
        self.follows.iter().enumerate().filter_map(of_joint)
    }
}

/// A number times a ratio.
pub(crate) fn scaled(x: Symbol<'_>, ratio: f64) -> Symbol<'_> {
    if ratio.abs() == 1.0 { x.signed(ratio < 0.0) } else { x * x.builder.constant(ratio, Cause::Arithmetic) }
}
