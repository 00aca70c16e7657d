//! The shape of an inspection.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::tree::Tree;

/// The compiler's knowledge of one function of one arm.
#[derive(Clone, Debug, Serialize)]
pub struct Inspection {
    /// `rne-inspection`.
    pub schema: &'static str,
    /// The version of the shape; a field may be added within one, none is taken away or changes its meaning.
    pub version: u32,
    /// The program that wrote it.
    pub generator: String,
    /// The arm.
    pub robot: Robot,
    /// Name of the function.
    pub function: String,
    /// Name of its form: `seven_steps` or `reduced`.
    pub form: String,
    /// The reduced forms that were refused before this one, each with the reason.
    pub refusals: Vec<String>,
    /// Its operations.
    pub counts: Counts,
    /// The meaning of every name, by its text.
    pub names: BTreeMap<String, Name>,
    /// The quantities of these names.
    pub quantities: BTreeMap<String, Quantity>,
    /// Why operations folded; a [`Mark`](crate::Mark) tells its number here, counted from 0.
    pub reasons: Vec<String>,
    /// The arguments that are used.
    pub arguments: Vec<String>,
    /// The numbers of the table, and those made of them, that the code uses: name and value.
    pub constants: Vec<(String, f64)>,
    /// Angles that are sums, in order.
    pub angles: Vec<Statement>,
    /// Sines and cosines, evaluated at once.
    pub sines_and_cosines: Vec<SineCosine>,
    /// The statements of the code, each using only what stands before it.
    pub statements: Vec<Statement>,
    /// The outputs, in order: the name, and the value over the names before it.
    pub outputs: Vec<(String, Tree)>,
    /// Numbers of the table and what is made of them before any step: link by link.
    pub table: Vec<Component>,
    /// The steps of the joints, in the order in which they are computed: steps 1 to 5 from the base to the tip, steps 6
    /// and 7 back. Empty for what is not the seven steps.
    pub cells: Vec<Cell>,
}

/// The arm as its file has it, in SI units; lengths m, angles rad.
#[derive(Clone, Debug, Serialize)]
pub struct Robot {
    /// Identifier.
    pub name: String,
    /// For people.
    pub title: String,
    /// Where the numbers come from.
    pub source: String,
    /// `standard` or `modified` Denavit-Hartenberg rows.
    pub convention: &'static str,
    /// Acceleration of gravity in frame 0, m/s²; it points down.
    pub gravity: [f64; 3],
    /// World → frame 0.
    pub base: Transform,
    /// Frame of the link `tip` → tip frame.
    pub tool: Transform,
    /// The number of the joint whose link carries the tip.
    pub tip: usize,
    /// Base to tip.
    pub joints: Vec<Joint>,
}

/// A placement: translation, then R = Rz(yaw) Ry(pitch) Rx(roll).
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Transform {
    /// m
    pub xyz: [f64; 3],
    /// roll, pitch, yaw, rad
    pub rpy: [f64; 3],
}

/// How a joint follows others: its position is Σ ratio · q + offset.
#[derive(Clone, Debug, Serialize)]
pub struct Follows {
    /// The joints that it follows, counted from 1, each with its ratio.
    pub ratios: Vec<(usize, f64)>,
    /// Its position where those joints are at 0, rad or m.
    pub offset: f64,
}

/// A joint and the link that it moves.
#[derive(Clone, Debug, Serialize)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// `revolute` or `prismatic`.
    pub kind: &'static str,
    /// The number of the joint that carries it; 0 is the base.
    pub parent: usize,
    /// Where its row begins in the link frame of the parent, if not there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub begins: Option<Transform>,
    /// How it follows other joints, if it does: it is no coordinate then, and has no torque.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub follows: Option<Follows>,
    /// θ, or its constant part, rad.
    pub theta: f64,
    /// d, or its constant part, m.
    pub d: f64,
    /// a, m.
    pub a: f64,
    /// α, rad.
    pub alpha: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the link frame of the table, m.
    pub com: [f64; 3],
    /// First moment of a link without mass that has one, in the same frame, kg m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_moment: Option<[f64; 3]>,
    /// xx, yy, zz, xy, xz, yz about the centre of mass in link axes, kg m².
    pub inertia: [f64; 6],
    /// Smallest and largest position, if the file has them.
    pub position_limits: Option<[f64; 2]>,
    /// Largest speed, if the file has it.
    pub velocity_limit: Option<f64>,
    /// Largest torque or force, if the file has it.
    pub effort_limit: Option<f64>,
}

/// Operations of one evaluation.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Counts {
    /// Before folding, step 3 included.
    pub before: Operations,
    /// In the code.
    pub after: Operations,
    /// Divisions in the code.
    pub divisions: usize,
    /// Angles whose sine or cosine the code takes.
    pub angles: usize,
    /// Statements of the code.
    pub statements: usize,
}

/// Products and sums; a difference is a sum, a sign costs nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Operations {
    /// Products.
    pub products: usize,
    /// Sums and differences.
    pub sums: usize,
}

/// The meaning of a name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Name {
    /// The quantity, as `rne explain quantities` lists them: `omega`, `joint_force`.
    pub quantity: String,
    /// The joint, counted from 1; 0 is the base, n + 1 the tip or a payload.
    pub joint: usize,
    /// `x`, `y`, `z` of a vector, `xy` and so on of a matrix; absent for one number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<String>,
    /// Number of the shared term inside the quantity, from 1; absent for the quantity itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<usize>,
    /// The joint to which a lever of the link leads, or that takes what the link hands on; n + 1 is the tip. Absent for
    /// the first that the link carries.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub carries: Option<usize>,
}

/// A quantity: letter, unit, axes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quantity {
    /// Its letter in formulas: `ω`.
    pub letter: &'static str,
    /// Its meaning in words.
    pub meaning: &'static str,
    /// The step that computes it, 1 to 7; absent for arguments and numbers of the table.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<usize>,
    /// Its unit at a revolute joint and at a prismatic one; empty for plain numbers.
    pub units: [&'static str; 2],
    /// In whose axes its components are: `link`, that of the joint in the name, or `parent`, the one before it; absent
    /// where axes mean nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axes: Option<&'static str>,
    /// Where to draw it. `joint`: an arrow at the joint; `com`: at the centre of mass of the link; `axis`: along or
    /// about the joint's axis; `position`: from the joint to the centre of mass; `lever`: at the end of the link, where
    /// the next joint is; `frame`: the axes of the joint's frame; `link`: the whole link.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawn: Option<&'static str>,
}

/// A statement of the code.
#[derive(Clone, Debug, Serialize)]
pub struct Statement {
    /// The name of its value.
    pub name: String,
    /// Component of the lecture to which the term belongs; absent if it belongs to none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<String>,
    /// Its value.
    pub value: Tree,
    /// As it stands in generated Rust.
    pub rust: String,
}

/// A sine and a cosine; a name is absent where the code does not use it.
#[derive(Clone, Debug, Serialize)]
pub struct SineCosine {
    /// The joint.
    pub joint: usize,
    /// Name of the sine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sine: Option<String>,
    /// Name of the cosine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cosine: Option<String>,
    /// The angle, rad.
    pub angle: Tree,
}

/// One step of one joint.
#[derive(Clone, Debug, Serialize)]
pub struct Cell {
    /// The joint, counted from 1; n + 1 for a payload.
    pub joint: usize,
    /// The step, 1 to 7.
    pub step: usize,
    /// The title of the step.
    pub title: &'static str,
    /// Its equations between vectors, in the letters of the lecture.
    pub formulas: Vec<Formula>,
    /// Operations before folding.
    pub before: Operations,
    /// Operations in the code.
    pub after: Operations,
    /// How many operations went for which reason, the commonest first.
    pub reasons: Vec<(usize, String)>,
    /// Its equations component by component. One may use components of any cell, and of the table; none uses itself.
    pub components: Vec<Component>,
}

/// An equation between vectors.
#[derive(Clone, Debug, Serialize)]
pub struct Formula {
    /// The quantity that it gives.
    pub quantity: String,
    /// The equation.
    pub text: String,
}

/// One component of a quantity: its equation in general, for this robot, what folded, and the code that is left.
#[derive(Clone, Debug, Serialize)]
pub struct Component {
    /// Its name.
    pub name: String,
    /// Its equation before folding, for any arm with these joints.
    pub general: Tree,
    /// The equation for this robot, as text: names with a constant value are replaced by the number.
    pub with_numbers: String,
    /// The terms that folded away, and why.
    pub folded: Vec<Folded>,
    /// Its fate in the code.
    pub became: Became,
    /// The statements that compute it and its parts, in order.
    pub statements: Vec<String>,
    /// The components whose equations use it.
    pub used_by: Vec<String>,
}

/// A term that folded away.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Folded {
    /// The term.
    pub term: String,
    /// The rest of it: `0`, or the operand that a factor 1 leaves, or the name under which it stands elsewhere.
    pub left: String,
    /// Why, in the words of the table.
    pub why: String,
}

/// The fate of a component in the code.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Became {
    /// It is computed by the statement of its own name.
    Computed,
    /// It is another name, or its negative.
    Same {
        /// The other name, with a minus sign where it is the negative.
        name: String,
    },
    /// It is a number.
    Constant {
        /// The number.
        value: f64,
        /// Because of what.
        why: String,
    },
    /// It stands inside the statement that uses it.
    Inside,
    /// Nothing that is returned depends on it.
    Unused,
}
