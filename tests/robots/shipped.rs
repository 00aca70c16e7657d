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

/// Calls a macro with a form and the list of all robots.
macro_rules! in_form {
    ($call:ident, $form:literal) => {
        $call! {
            $form
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
    };
}

macro_rules! shipped {
    ($form:literal $($robot:ident $dof:literal $path:literal)*) => {
        use super::{Shipped, Visitor};

        $(
            #[derive(rne::InverseDynamics)]
            #[robot(path = $path, form = $form)]
            pub(crate) struct $robot;

            impl Shipped<$dof> for $robot {
                const NAME: &'static str = $robot::NAME;
                const POSITION_LIMITS: [(f64, f64); $dof] = $robot::POSITION_LIMITS;
            }
        )*

        /// Shows every robot of this form to a visitor.
        pub(crate) fn visit_all(visitor: &mut impl Visitor) {
            $(visitor.visit(&$robot);)*
        }

        /// The names of all of them.
        #[allow(dead_code)] // asked for in one form
        pub(crate) const NAMES: &[&str] = &[$($robot::NAME),*];
    };
}

/// The seven steps of every robot.
pub(crate) mod seven_steps {
    in_form!(shipped, "seven_steps");
}

/// The reduced form of every robot, by its plan file.
pub(crate) mod reduced {
    in_form!(shipped, "reduced");
}

#[test]
fn all_shipped_robots_are_here() {
    let mut derived: Vec<String> = seven_steps::NAMES.iter().map(|name| format!("{name}.yaml")).collect();
    derived.sort();
    let folder = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/robots")).expect("the folder of robots");
    let names = folder.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
    let (mut plans, mut files): (Vec<String>, Vec<String>) =
        names.filter(|name| name.contains(".yaml")).partition(|name| name.contains(".plan."));
    files.sort();
    assert_eq!(files, derived);
    plans.sort();
    let planned: Vec<String> = derived.iter().map(|name| name.replace(".yaml", ".plan.yaml")).collect();
    assert_eq!(plans, planned, "a plan for each");
}
