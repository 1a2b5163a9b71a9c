//! Directed rounding of single `f64` operations, portable and the same on every machine.
//!
//! `add_down(a, b) <= a + b <= add_up(a, b)` in real numbers, and so on for every pair of this module. The operation is
//! done in the default mode (round to nearest); the rounded result `r` is then moved outward by `e = |r| phi + eta` with
//! `phi = 2^-53 (1 + 2^-52)` and `eta = 2^-1074`.
//!
//! **Proof.** Rump, Zimmermann, Boldo, Melquiond, *Computing predecessor and successor in rounding to nearest*, BIT 49
//! (2009), theorem 2.2: for every finite `r`, the computed `r - e` is at most the predecessor of `r` and the computed
//! `r + e` at least its successor; equality holds but for `|r|` in about `[2^-1022, 2^-1020]`, where the step may be two
//! units. A real number that rounds to the nearest `r` lies between these two neighbours. Overflow: a result `+inf` of
//! finite operands means a value above the largest float, so its lower bound is `MAX`; its upper bound stays `+inf`.
//!
//! **Infinite operands** are limits, as bounds of intervals are: `0 * inf = 0` and `x / inf = 0`. `inf - inf` and
//! `inf / inf` are NaN. **NaN** in gives NaN out, which no predicate takes as a proof.
//!
//! **Assumed**: IEEE 754 `+ - * /` and `sqrt` in round-to-nearest with subnormals, which is what Rust defines for `f64`.

/// `2^-53 (1 + 2^-52)`.
pub(crate) const PHI: f64 = f64::EPSILON / 2.0 * (1.0 + f64::EPSILON);
/// `2^-1074`, the smallest subnormal.
pub(crate) const ETA: f64 = f64::from_bits(1);

/// A number at most the predecessor of `r`: at most every real that rounds to `r`. `+inf` gives `MAX`.
#[inline(always)]
#[must_use]
pub fn next_down(r: f64) -> f64 {
    // inf - inf would be NaN. A NaN compares unequal and stays.
    if r == f64::INFINITY { f64::MAX } else { r - (r.abs() * PHI + ETA) }
}

/// A number at least the successor of `r`: at least every real that rounds to `r`. `-inf` gives `-MAX`.
#[inline(always)]
#[must_use]
pub fn next_up(r: f64) -> f64 {
    if r == f64::NEG_INFINITY { f64::MIN } else { r + (r.abs() * PHI + ETA) }
}

/// The smaller number; the second one if either is NaN. Unlike [`f64::min`] the same bits on every machine.
#[inline(always)]
pub(crate) fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger number; the second one if either is NaN.
#[inline(always)]
pub(crate) fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Lower bound of `a + b`, exact where a term or the rounded sum is 0.
#[inline(always)]
#[must_use]
pub fn add_down(a: f64, b: f64) -> f64 {
    let r = a + b;
    let e = sum_error(a, b, r);
    if r == f64::INFINITY { f64::MAX } else { r - e }
}

/// Upper bound of `a + b`, exact where a term or the rounded sum is 0.
#[inline(always)]
#[must_use]
pub fn add_up(a: f64, b: f64) -> f64 {
    let r = a + b;
    let e = sum_error(a, b, r);
    if r == f64::NEG_INFINITY { f64::MIN } else { r + e }
}

/// The step outward for `r = fl(a + b)`: none where a term is 0, nor where r is: a sum of two floats that rounds to 0 is 0,
/// because both are multiples of eta. This keeps `x^2 + y^2 >= 0`. (A masked number is cheaper than a choice of results.)
#[inline(always)]
fn sum_error(a: f64, b: f64, r: f64) -> f64 {
    if (r == 0.0) | (a == 0.0) | (b == 0.0) { 0.0 } else { r.abs() * PHI + ETA }
}

/// Lower bound of `a - b`, exact where a term or the rounded difference is 0.
#[inline(always)]
#[must_use]
pub fn sub_down(a: f64, b: f64) -> f64 {
    add_down(a, -b)
}

/// Upper bound of `a - b`, exact where a term or the rounded difference is 0.
#[inline(always)]
#[must_use]
pub fn sub_up(a: f64, b: f64) -> f64 {
    add_up(a, -b)
}

/// Lower bound of `a * b`, exact where a factor is 0, never below 0 where the product is not; `0 * inf = 0`.
#[inline(always)]
#[must_use]
pub fn mul_down(a: f64, b: f64) -> f64 {
    let r = a * b;
    if r.abs() > 0.0 { next_down(r) } else { vanished_product_down(a, b) }
}

/// Upper bound of `a * b`, exact where a factor is 0, never above 0 where the product is not; `0 * inf = 0`.
#[inline(always)]
#[must_use]
pub fn mul_up(a: f64, b: f64) -> f64 {
    let r = a * b;
    if r.abs() > 0.0 { next_up(r) } else { -vanished_product_down(-a, b) }
}

/// Lower bound of a product that was rounded to 0 or NaN. The sign of the real product is known from its factors.
#[cold]
fn vanished_product_down(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else if a == 0.0 || b == 0.0 || (a > 0.0) == (b > 0.0) {
        // Exactly 0, or above 0 by less than eta.
        0.0
    } else {
        -ETA
    }
}

/// Lower bound of `a / b`, exact where `a` is 0 or `b` infinite, never below 0 where the quotient is not. NaN if `b` is 0.
#[inline(always)]
#[must_use]
pub fn div_down(a: f64, b: f64) -> f64 {
    let r = a / b;
    if r.abs() > 0.0 && b != 0.0 { next_down(r) } else { vanished_quotient_down(a, b) }
}

/// Upper bound of `a / b`, exact where `a` is 0 or `b` infinite, never above 0 where the quotient is not. NaN if `b` is 0.
#[inline(always)]
#[must_use]
pub fn div_up(a: f64, b: f64) -> f64 {
    let r = a / b;
    if r.abs() > 0.0 && b != 0.0 { next_up(r) } else { -vanished_quotient_down(-a, b) }
}

/// Lower bound of a quotient that was rounded to 0 or NaN, or whose divisor is 0.
#[cold]
fn vanished_quotient_down(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() || b == 0.0 || (a.is_infinite() && b.is_infinite()) {
        f64::NAN
    } else if a == 0.0 || b.is_infinite() || (a > 0.0) == (b > 0.0) {
        0.0
    } else {
        -ETA
    }
}

/// `2^52`: the float `2^52 + k` has the bits of the whole number `k < 2^52` below those of its exponent.
pub(crate) const WHOLE: f64 = 4_503_599_627_370_496.0;

/// The upper half of the bits of a number that is not negative.
#[inline(always)]
pub(crate) fn top(x: f64) -> f64 {
    (x.to_bits() >> 32) as f64
}

/// The number with this upper half of the bits, which is rounded to a whole number, and nothing below.
#[inline(always)]
pub(crate) fn with_top(k: f64) -> f64 {
    f64::from_bits((k + WHOLE).to_bits() << 32)
}

/// About `x^(1/k)` for normal `x > 0`, `2 <= k <= 7`: within a millionth. No claim: for choosing. By operations that vectors have.
///
/// The bits of a float are about a linear function of its logarithm, which makes the first guess good to a twentieth;
/// a step of Newton's takes the relative error `d` to `(k - 1)/2 d^2`.
pub(crate) fn about_root(x: f64, k: u32) -> f64 {
    let (steps, inverse) = (f64::from(k - 1), 1.0 / f64::from(k));
    let mut r = with_top(top(x) * inverse + ROOT_OF_ONE * (steps * inverse));
    for _ in 0..3 {
        let power = (2..k).fold(r, |p, _| p * r);
        r = (steps * r + x / power) * inverse;
    }
    r
}

/// The upper half of the bits of 1, less half of the largest error of the logarithm (0.0430 of a binade).
pub(crate) const ROOT_OF_ONE: f64 = (1023.0 - 0.0430) * 1_048_576.0;

/// Lower bound of `a b + c`, exact where a factor is 0, never below 0 where the value is not; `0 * inf = 0`. One step.
///
/// [`f64::mul_add`] is specified to round once, to nearest (IEEE 754 `fusedMultiplyAdd`). Costs a library call where the
/// processor has no such instruction.
#[must_use]
pub fn mul_add_down(a: f64, b: f64, c: f64) -> f64 {
    if (a == 0.0 && !b.is_nan()) || (b == 0.0 && !a.is_nan()) {
        return c;
    }
    #[expect(clippy::disallowed_methods, reason = "one rounding is the point here, and it is specified")]
    let r = a.mul_add(b, c);
    if r == 0.0 {
        // A value that vanished keeps its sign; one that is 0 is a difference of equals, which is +0.
        if r.is_sign_negative() { -ETA } else { 0.0 }
    } else {
        r.next_down()
    }
}

/// Upper bound of `a b + c`, as [`mul_add_down`].
#[must_use]
pub fn mul_add_up(a: f64, b: f64, c: f64) -> f64 {
    if (a == 0.0 && !b.is_nan()) || (b == 0.0 && !a.is_nan()) {
        return c;
    }
    #[expect(clippy::disallowed_methods, reason = "one rounding is the point here, and it is specified")]
    let r = a.mul_add(b, c);
    if r == 0.0 {
        // Below 0, or 0, or above 0 by less than eta.
        if r.is_sign_negative() { 0.0 } else { ETA }
    } else {
        r.next_up()
    }
}

/// Lower bound of the square root, exact at 0. NaN if `a < 0`.
#[inline(always)]
#[must_use]
pub fn sqrt_down(a: f64) -> f64 {
    let r = a.sqrt();
    if r == 0.0 { r } else { next_down(r) }
}

/// Upper bound of the square root, exact at 0. NaN if `a < 0`.
#[inline(always)]
#[must_use]
pub fn sqrt_up(a: f64) -> f64 {
    let r = a.sqrt();
    if r == 0.0 { r } else { next_up(r) }
}

#[cfg(test)]
mod tests {
    use super::about_root;

    #[test]
    fn roots_are_within_a_millionth() {
        for k in 2..=7 {
            for i in 0..4000 {
                let x = (1.0 + f64::from(i % 100) / 100.0) * core_math::exp2(f64::from(i / 100 - 20));
                let error = about_root(x, k) / core_math::pow(x, 1.0 / f64::from(k)) - 1.0;
                assert!(error.abs() < 1e-6, "{x} {k}: {error:e}");
            }
        }
    }
}
