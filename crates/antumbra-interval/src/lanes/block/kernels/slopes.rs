//! Slopes of forms on vectors, from apexes in intervals and from apexes that are forms themselves. Why they enclose is said in
//! `affine::slope`.
use super::forms::{Enclosures, never};
use super::{AffineOf, IntervalOf, Kernel, left_to_scalars};
use crate::lanes::block::vector::{Eight, Vector};

/// Eight apexes of slopes of forms.
pub trait Apexes<V: Vector, F>: Kernel<V> {
    /// Vectors in it.
    const VECTORS: usize;
    /// `x + self`.
    fn shift(self, x: F) -> F;
    /// `x * self`.
    fn scale(self, x: F) -> F;
}

impl<V: Vector, F: Enclosures<V>> Apexes<V, F> for IntervalOf<V> {
    const VECTORS: usize = 2;
    #[inline(always)]
    fn shift(self, x: F) -> F {
        let (m, r) = self.centre_radius();
        x.plus_centre_radius(m, r)
    }
    #[inline(always)]
    fn scale(self, x: F) -> F {
        let (m, r) = self.centre_radius();
        x.times_centre_radius(m, r)
    }
}

impl<V: Vector, const N: usize> Apexes<V, Self> for AffineOf<V, N> {
    const VECTORS: usize = N + 2;
    #[inline(always)]
    fn shift(self, x: Self) -> Self {
        x.plus(self)
    }
    #[inline(always)]
    fn scale(self, x: Self) -> Self {
        x.times(self)
    }
}

/// Eight slopes.
#[derive(Clone, Copy)]
pub struct SlopeLanes<P, F> {
    apex: P,
    value: F,
    slope: F,
}

/// The apex decides which lanes are proper.
impl<V: Vector, P: Apexes<V, F>, F: Enclosures<V>> Kernel<V> for SlopeLanes<P, F> {
    #[inline(always)]
    fn load(from: &[Eight]) -> Self {
        let to = P::VECTORS + F::VECTORS;
        Self {
            apex: P::load(&from[..P::VECTORS]),
            value: F::from_memory(&from[P::VECTORS..to]),
            slope: F::from_memory(&from[to..]),
        }
    }
    #[inline(always)]
    fn store(self, to: &mut [Eight]) {
        let end = P::VECTORS + F::VECTORS;
        self.apex.store(&mut to[..P::VECTORS]);
        self.value.to_memory(&mut to[P::VECTORS..end]);
        self.slope.to_memory(&mut to[end..]);
    }
    #[inline(always)]
    fn neg(self) -> (Self, V::Mask) {
        let (apex, proper) = self.apex.neg();
        (Self { apex, value: self.value.negated(), slope: self.slope.negated() }, proper)
    }
    #[inline(always)]
    fn add(self, o: Self) -> (Self, V::Mask) {
        let (apex, proper) = self.apex.add(o.apex);
        (Self { apex, value: self.value.added(o.value), slope: self.slope.added(o.slope) }, proper)
    }
    #[inline(always)]
    fn sub(self, o: Self) -> (Self, V::Mask) {
        let (apex, proper) = self.apex.sub(o.apex);
        (Self { apex, value: self.value.subtracted(o.value), slope: self.slope.subtracted(o.slope) }, proper)
    }
    #[inline(always)]
    fn mul(self, o: Self) -> (Self, V::Mask) {
        let (apex, proper) = self.apex.mul(o.apex);
        let slope = self.slope.multiplied(o.value).added(self.apex.scale(o.slope));
        (Self { apex, value: self.value.multiplied(o.value), slope }, proper)
    }
    #[inline(always)]
    fn sqr(self) -> (Self, V::Mask) {
        let (apex, proper) = self.apex.sqr();
        let slope = self.slope.multiplied(self.apex.shift(self.value));
        (Self { apex, value: self.value.squared(), slope }, proper)
    }
    left_to_scalars!();
    /// The slope by the product rule, in the order of the scalar operator: from the lowest bit of n up.
    #[inline(always)]
    fn power(self, n: u32) -> (Self, V::Mask) {
        if !F::POWERS {
            return (self, never::<V>());
        }
        let (apex, at_apex) = self.apex.power(n);
        let (value, at_value) = self.value.powered(n);
        let (mut proper, mut square, mut slope, mut left) = (V::both(at_apex, at_value), self, self, n);
        let mut begun = false;
        loop {
            if left & 1 == 1 {
                let (product, fine) = if begun { slope.mul(square) } else { (square, proper) };
                (slope, proper, begun) = (product, V::both(proper, fine), true);
            }
            left >>= 1;
            if left == 0 {
                return (Self { apex, value, slope: slope.slope }, proper);
            }
            let (next, fine) = square.sqr();
            (square, proper) = (next, V::both(proper, fine));
        }
    }
    #[inline(always)]
    fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask) {
        let (product, proper) = t.mul(d);
        let (sum, sums) = product.add(p);
        (sum, V::both(proper, sums))
    }
}
