//! Recognises robot descriptions in XML, so that they are not reported as mistakes in YAML.

use crate::text::diagnostic::{Diagnostic, Remedy};

/// Number of bytes at the beginning of a text by which its format is recognised.
const HEAD: usize = 4096;

/// Returns whether a text is URDF or xacro, by its beginning: XML whose root is a `robot`.
///
/// ```
/// assert!(rne_model::is_urdf("<?xml version=\"1.0\"?>\n<robot name=\"arm\">"));
/// assert!(!rne_model::is_urdf("format: 1\nname: arm"));
/// ```
#[must_use]
pub fn is_urdf(text: &str) -> bool {
    let text = text.trim_start_matches('\u{FEFF}').trim_start();
    text.starts_with('<') && head(text).contains("<robot")
}

/// Returns the error for a text that is XML, in most cases URDF; `name` is the name of the file in messages. `None` for
/// a text that may be a robot file, which never begins with such a tag.
pub(crate) fn instead_of_a_robot_file(name: &str, text: &str) -> Option<Diagnostic> {
    let start = text.len() - text.trim_start().len();
    let rest = text.get(start..)?;
    let first_line = rest.lines().next().unwrap_or_default().trim_end();
    let place = start..start + first_line.len();
    if is_urdf(rest) {
        // the namespace alone is no sign of a template: a URDF that xacro has written may still declare it
        let template = ["<xacro:", "${", "$("].iter().any(|mark| head(rest).contains(mark));
        let help = template.then(|| "this is a template: let `xacro` write the URDF first".to_owned());
        let is_a_path = !name.starts_with('<') && !name.contains(char::is_whitespace);
        let remedy = Remedy::ImportUrdf { file: is_a_path.then(|| name.to_owned()) };
        let error = Diagnostic::error(place, "this is URDF, not a robot file").label("XML");
        return Some(error.maybe_help(help).remedy(remedy));
    }
    let is_xml = ["<?xml", "<!--", "<!DOCTYPE", "<mujoco", "<sdf"].iter().any(|tag| rest.starts_with(tag));
    is_xml.then(|| {
        Diagnostic::error(place, "this is XML, not a robot file")
            .label("XML")
            .help("a robot file is a YAML mapping that begins with `format: 1`")
            .remedy(Remedy::ImportUrdf { file: None })
    })
}

/// Returns the beginning of a text.
pub(crate) fn head(text: &str) -> &str {
    let mut end = HEAD.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    text.get(..end).unwrap_or_default()
}
