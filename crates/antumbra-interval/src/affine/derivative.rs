//! Derivatives of the smooth functions, as affine forms and as intervals.
use super::{Form, point::exact};
use crate::Interval;

/// A function that is three times differentiable on its (convex) domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Smooth {
    /// `e^x`.
    Exp,
    /// Natural logarithm, `x > 0`.
    Ln,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Tangent, between two poles.
    Tan,
    /// Arc sine.
    Asin,
    /// Arc tangent.
    Atan,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
    /// `x^y` for any one `y` of the interval; domain `x > 0`.
    Power(Interval),
}

impl Smooth {
    /// Form of `h'(x)`.
    pub(crate) fn first<F: Form>(self, x: F) -> F {
        let one = F::constant(Interval::ONE);
        match self {
            Self::Exp => x.exp(),
            Self::Ln => one / x,
            Self::Sin => x.cos(),
            Self::Cos => -x.sin(),
            Self::Tan => x.tan().sqr().add_interval(Interval::ONE),
            Self::Asin => one / (one - x.sqr()).sqrt(),
            Self::Atan => one / x.sqr().add_interval(Interval::ONE),
            Self::Sinh => x.cosh(),
            Self::Cosh => x.sinh(),
            Self::Tanh => one - x.tanh().sqr(),
            Self::Power(y) => x.pow(F::constant(y - Interval::ONE)).mul_interval(y),
        }
    }

    /// Whether all of `x` is inside the domain, so that `h` is smooth there (the tangent: its derivatives are unbounded
    /// across a pole).
    pub(crate) fn defined_on(self, x: Interval) -> bool {
        match self {
            Self::Ln | Self::Power(_) => x.certainly_positive(),
            Self::Asin => x.lo() > -1.0 && x.hi() < 1.0,
            _ => true,
        }
    }

    /// Range of `h` over the part of the domain in `x`.
    pub(crate) fn range(self, x: Interval) -> Interval {
        match self {
            Self::Exp => x.exp(),
            Self::Ln => x.ln(),
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Tan => x.tan(),
            Self::Asin => x.asin(),
            Self::Atan => x.atan(),
            Self::Sinh => x.sinh(),
            Self::Cosh => x.cosh(),
            Self::Tanh => x.tanh(),
            Self::Power(y) => positive(x).pow(y),
        }
    }

    /// Range of `h''` over the part of the domain in `x`.
    ///
    /// `tan'' = 2 tan (1 + tan^2)`, `asin'' = x/(1 - x^2)^(3/2)`, `atan'' = -2x/(1 + x^2)^2`,
    /// `tanh'' = -2 tanh (1 - tanh^2)`.
    pub(crate) fn second_range(self, x: Interval) -> Interval {
        let (one, two) = (Interval::ONE, exact(2.0));
        match self {
            Self::Exp => x.exp(),
            Self::Ln => -(one / positive(x).sqr()),
            Self::Sin => -x.sin(),
            Self::Cos => -x.cos(),
            Self::Tan => {
                let t = x.tan();
                two * t * (one + t.sqr())
            }
            Self::Asin => {
                let x = x.intersection(Interval::new(-1.0, 1.0));
                let s = one - x.sqr();
                x / (s * s.sqrt())
            }
            Self::Atan => -(two * x) / (one + x.sqr()).sqr(),
            Self::Sinh => x.sinh(),
            Self::Cosh => x.cosh(),
            Self::Tanh => {
                let t = x.tanh();
                -(two * t) * (one - t.sqr())
            }
            Self::Power(y) => y * (y - one) * positive(x).pow(y - two),
        }
    }

    /// Range of `h'` over the part of the domain in `x`.
    pub(crate) fn first_range(self, x: Interval) -> Interval {
        let one = Interval::ONE;
        match self {
            Self::Exp => x.exp(),
            Self::Ln => one / positive(x),
            Self::Sin => x.cos(),
            Self::Cos => -x.sin(),
            Self::Tan => one + x.tan().sqr(),
            Self::Asin => one / (one - x.intersection(Interval::new(-1.0, 1.0)).sqr()).sqrt(),
            Self::Atan => one / (one + x.sqr()),
            Self::Sinh => x.cosh(),
            Self::Cosh => x.sinh(),
            Self::Tanh => one - x.tanh().sqr(),
            Self::Power(y) => y * positive(x).pow(y - one),
        }
    }

    /// Range of `h'''` over the part of the domain in `x`.
    ///
    /// `tan''' = 2 + 8 tan^2 + 6 tan^4`, `asin''' = (1 + 2x^2)/(1 - x^2)^(5/2)`, `atan''' = (6x^2 - 2)/(1 + x^2)^3`,
    /// `tanh''' = (1 - tanh^2)(6 tanh^2 - 2)`.
    pub(crate) fn third_range(self, x: Interval) -> Interval {
        let (one, two, six) = (Interval::ONE, Interval::point(2.0), Interval::point(6.0));
        match self {
            Self::Exp => x.exp(),
            Self::Ln => two / (positive(x).sqr() * positive(x)),
            Self::Sin => -x.cos(),
            Self::Cos => x.sin(),
            Self::Tan => {
                let t = x.tan().sqr();
                two + t * (Interval::point(8.0) + six * t)
            }
            Self::Asin => {
                let s = x.intersection(Interval::new(-1.0, 1.0)).sqr();
                let r = (one - s).sqrt();
                (one + two * s) / (r.sqr().sqr() * r)
            }
            Self::Atan => {
                let d = one + x.sqr();
                (six * x.sqr() - two) / (d.sqr() * d)
            }
            Self::Sinh => x.cosh(),
            Self::Cosh => x.sinh(),
            Self::Tanh => {
                let t = x.tanh().sqr();
                (one - t) * (six * t - two)
            }
            Self::Power(y) => y * (y - one) * (y - two) * positive(x).pow(y - Interval::point(3.0)),
        }
    }
}

/// The part with `x >= 0`.
fn positive(x: Interval) -> Interval {
    x.intersection(Interval::new(0.0, f64::INFINITY))
}
