//! Quotients, powers, exponentials and arcs. Where a function is undefined on part of the range the form holds on the
//! rest; where it is unbounded nothing is known.
use super::{
    Affine,
    curve::{Bend, Curve, Fit, Formula, Pieces, finite_range},
    greater, point,
    point::{around, bounds, exact, non_negative, recip_non_negative},
};
use crate::Interval;
use crate::round::about_root;
use std::ops::Div;

/// Enclosure of pi/2: the constant is the float below.
pub(crate) const HALF_PI: Interval = Interval::new(std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2.next_up());

/// `1/x` for `x > 0`; `h' = alpha` at `sqrt(-1/alpha)`.
const RECIP: Formula = Formula {
    value: |x| non_negative(around(1.0 / x)),
    slope: |x| -around(1.0 / x).sqr(),
    touch: |alpha, _, _| (-1.0 / alpha).sqrt(),
};
/// `h' = 1/(2 sqrt x) = alpha` at `1/(4 alpha^2)`.
const SQRT: Formula = Formula {
    value: point::sqrt,
    slope: |x| recip_non_negative(point::sqrt(x) + point::sqrt(x)),
    touch: |alpha, _, _| 0.25 / (alpha * alpha),
};
/// `h' = 1/(3 h^2) = alpha` at `+-(3 alpha)^(-3/2)`.
const CBRT: Formula = Formula {
    value: point::cbrt,
    slope: |x| recip_non_negative(exact(3.0) * point::cbrt(x).sqr()),
    touch: |alpha, _, hi| {
        let t = 1.0 / (3.0 * alpha).sqrt();
        signed(t * t * t, hi)
    },
};
const EXP: Formula = Formula { value: point::exp, slope: point::exp, touch: |alpha, _, _| core_math::log(alpha) };
const LN: Formula =
    Formula { value: point::ln, slope: |x| non_negative(around(1.0 / x)), touch: |alpha, _, _| 1.0 / alpha };
/// `h' = 1/sqrt(1 - x^2) = alpha` at `+-sqrt(1 - 1/alpha^2)`.
const ASIN: Formula = Formula {
    value: point::asin,
    slope: |x| recip_non_negative(root((Interval::ONE - exact(x)) * (Interval::ONE + exact(x)))),
    touch: |alpha, _, hi| signed((1.0 - 1.0 / (alpha * alpha)).sqrt(), hi),
};
/// `h' = 1/(1 + x^2) = alpha` at `+-sqrt(1/alpha - 1)`.
const ATAN: Formula = Formula {
    value: point::atan,
    slope: |x| recip_non_negative(Interval::ONE + exact(x).sqr()),
    touch: |alpha, _, hi| signed((1.0 / alpha - 1.0).sqrt(), hi),
};
const SINH: Formula =
    Formula { value: point::sinh, slope: point::cosh, touch: |alpha, _, hi| signed(core_math::acosh(alpha), hi) };
const COSH: Formula = Formula { value: point::cosh, slope: point::sinh, touch: |alpha, _, _| core_math::asinh(alpha) };
/// `h' = 1 - h^2 = alpha` at `+-atanh(sqrt(1 - alpha))`.
const TANH: Formula = Formula {
    value: point::tanh,
    slope: |x| (Interval::ONE - point::tanh(x)) * (Interval::ONE + point::tanh(x)),
    touch: |alpha, _, hi| signed(core_math::atanh((1.0 - alpha).sqrt()), hi),
};

/// `x` with the sign of a piece that ends at `hi` and does not contain 0 inside.
fn signed(x: f64, hi: f64) -> f64 {
    if hi > 0.0 { x } else { -x }
}

/// Root of the enclosure of a non-negative number.
fn root(y: Interval) -> Interval {
    bounds(point::sqrt(greater(y.lo(), 0.0)).lo(), point::sqrt(y.hi()).hi())
}

/// `x^n` for `x > 0`, and for `x <= 0` if `n > 0`.
struct IntegerPower(i32);

impl IntegerPower {
    /// `x^n`, `n` of either sign.
    fn at(x: f64, n: i64) -> Interval {
        let p = point::integer_power(x, u32::try_from(n.unsigned_abs()).unwrap_or(u32::MAX));
        if n < 0 { Interval::ONE / p } else { p }
    }
}

impl Curve for IntegerPower {
    fn value(&self, x: f64) -> Interval {
        Self::at(x, i64::from(self.0))
    }
    fn slope(&self, x: f64) -> Interval {
        exact(f64::from(self.0)) * Self::at(x, i64::from(self.0) - 1)
    }
    /// `n x^(n-1) = alpha` at `(alpha/n)^(1/(n-1))`; an even `n - 1` has also the negative root.
    fn touch(&self, alpha: f64, _: f64, hi: f64) -> f64 {
        let q = alpha / f64::from(self.0);
        let r = match self.0 {
            3..=8 if q == 0.0 => 0.0,
            n @ 3..=8 => about_root(q.abs(), n as u32 - 1),
            n => core_math::pow(q.abs(), 1.0 / (f64::from(n) - 1.0)),
        };
        if self.0 % 2 == 0 && self.0 > 0 { r.copysign(q) } else { signed(r, hi) }
    }
}

/// `x^y` for `x > 0` (`x = 0` too if `y > 0`), where all of `y` is `<= 0`, in `[0, 1]`, or `>= 1`.
struct RealPower(Interval);

impl Curve for RealPower {
    fn value(&self, x: f64) -> Interval {
        point::real_power(x, self.0)
    }
    fn slope(&self, x: f64) -> Interval {
        self.0 * point::real_power(x, self.0 - Interval::ONE)
    }
    fn touch(&self, alpha: f64, _: f64, _: f64) -> f64 {
        let y = self.0.mid();
        core_math::pow(alpha / y, 1.0 / (y - 1.0))
    }
}

impl<const N: usize> Affine<N> {
    /// `1 / x`. Unknown if the range of `x` contains 0.
    #[must_use]
    pub fn recip(self) -> Self {
        let x = self.range();
        if x.certainly_negative() {
            return -(-self).recip();
        }
        match finite_range(&self, 0.0, f64::INFINITY) {
            Some(x) if self.range().certainly_positive() => {
                Pieces::whole(&RECIP, x, Bend::Convex).apply(&self, Fit::Positive)
            }
            _ => Self::UNKNOWN,
        }
    }

    /// `x^n`, `n` not 0.
    pub(super) fn integer_power(self, n: i32) -> Self {
        let x = self.range();
        let odd = n % 2 != 0;
        if x.hi() < 0.0 {
            let y = (-self).integer_power(n);
            return if odd { -y } else { y };
        }
        let curve = IntegerPower(n);
        match finite_range(&self, f64::NEG_INFINITY, f64::INFINITY) {
            Some(x) if x.0 > 0.0 => {
                // n >= 2 and n <= -1 are convex here.
                Pieces::whole(&curve, x, Bend::Convex).apply(&self, Fit::Positive)
            }
            Some(x) if n > 0 && odd => {
                Pieces::cut_at_zero(&curve, x, Bend::Concave, Bend::Convex).apply(&self, Fit::Chebyshev)
            }
            Some(x) if n > 0 => Pieces::whole(&curve, x, Bend::Convex).apply(&self, Fit::Chebyshev),
            _ => Self::constant(x.powi(n)),
        }
    }

    /// `x^y`: `exp(y ln x)` for `x > 0`; 0 for `x = 0 < y`.
    ///
    /// For each exponent of one bend the curve is convex (`y <= 0`, `y >= 1`) or concave; the bounds hold for every
    /// member of an interval of such exponents. Exponents that vary with the symbols go by `exp(y ln x)`.
    #[must_use]
    pub fn pow(self, y: Self) -> Self {
        let (base, exponent) = (self.range(), y.range());
        let fixed = y.a.iter().all(|&v| v == 0.0) && y.is_known();
        let exponent = if fixed && y.e == 0.0 { exact(y.c) } else { exponent };
        let bend = if exponent.lo() >= 1.0 || exponent.hi() <= 0.0 {
            Some(Bend::Convex)
        } else if exponent.lo() >= 0.0 && exponent.hi() <= 1.0 {
            Some(Bend::Concave)
        } else {
            None
        };
        let unbounded_at_zero = exponent.lo() <= 0.0;
        match (bend, finite_range(&self, 0.0, f64::INFINITY)) {
            (Some(bend), Some(x)) if fixed && (x.0 > 0.0 || !unbounded_at_zero) => {
                Pieces::whole(&RealPower(exponent), x, bend).apply(&self, Fit::Positive)
            }
            _ if base.certainly_positive() => (y * self.ln()).exp(),
            _ => Self::constant(base.pow(exponent)),
        }
    }

    /// `sqrt(x)` where `x >= 0`.
    #[must_use]
    pub fn sqrt(self) -> Self {
        match finite_range(&self, 0.0, f64::INFINITY) {
            Some(x) => Pieces::whole(&SQRT, x, Bend::Concave).apply(&self, Fit::Chebyshev),
            None => Self::UNKNOWN,
        }
    }

    /// Real cube root.
    #[must_use]
    pub fn cbrt(self) -> Self {
        self.inflected(&CBRT, Bend::Convex, Bend::Concave, Interval::cbrt)
    }

    /// `e^x`.
    #[must_use]
    pub fn exp(self) -> Self {
        match finite_range(&self, f64::NEG_INFINITY, f64::INFINITY) {
            Some(x) => Pieces::whole(&EXP, x, Bend::Convex).apply(&self, Fit::Positive),
            None => Self::UNKNOWN,
        }
    }

    /// Natural logarithm where `x > 0`. Unknown if the range of `x` contains 0.
    #[must_use]
    pub fn ln(self) -> Self {
        match finite_range(&self, 0.0, f64::INFINITY) {
            Some(x) if x.0 > 0.0 => Pieces::whole(&LN, x, Bend::Concave).apply(&self, Fit::Chebyshev),
            _ => Self::UNKNOWN,
        }
    }

    /// Arc sine where `|x| <= 1`.
    #[must_use]
    pub fn asin(self) -> Self {
        match finite_range(&self, -1.0, 1.0) {
            Some(x) => Pieces::cut_at_zero(&ASIN, x, Bend::Concave, Bend::Convex).apply(&self, Fit::Chebyshev),
            None => Self::UNKNOWN,
        }
    }

    /// Arc cosine where `|x| <= 1`: `pi/2 - asin x`.
    #[must_use]
    pub fn acos(self) -> Self {
        (-self.asin()).add_interval(HALF_PI)
    }

    /// Arc tangent.
    #[must_use]
    pub fn atan(self) -> Self {
        self.inflected(&ATAN, Bend::Convex, Bend::Concave, Interval::atan)
    }

    /// Angle of the point `(x, y)`, `self` being `y`, in `(-pi, pi]`.
    ///
    /// By `atan` of a quotient in the half planes `x > 0`, `y > 0`, `y < 0`; where neither sign is settled, constant.
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        let (ry, rx) = (self.range(), x.range());
        if rx.certainly_positive() {
            (self / x).atan()
        } else if ry.certainly_positive() {
            (-(x / self).atan()).add_interval(HALF_PI)
        } else if ry.certainly_negative() {
            (-(x / self).atan()).add_interval(-HALF_PI)
        } else {
            Self::constant((HALF_PI + HALF_PI).hull(-(HALF_PI + HALF_PI)))
        }
    }

    /// Hyperbolic sine.
    #[must_use]
    pub fn sinh(self) -> Self {
        self.inflected(&SINH, Bend::Concave, Bend::Convex, Interval::sinh)
    }

    /// Hyperbolic cosine.
    #[must_use]
    pub fn cosh(self) -> Self {
        match finite_range(&self, f64::NEG_INFINITY, f64::INFINITY) {
            Some(x) => Pieces::whole(&COSH, x, Bend::Convex).apply(&self, Fit::Positive),
            None => Self::UNKNOWN,
        }
    }

    /// Hyperbolic tangent.
    #[must_use]
    pub fn tanh(self) -> Self {
        self.inflected(&TANH, Bend::Convex, Bend::Concave, Interval::tanh)
    }

    /// A function on all numbers whose only inflection is 0.
    fn inflected(self, curve: &Formula, left: Bend, right: Bend, over: fn(Interval) -> Interval) -> Self {
        match finite_range(&self, f64::NEG_INFINITY, f64::INFINITY) {
            Some(x) => Pieces::cut_at_zero(curve, x, left, right).apply(&self, Fit::Chebyshev),
            None => Self::constant(over(Interval::ENTIRE)),
        }
    }
}

/// `x / y = x (1 / y)`. Unknown if the range of `y` contains 0.
impl<const N: usize> Div for Affine<N> {
    type Output = Self;
    #[inline]
    #[expect(clippy::suspicious_arithmetic_impl, reason = "a quotient is a product with the reciprocal")]
    fn div(self, o: Self) -> Self {
        self * o.recip()
    }
}
