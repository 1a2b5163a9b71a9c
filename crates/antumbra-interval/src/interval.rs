//! The interval type: bounds, members, relations between sets.
use std::fmt;

use crate::round::{greater, lesser, sub_up};

/// A closed set of reals `[lo, hi]`, possibly unbounded or empty.
///
/// **Invariant.** Either `lo <= hi`, `lo < +inf`, `hi > -inf`, or the empty set, stored as `[+inf, -inf]`. Infinite
/// bounds are limits, never members. Bounds may be zeros of either sign, which mean the same.
///
/// **NaN.** No operation makes a NaN bound from valid operands. Were one to arise, every certain predicate would answer
/// "no" and every possible one "yes": NaN proves nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub(crate) lo: f64,
    pub(crate) hi: f64,
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
    /// The two neighbours of pi: it is above the nearest float.
    pub const PI: Self = Self { lo: std::f64::consts::PI, hi: std::f64::consts::PI.next_up() };
    /// The two neighbours of pi / 2.
    pub const HALF_PI: Self = Self { lo: std::f64::consts::FRAC_PI_2, hi: std::f64::consts::FRAC_PI_2.next_up() };

    /// `[lo, hi]`. Panics unless `lo <= hi`, `lo < +inf`, `hi > -inf`.
    #[inline]
    #[must_use]
    pub const fn new(lo: f64, hi: f64) -> Self {
        assert!(
            lo <= hi && lo < f64::INFINITY && hi > f64::NEG_INFINITY,
            "interval bounds out of order, infinite on the wrong side, or NaN"
        );
        Self { lo, hi }
    }
    /// `[lo, hi]` if that is an interval.
    #[inline]
    #[must_use]
    pub const fn try_new(lo: f64, hi: f64) -> Option<Self> {
        if lo <= hi && lo < f64::INFINITY && hi > f64::NEG_INFINITY { Some(Self { lo, hi }) } else { None }
    }
    /// The single finite number `x`. Panics if it is infinite or NaN.
    #[inline]
    #[must_use]
    pub const fn point(x: f64) -> Self {
        Self::new(x, x)
    }
    /// Bounds of unknown origin: `EMPTY` where `lo > hi`, `ENTIRE` (no information) where they are no interval.
    #[inline]
    #[must_use]
    pub const fn from_bounds_or_entire(lo: f64, hi: f64) -> Self {
        if lo > hi {
            Self::EMPTY
        } else if let Some(x) = Self::try_new(lo, hi) {
            x
        } else {
            Self::ENTIRE
        }
    }
    /// Lower bound (`+inf` if empty).
    #[inline]
    #[must_use]
    pub const fn lo(self) -> f64 {
        self.lo
    }
    /// Upper bound (`-inf` if empty).
    #[inline]
    #[must_use]
    pub const fn hi(self) -> f64 {
        self.hi
    }
    /// No member at all.
    #[inline]
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.lo > self.hi
    }
    /// Exactly one member.
    #[inline]
    #[must_use]
    pub const fn is_point(self) -> bool {
        self.lo == self.hi
    }
    /// Not empty and both bounds finite.
    #[inline]
    #[must_use]
    pub const fn is_bounded(self) -> bool {
        self.lo > f64::NEG_INFINITY && self.hi < f64::INFINITY && self.lo <= self.hi
    }
    /// Exactly the number 0.
    #[inline]
    pub(crate) const fn is_zero(self) -> bool {
        self.lo == 0.0 && self.hi == 0.0
    }

    /// Whether 0 may be a member: false is a proof that it is not (also for the empty set).
    #[inline]
    #[must_use]
    pub const fn possibly_zero(self) -> bool {
        !(self.lo > 0.0 || self.hi < 0.0)
    }
    /// Every member is > 0 (true for the empty set).
    #[inline]
    #[must_use]
    pub const fn certainly_positive(self) -> bool {
        self.lo > 0.0
    }
    /// Every member is < 0 (true for the empty set).
    #[inline]
    #[must_use]
    pub const fn certainly_negative(self) -> bool {
        self.hi < 0.0
    }
    /// Every member is >= 0 (true for the empty set).
    #[inline]
    #[must_use]
    pub const fn certainly_nonnegative(self) -> bool {
        self.lo >= 0.0
    }
    /// Every member is <= 0 (true for the empty set).
    #[inline]
    #[must_use]
    pub const fn certainly_nonpositive(self) -> bool {
        self.hi <= 0.0
    }
    /// Every member is less than every member of `o` (true if either is empty).
    #[inline]
    #[must_use]
    pub const fn certainly_less(self, o: Self) -> bool {
        self.hi < o.lo
    }
    /// Every member is at most every member of `o` (true if either is empty).
    #[inline]
    #[must_use]
    pub const fn certainly_at_most(self, o: Self) -> bool {
        self.hi <= o.lo
    }
    /// Whether a number may belong to both: false is a proof that none does.
    #[inline]
    #[must_use]
    pub const fn possibly_intersects(self, o: Self) -> bool {
        !(self.is_empty() || o.is_empty() || self.hi < o.lo || o.hi < self.lo)
    }
    /// Whether `x` is a member.
    #[inline]
    #[must_use]
    pub const fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi && x.is_finite()
    }
    /// Every member is a member of `o` (the empty set is a subset of all).
    #[inline]
    #[must_use]
    pub const fn is_subset_of(self, o: Self) -> bool {
        self.is_empty() || (o.lo <= self.lo && self.hi <= o.hi)
    }
    /// Every member has a neighbourhood inside `o` (interior in the topology of the reals, as in IEEE 1788): what
    /// Brouwer's and Newton's existence tests need.
    #[inline]
    #[must_use]
    pub const fn is_interior_to(self, o: Self) -> bool {
        self.is_empty()
            || ((o.lo < self.lo || o.lo == f64::NEG_INFINITY) && (self.hi < o.hi || o.hi == f64::INFINITY))
                && self.lo <= self.hi
    }

    /// The float nearest to the middle (IEEE 1788 `mid`), a member; `+-f64::MAX` if one side is unbounded, 0 if both are. NaN if empty.
    #[inline]
    #[must_use]
    pub fn mid(self) -> f64 {
        if !self.is_bounded() {
            return if self.is_empty() {
                f64::NAN
            } else if self.lo > f64::NEG_INFINITY {
                f64::MAX
            } else if self.hi < f64::INFINITY {
                f64::MIN
            } else {
                0.0
            };
        }
        // The half sum rounded, hence a member: rounding is monotone and both bounds are floats. Halves come first only
        // where the sum overflows: there they are exact, while half a subnormal may not be.
        let sum = self.lo + self.hi;
        if sum.is_finite() { 0.5 * sum } else { 0.5 * self.lo + 0.5 * self.hi }
    }
    /// An upper bound of `|x - self.mid()|` for every member `x`; 0 if empty.
    #[inline]
    #[must_use]
    pub fn radius(self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let m = self.mid();
        greater(sub_up(m, self.lo), sub_up(self.hi, m))
    }
    /// An upper bound of the width `hi - lo`; 0 if empty.
    #[inline]
    #[must_use]
    pub fn width(self) -> f64 {
        if self.is_empty() { 0.0 } else { sub_up(self.hi, self.lo) }
    }
    /// Largest absolute value of a member (infinite if unbounded); 0 if empty.
    #[inline]
    #[must_use]
    pub fn magnitude(self) -> f64 {
        if self.is_empty() { 0.0 } else { greater(self.lo.abs(), self.hi.abs()) }
    }
    /// Smallest absolute value of a member; `+inf` if empty.
    #[inline]
    #[must_use]
    pub fn mignitude(self) -> f64 {
        if self.is_empty() {
            f64::INFINITY
        } else if self.possibly_zero() {
            0.0
        } else {
            lesser(self.lo.abs(), self.hi.abs())
        }
    }
    /// Smallest interval that contains both.
    #[inline]
    #[must_use]
    pub fn hull(self, o: Self) -> Self {
        // The bounds of the empty set are neutral here.
        Self { lo: lesser(self.lo, o.lo), hi: greater(self.hi, o.hi) }
    }
    /// Common members.
    #[inline]
    #[must_use]
    pub fn intersection(self, o: Self) -> Self {
        let (lo, hi) = (greater(self.lo, o.lo), lesser(self.hi, o.hi));
        if lo > hi { Self::EMPTY } else { Self { lo, hi } }
    }
}

/// `[lo, hi]` with the shortest decimals that read back as the same two floats, `[point]`, or `[empty]`. The decimals are
/// names of the bounds, not outward roundings of them: a precision asked for is ignored.
impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            f.write_str("[empty]")
        } else if self.is_point() {
            write!(f, "[{:?}]", self.lo)
        } else {
            write!(f, "[{:?}, {:?}]", self.lo, self.hi)
        }
    }
}
