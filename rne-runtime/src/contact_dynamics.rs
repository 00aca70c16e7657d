//! Motion of a robot on a floating base while contacts hold some of its tips.
//!
//! ```text
//! M x = r + Jᵀ f,   J x + J̇ v + g = 0        x_0 = M⁻¹ r,  X = M⁻¹ Jᵀ
//! (J X + μ 1) f = -(J x_0 + J̇ v + g)         x = x_0 + X f
//! ```
//!
//! J, J̇ v and f are in world axes. The columns of X are solved one by one.

use rne_model::Contact;

use crate::ldlt::{factor, solve};
use crate::{BaseAcceleration, Constant, DynArm, Scalar, Wrench, WrongLength};

/// A symmetric system that is solved many times.
struct Factored<T> {
    rows: Vec<Vec<T>>,
    inverse: Vec<T>,
}

impl<T: Scalar> Factored<T> {
    fn new(mut rows: Vec<Vec<T>>) -> Self {
        let mut inverse = vec![T::zero(); rows.len()];
        factor(&mut rows, &mut inverse);
        Self { rows, inverse }
    }

    fn solved(&self, mut b: Vec<T>) -> Vec<T> {
        solve(&self.rows, &self.inverse, &mut b);
        b
    }
}

fn dot<T: Scalar>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::zero(), |sum, (&a, &b)| sum + a * b)
}

impl<S: Constant> DynArm<S> {
    /// The tips that something outside the robot holds.
    #[must_use]
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }

    /// As [`ContactDynamics::forward_dynamics_in_contact`](crate::ContactDynamics::forward_dynamics_in_contact): the
    /// acceleration of the base, those of the joints, and the wrench on the robot at each of the [tips](Self::tips).
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint.
    #[allow(clippy::type_complexity)] // base, joints, tips
    pub fn forward_dynamics_in_contact<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        omega: &[T; 3],
        base_rotation: &[[T; 3]; 3],
    ) -> Result<(BaseAcceleration<T>, Vec<T>, Vec<Wrench<T>>), WrongLength> {
        let free = vec![Wrench::zero(); self.tips().len()];
        let (base, qdd) = self.floating_forward_dynamics(q, qd, tau, omega, &free)?;
        let mut x: Vec<T> = base.linear.into_iter().chain(base.angular).chain(qdd).collect();
        let mass = Factored::new(self.floating_mass_matrix(q)?);
        let jacobians = self.tip_jacobians(q, base_rotation)?;
        let lacking = self.tip_accelerations(q, qd, omega, base_rotation)?;
        let gravity = self.fixed_base::<T>().gravity;
        let held: Vec<(usize, usize)> =
            self.contacts.iter().flat_map(|&it| (0..it.rows()).map(move |row| (it.tip, row))).collect();
        let rows: Vec<&Vec<T>> = held.iter().map(|&(tip, row)| &jacobians[tip][row]).collect();
        let columns: Vec<Vec<T>> = rows.iter().map(|row| mass.solved((*row).clone())).collect();
        let matrix = rows.iter().enumerate().map(|(i, row)| {
            let element = |(j, column): (usize, &Vec<T>)| {
                let product = dot(row, column);
                if i == j { product + T::from_f64(Contact::DAMPING) } else { product }
            };
            columns.iter().enumerate().map(element).collect()
        });
        let falling = held.iter().zip(&rows).map(|(&(tip, row), jacobian)| {
            let lacking = lacking[tip][row] + dot(jacobian, &x);
            -(if row < 3 { lacking + gravity[row] } else { lacking })
        });
        let forces = Factored::new(matrix.collect()).solved(falling.collect());
        for (column, &force) in columns.iter().zip(&forces) {
            x.iter_mut().zip(column).for_each(|(x, &column)| *x += column * force);
        }
        let mut wrenches = free;
        for (&(tip, row), &force) in held.iter().zip(&forces) {
            let Wrench { force: linear, moment } = &mut wrenches[tip];
            if row < 3 { linear[row] = force } else { moment[row - 3] = force }
        }
        let base = BaseAcceleration { linear: [x[0], x[1], x[2]], angular: [x[3], x[4], x[5]] };
        Ok((base, x.split_off(6), wrenches))
    }
}
