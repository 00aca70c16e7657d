//! `rne export --fmu`: the archive, and what is refused.

use std::fs;
use std::path::Path;

use crate::call::{called, command, fails, folder, rne};

/// The files of an archive: paths and texts; a file that is no text is empty.
fn files(path: &Path) -> Vec<(String, String)> {
    let bytes = fs::read(path).expect("an archive");
    let archive = rawzip::ZipArchive::from_slice(&bytes).expect("a zip archive");
    let mut entries = archive.entries();
    let mut files = Vec::new();
    while let Some(entry) = entries.next_entry().expect("an entry") {
        let name = entry.file_path().try_normalize().expect("a path").as_ref().to_owned();
        let local = archive.get_entry(entry.wayfinder()).expect("its data");
        let mut text = Vec::new();
        std::io::Read::read_to_end(&mut local.verifying_reader(local.data()), &mut text).expect("its checksum");
        files.push((name, String::from_utf8(text).unwrap_or_default()));
    }
    files
}

#[test]
fn an_fmu_is_an_archive_of_sources_for_its_version() {
    let folder = folder("fmu_sources");
    for (version, own) in [("2", "fmiVersion=\"2.0\""), ("3", "fmiVersion=\"3.0\"")] {
        let out = folder.join(format!("arm{version}.fmu"));
        let path = out.to_str().expect("UTF-8");
        let called = rne(&["export", "planar2", "--fmu", version, "--no-build", "-o", path]);
        assert_eq!(called.status, 0, "{}", called.err);
        assert!(called.said().contains("no binary was built, because of --no-build"), "{}", called.err);
        let files = files(&out);
        let text = |name: &str| &files.iter().find(|(known, _)| known == name).expect(name).1;
        assert!(text("modelDescription.xml").contains(own));
        for name in ["planar2.c", "planar2.h", "fmi-functions.c", "fmi-types.h", "CMakeLists.txt"] {
            assert!(!text(&format!("sources/{name}")).is_empty());
        }
        let has = |name: &str| files.iter().any(|(known, _)| known.starts_with(name));
        assert_eq!([has("sources/buildDescription.xml"), has("binaries/")], [version == "3", false]);
        // an export that is repeated gives the same bytes, and the version of the standard is also 2.0 or 3.0
        let first = fs::read(&out).expect("an archive");
        let again = rne(&["export", "planar2", "--fmu", &format!("{version}.0"), "--no-build", "-o", path, "--force"]);
        assert_eq!((again.status, fs::read(&out).expect("an archive")), (0, first));
    }
}

#[test]
fn an_fmu_has_no_binary_where_there_is_no_compiler() {
    let out = folder("fmu_without").join("arm.fmu");
    let path = out.to_str().expect("UTF-8");
    let export = || command(&["export", "planar1", "--fmu", "-o", path]);
    let built = called(export().env_remove("CC").env("PATH", "").output().expect("rne starts"));
    assert_eq!(built.status, 0, "{}", built.err);
    assert!(built.said().contains("there is no C compiler, so the FMU has sources and no binary"), "{}", built.err);
    assert!(files(&out).iter().all(|(name, _)| !name.starts_with("binaries/")));
    let missing = called(export().arg("--force").env("CC", "no-such-compiler -O2").output().expect("rne starts"));
    assert_eq!(missing.status, 1, "{}", missing.err);
    let said = "the compiler no-such-compiler -O2 that the variable CC names is not found";
    assert!(missing.said().contains(said), "{}", missing.err);
    let no_folder = called(export().arg("--force").env("TMPDIR", "/no/such/folder").output().expect("rne starts"));
    assert!(no_folder.said().contains("the folder of temporary files /no/such/folder"), "{}", no_folder.err);
}

#[test]
fn the_name_of_a_robot_is_that_of_no_source() {
    let folder = folder("fmu_names");
    let text = include_str!("../../../robots/planar1.yaml");
    for name in ["fmu", "fmi_types", "fmi_functions"] {
        let (file, out) = (folder.join(format!("{name}.yaml")), folder.join(format!("{name}.fmu")));
        fs::write(&file, text.replace("name: planar1", &format!("name: {name}"))).expect("written");
        let [file, path] = [&file, &out].map(|path| path.to_str().expect("UTF-8"));
        let called = rne(&["export", file, "--fmu", "-o", path]);
        assert_eq!(called.status, 0, "{}", called.err);
        let mut names: Vec<String> = files(&out).into_iter().map(|(name, _)| name).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
    }
}

#[test]
fn limits_of_an_fmu_are_narrowed_by_joints_that_follow() {
    let folder = folder("fmu_limits");
    let (file, out) = (folder.join("gripper.yaml"), folder.join("gripper.fmu"));
    // finger_b = 2 finger_a + 0.005 is from 0.01 to 0.02 m, at most 0.1 m/s
    let text = include_str!("../../../docs/gripper.yaml")
        .replace("{finger_a: 1}, offset: 0}", "{finger_a: 2}, offset: 0.005}")
        .replace("alpha: -pi/2}", "alpha: -pi/2}\n    limits: {position: [0.01, 0.02], velocity: 0.1}");
    fs::write(&file, text).expect("written");
    let [file, path] = [&file, &out].map(|path| path.to_str().expect("UTF-8"));
    let called = rne(&["export", file, "--fmu", "--no-build", "-o", path]);
    assert_eq!(called.status, 0, "{}", called.err);
    let files = files(&out);
    let line = |name: &str| {
        let is_it = |line: &&str| line.contains(&format!("name=\"{name}\""));
        files[0].1.lines().find(is_it).unwrap_or_else(|| panic!("{name} in {}", files[0].1))
    };
    for part in ["min=\"0.0025\"", "max=\"0.0075\"", "start=\"0.0025\""] {
        assert!(line("q.finger_a").contains(part), "{}", line("q.finger_a"));
    }
    assert!(line("qd.finger_a").contains("max=\"0.05\""), "{}", line("qd.finger_a"));
}

/// A number that the file computes from a parameter follows this parameter. The FMU offers the parameter alone.
#[test]
fn parameters_of_the_file_are_parameters_of_the_fmu() {
    let folder = folder("fmu_parameters");
    let (file, out) = (folder.join("rod.yaml"), folder.join("rod.fmu"));
    let text = "format: 1\nname: rod\nsource: own numbers\nconvention: standard\ngravity: [0, -g, 0]\n\
                parameters: {g: 9.81, m: 2, half: 0.25, twice: 2 * half, angle: 0.5, unused: 3}\njoints:\n  \
                - {type: revolute, dh: {theta: angle, d: 0, a: twice, alpha: 0}, link: {mass: m, com: [-half, 0, 0], \
                inertia: {zz: 0.04}}}\n";
    fs::write(&file, text).expect("written");
    let [file, path] = [&file, &out].map(|path| path.to_str().expect("UTF-8"));
    let called = rne(&["export", file, "--fmu", "--no-build", "-o", path]);
    assert_eq!(called.status, 0, "{}", called.err);
    let files = files(&out);
    let xml = &files[0].1;
    let parameters = xml.lines().filter(|line| line.contains("causality=\"parameter\""));
    let names: Vec<&str> = parameters.filter_map(|line| line.split("name=\"").nth(1)?.split('"').next()).collect();
    let (own, payload) = names.split_at(5);
    assert_eq!(own, ["step", "g", "m", "half", "inertia.joint1.zz"]);
    assert_eq!((payload.len(), payload[0]), (10, "payload.mass"));
}

#[test]
fn what_cannot_be_an_fmu_is_refused() {
    let folder = folder("fmu_refused");
    let out = folder.join("arm.fmu");
    let path = out.to_str().expect("UTF-8");
    fails(2, &["export", "planar1", "--fmu", "4", "-o", path], &["4", "2, 3"]);
    fails(2, &["export", "planar1", "--fmu", "-o", "-"], &["--fmu needs the name of a file, such as -o arm.fmu"]);
    for (file, name) in [("planar1", "planar1.fmu"), ("docs/desk_arm.yaml", "desk_arm.fmu"), ("-", "arm.fmu")] {
        let said = format!("error: --fmu needs the name of the file that it writes: add -o {name}");
        fails(2, &["export", file, "--fmu"], &[&said]);
    }
    fails(2, &["export", "planar1", "--fmu", "-o", "arm.zip.urdf"], &["arm.zip.fmu"]);
    for option in ["--inverse", "--no-build", "--rotors"] {
        fails(2, &["export", "planar1", "--urdf", option], &[option, "is for FMUs", "--fmu"]);
    }
    fails(1, &["export", "docs/four_bar.yaml", "--fmu", "-o", path], &["an FMU needs a robot without closed loops"]);
    fails(1, &["export", "docs/satellite.yaml", "--fmu", "-o", path], &["floating"]);
    assert!(!out.exists());
}
