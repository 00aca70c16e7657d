#![deny(warnings)]
// Inside a function, inside a macro, two in one module, in YAML that stands here, from a re-export.

mod arms {
    use rne::InverseDynamics;

    #[derive(InverseDynamics)]
    #[robot(path = "../robots/rod.yaml", form = "seven_steps", max_ops = 100)]
    pub struct Rod;

    #[derive(InverseDynamics)]
    #[robot(path = "../robots/two.yaml")]
    #[robot(max_ops = 1_000)]
    pub(crate) struct Two {}
}

mod dynamics {
    pub mod library {
        pub use rne::*;
    }
}

macro_rules! arm {
    ($(#[$attribute:meta])* $name:ident, $path:literal) => {
        $(#[$attribute])*
        #[derive(dynamics::library::InverseDynamics)]
        #[robot(path = $path, crate = crate::dynamics::library)]
        pub(crate) struct $name;
    };
}

arm!(
    /// An arm from a macro.
    FromMacro, "../robots/rod.yaml"
);

#[derive(dynamics::library::InverseDynamics)]
#[robot(
    crate = "dynamics::library",
    yaml = r#"
    format: 1
    name: inline
    source: "own numbers, `quoted` and <b>bold</b>, see [nothing](nowhere)"
    convention: standard
    gravity: [0, 0, -9.81]
    joints:
      - type: prismatic
        dh: {theta: 0, d: 0, a: 0, alpha: 0}
        link: {mass: 2}
"#
)]
struct Inline;

fn main() {
    use rne::InverseDynamics;

    #[derive(InverseDynamics)]
    #[robot(path = "../robots/rod.yaml")]
    struct Local;

    let local = Local.gravity_torques(&[0.5]);
    assert_eq!(local, arms::Rod.gravity_torques(&[0.5]));
    // One constant is used, the others are not missed.
    assert_eq!(local.len(), FromMacro::DOF);
    assert_eq!(local, FromMacro.gravity_torques(&[0.5]));
    assert_eq!(arms::Two {}.gravity_torques(&[0.5, 0.0]).len(), arms::Two::DOF);
    assert_eq!(Inline.gravity_torques(&[0.5]), [2.0 * 9.81]);
}
