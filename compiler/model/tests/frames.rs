//! Named frames: what a file says, and where each mistake is.

use crate::common;
use crate::common::{found, with};
use rne_model::{Entry, FixedFrame, FrameId, Reader, Robot, Transform};

/// The valid file with a list `frames` before its joints.
fn framed(frames: &str) -> String {
    with("joints:\n", &format!("frames: {frames}\njoints:\n"))
}

fn robot(text: &str) -> Robot {
    Robot::from_yaml(text).unwrap_or_else(|report| panic!("{report}"))
}

#[test]
fn frames_are_read_in_the_order_of_the_file() {
    let robot = robot(&framed(
        "\n  - {name: camera, on: first, xyz: [0, -0.05, 0.1], rpy: [0, pi/2, 0]}\n  - {name: Table_2, on: base}",
    ));
    let [camera, table] = robot.frames.as_slice() else { panic!("{:?}", robot.frames) };
    assert_eq!((camera.name.as_str(), camera.fixed.on), ("camera", Some(0)));
    assert_eq!(camera.fixed.placement.xyz, [0.0, -0.05, 0.1]);
    assert_eq!(camera.fixed.placement.rpy[1].radians, std::f64::consts::FRAC_PI_2);
    assert_eq!(table.fixed, FixedFrame { on: None, placement: Transform::IDENTITY });
    assert_eq!(robot.frame("Table_2"), Ok(FrameId::Named(1)));
    // a joint names its link frame
    assert_eq!(robot.frame("first"), Ok(FrameId::Link(0)));
    assert_eq!(robot.fixed_frame(FrameId::Link(0)), FixedFrame { on: Some(0), placement: Transform::IDENTITY });
    let names: Vec<&str> = robot.frame_ids().map(|frame| robot.frame_name(frame)).collect();
    assert_eq!(names[..3], ["camera", "Table_2", "first"]);
}

#[test]
fn a_file_without_frames_has_none() {
    assert_eq!(robot(common::BASE).frames, []);
    assert_eq!(robot(&framed("[]")), robot(common::BASE));
}

#[test]
fn an_unknown_frame_lists_those_that_there_are() {
    let robot = robot(&framed("[{name: camera, on: first}]"));
    let message = robot.frame("camra").unwrap_err().to_string();
    for part in ["has no frame `camra`", "its frames are `camera`", "`first`", "did you mean `camera`?"] {
        assert!(message.contains(part), "{message}");
    }
    let message = Robot { frames: Vec::new(), ..robot }.frame("camera").unwrap_err().to_string();
    assert!(message.contains("its file has no list `frames`") && message.contains("`first`"), "{message}");
}

#[test]
fn a_placement_may_vary_at_run_time() {
    let text = framed("[{name: camera, on: first, xyz: [0, m, 0]}]");
    let checked = Reader::new("x.yaml").run_time(&["m"]).read(&text).unwrap_or_else(|report| panic!("{report}"));
    assert!(checked.robot.run_time.formula(Entry::FrameXyz(0, 1)).is_some());
    let moved = checked.robot.with_parameters(&[0.25]).expect("one value");
    assert_eq!(moved.frames[0].fixed.placement.xyz, [0.0, 0.25, 0.0]);
}

#[test]
fn every_mistake_is_at_its_place() {
    let many = format!("[{}]", (0..257).map(|i| format!("{{name: f{i}, on: base}}")).collect::<Vec<_>>().join(", "));
    for (frames, underlined, message, help) in [
        ("camera", "camera", "found `camera` where a list of frames is needed", "begin each frame with a dash"),
        ("{camera: {on: first}}", "{", "where a list of frames is needed", "- {name: camera, on: joint6"),
        ("[camera]", "camera", "where a mapping (name, on, xyz, rpy) is needed", ""),
        ("[{on: first}]", "{", "a frame lacks the required key `name`", ""),
        ("[{name: camera}]", "{", "a frame lacks the required key `on`", "`on: base` for frame 0"),
        (
            "[{name: camera, on: first, joint: 1}]",
            "joint",
            "unknown key `joint`; a frame has the keys name, on, xyz, rpy",
            "",
        ),
        ("[{name: camera, om: first}]", "om", "unknown key `om`", "did you mean `on`?"),
        (
            "[{name: camera-2, on: first}]",
            "camera-2",
            "is not an identifier; it must be a letter",
            "jacobian_of_camera",
        ),
        ("[{name: 2nd, on: first}]", "2nd", "is not an identifier", ""),
        ("[{name: \"a\\e[2J\", on: first}]", "\"a\\e[2J\"", "is not an identifier", ""),
        ("[{name: kamera_ü, on: first}]", "kamera_ü", "is not an identifier", ""),
        ("[{name: ~, on: first}]", "~", "where a text is needed", ""),
        ("[{name: base, on: first}]", "base", "`base` is already the name of frame 0", "write `on: base`"),
        ("[{name: first, on: base}]", "first", "`first` is already the name of joint 1", "its link frame"),
        (
            "[{name: a, on: base}, {name: a, on: first}]",
            "a",
            "the name `a` of frame 2 is already the name of frame 1; the names of frames must differ",
            "",
        ),
        (
            "[{name: camera, on: fist}]",
            "fist",
            "it must be `base` or the name of a joint: `first`",
            "did you mean `first`?",
        ),
        ("[{name: camera, on: 1}]", "1", "`on` names `1`, which is no joint of this file", "`on: first`"),
        ("[{name: camera, on: 0}]", "0", "`on` names `0`", ""),
        ("[{name: camera, on: []}]", "[]", "where a text is needed", ""),
        ("[{name: camera, on: first, xyz: [0, 1]}]", "[0, 1]", "where 3 numbers [x, y, z] (m) are needed", ""),
        ("[{name: camera, on: first, rpy: [0, 0, 1e9]}]", "1e9", "is too large", ""),
        ("[{name: camera, on: first, xyz: [0, 0, z]}]", "z", "z", ""),
        (many.as_str(), "{", "257 frames; at most 256 frames are allowed", ""),
    ] {
        let text = framed(frames);
        let report = found(&text);
        let [error] = report.diagnostics.as_slice() else { panic!("`{frames}`:\n{report}") };
        assert!(error.message.contains(message), "`{frames}`: {}", error.message);
        assert!(error.help.as_deref().unwrap_or_default().contains(help), "`{frames}`: {:?}", error.help);
        assert!(text[error.span.clone()].starts_with(underlined), "`{frames}`: {}", &text[error.span.clone()]);
        assert_eq!(error.line, 8, "`{frames}`: all stands in line 8");
    }
}

#[test]
fn base_is_frame_0_and_nothing_else() {
    let text = framed("[{name: camera, on: base}]").replace("name: first", "name: base");
    let report = found(&text);
    // and the warning below
    let [error, _] = report.diagnostics.as_slice() else { panic!("{report}") };
    assert!(error.message.contains("`on: base` means frame 0, but joint 1 has the name `base`, too"), "{report}");
    // without a frame on it, such a joint is a warning
    let report = found(&common::BASE.replace("name: first", "name: base"));
    let [warning] = report.diagnostics.as_slice() else { panic!("{report}") };
    assert!(!report.has_errors() && warning.message.contains("base"), "{report}");
}

#[test]
fn mistakes_of_frames_and_joints_are_told_together() {
    let report = found(&framed("[{name: camera, on: nowhere}]").replace("type: prismatic", "type: sliding"));
    assert_eq!(report.diagnostics.len(), 2, "{report}");
}
