//! Loads at the tips: nothing, a given wrench, a wrench at each named tip, or the wrench that moves a payload.

use nalgebra::{Matrix3, Vector3};

use rne_model::FixedFrame;

use crate::seven_steps::link_frame::{Chain, Table};
use crate::seven_steps::link_state::{ForceMoment, LinkLoad, LinkMotion};
use crate::seven_steps::mount::Mount;
use crate::{Constant, Payload, Scalar, Wrench};

/// A named tip: the link that carries it, and where it stands there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tip<S> {
    link: Option<usize>,
    mount: Mount<S>,
}

impl<S: Constant> Tip<S> {
    pub(crate) fn new(table: Table<'_, S>, frame: &FixedFrame<S>) -> Self {
        Self { link: frame.on, mount: Mount::of_frame(table.convention, table.rows, frame) }
    }
}

impl<T: Scalar> Payload<T> {
    /// Wrench of the last link on the payload, at the tip, in tip axes: steps 1, 2, 4, 5 and 6 of one link more, whose
    /// joint does not move. `last` is the motion of the last link, `tip` where the tip frame stands on it.
    ///
    /// - ω = Rᵀ ω_n, ω̇ = Rᵀ ω̇_n, g = Rᵀ g_n
    /// - c̈ = Rᵀ (c̈_n + ω̇_n × r + ω_n × (ω_n × r)) + ω̇ × c + ω × (ω × c)
    /// - f = m (c̈ - g), n = I ω̇ + ω × (I ω) + c × f
    pub(crate) fn wrench(&self, last: &LinkMotion<T>, tip: &Mount<T>) -> ForceMoment<T> {
        let (com, inertia) = (Vector3::from(self.com), Matrix3::from(self.inertia.rows()).transpose());
        let (r, rotation) = (&tip.r, &tip.rotation);
        let omega = rotation.tr_mul(&last.omega);
        let omega_dot = rotation.tr_mul(&last.omega_dot);
        let origin = (last.acceleration + last.omega_dot.cross(r)) + last.omega.cross(&last.omega.cross(r));
        let acceleration = (rotation.tr_mul(&origin) + omega_dot.cross(&com)) + omega.cross(&omega.cross(&com));
        let gravity = rotation.tr_mul(&last.gravity);
        let force = (acceleration - gravity) * self.mass;
        let moment = (inertia * omega_dot + omega.cross(&(inertia * omega))) + com.cross(&force);
        ForceMoment { force, moment }
    }
}

/// Wrench of the last link at the tip.
#[derive(Clone, Copy, Debug)]
pub(crate) enum AtTip<'a, T> {
    /// Nothing.
    Nothing,
    /// A force and a moment.
    Wrench(&'a Wrench<T>),
    /// A force and a moment at each named tip, in its axes.
    Wrenches(&'a [Wrench<T>]),
    /// The wrench that moves a payload.
    Payload(&'a Payload<T>),
}

impl<'a, T> From<Option<&'a Wrench<T>>> for AtTip<'a, T> {
    fn from(wrench: Option<&'a Wrench<T>>) -> Self {
        wrench.map_or(Self::Nothing, Self::Wrench)
    }
}

impl<T: Scalar> AtTip<'_, T> {
    /// Puts the load on the links of the tips.
    pub(crate) fn put<S: Constant>(self, chain: Chain<'_, S>, motions: &[LinkMotion<T>], loads: &mut [LinkLoad<T>]) {
        if let Self::Wrenches(wrenches) = self {
            for (Tip { link, mount }, wrench) in chain.tips.iter().zip(wrenches) {
                if let Some(load) = link.and_then(|link| loads.get_mut(link)) {
                    let mount = mount.to();
                    load.carry(&mount.rotation, &mount.r, &wrench.into());
                }
            }
        } else if let Some((load, motion)) =
            chain.tip_link.and_then(|link| Some((loads.get_mut(link)?, motions.get(link))))
        {
            let mount = chain.tip.to();
            load.carry(&mount.rotation, &mount.r, &self.wrench(motion, &mount));
        }
    }

    /// The load that changes the mass matrix: no force does.
    pub(crate) const fn matter(self) -> Self {
        match self {
            Self::Payload(_) => self,
            _ => Self::Nothing,
        }
    }

    /// In tip axes, for the last link's motion.
    fn wrench(self, last: Option<&LinkMotion<T>>, tip: &Mount<T>) -> ForceMoment<T> {
        match (self, last) {
            (Self::Wrench(wrench), _) => wrench.into(),
            (Self::Payload(payload), Some(last)) => payload.wrench(last, tip),
            _ => ForceMoment::zero(),
        }
    }
}
