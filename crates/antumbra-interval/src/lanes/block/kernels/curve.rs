//! Linear enclosures of functions of one variable, over ranges of one bend: step by step what `affine::curve` and
//! `affine::nonlinear` do.
use super::super::vector::Vector;
use super::{AffineOf, IntervalOf};
use crate::affine::{TINY, U};

/// A function of one variable that is convex or concave.
trait Curve<V: Vector>: Copy {
    /// Concave, else convex.
    const CONCAVE: bool;
    /// Enclosure of `h(x)`.
    fn value(self, x: V) -> IntervalOf<V>;
    /// Enclosure of `h'(x)`.
    fn slope(self, x: V) -> IntervalOf<V>;
    /// About where `h' = alpha`; NaN, where the scalar operator has to look itself.
    fn touch(self, alpha: V) -> V;
    /// Where the scalar operator touches with a line of slope 0.
    fn flat(self, lo: V, hi: V) -> V;
}

/// A range, and the values at its ends.
#[derive(Clone, Copy)]
struct Piece<V> {
    lo: V,
    hi: V,
    at_lo: IntervalOf<V>,
    at_hi: IntervalOf<V>,
}

impl<V: Vector> Piece<V> {
    /// Enclosure of `h(x) - alpha x`, by the tangent at `p`, which is in the range.
    #[inline(always)]
    fn deviation<C: Curve<V>>(self, curve: C, alpha: V, p: V) -> IntervalOf<V> {
        let beta = if C::CONCAVE { alpha.neg() } else { alpha };
        let high = above_line(mirror::<V, C>(self.at_lo).hi, beta, self.lo);
        let high = high.greater(above_line(mirror::<V, C>(self.at_hi).hi, beta, self.hi));
        let slope = mirror::<V, C>(curve.slope(p));
        let fall = product_above(slope.hi.sub(beta).above(), p, self.lo);
        let fall = fall.greater(product_above(beta.sub(slope.lo).above(), self.hi, p));
        let low = above_line(mirror::<V, C>(curve.value(p)).lo.neg(), beta.neg(), p).add(fall).above().neg();
        mirror::<V, C>(IntervalOf { lo: low, hi: high })
    }

    /// The same for the best `p`, and where that is one.
    #[inline(always)]
    fn best<C: Curve<V>>(self, curve: C, alpha: V) -> (IntervalOf<V>, V::Mask) {
        let touch = curve.touch(alpha);
        let d = self.deviation(curve, alpha, touch.greater(self.lo).lesser(self.hi));
        (d, V::both(touch.le(touch), d.lo.le(d.hi)))
    }
}

/// Upside down if the curve is concave.
#[inline(always)]
fn mirror<V: Vector, C: Curve<V>>(y: IntervalOf<V>) -> IntervalOf<V> {
    if C::CONCAVE { y.negative() } else { y }
}

/// Upper bound of `v - beta x`.
#[inline(always)]
fn above_line<V: Vector>(v: V, beta: V, x: V) -> V {
    let line = beta.mul(x);
    v.sub(line).add(V::splat(4.0 * U).mul(v.abs().add(line.abs())).add(V::splat(TINY)))
}

/// Upper bound of `max(g, 0) (y - x)` for `x <= y`.
#[inline(always)]
fn product_above<V: Vector>(g: V, y: V, x: V) -> V {
    let zero = V::splat(0.0);
    V::select(V::either(y.le(x), g.le(zero)), zero, g.mul(y.sub(x).above()).above())
}

/// The form of `h(x)` for `lo <= x <= hi`, and where it is the scalar operator's: positive where `h` is, if so wanted.
#[inline(always)]
fn linearised<V: Vector, C: Curve<V>, const N: usize>(
    curve: C,
    x: AffineOf<V, N>,
    range: IntervalOf<V>,
    positive: bool,
) -> (AffineOf<V, N>, V::Mask) {
    let IntervalOf { lo, hi } = range;
    let (zero, half) = (V::splat(0.0), V::splat(0.5));
    let piece = Piece { lo, hi, at_lo: curve.value(lo), at_hi: curve.value(hi) };
    let rise = piece.at_hi.mid().sub(piece.at_lo.mid());
    let secant = rise.div(hi.sub(lo));
    let (d, touched) = piece.best(curve, secant);
    let proper = V::both(touched, secant.abs().le(V::splat(f64::MAX)));
    let linear = x.scale_add(secant, d);
    let tight = linear.e.lt(half.mul(rise.abs()));
    let certain = if positive { zero.lt(linear.range().lo) } else { V::always() };
    if V::all(V::either(V::both(certain, tight), V::not(proper))) {
        return (linear, proper);
    }
    let flat = piece.deviation(curve, zero, curve.flat(lo, hi));
    let (constant, proper) = (AffineOf::constant(flat), V::both(proper, flat.lo.le(flat.hi)));
    let by_secant = AffineOf::select(tight, linear, linear.narrower(constant));
    if V::all(V::either(certain, V::not(proper))) {
        return (by_secant, proper);
    }
    // The flattest slope keeps h - alpha x monotone: the result has the range of h.
    let (p, q) = (curve.slope(lo).mid(), curve.slope(hi).mid());
    let alpha = V::select(p.abs().lt(q.abs()), p, q);
    let (d, touched) = piece.best(curve, alpha);
    let monotone = V::both(V::both(zero.lt(p.mul(q)), zero.lt(flat.lo)), touched);
    let by_flattest = x.scale_add(alpha, d).narrower(constant);
    (AffineOf::select(certain, by_secant, by_flattest), V::both(proper, V::either(certain, monotone)))
}

/// `1/x` for `x > 0`.
#[derive(Clone, Copy)]
struct Reciprocal;

impl<V: Vector> Curve<V> for Reciprocal {
    const CONCAVE: bool = false;
    #[inline(always)]
    fn value(self, x: V) -> IntervalOf<V> {
        IntervalOf::around(V::splat(1.0).div(x))
    }
    #[inline(always)]
    fn slope(self, x: V) -> IntervalOf<V> {
        <Self as Curve<V>>::value(self, x).positive_square().negative()
    }
    #[inline(always)]
    fn touch(self, alpha: V) -> V {
        V::splat(-1.0).div(alpha).sqrt()
    }
    #[inline(always)]
    fn flat(self, _: V, hi: V) -> V {
        hi
    }
}

impl<V: Vector, const N: usize> AffineOf<V, N> {
    /// `1 / x`. Where the range is negative, by that of `-x`.
    #[inline(always)]
    pub(super) fn recip(self) -> (Self, V::Mask) {
        let zero = V::splat(0.0);
        let negative = self.c.lt(zero);
        let x = Self::select(negative, self.negative(), self);
        let range = x.range();
        let known = zero.lt(range.lo);
        let (y, proper) = linearised(Reciprocal, x, range, true);
        let y = Self::select(negative, y.negative(), y);
        // Squares of these, of their reciprocals, and products of both are ordinary numbers.
        let fits = V::both(V::splat(1e-60).lt(range.lo), range.hi.lt(V::splat(1e60)));
        (Self::select(known, y, Self::unknown()), V::either(V::both(proper, fits), V::not(known)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::vector::Plain;
    use super::*;

    /// Ordinary forms are not left to the scalar operator.
    #[test]
    fn vectors_do_the_work() {
        let every = [true; 8];
        for width in [1e-9, 1e-3, 0.1, 0.5, 0.7, 0.9, 0.999] {
            for c in [0.01, 3.0, -3.0, 700.0] {
                let (c, w) = (Plain::splat(c), Plain::splat(c * width / 3.0));
                let x = AffineOf::<Plain, 3> { c, e: Plain::splat(0.0), a: [w, w.neg(), w] };
                assert_eq!(x.recip().1, every, "1/x, width {width}");
            }
        }
    }
}
