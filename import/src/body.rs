//! Bodies described by mass, first moment and second moments about one point, so that two bodies add up.

use std::ops::Add;

use rne_model::{Double, Inertia, Link};

use crate::geometry::{Pose, Vector, decimal, rounded};

/// Mass (kg), first moment (kg m) and inertia (kg m²) about the origin of a frame, in its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Body {
    pub(crate) mass: Double,
    pub(crate) moment: Vector,
    /// The inertia tensor, by rows.
    pub(crate) inertia: [Vector; 3],
}

impl Body {
    pub(crate) const NONE: Self = Self { mass: Double::new(0.0), moment: Vector::ZERO, inertia: [Vector::ZERO; 3] };

    /// Makes a body from its mass and its inertia about the centre of mass, in the axes of the frame `centre` at this
    /// point.
    pub(crate) fn at(mass: f64, centre: Pose, inertia: Inertia) -> Self {
        let own = Self { mass: decimal(mass), inertia: inertia.rows().map(Vector::decimal), ..Self::NONE };
        own.seen_from(centre)
    }

    /// Makes a body from a link of a table.
    pub(crate) fn of_link(link: &Link) -> Self {
        let mass = Self { mass: decimal(link.mass), inertia: link.inertia.rows().map(Vector::decimal), ..Self::NONE };
        let beside = Self { moment: Vector::decimal(link.first_moment), ..mass };
        beside.seen_from(Pose::new(link.com, [0.0; 3]))
    }

    /// Returns whether the body has a first moment without mass, which no physical body and no URDF has.
    pub(crate) fn is_massless_moment(&self) -> bool {
        self.mass.high == 0.0 && self.moment != Vector::ZERO
    }

    /// Converts the body from a frame that is placed at `place` in another frame to this other frame.
    pub(crate) fn seen_from(self, place: Pose) -> Self {
        let (r, t) = (place.rotation, place.translation);
        let turned_columns = self.inertia.map(|row| r * row);
        // R I Rᵀ: the rows of I, rotated by R, are the columns of R I, because I is symmetric.
        let [x, y, z] = turned_columns;
        let turned = [0, 1, 2].map(|i| r * Vector([x.0[i], y.0[i], z.0[i]]));
        let moment = r * self.moment;
        // The inertia about the new origin is I + 2 (h·t) 1 - h tᵀ - t hᵀ + m (t² 1 - t tᵀ).
        let along = Double::new(2.0) * moment.dot(t) + self.mass * t.dot(t);
        let inertia = [0, 1, 2].map(|i| {
            Vector([0, 1, 2].map(|j| {
                let products = moment.0[i] * t.0[j] + t.0[i] * moment.0[j] + self.mass * t.0[i] * t.0[j];
                let element = turned[i].0[j] - products;
                if i == j { element + along } else { element }
            }))
        });
        Self { mass: self.mass, moment: moment + t * self.mass, inertia }
    }

    /// Returns the centre of mass; the origin if there is no mass.
    pub(crate) fn centre(&self) -> Vector {
        if self.mass.high == 0.0 { Vector::ZERO } else { self.moment * (Double::new(1.0) / self.mass) }
    }

    /// Converts the body to a link of a table; `place` is the placement of the body's frame in the link frame. Offsets
    /// there and back to the centre of mass may be large and cancel: inertia that is small enough to be their rounding
    /// error counts as zero.
    pub(crate) fn to_link_at(self, place: Pose) -> Link {
        let way = place.translation;
        let moved = self.mass.to_f64() * way.dot(way).to_f64();
        let turned = if self.is_massless_moment() { length(self.moment) * length(way) } else { 0.0 };
        self.seen_from(place).link(size(&self.inertia).max(moved).max(turned))
    }

    /// Converts the body to a link of a table: each number is rounded once, and numbers that cancel are exactly zero.
    pub(crate) fn to_link(self) -> Link {
        self.link(0.0)
    }

    /// Converts the body to a link; an element of the inertia that is negligible relative to `added` becomes zero.
    fn link(self, added: f64) -> Link {
        let centre = self.centre();
        let back = Self { moment: Vector::ZERO, ..self.about_centre(centre) };
        let scale = size(&self.inertia).max(size(&back.inertia)).max(added);
        let element = |i: usize, j: usize| rounded(back.inertia[i].0[j], scale);
        let reach = centre.to_f64().into_iter().map(f64::abs).fold(0.0, f64::max);
        Link {
            mass: self.mass.to_f64(),
            com: centre.rounded(reach),
            inertia: Inertia {
                xx: element(0, 0),
                yy: element(1, 1),
                zz: element(2, 2),
                xy: element(0, 1),
                xz: element(0, 2),
                yz: element(1, 2),
            },
            first_moment: if self.is_massless_moment() { self.moment.rounded(length(self.moment)) } else { [0.0; 3] },
        }
    }

    fn about_centre(self, centre: Vector) -> Self {
        let mut place = Pose::identity();
        place.translation = -centre;
        self.seen_from(place)
    }
}

/// Returns the largest magnitude of a component.
fn length(vector: Vector) -> f64 {
    vector.to_f64().into_iter().map(f64::abs).fold(0.0, f64::max)
}

fn size(tensor: &[Vector; 3]) -> f64 {
    tensor.iter().flat_map(|row| row.to_f64()).map(f64::abs).fold(0.0, f64::max)
}

impl Add for Body {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            mass: self.mass + other.mass,
            moment: self.moment + other.moment,
            inertia: [0, 1, 2].map(|i| self.inertia[i] + other.inertia[i]),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    use super::*;

    fn inertia(xx: f64, yy: f64, zz: f64) -> Inertia {
        Inertia { xx, yy, zz, ..Inertia::default() }
    }

    #[test]
    fn a_body_that_goes_away_and_comes_back_is_the_same_to_the_last_digit() {
        let link =
            Link { mass: 2.43, com: [0.1, -0.2, 0.37], inertia: inertia(0.013, 0.0021, 0.0137), ..Link::default() };
        let place = Pose::new([0.4318, 1.7, -0.05], [0.3, 1.1, -2.0]);
        let back = Body::of_link(&link).seen_from(place).seen_from(place.inverse());
        assert_eq!(back.to_link(), link);
    }

    /// A point mass keeps exactly zero inertia about itself, also after its frame was moved far away.
    #[test]
    fn a_point_has_no_inertia_of_its_own() {
        let link = Link { mass: 231.7, com: [17.3, -4.91, 8.37], ..Link::default() };
        let own = Pose::new(link.com, [0.3, 1.1, -2.0]);
        for place in [Pose::identity(), Pose::new([0.4318, 1.7, -0.05], [0.3, 1.1, -2.0])] {
            let found = Body::of_link(&link).seen_from(place).to_link_at((place * own).inverse());
            assert_eq!(found.inertia, Inertia::default(), "{place:?}");
        }
    }

    #[test]
    fn two_halves_are_a_rod() {
        // Two halves of a thin rod of 6 kg and 2 m along x, each with m l²/12 about its own centre.
        let half = |x: f64| Body::at(3.0, Pose::new([x, 0.0, 0.0], [0.0; 3]), inertia(0.0, 0.25, 0.25));
        let rod = (half(0.5) + half(-0.5)).to_link();
        assert_eq!(rod, Link { mass: 6.0, inertia: inertia(0.0, 2.0, 2.0), ..Link::default() });
    }

    #[test]
    fn the_tensor_turns_with_its_frame() {
        let turned =
            |yaw| Body::at(1.0, Pose::new([0.0; 3], [0.0, 0.0, yaw]), inertia(1.0, 3.0, 5.0)).to_link().inertia;
        assert_eq!(turned(FRAC_PI_2), inertia(3.0, 1.0, 5.0));
        // After a turn by 45° about z, xy is (xx - yy)/2.
        assert_eq!(turned(FRAC_PI_4), Inertia { xy: -1.0, ..inertia(2.0, 2.0, 5.0) });
    }

    #[test]
    fn a_first_moment_without_mass_turns_and_moves_the_tensor() {
        let body = Body { moment: Vector::decimal([0.0, 2.0, 0.0]), ..Body::NONE };
        let moved = body.seen_from(Pose::new([0.0, 0.5, 0.0], [0.0; 3]));
        // Along y: 2 h·t - 2 h t = 0; across y: 2 h·t.
        assert_eq!(moved.inertia[0].to_f64(), [2.0, 0.0, 0.0]);
        assert_eq!(moved.inertia[1].to_f64(), [0.0, 0.0, 0.0]);
        assert_eq!(moved.moment.to_f64(), [0.0, 2.0, 0.0]);
    }

    #[test]
    fn a_link_without_mass_keeps_its_first_moment() {
        let link = Link { first_moment: [0.3, -0.7, 0.11], inertia: inertia(-0.02, 0.3, 0.1), ..Link::default() };
        let place = Pose::new([0.4318, 1.7, -0.05], [0.3, 1.1, -2.0]);
        assert_eq!(Body::of_link(&link).seen_from(place).seen_from(place.inverse()).to_link(), link);
        assert_eq!(Body::of_link(&link).seen_from(place).to_link_at(place.inverse()), link);
        let quarter = Body::of_link(&link).seen_from(Pose::new([0.0; 3], [0.0, 0.0, FRAC_PI_2])).to_link();
        assert_eq!(quarter.first_moment, [0.7, 0.3, 0.11]);
        assert_eq!(quarter.inertia, inertia(0.3, -0.02, 0.1));
    }
}
