//! Multiples of pi/2 among floats, and the tightest enclosures of periodic functions.
use crate::function::Function;
use antumbra_interval::Interval;
use rug::Float;
use rug::float::{Constant, Round};

/// A periodic function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Wave {
    Sin,
    Cos,
    Tan,
}

impl Wave {
    pub(crate) fn of(name: &str) -> Option<Self> {
        match name {
            "sin" => Some(Self::Sin),
            "cos" => Some(Self::Cos),
            "tan" => Some(Self::Tan),
            _ => None,
        }
    }
}

/// pi/2 to so many bits that no float is mistaken: none is nearer to a multiple of it than about 2^-60, and the largest
/// multiples have 1024 bits before the point.
pub(crate) struct Turns(Float);

const BITS: u32 = 1300;

impl Turns {
    pub(crate) fn new() -> Self {
        Self(Float::with_val(BITS, Constant::Pi) / 2u32)
    }

    /// The float nearest to `integer 2^shift pi/2`.
    pub(crate) fn quarter(&self, integer: u64, shift: u32) -> f64 {
        (Float::with_val(BITS, &self.0 * integer) << shift).to_f64_round(Round::Nearest)
    }

    /// The number of the quarter turn that holds `x`.
    fn index(&self, x: f64) -> Float {
        (Float::with_val(BITS, x) / &self.0).floor()
    }

    /// The tightest enclosure over a bounded interval.
    pub(crate) fn tightest(&self, wave: Wave, function: &Function, x: Interval) -> Interval {
        let (first, last) = (self.index(x.lo()), self.index(x.hi()));
        let crossed = Float::with_val(BITS, &last - &first).to_f64();
        // The index of the first quarter turn, modulo 4.
        let remainder = (Float::with_val(BITS, &first) - Float::with_val(BITS, &first / 4u32).floor() * 4u32).to_f64();
        let meets =
            |kind: u32| (1..=4).any(|k| f64::from(k) <= crossed && (remainder + f64::from(k)) % 4.0 == f64::from(kind));
        let at = |x: f64| function.at([x, 0.0, 0.0]);
        let ends = at(x.lo()).hull(at(x.hi()));
        let (most, least) = match wave {
            Wave::Sin => (1, 3),
            Wave::Cos => (0, 2),
            Wave::Tan if meets(1) || meets(3) => return Interval::ENTIRE,
            Wave::Tan => return ends,
        };
        let ends = if meets(most) { ends.hull(Interval::ONE) } else { ends };
        if meets(least) { ends.hull(-Interval::ONE) } else { ends }
    }
}
