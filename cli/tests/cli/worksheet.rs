//! `rne eval --trace`: worksheets for reading, as files, and beside somebody's own.

use std::fs;

use serde_json::Value;
use unicode_width::UnicodeWidthStr as _;

use crate::call::{Called, fails, fine, folder, rne, rne_reading};

const PLANAR2: [&str; 9] =
    ["eval", "robots/planar2.yaml", "--q", "0.6,-1.1", "--qd", "1.3,-0.4", "--qdd", "-0.7,2.1", "--trace"];

fn planar2<'a>(more: &[&'a str]) -> Vec<&'a str> {
    PLANAR2.into_iter().chain(more.iter().copied()).collect()
}

/// A state of a robot with so many joints.
fn of<'a>(robot: &'a str, q: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    ["eval", robot, "--q", q, "--qd", "1,2,3,-1,-2,0.5", "--qdd", "0.5,-1,2,1,0,-3", "--trace"]
        .into_iter()
        .chain(more.iter().copied())
        .collect()
}

const STANFORD: (&str, &str) = ("robots/stanford.yaml", "0.1,0.2,0.5,0.4,0.5,0.6");
const PUMA: (&str, &str) = ("robots/puma560.yaml", "0.1,-0.4,0.3,1.2,-0.7,0.5");

#[test]
fn worksheets_for_reading() {
    insta::assert_snapshot!("planar2_joint_axes", fine(&planar2(&["--axes", "joint"])));
    let stanford = |more: &[&'static str]| fine(&of(STANFORD.0, STANFORD.1, more));
    insta::assert_snapshot!("stanford_base_axes_joint_3", stanford(&["--axes", "base", "--joint", "3"]));
    let puma = |more: &[&'static str]| fine(&of(PUMA.0, PUMA.1, more));
    insta::assert_snapshot!("puma560_link_axes_joint_3", puma(&["--joint", "3"]));
    insta::assert_snapshot!("puma560_step_4", puma(&["--step", "4"]));
    assert_eq!(stanford(&["--axes", "lecture"]), stanford(&["--axes", "joint"]), "the lecture's are the joint's");
    for axes in ["link", "joint", "base"] {
        for text in [stanford(&["--axes", axes]), puma(&["--axes", axes])] {
            for line in text.lines() {
                assert!(line.width() <= 80 && line == line.trim_end(), "{}: {line:?}", line.width());
            }
        }
    }
}

#[test]
fn narrower_worksheets_are_lines_of_the_whole_one() {
    let csv = |more: &[&'static str]| fine(&of(STANFORD.0, STANFORD.1, &[&["--csv"], more].concat()));
    let whole = csv(&[]);
    let (joint, step, both) = (csv(&["--joint", "2"]), csv(&["--step", "6"]), csv(&["--joint", "2", "--step", "6"]));
    let rows = |text: &str| text.lines().skip(2).map(str::to_owned).collect::<Vec<_>>();
    let of = |start: &str| rows(&whole).into_iter().filter(|row| row.starts_with(start)).collect::<Vec<_>>();
    assert_eq!(rows(&joint), of("2,"));
    assert_eq!(rows(&both), of("2,6,"));
    assert_eq!(rows(&step).len(), 6 * of("2,6,").len());
    assert_eq!(of("2,6,").len(), 18);
    fails(2, &of_stanford(&["--joint", "7"]), &["stanford has no joint 7"]);
    fails(2, &of_stanford(&["--step", "8"]), &["the steps are"]);
}

fn of_stanford<'a>(more: &[&'a str]) -> Vec<&'a str> {
    of(STANFORD.0, STANFORD.1, more)
}

#[test]
fn csv_and_json_have_the_same_rows() {
    let csv = fine(&planar2(&["--csv", "--axes", "base"]));
    insta::assert_snapshot!("planar2_csv_head", csv.lines().take(24).collect::<Vec<_>>().join("\n"));
    let json: Value = serde_json::from_str(&fine(&planar2(&["--json", "--axes", "base"]))).expect("JSON");
    let rows = json["trace"]["rows"].as_array().expect("rows");
    let lines: Vec<&str> = csv.lines().skip(2).collect();
    assert_eq!(rows.len(), lines.len());
    for (row, line) in rows.iter().zip(lines) {
        let cells: Vec<&str> = line.split(',').collect();
        let keys = ["joint", "step", "quantity", "component", "value", "unit", "frame"];
        for (key, cell) in keys.into_iter().zip(cells) {
            match &row[key] {
                Value::String(text) => assert_eq!(text, cell),
                number => {
                    let (a, b) = (number.as_f64().expect("a number"), cell.parse::<f64>().expect("a number"));
                    assert!((a - b).abs() <= 1e-15 * b.abs(), "{key}: {number} is not {cell}");
                }
            }
        }
    }
}

fn compared(text: &str, more: &[&str]) -> Called {
    rne_reading(&planar2(&[&["--compare", "-"], more].concat()), text)
}

#[test]
fn what_is_printed_agrees() {
    for axes in ["link", "joint", "base"] {
        for shape in ["--csv", "--json"] {
            let mine = fine(&planar2(&[shape, "--axes", axes]));
            // the file knows its axes
            for more in [&["--axes", axes][..], &[]] {
                let called = compared(&mine, more);
                assert_eq!((called.status, called.err.as_str()), (0, ""), "{called:?}");
                assert!(called.out.starts_with("ok ") && called.out.contains("all agree to 4 digits"), "{called:?}");
            }
        }
    }
    // spreadsheets: another order of columns, a column of one's own, quotes, CRLF, semicolons, joints by name
    let mine = "\u{feff}quantity;value;joint;component;remark\r\n\"tau\";12.37;j1;;\"by \"\"hand\"\"\"\r\n\
                omega;0.9;2;z;\r\n# mine\r\n\r\nomega;;1;z;later\r\n";
    let called = compared(mine, &[]);
    assert_eq!(
        called.out,
        "ok 2 values of planar2 compared, all agree to 4 digits; not given: steps 2, 3,\n   4, 5 and 6\n"
    );
    // a list of rows is enough of JSON
    let mine = r#"[{"joint": 1, "quantity": "tau", "value": 12.366}, {"joint": 2, "quantity": "tau", "value": 2.421}]"#;
    let called = compared(mine, &["--json"]);
    let reply: Value = serde_json::from_str(&called.out).expect("JSON");
    assert_eq!((&reply["agrees"], &reply["compared"], called.status), (&true.into(), &2.into(), 0), "{reply}");
}

/// A term of c̈2 is left out, and what is behind it follows.
#[test]
fn the_first_difference_reads_well() {
    let csv = fine(&planar2(&["--csv"]));
    // c̈2 without ω2 × (ω2 × d2)
    let wrong = csv.replace("2,4,acceleration,x,-0.23336", "2,4,acceleration,x,-0.07136");
    assert_ne!(wrong, csv);
    let called = compared(&wrong.replace("2,6,inertia_force,x,-0.35", "2,6,inertia_force,x,-0.10"), &[]);
    assert_eq!((called.status, called.err.as_str()), (1, ""));
    insta::assert_snapshot!("a_missing_term", called.out);
    let json: Value = serde_json::from_str(&compared(&wrong, &["--json"]).out).expect("JSON");
    let first = &json["first"];
    assert_eq!((&first["quantity"], &first["component"]), (&"acceleration".into(), &"x".into()), "{json}");
    assert_eq!(first["reasons"][0]["says"], "the term ω2 × (ω2 × d2) is left out");
    // another state, and a payload that nobody said anything of
    let called = compared("joint,quantity,value\n1,q,0.7\n", &[]);
    assert!(called.out.contains("q1: given") && called.out.contains("for another state than"), "{}", called.out);
    let payload: Vec<&str> = planar2(&["--payload", "2,0.1,0,0", "--csv"]);
    let called = compared(&fine(&payload), &[]);
    assert!(called.out.contains("step 6, joint 2 (j2), f2,3, component x"), "{}", called.out);
    // gravity upwards, in torques alone
    let mine = "joint,quantity,value\n1,tau,-13.2\n2,tau,-2.41\n";
    let torques = fine(&["eval", "robots/planar2.yaml", "--q", "0.6,-1.1", "--qd", "1.3,-0.4", "--qdd", "-0.7,2.1"]);
    assert!(torques.contains("12.366"));
    let called = compared(mine, &[]);
    assert_eq!(called.status, 1);
    assert!(called.out.contains("step 7, joint 2"), "the way back begins at the tip: {}", called.out);
}

/// What a slip does to all values is told first; torques alone are a worksheet too.
#[test]
fn slips_are_named() {
    let up = folder("worksheet").join("up.yaml");
    let text = fs::read_to_string(format!("{}/robots/planar2.yaml", crate::call::ROOT)).expect("a robot");
    fs::write(&up, text.replace("gravity: [0, -9.81, 0]", "gravity: [0, 9.81, 0]")).expect("a file");
    let path = up.to_str().expect("UTF-8");
    let wrong: Vec<&str> = PLANAR2.iter().map(|word| if word.starts_with("robots/") { path } else { word }).collect();
    let mine = fine(&[&wrong[..], &["--csv"]].concat());
    let called = compared(&mine, &[]);
    assert_eq!(called.status, 1);
    assert!(called.out.contains("step 5, joint 1 (j1), g1, component x"), "{}", called.out);
    assert!(
        called.out.contains("all your values are right except for this: gravity points the other way"),
        "{}",
        called.out
    );
    let torques: String = mine
        .lines()
        .filter(|line| line.starts_with("joint") || line.contains(",tau,"))
        .fold(String::new(), |text, line| text + line + "\n");
    let called = compared(&torques, &[]);
    assert!(called.out.contains("gravity points the other way"), "{}", called.out);
}

const HEAD: &str = "joint,step,quantity,component,value,unit,frame\n";

/// What is wrong with a file, where, and what to do.
#[test]
fn files_that_are_no_worksheets() {
    let bad = |text: &str, parts: &[&str]| {
        let called = compared(text, &[]);
        assert_eq!((called.status, called.out.as_str()), (1, ""), "{called:?}");
        for part in parts {
            assert!(called.err.contains(part), "{text:?}: no `{part}` in {}", called.err);
        }
    };
    let row = |row: &str, parts: &[&str]| bad(&format!("{HEAD}1,1,omega,z,1.3,rad/s,link\n{row}\n"), parts);
    bad("", &["the file is empty", "the header is `joint,step,quantity"]);
    bad(HEAD, &["has no value to compare"]);
    bad("1,omega,z,1.3\n", &["there is no column `joint`"]);
    bad("joint,quantty,value\n1,tau,2\n", &["<standard input>:1:7", "did you mean `quantity`?"]);
    bad("joint,quantity,value,value\n1,tau,2,3\n", &["`value` occurs twice"]);
    row(
        "1,2,omega_dt,z,1,rad/s²,link",
        &[":3:5", "`omega_dt`", "did you mean `omega_dot`?", "the quantities are q, qd"],
    );
    row("1,2,omega_dot,w,1,rad/s²,link", &[":3:15", "has no component `w`", "x, y, z"]);
    row("1,2,omega_dot,,1,rad/s²,link", &["the component of omega_dot is missing"]);
    row("1,7,tau,z,1,N m,", &["tau has no component `z`", "tau is one number: leave the component empty"]);
    row("3,2,omega_dot,x,1,rad/s²,link", &[":3:1", "`3` is not a joint of planar2", "1 to 2"]);
    row("j3,2,omega_dot,x,1,rad/s²,link", &["did you mean `j1`?"]);
    row("1,3,omega_dot,x,1,rad/s²,link", &[":3:3", "omega_dot is computed by step 2, not by step `3`"]);
    row("1,2,omega_dot,x,1,deg/s²,link", &["omega_dot of joint 1 is in rad/s², not in `deg/s²`", "deg(30)"]);
    row(
        "1,2,omega_dot,x,1,rad/s^2,base",
        &["this value is in base axes, but the comparison is in link axes", "--axes base"],
    );
    row("1,2,omega_dot,x,1,rad/s2,lonk", &["`lonk` is not a name of axes", "`lecture`"]);
    row("1,1,omega,z,1.3,rad/s,link", &[":3:1", "omega z of joint 1 is given twice; first on line 2"]);
    row("1,1,omega,z,1,,\n1,1,omega,z,1,,", &[":3:1", ":4:1", "first on line 2"]);
    bad(&(HEAD.to_owned() + &"1,7,tau,,1,,\n".repeat(1000)), &["more rows than a worksheet of planar2 has"]);
    for number in ["nan", "inf", "1e999", "O.5", "1/0"] {
        row(&format!("1,2,omega_dot,x,{number},rad/s²,link"), &[":3:17", "is not a number"]);
    }
    row("1,2,omega_dot,x,0,5,rad/s²,link", &["the line has 8 cells, but the header has 7 columns", "decimal point"]);
    row("1,2,\"omega_dot,x,0", &["this quote is not closed"]);
    row("1,0,orientation,xx,1,,", &["a worksheet in link axes has no orientation"]);
    bad("# rne worksheet, format 2, robot planar2\njoint,quantity,value\n1,tau,1\n", &[":1:1", "reads format 1"]);
    bad("# rne worksheet, format 1, robot panda\njoint,quantity,value\n1,tau,1\n", &["is for `panda`"]);
    // every mistake at once
    row("9,1,omega,x,1,,\n1,1,omga,x,1,,", &[":3:1", ":4:5"]);
    bad("{\"rows\": 3}", &["this is not a worksheet"]);
    bad("{\"row\": []}", &["no key `rows`"]);
    bad("[{\"joint\": 1, \"quantity\": \"tau\", \"value\": NaN}]", &["<standard input>:1:", "JSON has no NaN"]);
    bad("[\n {\"joint\": 1, \"quantity\": \"tao\", \"value\": 1}]", &[":2:27", "did you mean `tau`?"]);
    bad("[{\"joint\": 1, \"value\": 1}]", &["this row has no `quantity`"]);
    bad("{\"format\": 7, \"rows\": []}", &["has format 7"]);
    let file = folder("worksheets").join("mine.csv");
    fs::write(&file, b"joint,quantity,value,unit\n1,omega_dot,1,rad/s\x81\n").expect("a file");
    let path = file.to_str().expect("UTF-8");
    fails(1, &planar2(&["--compare", path]), &["mine.csv:2:20", "byte 0x81 is not UTF-8", "CSV UTF-8"]);
    fails(1, &planar2(&["--compare", "nowhere.csv"]), &["the worksheet nowhere.csv cannot be read"]);
    fails(1, &planar2(&["--compare", "robots"]), &["cannot be read"]);
    fails(2, &planar2(&["--compare", path, "--csv"]), &["cannot be used with"]);
    fails(2, &planar2(&["--digits", "3"]), &["--compare"]);
    assert_eq!(rne(&["eval", "robots/planar2.yaml", "--q", "0,0", "--qd", "0,0", "--qdd", "0,0", "--csv"]).status, 2);
}

/// Tables as other programs write them.
#[test]
fn separators_are_found_or_named() {
    let call = ["eval", "planar1", "--q", "0.3", "--qd", "0.5", "--qdd", "1", "--trace"];
    let sheet = fine(&[&call[..], &["--csv"]].concat());
    let compared = |text: &str| rne_reading(&[&call[..], &["--compare", "-"]].concat(), text);
    assert_eq!(compared(&sheet).status, 0);
    let table = sheet.lines().skip(1).collect::<Vec<_>>().join("\n");
    assert_eq!(compared(&table.replace(',', ";")).status, 0);
    let Called { err, status, .. } = compared(&table.replace(',', "\t"));
    assert!(status == 1 && err.contains("separated by tabs") && err.contains("no column `joint`"), "{err}");
}
