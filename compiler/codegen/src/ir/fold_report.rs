//! The fold report: which operations were folded and why, as data for listings.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use super::{Axis, Name, Quantity, Step, WithRespectTo};

/// Why a number is exactly zero or one. Of two causes, the later variant is reported, because it explains more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Cause {
    /// Arithmetic of constants gives this value.
    Arithmetic,
    /// A rotation about z does not change z components.
    TurnAboutZ,
    /// A rotation about x does not change x components.
    TurnAboutX,
    /// The joint axis is e = (0, 0, 1).
    JointAxis,
    /// Frame 0 of a standard table is at joint 1.
    FirstFrame,
    /// A number of the table, or a number computed from it.
    Table(Name),
    /// Gravity has no component along this axis of frame 0.
    GravityDirection(Axis),
    /// The base does not move: ω₀ = ω̇₀ = ċ₀ = c̈₀ = 0.
    FixedBase,
    /// Nothing touches the tip: f_{n,n+1} = n_{n,n+1} = 0.
    FreeTip,
    /// The function is for an arm at rest, q̇ = 0.
    AtRest,
    /// The function is for an arm that does not accelerate, q̈ = 0.
    NoAcceleration,
    /// The function is for one joint that accelerates; all other joints do not.
    UnitAcceleration,
    /// The joint is between the frame and the tip, so it does not move the frame.
    BehindFrame,
    /// The function does not depend on gravity.
    NoGravity,
    /// Terms that are not zero cancel, as in x - x; the report does not say why they are equal.
    Cancellation,
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Arithmetic => f.write_str("constants"),
            Self::TurnAboutZ => f.write_str("a turn about z leaves z alone"),
            Self::TurnAboutX => f.write_str("a turn about x leaves x alone"),
            Self::JointAxis => f.write_str("the joint axis is (0, 0, 1)"),
            Self::FirstFrame => f.write_str("frame 0 is at joint 1"),
            Self::Table(name) => write!(f, "{}", Entry(*name)),
            Self::GravityDirection(axis) => write!(f, "gravity has no {axis} in frame 0"),
            Self::FixedBase => f.write_str("the base does not move"),
            Self::FreeTip => f.write_str("nothing touches the tip"),
            Self::AtRest => f.write_str("the arm is at rest"),
            Self::NoAcceleration => f.write_str("the joints do not accelerate"),
            Self::UnitAcceleration => f.write_str("one joint alone accelerates"),
            Self::BehindFrame => f.write_str("the joint does not move the frame"),
            Self::NoGravity => f.write_str("gravity has no part in it"),
            Self::Cancellation => f.write_str("its terms cancel"),
        }
    }
}

/// The causes that together make a number exactly zero or one. None of them can be left out.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Causes(Arc<[Cause]>);

impl Causes {
    pub(crate) fn single(cause: Cause) -> Self {
        Self(Arc::new([cause]))
    }

    /// The causes, in order of decreasing weight.
    pub fn iter(&self) -> impl Iterator<Item = Cause> {
        self.0.iter().copied()
    }

    /// The cause with the largest weight.
    pub(crate) fn main(&self) -> Cause {
        self.0.first().copied().unwrap_or(Cause::Arithmetic)
    }

    /// The name of the table entry, if one entry is the only cause.
    pub(crate) fn entry(&self) -> Option<Name> {
        match *self.0 {
            [Cause::Table(name)] => Some(name),
            [Cause::GravityDirection(axis)] => Some(Name::vector(Quantity::Gravity, 0, axis)),
            _ => None,
        }
    }

    /// Unites two sets, because a sum of two zeros needs both. Causes that hold for every arm are left out if others
    /// remain.
    fn and(&self, other: &Self) -> Self {
        let mut all: Vec<Cause> = self.iter().chain(other.iter()).collect();
        all.sort_unstable_by(|a, b| b.weight().cmp(&a.weight()).then(a.cmp(b)));
        all.dedup();
        if all.first().is_some_and(|cause| !cause.is_geometry()) {
            all.retain(|cause| !cause.is_geometry());
        } else {
            // of causes that hold for every arm, one is enough
            all.truncate(1);
        }
        Self(all.into())
    }

    /// The causes that hold for this arm and not for every arm.
    fn facts(&self) -> impl Iterator<Item = Cause> {
        self.iter().filter(|cause| !cause.is_geometry())
    }

    /// Whether the other set contains this set, so that the other set is not needed.
    fn is_within(&self, other: &Self) -> bool {
        self.facts().all(|fact| other.0.contains(&fact))
    }
}

/// The sets of causes each of which alone makes a number zero, the best first. A product of two zeros is zero because
/// of either factor, so there may be several sets. No set contains another.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Alternatives(Vec<Causes>);

impl Alternatives {
    /// Largest number of sets that are kept, enough to find one with the fewest causes.
    const MOST: usize = 8;

    pub(crate) fn single(cause: Cause) -> Self {
        Self(vec![Causes::single(cause)])
    }

    /// The best set.
    pub(crate) fn best(&self) -> &Causes {
        &self.0[0]
    }

    /// Joins the sets for a product of two zeros: a set of either factor is enough.
    pub(crate) fn or(&self, other: &Self) -> Self {
        Self::of(self.0.iter().chain(&other.0).cloned())
    }

    /// Combines the sets for a sum of two zeros: a set of each summand is needed.
    pub(crate) fn and(&self, other: &Self) -> Self {
        Self::of(self.0.iter().flat_map(|a| other.0.iter().map(|b| a.and(b))))
    }

    /// Sorts the sets and keeps the best. Sets with the fewest numbers of the robot file come first, because causes
    /// from the function hold for every robot; then those with the fewest facts; then those whose causes explain more.
    fn of(sets: impl Iterator<Item = Causes>) -> Self {
        let mut sets: Vec<Causes> = sets.collect();
        let size = |set: &Causes| (set.facts().filter(Cause::is_of_file).count(), set.facts().count());
        sets.sort_unstable_by(|a, b| size(a).cmp(&size(b)).then(b.cmp(a)));
        let mut kept: Vec<Causes> = Vec::new();
        for set in sets {
            if kept.len() < Self::MOST && !kept.iter().any(|known| known.is_within(&set)) {
                kept.push(set);
            }
        }
        Self(kept)
    }
}

impl fmt::Display for Causes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let causes: Vec<String> = self.iter().map(|cause| cause.to_string()).collect();
        f.write_str(&causes.join(" and "))
    }
}

impl Cause {
    /// The weight of a cause: larger if the cause explains more.
    const fn weight(&self) -> u8 {
        match self {
            Self::Arithmetic => 0,
            Self::TurnAboutZ | Self::TurnAboutX | Self::JointAxis | Self::FirstFrame => 1,
            Self::Table(_) => 2,
            Self::GravityDirection(_) => 3,
            Self::FixedBase
            | Self::FreeTip
            | Self::AtRest
            | Self::NoAcceleration
            | Self::UnitAcceleration
            | Self::BehindFrame
            | Self::NoGravity
            | Self::Cancellation => 4,
        }
    }

    /// Whether the cause is a number of the robot file.
    const fn is_of_file(&self) -> bool {
        matches!(self, Self::Table(_) | Self::GravityDirection(_))
    }

    /// Whether the cause holds for every arm: zeros of Rx, Rz and e.
    const fn is_geometry(&self) -> bool {
        self.weight() < 2
    }
}

/// A table entry, printed as a cause in the words of the table.
struct Entry(Name);

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Name { quantity, joint, .. } = self.0;
        match quantity {
            Quantity::TwistSine | Quantity::TwistCosine => write!(f, "alpha{joint} is a right angle"),
            Quantity::ThetaSine | Quantity::ThetaCosine => write!(f, "theta{joint} is a right angle"),
            Quantity::Mass => write!(f, "link {joint} has no mass"),
            Quantity::TipRotation => f.write_str("the tip frame is turned by right angles"),
            _ => write!(f, "{} = 0", self.0),
        }
    }
}

/// A product or a sum. A difference is a sum; a negation is free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Operation {
    /// A multiplication.
    Product,
    /// An addition or subtraction.
    Sum,
}

/// How operations of the unfolded recursion were folded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Fold {
    /// The operation is in the generated code.
    Kept,
    /// A factor or summand is zero; the cause is the main reason.
    Zero(Cause),
    /// A factor is 1 or -1, because of this cause.
    One(Cause),
    /// Both operands are constants: done at compile time.
    Constant,
    /// The operands cancel, as in x - x.
    Cancelled,
    /// The same value had been computed before.
    Shared,
    /// No returned number depends on it.
    Unused,
}

/// The place of an operation in the recursion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Place {
    /// The joint, counted from 1.
    pub joint: usize,
    /// The step.
    pub step: Step,
    /// The quantity that was being computed.
    pub quantity: Quantity,
    /// The variable of the derivative, if the operation belongs to one.
    pub by: Option<WithRespectTo>,
}

/// The number of operations of one place that were folded in the same way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// The place of the operations.
    pub place: Place,
    /// Product or sum.
    pub operation: Operation,
    /// How they were folded.
    pub fold: Fold,
    /// Number of operations.
    pub count: usize,
}

/// The numbers of all operations of the unfolded recursion, by place and by how they were folded.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FoldReport {
    lines: BTreeMap<(Place, Operation, Fold), usize>,
}

impl FoldReport {
    pub(crate) fn enter(&mut self, place: Place, operation: Operation, fold: Fold) {
        *self.lines.entry((place, operation, fold)).or_default() += 1;
    }

    /// Changes one kept operation into an unused one.
    pub(crate) fn drop_unused(&mut self, place: Place, operation: Operation) {
        if let Some(kept) = self.lines.get_mut(&(place, operation, Fold::Kept)) {
            *kept -= 1;
            if *kept == 0 {
                self.lines.remove(&(place, operation, Fold::Kept));
            }
            self.enter(place, operation, Fold::Unused);
        }
    }

    /// The lines, ordered by joint, step and quantity.
    pub fn lines(&self) -> impl Iterator<Item = Line> {
        self.lines.iter().map(|(&(place, operation, fold), &count)| Line { place, operation, fold, count })
    }

    /// (products, sums) over the lines that pass `filter`.
    pub fn total(&self, filter: impl Fn(&Line) -> bool) -> (usize, usize) {
        self.lines().filter(|line| filter(line)).fold((0, 0), |(products, sums), line| match line.operation {
            Operation::Product => (products + line.count, sums),
            Operation::Sum => (products, sums + line.count),
        })
    }

    /// (products, sums) before folding; for the seven steps, step 3 is included.
    #[must_use]
    pub fn before(&self) -> (usize, usize) {
        self.total(|_| true)
    }

    /// (products, sums) that remain in the generated code.
    #[must_use]
    pub fn after(&self) -> (usize, usize) {
        self.total(|line| line.fold == Fold::Kept)
    }
}
