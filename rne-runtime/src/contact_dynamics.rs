//! Motion of a robot on a floating base while contacts hold some of its tips.
//!
//! ```text
//! M x = r + Jᵀ f,   J x + J̇ v + g = 0        x_0 = M⁻¹ r,  X = M⁻¹ Jᵀ
//! (J X + μ 1) f = -(J x_0 + J̇ v + g)         x = x_0 + X f
//! ```
//!
//! J, J̇ v and f are in world axes. The columns of X are solved one by one.

use rne_model::{Contact, ContactKind, FixedFrame};

use crate::floating_base::{BASE, of_base};
use crate::ldlt::{factor, solve};
use crate::{AccelerationsAndWrenches, Arm, Constant, FloatingAccelerations, Scalar, Wrench};
#[cfg(feature = "std")]
use crate::{BaseAcceleration, DynArm, WrongLength};

fn dot<T: Scalar>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::zero(), |sum, (&a, &b)| sum + a * b)
}

/// The accelerations x of the robot while tips are held, from x_0.
///
/// `columns` holds the rows of J, and `forces` holds J̇ v + g of the same rows; it becomes f. The other arguments are
/// places: `a` and `inverse` have as many rows, `inverse_of_mass` has as many elements as M has rows.
struct Held<'a, T, R, V, W> {
    mass: &'a mut [R],
    inverse_of_mass: &'a mut [T],
    columns: &'a mut [V],
    a: &'a mut [W],
    inverse: &'a mut [T],
    forces: &'a mut [T],
}

impl<T, R, V, W> Held<'_, T, R, V, W>
where
    T: Scalar,
    R: AsRef<[T]> + AsMut<[T]>,
    V: AsRef<[T]> + AsMut<[T]> + Clone,
    W: AsRef<[T]> + AsMut<[T]>,
{
    fn hold(self, x: &mut [T]) {
        let Self { mass, inverse_of_mass, columns, a, inverse, forces } = self;
        for (force, row) in forces.iter_mut().zip(columns.iter()) {
            *force = -(*force + dot(row.as_ref(), x));
        }
        factor(mass, inverse_of_mass);
        for column in 0..columns.len() {
            let row = columns[column].clone();
            solve(mass, inverse_of_mass, columns[column].as_mut());
            // A is symmetric, and J of the rows above is X by now
            for above in 0..=column {
                a[above].as_mut()[column] = dot(row.as_ref(), columns[above].as_ref());
                a[column].as_mut()[above] = a[above].as_ref()[column];
            }
            a[column].as_mut()[column] += T::from_f64(Contact::DAMPING);
        }
        factor(a, inverse);
        solve(a, inverse, forces);
        for (column, &force) in columns.iter().zip(forces.iter()) {
            x.iter_mut().zip(column.as_ref()).for_each(|(x, &column)| *x += column * force);
        }
    }
}

/// A number for each row of all tips.
#[derive(Clone, Copy)]
struct OfTips<const TIPS: usize, T>([[T; 6]; TIPS]);

impl<const TIPS: usize, T> AsRef<[T]> for OfTips<TIPS, T> {
    fn as_ref(&self) -> &[T] {
        self.0.as_flattened()
    }
}

impl<const TIPS: usize, T> AsMut<[T]> for OfTips<TIPS, T> {
    fn as_mut(&mut self) -> &mut [T] {
        self.0.as_flattened_mut()
    }
}

/// An arm that does not know its tips takes them, with what is held of each.
impl<const DOF: usize, S: Constant> Arm<DOF, S> {
    /// As [`ContactDynamics::forward_dynamics_in_contact`](crate::ContactDynamics::forward_dynamics_in_contact), of
    /// these tips; `NV` is `DOF` + 6. `None` is a tip that nothing holds. A tip on a link that there is not is on the
    /// base.
    #[must_use]
    pub fn forward_dynamics_in_contact<T: Scalar, const NV: usize, const TIPS: usize>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        omega: &[T; 3],
        base_rotation: &[[T; 3]; 3],
        (tips, held): (&[FixedFrame<S>; TIPS], &[Option<ContactKind>; TIPS]),
    ) -> AccelerationsAndWrenches<DOF, TIPS, T> {
        let free = self.floating_forward_dynamics::<T, NV, 0>(q, qd, tau, omega, (&[], &[]));
        let FloatingAccelerations { base, qdd } = free;
        let mut numbers = base.linear.into_iter().chain(base.angular).chain(qdd);
        let mut x = [(); NV].map(|()| numbers.next().unwrap_or_else(T::zero));
        // the held rows come to the front
        let mut jacobians = self.tip_jacobians::<T, NV, TIPS>(q, base_rotation, tips);
        let lacking = self.tip_accelerations(q, qd, omega, base_rotation, tips);
        let gravity = self.fixed_base::<T>().gravity;
        let (zeros, mut forces) = (OfTips([[T::zero(); 6]; TIPS]), OfTips([[T::zero(); 6]; TIPS]));
        let (columns, forces_of_tips) = (jacobians.as_flattened_mut(), forces.as_mut());
        let rows = |tip: usize| held[tip].map_or(0, |kind| Contact { tip, kind }.rows());
        let mut count = 0;
        for tip in 0..TIPS {
            for row in 0..rows(tip) {
                columns[count] = columns[6 * tip + row];
                let lacking = lacking[tip][row];
                forces_of_tips[count] = if row < 3 { lacking + gravity[row] } else { lacking };
                count += 1;
            }
        }
        Held {
            mass: &mut self.floating_mass_matrix::<T, NV>(q),
            inverse_of_mass: &mut [T::zero(); NV],
            columns: &mut columns[..count],
            a: &mut [[zeros; 6]; TIPS].as_flattened_mut()[..count],
            inverse: &mut zeros.clone().as_mut()[..count],
            forces: &mut forces_of_tips[..count],
        }
        .hold(&mut x);
        let mut forces = forces_of_tips.iter().copied();
        let wrenches_on_robot = core::array::from_fn(|tip| {
            let mut part = |first: usize| {
                [(); 3].map(|()| if rows(tip) > first { forces.next().unwrap_or_else(T::zero) } else { T::zero() })
            };
            Wrench { force: part(0), moment: part(3) }
        });
        let qdd = core::array::from_fn(|joint| x[BASE + joint]);
        AccelerationsAndWrenches { accelerations: FloatingAccelerations { base: of_base(&x), qdd }, wrenches_on_robot }
    }
}

#[cfg(feature = "std")]
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
        let mut wrenches = vec![Wrench::zero(); self.tips().len()];
        let (base, qdd) = self.floating_forward_dynamics(q, qd, tau, omega, &wrenches)?;
        let mut x: Vec<T> = base.linear.into_iter().chain(base.angular).chain(qdd).collect();
        let jacobians = self.tip_jacobians(q, base_rotation)?;
        let lacking = self.tip_accelerations(q, qd, omega, base_rotation)?;
        let gravity = self.fixed_base::<T>().gravity;
        let held: Vec<(usize, usize)> =
            self.contacts.iter().flat_map(|&it| (0..it.rows()).map(move |row| (it.tip, row))).collect();
        let lacking = held.iter().map(|&(tip, row)| {
            let lacking = lacking[tip][row];
            if row < 3 { lacking + gravity[row] } else { lacking }
        });
        let mut forces: Vec<T> = lacking.collect();
        let zeros = vec![T::zero(); held.len()];
        Held {
            mass: &mut self.floating_mass_matrix(q)?,
            inverse_of_mass: &mut x.clone(),
            columns: &mut held.iter().map(|&(tip, row)| jacobians[tip][row].clone()).collect::<Vec<_>>(),
            a: &mut vec![zeros.clone(); held.len()],
            inverse: &mut zeros.clone(),
            forces: &mut forces,
        }
        .hold(&mut x);
        for (&(tip, row), &force) in held.iter().zip(&forces) {
            let Wrench { force: linear, moment } = &mut wrenches[tip];
            if row < 3 { linear[row] = force } else { moment[row - 3] = force }
        }
        Ok((of_base(&x), x.split_off(BASE), wrenches))
    }
}
