//! Random chains, both ways: URDF to tables, one convention to the other, tables to URDF and back.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;

use fastrand::Rng;
use rne_convert::{Difference, Imported, Options, Selection, Urdf, convert, export};
use rne_model::{Convention, InertiaReference, Reader, Robot};
use rne_runtime::DynArm;

const BOTH: [Convention; 2] = [Convention::Standard, Convention::Modified];

fn number(random: &mut Rng, size: f64) -> f64 {
    // Decimals as files have them.
    ((random.f64() * 2.0 - 1.0) * size * 1e4).round() / 1e4
}

fn angle(random: &mut Rng) -> f64 {
    match random.u32(0..8) {
        0..=2 => 0.0,
        3 => FRAC_PI_2,
        4 => -FRAC_PI_2,
        5 => PI,
        // near the pole of roll, pitch, yaw
        6 => FRAC_PI_2 + 1e-4 * number(random, 1.0),
        _ => number(random, 3.0),
    }
}

fn triple(values: [f64; 3]) -> String {
    values.map(|value| value.to_string()).join(" ")
}

fn inertial(random: &mut Rng) -> String {
    if random.u32(0..5) == 0 {
        return String::new();
    }
    let xyz = triple([0; 3].map(|_| number(random, 0.3)));
    let rpy = triple([0; 3].map(|_| angle(random)));
    let [x, y, z] = [0; 3].map(|_| 0.001 + 0.05 * random.f64());
    let off = 0.1 * x.min(y).min(z);
    format!(
        "<inertial><origin xyz=\"{xyz}\" rpy=\"{rpy}\"/><mass value=\"{}\"/>\
         <inertia ixx=\"{}\" ixy=\"{off}\" ixz=\"0\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/></inertial>",
        number(random, 2.0).abs(),
        y + z,
        x + z,
        -off,
        x + y
    )
}

/// A chain of `n` movable joints with fixed joints between them and links that hang on them.
fn urdf(random: &mut Rng, n: usize) -> String {
    let mut text = String::from("<robot name=\"random\">\n<link name=\"l0\"/>\n");
    let mut parent = "l0".to_owned();
    let mut links = 0;
    for i in 0..n {
        while random.u32(0..3) == 0 {
            links += 1;
            let child = format!("f{links}");
            let origin = place(random);
            let _ = writeln!(
                text,
                "<link name=\"{child}\">{}</link><joint name=\"j{child}\" type=\"fixed\"><parent link=\"{parent}\"/>\
                 <child link=\"{child}\"/>{origin}</joint>",
                inertial(random)
            );
            // Goes on from there, or hangs beside.
            if random.bool() {
                parent = child;
            }
        }
        let child = format!("l{}", i + 1);
        let kind = if random.u32(0..4) == 0 { "prismatic" } else { "revolute" };
        let axis = match random.u32(0..6) {
            0 => [0.0, 0.0, -1.0],
            1 => [0.0, 1.0, 0.0],
            2 => [7.0, 0.0, 0.0],
            3 => [number(random, 1.0) + 1.1, number(random, 1.0), number(random, 1.0)],
            _ => [0.0, 0.0, 1.0],
        };
        let _ = writeln!(
            text,
            "<link name=\"{child}\">{}</link><joint name=\"q{i}\" type=\"{kind}\"><parent link=\"{parent}\"/>\
             <child link=\"{child}\"/>{}<axis xyz=\"{}\"/><limit lower=\"-1.5\" upper=\"1.25\" effort=\"7\" \
             velocity=\"3\"/></joint>",
            inertial(random),
            place(random),
            triple(axis)
        );
        parent = child;
    }
    let _ = writeln!(
        text,
        "<link name=\"tip\"/><joint name=\"end\" type=\"fixed\"><parent link=\"{parent}\"/>\
         <child link=\"tip\"/>{}</joint>\n\
         </robot>",
        place(random)
    );
    text
}

fn place(random: &mut Rng) -> String {
    let coordinate = |random: &mut Rng| if random.bool() { 0.0 } else { number(random, 0.6) };
    let xyz = triple([0; 3].map(|_| coordinate(random)));
    let rpy = triple([0; 3].map(|_| angle(random)));
    format!("<origin xyz=\"{xyz}\" rpy=\"{rpy}\"/>")
}

fn import(text: &str, convention: Convention, snap: bool) -> Imported {
    let selection = Selection { tip: Some("tip".to_owned()), ..Selection::default() };
    let options = Options { selection, convention, snap, ..Options::default() };
    Urdf::read("random.urdf", text)
        .and_then(|urdf| urdf.import(&options))
        .unwrap_or_else(|report| panic!("{report}\n{text}"))
}

/// What is far away costs digits.
fn reach(robot: &Robot) -> f64 {
    robot.rows().flat_map(|row| [row.dh.a.abs(), row.dh.d.abs()]).fold(1.0, f64::max)
}

fn assert_small(difference: &Difference, reach: f64, what: &str) {
    let Difference { position, rotation, torque, .. } = *difference;
    assert!(position < 1e-14 * reach && rotation < 1e-14 && torque < 1e-12 * reach, "{what}: {difference:?}");
}

fn torques(robot: &Robot, seed: u64) -> Vec<f64> {
    let arm = DynArm::from_robot(robot);
    let mut random = Rng::with_seed(seed);
    let mut state = || (0..robot.dof()).map(|_| random.f64() * 3.0 - 1.5).collect::<Vec<f64>>();
    arm.inverse_dynamics(&state(), &state(), &state()).unwrap()
}

fn assert_same_torques(one: &Robot, other: &Robot, tolerance: f64) {
    for seed in 0..5 {
        let (a, b) = (torques(one, seed), torques(other, seed));
        let largest = a.iter().fold(1e-3, |largest: f64, x| largest.max(x.abs()));
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= tolerance * largest), "{a:?} {b:?}");
    }
}

#[test]
fn chains_of_urdfs_are_their_tables() {
    let mut random = Rng::with_seed(11);
    for case in 0..60 {
        let text = urdf(&mut random, 1 + case % 7);
        for convention in BOTH {
            let imported = import(&text, convention, false);
            let reach = reach(&imported.robot);
            assert_small(&imported.account.rounding, reach, &format!("case {case} {convention:?}\n{text}"));
            assert_eq!(Reader::new("written").read(&imported.text).unwrap().robot, imported.robot);
        }
    }
}

#[test]
fn one_convention_is_the_other() {
    let mut random = Rng::with_seed(12);
    for case in 0..40 {
        let text = urdf(&mut random, 1 + case % 7);
        for (from, to) in [(BOTH[0], BOTH[1]), (BOTH[1], BOTH[0])] {
            let imported = import(&text, from, true).robot;
            let converted = convert(&imported, to).unwrap();
            assert_eq!(converted.robot.convention, to);
            let reach = reach(&imported).max(reach(&converted.robot));
            assert_small(&converted.rounding, reach, &format!("case {case}\n{text}"));
            assert_same_torques(&imported, &converted.robot, 1e-12 * reach);
            let back = convert(&converted.robot, from).unwrap();
            assert_same_torques(&imported, &back.robot, 1e-12 * reach);
        }
    }
}

/// A link without mass keeps its first moment: it turns with the frame, and its tensor is about the origin of that.
#[test]
fn first_moments_turn_with_their_frames() {
    let mut random = Rng::with_seed(17);
    let mut moments = 0;
    for case in 0..60 {
        let text = urdf(&mut random, 1 + case % 7);
        for (from, to) in [(BOTH[0], BOTH[1]), (BOTH[1], BOTH[0])] {
            let mut robot = import(&text, from, true).robot;
            for joint in robot.joints.iter_mut().skip(case % 2).step_by(2) {
                let link = &mut joint.row.link;
                (link.first_moment, link.mass, link.com) = (link.com, 0.0, [0.0; 3]);
                if link.has_first_moment() {
                    joint.written_inertia = (link.inertia, InertiaReference::Origin);
                    moments += 1;
                }
            }
            let written = rne_convert::robot_file::write(&robot);
            let read = Reader::new("written").read(&written).unwrap_or_else(|report| panic!("{report}\n{written}"));
            assert_eq!(read.robot, robot, "{written}");
            let converted = convert(&robot, to).unwrap();
            let reach = reach(&robot).max(reach(&converted.robot));
            assert_small(&converted.rounding, reach, &format!("case {case}\n{written}"));
            assert_same_torques(&robot, &converted.robot, 1e-12 * reach);
            let has = |robot: &Robot| robot.rows().map(|row| row.link.has_first_moment()).collect::<Vec<_>>();
            assert_eq!(has(&robot), has(&converted.robot));
            if let Some(index) = has(&robot).into_iter().position(|has| has) {
                let refused = export(&robot).unwrap_err();
                let said = format!("link {}, which the joint ", index + 1);
                assert!(refused.to_string().starts_with(&said), "{refused}");
                assert!(refused.to_string().contains("has a first moment but no mass, and a URDF"), "{refused}");
            }
        }
    }
    assert!(moments > 100, "{moments}");
}

#[test]
fn what_is_exported_comes_back() {
    let mut random = Rng::with_seed(13);
    for case in 0..40 {
        let text = urdf(&mut random, 1 + case % 7);
        for convention in BOTH {
            let robot = import(&text, convention, true).robot;
            let exported = export(&robot).unwrap();
            let back = import(&exported.text, convention, false);
            let reach = reach(&robot);
            assert_small(&back.account.rounding, reach, &format!("case {case}\n{}", exported.text));
            assert_same_torques(&robot, &back.robot, 1e-12 * reach);
            assert_eq!(back.robot.joints.len(), robot.joints.len());
            for (a, b) in robot.joints.iter().zip(&back.robot.joints) {
                assert_eq!((&a.name, a.limits), (&b.name, b.limits));
            }
            assert!(exported.remarks.iter().all(|remark| !remark.contains("gravity")), "{:?}", exported.remarks);
        }
    }
}

/// Every shipped robot: the writer gives the same robot, and the other convention the same torques.
/// What an export writes, an import reads: numbers beyond that are refused by the export too.
#[test]
fn an_export_has_no_number_that_an_import_refuses() {
    let file = |link: &str, length: &str, tool: &str, viscous: &str| {
        let text = format!(
            "format: 1\nname: far\nsource: x\nconvention: standard\ngravity: [0, 0, -9.81]\n\
             base: {{xyz: [{length}, 0, 0]}}\ntool: {{xyz: [0, {tool}, 0]}}\njoints:\n\
             - type: revolute\n  dh: {{theta: 0, d: 0, a: {length}, alpha: 0}}\n  link: {{{link}}}\n  \
             motor: {{viscous: {viscous}}}\n"
        );
        Reader::new("far").read(&text).unwrap_or_else(|report| panic!("{report}")).robot
    };
    let unit = "mass: 1, com: [0.1, 0, 0]";
    let largest = file("mass: 1e9, com: [0, 0.9e9, 0], inertia: {xx: 1, yy: 1, zz: 1}", "0.1", "0.9e9", "1e9");
    import(&export(&largest).unwrap().text, Convention::Standard, false);
    for (robot, what) in [
        (file("mass: 1e-6, first_moment: [0, 1e4, 0]", "0", "0", "0"), "of the centre of mass of link 1 would be 1e10"),
        (file("mass: 1.1e9", "0", "0", "0"), "the mass of link 1 would be 1.1e9"),
        (file("mass: 1, inertia: {xx: 2e9, yy: 2e9, zz: 2e9}", "0", "0", "0"), "an inertia of link 1 would be 2e9"),
        (file(unit, "3e9", "0", "0"), "a coordinate of `base` would be 3e9"),
        (file(unit, "0", "3e9", "0"), "a coordinate of the tip would be 3e9"),
        (file(unit, "0", "0", "2e9"), "the friction of joint 1 would be 2e9"),
    ] {
        let refused = export(&robot).unwrap_err().to_string();
        assert!(refused.contains(what) && refused.contains("above 1e9"), "{refused}");
    }
}

#[test]
fn shipped_robots_are_written_converted_and_exported() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots");
    let (mut seen, mut with_friction) = (0, 0);
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.extension().is_none_or(|extension| extension != "yaml") || rne_model::robot_of(&path).is_some() {
            continue;
        }
        seen += 1;
        let robot = Reader::new(&name).read(&std::fs::read_to_string(&path).unwrap()).unwrap().robot;
        let written = rne_convert::robot_file::write(&robot);
        assert_eq!(
            Reader::new(&name).read(&written).unwrap_or_else(|report| panic!("{report}")).robot,
            robot,
            "{written}"
        );
        for convention in BOTH {
            let converted = convert(&robot, convention).unwrap();
            assert_same_torques(&robot, &converted.robot, 1e-12);
            assert_small(&converted.rounding, 1.0, &name);
        }
        let exported = export(&robot).unwrap();
        let gravity = exported.gravity;
        let options =
            Options { snap: false, gravity, convention: robot.convention, keep_unphysical: true, ..Options::default() };
        let back = Urdf::read(&name, &exported.text).and_then(|urdf| urdf.import(&options));
        let back = back.unwrap_or_else(|report| panic!("{report}")).robot;
        assert_same_torques(&robot, &back, 1e-12);
        has_the_friction_of_both_directions(&robot, &back);
        with_friction += usize::from(back.joints.iter().any(|joint| joint.motor.is_some()));
    }
    assert!(seen >= 15 && with_friction >= 1, "{seen}, {with_friction} with friction");
}

/// Half of the difference of the torques forth and back is the mean of the friction of both directions: by the runtime,
/// which computes it through the gear.
fn has_the_friction_of_both_directions(robot: &Robot, back: &Robot) {
    let still = vec![0.0; robot.dof()];
    let friction = |robot: &Robot, speed: f64| -> Vec<f64> {
        let arm = DynArm::from_robot(robot);
        let [forth, back] =
            [speed, -speed].map(|speed| arm.actuator_torques(&vec![speed; robot.dof()], &still).unwrap());
        forth.iter().zip(back).map(|(forth, back)| 0.5 * (forth - back)).collect()
    };
    for speed in [1e-3, 0.5, 3.0] {
        let (expected, found) = (friction(robot, speed), friction(back, speed));
        let close = expected.iter().zip(&found).all(|(a, b)| (a - b).abs() <= 1e-14 * a.abs());
        assert!(close, "{} at {speed}: {expected:?} {found:?}", robot.name);
    }
}
