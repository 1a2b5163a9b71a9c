//! Where a quadratic form is 0 along symbol `s`: on one line of fixed `a` and `b`, or on all of them.
use super::{Quadratic, TINY, U};
use crate::Interval;
use crate::affine::{LARGE, centre_radius};

/// Where along `s` a function is 0 on one line, on which it runs from one sign to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zero {
    /// Contains every zero on the line; if the function is continuous there, it holds one.
    pub at: Interval,
    /// Whether the function is negative before and positive behind; else it is positive before and negative behind.
    pub rises: bool,
}

/// Where along `s` a function may be 0 that has the same sign before and behind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// At values of `s` outside of these, the function has that one sign, whatever `a` and `b` are. Empty if it has it everywhere.
    pub zeros: Interval,
    /// The sign is positive; else it is negative.
    pub positive: bool,
}

/// Steps of Newton's method to a place that is good enough: each about squares the distance.
const STEPS: usize = 3;

impl Quadratic {
    /// The zeros of the function along `s` in `[-1, 1]` for one `a` and one `b`, of which all is known that they lie in these
    /// intervals and in `[-1, 1]`: `None` unless the form proves that the function has opposite signs at `s = -1` and `s = 1`, and
    /// varies mostly with `s`.
    ///
    /// With `A(s) = A_0 + A_1 s + A_2 s^2` the polynomial on the line, the function is `A + d`, `|d| <= e`. For any `z` in `[-1, 1]`
    /// `A(s) - A(z) = (s - z)(A_1 + A_2 (s + z))`, and if `A_1 > 0` the last factor is at least `D = A_1 - 2 |A_2|`. Let `D > 0`
    /// and `r = (|A(z)| + e)/D`. Then for `s < z - r` in `[-1, 1]` `A(s) < A(z) - r D <= -e`: the function is negative, and so it
    /// is positive for `s > z + r`. If `-1 < z - r` and `z + r < 1`, both signs occur, so a continuous function has a zero, and
    /// any function has its zeros within `r` of `z`. For `A_1 < 0` the same holds of the negative function.
    ///
    /// Rounding: `A_0`, `A_1` and `A(z)` are sums of at most 9 products of numbers of magnitude at most 1 with coefficients of sum
    /// `size`: within `40 u size`, underflow in `TINY`. A place that is known up to `d` changes `A_0` by at most `2 d size` and `A_1` by
    /// `d size`, which makes up to `3 d size` in `A(z)`.
    #[must_use]
    pub fn zero_along(&self, a: Interval, b: Interval) -> Option<Zero> {
        let ((a, da), (b, db)) = (centre_radius(a), centre_radius(b));
        let ([ls, la, lb], [ss, aa, bb, sa, sb, ab]) = (self.l, self.q);
        let size = self.size();
        if !(size < LARGE && a.abs() <= 1.0 && b.abs() <= 1.0) {
            return None;
        }
        let slack = (64.0 * U + 4.0 * (da + db)) * size + TINY;
        let (a1, a2) = (ls + sa * a + sb * b, ss);
        let a0 = self.c + a * (la + aa * a + ab * b) + b * (lb + bb * b);
        let least = a1.abs() - 2.0 * a2.abs() - slack;
        if least.is_nan() || least <= 0.0 {
            return None;
        }
        let mut z = -a0 / a1;
        for _ in 1..STEPS {
            // At least `least` in magnitude where z is in [-1, 1].
            let slope = a1 + 2.0 * a2 * z;
            z -= (a0 + z * (a1 + a2 * z)) / slope;
        }
        if z.is_nan() || z.abs() > 1.0 {
            return None;
        }
        let value = a0 + z * (a1 + a2 * z);
        // One quotient, one sum: the factor is at least 1 + 8u.
        let r = (value.abs() + self.e + slack) / least * (1.0 + 16.0 * U) + TINY;
        let (lo, hi) = ((z - r).next_down(), (z + r).next_up());
        (lo > -1.0 && hi < 1.0).then(|| Zero { at: Interval::new(lo, hi), rises: a1 > 0.0 })
    }

    /// Where the function may be 0 if it bends along `s`: none where it does not.
    ///
    /// Let `h = q_ss > 0`. With `R` the sum of the magnitudes of all terms but those in `s` and `s^2` alone, and of `e` (squares of
    /// `a` and `b` count only if they are negative), a value that is not positive has `h s^2 + l_s s + c <= R`, that is
    /// `(s + n)^2 <= n^2 + (R - c)/h`, `n = l_s/(2h)`. For `h < 0` the same holds of the negative function. Intervals take the rounding.
    #[must_use]
    pub fn turn(&self) -> Option<Turn> {
        if !self.is_known() || self.q[0] == 0.0 {
            return None;
        }
        let positive = self.q[0] > 0.0;
        let up = if positive { *self } else { -*self };
        let ([ls, la, lb], [h, aa, bb, sa, sb, ab]) = (up.l, up.q);
        let lowest = |q: f64| if q < 0.0 { -q } else { 0.0 };
        let others = [la.abs(), lb.abs(), sa.abs(), sb.abs(), ab.abs(), lowest(aa), lowest(bb), up.e];
        let rest = others.into_iter().fold(Interval::ZERO, |sum, x| sum + Interval::point(x));
        let [l, h, c] = [ls, h, up.c].map(Interval::point);
        let n = l / (h + h);
        let reach = (n.sqr() + (rest - c) / h).sqrt();
        let zeros = (-n + reach).hull(-n - reach).intersection(Interval::new(-1.0, 1.0));
        Some(Turn { zeros, positive })
    }
}
