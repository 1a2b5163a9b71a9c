//! Plain `f64` values: for shading, sampling and choosing search paths; never a proof.
use super::{Number, run};
use crate::expr::{Binary, Unary};
use crate::geom::Vec3;
use crate::tape::Tape;
use antumbra_interval::Interval;

/// The value of the formula at a point, rounded at every step; NaN where it is undefined.
#[must_use]
pub fn value_at(tape: &Tape, point: Vec3, slots: &mut Vec<f64>) -> f64 {
    run(tape, point.0, slots)
}

impl Number for f64 {
    #[inline]
    fn constant(value: Interval) -> Self {
        value.mid()
    }

    #[inline]
    fn unary(self, op: Unary) -> Self {
        match op {
            Unary::Neg => -self,
            Unary::Abs => self.abs(),
            // Rust's signum(0) is 1; the language's sign(0) is 0.
            Unary::Sign if self == 0.0 => 0.0,
            Unary::Sign => self.signum(),
            Unary::Floor => self.floor(),
            Unary::Sqr => self * self,
            Unary::Sqrt => self.sqrt(),
            Unary::Cbrt => core_math::cbrt(self),
            Unary::Exp => core_math::exp(self),
            Unary::Ln if self == 0.0 => f64::NAN,
            Unary::Ln => core_math::log(self),
            Unary::Sin => core_math::sin(self),
            Unary::Cos => core_math::cos(self),
            Unary::Tan => core_math::tan(self),
            Unary::Asin => core_math::asin(self),
            Unary::Acos => core_math::acos(self),
            Unary::Atan => core_math::atan(self),
            Unary::Sinh => core_math::sinh(self),
            Unary::Cosh => core_math::cosh(self),
            Unary::Tanh => core_math::tanh(self),
        }
    }

    #[inline]
    fn powi(self, n: i32) -> Self {
        // C's pow(NaN, 0) is 1: undefined must stay undefined.
        if self.is_nan() || (n < 0 && self == 0.0) { f64::NAN } else { core_math::pow(self, f64::from(n)) }
    }

    #[inline]
    fn binary(self, op: Binary, other: Self) -> Self {
        match op {
            Binary::Add => self + other,
            Binary::Sub => self - other,
            Binary::Mul => self * other,
            Binary::Div if other == 0.0 => f64::NAN,
            Binary::Div => self / other,
            // f64::min and max drop a NaN: undefined must stay undefined.
            Binary::Min | Binary::Max if self.is_nan() || other.is_nan() => f64::NAN,
            Binary::Min => self.min(other),
            Binary::Max => self.max(other),
            // C's pow(1, NaN) is 1 too.
            Binary::Pow if self.is_nan() || other.is_nan() => f64::NAN,
            Binary::Pow if self < 0.0 || (self == 0.0 && other <= 0.0) => f64::NAN,
            Binary::Pow => core_math::pow(self, other),
            Binary::Atan2 if self == 0.0 && other == 0.0 => f64::NAN,
            Binary::Atan2 => core_math::atan2(self, other),
        }
    }
}
