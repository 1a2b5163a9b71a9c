//! Linear enclosures of functions of one variable, over ranges of one bend: step by step what `affine::curve` and
//! `affine::nonlinear` do.
use super::super::vector::Vector;
use super::{AffineOf, IntervalOf};
use crate::affine::{TINY, U};
use crate::round::ROOT_OF_ONE;

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

/// The form of `h(x)` for `lo <= x <= hi`, and where it is the scalar operator's: positive where `h` is, in the lanes asked for.
#[inline(always)]
fn linearised<V: Vector, C: Curve<V>, const N: usize>(
    curve: C,
    x: AffineOf<V, N>,
    range: IntervalOf<V>,
    positive: V::Mask,
) -> (AffineOf<V, N>, V::Mask) {
    let IntervalOf { lo, hi } = range;
    let (zero, half) = (V::splat(0.0), V::splat(0.5));
    let piece = Piece { lo, hi, at_lo: curve.value(lo), at_hi: curve.value(hi) };
    let rise = piece.at_hi.mid().sub(piece.at_lo.mid());
    let secant = rise.div(hi.sub(lo));
    let mut proper = secant.abs().le(V::splat(f64::MAX));
    let (mut form, mut certain, mut tight) = (AffineOf::unknown(), proper, proper);
    // A loop, so that the long formulas stand in the code once: by the secant, by a line of slope 0, by the flattest slope.
    let (mut alpha, mut pass) = (secant, 0);
    loop {
        let p = if pass == 1 { curve.flat(lo, hi) } else { curve.touch(alpha) };
        let d = piece.deviation(curve, alpha, p.greater(lo).lesser(hi));
        let (linear, fine) = (x.scale_add(alpha, d), V::both(p.le(p), d.lo.le(d.hi)));
        if pass == 0 {
            proper = V::both(proper, fine);
            certain = V::either(zero.lt(linear.range().lo), V::not(positive));
            tight = linear.e.lt(half.mul(rise.abs()));
            form = linear;
            if V::all(V::either(V::both(certain, tight), V::not(proper))) {
                return (form, proper);
            }
            alpha = zero;
        } else if pass == 1 {
            // Where the result may be 0 the constant is kept for the last pass.
            let constant = AffineOf::constant(d);
            let narrower = AffineOf::select(tight, form, form.narrower(constant));
            form = AffineOf::select(certain, narrower, constant);
            proper = V::both(proper, fine);
            if V::all(V::either(certain, V::not(proper))) {
                return (form, proper);
            }
            // The flattest slope keeps h - alpha x monotone: the result has the range of h.
            let (first, last) = (curve.slope(lo).mid(), curve.slope(hi).mid());
            alpha = V::select(first.abs().lt(last.abs()), first, last);
            proper = V::both(proper, V::either(certain, V::both(zero.lt(first.mul(last)), zero.lt(d.lo))));
        } else {
            form = AffineOf::select(certain, form, linear.narrower(form));
            return (form, V::both(proper, V::either(certain, fine)));
        }
        pass += 1;
    }
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

/// `sqrt x` for `x > 0`.
#[derive(Clone, Copy)]
struct Root;

impl<V: Vector> Curve<V> for Root {
    const CONCAVE: bool = true;
    #[inline(always)]
    fn value(self, x: V) -> IntervalOf<V> {
        IntervalOf::around(x.sqrt())
    }
    #[inline(always)]
    fn slope(self, x: V) -> IntervalOf<V> {
        let (root, one) = (<Self as Curve<V>>::value(self, x), V::splat(1.0));
        let twice = root.plus(root).0;
        IntervalOf { lo: one.div(twice.hi).below(), hi: one.div(twice.lo).above() }
    }
    #[inline(always)]
    fn touch(self, alpha: V) -> V {
        V::splat(0.25).div(alpha.mul(alpha))
    }
    #[inline(always)]
    fn flat(self, _: V, hi: V) -> V {
        hi
    }
}

/// About `x^(1/k)`: [`crate::round::about_root`].
#[inline(always)]
fn about_root<V: Vector>(x: V, k: u32) -> V {
    let (steps, inverse) = (f64::from(k - 1), 1.0 / f64::from(k));
    let guess = x.top().mul(V::splat(inverse)).add(V::splat(ROOT_OF_ONE * (steps * inverse)));
    let mut r = guess.with_top();
    for _ in 0..3 {
        let mut power = r;
        for _ in 2..k {
            power = power.mul(r);
        }
        r = V::splat(steps).mul(r).add(x.div(power)).mul(V::splat(inverse));
    }
    r
}

/// `x^n` for `3 <= n <= 8`; `x > 0` if n is odd.
#[derive(Clone, Copy)]
struct IntegerPower(u32);

impl IntegerPower {
    /// Sizes whose powers, and products of these with numbers of such a size, are ordinary numbers.
    const SMALL: f64 = 1e-17;
    const LARGE: f64 = 1e17;

    /// `x^n`, n >= 2: [+0, -0] of 0, as it is of the scalar operator.
    #[inline(always)]
    fn at<V: Vector>(x: V, n: u32) -> IntervalOf<V> {
        let (size, zero) = (x.abs(), V::splat(0.0));
        let power = IntervalOf {
            lo: IntervalOf::chain_from_one(size, n, false),
            hi: IntervalOf::chain_from_one(size, n, true),
        };
        let below = if n.is_multiple_of(2) { zero.lt(zero) } else { x.lt(zero) };
        let nothing = size.le(zero);
        IntervalOf {
            lo: V::select(nothing, zero, V::select(below, power.hi.neg(), power.lo)),
            hi: V::select(nothing, zero.neg(), V::select(below, power.lo.neg(), power.hi)),
        }
    }
}

impl<V: Vector> Curve<V> for IntegerPower {
    const CONCAVE: bool = false;
    #[inline(always)]
    fn value(self, x: V) -> IntervalOf<V> {
        Self::at(x, self.0)
    }
    #[inline(always)]
    fn slope(self, x: V) -> IntervalOf<V> {
        Self::at(x, self.0 - 1).times_count(f64::from(self.0))
    }
    /// The powers of very small numbers are left to the scalar operator.
    #[inline(always)]
    fn touch(self, alpha: V) -> V {
        let zero = V::splat(0.0);
        let q = alpha.div(V::splat(f64::from(self.0)));
        let r = V::select(q.abs().le(zero), zero, about_root(q.abs(), self.0 - 1));
        let ordinary = V::either(r.le(zero), V::splat(Self::SMALL).lt(r));
        let r = V::select(ordinary, r, V::splat(f64::NAN));
        if self.0.is_multiple_of(2) { V::select(q.lt(zero), r.neg(), r) } else { r }
    }
    #[inline(always)]
    fn flat(self, lo: V, hi: V) -> V {
        V::splat(0.0).greater(lo).lesser(hi)
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
        let (y, proper) = linearised(Reciprocal, x, range, V::always());
        let y = Self::select(negative, y.negative(), y);
        // Squares of these, of their reciprocals, and products of both are ordinary numbers.
        let fits = V::both(V::splat(1e-60).lt(range.lo), range.hi.lt(V::splat(1e60)));
        (Self::select(known, y, Self::unknown()), V::either(V::both(proper, fits), V::not(known)))
    }

    /// `sqrt x`. A range with 0 in it is left to the scalar operator.
    #[inline(always)]
    pub(super) fn root(self) -> (Self, V::Mask) {
        let range = self.range();
        let (y, proper) = linearised(Root, self, range, V::not(V::always()));
        let fits = V::both(V::splat(1e-60).lt(range.lo), range.hi.lt(V::splat(1e60)));
        (y, V::both(proper, fits))
    }

    /// `x^n` for `2 <= n <= 8`: the product of narrow forms, else one linearisation. Where the range is negative, by that of `-x`.
    #[inline(always)]
    pub(super) fn powi(self, n: u32) -> (Self, V::Mask) {
        if n == 2 {
            return (self.square(), V::always());
        }
        let narrow = self.narrow(n);
        if V::all(narrow) || !V::LINEARISES {
            return (self.product(n), narrow);
        }
        let (range, zero) = (self.range(), V::splat(0.0));
        let negative = range.hi.lt(zero);
        let x = Self::select(negative, self.negative(), self);
        let range = IntervalOf {
            lo: V::select(negative, range.hi.neg(), range.lo),
            hi: V::select(negative, range.lo.neg(), range.hi),
        };
        let positive = zero.lt(range.lo);
        let (y, proper) = linearised(IntegerPower(n), x, range, positive);
        let fits = range.within(IntegerPower::SMALL, IntegerPower::LARGE);
        let (y, proper) = if n.is_multiple_of(2) {
            (y, V::both(proper, fits))
        } else {
            // A range with a point of inflection in it is left to the scalar operator.
            (Self::select(negative, y.negative(), y), V::both(proper, V::both(positive, fits)))
        };
        (Self::select(narrow, self.product(n), y), V::either(narrow, proper))
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::vector::Plain;
    use super::*;

    /// Ordinary forms are not left to the scalar operator.
    #[test]
    fn vectors_do_the_work() {
        for width in [1e-9, 1e-3, 0.1, 0.5, 0.7, 0.9, 0.999] {
            for c in [0.01, 3.0, 700.0] {
                let (c, w) = (Plain::splat(c), Plain::splat(c * width / 3.0));
                let x = AffineOf::<Plain, 3> { c, e: Plain::splat(0.0), a: [w, w.neg(), w] };
                let answered = |(_, proper): (AffineOf<Plain, 3>, [bool; 8])| assert_eq!(proper, [true; 8], "{width}");
                [x.recip(), x.negative().recip(), x.root(), x.size()].into_iter().for_each(answered);
                for n in 3..=8 {
                    answered(linearised(IntegerPower(n), x, x.range(), Plain::always()));
                }
                let shifted = AffineOf { c: c.mul(Plain::splat(0.3 * width)), ..x };
                answered(shifted.size());
                answered(linearised(IntegerPower(4), shifted, shifted.range(), Plain::not(Plain::always())));
            }
        }
    }
}
