//! Functions of known length: what a measured call costs besides the function.

use core::hint::black_box;

use robots::State;

/// Returns the positions.
#[inline(never)]
fn echo<const DOF: usize>(q: &[f32; DOF], _: &[f32; DOF], _: &[f32; DOF]) -> [f32; DOF] {
    *q
}

/// For every number of joints, the time of a call.
pub(crate) fn each(mut act: impl FnMut(usize, u32)) {
    macro_rules! each {
        ($($dof:literal)*) => {$(
            act($dof, crate::ticks::<$dof>(black_box(echo::<$dof>), &State::new(0)));
        )*};
    }
    each!(1 2 3 4 5 6 7);
}
