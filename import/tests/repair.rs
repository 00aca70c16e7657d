//! Repairs of bodies that cannot exist: public cases, and shipped robots with one mistake each.

use fastrand::Rng;
use rne_convert::repair::{Body, Candidate, Numbers, Order, bodies_of, proposals, written};

/// A URDF with one body, from its centre of mass, its mass and its tensor.
fn urdf(com: &str, mass: &str, tensor: &str) -> String {
    format!(
        "<robot name=\"t\"><link name=\"base\"/><joint name=\"j1\" type=\"revolute\"><parent link=\"base\"/><child \
         link=\"body\"/><axis xyz=\"0 0 1\"/></joint>\n<link name=\"body\"><inertial><origin xyz=\"{com}\"/><mass \
         value=\"{mass}\"/><inertia {tensor}/></inertial></link></robot>"
    )
}

/// Returns the candidates of the only proposal of a text that are equally good: what is wrong, and the new text of the
/// elements that change.
fn best(text: &str) -> Vec<(String, String)> {
    let bodies = bodies_of("t.urdf", text).unwrap_or_else(|report| panic!("{report}"));
    let found = proposals(&bodies);
    assert_eq!(found.len(), 1, "{found:?}");
    let best = found[0].candidates.iter().take(found[0].equal);
    let new = |candidate: &Candidate| candidate.diffs(text, &bodies).iter().map(|diff| diff.new.clone()).collect();
    best.map(|candidate| (candidate.what.clone(), new(candidate))).collect()
}

#[test]
fn public_cases_get_the_one_edit() {
    for (com, mass, tensor, what, new) in [
        (
            "0 0 0.05",
            "0.01",
            r#"ixx="2e-6" ixy="0" ixz="0" iyy="1e-6" iyz="0" izz="4e-6""#,
            "yy should be xx, because the link looks like a body of revolution",
            r#"<inertia ixx="2e-6" ixy="0" ixz="0" iyy="2e-6" iyz="0" izz="4e-6"/>"#,
        ),
        (
            "0 0 0.05",
            "0.5",
            r#"ixx="0.002" ixy="0" ixz="0.0002" iyy="0" iyz="0" izz="0.0002""#,
            "yy should be xx, because the link looks like a body of revolution",
            r#"<inertia ixx="0.002" ixy="0" ixz="0.0002" iyy="0.002" iyz="0" izz="0.0002"/>"#,
        ),
        (
            "0 0 0.05",
            "4.970684",
            r#"ixx="0.70337" ixy="0.70661" ixz="0.0091170" iyy="-0.00013900" iyz="0.0067720" izz="0.019169""#,
            "the numbers are in MuJoCo's order xx yy zz xy xz yz, not in that of URDF",
            concat!(
                r#"<inertia ixx="0.70337" ixy="-0.00013900" ixz="0.0067720" iyy="0.70661" iyz="0.019169" "#,
                r#"izz="0.0091170"/>"#
            ),
        ),
        (
            "0 0 0.05",
            "51.3211",
            r#"ixx="16616.493" ixy="-2240.0581" ixz="0" iyy="-2240.0581" iyz="16616.324" izz="0""#,
            "the numbers are the first six of the matrix, row by row: xx xy xz yx yy yz; the file does not have the \
             moment zz, so find it where the numbers are from",
            r#"<inertia ixx="16616.493" ixy="-2240.0581" ixz="0" iyy="16616.324" iyz="0" izz="?"/>"#,
        ),
    ] {
        let found = best(&urdf(com, mass, tensor));
        assert_eq!(found, [(what.to_owned(), new.to_owned())], "{tensor}");
    }
    let rod = r#"ixx="0.021978" ixy="-0.019780" ixz="-0.059341" iyy="0.197802" iyz="-0.006593" izz="0.180220""#;
    let bodies = bodies_of("rod.urdf", &urdf("0 0 0", "1", rod)).expect("a URDF");
    assert!(bodies.len() == 1 && proposals(&bodies).is_empty(), "{:?}", proposals(&bodies));
}

/// The bodies of all shipped robots, without places in a text.
fn shipped() -> Vec<(&'static str, Vec<Body>)> {
    let bodies = |robot: &rne_robots::RobotFile| {
        let mut bodies = bodies_of(robot.name, robot.yaml).unwrap_or_else(|report| panic!("{report}"));
        for body in &mut bodies {
            body.elements.clear();
        }
        bodies
    };
    rne_robots::all().map(|robot| (robot.name, bodies(robot))).collect()
}

#[test]
fn shipped_robots_need_no_repair() {
    for (name, bodies) in shipped() {
        let found = proposals(&bodies);
        let shown: Vec<_> = found.iter().map(|one| (&bodies[one.body], &one.failed, one.candidates.first())).collect();
        assert!(found.is_empty(), "{name}: {shown:#?}");
    }
}

/// Makes one mistake of a kind in a body, if it has such numbers; returns the element of the tensor that is lost.
fn spoil(kind: usize, body: &mut Body, other: &mut Body, rng: &mut Rng) -> Option<usize> {
    let Numbers { mass, inertia } = body.numbers;
    let [xx, yy, zz, xy, xz, yz] = inertia;
    let power = 10_f64.powi(rng.i32(1..=9) * if rng.bool() { 1 } else { -1 });
    let element = rng.usize(0..6);
    let [x, y, z] = body.com.unwrap_or_default();
    let sign = if rng.bool() { mass } else { -mass };
    body.order = if rng.bool() { Order::UpperTriangle } else { Order::MomentsFirst };
    let mut one = inertia;
    let new = match kind {
        0 => {
            one[element] *= power;
            one
        }
        1 => {
            one[element] *= -1.0;
            one
        }
        2 => {
            body.numbers.mass *= power;
            one
        }
        3 => inertia.map(|number| number * power),
        4 => [xx, yy, zz, -xy, -xz, -yz],
        5 => [-xx, -yy, -zz, xy, xz, yz],
        6 if body.order == Order::UpperTriangle => [xx, xy, yz, yy, zz, xz],
        6 => [xx, xy, xz, yy, yz, zz],
        7 if body.order == Order::UpperTriangle => [xx, xy, yz, xy, xz, yy],
        7 => [xx, xy, xz, xy, yy, yz],
        8 => [
            xx + sign * (y * y + z * z),
            yy + sign * (x * x + z * z),
            zz + sign * (x * x + y * y),
            xy - sign * x * y,
            xz - sign * x * z,
            yz - sign * y * z,
        ],
        9 => std::mem::replace(&mut other.numbers.inertia, inertia),
        _ => {
            body.numbers.mass *= -1.0;
            one
        }
    };
    if kind == 9 {
        body.numbers.inertia = new;
    } else {
        body.numbers.inertia = new.map(|number| format!("{number:.12e}").parse().unwrap_or(number));
    }
    (kind == 7).then_some(2)
}

const KINDS: [&str; 11] = [
    "one power",
    "one sign",
    "mass",
    "all",
    "products",
    "moments",
    "order",
    "rows",
    "reference",
    "exchange",
    "sign of mass",
];

fn agree(one: &Numbers, other: &Numbers, lost: Option<usize>) -> bool {
    let scale = one.inertia.iter().fold(0.0_f64, |most, number| most.max(number.abs()));
    let close = |(at, (a, b)): (usize, (&f64, &f64))| lost == Some(at) || (a - b).abs() <= 1e-7 * scale;
    (one.mass - other.mass).abs() <= 1e-9 * one.mass && one.inertia.iter().zip(&other.inertia).enumerate().all(close)
}

#[test]
fn the_true_edit_comes_first() {
    let robots = shipped();
    let bodies: usize = robots.iter().map(|(_, bodies)| bodies.len()).sum();
    assert!(bodies >= 30, "{bodies}");
    let mut rng = Rng::with_seed(2_026);
    let mut counts = [[0; 3]; KINDS.len()];
    for kind in (0..KINDS.len()).flat_map(|kind| std::iter::repeat_n(kind, 300)) {
        let (_, bodies) = &robots[rng.usize(0..robots.len())];
        let [at, other] = [rng.usize(0..bodies.len()), rng.usize(0..bodies.len())];
        if at == other || [at, other].iter().any(|at| bodies[*at].is_exempt || bodies[*at].numbers.mass == 0.0) {
            continue;
        }
        let mut spoilt = bodies.clone();
        let mut second = spoilt[other].clone();
        let lost = spoil(kind, &mut spoilt[at], &mut second, &mut rng);
        spoilt[other] = second;
        let found = proposals(&spoilt);
        // an exchange is found at either of the two links
        let Some(found) = found.iter().find(|found| [at, other].contains(&found.body)) else { continue };
        let right = |candidate: &Candidate| {
            candidate.changes.iter().all(|(body, numbers)| agree(&bodies[*body].numbers, numbers, lost))
                && (kind != 9 || candidate.changes.len() == 2)
        };
        let place = found.candidates.iter().position(right);
        counts[kind][0] += 1;
        counts[kind][1] += usize::from(place == Some(0));
        counts[kind][2] += usize::from(place == Some(0) && found.equal == 1);
    }
    for (kind, [all, first, only]) in KINDS.iter().zip(counts) {
        println!("{kind:12} impossible or implausible {all:4}, true edit first {first:4}, alone {only:4}");
    }
    let sum = |at: usize| counts.iter().map(|of| of[at]).sum::<usize>();
    println!("of {bodies} bodies all {}: first {}, alone {}", sum(0), sum(1), sum(2));
    assert!(sum(0) > 300 && 10 * sum(1) >= 9 * sum(0), "{counts:?}");
}

#[test]
fn nothing_else_in_the_file_changes() {
    let wrong = "<robot>\r\n <link name=\"a\"><inertial>\n <mass value='2'/>\n  <inertia  ixx='-0.10' ixy='0' ixz='0' \
                 iyy='1.0e-1' iyz='0' izz='0.1'/> <!-- ixx -->\n</inertial></link>\t</robot>\n";
    let bodies = bodies_of("a.urdf", wrong).expect("a URDF");
    let found = proposals(&bodies);
    assert!(found.len() == 1 && found[0].equal == 1, "{found:#?}");
    assert_eq!(written(wrong, &bodies, [&found[0].candidates[0]]), Some(wrong.replace("'-0.10'", "'0.10'")));
}

#[test]
fn robot_files_and_mjcf_files_are_repaired_in_their_own_syntax() {
    let puma = rne_robots::find("puma560").expect("a robot").yaml;
    let right = "inertia: {xx: 0.13, yy: 0.524, zz: 0.539}";
    let mjcf = "<mujoco><worldbody>\n<body name=\"a\"><joint/><inertial pos=\"0 0 .1\" mass=\"2\" \
                fullinertia=\"0.02 0.03 0.01 0.001 -0.002 0.003\"/>\n<body name=\"b\" pos=\"0 0 .3\"><joint/><inertial \
                mass=\"1\" pos=\"0 0 .1\" diaginertia=\"0.01 0.012  4e-3\" /></body></body></worldbody></mujoco>";
    let formulas = "format: 1\nname: x\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\nparameters: {n: 1, \
                    m: 2*n}\njoints:\n  - type: revolute\n    dh: {theta: 0, d: 0.3, a: 0, alpha: 0}\n    \
                    link:\n      mass: m\n      com: [0, 0, n/5]\n      inertia_about: origin\n      \
                    inertia:\n        xx: 0.09  # about the origin\n        yy: 0.09\n        zz: 0.009\n";
    for (file, text, right, wrong) in [
        ("formulas.yaml", formulas, "zz: 0.009", "zz: -0.009"),
        ("puma560.yaml", puma, right, "inertia: {xx: 0.13, yy: -0.524, zz: 0.539}"),
        ("puma560.yaml", puma, right, "inertia: {xx: 0.13, yy: 0.524, zz: 539}"),
        ("a.xml", mjcf, "0.01 0.012  4e-3", "0.01 0.012  -4e-3"),
        ("a.xml", mjcf, "0.02 0.03 0.01 0.001 -0.002 0.003", "0.02 0.001 -0.002 0.03 0.003 0.01"),
    ] {
        assert_eq!(text.matches(right).count(), 1, "{right}");
        let spoilt = text.replace(right, wrong);
        let bodies = bodies_of(file, &spoilt).unwrap_or_else(|report| panic!("{report}"));
        let found = proposals(&bodies);
        assert!(found.len() == 1 && !found[0].candidates.is_empty(), "{wrong}: {found:#?}");
        let repaired = written(&spoilt, &bodies, &found[0].candidates[..1]).expect("one change");
        assert!(found[0].equal == 1 && repaired == text, "{wrong}: {found:#?}");
        assert!(proposals(&bodies_of(file, text).expect("bodies")).is_empty());
    }
}

/// A robot file with these rows of `joints`.
fn table(joints: &str) -> String {
    format!("format: 1\nname: x\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n{joints}")
}

/// A row with a link.
fn row(d: &str, mass: &str, inertia: &str) -> String {
    format!(
        "  - type: revolute\n    dh: {{theta: 0, d: {d}, a: 0.3, alpha: pi/2}}\n    link: {{mass: {mass}, com: \
         [-0.1, 0, 0], inertia: {inertia}}}\n"
    )
}

/// Two elements may look alike, and one number may have several places.
#[test]
fn only_the_number_of_the_body_itself_changes() {
    let note = "<robot><link name=\"a\"><inertial><mass note=' value=\"9\"' value=\"2\"/><inertia note=' ixx=\"7.0\"' \
                iyy=\"0.1\" ixx = \"-0.1\" ixy=\"0\" ixz=\"0\" iyz=\"0\" izz=\"0.1\"/></inertial></link></robot>";
    let bodies = bodies_of("a.urdf", note).expect("a URDF");
    let found = proposals(&bodies);
    assert_eq!((bodies[0].numbers.mass, bodies[0].numbers.inertia[0]), (2.0, -0.1));
    let [one] = &found[..] else { panic!("{found:?}") };
    assert_eq!(written(note, &bodies, one.repair()), Some(note.replace("\"-0.1\"", "\"0.1\"")));

    let good = "{xx: 0.02, yy: 0.03, zz: 0.03}";
    for (joints, shared) in [
        (row("0.1", "&m -3.0", good) + &row("*m", "3", good), true),
        (row("0.1", "&m -3.0", good) + &row("0.2", "3", good), false),
        (row("0.1", "2", "{xx: &x -0.02, yy: 0.03, zz: 0.03}") + &row("0.2", "3", "{xx: 0.03, yy: *x}"), true),
        (row("0.1", "2", "&i {xx: -0.02, yy: 0.03, zz: 0.03}") + &row("0.2", "3", "*i"), true),
    ] {
        let text = table(&joints);
        let bodies = bodies_of("a.yaml", &text).unwrap_or_else(|report| panic!("{report}"));
        let repairs: Vec<_> = proposals(&bodies).into_iter().filter(|found| found.repair().is_some()).collect();
        assert_eq!(repairs.is_empty(), shared, "{text}{repairs:?}");
    }
}

/// A plate that is rounded to two digits is possible.
#[test]
fn rounded_plates_need_no_repair() {
    for (inertia, is_good) in [
        ("{xx: 0.0019, yy: 0.1, zz: 0.11}", true),
        ("{xx: 0.0019, yy: 0.10, zz: 0.13}", false),
        ("{xx: 0.00190, yy: 0.1001, zz: 0.1100}", false),
    ] {
        let bodies = bodies_of("a.yaml", &table(&row("0.3", "2", inertia))).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(proposals(&bodies).is_empty(), is_good, "{inertia}");
    }
}

/// What cannot be read is an error, and not a link without a finding.
#[test]
fn a_text_that_is_not_understood_is_refused() {
    let good = "{xx: 0.02, yy: 0.03, zz: 0.03}";
    for text in [
        "hello".to_owned(),
        table(&row("0.1", ".nan", good)),
        table(&row("0.1", "1e999", good)),
        table(&row("0.1", "2", "{xx: 4_0.0, yy: 0.1, zz: 0.1}")),
        table(&row("0.1", "2", "{xx: -4.0, yy: 0.1, zz: 0.1}, physical: False")),
        urdf("0 0 0", "1", "ixx='&#45;4' ixy='0' ixz='0' iyy='4' iyz='0' izz='4'"),
        "<mujoco><worldbody><body><joint/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1 1'/></body></worldbody>\
         </mujoco>"
            .to_owned(),
    ] {
        assert!(bodies_of("a", &text).is_err(), "{text}");
    }
}

/// The tensors of a whole file may be in another unit. No link has a mass of a thousand tonnes.
#[test]
fn one_unit_of_all_tensors_is_proposed() {
    let right = [("4", [0.02, 0.03, 0.03]), ("3", [0.012, 0.013, 0.004]), ("1.5", [0.002, 0.004, 0.003])];
    for (factor, unit) in [(1e4, "kg cm²"), (1e6, "kg mm²"), (1e7, "g cm²"), (1e9, "g mm²")] {
        let rows = right.map(|(mass, moments)| {
            let [xx, yy, zz] = moments.map(|moment| f64::round(moment * factor));
            row("0.25", mass, &format!("{{xx: {xx}, yy: {yy}, zz: {zz}}}"))
        });
        let text = table(&rows.concat());
        let bodies = bodies_of("a.yaml", &text).unwrap_or_else(|report| panic!("{report}"));
        let found = proposals(&bodies);
        assert_eq!(found.len(), 3, "{unit}: {found:?}");
        for (found, (_, moments)) in found.iter().zip(right) {
            let what = format!("all tensors of the file are in {unit}");
            let best = &found.candidates[..found.equal];
            let repair = best.iter().find(|one| one.what == what).unwrap_or_else(|| panic!("{unit}: {best:?}"));
            // g cm² and kg mm² differ by a factor of 10
            assert!(found.equal <= 2 && (found.equal == 1 || factor > 1e4), "{unit}: {best:?}");
            let numbers = repair.changes[0].1.inertia;
            assert!(numbers.iter().zip(moments).all(|(one, right)| (one - right).abs() < 1e-6), "{numbers:?}");
        }
    }
}

/// Only its size tells by which power of ten a product is wrong.
#[test]
fn the_power_of_a_product_is_never_sure() {
    let text = table(&row("0.3", "2", "{xx: 0.02, yy: 0.031, zz: 0.032, xy: 3.1}"));
    let found = proposals(&bodies_of("a.yaml", &text).unwrap_or_else(|report| panic!("{report}")));
    assert!(found.len() == 1 && found[0].equal > 1 && found[0].repair().is_none(), "{found:?}");
}

/// A reader of spoilt text returns bodies or an error, whatever the text is.
#[test]
fn no_text_is_too_strange() {
    let good = urdf("0 0 0.05", "1", r#"ixx="-1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1""#);
    let yaml = rne_robots::find("planar2").expect("a robot").yaml;
    let mut rng = Rng::with_seed(7);
    let strange = ['<', '>', '"', '=', ' ', '\u{2003}', 'e', '9', '-', '\u{FEFF}', '&', '{', ':', '*'];
    for _ in 0..2_000 {
        let mut text: Vec<char> = if rng.bool() { good.chars() } else { yaml.chars() }.collect();
        for _ in 0..rng.usize(1..4) {
            let at = rng.usize(0..text.len());
            text[at] = strange[rng.usize(0..strange.len())];
        }
        let text: String = text.into_iter().collect();
        if let Ok(bodies) = bodies_of("strange", &text) {
            for proposal in proposals(&bodies) {
                for candidate in &proposal.candidates {
                    let _ = written(&text, &bodies, [candidate]);
                }
            }
        }
    }
}
