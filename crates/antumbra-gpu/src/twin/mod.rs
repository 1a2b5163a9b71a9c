//! The arithmetic of `forms.wgsl` and `functions.wgsl` in Rust, operation by operation: on a GPU that rounds to nearest every bit is the same. With `FLUSH`
//! as on one that takes every subnormal operand and result for 0.
pub(crate) mod double;
mod functions;

pub(crate) use functions::take_lost;

use antumbra::eval::Number;
use antumbra::eval::wgsl::{FLOOR, ball, exact};
use antumbra::expr::{Binary, Unary};
use antumbra_interval::Interval;
use functions::Function;
use std::ops::{Add, Mul, Neg, Sub};

/// `guess` of `single.wgsl`.
fn guess(c: f32) -> f32 {
    f32::from_bits(0x7ef3_11c7_u32.wrapping_sub(c.to_bits()))
}

include!("arithmetic.rs");
