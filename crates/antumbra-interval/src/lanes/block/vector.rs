//! Eight numbers at a time, on each level.
//!
//! Every operation is the IEEE 754 one in round to nearest on each of the eight, and nothing is contracted, so a formula
//! written with it gives the same bits on every level, and those of the same formula on single numbers.

use crate::round;

/// Lanes of one vector.
pub const WIDTH: usize = 8;

/// Eight numbers in memory, aligned for every level.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub struct Eight(pub [f64; WIDTH]);

/// Eight numbers in registers.
pub trait Vector: Copy {
    /// Eight answers.
    type Mask: Copy;
    /// Whether vectors linearise powers faster than the scalar operator does in the lanes that need it.
    const LINEARISES: bool;
    /// Eight times `x`.
    fn splat(x: f64) -> Self;
    /// From memory.
    fn load(from: &Eight) -> Self;
    /// To memory.
    fn store(self, to: &mut Eight);
    /// `self + o`.
    fn add(self, o: Self) -> Self;
    /// `self - o`.
    fn sub(self, o: Self) -> Self;
    /// `self * o`.
    fn mul(self, o: Self) -> Self;
    /// `self / o`.
    fn div(self, o: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// The float above, of finite numbers: of both zeros the smallest one.
    fn above(self) -> Self;
    /// The float below, of finite numbers.
    fn below(self) -> Self;
    /// Sign bit cleared.
    fn abs(self) -> Self;
    /// Sign bit flipped.
    fn neg(self) -> Self;
    /// `self < o`, false on NaN.
    fn lt(self, o: Self) -> Self::Mask;
    /// `self <= o`, false on NaN.
    fn le(self, o: Self) -> Self::Mask;
    /// `yes` where the answer is yes, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Both.
    fn both(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// One or the other.
    fn either(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// The opposite.
    fn not(mask: Self::Mask) -> Self::Mask;
    /// Eight times yes.
    fn always() -> Self::Mask;
    /// Bit `i` is answer `i`.
    fn bits(mask: Self::Mask) -> u8;
    /// Whether all are yes.
    #[inline(always)]
    fn all(mask: Self::Mask) -> bool {
        Self::bits(mask) == u8::MAX
    }
    /// The upper half of the bits, as a whole number; of numbers that are not negative.
    fn top(self) -> Self;
    /// The number with this upper half of the bits and nothing below, of whole numbers below 2^31 (else of the nearest one).
    fn with_top(self) -> Self;
    /// `self > o ? self : o`.
    fn greater(self, o: Self) -> Self;
    /// `self < o ? self : o`.
    fn lesser(self, o: Self) -> Self;
    /// Not a zero; true of NaN.
    fn nonzero(self) -> Self::Mask;
    /// The number where the answer is yes, else +0.
    fn keep(mask: Self::Mask, x: Self) -> Self;
    /// The step outward `fl(fl(size phi) + eta)` of the [`round`] module, for `size >= 0`, or a number that gives the same sums and
    /// differences with every number of that size.
    ///
    /// So does `fl(size phi + eta)`, rounded once. Below `2^-1020` it is the same number: `fl(size phi)` is a multiple of `eta` there, and
    /// a sum with `eta` is exact, so both are equal unless `size phi` lies in the middle between two multiples. That takes
    /// `size (2^52 + 1) = (2k + 1) 2^-970`, a multiple of `2^-970`. From `2^-1020` on both are more than half the distance of `size` to the
    /// float above it, and less than 3/2 of the one to either neighbour: sum and difference round to the neighbours.
    fn step(size: Self) -> Self;
    /// `self + step(|self|)` of ordinary numbers, whose size is from `2^-1000` on: the float above, +inf of the largest one.
    ///
    /// `fl(r + |r| phi)` is that too, rounded once: `|r| phi` alone is between 1/2 and 3/2 of the distance.
    fn raised(self) -> Self;
    /// `self - step(|self|)` of such numbers: the float below.
    fn lowered(self) -> Self;
}

/// Plain Rust.
#[derive(Clone, Copy)]
pub(super) struct Plain([f64; WIDTH]);

macro_rules! each {
    ($i:ident => $value:expr) => {{
        let mut out = [Default::default(); WIDTH];
        let mut $i = 0;
        while $i < WIDTH {
            out[$i] = $value;
            $i += 1;
        }
        out
    }};
}

impl Vector for Plain {
    type Mask = [bool; WIDTH];
    const LINEARISES: bool = false;
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; WIDTH])
    }
    #[inline(always)]
    fn load(from: &Eight) -> Self {
        Self(from.0)
    }
    #[inline(always)]
    fn store(self, to: &mut Eight) {
        to.0 = self.0;
    }
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self(each!(i => self.0[i] + o.0[i]))
    }
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self(each!(i => self.0[i] - o.0[i]))
    }
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self(each!(i => self.0[i] * o.0[i]))
    }
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        Self(each!(i => self.0[i] / o.0[i]))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(each!(i => self.0[i].sqrt()))
    }
    #[inline(always)]
    fn above(self) -> Self {
        Self(each!(i => self.0[i].next_up()))
    }
    #[inline(always)]
    fn below(self) -> Self {
        Self(each!(i => self.0[i].next_down()))
    }
    #[inline(always)]
    fn top(self) -> Self {
        Self(each!(i => round::top(self.0[i])))
    }
    #[inline(always)]
    fn with_top(self) -> Self {
        Self(each!(i => round::with_top(self.0[i])))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(each!(i => self.0[i].abs()))
    }
    #[inline(always)]
    fn neg(self) -> Self {
        Self(each!(i => -self.0[i]))
    }
    #[inline(always)]
    fn greater(self, o: Self) -> Self {
        Self(each!(i => if self.0[i] > o.0[i] { self.0[i] } else { o.0[i] }))
    }
    #[inline(always)]
    fn lesser(self, o: Self) -> Self {
        Self(each!(i => if self.0[i] < o.0[i] { self.0[i] } else { o.0[i] }))
    }
    #[inline(always)]
    fn nonzero(self) -> Self::Mask {
        each!(i => self.0[i] != 0.0)
    }
    #[inline(always)]
    fn keep(mask: Self::Mask, x: Self) -> Self {
        Self(each!(i => if mask[i] { x.0[i] } else { 0.0 }))
    }
    #[inline(always)]
    fn step(size: Self) -> Self {
        size.mul(Self::splat(round::PHI)).add(Self::splat(round::ETA))
    }
    #[inline(always)]
    fn raised(self) -> Self {
        self.add(Self::step(self.abs()))
    }
    #[inline(always)]
    fn lowered(self) -> Self {
        self.sub(Self::step(self.abs()))
    }
    #[inline(always)]
    fn lt(self, o: Self) -> Self::Mask {
        each!(i => self.0[i] < o.0[i])
    }
    #[inline(always)]
    fn le(self, o: Self) -> Self::Mask {
        each!(i => self.0[i] <= o.0[i])
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Self(each!(i => if mask[i] { yes.0[i] } else { no.0[i] }))
    }
    #[inline(always)]
    fn both(a: Self::Mask, b: Self::Mask) -> Self::Mask {
        each!(i => a[i] & b[i])
    }
    #[inline(always)]
    fn either(a: Self::Mask, b: Self::Mask) -> Self::Mask {
        each!(i => a[i] | b[i])
    }
    #[inline(always)]
    fn not(mask: Self::Mask) -> Self::Mask {
        each!(i => !mask[i])
    }
    #[inline(always)]
    fn always() -> Self::Mask {
        [true; WIDTH]
    }
    #[inline(always)]
    fn bits(mask: Self::Mask) -> u8 {
        let mut bits = 0;
        let mut i = 0;
        while i < WIDTH {
            bits |= u8::from(mask[i]) << i;
            i += 1;
        }
        bits
    }
}
