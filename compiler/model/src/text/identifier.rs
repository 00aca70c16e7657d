//! Makes identifiers of joints in generated code from the names of a robot file.

use crate::Joint;
use crate::text::diagnostic::{Diagnostic, Problems, Report};
use crate::text::document::Node;
use crate::text::source::quoted;

/// The names of a joint in generated code.
///
/// They are made from the words of the joint's name, which are its runs of ASCII letters and digits. For a name without
/// any, the number of the joint is used, counted from 1.
///
/// ```
/// use rne_model::JointIdentifier;
///
/// for (name, camel_case, upper_case) in [
///     ("lf_haa", "LfHaa", "LF_HAA"),
///     ("LF_HAA", "LfHaa", "LF_HAA"),
///     ("shoulder-pan joint", "ShoulderPanJoint", "SHOULDER_PAN_JOINT"),
///     ("leftKnee", "LeftKnee", "LEFTKNEE"),
///     ("joint_1.0", "Joint1_0", "JOINT_1_0"),
///     ("1", "Joint1", "1"),
///     ("膝", "Joint3", "3"),
/// ] {
///     let (camel_case, upper_case) = (camel_case.to_owned(), upper_case.to_owned());
///     assert_eq!(JointIdentifier::of(name, 2), JointIdentifier { camel_case, upper_case });
/// }
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointIdentifier {
    /// A variant name for a Rust enum, such as `LfHaa`.
    pub camel_case: String,
    /// The end of the name of a C constant, such as `LF_HAA` in `HYQ_JOINT_LF_HAA`; it may begin with a digit.
    pub upper_case: String,
}

impl JointIdentifier {
    /// Makes the identifiers of the joint with this name and this index, from 0.
    #[must_use]
    pub fn of(name: &str, index: usize) -> Self {
        let number = (index + 1).to_string();
        let mut words: Vec<&str> =
            name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
        if words.is_empty() {
            words.push(&number);
        }
        Self { camel_case: camel_case(&words), upper_case: words.join("_").to_ascii_uppercase() }
    }
}

fn camel_case(words: &[&str]) -> String {
    let mut text = String::new();
    for word in words {
        let (first, rest) = word.split_at(1);
        if first.starts_with(is_digit) && text.ends_with(is_digit) {
            text.push('_');
        }
        text += &first.to_ascii_uppercase();
        let is_acronym = !word.contains(|c: char| c.is_ascii_lowercase());
        text += &if is_acronym { rest.to_ascii_lowercase() } else { rest.to_owned() };
    }
    // a variant cannot begin with a digit, and `Self` is a keyword
    if text.starts_with(is_digit) || text == "Self" { format!("Joint{text}") } else { text }
}

fn is_digit(c: char) -> bool {
    c.is_ascii_digit()
}

/// Makes the identifiers of all joints, in their order.
///
/// # Errors
/// When two joints have the same identifier, with the place of the second name.
pub(crate) fn identifiers(
    (name, text): (&str, &str),
    root: &Node,
    joints: &[Joint],
) -> Result<Vec<JointIdentifier>, Report> {
    let items = root.list("joints");
    let (mut known, mut mistakes): (Vec<JointIdentifier>, _) = (Vec::new(), Vec::new());
    for (index, (item, joint)) in items.iter().zip(joints).enumerate() {
        let own = JointIdentifier::of(&joint.name, index);
        let clash = known.iter().enumerate().find_map(|(first, other)| {
            let is_same = other.camel_case == own.camel_case;
            let identifier = if is_same { &own.camel_case } else { &own.upper_case };
            (is_same || other.upper_case == own.upper_case).then_some((first, identifier))
        });
        if let Some((first, identifier)) = clash {
            let message = format!(
                "the names {} of joint {} and {} of joint {} give the same identifier `{identifier}` in generated code",
                quoted(&joints[first].name),
                first + 1,
                quoted(&joint.name),
                index + 1,
            );
            let help = "rename one of the joints; an identifier has only the letters a to z and digits of a name, and \
                        ignores case";
            let span = item.get("name").map_or(item.head(), |name| name.span.clone());
            mistakes.push(Diagnostic::error(span, message).label("identifier taken").help(help));
        }
        known.push(own);
    }
    if mistakes.is_empty() {
        return Ok(known);
    }
    let problems = Problems::new();
    for mistake in mistakes {
        problems.push(mistake);
    }
    Err(problems.finish(name, text))
}
