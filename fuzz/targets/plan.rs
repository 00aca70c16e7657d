//! Whatever the text, a plan file is refused, or what it makes is proved or refused: no panic, and no wrong program.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use rne_codegen::{Compiler, Form};
use rne_model::Robot;
use rne_search::PlanFile;

/// The robot whose plans are read: small, so that a proof takes little time.
static ROBOT: LazyLock<Robot> =
    LazyLock::new(|| Robot::from_yaml(include_str!("../../robots/spherical_rrp.yaml")).expect("a shipped robot"));

fuzz_target!(|text: &str| {
    match PlanFile::read("x.plan.yaml", text, &ROBOT) {
        Err(report) => {
            report.render(true);
        }
        Ok(plan) => {
            let written = plan.to_yaml();
            let again = PlanFile::read("again.plan.yaml", &written, &ROBOT);
            assert!(again.is_ok(), "what is written is read again:\n{written}");
            for (function, plans) in plan.described(&ROBOT) {
                // a program is proved before it is returned
                let _ = Compiler::new(&ROBOT).with_plans(plans).compile(function, Form::Reduced);
            }
        }
    }
});
