//! Ring operations. Step counts of the rounding bounds refer to the module's introduction.
use super::{Affine, TINY, U, centre_radius};
use crate::Interval;
use std::ops::{Add, Mul, Neg, Sub};

impl<const N: usize> Neg for Affine<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { c: -self.c, a: self.a.map(|v| -v), e: self.e }
    }
}

impl<const N: usize> Affine<N> {
    /// `e` of a sum, where each coefficient is one rounded sum and `sum` their accumulated magnitude.
    ///
    /// True error `E = T + u S`, `T = e_a + e_b`, `S = |c| + |a|_1`. With `t = fl(T)` and `w = fl(S + t)` (at most
    /// `N + 2` sums): `E <= t + u t + u S`, and `fl(t + fl(4u w)) >= (t + 4u w (1-u))(1-u) >= t - u t + 3u (S + t) >= E`.
    /// If `w < 2^-1021` all sums were exact and `E = t`; else `fl(4u w)` loses at most `eta/2 <= u w / 2`.
    #[inline(always)]
    fn sum(c: f64, a: [f64; N], t: f64) -> Self {
        let w = a.iter().fold(c.abs() + t, |s, v| s + v.abs());
        Self::sealed(c, a, t + 4.0 * U * w, w)
    }

    /// `x + k` for an exact number `k`.
    #[must_use]
    #[inline(always)]
    pub fn add_f64(self, k: f64) -> Self {
        let c = self.c + k;
        // One rounding, |error| <= u |c|, and u (e + ...) for the sum below; no eta, as in `sum`.
        let w = c.abs() + self.e;
        Self::sealed(c, self.a, self.e + 4.0 * U * w, w)
    }

    /// `x + k` for any number (or function) in `k`.
    #[must_use]
    #[inline(always)]
    pub fn add_interval(self, k: Interval) -> Self {
        let (m, r) = centre_radius(k);
        self.add_centre_radius(m, r)
    }

    /// `x + k` for any number (or function) with `|k - m| <= r`.
    #[inline(always)]
    pub(crate) fn add_centre_radius(self, m: f64, r: f64) -> Self {
        let c = self.c + m;
        let t = self.e + r;
        let w = c.abs() + t;
        Self::sealed(c, self.a, t + 4.0 * U * w, w)
    }

    /// `x * k` for an exact number `k`: `N + 2` products, each within `u |product| + eta/2`.
    #[must_use]
    #[inline(always)]
    pub fn mul_f64(self, k: f64) -> Self {
        let (c, a, t) = (self.c * k, self.a.map(|v| v * k), self.e * k.abs());
        let w = a.iter().fold(c.abs() + t, |s, v| s + v.abs());
        Self::sealed(c, a, t + 4.0 * U * w + TINY, w)
    }

    /// `x * k` for any number (or function) in `k = m +- r`.
    ///
    /// `x k = m x + d x`, `|d| <= r`, `|x| <= S = |c| + |a|_1 + e`: the error is `|m| e + r S`. Steps, each times
    /// `u S (|m| + r)`: coefficients 1, `S` has `N + 1` sums, then product, sum and the last two sums.
    #[must_use]
    #[inline(always)]
    pub fn mul_interval(self, k: Interval) -> Self {
        let (m, r) = centre_radius(k);
        let s = self.a.iter().fold(self.c.abs() + self.e, |s, v| s + v.abs());
        let size = s * (m.abs() + r);
        let e = self.e * m.abs() + s * r;
        Self::sealed(self.c * m, self.a.map(|v| v * m), e + (N + 16) as f64 * U * size + TINY, size)
    }

    /// `alpha x + d` for any function with values in `d = m +- r`.
    ///
    /// Error `|alpha| e + r`. Steps, each times `u w`, `w = |alpha| (|c| + |a|_1 + e) + |m| + r`: coefficients 2, error 2,
    /// last two sums 2; the rest is slack.
    #[inline(always)]
    pub(super) fn scale_add(self, alpha: f64, d: Interval) -> Self {
        let (m, r) = centre_radius(d);
        let (c, a) = (self.c * alpha + m, self.a.map(|v| v * alpha));
        let t = self.e * alpha.abs() + r;
        let w = a.iter().fold((self.c * alpha).abs() + m.abs() + t, |s, v| s + v.abs());
        Self::sealed(c, a, t + 16.0 * U * w + TINY, w)
    }

    /// `x^2`.
    ///
    /// With `x = c + d`, `|d| <= R = |a|_1 + e`: `x^2 = c^2 + 2c d + d^2`, where `d^2` is in `R^2/2 +- R^2/2` and
    /// `2c d = 2c a.s +- 2|c| e`. Steps, each times `u (|c| + R)^2`: coefficients at most `2N + 3` in all (`R^2/2` has
    /// `2N + 1`), error `2N + 3`, last two sums 2.
    #[must_use]
    #[inline(always)]
    pub fn sqr(self) -> Self {
        let r = self.a.iter().fold(self.e, |s, v| s + v.abs());
        let (c, k, h) = (self.c.abs(), 2.0 * self.c, 0.5 * r * r);
        let size = (c + r) * (c + r);
        let e = h + 2.0 * c * self.e;
        Self::sealed(self.c * self.c + h, self.a.map(|v| k * v), e + (4 * N + 16) as f64 * U * size + TINY, size)
    }

    /// `x^n`; `x^0 = 1` everywhere. Negative `n`: unknown if the range of `x` contains 0.
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
        match n {
            0 => Self::constant(Interval::ONE),
            1 => self,
            2 => self.sqr(),
            -1 => self.recip(),
            _ if n > 0 && f64::from(n) * self.radius() <= 0.5 * self.c.abs() => self.repeated_product(n.unsigned_abs()),
            _ => self.integer_power(n),
        }
    }

    /// `x^n`, `n >= 1`, by squaring: cheap, and over a narrow range as tight (to second order) as one linearisation.
    fn repeated_product(self, n: u32) -> Self {
        // From the highest bit down, so that every factor is x itself.
        (0..n.ilog2()).rev().fold(self, |p, bit| if n >> bit & 1 == 1 { p.sqr() * self } else { p.sqr() })
    }
}

impl<const N: usize> Add for Affine<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        let mut a = self.a;
        for (x, y) in a.iter_mut().zip(o.a) {
            *x += y;
        }
        Self::sum(self.c + o.c, a, self.e + o.e)
    }
}

impl<const N: usize> Sub for Affine<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        let mut a = self.a;
        for (x, y) in a.iter_mut().zip(o.a) {
            *x -= y;
        }
        Self::sum(self.c - o.c, a, self.e + o.e)
    }
}

/// With `x = c_a + A + e_a p`, `y = c_b + B + e_b q`, `A = sum a_i s_i`, `B = sum b_i s_i`, `|p|, |q| <= 1`:
/// `x y = c_a c_b + c_a B + c_b A + A B + (c_a + A) e_b q + (c_b + B) e_a p + e_a e_b p q`.
///
/// `A B = sum a_i b_i s_i^2 + sum_{i<j} (a_i b_j + a_j b_i) s_i s_j`. As `s_i^2 = 1/2 +- 1/2`, the first sum is
/// `Q/2 +- D/2` with `Q = sum a_i b_i`, `D = sum |a_i b_i|`; the second is at most `|a|_1 |b|_1 - D`. So the centre is
/// `c_a c_b + Q/2` and, with `R = |a|_1 + e_a`, `T = |b|_1 + e_b`, the error `R T - D/2 + |c_a| e_b + |c_b| e_a`.
///
/// Steps, each times `u size`, `size = (|c_a| + R)(|c_b| + T)`: error at most `2N + 3` on numbers of sum at most
/// `R T + D/2 + |c_a| e_b + |c_b| e_a <= 3/2 size`, coefficients `N + 2`, last two sums 2: `4N + 9`.
impl<const N: usize> Mul for Affine<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let (mut r, mut t, mut q, mut d) = (self.e, o.e, 0.0, 0.0);
        let mut a = [0.0; N];
        for (i, k) in a.iter_mut().enumerate() {
            let (x, y) = (self.a[i], o.a[i]);
            let w = x * y;
            *k = self.c * y + o.c * x;
            r += x.abs();
            t += y.abs();
            q += w;
            d += w.abs();
        }
        let (ca, cb) = (self.c.abs(), o.c.abs());
        let size = (ca + r) * (cb + t);
        let e = (r * t - 0.5 * d) + (ca * o.e + cb * self.e);
        Self::sealed(self.c * o.c + 0.5 * q, a, e + (4 * N + 16) as f64 * U * size + TINY, size)
    }
}
