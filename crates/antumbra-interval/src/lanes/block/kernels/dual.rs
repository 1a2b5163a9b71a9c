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
    /// `f' / (2 sqrt f)`.
    #[inline(always)]
    fn sqrt(self) -> (Self, V::Mask) {
        let (value, proper) = self.value.root();
        let (slope, fine) = value.scaled(2.0).recip();
        (Self { value, derivative: self.derivative.times(slope) }, V::both(proper, fine))
    }
    #[inline(always)]
    fn abs(self) -> (Self, V::Mask) {
        let (value, proper) = self.value.size();
        let (d, negative) = (self.derivative, self.derivative.negative());
        let derivative = AffineOf::by_sign(self.value.range(), d, negative, d.between(negative));
        (Self { value, derivative }, proper)
    }
    #[inline(always)]
    fn min(self, o: Self) -> (Self, V::Mask) {
        let (larger, proper) = self.neg().0.max(o.neg().0);
        (larger.neg().0, proper)
    }
    #[inline(always)]
    fn max(self, o: Self) -> (Self, V::Mask) {
        let difference = self.value.minus(o.value).range();
        let (d, other) = (self.derivative, o.derivative);
        let derivative = AffineOf::by_sign(difference, d, other, d.between(other));
        (Self { value: self.value.larger(o.value), derivative }, V::always())
    }
    /// `n f^(n-1) f'`.
    #[inline(always)]
    fn power(self, n: u32) -> (Self, V::Mask) {
        let (mut lower, mut value, mut proper) = (self.value, self.value, V::always());
        // A loop, so that the long formulas stand in the code once.
        for m in n - 1..=n {
            let (power, fine) = self.value.powi(m);
            (lower, value, proper) = (value, power, V::both(proper, fine));
        }
        let derivative = lower.scaled(f64::from(n)).times(self.derivative);
        (Self { value, derivative }, proper)
    }
    #[inline(always)]
    fn coordinate(t: Self, d: Self, p: Self) -> (Self, V::Mask) {
        let value = t.value.times(d.value).shifted(p.value.c, p.value.e);
        (Self { value, derivative: d.value }, V::always())
    }
    #[inline(always)]
    fn spanning(self) -> (Self, V::Mask) {
        (Self { value: self.value.spanning().0, ..self }, V::always())
    }
}
