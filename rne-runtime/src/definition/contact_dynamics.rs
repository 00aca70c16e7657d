//! Motion of a robot on a floating base while contacts hold some of its tips.
//!
//! ```text
//! M x = r + Jᵀ f,   J x + J̇ v + g = 0        x_0 = M⁻¹ r,  X = M⁻¹ Jᵀ
//! (J X + μ 1) f = -(J x_0 + J̇ v + g)         x = x_0 + X f
//! ```
//!
//! J, J̇ v and f are in world axes. The columns of X are solved one by one.

use rne_model::Contact;

use crate::definition::Definition;
use crate::definition::per_joint::PerJoint;
use crate::number::ldlt::{factor, solve};
use crate::seven_steps::at_tip::AtTip;
use crate::{BaseAcceleration, Constant, Scalar, Wrench};

fn dot<T: Scalar>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::zero(), |sum, (&a, &b)| sum + a * b)
}

/// Changes the accelerations x_0 of the robot to x, while tips are held.
///
/// `columns` contains the rows of J, and `forces` contains J̇ v + g of the same rows; afterwards it contains f. The
/// other arguments are scratch memory: `a` and `inverse` have as many rows, `inverse_of_mass` has as many elements as M
/// has rows.
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
            // A is symmetric, and the rows of J above have already become rows of X
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

/// A number for each of the six rows of every tip.
#[derive(Clone)]
struct OfTips<P: PerJoint, T: Clone>(P::Of<[T; 6]>);

impl<P: PerJoint, T: Clone> AsRef<[T]> for OfTips<P, T> {
    fn as_ref(&self) -> &[T] {
        self.0.as_ref().as_flattened()
    }
}

impl<P: PerJoint, T: Clone> AsMut<[T]> for OfTips<P, T> {
    fn as_mut(&mut self) -> &mut [T] {
        self.0.as_mut().as_flattened_mut()
    }
}

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    #[allow(clippy::type_complexity)] // base, joints, tips
    pub(crate) fn forward_dynamics_in_contact<T: Scalar>(
        self,
        [q, qd, tau]: [&[T]; 3],
        omega: &[T; 3],
        base_rotation: &[[T; 3]; 3],
    ) -> (BaseAcceleration<T>, J::Of<T>, P::Of<Wrench<T>>) {
        let mut x = self.floating_accelerations([q, qd, tau], omega, AtTip::Wrenches(&[]));
        let mut jacobians = self.each_tip(|tip| self.tip_jacobian(q, base_rotation, tip));
        let lacking = self.each_tip(|tip| self.tip_acceleration([q, qd], omega, base_rotation, tip));
        let gravity = self.fixed_base::<T>().gravity;
        let zeros = OfTips::<P, T>(self.tips.all(&[T::zero(); 6]));
        let (mut forces, mut a, mut inverse) =
            (zeros.clone(), self.tips.of(|_| [(); 6].map(|()| zeros.clone())), zeros);
        // the rows of held tips are moved to the front
        let (columns, mut count) = (jacobians.as_mut().as_flattened_mut(), 0);
        let held = || self.contacts.iter().flat_map(|contact| (0..contact.rows()).map(|row| (contact.tip, row)));
        for (tip, row) in held() {
            columns[count] = columns[6 * tip + row].clone();
            let lacking = lacking.as_ref()[tip][row];
            forces.as_mut()[count] = if row < 3 { lacking + gravity[row] } else { lacking };
            count += 1;
        }
        Held {
            mass: self.floating_mass_matrix(q, AtTip::Nothing).as_mut(),
            inverse_of_mass: self.velocities.all(&T::zero()).as_mut(),
            columns: &mut columns[..count],
            a: &mut a.as_mut().as_flattened_mut()[..count],
            inverse: &mut inverse.as_mut()[..count],
            forces: &mut forces.as_mut()[..count],
        }
        .hold(x.as_mut());
        let mut wrenches = self.tips.all(&Wrench::zero());
        for ((tip, row), &force) in held().zip(forces.as_ref()) {
            let Wrench { force: linear, moment } = &mut wrenches.as_mut()[tip];
            if row < 3 { linear[row] = force } else { moment[row - 3] = force }
        }
        let (base, qdd) = self.of_velocities(x.as_ref());
        (base, qdd, wrenches)
    }
}
