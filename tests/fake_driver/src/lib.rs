//! A library that tests load in the place of `libcuda.so.1`: it has the calls that `rne-gpu` and `benches/gpu/run.py`
//! make. Memory of the card is memory of the process, and the interpreter of PTX runs kernels, before a launch returns.
//! A thread that reads or writes outside of memory that was allocated here makes the launch fail with
//! `CUDA_ERROR_ILLEGAL_ADDRESS`.
//!
//! Pointers are those that the documentation of the driver asks for; that they are right is the caller's duty, as it is
//! with the driver. [`fakeCount`] tells a test what was called.
#![allow(
    unsafe_code,
    unused_unsafe,
    non_snake_case,
    clippy::missing_panics_doc,
    clippy::missing_safety_doc,
    clippy::not_unsafe_ptr_arg_deref
)]

use std::alloc::{Layout, alloc_zeroed, dealloc};
use std::collections::{BTreeMap, HashMap};
use std::ffi::{CStr, c_char, c_float, c_int, c_uint, c_void};
use std::panic::catch_unwind;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use ptx_interpreter::{Kernel, Memory, read};

const SUCCESS: c_int = 0;
const INVALID_VALUE: c_int = 1;
const OUT_OF_MEMORY: c_int = 2;
const INVALID_DEVICE: c_int = 101;
const INVALID_CONTEXT: c_int = 201;
const INVALID_PTX: c_int = 218;
const NOT_FOUND: c_int = 500;
const ILLEGAL_ADDRESS: c_int = 700;

/// The bytes of memory of the card.
const MEMORY: usize = 1 << 28;
/// The handle of the only context.
const CONTEXT: usize = 0xC0;

#[derive(Default)]
struct Card {
    /// Bytes from each address.
    memory: Allocated,
    modules: Vec<HashMap<String, Arc<Kernel>>>,
    functions: Vec<Arc<Kernel>>,
    events: Vec<Instant>,
    /// What [`fakeCount`] tells.
    counts: [u64; 6],
}

/// The bytes from each address that were allocated here, and those of [`fakeMap`].
#[derive(Default)]
struct Allocated(BTreeMap<u64, usize>, BTreeMap<u64, usize>);

impl Allocated {
    /// Panics where the bytes were not allocated.
    fn check(&self, address: u64, bytes: usize) -> *mut u8 {
        let is_inside = [&self.0, &self.1].into_iter().any(|parts| {
            let found = parts.range(..=address).next_back();
            found.is_some_and(|(start, size)| address + bytes as u64 <= start + *size as u64)
        });
        assert!(is_inside, "{bytes} bytes at {address:#x} were not allocated");
        address as *mut u8
    }
}

impl Memory for Allocated {
    fn load(&self, address: u64, bytes: usize) -> u64 {
        let from = self.check(address, bytes);
        let mut word = [0; 8];
        // SAFETY: these bytes are of an allocation
        unsafe { std::ptr::copy_nonoverlapping(from, word.as_mut_ptr(), bytes) };
        u64::from_le_bytes(word)
    }

    fn store(&mut self, address: u64, bytes: usize, number: u64) {
        let to = self.check(address, bytes);
        // SAFETY: these bytes are of an allocation
        unsafe { std::ptr::copy_nonoverlapping(number.to_le_bytes().as_ptr(), to, bytes) };
    }
}

static CARD: Mutex<Option<Card>> = Mutex::new(None);

fn with<R>(work: impl FnOnce(&mut Card) -> R) -> R {
    let mut card: MutexGuard<'_, Option<Card>> = CARD.lock().unwrap_or_else(PoisonError::into_inner);
    work(card.get_or_insert_default())
}

/// Counts since the library was loaded, by their index: 0 launches, 1 calls that wait for the card, 2 the stream of the
/// last launch, 3 the blocks of the last launch, 4 modules that were translated, 5 contexts that are current.
#[unsafe(no_mangle)]
pub extern "C" fn fakeCount(which: c_int) -> u64 {
    with(|card| usize::try_from(which).ok().and_then(|which| card.counts.get(which).copied()).unwrap_or(0))
}

/// Lets kernels read and write memory of the process that was not allocated here, as that of a library.
#[unsafe(no_mangle)]
pub extern "C" fn fakeMap(address: u64, bytes: usize) {
    with(|card| card.memory.1.insert(address, bytes));
}

macro_rules! calls {
    ($($(#[$about:meta])* fn $name:ident($($argument:ident: $type:ty),*) $body:block)*) => {
        $($(#[$about])* #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($($argument: $type),*) -> c_int {
            // SAFETY: the caller's pointers are those that the documentation of this call asks for
            unsafe { $body }
        })*
    };
}

calls! {
    /// Does nothing.
    fn cuInit(flags: c_uint) { if flags == 0 { SUCCESS } else { INVALID_VALUE } }

    /// The version 12.0.
    fn cuDriverGetVersion(version: *mut c_int) { *version = 12000; SUCCESS }

    /// One device.
    fn cuDeviceGetCount(count: *mut c_int) { *count = 1; SUCCESS }

    /// The device 0.
    fn cuDeviceGet(device: *mut c_int, ordinal: c_int) {
        *device = 0;
        if ordinal == 0 { SUCCESS } else { INVALID_DEVICE }
    }

    /// A name that no card has.
    fn cuDeviceGetName(name: *mut c_char, length: c_int, _device: c_int) {
        write_text(name.cast(), usize::try_from(length).unwrap_or(0), "no card: the fake driver of rne");
        SUCCESS
    }

    /// A number, the same for each attribute.
    fn cuDeviceGetAttribute(value: *mut c_int, _attribute: c_int, _device: c_int) { *value = 7; SUCCESS }

    /// The context.
    fn cuDevicePrimaryCtxRetain(context: *mut usize, _device: c_int) { *context = CONTEXT; SUCCESS }

    /// Does nothing.
    fn cuDevicePrimaryCtxRelease_v2(_device: c_int) { SUCCESS }

    /// Makes the context current.
    fn cuCtxSetCurrent(_context: usize) { with(|card| card.counts[5] = 1); SUCCESS }

    /// Makes the context current until it is popped.
    fn cuCtxPushCurrent_v2(context: usize) {
        if context == CONTEXT { with(|card| card.counts[5] += 1); SUCCESS } else { INVALID_CONTEXT }
    }

    /// Makes the context before current.
    fn cuCtxPopCurrent_v2(context: *mut usize) {
        *context = CONTEXT;
        with(|card| match card.counts[5].checked_sub(1) {
            Some(count) => { card.counts[5] = count; SUCCESS }
            None => INVALID_CONTEXT,
        })
    }

    /// Returns at once: nothing is pending.
    fn cuCtxSynchronize() { with(|card| card.counts[1] += 1); SUCCESS }

    /// Returns at once: nothing is pending.
    fn cuStreamSynchronize(_stream: usize) { with(|card| card.counts[1] += 1); SUCCESS }

    /// Free memory and all memory.
    fn cuMemGetInfo_v2(free: *mut usize, total: *mut usize) {
        *free = MEMORY - with(|card| card.memory.0.values().sum::<usize>());
        *total = MEMORY;
        SUCCESS
    }

    /// Memory of the process, at least one byte.
    fn cuMemAlloc_v2(address: *mut u64, bytes: usize) {
        with(|card| {
            let used = card.memory.0.values().sum::<usize>();
            let layout = Layout::from_size_align(bytes, 256);
            let (Ok(layout), true) = (layout, bytes > 0 && used + bytes <= MEMORY) else { return OUT_OF_MEMORY };
            *address = alloc_zeroed(layout) as u64;
            card.memory.0.insert(*address, bytes);
            SUCCESS
        })
    }

    /// Frees what was allocated.
    fn cuMemFree_v2(address: u64) {
        with(|card| {
            let Some(bytes) = card.memory.0.remove(&address) else { return INVALID_VALUE };
            dealloc(address as *mut u8, Layout::from_size_align(bytes, 256).expect("a layout"));
            SUCCESS
        })
    }

    /// Copies to the card.
    fn cuMemcpyHtoD_v2(to: u64, from: *const c_void, bytes: usize) { copy(from as u64, to, bytes, [false, true]) }

    /// Copies from the card.
    fn cuMemcpyDtoH_v2(to: *mut c_void, from: u64, bytes: usize) { copy(from, to as u64, bytes, [true, false]) }

    /// Copies on the card.
    fn cuMemcpyDtoD_v2(to: u64, from: u64, bytes: usize) { copy(from, to, bytes, [true, true]) }

    /// Reads PTX; the option 5 is the place for what is wrong with it, and the option 6 the bytes of this place.
    fn cuModuleLoadDataEx(
        module: *mut usize, image: *const c_char, count: c_uint, options: *const c_int, values: *const *mut c_void
    ) {
        let text = CStr::from_ptr(image).to_string_lossy().into_owned();
        let place = |which| (0..count as usize).find(|&index| *options.add(index) == which);
        let option = |which| place(which).map(|index| *values.add(index));
        let Ok(kernels) = catch_unwind(|| read(&text)) else {
            if let (Some(place), Some(bytes)) = (option(5), option(6)) {
                write_text(place.cast(), bytes as usize, "line 1: error: this is not PTX that rne writes");
            }
            return INVALID_PTX;
        };
        with(|card| {
            card.counts[4] += 1;
            card.modules.push(kernels.into_iter().map(|(name, kernel)| (name, Arc::new(kernel))).collect());
            *module = card.modules.len();
            SUCCESS
        })
    }

    /// Keeps the module: functions of it may still be called.
    fn cuModuleUnload(_module: usize) { SUCCESS }

    /// A kernel by its name.
    fn cuModuleGetFunction(function: *mut usize, module: usize, name: *const c_char) {
        let name = CStr::from_ptr(name).to_string_lossy().into_owned();
        with(|card| {
            let found = card.modules.get(module.wrapping_sub(1)).and_then(|kernels| kernels.get(&name)).cloned();
            let Some(kernel) = found else { return NOT_FOUND };
            card.functions.push(kernel);
            *function = card.functions.len();
            SUCCESS
        })
    }

    /// A number, the same for each attribute.
    fn cuFuncGetAttribute(value: *mut c_int, _attribute: c_int, _function: usize) { *value = 0; SUCCESS }

    /// Runs all threads, one after the other.
    fn cuLaunchKernel(
        function: usize, blocks: c_uint, blocks_y: c_uint, blocks_z: c_uint, width: c_uint, width_y: c_uint,
        width_z: c_uint, shared: c_uint, stream: usize, parameters: *const *const c_void, _extra: usize
    ) {
        with(|card| {
            let Some(kernel) = card.functions.get(function.wrapping_sub(1)).cloned() else { return INVALID_VALUE };
            let is_possible = kernel.required_width().is_none_or(|required| required == width) && width <= 256;
            if [blocks_y, blocks_z, width_y, width_z, shared] != [1, 1, 1, 1, 0] || !is_possible || blocks == 0 {
                return INVALID_VALUE;
            }
            if card.counts[5] == 0 {
                return INVALID_CONTEXT;
            }
            let values: Vec<u64> = kernel
                .parameters()
                .iter()
                .enumerate()
                .map(|(index, parameter)| {
                    let value = *parameters.add(index);
                    if parameter.bytes == 8 { *value.cast::<u64>() } else { u64::from(*value.cast::<u32>()) }
                })
                .collect();
            card.counts[0] += 1;
            card.counts[2] = stream as u64;
            card.counts[3] = blocks.into();
            let memory = &mut card.memory;
            let run = std::panic::AssertUnwindSafe(|| kernel.launch(memory, &values, blocks, width));
            if catch_unwind(run).is_ok() { SUCCESS } else { ILLEGAL_ADDRESS }
        })
    }

    /// A new event.
    fn cuEventCreate(event: *mut usize, _flags: c_uint) {
        with(|card| {
            card.events.push(Instant::now());
            *event = card.events.len();
            SUCCESS
        })
    }

    /// Stores the time.
    fn cuEventRecord(event: usize, _stream: usize) {
        with(|card| {
            let Some(time) = card.events.get_mut(event.wrapping_sub(1)) else { return INVALID_VALUE };
            *time = Instant::now();
            SUCCESS
        })
    }

    /// Returns at once: nothing is pending.
    fn cuEventSynchronize(_event: usize) { with(|card| card.counts[1] += 1); SUCCESS }

    /// The time between two events, in ms.
    fn cuEventElapsedTime(milliseconds: *mut c_float, from: usize, to: usize) {
        with(|card| {
            let time = |event: usize| card.events.get(event.wrapping_sub(1)).copied();
            let (Some(from), Some(to)) = (time(from), time(to)) else { return INVALID_VALUE };
            *milliseconds = 1e3 * (to - from).as_secs_f32();
            SUCCESS
        })
    }

    /// The name of an error.
    fn cuGetErrorName(error: c_int, name: *mut *const c_char) { *name = words(error)[0].as_ptr(); SUCCESS }

    /// The meaning of an error.
    fn cuGetErrorString(error: c_int, text: *mut *const c_char) { *text = words(error)[1].as_ptr(); SUCCESS }
}

fn words(error: c_int) -> [&'static CStr; 2] {
    match error {
        SUCCESS => [c"CUDA_SUCCESS", c"no error"],
        OUT_OF_MEMORY => [c"CUDA_ERROR_OUT_OF_MEMORY", c"out of memory"],
        INVALID_DEVICE => [c"CUDA_ERROR_INVALID_DEVICE", c"invalid device ordinal"],
        INVALID_CONTEXT => [c"CUDA_ERROR_INVALID_CONTEXT", c"invalid device context"],
        INVALID_PTX => [c"CUDA_ERROR_INVALID_PTX", c"a PTX JIT compilation failed"],
        NOT_FOUND => [c"CUDA_ERROR_NOT_FOUND", c"named symbol not found"],
        ILLEGAL_ADDRESS => [c"CUDA_ERROR_ILLEGAL_ADDRESS", c"an illegal memory access was encountered"],
        _ => [c"CUDA_ERROR_INVALID_VALUE", c"invalid argument"],
    }
}

/// Writes a text that fits, and its end.
unsafe fn write_text(place: *mut u8, bytes: usize, text: &str) {
    let text = &text.as_bytes()[..text.len().min(bytes.saturating_sub(1))];
    if bytes > 0 {
        // SAFETY: the caller's memory has this number of bytes
        unsafe {
            std::ptr::copy_nonoverlapping(text.as_ptr(), place, text.len());
            *place.add(text.len()) = 0;
        }
    }
}

/// Copies bytes; those that are of the card must have been allocated.
unsafe fn copy(from: u64, to: u64, bytes: usize, [is_from_card, is_to_card]: [bool; 2]) -> c_int {
    with(|card| {
        card.counts[1] += 1;
        let memory = &card.memory;
        let check = |address, is_of_card: bool| {
            !is_of_card || catch_unwind(std::panic::AssertUnwindSafe(|| memory.check(address, bytes))).is_ok()
        };
        if !check(from, is_from_card) || !check(to, is_to_card) {
            return INVALID_VALUE;
        }
        // SAFETY: allocated here, or given by the caller
        unsafe { std::ptr::copy(from as *const u8, to as *mut u8, bytes) };
        SUCCESS
    })
}
