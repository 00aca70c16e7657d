//! Parameters that stay free until run time: which numbers of the table depend on them, and by which formulas.

use crate::{Formula, Inertia, InertiaReference, Robot};

/// The run-time parameters of a robot and the numbers that depend on them; none by default.
///
/// Every number of the [`Robot`] itself has the value for the parameters in the file. For those parameters the formulas
/// give the same bits; [`Robot::with_parameters`] gives the robot for other values.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct RunTime {
    /// The names of the run-time parameters, in the order in which the caller named them. [`Robot::parameters`] has
    /// each of them, too, with its value in the file.
    pub names: Vec<String>,
    /// The numbers of the table that depend on the parameters, each once: gravity, base, tool, frames, then joint by
    /// joint. None of them is zero in the table. From a file, no angle and no limit is among them; a program may add
    /// sines and cosines.
    pub entries: Vec<(Entry, Formula)>,
    /// The elements of [`Joint::written_inertia`](crate::Joint::written_inertia) that depend on the parameters, each
    /// with its joint from 0, where a file gives the tensor about the origin. Elements about the centre of mass are
    /// entries [`Entry::Inertia`].
    pub written_inertia: Vec<(usize, InertiaElement, Formula)>,
    /// The other parameters of the file that are defined through run-time parameters, each as an index into
    /// [`Robot::parameters`].
    pub parameters: Vec<(usize, Formula)>,
}

impl RunTime {
    /// Returns the values that the run-time parameters have in the file of `robot`, in the order of the names.
    #[must_use]
    pub fn values(&self, robot: &Robot) -> Vec<f64> {
        let value =
            |name: &String| robot.parameters.iter().find(|(known, _)| known == name).map_or(0.0, |known| known.1);
        self.names.iter().map(value).collect()
    }

    /// Whether there are no run-time parameters.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// Returns the formula of a number of the table; `None` when the number is constant.
    #[must_use]
    pub fn formula(&self, entry: Entry) -> Option<&Formula> {
        self.entries.iter().find(|(place, _)| *place == entry).map(|(_, formula)| formula)
    }
}

/// A number of the table that may depend on run-time parameters. Joints count from 0; axes are 0, 1, 2 for x, y, z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Entry {
    /// A component of [`Robot::gravity`], with the index of its axis.
    Gravity(usize),
    /// A component of the translation of [`Robot::base`], with the index of its axis.
    BaseXyz(usize),
    /// A component of the translation of [`Robot::tool`], with the index of its axis.
    ToolXyz(usize),
    /// A component of the translation of a named frame, with the indices of the frame and the axis.
    FrameXyz(usize, usize),
    /// The joint offset d, with the index of the joint.
    D(usize),
    /// The length a of the common normal, with the index of the joint.
    A(usize),
    /// The sine of the constant part of θ, with the index of the joint. No file has this entry or the next three; only
    /// programs add them.
    ThetaSine(usize),
    /// The cosine of the constant part of θ, with the index of the joint.
    ThetaCosine(usize),
    /// The sine of the twist α, with the index of the joint.
    AlphaSine(usize),
    /// The cosine of the twist α, with the index of the joint.
    AlphaCosine(usize),
    /// The mass of a link, with the index of the joint that moves the link.
    Mass(usize),
    /// A component of a link's centre of mass, with the indices of the joint and the axis.
    Com(usize, usize),
    /// A component of the first moment of a link without mass, with the indices of the joint and the axis.
    FirstMoment(usize, usize),
    /// An element of a link's inertia about the centre of mass, about whichever point the file gives it, with the index
    /// of the joint.
    Inertia(usize, InertiaElement),
    /// The rotor inertia of a motor, with the index of the joint.
    MotorInertia(usize),
    /// The gear ratio of a motor, with its sign, and with the index of the joint.
    GearRatio(usize),
    /// The viscous friction of a motor, with the index of the joint.
    Viscous(usize),
    /// The Coulomb friction of a motor for positive speed, with the index of the joint.
    CoulombPositive(usize),
    /// The Coulomb friction of a motor for negative speed, with the index of the joint.
    CoulombNegative(usize),
}

/// An element of an [`Inertia`] tensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum InertiaElement {
    /// Element (1,1).
    Xx,
    /// Element (2,2).
    Yy,
    /// Element (3,3).
    Zz,
    /// Element (1,2).
    Xy,
    /// Element (1,3).
    Xz,
    /// Element (2,3).
    Yz,
}

impl InertiaElement {
    /// All six elements, in the order of the fields of [`Inertia`].
    pub const ALL: [Self; 6] = [Self::Xx, Self::Yy, Self::Zz, Self::Xy, Self::Xz, Self::Yz];

    /// Returns the key of the element in a robot file, such as `xx`.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::Xx => "xx",
            Self::Yy => "yy",
            Self::Zz => "zz",
            Self::Xy => "xy",
            Self::Xz => "xz",
            Self::Yz => "yz",
        }
    }

    /// Returns this element of a tensor.
    pub fn of<S>(self, inertia: &Inertia<S>) -> &S {
        match self {
            Self::Xx => &inertia.xx,
            Self::Yy => &inertia.yy,
            Self::Zz => &inertia.zz,
            Self::Xy => &inertia.xy,
            Self::Xz => &inertia.xz,
            Self::Yz => &inertia.yz,
        }
    }

    /// Returns this element of a tensor, for changing it.
    pub fn of_mut<S>(self, inertia: &mut Inertia<S>) -> &mut S {
        match self {
            Self::Xx => &mut inertia.xx,
            Self::Yy => &mut inertia.yy,
            Self::Zz => &mut inertia.zz,
            Self::Xy => &mut inertia.xy,
            Self::Xz => &mut inertia.xz,
            Self::Yz => &mut inertia.yz,
        }
    }
}

impl Robot {
    /// Returns the robot for given values of its run-time parameters, in the order of [`RunTime::names`]; `None` when
    /// their number differs. It is the robot that its file gives with these values in place of the parameters' own, bit
    /// for bit, but nothing is checked: a mass may become negative, a gear ratio zero.
    /// ```
    /// let text = "
    /// format: 1
    /// name: pendulum
    /// source: a lecture
    /// convention: standard
    /// gravity: [0, -9.81, 0]
    /// parameters: {payload: 0}
    /// joints:
    ///   - {type: revolute, dh: {theta: 0, d: 0, a: 0.5, alpha: 0}, link: {mass: 1.2 + payload, com: [-1/4, 0, 0]}}
    /// ";
    /// let checked = rne_model::Reader::new("pendulum.yaml").run_time(&["payload"]).read(text).unwrap();
    /// assert_eq!(checked.robot.joints[0].row.link.mass, 1.2);
    /// let robot = checked.robot.with_parameters(&[0.5]).unwrap();
    /// assert_eq!(robot.joints[0].row.link.mass, 1.2 + 0.5);
    /// assert_eq!(robot.with_parameters(&[0.0]), Some(checked.robot));
    /// ```
    #[must_use]
    pub fn with_parameters(&self, values: &[f64]) -> Option<Self> {
        let mut robot = self.clone();
        let RunTime { names, entries, written_inertia, parameters } = &self.run_time;
        if values.len() != names.len() {
            return None;
        }
        // adding 0.0 changes -0 to 0, as reading a file does
        let value = |formula: &Formula| formula.evaluate(values) + 0.0;
        for (known, number) in &mut robot.parameters {
            if let Some(index) = names.iter().position(|name| name == known) {
                *number = values[index] + 0.0;
            }
        }
        for (index, formula) in parameters {
            robot.parameters.get_mut(*index)?.1 = value(formula);
        }
        for (joint, element, formula) in written_inertia {
            *element.of_mut(&mut robot.joints.get_mut(*joint)?.written_inertia.0) = value(formula);
        }
        for (entry, formula) in entries {
            *robot.number_mut(*entry)? = value(formula);
            if let Entry::Inertia(joint, element) = *entry {
                let written = &mut robot.joints.get_mut(joint)?.written_inertia;
                if written.1 == InertiaReference::Com {
                    *element.of_mut(&mut written.0) = value(formula);
                }
            }
        }
        Some(robot)
    }

    /// Returns a reference to a number of the table, for changing it; `None` where the robot has no such joint, motor
    /// or axis.
    pub fn number_mut(&mut self, entry: Entry) -> Option<&mut f64> {
        match entry {
            Entry::Gravity(axis) => self.gravity.get_mut(axis),
            Entry::BaseXyz(axis) => self.base.xyz.get_mut(axis),
            Entry::ToolXyz(axis) => self.tool.xyz.get_mut(axis),
            Entry::FrameXyz(frame, axis) => self.frames.get_mut(frame)?.fixed.placement.xyz.get_mut(axis),
            Entry::D(joint) => Some(&mut self.joints.get_mut(joint)?.row.dh.d),
            Entry::A(joint) => Some(&mut self.joints.get_mut(joint)?.row.dh.a),
            Entry::ThetaSine(joint) => Some(&mut self.joints.get_mut(joint)?.row.dh.theta.sin),
            Entry::ThetaCosine(joint) => Some(&mut self.joints.get_mut(joint)?.row.dh.theta.cos),
            Entry::AlphaSine(joint) => Some(&mut self.joints.get_mut(joint)?.row.dh.alpha.sin),
            Entry::AlphaCosine(joint) => Some(&mut self.joints.get_mut(joint)?.row.dh.alpha.cos),
            Entry::Mass(joint) => Some(&mut self.joints.get_mut(joint)?.row.link.mass),
            Entry::Com(joint, axis) => self.joints.get_mut(joint)?.row.link.com.get_mut(axis),
            Entry::FirstMoment(joint, axis) => self.joints.get_mut(joint)?.row.link.first_moment.get_mut(axis),
            Entry::Inertia(joint, element) => Some(element.of_mut(&mut self.joints.get_mut(joint)?.row.link.inertia)),
            Entry::MotorInertia(joint) => Some(&mut self.joints.get_mut(joint)?.motor.as_mut()?.inertia),
            Entry::GearRatio(joint) => Some(&mut self.joints.get_mut(joint)?.motor.as_mut()?.gear_ratio),
            Entry::Viscous(joint) => Some(&mut self.joints.get_mut(joint)?.motor.as_mut()?.viscous),
            Entry::CoulombPositive(joint) => self.joints.get_mut(joint)?.motor.as_mut()?.coulomb.first_mut(),
            Entry::CoulombNegative(joint) => self.joints.get_mut(joint)?.motor.as_mut()?.coulomb.last_mut(),
        }
    }
}
