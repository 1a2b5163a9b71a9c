//! Vectors of AVX-512 and AVX2.
//!
//! The intrinsics are called from functions that are always inlined, in the end into one that has the feature: [`on_avx512`],
//! [`on_avx2`]. Nothing else of the crate makes such vectors.
use super::vector::{Eight, Vector};
use super::{Act, Packed, act};
use crate::round::{ETA, PHI, WHOLE};
use std::arch::x86_64::{
    __m256d, __m256i, __m512d, __mmask8, _CMP_EQ_OQ, _CMP_LE_OQ, _CMP_LT_OQ, _CMP_NEQ_UQ, _mm256_add_epi64,
    _mm256_add_pd, _mm256_and_pd, _mm256_andnot_pd, _mm256_blendv_pd, _mm256_castpd_si256, _mm256_castsi256_pd,
    _mm256_cmp_pd, _mm256_cmpgt_epi64, _mm256_div_pd, _mm256_fmadd_pd, _mm256_fnmadd_pd, _mm256_load_pd, _mm256_max_pd,
    _mm256_min_pd, _mm256_movemask_pd, _mm256_mul_pd, _mm256_or_pd, _mm256_or_si256, _mm256_set1_epi64x,
    _mm256_set1_pd, _mm256_setzero_si256, _mm256_slli_epi64, _mm256_sqrt_pd, _mm256_srli_epi64, _mm256_store_pd,
    _mm256_sub_epi64, _mm256_sub_pd, _mm256_xor_pd, _mm512_abs_pd, _mm512_add_epi64, _mm512_add_pd,
    _mm512_castpd_si512, _mm512_castsi512_pd, _mm512_cmp_pd_mask, _mm512_div_pd, _mm512_fmadd_pd, _mm512_fnmadd_pd,
    _mm512_load_pd, _mm512_mask_blend_pd, _mm512_maskz_mov_pd, _mm512_max_pd, _mm512_min_pd, _mm512_mul_pd,
    _mm512_or_epi64, _mm512_set1_epi64, _mm512_set1_pd, _mm512_slli_epi64, _mm512_sqrt_pd, _mm512_srai_epi64,
    _mm512_srli_epi64, _mm512_store_pd, _mm512_sub_epi64, _mm512_sub_pd, _mm512_test_epi64_mask, _mm512_xor_epi64,
};

/// Proof that this processor and operating system support AVX2 and FMA.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Avx2 {
    _only_from_detect: (),
}

impl Avx2 {
    /// The proof, if the processor has the instructions.
    #[must_use]
    pub fn detect() -> Option<Self> {
        let both = std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma");
        both.then_some(Self { _only_from_detect: () })
    }
}

/// Eight numbers of AVX-512.
#[derive(Clone, Copy)]
pub(super) struct V512(__m512d);

/// Two times four numbers of AVX2.
#[derive(Clone, Copy)]
pub(super) struct V256([__m256d; 2]);

// SAFETY of every block below: such vectors exist only below `on_avx512` and `on_avx2`, which run only where the processor has
// the feature. Loads and stores are of 64 bytes behind a reference, aligned by the type.
impl Vector for V512 {
    type Mask = __mmask8;
    const LINEARISES: bool = true;
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self(unsafe { _mm512_set1_pd(x) })
    }
    #[inline(always)]
    fn load(from: &Eight) -> Self {
        Self(unsafe { _mm512_load_pd(from.0.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, to: &mut Eight) {
        unsafe { _mm512_store_pd(to.0.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self(unsafe { _mm512_add_pd(self.0, o.0) })
    }
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self(unsafe { _mm512_sub_pd(self.0, o.0) })
    }
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self(unsafe { _mm512_mul_pd(self.0, o.0) })
    }
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        Self(unsafe { _mm512_div_pd(self.0, o.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(unsafe { _mm512_sqrt_pd(self.0) })
    }
    // The floats of one sign are as the whole numbers that their bits are.
    #[inline(always)]
    fn above(self) -> Self {
        unsafe {
            let x = _mm512_castpd_si512(self.0);
            let sign = _mm512_or_epi64(_mm512_srai_epi64::<63>(x), _mm512_set1_epi64(1));
            let next = _mm512_castsi512_pd(_mm512_add_epi64(x, sign));
            let zero = _mm512_cmp_pd_mask::<_CMP_EQ_OQ>(self.0, _mm512_set1_pd(0.0));
            Self(_mm512_mask_blend_pd(zero, next, _mm512_set1_pd(ETA)))
        }
    }
    #[inline(always)]
    fn below(self) -> Self {
        unsafe {
            let x = _mm512_castpd_si512(self.0);
            let sign = _mm512_or_epi64(_mm512_srai_epi64::<63>(x), _mm512_set1_epi64(1));
            let next = _mm512_castsi512_pd(_mm512_sub_epi64(x, sign));
            let zero = _mm512_cmp_pd_mask::<_CMP_EQ_OQ>(self.0, _mm512_set1_pd(0.0));
            Self(_mm512_mask_blend_pd(zero, next, _mm512_set1_pd(-ETA)))
        }
    }
    #[inline(always)]
    fn top(self) -> Self {
        unsafe {
            let k = _mm512_srli_epi64::<32>(_mm512_castpd_si512(self.0));
            let whole = _mm512_or_epi64(k, _mm512_castpd_si512(_mm512_set1_pd(WHOLE)));
            Self(_mm512_sub_pd(_mm512_castsi512_pd(whole), _mm512_set1_pd(WHOLE)))
        }
    }
    #[inline(always)]
    fn with_top(self) -> Self {
        unsafe {
            let whole = _mm512_castpd_si512(_mm512_add_pd(self.0, _mm512_set1_pd(WHOLE)));
            Self(_mm512_castsi512_pd(_mm512_slli_epi64::<32>(whole)))
        }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(unsafe { _mm512_abs_pd(self.0) })
    }
    #[inline(always)]
    fn neg(self) -> Self {
        // XOR of doubles proper would need AVX-512DQ.
        Self(unsafe { _mm512_castsi512_pd(_mm512_xor_epi64(_mm512_castpd_si512(self.0), _mm512_set1_epi64(i64::MIN))) })
    }
    // The instructions return the second operand where either is NaN, or both are zeros: the very selection wanted.
    #[inline(always)]
    fn greater(self, o: Self) -> Self {
        Self(unsafe { _mm512_max_pd(self.0, o.0) })
    }
    #[inline(always)]
    fn lesser(self, o: Self) -> Self {
        Self(unsafe { _mm512_min_pd(self.0, o.0) })
    }
    #[inline(always)]
    fn nonzero(self) -> __mmask8 {
        unsafe { _mm512_test_epi64_mask(_mm512_castpd_si512(self.0), _mm512_set1_epi64(i64::MAX)) }
    }
    #[inline(always)]
    fn keep(mask: __mmask8, x: Self) -> Self {
        Self(unsafe { _mm512_maskz_mov_pd(mask, x.0) })
    }
    #[inline(always)]
    fn step(size: Self) -> Self {
        Self(unsafe { _mm512_fmadd_pd(size.0, _mm512_set1_pd(PHI), _mm512_set1_pd(ETA)) })
    }
    #[inline(always)]
    fn raised(self) -> Self {
        Self(unsafe { _mm512_fmadd_pd(_mm512_abs_pd(self.0), _mm512_set1_pd(PHI), self.0) })
    }
    #[inline(always)]
    fn lowered(self) -> Self {
        Self(unsafe { _mm512_fnmadd_pd(_mm512_abs_pd(self.0), _mm512_set1_pd(PHI), self.0) })
    }
    #[inline(always)]
    fn lt(self, o: Self) -> __mmask8 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, o.0) }
    }
    #[inline(always)]
    fn le(self, o: Self) -> __mmask8 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, o.0) }
    }
    #[inline(always)]
    fn select(mask: __mmask8, yes: Self, no: Self) -> Self {
        Self(unsafe { _mm512_mask_blend_pd(mask, no.0, yes.0) })
    }
    #[inline(always)]
    fn both(a: __mmask8, b: __mmask8) -> __mmask8 {
        a & b
    }
    #[inline(always)]
    fn either(a: __mmask8, b: __mmask8) -> __mmask8 {
        a | b
    }
    #[inline(always)]
    fn not(mask: __mmask8) -> __mmask8 {
        !mask
    }
    #[inline(always)]
    fn always() -> __mmask8 {
        u8::MAX
    }
    #[inline(always)]
    fn bits(mask: __mmask8) -> u8 {
        mask
    }
}

/// A function of two or three pairs of halves.
macro_rules! halves {
    ($f:ident $x:expr, $y:expr) => {
        unsafe { [$f($x[0], $y[0]), $f($x[1], $y[1])] }
    };
    ($f:ident $x:expr, $y:expr, $z:expr) => {
        unsafe { [$f($x[0], $y[0], $z[0]), $f($x[1], $y[1], $z[1])] }
    };
}

impl V256 {
    /// Whole numbers -1 where the sign bit is set, else 1.
    #[inline(always)]
    fn signs(self) -> [__m256i; 2] {
        unsafe {
            let (zero, one) = (_mm256_setzero_si256(), _mm256_set1_epi64x(1));
            [
                _mm256_or_si256(_mm256_cmpgt_epi64(zero, _mm256_castpd_si256(self.0[0])), one),
                _mm256_or_si256(_mm256_cmpgt_epi64(zero, _mm256_castpd_si256(self.0[1])), one),
            ]
        }
    }
}

impl Vector for V256 {
    type Mask = [__m256d; 2];
    const LINEARISES: bool = true;
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self(unsafe { [_mm256_set1_pd(x); 2] })
    }
    #[inline(always)]
    fn load(from: &Eight) -> Self {
        Self(unsafe { [_mm256_load_pd(from.0.as_ptr()), _mm256_load_pd(from.0.as_ptr().add(4))] })
    }
    #[inline(always)]
    fn store(self, to: &mut Eight) {
        unsafe {
            _mm256_store_pd(to.0.as_mut_ptr(), self.0[0]);
            _mm256_store_pd(to.0.as_mut_ptr().add(4), self.0[1]);
        }
    }
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self(halves!(_mm256_add_pd self.0, o.0))
    }
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self(halves!(_mm256_sub_pd self.0, o.0))
    }
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self(halves!(_mm256_mul_pd self.0, o.0))
    }
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        Self(halves!(_mm256_div_pd self.0, o.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(unsafe { [_mm256_sqrt_pd(self.0[0]), _mm256_sqrt_pd(self.0[1])] })
    }
    #[inline(always)]
    fn above(self) -> Self {
        let (zero, sign) = (Self::splat(0.0), self.signs());
        let next = unsafe {
            [
                _mm256_castsi256_pd(_mm256_add_epi64(_mm256_castpd_si256(self.0[0]), sign[0])),
                _mm256_castsi256_pd(_mm256_add_epi64(_mm256_castpd_si256(self.0[1]), sign[1])),
            ]
        };
        Self::select(Self::both(self.le(zero), zero.le(self)), Self::splat(ETA), Self(next))
    }
    #[inline(always)]
    fn below(self) -> Self {
        let (zero, sign) = (Self::splat(0.0), self.signs());
        let next = unsafe {
            [
                _mm256_castsi256_pd(_mm256_sub_epi64(_mm256_castpd_si256(self.0[0]), sign[0])),
                _mm256_castsi256_pd(_mm256_sub_epi64(_mm256_castpd_si256(self.0[1]), sign[1])),
            ]
        };
        Self::select(Self::both(self.le(zero), zero.le(self)), Self::splat(-ETA), Self(next))
    }
    #[inline(always)]
    fn top(self) -> Self {
        let whole = Self::splat(WHOLE);
        let k = unsafe {
            [
                _mm256_castsi256_pd(_mm256_srli_epi64::<32>(_mm256_castpd_si256(self.0[0]))),
                _mm256_castsi256_pd(_mm256_srli_epi64::<32>(_mm256_castpd_si256(self.0[1]))),
            ]
        };
        Self(halves!(_mm256_or_pd k, whole.0)).sub(whole)
    }
    #[inline(always)]
    fn with_top(self) -> Self {
        let whole = self.add(Self::splat(WHOLE));
        Self(unsafe {
            [
                _mm256_castsi256_pd(_mm256_slli_epi64::<32>(_mm256_castpd_si256(whole.0[0]))),
                _mm256_castsi256_pd(_mm256_slli_epi64::<32>(_mm256_castpd_si256(whole.0[1]))),
            ]
        })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let sign = Self::splat(-0.0);
        Self(halves!(_mm256_andnot_pd sign.0, self.0))
    }
    #[inline(always)]
    fn neg(self) -> Self {
        let sign = Self::splat(-0.0);
        Self(halves!(_mm256_xor_pd self.0, sign.0))
    }
    #[inline(always)]
    fn greater(self, o: Self) -> Self {
        Self(halves!(_mm256_max_pd self.0, o.0))
    }
    #[inline(always)]
    fn lesser(self, o: Self) -> Self {
        Self(halves!(_mm256_min_pd self.0, o.0))
    }
    #[inline(always)]
    fn nonzero(self) -> Self::Mask {
        let zero = Self::splat(0.0);
        unsafe {
            [_mm256_cmp_pd::<_CMP_NEQ_UQ>(self.0[0], zero.0[0]), _mm256_cmp_pd::<_CMP_NEQ_UQ>(self.0[1], zero.0[1])]
        }
    }
    #[inline(always)]
    fn keep(mask: Self::Mask, x: Self) -> Self {
        Self(halves!(_mm256_and_pd mask, x.0))
    }
    #[inline(always)]
    fn step(size: Self) -> Self {
        let (phi, eta) = (Self::splat(PHI), Self::splat(ETA));
        Self(halves!(_mm256_fmadd_pd size.0, phi.0, eta.0))
    }
    #[inline(always)]
    fn raised(self) -> Self {
        let (size, phi) = (self.abs(), Self::splat(PHI));
        Self(halves!(_mm256_fmadd_pd size.0, phi.0, self.0))
    }
    #[inline(always)]
    fn lowered(self) -> Self {
        let (size, phi) = (self.abs(), Self::splat(PHI));
        Self(halves!(_mm256_fnmadd_pd size.0, phi.0, self.0))
    }
    #[inline(always)]
    fn lt(self, o: Self) -> Self::Mask {
        unsafe { [_mm256_cmp_pd::<_CMP_LT_OQ>(self.0[0], o.0[0]), _mm256_cmp_pd::<_CMP_LT_OQ>(self.0[1], o.0[1])] }
    }
    #[inline(always)]
    fn le(self, o: Self) -> Self::Mask {
        unsafe { [_mm256_cmp_pd::<_CMP_LE_OQ>(self.0[0], o.0[0]), _mm256_cmp_pd::<_CMP_LE_OQ>(self.0[1], o.0[1])] }
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Self(halves!(_mm256_blendv_pd no.0, yes.0, mask))
    }
    #[inline(always)]
    fn both(a: Self::Mask, b: Self::Mask) -> Self::Mask {
        halves!(_mm256_and_pd a, b)
    }
    #[inline(always)]
    fn either(a: Self::Mask, b: Self::Mask) -> Self::Mask {
        halves!(_mm256_or_pd a, b)
    }
    #[inline(always)]
    fn not(mask: Self::Mask) -> Self::Mask {
        halves!(_mm256_xor_pd mask, Self::always())
    }
    #[inline(always)]
    fn always() -> Self::Mask {
        Self::splat(0.0).le(Self::splat(0.0))
    }
    #[inline(always)]
    fn bits(mask: Self::Mask) -> u8 {
        unsafe { (_mm256_movemask_pd(mask[0]) | _mm256_movemask_pd(mask[1]) << 4) as u8 }
    }
}

/// Runs an operation on AVX-512.
#[inline]
pub(super) fn with_avx512<F: Packed>(_: super::super::Avx512, act_: Act, memory: &mut [Eight], vectors: usize) {
    // SAFETY: the proof exists only where the processor has the feature.
    unsafe { on_avx512::<F>(act_, memory, vectors) }
}

/// Runs an operation on AVX2.
#[inline]
pub(super) fn with_avx2<F: Packed>(_: Avx2, act_: Act, memory: &mut [Eight], vectors: usize) {
    // SAFETY: the proof exists only where the processor has the feature.
    unsafe { on_avx2::<F>(act_, memory, vectors) }
}

#[target_feature(enable = "avx512f")]
fn on_avx512<F: Packed>(act_: Act, memory: &mut [Eight], vectors: usize) {
    act::<V512, F>(act_, memory, vectors);
}

#[target_feature(enable = "avx2,fma")]
fn on_avx2<F: Packed>(act_: Act, memory: &mut [Eight], vectors: usize) {
    act::<V256, F>(act_, memory, vectors);
}
