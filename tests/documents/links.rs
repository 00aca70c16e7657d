//! What documents lead to: links, sources, and the files and tests that guides name.

use std::collections::BTreeSet;
use std::path::Path;

use crate::{files_below, read, root};

/// The documents that say where things stand: what they name must exist.
const GUIDES: &[&str] = &["ARCHITECTURE.md", "CONTRIBUTING.md"];

/// The headings of a page as GitHub names them in addresses.
fn anchors(page: &str) -> BTreeSet<String> {
    let mut anchors = BTreeSet::new();
    let mut is_code = false;
    for line in page.lines() {
        is_code ^= line.starts_with("```");
        let title = line.trim_start_matches('#');
        if is_code || !line.starts_with('#') || !title.starts_with(' ') {
            continue;
        }
        let kept = title.trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        let anchor: String = kept.flat_map(char::to_lowercase).map(|c| if c == ' ' { '-' } else { c }).collect();
        let again = (1..1000).map(|time| format!("{anchor}-{time}")).find(|name| !anchors.contains(name));
        let name = if anchors.contains(&anchor) { again.expect("some number is free") } else { anchor };
        anchors.insert(name);
    }
    anchors
}

#[test]
fn links_lead_somewhere() {
    let mut pages = Vec::new();
    files_below(root(), ".md", &mut pages);
    let mut links = 0;
    for page in &pages {
        let text = read(page);
        for link in text.split("](").skip(1).filter_map(|rest| rest.split([')', ' ']).next()) {
            if link.contains("://") {
                continue;
            }
            links += 1;
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { page.clone() } else { page.with_file_name(file) };
            assert!(target.exists(), "{}: `{link}` leads nowhere", page.display());
            if !anchor.is_empty() {
                assert!(anchors(&read(&target)).contains(anchor), "{}: `{link}` has no such heading", page.display());
            }
        }
    }
    assert!(links > 80, "{links} links of {} pages", pages.len());
}

/// A source that any page names by its last part (`proof.rs`, `ir/graph.rs`) is there.
#[test]
fn pages_name_sources_that_are_there() {
    let (mut pages, mut sources) = (Vec::new(), Vec::new());
    files_below(root(), ".md", &mut pages);
    files_below(root(), ".rs", &mut sources);
    let mut named = 0;
    for page in &pages {
        for word in read(page).split('`').skip(1).step_by(2) {
            let is_path = word.chars().all(|c| c.is_ascii_alphanumeric() || "_/.-".contains(c));
            if is_path
                && Path::new(word).extension() == Some("rs".as_ref())
                && !word.starts_with('.')
                && !word.starts_with("target/")
            // what a build writes
            {
                named += 1;
                assert!(
                    sources.iter().any(|source| source.ends_with(word)),
                    "{}: there is no `{word}`",
                    page.display()
                );
            }
        }
    }
    assert!(named > 60, "{named} sources are named");
}

/// Files and tests that the guides name are there. A test is what has three underscores or more; a name in capitals
/// (`robots/NAME.yaml`) stands for any.
#[test]
fn guides_name_what_is_there() {
    let mut sources = Vec::new();
    files_below(root(), ".rs", &mut sources);
    let code: String = sources.iter().map(|path| read(path)).collect();
    for guide in GUIDES {
        let text = read(&root().join(guide));
        let mut named = 0;
        let mut is_code = false;
        for line in text.lines() {
            is_code ^= line.starts_with("```");
            if is_code {
                continue;
            }
            for word in line.split('`').skip(1).step_by(2) {
                let is_name = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
                if word.chars().all(is_name) && word.matches('_').count() >= 3 {
                    assert!(code.contains(&format!("fn {word}(")), "{guide}: there is no test `{word}`");
                    named += 1;
                } else if word.contains('/') && word.chars().all(|c| is_name(c) || "/.-".contains(c)) {
                    assert!(root().join(word).exists(), "{guide}: there is no `{word}`");
                    named += 1;
                }
            }
        }
        assert!(named > 30, "{guide} names {named} files and tests");
    }
}
