//! The header for CUDA, compiled by the host's compiler of C++, computes the bits of the code in C.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use rne_codegen::{Compiler, Form, Function, Layout, Program};
use rne_emit::{Additions, Precision, Prefix, c_code, cuda};
use rne_model::Robot;

fn of_file(path: &str) -> Robot {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path);
    let text = fs::read(&path).expect("a robot file");
    let checked = rne_model::Reader::new("file").trees().couplings().loops().read(&text);
    checked.unwrap_or_else(|report| panic!("{report}")).robot
}

fn compiled(robot: &Robot, functions: &[Function], form: Form) -> Vec<Program> {
    let compiler = Compiler::new(robot);
    functions.iter().map(|&function| compiler.compile(function, form).expect("a program")).collect()
}

fn run(command: &mut Command) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let (said, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{command:?}\n{said}{errors}");
    assert!(errors.is_empty(), "{command:?}\n{errors}");
}

/// A function of C++ that runs both on random numbers and ends the program where a bit differs.
fn comparison(program: &Program, prefix: &str, real: &str) -> String {
    let arrays = program.argument_arrays();
    let (name, outputs) = (&program.name, program.outputs.len());
    let is_number = program.layout() == Layout::Number;
    let pointers: Vec<_> =
        arrays.iter().map(|array| if array.is_number { real.to_owned() } else { format!("const {real} *") }).collect();
    let (returned, result) = if is_number { (real, String::new()) } else { ("void", format!("{real} *")) };
    let types = pointers.into_iter().chain((!is_number).then_some(result)).collect::<Vec<_>>().join(", ");
    let mut text = format!("extern \"C\" {returned} c_code_{name}({types});\nstatic void compare_{name}()\n{{\n");
    let mut passed = Vec::new();
    for array in &arrays {
        let variable = format!("array_{}", array.name);
        let _ = writeln!(
            text,
            "    {real} {variable}[{}];\n    fill({variable}, {});",
            array.elements.len(),
            array.elements.len()
        );
        passed.push(if array.is_number { format!("{variable}[0]") } else { variable });
    }
    let passed = passed.join(", ");
    let _ = writeln!(text, "    {real} ours[{outputs}], theirs[{outputs}];\n    {prefix}_{name}({passed}, ours);");
    let call = if is_number {
        format!("theirs[0] = c_code_{name}({passed})")
    } else {
        format!("c_code_{name}({passed}, theirs)")
    };
    text + &format!("    {call};\n    same(ours, theirs, sizeof ours, \"{name}\");\n}}\n\n")
}

fn compare(robot: &Robot, programs: &[Program], precision: Precision) {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    let real = precision.c_type();
    let code = c_code(robot, programs, precision, &"c_code".parse().expect("a prefix")).expect("code");
    fs::write(place("code.c"), code.one_file()).expect("written");
    let prefix = Prefix::of(robot);
    let header = cuda(robot, programs, &prefix, &Additions::default()).expect("a header");
    assert!(header.is_ascii());
    fs::write(place("robot.cuh"), header).expect("written");
    let mut text = format!(
        "#include \"robot.cuh\"\n#include <cstdio>\n#include <cstdlib>\n#include <cstring>\n\n\
         static void fill({real} *numbers, int count)\n{{\n    static unsigned long long state = 7;\n    \
         for (int i = 0; i < count; ++i) {{\n        \
         state = state * 6364136223846793005ULL + 1442695040888963407ULL;\n        \
         numbers[i] = {real}(double(state >> 11) / 4503599627370496.0 - 1.0);\n    }}\n}}\n\n\
         static void same(const void *ours, const void *theirs, unsigned long size, const char *name)\n{{\n    \
         if (std::memcmp(ours, theirs, size) != 0) {{\n        std::printf(\"%s differs\\n\", name);\n        \
         std::exit(1);\n    }}\n}}\n\n"
    );
    for program in programs {
        text.push_str(&comparison(program, prefix.as_str(), real));
    }
    text.push_str("int main()\n{\n    for (int i = 0; i < 200; ++i) {\n");
    for program in programs {
        let _ = writeln!(text, "        compare_{}();", program.name);
    }
    text.push_str("    }\n}\n");
    fs::write(place("main.cpp"), text).expect("written");
    let in_folder = |program: &str| {
        let mut command = Command::new(program);
        command.current_dir(folder.path()).args(["-O0", "-ffp-contract=off"]);
        command
    };
    run(in_folder("gcc").args(["-std=c99", "-c", "code.c", "-o", "code.o"]));
    run(in_folder("g++").args(["-std=c++11", "-Wall", "-Wextra", "-Wpedantic", "main.cpp", "code.o", "-o", "both"]));
    run(&mut Command::new(place("both")));
}

#[test]
fn the_header_gives_the_bits_of_the_code_in_c() {
    if ["gcc", "g++"].iter().any(|compiler| Command::new(compiler).arg("--version").output().is_err()) {
        println!("not compiled: there is no gcc or no g++");
        return;
    }
    let of_arm = [
        Function::InverseDynamics,
        Function::InverseDynamicsWithPayload,
        Function::InverseDynamicsFromSinCos,
        Function::MassMatrix,
        Function::ForwardDynamics,
        Function::EulerStep,
        Function::ForwardKinematics,
        Function::KineticEnergy,
        Function::JointWrenches,
        Function::ActuatorTorques,
    ];
    let arm = |name: &str| Robot::from_yaml(rne_robots::find(name).expect("shipped").yaml).expect("a robot");
    let of_loops = [Function::InverseDynamicsOfLoops, Function::ForwardDynamicsOfLoops, Function::ClosureStep];
    let cases: [(Robot, &[Function], Form); 6] = [
        (arm("puma560"), &of_arm, Form::Reduced),
        (arm("stanford"), &of_arm, Form::SevenSteps),
        (arm("panda"), &[Function::InverseDynamicsDerivatives], Form::Reduced),
        (of_file("docs/tree.yaml"), &[Function::InverseDynamics, Function::MassMatrix], Form::Reduced),
        (
            of_file("benches/trees/go2_floating.yaml"),
            &[Function::InverseDynamicsOfFloatingBase, Function::FloatingForwardDynamics],
            Form::Reduced,
        ),
        (of_file("docs/four_bar.yaml"), &of_loops, Form::Reduced),
    ];
    for (robot, functions, form) in cases {
        let programs = compiled(&robot, functions, form);
        for precision in Precision::ALL {
            compare(&robot, &programs, precision);
        }
    }
}
