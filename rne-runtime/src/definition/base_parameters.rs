//! The base parameters: the fewest combinations of the links' inertial parameters that the torques depend on.
//!
//! The [regressor](DynArm::regressor) is stacked at random states, the same in every run. A column that is a
//! combination of earlier columns belongs to a parameter whose effect on the torques cannot be distinguished from that
//! of the earlier parameters, so it is eliminated and regrouped into them. The columns run from the base to the tip and
//! within a link as J, m c, m, so that eliminated parameters are regrouped into links nearer to the base, and Jxx is
//! kept where Jyy or Jzz is eliminated, as usual.
//!
//! M. Gautier, W. Khalil, Direct calculation of minimum set of inertial parameters of serial robots, IEEE Transactions
//! on Robotics and Automation 6 (1990), 368-373, for the rules; M. Gautier, Numerical calculation of the base inertial
//! parameters of robots, Journal of Robotic Systems 8 (1991), 485-506, for the factorisation.

use std::{array, fmt};

use nalgebra::DVector;
use rne_model::{INERTIAL_PARAMETERS, JointKind, Link, PER_LINK, Row};

use crate::{DynArm, WrongLength};

/// The order in which a link's parameters are tried: J, m c, m. The numbers are those of the regressor.
const ORDER: [usize; PER_LINK] = [4, 5, 6, 7, 8, 9, 1, 2, 3, 0];

/// Number of random states. Each gives one row per joint, and there are ten columns per joint.
const STATES: usize = 40;

/// A column counts as independent if the part that earlier columns do not explain exceeds this fraction of the column.
const TOLERANCE: f64 = 1e-8;

/// A parameter of a link, numbered as in the regressor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LinkParameter {
    /// The link, counted from 0.
    pub link: usize,
    /// Its index in (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz).
    pub index: usize,
}

/// A combination of link parameters that affects the torques: `kept` + Σ coefficient · parameter.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BaseParameter {
    /// The parameter whose column of the regressor belongs to the combination.
    pub kept: LinkParameter,
    /// The parameters that are added to it, with their coefficients.
    pub regrouped: Vec<(f64, LinkParameter)>,
    /// Its value for the robot: kg m², kg m or kg, as `kept` has it.
    pub value: f64,
    /// Whether torques in double precision can distinguish it from the other base parameters, by the tolerance
    /// [`BaseParameters::VISIBLE`]. The torques determine only combinations of parameters that they cannot distinguish.
    pub is_visible: bool,
}

/// Combinations of link parameters that determine the torques, without rotors and friction.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BaseParameters {
    /// One per independent column, base to tip.
    pub parameters: Vec<BaseParameter>,
    /// Link parameters on which no torque depends.
    pub without_effect: Vec<LinkParameter>,
    /// How many combinations torques in double precision determine: as many as there are base parameters, or fewer if
    /// some of these are not visible.
    pub visible_rank: usize,
}

impl DynArm {
    /// The inertial parameters of every link, as the regressor counts them, about the origin of its link frame and in
    /// its axes.
    #[must_use]
    pub fn inertial_parameters(&self) -> Vec<[f64; PER_LINK]> {
        self.rows().iter().map(|row| about_the_origin(&row.link)).collect()
    }

    /// The inertial parameters of the base, then of every link, as
    /// [`floating_regressor`](Self::floating_regressor) counts them; zeros for a robot without `floating_base`.
    #[must_use]
    pub fn floating_inertial_parameters(&self) -> Vec<[f64; PER_LINK]> {
        let base = self.floating_base.as_ref().map_or([0.0; PER_LINK], about_the_origin);
        [base].into_iter().chain(self.inertial_parameters()).collect()
    }

    /// Computes the combinations of link parameters that determine the torques.
    #[must_use]
    pub fn base_parameters(&self) -> BaseParameters {
        let columns = self.stacked_regressor();
        let order = (0..self.rows().len()).flat_map(|link| ORDER.map(|index| LinkParameter { link, index }));
        let largest = columns.iter().map(DVector::norm).fold(0.0, f64::max);
        let mut basis = Basis::default();
        let mut found = BaseParameters { parameters: Vec::new(), without_effect: Vec::new(), visible_rank: 0 };
        let mut kept_columns = Vec::new();
        let values = self.inertial_parameters();
        let value = |parameter: LinkParameter| values[parameter.link][parameter.index];
        for parameter in order {
            let column = &columns[parameter.link * PER_LINK + parameter.index];
            if column.norm() <= TOLERANCE * largest {
                found.without_effect.push(parameter);
                continue;
            }
            let Some(coefficients) = basis.combination_or_insert(column) else {
                let value = value(parameter);
                let kept = BaseParameter { kept: parameter, regrouped: Vec::new(), value, is_visible: true };
                found.parameters.push(kept);
                kept_columns.push(column);
                continue;
            };
            for (base, coefficient) in found.parameters.iter_mut().zip(coefficients) {
                let coefficient = cleaned(coefficient);
                if coefficient != 0.0 {
                    base.value += coefficient * value(parameter);
                    base.regrouped.push((coefficient, parameter));
                }
            }
        }
        for base in &mut found.parameters {
            let parts = base.regrouped.iter().map(|(coefficient, parameter)| coefficient * value(*parameter));
            let magnitude = parts.fold(value(base.kept).abs(), |sum, part| sum + part.abs());
            if base.value.abs() <= 16.0 * f64::EPSILON * magnitude {
                // the terms cancel up to rounding
                base.value = 0.0;
            }
        }
        for (base, is_visible) in found.parameters.iter_mut().zip(basis.visible()) {
            base.is_visible = is_visible;
        }
        found.visible_rank = visible_rank(kept_columns);
        found.without_effect.sort_unstable();
        found
    }

    /// Returns the columns of the regressor at many random states, whose rows are stacked.
    fn stacked_regressor(&self) -> Vec<DVector<f64>> {
        let mut columns = vec![Vec::new(); self.rows().len() * PER_LINK];
        let mut random = Random(1);
        for _ in 0..STATES {
            let q: Vec<f64> =
                self.couplings.joints().iter().map(|&joint| random.position(&self.rows()[joint])).collect();
            let mut rates = |most: f64| -> Vec<f64> { (0..self.dof()).map(|_| most * random.number()).collect() };
            let (qd, qdd) = (rates(3.0), rates(10.0));
            // never an error, because there is one number per joint
            let Ok(matrix) = self.regressor(&q, &qd, &qdd) else { continue };
            for torque in matrix {
                for (column, element) in columns.iter_mut().zip(torque.iter().flatten()) {
                    column.push(*element);
                }
            }
        }
        columns.into_iter().map(DVector::from_vec).collect()
    }
}

impl BaseParameters {
    /// A base parameter is visible in double precision if its column of the regressor differs from every combination of
    /// the other columns by more than this fraction of itself. Angles near a right angle, such as `alpha: 1.5708`, give
    /// base parameters that are distinct in theory but not visible: rounding changes the torques more.
    pub const VISIBLE: f64 = 1e-10;

    /// The rank of the regressor.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.parameters.len()
    }

    /// The base parameters that consist of one link parameter.
    pub fn alone(&self) -> impl Iterator<Item = &BaseParameter> {
        self.parameters.iter().filter(|base| base.regrouped.is_empty())
    }

    /// Returns the columns of a regressor that belong to the base parameters: τ_i = Σ_k Y_ik value_k.
    ///
    /// # Errors
    /// As [`DynArm::regressor`].
    pub fn regressor(&self, arm: &DynArm, q: &[f64], qd: &[f64], qdd: &[f64]) -> Result<Vec<Vec<f64>>, WrongLength> {
        let matrix = arm.regressor(q, qd, qdd)?;
        let columns = |torque: Vec<[f64; PER_LINK]>| {
            self.parameters.iter().map(move |base| torque[base.kept.link][base.kept.index])
        };
        Ok(matrix.into_iter().map(|torque| columns(torque).collect()).collect())
    }
}

impl fmt::Display for LinkParameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", INERTIAL_PARAMETERS.get(self.index).unwrap_or(&"?"), self.link + 1)
    }
}

/// Independent columns, as orthonormal directions and the triangular matrix that relates them to the columns.
#[derive(Default)]
struct Basis {
    directions: Vec<DVector<f64>>,
    /// Column k has the components of independent column k along the directions 0 to k.
    triangle: Vec<Vec<f64>>,
}

impl Basis {
    /// Returns the coefficients of a column that is a combination of the earlier ones. Otherwise adds it to the
    /// independent columns and returns `None`.
    fn combination_or_insert(&mut self, column: &DVector<f64>) -> Option<Vec<f64>> {
        let mut rest = column.clone();
        let mut parts = vec![0.0; self.directions.len()];
        // the second orthogonalisation gives full precision
        for _ in 0..2 {
            for (part, direction) in parts.iter_mut().zip(&self.directions) {
                let along = direction.dot(&rest);
                rest.axpy(-along, direction, 1.0);
                *part += along;
            }
        }
        let length = rest.norm();
        if length <= TOLERANCE * column.norm() {
            return Some(self.solved(parts));
        }
        parts.push(length);
        self.triangle.push(parts);
        self.directions.push(rest / length);
        None
    }

    /// Finds the columns that differ from every combination of the others by more than [`BaseParameters::VISIBLE`] of
    /// themselves. The distance of a column from the others is one over the length of its row of the inverse triangle.
    fn visible(&self) -> Vec<bool> {
        let mut rows = vec![0.0; self.triangle.len()];
        for column in 0..self.triangle.len() {
            let mut unit = vec![0.0; column + 1];
            unit[column] = 1.0;
            for (row, element) in rows.iter_mut().zip(self.solved(unit)) {
                *row += element * element;
            }
        }
        let length = |parts: &Vec<f64>| parts.iter().map(|part| part * part).sum::<f64>().sqrt();
        let lengths = self.triangle.iter().map(length);
        rows.iter().zip(lengths).map(|(row, length)| row.sqrt() * length * BaseParameters::VISIBLE <= 1.0).collect()
    }

    /// Returns the coefficients of independent columns, from components along the directions.
    fn solved(&self, mut parts: Vec<f64>) -> Vec<f64> {
        for k in (0..parts.len()).rev() {
            parts[k] /= self.triangle[k][k];
            for earlier in 0..k {
                parts[earlier] -= parts[k] * self.triangle[k][earlier];
            }
        }
        parts
    }
}

/// Returns how many columns remain when the last one that is not visible is removed, again and again until all are
/// visible.
fn visible_rank(mut columns: Vec<&DVector<f64>>) -> usize {
    loop {
        let mut basis = Basis::default();
        // a column that is a combination of others up to the tolerance is not visible either
        columns.retain(|column| basis.combination_or_insert(column).is_none());
        match basis.visible().iter().rposition(|is_visible| !is_visible) {
            Some(hidden) => drop(columns.remove(hidden)),
            None => return columns.len(),
        }
    }
}

/// Removes the rounding errors of a coefficient: returns a whole number if it differs from one by less than 1e-9.
fn cleaned(coefficient: f64) -> f64 {
    let whole = coefficient.round();
    if (coefficient - whole).abs() < 1e-9 { whole } else { coefficient }
}

/// Returns the parameters of a link about the origin of the link frame.
fn about_the_origin(link: &Link) -> [f64; PER_LINK] {
    let Link { mass: m, com: [x, y, z], inertia: i, first_moment: [hx, hy, hz] } = *link;
    let body = [
        m,
        m * x,
        m * y,
        m * z,
        i.xx + m * (y * y + z * z),
        i.xy - m * x * y,
        i.xz - m * x * z,
        i.yy + m * (x * x + z * z),
        i.yz - m * y * z,
        i.zz + m * (x * x + y * y),
    ];
    // the inertia of the first moment h beside the mass: 2 h·c 1 - h cᵀ - c hᵀ
    let beside = [
        0.0,
        hx,
        hy,
        hz,
        2.0 * (hy * y + hz * z),
        -(hx * y + hy * x),
        -(hx * z + hz * x),
        2.0 * (hx * x + hz * z),
        -(hy * z + hz * y),
        2.0 * (hx * x + hy * y),
    ];
    if link.has_first_moment() { array::from_fn(|i| body[i] + beside[i]) } else { body }
}

/// The generator SplitMix64 of Steele, which gives the same states on every machine.
struct Random(u64);

impl Random {
    /// Returns a number between -1 and 1.
    #[allow(clippy::cast_precision_loss)] // exact for 53 bits
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        bits ^= bits >> 31;
        (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Returns a random position: any angle of a turn, or a distance within a metre.
    fn position(&mut self, row: &Row) -> f64 {
        match row.kind {
            JointKind::Revolute => std::f64::consts::PI * self.number(),
            JointKind::Prismatic => self.number(),
        }
    }
}
