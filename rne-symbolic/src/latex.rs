//! The document in LaTeX: an article with amsmath, which every TeX has.

use std::fmt::Write as _;

use crate::ClosedForm;
use crate::document::{Item, sections};
use crate::notation::{Script, latex_text};

/// Columns of a terminal whose formulas fill a line of the page.
const COLUMNS: usize = 78;

const HEAD: &str = r"\documentclass{article}
\usepackage{amsmath}
\setlength{\textwidth}{17cm}
\setlength{\oddsidemargin}{-0.6cm}
\setlength{\textheight}{24cm}
\setlength{\topmargin}{-2cm}
\setlength{\parindent}{0pt}
\allowdisplaybreaks
\begin{document}
";

pub(crate) fn latex(form: &ClosedForm, title: &str) -> String {
    let mut text = HEAD.to_owned();
    let _ = writeln!(text, "\\section*{{{}}}", latex_text(title));
    for section in sections(form, Script::Latex) {
        if !section.title.is_empty() {
            let _ = writeln!(text, "\n\\subsection*{{{}}}", mixed(&section.title));
        }
        let mut rows: Vec<String> = Vec::new();
        for item in section.items {
            match item {
                Item::Formula { left, width, right } => {
                    for (at, (_, line)) in right.lines(width + 3, 4, COLUMNS).into_iter().enumerate() {
                        rows.push(match at {
                            0 => format!("  {left} &= {line}"),
                            _ => format!("  &\\quad {line}"),
                        });
                    }
                }
                Item::Words(words) => {
                    aligned(&mut text, &mut rows);
                    let _ = writeln!(text, "\n{}\n", mixed(&words));
                }
                Item::List(entries) => {
                    aligned(&mut text, &mut rows);
                    let entry = |(formula, unit): &(String, String)| format!("${formula}$%\n{}", latex_unit(unit));
                    let _ = writeln!(text, "{}\n", entries.iter().map(entry).collect::<Vec<_>>().join(",\n"));
                }
            }
        }
        aligned(&mut text, &mut rows);
    }
    text.push_str("\\end{document}\n");
    text
}

/// Formulas below one another.
fn aligned(text: &mut String, rows: &mut Vec<String>) {
    if !rows.is_empty() {
        let _ = writeln!(text, "\\begin{{align*}}\n{}\n\\end{{align*}}", rows.join(" \\\\\n"));
        rows.clear();
    }
}

/// Words and formulas in turns.
fn mixed(parts: &[String]) -> String {
    let part = |(at, part): (usize, &String)| match at % 2 {
        0 => latex_text(part),
        _ if part.is_empty() => String::new(),
        _ => format!("${part}$"),
    };
    parts.iter().enumerate().map(part).collect()
}

fn latex_unit(unit: &str) -> String {
    let unit = unit.replace('²', "$^2$").replace(' ', "\\,");
    if unit.is_empty() { unit } else { format!("\\,{unit}") }
}
