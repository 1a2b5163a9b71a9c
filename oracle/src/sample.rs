//! Hard arguments.
use crate::function::{Function, Hard, Operands};
use crate::nasty::{Generator, nudge};
use crate::turns::Turns;
use antumbra_interval::Interval;

/// Arguments whose results are famous for lying near a float or near the middle of two (Lefevre and Muller), the float
/// nearest to a multiple of pi/2 of all, and ends of ranges.
const FAMOUS: [f64; 12] = [
    7.541_752_774_995_959e-10,
    5.319_372_648_326_541e255,
    f64::MAX,
    f64::MIN_POSITIVE,
    709.782_712_893_384,
    -745.133_219_101_941_1,
    710.475_860_073_943_9,
    -708.396_418_532_264_1,
    0.999_999_999_999_999_9,
    1.000_000_000_000_000_2,
    1e22,
    std::f64::consts::FRAC_PI_2,
];

/// Arguments of one function, from one seed.
pub(crate) struct Sampler {
    pub(crate) generator: Generator,
    hard: Hard,
    pub(crate) turns: Turns,
}

impl Sampler {
    pub(crate) fn new(function: &Function, seed: u64) -> Self {
        // The name makes the sequences of the functions different.
        let salt = function.name.bytes().fold(seed, |s, b| s.wrapping_mul(0x100_0000_01b3) ^ u64::from(b));
        Self { generator: Generator(salt), hard: function.hard, turns: Turns::new() }
    }

    /// A float: one in three hard for the function.
    fn number(&mut self) -> f64 {
        match self.generator.below(12) {
            0..4 => self.hard_number(),
            4..8 => self.generator.moderate(),
            8 => self.famous(),
            _ => self.generator.number(),
        }
    }

    fn famous(&mut self) -> f64 {
        // The double nearest to a multiple of pi/2 in relative terms (Kahan).
        let nearest = 6_381_956_970_095_103.0 * crate::nasty::power_of_two(797);
        let i = self.generator.below(FAMOUS.len() as u64 + 1) as usize;
        let x = FAMOUS.get(i).copied().unwrap_or(nearest);
        let x = nudge(x, self.generator.below(5) as i64 - 2).clamp(f64::MIN, f64::MAX);
        if self.generator.below(2) == 0 { x } else { -x }
    }

    fn hard_number(&mut self) -> f64 {
        let g = &mut self.generator;
        let sign = if g.below(2) == 0 { 1.0 } else { -1.0 };
        let steps = g.below(5) as i64 - 2;
        sign * match self.hard {
            Hard::No | Hard::Power => g.number().abs(),
            Hard::QuarterTurns => {
                // An integer of 1 to 53 bits times a power of two; small ones most often.
                let bits = 1 + g.below(53);
                let integer = (g.bits() >> (64 - bits)).max(1);
                let shift = if g.below(3) == 0 { g.below(970) as u32 } else { 0 };
                nudge(self.turns.quarter(integer, shift), steps).clamp(f64::MIN, f64::MAX)
            }
            Hard::UnitInterval => match g.below(3) {
                0 => nudge(1.0, steps),
                1 => 1.0 - g.unit() * crate::nasty::power_of_two(-(g.below(60) as i32)),
                _ => g.unit(),
            },
            // 2^k: powers and exponentials of these cross the limits of the format.
            Hard::Overflow => match g.below(3) {
                0 => {
                    nudge([708.0, 709.782_712_893_384, 710.475_860_073_943_9, 745.133_219][g.below(4) as usize], steps)
                }
                1 => {
                    crate::nasty::power_of_two([341, 256, 128, 114, 60, 1, -1, -358, -134][g.below(9) as usize])
                        * (1.0 + g.unit())
                }
                _ => 745.0 * g.unit(),
            },
        }
    }

    /// A point.
    pub(crate) fn point(&mut self, arity: usize) -> Operands<f64> {
        let x = self.number();
        let y = if arity < 2 { 0.0 } else { self.number() };
        let z = if arity < 3 { 0.0 } else { self.number() };
        match self.hard {
            Hard::Power if self.generator.below(2) == 0 => {
                // x^y about 2^+-1074, 2^1024 or 1: y = k / log2(x).
                let x = if x == 0.0 { 2.0 } else { x.abs() };
                let k = [1024.0, -1022.0, -1074.0, 1e-17, 1.0, 53.0][self.generator.below(6) as usize];
                let y = k / x.log2();
                let y = if y.is_finite() { nudge(y, self.generator.below(5) as i64 - 2) } else { 1.0 };
                [x, y, z]
            }
            _ if arity == 3 && self.generator.below(2) == 0 => {
                // A sum that cancels.
                let product = (x * y).clamp(f64::MIN, f64::MAX);
                [x, y, nudge(-product, self.generator.below(5) as i64 - 2).clamp(f64::MIN, f64::MAX)]
            }
            _ => [x, y, z],
        }
    }

    /// A box: around a point, or anything.
    pub(crate) fn boxes(&mut self, arity: usize) -> Operands<Interval> {
        let x = self.point(arity);
        x.map(|x| match self.generator.below(12) {
            0 => self.generator.any(),
            1 => Interval::new(x, f64::INFINITY),
            2 => Interval::new(f64::NEG_INFINITY, x),
            3 => Interval::point(x),
            _ => self.generator.around(x),
        })
    }
}
