//! `rne certify`: a certificate of the user's own arm.

use std::fs;
use std::process::Command;

use crate::call::{fails, fine, folder, rne};

const ROBOT: &str = "docs/desk_arm.yaml";

/// Whether all tools are there; a line says that the test is skipped.
fn has_tools() -> bool {
    let missing: Vec<&str> = ["arm-none-eabi-gcc", "arm-none-eabi-objdump", "qemu-system-arm", "cppcheck"]
        .into_iter()
        .filter(|tool| Command::new(tool).arg("--version").output().is_err())
        .collect();
    if !missing.is_empty() {
        println!("not certified: {} is not installed (cargo xtask certificate --install)", missing.join(", "));
    }
    missing.is_empty()
}

#[test]
fn a_compiler_that_is_missing_is_named_with_its_package() {
    fails(1, &["certify", ROBOT, "--cc", "no-such-gcc"], &["no-such-gcc", "apt-get install gcc-arm-none-eabi"]);
    fails(2, &["certify", ROBOT, "--cpu", "cortex-m0"], &["cortex-m4 and cortex-m7"]);
    fails(2, &["certify", ROBOT, "--function", "jacobian"], &["jacobian", "gravity_torques"]);
}

#[test]
fn a_certificate_is_checked_and_a_change_is_found() {
    if !has_tools() {
        return;
    }
    let folder = folder("certify");
    let out = folder.join("arm.cert.md");
    let out = out.to_str().expect("UTF-8");
    let certify = ["certify", ROBOT, "--states", "100", "-o", out];
    assert_eq!(rne(&certify).status, 0);
    let page = fs::read_to_string(out).expect("it was written");
    for part in ["| double precision | none |", "QEMU runs the code", "| 19.2 | 4 |", "| `tau[0]` |", "SHA-256"] {
        assert!(page.contains(part), "{part}: {page}");
    }
    let check = ["certify", ROBOT, "--states", "100", "--check", out];
    assert_eq!(rne(&check).status, 0);
    fs::write(out, page.replacen("| bytes of constants | ", "| bytes of constants | 1", 1)).expect("written");
    fails(1, &check, &["1 lines differ", "bytes of constants"]);
    // another arm, and a file that is no certificate
    fails(1, &["certify", "planar2", "--states", "100", "--check", out], &["lines differ"]);
    fs::write(out, "mine").expect("written");
    fails(2, &certify, &["is no certificate of rne and is not changed", "--force"]);
    assert_eq!(fs::read_to_string(out).expect("it is there"), "mine");
}

#[test]
fn the_figures_of_json_are_those_of_the_page() {
    if !has_tools() {
        return;
    }
    for cpu in ["cortex-m4", "cortex-m7"] {
        let certify = ["certify", ROBOT, "--states", "50", "--cpu", cpu];
        let json: serde_json::Value =
            serde_json::from_str(&fine(&[&certify[..], &["--json"]].concat())).expect("JSON");
        let page = fine(&certify);
        let instructions = json["cost"]["instructions"].as_u64().expect("a number");
        assert_eq!(json["emulation"]["instructions"].as_u64(), Some(instructions));
        assert!(page.contains(&format!("a call executes once | {instructions} |")), "{page}");
        let kinds = json["cost"]["classes"].as_array().expect("kinds").iter();
        let sum: u64 = kinds.map(|kind| kind["instructions"].as_u64().expect("a number")).sum();
        assert_eq!(sum, instructions, "each instruction is of one kind");
        assert_eq!(json["cost"]["stack"], json["cost"]["stack_of_listing"]);
    }
}
