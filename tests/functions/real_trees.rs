//! Real robots with branches, their bases held: functions beside Pinocchio, and operations of the reduced form.
//!
//! Six robot files and their golden files are by `trees/from_urdf.py`; both programs got the same snapped numbers. The
//! others are by `tests/reference/trees.py`: `rne import --whole` made the robot file, and Pinocchio read the URDF.

use rne_codegen::{Compiler, Form, Function};
use rne_model::{GoldenFile, Robot};

use crate::arm::{Arm, Given, Maker};
use crate::check::{ROOT, Worst, conditioning, error_on_scale, json, numbers, wrench};
use crate::trees::robot;

const TOLERANCE: f64 = 1e-12;
const FOLDER: &str = "tests/functions/trees";

/// Operations of torques: general, without regrouping, as a symbolic generator writes them; after Khalil and
/// Kleinfinger, with base parameters; and by the plan that a build finds without a search. The first two are counted by
/// a rebuilding of SYMORO's form on Khalil's frames.
struct Tree {
    name: &'static str,
    joints: usize,
    general: usize,
    with_base_parameters: usize,
    reduced: usize,
}

const fn tree(name: &'static str, joints: usize, counts: [usize; 3]) -> Tree {
    let [general, with_base_parameters, reduced] = counts;
    Tree { name, joints, general, with_base_parameters, reduced }
}

const TREES: [Tree; 6] = [
    tree("hyq", 12, [900, 792, 616]),
    tree("anymal_c", 12, [1032, 868, 724]),
    tree("solo12", 12, [880, 692, 608]),
    tree("go2", 12, [1004, 840, 640]),
    tree("atlas", 30, [2963, 2698, 2460]),
    tree("g1", 29, [3657, 3122, 2829]),
];

impl Tree {
    fn text(&self, ending: &str) -> String {
        let path = format!("{ROOT}/{FOLDER}/{}.{ending}", self.name);
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
    }

    fn robot(&self) -> Robot {
        let robot = robot(&self.text("yaml"));
        assert_eq!(robot.dof(), self.joints, "{}", self.name);
        robot
    }
}

#[test]
fn torques_of_real_trees_are_those_of_pinocchio() {
    for maker in Maker::ALL {
        let mut worst = Worst::default();
        for tree in TREES {
            let arm = Arm::new(&tree.robot(), maker);
            let golden = GoldenFile::read(tree.name, tree.text("golden.csv").as_bytes(), tree.joints);
            for state in golden.unwrap_or_else(|report| panic!("{report}")).states {
                let found = arm.numbers(Function::InverseDynamics, &Given::of_joints(&state.q, &state.qd, &state.qdd));
                worst.see(tree.name, error_on_scale(&found, &state.tau, 0.0));
            }
        }
        worst.at_most(TOLERANCE, &format!("real trees, {maker}"));
    }
}

/// The golden files of `tests/reference/trees.py`: names of the robots.
fn imported() -> Vec<String> {
    let folder = format!("{ROOT}/{FOLDER}");
    let files = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{folder}: {error}"));
    let names = files.filter_map(|file| {
        let name = file.expect("a file").file_name().into_string().expect("UTF-8");
        name.strip_suffix(".golden.json").map(str::to_owned)
    });
    names.collect()
}

#[test]
fn functions_of_imported_trees_are_those_of_pinocchio() {
    let names = imported();
    assert!(names.len() + TREES.len() >= 20, "{names:?}");
    // a program of the reduced form of many joints takes long to compile
    let most = if shipped::is_exhaustive() { usize::MAX } else { 8 };
    for maker in Maker::ALL {
        let mut worst = Worst::default();
        for name in &names {
            let golden = json(&format!("{FOLDER}/{name}.golden.json"));
            let file = format!("{ROOT}/{FOLDER}/{name}.yaml");
            let robot = robot(&std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{file}: {error}")));
            if maker != Maker::Runtime && robot.dof() > most {
                continue;
            }
            let array = |key: &str| numbers(&golden[key]);
            let (q, qd, qdd, tau) = (array("q"), array("qd"), array("qdd"), array("tau"));
            let wrench = wrench(array("wrench").try_into().expect("six numbers"));
            let given = Given { tau: &tau, wrench, ..Given::of_joints(&q, &qd, &qdd) };
            let arm = Arm::by_no_choice(&robot, maker);
            let torque = array("inverse_dynamics_with_wrench").iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
            let of_mass = conditioning(&arm.runtime.mass_matrix(&q).expect("one per joint")).expect("bodies");
            let functions = Function::OF_TREES.into_iter().filter(|function| golden.get(function.name()).is_some());
            for function in functions {
                let scale = match function {
                    _ if function.returns_torques() => torque,
                    Function::InverseDynamicsDerivatives | Function::WrenchTorques => torque,
                    Function::PotentialEnergy | Function::JacobianRateTimesVelocity => 1.0,
                    _ => 0.0,
                };
                let magnification = if function.inverts_mass() { of_mass.number } else { 1.0 };
                let found = arm.numbers(function, &given);
                let error = error_on_scale(&found, &array(function.name()), scale) / magnification;
                assert!(error <= TOLERANCE, "{maker}, {name}, {function}: {error:e}");
                worst.see(function.name(), error);
            }
        }
        worst.at_most(TOLERANCE, &format!("imported trees, {maker}"));
        assert_eq!(worst.len(), 14);
    }
}

#[test]
fn the_reduced_form_of_real_trees_takes_fewer_operations_than_any_published() {
    for tree in TREES {
        let robot = tree.robot();
        let program = Compiler::new(&robot).compile(Function::InverseDynamics, Form::Reduced).expect("a program");
        assert_eq!(program.operations().total(), tree.reduced, "{}", tree.name);
        assert!(tree.reduced < tree.with_base_parameters && tree.with_base_parameters < tree.general, "{}", tree.name);
    }
}

/// Elements of one triangle of the mass matrix that are not zero: those of two joints of which one moves the other.
#[test]
fn only_elements_along_branches_are_computed() {
    for (tree, elements) in TREES.into_iter().zip([24, 24, 24, 24, 150, 146]) {
        let robot = tree.robot();
        let moves = |joint: usize, other: usize| {
            std::iter::successors(Some(other), |&link| robot.parent(link)).any(|link| link == joint)
        };
        let dof = tree.joints;
        let of_branches = (0..dof).flat_map(|row| (row..dof).map(move |column| (row, column)));
        assert_eq!(of_branches.filter(|&(row, column)| moves(row, column)).count(), elements, "{}", tree.name);
        let matrix = Arm::new(&robot, Maker::Code(Form::Reduced)).mass_matrix(&vec![0.3; dof]);
        for (row, elements) in matrix.iter().enumerate() {
            for (column, element) in elements.iter().enumerate() {
                let is_of_branch = moves(row, column) || moves(column, row);
                assert_eq!(*element == 0.0, !is_of_branch, "{}: {row}, {column}: {element}", tree.name);
            }
        }
    }
}
