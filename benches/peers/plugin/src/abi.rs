//! The C interface of `native/rnepeer.h`. All `unsafe` of the plugin is here.
//!
//! What the driver promises, and every `SAFETY` below relies on:
//! - `robot` is a string of C that lives as long as the call.
//! - A function is called with the robot it was asked for; `q`, `qd`, `qdd` then hold one `f64` per joint (and state,
//!   in a batch), are aligned, initialised and not written during the call; `out` is as large, aligned, and overlaps
//!   nothing.
//! - A context is one that [`rp_open`] made, and one call at a time has it.

use std::ffi::{CStr, c_char, c_int, c_void};
#[cfg(feature = "functions")]
use std::hint::black_box;
use std::ptr;

#[cfg(feature = "batch")]
use rne::BatchInverseDynamics;
use rne::InverseDynamics;
#[cfg(all(feature = "batch", feature = "functions"))]
use rne::{BatchForwardDynamics, BatchInverseDynamicsDerivatives, BatchMassMatrix};
#[cfg(feature = "functions")]
use rne::{ForwardDynamics, InverseDynamicsDerivatives, MassMatrix};

/// `rp_call`: one state.
type Call = unsafe extern "C" fn(*mut c_void, *const f64, *const f64, *const f64, *mut f64);
/// `rp_batch`: many states, structure of arrays.
type Batch = unsafe extern "C" fn(*mut c_void, *const f64, *const f64, *const f64, *mut f64, usize);

/// A robot and what is offered for it; the same competitors in the same order for all robots.
pub(crate) struct Robot {
    pub(crate) name: &'static str,
    #[cfg(feature = "machine")]
    pub(crate) file: &'static str,
    pub(crate) competitors: &'static [(&'static CStr, Function)],
}

/// A function by its kind.
#[cfg_attr(not(all(feature = "batch", feature = "functions")), allow(dead_code))]
pub(crate) enum Function {
    InverseDynamics(Call),
    ForwardDynamics(Call),
    /// One of the quantities below in `out`.
    Other(c_int, Call),
    /// These quantities in the context.
    Matrices(&'static [c_int], Call),
    Batch(Batch),
    /// Accelerations of many states.
    BatchForwardDynamics(Batch),
    /// These quantities of many states, one after the other in the context.
    BatchMatrices(&'static [c_int], Batch),
    /// Many states of an arm that is compiled at run time.
    #[cfg(feature = "machine")]
    Machine(rne_codegen::Function),
}

/// The quantities of `rnepeer.h`.
#[cfg_attr(not(feature = "functions"), allow(dead_code))]
pub(crate) mod quantity {
    use super::c_int;

    pub(crate) const TAU: c_int = 0;
    pub(crate) const GRAVITY: c_int = 1;
    pub(crate) const BIAS: c_int = 2;
    pub(crate) const MASS_MATRIX: c_int = 3;
    pub(crate) const DTAU_DQ: c_int = 4;
    pub(crate) const DTAU_DQD: c_int = 5;
}

/// What does not fit into `out`, of the last call with this context. A robot with fewer joints uses the beginnings.
struct Results {
    keep: bool,
    tau: [f64; MOST_JOINTS],
    mass_matrix: [f64; MOST_JOINTS * MOST_JOINTS],
    by_q: [f64; MOST_JOINTS * MOST_JOINTS],
    by_qd: [f64; MOST_JOINTS * MOST_JOINTS],
}

const MOST_JOINTS: usize = 30;

/// `DOF` numbers from C.
///
/// # Safety
/// The pointer is to as many initialised numbers, which nobody writes while the reference lives.
unsafe fn read<'a, const DOF: usize>(numbers: *const f64) -> &'a [f64; DOF] {
    // SAFETY: as this function's.
    unsafe { &*numbers.cast() }
}

/// Numbers to C, which may be too few to fill the room.
///
/// # Safety
/// There is room for a `T`, aligned.
unsafe fn write<T>(room: *mut f64, value: T) {
    // SAFETY: as this function's.
    unsafe { room.cast::<T>().write(value) }
}

/// The functions of one state: their inputs by name, then the torques or accelerations that they write.
macro_rules! calls {
    ($(
        $(#[$attribute:meta])* $name:ident: $capability:ident, |$robot:ident, $q:tt, $qd:tt, $qdd:tt| $result:expr;
    )*) => {$(
        $(#[$attribute])*
        ///
        /// # Safety
        /// The pointers are as the module's page says, for a robot with `DOF` joints.
        pub(crate) unsafe extern "C" fn $name<R: $capability<DOF> + Default, const DOF: usize>(
            _context: *mut c_void,
            q: *const f64,
            qd: *const f64,
            qdd: *const f64,
            out: *mut f64,
        ) {
            // SAFETY: `DOF` initialised numbers each, which nobody writes while the references live.
            let ($q, $qd, $qdd) = unsafe { (read::<DOF>(q), read::<DOF>(qd), read::<DOF>(qdd)) };
            let $robot = R::default();
            let result: [f64; DOF] = $result;
            // SAFETY: room for `DOF` numbers.
            unsafe { write(out, result) }
        }
    )*};
}

calls! {
    /// Torques.
    inverse_dynamics: InverseDynamics, |robot, q, qd, qdd| robot.inverse_dynamics(q, qd, qdd);
    /// Torques at rest.
    #[cfg(feature = "functions")]
    gravity: InverseDynamics, |robot, q, _, _| robot.gravity_torques(q);
    /// Torques without acceleration.
    #[cfg(feature = "functions")]
    bias: InverseDynamics, |robot, q, qd, _| robot.bias_torques(q, qd);
    /// Accelerations.
    #[cfg(feature = "functions")]
    forward_dynamics: ForwardDynamics, |robot, q, qd, tau| robot.forward_dynamics(q, qd, tau);
}

/// The mass matrix; its first element goes to `out`.
///
/// It stays on the stack, where a program has what it called for, and all of it is there when `black_box` sees it. It
/// is copied only to be checked: to copy at once what was written number by number takes a robot's mass matrix again.
///
/// # Safety
/// The pointers are as the module's page says, for a robot with `DOF` joints.
#[cfg(feature = "functions")]
pub(crate) unsafe extern "C" fn mass_matrix<R: MassMatrix<DOF> + Default, const DOF: usize>(
    context: *mut c_void,
    q: *const f64,
    _qd: *const f64,
    _qdd: *const f64,
    out: *mut f64,
) {
    // SAFETY: `DOF` initialised numbers, which nobody writes while the reference lives.
    let q = unsafe { read::<DOF>(q) };
    let matrix = R::default().mass_matrix(q);
    black_box(&matrix);
    // SAFETY: room for a number; a context of ours, which nobody else has meanwhile.
    let results = unsafe {
        write(out, matrix[0][0]);
        &mut *context.cast::<Results>()
    };
    if results.keep {
        copy(&mut results.mass_matrix, &matrix);
    }
}

/// Both derivatives of the torques, as the mass matrix; an element goes to `out`. With `ALL`, torques and mass matrix
/// as well, which Pinocchio's function computes in passing.
///
/// # Safety
/// The pointers are as the module's page says, for a robot with `DOF` joints.
#[cfg(feature = "functions")]
pub(crate) unsafe extern "C" fn derivatives<R, const DOF: usize, const ALL: bool>(
    context: *mut c_void,
    q: *const f64,
    qd: *const f64,
    qdd: *const f64,
    out: *mut f64,
) where
    R: InverseDynamics<DOF> + MassMatrix<DOF> + InverseDynamicsDerivatives<DOF> + Default,
{
    // SAFETY: `DOF` initialised numbers each, which nobody writes while the references live.
    let (q, qd, qdd) = unsafe { (read::<DOF>(q), read::<DOF>(qd), read::<DOF>(qdd)) };
    let robot = R::default();
    let derivatives = robot.inverse_dynamics_derivatives(q, qd, qdd);
    black_box(&derivatives);
    // SAFETY: room for a number; a context of ours, which nobody else has meanwhile.
    let results = unsafe {
        write(out, derivatives.dq[0][0]);
        &mut *context.cast::<Results>()
    };
    if results.keep {
        copy(&mut results.by_q, &derivatives.dq);
        copy(&mut results.by_qd, &derivatives.dqd);
    }
    if ALL {
        let tau = robot.inverse_dynamics(q, qd, qdd);
        let matrix = robot.mass_matrix(q);
        black_box((&tau, &matrix));
        if results.keep {
            copy(&mut results.tau, &[tau]);
            copy(&mut results.mass_matrix, &matrix);
        }
    }
}

/// Rows one after the other, to the beginning of `place`.
#[cfg(feature = "functions")]
fn copy<const DOF: usize>(place: &mut [f64], rows: &[[f64; DOF]]) {
    let numbers = rows.as_flattened();
    place[..numbers.len()].copy_from_slice(numbers);
}

/// The numbers of each joint in an array from C.
///
/// # Safety
/// Joint j's numbers start at j·count; `DOF·count` initialised ones, which nobody writes meanwhile.
#[cfg(feature = "batch")]
unsafe fn joints<'a, const DOF: usize>(x: *const f64, count: usize) -> [&'a [f64]; DOF] {
    // SAFETY: as this function's.
    std::array::from_fn(|j| unsafe { std::slice::from_raw_parts(x.add(j * count), count) })
}

/// The functions of many states whose result is a vector of the joints.
#[cfg(feature = "batch")]
macro_rules! batches {
    ($($(#[$attribute:meta])* $name:ident: $capability:ident, $method:ident;)*) => {$(
        $(#[$attribute])*
        ///
        /// # Safety
        /// The pointers are as the module's page says, for `count` states of a robot with `DOF` joints.
        pub(crate) unsafe extern "C" fn $name<R: $capability<DOF> + Default, const DOF: usize>(
            _context: *mut c_void,
            q: *const f64,
            qd: *const f64,
            third: *const f64,
            out: *mut f64,
            count: usize,
        ) {
            // SAFETY: as this function's.
            let [q, qd, third] = [q, qd, third].map(|x| unsafe { joints::<DOF>(x, count) });
            // SAFETY: the same places of `out`: the slices of different joints do not overlap, nor do they overlap the
            // inputs. They are initialised, because the driver's memory is.
            let room =
                std::array::from_fn(|j| unsafe { std::slice::from_raw_parts_mut(out.add(j * count), count) });
            let done = R::default().$method(q, qd, third, room);
            // A panic aborts here: it cannot unwind out of `extern "C"`.
            assert!(done.is_ok(), "all slices have the same length");
        }
    )*};
}

#[cfg(feature = "batch")]
batches! {
    /// Torques of `count` states.
    batch: BatchInverseDynamics, inverse_dynamics_batch;
    /// Accelerations of `count` states.
    #[cfg(feature = "functions")]
    batch_forward_dynamics: BatchForwardDynamics, forward_dynamics_batch;
}

/// Mass matrices of `count` states, a block after the other in the context.
///
/// # Safety
/// The pointers are as the module's page says, for `count` states of a robot with `DOF` joints.
#[cfg(all(feature = "batch", feature = "functions"))]
pub(crate) unsafe extern "C" fn batch_mass_matrix<R: BatchMassMatrix<DOF> + Default, const DOF: usize>(
    context: *mut c_void,
    q: *const f64,
    _qd: *const f64,
    _qdd: *const f64,
    _out: *mut f64,
    count: usize,
) {
    // SAFETY: as this function's, and a context of ours, which nobody else has meanwhile.
    let (q, blocks) = unsafe { (joints::<DOF>(q, count), &mut *context.cast::<crate::blocks::Blocks>()) };
    // as Pinocchio, one half of the matrix
    blocks.compute(
        count,
        DOF * DOF,
        |element| element % DOF <= element / DOF,
        |states, mut rows| {
            let done = R::default().mass_matrix_batch(q.map(|x| &x[states.clone()]), rows.matrix());
            assert!(done.is_ok(), "all slices have the same length, or none");
        },
    );
}

/// Both derivatives of the torques of `count` states, as the mass matrices.
///
/// # Safety
/// The pointers are as the module's page says, for `count` states of a robot with `DOF` joints.
#[cfg(all(feature = "batch", feature = "functions"))]
pub(crate) unsafe extern "C" fn batch_derivatives<
    R: BatchInverseDynamicsDerivatives<DOF> + Default,
    const DOF: usize,
>(
    context: *mut c_void,
    q: *const f64,
    qd: *const f64,
    qdd: *const f64,
    _out: *mut f64,
    count: usize,
) {
    // SAFETY: as this function's.
    let arguments = [q, qd, qdd].map(|x| unsafe { joints::<DOF>(x, count) });
    // SAFETY: a context of ours, which nobody else has meanwhile.
    let blocks = unsafe { &mut *context.cast::<crate::blocks::Blocks>() };
    blocks.compute(
        count,
        2 * DOF * DOF,
        |_| true,
        |states, mut rows| {
            let [q, qd, qdd] = arguments.map(|joints| joints.map(|x| &x[states.clone()]));
            let (by_q, by_qd) = (rows.matrix(), rows.matrix());
            let done = R::default().inverse_dynamics_derivatives_batch(q, qd, qdd, by_q, by_qd);
            assert!(done.is_ok(), "all slices have the same length, or none");
        },
    );
}

/// Many states of an arm that is compiled at run time.
///
/// # Safety
/// The pointers are as the module's page says, for `count` states of the robot of the context.
#[cfg(feature = "machine")]
unsafe extern "C" fn machine(
    context: *mut c_void,
    q: *const f64,
    qd: *const f64,
    third: *const f64,
    out: *mut f64,
    count: usize,
) {
    use std::slice;
    // SAFETY: a context of ours, which nobody else has meanwhile.
    let machine = unsafe { &mut *context.cast::<crate::machine::Machine>() };
    let numbers = machine.dof() * count;
    // SAFETY: `numbers` initialised ones each, which nobody writes meanwhile.
    let arguments = [q, qd, third].map(|x| unsafe { slice::from_raw_parts(x, numbers) });
    // SAFETY: as many, which overlap nothing and are initialised, because the driver's memory is.
    machine.call(arguments, unsafe { slice::from_raw_parts_mut(out, numbers) }, count);
}

/// Competitor `k` of a robot.
fn competitor(robot: &Robot, k: c_int) -> Option<&'static (&'static CStr, Function)> {
    usize::try_from(k).ok().and_then(|k| robot.competitors.get(k))
}

/// The robot of this name.
///
/// # Safety
/// `robot` is a string of C, which outlives this call.
unsafe fn find(robot: *const c_char) -> Option<&'static Robot> {
    // SAFETY: as this function's.
    let name = unsafe { CStr::from_ptr(robot) };
    crate::ROBOTS.iter().find(|robot| robot.name.as_bytes() == name.to_bytes())
}

/// How many competitors there are.
#[unsafe(no_mangle)]
pub extern "C" fn rp_count() -> c_int {
    c_int::try_from(crate::ROBOTS[0].competitors.len()).expect("few competitors")
}

/// The name of competitor `k`.
#[unsafe(no_mangle)]
pub extern "C" fn rp_name(k: c_int) -> *const c_char {
    competitor(&crate::ROBOTS[0], k).map_or(ptr::null(), |(name, _)| name.as_ptr())
}

/// The kind of competitor `k`.
#[unsafe(no_mangle)]
pub extern "C" fn rp_kind(k: c_int) -> c_int {
    match competitor(&crate::ROBOTS[0], k) {
        Some((_, Function::InverseDynamics(_))) => 0,
        Some((_, Function::ForwardDynamics(_))) => 1,
        Some((_, Function::Batch(_))) => 3,
        Some((_, Function::BatchMatrices(..))) => 4,
        Some((_, Function::BatchForwardDynamics(_))) => 5,
        #[cfg(feature = "machine")]
        Some((_, Function::Machine(crate::machine::TORQUES))) => 3,
        #[cfg(feature = "machine")]
        Some((_, Function::Machine(crate::machine::FORWARD_DYNAMICS))) => 5,
        #[cfg(feature = "machine")]
        Some((_, Function::Machine(_))) => 4,
        Some((_, Function::Other(..) | Function::Matrices(..))) | None => 2,
    }
}

/// The function of competitor `k` for the robot of this name, or null.
///
/// # Safety
/// `robot` is a string of C.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rp_func(k: c_int, robot: *const c_char) -> *const c_void {
    // SAFETY: as this function's.
    match unsafe { find(robot) }.and_then(|robot| competitor(robot, k)) {
        Some((_, function)) => match function {
            Function::InverseDynamics(call)
            | Function::ForwardDynamics(call)
            | Function::Other(_, call)
            | Function::Matrices(_, call) => *call as *const c_void,
            Function::Batch(batch) | Function::BatchForwardDynamics(batch) | Function::BatchMatrices(_, batch) => {
                *batch as *const c_void
            }
            #[cfg(feature = "machine")]
            Function::Machine(_) => machine as *const c_void,
        },
        None => ptr::null(),
    }
}

/// The context of competitor `k`: room for results, or the compiled arm. It stays to the end of the process.
///
/// # Safety
/// `robot` is a string of C.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rp_open(k: c_int, robot: *const c_char, _folder: *const c_char) -> *mut c_void {
    // SAFETY: as this function's.
    let robot = unsafe { find(robot) };
    match robot.and_then(|robot| competitor(robot, k)) {
        #[cfg(feature = "machine")]
        Some((_, Function::Machine(function))) => {
            let file = robot.map_or("", |robot| robot.file);
            return ptr::from_mut(Box::leak(Box::new(crate::machine::Machine::new(file, *function)))).cast();
        }
        Some((_, Function::BatchMatrices(..))) => {
            return ptr::from_mut(Box::leak(Box::new(crate::blocks::Blocks::default()))).cast();
        }
        _ => {}
    }
    let nothing = [f64::NAN; MOST_JOINTS * MOST_JOINTS];
    let tau = [f64::NAN; MOST_JOINTS];
    let results = Results { keep: false, tau, mass_matrix: nothing, by_q: nothing, by_qd: nothing };
    ptr::from_mut(Box::leak(Box::new(results))).cast()
}

/// Whether the calls to come leave their results in the context.
///
/// # Safety
/// The context is one that [`rp_open`] made.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rp_keep(k: c_int, context: *mut c_void, keep: c_int) {
    // SAFETY: a context of ours, which nobody else has meanwhile.
    unsafe {
        match competitor(&crate::ROBOTS[0], k) {
            #[cfg(feature = "machine")]
            Some((_, Function::Machine(_))) => (*context.cast::<crate::machine::Machine>()).keeps_all = keep != 0,
            Some((_, Function::BatchMatrices(..))) => (*context.cast::<crate::blocks::Blocks>()).keeps_all = keep != 0,
            _ => (*context.cast::<Results>()).keep = keep != 0,
        }
    }
}

/// What competitor `k` computed in its last call with this context and `out`, or null.
///
/// # Safety
/// The context is one that [`rp_open`] made.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rp_result(k: c_int, context: *mut c_void, out: *const f64, what: c_int) -> *const f64 {
    match competitor(&crate::ROBOTS[0], k) {
        #[cfg(feature = "machine")]
        Some((_, Function::Machine(_))) => {
            // SAFETY: a context of ours, which nobody writes during this call.
            let machine = unsafe { &*context.cast::<crate::machine::Machine>() };
            return machine.matrices(what).map_or(ptr::null(), <[f64]>::as_ptr);
        }
        Some((_, Function::BatchMatrices(quantities, _))) => {
            // SAFETY: a context of ours, which nobody writes during this call.
            let blocks = unsafe { &*context.cast::<crate::blocks::Blocks>() };
            let place = quantities.iter().position(|quantity| *quantity == what);
            return place.map_or(ptr::null(), |place| blocks.part(place, quantities.len()).as_ptr());
        }
        Some((_, Function::Matrices(quantities, _))) if quantities.contains(&what) => {}
        Some((_, Function::Other(quantity, _))) if *quantity == what => return out,
        _ => return ptr::null(),
    }
    // SAFETY: a context of ours, which nobody writes during this call.
    let results = unsafe { &*context.cast::<Results>() };
    match what {
        quantity::TAU => results.tau.as_ptr(),
        quantity::MASS_MATRIX => results.mass_matrix.as_ptr(),
        quantity::DTAU_DQ => results.by_q.as_ptr(),
        quantity::DTAU_DQD => results.by_qd.as_ptr(),
        _ => ptr::null(),
    }
}
