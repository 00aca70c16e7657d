//! Makes texts of a robot file harmless in emitted text. A title or the name of a joint may contain any characters; in
//! the documentation and in the comments of code they must remain plain words. There is one function for each language,
//! except for the terminal, whose function is in the command line's crate.

use rne_model::{Robot, one_line};

/// Returns the name of a robot for a heading: its title, or its name if it has no title.
#[must_use]
pub fn title(robot: &Robot) -> String {
    let title = robot.title.as_deref().map(one_line).filter(|title| !title.trim().is_empty());
    title.unwrap_or_else(|| one_line(&robot.name)).trim().to_owned()
}

/// Escapes text for a paragraph of Markdown, the language of Rust's documentation, so that it contains no code that
/// `cargo test` would run, no HTML that a page would execute, and no link.
#[must_use]
pub fn markdown(text: &str) -> String {
    let line = one_line(text);
    let characters: Vec<char> = line.trim().chars().collect();
    // `1.` and `1)` begin a list
    let digits = characters.iter().take_while(|c| c.is_ascii_digit()).count();
    let mut escaped = String::new();
    for (at, &c) in characters.iter().enumerate() {
        let begins_a_block = match c {
            '#' | '+' | '-' | '=' | ':' => at == 0,
            '.' | ')' => at > 0 && at == digits,
            _ => false,
        };
        let is_inside_a_word = || {
            let neighbours = [at.checked_sub(1), at.checked_add(1)].map(|at| at.and_then(|at| characters.get(at)));
            neighbours.into_iter().all(|neighbour| neighbour.is_some_and(char::is_ascii_alphanumeric))
        };
        let is_markup = match c {
            '\\' | '`' | '*' | '[' | ']' | '<' | '>' | '&' | '~' | '|' | '$' | '^' | '{' | '}' => true,
            '_' => !is_inside_a_word(),
            _ => false,
        };
        if begins_a_block || is_markup {
            escaped.push('\\');
        }
        escaped.push(c);
    }
    escaped
}

/// Returns lines that Rust's documentation shows unchanged: a code block whose fence is longer than any in the text.
#[must_use]
pub fn verbatim(text: &str) -> String {
    let longest = text.split(|c| c != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(longest.max(2) + 1);
    let lines: Vec<String> = text.trim_end().split('\n').map(one_line).collect();
    format!("{fence}text\n{}\n{fence}", lines.join("\n"))
}

/// Makes text harmless in a `//` comment of C. A backslash at the end of a line, or the trigraph for it, would make the
/// next line a comment, too; compilers warn about every trigraph and about comments inside comments.
pub(super) fn c_comment(text: &str) -> String {
    let mut inert = String::new();
    let mut last = None;
    for c in one_line(text).chars().map(|c| if c == '\\' { '/' } else { c }) {
        match (last, c) {
            (Some('?'), '?') => continue,
            (Some('/'), '*') | (Some('*'), '/') => inert.push(' '),
            _ => {}
        }
        inert.push(c);
        last = Some(c);
    }
    inert
}
