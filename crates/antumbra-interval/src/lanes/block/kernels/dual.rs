//! Values with derivatives: step by step what `affine::dual` does.
use super::super::vector::{Eight, Vector};
use super::{AffineOf, Kernel};

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
    /// The scalar operator computes the reciprocal twice, which has the same bits.
    #[inline(always)]
    fn div(self, o: Self) -> (Self, V::Mask) {
        let (reciprocal, proper) = o.value.recip();
        let value = self.value.times(reciprocal);
        let derivative = self.derivative.minus(value.times(o.derivative)).times(reciprocal);
        (Self { value, derivative }, proper)
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
