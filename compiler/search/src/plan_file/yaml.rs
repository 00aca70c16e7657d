//! Names, numbers, lists and mappings as YAML, in the layout that plan files have.

use std::fmt::Write;

/// A value of a plan file.
#[derive(Debug)]
pub(super) enum Value {
    /// A text of one line that is written without quotes.
    Plain(String),
    /// A text, which is quoted where YAML needs it.
    Text(String),
    List(Vec<Value>),
    Mapping(Vec<(&'static str, Value)>),
}

impl Value {
    /// Writes a number with all digits that it needs to be read back.
    pub(super) fn number(value: f64) -> Self {
        let magnitude = value.abs();
        Self::Plain(match value {
            _ if value.is_nan() => ".nan".to_owned(),
            _ if value == f64::INFINITY => ".inf".to_owned(),
            _ if value == f64::NEG_INFINITY => "-.inf".to_owned(),
            _ if magnitude != 0.0 && !(1e-5..1e16).contains(&magnitude) => format!("{value:e}"),
            _ if value.trunc() == value => format!("{value}.0"),
            _ => value.to_string(),
        })
    }

    /// The value as a document.
    pub(super) fn document(&self) -> String {
        let mut out = String::new();
        self.block(0, &mut out);
        out
    }

    /// Writes a mapping or a list in lines of its own; the first line begins where `out` ends, the others after
    /// `indent` blanks.
    fn block(&self, indent: usize, out: &mut String) {
        let margin = " ".repeat(indent);
        match self {
            Self::Mapping(entries) => {
                for (index, (key, value)) in entries.iter().enumerate() {
                    let margin = if index == 0 { "" } else { &margin };
                    let _ = write!(out, "{margin}{key}:");
                    match value {
                        Self::Mapping(entries) if !entries.is_empty() => {
                            let _ = write!(out, "\n{:1$}", "", indent + 2);
                            value.block(indent + 2, out);
                        }
                        Self::List(items) if !items.is_empty() => {
                            let _ = write!(out, "\n{:1$}", "", indent);
                            value.block(indent, out);
                        }
                        _ => value.line(indent + 2, out),
                    }
                }
            }
            Self::List(items) => {
                for (index, item) in items.iter().enumerate() {
                    let margin = if index == 0 { "" } else { &margin };
                    let _ = write!(out, "{margin}-");
                    match item {
                        Self::Mapping(entries) if !entries.is_empty() => {
                            out.push(' ');
                            item.block(indent + 2, out);
                        }
                        _ => item.line(indent + 2, out),
                    }
                }
            }
            Self::Plain(_) | Self::Text(_) => self.line(indent, out),
        }
    }

    /// Writes a value after its key or dash, to the end of the line; further lines are indented by `indent` blanks.
    fn line(&self, indent: usize, out: &mut String) {
        match self {
            Self::Plain(text) => {
                let _ = writeln!(out, " {text}");
            }
            Self::Text(text) => {
                let _ = writeln!(out, " {}", scalar(text, indent));
            }
            Self::List(_) => out.push_str(" []\n"),
            Self::Mapping(_) => out.push_str(" {}\n"),
        }
    }
}

/// Returns a text as YAML: without quotes if it can mean nothing else, as a block if it consists of lines, else in
/// quotation marks.
fn scalar(text: &str, indent: usize) -> String {
    let is_line = |line: &str| !line.is_empty() && !line.starts_with(' ') && is_visible(line);
    if let Some(lines) = text.strip_suffix('\n').filter(|lines| lines.split('\n').all(is_line)) {
        let margin = format!("\n{:1$}", "", indent);
        return format!("|{margin}{}", lines.replace('\n', &margin));
    }
    let is_word = text.starts_with(|c: char| c.is_ascii_alphanumeric())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let is_number =
        text.len() > 1 && text.chars().all(|c| c.is_ascii_digit()) || text.parse().is_ok_and(f64::is_finite);
    if is_word && !is_number && !matches!(text, "null" | "true" | "false") {
        return text.to_owned();
    }
    if is_visible(text) {
        return format!("'{}'", text.replace('\'', "''"));
    }
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            ' '..='~' => quoted.push(c),
            _ => {
                let _ = write!(quoted, "\\U{:08X}", u32::from(c));
            }
        }
    }
    quoted.push('"');
    quoted
}

/// Whether every character is a visible ASCII character.
fn is_visible(text: &str) -> bool {
    text.chars().all(|c| matches!(c, ' '..='~')) && !text.ends_with(' ')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> String {
        Value::Mapping(vec![("key", Value::Text(text.to_owned()))]).document()
    }

    /// The value of the key `key` as serde reads it.
    fn read(document: &str) -> serde_yaml::Value {
        let value: serde_yaml::Value = serde_yaml::from_str(document).unwrap_or_else(|e| panic!("{e}: {document:?}"));
        value["key"].clone()
    }

    #[test]
    fn numbers_are_written_as_serde_writes_them() {
        let mut rng = fastrand::Rng::with_seed(3);
        // two digits, as accuracies have: of two shortest forms of one length serde may take the other
        let accuracies = (0..2000).map(|_| {
            let value = rng.f64() * 10_f64.powi(rng.i32(-20..20));
            format!("{value:.1e}").parse().unwrap_or(value)
        });
        let special = [0.0, -0.0, 1.0, 1e-5, 9.9e-6, 1e15, 1e16, f64::MAX, f64::MIN_POSITIVE, f64::INFINITY, f64::NAN];
        for value in accuracies.chain(special) {
            let Value::Plain(written) = Value::number(value) else { panic!("a number is plain") };
            assert_eq!(format!("{written}\n"), serde_yaml::to_string(&value).unwrap());
        }
    }

    #[test]
    fn texts_are_read_as_they_were() {
        let fingerprints = ["a775c97f9150e34b", "1234567890123456", "12e4567890123456", "0000000000000001", "1e5"];
        let words = ["ur5", "null", "true", "false", "no", "inf", "nan", "h2_x", "", " ", "a b", "it's", "- x", "#"];
        let lines = [
            "constants 2.0\noperations k1*qd1\n-1*1\nresults -1\n",
            "a\n\nb\n",
            "a",
            "a\nb",
            "a\n\n",
            " a\n",
            "a \n",
            "a\tb\n",
            "\n",
            "ü\n",
        ];
        let odd = ["\u{7}", "\u{85}", "\u{2028}", "\u{FEFF}a", "\"\\", "a: b", "a #b", "[", "\u{1F600}"];
        for one in fingerprints.into_iter().chain(words).chain(lines).chain(odd) {
            let document = text(one);
            assert_eq!(read(&document), serde_yaml::Value::from(one), "{document}");
        }
        for &one in fingerprints.iter().chain(&words[..8]).chain(&lines[..1]) {
            let value = serde_yaml::to_string(&std::collections::BTreeMap::from([("key", one)])).unwrap();
            assert_eq!(text(one), value, "as serde writes it");
        }
    }
}
