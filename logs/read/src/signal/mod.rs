//! Computations on sampled signals: even grids, filters, spectra, spikes.

pub(crate) mod convolution;
pub(crate) mod grid;
pub(crate) mod kernel;
pub(crate) mod median;
pub(crate) mod spectrum;
pub(crate) mod spikes;
