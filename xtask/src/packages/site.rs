//! Builds one static site of the documents, the playground, the pages of the shipped robots and the reference of the
//! library.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Component, Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use pulldown_cmark::{CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};
use regex_lite::Regex;
use xshell::cmd;

use crate::packages::playground::Playground;
use crate::{Verdict, machine, page};

/// Builds one static site: the documents, the playground, a page for each shipped robot, and the reference
///
/// The site is the folder target/site. Any web server can host it, and its links are relative. A link that leads
/// nowhere is an error. Documents keep their paths: docs/teaching/for-teachers.md is docs/teaching/for-teachers.html.
#[derive(Args)]
#[command(after_help = "\
Needs what `cargo xtask playground` needs; --test needs what `cargo xtask page`
needs.

Exit status: 1 if a link leads nowhere, or a page fails in the browser.

Examples:
  cargo xtask site --install           build the site, and get what is missing
  cargo xtask site --install --test    build it, and open it in headless Chromium")]
pub(crate) struct Site {
    /// Get what is missing: the target for WebAssembly, and with --test the browser
    #[arg(long)]
    pub(crate) install: bool,
    /// Open the site in headless Chromium: tests/page/site.py
    #[arg(long)]
    test: bool,
}

/// The links in the head of each page: their names, and their paths from the root.
const PLACES: [(&str, &str); 6] = [
    ("rne", "index.html"),
    ("lecture", "docs/teaching/lecture/README.html"),
    ("teaching", "docs/teaching/for-teachers.html"),
    ("playground", "playground/index.html"),
    ("robots", "reports/index.html"),
    ("reference", "api/rne/index.html"),
];

const STYLE: &str = "\
:root { color-scheme: light dark; --line: light-dark(#dcdad3, #343a42); --soft: light-dark(#f3f2ee, #20252b); }
body { margin: 0 auto; max-width: 60rem; padding: 0 1rem 4rem; background: light-dark(#fff, #14171b);
  color: light-dark(#1d2126, #e8e6e1); font: 16px/1.55 system-ui, sans-serif; }
nav { display: flex; flex-wrap: wrap; gap: 0.2rem 1.2rem; padding: 0.7rem 0; border-bottom: 1px solid var(--line); }
nav a { align-content: center; min-height: 44px; }
a { color: light-dark(#0b5cad, #7cbcf5); }
code, pre { font: 0.88em/1.5 ui-monospace, \"DejaVu Sans Mono\", Consolas, monospace; }
pre { overflow-x: auto; padding: 0.7rem 1rem; border-radius: 6px; background: var(--soft); }
table { display: block; overflow-x: auto; border-collapse: collapse; }
th, td { padding: 0.3rem 0.6rem; border: 1px solid var(--line); text-align: left; vertical-align: top; }
img { max-width: 100%; }
iframe { border: 1px solid var(--line); }
h1, h2, h3 { line-height: 1.2; }
@media print { nav, iframe { display: none; } body { max-width: none; } }
";

impl Site {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let target = machine::target_folder("target")?;
        let site = target.join("site");
        if site.exists() {
            fs::remove_dir_all(&site).with_context(|| site.display().to_string())?;
        }
        let rne = page::rne(&shell)?;
        let names = cmd!(shell, "git ls-files *.md").quiet().read()?;
        // Markdown files in source folders belong to the reference
        let sources: Vec<PathBuf> = names.lines().filter(|name| !name.contains("/src/")).map(PathBuf::from).collect();
        let mut wrong = Vec::new();
        for source in &sources {
            let text =
                fs::read_to_string(machine::root().join(source)).with_context(|| source.display().to_string())?;
            let html = Document { source, sources: &sources, site: &site }.html(&text, &mut wrong)?;
            write(&site.join(place_of(source)), &html)?;
        }
        write(&site.join("style.css"), STYLE)?;
        reports(&shell, &rne, &site)?;
        if Playground::built(self.install)? == Verdict::Fails {
            return Ok(Verdict::Fails);
        }
        copy(&target.join("playground/index.html"), &site.join("playground/index.html"))?;
        let doc = target.join("site-doc");
        let docs = cmd!(shell, "cargo doc --quiet --no-deps --package rne --target-dir {doc}");
        machine::without_flags(docs).quiet().run()?;
        copy_all(&doc.join("doc"), &site.join("api"))?;
        let pages = checked(&site, &mut wrong)?;
        for line in &wrong {
            println!("{line}");
        }
        println!("{}: {pages} pages besides the reference, {} links lead nowhere", site.display(), wrong.len());
        if self.test {
            let python = page::python(&shell, self.install)?;
            if cmd!(shell, "{python} tests/page/site.py {site}").quiet().run().is_err() {
                return Ok(Verdict::Fails);
            }
        }
        Ok(Verdict::from(wrong.is_empty()))
    }
}

/// Returns the path of a document's page in the site.
fn place_of(source: &Path) -> PathBuf {
    if source == Path::new("README.md") { "index.html".into() } else { source.with_extension("html") }
}

/// Returns the path from a page to the root, such as `../../`.
fn up(place: &Path) -> String {
    "../".repeat(place.components().count().saturating_sub(1))
}

/// Returns a page with the head that all pages have.
fn framed(place: &Path, title: &str, body: &str) -> String {
    let up = up(place);
    let mut links = String::new();
    for (name, link) in PLACES {
        let _ = write!(links, "<a href=\"{up}{link}\">{name}</a>");
    }
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n\
         <title>{title}</title>\n<link rel=\"stylesheet\" href=\"{up}style.css\">\n</head>\n<body>\n\
         <nav>{links}</nav>\n<main>\n{body}</main>\n</body>\n</html>\n"
    )
}

/// A document of the repository that becomes a page.
struct Document<'a> {
    source: &'a Path,
    sources: &'a [PathBuf],
    site: &'a Path,
}

impl Document<'_> {
    /// Returns the page of a document. Files of the repository to which it links are copied to the site.
    fn html(&self, text: &str, wrong: &mut Vec<String>) -> Result<String> {
        let options = Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH;
        let mut events = Vec::new();
        // headings get the names that GitHub gives them
        let mut names = Names::default();
        let mut heading: Option<(usize, String)> = None;
        let mut title = self.source.display().to_string();
        for event in Parser::new_ext(text, options) {
            match event {
                Event::Start(Tag::Link { link_type, dest_url, title, id }) => {
                    let dest_url = CowStr::from(self.link(&dest_url, wrong)?);
                    events.push(Event::Start(Tag::Link { link_type, dest_url, title, id }));
                }
                Event::Start(Tag::Image { link_type, dest_url, title, id }) => {
                    let dest_url = CowStr::from(self.link(&dest_url, wrong)?);
                    events.push(Event::Start(Tag::Image { link_type, dest_url, title, id }));
                }
                Event::Start(Tag::Heading { .. }) => {
                    heading = Some((events.len(), String::new()));
                    events.push(event);
                }
                Event::End(TagEnd::Heading(level)) => {
                    if let Some((at, words)) = heading.take() {
                        let name = names.of(&words);
                        if level == HeadingLevel::H1 {
                            title = escaped(&words);
                        }
                        let id = Some(CowStr::from(name));
                        events[at] = Event::Start(Tag::Heading { level, id, classes: Vec::new(), attrs: Vec::new() });
                    }
                    events.push(event);
                }
                Event::Text(ref words) | Event::Code(ref words) => {
                    if let Some((_, all)) = &mut heading {
                        all.push_str(words);
                    }
                    events.push(event);
                }
                // a live page of the book is shown in an iframe
                Event::Html(ref html) | Event::InlineHtml(ref html) if html.contains("<iframe src=\"") => {
                    let reports = format!("<iframe src=\"{}reports/", up(&place_of(self.source)));
                    events.push(Event::Html(html.replace("<iframe src=\"", &reports).into()));
                }
                event => events.push(event),
            }
        }
        let mut body = String::new();
        html::push_html(&mut body, events.into_iter());
        Ok(framed(&place_of(self.source), &title, &body))
    }

    /// Returns a link for the site. A folder becomes its README; a file that is not a document is copied.
    fn link(&self, link: &str, wrong: &mut Vec<String>) -> Result<String> {
        if link.contains("://") || link.starts_with('#') || link.starts_with("mailto:") {
            return Ok(link.to_owned());
        }
        let (file, anchor) = link.split_once('#').map_or((link, String::new()), |(file, at)| (file, format!("#{at}")));
        let folder = self.source.parent().unwrap_or(Path::new(""));
        let path = normal(&folder.join(file));
        let there = machine::root().join(&path);
        let path = if there.is_dir() { path.join("README.md") } else { path };
        let place = if self.sources.contains(&path) {
            place_of(&path)
        } else if there.is_file() {
            copy(&there, &self.site.join(&path))?;
            path
        } else if there.is_dir() {
            // a folder of sources has no page, so the link leads nowhere and its text stays
            return Ok("#".to_owned());
        } else {
            wrong.push(format!("{}: `{link}` leads nowhere", self.source.display()));
            path
        };
        let place = place.to_string_lossy().replace('\\', "/");
        Ok(format!("{}{place}{anchor}", up(&place_of(self.source))))
    }
}

/// The names of the headings on a page. A repeated heading gets a number.
#[derive(Default)]
struct Names {
    used: BTreeMap<String, usize>,
}

impl Names {
    fn of(&mut self, words: &str) -> String {
        let kept = words.trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        let name: String = kept.flat_map(char::to_lowercase).map(|c| if c == ' ' { '-' } else { c }).collect();
        let count = self.used.entry(name.clone()).or_default();
        *count += 1;
        if *count == 1 { name } else { format!("{name}-{}", *count - 1) }
    }
}

/// Returns a path without `.` and `..`.
fn normal(path: &Path) -> PathBuf {
    let mut parts = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                parts.pop();
            }
            Component::Normal(name) => parts.push(name),
            _ => {}
        }
    }
    parts
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

/// Writes the page of each shipped robot, and a list of them.
fn reports(shell: &xshell::Shell, rne: &Path, site: &Path) -> Result<()> {
    let mut robots: Vec<String> = Vec::new();
    for entry in fs::read_dir(machine::root().join("robots")).context("robots/")? {
        let path = entry?.path();
        let name = path.file_name().and_then(|name| name.to_str()).and_then(|name| name.strip_suffix(".yaml"));
        robots.extend(name.filter(|name| !name.contains('.')).map(str::to_owned));
    }
    robots.sort();
    let mut list = String::from(
        "<h1>Robots</h1>\n<p>The page of each shipped robot: the arm, the seven steps, the torques and exercises. \
         The playground opens the same robot with its file.</p>\n<ul>\n",
    );
    fs::create_dir_all(site.join("reports"))?;
    for name in &robots {
        let page = site.join("reports").join(name).with_extension("html");
        cmd!(shell, "{rne} report {name} -o {page} --force").quiet().ignore_stdout().ignore_stderr().run()?;
        let html = fs::read_to_string(&page)?;
        let title = html.split_once("<title>").and_then(|(_, rest)| rest.split_once("</title>"));
        let title = title.map_or(name.as_str(), |(title, _)| title);
        let _ = writeln!(
            list,
            "<li><a href=\"{name}.html\">{title}</a> \
             (<a href=\"../playground/index.html#robot={name}\">playground</a>)</li>"
        );
    }
    list.push_str("</ul>\n");
    write(&site.join("reports/index.html"), &framed(Path::new("reports/index.html"), "Robots", &list))
}

fn write(path: &Path, text: &str) -> Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    fs::write(path, text).with_context(|| path.display().to_string())
}

fn copy(from: &Path, to: &Path) -> Result<()> {
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    fs::copy(from, to).map(|_| ()).with_context(|| from.display().to_string())
}

fn copy_all(from: &Path, to: &Path) -> Result<()> {
    for path in files(from)? {
        copy(&path, &to.join(path.strip_prefix(from)?))?;
    }
    Ok(())
}

/// Returns all files below a folder.
fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry?.path();
        if path.is_dir() { all.extend(files(&path)?) } else { all.push(path) }
    }
    all.sort();
    Ok(all)
}

/// Finds links that lead nowhere on the written pages. Returns the number of pages, without the reference.
fn checked(site: &Path, wrong: &mut Vec<String>) -> Result<usize> {
    let link = Regex::new(r#"<(?:a|img|iframe|link)\b[^>]*?(?:href|src)="([^"]*)""#)?;
    let id = Regex::new(r#"\bid="([^"]*)""#)?;
    let pages: Vec<PathBuf> = files(site)?
        .into_iter()
        .filter(|path| path.extension().is_some_and(|end| end == "html") && !path.starts_with(site.join("api")))
        .collect();
    let ids = |path: &Path| -> Result<BTreeSet<String>> {
        let text = fs::read_to_string(path)?;
        Ok(id.captures_iter(&text).map(|found| found[1].to_owned()).collect())
    };
    for page in &pages {
        let text = fs::read_to_string(page)?;
        // scripts contain texts that look like links
        let text = text.split("<script").next().unwrap_or_default();
        for found in link.captures_iter(text) {
            let target = &found[1];
            if target.contains("://") || target.starts_with("data:") || target.starts_with("mailto:") {
                continue;
            }
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            let path = if file.is_empty() { page.clone() } else { normal(&page.with_file_name("").join(file)) };
            let path = if page.is_absolute() && !path.is_absolute() { Path::new("/").join(path) } else { path };
            let shown = page.strip_prefix(site).unwrap_or(page).display();
            if !path.is_file() {
                wrong.push(format!("{shown}: `{target}` leads nowhere"));
            } else if !anchor.is_empty() && !anchor.contains('=') && !ids(&path)?.contains(anchor) {
                wrong.push(format!("{shown}: `{target}` has no such heading"));
            }
        }
    }
    Ok(pages.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_have_the_names_of_github() {
        let mut names = Names::default();
        let named = ["A class", "The `rne` page, 2", "A class"].map(|words| names.of(words));
        assert_eq!(named, ["a-class", "the-rne-page-2", "a-class-1"]);
    }

    #[test]
    fn a_page_that_leads_nowhere_is_told() {
        let folder = tempfile::tempdir().expect("a folder");
        let site = folder.path();
        let page = r##"<h2 id="here"></h2><a href="b.html">1</a><a href="b.html#no">2</a><a href="c.html">3</a>
            <a href="#here">4</a><a href="b.html#q=1">5</a><a href="https://example.org/">6</a>"##;
        write(&site.join("d/a.html"), page).expect("written");
        write(&site.join("d/b.html"), "").expect("written");
        let mut wrong = Vec::new();
        assert_eq!(checked(site, &mut wrong).expect("checked"), 2);
        assert_eq!(wrong, ["d/a.html: `b.html#no` has no such heading", "d/a.html: `c.html` leads nowhere"]);
    }

    #[test]
    fn links_of_documents_are_links_of_pages() {
        let sources =
            ["README.md", "docs/teaching/for-teachers.md", "docs/teaching/lecture/README.md", "robots/README.md"]
                .map(PathBuf::from);
        let folder = tempfile::tempdir().expect("a folder");
        let document = Document { source: &sources[1], sources: &sources, site: folder.path() };
        let mut wrong = Vec::new();
        let mut link = |to: &str| document.link(to, &mut wrong).expect("a link");
        assert_eq!(link("lecture/README.md#a"), "../../docs/teaching/lecture/README.html#a");
        assert_eq!(link("../../README.md"), "../../index.html");
        assert_eq!(link("../../robots"), "../../robots/README.html");
        assert_eq!(link("../states.csv"), "../../docs/states.csv");
        assert_eq!(link("https://example.org/"), "https://example.org/");
        assert_eq!(link("nowhere.md"), "../../docs/teaching/nowhere.md");
        assert_eq!(wrong, ["docs/teaching/for-teachers.md: `nowhere.md` leads nowhere"]);
        assert!(folder.path().join("docs/states.csv").exists());
    }
}
