//! Pictures on the GPU, without giving up a proof.
//!
//! Kernels are WGSL, generated for each formula by [`antumbra::eval::wgsl`]; they run on any adapter that wgpu reaches and that passes the
//! start-up [`probe`]. What they claim is a theorem about the real function, as on the CPU: their 32-bit arithmetic bounds its own
//! rounding and does not trust the compiler of the driver. What 32 bits cannot prove is left open, and the CPU finishes it.
#![forbid(unsafe_code)]

mod assist;
mod certified;
mod compare;
mod device;
#[cfg(test)]
mod faults;
mod pace;
mod paper;
pub mod probe;
mod scene;
#[cfg(test)]
mod tests;
mod throughput;
#[cfg(test)]
mod twin;

pub use assist::{Share, assist};
pub use certified::{Kernels, Pixel, Proved, check};
pub use compare::{Comparison, compare};
pub use device::{Adapter, Error, Gpu, adapters};
pub use paper::{Found, Paper};
pub use throughput::{Throughput, throughput};
