//! Affine forms: step by step what `affine::arith` does.
use super::super::vector::{Eight, Vector};
use super::{IntervalOf, Kernel};
use crate::affine::{LARGE, TINY, U};

/// Eight affine forms.
#[derive(Clone, Copy)]
pub struct AffineOf<V, const N: usize> {
    pub(super) c: V,
    pub(super) e: V,
    pub(super) a: [V; N],
}

impl<V: Vector, const N: usize> AffineOf<V, N> {
    #[inline(always)]
    pub(super) fn sealed(c: V, a: [V; N], e: V, size: V) -> Self {
        let known = size.lt(V::splat(LARGE));
        if V::all(known) {
            return Self { c, e, a };
        }
        let zero = V::splat(0.0);
        Self {
            c: V::select(known, c, zero),
            e: V::select(known, e, V::splat(f64::INFINITY)),
            a: coefficients!(i => V::select(known, a[i], zero)),
        }
    }

    /// `s + |a_0| + |a_1| + ...`, from the left.
    #[inline(always)]
    pub(super) fn and_magnitudes(a: &[V; N], mut s: V) -> V {
        let mut i = 0;
        while i < N {
            s = s.add(a[i].abs());
            i += 1;
        }
        s
    }

    #[inline(always)]
    fn sum(c: V, a: [V; N], t: V) -> Self {
        let w = Self::and_magnitudes(&a, c.abs().add(t));
        Self::sealed(c, a, t.add(V::splat(4.0 * U).mul(w)), w)
    }

    #[inline(always)]
    pub(super) fn plus(self, o: Self) -> Self {
        Self::sum(self.c.add(o.c), coefficients!(i => self.a[i].add(o.a[i])), self.e.add(o.e))
    }

    #[inline(always)]
    pub(super) fn minus(self, o: Self) -> Self {
        Self::sum(self.c.sub(o.c), coefficients!(i => self.a[i].sub(o.a[i])), self.e.add(o.e))
    }

    #[inline(always)]
    pub(super) fn negative(self) -> Self {
        Self { c: self.c.neg(), e: self.e, a: coefficients!(i => self.a[i].neg()) }
    }

    #[inline(always)]
    pub(super) fn times(self, o: Self) -> Self {
        let (mut r, mut t, mut q, mut d) = (self.e, o.e, V::splat(0.0), V::splat(0.0));
        let mut a = [V::splat(0.0); N];
        let mut i = 0;
        while i < N {
            let (x, y) = (self.a[i], o.a[i]);
            let w = x.mul(y);
            a[i] = self.c.mul(y).add(o.c.mul(x));
            r = r.add(x.abs());
            t = t.add(y.abs());
            q = q.add(w);
            d = d.add(w.abs());
            i += 1;
        }
        let (ca, cb, half) = (self.c.abs(), o.c.abs(), V::splat(0.5));
        let size = ca.add(r).mul(cb.add(t));
        let e = r.mul(t).sub(half.mul(d)).add(ca.mul(o.e).add(cb.mul(self.e)));
        let e = e.add(V::splat((4 * N + 16) as f64 * U).mul(size)).add(V::splat(TINY));
        Self::sealed(self.c.mul(o.c).add(half.mul(q)), a, e, size)
    }

    #[inline(always)]
    pub(super) fn square(self) -> Self {
        let r = Self::and_magnitudes(&self.a, self.e);
        let two = V::splat(2.0);
        let (c, k, h) = (self.c.abs(), two.mul(self.c), V::splat(0.5).mul(r).mul(r));
        let size = c.add(r).mul(c.add(r));
        let e = h.add(two.mul(c).mul(self.e));
        let e = e.add(V::splat((4 * N + 16) as f64 * U).mul(size)).add(V::splat(TINY));
        Self::sealed(self.c.mul(self.c).add(h), coefficients!(i => k.mul(self.a[i])), e, size)
    }

    /// `alpha x + d` for any function with values in `d`.
    #[inline(always)]
    pub(super) fn scale_add(self, alpha: V, d: IntervalOf<V>) -> Self {
        let (m, r) = d.centre_radius();
        let ca = self.c.mul(alpha);
        let (c, a) = (ca.add(m), coefficients!(i => self.a[i].mul(alpha)));
        let t = self.e.mul(alpha.abs()).add(r);
        let w = Self::and_magnitudes(&a, ca.abs().add(m.abs()).add(t));
        Self::sealed(c, a, t.add(V::splat(16.0 * U).mul(w)).add(V::splat(TINY)), w)
    }

    /// Some function with values in `k`.
    #[inline(always)]
    pub(super) fn constant(k: IntervalOf<V>) -> Self {
        let (m, r) = k.centre_radius();
        Self::sealed(m, [V::splat(0.0); N], r, m.abs().add(r))
    }

    /// Bounds of the values. Where nothing is known they are infinite or NaN.
    #[inline(always)]
    pub(super) fn range(self) -> IntervalOf<V> {
        let (r, zero) = (self.radius(), V::splat(0.0));
        let point = r.le(zero);
        IntervalOf {
            lo: V::select(point, self.c, self.c.sub(r).below()),
            hi: V::select(point, self.c, self.c.add(r).above()),
        }
    }

    #[inline(always)]
    fn radius(self) -> V {
        Self::and_magnitudes(&self.a, self.e).mul(V::splat(1.0 + (2 * N + 4) as f64 * U))
    }

    /// The first symbol runs from one end to the other, both bounded; a constant where they are the same.
    #[inline(always)]
    pub(super) fn spanning_from(ends: IntervalOf<V>) -> Self {
        let (half, mut a) = (V::splat(0.5), [V::splat(0.0); N]);
        let (l, h) = (half.mul(ends.lo), half.mul(ends.hi));
        a[0] = h.sub(l);
        let size = l.abs().add(h.abs());
        let e = V::splat(8.0 * U).mul(size).add(V::splat(TINY));
        let point = V::both(ends.lo.le(ends.hi), ends.hi.le(ends.lo));
        Self::select(point, Self::constant(ends), Self::sealed(l.add(h), a, e, size))
    }

    /// `yes` where the answer is yes, else `no`.
    #[inline(always)]
    pub(super) fn select(mask: V::Mask, yes: Self, no: Self) -> Self {
        Self {
            c: V::select(mask, yes.c, no.c),
            e: V::select(mask, yes.e, no.e),
            a: coefficients!(i => V::select(mask, yes.a[i], no.a[i])),
        }
    }

    /// The form with the smaller error.
    #[inline(always)]
    pub(super) fn narrower(self, o: Self) -> Self {
        Self::select(self.e.lt(o.e), self, o)
    }

    /// Nothing known.
    #[inline(always)]
    pub(super) fn unknown() -> Self {
        Self { c: V::splat(0.0), e: V::splat(f64::INFINITY), a: [V::splat(0.0); N] }
    }

    /// Times an exact number that is not negative.
    #[inline(always)]
    pub(super) fn scaled(self, k: f64) -> Self {
        let k = V::splat(k);
        let (c, a, t) = (self.c.mul(k), coefficients!(i => self.a[i].mul(k)), self.e.mul(k));
        let w = Self::and_magnitudes(&a, c.abs().add(t));
        Self::sealed(c, a, t.add(V::splat(4.0 * U).mul(w)).add(V::splat(TINY)), w)
    }

    /// `self^n` by products, n >= 2.
    #[inline(always)]
    pub(super) fn product(self, n: u32) -> Self {
        let (mut p, mut bit) = (self, n.ilog2());
        while bit > 0 {
            bit -= 1;
            p = p.square();
            if n >> bit & 1 == 1 {
                p = p.times(self);
            }
        }
        p
    }

    /// Whether the range is so narrow that the scalar operator takes the product.
    #[inline(always)]
    pub(super) fn narrow(self, n: u32) -> V::Mask {
        V::splat(f64::from(n)).mul(self.radius()).le(V::splat(0.5).mul(self.c.abs()))
    }

    /// `self` plus a number known by centre and radius.
    #[inline(always)]
    pub(super) fn shifted(self, m: V, r: V) -> Self {
        let c = self.c.add(m);
        let t = self.e.add(r);
        let w = c.abs().add(t);
        Self::sealed(c, self.a, t.add(V::splat(4.0 * U).mul(w)), w)
    }
}

impl<V: Vector, const N: usize> Kernel<V> for AffineOf<V, N> {
    #[inline(always)]
    fn load(from: &[Eight]) -> Self {
        Self { c: V::load(&from[0]), e: V::load(&from[1]), a: coefficients!(i => V::load(&from[i + 2])) }
    }
    #[inline(always)]
    fn store(self, to: &mut [Eight]) {
        self.c.store(&mut to[0]);
        self.e.store(&mut to[1]);
        let mut i = 0;
        while i < N {
            self.a[i].store(&mut to[i + 2]);
            i += 1;
        }
    }
    #[inline(always)]
    fn neg(self) -> (Self, V::Mask) {
        (self.negative(), V::always())
    }
    #[inline(always)]
    fn add(self, o: Self) -> (Self, V::Mask) {
        (self.plus(o), V::always())
    }
    #[inline(always)]
    fn sub(self, o: Self) -> (Self, V::Mask) {
        (self.minus(o), V::always())
    }
    #[inline(always)]
    fn mul(self, o: Self) -> (Self, V::Mask) {
        (self.times(o), V::always())
    }
    #[inline(always)]
    fn div(self, o: Self) -> (Self, V::Mask) {
        let (reciprocal, proper) = o.recip();
        (self.times(reciprocal), proper)
    }
    #[inline(always)]
    fn sqr(self) -> (Self, V::Mask) {
        (self.square(), V::always())
    }
    #[inline(always)]
    fn sqrt(self) -> (Self, V::Mask) {
        self.root()
    }
    #[inline(always)]
    fn abs(self) -> (Self, V::Mask) {
        self.size()
    }
    #[inline(always)]
    fn min(self, o: Self) -> (Self, V::Mask) {
        (self.smaller(o), V::always())
    }
    #[inline(always)]
    fn max(self, o: Self) -> (Self, V::Mask) {
        (self.larger(o), V::always())
    }
    #[inline(always)]
    fn power(self, n: u32) -> (Self, V::Mask) {
        self.powi(n)
    }
    #[inline(always)]
    fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask) {
        (t.times(d).shifted(p.c, p.e), V::always())
    }
    #[inline(always)]
    fn spanning(self) -> (Self, V::Mask) {
        (Self::spanning_from(IntervalOf { lo: self.c, hi: self.e }), V::always())
    }
}
