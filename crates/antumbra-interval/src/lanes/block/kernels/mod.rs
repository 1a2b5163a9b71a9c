//! The formulas of the scalar operators on vectors, step by step the same. Why they enclose is said there: `affine`,
//! `arith`, `power`, `round`.
/// An array of the coefficients of a form.
macro_rules! coefficients {
    ($i:ident => $value:expr) => {{
        // Not from_fn: a closure would not take the features of the function around it.
        let mut out = [V::splat(0.0); N];
        let mut $i = 0;
        while $i < N {
            out[$i] = $value;
            $i += 1;
        }
        out
    }};
}

mod affine;
mod choice;
mod curve;
mod dual;
mod forms;
mod interval;
mod slopes;

pub(super) use affine::AffineOf;
pub(super) use dual::DualOf;
pub(super) use forms::{JetOf, PointJetOf, QuadraticOf};
pub(super) use interval::IntervalOf;
pub(super) use slopes::SlopeLanes;

use super::vector::{Eight, Vector};

/// Operations that are left to the scalar operators.
macro_rules! left_to_scalars {
    () => {
        #[inline(always)]
        fn div(self, _: Self) -> (Self, V::Mask) {
            (self, never::<V>())
        }
        #[inline(always)]
        fn sqrt(self) -> (Self, V::Mask) {
            (self, never::<V>())
        }
        #[inline(always)]
        fn abs(self) -> (Self, V::Mask) {
            (self, never::<V>())
        }
        #[inline(always)]
        fn min(self, _: Self) -> (Self, V::Mask) {
            (self, never::<V>())
        }
        #[inline(always)]
        fn max(self, _: Self) -> (Self, V::Mask) {
            (self, never::<V>())
        }
    };
}
use left_to_scalars;

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
    /// Square root of the part that is not negative.
    fn sqrt(self) -> (Self, V::Mask);
    /// `|a|`.
    fn abs(self) -> (Self, V::Mask);
    /// The smaller one.
    fn min(self, o: Self) -> (Self, V::Mask);
    /// The larger one.
    fn max(self, o: Self) -> (Self, V::Mask);
    /// `a^n`, 3 <= n <= 8.
    fn power(self, n: u32) -> (Self, V::Mask);
    /// `p + t d`.
    fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask);
    /// A parameter, from its ends.
    #[inline(always)]
    fn spanning(self) -> (Self, V::Mask) {
        (self, V::always())
    }
}
