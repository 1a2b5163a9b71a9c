//! Sound interval arithmetic.
mod interval;
pub use interval::Interval;
