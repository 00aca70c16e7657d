//! The calls of NVIDIA's driver. All functions of this module except launches are safe.
//!
//! The types of the calls are those of the header `cuda.h` of CUDA 12. There, handles are pointers to data that only
//! the driver reads; here they are numbers of the same size.
#![allow(unsafe_code)]

use std::error::Error as _;
use std::ffi::{CStr, CString, c_char, c_int, c_uint, c_void};
use std::path::Path;

use libloading::Library;

use crate::GpuError;

/// The error numbers with which the driver says that PTX could not be translated.
const INVALID_PTX: [c_int; 3] = [218, 221, 222];

macro_rules! calls {
    ($($name:ident = $symbol:literal ($($type:ty),*);)*) => {
        /// The library of the driver and its functions.
        #[derive(Debug)]
        pub(crate) struct Driver {
            $($name: unsafe extern "C" fn($($type),*) -> c_int,)*
            // a field after the functions, which are part of it: the library is dropped last
            _library: Library,
        }

        impl Driver {
            /// Opens the library of this name.
            pub(crate) fn open(name: &Path) -> Result<Self, GpuError> {
                // SAFETY: opening a library runs its initialisers. Its name is that of the driver, which the system
                // trusts like its kernel, or that in the variable RNE_LIBCUDA, with which the user of the program
                // chooses another library, as with LD_LIBRARY_PATH. Initialisers of a driver have no preconditions.
                let library = unsafe { Library::new(name) }.map_err(|error| GpuError::NoDriver {
                    library: name.to_owned(),
                    reason: error.source().map_or_else(|| error.to_string(), ToString::to_string),
                })?;
                $(
                    // SAFETY: the type is that of the function in `cuda.h`; for names ending in _v2 this type is fixed.
                    // The pointer lives no longer than the library, which is a field of the same struct.
                    let $name = *unsafe { library.get::<unsafe extern "C" fn($($type),*) -> c_int>($symbol) }
                        .map_err(|_| GpuError::OldDriver { library: name.to_owned(), call: symbol($symbol) })?;
                )*
                Ok(Self { $($name,)* _library: library })
            }
        }
    };
}

calls! {
    init = c"cuInit" (c_uint);
    device_count = c"cuDeviceGetCount" (*mut c_int);
    device_get = c"cuDeviceGet" (*mut c_int, c_int);
    device_name = c"cuDeviceGetName" (*mut c_char, c_int, c_int);
    retain = c"cuDevicePrimaryCtxRetain" (*mut usize, c_int);
    release = c"cuDevicePrimaryCtxRelease_v2" (c_int);
    push = c"cuCtxPushCurrent_v2" (usize);
    pop = c"cuCtxPopCurrent_v2" (*mut usize);
    synchronize = c"cuStreamSynchronize" (usize);
    load = c"cuModuleLoadDataEx" (*mut usize, *const c_char, c_uint, *const c_int, *const *mut c_void);
    unload = c"cuModuleUnload" (usize);
    function = c"cuModuleGetFunction" (*mut usize, usize, *const c_char);
    launch = c"cuLaunchKernel" (
        usize, c_uint, c_uint, c_uint, c_uint, c_uint, c_uint, c_uint, usize, *const *const c_void, *const *const c_void
    );
    allocate = c"cuMemAlloc_v2" (*mut u64, usize);
    free = c"cuMemFree_v2" (u64);
    upload = c"cuMemcpyHtoD_v2" (u64, *const c_void, usize);
    download = c"cuMemcpyDtoH_v2" (*mut c_void, u64, usize);
    error_name = c"cuGetErrorName" (c_int, *mut *const c_char);
    error_text = c"cuGetErrorString" (c_int, *mut *const c_char);
}

fn symbol(name: &CStr) -> String {
    name.to_string_lossy().into_owned()
}

/// The handle of the primary context of a device.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Context(usize);

/// The handle of a module.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Module(usize);

/// The handle of a kernel, and the number of its parameters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kernel {
    handle: usize,
    parameters: usize,
}

/// A number type of arrays on the card: `f32` or `f64`.
pub trait Real: sealed::Sealed + Copy {
    /// The precision of the kernels for this type.
    const PRECISION: rne_emit::Precision;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

impl Real for f32 {
    const PRECISION: rne_emit::Precision = rne_emit::Precision::Single;
}

impl Real for f64 {
    const PRECISION: rne_emit::Precision = rne_emit::Precision::Double;
}

/// Makes the pushed context no longer current when it is dropped.
struct Current<'a>(&'a Driver);

impl Drop for Current<'_> {
    fn drop(&mut self) {
        let mut context = 0;
        // SAFETY: writes the handle of the context that `push` made current
        let _ = unsafe { (self.0.pop)(&raw mut context) };
    }
}

impl Driver {
    fn checked(&self, call: &'static str, number: c_int) -> Result<(), GpuError> {
        if number == 0 {
            return Ok(());
        }
        let text = |of: unsafe extern "C" fn(c_int, *mut *const c_char) -> c_int| {
            let mut text = std::ptr::null();
            // SAFETY: writes the address of a text that is never freed, or null if the number is unknown
            let is_known = unsafe { of(number, &raw mut text) } == 0 && !text.is_null();
            if !is_known {
                return String::new();
            }
            // SAFETY: it points to a text that ends with 0, by the test above
            unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
        };
        Err(GpuError::Call { call, number, name: text(self.error_name), meaning: text(self.error_text) })
    }

    /// Returns the primary context of a device, which PyTorch, CuPy and JAX use, too, and the name of the device.
    pub(crate) fn context(&self, ordinal: usize) -> Result<(Context, String), GpuError> {
        // SAFETY: its argument is a number
        self.checked("cuInit", unsafe { (self.init)(0) })?;
        let mut count = 0;
        // SAFETY: writes a number to a valid place
        self.checked("cuDeviceGetCount", unsafe { (self.device_count)(&raw mut count) })?;
        let asked = c_int::try_from(ordinal).ok().filter(|asked| *asked < count);
        let asked = asked.ok_or(GpuError::NoDevice { ordinal, count: usize::try_from(count).unwrap_or(0) })?;
        let mut device = 0;
        // SAFETY: writes a number to a valid place
        self.checked("cuDeviceGet", unsafe { (self.device_get)(&raw mut device, asked) })?;
        let mut name = [0 as c_char; 256];
        // SAFETY: writes at most 256 bytes, with a final 0, to a buffer of 256 bytes
        self.checked("cuDeviceGetName", unsafe { (self.device_name)(name.as_mut_ptr(), 256, device) })?;
        // SAFETY: the text ends within the buffer
        let name = unsafe { CStr::from_ptr(name.as_ptr()) }.to_string_lossy().into_owned();
        let mut context = 0;
        // SAFETY: writes a handle to a valid place
        self.checked("cuDevicePrimaryCtxRetain", unsafe { (self.retain)(&raw mut context, device) })?;
        Ok((Context(context), name))
    }

    /// Releases the primary context of a device.
    pub(crate) fn release(&self, ordinal: usize) {
        // SAFETY: its argument is a number; each release follows one call of `context`
        let _ = unsafe { (self.release)(c_int::try_from(ordinal).unwrap_or(0)) };
    }

    /// Runs `work` with this context current, then restores the context that the thread had.
    fn within<R>(&self, context: Context, work: impl FnOnce() -> Result<R, GpuError>) -> Result<R, GpuError> {
        // SAFETY: the handle is that of a context that this crate has retained
        self.checked("cuCtxPushCurrent", unsafe { (self.push)(context.0) })?;
        let _current = Current(self);
        work()
    }

    /// Translates a text in PTX to a module.
    pub(crate) fn module(&self, context: Context, text: &str) -> Result<Module, GpuError> {
        const ERROR_LOG: c_int = 5;
        const ERROR_LOG_BYTES: c_int = 6;
        let text = CString::new(text).map_err(|_| GpuError::Translation { log: "a zero byte in the text".into() })?;
        let mut log = vec![0_u8; 8192];
        let options = [ERROR_LOG, ERROR_LOG_BYTES];
        // of this option the driver takes the value itself, the number of bytes, in the place of a pointer
        let values = [log.as_mut_ptr().cast::<c_void>(), std::ptr::without_provenance_mut(log.len())];
        let mut module = 0;
        self.within(context, || {
            // SAFETY: the text ends with 0; the two options have the two values that `cuda.h` asks for, and the log has
            // as many bytes as the second says; all of them live until the call returns
            let number = unsafe { (self.load)(&raw mut module, text.as_ptr(), 2, options.as_ptr(), values.as_ptr()) };
            if INVALID_PTX.contains(&number) {
                let log = String::from_utf8_lossy(&log).trim_matches(['\0', '\n', ' ']).to_owned();
                return Err(GpuError::Translation { log });
            }
            self.checked("cuModuleLoadDataEx", number)
        })?;
        Ok(Module(module))
    }

    /// Frees a module; no kernel of it may be launched afterwards.
    pub(crate) fn unload(&self, context: Context, module: Module) {
        // SAFETY: the handle is that of a module that `module` made; the arm that drops it has its only kernels, and
        // the driver itself waits for kernels that still run
        let _ = self.within(context, || self.checked("cuModuleUnload", unsafe { (self.unload)(module.0) }));
    }

    /// Returns the kernel of a module with this name, which has `parameters` parameters.
    pub(crate) fn kernel(
        &self,
        context: Context,
        module: Module,
        name: &str,
        parameters: usize,
    ) -> Result<Kernel, GpuError> {
        let name = CString::new(name).unwrap_or_default();
        let mut handle = 0;
        self.within(context, || {
            // SAFETY: `module` returned this module; the name ends with 0; the handle is written to a valid place
            let number = unsafe { (self.function)(&raw mut handle, module.0, name.as_ptr()) };
            self.checked("cuModuleGetFunction", number)
        })?;
        Ok(Kernel { handle, parameters })
    }

    /// Launches a kernel on a stream and does not wait for it.
    ///
    /// # Safety
    /// Each parameter has the bits of a value of the kernel's type. The addresses are those of memory that the device
    /// reaches, with as many numbers as the kernel reads and writes; nobody else writes to it, nor reads results, until
    /// the kernel has ended. The stream is 0 or one of this context.
    pub(crate) unsafe fn launch(
        &self,
        context: Context,
        kernel: Kernel,
        [blocks, width]: [u32; 2],
        stream: u64,
        parameters: &[u64],
    ) -> Result<(), GpuError> {
        assert_eq!(parameters.len(), kernel.parameters, "parameters of a kernel");
        // all processors for which there is a driver are little-endian, so a parameter of 32 bits is at the start of
        // its word
        let places: Vec<*const c_void> = parameters.iter().map(|word| (&raw const *word).cast()).collect();
        let stream = usize::try_from(stream).unwrap_or(0);
        self.within(context, || {
            // SAFETY: there are as many parameters as the kernel has, each with the 4 or 8 bytes that the driver copies
            // before the call returns; the caller promises the rest
            let number = unsafe {
                (self.launch)(kernel.handle, blocks, 1, 1, width, 1, 1, 0, stream, places.as_ptr(), std::ptr::null())
            };
            self.checked("cuLaunchKernel", number)
        })
    }

    /// Waits until the work of a stream is done.
    pub(crate) fn wait(&self, context: Context, stream: u64) -> Result<(), GpuError> {
        let stream = usize::try_from(stream).unwrap_or(0);
        self.within(context, || {
            // SAFETY: the driver checks the handle of a stream; 0 is the default stream
            self.checked("cuStreamSynchronize", unsafe { (self.synchronize)(stream) })
        })
    }

    /// Allocates memory on the card, at least one byte, and returns its address.
    pub(crate) fn allocate(&self, context: Context, bytes: usize) -> Result<u64, GpuError> {
        let mut address = 0;
        self.within(context, || {
            // SAFETY: writes an address to a valid place
            self.checked("cuMemAlloc", unsafe { (self.allocate)(&raw mut address, bytes.max(1)) })
        })?;
        Ok(address)
    }

    /// Frees memory from `allocate`, after the work that still runs.
    pub(crate) fn free(&self, context: Context, address: u64) {
        // SAFETY: the address comes from `allocate`, and it is freed once, when its owner is dropped
        let _ = self.within(context, || self.checked("cuMemFree", unsafe { (self.free)(address) }));
    }

    /// Copies numbers to memory from `allocate`, which must have room for them.
    pub(crate) fn upload<T: Real>(&self, context: Context, to: u64, numbers: &[T]) -> Result<(), GpuError> {
        self.within(context, || {
            // SAFETY: reads the bytes of the slice; the caller, in this crate, has allocated as many at `to`
            self.checked("cuMemcpyHtoD", unsafe { (self.upload)(to, numbers.as_ptr().cast(), size_of_val(numbers)) })
        })
    }

    /// Copies numbers from memory from `allocate`, which must contain as many.
    pub(crate) fn download<T: Real>(&self, context: Context, from: u64, numbers: &mut [T]) -> Result<(), GpuError> {
        self.within(context, || {
            let bytes = size_of_val(numbers);
            // SAFETY: writes the bytes of the slice, for which every pattern of bits is a number; `from` has as many
            self.checked("cuMemcpyDtoH", unsafe { (self.download)(numbers.as_mut_ptr().cast(), from, bytes) })
        })
    }
}
