//! Wraps paragraphs of Markdown and of comments again if they have a line that is too long.

use textwrap::{Options, WordSeparator, WordSplitter, WrapAlgorithm, wrap};
use unicode_width::UnicodeWidthStr;

/// A character for a blank at which a line must not end. It is in a private-use area and has the width of a blank.
const GLUE: char = '\u{E000}';

/// Wraps the comments of a Rust file. Code is not changed.
pub(crate) fn wrapped_comments(text: &str, columns: usize) -> String {
    let mut wrapped = String::new();
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let Some(marker) = marker(line) else {
            push(&mut wrapped, line);
            continue;
        };
        let mut bodies = vec![body(line, marker)];
        while let Some(next) = lines.next_if(|next| self::marker(next) == Some(marker)) {
            bodies.push(body(next, marker));
        }
        for body in paragraphs(&bodies, columns - marker.width() - 1) {
            push(&mut wrapped, format!("{marker} {body}").trim_end());
        }
    }
    wrapped
}

/// Wraps a file of Markdown. Lines between `<!-- begin: … -->` and `<!-- end -->` are not changed.
pub(crate) fn wrapped_markdown(text: &str, columns: usize) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let mut wrapped = String::new();
    for line in paragraphs(&lines, columns) {
        push(&mut wrapped, &line);
    }
    wrapped
}

fn push(text: &mut String, line: &str) {
    text.push_str(line);
    text.push('\n');
}

/// Returns the indentation and the slashes of a line that contains only a comment; `None` for other lines.
fn marker(line: &str) -> Option<&str> {
    let start = line.len() - line.trim_start().len();
    let slashes = ["///", "//!", "//"].into_iter().find(|slashes| line[start..].starts_with(slashes))?;
    let end = start + slashes.len();
    (line.len() == end || line[end..].starts_with(' ')).then_some(&line[..end])
}

fn body<'a>(line: &'a str, marker: &str) -> &'a str {
    let rest = &line[marker.len()..];
    rest.strip_prefix(' ').unwrap_or(rest)
}

/// Returns the lines, in which paragraphs with a line that is too long are wrapped again.
fn paragraphs(lines: &[&str], columns: usize) -> Vec<String> {
    let mut wrapped = Vec::new();
    let mut kept = Kept::default();
    let mut rest = lines;
    while let Some((first, after)) = rest.split_first() {
        rest = after;
        if kept.has(first) {
            wrapped.push((*first).to_owned());
            continue;
        }
        let count = rest.iter().take_while(|line| continues(line)).count();
        let (more, after) = rest.split_at(count);
        rest = after;
        let is_long = |line: &&str| line.width() > columns;
        if is_long(first) || more.iter().any(is_long) {
            wrapped.extend(paragraph(first, more, columns));
        } else {
            wrapped.extend([first].into_iter().chain(more).map(|line| (*line).to_owned()));
        }
    }
    wrapped
}

/// The state that decides which lines are not prose and must not be wrapped.
#[derive(Default)]
struct Kept {
    is_code: bool,
    is_generated: bool,
}

impl Kept {
    fn has(&mut self, line: &str) -> bool {
        let text = line.trim_start();
        if text.starts_with("```") {
            self.is_code = !self.is_code;
            return true;
        }
        self.is_generated |= text.starts_with("<!-- begin");
        self.is_generated &= !text.starts_with("<!-- end");
        self.is_code || self.is_generated || stands_alone(line)
    }
}

/// Whether a line belongs to no paragraph: empty lines, headings, rows of tables, HTML, indented code, definitions of
/// links.
fn stands_alone(line: &str) -> bool {
    let text = line.trim_start();
    let indent = line.len() - text.len();
    text.is_empty()
        || indent >= 4
        || ["#", "|", "<", "[", "```"].iter().any(|start| {
            text.starts_with(start) && {
                // a line that begins with a link may be prose; one that defines a link is not
                *start != "[" || text.contains("]: ")
            }
        })
}

/// Whether a line continues the paragraph before it.
fn continues(line: &str) -> bool {
    !stands_alone(line) && item(line.trim_start()).is_none()
}

/// Returns the length of the mark at the beginning of a list item; `None` if the text is no list item.
fn item(text: &str) -> Option<usize> {
    let word = text.split(' ').next()?;
    let number = word.strip_suffix('.').is_some_and(|number| number.parse::<u32>().is_ok());
    (number || ["-", "*", ">"].contains(&word)).then_some(word.len() + 1)
}

fn paragraph(first: &str, more: &[&str], columns: usize) -> Vec<String> {
    let indent = first.len() - first.trim_start().len();
    let of_item = item(first.trim_start()).unwrap_or_default();
    let (head, start) = first.split_at(indent + of_item);
    let following = more.first().map_or(indent + of_item, |line| line.len() - line.trim_start().len());
    let words = [start].into_iter().chain(more.iter().copied()).flat_map(str::split_whitespace);
    let text = glued(&words.collect::<Vec<_>>());
    let indents = (head.to_owned(), " ".repeat(following));
    let options = Options::new(columns)
        .initial_indent(&indents.0)
        .subsequent_indent(&indents.1)
        .break_words(false)
        .word_separator(WordSeparator::AsciiSpace)
        .word_splitter(WordSplitter::NoHyphenation)
        .wrap_algorithm(WrapAlgorithm::FirstFit);
    wrap(&text, options).into_iter().map(|line| line.replace(GLUE, " ")).collect()
}

/// Joins words by blanks. Where the next word must not begin a line, or short code would be split, it uses [`GLUE`]
/// instead.
fn glued(words: &[&str]) -> String {
    const CODE: usize = 40;
    let mut text = String::new();
    // the position at which code began that has not ended yet
    let mut code: Option<usize> = None;
    for (index, word) in words.iter().enumerate() {
        if index > 0 {
            let is_mark = item(word).is_some() || ["+", "=", "|", "#", "<"].iter().any(|mark| word.starts_with(mark));
            text.push(if is_mark { GLUE } else { ' ' });
        }
        let start = text.len();
        text.push_str(word);
        if word.matches('`').count() % 2 == 1 {
            match code.take() {
                None => code = Some(start),
                Some(begin) if text[begin..].width() <= CODE => {
                    let joined = text[begin..].replace(' ', &GLUE.to_string());
                    text.replace_range(begin.., &joined);
                }
                Some(_) => {}
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{wrapped_comments, wrapped_markdown};

    #[test]
    fn a_paragraph_that_is_too_wide_is_wrapped_and_others_are_not() {
        let rest = "\n    indented as code it is\n| a | table | that is wide |\n";
        let text = &format!("short\nlines\n\none two three four five\nsix\n{rest}");
        let expected = &format!("short\nlines\n\none two three\nfour five six\n{rest}");
        assert_eq!(wrapped_markdown(text, 14), *expected);
        assert_eq!(wrapped_markdown(expected, 14), *expected);
        let kept = "```text\none two three four five\n```\n<!-- begin: x -->\none two three four five\n<!-- end -->\n";
        assert_eq!(wrapped_markdown(kept, 14), kept);
    }

    #[test]
    fn items_keep_their_indentation() {
        let text = "- one two three four\n- five\n  six\n1. seven eight nine ten\n";
        assert_eq!(wrapped_markdown(text, 14), "- one two\n  three four\n- five\n  six\n1. seven eight\n   nine ten\n");
    }

    #[test]
    fn no_line_begins_with_a_mark_and_short_code_stays_together() {
        assert_eq!(wrapped_markdown("abcdef abcdef - x yz\n", 14), "abcdef\nabcdef - x yz\n");
        assert_eq!(wrapped_markdown("abcdefgh `a b c` d e\n", 14), "abcdefgh\n`a b c` d e\n");
    }

    #[test]
    fn comments_keep_their_slashes_and_code_is_not_touched() {
        let rest = "    ///\n    /// - seven\n    let x = \"one two three four five\";\n}\n";
        let text = format!("fn main() {{\n    /// one two three four five\n    /// six\n{rest}");
        let expected = format!("fn main() {{\n    /// one two three\n    /// four five six\n{rest}");
        assert_eq!(wrapped_comments(&text, 22), expected);
        let rule = "//------------------------------\n#!/shebang of many many words\n";
        assert_eq!(wrapped_comments(rule, 14), rule);
    }
}
