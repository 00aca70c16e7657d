//! Whatever a robot file calls its robot and its joints, emitted code is the same code, and its documentation has the
//! same parts.

use std::fs;
use std::process::{Command, Stdio};
use std::sync::LazyLock;

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use pulldown_cmark::{Event, Options, Parser};
use quote::ToTokens;
use rne_codegen::{Compiler, Form, Function, Program};
use rne_emit::{Additions, Precision, Prefix};
use rne_model::{Robot, is_control};

/// A robot whose title and joints are to be called otherwise, and its code.
static PLAIN: LazyLock<(Robot, Vec<Program>)> = LazyLock::new(|| {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/planar2.yaml");
    let robot = Robot::from_yaml(&fs::read_to_string(file).expect("a file")).expect("a robot");
    let robot = named(&robot, "title", ["shoulder".to_owned(), "elbow".to_owned()]);
    let programs =
        Function::TORQUES.map(|function| Compiler::new(&robot).compile(function, Form::SevenSteps).expect("a program"));
    (robot, programs.to_vec())
});

/// The reader refuses some of these names; what is emitted does not rely on it.
fn named(robot: &Robot, title: &str, joints: [String; 2]) -> Robot {
    let mut robot = robot.clone();
    robot.title = Some(title.to_owned());
    for (joint, name) in robot.joints.iter_mut().zip(joints) {
        joint.name = name;
    }
    robot
}

fn nasty() -> impl Strategy<Value = String> {
    let pieces = [
        "     let _ = std::fs::write(\"PWNED\", \"x\"); //",
        "    ",
        "\t",
        "```",
        "````",
        "~~~",
        "```rust",
        "`",
        "<img onerror=x>",
        "<!--",
        "-->",
        "<script>",
        "</p>",
        "<https://x.y>",
        "&lt;",
        "&#60;",
        "[a](b)",
        "[a]: b",
        "![x](y)",
        "[^1]",
        "# ",
        "- ",
        "+ ",
        "* ",
        "1. ",
        "12) ",
        "> ",
        "---",
        "===",
        "|",
        "| a |",
        "*a*",
        "__a__",
        "_",
        "~~a~~",
        "$x$",
        "\\",
        "\\\n",
        "\n",
        "\n\n",
        "\r",
        "\r\n",
        "/*",
        "*/",
        "//",
        "*",
        "/",
        "??/",
        "??=",
        "???/",
        "?",
        "??",
        "\u{2028}",
        "\u{2029}",
        "\u{85}",
        "\u{202E}",
        "\u{2066}",
        "\u{200F}",
        "\u{1B}[2J",
        "\u{0}",
        "\"",
        "'",
        "#![doc = \"x\"]",
        "//!",
        "}",
        "{",
        "#include \"x\"",
        "%s",
        "ü",
        "Arm",
        " ",
        ".",
        ":",
    ];
    let piece = prop_oneof![
        4 => prop::sample::select(pieces.to_vec()).prop_map(str::to_owned),
        1 => any::<char>().prop_map(String::from),
    ];
    prop::collection::vec(piece, 0..8).prop_map(|pieces| pieces.concat())
}

/// The documentation of a file, as rustdoc sees it, and the rest of it.
fn parts(text: &str) -> (String, String) {
    let mut file = syn::parse_file(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let line = |attribute: &syn::Attribute| match &attribute.meta {
        syn::Meta::NameValue(syn::MetaNameValue { value: syn::Expr::Lit(literal), .. }) => match &literal.lit {
            syn::Lit::Str(text) => text.value(),
            other => panic!("{other:?}"),
        },
        other => panic!("documentation alone stands at the head: {other:?}"),
    };
    // rustdoc takes one blank from all lines
    let lines: Vec<String> = file.attrs.iter().map(line).collect();
    let documentation = lines.iter().map(|line| line.strip_prefix(' ').unwrap_or(line)).collect::<Vec<_>>().join("\n");
    file.attrs.clear();
    (documentation, file.to_token_stream().to_string())
}

/// What rustdoc turns on.
fn options() -> Options {
    Options::ENABLE_TABLES
        | Options::ENABLE_FOOTNOTES
        | Options::ENABLE_STRIKETHROUGH
        | Options::ENABLE_TASKLISTS
        | Options::ENABLE_SMART_PUNCTUATION
}

/// A page without its words: paragraphs, tables, blocks of code, HTML.
fn structure(documentation: &str) -> Vec<String> {
    let events = Parser::new_ext(documentation, options());
    events.filter(|event| !matches!(event, Event::Text(_))).map(|event| format!("{event:?}")).collect()
}

/// The words of the first paragraph.
fn first_paragraph(documentation: &str) -> String {
    let events = Parser::new_ext(documentation, options() - Options::ENABLE_SMART_PUNCTUATION);
    let inside = events.take_while(|event| !matches!(event, Event::End(_)));
    inside.filter_map(|event| if let Event::Text(words) = event { Some(words.to_string()) } else { None }).collect()
}

/// Emitted C without the comments, which start their lines.
fn code(text: &str) -> Vec<&str> {
    text.lines().filter(|line| !line.trim_start().starts_with("//")).collect()
}

fn c_of(robot: &Robot) -> String {
    let code = rne_emit::c_code(robot, &PLAIN.1, Precision::Double, &Prefix::of(robot)).expect("finite constants");
    code.one_file()
}

/// The constants of the joints in C, and all other lines.
fn constants_of(robot: &Robot) -> (String, String) {
    let (names, prefix) = (Additions { names: true, ..Additions::default() }, Prefix::of(robot));
    let code = rne_emit::c_code_with(robot, &PLAIN.1, Precision::Double, &prefix, &names).expect("finite constants");
    let text = code.one_file();
    let (before, rest) = text.split_once("\n/// Indices of the joints").expect("constants");
    let (constants, after) = rest.split_once("};\n\n").expect("an end");
    (constants.to_owned(), before.to_owned() + after)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: if shipped::is_exhaustive() { 128 } else { 64 },
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn rust_stays_the_same_rust(title in nasty(), shoulder in nasty(), elbow in nasty()) {
        let (plain, programs) = &*PLAIN;
        let robot = named(plain, &title, [shoulder, elbow]);
        let text = rne_emit::rust_file(&robot, programs);
        prop_assert!(!text.chars().any(|c| c != '\n' && is_control(c)), "{text:?}");
        let (documentation, rest) = parts(&text);
        let (plain_documentation, plain_rest) = parts(&rne_emit::rust_file(plain, programs));
        prop_assert_eq!(rest, plain_rest);
        // the fence of a block is as long as it must be, and no event tells
        prop_assert_eq!(structure(&documentation), structure(&plain_documentation), "{}", documentation);
        prop_assert_eq!(
            first_paragraph(&documentation),
            format!("{}: straight-line recursive Newton-Euler.", rne_emit::title(&robot)),
            "{}", documentation
        );
    }

    #[test]
    fn names_of_joints_stay_texts(shoulder in nasty(), elbow in nasty()) {
        let robot = named(&PLAIN.0, "", [shoulder, elbow]);
        let file = syn::parse_file(&rne_emit::rust_joints(&robot)).expect("Rust");
        let Some(syn::Item::Const(names)) = file.items.last() else { panic!("no names") };
        let syn::Expr::Array(names) = &*names.expr else { panic!("no array") };
        let text = |name: &syn::Expr| match name {
            syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(name), .. }) => name.value(),
            other => panic!("{other:?}"),
        };
        let names: Vec<String> = names.elems.iter().map(text).collect();
        prop_assert_eq!(names, robot.joints.iter().map(|joint| joint.name.clone()).collect::<Vec<_>>());
        let (constants, rest) = constants_of(&robot);
        prop_assert_eq!(rest, c_of(&robot));
        // the words of the first comment, the enum's begin, a line for each joint
        prop_assert_eq!(code(&constants).len(), 4, "{}", constants);
    }

    #[test]
    fn a_verbatim_block_is_one_block(text in nasty()) {
        let page = format!("before\n\n{}\n\nafter", rne_emit::verbatim(&text));
        let blank = format!("before\n\n{}\n\nafter", rne_emit::verbatim("x"));
        prop_assert_eq!(structure(&page), structure(&blank), "{}", page);
    }

    #[test]
    fn c_stays_the_same_c(title in nasty(), shoulder in nasty(), elbow in nasty()) {
        let plain = c_of(&PLAIN.0);
        let text = c_of(&named(&PLAIN.0, &title, [shoulder, elbow]));
        prop_assert_eq!(code(&text), code(&plain));
        prop_assert!(!text.chars().any(|c| c != '\n' && is_control(c)), "{text:?}");
        for line in text.lines() {
            prop_assert!(!line.contains('\\') && !line.contains("??"), "{line}");
            prop_assert!(!line.contains("/*") && !line.contains("*/"), "{line}");
        }
    }
}

/// As many titles as a compiler of C takes in one file.
#[test]
fn a_compiler_of_c_has_nothing_to_warn_of() {
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let found = Command::new(&compiler).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    if !found.is_ok_and(|status| status.success()) {
        println!("left out: there is no compiler of C called `{compiler}`; CC names another");
        return;
    }
    let mut runner = TestRunner::deterministic();
    let mut text = String::new();
    for _ in 0..200 {
        let mut any = || nasty().new_tree(&mut runner).expect("a text").current();
        let (title, joints) = (any(), [any(), any()]);
        let file = c_of(&named(&PLAIN.0, &title, joints));
        // the comments alone: the code is the same
        text.extend(file.lines().filter(|line| line.starts_with("//")).flat_map(|line| [line, "\n"]));
    }
    text.push_str(&c_of(&PLAIN.0));
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("inert_texts.c");
    fs::write(&file, text).expect("written");
    let flags = ["-std=c99", "-Wall", "-Wextra", "-Wcomment", "-Wtrigraphs", "-Werror", "-fsyntax-only"];
    let compiled = Command::new(&compiler).args(flags).arg(&file).output().expect("it starts");
    let complaint: String = String::from_utf8_lossy(&compiled.stderr).chars().take(3000).collect();
    assert!(compiled.status.success() && complaint.is_empty(), "{complaint}");
}
