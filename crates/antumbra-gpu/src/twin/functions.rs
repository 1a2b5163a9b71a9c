//! The arithmetic of `functions.wgsl`, operation by operation.
#![allow(clippy::approx_constant, clippy::excessive_precision, reason = "the literals of the kernels")]
use super::{R, Twin, TwinSlope, U, b_mul, reciprocal};
use std::cell::Cell;

thread_local! {
    /// `lost` of the kernels.
    static LOST: Cell<bool> = const { Cell::new(false) };
}

/// Whether anything was lost since the last question.
pub(crate) fn take_lost() -> bool {
    LOST.replace(false)
}

fn lose_unless(fine: bool) {
    LOST.set(LOST.get() || !fine);
}

const SMALL: f32 = 8.673_617_4e-19;
const LARGE: f32 = 1.152_921_5e18;
const POLE: f32 = 9.536_743e-7;
const SLACK: f32 = 1.00001;

/// A number and what it may be off by.
pub(crate) type Ball<const FLUSH: bool> = [R<FLUSH>; 2];

/// `b_recip`.
pub(crate) fn recip<const FLUSH: bool>(c: R<FLUSH>) -> Ball<FLUSH> {
    let q = reciprocal(c);
    let d = (R(1.0) - q * c).abs() + R(1.5 * U);
    lose_unless(d.0 < 0.001);
    [q, (q.abs() * d) * 1.01]
}

/// `b_sqrt`.
pub(crate) fn sqrt<const FLUSH: bool>(c: R<FLUSH>) -> Ball<FLUSH> {
    if c.0 < SMALL {
        return [R(0.0), R(9.4e-10)];
    }
    let mut y = R(f32::from_bits(0x5f37_59df_u32.wrapping_sub(c.0.to_bits() >> 1)));
    let h = R(0.5 * c.0);
    for _ in 0..3 {
        y = y * (R(1.5) - (h * y) * y);
    }
    let q = c * y;
    lose_unless(y.0 > 0.0 && (q * y).0 > 0.995);
    let m = q * q;
    let d = (c - m).abs() + m * (1.5 * U);
    [q, (d * y) * 1.02]
}

/// `b_exp`.
pub(crate) fn exp<const FLUSH: bool>(c: R<FLUSH>) -> Ball<FLUSH> {
    if c.0 < -60.0 {
        return [R(0.0), R(1e-26)];
    }
    let k = R((c * R(1.442_695) + R(0.5)).0.floor());
    let r = (c - k * R(0.693_359_4)) - k * R(-2.121_944_4e-4);
    if !(r.0.abs() <= 0.36 && k.0.abs() < 100.0) {
        lose_unless(false);
        return [R(1.0), R::FLOOR];
    }
    let terms = [1.388_888_9e-3, 8.333_333_8e-3, 4.166_666_7e-2, 0.166_666_67, 0.5, 1.0, 1.0];
    let p = terms.iter().fold(R(1.984_127e-4), |p, t| r * p + R(*t));
    let scale = R(f32::from_bits(((k.0 as i32 + 127) as u32) << 23));
    [p * scale, R(4.0 * U) * scale]
}

/// `b_ln`.
pub(crate) fn ln<const FLUSH: bool>(c: R<FLUSH>) -> Ball<FLUSH> {
    let bits = c.0.to_bits();
    let mut k = R(((bits >> 23) as i32 - 127) as f32);
    let mut m = R(f32::from_bits(bits & 0x7f_ffff | 0x3f80_0000));
    if m.0 > 1.414_213_5 {
        (m, k) = (R(0.5 * m.0), R(k.0 + 1.0));
    }
    let d = m - R(1.0);
    let q = recip(m + R(1.0));
    let s = d * q[0];
    let off = R(2.2 * U) * s.abs() + R(1.02) * (d.abs() * q[1]);
    let z = s * s;
    let p = [0.285_714_3, 0.4, 0.666_666_7].iter().fold(R(0.222_222_22), |p, t| z * p + R(*t));
    let y = R(2.0 * s.0) + s * (z * p);
    let l = k * R(0.693_359_4) + (k * R(-2.121_944_4e-4) + y);
    let size = (l.abs() + R(2.0 * y.0.abs())) + (R(0.001) * k.abs() + R(0.1));
    [l, R(SLACK) * (R(2.2) * off + R(U) * size)]
}

/// `b_wave`: sine, cosine, error.
pub(crate) fn wave<const FLUSH: bool>(c: R<FLUSH>) -> [R<FLUSH>; 3] {
    let k = R((c * R(0.636_619_75) + R(0.5)).0.floor());
    let r = ((c - k * R(1.570_312_5)) - k * R(4.837_513e-4)) - k * R(7.549_79e-8);
    if !(r.0.abs() <= 0.8 && k.0.abs() < 2000.0) {
        lose_unless(false);
        return [R(0.0), R(0.0), R(1.0)];
    }
    let z = r * r;
    let p = [-1.984_127e-4, 8.333_333_8e-3, -0.166_666_67].iter().fold(R(2.755_731_9e-6), |p, t| z * p + R(*t));
    let s = r + r * (z * p);
    let o = [-1.388_888_9e-3, 4.166_666_7e-2, -0.5].iter().fold(R(2.480_158_7e-5), |o, t| z * o + R(*t));
    let w = R(1.0) + z * o;
    let e = if k.0 == 0.0 { R(2.5 * U) } else { R(U) * (R(5.0) + R(0.0011) * k.abs()) };
    match k.0 as i32 & 3 {
        0 => [s, w, e],
        1 => [w, -s, e],
        2 => [-s, -w, e],
        _ => [-w, s, e],
    }
}

fn between<const FLUSH: bool>(a: R<FLUSH>, b: R<FLUSH>) -> Twin<FLUSH> {
    let e = R(0.5) * (b - a) + R(3.0 * U) * (a.abs() + b.abs());
    Twin::new(R(0.5) * (a + b), R(SLACK) * e + R::FLOOR, [R(0.0); 3])
}

fn exp_between<const FLUSH: bool>(a: R<FLUSH>, b: R<FLUSH>) -> Twin<FLUSH> {
    let (lo, hi) = (exp(a), exp(b));
    between(R((lo[0] - lo[1]).0.max(0.0)), hi[0] + hi[1])
}

fn unknown<const FLUSH: bool>() -> Twin<FLUSH> {
    Twin::new(R(0.0), R(1.0), [R(0.0); 3])
}

fn lost<const FLUSH: bool>() -> Twin<FLUSH> {
    lose_unless(false);
    Twin::new(R(1.0), R::FLOOR, [R(0.0); 3])
}

/// A quarter turn on.
const SINE: usize = 0;
const COSINE: usize = 1;

impl<const FLUSH: bool> Twin<FLUSH> {
    fn line(self, r: R<FLUSH>, m: R<FLUSH>, k: R<FLUSH>, err: R<FLUSH>) -> Self {
        let w = k.abs();
        let e = (w * self.e + (R(2.0 * U) * w) * r) + (err + R(2.0 * U) * m.abs());
        Self::new(m, R(SLACK) * e + R::FLOOR, self.a.map(|v| v * k))
    }

    fn ends(self, r: R<FLUSH>) -> [R<FLUSH>; 2] {
        let s = r + R(4.0 * U) * (self.c.abs() + r);
        [self.c - s, self.c + s]
    }

    fn recip(self) -> Self {
        let x = if self.c.0 < 0.0 { self.neg() } else { self };
        let r = x.radius();
        let ends = x.ends(r);
        if !(ends[0].0 >= POLE && ends[1].0 <= LARGE) {
            return lost();
        }
        let (q, j) = (recip(x.c), recip(ends[0]));
        let t = r * q[0];
        let h = R(0.5 * SLACK) * ((t * t) * j[0]);
        let k = q[0] * q[0];
        let off = R(2.01) * (q[0] * q[1]) + R(U) * k;
        let f = x.line(r, q[0] + h, -k, (h + q[1]) + off * r);
        if self.c.0 < 0.0 { f.neg() } else { f }
    }

    fn sqrt(self) -> Self {
        let r = self.radius();
        let top = self.ends(r)[1];
        if top.0.is_nan() || top.0 > LARGE {
            return lost();
        }
        if top.0 <= 0.0 {
            return Self::new(R(0.0), R::FLOOR, [R(0.0); 3]);
        }
        if self.c.0 < SMALL || r.0 > self.c.0 {
            let b = sqrt(top);
            return between(R(0.0), b[0] + b[1]);
        }
        let s = sqrt(self.c);
        let j = recip(s[0]);
        let t = R(((r * j[0]) * (j[0] * R(SLACK))).0.min(1.0));
        let w = (r * j[0]) * (R(0.5) * (R(1.0) + t));
        let h = R(0.25 * SLACK) * ((w * w) * j[0]);
        let k = R(0.5 * j[0].0);
        let off = R(0.5 * j[1].0) + R(1.01) * (k * (s[1] * j[0]));
        self.line(r, s[0] - h, k, (h + s[1]) + off * r)
    }

    fn exp(self) -> Self {
        let r = self.radius();
        let ends = self.ends(r);
        if ends[1].0.is_nan() || ends[1].0 > 20.0 {
            return lost();
        }
        if r.0 > 1.5 {
            return exp_between(ends[0], ends[1]);
        }
        let b = exp(self.c);
        let q = r * r;
        let g = q * (R(1.0) + (R(0.333_333_34) * r + R(0.125) * q));
        let h = R(0.25 * SLACK) * ((b[0] + b[1]) * g);
        self.line(r, b[0] + h, b[0], h + b[1] * (R(1.0) + r))
    }

    fn ln(self) -> Self {
        let r = self.radius();
        let ends = self.ends(r);
        if !(ends[0].0 >= SMALL && ends[1].0 <= LARGE) {
            return lost();
        }
        if r.0 > 0.7 * self.c.0 {
            let (a, b) = (ln(ends[0]), ln(ends[1]));
            return between(a[0] - a[1], b[0] + b[1]);
        }
        let (l, k, j) = (ln(self.c), recip(self.c), recip(ends[0]));
        let z = r * j[0];
        let h = R(0.25 * SLACK) * (z * z);
        self.line(r, l[0] - h, k[0], (h + l[1]) + k[1] * r)
    }

    fn wave(self, part: usize) -> Self {
        let r = self.radius();
        if !(r.0 <= 1.6 && self.c.0.abs() <= 1000.0) {
            return unknown();
        }
        let w = wave(self.c);
        let (v, d, e) = if part == SINE { (w[0], w[1], w[2]) } else { (w[1], -w[0], w[2]) };
        let s = R(SLACK) * (e + R(0.333_333_34) * r);
        let q = R(0.5 * SLACK) * (r * r);
        let p = R((v + s).0.clamp(0.0, 1.0)) * q;
        let n = R((s - v).0.clamp(0.0, 1.0)) * q;
        let m = v + R(0.5) * (n - p);
        let h = R(0.5) * (n + p);
        self.line(r, m, d, (h + R(2.0 * U) * (n + p)) + e * (R(1.0) + r))
    }

    fn sinh(self) -> Self {
        self.exp().sub(self.neg().exp()).scale(0.5)
    }

    fn cosh(self) -> Self {
        self.exp().add(self.neg().exp()).scale(0.5)
    }

    pub(super) fn div(self, o: Self) -> Self {
        self.mul(o.recip())
    }

    /// `f_recip`, for negative powers.
    pub(super) fn inverse(self) -> Self {
        self.recip()
    }

    /// `f_real`.
    pub(super) fn real(self, m: f32, r: f32) -> Self {
        let ends = self.ends(self.radius());
        if ends[0].0 >= SMALL {
            return self.ln().mulk(m, r).exp();
        }
        if ends[1].0.is_nan() || ends[1].0 > LARGE {
            return lost();
        }
        let z = b_mul(ln(R(ends[1].0.max(SMALL))), [R(m), R(r)]);
        let top = Self::new(z[0], z[1], [R(0.0); 3]).exp();
        between(R(0.0), top.c + top.e)
    }

    /// The function, by its name in the kernels.
    pub(super) fn named(self, name: Function) -> Self {
        match name {
            Function::Sqrt => self.sqrt(),
            Function::Exp => self.exp(),
            Function::Ln => self.ln(),
            Function::Sin => self.wave(SINE),
            Function::Cos => self.wave(COSINE),
            Function::Sinh => self.sinh(),
            Function::Cosh => self.cosh(),
        }
    }
}

/// Functions that the kernels have.
#[derive(Clone, Copy)]
pub(super) enum Function {
    Sqrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Sinh,
    Cosh,
}

impl<const FLUSH: bool> TwinSlope<FLUSH> {
    fn apex(self) -> Twin<FLUSH> {
        Twin::new(self.p[0], self.p[1], [R(0.0); 3])
    }

    fn middle(self) -> Twin<FLUSH> {
        self.v.addk(self.p[0].0, self.p[1].0).scale(0.5)
    }

    fn step(self) -> R<FLUSH> {
        R(SLACK) * (((self.v.c - self.p[0]).abs() + self.v.radius()) + self.p[1])
    }

    fn with(self, h: impl Fn(Twin<FLUSH>) -> Twin<FLUSH>, mean: Twin<FLUSH>) -> Self {
        Self { p: ball(h(self.apex())), v: h(self.v), g: self.g.mul(mean) }
    }

    pub(super) fn div(self, o: Self) -> Self {
        let q = b_mul(self.p, ball(o.apex().recip()));
        let w = o.v.recip();
        Self { p: q, v: self.v.mul(w), g: self.g.sub(o.g.mulk(q[0].0, q[1].0)).mul(w) }
    }

    pub(super) fn inverse(self) -> Self {
        let one = Twin::new(R(1.0), R::FLOOR, [R(0.0); 3]);
        let none = Twin::new(R(0.0), R::FLOOR, [R(0.0); 3]);
        Self { p: [R(1.0), R::FLOOR], v: one, g: none }.div(self)
    }

    fn sqrt(self) -> Self {
        let (p, v) = (ball(self.apex().sqrt()), self.v.sqrt());
        Self { p, v, g: self.g.mul(v.addk(p[0].0, p[1].0).recip()) }
    }

    fn exp(self) -> Self {
        let d = self.step();
        let mean = if d.0 <= 1.5 {
            let w = R(0.022) * (d * d);
            self.middle().exp().mulk((R(1.0) + w).0, (w + R(2.0 * U)).0)
        } else {
            let (v, p) = (self.v.ends(self.v.radius()), self.apex().ends(self.p[1]));
            let (lo, hi) = (R(v[0].0.min(p[0].0)), R(v[1].0.max(p[1].0)));
            if hi.0 <= 20.0 { exp_between(lo, hi) } else { lost() }
        };
        self.with(Twin::exp, mean)
    }

    fn ln(self) -> Self {
        let d = self.step();
        let lo = R(self.v.ends(self.v.radius())[0].0.min(self.apex().ends(self.p[1])[0].0));
        let mean = if lo.0 >= POLE && lo.0 <= LARGE {
            let j = recip(lo);
            let t = d * j[0];
            if t.0 <= 1.0 {
                let w = R(0.042) * ((t * t) * j[0]);
                self.middle().recip().addk(w.0, w.0)
            } else {
                between(R(0.0), R(SLACK) * j[0])
            }
        } else {
            lost()
        };
        self.with(Twin::ln, mean)
    }

    fn wave(self, part: usize) -> Self {
        let d = self.step();
        let f = self.middle().wave(1 - part);
        let wide = if d.0 > 4.0 { unknown() } else { Twin::new(f.c, f.e + R(0.042) * (d * d), f.a) };
        self.with(|f| f.wave(part), if part == SINE { wide } else { wide.neg() })
    }

    pub(super) fn real(self, m: f32, r: f32) -> Self {
        self.ln().mulk(m, r).exp()
    }

    /// The function, by its name in the kernels.
    pub(super) fn named(self, name: Function) -> Self {
        match name {
            Function::Sqrt => self.sqrt(),
            Function::Exp => self.exp(),
            Function::Ln => self.ln(),
            Function::Sin => self.wave(SINE),
            Function::Cos => self.wave(COSINE),
            Function::Sinh => self.exp().sub(self.neg().exp()).scale(0.5),
            Function::Cosh => self.exp().add(self.neg().exp()).scale(0.5),
        }
    }
}

fn ball<const FLUSH: bool>(x: Twin<FLUSH>) -> Ball<FLUSH> {
    [x.c, x.radius()]
}
