//! Value and derivative along one direction: the slope for `t -> 0`.
use super::{Affine, derivative::Smooth, nonlinear::HALF_PI};
use crate::Interval;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `f` and its derivative along a path, as forms over the same symbols.
///
/// The derivative is enclosed where `f` is differentiable; at a kink of `abs`, `min`, `max` every one-sided (and every
/// generalised) derivative is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize> {
    /// `f`.
    pub value: Affine<N>,
    /// `f'`.
    pub derivative: Affine<N>,
}

impl<const N: usize> Dual<N> {
    /// A number of `k`.
    #[must_use]
    pub fn constant(k: Interval) -> Self {
        Self { value: Affine::constant(k), derivative: Affine::ZERO }
    }

    /// `f + k` for a number of `k`.
    #[must_use]
    pub fn add_interval(self, k: Interval) -> Self {
        Self { value: self.value.add_interval(k), derivative: self.derivative }
    }

    /// `f k` for a number of `k`.
    #[must_use]
    pub fn mul_interval(self, k: Interval) -> Self {
        Self { value: self.value.mul_interval(k), derivative: self.derivative.mul_interval(k) }
    }

    /// `f k` for the exact number `k`.
    #[must_use]
    pub fn mul_f64(self, k: f64) -> Self {
        Self { value: self.value.mul_f64(k), derivative: self.derivative.mul_f64(k) }
    }

    /// `f^2`.
    #[must_use]
    pub fn sqr(self) -> Self {
        Self { value: self.value.sqr(), derivative: (self.value * self.derivative).mul_f64(2.0) }
    }

    /// `f^n`: `n f^(n-1) f'`.
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
        let derivative = match n {
            0 => Affine::ZERO,
            // n - 1 does not exist.
            i32::MIN => Affine::UNKNOWN,
            _ => self.value.powi(n - 1).mul_f64(f64::from(n)) * self.derivative,
        };
        Self { value: self.value.powi(n), derivative }
    }

    /// `sqrt(f)`: `f' / (2 sqrt f)`.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        Self { value, derivative: self.derivative / value.mul_f64(2.0) }
    }

    /// Cube root: `f' / (3 cbrt(f)^2)`.
    #[must_use]
    pub fn cbrt(self) -> Self {
        let value = self.value.cbrt();
        Self { value, derivative: self.derivative / value.sqr().mul_f64(3.0) }
    }

    /// `|f|`.
    #[must_use]
    pub fn abs(self) -> Self {
        let x = self.value.range();
        let derivative = if x.lo() >= 0.0 {
            self.derivative
        } else if x.hi() <= 0.0 {
            -self.derivative
        } else {
            self.derivative.between(-self.derivative)
        };
        Self { value: self.value.abs(), derivative }
    }

    /// The larger one.
    #[must_use]
    pub fn max(self, o: Self) -> Self {
        let d = (self.value - o.value).range();
        let derivative = if d.lo() >= 0.0 {
            self.derivative
        } else if d.hi() <= 0.0 {
            o.derivative
        } else {
            self.derivative.between(o.derivative)
        };
        Self { value: self.value.max(o.value), derivative }
    }

    /// The smaller one: `-max(-a, -b)`.
    #[must_use]
    pub fn min(self, o: Self) -> Self {
        let m = (-self).max(-o);
        Self { value: self.value.min(o.value), derivative: -m.derivative }
    }

    /// -1, 0 or 1: derivative 0 where constant, else unknown.
    #[must_use]
    pub fn sign(self) -> Self {
        Self::step(self.value.sign())
    }

    /// Largest integer `<= f`: derivative 0 where constant, else unknown.
    #[must_use]
    pub fn floor(self) -> Self {
        Self::step(self.value.floor())
    }

    fn step(value: Affine<N>) -> Self {
        let x = value.range();
        Self { value, derivative: if x.lo() == x.hi() { Affine::ZERO } else { Affine::UNKNOWN } }
    }

    fn smooth(self, h: Smooth, value: Affine<N>) -> Self {
        Self { value, derivative: self.derivative * h.first(self.value) }
    }

    /// Arc cosine, `pi/2 - asin f`.
    #[must_use]
    pub fn acos(self) -> Self {
        Self::constant(HALF_PI) - self.asin()
    }

    /// `f^y`, real exponent: by the derivative of the power if `y` is constant (derivative 0), else `exp(y ln f)`.
    #[must_use]
    pub fn pow(self, y: Self) -> Self {
        let value = self.value.pow(y.value);
        if y.derivative == Affine::ZERO {
            self.smooth(Smooth::Power(y.value.range()), value)
        } else {
            Self { value, derivative: (y * self.ln()).exp().derivative }
        }
    }

    /// Angle of the point `(x, y)`, `self` being `y`; unknown derivative where no half plane is settled.
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        let derivative = if x.value.range().certainly_positive() {
            (self / x).atan().derivative
        } else if !self.value.range().possibly_zero() {
            -(x / self).atan().derivative
        } else {
            Affine::UNKNOWN
        };
        Self { value: self.value.atan2(x.value), derivative }
    }
}

macro_rules! smooth {
    ($($name:ident $h:ident)*) => { impl<const N: usize> Dual<N> { $(
        /// The operator of that name: `h'(f) f'`.
        #[must_use]
        pub fn $name(self) -> Self {
            self.smooth(Smooth::$h, self.value.$name())
        }
    )* } };
}
smooth!(exp Exp ln Ln sin Sin cos Cos tan Tan asin Asin atan Atan sinh Sinh cosh Cosh tanh Tanh);

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, derivative: -self.derivative }
    }
}
impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self { value: self.value + o.value, derivative: self.derivative + o.derivative }
    }
}
impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self { value: self.value - o.value, derivative: self.derivative - o.derivative }
    }
}
/// `(a b)' = a b' + a' b`.
impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let derivative = self.value * o.derivative + self.derivative * o.value;
        Self { value: self.value * o.value, derivative }
    }
}
/// `(a / b)' = (a' - (a/b) b') / b`.
impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let value = self.value / o.value;
        Self { value, derivative: (self.derivative - value * o.derivative) / o.value }
    }
}
