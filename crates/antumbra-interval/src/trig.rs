//! Sine, cosine and tangent.
//!
//! The question is which multiples of pi/2 lie between two floats; it must be answered by proof, or an extremum is lost.
//! No float but 0 is a multiple of pi/2, so every other float lies in the interior of one quadrant
//! `(k pi/2, (k+1) pi/2)`. Two ways to find k modulo 4, the second used only where the first cannot decide:
//!
//! 1. **Product.** `t = fl(x * fl(2/pi))` has relative error below `2^-51` (two roundings of `2^-53` each). For
//!    `|x| < 2^30` that is less than `2^-20`. If t is farther than that from both neighbouring integers, `floor(t)` is k.
//! 2. **Signs.** The signs of the correctly rounded `sin x` and `cos x` are those of the real values, whatever the size
//!    of x: at a float with `|x| >= 1` neither is smaller than `1e-19`, so neither is rounded to 0.
//!
//! The width of the interval then settles the number of quarter turns between the ends: the same quadrant means less
//! than pi/2 or more than 3 pi/2 apart, which any threshold between the two tells apart.
use std::f64::consts::{FRAC_2_PI, TAU};

use crate::Interval;
use crate::elementary::{above, below};
use crate::round::{greater, lesser, sub_up};

/// Which multiples of pi/2 lie in an interval: those with index `first + 1 ..= first + count`, modulo 4, and possibly its
/// lower end 0. `count` stops at 4: then every kind occurs.
struct Crossings {
    first: u8,
    count: u8,
}

impl Crossings {
    /// Of a bounded or unbounded interval that is not empty.
    fn of(x: Interval) -> Self {
        const ALL: Crossings = Crossings { first: 0, count: 4 };
        let width = sub_up(x.hi, x.lo);
        // TAU is below 2 pi. A wider interval may hold a full turn.
        if width > TAU || width.is_nan() {
            return ALL;
        }
        let (lo, hi) = (quadrant(x.lo), quadrant(x.hi));
        let count = (4 + hi - lo) % 4;
        // pi/2 < 3 < 3 pi/2.
        if count == 0 && width > 3.0 { ALL } else { Self { first: lo, count } }
    }

    /// Whether a multiple of pi/2 with this index modulo 4 was crossed.
    fn include(&self, index: u8) -> bool {
        // Distance from the first quadrant's left end: 1 ..= 4.
        (index + 3 - self.first) % 4 < self.count
    }
}

/// The k modulo 4 with `x` in `[k pi/2, (k+1) pi/2)`, for a finite x.
fn quadrant(x: f64) -> u8 {
    // A small x, 0 included, is on the side of 0 that its sign says: 1 < pi/2.
    if x.abs() < 1.0 {
        return if x >= 0.0 { 0 } else { 3 };
    }
    if x.abs() < (1_u64 << 30) as f64 {
        const ERROR: f64 = 1.0 / (1_u64 << 20) as f64;
        let t = x * FRAC_2_PI;
        let k = t.floor();
        // Exact: the difference of a float and its floor has no more digits than the float.
        let fraction = t - k;
        if fraction > ERROR && fraction < 1.0 - ERROR {
            return (k as i64).rem_euclid(4) as u8;
        }
    }
    let (sin, cos) = core_math::sincos(x);
    match (sin > 0.0, cos > 0.0) {
        (true, true) => 0,
        (true, false) => 1,
        (false, false) => 2,
        (false, true) => 3,
    }
}

impl Interval {
    /// Sine, exact at 0; in [-1, 1].
    #[must_use]
    pub fn sin(self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let crossings = Crossings::of(self);
        let (lowest, highest) = (crossings.include(3), crossings.include(1));
        if lowest && highest {
            return Self { lo: -1.0, hi: 1.0 };
        }
        let (a, b) = (core_math::sin(self.lo), core_math::sin(self.hi));
        // Only 0 has an exact sine, and the smaller and larger of two values are monotone in them.
        let (least, most) = (lesser(a, b), greater(a, b));
        Self {
            lo: if lowest { -1.0 } else { below_unless_zero(least) },
            hi: if highest { 1.0 } else { above_unless_zero(most) },
        }
        .within(-1.0, 1.0)
    }

    /// Cosine, exact at 0; in [-1, 1].
    #[must_use]
    pub fn cos(self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let crossings = Crossings::of(self);
        let (lowest, highest) = (crossings.include(2), crossings.include(0));
        if lowest && highest {
            return Self { lo: -1.0, hi: 1.0 };
        }
        let (a, b) = (core_math::cos(self.lo), core_math::cos(self.hi));
        // A cosine is never exactly 0 at a float; cos 0 = 1 is exact.
        let lo = if lowest {
            -1.0
        } else if self.is_zero() {
            1.0
        } else {
            below(lesser(a, b))
        };
        Self { lo, hi: if highest { 1.0 } else { above(greater(a, b)) } }.within(-1.0, 1.0)
    }

    /// Tangent, exact at 0; every real number if a pole may lie inside.
    #[must_use]
    pub fn tan(self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        if self.possibly_has_tan_pole() {
            return Self::ENTIRE;
        }
        // Between poles the tangent increases. It is 0 only at 0.
        Self { lo: below_unless_zero(core_math::tan(self.lo)), hi: above_unless_zero(core_math::tan(self.hi)) }
    }

    /// Whether an odd multiple of pi/2 may be a member: false is a proof that none is.
    #[must_use]
    pub(crate) fn possibly_has_tan_pole(self) -> bool {
        let crossings = Crossings::of(self);
        crossings.include(1) || crossings.include(3)
    }
}

/// Lower bound of a sine or tangent whose nearest float is `r`: 0 only at 0, where it is exact (|sin x| of a float x is at
/// least 2^-1074 or about 1e-19, never rounded to 0).
fn below_unless_zero(r: f64) -> f64 {
    if r == 0.0 { 0.0 } else { below(r) }
}

/// Upper bound of a sine or tangent whose nearest float is `r`.
fn above_unless_zero(r: f64) -> f64 {
    if r == 0.0 { 0.0 } else { above(r) }
}
