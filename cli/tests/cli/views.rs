//! Every view of four arms: of each the first lines, and a digest of all of it, so that nothing changes unseen. What a
//! view has to say is tested beside its command; here it is only kept.

use std::fmt::Write as _;

use serde_json::Value;

use crate::call::{fine, folder, rne};

/// Lines of a view that a snapshot has.
const LINES: usize = 8;

/// FNV-1a: the same on every machine and with every compiler.
fn digest(text: &str) -> u64 {
    text.bytes().fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3))
}

/// What stands above the matter of a view: the table of the arm, the preamble of a document.
const HEADS: [&str; 2] = [" statements\n\n", "\\begin{document}\n"];

/// The first lines below the head, shortened, how many there are, and the digest of all.
fn beginning(text: &str) -> String {
    let mut shown = String::new();
    let below = HEADS.iter().find_map(|head| Some(text.split_once(head)?.1)).unwrap_or(text);
    for line in below.lines().take(LINES) {
        let end = line.char_indices().nth(100).map_or(line.len(), |(at, _)| at);
        let _ = writeln!(shown, "{}", line[..end].trim_end());
    }
    let _ = writeln!(shown, "-- {} lines, digest {:016x}", text.lines().count(), digest(text));
    shown
}

/// What an object holds: of each key the length of its list, the keys of its object, or its value; then the digest.
fn outline(value: &Value) -> String {
    let mut shown = String::new();
    for (key, value) in value.as_object().expect("an object") {
        let _ = match value {
            Value::Array(all) => writeln!(shown, "{key}: [{}]", all.len()),
            Value::Object(all) if all.len() > 8 => writeln!(shown, "{key}: {{{}}}", all.len()),
            Value::Object(all) => writeln!(shown, "{key}: {{{}}}", all.keys().cloned().collect::<Vec<_>>().join(", ")),
            value => writeln!(shown, "{key}: {value}"),
        };
    }
    let _ = writeln!(shown, "-- digest {:016x}", digest(&value.to_string()));
    shown
}

/// JSON without the version of the program.
fn json(text: &str) -> Value {
    let mut value: Value = serde_json::from_str(text).expect("JSON");
    value.as_object_mut().expect("an object").remove("generator");
    value
}

/// The parts of a page by their ids, in order, and its data.
fn structure(page: &str) -> String {
    let (markup, rest) = page.split_once("id=\"data\">").expect("data");
    let (data, _) = rest.split_once("</script>").expect("the end of the data");
    let (_, body) = markup.split_once("<body").expect("a body");
    let ids: Vec<&str> = body.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    let mut data: Value = serde_json::from_str(data).expect("JSON");
    data.as_object_mut().expect("an object").remove("generator");
    for program in data["programs"].as_object_mut().expect("programs").values_mut() {
        program.as_object_mut().expect("an object").remove("generator");
    }
    format!("ids: {}\n{}", ids.join(" "), outline(&data))
}

fn views(robot: &str, name: &str, state: [&str; 3]) -> String {
    let [q, qd, qdd] = state;
    let q = format!("--q={q}");
    let (qd, qdd) = (format!("--qd={qd}"), format!("--qdd={qdd}"));
    let mut text = String::new();
    let mut view = |call: &[&str], of: fn(&str) -> String| {
        let _ = write!(text, "$ rne {}\n{}\n", call.join(" "), of(&fine(call)));
    };
    view(&["show", robot], beginning);
    view(&["show", robot, "--json"], |text| outline(&json(text)));
    view(&["show", robot, "--equations", "--joint", "1", "--step", "4"], beginning);
    view(&["show", robot, "--symbolic"], beginning);
    view(&["show", robot, "--latex"], beginning);
    view(&["explain", name, robot], beginning);
    let trace = ["eval", robot, &q, &qd, &qdd, "--trace"];
    view(&trace, beginning);
    view(&[&trace[..], &["--csv"]].concat(), beginning);
    view(&["plot", robot], beginning);
    let file = folder("views").join(format!("{robot}.html"));
    let path = file.to_str().expect("UTF-8");
    assert_eq!(rne(&["report", robot, "-o", path]).status, 0);
    let page = std::fs::read_to_string(&file).expect("a page");
    let _ = write!(text, "$ rne report {robot}\n{}", structure(&page));
    text
}

#[test]
fn every_view_of_four_arms() {
    for (robot, name, state) in [
        ("planar1", "n0_1_z", ["0.6", "1.3", "-0.7"]),
        ("planar2", "n0_1_z", ["0.6,-1.1", "1.3,-0.4", "-0.7,2.1"]),
        ("stanford", "f2_3_z", ["0.1,0.2,0.5,0.4,0.5,0.6", "1,2,0.3,-1,-2,0.5", "0.5,-1,0.2,1,0,-3"]),
        ("puma560", "n1_2_x", ["0.1,-0.4,0.3,1.2,-0.7,0.5", "1,2,3,-1,-2,0.5", "0.5,-1,2,1,0,-3"]),
    ] {
        insta::assert_snapshot!(robot, views(robot, name, state));
    }
}
