//! Converts a chain to the rows of a Denavit-Hartenberg table.
//!
//! z of every frame is the positive axis of its joint, so q, its sign and its limits stay the same. Where the axes
//! leave a choice, the table becomes as short as possible:
//!
//! - parallel axes: the common normal begins where the one before it ended, so that d is zero;
//! - two axes on one line: a = 0, x stays, the origin is that of the next joint;
//! - x points so that |theta| ≤ pi/2; at exactly ±pi/2 so that a > 0, or if a = 0, so that theta > 0;
//! - frame 0: its origin is on the first axis, nearest to the origin of the base, and its x is that of the base;
//! - the last frame: its origin is that of the last joint, and its x that of the last link.
//!
//! Both conventions use the same common normals: a standard frame is at the far end of one, a modified frame at the
//! near end of the next.

use rne_model::{Angle, Convention, Dh, Double};

use crate::chain::Chain;
use crate::geometry::{Pose, Rotation, Vector, atan2, rounded, twelfths_of_pi};
use crate::snap::of_twelfths;

/// A length below this is taken for a rounding error of an `f64`, m.
const NOTHING: f64 = 1e-15;
/// An angle between axes below this is taken for a rounding error of an `f64`, rad.
const ROUNDING: f64 = 1e-15;
/// A distance that no arm has, m: it shows that two axes are nearly parallel.
pub(crate) const FAR: f64 = 100.0;

/// Sine of the angle between two axes below which they are nearly parallel, so that lengths in the table become large.
pub(crate) const NEARLY_PARALLEL: f64 = 0.05;

/// The rows of a table and the resulting frames.
pub(crate) struct Table {
    /// Placement of frame 0 in the frame of the base.
    pub(crate) start: Pose,
    pub(crate) rows: Vec<Dh>,
    /// γ and b of each row, by which the row begins in the link frame of its parent; both are zero except in a tree.
    pub(crate) branches: Vec<[f64; 2]>,
    /// For each moved link, placement of frame i of the table in the link's own frame; both are fixed to the link.
    pub(crate) frames: Vec<Pose>,
    /// Placement of the tip in the link frame of the link that carries it.
    pub(crate) tool: Pose,
    /// Pairs of axes, counted from 1, that are taken as parallel, each with the angle between them, rad. The number
    /// after that of the last joint means the z axis of the base.
    pub(crate) levelled: Vec<([usize; 2], f64)>,
}

/// The common normal of the axes of two neighbouring joints.
struct Normal {
    /// The point on the first axis at which the normal begins.
    from: Vector,
    /// The point on the second axis at which the normal ends.
    to: Vector,
    /// The direction of the normal, of length 1.
    x: Vector,
}

/// The joint axes at q = 0, in the frame of the base.
struct Axes {
    /// The frames of the moved links.
    links: Vec<Pose>,
    points: Vec<Vector>,
    directions: Vec<Vector>,
}

/// Computes the table of a chain.
pub(crate) fn table(chain: &Chain, convention: Convention) -> Table {
    let mut axes = Axes::of(chain);
    let n = axes.points.len();
    let first = axes.directions[0];
    // The point on the first axis that is nearest to the origin of the base.
    let origin = axes.points[0].across(first);
    let x = perpendicular(first, [0, 1, 2].map(Vector::unit));
    let mut levelled = Vec::new();
    let mut normals: Vec<Normal> = Vec::new();
    for k in 0..n.saturating_sub(1) {
        let (origin, x) = normals.last().map_or((origin, x), |normal| (normal.to, normal.x));
        normals.push(axes.normal((k, k + 1), origin, x, &mut levelled));
    }
    let last = axes.directions[n - 1];
    let last_x = perpendicular(last, axes.links[n - 1].rotation.columns);

    let mut rows = Vec::with_capacity(n);
    let mut frames = Vec::with_capacity(n);
    for k in 0..n {
        let before = k.checked_sub(1).map(|before| &normals[before]);
        let (o, x) = before.map_or((origin, x), |normal| (normal.to, normal.x));
        let z = axes.directions[k];
        let (next_from, next_x) = normals.get(k).map_or((axes.points[k], last_x), |normal| (normal.from, normal.x));
        let theta = canonical(atan2(z.dot(x.cross(next_x)), x.dot(next_x)));
        let d = length((next_from - o).dot(z), next_from, o);
        let (a, alpha) = match convention {
            Convention::Standard => axes.twist((k, k + 1), normals.get(k)),
            Convention::Modified => {
                k.checked_sub(1).map_or((0.0, 0.0), |before| axes.twist((before, k), normals.get(before)))
            }
        };
        rows.push(Dh { theta: Angle::new(theta), d, a, alpha: Angle::new(alpha) });
        let frame = match (convention, normals.get(k)) {
            (_, None) => Pose { rotation: Rotation::of_axes(last_x, last), translation: axes.points[k] },
            (Convention::Standard, Some(normal)) => {
                Pose { rotation: Rotation::of_axes(normal.x, axes.directions[k + 1]), translation: normal.to }
            }
            (Convention::Modified, Some(normal)) => {
                Pose { rotation: Rotation::of_axes(normal.x, z), translation: normal.from }
            }
        };
        frames.push(axes.links[k].inverse() * frame);
    }
    let start = Pose { rotation: Rotation::of_axes(x, first), translation: origin };
    let tool = frames[n - 1].inverse() * chain.tip;
    Table { start, branches: vec![[0.0; 2]; n], rows, frames, tool, levelled }
}

/// Computes the table of a tree, with modified rows. Frame 0 is the frame of the base, whose z axis is treated like a
/// joint axis. The first joint on a link begins at its link frame, as in a chain; further joints begin at γ and b.
pub(crate) fn tree_table(chain: &Chain) -> Table {
    let mut axes = Axes::of(chain);
    let n = axes.points.len();
    // the z axis of the base is stored after those of the joints
    axes.points.push(Vector::ZERO);
    axes.directions.push(Vector::unit(2));
    let parent = |k: usize| chain.joints[k].parent.unwrap_or(n);
    let mut levelled = Vec::new();
    let mut normals: Vec<Normal> = Vec::with_capacity(n);
    // x axis and origin of each link frame that has been determined
    let mut ends: Vec<Option<(Vector, Vector)>> = vec![None; n];
    ends.push(Some((Vector::unit(0), Vector::ZERO)));
    for k in 0..n {
        let p = parent(k);
        let (x, origin) = ends[p].unwrap_or_else(|| (normals[p].x, normals[p].to));
        let normal = axes.normal((p, k), origin, x, &mut levelled);
        ends[p].get_or_insert((normal.x, normal.from));
        normals.push(normal);
    }
    let end = |k: usize| {
        ends[k].unwrap_or_else(|| (perpendicular(axes.directions[k], axes.links[k].rotation.columns), axes.points[k]))
    };
    let about = |z: Vector, from: Vector, to: Vector| canonical(atan2(z.dot(from.cross(to)), from.dot(to)));
    let (mut rows, mut branches, mut frames) = (Vec::new(), Vec::new(), Vec::new());
    for (k, normal) in normals.iter().enumerate() {
        let (p, z) = (parent(k), axes.directions[k]);
        let ((x, origin), (x_before, origin_before)) = (end(k), end(p));
        let (a, alpha) = axes.twist((p, k), Some(normal));
        let theta = about(z, normal.x, x);
        let d = length((origin - normal.to).dot(z), origin, normal.to);
        rows.push(Dh { theta: Angle::new(theta), d, a, alpha: Angle::new(alpha) });
        let before = axes.directions[p];
        let b = length((normal.from - origin_before).dot(before), normal.from, origin_before);
        branches.push([about(before, x_before, normal.x), b]);
        let frame = Pose { rotation: Rotation::of_axes(x, z), translation: origin };
        frames.push(axes.links[k].inverse() * frame);
    }
    let tool = frames[chain.tip_on].inverse() * chain.tip;
    Table { start: Pose::identity(), rows, branches, frames, tool, levelled }
}

impl Axes {
    fn of(chain: &Chain) -> Self {
        let mut axes = Self { links: Vec::new(), points: Vec::new(), directions: Vec::new() };
        for joint in &chain.joints {
            let link = joint.parent.map_or(joint.place, |parent| axes.links[parent] * joint.place);
            axes.links.push(link);
            axes.points.push(link.translation);
            axes.directions.push(link.rotation * joint.axis);
        }
        axes
    }

    /// Computes the common normal from axis `k` to axis `after`; `origin` and `x` are those of the frame before it.
    fn normal(
        &mut self,
        (k, after): (usize, usize),
        origin: Vector,
        x: Vector,
        levelled: &mut Vec<([usize; 2], f64)>,
    ) -> Normal {
        let (z, next) = (self.directions[k], self.directions[after]);
        let cross = z.cross(next);
        let tilt = cross.norm();
        let way = self.points[after] - self.points[k];
        let skew = (tilt.to_f64() > ROUNDING).then(|| {
            // The nearest points of two skew lines, by Cramer's rule.
            let square = tilt * tilt;
            let along = way.cross(next).dot(cross) / square;
            let along_next = way.cross(z).dot(cross) / square;
            (self.points[k] + z * along, self.points[after] + next * along_next)
        });
        // If the nearest points are so far away that their rounding errors exceed the effect of the tilt over a metre,
        // the axes are taken as parallel.
        let skew = skew.filter(|(from, to)| {
            let far = (*from - self.points[k]).norm().to_f64().max((*to - self.points[after]).norm().to_f64());
            let is_lost = tilt.to_f64() < f64::EPSILON * far;
            if is_lost {
                levelled.push(([k + 1, after + 1], tilt.to_f64()));
            }
            !is_lost
        });
        if let Some((from, to)) = skew {
            let normal = cross * (Double::new(1.0) / tilt);
            let length = to - from;
            let leads = length.norm().to_f64() > NOTHING;
            let normal = if leads && length.dot(normal).to_f64() < 0.0 { -normal } else { normal };
            return Normal { from, to, x: facing(x, z, normal, leads) };
        }
        // Makes both directions equal to the last bit.
        self.directions[after] = if z.dot(next).to_f64() < 0.0 { -z } else { z };
        let across = way.across(z);
        if across.norm().to_f64() <= NOTHING {
            let point = self.points[after] - (self.points[after] - self.points[k]).across(z);
            return Normal { from: point, to: point, x };
        }
        // The normal begins at `origin`, unless a nearly parallel pair before it has moved that far away.
        let from = if (origin - self.points[k]).norm().to_f64() > FAR { self.points[k] } else { origin };
        let distance = (self.points[after] - from).across(z);
        let direction = distance.direction().unwrap_or(x);
        Normal { from, to: from + distance, x: facing(x, z, direction, true) }
    }

    /// Returns a and alpha from axis `k` to axis `after`; both are zero for the last joint.
    fn twist(&self, (k, after): (usize, usize), normal: Option<&Normal>) -> (f64, f64) {
        let Some(Normal { from, to, x }) = normal else { return (0.0, 0.0) };
        let (z, next) = (self.directions[k], self.directions[after]);
        let alpha = canonical(atan2(x.dot(z.cross(next)), z.dot(next)));
        (length((*to - *from).dot(*x), *to, *from), alpha)
    }
}

/// Returns the normal `x` or its opposite, so that the angle from `before` to it about `z` is at most a right angle. At
/// exactly a right angle, `x` stays if it `leads` to the next axis, because then a > 0; else it is chosen so that theta
/// is positive.
fn facing(before: Vector, z: Vector, x: Vector, leads: bool) -> Vector {
    const RIGHT: f64 = 1e-20;
    let (sin, cos) = (z.dot(before.cross(x)).to_f64(), before.dot(x).to_f64());
    if cos < -RIGHT || (cos <= RIGHT && !leads && sin < 0.0) { -x } else { x }
}

/// Returns a unit vector perpendicular to `z`: the first of `hints` that is nearly perpendicular, else the most
/// perpendicular one, each without its part along `z`.
fn perpendicular(z: Vector, hints: [Vector; 3]) -> Vector {
    let tilt = |hint: &Vector| hint.dot(z).to_f64().abs();
    let near = hints.iter().find(|hint| tilt(hint) < 0.5);
    let hint = near.copied().unwrap_or_else(|| {
        let mut sorted = hints;
        sorted.sort_by(|a, b| tilt(a).total_cmp(&tilt(b)));
        sorted[0]
    });
    hint.across(z).direction().unwrap_or_else(|| Vector::unit(0))
}

/// Returns a distance between two points, rounded once; a value that is only a rounding error becomes zero.
fn length(value: Double, from: Vector, to: Vector) -> f64 {
    let scale = from.to_f64().into_iter().chain(to.to_f64()).map(f64::abs).fold(0.0, f64::max);
    let value = rounded(value, scale);
    if value.abs() < NOTHING { 0.0 } else { value }
}

/// Returns an angle as a person would write it: -pi becomes pi, and a multiple of pi/12 gets the bits of that
/// expression.
fn canonical(angle: f64) -> f64 {
    let angle = twelfths_of_pi(angle).map_or(angle, of_twelfths);
    if angle == -std::f64::consts::PI { std::f64::consts::PI } else { angle }
}
