//! Deterministic inputs where rounding errors hide, and counting in units of float steps.
#![allow(dead_code, reason = "each test binary uses a part of it")]
#![allow(clippy::disallowed_methods, reason = "no NaN and no sign of zero is at stake among finite test values")]
use antumbra_interval::Interval;

/// SplitMix64 (Steele, Lea, Flood 2014).
pub(crate) struct Generator(pub(crate) u64);

impl Generator {
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
    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }
    /// A finite number of a kind that breaks things.
    pub(crate) fn number(&mut self) -> f64 {
        let sign = if self.below(2) == 0 { 1.0 } else { -1.0 };
        let magnitude = match self.below(12) {
            0 => 0.0,
            1 => power_of_two(self.below(2098) as i32 - 1074),
            2 => nudge(power_of_two(self.below(2040) as i32 - 1020), self.below(7) as i64 - 3),
            3 => f64::from_bits(self.below(1 << 52)),
            4 => f64::from_bits(self.below(5)),
            5 => nudge(f64::MAX, -(self.below(4) as i64)),
            6 => self.below(20) as f64,
            // Few bits: products and sums that are exact or ties.
            7 => (self.below(1 << 27) as f64) * power_of_two(self.below(60) as i32 - 30),
            8 => nudge(std::f64::consts::FRAC_PI_2 * self.below(1000) as f64, self.below(5) as i64 - 2),
            9 => f64::from_bits(self.below(f64::INFINITY.to_bits())),
            _ => self.unit() * 10.0,
        };
        sign * magnitude
    }
    /// A finite number with an exponent in the middle.
    pub(crate) fn moderate(&mut self) -> f64 {
        let sign = if self.below(2) == 0 { 1.0 } else { -1.0 };
        sign * match self.below(4) {
            0 => self.below(9) as f64,
            1 => nudge(self.below(9) as f64, self.below(5) as i64 - 2),
            _ => self.unit() * power_of_two(self.below(40) as i32 - 20),
        }
    }
    /// A bounded interval; often a point or a few steps wide.
    pub(crate) fn bounded(&mut self) -> Interval {
        let a = self.number();
        self.around(a)
    }
    /// A bounded interval with one bound `a`.
    pub(crate) fn around(&mut self, a: f64) -> Interval {
        let b = match self.below(5) {
            0 => a,
            1 => nudge(a, self.below(9) as i64 - 4).clamp(f64::MIN, f64::MAX),
            2 => -a,
            3 => (a * (1.0 + self.unit())).clamp(f64::MIN, f64::MAX),
            _ => self.number(),
        };
        if a <= b { Interval::new(a, b) } else { Interval::new(b, a) }
    }
    /// Any interval: also empty and unbounded ones.
    pub(crate) fn any(&mut self) -> Interval {
        let x = self.bounded();
        match self.below(12) {
            0 => Interval::EMPTY,
            1 => Interval::ENTIRE,
            2 => Interval::new(f64::NEG_INFINITY, x.hi()),
            3 => Interval::new(x.lo(), f64::INFINITY),
            4 => Interval::ZERO,
            _ => x,
        }
    }
    /// A finite member of an interval that is not empty: often a bound.
    pub(crate) fn member(&mut self, x: Interval) -> f64 {
        let (lo, hi) = (x.lo().max(f64::MIN), x.hi().min(f64::MAX));
        match self.below(4) {
            0 => lo,
            1 => hi,
            2 => {
                let s = self.unit();
                (lo * (1.0 - s) + hi * s).clamp(lo, hi)
            }
            _ => self.number().clamp(lo, hi),
        }
    }
}

/// `2^e`, subnormal ones included.
pub(crate) fn power_of_two(e: i32) -> f64 {
    if e >= -1022 { f64::from_bits(((e + 1023) as u64) << 52) } else { f64::from_bits(1 << (e + 1074)) }
}

/// `steps` floats further up (down if negative), stopping at the infinities.
pub(crate) fn nudge(x: f64, steps: i64) -> f64 {
    (0..steps.abs()).fold(x, |x, _| if steps > 0 { x.next_up() } else { x.next_down() })
}

/// How many floats wider `x` is than `tight` at its wider end; `None` if it does not contain it. Both empty: 0.
pub(crate) fn excess(x: Interval, tight: Interval) -> Option<u64> {
    if !tight.is_subset_of(x) {
        return None;
    }
    if tight.is_empty() {
        return Some(if x.is_empty() { 0 } else { u64::MAX });
    }
    Some((rank(tight.lo()) - rank(x.lo())).max(rank(x.hi()) - rank(tight.hi())) as u64)
}

/// How many floats `upper` is above `least`, which it must not be below.
pub(crate) fn excess_of_bound(upper: f64, least: f64) -> u64 {
    u64::try_from(rank(upper) - rank(least)).expect("an upper bound")
}

/// Place of a float among all floats; both zeros have one.
fn rank(v: f64) -> i128 {
    let bits = (v + 0.0).to_bits() as i64;
    i128::from(if bits < 0 { i64::MIN - bits } else { bits })
}
