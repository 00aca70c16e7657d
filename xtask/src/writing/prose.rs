//! Finds patterns of prose that are hard to read.

mod rules;

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use clap::Args;
use regex_lite::Regex;

use rules::{Rule, rules};

use crate::{Verdict, machine};

/// Finds patterns of prose that are hard to read: in documents, helps of rne and first sentences of documentation
///
/// A pattern holds anywhere in a text, or at the beginning of a sentence. The strings of sources are messages, so the
/// former are searched in them, too. Code in documents, and blocks that a program writes, are not searched.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 if there are such patterns.

Examples:
  cargo xtask prose                      all that is checked
  cargo xtask prose docs/control/logs.md         one file")]
pub(crate) struct Prose {
    /// Files to search, from the root of the repository [default: all that is checked]
    paths: Vec<String>,
}

/// Documents that are written by hand. A page is added after it has been rewritten.
const DOCUMENTS: &[&str] = &[
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "README.md",
    "benches/peers/README.md",
    "docs/measured/accuracy.md",
    "docs/firmware/c-library.md",
    "docs/reference/capabilities.md",
    "docs/reference/command-line.md",
    "docs/crate.md",
    "docs/measured/embedded.md",
    "docs/firmware/first-firmware.md",
    "docs/control/fleet.md",
    "docs/reference/function-names.md",
    "docs/reference/functions.md",
    "docs/control/identify.md",
    "docs/teaching/inspection.md",
    "docs/teaching/lecture/README.md",
    "docs/teaching/lecture/errata.md",
    "docs/teaching/lecture/answers.md",
    "docs/teaching/lecture/exercises.md",
    "docs/teaching/lecture/folding.md",
    "docs/teaching/lecture/frames.md",
    "docs/teaching/lecture/one-link.md",
    "docs/teaching/lecture/prismatic.md",
    "docs/teaching/lecture/reduced.md",
    "docs/teaching/lecture/results.md",
    "docs/teaching/lecture/two-links.md",
    "docs/control/logs.md",
    "docs/control/operational-space.md",
    "docs/control/optimal-control.md",
    "docs/control/jax.md",
    "docs/measured/performance.md",
    "docs/control/python.md",
    "docs/teaching/reduced-form.md",
    "docs/reference/robot-file-keys.md",
    "docs/robot-file.md",
    "docs/control/ros2.md",
    "docs/control/run-time.md",
    "docs/teaching/for-teachers.md",
    "docs/control/urdf.md",
    "docs/control/watch.md",
    "robots/README.md",
];

/// Folders of sources whose first sentences of documentation are checked. A crate is added after it has been rewritten.
const SOURCES: &[&str] = &[
    "src",
    "compiler/functions/src",
    "cli/src",
    "compiler/codegen/src",
    "import/src",
    "teaching/diagnose/src",
    "compiler/emit/src",
    "doors/gpu/src",
    "logs/identify/src",
    "teaching/inspection/src",
    "logs/read/src",
    "compiler/machine/src",
    "rne-macro/src",
    "compiler/model/src",
    "teaching/plot/src",
    "teaching/page/src",
    "rne-runtime/src",
    "compiler/search/src",
    "teaching/symbolic/src",
    "logs/watch/src",
    "firmware/certify/src",
    "xtask/src",
];

/// Sources in these folders that contain emitted text, which must not change in any byte. They are not checked.
const EMITTED: &[&str] =
    &["compiler/emit/src/own_tests/rust.rs", "compiler/emit/src/sin_cos_f32.rs", "compiler/emit/src/sin_cos_f64.rs"];

/// Folders of libraries. Their messages must not name options or commands of the command line, because users of Python,
/// C and SQL read them, too.
const LIBRARIES: &[&str] = &[
    "compiler/functions/src",
    "compiler/codegen/src",
    "import/src",
    "teaching/diagnose/src",
    "compiler/emit/src",
    "doors/gpu/src",
    "logs/identify/src",
    "teaching/inspection/src",
    "logs/read/src",
    "compiler/machine/src",
    "compiler/model/src",
    "teaching/plot/src",
    "teaching/page/src",
    "rne-runtime/src",
    "compiler/search/src",
    "teaching/symbolic/src",
    "logs/watch/src",
    "firmware/certify/src",
];

/// Folders of sources whose strings are messages. They are searched for the patterns that are not bound to the
/// beginning of a sentence.
const MESSAGES: &[&str] = &[
    "cli/src",
    "import/src",
    "teaching/diagnose/src",
    "doors/gpu/src",
    "logs/identify/src",
    "logs/read/src",
    "rne-macro/src",
    "compiler/model/src",
    "compiler/search/src",
    "logs/watch/src",
    "firmware/certify/src",
];

/// Folders of sources whose help texts are checked.
const HELPS: &[&str] = &["cli/src"];

/// The text of a paragraph without line breaks, and the positions at which its lines begin.
#[derive(Default)]
struct Paragraph {
    text: String,
    lines: Vec<(usize, usize)>,
}

impl Paragraph {
    fn push(&mut self, number: usize, line: &str) {
        if !self.text.is_empty() {
            self.text.push(' ');
        }
        self.lines.push((self.text.len(), number));
        self.text.push_str(line.trim());
    }

    fn line(&self, at: usize) -> usize {
        self.lines.iter().rev().find(|(start, _)| *start <= at).map_or(0, |(_, number)| *number)
    }
}

/// Returns a text in which code between backticks is replaced by the same number of letters.
fn without_code(text: &str) -> String {
    let parts = text.split('`').enumerate();
    let plain = parts.map(|(index, part)| if index % 2 == 0 { part.to_owned() } else { "x".repeat(part.len()) });
    plain.collect::<Vec<_>>().join("`")
}

/// Returns the paragraphs of a document, including items of lists and cells of tables.
fn of_document(text: &str) -> Vec<Paragraph> {
    let (mut found, mut paragraph) = (Vec::new(), Paragraph::default());
    let (mut is_code, mut is_written) = (false, false);
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        let trimmed = line.trim_start();
        is_written |= trimmed.starts_with("<!-- begin:");
        let ends = trimmed.starts_with("<!-- end");
        let fence = trimmed.starts_with("```");
        let is_text = !(is_code || is_written || fence || ends || trimmed.starts_with("<!--"));
        is_code ^= fence;
        is_written &= !ends;
        let item = ["- ", "* ", "> "].iter().find_map(|mark| trimmed.strip_prefix(mark));
        let begins = !is_text || trimmed.is_empty() || item.is_some() || trimmed.starts_with(['#', '|']);
        if begins && !paragraph.text.is_empty() {
            found.push(std::mem::take(&mut paragraph));
        }
        if !is_text || trimmed.is_empty() || trimmed.starts_with('#') {
            continue;
        }
        if trimmed.starts_with('|') {
            for cell in without_code(trimmed).split('|') {
                let mut of_cell = Paragraph::default();
                of_cell.push(number, cell);
                found.push(of_cell);
            }
        } else {
            paragraph.push(number, item.unwrap_or(trimmed));
        }
    }
    found.push(paragraph);
    found
}

/// Returns the first paragraph of each documentation comment in a source. `is_wanted` selects comments by the line of
/// code below.
fn of_source(text: &str, is_wanted: impl Fn(&str) -> bool) -> Vec<Paragraph> {
    let (mut found, mut paragraph) = (Vec::new(), Paragraph::default());
    let mut is_first = true;
    for (index, line) in text.lines().enumerate() {
        let code = line.trim_start();
        if let Some(words) = ["///", "//!"].iter().find_map(|mark| code.strip_prefix(mark)) {
            is_first &= !words.trim().is_empty();
            if is_first {
                paragraph.push(index + 1, words);
            }
            continue;
        }
        let of_comment = std::mem::take(&mut paragraph);
        if !of_comment.text.is_empty() && is_wanted(code) {
            found.push(of_comment);
        }
        is_first = true;
    }
    found
}

/// Returns the help texts in a source: comments on arguments and commands, and the texts after the options.
fn of_helps(text: &str) -> Vec<Paragraph> {
    let is_help = |below: &str| {
        let derives = ["Args", "Parser", "Subcommand", "ValueEnum"];
        below.starts_with("#[arg")
            || below.starts_with("#[command")
            || below.starts_with("#[derive") && derives.iter().any(|name| below.contains(name))
    };
    let mut found = of_source(text, is_help);
    let mut paragraph = None::<Paragraph>;
    for (index, line) in text.lines().enumerate() {
        if let Some(below) = &mut paragraph {
            let (words, ends) = line.split_once("\")]").map_or((line, false), |(words, _)| (words, true));
            if words.trim().is_empty() {
                found.push(std::mem::take(below));
            } else {
                below.push(index + 1, words);
            }
            if ends {
                found.extend(paragraph.take());
            }
        } else if line.contains("after_help = \"\\") {
            paragraph = Some(Paragraph::default());
        }
    }
    found
}

/// Returns the lines of code without comments; the words that are searched in them are those of strings.
fn of_code(text: &str) -> Vec<Paragraph> {
    let code = text.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//"));
    let paragraph = |(index, line): (usize, &str)| {
        let mut of_line = Paragraph::default();
        of_line.push(index + 1, line);
        of_line
    };
    code.map(paragraph).collect()
}

/// Returns the rules that a paragraph breaks: line, words found, and advice. The rules for the beginning of a sentence
/// do not apply to questions.
fn broken(paragraph: &Paragraph, rules: &[(Regex, &'static Rule)]) -> Vec<(usize, String, &'static str)> {
    let text = without_code(&paragraph.text);
    let is_question =
        |end: usize| text[end..].find(['.', '?', '!']).is_some_and(|at| text[end + at..].starts_with('?'));
    let found = rules.iter().flat_map(|(pattern, rule)| {
        let places = pattern.find_iter(&text).filter(|place| !(rule.begins && is_question(place.end())));
        let of = |place: regex_lite::Match<'_>| (place.start(), place.as_str().to_owned(), rule.instead);
        places.map(of).collect::<Vec<_>>()
    });
    found.map(|(at, words, instead)| (paragraph.line(at), words, instead)).collect()
}

impl Prose {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let rules = rules()?;
        let mut count = 0;
        for path in sources(LIBRARIES)?.iter().filter(|path| self.names(path)) {
            for (line, option) in options(&machine::read(path)?)? {
                println!("{path}:{line}: \"{option}\": say it as data; each door words it");
                count += 1;
            }
        }
        let (_, of_messages): (Vec<_>, Vec<_>) = self::rules()?.into_iter().partition(|(_, rule)| rule.begins);
        let mut tell = |path: &str, paragraphs: Vec<Paragraph>, rules: &[(Regex, &'static Rule)]| {
            for paragraph in &paragraphs {
                for (line, words, instead) in broken(paragraph, rules) {
                    println!("{path}:{line}: \"{}\": {instead}", words.trim_start_matches(['.', ' ', '!', '?', ':']));
                    count += 1;
                }
            }
        };
        for path in DOCUMENTS.iter().filter(|path| self.names(path)) {
            tell(path, of_document(&machine::read(path)?), &rules);
        }
        for (folders, paragraphs) in [(SOURCES, first_sentences as Paragraphs), (HELPS, of_helps)] {
            for path in sources(folders)?.iter().filter(|path| self.names(path)) {
                tell(path, paragraphs(&machine::read(path)?), &rules);
            }
        }
        for path in sources(MESSAGES)?.iter().filter(|path| self.names(path)) {
            tell(path, of_code(&machine::read(path)?), &of_messages);
        }
        if count > 0 {
            println!("prose: {count} patterns");
        }
        Ok(Verdict::from(count == 0))
    }

    fn names(&self, path: &str) -> bool {
        self.paths.is_empty() || self.paths.iter().any(|of| path == of || Path::new(path).starts_with(of))
    }
}

/// Returns the options and commands of the command line that a source names outside of comments, with their lines.
fn options(text: &str) -> Result<Vec<(usize, String)>> {
    let pattern = Regex::new(r#"(?:^|[ "`(])(--[a-z][a-z-]*|`rne [a-z]+)"#)?;
    let code = text.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//"));
    let found = code.flat_map(|(index, line)| {
        let options = pattern.captures_iter(line).filter_map(|found| found.get(1));
        options.map(|option| (index + 1, option.as_str().to_owned())).collect::<Vec<_>>()
    });
    Ok(found.collect())
}

type Paragraphs = fn(&str) -> Vec<Paragraph>;

/// Returns the first sentence of each documentation comment in a source.
fn first_sentences(text: &str) -> Vec<Paragraph> {
    let mut found = of_source(text, |_| true);
    for paragraph in &mut found {
        let end = paragraph.text.find(". ").map_or(paragraph.text.len(), |at| at + 1);
        paragraph.text.truncate(end);
    }
    found
}

/// Returns the Rust files below folders, as paths from the root of the repository.
fn sources(folders: &[&str]) -> Result<Vec<String>> {
    let (mut found, mut open) = (Vec::new(), folders.iter().map(|folder| (*folder).to_owned()).collect::<Vec<_>>());
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(machine::root().join(&folder)).with_context(|| folder.clone())? {
            let entry = entry?;
            let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
            if entry.file_type()?.is_dir() {
                open.push(path);
            } else if Path::new(&path).extension().is_some_and(|extension| extension == "rs")
                && !EMITTED.contains(&path.as_str())
            {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::rules::RULES;
    use super::{Paragraph, broken, first_sentences, of_code, of_document, of_helps, options, rules};

    #[test]
    fn an_option_is_found_in_a_string_and_not_in_a_comment() {
        let text = "/// as `rne log --tip`\nlet x = \"name it with --tip, or\n  `rne log` FILE\"; // --base\n x--y";
        let found = options(text).expect("a pattern");
        assert_eq!(found, [(2, "--tip".to_owned()), (3, "`rne log".to_owned()), (3, "--base".to_owned())]);
    }

    fn found(paragraphs: &[Paragraph]) -> Vec<(usize, String)> {
        let rules = rules().expect("patterns");
        let of = |paragraph| broken(paragraph, &rules).into_iter().map(|(line, words, _)| (line, words));
        paragraphs.iter().flat_map(of).collect()
    }

    #[test]
    fn every_rule_finds_its_example() {
        let rules = rules().expect("patterns");
        assert_eq!(rules.len(), RULES.len());
        for (pattern, rule) in &rules {
            assert!(pattern.is_match(rule.example), "{}: {}", rule.pattern, rule.example);
        }
    }

    #[test]
    fn messages_are_searched_and_comments_are_not() {
        let text = "// it is held still\nformat!(\n    \"the joint {name} \\\n     is held still\"\n)\n";
        let places: Vec<usize> = found(&of_code(text)).into_iter().map(|(line, _)| line).collect();
        assert_eq!(places, [4]);
    }

    #[test]
    fn a_document_is_read_by_paragraphs_items_and_cells() {
        let text = [
            "# Of no heading",
            "",
            "A line that",
            "is good. Of",
            "no log.",
            "",
            "- What it is",
            "",
            "| key | Of a joint |",
            "|---|---|",
            "```text",
            "Of code",
            "```",
            "<!-- begin: x -->",
            "What a program prints",
            "<!-- end -->",
            "so",
            "many `so many`",
            "",
        ];
        let text = &text.join("\n");
        let places: Vec<usize> = found(&of_document(text)).into_iter().map(|(line, _)| line).collect();
        assert_eq!(places, [4, 7, 9, 17]);
        assert_eq!(found(&of_document("The gain of the observer. It is of use. What did it do? Which one?\n")), []);
    }

    #[test]
    fn first_sentences_are_read_of_a_source_and_helps_of_arguments() {
        let text = [
            "//! What it is.",
            "",
            "/// A good one. What follows is free.",
            "///",
            "/// What is below, too.",
            "fn a() {}",
            "",
            "/// The same in",
            "/// other axes.",
            "fn b() {}",
            "    /// None.",
            "    #[arg(long)]",
            "    c: bool,",
        ];
        let text = &text.join("\n");
        let places = |paragraphs: &[Paragraph]| found(paragraphs).into_iter().map(|(line, _)| line).collect::<Vec<_>>();
        assert_eq!(places(&first_sentences(text)), [1, 8, 11]);
        assert_eq!(places(&of_helps(text)), [11]);
        let help = "#[command(after_help = \"\\\nExamples:\n  rne log\n\nWhat is missing is\nsaid.\")]\nstruct A;\n";
        assert_eq!(places(&of_helps(help)), [5, 5]);
    }
}
