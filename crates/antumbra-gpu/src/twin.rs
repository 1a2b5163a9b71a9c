//! The arithmetic of `forms.wgsl` in Rust, operation by operation: on a GPU that rounds to nearest every bit is the same. With `FLUSH`
//! as on one that takes every subnormal operand and result for 0.
use antumbra::eval::Number;
use antumbra::eval::wgsl::{FLOOR, ball, exact};
use antumbra::expr::{Binary, Unary};
use antumbra_interval::Interval;

use std::ops::{Add, Mul, Neg, Sub};

const U: f32 = f32::EPSILON;

/// A number of such a GPU.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(crate) struct R<const FLUSH: bool>(pub(crate) f32);

/// `x`, as an operand or a result.
fn kept<const FLUSH: bool>(x: f32) -> f32 {
    if FLUSH && x.abs() < f32::MIN_POSITIVE { 0.0 } else { x }
}

macro_rules! operator {
    ($name:ident, $method:ident) => {
        impl<const FLUSH: bool> $name for R<FLUSH> {
            type Output = Self;
            fn $method(self, o: Self) -> Self {
                Self(kept::<FLUSH>(kept::<FLUSH>(self.0).$method(kept::<FLUSH>(o.0))))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);

/// A number times a constant.
impl<const FLUSH: bool> Mul<f32> for R<FLUSH> {
    type Output = Self;
    fn mul(self, o: f32) -> Self {
        self * Self(o)
    }
}

impl<const FLUSH: bool> Neg for R<FLUSH> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<const FLUSH: bool> R<FLUSH> {
    const FLOOR: Self = Self(FLOOR);
    const INFINITY: Self = Self(f32::INFINITY);
    const ZERO: Self = Self(0.0);

    fn abs(self) -> Self {
        Self(self.0.abs())
    }
}

/// `Form` of `forms.wgsl`: `c + a.s +- e`. Constants are remembered as such, as the generated text does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Twin<const FLUSH: bool> {
    /// Centre.
    pub(crate) c: R<FLUSH>,
    /// Error.
    pub(crate) e: R<FLUSH>,
    /// Coefficients.
    pub(crate) a: [R<FLUSH>; 3],
    constant: Option<Interval>,
}

fn sum3<const FLUSH: bool>(s: R<FLUSH>, a: [R<FLUSH>; 3]) -> R<FLUSH> {
    a.iter().fold(s, |s, v| s + v.abs())
}

impl<const FLUSH: bool> Twin<FLUSH> {
    /// A form with these numbers.
    pub(crate) fn new(c: R<FLUSH>, e: R<FLUSH>, a: [R<FLUSH>; 3]) -> Self {
        Self { c, e, a, constant: None }
    }

    fn zip(self, o: Self, f: impl Fn(R<FLUSH>, R<FLUSH>) -> R<FLUSH>) -> [R<FLUSH>; 3] {
        std::array::from_fn(|k| f(self.a[k], o.a[k]))
    }

    fn sum(c: R<FLUSH>, a: [R<FLUSH>; 3], t: R<FLUSH>) -> Self {
        let w = sum3(c.abs() + t, a);
        Self::new(c, t + w * (3.0 * U), a)
    }

    fn add(self, o: Self) -> Self {
        Self::sum(self.c + o.c, self.zip(o, |x, y| x + y), self.e + o.e)
    }

    fn sub(self, o: Self) -> Self {
        Self::sum(self.c - o.c, self.zip(o, |x, y| x - y), self.e + o.e)
    }

    fn neg(self) -> Self {
        Self::new(-self.c, self.e, self.a.map(|v| -v))
    }

    fn addk(self, m: f32, r: f32) -> Self {
        let (c, t) = (self.c + R(m), self.e + R(r));
        Self::new(c, t + (c.abs() + t) * (3.0 * U), self.a)
    }

    fn scale(self, k: f32) -> Self {
        let (c, a, t) = (self.c * k, self.a.map(|v| v * k), self.e * k.abs());
        let w = sum3(c.abs() + t, a);
        Self::new(c, t + w * (5.0 * U) + R::FLOOR, a)
    }

    fn mulk(self, m: f32, r: f32) -> Self {
        let (s, p, m, r) = (sum3(self.e, self.a), self.c.abs(), R(m), R(r));
        let rest = p * r + s * (m.abs() + r);
        let e = self.e * m.abs() + (p + s) * r;
        let c = self.c * m;
        let pad = c.abs() * (3.0 * U) + rest * (20.0 * U);
        Self::new(c, e + pad + R::FLOOR, self.a.map(|v| v * m))
    }

    fn mul(self, o: Self) -> Self {
        let (r, t) = (sum3(self.e, self.a), sum3(o.e, o.a));
        let w = self.zip(o, |x, y| x * y);
        let q = w[0] + w[1] + w[2];
        let d = w[0].abs() + w[1].abs() + w[2].abs();
        let (p, s) = (self.c.abs(), o.c.abs());
        let rest = p * t + r * (s + t);
        let e = (r * t - d * 0.5) + (p * o.e + s * self.e);
        let a = std::array::from_fn(|k| self.c * o.a[k] + o.c * self.a[k]);
        let c = self.c * o.c;
        let pad = c.abs() * (4.0 * U) + rest * (28.0 * U);
        Self::new(c + q * 0.5, e + pad + R::FLOOR, a)
    }

    fn sqr(self) -> Self {
        let (r, p) = (sum3(self.e, self.a), self.c.abs());
        let h = (r * r) * 0.5;
        let e = h + (p * 2.0) * self.e;
        let c = self.c * self.c;
        let pad = c * (4.0 * U) + (r * (p * 2.0 + r)) * (28.0 * U);
        Self::new(c + h, e + pad + R::FLOOR, self.a.map(|v| v * (self.c * 2.0)))
    }

    fn radius(self) -> R<FLUSH> {
        sum3(self.e, self.a) * (1.0 + 8.0 * U)
    }

    /// The sign that the function has everywhere; 0 if that is not proved.
    pub(crate) fn sign(self) -> i32 {
        let r = self.radius();
        i32::from(self.c > r) - i32::from(self.c < -r)
    }

    fn abs(self) -> Self {
        match self.sign() {
            1 => self,
            -1 => self.neg(),
            _ => {
                let h = ((self.c.abs() + self.radius()) * (1.0 + 8.0 * U)) * 0.5;
                Self::new(h, h, [R::ZERO; 3])
            }
        }
    }
}

impl<const FLUSH: bool> Number for Twin<FLUSH> {
    fn constant(value: Interval) -> Self {
        let (m, r) = ball(value);
        Self { constant: Some(value), ..Self::new(R(m), R(r), [R::ZERO; 3]) }
    }

    fn unary(self, op: Unary) -> Self {
        match op {
            Unary::Neg => self.neg(),
            Unary::Abs => self.abs(),
            Unary::Sqr => self.sqr(),
            _ => Self::new(R::ZERO, R::INFINITY, [R::ZERO; 3]),
        }
    }

    fn powi(self, n: i32) -> Self {
        power(self, n, Self::sqr, Self::mul).unwrap_or(Self::constant(Interval::ONE))
    }

    fn binary(self, op: Binary, o: Self) -> Self {
        let shifted = |x: Self, k: Interval| {
            let (m, r) = ball(k);
            x.addk(m, r)
        };
        let scaled = |x: Self, k: Interval| match exact(k) {
            Some(k) => x.scale(k),
            None => {
                let (m, r) = ball(k);
                x.mulk(m, r)
            }
        };
        match (op, self.constant, o.constant) {
            (Binary::Add, _, Some(k)) => shifted(self, k),
            (Binary::Sub, _, Some(k)) => shifted(self, -k),
            (Binary::Add, Some(k), _) => shifted(o, k),
            (Binary::Mul, _, Some(k)) => scaled(self, k),
            (Binary::Mul, Some(k), _) => scaled(o, k),
            (Binary::Add, ..) => self.add(o),
            (Binary::Sub, ..) => self.sub(o),
            (Binary::Mul, ..) => self.mul(o),
            (Binary::Max, ..) => self.add(o).add(self.sub(o).abs()).scale(0.5),
            (Binary::Min, ..) => self.add(o).sub(self.sub(o).abs()).scale(0.5),
            _ => Self::new(R::ZERO, R::INFINITY, [R::ZERO; 3]),
        }
    }
}

/// Powers as the generated text takes them; none for the power 0.
fn power<N: Copy>(x: N, n: i32, sqr: impl Fn(N) -> N, mul: impl Fn(N, N) -> N) -> Option<N> {
    let n = u32::try_from(n).ok().filter(|n| *n > 0)?;
    Some((0..n.ilog2()).rev().fold(x, |p, bit| if n >> bit & 1 == 1 { mul(sqr(p), x) } else { sqr(p) }))
}

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

fn b_mul<const FLUSH: bool>(x: [R<FLUSH>; 2], y: [R<FLUSH>; 2]) -> [R<FLUSH>; 2] {
    let (p, q) = (x[0].abs(), y[0].abs());
    let rest = p * y[1] + x[1] * (q + y[1]);
    let m = x[0] * y[0];
    [m, rest * (1.0 + 20.0 * U) + m.abs() * (3.0 * U) + R::FLOOR]
}

impl<const FLUSH: bool> TwinSlope<FLUSH> {
    fn add(self, o: Self) -> Self {
        Self { p: b_add(self.p, o.p), v: self.v.add(o.v), g: self.g.add(o.g) }
    }

    fn sub(self, o: Self) -> Self {
        Self { p: b_add(self.p, b_neg(o.p)), v: self.v.sub(o.v), g: self.g.sub(o.g) }
    }

    fn neg(self) -> Self {
        Self { p: b_neg(self.p), v: self.v.neg(), g: self.g.neg() }
    }

    fn addk(self, m: f32, r: f32) -> Self {
        Self { p: b_add(self.p, [R(m), R(r)]), v: self.v.addk(m, r), g: self.g }
    }

    fn scale(self, k: f32) -> Self {
        Self { p: b_mul(self.p, [R(k), R::FLOOR]), v: self.v.scale(k), g: self.g.scale(k) }
    }

    fn mulk(self, m: f32, r: f32) -> Self {
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

    fn abs(self) -> Self {
        let (s, b) = (self.v.sign(), [self.p[0].abs(), self.p[1]]);
        if s != 0 && b[0] > b[1] && (self.p[0] > R::ZERO) == (s > 0) {
            return if s > 0 { self } else { self.neg() };
        }
        let h = (self.g.c.abs() + self.g.radius()) * (1.0 + 8.0 * U);
        Self { p: b, v: self.v.abs(), g: Twin::new(R::ZERO, h, [R::ZERO; 3]) }
    }
}

impl<const FLUSH: bool> Number for TwinSlope<FLUSH> {
    fn constant(value: Interval) -> Self {
        let (m, r) = ball(value);
        Self { p: [R(m), R(r)], v: Twin::constant(value), g: Twin::new(R::ZERO, R::FLOOR, [R::ZERO; 3]) }
    }

    fn unary(self, op: Unary) -> Self {
        match op {
            Unary::Neg => self.neg(),
            Unary::Abs => self.abs(),
            Unary::Sqr => self.sqr(),
            _ => Self { g: Twin::new(R::ZERO, R::INFINITY, [R::ZERO; 3]), ..self },
        }
    }

    fn powi(self, n: i32) -> Self {
        power(self, n, Self::sqr, Self::mul).unwrap_or(Self::constant(Interval::ONE))
    }

    fn binary(self, op: Binary, o: Self) -> Self {
        let shifted = |x: Self, k: Interval| {
            let (m, r) = ball(k);
            x.addk(m, r)
        };
        let scaled = |x: Self, k: Interval| match exact(k) {
            Some(k) => x.scale(k),
            None => {
                let (m, r) = ball(k);
                x.mulk(m, r)
            }
        };
        match (op, self.v.constant, o.v.constant) {
            (Binary::Add, _, Some(k)) => shifted(self, k),
            (Binary::Sub, _, Some(k)) => shifted(self, -k),
            (Binary::Add, Some(k), _) => shifted(o, k),
            (Binary::Mul, _, Some(k)) => scaled(self, k),
            (Binary::Mul, Some(k), _) => scaled(o, k),
            (Binary::Add, ..) => self.add(o),
            (Binary::Sub, ..) => self.sub(o),
            (Binary::Mul, ..) => self.mul(o),
            (Binary::Max, ..) => self.add(o).add(self.sub(o).abs()).scale(0.5),
            (Binary::Min, ..) => self.add(o).sub(self.sub(o).abs()).scale(0.5),
            _ => Self { g: Twin::new(R::ZERO, R::INFINITY, [R::ZERO; 3]), ..self },
        }
    }
}
