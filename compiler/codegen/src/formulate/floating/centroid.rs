//! The momentum about the centre of mass of a robot with a floating base, from the rows of the base in M and in the
//! bias. All vectors are in axes of frame 0; m, h, J, F and N are those of [`mass_matrix`](super::mass_matrix).
//!
//! ```text
//! linear    p = [ m 1   -[h]×          F         ] v
//! angular   L = [ 0      J + [c]× [h]×  N - [c]× F ] v        c = h / m
//! their rates at zero accelerations: f and n - c × f of the bias
//! of velocities v: P and L - c × P of the momenta about the origin of frame 0
//! ```
//!
//! D. E. Orin, A. Goswami, S.-H. Lee, "Centroidal dynamics of a humanoid robot", 2013.

use crate::formulate::Outputs;
use crate::formulate::layout::components;
use crate::formulate::ldlt::System;
use crate::formulate::mass_matrix::OfBase;
use crate::ir::{Builder, Name, Quantity, Symbol, Vector};

/// The centre of mass of a robot, about which moments are computed.
struct Centre<'s> {
    builder: &'s Builder,
    /// The centre of mass in frame 0; for a robot without mass, a number that is not finite.
    position: Result<Vector<'s>, Symbol<'s>>,
}

impl<'s> Centre<'s> {
    fn of(builder: &'s Builder, (mass, h): (Symbol<'s>, Vector<'s>)) -> Self {
        let position = builder.joint(0).within(Quantity::CentroidalMoment, || {
            let inverse = builder.quotient(builder.entry(Name::scalar(Quantity::One, 0), 1.0), mass);
            if mass.is_zero() { Err(inverse) } else { Ok(h * inverse) }
        });
        Self { builder, position }
    }

    /// Returns the moment about the centre of mass, given a force and its moment about the origin of frame 0.
    fn moment(&self, [force, moment]: [Vector<'s>; 2]) -> Vector<'s> {
        let line = self.builder.joint(0);
        line.within(Quantity::CentroidalMoment, || match self.position {
            Ok(c) => moment - c.cross(force),
            Err(infinite) => Vector([infinite; 3]),
        })
    }
}

/// Returns the rows of the centroidal momentum matrix; `of_base` has a column for each coordinate.
pub(crate) fn momentum_matrix<'s>(builder: &'s Builder, system: &System<'_>, of_base: &OfBase<'s>) -> Outputs<'s> {
    let centre = Centre::of(builder, (of_base.mass, of_base.h));
    let columns: Vec<[Vector<'s>; 2]> = (0..system.size())
        .map(|column| {
            let [force, moment] = of_base.column(builder, column);
            // a pure translation gives no angular momentum about the centre of mass
            let about = if column < 3 { builder.no_vector() } else { centre.moment([force, moment]) };
            [force, about]
        })
        .collect();
    let places = (0..6).flat_map(|row| (0..system.size()).map(move |column| (row, column)));
    let element = |(row, column): (usize, usize)| {
        let of_matrix = system.name_of_element(row, column);
        let quantity = if row < 3 { of_matrix.quantity } else { Quantity::CentroidalMoment };
        let name = Name { quantity, ..of_matrix };
        (name, builder.name(name, columns[column][row / 3].0[row % 3]))
    };
    places.map(element).collect()
}

/// Returns the momentum, or its rate, about the centre of mass, given that about the origin of frame 0. `centre` is the
/// mass and the first moment of the robot, `linear` the quantity of the linear part.
pub(crate) fn about_centre<'s>(
    builder: &'s Builder,
    centre: (Symbol<'s>, Vector<'s>),
    linear: Quantity,
    [force, moment]: [Vector<'s>; 2],
) -> Outputs<'s> {
    let about = Centre::of(builder, centre).moment([force, moment]);
    let about = builder.name_vector(Quantity::CentroidalMoment, 0, about);
    let parts = [(linear, force), (Quantity::CentroidalMoment, about)];
    parts.into_iter().flat_map(|(part, vector)| components(Name::scalar(part, 0), vector)).collect()
}
