//! Sound interval arithmetic.
pub mod affine;
mod interval;
pub use interval::Interval;
