//! Choices: minimum, maximum, absolute value, sign, floor.
use super::{
    Affine, TINY, U,
    curve::narrower,
    greater, lesser,
    point::{bounds, exact},
};
use crate::Interval;

impl<const N: usize> Affine<N> {
    /// The larger of `x` and `y`.
    ///
    /// Write `x = A +- e_a`, `y = B +- e_b`, and let `[d, D]` be the range of the plane `A - B`. For any weight `w` in
    /// `[0, 1]` and `M = w A + (1-w) B`:
    /// - `max(x, y) >= w x + (1-w) y >= M - L`, `L = w e_a + (1-w) e_b`;
    /// - `max(x, y) <= max(A + e_a, B + e_b) = M + max((1-w)(A - B) + e_a, e_b - w (A - B)) <= M + H`,
    ///   `H = max((1-w) D + e_a, e_b - w d)`.
    ///
    /// So the form is `M + (H - L)/2 +- (H + L)/2`. `H + L` is convex and piecewise linear in `w`; the slope is
    /// `-D + e_a - e_b` before the kink `w = (D + e_a - e_b)/(D - d)` and `-d + e_a - e_b` after it, which tells where it
    /// is least. If `d >= e_b - e_a` then `w = 1`, `H = L = e_a`: the result is `x`; likewise `y` if `-D >= e_a - e_b`.
    #[must_use]
    pub fn max(self, o: Self) -> Self {
        let (mut r, mut size) = (0.0, self.c.abs() + o.c.abs() + (self.e + o.e));
        for i in 0..N {
            r += (self.a[i] - o.a[i]).abs();
            size += self.a[i].abs() + o.a[i].abs();
        }
        let centre = self.c - o.c;
        let (lo, hi, tilt) = (centre - r, centre + r, self.e - o.e);
        let slack = Self::CHOICE * size + TINY;
        if lo + tilt >= slack {
            return Self::sealed(self.c, self.a, self.e, size);
        }
        if -hi - tilt >= slack {
            return Self::sealed(o.c, o.a, o.e, size);
        }
        // Any weight is sound; NaN (0/0) becomes 1.
        let kink = (hi + tilt) / (hi - lo);
        let w = if tilt >= hi {
            0.0
        } else if tilt <= lo || kink.is_nan() {
            1.0
        } else {
            lesser(greater(kink, 0.0), 1.0)
        };
        let above = greater((1.0 - w) * hi + self.e, o.e - w * lo);
        let below = w * self.e + (1.0 - w) * o.e;
        let mut a = o.a;
        for (b, x) in a.iter_mut().zip(self.a) {
            *b += w * (x - *b);
        }
        let c = (o.c + w * centre) + 0.5 * (above - below);
        Self::sealed(c, a, 0.5 * (above + below) + slack, size)
    }

    /// Rounding steps of [`Affine::max`] and [`Affine::between`], times `u size`, `size = sum of all magnitudes`: `d`, `D`
    /// `N + 2`; `H` 3 more; `L` 3; `M` 3; centre and error 2 each. `H` and `L` enter centre and error by halves:
    /// `(N + 8) + 3 + 4`; the comparisons against 0 have `N + 4`.
    pub(crate) const CHOICE: f64 = (2 * N + 24) as f64 * U;

    /// The smaller of `x` and `y`: `-max(-x, -y)`.
    #[must_use]
    pub fn min(self, o: Self) -> Self {
        -(-self).max(-o)
    }

    /// Some function that lies between `x` and `y` at every point.
    ///
    /// `t x + (1-t) y`, `t` in `[0, 1]`, differs from `(A + B)/2 + (t - 1/2)(A - B)` by at most `max(e_a, e_b)`, and that
    /// from `(A + B)/2` by at most `|A - B|/2`.
    pub(crate) fn between(self, o: Self) -> Self {
        let (mut a, mut r) = ([0.0; N], (self.c - o.c).abs());
        let mut size = self.c.abs() + o.c.abs() + (self.e + o.e);
        for (i, k) in a.iter_mut().enumerate() {
            let (x, y) = (self.a[i], o.a[i]);
            *k = 0.5 * x + 0.5 * y;
            r += (x - y).abs();
            size += x.abs() + y.abs();
        }
        let e = greater(self.e, o.e) + 0.5 * r;
        Self::sealed(0.5 * self.c + 0.5 * o.c, a, e + (Self::CHOICE * size + TINY), size)
    }

    /// `|x|`.
    ///
    /// Where `x` in `[l, u]` changes sign: `|x| - w x`, `|w| <= 1`, is in `[0, max((1-w) u, -(1+w) l)]`, least for
    /// `w = (u + l)/(u - l)`.
    #[must_use]
    pub fn abs(self) -> Self {
        let x = self.range();
        let (l, u) = (x.lo(), x.hi());
        if l >= 0.0 {
            return self;
        }
        if u <= 0.0 {
            return -self;
        }
        let w = lesser(greater((u + l) / (u - l), -1.0), 1.0);
        let (at_l, at_u) = (exact(-l) - exact(w) * exact(l), exact(u) - exact(w) * exact(u));
        narrower(self.scale_add(w, bounds(0.0, greater(at_l.hi(), at_u.hi()))), Self::constant(x.abs()))
    }

    /// -1, 0 or 1.
    #[must_use]
    pub fn sign(self) -> Self {
        let x = self.range();
        let of = |v: f64| f64::from(i8::from(v > 0.0) - i8::from(v < 0.0));
        Self::constant(bounds(of(x.lo()), of(x.hi())))
    }

    /// Largest integer `<= x`: constant, or within `[-1, 0]` of `x`.
    #[must_use]
    pub fn floor(self) -> Self {
        let x = self.range();
        narrower(self.scale_add(1.0, Interval::new(-1.0, 0.0)), Self::constant(bounds(x.lo().floor(), x.hi().floor())))
    }
}
