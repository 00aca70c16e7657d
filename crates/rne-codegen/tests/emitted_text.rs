//! The text for people and the tokens for the macro are one program, and its operators are what the counts say.

mod common;

use quote::quote;
use rne_codegen::emit;
use syn::visit::{self, Visit};

/// The functions of an emitted file, by name.
fn functions(text: &str) -> Vec<syn::ItemFn> {
    let file = syn::parse_file(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    file.items.into_iter().filter_map(|item| if let syn::Item::Fn(f) = item { Some(f) } else { None }).collect()
}

#[test]
fn text_parses_back_to_the_tokens() {
    for (robot, programs) in common::compiled() {
        let functions = functions(&emit::rust_file(&robot, &programs));
        assert_eq!(functions.len(), programs.len());
        for (program, function) in programs.iter().zip(functions) {
            assert_eq!(function.sig.ident, program.function.name());
            let statements = &function.block.stmts;
            let tokens = emit::Body::new(program, &quote!(Scalar)).whole();
            let (text, tokens) = (quote!(#(#statements)*).to_string(), tokens.to_string());
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
    other: Vec<String>,
    calls: Vec<String>,
    angles: usize,
}

impl<'ast> Visit<'ast> for Counter {
    fn visit_expr_binary(&mut self, node: &'ast syn::ExprBinary) {
        match node.op {
            syn::BinOp::Mul(_) => self.mul += 1,
            syn::BinOp::Add(_) | syn::BinOp::Sub(_) => self.add += 1,
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
    for (robot, programs) in common::compiled() {
        for (program, function) in programs.iter().zip(functions(&emit::rust_file(&robot, &programs))) {
            let mut counter = Counter::default();
            counter.visit_block(&function.block);
            let counted = program.operations();
            assert_eq!(
                (counter.mul, counter.add),
                (counted.mul, counted.add),
                "{} of {}",
                program.function,
                robot.name
            );
            assert_eq!(counted.div, 0);
            assert!(counter.other.is_empty(), "no branch, loop, index or method: {:?}", counter.other);
            let called = |name: &str| counter.calls.iter().filter(|call| *call == name).count();
            let (one, several) = (called("Scalar :: sin_cos"), called("Scalar :: sin_cos_array"));
            // all angles in one call
            assert_eq!((one, several), (usize::from(counted.sincos == 1), usize::from(counted.sincos > 1)));
            assert_eq!(counter.angles, counted.sincos);
            let constants = counter.calls.iter().filter(|call| *call == "Scalar :: from_f64").count();
            assert_eq!(one + several + constants, counter.calls.len(), "nothing else is called: {:?}", counter.calls);
            let statements = function.block.stmts.len();
            assert!(statements > counted.statements, "arguments, constants and the result come on top");
        }
    }
}

#[test]
fn the_same_file_gives_the_same_bytes() {
    let text = || -> Vec<String> {
        common::all().iter().map(|robot| emit::rust_file(robot, &common::programs(robot))).collect()
    };
    assert_eq!(text(), text());
}

#[test]
fn rustfmt_has_nothing_to_change() {
    use std::io::Write;
    use std::process::{Command, Stdio};
    if Command::new("rustfmt").arg("--version").output().is_err() {
        eprintln!("rustfmt is not installed: nothing to compare with");
        return;
    }
    for robot in common::shipped() {
        let text = emit::rust_file(&robot, &common::programs(&robot));
        let reduced = emit::rust_file(&robot, &common::reduced_programs(&robot)[..5]);
        for text in [text, reduced] {
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
    for robot in common::shipped() {
        let programs = common::reduced_programs(&robot);
        for program in &programs {
            let proof = program.proof.expect("a proof");
            assert!(proof.rounding < 1e-13, "{} of {}: {}", program.function, robot.name, proof.rounding);
            assert!(
                proof.single <= 4.0 * proof.single_of_seven_steps.max(1e-7),
                "{} of {}: {proof:?}",
                program.function,
                robot.name
            );
            assert_eq!(proof.points, 4);
        }
        let text = emit::rust_file(&robot, &programs);
        assert!(text.contains("Proved identical to the seven steps"), "{text}");
    }
}
