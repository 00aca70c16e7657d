//! The data types of an inspection.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::tree::Tree;

/// The compiler's knowledge of one function of one arm.
#[derive(Clone, Debug, Serialize)]
pub struct Inspection {
    /// Name of the schema: `rne-inspection`.
    pub schema: &'static str,
    /// The version of the schema. Within a version, fields may be added, but none is removed or changes its meaning.
    pub version: u32,
    /// The program that wrote the inspection.
    pub generator: String,
    /// The arm.
    pub robot: Robot,
    /// Name of the function.
    pub function: String,
    /// Name of the form of the function: `seven_steps` or `reduced`.
    pub form: String,
    /// The reduced forms that were refused before this one, each with the reason.
    pub refusals: Vec<String>,
    /// The numbers of operations of the function.
    pub counts: Counts,
    /// The meaning of every name in the program.
    pub names: BTreeMap<String, Name>,
    /// The quantities to which these names belong.
    pub quantities: BTreeMap<String, Quantity>,
    /// The reasons for which operations were folded; a [`Mark`](crate::Mark) refers to them by index, from 0.
    pub reasons: Vec<String>,
    /// The arguments that the code uses.
    pub arguments: Vec<String>,
    /// The constants that the code uses, from the table or computed from it: name and value.
    pub constants: Vec<(String, f64)>,
    /// Angles that are sums, in order.
    pub angles: Vec<Statement>,
    /// Sines and cosines, evaluated at once.
    pub sines_and_cosines: Vec<SineCosine>,
    /// The statements of the code; each uses only earlier ones.
    pub statements: Vec<Statement>,
    /// The outputs, in order: the name, and the formula of its value.
    pub outputs: Vec<(String, Tree)>,
    /// Numbers of the table, and values that are computed from them before any step, link by link.
    pub table: Vec<Component>,
    /// The steps of the joints, in the order in which they are computed: steps 1 to 5 from the base to the tip, steps 6
    /// and 7 back. Empty for other forms than the seven steps.
    pub cells: Vec<Cell>,
}

/// The arm of the robot file, in SI units; lengths m, angles rad.
#[derive(Clone, Debug, Serialize)]
pub struct Robot {
    /// Name of the robot, an identifier.
    pub name: String,
    /// Title of the robot.
    pub title: String,
    /// Source of the numbers.
    pub source: String,
    /// `standard` or `modified` Denavit-Hartenberg rows.
    pub convention: &'static str,
    /// Acceleration of gravity in frame 0, m/s²; it points down.
    pub gravity: [f64; 3],
    /// Placement of frame 0 in the world.
    pub base: Transform,
    /// Placement of the tip frame in the frame of the link that carries it.
    pub tool: Transform,
    /// The number of the joint whose link carries the tip.
    pub tip: usize,
    /// The joints, base to tip.
    pub joints: Vec<Joint>,
}

/// A placement: translation, then R = Rz(yaw) Ry(pitch) Rx(roll).
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Transform {
    /// Translation, m.
    pub xyz: [f64; 3],
    /// Roll, pitch and yaw, rad.
    pub rpy: [f64; 3],
}

/// The coupling of a dependent joint: its position is Σ ratio · q + offset.
#[derive(Clone, Debug, Serialize)]
pub struct Follows {
    /// The joints on which it depends, counted from 1, each with its ratio.
    pub ratios: Vec<(usize, f64)>,
    /// Its position if those joints are at 0, rad or m.
    pub offset: f64,
}

/// A joint and the link that it moves.
#[derive(Clone, Debug, Serialize)]
pub struct Joint {
    /// Name of the joint.
    pub name: String,
    /// `revolute` or `prismatic`.
    pub kind: &'static str,
    /// The number of the joint whose link carries this joint; 0 is the base.
    pub parent: usize,
    /// Placement of the frame where the row begins, in the link frame of the parent; absent if it is that frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub begins: Option<Transform>,
    /// The coupling, if this is a dependent joint, which is no coordinate and has no torque.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub follows: Option<Follows>,
    /// θ, or its constant part for a revolute joint, rad.
    pub theta: f64,
    /// d, or its constant part for a prismatic joint, m.
    pub d: f64,
    /// a, m.
    pub a: f64,
    /// α, rad.
    pub alpha: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the link frame of the table, m.
    pub com: [f64; 3],
    /// First moment of a link that has one but no mass, in the link frame of the table, kg m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_moment: Option<[f64; 3]>,
    /// Inertia about the centre of mass in link axes: xx, yy, zz, xy, xz, yz, kg m².
    pub inertia: [f64; 6],
    /// Smallest and largest position, if the file has them.
    pub position_limits: Option<[f64; 2]>,
    /// Largest speed, if the file has it.
    pub velocity_limit: Option<f64>,
    /// Largest torque or force, if the file has it.
    pub effort_limit: Option<f64>,
}

/// Numbers of operations of one evaluation.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Counts {
    /// Operations before folding, including step 3.
    pub before: Operations,
    /// Operations in the code.
    pub after: Operations,
    /// Number of divisions in the code.
    pub divisions: usize,
    /// Number of angles whose sine or cosine the code computes.
    pub angles: usize,
    /// Number of statements of the code.
    pub statements: usize,
}

/// Numbers of products and sums. A difference counts as a sum; changes of sign are not counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Operations {
    /// Number of products.
    pub products: usize,
    /// Number of sums and differences.
    pub sums: usize,
}

/// The meaning of a name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Name {
    /// The quantity in the list of `rne explain quantities`, such as `omega` or `joint_force`.
    pub quantity: String,
    /// The joint, counted from 1; 0 is the base, n + 1 the tip or a payload.
    pub joint: usize,
    /// The component: `x`, `y` or `z` of a vector, `xy` and so on of a matrix; absent for a single number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<String>,
    /// Number, from 1, of a shared term within the quantity; absent for the quantity itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<usize>,
    /// The next joint to which a lever of the link leads, or on which a force of the link acts; n + 1 is the tip.
    /// Absent for the first joint that the link carries.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub carries: Option<usize>,
}

/// A quantity: letter, unit, axes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quantity {
    /// The letter in formulas, such as `ω`.
    pub letter: &'static str,
    /// The meaning in words.
    pub meaning: &'static str,
    /// The step that computes it, 1 to 7; absent for arguments and numbers of the table.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<usize>,
    /// The units at a revolute joint and at a prismatic joint; empty for plain numbers.
    pub units: [&'static str; 2],
    /// The axes of the components: `link` for the link of the joint in the name, or `parent` for the previous link;
    /// absent for quantities without axes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axes: Option<&'static str>,
    /// The place in drawings of the arm. `joint`: an arrow at the joint; `com`: at the centre of mass of the link;
    /// `axis`: along or about the joint's axis; `position`: from the joint to the centre of mass; `lever`: at the end
    /// of the link, where the next joint is; `frame`: the axes of the joint's frame; `link`: the whole link.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawn: Option<&'static str>,
}

/// A statement of the code.
#[derive(Clone, Debug, Serialize)]
pub struct Statement {
    /// The name of the value.
    pub name: String,
    /// Component of the lecture to which the statement belongs; absent if it belongs to none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<String>,
    /// The formula of the value.
    pub value: Tree,
    /// The statement in the generated Rust code.
    pub rust: String,
}

/// A sine and a cosine of an angle; a name is absent if the code does not use it.
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
    /// The vector equations of the step, with the letters of the lecture.
    pub formulas: Vec<Formula>,
    /// Operations before folding.
    pub before: Operations,
    /// Operations in the code.
    pub after: Operations,
    /// Numbers of operations that were folded away, with the reason, the commonest first.
    pub reasons: Vec<(usize, String)>,
    /// The equations component by component. An equation may use components of any cell and of the table, but not
    /// itself.
    pub components: Vec<Component>,
}

/// An equation between vectors.
#[derive(Clone, Debug, Serialize)]
pub struct Formula {
    /// The quantity on the left side.
    pub quantity: String,
    /// The equation.
    pub text: String,
}

/// One component of a quantity: its general equation, that for this robot, the folded terms, and the remaining code.
#[derive(Clone, Debug, Serialize)]
pub struct Component {
    /// Name of the component.
    pub name: String,
    /// The equation before folding, for any arm with these joints.
    pub general: Tree,
    /// The equation for this robot, as text: names with a constant value are replaced by the number.
    pub with_numbers: String,
    /// The terms that were folded away, with the reasons.
    pub folded: Vec<Folded>,
    /// The fate of the component in the code.
    pub became: Became,
    /// The statements that compute the component and its parts, in order.
    pub statements: Vec<String>,
    /// The components whose equations use this one.
    pub used_by: Vec<String>,
}

/// A term that was folded away.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Folded {
    /// The term.
    pub term: String,
    /// The rest of the term: `0`, or the other operand of a factor 1, or the name of the same value elsewhere.
    pub left: String,
    /// The reason in words, by the numbers of the table.
    pub why: String,
}

/// The fate of a component in the code.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Became {
    /// A statement with its name computes it.
    Computed,
    /// It equals another name, or the negative of it.
    Same {
        /// The other name, with a minus sign for the negative.
        name: String,
    },
    /// It is a constant.
    Constant {
        /// The value.
        value: f64,
        /// The reason for which it is a constant.
        why: String,
    },
    /// It is computed within the statement that uses it.
    Inside,
    /// No output depends on it.
    Unused,
}
