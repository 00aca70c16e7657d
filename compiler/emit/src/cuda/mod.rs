//! Writes programs as a header of functions for CUDA and C++: templates over the number type.

use std::fmt::Write as _;

use rne_codegen::{ArgumentArray, Program};
use rne_model::Robot;

use crate::ascii::ascii;
use crate::c::{Additions, ConstantTooLarge, File, Prefix, SIN_COS, UNUSED, array_name, comment, header};
use crate::expression::line;
use crate::line_breaks::statement;
use crate::listing::{Line, Selection, listing};
use crate::ptx::heading;
use crate::syntax::{Precision, Syntax};
use crate::wrap::{WIDTH, fill};

/// The properties that all functions share, as text for the heading.
const CONTRACT: [&str; 3] = [
    "Functions for one state, for the host and for the device, over float, double or any other number type with +, -, \
     *, /, comparisons and a function PREFIX_sin_cos. All arrays are flat, in the order of the comments; the results \
     may be written over arguments. No loop, no branch, no memory but the stack, no library.",
    "Sines and cosines are computed here, with errors below 1 ulp for angles up to 1e5 rad, the sums of those of \
     parallel joints included; beyond that results mean nothing.",
    "With -ffp-contract=off, for nvcc -fmad=false, the results are those of the code in C and in Rust built without \
     fused multiply-add, bit for bit.",
];

const BEGIN: &str = "\
#if defined(__CUDACC__) || defined(__HIPCC__)
#define RNE_HOST_DEVICE __host__ __device__
#else
#define RNE_HOST_DEVICE
#endif
#endif
";

/// Writes the programs of one robot as one header, which any C++ compiler accepts as well.
///
/// # Errors
/// When a constant is not finite.
pub fn cuda(
    robot: &Robot,
    programs: &[Program],
    prefix: &Prefix,
    additions: &Additions<'_>,
) -> Result<String, ConstantTooLarge> {
    let prefix = prefix.as_str();
    let file = File { robot, programs, precision: Precision::Double, prefix, additions };
    let mut text = header::title(&file) + &header::robot(&file);
    for words in CONTRACT {
        text.push_str("//\n");
        text.push_str(&comment("//", &words.replace("PREFIX", prefix)));
    }
    text.push_str(&header::counts(programs));
    let guard = prefix.to_ascii_uppercase();
    let _ = write!(
        text,
        "\n#ifndef {guard}_CUH\n#define {guard}_CUH\n\n#include <cfloat>\n#include <cstdint>\n\n\
         #ifndef RNE_HOST_DEVICE\n{BEGIN}"
    );
    if file.turns() {
        for (block, name) in SIN_COS.iter().zip(["float", "double"]) {
            let block = block.rsplit("#else\n").next().unwrap_or_default().trim_end().trim_end_matches("#endif");
            let block = block.replace("static void", "RNE_HOST_DEVICE inline void");
            let block = block.replace("PREFIX_bits", &format!("{prefix}_bits_of_{name}")).replace("PREFIX", prefix);
            text.push_str(block.trim_end());
            text.push('\n');
        }
    }
    if file.chooses_by_sign() {
        let _ = write!(
            text,
            "\n// `positive` where x is above 0, `negative` where it is below, else 0.\ntemplate <typename T>\n\
             RNE_HOST_DEVICE inline T {prefix}_by_sign(T x, T positive, T negative)\n{{\n    \
             return (x > T(0)) ? positive : ((x < T(0)) ? negative : T(0));\n}}\n"
        );
    }
    for program in programs {
        text.push('\n');
        text.push_str(&heading(program));
        text.push_str(&function(&file, program)?);
    }
    text.push_str("\n#endif\n");
    Ok(ascii(&text))
}

fn function(file: &File<'_>, program: &Program) -> Result<String, ConstantTooLarge> {
    let syntax = Syntax::Cuda { prefix: file.prefix };
    let arrays = program.argument_arrays();
    let output = Some(program.function.entry().output).filter(|name| !name.is_empty()).unwrap_or("result");
    let parameters = arrays.iter().map(|array| {
        let name = array_name(array.name);
        if array.is_number { format!("T {name}") } else { format!("const T *{name}") }
    });
    let parameters: Vec<String> = parameters.chain([format!("T *{output}")]).collect();
    let parameters = fill(&parameters.join(", "), WIDTH, "    ", "    ");
    let mut text = format!(
        "template <typename T>\nRNE_HOST_DEVICE inline void {}_{}(\n{parameters})\n{{\n",
        file.prefix, program.name
    );
    for ArgumentArray { name: array, elements, is_number, .. } in &arrays {
        let array = array_name(array);
        if elements.iter().all(Option::is_none) {
            let _ = writeln!(text, "    (void){array};");
        }
        for (index, name) in elements.iter().enumerate() {
            if let Some(name) = name {
                let place = if *is_number { String::new() } else { format!("[{index}]") };
                let _ = writeln!(text, "    const T {name} = {array}{place};");
            }
        }
    }
    for constant in program.constants() {
        let (name, value) = (constant.name, constant.value);
        let too_large = || ConstantTooLarge { name, value, function: program.function };
        let literal = Precision::Double.literal(value).ok_or_else(too_large)?;
        let _ = writeln!(text, "    const T {name} = T({literal});");
    }
    for statement in &program.angles {
        let _ = writeln!(text, "{}", Line::statement(program, statement).indented(syntax));
    }
    let turns = &program.sines_and_cosines;
    if turns.iter().any(|turn| turn.sine.is_none() || turn.cosine.is_none()) {
        let _ = writeln!(text, "    T {UNUSED};");
    }
    for turn in turns {
        let names = [turn.sine, turn.cosine].map(|name| name.map(|name| name.to_string()));
        for name in names.iter().flatten() {
            let _ = writeln!(text, "    T {name};");
        }
        let [sine, cosine] = names.map(|name| name.unwrap_or_else(|| UNUSED.to_owned()));
        let angle = line(syntax, program.values.used(turn.angle));
        let _ = writeln!(text, "    {}_sin_cos({angle}, &{sine}, &{cosine});", file.prefix);
    }
    text.push_str(&listing(file.robot, program, Selection::default()).text(syntax));
    for (index, result) in program.outputs.iter().enumerate() {
        let start = format!("{output}[{index}] =");
        let _ = writeln!(text, "{}", statement(syntax, "    ", start.into(), program.values.used(result.value)));
    }
    Ok(text + "}\n")
}
