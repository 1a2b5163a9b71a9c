//! Monotone elementary functions and their inverses, from correctly rounded values.
//!
//! `core_math` returns the float nearest to the real value `f(x)`. By Lindemann and Weierstrass `f(x)` is not a float
//! except at the few arguments listed with each function, so it lies strictly between the neighbours of what is
//! returned, and one step outward encloses it. The listed arguments give exact bounds. Every bound is then clamped to
//! the range of the function.
use crate::Interval;
use crate::round::{greater, lesser};

/// Lower bound of a real whose nearest float is `r`. (`f64::next_down` is exact where `round::next_down` may take two steps.)
#[inline]
pub(crate) fn below(r: f64) -> f64 {
    r.next_down()
}

/// Upper bound of a real whose nearest float is `r`.
#[inline]
pub(crate) fn above(r: f64) -> f64 {
    r.next_up()
}

/// Both bounds of an increasing function that is exact only at `fixed`, where it is `value`.
#[inline]
fn increasing(x: Interval, f: impl Fn(f64) -> f64, fixed: f64, value: f64) -> Interval {
    let lo = if x.lo == fixed { value } else { below(f(x.lo)) };
    let hi = if x.hi == fixed { value } else { above(f(x.hi)) };
    Interval { lo, hi }
}

impl Interval {
    /// Cuts the bounds to the range `[lo, hi]` of a function.
    #[inline]
    pub(crate) fn within(self, lo: f64, hi: f64) -> Self {
        Self { lo: greater(self.lo, lo), hi: lesser(self.hi, hi) }
    }

    /// `e^a`, exact at 0; never below 0.
    #[must_use]
    pub fn exp(self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        increasing(self, core_math::exp, 0.0, 1.0).within(0.0, f64::INFINITY)
    }

    /// Natural logarithm of the positive part, exact at 1.
    #[must_use]
    pub fn ln(self) -> Self {
        if self.is_empty() || self.hi <= 0.0 {
            return Self::EMPTY;
        }
        // The limit at 0, and no sign of zero for the library to look at.
        let lo = if self.lo <= 0.0 { f64::NEG_INFINITY } else { below(core_math::log(self.lo)) };
        let hi = above(core_math::log(self.hi));
        Self { lo: if self.lo == 1.0 { 0.0 } else { lo }, hi: if self.hi == 1.0 { 0.0 } else { hi } }
    }

    /// Real cube root, exact at 0 and +-1.
    #[must_use]
    pub fn cbrt(self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        // A step outward is right for exact cubes too.
        let exact = |x: f64| x == 0.0 || x.abs() == 1.0;
        Self {
            lo: if exact(self.lo) { self.lo } else { below(core_math::cbrt(self.lo)) },
            hi: if exact(self.hi) { self.hi } else { above(core_math::cbrt(self.hi)) },
        }
    }

    /// Arc sine of the part inside [-1, 1], in `[-pi/2, pi/2]`, exact at 0.
    #[must_use]
    pub fn asin(self) -> Self {
        let x = self.intersection(Self { lo: -1.0, hi: 1.0 });
        if x.is_empty() {
            return Self::EMPTY;
        }
        increasing(x, core_math::asin, 0.0, 0.0).within(-Self::HALF_PI.hi, Self::HALF_PI.hi)
    }

    /// Arc cosine of the part inside [-1, 1], in `[0, pi]`, exact at 1.
    #[must_use]
    pub fn acos(self) -> Self {
        let x = self.intersection(Self { lo: -1.0, hi: 1.0 });
        if x.is_empty() {
            return Self::EMPTY;
        }
        // Decreasing.
        let lo = if x.hi == 1.0 { 0.0 } else { below(core_math::acos(x.hi)) };
        let hi = if x.lo == 1.0 { 0.0 } else { above(core_math::acos(x.lo)) };
        Self { lo, hi }.within(0.0, Self::PI.hi)
    }

    /// Arc tangent, in `[-pi/2, pi/2]`, exact at 0.
    #[must_use]
    pub fn atan(self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        increasing(self, core_math::atan, 0.0, 0.0).within(-Self::HALF_PI.hi, Self::HALF_PI.hi)
    }

    /// Hyperbolic sine, exact at 0.
    #[must_use]
    pub fn sinh(self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        increasing(self, core_math::sinh, 0.0, 0.0)
    }

    /// Hyperbolic cosine, exact at 0; never below 1.
    #[must_use]
    pub fn cosh(self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        // Even, and increasing in |a|.
        let distance = Self { lo: self.mignitude(), hi: self.magnitude() };
        increasing(distance, core_math::cosh, 0.0, 1.0).within(1.0, f64::INFINITY)
    }

    /// Hyperbolic tangent, in [-1, 1], exact at 0.
    #[must_use]
    pub fn tanh(self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        increasing(self, core_math::tanh, 0.0, 0.0).within(-1.0, 1.0)
    }

    /// Angle in `(-pi, pi]` of the points `(x, y)` other than the origin, `self` being y (IEEE 1788 `atan2`).
    ///
    /// `[-pi, pi]` rounded outward where the box meets the cut (the negative x axis) from below.
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        let y = self;
        if y.is_empty() || x.is_empty() || (y.is_zero() && x.is_zero()) {
            return Self::EMPTY;
        }
        if y.lo < 0.0 && y.hi >= 0.0 && x.lo < 0.0 {
            return Self { lo: -Self::PI.hi, hi: Self::PI.hi };
        }
        if y.lo >= 0.0 {
            angle_of_upper_half(y, x)
        } else if y.hi <= 0.0 {
            // Mirrored at the x axis; the cut was dealt with above.
            -angle_of_upper_half(-y, x)
        } else {
            // y on both sides of 0, x >= 0: the angle is extreme on the left edge.
            Self { lo: below(core_math::atan2(y.lo, x.lo)), hi: above(core_math::atan2(y.hi, x.lo)) }
                .within(-Self::HALF_PI.hi, Self::HALF_PI.hi)
        }
    }
}

/// Angles of a box in `y >= 0`, not just the origin.
///
/// The angle falls with x; it rises with y where x > 0 and falls with y where x < 0.
fn angle_of_upper_half(y: Interval, x: Interval) -> Interval {
    if y.hi == 0.0 {
        // On the x axis the angle is 0 on the right and pi on the left.
        let (left, right) = (x.lo < 0.0, x.hi > 0.0);
        return Interval {
            lo: if right { 0.0 } else { Interval::PI.lo },
            hi: if left { Interval::PI.hi } else { 0.0 },
        };
    }
    // The library tells -0 from +0, we do not: a zero y means the upper side of the axis. (At x = +-0 y is positive here,
    // where both zeros give pi/2.) Never two infinities: an infinite x.hi meets y.lo, an infinite x.lo meets y.lo.
    let positive_zero = |v: f64| if v == 0.0 { 0.0 } else { v };
    let y_lo = positive_zero(y.lo);
    let first = if x.hi > 0.0 { y_lo } else { y.hi };
    let last = if x.lo < 0.0 { y_lo } else { y.hi };
    // The angle of a point of the positive x axis is exactly 0.
    let lo = if x.hi > 0.0 && y_lo == 0.0 { 0.0 } else { below(core_math::atan2(first, x.hi)) };
    Interval { lo, hi: above(core_math::atan2(last, x.lo)) }.within(0.0, Interval::PI.hi)
}
