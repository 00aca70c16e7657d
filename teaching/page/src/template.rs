//! Fills the gaps of a page, and escapes the texts in it.

use std::fmt::Write as _;

use serde_json::Value;

/// Returns the template with every `{{name}}` replaced, in one pass: inserted text is not searched for gaps.
pub(crate) fn filled(template: &str, parts: &[(&str, String)]) -> String {
    let mut page = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        page.push_str(before);
        let part = after.split_once("}}").and_then(|(name, behind)| {
            let (_, text) = parts.iter().find(|(known, _)| *known == name)?;
            Some((text, behind))
        });
        if let Some((text, behind)) = part {
            page.push_str(text);
            rest = behind;
        } else {
            page.push_str("{{");
            rest = after;
        }
    }
    page + rest
}

/// Escapes a text for the content of an element, or for an attribute in quotes.
pub(crate) fn text(text: &str) -> String {
    let mut inert = String::new();
    for c in text.chars() {
        match c {
            '&' => inert.push_str("&amp;"),
            '<' => inert.push_str("&lt;"),
            '>' => inert.push_str("&gt;"),
            '"' => inert.push_str("&quot;"),
            '\'' => inert.push_str("&#39;"),
            c => inert.push(c),
        }
    }
    inert
}

/// Writes JSON for the content of a `script` element: the characters of `</script>`, `<!--` and of HTML entities are
/// escaped. In JSON, they occur only inside strings.
pub(crate) fn json(mut value: Value) -> String {
    without_fractions(&mut value);
    let mut inert = String::new();
    for c in value.to_string().chars() {
        match c {
            '<' | '>' | '&' | '\u{2028}' | '\u{2029}' => {
                let _ = write!(inert, "\\u{:04x}", u32::from(c));
            }
            c => inert.push(c),
        }
    }
    inert
}

/// Removes the `.0` of whole numbers, which JavaScript does not need, except for a negative zero.
fn without_fractions(value: &mut Value) {
    const LARGEST: f64 = 1e9;
    match value {
        Value::Number(number) => {
            let whole = number.as_f64().filter(|x| number.is_f64() && x.fract() == 0.0 && x.abs() <= LARGEST);
            if let Some(whole) = whole.filter(|x| *x != 0.0 || x.is_sign_positive()) {
                #[allow(clippy::cast_possible_truncation)] // it is whole and small
                let whole = whole as i64;
                *value = whole.into();
            }
        }
        Value::Array(values) => values.iter_mut().for_each(without_fractions),
        Value::Object(values) => values.values_mut().for_each(without_fractions),
        _ => {}
    }
}

/// Returns a source of the page without indentation and without lines that are only comments, which would be a tenth of
/// a page. A string in a script must not extend over several lines.
pub(crate) fn code(script: &str) -> String {
    let mut code = String::new();
    let mut is_inside = false;
    for line in script.lines() {
        let text = line.trim();
        is_inside |= text.starts_with("/*");
        if !is_inside && !text.is_empty() && !text.starts_with("//") {
            code.push_str(text);
            code.push('\n');
        }
        is_inside &= !text.ends_with("*/");
    }
    code
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_put_in_is_not_searched_for_gaps() {
        let parts = [("a", "{{b}}".to_owned()), ("b", "B".to_owned())];
        assert_eq!(filled("{{a}} {{b}} {{c}} {{", &parts), "{{b}} B {{c}} {{");
    }

    #[test]
    fn lines_of_comments_are_left_out_alone() {
        let script = "// a\nconst a = 1; // b\n/** c */\n/**\n * d\n */\n  // e\nconst of = \"// f\";\n";
        assert_eq!(code(script), "const a = 1; // b\nconst of = \"// f\";\n");
        assert_eq!(code("f(\n  a,\n);\n\n"), "f(\na,\n);\n");
    }

    #[test]
    fn no_text_of_a_script_goes_over_lines() {
        for (name, script) in crate::SCRIPTS {
            for line in code(script).lines() {
                assert!(line.matches('`').count() % 2 == 0, "{name}: {line}");
            }
        }
    }

    #[test]
    fn json_ends_no_script_and_says_the_same() {
        let value = serde_json::json!({ "</script><!--&amp;": "\u{2028}]]>" });
        let inert = json(value.clone());
        assert!(!inert.contains(['<', '>', '&', '\u{2028}']), "{inert}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&inert).ok(), Some(value));
    }

    #[test]
    fn text_stays_text_in_quotes_too() {
        assert_eq!(text("<b title='\"'>&"), "&lt;b title=&#39;&quot;&#39;&gt;&amp;");
    }
}
