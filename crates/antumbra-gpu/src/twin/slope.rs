//! Slopes, as `Slope` of `forms.wgsl`.
use super::functions::Function;
use super::{R, Twin, U, arithmetic};
use antumbra::eval::Number;
use antumbra::eval::wgsl::ball;
use antumbra::expr::{Binary, Unary};
use antumbra_interval::Interval;

/// `Slope` of `forms.wgsl`: the ball `p`, value and slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TwinSlope<const FLUSH: bool> {
    /// Middle and radius of the value at the apex.
    pub(crate) p: [R<FLUSH>; 2],
    /// The value.
    pub(crate) v: Twin<FLUSH>,
    /// The slope.
    pub(crate) g: Twin<FLUSH>,
}

fn b_add<const FLUSH: bool>(x: [R<FLUSH>; 2], y: [R<FLUSH>; 2]) -> [R<FLUSH>; 2] {
    let (m, t) = (x[0] + y[0], x[1] + y[1]);
    [m, t + (m.abs() + t) * (3.0 * U)]
}

fn b_neg<const FLUSH: bool>(x: [R<FLUSH>; 2]) -> [R<FLUSH>; 2] {
    [-x[0], x[1]]
}

pub(super) fn b_mul<const FLUSH: bool>(x: [R<FLUSH>; 2], y: [R<FLUSH>; 2]) -> [R<FLUSH>; 2] {
    let (p, q) = (x[0].abs(), y[0].abs());
    let rest = p * y[1] + x[1] * (q + y[1]);
    let m = x[0] * y[0];
    [m, rest * (1.0 + 20.0 * U) + m.abs() * (3.0 * U) + R::FLOOR]
}

impl<const FLUSH: bool> TwinSlope<FLUSH> {
    fn literal(value: Interval) -> Self {
        let (m, r) = ball(value);
        Self { p: [R(m), R(r)], v: Twin::literal(value), g: Twin::new(R::ZERO, R::FLOOR, [R::ZERO; 3]) }
    }

    pub(super) fn add(self, o: Self) -> Self {
        Self { p: b_add(self.p, o.p), v: self.v.add(o.v), g: self.g.add(o.g) }
    }

    pub(super) fn sub(self, o: Self) -> Self {
        Self { p: b_add(self.p, b_neg(o.p)), v: self.v.sub(o.v), g: self.g.sub(o.g) }
    }

    pub(super) fn neg(self) -> Self {
        Self { p: b_neg(self.p), v: self.v.neg(), g: self.g.neg() }
    }

    pub(super) fn addk(self, m: f32, r: f32) -> Self {
        Self { p: b_add(self.p, [R(m), R(r)]), v: self.v.addk(m, r), g: self.g }
    }

    pub(super) fn scale(self, k: f32) -> Self {
        Self { p: b_mul(self.p, [R(k), R::FLOOR]), v: self.v.scale(k), g: self.g.scale(k) }
    }

    pub(super) fn mulk(self, m: f32, r: f32) -> Self {
        Self { p: b_mul(self.p, [R(m), R(r)]), v: self.v.mulk(m, r), g: self.g.mulk(m, r) }
    }

    fn mul(self, o: Self) -> Self {
        let g = self.g.mul(o.v).add(o.g.mulk(self.p[0].0, self.p[1].0));
        Self { p: b_mul(self.p, o.p), v: self.v.mul(o.v), g }
    }

    fn sqr(self) -> Self {
        let g = self.g.mul(self.v.addk(self.p[0].0, self.p[1].0));
        Self { p: b_mul(self.p, self.p), v: self.v.sqr(), g }
    }

    fn sign(self) -> i32 {
        let s = self.v.sign();
        if self.p[0].abs() > self.p[1] && (self.p[0] > R::ZERO) == (s > 0) { s } else { 0 }
    }

    fn abs(self) -> Self {
        match self.sign() {
            1 => self,
            -1 => self.neg(),
            _ => {
                let h = (self.g.c.abs() + self.g.radius()) * (1.0 + 8.0 * U);
                Self { p: [self.p[0].abs(), self.p[1]], v: self.v.abs(), g: Twin::new(R::ZERO, h, [R::ZERO; 3]) }
            }
        }
    }
}

arithmetic!(TwinSlope, |x| x.v.constant);
