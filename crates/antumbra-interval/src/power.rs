//! Integer and real powers.
use crate::Interval;
use crate::elementary::{above, below};
use crate::round::{div_down, div_up, greater, mul_down, mul_up};

/// Up to this exponent a chain of products is used: faster than the library's power by an order of magnitude.
const LONGEST_CHAIN: u32 = 8;

/// Lower bound of `x^n` for `x >= 0`, `n >= 1`.
///
/// Repeated squaring: every factor is a lower bound and not negative, so every product is.
#[inline]
fn chain_down(x: f64, n: u32) -> f64 {
    let (mut square, mut rest, mut product) = (x, n, None);
    loop {
        if rest & 1 == 1 {
            product = Some(product.map_or(square, |p| mul_down(p, square)));
        }
        rest >>= 1;
        if rest == 0 {
            return product.unwrap_or(1.0);
        }
        square = mul_down(square, square);
    }
}

/// Upper bound of `x^n` for `x >= 0`, `n >= 1`.
#[inline]
fn chain_up(x: f64, n: u32) -> f64 {
    let (mut square, mut rest, mut product) = (x, n, None);
    loop {
        if rest & 1 == 1 {
            product = Some(product.map_or(square, |p| mul_up(p, square)));
        }
        rest >>= 1;
        if rest == 0 {
            return product.unwrap_or(1.0);
        }
        square = mul_up(square, square);
    }
}

/// Lower bound of `x^y` for `x >= 0` (0 and infinities as limits; 1 on the edges `x = 1` and `y = 0`).
#[inline]
fn real_down(x: f64, y: f64) -> f64 {
    // 1^y and x^0 are exact; else a step below the nearest float, which is right for exact powers too.
    if x == 1.0 || y == 0.0 { 1.0 } else { greater(below(core_math::pow(x, y)), 0.0) }
}

/// Upper bound of `x^y` for `x >= 0`, as above; exact where it is 0 because `x` is.
#[inline]
fn real_up(x: f64, y: f64) -> f64 {
    if x == 1.0 || y == 0.0 {
        1.0
    } else if x == 0.0 && y > 0.0 {
        0.0
    } else {
        above(core_math::pow(x, y))
    }
}

/// Lower bound of `x^n` for `x >= 0` and any `n != 0`; `x > 0` if `n < 0`.
#[inline]
fn integer_down(x: f64, n: i32) -> f64 {
    match n.unsigned_abs() {
        m if m > LONGEST_CHAIN => real_down(x, f64::from(n)),
        m if n > 0 => chain_down(x, m),
        m => match chain_up(x, m) {
            power if power.is_normal() => div_down(1.0, power),
            // The chain over- or underflowed where its reciprocal may be a number that can still be told.
            _ => real_down(x, f64::from(n)),
        },
    }
}

/// Upper bound of `x^n` for `x >= 0` and any `n != 0`; `0^n = +inf` if `n < 0`.
#[inline]
fn integer_up(x: f64, n: i32) -> f64 {
    match n.unsigned_abs() {
        m if m > LONGEST_CHAIN => real_up(x, f64::from(n)),
        m if n > 0 => chain_up(x, m),
        m => match chain_down(x, m) {
            power if power.is_normal() && power < f64::MAX => div_up(1.0, power),
            _ => real_up(x, f64::from(n)),
        },
    }
}

impl Interval {
    /// Integer power (IEEE 1788 `pown`): `x^0 = 1` everywhere, a negative power of 0 is undefined.
    ///
    /// Cost: a chain of products for `|n| <= 8`, else two calls of a correctly rounded power.
    #[inline]
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        match n {
            0 => Self::ONE,
            1 => self,
            2 => self.sqr(),
            _ if n % 2 == 0 => {
                let (near, far) = (self.mignitude(), self.magnitude());
                if n > 0 {
                    Self { lo: integer_down(near, n), hi: integer_up(far, n) }
                } else if far == 0.0 {
                    Self::EMPTY
                } else {
                    Self { lo: integer_down(far, n), hi: integer_up(near, n) }
                }
            }
            _ if n > 0 => {
                // Odd and increasing.
                let lo = if self.lo < 0.0 { -integer_up(-self.lo, n) } else { integer_down(self.lo, n) };
                let hi = if self.hi < 0.0 { -integer_down(-self.hi, n) } else { integer_up(self.hi, n) };
                Self { lo, hi }
            }
            _ if self.lo >= 0.0 => odd_negative_power(self, n),
            _ if self.hi <= 0.0 => -odd_negative_power(-self, n),
            _ => Self::ENTIRE,
        }
    }

    /// Real power (IEEE 1788 `pow`): `x^y` for `x > 0`, and 0 for `x = 0 < y`. The rest of the box is outside the domain.
    #[must_use]
    pub fn pow(self, y: Self) -> Self {
        let x = self.intersection(Self { lo: 0.0, hi: f64::INFINITY });
        if x.is_empty() || y.is_empty() {
            return Self::EMPTY;
        }
        if x.hi == 0.0 {
            return if y.hi > 0.0 { Self::ZERO } else { Self::EMPTY };
        }
        // No negative zero for the library to look at.
        let (a, b) = (if x.lo == 0.0 { 0.0 } else { x.lo }, x.hi);
        let (c, d) = (y.lo, y.hi);
        // y ln x is bilinear in (ln x, y): extreme at corners. As a function of x it grows where y > 0, as a function of y
        // where x > 1. Corners at 0 and infinity are limits, which the library returns: 0^-1 = inf, 0.5^inf = 0, 1^inf = 1,
        // 0^0 = inf^0 = 1 (the value on the edge y = 0).
        let (lo, hi) = if c >= 0.0 {
            (real_down(a, if a < 1.0 { d } else { c }), real_up(b, if b < 1.0 { c } else { d }))
        } else if d <= 0.0 {
            (real_down(b, if b < 1.0 { d } else { c }), real_up(a, if a < 1.0 { c } else { d }))
        } else if b <= 1.0 {
            (real_down(a, d), real_up(a, c))
        } else if a >= 1.0 {
            (real_down(b, c), real_up(b, d))
        } else {
            (crate::round::lesser(real_down(a, d), real_down(b, c)), greater(real_up(a, c), real_up(b, d)))
        };
        Self { lo, hi }
    }
}

/// `x^n` for odd `n < 0` and `x.lo >= 0`: decreasing, unbounded towards 0, undefined at 0.
fn odd_negative_power(x: Interval, n: i32) -> Interval {
    if x.hi == 0.0 {
        return Interval::EMPTY;
    }
    let hi = if x.lo == 0.0 { f64::INFINITY } else { integer_up(x.lo, n) };
    Interval { lo: integer_down(x.hi, n), hi }
}
