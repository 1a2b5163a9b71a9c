//! Ring operations on quadratic forms.
use super::{Quadratic, TINY, U, centre_radius, norm};
use crate::Interval;
use crate::affine::Affine;
use std::ops::{Add, Mul, Neg, Sub};

/// Pairs of symbols `i < j` with the index of their mixed term.
pub(crate) const PAIRS: [(usize, usize, usize); 3] = [(0, 1, 3), (0, 2, 4), (1, 2, 5)];

/// Rounding steps of a product, see [`Mul`].
pub(crate) const PRODUCT: f64 = 64.0 * U;

impl Neg for Quadratic {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { c: -self.c, l: self.l.map(|v| -v), q: self.q.map(|v| -v), e: self.e }
    }
}

impl Quadratic {
    /// `e` of a sum, each coefficient being one rounded sum, `t` the rounded sum of the errors: as for affine forms, each
    /// rounding is at most `u` times the rounded coefficient (a subnormal sum is exact).
    #[inline(always)]
    fn sum(c: f64, l: [f64; 3], q: [f64; 6], t: f64) -> Self {
        let w = (c.abs() + norm(&l)) + (norm(&q) + t);
        Self::sealed(c, l, q, t + 4.0 * U * w, w)
    }

    /// `x + k` for any number (or function) in `k`.
    #[must_use]
    #[inline(always)]
    pub fn add_interval(self, k: Interval) -> Self {
        let (m, r) = centre_radius(k);
        let c = self.c + m;
        let t = self.e + r;
        let w = c.abs() + t;
        Self::sealed(c, self.l, self.q, t + 4.0 * U * w, w)
    }

    /// `x k` for an exact number `k`: products within `u |product| + eta/2`.
    #[must_use]
    #[inline(always)]
    pub fn mul_f64(self, k: f64) -> Self {
        let (c, l, q, t) = (self.c * k, self.l.map(|v| v * k), self.q.map(|v| v * k), self.e * k.abs());
        let w = (c.abs() + norm(&l)) + (norm(&q) + t);
        Self::sealed(c, l, q, t + 4.0 * U * w + TINY, w)
    }

    /// `x k` for any number (or function) in `k = m +- r`: `x k = m x + d x`, `|d| <= r`, `|x| <= size`.
    ///
    /// Steps, each times `u size (|m| + r)`: coefficients 1, `size` 11, then product and the last two sums.
    #[must_use]
    #[inline(always)]
    pub fn mul_interval(self, k: Interval) -> Self {
        let (m, r) = centre_radius(k);
        let size = self.size();
        let w = size * (m.abs() + r);
        let e = self.e * m.abs() + size * r;
        Self::sealed(self.c * m, self.l.map(|v| v * m), self.q.map(|v| v * m), e + 24.0 * U * w + TINY, w)
    }

    /// The product of two affine forms: all of degree 2 is kept, so nothing is lost but rounding and the operands' errors.
    ///
    /// Steps, each times `u size`: coefficients at most 3, error 8.
    #[must_use]
    #[inline(always)]
    pub fn product_of(x: &Affine<3>, y: &Affine<3>) -> Self {
        let (a, b) = (x.coefficients(), y.coefficients());
        let (ca, cb) = (x.centre(), y.centre());
        let l = std::array::from_fn(|i| ca * b[i] + cb * a[i]);
        let mut q = [a[0] * b[0], a[1] * b[1], a[2] * b[2], 0.0, 0.0, 0.0];
        for (i, j, m) in PAIRS {
            q[m] = a[i] * b[j] + a[j] * b[i];
        }
        let (mx, my) = (ca.abs() + norm(a), cb.abs() + norm(b));
        let (ex, ey) = (x.error(), y.error());
        let size = (mx + ex) * (my + ey);
        let e = ex * (my + ey) + ey * mx;
        Self::sealed(ca * cb, l, q, e + 16.0 * U * size + TINY, size)
    }

    /// `x^2`.
    ///
    /// As the product, but each pair of equal terms is added once, and the square of the part of degree 2 is in
    /// `[0, |q|^2]`: centre and radius `|q|^2/2`.
    #[must_use]
    #[inline(always)]
    pub fn sqr(self) -> Self {
        let (l, q) = (&self.l, &self.q);
        let k2 = 2.0 * self.c;
        let mut rl: [f64; 3] = std::array::from_fn(|i| k2 * l[i]);
        let mut rq: [f64; 6] = std::array::from_fn(|i| k2 * q[i]);
        let mut cut = 0.0;
        for i in 0..3 {
            rq[i] += l[i] * l[i];
            let k = 2.0 * l[i] * q[i];
            rl[i] += 0.75 * k;
            cut += 0.25 * k.abs();
        }
        for (i, j, m) in PAIRS {
            rq[m] += 2.0 * l[i] * l[j];
            let k = l[i] * q[m] + l[j] * q[i];
            rl[j] += k;
            cut += k.abs();
            let k = l[j] * q[m] + l[i] * q[j];
            rl[i] += k;
            cut += k.abs();
        }
        cut += 2.0 * (l[0] * q[5] + l[1] * q[4] + l[2] * q[3]).abs();
        let nq = norm(q);
        let half = 0.5 * nq * nq;
        let m = self.c.abs() + norm(l) + nq;
        let size = (m + self.e) * (m + self.e);
        let e = cut + half + self.e * (2.0 * m + self.e);
        Self::sealed(self.c * self.c + half, rl, rq, e + PRODUCT * size + TINY, size)
    }

    /// `x^n`. Negative `n`: unknown if the range of `x` contains 0.
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
        match n {
            0 => Self::constant(Interval::ONE),
            1 => self,
            2 => self.sqr(),
            _ if n > 0 => {
                let m = n.unsigned_abs();
                // From the highest bit down, so that every factor is x itself.
                let power =
                    (0..m.ilog2()).rev().fold(self, |p, bit| if m >> bit & 1 == 1 { p.sqr() * self } else { p.sqr() });
                if m < 4 { power } else { power.narrower(self.by_range(|x| x.powi(n))) }
            }
            _ if n > -16 => self.powi(-n).recip().narrower(self.by_range(|x| x.powi(n))),
            _ => self.by_range(|x| x.powi(n)),
        }
    }

    /// The form with the smaller error, the second one if they are equal.
    #[must_use]
    pub(super) fn narrower(self, o: Self) -> Self {
        if self.e < o.e { self } else { o }
    }
}

impl Add for Quadratic {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        let l = std::array::from_fn(|i| self.l[i] + o.l[i]);
        let q = std::array::from_fn(|i| self.q[i] + o.q[i]);
        Self::sum(self.c + o.c, l, q, self.e + o.e)
    }
}

impl Sub for Quadratic {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        let l = std::array::from_fn(|i| self.l[i] - o.l[i]);
        let q = std::array::from_fn(|i| self.q[i] - o.q[i]);
        Self::sum(self.c - o.c, l, q, self.e + o.e)
    }
}

/// With `x = c + L + Q + e p` and `y = c' + L' + Q' + e' p'`, `|p|, |p'| <= 1`: degrees up to 2 of the product of the
/// polynomials are kept. The rest is replaced by its best approximation of lower degree on `[-1, 1]` (economisation):
/// - degree 3: `x_i^3 = 3/4 x_i +- 1/4` (the Chebyshev polynomial `4x^3 - 3x` is within 1); `x_i^2 x_j = x_j/2 +- 1/2`
///   (`x_i^2` is in `1/2 +- 1/2`); `s a b` is within 1;
/// - degree 4: `Q Q'` is within `|q| |q'|` (sums of the magnitudes).
///
/// Errors: `e (|y| + e') + e' |x|`, magnitudes of the polynomials. Steps, each times `u size`, `size = (|x| + e)(|y| + e')`:
/// every product of two coefficients is added with weights of sum at most 1 to one coefficient and to the error; at most
/// 16 roundings in a coefficient, 40 in the error and 12 in `size`. Below 120 underflows of `eta/2`: covered by `2^-1022`.
impl Mul for Quadratic {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let (x, y) = (&self, &o);
        let (xl, yl, xq, yq) = (&x.l, &y.l, &x.q, &y.q);
        let mut l: [f64; 3] = std::array::from_fn(|i| x.c * yl[i] + y.c * xl[i]);
        let mut q: [f64; 6] = std::array::from_fn(|i| x.c * yq[i] + y.c * xq[i]);
        let mut cut = 0.0;
        for i in 0..3 {
            q[i] += xl[i] * yl[i];
            let k = xl[i] * yq[i] + yl[i] * xq[i];
            l[i] += 0.75 * k;
            cut += 0.25 * k.abs();
        }
        for (i, j, m) in PAIRS {
            q[m] += xl[i] * yl[j] + xl[j] * yl[i];
            // x_i^2 x_j
            let k = (xl[i] * yq[m] + yl[i] * xq[m]) + (xl[j] * yq[i] + yl[j] * xq[i]);
            l[j] += 0.5 * k;
            cut += 0.5 * k.abs();
            let k = (xl[j] * yq[m] + yl[j] * xq[m]) + (xl[i] * yq[j] + yl[i] * xq[j]);
            l[i] += 0.5 * k;
            cut += 0.5 * k.abs();
        }
        cut +=
            ((xl[0] * yq[5] + yl[0] * xq[5]) + (xl[1] * yq[4] + yl[1] * xq[4]) + (xl[2] * yq[3] + yl[2] * xq[3])).abs();
        let (nxq, nyq) = (norm(xq), norm(yq));
        let mx = x.c.abs() + norm(xl) + nxq;
        let my = y.c.abs() + norm(yl) + nyq;
        let size = (mx + x.e) * (my + y.e);
        let e = cut + nxq * nyq + (x.e * (my + y.e) + y.e * mx);
        Self::sealed(x.c * y.c, l, q, e + PRODUCT * size + TINY, size)
    }
}
