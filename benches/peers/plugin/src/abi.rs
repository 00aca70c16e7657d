//! The C interface of `native/rnepeer.h`. All `unsafe` of the plugin is here.
//!
//! What the driver promises, and every `SAFETY` below relies on:
//! - `robot` is a string of C that lives as long as the call.
//! - A function is called with the robot it was asked for; `q`, `qd`, `qdd` then hold one `f64` per joint (and state, in
//!   a batch), are aligned, initialised and not written during the call; `out` is as large, aligned, and overlaps nothing.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr;

#[cfg(feature = "batch")]
use rne::BatchInverseDynamics;
use rne::InverseDynamics;

/// `rp_call`: one state.
type Call = unsafe extern "C" fn(*mut c_void, *const f64, *const f64, *const f64, *mut f64);
/// `rp_batch`: many states, structure of arrays.
#[cfg(feature = "batch")]
type Batch = unsafe extern "C" fn(*mut c_void, *const f64, *const f64, *const f64, *mut f64, usize);

/// The kinds of `rnepeer.h` that are offered here.
const ID: c_int = 0;
const ID_BATCH: c_int = 3;

/// A robot's functions.
pub(crate) struct Robot {
    name: &'static str,
    call: Call,
    #[cfg(feature = "batch")]
    batch: Batch,
}

#[cfg(not(feature = "batch"))]
impl Robot {
    /// The functions of `R`.
    pub(crate) const fn new<R: InverseDynamics<DOF> + Default, const DOF: usize>(name: &'static str) -> Self {
        Self { name, call: call::<R, DOF> }
    }
}

#[cfg(feature = "batch")]
impl Robot {
    /// The functions of `R`.
    pub(crate) const fn new<R, const DOF: usize>(name: &'static str) -> Self
    where
        R: InverseDynamics<DOF> + BatchInverseDynamics<DOF> + Default,
    {
        Self { name, call: call::<R, DOF>, batch: batch::<R, DOF> }
    }
}

/// Torques of one state.
///
/// # Safety
/// The pointers are as the module's page says, for a robot with `DOF` joints.
unsafe extern "C" fn call<R: InverseDynamics<DOF> + Default, const DOF: usize>(
    _context: *mut c_void,
    q: *const f64,
    qd: *const f64,
    qdd: *const f64,
    out: *mut f64,
) {
    // SAFETY: `DOF` initialised numbers each, which nobody writes while the references live.
    let (q, qd, qdd) = unsafe { (&*q.cast::<[f64; DOF]>(), &*qd.cast::<[f64; DOF]>(), &*qdd.cast::<[f64; DOF]>()) };
    let tau = R::default().inverse_dynamics(q, qd, qdd);
    // SAFETY: room for `DOF` numbers.
    unsafe { out.cast::<[f64; DOF]>().write(tau) }
}

/// Torques of `count` states.
///
/// # Safety
/// The pointers are as the module's page says, for `count` states of a robot with `DOF` joints.
#[cfg(feature = "batch")]
unsafe extern "C" fn batch<R: BatchInverseDynamics<DOF> + Default, const DOF: usize>(
    _context: *mut c_void,
    q: *const f64,
    qd: *const f64,
    qdd: *const f64,
    out: *mut f64,
    count: usize,
) {
    use std::{array, slice};
    // SAFETY: joint j's numbers start at j·count; `DOF·count` initialised ones each, which nobody writes meanwhile.
    let joints = |x: *const f64| array::from_fn(|j| unsafe { slice::from_raw_parts(x.add(j * count), count) });
    // SAFETY: the same places of `out`: the slices of different joints do not overlap, nor do they overlap the inputs. They
    // are initialised, because the driver's memory is.
    let tau = array::from_fn(|j| unsafe { slice::from_raw_parts_mut(out.add(j * count), count) });
    let done = R::default().inverse_dynamics_batch(joints(q), joints(qd), joints(qdd), tau);
    // A panic aborts here: it cannot unwind out of `extern "C"`.
    assert!(done.is_ok(), "all slices have the same length");
}

/// How many competitors there are.
#[unsafe(no_mangle)]
pub extern "C" fn rp_count() -> c_int {
    if cfg!(feature = "batch") { 2 } else { 1 }
}

/// The name of competitor `k`.
#[unsafe(no_mangle)]
pub extern "C" fn rp_name(k: c_int) -> *const c_char {
    if k == 0 { c"rne".as_ptr() } else { c"rne_batch".as_ptr() }
}

/// The kind of competitor `k`.
#[unsafe(no_mangle)]
pub extern "C" fn rp_kind(k: c_int) -> c_int {
    if k == 0 { ID } else { ID_BATCH }
}

/// The function of competitor `k` for the robot of this name, or null.
///
/// # Safety
/// `robot` is a string of C.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rp_func(k: c_int, robot: *const c_char) -> *const c_void {
    // SAFETY: the driver passes a string of C that outlives this call.
    let name = unsafe { CStr::from_ptr(robot) };
    let Some(robot) = crate::ROBOTS.iter().find(|robot| robot.name.as_bytes() == name.to_bytes()) else {
        return ptr::null();
    };
    match k {
        0 => robot.call as *const c_void,
        #[cfg(feature = "batch")]
        1 => robot.batch as *const c_void,
        _ => ptr::null(),
    }
}

/// Nothing has to be opened: the robots are compiled in.
#[unsafe(no_mangle)]
pub extern "C" fn rp_open(_k: c_int, _robot: *const c_char, _folder: *const c_char) -> *mut c_void {
    ptr::null_mut()
}
