//! What XLA calls: a C function that turns the call frame of XLA's foreign-function interface into slices.
//!
//! This is the only module of the package with `unsafe`: a call frame consists of C's pointers, and nothing else can
//! read it. The structs are those of `xla/ffi/api/c_api.h` (`jax.ffi.include_dir()` has it), as far as they are read
//! here. Before a struct is used, its `struct_size`, which XLA states, must reach to the last field that is read.
//! Before a pointer is used, it must not be NULL and must be aligned; lengths of axes are multiplied with checks, and
//! the result shares no memory with an argument. Enums of C are integers here, because C may put any number there. What
//! cannot be checked is XLA's promise: a pointer that is not NULL points to as much as the frame says, and stays so for
//! the call. No panic crosses the border.
#![allow(unsafe_code)]

use std::ffi::{CStr, c_char, c_int, c_void};
use std::mem::offset_of;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::{self, NonNull};
use std::sync::atomic::{AtomicI32, Ordering};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyCapsule;

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

/// What XLA calls, as a capsule for `jax.ffi.register_ffi_target`, where XLA has this version of the interface. A call
/// that asks for the version does not tell which one XLA has, and some XLA takes none but its own.
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
    // SAFETY: the pointer is that of a function, which stays as long as the process, and has no destructor.
    unsafe { PyCapsule::new_with_pointer(py, pointer, NAME) }
}

/// Computes the function that the attributes name; NULL says that all is well.
extern "C" fn handle(frame: *mut CallFrame) -> *mut c_void {
    let done = catch_unwind(AssertUnwindSafe(|| {
        // SAFETY: XLA's promise of the frame.
        unsafe { handled(frame) }
    }));
    let (code, message) = match done {
        Ok(Ok(())) => return ptr::null_mut(),
        Ok(Err(message)) => (INVALID_ARGUMENT, message),
        Err(_) => (INTERNAL, "a panic in the computation: this is a bug".to_owned()),
    };
    // SAFETY: the same.
    unsafe { error(frame, code, format!("rne: {message}")) }
}

/// # Safety
/// `frame` is NULL, or a call frame of XLA.
unsafe fn handled(frame: *mut CallFrame) -> Result<(), String> {
    // SAFETY: XLA's promise; its size is read first.
    let frame = unsafe { sized::<CallFrame>(frame, "the call frame")? };
    if !frame.extensions.is_null() {
        // SAFETY: XLA's promise of an extension.
        let extension = unsafe { sized::<Extension>(frame.extensions, "an extension")? };
        if extension.kind == METADATA {
            // SAFETY: the kind says what the extension is.
            return unsafe { tell_version(frame) };
        }
    }
    if frame.stage != EXECUTE {
        return Err(format!("stage {} of the call, but only stage {EXECUTE}, to execute, is known", frame.stage));
    }
    // SAFETY: XLA's promise of the lists of the frame, and of what they list.
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

/// Answers the question for the version.
///
/// # Safety
/// The first extension of the frame is a struct of the kind [`METADATA`].
unsafe fn tell_version(frame: &CallFrame) -> Result<(), String> {
    let extension = frame.extensions.cast::<MetadataExtension>();
    // SAFETY: the promise of the caller; sizes are read first.
    unsafe {
        let extension = sized::<MetadataExtension>(extension, "the metadata")?;
        let metadata = extension.metadata;
        // what comes behind is newer, and XLA's to fill
        let known = offset_of!(Metadata, traits) + size_of::<u32>();
        sized_pointer(metadata, known, "the metadata")?;
        let (major, minor) = (KNOWN.0, MINOR.load(Ordering::Relaxed));
        let version = ApiVersion { struct_size: size_of::<ApiVersion>(), extensions: ptr::null_mut(), major, minor };
        (&raw mut (*metadata).api_version).write(version);
        (&raw mut (*metadata).traits).write(0);
    }
    Ok(())
}

/// An error of XLA's; NULL, which says that all is well, only where XLA gives no way to make one.
///
/// # Safety
/// `frame` is NULL, or a call frame of XLA.
unsafe fn error(frame: *mut CallFrame, code: u32, message: String) -> *mut c_void {
    let mut message = message.replace('\0', " ").into_bytes();
    message.push(0);
    // SAFETY: XLA's promise of the frame; sizes are read first. The message outlives the call, which copies it.
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

/// The text of an attribute.
///
/// # Safety
/// XLA's promise of the attributes.
unsafe fn text<'a>(attributes: &'a Attributes, wanted: &str) -> Result<&'a str, String> {
    if attributes.struct_size < size_of::<Attributes>() {
        return Err("the attributes are of an older version of XLA".to_owned());
    }
    // SAFETY: XLA's promise: the lists have as many items as it says.
    unsafe {
        let kinds = listed(attributes.kinds, attributes.count, "the attributes")?;
        let names = listed(attributes.names, attributes.count, "the attributes")?;
        let items = listed(attributes.items, attributes.count, "the attributes")?;
        for ((&kind, &name), &item) in kinds.iter().zip(names).zip(items) {
            if span(name)? != wanted.as_bytes() {
                continue;
            }
            if kind != STRING {
                return Err(format!("the attribute `{wanted}` is no text"));
            }
            let text = span(item.cast())?;
            return str::from_utf8(text).map_err(|_| format!("the attribute `{wanted}` is no text in UTF-8"));
        }
    }
    Err(format!("there is no attribute `{wanted}`"))
}

/// # Safety
/// XLA's promise of the span.
unsafe fn span<'a>(pointer: *const ByteSpan) -> Result<&'a [u8], String> {
    // SAFETY: the promise of the caller.
    unsafe {
        refuse_wrong(pointer, "an attribute")?;
        let span = &*pointer;
        listed(span.start, i64::try_from(span.length).unwrap_or(-1), "an attribute")
    }
}

/// # Safety
/// XLA's promise of the list.
unsafe fn buffers<'a>(buffers: &'a Buffers, what: &str) -> Result<&'a [*const Buffer], String> {
    if buffers.struct_size < size_of::<Buffers>() {
        return Err(format!("{what} are of an older version of XLA"));
    }
    // SAFETY: the promise of the caller: the lists have as many items as it says.
    unsafe {
        let kinds = listed(buffers.kinds, buffers.count, what)?;
        if kinds.iter().any(|&kind| kind != BUFFER) {
            return Err(format!("{what} are not arrays only"));
        }
        listed(buffers.items, buffers.count, what)
    }
}

/// The lengths of the axes of an array, and how many numbers it has.
///
/// # Safety
/// XLA's promise of the lengths.
unsafe fn shape(buffer: &Buffer, what: &str) -> Result<(Vec<usize>, usize), String> {
    if usize::try_from(buffer.rank).map_or(true, |rank| rank > AXES) {
        return Err(format!("{what} has {} axes", buffer.rank));
    }
    // SAFETY: the promise of the caller.
    let lengths = unsafe { listed(buffer.dimensions, buffer.rank, what)? };
    let lengths: Option<Vec<usize>> = lengths.iter().map(|&length| usize::try_from(length).ok()).collect();
    let shape = lengths.ok_or_else(|| format!("{what} has an axis whose length is negative"))?;
    let count = shape.iter().try_fold(1_usize, |count, &length| count.checked_mul(length));
    Ok((shape, count.ok_or_else(|| format!("{what} is larger than memory"))?))
}

/// Whether the numbers of an array are of double precision, and their addresses, if they are numbers that can be used.
fn checked(buffer: &Buffer, count: usize, what: &str) -> Result<(bool, std::ops::Range<usize>), String> {
    let size = match buffer.dtype {
        F32 => size_of::<f32>(),
        F64 => size_of::<f64>(),
        other => {
            return Err(format!("{what} has the data type {other} of XLA; it is float32 ({F32}) or float64 ({F64})"));
        }
    };
    if count == 0 {
        return Ok((size == size_of::<f64>(), 0..0));
    }
    let start = buffer.data.addr();
    let bytes = count.checked_mul(size).filter(|&bytes| isize::try_from(bytes).is_ok());
    let end = bytes.and_then(|bytes| start.checked_add(bytes));
    let end = end.ok_or_else(|| format!("{what} is larger than memory"))?;
    if start == 0 || !start.is_multiple_of(size) {
        return Err(format!("{what} is NULL or not aligned"));
    }
    Ok((size == size_of::<f64>(), start..end))
}

/// # Safety
/// [`checked`] has let it pass, and it points to as many numbers.
unsafe fn slice<'a, T>(start: *const T, count: usize) -> &'a [T] {
    if count == 0 {
        return &[];
    }
    // SAFETY: it is not NULL, aligned, and no larger than memory; for the rest the promise of the caller.
    unsafe { std::slice::from_raw_parts(start, count) }
}

/// # Safety
/// [`checked`] has let it pass, and it points to as many numbers, which nobody else uses. Whatever bytes are there are
/// numbers; they are written to and not read.
unsafe fn slice_mut<'a, T>(start: *mut T, count: usize) -> &'a mut [T] {
    if count == 0 {
        return &mut [];
    }
    // SAFETY: it is not NULL, aligned, and no larger than memory; for the rest the promise of the caller.
    unsafe { std::slice::from_raw_parts_mut(start, count) }
}

/// The items of a list; no pointer is needed for an empty one.
///
/// # Safety
/// `start` is NULL or points to as many items.
unsafe fn listed<'a, T>(start: *const T, count: i64, what: &str) -> Result<&'a [T], String> {
    let count = usize::try_from(count).map_err(|_| format!("{what} have a negative number of items"))?;
    if count == 0 {
        return Ok(&[]);
    }
    refuse_wrong(start, what)?;
    if count.checked_mul(size_of::<T>()).is_none_or(|bytes| isize::try_from(bytes).is_err()) {
        return Err(format!("{what} are larger than memory"));
    }
    // SAFETY: it is not NULL, aligned, and no larger than memory; for the rest the promise of the caller.
    Ok(unsafe { std::slice::from_raw_parts(start, count) })
}

/// A struct that begins with its size, where that says that it is all there.
///
/// # Safety
/// `pointer` is NULL or points to a struct that begins with its size.
unsafe fn sized<'a, T>(pointer: *const T, what: &str) -> Result<&'a T, String> {
    // SAFETY: the promise of the caller; the size says that all fields are there.
    unsafe {
        sized_pointer(pointer, size_of::<T>(), what)?;
        Ok(&*pointer)
    }
}

/// Refuses a struct whose size says that it has fewer than `known` bytes.
///
/// # Safety
/// As of [`sized`].
unsafe fn sized_pointer<T>(pointer: *const T, known: usize, what: &str) -> Result<(), String> {
    refuse_wrong(pointer, what)?;
    // SAFETY: it is not NULL, and aligned; the struct begins with its size.
    let size = unsafe { pointer.cast::<usize>().read() };
    if size < known {
        return Err(format!("{what}: {size} bytes, but {known} are needed; this version of JAX is too old"));
    }
    Ok(())
}

fn refuse_wrong<T>(pointer: *const T, what: &str) -> Result<(), String> {
    if pointer.is_null() || !pointer.is_aligned() {
        return Err(format!("{what}: a pointer is NULL or not aligned"));
    }
    Ok(())
}
