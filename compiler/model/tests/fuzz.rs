//! Whatever the bytes, the answer is a robot or a report, never a panic, and little work is done for it.

use crate::common::BASE;
use proptest::prelude::*;
use rne_model::{Reader, Report, is_control};

/// Reads, renders every way, and checks what must hold of every report.
fn survive(bytes: &[u8]) -> Result<(), TestCaseError> {
    let result = Reader::new("x.yaml").read(bytes);
    let valid = result.is_ok();
    let report = result.map_or_else(|report| report, |checked| checked.lints);
    prop_assert_eq!(report.has_errors(), !valid, "{}", report.short());
    well_formed(&report)?;
    let varying = Reader::new("x.yaml").run_time(&["m", "r"]).read(bytes);
    prop_assert!(valid || varying.is_err(), "no error is forgiven at run time");
    well_formed(&varying.map_or_else(|report| report, |checked| checked.lints))?;
    let of_all = Reader::new("x.yaml").trees().couplings().loops().read(bytes);
    prop_assert!(!valid || of_all.is_ok(), "who takes more refuses no less");
    well_formed(&of_all.map_or_else(|report| report, |checked| checked.lints))?;
    let most = 1000 + 100 * bytes.len();
    prop_assert!(report.work() <= most, "{} steps for {} bytes", report.work(), bytes.len());
    Ok(())
}

fn well_formed(report: &Report) -> Result<(), TestCaseError> {
    for found in &report.diagnostics {
        prop_assert!(report.text.get(found.span.clone()).is_some(), "{:?} of {:?}", found.span, report.text);
        let before = &report.text[..found.span.start];
        prop_assert_eq!(found.line, before.matches('\n').count() + 1);
        prop_assert_eq!(found.column, before.rsplit('\n').next().unwrap_or_default().chars().count() + 1);
        prop_assert!(!found.message.contains('\n'), "{:?}", found.message);
    }
    let full = report.to_string();
    prop_assert_eq!(full.is_empty(), report.is_empty());
    prop_assert!(!full.contains('\u{1B}'), "{:?}", full);
    let words =
        report.diagnostics.iter().flat_map(|found| [Some(&found.message), found.label.as_ref(), found.help.as_ref()]);
    for words in words.flatten() {
        prop_assert!(!words.chars().any(is_control), "what a file holds is quoted: {words:?}");
    }
    report.render(true);
    report.short();
    Ok(())
}

/// A file with a closed loop.
const FOUR_BAR: &str = include_str!("../../../docs/four_bar.yaml");

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_closed_loop_with_other_words_and_numbers(
        changes in prop::collection::vec((0..100_usize, 0..24_usize), 1..4),
    ) {
        const PIECES: [&str; 24] = [
            "0", "1", "-0.3", "1e300", "-1e300", "1e-300", ".inf", ".nan", "pi/2", "prismatic", "weld", "universal",
            "spherical", "revolute", "standard", "base", "crank", "coupler", "rocker", "", "[]", "{}", "~", "pin",
        ];
        let mut text = FOUR_BAR.split_once("joints:").expect("a list of joints").1.to_owned();
        for (at, piece) in changes {
            let is_word = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
            let begins = |(at, c): (usize, char)| {
                (is_word(c) && !text[..at].ends_with(is_word)).then_some(at)
            };
            let words: Vec<usize> = text.char_indices().filter_map(begins).collect();
            let start = words[at % words.len()];
            let end = text[start..].find(|c| !is_word(c)).map_or(text.len(), |length| start + length);
            text.replace_range(start..end, PIECES[piece]);
        }
        let head = FOUR_BAR.split_once("joints:").expect("a list of joints").0;
        survive(format!("{head}joints:{text}").as_bytes())?;
    }
}

/// What robot files and YAML are made of.
fn pieces() -> impl Strategy<Value = String> {
    prop::sample::select(vec![
        "format: 1\n",
        "name: x\n",
        "source: s\n",
        "convention: standard\n",
        "gravity: [0, 0, -9.81]\n",
        "joints:\n",
        "  - type: revolute\n",
        "    dh: {theta: 0, d: 0, a: 0, alpha: pi/2}\n",
        "    link: {mass: 1}\n",
        "parameters: {",
        "a: 1",
        "2*m",
        "(",
        ")",
        "sin(",
        "^",
        "-",
        "1e9",
        "1e999",
        ".inf",
        "pi",
        "deg(90)",
        "{",
        "}",
        "[",
        "]",
        ", ",
        ": ",
        "- ",
        "? ",
        "\n",
        "\n  ",
        "\n    ",
        "\r\n",
        "\t",
        "'",
        "\"",
        "\\x41",
        "&a ",
        "*a",
        "!t ",
        "|\n",
        ">\n",
        "# c",
        "---\n",
        "...\n",
        "%YAML 1.2\n",
        "<<: ",
        "~",
        "é",
        "\u{FEFF}",
        "\u{85}",
        "\u{2028}",
        "\u{202E}",
        "\u{200F}",
        "😀",
    ])
    .prop_map(str::to_owned)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        survive(&bytes)?;
    }

    #[test]
    fn arbitrary_strings(text in "\\PC{0,100}") {
        survive(text.as_bytes())?;
    }

    #[test]
    fn arbitrary_pieces(pieces in prop::collection::vec(pieces(), 0..60)) {
        survive(pieces.concat().as_bytes())?;
    }

    #[test]
    fn a_valid_file_with_bytes_overwritten(at in 0..BASE.len(), new in prop::collection::vec(any::<u8>(), 0..4)) {
        let mut bytes = BASE.as_bytes().to_vec();
        let end = (at + new.len()).min(bytes.len());
        bytes.splice(at..end, new);
        survive(&bytes)?;
    }

    #[test]
    fn a_valid_file_with_pieces_inserted_and_cut(
        changes in prop::collection::vec((0..BASE.len(), 0..12_usize, pieces()), 1..5),
    ) {
        let mut text: Vec<char> = BASE.chars().collect();
        for (at, cut, piece) in changes {
            let start = at.min(text.len());
            let end = (start + cut).min(text.len());
            text.splice(start..end, piece.chars());
        }
        survive(text.into_iter().collect::<String>().as_bytes())?;
    }

    #[test]
    fn every_expression_of_arithmetic_is_a_number_or_an_error_inside_it(
        tokens in prop::collection::vec(prop::sample::select(vec![
            "1", "2.5", "0", "m", "x", "pi", "+", "-", "*", "/", "^", "(", ")", "sqrt(", "deg(", "tan(", " ", "1e300",
            ".5",
        ]), 1..20),
    ) {
        let expression = tokens.concat();
        let text = BASE.replace("d: 0.4", &format!("d: \"{expression}\""));
        match Reader::new("x.yaml").read(&text) {
            Ok(checked) => prop_assert!(checked.robot.joints[0].row.dh.d.is_finite()),
            Err(report) => {
                prop_assert_eq!(report.diagnostics.len(), 1);
                let quote = text.find("d: \"").unwrap() + 3;
                let inside = quote..quote + expression.len() + 2;
                let span = &report.diagnostics[0].span;
                prop_assert!(inside.start <= span.start && span.end <= inside.end, "{}", report);
                prop_assert!(!span.is_empty());
            }
        }
    }

    #[test]
    fn every_float_survives_its_own_notation(
        value in prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO
    ) {
        for written in [format!("{value:?}"), format!("{value:e}"), format!("{value}")] {
            let text = BASE.replace("d: 0.4", &format!("d: {written}"));
            let checked = Reader::new("x.yaml").read(&text);
            let robot = checked.map_err(|report| TestCaseError::fail(report.to_string()))?.robot;
            prop_assert_eq!(robot.joints[0].row.dh.d, value);
        }
    }
}
