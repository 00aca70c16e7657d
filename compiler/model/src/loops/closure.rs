//! The equations of closed loops as numbers: how far positions of the joints are from closing the loops, and the
//! Jacobian of the equations.

mod search;

use std::ops::Range;

use crate::loops::matrix::Matrix;
use crate::parts::pose::{Pose, axis_on_link, cross, difference, dot, link_behind_axis, own_joints};
use crate::{ClosedLoop, Convention, Cut, Joint, JointKind};

/// The joints and the two places of a closed loop.
struct Ways {
    cut: Cut,
    /// The placement of both places, each in the frame of its link.
    places: [Pose; 2],
    /// The joints that move one place and not the other, base first.
    joints: [Vec<usize>; 2],
    /// The rotation from the axes of the loop to the last link that carries both places.
    start: Pose,
}

/// The equations of all closed loops of a robot, as functions of the joints that move a loop and follow no other joint.
pub(crate) struct Equations<'a> {
    joints: &'a [Joint],
    convention: Convention,
    ways: Vec<Ways>,
    /// The joints that move a loop and follow no other joint.
    pub(crate) variables: Vec<usize>,
    /// The largest sum of lengths along a loop, m, which lengths are compared with.
    pub(crate) size: f64,
}

/// A loop at some positions of its joints.
struct State {
    /// Both places, in the axes of the loop.
    places: [Pose; 2],
    /// For each joint of the loop: its index, the place (0 or 1) that it moves, and the frame at its axis.
    axes: Vec<(usize, usize, Pose)>,
}

impl<'a> Equations<'a> {
    pub(crate) fn new(joints: &'a [Joint], convention: Convention, loops: &[ClosedLoop]) -> Self {
        let ways: Vec<Ways> = loops.iter().map(|closed| Ways::new(joints, convention, closed)).collect();
        let variables = sorted(loops.iter().flat_map(|closed| moving(joints, closed)).collect());
        let size = ways.iter().map(|ways| ways.size(joints)).fold(0.0, f64::max);
        Self { joints, convention, ways, variables, size: if size > 0.0 { size } else { 1.0 } }
    }

    /// Returns the rows of the equations of a loop.
    pub(crate) fn rows_of(&self, index: usize) -> Range<usize> {
        let first = self.ways[..index].iter().map(|ways| ways.cut.equations()).sum();
        first..first + self.ways[index].cut.equations()
    }

    /// Returns all rows of the equations, each with the factor that makes the row free of units.
    pub(crate) fn rows(&self) -> Vec<(usize, f64)> {
        let of_loop = |index: usize| {
            let rows = self.rows_of(index);
            rows.clone().map(move |row| (row, if row < rows.start + 3 { 1.0 / self.size } else { 1.0 }))
        };
        (0..self.ways.len()).flat_map(of_loop).collect()
    }

    /// Returns all columns of the variables, each with the factor that makes the column free of units.
    pub(crate) fn columns(&self) -> Vec<(usize, f64)> {
        self.variables.iter().map(|&joint| self.unit(joint)).enumerate().collect()
    }

    fn unit(&self, joint: usize) -> f64 {
        match self.joints[joint].row.kind {
            JointKind::Revolute => 1.0,
            JointKind::Prismatic => self.size,
        }
    }

    /// Returns the Jacobian of the equations at positions of all joints: rows are equations in the order of [`Cut`],
    /// columns are variables, elements are in m or 1 per rad or m. Rows of p₂ - p₁ are in the axes of the loop; a
    /// product a·b of an axis of the first place and one of the second has the derivative (b × a)·(ω₂ - ω₁).
    pub(crate) fn jacobian(&self, positions: &[f64]) -> Matrix {
        let rows = self.ways.iter().map(|ways| ways.cut.equations()).sum();
        let mut jacobian = Matrix::zero(rows, self.variables.len());
        for (index, ways) in self.ways.iter().enumerate() {
            let (start, state) = (self.rows_of(index).start, self.state(ways, positions));
            let turns = ways.cut.perpendicular().iter().map(|&[a, b]| {
                let [a, b] = [state.places[0].axis(a), state.places[1].axis(b)];
                cross(b, a)
            });
            let turns: Vec<[f64; 3]> = turns.collect();
            for (joint, place, axis) in &state.axes {
                let (velocity, rotation) = self.motion(*joint, *place, axis, &state.places[*place]);
                let along = turns.iter().map(|turn| dot(*turn, rotation));
                self.enter(&mut jacobian, start, *joint, |_| 1.0, velocity.into_iter().chain(along));
            }
        }
        jacobian
    }

    /// Returns the velocity of p₂ - p₁ and ω₂ - ω₁ while a joint moves one of the two places at unit speed.
    fn motion(&self, joint: usize, place: usize, axis: &Pose, moved: &Pose) -> ([f64; 3], [f64; 3]) {
        let z = axis.axis(2).map(|z| if place == 0 { -z } else { z });
        match self.joints[joint].row.kind {
            JointKind::Revolute => (cross(z, difference(moved.translation, axis.translation)), z),
            JointKind::Prismatic => (z, [0.0; 3]),
        }
    }

    /// Adds the column of a joint to the matrix; the column of a follower is added to those of the variables that it
    /// follows.
    fn enter(
        &self,
        matrix: &mut Matrix,
        start: usize,
        joint: usize,
        unit: impl Fn(usize) -> f64,
        column: impl Iterator<Item = f64>,
    ) {
        let own = [(joint, 1.0)];
        let of = self.joints[joint].coupling.as_ref().map_or(&own[..], |coupling| &coupling.follows);
        for (row, value) in column.enumerate() {
            for (variable, ratio) in of {
                if let Ok(at) = self.variables.binary_search(variable) {
                    matrix.add(start + row, at, ratio * unit(*variable) * value);
                }
            }
        }
    }

    /// Returns residuals that are zero where the loops are closed, and their derivatives, all free of units: the
    /// distances of the places, and the differences of axes that must be equal. Differences are used because products
    /// of axes are also zero for opposite axes.
    fn open(&self, positions: &[f64]) -> (Vec<f64>, Matrix) {
        let equations: usize = self.ways.iter().map(|ways| 3 + ways.cut.differences()).sum();
        let mut derivatives = Matrix::zero(equations, self.variables.len());
        let mut residual = Vec::with_capacity(equations);
        for ways in &self.ways {
            let (start, state) = (residual.len(), self.state(ways, positions));
            let [one, other] = &state.places;
            residual.extend(difference(other.translation, one.translation).map(|length| length / self.size));
            let equal = ways.cut.equal();
            residual.extend(equal.iter().flat_map(|&axis| difference(other.axis(axis), one.axis(axis))));
            if ways.cut == Cut::Universal {
                residual.push(dot(one.axis(0), other.axis(1)));
            }
            for (joint, place, axis) in &state.axes {
                let (velocity, rotation) = self.motion(*joint, *place, axis, &state.places[*place]);
                let turned = equal.iter().flat_map(|&axis| cross(rotation, state.places[*place].axis(axis)));
                let product = (ways.cut == Cut::Universal).then(|| dot(cross(other.axis(1), one.axis(0)), rotation));
                let column = velocity.into_iter().map(|v| v / self.size).chain(turned).chain(product);
                // each column gets the unit of the leader, because that is the variable, also where a follower moves
                // the place
                self.enter(&mut derivatives, start, *joint, |leader| self.unit(leader), column);
            }
        }
        (residual, derivatives)
    }

    fn state(&self, ways: &Ways, positions: &[f64]) -> State {
        let mut axes = Vec::new();
        let places = [0, 1].map(|place| {
            let mut link = ways.start;
            for &joint in &ways.joints[place] {
                let axis = link.then(&axis_on_link(self.joints, self.convention, joint));
                link = axis.then(&link_behind_axis(self.joints, self.convention, joint, positions[joint]));
                axes.push((joint, place, axis));
            }
            link.then(&ways.places[place])
        });
        State { places, axes }
    }

    /// Returns the distance between the two places of a loop, m, and the largest angle by which axes miss their
    /// required direction, rad.
    pub(crate) fn apart(&self, index: usize, positions: &[f64]) -> [f64; 2] {
        let ways = &self.ways[index];
        let [one, other] = self.state(ways, positions).places;
        let length = |v: [f64; 3]| libm::hypot(libm::hypot(v[0], v[1]), v[2]);
        let angle = |axis: &usize| {
            let [a, b] = [one.axis(*axis), other.axis(*axis)];
            libm::atan2(length(cross(a, b)), dot(a, b))
        };
        let turned = match ways.cut {
            Cut::Universal => libm::asin(dot(one.axis(0), other.axis(1)).clamp(-1.0, 1.0)).abs(),
            cut => cut.equal().iter().map(angle).fold(0.0, f64::max),
        };
        [length(difference(other.translation, one.translation)), turned]
    }

    /// Returns the loop whose places are farthest apart, comparing lengths as parts of the loops' size with angles in
    /// rad; and how far apart they are, m and rad.
    pub(crate) fn farthest(&self, positions: &[f64]) -> (usize, [f64; 2]) {
        let off = |index: &usize| {
            let [length, angle] = self.apart(*index, positions);
            (length / self.size).max(angle)
        };
        let index = (0..self.ways.len()).max_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0);
        (index, self.apart(index, positions))
    }

    /// Computes the positions of the joints that follow others.
    fn complete(&self, positions: &mut [f64]) {
        for (joint, of) in self.joints.iter().enumerate() {
            if let Some(coupling) = &of.coupling {
                let sum: f64 = coupling.follows.iter().map(|(leader, ratio)| ratio * positions[*leader]).sum();
                positions[joint] = sum + coupling.offset;
            }
        }
    }
}

/// Returns the joints that move one place of a loop relative to the other and follow no other joint, in the order of
/// the joints.
pub(crate) fn moving(joints: &[Joint], closed: &ClosedLoop) -> Vec<usize> {
    let of_joint = |joint: usize| match &joints[joint].coupling {
        Some(coupling) => coupling.follows.iter().map(|(leader, _)| *leader).collect(),
        None => vec![joint],
    };
    sorted(own_joints(joints, &closed.between).into_iter().flatten().flat_map(of_joint).collect())
}

/// Sorts the joints and removes repetitions.
pub(crate) fn sorted(mut joints: Vec<usize>) -> Vec<usize> {
    joints.sort_unstable();
    joints.dedup();
    joints
}

impl Ways {
    fn new(joints: &[Joint], convention: Convention, closed: &ClosedLoop) -> Self {
        let ways = own_joints(joints, &closed.between);
        let first = ways.iter().flatten().next();
        let start = first.map_or(Pose::IDENTITY, |&joint| axis_on_link(joints, convention, joint).turned_back());
        Self { cut: closed.cut, places: closed.between.map(|end| Pose::of(&end.placement)), joints: ways, start }
    }

    /// Returns the sum of the lengths along the loop, m.
    fn size(&self, joints: &[Joint]) -> f64 {
        let sum = |lengths: [f64; 3]| lengths.iter().map(|it| it.abs()).sum::<f64>();
        let of_joint = |&joint: &usize| {
            let Joint { row, branch, .. } = &joints[joint];
            row.dh.a.abs() + row.dh.d.abs() + branch.map_or(0.0, |branch| sum(branch.placement.xyz))
        };
        let of_joints: f64 = self.joints.iter().flatten().map(of_joint).sum();
        of_joints + self.places.iter().map(|place| sum(place.translation)).sum::<f64>()
    }
}

impl Cut {
    /// Returns the axes (0 to 2 for x to z) that must be equal at both places.
    const fn equal(self) -> &'static [usize] {
        match self {
            Self::Revolute => &[2],
            Self::Spherical | Self::Universal => &[],
            Self::Weld => &[0, 1, 2],
        }
    }

    /// Returns how many residuals the directions of the axes have.
    const fn differences(self) -> usize {
        match self {
            Self::Universal => 1,
            cut => 3 * cut.equal().len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Angle, FixedFrame, Reader, Robot, Transform};

    /// Makes a robot with two branches, sliding joints and a follower, and a loop between the ends of the branches.
    fn robot(convention: &str, cut: Cut) -> Robot {
        let text = format!(
            "{{format: 2, name: x, source: own, convention: {convention}, gravity: [0, 0, 0], tool: {{on: c}}, joints: [
            {{name: root, type: revolute, dh: {{theta: 0.2, d: 0.3, a: 0.1, alpha: 0.4}}}},
            {{name: a, type: revolute, dh: {{theta: 0.3, d: 0.1, a: 0.2, alpha: 1}}}},
            {{name: b, type: prismatic, dh: {{theta: 0.5, d: 0.2, a: 0.1, alpha: -0.7}}}},
            {{name: c, type: revolute, dh: {{theta: 0, d: 0.1, a: 0.3, alpha: 0.2}}}},
            {{name: d, parent: root, at: {{xyz: [0.1, 0.2, 0.3], rpy: [1, 2, 3]}}, type: revolute,
             dh: {{theta: 1, d: 0, a: 0.2, alpha: 0.1}}}},
            {{name: e, type: revolute, dh: {{theta: 0, d: 0.1, a: 0.1, alpha: 0.5}}}},
            {{name: f, type: prismatic, dh: {{theta: 0, d: 0, a: 0, alpha: 0.3}}}}],
            couplings: [{{joint: e, follows: {{a: 0.5, d: -2}}, offset: 0.1}}]}}"
        );
        let read = Reader::new("x").trees().couplings().read(&text);
        let mut robot = read.unwrap_or_else(|report| panic!("{report}")).robot;
        let place = |on: usize, xyz: [f64; 3], rpy: [f64; 3]| FixedFrame {
            on: Some(on),
            placement: Transform { xyz, rpy: rpy.map(Angle::new) },
        };
        let between = [place(3, [0.1, 0.0, 0.2], [0.1, 0.2, 0.3]), place(6, [0.0; 3], [1.0, 0.0, 2.0])];
        let name = "loop1".to_owned();
        robot.closed.loops = vec![ClosedLoop { name, cut, between, dependent: Vec::new() }];
        robot
    }

    /// Evaluates the equations as the documentation of closed loops defines them.
    fn defined(equations: &Equations<'_>, cut: Cut, positions: &[f64]) -> Vec<f64> {
        let [one, other] = equations.state(&equations.ways[0], positions).places;
        let products = cut.perpendicular().iter().map(|&[a, b]| dot(one.axis(a), other.axis(b)));
        difference(other.translation, one.translation).into_iter().chain(products).collect()
    }

    /// Compares both Jacobians with finite differences, at positions where the loop is open.
    #[test]
    fn jacobians_are_the_derivatives_of_the_equations() {
        const STEP: f64 = 1e-6;
        for (convention, cut) in ["standard", "modified"].into_iter().flat_map(|it| Cut::ALL.map(|cut| (it, cut))) {
            let robot = robot(convention, cut);
            let equations = Equations::new(&robot.joints, robot.convention, &robot.closed.loops);
            assert_eq!(equations.variables, [1, 2, 3, 4, 6], "the root moves both places");
            let mut positions = vec![0.3, -0.4, 0.2, 0.7, 0.1, 0.0, 0.3];
            equations.complete(&mut positions);
            let (found, (_, of_open)) = (equations.jacobian(&positions), equations.open(&positions));
            for (column, &joint) in equations.variables.iter().enumerate() {
                let [before, after] = [-STEP, STEP].map(|step| {
                    let mut moved = positions.clone();
                    moved[joint] += step;
                    equations.complete(&mut moved);
                    (defined(&equations, cut, &moved), equations.open(&moved).0)
                });
                let slope = |row: usize, of: [&[f64]; 2]| (of[1][row] - of[0][row]) / (2.0 * STEP);
                for row in 0..cut.equations() {
                    let off = found.get(row, column) - slope(row, [&before.0, &after.0]);
                    assert!(off.abs() < 1e-9, "{convention} {cut:?} {row} {joint}: {off}");
                }
                for row in 0..before.1.len() {
                    let off = of_open.get(row, column) - equations.unit(joint) * slope(row, [&before.1, &after.1]);
                    assert!(off.abs() < 1e-9, "{convention} {cut:?} {row} {joint}: {off}");
                }
            }
        }
    }

    /// The axes of the loop are fixed to the link that carries the first joint: for a modified row after Rx(alpha)
    /// Tx(a), whatever the position of the joint is.
    #[test]
    fn positions_are_in_the_axes_of_the_loop() {
        let robot = robot("modified", Cut::Spherical);
        let equations = Equations::new(&robot.joints, robot.convention, &robot.closed.loops);
        let positions = [0.3, -0.4, 0.2, 0.7, 0.1, 0.0, 0.3];
        let state = equations.state(&equations.ways[0], &positions);
        let (joint, place, axis) = &state.axes[0];
        assert_eq!((*joint, *place), (1, 0));
        for i in 0..3 {
            let unit = [0, 1, 2].map(|j| if i == j { 1.0 } else { 0.0 });
            let off = difference(axis.axis(i), unit);
            assert!(off.iter().all(|it: &f64| it.abs() < 1e-15), "{axis:?}");
        }
    }
}
