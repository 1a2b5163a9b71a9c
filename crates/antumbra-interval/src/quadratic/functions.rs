//! The other operators: Taylor expansions of second order with proved remainders, and linear enclosures where these are
//! not worth it.
use super::Quadratic;
use crate::Interval;
use crate::affine::{
    Affine, Form, Smooth,
    form::{inherent, sealed},
    nonlinear::HALF_PI,
    point::{bounds, exact},
};
use std::ops::Div;

impl Quadratic {
    /// `h(x)` by a linear enclosure of `h` over the range of `x`, given for a form of one symbol.
    ///
    /// A value `v` in `[lo, hi]` is `(lo + hi)/2 + r s` for one `s` in `[-1, 1]`, `r = (hi - lo)/2`; the form of one symbol that
    /// spans the range is mapped to `c + k s +- e`, so `h(v)` is in `c + (k/r) (v - (lo + hi)/2) +- e`.
    pub(super) fn by_range(self, h: impl Fn(Affine<1>) -> Affine<1>) -> Self {
        let x = self.range();
        if !x.is_bounded() || x.is_point() {
            return Self::constant(h(Affine::constant(x)).range());
        }
        let line = h(Affine::spanning(0, x));
        if !line.is_known() {
            return Self::UNKNOWN;
        }
        let half = exact(0.5);
        let (middle, radius) = ((exact(x.lo()) + exact(x.hi())) * half, (exact(x.hi()) - exact(x.lo())) * half);
        let offset = exact(line.centre()) + bounds(-line.error(), line.error());
        let [k] = *line.coefficients();
        if k == 0.0 {
            return Self::constant(offset);
        }
        self.add_interval(-middle).mul_interval(exact(k) / radius).add_interval(offset)
    }

    /// `h(x)` for a smooth `h`, by its Taylor polynomial about the middle `m` of the range `m +- r` of `x`.
    ///
    /// With `y = x - m`: `h(x) = h(m) + h'(m) y + h''(m)/2 y^2 + h'''(xi)/6 y^3`. Let `h'''/6` be in `k +- d` over the range;
    /// as `y^3 = 3/4 r^2 y +- r^3/4` on `[-r, r]`, the last term is `3/4 k r^2 y +- (|k| r^3/4 + d r^3)`.
    ///
    /// Where `h` is not three times differentiable on the whole range one of these numbers is infinite or empty, and the
    /// linear enclosure is taken; it is tried too where the remainder is as large as its error would be.
    fn by_taylor(self, h: Smooth, linear: impl Fn(Affine<1>) -> Affine<1>) -> Self {
        let x = self.range();
        if !x.is_bounded() {
            return self.by_range(linear);
        }
        let m = exact(x.mid());
        let r = exact(x.radius());
        let (h0, h1) = (h.range(m), h.first_range(m));
        let h2 = h.second_range(m) * exact(0.5);
        let third = h.third_range(x) / exact(6.0);
        if ![h0, h1, h2, third].iter().all(|k| k.is_bounded()) {
            return self.by_range(linear);
        }
        let (k, d) = (exact(third.mid()), exact(third.radius()));
        let cubic = k * r.sqr();
        let error = (cubic.abs() * exact(0.25) + d * r.sqr()) * r;
        let offset = h0 + error.hull(-error);
        let y = self.add_interval(-m);
        let slope = h1 + cubic * exact(0.75);
        let curved = (y.sqr().mul_interval(h2) + y.mul_interval(slope)).add_interval(offset);
        if error.hi() <= (h2.abs() * r.sqr()).hi() && curved.is_known() {
            curved
        } else {
            curved.narrower(self.by_range(linear))
        }
    }

    /// `1 / x`. Unknown if the range of `x` contains 0.
    #[must_use]
    pub fn recip(self) -> Self {
        let x = self.range();
        if x.certainly_negative() {
            -(-self).recip()
        } else if x.certainly_positive() {
            self.by_taylor(Smooth::Power(-Interval::ONE), Affine::recip)
        } else {
            Self::UNKNOWN
        }
    }

    /// `sqrt(x)` where `x >= 0`.
    #[must_use]
    pub fn sqrt(self) -> Self {
        self.by_taylor(Smooth::Power(exact(0.5)), Affine::sqrt)
    }

    /// Real cube root.
    #[must_use]
    pub fn cbrt(self) -> Self {
        let x = self.range();
        if x.certainly_negative() {
            -(-self).cbrt()
        } else if x.certainly_positive() {
            self.by_taylor(Smooth::Power(Interval::ONE / exact(3.0)), Affine::cbrt)
        } else {
            self.by_range(Affine::cbrt)
        }
    }

    /// `|x|`.
    #[must_use]
    pub fn abs(self) -> Self {
        let x = self.range();
        if x.lo() >= 0.0 {
            self
        } else if x.hi() <= 0.0 {
            -self
        } else {
            self.by_range(Affine::abs)
        }
    }

    /// The larger one: `y + max(x - y, 0)`.
    #[must_use]
    pub fn max(self, o: Self) -> Self {
        let d = self - o;
        let x = d.range();
        if x.lo() >= 0.0 {
            self
        } else if x.hi() <= 0.0 {
            o
        } else if d.is_known() {
            o + d.by_range(|d| d.max(Affine::ZERO))
        } else {
            Self::constant(self.range().max(o.range()))
        }
    }

    /// The smaller one: `-max(-x, -y)`.
    #[must_use]
    pub fn min(self, o: Self) -> Self {
        -(-self).max(-o)
    }

    /// Any mean `w x + (1 - w) y`: `(x + y)/2` is off by at most `|x - y|/2`.
    #[must_use]
    pub fn between(self, o: Self) -> Self {
        let d = exact((self - o).range().magnitude()) * exact(0.5);
        (self + o).mul_f64(0.5).add_interval(d.hull(-d))
    }

    /// -1, 0 or 1.
    #[must_use]
    pub fn sign(self) -> Self {
        self.by_range(Affine::sign)
    }

    /// Largest integer `<= x`.
    #[must_use]
    pub fn floor(self) -> Self {
        self.by_range(Affine::floor)
    }

    /// Arc cosine where `|x| <= 1`: `pi/2 - asin x`.
    #[must_use]
    pub fn acos(self) -> Self {
        (-self.asin()).add_interval(HALF_PI)
    }

    /// `x^y`: `exp(y ln x)` for `x > 0`; 0 for `x = 0 < y`.
    #[must_use]
    pub fn pow(self, y: Self) -> Self {
        let fixed = y.is_known() && y.l == [0.0; 3] && y.q == [0.0; 6];
        let exponent = y.range();
        if fixed {
            let line = |x: Affine<1>| x.pow(Affine::constant(exponent));
            self.by_taylor(Smooth::Power(exponent), line)
        } else if self.range().certainly_positive() {
            (y * self.ln()).exp()
        } else {
            Self::constant(self.range().pow(exponent))
        }
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
}

macro_rules! smooth {
    ($($name:ident $h:ident)*) => { impl Quadratic { $(
        /// The operator of that name, where it is defined.
        #[must_use]
        pub fn $name(self) -> Self {
            self.by_taylor(Smooth::$h, Affine::$name)
        }
    )* } };
}
smooth!(exp Exp ln Ln sin Sin cos Cos tan Tan asin Asin atan Atan sinh Sinh cosh Cosh tanh Tanh);

/// `x / y = x (1 / y)`. Unknown if the range of `y` contains 0.
impl Div for Quadratic {
    type Output = Self;
    #[expect(clippy::suspicious_arithmetic_impl, reason = "a quotient is a product with the reciprocal")]
    fn div(self, o: Self) -> Self {
        self * o.recip()
    }
}

impl sealed::Sealed for Quadratic {}

impl Form for Quadratic {
    const ZERO: Self = Self::ZERO;
    const UNKNOWN: Self = Self::UNKNOWN;
    inherent!(Quadratic: sqr sqrt cbrt abs sign floor exp ln sin cos tan asin acos atan sinh cosh tanh);

    /// As for affine forms, `h'(m) + h'''(xi)/24 (v - p)^2`, but the last factor keeps its form.
    fn mean_derivative(h: Smooth, both: Interval, middle: Self, difference: Self) -> Self {
        let curved = h.first(middle) + difference.sqr().mul_interval(h.third_range(both) / exact(24.0));
        curved.narrower(Self::constant(h.first_range(both)))
    }
}
