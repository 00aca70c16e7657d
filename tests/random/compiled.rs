//! Forty seeded random robots, compiled by the macro.

use fastrand::Rng;
use rne::{Arm, InverseDynamics, Wrench};

use super::robots;

macro_rules! compiled {
    ($($robot:ident $dof:literal $seed:literal $path:literal)*) => {
        $(
            #[derive(rne::InverseDynamics)]
            #[robot(path = $path, allow_lints)]
            struct $robot;
        )*

        #[test]
        fn compiled_random_robots_equal_the_runtime() {
            $(agree::<$dof>(&$robot, $robot::NAME);)*
        }

        /// The files are the random robots of their seeds. With `RNE_WRITE_RANDOM_ROBOTS` set, they are written anew.
        #[test]
        fn files_are_those_of_their_seeds() {
            $(is_written($path, &robots::yaml($seed, $dof));)*
        }
    };
}

fn path(file: &str) -> String {
    format!("{}/tests/random/{file}", env!("CARGO_MANIFEST_DIR"))
}

fn is_written(file: &str, yaml: &str) {
    if std::env::var_os("RNE_WRITE_RANDOM_ROBOTS").is_some() {
        std::fs::write(path(file), yaml).expect("a writable folder");
    }
    assert_eq!(std::fs::read_to_string(path(file)).expect("a robot file"), yaml, "{file}");
}

fn agree<const DOF: usize>(robot: &impl InverseDynamics<DOF>, name: &str) {
    let seed = name.trim_start_matches("random_");
    let arm: Arm<DOF> = Arm::from_file(path(&format!("files/{seed}.yaml"))).unwrap_or_else(|error| panic!("{error}"));
    let mut rng = Rng::with_seed(seed.parse().expect("a seed"));
    for _ in 0..100 {
        let mut array = |scale: f64| [(); DOF].map(|()| (2.0 * rng.f64() - 1.0) * scale);
        let (q, qd, qdd) = (array(3.0), array(2.0), array(5.0));
        let mut triple = || [(); 3].map(|()| (2.0 * rng.f64() - 1.0) * 10.0);
        let wrench = Wrench { force: triple(), moment: triple() };
        assert_eq!(robot.inverse_dynamics(&q, &qd, &qdd), arm.inverse_dynamics(&q, &qd, &qdd), "{name}");
        assert_eq!(
            robot.inverse_dynamics_with_wrench(&q, &qd, &qdd, &wrench),
            arm.inverse_dynamics_with_wrench(&q, &qd, &qdd, &wrench),
            "{name}"
        );
        assert_eq!(robot.gravity_torques(&q), arm.gravity_torques(&q), "{name}");
        assert_eq!(robot.bias_torques(&q, &qd), arm.bias_torques(&q, &qd), "{name}");
    }
}

compiled! {
    Random00 1 0 "files/0.yaml"
    Random01 2 1 "files/1.yaml"
    Random02 3 2 "files/2.yaml"
    Random03 4 3 "files/3.yaml"
    Random04 5 4 "files/4.yaml"
    Random05 6 5 "files/5.yaml"
    Random06 7 6 "files/6.yaml"
    Random07 2 7 "files/7.yaml"
    Random08 3 8 "files/8.yaml"
    Random09 8 9 "files/9.yaml"
    Random10 1 10 "files/10.yaml"
    Random11 2 11 "files/11.yaml"
    Random12 3 12 "files/12.yaml"
    Random13 4 13 "files/13.yaml"
    Random14 5 14 "files/14.yaml"
    Random15 6 15 "files/15.yaml"
    Random16 7 16 "files/16.yaml"
    Random17 2 17 "files/17.yaml"
    Random18 3 18 "files/18.yaml"
    Random19 8 19 "files/19.yaml"
    Random20 1 20 "files/20.yaml"
    Random21 2 21 "files/21.yaml"
    Random22 3 22 "files/22.yaml"
    Random23 4 23 "files/23.yaml"
    Random24 5 24 "files/24.yaml"
    Random25 6 25 "files/25.yaml"
    Random26 7 26 "files/26.yaml"
    Random27 2 27 "files/27.yaml"
    Random28 3 28 "files/28.yaml"
    Random29 8 29 "files/29.yaml"
    Random30 1 30 "files/30.yaml"
    Random31 2 31 "files/31.yaml"
    Random32 3 32 "files/32.yaml"
    Random33 4 33 "files/33.yaml"
    Random34 5 34 "files/34.yaml"
    Random35 6 35 "files/35.yaml"
    Random36 7 36 "files/36.yaml"
    Random37 2 37 "files/37.yaml"
    Random38 3 38 "files/38.yaml"
    Random39 12 39 "files/39.yaml"
}
