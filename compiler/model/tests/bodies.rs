//! The lists `bodies` and `tips`: what they mean, and every mistake at its line and column.

use rne_model::{Body, Entry, FixedFrame, Inertia, InertiaReference, Link, Reader, Robot, Transform};

const FILE: &str = "format: 2
name: torso
source: own
convention: modified
gravity: [0, 0, -9.81]
parameters: {l: 0.1}
joints:
  - {name: a, type: revolute, dh: {theta: 0, d: 0, a: l, alpha: 0}, link: {mass: 2, com: [0, 0.3, 0], inertia: {xx: 1}}}
  - {name: b, type: revolute, dh: {theta: 0, d: 0, a: 0.2, alpha: 0}, link: {mass: 1, com: [l, 0, 0]}}
  - {name: c, parent: a, type: revolute, dh: {theta: 0, d: 0, a: 0.2, alpha: 0}}
";
const FRAMES: &str = "frames: [{name: left, on: b, xyz: [l, 0, 0]}, {name: right, on: c}, {name: floor, on: base}]\n";

fn read_with(text: &str, run_time: &[&str]) -> Result<(Robot, Vec<String>), String> {
    let checked = Reader::new("torso.yaml").trees().run_time(run_time).read(&format!("{FILE}{text}"));
    let said = |checked: &rne_model::Checked| checked.lints.diagnostics.iter().map(|it| it.message.clone()).collect();
    checked.map(|checked| (checked.robot.clone(), said(&checked))).map_err(|report| report.short())
}

fn read(text: &str) -> Robot {
    let text = if text.contains("tips") { text.to_owned() } else { format!("tool: {{on: b}}\n{text}") };
    read_with(&text, &[]).unwrap_or_else(|report| panic!("{report}")).0
}

/// Mass, first moment and inertia about the origin of the frame of a link.
fn moments(link: &Link) -> (f64, [f64; 3], [[f64; 3]; 3]) {
    let Link { mass, com, inertia, .. } = link;
    let square: f64 = com.iter().map(|x| x * x).sum();
    let rows = inertia.rows();
    let about_origin =
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| rows[i][j] + mass * (if i == j { square } else { 0.0 } - com[i] * com[j])));
    (*mass, com.map(|x| mass * x), about_origin)
}

/// The matter of a body as points that have its mass, first moment and inertia: six on the axes of a box, each moved to
/// the link by itself. No theorem of parallel axes, no product of tensors.
fn of_points(points: &[(f64, [f64; 3])], turn: impl Fn([f64; 3]) -> [f64; 3]) -> (f64, [f64; 3], [[f64; 3]; 3]) {
    let mut sum = (0.0, [0.0; 3], [[0.0; 3]; 3]);
    for &(mass, point) in points {
        let p = turn(point);
        let square: f64 = p.iter().map(|x| x * x).sum();
        sum.0 += mass;
        for i in 0..3 {
            sum.1[i] += mass * p[i];
            for j in 0..3 {
                sum.2[i][j] += mass * (if i == j { square } else { 0.0 } - p[i] * p[j]);
            }
        }
    }
    sum
}

#[test]
fn a_body_is_a_part_of_its_link() {
    // two points of 0.2 kg at ±r on each axis from the centre of mass
    let (centre, r) = ([0.02, -0.03, 0.05], [0.1, 0.2, 0.3]);
    let mut points = Vec::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let mut point = centre;
            point[axis] += side * r[axis];
            points.push((0.2, point));
        }
    }
    let [xx, yy, zz] = [(1, 2), (0, 2), (0, 1)].map(|(i, j)| 0.4 * (r[i] * r[i] + r[j] * r[j]));
    let (roll, pitch, yaw): (f64, f64, f64) = (0.4, -0.7, 1.1);
    let place = [0.3, -0.1, 0.25];
    let turn = |[x, y, z]: [f64; 3]| {
        // fixed axes: roll, then pitch, then yaw
        let ([y, z], x) = ([y * roll.cos() - z * roll.sin(), y * roll.sin() + z * roll.cos()], x);
        let [x, z] = [x * pitch.cos() + z * pitch.sin(), z * pitch.cos() - x * pitch.sin()];
        let [x, y] = [x * yaw.cos() - y * yaw.sin(), x * yaw.sin() + y * yaw.cos()];
        [x + place[0], y + place[1], z + place[2]]
    };
    let bare = read("");
    let whole = read(&format!(
        "bodies:\n  - {{name: box, on: a, at: {{xyz: {place:?}, rpy: [{roll}, {pitch}, {yaw}]}}, mass: 1.2, com: \
         {centre:?}, inertia: {{xx: {xx}, yy: {yy}, zz: {zz}}}}}\n"
    ));
    let (own, added) = (moments(&bare.joints[0].row.link), of_points(&points, turn));
    let found = moments(&whole.joints[0].row.link);
    assert!((found.0 - own.0 - added.0).abs() < 1e-15);
    for i in 0..3 {
        assert!((found.1[i] - own.1[i] - added.1[i]).abs() < 1e-15, "first moment {i}");
        for j in 0..3 {
            assert!((found.2[i][j] - own.2[i][j] - added.2[i][j]).abs() < 1e-15, "inertia {i}, {j}");
        }
    }
    assert_eq!(whole.joints[0].written_inertia, (whole.joints[0].row.link.inertia, InertiaReference::Com));
    assert_eq!(whole.joints[1..], bare.joints[1..]);
}

#[test]
fn zeros_stay_zeros_and_an_empty_link_becomes_the_body() {
    let robot = read(
        "bodies:\n  - {name: one, on: c, mass: 0.5, com: [0, 0, 0.1], inertia: {xx: 0.2, yy: 0.1, zz: 0.15}}\n  - \
         {name: two, on: b, at: {rpy: [0, 0, pi/2]}, mass: 1, com: [0, -0.3, 0], inertia_about: origin, inertia: {xx: \
         0.09, zz: 0.09}}\n",
    );
    let inertia = Inertia { xx: 0.2, yy: 0.1, zz: 0.15, ..Inertia::default() };
    assert_eq!(robot.joints[2].row.link, Link { mass: 0.5, com: [0.0, 0.0, 0.1], inertia, first_moment: [0.0; 3] });
    // points of 1 kg at x = 0.1 and x = 0.3
    let Link { mass, com, inertia, .. } = robot.joints[1].row.link;
    assert_eq!((mass, com[1..] == [0.0, 0.0], [inertia.xx, inertia.xy, inertia.xz, inertia.yz]), (2.0, true, [0.0; 4]));
    assert!((com[0] - 0.2).abs() < 1e-16 && (inertia.yy - 0.02).abs() < 1e-16 && (inertia.zz - 0.02).abs() < 1e-16);
}

#[test]
fn bodies_may_be_left_out_by_name() {
    const BODIES: &str = "bodies:\n  - {name: camera, on: a, mass: 0.3, com: [0.1, 0, 0]}\n  \
                          - {name: hand, on: a, mass: 0.7}\n  - {name: tool_1, on: c, mass: 1}\n";
    let robot = read(BODIES);
    let names = |robot: &Robot| robot.bodies.list.iter().map(|body| body.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&robot), ["camera", "hand", "tool_1"]);
    let Body { fixed, matter, .. } = &robot.bodies.list[0];
    assert_eq!((*fixed, matter.mass), (FixedFrame { on: Some(0), placement: Transform::IDENTITY }, 0.3));
    let without = robot.without_bodies(&["camera", "tool_1"]).expect("both are there");
    assert_eq!(without, read("bodies: [{name: hand, on: a, mass: 0.7}]"));
    assert_eq!(robot.without_bodies(&[]), Ok(robot.clone()));
    assert_eq!(without.without_bodies(&["hand"]).expect("it is there").joints, read("").joints);
    let unknown = robot.without_bodies(&["hand", "camra"]).unwrap_err().to_string();
    for part in ["torso has no body `camra`", "its bodies are `camera`, `hand`, `tool_1`", "did you mean `camera`?"] {
        assert!(unknown.contains(part), "{unknown}");
    }
    let none = read("").without_bodies(&["camera"]).unwrap_err().to_string();
    assert_eq!(none, "torso has no body `camera`: its file has no list `bodies`");
}

#[test]
fn mistakes_in_bodies_are_told_at_their_place() {
    for (bodies, place, said) in [
        ("  - {name: x, on: d, mass: 1}", "13:19", "`on` names `d`, which is no joint of this file"),
        ("  - {name: x, on: a}", "13:5", "lacks the required key `mass`"),
        ("  - {on: a, mass: 1}", "13:5", "lacks the required key `name`"),
        ("  - {name: 3d, on: a, mass: 1}", "13:12", "the body name `3d` is not an identifier"),
        ("  - {name: x, on: a, mass: -1}", "13:28", "the mass `-1` is negative"),
        ("  - {name: x, on: a, mass: 1, size: 2}", "13:31", "unknown key `size`"),
        (
            "  - {name: x, on: a, mass: 1}\n  - {name: x, on: b, mass: 1}",
            "14:12",
            "`x` is already the name of another body",
        ),
        ("  - {name: x, on: a, mass: 1, inertia: {xx: -1}}", "13:40", "no body can have this inertia"),
        ("  - {name: x, on: a, mass: 1, inertia: {xx: 1, ww: 1}}", "13:48", "unknown key `ww`"),
        ("  - {name: x, on: a, mass: 1, at: {xyz: [1, 2]}}", "13:41", "[x, y, z] (m)"),
        ("  {name: x, on: a, mass: 1}", "13:3", "a list of bodies is needed"),
    ] {
        let report = read_with(&format!("tool: {{on: b}}\nbodies:\n{bodies}\n"), &[]).expect_err(bodies);
        assert!(
            report.contains(&format!("torso.yaml:{place}: error: ")) && report.contains(said),
            "{bodies}\n{report}"
        );
    }
    let old =
        FILE.replace("format: 2", "format: 1").replace("parent: a, ", "") + "bodies: [{name: x, on: a, mass: 1}]\n";
    let report = Reader::new("torso.yaml").read(&old).unwrap_err().short();
    assert!(report.contains("the key `bodies` needs `format: 2`"), "{report}");
}

#[test]
fn a_body_on_the_base_or_on_a_varying_link_is_remarked_or_refused() {
    let (robot, said) = read_with("tool: {on: b}\nbodies: [{name: x, on: base, mass: 1}]\n", &[]).expect("valid");
    assert_eq!(robot.joints, read("").joints);
    assert!(said.iter().any(|said| said.contains("the body `x` has no effect: it is on `base`")), "{said:?}");
    // the length a varies, and no number of the link of a; the centre of mass of b does
    let on = |link: &str| format!("tool: {{on: b}}\nbodies: [{{name: x, on: {link}, mass: 1}}]\n");
    assert!(read_with(&on("a"), &["l"]).is_ok());
    let report = read_with(&on("b"), &["l"]).unwrap_err();
    assert!(
        report.contains("the link of `b` depends on the run-time parameter `l`, so it can have no body"),
        "{report}"
    );
    let report = read_with(&on("a").replace("mass: 1", "mass: l"), &["l"]).unwrap_err();
    assert!(report.contains("the mass `l` depends on the run-time parameter `l`"), "{report}");
}

#[test]
fn tips_are_frames_in_their_own_order() {
    let robot = read(&format!("{FRAMES}tips: [right, left]\n"));
    assert_eq!((robot.tip_names(), robot.tip_count()), (vec!["right", "left"], 2));
    assert_eq!(robot.wrench_frames(), [robot.frames[1].fixed, robot.frames[0].fixed]);
    assert_eq!([robot.tip_entry(0, 2), robot.tip_entry(1, 0)], [Entry::FrameXyz(1, 2), Entry::FrameXyz(0, 0)]);
    // without `tool`, the first of them is the tip
    assert_eq!((robot.tip(), robot.tip_on), (robot.frames[1].fixed, None));
    let other = read(&format!("{FRAMES}tips: [left]\n"));
    assert_eq!((other.tip(), other.tip_on), (other.frames[0].fixed, Some(1)));
    let with_tool = read(&format!("{FRAMES}tips: [right, left]\ntool: {{on: a, xyz: [0, 0, 1]}}\n"));
    assert_eq!((with_tool.tip_on, with_tool.tool.xyz, with_tool.tip_count()), (Some(0), [0.0, 0.0, 1.0], 2));
    // a robot without the list has one tip, its tip frame
    let none = read("");
    assert_eq!((none.tip_names(), none.wrench_frames()), (vec!["tip"], vec![none.tip()]));
    assert_eq!(none.tip_entry(0, 1), Entry::ToolXyz(1));
}

#[test]
fn a_tip_may_vary_at_run_time() {
    let (robot, _) = read_with(&format!("{FRAMES}tips: [left, right]\n"), &["l"]).expect("valid");
    let moved = robot.with_parameters(&[0.7]).expect("one value");
    assert_eq!((moved.wrench_frames()[0].placement.xyz, moved.tool.xyz), ([0.7, 0.0, 0.0], [0.7, 0.0, 0.0]));
}

#[test]
fn mistakes_in_tips_are_told_at_their_place() {
    for (tips, place, said) in [
        (
            "[left, lefd]",
            "12:14",
            "`tips` names `lefd`, which is no frame of this file; its frames are `left`, `right`, `floor`",
        ),
        ("[left, left]", "12:14", "`left` is in the list twice"),
        ("[floor]", "12:8", "the tip `floor` is on `base`"),
        ("left", "12:7", "a list of names is needed"),
        ("[b]", "12:8", "`tips` names `b`, which is no frame of this file"),
    ] {
        let report = read_with(&format!("{FRAMES}tips: {tips}\n"), &[]).expect_err(tips);
        assert!(report.contains(&format!("torso.yaml:{place}: error: ")) && report.contains(said), "{tips}\n{report}");
    }
    let report = read_with("tips: [left]\n", &[]).unwrap_err();
    assert!(report.contains("the file has no list `frames`"), "{report}");
}

/// Two bodies of 1e308 kg weigh more than a 64-bit number holds; so does the inertia of a light one that is far away.
#[test]
fn bodies_that_overflow_are_refused_at_their_line() {
    let heavy = "tool: {on: b}\nbodies:\n  - {name: x, on: a, mass: 1e308}\n  - {name: y, on: a, mass: 1e308}\n";
    let far = "tool: {on: b}\nbodies:\n  - {name: x, on: b, mass: 1e10}\n  \
               - {name: y, on: b, at: {xyz: [1e150, 0, 0]}, mass: 1e10}\n";
    for (bodies, place, link) in [(heavy, "14:28", "`a`"), (far, "14:54", "`b`")] {
        let report = read_with(bodies, &[]).expect_err(bodies);
        let said = format!("torso.yaml:{place}: error: the link of {link} with its bodies is too heavy");
        assert!(report.contains(&said), "{report}");
    }
    // on two links each is a number
    assert!(read_with(&heavy.replace("y, on: a", "y, on: b"), &[]).is_ok());
}

/// A list without entries means the same as no list, whichever it is.
#[test]
fn empty_lists_are_as_no_list() {
    let without = read("");
    for key in ["frames", "couplings", "loops", "motors", "bodies", "tips", "contacts"] {
        let text = format!("{FILE}tool: {{on: b}}\n{key}: []\n");
        let read = Reader::new("torso.yaml").trees().couplings().read(&text);
        assert_eq!(read.unwrap_or_else(|report| panic!("{key}: {report}")).robot, without, "{key}");
        if key != "frames" {
            let chain = FILE.replace("format: 2", "format: 1").replace("parent: a, ", "");
            let old = format!("{chain}{key}: []\n");
            let report = Reader::new("torso.yaml").read(&old).unwrap_err().short();
            assert!(report.contains(&format!("the key `{key}` needs `format: 2`")), "{report}");
        }
    }
    // a robot with several ends and no tips says where its tip is
    let report = read_with("tips: []\n", &[]).unwrap_err();
    assert!(report.contains("the robot has 2 ends (`b`, `c`)"), "{report}");
}
