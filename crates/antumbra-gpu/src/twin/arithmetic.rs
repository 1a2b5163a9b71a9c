// The arithmetic of `forms.wgsl`, operation by operation, for `f32` as the module that includes it has it: as the kernels' text is that of both
// widths. A module brings `f32`, `ball`, `exact`, `guess` and `Function`.

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

/// `reciprocal`.
fn reciprocal<const FLUSH: bool>(c: R<FLUSH>) -> R<FLUSH> {
    (0..3).fold(R(guess(c.0)), |q, _| q * (R(2.0) - c * q))
}

impl<const FLUSH: bool> Twin<FLUSH> {
    fn literal(value: Interval) -> Self {
        let (m, r) = ball(value);
        Self { constant: Some(value), ..Self::new(R(m), R(r), [R::ZERO; 3]) }
    }

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

    pub(super) fn add(self, o: Self) -> Self {
        Self::sum(self.c + o.c, self.zip(o, |x, y| x + y), self.e + o.e)
    }

    pub(super) fn sub(self, o: Self) -> Self {
        Self::sum(self.c - o.c, self.zip(o, |x, y| x - y), self.e + o.e)
    }

    pub(super) fn neg(self) -> Self {
        Self::new(-self.c, self.e, self.a.map(|v| -v))
    }

    pub(super) fn addk(self, m: f32, r: f32) -> Self {
        let (c, t) = (self.c + R(m), self.e + R(r));
        Self::new(c, t + (c.abs() + t) * (3.0 * U), self.a)
    }

    pub(super) fn scale(self, k: f32) -> Self {
        let (c, a, t) = (self.c * k, self.a.map(|v| v * k), self.e * k.abs());
        let w = sum3(c.abs() + t, a);
        Self::new(c, t + w * (5.0 * U) + R::FLOOR, a)
    }

    pub(super) fn mulk(self, m: f32, r: f32) -> Self {
        let (s, p, m, r) = (sum3(self.e, self.a), self.c.abs(), R(m), R(r));
        let rest = p * r + s * (m.abs() + r);
        let e = self.e * m.abs() + (p + s) * r;
        let c = self.c * m;
        let pad = c.abs() * (3.0 * U) + rest * (20.0 * U);
        Self::new(c, e + pad + R::FLOOR, self.a.map(|v| v * m))
    }

    pub(super) fn mul(self, o: Self) -> Self {
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
                let (c, r) = (self.c, self.radius());
                let k = R((c * reciprocal(r)).0.clamp(-1.0, 1.0));
                let b = ((R(1.0) - k) * (r + c)).0.max(((R(1.0) + k) * (r - c)).0);
                let h = (R(b) + r * (4.0 * U)) * (0.5 * (1.0 + 8.0 * U));
                self.scale(k.0).addk(h.0, h.0)
            }
        }
    }
}

/// What forms and slopes have in common: how the generated text writes an operator.
trait Arithmetic: Copy {
    fn known(self) -> Option<Interval>;
    fn sign(self) -> i32;
    fn neg(self) -> Self;
    fn abs(self) -> Self;
    fn sqr(self) -> Self;
    fn add(self, o: Self) -> Self;
    fn sub(self, o: Self) -> Self;
    fn mul(self, o: Self) -> Self;
    fn div(self, o: Self) -> Self;
    fn inverse(self) -> Self;
    fn addk(self, m: f32, r: f32) -> Self;
    fn mulk(self, m: f32, r: f32) -> Self;
    fn scale(self, k: f32) -> Self;
    fn real(self, m: f32, r: f32) -> Self;
    fn named(self, name: Function) -> Self;

    fn unary(self, op: Unary) -> Self {
        match op {
            Unary::Neg => self.neg(),
            Unary::Abs => self.abs(),
            Unary::Sqr => self.sqr(),
            Unary::Sqrt => self.named(Function::Sqrt),
            Unary::Exp => self.named(Function::Exp),
            Unary::Ln => self.named(Function::Ln),
            Unary::Sin => self.named(Function::Sin),
            Unary::Cos => self.named(Function::Cos),
            Unary::Sinh => self.named(Function::Sinh),
            Unary::Cosh => self.named(Function::Cosh),
            _ => panic!("the kernels do not have {op:?}"),
        }
    }

    fn max(self, o: Self) -> Self {
        let d = self.sub(o);
        match d.sign() {
            1 => self,
            -1 => o,
            _ => self.add(o).add(d.abs()).scale(0.5),
        }
    }

    fn shifted(self, k: Interval) -> Self {
        let (m, r) = ball(k);
        self.addk(m, r)
    }

    fn scaled(self, k: Interval) -> Self {
        let (m, r) = ball(k);
        exact(k).map_or_else(|| self.mulk(m, r), |k| self.scale(k))
    }

    fn binary(self, op: Binary, o: Self) -> Self {
        match (op, self.known(), o.known()) {
            (Binary::Add, _, Some(k)) => self.shifted(k),
            (Binary::Sub, _, Some(k)) => self.shifted(-k),
            (Binary::Add, Some(k), _) => o.shifted(k),
            (Binary::Mul, _, Some(k)) => self.scaled(k),
            (Binary::Mul, Some(k), _) => o.scaled(k),
            (Binary::Div, _, Some(k)) if !k.possibly_zero() => self.scaled(Interval::ONE / k),
            (Binary::Pow, _, Some(k)) if k.hi() < 0.0 => {
                let (m, r) = ball(-k);
                self.real(m, r).inverse()
            }
            (Binary::Pow, _, Some(k)) => {
                let (m, r) = ball(k);
                self.real(m, r)
            }
            (Binary::Add, ..) => self.add(o),
            (Binary::Sub, ..) => self.sub(o),
            (Binary::Mul, ..) => self.mul(o),
            (Binary::Div, ..) => self.div(o),
            (Binary::Max, ..) => self.max(o),
            (Binary::Min, ..) => self.neg().max(o.neg()).neg(),
            _ => panic!("the kernels do not have {op:?}"),
        }
    }

    /// Powers as the generated text takes them; none for the power 0.
    fn power(self, n: i32) -> Option<Self> {
        let m = Some(n.unsigned_abs()).filter(|m| *m > 0)?;
        let step = |p: Self, bit: u32| if m >> bit & 1 == 1 { p.sqr().mul(self) } else { p.sqr() };
        let power = (0..m.ilog2()).rev().fold(self, step);
        Some(if n < 0 { power.inverse() } else { power })
    }
}

/// The operations of a kind of number, as the trait that writes operators wants them.
macro_rules! arithmetic {
    ($kind:ident, |$x:ident| $known:expr) => {
        impl<const FLUSH: bool> Arithmetic for $kind<FLUSH> {
            fn known(self) -> Option<Interval> {
                let $x = self;
                $known
            }
            fn sign(self) -> i32 {
                $kind::sign(self)
            }
            arithmetic!(@ $kind, neg(), abs(), sqr(), inverse(), add(o: Self), sub(o: Self), mul(o: Self), div(o: Self),
                addk(m: f32, r: f32), mulk(m: f32, r: f32), scale(k: f32), real(m: f32, r: f32), named(name: Function));
        }
        impl<const FLUSH: bool> Number for $kind<FLUSH> {
            fn constant(value: Interval) -> Self {
                $kind::literal(value)
            }
            fn unary(self, op: Unary) -> Self {
                Arithmetic::unary(self, op)
            }
            fn powi(self, n: i32) -> Self {
                Arithmetic::power(self, n).unwrap_or(Self::literal(Interval::ONE))
            }
            fn binary(self, op: Binary, o: Self) -> Self {
                Arithmetic::binary(self, op, o)
            }
        }
    };
    (@ $kind:ident, $($name:ident($($arg:ident: $type:ty),*)),*) => {
        $(fn $name(self, $($arg: $type),*) -> Self { $kind::$name(self, $($arg),*) })*
    };
}
arithmetic!(Twin, |x| x.constant);

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
