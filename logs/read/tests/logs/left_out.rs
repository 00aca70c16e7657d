//! A build without a format says which command reads it.

use rne_logs::{Options, Remedy};

use crate::written::{file, survey};

#[test]
fn a_format_that_is_left_out_names_the_command_that_has_it() {
    for (name, beginning, format) in [
        ("bag.db3", b"SQLite format 3\0".as_slice(), "rosbag2, SQLite"),
        ("bag.mcap", b"\x89MCAP0\r\n", "rosbag2, MCAP"),
        ("table.parquet", b"PAR1", "Parquet"),
    ] {
        let (_folder, path) = file(name, beginning);
        let error = survey(&[path], Options::default()).map(|_| ()).unwrap_err();
        assert_eq!(error.remedies(), [Remedy::BuildWithFormats]);
        let error = error.to_string();
        for part in [name, format] {
            assert!(error.contains(part), "no `{part}` in {error}");
        }
    }
}
