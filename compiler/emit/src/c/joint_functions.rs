//! Functions for the friction of the joints and the limits of their torques. They are not programs: they are the same
//! for every arm except for their numbers.

use std::fmt::Write;

use rne_codegen::{Function, Name, Quantity};

use super::joint_friction::JointFriction;
use super::signature::wrapped;
use super::{ConstantTooLarge, File, comment};
use crate::syntax::Precision;

/// Whether a function of the file reads the bits of a number.
pub(super) fn needs_bits(file: &File) -> bool {
    has_coulomb(file) || file.additions.limits
}

fn has_coulomb(file: &File) -> bool {
    file.additions.friction.is_some_and(|frictions| frictions.iter().any(|friction| friction.odd != 0.0))
}

/// Returns the declarations of these functions for the header.
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

/// Returns the definitions of these functions.
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

/// Returns the signature of a function that takes and returns one number per joint.
fn head(file: &File, function: &str, input: &str, output: &str) -> String {
    let (real, dof) = (file.precision.c_type(), file.robot.dof());
    let arguments = [format!("const {real} {input}[{dof}]"), format!("{real} {output}[{dof}]")];
    wrapped(&format!("void {}_{function}(", file.prefix), &arguments)
}

fn friction_head(file: &File) -> String {
    head(file, "friction_torques", "qd", "friction")
}

fn derivatives_head(file: &File) -> String {
    head(file, "friction_derivatives", "qd", "derivatives")
}

fn limits_head(file: &File) -> String {
    head(file, "limit_torques", "tau", "limited")
}

/// Returns a function for 1/√x: its first guess halves the exponent in the bits of x, then each Newton step doubles the
/// number of correct digits.
fn inverse_root(file: &File) -> String {
    let (real, prefix) = (file.precision.c_type(), file.prefix);
    // the relative error of the first guess is 0.035; after the steps it is 1.8e-3, 4.7e-6, 3.3e-11, 1.7e-21
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

/// Returns a number of a joint's friction as a literal of the code.
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

/// Writes the function for the derivatives of the friction with respect to the speeds.
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

/// Writes the function for the limits. It works on the bits of the numbers, because compilers make a branch of a
/// comparison.
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
        // a limit that is too large for the number type limits none of its numbers
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
