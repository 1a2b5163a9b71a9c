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
    /// What its reciprocal stays below.
    inverse: f64,
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
        Self { value, slope, peak: peak.max(value).max(slope), inverse: 4.0 * POLE }
    }

    fn product(self, o: Self) -> Self {
        // The slope's two products are summed.
        let slope = self.slope * o.value + self.value * o.slope;
        Self::new(self.value * o.value, slope, self.peak.max(o.peak))
    }
}

/// Denominators nearer to 0 than its inverse are lost (`POLE` of `functions.wgsl`).
const POLE: f64 = (1 << 20) as f64;

/// The functions of `functions.wgsl`, each by what its kernel lets pass.
impl Reach {
    /// A value of at most that, and a slope of at most so many times the operand's.
    fn through(self, value: f64, mean: f64) -> Self {
        Self::new(value, mean * self.slope, self.peak)
    }

    /// Arguments beyond 20 are lost; centre, coefficients and error of the form are at most 8 times the largest value.
    fn exponential(self) -> Self {
        let e = 8.0 * Interval::point(self.value.clamp(0.0, 20.0)).exp().hi();
        // Infinite or NaN stays so.
        let e = if self.value.is_finite() { e } else { f64::INFINITY };
        self.through(e, 2.0 * e)
    }

    /// `x / y`: `1 / y` is a form of at most four times its largest value unless y is a constant; the slope is `(x' - q y') / y`, `q` the quotient at the apex.
    fn quotient(self, o: Self) -> Self {
        let inverse = o.inverse;
        let value = self.value * inverse;
        Self::new(value, (self.slope + value * o.slope) * inverse, self.peak.max(o.peak))
    }
}

impl Number for Reach {
    fn constant(value: Interval) -> Self {
        let new = Self::new(value.magnitude(), 0.0, 0.0);
        if value.possibly_zero() {
            return new;
        }
        // Multiplied by, not divided by.
        let inverse = ROUNDING / value.mignitude();
        Self { inverse, peak: new.peak.max(inverse), ..new }
    }

    fn unary(self, op: Unary) -> Self {
        match op {
            Unary::Neg => Self::new(self.value, self.slope, self.peak),
            // k x + [0, b] with |k| <= 1, b at most twice the size.
            Unary::Abs => Self::new(3.0 * self.value, 2.0 * self.slope, self.peak),
            // The slope is a product with the sum of two values.
            Unary::Sqr => self.product(self),
            Unary::Sqrt => self.through(3.0 * self.value + 3.0, 4.0 * POLE),
            Unary::Sin | Unary::Cos => self.through(5.0, 6.0),
            Unary::Ln => self.through(120.0, 8.0 * POLE),
            Unary::Exp => self.exponential(),
            // Half a sum of two.
            Unary::Sinh | Unary::Cosh => self.exponential().product(Self::new(4.0, 0.0, 0.0)),
            _ => Self::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        }
    }

    fn powi(self, n: i32) -> Self {
        match n {
            0 => Self::constant(Interval::ONE),
            i32::MIN..0 => Self::constant(Interval::ONE).quotient(self.powi(n.saturating_neg())),
            1.. => {
                let n = n.unsigned_abs();
                (0..n.ilog2()).rev().fold(self, |p, bit| {
                    let square = p.product(p);
                    if n >> bit & 1 == 1 { square.product(self) } else { square }
                })
            }
        }
    }

    fn binary(self, op: Binary, o: Self) -> Self {
        let peak = self.peak.max(o.peak);
        let sum = Self::new(self.value + o.value, self.slope + o.slope, peak);
        match op {
            Binary::Add | Binary::Sub => sum,
            // (x + y + |x - y|)/2: four times the sum on the way.
            Binary::Min | Binary::Max => sum.product(Self::new(4.0, 0.0, 0.0)),
            Binary::Mul => self.product(o),
            Binary::Div => self.quotient(o),
            // e^(y ln x), or up to 1 over that.
            Binary::Pow => {
                let power = self.unary(Unary::Ln).product(Self::new(o.value, 0.0, o.peak)).exponential();
                power.quotient(Self::constant(Interval::ONE))
            }
            Binary::Atan2 => Self::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        }
    }
}
