//! Deterministic random forms, and exact values of them.
#![allow(dead_code, reason = "each test file uses a part")]
use antumbra_interval::affine::Affine;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

/// SplitMix64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    pub(crate) fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }
    /// In [-1, 1), all 53 bits in use.
    pub(crate) fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * 2f64.powi(-52) - 1.0
    }
    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * (0.5 * self.signed() + 0.5)
    }
    /// A symbol value: often at an end or 0.
    pub(crate) fn symbol(&mut self) -> f64 {
        match self.below(6) {
            0 => 1.0,
            1 => -1.0,
            2 => 0.0,
            _ => self.signed(),
        }
    }
    pub(crate) fn symbols<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.symbol())
    }
    /// Any size from the subnormals to 2^480, mostly near 1.
    pub(crate) fn nasty(&mut self) -> f64 {
        let exponent = match self.below(10) {
            0 => self.below(1550) as i32 - 1074,
            1 => self.below(200) as i32 - 100,
            2 => return 0.0,
            3 => return [1.0, -1.0, 0.5, 3.0, f64::MIN_POSITIVE, 5e-324][self.below(6) as usize],
            _ => self.below(8) as i32 - 4,
        };
        let x = self.signed();
        // Two steps: 2^-1074 alone is fine, a smaller power would be 0.
        x * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
    }
    pub(crate) fn nasty_form<const N: usize>(&mut self) -> Affine<N> {
        let e = if self.below(3) == 0 { 0.0 } else { self.nasty().abs() };
        Affine::linear(self.nasty(), std::array::from_fn(|_| self.nasty()), e)
    }
    /// Centre in [lo, hi], radius at most `radius`, of any small scale.
    pub(crate) fn form<const N: usize>(&mut self, lo: f64, hi: f64, radius: f64) -> Affine<N> {
        let scale = radius * 2f64.powi(-(self.below(40) as i32)) / (N + 1) as f64;
        let e = match self.below(3) {
            0 => 0.0,
            1 => scale * self.signed().abs(),
            _ => scale * 1e-6 * self.signed().abs(),
        };
        let c = self.between(lo, hi);
        Affine::linear(c, std::array::from_fn(|_| scale * self.signed()), e)
    }
}

pub(crate) fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).expect("finite")
}

/// The plane of a known form at symbol values.
pub(crate) fn plane<const N: usize>(x: &Affine<N>, s: &[f64; N]) -> BigRational {
    x.coefficients().iter().zip(s).fold(exact(x.centre()), |v, (a, s)| v + exact(*a) * exact(*s))
}

/// A member of the form at symbol values: the plane plus `p e`.
pub(crate) fn member<const N: usize>(x: &Affine<N>, s: &[f64; N], p: f64) -> BigRational {
    plane(x, s) + exact(p) * exact(x.error())
}

/// Whether the form allows the value `v` at these symbol values.
pub(crate) fn allows<const N: usize>(x: &Affine<N>, s: &[f64; N], v: &BigRational) -> bool {
    !x.is_known() || (v - plane(x, s)).abs() <= exact(x.error())
}

/// Whether the form allows some value of `[lo, hi]` (possibly infinite) at these symbol values.
pub(crate) fn meets<const N: usize>(x: &Affine<N>, s: &[f64; N], lo: f64, hi: f64) -> bool {
    assert!(lo <= hi, "{lo} {hi}");
    if !x.is_known() {
        return true;
    }
    let (p, e) = (plane(x, s), exact(x.error()));
    (lo == f64::NEG_INFINITY || exact(lo) <= &p + &e) && (hi == f64::INFINITY || exact(hi) >= p - e)
}

/// The floats on both sides of `x`.
pub(crate) fn neighbours(x: &BigRational) -> (f64, f64) {
    if x.is_zero() {
        return (0.0, 0.0);
    }
    let mut m = x.to_f64().unwrap_or(0.0);
    while exact(m) > *x {
        m = m.next_down();
    }
    while exact(m.next_up()) <= *x {
        m = m.next_up();
    }
    (m, if exact(m) == *x { m } else { m.next_up() })
}
