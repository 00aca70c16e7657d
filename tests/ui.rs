//! What the user sees: each likely mistake as the compiler reports it, and what has to compile without a word.
//!
//! The messages in `tests/ui/*.stderr` are rustc's of the toolchain that wrote them;
//! `TRYBUILD=overwrite cargo test --test ui` writes them again.

#[test]
fn mistakes_and_their_messages() {
    let cases = trybuild::TestCases::new();
    cases.compile_fail("tests/ui/*.rs");
    cases.pass("tests/ui/pass/*.rs");
}
