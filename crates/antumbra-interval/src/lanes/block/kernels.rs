//! The formulas of the scalar operators on vectors, step by step the same. Why they enclose is said there: `affine::arith`,
//! `affine::dual`, `arith`, `round`.
use super::vector::{Eight, Vector};
use crate::affine::{LARGE, TINY, U};
use crate::round::{ETA, PHI};

/// Eight numbers of one kind. A result comes with the lanes in which it is the scalar operator's; the others are done again.
pub trait Kernel<V: Vector>: Copy {
    /// From its vectors.
    fn load(from: &[Eight]) -> Self;
    /// To its vectors.
    fn store(self, to: &mut [Eight]);
    /// `-a`.
    fn neg(self) -> (Self, V::Mask);
    /// `a + b`.
    fn add(self, o: Self) -> (Self, V::Mask);
    /// `a - b`.
    fn sub(self, o: Self) -> (Self, V::Mask);
    /// `a b`.
    fn mul(self, o: Self) -> (Self, V::Mask);
    /// `a^2`.
    fn sqr(self) -> (Self, V::Mask);
    /// `p + t d`.
    fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask);
}

/// Eight affine forms.
#[derive(Clone, Copy)]
pub struct AffineOf<V, const N: usize> {
    c: V,
    e: V,
    a: [V; N],
}

macro_rules! coefficients {
    ($i:ident => $value:expr) => {{
        // Not from_fn: a closure would not take the features of the function around it.
        let mut out = [V::splat(0.0); N];
        let mut $i = 0;
        while $i < N {
            out[$i] = $value;
            $i += 1;
        }
        out
    }};
}

impl<V: Vector, const N: usize> AffineOf<V, N> {
    #[inline(always)]
    fn sealed(c: V, a: [V; N], e: V, size: V) -> Self {
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
    fn and_magnitudes(a: &[V; N], mut s: V) -> V {
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
    fn plus(self, o: Self) -> Self {
        Self::sum(self.c.add(o.c), coefficients!(i => self.a[i].add(o.a[i])), self.e.add(o.e))
    }

    #[inline(always)]
    fn minus(self, o: Self) -> Self {
        Self::sum(self.c.sub(o.c), coefficients!(i => self.a[i].sub(o.a[i])), self.e.add(o.e))
    }

    #[inline(always)]
    fn negative(self) -> Self {
        Self { c: self.c.neg(), e: self.e, a: coefficients!(i => self.a[i].neg()) }
    }

    #[inline(always)]
    fn times(self, o: Self) -> Self {
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
    fn square(self) -> Self {
        let r = Self::and_magnitudes(&self.a, self.e);
        let two = V::splat(2.0);
        let (c, k, h) = (self.c.abs(), two.mul(self.c), V::splat(0.5).mul(r).mul(r));
        let size = c.add(r).mul(c.add(r));
        let e = h.add(two.mul(c).mul(self.e));
        let e = e.add(V::splat((4 * N + 16) as f64 * U).mul(size)).add(V::splat(TINY));
        Self::sealed(self.c.mul(self.c).add(h), coefficients!(i => k.mul(self.a[i])), e, size)
    }

    #[inline(always)]
    fn doubled(self) -> Self {
        let two = V::splat(2.0);
        // mul_f64(2.0)
        let (c, a, t) = (self.c.mul(two), coefficients!(i => self.a[i].mul(two)), self.e.mul(two));
        let w = Self::and_magnitudes(&a, c.abs().add(t));
        Self::sealed(c, a, t.add(V::splat(4.0 * U).mul(w)).add(V::splat(TINY)), w)
    }

    /// `self` plus a number known by centre and radius.
    #[inline(always)]
    fn shifted(self, m: V, r: V) -> Self {
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
    fn sqr(self) -> (Self, V::Mask) {
        (self.square(), V::always())
    }
    #[inline(always)]
    fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask) {
        (t.times(d).shifted(p.c, p.e), V::always())
    }
}

/// Eight values with derivatives.
#[derive(Clone, Copy)]
pub struct DualOf<V, const N: usize> {
    value: AffineOf<V, N>,
    derivative: AffineOf<V, N>,
}

impl<V: Vector, const N: usize> Kernel<V> for DualOf<V, N> {
    #[inline(always)]
    fn load(from: &[Eight]) -> Self {
        Self { value: AffineOf::load(&from[..N + 2]), derivative: AffineOf::load(&from[N + 2..]) }
    }
    #[inline(always)]
    fn store(self, to: &mut [Eight]) {
        self.value.store(&mut to[..N + 2]);
        self.derivative.store(&mut to[N + 2..]);
    }
    #[inline(always)]
    fn neg(self) -> (Self, V::Mask) {
        (Self { value: self.value.negative(), derivative: self.derivative.negative() }, V::always())
    }
    #[inline(always)]
    fn add(self, o: Self) -> (Self, V::Mask) {
        (Self { value: self.value.plus(o.value), derivative: self.derivative.plus(o.derivative) }, V::always())
    }
    #[inline(always)]
    fn sub(self, o: Self) -> (Self, V::Mask) {
        (Self { value: self.value.minus(o.value), derivative: self.derivative.minus(o.derivative) }, V::always())
    }
    #[inline(always)]
    fn mul(self, o: Self) -> (Self, V::Mask) {
        let derivative = self.value.times(o.derivative).plus(self.derivative.times(o.value));
        (Self { value: self.value.times(o.value), derivative }, V::always())
    }
    #[inline(always)]
    fn sqr(self) -> (Self, V::Mask) {
        let derivative = self.value.times(self.derivative).doubled();
        (Self { value: self.value.square(), derivative }, V::always())
    }
    #[inline(always)]
    fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask) {
        let value = t.value.times(d.value).shifted(p.value.c, p.value.e);
        (Self { value, derivative: d.value }, V::always())
    }
}

/// Eight intervals.
#[derive(Clone, Copy)]
pub struct IntervalOf<V> {
    lo: V,
    hi: V,
}

/// The step outward from `r`.
#[inline(always)]
fn step<V: Vector>(r: V) -> V {
    r.abs().mul(V::splat(PHI)).add(V::splat(ETA))
}

/// The step outward for the sum `r = fl(a + b)`.
#[inline(always)]
fn sum_error<V: Vector>(a: V, b: V, r: V) -> V {
    let zero = V::splat(0.0);
    let inexact = V::both(zero.lt(r.abs()), V::both(zero.lt(a.abs()), zero.lt(b.abs())));
    V::select(inexact, step(r), zero)
}

impl<V: Vector> IntervalOf<V> {
    /// A zero term, or a sum that is zero, is exact. Sums that overflow, of empty lanes, or with a NaN are done again.
    #[inline(always)]
    fn plus(self, o: Self) -> (Self, V::Mask) {
        let (lo, hi) = (self.lo.add(o.lo), self.hi.add(o.hi));
        let finite = V::both(lo.abs().le(V::splat(f64::MAX)), hi.abs().le(V::splat(f64::MAX)));
        let value = Self { lo: lo.sub(sum_error(self.lo, o.lo, lo)), hi: hi.add(sum_error(self.hi, o.hi, hi)) };
        (value, finite)
    }

    /// The scalar operator picks the factors by signs: the same ones here, the second pair where both intervals hold numbers of both
    /// signs.
    #[inline(always)]
    fn times(self, o: Self) -> (Self, V::Mask) {
        let (a, b, zero) = (self, o, V::splat(0.0));
        // a >= 0, else a <= 0, else b >= 0, else b <= 0, else neither.
        let (up, down) = (zero.le(a.lo), a.hi.le(zero));
        let (lo_up, hi_up, hi_down) = (zero.le(b.lo), zero.le(b.hi), b.hi.le(zero));
        // lo = x_lo y_lo and x_lo2 y_lo2, the smaller; hi likewise.
        let x_lo = V::select(
            up,
            V::select(lo_up, a.lo, a.hi),
            V::select(down, V::select(hi_up, a.lo, a.hi), V::select(lo_up, a.lo, V::select(hi_down, a.hi, a.lo))),
        );
        let y_lo = V::select(up, b.lo, V::select(down, b.hi, V::select(lo_up, b.hi, V::select(hi_down, b.lo, b.hi))));
        let x_hi = V::select(
            up,
            V::select(hi_up, a.hi, a.lo),
            V::select(down, V::select(lo_up, a.hi, a.lo), V::select(lo_up, a.hi, a.lo)),
        );
        let y_hi = V::select(up, b.hi, V::select(down, b.lo, V::select(lo_up, b.hi, b.lo)));
        let (lo, hi) = (x_lo.mul(y_lo), x_hi.mul(y_hi));
        // Where neither has one sign: a.hi b.lo, and a.hi b.hi.
        let (lo2, hi2) = (a.hi.mul(b.lo), a.hi.mul(b.hi));
        let mixed = V::both(V::both(a.lo.lt(zero), zero.lt(a.hi)), V::both(b.lo.lt(zero), zero.lt(b.hi)));
        let (lo, hi) = (lo.sub(step(lo)), hi.add(step(hi)));
        let (lo2, hi2) = (lo2.sub(step(lo2)), hi2.add(step(hi2)));
        let value = Self { lo: V::select(mixed, lo.lesser(lo2), lo), hi: V::select(mixed, hi.greater(hi2), hi) };
        // 0 times anything bounded is [+0, -0], as it is of the scalar operator.
        let none = V::either(self.is_zero(), o.is_zero());
        let value = Self { lo: V::select(none, zero, value.lo), hi: V::select(none, zero.neg(), value.hi) };
        let bounded = V::both(self.is_zero_or_moderate(), o.is_zero_or_moderate());
        (value, bounded)
    }

    /// Just 0.
    #[inline(always)]
    fn is_zero(self) -> V::Mask {
        let zero = V::splat(0.0);
        V::both(self.lo.abs().le(zero), self.hi.abs().le(zero))
    }

    #[inline(always)]
    fn is_zero_or_moderate(self) -> V::Mask {
        V::either(self.is_zero(), self.moderate())
    }

    /// Ends whose products are ordinary numbers. No empty lane, none with a NaN.
    #[inline(always)]
    fn moderate(self) -> V::Mask {
        let (small, large) = (V::splat(1e-140), V::splat(1e140));
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
        (Self { lo: self.hi.neg(), hi: self.lo.neg() }, V::always())
    }
    #[inline(always)]
    fn add(self, o: Self) -> (Self, V::Mask) {
        self.plus(o)
    }
    #[inline(always)]
    fn sub(self, o: Self) -> (Self, V::Mask) {
        self.plus(Self { lo: o.hi.neg(), hi: o.lo.neg() })
    }
    #[inline(always)]
    fn mul(self, o: Self) -> (Self, V::Mask) {
        self.times(o)
    }
    #[inline(always)]
    fn sqr(self) -> (Self, V::Mask) {
        let zero = V::splat(0.0);
        let (lo, hi) = (self.lo.abs(), self.hi.abs());
        let across = V::both(self.lo.le(zero), zero.le(self.hi));
        let (near, far) = (lo.lesser(hi), lo.greater(hi));
        let (l, h) = (near.mul(near), far.mul(far));
        let value = Self { lo: V::select(across, zero, l.sub(step(l))), hi: h.add(step(h)) };
        (value, self.moderate())
    }
    #[inline(always)]
    fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask) {
        let (product, proper) = t.times(d);
        let (value, sums) = p.plus(product);
        (value, V::both(proper, sums))
    }
}
