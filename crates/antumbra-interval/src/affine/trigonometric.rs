//! Sine, cosine, tangent: cut at the points of inflection, multiples of pi/2, each known to lie between two floats.
use super::{
    Affine,
    curve::{Bend, Curve, Fit, Formula, Pieces, finite_range},
    lesser,
    nonlinear::HALF_PI,
    point,
    point::exact,
};
use crate::Interval;
use std::f64::consts::FRAC_PI_2;

/// Beyond this the pieces are not worth their cost.
const FARTHEST: f64 = 1e9;

/// `j pi / 2`.
fn quarter(j: i64) -> Interval {
    exact(j as f64) * HALF_PI
}

/// Sine (`shift = 0`) and cosine (`shift = 1`): inflections at `j pi/2`, `j + shift` even.
struct Wave {
    shift: i64,
}

impl Wave {
    /// About the last inflection before or at `x`.
    fn inflection_before(&self, x: f64) -> i64 {
        let j = (x / FRAC_PI_2).floor() as i64;
        j - (j + self.shift).rem_euclid(2)
    }

    /// Between the inflections `j` and `j + 2`: `sin(j pi/2 + y) = +- sin y` resp. `cos(..) = +- sin y`, `y` in `[0, pi]`.
    fn bend_after(&self, j: i64) -> Bend {
        if (j + self.shift).rem_euclid(4) == 0 { Bend::Concave } else { Bend::Convex }
    }

    /// The range cut at its inflections, unless there are more than two.
    fn pieces(&self, (lo, hi): (f64, f64)) -> Option<Pieces<'_, Self>> {
        let mut j = self.inflection_before(lo);
        if quarter(j).hi() > lo {
            j -= 2;
        }
        let mut pieces = Pieces::starting(self, lo);
        if quarter(j).hi() > lo {
            return None;
        }
        // Invariant: the inflection j is certainly at or before the end of the pieces.
        while pieces.has_room() {
            let next = quarter(j + 2);
            pieces = pieces.until(lesser(next.lo(), hi), self.bend_after(j));
            if pieces.end() >= hi {
                return Some(pieces);
            }
            if !pieces.has_room() {
                return None;
            }
            pieces = pieces.until(lesser(next.hi(), hi), Bend::Gap);
            if pieces.end() >= hi {
                return Some(pieces);
            }
            j += 2;
        }
        None
    }
}

impl Curve for Wave {
    fn value(&self, x: f64) -> Interval {
        if self.shift == 0 { point::sin(x) } else { point::cos(x) }
    }
    fn slope(&self, x: f64) -> Interval {
        if self.shift == 0 { point::cos(x) } else { -point::sin(x) }
    }
    /// `+-cos y = alpha`, `y` the distance from the inflection before.
    fn touch(&self, alpha: f64, lo: f64, hi: f64) -> f64 {
        let j = self.inflection_before(0.5 * lo + 0.5 * hi);
        let alpha = if self.bend_after(j) == Bend::Concave { alpha } else { -alpha };
        j as f64 * FRAC_PI_2 + core_math::acos(alpha)
    }
}

/// `h' = 1 + h^2 = alpha` at `k pi +- atan(sqrt(alpha - 1))`, on that side of `k pi` where the piece is.
const TAN: Formula = Formula {
    value: point::tan,
    slope: |x| Interval::ONE + point::tan(x).sqr(),
    touch: |alpha, lo, hi| {
        let middle = 0.5 * lo + 0.5 * hi;
        let centre = (middle / (2.0 * FRAC_PI_2)).round() * (2.0 * FRAC_PI_2);
        centre + core_math::atan((alpha - 1.0).sqrt()).copysign(middle - centre)
    },
};

impl<const N: usize> Affine<N> {
    /// Sine.
    #[must_use]
    pub fn sin(self) -> Self {
        self.wave(&Wave { shift: 0 }, Interval::sin)
    }

    /// Cosine.
    #[must_use]
    pub fn cos(self) -> Self {
        self.wave(&Wave { shift: 1 }, Interval::cos)
    }

    /// Tangent. Unknown unless the range of `x` lies strictly between two neighbouring poles.
    #[must_use]
    pub fn tan(self) -> Self {
        let Some((lo, hi)) = finite_range(&self, -FARTHEST, FARTHEST) else { return Self::UNKNOWN };
        let k = 2 * ((0.5 * lo + 0.5 * hi) / (2.0 * FRAC_PI_2)).round() as i64;
        // The clipped range equals the range, or touches +-FARTHEST: then the rest of x was not looked at.
        let all = lo > -FARTHEST && hi < FARTHEST;
        if !(all && quarter(k - 1).hi() < lo && hi < quarter(k + 1).lo()) {
            return Self::UNKNOWN;
        }
        let zero = quarter(k);
        // Beside the inflection, over a gap of a few ulps (1e-6 at most at FARTHEST), 1 <= h' = 1 + tan^2 <= 2.
        let pieces = Pieces::starting(&TAN, lo).until(lesser(hi, zero.lo()), Bend::Concave);
        let pieces = pieces.until(lesser(hi, zero.hi()), Bend::Gap).until(hi, Bend::Convex);
        pieces.apply(&self, Fit::Chebyshev)
    }

    fn wave(self, wave: &Wave, over: fn(Interval) -> Interval) -> Self {
        let x = self.range();
        let near = -FARTHEST < x.lo() && x.hi() < FARTHEST;
        match if near { wave.pieces((x.lo(), x.hi())) } else { None } {
            Some(pieces) => pieces.apply(&self, Fit::Chebyshev),
            None => Self::constant(over(x).intersection(Interval::new(-1.0, 1.0))),
        }
    }
}
