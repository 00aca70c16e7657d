//! `rne show --symbolic` and `--latex`: the equations of motion in letters.

use crate::call::{ROOT, fails, fine, rne, rne_reading};

#[test]
fn the_lectures_arm() {
    insta::assert_snapshot!(fine(&["show", "robots/planar1.yaml", "--symbolic"]));
}

/// The lecture has gravity along x.
#[test]
fn the_lectures_arm_with_the_lectures_gravity() {
    let text = std::fs::read_to_string(format!("{ROOT}/robots/planar1.yaml")).expect("a robot");
    let called = rne_reading(&["show", "-", "--symbolic"], &text.replace("gravity: [0, -g, 0]", "gravity: [g, 0, 0]"));
    assert!(called.out.contains("\n  τ1 = (1/3) m a² θ̈1 + (1/2) m g a sin θ1\n"), "{called:?}");
}

#[test]
fn two_links() {
    insta::assert_snapshot!(fine(&["show", "planar2", "--symbolic"]));
}

#[test]
fn the_stanford_arm_up_to_its_slide() {
    insta::assert_snapshot!(fine(&["show", "robots/stanford.yaml", "--symbolic", "--first", "3"]));
}

#[test]
fn an_arm_that_no_page_holds() {
    insta::assert_snapshot!(fine(&["show", "robots/puma560.yaml", "--symbolic"]));
}

/// Vectors are bold, a transpose is upright, and a formula in a heading is one.
#[test]
fn the_recursion_in_latex() {
    let latex = fine(&["show", "puma560", "--latex"]);
    let (_, recursion) =
        latex.split_once("\\subsection*{Forward, $i = 1$ to the last, $p = i - 1$; the").expect("a heading");
    let (recursion, _) = recursion.split_once("\\subsection*{Of each link").expect("a heading");
    let bare = recursion.replace("\\boldsymbol\\omega", "");
    assert!(!bare.contains("omega") && !bare.contains("^T") && bare.contains("^{\\mathrm T}"), "{recursion}");
    for letter in ["c", "f", "n", "g", "r", "d"] {
        let bold = format!("\\mathbf {letter}");
        let rest = recursion.replace(&bold, "");
        assert!(recursion.contains(&bold) && !rest.contains(&format!(" {letter}_")), "{letter}: {recursion}");
    }
}

#[test]
fn two_links_in_latex() {
    let latex = fine(&["show", "robots/planar2.yaml", "--latex"]);
    insta::assert_snapshot!(latex);
    assert_eq!(latex, fine(&["show", "robots/planar2.yaml", "--symbolic", "--latex"]), "of the closed form, as LaTeX");
}

/// Equations alone and slides have the equations of the article, and no document around them.
#[test]
fn equations_for_a_document_and_for_slides() {
    let of = |robot: &str, style: &str| fine(&["show", robot, style]);
    let environments = |text: &str| {
        let count = |word: &str| text.matches(&format!("{word}{{align*}}")).count();
        assert_eq!(count("\\begin"), count("\\end"), "{text}");
        count("\\begin")
    };
    for robot in ["planar1", "planar2", "puma560"] {
        let (article, body, slides) = (of(robot, "--latex"), of(robot, "--latex=body"), of(robot, "--latex=beamer"));
        assert_eq!(article, of(robot, "--latex=article"));
        let is_formula = |line: &&str| line.contains("&=") || line.contains("&\\quad");
        let formulas = |text: &str| text.lines().filter(is_formula).map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(formulas(&body), formulas(&article));
        for text in [&body, &slides] {
            assert!(!text.contains("\\documentclass") && !text.contains("{document}"), "{text}");
        }
        // lines break elsewhere, and nothing else differs
        let joined = |text: &str| formulas(text).concat().replace("&\\quad", "").replace([' ', '\\'], "");
        assert_eq!(joined(&slides), joined(&article), "{robot}");
        assert_eq!(slides.matches("\\begin{frame}").count(), slides.matches("\\end{frame}").count());
        assert_eq!((environments(&body), environments(&slides) > 1), (environments(&article), true));
        // what the letters are
        let is_value = |line: &&str| line.starts_with('$') && line.ends_with("$%");
        let values = |text: &str| text.lines().filter(is_value).map(str::to_owned).collect::<Vec<_>>();
        assert!(!values(&article).is_empty() && values(&body) == values(&article), "{body}");
        assert_eq!(values(&slides), values(&article), "{slides}");
    }
    let slides = of("planar2", "--latex=beamer");
    // two torques, M, h, γ and the letters
    assert_eq!(slides.matches("\\begin{frame}").count(), 6, "{slides}");
    assert_eq!(slides.matches("{Torque, $\\tau").count(), 2, "{slides}");
    fails(2, &["show", "planar2", "--latex=word"], &["article", "body", "beamer"]);
}

#[test]
fn rotors_belong_to_the_arm_if_asked_for() {
    let text = fine(&["show", "robots/puma560.yaml", "--first", "2", "--rotors"]);
    assert!(text.contains("Jm2 G2²") && text.contains("G2 = 107.815"), "{text}");
    // a direct motor has no gear
    let text = fine(&["show", "robots/stanford.yaml", "--first", "3", "--rotors", "--symbolic"]);
    assert!(text.contains("\n  M33 = m3 + Jm3\n") && !text.contains("G3"), "{text}");
    let recursion = fine(&["show", "robots/puma560.yaml", "--symbolic", "--rotors"]);
    assert!(recursion.contains("The rotor of joint i adds Gi² Jmi q̈i to its torque"), "{recursion}");
}

#[test]
fn what_a_closed_form_has_no_use_for() {
    for other in [["--joint", "1"], ["--step", "2"], ["--function", "mass_matrix"], ["--form", "reduced"]] {
        for form in ["--symbolic", "--latex"] {
            fails(2, &["show", "robots/planar2.yaml", form, other[0], other[1]], &[form, other[0]]);
        }
    }
    for other in ["--equations", "--json", "--base-parameters"] {
        fails(2, &["show", "robots/planar2.yaml", "--symbolic", other], &["--symbolic", other]);
        fails(2, &["show", "robots/planar2.yaml", "--first", "1", other], &["--first", other]);
    }
    fails(2, &["show", "robots/planar2.yaml", "--first", "3"], &["planar2 has 2 joints", "--first takes 1 to 2"]);
    fails(2, &["show", "robots/planar2.yaml", "--first", "0", "--latex"], &["--first takes 1 to 2"]);
    fails(1, &["show", "robots/planar7.yaml", "--symbolic"], &["there is no robot file"]);
}

#[test]
fn the_same_every_time() {
    let call = ["show", "robots/spherical_rrp.yaml", "--symbolic"];
    assert_eq!(fine(&call), fine(&call));
}

/// A parameter that occurs only in a part of a length has its unit; rotors that are left out are told.
#[test]
fn units_and_rotors() {
    let planar = fine(&["show", "planar3", "--symbolic"]);
    assert!(planar.contains("a3 = 0.25 m"), "{planar}");
    for latex in ["--symbolic", "--latex=body"] {
        let with_motors = ["show", "puma560", "--first", "2", latex];
        let left_out = rne(&with_motors);
        assert!(left_out.err.contains("the inertia of the rotors is left out; --rotors adds it"), "{left_out:?}");
        assert_eq!(rne(&[&with_motors[..], &["--rotors"]].concat()).err, "");
        assert_eq!(rne(&["show", "planar2", latex]).err, "");
    }
}
