//! Real robots with branches, their bases held: torques beside Pinocchio, and operations of the reduced form.
//!
//! `trees/from_urdf.py` writes the robot files and the golden files. Both programs get the same snapped numbers.

use rne_codegen::{Compiler, Form, Function};
use rne_model::{GoldenFile, Robot};

use crate::arm::{Arm, Given, Maker};
use crate::check::{Worst, error_on_scale};
use crate::trees::robot;

const TOLERANCE: f64 = 1e-12;

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
    tree("atlas", 30, [2963, 2698, 2476]),
    tree("g1", 29, [3657, 3122, 2840]),
];

impl Tree {
    fn text(&self, ending: &str) -> String {
        let path = format!("{}/tests/functions/trees/{}.{ending}", env!("CARGO_MANIFEST_DIR"), self.name);
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
