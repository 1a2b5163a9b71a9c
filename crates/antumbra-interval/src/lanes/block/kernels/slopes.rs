//! Slopes of forms on vectors, from apexes in intervals. Why they enclose is said in `affine::slope`.
use super::forms::{Enclosures, never};
use super::{IntervalOf, Kernel, left_to_scalars};
use crate::lanes::block::vector::{Eight, Vector};

/// Eight slopes from apexes in intervals.
#[derive(Clone, Copy)]
pub struct SlopeLanes<V, F> {
    apex: IntervalOf<V>,
    value: F,
    slope: F,
}

/// The apex decides which lanes are proper.
impl<V: Vector, F: Enclosures<V>> Kernel<V> for SlopeLanes<V, F> {
    #[inline(always)]
    fn load(from: &[Eight]) -> Self {
        let to = 2 + F::VECTORS;
        Self {
            apex: Kernel::<V>::load(&from[..2]),
            value: F::from_memory(&from[2..to]),
            slope: F::from_memory(&from[to..]),
        }
    }
    #[inline(always)]
    fn store(self, to: &mut [Eight]) {
        let end = 2 + F::VECTORS;
        self.apex.store(&mut to[..2]);
        self.value.to_memory(&mut to[2..end]);
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
        let (m, r) = self.apex.centre_radius();
        let slope = self.slope.multiplied(o.value).added(o.slope.times_centre_radius(m, r));
        (Self { apex, value: self.value.multiplied(o.value), slope }, proper)
    }
    #[inline(always)]
    fn sqr(self) -> (Self, V::Mask) {
        let (apex, proper) = self.apex.sqr();
        let (m, r) = self.apex.centre_radius();
        let slope = self.slope.multiplied(self.value.plus_centre_radius(m, r));
        (Self { apex, value: self.value.squared(), slope }, proper)
    }
    left_to_scalars!();
    #[inline(always)]
    fn power(self, _: u32) -> (Self, V::Mask) {
        (self, never::<V>())
    }
    #[inline(always)]
    fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask) {
        let (product, proper) = t.mul(d);
        let (sum, sums) = product.add(p);
        (sum, V::both(proper, sums))
    }
}
