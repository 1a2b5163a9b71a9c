//! Quadratic forms: second-degree polynomials in three symbols with one error bound.
//!
//! A [`Quadratic`] `c + l.x + (degree 2 in x) +- e`, `x = (s, a, b)` in `[-1, 1]^3`, encloses a real function of the symbols
//! pointwise, as [`Affine`] forms do, but over boxes of width `w` its error shrinks as `w^3`. Symbol `s` (index 0) runs
//! along a beam, `a` and `b` (1, 2) across it: [`Quadratic::eliminate`] bounds the least value over `s`, as a quadratic
//! polynomial in `(a, b)`, a [`Paraboloid`].
//!
//! # Rounding
//! As in [`crate::affine`]: operations in round to nearest, and every operation adds `(number of steps) u * size` to `e`,
//! where `size` bounds the sum of the magnitudes of all terms that took part, and `2^-1022` where products occur. A known
//! form has only finite numbers; [`Quadratic::UNKNOWN`] says nothing.
pub(crate) mod arith;
mod eliminate;
mod functions;
mod zero;

pub use eliminate::{Eliminated, Paraboloid};
pub use zero::{Turn, Zero};

use crate::Interval;
use crate::affine::{Affine, LARGE, TINY, U, centre_radius, overflow};

/// A function of the symbols `(s, a, b)` in `[-1, 1]^3`, known up to an error:
/// `|g - c - l_s s - l_a a - l_b b - q_ss s^2 - q_aa a^2 - q_bb b^2 - q_sa s a - q_sb s b - q_ab a b| <= e`.
///
/// `e = inf` ([`Quadratic::UNKNOWN`]) says nothing. Otherwise all numbers are finite and `e >= 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadratic {
    pub(crate) c: f64,
    pub(crate) l: [f64; 3],
    /// ss, aa, bb, sa, sb, ab.
    pub(crate) q: [f64; 6],
    pub(crate) e: f64,
}

impl Quadratic {
    /// Nothing known: contains every function.
    pub const UNKNOWN: Self = Self { c: 0.0, l: [0.0; 3], q: [0.0; 6], e: f64::INFINITY };
    /// The number 0, exactly.
    pub const ZERO: Self = Self { c: 0.0, l: [0.0; 3], q: [0.0; 6], e: 0.0 };

    /// The form if `size`, which bounds all its numbers and all that led to them, is below `2^1000`; else unknown.
    #[inline(always)]
    fn sealed(c: f64, l: [f64; 3], q: [f64; 6], e: f64, size: f64) -> Self {
        if size < LARGE {
            Self { c, l, q, e }
        } else {
            overflow();
            Self::UNKNOWN
        }
    }

    /// The polynomial with these coefficients (`q`: ss, aa, bb, sa, sb, ab) `+- e`. [`Quadratic::UNKNOWN`] if a number is
    /// NaN or too large, or `e < 0`.
    #[must_use]
    pub fn polynomial(c: f64, l: [f64; 3], q: [f64; 6], e: f64) -> Self {
        let size = l.iter().chain(&q).fold(c.abs() + e.abs(), |s, v| s + v.abs());
        if e >= 0.0 { Self::sealed(c, l, q, e, size) } else { Self::UNKNOWN }
    }

    /// Some function (a constant, for instance) with values in `k`. Unknown if `k` is unbounded or empty.
    #[must_use]
    #[inline]
    pub fn constant(k: Interval) -> Self {
        let (m, r) = centre_radius(k);
        Self::sealed(m, [0.0; 3], [0.0; 6], r, m.abs() + r)
    }

    /// Constant coefficient.
    #[must_use]
    pub const fn centre(&self) -> f64 {
        self.c
    }
    /// Coefficients of `s, a, b`.
    #[must_use]
    pub const fn linear(&self) -> &[f64; 3] {
        &self.l
    }
    /// Coefficients of `s^2, a^2, b^2, s a, s b, a b`.
    #[must_use]
    pub const fn quadratic(&self) -> &[f64; 6] {
        &self.q
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

    /// Sum of the magnitudes of all numbers, up to a factor `1 + 12u`.
    #[inline(always)]
    fn size(&self) -> f64 {
        (self.c.abs() + norm(&self.l)) + (norm(&self.q) + self.e)
    }

    /// An interval that contains every value of the function.
    ///
    /// Mixed terms by their magnitude; `l x + q x^2` over `[-1, 1]` by `parabola_low`. At most 20 roundings on numbers of
    /// sum `size`.
    #[must_use]
    #[inline]
    pub fn range(&self) -> Interval {
        if !self.is_known() {
            return Interval::ENTIRE;
        }
        if self.e == 0.0 && self.l == [0.0; 3] && self.q == [0.0; 6] {
            return Interval::point(self.c);
        }
        let mixed = self.q[3].abs() + self.q[4].abs() + self.q[5].abs();
        let slack = mixed + self.e + (32.0 * U * self.size() + TINY);
        let (mut lo, mut hi) = (self.c - slack, self.c + slack);
        for i in 0..3 {
            lo += parabola_low(self.l[i], self.q[i]);
            hi -= parabola_low(-self.l[i], -self.q[i]);
        }
        Interval::try_new(lo, hi).unwrap_or(Interval::ENTIRE)
    }

    /// The affine form with the same linear part: `x^2 = 1/2 +- 1/2` for each symbol, mixed terms into the error.
    ///
    /// Steps: centre 4, error 10, times `u size`.
    #[must_use]
    pub fn to_affine(&self) -> Affine<3> {
        if !self.is_known() {
            return Affine::UNKNOWN;
        }
        let [ss, aa, bb, sa, sb, ab] = self.q;
        let error = self.e + 0.5 * (ss.abs() + aa.abs() + bb.abs()) + (sa.abs() + sb.abs() + ab.abs());
        Affine::linear(self.c + 0.5 * (ss + aa + bb), self.l, error + (24.0 * U * self.size() + TINY))
    }
}

impl From<Affine<3>> for Quadratic {
    fn from(x: Affine<3>) -> Self {
        Self { c: x.centre(), l: *x.coefficients(), q: [0.0; 6], e: x.error() }
    }
}

impl From<Interval> for Quadratic {
    fn from(k: Interval) -> Self {
        Self::constant(k)
    }
}

/// Sum of magnitudes.
#[inline(always)]
fn norm<const K: usize>(v: &[f64; K]) -> f64 {
    v.iter().fold(0.0, |s, v| s + v.abs())
}

/// Least value of `l x + q x^2` over `[-1, 1]`, within `3u (|l| + |q|) + eta`: inside where `|l| < 2 q`, there
/// `-l^2/(4q) = -(|l|/2) (|l|/(2q))`, the last factor below 1; else at the lower end.
#[inline(always)]
fn parabola_low(l: f64, q: f64) -> f64 {
    let l = l.abs();
    if l < 2.0 * q { -(0.5 * l) * (l / (2.0 * q)) } else { q - l }
}
