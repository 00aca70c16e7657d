//! Whatever the bytes, a robot file is a robot or a report: no panic, bounded work, and the robot can be used.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rne_model::Reader;
use rne_runtime::DynArm;

fuzz_target!(|bytes: &[u8]| {
    let checked = Reader::new("x.yaml").read(bytes);
    let is_valid = checked.is_ok();
    let report = match &checked {
        Ok(checked) => &checked.lints,
        Err(report) => report,
    };
    assert_eq!(report.has_errors(), !is_valid);
    assert!(report.work() <= 1000 + 100 * bytes.len(), "{} steps for {} bytes", report.work(), bytes.len());
    for found in &report.diagnostics {
        assert!(report.text.get(found.span.clone()).is_some(), "{:?}", found.span);
    }
    report.render(true);
    report.short();
    let varying = Reader::new("x.yaml").run_time(&["m"]).read(bytes);
    assert!(is_valid || varying.is_err(), "no error is forgiven at run time");
    let _ = Reader::new("x.yaml").trees().couplings().loops().read(bytes);
    if let Ok(checked) = checked {
        let zeros = vec![0.0; checked.robot.dof()];
        let torques = DynArm::from_robot(&checked.robot).inverse_dynamics(&zeros, &zeros, &zeros);
        assert_eq!(torques.map(|torques| torques.len()), Ok(checked.robot.dof()));
        // what is written is read again
        let text = rne_convert::robot_file::write(&checked.robot);
        let again = Reader::new("again.yaml").read(&text);
        let again = again.unwrap_or_else(|report| panic!("{report}\n{text}")).robot;
        for (old, new) in checked.robot.joints.iter().zip(&again.joints) {
            assert_eq!((old.row.kind, old.row.dh), (new.row.kind, new.row.dh), "{text}");
        }
    }
});
