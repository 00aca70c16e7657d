//! Orders in which other tools list the coordinates of a robot. An order gives the coordinate at each index of a list.
//! Coordinates count from 0, in the order of the file.

use rne_model::Robot;

/// Returns the alphabetical order of the names of the joints.
pub(crate) fn by_name(robot: &Robot) -> Vec<usize> {
    let names: Vec<&str> = robot.independent_joints().map(|joint| joint.name.as_str()).collect();
    let mut order: Vec<usize> = (0..names.len()).collect();
    order.sort_by_key(|&coordinate| names[coordinate]);
    order
}

/// Returns the breadth-first order: by the number of joints between a joint and the base.
pub(crate) fn by_level(robot: &Robot) -> Vec<usize> {
    let level = |joint: usize| std::iter::successors(Some(joint), |&joint| robot.parent(joint)).count();
    let levels: Vec<usize> = robot.coordinates().map(level).collect();
    let mut order: Vec<usize> = (0..levels.len()).collect();
    order.sort_by_key(|&coordinate| levels[coordinate]);
    order
}

/// Returns pairs of branches on the same link with equal numbers of coordinates, at least one. Each branch is given by
/// its first joint, counted from 0.
pub(crate) fn equal_branches(robot: &Robot) -> Vec<[usize; 2]> {
    let joints = robot.joints.len();
    let pairs = (0..joints).flat_map(|one| (one + 1..joints).map(move |other| [one, other]));
    let is_pair = |[one, other]: &[usize; 2]| {
        let count = branch(robot, *one).len();
        robot.parent(*one) == robot.parent(*other) && count > 0 && count == branch(robot, *other).len()
    };
    pairs.filter(is_pair).collect()
}

/// Returns the order of the file with two branches exchanged.
pub(crate) fn with_branches_exchanged(robot: &Robot, branches: [usize; 2]) -> Vec<usize> {
    let [one, other] = branches.map(|first| branch(robot, first));
    let mut order: Vec<usize> = (0..robot.dof()).collect();
    one.into_iter().zip(other).for_each(|(a, b)| order.swap(a, b));
    order
}

/// Returns the coordinates of a branch.
fn branch(robot: &Robot, first: usize) -> Vec<usize> {
    let is_in = |joint: usize| std::iter::successors(Some(joint), |&joint| robot.parent(joint)).any(|it| it == first);
    robot.coordinates().enumerate().filter(|(_, joint)| is_in(*joint)).map(|(coordinate, _)| coordinate).collect()
}
