//! The header is that of the functions: what cbindgen makes of the border. `RNE_WRITE_DOCUMENTS=1` writes it anew.

use std::path::Path;

#[test]
fn the_header_is_that_of_the_functions() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut config = cbindgen::Config::from_file(folder.join("cbindgen.toml")).expect("a configuration");
    config.header = Some(include_str!("../include/head.txt").trim_end().to_owned());
    let sources = ["status.rs", "handle.rs", "border.rs"].map(|file| folder.join("src").join(file));
    let builder = sources.iter().fold(cbindgen::Builder::new().with_config(config), cbindgen::Builder::with_src);
    let mut text = Vec::new();
    builder.generate().expect("a header").write(&mut text);
    let text = String::from_utf8(text).expect("UTF-8");
    // what Rust's readers are told stands in the words before it
    let mut told = String::new();
    let mut skips = false;
    for line in text.lines() {
        skips |= line.trim() == "* # Safety";
        skips &= !line.trim_start().starts_with("*/");
        if !skips {
            if line.trim_start().starts_with("*/") && told.ends_with(" *\n") {
                told.truncate(told.len() - 3);
            }
            told += line;
            told.push('\n');
        }
    }
    let path = folder.join("include/rne.h");
    if std::env::var_os("RNE_WRITE_DOCUMENTS").is_some() {
        std::fs::write(&path, &told).expect("the header can be written");
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(found == told, "include/rne.h is another: RNE_WRITE_DOCUMENTS=1 cargo test --test header");
}
