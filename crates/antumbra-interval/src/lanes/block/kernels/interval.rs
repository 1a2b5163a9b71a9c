//! Intervals: step by step what `arith`, `power` and `round` do.
use super::super::vector::{Eight, Vector};
use super::Kernel;

/// Eight intervals.
#[derive(Clone, Copy)]
pub struct IntervalOf<V> {
    pub(super) lo: V,
    pub(super) hi: V,
}

/// The step outward from `r`.
#[inline(always)]
pub(super) fn step<V: Vector>(r: V) -> V {
    V::step(r.abs())
}

/// Results from this size on are ordinary numbers: the step outward leads to the neighbouring float.
const ORDINARY: f64 = 1e-290;

/// The step outward for the sum `r = fl(a + b)`: a zero term, or a sum that is zero, is exact.
#[inline(always)]
fn sum_error<V: Vector>(a: V, b: V, r: V) -> V {
    V::keep(V::both(V::both(a.nonzero(), b.nonzero()), r.nonzero()), step(r))
}

impl<V: Vector> IntervalOf<V> {
    /// Sums that overflow, of empty lanes, or with a NaN are done again: one end is not finite there, and so is the difference.
    #[inline(always)]
    pub(super) fn plus(self, o: Self) -> (Self, V::Mask) {
        let (lo, hi) = (self.lo.add(o.lo), self.hi.add(o.hi));
        let finite = lo.sub(hi).abs().le(V::splat(f64::MAX));
        let value = Self { lo: lo.sub(sum_error(self.lo, o.lo, lo)), hi: hi.add(sum_error(self.hi, o.hi, hi)) };
        (value, finite)
    }

    /// The scalar operator picks the extreme corners by signs. Where one factor is nowhere negative, so does this. Else they are the
    /// least and the largest of all four, also rounded, as rounding is monotone.
    ///
    /// Both ends of the result ordinary, so are those of the factors: an infinite or empty factor has an infinite corner, or, as a
    /// factor with a NaN, corners that are 0 or NaN. These come last in one of both selections, which keep the last.
    #[inline(always)]
    pub(super) fn times(self, o: Self) -> (Self, V::Mask) {
        let zero = V::splat(0.0);
        let (self_positive, o_positive) = (zero.le(self.lo), zero.le(o.lo));
        let (lo, hi) = if V::all(V::both(self_positive, o_positive)) {
            (self.lo.mul(o.lo), self.hi.mul(o.hi))
        } else if V::all(self_positive) {
            self.times_signed(o)
        } else if V::all(o_positive) {
            o.times_signed(self)
        } else {
            let (p, q, r, s) = (self.lo.mul(o.lo), self.lo.mul(o.hi), self.hi.mul(o.lo), self.hi.mul(o.hi));
            (p.lesser(q).lesser(r.lesser(s)), s.greater(r).greater(q.greater(p)))
        };
        let value = Self { lo: lo.lowered(), hi: hi.raised() };
        let small = V::splat(ORDINARY);
        let proper = V::both(small.lt(lo.abs()), small.lt(hi.abs()));
        let proper = V::both(proper, lo.sub(hi).abs().le(V::splat(f64::MAX)));
        if V::all(proper) {
            return (value, proper);
        }
        // Of moderate factors only those products are 0 that are exactly 0, and [+0, -0] of the scalar operator.
        let value = Self { lo: V::keep(lo.nonzero(), value.lo), hi: V::select(hi.nonzero(), value.hi, zero.neg()) };
        (value, V::either(proper, V::both(self.is_zero_or_moderate(), o.is_zero_or_moderate())))
    }

    /// The extreme corners of a product by a factor that is not negative.
    #[inline(always)]
    fn times_signed(self, o: Self) -> (V, V) {
        let zero = V::splat(0.0);
        let least = V::select(o.lo.lt(zero), self.hi, self.lo);
        let most = V::select(o.hi.lt(zero), self.lo, self.hi);
        (least.mul(o.lo), most.mul(o.hi))
    }

    /// `(m, r)` with `|x - m| <= r` for every `x`.
    #[inline(always)]
    pub(super) fn centre_radius(self) -> (V, V) {
        let half = V::splat(0.5);
        let m = half.mul(self.lo).add(half.mul(self.hi));
        let d = m.sub(self.lo).greater(self.hi.sub(m));
        (m, d.add(d.mul(V::splat(f64::EPSILON))))
    }

    /// The float nearest to the middle, of bounded intervals whose ends have no infinite sum.
    #[inline(always)]
    pub(super) fn mid(self) -> V {
        V::splat(0.5).mul(self.lo.add(self.hi))
    }

    /// `-a`.
    #[inline(always)]
    pub(super) fn negative(self) -> Self {
        Self { lo: self.hi.neg(), hi: self.lo.neg() }
    }

    /// `a^2` of positive numbers.
    #[inline(always)]
    pub(super) fn positive_square(self) -> Self {
        let (l, h) = (self.lo.mul(self.lo), self.hi.mul(self.hi));
        Self { lo: l.sub(step(l)), hi: h.add(step(h)) }
    }

    /// One number.
    #[inline(always)]
    pub(super) fn exact(x: V) -> Self {
        Self { lo: x, hi: x }
    }

    /// No number in these lanes.
    #[inline(always)]
    fn empty_where(mask: V::Mask, x: Self) -> Self {
        let infinite = V::splat(f64::INFINITY);
        Self { lo: V::select(mask, infinite, x.lo), hi: V::select(mask, infinite.neg(), x.hi) }
    }

    /// The floats on both sides of finite numbers.
    #[inline(always)]
    pub(super) fn around(y: V) -> Self {
        Self { lo: y.below(), hi: y.above() }
    }

    /// The bound that the scalar operator divides by; where it divides by one of a negative interval, both are negated, exactly.
    /// A zero above is exact, and [+0, -0] as it is of the scalar operator.
    #[inline(always)]
    fn over(self, o: Self) -> (Self, V::Mask) {
        let zero = V::splat(0.0);
        let below = o.hi.lt(zero);
        let (lo, hi) = (V::select(below, self.hi.neg(), self.lo), V::select(below, self.lo.neg(), self.hi));
        let (near, far) = (V::select(below, o.hi.neg(), o.lo), V::select(below, o.lo.neg(), o.hi));
        let (l, h) = (lo.div(V::select(zero.le(lo), far, near)), hi.div(V::select(hi.le(zero), far, near)));
        let (zero_lo, zero_hi) = (lo.abs().le(zero), hi.abs().le(zero));
        let value =
            Self { lo: V::select(zero_lo, zero, l.sub(step(l))), hi: V::select(zero_hi, zero.neg(), h.add(step(h))) };
        let (small, large) = (V::splat(1e-140), V::splat(1e140));
        let fit_lo = V::both(small.lt(lo.abs()), lo.abs().lt(large));
        let fit_hi = V::both(small.lt(hi.abs()), hi.abs().lt(large));
        let above = V::both(V::either(zero_lo, fit_lo), V::either(zero_hi, fit_hi));
        (value, V::both(above, V::both(zero.lt(near), o.moderate())))
    }

    /// The power of numbers that are not negative and moderate, from below and from above: the chains of products of the scalar
    /// one.
    #[inline(always)]
    fn chain(x: V, n: u32, up: bool) -> V {
        let (mut square, mut rest, mut product, mut begun) = (x, n, x, false);
        loop {
            if rest & 1 == 1 {
                product = if begun { Self::rounded(product.mul(square), up) } else { square };
                begun = true;
            }
            rest >>= 1;
            if rest == 0 {
                return product;
            }
            square = Self::rounded(square.mul(square), up);
        }
    }

    /// The power of such numbers that begins with a product by 1: of the scalar operator on one number.
    #[inline(always)]
    pub(super) fn chain_from_one(x: V, n: u32, up: bool) -> V {
        let (mut square, mut rest, mut product) = (x, n, V::splat(1.0));
        loop {
            if rest & 1 == 1 {
                product = Self::rounded(product.mul(square), up);
            }
            rest >>= 1;
            if rest == 0 {
                return product;
            }
            square = Self::rounded(square.mul(square), up);
        }
    }

    /// Times a positive number, of intervals on one side of 0; [+0, -0] of 0.
    #[inline(always)]
    pub(super) fn times_count(self, n: f64) -> Self {
        let (l, h, zero) = (V::splat(n).mul(self.lo), V::splat(n).mul(self.hi), V::splat(0.0));
        Self {
            lo: V::select(l.abs().le(zero), zero, l.sub(step(l))),
            hi: V::select(h.abs().le(zero), zero.neg(), h.add(step(h))),
        }
    }

    /// The power from 3 to 8.
    #[inline(always)]
    fn power_of<const N: u32>(self) -> (Self, V::Mask) {
        // The eighth powers of these are ordinary.
        let (zero, small, large) = (V::splat(0.0), V::splat(1e-17), V::splat(1e17));
        let (lo, hi) = (self.lo.abs(), self.hi.abs());
        if N.is_multiple_of(2) {
            let across = V::both(self.lo.le(zero), zero.le(self.hi));
            // A NaN is the nearer or the farther end.
            let (near, far) = (lo.lesser(hi), hi.greater(lo));
            let least = V::keep(V::not(across), Self::chain(near, N, false));
            let proper = V::both(V::both(small.lt(far), far.lt(large)), V::either(across, small.lt(near)));
            return (Self { lo: least, hi: Self::chain(far, N, true) }, proper);
        }
        // Odd and increasing.
        let value = if V::all(zero.le(self.lo)) {
            Self { lo: Self::chain(lo, N, false), hi: Self::chain(hi, N, true) }
        } else {
            let lo_negative = Self::chain(lo, N, true).neg();
            let hi_negative = Self::chain(hi, N, false).neg();
            Self {
                lo: V::select(self.lo.lt(zero), lo_negative, Self::chain(lo, N, false)),
                hi: V::select(self.hi.lt(zero), hi_negative, Self::chain(hi, N, true)),
            }
        };
        (value, self.within(1e-17, 1e17))
    }

    #[inline(always)]
    fn rounded(r: V, up: bool) -> V {
        if up { r.raised() } else { r.lowered() }
    }

    /// Ends that are 0, or whose products are ordinary numbers. No empty lane, none with a NaN.
    #[inline(always)]
    fn is_zero_or_moderate(self) -> V::Mask {
        let (small, large, lo, hi) = (V::splat(1e-140), V::splat(1e140), self.lo.abs(), self.hi.abs());
        let fits = V::both(lo.lt(large), hi.lt(large));
        let (lo, hi) = (V::either(small.lt(lo), V::not(lo.nonzero())), V::either(small.lt(hi), V::not(hi.nonzero())));
        V::both(fits, V::both(lo, hi))
    }

    /// Ends whose products are ordinary numbers. No empty lane, none with a NaN.
    #[inline(always)]
    fn moderate(self) -> V::Mask {
        self.within(1e-140, 1e140)
    }

    /// Both ends of a size between these.
    #[inline(always)]
    pub(super) fn within(self, small: f64, large: f64) -> V::Mask {
        let (small, large) = (V::splat(small), V::splat(large));
        let fits = V::both(self.lo.abs().lt(large), self.hi.abs().lt(large));
        V::both(fits, V::both(small.lt(self.lo.abs()), small.lt(self.hi.abs())))
    }
}

impl<V: Vector> Kernel<V> for IntervalOf<V> {
    #[inline(always)]
    fn load(from: &[Eight]) -> Self {
        Self { lo: V::load(&from[0]), hi: V::load(&from[1]) }
    }
    #[inline(always)]
    fn store(self, to: &mut [Eight]) {
        self.lo.store(&mut to[0]);
        self.hi.store(&mut to[1]);
    }
    #[inline(always)]
    fn neg(self) -> (Self, V::Mask) {
        (self.negative(), V::always())
    }
    #[inline(always)]
    fn add(self, o: Self) -> (Self, V::Mask) {
        self.plus(o)
    }
    #[inline(always)]
    fn sub(self, o: Self) -> (Self, V::Mask) {
        self.plus(o.negative())
    }
    #[inline(always)]
    fn mul(self, o: Self) -> (Self, V::Mask) {
        self.times(o)
    }
    #[inline(always)]
    fn div(self, o: Self) -> (Self, V::Mask) {
        self.over(o)
    }
    #[inline(always)]
    fn sqr(self) -> (Self, V::Mask) {
        let (zero, small) = (V::splat(0.0), V::splat(ORDINARY));
        let (lo, hi) = (self.lo.abs(), self.hi.abs());
        let across = V::both(self.lo.le(zero), zero.le(self.hi));
        // A NaN is the nearer or the farther end.
        let (near, far) = (lo.lesser(hi), hi.greater(lo));
        let (l, h) = (near.mul(near), far.mul(far));
        let value = Self { lo: V::keep(V::not(across), l.lowered()), hi: h.raised() };
        let proper = V::both(V::both(small.lt(h), h.lt(V::splat(f64::INFINITY))), V::either(across, small.lt(l)));
        if V::all(proper) {
            return (value, proper);
        }
        // The square of 0 is [+0, -0] of the scalar operator.
        let none = V::both(across, V::not(far.nonzero()));
        (Self { lo: value.lo, hi: V::select(none, zero.neg(), value.hi) }, V::either(proper, none))
    }
    /// Empty intervals, and those below 0, are done again.
    #[inline(always)]
    fn sqrt(self) -> (Self, V::Mask) {
        let (l, h, zero) = (self.lo.sqrt(), self.hi.sqrt(), V::splat(0.0));
        let value = Self {
            lo: V::select(self.lo.le(zero), zero, l.sub(step(l))),
            hi: V::select(h.le(zero), h, h.add(step(h))),
        };
        (value, V::both(self.lo.le(self.hi), zero.le(self.hi)))
    }
    #[inline(always)]
    fn abs(self) -> (Self, V::Mask) {
        let (zero, negative) = (V::splat(0.0), self.negative());
        let (above, below) = (zero.le(self.lo), self.hi.le(zero));
        let lo = V::select(above, self.lo, V::select(below, negative.lo, zero));
        let across = negative.hi.greater(self.hi);
        (Self { lo, hi: V::select(above, self.hi, V::select(below, negative.hi, across)) }, V::always())
    }
    #[inline(always)]
    fn min(self, o: Self) -> (Self, V::Mask) {
        let empty = V::either(self.hi.lt(self.lo), o.hi.lt(o.lo));
        let value = Self { lo: self.lo.lesser(o.lo), hi: self.hi.lesser(o.hi) };
        (Self::empty_where(empty, value), V::always())
    }
    #[inline(always)]
    fn max(self, o: Self) -> (Self, V::Mask) {
        let empty = V::either(self.hi.lt(self.lo), o.hi.lt(o.lo));
        let value = Self { lo: self.lo.greater(o.lo), hi: self.hi.greater(o.hi) };
        (Self::empty_where(empty, value), V::always())
    }
    #[inline(always)]
    fn power(self, n: u32) -> (Self, V::Mask) {
        // The exponent known, its chains of products are straight.
        match n {
            3 => self.power_of::<3>(),
            4 => self.power_of::<4>(),
            5 => self.power_of::<5>(),
            6 => self.power_of::<6>(),
            7 => self.power_of::<7>(),
            _ => self.power_of::<8>(),
        }
    }
    #[inline(always)]
    fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask) {
        let (product, proper) = t.times(d);
        let (value, sums) = p.plus(product);
        (value, V::both(proper, sums))
    }
}
