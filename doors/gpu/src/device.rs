//! A graphics card and memory on it.

use std::ffi::OsString;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::GpuError;
use crate::driver::{Context, Driver, Real};

/// A graphics card of NVIDIA with its primary context, which other libraries of this process share.
///
/// Clones refer to the same card.
#[derive(Clone, Debug)]
pub struct Device(Arc<Card>);

#[derive(Debug)]
struct Card {
    driver: Driver,
    context: Context,
    ordinal: usize,
    name: String,
}

impl Drop for Card {
    fn drop(&mut self) {
        self.driver.release(self.ordinal);
    }
}

/// The name of the driver's library.
const LIBRARY: &str = if cfg!(windows) { "nvcuda.dll" } else { "libcuda.so.1" };

impl Device {
    /// Opens the card with this number, from 0, in the order of `CUDA_VISIBLE_DEVICES`.
    ///
    /// The driver is the library `libcuda.so.1`, under Windows `nvcuda.dll`, or the library that the environment
    /// variable `RNE_LIBCUDA` names.
    ///
    /// # Errors
    /// When there is no driver or no such card.
    pub fn open(ordinal: usize) -> Result<Self, GpuError> {
        let library = std::env::var_os("RNE_LIBCUDA").unwrap_or_else(|| OsString::from(LIBRARY));
        Self::of_library(&PathBuf::from(library), ordinal)
    }

    pub(crate) fn of_library(library: &Path, ordinal: usize) -> Result<Self, GpuError> {
        let driver = Driver::open(library)?;
        let (context, name) = driver.context(ordinal)?;
        Ok(Self(Arc::new(Card { driver, context, ordinal, name })))
    }

    /// The name of the card.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// The number of the card.
    #[must_use]
    pub fn ordinal(&self) -> usize {
        self.0.ordinal
    }

    /// Allocates memory for some numbers, all zero.
    ///
    /// # Errors
    /// When the card has too little memory.
    pub fn zeros<T: Real + Default>(&self, numbers: usize) -> Result<Memory<T>, GpuError> {
        self.upload(&vec![T::default(); numbers])
    }

    /// Copies numbers to new memory on the card.
    ///
    /// # Errors
    /// When the card has too little memory.
    pub fn upload<T: Real>(&self, numbers: &[T]) -> Result<Memory<T>, GpuError> {
        let address = self.driver().allocate(self.context(), size_of_val(numbers))?;
        let memory = Memory { device: self.clone(), address, length: numbers.len(), numbers: PhantomData };
        if !numbers.is_empty() {
            self.driver().upload(self.context(), address, numbers)?;
        }
        Ok(memory)
    }

    /// Waits until everything that was launched on a stream has been computed; 0 is the default stream.
    ///
    /// # Errors
    /// When something that was launched failed.
    pub fn wait(&self, stream: u64) -> Result<(), GpuError> {
        self.driver().wait(self.context(), stream)
    }

    pub(crate) fn driver(&self) -> &Driver {
        &self.0.driver
    }

    pub(crate) fn context(&self) -> Context {
        self.0.context
    }

    pub(crate) fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// Numbers in the memory of a card.
#[derive(Debug)]
pub struct Memory<T: Real> {
    device: Device,
    address: u64,
    length: usize,
    numbers: PhantomData<T>,
}

impl<T: Real> Memory<T> {
    /// How many numbers there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.length
    }

    /// Whether there is no number.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// The address on the card.
    #[must_use]
    pub fn address(&self) -> u64 {
        self.address
    }

    /// Copies all numbers to the processor.
    ///
    /// # Errors
    /// When something that was launched before failed.
    pub fn download(&self) -> Result<Vec<T>, GpuError>
    where
        T: Default,
    {
        let mut numbers = vec![T::default(); self.length];
        if !self.is_empty() {
            self.device.driver().download(self.device.context(), self.address, &mut numbers)?;
        }
        Ok(numbers)
    }

    pub(crate) fn is_on(&self, device: &Device) -> bool {
        self.device.is(device)
    }
}

impl<T: Real> Drop for Memory<T> {
    fn drop(&mut self) {
        self.device.driver().free(self.device.context(), self.address);
    }
}
