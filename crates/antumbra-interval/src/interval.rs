//! The interval type (first sketch: exact API, loose elementary functions).
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A closed set of reals `[lo, hi]`, possibly unbounded or empty.
///
/// Empty is stored as `lo > hi`. A NaN bound never arises from valid input; were it to arise, every certain predicate
/// answers "no": NaN proves nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    lo: f64,
    hi: f64,
}

fn down(x: f64) -> f64 {
    x.next_down()
}
fn up(x: f64) -> f64 {
    x.next_up()
}

impl Interval {
    /// No number.
    pub const EMPTY: Self = Self { lo: f64::INFINITY, hi: f64::NEG_INFINITY };
    /// Every real number.
    pub const ENTIRE: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
    /// Every number `>= 0`.
    pub const NON_NEGATIVE: Self = Self { lo: 0.0, hi: f64::INFINITY };
    /// Just 0.
    pub const ZERO: Self = Self { lo: 0.0, hi: 0.0 };
    /// Just 1.
    pub const ONE: Self = Self { lo: 1.0, hi: 1.0 };

    /// `[lo, hi]`. Panics unless `lo <= hi`, `lo < +inf`, `hi > -inf`.
    #[must_use]
    pub const fn new(lo: f64, hi: f64) -> Self {
        assert!(
            lo <= hi && lo < f64::INFINITY && hi > f64::NEG_INFINITY,
            "interval bounds out of order, infinite on the wrong side, or NaN"
        );
        Self { lo, hi }
    }
    /// `[lo, hi]` if that is an interval.
    #[must_use]
    pub const fn try_new(lo: f64, hi: f64) -> Option<Self> {
        if lo <= hi && lo < f64::INFINITY && hi > f64::NEG_INFINITY { Some(Self { lo, hi }) } else { None }
    }
    /// The single finite number `x`.
    #[must_use]
    pub const fn point(x: f64) -> Self {
        Self::new(x, x)
    }
    /// Lower bound (`+inf` if empty).
    #[must_use]
    pub const fn lo(self) -> f64 {
        self.lo
    }
    /// Upper bound (`-inf` if empty).
    #[must_use]
    pub const fn hi(self) -> f64 {
        self.hi
    }
    /// No member at all.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.lo > self.hi
    }
    /// Whether 0 may be a member: false is a proof that it is not (also for the empty set).
    #[must_use]
    pub fn possibly_zero(self) -> bool {
        !(self.lo > 0.0 || self.hi < 0.0)
    }
    /// Every member is > 0 (true for the empty set).
    #[must_use]
    pub fn certainly_positive(self) -> bool {
        self.lo > 0.0
    }
    /// Every member is < 0 (true for the empty set).
    #[must_use]
    pub fn certainly_negative(self) -> bool {
        self.hi < 0.0
    }
    /// A finite number near the middle, inside the interval unless empty.
    #[must_use]
    pub fn mid(self) -> f64 {
        (0.5 * self.lo + 0.5 * self.hi).clamp(self.lo, self.hi)
    }
    /// An upper bound of the width `hi - lo`.
    #[must_use]
    pub fn width(self) -> f64 {
        up(self.hi - self.lo)
    }
    /// Largest absolute value of a member.
    #[must_use]
    pub fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }
    /// Smallest interval that contains both.
    #[must_use]
    pub fn hull(self, o: Self) -> Self {
        Self { lo: self.lo.min(o.lo), hi: self.hi.max(o.hi) }
    }
    /// Common members.
    #[must_use]
    pub fn intersection(self, o: Self) -> Self {
        let (lo, hi) = (self.lo.max(o.lo), self.hi.min(o.hi));
        if lo <= hi { Self { lo, hi } } else { Self::EMPTY }
    }
    /// Whether `x` is a member.
    #[must_use]
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }
    /// `a^2`, tighter than `a * a`.
    #[must_use]
    pub fn sqr(self) -> Self {
        let (a, b) = (self.lo * self.lo, self.hi * self.hi);
        let lo = if self.contains(0.0) { 0.0 } else { down(a.min(b)).max(0.0) };
        Self { lo, hi: up(a.max(b)) }
    }
    /// `|a|`.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.lo >= 0.0 {
            self
        } else if self.hi <= 0.0 {
            -self
        } else {
            Self { lo: 0.0, hi: self.magnitude() }
        }
    }
    /// Pointwise minimum.
    #[must_use]
    pub fn min(self, o: Self) -> Self {
        Self { lo: self.lo.min(o.lo), hi: self.hi.min(o.hi) }
    }
    /// Pointwise maximum.
    #[must_use]
    pub fn max(self, o: Self) -> Self {
        Self { lo: self.lo.max(o.lo), hi: self.hi.max(o.hi) }
    }
}

macro_rules! loose {
    ($($name:ident)*) => { impl Interval { $(
        /// Enclosure of the function over the part of its domain inside the interval.
        #[must_use] pub fn $name(self) -> Self { Self::ENTIRE }
    )* } };
}
loose!(sqrt cbrt exp ln sin cos tan asin acos atan sinh cosh tanh floor sign);
impl Interval {
    /// Integer power (IEEE 1788 `pown`).
    #[must_use]
    pub fn powi(self, _n: i32) -> Self {
        Self::ENTIRE
    }
    /// Real power (IEEE 1788 `pow`).
    #[must_use]
    pub fn pow(self, _y: Self) -> Self {
        Self::ENTIRE
    }
    /// Angle of the points `(x, y)`, `self` being y.
    #[must_use]
    pub fn atan2(self, _x: Self) -> Self {
        Self::ENTIRE
    }
}
impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self { lo: -self.hi, hi: -self.lo }
    }
}
impl Add for Interval {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self { lo: down(self.lo + o.lo), hi: up(self.hi + o.hi) }
    }
}
impl Sub for Interval {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self { lo: down(self.lo - o.hi), hi: up(self.hi - o.lo) }
    }
}
impl Mul for Interval {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let p =
            [self.lo * o.lo, self.lo * o.hi, self.hi * o.lo, self.hi * o.hi].map(|v| if v.is_nan() { 0.0 } else { v });
        Self { lo: down(p[0].min(p[1]).min(p[2].min(p[3]))), hi: up(p[0].max(p[1]).max(p[2].max(p[3]))) }
    }
}
impl Div for Interval {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        if o.possibly_zero()
            || self.lo.is_infinite()
            || self.hi.is_infinite()
            || o.lo.is_infinite()
            || o.hi.is_infinite()
        {
            return Self::ENTIRE;
        }
        let p = [self.lo / o.lo, self.lo / o.hi, self.hi / o.lo, self.hi / o.hi];
        Self { lo: down(p[0].min(p[1]).min(p[2].min(p[3]))), hi: up(p[0].max(p[1]).max(p[2].max(p[3]))) }
    }
}
