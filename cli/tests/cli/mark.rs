//! `rne worksheet` and `rne mark`: worksheets of a class, filled in by closed forms, and marked.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::call::{Called, fails, fine, folder, rne};

/// Mass, length and gravity of `planar1`.
const M: f64 = 2.0;
const A: f64 = 0.5;
const G: f64 = 9.81;

/// The numbers of a pendulum's worksheet that somebody computes.
struct Pendulum {
    omega: f64,
    omega_dot: f64,
    acceleration: [f64; 2],
    tau: f64,
}

impl Pendulum {
    /// A slender bar about its end: c̈ = (-a/2 θ̇², a/2 θ̈), τ = m a²/3 θ̈ + m g a/2 cos θ.
    fn at([q, qd, qdd]: [f64; 3]) -> Self {
        let tau = M * A * A / 3.0 * qdd + M * G * A / 2.0 * q.cos();
        Self { omega: qd, omega_dot: qdd, acceleration: [-A / 2.0 * qd * qd, A / 2.0 * qdd], tau }
    }
}

/// A mistake of a student, and what the mark says of it.
type Mistake = (fn(&mut Pendulum, [f64; 3]), u64, Option<(&'static str, u64)>, &'static str);

/// Mistakes that students make; points of the 5 values that are not always zero, the first wrong quantity with its
/// step, and the likely cause.
const MISTAKES: [Mistake; 8] = [
    (|_, _| {}, 5, None, ""),
    (|all, _| all.acceleration[0] = 0.0, 4, Some(("acceleration", 4)), "the term ω1 × (ω1 × d1) is left out"),
    (|all, _| all.acceleration[0] *= -1.0, 4, Some(("acceleration", 4)), "the term ω1 × (ω1 × d1) has the other sign"),
    (|all, _| all.omega *= 180.0 / std::f64::consts::PI, 4, Some(("omega", 1)), "in degrees"),
    (|all, _| all.omega_dot *= -1.0, 4, Some(("omega_dot", 2)), "sign"),
    (|all, [q, ..]| all.tau -= M * G * A * q.cos(), 4, Some(("tau", 7)), "gravity points the other way"),
    (|all, [.., qdd]| all.tau -= M * A * A / 4.0 * qdd, 4, Some(("tau", 7)), ""),
    (|all, _| all.acceleration.swap(0, 1), 3, Some(("acceleration", 4)), "two components are exchanged: y, x, z"),
];

/// Fills in the rows of a blank worksheet; every other one with commas and semicolons as a German spreadsheet.
fn filled(blank: &str, mistake: fn(&mut Pendulum, [f64; 3])) -> String {
    // the numbers of the arm stand above the header
    assert!(blank.contains("\n# link 1: m = ") && blank.contains("# acceleration of gravity in frame 0: "), "{blank}");
    let header = blank.lines().find(|line| line.starts_with("joint")).expect("a header");
    let separator = if header.contains(';') { ';' } else { ',' };
    let cells = |line: &str| line.split(separator).map(str::to_owned).collect::<Vec<_>>();
    let given = |quantity: &str| {
        let row = blank.lines().map(cells).find(|row| row.len() == 7 && row[2] == quantity).expect("a row");
        row[4].replace(',', ".").parse::<f64>().expect("a number")
    };
    let state = ["q", "qd", "qdd"].map(given);
    assert!(state.iter().all(|number| *number != 0.0), "{state:?}");
    let mut all = Pendulum::at(state);
    mistake(&mut all, state);
    let mut text = String::new();
    for line in blank.lines() {
        let mut row = cells(line);
        if row.len() == 7 && row[4].is_empty() {
            let value = match (row[2].as_str(), row[3].as_str()) {
                ("omega", "z") => all.omega,
                ("omega_dot", "z") => all.omega_dot,
                ("acceleration", "x") => all.acceleration[0],
                ("acceleration", "y") => all.acceleration[1],
                ("tau", _) => all.tau,
                _ => 0.0,
            };
            let value = format!("{value:.5}");
            row[4] = if separator == ';' { value.replace('.', ",") } else { value };
        }
        text += &row.join(separator.encode_utf8(&mut [0; 4]));
        text.push('\n');
    }
    text
}

fn path(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// A class of forty with numbers of their own, in two folders: with a decimal point and with a comma.
fn class(name: &str) -> Vec<PathBuf> {
    let folder = folder(name);
    let students: Vec<String> = (1..=40).map(|number| format!("student {number:02}")).collect();
    let mut files = Vec::new();
    for (half, comma) in [(&students[..20], &[][..]), (&students[20..], &["--decimal-comma"])] {
        let sheets = folder.join(if comma.is_empty() { "point" } else { "comma" });
        let mut words = vec!["worksheet", "planar1", "--seed", "11", "--step", "1,2,4,7", "-o", path(&sheets)];
        words.extend(comma);
        words.extend(half.iter().map(String::as_str));
        let called = rne(&words);
        assert_eq!((called.status, called.out.as_str()), (0, ""), "{called:?}");
        files.extend(half.iter().map(|student| sheets.join(format!("{student}.csv"))));
    }
    files
}

fn marked(files: &[PathBuf], more: &[&str]) -> Called {
    let mut words = vec!["mark", "planar1", "--seed", "11", "--step", "1,2,4,7"];
    words.extend(files.iter().map(|file| path(file)));
    words.extend(more);
    rne(&words)
}

#[test]
fn forty_worksheets_are_marked_by_one_command() {
    let files = class("mark_forty");
    let mut states = std::collections::BTreeSet::new();
    for (index, file) in files.iter().enumerate() {
        let blank = fs::read_to_string(file).expect("a worksheet");
        states.insert(blank.lines().filter(|line| line.contains("qd")).collect::<String>());
        fs::write(file, filled(&blank, MISTAKES[index % MISTAKES.len()].0)).expect("a file");
    }
    assert!(states.len() > 30, "each has numbers of their own: {}", states.len());
    let called = marked(&files, &["--json"]);
    assert_eq!((called.status, called.err.as_str()), (0, ""), "{called:?}");
    let reply: Value = serde_json::from_str(&called.out).expect("JSON");
    let marks = reply["marks"].as_array().expect("marks");
    assert_eq!((marks.len(), &reply["of"]), (40, &5.into()));
    for (index, mark) in marks.iter().enumerate() {
        let (_, points, first, cause) = &MISTAKES[index % MISTAKES.len()];
        assert_eq!(mark["student"], format!("student {:02}", index + 1));
        assert_eq!(mark["points"], *points, "{mark}");
        match first {
            None => assert!(mark["first_error"].is_null(), "{mark}"),
            Some((quantity, step)) => {
                assert_eq!(
                    (&mark["first_error"]["quantity"], &mark["first_error"]["step"]),
                    (&(*quantity).into(), &(*step).into()),
                    "{mark}"
                );
                let said = mark["first_error"]["cause"].as_str().unwrap_or_default();
                assert!(said.contains(cause), "{mark}");
            }
        }
    }
    // the table: a line for each student, and the causes that several share
    let table = marked(&files, &[]).out;
    assert!(
        table.starts_with("student     points  first error") && table.contains("\n  5 × gravity points the other way"),
        "{table}"
    );
    assert_eq!(table.matches("5/5  none").count(), 5, "{table}");
    let csv = marked(&files, &["--csv"]).out;
    assert_eq!(csv.lines().count(), 41);
    assert_eq!(csv.lines().filter(|line| line.contains(",5,5,0,0,,,")).count(), 5, "{csv}");
}

/// `--hint` has the place and the cause, and nowhere the right value.
#[test]
fn hints_have_no_answer() {
    let files = class("mark_hint");
    let file = &files[..1];
    let blank = fs::read_to_string(&file[0]).expect("a worksheet");
    let right = filled(&blank, |_, _| {});
    let value = right.lines().find(|line| line.contains("acceleration,x")).and_then(|line| line.split(',').nth(4));
    let value = value.expect("a value").trim_end_matches('0').to_owned();
    fs::write(&file[0], filled(&blank, MISTAKES[1].0)).expect("a file");
    for shape in [&[][..], &["--json"], &["--csv"]] {
        let told = marked(file, shape).out;
        assert!(told.contains(&value), "{told}");
        let hint = marked(file, &[shape, &["--hint"]].concat()).out;
        assert!(!hint.contains(&value) && hint.contains("ω1 × (ω1 × d1) is left out"), "{hint}");
    }
    let compare = |more: &[&str]| {
        let call = [
            "eval",
            "planar1",
            "--q",
            "0.3",
            "--qd",
            "0.5",
            "--qdd",
            "1",
            "--trace",
            "--compare",
            "docs/teaching/lecture/class/bob.csv",
        ];
        let called = rne(&[&call, more].concat());
        assert_eq!((called.status, called.err.as_str()), (1, ""));
        called.out
    };
    for shape in [&[][..], &["--json"]] {
        let (told, hint) = (compare(shape), compare(&[shape, &["--hint"]].concat()));
        assert!(told.contains("-0.0625") && !hint.contains("0625"), "{hint}");
        assert!(hint.contains("ω1 × (ω1 × d1) is left out"), "{hint}");
    }
    fails(2, &["eval", "planar1", "--q", "0", "--trace", "--hint"], &["--compare"]);
}

/// A file that cannot be read is refused at its line; the others are marked.
#[test]
fn hostile_files_are_refused_at_their_line() {
    let files = class("mark_hostile");
    let blank = fs::read_to_string(&files[0]).expect("a worksheet");
    fs::write(&files[0], filled(&blank, |_, _| {})).expect("a file");
    let bad: [(&[u8], &str); 9] = [
        (b"", "the file is empty"),
        (b"joint,quantity,value\n1,tau,=1+1\n", ".csv:2:7"),
        (b"joint,quantity,value\n1,tau,nan\n", ".csv:2:7"),
        (b"joint,quantity,component,value\n1,omega,z,1\n1,omega,z,2\n", ".csv:3:1"),
        (b"joint,quantity,value\n99,tau,1\n", ".csv:2:1"),
        (b"joint,quantity,value\n1,t\x81,1\n", ".csv:2:4"),
        (b"joint,quantity,value\n1,tau,\"1\n", ".csv:2:7"),
        (b"{\"rows\": [[[[", ".csv:1:"),
        (b"# rne worksheet, format 1, robot panda\njoint,quantity,value\n1,tau,1\n", ".csv:1:1"),
    ];
    for ((text, _), file) in bad.iter().zip(&files[1..]) {
        fs::write(file, text).expect("a file");
    }
    let mut long = b"joint,quantity,value\n".to_vec();
    long.resize(5 << 20, b'x');
    fs::write(&files[10], long).expect("a file");
    let called = marked(&files[..11], &["--json"]);
    assert_eq!(called.status, 1, "{called:?}");
    for (_, place) in bad {
        assert!(called.said().contains(place), "no {place} in {}", called.err);
    }
    let reply: Value = serde_json::from_str(&called.out).expect("JSON");
    let marks = reply["marks"].as_array().expect("marks");
    assert_eq!((&marks[0]["points"], marks.len()), (&5.into(), 11));
    for mark in &marks[1..] {
        assert!(mark["points"].is_null() && mark["refused"].is_string(), "{mark}");
    }
    // the name that a file gives is no formula of a spreadsheet and no code of a terminal
    let text = "# rne worksheet, format 1, robot planar1, student =1+1\u{1b}[31m\njoint,quantity,value\n1,tau,1\n";
    fs::write(&files[0], text).expect("a file");
    let (csv, table) = (marked(&files[..1], &["--csv"]).out, marked(&files[..1], &[]).out);
    assert!(csv.contains("\n'=1+1"), "{csv}");
    assert!(table.contains("=1+1\\u{1b}[31m") && !table.contains('\u{1b}'), "{table}");
    // a worksheet that two hand in
    let twice = [files[0].clone(), files[0].clone()];
    assert!(marked(&twice, &[]).said().contains("has several files"));
}

/// Files of states, one for everybody or a row for each.
#[test]
fn states_of_a_class() {
    let folder = folder("mark_states");
    let key = folder.join("key.csv");
    let with = |text: &str| {
        fs::write(&key, text).expect("a file");
        rne(&[
            "mark",
            "planar1",
            "--states",
            path(&key),
            "docs/teaching/lecture/class/ada.csv",
            "docs/teaching/lecture/class/carl.csv",
        ])
    };
    let one = with("q1,qd1,qdd1\n0.3,0.5,1\n");
    assert!(one.status == 0 && one.out.contains("ada       14/14"), "{one:?}");
    let each = with("name;q1;qd1;qdd1\nada;0,3;0,5;1\ncarl;0,3;0,5;pi/2\n");
    assert!(each.out.contains("14/14  none") && each.out.contains("the worksheet is for another state"), "{each:?}");
    let unknown = with("name,q1\nada,0.3\ncarla,0.3\n");
    assert!(unknown.status == 1 && unknown.err.contains("no row for the student `carl`; did you mean `carla`?"));
    for (text, parts) in [
        ("", &["the file is empty"][..]),
        ("q1,qd1\n", &["no state below"]),
        ("q2\n1\n", &["the key is for an arm of 2 joints; planar1 has 1"]),
        ("q1\tqd1\n1\t2\n", &["separated by tabs"]),
        ("q1\n0.3\n0.4\n", &[":3:1", "no column `name`"]),
        ("q1,q1\n1,1\n", &[":1:4", "occurs twice"]),
        ("name,q1\nada,1\nada,2\n", &[":3:1", "`ada` occurs twice"]),
        ("name,q1\n,1\n", &[":2:1", "the name of the student is missing"]),
        ("q1\nO.3\n", &[":2:1", "is not a number"]),
        ("q1,qd1\n0,3,0,5\n", &[":2:1", "4 cells, but 2 columns", "semicolons"]),
    ] {
        let called = with(text);
        assert_eq!((called.status, called.out.as_str()), (1, ""), "{text:?}: {called:?}");
        for part in parts {
            assert!(called.said().contains(part), "{text:?}: no {part} in {}", called.err);
        }
    }
    fails(2, &["mark", "planar1", "docs/teaching/lecture/class/ada.csv"], &["--states <KEY>|--seed <N>"]);
    // names of students are those of the file of states
    fs::write(&key, "name,q1\nada,0.3\nbo b,0.4\n").expect("a file");
    let sheets = folder.join("sheets");
    let written = ["worksheet", "planar1", "--states", path(&key), "-o", path(&sheets)];
    assert_eq!(rne(&written).status, 0);
    assert!(fs::read_to_string(sheets.join("bo b.csv")).expect("a file").contains("\n1,0,q,,0.4,rad,\n"));
    // nothing is overwritten, and no name leads out of the folder
    fails(2, &written, &["is not empty and is not changed"]);
    for name in ["../ada", "a/b", ".ada", "ada,bob", "", "-", "a\nb"] {
        let out = folder.join("no");
        fails(2, &["worksheet", "planar1", "--seed", "1", "-o", path(&out), "--", name], &["cannot be the name"]);
        assert!(!out.exists());
    }
    let twice = ["worksheet", "planar1", "--seed", "1", "-o", "nowhere", "ada", "Ada"];
    fails(2, &twice, &["`Ada` is named twice"]);
    fails(2, &["worksheet", "planar1", "--seed", "1", "-o", "nowhere"], &["no student is named"]);
}

/// Answers of a worksheet are right, in all axes and with a decimal comma.
#[test]
fn answers_have_all_points() {
    for axes in ["link", "joint", "base"] {
        for comma in [&[][..], &["--decimal-comma"]] {
            let sheets = folder("mark_answers").join("sheets");
            let words =
                ["worksheet", "stanford", "--seed", "3", "--answers", "--axes", axes, "ada", "-o", path(&sheets)];
            assert_eq!(rne(&[&words, comma].concat()).status, 0);
            let table = fine(&["mark", "stanford", "--seed", "3", path(&sheets.join("ada.csv"))]);
            let points = table.lines().nth(1).and_then(|line| line.split_whitespace().nth(1)).unwrap_or_default();
            let (points, of) = points.split_once('/').expect("points");
            assert!(points == of && of.len() == 3 && table.contains("  none\n"), "{axes}: {table}");
        }
    }
}

/// Values that are zero in every state, such as ω_x of a planar arm, give no points: a sheet of zeros has none.
#[test]
fn zeros_have_no_points() {
    let sheets = folder("mark_zeros").join("sheets");
    assert_eq!(rne(&["worksheet", "planar2", "--seed", "3", "ada", "-o", path(&sheets)]).status, 0);
    let file = sheets.join("ada.csv");
    let blank = fs::read_to_string(&file).expect("a worksheet");
    let zeros: String =
        blank.lines().map(|line| line.replace(",,rad", ",0,rad").replace(",,N", ",0,N") + "\n").collect();
    let zeros = zeros.replace(",,m/s", ",0,m/s");
    fs::write(&file, zeros).expect("a file");
    for carry in [&[][..], &["--carry"]] {
        let mark = rne(&[&["mark", "planar2", "--seed", "3", "--json", path(&file)], carry].concat());
        let reply: Value = serde_json::from_str(&mark.out).expect("JSON");
        let mark = &reply["marks"][0];
        // by hand: of each link ω_z, ω̇_z, τ, x and y of c̈, g and f, n_z, and x, y and z of what it takes at its joint;
        // once ċ1 (y alone, about a joint at rest), x and y of ċ2, and x, y and z of what link 1 hands on
        assert_eq!((&mark["points"], &mark["missing"], &mark["of"]), (&0.into(), &0.into(), &32.into()), "{mark}");
    }
}

/// The steps that a worksheet asks for are in its first line; a spreadsheet changes the separators of this line and the
/// minus signs.
#[test]
fn the_first_line_says_what_is_asked() {
    let sheets = folder("mark_head").join("sheets");
    let words = ["worksheet", "planar1", "--seed", "7", "--step", "1,2,7", "--answers", "m6", "-o", path(&sheets)];
    assert_eq!(rne(&words).status, 0);
    let text = fs::read_to_string(sheets.join("m6.csv")).expect("a worksheet");
    // a spreadsheet that is to show m/s² needs the byte order mark
    let text = text.strip_prefix('\u{feff}').expect("a byte order mark");
    let (head, rest) = text.split_once('\n').expect("a line");
    assert_eq!(head, "# rne worksheet, format 1, robot planar1, steps 1 2 7, student m6");
    // with another name: the student's is in the file
    let file = sheets.join("handed in.csv");
    let rest = rest.replace(',', ";").replace('-', "\u{2212}").replace('.', ",");
    let quoted = head.split(", ").map(|part| format!("\"{part}\"")).collect::<Vec<_>>().join(";");
    for head in [head.to_owned(), head.replace(',', ";") + ";;;", head.to_owned() + ";;;;;;", quoted] {
        fs::write(&file, format!("{head}\n{rest}")).expect("a file");
        let table = fine(&["mark", "planar1", "--seed", "7", path(&file)]);
        assert!(table.contains("m6          3/3  none\n"), "{head}: {table}");
    }
    fs::write(&file, text.replace("steps 1 2 7", "steps 1 9")).expect("a file");
    let called = rne(&["mark", "planar1", "--seed", "7", path(&file)]);
    assert!(called.status == 1 && called.err.contains(":1:1") && called.err.contains("are not steps"), "{called:?}");
}

/// Worksheets of `planar2` with right values: the folder, and a file of each student.
fn answers(name: &str, students: &[&str]) -> (PathBuf, Vec<PathBuf>) {
    let sheets = folder(name).join("sheets");
    let words = ["worksheet", "planar2", "--seed", "7", "--answers", "--axes", "joint", "-o", path(&sheets)];
    assert_eq!(rne(&[&words, students].concat()).status, 0);
    let files = students.iter().map(|student| sheets.join(format!("{student}.csv"))).collect();
    (sheets, files)
}

/// Excel saves `CSV` in Windows-1252, and `Unicode text` in UTF-16; our own units have a `²`.
#[test]
fn worksheets_as_spreadsheets_save_them() {
    let (_, files) = answers("mark_encodings", &["ada"]);
    let text = fs::read_to_string(&files[0]).expect("a worksheet");
    assert!(text.contains("m/s²"), "{text}");
    let plain = text.trim_start_matches('\u{feff}');
    let windows = plain.chars().map(|c| u8::try_from(u32::from(c)).expect("Latin-1")).collect::<Vec<u8>>();
    // “–”, which Windows-1252 has and Latin-1 has not
    let dash = [b"# \x96\n", windows.as_slice()].concat();
    let little = text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
    let big = text.encode_utf16().flat_map(u16::to_be_bytes).collect::<Vec<u8>>();
    for bytes in [windows, dash, little.clone(), big] {
        fs::write(&files[0], bytes).expect("a file");
        let table = fine(&["mark", "planar2", "--seed", "7", path(&files[0])]);
        assert!(table.contains("ada       32/32  none\n"), "{table}");
    }
    fs::write(&files[0], &little[..little.len() - 1]).expect("a file");
    let called = rne(&["mark", "planar2", "--seed", "7", path(&files[0])]);
    assert!(called.status == 1 && called.err.contains("ada.csv is not UTF-16 to its end"), "{called:?}");
}

/// What rounding leaves of a zero is 0, and no answer has digits that nobody can use.
#[test]
fn answers_have_no_noise() {
    let (_, files) = answers("mark_noise", &["ada"]);
    let text = fs::read_to_string(&files[0]).expect("a worksheet");
    let number =
        |line: &str| line.split(',').nth(4).and_then(|cell| cell.parse::<f64>().ok().map(|x| (x, cell.to_owned())));
    let rows = text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    let values: Vec<(f64, String)> = rows.filter_map(number).collect();
    assert!(values.len() > 70 && text.contains("1,5,gravity,x,0,m/s²,joint"), "{text}");
    for (value, text) in values {
        let digits = text.bytes().filter(u8::is_ascii_digit).count();
        assert!((value == 0.0 || value.abs() > 1e-10) && digits <= 10, "{text}");
    }
}

/// Only the cells that the first line names are asked for: joint and step.
#[test]
fn cells_that_are_asked_for() {
    let (_, files) = answers("mark_cells", &["ada"]);
    let text = fs::read_to_string(&files[0]).expect("a worksheet");
    for (cells, points) in [("2.4", "2/2"), ("2.4 1.7", "3/3")] {
        fs::write(&files[0], text.replace(", student", &format!(", cells {cells}, student"))).expect("a file");
        let call = ["mark", "planar2", "--seed", "7", path(&files[0])];
        let table = fine(&call);
        assert!(table.contains(&format!("ada         {points}  none\n")), "{cells}: {table}");
        // what the command line asks for comes first
        assert!(fine(&[&call[..], &["--step", "7"]].concat()).contains("2/2"), "{cells}");
    }
    fs::write(&files[0], text.replace(", student", ", cells 2.9, student")).expect("a file");
    let called = rne(&["mark", "planar2", "--seed", "7", path(&files[0])]);
    for says in ["ada.csv:1:1", "are not cells", "cells 1.4 2.4"] {
        assert!(called.status == 1 && called.err.contains(says), "{called:?}");
    }
}

/// A folder is the worksheets in it; a file that is refused says why in its row, and whose state a worksheet has.
#[test]
fn a_folder_of_a_class() {
    let (sheets, files) = answers("mark_folder", &["ada", "bob", "eve"]);
    let text = fs::read_to_string(&files[2]).expect("a worksheet");
    fs::write(&files[2], text.replace("1,1,omega,z,", "1,1,omgea,z,").replace("1,7,tau,", "1,7,tao,")).expect("a file");
    // bob's, handed in as ada's
    let text = fs::read_to_string(&files[1]).expect("a worksheet");
    fs::write(sheets.join("carl.csv"), text.replace("student bob", "student carl")).expect("a file");
    fs::write(sheets.join("notes.txt"), "no worksheet").expect("a file");
    let called = rne(&["mark", "planar2", "--seed", "7", path(&sheets)]);
    for says in [
        "ada       32/32  none\n",
        "the worksheet is for another state: that of bob\n",
        "line 17: `omgea`: there is no such quantity",
    ] {
        assert!(called.out.contains(says), "{says}: {}", called.out);
    }
    assert!(called.status == 1 && called.err.contains("eve.csv:17:5"), "{called:?}");
    let csv = rne(&["mark", "planar2", "--seed", "7", path(&sheets), "--csv"]).out;
    let row = csv.lines().find(|line| line.starts_with("eve,")).expect("a row");
    assert!(row.ends_with(",line 17: `omgea`: there is no such quantity; did you mean `omega`?"), "{row}");
    let empty = sheets.join("empty");
    fs::create_dir(&empty).expect("a folder");
    fails(1, &["mark", "planar2", "--seed", "7", path(&empty)], &["has no worksheet: no file .csv"]);
    // a worksheet has its state
    let compared = fine(&["eval", "planar2", "--trace", "--compare", path(&files[1])]);
    assert!(compared.starts_with("ok 74 values"), "{compared}");
    let blank = "joint,quantity,component,value\n1,omega,z,1\n";
    let file = sheets.join("blank.csv");
    fs::write(&file, blank).expect("a file");
    fails(2, &["eval", "planar2", "--trace", "--compare", path(&file)], &["--q"]);
}

/// A wrong seed is asked about once.
#[test]
fn another_seed_is_asked_about() {
    let files = class("mark_seed");
    let mut words = vec!["mark", "planar1", "--seed", "12", path(&files[0]), path(&files[1])];
    let called = rne(&words);
    assert_eq!(called.status, 1, "{called:?}");
    assert!(called.err.contains("is --seed that of the worksheets?"), "{called:?}");
    words[3] = "11";
    let called = rne(&words);
    assert_eq!((called.status, called.err.as_str()), (0, ""), "{called:?}");
}

/// With --carry, a value that is right for the student's own wrong value before it gives a point: c̈x = -a/2 ω².
#[test]
fn values_that_follow_from_a_wrong_one_have_points() {
    let files = class("mark_carry");
    let blank = fs::read_to_string(&files[0]).expect("a worksheet");
    let twice = |all: &mut Pendulum, _: [f64; 3]| {
        all.omega *= 2.0;
        all.acceleration[0] *= 4.0;
    };
    fs::write(&files[0], filled(&blank, twice)).expect("a file");
    let thrice = |all: &mut Pendulum, _: [f64; 3]| {
        all.omega *= 2.0;
        all.acceleration[0] *= 3.0;
    };
    fs::write(&files[1], filled(&fs::read_to_string(&files[1]).expect("a worksheet"), thrice)).expect("a file");
    for (more, points) in [(&["--json"][..], [3, 3]), (&["--json", "--carry"], [4, 3])] {
        let reply: Value = serde_json::from_str(&marked(&files[..2], more).out).expect("JSON");
        let marks = [0, 1].map(|index| reply["marks"][index]["points"].as_u64());
        assert_eq!(marks, points.map(Some), "{reply}");
        assert_eq!(reply["marks"][0]["carried"], points[0] - 3, "{reply}");
    }
}
