//! Pictures on the GPU, without giving up a proof.
//!
//! Kernels are WGSL, generated for each formula by [`antumbra::eval::wgsl`]; they run on any adapter that wgpu reaches and that passes the
//! start-up [`probe`]. What they claim is a theorem about the real function, as on the CPU: their arithmetic, in 32 bits, or in 64 where that is
//! measured to pay ([`chosen`]), bounds its own rounding and does not trust the compiler of the driver. What it cannot prove is left open, and the CPU finishes it.
//!
//! The host of the kernels speaks to a [`Machine`]. With the feature `native` that is a [`Gpu`] of wgpu's; the web page brings its own.
#![forbid(unsafe_code)]

mod assist;
mod certified;
mod choice;
mod compare;
#[cfg(feature = "native")]
mod device;
mod error;
#[cfg(all(test, feature = "native"))]
mod faults;
mod machine;
#[cfg(all(test, feature = "native"))]
mod negligence;
mod pace;
mod paper;
pub mod probe;
#[cfg(feature = "native")]
mod probe_double;
mod receipt;
mod scene;
#[cfg(all(test, feature = "native"))]
mod tests;
#[cfg(all(test, feature = "native"))]
mod tests_double;
#[cfg(feature = "native")]
mod throughput;
#[cfg(feature = "native")]
mod trace;
#[cfg(all(test, feature = "native"))]
mod twin;

#[cfg(feature = "native")]
pub use assist::assist;
pub use assist::{Share, kernels};
pub use certified::{Kernels, Pixel, Proved, check};
pub use choice::{Measured, chosen};
pub use compare::{Comparison, compare};
#[cfg(feature = "native")]
pub use device::{Adapter, Gpu, adapters};
pub use error::Error;
pub use machine::{Kernel, Machine, Usage};
pub use paper::{Found, Paper};
#[cfg(feature = "native")]
pub use throughput::{Throughput, throughput};
#[cfg(feature = "native")]
pub use trace::trace;
