//! Texts in the place of a robot file.

use std::fmt::Write as _;
use std::path::Path;

use super::{Case, as_said, written};

/// A valid file, of which passages are replaced.
pub(super) const ARM: &str = "\
format: 1
name: arm
title: an arm
source: a test
convention: standard
gravity: [0, -9.81, 0]
parameters: {m: 1.5, r: 2*m}
joints:
  - name: shoulder
    type: revolute
    dh: {theta: 0, d: 0, a: 0.4, alpha: 0}
    link: {mass: m, com: [-0.2, 0, 0], inertia: {xx: 0.01, yy: 0.02, zz: 0.02}}
";

/// The valid file with one passage replaced.
pub(super) fn with(old: &str, new: &str) -> String {
    assert_eq!(ARM.matches(old).count(), 1, "`{old}` must occur once");
    ARM.replace(old, new)
}

/// A unit, so often that the file is just short enough.
fn fill(unit: &str) -> String {
    unit.repeat((1 << 20) / unit.len())
}

/// Lines made of a number.
pub(super) fn lines(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).fold(String::new(), |mut text, index| {
        let _ = writeln!(text, "{}", line(index));
        text
    })
}

pub(super) fn cases(folder: &Path) -> Vec<Case> {
    let texts = texts().into_iter().map(|(what, text, words)| (what.to_owned(), text.into_bytes(), words));
    let bytes = bytes().into_iter().map(|(what, bytes, words)| (what.to_owned(), bytes, words));
    let numbers = numbers().into_iter().map(|(number, words)| {
        let text = with("a: 0.4", &format!("a: {number}"));
        (number.chars().take(40).collect(), text.into_bytes(), words)
    });
    let case = |(index, (what, bytes, words)): (usize, (String, Vec<u8>, &'static str))| {
        let path = written(folder, index, "x.yaml", bytes);
        Case::new(what, &["check", &path], as_said(words)).naming(format!("{index}/x.yaml"))
    };
    bytes.chain(texts).chain(numbers).enumerate().map(case).collect()
}

/// What, the file, and what is said of it: nothing of a valid one.
type Row = (&'static str, Vec<u8>, &'static str);

/// What is no text, or a strange one.
fn bytes() -> Vec<Row> {
    let utf16 = |bytes: fn(u16) -> [u8; 2]| ARM.encode_utf16().flat_map(bytes).collect::<Vec<u8>>();
    let spliced = |bytes: &[u8]| [ARM.as_bytes(), bytes].concat();
    let long = |comment: usize| format!("{ARM}#{}", "x".repeat(comment)).into_bytes();
    vec![
        ("empty", Vec::new(), "the file is empty"),
        ("a blank", b" ".into(), "the file is empty"),
        ("a byte order mark", b"\xEF\xBB\xBF".into(), "the file is empty"),
        ("a byte order mark and an arm", [b"\xEF\xBB\xBF", ARM.as_bytes()].concat(), ""),
        ("UTF-16, little end first", [b"\xFF\xFE".into(), utf16(u16::to_le_bytes)].concat(), "UTF-16"),
        ("UTF-16, big end first", [b"\xFE\xFF".into(), utf16(u16::to_be_bytes)].concat(), "UTF-16"),
        ("UTF-16 without its mark", utf16(u16::to_le_bytes), "control character U+0000"),
        ("zeros", vec![0; 1 << 20], "control character U+0000"),
        ("a zero at the end", spliced(b"\0"), "control character U+0000"),
        ("ones", vec![0xFF; 1 << 20], "byte 0xFF is not UTF-8"),
        ("half a character", spliced(b"# \xC3"), "byte 0xC3 is not UTF-8"),
        ("a surrogate", spliced(b"# \xED\xA0\x80"), "byte 0xED is not UTF-8"),
        ("a long zero", spliced(b"# \xC0\x80"), "byte 0xC0 is not UTF-8"),
        ("beyond Unicode", spliced(b"# \xF4\x90\x80\x80"), "byte 0xF4 is not UTF-8"),
        ("Latin-1", spliced(b"# Gr\xFC\xDFe"), "byte 0xFC is not UTF-8"),
        ("gzip", b"\x1F\x8B\x08\x00\x00\x00\x00\x00".into(), "byte 0x8B is not UTF-8"),
        ("an ELF", b"\x7FELF\x02\x01\x01\x00".into(), "control character U+007F"),
        ("an escape", spliced(b"# \x1B[2J\n"), "control character U+001B"),
        ("an escape of one character", spliced("# \u{9B}2J\n".as_bytes()), "control character U+009B"),
        ("lines of DOS", ARM.replace('\n', "\r\n").into_bytes(), ""),
        ("lines of an old Mac", ARM.replace('\n', "\r").into_bytes(), ""),
        ("1 MiB", long((1 << 20) - ARM.len() - 1), ""),
        ("1 MiB and 1", long((1 << 20) - ARM.len()), "more than 1048576 bytes"),
        ("10 MiB", long(10 << 20), "more than 1048576 bytes"),
    ]
}

/// YAML that is too deep, too long, too clever or something else.
#[allow(clippy::too_many_lines)] // a table
fn texts() -> Vec<(&'static str, String, &'static str)> {
    let aliases = |items: &str| {
        lines(12, |i| match i {
            0 => format!("a0: &a0 [{}]", items.replace('_', "x")),
            i => format!("a{i}: &a{i} [{}]", items.replace('_', &format!("*a{}", i - 1))),
        })
    };
    let many = |count| {
        with("  - name: shoulder\n", "").lines().take(8).fold(String::new(), |text, line| text + line + "\n")
            + &"  - {type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 1}}\n".repeat(count)
    };
    let parameters = |lines: &str| with("parameters: {m: 1.5, r: 2*m}\n", &format!("parameters:\n  m: 1.5\n{lines}"));
    let chain = |count: usize, next: fn(usize, usize) -> usize| {
        parameters(&lines(count, |i| format!("  p{i}: p{}", next(i, count))))
    };
    let joints = |value: &str| {
        let (head, _) = ARM.split_once("joints:").expect("joints");
        format!("{head}joints: {value}\n")
    };
    let long = "x".repeat(100_000);
    vec![
        // what stands in the wrong place
        ("a URDF without links", "<?xml version=\"1.0\"?><robot name=\"r\"/>".into(), "the robot has no link"),
        ("JSON", "{\"joints\": [1, 2]}".into(), "is missing"),
        ("TOML", "format = 1\nname = \"arm\"\n".into(), "mapping"),
        ("C", "#include <stdio.h>\nint main(void) { return 0; }\n".into(), "x.yaml:"),
        ("a plan", "format: 3\nrobot: arm\nfingerprint: 0\nreduced: {}\n".into(), "unknown format `3`"),
        ("a word", "arm".into(), "mapping"),
        ("a number", "1e999".into(), "mapping"),
        ("nothing", "~".into(), "mapping"),
        ("a list", "- 1\n- 2\n".into(), "mapping"),
        ("an empty mapping", "{}".into(), "is missing"),
        ("a document's end", "...".into(), "x.yaml"),
        ("two documents", format!("{ARM}---\n{ARM}"), "a second YAML document"),
        ("a thousand documents", "---\na\n".repeat(1000), "a second YAML document"),
        ("a later YAML", format!("%YAML 9.9\n---\n{ARM}"), ""),
        // aliases, anchors, tags
        ("billions of laughs", aliases("_, _, _, _, _, _, _, _, _, _"), "more than 50000 values when aliases"),
        ("a tower of laughs", aliases("_"), "unknown key"),
        ("an anchor within itself", "a: &a [*a]".into(), "x.yaml:1"),
        ("an unknown alias", with("a: 0.4", "a: *nothing"), "x.yaml:11"),
        ("a merge", with("a: 0.4", "<<: {a: 0.4}"), "unknown key `<<`"),
        ("a tag of Python", with("a: 0.4", "a: !!python/object/apply:os.system [ls]"), "x.yaml:11"),
        ("a tag", with("a: 0.4", "a: !!float 0.4"), "x.yaml:11"),
        ("bytes", with("a: 0.4", "a: !!binary AAAA"), "x.yaml:11"),
        ("anchors alone", fill("&a "), "x.yaml:1"),
        ("aliases alone", fill("*a "), "x.yaml:1"),
        ("tags alone", fill("!a "), "x.yaml:1"),
        // depth
        ("open lists", fill("["), "nested more than 16 levels deep"),
        ("open mappings", fill("{a: "), "nested more than 16 levels deep"),
        ("dashes", fill("- "), "nested more than 16 levels deep"),
        ("questions", fill("? "), "x.yaml:"),
        ("deeper and deeper", lines(1400, |i| format!("{}a:", " ".repeat(i))), "nested more than 16 levels deep"),
        ("closed lists", fill("]"), "x.yaml:1"),
        // length
        ("items", fill("- 1\n"), "more than 50000 values"),
        ("items in a line", format!("[{}]", fill("1,")[..1 << 19].to_owned()), "more than"),
        ("keys in a line", format!("{{{}}}", &fill("a: 1, ")[..1_000_000]), "more than 50000 commas"),
        ("keys without values", format!("{{{}}}", &fill("a,")[..1_000_000]), "more than 50000 commas"),
        ("pairs in a list", format!("[{}]", &fill("a: a,")[..1_000_000]), "x.yaml:1"),
        ("colons in a list", format!("[{}]", &fill(": ")[..1_000_000]), "x.yaml:1"),
        ("quotes in a list", format!("[{}]", &fill("'',")[..999_999]), "x.yaml:1"),
        ("anchors in a list", format!("[{}]", &fill("&a ")[..999_999]), "x.yaml:1"),
        ("dashes in quotes", format!("[{}]", &fill("'\n- ',")[..999_999]), "x.yaml:"),
        ("pairs and dashes", format!("{{{}}}", &fill("a: a,a: '\n- ',")[..999_999]), "x.yaml:"),
        ("lists in a list", format!("[{}]", &fill("[],")[..999_999]), "x.yaml:1"),
        ("the same key", fill("a: 1\n"), "repeated key `a`"),
        ("unknown keys", lines(60_000, |i| format!("k{i}: 1")), "more than 50000 values"),
        ("a long word", fill("a"), "mapping"),
        ("a long key", format!("{long}: 1"), "x.yaml:1"),
        ("a long key of a joint", with("a: 0.4", &format!("{}: 0.4", "a".repeat(900))), "unknown key"),
        ("an open quote", fill("'"), "x.yaml:1"),
        ("escapes", format!("\"{}\"", &fill("\\x41")[..1 << 19]), "mapping"),
        ("an escape that is none", "\"\\q\"".into(), "x.yaml:1"),
        ("colons", fill(":"), "mapping"),
        ("commas", fill(","), "x.yaml:1"),
        ("percents", fill("%"), "x.yaml:1"),
        ("tabs", fill("\t"), "x.yaml"),
        ("tabs for blanks", ARM.replace("    ", "\t"), "x.yaml:"),
        ("lines", fill("\n"), "the file is empty"),
        ("ends of lines of no system", fill("a\r"), "x.yaml:1"),
        ("next lines", fill("\u{85}"), "x.yaml"),
        ("line separators", fill("\u{2028}"), "x.yaml"),
        ("byte order marks", fill("\u{FEFF}"), "x.yaml"),
        ("comments", fill("#\n"), "the file is empty"),
        ("blocks", fill("|\n"), "x.yaml"),
        ("a folded text", format!("a: {}", &fill("b\n  ")[..1 << 19]), "unknown key"),
        ("starts of documents", fill("---\n"), "x.yaml"),
        ("ends of documents", fill("...\n"), "x.yaml"),
        ("a long source", with("source: a test", &format!("source: {long}")), ""),
        // keys and values that are not what they should be
        ("a repeated key", with("name: arm", "name: arm\nname: arm"), "repeated key `name`"),
        ("a list as a key", with("name: arm", "[a]: arm"), "x.yaml:2"),
        ("nothing as a key", with("name: arm", ": arm"), "x.yaml:2"),
        ("a number as a key", with("name: arm", "1: arm"), "unknown key `1`"),
        ("a key of a prototype", with("name: arm", "name: arm\n__proto__: {}"), "unknown key"),
        ("a word for a number", with("a: 0.4", "a: no"), "unknown name `no`"),
        ("a list for a number", with("a: 0.4", "a: [0.4]"), "a list of 1"),
        ("a mapping for a number", with("a: 0.4", "a: {}"), "a mapping"),
        ("a number for a list", with("[0, -9.81, 0]", "-9.81"), "x.yaml:6"),
        ("two numbers", with("[0, -9.81, 0]", "[0, -9.81]"), "x.yaml:6"),
        ("a thousand numbers", with("[0, -9.81, 0]", &format!("[{}0]", "0, ".repeat(1000))), "x.yaml:6"),
        ("a format to come", with("format: 1", "format: 1e999"), "x.yaml:1"),
        ("a format of 100 digits", with("format: 1", &format!("format: {}", "1".repeat(100))), "x.yaml:1"),
        ("a convention", with("standard", "denavit"), "x.yaml:5"),
        ("no mass", with("mass: m", "mass: -1e-300"), "negative"),
        ("an endless inertia", with("xx: 0.01", "xx: 1e308*10"), "too large"),
        // joints
        ("no joints", joints("[]"), "x.yaml:8"),
        ("a mapping of joints", joints("{}"), "x.yaml:8"),
        ("a number of joints", joints("6"), "x.yaml:8"),
        ("joints of nothing", joints("[~, ~]"), "x.yaml:8"),
        ("64 joints", many(64), ""),
        ("65 joints", many(65), "65 joints; 1 to 64"),
        ("10,000 joints", many(10_000), "64 joints"),
        // names
        ("a name of a path", with("name: arm", "name: ../../etc/passwd"), "x.yaml:2"),
        ("a name of a device", with("name: arm", "name: CON"), "x.yaml:2"),
        ("a name like an option", with("name: arm", "name: -rf"), "x.yaml:2"),
        ("no name", with("name: arm", "name: ''"), "x.yaml:2"),
        ("a name with a blank", with("name: arm", "name: a b"), "x.yaml:2"),
        ("a name with an escape", with("name: arm", "name: \"a\\e[2Jb\""), "x.yaml:2"),
        ("a name that turns", with("name: arm", "name: \"a\\u202Eb\""), "x.yaml:2"),
        ("a keyword", with("name: arm", "name: fn"), ""),
        ("a title with an escape", with("an arm", "\"\\e]0;title\\a\\e[2J\\x9B2J\""), "control character"),
        ("a title that turns", with("an arm", "\"\\u202E\\u2066 mra na\""), "control character"),
        ("a title of lines", with("an arm", "\"a\\nb\\r\\nc\\u2028d\\0\""), "control character"),
        ("a joint with an escape", with("shoulder", "\"\\e[31mred\""), "control character"),
        ("an unknown key that turns", with("a: 0.4", "\"\\u202Ea\\e[2J\": 0.4"), "unknown key"),
        ("a key of Cyrillic", with("a: 0.4", "\u{430}: 0.4"), "unknown key `\u{430}`"),
        // parameters
        ("a parameter of itself", parameters("  p: p\n"), "p"),
        ("a circle of two", parameters("  p: q\n  q: p\n"), "x.yaml:9"),
        ("a circle of 1,000", chain(1000, |i, n| (i + 1) % n), "x.yaml:9"),
        ("a chain of 1,000, backwards", chain(1000, |i, n| (i + 1).min(n - 1)), "x.yaml:9"),
        (
            "a chain of 1,000",
            parameters(&lines(1000, |i| if i == 0 { "  p0: 1".into() } else { format!("  p{i}: p{}", i - 1) })),
            "",
        ),
        (
            "a chain that doubles",
            parameters(&lines(1100, |i| match i {
                0 => "  p0: 1".into(),
                i => format!("  p{i}: p{0} + p{0}", i - 1),
            })),
            "too large",
        ),
        ("60,000 parameters", parameters(&lines(60_000, |i| format!("  p{i}: {i}"))), "more than 50000 values"),
        ("a parameter that is pi", parameters("  pi: 3\n"), "pi"),
        ("a parameter that is a function", parameters("  sin: 3\n"), "sin"),
        ("a long parameter", parameters(&format!("  {}: 3\n", "p".repeat(1000))), ""),
        ("a parameter with a blank", parameters("  a b: 3\n"), "x.yaml:9"),
        ("no parameters", with("{m: 1.5, r: 2*m}", "[1, 2]"), "x.yaml:7"),
    ]
}

/// What stands in the place of a number.
fn numbers() -> Vec<(String, &'static str)> {
    let short = [
        ("1e999", "too large"),
        ("-1e999", "too large"),
        ("1e-999", "too small"),
        ("5e-324", ""),
        ("1.7976931348623157e308", ""),
        ("1e99999999999999999999", "too large"),
        ("1e-99999999999999999999", "too small"),
        ("'1e308*10'", "too large"),
        (".inf", "x.yaml:11"),
        ("-.INF", "x.yaml:11"),
        (".nan", "x.yaml:11"),
        ("nan", "numbers are finite"),
        ("infinity", "numbers are finite"),
        ("0/0", "x.yaml:11"),
        ("1/0", "x.yaml:11"),
        ("sqrt(-1)", "x.yaml:11"),
        ("asin(2)", "x.yaml:11"),
        ("9^9^9^9", "x.yaml:11"),
        ("2^1e308", "x.yaml:11"),
        ("(-8)^(1/3)", "x.yaml:11"),
        ("system(1)", "x.yaml:11"),
        ("sin", "x.yaml:11"),
        ("sin(", "x.yaml:11"),
        ("1 2", "x.yaml:11"),
        ("1..2", "x.yaml:11"),
        ("1e", "x.yaml:11"),
        ("0x10", "x.yaml:11"),
        ("0o17", "x.yaml:11"),
        ("1_000", "x.yaml:11"),
        ("1:30", "x.yaml:11"),
        ("'1;2'", "x.yaml:11"),
        ("\u{2212}1", "x.yaml:11"),
        ("\u{FF11}", "x.yaml:11"),
        ("\u{221E}", "x.yaml:11"),
        ("\"\\e[2J\"", "x.yaml:11"),
        ("\"\\0\"", "x.yaml:11"),
        ("''", "x.yaml:11"),
        ("", "x.yaml:11"),
    ];
    let long = [
        ("1".repeat(10_000), "too large"),
        ("1".repeat(1 << 19), "too long: 524288 bytes"),
        (format!("0.{}1", "0".repeat(9000)), "too small"),
        (format!("{}1", "1+".repeat(4000)), "more than 1000 numbers"),
        (format!("{}1", "1+".repeat(1 << 18)), "too long"),
        (format!("\"{}\"", "(".repeat(9_000)), "nested more than 64 levels deep"),
        (format!("\"{}1\"", "-".repeat(9_000)), "x.yaml:11"),
        (format!("{}1", "2^".repeat(400)), "x.yaml:11"),
        (format!("\"{}\"", "sin(".repeat(2_000)), "nested more than 64 levels deep"),
        (format!("\"{}\"", "x".repeat(9_000)), "x.yaml:11"),
    ];
    short.into_iter().map(|(number, words)| (number.to_owned(), words)).chain(long).collect()
}
