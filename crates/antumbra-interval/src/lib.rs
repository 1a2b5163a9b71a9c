//! Sound interval arithmetic.
pub mod affine;
mod arith;
mod decoration;
mod elementary;
mod interval;
mod power;
pub mod round;
mod trig;

pub use decoration::{Decorated, Decoration};
pub use interval::Interval;
