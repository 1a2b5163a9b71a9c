//! Deterministic random forms, and exact values of them.
#![allow(dead_code, reason = "each test file uses a part")]
use antumbra_interval::affine::Affine;
use num_bigint::BigInt;
use std::cmp::Ordering;

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
        (self.bits() >> 11) as f64 * power_of_two(-52) - 1.0
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
        x * power_of_two(exponent)
    }
    pub(crate) fn nasty_form<const N: usize>(&mut self) -> Affine<N> {
        let e = if self.below(3) == 0 { 0.0 } else { self.nasty().abs() };
        Affine::linear(self.nasty(), std::array::from_fn(|_| self.nasty()), e)
    }
    /// Centre in [lo, hi], radius at most `radius`, of any small scale.
    pub(crate) fn form<const N: usize>(&mut self, lo: f64, hi: f64, radius: f64) -> Affine<N> {
        let scale = radius * power_of_two(-(self.below(40) as i32)) / (N + 1) as f64;
        let e = match self.below(3) {
            0 => 0.0,
            1 => scale * self.signed().abs(),
            _ => scale * 1e-6 * self.signed().abs(),
        };
        let c = self.between(lo, hi);
        Affine::linear(c, std::array::from_fn(|_| scale * self.signed()), e)
    }
}

/// `2^k` for `-1074 <= k <= 1023`.
pub(crate) fn power_of_two(k: i32) -> f64 {
    f64::from_bits(if k >= -1022 { ((k + 1023) as u64) << 52 } else { 1 << (k + 1074) })
}

/// The smaller and the larger one.
pub(crate) fn ordered(x: f64, y: f64) -> (f64, f64) {
    if x < y { (x, y) } else { (y, x) }
}

/// The exact number `mantissa * 2^exponent`: floats, their sums and products.
#[derive(Clone, Debug)]
pub(crate) struct Dyadic {
    mantissa: BigInt,
    exponent: i64,
}

pub(crate) fn exact(x: f64) -> Dyadic {
    assert!(x.is_finite());
    let (bits, biased) = (x.to_bits() & ((1 << 52) - 1), (x.to_bits() >> 52 & 0x7ff) as i64);
    let m = BigInt::from(if biased == 0 { bits } else { bits | 1 << 52 });
    Dyadic { mantissa: if x < 0.0 { -m } else { m }, exponent: if biased == 0 { -1074 } else { biased - 1075 } }
}

impl Dyadic {
    pub(crate) fn abs(&self) -> Self {
        Self { mantissa: self.mantissa.magnitude().clone().into(), exponent: self.exponent }
    }
    pub(crate) fn is_zero(&self) -> bool {
        self.mantissa == BigInt::ZERO
    }
    fn at_exponent(&self, exponent: i64) -> BigInt {
        &self.mantissa << (self.exponent - exponent)
    }
    /// A float next to it, on either side.
    fn near(&self) -> f64 {
        let cut = self.mantissa.bits().saturating_sub(60);
        let top = i64::try_from(&self.mantissa >> cut).expect("60 bits");
        let mut x = top as f64;
        let mut k = self.exponent + cut as i64;
        while k != 0 {
            let step = k.clamp(-500, 500) as i32;
            x *= power_of_two(step);
            k -= i64::from(step);
        }
        if x.is_infinite() { f64::MAX.copysign(x) } else { x }
    }
}
macro_rules! operator {
    ($trait:ident $name:ident |$a:ident, $b:ident| $body:expr) => {
        impl std::ops::$trait<&Dyadic> for &Dyadic {
            type Output = Dyadic;
            fn $name(self, o: &Dyadic) -> Dyadic {
                let ($a, $b) = (self, o);
                $body
            }
        }
        impl std::ops::$trait for Dyadic {
            type Output = Dyadic;
            fn $name(self, o: Dyadic) -> Dyadic {
                std::ops::$trait::$name(&self, &o)
            }
        }
    };
}
fn aligned(a: &Dyadic, b: &Dyadic, f: fn(BigInt, BigInt) -> BigInt) -> Dyadic {
    let exponent = Ord::min(a.exponent, b.exponent);
    Dyadic { mantissa: f(a.at_exponent(exponent), b.at_exponent(exponent)), exponent }
}
operator!(Add add |a, b| aligned(a, b, |x, y| x + y));
operator!(Sub sub |a, b| aligned(a, b, |x, y| x - y));
operator!(Mul mul |a, b| Dyadic { mantissa: &a.mantissa * &b.mantissa, exponent: a.exponent + b.exponent });

impl PartialEq for Dyadic {
    fn eq(&self, o: &Self) -> bool {
        self.partial_cmp(o) == Some(Ordering::Equal)
    }
}
impl PartialOrd for Dyadic {
    fn partial_cmp(&self, o: &Self) -> Option<Ordering> {
        let exponent = Ord::min(self.exponent, o.exponent);
        Some(self.at_exponent(exponent).cmp(&o.at_exponent(exponent)))
    }
}

/// The plane of a known form at symbol values.
pub(crate) fn plane<const N: usize>(x: &Affine<N>, s: &[f64; N]) -> Dyadic {
    x.coefficients().iter().zip(s).fold(exact(x.centre()), |v, (a, s)| v + exact(*a) * exact(*s))
}

/// A member of the form at symbol values: the plane plus `p e`.
pub(crate) fn member<const N: usize>(x: &Affine<N>, s: &[f64; N], p: f64) -> Dyadic {
    plane(x, s) + exact(p) * exact(x.error())
}

/// Whether the form allows the value `v` at these symbol values.
pub(crate) fn allows<const N: usize>(x: &Affine<N>, s: &[f64; N], v: &Dyadic) -> bool {
    !x.is_known() || (v - &plane(x, s)).abs() <= exact(x.error())
}

/// Whether the form allows the value `n / d` at these symbol values: `|n - d plane| <= e |d|`.
pub(crate) fn allows_ratio<const N: usize>(x: &Affine<N>, s: &[f64; N], n: &Dyadic, d: &Dyadic) -> bool {
    !x.is_known() || (n - &(d * &plane(x, s))).abs() <= &exact(x.error()) * &d.abs()
}

/// Whether the form allows some value of `[lo, hi]` (possibly infinite) at these symbol values.
pub(crate) fn meets<const N: usize>(x: &Affine<N>, s: &[f64; N], lo: f64, hi: f64) -> bool {
    assert!(lo <= hi, "{lo} {hi}");
    if !x.is_known() {
        return true;
    }
    let (p, e) = (plane(x, s), exact(x.error()));
    (lo == f64::NEG_INFINITY || exact(lo) <= &p + &e) && (hi == f64::INFINITY || exact(hi) >= &p - &e)
}

/// The floats on both sides of `x`.
pub(crate) fn neighbours(x: &Dyadic) -> (f64, f64) {
    if x.is_zero() {
        return (0.0, 0.0);
    }
    let mut m = x.near();
    while exact(m) > *x {
        m = m.next_down();
    }
    while exact(m.next_up()) <= *x {
        m = m.next_up();
    }
    (m, if exact(m) == *x { m } else { m.next_up() })
}
