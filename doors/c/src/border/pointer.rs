//! Pointers from C as values, texts, references and slices, and back.

use std::ffi::{CStr, c_char};
use std::ops::Range;
use std::ptr;

use rne_machine::Number;

use crate::handle::Arm;
use crate::status::{self, Failure, Status};

/// Makes an arm and writes a pointer to it to `place`, or NULL if it cannot be made.
///
/// # Safety
/// `place` is NULL or a place for a pointer.
pub(super) unsafe fn made(place: *mut *mut Arm, make: impl FnOnce() -> Result<Arm, Failure>) -> Status {
    status::status(|| {
        checked(place.cast_const(), 1, "arm")?;
        // SAFETY: it is not NULL, and aligned; the caller promises that it is valid.
        unsafe { place.write(ptr::null_mut()) };
        let arm = Box::new(make()?);
        // SAFETY: as for the write of NULL above.
        unsafe { place.write(Box::into_raw(arm)) };
        Ok(())
    })
}

/// Writes a value to `place`.
///
/// # Safety
/// `place` is NULL or a place for a value.
pub(super) unsafe fn give<T>(place: *mut T, what: &str, value: T) -> Result<(), Failure> {
    checked(place.cast_const(), 1, what)?;
    // SAFETY: it is not NULL, and aligned; the caller promises that it is valid.
    unsafe { place.write(value) };
    Ok(())
}

/// Returns a reference to the value at `pointer`, or an error if it is NULL or not aligned.
///
/// # Safety
/// It is NULL or points to a value that nobody changes as long as the reference is used.
pub(super) unsafe fn reference<'a, T>(pointer: *const T, what: &str) -> Result<&'a T, Failure> {
    checked(pointer, 1, what)?;
    // SAFETY: it is not NULL, and aligned; the caller promises that it is valid.
    Ok(unsafe { &*pointer })
}

/// Returns a text of C, or an error if it is NULL or no UTF-8.
///
/// # Safety
/// `pointer` is NULL or its bytes end with a zero, and nobody changes them as long as the text is used.
pub(super) unsafe fn text<'a>(pointer: *const c_char, what: &str) -> Result<&'a str, Failure> {
    if pointer.is_null() {
        return Err(Failure::null(what));
    }
    // SAFETY: it is not NULL; the caller promises that it ends with a zero byte.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| Failure::new(Status::NotUtf8, format!("`{what}` is not text in UTF-8")))
}

/// Returns the range of addresses of an array, or an error if memory cannot contain such an array. The range is empty
/// if the array has no values.
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

/// Returns an array of C as a slice. The pointer of an empty array may be NULL.
///
/// # Safety
/// `pointer` is NULL or points to `count` values that nobody changes as long as the slice is used.
pub(super) unsafe fn slice<'a, T>(pointer: *const T, count: usize, what: &str) -> Result<&'a [T], Failure> {
    checked(pointer, count, what)?;
    if count == 0 {
        return Ok(&[]);
    }
    // SAFETY: it is not NULL, aligned, and no larger than memory; the caller promises that its values are valid.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// Returns an array of C as a slice to be written to. [`checked`] must have accepted it.
///
/// # Safety
/// It has room for `count` numbers, and nobody else uses it as long as the slice is used. Any bytes are valid numbers;
/// they are written and not read.
pub(super) unsafe fn slice_mut<'a, T: Number>(pointer: *mut T, count: usize) -> &'a mut [T] {
    if count == 0 {
        return &mut [];
    }
    // SAFETY: it is not NULL, aligned, and no larger than memory; the caller promises that it is valid.
    unsafe { std::slice::from_raw_parts_mut(pointer, count) }
}
