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
    let formulas = "format: 1\nparameters: {m: 2*n, n: 1}\njoints:\n  - dh: {d: 0.3}\n    link:\n      mass: m\n      \
                    com: [0, 0, n/5]\n      inertia_about: origin\n      inertia:\n        xx: 0.09  # about the \
                    origin\n        yy: 0.09\n        zz: 0.009\n";
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
