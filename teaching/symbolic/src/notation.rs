//! Writes letters, powers and fractions in Unicode for a terminal and in LaTeX.

use rne_model::JointKind;

use crate::factor::{Argument, Factor};
use crate::rational::{Rational, Spelling, spelling};
use crate::symbol::{Angle, Constants};

/// The script in which a formula is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Script {
    /// Unicode for a terminal.
    Unicode,
    /// Mathematics of LaTeX.
    Latex,
}

/// Writes the letters of an arm in a script.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Notation<'c> {
    pub(crate) script: Script,
    pub(crate) constants: &'c Constants,
    /// The kinds of the joints, base to tip.
    pub(crate) kinds: &'c [JointKind],
}

impl Notation<'_> {
    /// Writes a letter with an index.
    pub(crate) fn indexed(&self, letter: &str, index: &str) -> String {
        match self.script {
            Script::Unicode => format!("{letter}{index}"),
            Script::Latex if index.is_empty() => letter.to_owned(),
            Script::Latex => format!("{letter}_{{{index}}}"),
        }
    }

    /// Writes the indices of a matrix or a Christoffel symbol, with commas if there are more than nine joints.
    pub(crate) fn indices(&self, indices: &[usize]) -> String {
        let separator = if self.kinds.len() > 9 { "," } else { "" };
        indices.iter().map(|index| (index + 1).to_string()).collect::<Vec<_>>().join(separator)
    }

    /// Writes a Greek or other letter.
    pub(crate) fn letter(&self, unicode: &'static str) -> &'static str {
        match (self.script, unicode) {
            (Script::Unicode, _) => unicode,
            (_, "τ") => r"\tau",
            (_, "γ") => r"\gamma",
            (_, "θ") => r"\theta",
            (_, "θ̇") => r"\dot{\theta}",
            (_, "θ̈") => r"\ddot{\theta}",
            (_, "ḋ") => r"\dot{d}",
            (_, "d̈") => r"\ddot{d}",
            (_, "α") => r"\alpha",
            (_, "Σ") => r"\sum",
            _ => unicode,
        }
    }

    /// Writes θ or d of a joint with a number of dots.
    pub(crate) fn variable(&self, joint: usize, dots: usize) -> String {
        let is_revolute = self.kinds.get(joint) == Some(&JointKind::Revolute);
        let letters = if is_revolute { ["θ", "θ̇", "θ̈"] } else { ["d", "ḋ", "d̈"] };
        self.indexed(self.letter(letters[dots.min(2)]), &(joint + 1).to_string())
    }

    pub(crate) fn angle(&self, angle: Angle) -> String {
        match angle {
            Angle::Joint(joint) => self.variable(joint, 0),
            Angle::Twist(row) => self.indexed(self.letter("α"), &row.to_string()),
            Angle::Turn(joint) => self.indexed(self.letter("θ"), &(joint + 1).to_string()),
        }
    }

    pub(crate) fn constant(&self, index: usize) -> String {
        self.named(self.constants.0.get(index).map_or("", |constant| constant.name.as_str()))
    }

    /// Writes the name of a constant.
    pub(crate) fn named(&self, name: &str) -> String {
        match self.script {
            Script::Unicode => name.to_owned(),
            Script::Latex => latex_name(name),
        }
    }

    /// Writes a power of a factor.
    pub(crate) fn power(&self, factor: &Factor, exponent: i32) -> String {
        let power = self.exponent(exponent);
        match factor {
            Factor::Constant(index) => self.constant(*index) + &power,
            Factor::Position(joint) => self.variable(*joint, 0) + &power,
            Factor::Rate(joint) => self.variable(*joint, 1) + &power,
            Factor::Acceleration(joint) => self.variable(*joint, 2) + &power,
            Factor::Sine(argument) => self.function("sin", argument, &power),
            Factor::Cosine(argument) => self.function("cos", argument, &power),
        }
    }

    fn function(&self, name: &str, argument: &Argument, power: &str) -> String {
        let mut sum = String::new();
        for (at, (angle, times)) in argument.iter().enumerate() {
            let sign = match (at, times.is_negative()) {
                (0, false) => "",
                (_, true) => "-",
                (_, false) => "+",
            };
            let multiple = if times.abs() == 1 { String::new() } else { times.abs().to_string() };
            sum.extend([sign, &multiple, &self.angle(*angle)]);
        }
        match (self.script, argument.len()) {
            (Script::Unicode, 1) => format!("{name}{power} {sum}"),
            (Script::Unicode, _) => format!("{name}{power}({sum})"),
            (Script::Latex, 1) => format!("\\{name}{power} {sum}"),
            (Script::Latex, _) => format!("\\{name}{power}({sum})"),
        }
    }

    /// Writes an exponent; nothing for 1.
    pub(crate) fn exponent(&self, exponent: i32) -> String {
        match (self.script, exponent) {
            (_, 1) => String::new(),
            (Script::Latex, n) => format!("^{{{n}}}"),
            (Script::Unicode, n) => n
                .to_string()
                .chars()
                .map(|digit| match digit {
                    '-' => '⁻',
                    '1' => '¹',
                    '2' => '²',
                    '3' => '³',
                    digit => digit.to_digit(10).and_then(|n| char::from_u32(0x2070 + n)).unwrap_or(digit),
                })
                .collect(),
        }
    }

    /// Writes the magnitude of a number.
    pub(crate) fn magnitude(&self, number: &Rational) -> String {
        match (spelling(number), self.script) {
            (Spelling::Plain(text), _) => text,
            (Spelling::Fraction(p, q), Script::Unicode) => format!("({p}/{q})"),
            (Spelling::Fraction(p, q), Script::Latex) => format!("\\tfrac{{{p}}}{{{q}}}"),
        }
    }

    /// Returns the separator between factors.
    pub(crate) fn times(&self) -> &'static str {
        match self.script {
            Script::Unicode => " ",
            Script::Latex => r"\,",
        }
    }
}

/// Names of parameters that LaTeX has as Greek letters.
const GREEK: [&str; 22] = [
    "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda", "mu", "nu", "xi",
    "rho", "sigma", "tau", "phi", "chi", "psi", "omega", "pi",
];

/// Largest number of characters of a word in LaTeX, so that several fit on a line.
const LONGEST_WORD: usize = 32;

/// Cuts off a word that is so long that TeX could not measure the line.
fn shortened(word: &str) -> String {
    if word.len() <= LONGEST_WORD {
        return word.to_owned();
    }
    word.chars().take(LONGEST_WORD).chain("\\ldots ".chars()).collect()
}

/// Writes the name of a constant in LaTeX: m1 is m with an index, and longer words stay words, which are cut off if
/// they are much too long. Names consist of letters, digits and underscores, with primes after them.
pub(crate) fn latex_name(name: &str) -> String {
    let primes = name.len() - name.trim_end_matches('\'').len();
    let (name, primes) = name.split_at(name.len() - primes);
    let (head, tail) = name.split_once('_').unwrap_or((name, ""));
    let letters = head.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = head.strip_prefix(letters).unwrap_or("");
    let tail = tail.replace('_', ",");
    let tail = if tail.len() > 1 { format!("\\mathit{{{}}}", shortened(&tail)) } else { tail };
    let index = [shortened(digits), tail].iter().filter(|part| !part.is_empty()).cloned().collect::<Vec<_>>().join(",");
    let letter = match letters {
        greek if GREEK.contains(&greek) => format!("\\{greek}"),
        single if single.len() <= 1 => single.to_owned(),
        word => format!("\\mathit{{{}}}", shortened(word)),
    };
    // a name that begins with an underscore
    let letter = if letter.is_empty() { "\\_".to_owned() } else { letter };
    let index = if index.is_empty() { String::new() } else { format!("_{{{index}}}") };
    format!("{letter}{index}{primes}")
}

/// Writes a text outside mathematics: special characters of LaTeX are escaped, and characters that its fonts may not
/// have are left out.
pub(crate) fn latex_text(text: &str) -> String {
    let mut inert = String::new();
    for c in text.chars() {
        match c {
            // prevents two hyphens from becoming a dash
            '-' => inert.push_str("-{}"),
            '\\' => inert.push_str(r"\textbackslash{}"),
            '^' => inert.push_str(r"\textasciicircum{}"),
            '~' => inert.push_str(r"\textasciitilde{}"),
            '<' => inert.push_str(r"\textless{}"),
            '>' => inert.push_str(r"\textgreater{}"),
            '|' => inert.push_str(r"\textbar{}"),
            '"' => inert.push_str("''"),
            // prevents ligatures with a second quote and with a question or exclamation mark before it
            '`' => inert.push_str("{}`{}"),
            '#' | '$' | '%' | '&' | '_' | '{' | '}' => {
                inert.push('\\');
                inert.push(c);
            }
            c if c.is_ascii_graphic() || c == ' ' => inert.push(c),
            _ => inert.push('?'),
        }
    }
    inert
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_letters_with_indices() {
        for (name, latex) in [
            ("m", "m"),
            ("m1", "m_{1}"),
            ("x_C2", "x_{\\mathit{C2}}"),
            ("I2_xx", "I_{2,\\mathit{xx}}"),
            ("rho", "\\rho"),
            ("upper_arm", "\\mathit{upper}_{\\mathit{arm}}"),
            ("m1'", "m_{1}'"),
            ("_x", "\\__{x}"),
        ] {
            assert_eq!(latex_name(name), latex);
        }
        for long in ["x".repeat(4000), format!("m{}", "1".repeat(4000)), format!("m_{}", "a".repeat(4000))] {
            assert!(latex_name(&long).len() < 100, "{}", latex_name(&long));
        }
    }

    #[test]
    fn texts_stay_texts() {
        assert_eq!(latex_text(r"50% of \input{x}"), r"50\% of \textbackslash{}input\{x\}");
        assert_eq!(latex_text("Möbius $x$"), r"M?bius \$x\$");
        assert_eq!(latex_text("?``"), "?{}`{}{}`{}");
    }
}
