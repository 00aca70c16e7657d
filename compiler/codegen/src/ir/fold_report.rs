//! Operations that were folded, and the causes: data for listings, not a log.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use super::{Axis, Name, Quantity, Step, WithRespectTo};

/// Why a number is exactly zero or one. Of two causes, the later variant is reported, because it explains more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Cause {
    /// Constants that happen to give it.
    Arithmetic,
    /// A turn about z leaves z alone.
    TurnAboutZ,
    /// A turn about x leaves x alone.
    TurnAboutX,
    /// The joint axis is e = (0, 0, 1).
    JointAxis,
    /// Frame 0 of a standard table is at joint 1.
    FirstFrame,
    /// A number of the table, or made from it.
    Table(Name),
    /// Gravity has no such component in frame 0.
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
    /// The function has nothing to do with gravity.
    NoGravity,
    /// Terms that are not zero cancel, as x - x does; what makes them equal is not told.
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

/// Everything because of which a number is exactly zero or one: a set that suffices, and of which nothing can be left
/// out.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Causes(Arc<[Cause]>);

impl Causes {
    pub(crate) fn single(cause: Cause) -> Self {
        Self(Arc::new([cause]))
    }

    /// The causes, the weightiest first.
    pub fn iter(&self) -> impl Iterator<Item = Cause> {
        self.0.iter().copied()
    }

    /// The weightiest.
    pub(crate) fn main(&self) -> Cause {
        self.0.first().copied().unwrap_or(Cause::Arithmetic)
    }

    /// The name of the one table entry that is the cause, if it is one alone.
    pub(crate) fn entry(&self) -> Option<Name> {
        match *self.0 {
            [Cause::Table(name)] => Some(name),
            [Cause::GravityDirection(axis)] => Some(Name::vector(Quantity::Gravity, 0, axis)),
            _ => None,
        }
    }

    /// Both together, as a sum of two zeros needs them. That a frame turns about its own axis goes without saying.
    fn and(&self, other: &Self) -> Self {
        let mut all: Vec<Cause> = self.iter().chain(other.iter()).collect();
        all.sort_unstable_by(|a, b| b.weight().cmp(&a.weight()).then(a.cmp(b)));
        all.dedup();
        if all.first().is_some_and(|cause| !cause.is_geometry()) {
            all.retain(|cause| !cause.is_geometry());
        } else {
            // one reason that holds for every arm is as good as two
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

/// The sets of causes each of which suffices for a zero, the best first: a product is zero because of one factor or the
/// other, so a sum of products has its choice. None of them contains another.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Alternatives(Vec<Causes>);

impl Alternatives {
    /// Sets that are kept; the fewest causes are found among them.
    const MOST: usize = 8;

    pub(crate) fn single(cause: Cause) -> Self {
        Self(vec![Causes::single(cause)])
    }

    /// The best of them.
    pub(crate) fn best(&self) -> &Causes {
        &self.0[0]
    }

    /// Each alone suffices: of a product of two zeros.
    pub(crate) fn or(&self, other: &Self) -> Self {
        Self::of(self.0.iter().chain(&other.0).cloned())
    }

    /// One of each is needed: for a sum of two zeros.
    pub(crate) fn and(&self, other: &Self) -> Self {
        Self::of(self.0.iter().flat_map(|a| other.0.iter().map(|b| a.and(b))))
    }

    /// The fewest numbers of the robot file first, for what the function says holds whatever the robot; then the fewest
    /// facts; of as many, those that tell more.
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
    /// How much a cause tells, the rank of its variant.
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

    /// Whether a robot file could say otherwise.
    const fn is_of_file(&self) -> bool {
        matches!(self, Self::Table(_) | Self::GravityDirection(_))
    }

    /// Whether it holds for every arm: zeros of Rx, Rz and e.
    const fn is_geometry(&self) -> bool {
        self.weight() < 2
    }
}

/// An entry of the table in the words of the table.
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

/// The fate of operations that the unfolded recursion performs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Fold {
    /// It stands in the generated code.
    Kept,
    /// A factor or summand is zero; the cause is the main reason.
    Zero(Cause),
    /// A factor is 1 or -1, because of this.
    One(Cause),
    /// Both operands are constants: done at compile time.
    Constant,
    /// x - x.
    Cancelled,
    /// The same value had been computed before.
    Shared,
    /// No returned number depends on it.
    Unused,
}

/// Where in the recursion an operation stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Place {
    /// The joint, counted from 1.
    pub joint: usize,
    /// The step.
    pub step: Step,
    /// The quantity that was being computed.
    pub quantity: Quantity,
    /// The variable by which it was differentiated.
    pub by: Option<WithRespectTo>,
}

/// How many operations of one place have the same fate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// Where.
    pub place: Place,
    /// Product or sum.
    pub operation: Operation,
    /// Their fate.
    pub fold: Fold,
    /// How many.
    pub count: usize,
}

/// Every operation of the unfolded recursion, by place and fate.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FoldReport {
    lines: BTreeMap<(Place, Operation, Fold), usize>,
}

impl FoldReport {
    pub(crate) fn enter(&mut self, place: Place, operation: Operation, fold: Fold) {
        *self.lines.entry((place, operation, fold)).or_default() += 1;
    }

    /// An operation that was kept turns out to be unused.
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

    /// (products, sums) before folding; of the seven steps, step 3 included.
    #[must_use]
    pub fn before(&self) -> (usize, usize) {
        self.total(|_| true)
    }

    /// (products, sums) that are left.
    #[must_use]
    pub fn after(&self) -> (usize, usize) {
        self.total(|line| line.fold == Fold::Kept)
    }
}
