//! Forward dynamics of a robot on a floating base whose tips are held by contacts, and the forces of these contacts.
//!
//! ```text
//! M x = r + Jᵀ f       r = (0, τ) - bias;  x = (a - g, ω̇, q̈);  f acts on the robot
//! J x + J̇ v + g = 0    the tips do not accelerate in the world
//!
//! M = L D Lᵀ,  Y = L⁻¹ Jᵀ,  y = L⁻¹ r
//! (Yᵀ D⁻¹ Y + μ 1) f = -(J̇ v + g) - Yᵀ D⁻¹ y
//! Lᵀ x = D⁻¹ (y + Y f)
//! ```
//!
//! All of it is in axes of frame 0: there, the columns of the base in J have only zeros, ones and levers. A column of
//! Y, like one of Jᵀ, has elements only at the base and at the joints that move its tip. f is turned into world axes
//! last. μ is [`Contact::DAMPING`].

use rne_model::{Contact, Robot};

use crate::formulate::arm::identity;
use crate::formulate::derivation::Derivation;
use crate::formulate::floating::floating_rest;
use crate::formulate::floating::tips::Tips;
use crate::formulate::layout::components;
use crate::formulate::ldlt::{Factors, System};
use crate::formulate::{Outputs, base_rotation};
use crate::ir::{Builder, Cause, Matrix, Name, Quantity, Symbol, Vector};

/// The acceleration components of tips that contacts keep at zero.
pub(crate) struct Contacts<'s> {
    list: Vec<Contact>,
    /// Number of tips of the robot.
    tips: usize,
    /// For each of the acceleration components: its row of J, and J̇ v + g.
    rows: Vec<(Vec<Symbol<'s>>, Symbol<'s>)>,
    rotation: Matrix<'s>,
}

impl<'s> Contacts<'s> {
    /// Returns the contacts of a robot, for the function of the builder.
    pub(crate) fn new(builder: &'s Builder, robot: &Robot) -> Self {
        builder.unnamed(|| Self::of(&Derivation::new(builder, robot)))
    }

    pub(in crate::formulate) fn of(derivation: &Derivation<'s, '_>) -> Self {
        let (builder, arm) = (derivation.builder, &derivation.arm);
        builder.unnamed(|| {
            let tips = Tips::of(arm, &derivation.states, identity(builder));
            let accelerations = tips.accelerations(arm, &derivation.states, &derivation.base.turning);
            let rotation = base_rotation(builder);
            let gravity = builder.joint(0).within(Quantity::TipAcceleration, || rotation.transpose() * arm.gravity);
            let list = derivation.robot.contacts.clone();
            let mut rows = Vec::new();
            for contact in &list {
                let columns = tips.gathered(arm, derivation.coordinates(), contact.tip);
                let [linear, angular] = accelerations[contact.tip];
                let falling = builder.joint(0).within(Quantity::TipAcceleration, || [linear + gravity, angular]);
                rows.extend((0..contact.rows()).map(|row| {
                    let element = |parts: &[Vector<'s>; 2]| parts[row / 3].0[row % 3];
                    (columns.iter().map(element).collect(), element(&falling))
                }));
            }
            Self { list, tips: accelerations.len(), rows, rotation }
        })
    }
}

/// Returns the accelerations of the base and of the joints, then the wrench on the robot at each tip.
pub(crate) fn forward_dynamics<'s>(
    builder: &'s Builder,
    system: &System<'_>,
    upper: &[Vec<Symbol<'s>>],
    bias: Outputs<'s>,
    contacts: &Contacts<'s>,
) -> Outputs<'s> {
    let factors = Factors::of(builder, system, upper);
    let rest = floating_rest(builder, system, bias);
    let line = builder.joint(0);
    let (forces, x) = line.within(Quantity::ContactForce, || {
        let dot = |a: &[Symbol<'s>], b: &[Symbol<'s>]| {
            a.iter().zip(b).map(|(&a, &b)| a * b).reduce(|sum, product| sum + product).unwrap_or_else(|| builder.zero())
        };
        let y = factors.forward(&rest);
        let lower: Vec<Vec<Symbol<'s>>> = contacts.rows.iter().map(|(row, _)| factors.forward(row)).collect();
        let scaled: Vec<Vec<Symbol<'s>>> = lower.iter().map(|column| factors.scaled(column)).collect();
        let damping = || builder.entry(Name::scalar(Quantity::ContactDamping, 0), Contact::DAMPING);
        let held: Vec<Vec<Symbol<'s>>> = (0..lower.len())
            .map(|row| {
                let element = |column: usize| {
                    let product = dot(&lower[row], &scaled[column]);
                    if row == column { product + damping() } else { product }
                };
                (0..=row).map(element).collect()
            })
            .collect();
        let falling = contacts.rows.iter().zip(&scaled).map(|((_, falling), scaled)| -(*falling + dot(scaled, &y)));
        let forces = solved(builder, &held, falling.collect());
        let with = |(place, &y): (usize, &Symbol<'s>)| {
            lower.iter().zip(&forces).fold(y, |sum, (column, &force)| sum + column[place] * force)
        };
        let sum: Vec<Symbol<'s>> = y.iter().enumerate().map(with).collect();
        (forces, factors.backward(&factors.scaled(&sum)))
    });
    let mut outputs: Outputs<'s> =
        x.into_iter().enumerate().map(|(row, x)| (system.name(Quantity::RateDot, row), x)).collect();
    let mut forces = forces.into_iter();
    let mut at_tips = vec![[builder.zeros(Cause::FreeTip); 2]; contacts.tips];
    for contact in &contacts.list {
        for part in at_tips[contact.tip].iter_mut().take(contact.rows() / 3) {
            let force = Vector([(); 3].map(|()| forces.next().unwrap_or_else(|| builder.zero())));
            *part = line.within(Quantity::ContactForce, || contacts.rotation * force);
        }
    }
    for (tip, parts) in at_tips.into_iter().enumerate() {
        for (quantity, part) in [Quantity::ContactForce, Quantity::ContactMoment].into_iter().zip(parts) {
            outputs.extend(components(Name::scalar(quantity, tip + 1), part));
        }
    }
    outputs.into_iter().map(|(name, x)| (name, builder.name(name, x))).collect()
}

/// Returns the solution of A f = b by A = L D Lᵀ; row i of `lower` has the elements (i, 0) to (i, i) of A.
fn solved<'s>(builder: &'s Builder, lower: &[Vec<Symbol<'s>>], b: Vec<Symbol<'s>>) -> Vec<Symbol<'s>> {
    // the rows of L and of L D: for each element both values
    let mut rows: Vec<Vec<[Symbol<'s>; 2]>> = Vec::new();
    let mut inverses: Vec<Symbol<'s>> = Vec::new();
    let mut x = b;
    for (i, elements) in lower.iter().enumerate() {
        let mut row: Vec<[Symbol<'s>; 2]> = Vec::with_capacity(i);
        for j in 0..i {
            let scaled = row.iter().zip(&rows[j]).fold(elements[j], |sum, (&[l, _], &[_, c])| sum - l * c);
            row.push([scaled * inverses[j], scaled]);
        }
        let pivot = row.iter().fold(elements[i], |sum, &[l, c]| sum - l * c);
        inverses.push(builder.quotient(builder.entry(Name::scalar(Quantity::One, 0), 1.0), pivot));
        x[i] = row.iter().enumerate().fold(x[i], |sum, (j, &[l, _])| sum - l * x[j]);
        rows.push(row);
    }
    for (x, &inverse) in x.iter_mut().zip(&inverses) {
        *x = *x * inverse;
    }
    for i in (0..x.len()).rev() {
        x[i] = (i + 1..x.len()).fold(x[i], |sum, k| sum - rows[k][i][0] * x[k]);
    }
    x
}
