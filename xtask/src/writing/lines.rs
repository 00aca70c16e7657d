//! Checks that lines have at most 120 columns, in code and in prose.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use clap::Args;
use unicode_width::UnicodeWidthStr;

use crate::Verdict;
use crate::{machine, writing::wrapping};

/// Tells lines of more than 120 columns in *.rs; `--wrap` breaks those of comments and of *.md
///
/// Some lines may be longer, for they cannot be broken or had better not be: in Markdown, tables, blocks of code and
/// lines with an address; in Rust, a word without a blank, rows of a table in a comment, what stands below
/// `#[rustfmt::skip]` up to an empty line, and snapshots.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when there are such lines.

Examples:
  cargo xtask lines                      the whole repository
  cargo xtask lines docs README.md       some folders and files of it
  cargo xtask lines --wrap docs          wrap comments and prose anew where a line is too long")]
pub(crate) struct Lines {
    /// Folders and files, from the root of the repository
    #[arg(default_value = ".", hide_default_value = true)]
    paths: Vec<String>,
    /// Wrap the comments and paragraphs that have such lines; strings and code stay
    #[arg(long)]
    wrap: bool,
}

/// The largest width, as in rustfmt.toml.
const COLUMNS: usize = 120;

impl Lines {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let mut found = Vec::new();
        for path in &self.paths {
            self.walk(&machine::root().join(path), &mut found)?;
        }
        found.sort();
        for line in &found {
            println!("{line}");
        }
        if !found.is_empty() {
            println!("lines: {} of more than {COLUMNS} columns", found.len());
        }
        Ok(Verdict::from(found.is_empty()))
    }

    /// Finds long lines of a file, or of the files below a folder, with their places. With --wrap it breaks them first.
    fn walk(&self, path: &Path, found: &mut Vec<String>) -> Result<()> {
        if path.is_dir() {
            let name = path.file_name().unwrap_or_default();
            if name == "target" || name == ".git" {
                return Ok(());
            }
            for entry in fs::read_dir(path).with_context(|| path.display().to_string())? {
                self.walk(&entry?.path(), found)?;
            }
            return Ok(());
        }
        let (long, wrapped): (Long, Wrapped) = match path.extension().and_then(|extension| extension.to_str()) {
            Some("rs") => (long_in_rust, wrapping::wrapped_comments),
            Some("md") => (long_in_markdown, wrapping::wrapped_markdown),
            _ => return Ok(()),
        };
        let mut text = fs::read_to_string(path).with_context(|| path.display().to_string())?;
        if self.wrap && !long(&text).is_empty() {
            text = wrapped(&text, COLUMNS);
            fs::write(path, &text).with_context(|| path.display().to_string())?;
        }
        // remaining long lines of a document are allowed: formulas and tables may be wider
        if path.extension().is_some_and(|extension| extension == "md") {
            return Ok(());
        }
        let shown = path.strip_prefix(machine::root()).unwrap_or(path).display();
        found.extend(long(&text).into_iter().map(|(line, width)| format!("{shown}:{line}: {width} columns")));
        Ok(())
    }
}

type Long = fn(&str) -> Vec<(usize, usize)>;
type Wrapped = fn(&str, usize) -> String;

/// Returns the numbers and widths of the lines that are too long.
fn long(text: &str, mut may_be: impl FnMut(&str) -> bool) -> Vec<(usize, usize)> {
    let lines = text.lines().enumerate().map(|(index, line)| (index + 1, line, line.width()));
    lines
        .filter(|(_, line, width)| !may_be(line) && *width > COLUMNS)
        .map(|(number, _, width)| (number, width))
        .collect()
}

fn long_in_rust(text: &str) -> Vec<(usize, usize)> {
    let (mut is_table, mut is_snapshot) = (false, false);
    long(text, |line| {
        let code = line.trim_start();
        is_snapshot &= !code.starts_with('"');
        is_snapshot |= line.ends_with("@r\"") || line.ends_with("@r#\"");
        is_table |= code == "#[rustfmt::skip]";
        is_table &= !code.is_empty();
        let text = code.trim_start_matches(['/', '!']).trim_start();
        // a row of a table, or a single word
        is_table || is_snapshot || text.starts_with('|') || !text.trim_end().contains(' ')
    })
}

fn long_in_markdown(text: &str) -> Vec<(usize, usize)> {
    let mut is_code = false;
    long(text, |line| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        is_fence || is_code || line.trim_start().starts_with('|') || line.contains("://")
    })
}

#[cfg(test)]
mod tests {
    use super::{long_in_markdown, long_in_rust};

    #[test]
    fn what_can_be_broken_must_be() {
        let words = "word ".repeat(25);
        let line = words.trim_end();
        assert_eq!(long_in_rust(&format!("// short\n// {line}\n")), [(2, 127)]);
        assert_eq!(long_in_rust(&format!("{}\n", "ω̇".repeat(120))), []);
        assert_eq!(long_in_rust(&format!("/// | a | {line} |\n/// {}\n", "x".repeat(130))), []);
        let table = format!("#[rustfmt::skip]\nfn rows() {{\n{line}\n}}\n\n{line}\n");
        assert_eq!(long_in_rust(&table), [(6, 124)]);
        let snapshot = format!("snapshot!(text, @r\"\n{line}\n\n{line}\n\");\n// {line}\n");
        assert_eq!(long_in_rust(&snapshot), [(6, 127)]);
        let page = format!("{line}\n| {line} |\n```text\n{line}\n```\n{line}\nsee https://example.org {line}\n");
        assert_eq!(long_in_markdown(&page), [(1, 124), (6, 124)]);
    }
}
