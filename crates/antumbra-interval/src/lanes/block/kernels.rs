//! The formulas of the scalar operators on vectors, step by step the same. Why they enclose is said there: `affine::arith`,
//! `affine::dual`, `arith`, `round`.
mod forms;
mod slopes;

pub(super) use forms::{JetOf, PointJetOf, QuadraticOf};
pub(super) use slopes::SlopeLanes;

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
    /// `a^n`, 3 <= n <= 8.
    fn power(self, n: u32) -> (Self, V::Mask);
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

    /// Times an exact number that is not negative.
    #[inline(always)]
    fn scaled(self, k: f64) -> Self {
        let k = V::splat(k);
        let (c, a, t) = (self.c.mul(k), coefficients!(i => self.a[i].mul(k)), self.e.mul(k));
        let w = Self::and_magnitudes(&a, c.abs().add(t));
        Self::sealed(c, a, t.add(V::splat(4.0 * U).mul(w)).add(V::splat(TINY)), w)
    }

    /// `self^n` by products, n >= 2.
    #[inline(always)]
    fn product(self, n: u32) -> Self {
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
    fn narrow(self, n: u32) -> V::Mask {
        let radius = Self::and_magnitudes(&self.a, self.e).mul(V::splat(1.0 + (2 * N + 4) as f64 * U));
        V::splat(f64::from(n)).mul(radius).le(V::splat(0.5).mul(self.c.abs()))
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
    fn power(self, n: u32) -> (Self, V::Mask) {
        (self.product(n), self.narrow(n))
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
        let derivative = self.value.times(self.derivative).scaled(2.0);
        (Self { value: self.value.square(), derivative }, V::always())
    }
    /// `n f^(n-1) f'`; what is narrow enough for n is for n - 1.
    #[inline(always)]
    fn power(self, n: u32) -> (Self, V::Mask) {
        let derivative = self.value.product(n - 1).scaled(f64::from(n)).times(self.derivative);
        (Self { value: self.value.product(n), derivative }, self.value.narrow(n))
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

    /// The scalar operator picks the extreme corners by signs. They are the least and the largest of all four, also rounded, as
    /// rounding is monotone; and so is the step outward, which leads to the neighbouring float there.
    #[inline(always)]
    fn times(self, o: Self) -> (Self, V::Mask) {
        let (p, q, r, s) = (self.lo.mul(o.lo), self.lo.mul(o.hi), self.hi.mul(o.lo), self.hi.mul(o.hi));
        let (lo, hi) = (p.lesser(q).lesser(r.lesser(s)), p.greater(q).greater(r.greater(s)));
        let value = Self { lo: lo.sub(step(lo)), hi: hi.add(step(hi)) };
        let proper = V::both(self.moderate(), o.moderate());
        if V::all(proper) {
            return (value, proper);
        }
        // 0 times anything bounded is [+0, -0], as it is of the scalar operator.
        let (none, zero) = (V::either(self.is_zero(), o.is_zero()), V::splat(0.0));
        let value = Self { lo: V::select(none, zero, value.lo), hi: V::select(none, zero.neg(), value.hi) };
        (value, V::both(self.is_zero_or_moderate(), o.is_zero_or_moderate()))
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

    #[inline(always)]
    fn rounded(r: V, up: bool) -> V {
        if up { r.add(step(r)) } else { r.sub(step(r)) }
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
        self.within(1e-140, 1e140)
    }

    /// Both ends of a size between these.
    #[inline(always)]
    fn within(self, small: f64, large: f64) -> V::Mask {
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
    fn power(self, n: u32) -> (Self, V::Mask) {
        let (lo, hi, zero) = (self.lo.abs(), self.hi.abs(), V::splat(0.0));
        let value = if n.is_multiple_of(2) {
            let across = V::both(self.lo.le(zero), zero.le(self.hi));
            let least = Self::chain(lo.lesser(hi), n, false);
            Self { lo: V::select(across, zero, least), hi: Self::chain(lo.greater(hi), n, true) }
        } else {
            // Odd and increasing.
            let lo_negative = Self::chain(lo, n, true).neg();
            let hi_negative = Self::chain(hi, n, false).neg();
            Self {
                lo: V::select(self.lo.lt(zero), lo_negative, Self::chain(lo, n, false)),
                hi: V::select(self.hi.lt(zero), hi_negative, Self::chain(hi, n, true)),
            }
        };
        // The eighth power of these is moderate.
        (value, self.within(1e-17, 1e17))
    }
    #[inline(always)]
    fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask) {
        let (product, proper) = t.times(d);
        let (value, sums) = p.plus(product);
        (value, V::both(proper, sums))
    }
}
