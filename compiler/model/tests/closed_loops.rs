//! Closed loops: the configurations that close them against closed forms, the order of elimination, and what is
//! refused.

use std::f64::consts::PI;

use rne_model::{Checked, ClosedLoops, Cut, Pivot, Reader, Robot};

/// The beginning of a file whose list `joints` goes on.
const HEAD: &str = "format: 2\nname: linkage\nsource: own\nconvention: modified\ngravity: [0, 0, -9.81]\n";

/// A four-bar: crank 0.2 m, coupler 0.45 m, rocker 0.3 m, ground 0.5 m; 0.2 + 0.5 < 0.45 + 0.3, so the crank turns
/// round (F. Grashof).
const FOUR_BAR: &str = "tool: {on: coupler}
joints:
  - {name: crank, type: revolute, dh: {alpha: 0, a: 0, theta: 0, d: 0}, link: {mass: 1, inertia: {}}}
  - {name: coupler, type: revolute, dh: {alpha: 0, a: 0.2, theta: 0, d: 0}, link: {mass: 1, inertia: {}}}
  - {name: rocker, parent: base, type: revolute, dh: {alpha: 0, a: 0.5, theta: 0, d: 0}, link: {mass: 1, inertia: {}}}
loops:
  - name: bar
    cut: revolute
    between: [{on: coupler, xyz: [0.45, 0, 0]}, {on: rocker, xyz: [0.3, 0, 0]}]
    dependent: [coupler, rocker]
";

fn checked(text: &str) -> Result<Checked, String> {
    let reader = Reader::new("linkage.yaml").trees().couplings().loops();
    reader.read(&format!("{HEAD}{text}")).map_err(|report| report.to_string())
}

fn read(text: &str) -> Robot {
    checked(text).unwrap_or_else(|report| panic!("{report}")).robot
}

fn names<'a>(robot: &'a Robot, joints: &[usize]) -> Vec<&'a str> {
    joints.iter().map(|&joint| robot.joints[joint].name.as_str()).collect()
}

/// The angle in ±π.
fn turned(angle: f64) -> f64 {
    angle - 2.0 * PI * (angle / (2.0 * PI)).round()
}

/// Freudenstein: with crank a at θ, rocker c at φ, coupler b at θ + β and ground d along x, the ends meet in x and y,
/// a cos θ + b cos(θ + β) = d + c cos φ. The rocker follows from b² = |d + c e(φ) - a e(θ)|² by a half-angle tangent.
#[test]
fn a_four_bar_closes_where_freudenstein_says() {
    let robot = read(FOUR_BAR);
    let (a, b, c, d) = (0.2, 0.45, 0.3, 0.5);
    let ClosedLoops { loops, passive, closures, .. } = &robot.closed;
    assert_eq!((loops[0].name.as_str(), loops[0].cut), ("bar", Cut::Revolute));
    assert_eq!((names(&robot, passive), robot.dof()), (vec!["coupler", "rocker"], 1));
    assert_eq!(closures.len(), 20);
    let mut cranks: Vec<f64> = Vec::new();
    for closure in closures {
        let &[crank, coupler, rocker] = &closure[..] else { panic!("{closure:?}") };
        // p cos φ + q sin φ = r
        let (x, y) = (d - a * crank.cos(), -a * crank.sin());
        let (p, q, r) = (2.0 * c * x, 2.0 * c * y, b * b - c * c - x * x - y * y);
        let branches = [1.0, -1.0].map(|sign| q.atan2(p) + sign * (r / p.hypot(q)).acos());
        let off = branches.map(|branch| turned(rocker - branch).abs());
        assert!(off[0].min(off[1]) < 1e-10, "{closure:?}: {branches:?}");
        let end = (d + c * rocker.cos() - a * crank.cos(), c * rocker.sin() - a * crank.sin());
        assert!(turned(end.1.atan2(end.0) - crank - coupler).abs() < 1e-10, "{closure:?}");
        cranks.push(crank);
    }
    cranks.sort_by(f64::total_cmp);
    assert!(cranks.windows(2).all(|pair| pair[1] - pair[0] > 1e-6), "{cranks:?}");
}

/// K of the four-bar by hand: p₂ - p₁ in the axes of the base, whose columns for coupler and rocker are
/// -b (-sin(θ + β), cos(θ + β)) and c (-sin φ, cos φ). The smallest pivot and the smallest singular value of all
/// configurations are found, as a walk round the crank tells on both branches.
#[test]
fn pivots_and_singular_values_are_those_of_the_matrix_by_hand() {
    let closed = read(FOUR_BAR).closed;
    let (a, b, c, d) = (0.2, 0.45, 0.3, 0.5);
    let [first, second] = [closed.elimination[0], closed.elimination[1]];
    assert!(first.equation != second.equation && first.passive != second.passive);
    // the smallest and the largest singular value and the smallest pivot at the angles of coupler and rocker
    let of = |(alpha, phi): (f64, f64)| {
        let k = [[b * alpha.sin(), -c * phi.sin()], [-b * alpha.cos(), c * phi.cos()]];
        let determinant: f64 = k[0][0] * k[1][1] - k[0][1] * k[1][0];
        let squares: f64 = k.concat().iter().map(|it| it * it).sum();
        let root = (squares * squares - 4.0 * determinant * determinant).sqrt();
        let pivot: f64 = k[first.equation][first.passive];
        let pivot = pivot.abs().min((determinant / pivot).abs());
        [f64::midpoint(squares, -root).sqrt(), -f64::midpoint(squares, root).sqrt(), pivot]
    };
    let least = |angles: &[(f64, f64)]| {
        let smaller = |known: [f64; 3], found: [f64; 3]| [0, 1, 2].map(|i| known[i].min(found[i]));
        angles.iter().copied().map(of).fold([f64::INFINITY; 3], smaller)
    };
    let walk: Vec<(f64, f64)> = (0..20_000)
        .flat_map(|step| {
            let crank = PI * f64::from(step) / 10_000.0;
            let (x, y) = (d - a * crank.cos(), -a * crank.sin());
            let (p, q, r) = (2.0 * c * x, 2.0 * c * y, b * b - c * c - x * x - y * y);
            [1.0, -1.0].map(|sign| {
                let phi = q.atan2(p) + sign * (r / p.hypot(q)).acos();
                ((y + c * phi.sin()).atan2(x + c * phi.cos()), phi)
            })
        })
        .collect();
    let [value, largest, pivot] = least(&walk);
    let at_closures = least(&closed.closures.iter().map(|it| (it[0] + it[1], it[2])).collect::<Vec<_>>());
    println!("{value} {largest} {pivot} {at_closures:?} {:?} {}", closed.singular_values, closed.smallest_pivot);
    assert!((closed.singular_values[0] - value).abs() < 1e-4);
    assert!(closed.singular_values[1] >= -at_closures[1] - 1e-12 && closed.singular_values[1] <= -largest + 1e-12);
    assert!((closed.smallest_pivot - pivot).abs() < 1e-4 && at_closures[2] > 0.1);
}

const BARS: &str = "tool: {on: coupler}
joints:
  - {name: crank, type: revolute, dh: {alpha: 0, a: 0, theta: 0, d: 0}, limits: {position: [0.3, 2.8]}}
  - {name: coupler, type: revolute, dh: {alpha: 0, a: 0.3, theta: 0, d: 0}, limits: {position: [-3, 0]}}
  - {name: rocker, parent: base, type: revolute, dh: {alpha: 0, a: 0.7, theta: 0, d: 0}, limits: {position: [0.3, 2.8]}}
loops:
  - {cut: revolute, between: [{on: coupler, xyz: [0.7, 0, 0]}, {on: rocker, xyz: [0.3, 0, 0]}],
     dependent: [coupler, rocker]}
";

/// A parallelogram as a loop without a kind: rocker = crank on the branch of the parallelogram, as the coupling of the
/// loop of kind `parallelogram` says; on the other branch the bars cross.
#[test]
fn a_parallelogram_is_a_loop_like_others() {
    let coupled = read(&BARS.replace("{cut", "{kind: parallelogram, cut"));
    let robot = read(BARS);
    assert!(coupled.closed.is_empty() && robot.closed.loops[0].name == "loop1");
    let of = |joint: usize| coupled.joints[joint].coupling.clone().expect("it follows the crank");
    assert_eq!((of(1).follows, of(2).follows), (vec![(0, -1.0)], vec![(0, 1.0)]));
    for closure in &robot.closed.closures {
        assert!((closure[1] + closure[0]).abs() < 1e-10 && (closure[2] - closure[0]).abs() < 1e-10, "{closure:?}");
    }
}

/// Where all bars lie on one line, as at zero, the rank is smaller: that is no reason to refuse the loop, and others
/// take the place of this closure.
#[test]
fn a_singular_configuration_is_none_of_the_closures() {
    let free = BARS.lines().map(|line| match line.split_once(", limits") {
        Some((line, _)) => format!("{line}}}\n"),
        None => format!("{line}\n"),
    });
    let checked = checked(&free.collect::<String>()).unwrap_or_else(|report| panic!("{report}"));
    let closures = &checked.robot.closed.closures;
    assert_eq!(closures.len(), 20);
    assert!(closures.iter().flatten().all(|position| *position != 0.0), "{closures:?}");
    let lints = checked.lints.to_string();
    assert!(lints.contains("the other joints hardly determine `coupler`"), "{lints}");
}

/// A slider-crank: crank 0.1 m, rod 0.3 m, the slide along y of frame 0.
#[test]
fn a_slide_closes_a_loop() {
    let robot = read(
        "tool: {on: rod}
joints:
  - {name: crank, type: revolute, dh: {alpha: 0, a: 0, theta: 0, d: 0}}
  - {name: rod, type: revolute, dh: {alpha: 0, a: 0.1, theta: 0, d: 0}}
  - {name: slide, parent: base, type: prismatic, dh: {alpha: -pi/2, a: 0, theta: 0, d: 0}}
loops:
  - {cut: spherical, between: [{on: rod, xyz: [0.3, 0, 0]}, {on: slide}], dependent: [rod, slide]}
",
    );
    for closure in &robot.closed.closures {
        let (crank, rod, slide) = (closure[0], closure[0] + closure[1], closure[2]);
        assert!((0.1 * crank.cos() + 0.3 * rod.cos()).abs() < 1e-12, "{closure:?}");
        assert!((0.1 * crank.sin() + 0.3 * rod.sin() - slide).abs() < 1e-12, "{closure:?}");
    }
}

const RSSR: &str = "tool: {on: spin}
joints:
  - {name: crank, type: revolute, dh: {alpha: 0, a: 0, theta: 0, d: 0}}
  - {name: ball_z, type: revolute, dh: {alpha: 0, a: 0.1, theta: 0, d: 0}}
  - {name: ball_x, type: revolute, dh: {alpha: pi/2, a: 0, theta: 0, d: 0}, limits: {position: [0.3, 2.8]}}
  - {name: spin, type: revolute, dh: {alpha: pi/2, a: 0, theta: 0, d: 0}}
  - {name: rocker, parent: base, type: revolute, at: {xyz: [0.3, 0.4, 0], rpy: [0, pi/2, 0]},
     dh: {alpha: 0, a: 0, theta: 0, d: 0}}
loops:
  - {name: rod, cut: spherical, between: [{on: spin, xyz: [0, 0, 0.5]}, {on: rocker, xyz: [0.2, 0, 0]}],
     dependent: [ball_z, ball_x, rocker]}
";

/// RSSR: a crank about z at the origin and a rocker about x at (0.3, 0.4, 0) with a rod of 0.5 m between two balls. The
/// rod is three revolute joints on the crank, at one point, with axes z, x, z, and a spherical cut at the rocker: the
/// spin about the rod is free. The rocker's angle follows from the length of the rod.
#[test]
fn a_spatial_loop_closes_where_its_rod_has_its_length() {
    let robot = read(RSSR);
    assert_eq!((robot.dof(), robot.closed.passive.len()), (2, 3));
    for closure in &robot.closed.closures {
        let (crank, rocker) = (closure[0], closure[4]);
        // x of the rocker at 0 is -z of frame 0, and its y is y
        let ball = [0.3, 0.4 + 0.2 * rocker.sin(), -0.2 * rocker.cos()];
        let other = [0.1 * crank.cos(), 0.1 * crank.sin(), 0.0];
        let length = (0..3).map(|i| (ball[i] - other[i]).powi(2)).sum::<f64>().sqrt();
        assert!((length - 0.5).abs() < 1e-12, "{closure:?}: {length}");
    }
    // without the spin as a joint the cut is a universal joint; its two axes stay perpendicular
    let universal = RSSR.replace("cut: spherical", "cut: universal").replace("ball_x, rocker", "ball_x, spin, rocker");
    assert_eq!(read(&universal).dof(), 1);
    let undetermined = checked(&RSSR.replace("ball_x, rocker", "ball_x, spin")).expect_err("the spin is free");
    assert!(undetermined.contains("do not determine the dependent joints `spin`"), "{undetermined}");
}

/// A universal joint between two shafts whose axes meet at the angle β: tan θ₂ = cos β tan θ₁ (G. Cardano, R. Hooke).
#[test]
fn a_universal_joint_turns_unevenly() {
    let robot = read(
        "tool: {on: drive}
joints:
  - {name: drive, type: revolute, dh: {alpha: 0, a: 0, theta: 0, d: 0}}
  - {name: driven, parent: base, type: revolute, dh: {alpha: 0.6, a: 0, theta: 0, d: 0}}
loops:
  - {name: shaft, cut: universal, between: [{on: drive}, {on: driven}], dependent: [driven]}
",
    );
    // the equations of positions are 0 = 0
    assert_eq!(robot.closed.elimination, [Pivot { equation: 3, passive: 0 }]);
    for closure in &robot.closed.closures {
        let (drive, driven) = (closure[0], closure[1]);
        assert!((driven.sin() * drive.cos() - 0.6_f64.cos() * driven.cos() * drive.sin()).abs() < 1e-12, "{closure:?}");
    }
}

/// A delta robot: three legs, each an arm of 0.2 m and a rod of 0.5 m whose parallelograms, as couplings, keep the
/// platform's direction; two spherical cuts join the platforms of the legs. The middle of the platform is 0.5 m from
/// each elbow, which is moved inwards by the platform's radius (R. Clavel, 1988).
#[test]
fn a_delta_robot_has_three_freedoms() {
    let leg = |name: &str, angle: f64| {
        let (x, y) = (0.15 * angle.cos(), 0.15 * angle.sin());
        format!(
            "  - {{name: {name}1, parent: base, at: {{xyz: [{x}, {y}, 0], rpy: [pi/2, 0, {angle}]}}, type: revolute, \
             dh: {{alpha: 0, a: 0, theta: 0, d: 0}}, limits: {{position: [-1.2, 0.8]}}}}
  - {{name: {name}2, type: revolute, dh: {{alpha: 0, a: 0.2, theta: 0, d: 0}}, limits: {{position: [-2.6, -0.3]}}}}
  - {{name: {name}3, type: revolute, dh: {{alpha: -pi/2, a: 0, theta: 0, d: 0}}, limits: {{position: [-1, 1]}}}}
  - {{name: {name}4, type: revolute, dh: {{alpha: 0, a: 0.5, theta: 0, d: 0}}}}
  - {{name: {name}5, type: revolute, dh: {{alpha: pi/2, a: 0, theta: 0, d: 0}}}}
"
        )
    };
    let angles = [0.0, 2.0 * PI / 3.0, -2.0 * PI / 3.0];
    let legs: String = ["a", "b", "c"].iter().zip(angles).map(|(name, angle)| leg(name, angle)).collect();
    let couplings = ["a", "b", "c"].map(|name| {
        format!(
            "  - {{joint: {name}4, follows: {{{name}3: -1}}}}
  - {{joint: {name}5, follows: {{{name}1: -1, {name}2: -1}}}}\n"
        )
    });
    let end = |name: &str| format!("{{on: {name}5, xyz: [-0.05, 0, 0]}}");
    let text = format!(
        "tool: {{on: a5}}\njoints:\n{legs}couplings:\n{}loops:
  - {{name: ab, cut: spherical, between: [{}, {}], dependent: [a2, a3, b3]}}
  - {{name: ac, cut: spherical, between: [{}, {}], dependent: [b2, c2, c3]}}\n",
        couplings.concat(),
        end("a"),
        end("b"),
        end("a"),
        end("c")
    );
    // b2 moves the first loop, not the second
    let refused = checked(&text).expect_err("b2 is no joint of the second loop");
    assert!(
        refused.contains(
            "`b2` does not move the loop `ac`; the joints that move it are `a1`, `a2`, `a3`, `c1`, `c2`, `c3`"
        ),
        "{refused}"
    );
    let text = text.replace("[a2, a3, b3]", "[a2, b2, b3]").replace("[b2, c2, c3]", "[a3, c2, c3]");
    let robot = read(&text);
    let free: Vec<&str> = robot.independent_joints().map(|joint| joint.name.as_str()).collect();
    assert_eq!(free, ["a1", "b1", "c1"]);
    for closure in &robot.closed.closures {
        // the platform by the first leg, in whose plane x is outwards and z is up
        let (arm, rod, aside) = (closure[0], closure[0] + closure[1], closure[2]);
        let out = 0.15 + 0.2 * arm.cos() + 0.5 * rod.cos() * aside.cos() - 0.05;
        let platform = [out, 0.5 * aside.sin(), 0.2 * arm.sin() + 0.5 * rod.sin() * aside.cos()];
        for (leg, angle) in angles.into_iter().enumerate() {
            let arm = closure[5 * leg];
            let out = 0.15 + 0.2 * arm.cos() - 0.05;
            let elbow = [out * angle.cos(), out * angle.sin(), 0.2 * arm.sin()];
            let length = (0..3).map(|i| (platform[i] - elbow[i]).powi(2)).sum::<f64>().sqrt();
            assert!((length - 0.5).abs() < 1e-12, "{closure:?}: leg {leg}: {length}");
        }
    }
}

/// A five-bar has two freedoms, and any two of its four tree joints may be dependent.
#[test]
fn a_five_bar_has_two_freedoms() {
    let robot = read(&five_bar("[left_2, right_2]"));
    assert_eq!(robot.independent_joints().map(|joint| joint.name.as_str()).collect::<Vec<_>>(), ["left", "right"]);
    for pair in ["[left, right]", "[left, left_2]", "[right_2, left]"] {
        assert_eq!(read(&five_bar(pair)).dof(), 2, "{pair}");
    }
    for closure in &robot.closed.closures {
        let end = |root: f64, first: f64, second: f64| {
            [root + 0.3 * first.cos() + 0.4 * (first + second).cos(), 0.3 * first.sin() + 0.4 * (first + second).sin()]
        };
        let (left, right) = (end(0.0, closure[0], closure[1]), end(0.2, closure[2], closure[3]));
        assert!((left[0] - right[0]).hypot(left[1] - right[1]) < 1e-12, "{closure:?}");
    }
}

fn five_bar(dependent: &str) -> String {
    format!(
        "tool: {{on: left_2}}
joints:
  - {{name: left, type: revolute, dh: {{alpha: 0, a: 0, theta: 0, d: 0}}}}
  - {{name: left_2, type: revolute, dh: {{alpha: 0, a: 0.3, theta: 0, d: 0}}}}
  - {{name: right, parent: base, type: revolute, dh: {{alpha: 0, a: 0.2, theta: 0, d: 0}}}}
  - {{name: right_2, type: revolute, dh: {{alpha: 0, a: 0.3, theta: 0, d: 0}}}}
loops:
  - {{name: five, cut: revolute, between: [{{on: left_2, xyz: [0.4, 0, 0]}}, {{on: right_2, xyz: [0.4, 0, 0]}}],
     dependent: {dependent}}}
"
    )
}

/// A weld leaves nothing free between the places: a chain of seven joints whose end is held has one freedom, by which
/// its elbow swings. The axes of the places must be the same, not opposite.
#[test]
fn a_weld_holds_a_redundant_arm() {
    let row = |name: &str, alpha: &str, d: f64| {
        format!("  - {{name: {name}, type: revolute, dh: {{alpha: {alpha}, a: 0, theta: 0, d: {d}}}}}\n")
    };
    let rows = [("j1", "0", 0.3), ("j2", "-pi/2", 0.0), ("j3", "pi/2", 0.4), ("j4", "pi/2", 0.0)];
    let wrist = [("j5", "-pi/2", 0.4), ("j6", "-pi/2", 0.0), ("j7", "pi/2", 0.1)];
    let rows: String = rows.iter().chain(&wrist).map(|(name, alpha, d)| row(name, alpha, *d)).collect();
    let text = format!(
        "joints:\n{rows}loops:\n  - {{cut: weld, between: [{{on: base, xyz: [0.4, 0.1, 0.5], rpy: [0.3, 1, 0.2]}}, \
         {{on: j7}}], dependent: [j2, j3, j4, j5, j6, j7]}}\n"
    );
    let robot = read(&text);
    assert_eq!((robot.dof(), robot.closed.equations(), robot.closed.passive.len()), (1, 6, 6));
    let equations: Vec<usize> = robot.closed.elimination.iter().map(|pivot| pivot.equation).collect();
    assert!((0..6).all(|equation| equations.contains(&equation)), "{equations:?}");
    for closure in &robot.closed.closures {
        // the wrist is 0.1 m behind the end, and so far from the shoulder as the elbow's angle says
        let (sr, cr, sp, cp, sy, cy) =
            (0.3_f64.sin(), 0.3_f64.cos(), 1_f64.sin(), 1_f64.cos(), 0.2_f64.sin(), 0.2_f64.cos());
        let z = [cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr];
        let wrist = [0.4 - 0.1 * z[0], 0.1 - 0.1 * z[1], 0.5 - 0.1 * z[2] - 0.3];
        let square: f64 = wrist.iter().map(|it| it * it).sum();
        assert!((0.32 * (1.0 + closure[3].cos()) - square).abs() < 1e-12, "{closure:?}");
    }
}

/// A follower in a loop: the rocker's joint turns half as far as the crank and the loop has a slide that gives.
#[test]
fn followers_move_loops_through_their_leaders() {
    let text = "tool: {on: rod}
joints:
  - {name: crank, type: revolute, dh: {alpha: 0, a: 0, theta: 0, d: 0}}
  - {name: rod, type: revolute, dh: {alpha: 0, a: 0.2, theta: 0, d: 0}}
  - {name: arm, parent: base, type: revolute, dh: {alpha: 0, a: 0.5, theta: 0, d: 0}}
  - {name: slide, type: prismatic, dh: {alpha: -pi/2, a: 0, theta: 0, d: 0}}
couplings:
  - {joint: arm, follows: {crank: 0.5}, offset: 0.1}
loops:
  - {cut: spherical, between: [{on: rod, xyz: [0.4, 0, 0]}, {on: slide}], dependent: [rod, slide]}
";
    let robot = read(text);
    assert_eq!(robot.dof(), 1);
    for closure in &robot.closed.closures {
        let &[crank, rod, arm, slide] = &closure[..] else { panic!("{closure:?}") };
        assert!((arm - 0.5 * crank - 0.1).abs() < 1e-12, "{closure:?}");
        let end = [0.2 * crank.cos() + 0.4 * (crank + rod).cos(), 0.2 * crank.sin() + 0.4 * (crank + rod).sin()];
        assert!((end[0] - 0.5 + slide * arm.sin()).abs() < 1e-12, "{closure:?}");
        assert!((end[1] - slide * arm.cos()).abs() < 1e-12, "{closure:?}");
    }
    // the leader may be dependent, too; the follower may not
    assert_eq!(read(&text.replace("[rod, slide]", "[crank, slide]")).dof(), 1);
    let refused = checked(&text.replace("[rod, slide]", "[arm, slide]")).expect_err("it follows");
    assert!(refused.contains("the dependent joint `arm` follows other joints already"), "{refused}");
}

/// Two four-bars on one crank share it: their equations are solved together.
#[test]
fn loops_that_share_joints_are_counted_together() {
    let second = "  - {name: coupler_2, parent: crank, type: revolute, dh: {alpha: 0, a: 0.15, theta: 0, d: 0}}
  - {name: rocker_2, parent: base, type: revolute, dh: {alpha: 0, a: -0.5, theta: 0, d: 0}}
loops:
  - name: second
    cut: spherical
    between: [{on: coupler_2, xyz: [0.45, 0, 0]}, {on: rocker_2, xyz: [0.3, 0, 0]}]
    dependent: [coupler_2, rocker_2]
";
    let text = FOUR_BAR.replace("loops:\n", second);
    let robot = read(&text);
    assert_eq!((robot.dof(), robot.closed.passive.len(), robot.closed.equations()), (1, 4, 8));
    // the equations of the second loop come first in the file
    let of_second = robot.closed.elimination.iter().filter(|pivot| pivot.equation < 3);
    assert!(of_second.clone().all(|pivot| pivot.passive >= 2) && of_second.count() == 2);
    let refused = checked(&text.replace("[coupler, rocker]", "[coupler, rocker, crank]")).expect_err("one too many");
    assert!(refused.contains("share joints and have 5 dependent joints together"), "{refused}");
    assert!(refused.contains("linkage.yaml:21:16"), "the list of the loop that names too many: {refused}");
    let named_twice = checked(&text.replace("[coupler, rocker]", "[coupler, rocker_2]")).expect_err("named twice");
    assert!(named_twice.contains("`rocker_2` is a dependent joint of another loop already"), "{named_twice}");
}

#[test]
fn what_cannot_be_solved_is_refused_at_its_line() {
    let bar = |dependent: &str| FOUR_BAR.replace("[coupler, rocker]", dependent);
    let ends = "[{on: coupler, xyz: [0.45, 0, 0]}, {on: rocker, xyz: [0.3, 0, 0]}]";
    let between = |text: &str| FOUR_BAR.replace(ends, text);
    for (text, place, said) in [
        (bar("[coupler]"), "15:16", "has 1 dependent joint, but its equations determine 2"),
        (bar("[coupler, rocker, crank]"), "15:16", "has 3 dependent joints, but its equations determine 2"),
        (bar("[]"), "15:16", "found a list of 0 where a list of joints is needed"),
        (bar("coupler"), "15:16", "found `coupler` where a list of joints is needed"),
        (bar("[coupler, elbow]"), "15:26", "`dependent` names `elbow`, which is no joint of this file"),
        (bar("[coupler, coupler]"), "15:26", "`dependent` names `coupler` twice"),
        (between("[{on: base}, {on: base}]"), "14:14", "both places of the loop `bar` are on `base`"),
        (between("[{on: rocker}, {on: rocker}]"), "14:14", "both places of the loop `bar` are on the link of `rocker`"),
        (between("[{on: rocker}]"), "14:14", "found a list of 1 where a list of two places is needed"),
        (between("[{on: crank}, {on: rocker}]"), "15:16", "`coupler` does not move the loop `bar`"),
        (FOUR_BAR.replace("0.45", "1.5"), "14:14", "leaves its two places 0.5 m apart"),
        (FOUR_BAR.replace("0.45", "1e300"), "14:14", "no configuration closes the loop"),
        (FOUR_BAR.replace("0.45", ".nan"), "14:35", "is not a number"),
        (FOUR_BAR.replace("[0.45, 0, 0]", "[0.45, 0, 0.01]"), "14:14", "leaves its two places 0.01 m apart"),
        (FOUR_BAR.replace("[0.45, 0, 0]", "[0.45, 0, 0], rpy: [pi, 0, 0]"), "14:14", "turned by 3.14 rad"),
        (FOUR_BAR.replace("cut: revolute", "cut: prismatic"), "13:10", "unknown cut joint"),
        (FOUR_BAR.replace("cut: revolute", "cut: weld"), "14:14", "no configuration closes the loop"),
        (
            FOUR_BAR.replace(
                "type: revolute, dh: {alpha: 0, a: 0.5",
                "type: revolute, motor: {inertia: 1}, dh: {alpha: 0, a: 0.5",
            ),
            "15:16",
            "`rocker` has a `motor`",
        ),
        (
            format!("{FOUR_BAR}  - {{name: bar, cut: spherical, between: {ends}, dependent: [crank]}}\n"),
            "16:12",
            "two loops have the name `bar`",
        ),
        (
            format!("{FOUR_BAR}  - {{cut: spherical, between: {ends}, dependent: [crank]}}\n"),
            "16:110",
            "have 3 dependent joints together, but",
        ),
        (
            FOUR_BAR.replace("cut: revolute", "kind: parallelogram\n    cut: spherical"),
            "14:10",
            "it must be `cut: revolute`",
        ),
    ] {
        let report = checked(&text).err().unwrap_or_else(|| panic!("read, but: {said}\n{text}"));
        assert!(report.contains(said), "{said}\n{report}");
        assert!(report.contains(&format!("linkage.yaml:{place}")), "{place}: {said}\n{report}");
    }
    let format_1 = HEAD.replace("format: 2", "format: 1")
        + &FOUR_BAR.replace("parent: base, ", "").replace("tool: {on: coupler}\n", "");
    let report = Reader::new("linkage.yaml").trees().couplings().loops().read(&format_1).unwrap_err().short();
    assert!(report.contains("the key `loops` needs `format: 2`"), "{report}");
}

/// A second cut at the same places adds nothing.
#[test]
fn a_loop_that_repeats_another_is_to_be_deleted() {
    let places = "[{on: coupler, xyz: [0.45, 0, 0]}, {on: rocker, xyz: [0.3, 0, 0]}]";
    let again = format!("{FOUR_BAR}  - {{name: again, cut: spherical, between: {places}, dependent: [crank]}}\n");
    let report = checked(&again).expect_err("it repeats");
    assert!(report.contains("have 3 dependent joints together, but their equations determine 2"), "{report}");
    assert!(report.contains("delete the loop `again`: its equations follow from those of the other loops"), "{report}");
}

/// Who does not take closed loops gets none.
#[test]
fn closed_loops_are_refused_where_they_are_not_taken() {
    let text = format!("{HEAD}{FOUR_BAR}");
    let report = Reader::new("linkage.yaml").trees().couplings().read(&text).unwrap_err().short();
    assert_eq!(report.trim_end().lines().count(), 1, "{report}");
    assert!(report.contains("the robot has closed loops, which are not supported here"), "{report}");
}

/// The slide of a slider-crank that drives stands still at two dead points.
#[test]
fn singular_configurations_within_the_limits_are_noted() {
    let text = "tool: {on: rod}
joints:
  - {name: crank, type: revolute, dh: {alpha: 0, a: 0, theta: 0, d: 0}, link: {mass: 1, inertia: {}}}
  - {name: rod, type: revolute, dh: {alpha: 0, a: 0.1, theta: 0, d: 0}, link: {mass: 1, inertia: {}}}
  - {name: slide, parent: base, type: prismatic, dh: {alpha: -pi/2, a: 0, theta: 0, d: 0}, link: {mass: 1, inertia: {}}}
loops:
  - {cut: spherical, between: [{on: rod, xyz: [0.3, 0, 0]}, {on: slide}], dependent: [crank, rod]}
";
    let lints = |text: &str| checked(text).unwrap_or_else(|report| panic!("{report}")).lints.to_string();
    let noted = lints(text);
    assert!(noted.contains("note: near crank = ") && noted.contains("hardly determine `crank`"), "{noted}");
    // crank and rod of one length: with the slide at 0 the crank turns freely, and such configurations do not count
    let equal = lints(&text.replace("[0.3, 0, 0]", "[0.1, 0, 0]"));
    assert!(equal.contains("of 20 configurations that close the loops were found"), "{equal}");
    let narrow = text.replace(
        "d: 0}, link: {mass: 1, inertia: {}}}\n  - {name: rod",
        "d: 0}, link: {mass: 1, inertia: {}}, limits: {position: [-1, 1]}}\n  - {name: rod",
    );
    assert_ne!(narrow, text);
    assert_eq!(lints(&narrow), "");
}

/// A loop of many joints, and many loops, are read in bounded time.
#[test]
fn hostile_loops_are_refused_soon() {
    let row = |index: usize| {
        let alpha = ["pi/2", "-pi/2"][index % 2];
        format!("  - {{name: j{index}, type: revolute, dh: {{alpha: {alpha}, a: 0.1, theta: 0, d: 0}}}}\n")
    };
    let rows: String = (0..64).map(row).collect();
    let item = |index: usize| {
        format!(
            "  - {{cut: weld, between: [{{on: base, xyz: [0.{index}, 0, 0]}}, {{on: j63}}], dependent: [j{index}]}}\n"
        )
    };
    let loops: String = (0..60).map(item).collect();
    let report = checked(&format!("joints:\n{rows}loops:\n{loops}")).expect_err("they exclude each other");
    assert!(report.contains("no configuration closes the loop"), "{report}");
}

/// Whole messages: `INSTA_UPDATE=always cargo test -p rne-model --test closed_loops` writes the snapshot.
#[test]
fn messages() {
    let text = [
        FOUR_BAR.replace("[coupler, rocker]", "[rocker]"),
        five_bar("[left, left_2, right]"),
        FOUR_BAR.replace("0.45", "1.5"),
        FOUR_BAR.replace("rocker, xyz: [0.3, 0, 0]", "rocker, xyz: [0.3, 0, 0], rpy: [0.001, 0, 0]"),
        RSSR.replace("ball_x, rocker", "ball_x, spin"),
        BARS.replace("{on: coupler, xyz: [0.7, 0, 0]}", "{on: crank}"),
    ]
    .map(|text| checked(&text).expect_err(&text));
    insta::assert_snapshot!(text.join("\n\n"));
}

/// A joint in radians that follows a slide moves as far as the slide does: the search for closures takes steps in
/// metres for both.
#[test]
fn a_follower_in_radians_of_a_slide_closes() {
    let text = "
format: 2
name: m
source: x
convention: modified
gravity: [0, 0, -9.81]
tool: {on: k5}
joints:
  - {name: k0, type: revolute, dh: {theta: -1.9317, d: -0.8962, a: 0.3174, alpha: -1.5707}}
  - {name: k1, type: revolute, dh: {theta: -0.8313, d: -0.9585, a: -0.1516, alpha: 1.5707}}
  - {name: k2, type: prismatic, dh: {theta: 1.6805, d: -0.5900, a: 1.2095, alpha: -1.5707}}
  - {name: k3, type: prismatic, dh: {theta: 2.6659, d: -1.6854, a: 0.4758, alpha: 1.5707}}
  - {name: k4, type: revolute, dh: {theta: -0.2627, d: 1.1098, a: 0.2239, alpha: 0.0, gamma: 0.8648, b: -1.2685}}
  - {name: k5, type: revolute, dh: {theta: -2.8046, d: -0.0916, a: -0.2830, alpha: 1.5707}}
couplings: [{joint: k0, follows: {k3: 1.7525}, offset: 0.0}]
loops:
  - name: l0
    cut: universal
    between:
      - {on: base, xyz: [0.1799, 1.9487, 1.5778], rpy: [-0.0713, -1.3394, -0.3253]}
      - {on: k5, xyz: [1.9592, -0.5403, 3.1157], rpy: [-2.0687, -0.1467, 0.7817]}
    dependent: [k1, k2, k4, k5]
";
    let read = Reader::new("m").trees().couplings().loops().read(text.as_bytes());
    let robot = read.unwrap_or_else(|report| panic!("{}", report.render(false))).robot;
    assert_eq!(robot.closed.passive, [1, 2, 4, 5]);
}

/// A loop knows nothing of the base.
#[test]
fn loops_on_a_floating_base_are_those_on_a_fixed_one() {
    let text = format!("{FOUR_BAR}floating_base: {{name: trunk, link: {{mass: 3}}}}\n");
    assert_eq!(read(&text).closed, read(FOUR_BAR).closed);
}

/// Two bars between two points of the base: a frame, beside a crank that moves.
#[test]
fn a_loop_that_cannot_move_is_told() {
    let text = "tool: {on: crank}
joints:
  - {name: crank, type: revolute, dh: {alpha: 0, a: 0, theta: 0, d: 0}, link: {mass: 1, inertia: {}}}
  - {name: bar, parent: base, type: revolute, dh: {alpha: 0, a: 0.2, theta: 0, d: 0}, link: {mass: 1, inertia: {}}}
  - {name: stay, type: revolute, dh: {alpha: 0, a: 0.3, theta: 0, d: 0}, link: {mass: 1, inertia: {}}}
loops: [{name: frame, cut: spherical, between: [{on: base, xyz: [0.5, 0.1, 0]}, {on: stay, xyz: [0.3, 0, 0]}],
         dependent: [bar, stay]}]
";
    let lints = checked(text).unwrap_or_else(|report| panic!("{report}")).lints.to_string();
    assert!(lints.contains("the loop `frame` cannot move: all joints that move it are dependent"), "{lints}");
    assert!(!checked(FOUR_BAR).expect("a four-bar").lints.to_string().contains("cannot move"));
}

/// The axis of the pin points the other way at one end.
#[test]
fn opposite_axes_are_told_from_wrong_lengths() {
    let text = FOUR_BAR.replace("xyz: [0.45, 0, 0]}", "xyz: [0.45, 0, 0], rpy: [pi, 0, 0]}");
    let report = checked(&text).expect_err("opposite axes");
    assert!(report.contains("turn one place by `rpy: [pi, 0, 0]`"), "{report}");
}

#[test]
fn limits_that_leave_no_closure_are_told() {
    let limited = "{name: rocker, parent: base, type: revolute, limits: {position: [0.1, 0.2]},";
    let text = FOUR_BAR.replace("{name: rocker, parent: base, type: revolute,", limited);
    let told = "no configuration within the position limits was found that closes the loops";
    assert!(checked(&text).expect("a four-bar").lints.to_string().contains(told));
    assert!(!checked(FOUR_BAR).expect("a four-bar").lints.to_string().contains(told));
}

/// The speed of a dependent joint is no constant multiple of that of the crank.
#[test]
fn motors_turn_joints_that_are_not_dependent() {
    let motors = |turns: &str| format!("{FOUR_BAR}motors: [{{name: m, turns: {{{turns}}}}}]\n");
    assert!(checked(&motors("crank: 3")).is_ok());
    let report = checked(&motors("crank: 3, rocker: 5")).expect_err("a dependent joint");
    assert!(report.contains("the motor `m` turns with the joint `rocker`, which is dependent"), "{report}");
}
