//! How large can a number get? Proved before anything runs on a GPU, where overflow is undefined.
use super::Refusal;
use crate::eval::{Number, run};
use crate::expr::{Binary, Unary};
use crate::tape::Tape;
use antumbra_interval::Interval;

/// Upper bounds of all magnitudes of a form, of `|c| + |a|_1 + e`, and of its slope's.
///
/// A sum's is at most the sum of its operands'; a product's at most their product, because
/// `|c_a c_b| + |Q|/2 + |c_a||b|_1 + |c_b||a|_1 + R T - D/2 + |c_a| e_b + |c_b| e_a <= (|c_a| + R)(|c_b| + T)` with `|Q| <= D`. The same
/// bounds hold for the ends of intervals and for balls. Rounding is covered by the factor of each operation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Of values.
    value: f64,
    /// Of slopes.
    slope: f64,
    /// The largest of all that led here.
    peak: f64,
}

/// More than 32 roundings of 2^-23 and what is added for underflow.
const ROUNDING: f64 = 1.0001;
/// No intermediate result may be larger.
const MOST: f64 = (1u128 << 120) as f64;

impl Reach {
    /// Proves that no kind of number of the GPU overflows on the tape, if no coordinate's form reaches `coordinates` and no slope's
    /// reaches `directions`.
    ///
    /// # Errors
    /// [`Refusal::Overflow`] where that is not proved. Operators that the GPU does not have count as infinite.
    pub fn check(tape: &Tape, coordinates: [f64; 3], directions: [f64; 3]) -> Result<(), Refusal> {
        let point = std::array::from_fn(|k| Self::new(coordinates[k], directions[k], 0.0));
        let found = run(tape, point, &mut Vec::new());
        // Not `peak > MOST`: NaN is refused too.
        if found.peak <= MOST { Ok(()) } else { Err(Refusal::Overflow(found.peak)) }
    }

    fn new(value: f64, slope: f64, peak: f64) -> Self {
        // Bounds that are added as floors count too.
        let (value, slope) = ((value + 1e-20) * ROUNDING, (slope + 1e-20) * ROUNDING);
        Self { value, slope, peak: peak.max(value).max(slope) }
    }

    fn product(self, o: Self) -> Self {
        // The slope's two products are summed.
        let slope = self.slope * o.value + self.value * o.slope;
        Self::new(self.value * o.value, slope, self.peak.max(o.peak))
    }
}

impl Number for Reach {
    fn constant(value: Interval) -> Self {
        Self::new(value.magnitude(), 0.0, 0.0)
    }

    fn unary(self, op: Unary) -> Self {
        match op {
            Unary::Neg | Unary::Abs => Self::new(self.value, self.slope, self.peak),
            // The slope is a product with the sum of two values.
            Unary::Sqr => self.product(self),
            _ => Self::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        }
    }

    fn powi(self, n: i32) -> Self {
        match n {
            0 => Self::constant(Interval::ONE),
            1.. => {
                let n = n.unsigned_abs();
                (0..n.ilog2()).rev().fold(self, |p, bit| {
                    let square = p.product(p);
                    if n >> bit & 1 == 1 { square.product(self) } else { square }
                })
            }
            _ => Self::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        }
    }

    fn binary(self, op: Binary, o: Self) -> Self {
        let peak = self.peak.max(o.peak);
        let sum = Self::new(self.value + o.value, self.slope + o.slope, peak);
        match op {
            Binary::Add | Binary::Sub => sum,
            // (x + y + |x - y|)/2: twice the sum on the way.
            Binary::Min | Binary::Max => sum.product(Self::new(2.0, 0.0, 0.0)),
            Binary::Mul => self.product(o),
            Binary::Div | Binary::Pow | Binary::Atan2 => Self::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        }
    }
}
