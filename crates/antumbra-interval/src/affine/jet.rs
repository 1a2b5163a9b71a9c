//! Second-order jets: value, first and half the second derivative along a path, as forms.
use super::{
    derivative::Smooth,
    form::{Form, inherent, sealed},
    nonlinear::HALF_PI,
    point::exact,
};
use crate::Interval;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `f`, `f'` and `f''/2` along a path, as forms over the same symbols.
///
/// Wherever both derivatives are known `f` is twice continuously differentiable on the whole range of its operands: at
/// kinks, jumps, poles and at the ends of domains they are unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<F> {
    /// `f`.
    pub value: F,
    /// `f'`.
    pub first: F,
    /// `f''/2`: the coefficient of the Taylor series.
    pub second: F,
}

impl<F: Form> Jet<F> {
    /// A number of `k`.
    #[must_use]
    pub fn constant(k: Interval) -> Self {
        Self { value: F::constant(k), first: F::ZERO, second: F::ZERO }
    }

    /// `value + t first` at a parameter `t`: a coordinate on a ray.
    #[must_use]
    pub fn line(value: F, first: F) -> Self {
        Self { value, first, second: F::ZERO }
    }

    /// Contains every value.
    #[must_use]
    pub fn range(&self) -> Interval {
        self.value.range()
    }

    /// `f + k` for a number of `k`.
    #[must_use]
    pub fn add_interval(self, k: Interval) -> Self {
        Self { value: self.value.add_interval(k), ..self }
    }

    /// `f k` for a number of `k`.
    #[must_use]
    pub fn mul_interval(self, k: Interval) -> Self {
        let [value, first, second] = [self.value, self.first, self.second].map(|x| x.mul_interval(k));
        Self { value, first, second }
    }

    /// `f k` for the exact number `k`.
    #[must_use]
    pub fn mul_f64(self, k: f64) -> Self {
        let [value, first, second] = [self.value, self.first, self.second].map(|x| x.mul_f64(k));
        Self { value, first, second }
    }

    /// Derivatives unknown, or 0 where the value is one number.
    fn step(value: F) -> Self {
        let x = value.range();
        let derivative = if x.is_point() { F::ZERO } else { F::UNKNOWN };
        Self { value, first: derivative, second: derivative }
    }

    fn kink(value: F) -> Self {
        Self { value, first: F::UNKNOWN, second: F::UNKNOWN }
    }

    /// `f^2`: `(f^2)' = 2 f f'`, `(f^2)''/2 = 2 f (f''/2) + f'^2`.
    #[must_use]
    pub fn sqr(self) -> Self {
        let twice = self.value.mul_f64(2.0);
        Self { value: self.value.sqr(), first: twice * self.first, second: twice * self.second + self.first.sqr() }
    }

    /// `f^n` by products; `f^0 = 1`.
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
        let one = Self::constant(Interval::ONE);
        let (mut power, mut square, mut m) = (None, self, n.unsigned_abs());
        while m > 0 {
            if m & 1 == 1 {
                power = Some(power.map_or(square, |p: Self| p * square));
            }
            m >>= 1;
            if m > 0 {
                square = square.sqr();
            }
        }
        let Some(power) = power else { return one };
        let power = if n < 0 { one / power } else { power };
        Self { value: self.value.powi(n), ..power }
    }

    /// `r = sqrt(f)`: from `r^2 = f`, `2 r r' = f'` and `2 r (r''/2) + r'^2 = f''/2`.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        let twice = value.mul_f64(2.0);
        let first = self.first / twice;
        Self { value, first, second: (self.second - first.sqr()) / twice }
    }

    /// `r = cbrt(f)`: from `r^3 = f`, `3 r^2 r' = f'` and `3 r^2 (r''/2) + 3 r r'^2 = f''/2`.
    #[must_use]
    pub fn cbrt(self) -> Self {
        let value = self.value.cbrt();
        let scale = value.sqr().mul_f64(3.0);
        let first = self.first / scale;
        Self { value, first, second: (self.second - (value * first.sqr()).mul_f64(3.0)) / scale }
    }

    /// `h(f)`: `h' f'` and `h' f''/2 + (h''/2) f'^2`.
    fn smooth(self, h: Smooth, value: F) -> Self {
        if !h.defined_on(self.value.range()) {
            return Self::kink(value);
        }
        let slope = h.first(self.value);
        let bend = h.second_range(self.value.range()) * exact(0.5);
        let second = slope * self.second + self.first.sqr().mul_interval(known(bend));
        Self { value, first: slope * self.first, second }
    }

    /// `|f|`.
    #[must_use]
    pub fn abs(self) -> Self {
        let x = self.value.range();
        if x.lo() >= 0.0 {
            self
        } else if x.hi() <= 0.0 {
            -self
        } else {
            Self::kink(self.value.abs())
        }
    }

    /// The larger one.
    #[must_use]
    pub fn max(self, o: Self) -> Self {
        let d = (self.value - o.value).range();
        if d.lo() >= 0.0 {
            self
        } else if d.hi() <= 0.0 {
            o
        } else {
            Self::kink(self.value.max(o.value))
        }
    }

    /// The smaller one: `-max(-a, -b)`.
    #[must_use]
    pub fn min(self, o: Self) -> Self {
        -(-self).max(-o)
    }

    /// A mean of both: its derivatives are unknown unless they are the same.
    #[must_use]
    pub fn between(self, o: Self) -> Self {
        if self == o { self } else { Self::kink(self.value.between(o.value)) }
    }

    /// -1, 0 or 1.
    #[must_use]
    pub fn sign(self) -> Self {
        Self::step(self.value.sign())
    }

    /// Largest integer `<= f`.
    #[must_use]
    pub fn floor(self) -> Self {
        Self::step(self.value.floor())
    }

    /// Arc cosine, `pi/2 - asin f`.
    #[must_use]
    pub fn acos(self) -> Self {
        Self::constant(HALF_PI) - self.asin()
    }

    /// `f^y`, real exponent: by the derivatives of the power if `y` is constant, else `exp(y ln f)`.
    #[must_use]
    pub fn pow(self, y: Self) -> Self {
        let value = self.value.pow(y.value);
        if y.first == F::ZERO && y.second == F::ZERO {
            self.smooth(Smooth::Power(y.value.range()), value)
        } else {
            Self { value, ..(y * self.ln()).exp() }
        }
    }

    /// Angle of the point `(x, y)`, `self` being `y`; unknown derivatives where no half plane is settled.
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        let value = self.value.atan2(x.value);
        if x.value.range().certainly_positive() {
            Self { value, ..(self / x).atan() }
        } else if !self.value.range().possibly_zero() {
            Self { value, ..-(x / self).atan() }
        } else {
            Self::kink(value)
        }
    }
}

/// The empty interval, which says that the operator is defined nowhere, as no information.
fn known(k: Interval) -> Interval {
    if k.is_empty() { Interval::ENTIRE } else { k }
}

macro_rules! smooth {
    ($($name:ident $h:ident)*) => { impl<F: Form> Jet<F> { $(
        /// The operator of that name.
        #[must_use]
        pub fn $name(self) -> Self {
            self.smooth(Smooth::$h, self.value.$name())
        }
    )* } };
}
smooth!(exp Exp ln Ln sin Sin cos Cos tan Tan asin Asin atan Atan sinh Sinh cosh Cosh tanh Tanh);

impl<F: Form> Neg for Jet<F> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, first: -self.first, second: -self.second }
    }
}
impl<F: Form> Add for Jet<F> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self { value: self.value + o.value, first: self.first + o.first, second: self.second + o.second }
    }
}
impl<F: Form> Sub for Jet<F> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self { value: self.value - o.value, first: self.first - o.first, second: self.second - o.second }
    }
}
/// Cauchy product of the Taylor coefficients.
impl<F: Form> Mul for Jet<F> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self {
            value: self.value * o.value,
            first: self.value * o.first + self.first * o.value,
            second: self.value * o.second + self.first * o.first + self.second * o.value,
        }
    }
}
/// `q = a / b` from `q b = a`, coefficient by coefficient.
impl<F: Form> Div for Jet<F> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let value = self.value / o.value;
        let first = (self.first - value * o.first) / o.value;
        Self { value, first, second: (self.second - value * o.second - first * o.first) / o.value }
    }
}

impl<F: Form> sealed::Sealed for Jet<F> {}

impl<F: Form> Form for Jet<F> {
    const ZERO: Self = Self { value: F::ZERO, first: F::ZERO, second: F::ZERO };
    const UNKNOWN: Self = Self { value: F::UNKNOWN, first: F::UNKNOWN, second: F::UNKNOWN };
    inherent!(Jet: sqr sqrt cbrt abs sign floor exp ln sin cos tan asin acos atan sinh cosh tanh);

    /// The mean is `m(v) = int_0^1 h'(p + w (v - p)) dw`. Differentiated under the integral, with `p` constant:
    /// `m'(v) = int w h''(..) dw` lies in `h''/2` over the hull of both, `m''(v) = int w^2 h'''(..) dw` in `h'''/3`. Then
    /// `m' v'` and `m' v''/2 + (m''/2) v'^2` by the chain rule; the derivatives of `v` are those of `difference`.
    fn mean_derivative(h: Smooth, both: Interval, middle: Self, difference: Self) -> Self {
        let value = F::mean_derivative(h, both, middle.value, difference.value);
        if !h.defined_on(both) {
            return Self::kink(value);
        }
        let first = known(h.second_range(both)) * exact(0.5);
        let half_second = known(h.third_range(both)) / exact(6.0);
        Self {
            value,
            first: difference.first.mul_interval(first),
            second: difference.second.mul_interval(first) + difference.first.sqr().mul_interval(half_second),
        }
    }
}
