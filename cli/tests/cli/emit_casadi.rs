//! `rne emit --lang c --casadi`: functions by CasADi's external interface, called as CasADi calls them.
//! `doors/python/tests/test_casadi.py` has CasADi itself call them.

use std::fs;
use std::process::Command;

use crate::call::{fails, fine, folder, rne};
use crate::emit_c::{path, printed};

const FUNCTIONS: &str = "inverse_dynamics,forward_dynamics,gravity_torques,bias_torques";

#[test]
fn functions_and_derivatives_are_those_of_the_file() {
    // planes, prismatic joints, and legs whose joints do not feel each other
    for robot in ["planar2", "stanford", "trees/hyq"] {
        let folder = folder(&format!("casadi_{}", robot.replace('/', "_")));
        let (file, out) = (format!("robots/{robot}.yaml"), path(&folder, "arm.c"));
        let emit = [
            "emit",
            &file,
            "--lang",
            "c",
            "--casadi",
            "--acados",
            "--prefix",
            "arm",
            "--function",
            FUNCTIONS,
            "-o",
            &out,
        ];
        assert_eq!(rne(&emit).status, 0, "{robot}");
        fs::write(folder.join("driver.c"), include_str!("casadi/driver.c")).expect("written");
        let options = ["-Wshadow", "-Wmissing-prototypes", "-Wdouble-promotion"];
        let code = fs::read_to_string(folder.join("arm.c")).expect("it was written");
        assert!(code.contains("arm_external(jac_forward_dynamics, 4, 3)"), "{robot}");
        let Some(said) = printed(&folder, &["arm.c", "driver.c"], &options) else { return };
        let count = said.strip_suffix(" numbers\n").and_then(|count| count.parse().ok()).unwrap_or(0);
        assert!(count > 300, "{robot}: {said}");
    }
}

#[test]
fn derivatives_of_a_step_are_difference_quotients() {
    for robot in ["planar2", "stanford", "trees/hyq"] {
        let folder = folder(&format!("casadi_step_{}", robot.replace('/', "_")));
        let (file, out) = (format!("robots/{robot}.yaml"), path(&folder, "arm.c"));
        let emit =
            ["emit", &file, "--lang", "c", "--casadi", "--prefix", "arm", "--function", "euler_step", "-o", &out];
        assert_eq!(rne(&emit).status, 0, "{robot}");
        fs::write(folder.join("step.c"), include_str!("casadi/step.c")).expect("written");
        let options = ["-Wshadow", "-Wmissing-prototypes", "-Wdouble-promotion"];
        let code = fs::read_to_string(folder.join("arm.c")).expect("it was written");
        assert!(code.contains("arm_external(jac_adj1_euler_step, 12, 32)"), "{robot}");
        let Some(said) = printed(&folder, &["arm.c", "step.c"], &options) else { return };
        let count = said.strip_suffix(" numbers\n").and_then(|count| count.parse().ok()).unwrap_or(0);
        assert!(count > 300, "{robot}: {said}");
    }
}

#[test]
fn elements_that_are_zero_in_every_state_are_left_out() {
    let code = fine(&["emit", "robots/trees/hyq.yaml", "--lang", "c", "--casadi"]);
    // four legs of three joints: no column has rows of another leg
    let of_legs = "{12, 12, 0, 3, 6, 9, 12, 15, 18, 21, 24, 27, 30, 33, 36,";
    assert!(code.replace("\n    ", " ").replace("{ ", "{").contains(of_legs), "the mass matrix");
}

#[test]
fn a_library_shows_the_functions_for_casadi() {
    let folder = folder("casadi_library");
    let out = path(&folder, "planar2.c");
    assert_eq!(rne(&["emit", "planar2", "--lang", "c", "--casadi", "-o", &out]).status, 0);
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let library = ["-std=c99", "-fPIC", "-fvisibility=hidden", "-shared", "planar2.c", "-o", "libplanar2.so"];
    let Ok(made) = Command::new(compiler).args(library).current_dir(&folder).output() else { return };
    assert!(made.status.success(), "{made:?}");
    let main = "#include <stdio.h>\nlong long int adj1_forward_dynamics_n_in(void);\nint main(void)\n{\n    \
                printf(\"%d\", (int)adj1_forward_dynamics_n_in());\n    return 0;\n}\n";
    fs::write(folder.join("main.c"), main).expect("written");
    let rpath = format!("-Wl,-rpath,{}", folder.display());
    let Some(said) = printed(&folder, &["main.c", "libplanar2.so"], &[&rpath]) else { return };
    assert_eq!(said, "5", "q, qd, tau, out_qdd, adj_qdd");
}

#[test]
fn what_casadi_cannot_call_is_refused() {
    let c = ["emit", "planar2", "--lang", "c", "--casadi"];
    fails(2, &[&c[..], &["--real", "float"]].concat(), &["computes in double precision", "--real double"]);
    fails(2, &[&c[..], &["--function", "forward_kinematics"]].concat(), &["CasADi can call none of these functions"]);
    fails(2, &["emit", "planar2", "--casadi"], &["--casadi is for --lang c", "--lang c"]);
    fails(2, &[&c[..], &["--run-time", "m1"]].concat(), &["--casadi", "--run-time"]);
    // a prefix with which a function of C would have the name of one for CasADi
    for prefix in ["jac", "fwd1", "adj1", "jac_adj1"] {
        let name = format!("{prefix}_inverse_dynamics");
        fails(2, &[&c[..], &["--prefix", prefix]].concat(), &[&name, "--prefix my_arm"]);
    }
    let inverse = ["--prefix", "inverse", "--function", "inverse_dynamics,inverse_mass_matrix,mass_matrix"];
    fails(2, &[&c[..], &inverse].concat(), &["inverse_mass_matrix"]);
    let mass = fine(&[&c[..], &["--function", "mass_matrix"]].concat());
    assert!(mass.contains("planar2_external(mass_matrix, 1, 1)") && !mass.contains("jac_"), "no derivatives");
}

#[test]
fn a_prefix_may_be_a_word_of_the_template() {
    let folder = folder("casadi_prefix");
    for prefix in ["DOF", "PREFIX", "LONGEST"] {
        let code = fine(&["emit", "planar2", "--lang", "c", "--casadi", "--acados", "--prefix", prefix]);
        fs::write(folder.join("arm.c"), code + "int main(void) { return 0; }\n").expect("written");
        printed(&folder, &["arm.c"], &[]);
    }
}

#[test]
fn functions_without_casadi_are_named() {
    let out = folder("casadi_notes").join("arm.c").display().to_string();
    let functions = ["--function", "inverse_dynamics,torque_hessian,regressor"];
    let called = rne(&[&["emit", "planar2", "--lang", "c", "--casadi", "-o", &out][..], &functions].concat());
    assert_eq!(called.status, 0, "{}", called.err);
    assert!(called.said().contains("functions of C alone: regressor, torque_hessian"), "{}", called.err);
}

#[test]
fn the_command_that_writes_a_stale_file_keeps_what_is_for_casadi() {
    let out = folder("casadi_stale").join("arm.c").display().to_string();
    let check = ["emit", "planar2", "--lang", "c", "--casadi", "--acados", "--check", &out];
    let stale = rne(&check);
    assert_eq!(stale.status, 1, "{}", stale.err);
    let said = stale.said();
    let advised = said.split("to write it: rne ").nth(1).expect("a command");
    let words: Vec<&str> = advised.split(' ').collect();
    assert_eq!(rne(&words).status, 0, "{advised}");
    assert_eq!(rne(&check).status, 0, "{advised}");
}

/// A step of an integrator and frames add their functions to those for CasADi.
#[test]
fn options_that_add_functions_go_with_casadi() {
    let casadi = ["emit", "docs/desk_arm_frames.yaml", "--lang", "c", "--casadi", "--prefix", "arm"];
    let with = |options: &[&str]| rne(&[&casadi[..], options].concat());
    for (options, of_c, of_casadi, note) in [
        (
            &[][..],
            &["inverse_dynamics", "forward_dynamics"][..],
            &["inverse_dynamics, 3", "forward_dynamics, 3"][..],
            "",
        ),
        (
            &["--runge-kutta"],
            &["inverse_dynamics", "runge_kutta_step", "runge_kutta_step_derivatives"],
            &["inverse_dynamics, 3", "forward_dynamics, 3"],
            "functions of C alone: runge_kutta_step, runge_kutta_step_derivatives",
        ),
        (
            &["--frame", "camera"],
            &["inverse_dynamics", "pose_of_camera"],
            &["inverse_dynamics, 3", "jacobian_of_camera, 1"],
            "functions of C alone: pose_of_camera",
        ),
        (
            &["--frame", "camera", "--runge-kutta"],
            &["runge_kutta_step", "pose_of_camera"],
            &["forward_dynamics, 3", "jacobian_of_camera, 1"],
            "pose_of_camera",
        ),
    ] {
        let called = with(options);
        assert_eq!(called.status, 0, "{options:?}: {}", called.err);
        for name in of_c {
            assert!(called.out.contains(&format!("void arm_{name}(")), "{options:?}: {name}");
        }
        for call in of_casadi {
            assert!(called.out.contains(&format!("arm_external({call}, 1)")), "{options:?}: {call}");
        }
        assert!(called.said().contains(note), "{options:?}: {}", called.err);
    }
}
