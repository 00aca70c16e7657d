//! Writes the document in LaTeX: an article with the common package amsmath, or only its equations, for an article or
//! for slides.

use std::fmt::Write as _;

use crate::ClosedForm;
use crate::document::{Item, sections};
use crate::notation::{Script, latex_text};

/// The kind of LaTeX text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum LatexStyle {
    /// A document that compiles by itself.
    #[default]
    Article,
    /// Only equations, for `\input` into a document with amsmath.
    Body,
    /// A beamer frame for each torque, then a frame for each other section with equations, for `\input`.
    Beamer,
}

/// Width, in columns of a terminal, of formulas that fill a line of the page.
const COLUMNS: usize = 78;

/// Width, in columns of a terminal, of formulas that fill a line of a slide in small letters.
const COLUMNS_OF_SLIDE: usize = 54;

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

pub(crate) fn latex(form: &ClosedForm, title: &str, style: LatexStyle) -> String {
    match style {
        LatexStyle::Article => article(form, title),
        LatexStyle::Body => {
            let mut text = format!("% {}; needs amsmath\n", latex_text(title));
            for section in sections(form, Script::Latex).iter().filter(|section| is_of_equations(&section.items)) {
                let _ = writeln!(text, "\\paragraph{{{}}}", mixed(&section.title));
                content(&mut text, &section.items, COLUMNS);
            }
            text
        }
        LatexStyle::Beamer => {
            let mut text = format!("% {}; frames for beamer\n", latex_text(title));
            for (at, section) in sections(form, Script::Latex).iter().enumerate() {
                // the first section with equations has the torques, a frame for each
                let is_torques = at == usize::from(form.joints() < form.dof) && form.is_closed();
                let parts: Vec<&[Item]> =
                    if is_torques { section.items.chunks(1).collect() } else { vec![section.items.as_slice()] };
                for items in parts {
                    let title = match items {
                        [Item::Formula { left, .. }] if is_torques => format!("Torque, ${left}$"),
                        _ => mixed(&section.title),
                    };
                    frame(&mut text, &title, items);
                }
            }
            text
        }
    }
}

/// Writes a slide with formulas of a section; long formulas continue on another slide.
fn frame(text: &mut String, title: &str, items: &[Item]) {
    if is_of_equations(items) {
        let _ = writeln!(text, "\n\\begin{{frame}}[allowframebreaks]{{{title}}}\n\\small\\allowdisplaybreaks");
        content(text, items, COLUMNS_OF_SLIDE);
        text.push_str("\\end{frame}\n");
    }
}

/// Whether a section has equations or values of letters, and not only words.
fn is_of_equations(items: &[Item]) -> bool {
    items.iter().any(|item| !matches!(item, Item::Words(_)))
}

/// Writes the formulas, words and lists of a section.
fn content(text: &mut String, items: &[Item], columns: usize) {
    let mut rows: Vec<String> = Vec::new();
    for item in items {
        match item {
            Item::Formula { .. } => rows.extend(rows_of(item, columns)),
            Item::Words(words) => {
                aligned(text, &mut rows);
                let _ = writeln!(text, "\n{}\n", mixed(words));
            }
            Item::List(entries) => {
                aligned(text, &mut rows);
                let entry = |(formula, unit): &(String, String)| format!("${formula}$%\n{}", latex_unit(unit));
                let _ = writeln!(text, "{}\n", entries.iter().map(entry).collect::<Vec<_>>().join(",\n"));
            }
        }
    }
    aligned(text, &mut rows);
}

/// Returns the rows of a formula; empty for words.
fn rows_of(item: &Item, columns: usize) -> Vec<String> {
    let Item::Formula { left, width, right } = item else { return Vec::new() };
    let lines = match columns {
        COLUMNS_OF_SLIDE => right.outer_lines(width + 3, 4, columns),
        _ => right.lines(width + 3, 4, columns),
    };
    let lines = lines.into_iter().enumerate();
    lines
        .map(|(at, (_, line))| if at == 0 { format!("  {left} &= {line}") } else { format!("  &\\quad {line}") })
        .collect()
}

fn article(form: &ClosedForm, title: &str) -> String {
    let mut text = HEAD.to_owned();
    let _ = writeln!(text, "\\section*{{{}}}", latex_text(title));
    for section in sections(form, Script::Latex) {
        if !section.title.is_empty() {
            let _ = writeln!(text, "\n\\subsection*{{{}}}", mixed(&section.title));
        }
        content(&mut text, &section.items, COLUMNS);
    }
    text.push_str("\\end{document}\n");
    text
}

/// Writes aligned formulas, one below the other.
fn aligned(text: &mut String, rows: &mut Vec<String>) {
    if !rows.is_empty() {
        let _ = writeln!(text, "\\begin{{align*}}\n{}\n\\end{{align*}}", rows.join(" \\\\\n"));
        rows.clear();
    }
}

/// Writes alternating words and formulas.
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
