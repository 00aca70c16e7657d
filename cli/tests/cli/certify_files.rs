//! One certificate for the file that is linked: the observer, friction and limits in it, its name, and what is changed
//! by hand.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::call::{ROOT, fails, fine, folder, rne};
use crate::certify::{checked, has_tools};

/// An arm with friction in all joints, and effort limits of 40, 40 and 15 N m.
const ARM: &str = "docs/desk_arm_identified.yaml";

/// The options of the file, for `rne certify`.
const OPTIONS: [&str; 8] = [
    "--function",
    "inverse_dynamics,gravity_torques",
    "--observer",
    "--friction",
    "--limits",
    "--prefix",
    "kf",
    "--source",
];

/// The code in a folder, under a name that is not that of the robot file, and its certificate.
fn linked(folder: &Path) -> (PathBuf, PathBuf) {
    let (source, certificate) = (folder.join("kf_all.c"), folder.join("kf.cert.md"));
    let text = |path: &Path| path.to_str().expect("UTF-8").to_owned();
    let (code, page) = (text(&source), text(&certificate));
    let functions = "inverse_dynamics,gravity_torques,momentum_and_rate";
    let emit = ["emit", ARM, "--lang", "c", "--function", functions, "--friction", "--limits", "--prefix", "kf"];
    assert_eq!(rne(&[&emit[..], &["-o", code.as_str()]].concat()).status, 0);
    let certify = [&["certify", ARM, "--states", "5"], &OPTIONS[..], &[code.as_str(), "-o", page.as_str()]].concat();
    let said = rne(&certify);
    assert_eq!(said.status, 0, "{said:?}");
    (source, certificate)
}

#[test]
#[ignore = "slow: cargo xtask verify certify"]
fn the_certificate_is_of_the_file_that_is_linked() {
    if !has_tools() {
        return;
    }
    let folder = folder("certify_linked");
    let (source, certificate) = linked(&folder);
    let page = fs::read_to_string(&certificate).expect("it was written");
    for name in ["kf_all.c", "kf_all.h"] {
        let hash = rne_certify::sha256(&fs::read(folder.join(name)).expect("it was written"));
        assert!(page.contains(&format!("| {name} | `{hash}` |")), "{name}: {page}");
    }
    for function in ["inverse_dynamics", "gravity_torques", "observer_update", "friction_torques", "limit_torques"] {
        assert!(page.contains(&format!("## Cost of a call of `{function}`")), "{function}: {page}");
    }
    assert!(page.contains(" --source kf_all.c\n") && page.contains(" -o kf_all.c\n"), "{page}");

    let code = source.to_str().expect("UTF-8");
    let page = certificate.to_str().expect("UTF-8");
    let check = [&["certify", ARM, "--states", "5"], &OPTIONS[..], &[code, "--check", page]].concat();
    let said = rne(&check);
    assert!(said.status == 0 && said.err.matches("up to date:").count() == 3, "{said:?}");
    // one sign, and one number of the header
    for (name, old, new) in [("kf_all.c", " + ", " - "), ("kf_all.h", "KF_DOF 3", "KF_DOF 4")] {
        let file = folder.join(name);
        let text = fs::read_to_string(&file).expect("it is there");
        assert!(text.contains(old), "{text}");
        fs::write(&file, text.replacen(old, new, 1)).expect("written");
        fails(1, &check, &[name, "is not the code of the certificate", "rne emit", "--check"]);
        fs::write(&file, text).expect("written");
    }
    fs::remove_file(&source).expect("it is there");
    let said = rne(&check);
    assert!(said.status == 0 && said.said().contains("kf_all.c cannot be read, so it is not compared"), "{said:?}");
}

/// What the checker does not compute, it compares by the text: another number in it is found.
#[test]
#[ignore = "slow: cargo xtask verify certify"]
fn the_checker_compares_the_texts_of_what_it_does_not_compute() {
    let has_python = std::process::Command::new("python3").arg("--version").output().is_ok();
    if !has_python || !has_tools() {
        return;
    }
    let folder = folder("checker_texts");
    let evidence = folder.to_str().expect("UTF-8");
    let (source, trace) = (folder.join("kf_all.c"), folder.join("kf_all.trace.json"));
    let robot = Path::new(ROOT).join(ARM);
    fine(
        &[&["certify", ARM, "--states", "5", "--tests"], &OPTIONS[..], &["kf_all.c", "--evidence", evidence]].concat(),
    );
    let text = fs::read_to_string(&source).expect("it was written");
    let (is_accepted, said) = checked(&source, &trace, &robot);
    let compared = said.lines().find(|line| line.starts_with("compared by their texts alone")).expect("a line");
    for name in ["kf_momentum_and_rate", "kf_observer_update", "kf_friction_torques", "kf_limit_torques", "kf_limited"]
    {
        assert!(compared.contains(name), "{name}: {compared}");
    }
    assert!(is_accepted, "{said}");
    let line = |of: &str| text.lines().position(|line| line.contains(of)).expect("a line") + 1;
    let at = line("void kf_limit_torques(");
    for (what, mutant, words) in [
        ("a limit", text.replacen("15.0f)", "18.0f)", 1), "kf_limit_torques is not the text that rne wrote".to_owned()),
        ("friction", text.replacen(" + coulomb1", " - coulomb1", 1), "kf_friction_torques is not the text".to_owned()),
        ("no observer", text.replacen("kf_observer_update(", "kf_update(", 1), "define kf_observer_update".to_owned()),
        (
            "one more",
            text.replacen("void kf_limit_torques(", "void kf_x(void)\n{\n}\n\nvoid kf_limit_torques(", 1),
            "does not name these functions of the source: kf_x".to_owned(),
        ),
        (
            "a macro",
            text.replacen("void kf_limit_torques(", "#define tau3 tau2\nvoid kf_limit_torques(", 1),
            format!("line {at} of the source is a line of the preprocessor that rne does not write: #define tau3 tau2"),
        ),
        (
            "a continued comment",
            text.replacen("// within the limits", "// within \\", 1),
            "ends with a backslash".to_owned(),
        ),
        (
            "a comment in a comment",
            text.replacen("    // within the limits", "    // /*\n    limited[0] = tau1;\n    // */", 1),
            "kf_limit_torques is not the text".to_owned(),
        ),
    ] {
        assert_ne!(mutant, text, "{what}");
        fs::write(&source, mutant).expect("written");
        let (is_accepted, said) = checked(&source, &trace, &robot);
        assert!(!is_accepted && said.contains("wrong: ") && said.contains(&words), "{what}: {said}");
    }
    // blanks, comments and line ends are no text
    fs::write(&source, text.replace("// within the limits", "// cut").replace('\n', "\r\n")).expect("written");
    assert!(checked(&source, &trace, &robot).0);
    let json: Value = serde_json::from_str(&fs::read_to_string(&trace).expect("written")).expect("JSON");
    assert_eq!(json["functions"].as_array().map(Vec::len), Some(2));
}
