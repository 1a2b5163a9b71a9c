//! The formulas of the scalar operators on vectors, step by step the same. Why they enclose is said there: `affine`,
//! `arith`, `power`, `round`.
mod affine;
mod curve;
mod dual;
mod interval;

pub(super) use affine::AffineOf;
pub(super) use dual::DualOf;
pub(super) use interval::IntervalOf;

use super::vector::{Eight, Vector};

/// Eight numbers of one kind. A result comes with the lanes in which it is the scalar operator's; the others are done again.
pub trait Kernel<V: Vector>: Copy {
    /// From its vectors.
    fn load(from: &[Eight]) -> Self;
    /// To its vectors.
    fn store(self, to: &mut [Eight]);
    /// `-a`.
    fn neg(self) -> (Self, V::Mask);
    /// `a + b`.
    fn add(self, o: Self) -> (Self, V::Mask);
    /// `a - b`.
    fn sub(self, o: Self) -> (Self, V::Mask);
    /// `a b`.
    fn mul(self, o: Self) -> (Self, V::Mask);
    /// `a / b`.
    fn div(self, o: Self) -> (Self, V::Mask);
    /// `a^2`.
    fn sqr(self) -> (Self, V::Mask);
    /// `a^n`, 3 <= n <= 8.
    fn power(self, n: u32) -> (Self, V::Mask);
    /// `p + t d`.
    fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask);
}
