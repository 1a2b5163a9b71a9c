//! Derivatives of the smooth functions, as affine forms and as intervals.
use super::Affine;
use crate::Interval;

/// A function that is three times differentiable on its (convex) domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Smooth {
    Exp,
    Ln,
    Sin,
    Cos,
    Tan,
    Asin,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    /// `x^y` for any one `y` of the interval; domain `x > 0`.
    Power(Interval),
}

impl Smooth {
    /// Form of `h'(x)`.
    pub(super) fn first<const N: usize>(self, x: Affine<N>) -> Affine<N> {
        let one = Affine::constant(Interval::ONE);
        match self {
            Self::Exp => x.exp(),
            Self::Ln => x.recip(),
            Self::Sin => x.cos(),
            Self::Cos => -x.sin(),
            Self::Tan => x.tan().sqr().add_f64(1.0),
            Self::Asin => (one - x.sqr()).sqrt().recip(),
            Self::Atan => x.sqr().add_f64(1.0).recip(),
            Self::Sinh => x.cosh(),
            Self::Cosh => x.sinh(),
            Self::Tanh => one - x.tanh().sqr(),
            Self::Power(y) => x.pow(Affine::constant(y - Interval::ONE)).mul_interval(y),
        }
    }

    /// Range of `h'` over the part of the domain in `x`.
    pub(super) fn first_range(self, x: Interval) -> Interval {
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
    pub(super) fn third_range(self, x: Interval) -> Interval {
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
