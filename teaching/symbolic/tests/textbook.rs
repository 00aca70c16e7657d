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
    assert!((tau[0] - 5.165_809_330_671_964).abs() < 1e-14);
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
    assert!((tau[0] - 9.101_199_594_411_123).abs() < 1e-13 && (tau[1] + 11.276_313_573_395_916).abs() < 1e-13);
    let pr = form(
        "parameters: {m1: 2.5, m2: 1.5, l: 0.3, I2: 0.05, g: 9.81}\ngravity: [0, 0, -g]\njoints:\n  - \
         {type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: pi/2}, link: {mass: m1}}\n  - {type: revolute, dh: \
         {theta: 0, d: 0, a: 2*l, alpha: 0}, link: {mass: m2, com: [-l, 0, 0], inertia: {zz: I2}, physical: false}}",
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

/// The Stanford arm up to its slide: R. Paul's and Bejczy's D_ij, in the numbers of the table. The boom is symmetric,
/// so J3_xx is J3_yy.
#[test]
fn the_stanford_arm_up_to_its_slide() {
    let robot = shipped("stanford");
    let form = ClosedForm::of(&robot, 3);
    for (found, expected) in [
        (form.mass(0, 1), "-m3 d2 (d3 + z_C3) cos θ2"),
        (form.mass(0, 2), "-m3 d2 sin θ2"),
        (form.mass(1, 1), "m3 (d3² + 2 z_C3 d3) + J2_yy + J3_xx"),
        (form.mass(1, 2), "0"),
        (form.mass(2, 2), "m3"),
        (form.christoffel(0, 0, 2), "m3 (d3 + z_C3) sin² θ2"),
        (form.christoffel(2, 1, 1), "-m3 (d3 + z_C3)"),
        (form.gravity(0), "0"),
        (form.gravity(1), "-m3 g (d3 + z_C3) sin θ2"),
        (form.gravity(2), "m3 g cos θ2"),
    ] {
        assert_eq!(found.as_deref(), Some(expected));
    }
    let text = form.text();
    for part in ["what joint 4 carries is left away", "J3_xx = J3_yy = 2.51 kg m²", "z_C3 = -0.6447 m"] {
        assert!(text.contains(part), "no `{part}` in {text}");
    }
    assert!(!text.contains("m4"), "{text}");
    // the boom of a turning shoulder, typed: ½ d/dq of M11 = … + (J2_xx + J3_xx + m3 (d3² + 2 z d3)) sin² θ2 + … cos²
    // θ2
    let (q, d2, d3, z, y2) = ([0.3, -0.7_f64, 0.9], 0.154, 0.9, -0.6447, -0.1054);
    let (m2, m3) = (5.01, 4.25);
    let boom = m3 * (d3 * d3 + 2.0 * z * d3);
    let across = boom + 0.108 + 2.51;
    let m11 = 0.255
        + m2 * (d2 * d2 + 2.0 * d2 * y2)
        + m3 * d2 * d2
        + across * q[1].sin().powi(2)
        + 0.106 * q[1].cos().powi(2);
    let tau = form.torques(&q, &[0.0; 3], &[1.0, 0.0, 0.0]).expect("a closed form");
    let tau_of_gravity = form.torques(&q, &[0.0; 3], &[0.0; 3]).expect("a closed form");
    assert!((tau[0] - tau_of_gravity[0] - m11).abs() < 1e-13, "{tau:?} {m11}");
}

#[test]
fn a_parameter_that_an_angle_or_a_root_depends_on_is_a_number() {
    let form = form(
        "parameters: {m: 2, b: 0.4, k: 3, tilt: 0.2, none: 0}\ngravity: [0, -9.81, 0]\njoints:\n  - \
         {type: revolute, dh: {theta: tilt, d: 0, a: 0, alpha: 0}, link: {mass: m, com: [b/k, none, 0], \
         inertia: {zz: sqrt(k)}, physical: false}}",
    );
    assert_eq!(form.mass(0, 0).as_deref(), Some("(1/9) m b² + I1_zz"));
    let text = form.text();
    for part in ["\n    m = 2 kg, b = 0.4 m\n", "I1_zz = 1.7320508075688772 kg m²", "θ1 = q1 + 0.2 rad"] {
        assert!(text.contains(part), "no `{part}` in {text}");
    }
}

#[test]
fn a_table_in_numbers_gets_the_letters_of_textbooks_and_no_letter_has_two_meanings() {
    let form = form(
        "parameters: {a1: 3}\ngravity: [0, 1.5, -9.81]\njoints:\n  - \
         {type: revolute, dh: {theta: 0, d: 0.1, a: 1, alpha: 0.4}, link: {mass: a1, com: [-1/2, 0.1, 0], \
         inertia: {xx: 0.2, yy: 0.2, zz: 0.2}}}",
    );
    assert_eq!(form.mass(0, 0).as_deref(), Some("a1 ((a1' + x_C1)² + y_C1² cos² α1) + I1_xx"));
    let text = form.text();
    for part in ["a1 = 3", "a1' = 1 m", "gy = 1.5 m/s²", "I1_xx = I1_yy = I1_zz = 0.2 kg m²"] {
        assert!(text.contains(part), "no `{part}` in {text}");
    }
}

/// No line is wider than a terminal, whatever the arm.
#[test]
fn lines_fit_on_a_terminal() {
    for file in shipped::tried() {
        let robot = shipped(file.name);
        for joints in [2, robot.dof()] {
            let form = ClosedForm::of(&robot, joints);
            if form.is_closed() {
                assert_eq!(form.is_lagranges(), Some(true), "{} up to joint {joints}", file.name);
            }
            for line in form.text().lines() {
                assert!(unicode_width::UnicodeWidthStr::width(line) <= 80, "{} {joints}: {line}", file.name);
            }
        }
    }
}

/// More joints than anybody writes down: bounded in work, and said.
#[test]
fn what_no_page_holds_is_the_recursion() {
    let form = ClosedForm::of(&shipped("panda"), 7);
    assert!(!form.is_closed() && form.torque(0).is_none() && form.torques(&[0.0; 7], &[0.0; 7], &[0.0; 7]).is_none());
    let text = form.text();
    for part in ["too long to be read", "The arm up to joint", "ω̇i = Riᵀ ω̇p + q̈i e + q̇i ωi × e", "R4 = Rx(π/2) Rz(θ4)"]
    {
        assert!(text.contains(part), "no `{part}` in {text}");
    }
    let joint = "\n  - {type: revolute, dh: {theta: 0.3, d: 0.1, a: 0.2, alpha: 0.4}, link: {mass: 1, com: \
                 [0.1, 0.2, 0.3], inertia: {xx: 0.1, yy: 0.2, zz: 0.25}}}";
    let long = self::form(&format!("gravity: [1, 2, 3]\njoints:{}", joint.repeat(64)));
    assert!(!long.is_closed() && long.text().contains("R64 = Rx(α63) Rz(θ64)"));
    let slide = "\n  - {type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: pi/2}, link: {mass: 1}}";
    let gantry = self::form(&format!("gravity: [1, 2, 3]\njoints:{}", slide.repeat(12)));
    assert!(gantry.is_closed() && gantry.text().contains("M1,3 = M3,1 = "), "{}", gantry.text());
}
