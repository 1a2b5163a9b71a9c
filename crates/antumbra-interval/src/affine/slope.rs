//! Slopes (deflation): what remains of a function after its value at an apex is split off.
//!
//! With `P` the apex, `D` a direction and `t` a parameter, a [`Slope`] of `f` holds `f(P)`, `f(P + t D)` and a slope `g`
//! with `f(P + t D) = f(P) + t g`, for every value of the symbols where both values are defined. At a zero `P` of `f` the
//! sign of `f(P + t D)` is the sign of `t g`, without cancellation however small `t` is; `g` at `t = 0` is `grad f . D`.
use super::{
    Affine,
    derivative::Smooth,
    form::{Apex, Form},
    nonlinear::HALF_PI,
    point::exact,
};
use crate::Interval;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A slope whose value and slope are affine forms of `N` symbols.
pub type Slope<P, const N: usize> = SlopeOf<P, Affine<N>>;

/// `f(P)`, `f(P + t D)` and `g` with `f(P + t D) = f(P) + t g`. `t` itself is not stored: all operands share it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeOf<P, F> {
    /// `f(P)`, at the apex.
    pub apex: P,
    /// `f(P + t D)`.
    pub value: F,
    /// `g`.
    pub slope: F,
}

impl<P: Apex<F>, F: Form> SlopeOf<P, F> {
    /// A number of `k`, the same at the apex and elsewhere.
    #[must_use]
    pub fn constant(k: Interval) -> Self {
        Self { apex: P::constant(k), value: F::constant(k), slope: F::ZERO }
    }

    /// The coordinate `P + t d`, for the shared parameter `t`.
    #[must_use]
    pub fn coordinate(apex: P, t: F, d: F) -> Self {
        Self { apex, value: apex.shift(t * d), slope: d }
    }

    /// `f + k` for a number of `k`, the same at the apex and elsewhere.
    #[must_use]
    pub fn add_interval(self, k: Interval) -> Self {
        Self { apex: self.apex.add_interval(k), value: self.value.add_interval(k), slope: self.slope }
    }

    /// `f k` for a number of `k`, the same at the apex and elsewhere.
    #[must_use]
    pub fn mul_interval(self, k: Interval) -> Self {
        Self { apex: self.apex.mul_interval(k), value: self.value.mul_interval(k), slope: self.slope.mul_interval(k) }
    }

    /// `f k` for the exact number `k`.
    #[must_use]
    pub fn mul_f64(self, k: f64) -> Self {
        Self { apex: self.apex.mul_interval(exact(k)), value: self.value.mul_f64(k), slope: self.slope.mul_f64(k) }
    }

    /// `f^2`: `v^2 - p^2 = (v - p)(v + p)`.
    #[must_use]
    pub fn sqr(self) -> Self {
        Self { apex: self.apex.sqr(), value: self.value.sqr(), slope: self.slope * self.apex.shift(self.value) }
    }

    /// `f^n` by the product rule; `f^0 = 1`.
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
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
        let one = Self::constant(Interval::ONE);
        let Some(power) = power else { return one };
        let slope = if n < 0 { (one / power).slope } else { power.slope };
        Self { apex: self.apex.powi(n), value: self.value.powi(n), slope }
    }

    /// `sqrt(f)`: `sqrt v - sqrt p = (v - p)/(sqrt v + sqrt p)`.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let (apex, value) = (self.apex.sqrt(), self.value.sqrt());
        Self { apex, value, slope: self.slope / apex.shift(value) }
    }

    /// Cube root: with `a^3 = v`, `b^3 = p`, `v - p = (a - b)(a^2 + a b + b^2)`, where
    /// `a^2 + a b + b^2 = (a + b/2)^2 + 3/4 b^2`.
    #[must_use]
    pub fn cbrt(self) -> Self {
        let (apex, value) = (self.apex.cbrt(), self.value.cbrt());
        let square = apex.mul_interval(exact(0.5)).shift(value).sqr();
        let rest = apex.sqr().mul_interval(exact(0.75)).shift(square);
        Self { apex, value, slope: self.slope / rest }
    }

    /// `|f|`: `+-g` where the sign is settled; else `||v| - |p|| <= |v - p|`. Settled strictly at the apex, so that it is also near
    /// it: there the slope is the limit of the slopes beyond, where f has one.
    #[must_use]
    pub fn abs(self) -> Self {
        let (p, v) = (self.apex.range(), self.value.range());
        let slope = if p.lo() > 0.0 && v.lo() >= 0.0 {
            self.slope
        } else if p.hi() < 0.0 && v.hi() <= 0.0 {
            -self.slope
        } else {
            self.slope.between(-self.slope)
        };
        Self { apex: self.apex.abs(), value: self.value.abs(), slope }
    }

    /// The larger one.
    ///
    /// Where the choice is the same at the apex and beyond, its slope. Where it changes, say `a` at the apex and `b`
    /// beyond: `b_v - a_p >= a_v - a_p = t s_a` and `b_v - a_p <= b_v - b_p = t s_b`, so the slope lies between both.
    /// The choice at the apex is strict, as for [`abs`](Self::abs).
    #[must_use]
    pub fn max(self, o: Self) -> Self {
        let (p, v) = ((self.apex - o.apex).range(), (self.value - o.value).range());
        let slope = if p.lo() > 0.0 && v.lo() >= 0.0 {
            self.slope
        } else if p.hi() < 0.0 && v.hi() <= 0.0 {
            o.slope
        } else {
            self.slope.between(o.slope)
        };
        Self { apex: self.apex.max(o.apex), value: self.value.max(o.value), slope }
    }

    /// The smaller one: `-max(-a, -b)`.
    #[must_use]
    pub fn min(self, o: Self) -> Self {
        let slope = (-self).max(-o).slope;
        Self { apex: self.apex.min(o.apex), value: self.value.min(o.value), slope: -slope }
    }

    /// -1, 0 or 1: slope 0 where constant, else unknown.
    #[must_use]
    pub fn sign(self) -> Self {
        Self::step(self.apex.sign(), self.value.sign())
    }

    /// Largest integer `<= f`: slope 0 where constant, else unknown.
    #[must_use]
    pub fn floor(self) -> Self {
        Self::step(self.apex.floor(), self.value.floor())
    }

    fn step(apex: P, value: F) -> Self {
        let both = apex.range().hull(value.range());
        let slope = if both.lo() == both.hi() { F::ZERO } else { F::UNKNOWN };
        Self { apex, value, slope }
    }

    /// `h(f)` with values already computed: `(h(v) - h(p))/(v - p)` is the mean of `h'` from `p` to `v`.
    fn smooth(self, h: Smooth, apex: P, value: F) -> Self {
        let both = self.apex.range().hull(self.value.range());
        let middle = self.apex.shift(self.value).mul_f64(0.5);
        let difference = (-self.apex).shift(self.value);
        Self { apex, value, slope: self.slope * F::mean_derivative(h, both, middle, difference) }
    }

    /// `e^f`.
    #[must_use]
    pub fn exp(self) -> Self {
        self.smooth(Smooth::Exp, self.apex.exp(), self.value.exp())
    }
    /// Natural logarithm.
    #[must_use]
    pub fn ln(self) -> Self {
        self.smooth(Smooth::Ln, self.apex.ln(), self.value.ln())
    }
    /// Sine.
    #[must_use]
    pub fn sin(self) -> Self {
        self.smooth(Smooth::Sin, self.apex.sin(), self.value.sin())
    }
    /// Cosine.
    #[must_use]
    pub fn cos(self) -> Self {
        self.smooth(Smooth::Cos, self.apex.cos(), self.value.cos())
    }
    /// Tangent; unknown slope across a pole.
    #[must_use]
    pub fn tan(self) -> Self {
        self.smooth(Smooth::Tan, self.apex.tan(), self.value.tan())
    }
    /// Arc sine.
    #[must_use]
    pub fn asin(self) -> Self {
        self.smooth(Smooth::Asin, self.apex.asin(), self.value.asin())
    }
    /// Arc cosine, `pi/2 - asin f`.
    #[must_use]
    pub fn acos(self) -> Self {
        Self::constant(HALF_PI) - self.asin()
    }
    /// Arc tangent.
    #[must_use]
    pub fn atan(self) -> Self {
        self.smooth(Smooth::Atan, self.apex.atan(), self.value.atan())
    }
    /// Hyperbolic sine.
    #[must_use]
    pub fn sinh(self) -> Self {
        self.smooth(Smooth::Sinh, self.apex.sinh(), self.value.sinh())
    }
    /// Hyperbolic cosine.
    #[must_use]
    pub fn cosh(self) -> Self {
        self.smooth(Smooth::Cosh, self.apex.cosh(), self.value.cosh())
    }
    /// Hyperbolic tangent.
    #[must_use]
    pub fn tanh(self) -> Self {
        self.smooth(Smooth::Tanh, self.apex.tanh(), self.value.tanh())
    }

    /// `f^y`, real exponent: by the derivative of the power if `y` is constant (slope 0), else `exp(y ln f)`.
    #[must_use]
    pub fn pow(self, y: Self) -> Self {
        let (apex, value) = (self.apex.pow(y.apex), self.value.pow(y.value));
        if y.slope == F::ZERO {
            self.smooth(Smooth::Power(y.value.range()), apex, value)
        } else {
            Self { apex, value, slope: (y * self.ln()).exp().slope }
        }
    }

    /// Angle of the point `(x, y)`, `self` being `y`, as [`Affine::atan2`]; unknown slope where no half plane is settled.
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        let (ry, rx) = (self.apex.range().hull(self.value.range()), x.apex.range().hull(x.value.range()));
        let slope = if rx.certainly_positive() {
            (self / x).atan().slope
        } else if !ry.possibly_zero() {
            -(x / self).atan().slope
        } else {
            F::UNKNOWN
        };
        Self { apex: self.apex.atan2(x.apex), value: self.value.atan2(x.value), slope }
    }
}

impl<P: Apex<F>, F: Form> Neg for SlopeOf<P, F> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { apex: -self.apex, value: -self.value, slope: -self.slope }
    }
}
impl<P: Apex<F>, F: Form> Add for SlopeOf<P, F> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self { apex: self.apex + o.apex, value: self.value + o.value, slope: self.slope + o.slope }
    }
}
impl<P: Apex<F>, F: Form> Sub for SlopeOf<P, F> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self { apex: self.apex - o.apex, value: self.value - o.value, slope: self.slope - o.slope }
    }
}
/// `v_a v_b - p_a p_b = (v_a - p_a) v_b + p_a (v_b - p_b)`.
impl<P: Apex<F>, F: Form> Mul for SlopeOf<P, F> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let slope = self.slope * o.value + self.apex.scale(o.slope);
        Self { apex: self.apex * o.apex, value: self.value * o.value, slope }
    }
}
/// With `q = p_a / p_b`: `v_a / v_b - q = (v_a - q v_b) / v_b = ((v_a - p_a) - q (v_b - p_b)) / v_b`.
impl<P: Apex<F>, F: Form> Div for SlopeOf<P, F> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let q = self.apex / o.apex;
        Self { apex: q, value: self.value / o.value, slope: (self.slope - q.scale(o.slope)) / o.value }
    }
}
