//! Decorations: what is known of a function on its whole box, besides its range (IEEE 1788, simplified).
//!
//! A sign change proves a root only if the function is defined and continuous in between: `1/x` changes sign without
//! one. An evaluation in [`Decorated`] arithmetic carries that proof along.
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::Interval;

/// What has been proved of a function on the whole box it was evaluated over. Each level implies those below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Decoration {
    /// Nothing (IEEE 1788 `trv`).
    Trivial,
    /// Defined at every point of the box (`def`).
    Defined,
    /// Defined on the box, and its restriction to the box continuous (`dac`).
    Continuous,
}

/// An enclosure of the range of a function over a box, and what is proved of the function on that box.
///
/// Start with [`Decorated::from`] on the inputs (the identity is continuous) and apply the operations: a result is
/// decorated with the weakest of its operands and of the operation itself on their enclosures, because a composition of
/// continuous functions is continuous. The empty interval is always `Trivial`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decorated {
    /// Contains every value that the function takes on the box.
    pub interval: Interval,
    /// Proved of the function on the box.
    pub decoration: Decoration,
}

impl From<Interval> for Decorated {
    /// A variable or a constant: continuous, unless there is no value.
    fn from(interval: Interval) -> Self {
        Self { interval, decoration: Continuous }.checked()
    }
}

use Decoration::{Continuous, Defined, Trivial};

/// `Continuous` if the operation is continuous wherever it is defined, and defined on all its operands.
fn continuous_if(proved: bool) -> Decoration {
    if proved { Continuous } else { Trivial }
}

impl Decorated {
    /// An enclosure of a function that is known to be of this kind on its box.
    #[must_use]
    pub fn new(interval: Interval, decoration: Decoration) -> Self {
        Self { interval, decoration }.checked()
    }
    /// Whether the function is proved defined and continuous on the box.
    #[must_use]
    pub fn certainly_continuous(self) -> bool {
        self.decoration == Continuous
    }
    /// Whether the function is proved defined on the box.
    #[must_use]
    pub fn certainly_defined(self) -> bool {
        self.decoration >= Defined
    }
    fn checked(self) -> Self {
        if self.interval.is_empty() { Self { decoration: Trivial, ..self } } else { self }
    }
    fn unary(self, interval: Interval, local: Decoration) -> Self {
        Self { interval, decoration: self.decoration.min(local) }.checked()
    }
    fn binary(self, o: Self, interval: Interval, local: Decoration) -> Self {
        Self { interval, decoration: self.decoration.min(o.decoration).min(local) }.checked()
    }
    /// `1 / a`, continuous where the operand excludes 0.
    #[must_use]
    pub fn recip(self) -> Self {
        self.unary(self.interval.recip(), continuous_if(!self.interval.possibly_zero()))
    }
    /// Square root, continuous where the operand is >= 0.
    #[must_use]
    pub fn sqrt(self) -> Self {
        self.unary(self.interval.sqrt(), continuous_if(self.interval.certainly_nonnegative()))
    }
    /// Natural logarithm, continuous where the operand is > 0.
    #[must_use]
    pub fn ln(self) -> Self {
        self.unary(self.interval.ln(), continuous_if(self.interval.certainly_positive()))
    }
    /// Tangent, continuous where the operand contains no pole.
    #[must_use]
    pub fn tan(self) -> Self {
        self.unary(self.interval.tan(), continuous_if(!self.interval.possibly_has_tan_pole()))
    }
    /// Arc sine, continuous where the operand lies in [-1, 1].
    #[must_use]
    pub fn asin(self) -> Self {
        self.unary(self.interval.asin(), continuous_if(self.interval.is_subset_of(Interval::new(-1.0, 1.0))))
    }
    /// Arc cosine, continuous where the operand lies in [-1, 1].
    #[must_use]
    pub fn acos(self) -> Self {
        self.unary(self.interval.acos(), continuous_if(self.interval.is_subset_of(Interval::new(-1.0, 1.0))))
    }
    /// Floor: defined everywhere, continuous where it is constant.
    #[must_use]
    pub fn floor(self) -> Self {
        self.step(self.interval.floor())
    }
    /// Ceiling: defined everywhere, continuous where it is constant.
    #[must_use]
    pub fn ceil(self) -> Self {
        self.step(self.interval.ceil())
    }
    /// Sign: defined everywhere, continuous where it is constant.
    #[must_use]
    pub fn sign(self) -> Self {
        self.step(self.interval.sign())
    }
    /// A step function is continuous on a box exactly where it takes one value.
    fn step(self, value: Interval) -> Self {
        self.unary(value, if value.is_point() { Continuous } else { Defined })
    }
    /// Integer power, continuous for `n >= 0` or where the operand excludes 0.
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
        self.unary(self.interval.powi(n), continuous_if(n >= 0 || !self.interval.possibly_zero()))
    }
    /// Real power, continuous where the base is > 0, or >= 0 with an exponent > 0.
    #[must_use]
    pub fn pow(self, y: Self) -> Self {
        let x = self.interval;
        let inside = x.certainly_positive() || (x.certainly_nonnegative() && y.interval.certainly_positive());
        self.binary(y, x.pow(y.interval), continuous_if(inside))
    }
    /// Angle of the points `(x, y)`, `self` being y: defined off the origin, continuous where the box does not meet the
    /// cut (the negative x axis) from below.
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        let (y, x_box) = (self.interval, x.interval);
        let local = if y.possibly_zero() && x_box.possibly_zero() {
            Trivial
        } else if x_box.certainly_nonnegative() || y.certainly_nonnegative() || y.certainly_negative() {
            Continuous
        } else {
            Defined
        };
        self.binary(x, y.atan2(x_box), local)
    }
    /// `a b + c`, continuous on all reals.
    #[must_use]
    pub fn mul_add(self, b: Self, c: Self) -> Self {
        let interval = self.interval.mul_add(b.interval, c.interval);
        Self { interval, decoration: self.decoration.min(b.decoration).min(c.decoration) }.checked()
    }
    /// Pointwise minimum.
    #[must_use]
    pub fn min(self, o: Self) -> Self {
        self.binary(o, self.interval.min(o.interval), Continuous)
    }
    /// Pointwise maximum.
    #[must_use]
    pub fn max(self, o: Self) -> Self {
        self.binary(o, self.interval.max(o.interval), Continuous)
    }
}

/// Functions continuous on all reals.
macro_rules! continuous_everywhere {
    ($($name:ident)*) => { impl Decorated { $(
        #[doc = concat!("[`Interval::", stringify!($name), "`], continuous on all reals.")]
        #[must_use]
        pub fn $name(self) -> Self {
            self.unary(self.interval.$name(), Continuous)
        }
    )* } };
}
continuous_everywhere!(sqr abs cbrt exp sin cos atan sinh cosh tanh);

macro_rules! continuous_operator {
    ($($trait:ident $method:ident)*) => { $(
        impl $trait for Decorated {
            type Output = Self;
            fn $method(self, o: Self) -> Self {
                self.binary(o, $trait::$method(self.interval, o.interval), Continuous)
            }
        }
    )* };
}
continuous_operator!(Add add Sub sub Mul mul);

impl Neg for Decorated {
    type Output = Self;
    fn neg(self) -> Self {
        self.unary(-self.interval, Continuous)
    }
}

impl Div for Decorated {
    type Output = Self;
    /// Continuous where the divisor excludes 0.
    fn div(self, o: Self) -> Self {
        self.binary(o, self.interval / o.interval, continuous_if(!o.interval.possibly_zero()))
    }
}
