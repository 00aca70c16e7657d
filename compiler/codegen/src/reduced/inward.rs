//! Moves quantities from link to link towards the base: they are rotated in two steps and moved to the parent's origin.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::ir::{Number, Symbol, Vector};
use crate::reduced::regrouping::{group_start, is_parallel};
use crate::reduced::{Arm, SymbolicTurn, Twist, Wrench};

/// The frames in which composite and articulated bodies are expressed and added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExpressedIn {
    /// The frame of each joint.
    JointFrame,
    /// The frame N of the first axis of a group of parallel axes.
    GroupFrame,
}

/// A symmetric matrix: xx, yy, zz, xy, xz, yz.
pub(crate) type Symmetric<'s> = [Symbol<'s>; 6];

/// Returns all elements of a symmetric matrix, by rows.
pub(crate) fn full([xx, yy, zz, xy, xz, yz]: Symmetric<'_>) -> [[Symbol<'_>; 3]; 3] {
    [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
}

/// A rotation about an axis that the frames before and after it have in common.
#[derive(Clone, Copy)]
pub(crate) enum Turned<'s> {
    AboutX(SymbolicTurn<'s>),
    AboutZ(SymbolicTurn<'s>),
}

impl<'s> Turned<'s> {
    /// Returns R v.
    pub(crate) fn of(self, v: Vector<'s>) -> Vector<'s> {
        match self {
            Self::AboutX(turn) => turn.about_x(v),
            Self::AboutZ(turn) => turn.about_z(v),
        }
    }

    /// Returns R S Rᵀ.
    pub(crate) fn of_symmetric(self, [xx, yy, zz, xy, xz, yz]: Symmetric<'s>) -> Symmetric<'s> {
        let SymbolicTurn { s: sine, c: cosine } = match self {
            Self::AboutZ(turn) => turn,
            Self::AboutX(turn) => {
                // a rotation about x is one about z after the axes are renamed: y, z, x for x, y, z
                let [yy, zz, xx, yz, xy, xz] = Self::AboutZ(turn).of_symmetric([yy, zz, xx, yz, xy, xz]);
                return [xx, yy, zz, xy, xz, yz];
            }
        };
        let difference = xx - yy;
        let twice = xy + xy;
        let (both, square) = (cosine * sine, cosine * cosine);
        let u = square * difference - both * twice;
        let turned_xy = both * difference + (square * twice - xy);
        [u + yy, xx - u, zz, turned_xy, cosine * xz - sine * yz, sine * xz + cosine * yz]
    }
}

/// A quantity that can be converted to other axes and to another reference point.
pub(crate) trait Inward<'s>: Sized {
    fn turned(self, turn: Turned<'s>) -> Self;

    /// Returns the quantity about another point, from which the old one is at t.
    fn moved(self, t: Vector<'s>) -> Self;
}

/// A body to which other bodies are added on the way to the base.
pub(crate) trait Body<'s>: Inward<'s> + Copy {
    fn plus(self, other: Self) -> Self;
}

/// Mass and first moment of a body.
#[derive(Clone, Copy)]
pub(crate) struct FirstMoment<'s> {
    pub(crate) mass: Symbol<'s>,
    pub(crate) h: Vector<'s>,
}

impl<'s> Body<'s> for FirstMoment<'s> {
    fn plus(self, other: Self) -> Self {
        Self { mass: self.mass + other.mass, h: self.h + other.h }
    }
}

impl<'s> Inward<'s> for FirstMoment<'s> {
    fn turned(self, turn: Turned<'s>) -> Self {
        Self { h: turn.of(self.h), ..self }
    }

    fn moved(self, t: Vector<'s>) -> Self {
        Self { h: self.h + t * self.mass, ..self }
    }
}

/// The motion of a link, which can be converted to the axes of the next link and to another point.
pub(crate) trait Outward<'s>: Copy {
    fn turned_back(self, f: impl Fn(Vector<'s>) -> Vector<'s>) -> Self;

    /// Returns the motion of the point p of the link.
    fn at(self, p: Vector<'s>) -> Self;
}

/// The bodies that a link's joints move, with the columns of these joints: about the origin of the link's frame, in its
/// axes or in frame N of its group.
pub(crate) struct Carried<B, C> {
    pub(crate) behind: Option<B>,
    pub(crate) columns: Vec<C>,
}

impl<B, C> Carried<B, C> {
    const NOTHING: Self = Self { behind: None, columns: Vec::new() };

    fn map(self, behind: impl Fn(B) -> B, column: impl Fn(C) -> C) -> Self {
        Self { behind: self.behind.map(behind), columns: self.columns.into_iter().map(column).collect() }
    }
}

/// The loads on links whose joints have been processed on the way to the base.
pub(crate) struct Loads<B, C>(Vec<Load<B, C>>);

struct Load<B, C> {
    on: usize,
    /// Whether the load is in frame N of the group of link `on`, not in the axes of the link.
    unturned: bool,
    carried: Carried<B, C>,
}

/// The sum of the loads on one link. Loads in the axes of the link and loads in frame N of its group are separate sums,
/// because one of them must be rotated before both are added.
pub(crate) struct LoadOfLink<B, C> {
    /// In the axes of the link.
    pub(crate) own: Carried<B, C>,
    /// In the frame N of its group.
    pub(crate) unturned: Carried<B, C>,
}

impl<'s, B: Body<'s>, C> Loads<B, C> {
    pub(crate) const fn new() -> Self {
        Self(Vec::new())
    }

    /// Adds a load to a link.
    pub(crate) fn put(&mut self, on: usize, unturned: bool, carried: Carried<B, C>) {
        self.0.push(Load { on, unturned, carried });
    }

    /// Removes all loads from a link and returns their sum.
    pub(crate) fn take(&mut self, on: usize) -> LoadOfLink<B, C> {
        let (mut own, mut unturned) = (Carried::NOTHING, Carried::NOTHING);
        for load in self.0.extract_if(.., |load| load.on == on) {
            let sum = if load.unturned { &mut unturned } else { &mut own };
            sum.behind = plus(sum.behind, load.carried.behind);
            sum.columns.extend(load.carried.columns);
        }
        LoadOfLink { own, unturned }
    }
}

impl<'s, B: Body<'s>, C: Inward<'s>> LoadOfLink<B, C> {
    /// Returns the link plus the bodies whose load is in the link's axes.
    pub(crate) fn with_link(&self, link: B) -> B {
        self.own.behind.map_or(link, |behind| link.plus(behind))
    }

    /// Returns the sum of all bodies in one frame: in frame N of a revolute joint with the rotation `turn`, or in the
    /// axes of a prismatic link. `in_axes` is the part that is in the axes of the link.
    pub(crate) fn whole(&self, in_axes: B, turn: Option<SymbolicTurn<'s>>) -> B {
        let own = turn.map_or(in_axes, |turn| in_axes.turned(Turned::AboutZ(turn)));
        self.unturned.behind.map_or(own, |behind| own.plus(behind))
    }

    /// Returns all columns, in the frame that [`Self::whole`] uses.
    pub(crate) fn columns(&mut self, turn: Option<SymbolicTurn<'s>>) -> Vec<C> {
        let turned = |column: C| match turn {
            Some(turn) => column.turned(Turned::AboutZ(turn)),
            None => column,
        };
        let [own, unturned] = [&mut self.own, &mut self.unturned].map(|load| std::mem::take(&mut load.columns));
        own.into_iter().map(turned).chain(unturned).collect()
    }
}

fn plus<'s, B: Body<'s>>(a: Option<B>, b: Option<B>) -> Option<B> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.plus(b)),
        (a, b) => a.or(b),
    }
}

impl<'s, B: Inward<'s>, C: Inward<'s>> Inward<'s> for Carried<B, C> {
    fn turned(self, turn: Turned<'s>) -> Self {
        self.map(|body| body.turned(turn), |column| column.turned(turn))
    }

    fn moved(self, t: Vector<'s>) -> Self {
        self.map(|body| body.moved(t), |column| column.moved(t))
    }
}

impl<'s> Inward<'s> for Wrench<'s> {
    fn turned(self, turn: Turned<'s>) -> Self {
        self.map(|v| turn.of(v))
    }

    fn moved(self, t: Vector<'s>) -> Self {
        self.about(t)
    }
}

impl<'s> Arm<'_, 's> {
    /// Whether a joint shares the frame N of the one before it.
    pub(crate) fn is_grouped(&self, index: usize) -> bool {
        self.expressed_in == ExpressedIn::GroupFrame && is_parallel(self.rows(), index)
    }

    /// Returns the rotation from the axes of a revolute link to frame N of its group.
    pub(crate) fn turn_of_group(&self, index: usize) -> SymbolicTurn<'s> {
        self.turn(if self.is_grouped(index) { group_start(self.rows(), index) } else { index }, index)
    }

    /// Returns the motion of the parent at the origin of a joint, in frame N (prismatic: in the axes of the link).
    /// `last` is the parent's motion in its axes. If both joints share frame N, the parent's motion in N, `unturned`,
    /// is used instead, and `turn` is the rotation of the parent in N.
    pub(crate) fn outward<T: Outward<'s>>(&self, index: usize, last: T, unturned: T, turn: SymbolicTurn<'s>) -> T {
        let (builder, row) = (self.builder, &self.rows()[index]);
        let (offset, d) = self.lengths(index, Number::ONE);
        let (offset, twist) = (builder.vector(offset), Twist::new(builder, row));
        match row.kind {
            Revolute if self.is_grouped(index) => unturned.at(turn.about_z(offset) + builder.along_z(d)),
            // joints on a fixed base have their frame at the base
            Revolute if self.joint_frames.carrier(index).is_none() => last.turned_back(|v| twist.back(v)),
            Revolute => last.at(offset).turned_back(|v| twist.back(v)).at(builder.along_z(d)),
            Prismatic => {
                let theta = builder.fixed_turn(row.theta);
                let last = last.at(offset);
                let last = if row.carried { last } else { last.turned_back(|v| theta.back_about_z(twist.back(v))) };
                last.at(builder.vector(row.axis) * (self.position(index) + builder.number(d)))
            }
        }
    }

    /// Converts a quantity from frame N of a joint, or from the axes of a prismatic link, to the axes of the parent and
    /// about the parent's origin. If both joints share frame N, only the reference point changes.
    pub(crate) fn inward<T: Inward<'s>>(&self, index: usize, carried: T) -> T {
        let (builder, row) = (self.builder, &self.rows()[index]);
        let (offset, d) = self.lengths(index, Number::ONE);
        let twist = Twist::new(builder, row);
        match row.kind {
            Revolute if self.is_grouped(index) => {
                let before = self.turn(group_start(self.rows(), index), index - 1);
                carried.moved(before.about_z(builder.vector(offset)) + builder.along_z(d))
            }
            Revolute => twist.turns().fold(carried.moved(builder.along_z(d)), T::turned).moved(builder.vector(offset)),
            Prismatic => {
                let carried = carried.moved(builder.vector(row.axis) * (self.position(index) + builder.number(d)));
                let theta = || Turned::AboutZ(builder.fixed_turn(row.theta));
                let carried =
                    if row.carried { carried } else { twist.turns().fold(carried.turned(theta()), T::turned) };
                carried.moved(builder.vector(offset))
            }
        }
    }
}
