//! Kernels with AVX-512 embedded rounding: every instruction carries its direction, so the bounds are the tightest and
//! the control register stays as it is.
//!
//! Facts used (Intel SDM, volume 2, instructions VADDPD ... VCMPPD):
//! - rounding down never overflows a finite value to `+inf` (it gives `MAX`) nor up to `-inf`, so overflow needs no care;
//! - `vminpd(x, y)` and `vmaxpd(x, y)` return y if either is NaN and if both are zeros: lanes with a NaN are therefore
//!   found by comparing the *operands* and replaced at the end, and the sign of a zero is never relied upon;
//! - rounding down, an exact zero sum is `-0`;
//! - comparisons `_OQ` are false on NaN, `_UQ` true.
//!
//! No closure calls an intrinsic: it would not be inlined into a function with more target features than its own.
use std::arch::x86_64::{
    __m512d, __mmask8, _CMP_EQ_OQ, _CMP_GE_OQ, _CMP_LE_OQ, _CMP_LT_OQ, _CMP_NEQ_UQ, _CMP_UNORD_Q, _MM_FROUND_NO_EXC,
    _MM_FROUND_TO_NEG_INF, _MM_FROUND_TO_POS_INF, _mm512_add_round_pd, _mm512_castpd_si512, _mm512_castsi512_pd,
    _mm512_cmp_pd_mask, _mm512_div_round_pd, _mm512_loadu_pd, _mm512_mask_blend_pd, _mm512_mask3_fmadd_round_pd,
    _mm512_maskz_mul_round_pd, _mm512_max_pd, _mm512_min_pd, _mm512_mul_round_pd, _mm512_set1_epi64, _mm512_set1_pd,
    _mm512_setzero_pd, _mm512_sqrt_round_pd, _mm512_storeu_pd, _mm512_sub_round_pd, _mm512_xor_epi64,
};

use super::{Lanes, LanesMut};

const DOWN: i32 = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;
const UP: i32 = _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC;

/// Lanes of one vector.
const WIDTH: usize = 8;

/// Proof that this processor and operating system support AVX-512F.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Avx512 {
    _only_from_detect: (),
}

impl Avx512 {
    /// The proof, if the processor has the instructions.
    #[must_use]
    pub fn detect() -> Option<Self> {
        std::arch::is_x86_feature_detected!("avx512f").then_some(Self { _only_from_detect: () })
    }
}

/// Eight intervals.
#[derive(Clone, Copy)]
struct Vector {
    lo: __m512d,
    hi: __m512d,
}

#[inline]
#[target_feature(enable = "avx512f")]
fn load(lo: &[f64; WIDTH], hi: &[f64; WIDTH]) -> Vector {
    // SAFETY: the references are to 64 readable bytes each; the instruction asks for no alignment.
    unsafe { Vector { lo: _mm512_loadu_pd(lo.as_ptr()), hi: _mm512_loadu_pd(hi.as_ptr()) } }
}

#[inline]
#[target_feature(enable = "avx512f")]
fn store(x: Vector, lo: &mut [f64; WIDTH], hi: &mut [f64; WIDTH]) {
    // SAFETY: the references are to 64 writable bytes each; the instruction asks for no alignment.
    unsafe {
        _mm512_storeu_pd(lo.as_mut_ptr(), x.lo);
        _mm512_storeu_pd(hi.as_mut_ptr(), x.hi);
    }
}

/// The last, incomplete vector, filled up with `[0, 0]`.
#[inline]
fn padded(rest: &[f64]) -> [f64; WIDTH] {
    let mut full = [0.0; WIDTH];
    full[..rest.len()].copy_from_slice(rest);
    full
}

macro_rules! unary {
    ($($name:ident = $kernel:ident, $op:ident)*) => { $(
        pub(super) fn $name(_: Avx512, a: Lanes<'_>, out: LanesMut<'_>) {
            // SAFETY: an Avx512 exists only where the processor has the feature.
            unsafe { $kernel(a, out) }
        }

        #[target_feature(enable = "avx512f")]
        fn $kernel(a: Lanes<'_>, out: LanesMut<'_>) {
            let ((a_lo, a_lo_rest), (a_hi, a_hi_rest)) = (a.lo.as_chunks(), a.hi.as_chunks());
            let ((lo, lo_rest), (hi, hi_rest)) = (out.lo.as_chunks_mut(), out.hi.as_chunks_mut());
            for (((a_lo, a_hi), lo), hi) in a_lo.iter().zip(a_hi).zip(lo).zip(hi) {
                let a = load(a_lo, a_hi);
                store(replaced($op(a), inhabited(a), has_nan(a)), lo, hi);
            }
            if !lo_rest.is_empty() {
                let a = load(&padded(a_lo_rest), &padded(a_hi_rest));
                let (mut lo, mut hi) = ([0.0; WIDTH], [0.0; WIDTH]);
                store(replaced($op(a), inhabited(a), has_nan(a)), &mut lo, &mut hi);
                lo_rest.copy_from_slice(&lo[..lo_rest.len()]);
                hi_rest.copy_from_slice(&hi[..hi_rest.len()]);
            }
        }
    )* };
}

macro_rules! binary {
    ($($name:ident = $kernel:ident, $op:ident)*) => { $(
        pub(super) fn $name(_: Avx512, a: Lanes<'_>, b: Lanes<'_>, out: LanesMut<'_>) {
            // SAFETY: an Avx512 exists only where the processor has the feature.
            unsafe { $kernel(a, b, out) }
        }

        #[target_feature(enable = "avx512f")]
        fn $kernel(a: Lanes<'_>, b: Lanes<'_>, out: LanesMut<'_>) {
            let ((a_lo, a_lo_rest), (a_hi, a_hi_rest)) = (a.lo.as_chunks(), a.hi.as_chunks());
            let ((b_lo, b_lo_rest), (b_hi, b_hi_rest)) = (b.lo.as_chunks(), b.hi.as_chunks());
            let ((lo, lo_rest), (hi, hi_rest)) = (out.lo.as_chunks_mut(), out.hi.as_chunks_mut());
            for (((((a_lo, a_hi), b_lo), b_hi), lo), hi) in a_lo.iter().zip(a_hi).zip(b_lo).zip(b_hi).zip(lo).zip(hi) {
                let (a, b) = (load(a_lo, a_hi), load(b_lo, b_hi));
                store(replaced($op(a, b), inhabited(a) & inhabited(b), has_nan(a) | has_nan(b)), lo, hi);
            }
            if !lo_rest.is_empty() {
                let a = load(&padded(a_lo_rest), &padded(a_hi_rest));
                let b = load(&padded(b_lo_rest), &padded(b_hi_rest));
                let (mut lo, mut hi) = ([0.0; WIDTH], [0.0; WIDTH]);
                let value = replaced($op(a, b), inhabited(a) & inhabited(b), has_nan(a) | has_nan(b));
                store(value, &mut lo, &mut hi);
                lo_rest.copy_from_slice(&lo[..lo_rest.len()]);
                hi_rest.copy_from_slice(&hi[..hi_rest.len()]);
            }
        }
    )* };
}

unary! { neg = neg_lanes, negative  abs = abs_lanes, absolute  sqr = sqr_lanes, square  sqrt = sqrt_lanes, root }
binary! {
    add = add_lanes, sum
    sub = sub_lanes, difference
    mul = mul_lanes, product
    div = div_lanes, quotient
    min = min_lanes, minimum
    max = max_lanes, maximum
}

pub(super) fn mul_add(_: Avx512, a: Lanes<'_>, b: Lanes<'_>, c: Lanes<'_>, out: LanesMut<'_>) {
    // SAFETY: an Avx512 exists only where the processor has the feature.
    unsafe { mul_add_lanes(a, b, c, out) }
}

/// Every vector through the copy that fills up the last one: three operands are rare, and the code is short.
#[target_feature(enable = "avx512f")]
fn mul_add_lanes(a: Lanes<'_>, b: Lanes<'_>, c: Lanes<'_>, out: LanesMut<'_>) {
    for start in (0..out.lo.len()).step_by(WIDTH) {
        let end = usize::min(start + WIDTH, out.lo.len());
        let a = load(&padded(&a.lo[start..end]), &padded(&a.hi[start..end]));
        let b = load(&padded(&b.lo[start..end]), &padded(&b.hi[start..end]));
        let c = load(&padded(&c.lo[start..end]), &padded(&c.hi[start..end]));
        let all = inhabited(a) & inhabited(b) & inhabited(c);
        let value = replaced(fused(a, b, c), all, has_nan(a) | has_nan(b) | has_nan(c));
        let (mut lo, mut hi) = ([0.0; WIDTH], [0.0; WIDTH]);
        store(value, &mut lo, &mut hi);
        out.lo[start..end].copy_from_slice(&lo[..end - start]);
        out.hi[start..end].copy_from_slice(&hi[..end - start]);
    }
}

/// Lanes that have members: not the empty ones, not those with a NaN.
#[inline]
#[target_feature(enable = "avx512f")]
fn inhabited(a: Vector) -> __mmask8 {
    _mm512_cmp_pd_mask::<_CMP_LE_OQ>(a.lo, a.hi)
}

#[inline]
#[target_feature(enable = "avx512f")]
fn has_nan(a: Vector) -> __mmask8 {
    _mm512_cmp_pd_mask::<_CMP_UNORD_Q>(a.lo, a.hi)
}

/// `x` with the lanes in `mask` replaced by `[lo, hi]`.
#[inline]
#[target_feature(enable = "avx512f")]
fn with(x: Vector, mask: __mmask8, lo: f64, hi: f64) -> Vector {
    // blend(mask, x, y) takes y where the bit is set.
    Vector {
        lo: _mm512_mask_blend_pd(mask, x.lo, _mm512_set1_pd(lo)),
        hi: _mm512_mask_blend_pd(mask, x.hi, _mm512_set1_pd(hi)),
    }
}

/// The computed lanes where all operands have members; else the empty set, or every number where an operand has a NaN.
#[inline]
#[target_feature(enable = "avx512f")]
fn replaced(value: Vector, inhabited: __mmask8, nan: __mmask8) -> Vector {
    if inhabited == 0xff {
        // A NaN lane is not inhabited.
        return value;
    }
    let value = with(value, !inhabited, f64::INFINITY, f64::NEG_INFINITY);
    with(value, nan, f64::NEG_INFINITY, f64::INFINITY)
}

/// Flips the sign bit (XOR of doubles proper would need AVX-512DQ).
#[inline]
#[target_feature(enable = "avx512f")]
fn flipped(x: __m512d) -> __m512d {
    _mm512_castsi512_pd(_mm512_xor_epi64(_mm512_castpd_si512(x), _mm512_set1_epi64(i64::MIN)))
}

#[inline]
#[target_feature(enable = "avx512f")]
fn negative(a: Vector) -> Vector {
    Vector { lo: flipped(a.hi), hi: flipped(a.lo) }
}

/// Smallest and largest absolute value: of `lo` and `-hi` at most one is positive, none where 0 is a member.
#[inline]
#[target_feature(enable = "avx512f")]
fn absolute(a: Vector) -> Vector {
    Vector {
        lo: _mm512_max_pd(_mm512_max_pd(a.lo, flipped(a.hi)), _mm512_setzero_pd()),
        hi: _mm512_max_pd(flipped(a.lo), a.hi),
    }
}

#[inline]
#[target_feature(enable = "avx512f")]
fn square(a: Vector) -> Vector {
    // The smaller one is finite and not negative: its square rounded down is in [0, MAX].
    let m = absolute(a);
    Vector { lo: _mm512_mul_round_pd::<DOWN>(m.lo, m.lo), hi: _mm512_mul_round_pd::<UP>(m.hi, m.hi) }
}

#[inline]
#[target_feature(enable = "avx512f")]
fn root(a: Vector) -> Vector {
    let zero = _mm512_setzero_pd();
    let outside = _mm512_cmp_pd_mask::<_CMP_LT_OQ>(a.hi, zero);
    // max(-0, +0) is the second, +0: no root of a negative number or of -0 is taken.
    let value = Vector {
        lo: _mm512_sqrt_round_pd::<DOWN>(_mm512_max_pd(a.lo, zero)),
        hi: _mm512_sqrt_round_pd::<UP>(_mm512_max_pd(a.hi, zero)),
    };
    with(value, outside, f64::INFINITY, f64::NEG_INFINITY)
}

#[inline]
#[target_feature(enable = "avx512f")]
fn sum(a: Vector, b: Vector) -> Vector {
    // lo < +inf and hi > -inf: inf - inf cannot arise.
    Vector { lo: _mm512_add_round_pd::<DOWN>(a.lo, b.lo), hi: _mm512_add_round_pd::<UP>(a.hi, b.hi) }
}

#[inline]
#[target_feature(enable = "avx512f")]
fn difference(a: Vector, b: Vector) -> Vector {
    Vector { lo: _mm512_sub_round_pd::<DOWN>(a.lo, b.hi), hi: _mm512_sub_round_pd::<UP>(a.hi, b.lo) }
}

/// Lanes whose number is not +-0 (true for NaN).
#[inline]
#[target_feature(enable = "avx512f")]
fn nonzero(x: __m512d) -> __mmask8 {
    _mm512_cmp_pd_mask::<_CMP_NEQ_UQ>(x, _mm512_setzero_pd())
}

#[inline]
#[target_feature(enable = "avx512f")]
fn product(a: Vector, b: Vector) -> Vector {
    // A corner with a zero factor is +0 by its mask and not multiplied: 0 * inf = 0. So no corner is NaN.
    let (al, ah, bl, bh) = (nonzero(a.lo), nonzero(a.hi), nonzero(b.lo), nonzero(b.hi));
    let lo = _mm512_min_pd(
        _mm512_min_pd(
            _mm512_maskz_mul_round_pd::<DOWN>(al & bl, a.lo, b.lo),
            _mm512_maskz_mul_round_pd::<DOWN>(al & bh, a.lo, b.hi),
        ),
        _mm512_min_pd(
            _mm512_maskz_mul_round_pd::<DOWN>(ah & bl, a.hi, b.lo),
            _mm512_maskz_mul_round_pd::<DOWN>(ah & bh, a.hi, b.hi),
        ),
    );
    let hi = _mm512_max_pd(
        _mm512_max_pd(
            _mm512_maskz_mul_round_pd::<UP>(al & bl, a.lo, b.lo),
            _mm512_maskz_mul_round_pd::<UP>(al & bh, a.lo, b.hi),
        ),
        _mm512_max_pd(
            _mm512_maskz_mul_round_pd::<UP>(ah & bl, a.hi, b.lo),
            _mm512_maskz_mul_round_pd::<UP>(ah & bh, a.hi, b.hi),
        ),
    );
    Vector { lo, hi }
}

#[inline]
#[target_feature(enable = "avx512f")]
fn quotient(a: Vector, b: Vector) -> Vector {
    let zero = _mm512_setzero_pd();
    // x / y = (-x) / (-y): from here on y is not negative, unless 0 lies inside it.
    let flip = _mm512_cmp_pd_mask::<_CMP_LE_OQ>(b.hi, zero);
    let (minus_a, minus_b) = (negative(a), negative(b));
    let x =
        Vector { lo: _mm512_mask_blend_pd(flip, a.lo, minus_a.lo), hi: _mm512_mask_blend_pd(flip, a.hi, minus_a.hi) };
    let y_hi = _mm512_mask_blend_pd(flip, b.hi, minus_b.hi);
    // max(-0, +0) is the second, +0: x / 0 is the limit from the right. A negative end becomes 0 too; such lanes are
    // replaced below.
    let y_lo_signed = _mm512_mask_blend_pd(flip, b.lo, minus_b.lo);
    let y_lo = _mm512_max_pd(y_lo_signed, zero);
    // Falling in y for x >= 0, rising for x <= 0. No inf / inf: x.lo >= 0 and x.hi <= 0 are finite, and so is y.lo.
    // No 0 / 0 but for y = [0, 0], replaced below: x.lo = 0 or x.hi = 0 is divided by y.hi > 0.
    let rises = _mm512_cmp_pd_mask::<_CMP_GE_OQ>(x.lo, zero);
    let falls = _mm512_cmp_pd_mask::<_CMP_LE_OQ>(x.hi, zero);
    let value = Vector {
        lo: _mm512_div_round_pd::<DOWN>(x.lo, _mm512_mask_blend_pd(rises, y_lo, y_hi)),
        hi: _mm512_div_round_pd::<UP>(x.hi, _mm512_mask_blend_pd(falls, y_lo, y_hi)),
    };
    let around_zero = _mm512_cmp_pd_mask::<_CMP_LT_OQ>(y_lo_signed, zero);
    let value = with(value, around_zero, f64::NEG_INFINITY, f64::INFINITY);
    let zero_dividend = _mm512_cmp_pd_mask::<_CMP_EQ_OQ>(a.lo, zero) & _mm512_cmp_pd_mask::<_CMP_EQ_OQ>(a.hi, zero);
    let value = with(value, zero_dividend, 0.0, 0.0);
    let zero_divisor = _mm512_cmp_pd_mask::<_CMP_EQ_OQ>(b.lo, zero) & _mm512_cmp_pd_mask::<_CMP_EQ_OQ>(b.hi, zero);
    with(value, zero_divisor, f64::INFINITY, f64::NEG_INFINITY)
}

#[inline]
#[target_feature(enable = "avx512f")]
fn minimum(a: Vector, b: Vector) -> Vector {
    Vector { lo: _mm512_min_pd(a.lo, b.lo), hi: _mm512_min_pd(a.hi, b.hi) }
}

#[inline]
#[target_feature(enable = "avx512f")]
fn maximum(a: Vector, b: Vector) -> Vector {
    Vector { lo: _mm512_max_pd(a.lo, b.lo), hi: _mm512_max_pd(a.hi, b.hi) }
}

#[inline]
#[target_feature(enable = "avx512f")]
fn fused(a: Vector, b: Vector, c: Vector) -> Vector {
    // A corner with a zero factor is not multiplied but c's end, by its mask: 0 * inf = 0.
    let (al, ah, bl, bh) = (nonzero(a.lo), nonzero(a.hi), nonzero(b.lo), nonzero(b.hi));
    let lo = _mm512_min_pd(
        _mm512_min_pd(
            _mm512_mask3_fmadd_round_pd::<DOWN>(a.lo, b.lo, c.lo, al & bl),
            _mm512_mask3_fmadd_round_pd::<DOWN>(a.lo, b.hi, c.lo, al & bh),
        ),
        _mm512_min_pd(
            _mm512_mask3_fmadd_round_pd::<DOWN>(a.hi, b.lo, c.lo, ah & bl),
            _mm512_mask3_fmadd_round_pd::<DOWN>(a.hi, b.hi, c.lo, ah & bh),
        ),
    );
    let hi = _mm512_max_pd(
        _mm512_max_pd(
            _mm512_mask3_fmadd_round_pd::<UP>(a.lo, b.lo, c.hi, al & bl),
            _mm512_mask3_fmadd_round_pd::<UP>(a.lo, b.hi, c.hi, al & bh),
        ),
        _mm512_max_pd(
            _mm512_mask3_fmadd_round_pd::<UP>(a.hi, b.lo, c.hi, ah & bl),
            _mm512_mask3_fmadd_round_pd::<UP>(a.hi, b.hi, c.hi, ah & bh),
        ),
    );
    // inf - inf, the one way to a NaN, takes an unbounded c: then so is the result, whatever the corners are.
    let minus_infinity = _mm512_set1_pd(f64::NEG_INFINITY);
    let infinity = _mm512_set1_pd(f64::INFINITY);
    Vector {
        lo: _mm512_mask_blend_pd(_mm512_cmp_pd_mask::<_CMP_EQ_OQ>(c.lo, minus_infinity), lo, minus_infinity),
        hi: _mm512_mask_blend_pd(_mm512_cmp_pd_mask::<_CMP_EQ_OQ>(c.hi, infinity), hi, infinity),
    }
}
