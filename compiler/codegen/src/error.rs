//! Why a robot cannot be compiled, in words for people.

mod suspect;

use std::fmt;

use rne_model::Robot;

pub use suspect::{Extreme, Suspect};

use crate::function::{Axes, Capability, Function, Load};
use crate::ir::Name;

/// Why a robot cannot be compiled.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum CompileError {
    /// A constant made from finite numbers of the table overflows.
    NotFinite {
        /// The constant.
        name: Name,
    },
    /// Code that is another function than the seven steps; such code is never emitted.
    NotIdentical {
        /// The function.
        function: Function,
        /// The first number returned that differs, counted from 1: for torques, the joint.
        output: usize,
        /// The probable cause.
        suspect: Suspect,
    },
    /// Code that differs too much from the seven steps by rounding; such code is never emitted.
    Imprecise {
        /// The function.
        function: Function,
        /// The largest difference, relative to the largest number returned.
        rounding: f64,
        /// The probable cause.
        suspect: Suspect,
    },
    /// Two variables with the same name, of which the second would shadow the first; such code is never emitted.
    TwoOfOneName {
        /// The function.
        function: Function,
        /// The name.
        name: String,
    },
    /// A function whose code is too large for any compiler, because the arm has too many joints.
    TooLarge {
        /// The function.
        function: Function,
        /// Degrees of freedom of the robot.
        dof: usize,
        /// The largest number of operations that is compiled.
        most: usize,
    },
    /// A function that returns numbers of every link, for a robot some of whose joints follow others: its arrays have
    /// an element only for each coordinate.
    OfEveryLink {
        /// The function.
        function: Function,
        /// The name of a joint that follows others.
        follower: String,
    },
    /// A function that takes no positions of dependent joints, for a robot with closed loops.
    HasClosedLoops {
        /// The function.
        function: Function,
        /// The name of a loop.
        name: String,
    },
    /// A function of closed loops, for a robot without closed loops.
    NoClosedLoops {
        /// The function.
        function: Function,
    },
    /// A function of a floating base, for a robot whose file has no `floating_base`.
    NoFloatingBase {
        /// The function.
        function: Function,
        /// The robot's name.
        robot: String,
    },
    /// The function of the motion in contact, for a robot without contacts.
    NoContacts {
        /// The function.
        function: Function,
    },
    /// A plan with a choice that the robot does not offer.
    PlanDoesNotFit {
        /// The robot's name.
        robot: String,
    },
    /// A rewritten graph that cannot be read.
    Graph {
        /// The robot's name.
        robot: String,
        /// The function whose graph it is.
        function: Function,
        /// The word of the graph, counted from 1.
        word: usize,
        /// The mistake in this word.
        mistake: GraphMistake,
    },
}

/// A mistake in the text of a rewritten graph. Each text is the wrong word, or the part of the word that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GraphMistake {
    /// The first word is not the name of a section.
    NoSection(String),
    /// The word is not an operation.
    NoOperation(String),
    /// The word divides by a value by which the code of the plan never divides: the value could be zero.
    Division(String),
    /// No earlier word defines this value.
    UnknownValue(String),
    /// The number is infinite or not a number.
    NotFinite(String),
    /// The number does not occur in the code of the plan.
    UnknownNumber(String),
    /// The graph has too many or too few results.
    Results {
        /// The function.
        function: Function,
        /// How many numbers the function returns.
        needed: usize,
        /// How many results the graph has.
        found: usize,
    },
}

impl fmt::Display for GraphMistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSection(word) => write!(f, "a graph begins with `constants` or `operations`, not with `{word}`"),
            Self::NoOperation(word) => write!(f, "`{word}` is not an operation of a graph, such as `s2*qd3`"),
            Self::Division(word) => {
                write!(f, "`{word}` divides by a value by which the code of the plan never divides")
            }
            Self::UnknownValue(name) => write!(f, "the graph defines no value `{name}` before this word"),
            Self::NotFinite(word) => write!(f, "`{word}` is not a finite number"),
            Self::UnknownNumber(word) => write!(f, "the number {word} does not occur in the code of the plan"),
            Self::Results { function, needed, found } => {
                write!(f, "`{function}` returns {needed} numbers, but the graph has {found} results")
            }
        }
    }
}

/// A remedy for an error of a plan. Each interface says it in its own words: the command line names its options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Remedy {
    /// A search that leaves out what is wrong in the plan and finds the rest anew.
    SearchAfresh,
    /// A search as [`Remedy::SearchAfresh`], with rewriting, so that the graph is written anew too.
    RewriteAfresh,
    /// A search that starts from the present plan, and counts the operations anew.
    CountAnew,
}

impl CompileError {
    /// Whether a form was refused because it is another function than the seven steps, or rounds too much.
    #[must_use]
    pub fn is_refusal(&self) -> bool {
        matches!(self, Self::NotIdentical { .. } | Self::Imprecise { .. })
    }

    /// The remedy for the error, if another plan is one.
    #[must_use]
    pub const fn remedy(&self) -> Option<Remedy> {
        match self {
            Self::NotIdentical { suspect, .. } | Self::Imprecise { suspect, .. }
                if suspect.planned && suspect.number.is_none() =>
            {
                Some(Remedy::SearchAfresh)
            }
            Self::PlanDoesNotFit { .. } => Some(Remedy::SearchAfresh),
            Self::Graph { .. } => Some(Remedy::RewriteAfresh),
            _ => None,
        }
    }

    /// Returns the error with its probable cause.
    #[must_use]
    pub fn suspecting(mut self, robot: &Robot, is_planned: bool) -> Self {
        if let Self::NotIdentical { suspect, .. } | Self::Imprecise { suspect, .. } = &mut self {
            *suspect = Suspect { planned: is_planned, number: Extreme::of(robot) };
        }
        self
    }
}

/// Checks whether a robot has all that a function needs.
pub trait CheckFor: Sized {
    /// Refuses a function that a robot does not have.
    ///
    /// # Errors
    /// When a joint follows others and the function returns numbers of every link; when the robot has closed loops and
    /// the function is not for such robots, or the robot has none and the function needs them.
    fn check_kind(self, robot: &Robot) -> Result<(), CompileError>;

    /// Refuses a function that a robot does not have, or for which it lacks the base or the contacts.
    ///
    /// # Errors
    /// Those of [`check_kind`](Self::check_kind) and of [`check_base`](Self::check_base).
    fn check_for(self, robot: &Robot) -> Result<(), CompileError>;

    /// Refuses a function whose floating base or contacts the robot does not have. The compiler takes a robot whose
    /// file has no `floating_base` as one whose base has no mass; code that computes numbers of the robot calls this
    /// first, because that mass was probably left out.
    ///
    /// # Errors
    /// [`CompileError::NoFloatingBase`] for a function of a floating base, if the robot has none;
    /// [`CompileError::NoContacts`] for the motion in contact, if the robot has no contacts, because it would be a free
    /// fall.
    fn check_base(self, robot: &Robot) -> Result<(), CompileError>;
}

impl CheckFor for Function {
    fn check_kind(self, robot: &Robot) -> Result<(), CompileError> {
        let function = self;
        let follower = robot.joints.iter().find(|joint| joint.coupling.is_some() && self.is_of_every_link());
        if let Some(joint) = follower {
            return Err(CompileError::OfEveryLink { function, follower: joint.name.clone() });
        }
        match robot.closed.loops.first() {
            Some(closed) if !self.is_of_closed_loops() => {
                Err(CompileError::HasClosedLoops { function, name: closed.name.clone() })
            }
            None if self.is_of_closed_loops() => Err(CompileError::NoClosedLoops { function }),
            _ => Ok(()),
        }
    }

    fn check_for(self, robot: &Robot) -> Result<(), CompileError> {
        self.check_base(robot)?;
        self.check_kind(robot)
    }

    fn check_base(self, robot: &Robot) -> Result<(), CompileError> {
        if self.is_of_floating_base() && robot.floating_base.is_none() {
            return Err(CompileError::NoFloatingBase { function: self, robot: robot.name.clone() });
        }
        if self.capability() == Capability::ContactDynamics && robot.contacts.is_empty() {
            return Err(CompileError::NoContacts { function: self });
        }
        Ok(())
    }
}

impl fmt::Display for CompileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { name } => write!(
                f,
                "the constant {name} ({}) of link {} is too large for a number of double precision",
                name.quantity.meaning(),
                name.joint
            ),
            Self::NotIdentical { function, output, suspect } => not_identical(f, *function, *output, suspect),
            Self::Imprecise { function, rounding, suspect } => imprecise(f, *function, *rounding, suspect),
            Self::TwoOfOneName { function, name } => write!(
                f,
                "the code of `{function}` has two variables called `{name}`: the second would replace the first. No \
                 code is written. Please report this robot"
            ),
            Self::TooLarge { function, dof, most } => write!(
                f,
                "`{function}` of {dof} joints is straight-line code of more than {most} operations, which no compiler \
                 can compile in reasonable time. Compute it at run time by `rne::DynArm` instead, which has loops"
            ),
            Self::HasClosedLoops { function, name } => has_closed_loops(f, *function, name),
            Self::NoClosedLoops { function } => write!(
                f,
                "`{function}` is of robots with closed loops; this robot file has no `loops` with a cut joint that is \
                 solved for. The section Closed loops of docs/robot-file.md says how to write one"
            ),
            Self::NoContacts { function } => write!(
                f,
                "`{function}` is of robots with contacts, and the robot file has no `contacts`: nothing would hold the \
                 robot. Write beside `floating_base` and `tips` which tips are held, such as `contacts: [{{tip: left, \
                 kind: point}}]`; without contacts, use `floating_forward_dynamics`"
            ),
            Self::OfEveryLink { function, follower } => write!(
                f,
                "`{function}` returns numbers of every link, and the joint `{follower}` follows other joints: arrays \
                 have no element for it. Compute it at run time by `rne::DynArm` instead"
            ),
            Self::NoFloatingBase { function, robot } => write!(
                f,
                "`{function}` is of robots with a floating base, and the file of {robot} has no `floating_base`: the \
                 mass of its base is not known. Import the whole robot with a floating base, in Python by \
                 `rne.load(FILE, whole=True, floating=True)`, or write the base into the robot file (`format: 2`), \
                 such as `floating_base: {{name: trunk, link: {{mass: 20, com: [0, 0, 0], \
                 inertia: {{xx: 1, yy: 1, zz: 1}}}}}}`"
            ),
            Self::PlanDoesNotFit { robot } => {
                write!(f, "the plan does not fit `{robot}`: one of its choices is not possible for this robot")
            }
            Self::Graph { robot, function, word, mistake } => {
                write!(f, "word {word} of the rewritten graph of `{function}` in the plan of `{robot}`: {mistake}")
            }
        }
    }
}

impl std::error::Error for CompileError {}

fn not_identical(f: &mut fmt::Formatter<'_>, function: Function, output: usize, suspect: &Suspect) -> fmt::Result {
    let what = if function.returns_torques() { "the torque of joint" } else { "the returned number" };
    write!(
        f,
        "this form of `{function}` does not compute the same as the seven steps: {what} {output} differs. No code is \
         written. "
    )?;
    let of_plan_file = "The cause may be that somebody has edited the graph in the plan file";
    suspect.advise(f, of_plan_file, "Please report this robot")
}

fn imprecise(f: &mut fmt::Formatter<'_>, function: Function, rounding: f64, suspect: &Suspect) -> fmt::Result {
    let what = match function {
        _ if function.returns_torques() => "torque",
        _ if function.returns_accelerations() => "acceleration",
        _ => "returned number",
    };
    write!(
        f,
        "this form of `{function}` rounds too much: it differs from the seven steps by {rounding:.1e} of the largest \
         {what}. "
    )?;
    suspect.advise(f, "Use `form = \"seven_steps\"`, which needs no plan", "Use `form = \"seven_steps\"`")
}

fn has_closed_loops(f: &mut fmt::Formatter<'_>, function: Function, name: &str) -> fmt::Result {
    write!(
        f,
        "`{function}` is not computed for robots with closed loops, and the robot has the loop `{name}`: the positions \
         of its dependent joints are arguments, too. "
    )?;
    let axes = function.axes().of_loops();
    let load = if axes.load == Load::Wrench { Load::Wrenches } else { axes.load };
    match Function::find(Axes { load, ..axes }) {
        Some(of_loops) => write!(f, "Use `{of_loops}`"),
        None => f.write_str("docs/control/closed-loops.md lists the functions of closed loops"),
    }
}
