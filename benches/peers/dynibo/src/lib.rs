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

/// Gravity of these is not along -z, and an inertia of the source of Atlas is not that of a body.
const REFUSED: [&CStr; 4] = [c"planar2", c"dense6_2p", c"dense7", c"atlas"];

/// A robot. dynibo has an order of joints of its own: `joints[i]` is the driver's number of its joint i.
struct Context {
    robot: Robot,
    joints: Vec<usize>,
    /// q, q̇, the third argument, the result and the torques at rest in dynibo's order.
    rooms: [Vec<f64>; 5],
    /// The mass matrix of the last call, in dynibo's order and then in the driver's.
    matrices: [Vec<f64>; 2],
    is_checked: bool,
}

impl Context {
    fn new(file: &str) -> Self {
        let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{file}: {error}"));
        let robot = Robot::from_urdf(file).unwrap_or_else(|error| panic!("{file}: {error}"));
        let elements = text.split("<joint name=\"").skip(1).filter(|joint| !joint.contains("type=\"fixed\""));
        let names: Vec<&str> = elements.filter_map(|joint| joint.split('"').next()).collect();
        let number = |i| {
            let name = robot.joint_name(i).unwrap_or_else(|error| panic!("{file}: {error}"));
            names.iter().position(|other| *other == name).unwrap_or_else(|| panic!("{file} has no joint {name}"))
        };
        let joints: Vec<usize> = (0..robot.generalized_count()).map(number).collect();
        let count = joints.len();
        let (rooms, matrices) = ([(); 5].map(|()| vec![0.0; count]), [(); 2].map(|()| vec![0.0; count * count]));
        Self { robot, joints, rooms, matrices, is_checked: false }
    }

    fn call<const FUNCTION: usize>(&mut self, arguments: [&[f64]; 3], results: &mut [f64]) -> dynibo::Result<()> {
        let Self { robot, joints, rooms: [q, qd, third, out, at_rest], matrices, is_checked } = self;
        for (room, argument) in [&mut *q, &mut *qd, &mut *third].into_iter().zip(arguments) {
            room.iter_mut().zip(&*joints).for_each(|(x, &joint)| *x = argument[joint]);
        }
        // What gravity of the states adds to the torques.
        if *is_checked {
            robot.gravity(q, &[], at_rest)?;
            at_rest.iter_mut().for_each(|torque| *torque *= 1.0 / GRAVITY - 1.0);
        } else {
            at_rest.fill(0.0);
        }
        match FUNCTION {
            0 => {
                robot.inverse_dynamics(q, qd, third, &[], out)?;
                out.iter_mut().zip(&*at_rest).for_each(|(torque, missing)| *torque += missing);
            }
            1 => {
                robot.mass_matrix(q, &mut matrices[0])?;
                results[0] = matrices[0][0];
                return Ok(());
            }
            _ => {
                third.iter_mut().zip(&*at_rest).for_each(|(torque, missing)| *torque -= missing);
                robot.forward_dynamics(q, qd, third, &[], out)?;
            }
        }
        out.iter().zip(&*joints).for_each(|(x, &joint)| results[joint] = *x);
        Ok(())
    }

    fn mass_matrix(&mut self) -> &[f64] {
        let (joints, [from, to]) = (&self.joints, &mut self.matrices);
        for (i, row) in joints.iter().enumerate() {
            for (j, column) in joints.iter().enumerate() {
                to[row * joints.len() + column] = from[i * joints.len() + j];
            }
        }
        to
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
    let count = context.joints.len();
    // SAFETY: a number for each joint, which nobody writes meanwhile.
    let arguments = [q, qd, third].map(|x| unsafe { slice::from_raw_parts(x, count) });
    // SAFETY: as many, which overlap nothing.
    let done = context.call::<FUNCTION>(arguments, unsafe { slice::from_raw_parts_mut(out, count) });
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

/// # Safety
/// As the page of the crate says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rp_func(k: c_int, robot: *const c_char) -> *const c_void {
    // SAFETY: a string of C that outlives this call.
    if REFUSED.contains(&unsafe { CStr::from_ptr(robot) }) {
        return ptr::null();
    }
    competitor(k).map_or(ptr::null(), |(.., call)| *call as *const c_void)
}

/// # Safety
/// As the page of the crate says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rp_open(_k: c_int, robot: *const c_char, folder: *const c_char) -> *mut c_void {
    // SAFETY: strings of C that outlive this call.
    let [robot, folder] = [robot, folder].map(|text| unsafe { CStr::from_ptr(text) }.to_string_lossy());
    ptr::from_mut(Box::leak(Box::new(Context::new(&format!("{folder}/{robot}.urdf"))))).cast()
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
    let context = unsafe { &mut *context.cast::<Context>() };
    if k == 1 && what == 3 { context.mass_matrix().as_ptr() } else { ptr::null() }
}
