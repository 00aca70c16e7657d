//! Friction of the joints and limits of their torques: functions beside the programs, which are the same for every
//! arm but for their numbers.

use std::fmt::{self, Write};

use rne_codegen::{Function, Name, Quantity, Real};
use rne_model::{Entry, Joint, Robot};

use super::signature::wrapped;
use super::{ConstantTooLarge, File, comment};
use crate::syntax::Precision;

/// Friction at a joint: viscous q̇ + odd s + even s², with s = q̇ / √(q̇² + width²).
///
/// It is that of `actuator_torques_smooth` of the runtime: |G| (½ (Tc⁺ - Tc⁻) s + ½ (Tc⁺ + Tc⁻) s²) + G² B q̇.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointFriction {
    /// N m s/rad or N s/m.
    viscous: f64,
    /// N m or N: half of the difference of Coulomb friction forward and backward.
    odd: f64,
    /// N m or N: half of their sum.
    even: f64,
    /// The speed at which s is 0.7, rad/s or m/s.
    width: f64,
}

/// Why the friction of a robot is no function of the speeds.
#[derive(Clone, Debug, PartialEq)]
pub enum NoFriction {
    /// No joint has any.
    Nowhere,
    /// The joint has Coulomb friction, and no speed about which it changes its sign.
    NoWidth(String),
    /// The width of the joint is too small to be squared in single precision.
    NarrowWidth(String, f64),
    /// The friction of the joint changes its sign over a displacement, so it is no function of the speed.
    Displacement(String),
    /// The friction of the joint depends on a parameter that is given at run time.
    RunTime(String),
}

impl JointFriction {
    /// The smallest width, rad/s or m/s.
    pub const NARROWEST: f64 = 1e-9;

    /// The friction of the joints from base to tip.
    ///
    /// # Errors
    /// When no joint has friction, or that of one cannot be computed from its speed alone.
    pub fn of(robot: &Robot) -> Result<Vec<Self>, NoFriction> {
        let frictions = Self::about(robot, None)?;
        if frictions.iter().all(|friction| friction.viscous == 0.0 && friction.odd == 0.0) {
            return Err(NoFriction::Nowhere);
        }
        Ok(frictions)
    }

    /// The friction of the joints from base to tip, zero at a joint that has none. Coulomb friction changes its sign
    /// about the speed `width`, rad/s or m/s, or about the `coulomb_width` of each joint. A `width` is at least
    /// [`NARROWEST`](Self::NARROWEST).
    ///
    /// # Errors
    /// When the friction of a joint cannot be computed from its speed alone.
    pub fn about(robot: &Robot, width: Option<f64>) -> Result<Vec<Self>, NoFriction> {
        robot.coordinates().map(|index| Self::of_joint(robot, index, &robot.joints[index], width)).collect()
    }

    /// The numbers viscous, odd, even and width of the law.
    #[must_use]
    pub fn numbers(&self) -> [f64; 4] {
        [self.viscous, self.odd, self.even, self.width]
    }

    /// The friction at a speed, N m or N.
    #[must_use]
    pub fn torque(&self, qd: f64) -> f64 {
        self.torque_in(qd, |number| number, |x| 1.0 / x.sqrt())
    }

    /// The friction at a speed in another type of numbers, with the operations of the emitted code in their order.
    /// `number` makes numbers of this type, and `inverse_root` is 1/√x.
    pub fn torque_in<T: Real>(&self, qd: T, number: impl Fn(f64) -> T, inverse_root: impl Fn(T) -> T) -> T {
        let viscous = (self.viscous != 0.0).then(|| number(self.viscous) * qd);
        let coulomb = (self.odd != 0.0).then(|| {
            let s = qd * inverse_root(qd * qd + number(self.width * self.width));
            let odd = number(self.odd) * s;
            if self.even == 0.0 { odd } else { odd + number(self.even) * (s * s) }
        });
        match (viscous, coulomb) {
            (Some(viscous), Some(coulomb)) => viscous + coulomb,
            (one, other) => one.or(other).unwrap_or_else(|| number(0.0)),
        }
    }

    /// The derivative of the friction by the speed, N m s/rad or N s/m.
    #[must_use]
    pub fn derivative(&self, qd: f64) -> f64 {
        self.derivative_in(qd, |number| number, |x| 1.0 / x.sqrt())
    }

    /// The derivative of the friction by the speed, viscous + (odd + 2 even s) width² r³ with r = 1/√(q̇² + width²), in
    /// another type of numbers, as [`torque_in`](Self::torque_in).
    pub fn derivative_in<T: Real>(&self, qd: T, number: impl Fn(f64) -> T, inverse_root: impl Fn(T) -> T) -> T {
        let viscous = (self.viscous != 0.0).then(|| number(self.viscous));
        let coulomb = (self.odd != 0.0).then(|| {
            let square = number(self.width * self.width);
            let r = inverse_root(qd * qd + square);
            let slope = square * r * r * r;
            let odd = number(self.odd);
            if self.even == 0.0 { odd * slope } else { (odd + number(2.0 * self.even) * (qd * r)) * slope }
        });
        match (viscous, coulomb) {
            (Some(viscous), Some(coulomb)) => viscous + coulomb,
            (one, other) => one.or(other).unwrap_or_else(|| number(0.0)),
        }
    }

    fn of_joint(robot: &Robot, index: usize, joint: &Joint, width: Option<f64>) -> Result<Self, NoFriction> {
        let Some(motor) = joint.motor else { return Ok(Self { viscous: 0.0, odd: 0.0, even: 0.0, width: 1.0 }) };
        let name = || joint.name.clone();
        let entries = [
            Entry::GearRatio(index),
            Entry::Viscous(index),
            Entry::CoulombPositive(index),
            Entry::CoulombNegative(index),
        ];
        if entries.into_iter().any(|entry| robot.run_time.formula(entry).is_some()) {
            return Err(NoFriction::RunTime(name()));
        }
        let ratio = motor.gear_ratio.abs();
        let [forward, backward] = motor.coulomb.map(|friction| ratio * friction);
        let width = match width.or(joint.coulomb_width) {
            _ if forward == 0.0 && backward == 0.0 => 1.0,
            _ if width.is_none() && joint.coulomb_displacement.is_some() => {
                return Err(NoFriction::Displacement(name()));
            }
            None => return Err(NoFriction::NoWidth(name())),
            Some(width) if width < Self::NARROWEST => return Err(NoFriction::NarrowWidth(name(), width)),
            Some(width) => width,
        };
        let viscous = ratio * ratio * motor.viscous;
        Ok(Self { viscous, odd: 0.5 * (forward - backward), even: 0.5 * (forward + backward), width })
    }
}

impl fmt::Display for NoFriction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nowhere => f.write_str(
                "no joint has friction; write it in `motor` of the joint: `motor: {viscous: 0.4, coulomb: [0.5, -0.5], \
                 coulomb_width: 0.02}`",
            ),
            Self::NoWidth(joint) => write!(
                f,
                "the joint {joint} has Coulomb friction without `coulomb_width`; write the speed about which the \
                 friction changes its sign in `motor` of the joint, for example `coulomb_width: 0.02` (rad/s or m/s)"
            ),
            Self::NarrowWidth(joint, width) => {
                let narrowest = JointFriction::NARROWEST;
                write!(
                    f,
                    "the joint {joint} has `coulomb_width: {width}`; the smallest width for this function is \
                     {narrowest:e} rad/s or m/s"
                )
            }
            Self::Displacement(joint) => write!(
                f,
                "the joint {joint} has `coulomb_displacement`: its friction depends on the way since the last \
                 reversal, and the function knows only the speed; write `coulomb_width` instead"
            ),
            Self::RunTime(joint) => {
                write!(f, "the friction of the joint {joint} depends on a parameter that is given at run time")
            }
        }
    }
}

impl std::error::Error for NoFriction {}

/// Whether a function needs the bits of a number.
pub(super) fn needs_bits(file: &File) -> bool {
    has_coulomb(file) || file.additions.limits
}

fn has_coulomb(file: &File) -> bool {
    file.additions.friction.is_some_and(|frictions| frictions.iter().any(|friction| friction.odd != 0.0))
}

/// The declarations for the header.
pub(super) fn declarations(file: &File) -> String {
    let mut text = String::new();
    if file.additions.friction.is_some() {
        text.push('\n');
        text.push_str(&comment(
            "///",
            "Friction of the joints at speeds qd. Add it to the torques of the links, then limit the sum. It is \
             viscous * qd + odd * s + even * s^2 with s = qd / sqrt(qd^2 + width^2): smooth, zero at rest, and Coulomb \
             friction of the robot file far from rest.",
        ));
        text.push_str(&comment(
            "///",
            "friction: positive for a positive speed; N m or N, at the joint. viscous is G^2 B, odd is |G| (Tc+ - \
             Tc-)/2, even is |G| (Tc+ + Tc-)/2, and width is coulomb_width, all of the robot file. The error of s is \
             below 4 ulp. Speeds up to 1e18 are allowed.",
        ));
        let _ = writeln!(text, "{};\n", friction_head(file));
        text.push_str(&comment(
            "///",
            "Derivative of the friction of each joint by its speed qd, N m s/rad or N s/m: viscous + (odd + 2 * even * \
             s) * width^2 / (qd^2 + width^2)^(3/2). These are the elements of a diagonal matrix. Speeds up to 1e18 are \
             allowed.",
        ));
        let _ = writeln!(text, "{};", derivatives_head(file));
    }
    if file.additions.limits {
        text.push('\n');
        text.push_str(&comment(
            "///",
            "Torques within the effort limits of the robot file: a larger torque becomes the limit, a torque below the \
             negative limit becomes the negative limit. A joint without a limit keeps its torque. A NaN remains a NaN.",
        ));
        let _ = writeln!(text, "{};", limits_head(file));
    }
    text
}

/// The functions.
pub(super) fn definitions(file: &File) -> Result<String, ConstantTooLarge> {
    let mut text = String::new();
    if needs_bits(file) {
        let (real, prefix) = (file.precision.c_type(), file.prefix);
        let _ = write!(
            text,
            "\n// A number and its bits: C99 defines it, rule 19.2 of MISRA C advises against any union.\n\
             typedef union {{\n    {real} number;\n    {} bits;\n}} {prefix}_number;\n",
            bits_type(file)
        );
    }
    if let Some(frictions) = file.additions.friction {
        if has_coulomb(file) {
            let _ = write!(text, "\n{}", inverse_root(file));
        }
        let _ = write!(text, "\n{}\n{}", friction(file, frictions)?, derivatives(file, frictions)?);
    }
    if file.additions.limits {
        let _ = write!(text, "\n{}", limits(file));
    }
    Ok(text)
}

fn bits_type(file: &File) -> &'static str {
    match file.precision {
        Precision::Single => "uint32_t",
        Precision::Double => "uint64_t",
    }
}

fn friction_head(file: &File) -> String {
    let (real, dof) = (file.precision.c_type(), file.robot.dof());
    let arguments = [format!("const {real} qd[{dof}]"), format!("{real} friction[{dof}]")];
    wrapped(&format!("void {}_friction_torques(", file.prefix), &arguments)
}

fn derivatives_head(file: &File) -> String {
    let (real, dof) = (file.precision.c_type(), file.robot.dof());
    let arguments = [format!("const {real} qd[{dof}]"), format!("{real} derivatives[{dof}]")];
    wrapped(&format!("void {}_friction_derivatives(", file.prefix), &arguments)
}

fn limits_head(file: &File) -> String {
    let (real, dof) = (file.precision.c_type(), file.robot.dof());
    let arguments = [format!("const {real} tau[{dof}]"), format!("{real} limited[{dof}]")];
    wrapped(&format!("void {}_limit_torques(", file.prefix), &arguments)
}

/// 1/√x from the bits of x: half of the exponent, then Newton's steps, each of which doubles the digits.
fn inverse_root(file: &File) -> String {
    let (real, prefix) = (file.precision.c_type(), file.prefix);
    // the relative error after the bits is 0.035; it is 1.8e-3, 4.7e-6, 3.3e-11, 1.7e-21 after the steps
    let (magic, steps) = match file.precision {
        Precision::Single => ("0x5f375a86u", 3),
        Precision::Double => ("0x5fe6eb50c7b537a9u", 4),
    };
    let [half, more] = [0.5, 1.5].map(|number| file.precision.literal(number).unwrap_or_default());
    let mut text = format!(
        "// 1 / sqrt(x) of x above 0, without a library and without a branch: half of the exponent by\n\
         // the bits, then steps of Newton.\n\
         static {real} {prefix}_inverse_root({real} x)\n{{\n    const {real} h = {half} * x;\n    \
         {prefix}_number guess;\n    {real} y;\n    guess.number = x;\n    \
         guess.bits = {magic} - (guess.bits >> 1u);\n    y = guess.number;\n"
    );
    for _ in 0..steps {
        let _ = writeln!(text, "    y = y * ({more} - ((h * y) * y));");
    }
    text + "    return y;\n}\n"
}

/// A number of a joint's friction as the code has it.
fn constant(file: &File, quantity: Quantity, joint: usize, value: f64) -> Result<String, ConstantTooLarge> {
    let too_large =
        ConstantTooLarge { name: Name::scalar(quantity, joint), value, function: Function::ActuatorTorques };
    file.precision.literal(value).ok_or(too_large)
}

fn friction(file: &File, frictions: &[JointFriction]) -> Result<String, ConstantTooLarge> {
    let (real, prefix) = (file.precision.c_type(), file.prefix);
    let mut text = format!("{}\n{{\n", friction_head(file));
    for (index, friction) in frictions.iter().enumerate() {
        if friction.viscous != 0.0 || friction.odd != 0.0 {
            let _ = writeln!(text, "    const {real} qd{} = qd[{index}];", index + 1);
        }
    }
    for (index, friction) in frictions.iter().enumerate() {
        let joint = index + 1;
        let _ = writeln!(text, "\n    // joint {joint}");
        let mut sum = Vec::new();
        if friction.viscous != 0.0 {
            let viscous = constant(file, Quantity::ViscousFriction, joint, friction.viscous)?;
            sum.push(format!("({viscous} * qd{joint})"));
        }
        if friction.odd != 0.0 {
            let coulomb = |value| constant(file, Quantity::CoulombFriction, joint, value);
            let square = coulomb(friction.width * friction.width)?;
            let _ = writeln!(
                text,
                "    const {real} s{joint} = qd{joint} * {prefix}_inverse_root((qd{joint} * qd{joint}) + {square});"
            );
            let odd = format!("({} * s{joint})", coulomb(friction.odd)?);
            let of_sign = if friction.even == 0.0 {
                odd
            } else {
                format!("{odd} + ({} * (s{joint} * s{joint}))", coulomb(friction.even)?)
            };
            let _ = writeln!(text, "    const {real} coulomb{joint} = {of_sign};");
            sum.push(format!("coulomb{joint}"));
        }
        let sum = if sum.is_empty() { file.syntax().zero().to_owned() } else { sum.join(" + ") };
        let _ = writeln!(text, "    friction[{index}] = {sum};");
    }
    Ok(text + "}\n")
}

/// The derivatives of the friction by the speeds.
fn derivatives(file: &File, frictions: &[JointFriction]) -> Result<String, ConstantTooLarge> {
    let (real, prefix) = (file.precision.c_type(), file.prefix);
    let mut text = format!("{}\n{{\n", derivatives_head(file));
    for (index, _) in frictions.iter().enumerate().filter(|(_, friction)| friction.odd != 0.0) {
        let _ = writeln!(text, "    const {real} qd{} = qd[{index}];", index + 1);
    }
    if !has_coulomb(file) {
        text.push_str("    (void)qd; // the derivatives are constants\n");
    }
    for (index, friction) in frictions.iter().enumerate() {
        let joint = index + 1;
        let _ = writeln!(text, "\n    // joint {joint}");
        let mut sum = Vec::new();
        if friction.viscous != 0.0 {
            sum.push(constant(file, Quantity::ViscousFriction, joint, friction.viscous)?);
        }
        if friction.odd != 0.0 {
            let coulomb = |value| constant(file, Quantity::CoulombFriction, joint, value);
            let square = coulomb(friction.width * friction.width)?;
            let _ = writeln!(
                text,
                "    const {real} r{joint} = {prefix}_inverse_root((qd{joint} * qd{joint}) + {square});\n    \
                 const {real} slope{joint} = (({square} * r{joint}) * r{joint}) * r{joint};"
            );
            let odd = coulomb(friction.odd)?;
            sum.push(if friction.even == 0.0 {
                format!("({odd} * slope{joint})")
            } else {
                format!("(({odd} + ({} * (qd{joint} * r{joint}))) * slope{joint})", coulomb(2.0 * friction.even)?)
            });
        }
        let sum = if sum.is_empty() { file.syntax().zero().to_owned() } else { sum.join(" + ") };
        let _ = writeln!(text, "    derivatives[{index}] = {sum};");
    }
    Ok(text + "}\n")
}

/// Limits by the bits of the numbers: of a comparison, compilers make a branch.
fn limits(file: &File) -> String {
    let (real, prefix, bits) = (file.precision.c_type(), file.prefix, bits_type(file));
    let (sign, infinity, shift) = match file.precision {
        Precision::Single => ("0x80000000u", "0x7f800000u", 31),
        Precision::Double => ("0x8000000000000000u", "0x7ff0000000000000u", 63),
    };
    let (mut arguments, mut results) = (String::new(), String::new());
    for (index, joint) in file.robot.independent_joints().enumerate() {
        let tau = format!("tau{}", index + 1);
        let _ = writeln!(arguments, "    const {real} {tau} = tau[{index}];");
        // a limit that the type cannot hold limits no number of it
        let limit = joint.limits.effort.and_then(|limit| file.precision.literal(limit));
        let value = limit.map_or(tau.clone(), |limit| format!("{prefix}_limited({tau}, {limit})"));
        let _ = writeln!(results, "    limited[{index}] = {value};");
    }
    format!(
        "// x between -limit and limit. Magnitudes of numbers are in the order of their bits, and those of\n\
         // NaN are above infinity: a NaN remains a NaN.\n\
         static {real} {prefix}_limited({real} x, {real} limit)\n{{\n    {prefix}_number within;\n    \
         {prefix}_number most;\n    {bits} sign;\n    {bits} magnitude;\n    {bits} is_above;\n    \
         {bits} is_number;\n    within.number = x;\n    most.number = limit;\n    \
         sign = within.bits & {sign};\n    magnitude = within.bits ^ sign;\n    \
         // each is all bits or none\n    \
         is_above = 0u - ((most.bits - magnitude) >> {shift}u);\n    \
         is_number = (({infinity} - magnitude) >> {shift}u) - 1u;\n    \
         within.bits = sign | (magnitude ^ ((magnitude ^ most.bits) & is_above & is_number));\n    \
         return within.number;\n}}\n\n{}\n{{\n{arguments}\n    // within the limits\n{results}}}\n",
        limits_head(file)
    )
}
