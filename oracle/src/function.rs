//! A function as each of the three sides knows it.
use antumbra_interval::Interval;
use rug::Float;
use rug::float::Round;
use std::cmp::Ordering;

/// Bits of a double's significand: MPFR rounds to it in the direction that is asked for.
pub(crate) const BITS: u32 = 53;

/// Operands: as many as the function has, then anything.
pub(crate) type Operands<T> = [T; 3];

/// What makes a function's arguments hard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Hard {
    /// Nothing in particular.
    No,
    /// Floats nearest to multiples of pi/2, up to the largest floats.
    QuarterTurns,
    /// The ends of [-1, 1].
    UnitInterval,
    /// Where the result over- or underflows.
    Overflow,
    /// A base and an exponent whose power over- or underflows, or is near 1.
    Power,
}

/// A function to compare.
pub(crate) struct Function {
    pub(crate) name: &'static str,
    pub(crate) arity: usize,
    /// Most floats between a bound and the tightest one.
    pub(crate) steps: u64,
    pub(crate) hard: Hard,
    /// Whether it is defined at a point.
    pub(crate) defined: fn(Operands<f64>) -> bool,
    pub(crate) ours: fn(Operands<Interval>) -> Interval,
    /// Rounded in the direction: the value, and on which side of the real one it lies.
    pub(crate) mpfr: fn(&Operands<Float>, Round) -> (Float, Ordering),
    pub(crate) inari: Option<fn(Operands<inari::Interval>) -> inari::Interval>,
}

impl Function {
    /// The tightest enclosure of the value at a point of the domain.
    pub(crate) fn at(&self, x: Operands<f64>) -> Interval {
        // Real numbers have one zero: the sum makes it +0.
        let operands = x.map(|x| Float::with_val(BITS, x + 0.0));
        let (value, side) = (self.mpfr)(&operands, Round::Down);
        // Rounding down twice is rounding down once: the second step only meets coarser numbers.
        let lo = value.to_f64_round(Round::Down);
        let exact = side == Ordering::Equal && value == lo;
        // An overflow leaves the largest float below the value.
        let hi = if exact { lo } else { lo.next_up() };
        Interval::new(lo, hi)
    }
}
