//! Batches: one operation on many intervals, stored as a slice of lower and a slice of upper bounds.
//!
//! **Levels.** [`Level::Portable`] runs everywhere and gives the same bounds as [`Interval`]. [`Level::Avx512`] uses the
//! processor's directed rounding and gives the tightest floating-point bounds; where the portable result is wider it is
//! so by one step of [`crate::round`] at each end. ([`Level::Avx2`] takes the portable kernels here.) All are enclosures, lane by lane; neither depends on a lane's
//! position or on its neighbours. [`block`] is the other kind of batch: the same bits on every level.
//!
//! **Lanes.** Each lane satisfies the invariant of [`Interval`]. A lane with `lo > hi` is empty and makes an empty lane,
//! `[+inf, -inf]`. A lane with a NaN makes `[-inf, +inf]`: no information, never a proof.
//!
//! ```
//! use antumbra_interval::lanes::{self, Lanes, LanesMut, Level};
//!
//! let (lo, hi) = ([1.0, -2.0, 0.5], [2.0, 3.0, 0.5]);
//! let (mut square_lo, mut square_hi) = ([0.0; 3], [0.0; 3]);
//! lanes::sqr(Level::detect(), Lanes::new(&lo, &hi), LanesMut::new(&mut square_lo, &mut square_hi));
//! assert!(square_lo[1] == 0.0 && square_hi[1] >= 9.0);
//! ```
#[cfg(target_arch = "x86_64")]
mod avx512;
pub mod block;
mod portable;

use crate::Interval;
#[cfg(target_arch = "x86_64")]
pub use avx512::Avx512;
#[cfg(target_arch = "x86_64")]
pub use block::Avx2;

/// Which instructions the kernels use. A value of this type is proof that the processor has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Level {
    /// Plain operations rounded to nearest, then a step outward.
    Portable,
    /// AVX2 with FMA, for blocks; the other kernels take the portable way.
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    /// AVX-512F with a rounding direction in each instruction.
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
}

impl Level {
    /// The best level of this processor. Asked of the processor once; afterwards a load and a test.
    #[must_use]
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(proof) = Avx512::detect() {
            return Self::Avx512(proof);
        }
        #[cfg(target_arch = "x86_64")]
        if let Some(proof) = Avx2::detect() {
            return Self::Avx2(proof);
        }
        Self::Portable
    }

    /// Whether the kernels on slices of intervals round in a direction and so give the tightest bounds. (Blocks never do: their bits are
    /// the same on every level.)
    #[must_use]
    pub const fn is_directed(self) -> bool {
        match self {
            Self::Portable => false,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => false,
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => true,
        }
    }

    /// Every level of this processor, the portable one first.
    pub fn all() -> impl Iterator<Item = Self> {
        #[cfg(target_arch = "x86_64")]
        let more = [Avx2::detect().map(Self::Avx2), Avx512::detect().map(Self::Avx512)];
        #[cfg(not(target_arch = "x86_64"))]
        let more: [Option<Self>; 0] = [];
        std::iter::once(Self::Portable).chain(more.into_iter().flatten())
    }
}

/// Intervals to read: `lo[i]` and `hi[i]` bound lane `i`.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<'a> {
    lo: &'a [f64],
    hi: &'a [f64],
}

impl<'a> Lanes<'a> {
    /// Panics if the lengths differ.
    #[inline]
    #[must_use]
    pub fn new(lo: &'a [f64], hi: &'a [f64]) -> Self {
        assert_eq!(lo.len(), hi.len(), "as many lower as upper bounds");
        Self { lo, hi }
    }
    /// How many lanes.
    #[inline]
    #[must_use]
    pub fn len(self) -> usize {
        self.lo.len()
    }
    /// No lane at all.
    #[inline]
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.lo.is_empty()
    }
    /// Lane `i`; `ENTIRE` if its bounds are no interval. Panics if there is no such lane.
    #[inline]
    #[must_use]
    pub fn get(self, i: usize) -> Interval {
        Interval::from_bounds_or_entire(self.lo[i], self.hi[i])
    }
}

/// Intervals to write: `lo[i]` and `hi[i]` bound lane `i`.
#[derive(Debug)]
pub struct LanesMut<'a> {
    lo: &'a mut [f64],
    hi: &'a mut [f64],
}

impl<'a> LanesMut<'a> {
    /// Panics if the lengths differ.
    #[inline]
    #[must_use]
    pub fn new(lo: &'a mut [f64], hi: &'a mut [f64]) -> Self {
        assert_eq!(lo.len(), hi.len(), "as many lower as upper bounds");
        Self { lo, hi }
    }
    /// How many lanes.
    #[inline]
    #[must_use]
    pub fn len(&self) -> usize {
        self.lo.len()
    }
    /// No lane at all.
    #[inline]
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lo.is_empty()
    }
    /// Writes lane `i`. Panics if there is no such lane.
    #[inline]
    pub fn set(&mut self, i: usize, x: Interval) {
        (self.lo[i], self.hi[i]) = (x.lo, x.hi);
    }
}

/// Applies a function of one interval to every lane. Panics if the lengths differ.
#[inline]
pub fn map(a: Lanes<'_>, mut out: LanesMut<'_>, f: impl Fn(Interval) -> Interval) {
    assert_eq!(a.len(), out.len(), "as many results as operands");
    for i in 0..a.len() {
        out.set(i, f(a.get(i)));
    }
}

/// Applies a function of two intervals to every pair of lanes. Panics if the lengths differ.
#[inline]
pub fn map2(a: Lanes<'_>, b: Lanes<'_>, mut out: LanesMut<'_>, f: impl Fn(Interval, Interval) -> Interval) {
    assert!(a.len() == out.len() && b.len() == out.len(), "as many results as operands");
    for i in 0..a.len() {
        out.set(i, f(a.get(i), b.get(i)));
    }
}

macro_rules! unary {
    ($($(#[$doc:meta])* $name:ident)*) => { $(
        $(#[$doc])*
        ///
        /// Panics if the lengths differ.
        #[inline]
        pub fn $name(level: Level, a: Lanes<'_>, out: LanesMut<'_>) {
            assert_eq!(a.len(), out.len(), "as many results as operands");
            match level {
                Level::Portable => portable::$name(a, out),
                #[cfg(target_arch = "x86_64")]
                Level::Avx2(_) => portable::$name(a, out),
                #[cfg(target_arch = "x86_64")]
                Level::Avx512(proof) => avx512::$name(proof, a, out),
            }
        }
    )* };
}

macro_rules! binary {
    ($($(#[$doc:meta])* $name:ident)*) => { $(
        $(#[$doc])*
        ///
        /// Panics if the lengths differ.
        #[inline]
        pub fn $name(level: Level, a: Lanes<'_>, b: Lanes<'_>, out: LanesMut<'_>) {
            assert!(a.len() == out.len() && b.len() == out.len(), "as many results as operands");
            match level {
                Level::Portable => portable::$name(a, b, out),
                #[cfg(target_arch = "x86_64")]
                Level::Avx2(_) => portable::$name(a, b, out),
                #[cfg(target_arch = "x86_64")]
                Level::Avx512(proof) => avx512::$name(proof, a, b, out),
            }
        }
    )* };
}

unary! {
    /// `-a` in every lane, exact.
    neg
    /// `|a|` in every lane, exact.
    abs
    /// `a^2` in every lane, never below 0.
    sqr
    /// Square root of the part that is not negative, in every lane.
    sqrt
}

binary! {
    /// `a + b` in every lane.
    add
    /// `a - b` in every lane.
    sub
    /// `a b` in every lane.
    mul
    /// `a / b` in every lane, with the set semantics of [`Interval`]'s division.
    div
    /// Pointwise minimum in every lane, exact.
    min
    /// Pointwise maximum in every lane, exact.
    max
}

/// `a b + c` in every lane, rounded once.
///
/// Panics if the lengths differ.
#[inline]
pub fn mul_add(level: Level, a: Lanes<'_>, b: Lanes<'_>, c: Lanes<'_>, out: LanesMut<'_>) {
    assert!(a.len() == out.len() && b.len() == out.len() && c.len() == out.len(), "as many results as operands");
    match level {
        Level::Portable => portable::mul_add(a, b, c, out),
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(_) => portable::mul_add(a, b, c, out),
        #[cfg(target_arch = "x86_64")]
        Level::Avx512(proof) => avx512::mul_add(proof, a, b, c, out),
    }
}
