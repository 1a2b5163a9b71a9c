//! The least value along a beam: the symbol `s` eliminated from a quadratic form.
use super::{Quadratic, TINY, U, norm, parabola_low};
use crate::Interval;
use crate::affine::LARGE;
use crate::round::{add_up, greater, lesser};

/// A polynomial `c + l_a a + l_b b + q_aa a^2 + q_bb b^2 + q_ab a b` with exactly these coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paraboloid {
    /// Constant coefficient.
    pub c: f64,
    /// Coefficients of `a`, `b`.
    pub l: [f64; 2],
    /// Coefficients of `a^2`, `b^2`, `a b`.
    pub q: [f64; 3],
}

impl Paraboloid {
    /// Lower bound over `[-1, 1]^2`: 8 roundings on numbers of sum `size`.
    #[must_use]
    pub fn lower_bound(&self) -> f64 {
        let size = self.size();
        let low = self.c + parabola_low(self.l[0], self.q[0]) + parabola_low(self.l[1], self.q[1]) - self.q[2].abs();
        low - (16.0 * U * size + TINY)
    }

    /// Lower bound over a part `a x b` of `[-1, 1]^2`.
    ///
    /// With `a = m + r x`, `b = n + s y`, where `[m - r, m + r]` holds the part for all roundings of m and r, each below 2u: a polynomial in
    /// `(x, y)` over the whole square. Its coefficients are sums of terms with at most 5 factors, whose magnitudes add up to at most
    /// `(1 + 8u)^2` times those of this one: less than 32 roundings, all told.
    #[must_use]
    pub fn lower_bound_over(&self, [a, b]: [Interval; 2]) -> f64 {
        let about = |t: Interval| (0.5 * (t.lo() + t.hi()), 0.5 * (t.hi() - t.lo()) + 4.0 * U);
        let ((m, r), (n, s)) = (about(a), about(b));
        let ([la, lb], [aa, bb, ab]) = (self.l, self.q);
        let moved = Self {
            c: self.c + m * (la + aa * m) + n * (lb + bb * n) + ab * m * n,
            l: [r * (la + 2.0 * aa * m + ab * n), s * (lb + 2.0 * bb * n + ab * m)],
            q: [aa * r * r, bb * s * s, ab * r * s],
        };
        moved.lower_bound() - (64.0 * U * self.size() + TINY)
    }

    /// Upper bound over a part `a x b` of `[-1, 1]^2`.
    #[must_use]
    pub fn upper_bound_over(&self, part: [Interval; 2]) -> f64 {
        -self.negated().lower_bound_over(part)
    }

    /// Upper bound over `[-1, 1]^2`.
    #[must_use]
    pub fn upper_bound(&self) -> f64 {
        -self.negated().lower_bound()
    }

    fn negated(&self) -> Self {
        Self { c: -self.c, l: self.l.map(|v| -v), q: self.q.map(|v| -v) }
    }

    /// With `a` and `b` exchanged.
    #[must_use]
    pub const fn transposed(&self) -> Self {
        let ([la, lb], [aa, bb, ab]) = (self.l, self.q);
        Self { c: self.c, l: [lb, la], q: [bb, aa, ab] }
    }

    /// Sum of all magnitudes.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.c.abs() + norm(&self.l) + norm(&self.q)
    }
}

/// Bounds of `m(a, b) = min over s of g(s, a, b)`, and of `g` on one line `s = s(a, b)` in `[-1, 1]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eliminated {
    /// `g(s, a, b) >= lower(a, b) - error` for every `s` in `[-1, 1]`.
    pub lower: Paraboloid,
    /// For every `(a, b)` there is an `s` in `[-1, 1]` with `g(s, a, b) <= upper(a, b) + error`.
    pub upper: Paraboloid,
    /// At least the form's error; infinite if nothing is known.
    pub error: f64,
}

impl Eliminated {
    const UNKNOWN: Self = {
        let zero = Paraboloid { c: 0.0, l: [0.0; 2], q: [0.0; 3] };
        Self { lower: zero, upper: zero, error: f64::INFINITY }
    };

    /// The same if `g` may be lower than it was bounded by `by >= 0`: both bounds half as much lower, with half as much more
    /// error. One rounding, of at most `u` times the rounded difference.
    #[must_use]
    pub fn lowered(self, by: f64) -> Self {
        let half = 0.5 * by;
        let down = |p: Paraboloid| Paraboloid { c: p.c - half, ..p };
        let (lower, upper) = (down(self.lower), down(self.upper));
        let rounding = 2.0 * U * greater(lower.c.abs(), upper.c.abs()) + TINY;
        let error = add_up(add_up(self.error, half), rounding);
        if by < LARGE { Self { lower, upper, error } } else { Self::UNKNOWN }
    }

    /// `g > 0` for every `s`, `a`, `b`.
    #[must_use]
    pub fn certainly_positive(&self) -> bool {
        self.lower.lower_bound() > self.error
    }

    /// For every `(a, b)` there is an `s` with `g < 0`.
    #[must_use]
    pub fn certainly_negative_somewhere(&self) -> bool {
        self.upper.upper_bound() < -self.error
    }
}

impl Quadratic {
    /// The polynomial at a fixed `s`, and the magnitude of all terms: at most 4 roundings times `u` of that.
    fn at(&self, s: f64) -> (Paraboloid, f64) {
        let ([ls, la, lb], [ss, aa, bb, sa, sb, ab]) = (self.l, self.q);
        let curve = s * ls + (s * s) * ss;
        (Paraboloid { c: self.c + curve, l: [la + s * sa, lb + s * sb], q: [aa, bb, ab] }, self.size())
    }

    /// Eliminates `s`, the error of the form included.
    ///
    /// Write `Q = q_ss s^2 + (l_s + q_sa a + q_sb b) s + rest`, `h = q_ss`, `n = l_s + q_sa a + q_sb b`.
    /// 1. For `h > 0`: `Q = h (s + n/(2h))^2 + S`, `S = rest - n^2/(4h)` (the Schur complement), so `Q >= S` everywhere, and
    ///    if `|n| <= 2h` on all `(a, b)`, `S` is attained at `s = -n/(2h)`: both bounds.
    /// 2. If `n >= 2|h|` on all `(a, b)`, `dQ/ds = 2 h s + n >= 0`: the least value is at `s = -1`; if `n <= -2|h|`, at 1.
    /// 3. Otherwise below: `S` if `h` is positive enough, else `rest - max(-h, 0) - max |n|`; above: `Q` at any fixed `s`.
    ///
    /// Rounding: `n^2/(4h)` is expanded with the ratios `l_s/(4h)` etc., of which none exceeds 250 where it is used; each
    /// of its terms is off by 3 roundings, their magnitudes are added to `size`. At most 12 roundings in a coefficient.
    #[must_use]
    pub fn eliminate(&self) -> Eliminated {
        if !self.is_known() {
            return Eliminated::UNKNOWN;
        }
        let ([ls, la, lb], [h, aa, bb, sa, sb, ab]) = (self.l, self.q);
        let mixed = sa.abs() + sb.abs();
        // Comparisons of sums of three numbers: their roundings are given away.
        let reach = (ls.abs() + mixed) * (1.0 + 8.0 * U);
        let least = ls.abs() * (1.0 - 8.0 * U) - mixed * (1.0 + 8.0 * U);
        let schur = || {
            let quarter = 0.25 / h;
            let (rl, ra, rb) = (ls * quarter, sa * quarter, sb * quarter);
            let lower = Paraboloid {
                c: self.c - ls * rl,
                l: [la - 2.0 * ls * ra, lb - 2.0 * ls * rb],
                q: [aa - sa * ra, bb - sb * rb, ab - 2.0 * sa * rb],
            };
            let moved = reach * (reach * quarter);
            (lower, self.size() + moved)
        };
        let (lower, upper, size) = if h > 0.0 && reach <= 2.0 * h {
            let (m, size) = schur();
            (m, m, size)
        } else if least >= 2.0 * h.abs() && least > 0.0 {
            let (m, size) = self.at(if ls > 0.0 { -1.0 } else { 1.0 });
            (m, m, size)
        } else if h > 1e-3 * reach {
            let (m, size) = schur();
            let s = lesser(greater(-0.5 * ls / h, -1.0), 1.0);
            (m, self.at(s).0, size)
        } else {
            let (mut m, size) = self.at(0.0);
            m.c -= if h < 0.0 { -h } else { 0.0 } + reach;
            (m, self.at(if ls > 0.0 { -1.0 } else { 1.0 }).0, size + reach)
        };
        // An upper bound for an end of a concave parabola may be the worse one: still a value at some s.
        let error = self.e + (48.0 * U * size + TINY);
        if size < LARGE { Eliminated { lower, upper, error } } else { Eliminated::UNKNOWN }
    }

    /// `self - factor * paraboloid(a, b)`, the paraboloid having the error `e`.
    ///
    /// 2 roundings per coefficient.
    #[must_use]
    pub fn minus(&self, factor: f64, p: &Paraboloid, e: f64) -> Self {
        let ([ls, la, lb], [ss, aa, bb, sa, sb, ab]) = (self.l, self.q);
        let size = self.size() + factor.abs() * (p.size() + e);
        let l = [ls, la - factor * p.l[0], lb - factor * p.l[1]];
        let q = [ss, aa - factor * p.q[0], bb - factor * p.q[1], sa, sb, ab - factor * p.q[2]];
        let error = self.e + factor.abs() * e + (16.0 * U * size + TINY);
        Self::sealed(self.c - factor * p.c, l, q, error, size)
    }
}
