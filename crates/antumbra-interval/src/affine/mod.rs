//! Affine forms with fixed symbols: planes with one error bound, and slopes and jets of them.
//!
//! An [`Affine`] form `c + a.s +- e` encloses a real function of symbols `s` in `[-1, 1]^N` *pointwise*:
//! `|g(s) - c - sum a_i s_i| <= e` for every `s` where `g` is defined. The symbols keep their meaning through a whole
//! expression, hence `x - x` is thin, and the form is a pair of parallel planes that hold `g` between them.
//!
//! Whether `g` is defined or continuous is not told: that needs decorated intervals.
//!
//! # Rounding
//! Operations are in round to nearest; `u = 2^-53`, `eta = 2^-1074`. One sum, product, quotient or root `r = fl(x op y)`
//! that does not overflow has `|r - (x op y)| <= u |r| + eta/2`, and `<= u |x op y| + eta/2`; sums have no `eta` (a
//! subnormal sum is exact). `k` such steps on numbers without cancellation change a result by a factor within
//! `1 +- gamma_k`, `gamma_k = k u / (1 - k u)`. Each operation adds `(number of steps) u * size` to `e`, `size` an upper
//! bound of all magnitudes that took part, and where products occur also `2^-1022 = 2^52 eta` for underflow. The counts
//! stand beside the code; second-order terms are covered by the slack of several `u` there (for `N < 2^20`).
//!
//! # Overflow and NaN
//! A form is either [`Affine::UNKNOWN`] or all its numbers are finite: operations end in one comparison
//! `size < 2^1000`, false for NaN too, and `size` bounds every intermediate up to a factor 4. So neither NaN nor infinity
//! passes through a proof.
mod arith;
mod choice;
mod curve;
pub(crate) mod derivative;
mod dual;
pub(crate) mod form;
mod jet;
pub(crate) mod nonlinear;
pub(crate) mod point;
mod slope;
mod trigonometric;

pub use derivative::Smooth;
pub use dual::Dual;
pub use form::{Apex, Form};
pub use jet::Jet;
pub use slope::{Slope, SlopeOf};

use crate::Interval;

/// Unit roundoff `u`.
pub(crate) const U: f64 = f64::EPSILON / 2.0;
/// Covers every underflow of one operation: `2^52 eta`.
pub(crate) const TINY: f64 = f64::MIN_POSITIVE;
/// No known form has a number this large (`2^1000`).
pub(crate) const LARGE: f64 = 1.0715086071862673e301;

/// A function of the symbols `s` in `[-1, 1]^N`, known up to an error: `|g(s) - c - sum a_i s_i| <= e`.
///
/// `e = inf` ([`Affine::UNKNOWN`]) says nothing. Otherwise `c`, `a`, `e` are finite and `e >= 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine<const N: usize> {
    pub(crate) c: f64,
    pub(crate) a: [f64; N],
    pub(crate) e: f64,
}

impl<const N: usize> Affine<N> {
    /// Nothing known: contains every function.
    pub const UNKNOWN: Self = Self { c: 0.0, a: [0.0; N], e: f64::INFINITY };
    /// The number 0, exactly.
    pub const ZERO: Self = Self { c: 0.0, a: [0.0; N], e: 0.0 };

    /// The form if `size`, which bounds `|c|, |a_i|, e` and all that led to them, is below `2^1000`; else unknown.
    #[inline(always)]
    fn sealed(c: f64, a: [f64; N], e: f64, size: f64) -> Self {
        if size < LARGE {
            Self { c, a, e }
        } else {
            overflow();
            Self::UNKNOWN
        }
    }

    /// `c + sum a_i s_i +- e`. [`Affine::UNKNOWN`] if a number is NaN or too large, or `e < 0`.
    #[must_use]
    pub fn linear(c: f64, a: [f64; N], e: f64) -> Self {
        let size = a.iter().fold(c.abs() + e.abs(), |s, v| s + v.abs());
        if e >= 0.0 { Self::sealed(c, a, e, size) } else { Self::UNKNOWN }
    }

    /// Some function (a constant, for instance) with values in `k`. Unknown if `k` is unbounded or empty.
    #[must_use]
    #[inline]
    pub fn constant(k: Interval) -> Self {
        let (m, r) = centre_radius(k);
        Self::sealed(m, [0.0; N], r, m.abs() + r)
    }

    /// The function `s_i`. Panics unless `i < N`.
    #[must_use]
    pub fn symbol(i: usize) -> Self {
        let mut a = [0.0; N];
        a[i] = 1.0;
        Self { c: 0.0, a, e: 0.0 }
    }

    /// The function that maps `s_i = -1` to `x.lo()` and `s_i = 1` to `x.hi()`, linearly. Panics unless `i < N`.
    ///
    /// With `m`, `d` the computed half sum and half difference: `|m - (lo + hi)/2| + |d - (hi - lo)/2|` is at most
    /// `3u (|lo|/2 + |hi|/2)` (three roundings) plus `4 eta/2` (halving a subnormal).
    ///
    /// So it holds as well for the symbol that is -1, 0 and 1 at `x.lo()`, at the computed `m` and at `x.hi()`, and linear in between: what divides `x` at
    /// [`Interval::mid`], which is `m` but for underflow, relies on it.
    #[must_use]
    pub fn spanning(i: usize, x: Interval) -> Self {
        if x.lo() == x.hi() {
            return Self::constant(x);
        }
        let (l, h) = (0.5 * x.lo(), 0.5 * x.hi());
        let mut a = [0.0; N];
        a[i] = h - l;
        let size = l.abs() + h.abs();
        Self::sealed(l + h, a, 8.0 * U * size + TINY, size)
    }

    /// Centre `c`.
    #[must_use]
    pub const fn centre(&self) -> f64 {
        self.c
    }
    /// Coefficients `a` of the symbols.
    #[must_use]
    pub const fn coefficients(&self) -> &[f64; N] {
        &self.a
    }
    /// Error bound `e >= 0`, `+inf` if nothing is known.
    #[must_use]
    pub const fn error(&self) -> f64 {
        self.e
    }
    /// Whether the form says anything.
    #[must_use]
    pub const fn is_known(&self) -> bool {
        self.e < f64::INFINITY
    }

    /// The plane `k + sum a_i s_i` below the function: `k <= c - e`. `(-inf, 0)` if nothing is known.
    #[must_use]
    #[inline]
    pub fn lower_plane(&self) -> (f64, [f64; N]) {
        ((self.c - self.e).next_down(), self.a)
    }
    /// The plane `k + sum a_i s_i` above the function: `k >= c + e`. `(inf, 0)` if nothing is known.
    #[must_use]
    #[inline]
    pub fn upper_plane(&self) -> (f64, [f64; N]) {
        ((self.c + self.e).next_up(), self.a)
    }

    /// Upper bound of `sum |a_i| + e`: N sums lose at most `gamma_N`, the last product `u`.
    #[inline(always)]
    fn radius(&self) -> f64 {
        self.a.iter().fold(self.e, |s, v| s + v.abs()) * (1.0 + (2 * N + 4) as f64 * U)
    }

    /// An interval that contains every value of the function.
    #[must_use]
    #[inline]
    pub fn range(&self) -> Interval {
        if !self.is_known() {
            return Interval::ENTIRE;
        }
        let r = self.radius();
        if r == 0.0 {
            return Interval::point(self.c);
        }
        Interval::new((self.c - r).next_down(), (self.c + r).next_up())
    }
}

/// Where a function may be 0 along one of its symbols.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// At values of the symbol outside of these, and at their ends within `(-1, 1)`, the function is nowhere 0.
    pub zeros: Interval,
    /// Whether it is negative before and positive behind them; else it is positive before and negative behind.
    pub rises: bool,
}

impl<const N: usize> Affine<N> {
    /// Where the function may be 0 along symbol `i`, whatever the other symbols are. None where the form does not vary with it,
    /// says nothing, or is 0 nowhere. Panics unless `i < N`.
    ///
    /// A zero has `|c + a_i s_i| <= r`, `r` the largest sum of what the other symbols and the error bring: `s_i` is in
    /// `(-c -+ r)/a_i`. Sum and quotient are off by at most `(2u + u^2) |p| + eta` together, and the step outward is larger: so
    /// the ends are strict. (A quotient that overflows lies beyond -1 or 1.)
    #[must_use]
    #[inline]
    pub fn crossing(&self, i: usize) -> Option<Crossing> {
        let slope = self.a[i];
        if !self.is_known() || slope == 0.0 {
            return None;
        }
        let r = Self { a: std::array::from_fn(|k| if k == i { 0.0 } else { self.a[k] }), ..*self }.radius();
        let rises = slope > 0.0;
        let [first, last] = if rises { [-r, r] } else { [r, -r] }.map(|r| (r - self.c) / slope);
        let step = |p: f64| p.abs() * (4.0 * U) + TINY;
        let (lo, hi) = (greater(first - step(first), -1.0), lesser(last + step(last), 1.0));
        Some(Crossing { zeros: Interval::try_new(lo, hi)?, rises })
    }
}

impl<const N: usize> From<Interval> for Affine<N> {
    fn from(k: Interval) -> Self {
        Self::constant(k)
    }
}

/// `(m, r)` with `|x - m| <= r` for every `x` in `k`: infinite or NaN `r` if `k` is unbounded or empty, `r = 0` if `k` is
/// one number that halves exactly.
///
/// `r = d + fl(2u d)`, `d` the larger of two rounded differences: a normal `d` is off by at most `u d`, and `2u d` is at
/// least its last place, so `r` is at least the next float; a subnormal `d` is exact. NaN and infinity stay.
#[inline(always)]
pub(crate) fn centre_radius(k: Interval) -> (f64, f64) {
    let (lo, hi) = (k.lo(), k.hi());
    let m = 0.5 * lo + 0.5 * hi;
    // [-inf, hi]: NaN, inf; [lo, inf]: inf, NaN. A NaN first argument is dropped, m is infinite anyway.
    let d = greater(m - lo, hi - m);
    (m, d + d * f64::EPSILON)
}

/// Marks the branch of [`Affine::sealed`] that is hardly ever taken, else it becomes `N + 2` selections.
#[cold]
pub(crate) const fn overflow() {}

/// The larger one of two numbers that are not NaN; else `y`.
#[inline(always)]
fn greater(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}

/// The smaller one of two numbers that are not NaN; else `y`.
#[inline(always)]
fn lesser(x: f64, y: f64) -> f64 {
    if x < y { x } else { y }
}
