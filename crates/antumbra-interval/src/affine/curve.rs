//! Linear enclosures of functions of one variable.
//!
//! For *any* float `alpha`, `h(x) = alpha x + (h(x) - alpha x)`, and the second part, the deviation, is enclosed over the
//! range of `x`. So `alpha` decides only how tight the result is.
//!
//! Where `h` is convex on `[l, u]`, so is the deviation: its maximum is at `l` or `u`, and it lies above its tangent at
//! any `p` of `[l, u]`: `h(x) - alpha x >= h(p) - alpha p + (h'(p) - alpha)(x - p)`. The best `p` has `h'(p) = alpha`; an
//! approximate one costs only `|h'(p) - alpha| (u - l)`. Concave: the same upside down.
use super::{
    Affine, TINY, U,
    point::{bounds, exact},
    {greater, lesser},
};
use crate::Interval;

/// A real function of one variable.
pub(super) trait Curve {
    /// Enclosure of `h(x)` at a float of the domain.
    fn value(&self, x: f64) -> Interval;
    /// Enclosure of `h'(x)` at a float of the domain.
    fn slope(&self, x: f64) -> Interval;
    /// About the point of `[lo, hi]`, on which `h'` is monotone, where `h' = alpha`. Any answer is sound.
    fn touch(&self, alpha: f64, lo: f64, hi: f64) -> f64;
}

/// A curve given by three functions.
pub(super) struct Formula {
    pub(super) value: fn(f64) -> Interval,
    pub(super) slope: fn(f64) -> Interval,
    pub(super) touch: fn(f64, f64, f64) -> f64,
}

impl Curve for Formula {
    fn value(&self, x: f64) -> Interval {
        (self.value)(x)
    }
    fn slope(&self, x: f64) -> Interval {
        (self.slope)(x)
    }
    fn touch(&self, alpha: f64, lo: f64, hi: f64) -> f64 {
        (self.touch)(alpha, lo, hi)
    }
}

/// What is known of `h` on one part of the range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Bend {
    Convex,
    Concave,
    /// `|h'| <= 2`: for the gap between the floats on both sides of an irrational point of inflection.
    Gap,
}

/// A part `[lo, hi]` of the range, with the values at its ends.
#[derive(Clone, Copy, Debug)]
struct Piece {
    lo: f64,
    hi: f64,
    at_lo: Interval,
    at_hi: Interval,
    bend: Bend,
}

impl Piece {
    /// Enclosure of `h(x) - alpha x` for `x` in the piece.
    fn deviation<C: Curve>(&self, curve: &C, alpha: f64) -> Interval {
        match self.bend {
            Bend::Gap => {
                let (a, x) = (exact(alpha), bounds(self.lo, self.hi));
                let start = self.at_lo - a * exact(self.lo);
                start + (Interval::new(-2.0, 2.0) - a) * (x - exact(self.lo))
            }
            Bend::Convex => {
                let (low, high) = self.convex(curve, alpha, |y| y);
                bounds(low, high)
            }
            Bend::Concave => {
                // -h is convex.
                let (low, high) = self.convex(curve, alpha, |y| -y);
                bounds(-high, -low)
            }
        }
    }

    /// Bounds of `k(x) - beta x`, where `k = h`, `beta = alpha`, or both mirrored, so that `k` is convex. NaN if unknown.
    fn convex<C: Curve>(&self, curve: &C, alpha: f64, mirror: fn(Interval) -> Interval) -> (f64, f64) {
        let beta = mirror(exact(alpha)).lo();
        let high = greatest(
            above_line(mirror(self.at_lo).hi(), beta, self.lo),
            above_line(mirror(self.at_hi).hi(), beta, self.hi),
        );
        let p = curve.touch(alpha, self.lo, self.hi);
        let p = if p.is_nan() {
            // The slope is never alpha: the tangent at the end where the deviation is least.
            let middle = 0.5 * self.lo + 0.5 * self.hi;
            if mirror(curve.slope(middle)).mid() > beta { self.lo } else { self.hi }
        } else {
            lesser(greater(p, self.lo), self.hi)
        };
        let slope = mirror(curve.slope(p));
        // (k'(p) - beta)(p - x), p - x in [p - hi, p - lo], is largest at an end: for the steepest slope at lo, for the
        // least one at hi.
        let fall = greatest(
            product_above((slope.hi() - beta).next_up(), p, self.lo),
            product_above((beta - slope.lo()).next_up(), self.hi, p),
        );
        (-(above_line(-mirror(curve.value(p)).lo(), -beta, p) + fall).next_up(), high)
    }
}

/// Upper bound of `v - beta x`. Roundings: the product `u |beta x| + eta/2`, two sums `u (|v| + |beta x|)` each.
fn above_line(v: f64, beta: f64, x: f64) -> f64 {
    let line = beta * x;
    (v - line) + (4.0 * U * (v.abs() + line.abs()) + TINY)
}

/// Upper bound of `max(g, 0) (y - x)` for floats `x <= y`; `g` may be infinite.
fn product_above(g: f64, y: f64, x: f64) -> f64 {
    if x == y || g <= 0.0 { 0.0 } else { (g * (y - x).next_up()).next_up() }
}

/// The larger one, NaN if there is one.
fn greatest(x: f64, y: f64) -> f64 {
    if x >= y {
        x
    } else if x < y {
        y
    } else {
        f64::NAN
    }
}

/// How to choose `alpha`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fit {
    /// Smallest error.
    Chebyshev,
    /// Smallest error, but keep the result positive where `h > 0` is.
    Positive,
}

/// A range `[lo, hi]` cut at the points of inflection of a curve.
pub(super) struct Pieces<'a, C> {
    curve: &'a C,
    list: [Piece; 5],
    len: usize,
    end: f64,
    at_end: Interval,
}

impl<'a, C: Curve> Pieces<'a, C> {
    /// A range that begins at `lo`, of no length yet.
    pub(super) fn starting(curve: &'a C, lo: f64) -> Self {
        let at = curve.value(lo);
        let none = Piece { lo, hi: lo, at_lo: at, at_hi: at, bend: Bend::Gap };
        Self { curve, list: [none; 5], len: 0, end: lo, at_end: at }
    }

    /// The range of one bend.
    pub(super) fn whole(curve: &'a C, (lo, hi): (f64, f64), bend: Bend) -> Self {
        Self::starting(curve, lo).until(hi, bend)
    }

    /// The range cut at the inflection 0 if it is inside.
    pub(super) fn cut_at_zero(curve: &'a C, (lo, hi): (f64, f64), left: Bend, right: Bend) -> Self {
        let pieces = Self::starting(curve, lo).until(lesser(hi, 0.0), left);
        pieces.until(hi, right)
    }

    /// Whether one more piece fits.
    pub(super) fn has_room(&self) -> bool {
        self.len < self.list.len()
    }

    /// The range so far ends here.
    pub(super) fn end(&self) -> f64 {
        self.end
    }

    /// Appends the piece up to `hi`, nothing if the range is that long already (one number makes one piece).
    pub(super) fn until(mut self, hi: f64, bend: Bend) -> Self {
        if hi > self.end || (self.len == 0 && hi == self.end) {
            let at_hi = self.curve.value(hi);
            self.list[self.len] = Piece { lo: self.end, hi, at_lo: self.at_end, at_hi, bend };
            self.len += 1;
            (self.end, self.at_end) = (hi, at_hi);
        }
        self
    }

    /// Enclosure of `h(x) - alpha x` over the whole range.
    fn deviation(&self, alpha: f64) -> Interval {
        let first = self.list[0].deviation(self.curve, alpha);
        self.list.iter().take(self.len).skip(1).fold(first, |d, p| d.hull(p.deviation(self.curve, alpha)))
    }

    /// A good `alpha`.
    ///
    /// One bend: the secant, for which the extreme deviations are at both ends and at one inner point (Chebyshev). Cut
    /// ranges: for a cubic over `m +- r` the best slope is `secant + (h'(m) - secant)/4`; `h'(m)` is limited to
    /// `[0, 7/3] secant`, which suits a cube root (infinite slope) and a step (saturated `tanh`) too.
    fn chebyshev(&self) -> f64 {
        let (lo, hi) = (self.list[0].lo, self.end);
        let secant = (self.at_end.mid() - self.list[0].at_lo.mid()) / (hi - lo);
        let middle = || self.curve.slope(0.5 * lo + 0.5 * hi).mid();
        let alpha = if !secant.is_finite() {
            middle()
        } else if self.len == 1 {
            secant
        } else {
            let ratio = middle() / secant;
            let limited = if ratio < 7.0 / 3.0 { if ratio > 0.0 { ratio } else { 0.0 } } else { 7.0 / 3.0 };
            secant * (0.75 + 0.25 * limited)
        };
        if alpha.is_finite() { alpha } else { 0.0 }
    }

    /// The form of `h(x)`; `x` takes values of the range only, where `h` is defined.
    ///
    /// Falls back to centre and radius of the range of `h` if that error is no larger; tried only if the linear error
    /// exceeds half the difference of the values at both ends, as the radius is at least that.
    pub(super) fn apply<const N: usize>(&self, x: &Affine<N>, fit: Fit) -> Affine<N> {
        let alpha = self.chebyshev();
        let linear = x.scale_add(alpha, self.deviation(alpha));
        if fit == Fit::Positive && !linear.range().certainly_positive() {
            let flat = self.deviation(0.0);
            if flat.certainly_positive() {
                // The flattest slope keeps h - alpha x monotone: the result has the range of h.
                let (p, q) = (self.curve.slope(self.list[0].lo).mid(), self.curve.slope(self.end).mid());
                let alpha = if p * q <= 0.0 {
                    0.0
                } else if p.abs() < q.abs() {
                    p
                } else {
                    q
                };
                return narrower(x.scale_add(alpha, self.deviation(alpha)), Affine::constant(flat));
            }
        }
        let rise = 0.5 * (self.at_end.mid() - self.list[0].at_lo.mid()).abs();
        if linear.e < rise { linear } else { narrower(linear, Affine::constant(self.deviation(0.0))) }
    }
}

/// The form with the smaller error, the second one if they are equal.
pub(super) fn narrower<const N: usize>(p: Affine<N>, q: Affine<N>) -> Affine<N> {
    if p.e < q.e { p } else { q }
}

/// The bounds of the range of `x` inside `[lo, hi]`, if they are finite.
pub(super) fn finite_range<const N: usize>(x: &Affine<N>, lo: f64, hi: f64) -> Option<(f64, f64)> {
    let x = x.range().intersection(bounds(lo, hi));
    (!x.is_empty() && x.lo().is_finite() && x.hi().is_finite()).then(|| (x.lo(), x.hi()))
}
