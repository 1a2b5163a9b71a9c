//! Choices between forms: step by step what `affine::choice` does.
use super::super::vector::Vector;
use super::{AffineOf, IntervalOf};
use crate::affine::{Affine, TINY};

impl<V: Vector, const N: usize> AffineOf<V, N> {
    /// The larger one.
    #[inline(always)]
    pub(super) fn larger(self, o: Self) -> Self {
        let (zero, half, one) = (V::splat(0.0), V::splat(0.5), V::splat(1.0));
        let (mut r, mut size) = (zero, self.c.abs().add(o.c.abs()).add(self.e.add(o.e)));
        let mut i = 0;
        while i < N {
            r = r.add(self.a[i].sub(o.a[i]).abs());
            size = size.add(self.a[i].abs().add(o.a[i].abs()));
            i += 1;
        }
        let centre = self.c.sub(o.c);
        let (lo, hi, tilt) = (centre.sub(r), centre.add(r), self.e.sub(o.e));
        let slack = V::splat(Affine::<N>::CHOICE).mul(size).add(V::splat(TINY));
        // A quotient that is not NaN is at most itself.
        let kink = hi.add(tilt).div(hi.sub(lo));
        let w = V::select(kink.le(kink), kink.greater(zero).lesser(one), one);
        let w = V::select(hi.le(tilt), zero, V::select(tilt.le(lo), one, w));
        let v = one.sub(w);
        let above = v.mul(hi).add(self.e).greater(o.e.sub(w.mul(lo)));
        let below = w.mul(self.e).add(v.mul(o.e));
        let mixed = Self {
            c: o.c.add(w.mul(centre)).add(half.mul(above.sub(below))),
            e: half.mul(above.add(below)).add(slack),
            a: coefficients!(i => o.a[i].add(w.mul(self.a[i].sub(o.a[i])))),
        };
        let second = Self::select(slack.le(hi.neg().sub(tilt)), o, mixed);
        let chosen = Self::select(slack.le(lo.add(tilt)), self, second);
        Self::sealed(chosen.c, chosen.a, chosen.e, size)
    }

    /// The smaller one.
    #[inline(always)]
    pub(super) fn smaller(self, o: Self) -> Self {
        self.negative().larger(o.negative()).negative()
    }

    /// Some function between both.
    #[inline(always)]
    pub(super) fn between(self, o: Self) -> Self {
        let half = V::splat(0.5);
        let mut r = self.c.sub(o.c).abs();
        let mut size = self.c.abs().add(o.c.abs()).add(self.e.add(o.e));
        let mut i = 0;
        while i < N {
            r = r.add(self.a[i].sub(o.a[i]).abs());
            size = size.add(self.a[i].abs().add(o.a[i].abs()));
            i += 1;
        }
        let slack = V::splat(Affine::<N>::CHOICE).mul(size).add(V::splat(TINY));
        let e = self.e.greater(o.e).add(half.mul(r)).add(slack);
        let a = coefficients!(i => half.mul(self.a[i]).add(half.mul(o.a[i])));
        Self::sealed(half.mul(self.c).add(half.mul(o.c)), a, e, size)
    }

    /// One where the range is not negative, the other where it is not positive, else the third.
    #[inline(always)]
    pub(super) fn by_sign(range: IntervalOf<V>, above: Self, below: Self, across: Self) -> Self {
        let zero = V::splat(0.0);
        Self::select(zero.le(range.lo), above, Self::select(range.hi.le(zero), below, across))
    }

    /// `|x|`.
    #[inline(always)]
    pub(super) fn size(self) -> (Self, V::Mask) {
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let range = self.range();
        let IntervalOf { lo, hi } = range;
        let w = hi.add(lo).div(hi.sub(lo)).greater(one.neg()).lesser(one);
        let (slope, lower, upper) = (IntervalOf::exact(w), IntervalOf::exact(lo), IntervalOf::exact(hi));
        let ((at_lo, fine_lo), (at_hi, fine_hi)) = (slope.times(lower), slope.times(upper));
        let (at_lo, sum_lo) = IntervalOf::exact(lo.neg()).plus(at_lo.negative());
        let (at_hi, sum_hi) = upper.plus(at_hi.negative());
        let rest = IntervalOf { lo: zero, hi: at_lo.hi.greater(at_hi.hi) };
        let largest = IntervalOf { lo: zero, hi: lo.neg().greater(hi) };
        let across = self.scale_add(w, rest).narrower(Self::constant(largest));
        let settled = V::either(zero.le(lo), hi.le(zero));
        let fine = V::both(V::both(V::both(fine_lo, fine_hi), V::both(sum_lo, sum_hi)), zero.le(rest.hi));
        (Self::by_sign(range, self, self.negative(), across), V::either(settled, fine))
    }
}
