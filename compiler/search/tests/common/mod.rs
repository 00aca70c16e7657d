//! The robots of the repository.

use rne_model::{Reader, Robot};

pub(crate) fn robot(name: &str) -> Robot {
    let folder = match name {
        _ if name.starts_with("dense") => "tests/dense",
        "spindle" | "close_angles" | "about_origin" => "tests/random/files",
        _ if name.starts_with(|first: char| first.is_ascii_digit()) => "tests/random/files",
        _ => "robots",
    };
    let path = format!("{}/../../{folder}/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    Reader::new(name).read(&std::fs::read(path).unwrap()).unwrap().robot
}
