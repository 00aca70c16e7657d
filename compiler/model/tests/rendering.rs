//! Whole messages, as people see them.

use crate::common::{found, with};
use insta::assert_snapshot;

#[test]
fn an_unknown_key() {
    assert_snapshot!(found(&with("source: test", "sorce: test")), @r"
    error: unknown key `sorce`; a robot file has the keys format, name, title, source, notes, parameters, convention, gravity, base, floating_base, tool, frames, joints, couplings, loops, motors, bodies, tips, contacts
     --> robots/x.yaml:3:1
      |
    3 | sorce: test
      | ^^^^^ unknown key
      |
      = help: did you mean `source`?
    ");
}

#[test]
fn a_missing_field_of_a_block() {
    assert_snapshot!(found(&with("    dh: {theta: 0, d: 0.4, a: 0, alpha: pi/2}\n", "")), @r"
    error: a joint lacks the required key `dh`
     --> robots/x.yaml:9:5
      |
    9 |   - name: first
      |     ^^^^ `dh` is missing
      |
      = help: all four numbers of `dh` are required, such as `dh: {theta: 0, d: 0.4, a: 0, alpha: pi/2}`
    ");
}

#[test]
fn a_missing_convention() {
    assert_snapshot!(found(&with("convention: standard\n", "")), @r"
    error: a robot file lacks the required key `convention`
     --> robots/x.yaml:1:1
      |
    1 | format: 1
      | ^^^^^^ `convention` is missing
      |
      = help: write `convention: standard` (Rz(theta) Tz(d) Tx(a) Rx(alpha)) or `convention: modified` (Rx(alpha) Tx(a) Rz(theta) Tz(d)); rne never guesses the convention
    ");
}

#[test]
fn a_mistake_inside_an_expression() {
    assert_snapshot!(found(&with("\"m / 12\"", "\"m / x\"")), @r#"
    error: unknown name `x`
      --> robots/x.yaml:22:40
       |
    22 |     link: {mass: r, inertia: {yy: "m / x", zz: m/12}}
       |                                        ^
       |
       = help: define it under `parameters`, or check the number: a number is a finite decimal such as 0.4 or 2.0e-4, or an expression over numbers, `pi`, parameters, `+ - * / ^`, parentheses and sqrt sin cos tan deg mm g
    "#);
}

#[test]
fn an_impossible_inertia_and_a_lint() {
    let text = with("xx: 0.1", "xx: -0.1").replace("alpha: pi/2", "alpha: 1.5708");
    assert_snapshot!(found(&text), @r"
    error: no body can have this inertia: its smallest principal moment about the centre of mass is -0.1 kg m²; it must be zero or positive
      --> robots/x.yaml:15:16
       |
    15 |       inertia: {xx: -0.1, yy: 0.12, zz: 0.02}
       |                ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ not the inertia of a body
       |
       = help: check the signs and the order of the numbers; a tensor about the origin of the link frame needs `inertia_about: origin`

    warning: the angle `1.5708` is 3.67321e-6 rad off the right angle `pi/2`
      --> robots/x.yaml:11:41
       |
    11 |     dh: {theta: 0, d: 0.4, a: 0, alpha: 1.5708}
       |                                         ^^^^^^ rounded?
       |
       = help: write `pi/2` if you mean this angle: its sine and cosine are exactly 0 and ±1, and the code gets shorter
    ");
}

#[test]
fn an_open_bracket() {
    assert_snapshot!(found(&with("[0, 0, -9.81]", "[0, 0, -9.81")), @r"
    error: this is not YAML: illegal placement of ':' indicator
     --> robots/x.yaml:6:5
      |
    6 | base: {xyz: [0, 0, 1], rpy: [0, 0, pi]}
      |     ^
      |
      = help: check that the `[` in line 5 is closed
    ");
}

#[test]
fn beyond_ascii() {
    assert_snapshot!(found(&with("{m: 1.5, ", "{m: 1.5, größe: 3, ")), @r"
    error: the parameter name `größe` is not an identifier; it must be a letter from a to z or `_`, then letters, digits and `_`
     --> robots/x.yaml:7:22
      |
    7 | parameters: {m: 1.5, größe: 3, r: 2*m}
      |                      ^^^^^
    ");
}

#[test]
fn colours_only_where_asked() {
    let report = found(&with("mass: 2.5", "mass: -1"));
    assert!(!report.render(false).contains('\u{1B}'));
    let styled = report.render(true);
    assert!(styled.contains("\u{1B}[") && styled.contains("negative"));
}

#[test]
fn one_line_per_diagnostic() {
    let text = with("mass: 2.5", "mass: -1").replace("standard", "distal");
    assert_snapshot!(found(&text).short(), @r"
    robots/x.yaml:4:13: error: unknown convention `distal`; it must be `standard` or `modified`
    robots/x.yaml:13:13: error: the mass `-1` is negative; it must be zero or positive
    ");
}
