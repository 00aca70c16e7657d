//! Tables of figures: writes them to the document, reads them from the committed one, and compares them.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::image::Figures;

/// Largest relative growth of a figure that is accepted.
const TOLERANCE: f64 = 0.02;

/// A section of the document.
pub(crate) struct Table {
    /// The heading.
    pub(crate) title: &'static str,
    /// Text about the table.
    pub(crate) about: String,
    /// The compiler that compiled the code.
    pub(crate) compiler: String,
    /// Heading of the first column: robot or function.
    pub(crate) of: &'static str,
    /// The rows.
    pub(crate) rows: Vec<Row>,
}

/// The figures of a function.
pub(crate) struct Row {
    /// Name of the robot or function.
    pub(crate) name: String,
    /// The form of the code.
    pub(crate) form: String,
    /// The cost of the function.
    pub(crate) figures: Figures,
    /// The difference of the results from those of the host, in words.
    pub(crate) results: String,
}

/// The figures of a committed document, by section, name and form, and the compiler of each section.
#[derive(Default)]
pub(crate) struct Baseline {
    compilers: BTreeMap<String, String>,
    figures: BTreeMap<(String, String, String), Figures>,
}

impl Table {
    /// Returns the section in Markdown, with the rows for which `is_shown` is true.
    pub(crate) fn markdown(&self, is_shown: impl Fn(&Row) -> bool) -> String {
        let mut text = format!("## {}\n\n{}\n\nCompiler: {}\n\n", self.title, self.about, self.compiler);
        let _ = writeln!(
            text,
            "| {} | form | instructions | code, bytes | constants, bytes | stack, bytes | results |",
            self.of
        );
        text.push_str("|---|---|---:|---:|---:|---:|---|\n");
        for Row { name, form, figures, results } in self.rows.iter().filter(|row| is_shown(row)) {
            let Figures { instructions, code, constants, stack } = figures;
            let _ = writeln!(text, "| {name} | {form} | {instructions} | {code} | {constants} | {stack} | {results} |");
        }
        text
    }

    /// Describes the figures that have grown by more than the tolerance since the baseline; empty if the baseline is of
    /// another compiler.
    pub(crate) fn growth(&self, baseline: &Baseline) -> Vec<String> {
        if baseline.compilers.get(self.title) != Some(&self.compiler) {
            return Vec::new();
        }
        let mut found = Vec::new();
        for Row { name, form, figures, .. } in &self.rows {
            let key = (self.title.to_owned(), name.clone(), form.clone());
            let Some(before) = baseline.figures.get(&key) else { continue };
            let size = |figures: &Figures| figures.code + figures.constants;
            let pairs = [
                ("instructions", before.instructions, figures.instructions),
                ("bytes of code and constants", size(before), size(figures)),
                ("bytes of stack", before.stack, figures.stack),
            ];
            for (what, before, now) in pairs {
                #[allow(clippy::cast_precision_loss)]
                if now as f64 > before as f64 * (1.0 + TOLERANCE) {
                    found.push(format!("{}: {name} {form}: {now} {what}, {before} before", self.title));
                }
            }
        }
        found
    }

    /// Whether the baseline is of another compiler.
    pub(crate) fn is_of_another_compiler(&self, baseline: &Baseline) -> bool {
        baseline.compilers.get(self.title).is_some_and(|compiler| *compiler != self.compiler)
    }
}

impl Baseline {
    /// Reads the tables of a document.
    pub(crate) fn read(document: &str) -> Self {
        let mut baseline = Self::default();
        let mut title = "";
        for line in document.lines() {
            if let Some(heading) = line.strip_prefix("## ") {
                title = heading;
            } else if let Some(compiler) = line.strip_prefix("Compiler: ") {
                baseline.compilers.insert(title.to_owned(), compiler.to_owned());
            } else if let [_, name, form, figures @ ..] = line.split('|').map(str::trim).collect::<Vec<_>>().as_slice()
                && let [instructions, code, constants, stack, ..] = figures
                && let [Ok(instructions), Ok(code), Ok(constants), Ok(stack)] =
                    [instructions, code, constants, stack].map(|figure| figure.parse())
            {
                let key = (title.to_owned(), (*name).to_owned(), (*form).to_owned());
                baseline.figures.insert(key, Figures { instructions, code, constants, stack });
            }
        }
        baseline
    }
}

#[cfg(test)]
mod tests {
    use super::{Baseline, Row, Table};
    use crate::image::Figures;

    fn table(compiler: &str, instructions: u64) -> Table {
        let figures = Figures { instructions, code: 400, constants: 20, stack: 64 };
        let row = Row { name: "arm".into(), form: "reduced".into(), figures, results: "identical".into() };
        Table { title: "T", about: "About.".into(), compiler: compiler.into(), of: "robot", rows: vec![row] }
    }

    #[test]
    fn growth_is_found_in_what_was_written() {
        let baseline = Baseline::read(&table("rustc 1", 100).markdown(|_| true));
        assert_eq!(table("rustc 1", 102).growth(&baseline), Vec::<String>::new());
        assert_eq!(table("rustc 1", 103).growth(&baseline), ["T: arm reduced: 103 instructions, 100 before"]);
        assert!(!table("rustc 1", 100).is_of_another_compiler(&baseline));
    }

    #[test]
    fn another_compiler_is_not_compared() {
        let baseline = Baseline::read(&table("rustc 1", 100).markdown(|_| true));
        assert!(table("rustc 2", 200).growth(&baseline).is_empty());
        assert!(table("rustc 2", 200).is_of_another_compiler(&baseline));
    }
}
