//! What the playground says of texts, beside the text itself and beside what the compiler says elsewhere.

use rne_model::{Reader, Robot};
use rne_playground::{answer, border};
use serde_json::Value;

const PENDULUM: &str = "\
format: 1
name: pendulum
source: a lecture
convention: standard
gravity: [0, -9.81, 0]
joints:
  - {type: revolute, dh: {theta: 0, d: 0, a: 0.5, alpha: 0}, link: {mass: 2, inertia: {yy: 0.1, zz: 0.1}}}
";

/// The characters of a text between two places of a diagnostic, by counting them.
fn underlined(text: &str, found: &Value) -> String {
    let place = |line: &str, column: &str| {
        let number = |name: &str| usize::try_from(found[name].as_u64().expect("a number")).expect("a small one");
        (number(line), number(column))
    };
    let (start, end) = (place("line", "column"), place("end_line", "end_column"));
    let mut at = (1, 1);
    let mut between = String::new();
    for c in text.chars() {
        if start <= at && at < end {
            between.push(c);
        }
        at = if c == '\n' { (at.0 + 1, 1) } else { (at.0, at.1 + 1) };
    }
    between
}

fn first(answer: &Value) -> &Value {
    &answer["diagnostics"][0]
}

/// What goes over the border, as a page has it.
fn over_the_border(text: &[u8]) -> String {
    border::clear();
    for byte in text {
        border::push(u32::from(*byte));
    }
    let length = border::compile();
    let words = (0..length.div_ceil(4)).map(|index| border::word(index));
    let mut bytes: Vec<u8> = words.flat_map(u32::to_le_bytes).collect();
    assert!(bytes[length..].iter().all(|byte| *byte == 0));
    bytes.truncate(length);
    String::from_utf8(bytes).expect("UTF-8")
}

#[test]
fn a_mistake_is_underlined_where_it_stands() {
    let wrong = PENDULUM.replace("mass", "masss");
    let said = answer(&wrong);
    let found = first(&said);
    assert_eq!(underlined(&wrong, found), "masss");
    assert_eq!((found["line"].as_u64(), found["column"].as_u64()), (Some(7), Some(69)));
    assert_eq!((found["end_line"].as_u64(), found["end_column"].as_u64()), (Some(7), Some(74)));
    assert_eq!(found["severity"], "error");
    assert_eq!(found["help"], "did you mean `mass`?");
    assert!(found["message"].as_str().is_some_and(|message| message.starts_with("unknown key `masss`")), "{found}");
    assert!(said.get("page").is_none());
}

#[test]
fn columns_are_characters_whatever_their_bytes() {
    let wrong = PENDULUM.replace("{type: revolute", "{name: \"\u{1f916}\u{e4}\", tpye: revolute");
    let found = &answer(&wrong)["diagnostics"];
    let found = found.as_array().expect("a list").iter().find(|found| underlined(&wrong, found) == "tpye");
    assert!(found.is_some_and(|found| found["column"] == 18), "{found:?}");
}

/// Every diagnostic of a text with many of them, beside the report that the command line renders.
#[test]
fn all_that_is_found_is_said() {
    let wrong =
        PENDULUM.replace("gravity: [0, -9.81, 0]", "gravity: [0, down]\nnames: 3").replace("standard", "classic");
    let report = Reader::new("any").read(&wrong).expect_err("it is wrong");
    let said = answer(&wrong);
    let said = said["diagnostics"].as_array().expect("a list");
    assert!(said.len() >= 3 && said.len() == report.diagnostics.len(), "{said:?}");
    for (said, found) in said.iter().zip(&report.diagnostics) {
        assert_eq!(said["message"], found.message);
        assert_eq!(underlined(&wrong, said), wrong[found.span.clone()], "{said}");
    }
}

#[test]
fn a_remark_stands_beside_the_page() {
    let odd = PENDULUM.replace("zz: 0.1", "zz: 0.3");
    // a published table says that no body has its inertia
    let published = odd.replace("zz: 0.3}", "zz: 0.3}, physical: false");
    assert!(published != odd);
    for (odd, severity) in [(odd, "warning"), (published, "note")] {
        let said = answer(&odd);
        assert!(said["page"].is_string());
        assert_eq!(first(&said)["severity"], severity, "{}", said["diagnostics"]);
        assert_eq!(underlined(&odd, first(&said)), "{yy: 0.1, zz: 0.3}");
    }
}

#[test]
fn every_shipped_robot_has_the_page_of_its_report() {
    for file in rne_robots::ROBOTS {
        let robot = Robot::from_yaml(file.yaml).expect("it is shipped");
        let said = answer(file.yaml);
        let page = rne_report::page(&robot, None).expect("it compiles");
        assert_eq!(said["page"].as_str(), Some(page.as_str()), "{}", file.name);
    }
}

#[test]
fn the_border_carries_what_is_answered() {
    let odd = PENDULUM.replace("a lecture", "\u{c4}rm \u{1f916}");
    // an answer of each remainder of four
    for text in [PENDULUM, odd.as_str(), "", "a", "ab", "abc", "abcd", "format: 3"] {
        assert_eq!(over_the_border(text.as_bytes()), answer(text).to_string(), "{text}");
    }
    assert_eq!(border::word(usize::MAX), 0);
}

#[test]
fn no_text_stops_the_compiler() {
    for text in
        ["", "\0", "- - - -", "{", "&a *a", "\t", "joints: &a [*a]", "\u{feff}format: 1", "<robot/>", "%YAML 9.9"]
    {
        let said = answer(text);
        assert!(said["diagnostics"].as_array().is_some_and(|all| !all.is_empty()), "{text:?}");
    }
    let said: Value = serde_json::from_str(&over_the_border(b"name: \xff\xfe")).expect("JSON");
    assert!(said["diagnostics"].as_array().is_some_and(|all| !all.is_empty()));
    let _ = answer(&"[".repeat(100_000));
    let _ = answer(&"joints:\n".repeat(10_000));
}
