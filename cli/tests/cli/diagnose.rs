//! `rne diagnose`: slips that were made by editing a robot file.

use std::fs;

use serde_json::Value;

use crate::call::{ROOT, fails, fine, folder, rne};

const STATE: [&str; 6] = ["--q", "0.1,0.3,-0.5,0.1,0.2,0.4", "--qd", "1,0.5,-1,2,1,1", "--qdd=1,2,3,1,0.3,1", "--json"];

/// The torques of the PUMA from a copy of its file in which something was replaced, as another tool would print them.
fn torques_with(name: &str, from: &str, to: &str) -> String {
    let text = fs::read_to_string(format!("{ROOT}/robots/puma560.yaml")).expect("the robot file");
    assert!(text.contains(from), "{from}");
    let file = folder(name).join("arm.yaml");
    fs::write(&file, text.replace(from, to)).expect("a copy");
    let path = file.to_str().expect("UTF-8");
    let reply: Value = serde_json::from_str(&rne(&[&["eval", path][..], &STATE].concat()).out).expect("JSON");
    let torques = reply["result"].as_array().expect("torques").iter();
    torques.map(|tau| format!("{:.7}", tau.as_f64().expect("a number"))).collect::<Vec<_>>().join(",")
}

fn names(tau: &str) -> Vec<Vec<String>> {
    let tau = format!("--tau={tau}");
    let called = rne(&[&["diagnose", "robots/puma560.yaml", &tau][..], &STATE].concat());
    assert_eq!(called.status, 0, "{called:?}");
    let reply: Value = serde_json::from_str(&called.out).expect("JSON");
    let explanations = reply["explanations"].as_array().expect("a list").iter();
    let names = explanations.map(|one| {
        let slips = one["slips"].as_array().expect("slips").iter();
        slips.map(|slip| slip["name"].as_str().expect("a name").to_owned()).collect()
    });
    names.collect()
}

#[test]
fn a_slip_in_the_file_is_named() {
    for (name, from, to, slip) in [
        ("slip_convention", "convention: standard", "convention: modified", "other_convention"),
        ("slip_gravity", "gravity: [0, 0, -9.81]", "gravity: [0, 0, 9.81]", "gravity_reversed"),
        ("slip_frame", "gravity: [0, 0, -9.81]", "gravity: [0, -9.81, 0]", "gravity_along_another_axis"),
    ] {
        assert_eq!(names(&torques_with(name, from, to)).first(), Some(&vec![slip.to_owned()]), "{name}");
    }
}

#[test]
fn torques_that_agree_have_no_slip() {
    assert!(names(&torques_with("slip_none", "name: puma560", "name: puma560")).is_empty());
    let text = fine(&["diagnose", "planar1", "--q", "0.3", "--qd", "0.5", "--qdd=-1", "--tau", "4.5193"]);
    assert!(text.starts_with("ok the torques agree with planar1"), "{text}");
}

#[test]
fn the_answer_reads_well() {
    let (q, qd, qdd) = (["--q", "0.3,0.5"], ["--qd", "1,2"], ["--qdd", "0.5,-1"]);
    let call = |tau| rne(&[&["diagnose", "robots/planar2.yaml", tau][..], &q, &qd, &qdd].concat());
    let (explained, unexplained) = (call("--tau=-14.1097,-1.95268"), call("--tau=3.5,17.25"));
    assert_eq!(unexplained.status, 1);
    insta::assert_snapshot!(format!("{}----\n{}", explained.out, unexplained.out));
}

#[test]
fn mistakes_in_the_call() {
    let state = ["--q", "0.3", "--qd", "0", "--qdd", "0"];
    let call = |more: &[&str], parts: &[&str]| {
        fails(2, &[&["diagnose", "robots/planar1.yaml"][..], &state, more].concat(), parts);
    };
    call(&["--tau", "1,2"], &["--tau needs 1 number", "not 2"]);
    call(&[], &["--tau"]);
    call(&["--tau", "x"], &["number 1, `x`, is not a number"]);
    for bad in ["2", "-1", "-1e-3", "x"] {
        call(&["--tau", "1", "--tolerance", bad], &["from 0 to below 1, such as --tolerance 1e-4"]);
    }
    let state = ["--q", "0.5,0.3", "--qd", "1e155,0.5", "--qdd", "2,1", "--tau", "1,2"];
    fails(1, &[&["diagnose", "planar2"][..], &state].concat(), &["overflows: the state is too large"]);
}

/// Torques that are right as printed agree: each is off by less than half of its own last digit.
#[test]
fn torques_agree_as_printed() {
    let state = ["--q", "0.3,0.4", "--qd", "0.1,0.2", "--qdd", "0.5,0.6", "--json"];
    // right are 14.541 and 2.4086
    for (tau, agrees, accepted) in [
        ("14.5,2.4", true, [0.05, 0.05]),
        ("14.54,2.4", true, [0.005, 0.05]),
        ("14.5,2.41", true, [0.05, 0.005]),
        ("14.5,2.400", false, [0.05, 0.0005]),
        ("14.50,2.4", false, [0.005, 0.05]),
        ("15,2", true, [0.5, 0.5]),
        ("14,2", false, [0.5, 0.5]),
        ("1.45e1,2.41e0", true, [0.05, 0.005]),
        ("1e1,2", true, [5.0, 0.5]),
        ("14541e-3,2.4086", true, [0.0005, 0.00005]),
        ("14.5420,2.4086", false, [0.00005, 0.00005]),
    ] {
        let called = rne(&[&["diagnose", "planar2", &format!("--tau={tau}")][..], &state].concat());
        let reply: Value = serde_json::from_str(&called.out).expect("JSON");
        assert_eq!(reply["agrees"], agrees, "{tau}: {reply}");
        if agrees {
            assert_eq!(called.status, 0, "{tau}");
            assert_eq!(reply["accepted"], serde_json::json!(accepted), "{tau}");
            let most = accepted.iter().fold(0.0, |most: f64, half| most.max(*half));
            let largest = reply["tolerance"].as_f64().expect("a number");
            assert!(largest > 0.9 * most / 16.0 && largest < 1.1 * most / 10.0, "{tau}: {reply}");
        }
    }
    let wide = rne(&[&["diagnose", "planar2", "--tau=14.3,2.4", "--tolerance", "0.02"][..], &state].concat());
    let reply: Value = serde_json::from_str(&wide.out).expect("JSON");
    assert_eq!((&reply["agrees"], &reply["tolerance"]), (&serde_json::json!(true), &serde_json::json!(0.02)));
    // of zeros a part of the largest says nothing, and a zero without digits accepts no half
    let rest = ["diagnose", "planar1", "--q", "0.3", "--qd", "0", "--qdd", "0", "--tau", "0"];
    let called = rne(&rest);
    assert!(called.out.contains("result from this:") && called.out.contains("there is no gravity"), "{called:?}");
}

/// Somebody has typed `alpha: pi/2` for joint 3 of the PUMA 560, whose file has `-pi/2`.
#[test]
fn a_mistyped_sign_is_named() {
    let file = folder("mistyped").join("puma.yaml");
    let text = fs::read_to_string(format!("{ROOT}/robots/puma560.yaml")).expect("a robot");
    let mistyped = text.replacen("a: 0.0203, alpha: -pi/2", "a: 0.0203, alpha: pi/2", 1);
    assert_ne!(text, mistyped);
    fs::write(&file, mistyped).expect("written");
    let state = ["--q", "0.1,0.3,-0.5,0.1,0.2,0.4", "--qd", "1,1,1,1,1,1", "--qdd", "1,0,0,0,0,1"];
    let json = fine(&[&["eval", file.to_str().expect("UTF-8"), "--json"][..], &state].concat());
    let tau: String = json.chars().filter(|c| c.is_ascii_digit() || ".,-".contains(*c)).collect();
    let called = rne(&[&["diagnose", "puma560", "--tau", &tau][..], &state].concat());
    for part in
        ["exactly", "`alpha` of row 3 (j3) has the other sign", "in the file it is -1.5708 rad; check in the source"]
    {
        assert!(called.out.contains(part), "no `{part}` in {called:?}");
    }
}

/// The other program has the angles of the URDF, and the robot file has snapped ones: torques that are right agree
/// nearly, and a mistake is found all the same.
#[test]
fn snapped_angles_hide_no_mistake() {
    let folder = folder("diagnose_snapped");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let (urdf, snapped, raw, wrong) = (path("arm.urdf"), path("snapped.yaml"), path("raw.yaml"), path("wrong.yaml"));
    fs::write(&urdf, fine_urdf().replace("1.5707963267948966", "1.5708")).expect("written");
    for options in [&["-o", &snapped][..], &["--no-snap", "-o", &raw]] {
        assert_eq!(rne(&[&["import", &urdf][..], options].concat()).status, 0);
    }
    let text = fs::read_to_string(&raw).expect("a robot file");
    assert!(text.contains("gravity: [0, 0, -9.81]"), "{text}");
    fs::write(&wrong, text.replace("gravity: [0, 0, -9.81]", "gravity: [0, 0, 9.81]")).expect("written");
    let torques = |file: &str| {
        let reply: Value = serde_json::from_str(&rne(&[&["eval", file][..], &STATE].concat()).out).expect("JSON");
        let torques = reply["result"].as_array().expect("torques").iter();
        format!("--tau={}", torques.map(Value::to_string).collect::<Vec<_>>().join(","))
    };
    let state = &STATE[..STATE.len() - 1];
    let diagnosed = |file: &str, tau: &str| rne(&[&["diagnose", file, tau][..], state].concat());
    for file in [&snapped, &urdf] {
        let right = diagnosed(file, &torques(&raw));
        let said = right.out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(right.status == 0 && said.starts_with("ok the torques agree with puma560 to "), "{right:?}");
        assert!(said.contains("angles snapped to multiples of pi/12: ") && said.contains("--no-snap"), "{said}");
        let mistaken = diagnosed(file, &torques(&wrong));
        let said = mistaken.out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(mistaken.status == 0 && said.contains("gravity points the other way"), "{said}");
        assert!(said.contains("angles snapped to multiples of pi/12: "), "{said}");
    }
    // without snapped angles, torques that agree nearly are not right
    let near = diagnosed(&raw, &torques(&snapped));
    assert!(near.status == 1 && near.out.contains("of the largest, but not with all of their digits"), "{near:?}");
    let exact = diagnosed(&raw, &torques(&raw));
    assert!(exact.status == 0 && !exact.out.contains("snap"), "{exact:?}");
}

/// The URDF of the PUMA.
fn fine_urdf() -> String {
    let exported = rne(&["export", "puma560", "--urdf"]);
    assert_eq!(exported.status, 0, "{exported:?}");
    exported.out
}
