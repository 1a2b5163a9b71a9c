//! Sound interval arithmetic.
mod arith;
mod decoration;
mod elementary;
mod interval;
pub mod lanes;
mod power;
pub mod round;
mod trig;

pub use decoration::{Decorated, Decoration};
pub use interval::Interval;
