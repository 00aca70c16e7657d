//! Explains in words why a program in the reduced form can be trusted.

use rne_codegen::{Form, Order, Program, Proof, Scales};

/// Returns the form of a program, its proof and its choices, one sentence or choice per line.
#[must_use]
pub fn evidence(program: &Program, proof: &Proof) -> Vec<String> {
    let meaning = if program.function.returns_torques() {
        "only the torques keep a physical meaning."
    } else {
        "only what is returned keeps a meaning."
    };
    let form = match () {
        () if program.is_rewritten => format!("Reduced form, rewritten by algebra: fewest operations; {meaning}"),
        () if !program.choices.is_empty() => format!("Reduced form: fewest operations; {meaning}"),
        () => "Reduced form: the plain formulas, every value computed once however it comes about.".to_owned(),
    };
    let (what, largest) =
        if program.function.returns_torques() { ("all torques", "torque") } else { ("all results", "result") };
    let mut lines = vec![
        form,
        format!(
            "Identical to the seven steps but for a probability below 1e-100: {what} agree at {} random points of the \
            fields of 2^61 - 1 and 2^61 - 31.",
            proof.points
        ),
        match proof.states {
            0 => format!(
                "Rounding was measured at no state: each {largest} is zero or not finite at every random state."
            ),
            states => format!(
                "Rounding at {states} random states, in parts of the largest {largest}: {:.1e} (f64), {:.1e} (f32; \
                 seven steps {:.1e}).",
                proof.rounding, proof.single, proof.single_of_seven_steps
            ),
        },
    ];
    if program.order == Order::Registers {
        lines.push("Order: statements stand where few values are alive at once, not joint by joint.".to_owned());
    }
    for Scales { behind, length, force } in &program.scales {
        let links = behind.map_or_else(String::new, |joint| format!(" of the links from joint {joint} on"));
        lines.push(format!(
            "Scaled values{links}: lengths and the velocities and accelerations of points are multiplied by \
             {length:.6}, forces by {force:.6}, masses by {:.6}, so that constants become 1. Results are in SI units.",
            force / length
        ));
    }
    if !program.choices.is_empty() {
        lines.push("Choices:".to_owned());
        lines.extend(program.choices.iter().map(|choice| format!("  {choice}")));
    }
    lines
}

/// Returns the reduced forms of a function that were refused, and why; then the form that is used instead. No line if
/// none was refused.
#[must_use]
pub fn refusals(program: &Program) -> Vec<String> {
    if program.refusals.is_empty() {
        return Vec::new();
    }
    let form = match program.form {
        Form::SevenSteps => "its code is that of the seven steps",
        Form::Reduced => "its code is another one, which is proved",
    };
    let heading = format!("Not every reduced form of {} could be taken; {form}. Refused:", program.function);
    std::iter::once(heading).chain(program.refusals.iter().map(|refusal| format!("  {refusal}"))).collect()
}

/// Returns the functions for which single precision is not accurate enough, with their errors. No line if there is
/// none.
#[must_use]
pub fn losses(programs: &[Program]) -> Vec<String> {
    let lossy: Vec<_> = programs.iter().filter_map(|program| Some((program, program.loss?))).collect();
    if lossy.is_empty() {
        return Vec::new();
    }
    let heading = "Single precision (float, f32) is not enough for these functions. At random states, their largest \
                   errors in parts of the largest number that they return are more than 1e-4, or more than 1e-2 where \
                   they solve by the mass matrix:";
    let error = |error: f64| if error.is_finite() { format!("{error:.1e}") } else { "not finite".to_owned() };
    let errors = lossy.iter().map(|(program, loss)| format!("  {}, {}: {}", program.name, program.form, error(*loss)));
    let advice = if lossy.iter().any(|(program, _)| program.form == Form::SevenSteps) {
        "Compute them in double precision, or try the form reduced."
    } else {
        "Compute them in double precision."
    };
    std::iter::once(heading.to_owned()).chain(errors).chain([advice.to_owned()]).collect()
}
