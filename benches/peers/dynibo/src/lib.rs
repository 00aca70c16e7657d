//! dynibo's inverse dynamics, mass matrix and forward dynamics of the URDFs that `rne export` writes.
//!
//! What the driver promises, and every `SAFETY` below relies on: strings are strings of C; a context is one of
//! [`rp_open`], which one call at a time has; arrays have a number for each joint, are initialised, and `out` overlaps
//! nothing.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::{ptr, slice};

use dynibo::Robot;

/// Gravity of dynibo over that of the states, both along -z: dynibo's cannot be set.
const GRAVITY: f64 = 9.80665 / 9.81;

/// A robot, the mass matrix of the last call, and room for the torques at rest while results are checked.
struct Context {
    robot: Robot,
    joints: usize,
    matrix: Vec<f64>,
    at_rest: Vec<f64>,
    is_checked: bool,
}

impl Context {
    /// What gravity of the states adds to the torques.
    fn missing_torques(&mut self, q: &[f64]) -> impl Iterator<Item = f64> {
        assert!(self.robot.gravity(q, &[], &mut self.at_rest).is_ok(), "the sizes are those of the robot");
        self.at_rest.iter().map(|torque| torque * (1.0 / GRAVITY - 1.0))
    }
}

type Call = unsafe extern "C" fn(*mut c_void, *const f64, *const f64, *const f64, *mut f64);

/// The functions in the order of their numbers, with name and kind of `rnepeer.h`.
const CALLS: [(&CStr, c_int, Call); 3] =
    [(c"dynibo_rnea", 0, call::<0>), (c"dynibo_mass_matrix", 2, call::<1>), (c"dynibo_aba", 1, call::<2>)];

/// # Safety
/// As the page of the crate says.
unsafe extern "C" fn call<const FUNCTION: usize>(
    context: *mut c_void,
    q: *const f64,
    qd: *const f64,
    third: *const f64,
    out: *mut f64,
) {
    // SAFETY: a context of ours, which nobody else has meanwhile.
    let context = unsafe { &mut *context.cast::<Context>() };
    // SAFETY: a number for each joint, which nobody writes meanwhile.
    let [q, qd, third] = [q, qd, third].map(|x| unsafe { slice::from_raw_parts(x, context.joints) });
    // SAFETY: as many, which overlap nothing.
    let out = unsafe { slice::from_raw_parts_mut(out, context.joints) };
    let done = match FUNCTION {
        0 => context.robot.inverse_dynamics(q, qd, third, &[], out),
        1 => {
            let done = context.robot.mass_matrix(q, &mut context.matrix);
            out[0] = context.matrix[0];
            done
        }
        _ if context.is_checked => {
            let tau: Vec<f64> =
                third.iter().zip(context.missing_torques(q)).map(|(tau, missing)| tau - missing).collect();
            context.robot.forward_dynamics(q, qd, &tau, &[], out)
        }
        _ => context.robot.forward_dynamics(q, qd, third, &[], out),
    };
    if FUNCTION == 0 && context.is_checked {
        out.iter_mut().zip(context.missing_torques(q)).for_each(|(tau, missing)| *tau += missing);
    }
    assert!(done.is_ok(), "the sizes are those of the robot");
}

#[unsafe(no_mangle)]
pub extern "C" fn rp_count() -> c_int {
    3
}

fn competitor(k: c_int) -> Option<&'static (&'static CStr, c_int, Call)> {
    usize::try_from(k).ok().and_then(|k| CALLS.get(k))
}

#[unsafe(no_mangle)]
pub extern "C" fn rp_name(k: c_int) -> *const c_char {
    competitor(k).map_or(ptr::null(), |(name, ..)| name.as_ptr())
}

#[unsafe(no_mangle)]
pub extern "C" fn rp_kind(k: c_int) -> c_int {
    competitor(k).map_or(2, |(_, kind, _)| *kind)
}

#[unsafe(no_mangle)]
pub extern "C" fn rp_func(k: c_int, _robot: *const c_char) -> *const c_void {
    competitor(k).map_or(ptr::null(), |(.., call)| *call as *const c_void)
}

/// # Safety
/// As the page of the crate says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rp_open(_k: c_int, robot: *const c_char, folder: *const c_char) -> *mut c_void {
    // SAFETY: strings of C that outlive this call.
    let [robot, folder] = [robot, folder].map(|text| unsafe { CStr::from_ptr(text) }.to_string_lossy());
    let robot = Robot::from_urdf(format!("{folder}/{robot}.urdf")).unwrap_or_else(|error| panic!("{robot}: {error}"));
    let joints = robot.generalized_count();
    let [matrix, at_rest] = [joints * joints, joints].map(|size| vec![0.0; size]);
    ptr::from_mut(Box::leak(Box::new(Context { robot, joints, matrix, at_rest, is_checked: false }))).cast()
}

/// While results are checked they are those of the gravity of the states.
///
/// # Safety
/// As the page of the crate says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rp_keep(_k: c_int, context: *mut c_void, keep: c_int) {
    // SAFETY: a context of ours, which nobody else has meanwhile.
    unsafe { (*context.cast::<Context>()).is_checked = keep != 0 }
}

/// # Safety
/// As the page of the crate says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rp_result(k: c_int, context: *mut c_void, _out: *const f64, what: c_int) -> *const f64 {
    // SAFETY: a context of ours, which nobody writes during this call.
    let context = unsafe { &*context.cast::<Context>() };
    if k == 1 && what == 3 { context.matrix.as_ptr() } else { ptr::null() }
}
