//! Files that commands write: whole or not at all, also where a signal or a full disk ends the writing; where they may
//! not go; and standard output in their place.

use std::fs;
use std::path::Path;

use crate::call::{Called, called, command, fails, folder, rne};

/// Everything in a folder.
fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
    let mut names: Vec<String> = names.map(|name| name.to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn in_folder(folder: &Path, arguments: &[&str]) -> Called {
    called(command(arguments).current_dir(folder).output().expect("rne starts"))
}

/// A name that says another format than what is written is refused, and nothing is written.
#[test]
fn files_are_not_named_for_what_they_do_not_hold() {
    let folder = folder("named_for_others");
    let log = env!("CARGO_MANIFEST_DIR").to_owned() + "/../docs/desk_arm_log.csv";
    let arm = env!("CARGO_MANIFEST_DIR").to_owned() + "/../docs/desk_arm_identified.yaml";
    in_folder(&folder, &["export", "planar2", "--urdf", "-o", "arm.urdf"]);
    let commands: [(&[&str], &[&str]); 10] = [
        (&["report", "planar2", "-o"], &["x.parquet", "x.yaml"]),
        (&["convert", "puma560", "--convention", "modified", "-o"], &["x.parquet", "x.urdf"]),
        (&["export", "planar2", "--urdf", "-o"], &["x.yaml"]),
        (&["import", "arm.urdf", "-o"], &["x.PARQUET", "x.csv"]),
        (&["emit", "planar2", "-o"], &["x.parquet", "x.yaml", "x.c"]),
        (&["emit", "planar2", "--lang", "c", "-o"], &["x.parquet", "x.rs"]),
        (&["new", "elbow", "--dof", "2", "-o"], &["x.csv"]),
        (&["identify", &arm, &log, "-o"], &["x.parquet", "x.json"]),
        (&["identify", &arm, &log, "--plot"], &["x.png", "x.yaml"]),
        (&["watch", &arm, &log, "--plot"], &["x.png", "x.csv"]),
    ];
    for (arguments, names) in commands {
        for name in names {
            let called = in_folder(&folder, &[arguments, &[name]].concat());
            assert_eq!(called.status, 2, "{arguments:?} {name}: {called:?}");
            assert!(called.err.contains("name it"), "{arguments:?} {name}: {}", called.err);
            assert!(!folder.join(name).exists(), "{name}");
        }
    }
    // a name may say nothing
    for (arguments, name) in [(&["emit", "planar2", "-o"][..], "arm.inc"), (&["report", "planar2", "-o"], "page")] {
        assert_eq!(in_folder(&folder, &[arguments, &[name]].concat()).status, 0, "{name}");
    }
}

/// Every command that writes a text takes `-` and `/dev/stdout` for standard output, and prints what it would write.
#[test]
fn a_dash_is_standard_output_everywhere() {
    let folder = folder("standard_output");
    let commands: [(&[&str], &str); 8] = [
        (&["report", "planar2"], "page.html"),
        (&["convert", "puma560", "--convention", "modified"], "arm.yaml"),
        (&["export", "planar2", "--urdf"], "arm.urdf"),
        (&["import", "arm.urdf"], "imported.yaml"),
        (&["plot", "planar2"], "plot.svg"),
        (&["plot", "planar2", "--csv"], "plot.csv"),
        (&["emit", "planar2"], "arm.rs"),
        (&["new", "elbow", "--dof", "2"], "new.yaml"),
    ];
    for (arguments, name) in commands {
        let with = |out: &str| {
            let called = in_folder(&folder, &[arguments, &["-o", out]].concat());
            assert_eq!(called.status, 0, "{arguments:?} {out}: {called:?}");
            called.out
        };
        with(name);
        let before = names(&folder);
        let text = fs::read_to_string(folder.join(name)).expect(name);
        for out in ["-", "/dev/stdout"] {
            assert_eq!(with(out), text, "{arguments:?} {out}");
        }
        assert_eq!(names(&folder), before, "{arguments:?}");
    }
    let states = folder.join("states.csv");
    fs::write(&states, "q1,q2\n0.1,0.2\n").expect("written");
    let arguments = ["eval", "planar2", "--function", "gravity_torques", "--states", "states.csv"];
    let printed = in_folder(&folder, &arguments).out;
    assert!(printed.starts_with("tau1,tau2\n"), "{printed}");
    let before = names(&folder);
    for out in ["-", "/dev/stdout"] {
        assert_eq!(in_folder(&folder, &[&arguments[..], &["-o", out]].concat()).out, printed);
    }
    // what is no text for standard output
    for (arguments, said) in [
        (&["firmware", "torque", "-o", "-"][..], "a firmware is a folder"),
        (&["man", "-o", "-"], "needs the name of a folder for the pages"),
        (&["excite", "planar2", "--plot", "-"], "needs the name of a file, such as picture.svg"),
        (&["watch", "planar2", "states.csv", "--plot", "-"], "needs the name of a file, such as picture.svg"),
        (
            &["identify", "planar2", "states.csv", "--plot", "/dev/stdout"],
            "needs the name of a file, such as picture.svg",
        ),
        (&["emit", "planar2", "--check", "-"], "and not standard output"),
    ] {
        let called = in_folder(&folder, arguments);
        assert!(called.status == 2 && called.out.is_empty() && called.said().contains(said), "{called:?}");
    }
    assert_eq!(names(&folder), before);
}

/// What is there already is a matter of the command line, as `rne explain exit-status` says.
#[test]
fn what_is_there_already_stays() {
    let folder = folder("there_already");
    fs::write(folder.join("elbow.yaml"), "mine\n").expect("written");
    fs::create_dir(folder.join("place")).expect("a folder");
    let long = "x".repeat(5000);
    let long_file = format!("{long}.svg");
    for (arguments, said) in [
        (&["new", "elbow", "--dof", "2"][..], "elbow.yaml exists and is not changed"),
        (&["new", "elbow", "--dof", "2", "-o", "place"], "place exists and is not changed"),
        (&["man", "-o", "elbow.yaml"], "is not a folder"),
        (&["new", &long, "--dof", "2"], "its name is too long"),
        (&["plot", "planar2", "-o", &long_file], "its name is too long"),
        (&["emit", "planar2", "-o", &long], "its name is too long"),
        (&["firmware", "torque", "-o", &long], "its name is too long"),
    ] {
        let called = in_folder(&folder, arguments);
        assert!(called.status == 2 && called.out.is_empty(), "{called:?}");
        assert!(called.said().contains(said) && called.err.len() < 500, "no `{said}` in {called:?}");
    }
    assert_eq!(names(&folder), ["elbow.yaml", "place"]);
    assert_eq!(fs::read_to_string(folder.join("elbow.yaml")).expect("a file"), "mine\n");

    // as long as the system takes it, although the temporary file has a longer name
    let longest = format!("{}.rs", "x".repeat(240));
    assert_eq!(in_folder(&folder, &["emit", "planar2", "-o", &longest]).status, 0);
    assert!(folder.join(longest).is_file());
}

/// A header and its source belong together: neither is new where one cannot be written.
#[test]
fn a_pair_in_c_changes_together() {
    let folder = folder("pair");
    let path = |name: &str| folder.join(name);
    let emit = |robot: &str| in_folder(&folder, &["emit", robot, "--lang", "c", "--prefix", "arm", "-o", "arm.c"]);
    assert_eq!(emit("planar1").status, 0);
    let read = || ["arm.h", "arm.c"].map(|name| fs::read_to_string(path(name)).expect(name));
    let old = read();
    let mut permissions = fs::metadata(path("arm.c")).expect("a file").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(path("arm.c"), permissions.clone()).expect("permitted");
    let refused = emit("planar2");
    assert!(refused.status == 1 && refused.err.contains("arm.c cannot be written"), "{refused:?}");
    assert!(!refused.err.contains("wrote"), "{refused:?}");
    assert_eq!(read(), old);
    assert_eq!(names(&folder), ["arm.c", "arm.h"]);
    fs::remove_file(path("arm.c")).expect("removed");
    assert_eq!(emit("planar2").status, 0);
    let new = read();
    assert!(new[0] != old[0] && new[1] != old[1]);
}

#[test]
fn a_log_is_not_what_is_usual_in_itself() {
    let folder = folder("quiet");
    let log = folder.join("a.csv");
    fs::copy(format!("{}/docs/desk_arm_log.csv", crate::call::ROOT), &log).expect("a copy");
    let (log, folder) = (log.to_str().expect("UTF-8"), folder.to_str().expect("UTF-8"));
    let dotted = format!("{folder}/./a.csv");
    for quiet in [log, &dotted, folder] {
        let arguments = ["watch", "docs/desk_arm_identified.yaml", log, "--quiet", quiet];
        fails(2, &arguments, &["is also watched", "--quiet"]);
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_told_by_every_text() {
    for arguments in [
        &["--help"][..],
        &["--version"],
        &["help", "emit"],
        &["emit", "--help"],
        &["completions", "bash"],
        &["man"],
        &["list"],
    ] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("a device");
        let called = called(command(arguments).stdout(full).output().expect("rne starts"));
        assert!(called.status == 1 && called.err.contains("the output cannot be written"), "{arguments:?}: {called:?}");
    }
    assert_eq!(rne(&["--help"]).status, 0);
}

#[cfg(unix)]
mod unix {
    use std::io::Write as _;
    use std::os::unix::process::ExitStatusExt as _;
    use std::process::{Child, Command, Stdio};
    use std::thread;
    use std::time::Duration;

    use nix::sys::signal::{Signal, kill};
    use nix::unistd::Pid;

    use super::*;
    use crate::call::Running;

    fn send(child: &Child, signal: Signal) {
        let process = Pid::from_raw(child.id().try_into().expect("a number of a process"));
        kill(process, signal).expect("the process runs");
    }

    /// Whether this process was started with a signal ignored, as a shell starts what runs in the background; then what
    /// it starts ignores the signal too.
    fn is_ignored(signal: Signal) -> bool {
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let mask = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
        mask >> (signal as i32 - 1) & 1 == 1
    }

    /// Signals that end a program, but those that this process was started to ignore.
    fn signals() -> impl Iterator<Item = Signal> {
        [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP].into_iter().filter(|signal| !is_ignored(*signal))
    }

    /// Waits until something is so; a child that ends before has failed, and so has one that never gets there.
    fn until(child: &mut Child, mut is_so: impl FnMut(&Child) -> bool) {
        const LOOKS: usize = 60_000;
        for _ in 0..LOOKS {
            if is_so(child) {
                return;
            }
            let ended = child.try_wait().expect("a child");
            assert!(ended.is_none(), "it ended by {ended:?}");
            thread::sleep(Duration::from_millis(5));
        }
        panic!("it does not get there");
    }

    /// States that never end come through a pipe, so the file is being written when the signal comes.
    #[test]
    fn a_signal_leaves_no_temporary_file() {
        for signal in signals() {
            for out in ["out.csv", "out.npy"] {
                let folder = folder(&format!("{signal}_{out}"));
                let arguments = ["eval", "planar2", "--function", "gravity_torques", "--states", "-", "-o", out];
                let mut command = command(&arguments);
                let mut child = Running::of(command.current_dir(&folder).stdin(Stdio::piped()).stderr(Stdio::piped()));
                let mut states = child.stdin.take().expect("a pipe");
                states.write_all(b"q1,q2\n0.1,0.2\n").expect("it reads");
                until(&mut child, |_| !names(&folder).is_empty());
                send(&child, signal);
                let ended = child.wait().expect("it ends");
                // by the signal itself: a shell tells it by 128 and its number
                assert_eq!(ended.signal(), Some(signal as i32), "{signal} {out}: {ended:?}");
                assert_eq!(names(&folder), Vec::<String>::new(), "{signal} {out}");
            }
        }
    }

    /// `nohup` starts a program whose SIGHUP is ignored, and it stays so.
    #[test]
    fn a_signal_that_is_ignored_ends_nothing() {
        let folder = folder("signal_ignored");
        let line = "trap '' HUP; exec \"$@\"";
        let arguments = ["eval", "planar2", "--function", "gravity_torques", "--states", "-", "-o", "out.csv"];
        let mut shell = Command::new("sh");
        shell.args(["-c", line, "sh", env!("CARGO_BIN_EXE_rne")]).args(arguments).current_dir(&folder);
        let mut child = Running::of(shell.stdin(Stdio::piped()).stderr(Stdio::piped()));
        let mut states = child.stdin.take().expect("a pipe");
        states.write_all(b"q1,q2\n0.1,0.2\n").expect("it reads");
        until(&mut child, |_| !names(&folder).is_empty());
        send(&child, Signal::SIGHUP);
        drop(states);
        assert_eq!(child.wait().expect("it ends").code(), Some(0));
        assert_eq!(names(&folder), ["out.csv"]);
    }

    /// Whether a process has begun to expect signals: the main thread blocks SIGINT.
    #[cfg(target_os = "linux")]
    fn blocks_interrupt(child: &Child) -> bool {
        let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
        let blocked = status.lines().find_map(|line| line.strip_prefix("SigBlk:"));
        blocked.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask & 2 != 0)
    }

    /// Ctrl-C ends a search, which keeps what it found; SIGTERM ends the program, which writes nothing.
    #[test]
    #[cfg(target_os = "linux")]
    fn a_search_keeps_its_best_after_ctrl_c_alone() {
        for signal in signals() {
            let folder = folder(&format!("{signal}_search"));
            fs::copy(format!("{}/robots/planar2.yaml", crate::call::ROOT), folder.join("arm.yaml")).expect("a copy");
            // longer than any machine takes to send a signal; where this test is killed itself, the search ends
            let mut command = command(&["search", "arm.yaml", "--seconds", "600"]);
            let mut child = Running::of(command.current_dir(&folder).stdout(Stdio::piped()).stderr(Stdio::piped()));
            until(&mut child, blocks_interrupt);
            send(&child, signal);
            let ended = child.wait().expect("it ends");
            let is_kept = signal == Signal::SIGINT;
            let expected = if is_kept { (Some(0), None) } else { (None, Some(signal as i32)) };
            assert_eq!((ended.code(), ended.signal()), expected, "{signal}");
            let expected: &[&str] = if is_kept { &["arm.plan.yaml", "arm.yaml"] } else { &["arm.yaml"] };
            assert_eq!(names(&folder), expected, "{signal}");
        }
    }

    /// What a command says where no file may be longer than so many blocks of 512 bytes (1024 in some shells).
    fn limited(blocks: usize, folder: &Path, arguments: &[&str]) -> Called {
        let line = format!("ulimit -f {blocks} && exec \"$@\"");
        let mut command = Command::new("sh");
        command.args(["-c", &line, "sh", env!("CARGO_BIN_EXE_rne")]).args(arguments).current_dir(folder);
        called(command.stdin(Stdio::null()).output().expect("a shell"))
    }

    /// Files of which some fit and others do not: none is written, and the next call has room for all of them.
    #[test]
    fn without_room_for_all_files_there_is_none() {
        let folder = folder("room");
        let emit = ["emit", "puma560", "--lang", "c", "--function", "all", "-o", "arm.c"];
        let excite = ["excite", "planar2", "--evaluations", "50", "-o", "motion.csv", "--plot", "motion.svg"];
        let commands: [(&[&str], usize); 4] = [
            (&emit, 64),
            (&["firmware", "torque", "--robot", "puma560"], 16),
            (&["man", "-o", "pages"], 2),
            (&excite, 128),
        ];
        fs::create_dir(folder.join("pages")).expect("a folder");
        let before = [names(&folder), names(&folder.join("pages"))];
        for (arguments, blocks) in commands {
            let full = limited(blocks, &folder, arguments);
            assert!(full.status == 1 && full.err.contains("cannot be written"), "{arguments:?}: {full:?}");
            assert_eq!([names(&folder), names(&folder.join("pages"))], before, "{arguments:?}");
        }
        for (arguments, blocks) in commands {
            let called = in_folder(&folder, arguments);
            assert_eq!(called.status, 0, "{called:?}");
            let files: Vec<u64> = called
                .err
                .lines()
                .filter_map(|line| line.strip_prefix("wrote "))
                .map(|file| fs::metadata(folder.join(file)).expect(file).len())
                .collect();
            let fits = |length: &&u64| **length <= 512 * blocks as u64;
            let too_long = |length: &&u64| **length > 1024 * blocks as u64;
            assert!(files.iter().any(|length| fits(&length)), "{arguments:?}: {files:?}");
            assert!(files.iter().any(|length| too_long(&length)), "{arguments:?}: {files:?}");
        }
    }
}
