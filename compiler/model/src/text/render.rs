//! Renders diagnostics in one way, for the macro and for the command line.

use std::fmt::Write as _;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};

use crate::{Diagnostic, Report, Severity, one_line};

/// Largest number of diagnostics that are shown.
const SHOWN: usize = 20;

/// Longest source line that is shown, in bytes. A longer one is only named, because nobody reads it and its layout
/// takes long.
const LONGEST_LINE: usize = 4096;

pub(crate) fn full(report: &Report, color: bool) -> String {
    let renderer = if color { Renderer::styled() } else { Renderer::plain() };
    let shown = report.diagnostics.iter().take(SHOWN).map(|found| snippet(report, found, &renderer));
    shown.chain(rest(report)).collect::<Vec<_>>().join("\n\n")
}

pub(crate) fn short(report: &Report) -> String {
    let line = |found: &Diagnostic| {
        let mut line = format!("{}:{}:{}: ", one_line(&report.name), found.line, found.column);
        let _ = write!(line, "{}: {}", severity(found.severity), found.message);
        line
    };
    report.diagnostics.iter().take(SHOWN).map(line).chain(rest(report)).collect::<Vec<_>>().join("\n")
}

fn severity(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    }
}

fn rest(report: &Report) -> Option<String> {
    let rest = report.diagnostics.get(SHOWN..).filter(|rest| !rest.is_empty())?;
    let counted = [Severity::Error, Severity::Warning, Severity::Note].into_iter().filter_map(|kind| {
        let count = rest.iter().filter(|found| found.severity == kind).count();
        (count > 0).then(|| format!("{count} more {}s", severity(kind)))
    });
    Some(format!("and {}", counted.collect::<Vec<_>>().join(" and ")))
}

fn snippet(report: &Report, found: &Diagnostic, renderer: &Renderer) -> String {
    let level = match found.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Note => Level::NOTE,
    };
    let title = level.primary_title(&found.message);
    // the name of a file may contain line breaks and control characters
    let name = one_line(&report.name);
    // Only the first line of the span is shown, so the caret of a span of several lines ends with that line.
    let (line, span) = line_of(&report.text, &found.span);
    let group = if report.text.is_empty() || line.len() > LONGEST_LINE {
        title.element(Origin::path(&name).line(found.line).char_column(found.column))
    } else {
        let caret = AnnotationKind::Primary.span(span).label(found.label.as_deref());
        title.element(Snippet::source(line).line_start(found.line).path(&name).annotation(caret))
    };
    let group = group.elements(found.help.as_deref().map(|help| Level::HELP.message(help)));
    renderer.render(&[group])
}

/// Returns the line in which `span` begins, and the part of the span inside this line.
fn line_of<'t>(text: &'t str, span: &Range<usize>) -> (&'t str, Range<usize>) {
    let (before, after) = text.split_at_checked(span.start).unwrap_or((text, ""));
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let end = after.find('\n').map_or(text.len(), |newline| before.len() + newline);
    let line = text.get(start..end).unwrap_or_default().trim_end_matches('\r');
    let inside = |index: usize| index.saturating_sub(start).min(line.len());
    (line, inside(span.start)..inside(span.end))
}
