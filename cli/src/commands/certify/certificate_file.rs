//! Writes the file of a certificate, or compares it with the certificate that would be written now.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use rne_certify::certificate::Certificate;
use rne_certify::sha256;

use crate::commands::certify::Arguments;
use crate::files::output_file::{self, Existing, is_standard_output};
use crate::outcome::{Failure, Outcome};
use crate::palette::{GOOD, TITLE, TYPED};

/// Writes the certificate to standard output or to a file, or checks a file.
pub(super) fn written(arguments: &Arguments, certificate: &Certificate) -> Result<Outcome, Failure> {
    let text = if arguments.json {
        serde_json::to_string_pretty(certificate).map_err(Failure::input)? + "\n"
    } else {
        certificate.page()
    };
    if let Some(file) = &arguments.check {
        if matches!(output_file::existing(file), Existing::Text(found) if !is_ours(&found)) {
            return Err(input_error!("{} is no certificate of rne", file.display()));
        }
        return check(file, &text, certificate);
    }
    let Some(out) = arguments.output.as_deref().filter(|out| !is_standard_output(out)) else {
        return Ok(Outcome::text(text));
    };
    match output_file::existing(out) {
        Existing::Text(found) if !is_ours(&found) && !arguments.force => Err(usage_error!(
            "{} is no certificate of rne and is not changed; {TYPED}--force{TYPED:#} overwrites it",
            out.display()
        )),
        Existing::Other if !arguments.force => {
            Err(usage_error!("{} is no certificate of rne and is not changed", out.display()))
        }
        Existing::Folder => Err(usage_error!("{} is a folder; name a file", out.display())),
        Existing::Special => Err(usage_error!("{} is not a regular file", out.display())),
        Existing::Unreadable(error) => Err(output_file::unreadable(out, &error)),
        _ => {
            let remark = output_file::write_all(&[(out, text)])?;
            let other = code_beside(out, certificate).err().map(|failure| failure.sentence());
            let note = other.map_or_else(String::new, |other| format!("{TITLE}note{TITLE:#}: {other}\n"));
            Ok(Outcome::remark(remark + &note))
        }
    }
}

fn is_ours(text: &str) -> bool {
    text.trim().is_empty()
        || text.starts_with("# Certificate of `")
        || text.starts_with("{\n  \"command\": \"rne certify")
}

/// Compares a file with the certificate that would be written now, line by line, and then the code beside it with its
/// SHA-256.
fn check(file: &Path, text: &str, certificate: &Certificate) -> Result<Outcome, Failure> {
    let shown = file.display();
    let found = match output_file::existing(file) {
        Existing::Text(found) if found.trim().is_empty() => {
            return Err(input_error!("{shown} is empty; {TYPED}-o{TYPED:#} writes a certificate there"));
        }
        Existing::Text(found) => found,
        Existing::Nothing => {
            return Err(input_error!(
                "there is no file {shown}; {TYPED}-o {shown}{TYPED:#} in the place of {TYPED}--check{TYPED:#} writes it"
            ));
        }
        _ => return Err(input_error!("{shown} is no certificate of rne")),
    };
    if found == text {
        let code = code_beside(file, certificate)?;
        return Ok(Outcome::remark(format!("{GOOD}up to date:{GOOD:#} {shown}\n{code}")));
    }
    // the message lists differing figures before differing hashes
    let (mut differences, mut hashes): (Vec<String>, Vec<String>) = Default::default();
    let mut section = "the head";
    let (old, new): (Vec<&str>, Vec<&str>) = (found.lines().collect(), text.lines().collect());
    for index in 0..old.len().max(new.len()) {
        let [a, b] = [&old, &new].map(|lines| lines.get(index).copied().unwrap_or("the end of the file"));
        section = a.strip_prefix("## ").unwrap_or(section);
        if a != b {
            let is_hash = |line: &str| line.split('`').any(|word| word.len() == 64);
            let list = if is_hash(a) || is_hash(b) { &mut hashes } else { &mut differences };
            list.push(format!("line {} ({section}):\n  file: {a}\n  now:  {b}", index + 1));
        }
    }
    differences.append(&mut hashes);
    let count = differences.len();
    differences.truncate(5);
    let made_by = match [&found[..], text].map(command_of) {
        [Some(old), Some(new)] if old != new => {
            format!("the certificate {shown} was made by: {old}\nthe command of now is: {new}\n")
        }
        _ => String::new(),
    };
    Err(input_error!(
        "{made_by}{shown} is not what rne would write now; {count} lines differ:\n{}",
        differences.join("\n")
    ))
}

/// Compares the files of the code beside a certificate with the hashes in the certificate. Returns what was compared.
fn code_beside(beside: &Path, certificate: &Certificate) -> Result<String, Failure> {
    let mut remark = String::new();
    let is_code = |name: &str| [".c", ".h", ".rs"].iter().any(|end| name.ends_with(end));
    for (name, expected) in certificate.hashes.iter().filter(|(name, _)| is_code(name)) {
        let path = beside.with_file_name(name);
        let shown = path.display();
        let Ok(bytes) = fs::read(&path) else {
            let _ = writeln!(remark, "{TITLE}note{TITLE:#}: {shown} cannot be read, so it is not compared");
            continue;
        };
        let hash = sha256(&bytes);
        if hash != *expected {
            return Err(input_error!(
                "{shown} is not the code of the certificate: its SHA-256 is {hash} instead of {expected}. This \
                 command writes the code; with {TYPED}--check{TYPED:#} in the place of {TYPED}-o{TYPED:#}, it says \
                 what differs:\n  {}",
                certificate.emit
            ));
        }
        let _ = writeln!(remark, "{GOOD}up to date:{GOOD:#} {shown}");
    }
    Ok(remark)
}

/// Returns the command by which a certificate was made, from its page or its JSON.
fn command_of(text: &str) -> Option<&str> {
    text.lines().find_map(|line| {
        let of_json = line.strip_prefix("  \"command\": \"").and_then(|line| line.strip_suffix("\","));
        of_json.or_else(|| line.starts_with("rne certify ").then_some(line))
    })
}
