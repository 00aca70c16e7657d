//! The text for people and the tokens for the macro are one program, and its operators are what the counts say.

#[path = "../../codegen/tests/common/mod.rs"]
mod common;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::process::Command;
use std::sync::OnceLock;

use quote::quote;
use rne_codegen::{Compiler, Form, Function, Program};
use rne_emit::{Precision, Prefix};
use rne_model::{Reader, Robot};
use syn::visit::{self, Visit};

/// What is emitted, compiled once for all tests.
fn emitted() -> &'static [(Robot, Vec<Program>)] {
    static EMITTED: OnceLock<Vec<(Robot, Vec<Program>)>> = OnceLock::new();
    EMITTED.get_or_init(common::compiled)
}

/// The functions of an emitted file, by name.
fn functions(text: &str) -> Vec<syn::ItemFn> {
    let file = syn::parse_file(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    file.items.into_iter().filter_map(|item| if let syn::Item::Fn(f) = item { Some(f) } else { None }).collect()
}

#[test]
fn text_parses_back_to_the_tokens() {
    for (robot, programs) in emitted() {
        let functions = functions(&rne_emit::rust_file(robot, programs));
        assert_eq!(functions.len(), programs.len());
        for (program, function) in programs.iter().zip(functions) {
            assert_eq!(function.sig.ident, program.function.name());
            let statements = &function.block.stmts;
            let tokens = rne_emit::Body::new(program, &quote!(Scalar)).whole();
            // the last element of a list that is broken has a comma too
            let text = quote!(#(#statements)*).to_string().replace(" ,]", "]").replace(" ,)", ")");
            // derived code takes the wrenches of all tips as one array, and the rows of a rotation
            let of_rows = |statement: &str| {
                ["wrenches", "base_rotation"].iter().any(|name| statement.ends_with(&format!("= * {name} ")))
            };
            let flat = |statement: &str| {
                if of_rows(statement) {
                    statement.replace("[[", "[").replace("]]", "]").replace("] , [", " , ")
                } else {
                    statement.to_owned()
                }
            };
            let text = text.split(';').map(flat).collect::<Vec<_>>().join(";");
            let tokens = tokens.to_string();
            let differs = text.split(';').zip(tokens.split(';')).find(|(text, tokens)| text != tokens);
            assert_eq!(differs, None, "{} of {}", program.function, robot.name);
            assert_eq!(text.len(), tokens.len(), "{} of {}", program.function, robot.name);
        }
    }
}

/// Counts operators and calls in Rust code: it knows nothing of the compiler.
#[derive(Default)]
struct Counter {
    mul: usize,
    add: usize,
    div: usize,
    other: Vec<String>,
    calls: Vec<String>,
    angles: usize,
}

impl<'ast> Visit<'ast> for Counter {
    fn visit_expr_binary(&mut self, node: &'ast syn::ExprBinary) {
        match node.op {
            syn::BinOp::Mul(_) => self.mul += 1,
            syn::BinOp::Add(_) | syn::BinOp::Sub(_) => self.add += 1,
            syn::BinOp::Div(_) => self.div += 1,
            ref other => self.other.push(quote!(#other).to_string()),
        }
        visit::visit_expr_binary(self, node);
    }

    fn visit_expr_call(&mut self, node: &'ast syn::ExprCall) {
        let function = &node.func;
        let name = quote!(#function).to_string();
        self.angles += match node.args.first() {
            Some(syn::Expr::Array(angles)) if name == "Scalar :: sin_cos_array" => angles.elems.len(),
            _ => usize::from(name == "Scalar :: sin_cos"),
        };
        self.calls.push(name);
        visit::visit_expr_call(self, node);
    }

    fn visit_expr(&mut self, node: &'ast syn::Expr) {
        let plain = matches!(
            node,
            syn::Expr::Array(_)
                | syn::Expr::Binary(_)
                | syn::Expr::Call(_)
                | syn::Expr::Lit(_)
                | syn::Expr::Paren(_)
                | syn::Expr::Path(_)
                | syn::Expr::Tuple(_)
                | syn::Expr::Unary(syn::ExprUnary { op: syn::UnOp::Neg(_) | syn::UnOp::Deref(_), .. })
        );
        if !plain {
            self.other.push(quote!(#node).to_string());
        }
        visit::visit_expr(self, node);
    }
}

#[test]
fn operators_in_the_text_are_what_the_counts_say() {
    type File = fn(&Robot, &[Program]) -> String;
    let files: [(File, bool); 2] = [(rne_emit::rust_file, true), (rne_emit::rust_file_with_sin_cos, false)];
    for ((robot, programs), (file, has_array)) in emitted().iter().flat_map(|all| files.map(|file| (all, file))) {
        let text = file(robot, programs);
        // of a loop over angles, a compiler makes a branch
        assert!(has_array || !text.contains("sin_cos_array") && !text.contains(".map("), "{}", robot.name);
        for (program, function) in programs.iter().zip(functions(&text)) {
            let mut counter = Counter::default();
            counter.visit_block(&function.block);
            let counted = program.operations();
            assert_eq!(
                (counter.mul, counter.add, counter.div),
                (counted.mul, counted.add, counted.div),
                "{} of {}",
                program.function,
                robot.name
            );
            assert!(counter.other.is_empty(), "no branch, loop, index or method: {:?}", counter.other);
            let called = |name: &str| counter.calls.iter().filter(|call| *call == name).count();
            let (one, several) = (called("Scalar :: sin_cos"), called("Scalar :: sin_cos_array"));
            // all angles in one call, or each in its own where the file has the sine
            let in_one = (usize::from(counted.sincos == 1), usize::from(counted.sincos > 1));
            assert_eq!((one, several), if has_array { in_one } else { (counted.sincos, 0) });
            assert_eq!(counter.angles, counted.sincos);
            let (constants, signs) = (called("Scalar :: from_f64"), called("Scalar :: by_sign"));
            assert!(signs == 0 || program.function == Function::ActuatorTorques, "only friction asks for a sign");
            assert_eq!(
                one + several + constants + signs,
                counter.calls.len(),
                "nothing else is called: {:?}",
                counter.calls
            );
            let statements = function.block.stmts.len();
            assert!(statements > counted.statements, "arguments, constants and the result come on top");
        }
    }
}

/// A name that is given twice hides the first value from the statements behind the second: the compiler of Rust does
/// not mind, and the interpreter, which knows names by more than their text, does not see it.
#[test]
fn no_name_of_a_function_is_given_twice() {
    for (robot, programs) in emitted() {
        for program in programs {
            let turns = program.sines_and_cosines.iter().flat_map(|turn| turn.sine.into_iter().chain(turn.cosine));
            let statements = program.angles.iter().chain(&program.statements).map(|statement| statement.name);
            let constants = program.constants().map(|constant| constant.name);
            let names = program.arguments().chain(constants).chain(turns).chain(statements);
            let mut known = BTreeSet::new();
            for name in names {
                assert!(known.insert(name.to_string()), "{name} in {} of {}", program.function, robot.name);
            }
        }
    }
}

#[test]
fn the_same_file_gives_the_same_bytes() {
    for robot in common::all() {
        let again = common::programs(&robot);
        let (_, programs) = emitted().iter().find(|(other, _)| other.name == robot.name).expect("the same robot");
        assert!(rne_emit::rust_file(&robot, programs) == rne_emit::rust_file(&robot, &again), "{}", robot.name);
    }
}

#[test]
fn rustfmt_has_nothing_to_change() {
    use std::io::Write;
    use std::process::{Command, Stdio};
    if Command::new("rustfmt").arg("--version").output().is_err() {
        eprintln!("rustfmt is not installed: nothing to compare with");
        return;
    }
    for (robot, programs) in emitted() {
        // all functions of a robot that is shipped
        if programs.len() == Function::OF_TREES.len() {
            let text = rne_emit::rust_file_with_sin_cos(robot, programs) + &rne_emit::rust_joints(robot);
            let mut rustfmt = Command::new("rustfmt")
                .args(["--edition", "2024", "--check", "--config-path", "/dev/null"])
                .stdin(Stdio::piped())
                .stdout(Stdio::piped())
                .spawn()
                .expect("rustfmt starts");
            rustfmt.stdin.take().expect("a pipe").write_all(text.as_bytes()).expect("rustfmt reads");
            let output = rustfmt.wait_with_output().expect("rustfmt ends");
            let difference: String = String::from_utf8_lossy(&output.stdout).chars().take(2000).collect();
            assert!(difference.is_empty(), "{}:\n{difference}", robot.name);
        }
    }
}

#[test]
fn every_reduced_form_tells_its_proof() {
    for (robot, programs) in emitted() {
        // bearings and motors have the seven steps alone
        let reduced: Vec<&Program> = programs.iter().filter(|program| program.form != Form::SevenSteps).collect();
        if reduced.is_empty() {
            continue;
        }
        for program in reduced {
            let proof = program.proof.expect("a proof");
            assert!(proof.rounding < 1e-13, "{} of {}: {}", program.function, robot.name, proof.rounding);
            // single precision is demanded of the torques alone
            let is_torque = Function::TORQUES.contains(&program.function);
            assert!(
                !is_torque || proof.single <= 4.0 * proof.single_of_seven_steps.max(1e-7),
                "{} of {}: {proof:?}",
                program.function,
                robot.name
            );
            assert_eq!(proof.points, 4);
        }
        let text = rne_emit::rust_file(robot, programs);
        assert!(text.contains("Identical to the seven steps but for a probability below 1e-100"), "{text}");
    }
}

/// Every letter of the emitted C has a spelling in ASCII: one without it would be `_`.
#[test]
fn emitted_c_has_a_spelling_for_each_letter() {
    let loops = include_str!("../../../docs/four_bar.yaml");
    let loops = Reader::new("four_bar").trees().couplings().loops().read(loops).expect("a robot").robot;
    let compile = |function| Compiler::new(&loops).compile(function, Form::Reduced).expect("it compiles");
    let programs = rne_codegen::functions_of(&loops).map(compile).collect();
    let of_loops = (loops, programs);
    for (robot, programs) in emitted().iter().chain([&of_loops]) {
        let prefix = Prefix::of(robot);
        let code = rne_emit::c_code(robot, programs, Precision::Double, &prefix).expect("numbers of double").one_file();
        let ascii = rne_emit::ascii(&code);
        assert!(ascii.is_ascii(), "{}", robot.name);
        assert_eq!(ascii.matches('_').count(), code.matches('_').count(), "{}", robot.name);
    }
}

/// The emitted file is all that a crate without `std`, allocator and dependencies needs.
#[test]
fn emitted_files_build_alone_without_std() {
    let folder = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).expect("a folder");
    let mut library = "#![no_std]\n#![deny(warnings)]\n".to_owned();
    let files = [rne_emit::rust_file, rne_emit::rust_file_with_sin_cos];
    let is_small = |robot: &Robot| shipped::is_exhaustive() || robot.dof() <= 3 || robot.name == "puma560";
    let all = emitted().iter().filter(|(_, programs)| programs.len() == Function::OF_TREES.len());
    for (robot, programs) in all.filter(|(robot, _)| is_small(robot)) {
        let module = format!("{}_{}", robot.name, programs[0].form);
        let is_reduced = programs[0].form == Form::Reduced;
        let text = files[usize::from(is_reduced)](robot, programs) + &rne_emit::rust_joints(robot);
        fs::write(folder.path().join(format!("{module}.rs")), text).expect("written");
        let _ = writeln!(library, "pub mod {module};");
    }
    let robots = common::shipped().into_iter().filter(is_small).count();
    assert_eq!(library.matches("pub mod ").count(), 2 * robots, "every robot in two forms");
    fs::write(folder.path().join("lib.rs"), library).expect("written");
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let built = Command::new(rustc)
        .args(["--edition", "2024", "--crate-type", "lib", "--crate-name", "arms", "--emit", "metadata", "lib.rs"])
        .current_dir(folder.path())
        .output()
        .expect("rustc starts");
    let complaint: String = String::from_utf8_lossy(&built.stderr).chars().take(3000).collect();
    assert!(built.status.success() && complaint.is_empty(), "{complaint}");
}
