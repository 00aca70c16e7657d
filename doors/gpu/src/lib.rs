//! Functions of a robot arm on a graphics card of NVIDIA: many states at once, a thread per state.
//!
//! A [`GpuArm`] writes the functions of a [`CompiledArm`] as kernels of PTX, which the driver of the card translates.
//! The driver's library is opened when the program runs, so neither CUDA's toolkit nor a card is needed to build a
//! program with this crate. The results have the bits of the processor with fused multiply-add.
//!
//! ```
//! use rne_gpu::{Device, GpuArm, GpuError, GpuRollout, Order};
//! use rne_machine::{CompiledArm, Function};
//!
//! let rod = "
//! format: 1
//! name: rod
//! source: own
//! convention: standard
//! gravity: [0, -9.81, 0]
//! joints: [{type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0]}}]
//! ";
//! let arm = CompiledArm::from_yaml(rod)?;
//! let device = match Device::open(0) {
//!     Ok(device) => device,
//!     Err(error) => {
//!         eprintln!("{error}"); // no NVIDIA driver: libcuda.so.1 was not found …
//!         return Ok(());
//!     }
//! };
//! let gpu = GpuArm::new(&arm, &device);
//! let q = device.upload(&[0.0_f32, 0.1, 0.2])?; // rad, three states
//! let mut tau = device.zeros(3)?;
//! gpu.run(Function::GravityTorques, Order::Rows, 3, &[("q", &q)], &mut tau)?;
//! assert!((tau.download()?[0] - 2.5 * 9.81 * 0.4).abs() < 1e-5);
//!
//! // three samples move on by ten steps of 10 ms
//! let (qd, tau) = (device.zeros::<f32>(3)?, device.zeros(3 * 10)?);
//! let (mut positions, mut velocities) = (device.zeros(3 * 10)?, device.zeros(3 * 10)?);
//! let arguments = [("q", &q), ("qd", &qd), ("tau", &tau)];
//! let states = [&mut positions, &mut velocities];
//! gpu.rollout(&GpuRollout::new(10, 0.01), Order::Columns, 3, &arguments, states)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arm;
mod device;
mod driver;
mod error;
#[cfg(test)]
mod tests;

pub use arm::{GpuArm, GpuRollout, Order};
pub use device::{Device, Memory};
pub use driver::Real;
pub use error::GpuError;
pub use rne_emit::Precision;
pub use rne_machine::{CompiledArm, Function};
