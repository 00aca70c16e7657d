//! Converts a robot file to rows of parameters whose frame i is on joint axis i and fixed to link i.
//!
//! In every convention of the table, row i leads from the frame of its parent to frame i as a modified row does, Rx(α)
//! Tx(a) Rz(θ) Tz(d), and the moments of link i are about the origin of frame i in its axes (the reduced form, section
//! 2). Changes of frames that never cost an operation are made here: the base is turned into the frame of each joint on
//! it, the constant angle of the last joint of a branch is moved into its link, anti-parallel axes are made parallel.
//! If a link carries several joints, its frame is turned about its axis so that the first of them is an ordinary row;
//! the rows of the other joints begin with one more constant rotation Rz(γ) (section 15).

use rne_model::{Convention, FixedFrame, Joint, JointKind, Link, Motor, QuarterTurns, Robot, Row, Transform};

use crate::coordinates::Coordinates;
use crate::ir::{Embedding, ExactAngle, Number};
use crate::reduced::gyrostats::{Carrier, put_rotors};
use crate::reduced::link_parameters::{about_x, about_z, apply, compose, transpose};
use crate::reduced::{Gyrostat, IDENTITY, PseudoInertia, Square, Triple};

/// Frames are too far from the arm if one is farther from it than this factor times the longest distance within the
/// arm: second moments then lose more than two digits.
const FAR: f64 = 10.0;

/// Returns, for each joint, the distance along its axis from the table's origin to a point near the arm; `None` if the
/// frames of the table are near the arm. Any point of the axis can be the origin. The common normal of nearly parallel
/// axes, where a table has it, may be hundreds of metres away.
pub(crate) fn near_origins(robot: &Robot) -> Option<Vec<f64>> {
    // without nearly parallel axes all frames are near the arm, and the search below is not needed
    let is_tilted = |joint: &Joint| joint.row.dh.alpha.right.is_none() && joint.row.dh.alpha.sin.abs() < 1.0 / FAR;
    if !robot.joints.iter().any(is_tilted) {
        return None;
    }
    let written = JointFrames::as_written(robot, false, Embedding::default())?;
    let (_, farthest, reach) = written.near(0.0);
    // with finer steps, numbers that should be zero would be nonzero from rounding
    (farthest > FAR * reach && farthest.is_finite()).then(|| written.near(reach / 64.0).0)
}

/// One joint and the link that it moves.
#[derive(Clone, Debug)]
pub(crate) struct JointFrame {
    /// The link that carries the joint, counted from 0; `None` for the base.
    pub(crate) parent: Option<usize>,
    pub(crate) kind: JointKind,
    /// Whether q, q̇, q̈ and τ have the opposite sign of the robot file's.
    pub(crate) reversed: bool,
    /// Rz(γ), the first rotation of the row, about the axis of the parent.
    pub(crate) gamma: ExactAngle,
    /// Rx(α), the rotation by the twist between both axes.
    pub(crate) alpha: ExactAngle,
    /// Vector from the origin of the parent's frame to axis i, in the axes of the parent.
    pub(crate) offset: Triple,
    /// The constant part of the joint angle.
    pub(crate) theta: ExactAngle,
    /// Offset along axis i, without the joint variable.
    pub(crate) d: Number,
    /// Direction in which a prismatic joint slides, in the axes of its link.
    pub(crate) axis: Triple,
    /// Whether a prismatic link keeps the axes of the revolute link before it, so that its row has no rotation.
    pub(crate) carried: bool,
    pub(crate) matter: PseudoInertia,
    /// The rotors on the link that are not included in its inertial parameters.
    pub(crate) gyrostats: Vec<Gyrostat>,
}

/// The pose of the tip frame in the frame of the link that carries it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tip {
    /// The link that carries the tip, counted from 0.
    pub(crate) on: usize,
    pub(crate) rotation: Square,
    pub(crate) translation: Triple,
}

/// All rows of an arm.
#[derive(Clone, Debug)]
pub(crate) struct JointFrames {
    pub(crate) rows: Vec<JointFrame>,
    pub(crate) coordinates: Coordinates,
    /// Acceleration of gravity in the frame of each joint on the base, at q = 0; zero for the other joints.
    pub(crate) gravity: Vec<Triple>,
    /// Acceleration of gravity on a floating base, in axes of the world.
    pub(crate) gravity_in_world: Triple,
    /// The tip frame, then those of the list `tips`.
    pub(crate) tips: Vec<Tip>,
    /// Constants on the diagonal of M, for each joint: G² Jm of a rotor that belongs to the arm, and the constant part
    /// of the rotors of the list `motors`.
    pub(crate) rotors: Vec<Number>,
    /// Constants above the diagonal of M: row, column and value.
    pub(crate) coupled: Vec<(usize, usize, Number)>,
    /// How the decimal numbers of the file were converted to exact numbers.
    pub(crate) embedding: Embedding,
    /// Sines and cosines of the constant angles of the file, as absolute values.
    pub(crate) known: Vec<Number>,
    /// A floating base: its moments are about the origin of frame 0 and in its axes.
    pub(crate) base: Option<Carrier>,
}

/// Choices of frames that change the rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) struct FrameChoice {
    /// The last frame of each branch is turned about its axis so that h_y of its link vanishes (section 5.8).
    pub(crate) turned_last: bool,
    /// Prismatic links keep the axes of the last revolute link (section 5.9).
    pub(crate) carried: bool,
    /// The base is floating: it is a link, whose axes are those of frame 0 (section 17). The function, not the plan,
    /// decides this.
    pub(crate) floating: bool,
}

impl JointFrame {
    /// Returns Rz(γ) Rx(α), the rotation from the axes of the joint at rest to those of its parent.
    pub(crate) fn twist(&self) -> Square {
        let twist = about_x(self.alpha);
        if self.gamma == ExactAngle::NONE { twist } else { compose(&about_z(self.gamma), &twist) }
    }

    /// Turns the link in its frame: every point r becomes R r.
    fn turn_link(&mut self, rotation: &Square) {
        self.matter = self.matter.turned(rotation);
        self.gyrostats.iter_mut().for_each(|gyrostat| gyrostat.axis = apply(rotation, gyrostat.axis));
    }

    /// Returns the vector of length d along the joint axis, in the axes of the parent.
    pub(crate) fn along_axis(&self, d: Number) -> Triple {
        let along = [Number::ZERO, -(d * self.alpha.sin), d * self.alpha.cos];
        if self.gamma == ExactAngle::NONE { along } else { apply(&about_z(self.gamma), along) }
    }

    /// Returns Rz(γ) Rx(α) Rz(θ).
    pub(crate) fn rotation(&self) -> Square {
        compose(&self.twist(), &about_z(self.theta))
    }
}

impl JointFrame {
    /// Returns the row of a joint that begins at a placement in the link frame of its parent. `None` if a square root
    /// that the axes of the placement need does not exist in exact arithmetic.
    fn beginning_at(self, placement: &Transform, convention: Convention, embedding: Embedding) -> Option<Self> {
        let (rotation, translation) = pose(placement, embedding);
        let twist = about_x(self.alpha);
        let along_x = |x: Number| [x, Number::ZERO, Number::ZERO];
        let plus = |a: Triple, b: Triple| [0, 1, 2].map(|i| a[i] + b[i]);
        let [a, ..] = self.offset;
        let is_about_z = placement.rpy[..2].iter().all(|angle| embedding.turn(angle) == ExactAngle::NONE);
        let about_axis = embedding.turn(&placement.rpy[2]);
        let turns = placement.rpy.iter().map(|angle| embedding.turn(angle)).chain([self.alpha]);
        let known: Vec<_> = turns.flat_map(|turn| [turn.sin.abs(), turn.cos.abs()]).collect();
        let (offset, all) = match convention {
            Convention::Modified => (plus(translation, apply(&rotation, along_x(a))), compose(&rotation, &twist)),
            Convention::Standard => (plus(along_x(a), apply(&twist, translation)), compose(&twist, &rotation)),
        };
        let [gamma, alpha, before] = match (is_about_z, convention) {
            (true, Convention::Modified) => [about_axis, self.alpha, ExactAngle::NONE],
            (true, Convention::Standard) => [ExactAngle::NONE, self.alpha, about_axis],
            (false, _) => decomposed(&all, embedding, &known)?,
        };
        Some(Self { gamma, alpha, offset, theta: before.then(self.theta), ..self })
    }
}

impl JointFrames {
    /// Returns the rows of a robot; `None` if a choice of frames does not apply to it, or if none of the tried
    /// conversions of its numbers to exact numbers works: all square roots must exist, and a number that is zero as a
    /// float must be zero exactly.
    pub(crate) fn new(robot: &Robot, frames: FrameChoice) -> Option<Self> {
        if frames == (FrameChoice { floating: frames.floating, ..FrameChoice::default() })
            && let Some(joint_frames) = Self::read(robot, frames, Embedding::default())
        {
            return Some(joint_frames);
        }
        // if the choice does not apply to the robot, no conversion of the numbers helps, so none is tried
        let kinds: Vec<_> = robot.rows().map(|row| row.kind).collect();
        let can_carry = kinds.windows(2).any(|pair| pair == [JointKind::Revolute, JointKind::Prismatic]);
        let can_turn = kinds.last() == Some(&JointKind::Revolute);
        if (frames.carried && !can_carry) || (frames.turned_last && !can_turn) {
            return None;
        }
        // a needed square root exists in about every fourth conversion
        let Link { com, first_moment, .. } = robot.rows().last()?.link;
        let unknowns = [com[0], com[1], first_moment[0], first_moment[1]].map(|x| Some(x.abs()));
        let unknowns = [None].into_iter().chain(unknowns);
        let usable = unknowns.filter(|unknown| unknown.is_none_or(|x| (4.0 * x).fract() != 0.0));
        usable
            .flat_map(|unknown| (0..48).map(move |seed| Embedding { seed, unknown }))
            .find_map(|embedding| Self::read(robot, frames, embedding).filter(Self::agrees))
    }

    /// Returns the link that carries a joint, counted from 0. For a floating base it is the number of links, for a
    /// fixed base `None`.
    pub(crate) fn carrier(&self, index: usize) -> Option<usize> {
        self.rows[index].parent.or_else(|| self.base.as_ref().map(|_| self.rows.len()))
    }

    /// Returns a copy of the rows with zero gravity.
    pub(crate) fn without_gravity(&self) -> Self {
        Self { gravity: vec![Triple::default(); self.rows.len()], gravity_in_world: Triple::default(), ..self.clone() }
    }

    /// Whether no number is zero only as a float but not exactly.
    fn agrees(&self) -> bool {
        let length = |row: &JointFrame| row.offset.map(|x| x.to_f64().abs()).iter().sum::<f64>() + row.d.to_f64().abs();
        let reach: f64 = self.rows.iter().map(length).sum();
        self.rows.iter().all(|row| {
            let PseudoInertia { mass, h, s } = row.matter;
            let largest =
                |numbers: &[Number], least: f64| numbers.iter().map(|x| x.to_f64().abs()).fold(least, f64::max);
            let first = largest(&h, mass.to_f64().abs() * reach);
            let second = largest(s.as_flattened(), mass.to_f64().abs() * reach * reach);
            let turns = [row.gamma, row.alpha, row.theta].map(|turn| [turn.sin, turn.cos]);
            let is_clear = |numbers: &[Number], scale: f64| !numbers.iter().any(|x| x.is_dust(scale));
            is_clear(&row.offset, reach)
                && is_clear(&[row.d], reach)
                && is_clear(&h, first)
                && is_clear(s.as_flattened(), second)
                && is_clear(turns.as_flattened(), 1.0)
                && is_clear(&row.axis, 1.0)
        })
    }

    fn read(robot: &Robot, frames: FrameChoice, embedding: Embedding) -> Option<Self> {
        let mut joint_frames = Self::as_written(robot, frames.floating, embedding)?;
        if let Some(near) = near_origins(robot) {
            joint_frames.move_origins(&near);
        }
        joint_frames.straighten();
        joint_frames.turn_carriers();
        if !frames.floating {
            joint_frames.normalise_first();
        }
        if frames.carried && !joint_frames.carry_prismatics() {
            return None;
        }
        if !frames.turned_last {
            joint_frames.normalise_last();
        } else if !joint_frames.turn_last() {
            return None;
        }
        Some(joint_frames)
    }

    /// Returns the rows as the file has them; `None` if a square root that the axes of a branch need does not exist.
    fn as_written(robot: &Robot, floating: bool, embedding: Embedding) -> Option<Self> {
        let decimal = |x: f64| embedding.decimal(x);
        let half = decimal(0.5);
        let none = (ExactAngle::NONE, Number::ZERO);
        let written = |row: &Row| (embedding.turn(&row.dh.alpha), decimal(row.dh.a));
        // in a standard table, the twist and length of the parent's row come before the joint
        let before = |index: usize| match robot.convention {
            Convention::Modified => written(&robot.joints[index].row),
            Convention::Standard => robot.parent(index).map_or(none, |parent| written(&robot.joints[parent].row)),
        };
        let mut rows = Vec::with_capacity(robot.joints.len());
        for (index, joint) in robot.joints.iter().enumerate() {
            let row = &joint.row_with_offset();
            let (alpha, a) = before(index);
            let com = row.link.com.map(decimal);
            let body = PseudoInertia::of_body(decimal(row.link.mass), com, embedding.inertia(joint), half);
            let body = if row.link.has_first_moment() {
                body.with_first_moment(row.link.first_moment.map(decimal), com)
            } else {
                body
            };
            let matter = match robot.convention {
                Convention::Modified => body,
                Convention::Standard => {
                    let (own_alpha, own_a) = written(row);
                    body.turned(&about_x(own_alpha)).moved([own_a, Number::ZERO, Number::ZERO])
                }
            };
            let row = JointFrame {
                parent: robot.parent(index),
                kind: row.kind,
                reversed: false,
                gamma: ExactAngle::NONE,
                alpha,
                offset: [a, Number::ZERO, Number::ZERO],
                theta: embedding.turn(&row.dh.theta),
                d: decimal(row.dh.d),
                axis: IDENTITY[2],
                carried: false,
                matter,
                gyrostats: Vec::new(),
            };
            rows.push(match joint.branch {
                Some(branch) => row.beginning_at(&branch.placement, robot.convention, embedding)?,
                None => row,
            });
        }
        let placed = |frame: &FixedFrame| {
            let (rotation, translation) = pose(&frame.placement, embedding);
            let tip = Tip { on: frame.on?, rotation, translation };
            if robot.convention != Convention::Standard {
                return Some(tip);
            }
            // in a standard table, twist and length of the row lead from the joint's frame to the link frame
            let (alpha, a) = written(&robot.joints[tip.on].row);
            let turn = about_x(alpha);
            let [x, y, z] = apply(&turn, tip.translation);
            Some(Tip { rotation: compose(&turn, &tip.rotation), translation: [x + a, y, z], ..tip })
        };
        let named = robot.tips.iter().map(|&tip| &robot.frames[tip].fixed);
        let tips = [&robot.tip()].into_iter().chain(named).map(placed).collect::<Option<Vec<_>>>()?;
        let of_tip = written(&robot.joints[tips[0].on].row).0;
        let turns = rows.iter().flat_map(|row: &JointFrame| [row.alpha, row.theta]).chain([of_tip]);
        let known = turns.flat_map(|turn| [turn.sin.abs(), turn.cos.abs()]).collect();
        let rotor = |motor: Motor| decimal(motor.gear_ratio) * decimal(motor.gear_ratio) * decimal(motor.inertia);
        let of_arm = |joint: &Joint| joint.motor.filter(|_| robot.rotors).map(rotor).unwrap_or_default();
        let mut rotors: Vec<Number> = robot.joints.iter().map(of_arm).collect();
        let mut base = floating.then(|| Carrier { matter: matter_of_base(robot, embedding), gyrostats: Vec::new() });
        let coupled = put_rotors(robot, embedding, (&mut rows, base.as_mut()), &mut rotors)?;
        let gravity_in_world = robot.gravity.map(decimal);
        let of_base = |row: &JointFrame| if row.parent.is_none() { gravity_in_world } else { Triple::default() };
        let gravity = rows.iter().map(of_base).collect();
        let coordinates = Coordinates::of(robot);
        Some(Self { rows, coordinates, gravity, gravity_in_world, tips, rotors, coupled, embedding, known, base })
    }

    /// Moves the origin of each frame along its axis, by the distance in `near` from the origin that the row has.
    fn move_origins(&mut self, near: &[f64]) {
        // offsets from the new origins to the origins of the table
        let near: Vec<Number> = near.iter().map(|&along| self.embedding.decimal(along)).collect();
        let ends: Vec<Number> = self.rows.iter().zip(&near).map(|(row, &along)| row.d - along).collect();
        let along_z = |z: Number, [x, y, before]: Triple| [x, y, before + z];
        for (index, row) in self.rows.iter_mut().enumerate() {
            let offset = row.parent.map_or(row.offset, |parent| along_z(ends[parent], row.offset));
            let moved = row.along_axis(near[index]);
            row.offset = [0, 1, 2].map(|axis| offset[axis] + moved[axis]);
            row.d = Number::ZERO;
            row.matter = row.matter.moved([Number::ZERO, Number::ZERO, ends[index]]);
        }
        for tip in &mut self.tips {
            tip.translation = along_z(ends[tip.on], tip.translation);
        }
    }

    /// Returns the distance along each axis to a point near the arm. For a joint on a link it is the foot of the
    /// perpendicular from the point of the link's own joint, for a joint on the base that from the origin of frame 0.
    /// Distances are multiples of `step`, unless `step` is 0. Also returns the largest distance of these points from
    /// the table's origins, and the longest distance within the arm.
    fn near(&self, step: f64) -> (Vec<f64>, f64, f64) {
        let raised = |v: Triple, by: f64| [v[0].to_f64(), v[1].to_f64(), v[2].to_f64() + by];
        let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let norm = |v: [f64; 3]| dot(v, v).sqrt();
        let (mut near, mut farthest, mut reach) = (Vec::new(), 0.0_f64, 0.0_f64);
        // offsets from the points near the arm to the origins of the table
        let mut ends: Vec<f64> = Vec::new();
        for row in &self.rows {
            let point = raised(row.offset, row.parent.map_or(0.0, |parent| ends[parent]));
            let axis = raised(row.along_axis(Number::ONE), 0.0);
            let along = -dot(point, axis);
            let along = if step == 0.0 { along } else { (along / step).round() * step };
            let (mass, end) = (row.matter.mass.to_f64(), row.d.to_f64() - along);
            farthest = farthest.max(along.abs()).max(end.abs());
            reach = reach.max(norm([0, 1, 2].map(|i| point[i] + along * axis[i])));
            if mass != 0.0 {
                reach = reach.max(norm(raised(row.matter.h, mass * end)) / mass.abs());
            }
            near.push(along);
            ends.push(end);
        }
        reach = self.tips.iter().map(|tip| norm(raised(tip.translation, ends[tip.on]))).fold(reach, f64::max);
        (near, farthest, reach)
    }

    /// Replaces α = ±π by 0: from there on all rotations have the opposite sign, until the next such row.
    fn straighten(&mut self) {
        let flip = about_x(ExactAngle { sin: Number::ZERO, cos: -Number::ONE });
        let is_floating = self.base.is_some();
        for index in 0..self.rows.len() {
            let parent = self.rows[index].parent.map(|parent| self.rows[parent].reversed);
            let row = &mut self.rows[index];
            row.reversed = parent == Some(true);
            if row.reversed {
                row.offset = apply(&flip, row.offset);
                row.gamma = row.gamma.back();
            }
            if (parent.is_some() || is_floating) && row.alpha.quarters() == Some(QuarterTurns::Two) {
                row.alpha = ExactAngle::NONE;
                row.reversed = !row.reversed;
            }
            if row.reversed {
                row.theta = row.theta.back();
                row.d = -row.d;
                row.turn_link(&flip);
            }
            if row.alpha == ExactAngle::NONE && row.gamma != ExactAngle::NONE {
                // both rotations are about one axis, so their angles add
                row.theta = row.gamma.then(row.theta);
                row.gamma = ExactAngle::NONE;
            }
        }
        let is_reversed: Vec<bool> = self.rows.iter().map(|row| row.reversed).collect();
        self.turn_tips(|on| is_reversed[on], &flip);
    }

    /// Turns the frame of each link about its axis, so that the first row on it needs no rotation Rz(γ).
    fn turn_carriers(&mut self) {
        for index in 0..self.rows.len() {
            let Some(first) = self.rows.iter().position(|row| row.parent == Some(index)) else { continue };
            let gamma = self.rows[first].gamma;
            if gamma == ExactAngle::NONE {
                continue;
            }
            let back = about_z(gamma.back());
            let row = &mut self.rows[index];
            row.theta = row.theta.then(gamma);
            row.turn_link(&back);
            for carried in self.rows.iter_mut().filter(|row| row.parent == Some(index)) {
                carried.offset = apply(&back, carried.offset);
                if carried.alpha == ExactAngle::NONE {
                    carried.theta = gamma.back().then(carried.theta);
                } else {
                    carried.gamma = gamma.back().then(carried.gamma);
                }
            }
            self.rows[first].gamma = ExactAngle::NONE;
            self.turn_tips(|on| on == index, &back);
        }
    }

    /// Turns the base into the frame of each joint on it at q = 0. The position of a fixed base changes no torque.
    fn normalise_first(&mut self) {
        for (row, gravity) in self.rows.iter_mut().zip(&mut self.gravity).filter(|(row, _)| row.parent.is_none()) {
            *gravity = apply(&transpose(&row.rotation()), *gravity);
            (row.gamma, row.alpha, row.theta) = (ExactAngle::NONE, ExactAngle::NONE, ExactAngle::NONE);
            (row.offset, row.d) = ([Number::ZERO; 3], Number::ZERO);
        }
    }

    /// Returns the links that carry no joint, counted from 0.
    fn ends(&self) -> Vec<usize> {
        let carries = |index: usize| self.rows.iter().any(|row| row.parent == Some(index));
        (0..self.rows.len()).filter(|&index| !carries(index)).collect()
    }

    /// Moves the constant angle of the last joint of each branch into its link, if the joint is revolute.
    fn normalise_last(&mut self) {
        for end in self.ends() {
            self.normalise_end(end);
        }
    }

    fn normalise_end(&mut self, end: usize) {
        let last = &mut self.rows[end];
        if last.kind == JointKind::Revolute && last.theta.quarters() != Some(QuarterTurns::Zero) {
            let rotation = about_z(last.theta);
            last.theta = ExactAngle::NONE;
            last.turn_link(&rotation);
            self.turn_tips(|on| on == end, &rotation);
        }
    }

    /// Turns the poses of the tips on links for which `is_turned` is true, because the frames of these links were
    /// turned.
    fn turn_tips(&mut self, is_turned: impl Fn(usize) -> bool, rotation: &Square) {
        for tip in self.tips.iter_mut().filter(|tip| is_turned(tip.on)) {
            tip.rotation = compose(rotation, &tip.rotation);
            tip.translation = apply(rotation, tip.translation);
        }
    }

    /// Returns the tip frame.
    pub(crate) fn tip(&self) -> &Tip {
        &self.tips[0]
    }

    /// Turns the last frame of each branch by φ = atan2(h_y, h_x), so that h_y vanishes. Returns false if that changes
    /// nothing at any branch, or if a square root is missing.
    fn turn_last(&mut self) -> bool {
        let mut gains = false;
        for end in self.ends() {
            match self.turn_end(end) {
                Some(true) => gains = true,
                Some(false) => self.normalise_end(end),
                None => return false,
            }
        }
        gains
    }

    /// Turns the frame of one last link. Returns whether that saves operations; `None` if a square root is missing.
    fn turn_end(&mut self, end: usize) -> Option<bool> {
        let embedding = self.embedding;
        let last = &mut self.rows[end];
        let [x, y, _] = last.matter.h;
        if last.kind != JointKind::Revolute {
            return Some(false);
        }
        if y.is_zero() {
            // h_y is zero already if the angle of the file is kept
            return Some(last.theta.quarters() != Some(QuarterTurns::Zero));
        }
        let phi = direction(y, x, embedding)?;
        let back = about_z(phi.back());
        last.theta = last.theta.then(phi);
        last.turn_link(&back);
        self.turn_tips(|on| on == end, &back);
        Some(true)
    }

    /// Turns the prismatic links after a revolute link into the axes of that link. At the next revolute joint one
    /// constant rotation Rz(φ1) Rx(α') Rz(φ2) remains: φ2 is added to its angle, φ1 to the angle of the revolute joint
    /// before, whose link it turns. So a prismatic joint needs no rotation at all. Returns false if there is no such
    /// link, or if a square root is missing.
    fn carry_prismatics(&mut self) -> bool {
        // in a branched robot, the links after a link are not consecutive rows, so this is not done
        if self.rows.iter().enumerate().any(|(index, row)| row.parent != index.checked_sub(1)) {
            return false;
        }
        let kinds: Vec<_> = self.rows.iter().map(|row| row.kind).collect();
        let origin_shifts = |at: usize| kinds.get(at) == Some(&JointKind::Prismatic);
        let mut carriers = (0..kinds.len()).filter(|&at| !origin_shifts(at) && origin_shifts(at + 1)).peekable();
        let end = |first: usize| (first + 1..kinds.len()).find(|&at| !origin_shifts(at)).unwrap_or(kinds.len());
        carriers.peek().is_some() && carriers.all(|first| self.carry_behind(first, end(first)))
    }

    /// Does this for the prismatic rows after the revolute row `first`, up to `end`.
    fn carry_behind(&mut self, first: usize, end: usize) -> bool {
        // rotation from the axes of each link after `first` to those of the link `first`
        let mut axes = IDENTITY;
        for index in first + 1..end {
            let row = &mut self.rows[index];
            row.offset = apply(&axes, row.offset);
            axes = compose(&axes, &row.rotation());
            row.axis = apply(&axes, IDENTITY[2]);
            row.turn_link(&axes);
            (row.alpha, row.theta, row.carried) = (ExactAngle::NONE, ExactAngle::NONE, true);
            self.turn_tips(|on| on == index, &axes);
        }
        let Some(next) = self.rows.get_mut(end) else { return true };
        next.offset = apply(&axes, next.offset);
        let Some([before, twist, after]) =
            decomposed(&compose(&axes, &about_x(next.alpha)), self.embedding, &self.known)
        else {
            return false;
        };
        next.alpha = twist;
        next.theta = after.then(next.theta);
        let back = about_z(before.back());
        next.offset = apply(&back, next.offset);
        for (index, row) in self.rows[first..end].iter_mut().enumerate() {
            row.turn_link(&back);
            if index > 0 {
                row.offset = apply(&back, row.offset);
                row.axis = apply(&back, row.axis);
            }
        }
        self.rows[first].theta = self.rows[first].theta.then(before);
        self.turn_tips(|on| (first..end).contains(&on), &back);
        true
    }
}

/// Returns the inertial parameters of the base: zero if the robot file has no `floating_base`.
fn matter_of_base(robot: &Robot, embedding: Embedding) -> PseudoInertia {
    let decimal = |x: f64| embedding.decimal(x);
    robot.floating_base.as_ref().map_or_else(PseudoInertia::default, |base| {
        let inertia = base.link.inertia.rows().map(|row| row.map(decimal));
        PseudoInertia::of_body(decimal(base.link.mass), base.link.com.map(decimal), inertia, decimal(0.5))
    })
}

/// Returns φ1, α and φ2 of R = Rz(φ1) Rx(α) Rz(φ2). The sine of α may be one of those `known`.
fn decomposed(rotation: &Square, embedding: Embedding, known: &[Number]) -> Option<[ExactAngle; 3]> {
    let [[xx, _, xz], [yx, _, yz], [zx, zy, zz]] = *rotation;
    if xz.is_zero() && yz.is_zero() {
        // the z axes are parallel, so the two rotations about z are one
        return Some([
            ExactAngle::NONE,
            ExactAngle { sin: Number::ZERO, cos: zz },
            ExactAngle { sin: yx * zz, cos: xx },
        ]);
    }
    let square = xz * xz + yz * yz;
    // the sine is that of an angle of the file, if one matches exactly; otherwise a root is computed
    let known = known.iter().find(|known| known.residue * known.residue == square.residue);
    let sine = match known {
        Some(&known) => known,
        None => hypotenuse(xz, yz, embedding)?,
    };
    let scale = sine.inverse()?;
    Some([
        ExactAngle { sin: xz * scale, cos: -(yz * scale) },
        ExactAngle { sin: sine, cos: zz },
        ExactAngle { sin: zx * scale, cos: zy * scale },
    ])
}

/// Returns the angle whose tangent is y/x.
fn direction(y: Number, x: Number, embedding: Embedding) -> Option<ExactAngle> {
    let scale = hypotenuse(x, y, embedding)?.inverse()?;
    Some(ExactAngle { sin: y * scale, cos: x * scale })
}

/// Returns √(x² + y²).
fn hypotenuse(x: Number, y: Number, embedding: Embedding) -> Option<Number> {
    // if x or y is zero the root is rational; in the finite fields, `root` could return it with different signs
    match (x.is_zero(), y.is_zero()) {
        (true, _) => Some(y.abs()),
        (_, true) => Some(x.abs()),
        _ => root(x * x + y * y, embedding),
    }
}

/// Returns the positive root. If it is a short decimal, the exact number is that decimal. Any other root is irrational,
/// and either of its two images in the finite field can be used.
fn root(square: Number, embedding: Embedding) -> Option<Number> {
    let decimal = embedding.decimal(square.value.sqrt().to_f64());
    if decimal.residue * decimal.residue == square.residue {
        return Some(decimal);
    }
    square.sqrt()
}

/// Returns R = Rz(yaw) Ry(pitch) Rx(roll) of a placement, and its translation.
fn pose(transform: &Transform, embedding: Embedding) -> (Square, Triple) {
    let [roll, pitch, yaw] = transform.rpy.map(|angle| embedding.turn(&angle));
    let (zero, one) = (Number::ZERO, Number::ONE);
    let about_y = [[pitch.cos, zero, pitch.sin], [zero, one, zero], [-pitch.sin, zero, pitch.cos]];
    let rotation = compose(&compose(&about_z(yaw), &about_y), &about_x(roll));
    (rotation, transform.xyz.map(|x| embedding.decimal(x)))
}
