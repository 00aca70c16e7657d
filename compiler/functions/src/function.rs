//! Properties of a function, by the table.

use crate::axes::{Axes, Base, Load};
use crate::table::{SIGNATURES, TABLE};
use crate::{Answer, Argument, Capability, Entry, Function, Length, Shape, What};
#[cfg(feature = "alloc")]
use crate::{Layout, Sizes};

impl Function {
    /// The functions of the trait `InverseDynamics`: torques of an arm whose base stands still.
    pub const TORQUES: [Self; 6] = [
        Self::InverseDynamics,
        Self::InverseDynamicsWithWrench,
        Self::InverseDynamicsWithPayload,
        Self::InverseDynamicsFromSinCos,
        Self::GravityTorques,
        Self::BiasTorques,
    ];

    /// The functions of a robot without closed loops.
    pub const OF_TREES: [Self; Self::trees()] = {
        let (mut functions, mut index, mut found) = ([Self::InverseDynamics; Self::trees()], 0, 0);
        while index < Self::ALL.len() {
            if !Self::ALL[index].is_of_closed_loops() {
                functions[found] = Self::ALL[index];
                found += 1;
            }
            index += 1;
        }
        functions
    };

    /// How many functions a robot without closed loops has.
    const fn trees() -> usize {
        let (mut index, mut found) = (0, 0);
        while index < Self::ALL.len() {
            found += !Self::ALL[index].is_of_closed_loops() as usize;
            index += 1;
        }
        found
    }

    /// Its entry in the table, which stands at its place.
    pub const fn entry(self) -> &'static Entry {
        &TABLE[self as usize]
    }

    /// The trait that it is a method of.
    #[must_use]
    pub const fn capability(self) -> Capability {
        self.entry().capability
    }

    /// The first line of its documentation.
    #[must_use]
    pub const fn summary(self) -> &'static str {
        SIGNATURES[self as usize].summary
    }

    /// Shapes, units, frames and signs that the names do not tell.
    #[must_use]
    pub const fn details(self) -> &'static str {
        SIGNATURES[self as usize].details
    }

    /// Its arguments, in order.
    #[must_use]
    pub const fn arguments(self) -> &'static [Argument] {
        SIGNATURES[self as usize].arguments
    }

    /// Whether it has an argument.
    #[must_use]
    pub fn takes(self, argument: Argument) -> bool {
        self.arguments().contains(&argument)
    }

    /// Whether an argument or its result has an array of this length.
    pub(crate) fn has(self, length: Length) -> bool {
        self.shape().has(length) || self.arguments().iter().any(|argument| argument.shape().has(length))
    }

    /// Whether it takes or returns something for each tip.
    #[must_use]
    pub fn has_tips(self) -> bool {
        self.has(Length::Tips)
    }

    /// The parts of its name.
    #[must_use]
    pub const fn axes(self) -> Axes {
        SIGNATURES[self as usize].axes
    }

    /// Its result, whatever the robot.
    #[must_use]
    pub const fn what(self) -> What {
        self.axes().what
    }

    /// The function with these parts of its name, if the table has it.
    #[must_use]
    pub fn find(axes: Axes) -> Option<Self> {
        Self::ALL.into_iter().find(|function| function.axes() == axes)
    }

    /// The function of the same result for a robot with a payload, if the table has it and this one has no load.
    #[must_use]
    pub fn with_payload(self) -> Option<Self> {
        if self.axes().load == Load::Free { Self::find(self.axes().with_payload()) } else { None }
    }

    /// The beginning of its name at a frame, `jacobian` of `jacobian_of_camera`, for a function of the tip that can be
    /// taken at any frame of a link instead.
    #[must_use]
    pub const fn of_frame(self) -> Option<&'static str> {
        SIGNATURES[self as usize].of_frame
    }

    /// The functions of the tip that can be taken at any frame of a link instead.
    pub fn of_frames() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|function| function.of_frame().is_some())
    }

    /// Whether what it returns are the torques of the joints.
    #[must_use]
    pub const fn returns_torques(self) -> bool {
        self.entry().returns_torques
    }

    /// Whether it is a function of a robot with a floating base.
    #[must_use]
    pub const fn is_of_floating_base(self) -> bool {
        matches!(self.axes().base, Base::Floating)
    }

    /// Whether it is a function of a robot with closed loops.
    #[must_use]
    pub const fn is_of_closed_loops(self) -> bool {
        self.axes().loops
    }

    /// Whether it closes the loops: its argument `passive` is a guess, where that of other functions closes them.
    #[must_use]
    pub fn closes_loops(self) -> bool {
        self == Self::ClosureStep
    }

    /// Whether rotors that belong to the arm change what it returns.
    #[must_use]
    pub fn feels_rotors(self) -> bool {
        let has_torques = self.returns_torques() || self.is_of_floating_base();
        self.entry().feels_rotors || has_torques && self.takes(Argument::Accelerations)
    }

    /// Whether what it returns are the accelerations of the joints.
    #[must_use]
    pub const fn returns_accelerations(self) -> bool {
        matches!(self.entry().answer, Answer::Accelerations)
    }

    /// The shape of what it returns, for any number of joints.
    #[must_use]
    pub const fn shape(self) -> &'static Shape {
        SIGNATURES[self as usize].returned
    }

    /// How its numbers are laid out for reading.
    #[must_use]
    pub const fn answer(self) -> &'static Answer {
        &self.entry().answer
    }

    /// Whether it returns numbers of every link, also of those whose joints follow others.
    #[must_use]
    pub const fn is_of_every_link(self) -> bool {
        matches!(self, Self::Regressor | Self::FloatingRegressor)
    }

    /// Whether it has a reduced form, whose graph can be rewritten.
    #[must_use]
    pub const fn can_be_rewritten(self) -> bool {
        !self.entry().is_irreducible
    }

    /// Whether it solves by the mass matrix, so that its numbers are worth nothing where that is nearly singular.
    #[must_use]
    pub const fn inverts_mass(self) -> bool {
        self.entry().inverts_mass
    }

    /// The meaning of numbers that are not finite, for a function that divides.
    #[must_use]
    pub const fn divides(self) -> Option<&'static str> {
        self.entry().divides
    }

    /// The shape of its result for a robot.
    #[cfg(feature = "alloc")]
    #[must_use]
    pub fn layout(self, sizes: Sizes) -> Layout {
        self.shape().layout(sizes)
    }
}
