//! `rne emit --lang c`: two files or one, which a compiler of C takes as they are.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::call::{ROOT, fails, fine, folder, rne};

const ROBOT: &str = "robots/planar2.yaml";

/// A path in `folder` as text.
pub(crate) fn path(folder: &Path, name: &str) -> String {
    folder.join(name).to_str().expect("UTF-8").to_owned()
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).expect("it was written")
}

/// Compiles files and runs what they make; nothing where there is no compiler.
pub(crate) fn printed(folder: &Path, files: &[&str], options: &[&str]) -> Option<String> {
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    if Command::new(&compiler).arg("--version").output().is_err() {
        println!("not compiled: there is no compiler of C called `{compiler}`; CC names another");
        return None;
    }
    let flags = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Wconversion", "-pedantic", "-Werror", "-ffp-contract=off"];
    let compiled = Command::new(compiler)
        .current_dir(folder)
        .args(flags.iter().chain(options).chain(files).chain(&["-o", "program"]))
        .output()
        .expect("it starts");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let computed = Command::new(folder.join("program")).output().expect("it starts");
    Some(String::from_utf8(computed.stdout).expect("text"))
}

#[test]
fn a_source_in_c_has_an_extension() {
    // else the header of another file would be replaced
    fails(2, &["emit", "planar1", "--lang", "c", "-o", "arm3"], &["arm3 is no name of a source file", "arm3.c"]);
}

#[test]
fn standard_output_is_one_file_that_compiles_alone() {
    let folder = folder("c_one_file");
    let code = fine(&["emit", ROBOT, "--form", "seven_steps", "--lang", "c", "--real", "double", "--prefix", "arm"]);
    assert_eq!(
        code,
        fine(&[
            "emit",
            ROBOT,
            "--lang",
            "c",
            "--real",
            "double",
            "--prefix",
            "arm",
            "--form",
            "seven_steps",
            "-o",
            "-"
        ])
    );
    let includes: Vec<&str> = code.lines().filter(|line| line.starts_with("#include")).collect();
    assert_eq!(includes, ["#include <float.h>", "#include <stdint.h>"], "no library, and not itself");
    let main = "#include <stdio.h>\nint main(void)\n{\n    const double q[] = {0.6, -1.1}, qd[] = {1.3, -0.4}, \
                qdd[] = {-0.7, 2.1};\n    double tau[ARM_DOF];\n    arm_inverse_dynamics(q, qd, qdd, tau);\n    \
                printf(\"%.17g %.17g\", tau[0], tau[1]);\n    return 0;\n}\n";
    fs::write(folder.join("main.c"), code + main).expect("written");
    let Some(printed) = printed(&folder, &["main.c"], &[]) else { return };
    let eval = ["eval", ROBOT, "--q", "0.6,-1.1", "--qd", "1.3,-0.4", "--qdd", "-0.7,2.1", "--json"];
    let json: serde_json::Value = serde_json::from_str(&fine(&eval)).expect("JSON");
    let expected: Vec<f64> = serde_json::from_value(json["result"].clone()).expect("numbers");
    let found: Vec<f64> = printed.split(' ').map(|word| word.parse().expect("a number")).collect();
    assert_eq!(found, expected, "in every bit");
}

#[test]
fn a_source_has_its_header_beside_it() {
    let folder = folder("c_two_files");
    let out = path(&folder, "arm.c");
    let emit = ["emit", ROBOT, "--lang", "c", "--function", "all", "-o", &out];
    let written = rne(&emit);
    assert_eq!((written.status, written.out.as_str()), (0, ""), "{written:?}");
    assert!(written.err.contains("arm.c") && written.err.contains("arm.h"), "{written:?}");
    let (source, header) = (read(&folder, "arm.c"), read(&folder, "arm.h"));
    assert!(source.contains("#include \"arm.h\"") && header.contains("#ifndef PLANAR2_H"), "{header}");
    assert!(rne(&emit).err.matches("up to date").count() == 2, "written once");

    let checked = ["emit", ROBOT, "--lang", "c", "--function", "all", "--check", &out];
    assert_eq!(rne(&checked).status, 0);
    let refresh = format!("rne emit {ROBOT} --lang c --function all -o {out}");
    fs::write(folder.join("arm.h"), header.replace("DOF 2u", "DOF 3u")).expect("changed");
    fails(1, &checked, &["arm.h is stale: line ", "DOF 3u", &refresh]);
    fs::remove_file(folder.join("arm.h")).expect("removed");
    fails(1, &checked, &["there is no file", "arm.h", &refresh]);
    fs::write(folder.join("arm.h"), &header).expect("as it was");
    fs::write(folder.join("arm.c"), source.replace("0.25f", "0.26f")).expect("changed");
    fails(1, &checked, &["arm.c is stale: line ", &refresh]);
    let typed = ["emit", ROBOT, "--lang", "c", "--real", "double", "--prefix", "my_arm", "--check", &out];
    fails(1, &typed, &["--lang c --real double --prefix my_arm -o"]);

    // a sine of one's own, and the header from C++ as well as from C
    fs::write(folder.join("arm.c"), source).expect("as it was");
    let main = "#include <stdio.h>\n#include \"arm.h\"\n#include \"arm.h\"\n\
                void cordic(float angle, float *sine, float *cosine);\n\
                void cordic(float angle, float *sine, float *cosine) { (void)angle; *sine = 0.0f; *cosine = 1.0f; }\n\
                int main(void)\n{\n    const float q[PLANAR2_DOF] = {0.5f, 0.25f};\n    planar2_pose tip;\n    \
                planar2_forward_kinematics(q, &tip);\n    printf(\"%g\", (double)tip.translation[0]);\n    return \
                0;\n}\n";
    fs::write(folder.join("main.c"), main).expect("written");
    let Some(stretched) = printed(&folder, &["main.c", "arm.c"], &["-DRNE_SIN_COS=cordic"]) else { return };
    assert_eq!(stretched, "0.9", "0.5 m and 0.4 m, however the joints stand");
}

#[test]
fn nothing_is_written_where_one_file_is_not_ours() {
    let folder = folder("c_overwriting");
    for (mine, other) in [("arm.h", "arm.c"), ("arm.c", "arm.h")] {
        fs::write(folder.join(mine), "int mine;\n").expect("written");
        let out = path(&folder, "arm.c");
        let message = format!("{mine} was not generated by rne");
        fails(2, &["emit", ROBOT, "--lang", "c", "-o", &out], &[&message, "--force"]);
        assert_eq!(read(&folder, mine), "int mine;\n");
        assert!(!folder.join(other).exists(), "{other}");
        fails(1, &["emit", ROBOT, "--lang", "c", "--check", &out], &["--force"]);
        assert_eq!(rne(&["emit", ROBOT, "--lang", "c", "-o", &out, "--force"]).status, 0);
        fs::remove_file(folder.join("arm.c")).expect("written");
        fs::remove_file(folder.join("arm.h")).expect("written");
    }
    let header = path(&folder, "arm.h");
    fails(2, &["emit", ROBOT, "--lang", "c", "-o", &header], &["the name of a header", "arm.c"]);
    fails(2, &["emit", ROBOT, "--lang", "c", "--check", &header], &["the name of a header", "arm.c"]);
    // a header that would be the robot file: nobody calls it so, and nothing is lost
    let robot = path(&folder, "robot.h");
    fs::copy(format!("{ROOT}/{ROBOT}"), &robot).expect("a copy");
    let out = path(&folder, "robot.c");
    fails(2, &["emit", &robot, "--lang", "c", "-o", &out, "--force"], &["the robot file itself"]);
    assert!(!Path::new(&out).exists());
}

#[test]
fn options_of_c_belong_to_c() {
    fails(2, &["emit", ROBOT, "--real", "float"], &["--real", "generic", "--lang c"]);
    fails(2, &["emit", ROBOT, "--lang", "rust", "--prefix", "arm"], &["--prefix", "--lang c"]);
    for bad in ["2arm", "my-arm", "_arm", ""] {
        fails(2, &["emit", ROBOT, "--lang", "c", "--prefix", bad], &["--prefix", "my_arm"]);
    }
    fails(2, &["emit", ROBOT, "--lang", "c", "--real", "half"], &["float", "double"]);
}

#[test]
fn a_constant_that_no_float_holds_is_named() {
    let folder = folder("c_overflow");
    let robot = path(&folder, "heavy.yaml");
    let text = fs::read_to_string(format!("{ROOT}/{ROBOT}")).expect("a robot");
    let heavy = text.replace("m2: 1.5,", "m2: 1.5e39,");
    fs::write(&robot, heavy).expect("written");
    let gravity = ["emit", &robot, "--lang", "c", "--form", "seven_steps", "--function", "gravity_torques"];
    fails(1, &gravity, &["heavy.yaml", "`gravity_torques` needs the constant m2 (mass, of link 2)", "--real double"]);
    let code = fine(&[&gravity[..], &["--real", "double"]].concat());
    assert!(code.contains("const double m2 = 1.5e39;"), "{code}");
}

#[test]
fn the_code_of_two_links() {
    let all = "inverse_dynamics,mass_matrix,forward_kinematics,kinetic_energy";
    insta::assert_snapshot!(fine(&["emit", ROBOT, "--lang", "c", "--form", "seven_steps", "--function", all]));
    insta::assert_snapshot!(fine(&["emit", ROBOT, "--lang", "c", "--real", "double"]));
}

#[test]
fn a_header_with_run_time_parameters() {
    let folder = folder("c_run_time");
    let emit = ["emit", "docs/desk_arm.yaml", "--lang", "c", "--run-time", "upper,fore"];
    let functions = ["--function", "gravity_torques,kinetic_energy", "-o", &path(&folder, "arm.c")];
    written(&[&emit[..], &functions].concat());
    insta::assert_snapshot!(read(&folder, "arm.h"));
    let main = "#include <stdio.h>\n#include \"arm.h\"\nint main(void)\n{\n    desk_arm_parameters p = \
                DESK_ARM_PARAMETERS;\n    const float q[3] = {0.0f, 0.0f, 0.0f};\n    float tau[3];\n    \
                p.upper = 0.5f;\n    desk_arm_gravity_torques(q, &p, tau);\n    \
                printf(\"%.9g\\n%.9g\", (double)tau[1], (double)tau[2]);\n    return 0;\n}\n";
    fs::write(folder.join("main.c"), main).expect("written");
    let Some(printed) = printed(&folder, &["main.c", "arm.c"], &[]) else { return };
    let found: Vec<f64> = printed.lines().map(|word| word.parse().expect("a number")).collect();
    // stretched: 3 kg at 0.18 m and 1.5 kg at 0.5 m + 0.12 m
    let expected = [9.81 * (3.0 * 0.18 + 1.5 * 0.62), 9.81 * 1.5 * 0.12];
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-5, "{found} is not {expected}");
    }
    let huge = path(&folder, "huge.yaml");
    let text = fs::read_to_string(Path::new(ROOT).join("docs/desk_arm.yaml")).expect("a robot");
    fs::write(&huge, text.replace("fore: 0.30", "fore: 1e39")).expect("written");
    let huge =
        ["emit", &huge, "--lang", "c", "--form", "seven_steps", "--run-time", "fore", "--function", "mass_matrix"];
    fails(1, &huge, &["`mass_matrix` takes run-time parameter 1", "1e39", "--real double"]);
    assert!(fine(&[&huge[..], &["--real", "double"]].concat()).contains("#define DESK_ARM_PARAMETERS {1e39}"));
}

#[test]
fn a_file_of_its_own_is_written_again_however_long_the_title() {
    let folder = folder("c_again");
    let robot = fs::read_to_string(Path::new(ROOT).join(ROBOT)).expect("it is shipped");
    for words in [1, 20, 80] {
        let title = format!("title: {}\n", "A title of many words ".repeat(words).trim_end());
        let lines: Vec<&str> = robot.lines().filter(|line| !line.starts_with("title:")).collect();
        let named = lines.join("\n").replacen("format: 1\n", &format!("format: 1\n{title}"), 1);
        assert!(named.contains(&title), "the file begins as it did");
        fs::write(folder.join("arm.yaml"), named).expect("written");
        let (arm, out) = (path(&folder, "arm.yaml"), path(&folder, &format!("arm{words}.c")));
        written(&["emit", &arm, "--lang", "c", "-o", &out]);
        fails(1, &["emit", &arm, "--lang", "c", "--real", "double", "--check", &out], &["is stale"]);
        written(&["emit", &arm, "--lang", "c", "--real", "double", "-o", &out]);
        fails(1, &["emit", &arm, "--lang", "c", "--check", &out], &["is stale"]);
    }
}

#[test]
fn settings_that_spoil_the_sine_are_refused() {
    let folder = folder("c_settings");
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    if Command::new(&compiler).arg("--version").output().is_err() {
        println!("not compiled: there is no compiler of C called `{compiler}`; CC names another");
        return;
    }
    for real in ["float", "double"] {
        let name = format!("{real}.c");
        written(&["emit", ROBOT, "--lang", "c", "--real", real, "-o", &path(&folder, &name)]);
        let says = |flags: &[&str]| {
            let mut command = Command::new(&compiler);
            let output =
                command.current_dir(&folder).args(flags).args(["-O2", "-c", &name]).output().expect("it starts");
            String::from_utf8_lossy(&output.stderr).into_owned()
        };
        assert_eq!(says(&[]), "", "{real}");
        assert!(says(&["-ffast-math"]).contains("the sine needs"), "{real}");
        // as on a processor of Arm without hardware for floating-point numbers
        let is_slow = !cfg!(target_arch = "aarch64") && real == "float";
        assert_eq!(says(&["-D__ARM_ARCH=7"]).contains("-DRNE_SOFT_FLOAT to allow it"), is_slow, "{real}");
        assert_eq!(says(&["-D__ARM_ARCH=7", "-DRNE_SOFT_FLOAT"]), "", "{real}");
        assert_eq!(says(&["-ffast-math", "-DRNE_SIN_COS=sincos_of_the_board"]), "", "{real}");
        let is_gcc = says(&["-v"]).contains("gcc version");
        if is_gcc {
            assert!(says(&["-funsafe-math-optimizations"]).contains("the sine needs its sums"), "{real}");
        }
        if is_gcc && cfg!(target_arch = "x86_64") {
            assert!(says(&["-mfpmath=387"]).contains("the sine needs every number rounded"), "{real}");
        }
    }
}

#[test]
fn a_file_has_a_name_of_its_language() {
    let folder = folder("c_names");
    fails(2, &["emit", ROBOT, "-o", &path(&folder, "arm.c")], &["not a name for a file in Rust", "arm.rs", "--lang c"]);
    fails(
        2,
        &["emit", ROBOT, "--lang", "c", "-o", &path(&folder, "arm.rs")],
        &["not a name for a file in C", "--lang rust"],
    );
    fails(
        2,
        &["emit", ROBOT, "--lang", "c", "-o", &path(&folder, "arm.cpp")],
        &["not a name for a file in C", "arm.c"],
    );
    assert!(fs::read_dir(&folder).expect("a folder").next().is_none(), "nothing was written");
    // a folder is made
    written(&["emit", ROBOT, "--lang", "c", "-o", &path(&folder, "ctl/new/arm.c")]);
    assert!(folder.join("ctl/new/arm.h").is_file());
    fs::write(folder.join("file"), "text").expect("written");
    fails(1, &["emit", ROBOT, "--lang", "c", "-o", &path(&folder, "file/arm.c")], &["file/arm.h", "Not a directory"]);
}

/// A call that writes files and says so.
fn written(arguments: &[&str]) {
    let called = rne(arguments);
    assert_eq!(called.status, 0, "{arguments:?}: {}", called.err);
}

/// The limits of the file, as C has them, and where there is none the largest number; the heading says of which file.
#[test]
fn a_header_has_limits_and_origin() {
    let folder = folder("c_limits");
    let robot = path(&folder, "arm.yaml");
    let text = fs::read_to_string(Path::new(ROOT).join("docs/desk_arm.yaml")).expect("a robot");
    let text = text.replace("limits: {position: [-deg(30), deg(120)], velocity: deg(120), effort: 40}", "limits: {}");
    fs::write(&robot, &text).expect("written");
    let code = fine(&["emit", &robot, "--lang", "c", "--real", "double"]);
    let heading = format!("// rne {}, of the robot file arm.yaml, SHA-256\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(code.matches(&heading).count(), 1, "{code}");
    fs::write(&robot, text + "# a remark\n").expect("written");
    let other = fine(&["emit", &robot, "--lang", "c", "--real", "double"]);
    let differ: Vec<&str> = code.lines().zip(other.lines()).filter(|(a, b)| a != b).map(|(a, _)| a).collect();
    assert!(matches!(differ[..], [line] if line.len() == "// ".len() + 64), "{differ:?}");
    let main = "#include <stdio.h>\nint main(void)\n{\n    const double lower[DESK_ARM_DOF] = DESK_ARM_POSITION_LOWER, \
                upper[] = DESK_ARM_POSITION_UPPER;\n    const double speed[] = DESK_ARM_VELOCITY_LIMIT, effort[] = \
                DESK_ARM_EFFORT_LIMIT;\n    for (unsigned i = 0; i < DESK_ARM_DOF; ++i)\n        printf(\"%.17g %.17g \
                %.17g %.17g\\n\", lower[i], upper[i], speed[i], effort[i]);\n    return 0;\n}\n";
    fs::write(folder.join("main.c"), code + main).expect("written");
    let Some(printed) = printed(&folder, &["main.c"], &[]) else { return };
    let found: Vec<f64> = printed.split_whitespace().map(|word| word.parse().expect("a number")).collect();
    let [quick, quicker] = [120_f64, 180.0].map(f64::to_radians);
    let expected = [
        [-(170_f64.to_radians()), 170_f64.to_radians(), quick, 40.0],
        [-f64::MAX, f64::MAX, f64::MAX, f64::MAX],
        [-(150_f64.to_radians()), 150_f64.to_radians(), quicker, 15.0],
    ];
    for (found, expected) in found.iter().zip(expected.as_flattened()) {
        assert!((found - expected).abs() <= 1e-15 * expected.abs(), "{found} is not {expected}");
    }
    assert_eq!(found.len(), 12);
}

/// `--ascii` changes comments alone, and leaves nothing but ASCII.
#[test]
fn comments_in_ascii() {
    for robot in ["robots/scara_cobra600.yaml", "robots/puma560_mdh.yaml"] {
        for lang in ["c", "rust"] {
            let arguments = ["emit", robot, "--lang", lang, "--function", "all", "--ascii"];
            let (plain, ascii) = (fine(&arguments[..6]), fine(&arguments));
            assert!(ascii.is_ascii() && !plain.is_ascii());
            let code = |text: &str| -> Vec<String> {
                text.lines().map(|line| line.split("//").next().unwrap_or_default().trim_end().to_owned()).collect()
            };
            assert_eq!(code(&plain), code(&ascii), "{robot}, {lang}");
            // what has no spelling would be one more
            assert_eq!(plain.matches('_').count(), ascii.matches('_').count(), "{robot}, {lang}");
        }
    }
    let folder = folder("c_ascii");
    let out = path(&folder, "arm.c");
    let emit = ["emit", ROBOT, "--lang", "c", "--ascii"];
    assert_eq!(rne(&[&emit[..], &["-o", &out]].concat()).status, 0);
    assert_eq!(rne(&[&emit[..], &["--check", &out]].concat()).status, 0);
    fails(1, &["emit", ROBOT, "--lang", "c", "--check", &out], &["is stale"]);
}

/// The order of the statements changes no bit, and a result may take the place of an argument.
#[test]
fn the_order_for_registers_gives_the_same_bits() {
    let folder = folder("c_order");
    let functions = "inverse_dynamics,forward_dynamics,inverse_dynamics_derivatives,euler_step";
    for (order, prefix) in [("formulas", "one"), ("registers", "other")] {
        let out = path(&folder, &format!("{prefix}.c"));
        let written = [
            "emit",
            "robots/puma560.yaml",
            "--lang",
            "c",
            "--real",
            "double",
            "--runge-kutta",
            "--function",
            functions,
        ];
        assert_eq!(rne(&[&written[..], &["--order", order, "--prefix", prefix, "-o", &out]].concat()).status, 0);
        let check = [&written[..], &["--order", order, "--prefix", prefix, "--check", &out]].concat();
        assert_eq!(rne(&check).status, 0);
    }
    let header = read(&folder, "other.h");
    assert!(header.contains("// Order: statements stand where few values are alive at once"), "{header}");
    let stale = rne(&["emit", "puma560", "--lang", "c", "--order", "registers", "--check", &path(&folder, "one.c")]);
    assert!(stale.status == 1 && stale.err.contains("--lang c --order registers -o "), "{}", stale.err);
    let main = r#"
#include <stdio.h>
#include <string.h>
#include "one.h"
#include "other.h"
static int differs(const void *a, const void *b, size_t size) { return memcmp(a, b, size) != 0; }
int main(void)
{
    int wrong = 0;
    for (int state = 0; state < 100; state++) {
        double q[6], qd[6], qdd[6], a[6], b[6];
        for (int i = 0; i < 6; i++) {
            q[i] = 0.37 * state - 1.1 * i;
            qd[i] = 0.1 * i - 0.01 * state;
            qdd[i] = 2.0 - i;
        }
        one_torque_derivatives c;
        other_torque_derivatives d;
        one_inverse_dynamics_derivatives(q, qd, qdd, &c);
        other_inverse_dynamics_derivatives(q, qd, qdd, &d);
        wrong += differs(c.dq, d.dq, sizeof c.dq) + differs(c.dqd, d.dqd, sizeof c.dqd);
        one_forward_dynamics(q, qd, qdd, a);
        other_forward_dynamics(q, qd, qdd, b);
        wrong += differs(a, b, sizeof a);
        one_inverse_dynamics(q, qd, qdd, a);
        other_inverse_dynamics(q, qd, qdd, b);
        wrong += differs(a, b, sizeof a);
        // the state after a step, from the place of the velocities on
        double start[18];
        one_next_state next;
        memcpy(start, q, sizeof q);
        memcpy(start + 6, qd, sizeof qd);
        one_runge_kutta_step(start, start + 6, qdd, 0.001, &next);
        other_runge_kutta_step(start, start + 6, qdd, 0.001, (other_next_state *)(void *)(start + 6));
        wrong += differs(&next, start + 6, sizeof next);
        other_inverse_dynamics(q, qd, qdd, q);
        wrong += differs(a, q, sizeof a);
    }
    printf("%d wrong\n", wrong);
    return 0;
}
"#;
    fs::write(folder.join("main.c"), main).expect("written");
    let Some(said) = printed(&folder, &["main.c", "one.c", "other.c"], &[]) else { return };
    assert_eq!(said, "0 wrong\n");
}

#[test]
fn an_order_is_for_the_reduced_form() {
    for command in [&["emit", "planar2"][..], &["emit", "planar2", "--lang", "c", "--form", "seven_steps"]] {
        fails(2, &[command, &["--order", "registers"]].concat(), &["--order registers is for --form reduced"]);
    }
    let kernels = ["emit", "planar2", "--lang", "ptx", "--order", "registers"];
    fails(2, &kernels, &["--order registers is for", "kernels of PTX always have an order"]);
    fails(2, &["emit", "planar2", "--order", "stack"], &["--order <O>", "formulas, registers"]);
    let code = fine(&["emit", "planar2", "--form", "reduced", "--order", "registers"]);
    assert!(code.contains("Order: statements stand where few values are alive at once"), "{code}");
}
