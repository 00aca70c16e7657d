//! The C function that XLA calls. It turns the call frame of XLA's foreign-function interface into slices.
//!
//! This is the only module of the package with `unsafe`: a call frame consists of C's pointers, and nothing else can
//! read it. The structs are those of `xla/ffi/api/c_api.h` (`jax.ffi.include_dir()` has it), as far as they are read
//! here. Before a struct is used, its `struct_size`, which XLA states, must reach to the last field that is read.
//! Before a pointer is used, it must not be NULL and must be aligned; lengths of axes are multiplied with checks, and
//! the result shares no memory with an argument. Enums of C are integers here, because C may put any number there. The
//! rest cannot be checked and is XLA's promise: a pointer that is not NULL points to as much as the frame says, and
//! stays so for the call. No panic crosses the border.
#![allow(unsafe_code)]

mod checked;

use std::ffi::{CStr, c_char, c_int, c_void};
use std::mem::offset_of;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::{self, NonNull};
use std::sync::atomic::{AtomicI32, Ordering};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyCapsule;

use self::checked::{buffers, checked, shape, sized, sized_pointer, slice, slice_mut, text};
use super::{Argument, Call, Numbers, Room, compute};

/// The newest version of the interface whose structs are known here. A minor version only adds fields at the end.
const KNOWN: (c_int, c_int) = (0, 3);

/// The minor version that this module reports to XLA. XLA must know this version.
static MINOR: AtomicI32 = AtomicI32::new(KNOWN.1);

/// Values of C's enums.
const METADATA: u32 = 1;
const EXECUTE: u32 = 3;
const BUFFER: u32 = 1;
const STRING: u32 = 4;
const F32: u32 = 11;
const F64: u32 = 12;
const INVALID_ARGUMENT: u32 = 3;
const INTERNAL: u32 = 13;

/// The largest number of axes of an array.
const AXES: usize = 64;

#[repr(C)]
struct Extension {
    struct_size: usize,
    kind: u32,
    next: *mut Extension,
}

#[repr(C)]
#[derive(Clone, Copy)]
struct ApiVersion {
    struct_size: usize,
    extensions: *mut Extension,
    major: c_int,
    minor: c_int,
}

#[repr(C)]
struct Metadata {
    struct_size: usize,
    api_version: ApiVersion,
    traits: u32,
}

#[repr(C)]
struct MetadataExtension {
    base: Extension,
    metadata: *mut Metadata,
}

#[repr(C)]
struct ErrorArguments {
    struct_size: usize,
    extensions: *mut Extension,
    message: *const c_char,
    code: u32,
}

#[repr(C)]
struct Api {
    struct_size: usize,
    extensions: *mut Extension,
    version: ApiVersion,
    internal: *const c_void,
    create_error: Option<unsafe extern "C" fn(*mut ErrorArguments) -> *mut c_void>,
}

#[repr(C)]
struct ByteSpan {
    start: *const u8,
    length: usize,
}

#[repr(C)]
struct Buffer {
    struct_size: usize,
    extensions: *mut Extension,
    dtype: u32,
    data: *mut c_void,
    rank: i64,
    dimensions: *const i64,
}

/// The arguments, or the results: their kinds, and what they are.
#[repr(C)]
struct Buffers {
    struct_size: usize,
    extensions: *mut Extension,
    count: i64,
    kinds: *const u32,
    items: *const *const Buffer,
}

#[repr(C)]
struct Attributes {
    struct_size: usize,
    extensions: *mut Extension,
    count: i64,
    kinds: *const u32,
    names: *const *const ByteSpan,
    /// Those of texts are spans.
    items: *const *const c_void,
}

#[repr(C)]
struct CallFrame {
    struct_size: usize,
    extensions: *mut Extension,
    api: *const Api,
    context: *mut c_void,
    stage: u32,
    arguments: Buffers,
    results: Buffers,
    attributes: Attributes,
}

/// Returns the function that XLA calls, as a capsule for `jax.ffi.register_ffi_target`, if XLA has this version of the
/// interface. The version must be given, because a call in which XLA asks for the version does not tell which one XLA
/// has, and some versions of XLA accept only their own.
pub(super) fn capsule(py: Python<'_>, version: (c_int, c_int)) -> PyResult<Bound<'_, PyCapsule>> {
    const NAME: &CStr = c"xla._CUSTOM_CALL_TARGET";
    let (major, minor) = version;
    if major != KNOWN.0 || minor < 0 {
        return Err(PyRuntimeError::new_err(format!(
            "JAX has version {major}.{minor} of XLA's foreign-function interface, but rne knows {}.0 to {}.{}: install \
             another version of JAX",
            KNOWN.0, KNOWN.0, KNOWN.1
        )));
    }
    MINOR.store(minor.min(KNOWN.1), Ordering::Relaxed);
    let handler: extern "C" fn(*mut CallFrame) -> *mut c_void = handle;
    let pointer = NonNull::new(handler as *mut c_void).unwrap_or(NonNull::dangling());
    // SAFETY: the pointer is that of a function, which exists as long as the process and needs no destructor.
    unsafe { PyCapsule::new_with_pointer(py, pointer, NAME) }
}

/// Computes the function that the attributes name; NULL says that all is well.
extern "C" fn handle(frame: *mut CallFrame) -> *mut c_void {
    let done = catch_unwind(AssertUnwindSafe(|| {
        // SAFETY: XLA promises that the frame is valid.
        unsafe { handled(frame) }
    }));
    let (code, message) = match done {
        Ok(Ok(())) => return ptr::null_mut(),
        Ok(Err(message)) => (INVALID_ARGUMENT, message),
        Err(_) => (INTERNAL, "a panic in the computation: this is a bug".to_owned()),
    };
    // SAFETY: XLA promises that the frame is valid.
    unsafe { error(frame, code, format!("rne: {message}")) }
}

/// # Safety
/// `frame` is NULL, or a call frame of XLA.
unsafe fn handled(frame: *mut CallFrame) -> Result<(), String> {
    // SAFETY: XLA promises that the frame is valid; its size is read first.
    let frame = unsafe { sized::<CallFrame>(frame, "the call frame")? };
    if !frame.extensions.is_null() {
        // SAFETY: XLA promises that an extension is valid.
        let extension = unsafe { sized::<Extension>(frame.extensions, "an extension")? };
        if extension.kind == METADATA {
            // SAFETY: its kind says that this extension has metadata.
            return unsafe { tell_version(frame) };
        }
    }
    if frame.stage != EXECUTE {
        return Err(format!("stage {} of the call, but only stage {EXECUTE}, to execute, is known", frame.stage));
    }
    // SAFETY: XLA promises that the lists of the frame and their items are valid.
    unsafe {
        let arm = text(&frame.attributes, "arm")?;
        let function = text(&frame.attributes, "function")?;
        let arguments = buffers(&frame.arguments, "the arguments")?;
        let results = buffers(&frame.results, "the results")?;
        let &[result] = results else { return Err(format!("{} results, but there is one", results.len())) };
        let result = sized::<Buffer>(result, "the result")?;
        let (shape, count) = shape(result, "the result")?;
        let (_, written) = checked(result, count, "the result")?;
        let mut all = Vec::with_capacity(arguments.len());
        for (index, &buffer) in arguments.iter().enumerate() {
            let what = format!("argument {index}");
            let buffer = sized::<Buffer>(buffer, &what)?;
            let (shape, count) = self::shape(buffer, &what)?;
            let (is_double, read) = checked(buffer, count, &what)?;
            if read.start < written.end && written.start < read.end {
                return Err(format!("{what} shares memory with the result"));
            }
            let numbers = if is_double {
                Numbers::Double(slice(buffer.data.cast(), count))
            } else {
                Numbers::Single(slice(buffer.data.cast(), count))
            };
            all.push(Argument { shape, numbers });
        }
        let room = if result.dtype == F64 {
            Room::Double(slice_mut(result.data.cast(), count))
        } else {
            Room::Single(slice_mut(result.data.cast(), count))
        };
        compute(Call { arm, function, arguments: all, shape, room })
    }
}

/// Answers XLA's question which version of the interface this module has.
///
/// # Safety
/// The first extension of the frame is a struct of the kind [`METADATA`].
unsafe fn tell_version(frame: &CallFrame) -> Result<(), String> {
    let extension = frame.extensions.cast::<MetadataExtension>();
    // SAFETY: promised by the caller; sizes are read first.
    unsafe {
        let extension = sized::<MetadataExtension>(extension, "the metadata")?;
        let metadata = extension.metadata;
        // fields after these are newer, and XLA fills them
        let known = offset_of!(Metadata, traits) + size_of::<u32>();
        sized_pointer(metadata, known, "the metadata")?;
        let (major, minor) = (KNOWN.0, MINOR.load(Ordering::Relaxed));
        let version = ApiVersion { struct_size: size_of::<ApiVersion>(), extensions: ptr::null_mut(), major, minor };
        (&raw mut (*metadata).api_version).write(version);
        (&raw mut (*metadata).traits).write(0);
    }
    Ok(())
}

/// Returns an error of XLA. If XLA offers no way to make one, it returns NULL, which means success.
///
/// # Safety
/// `frame` is NULL, or a call frame of XLA.
unsafe fn error(frame: *mut CallFrame, code: u32, message: String) -> *mut c_void {
    let mut message = message.replace('\0', " ").into_bytes();
    message.push(0);
    // SAFETY: XLA promises that the frame is valid; sizes are read first. The message outlives the call, which copies
    // it.
    unsafe {
        if sized_pointer(frame, offset_of!(CallFrame, context), "").is_err() {
            return ptr::null_mut();
        }
        let api = (&raw const (*frame).api).read();
        let api = sized::<Api>(api, "");
        let Ok(Some(create)) = api.map(|api| api.create_error) else { return ptr::null_mut() };
        let mut arguments = ErrorArguments {
            struct_size: offset_of!(ErrorArguments, code) + size_of::<u32>(),
            extensions: ptr::null_mut(),
            message: message.as_ptr().cast(),
            code,
        };
        create(&raw mut arguments)
    }
}
