//! Enclosures of elementary functions at one number.
//!
//! `core-math` rounds correctly, so the true value lies between the floats on both sides of the returned one.
use super::greater;
use crate::Interval;

/// The numbers from the float below `y` to the float above. Everything if `y` is NaN.
///
/// A true value beyond the largest float rounds to infinity: `[MAX, inf]`.
pub(super) fn around(y: f64) -> Interval {
    Interval::try_new(y.next_down(), y.next_up()).unwrap_or(Interval::ENTIRE)
}

/// `[lo, hi]`, everything if that is no interval.
pub(crate) fn bounds(lo: f64, hi: f64) -> Interval {
    Interval::try_new(lo, hi).unwrap_or(Interval::ENTIRE)
}

/// The number `x`, everything if it is not finite.
pub(crate) fn exact(x: f64) -> Interval {
    bounds(x, x)
}

/// Non-negative part of an enclosure of a non-negative number.
pub(super) fn non_negative(y: Interval) -> Interval {
    bounds(greater(y.lo(), 0.0), y.hi())
}

/// `1 / y` for a non-negative number in `y`, `[.., inf)` where it may be 0.
pub(super) fn recip_non_negative(y: Interval) -> Interval {
    // One rounding each, then one step outward.
    let (lo, hi) = (greater((1.0 / y.hi()).next_down(), 0.0), (1.0 / greater(y.lo(), 0.0)).next_up());
    bounds(lo, hi)
}

macro_rules! correctly_rounded {
    ($($name:ident = $f:ident)*) => { $(
        pub(super) fn $name(x: f64) -> Interval { around(core_math::$f(x)) }
    )* };
}
correctly_rounded!(ln = log sin = sin cos = cos tan = tan asin = asin atan = atan sinh = sinh tanh = tanh cbrt = cbrt);

pub(super) fn exp(x: f64) -> Interval {
    non_negative(around(core_math::exp(x)))
}

pub(super) fn cosh(x: f64) -> Interval {
    non_negative(around(core_math::cosh(x)))
}

/// `sqrt(x)`, `x >= 0`: IEEE 754 rounds it correctly.
pub(super) fn sqrt(x: f64) -> Interval {
    non_negative(around(x.sqrt()))
}

/// `x^n` by repeated squaring; `x^0 = 1`.
pub(super) fn integer_power(x: f64, n: u32) -> Interval {
    let (mut power, mut square, mut n) = (Interval::ONE, exact(x), n);
    while n > 0 {
        if n & 1 == 1 {
            power = power * square;
        }
        n >>= 1;
        if n > 0 {
            square = square.sqr();
        }
    }
    power
}

/// `x^y` for `x >= 0` and every `y` in the interval: monotone in `y`, so between the values at its ends (`0^y`: 0 or inf).
pub(super) fn real_power(x: f64, y: Interval) -> Interval {
    non_negative(around(core_math::pow(x, y.lo())).hull(around(core_math::pow(x, y.hi()))))
}
