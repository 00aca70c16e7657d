//! Compiles generated C for the board with GCC, reads and runs it, and compares it with Rust.

use std::fmt::Write as _;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use anyhow::{Context, Result, anyhow, ensure};
use rne_certify::board;
use rne_certify::cycles::Core;
use rne_codegen::plan::PlanSet;
use rne_codegen::{Compiler, Form, Function, Layout, Sizes};
use rne_emit::{Precision, Prefix, c_code};
use rne_model::Robot;
use rne_search::PlanFile;
use robots::puma560::Arguments;
use robots::{STATES, State};

use crate::functions::{self, Method};
use crate::image;
use crate::log::{Agreement, Log};
use crate::table::Row;
use crate::tools;

/// The C code of a robot in a form.
struct Source {
    prefix: String,
    dof: usize,
    functions: Vec<Function>,
}

/// Returns the figures of `inverse_dynamics` of every robot in both forms. Fails if a result of it, or of any function
/// of the PUMA 560, differs from that of Rust in a bit. With `sample`, only every third robot and the PUMA 560 are
/// examined, and the other functions of the PUMA 560 only in the reduced form, because GCC takes minutes for their
/// seven steps.
pub(crate) fn examine(workspace: &Path, sample: bool, expected: &Log) -> Result<Vec<Row>> {
    let folder = tools::target_folder(workspace).join("c");
    fs::create_dir_all(&folder)?;
    let mut robots = functions::robots();
    if sample {
        let third = |(number, robot): (usize, functions::Robot)| {
            (number / 2 % 3 == 0 || robot.name == "puma560").then_some(robot)
        };
        robots = robots.into_iter().enumerate().filter_map(third).collect();
    }
    let mut sources = Vec::new();
    for &robot in &robots {
        let has_all = robot.name == "puma560" && !(sample && robot.form == "seven_steps");
        sources.push(write_source(workspace, &folder, robot, has_all)?);
    }
    fs::write(folder.join("cases.c"), cases(&sources)?)?;
    let board_folder = workspace.join("certify/board");
    let flags = Core::M4.flags();
    let include = format!("-I{}", board_folder.display());
    let mut files: Vec<String> = sources.iter().map(|source| format!("{}.c", source.prefix)).collect();
    files.push("cases.c".to_owned());
    let arguments = board::OPTIONS.iter().chain(&["-ffunction-sections"]).chain(&flags).map(|&flag| flag.to_owned());
    tools::gcc(&folder, arguments.clone().chain(["-fstack-usage".to_owned(), "-c".to_owned(), include]).chain(files))?;
    let mut objects: Vec<String> = sources.iter().map(|source| format!("{}.o", source.prefix)).collect();
    objects.push("cases.o".to_owned());
    // the file `board.c` is GNU C
    let link = ["-std=gnu99", "-nostartfiles", "-Wl,--gc-sections", "-T", "board.ld", "board.c", "-o"];
    let link = link.map(|word| {
        if word.starts_with("board") { board_folder.join(word).display().to_string() } else { word.to_owned() }
    });
    let elf = folder.join("board.elf");
    tools::gcc(&folder, arguments.chain(link).chain([elf.display().to_string()]).chain(objects))?;

    let log = Log::read(&tools::qemu("mps2-an386", &elf)?)?;
    for Method { name, form } in functions::methods().into_iter().filter(|of| !(sample && of.form == "seven_steps")) {
        agrees(&log, expected, &format!("method {form} {name}"))?;
    }
    let image = image::read(&elf)?.with_frames(|name| frame(&folder, name));
    let row = |robot: functions::Robot| {
        let functions::Robot { name, form, .. } = robot;
        let results = agrees(&log, expected, &format!("torques {name} {form}"))?;
        let function = format!("{name}_{form}_inverse_dynamics");
        let figures = image.straight_but_for(&function, |callee| callee.ends_with("_sin_cos"))?;
        Ok(Row { name: name.to_owned(), form: form.to_owned(), figures, results })
    };
    robots.into_iter().map(row).collect()
}

/// Fails unless all bits of the results are the same.
fn agrees(log: &Log, expected: &Log, function: &str) -> Result<String> {
    let agreement = log.agreement(expected, function)?;
    ensure!(agreement == Agreement::Identical, "{function}: the results of C are {agreement}, not those of Rust");
    Ok(agreement.to_string())
}

/// Reads the bytes of stack of a function, which GCC writes to a file next to the object file.
fn frame(folder: &Path, function: &str) -> Option<u64> {
    let robot = functions::robots().into_iter().map(|robot| format!("{}_{}", robot.name, robot.form));
    let prefix = robot.filter(|prefix| function.starts_with(&format!("{prefix}_"))).max_by_key(String::len)?;
    let usage = fs::read_to_string(folder.join(format!("{prefix}.su"))).ok()?;
    usage.lines().find_map(|line| {
        let (place, rest) = line.split_once('\t')?;
        let (bytes, _) = rest.split_once('\t')?;
        place.ends_with(&format!(":{function}")).then(|| bytes.parse().ok())?
    })
}

/// Writes header and source of a robot in a form: with `inverse_dynamics` only, or with all functions.
fn write_source(workspace: &Path, folder: &Path, robot: functions::Robot, has_all: bool) -> Result<Source> {
    let functions::Robot { name, form, dof } = robot;
    let file = workspace.join(format!("../robots/{name}.yaml"));
    let text = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
    let robot = Robot::from_yaml(&text).map_err(|report| anyhow!("{report}"))?;
    let plans = choice_of(&file, &robot)?;
    let all = if has_all { &Function::OF_TREES[..] } else { &Function::OF_TREES[..1] };
    let kind: Form = form.parse().map_err(|_| anyhow!("no form is called {form}"))?;
    let compiler = Compiler::new(&robot).with_plans(plans);
    let programs: Result<Vec<_>, _> = all.iter().map(|&function| compiler.compile(function, kind)).collect();
    let prefix = format!("{name}_{form}");
    let code = c_code(&robot, &programs?, Precision::Single, &prefix.parse::<Prefix>()?)?;
    fs::write(folder.join(format!("{prefix}.h")), code.header())?;
    fs::write(folder.join(format!("{prefix}.c")), code.source(&format!("{prefix}.h")))?;
    Ok(Source { prefix, dof, functions: all.to_vec() })
}

/// Returns the choices of the plan file next to a robot file; without one, the default choices, which the derive macro
/// uses, too.
fn choice_of(file: &Path, robot: &Robot) -> Result<PlanSet> {
    let file = file.with_extension("plan.yaml");
    let shown = file.display().to_string();
    match fs::read_to_string(&file) {
        Ok(text) => {
            let plan = PlanFile::read(&shown, &text, robot).map_err(|report| anyhow!("{report}"))?;
            Ok(PlanSet::from(plan))
        }
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(PlanSet::default_of(robot)),
        Err(error) => Err(error).context(shown),
    }
}

/// Returns a C file that calls every function and prints the results.
fn cases(sources: &[Source]) -> Result<String> {
    let mut text = "#include \"board.h\"\n".to_owned();
    for Source { prefix, .. } in sources {
        let _ = writeln!(text, "#include \"{prefix}.h\"");
    }
    // sines and cosines for the PUMA 560, computed by Rust
    let arguments: Vec<Arguments> = (0..STATES).map(|number| Arguments::at(State::new(number))).collect();
    text.push_str(&constant("sines", arguments.iter().map(|arguments| arguments.sin)));
    text.push_str(&constant("cosines", arguments.iter().map(|arguments| arguments.cos)));
    text.push_str("\nvoid run_cases(uint32_t number)\n{\n    struct state s;\n");
    text.push_str(ARGUMENTS);
    for Source { prefix, dof, functions } in sources {
        let _ = writeln!(text, "    s = state_of(number, {dof}u);");
        for &function in functions {
            text.push_str(&case(prefix, *dof, function)?);
        }
        if functions.contains(&Function::MomentumAndRate) {
            text.push_str(&observed(prefix)?);
        }
    }
    text.push_str("}\n");
    Ok(text)
}

/// C declarations of all arguments, as in ../robots/src/puma560.rs. The names begin with `a_`, because `sin` is a C
/// function.
const ARGUMENTS: &str = "\
    const float *const a_q = s.q, *const a_qd = s.qd, *const a_qdd = s.qdd, *const a_tau = s.qdd;
    const float *const a_multipliers = s.qdd, *const a_sin = sines[number], *const a_cos = cosines[number];
    const float a_step = 0.01f, a_force[3] = {1.0f, -2.0f, 3.0f}, a_moment[3] = {0.5f, 0.25f, -0.125f};
    const float a_payload[10] =
        {0.5f, 0.01f, -0.02f, 0.1f, 0.002f, 0.003f, 0.001f, 0.0001f, -0.0002f, 0.0003f};
    const float a_base_omega[3] = {0.1f, -0.2f, 0.3f}, a_base_omega_dot[3] = {0.0f, 0.0f, 0.0f};
    const float a_base_acceleration[3] = {0.0f, 0.0f, 0.0f}, a_base_gravity[3] = {0.0f, 0.0f, -9.81f};
    const float a_base_rotation[3][3] = {{0.36f, 0.48f, -0.8f}, {-0.8f, 0.6f, 0.0f}, {0.48f, 0.64f, 0.6f}};
    const float a_omega[3] = {0.1f, -0.2f, 0.3f}, a_twist[6] = {0.0f, 0.0f, 0.0f, 0.1f, -0.2f, 0.3f};
    const float a_pose[12] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f};
    const float a_wrenches[1][6] = {{1.0f, -2.0f, 3.0f, 0.5f, 0.25f, -0.125f}};
";

/// Returns C code for the third tick of an observer, as `Arguments::observed` of ../robots/src/puma560.rs computes it.
/// Its weight and frequency are those of Rust, which are computed in double precision and rounded.
fn observed(prefix: &str) -> Result<String> {
    let form = ["seven_steps", "reduced"].into_iter().find(|form| prefix.ends_with(form)).context("a form")?;
    let weight = -(-std::f64::consts::TAU * 20.0 * 1e-3).exp_m1();
    #[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
    let weight = weight as f32;
    Ok(format!(
        "    {{\n        {prefix}_observer observer;\n        float out[6];\n        \
         {prefix}_observer_begin(&observer, 20.0f, 1e-3f);\n        observer.weight = {weight:?}f;\n        \
         observer.frequency = 1000.0f;\n        \
         {prefix}_observer_update(&observer, s.q, s.qd, s.qdd, out);\n        \
         {prefix}_observer_update(&observer, sines[number], cosines[number], s.qdd, out);\n        \
         {prefix}_observer_update(&observer, cosines[number], sines[number], s.qd, out);\n        \
         print_results(\"method {form} observer_update\", number, out, 6u);\n    }}\n"
    ))
}

/// Returns C code that calls a function and prints a line.
fn case(prefix: &str, dof: usize, function: Function) -> Result<String> {
    let (robot, form) = ["seven_steps", "reduced"]
        .into_iter()
        .find_map(|form| Some((prefix.strip_suffix(form)?.strip_suffix('_')?, form)))
        .context("a robot and a form")?;
    let what = match function {
        Function::InverseDynamics => format!("torques {robot} {form}"),
        _ => format!("method {form} {function}"),
    };
    let parts = function.arguments().iter().flat_map(|argument| argument.parts());
    let arguments: Vec<String> = parts.map(|part| format!("a_{}", part.name)).collect();
    let arguments = arguments.join(", ");
    let layout = function.layout(Sizes { dof, tips: 1, passive: 0, equations: 0 });
    let count = layout.len();
    Ok(match &layout {
        Layout::Number => format!(
            "    {{\n        const float out = {prefix}_{function}({arguments});\n        \
             print_results(\"{what}\", number, &out, {count}u);\n    }}\n"
        ),
        layout => {
            let (kind, lengths) = declaration(prefix, layout);
            let address = if lengths.is_empty() { "&" } else { "" };
            format!(
                "    {{\n        {kind} out{lengths};\n        \
                 {prefix}_{function}({arguments}, {address}out);\n        \
                 print_results(\"{what}\", number, (const float *)&out, {count}u);\n    }}\n"
            )
        }
    })
}

/// Returns a C constant with six numbers for each state.
fn constant(name: &str, rows: impl Iterator<Item = [f32; 6]>) -> String {
    let mut text = format!("\nstatic const float {name}[{STATES}][6] = {{\n");
    for row in rows {
        let row: Vec<String> = row.iter().map(|number| format!("{number:?}f")).collect();
        let _ = writeln!(text, "    {{{}}},", row.join(", "));
    }
    text + "};\n"
}

/// Returns the C type of a result, and the lengths of its arrays.
fn declaration(prefix: &str, layout: &Layout) -> (String, String) {
    match layout {
        Layout::Number => ("float".to_owned(), String::new()),
        Layout::Array(length, of) => {
            let (kind, lengths) = declaration(prefix, of);
            (kind, format!("[{length}]{lengths}"))
        }
        Layout::Record(record, _) => (rne_emit::record_name(prefix, *record), String::new()),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use rne_codegen::plan::PlanSet;
    use rne_codegen::{Compiler, Form, Function};
    use rne_emit::{Precision, c_code};
    use rne_model::Robot;

    use super::choice_of;

    /// A robot without a plan file is certified with the default choices, which the derive macro uses.
    #[test]
    fn a_robot_without_a_plan_file_has_the_default_choices() {
        let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
        let text = fs::read_to_string(shipped.join("planar2.yaml")).expect("a shipped robot");
        let robot = Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}"));
        let source = |plans: &PlanSet| {
            let compiler = Compiler::new(&robot).with_plans(plans);
            let program = compiler.compile(Function::InverseDynamics, Form::Reduced).expect("it compiles");
            let prefix = "planar2".parse().expect("a prefix");
            c_code(&robot, &[program], Precision::Single, &prefix).expect("C code").source("planar2.h")
        };
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("planar2.yaml");
        let plans = choice_of(&file, &robot).expect("no plan is no error");
        assert_eq!(source(&plans), source(&PlanSet::default_of(&robot)));

        // a plan file is read, and an error in it is reported with its position
        fs::copy(shipped.join("planar2.plan.yaml"), file.with_extension("plan.yaml")).expect("a plan");
        choice_of(&file, &robot).expect("the shipped plan");
        fs::write(file.with_extension("plan.yaml"), "format: 1\nplans: none\n").expect("written");
        let error = choice_of(&file, &robot).err().expect("no plan").to_string();
        assert!(error.contains("planar2.plan.yaml:"), "{error}");
        // a plan file that cannot be read is named in the error
        fs::remove_file(file.with_extension("plan.yaml")).expect("it is there");
        fs::create_dir(file.with_extension("plan.yaml")).expect("a folder in its place");
        let error = format!("{:#}", choice_of(&file, &robot).err().expect("a folder is no plan"));
        assert!(error.contains("planar2.plan.yaml: "), "{error}");
    }
}
