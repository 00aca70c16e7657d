//! Checks the pointers that XLA passes, and returns what they point to.

use super::{AXES, Attributes, BUFFER, Buffer, Buffers, ByteSpan, F32, F64, STRING};

/// Returns the text of the attribute with the name `wanted`.
///
/// # Safety
/// The attributes must come from XLA in this call: each list pointer is NULL or points to as many items as XLA says.
pub(super) unsafe fn text<'a>(attributes: &'a Attributes, wanted: &str) -> Result<&'a str, String> {
    if attributes.struct_size < size_of::<Attributes>() {
        return Err("the attributes are of an older version of XLA".to_owned());
    }
    // SAFETY: XLA promises that the lists have as many items as it says.
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
/// XLA must promise that the span is valid.
pub(super) unsafe fn span<'a>(pointer: *const ByteSpan) -> Result<&'a [u8], String> {
    // SAFETY: promised by the caller.
    unsafe {
        refuse_wrong(pointer, "an attribute")?;
        let span = &*pointer;
        listed(span.start, i64::try_from(span.length).unwrap_or(-1), "an attribute")
    }
}

/// # Safety
/// XLA must promise that the list is valid.
pub(super) unsafe fn buffers<'a>(buffers: &'a Buffers, what: &str) -> Result<&'a [*const Buffer], String> {
    if buffers.struct_size < size_of::<Buffers>() {
        return Err(format!("{what} are of an older version of XLA"));
    }
    // SAFETY: the caller promises that the lists have as many items as they say.
    unsafe {
        let kinds = listed(buffers.kinds, buffers.count, what)?;
        if kinds.iter().any(|&kind| kind != BUFFER) {
            return Err(format!("{what} are not arrays only"));
        }
        listed(buffers.items, buffers.count, what)
    }
}

/// Returns the lengths of the axes of an array, and how many numbers it has.
///
/// # Safety
/// XLA must promise that the lengths are valid.
pub(super) unsafe fn shape(buffer: &Buffer, what: &str) -> Result<(Vec<usize>, usize), String> {
    if usize::try_from(buffer.rank).map_or(true, |rank| rank > AXES) {
        return Err(format!("{what} has {} axes", buffer.rank));
    }
    // SAFETY: promised by the caller.
    let lengths = unsafe { listed(buffer.dimensions, buffer.rank, what)? };
    let lengths: Option<Vec<usize>> = lengths.iter().map(|&length| usize::try_from(length).ok()).collect();
    let shape = lengths.ok_or_else(|| format!("{what} has an axis whose length is negative"))?;
    let count = shape.iter().try_fold(1_usize, |count, &length| count.checked_mul(length));
    Ok((shape, count.ok_or_else(|| format!("{what} is larger than memory"))?))
}

/// Returns whether the numbers of an array are in double precision, and their addresses. Returns an error if they are
/// of another type or cannot be used.
pub(super) fn checked(buffer: &Buffer, count: usize, what: &str) -> Result<(bool, std::ops::Range<usize>), String> {
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
/// [`checked`] has accepted it, and it points to as many numbers.
pub(super) unsafe fn slice<'a, T>(start: *const T, count: usize) -> &'a [T] {
    if count == 0 {
        return &[];
    }
    // SAFETY: it is not NULL, aligned, and no larger than memory; the caller promises the rest.
    unsafe { std::slice::from_raw_parts(start, count) }
}

/// # Safety
/// [`checked`] has accepted it, and it points to as many numbers, which nobody else uses. Any bytes there are valid
/// numbers; they are written and not read.
pub(super) unsafe fn slice_mut<'a, T>(start: *mut T, count: usize) -> &'a mut [T] {
    if count == 0 {
        return &mut [];
    }
    // SAFETY: it is not NULL, aligned, and no larger than memory; the caller promises the rest.
    unsafe { std::slice::from_raw_parts_mut(start, count) }
}

/// Returns the items of a list; the pointer of an empty list may be NULL.
///
/// # Safety
/// `start` is NULL or points to as many items.
pub(super) unsafe fn listed<'a, T>(start: *const T, count: i64, what: &str) -> Result<&'a [T], String> {
    let count = usize::try_from(count).map_err(|_| format!("{what} have a negative number of items"))?;
    if count == 0 {
        return Ok(&[]);
    }
    refuse_wrong(start, what)?;
    if count.checked_mul(size_of::<T>()).is_none_or(|bytes| isize::try_from(bytes).is_err()) {
        return Err(format!("{what} are larger than memory"));
    }
    // SAFETY: it is not NULL, aligned, and no larger than memory; the caller promises the rest.
    Ok(unsafe { std::slice::from_raw_parts(start, count) })
}

/// Returns a struct that begins with its size, if this size says that it has all fields.
///
/// # Safety
/// `pointer` is NULL or points to a struct that begins with its size.
pub(super) unsafe fn sized<'a, T>(pointer: *const T, what: &str) -> Result<&'a T, String> {
    // SAFETY: promised by the caller; the size says that all fields exist.
    unsafe {
        sized_pointer(pointer, size_of::<T>(), what)?;
        Ok(&*pointer)
    }
}

/// Returns an error for a struct whose size says that it has fewer than `known` bytes.
///
/// # Safety
/// As for [`sized`].
pub(super) unsafe fn sized_pointer<T>(pointer: *const T, known: usize, what: &str) -> Result<(), String> {
    refuse_wrong(pointer, what)?;
    // SAFETY: it is not NULL, and aligned; the struct begins with its size.
    let size = unsafe { pointer.cast::<usize>().read() };
    if size < known {
        return Err(format!("{what}: {size} bytes, but {known} are needed; this version of JAX is too old"));
    }
    Ok(())
}

pub(super) fn refuse_wrong<T>(pointer: *const T, what: &str) -> Result<(), String> {
    if pointer.is_null() || !pointer.is_aligned() {
        return Err(format!("{what}: a pointer is NULL or not aligned"));
    }
    Ok(())
}
