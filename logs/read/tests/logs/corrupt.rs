//! Files that are cut off, and files with other bytes: a message with the file's name, or numbers, never a panic.

use std::fs;
use std::path::Path;

use parquet::file::properties::WriterProperties;
use rne_logs::Options;

use crate::bags::bag;
use crate::formats::{mcap, npy, scalars};
use crate::written::{csv, file, runs};

fn samples() -> Vec<(&'static str, Vec<u8>)> {
    let times: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.01).collect();
    let compressed = parquet::basic::Compression::SNAPPY;
    vec![
        ("bag.db3", fs::read(bag("panda.db3")).unwrap()),
        ("plain.mcap", mcap(&times, None, &["/joint_states"])),
        ("zstd.mcap", mcap(&times, Some(mcap::Compression::Zstd), &["/joint_states"])),
        ("lz4.mcap", mcap(&times, Some(mcap::Compression::Lz4), &["/joint_states"])),
        ("log.parquet", scalars(&times, WriterProperties::builder().set_compression(compressed).build())),
        ("log.npy", npy(&times, true, "<f8")),
        ("log.csv", csv(&times).into_bytes()),
    ]
}

/// Reads a file to its end.
fn read(path: &Path) -> Result<usize, String> {
    let options = Options { cutoff: Some(5.0), ..Options::default() };
    let read = runs(&[path.to_owned()], options, 1000).map_err(|error| error.to_string());
    if let Err(error) = &read {
        assert!(error.contains(&path.display().to_string()) && error.len() < 600, "{error}");
    }
    read.map(|runs| runs.iter().map(|(_, motion)| motion.len()).sum())
}

#[test]
fn files_that_are_cut_off_say_so() {
    for (name, bytes) in samples() {
        let cuts = 60;
        for cut in 0..cuts {
            let length = bytes.len() * cut / cuts + cut % 7;
            let (_folder, path) = file(name, &bytes[..length]);
            let read = read(&path);
            // a CSV may be cut at a line's end, or within a number
            if name != "log.csv" {
                assert!(read.is_err(), "{name} of {length} bytes");
            }
        }
        // the last byte
        if name != "log.csv" {
            let (_folder, path) = file(name, &bytes[..bytes.len() - 1]);
            assert!(read(&path).is_err(), "{name}");
        }
        let (_folder, path) = file(name, &bytes);
        let read = read(&path);
        assert!(matches!(read, Ok(states) if states > 50), "{name}: {read:?}");
    }
}

#[test]
fn other_bytes_never_panic() {
    let mut random = fastrand::Rng::with_seed(11);
    let tries = if std::env::var_os("RNE_EXHAUSTIVE").is_some() { 3000 } else { 150 };
    for (name, bytes) in samples() {
        for _ in 0..tries {
            let mut bytes = bytes.clone();
            for _ in 0..random.usize(1..6) {
                // heads and ends have the most to say
                let place = match random.u8(0..3) {
                    0 => random.usize(0..bytes.len().min(300)),
                    1 => bytes.len() - 1 - random.usize(0..bytes.len().min(900)),
                    _ => random.usize(0..bytes.len()),
                };
                bytes[place] = if random.bool() { random.u8(..) } else { bytes[place] ^ (1 << random.u8(0..8)) };
            }
            let (_folder, path) = file(name, &bytes);
            let _ = read(&path);
        }
    }
}
