//! Links of a URDF as named frames.

use rne_convert::{convert, export};
use rne_model::{Frame, FrameId};

use super::*;

/// Two joints that are not parallel; a camera on the first moved link, a tool on the last one, a table on the base.
fn arm() -> String {
    robot(&[
        link("upper", 2.0, "0.1 0 0", [0.1; 3]),
        link("fore", 1.0, "0.1 0 0", [0.1; 3]),
        bare(&["base", "mount", "camera-1", "lens", "tool0", "table"]),
        joint("fixed_base", "fixed", ("base", "mount"), "xyz=\"0 0 0.3\" rpy=\"0 0 0.4\"", ""),
        joint("to_table", "fixed", ("mount", "table"), "xyz=\"0.7 0 0\" rpy=\"0.1 0 0\"", ""),
        joint("a", "continuous", ("mount", "upper"), "xyz=\"0.1 0.2 0\" rpy=\"0.3 0 0\"", "<axis xyz=\"0 1 0\"/>"),
        joint("to_camera", "fixed", ("upper", "camera-1"), "xyz=\"0.05 0 0.1\" rpy=\"0 0.5 0\"", ""),
        joint("to_lens", "fixed", ("camera-1", "lens"), "xyz=\"0 0 0.02\"", ""),
        joint("b", "continuous", ("upper", "fore"), "xyz=\"0.4 0 0.1\" rpy=\"0 0.2 0.9\"", "<axis xyz=\"0 0 1\"/>"),
        joint("to_tool", "fixed", ("fore", "tool0"), "xyz=\"0.3 0 0\"", ""),
    ])
}

fn options(convention: Convention) -> Options {
    let selection = Selection { tip: Some("tool0".to_owned()), ..Selection::default() };
    Options { frames: true, snap: false, convention, selection, ..Options::default() }
}

fn pose(robot: &Robot, name: &str, q: &[f64]) -> rne_runtime::Pose<f64> {
    let frame = robot.frame(name).unwrap_or_else(|unknown| panic!("{unknown}"));
    DynArm::from_robot(&robot.clone().at_frame(frame)).forward_kinematics(q).unwrap()
}

fn turned(axis: [f64; 3], angle: f64) -> rne_runtime::Pose<f64> {
    let rotation = nalgebra::Rotation3::from_scaled_axis(nalgebra::Vector3::from(axis) * angle);
    rne_runtime::Pose::from_matrix(rotation.into_inner(), nalgebra::Vector3::zeros())
}

/// The origin of a joint of URDF.
fn origin(xyz: [f64; 3], [roll, pitch, yaw]: [f64; 3]) -> rne_runtime::Pose<f64> {
    let rotation = nalgebra::Rotation3::from_euler_angles(roll, pitch, yaw);
    rne_runtime::Pose::from_matrix(rotation.into_inner(), nalgebra::Vector3::from(xyz))
}

#[test]
fn links_are_frames_in_their_own_axes() {
    for convention in BOTH {
        let imported = import(&arm(), &options(convention));
        let names: Vec<&str> = imported.robot.frames.iter().map(|frame| frame.name.as_str()).collect();
        assert_eq!(names, ["base_frame", "mount", "table", "upper", "camera_1", "lens", "fore", "tool0"]);
        assert!(imported.account.frames.contains(&("camera-1".to_owned(), "camera_1".to_owned())));
        let rounding = imported.account.rounding;
        assert!(rounding.position < 1e-14 && rounding.rotation < 1e-14, "{rounding:?}");
        // by the numbers of the URDF
        let q = [0.7, -1.2];
        let mount = origin([0.0, 0.0, 0.3], [0.0, 0.0, 0.4]);
        let upper = mount.then(&origin([0.1, 0.2, 0.0], [0.3, 0.0, 0.0])).then(&turned([0.0, 1.0, 0.0], q[0]));
        let camera = upper.then(&origin([0.05, 0.0, 0.1], [0.0, 0.5, 0.0]));
        let fore = upper.then(&origin([0.4, 0.0, 0.1], [0.0, 0.2, 0.9])).then(&turned([0.0, 0.0, 1.0], q[1]));
        for (name, expected) in [
            ("base_frame", rne_runtime::Pose::identity()),
            ("mount", mount),
            ("table", mount.then(&origin([0.7, 0.0, 0.0], [0.1, 0.0, 0.0]))),
            ("upper", upper),
            ("camera_1", camera),
            ("lens", camera.then(&origin([0.0, 0.0, 0.02], [0.0; 3]))),
            ("fore", fore),
            ("tool0", fore.then(&origin([0.3, 0.0, 0.0], [0.0; 3]))),
        ] {
            for x in pose(&imported.robot, name, &q).error_to(&expected) {
                assert!(x.abs() < 1e-14, "{name} {convention:?}");
            }
        }
    }
}

#[test]
fn a_note_names_the_frame_of_the_base_link() {
    let [ours] = remarks_on_base(&arm()).try_into().expect("one note");
    assert!(
        ours.starts_with(
            "the base link `base` of the file is the frame `base_frame`; `base` in a robot file is frame 0 of the \
             table, which is at ["
        ),
        "{ours}"
    );
    // the link keeps its name, and frame 0 is elsewhere, on the first axis
    let renamed = arm().replace("\"base\"", "\"base_link\"");
    let [ours] = remarks_on_base(&renamed).try_into().expect("one note");
    assert!(ours.contains("`base_link` of the file is the frame `base_link`;"), "{ours}");
    let one = |base: &str, xyz: &str| {
        robot(&[
            link("a", 1.0, "0 0 0", [0.1; 3]),
            bare(&[base]),
            joint("j", "continuous", (base, "a"), &format!("xyz=\"{xyz}\""), "<axis xyz=\"0 0 1\"/>"),
        ])
    };
    let [ours] = remarks_on_base(&one("base_link", "0.25 -0.5 0")).try_into().expect("one note");
    assert!(ours.ends_with("frame 0 of the table, which is at [0.25, -0.5, 0] m in the axes of this link"), "{ours}");
    let [ours] = remarks_on_base(&one("base", "0 0 0.3")).try_into().expect("one note");
    assert!(ours.ends_with("which is at the same place"), "{ours}");
    assert!(remarks_on_base(&one("base_link", "0 0 0.3")).is_empty());
}

/// The notes about the base link, which the robot file has, too.
fn remarks_on_base(text: &str) -> Vec<String> {
    let tip = text.contains("tool0").then(|| "tool0".to_owned());
    let selection = Selection { tip, ..Selection::default() };
    let imported = import(text, &Options { frames: true, selection, ..Options::default() });
    let remarks: Vec<String> =
        imported.account.sentences().into_iter().filter(|remark| remark.starts_with("the base link")).collect();
    assert!(remarks.iter().all(|remark| imported.robot.notes.as_ref().is_some_and(|notes| notes.contains(remark))));
    remarks
}

#[test]
fn without_the_option_the_file_has_no_frames_but_the_account_names_them() {
    let with = import(&arm(), &options(Convention::Standard));
    let without = import(&arm(), &Options { frames: false, ..options(Convention::Standard) });
    assert_eq!(without.robot, Robot { frames: Vec::new(), notes: None, ..with.robot.clone() });
    assert!(!without.text.contains("frames:"), "{}", without.text);
    assert_eq!(without.account.frames, with.account.frames);
}

#[test]
fn names_that_are_taken_get_others() {
    let text = robot(&[
        link("a", 1.0, "0 0 0", [0.1; 3]),
        bare(&["base", "base_frame", "1st", "x.y", "x-y"]),
        joint("a", "continuous", ("base", "a"), "xyz=\"0 0 0\"", "<axis xyz=\"0 0 1\"/>"),
        joint("f1", "fixed", ("base", "base_frame"), "xyz=\"0 0 0\"", ""),
        joint("f2", "fixed", ("a", "1st"), "xyz=\"0 0 0\"", ""),
        joint("f3", "fixed", ("a", "x.y"), "xyz=\"0 0 0\"", ""),
        joint("f4", "fixed", ("a", "x-y"), "xyz=\"0 0 0\"", ""),
    ]);
    let options = Options { frames: true, ..Options::default() };
    let names: Vec<String> = import(&text, &options).robot.frames.into_iter().map(|frame| frame.name).collect();
    assert_eq!(names, ["base_frame", "base_frame_2", "a_frame", "frame_1st", "x_y", "x_y_2"]);
}

#[test]
fn another_convention_and_a_urdf_keep_the_frames() {
    let standard = import(&arm(), &options(Convention::Standard)).robot;
    let modified = convert(&standard, Convention::Modified).unwrap_or_else(|report| panic!("{report}"));
    assert!(modified.rounding.position < 1e-14, "{:?}", modified.rounding);
    let exported = export(&standard).unwrap_or_else(|error| panic!("{error}"));
    let selection = Selection { tip: Some("tip".to_owned()), ..Selection::default() };
    let back = import(&exported.text, &Options { selection, frames: true, snap: false, ..Options::default() });
    assert_eq!(standard.frames.len(), modified.robot.frames.len());
    for (index, Frame { name, .. }) in standard.frames.iter().enumerate() {
        let q = [0.3, 2.1];
        let expected = pose(&standard, name, &q);
        assert_eq!(modified.robot.frame(name), Ok(FrameId::Named(index)));
        // a link of a URDF may have a name that no frame has
        let link = back.account.frames.iter().find(|(link, _)| link == name).map(|(_, name)| name.as_str());
        for (robot, name) in [(&modified.robot, name.as_str()), (&back.robot, link.expect("a link"))] {
            for x in pose(robot, name, &q).error_to(&expected) {
                assert!(x.abs() < 1e-13, "{name}: {}", robot.convention.name());
            }
        }
    }
}
