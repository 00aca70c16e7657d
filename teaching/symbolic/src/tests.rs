//! Tests that compare the seven steps over polynomials with Lagrange's equations, as polynomials, and with the runtime,
//! as numbers, and the written formulas with both.

mod results;

use fastrand::Rng;
use rne_model::{InertiaReference, Robot};
use rne_runtime::DynArm;

use crate::collected::Collector;
use crate::derivation::{Derivation, TooLong};
use crate::equations::Equations;
use crate::polynomial::Polynomial;
use crate::table::Table;
use crate::{lagrange, read};

/// Textbook arms in letters: uniform rods, a prismatic joint after a revolute one, and the reverse.
const TEXTBOOK: [&str; 5] = [
    "parameters: {m: 2.5, a: 0.8, g: 9.81}
convention: standard
gravity: [g, 0, 0]
joints:
  - {type: revolute, dh: {theta: 0, d: 0, a: a, alpha: 0},
     link: {mass: m, com: [-a/2, 0, 0], inertia: {yy: m*a^2/12, zz: m*a^2/12}}}",
    "parameters: {m1: 2.5, a1: 0.8, m2: 1.5, a2: 0.6, gx: 9.81, gy: 1.2}
convention: standard
gravity: [gx, gy, 0]
joints:
  - {type: revolute, dh: {theta: 0, d: 0, a: a1, alpha: 0},
     link: {mass: m1, com: [-a1/2, 0, 0], inertia: {yy: m1*a1^2/12, zz: m1*a1^2/12}}}
  - {type: revolute, dh: {theta: 0, d: 0, a: a2, alpha: 0},
     link: {mass: m2, com: [-a2/2, 0, 0], inertia: {yy: m2*a2^2/12, zz: m2*a2^2/12}}}",
    "parameters: {m1: 2.5, m2: 1.5, l: 0.3, J1: 0.12, J2: 0.05, g: 9.81}
convention: standard
gravity: [0, -g, 0]
joints:
  - {type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: pi/2},
     link: {mass: m1, com: [0, 0, l], inertia: {yy: J1}, physical: false}}
  - {type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: m2, inertia: {yy: J2}, physical: false}}",
    "parameters: {m1: 2.5, m2: 1.5, l: 0.3, J2: 0.05, g: 9.81}
convention: standard
gravity: [0, 0, -g]
joints:
  - {type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: pi/2}, link: {mass: m1}}
  - {type: revolute, dh: {theta: 0, d: 0, a: 2*l, alpha: 0},
     link: {mass: m2, com: [-l, 0, 0], inertia: {zz: J2}, physical: false}}",
    // a parameter in a denominator, an offset, and a tensor about the origin from parameters
    "parameters: {m: 2, r: 0.5, k: 4, l: 0.2}
convention: modified
gravity: [0, 0, -9.81]
joints:
  - {type: prismatic, dh: {theta: 0.3, d: l, a: 0, alpha: 0.4},
     link: {mass: m, com: [r/k, 0, 0.1], inertia: {zz: m*r^2, yy: m*r^2, xx: 0.1}, inertia_about: origin}}
  - {type: revolute, dh: {theta: pi/2, d: 0, a: r, alpha: -pi/2},
     link: {mass: m/k, com: [0, 1/k - r/(k*l), 0.2], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}}",
];

/// Two pendulums on a cart, and two arms on a column, one with a prismatic joint.
const TREES: [&str; 2] = [
    "parameters: {M: 3, m1: 1, m2: 2, l1: 0.4, l2: 0.7, g: 9.81}
convention: standard
gravity: [0, -g, 0]
tool: {on: long}
joints:
  - {name: cart, parent: base, at: {xyz: [0, 0, 0], rpy: [0, pi/2, 0]}, type: prismatic,
     dh: {theta: 0, d: 0, a: 0, alpha: -pi/2}, link: {mass: M}}
  - {name: short, parent: cart, at: {xyz: [0.1, 0.2, 0], rpy: [pi/2, 0, 0]}, type: revolute,
     dh: {theta: -pi/2, d: 0, a: l1, alpha: 0}, link: {mass: m1}}
  - {name: long, parent: cart, at: {xyz: [-0.1, 0.2, 0.5], rpy: [pi/2, pi, -pi/2]}, type: revolute,
     dh: {theta: 0, d: 0, a: l2, alpha: 0}, link: {mass: m2, com: [-l2/4, 0, 0.1], inertia: {zz: 0.02, yy: 0.02}}}",
    "parameters: {h: 0.5, a: 0.3, m: 2}
convention: modified
gravity: [0.5, 0, -9.81]
tool: {on: left}
joints:
  - {name: column, type: revolute, dh: {theta: 0, d: h, a: 0, alpha: 0}, motor: {inertia: 0.002, gear_ratio: 50},
     link: {mass: 12, com: [0.1, 0.2, 0], inertia: {xx: 0.3, yy: 0.3, zz: 0.2, xy: 0.01}}}
  - {name: left, parent: column, type: revolute, dh: {gamma: pi/2, b: 0.3, theta: 0.2, d: 0.1, a: a, alpha: pi/2},
     link: {mass: m, com: [0.2, 0, 0.04], inertia: {xx: 0.01, yy: 0.03, zz: 0.03, yz: 0.002}}}
  - {name: right, parent: column, type: prismatic, dh: {gamma: -pi/2, b: -0.3, theta: 0, d: 0, a: a, alpha: 0.4},
     link: {mass: m, com: [0.2, 0.1, 0], inertia: {yy: 0.03, zz: 0.03}}}",
];

pub(crate) fn robot(text: &str) -> Robot {
    let format = if text.contains("parent:") { 2 } else { 1 };
    let text = format!("format: {format}\nname: arm\nsource: a test\n{text}\n");
    read("arm.yaml", text.as_bytes()).unwrap_or_else(|report| panic!("{report}\n{text}"))
}

fn shipped(name: &str) -> Robot {
    let file = rne_robots::find(name).expect("it is shipped");
    read(name, file.yaml.as_bytes()).expect("it is valid")
}

/// Removes the joints of an arm after the first `joints`.
fn up_to(robot: &Robot, joints: usize) -> Robot {
    let mut first = robot.clone();
    first.joints.truncate(joints);
    first
}

/// Makes a random table: both conventions, right and other angles, prismatic joints, zeros, tensors about either point.
fn random_robot(rng: &mut Rng, joints: usize) -> Robot {
    let convention = ["standard", "modified"][rng.usize(..2)];
    let number = |rng: &mut Rng| format!("{:.3}", 0.1 + rng.f64());
    let maybe = |rng: &mut Rng| if rng.u8(..3) == 0 { number(rng) } else { "0".to_owned() };
    let angle = |rng: &mut Rng| ["0", "pi/2", "-pi/2", "pi", "0.7", "-1.1"][rng.usize(..6)];
    let vector = |rng: &mut Rng| format!("[{}, {}, {}]", maybe(rng), maybe(rng), maybe(rng));
    let mut text = format!("convention: {convention}\ngravity: {}\njoints:", vector(rng));
    for _ in 0..joints {
        let kind = ["revolute", "revolute", "prismatic"][rng.usize(..3)];
        let (theta, alpha) = (angle(rng), angle(rng));
        let (d, a, mass, com) = (maybe(rng), maybe(rng), number(rng), vector(rng));
        let about = ["com", "origin"][rng.usize(..2)];
        let products = format!("xy: {}, xz: {}, yz: {}", maybe(rng), maybe(rng), maybe(rng));
        let moments = format!("xx: {}, yy: {}, zz: {}", maybe(rng), maybe(rng), number(rng));
        let motor = format!("{{inertia: {}, gear_ratio: -2.5}}", number(rng));
        let row = format!(
            "\n  - {{type: {kind}, dh: {{theta: {theta}, d: {d}, a: {a}, alpha: {alpha}}}, motor: {motor}, link: \
             {{mass: {mass}, com: {com}, inertia: {{{moments}, {products}}}, inertia_about: {about}, physical: \
             false}}}}"
        );
        text.push_str(&row);
    }
    robot(&text)
}

fn random_robots(count: usize) -> Vec<Robot> {
    let mut rng = Rng::with_seed(7);
    let robots = (0..count).map(|index| {
        let robot = random_robot(&mut rng, 1 + index % 3);
        if index % 4 == 0 { robot.with_rotors() } else { robot }
    });
    robots.collect()
}

/// Replaces the masses of every second link by first moments.
fn without_mass(mut robot: Robot) -> Robot {
    for joint in robot.joints.iter_mut().step_by(2) {
        let link = &mut joint.row.link;
        (link.first_moment, link.mass, link.com) = (link.com, 0.0, [0.0; 3]);
        joint.written_inertia = (link.inertia, InertiaReference::Origin);
    }
    robot
}

/// Returns the arms of every test below: textbook, shipped, random.
fn robots() -> Vec<Robot> {
    let textbook = TEXTBOOK.map(robot);
    let trees = TREES.map(robot);
    let first = [("stanford", 3), ("puma560", 3), ("puma560_mdh", 3), ("ur5", 3), ("fr3", 2), ("jaco", 2)];
    let first = first.map(|(name, joints)| up_to(&shipped(name), joints));
    let whole = ["planar1", "planar2", "planar3", "cylindrical_rpp", "gantry_ppp", "scara_cobra600", "spherical_rrp"];
    textbook
        .into_iter()
        .chain(trees.iter().cloned())
        .chain(trees.clone().map(Robot::with_rotors))
        .chain(first)
        .chain(whole.map(shipped))
        .chain(random_robots(60))
        .chain(random_robots(30).into_iter().map(without_mass))
        .collect()
}

fn derived(table: &Table) -> Result<Equations, TooLong> {
    Derivation::new(table, &[]).map(|derivation| Equations::sorted(&derivation.torques()))
}

/// Two derivations that have only the letters of the table in common give the same polynomials. A wrong sign in a
/// recursion, a Jacobian or a Christoffel symbol would change them.
#[test]
fn the_seven_steps_are_lagranges_equations() {
    let mut robots_compared = 0;
    for robot in robots() {
        let table = Table::new(&robot, robot.dof());
        let (Ok(steps), Ok(lagranges)) = (derived(&table), lagrange::equations(&table)) else { continue };
        assert_eq!(steps, lagranges, "{robot:?}");
        // symmetries that the recursion does not use
        for i in 0..robot.dof() {
            for j in 0..robot.dof() {
                assert_eq!(steps.mass_matrix[i][j], steps.mass_matrix[j][i]);
                for k in 0..robot.dof() {
                    // Ṁ - 2C is skew
                    let [c, d] = [&steps.christoffel[i][j][k], &steps.christoffel[j][i][k]];
                    assert_eq!(c + d, steps.mass_matrix[i][j].by_joint(k));
                }
            }
        }
        robots_compared += 1;
    }
    assert!(robots_compared >= 70, "{robots_compared} arms are short enough");
}

/// Splitting the torques into parts loses no term.
#[test]
fn the_parts_are_the_torque() {
    for robot in robots() {
        let table = Table::new(&robot, robot.dof());
        let Ok(torques) = Derivation::new(&table, &[]).map(|derivation| derivation.torques()) else { continue };
        let equations = Equations::sorted(&torques);
        for (joint, torque) in torques.iter().enumerate() {
            assert_eq!(equations.torque(joint), *torque);
        }
    }
}

/// Joints of different branches have no mass in common, and a placement at other angles has no fractions.
#[test]
fn a_tree_has_a_closed_form() {
    for tree in TREES {
        let form = crate::ClosedForm::of(&robot(tree), 3);
        assert_eq!(form.is_lagranges(), Some(true));
        let mass = form.mass(1, 2);
        assert!(mass.is_none_or(|mass| mass == "0"), "{tree}");
    }
    let oblique = robot(&TREES[1].replace("gamma: pi/2", "gamma: 0.4"));
    let text = crate::ClosedForm::of(&oblique, 3).text();
    assert!(text.contains("the row of left begins at an angle"), "{text}");
}

/// A pendulum with a first moment but no mass has no square of its lever.
#[test]
fn a_first_moment_is_a_letter() {
    let robot = robot(
        "convention: standard\ngravity: [0, -9.81, 0]\njoints:\n  - {type: revolute, dh: {theta: 0, d: 0, a: 0.5, \
         alpha: 0}, link: {first_moment: [-0.3, 0, 0], inertia: {zz: 0.4}, physical: false}}",
    );
    let table = Table::new(&robot, 1);
    let names: Vec<&str> = table.constants.0.iter().map(|constant| constant.name.as_str()).collect();
    assert_eq!(names, ["g", "J1_zz", "a1", "mcx1"]);
    let equations = derived(&table).unwrap();
    let value = |polynomial: &Polynomial| polynomial.evaluate(|symbol| table.value(symbol, &[0.0], &[0.0], &[0.0]));
    assert!((value(&equations.mass_matrix[0][0]) - (0.4 - 2.0 * 0.5 * 0.3)).abs() < 1e-15);
    assert!((value(&equations.gravity[0]) + 9.81 * 0.3).abs() < 1e-15);
}

#[test]
fn the_numbers_are_those_of_the_runtime() {
    let mut rng = Rng::with_seed(3);
    let mut largest: f64 = 0.0;
    for robot in robots() {
        let table = Table::new(&robot, robot.dof());
        let Ok(equations) = derived(&table) else { continue };
        let arm = DynArm::from_robot(&robot);
        for _ in 0..10 {
            let mut state = || (0..robot.dof()).map(|_| 4.0 * rng.f64() - 2.0).collect::<Vec<_>>();
            let (q, qd, qdd) = (state(), state(), state());
            let expected = arm.inverse_dynamics(&q, &qd, &qdd).expect("lengths");
            let scale = expected.iter().fold(1.0_f64, |scale, tau| scale.max(tau.abs()));
            for (joint, expected) in expected.iter().enumerate() {
                let found = equations.torque(joint).evaluate(|symbol| table.value(symbol, &q, &qd, &qdd));
                largest = largest.max((found - expected).abs() / scale);
            }
        }
    }
    assert!(largest < 1e-12, "{largest:e} of the largest torque");
}

/// A printed form gives the polynomial again when it is multiplied out.
#[test]
fn what_is_collected_is_what_was_derived() {
    let mut compared = 0;
    for robot in robots() {
        let table = Table::new(&robot, robot.dof());
        let Ok(equations) = derived(&table) else { continue };
        let mut collector = Collector::new(&table.constants);
        let h: Vec<Polynomial> = (0..robot.dof()).map(|joint| equations.velocity_torque(joint)).collect();
        for polynomial in equations.all().chain(&h) {
            let is_short = polynomial.terms().is_some_and(|terms| terms.len() < 120);
            if is_short && let Some(sum) = collector.collected(polynomial) {
                assert_eq!(sum.expanded(), *polynomial, "{sum:?}");
                compared += 1;
            }
        }
    }
    assert!(compared > 1000, "{compared} polynomials");
}

/// Every letter of the list at the end occurs once there, with one value, and is no variable.
#[test]
fn letters_that_look_alike_are_told_apart() {
    let form = crate::ClosedForm::of(
        &robot(
            "parameters: {d2: 0.7, m_1: 3, m1: 2, c111: 1, c211: 0.6, M11: 0.25, h1: 0.3, theta1: 0.2, tau1: 0.11, g: 4}
convention: standard
gravity: [0, -9.81, 0]
joints:
  - {type: revolute, dh: {theta: 0, d: 0, a: d2, alpha: pi/2},
     link: {mass: 7, com: [-c211, M11, c111], inertia: {yy: h1, zz: theta1}, physical: false}}
  - {type: prismatic, dh: {theta: 0.3, d: 0.4, a: tau1, alpha: 0},
     link: {mass: m1, com: [-g, 0.1, m_1], inertia: {yy: 1, zz: 1}}}",
        ),
        2,
    );
    let text = form.text();
    // d2' is the parameter, d2 the variable of the prismatic joint; m1 and m_1 are parameters next to the mass m1 of
    // the table
    for part in ["d2' = 0.7", "m1 = 2", "c211' = 0.6", "h1' = 0.3", "g = 4", "m1'' = 7 kg", "g' = 9.81 m/s²"] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    assert!(text.contains("h1 = 2 c112 θ̇1 ḋ2") && !text.contains("d2² + d2²"), "{text}");
    let latex = form.latex("letters", crate::LatexStyle::Article);
    let values: Vec<&str> = latex.lines().filter_map(|line| line.strip_prefix('$')?.strip_suffix("$%")).collect();
    let letters: Vec<&str> = values.iter().flat_map(|value| value.split(" = ")).collect();
    assert!(values.len() >= 8, "{values:?}");
    for letter in letters.iter().filter(|letter| letter.starts_with(|c: char| c.is_alphabetic() || c == '\\')) {
        assert_eq!(letters.iter().filter(|other| other == &letter).count(), 1, "{letter} in {values:?}");
        assert!(![r"\theta_{1}", r"\tau_{1}", "M_{11}", "c_{211}", "h_{1}"].contains(letter), "{letter}");
    }
}

/// A parameter may be both a mass and a length: all terms have it, with different exponents.
#[test]
fn a_mass_may_be_a_length_too() {
    let form = crate::ClosedForm::of(
        &robot(
            "parameters: {k: 0.4, l: 1.3}
convention: standard
gravity: [9.81, 0, 0]
joints:
  - {type: revolute, dh: {theta: 0, d: -0.87, a: 0.5, alpha: deg(60)},
     link: {mass: k, com: [-k/2, l, 0.15], inertia: {xx: 0.02, yy: 0.2, zz: 0.4}, physical: false}}",
        ),
        1,
    );
    assert_eq!(form.is_lagranges(), Some(true));
    // calculated by hand: com at x = 0.5 - k/2 along the link, g along x
    let tau = form.torques(&[std::f64::consts::FRAC_PI_2], &[0.0], &[0.0]).expect("a closed form");
    assert!((tau[0] - 0.4 * 9.81 * (0.5 - 0.2)).abs() < 1e-12, "{tau:?}");
}
