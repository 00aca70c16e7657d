//! Functions of known length, which show the overhead of a measured call.

use core::hint::black_box;

use robots::State;

/// Returns the positions.
#[inline(never)]
fn echo<const DOF: usize>(q: &[f32; DOF], _: &[f32; DOF], _: &[f32; DOF]) -> [f32; DOF] {
    *q
}

/// Passes the time of a call, for every number of joints, to `act`.
pub(crate) fn each(mut act: impl FnMut(usize, u32)) {
    macro_rules! each {
        ($($dof:literal)*) => {$(
            act($dof, crate::ticks::<$dof>(black_box(echo::<$dof>), &State::new(0)));
        )*};
    }
    each!(1 2 3 4 5 6 7);
}
