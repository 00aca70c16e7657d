//! Valid files.

use std::f64::consts::FRAC_PI_2;

use rne_model::{
    Convention, Inertia, InertiaReference, JointKind, Limits, Link, QuarterTurns, Reader, Robot, Transform,
};

const DEMO: &str = include_str!("robots/rp_demo.yaml");

#[test]
fn the_example_of_the_format() {
    let checked = Reader::new("robots/rp_demo.yaml").read(DEMO).unwrap();
    assert_eq!(checked.lints.to_string(), "");
    let robot = checked.robot;
    assert_eq!(robot.name, "rp_demo");
    assert_eq!(robot.title.as_deref(), Some("Two-joint demonstration arm"));
    assert_eq!(robot.source, "own numbers");
    assert_eq!(robot.convention, Convention::Standard);
    assert_eq!(robot.gravity, [0.0, 0.0, -9.81]);
    assert_eq!(robot.parameters, [("m".to_owned(), 1.5), ("a".to_owned(), 0.6)]);
    let [shoulder, slide] = &robot.joints[..] else { panic!() };
    assert_eq!(shoulder.name, "shoulder");
    assert_eq!(shoulder.row.dh.alpha.radians, FRAC_PI_2);
    assert_eq!(shoulder.row.dh.alpha.right, Some(QuarterTurns::One));
    assert_eq!(shoulder.limits.velocity, Some(2.0));
    assert_eq!(shoulder.motor.unwrap().coulomb, [0.395, -0.435]);
    assert_eq!(slide.row.kind, JointKind::Prismatic);
    assert_eq!(slide.row.link.mass, 1.5);
    let inertia = 1.5 * 0.36 / 12.0;
    assert_eq!(slide.row.link.inertia, Inertia { yy: inertia, zz: inertia, ..Inertia::default() });
    assert_eq!(slide.motor, None);
    assert_eq!(Robot::from_yaml(DEMO).unwrap(), robot);
}

#[test]
fn defaults() {
    let text = "format: 1\nname: bare\nsource: none\nconvention: modified\ngravity: [0, 0, -9.81]\njoints:\n\
                - {type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: 0}}\n\
                - {type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 1}, motor: {}}\n";
    let robot = Robot::from_yaml(text).unwrap();
    assert_eq!((robot.title, robot.notes), (None, None));
    assert_eq!((robot.base, robot.tool), (Transform::IDENTITY, Transform::IDENTITY));
    assert!(robot.parameters.is_empty());
    let [first, second] = &robot.joints[..] else { panic!() };
    assert_eq!((first.name.as_str(), second.name.as_str()), ("joint1", "joint2"));
    assert_eq!(first.row.link, Link::default());
    assert_eq!(first.limits, Limits::default());
    assert_eq!(first.motor, None);
    assert_eq!(second.row.link, Link { mass: 1.0, ..Link::default() });
    assert_eq!(second.written_inertia, (Inertia::default(), InertiaReference::Com));
    let motor = second.motor.unwrap();
    assert_eq!((motor.inertia, motor.gear_ratio, motor.viscous, motor.coulomb), (0.0, 1.0, 0.0, [0.0, 0.0]));
}

#[test]
fn inertia_about_the_origin_is_moved_and_kept() {
    let text = DEMO
        .replace("xx: 0.1, yy: 0.12, zz: 0.02", "xx: 0.1 + 2.5*0.3^2, yy: 0.12 + 2.5*0.3^2, zz: 0.02")
        .replace("inertia_about: com ", "inertia_about: origin ");
    let joint = &Robot::from_yaml(&text).unwrap().joints[0];
    let (written, about) = joint.written_inertia;
    assert_eq!(about, InertiaReference::Origin);
    let moved = 2.5 * libm::pow(0.3, 2.0);
    assert_eq!((written.xx, written.yy, written.zz), (0.1 + moved, 0.12 + moved, 0.02));
    let inertia = joint.row.link.inertia;
    assert!((inertia.xx - 0.1).abs() < 1e-15 && (inertia.yy - 0.12).abs() < 1e-15);
    assert_eq!((inertia.zz, inertia.xy, inertia.xz, inertia.yz), (0.02, 0.0, 0.0, 0.0));
}

#[test]
fn spellings_of_yaml_do_not_matter() {
    let robot = Robot::from_yaml(DEMO).unwrap();
    assert_eq!(Robot::from_yaml(&DEMO.replace('\n', "\r\n")).unwrap(), robot);
    assert_eq!(Robot::from_yaml(&format!("\u{FEFF}%YAML 1.2\n---\n{DEMO}...\n")).unwrap(), robot);
    assert_eq!(Robot::from_yaml(&DEMO.replace("alpha: pi/2", "'alpha': \"pi / 2\"")).unwrap(), robot);
    assert_eq!(Robot::from_yaml(&DEMO.replace("pi/2}", "pi/2,}")).unwrap(), robot);
}

#[test]
fn a_negative_zero_is_zero() {
    let robot = Robot::from_yaml(&DEMO.replace("a: 0, alpha: pi/2", "a: -0.0, alpha: pi/2")).unwrap();
    assert!(robot.joints[0].row.dh.a.is_sign_positive());
}

/// Every robot of the repository is valid, none warns in a build, and its notes are known.
#[test]
fn the_robots_of_the_repository() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    let Ok(files) = folder.read_dir() else { return };
    let mut noted = Vec::new();
    for file in files {
        let path = file.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.extension().is_none_or(|extension| extension != "yaml") || name.ends_with(".plan.yaml") {
            continue;
        }
        let checked = Reader::new(&name)
            .read(&std::fs::read_to_string(&path).unwrap())
            .unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(format!("{}.yaml", checked.robot.name), name);
        assert_eq!(checked.lints.warnings().count(), 0, "{}", checked.lints);
        noted.extend(checked.lints.notes().map(|lint| (name.clone(), lint.label.clone().unwrap_or_default())));
    }
    noted.sort();
    // Published as they are; the files say so.
    let expected = ["puma560.yaml"];
    let expected = expected.map(|name| (name.to_owned(), "violates the triangle inequality".to_owned()));
    assert_eq!(noted, expected);
}
