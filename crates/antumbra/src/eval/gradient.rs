//! Forward differentiation in interval arithmetic.
use super::Number;
use crate::expr::{Binary, Unary};
use antumbra_interval::Interval;

/// Enclosures of a value and of its partial derivatives over a box.
///
/// Where an operator has a kink (`abs`, `min`, `max`) the derivative is the hull of the one-sided ones: so the mean
/// value theorem holds (f is locally Lipschitz with those slopes). At a jump (`floor`, `sign`) nothing is known of
/// the derivative: it is the whole line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient {
    /// Enclosure of the value.
    pub value: Interval,
    /// Enclosures of the derivatives by x, y, z.
    pub partials: [Interval; 3],
}

impl Gradient {
    /// The three coordinates as functions of themselves.
    #[must_use]
    pub fn coordinates(x: [Interval; 3]) -> [Self; 3] {
        std::array::from_fn(|i| Self {
            value: x[i],
            partials: std::array::from_fn(|j| if i == j { Interval::ONE } else { Interval::ZERO }),
        })
    }

    /// `h(self)` by the chain rule: `value` encloses h, `slope` encloses h' over the range of self.
    #[inline]
    fn chain(self, value: Interval, slope: Interval) -> Self {
        Self::known(value, self.partials.map(|d| slope * d))
    }

    /// A slope is empty where no point of the box has a finite one: `1/(2 sqrt v)` at v = 0, where the value exists. An
    /// empty enclosure would claim that there is no value either; so nothing is known.
    #[inline]
    fn known(value: Interval, partials: [Interval; 3]) -> Self {
        Self { value, partials: partials.map(|d| if d.is_empty() && !value.is_empty() { Interval::ENTIRE } else { d }) }
    }

    #[inline]
    fn zip(self, o: Self, value: Interval, f: impl Fn(Interval, Interval) -> Interval) -> Self {
        Self::known(value, std::array::from_fn(|i| f(self.partials[i], o.partials[i])))
    }
}

/// Derivative of a step function with this range: 0 where it is constant.
fn step_slope(range: Interval) -> Interval {
    if range.lo() == range.hi() { Interval::ZERO } else { Interval::ENTIRE }
}

/// Which operand a minimum of `a` and `b` takes: `[1, 1]` the first, `[0, 0]` the second, `[0, 1]` open.
fn choice_of_min(a: Interval, b: Interval) -> Interval {
    if a.hi() < b.lo() {
        Interval::ONE
    } else if b.hi() < a.lo() {
        Interval::ZERO
    } else {
        Interval::new(0.0, 1.0)
    }
}

impl Number for Gradient {
    #[inline]
    fn constant(value: Interval) -> Self {
        Self { value, partials: [Interval::ZERO; 3] }
    }

    #[inline]
    fn unary(self, op: Unary) -> Self {
        let (v, one) = (self.value, Interval::ONE);
        let value = v.unary(op);
        match op {
            Unary::Neg => Self { value, partials: self.partials.map(|d| -d) },
            Unary::Abs => self.chain(value, v.sign()),
            Unary::Sign | Unary::Floor => self.chain(value, step_slope(value)),
            Unary::Sqr => self.chain(value, v + v),
            // (sqrt v)' = 1 / (2 sqrt v)
            Unary::Sqrt => self.chain(value, one / (value + value)),
            // (cbrt v)' = 1 / (3 cbrt(v)^2)
            Unary::Cbrt => self.chain(value, one / (Interval::point(3.0) * value.sqr())),
            Unary::Exp => self.chain(value, value),
            // The derivative only matters where ln is defined.
            Unary::Ln => self.chain(value, one / v.intersection(Interval::NON_NEGATIVE)),
            Unary::Sin => self.chain(value, v.cos()),
            Unary::Cos => self.chain(value, -v.sin()),
            Unary::Tan => self.chain(value, one + value.sqr()),
            Unary::Asin => self.chain(value, one / (one - v.intersection(Interval::new(-1.0, 1.0)).sqr()).sqrt()),
            Unary::Acos => self.chain(value, -(one / (one - v.intersection(Interval::new(-1.0, 1.0)).sqr()).sqrt())),
            Unary::Atan => self.chain(value, one / (one + v.sqr())),
            Unary::Sinh => self.chain(value, v.cosh()),
            Unary::Cosh => self.chain(value, v.sinh()),
            Unary::Tanh => self.chain(value, (one - value.sqr()).intersection(Interval::new(0.0, 1.0))),
        }
    }

    #[inline]
    fn powi(self, n: i32) -> Self {
        let value = self.value.powi(n);
        match n {
            0 => Self::constant(value),
            // n - 1 cannot overflow below: i32::MIN takes the wide way, n v^n / v.
            i32::MIN => self.chain(value, Interval::point(f64::from(n)) * value / self.value),
            _ => self.chain(value, Interval::point(f64::from(n)) * self.value.powi(n - 1)),
        }
    }

    #[inline]
    fn binary(self, op: Binary, o: Self) -> Self {
        let (a, b) = (self.value, o.value);
        let value = a.binary(op, b);
        match op {
            Binary::Add => self.zip(o, value, |x, y| x + y),
            Binary::Sub => self.zip(o, value, |x, y| x - y),
            Binary::Mul => self.zip(o, value, |x, y| a * y + x * b),
            // (a/b)' = (a' - (a/b) b') / b
            Binary::Div => self.zip(o, value, |x, y| (x - value * y) / b),
            Binary::Min | Binary::Max => {
                let first = match op {
                    Binary::Min => choice_of_min(a, b),
                    _ => choice_of_min(b, a),
                };
                match (first.lo(), first.hi()) {
                    (1.0, _) => Self { value, partials: self.partials },
                    (_, 0.0) => Self { value, partials: o.partials },
                    _ => self.zip(o, value, Interval::hull),
                }
            }
            // (a^b)' = b a^(b-1) a' + a^b ln(a) b', on a > 0. A constant exponent (b' = 0) needs no logarithm.
            Binary::Pow => {
                let base = a.intersection(Interval::NON_NEGATIVE);
                let by_base = b * base.pow(b - Interval::ONE);
                let by_exponent = value * base.ln();
                self.zip(o, value, |x, y| if y == Interval::ZERO { by_base * x } else { by_base * x + by_exponent * y })
            }
            // A jump by 2 pi lies where x < 0 and y passes 0 from below.
            Binary::Atan2 if b.lo() < 0.0 && a.lo() < 0.0 && a.hi() >= 0.0 => {
                Self { value, partials: [Interval::ENTIRE; 3] }
            }
            // atan2(y, x)' = (x y' - y x') / (x^2 + y^2)
            Binary::Atan2 => {
                let norm = a.sqr() + b.sqr();
                self.zip(o, value, |y, x| (b * y - a * x) / norm)
            }
        }
    }
}
