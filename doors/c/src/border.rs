//! The functions that C calls. Only here pointers become texts, slices and references.
//!
//! Every `unsafe` function trusts its caller in what C cannot express: that a pointer which is not NULL points to as
//! many values as the call states, for the duration of the call. The following is checked: NULL, alignment, sizes
//! beyond memory, and outputs that share memory with an input. No panic reaches the caller.
#![allow(unsafe_code)]

mod pointer;

use std::ffi::c_char;
use std::ptr;

use rne_convert::Selection;
use rne_machine::{Function, Number};

use pointer::{checked, give, made, reference, slice, slice_mut, text};

use crate::evaluation::{self, Given};
use crate::handle::{self, Arm, JointKind, Limits};
use crate::status::{self, Failure, Status, guarded};

/// An argument of a function, in double precision. Element j of state s is data[s * state_stride + j * element_stride].
///
/// `{.name = "q", .data = q, .count = 6}` is one row for all states; with .state_stride = 6 it is a row for each.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Input {
    /// Which argument: "q", "qd", "qdd", "tau", …; rne_function_argument() tells them.
    pub name: *const c_char,
    /// Its numbers. They are read during the call alone.
    pub data: *const f64,
    /// How many numbers there are at data; reading ends before.
    pub count: usize,
    /// How far apart states are, in numbers; 0 where all states have the same. One state needs none.
    pub state_stride: usize,
    /// How far apart elements are, in numbers; 0 means 1.
    pub element_stride: usize,
}

/// An argument of a function, in single precision: as rne_input.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct InputF32 {
    /// Which argument.
    pub name: *const c_char,
    /// Its numbers.
    pub data: *const f32,
    /// How many numbers there are at data.
    pub count: usize,
    /// How far apart states are; 0 where all states have the same.
    pub state_stride: usize,
    /// How far apart elements are; 0 means 1.
    pub element_stride: usize,
}

/// The version of this library, such as "0.1.0": a text that stays.
#[unsafe(no_mangle)]
pub extern "C" fn rne_version() -> *const c_char {
    status::VERSION.as_ptr()
}

/// Why the last call of this thread that failed did: one line or, of a file, several. Empty before the first.
///
/// The text is this library's, and stays until the next failure of the same thread. A success leaves it as it is.
#[unsafe(no_mangle)]
pub extern "C" fn rne_last_error() -> *const c_char {
    status::last_error()
}

/// Reads a robot file, and the plan file beside it (NAME.plan.yaml) where there is one; or gives a built-in robot, if
/// `path` is its name and no file.
///
/// `path` is in UTF-8; one that is relative starts at the working directory. The arm goes to `*arm`, to be freed by
/// rne_arm_free(); after a failure `*arm` is NULL. The same text read again gives the same arm, compiled.
///
/// # Safety
/// `path` is NULL or ends with a zero byte; `arm` is NULL or a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_arm_load_file(path: *const c_char, arm: *mut *mut Arm) -> Status {
    // SAFETY: the caller promises that both pointers are valid.
    unsafe { made(arm, || Arm::of_file(text(path, "path")?)) }
}

/// Reads the text of a robot file: as rne_arm_load_file().
///
/// # Safety
/// `yaml` is NULL or ends with a zero byte; `arm` is NULL or a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_arm_load_text(yaml: *const c_char, arm: *mut *mut Arm) -> Status {
    // SAFETY: the caller promises that both pointers are valid.
    unsafe { made(arm, || Arm::of_text(text(yaml, "yaml")?)) }
}

/// Makes an arm of a chain of a URDF, in standard rows; no angle is taken for a near multiple of pi/12.
///
/// `base` and `tip` name the links at its ends: NULL is the root, and the one leaf of the tree. The movable joints
/// `lock_names[0 … lock_count - 1]` stand still at `lock_values`, rad or m; with `lock_others` every other movable
/// joint off the chain does, at zero.
///
/// # Safety
/// `path`, `base`, `tip` and the names are NULL or end with a zero byte; there are `lock_count` names and values; `arm`
/// is NULL or a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_arm_load_urdf(
    path: *const c_char,
    base: *const c_char,
    tip: *const c_char,
    lock_names: *const *const c_char,
    lock_values: *const f64,
    lock_count: usize,
    lock_others: bool,
    arm: *mut *mut Arm,
) -> Status {
    // SAFETY: the caller promises that all pointers are valid.
    unsafe {
        made(arm, || {
            let path = text(path, "path")?;
            let optional = |link: *const c_char, what: &str| {
                if link.is_null() { Ok(None) } else { text(link, what).map(|link| Some(link.to_owned())) }
            };
            let names = slice(lock_names, lock_count, "lock_names")?;
            let values = slice(lock_values, lock_count, "lock_values")?;
            let lock =
                names.iter().zip(values).map(|(name, value)| Ok((text(*name, "lock_names[…]")?.to_owned(), *value)));
            let lock = lock.collect::<Result<_, Failure>>()?;
            let (base, tip) = (optional(base, "base")?, optional(tip, "tip")?);
            Arm::of_urdf(path, Selection { base, tip, lock, lock_others, ..Selection::default() })
        })
    }
}

/// A robot of the box by its name, "puma560" say, with its plan.
///
/// # Safety
/// `name` is NULL or ends with a zero byte; `arm` is NULL or a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_arm_builtin(name: *const c_char, arm: *mut *mut Arm) -> Status {
    // SAFETY: the caller promises that both pointers are valid.
    unsafe { made(arm, || Arm::of_name(text(name, "name")?)) }
}

/// Makes an arm with a frame in the place of the tip: the pose, the Jacobian, its rate and derivatives, and the torques
/// of a wrench are those of the frame. The other functions of the new arm are those of the tip.
///
/// `frame` is the name of a frame in the list `frames` of the robot file, or the name of a joint for its link frame.
/// The new arm goes to `*at`, to be freed by rne_arm_free() as `arm` is; either may be freed first. After a failure
/// `*at` is NULL.
///
/// # Safety
/// `arm` is NULL or an arm; `frame` is NULL or ends with a zero byte; `at` is NULL or a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_arm_at_frame(arm: *const Arm, frame: *const c_char, at: *mut *mut Arm) -> Status {
    // SAFETY: the caller promises that all pointers are valid.
    unsafe { made(at, || reference(arm, "arm")?.at_frame(text(frame, "frame")?)) }
}

/// Frees an arm, and the names that it gave out; NULL is let pass. No other call may be using it, or use it later.
///
/// # Safety
/// `arm` is NULL or an arm that was not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_arm_free(arm: *mut Arm) {
    if !arm.is_null() {
        // SAFETY: every arm that C has comes from `Box::into_raw`, and the caller frees it once.
        let arm = unsafe { Box::from_raw(arm) };
        let _ = guarded(|| {
            drop(arm);
            Ok(())
        });
    }
}

/// The robot's name: a text of the arm's, which goes with it. NULL when `arm` is.
///
/// # Safety
/// `arm` is NULL or an arm.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_arm_name(arm: *const Arm) -> *const c_char {
    // SAFETY: the caller promises that the arm is valid.
    guarded(|| Ok(unsafe { reference(arm, "arm") }?.name().as_ptr())).unwrap_or(ptr::null())
}

/// How many joints it has; 0 when `arm` is NULL.
///
/// # Safety
/// `arm` is NULL or an arm.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_arm_dof(arm: *const Arm) -> usize {
    // SAFETY: the caller promises that the arm is valid.
    guarded(|| Ok(unsafe { reference(arm, "arm") }?.compiled().dof())).unwrap_or(0)
}

/// The name of a joint, counted from 0 at the base: a text of the arm's, which goes with it. NULL when there is no such
/// joint, or `arm` is NULL.
///
/// # Safety
/// `arm` is NULL or an arm.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_arm_joint_name(arm: *const Arm, joint: usize) -> *const c_char {
    // SAFETY: the caller promises that the arm is valid.
    guarded(|| Ok(unsafe { reference(arm, "arm") }?.joint_name(joint)?.as_ptr())).unwrap_or(ptr::null())
}

/// Whether a joint turns or slides: which units its numbers have.
///
/// # Safety
/// `arm` is NULL or an arm; `kind` is NULL or a place for it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_arm_joint_kind(arm: *const Arm, joint: usize, kind: *mut JointKind) -> Status {
    // SAFETY: the caller promises that both pointers are valid.
    status::status(|| unsafe { give(kind, "kind", reference(arm, "arm")?.joint_kind(joint)?) })
}

/// What a joint may do, by the robot file.
///
/// # Safety
/// `arm` is NULL or an arm; `limits` is NULL or a place for them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_arm_joint_limits(arm: *const Arm, joint: usize, limits: *mut Limits) -> Status {
    // SAFETY: the caller promises that both pointers are valid.
    status::status(|| unsafe { give(limits, "limits", reference(arm, "arm")?.limits(joint)?) })
}

/// The id of a function by its name: "inverse_dynamics", "mass_matrix", …; `docs/reference/functions.md` has them all.
/// An id is that of every arm. It may be another in another version of this library: do not store it.
///
/// # Safety
/// `name` is NULL or ends with a zero byte; `id` is NULL or a place for a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_function_find(name: *const c_char, id: *mut u32) -> Status {
    // SAFETY: the caller promises that both pointers are valid.
    status::status(|| unsafe { give(id, "id", handle::function_id(text(name, "name")?)?) })
}

/// How many functions there are: their ids are 0 and those up to it.
#[unsafe(no_mangle)]
pub extern "C" fn rne_function_count() -> u32 {
    u32::try_from(Function::ALL.len()).unwrap_or(u32::MAX)
}

/// Compiles a function of an arm now, in some ten milliseconds; otherwise its first use does.
///
/// # Safety
/// `arm` is NULL or an arm.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_function_prepare(arm: *const Arm, id: u32) -> Status {
    // SAFETY: the caller promises that the arm is valid.
    status::status(|| unsafe { reference(arm, "arm") }?.prepare(id))
}

/// How many numbers a function returns for a state: a matrix row by row, a pose as the rotation row by row and then the
/// translation, a wrench as force and then moment.
///
/// # Safety
/// `arm` is NULL or an arm; `outputs` is NULL or a place for a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_function_outputs(arm: *const Arm, id: u32, outputs: *mut usize) -> Status {
    // SAFETY: the caller promises that both pointers are valid.
    status::status(|| unsafe { give(outputs, "outputs", reference(arm, "arm")?.function(id)?.outputs()) })
}

/// How many arguments a function takes. It is compiled for it, as by rne_function_prepare().
///
/// # Safety
/// `arm` is NULL or an arm; `arguments` is NULL or a place for a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_function_arguments(arm: *const Arm, id: u32, arguments: *mut usize) -> Status {
    // SAFETY: the caller promises that both pointers are valid.
    status::status(|| unsafe { give(arguments, "arguments", reference(arm, "arm")?.function(id)?.arguments().len()) })
}

/// An argument of a function, counted from 0: its name and how many elements it has for a state. The name stays as long
/// as the program. Either place may be NULL.
///
/// # Safety
/// `arm` is NULL or an arm; `name` and `elements` are NULL or places for a pointer and a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_function_argument(
    arm: *const Arm,
    id: u32,
    argument: usize,
    name: *mut *const c_char,
    elements: *mut usize,
) -> Status {
    status::status(|| {
        // SAFETY: the caller promises that the arm is valid.
        let (found, count) = unsafe { reference(arm, "arm") }?.argument(id, argument)?;
        // both pointers are checked before anything is written
        checked(name.cast_const(), usize::from(!name.is_null()), "name")?;
        checked(elements.cast_const(), usize::from(!elements.is_null()), "elements")?;
        if !name.is_null() {
            // SAFETY: `name` was checked to be aligned, and the caller promises that it is valid.
            unsafe { name.write(found.as_ptr()) };
        }
        if !elements.is_null() {
            // SAFETY: `elements` was checked to be aligned, and the caller promises that it is valid.
            unsafe { elements.write(count) };
        }
        Ok(())
    })
}

/// Computes a function for one state, in double precision.
///
/// `outputs` has room for `output_count` numbers, just as many as rne_function_outputs() tells. Inputs that the
/// function does not take are not read. After a failure nothing has been written. The second call of a thread and those
/// that follow allocate nothing, take no lock and do not call the operating system; the first allocates what the thread
/// keeps, and compiles the function unless rne_function_prepare() has. A failure allocates its message.
///
/// # Safety
/// `arm` is NULL or an arm; there are `input_count` inputs with as many numbers as they say, and room for
/// `output_count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_evaluate(
    arm: *const Arm,
    id: u32,
    inputs: *const Input,
    input_count: usize,
    outputs: *mut f64,
    output_count: usize,
) -> Status {
    // SAFETY: the caller promises that all pointers are valid.
    unsafe { evaluate(arm, id, Extent::One, inputs, input_count, outputs, output_count) }
}

/// Computes a function for so many states, in double precision, in the calling thread, on its widest vector unit.
///
/// `outputs` has room for `output_count` numbers: `states` rows of as many as rne_function_outputs() tells. Each row
/// has the bits that rne_evaluate() gives that state. Otherwise as rne_evaluate(), but that some hundred bytes are
/// allocated.
///
/// # Safety
/// As rne_evaluate().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_evaluate_batch(
    arm: *const Arm,
    id: u32,
    states: usize,
    inputs: *const Input,
    input_count: usize,
    outputs: *mut f64,
    output_count: usize,
) -> Status {
    // SAFETY: the caller promises that all pointers are valid.
    unsafe { evaluate(arm, id, Extent::Many(states), inputs, input_count, outputs, output_count) }
}

/// rne_evaluate_batch() in so many threads, the caller's among them; `threads` of 0 is one for each core.
///
/// The others are started and end within the call, each with some thousand states at a time: fewer states take fewer
/// threads. Every row has the bits that it has otherwise. Where the system gives no thread, those that there are do
/// all.
///
/// # Safety
/// As rne_evaluate().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_evaluate_batch_threads(
    arm: *const Arm,
    id: u32,
    threads: usize,
    states: usize,
    inputs: *const Input,
    input_count: usize,
    outputs: *mut f64,
    output_count: usize,
) -> Status {
    // SAFETY: the caller promises that all pointers are valid.
    unsafe { evaluate(arm, id, Extent::Threads(states, threads), inputs, input_count, outputs, output_count) }
}

/// rne_evaluate() in single precision.
///
/// # Safety
/// As rne_evaluate().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_evaluate_f32(
    arm: *const Arm,
    id: u32,
    inputs: *const InputF32,
    input_count: usize,
    outputs: *mut f32,
    output_count: usize,
) -> Status {
    // SAFETY: the caller promises that all pointers are valid.
    unsafe { evaluate(arm, id, Extent::One, inputs, input_count, outputs, output_count) }
}

/// rne_evaluate_batch() in single precision.
///
/// # Safety
/// As rne_evaluate().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_evaluate_batch_f32(
    arm: *const Arm,
    id: u32,
    states: usize,
    inputs: *const InputF32,
    input_count: usize,
    outputs: *mut f32,
    output_count: usize,
) -> Status {
    // SAFETY: the caller promises that all pointers are valid.
    unsafe { evaluate(arm, id, Extent::Many(states), inputs, input_count, outputs, output_count) }
}

/// rne_evaluate_batch_threads() in single precision.
///
/// # Safety
/// As rne_evaluate().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rne_evaluate_batch_threads_f32(
    arm: *const Arm,
    id: u32,
    threads: usize,
    states: usize,
    inputs: *const InputF32,
    input_count: usize,
    outputs: *mut f32,
    output_count: usize,
) -> Status {
    // SAFETY: the caller promises that all pointers are valid.
    unsafe { evaluate(arm, id, Extent::Threads(states, threads), inputs, input_count, outputs, output_count) }
}

/// An input of either precision, `rne_input` or `rne_input_f32`.
trait Raw<T>: Copy {
    /// Returns the name, the address of the numbers, their count, and the strides of states and of elements.
    fn parts(self) -> (*const c_char, *const T, usize, usize, usize);
}

impl Raw<f64> for Input {
    fn parts(self) -> (*const c_char, *const f64, usize, usize, usize) {
        (self.name, self.data, self.count, self.state_stride, self.element_stride)
    }
}

impl Raw<f32> for InputF32 {
    fn parts(self) -> (*const c_char, *const f32, usize, usize, usize) {
        (self.name, self.data, self.count, self.state_stride, self.element_stride)
    }
}

/// The states of a call: one, many in this thread, or many on several threads (states, threads).
#[derive(Clone, Copy)]
enum Extent {
    One,
    Many(usize),
    Threads(usize, usize),
}

/// Computes a function for the states that `extent` says, and returns the status of the call.
///
/// # Safety
/// As for [`rne_evaluate`].
unsafe fn evaluate<T: Number + Send + Sync, I: Raw<T>>(
    arm: *const Arm,
    id: u32,
    extent: Extent,
    inputs: *const I,
    input_count: usize,
    outputs: *mut T,
    output_count: usize,
) -> Status {
    status::status(|| {
        // SAFETY: the caller promises that the arm and the array of inputs are valid.
        let (arm, inputs) = unsafe { (reference(arm, "arm")?, slice(inputs, input_count, "inputs")?) };
        let room = checked(outputs.cast_const(), output_count, "outputs")?;
        let read = |(index, input): (usize, &I)| {
            let (name, data, count, state, element) = input.parts();
            // SAFETY: the caller promises that the name and the numbers are valid and that nobody writes to them during
            // the call. The outputs do not overlap them either: this is checked below, before the slice is used.
            let given = unsafe {
                let name = text(name, "name of an input")
                    .map_err(|Failure { status, message }| Failure::new(status, format!("input {index}: {message}")))?;
                let within = checked(data, count, name)?;
                if within.start < room.end && room.start < within.end {
                    let message = format!("`outputs` and `{name}` share memory");
                    return Err(Failure::new(Status::WrongMemory, message));
                }
                Given { name, numbers: slice(data, count, name)?, state, element }
            };
            Ok(given)
        };
        // the array of inputs must not overlap the outputs either
        let array = checked(inputs.as_ptr(), inputs.len(), "inputs")?;
        if array.start < room.end && room.start < array.end {
            return Err(Failure::new(Status::WrongMemory, "`outputs` and `inputs` share memory"));
        }
        // SAFETY: the caller promises memory for the outputs; by the checks above it overlaps nothing that is read.
        let outputs = unsafe { slice_mut(outputs, output_count) };
        let given = inputs.iter().enumerate().map(read);
        match extent {
            Extent::One => evaluation::one(arm, id, given, outputs),
            Extent::Many(states) => evaluation::many(arm, id, states, given, outputs),
            Extent::Threads(states, threads) => evaluation::on_threads(arm, id, (states, threads), given, outputs),
        }
    })
}
