//! Unevaluated sums of two `f64`: about 31 digits for `+ - * / sqrt` and powers. Other functions are as exact as `f64`.
use antumbra::eval::Number;
use antumbra::expr::{Binary, Unary};
use antumbra_interval::Interval;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `hi + lo`, `|lo| <= ulp(hi) / 2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Double {
    pub(crate) hi: f64,
    lo: f64,
}

/// Knuth's sum: `a + b = hi + lo` exactly.
fn two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    let c = hi - a;
    Double { hi, lo: (a - (hi - c)) + (b - c) }
}

impl From<f64> for Double {
    fn from(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }
}

impl Neg for Double {
    type Output = Self;

    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

impl Add for Double {
    type Output = Self;

    fn add(self, o: Self) -> Self {
        let (s, t) = (two_sum(self.hi, o.hi), two_sum(self.lo, o.lo));
        let s = two_sum(s.hi, s.lo + t.hi);
        two_sum(s.hi, s.lo + t.lo)
    }
}

impl Sub for Double {
    type Output = Self;

    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for Double {
    type Output = Self;

    fn mul(self, o: Self) -> Self {
        let hi = self.hi * o.hi;
        two_sum(hi, self.hi.mul_add(o.hi, -hi) + (self.hi * o.lo + self.lo * o.hi))
    }
}

impl Div for Double {
    type Output = Self;

    fn div(self, o: Self) -> Self {
        if o.hi == 0.0 {
            return f64::NAN.into();
        }
        // Two steps of long division.
        let first = self.hi / o.hi;
        let rest = self - o * first.into();
        let second = rest.hi / o.hi;
        let rest = rest - o * second.into();
        two_sum(first, second) + (rest.hi / o.hi).into()
    }
}

impl Double {
    fn sqrt(self) -> Self {
        if self.hi <= 0.0 {
            return if self.hi == 0.0 { 0.0 } else { f64::NAN }.into();
        }
        // One step of Newton doubles the digits.
        let root = self.hi.sqrt();
        two_sum(root, (self - Self::from(root) * root.into()).hi / (2.0 * root))
    }

    fn negative(self) -> bool {
        self.hi < 0.0
    }
}

impl Number for Double {
    fn constant(value: Interval) -> Self {
        value.mid().into()
    }

    fn unary(self, op: Unary) -> Self {
        let Self { hi, lo } = self;
        match op {
            Unary::Neg => -self,
            Unary::Abs if self.negative() => -self,
            Unary::Abs => self,
            Unary::Sqr => self * self,
            Unary::Sqrt => self.sqrt(),
            Unary::Sin => Self::from(core_math::sin(hi)) + (core_math::cos(hi) * lo).into(),
            Unary::Cos => Self::from(core_math::cos(hi)) + (-core_math::sin(hi) * lo).into(),
            _ => hi.unary(op).into(),
        }
    }

    fn powi(self, n: i32) -> Self {
        if n < 0 {
            return Self::from(1.0) / self.powi(-n);
        }
        (0..n).fold(1.0.into(), |p, _| p * self)
    }

    fn binary(self, op: Binary, o: Self) -> Self {
        match op {
            Binary::Add => self + o,
            Binary::Sub => self - o,
            Binary::Mul => self * o,
            Binary::Div => self / o,
            Binary::Min | Binary::Max if self.hi.is_nan() || o.hi.is_nan() => f64::NAN.into(),
            Binary::Min => {
                if (self - o).negative() {
                    self
                } else {
                    o
                }
            }
            Binary::Max => {
                if (self - o).negative() {
                    o
                } else {
                    self
                }
            }
            _ => self.hi.binary(op, o.hi).into(),
        }
    }
}
