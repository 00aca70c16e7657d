//! Every shipped robot, derived from its file, and a way to do something with each.

use rne::{Arm, InverseDynamics};

/// A derived robot together with what the tests need to know of it.
pub(crate) trait Shipped<const DOF: usize>: InverseDynamics<DOF> {
    /// The name of its file.
    const NAME: &'static str;
    /// Position limits of its file, infinite where it has none.
    const POSITION_LIMITS: [(f64, f64); DOF];

    /// The same robot at run time.
    fn arm() -> Arm<DOF> {
        let path = format!("{}/robots/{}.yaml", env!("CARGO_MANIFEST_DIR"), Self::NAME);
        Arm::from_file(path).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// What a test does with each robot.
pub(crate) trait Visitor {
    fn visit<const DOF: usize, R: Shipped<DOF>>(&mut self, robot: &R);
}

macro_rules! shipped {
    ($($robot:ident $dof:literal $path:literal)*) => {
        $(
            #[derive(rne::InverseDynamics)]
            #[robot(path = $path)]
            pub(crate) struct $robot;

            impl Shipped<$dof> for $robot {
                const NAME: &'static str = $robot::NAME;
                const POSITION_LIMITS: [(f64, f64); $dof] = $robot::POSITION_LIMITS;
            }
        )*

        /// Shows every shipped robot to a visitor.
        pub(crate) fn visit_all(visitor: &mut impl Visitor) {
            $(visitor.visit(&$robot);)*
        }

        #[test]
        fn all_shipped_robots_are_here() {
            let mut derived = [$($robot::NAME),*].map(|name| format!("{name}.yaml"));
            derived.sort();
            let folder = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/robots")).expect("the folder of robots");
            let names = folder.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
            let mut files: Vec<String> =
                names.filter(|name| name.ends_with(".yaml") && !name.ends_with(".plan.yaml")).collect();
            files.sort();
            assert_eq!(files, derived);
        }
    };
}

shipped! {
    CylindricalRpp 3 "../../robots/cylindrical_rpp.yaml"
    GantryPpp 3 "../../robots/gantry_ppp.yaml"
    Iiwa14 7 "../../robots/iiwa14.yaml"
    Panda 7 "../../robots/panda.yaml"
    Planar1 1 "../../robots/planar1.yaml"
    Planar2 2 "../../robots/planar2.yaml"
    Planar3 3 "../../robots/planar3.yaml"
    Puma560 6 "../../robots/puma560.yaml"
    Puma560Mdh 6 "../../robots/puma560_mdh.yaml"
    ScaraCobra600 4 "../../robots/scara_cobra600.yaml"
    SphericalRrp 3 "../../robots/spherical_rrp.yaml"
    Stanford 6 "../../robots/stanford.yaml"
    Ur5 6 "../../robots/ur5.yaml"
    Ur5e 6 "../../robots/ur5e.yaml"
    Wam7 7 "../../robots/wam7.yaml"
}
