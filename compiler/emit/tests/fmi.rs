//! FMUs as a program in C steps them: the trajectory of the runtime, and descriptions that agree with the code.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::process::Command;

use rne_codegen::{Compiler, Form, Program};
use rne_emit::{FmiVersion, Fmu, FmuCausality, Precision, Prefix, with_inertial_parameters};
use rne_model::{Reader, Robot};
use rne_runtime::{DynArm, Payload};

const VERSIONS: [FmiVersion; 2] = [FmiVersion::Two, FmiVersion::Three];

/// An arm with standard rows, one whose third joint slides, and a tree some of whose joints follow others.
fn robots() -> Vec<Robot> {
    let shipped = ["puma560", "scara_cobra600"].map(|name| rne_robots::find(name).expect("shipped").yaml.to_owned());
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs");
    let gripper = fs::read_to_string(format!("{folder}/gripper.yaml")).expect("it is there");
    let read = |text: &String| Reader::new("robot.yaml").trees().couplings().read(text).expect("valid").robot;
    shipped.iter().chain([&gripper]).map(read).collect()
}

/// The files of an FMU.
fn files(robot: &Robot, version: FmiVersion, causality: FmuCausality) -> Vec<(String, String)> {
    let compiler = Compiler::new(robot);
    let compiled = causality.functions().iter().map(|&function| compiler.compile(function, Form::Reduced));
    let programs: Vec<Program> = compiled.collect::<Result<_, _>>().expect("it compiles");
    let code = rne_emit::c_code(robot, &programs, Precision::Double, &Prefix::of(robot)).expect("numbers fit");
    Fmu { robot, programs: &programs, code: &code, version, causality, token: "token" }.files()
}

fn file<'a>(files: &'a [(String, String)], path: &str) -> &'a str {
    &files.iter().find(|(known, _)| known == path).unwrap_or_else(|| panic!("there is no {path}")).1
}

/// The values of an attribute, in their order.
fn attributes<'a>(xml: &'a str, name: &str) -> Vec<&'a str> {
    let start = format!(" {name}=\"");
    xml.split(start.as_str()).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

/// Compiles the sources with a program and runs it; none where there is no compiler of C.
fn printed(robot: &Robot, files: &[(String, String)], main: &str) -> Option<Vec<f64>> {
    let folder = tempfile::tempdir().expect("a folder");
    for (path, text) in files {
        if let Some(name) = path.strip_prefix("sources/") {
            fs::write(folder.path().join(name), text).expect("written");
        }
    }
    fs::write(folder.path().join("main.c"), main).expect("written");
    let flags = "-std=c99 -Wall -Wextra -Wshadow -Wconversion -Werror -pedantic -ffp-contract=off -O1 -o program";
    let compiled = Command::new(std::env::var("CC").unwrap_or_else(|_| "cc".to_owned()))
        .args(flags.split(' '))
        .args(["main.c", "fmi-functions.c", &format!("{}.c", robot.name)])
        .current_dir(folder.path())
        .output();
    let Ok(compiled) = compiled else {
        println!("left out: there is no compiler of C");
        return None;
    };
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let run = Command::new(folder.path().join("program")).output().expect("it starts");
    assert!(run.status.success(), "{run:?}");
    let text = String::from_utf8(run.stdout).expect("numbers");
    Some(text.lines().map(|line| line.parse().expect("a number")).collect())
}

/// The program of [`driver`], whose words in capitals are replaced.
const MAIN: &str = r#"#include <stdio.h>
#include "fmi-types.h"
DECLARATIONS
int main(void)
{
    const unsigned given[] = {REFERENCES}, asked[] = {ASKED};
    const double values[] = {VALUES};
    double seen[sizeof asked / sizeof *asked];
    size_t k;
    int i;
OWN    void *arm = BEGIN;
    if (arm == 0 || PUT != 0) {
        return 1;
    }
    for (i = 0; i < STEPS; i++) {
        if (STEP != 0) {
            return 2;
        }
    }
    if (GET != 0) {
        return 3;
    }
    for (k = 0; k < sizeof asked / sizeof *asked; k++) {
        printf("%.17g\n", seen[k]);
    }
    FREE(arm);
    return 0;
}
"#;

/// A program that sets the values with the first references, steps or evaluates, and prints `count` values.
fn driver(version: FmiVersion, set: &[(usize, f64)], steps: usize, duration: f64, print: &[usize]) -> String {
    let list = |numbers: Vec<String>| numbers.join(", ");
    let references = list(set.iter().map(|(reference, _)| reference.to_string()).collect());
    let values = list(set.iter().map(|(_, value)| format!("{value:?}")).collect());
    let printed = list(print.iter().map(ToString::to_string).collect());
    let (given, asked) = (set.len(), print.len());
    let (declarations, begin, get, put, step) = match version {
        FmiVersion::Two => (
            "fmi2Component fmi2Instantiate(fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions \
             *, fmi2Boolean, fmi2Boolean);\nfmi2Status fmi2SetReal(void *, const unsigned *, size_t, const double \
             *);\nfmi2Status fmi2GetReal(void *, const unsigned *, size_t, double *);\nfmi2Status fmi2DoStep(void *, \
             double, double, int);\nvoid fmi2FreeInstance(void *);\n",
            "fmi2Instantiate(\"arm\", fmi2CoSimulation, \"token\", NULL, NULL, 0, 0)".to_owned(),
            format!("fmi2GetReal(arm, asked, {asked}u, seen)"),
            format!("fmi2SetReal(arm, given, {given}u, values)"),
            format!("fmi2DoStep(arm, i * {duration:?}, {duration:?}, 1)"),
        ),
        FmiVersion::Three => (
            "fmi3Instance fmi3InstantiateCoSimulation(fmi3String, fmi3String, fmi3String, bool, bool, bool, bool, \
             const fmi3ValueReference *, size_t, void *, fmi3LogMessageCallback, \
             fmi3IntermediateUpdateCallback);\nfmi3Status fmi3SetFloat64(void *, const unsigned *, size_t, const \
             double *, size_t);\nfmi3Status fmi3GetFloat64(void *, const unsigned *, size_t, double *, \
             size_t);\nfmi3Status fmi3DoStep(void *, double, double, bool, bool *, bool *, bool *, double *);\nvoid \
             fmi3FreeInstance(void *);\n",
            "fmi3InstantiateCoSimulation(\"arm\", \"token\", NULL, 0, 0, 0, 0, NULL, 0u, NULL, NULL, NULL)".to_owned(),
            format!("fmi3GetFloat64(arm, asked, {asked}u, seen, {asked}u)"),
            format!("fmi3SetFloat64(arm, given, {given}u, values, {given}u)"),
            format!("fmi3DoStep(arm, i * {duration:?}, {duration:?}, true, &a, &b, &c, &last)"),
        ),
    };
    let own = if version == FmiVersion::Three { "    bool a, b, c;\n    double last;\n" } else { "" };
    let free = if version == FmiVersion::Two { "fmi2FreeInstance" } else { "fmi3FreeInstance" };
    let (steps, begin) = (steps.to_string(), begin.as_str());
    [
        ("DECLARATIONS", declarations),
        ("REFERENCES", &references),
        ("ASKED", &printed),
        ("VALUES", &values),
        ("OWN", own),
        ("BEGIN", begin),
        ("PUT", &put),
        ("STEPS", &steps),
        ("STEP", &step),
        ("GET", &get),
        ("FREE", free),
    ]
    .into_iter()
    .fold(MAIN.to_owned(), |text, (place, part)| text.replace(place, part))
}

/// q, q̇ and a third array, of moderate size.
fn state(dof: usize) -> [Vec<f64>; 3] {
    let mut rng = fastrand::Rng::with_seed(5);
    [0.4, 0.3, 0.8].map(|size| (0..dof).map(|_| size * (2.0 * rng.f64() - 1.0)).collect())
}

fn references(first: usize, values: &[f64]) -> Vec<(usize, f64)> {
    values.iter().enumerate().map(|(index, value)| (first + index, *value)).collect()
}

/// A payload, in the order of its variables.
const PAYLOAD: [f64; 10] = [1.5, 0.05, -0.03, 0.1, 0.012, 0.015, 0.009, 0.001, -0.002, 0.0015];

/// The classical method of order 4, in its usual form for ẋ = f(x), with a payload at the tip.
fn runge_kutta(arm: &DynArm, q: &[f64], qd: &[f64], tau: &[f64], payload: &Payload<f64>) -> Vec<f64> {
    let (dof, h, steps) = (q.len(), 0.001, 50);
    let rate = |x: &[f64]| -> Vec<f64> {
        let (q, qd) = x.split_at(dof);
        [qd.to_vec(), arm.forward_dynamics_with_payload(q, qd, tau, payload).expect("one per joint")].concat()
    };
    let moved = |x: &[f64], by: f64, k: &[f64]| -> Vec<f64> { x.iter().zip(k).map(|(x, k)| x + by * k).collect() };
    let mut x = [q, qd].concat();
    for _ in 0..steps {
        let a = rate(&x);
        let b = rate(&moved(&x, 0.5 * h, &a));
        let c = rate(&moved(&x, 0.5 * h, &b));
        let d = rate(&moved(&x, h, &c));
        for index in 0..x.len() {
            x[index] += h / 6.0 * (a[index] + 2.0 * b[index] + 2.0 * c[index] + d[index]);
        }
    }
    x
}

fn assert_close(found: &[f64], expected: &[f64], tolerance: f64, name: &str) {
    assert_eq!(found.len(), expected.len(), "{name}");
    let largest = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance * largest, "{name}: {found}, not {expected}");
    }
}

#[test]
fn co_simulation_is_the_trajectory_of_the_runtime() {
    for robot in robots() {
        let arm = DynArm::from_robot(&robot);
        let dof = robot.dof();
        let [q, qd, more] = state(dof);
        let hold = arm.inverse_dynamics(&q, &qd, &vec![0.0; dof]).expect("one per joint");
        let tau: Vec<f64> = hold.iter().zip(&more).map(|(hold, more)| hold + more).collect();
        let varying = with_inertial_parameters(robot.clone());
        // a payload that the program does not set is zero, because the start values of its variables are zero
        for (version, payload) in VERSIONS.into_iter().flat_map(|version| [(version, None), (version, Some(PAYLOAD))]) {
            let expected = payload.map_or(Payload::none(), Payload::from_array);
            let expected = runge_kutta(&arm, &q, &qd, &tau, &expected);
            let files = files(&varying, version, FmuCausality::Forward);
            let count = file(&files, "modelDescription.xml").matches(" causality=").count();
            let held = payload.map_or(vec![], |payload| references(count - 10, &payload));
            let set = [references(1, &q), references(1 + dof, &qd), references(1 + 3 * dof, &tau), held].concat();
            let print: Vec<usize> = (1..=2 * dof).collect();
            let main = driver(version, &set, 5, 0.01, &print);
            let Some(found) = printed(&varying, &files, &main) else { return };
            assert_close(&found, &expected, 1e-10, &robot.name);
        }
    }
}

#[test]
fn inverse_dynamics_follow_parameters_that_are_set() {
    for robot in robots() {
        let dof = robot.dof();
        let [q, qd, qdd] = state(dof);
        let varying = with_inertial_parameters(robot.clone());
        // every number of the file times 1.25
        let values: Vec<f64> = varying.run_time.values(&varying).iter().map(|value| 1.25 * value).collect();
        let changed = varying.with_parameters(&values).expect("as many");
        let expected = DynArm::from_robot(&changed).inverse_dynamics(&q, &qd, &qdd).expect("one per joint");
        for version in VERSIONS {
            let files = files(&varying, version, FmuCausality::Inverse);
            let xml = file(&files, "modelDescription.xml");
            let starts = xml.lines().filter(|line| line.contains("causality=\"parameter\"")).map(|line| {
                let number = |name| attributes(line, name)[0];
                (number("valueReference").parse().expect("it"), 1.25 * number("start").parse::<f64>().expect("it"))
            });
            let set: Vec<(usize, f64)> = [references(1, &q), references(1 + dof, &qd), references(1 + 2 * dof, &qdd)]
                .concat()
                .into_iter()
                .chain(starts)
                .collect();
            let print: Vec<usize> = (1 + 3 * dof..=4 * dof).collect();
            let Some(found) = printed(&varying, &files, &driver(version, &set, 1, 0.01, &print)) else { return };
            assert_close(&found, &expected, 1e-12, &robot.name);
        }
    }
}

/// A program that steps an FMU and prints for each step whether its status and the logged words are the expected ones.
/// Words in capitals are replaced.
const STEPPING: &str = r#"#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include "fmi-types.h"
DECLARATIONS
static char said[512];
LOGGER
int main(void)
{
    const double inf = HUGE_VAL, nan = inf - inf, one = 1.0;
    OWN
    (void)nan, (void)inf, (void)one;
    if (arm == NULL) {
        return 1;
    }
STEPS    FREE(arm);
    return 0;
}
"#;

/// Steps that cannot be are refused in words of their own, and change nothing.
#[test]
fn steps_that_cannot_be_are_refused_in_words() {
    let robot = robots().remove(0);
    let (varying, dof) = (with_inertial_parameters(robot.clone()), robot.dof());
    let size = "the step size is negative or not finite; it must be 0 s or more";
    let time = "the time at which the step begins is not finite";
    // what is set before the step, its time and size, and what is logged
    let of_both = [
        ("", "0.0, 0.01", ""),
        ("", "0.01, nan", size),
        ("", "0.01, -0.01", size),
        ("", "0.01, inf", size),
        ("", "nan, 0.01", time),
        ("", "-inf, 0.01", time),
        ("", "0.0, 0.01", "the step begins before the end of the last step"),
        // nothing has changed, and sums of times differ by rounding
        ("", "0.01 - 1e-12, 0.01", ""),
        ("", "0.02, 0.0", ""),
        ("", "0.5, 0.01", ""),
    ];
    let parameter = 1 + 4 * dof;
    let set = |reference: usize, value: &str| format!("{reference}, {value}");
    let (longer, none, back) = (set(parameter, "1e-12"), set(parameter, "0.0"), set(parameter, "0.001"));
    let (torque, rate) = (set(1 + 3 * dof, "nan"), set(1 + dof, "nan"));
    let finite = set(1 + dof, "one");
    let of_forward = [
        (longer.as_str(), "0.51, 0.01", "the step is 1e9 times as long as the parameter step"),
        (&none, "0.51, 0.01", "the parameter step is not above 0 s"),
        (&back, "0.51, 0.01", ""),
        (&torque, "0.52, 0.01", "the motion does not stay finite during the step"),
    ];
    let of_inverse =
        [(rate.as_str(), "0.51, 0.01", "an input or a parameter is not finite"), (&finite, "0.51, 0.01", "")];
    for version in VERSIONS {
        for (causality, own) in [(FmuCausality::Forward, &of_forward[..]), (FmuCausality::Inverse, &of_inverse[..])] {
            let cases: Vec<_> = of_both.iter().chain(own).collect();
            let Some(found) = printed(&varying, &files(&varying, version, causality), &stepping(version, &cases))
            else {
                return;
            };
            for (case, as_expected) in cases.iter().zip(&found) {
                assert!(*as_expected == 1.0, "{version:?}, {causality:?}, {case:?}");
            }
            assert_eq!(found.len(), cases.len());
        }
    }
}

/// The program [`STEPPING`] for these steps.
fn stepping(version: FmiVersion, cases: &[&(&str, &str, &str)]) -> String {
    let is_two = version == FmiVersion::Two;
    let (set, step) = if is_two {
        ("fmi2SetReal(arm, &r, 1u, &v)", "fmi2DoStep(arm, TIMES, 1)")
    } else {
        ("fmi3SetFloat64(arm, &r, 1u, &v, 1u)", "fmi3DoStep(arm, TIMES, true, &a, &b, &c, &last)")
    };
    let mut steps = String::new();
    for (given, times, words) in cases {
        let before = given.split_once(", ").map_or_else(String::new, |(reference, value)| {
            format!(
                "        const unsigned r = {reference};\n        const double v = {value};\n        (void){set};\n"
            )
        });
        let (status, step) = (if words.is_empty() { 0 } else { 3 }, step.replace("TIMES", times));
        let _ = write!(
            steps,
            "    {{\n{before}        said[0] = 0;\n        const int status = (int){step};\n        \
             printf(\"%d\\n\", status == {status} && strstr(said, \"{words}\") == said);\n    }}\n"
        );
    }
    // the declarations are those of the other program
    let other = driver(version, &[], 0, 0.0, &[]);
    let is_declaration = |line: &&str| line.starts_with("fmi") || line.starts_with("void fmi");
    let declarations = other.lines().filter(is_declaration).collect::<Vec<_>>().join("\n");
    let (logger, own) = if is_two {
        (
            "static void log_message(void *e, const char *name, fmi2Status status, const char *category, const char \
             *format, ...)\n{\n    va_list list;\n    (void)e, (void)name, (void)status, (void)category;\n    \
             va_start(list, format);\n    vsnprintf(said, sizeof said, format, list);\n    va_end(list);\n}\n",
            "fmi2CallbackFunctions calls;\n    void *arm;\n    memset(&calls, 0, sizeof calls);\n    calls.logger = \
             log_message;\n    arm = fmi2Instantiate(\"arm\", fmi2CoSimulation, \"token\", NULL, &calls, 0, 1);",
        )
    } else {
        (
            "static void log_message(void *e, fmi3Status status, const char *category, const char *text)\n{\n    \
             (void)e, (void)status, (void)category;\n    snprintf(said, sizeof said, \"%s\", text);\n}\n",
            "bool a, b, c;\n    double last;\n    void *arm = fmi3InstantiateCoSimulation(\"arm\", \"token\", NULL, 0, \
             1, 0, 0, NULL, 0u, NULL, log_message, NULL);",
        )
    };
    let free = if is_two { "fmi2FreeInstance" } else { "fmi3FreeInstance" };
    [("DECLARATIONS", declarations.as_str()), ("LOGGER", logger), ("OWN", own), ("STEPS", &steps), ("FREE", free)]
        .into_iter()
        .fold(STEPPING.to_owned(), |text, (place, part)| text.replace(place, part))
}

#[test]
fn descriptions_list_each_variable_once() {
    for robot in robots() {
        let dof = robot.dof();
        let robot = with_inertial_parameters(robot);
        for (version, causality) in VERSIONS
            .into_iter()
            .flat_map(|version| [FmuCausality::Forward, FmuCausality::Inverse].map(|of| (version, of)))
        {
            let files = files(&robot, version, causality);
            let xml = file(&files, "modelDescription.xml");
            let variables: Vec<&str> = xml.lines().filter(|line| line.contains(" causality=")).collect();
            for (index, line) in variables.iter().enumerate() {
                assert_eq!(attributes(line, "valueReference"), [index.to_string()], "{line}");
            }
            let names: BTreeSet<&str> = variables.iter().map(|line| attributes(line, "name")[0]).collect();
            assert_eq!(names.len(), variables.len(), "{names:?}");
            for joint in robot.independent_joints() {
                for kind in ["q", "qd", "qdd", "tau"] {
                    assert!(names.contains(format!("{kind}.{}", joint.name).as_str()), "{kind}, {names:?}");
                }
            }
            let count = |causality: &str| xml.matches(&format!("causality=\"{causality}\"")).count();
            let outputs = if causality == FmuCausality::Forward { 3 } else { 1 };
            assert_eq!([count("output"), count("input")], [outputs * dof, (4 - outputs) * dof]);
            let states = if causality == FmuCausality::Forward { 2 * dof } else { 0 };
            assert_eq!(attributes(xml, "derivative").len(), states);
        }
    }
}

/// A name may be any text: `&`, quotes, letters of other alphabets.
#[test]
fn names_of_joints_stay_xml() {
    let mut robot = robots().remove(0);
    robot.joints[0].name = "a \"b\" <c> & d\u{7}é".to_owned();
    robot.title = Some("<title> & more".to_owned());
    let mut description = String::new();
    for version in VERSIONS {
        let files = files(&with_inertial_parameters(robot.clone()), version, FmuCausality::Forward);
        let _ = write!(description, "{}", file(&files, "modelDescription.xml"));
    }
    assert!(description.contains("name=\"q.a &quot;b&quot; &lt;c&gt; &amp; d é\""), "{description}");
    assert!(description.contains("variableNamingConvention=\"flat\""));
    let tags = |c: char| description.matches(c).count();
    assert_eq!([tags('<'), tags('"') % 2], [tags('>'), 0]);
}
