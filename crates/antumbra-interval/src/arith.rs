//! Sums, products, quotients, square, root and the piecewise linear functions.
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::Interval;
use crate::round::{
    add_down, add_up, div_down, div_up, greater, lesser, mul_add_down, mul_add_up, mul_down, mul_up, sqrt_down,
    sqrt_up, sub_down, sub_up,
};

impl Neg for Interval {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        // Exact, and the empty set [+inf, -inf] is its own negative.
        Self { lo: -self.hi, hi: -self.lo }
    }
}

#[allow(clippy::suspicious_arithmetic_impl, reason = "one branch for both operands")]
impl Add for Interval {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl, reason = "`|` joins two tests without a branch")]
    #[inline]
    fn add(self, o: Self) -> Self {
        if self.is_empty() | o.is_empty() {
            return Self::EMPTY;
        }
        // lo < +inf and hi > -inf on both sides: inf - inf cannot arise.
        Self { lo: add_down(self.lo, o.lo), hi: add_up(self.hi, o.hi) }
    }
}

#[allow(clippy::suspicious_arithmetic_impl, reason = "one branch for both operands")]
impl Sub for Interval {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl, reason = "`|` joins two tests without a branch")]
    #[inline]
    fn sub(self, o: Self) -> Self {
        if self.is_empty() | o.is_empty() {
            return Self::EMPTY;
        }
        Self { lo: sub_down(self.lo, o.hi), hi: sub_up(self.hi, o.lo) }
    }
}

impl Mul for Interval {
    type Output = Self;
    /// The extremes of a bilinear function lie at corners; the signs tell which.
    #[inline]
    fn mul(self, o: Self) -> Self {
        let (a, b) = (self, o);
        if a.is_empty() | b.is_empty() {
            return Self::EMPTY;
        }
        let (lo, hi) = if a.lo >= 0.0 {
            // The lower bound of the product is at the end of a that is smaller for b.lo >= 0, larger for b.lo < 0.
            let for_lo = if b.lo >= 0.0 { a.lo } else { a.hi };
            let for_hi = if b.hi >= 0.0 { a.hi } else { a.lo };
            (mul_down(for_lo, b.lo), mul_up(for_hi, b.hi))
        } else if a.hi <= 0.0 {
            let for_lo = if b.hi >= 0.0 { a.lo } else { a.hi };
            let for_hi = if b.lo >= 0.0 { a.hi } else { a.lo };
            (mul_down(for_lo, b.hi), mul_up(for_hi, b.lo))
        } else if b.lo >= 0.0 {
            (mul_down(a.lo, b.hi), mul_up(a.hi, b.hi))
        } else if b.hi <= 0.0 {
            (mul_down(a.hi, b.lo), mul_up(a.lo, b.lo))
        } else {
            (lesser(mul_down(a.lo, b.hi), mul_down(a.hi, b.lo)), greater(mul_up(a.lo, b.lo), mul_up(a.hi, b.hi)))
        };
        Self { lo, hi }
    }
}

impl Div for Interval {
    type Output = Self;
    /// The hull of `{x / y : y != 0}` (IEEE 1788): `[1, 2] / [0, 1] = [1, +inf]`, and nothing for the divisor `[0, 0]`.
    #[inline]
    fn div(self, o: Self) -> Self {
        if self.is_empty() | o.is_empty() {
            return Self::EMPTY;
        }
        if o.lo > 0.0 {
            quotient(self, o)
        } else if o.hi < 0.0 {
            // x / y = (-x) / (-y), exactly.
            quotient(-self, -o)
        } else {
            quotient_around_zero(self, o)
        }
    }
}

/// `a / b` for `b.lo > 0`: increasing in x; in y decreasing for x > 0, increasing for x < 0.
#[inline]
fn quotient(a: Interval, b: Interval) -> Interval {
    // An infinite end of a is never divided by an infinite end of b: a.lo >= 0 and a.hi <= 0 are finite.
    let under_lo = if a.lo >= 0.0 { b.hi } else { b.lo };
    let under_hi = if a.hi <= 0.0 { b.hi } else { b.lo };
    Interval { lo: div_down(a.lo, under_lo), hi: div_up(a.hi, under_hi) }
}

/// `a / b` where b contains 0.
fn quotient_around_zero(a: Interval, b: Interval) -> Interval {
    if b.is_zero() {
        return Interval::EMPTY;
    }
    if a.is_zero() {
        return Interval::ZERO;
    }
    let (a, b) = if b.hi == 0.0 { (-a, -b) } else { (a, b) };
    // NaN bounds fall through every comparison to the answer that says nothing.
    if b.lo == 0.0 && a.lo >= 0.0 {
        Interval { lo: div_down(a.lo, b.hi), hi: f64::INFINITY }
    } else if b.lo == 0.0 && a.hi <= 0.0 {
        Interval { lo: f64::NEG_INFINITY, hi: div_up(a.hi, b.hi) }
    } else {
        Interval::ENTIRE
    }
}

impl Interval {
    /// `1 / a`.
    #[inline]
    #[must_use]
    pub fn recip(self) -> Self {
        Self::ONE / self
    }
    /// `a + x` for a finite number `x`; no information (`ENTIRE`) if `x` is infinite or NaN.
    #[inline]
    #[must_use]
    pub fn add_point(self, x: f64) -> Self {
        self + Self::from_bounds_or_entire(x, x)
    }
    /// `a * x` for a finite number `x`; no information (`ENTIRE`) if `x` is infinite or NaN.
    #[inline]
    #[must_use]
    pub fn mul_point(self, x: f64) -> Self {
        if self.is_empty() {
            Self::EMPTY
        } else if !x.is_finite() {
            Self::ENTIRE
        } else if x >= 0.0 {
            Self { lo: mul_down(self.lo, x), hi: mul_up(self.hi, x) }
        } else {
            Self { lo: mul_down(self.hi, x), hi: mul_up(self.lo, x) }
        }
    }
    /// `a b + c` with one rounding (IEEE 1788 `fma`).
    #[must_use]
    pub fn mul_add(self, b: Self, c: Self) -> Self {
        let a = self;
        if a.is_empty() | b.is_empty() | c.is_empty() {
            return Self::EMPTY;
        }
        // The product is extreme at corners; c adds its own end. A corner at +inf would be NaN with c.lo = -inf.
        let corners = [(a.lo, b.lo), (a.lo, b.hi), (a.hi, b.lo), (a.hi, b.hi)];
        let lo = if c.lo == f64::NEG_INFINITY {
            f64::NEG_INFINITY
        } else {
            corners.iter().fold(f64::INFINITY, |least, &(x, y)| lesser(mul_add_down(x, y, c.lo), least))
        };
        let hi = if c.hi == f64::INFINITY {
            f64::INFINITY
        } else {
            corners.iter().fold(f64::NEG_INFINITY, |most, &(x, y)| greater(mul_add_up(x, y, c.hi), most))
        };
        Self { lo, hi }
    }
    /// `a^2`, tighter than `a * a`; never below 0.
    #[inline]
    #[must_use]
    pub fn sqr(self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let (near, far) = (self.mignitude(), self.magnitude());
        Self { lo: mul_down(near, near), hi: mul_up(far, far) }
    }
    /// Square root of the part that is not negative.
    #[inline]
    #[must_use]
    pub fn sqrt(self) -> Self {
        if self.is_empty() || self.hi < 0.0 {
            return Self::EMPTY;
        }
        Self { lo: if self.lo <= 0.0 { 0.0 } else { sqrt_down(self.lo) }, hi: sqrt_up(self.hi) }
    }
    /// `|a|`, exact.
    #[inline]
    #[must_use]
    pub fn abs(self) -> Self {
        if self.lo >= 0.0 {
            self
        } else if self.hi <= 0.0 {
            -self
        } else {
            Self { lo: 0.0, hi: greater(-self.lo, self.hi) }
        }
    }
    /// Pointwise minimum, exact.
    #[inline]
    #[must_use]
    pub fn min(self, o: Self) -> Self {
        if self.is_empty() | o.is_empty() {
            return Self::EMPTY;
        }
        Self { lo: lesser(self.lo, o.lo), hi: lesser(self.hi, o.hi) }
    }
    /// Pointwise maximum, exact.
    #[inline]
    #[must_use]
    pub fn max(self, o: Self) -> Self {
        if self.is_empty() | o.is_empty() {
            return Self::EMPTY;
        }
        Self { lo: greater(self.lo, o.lo), hi: greater(self.hi, o.hi) }
    }
    /// Largest integer at most the argument, exact.
    #[inline]
    #[must_use]
    pub fn floor(self) -> Self {
        Self { lo: self.lo.floor(), hi: self.hi.floor() }
    }
    /// Smallest integer at least the argument, exact.
    #[inline]
    #[must_use]
    pub fn ceil(self) -> Self {
        Self { lo: self.lo.ceil(), hi: self.hi.ceil() }
    }
    /// -1, 0 or 1, exact.
    #[inline]
    #[must_use]
    pub fn sign(self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let sign = |x: f64, nan: f64| {
            if x > 0.0 {
                1.0
            } else if x < 0.0 {
                -1.0
            } else if x == 0.0 {
                0.0
            } else {
                nan
            }
        };
        Self { lo: sign(self.lo, -1.0), hi: sign(self.hi, 1.0) }
    }
}
