//! Pointers from C as values, texts, references and slices, and back.

use std::ffi::{CStr, c_char};
use std::ops::Range;
use std::ptr;

use rne_machine::Number;

use crate::handle::Arm;
use crate::status::{self, Failure, Status};

/// Gives an arm that was made, or NULL.
///
/// # Safety
/// `place` is NULL or a place for a pointer.
pub(super) unsafe fn made(place: *mut *mut Arm, make: impl FnOnce() -> Result<Arm, Failure>) -> Status {
    status::status(|| {
        checked(place.cast_const(), 1, "arm")?;
        // SAFETY: it is not NULL, and aligned; for the rest the caller's promise of the place.
        unsafe { place.write(ptr::null_mut()) };
        let arm = Box::new(make()?);
        // SAFETY: the same.
        unsafe { place.write(Box::into_raw(arm)) };
        Ok(())
    })
}

/// Gives a value.
///
/// # Safety
/// `place` is NULL or a place for a value.
pub(super) unsafe fn give<T>(place: *mut T, what: &str, value: T) -> Result<(), Failure> {
    checked(place.cast_const(), 1, what)?;
    // SAFETY: it is not NULL, and aligned; for the rest the caller's promise of the place.
    unsafe { place.write(value) };
    Ok(())
}

/// What a pointer points to.
///
/// # Safety
/// It is NULL or points to a value that nobody changes as long as the reference is used.
pub(super) unsafe fn reference<'a, T>(pointer: *const T, what: &str) -> Result<&'a T, Failure> {
    checked(pointer, 1, what)?;
    // SAFETY: it is not NULL, and aligned; for the rest the caller's promise.
    Ok(unsafe { &*pointer })
}

/// A text of C's.
///
/// # Safety
/// `pointer` is NULL or its bytes end with a zero, and nobody changes them as long as the text is used.
pub(super) unsafe fn text<'a>(pointer: *const c_char, what: &str) -> Result<&'a str, Failure> {
    if pointer.is_null() {
        return Err(Failure::null(what));
    }
    // SAFETY: the caller's promise.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| Failure::new(Status::NotUtf8, format!("`{what}` is not text in UTF-8")))
}

/// The addresses of an array, if it can be one; empty where it has no values.
pub(super) fn checked<T>(pointer: *const T, count: usize, what: &str) -> Result<Range<usize>, Failure> {
    if count == 0 {
        return Ok(0..0);
    }
    if pointer.is_null() {
        return Err(Failure::null(what));
    }
    let start = pointer.addr();
    let bytes = count.checked_mul(size_of::<T>()).filter(|bytes| isize::try_from(*bytes).is_ok());
    match bytes.and_then(|bytes| start.checked_add(bytes)) {
        Some(end) if pointer.is_aligned() => Ok(start..end),
        Some(_) => {
            let message = format!("`{what}` is not aligned: its address is not a multiple of {}", align_of::<T>());
            Err(Failure::new(Status::WrongMemory, message))
        }
        None => {
            Err(Failure::new(Status::WrongMemory, format!("`{what}` has {count} values, more than fit into memory")))
        }
    }
}

/// An array of C's; no pointer is needed for an empty one.
///
/// # Safety
/// `pointer` is NULL or points to `count` values that nobody changes as long as the slice is used.
pub(super) unsafe fn slice<'a, T>(pointer: *const T, count: usize, what: &str) -> Result<&'a [T], Failure> {
    checked(pointer, count, what)?;
    if count == 0 {
        return Ok(&[]);
    }
    // SAFETY: it is not NULL, aligned, and no larger than memory; for the rest the caller's promise.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// An array of C's to be written to, which [`checked`] has let pass.
///
/// # Safety
/// It has room for `count` numbers, and nobody else uses it as long as the slice is used. Whatever bytes C has there
/// are numbers; they are written to and not read.
pub(super) unsafe fn slice_mut<'a, T: Number>(pointer: *mut T, count: usize) -> &'a mut [T] {
    if count == 0 {
        return &mut [];
    }
    // SAFETY: it is not NULL, aligned, and no larger than memory; for the rest the caller's promise.
    unsafe { std::slice::from_raw_parts_mut(pointer, count) }
}
