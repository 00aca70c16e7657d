//! Whatever the text, an expression is a finite number or a message.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok(value) = rne_model::number(text) {
        assert!(value.is_finite(), "{text:?} is {value}");
    }
});
