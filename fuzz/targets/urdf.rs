//! Whatever the text, a URDF is a chain or a report, and the robot file of a chain is read again as that robot.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rne_convert::{Options, Urdf};
use rne_model::{Convention, Reader};

fuzz_target!(|text: &str| {
    let Ok(urdf) = Urdf::read("x.urdf", text) else { return };
    let tip = urdf.leaves().first().map(|&leaf| leaf.to_owned());
    for convention in [Convention::Standard, Convention::Modified] {
        for keep in [false, true] {
            let mut options = Options::default();
            options.selection.tip.clone_from(&tip);
            options.selection.lock_others = true;
            options.convention = convention;
            options.keep_unphysical = keep;
            if let Ok(imported) = urdf.import(&options) {
                let again = Reader::new("x.yaml").read(&imported.text);
                let again = again.unwrap_or_else(|report| panic!("{report}\n{}", imported.text)).robot;
                assert_eq!(again.joints, imported.robot.joints, "{}", imported.text);
                let _ = rne_convert::export(&again);
            }
        }
    }
});
