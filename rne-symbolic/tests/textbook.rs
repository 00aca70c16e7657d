//! The arms of lectures and textbooks: their formulas as those print them.

use rne_model::Robot;
use rne_symbolic::{ClosedForm, read};

fn form(text: &str) -> ClosedForm {
    let text = format!("format: 1\nname: arm\nsource: a test\nconvention: standard\n{text}\n");
    let robot = read("arm.yaml", text.as_bytes()).unwrap_or_else(|report| panic!("{report}"));
    ClosedForm::of(&robot, usize::MAX)
}

fn shipped(name: &str) -> Robot {
    read(name, rne_robots::find(name).expect("it is shipped").yaml.as_bytes()).expect("it is valid")
}

fn rod(index: &str) -> String {
    format!(
        "\n  - {{type: revolute, dh: {{theta: 0, d: 0, a: a{index}, alpha: 0}}, link: {{mass: m{index}, com: \
         [-a{index}/2, 0, 0], inertia: {{yy: m{index}*a{index}^2/12, zz: m{index}*a{index}^2/12}}}}}}"
    )
}

/// Specification 5.1; the lecture has X down.
#[test]
fn one_link_as_the_lecture_prints_it() {
    let form = form(&format!("parameters: {{m: 2.5, a: 0.8, g: 9.81}}\ngravity: [g, 0, 0]\njoints:{}", rod("")));
    assert_eq!(form.torque(0).as_deref(), Some("(1/3) m a² θ̈1 + (1/2) m g a sin θ1"));
    assert!(form.text().contains("\n  τ1 = (1/3) m a² θ̈1 + (1/2) m g a sin θ1\n"), "{}", form.text());
    assert_eq!(form.mass(0, 0).as_deref(), Some("(1/3) m a²"));
    assert_eq!(form.christoffel(0, 0, 0).as_deref(), Some("0"));
    assert_eq!(form.gravity(0).as_deref(), Some("(1/2) m g a sin θ1"));
    let tau = form.torques(&[0.6], &[1.3], &[-0.7]).expect("a closed form");
    assert!((tau[0] - 5.165_809_330_671_963_5).abs() < 1e-14);
    assert_eq!(form.is_lagranges(), Some(true));
}

/// Specification 5.2.
#[test]
fn two_links_as_textbooks_print_them() {
    let parameters = "parameters: {m1: 2.5, a1: 0.8, m2: 1.5, a2: 0.6, gx: 9.81, gy: 1.5}\ngravity: [gx, gy, 0]";
    let form = form(&format!("{parameters}\njoints:{}{}", rod("1"), rod("2")));
    for (found, expected) in [
        (form.mass(0, 0), "(1/3) m1 a1² + m2 (a1² + (1/3) a2² + a1 a2 cos θ2)"),
        (form.mass(0, 1), "m2 ((1/3) a2² + (1/2) a1 a2 cos θ2)"),
        (form.mass(1, 1), "(1/3) m2 a2²"),
        (form.christoffel(0, 0, 1), "-(1/2) m2 a1 a2 sin θ2"),
        (form.christoffel(0, 1, 1), "-(1/2) m2 a1 a2 sin θ2"),
        (form.christoffel(1, 0, 0), "(1/2) m2 a1 a2 sin θ2"),
        (form.christoffel(1, 0, 1), "0"),
        (form.gravity(1), "(1/2) m2 a2 (gx sin(θ1+θ2) - gy cos(θ1+θ2))"),
    ] {
        assert_eq!(found.as_deref(), Some(expected));
    }
    // h and γ of joint 1, typed from the specification
    let (q, qd, qdd) = ([0.6, -1.1_f64], [1.3, -0.4], [-0.7, 2.1]);
    let (m1, a1, m2, a2, gx, gy) = (2.5, 0.8, 1.5, 0.6, 9.81, 1.5);
    let (s2, c2, q12) = (q[1].sin(), q[1].cos(), q[0] + q[1]);
    let h = m2 * a1 * a2 * s2;
    let m12 = m2 * (a2 * a2 / 3.0 + a1 * a2 * c2 / 2.0);
    let far = m2 * a2 / 2.0 * (gx * q12.sin() - gy * q12.cos());
    let near = (m1 * a1 / 2.0 + m2 * a1) * (gx * q[0].sin() - gy * q[0].cos());
    let m11 = m1 * a1 * a1 / 3.0 + m2 * (a1 * a1 + a2 * a2 / 3.0 + a1 * a2 * c2);
    let expected = [
        m11 * qdd[0] + m12 * qdd[1] - h * (qd[0] * qd[1] + qd[1] * qd[1] / 2.0) + near + far,
        m12 * qdd[0] + m2 * a2 * a2 / 3.0 * qdd[1] + h * qd[0] * qd[0] / 2.0 + far,
    ];
    let tau = form.torques(&q, &qd, &qdd).expect("a closed form");
    assert!((tau[0] - expected[0]).abs() < 1e-13 && (tau[1] - expected[1]).abs() < 1e-13, "{tau:?} {expected:?}");
}

/// Specification 5.3 and 5.4: the slide on a turning joint, the turning joint on a slide.
#[test]
fn slides_as_textbooks_print_them() {
    let turning = "{type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: pi/2}, link: {mass: m1, com: [0, 0, l], inertia: \
                   {yy: I1}, physical: false}}";
    let slide = "{type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: m2, inertia: {yy: I2}, physical: \
                 false}}";
    let parameters = "parameters: {m1: 2.5, m2: 1.5, l: 0.3, I1: 0.12, I2: 0.05, g: 9.81}";
    let rp = form(&format!("{parameters}\ngravity: [0, -g, 0]\njoints:\n  - {turning}\n  - {slide}"));
    for (found, expected) in [
        (rp.mass(0, 0), "m1 l² + m2 d2² + I1 + I2"),
        (rp.mass(0, 1), "0"),
        (rp.mass(1, 1), "m2"),
        (rp.christoffel(0, 0, 1), "m2 d2"),
        (rp.christoffel(1, 0, 0), "-m2 d2"),
        (rp.gravity(0), "g (m1 l + m2 d2) sin θ1"),
        (rp.gravity(1), "-m2 g cos θ1"),
    ] {
        assert_eq!(found.as_deref(), Some(expected));
    }
    let tau = rp.torques(&[0.6, 0.9], &[1.3, -0.4], &[-0.7, 2.1]).expect("a closed form");
    assert!((tau[0] - 9.101_199_594_411_123_4).abs() < 1e-13 && (tau[1] + 11.276_313_573_395_916).abs() < 1e-13);
    let pr = form(
        "parameters: {m1: 2.5, m2: 1.5, l: 0.3, I2: 0.05, g: 9.81}\ngravity: [0, 0, -g]\njoints:\n  - {type: prismatic, \
         dh: {theta: 0, d: 0, a: 0, alpha: pi/2}, link: {mass: m1}}\n  - {type: revolute, dh: {theta: 0, d: 0, a: 2*l, \
         alpha: 0}, link: {mass: m2, com: [-l, 0, 0], inertia: {zz: I2}, physical: false}}",
    );
    for (found, expected) in [
        (pr.mass(0, 0), "m1 + m2"),
        (pr.mass(0, 1), "m2 l cos θ2"),
        (pr.mass(1, 1), "m2 l² + I2"),
        (pr.christoffel(0, 1, 1), "-m2 l sin θ2"),
        (pr.gravity(0), "g (m1 + m2)"),
        (pr.gravity(1), "m2 g l cos θ2"),
    ] {
        assert_eq!(found.as_deref(), Some(expected));
    }
}
