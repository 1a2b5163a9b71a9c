//! What the second-order search asks, on vectors: quadratic forms, jets, slopes of both, and plain jets.
//!
//! The formulas of the scalar operators, as in the parent module. Why they enclose is said in `quadratic::arith`, `affine::jet` and
//! `affine::slope`.
use super::{AffineOf, Kernel, left_to_scalars};
use crate::affine::{LARGE, TINY, U};
use crate::lanes::block::vector::{Eight, Vector};
use crate::quadratic::arith::{PAIRS, PRODUCT};

/// Eight enclosures of functions of symbols: operations that suit every lane. (Public, as kernels are; the module is not.)
pub trait Enclosures<V: Vector>: Copy {
    /// Vectors in it.
    const VECTORS: usize;
    /// From its vectors.
    fn from_memory(from: &[Eight]) -> Self;
    /// To its vectors.
    fn to_memory(self, to: &mut [Eight]);
    /// `-a`.
    fn negated(self) -> Self;
    /// `a + b`.
    fn added(self, o: Self) -> Self;
    /// `a - b`.
    fn subtracted(self, o: Self) -> Self;
    /// `a b`.
    fn multiplied(self, o: Self) -> Self;
    /// `a^2`.
    fn squared(self) -> Self;
    /// `a + k` for `k` known by centre and radius.
    fn plus_centre_radius(self, m: V, r: V) -> Self;
    /// `a k` for `k` known by centre and radius.
    fn times_centre_radius(self, m: V, r: V) -> Self;
    /// Whether there are powers in vectors; else they are left to the scalar operators.
    const POWERS: bool = false;
    /// `a^n`, 3 <= n <= 8, and the lanes in which it is the scalar operator's.
    #[inline(always)]
    fn powered(self, _: u32) -> (Self, V::Mask) {
        (self, never::<V>())
    }
}

/// No lane.
#[inline(always)]
pub(super) fn never<V: Vector>() -> V::Mask {
    V::splat(1.0).le(V::splat(0.0))
}

impl<V: Vector, const N: usize> Enclosures<V> for AffineOf<V, N> {
    const VECTORS: usize = N + 2;
    #[inline(always)]
    fn from_memory(from: &[Eight]) -> Self {
        Kernel::<V>::load(from)
    }
    #[inline(always)]
    fn to_memory(self, to: &mut [Eight]) {
        self.store(to);
    }
    #[inline(always)]
    fn negated(self) -> Self {
        self.negative()
    }
    #[inline(always)]
    fn added(self, o: Self) -> Self {
        self.plus(o)
    }
    #[inline(always)]
    fn subtracted(self, o: Self) -> Self {
        self.minus(o)
    }
    #[inline(always)]
    fn multiplied(self, o: Self) -> Self {
        self.times(o)
    }
    #[inline(always)]
    fn squared(self) -> Self {
        self.square()
    }
    #[inline(always)]
    fn plus_centre_radius(self, m: V, r: V) -> Self {
        self.shifted(m, r)
    }
    #[inline(always)]
    fn times_centre_radius(self, m: V, r: V) -> Self {
        let s = Self::and_magnitudes(&self.a, self.c.abs().add(self.e));
        let size = s.mul(m.abs().add(r));
        let e = self.e.mul(m.abs()).add(s.mul(r));
        let e = e.add(V::splat((N + 16) as f64 * U).mul(size)).add(V::splat(TINY));
        let mut a = self.a;
        let mut i = 0;
        while i < N {
            a[i] = a[i].mul(m);
            i += 1;
        }
        Self::sealed(self.c.mul(m), a, e, size)
    }
    const POWERS: bool = true;
    #[inline(always)]
    fn powered(self, n: u32) -> (Self, V::Mask) {
        self.power(n)
    }
}

/// Eight quadratic forms.
#[derive(Clone, Copy)]
pub struct QuadraticOf<V> {
    c: V,
    e: V,
    l: [V; 3],
    q: [V; 6],
}

macro_rules! each {
    ($n:literal, $i:ident => $value:expr) => {{
        // Not from_fn: a closure would not take the features of the function around it.
        let mut out = [V::splat(0.0); $n];
        let mut $i = 0;
        while $i < $n {
            out[$i] = $value;
            $i += 1;
        }
        out
    }};
}

/// Sum of magnitudes, from the left.
#[inline(always)]
fn norm<V: Vector, const K: usize>(v: &[V; K]) -> V {
    let mut s = V::splat(0.0);
    let mut i = 0;
    while i < K {
        s = s.add(v[i].abs());
        i += 1;
    }
    s
}

impl<V: Vector> QuadraticOf<V> {
    #[inline(always)]
    fn sealed(c: V, l: [V; 3], q: [V; 6], e: V, size: V) -> Self {
        let known = size.lt(V::splat(LARGE));
        if V::all(known) {
            return Self { c, e, l, q };
        }
        let zero = V::splat(0.0);
        Self {
            c: V::select(known, c, zero),
            e: V::select(known, e, V::splat(f64::INFINITY)),
            l: each!(3, i => V::select(known, l[i], zero)),
            q: each!(6, i => V::select(known, q[i], zero)),
        }
    }

    #[inline(always)]
    fn sum(c: V, l: [V; 3], q: [V; 6], t: V) -> Self {
        let w = c.abs().add(norm(&l)).add(norm(&q).add(t));
        Self::sealed(c, l, q, t.add(V::splat(4.0 * U).mul(w)), w)
    }
}

impl<V: Vector> Enclosures<V> for QuadraticOf<V> {
    const VECTORS: usize = 11;
    #[inline(always)]
    fn from_memory(from: &[Eight]) -> Self {
        let (l, q) = (each!(3, i => V::load(&from[i + 2])), each!(6, i => V::load(&from[i + 5])));
        Self { c: V::load(&from[0]), e: V::load(&from[1]), l, q }
    }
    #[inline(always)]
    fn to_memory(self, to: &mut [Eight]) {
        self.c.store(&mut to[0]);
        self.e.store(&mut to[1]);
        let mut i = 0;
        while i < 3 {
            self.l[i].store(&mut to[i + 2]);
            i += 1;
        }
        i = 0;
        while i < 6 {
            self.q[i].store(&mut to[i + 5]);
            i += 1;
        }
    }
    #[inline(always)]
    fn negated(self) -> Self {
        Self { c: self.c.neg(), e: self.e, l: each!(3, i => self.l[i].neg()), q: each!(6, i => self.q[i].neg()) }
    }
    #[inline(always)]
    fn added(self, o: Self) -> Self {
        let (l, q) = (each!(3, i => self.l[i].add(o.l[i])), each!(6, i => self.q[i].add(o.q[i])));
        Self::sum(self.c.add(o.c), l, q, self.e.add(o.e))
    }
    #[inline(always)]
    fn subtracted(self, o: Self) -> Self {
        let (l, q) = (each!(3, i => self.l[i].sub(o.l[i])), each!(6, i => self.q[i].sub(o.q[i])));
        Self::sum(self.c.sub(o.c), l, q, self.e.add(o.e))
    }
    #[inline(always)]
    fn multiplied(self, o: Self) -> Self {
        let (x, y) = (&self, &o);
        let (xl, yl, xq, yq) = (&x.l, &y.l, &x.q, &y.q);
        let (half, quarter) = (V::splat(0.5), V::splat(0.25));
        let mut l = each!(3, i => x.c.mul(yl[i]).add(y.c.mul(xl[i])));
        let mut q = each!(6, i => x.c.mul(yq[i]).add(y.c.mul(xq[i])));
        let mut cut = V::splat(0.0);
        let mut i = 0;
        while i < 3 {
            q[i] = q[i].add(xl[i].mul(yl[i]));
            let k = xl[i].mul(yq[i]).add(yl[i].mul(xq[i]));
            l[i] = l[i].add(V::splat(0.75).mul(k));
            cut = cut.add(quarter.mul(k.abs()));
            i += 1;
        }
        let mut pair = 0;
        while pair < 3 {
            let (i, j, m) = PAIRS[pair];
            q[m] = q[m].add(xl[i].mul(yl[j]).add(xl[j].mul(yl[i])));
            let k = xl[i].mul(yq[m]).add(yl[i].mul(xq[m])).add(xl[j].mul(yq[i]).add(yl[j].mul(xq[i])));
            l[j] = l[j].add(half.mul(k));
            cut = cut.add(half.mul(k.abs()));
            let k = xl[j].mul(yq[m]).add(yl[j].mul(xq[m])).add(xl[i].mul(yq[j]).add(yl[i].mul(xq[j])));
            l[i] = l[i].add(half.mul(k));
            cut = cut.add(half.mul(k.abs()));
            pair += 1;
        }
        let mixed = xl[0].mul(yq[5]).add(yl[0].mul(xq[5])).add(xl[1].mul(yq[4]).add(yl[1].mul(xq[4])));
        cut = cut.add(mixed.add(xl[2].mul(yq[3]).add(yl[2].mul(xq[3]))).abs());
        let (nxq, nyq) = (norm(xq), norm(yq));
        let mx = x.c.abs().add(norm(xl)).add(nxq);
        let my = y.c.abs().add(norm(yl)).add(nyq);
        let size = mx.add(x.e).mul(my.add(y.e));
        let e = cut.add(nxq.mul(nyq)).add(x.e.mul(my.add(y.e)).add(y.e.mul(mx)));
        let e = e.add(V::splat(PRODUCT).mul(size)).add(V::splat(TINY));
        Self::sealed(x.c.mul(y.c), l, q, e, size)
    }
    #[inline(always)]
    fn squared(self) -> Self {
        let (l, q, two) = (&self.l, &self.q, V::splat(2.0));
        let k2 = two.mul(self.c);
        let mut rl = each!(3, i => k2.mul(l[i]));
        let mut rq = each!(6, i => k2.mul(q[i]));
        let mut cut = V::splat(0.0);
        let mut i = 0;
        while i < 3 {
            rq[i] = rq[i].add(l[i].mul(l[i]));
            let k = two.mul(l[i]).mul(q[i]);
            rl[i] = rl[i].add(V::splat(0.75).mul(k));
            cut = cut.add(V::splat(0.25).mul(k.abs()));
            i += 1;
        }
        let mut pair = 0;
        while pair < 3 {
            let (i, j, m) = PAIRS[pair];
            rq[m] = rq[m].add(two.mul(l[i]).mul(l[j]));
            let k = l[i].mul(q[m]).add(l[j].mul(q[i]));
            rl[j] = rl[j].add(k);
            cut = cut.add(k.abs());
            let k = l[j].mul(q[m]).add(l[i].mul(q[j]));
            rl[i] = rl[i].add(k);
            cut = cut.add(k.abs());
            pair += 1;
        }
        cut = cut.add(two.mul(l[0].mul(q[5]).add(l[1].mul(q[4])).add(l[2].mul(q[3])).abs()));
        let nq = norm(q);
        let half = V::splat(0.5).mul(nq).mul(nq);
        let m = self.c.abs().add(norm(l)).add(nq);
        let size = m.add(self.e).mul(m.add(self.e));
        let e = cut.add(half).add(self.e.mul(two.mul(m).add(self.e)));
        let e = e.add(V::splat(PRODUCT).mul(size)).add(V::splat(TINY));
        Self::sealed(self.c.mul(self.c).add(half), rl, rq, e, size)
    }
    #[inline(always)]
    fn plus_centre_radius(self, m: V, r: V) -> Self {
        let c = self.c.add(m);
        let t = self.e.add(r);
        let w = c.abs().add(t);
        Self::sealed(c, self.l, self.q, t.add(V::splat(4.0 * U).mul(w)), w)
    }
    #[inline(always)]
    fn times_centre_radius(self, m: V, r: V) -> Self {
        let size = self.c.abs().add(norm(&self.l)).add(norm(&self.q).add(self.e));
        let w = size.mul(m.abs().add(r));
        let e = self.e.mul(m.abs()).add(size.mul(r));
        let e = e.add(V::splat(24.0 * U).mul(w)).add(V::splat(TINY));
        Self::sealed(self.c.mul(m), each!(3, i => self.l[i].mul(m)), each!(6, i => self.q[i].mul(m)), e, w)
    }
}

/// Eight jets of affine forms.
#[derive(Clone, Copy)]
pub struct JetOf<V, const N: usize> {
    value: AffineOf<V, N>,
    first: AffineOf<V, N>,
    second: AffineOf<V, N>,
}

impl<V: Vector, const N: usize> Enclosures<V> for JetOf<V, N> {
    const VECTORS: usize = 3 * (N + 2);
    #[inline(always)]
    fn from_memory(from: &[Eight]) -> Self {
        let part = N + 2;
        Self {
            value: AffineOf::from_memory(&from[..part]),
            first: AffineOf::from_memory(&from[part..2 * part]),
            second: AffineOf::from_memory(&from[2 * part..]),
        }
    }
    #[inline(always)]
    fn to_memory(self, to: &mut [Eight]) {
        let part = N + 2;
        self.value.store(&mut to[..part]);
        self.first.store(&mut to[part..2 * part]);
        self.second.store(&mut to[2 * part..]);
    }
    #[inline(always)]
    fn negated(self) -> Self {
        Self { value: self.value.negative(), first: self.first.negative(), second: self.second.negative() }
    }
    #[inline(always)]
    fn added(self, o: Self) -> Self {
        let second = self.second.plus(o.second);
        Self { value: self.value.plus(o.value), first: self.first.plus(o.first), second }
    }
    #[inline(always)]
    fn subtracted(self, o: Self) -> Self {
        let second = self.second.minus(o.second);
        Self { value: self.value.minus(o.value), first: self.first.minus(o.first), second }
    }
    #[inline(always)]
    fn multiplied(self, o: Self) -> Self {
        let first = self.value.times(o.first).plus(self.first.times(o.value));
        let second = self.value.times(o.second).plus(self.first.times(o.first)).plus(self.second.times(o.value));
        Self { value: self.value.times(o.value), first, second }
    }
    #[inline(always)]
    fn squared(self) -> Self {
        let twice = self.value.scaled(2.0);
        let second = twice.times(self.second).plus(self.first.square());
        Self { value: self.value.square(), first: twice.times(self.first), second }
    }
    #[inline(always)]
    fn plus_centre_radius(self, m: V, r: V) -> Self {
        Self { value: self.value.shifted(m, r), ..self }
    }
    #[inline(always)]
    fn times_centre_radius(self, m: V, r: V) -> Self {
        let second = self.second.times_centre_radius(m, r);
        Self { value: self.value.times_centre_radius(m, r), first: self.first.times_centre_radius(m, r), second }
    }
}

/// Powers are left to the scalar operators.
macro_rules! kernel_of_enclosures {
    ([$($generic:tt)*] $type:ty) => {
        impl<$($generic)*> Kernel<V> for $type {
            #[inline(always)]
            fn load(from: &[Eight]) -> Self {
                Self::from_memory(from)
            }
            #[inline(always)]
            fn store(self, to: &mut [Eight]) {
                self.to_memory(to);
            }
            #[inline(always)]
            fn neg(self) -> (Self, V::Mask) {
                (self.negated(), V::always())
            }
            #[inline(always)]
            fn add(self, o: Self) -> (Self, V::Mask) {
                (self.added(o), V::always())
            }
            #[inline(always)]
            fn sub(self, o: Self) -> (Self, V::Mask) {
                (self.subtracted(o), V::always())
            }
            #[inline(always)]
            fn mul(self, o: Self) -> (Self, V::Mask) {
                (self.multiplied(o), V::always())
            }
            #[inline(always)]
            fn sqr(self) -> (Self, V::Mask) {
                (self.squared(), V::always())
            }
            left_to_scalars!();
            #[inline(always)]
            fn power(self, _: u32) -> (Self, V::Mask) {
                (self, never::<V>())
            }
            #[inline(always)]
            fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask) {
                (t.multiplied(d).added(p), V::always())
            }
        }
    };
}
kernel_of_enclosures!([V: Vector] QuadraticOf<V>);
kernel_of_enclosures!([V: Vector, const N: usize] JetOf<V, N>);

/// Eight plain jets.
#[derive(Clone, Copy)]
pub struct PointJetOf<V>([V; 3]);

impl<V: Vector> PointJetOf<V> {
    #[inline(always)]
    fn times(self, o: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, o.0);
        Self([a.mul(x), a.mul(y).add(b.mul(x)), a.mul(z).add(b.mul(y)).add(c.mul(x))])
    }
}

impl<V: Vector> Kernel<V> for PointJetOf<V> {
    #[inline(always)]
    fn load(from: &[Eight]) -> Self {
        Self(each!(3, i => V::load(&from[i])))
    }
    #[inline(always)]
    fn store(self, to: &mut [Eight]) {
        let mut i = 0;
        while i < 3 {
            self.0[i].store(&mut to[i]);
            i += 1;
        }
    }
    #[inline(always)]
    fn neg(self) -> (Self, V::Mask) {
        (Self(each!(3, i => self.0[i].mul(V::splat(-1.0)))), V::always())
    }
    #[inline(always)]
    fn add(self, o: Self) -> (Self, V::Mask) {
        (Self(each!(3, i => self.0[i].add(o.0[i]))), V::always())
    }
    #[inline(always)]
    fn sub(self, o: Self) -> (Self, V::Mask) {
        (Self(each!(3, i => self.0[i].sub(o.0[i]))), V::always())
    }
    #[inline(always)]
    fn mul(self, o: Self) -> (Self, V::Mask) {
        (self.times(o), V::always())
    }
    #[inline(always)]
    fn sqr(self) -> (Self, V::Mask) {
        (self.times(self), V::always())
    }
    left_to_scalars!();
    #[inline(always)]
    fn power(self, n: u32) -> (Self, V::Mask) {
        let square = self.times(self);
        match n {
            3 => (square.times(self), V::always()),
            4 => (square.times(square), V::always()),
            _ => (self, never::<V>()),
        }
    }
    #[inline(always)]
    fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask) {
        t.times(d).add(p)
    }
}
